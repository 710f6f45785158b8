//! A straight cut behind another one is written on a short path of its own; a record between them that says what holds leads past it.
//! Both give the same text, whatever records come before: they are of every kind, and the machines write an orientation in every way.

#[path = "common/samples.rs"]
mod samples;

use geom::{Frame, Vec3};
use machine::Machine;
use program::{
    Compensation, Coolant, Cycle, CycleKind, Feed, Kind, Op, PathMode, Pose, Program, Spindle, Tool,
};
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
    leaning_at(3.0, 2.0, 0.1)
}

/// At X, Y, Z-1, the tool axis leaning along Y.
fn leaning_at(x: f64, y: f64, lean: f64) -> Pose {
    Pose::new(Vec3::new(x, y, -1.0), Vec3::new(0.0, lean, 1.0).normalize()).unwrap()
}

/// Cuts whose axis goes round Z until a rotary axis is at the end of its travel, and cuts along Z between, in which it may turn back.
fn winding(sense: f64) -> Vec<Op> {
    let round = |turn: u32| {
        (0..8).map(move |eighth| {
            let angle = sense * std::f64::consts::FRAC_PI_4 * f64::from(eighth);
            let axis = Vec3::new(0.2 * angle.cos(), 0.2 * angle.sin(), 1.0).normalize();
            let point = Vec3::new(f64::from(eighth), f64::from(turn), -1.0);
            Op::Line(Pose::new(point, axis).unwrap())
        })
    };
    let upright = |turn: u32| [3.0, 2.0, 1.0].map(|x| Op::Line(at(x, f64::from(turn), -1.0)));
    (0..6).flat_map(|turn| round(turn).chain(upright(turn))).collect()
}

/// A hole whose cycle has a feed of its own: where a control has no such cycle, it is made of straight cuts.
fn drilled() -> [Op; 2] {
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 2.0,
        clearance: 2.0,
        retract: 6.0,
        feed: Some(Feed::PerMinute(77.0)),
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    [Op::Cycle(Box::new(cycle)), Op::Hole(at(0.0, 0.0, -1.0))]
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
        // Along one leaning axis, from one to another, and about Z, where a rotary axis is free.
        [(3.0, 2.0), (4.0, 3.0), (6.0, 1.0)].map(|(x, y)| Op::Line(leaning_at(x, y, 0.1))).into(),
        [0.1, 0.2, 0.2, 0.0, 0.0].map(|lean| Op::Line(leaning_at(30.0 * lean, 2.0, lean))).into(),
        [0.0, 1e-9, 0.0].map(|lean| Op::Line(leaning_at(2.0, 2.0 + lean, lean))).into(),
        winding(1.0),
        winding(-1.0),
        // Beyond the travel of the small ones, and of all.
        vec![Op::Line(at(450.0, 0.0, -1.0))],
        vec![Op::Line(at(0.0, 90_000.0, -1.0))],
        drilled().into(),
        [drilled().as_slice(), &[Op::Hole(at(9.0, 0.0, -1.0)), Op::CycleOff]].concat(),
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
        "haas-umc-750",
        "linuxcnc-xyzac",
        "linuxcnc-xyzbc-head",
    ];
    names.map(|name| machine::load(name).unwrap()).into()
});

/// Wire-EDM machines.
static WIRES: LazyLock<Vec<Machine>> = LazyLock::new(|| {
    ["fanuc-wire", "sodick-iso", "agie-iso"].map(|name| machine::load(name).unwrap()).into()
});

/// Cuts of a wire, upright and leaning, with a taper that the control makes.
#[test]
fn a_straight_cut_of_a_wire_is_written_the_same_on_the_short_path() {
    let points = [(5.0, 0.0), (5.0, 5.0), (0.0, 5.0), (0.0, 0.0)];
    let upright = points.map(|(x, y)| Op::Line(at(x, y, 0.0)));
    let along = |lean: f64| {
        points.map(|(x, y)| {
            let axis = Vec3::new(lean, 0.0, 1.0).normalize();
            Op::Line(Pose::new(Vec3::new(x, y, 0.0), axis).unwrap())
        })
    };
    let parts: [Vec<Op>; 10] = [
        vec![],
        vec![Op::Taper(5.0)],
        vec![Op::Taper(-3.0)],
        vec![Op::Taper(0.0)],
        vec![Op::Compensation(Compensation::Left(Some(1)))],
        vec![Op::Compensation(Compensation::Off)],
        vec![Op::Feed(Feed::PerMinute(4.0))],
        along(0.05).into(),
        along(0.1).into(),
        vec![Op::CutWire, Op::Rapid(at(0.0, 0.0, 0.0)), Op::ThreadWire],
    ];
    let mut written = 0;
    for machine in WIRES.iter() {
        for parts in parts.iter().flat_map(|a| parts.iter().map(move |b| [a, b])) {
            let start = [Op::Rapid(at(0.0, 0.0, 0.0)), Op::ThreadWire];
            let feed = [Op::Feed(Feed::PerMinute(3.0))];
            let ops = [
                start.as_slice(),
                &feed,
                &upright,
                parts[0],
                &upright,
                parts[1],
                &upright,
                &[Op::CutWire],
            ]
            .concat();
            let is_written = both_paths(machine, &ops).unwrap_or_else(|found| panic!("{found}"));
            written += usize::from(is_written);
        }
    }
    assert!(written > 60, "{written}");
}

fn begins() -> Vec<Op> {
    vec![
        Op::Tool(Box::new(Tool { number: 1, diameter: Some(6.0), ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Rapid(at(0.0, 0.0, 6.0)),
    ]
}

/// What leads past the short path does: behind a feed in between, the next cut says it.
#[test]
fn a_record_between_two_cuts_leads_past_the_short_path() {
    for machine in MILLS.iter() {
        let feed = [Op::Feed(Feed::PerMinute(123.0))];
        let ops = [&begins(), cuts().as_slice(), &feed, &cuts()].concat();
        let written = post::write(&lines(ops), machine).unwrap();
        let text = String::from_utf8_lossy(&written.text);
        assert_eq!(text.matches("F123").count(), 1, "{}\n{text}", machine.name);
    }
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
