//! From home to the part: where the control keeps the tool tip, X, Y and Z count on the part, and with a tilted table or
//! head a word of X or Y moves Z of the machine. The way from home is proven in the machine, at the first approach and at
//! every return.

use crate::files::root;
use machine::{Machine, load, load_text};
use program::{Diagnostic, Op, Program, WorkOffset};

fn read(text: &str) -> Program {
    let read = source::apt::read("job.cls", text.as_bytes(), &Default::default());
    read.unwrap_or_else(|found| panic!("{found:?}")).program
}

fn sample() -> Program {
    read(&std::fs::read_to_string(root().join("machines/samples/five-axes.cls")).unwrap())
}

fn written(source: &Program, machine: &Machine) -> String {
    let output = post::write(source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    String::from_utf8(output.text).unwrap()
}

fn found(source: &Program, machine: &Machine, text: &str) -> Vec<Diagnostic> {
    proof::prove(source, machine, "p", text.as_bytes(), &Default::default()).mismatches
}

#[track_caller]
fn proven(source: &Program, machine: &Machine, text: &str) {
    let found = found(source, machine, text);
    assert!(found.is_empty(), "{found:#?}\n{text}");
}

/// The rule that a program breaks first, and its line in the text.
#[track_caller]
fn refused(source: &Program, machine: &Machine, text: &str) -> (&'static str, String) {
    let found = found(source, machine, text);
    let first = found.first().unwrap_or_else(|| panic!("proven:\n{text}"));
    (first.rule.name(), text.lines().nth(first.line as usize - 1).unwrap_or_default().to_owned())
}

/// A trunnion: A tilts the table about X through Z -100, C turns on it. Work zero is the zero of the machine, the spindle
/// is home at Z 400.
fn trunnion(control: &str, more: &str) -> Machine {
    let text = format!(
        "extends = \"{control}\"\nsafe_height = 400\nwork_zero = [0, 0, 0]\n[settings]\n{more}\n[orientation]\n\
         simultaneous = \"tool-center-angles\"\npositioned = \"tool-center-angles\"\ntolerance = 0.01\n[axes]\n\
         X = {{ min = -400, max = 400, rapid = 20000, acceleration = 3 }}\n\
         Y = {{ min = -400, max = 400, rapid = 20000, acceleration = 3 }}\n\
         Z = {{ min = -400, max = 400, rapid = 20000, acceleration = 3 }}\n\
         [[rotary]]\nletter = \"A\"\non = \"table\"\naxis = [1, 0, 0]\npoint = [0, 0, -100]\nsign = -1\nmin = -30\nmax = 120\n\
         rapid = 9000\nacceleration = 300\nmodulo = false\n\
         [[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\npoint = [0, 0, 0]\nsign = -1\nmin = -360\nmax = 360\n\
         rapid = 9000\nacceleration = 300\nmodulo = false\n"
    );
    load_text("trunnion.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// `G43.4` stands in a block of its own there, which a control whose lengths move the coordinates lets it.
fn fanuc() -> Machine {
    let settings = "table_frame_at_zero = true\nrotary_by_sign = false\nlength_moves_axis = false\nlength_along_z = true\nrapid_path = \"linear\"\n\
                    [blocks]\ntool_center_on = \"{{N}} G43.4 {{H}}\"";
    trunnion("fanuc-31i", settings)
}

/// As the library has it: `G43.4` begins with the first position.
fn fanuc_by_position(length_moves_axis: &str) -> Machine {
    let settings = format!(
        "table_frame_at_zero = true\nrotary_by_sign = false\n{length_moves_axis}length_along_z = true\nrapid_path = \"linear\""
    );
    trunnion("fanuc-31i", &settings)
}

/// Parameter 5006#6 (B-63943EN-1 p. 1654): where it is 0 a length that begins moves Z by itself, at home beyond its end, or, with
/// lengths that count down from home, onto the part. A machine file that says so, or does not say it, gets no such block.
#[test]
fn a_length_begins_with_a_position_above_all_cuts() {
    let source = read(LEDGE);
    for setting in ["", "length_moves_axis = true\n", "length_moves_axis = false\n"] {
        let machine = fanuc_by_position(setting);
        let good = written(&source, &machine);
        proven(&source, &machine, &good);
        let entry = "G43.4 X0. Y-260. Z20. H1";
        let apart = with(&good, entry, &["G43.4 H1", "X0. Y-260. Z20."]);
        if setting.contains("false") {
            proven(&source, &machine, &apart);
        } else {
            assert_eq!(refused(&source, &machine, &apart), ("length-change", "G43.4 H1".into()));
        }
        // X and Y alone move Z of the machine, and this one says no Z at all.
        let dives = with(&good, entry, &["G43.4 X0. Y-145. H1", "Z20."]);
        assert!(!found(&source, &machine, &dives).is_empty());
    }
    // With the table level too: X, Y and Z together, to 1 mm above all cuts, which begin at 50.
    let upright = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/0,0,-20,0,0,1\n\
         GOTO/0,0,-21\nGOTO/9,0,-21,0,0.1,0.995\nRAPID\nGOTO/9,0,50,0,0.1,0.995\nRAPID\nGOTO/40,0,50\nGOTO/40,0,0\nFINI\n",
    );
    let machine = fanuc_by_position("");
    let good = written(&upright, &machine);
    proven(&upright, &machine, &good);
    assert!(good.contains("G43.4 X0. Y0. Z51.01 H1\n"), "{good}");
}

/// Cuts in the face that looks along -Y: first a ledge at Y -140, then what stands out to Y -200. With A at 90 the table
/// stands upright, -Y is up: Y -200 is at Z 100 of the machine (-Y - 100), and Z of the part is Y of the machine (Z + 100).
const LEDGE: &str = "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n\
    RAPID\nGOTO/0,-145,20,0,-1,0\nGOTO/0,-140,20\nGOTO/30,-140,20\nRAPID\nGOTO/30,-260,20\nRAPID\nGOTO/30,-260,-60\n\
    RAPID\nGOTO/30,-205,-60\nGOTO/30,-200,-60\nGOTO/0,-200,-60\nRAPID\nGOTO/0,-260,-60\nFINI\n";

/// The words of a block behind its number.
fn words(line: &str) -> &str {
    let number = |word: &str| word.trim_start_matches('N').parse::<u32>().is_ok();
    match line.split_once(' ') {
        Some((first, words)) if number(first) => words,
        _ => line,
    }
}

/// A program whose block with these words is replaced; numbers stay as they are.
#[track_caller]
fn with(text: &str, block: &str, others: &[&str]) -> String {
    assert!(text.lines().any(|line| words(line) == block), "no `{block}` in\n{text}");
    let lines = text.lines().flat_map(|line| match words(line) == block {
        true => others.iter().map(|other| (*other).to_owned()).collect(),
        false => vec![line.to_owned()],
    });
    lines.map(|line| line + "\n").collect()
}

#[test]
fn x_and_y_first_dive_next_to_a_part_that_the_table_has_swung_up() {
    let (source, machine) = (read(LEDGE), fanuc());
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
    // All axes together to Y -260, as high as the source ever goes along the tool, then down along it.
    assert!(good.contains("G43.4 H1\n") && good.contains(" X0. Y-260. Z20.\n"), "{good}");
    assert!(good.lines().any(|line| words(line) == "Y-145."), "{good}");
    // From home, tip at Z 300, X0 Y-145 sends Z of the machine to 45 wherever its Y is: 55 mm under what stands at Z 100.
    let dives = with(&good, "X0. Y-260. Z20.", &["X0. Y-145.", "Z20."]);
    let dives = with(&dives, "Y-145.", &[]);
    assert_eq!(refused(&source, &machine, &dives), ("rapid-path", "X0. Y-145.".into()));
    // The same in one block comes down aslant next to what stands out.
    let aslant = with(&good, "X0. Y-260. Z20.", &["X0. Y-145. Z20."]);
    let aslant = with(&aslant, "Y-145.", &[]);
    assert_eq!(refused(&source, &machine, &aslant), ("rapid-path", "X0. Y-145. Z20.".into()));
    // So does one that ends 0.1 mm short of where the source goes highest: a bore may be around it.
    let low = with(&good, "X0. Y-260. Z20.", &["X0. Y-259.9 Z20."]);
    assert_eq!(refused(&source, &machine, &low), ("rapid-path", "X0. Y-259.9 Z20.".into()));
}

/// `TRAORI` and `M128` count on the part as `G43.4` does.
#[test]
fn x_and_y_first_dive_under_traori_and_m128_too() {
    let source = read(LEDGE);
    for (control, entry, then, first, second) in [
        ("sinumerik-840d", "X0 Y-260 Z20", "Y-145", "X0 Y-145", "Z20"),
        (
            "heidenhain-tnc640",
            "L X+0 Y-260 Z+20 R0 FMAX",
            "L Y-145 R0 FMAX",
            "L X+0 Y-145 R0 FMAX",
            "L Z+20 R0 FMAX",
        ),
    ] {
        // Under M128 cycle 32 says how far rotary axes may be off.
        let options = match control {
            "heidenhain-tnc640" => "[options]\norientation_tolerance = 0.05",
            _ => "",
        };
        let machine = trunnion(control, options);
        let good = written(&source, &machine);
        proven(&source, &machine, &good);
        let at =
            good.lines().position(|line| words(line) == entry).unwrap_or_else(|| panic!("{good}"));
        let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
        assert_eq!(words(&lines[at + 1]), then);
        lines[at] = lines[at].replace(entry, first);
        lines[at + 1] = lines[at + 1].replace(then, second);
        let (rule, line) = refused(&source, &machine, &(lines.join("\n") + "\n"));
        assert_eq!((rule, words(&line)), ("rapid-path", first), "{good}");
    }
}

/// Where the axes are put before the control keeps the tip, X and Y count in the machine: Y 120 is Z 20 of the part.
#[test]
fn z_alone_comes_down_where_x_and_y_stand_over_the_place_before_the_tip_is_kept() {
    let (source, machine) = (read(LEDGE), fanuc());
    let good = written(&source, &machine);
    let over = |y: &str| {
        let before = format!("G0 X0. {y}");
        let text = with(&good, "G43.4 H1", &[&before, "G43.4 H1"]);
        with(&with(&text, "X0. Y-260. Z20.", &["X0. Y-145. Z20."]), "Y-145.", &[])
    };
    proven(&source, &machine, &over("Y120."));
    let aside = over("Y119.");
    assert_eq!(refused(&source, &machine, &aside), ("rapid-path", "X0. Y-145. Z20.".into()));
}

#[test]
fn no_axis_turns_at_home_while_the_control_keeps_the_tip() {
    let (source, machine) = (read(LEDGE), fanuc());
    let good = written(&source, &machine);
    let turn = good.lines().find(|line| line.contains("A90. C0.")).map(words).unwrap();
    let late = with(&with(&good, turn, &[]), "G43.4 H1", &["G43.4 H1", "G0 A90. C0."]);
    assert_eq!(refused(&source, &machine, &late), ("rapid-path", "G0 A90. C0.".into()));
}

/// The first approach, and those after a tool change, after home in the source, in another orientation and at another
/// work offset.
#[test]
fn each_return_from_home_is_looked_at_as_the_first_approach_is() {
    let ledge =
        "RAPID\nGOTO/0,-145,20,0,-1,0\nGOTO/0,-140,20\nGOTO/30,-140,20\nRAPID\nGOTO/30,-260,20\n";
    let between = [
        "LOADTL/2,LENGTH,90\nSPINDL/900,RPM,CLW\n",
        "PPRINT/HOME\n",
        "RAPID\nGOTO/0,0,60,0,0,1\nGOTO/0,0,55\nRAPID\nGOTO/0,0,60\n",
        "PPRINT/OFFSET\n",
    ];
    let out = "RAPID\nGOTO/30,-205,-60,0,-1,0\nGOTO/30,-200,-60\nRAPID\nGOTO/30,-260,-60\n";
    let head = "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n";
    let middle = between.map(|between| format!("{ledge}{between}")).concat();
    let (mut source, machine) = (read(&format!("{head}{middle}{ledge}{out}FINI\n")), fanuc());
    for record in &mut source.records {
        match &record.op {
            Op::Comment(text) | Op::Message(text) if text.contains("HOME") => record.op = Op::Home,
            Op::Comment(text) | Op::Message(text) if text.contains("OFFSET") => {
                record.op = Op::WorkOffset(WorkOffset::numbered(55).unwrap());
            }
            _ => {}
        }
    }
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
    let entry = "X0. Y-260. Z20.";
    let is_entry = |line: &str| words(line).trim_start_matches("G0 ") == entry;
    let entries: Vec<usize> =
        (0..).zip(good.lines()).filter(|(_, line)| is_entry(line)).map(|(at, _)| at).collect();
    assert_eq!(entries.len(), 5, "{good}");
    for at in entries {
        let mut lines: Vec<&str> = good.lines().collect();
        assert_eq!(words(lines[at + 1]), "Y-145.");
        lines[at] = "G0 X0. Y-145.";
        lines[at + 1] = "Z20.";
        let rules: Vec<_> = found(&source, &machine, &(lines.join("\n") + "\n"))
            .iter()
            .map(|found| (found.rule.name(), found.line))
            .collect();
        assert_eq!(rules.first(), Some(&("rapid-path", at as u32 + 1)), "{good}");
    }
}

/// A part 420 mm out comes up to Z 320 of the machine; a tool of 100 mm, home at Z 400, hangs down to Z 300.
#[test]
fn home_is_not_above_a_part_that_the_table_swings_up_to_it() {
    let far = LEDGE.replace("-2", "-4").replace("-1", "-3").replace("0,-3,0", "0,-1,0");
    let (source, machine) = (read(&far), fanuc());
    let refusal = post::write(&source, &machine).unwrap_err();
    assert_eq!(refusal[0].rule.name(), "home-height", "{refusal:?}");
    // Written for a machine whose spindle is home 200 mm higher, it is no program for this one.
    let mut higher = fanuc();
    higher.safe_height = Some(600.0);
    higher.linear[2].max = 600.0;
    let text = written(&source, &higher);
    proven(&source, &higher, &text);
    assert!(found(&source, &machine, &text).iter().any(|found| found.rule.name() == "home-height"));
}

/// The programs of the library that were written before: X and Y, then Z.
#[test]
fn the_samples_approach_in_the_machine() {
    let halves = |line: &str, at: &str| {
        let (before, z) = line.split_at(line.find(at).unwrap());
        let (z, rest) = z.trim_start().split_once(' ').unwrap_or((z.trim(), ""));
        [
            format!("{} {rest}", before.trim_end()),
            format!("{} {z} {rest}", line.split(' ').next().unwrap()),
        ]
    };
    for (name, block, z) in [
        ("fanuc-table-bc", "G43.4 X-17.302 Y7.415 Z50.911 H2", " Z"),
        ("haas-umc-750", "X-17.302 Y7.415 Z50.911", " Z"),
        ("dmu50-heidenhain", "L X-17.302 Y+7.415 Z+50.911 R0 FMAX", " Z"),
        ("sinumerik-840d-traori", "G0 X7.465 Y10.556 Z83.64", " Z"),
    ] {
        let (source, machine) = (sample(), load(name).unwrap());
        let good = written(&source, &machine);
        proven(&source, &machine, &good);
        let at =
            good.lines().position(|line| words(line) == block).unwrap_or_else(|| panic!("{good}"));
        let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
        let [xy, mut only_z] = halves(&lines[at], z);
        if name == "dmu50-heidenhain" {
            // A block of HEIDENHAIN says its kind, and its number is one more.
            only_z = only_z.replacen("59 Z", "60 L Z", 1);
            for line in &mut lines[at + 1..] {
                if let Some((number, rest)) =
                    line.split_once(' ').and_then(|(n, r)| Some((n.parse::<u32>().ok()?, r)))
                {
                    *line = format!("{} {rest}", number + 1);
                }
            }
        }
        lines.splice(at..=at, [xy.trim_end().to_owned(), only_z.trim_end().to_owned()]);
        let text = lines.join("\n") + "\n";
        let (rule, line) = refused(&source, &machine, &text);
        // A length of FANUC begins with a Z, whatever X and Y do.
        let expected = if name == "fanuc-table-bc" { "length-change" } else { "rapid-path" };
        assert_eq!((rule, line), (expected, lines[at].clone()), "{name}");
    }
}

/// A fork head: A tilts the spindle about X, 200 mm above its gauge line. The spindle is home at Z 400.
fn fork(more: &str) -> Machine {
    let text = format!(
        "extends = \"fanuc-31i\"\nsafe_height = 400\nwork_zero = [0, 0, 0]\n[settings]\ntable_frame_at_zero = true\nrotary_by_sign = false\n\
         length_moves_axis = false\nlength_along_z = true\nrapid_path = \"linear\"\n{more}[blocks]\ntool_center_on = \"{{{{N}}}} G43.4 {{{{H}}}}\"\n[orientation]\n\
         simultaneous = \"tool-center-angles\"\npositioned = \"tool-center-angles\"\ntolerance = 0.01\n\
         [[rotary]]\nletter = \"A\"\non = \"head\"\naxis = [1, 0, 0]\npoint = [0, 0, 200]\nmin = -115\nmax = 115\n\
         rapid = 9000\nacceleration = 300\nmodulo = false\n"
    );
    load_text("fork.toml", &text).unwrap_or_else(|why| panic!("{why}"))
}

/// A fork head at 45° under tool-centre control, into a slot: straight down it would go through its wall, from beyond all
/// cuts along the tool it comes in as it was drawn.
#[test]
fn a_tilted_head_comes_in_along_its_tool() {
    let machine = fork("");
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n\
         RAPID\nGOTO/0,-30,-28,0,-0.70710678,0.70710678\nGOTO/0,-29,-29\nGOTO/40,-29,-29\nRAPID\nGOTO/40,-69,11\n\
         RAPID\nGOTO/0,30,11\nGOTO/0,30,0\nRAPID\nGOTO/0,30,40\nFINI\n",
    );
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
    let at = good
        .lines()
        .position(|line| words(line) == "Y-30. Z-28.")
        .unwrap_or_else(|| panic!("{good}"));
    let lines: Vec<&str> = good.lines().collect();
    let straight =
        [&lines[..at - 2], &["X0. Y-30.", "Z-28."], &lines[at + 1..]].concat().join("\n") + "\n";
    assert_eq!(refused(&source, &machine, &straight), ("rapid-path", "Z-28.".into()));
}

/// A slot at 45° under a face at Z 0 that reaches to Y -60; the tool ends in it at Y -29 Z -29, then comes `then`.
fn slot(then: &str) -> Program {
    read(&format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n\
         RAPID\nGOTO/0,-60,20,0,0,1\nGOTO/0,-60,0\nGOTO/40,40,0\nRAPID\nGOTO/40,40,50\n\
         RAPID\nGOTO/0,-69,11,0,-0.70710678,0.70710678\nRAPID\nGOTO/0,-30,-28\nGOTO/0,-29,-29\nGOTO/40,-29,-29\n{then}"
    ))
}

/// A tool change, the end, and another orientation; a tool change with a stop behind it.
const LEAVES: [&str; 4] = [
    "LOADTL/2,LENGTH,60\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,20,0,0,1\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI\n",
    "FINI\n",
    "RAPID\nGOTO/40,40,50,0,0,1\nGOTO/40,40,-1\nRAPID\nGOTO/40,40,50\nFINI\n",
    "LOADTL/2,LENGTH,60\nOPSTOP\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,20,0,0,1\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,50\nFINI\n",
];

/// Z home brings the machine straight up: from Y -29 Z -29 through the roof of the slot. Out along the tool it is as high as the
/// source ever goes, at Z 50, after 79 mm of Y and of Z.
#[test]
fn a_tilted_head_goes_out_along_its_tool_before_z_goes_home() {
    let head = |name| load(name).unwrap();
    for (machine, out) in [
        (fork(""), "G0 Y-108. Z50."),
        // In the plane Z is the tool.
        (head("sinumerik-840d-traori"), "G0 Z111.723"),
        (head("linuxcnc-xyzbc-head"), "G0 Y-108 Z50"),
    ] {
        for then in LEAVES {
            let source = slot(then);
            let good = written(&source, &machine);
            proven(&source, &machine, &good);
            let at = good.lines().position(|line| words(line).ends_with(out));
            let at = at.unwrap_or_else(|| panic!("no {out} in\n{good}"));
            let mut lines: Vec<&str> = good.lines().collect();
            lines.remove(at);
            let (rule, home) = refused(&source, &machine, &(lines.join("\n") + "\n"));
            let is_home = ["G28", "SUPA", "G53"].iter().any(|word| home.contains(word));
            assert!(rule == "rapid-path" && is_home, "{rule} {home}\n{good}");
        }
    }
}

/// Another work offset: on its way home the tool goes by the one that was.
#[test]
fn a_tilted_head_goes_out_by_the_old_work_offset() {
    let machine = load("sinumerik-840d-traori").unwrap();
    let mut source = slot(LEAVES[2]);
    let line = source.records.iter().rposition(|record| matches!(record.op, Op::Line(_)));
    let leaves =
        source.records[..line.unwrap()].iter().rposition(|record| matches!(record.op, Op::Line(_)));
    let at = leaves.unwrap() + 1;
    let offset =
        |line| program::Record { line, op: Op::WorkOffset(WorkOffset::numbered(55).unwrap()) };
    source.records.insert(at, offset(source.records[at].line));
    let good = written(&source, &machine);
    let out = good.lines().position(|line| words(line) == "G0 Z111.723");
    assert!(
        out.is_some_and(|out| good.lines().skip(out).any(|line| words(line) == "G55")),
        "{good}"
    );
    proven(&source, &machine, &good);
}

/// Half of the way out is not out.
#[test]
fn a_tilted_head_that_goes_out_by_less_is_refused() {
    let (source, machine) = (slot("FINI\n"), fork(""));
    let good = written(&source, &machine);
    let other = |block: &str| {
        let lines = good.lines().map(|line| match line.ends_with("G0 Y-108. Z50.") {
            true => line.replace("Y-108. Z50.", block),
            false => line.to_owned(),
        });
        lines.map(|line| line + "\n").collect::<String>()
    };
    assert_eq!(refused(&source, &machine, &other("Y-107.9 Z49.9")).0, "rapid-path");
    proven(&source, &machine, &other("Y-108.1 Z50.1"));
}

/// The same where the tool change itself brings Z up.
#[test]
fn a_tool_change_that_retracts_by_itself_takes_no_tilted_head_out_of_a_slot() {
    let source = slot(LEAVES[0]);
    let machine = fork("[tools]\nretracts = true\nturns_upright = true\n");
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
    let at = good.lines().position(|line| line.ends_with("G0 Y-108. Z50.")).unwrap();
    let change = at + good.lines().skip(at).position(|line| line.contains("M6")).unwrap();
    let stays = |(i, line): (usize, &str)| {
        (i < at || i >= change || !line.contains("Z")).then(|| line.to_owned() + "\n")
    };
    let low: String = good.lines().enumerate().filter_map(stays).collect();
    let (rule, line) = refused(&source, &machine, &low);
    assert!(rule == "rapid-path" && line.contains("M6"), "{rule} {line}\n{low}");
}

/// Under a vector the way out has the same vector, and an undercut needs more than its own depth: 1.01 mm beyond Y 0 along
/// the tool, and beyond it on the whole way up.
#[test]
fn a_tool_that_points_down_goes_out_until_it_is_free_on_its_way_up() {
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n\
         RAPID\nGOTO/0,-90,-20,0,-0.96592583,-0.25881905\nGOTO/0,-20,-10\nGOTO/0,-20,-10,0,-1,0\n\
         GOTO/0,-20,-10,0,-0.96592583,-0.25881905\nRAPID\nGOTO/0,-60,-20.717968\nRAPID\nGOTO/40,0,50,0,0,1\n\
         GOTO/40,0,0\nRAPID\nGOTO/40,0,50\nFINI\n",
    );
    let machine = load("sinumerik-840d-traori").unwrap();
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
}

/// Where Z is down before X and Y are known, it has to be as high as the source ever goes.
#[test]
fn z_first_comes_down_to_where_the_source_goes_highest_only() {
    let source = read(
        "UNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/5,0,3\nGOTO/5,0,-5\nGOTO/25,0,2\nRAPID\n\
         GOTO/25,0,50\nFINI\n",
    );
    let machine = load("generic-3axis-sinumerik").unwrap();
    let good = written(&source, &machine);
    proven(&source, &machine, &good);
    let z_first = |z: &str| with(&good, "G0 X5 Y0", &[&format!("G0 {z}"), "X5 Y0"]);
    proven(&source, &machine, &z_first("Z50"));
    assert_eq!(refused(&source, &machine, &z_first("Z49.9")), ("rapid-path", "G0 Z49.9".into()));
    // 1 mm above all cuts there may be a pocket around it.
    let low = with(&z_first("Z3"), "Z3", &[]);
    assert_eq!(refused(&source, &machine, &low), ("rapid-path", "G0 Z3".into()));
}
