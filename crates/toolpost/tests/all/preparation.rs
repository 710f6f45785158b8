//! What programs for HEIDENHAIN and SINUMERIK say besides the path: the blank, the tools, tolerances, modes that a break may have left on.
//! Each program is proven.

use machine::{Machine, load, load_text};
use program::{Diagnostic, Op, Program, Record, WorkOffset};

/// A box of cuts from 0, 0, -3 to 40, 20, 0, with tool 4 and then tool 7.
const UPRIGHT: &str = "UNITS/MM\nTPRINT/FACE MILL\nLOADTL/4,LENGTH,80\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,50\nRAPID\nGOTO/0,0,2\n\
                       GOTO/0,0,-3\nGOTO/40,0,-3\nGOTO/40,20,0\nRAPID\nGOTO/40,20,50\nLOADTL/7,LENGTH,60\nSPINDL/900,RPM,CLW\nRAPID\nGOTO/5,5,50\n\
                       RAPID\nGOTO/5,5,2\nGOTO/5,5,-1\nGOTO/9,5,-1\nRAPID\nGOTO/9,5,50\nFINI\n";

fn read(text: &str) -> Program {
    source::apt::read("job.apt", text.as_bytes(), &Default::default()).unwrap().program
}

fn five_axes() -> Program {
    let path = crate::files::root().join("machines/samples/five-axes.cls");
    read(&std::fs::read_to_string(path).unwrap())
}

fn machine(text: &str) -> Machine {
    load_text("mill.toml", text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

fn written(program: &Program, machine: &Machine) -> String {
    let output = post::write(program, machine).unwrap_or_else(|why| panic!("{why:#?}"));
    String::from_utf8(output.text).unwrap()
}

/// The program, which its own proof accepts.
fn proven(program: &Program, machine: &Machine) -> String {
    let text = written(program, machine);
    let found = found(program, machine, &text);
    assert!(found.is_empty(), "{found:#?}\n{text}");
    text
}

fn found(program: &Program, machine: &Machine, text: &str) -> Vec<Diagnostic> {
    let report = proof::prove(program, machine, "p.nc", text.as_bytes(), &Default::default());
    if report.proven { Vec::new() } else { report.mismatches }
}

/// The blocks without their numbers.
fn blocks(text: &str) -> Vec<String> {
    let numbered = |line: &str| {
        let (number, rest) = line.split_once(' ').unwrap_or(("", line));
        let is_number = !number.is_empty()
            && number.trim_start_matches('N').bytes().all(|byte| byte.is_ascii_digit());
        if is_number { rest.to_owned() } else { line.to_owned() }
    };
    text.lines().map(numbered).collect()
}

#[track_caller]
fn stands(text: &str, row: &[&str]) {
    let blocks = blocks(text);
    assert!(blocks.windows(row.len()).any(|here| here == row), "{row:#?} is not in\n{text}");
}

#[test]
fn the_blank_reaches_as_far_as_the_cuts_and_says_that_it_is_not_the_stock() {
    let job = read(UPRIGHT);
    let text = proven(&job, &load("generic-3axis-heidenhain").unwrap());
    stands(
        &text,
        &[
            "BLK FORM 0.1 Z X+0 Y+0 Z-3",
            "BLK FORM 0.2 X+40 Y+20 Z+0",
            "; The blank is as large as the cuts reach, it is not the stock",
        ],
    );
    let none = "extends = \"generic-3axis-heidenhain\"\n[options]\nblank = false\n";
    assert!(!proven(&job, &machine(none)).contains("BLK"));
    let sinumerik = "extends = \"generic-3axis-sinumerik\"\n[options]\nblank = true\n";
    stands(
        &proven(&job, &machine(sinumerik)),
        &[
            "; The blank is as large as the cuts reach, it is not the stock",
            "WORKPIECE(,\"\",,\"BOX\",112,0,-3,-80,0,0,40,20)",
        ],
    );
    assert!(!proven(&job, &load("generic-3axis-sinumerik").unwrap()).contains("WORKPIECE"));
}

#[test]
fn the_blank_is_the_stock_where_the_source_states_it() {
    let stock = [[-5.0, -6.0, -20.0], [45.0, 26.0, 1.5]].map(geom::Vec3::from);
    let job = Program { stock: Some(stock), ..read(UPRIGHT) };
    stands(
        &proven(&job, &load("generic-3axis-heidenhain").unwrap()),
        &[
            "BLK FORM 0.1 Z X-5 Y-6 Z-20",
            "BLK FORM 0.2 X+45 Y+26 Z+1.5",
            "; The blank is the stock of the toolpath",
        ],
    );
    let sinumerik = "extends = \"generic-3axis-sinumerik\"\n[options]\nblank = true\n";
    stands(
        &proven(&job, &machine(sinumerik)),
        &["WORKPIECE(,\"\",,\"BOX\",112,1.5,-20,-80,-5,-6,45,26)"],
    );
}

/// A control refuses a blank without a thickness, and how far two work offsets are apart no program says.
#[test]
fn cuts_that_make_no_body_have_no_blank() {
    let heidenhain = load("generic-3axis-heidenhain").unwrap();
    let flat = UPRIGHT.replace(",-3\n", ",0\n").replace(",-1\n", ",0\n");
    assert!(!proven(&read(&flat), &heidenhain).contains("BLK"));
    let job = read(UPRIGHT);
    let is_second = |record: &Record| matches!(&record.op, Op::Tool(tool) if tool.number == 7);
    let at = job.records.iter().position(is_second).unwrap();
    let second = Op::WorkOffset(WorkOffset::numbered(55).unwrap());
    let mut records = job.records.clone();
    records.insert(at, Record { line: 15, op: second });
    assert!(!written(&job.with_records(records), &heidenhain).contains("BLK"));
}

#[test]
fn the_tools_of_the_program_stand_at_its_head() {
    let job = read(&UPRIGHT.replace("LOADTL/7,LENGTH,60", "CUTTER/10\nLOADTL/7,LENGTH,60"));
    for name in ["generic-3axis-heidenhain", "generic-3axis-sinumerik"] {
        let text = proven(&job, &load(name).unwrap());
        let list: Vec<String> = blocks(&text)
            .into_iter()
            .filter(|block| ["; T4", "; T7"].iter().any(|tool| block.starts_with(tool)))
            .collect();
        assert!(list[0].starts_with("; T4") && list[0].ends_with("L80"), "{text}");
        assert!(list[1].starts_with("; T7") && list[1].ends_with("D10 L60"), "{text}");
    }
}

/// 530 p. 457: `FUNCTION TCPM` with these words is `M128`, and `FUNCTION RESET TCPM` is `M129`.
#[test]
fn function_tcpm_may_stand_in_place_of_m128() {
    let job = five_axes();
    let m128 = load("dmu50-heidenhain").unwrap();
    let tcpm = machine("extends = \"dmu50-heidenhain\"\n[options]\ntcpm = true\n");
    let expected = proven(&job, &m128)
        .replace("M128", "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS")
        .replace("M129", "FUNCTION RESET TCPM");
    let text = proven(&job, &tcpm);
    assert_eq!(text, expected);
    // The other way of turning is another program.
    let turned = text.replace("PATHCTRL AXIS", "PATHCTRL VECTOR");
    let found = found(&job, &tcpm, &turned);
    assert_eq!(found.first().map(|found| found.rule.name()), Some("orientation-way"), "{found:#?}");
}

/// TNC 620 34056x-04, p. 340: M128 has to be off before `M91` and a tool call, and it stays on behind a break.
#[test]
fn a_heidenhain_takes_off_what_a_break_may_have_left_on_before_it_goes_home() {
    let text = proven(&five_axes(), &load("dmu50-heidenhain").unwrap());
    let at = |what: &str| text.lines().position(|line| line.contains(what)).unwrap();
    let [tip, plane, home, tool] = ["M129", "PLANE RESET STAY", "M91", "TOOL CALL"].map(at);
    assert!(tip < plane && plane < home && home < tool, "{text}");
    let upright = proven(&read(UPRIGHT), &load("generic-3axis-heidenhain").unwrap());
    assert!(!upright.contains("M129") && !upright.contains("PLANE RESET"), "{upright}");
}

#[test]
fn the_tolerance_of_the_orientation_is_that_of_the_machine_file() {
    let job = five_axes();
    let heidenhain = load("dmu50-heidenhain").unwrap();
    let text = proven(&job, &heidenhain);
    stands(&text, &["CYCL DEF 32.1 T0.01", "CYCL DEF 32.2 HSC-MODE:0 TA0.05"]);
    let wide = text.replace("TA0.05", "TA0.1");
    assert_eq!(found(&job, &heidenhain, &wide)[0].rule.name(), "orientation-tolerance");
    let rough =
        "extends = \"dmu50-heidenhain\"\n[options]\nhsc_mode = 1\norientation_tolerance = 1\n";
    stands(&proven(&job, &machine(rough)), &["CYCL DEF 32.2 HSC-MODE:1 TA1"]);
    let silent = "extends = \"dmu50-heidenhain\"\n[options]\norientation_tolerance = 0\n";
    stands(&proven(&job, &machine(silent)), &["CYCL DEF 32.2 HSC-MODE:0 TA0"]);

    let sinumerik = load("sinumerik-840d-traori").unwrap();
    let text = proven(&job, &sinumerik);
    stands(&text, &["CYCLE832(0.01,_ORI_FINISH,0.05)"]);
    let wide = text.replace("_ORI_FINISH,0.05", "_ORI_FINISH,0.1");
    assert_eq!(found(&job, &sinumerik, &wide)[0].rule.name(), "orientation-tolerance");
    let rough = "extends = \"sinumerik-840d-traori\"\n[options]\nmachining = \"ROUGH\"\n";
    stands(&proven(&job, &machine(rough)), &["CYCLE832(0.01,_ORI_ROUGH,0.05)"]);
    // By how much the tool turns behind this, setting data say, which nobody knows.
    let unsaid = text.replace("_ORI_FINISH,0.05", "_FINISH,1");
    assert_eq!(found(&job, &sinumerik, &unsaid)[0].rule.name(), "orientation-tolerance");
    let silent = "extends = \"sinumerik-840d-traori\"\n[options]\norientation_tolerance = 0\n";
    let mut under_traori = false;
    for block in blocks(&proven(&job, &machine(silent))) {
        under_traori = (under_traori || block.starts_with("TRAORI")) && block != "TRAFOOF";
        assert!(!(under_traori && block.starts_with("CYCLE832(0.")), "{block}");
    }
}

/// TNC manuals, M140: back along the tool to the end of the travel; on a tilting table that is Z of the machine.
#[test]
fn m140_retracts_where_only_tables_tilt() {
    let job = five_axes();
    let text = proven(
        &job,
        &machine("extends = \"dmu50-heidenhain\"\n[options]\nretract_by_m140 = true\n"),
    );
    stands(&text, &["; SLOPE", "L M140 MB MAX FMAX"]);
}

#[test]
fn a_sinumerik_takes_off_what_a_break_may_have_left_on_at_its_start_and_at_each_tool() {
    let traori = load("sinumerik-840d-traori").unwrap();
    let text = proven(&five_axes(), &traori);
    stands(&text, &["TRAFOOF", "CYCLE800()", "G17 G40 G54 G64 G710 G90 G94", "FFWON SOFT"]);
    // Z is home since the plane went off, and the head turns upright for the magazine.
    let change = ["G0 SUPA Z0 D0", "CYCLE800()", "TRAFOOF", "G17 G54", "M5", "M9", "G0 A0 C0"];
    stands(&text, &[&change[..], &["T=\"BALL_6\""]].concat());
    stands(&text, &["FFWOF BRISK", "M30"]);
    // A machine without rotary axes may have neither the option nor the cycle.
    let plain = proven(&read(UPRIGHT), &load("generic-3axis-sinumerik").unwrap());
    stands(&plain, &["G17 G54", "G0 SUPA Z0 D0", "M5", "T7"]);
    assert!(!["TRAFOOF", "CYCLE800", "FFWON"].iter().any(|word| plain.contains(word)), "{plain}");
}

#[test]
fn the_swivel_cycle_names_its_data_set_and_its_retract() {
    let text = "extends = \"sinumerik-840d-traori\"\n[options]\nswivel_retract = 1\nswivel_data = \"HEAD\"\n";
    let text = proven(&five_axes(), &machine(text));
    let cycle = blocks(&text).into_iter().find(|block| block.starts_with("CYCLE800(1,"));
    assert!(cycle.is_some_and(|cycle| cycle.starts_with("CYCLE800(1,\"HEAD\",0,57,")), "{text}");
}

/// Where nobody has switched them on since, a program stops neither spindle nor coolant twice.
#[test]
fn spindle_and_coolant_are_stopped_once() {
    for (name, job) in [
        ("dmu50-heidenhain", five_axes()),
        ("generic-3axis-heidenhain", read(UPRIGHT)),
        ("sinumerik-840d-traori", five_axes()),
        ("generic-3axis-sinumerik", read(UPRIGHT)),
    ] {
        let text = proven(&job, &load(name).unwrap());
        let mut turns = true;
        for block in blocks(&text) {
            let words: Vec<&str> = block.split(' ').collect();
            if block.starts_with(';') {
                continue;
            }
            if words.contains(&"M5") {
                assert!(turns, "{name}: M5 twice\n{text}");
                turns = false;
            }
            turns |= words.contains(&"M3") || words.contains(&"M4");
        }
    }
}

/// The source's tolerance is how far its path may lie inside and outside of the part together. What is less than the machine's figure is
/// said before the next cut, and behind it that figure is said again.
#[test]
fn a_control_follows_the_path_as_closely_as_the_source_says() {
    let with = |words: &str| read(&UPRIGHT.replacen("RAPID\n", &format!("{words}\nRAPID\n"), 1));
    let finer = with("INTOL/0.001\nOUTTOL/0.004");
    let heidenhain = load("generic-3axis-heidenhain").unwrap();
    stands(
        &proven(&finer, &heidenhain),
        &["L Z+2 R0 FMAX", "CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1 T0.005", "L Z-3 R0 F100"],
    );
    for words in ["INTOL/0.05", "TOLER/0.01", "INTOL/0"] {
        assert_eq!(proven(&with(words), &heidenhain).matches("TOLERANCE").count(), 1, "{words}");
    }
    let second = UPRIGHT.replacen("RAPID\n", "TOLER/0.005\nRAPID\n", 1);
    let second = read(&second.replacen("LOADTL/7", "TOLER/0.02\nLOADTL/7", 1));
    let text = proven(&second, &heidenhain);
    let said: Vec<_> =
        text.lines().filter_map(|line| line.split_once("32.1 ")).map(|(_, t)| t).collect();
    assert_eq!(said, ["T0.01", "T0.005", "T0.01"]);
    let haas = blocks(&proven(&finer, &load("generic-3axis-haas").unwrap()));
    assert_eq!(
        haas.iter().filter(|block| block.starts_with("G187")).collect::<Vec<_>>(),
        ["G187 E0.01", "G187 E0.005"]
    );
    let linuxcnc = blocks(&proven(&finer, &load("generic-3axis-linuxcnc").unwrap()));
    assert_eq!(
        linuxcnc.iter().filter(|block| block.starts_with("G64")).collect::<Vec<_>>(),
        ["G64 P0.005 Q0.005", "G64 P0.0025"]
    );
    // A control without a word for it says that it is not so close, and its program is not that of the source.
    let silent = "extends = \"generic-3axis-linuxcnc\"\n[blocks]\nlook_ahead_on = \"\"\n";
    let silent = machine(silent);
    let output = post::write(&finer, &silent).unwrap();
    assert!(
        output.warnings.iter().any(|found| found.rule.name() == "path-mode"),
        "{:#?}",
        output.warnings
    );
    let text = String::from_utf8(output.text).unwrap();
    assert_eq!(found(&finer, &silent, &text)[0].rule.name(), "path-tolerance");
}

#[test]
fn a_sinumerik_cuts_under_cycle832_and_drills_without_it() {
    let sinumerik = load("generic-3axis-sinumerik").unwrap();
    let text = proven(&read(UPRIGHT), &sinumerik);
    stands(&text, &["Z2", "CYCLE832(0.01,_FINISH,1)", "G1 Z-3 F100"]);
    stands(&text, &["CYCLE832(0,_OFF,1)", "G17 G54"]);
    let finer = read(&UPRIGHT.replacen("RAPID\n", "TOLER/0.004\nRAPID\n", 1));
    let rough =
        machine("extends = \"generic-3axis-sinumerik\"\n[options]\nmachining = \"ROUGH\"\n");
    stands(&proven(&finer, &rough), &["CYCLE832(0.004,_ROUGH,1)", "G1 Z-3 F100"]);
    let holes = std::fs::read_to_string(crate::files::root().join("examples/plate.cls")).unwrap();
    let text = proven(&read(&holes), &sinumerik);
    let mut on = false;
    for block in blocks(&text) {
        on = if block.starts_with("CYCLE832") { !block.contains("_OFF") } else { on };
        assert!(
            !(on && (block.starts_with("MCALL") || block == "M6" || block == "M30")),
            "{block} in\n{text}"
        );
    }
    let unsaid = machine("extends = \"generic-3axis-sinumerik\"\n[options]\npath_tolerance = 0\n");
    assert!(!proven(&read(UPRIGHT), &unsaid).contains("CYCLE832"));
}

/// `END PGM` ends a program without `M30`, which then has to stop spindle and coolant itself.
#[test]
fn a_heidenhain_without_m30_leaves_on_what_it_has_not_stopped() {
    let heidenhain = load("generic-3axis-heidenhain").unwrap();
    let job = read(&UPRIGHT.replacen("RAPID\n", "COOLNT/FLOOD\nRAPID\n", 1));
    let text = proven(&job, &heidenhain);
    let last = |text: &str, function: &str| {
        let (before, behind) = text.rsplit_once(&format!(" {function}\n")).unwrap();
        format!("{before} M90\n{behind}")
    };
    let without = last(&text, "M30");
    assert_eq!(found(&job, &heidenhain, &without), []);
    assert_eq!(found(&job, &heidenhain, &last(&text, "M5")), [], "M30 stops the spindle");
    for function in ["M5", "M9"] {
        let on = last(&without, function);
        assert_eq!(found(&job, &heidenhain, &on)[0].rule.name(), "left-on", "{function}\n{on}");
    }
}

#[test]
fn a_machine_may_activate_the_preset_of_its_work_offset() {
    let datum = machine("extends = \"generic-3axis-heidenhain\"\n[options]\ndatum = true\n");
    let text = proven(&read(UPRIGHT), &datum);
    assert!(text.contains(" CYCL DEF 247 DATUM SETTING ~\nQ339=+1 ;DATUM NUMBER\n"), "{text}");
    assert!(!proven(&read(UPRIGHT), &load("generic-3axis-heidenhain").unwrap()).contains("247"));
}

/// The cutter of 40 mm reaches 20 mm further than its tip, and not further down.
#[test]
fn the_blank_holds_what_the_tools_sweep() {
    let wide = read(&UPRIGHT.replacen("LOADTL/4,LENGTH,80", "CUTTER/40\nLOADTL/4,LENGTH,80", 1));
    stands(
        &proven(&wide, &load("generic-3axis-heidenhain").unwrap()),
        &["BLK FORM 0.1 Z X-20 Y-20 Z-3", "BLK FORM 0.2 X+60 Y+40 Z+0"],
    );
}
