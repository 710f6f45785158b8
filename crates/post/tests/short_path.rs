//! A straight cut behind another one is written on a short path of its own; a record between them that says what holds leads past it.
//! Both give the same text, whatever records come before: they are of every kind, and the machines write an orientation in every way.

#[path = "common/samples.rs"]
mod samples;

use geom::{Frame, Vec3};
use machine::Machine;
use program::{Compensation, Coolant, Feed, Kind, Op, PathMode, Pose, Program, Spindle, Tool};
use proptest::prelude::*;
use samples::{Sample, at, lines, sample};
use std::sync::LazyLock;
use toolpost_post as post;

/// The same program with the feed that holds once more before each straight cut: a record between two cuts leads the writer past the
/// short path of a straight cut behind another one.
fn past_the_short_path(ops: &[Op]) -> Program {
    let mut feed = None;
    lines(ops.iter().flat_map(|op| {
        if let Op::Feed(own) = op {
            feed = Some(*own);
        }
        let again = feed.filter(|_| matches!(op, Op::Line(_))).map(Op::Feed);
        again.into_iter().chain([op.clone()])
    }))
}

/// Writes the records on the short path and past it: the same text, or a refusal by the same rule.
fn both_paths(machine: &Machine, ops: &[Op]) -> Result<bool, String> {
    let written = |program: &Program| match post::write(program, machine) {
        Ok(output) => Ok(String::from_utf8_lossy(&output.text).into_owned()),
        Err(found) => Err(found[0].rule),
    };
    let short = written(&lines(ops.iter().cloned()));
    let past = written(&past_the_short_path(ops));
    match short == past {
        true => Ok(short.is_ok()),
        false => Err(format!("{}\n{ops:?}\n{short:?}\n{past:?}", machine.name)),
    }
}

/// Straight cuts in a row to X0 Y0 Z-1, where a sample begins.
fn cuts() -> [Op; 3] {
    [at(5.0, 0.0, -1.0), at(5.0, 0.0, -1.5), at(0.0, 0.0, -1.0)].map(Op::Line)
}

fn leaning() -> Pose {
    Pose::new(Vec3::new(3.0, 2.0, -1.0), Vec3::new(0.0, 0.1, 1.0).normalize()).unwrap()
}

/// A sample of each kind, and what of the same kinds changes cuts otherwise.
fn alphabet() -> Vec<Vec<Op>> {
    let samples = Kind::ALL.into_iter().filter(|kind| *kind != Kind::End).map(|kind| {
        let Sample { before, op, after } = sample(kind);
        before.into_iter().chain([op]).chain(after).collect()
    });
    let slope = Frame::from_rotation_x(0.3);
    let others = [
        vec![Op::Feed(Feed::PerTurn(0.1))],
        vec![Op::Feed(Feed::InverseTime(20.0))],
        vec![Op::Compensation(Compensation::Right(None))],
        vec![Op::Compensation(Compensation::Off)],
        vec![Op::Spindle(Spindle::Off)],
        vec![Op::Coolant(Coolant::Off)],
        vec![Op::Line(leaning())],
        vec![Op::Line(leaning()), Op::Line(leaning()), Op::Line(at(4.0, 4.0, -1.0))],
        vec![Op::Rapid(at(0.0, 0.0, 6.0)), Op::Frame(Box::new(slope)), Op::Rapid(leaning())],
        vec![Op::PathMode(PathMode::ExactPath)],
    ];
    samples.chain(others).collect()
}

/// Mills with every way of writing an orientation, and with a feed of rapids of their own.
static MILLS: LazyLock<Vec<Machine>> = LazyLock::new(|| {
    let names = [
        "generic-3axis-linuxcnc",
        "generic-3axis-fanuc",
        "grbl-3018",
        "dmu50-heidenhain",
        "fanuc-table-bc",
        "sinumerik-840d-table-ac",
        "sinumerik-840d-traori",
    ];
    names.map(|name| machine::load(name).unwrap()).into()
});

fn begins() -> Vec<Op> {
    vec![
        Op::Tool(Box::new(Tool { number: 1, diameter: Some(6.0), ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Rapid(at(0.0, 0.0, 6.0)),
    ]
}

#[test]
fn a_straight_cut_is_written_the_same_on_the_short_path_behind_every_record() {
    let mut written = 0;
    for machine in MILLS.iter() {
        for part in alphabet() {
            let ops = [begins(), cuts().to_vec(), part, cuts().to_vec(), cuts().to_vec()].concat();
            let is_written = both_paths(machine, &ops).unwrap_or_else(|found| panic!("{found}"));
            written += usize::from(is_written);
        }
    }
    assert!(written > 100, "{written}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn straight_cuts_are_written_the_same_on_the_short_path_among_any_records(
        machine in any::<prop::sample::Index>(),
        parts in prop::collection::vec((any::<prop::sample::Index>(), any::<bool>()), 1..6),
    ) {
        let alphabet = alphabet();
        let parts = parts.into_iter().flat_map(|(part, cut)| {
            let cuts = if cut { cuts().to_vec() } else { Vec::new() };
            [part.get(&alphabet).clone(), cuts].concat()
        });
        let ops: Vec<Op> = [begins(), cuts().to_vec()].concat().into_iter().chain(parts).collect();
        let both = both_paths(machine.get(&MILLS), &ops);
        prop_assert!(both.is_ok(), "{}", both.unwrap_err());
    }
}
