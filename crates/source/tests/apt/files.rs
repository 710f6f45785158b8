//! Cutter-location data that CAM systems wrote for real parts. The figures were counted with `grep` and
//! `awk` in the files, not with the reader.

use geom::{Arc, Vec3, angle_between};
use program::statistics::Statistics;
use program::{CycleKind, Op, Program, Spindle};
use std::path::PathBuf;
use toolpost_source::apt::{Dialect, Options, Reading, read};

/// The folder of real input.
fn data() -> Option<PathBuf> {
    judge::data("cldata")
}

/// Reads `name`; `None` where there is no real input.
fn reading(name: &str) -> Option<Reading> {
    let text = std::fs::read(data()?.join(name)).expect("the file is there");
    match read(name, &text, &Options::default()) {
        Ok(reading) => Some(reading),
        Err(errors) => panic!("{}", errors[0]),
    }
}

/// A file, its rapids, lines, arcs and holes, its tools, and the box of its points.
type Counted = (&'static str, [usize; 4], &'static [u32], [f64; 3], [f64; 3]);

const FILES: [Counted; 14] = [
    ("makino/Plane_1.cldata", [5, 171, 29, 0], &[45], [0., -5., 28.], [55., 30., 50.]),
    ("makino/Plane_2.cldata", [5, 28, 29, 0], &[45], [-55., -0.3499734, 28.], [0., 30., 50.]),
    (
        "nx/coremill.cls",
        [356, 2160, 614, 0],
        &[1],
        [-20.4445, -20.4423, 30.],
        [320.4442, 220.4441, 146.],
    ),
    (
        "nx/simple_block.cls",
        [30, 41, 33, 0],
        &[1],
        [-12.9971, -14.0265, 15.],
        [112.6997, 112.6997, 40.],
    ),
    ("solidworks/Dem-target1.apt", [1, 0, 0, 4], &[14], [9., 8., 0.], [211., 212., 25.]),
    (
        "solidworks/Dem-target2.apt",
        [99, 132, 75, 8],
        &[14, 16, 5],
        [5., 5., -24.],
        [215., 215., 25.],
    ),
    (
        "solidworks/Interface-glue.apt",
        [36, 6219, 50, 6],
        &[16, 17, 8],
        [10.362189, -2.408075, -30.005],
        [124.637811, 124.639047, 25.],
    ),
    (
        "solidworks/Sacrifice-Board.apt",
        [150, 246, 70, 28],
        &[12, 11, 1, 2],
        [-52.5, 19.895833, -55.],
        [492.5, 150., 25.],
    ),
    (
        "solidworks/SupPetriLED.apt",
        [59, 122, 107, 12],
        &[16, 17, 1],
        [-6.966951, -10.608542, -30.],
        [125.345924, 122.304206, 64.],
    ),
    (
        "solidworks/Teflon-gasket.apt",
        [67, 84, 99, 2],
        &[6, 16, 2],
        [9.25, -6.692519, -35.005],
        [20.597218, 19.625963, 25.],
    ),
    (
        "solidworks/Teste-Metrologia.apt",
        [92, 297, 65, 0],
        &[1],
        [-8.856356, -17.5, -51.4375],
        [250., 55.5, 25.],
    ),
    (
        "solidworks/Top-light-cover.apt",
        [191, 487, 708, 4],
        &[15, 5],
        [-15.5, -15.5, -30.],
        [204.5, 204.5, 25.],
    ),
    (
        "solidworks/basemach.apt",
        [374, 1331, 369, 16],
        &[14, 13, 15, 17],
        [12.5, 12.5, -10.5],
        [335.5, 133.5, 25.],
    ),
    (
        "solidworks/shimemcunha.apt",
        [23, 32, 28, 3],
        &[12, 13, 16],
        [-52.493833, 3.222501, -1.55],
        [88.89046, 34.672346, 25.448882],
    ),
];

#[test]
fn every_real_file_gives_the_moves_tools_and_points_that_are_in_it() {
    for (name, [rapids, lines, arcs, holes], tools, low, high) in FILES {
        let Some(reading) = reading(name) else { return };
        let s = Statistics::of(&reading.program);
        assert_eq!([s.rapids, s.lines, s.arcs, s.holes], [rapids, lines, arcs, holes], "{name}");
        assert_eq!(s.tools, tools, "{name}");
        let points: Vec<Vec3> = poses(&reading.program).map(|pose| pose.point()).collect();
        let fold = |f: fn(Vec3, Vec3) -> Vec3| points.iter().copied().reduce(f).unwrap().to_array();
        assert_eq!((fold(Vec3::min), fold(Vec3::max)), (low, high), "{name}");
        assert!(matches!(reading.program.records.last().unwrap().op, Op::End), "{name}");
    }
}

fn poses(program: &Program) -> impl Iterator<Item = &program::Pose> {
    program.records.iter().filter_map(|record| record.op.pose())
}

#[test]
fn the_cam_system_is_detected_in_the_file() {
    for (name, ..) in FILES {
        let Some(reading) = reading(name) else { return };
        let dialect = match name.split('/').next() {
            Some("makino") => Dialect::Makino,
            Some("nx") => Dialect::Nx,
            _ => Dialect::SolidWorksCam,
        };
        assert_eq!(reading.dialect, dialect, "{name}");
    }
}

/// Arcs of `program` with the direction (unit vector) of the straight cuts right before and after.
fn arcs(program: &Program) -> Vec<(Arc, Option<Vec3>, Option<Vec3>)> {
    let moves: Vec<&Op> =
        program.records.iter().map(|r| &r.op).filter(|op| op.pose().is_some()).collect();
    let point = |i: usize| moves[i].pose().unwrap().point();
    let cut = |i: usize| {
        let line = i > 0 && matches!(moves.get(i), Some(Op::Line(_)));
        line.then(|| point(i) - point(i - 1)).and_then(geom::direction)
    };
    let arc = |i: usize| match moves[i] {
        Op::Arc(a) => {
            let arc = a.circle.arc(point(i - 1), a.end.point(), 0.005);
            Some((arc.unwrap(), cut(i - 1), cut(i + 1)))
        }
        _ => None,
    };
    (1..moves.len()).filter_map(arc).collect()
}

#[test]
fn arcs_go_on_smoothly_from_the_straight_cuts_before_and_behind_them() {
    // By system: arcs with a tangent straight cut (within 3 degrees) if turned as read, arcs in all; none
    // would have all its straight cuts tangent in the other direction.
    for (system, expected, all) in [("makino", 49, 58), ("nx", 469, 647), ("solidworks", 700, 1571)]
    {
        let (mut count, mut smooth, mut reversed) = (0, 0, 0);
        for (name, ..) in FILES.iter().filter(|f| f.0.starts_with(system)) {
            let Some(reading) = reading(name) else { return };
            for (arc, before, after) in arcs(&reading.program) {
                let back = Arc { start: arc.end, end: arc.start, normal: -arc.normal, ..arc };
                let joints =
                    [before.map(|d| (d, arc.tangent())), after.map(|d| (d, -back.tangent()))];
                let angles: Vec<f64> = joints
                    .iter()
                    .flatten()
                    .map(|(d, t)| angle_between(*d, *t).to_degrees())
                    .collect();
                count += 1;
                smooth += usize::from(angles.iter().any(|a| *a < 3.0));
                let all_back = !angles.is_empty() && angles.iter().all(|a| *a > 177.0);
                reversed += usize::from(all_back);
            }
        }
        assert_eq!((count, smooth, reversed), (all, expected, 0), "{system}");
    }
}

#[test]
fn arcs_of_a_set_up_on_its_side_lie_in_its_plane() {
    let Some(reading) = reading("solidworks/Teste-Metrologia.apt") else { return };
    let on_the_side =
        arcs(&reading.program).iter().filter(|(a, ..)| a.normal.x.abs() == 1.0).count();
    // `grep '^CIRCLE' | grep -c '1.,0,0\r*$'`
    assert_eq!(on_the_side, 59);
}

#[test]
fn a_set_up_changes_the_frame_and_the_axis_of_every_point_in_it() {
    let set_ups = [
        ("Sacrifice-Board", vec![Vec3::NEG_Z]),
        ("Teste-Metrologia", vec![Vec3::X]),
        ("shimemcunha", vec![Vec3::new(0.005061, 0.0, 0.999987), Vec3::Z]),
    ];
    for (name, axes) in set_ups {
        let Some(reading) = reading(&format!("solidworks/{name}.apt")) else { return };
        let (mut frames, mut axis) = (Vec::new(), Vec3::Z);
        for record in &reading.program.records {
            if let Op::Frame(frame) = &record.op {
                axis = frame.matrix3.z_axis;
                frames.push(axis);
                assert_eq!(frame.translation, Vec3::ZERO);
            }
            if let Some(pose) = record.op.pose() {
                assert!(pose.axis().distance(axis) < 2e-6, "{name}:{}", record.line);
            }
        }
        assert_eq!(frames.len(), axes.len(), "{name}");
        assert!(frames.iter().zip(&axes).all(|(a, b)| a.distance(*b) < 2e-6), "{name}");
    }
}

#[test]
fn the_first_hole_of_a_real_part_is_drilled_as_the_file_says() {
    let Some(reading) = reading("solidworks/Dem-target1.apt") else { return };
    let ops: Vec<&Op> = reading.program.records.iter().map(|r| &r.op).collect();
    let Op::Tool(tool) = ops[0] else { panic!("{:?}", ops[0]) };
    assert_eq!((tool.number, tool.diameter, tool.corner_radius), (14, Some(3.0), Some(0.0)));
    assert_eq!(tool.name, "[HOLDER=C40-32ERP412] 3.0mm SCREW MACH DRILL");
    assert_eq!(tool.length, None);
    assert!(ops.iter().any(|op| **op == Op::Spindle(Spindle::Clockwise(12000.0))));
    let cycle = ops.iter().find_map(|op| match op {
        Op::Cycle(cycle) => Some(**cycle),
        _ => None,
    });
    let cycle = cycle.unwrap();
    assert_eq!(cycle.kind, CycleKind::Deep);
    assert_eq!((cycle.depth, cycle.clearance, cycle.retract), (24.6205, 3.0, 25.0));
    assert_eq!((cycle.first_peck, cycle.peck), (Some(5.0), Some(2.0)));
    assert_eq!(cycle.feed, Some(program::Feed::PerMinute(670.56)));
    assert_eq!(reading.program.name, "1");
    assert!(reading.warnings.is_empty());
}

#[test]
fn line_numbers_are_those_of_the_file() {
    for name in ["nx/simple_block.cls", "solidworks/Teste-Metrologia.apt"] {
        let Some(folder) = data() else { return };
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for record in &reading(name).unwrap().program.records {
            if record.op.pose().is_some() {
                assert!(lines[record.line as usize - 1].starts_with("GOTO/"));
            }
        }
    }
}

#[test]
fn a_real_file_that_is_cut_off_is_refused_or_says_so() {
    for name in ["nx/simple_block.cls", "solidworks/Dem-target1.apt", "makino/Plane_2.cldata"] {
        let Some(folder) = data() else { return };
        let text = std::fs::read(folder.join(name)).unwrap();
        let whole = text.trim_ascii_end().len();
        for cut in (0..whole - 5).step_by(97) {
            assert!(read(name, &text[..cut], &Options::default()).is_err(), "{name} at {cut}");
        }
    }
}

#[test]
fn a_real_file_in_strict_mode_fails_by_its_warnings_only() {
    for (name, ..) in FILES {
        let Some(folder) = data() else { return };
        let text = std::fs::read(folder.join(name)).unwrap();
        let warnings = reading(name).unwrap().warnings;
        match read(name, &text, &Options { strict: true, ..Options::default() }) {
            Ok(_) => assert!(warnings.is_empty()),
            Err(errors) => {
                let rules = |list: &[program::Diagnostic]| -> Vec<&str> {
                    list.iter().map(|d| d.rule.name()).collect()
                };
                assert_eq!(rules(&errors), rules(&warnings), "{name}");
            }
        }
    }
}
