//! Short toolpaths and the blocks that they have to become, worked out by hand. Each program is proven
//! as well.

use program::{CompensatedPath, Diagnostic};
use source::apt::Options;

/// The blocks after the last tool change of the proven program, and the rules of the warnings.
fn posted(machine: &str, path: &str) -> (Vec<String>, Vec<&'static str>) {
    let (text, warnings) = written(machine, path).unwrap_or_else(|errors| panic!("{}", errors[0]));
    let blocks: Vec<String> = text.lines().map(String::from).collect();
    let turns = |block: &String| block.split(' ').any(|word| word == "M3");
    let change = blocks.iter().rposition(turns).unwrap();
    (blocks[change + 1..].to_vec(), warnings.iter().map(|found| found.rule.name()).collect())
}

/// The rule and line of the first error.
fn refused(machine: &str, path: &str) -> (&'static str, u32) {
    let errors = written(machine, path).expect_err("a program");
    (errors[0].rule.name(), errors[0].line)
}

fn written(machine: &str, path: &str) -> Result<(String, Vec<Diagnostic>), Vec<Diagnostic>> {
    let machine = machine::load(machine).unwrap();
    let path =
        format!("UNITS/MM\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nFEDRAT/300,MMPM\n{path}\nFINI\n");
    let cutcom = path.contains("CUTCOM").then_some(CompensatedPath::Contour);
    let options = Options { cutcom, ..Options::default() };
    let reading = source::apt::read("part.apt", path.as_bytes(), &options)?;
    let output = post::write(&reading.program, &machine)?;
    let tolerances = Default::default();
    let report = proof::prove(&reading.program, &machine, "part.nc", &output.text, &tolerances);
    if !report.proven {
        return Err(report.mismatches);
    }
    Ok((String::from_utf8(output.text).unwrap(), output.warnings))
}

/// Whether these blocks stand in a row.
#[track_caller]
fn stands(blocks: &[String], row: &[&str]) {
    let found = blocks.windows(row.len()).any(|blocks| blocks == row);
    assert!(found, "{row:#?} is not in\n{}", blocks.join("\n"));
}

const LINUXCNC: &str = "generic-3axis-linuxcnc";

const TO_A_CONTOUR: &str = "RAPID\nGOTO/0,0,50\nRAPID\nGOTO/0,0,2\nGOTO/0,0,-1\nCUTCOM/LEFT";

#[test]
fn compensation_goes_off_with_a_rapid_in_the_plane() {
    let path = format!(
        "{TO_A_CONTOUR}\nGOTO/10,0,-1\nGOTO/20,0,-1\nCUTCOM/OFF\nGOTO/20,0,9\nRAPID\nGOTO/90,0,9\n\
         GOTO/90,0,-5\nGOTO/99,0,-5"
    );
    let (blocks, _) = posted(LINUXCNC, &path);
    stands(&blocks, &["G1 Z-1 F300", "G41 D1 X10", "X20", "Z9", "G0 G40 X90", "G1 Z-5", "X99"]);
}

#[test]
fn compensation_is_not_switched_on_an_arc_nor_left_on() {
    let on = format!("{TO_A_CONTOUR}\nCIRCLE/10,0,-1,0,0,1,10\nGOTO/20,0,-1\nGOTO/30,0,-1");
    assert_eq!(refused(LINUXCNC, &on), ("compensation", 12));
    let end = format!("{TO_A_CONTOUR}\nGOTO/10,0,-1\nCUTCOM/OFF\nRAPID\nGOTO/10,0,50");
    assert_eq!(refused(LINUXCNC, &end), ("compensation-active", 15));
    let tool = format!("{end}\nLOAD/TOOL,2\nRAPID\nGOTO/99,0,50");
    assert_eq!(refused(LINUXCNC, &tool), ("compensation-active", 15));
    let hole = format!("{end}\nCYCLE/DRILL,RAPTO,2,FEDTO,6,RTRCTO,5,MMPM,150\nGOTO/10,0,0");
    assert_eq!(refused(LINUXCNC, &hole), ("compensation-active", 16));
}

const TWO_HOLES: [&str; 3] = [
    "RAPID\nGOTO/0,0,5\nCYCLE/DRILL,RAPTO,2,FEDTO,6,RTRCTO,5",
    "GOTO/0,0,0",
    "GOTO/9,0,0\nCYCLE/OFF",
];

/// `MCALL` drills after every block, also one that has only a feed in it.
#[test]
fn what_changes_between_two_holes_defines_the_cycle_anew() {
    let [start, first, second] = TWO_HOLES;
    let cycle = "MCALL CYCLE81(5,0,2,-6)";
    for (change, said) in
        [("FEDRAT/100,MMPM", "F100"), ("SPINDL/RPM,500,CLW", "S500 M3"), ("STOP", "M0")]
    {
        let (text, _) =
            written("generic-3axis-sinumerik", &format!("{start}\n{first}\n{change}\n{second}"))
                .unwrap_or_else(|errors| panic!("{change}: {}", errors[0]));
        let blocks: Vec<&str> =
            text.lines().map(|block| block.split_once(' ').unwrap().1).collect();
        let at = |block| blocks.iter().position(|b| *b == block);
        let (off, change) = (at("MCALL").unwrap(), at(said).unwrap());
        assert!(off < change, "{said} while the cycle is on:\n{text}");
        assert_eq!(blocks.iter().filter(|block| **block == cycle).count(), 2, "{text}");
    }
}

/// Two holes along two tool axes, with no rapid in between: the cycle ends, the tool leaves the part,
/// turns, and the second hole has a cycle of its own.
#[test]
fn holes_along_several_axes_each_have_their_plane() {
    let path = "MULTAX/ON\nRAPID\nGOTO/0,0,60,0,0,1\nCYCLE/DRILL,RAPTO,2,FEDTO,6,RTRCTO,20,MMPM,150\n\
                GOTO/0,0,0\nGOTO/20,0,-5,0.5,0,0.8660254\nCYCLE/OFF";
    for machine in
        ["sinumerik-840d-table-ac", "sinumerik-840d-traori", "dmu50-heidenhain", "fanuc-table-bc"]
    {
        written(machine, path).unwrap_or_else(|errors| panic!("{machine}: {}", errors[0]));
    }
    let (blocks, _) = posted("fanuc-table-bc", path);
    let words: Vec<&str> =
        blocks.iter().map(|block| block.split_once(' ').map_or("", |b| b.1)).collect();
    let at = |word: &str| words.iter().position(|block| block.starts_with(word)).unwrap();
    assert!(at("G80") < at("G91 G28 Z0") && at("G91 G28 Z0") < at("G68.2"), "{blocks:#?}");
}

/// Three turns in half a minute: Haas makes each turn in a block of its own, in a sixth of a minute.
#[test]
fn a_piece_of_a_move_has_its_part_of_the_inverse_time() {
    let helix = "RAPID\nGOTO/10,0,3\nFEDRAT/2,INVERS\nCIRCLE/0,0,3,0,0,1,10,TIMES,3\nGOTO/10,0,0";
    let (blocks, _) = posted("generic-3axis-haas", helix);
    assert_eq!(blocks.iter().filter(|block| block.ends_with(" F6.")).count(), 3, "{blocks:#?}");
}

#[test]
fn a_speed_that_rounds_to_nothing_is_refused() {
    let path = "SPINDL/RPM,0.3,CLW\nRAPID\nGOTO/0,0,5\nGOTO/0,0,0";
    assert_eq!(refused(LINUXCNC, path), ("spindle-range", 5));
}

#[test]
fn a_feed_beyond_the_machine_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mill.toml");
    std::fs::write(&file, "extends = \"generic-3axis-linuxcnc\"\nfeed_max = 2000\n").unwrap();
    let path = |feed: u32| format!("RAPID\nGOTO/0,0,5\nFEDRAT/{feed},MMPM\nGOTO/0,0,0");
    let machine = file.to_str().unwrap();
    assert_eq!(refused(machine, &path(2001)), ("feed-range", 8));
    posted(machine, &path(2000));
}

#[test]
fn registers_that_the_control_cannot_name_are_reported() {
    let path = "LOAD/TOOL,2,ADJUST,12\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,5\nGOTO/0,0,0\n\
                CUTCOM/LEFT,5\nGOTO/10,0,0\nCUTCOM/OFF\nGOTO/20,0,0";
    let (_, warnings) = posted("generic-3axis-sinumerik", path);
    assert_eq!(warnings.iter().filter(|rule| **rule == "register").count(), 2, "{warnings:?}");
    let (blocks, warnings) = posted(LINUXCNC, path);
    assert!(!warnings.contains(&"register"), "{warnings:?}");
    stands(&blocks, &["G43 Z5 H12", "G1 Z0 F300", "G41 D5 X10", "G40 X20"]);
}

#[test]
fn grbl_has_no_optional_stop_and_says_so() {
    let path = "RAPID\nGOTO/0,0,5\nOPSTOP\nGOTO/0,0,0\nRAPID\nGOTO/0,0,5\nOPSTOP";
    let stops = |machine: &str| {
        let (text, warnings) =
            written(machine, path).unwrap_or_else(|errors| panic!("{}", errors[0]));
        let stops = text.lines().filter(|block| *block == "M1").count();
        (stops, warnings.iter().map(|found| found.rule.name()).collect::<Vec<_>>())
    };
    assert_eq!(stops("generic-3axis-grbl"), (0, vec!["optional-stop"]));
    assert_eq!(stops(LINUXCNC), (2, vec![]));
}

#[test]
fn what_cannot_be_said_is_refused_with_the_way_out() {
    let dwell = "RAPID\nGOTO/0,0,5\nDELAY/0.0004\nGOTO/0,0,0";
    assert_eq!(refused(LINUXCNC, dwell), ("dwell", 7));
    let through = "COOLNT/THRU\nRAPID\nGOTO/0,0,5\nGOTO/0,0,0";
    assert_eq!(refused(LINUXCNC, through), ("missing-block", 8));
}

#[test]
fn a_long_text_is_cut_to_the_line_of_the_control() {
    let text = "A".repeat(300);
    let path = format!(
        "LOAD/TOOL,2\nTPRINT/{text}\nPPRINT/{text}\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,5"
    );
    let (program, _) = written("generic-3axis-grbl", &path).unwrap_or_else(|e| panic!("{}", e[0]));
    assert!(program.lines().all(|line| line.len() <= 70), "{program}");
    assert!(program.contains(&("A".repeat(43) + "...")), "{program}");
}

/// A chord of a few micrometres swings a nearly full arc about: it is written as lines, and proven.
#[test]
fn an_arc_that_rounding_would_swing_is_made_of_lines() {
    let arc = |x: f64, y: f64| {
        format!("RAPID\nGOTO/{x},{y},5\nGOTO/{x},{y},0\nCIRCLE/0,0,0,0,0,1,100\nGOTO/100,0,0")
    };
    let angle = 0.000_04f64;
    let path = arc(100.0 * angle.cos(), 100.0 * angle.sin());
    written(LINUXCNC, &path).unwrap_or_else(|errors| panic!("{}", errors[0]));
}

/// From a lean of 30 degrees to upright, and on to a lean in another direction: on the upright tool the
/// free axis turns by itself. A step of 90 degrees is split.
#[test]
fn the_tool_does_not_swing_out_of_its_way() {
    let path = "MULTAX/ON\nRAPID\nGOTO/0,0,50,0,-0.5,0.8660254\nGOTO/0,0,20\nGOTO/0,10,20,0,0,1\n\
                GOTO/0,20,20,0.5,0,0.8660254\nGOTO/0,30,20,0,1,0";
    let (blocks, warnings) = posted("fanuc-table-bc", path);
    assert!(warnings.contains(&"sweep"), "{warnings:?}");
    let words: Vec<&str> =
        blocks.iter().map(|block| block.split_once(' ').map_or("", |b| b.1)).collect();
    let upright = words.iter().position(|block| *block == "Y10. B0.").unwrap();
    assert_eq!(words[upright + 1..upright + 3], ["C180.", "Y20. B-30."], "{blocks:#?}");
    let parts = words.iter().filter(|block| block.starts_with("Y2")).count();
    assert!(parts >= 8, "{blocks:#?}");
}
