//! Outputs, inputs and functions of the machine's builder in a proof; and records that no program can be compared with.

use crate::common::*;
use control::Action;
use program::*;

fn function(number: u32) -> Auxiliary {
    Auxiliary::of(number)
}

fn output(number: u32, on: bool) -> Output {
    Output { number, value: OutputValue::Digital(on), with_motion: false }
}

/// Two cuts, with this between them.
fn between(op: Op) -> Program {
    source(vec![
        Op::Rapid(at(0.0, 0.0, 2.0)),
        Op::Line(at(0.0, 0.0, -1.0)),
        op,
        Op::Line(at(30.0, 0.0, -1.0)),
        Op::End,
    ])
}

/// The rules by which a program is refused that does this before the first cut, between the two and after both.
fn rules_of(source: &Program, [before, within, after]: [Vec<Action>; 3]) -> Vec<&'static str> {
    let first = vec![Action::Rapid(block(0.0, 0.0, 2.0))];
    let down = vec![Action::Line(block(0.0, 0.0, -1.0))];
    let along = vec![Action::Line(block(30.0, 0.0, -1.0))];
    rules(&judge(&mill(), source, [first, before, down, within, along, after].concat()))
}

/// What refuses a program that does `does` in place of what the source says.
fn instead(op: Op, does: Vec<Action>) -> Vec<&'static str> {
    rules_of(&between(op), [vec![], does, vec![]])
}

#[test]
fn an_output_is_the_same_one_and_switched_in_the_same_way_between_the_same_motions() {
    let on = Op::Output(output(3, true));
    let does = |output| vec![Action::Output(output)];
    assert!(instead(on.clone(), does(output(3, true))).is_empty());
    let other = [
        output(2, true),
        output(3, false),
        Output { with_motion: true, ..output(3, true) },
        Output { value: OutputValue::Analog(1.0), ..output(3, true) },
    ];
    for other in other {
        assert_eq!(instead(on.clone(), does(other)), ["output"], "{other:?}");
    }
    assert_eq!(instead(on.clone(), vec![]), ["output"]);
    assert_eq!(
        instead(on.clone(), [does(output(3, true)), does(output(3, true))].concat()),
        ["output"]
    );
    let source = between(on);
    let moved = |sides| rules_of(&source, sides);
    assert_eq!(moved([does(output(3, true)), vec![], vec![]]), ["output"]);
    assert_eq!(moved([vec![], vec![], does(output(3, true))]), ["output"]);

    let analog = |value| Output { value: OutputValue::Analog(value), ..output(0, true) };
    assert!(instead(Op::Output(analog(1.23456)), does(analog(1.2346))).is_empty());
    assert_eq!(instead(Op::Output(analog(1.23456)), does(analog(1.2347))), ["output"]);
}

#[test]
fn an_input_is_waited_for_in_the_same_way() {
    let wait = Input { number: 2, until: Until::High, timeout: 5.0 };
    let does = |input| vec![Action::Input(Box::new(input))];
    let source = Op::Input(Box::new(wait));
    assert!(instead(source.clone(), does(wait)).is_empty());
    let others = [
        Input { number: 1, ..wait },
        Input { until: Until::Low, ..wait },
        Input { timeout: 6.0, ..wait },
    ];
    for other in others {
        assert_eq!(instead(source.clone(), does(other)), ["input"], "{other:?}");
    }
    assert_eq!(instead(source, vec![]), ["input"]);
}

#[test]
fn a_function_of_the_builder_that_the_source_calls_is_called_there() {
    let call = Op::Auxiliary(function(21));
    let does = |function| vec![Action::Auxiliary(function)];
    assert!(instead(call.clone(), does(function(21))).is_empty());
    assert_eq!(instead(call.clone(), vec![]), ["auxiliary"]);
    assert_eq!(instead(call.clone(), does(function(22))), ["auxiliary"]);
    let source = between(call);
    assert_eq!(rules_of(&source, [does(function(21)), vec![], vec![]]), ["auxiliary"]);
    assert_eq!(rules_of(&source, [vec![], vec![], does(function(21))]), ["auxiliary"]);
    // With the values that it is called with.
    let with = |p, q| Auxiliary { values: [p, q], ..function(101) };
    let call = Op::Auxiliary(with(Some(2.0), None));
    assert!(instead(call.clone(), does(with(Some(2.0), None))).is_empty());
    for other in [with(Some(3.0), None), with(Some(2.0), Some(0.0)), with(None, None)] {
        assert_eq!(instead(call.clone(), does(other)), ["auxiliary"], "{other:?}");
    }
}

/// The blocks of a machine file call functions of their own: they open clamps before a table turns.
#[test]
fn a_function_that_the_source_does_not_call_is_the_machines_own() {
    let does = vec![Action::Auxiliary(function(26))];
    assert!(instead(Op::Comment("no call".into()), does).is_empty());
}

#[test]
fn what_comes_after_the_last_motion_is_missed_too() {
    let cut = [Op::Rapid(at(0.0, 0.0, 2.0)), Op::Line(at(0.0, 0.0, -1.0))];
    let does = || vec![Action::Rapid(block(0.0, 0.0, 2.0)), Action::Line(block(0.0, 0.0, -1.0))];
    for (op, rule) in [
        (Op::Output(output(1, false)), "output"),
        (Op::Auxiliary(function(21)), "auxiliary"),
        (Op::Dwell(2.0), "dwell"),
        (Op::Stop, "stop"),
    ] {
        let source = source([&cut[..], &[op]].concat());
        assert_eq!(rules(&judge(&mill(), &source, does())), [rule]);
    }
}

/// No virtual control reports these yet: whatever the program does, it is not proven.
#[test]
fn what_cannot_be_compared_is_never_proven() {
    let records = [
        Op::Oriented(Box::new(Oriented {
            end: FullPose::new(at(30.0, 0.0, -1.0), geom::Vec3::X).unwrap(),
            course: Course::Line,
            configuration: None,
            external: Vec::new(),
        })),
        Op::Joints(Box::new(JointMove { degrees: [0.0; 6], external: Vec::new() })),
        Op::MachineMove(Box::default()),
        Op::Beam(Beam::Off),
        Op::Pulses(1),
    ];
    for op in records {
        let kind = op.kind().name();
        assert!(instead(op.clone(), vec![]).contains(&"unproven"), "{kind}");
        let stop = vec![Action::Stop];
        assert!(instead(op.clone(), stop).contains(&"unproven"), "{kind}");
        // Even where nothing follows it.
        let ends = source(vec![Op::Rapid(at(0.0, 0.0, 2.0)), op]);
        let found = rules(&judge(&mill(), &ends, vec![Action::Rapid(block(0.0, 0.0, 2.0))]));
        assert_eq!(found, ["unproven"], "{kind}");
    }
}
