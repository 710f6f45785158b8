//! Jobs as FreeCAD gives them: what becomes of their commands, and what is refused.

use geom::Vec3;
use program::{Coolant, Cycle, CycleKind, Diagnostic, Feed, Op, Program, Purpose, Spindle};
use serde_json::{Value, json};
use toolpost_freecad::{self as freecad, Job};

const TOOL: &str = "(Mill 5)\nM6 T1.000000\nM3 S2000.000000\n";

/// A job of a tool controller and these operations.
fn job(operations: Value) -> Value {
    let mut all = vec![json!({ "label": "Mill 5", "commands": TOOL })];
    all.extend(operations.as_array().unwrap().iter().cloned());
    let tools = json!([{ "number": 1, "name": "Mill 5", "diameter": 5.0, "length": 50.0 }]);
    let (toolpost, version) = ("freecad-job", 1);
    json!({ "toolpost": toolpost, "version": version, "name": "part", "tools": tools, "operations": all })
}

/// A job of one operation.
fn operation(commands: &str) -> Value {
    job(json!([{ "label": "Profile", "commands": commands }]))
}

fn read_on(machine: &str, job: &Value) -> Result<Program, Box<Diagnostic>> {
    let job = Job::of("part.json", job.to_string().as_bytes())?;
    let machine = machine::load(machine).unwrap();
    Ok(freecad::read(&machine, "part.json", job, Purpose::Program)?.program)
}

fn read(job: &Value) -> Result<Program, Box<Diagnostic>> {
    read_on("generic-3axis-sinumerik-828d", job)
}

fn ops(job: &Value) -> Vec<Op> {
    let program = read(job).unwrap_or_else(|found| panic!("{found}"));
    program.records.into_iter().map(|record| record.op).collect()
}

/// What is wrong with a job: the rule, where, and the way out.
#[track_caller]
fn refused(job: &Value, rule: &str, place: &str, help: &str) {
    let found = read(job).unwrap_err();
    assert_eq!(found.rule.name(), rule, "{found}");
    assert_eq!(format!("{}:{}", found.file, found.line), place, "{found}");
    assert!(found.help.contains(help), "{found}");
}

#[test]
fn the_stock_of_a_job_is_that_of_the_program() {
    let mut stated = operation(&format!("(Profile)\n{START}"));
    assert_eq!(read(&stated).unwrap().stock, None);
    stated["stock"] = json!({ "low": [0, 0, -10], "high": [80, 50, 1] });
    let corners = [[0.0, 0.0, -10.0], [80.0, 50.0, 1.0]].map(Vec3::from);
    assert_eq!(read(&stated).unwrap().stock, Some(corners));
    stated["stock"] = json!({ "low": [0, 0] });
    assert_eq!(read(&stated).unwrap_err().rule.name(), "freecad-job");
}

const START: &str = "G0 Z20.000000\nG0 X1.000000 Y2.000000\n";

#[test]
fn an_operation_has_its_name_its_tool_and_its_moves() {
    let text = format!("(Profile)\n{START}G1 F3.333333 X1.000000 Y2.000000 Z-1.500000\n");
    let ops = ops(&operation(&text));
    let Op::Tool(tool) = &ops[0] else { panic!("{ops:?}") };
    assert_eq!((tool.number, tool.name.as_str(), tool.diameter), (1, "Mill 5", Some(5.0)));
    // The length of a tool bit is not that from the spindle.
    assert_eq!(tool.length, None);
    assert_eq!(
        ops[1..3],
        [Op::Spindle(Spindle::Clockwise(2000.0)), Op::Operation("Profile".into())]
    );
    assert_eq!(ops[3].pose().unwrap().point(), Vec3::new(1.0, 2.0, 20.0));
    assert_eq!(ops[4], Op::Feed(Feed::PerMinute(200.0)));
    assert_eq!(ops[5].pose().unwrap().point(), Vec3::new(1.0, 2.0, -1.5));
    assert_eq!(ops[6..], [Op::EndOfOperation, Op::End]);
}

#[test]
fn f_in_the_block_of_a_rapid_is_not_the_feed() {
    let text =
        format!("{START}G0 F0.000000 Z5.000000\nG1 F1.5 Z0.000000\nG0 F50.0 Z5.0\nG1 Z1.0\n");
    let feeds: Vec<Op> =
        ops(&operation(&text)).into_iter().filter(|op| matches!(op, Op::Feed(_))).collect();
    assert_eq!(feeds, [Op::Feed(Feed::PerMinute(90.0))]);
}

#[test]
fn coolant_runs_in_its_operations_and_not_between_them() {
    let cut = format!("{START}G1 F2.0 Z0.0\nG0 Z20.0\n");
    let job = job(json!([
        { "label": "A", "coolant": "flood", "commands": cut },
        { "label": "B", "coolant": "flood", "commands": cut },
        { "label": "C", "coolant": "mist", "commands": cut },
        { "label": "D", "commands": cut },
    ]));
    let coolant = ops(&job).into_iter().filter_map(|op| match op {
        Op::Coolant(coolant) => Some(coolant),
        _ => None,
    });
    let expected = [Coolant::Flood, Coolant::Off, Coolant::Mist, Coolant::Off];
    assert_eq!(coolant.collect::<Vec<_>>(), expected);
}

#[test]
fn work_offsets_are_those_of_the_list() {
    let cut = format!("{START}G1 F2.0 Z0.0\nG0 Z20.0\n");
    let job = job(json!([
        { "label": "G54", "commands": "G54\n" },
        { "label": "A", "commands": cut },
        { "label": "G59.9", "commands": "G59.9\nG0 Z26.0\n" },
        { "label": "A", "commands": cut },
    ]));
    let offsets = ops(&job).into_iter().filter_map(|op| match op {
        Op::WorkOffset(offset) => Some(offset.number()),
        _ => None,
    });
    assert_eq!(offsets.collect::<Vec<_>>(), [54, 68]);
}

/// FreeCAD 0.20's drilling of two holes, 24 mm deep, in pecks of 3 mm.
#[test]
fn holes_of_one_cycle_stay_together() {
    let text = "(Begin Drilling)\nG0 F0.000000 Z26.000000\nG90\nG98\nG0 X70.0 Y15.0\nG0 Z24.0\n\
        G83 F1.500000 Q3.000000 R24.000000 X70.000000 Y15.000000 Z0.000000\n\
        G0 X70.0 Y35.0\nG0 Z24.0\n\
        G83 F1.500000 Q3.000000 R24.000000 X70.000000 Y35.000000 Z0.000000\nG80\nG0 Z26.0\n";
    let cycle = Cycle {
        kind: CycleKind::Deep,
        depth: 24.0,
        clearance: 0.0,
        retract: 0.0,
        feed: None,
        dwell: 0.0,
        first_peck: Some(3.0),
        peck: Some(3.0),
    };
    let ops = ops(&operation(text));
    let from = ops.iter().position(|op| matches!(op, Op::Cycle(_))).unwrap();
    assert_eq!(ops[from], Op::Cycle(cycle.into()));
    assert_eq!(ops[from + 1].pose().unwrap().point(), Vec3::new(70.0, 15.0, 24.0));
    assert_eq!(ops[from + 2].pose().unwrap().point(), Vec3::new(70.0, 35.0, 24.0));
    assert!(matches!(ops[from + 3..], [Op::CycleOff, Op::Rapid(_), Op::EndOfOperation, Op::End]));
}

/// Points between two holes are kept, and a cycle with another depth is another one.
#[test]
fn a_way_that_is_not_that_of_the_cycle_stays() {
    let hole = |y: f64, z: f64| format!("G81 F1.5 R2.0 X0.0 Y{y:.1} Z{z:.1}\n");
    for between in ["G0 X9.0 Y9.0\n", "G0 Z10.0\nG0 Z2.0\n"] {
        let text = format!(
            "{START}G0 X0.0 Y0.0\nG0 Z2.0\n{}{between}G0 X0.0 Y5.0\n{}",
            hole(0.0, -4.0),
            hole(5.0, -4.0)
        );
        let ops = ops(&operation(&text));
        assert_eq!(ops.iter().filter(|op| matches!(op, Op::Cycle(_))).count(), 2, "{between}");
    }
    let text = format!(
        "{START}G0 X0.0 Y0.0\nG0 Z2.0\n{}G0 X0.0 Y5.0\n{}",
        hole(0.0, -4.0),
        hole(5.0, -5.0)
    );
    assert_eq!(ops(&operation(&text)).iter().filter(|op| matches!(op, Op::Cycle(_))).count(), 2);
}

/// FreeCAD's tapping writes the pitch as F (`Generator/tapping.py`).
#[test]
fn with_a_tap_f_is_the_pitch() {
    let tap = format!("{START}G0 Z5.0\nG84 F1.25 R5.0 S300.0 X1.0 Y2.0 Z-8.0\nG80\nG0 Z20.0\n");
    let ops = ops(&operation(&tap));
    assert!(ops.contains(&Op::Spindle(Spindle::Clockwise(300.0))));
    let cycle = ops.iter().find_map(|op| match op {
        Op::Cycle(cycle) => Some(cycle.kind),
        _ => None,
    });
    assert_eq!(cycle, Some(CycleKind::Tap { pitch: 1.25, left: false }));
    // The pitch is no feed for what follows.
    let cut = format!("{tap}G1 X9.0\n");
    refused(&operation(&cut), "feed", "part.json: operation `Profile`:7", "tool controller");
}

/// FreeCAD's posts write 60 F in every mode, so that F counts a second: `G93` F0.5 is 30 moves a minute.
#[test]
fn feeds_are_a_second_in_every_mode() {
    let text = format!(
        "{START}G1 F2.0 Z5.0\nG93\nG1 F0.500000 X5.0\nG1 F0.205761 X9.0\nG95\nG1 F0.001667 X12.0\nG1 X13.0\n\
         G94\nG1 F3.333333 X20.0\n"
    );
    let ops = ops(&operation(&text));
    let feeds = ops.iter().filter_map(|op| match op {
        Op::Feed(feed) => Some(*feed),
        _ => None,
    });
    assert_eq!(
        feeds.collect::<Vec<_>>(),
        [
            Feed::PerMinute(120.0),
            Feed::InverseTime(30.0),
            Feed::InverseTime(0.205761 * 60.0),
            Feed::PerTurn(0.1),
            Feed::PerMinute(200.0),
        ]
    );
    let place = "part.json: operation `Profile`:6";
    // Each move of its own time has an F, and the number of one mode means nothing in another.
    let alone = format!("{START}G1 F2.0 Z5.0\nG93\nG1 F0.5 X5.0\nG1 X9.0\n");
    refused(&operation(&alone), "feed", place, "tool controller");
    let back = format!("{START}G93\nG1 F0.5 X5.0\nG94\nG1 X9.0\n");
    refused(&operation(&back), "feed", place, "tool controller");
}

#[test]
fn an_arc_has_its_centre_from_its_start_and_its_k_means_nothing() {
    let text = format!("{START}G1 F2.0 Z0.0\nG3 F2.0 I0.0 J5.0 K3.0 X1.0 Y12.0 Z-1.0\n");
    let ops = ops(&operation(&text));
    let Some(Op::Arc(arc)) = ops.iter().find(|op| matches!(op, Op::Arc(_))) else { panic!() };
    assert_eq!(arc.circle.center().with_z(0.0), Vec3::new(1.0, 7.0, 0.0));
    assert_eq!((arc.end.point(), arc.circle.normal()), (Vec3::new(1.0, 12.0, -1.0), Vec3::Z));
}

/// A rotary axis is that of the machine; a job without one is made by every mill.
#[test]
fn words_for_rotary_axes_need_a_machine_that_has_them() {
    let cut = format!("G0 A0.0 C0.0\n{START}G1 F2.0 Z0.0\n");
    refused(&operation(&cut), "unknown-axis", "part.json: operation `Profile`:1", "rotary axes");
    assert!(read_on("sinumerik-840d-table-ac", &operation(&cut)).is_ok());
    let upright = operation(&format!("{START}G1 F2.0 Z0.0\n"));
    assert_eq!(read_on("sinumerik-840d-table-ac", &upright), read(&upright));
}

#[test]
fn comments_may_hold_brackets_and_any_letter() {
    let job = job(json!([{ "label": "Tasche (größer)", "commands":
        format!("(Tasche (größer))\n(a (b) c)\n{START}") }]));
    let ops = ops(&job);
    assert!(ops.contains(&Op::Operation("Tasche (größer)".into())));
    // The label is said once.
    assert_eq!(ops.iter().filter(|op| matches!(op, Op::Comment(_))).count(), 1);
    assert!(ops.contains(&Op::Comment("a (b) c".into())));
}

#[test]
fn operations_that_are_not_active_are_left_out() {
    let cut = format!("{START}G1 F2.0 Z0.0\n");
    let job = job(json!([
        { "label": "A", "active": false, "commands": "G999\n" },
        { "label": "B", "active": true, "commands": cut },
    ]));
    let operations = ops(&job).into_iter().filter(|op| matches!(op, Op::Operation(_)));
    assert_eq!(operations.collect::<Vec<_>>(), [Op::Operation("B".into())]);
}

#[test]
fn an_operation_has_a_line_for_each_command() {
    let cut = format!("{START}G1 F2.0 Z0.0\n");
    let lines = cut.lines().count();
    let counted = |count: usize| {
        job(json!([
            { "label": "A", "coolant": "mist", "count": 0, "commands": "" },
            { "label": "B", "coolant": "flood", "count": count, "commands": cut },
        ]))
    };
    assert!(!ops(&counted(lines)).is_empty());
    for wrong in [lines - 1, lines + 1] {
        refused(&counted(wrong), "freecad-lines", "part.json:0", "line break");
    }
}

#[test]
fn operations_keep_their_order_however_long_they_are() {
    let lengths = [3, 200, 1, 40, 900, 5000, 2];
    let mut count = 0;
    let operations = lengths.map(|moves| {
        let lines = (0..moves).map(|_| {
            count += 1;
            format!("G0 X{count}.000000")
        });
        let lines: Vec<String> = lines.collect();
        let commands = format!("G0 Z20.000000 Y0.000000\n{}", lines.join("\n"));
        json!({ "label": format!("of {moves}"), "commands": commands })
    });
    let ops = ops(&job(json!(operations)));
    let mut stops: Vec<f64> = ops.iter().filter_map(|op| Some(op.pose()?.point().x)).collect();
    stops.dedup();
    assert!(stops.into_iter().eq((1..=count).map(f64::from)));
    // A finding has its operation and the number of its command.
    let mut operations = operations;
    operations[4]["commands"] = json!("G0 X1.000000\nG1 Q1.000000");
    refused(&job(json!(operations)), "unused-word", "part.json: operation `of 900`:2", "");
}

#[test]
fn an_empty_job_is_refused() {
    for operations in [json!([]), json!([{ "label": "A", "active": false, "commands": START }])] {
        refused(&job(operations), "no-motion", "part.json:0", "active");
    }
}

#[test]
fn what_an_operation_lacks_is_reported_with_the_operation_and_its_command() {
    let place = |command: u32| format!("part.json: operation `Profile`:{command}");
    // Feed.
    let zero = operation(&format!("{START}G1 F0.000000 Z0.0\n"));
    refused(&zero, "feed", &place(3), "tool controller");
    refused(&operation(&format!("{START}G1 Z0.0\n")), "feed", &place(3), "tool controller");
    // Tool.
    let mut bare = operation(&format!("{START}G1 F2.0 Z0.0\n"));
    bare["operations"].as_array_mut().unwrap().remove(0);
    refused(&bare, "no-tool", &place(2), "tool controller");
    let cut = json!({ "label": "Profile", "tool": 4, "commands": START });
    refused(&job(json!([cut])), "tool-number", &place(2), "tool controller");
    // Number of the tool, speed of the spindle.
    for (controller, rule) in [
        ("M6 T0.000000\nM3 S2000.0\n", "tool"),
        ("M6 T1.000000\nM3 S0.000000\n", "spindle-speed"),
        ("M6 T1.000000\nM3\n", "spindle"),
    ] {
        let mut job = operation(START);
        job["operations"][0]["commands"] = controller.into();
        let found = read(&job).unwrap_err();
        assert_eq!(
            (found.rule.name(), found.file.as_str()),
            (rule, "part.json: operation `Mill 5`")
        );
        assert!(found.help.contains("tool controller"), "{found}");
    }
    let mut standing = operation(&format!("{START}G1 F2.0 Z0.0\n"));
    standing["operations"][0]["commands"] = "M6 T1.0\n".into();
    refused(&standing, "spindle-off", &place(3), "tool controller");
}

#[test]
fn commands_that_mean_nothing_are_named() {
    let place = "part.json: operation `Profile`:3";
    let wrong = |command: &str| operation(&format!("{START}{command}\n"));
    refused(&wrong("G123 X1.0"), "unknown-word", place, "commands of the operation");
    refused(&wrong("M77"), "unknown-word", place, "auxiliary");
    refused(&wrong("G20"), "unknown-word", place, "in mm");
    // FreeCAD itself takes the words behind it.
    refused(&wrong("G1 X7.000000 ;Y9.000000"), "syntax", place, "a command of its own");
    // A NaN, and an infinite number, as `toGCode` writes them, and by their names.
    for number in ["-922337203685.477581", "nan", "-inf"] {
        for letter in ["X", "I", "F"] {
            let nothing = format!("G2 {letter}{number} Y2.0");
            refused(&wrong(&nothing), "number", place, "recompute");
        }
    }
}

#[test]
fn a_million_commands_are_read() {
    let mut text = String::from(START) + "G1 F2.0 Z0.0\n";
    let moves = 1_000_000;
    for n in 0..moves {
        // No two neighbours are the same place.
        text += if n % 2 == 0 { "G1 X5.000000\n" } else { "G1 X1.000000\n" };
    }
    let records = read(&operation(&text)).unwrap().records;
    let lines = records.iter().filter(|record| matches!(record.op, Op::Line(_))).count();
    assert_eq!(lines, moves + 1);
}

#[test]
fn what_is_no_job_is_refused_with_its_place() {
    let read = |text: &str| Job::of("part.json", text.as_bytes()).unwrap_err();
    let found = read("{\n  \"toolpost\": 1 }");
    assert_eq!((found.rule.name(), found.line), ("freecad-job", 2), "{found}");
    assert!(read("{").line == 1 && read("").rule.name() == "freecad-job");
    let other = read(r#"{ "toolpost": "other", "version": 1, "operations": [] }"#);
    assert!(other.message.contains("`other`"), "{other}");
    let later = read(r#"{ "toolpost": "freecad-job", "version": 2, "operations": [] }"#);
    assert!(later.message.contains("version 2"), "{later}");
    // A chain of brackets without end.
    assert_eq!(read(&"[".repeat(100_000)).rule.name(), "freecad-job");
}

#[test]
fn what_is_no_dump_is_refused_with_its_line() {
    let wrong = |line: &str| {
        let text = format!("(Path: A)\nCommand M6 [ T:1 ]\n{line}\n");
        let found = Job::of("a.dump", text.as_bytes()).unwrap_err();
        assert_eq!(
            (found.rule.name(), found.line, found.file.as_str()),
            ("freecad-dump", 3, "a.dump")
        );
        found.message.clone()
    };
    assert!(wrong("...").contains("no line of a dump"));
    assert!(wrong("Command G1 [ X:nan ]").contains("X:nan"));
    assert!(wrong("Command G1 [ X=1 ]").contains("X=1"));
    assert!(wrong("Command G1 [ X:1").contains("no end"));
    assert!(wrong("Command G1 X:1 ]").contains("NAME"));
    let found = Job::of("a.dump", b"Command G0 [ X:1 ]\n").unwrap_err();
    assert_eq!(found.line, 1);
}

/// FreeCAD posts a job although an operation of it could not be recomputed: its path is empty, or an old one.
#[test]
fn an_operation_that_freecad_could_not_recompute_is_refused_with_its_name() {
    let with = |active: bool| {
        let commands = format!("{START}G1 F3.333333 Z-1.500000\n");
        job(json!([
            { "label": "Profile", "commands": commands },
            { "label": "Pocket003", "commands": "", "invalid": true, "active": active },
        ]))
    };
    let found = read(&with(true)).unwrap_err();
    assert_eq!(found.rule.name(), "freecad-invalid");
    assert!(found.message.contains("Pocket003"), "{found}");
    assert!(read(&with(false)).is_ok());
}

#[test]
fn two_tools_do_not_have_one_number() {
    let with = |shape: &str| {
        let mut job = operation(START);
        job["tools"] = json!([
            { "number": 1, "name": "Fast", "diameter": 5.0, "shape": "endmill" },
            { "number": 1, "name": "Slow", "diameter": 5.0, "shape": shape },
        ]);
        job
    };
    assert_eq!(read(&with("ballend")).unwrap_err().rule.name(), "two-tools");
    // Two controllers of one tool: another speed, another feed.
    assert!(read(&with("endmill")).is_ok());
}

/// Without a horizontal feed FreeCAD's cuts along X and Y have no F, and go at that of the plunge before them.
#[test]
fn a_tool_controller_without_a_horizontal_feed_is_refused_where_it_cuts_sideways() {
    let with = |feed: f64, commands: &str| {
        let commands = format!("{START}{commands}");
        let mut job = job(json!([{ "label": "Profile", "tool": 1, "commands": commands }]));
        job["tools"] = json!([{ "number": 1, "name": "Mill 5", "horizontal_feed": feed }]);
        job
    };
    let plunge = "G1 F3.333333 Z-1.500000\n";
    let sideways = format!("{plunge}G1 X9.000000\n");
    let found = read(&with(0.0, &sideways)).unwrap_err();
    assert!(found.message.contains("Profile") && found.message.contains("Mill 5"), "{found}");
    assert_eq!(found.rule.name(), "feed");
    for (feed, commands) in
        [(5.0, sideways.as_str()), (0.0, plunge), (0.0, "G1 F3.333333 X9.000000\n")]
    {
        assert!(read(&with(feed, commands)).is_ok(), "{feed} {commands}");
    }
}

/// What the builder of the machine has added reaches the program, from a Custom operation too.
#[test]
fn functions_of_the_builder_in_a_custom_operation_are_reported() {
    let text = "extends = \"generic-3axis-fanuc\"\nauxiliary = [10, 62]\n";
    let machine = machine::load_text("m.toml", text).unwrap();
    let commands = format!("{START}M10\nG1 F3.333333 Z-1.500000\nM62\n");
    let job = job(json!([{ "label": "Custom", "commands": commands }]));
    let job = Job::of("part.json", job.to_string().as_bytes()).unwrap();
    let program = freecad::read(&machine, "part.json", job, Purpose::Program).unwrap().program;
    let numbers: Vec<u32> = (program.records.iter())
        .filter_map(|record| match record.op {
            Op::Auxiliary(function) => Some(function.number),
            _ => None,
        })
        .collect();
    assert_eq!(numbers, [10, 62]);
}
