//! The proof of a wire's program: against the contour with its arcs where the wire is upright;
//! where it leans against its points, and each end of the wire against its own contour besides.

use super::report::Cut;
use crate::watch::{Followed, Watch};
use control::{Action, Position, Setup};
use geom::Vec3;
use machine::Machine;
use program::{Diagnostic, Feed, NoPose, Program};
use proof::{MachineState, Motion, MotionKind, Observer, Prover, Report, Tolerances};
use wire::segment::{End, Segment};

/// Runs `text` on the control of `machine` and compares it with what `cut` wants, for whoever watches.
///
/// # Errors
/// A contour with a point that is not finite.
pub fn of(
    cut: &Cut,
    machine: &Machine,
    name: &str,
    file: &str,
    text: &[u8],
    tolerances: &Tolerances,
    watch: &dyn Watch,
) -> Result<Report, NoPose> {
    let program = cut.source(name)?;
    let follower = watch.followed(file, &program, machine);
    // Nobody else needs them: for them the program is made once more.
    let feeds = match follower.wants_motions() {
        true => cut.feeds_aside(name)?,
        false => Vec::new(),
    };
    let follower = &mut Timed { follower, feeds };
    let mut report = proof::prove_for(&program, machine, file, text, tolerances, follower);
    let leans = cut.segments.iter().any(Segment::leans);
    for end in [End::Lower, End::Upper] {
        if leans && report.proven {
            let contour = cut.end(name, end)?;
            let found = one_end(&contour, (end, cut.height()), machine, file, text, tolerances);
            report.proven = found.proven;
            report.mismatches.extend(found.mismatches);
            report.first_mismatch = found.first_mismatch;
            report.deviations.path_mm = match end {
                End::Lower => found.deviations.path_mm,
                End::Upper if found.deviations.path_mm.value > report.deviations.path_mm.value => {
                    found.deviations.path_mm
                }
                End::Upper => report.deviations.path_mm,
            };
        }
    }
    Ok(report)
}

/// Whoever follows the proof. Cuts of a program that says no feed take as long as at the one that is set at the machine, as the
/// report counts them.
struct Timed<'a> {
    follower: Followed<'a>,
    /// Of each record, mm/min, where it is known; empty where the program says it, or nobody is told the motions.
    feeds: Vec<Option<f64>>,
}

impl Observer for Timed<'_> {
    fn reached(&mut self, part: f64) -> bool {
        self.follower.reached(part)
    }

    fn wants_motions(&self) -> bool {
        self.follower.wants_motions()
    }

    fn moved(&mut self, motion: &Motion) {
        match self.feeds.get(motion.record).copied().flatten() {
            Some(feed) if motion.kind == MotionKind::Line => {
                let [from, to] = motion.tool.map(|pose| pose.tip);
                let seconds = from.distance(to) / feed * 60.0;
                let feed = Some(Feed::PerMinute(feed));
                self.follower.moved(&Motion { seconds, feed, ..motion.clone() });
            }
            _ => self.follower.moved(motion),
        }
    }

    fn stated(&mut self, state: &MachineState) {
        self.follower.stated(state);
    }

    fn mismatched(&mut self, found: &Diagnostic) {
        self.follower.mismatched(found);
    }

    fn ended(&mut self, report: &Report) {
        self.follower.ended(report);
    }
}

/// Compares the path of one end of the wire, the upper one at this height in mm, with the contour that it follows.
fn one_end(
    contour: &Program,
    (end, height): (End, Option<f64>),
    machine: &Machine,
    file: &str,
    text: &[u8],
    tolerances: &Tolerances,
) -> Report {
    // The upper end is X + U, Y + V where the part is as high as the plane of U and V: two words are rounded.
    let plane = machine.wire.and_then(|wire| wire.height);
    let rounded = match (end, height.zip(plane)) {
        (End::Upper, Some((height, plane))) => 1.0 + height / plane,
        (End::Upper, None) => 2.0,
        (End::Lower, _) => 1.0,
    };
    let position = tolerances.position.unwrap_or(rounded * machine.resolution() / 2f64.sqrt());
    let tolerances = Tolerances { position: Some(position), ..*tolerances };
    let mut prover = Prover::new(contour, machine, &tolerances);
    let shift = |position: &mut Position| {
        let lean =
            position.axis().and_then(|axis| machine::lean(axis, height?)).unwrap_or_default();
        let by = match end {
            End::Lower => Vec3::ZERO,
            End::Upper => lean.extend(0.0),
        };
        *position = Position::new(position.point + by, Vec3::Z);
        by
    };
    let run = nc::settings(machine, Setup::default()).and_then(|settings| {
        control::read(&settings, file, text, &mut |mut event| {
            match &mut event.action {
                Action::Rapid(position) | Action::Line(position) => drop(shift(position)),
                Action::Arc(arc) => arc.center += shift(&mut arc.end),
                _ => {}
            }
            prover.event(&event)
        })
    });
    // What the control refuses it has refused before, for the program as a whole.
    drop(run);
    prover.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec2;
    use wire::points::{Step, points};
    use wire::{Element, Path};

    /// A cone of 5 mm below and 10 mm above, as points; `upper` moved by so many mm in one of them.
    fn cone(moved: f64) -> Report {
        let circle = |radius: f64| {
            let start = Vec2::new(radius, 0.0);
            vec![Element::arc(start, start, Vec2::ZERO, std::f64::consts::TAU).from_line(1)]
        };
        let path = Path::by_block(circle(5.0), circle(10.0)).unwrap();
        let mut all = points(&[&path], Step::ChordError(0.01), None).unwrap();
        all[0].upper[9].y += moved;
        let segment = Segment { points: all.pop(), ..Segment::of(path) };
        let text = "extends = \"bp-95d\"\n[wire]\nheight = 30\n";
        let mut machine = machine::load_text("shop.toml", text).unwrap();
        let cut = Cut::of(vec![segment], Some(30.0), &machine);
        machine.capabilities.lowering_tolerance = 0.01;
        let written = post::write(&cut.program("cone").unwrap(), &machine).unwrap().text;
        of(&cut, &machine, "cone", "cone.pts", &written, &Tolerances::default(), &()).unwrap()
    }

    #[test]
    fn an_upper_end_off_its_contour_is_found_though_the_points_are_written_as_they_are() {
        let report = cone(0.0);
        assert!(report.proven, "{:?}", report.mismatches);
        let report = cone(0.05);
        assert!(!report.proven);
        assert_eq!((report.mismatches[0].rule.name(), report.mismatches[0].line), ("path", 10));
    }
}
