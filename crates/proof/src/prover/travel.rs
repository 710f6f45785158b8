//! Each block of the program in machine space: no axis leaves its travel, at its end and on the way.

use super::*;
use program::Rule;

/// Rotary axes turn at most this much between two positions that are looked at, degrees: 200 mm from the axis of a table
/// the slides leave the chord between two by 0.07 mm.
const SAMPLE: f64 = 3.0;

impl Prover<'_> {
    /// Holds the axes within their travel in a move to `to`, along `block` where it is an arc.
    #[inline]
    pub(super) fn hold_travel(&mut self, to: &ResolvedPose, block: Option<&Arc>) {
        let gauge = self.gauge;
        if gauge.machine.wire.is_some() {
            return;
        }
        self.check_pole(to);
        let slack = gauge.slack(to);
        let from = single(self.standing.here());
        self.standing.at(&to.position.orientation);
        let strayed = self.standing.strayed();
        let angles = self.standing.at(&to.position.orientation);
        if matches!(to.position.orientation, Orientation::Axis(_)) {
            angles.iter().for_each(|degrees| self.report.program.include_rotary(*degrees));
        }
        let mut found = self.travel.broken_at(&gauge, angles, &to.position, slack);
        if let (None, Some(strayed)) = (&found, strayed) {
            found = self.travel.turned_too_far(&gauge, strayed);
        }
        if let (None, Some(arc)) = (&found, block) {
            found = self.travel.broken_on_arc(&gauge, angles, arc, slack);
        }
        let own = matches!(to.position.orientation, Orientation::Rotary { tool_center: false, .. });
        if let (None, Some(from), Some(end), false) = (&found, from, single(angles), own) {
            found = self.broken_on_way(to, from, end, slack);
        }
        if let Some(mut found) = found {
            if let Some(way_out) = self.standing.way_out() {
                found.help = format!("{}; {way_out}", found.help);
            }
            let message = format!("{}{}", SourceLine(self.cursor.line), found.message);
            self.found(Diagnostic { message, ..found }.line(to.line));
        }
    }

    /// Refuses a vector that goes past a pole so near that the control leads it through it, or stops.
    fn check_pole(&mut self, to: &ResolvedPose) {
        let Orientation::Axis(axis) = to.position.orientation else { return };
        if self.standing.has_swivelled() {
            return;
        }
        let Some(near) = self.standing.passes_pole(axis) else { return };
        let message = format!(
            "{}the vector of the tool goes past the pole of the rotary axes at {}°: within 2° (MD24530) the \
             control leads it through the pole, or stops with alarm 14112 (MD24540)",
            SourceLine(self.cursor.line),
            Number(near)
        );
        let help = "tool axes in the source that go round the pole by more than 2° or through it, or positions of the rotary axes \
                    in place of vectors (`simultaneous = \"tool-center-angles\"` in [orientation] of the machine file)";
        self.found(Diagnostic::error(Rule::PoleWay, message).help(help).line(to.line));
    }

    /// What is wrong between the ends of a move in which the rotary axes turn from one place (degrees of A, B, C) to
    /// another, and the control makes the linear axes follow.
    fn broken_on_way(
        &mut self,
        to: &ResolvedPose,
        from: [f64; 3],
        end: [f64; 3],
        slack: f64,
    ) -> Option<Diagnostic> {
        let turned = (0..3).map(|i| (end[i] - from[i]).abs()).fold(0.0, f64::max);
        if turned <= SAMPLE {
            return None;
        }
        let samples = (turned / SAMPLE).ceil().min(360.0) as u32;
        // Along a vector the tool turns on the great circle, and not the axes evenly as they do to a tilted plane.
        let vector = match to.position.orientation {
            Orientation::Axis(axis) if !self.standing.has_swivelled() => {
                Some((self.gauge.machine.axis_at(from), axis))
            }
            Orientation::Axis(_) | Orientation::Rotary { .. } => None,
        };
        let mut at = Some(from);
        (1..samples).find_map(|i| {
            let part = |i: u32| f64::from(i) / f64::from(samples);
            let degrees = match vector {
                Some((start, axis)) => {
                    let axes = [i - 1, i].map(|i| geom::between(start, axis, part(i)));
                    // Behind a pole in the middle between two solutions nobody knows which.
                    at = self.standing.follow(at?, axes);
                    at?
                }
                None => [0, 1, 2].map(|k| from[k] + (end[k] - from[k]) * part(i)),
            };
            let part = part(i);
            let orientation = Orientation::Rotary { degrees, tool_center: true };
            let point = self.here.place.tip.lerp(to.place.tip, part);
            let on_way = Position { point, orientation };
            self.travel.broken_at(&self.gauge, &[degrees], &on_way, slack)
        })
    }
}

/// Where the rotary axes stand, where only one place is possible.
fn single(angles: &[[f64; 3]]) -> Option<[f64; 3]> {
    match angles {
        [one] => Some(*one),
        _ => None,
    }
}
