//! Posts and templates of other systems, written here in the style that is in use, as machine files: the
//! blocks that they become, what is reported, and that the sample part is proven with each.

use import::Import;
use machine::{LengthOffset, Machine, load_text};
use program::{Diagnostic, Op};
use proptest::prelude::*;
use std::path::Path;

/// Words and blocks that every post here has; an own one follows for what it differs in.
const WORDS: &str = r#"
LINE_ENDING = "[13][10]"
LINE_NUMBER_START     = 10
LINE_NUMBER_INCREMENT = 5
LINE_NUMBER_MAXIMUM   = 999999
VAR LINE_NUMBER = [N|A|N|1.0]
VAR SPINDLE_SPEED = [S|A|S|1.0]
VAR FEED_RATE = [F|C|F|1.1]
VAR X_POSITION = [X|C|X|1.3]
VAR Y_POSITION = [Y|C|Y|1.3]
VAR Z_POSITION = [Z|C|Z|1.3]
VAR ARC_CENTRE_I_INC_POSITION = [I|A|I|1.3]
VAR ARC_CENTRE_J_INC_POSITION = [J|A|J|1.3]
VAR ARC_CENTRE_I_ABS_POSITION = [IA|A|I|1.3]
VAR ARC_CENTRE_J_ABS_POSITION = [JA|A|J|1.3]
VAR ARC_RADIUS = [Radius|A|R|1.4]
VAR X_HOME_POSITION = [XH|A|X|1.3]
VAR Y_HOME_POSITION = [YH|A|Y|1.3]
VAR Z_HOME_POSITION = [ZH|A|Z|1.3]
VAR DWELL_TIME = [DWELL|A|P|1.2]
"#;

const MOVES: &str = r#"
begin RAPID_MOVE
"G0[X][Y][Z]"
begin FIRST_FEED_MOVE
"G1[X][Y][Z][F]"
begin FEED_MOVE
"G1[X][Y][Z]"
"#;

fn import(file: &str, text: &[u8], extends: Option<&str>) -> Result<Import, Vec<Diagnostic>> {
    import::import(file, text, extends, Path::new(""))
}

fn arcs(words: &str) -> String {
    let of = |name, code| {
        format!(
            "begin FIRST_{name}_ARC_MOVE\n\"{code}{words}[F]\"\nbegin {name}_ARC_MOVE\n\"{code}{words}\"\n"
        )
    };
    of("CW", "G2") + &of("CCW", "G3")
}

fn imported(file: &str, text: &str, extends: Option<&str>) -> (Import, Machine) {
    let import = import(file, text.as_bytes(), extends).unwrap_or_else(|found| panic!("{found:?}"));
    let machine =
        load_text("own.toml", &import.text).unwrap_or_else(|e| panic!("{e}\n{}", import.text));
    post::check(&machine).unwrap_or_else(|found| panic!("{found:?}\n{}", import.text));
    (import, machine)
}

/// The sample part on an imported machine: written and proven, or the rule of the first fault. With one tool for all of it where
/// no block takes a length.
fn sample(machine: &Machine) -> Result<String, &'static str> {
    let sample = include_str!("../../../../machines/samples/three-axes.cls");
    let mut program =
        source::apt::read("s.cls", sample.as_bytes(), &Default::default()).unwrap().program;
    if machine.capabilities.length_offset == LengthOffset::Implicit {
        let mut first = None;
        for record in &mut program.records {
            if let Op::Tool(tool) = &mut record.op {
                *tool = first.get_or_insert_with(|| tool.clone()).clone();
            }
        }
    }
    let output = post::write(&program, machine).map_err(|found| found[0].rule.name())?;
    let report = proof::prove(&program, machine, "p", &output.text, &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))?;
    Ok(String::from_utf8(output.text).unwrap())
}

/// Whether each block is as it should be.
#[track_caller]
fn blocks(machine: &Machine, expected: &[(&str, &str)]) {
    for (name, text) in expected {
        assert_eq!(machine.blocks[*name].text.trim_end(), *text, "{name}");
    }
}

/// The lines of what is reported of the post, with its rule. What no post says, the safe height, is not among them.
fn reported(import: &Import) -> Vec<(u32, &'static str)> {
    let findings = import.findings.iter().filter(|found| found.rule.name() != "safe-height");
    findings.map(|found| (found.line, found.rule.name())).collect()
}

const LOST: &str = "not-carried-over";
const OTHERWISE: &str = "carried-otherwise";

#[test]
fn a_post_for_grbl_keeps_its_words_and_what_grbl_cannot_is_the_controls() {
    let head = "POST_NAME = \"Shop Grbl (mm) (*.nc)\"\nFILE_EXTENSION = \"nc\"\nUNITS = \"MM\"";
    let places = r#"begin HEADER
"(shop)"
"G17"
"T[T]"
"[S]M3"
"G0[ZH]"
"G0[XH][YH]"
begin TOOLCHANGE
"M5"
"M6 T[T]"
"M3[S]"
begin DWELL_MOVE
"G04 [DWELL]"
begin FOOTER
"M5"
"G0[ZH]"
"M2"
"#;
    let text = [head, WORDS, places, MOVES, &arcs("[X][Y][I][J]")].concat();
    let (import, machine) = imported("shop.pp", &text, None);
    assert_eq!((import.extends.as_str(), machine.extension.as_str()), ("grbl", "nc"));
    assert_eq!(machine.format.line_end, "\r\n");
    blocks(
        &machine,
        &[
            ("rapid", "G0{{X}}{{Y}}{{Z}}"),
            ("linear", "G1{{X}}{{Y}}{{Z}}{{F}}"),
            ("arc_cw", "G2{{X}}{{Y}}{{I}}{{J}}{{F}}"),
            ("arc_ccw", "G3{{X}}{{Y}}{{I}}{{J}}{{F}}"),
            ("dwell", "G04 {{P}}"),
            ("spindle_cw", "{{S}} M3"),
            ("spindle_ccw", "{{S}} M4"),
            // G17 is in the line of the control.
            (
                "program_start",
                "({{ program.name }})\n{% for t in program.tools %}\n(T{{ t.number }}{% if t.name %} \
                 {{ t.name[:40] }}{% endif %}{% if t.diameter %} D{{ t.diameter }}{% endif %})\n{% endfor %}\n\
                 G21 G17 G40 G49 G90 G94 G54\n(shop)",
            ),
            (
                "program_end",
                "{% if options.retract_height %}G0 {{RETRACT_HEIGHT}}{% else %}G53 G0 {{SAFE_HEIGHT}}{% endif %}\nM5\nM2",
            ),
        ],
    );
    let x = &machine.words["X"];
    assert_eq!((x.decimals, x.trim, x.modal), (3, false, true));
    assert_eq!(machine.words["N"].step, 0, "no block places a number");
    // The home of the header, X Y of it, M6, the home of the footer; counted by hand.
    let at = |what: &str| 1 + text.lines().position(|line| line.contains(what)).unwrap() as u32;
    let footer = 1 + text.lines().position(|line| line.contains("FOOTER")).unwrap() as u32;
    assert_eq!(
        reported(&import),
        [
            (at("G0[ZH]"), OTHERWISE),
            (at("G0[XH]"), OTHERWISE),
            (at("TOOLCHANGE") + 1, LOST),
            (footer + 2, OTHERWISE),
        ]
    );
    let program = sample(&machine).unwrap();
    // The helix has no block of its own: lines.
    for line in ["G1Z-2.000F200.0\r", "G3Y30.000I0.000J10.000\r", "G1X32.480Y19.687Z0.960F300.0\r"]
    {
        assert!(program.lines().any(|l| l == line.trim_end()), "{line}\n{program}");
    }
}

#[test]
fn a_post_in_inches_with_numbers_lengths_and_helices_is_one_in_millimetres() {
    let head =
        "POST_NAME = \"Barn LinuxCNC (inch) (*.ngc)\"\nUNITS = \"INCHES\"\nDIRECT_OUTPUT = \"V\"";
    let places = r#"begin HEADER
"%"
"( [TP_FILENAME] )"
"( [DATE] )"
"[N] G00 G20 G17 G90 G40 G49 G80"
"[N] G64 P0.001"
"[N] T[T] M6 ([TOOLNAME])"
"[N] M07"
"[N] G00 G43[ZH] H[T]"
"[N] G0[XH][YH] M03[S]"
"[N] M0"
begin TOOLCHANGE
"[N] M05"
"[N] T[T] M6 ([TOOLNAME])"
"[N] G00 G43[ZH] H[T]"
begin NEW_SEGMENT
"[N] M03[S]"
"(Toolpath: [TOOLPATH_NAME])"
begin RAPID_MOVE
"[N] G00[X][Y][Z]"
begin FIRST_FEED_MOVE
"[N] G1[X][Y][Z][F]"
begin FIRST_CW_ARC_MOVE
"[N] G2[X][Y][I][J][F]"
begin FIRST_CCW_ARC_MOVE
"[N] G3[X][Y][I][J][F]"
begin FIRST_CW_HELICAL_ARC_MOVE
"[N] G2[X][Y][Z][I][J][F]"
begin FIRST_CCW_HELICAL_ARC_MOVE
"[N] G3[X][Y][Z][I][J][F]"
begin JET_TOOL_ON
"M03S0"
begin FOOTER
"[N] M05"
"[N] M09"
"#;
    // An address with a blank before it stands apart.
    let words = WORDS
        .replace("|A|N|", "|A| N|")
        .replace("|C|", "|C| ")
        .replace("|A|I|1.3]\nVAR ARC_CENTRE_J_INC", "|A| I|1.3]\nVAR ARC_CENTRE_J_INC")
        .replace("1.3]", "1.4]");
    let text = [head, &words, places].concat();
    let (import, machine) = imported("barn.pp", &text, None);
    assert_eq!(import.extends, "linuxcnc");
    assert_eq!(machine.words["X"].decimals, 3, "of an inch four, of a millimetre three");
    assert_eq!((machine.words["N"].first, machine.words["N"].step), (10, 5));
    blocks(
        &machine,
        &[
            ("helix_cw", "{{N}} G2 {{X}} {{Y}} {{Z}} {{I}}{{J}} {{F}}"),
            ("linear", "{{N}} G1 {{X}} {{Y}} {{Z}} {{F}} {{length}} {{H}}"),
            ("operation_start", "(Toolpath: {{ operation.name }})"),
            (
                "tool_change",
                "G53 G0 {{SAFE_HEIGHT}}\n{% if tool.first %}{{N}} {{T}} M6 ({{ tool.name }}){% endif %}\n\
                 {% if not tool.first %}{{N}} M05\n{{N}} {{T}} M6 ({{ tool.name }}){% endif %}",
            ),
            ("program_end", "G53 G0 {{SAFE_HEIGHT}}\n{{N}} M05\n{{N}} M09\nM2"),
        ],
    );
    let lost = |what: &str| {
        let line = 1 + text.lines().position(|line| line.contains(what)).unwrap() as u32;
        assert!(reported(&import).contains(&(line, LOST)), "{what}: {:?}", import.findings);
    };
    for what in ["DIRECT_OUTPUT", "\"%\"", "[DATE]", "M07", "M0\"", "JET_TOOL_ON"] {
        lost(what);
    }
    let program = sample(&machine).unwrap();
    assert!(program.contains("G2 X32.500 Y20.000 Z-1.000 I-2.500"), "{program}");
    assert!(program.contains("G00 Z20.000 G43 H1"), "{program}");
}

#[test]
fn centres_may_be_absolute_and_a_radius_may_stand_for_them() {
    let head = "POST_NAME = \"Mach3 arcs (mm)\"\n";
    let places = "begin HEADER\n\"G91 G28 Z0\"\n\"G90\"\n\"G90.1\"\nbegin TOOLCHANGE\n\"M6 T[T]\"\nbegin FOOTER\n\"G91.1\"\n\"M30\"\n";
    let post = [head, WORDS, places, MOVES].concat();
    let (_, machine) = imported("a.pp", &(post.clone() + &arcs("[X][Y][IA][JA]")), None);
    blocks(&machine, &[("arc_cw", "G2{{X}}{{Y}}{{CX}}{{CY}}{{F}}")]);
    // The sample dwells, and what P counts on a Mach3 its operator has set up.
    assert_eq!(sample(&machine), Err("dwell-unit"));
    let counting_seconds = |mut machine: Machine| {
        machine.settings.dwell_p_milliseconds = Some(false);
        sample(&machine)
    };
    let program = counting_seconds(machine).unwrap();
    assert!(program.contains("G3Y30.000I40.000J20.000"), "{program}");
    let (_, machine) = imported("b.pp", &(post.clone() + &arcs("[X][Y][Radius]")), None);
    let program = counting_seconds(machine).unwrap();
    assert!(program.contains("G3X50.000Y20.000R10.0000"), "{program}");
    // Without the code that says so the control counts from the start: the proof finds it.
    let wrong = post.replace("G90.1", "G98") + &arcs("[X][Y][IA][JA]");
    assert_eq!(counting_seconds(imported("c.pp", &wrong, None).1), Err("arc"));
}

#[test]
fn a_post_for_marlin_has_comments_of_its_own() {
    let head = "POST_NAME = \"Marlin mill\"\nFILE_EXTENSION = \"gcode\"\n";
    let places = r#"begin HEADER
"; Path: [TP_FILENAME]"
"M117 [TOOLPATH_NAME] - Bit #[T]"
"G1 Z[SAFEZ] F500"
"M3 [S]"
begin TOOLCHANGE
"M5"
"; Tool [T]: [TOOLNAME]"
"T[T]"
"M0 Load the tool"
begin RAPID_MOVE
"G0 [X] [Y] [Z] [F]"
begin FEED_MOVE
"G1 [X] [Y] [Z] [FC]"
begin PLUNGE_MOVE
"G1 [X] [Y] [Z] [FP]"
begin DWELL_MOVE
"G4 [DWELL]"
begin FOOTER
"M5"
"#;
    // By S a dwell is in seconds, by the P of the control in milliseconds.
    let words = WORDS.replace("[DWELL|A|P|1.2]", "[DWELL|A|S|1.2]")
        + "VAR CUT_RATE = [FC|C|F|1.1]\nVAR PLUNGE_RATE = [FP|C|F|1.1]\n";
    let text = [head, &words, places, &arcs(" [X] [Y] [I] [J] ")].concat();
    let (import, machine) = imported("m.pp", &text, None);
    assert_eq!(import.extends, "marlin");
    blocks(
        &machine,
        &[
            ("linear", "G1 {{X}} {{Y}} {{Z}} {{F}}"),
            (
                "tool_change",
                "G53 G0 {{SAFE_HEIGHT}} {{RAPID_FEED}}\nM5\n; Tool {{ tool.number }}: {{ tool.name }}\n{{T}}\n\
                 {% if not tool.first %}M0 Load the tool{% endif %}",
            ),
        ],
    );
    let line = 1 + text.lines().position(|line| line.contains("M117")).unwrap() as u32;
    assert!(reported(&import).contains(&(line, LOST)), "{:?}", import.findings);
    let program = sample(&machine).unwrap();
    assert!(program.contains("M0 Load the tool") && program.contains("G4 S0.50"), "{program}");
}

#[test]
fn templates_with_parameters_become_blocks() {
    let text = "\
[engraving: file extension]
mpf
[engraving: tool radius]
0.1
[engraving: program start]
; board @name@
[engraving: approach into the material]
G0 X@x@ Y@y@
G1 Z@depth@ F@feed@
[engraving: linear move]
G1 X@x@ Y@y@ Z@z@ F@feed@
[engraving: arc clockwise]
CIP X@x@ Y@y@ Z@z@ I1=@x mid@ J1=@y mid@ K1=@z mid@ F@feed@
[engraving: arc counter-clockwise]
CIP X@x@ Y@y@ Z@z@ I1=@x_mid@ J1=@y_mid@ K1=@z_mid@ F@feed@
[engraving: leave the material]
G0 Z2
[engraving: program end]
M5
M30
[drilling: drill change]
T@tool@
M6
[drilling: drilling one hole]
G0 X@x@ Y@y@
G1 Z@depth@ F@feed@
[drilling: program end]
M30
";
    let (import, machine) = imported("board.txt", text, Some("sinumerik-828d"));
    assert_eq!((machine.extension.as_str(), machine.words["MX"].address.as_str()), ("mpf", "I1="));
    blocks(
        &machine,
        &[
            ("linear", "G1 {{X}} {{Y}} {{Z}} {{F}} {{H}}"),
            ("arc_cw", "CIP {{X}} {{Y}} {{Z}} {{MX}} {{MY}} {{MZ}} {{F}}"),
            ("tool_change", "{{N}} G0 SUPA {{SAFE_HEIGHT}} D0\n{{T}}\nM6"),
        ],
    );
    let lost: Vec<u32> = reported(&import).into_iter().map(|(line, _)| line).collect();
    // The edge of the tool, which no block says; tool radius, approach, leave, the hole by moves, the second end.
    assert_eq!(lost, [0, 3, 7, 16, 25, 27], "{:?}", import.findings);
    let program = sample(&machine).unwrap();
    assert!(program.contains("CIP X40 Y30 Z-2 I1=50 J1=20 K1=-2 F600"), "{program}");
}

#[test]
fn a_hole_by_g81_is_a_cycle_and_a_radius_has_its_sign() {
    let text = "\
[engraving: linear move]
G1X@X@Y@Y@Z@Z@F@F@
[engraving: arc cw]
G2X@end x@Y@end y@Z@end z@R@signed-radius@F@feed@
[engraving: arc ccw]
G3X@end x@Y@end y@Z@end z@R@signed-radius@F@feed@
[drilling: hole]
G98 G81 X@x@ Y@y@ Z@depth@ R@clearance@ F@feed@
";
    let (_, machine) = imported("mill.txt", text, Some("linuxcnc"));
    blocks(
        &machine,
        &[
            ("cycle_drill", "G98 G81 {{X}} {{Y}} {{BOTTOM}} {{CLEAR}} {{F}}"),
            ("cycle_hole", "G98 G81 {{X}} {{Y}} {{BOTTOM}} {{CLEAR}} {{F}}"),
        ],
    );
    let program = sample(&machine).unwrap();
    assert!(program.contains("G98 G81 X15 Y20 Z-6 R2 F150"), "{program}");
    assert!(program.contains("R10"), "{program}");
    // A control keeps the level to which it goes back from the program before: the proof finds it.
    let (_, machine) = imported("mill.txt", &text.replace("G98 ", ""), Some("linuxcnc"));
    assert_eq!(sample(&machine), Err("cycle"));
}

/// `R` alone: it becomes the one with a sign. GRBL has no G81, so holes are moves.
#[test]
fn a_radius_without_sign_gets_one_and_a_cycle_needs_a_control_that_has_it() {
    let text = "\
[engraving: linear move]
G1 X@x@ Y@y@ Z@z@ F@f@
[engraving: arc cw]
G2 X@x@ Y@y@ R@r@ F@f@
[engraving: arc ccw]
G3 X@x@ Y@y@ R@r@ F@f@
[drilling: hole]
G81 X@x@ Y@y@ Z@depth@ R@clearance@ F@f@
";
    for control in ["grbl", "marlin"] {
        let (import, machine) = imported("mill.txt", text, Some(control));
        let expected = [(0, "rapid-feed"), (4, OTHERWISE), (6, OTHERWISE), (8, LOST)];
        // Rapids of Marlin go at an F, which the post does not say.
        assert_eq!(reported(&import), expected[usize::from(control == "grbl")..]);
        assert!(machine.capabilities.cycles.is_empty() && !machine.capabilities.arcs.is_empty());
        blocks(&machine, &[("arc_cw", "G2 {{X}} {{Y}} {{R}} {{F}}")]);
        let program = sample(&machine).unwrap();
        assert!(!program.contains("G81"), "{program}");
        assert!(program.lines().any(|l| l.starts_with("G3 ") && l.contains(" R10")), "{program}");
    }
    // With a centre it stays what it is, and a word that has no value leaves arcs out.
    let both = text.replace("R@r@", "I@i@ J@j@ R@r@");
    let (_, machine) = imported("mill.txt", &both, Some("grbl"));
    blocks(&machine, &[("arc_cw", "G2 {{X}} {{Y}} {{I}} {{J}} {{RADIUS}} {{F}}")]);
    let (import, machine) = imported("mill.txt", &text.replace("R@r@", "U@r@"), Some("grbl"));
    assert!(machine.capabilities.arcs.is_empty());
    let says = |found: &Diagnostic| found.message.contains("arcs are written as lines");
    assert!(import.findings.iter().any(says), "{import:?}");
}

#[test]
fn what_differs_from_the_first_move_and_what_the_toolpath_says_itself_is_reported() {
    let rest = r#"POST_NAME = "linuxcnc"
begin HEADER
"S12000 M3"
"M8"
"G0 X0 Y0"
"G4 P2"
"G92.1"
"G10 L2 P1 X0 Y0"
begin PLUNGE_MOVE
"G1[X][Y][Z][F]"
begin RETRACT_MOVE
"G1[X][Y][Z][F]"
begin CW_ARC_MOVE
"G2[X][Y][ArcMidXI][I][J][F]"
begin CCW_ARC_MOVE
"G3[X][Y][I][J][F]"
"#;
    let text = [WORDS, MOVES, rest].concat();
    let (import, machine) = imported("a.pp", &text, None);
    let line = |what: &str| 1 + text.lines().position(|line| line.contains(what)).unwrap() as u32;
    let retract = line("RETRACT_MOVE") + 1;
    // One direction without the other is none, so arcs are lines.
    let expected = [
        (0, LOST),
        (0, "length-offset"),
        (line("S12000"), LOST),
        (line("\"M8"), LOST),
        (line("G0 X0"), OTHERWISE),
        (line("G4 P2"), LOST),
        (retract, LOST),
        (line("ArcMidXI"), LOST),
    ];
    assert_eq!(reported(&import), expected, "{:?}", import.findings);
    assert!(machine.capabilities.arcs.is_empty());
    // What a command says stays with it, and what it does is the proof's to say.
    let start = machine.blocks["program_start"].text.trim_end();
    assert!(start.ends_with("G92.1\nG10 L2 P1 X0 Y0"), "{start}");
    assert_eq!(sample(&machine).map(drop), Err("operator-data"));
}

/// What is refused, and at which line.
#[test]
fn what_cannot_be_read_is_refused_with_its_line() {
    let refused = |file: &str, text: &str| {
        let found = import(file, text.as_bytes(), Some("grbl")).expect_err("a machine");
        assert!(found.iter().any(|found| found.is_error()) && found.len() <= 201);
        let first = found.into_iter().find(|found| found.is_error()).unwrap();
        assert_eq!(first.file, file);
        (first.line, first.message)
    };
    for (text, line, what) in [
        ("begin HEADER\n\"G21", 2, "quotes are not closed"),
        ("\"G21\"", 1, "before any `begin`"),
        ("VAR X_POSITION = [X|C|X|1.4\nbegin HEADER\n\"G21\"", 1, "pair of brackets"),
        ("VAR X_POSITION = [X|C|X]", 1, "a name, A or C"),
        ("VAR X_POSITION = [X|Q|X|1.4]", 1, "always (A) or changed (C)"),
        ("VAR X_POSITION = [X|C|X|1.99]", 1, "no format"),
        ("UNITS = \"MM\"\nVAR X_POSITION = [X|C|\u{6}X|1.4]", 2, "letters of ASCII"),
        ("VAR X_POSITION = [X|C|X{|1.4]", 1, "letters of ASCII"),
        ("VAR X_POSITION = [X|C|é|1.4]", 1, "letters of ASCII"),
        ("VAR Z_POSITION = [Z|C|Z|1.4|-1]", 1, "multiplied by -1"),
        ("VAR X_POSITION = [X|C|X|1.0|1000]", 1, "multiplied by 1000"),
        ("VAR F", 1, "a variable is"),
        ("LINE_NUMBER_START = many", 1, "a whole number"),
        ("begin FOOTER\n\"M2\"\nbegin FOOTER\n\"M2\"", 3, "a second time"),
        ("+ nothing\n", 0, "no block of a program"),
        ("", 0, "no block of a program"),
    ] {
        let (at, message) = refused("post.pp", text);
        assert!(at == line && message.contains(what), "{text}: {at} {message}");
    }
    for (text, line, what) in [
        ("G1 X@x@", 1, "before the first field"),
        ("[engraving: linear move]\nG1 X@x Y1", 2, "begins a parameter"),
        ("[engraving: linear]\nG1", 1, "no field of a template"),
        ("[engraving: line]\nG1\n[engraving: line]\nG1", 3, "stands here again"),
        ("[milling: line]\nG1", 1, "before the first field"),
    ] {
        let (at, message) = refused("post.txt", text);
        assert!(at == line && message.contains(what), "{text}: {at} {message}");
    }
    let large = vec![b'+'; (1 << 20) + 1];
    assert_eq!(import("a.pp", &large, None).unwrap_err()[0].rule.name(), "import");
    // A control that is named by nobody, by two, and by a name that is none.
    let post = [WORDS, MOVES].concat();
    for (name, extends, rule) in [
        ("Router", None, "import-control"),
        ("Mach3 and GRBL", None, "import-control"),
        ("Router", Some("nonesuch"), "machine-unknown"),
    ] {
        let text = format!("POST_NAME = \"{name}\"\n{post}");
        assert_eq!(import("a.pp", text.as_bytes(), extends).unwrap_err()[0].rule.name(), rule);
    }
}

#[test]
fn hostile_lines_are_left_out_or_stand_as_text() {
    let long = "G1 ".repeat(300_000);
    let deep = "[".repeat(200_000);
    for line in [
        "{{ 7 * 7 }}",
        "{% for i in range(1000000) %}G1{% endfor %}",
        "(\u{1b}[2J é {{ tool.name }})",
        "M6 [T][T][T] [NOPE] [",
        &long,
        &deep,
        "\\\" \\u0000 ''' ;",
    ] {
        for block in ["HEADER", "TOOLCHANGE", "RAPID_MOVE", "FIRST_CW_ARC_MOVE", "FOOTER"] {
            let other = if block == "RAPID_MOVE" { "" } else { MOVES };
            let text = format!("{WORDS}begin {block}\n\"{line}\"\n{other}");
            let import = import("grbl.pp", text.as_bytes(), None).unwrap();
            let machine = load_text("own.toml", &import.text).unwrap();
            assert!(!machine.blocks.values().any(|block| block.text.contains("7 * 7")));
            // It may be too long for the control, and is then refused; it makes nothing run for ever.
            let _ = post::check(&machine).map(|()| sample(&machine));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Pieces of posts in any order: a file that loads, or errors.
    #[test]
    fn whatever_is_read_loads(
        pieces in proptest::collection::vec(
            prop_oneof![
                Just("begin HEADER\n"), Just("begin RAPID_MOVE\n"), Just("begin FOOTER\n"),
                Just("begin TOOLCHANGE\n"), Just("begin FIRST_FEED_MOVE\n"), Just("\"G0[X][Y][Z]\"\n"),
                Just("\"M6 T[T] ([TOOLNAME])\"\n"), Just("\"[N] G43 H[T] [ZH]\"\n"), Just("\"M3[S]\"\n"),
                Just("VAR X_POSITION = [X|C| X|1.4]\n"), Just("VAR Y_POSITION = [Y|A|YY=|2.0]\n"),
                Just("VAR LINE_NUMBER = [N|A||1.0]\n"), Just("VAR SPINDLE_SPEED = [S|A||1.0]\n"),
                Just("\"[13][10]G1[X] F100\"\n"), Just("\"\\\\ %% (\"\n"), Just("\"; [DATE]\"\n"),
                Just("VAR Z_POSITION = [Z|C|\"Z\\|1.4]\n"),
                Just("UNITS = \"INCHES\"\n"), Just("LINE_ENDING = \"[10]\"\n"), Just("\"{\"\n"),
            ],
            0..24,
        ),
    ) {
        if let Ok(import) = import("grbl.pp", pieces.concat().as_bytes(), None) {
            let machine = load_text("own.toml", &import.text);
            prop_assert!(machine.is_ok(), "{:?}\n{}", machine, import.text);
            let checked = post::check(&machine.unwrap());
            prop_assert!(checked.is_ok(), "{:?}\n{}", checked, import.text);
        }
    }
}
