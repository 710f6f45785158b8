//! Reading short texts, for the tests of single statements.

use geom::Vec3;
use program::{Op, Pose};
use toolpost_source::apt::{Options, Reading, read};

/// Unit, tool, spindle and feed, so that a cut may follow at once.
pub const HEAD: &str = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\n";
/// Records that `HEAD` makes.
pub const HEAD_OPS: usize = 3;

pub fn reading(text: &str) -> Reading {
    read("test.apt", text.as_bytes(), &Options::default()).unwrap_or_else(|e| panic!("{}", e[0]))
}

/// The records of `body` after [`HEAD`], without the end, and without any warning.
pub fn ops(body: &str) -> Vec<Op> {
    let reading = reading(&format!("{HEAD}{body}\nFINI\n"));
    assert!(reading.warnings.is_empty(), "{}", reading.warnings[0]);
    let mut ops: Vec<Op> = reading.program.records.into_iter().map(|record| record.op).collect();
    assert_eq!(ops.pop(), Some(Op::End));
    ops.split_off(HEAD_OPS)
}

/// The rules of the warnings of `body` after [`HEAD`].
pub fn warnings(body: &str) -> Vec<&'static str> {
    reading(&format!("{HEAD}{body}\nFINI\n")).warnings.iter().map(|w| w.rule.name()).collect()
}

/// The one error of `body` after [`HEAD`].
pub fn error(body: &str) -> &'static str {
    let text = format!("{HEAD}{body}\nFINI\n");
    let errors = read("test.apt", text.as_bytes(), &Options::default()).expect_err(body);
    errors[0].rule.name()
}

pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// Whether the poses of `ops` are `expected` (point, axis) within rounding.
#[track_caller]
pub fn assert_poses(ops: &[Op], expected: &[([f64; 3], [f64; 3])]) {
    let poses: Vec<&Pose> = ops.iter().filter_map(Op::pose).collect();
    assert_eq!(poses.len(), expected.len(), "{ops:?}");
    for (pose, (point, axis)) in poses.iter().zip(expected) {
        let near = |a: Vec3, b: [f64; 3]| a.distance(Vec3::from_array(b)) < 1e-9;
        assert!(near(pose.point(), *point), "{:?} is not {point:?}", pose.point());
        assert!(near(pose.axis(), *axis), "{:?} is not {axis:?}", pose.axis());
    }
}

pub const Z: [f64; 3] = [0.0, 0.0, 1.0];
