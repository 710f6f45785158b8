//! Cutter compensation, by what the coordinates of the source are and by what the tool table keeps: the path of the tool's
//! centre is not offset by the tool once more, and a contour is.

use machine::{Machine, load, load_text};
use program::{CompensatedPath, Compensation, Feed, Op, Program, Tool};
use proof::Report;
use source::apt::Options;
use std::path::Path;
use std::process::Command;

const CONTROLS: [&str; 4] = [
    "generic-3axis-sinumerik",
    "generic-3axis-heidenhain",
    "generic-3axis-fanuc",
    "generic-3axis-linuxcnc",
];

fn read(path: &Path) -> Program {
    let text = std::fs::read(path).unwrap();
    source::apt::read("part.apt", &text, &Options::default()).unwrap().program
}

/// A tool of 10 mm along two walls, with a way in of radius 2 towards the tool.
fn centre() -> Program {
    let text = "UNITS/MM\nCUTTER/10,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,-5,5\nFEDRAT/300,MMPM\n\
                GOTO/0,-5,-1\nCUTCOM/LEFT\nGOTO/10,0,-1\nCIRCLE/10,2,-1,0,0,1,2\nGOTO/12,2,-1\nGOTO/12,30,-1\n\
                GOTO/-9,30,-1\nCUTCOM/OFF\nGOTO/-9,20,-1\nRAPID\nGOTO/-9,20,5\nFINI\n";
    source::apt::read("part.apt", text.as_bytes(), &Options::default()).unwrap().program
}

/// The machine with this in its `[settings]`.
fn keeping(machine: &str, table: Option<&str>) -> Machine {
    let mut loaded = load(machine).unwrap();
    loaded.settings.tool_radius = match table {
        None => None,
        Some(table) => {
            let text = format!("extends = \"{machine}\"\n[settings]\ntool_radius = \"{table}\"\n");
            load_text("m.toml", &text).unwrap().settings.tool_radius
        }
    };
    loaded
}

/// The proven program and the rules of its warnings, or the rule of the refusal.
fn posted(
    source: &Program,
    machine: &Machine,
) -> Result<(String, Vec<&'static str>), &'static str> {
    let output = post::write(source, machine).map_err(|found| found[0].rule.name())?;
    let report = proof::prove(source, machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    let text = String::from_utf8(output.text).unwrap();
    Ok((text, output.warnings.iter().map(|found| found.rule.name()).collect()))
}

/// Whether a block switches compensation on.
fn compensates(text: &str) -> bool {
    let on = |word: &str| ["G41", "G42", "RL", "RR"].contains(&word);
    text.lines().any(|line| !line.contains('(') && line.split(' ').any(on))
}

#[test]
fn the_path_of_the_centre_is_written_without_compensation() {
    for name in CONTROLS.into_iter().chain(["generic-3axis-grbl", "generic-3axis-haas"]) {
        for table in [Some("full"), None] {
            let (text, warnings) = posted(&centre(), &keeping(name, table)).unwrap();
            assert!(!compensates(&text), "{name}: {text}");
            assert!(warnings.contains(&"compensated-path"), "{name}");
        }
    }
}

#[test]
fn the_path_of_the_centre_is_compensated_for_wear_where_the_table_keeps_wear() {
    for name in CONTROLS {
        let (text, warnings) = posted(&centre(), &keeping(name, Some("wear"))).unwrap();
        assert!(compensates(&text), "{name}: {text}");
        assert!(!warnings.contains(&"compensated-path"), "{name}");
    }
}

#[test]
fn a_contour_is_compensated_only_where_the_table_is_known_to_keep_the_radius() {
    let mut contour = centre();
    // A tool of 2 mm could cut it.
    for record in &mut contour.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.diameter = Some(2.0);
        }
    }
    contour.compensated_path = Some(CompensatedPath::Contour);
    for name in CONTROLS {
        assert!(compensates(&posted(&contour, &keeping(name, Some("full"))).unwrap().0), "{name}");
        for table in [Some("wear"), None] {
            let machine = keeping(name, table);
            assert_eq!(posted(&contour, &machine), Err("compensated-path"), "{name} {table:?}");
            // The judge does not take it either.
            let text = posted(&contour, &keeping(name, Some("full"))).unwrap().0;
            let report =
                proof::prove(&contour, &machine, "p", text.as_bytes(), &Default::default());
            assert_eq!(report.mismatches[0].rule.name(), "compensated-path", "{name} {table:?}");
        }
    }
}

#[test]
fn where_nothing_shows_which_path_it_is_nothing_is_written() {
    let unknown = Program { compensated_path: None, ..centre() };
    for name in CONTROLS {
        let found = post::write(&unknown, &load(name).unwrap()).unwrap_err();
        assert_eq!(found[0].rule.name(), "compensated-path");
        assert!(found[0].help.contains("--cutcom centre"), "{}", found[0].help);
        let text = posted(&centre(), &load(name).unwrap()).unwrap().0;
        let report =
            proof::prove(&unknown, &load(name).unwrap(), "p", text.as_bytes(), &Default::default());
        assert_eq!(report.mismatches[0].rule.name(), "compensated-path");
    }
}

/// The program that was written before: with `G41`, so that the control offsets the path of the centre by the radius in its
/// table once more.
#[test]
fn a_centre_path_that_is_offset_once_more_is_refused() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    let real = read(&folder.join("Teflon-gasket.apt"));
    for source in [centre(), real] {
        for name in CONTROLS {
            let doubled = posted(&source, &keeping(name, Some("wear"))).unwrap().0;
            for table in [Some("full"), None] {
                let machine = keeping(name, table);
                let report =
                    proof::prove(&source, &machine, "p", doubled.as_bytes(), &Default::default());
                assert_eq!(report.mismatches[0].rule.name(), "compensation", "{name}");
                assert!(report.mismatches[0].message.contains("once more"), "{name}");
            }
        }
    }
}

#[test]
fn the_real_files_of_solidworks_are_written_as_paths_of_the_centre() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    let mut made = 0;
    for file in [
        "Dem-target2.apt",
        "Interface-glue.apt",
        "SupPetriLED.apt",
        "Teflon-gasket.apt",
        "Top-light-cover.apt",
        "basemach.apt",
    ] {
        let source = read(&folder.join(file));
        for name in CONTROLS {
            let (text, _) = posted(&source, &load(name).unwrap()).unwrap();
            assert!(!compensates(&text), "{file} {name}");
            let wear = posted(&source, &keeping(name, Some("wear"))).unwrap().0;
            assert!(compensates(&wear), "{file} {name}");
            made += 2;
        }
    }
    assert_eq!(made, 48);
}

/// A contour with a tool of 10 mm on its left: into an inner corner of the way in, around an outer one of 90°, into one, around
/// one of 90° and one of 135°, into one, around a convex arc of radius 8, into a concave one of radius 9, and out.
fn contour() -> Program {
    let text = "UNITS/MM\nCUTTER/10,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/-20,-10,5\nFEDRAT/300,MMPM\n\
                GOTO/-20,-10,-3\nCUTCOM/LEFT\nGOTO/0,-10,-3\nGOTO/0,40,-3\nGOTO/20,40,-3\nGOTO/20,60,-3\n\
                GOTO/40,60,-3\nGOTO/28,48,-3\nGOTO/44,32,-3\nCIRCLE/38.343,26.343,-3,0,0,-1,8\nGOTO/44,20.686,-3\n\
                CIRCLE/50.364,14.322,-3,0,0,1,9\nGOTO/44,7.958,-3\nGOTO/60,-8.042,-3\nCUTCOM/OFF\nGOTO/80,-8,-3\n\
                RAPID\nGOTO/80,-8,5\nFINI\n";
    let options = Options { cutcom: Some(CompensatedPath::Contour), ..Options::default() };
    source::apt::read("part.apt", text.as_bytes(), &options).unwrap().program
}

fn report(source: &Program, machine: &Machine, text: &str) -> Report {
    proof::prove(source, machine, "p", text.as_bytes(), &Default::default())
}

/// The rules of what the proof finds in the program of `source` on each control. It is written with tools whose radius the source
/// does not say, since the writer would refuse it.
fn found(source: &Program) -> Vec<&'static str> {
    let mut unknown = source.clone();
    for record in &mut unknown.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.diameter = None;
        }
    }
    let prove = |name: &&str| {
        let machine = load(name).unwrap();
        let output = post::write(&unknown, &machine).unwrap_or_else(|found| panic!("{}", found[0]));
        let report = proof::prove(source, &machine, "p", &output.text, &Default::default());
        report.mismatches.first().map_or("proven", |found| found.rule.name())
    };
    CONTROLS.iter().map(prove).collect()
}

/// Line and rule of what the writer refuses on each control, with a way out; what it writes is proven.
fn refused(source: &Program) -> Vec<(u32, &'static str)> {
    let post = |name: &&str| {
        let machine = load(name).unwrap();
        match post::write(source, &machine) {
            Ok(output) => {
                let report = proof::prove(source, &machine, "p", &output.text, &Default::default());
                assert!(report.proven, "{name}: {:?}", report.mismatches);
                (0, "proven")
            }
            Err(found) => {
                assert!(!found[0].help.is_empty(), "{}", found[0]);
                (found[0].line, found[0].rule.name())
            }
        }
    };
    CONTROLS.iter().map(post).collect()
}

#[test]
fn the_control_leads_the_centre_of_the_tool_along_the_contour() {
    for name in CONTROLS {
        let machine = load(name).unwrap();
        let text = posted(&contour(), &machine).unwrap().0;
        let report = report(&contour(), &machine, &text);
        assert_eq!((report.compared.contours, report.warnings.len()), (1, 0), "{name}");
    }
}

/// As a contour no control can cut the arc of radius 2 with a tool of radius 5. It was proven before, since the contour was compared as
/// programmed alone.
#[test]
fn a_contour_that_the_control_refuses_with_the_tool_is_not_proven() {
    let doubled = Program { compensated_path: Some(CompensatedPath::Contour), ..centre() };
    assert_eq!(found(&doubled), ["compensation-arc-radius"; 4]);
    assert_eq!(refused(&doubled), [(12, "compensation-arc-radius"); 4]);
    // A step of 3 mm, which is shorter than the radius.
    let mut step = contour();
    let up = step.records.iter_mut().filter_map(|record| match &mut record.op {
        Op::Line(pose) => Some(pose),
        _ => None,
    });
    for pose in up.filter(|pose| pose.point().y == 60.0) {
        *pose = pose.at(pose.point().with_y(43.0)).unwrap();
    }
    assert!(found(&step).iter().all(|rule| *rule != "proven"), "{:?}", found(&step));
    assert_eq!(refused(&step), [(13, "compensation-inner-corner"); 4]);
}

/// Chords of 0.04 rad around an island of radius 30. LinuxCNC joins them without a corner, which cuts 1 - cos 0.04 = 0.0008 radii into each
/// joint: 0.004 mm with a tool of radius 5, 0.02 mm with one of radius 25. The machine file allows 0.01 at corners.
#[test]
fn linuxcnc_cuts_into_flat_corners_and_a_large_tool_too_deep() {
    let with = |radius: f64| {
        let mut source = contour();
        let first =
            source.records.iter().position(|record| matches!(record.op, Op::Compensation(_)));
        let last =
            source.records.iter().rposition(|record| matches!(record.op, Op::Compensation(_)));
        let (first, last) = (first.unwrap() + 1, last.unwrap());
        let line = source.records[first].line;
        let around = (0..=40).map(|i| {
            let angle = std::f64::consts::PI - 0.04 * f64::from(i);
            [30.0 * angle.cos() + 80.0, 30.0 * angle.sin() - 10.0]
        });
        let points = std::iter::once([50.0, -60.0]).chain(around).map(|[x, y]| {
            let pose = program::Pose::upright(geom::Vec3::new(x, y, -3.0)).unwrap();
            program::Record { line, op: Op::Line(pose) }
        });
        source.records.splice(first..last, points);
        let source = moved(source, [-20.0, -10.0], [-10.0, -60.0]);
        let mut source = moved(source, [80.0, -8.0], [120.0, 60.0]);
        for record in &mut source.records {
            if let Op::Tool(tool) = &mut record.op {
                tool.diameter = Some(2.0 * radius);
            }
        }
        (found(&source), refused(&source).into_iter().map(|(_, rule)| rule).collect::<Vec<_>>())
    };
    assert_eq!(with(5.0), (vec!["proven"; 4], vec!["proven"; 4]));
    let (found, refused) = with(25.0);
    assert_eq!(found, ["proven", "proven", "proven", "compensation"]);
    assert_eq!(refused, ["proven", "proven", "proven", "compensation-gouge"]);
}

/// The source asks for register 2, which is the radius of another tool: 3 mm in place of 5.
#[test]
fn a_register_that_holds_the_radius_of_another_tool_is_not_proven() {
    let mut source = contour();
    for record in &mut source.records {
        if let Op::Compensation(Compensation::Left(register)) = &mut record.op {
            *register = Some(2);
        }
    }
    let other = Tool { number: 2, diameter: Some(6.0), ..Tool::default() };
    let end = source.records.len() - 1;
    source.records.insert(end, program::Record { line: 1, op: Op::Tool(Box::new(other)) });
    for name in ["generic-3axis-linuxcnc", "generic-3axis-fanuc"] {
        let machine = load(name).unwrap();
        let found = post::write(&source, &machine).unwrap_err();
        assert_eq!((found[0].rule.name(), found[0].line), ("compensation", 10), "{name}");
        let text = posted(&contour(), &machine).unwrap().0;
        assert!(text.contains("D1 "), "{text}");
        let report = report(&source, &machine, &text.replacen("D1 ", "D2 ", 1));
        assert_eq!(report.mismatches[0].rule.name(), "compensation", "{name}");
        assert!(report.mismatches[0].message.contains("radius of 5 mm"), "{:?}", report.mismatches);
    }
}

/// Two blocks without a move in the contour are more than a FANUC sees past: it would cut the corner.
#[test]
fn a_contour_past_whose_blocks_the_control_does_not_see_is_not_proven() {
    let mut source = contour();
    let at = source
        .records
        .iter()
        .position(|record| matches!(&record.op, Op::Line(pose) if pose.point().y == 60.0));
    for seconds in [1.0, 2.0, 3.0, 4.0] {
        let line = source.records[at.unwrap()].line;
        source.records.insert(at.unwrap() + 1, program::Record { line, op: Op::Dwell(seconds) });
    }
    let rules = found(&source);
    // SINUMERIK sees past three, FANUC past one; the others read on.
    assert_eq!(rules, ["compensation-look-ahead", "proven", "compensation-look-ahead", "proven"]);
    let too_many = (14, "compensation-look-ahead");
    assert_eq!(refused(&source), [too_many, (0, "proven"), too_many, (0, "proven")]);
}

/// The source with its moves from one place to another in the plane.
fn moved(mut source: Program, [x, y]: [f64; 2], to: [f64; 2]) -> Program {
    for record in &mut source.records {
        if let Op::Rapid(pose) | Op::Line(pose) = &mut record.op
            && (pose.point().x, pose.point().y) == (x, y)
        {
            *pose = pose.at(pose.point().with_x(to[0]).with_y(to[1])).unwrap();
        }
    }
    source
}

/// From the other side of the contour: LinuxCNC goes around its first point, as its first move counts as an element; the others would
/// go through.
#[test]
fn a_way_in_through_the_contour_is_not_proven() {
    let rules = found(&moved(contour(), [-20.0, -10.0], [10.0, 15.0]));
    assert_eq!(rules, ["compensation-gouge", "compensation-gouge", "compensation-gouge", "proven"]);
    let through = (11, "compensation-gouge");
    let refused = refused(&moved(contour(), [-20.0, -10.0], [10.0, 15.0]));
    assert_eq!(refused, [through, through, through, (0, "proven")]);
}

/// To the other side: LinuxCNC does not look, and the judge sees it.
#[test]
fn a_way_out_through_the_contour_is_not_proven() {
    let rules = found(&moved(contour(), [80.0, -8.0], [45.0, -5.0]));
    assert_eq!(
        rules,
        ["compensation-gouge", "compensation-gouge", "compensation-gouge", "compensation"]
    );
    let refused = refused(&moved(contour(), [80.0, -8.0], [45.0, -5.0]));
    assert_eq!(refused, [(23, "compensation-gouge"); 4]);
}

/// From the end of a wall round 335° of a bore of radius 12 mm: 1.1 mm from the place from where the tool comes. Elements are looked at
/// with those on both sides of them.
#[test]
fn a_contour_that_comes_back_to_the_element_before_is_refused_by_the_writer_and_by_the_proof() {
    let text = "UNITS/MM\nCUTTER/10,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/-30,-30,5\nFEDRAT/300,MMPM\n\
                GOTO/-30,-30,-3\nCUTCOM/LEFT\nGOTO/0,-20,-3\nGOTO/0,0,-3\nCIRCLE/0,12,-3,0,0,1,12\nGOTO/-5,1.091,-3\n\
                CUTCOM/OFF\nGOTO/0,14,-3\nRAPID\nGOTO/0,14,5\nFINI\n";
    let options = Options { cutcom: Some(CompensatedPath::Contour), ..Options::default() };
    let source = source::apt::read("part.apt", text.as_bytes(), &options).unwrap().program;
    assert_eq!(refused(&source), [(13, "compensation-inner-corner"); 4]);
    assert_eq!(found(&source), ["compensation"; 4]);
}

/// The time of each block is that of the contour, and corners add moves: the feed goes in mm/min. With the times of the source no
/// control takes it.
#[test]
fn a_contour_in_inverse_time_is_written_with_its_feed_in_mm_per_minute() {
    let mut source = contour();
    for record in &mut source.records {
        if let Op::Feed(feed) = &mut record.op {
            *feed = Feed::InverseTime(6.0);
        }
    }
    for name in CONTROLS {
        let (text, warnings) = posted(&source, &load(name).unwrap()).unwrap();
        // The wall from Y -10 to 40 in a sixth of a minute.
        assert!(text.contains("F300"), "{name}: {text}");
        assert!(warnings.contains(&"feed-inverse-time"), "{name}: {warnings:?}");
        assert!(!text.contains("G93 G1 G41"), "{name}: {text}");
    }
}

/// From the wall's left to its right side.
#[test]
fn compensation_that_changes_its_side_in_the_cut_is_refused() {
    let mut source = contour();
    let at = source
        .records
        .iter()
        .position(|record| matches!(&record.op, Op::Line(pose) if pose.point().y == 60.0))
        .unwrap();
    let line = source.records[at].line;
    let op = Op::Compensation(Compensation::Right(None));
    source.records.insert(at, program::Record { line, op });
    assert_eq!(refused(&source), [(line, "compensation-change"); 4]);
}

/// In a plane other than XY the control would not offset: such an arc is written as lines.
#[test]
fn an_arc_in_another_plane_goes_as_lines_while_the_control_offsets() {
    let text = "UNITS/MM\nCUTTER/10,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/-30,-30,5\nFEDRAT/300,MMPM\n\
                GOTO/-30,-30,-3\nCUTCOM/LEFT\nGOTO/0,-20,-3\nGOTO/0,0,-3\nCIRCLE/0,10,-3,1,0,0,10\nGOTO/0,10,-13\nGOTO/0,40,-13\n\
                CUTCOM/OFF\nGOTO/-20,60,-13\nRAPID\nGOTO/-20,60,5\nFINI\n";
    let options = Options { cutcom: Some(CompensatedPath::Contour), ..Options::default() };
    let source = source::apt::read("part.apt", text.as_bytes(), &options).unwrap().program;
    assert_eq!(refused(&source), [(0, "proven"); 4]);
}

/// A tool of 40 mm on a way in of 20 mm: LinuxCNC wants more, the others only where the tool comes from.
#[test]
fn a_way_in_that_is_shorter_than_the_radius_is_refused_where_the_control_needs_more() {
    let mut source = centre();
    source.compensated_path = Some(CompensatedPath::Contour);
    source.records.retain(|record| !matches!(record.op, Op::Arc(_)));
    let refused = refused(&source);
    assert_eq!(refused, [(0, "proven"); 4]);
    let short = moved(source, [0.0, -5.0], [6.0, 0.0]);
    assert_eq!(self::refused(&short)[3], (10, "compensation-entry"));
    assert_eq!(found(&short)[3], "compensation-entry");
}

#[test]
fn where_the_radius_is_not_known_the_proof_says_that_the_contour_is_compared_as_programmed() {
    let mut source = contour();
    for record in &mut source.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.diameter = None;
        }
    }
    for name in CONTROLS.into_iter().chain(["generic-3axis-haas", "generic-3axis-mach3"]) {
        // How Haas and Mach3 lead the tool has no source.
        let machine = load(name).unwrap();
        let text = posted(&source, &machine).unwrap().0;
        let report = report(&source, &machine, &text);
        assert_eq!(report.compared.contours, 0);
        assert_eq!(report.warnings[0].rule.name(), "compensation-open", "{name}");
    }
}

/// With the wear of new tools, which is 0, each of the real paths comes out as it is in the file.
#[test]
fn the_real_files_of_solidworks_are_led_along_the_path_of_the_centre() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    let mut contours = 0;
    let five = ["fanuc-table-bc", "sinumerik-840d-traori", "dmu50-heidenhain"];
    for (file, stretches) in [
        ("Dem-target2.apt", 33),
        ("Interface-glue.apt", 10),
        ("Sacrifice-Board.apt", 42),
        ("SupPetriLED.apt", 13),
        ("Teflon-gasket.apt", 15),
        ("Teste-Metrologia.apt", 8),
        ("Top-light-cover.apt", 22),
        ("basemach.apt", 62),
        ("shimemcunha.apt", 4),
    ] {
        let source = read(&folder.join(file));
        for name in CONTROLS.iter().chain(&five) {
            for table in ["full", "wear"] {
                let machine = keeping(name, Some(table));
                let output = match post::write(&source, &machine) {
                    Ok(output) => output,
                    Err(found) => {
                        let tilted = ["unreachable-orientation", "axis-limit"];
                        assert!(
                            tilted.contains(&found[0].rule.name()),
                            "{file} {name}: {}",
                            found[0]
                        );
                        continue;
                    }
                };
                let report =
                    proof::prove(&source, &machine, "p", &output.text, &Default::default());
                let first = report.mismatches.first().map(ToString::to_string);
                assert!(report.proven, "{file} {name} {table}: {first:?}");
                let compared = if table == "wear" { stretches } else { 0 };
                assert_eq!(report.compared.contours, compared, "{file} {name} {table}");
                contours += report.compared.contours;
            }
        }
    }
    // Six files with an upright tool on seven machines, and two of the three that tilt it on three.
    assert_eq!(contours, 155 * 7 + 12 * 3);
}

/// The moves of the tool's centre that LinuxCNC's own interpreter makes of a program, with tool 1 of this diameter, as chords (mm).
fn rs274(program: &str, diameters: &[(u32, f64)]) -> Option<Result<Vec<[f64; 3]>, String>> {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    // Alone, rs274 counts the table in inches.
    let row =
        |(tool, diameter): &(u32, f64)| format!("T{tool} P{tool} Z1 D{:.12}\n", diameter / 25.4);
    let table: String = diameters.iter().map(row).collect();
    for (name, text) in [("tool.tbl", table.as_str()), ("rs274.var", ""), ("p.ngc", program)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let output = Command::new("rs274")
        .args(["-t", "tool.tbl", "-v", "rs274.var", "-g", "p.ngc"])
        .env("HOME", folder.path())
        .current_dir(folder.path())
        .output()
        .unwrap();
    if !output.status.success() {
        return Some(Err(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    let mut points: Vec<[f64; 3]> = vec![[0.0; 3]];
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let Some((name, arguments)) = line.split_once('(') else { continue };
        let number = |text: &str| text.trim().parse().ok();
        let n: Vec<f64> = arguments.trim_end_matches(')').split(',').filter_map(number).collect();
        match name.rsplit(' ').next().unwrap() {
            "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" => points.push([n[0], n[1], n[2]]),
            "ARC_FEED" => {
                let [x, y, z] = *points.last().unwrap();
                let (start, end) = ((y - n[3]).atan2(x - n[2]), (n[1] - n[3]).atan2(n[0] - n[2]));
                let radius = (y - n[3]).hypot(x - n[2]);
                let turn = std::f64::consts::TAU;
                let sweep = match n[4] > 0.0 {
                    true => (end - start).rem_euclid(turn),
                    false => -(start - end).rem_euclid(turn),
                };
                for i in 1..=200 {
                    let t = f64::from(i) / 200.0;
                    let angle = start + sweep * t;
                    points.push([
                        n[2] + radius * angle.cos(),
                        n[3] + radius * angle.sin(),
                        z + (n[5] - z) * t,
                    ]);
                }
            }
            _ => {}
        }
    }
    Some(Ok(points))
}

/// How far a point is from a way of chords, mm, in the plane.
fn away(chords: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let to = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let (dx, dy) = (bx - ax, by - ay);
        let squared = dx * dx + dy * dy;
        let t = if squared > 0.0 { ((x - ax) * dx + (y - ay) * dy) / squared } else { 0.0 };
        let t = t.clamp(0.0, 1.0);
        (x - ax - t * dx).hypot(y - ay - t * dy)
    };
    chords.windows(2).map(to).fold(f64::INFINITY, f64::min)
}

/// Points every 0.1 mm or so along chords.
fn dense(chords: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let between = |pair: &[[f64; 2]]| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let steps = ((bx - ax).hypot(by - ay) / 0.1).ceil().max(1.0) as u32;
        (0..=steps).map(move |i| {
            let t = f64::from(i) / f64::from(steps);
            [ax + t * (bx - ax), ay + t * (by - ay)]
        })
    };
    chords.windows(2).flat_map(between).collect()
}

/// The contour, arcs as chords: by hand from `contour()`.
fn by_hand() -> Vec<[f64; 2]> {
    let arc = |[x, y]: [f64; 2], radius: f64, from: f64, sweep: f64| {
        (0..=200).map(move |i| {
            let angle = (from + sweep * f64::from(i) / 200.0).to_radians();
            [x + radius * angle.cos(), y + radius * angle.sin()]
        })
    };
    let lines = [
        [0.0, -10.0],
        [0.0, 40.0],
        [20.0, 40.0],
        [20.0, 60.0],
        [40.0, 60.0],
        [28.0, 48.0],
        [44.0, 32.0],
    ];
    let arcs =
        arc([38.343, 26.343], 8.0, 45.0, -90.0).chain(arc([50.364, 14.322], 9.0, 135.0, 90.0));
    lines.into_iter().chain(arcs).chain([[60.0, -8.042]]).collect()
}

/// LinuxCNC itself leads a tool of radius 5 along the contour at 5 mm; and of a path of the centre written as before, with `G41` and
/// the full radius in its table, it makes nothing.
#[test]
fn linuxcnc_leads_the_tool_at_its_radius_along_the_contour() {
    let machine = load("generic-3axis-linuxcnc").unwrap();
    let text = posted(&contour(), &machine).unwrap().0;
    let Some(path) = rs274(&text, &[(1, 10.0)]) else { return };
    let low: Vec<[f64; 2]> =
        path.unwrap().into_iter().filter(|[_, _, z]| *z < -2.9).map(|[x, y, _]| [x, y]).collect();
    let contour = by_hand();
    let near =
        dense(&low).into_iter().map(|point| away(&contour, point)).fold(f64::INFINITY, f64::min);
    assert!((near - 5.0).abs() < 0.003, "the tool comes as near as {near} mm");
    // Every point of the contour is cut, but for inner corners that the round tool does not reach.
    let far = |[x, y]: &[f64; 2]| {
        let inner = [[0.0, -10.0], [20.0, 40.0], [28.0, 48.0]];
        inner.iter().all(|[cx, cy]| (x - cx).hypot(y - cy) > 13.0)
    };
    let left =
        dense(&contour).into_iter().filter(far).map(|point| away(&low, point)).fold(0.0, f64::max);
    assert!((left - 5.0).abs() < 0.003, "the contour is as far as {left} mm from the path");

    let doubled = posted(&centre(), &keeping("generic-3axis-linuxcnc", Some("wear"))).unwrap().0;
    let refused = rs274(&doubled, &[(1, 10.0)]).unwrap();
    assert!(refused.is_err(), "{refused:?}");
    // With a wear of 0 it is the path of the source.
    let path = rs274(&doubled, &[(1, 0.0)]).unwrap().unwrap();
    let plain = posted(&centre(), &machine).unwrap().0;
    assert_eq!(path, rs274(&plain, &[(1, 10.0)]).unwrap().unwrap());
}

/// The same of the real files: with `G41` and wear of 0 in its table LinuxCNC makes the moves that it makes of the program without
/// compensation, and with the full radius, as before, it makes nothing of any.
#[test]
fn linuxcnc_refuses_the_real_files_as_they_were_written_before() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    for file in [
        "Dem-target2.apt",
        "Interface-glue.apt",
        "SupPetriLED.apt",
        "Teflon-gasket.apt",
        "Top-light-cover.apt",
        "basemach.apt",
    ] {
        let source = read(&folder.join(file));
        let tools = source.records.iter().filter_map(|record| match &record.op {
            Op::Tool(tool) => Some((tool.number, tool.diameter.unwrap_or(0.0))),
            _ => None,
        });
        let full: std::collections::BTreeMap<u32, f64> = tools.collect();
        let table =
            |keeps: f64| full.iter().map(|(tool, d)| (*tool, d * keeps)).collect::<Vec<_>>();
        let machine = "generic-3axis-linuxcnc";
        let [plain, wear] =
            ["full", "wear"].map(|kept| posted(&source, &keeping(machine, Some(kept))).unwrap().0);
        let Some(plain) = rs274(&plain, &table(1.0)) else { return };
        let mut plain = plain.unwrap();
        let mut led = rs274(&wear, &table(0.0)).unwrap().unwrap();
        plain.dedup();
        led.dedup();
        assert_eq!(plain.len(), led.len(), "{file}");
        let apart = |(a, b): (&[f64; 3], &[f64; 3])| {
            (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
        };
        let most = plain.iter().zip(&led).map(apart).fold(0.0, f64::max);
        assert!(most < 1e-3, "{file}: {most} mm");
        assert!(rs274(&wear, &table(1.0)).unwrap().is_err(), "{file}");
    }
}
