//! What production programs have: the number of the program, stops between tools, look-ahead, retracts by `G53`. Each by a
//! key of the machine file, written, proven, and looked at as an operator would.

use crate::files::root;
use geom::Vec3;
use machine::Machine;
use program::{Op, Program};

fn machine(text: &str) -> Machine {
    let machine = machine::load_text("own.toml", text).unwrap();
    post::check(&machine).unwrap();
    machine
}

fn sample(axes: &str) -> Program {
    let file = root().join("machines/samples").join(axes).with_extension("cls");
    let text = std::fs::read(&file).unwrap();
    source::apt::read(axes, &text, &Default::default()).unwrap().program
}

fn rules(source: &Program, machine: &Machine, text: &str) -> Vec<&'static str> {
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.iter().map(|found| found.rule.name()).collect()
}

/// The proven program, without the numbers of its blocks.
fn written(source: &Program, machine: &Machine) -> String {
    let text = String::from_utf8(post::write(source, machine).unwrap().text).unwrap();
    assert_eq!(rules(source, machine, &text), [""; 0], "{text}");
    let bare = |line: &str| match line.split_once(' ') {
        Some((number, rest)) if number.starts_with('N') => rest.to_owned(),
        _ => line.to_owned(),
    };
    text.lines().map(|line| bare(line) + "\n").collect()
}

#[test]
fn a_program_whose_name_is_a_number_has_that_number() {
    for (name, options, expected) in [
        ("O1234", "", "O1234 (O1234)"),
        ("o77", "", "O0077 (o77)"),
        ("42", "", "O0042 (42)"),
        // Of the builder's numbers, of none, and of too many digits it is none.
        ("O9001", "", "O0001 (O9001)"),
        ("O8000", "", "O0001 (O8000)"),
        ("O0", "", "O0001 (O0)"),
        ("12345", "", "O0001 (12345)"),
        ("BRACKET", "", "O0001 (BRACKET)"),
        ("O1234", "program_number = \"O0007\"", "O0007 (O1234)"),
        ("O1234", "program_number = 1235", "O1235 (O1234)"),
        ("O1234", "program_number = \"01236\"", "O1236 (O1234)"),
    ] {
        let machine =
            machine(&format!("extends = \"generic-3axis-fanuc\"\n[options]\n{options}\n"));
        let source = Program { name: name.into(), ..sample("three-axes") };
        let text = written(&source, &machine);
        assert_eq!(text.lines().nth(1), Some(expected));
    }
}

#[test]
fn a_stop_for_the_operator_stands_before_each_further_tool() {
    for (name, before, after) in [
        ("generic-3axis-fanuc", "M5", "(DRILL_3.3)"),
        ("generic-3axis-haas", "M5", "(DRILL_3.3)"),
        ("generic-3axis-mach3", "M5", "(DRILL_3.3)"),
        ("linuxcnc-mill", "M5", "(DRILL_3.3)"),
    ] {
        let machine =
            machine(&format!("extends = \"{name}\"\n[options]\nstop_between_tools = true\n"));
        let text = written(&sample("three-axes"), &machine);
        assert_eq!(text.matches("M1\n").count(), 1, "{name}");
        // The spindle stands, Z is home.
        assert!(text.contains(&format!("{before}\nM1\n{after}\n")), "{name}: {text}");
    }
}

#[test]
fn a_fanuc_cuts_contours_under_look_ahead_and_nothing_else() {
    let text = "extends = \"generic-3axis-fanuc\"\n[options]\nhigh_precision = true\n";
    let machine3 = machine(text);
    let source = sample("three-axes");
    let text = written(&source, &machine3);
    assert!(text.contains("Z2.\nG5.1 Q1\nG1 Z-2. F200.\n"), "{text}");
    // Off before the tool change, and not on again for holes.
    assert!(text.contains("G0 Z20.\n(HOLES)\nG5.1 Q0\nG91 G28 Z0\nG90\nG49\nM5\n"), "{text}");
    assert_eq!(text.matches("G5.1").count(), 2, "{text}");
    // Under the tool centre point it comes after G43.4 and goes before G49.
    let text = "extends = \"fanuc-table-bc\"\n[options]\nhigh_precision = true\n";
    let machine = machine(text);
    let source = sample("five-axes");
    let text = written(&source, &machine);
    let at = |what: &str| text.rfind(what).unwrap_or_else(|| panic!("{what}: {text}"));
    assert!(at("G43.4") < at("G5.1 Q1") && at("G5.1 Q1") < at("G5.1 Q0"));
    assert!(at("G5.1 Q0") < at("G91 G28 Z0"), "{text}");
    let wrong = text.replacen("G5.1 Q0\n", "", 1);
    assert_eq!(rules(&source, &machine, &wrong), ["look-ahead"], "{wrong}");
}

#[test]
fn a_fanuc_retracts_by_g53_where_its_file_says_so() {
    let machine3 = machine(
        "extends = \"generic-3axis-fanuc\"\nsafe_height = 0\n[options]\nretract_by_g53 = true\n",
    );
    let source = sample("three-axes");
    let text = written(&source, &machine3);
    assert!(!text.contains("G28"), "{text}");
    assert_eq!(text.matches("G53 G0 Z0.\n").count(), 3, "{text}");
    // Up and away before another work offset: the length is still in force at G53, and ends behind it.
    let at = |x: f64, z: f64| program::Pose::upright(Vec3::new(x, 0.0, z)).unwrap();
    let mut source = Program::new("offsets");
    let offset = |number| Op::WorkOffset(program::WorkOffset::numbered(number).unwrap());
    for (line, op) in (1..).zip([
        Op::Tool(Box::new(program::Tool { number: 1, ..Default::default() })),
        Op::Spindle(program::Spindle::Clockwise(500.0)),
        Op::Feed(program::Feed::PerMinute(100.0)),
        Op::Rapid(at(0.0, 20.0)),
        Op::Line(at(0.0, -1.0)),
        Op::Rapid(at(0.0, 20.0)),
        offset(55),
        Op::Rapid(at(5.0, 20.0)),
        Op::Line(at(5.0, -1.0)),
        Op::Rapid(at(5.0, 20.0)),
        Op::End,
    ]) {
        source.push(line, op);
    }
    let text = written(&source, &machine3);
    assert!(text.contains("G0 Z20.\nG53 G0 Z0.\nG49\nG55\n"), "{text}");
    // Where the top of Z is, nobody guesses.
    let unsaid = "extends = \"generic-3axis-fanuc\"\n[options]\nretract_by_g53 = true\n";
    let unsaid = machine::load_text("own.toml", unsaid).unwrap();
    assert_eq!(post::check(&unsaid).unwrap_err()[0].rule.name(), "safe-height");
}

#[test]
fn a_program_for_haas_says_how_smooth_it_goes_and_by_how_much_it_may_round_corners() {
    let source = sample("three-axes");
    for (options, block) in [
        ("smoothness = 3\npath_tolerance = 0.05", "G187 P3 E0.05\n"),
        ("smoothness = 1", "G187 P1 E0.01\n"),
        ("path_tolerance = 0", "G61\n"),
    ] {
        let machine = machine(&format!("extends = \"generic-3axis-haas\"\n[options]\n{options}\n"));
        let text = written(&source, &machine);
        assert!(text.contains(&format!("G94 G54\n{block}")), "{text}");
    }
    let machine = machine("extends = \"generic-3axis-haas\"\n");
    assert!(written(&source, &machine).contains("G94 G54\nG187 E0.01\n"));
}

/// M88 starts coolant through the spindle, M89 ends it; M9 does not.
#[test]
fn coolant_through_the_spindle_of_a_haas_ends_by_m89() {
    use program::Coolant;
    let at = |x: f64, z: f64| program::Pose::upright(Vec3::new(x, 0.0, z)).unwrap();
    let tool = |number| Op::Tool(Box::new(program::Tool { number, ..Default::default() }));
    let cut = |x| [Op::Rapid(at(x, 20.0)), Op::Line(at(x, -1.0)), Op::Rapid(at(x, 20.0))];
    let ops = [tool(1), Op::Spindle(program::Spindle::Clockwise(900.0))].into_iter();
    let ops = ops.chain([Op::Feed(program::Feed::PerMinute(100.0)), Op::Coolant(Coolant::Through)]);
    // Through, flood, through, off; the next tool; a stop, which ends both.
    let ops = ops.chain(cut(1.0)).chain([Op::Coolant(Coolant::Flood)]).chain(cut(2.0));
    let ops = ops.chain([Op::Coolant(Coolant::Through)]).chain(cut(3.0)).chain([tool(2)]);
    let ops = ops.chain(cut(4.0)).chain([Op::Stop]).chain(cut(5.0)).chain([Op::End]);
    let mut source = Program::new("through");
    for (line, op) in (1..).zip(ops) {
        source.push(line, op);
    }
    let machine = machine("extends = \"generic-3axis-haas\"\n");
    let text = written(&source, &machine);
    let coolant: Vec<&str> = text
        .lines()
        .filter(|block| ["M8", "M9", "M88", "M89", "M6", "M0"].iter().any(|m| block.ends_with(m)))
        .collect();
    let expected = [
        "M9", "T1 M6", "M88", "M89", "M8", "M9", "M88", "M89", "T2 M6", "M88", "M89", "M0", "M88",
        "M89",
    ];
    assert_eq!(coolant, expected, "{text}");
    // What M9 would leave on is refused.
    let wrong = text.replacen("M89", "M9", 1);
    assert_eq!(rules(&source, &machine, &wrong).len(), 1, "{wrong}");
}

/// Coolant through the tool has no number of its own on a FANUC: the builder's, which the machine file states. Flood may be another
/// than M8, too.
#[test]
fn a_fanuc_has_coolant_through_the_tool_where_its_file_states_it() {
    let source = |coolant: &str| {
        let text = format!(
            "UNITS/MM\nLOADTL/1\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nCOOLNT/{coolant}\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-1\nRAPID\n\
             GOTO/0,0,20\nFINI\n"
        );
        source::apt::read("c.cls", text.as_bytes(), &Default::default()).unwrap().program
    };
    let own = machine(
        "extends = \"generic-3axis-fanuc\"\n[coolant]\nflood = 28\nthrough = 26\n[blocks]\ncoolant_flood = \"{{N}} M28\"\n\
         coolant_through = \"{{N}} M26\"\n",
    );
    for (coolant, function, other) in [("THRU", "M26", "M28"), ("FLOOD", "M28", "M26")] {
        let source = source(coolant);
        let text = written(&source, &own);
        assert!(text.lines().any(|line| line.ends_with(function)), "{text}");
        for wrong in [other, "M8", "M7"] {
            let damaged = text.replacen(function, wrong, 1);
            assert!(!rules(&source, &own, &damaged).is_empty(), "{damaged}");
        }
        // Both, of which the second may end the first.
        let both = text.replacen(function, &format!("{function}\nN1 {other}"), 1);
        assert_eq!(rules(&source, &own, &both), ["coolant"], "{both}");
    }
    let plain = machine("extends = \"generic-3axis-fanuc\"\n");
    let refused = post::write(&source("THRU"), &plain).unwrap_err();
    assert_eq!(refused[0].rule.name(), "missing-block", "{refused:?}");
    let twice = machine::load_text(
        "two.toml",
        "extends = \"fanuc-31i\"\n[coolant]\nflood = 26\nthrough = 26\n",
    );
    assert!(twice.unwrap_err().message.contains("two things"));
}

/// The table and the block that switches it on are all that a machine file needs: what ends a coolant is taken from the table at
/// tool changes, stops and the end. There M9 would leave on what has a function of its own to end it.
#[test]
fn coolant_through_the_tool_is_ended_by_its_own_function_on_every_mill() {
    let text = "UNITS/MM\nLOADTL/1\nCUTTER/10,0\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nCOOLNT/THRU\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-1\n\
                COOLNT/OFF\nGOTO/5,0,-1\nCOOLNT/THRU\nGOTO/9,0,-1\nRAPID\nGOTO/0,0,20\nSTOP\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-2\nRAPID\nGOTO/0,0,20\n\
                LOADTL/2\nCUTTER/8,0\nSPINDL/800,RPM,CLW\nCOOLNT/THRU\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,20\nFINI\n";
    let source = source::apt::read("c.cls", text.as_bytes(), &Default::default()).unwrap().program;
    for mill in [
        "generic-3axis-sinumerik",
        "generic-3axis-fanuc",
        "generic-3axis-haas",
        "generic-3axis-heidenhain",
        "generic-3axis-linuxcnc",
        "fanuc-table-bc",
        "haas-umc-750",
        "dmu50-heidenhain",
        "sinumerik-840d-traori",
    ] {
        let own = machine(&format!(
            "extends = \"{mill}\"\n[coolant]\nthrough = 26\nthrough_off = 27\n[blocks]\ncoolant_through = \"{{{{N}}}} M26\"\n"
        ));
        let text = written(&source, &own);
        let ends: Vec<usize> = text.match_indices("M27").map(|(at, _)| at).collect();
        // In the cut, before the stop, before the tool change, before the end.
        assert_eq!(ends.len(), 4, "{mill}: {text}");
        for at in ends {
            let mut damaged = text.clone();
            damaged.replace_range(at..at + 3, "M9");
            assert_eq!(rules(&source, &own, &damaged), ["coolant"], "{mill} {at}: {damaged}");
        }
    }
}

/// Under G254 a program does not depend on where the part is clamped: the table turns about another place of it, and no block
/// changes. Without G254 the same blocks lead elsewhere, and behind it the table may not turn.
#[test]
fn a_haas_carries_the_work_zero_with_its_table() {
    let source = sample("five-axes");
    let haas = |height: f64| {
        machine(&format!(
            "extends = \"haas-umc-750\"\nwork_zero = [-381, -254, {height}]\n[orientation]\npositioned = \"dynamic-offset\"\n"
        ))
    };
    let (high, low) = (haas(-300.0), haas(-350.0));
    let text = written(&source, &high);
    assert_eq!(text, written(&source, &low));
    assert!(text.contains("B45. C45.\nG254\n"), "{text}");
    assert!(text.contains("G53 G0 Z0.\nG255\n"), "{text}");
    let damaged = |from: &str, to: &str| rules(&source, &high, &text.replacen(from, to, 1));
    assert_ne!(damaged("G254\n", ""), [""; 0]);
    assert_eq!(damaged("G255\n", ""), ["dynamic-offset"]);
    assert_eq!(damaged("G254\n", "G55\nG254\n"), ["dynamic-offset"]);
    assert_eq!(damaged("G0 B45. C45.\nG254\n", "G254\nG0 B45. C45.\n"), ["dynamic-offset"]);
    let umc = std::fs::read_to_string(root().join("machines/haas-umc-750.toml")).unwrap();
    let nowhere = machine(
        &umc.replace("point = [-381, -254, -400]", "").replace("machine-angles", "dynamic-offset"),
    );
    let refused = post::write(&source, &nowhere).unwrap_err();
    assert_eq!(refused[0].rule.name(), "kinematics", "{refused:?}");
}

/// Setting 52 ("G83 Retract Above R"): chips are cleared above R, where Z has to have room for it.
#[test]
fn a_haas_clears_chips_above_r_as_far_as_setting_52_says() {
    let source = sample("three-axes");
    let haas = |above: f64| {
        format!(
            "extends = \"haas\"\nwork_zero = [0, 0, -30]\n[settings]\nretract_above_r = {above}\n[axes]\n\
             X = {{ min = -500, max = 500 }}\nY = {{ min = -500, max = 500 }}\nZ = {{ min = -300, max = 0 }}\n"
        )
    };
    // R is at 2 mm, the work zero 30 mm below the end of Z.
    let near = machine(&haas(25.0));
    let text = written(&source, &near);
    let far = machine(&haas(35.0));
    assert_eq!(
        rules(&source, &far, &{
            String::from_utf8(post::write(&source, &near).unwrap().text).unwrap()
        }),
        ["axis-limit"],
        "{text}"
    );
    assert_eq!(post::write(&source, &far).unwrap_err()[0].rule.name(), "axis-limit");
    // A file that does not say it is reported.
    let unsaid = machine("extends = \"haas\"\n");
    let text = post::write(&source, &unsaid).unwrap().text;
    let report = proof::prove(&source, &unsaid, "p", &text, &Default::default());
    assert!(
        report.proven && report.warnings.iter().any(|found| found.rule.name() == "peck-retract")
    );
}

#[test]
fn a_haas_pads_the_number_of_a_program_to_five_digits() {
    for (options, expected) in [("", "O00042 (42)"), ("program_number = 1234", "O01234 (42)")] {
        let machine = machine(&format!("extends = \"generic-3axis-haas\"\n[options]\n{options}\n"));
        let source = Program { name: "42".into(), ..sample("three-axes") };
        assert_eq!(written(&source, &machine).lines().nth(1), Some(expected));
    }
}

/// FANUC 3202#0 keeps 8000 to 8999 from being edited, and 9000 and above are the builder's.
#[test]
fn a_number_of_a_program_that_not_everybody_may_use_is_refused_before_writing() {
    for number in ["\"O9012\"", "8000", "0", "12.5", "-3", "\"PART\"", "\"123456789\""] {
        for name in ["generic-3axis-fanuc", "generic-3axis-haas"] {
            let text = format!("extends = \"{name}\"\n[options]\nprogram_number = {number}\n");
            let own = machine::load_text("own.toml", &text).unwrap();
            let refused = post::check(&own).unwrap_err();
            let rules: Vec<&str> = refused.iter().map(|found| found.rule.name()).collect();
            assert_eq!(rules, ["program-number"], "{number} on {name}");
        }
    }
}

#[test]
fn the_tools_of_a_program_stand_at_its_head() {
    for (name, first) in [
        ("generic-3axis-fanuc", "(T1 MILL_6 D6)"),
        ("generic-3axis-haas", "(T1 MILL_6 D6)"),
        ("generic-3axis-linuxcnc", "(T1 MILL_6 D6)"),
    ] {
        let text = written(&sample("three-axes"), &machine(&format!("extends = \"{name}\"\n")));
        let head = text.find("G21").unwrap();
        let list = text.find(&format!("{first}\n(T2 DRILL_3.3 D3.3)\n"));
        assert!(list.is_some_and(|at| at < head || name.contains("haas")), "{name}: {text}");
    }
}

/// Behind the last tool the first is made ready, for the next part.
#[test]
fn a_machine_may_make_the_next_tool_ready_behind_each_change() {
    for (name, one, two, block) in [
        ("generic-3axis-fanuc", "T1 M6\nT2\n", "T2 M6\nT1\n", "T2"),
        ("generic-3axis-haas", "T1 M6\nT2\n", "T2 M6\nT1\n", "T2"),
        ("haas-umc-750", "T1 M6\nT2\n", "T2 M6\nT1\n", "T2"),
        ("generic-3axis-linuxcnc", "T1 M6\nT2\n", "T2 M6\nT1\n", "T2"),
        ("generic-3axis-heidenhain", "TOOL DEF 2\n", "TOOL DEF 1\n", "TOOL DEF 2"),
        ("generic-3axis-sinumerik", "M6\nD1\nT2\n", "M6\nD1\nT1\n", "T2"),
    ] {
        let ready = format!("extends = \"{name}\"\n[options]\npreselect_tools = true\n");
        let text = written(&sample("three-axes"), &machine(&ready));
        assert!(text.contains(one) && text.contains(two), "{name}: {text}");
        let plain = written(&sample("three-axes"), &machine(&format!("extends = \"{name}\"\n")));
        let count = |text: &str| {
            text.lines().filter(|line| line.ends_with(block) && line.len() < 16).count()
        };
        assert_eq!(count(&text), count(&plain) + 1, "{name}: {plain}");
    }
}

/// On a SINUMERIK a `T` alone moves nothing and takes no length, whichever tool it names; `M6` takes the tool of the last `T`.
#[test]
fn another_tool_made_ready_is_in_vain_and_a_change_that_takes_it_is_refused() {
    let machine =
        machine("extends = \"generic-3axis-sinumerik\"\n[options]\npreselect_tools = true\n");
    let source = sample("three-axes");
    let text = String::from_utf8(post::write(&source, &machine).unwrap().text).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let calls = |tool: &str| {
        let named = lines.iter().enumerate().filter(|(_, line)| line.ends_with(tool));
        named.map(|(at, _)| at).collect::<Vec<_>>()
    };
    let [ready, called] = calls(" T2")[..] else { panic!("{text}") };
    let mut changed = lines.clone();
    changed[ready] = "N1 T7";
    assert_eq!(rules(&source, &machine, &(changed.join("\n") + "\n")), [""; 0]);
    // Nothing names the tool of the change any more but the T that made one ready.
    changed.remove(called);
    assert_eq!(rules(&source, &machine, &(changed.join("\n") + "\n"))[0], "tool");
    changed[ready] = lines[ready];
    assert_eq!(rules(&source, &machine, &(changed.join("\n") + "\n")), [""; 0]);
}

/// The portal mill calls tools by name where the source names them so; it makes them ready in the same way.
#[test]
fn a_tool_that_is_called_by_name_is_made_ready_by_name() {
    let machine =
        machine("extends = \"sinumerik-840d-traori\"\n[options]\npreselect_tools = true\n");
    let mut source = sample("three-axes");
    for record in &mut source.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.name = if tool.number == 1 { "MILL_10".into() } else { "two words".into() };
        }
    }
    let text = written(&source, &machine);
    assert!(text.contains("T=\"MILL_10\"\nM6\nD1\nT2\n"), "{text}");
    assert!(text.contains("T2\nM6\nD1\nT=\"MILL_10\"\n"), "{text}");
}

#[test]
fn a_tool_that_the_source_makes_ready_and_calls_at_once_is_not_made_ready() {
    let with = |op: Op| {
        let mut source = sample("three-axes");
        let at = source.records.iter().position(|record| matches!(record.op, Op::Tool(_))).unwrap();
        let line = source.records[at].line;
        source.records.insert(at, program::Record { line, op });
        written(&source, &machine("extends = \"generic-3axis-fanuc\"\n"))
    };
    assert!(!with(Op::Preselect(1)).contains("\nT1\n"));
    assert!(with(Op::Preselect(2)).contains("\nT2\n"));
}

/// `G53` is an alarm in a tilted plane: there Z goes home by `G28`, everywhere else by `G53`.
#[test]
fn z_goes_home_by_g53_wherever_no_plane_is_tilted() {
    let by_g53 =
        "extends = \"fanuc-table-bc\"\nsafe_height = 0\n[options]\nretract_by_g53 = true\n";
    let text = written(&sample("five-axes"), &machine(by_g53));
    assert!(text.contains("G53 G0 Z0.\nM5\n"), "{text}");
    assert!(text.contains("G91 G28 Z0\nG90\nG49\nG69\n"), "{text}");
    // Without a height to go to it is refused.
    let nowhere = "extends = \"fanuc-table-bc\"\n[options]\nretract_by_g53 = true\n";
    let nowhere = machine::load_text("own.toml", nowhere).unwrap();
    assert_eq!(post::check(&nowhere).unwrap_err()[0].rule.name(), "safe-height");
}

/// LinuxCNC "G43", B-64484EN-2 "Tool length offset": a change of the tool takes no length. A machine file that says that it does
/// would let the second tool go down by the difference of the lengths; a single tool may have been touched off.
#[test]
fn a_control_that_takes_lengths_by_a_word_gets_no_second_tool_without_it() {
    let text = |second: &str| {
        format!(
            "UNITS/MM\nLOADTL/1\nCUTTER/10,0\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,20\n\
             {second}FINI\n"
        )
    };
    let second = "LOADTL/2\nCUTTER/8,0\nSPINDL/800,RPM,CLW\nRAPID\nGOTO/0,0,20\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,20\n";
    let read = |text: String| {
        source::apt::read("c.cls", text.as_bytes(), &Default::default()).unwrap().program
    };
    let (one, two) = (read(text("")), read(text(second)));
    for name in ["fanuc", "haas", "iso", "linuxcnc", "mach3"] {
        let own = machine(&format!(
            "extends = \"generic-3axis-{name}\"\n[capabilities]\nlength_offset = \"implicit\"\n"
        ));
        assert!(!written(&one, &own).contains("G43"), "{name}");
        let text = post::write(&two, &own).unwrap().text;
        let found = rules(&two, &own, &String::from_utf8(text).unwrap());
        assert_eq!(found[0], "length-offset", "{name}: {found:?}");
    }
}
