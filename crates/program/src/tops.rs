//! How high a program goes, by how its tool leans.

use crate::{ArcTo, Cycle, Op, Pose, Program};
use geom::{Vec3, angle_between, reach_of_box};

/// Tools that lean apart by no more than this lean alike, radians: what one of them passes, the other does.
pub const ALIKE: f64 = 0.1;

/// So many poses are looked at one by one.
const FEW: usize = 16;

/// The poses of a program, so arranged that the highest of those with a tool that leans alike is found without a look at each.
#[derive(Clone, Debug)]
pub struct Tops {
    poses: Vec<Pose>,
    /// Boxes around halves of the poses, halves of these and so on: each before those of its own halves.
    boxes: Vec<PoseBox>,
}

/// The box around some of the poses.
#[derive(Clone, Copy, Debug)]
struct PoseBox {
    points: [Vec3; 2],
    axes: [Vec3; 2],
    /// The first pose, and the one behind the last.
    poses: [usize; 2],
    /// The number of the box of the second half; 0 where the poses are few.
    second: usize,
}

impl Tops {
    /// Those of `program`, whose poses are in the work frame: where its motions end, how high its arcs rise, and the heights from which
    /// and to which the tool goes at its holes.
    pub fn of(program: &Program) -> Tops {
        let mut here: Option<Pose> = None;
        let mut cycle: Option<&Cycle> = None;
        let mut poses = Vec::new();
        for record in &program.records {
            if let Op::Cycle(new) = &record.op {
                cycle = Some(new);
            }
            let Some(pose) = record.op.pose() else { continue };
            let height = if matches!(record.op, Op::Hole(_)) {
                cycle.map_or(0.0, |cycle| cycle.clearance.max(cycle.retract))
            } else if let Op::Arc(to) = &record.op {
                rise(here, to)
            } else {
                0.0
            };
            poses.push(pose.lifted(height).unwrap_or(*pose));
            here = Some(*pose);
        }
        let mut tops = Tops { boxes: Vec::with_capacity(2 * poses.len() / FEW + 1), poses };
        if !tops.poses.is_empty() {
            tops.divide([0, tops.poses.len()]);
        }
        tops
    }

    /// How high the program goes along `axis`, a unit vector, with its tool as it leans there, mm from the origin: from below that nobody
    /// knows what is around the tool elsewhere than on the program's own way. −∞ where its tool never leans so.
    pub fn along(&self, axis: Vec3) -> f64 {
        let mut highest = f64::NEG_INFINITY;
        if !self.boxes.is_empty() {
            self.look(0, axis, &mut highest);
        }
        highest
    }

    /// Puts a box around poses, and others around each half of them.
    fn divide(&mut self, [first, end]: [usize; 2]) {
        let poses = &mut self.poses[first..end];
        let [points, axes] = [Pose::point, Pose::axis].map(|part| {
            let parts = || poses.iter().map(part);
            [parts().fold(Vec3::INFINITY, Vec3::min), parts().fold(Vec3::NEG_INFINITY, Vec3::max)]
        });
        let number = self.boxes.len();
        self.boxes.push(PoseBox { points, axes, poses: [first, end], second: 0 });
        if poses.len() <= FEW {
            return;
        }
        let widest = |[low, high]: [Vec3; 2]| {
            let wide = high - low;
            let longest = if wide.x >= wide.y { 0 } else { 1 };
            let longest = if wide[longest] >= wide.z { longest } else { 2 };
            (wide[longest], longest)
        };
        let (lean, by_axis) = widest(axes);
        let part: (fn(&Pose) -> Vec3, usize) = match lean > ALIKE {
            true => (Pose::axis, by_axis),
            false => (Pose::point, widest(points).1),
        };
        let of = |pose: &Pose| part.0(pose)[part.1];
        let half = poses.len() / 2;
        poses.select_nth_unstable_by(half, |a, b| of(a).total_cmp(&of(b)));
        self.divide([first, first + half]);
        self.boxes[number].second = self.boxes.len();
        self.divide([first + half, end]);
    }

    /// Looks for a pose within a box that is higher than the highest so far.
    fn look(&self, number: usize, axis: Vec3, highest: &mut f64) {
        let PoseBox { poses: [first, end], second, .. } = self.boxes[number];
        if self.most(number, axis) <= *highest {
            return;
        }
        if second == 0 {
            let poses = self.poses[first..end].iter();
            let alike = poses.filter(|pose| angle_between(pose.axis(), axis) <= ALIKE);
            *highest = alike.map(|pose| pose.point().dot(axis)).fold(*highest, f64::max);
            return;
        }
        let mut halves = [number + 1, second];
        if self.most(halves[1], axis) > self.most(halves[0], axis) {
            halves.reverse();
        }
        for half in halves {
            self.look(half, axis, highest);
        }
    }

    /// How high the poses of a box can be at the most; −∞ where none of them leans alike.
    fn most(&self, number: usize, axis: Vec3) -> f64 {
        let PoseBox { points: [low, high], axes, .. } = self.boxes[number];
        // Chords are shorter than their arcs.
        match axis.clamp(axes[0], axes[1]).distance(axis) <= ALIKE {
            true => reach_of_box(low, high, axis),
            false => f64::NEG_INFINITY,
        }
    }
}

/// How far an arc rises along the tool above its end, mm. One across the tool is as high as its ends.
fn rise(from: Option<Pose>, to: &ArcTo) -> f64 {
    let (end, axis) = (to.end.point(), to.end.axis());
    let start = from.map_or(end, |from| from.point());
    if angle_between(to.circle.normal(), axis).sin() < 1e-9 {
        return 0.0;
    }
    to.circle.arc(start, end, f64::MAX).map_or(0.0, |arc| {
        let (low, high) = arc.extents();
        reach_of_box(low, high, axis) - end.dot(axis)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Circle, CycleKind};

    fn program(ops: impl IntoIterator<Item = Op>) -> Program {
        let mut program = Program::new("t");
        for (line, op) in (1..).zip(ops) {
            program.push(line, op);
        }
        program
    }

    /// The numbers of a linear congruential generator (Knuth's MMIX), 0 to 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn the_tree_finds_what_a_look_at_each_pose_finds() {
        let mut number = numbers();
        let mut any = || Vec3::new(number(), number(), number()) * 2.0 - 1.0;
        for lean in [0.0, 0.02, 0.3, 10.0] {
            let poses: Vec<Pose> = (0..3000)
                .map(|_| Pose::new(any() * 200.0, (Vec3::Z + any() * lean).normalize()).unwrap())
                .collect();
            let tops = Tops::of(&program(poses.iter().copied().map(Op::Rapid)));
            for _ in 0..200 {
                let axis = (Vec3::Z + any() * lean).normalize();
                let alike = poses.iter().filter(|pose| angle_between(pose.axis(), axis) <= 0.1);
                let highest =
                    alike.map(|pose| pose.point().dot(axis)).fold(f64::NEG_INFINITY, f64::max);
                assert_eq!(tops.along(axis), highest);
            }
        }
    }

    #[test]
    fn a_tool_that_leans_otherwise_does_not_count() {
        let sideways = Pose::new(Vec3::new(90.0, 0.0, 300.0), Vec3::X).unwrap();
        let upright = Pose::upright(Vec3::new(10.0, 0.0, 65.0)).unwrap();
        let tops = Tops::of(&program([Op::Rapid(sideways), Op::Rapid(upright)]));
        assert_eq!([Vec3::Z, Vec3::X].map(|axis| tops.along(axis)), [65.0, 90.0]);
        assert_eq!(tops.along(Vec3::Y), f64::NEG_INFINITY);
        assert_eq!(Tops::of(&Program::new("t")).along(Vec3::Z), f64::NEG_INFINITY);
    }

    /// By hand: over a hole at Z 0 the tool goes 7 mm back, and half a circle of radius 10 that stands upright rises to Z 10.
    #[test]
    fn holes_count_with_their_heights_and_arcs_with_their_rise() {
        let at = |x: f64| Pose::upright(Vec3::new(x, 0.0, 0.0)).unwrap();
        let cycle = Cycle {
            kind: CycleKind::Drill,
            depth: 20.0,
            clearance: 2.0,
            retract: 7.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        };
        let hole = program([Op::Cycle(Box::new(cycle)), Op::Hole(at(0.0))]);
        assert_eq!(Tops::of(&hole).along(Vec3::Z), 7.0);
        let circle = |normal: Vec3| Circle::new(Vec3::ZERO, normal, 0).unwrap();
        let half =
            |normal: Vec3| Op::Arc(Box::new(ArcTo { end: at(10.0), circle: circle(normal) }));
        let over = program([Op::Rapid(at(-10.0)), half(Vec3::Y)]);
        assert!((Tops::of(&over).along(Vec3::Z) - 10.0).abs() < 1e-9);
        let flat = program([Op::Rapid(at(-10.0)), half(Vec3::Z)]);
        assert_eq!(Tops::of(&flat).along(Vec3::Z), 0.0);
    }
}
