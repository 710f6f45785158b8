//! What becomes of a control's events in a neutral program.

use control::{Setup, ToolData};
use geom::Vec3;
use machine::{Machine, load, load_origin};
use program::{Diagnostic, Op, Pose, Probe, Program};
use toolpost_nc as nc;

fn read_for(machine: &Machine, setup: Setup, text: &str) -> Result<nc::Reading, Box<Diagnostic>> {
    nc::read(machine, setup, "old.nc", text.as_bytes())
}

/// The mill with B and C on its table whose work zero stands where they cross.
fn table() -> Machine {
    let rotary = |letter: char, axis: &str| {
        format!(
            "[[rotary]]\nletter = \"{letter}\"\non = \"table\"\naxis = {axis}\npoint = [0, 0, 0]\nsign = -1\n\
             rapid = 9000\nacceleration = 300\n"
        )
    };
    let (b, c) = (rotary('B', "[0, 1, 0]"), rotary('C', "[0, 0, 1]"));
    let text = format!("extends = \"fanuc-table-bc\"\nwork_zero = [0, 0, 0]\n{b}{c}");
    machine::load_text("table.toml", &text).unwrap()
}

fn fanuc(text: &str) -> Program {
    let machine = load_origin("fanuc-31i").unwrap();
    read_for(&machine, Setup::default(), text).unwrap().program
}

fn refused(text: &str) -> Box<Diagnostic> {
    read_for(&load_origin("fanuc-31i").unwrap(), Setup::default(), text).unwrap_err()
}

/// What moves the tool, sends it home or changes it.
fn moves(program: &Program) -> Vec<(u32, &Op)> {
    let moves = |op: &Op| op.pose().is_some() || matches!(op, Op::Home | Op::Tool(_));
    program.records.iter().filter(|r| moves(&r.op)).map(|r| (r.line, &r.op)).collect()
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// It took a minute for 3,000 of them: the third power of their number.
#[test]
fn each_of_many_tools_that_are_called_by_name_gets_a_number_of_its_own() {
    let machine = load_origin("sinumerik-840d").unwrap();
    let called: String = (1..=20_000).map(|i| format!("T=\"TOOL_{i}\"\nM6\n")).collect();
    let text = format!("T5\nM6\n{called}T=\"TOOL_7\"\nM6\nM30\n");
    let program = read_for(&machine, Setup::default(), &text).unwrap().program;
    let tools = program.records.iter().filter_map(|record| match &record.op {
        Op::Tool(tool) => Some(tool.number),
        _ => None,
    });
    // 5 is taken.
    let expected = [5].into_iter().chain((1..=20_001).filter(|number| *number != 5)).chain([8]);
    assert!(tools.eq(expected));
}

#[test]
fn a_rapid_waits_until_every_coordinate_is_known() {
    let program = fanuc("G21 G90 G54 G0\nX10. Y20.\nZ5.\nG1 Z-1. F100.\nM30\n");
    let expected = [(3, &Op::Rapid(at(10.0, 20.0, 5.0))), (4, &Op::Line(at(10.0, 20.0, -1.0)))];
    assert_eq!(moves(&program), expected);
}

#[test]
fn where_z_is_at_its_switch_g92_says() {
    let machine = load_origin("marlin").unwrap();
    let known = Setup { start: Some(Vec3::new(0.0, 0.0, 50.0)), ..Setup::default() };
    let text = "G21\nG90\nG28 Z\nG92 Z0.8\nG1 Z-1 F100\nG1 X5\n";
    let program = read_for(&machine, known, text).unwrap().program;
    let expected = [
        &Op::Home,
        &Op::Rapid(at(0.0, 0.0, 0.8)),
        &Op::Line(at(0.0, 0.0, -1.0)),
        &Op::Line(at(5.0, 0.0, -1.0)),
    ];
    let found: Vec<_> = moves(&program).into_iter().map(|(_, op)| op).collect();
    assert_eq!(found, expected);
    // Where X and Y are nobody has said.
    let error = read_for(&machine, Setup::default(), text).unwrap_err();
    assert_eq!(error.rule.name(), "unknown-position");
}

/// The boring bar goes aside along X of the machine: on a table that has turned by 90 degrees that is
/// another direction in the work.
#[test]
fn a_boring_bar_goes_aside_as_the_table_stands() {
    let machine = table();
    let aside = |c: &str| {
        let setup = Setup { aside: Some(Vec3::X), ..Setup::default() };
        let text = format!(
            "G21 G90 G54\nT1 M6\nS500 M3\nG0 B0 C0\nX0 Y0 Z50.\nG0 C{c}\nG98 G76 X1. Y0 Z-20. R2. Q0.5 F50\n\
             X5.\nG80\nM30\n"
        );
        let program = read_for(&machine, setup, &text).unwrap().program;
        let aside = |op: &Op| match op {
            Op::Cycle(cycle) => cycle.kind.withdrawal().map(|withdrawal| withdrawal.aside),
            _ => None,
        };
        program.records.iter().filter_map(|record| aside(&record.op)).collect::<Vec<_>>()
    };
    assert_eq!(aside("0"), [Vec3::new(0.5, 0.0, 0.0)]);
    let turned = aside("90.");
    assert!(
        turned.len() == 1 && turned[0].x.abs() < 1e-12 && (turned[0].y.abs() - 0.5).abs() < 1e-12
    );
}

#[test]
fn z_home_stays_between_two_moves_and_goes_where_the_tool_is_changed() {
    let text = "G21 G90 G54 G0\nT1 M6\nX0. Y0.\nG43 Z5. H1\nG91 G28 Z0\nG90 X9. Y9.\nZ5.\n\
                G91 G28 Z0\nG90 T2 M6\nX1. Y1.\nG43 Z5. H2\nG91 G28 Z0\nM30\n";
    let program = fanuc(text);
    let found: Vec<_> = moves(&program).into_iter().map(|(line, op)| (line, op.pose())).collect();
    let expected = [
        (2, None),
        (4, Some(&at(0.0, 0.0, 5.0))),
        (5, None),
        (7, Some(&at(9.0, 9.0, 5.0))),
        (9, None),
        (11, Some(&at(1.0, 1.0, 5.0))),
    ];
    assert_eq!(found.len(), expected.len());
    for ((line, pose), (wanted, expected)) in found.iter().zip(expected) {
        assert_eq!((*line, *pose), (wanted, expected));
    }
    assert_eq!(moves(&program)[2].1, &Op::Home);
}

#[test]
fn a_cut_from_a_place_that_is_not_known_is_refused_with_its_line() {
    let found = refused("G21 G90 G54\nG0 X0. Y0.\nG1 Z-1. F100.\nM30\n");
    assert_eq!((found.rule.name(), found.line), ("unknown-position", 3));
    assert!(found.message.ends_with("not known in Z"), "{found}");
    let found = refused("G21 G90 G54\nG0 X0. Y0. Z9.\nG91 G28 Z0\nG90 G1 Z-1. F100.\nM30\n");
    assert_eq!((found.rule.name(), found.line), ("unknown-position", 4));
}

#[test]
fn where_the_tool_stands_at_the_start_stays_known_when_the_first_offset_is_named() {
    let machine = load_origin("grbl").unwrap();
    let start = Setup { start: Some(Vec3::new(0.0, 0.0, 50.0)), ..Setup::default() };
    let read = |text: &str| read_for(&machine, start.clone(), text);
    assert!(read("G21 G54\nG1 X5 F100\n").is_ok());
    assert_eq!(read("G21\nG1 X5 F100\nG55\nG1 X6\n").unwrap_err().rule.name(), "unknown-position");
}

#[test]
fn the_register_of_a_length_offset_is_that_of_the_tool() {
    let program = fanuc("G21 G90 G54\nT3 M6\nG0 X0. Y0.\nG43 Z5. H13\nM30\n");
    let Op::Tool(tool) = moves(&program)[0].1 else { panic!("no tool") };
    assert_eq!((tool.number, tool.offset), (3, Some(13)));
    let found = refused("G21 G90 G54\nT3 M6\nG0 X0. Y0.\nG43 Z5. H3\nG43 Z4. H13\nM30\n");
    assert_eq!((found.rule.name(), found.line), ("length-offset", 5));
}

#[test]
fn rotary_positions_become_a_tool_axis_by_the_machine_of_the_program() {
    // C turns the table left-handed about Z: at C90 a point on X of the machine is one on Y of the part.
    let machine = table();
    let text = "G21 G90 G54\nT1 M6\nG0 B0 C90.\nX10. Y0.\nG43 Z5. H1\nG1 Z1. F100.\nM30\n";
    let reading = read_for(&machine, Setup::default(), text).unwrap();
    let poses: Vec<Vec3> =
        moves(&reading.program).iter().filter_map(|(_, op)| op.pose()).map(|p| p.point()).collect();
    assert_eq!(poses.len(), 2);
    assert!(poses[0].distance(Vec3::new(0.0, 10.0, 5.0)) < 1e-9, "{}", poses[0]);
    // B tilts the table: what stood upright leans towards X.
    let text = "G21 G90 G54\nT1 M6\nG0 B-30. C0.\nG43.4 H1 X0. Y0. Z5.\nG1 Z1. F100.\nM30\n";
    let reading = read_for(&machine, Setup::default(), text).unwrap();
    let axis = moves(&reading.program)[1].1.pose().unwrap().axis();
    let leaning = Vec3::new(-0.5, 0.0, 0.75_f64.sqrt());
    assert!(axis.distance(leaning) < 1e-9, "{axis}");
}

#[test]
fn an_arc_on_a_turned_table_turns_with_it() {
    let machine = table();
    let text =
        "G21 G90 G54\nT1 M6\nG0 B0 C90.\nX10. Y0.\nG43 Z5. H1\nG3 X0. Y10. I-10. J0. F100.\nM30\n";
    let reading = read_for(&machine, Setup::default(), text).unwrap();
    let Op::Arc(arc) = moves(&reading.program)[2].1 else { panic!("no arc") };
    let apart = |a: Vec3, b: Vec3| a.distance(b) < 1e-9;
    assert!(apart(arc.end.point(), Vec3::new(-10.0, 0.0, 5.0)), "{}", arc.end.point());
    assert!(
        apart(arc.circle.center(), Vec3::new(0.0, 0.0, 5.0)) && apart(arc.circle.normal(), Vec3::Z)
    );
}

#[test]
fn a_turned_head_needs_the_length_of_the_tool() {
    let machine = load("sinumerik-840d-traori").unwrap();
    let text = "G90 G54\nT1\nM6\nD1\nG0 A90 C0\nX0 Y0 Z0\nG1 X5 F100\nM30\n";
    let found = read_for(&machine, Setup::default(), text).unwrap_err();
    assert_eq!((found.rule.name(), found.line), ("tool-length", 7));
    let tool = ToolData { number: 1, name: String::new(), radius: 3.0, length: 100.0 };
    let setup = Setup { tools: vec![tool], ..Setup::default() };
    assert!(read_for(&machine, setup, text).is_ok());
}

#[test]
fn a_tool_with_a_name_gets_a_number_and_a_warning_says_so() {
    let machine = load_origin("sinumerik-840d").unwrap();
    let text = "G90 G54\nT=\"MILL\"\nM6\nT=\"DRILL\"\nM6\nT=\"MILL\"\nM6\nM30\n";
    let numbers = |reading: &nc::Reading| -> Vec<u32> {
        let tool = |op: &Op| if let Op::Tool(tool) = op { Some(tool.number) } else { None };
        reading.program.records.iter().filter_map(|r| tool(&r.op)).collect()
    };
    let reading = read_for(&machine, Setup::default(), text).unwrap();
    assert_eq!(numbers(&reading), [1, 2, 1]);
    assert_eq!(reading.warnings.iter().map(|w| w.line).collect::<Vec<_>>(), [3, 5]);
    let drill = ToolData { number: 7, name: "drill".into(), radius: 2.0, length: 80.0 };
    let setup = Setup { tools: vec![drill], ..Setup::default() };
    assert_eq!(numbers(&read_for(&machine, setup, text).unwrap()), [1, 7, 1]);
    let text = "G90 G54\nT=\"MILL\"\nM6\nT1\nM6\nM30\n";
    assert_eq!(read_for(&machine, Setup::default(), text).unwrap_err().rule.name(), "tool-number");
}

#[test]
fn axes_are_not_sent_home_next_to_the_part() {
    let found = refused("G21 G90 G54\nG0 X0. Y0. Z5.\nG91 G28 X0 Y0\nM30\n");
    assert_eq!((found.rule.name(), found.line), ("home", 3));
    fanuc("G21 G90 G54\nG0 X0. Y0. Z5.\nG91 G28 Z0\nG28 X0 Y0\nM30\n");
}

#[test]
fn several_work_offsets_stay_and_the_first_alone_is_left_to_the_machine() {
    let cut = "G0 X0. Y0.\nZ5.\nG1 Z-1. F100.\nG0 Z5.\n";
    let offsets = |program: &Program| -> Vec<(u32, u32)> {
        let number = |op: &Op| if let Op::WorkOffset(n) = op { Some(n.number()) } else { None };
        program.records.iter().filter_map(|r| Some((r.line, number(&r.op)?))).collect()
    };
    assert_eq!(offsets(&fanuc(&format!("G21 G90 G54\n{cut}M30\n"))), []);
    assert_eq!(offsets(&fanuc(&format!("G21 G90 G55\n{cut}M30\n"))), [(1, 55)]);
    let two = format!("G21 G90 G54\n{cut}G55\n{cut}M30\n");
    assert_eq!(offsets(&fanuc(&two)), [(1, 54), (6, 55)]);
    // Where the tool stands in the new frame nobody knows.
    let found = refused("G21 G90 G54\nG0 X0. Y0. Z5.\nG55\nG1 Z-1. F100.\nM30\n");
    assert_eq!(found.line, 4);
}

#[test]
fn threads_and_probes_are_moves_at_feed() {
    let start = "G21 G90 G54 G0\nS100 M3\nX0 Y0 Z5.\n";
    let thread = fanuc(&format!("{start}G33 Z-9. F1.5\nG0 Z5.\nM30\n"));
    let end = thread.records.iter().find_map(|record| match &record.op {
        Op::Thread(thread) => Some((thread.end, thread.pitch())),
        _ => None,
    });
    assert_eq!(end, Some((at(0.0, 0.0, -9.0), 1.5)));
    let probe = fanuc(&format!("{start}G31 Z-9. F100.\nG0 Z5.\nM30\n"));
    let end = at(0.0, 0.0, -9.0);
    let skip = Op::Probe(Box::new(Probe { end, away: false, must_answer: false, place: None }));
    assert!(probe.records.iter().any(|record| record.op == skip));
    // Where the probe has stopped is not known: nothing is cut from there.
    assert_eq!(
        refused(&format!("{start}G31 Z-9. F100.\nG1 Z-5.\nM30\n")).rule.name(),
        "unknown-position"
    );
}

/// Charmilles, FANUC and others begin a wire's program so: the operator has brought it to the place.
#[test]
fn a_cut_may_begin_where_g92_says_that_the_tool_stands() {
    let wire = |text: &str| {
        read_for(&load_origin("fanuc-wire").unwrap(), Setup::default(), text).map(|r| r.program)
    };
    let program = wire("G21 G90\nG92 X5. Y-3.\nG1 X10.\nM2\n").unwrap();
    let expected = [(3, &Op::Rapid(at(5.0, -3.0, 0.0))), (3, &Op::Line(at(10.0, -3.0, 0.0)))];
    assert_eq!(moves(&program), expected);
    assert_eq!(
        wire("G21 G90\nG92 X5.\nG1 X10. Y0.\nM2\n").unwrap_err().rule.name(),
        "unknown-position"
    );
}

/// A file that is cut off is no program: FANUC and Haas end by M30 or M2, LinuxCNC by those or a second `%` (manual, "File
/// Requirements"); of GRBL and Mach3 many programs have no end, and Marlin has no code for it.
#[test]
fn a_program_that_is_cut_off_is_refused_where_its_control_knows_an_end() {
    let found = |machine: &str, text: &str| {
        let machine = machine::load(machine).unwrap();
        match nc::read(&machine, Setup::default(), "p.nc", text.as_bytes()) {
            Ok(reading) => {
                let ends = reading.warnings.iter().find(|found| found.rule.name() == "program-end");
                ends.map_or("whole", |_| "reported")
            }
            Err(error) => {
                assert!(error.line > 0 && !error.help.is_empty(), "{error}");
                error.rule.name()
            }
        }
    };
    let body = "G21 G90 G94 G17 G54\nG0 X0. Y0.\n";
    for (machine, no_end, one_percent) in [
        ("generic-3axis-fanuc", "program-end", "program-end"),
        ("generic-3axis-haas", "program-end", "program-end"),
        ("generic-3axis-iso", "program-end", "program-end"),
        ("generic-3axis-linuxcnc", "program-end", "program-end"),
        ("generic-3axis-mach3", "reported", "program-end"),
        ("generic-3axis-grbl", "reported", "syntax"),
        ("generic-3axis-marlin", "whole", "syntax"),
    ] {
        let body =
            if machine.ends_with("marlin") { "G21\nG90\nG17\nG54\nG0 X0 Y0\n" } else { body };
        assert_eq!(found(machine, body), no_end, "{machine}");
        let marlin = machine.ends_with("marlin");
        let ended = if marlin { body.into() } else { format!("{body}M30\n") };
        assert_eq!(found(machine, &ended), "whole", "{machine}");
        let open = found(machine, &format!("%\n{body}"));
        assert!(open == one_percent || open.starts_with("nc-"), "{machine}: {open}");
        assert_eq!(found(machine, ""), "program-end", "{machine}");
    }
    assert_eq!(found("generic-3axis-linuxcnc", &format!("%\n{body}%\n")), "whole");
    assert_eq!(found("generic-3axis-fanuc", &format!("%\nO1\n{body}%\n")), "program-end");
    assert_eq!(found("generic-3axis-fanuc", &format!("%\nO1\n{body}M30\n")), "reported");
    assert_eq!(found("generic-3axis-fanuc", &format!("%\nO1\n{body}M30\n%\n")), "whole");
}

/// The registers of the tools of a program, and the findings about its lengths.
fn registers(control: &str, text: &str) -> (Vec<(u32, Option<u32>)>, Vec<Diagnostic>) {
    let machine = load_origin(control).unwrap();
    let reading = read_for(&machine, Setup::default(), text).unwrap_or_else(|e| panic!("{e}"));
    let tools = reading.program.records.iter().filter_map(|record| match &record.op {
        Op::Tool(tool) => Some((tool.number, tool.offset)),
        _ => None,
    });
    let findings =
        reading.warnings.into_iter().filter(|found| found.rule.name() == "length-offset");
    (tools.collect(), findings.collect())
}

const CUT: &str = "G0 X0. Y0. Z5.\nG1 Z-1. F90.\nX9.\nG0 Z5.\n";

#[test]
fn a_tool_that_cuts_without_a_length_offset_is_reported_once() {
    for control in ["fanuc-31i", "haas", "linuxcnc", "mach3"] {
        let text = format!("G21 G90 G94 G54\nT2 M6\nS900 M3\n{CUT}T2 M6\n{CUT}M30\n");
        let (tools, findings) = registers(control, &text);
        assert_eq!(tools, [(2, None), (2, None)], "{control}");
        let [found] = &findings[..] else { panic!("{control}: {findings:?}") };
        assert!(found.line == 5 && found.message.contains("register 2"), "{control}: {found}");
        // With G43 nothing is reported.
        let text = format!("G21 G90 G94 G54\nT2 M6\nS900 M3\nG0 X0. Y0.\nG43 H2 Z9.\n{CUT}M30\n");
        assert_eq!(registers(control, &text), (vec![(2, None)], vec![]), "{control}");
    }
    // These take the length with the tool.
    for (control, text) in [
        ("grbl", format!("G21 G90 G94 G54\nT2\nS900 M3\n{CUT}M30\n")),
        ("sinumerik-840d", format!("G71 G90 G94 G54\nT2 M6\nS900 M3\n{CUT}M30\n")),
    ] {
        assert!(registers(control, &text).1.is_empty(), "{control}");
    }
}

/// G43 and its register stay on through a tool change: the control cuts with the length of the other tool.
#[test]
fn a_length_offset_that_was_called_before_the_tool_stays_its_own_and_is_reported() {
    let first = format!("T1 M6\nS900 M3\nG0 X0. Y0.\nG43 H1 Z9.\n{CUT}");
    for second in ["", "G43 H1\n"] {
        for control in ["fanuc-31i", "haas", "linuxcnc"] {
            let text = format!("G21 G90 G94 G54\n{first}T2 M6\nS900 M3\n{second}{CUT}M30\n");
            let (tools, findings) = registers(control, &text);
            assert_eq!(tools, [(1, None), (2, Some(1))], "{control}: {second}");
            let [found] = &findings[..] else { panic!("{control}: {findings:?}") };
            assert!(
                found.message.contains("offset 1") && found.message.contains("place of 2"),
                "{found}"
            );
        }
    }
    let text = format!("G21 G90 G94 G54\nG43 H1\nT2 M6\nS900 M3\n{CUT}M30\n");
    let (tools, findings) = registers("fanuc-31i", &text);
    assert_eq!((&tools[..], findings.len()), (&[(2, Some(1))][..], 2));
}

#[test]
fn a_tool_that_cuts_with_and_without_its_length_offset_is_refused() {
    let start = "G21 G90 G94 G54\nT2 M6\nS900 M3\n";
    let found = refused(&format!("{start}{CUT}G43 H2\n{CUT}M30\n"));
    assert_eq!((found.rule.name(), found.line), ("length-offset", 10), "{found}");
    let found = refused(&format!("{start}G43 H2\n{CUT}G49\n{CUT}M30\n"));
    assert_eq!((found.rule.name(), found.line), ("length-offset", 11), "{found}");
    // Up and home without it is no cut.
    fanuc(&format!("{start}G43 H2\n{CUT}G49 G0 Z9.\nM30\n"));
}

/// Nothing is 1 km away, as in cutter-location data: sums over such places are infinite, and no summary could say them.
#[test]
fn a_place_beyond_every_machine_is_refused_with_its_line() {
    let digits = "9".repeat(300);
    const START: &str = "G21 G90 G94\nT1 M6\nS100 M3\nG0 X0. Y0. Z5.\n";
    for block in [
        format!("G1 Z-{digits}. F100."),
        "G0 X1000001.".into(),
        format!("G2 X10. Y0. I{digits}. J0. F100."),
        "G91 G0 X900000.\nX900000.".into(),
    ] {
        let error = refused(&format!("{START}{block}\nM30\n"));
        let line = 5 + block.matches('\n').count() as u32;
        assert_eq!((error.rule.name(), error.line), ("out-of-range", line), "{block}");
        assert!(error.message.len() < 200, "{error}");
    }
    for block in [format!("G4 X{digits}."), format!("G1 X5. F{digits}."), format!("S{digits} M3")] {
        assert_eq!(
            refused(&format!("{START}{block}\nM30\n")).rule.name(),
            "out-of-range",
            "{block}"
        );
    }
    assert!(fanuc(&format!("{START}G1 X1000000. F100.\nM30\n")).records.len() > 3);
}

/// `T0` is no tool: a program that puts its last tool away ends with it (TNC 640, "Tool call": `TOOL CALL 0`).
#[test]
fn an_empty_spindle_is_no_tool() {
    let program = "G21 G17 G90 G94 G40 G49 G80 G54\nT1 M6\nS900 M3\nG0 X0 Y0\nG43 Z20. H1\nG1 Z-1. F100\nG0 Z20.\nG49\nM5\nG91 G28 Z0\nG90\nT0 M6\n";
    let machine = load_origin("fanuc-31i").unwrap();
    let end = format!("{program}M30\n");
    let reading = read_for(&machine, Setup::default(), &end).unwrap();
    let tools = reading.program.records.iter().filter(|r| matches!(r.op, Op::Tool(_))).count();
    assert_eq!(tools, 1);
    let said = |found: &Diagnostic| found.rule == "tool" && found.message.contains("emptied");
    assert_eq!(reading.warnings.iter().filter(|found| said(found)).count(), 1);
    // It moves on without a tool, which cuts nothing.
    let moved = read_for(&machine, Setup::default(), &format!("{program}G0 X100.\nM30\n")).unwrap();
    assert_eq!(moves(&moved.program), moves(&reading.program));
    let cut = format!("{program}S900 M3\nG0 X0 Y0\nZ5.\nG1 Z-1. F100\nM30\n");
    let found = refused(&cut);
    assert_eq!(found.rule, "tool", "{found:?}");
    assert!(found.message.contains("line 12 has emptied the spindle"), "{}", found.message);
}
