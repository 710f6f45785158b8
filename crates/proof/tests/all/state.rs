//! What holds in the cut, events, tool changes, home positions, the end.

use crate::common::*;
use control::Action;
use machine::{LengthOffset, Machine};
use program::*;

const MILL_OF_HEADS: &str = r#"
reader = "fanuc"
[settings]
rapid_path = "linear"
[words]
X = { decimals = 3 }
A = { decimals = 3 }
C = { decimals = 3 }
[orientation]
simultaneous = "tool-center-angles"
"#;

const MILL_AT_CORNERS: &str = r#"
reader = "linuxcnc"
[capabilities]
length_offset = "tool-number"
[settings]
rapid_path = "linear"
[words]
X = { decimals = 3 }
Y = { decimals = 3 }
Z = { decimals = 3 }
F = { decimals = 0 }
[options]
"#;

fn cut() -> Vec<Op> {
    vec![
        Op::Rapid(at(0.0, 0.0, 5.0)),
        Op::Line(at(0.0, 0.0, -1.0)),
        Op::Line(at(30.0, 0.0, -1.0)),
        Op::Rapid(at(30.0, 0.0, 5.0)),
    ]
}

fn cut_nc() -> Vec<Action> {
    vec![
        Action::Rapid(block(0.0, 0.0, 5.0)),
        Action::Line(block(0.0, 0.0, -1.0)),
        Action::Line(block(30.0, 0.0, -1.0)),
        Action::Rapid(block(30.0, 0.0, 5.0)),
    ]
}

/// The work offset of that number.
fn offset(number: u32) -> WorkOffset {
    WorkOffset::numbered(number).unwrap()
}

/// The magazine of a portal mill takes the tool with the head upright. `unknown` is before the first block has turned it.
#[test]
fn a_tool_is_changed_with_the_head_upright() {
    const FORK: &str = r#"
[[rotary]]
letter = "C"
on = "head"
axis = [0, 0, 1]
rapid = 1e4
acceleration = 100
[[rotary]]
letter = "A"
on = "head"
axis = [1, 0, 0]
point = [0, 0, 200]
rapid = 1e4
acceleration = 100
"#;
    let turned = |a: f64, c: f64| {
        Action::Rapid(control::Position {
            point: geom::Vec3::NAN,
            orientation: control::Orientation::Rotary { degrees: [a, 0.0, c], tool_center: false },
        })
    };
    let judged = |more: &str, turn: Option<Action>| {
        let machine = machine::load_text("fork.toml", &format!("{MILL_OF_HEADS}{more}{FORK}"));
        let start = [Action::Home(Axes::Z)].into_iter().chain(turn);
        let report = run(&machine.unwrap(), &source(cut()), start.chain(nc_start()).collect());
        rules(&report).contains(&"tool-change-tilt")
    };
    assert!(judged("", None));
    assert!(judged("", Some(turned(-45.0, 0.0))));
    assert!(judged("", Some(turned(0.0, 30.0))));
    assert!(!judged("", Some(turned(0.0, 0.0))));
    assert!(!judged("", Some(turned(0.0, 720.0))));
    assert!(!judged("[tools]\nturns_upright = true\n", None));
}

/// Spindle and coolant off.
fn off() -> Vec<Action> {
    vec![Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off)]
}

/// Judges the cut with this before its first event.
fn after_start(words: Vec<Action>) -> Vec<&'static str> {
    rules(&judge(&mill(), &source(cut()), [words, cut_nc()].concat()))
}

/// Judges the cut with these before record `index` of the source and event `index` of the program.
fn at_record(index: usize, ops: Vec<Op>, actions: Vec<Action>) -> Vec<&'static str> {
    let (mut own, mut nc) = (cut(), cut_nc());
    own.splice(index..index, ops);
    nc.splice(index..index, actions);
    rules(&judge(&mill(), &source(own), nc))
}

/// Judges the cut of a program that lacks an event of its start.
fn without(missing: impl Fn(&Action) -> bool) -> Vec<&'static str> {
    let start = nc_start().into_iter().filter(|action| !missing(action));
    let nc = start.chain(cut_nc()).chain([Action::Home(Axes::Z)]).chain(end()).collect();
    rules(&run(&mill(), &source(cut()), nc))
}

#[test]
fn each_word_of_the_start_is_needed() {
    assert_eq!(without(|action| matches!(action, Action::Feed(_))), ["feed"]);
    assert_eq!(without(|action| matches!(action, Action::Spindle(_))), ["spindle"]);
    assert_eq!(without(|action| matches!(action, Action::Coolant(_))), ["coolant"]);
    assert_eq!(without(|action| matches!(action, Action::LengthOffset(_))), ["length-offset"]);
    assert_eq!(without(|action| matches!(action, Action::Tool(_)))[0], "tool");
}

#[test]
fn another_feed_is_refused_and_half_a_step_is_rounding() {
    let feed = |f| after_start(vec![Action::Feed(Feed::PerMinute(f))]);
    assert!(feed(300.5).is_empty());
    assert_eq!(feed(301.0), ["feed"]);
    assert_eq!(feed(f64::NAN), ["feed"]);
}

#[test]
fn feed_per_turn_counts_with_the_speed() {
    let per_turn = |f| after_start(vec![Action::Feed(Feed::PerTurn(f))]);
    assert!(per_turn(0.3).is_empty());
    assert_eq!(per_turn(300.0), ["feed"]);
}

#[test]
fn inverse_time_counts_with_the_length_of_each_block() {
    // 300 mm/min: 6 mm take 1/50 min, 30 mm take 1/10 min.
    let timed = |plunge, along| {
        let (mut nc, rate) = (cut_nc(), |r| Action::Feed(Feed::InverseTime(r)));
        nc.splice(1..3, [rate(plunge), nc[1].clone(), rate(along), nc[2].clone()]);
        rules(&judge(&mill(), &source(cut()), nc))
    };
    assert!(timed(50.0, 10.0).is_empty());
    assert_eq!(timed(50.0, 50.0), ["feed"]);
    let own = at_record(
        2,
        vec![Op::Feed(Feed::InverseTime(20.0))],
        vec![Action::Feed(Feed::PerMinute(600.0))],
    );
    assert!(own.is_empty());
}

#[test]
fn the_spindle_turns_as_fast_and_the_way_the_source_says() {
    assert_eq!(after_start(vec![Action::Spindle(Spindle::CounterClockwise(1000.0))]), ["spindle"]);
    assert_eq!(after_start(vec![Action::Spindle(Spindle::Clockwise(100.0))]), ["spindle"]);
    assert_eq!(after_start(vec![Action::Spindle(Spindle::Off)]), ["spindle"]);
    assert_eq!(after_start(vec![Action::Coolant(Coolant::Mist)]), ["coolant"]);
}

#[test]
fn spindle_and_coolant_count_in_the_cut_not_where_their_word_stands() {
    let (mut own, mut nc) = (cut(), cut_nc());
    own.push(Op::Spindle(Spindle::Off));
    nc.insert(3, Action::Coolant(Coolant::Off));
    proven(&judge(&mill(), &source(own), nc));
}

#[test]
fn a_wrong_offset_or_tool_is_refused() {
    assert_eq!(after_start(vec![Action::LengthOffset(Some(2))]), ["length-offset"]);
    assert_eq!(after_start(vec![Action::LengthOffset(None)]), ["length-offset"]);
    assert_eq!(after_start(vec![Action::WorkOffset(offset(55))]), ["work-offset"]);
    // Without a word a SINUMERIK has none (G500). On the others the virtual control reports that nobody knows which is active
    // (`Risk::START_OFFSET`; end to end in `unsaid.rs` of the command).
    // `G61`, without which setting 85 of a Haas rounds the corners.
    let exact = vec![Action::PathMode(PathMode::ExactPath)];
    let nc = [nc_start(), exact, cut_nc(), end()].concat();
    for (reader, wrong) in [("sinumerik", true), ("grbl", false)] {
        let machine = Machine { reader: reader.into(), ..mill() };
        proven(&run(&machine, &source(cut()), nc.clone()));
        let unsaid = run(&machine, &source(cut()), nc[1..].to_vec());
        assert_eq!(unsaid.proven, !wrong, "{reader}");
        assert_eq!(rules(&unsaid).contains(&"work-offset"), wrong, "{reader}");
    }
    let mut start = nc_start();
    start[1] = Action::Tool(tool(2));
    let nc = [start, cut_nc(), end()].concat();
    // The length of T1 with T2 in the spindle is a difference of its own.
    assert_eq!(rules(&run(&mill(), &source(cut()), nc)), ["length-offset", "tool"]);
}

/// The source says by how much the path of its cuts may be left, by operation; 0.02 mm are the most that this machine lets a control.
#[test]
fn corners_are_cut_no_further_than_the_source_says_for_the_operation() {
    let machine = |options: &str| {
        let text = format!("{MILL_AT_CORNERS}{options}");
        machine::load_text("corners.toml", &text).unwrap()
    };
    let judged = |machine: &Machine, own: [PathMode; 2], nc: [PathMode; 2]| {
        let operation = |x: f64| {
            [Op::Rapid(at(x, 0.0, 5.0)), Op::Line(at(x, 0.0, -1.0)), Op::Rapid(at(x, 0.0, 5.0))]
        };
        let block_of = |x: f64| {
            [
                Action::Rapid(block(x, 0.0, 5.0)),
                Action::Line(block(x, 0.0, -1.0)),
                Action::Rapid(block(x, 0.0, 5.0)),
            ]
        };
        let (mut ops, mut actions) = (Vec::new(), Vec::new());
        for (i, x) in [0.0, 20.0].into_iter().enumerate() {
            ops.push(Op::PathMode(own[i]));
            ops.extend(operation(x));
            actions.push(Action::PathMode(nc[i]));
            actions.extend(block_of(x));
        }
        rules(&judge(machine, &source(ops), actions))
    };
    use PathMode::{AsSetUp, Blend, ExactPath, ExactStop};
    let mill = machine("path_tolerance = 0.02\n");
    let same = |mode| [mode; 2];
    let refused = ["path-tolerance"];
    // Finishing follows the path more closely, in the operation that asks for it alone.
    let own = [Blend(0.02), Blend(0.005)];
    assert!(judged(&mill, own, own).is_empty());
    assert!(judged(&mill, own, same(Blend(0.005))).is_empty());
    assert_eq!(judged(&mill, own, same(Blend(0.02))), refused);
    assert_eq!(judged(&mill, own, [Blend(0.005), Blend(0.02)]), refused);
    assert_eq!(judged(&mill, own, [Blend(0.02), Blend(0.0051)]), refused);
    assert_eq!(judged(&mill, own, [Blend(0.02), AsSetUp]), refused);
    assert!(judged(&mill, own, [Blend(0.02), ExactPath]).is_empty());
    // Closer than it asks for is slower.
    let closer = |nc: [PathMode; 2]| {
        let ops = vec![
            Op::PathMode(Blend(0.015)),
            Op::Rapid(at(0.0, 0.0, 5.0)),
            Op::Line(at(0.0, 0.0, -1.0)),
            Op::PathMode(Blend(0.05)),
            Op::Line(at(9.0, 0.0, -1.0)),
            Op::Rapid(at(9.0, 0.0, 5.0)),
        ];
        let [first, second] = nc.map(Action::PathMode);
        let actions = vec![
            Action::Rapid(block(0.0, 0.0, 5.0)),
            first,
            Action::Line(block(0.0, 0.0, -1.0)),
            second,
            Action::Line(block(9.0, 0.0, -1.0)),
            Action::Rapid(block(9.0, 0.0, 5.0)),
        ];
        let report = judge(&mill, &source(ops), actions);
        proven(&report);
        let slow = report.warnings.iter().filter(|found| found.rule == Rule::PathMode);
        slow.map(|found| found.count).collect::<Vec<_>>()
    };
    assert_eq!(closer([Blend(0.015), Blend(0.02)]), [0; 0]);
    assert_eq!(closer([Blend(0.014), Blend(0.02)]), [1]);
    assert_eq!(closer([Blend(0.005), Blend(0.005)]), [2]);
    assert_eq!(closer([ExactPath, ExactPath]), [0; 0]);
    // What the source does not say, and what it says beyond the machine's figure, is the machine's.
    assert!(judged(&mill, [Blend(0.005), AsSetUp], [Blend(0.005), Blend(0.02)]).is_empty());
    assert!(judged(&mill, same(Blend(0.1)), same(Blend(0.02))).is_empty());
    assert_eq!(judged(&mill, same(Blend(0.1)), same(Blend(0.03))), refused);
    for exact in [ExactPath, ExactStop] {
        assert!(judged(&mill, same(exact), same(Blend(0.001))).is_empty());
        assert_eq!(judged(&mill, same(exact), same(Blend(0.002))), refused);
    }
    // Roughing may be further from the path, where the source says that it may.
    let rough = machine("path_tolerance = 0.02\nroughing_tolerance = 0.05\n");
    assert!(judged(&rough, [Blend(0.1), AsSetUp], [Blend(0.05), Blend(0.02)]).is_empty());
    assert_eq!(judged(&rough, [Blend(0.1), AsSetUp], same(Blend(0.05))), refused);
    assert_eq!(judged(&rough, [Blend(0.04), AsSetUp], [Blend(0.05), Blend(0.02)]), refused);
    assert_eq!(judged(&rough, same(Blend(0.1)), same(Blend(0.06))), refused);
}

#[test]
fn compensation_switches_with_the_first_straight_cut_in_the_plane() {
    use Compensation::*;
    let own_on = |side| vec![Op::Compensation(side)];
    let on = |side| vec![Action::Compensation(side)];
    // Before the plunge the source asks for it; the program may wait for the move in X.
    assert!(at_record(1, own_on(Left(None)), on(Left(Some(1)))).is_empty());
    let late = |word: Vec<Action>| {
        let (mut own, mut nc) = (cut(), cut_nc());
        own.splice(1..1, own_on(Left(None)));
        nc.splice(2..2, word);
        rules(&judge(&mill(), &source(own), nc))
    };
    assert!(late(on(Left(None))).is_empty());
    assert_eq!(late(on(Right(None))), ["compensation"]);
    assert_eq!(late(on(Left(Some(7)))), ["compensation"]);
    assert_eq!(late(vec![]), ["compensation"]);
    assert_eq!(at_record(2, vec![], on(Left(None))), ["compensation"]);
}

#[test]
fn compensation_does_not_switch_on_an_arc() {
    let mut own = vec![
        Op::Rapid(at(10.0, 0.0, 0.0)),
        Op::Line(at(11.0, 0.0, 0.0)),
        Op::Line(at(10.0, 0.0, 0.0)),
        Op::Arc(arc(at(0.0, 10.0, 0.0), (0.0, 0.0, 0.0), geom::Vec3::Z)),
        Op::Line(at(0.0, 20.0, 0.0)),
    ];
    let (mut early, mut late) = (actions(&own), actions(&own));
    let on = Op::Compensation(Compensation::Left(None));
    early.insert(3, action(&on));
    late.insert(4, action(&on));
    own.insert(3, on);
    assert_eq!(rules(&judge(&mill(), &source(own.clone()), early)), ["compensation"]);
    // Nor may the arc be cut without it.
    assert_eq!(rules(&judge(&mill(), &source(own), late)), ["compensation"]);
}

#[test]
fn compensation_goes_off_with_a_rapid_before_the_tool_comes_down_elsewhere() {
    let own = vec![
        Op::Rapid(at(0.0, 0.0, 5.0)),
        Op::Line(at(0.0, 0.0, -1.0)),
        Op::Compensation(Compensation::Left(None)),
        Op::Line(at(10.0, 0.0, -1.0)),
        Op::Compensation(Compensation::Off),
        Op::Line(at(10.0, 0.0, 5.0)),
        Op::Rapid(at(50.0, 0.0, 5.0)),
        Op::Line(at(50.0, 0.0, -1.0)),
        Op::Line(at(60.0, 0.0, -1.0)),
    ];
    let nc = actions(&own);
    let mut late = nc.clone();
    let off = late.remove(4);
    late.insert(7, off);
    proven(&judge(&mill(), &source(own.clone()), nc));
    assert_eq!(rules(&judge(&mill(), &source(own), late)), ["compensation"]);
}

#[test]
fn dwells_and_stops_come_in_their_place() {
    let own_dwell = |s| vec![Op::Dwell(s)];
    let dwell = |s| vec![Action::Dwell(s)];
    assert!(at_record(2, own_dwell(1.5), dwell(1.5)).is_empty());
    assert_eq!(at_record(2, own_dwell(1.5), dwell(15.0)), ["dwell"]);
    assert_eq!(at_record(2, own_dwell(1.5), vec![]), ["dwell"]);
    assert_eq!(at_record(2, vec![], dwell(1.5)), ["dwell"]);
    let reported = vec![Action::Stop, Action::Comment("x".into())];
    assert!(at_record(2, vec![Op::Stop], reported).is_empty());
    assert_eq!(at_record(2, vec![Op::Stop], vec![Action::OptionalStop]), ["stop"]);
    assert_eq!(at_record(3, vec![], vec![Action::Stop]), ["stop"]);
    let mut moved = cut_nc();
    moved.insert(3, Action::Dwell(1.5));
    let mut own = cut();
    own.insert(2, Op::Dwell(1.5));
    assert_eq!(rules(&judge(&mill(), &source(own), moved)), ["dwell"]);
}

#[test]
fn the_spindle_stands_where_the_source_stops_it_for_the_operator() {
    let stop = vec![Op::Spindle(Spindle::Off), Op::Stop, Op::Spindle(Spindle::Clockwise(1000.0))];
    assert!(at_record(1, stop.clone(), actions(&stop)).is_empty());
    assert_eq!(at_record(1, stop, vec![Action::Stop]), ["spindle"]);
}

fn two_tools() -> Vec<Op> {
    let mut ops = cut();
    ops.extend([Op::Tool(tool(2)), Op::Spindle(Spindle::Clockwise(500.0))]);
    ops.extend(cut());
    ops
}

fn change() -> Vec<Action> {
    vec![
        Action::Home(Axes::Z),
        Action::Spindle(Spindle::Off),
        Action::Tool(tool(2)),
        Action::Spindle(Spindle::Clockwise(500.0)),
        Action::Coolant(Coolant::Flood),
        Action::LengthOffset(Some(2)),
        Action::Rapid(block(0.0, 0.0, f64::NAN)),
    ]
}

fn changed(change: Vec<Action>) -> Vec<&'static str> {
    rules(&judge(&mill(), &source(two_tools()), [cut_nc(), change, cut_nc()].concat()))
}

#[test]
fn a_tool_change_establishes_everything_again() {
    assert!(changed(change()).is_empty());
    let without = |index: usize| {
        let mut others = change();
        others.remove(index);
        changed(others)
    };
    // The way home: on a machine whose tool change goes up by itself it may be missing.
    assert_eq!(without(0), ["tool-change-height"]);
    let mut lifts = mill();
    lifts.tools.retracts = true;
    let own = [cut_nc(), change()[1..].to_vec(), cut_nc()].concat();
    assert!(rules(&judge(&lifts, &source(two_tools()), own)).is_empty());
    assert_eq!(without(2), ["length-offset", "tool"]);
    assert_eq!(without(3), ["spindle"]);
    assert_eq!(without(4), ["coolant"]);
    assert_eq!(without(5), ["length-offset"]);
}

#[test]
fn a_tool_change_that_the_source_does_not_have_is_refused() {
    assert_eq!(at_record(2, vec![], vec![Action::Tool(tool(1))]), ["extra-tool-change"]);
    assert_eq!(at_record(4, vec![], vec![Action::Tool(tool(1))]), ["extra-tool-change"]);
}

#[test]
fn a_part_without_tool_calls_takes_any_one_tool() {
    let own = program([start()[1..].to_vec(), cut()].concat());
    proven(&judge(&mill(), &own, cut_nc()));
    let nc = [cut_nc(), vec![Action::Home(Axes::Z), Action::Tool(tool(2))]].concat();
    assert_eq!(rules(&judge(&mill(), &own, nc)), ["extra-tool-change"]);
}

#[test]
fn home_in_the_middle_of_the_work_is_refused() {
    // Only Z, and only when the tool comes back down to where it left, is an excursion.
    let down = Action::Rapid(block(0.0, 0.0, -1.0));
    let back = vec![Action::Home(Axes::Z), down.clone()];
    let report = |between: Vec<Action>| {
        let mut nc = cut_nc();
        nc.splice(2..2, between);
        judge(&mill(), &source(cut()), nc)
    };
    let there_and_back = report(back);
    proven(&there_and_back);
    assert_eq!(there_and_back.compared.excursions, 1);
    assert_eq!(there_and_back.excursions[0].source_line, 7);
    assert_eq!(rules(&report(vec![Action::Home(Axes::LINEAR), down])), ["home"]);
    assert_eq!(rules(&report(vec![Action::Home(Axes::X)])), ["home"]);
    assert_eq!(rules(&report(vec![Action::Home(Axes::Z)])), ["rapid-feed"]);
}

#[test]
fn a_tool_is_called_by_its_number_or_by_its_own_name() {
    let mut implicit = mill();
    implicit.capabilities.length_offset = LengthOffset::Implicit;
    let called = |source: (u32, &str), block: (u32, &str)| {
        let tool = |(number, name): (u32, &str)| {
            Box::new(Tool { number, name: name.into(), ..Tool::default() })
        };
        let own = program([vec![Op::Tool(tool(source))], start()[1..].to_vec(), cut()].concat());
        let mut nc = [nc_start(), cut_nc(), end()].concat();
        nc[1] = Action::Tool(tool(block));
        run(&implicit, &own, nc).proven
    };
    assert!(called((3, ""), (3, "")) && called((3, "MILL 16"), (0, "mill_16")));
    assert!(called((0, ""), (3, "")) && called((0, "M.1"), (0, "M.1")));
    assert!(!called((3, "MILL_16"), (0, "MILL.16")) && !called((3, "MILL_16"), (0, "MILL_16 ")));
    // T0 is an empty spindle.
    assert!(!called((3, ""), (0, "")) && !called((0, ""), (0, "")));
}

#[test]
fn the_length_offset_holds_on_the_way_to_a_tool_change() {
    let report = |off: Vec<Action>| {
        let mut own = cut();
        own.extend([vec![Op::Tool(tool(2))], start()[1..].to_vec(), cut()].concat());
        let away = vec![
            Action::Rapid(block(30.0, 0.0, 60.0)),
            Action::Home(Axes::Z),
            Action::Tool(tool(2)),
        ];
        let mut nc = [cut_nc(), off, away].concat();
        nc.extend([actions(&start()[1..]), vec![Action::LengthOffset(Some(2))], cut_nc()].concat());
        rules(&judge(&mill(), &source(own), nc))
    };
    assert!(report(vec![]).is_empty());
    assert_eq!(report(vec![Action::LengthOffset(None)]), ["length-offset"]);
    assert_eq!(report(vec![Action::WorkOffset(offset(55))]), ["work-offset"]);
}

/// At the start nobody knows how high the tool stands: X and Y go home at that height, or while Z goes up, where Z has not gone
/// before.
#[test]
fn other_axes_that_go_home_first_of_all_get_a_warning() {
    let warned = |own: Vec<Op>, before: &[&Action]| {
        let ended = vec![Action::Home(Axes::Z)];
        let before = before.iter().map(|action| (*action).clone()).collect();
        let does = [before, nc_start(), cut_nc(), ended, end()].concat();
        let report = run(&mill(), &source([own, cut()].concat()), does);
        proven(&report);
        report.warnings.iter().filter(|found| found.rule == Rule::Home).count()
    };
    let of = |xyz: [bool; 3]| Action::Home(Axes::of([xyz[0], xyz[1], xyz[2], false, false, false]));
    let (xy, z, xz) = (of([true, true, false]), of([false, false, true]), of([true, false, true]));
    let all = Action::Home(Axes::LINEAR);
    for own in [vec![], vec![Op::Home]] {
        assert_eq!(warned(own.clone(), &[&z]), 0);
        assert_eq!(warned(own.clone(), &[&z, &xy]), 0);
        assert_eq!(warned(own.clone(), &[&z, &all]), 0);
        assert_eq!(warned(own.clone(), &[&xy, &z]), 1);
        assert_eq!(warned(own.clone(), &[&all]), 1);
        assert_eq!(warned(own, &[&xz]), 1);
    }
    assert_eq!(warned(vec![], &[]), 0);
}

#[test]
fn other_axes_go_home_with_z_only_from_above_the_part() {
    let report = |above: f64| {
        let (mut own, mut nc) = (cut(), cut_nc());
        own.extend([vec![Op::Rapid(at(30.0, 0.0, above))], start(), cut()].concat());
        nc.extend([Action::Rapid(block(30.0, 0.0, above)), Action::Home(Axes::LINEAR)]);
        nc.extend(nc_start());
        judge(&mill(), &source(own), [nc, cut_nc()].concat())
    };
    let from_above = report(5.0);
    proven(&from_above);
    // The program changes the first tool before anything goes home.
    let warned: Vec<_> = from_above.warnings.iter().map(|found| found.rule.name()).collect();
    assert_eq!(warned[..2], ["tool-change-height", "home"]);
    assert_eq!(rules(&report(4.0)), ["home"]);
}

#[test]
fn a_lift_along_the_tool_axis_and_back_is_an_excursion() {
    let report = |way: Vec<Action>| {
        let mut nc = cut_nc();
        nc.splice(2..2, [vec![Action::Line(block(10.0, 0.0, -1.0))], way].concat());
        judge(&mill(), &source(cut()), nc)
    };
    let rapid = |x, y, z| Action::Rapid(block(x, y, z));
    let lifted = report(vec![rapid(10.0, 0.0, 40.0), Action::Line(block(10.0, 0.0, -1.0))]);
    proven(&lifted);
    assert_eq!(lifted.excursions[0].lift_mm, 41.0);
    let (up, down) = (rapid(10.0, 0.0, 40.0), rapid(10.0, 0.0, -1.0));
    // Down into the part, next to it, and back on a slope are not.
    assert_eq!(rules(&report(vec![rapid(10.0, 0.0, -5.0), down.clone()])), ["rapid-feed"]);
    assert_eq!(rules(&report(vec![rapid(12.0, 0.0, 40.0), down.clone()])), ["rapid-feed"]);
    let aside = vec![up.clone(), rapid(10.0, 9.0, 40.0), down.clone()];
    assert_eq!(rules(&report(aside)), ["excursion"]);
    let astray = vec![up.clone(), rapid(10.0, 9.0, -1.0), up.clone(), down];
    assert_eq!(rules(&report(astray)), ["rapid-path", "rapid-stop"]);
    assert_eq!(rules(&report(vec![up])), ["rapid-feed"]);
}

#[test]
fn after_the_last_motion_the_tool_only_leaves() {
    let ending = |end: Vec<Action>| {
        rules(&run(&mill(), &source(cut()), [nc_start(), cut_nc(), off(), end].concat()))
    };
    let away = Action::Rapid(block(30.0, 0.0, 100.0));
    let (up, aside) = (Action::Home(Axes::Z), Action::Home(Axes::X | Axes::Y));
    assert!(ending(vec![away.clone(), up.clone(), aside.clone(), Action::End]).is_empty());
    assert_eq!(ending(vec![up]), ["no-end"]);
    assert_eq!(ending(vec![Action::Rapid(block(30.0, 5.0, 5.0)), Action::End]), ["extra-motion"]);
    assert_eq!(ending(vec![Action::Rapid(block(30.0, 0.0, -5.0)), Action::End]), ["extra-motion"]);
    assert_eq!(ending(vec![Action::Line(block(30.0, 0.0, 9.0)), Action::End]), ["extra-motion"]);
    assert_eq!(ending(vec![aside, Action::End]), ["home"]);
    assert_eq!(ending(vec![Action::End, away]), ["after-end"]);
    assert_eq!(ending(vec![Action::End, Action::Spindle(Spindle::Clockwise(9.0))]), ["after-end"]);
}

#[test]
fn what_a_program_leaves_on_at_its_end_is_refused() {
    let ending = |end: Vec<Action>| {
        let nc = [nc_start(), cut_nc(), vec![Action::Home(Axes::Z)], end, vec![Action::End]];
        rules(&run(&mill(), &source(cut()), nc.concat()))
    };
    let and_off = |more: Action| [off(), vec![more]].concat();
    assert_eq!(ending(off()), [""; 0]);
    assert_eq!(ending(vec![]), ["left-on"]);
    assert_eq!(ending(off()[1..].to_vec()), ["left-on"]);
    assert_eq!(ending(off()[..1].to_vec()), ["left-on"]);
    assert_eq!(ending(and_off(Action::Spindle(Spindle::Clockwise(9.0)))), ["left-on"]);
    assert_eq!(ending(and_off(Action::WorkOffset(offset(55)))), ["left-on"]);
    assert_eq!(ending(and_off(Action::LengthOffset(Some(2)))), ["left-on"]);
    assert_eq!(ending(and_off(Action::Taper(1.0))), ["left-on"]);
    // The length of the tool that has cut may stay or end, and so may the first work offset.
    assert_eq!(ending(and_off(Action::LengthOffset(None))), [""; 0]);
    assert_eq!(ending(and_off(Action::WorkOffset(WorkOffset::FIRST))), [""; 0]);
}

#[test]
fn a_program_that_ends_with_the_tool_over_the_part_is_reported() {
    let warned = |between: Vec<Action>| {
        let report = run(&mill(), &source(cut()), [nc_start(), cut_nc(), between, end()].concat());
        proven(&report);
        report.warnings.iter().any(|found| found.rule == "end-height")
    };
    assert!(warned(vec![]));
    assert!(!warned(vec![Action::Home(Axes::Z)]));
}

#[test]
fn a_first_cut_from_an_unknown_place_has_to_go_straight_to_its_end() {
    let own = source(cut()[1..].to_vec());
    let report = judge(&mill(), &own, cut_nc()[1..].to_vec());
    proven(&report);
    assert!(report.warnings.iter().any(|found| found.rule == "unknown-start"));
    let mut nc = cut_nc()[1..].to_vec();
    nc.insert(0, Action::Line(block(0.0, 3.0, -1.0)));
    assert_eq!(rules(&judge(&mill(), &own, nc)), ["unknown-start"]);
}

#[test]
fn the_same_difference_is_reported_once_with_its_count() {
    let slow = vec![Action::Feed(Feed::PerMinute(30.0))];
    let report = judge(&mill(), &source(cut()), [slow, cut_nc()].concat());
    assert_eq!(report.mismatches.len(), 1);
    assert_eq!(report.mismatches[0].count, 2);
    let message = "source line 6: the feed is 30 mm/min, but should be 300 mm/min";
    assert_eq!(report.mismatches[0].message, message);
}

/// The cut, then the same cut after `between`.
fn twice<T: Clone>(cut: Vec<T>, between: Vec<T>) -> Vec<T> {
    [cut.clone(), between, cut].concat()
}

#[test]
fn a_change_of_the_work_offset_is_made_from_above_and_to_the_right_one() {
    let own = twice(cut(), vec![Op::WorkOffset(offset(55))]);
    let judged = |between| rules(&judge(&mill(), &source(own.clone()), twice(cut_nc(), between)));
    let (up, to) = (Action::Home(Axes::Z), |number| Action::WorkOffset(offset(number)));
    assert!(judged(vec![up.clone(), to(55)]).is_empty());
    assert_eq!(judged(vec![up.clone(), to(56)])[0], "work-offset");
    assert_eq!(judged(vec![to(55)])[0], "home");
    assert!(!judged(vec![up]).is_empty());
    // A source without work offsets is made in the first.
    assert_eq!(after_start(vec![to(55)])[0], "work-offset");
}

#[test]
fn the_tool_goes_home_where_the_source_does() {
    let own = twice(cut(), vec![Op::Home]);
    let judged = |between| rules(&judge(&mill(), &source(own.clone()), twice(cut_nc(), between)));
    assert!(judged(vec![Action::Home(Axes::Z)]).is_empty());
    assert_eq!(judged(vec![])[0], "home");
}

/// Above all that is cut a program may stop and start the spindle as it likes, but no other way round than the source has it somewhere,
/// and it opens no valve that the source opens nowhere.
#[test]
fn what_the_source_switches_on_nowhere_is_refused_where_nothing_is_cut_too() {
    let behind = |source_has: Vec<Op>, switched: Action| {
        let own = source([cut(), source_has].concat());
        let nc = [nc_start(), cut_nc(), vec![Action::Home(Axes::Z)], off(), vec![switched], end()];
        rules(&run(&mill(), &own, nc.concat()))
    };
    let reversed = || Action::Spindle(Spindle::CounterClockwise(1000.0));
    assert_eq!(behind(vec![], reversed()), ["spindle"]);
    assert!(behind(vec![], Action::Spindle(Spindle::Clockwise(1000.0))).is_empty());
    // A tap that is made by moves turns back.
    let tap = Cycle { kind: CycleKind::Tap { pitch: 1.0, left: false }, ..drill() };
    assert!(behind(vec![Op::Cycle(Box::new(tap)), Op::CycleOff], reversed()).is_empty());
    for other in [Coolant::Mist, Coolant::FloodAndMist, Coolant::Through] {
        assert_eq!(behind(vec![], Action::Coolant(other)), ["coolant"]);
    }
    assert!(behind(vec![], Action::Coolant(Coolant::Flood)).is_empty());
    let both = vec![Op::Coolant(Coolant::FloodAndMist), Op::Coolant(Coolant::Off)];
    assert!(behind(both, Action::Coolant(Coolant::Mist)).is_empty());
}
