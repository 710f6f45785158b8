//! The way from home: where X and Y stand nobody knows, and of Z only that it is at its top.
//!
//! A control that keeps the tool tip counts X, Y and Z on the part. Where a table is tilted, a word of X moves Z of the
//! machine too, and the Z that is kept is that of the part: from home the tool dives. So each block from home is looked
//! at in the machine: whatever X and Y are, it goes at the height of home, or all axes end above all that the source
//! cuts, or Z of the machine alone comes down, along the tool.

use super::*;
use program::Rule;

/// A tool that points down by less than this sine lies level.
const LEVEL: f64 = 1e-4;

/// Sine of the angle over level from which a tool has to be as high along Z, too, as the source ever goes.
const STEEP: f64 = 0.5;

impl Prover<'_> {
    /// What is wrong with a rapid block to `to` from a place that nobody knows.
    pub(super) fn wrong_approach(&mut self, to: &ResolvedPose) -> Option<Diagnostic> {
        let point = to.position.point;
        if !self.raised {
            return self.wrong_way_on(to);
        }
        if self.turns_on_the_way(to) {
            // At home they turn where no linear axis has to follow.
            let alone =
                matches!(to.position.orientation, Orientation::Rotary { tool_center: false, .. });
            let what = "comes from home while rotary axes turn: turn them first, at home";
            return (!alone || !point.z.is_nan()).then(|| self.way_refused(to, what));
        }
        if point.x.is_nan() && point.y.is_nan() && point.z.is_nan() {
            return None;
        }
        let ups = self.ups(to);
        let is_level = self.is_level(to, &ups);
        if point.z.is_nan() {
            return self.wrong_crossing(to, &ups, is_level);
        }
        if ups.is_empty() || !to.place.known() && !is_level {
            let what = "comes from home, and where the machine then stands is not known";
            return Some(self.way_refused(to, what));
        }
        if let Some(found) = self.low_home(to) {
            return Some(found);
        }
        if self.comes_straight_down(to, &ups) {
            return None;
        }
        let short = self.short_of_all(to, &ups);
        if short <= self.rounding(to) {
            return None;
        }
        let what = format!(
            "comes from home while other axes are still on their way, {}",
            self.too_low(short)
        );
        Some(self.way_refused(to, &what))
    }

    /// What is wrong with the way of a cycle to its R plane: it goes across as its coordinates count, at the height where the
    /// tool is, and then along the tool axis.
    pub(super) fn wrong_cycle(&mut self, r_plane: &ResolvedPose) -> Option<Diagnostic> {
        let here = self.here;
        if here.place.known() {
            let height = r_plane.place.above(here.place.tip).0;
            let over = ResolvedPose { place: r_plane.place.lifted(height), ..*r_plane };
            let across = self.wrong_dog_leg(&here, &over);
            return across.or_else(|| self.wrong_dog_leg(&over, r_plane));
        }
        if !self.raised {
            return None;
        }
        let ups = self.ups(r_plane);
        match is_along(&self.gauge, &ups, r_plane.place.axis) {
            true => self.low_home(r_plane),
            false => self.wrong_approach(r_plane),
        }
    }

    /// Z of the machine goes home from where the tool stands: straight up, which a tilted tool may do only where it is
    /// beyond all cuts along its own axis until it is above them.
    pub(super) fn leaves_for_home(&mut self, line: u32) {
        let Some(at) = self.down.take() else { return };
        let machine = self.gauge.machine;
        if machine.rotary.iter().all(|axis| axis.on == Mount::Table) {
            return;
        }
        let ups = self.ups(&at);
        if is_along(&self.gauge, &ups, at.place.axis) {
            return;
        }
        let is_above = self.short_of_all(&at, &ups) <= self.rounding(&at);
        if is_above && !ups.is_empty() {
            return;
        }
        let short = if ups.is_empty() { f64::INFINITY } else { self.short_aside(&at, &ups) };
        if short <= self.gauge.slack(&at) {
            return;
        }
        let message = format!(
            "{}the program sends Z home from {} with a tilted tool, {}",
            SourceLine(self.cursor.line),
            at.place,
            self.too_low(short)
        );
        let help = "go out along the tool axis first";
        self.found(Diagnostic::error(Rule::RapidPath, message).help(help).line(line));
    }

    /// What is wrong with a rapid from a place that nobody knows while Z has not been home since the last move.
    fn wrong_way_on(&mut self, to: &ResolvedPose) -> Option<Diagnostic> {
        // Where a program begins without home, whoever starts it has brought the tool to a safe place.
        if !self.has_stood || !to.place.known() {
            return None;
        }
        let ups = self.ups(to);
        if self.comes_straight_down(to, &ups) {
            return None;
        }
        if self.short_of_free(&to.place) <= self.gauge.slack(to) {
            return None;
        }
        let what =
            "goes on from a place that nobody knows, where Z has not been home since the last move";
        Some(self.way_refused(to, what))
    }

    /// A rapid across a tilted plane, to the line along the tool axis through `position`, at a height that nobody knows.
    pub(super) fn across(&mut self, line: u32, position: &Position) -> Outcome {
        let to = self.gauge.resolve(line, *position);
        let ups = self.ups(&to);
        let is_level = is_along(&self.gauge, &ups, to.place.axis);
        let wrong = if self.here.place.known() || self.gauge.machine.wire.is_some() {
            None
        } else {
            self.wrong_crossing(&to, &ups, is_level)
        };
        self.motion(line, MotionKind::Rapid, &Position { point: Vec3::NAN, ..*position }, None)?;
        if let Some(found) = wrong {
            self.found(found);
        }
        self.over = Some(to.place);
        Ok(())
    }

    /// Whether a rapid from home has come to a place above all that the source cuts, with the tool as its end has it: the
    /// way begins there.
    pub(super) fn begins_above(&mut self, to: &ResolvedPose) -> bool {
        let Step::Move(goal) = &self.cursor.step else { return false };
        let free = goal.free(self.gauge.allowed.axis_degrees);
        let as_at_end = goal.to.apart(&to.place).1 <= self.gauge.allowed.axis_degrees;
        if !self.raised || !to.place.known() || !as_at_end {
            return false;
        }
        let ups = self.ups(to);
        let is_above = self.short_of_all(to, &ups) <= self.gauge.slack(to);
        let start = self.progress.start.unwrap_or(self.here);
        let begins = is_above
            && !ups.is_empty()
            && stops::explain(&self.gauge, &start, &self.progress.stops, to, free).is_ok();
        if begins {
            self.progress.start = Some(*to);
            self.progress.stops.clear();
        }
        begins
    }

    /// What is wrong with a block that moves X and Y from home and not Z, as its coordinates count.
    fn wrong_crossing(
        &mut self,
        to: &ResolvedPose,
        ups: &[Vec3],
        is_level: bool,
    ) -> Option<Diagnostic> {
        if !is_level {
            let what = "moves X and Y from home, and Z of the machine with them: the Z that stays is that of the part, \
                        which does not lie level";
            return Some(self.way_refused(to, what));
        }
        if ups.is_empty() { None } else { self.low_home(to) }
    }

    /// Whether this block turns the tool or the table.
    fn turns_on_the_way(&self, to: &ResolvedPose) -> bool {
        match (&self.here.position.orientation, &to.position.orientation) {
            (Orientation::Rotary { .. }, Orientation::Rotary { .. }) => {
                let turning = self.turning(&to.position.orientation);
                self.gauge.machine.rotary.iter().any(|axis| turning[axis.index()])
            }
            // `Swivel` has turned them.
            _ if self.standing.has_swivelled() => false,
            _ => {
                let (_, degrees) = self.here.place.apart(&to.place);
                degrees.is_nan() || degrees > self.gauge.allowed.axis_degrees
            }
        }
    }

    /// Where +Z of the machine points on the part, in all ways that the machine may stand at `to`; none where nobody knows.
    pub(super) fn ups(&mut self, to: &ResolvedPose) -> Vec<Vec3> {
        let machine = self.gauge.machine;
        if machine.rotary.iter().all(|axis| axis.on == Mount::Head) {
            return vec![Vec3::Z];
        }
        let stances = self.standing.at(&to.position.orientation).iter();
        stances.map(|degrees| machine.up_at(*degrees)).filter(|up| up.is_finite()).collect()
    }

    /// Whether the Z of a block is that of the machine.
    fn is_level(&self, to: &ResolvedPose, ups: &[Vec3]) -> bool {
        match to.position.orientation {
            Orientation::Rotary { tool_center: false, .. } => true,
            Orientation::Rotary { .. } | Orientation::Axis(_) => {
                is_along(&self.gauge, ups, Vec3::Z)
            }
        }
    }

    /// By how much the tool at `to` is too low to leave the way of the source, along Z of the machine in all ways that it may stand, mm.
    fn short_of_all(&mut self, to: &ResolvedPose, ups: &[Vec3]) -> f64 {
        let short = |up: &Vec3| self.short_below(to, *up);
        let along = ups.iter().map(short).fold(f64::NEG_INFINITY, f64::max);
        along.max(self.short_of_top(&to.place))
    }

    /// By how much a steep tool is lower than the source ever goes along Z, mm: the places that are as high along the tool as the highest
    /// lie on a slope, which reaches into a pocket far from there.
    fn short_of_top(&mut self, place: &PartialPose) -> f64 {
        // Rounding of the words: a tool of just this angle is none that stands.
        if place.axis.z >= STEEP + 1e-4 && place.known() {
            self.top_along(Vec3::Z) - place.tip.z
        } else {
            f64::NEG_INFINITY
        }
    }

    /// By how much the tool is too low to leave the way of the source there, mm.
    pub(super) fn short_of_free(&mut self, place: &PartialPose) -> f64 {
        let along = self.free_from(place.axis) - place.tip.dot(place.axis);
        along.max(self.short_of_top(place))
    }

    /// By how much the tool at `to` is too low along `up` to leave the way of the source, with its length where it hangs from its tip, mm.
    pub(super) fn short_below(&mut self, to: &ResolvedPose, up: Vec3) -> f64 {
        let point = Vec3::select(to.position.point.is_nan_mask(), Vec3::ZERO, to.position.point);
        let place = self.gauge.resolve(to.line, Position { point, ..to.position }).place;
        self.needed(up, place.axis) - place.tip.dot(up)
    }

    /// How far the tip may be from where it should be at `to`, of which a coordinate may be unknown, mm.
    fn rounding(&self, to: &ResolvedPose) -> f64 {
        let slack = self.gauge.slack(to);
        if slack.is_nan() { self.gauge.machine.resolution() } else { slack }
    }

    /// How high along `up` a tip has to be, so that the tool along `axis` may leave the way of the source, mm.
    fn needed(&mut self, up: Vec3, axis: Vec3) -> f64 {
        self.free_from(up) + self.hanging(up, axis)
    }

    /// How far the tool along `axis` hangs below its tip, along `up`, mm.
    fn hanging(&self, up: Vec3, axis: Vec3) -> f64 {
        let hangs = (-axis.dot(up)).max(0.0);
        if hangs > LEVEL { hangs * self.gauge.tool_length.unwrap_or(f64::INFINITY) } else { 0.0 }
    }

    /// Whether Z of the machine alone comes down, with the tool along it, or beyond all cuts along its own axis until it
    /// is above them, and so far out.
    fn comes_straight_down(&mut self, to: &ResolvedPose, ups: &[Vec3]) -> bool {
        if !self.moves_z_alone(to, ups) {
            return false;
        }
        is_along(&self.gauge, ups, to.place.axis)
            || self.short_aside(to, ups) <= self.gauge.slack(to)
    }

    /// By how much the tool is not far enough out along its own axis to leave the way of the source, on the way along Z of the machine
    /// between `to` and where it is above all cuts, mm.
    fn short_aside(&mut self, to: &ResolvedPose, ups: &[Vec3]) -> f64 {
        let axis = to.place.axis;
        let short = self.short_of_free(&to.place);
        let more = |up: &Vec3| (-axis.dot(*up)).max(0.0) * self.short_below(to, *up).max(0.0);
        short + ups.iter().map(more).fold(0.0, f64::max)
    }

    /// Whether X and Y of the machine stand at `to` as they stand here.
    fn moves_z_alone(&self, to: &ResolvedPose, ups: &[Vec3]) -> bool {
        let slack = self.gauge.slack(to);
        if let Some(over) = self.over {
            return over.apart(&to.place).1 <= self.gauge.allowed.axis_degrees
                && over.above(to.place.tip).1 <= slack
                && is_along(&self.gauge, ups, over.axis);
        }
        let (a, b) = (self.here.position, to.position);
        let alike = match (a.orientation, b.orientation) {
            (
                Orientation::Rotary { tool_center: before, .. },
                Orientation::Rotary { tool_center, .. },
            ) => before == tool_center,
            (a, b) => a == b,
        };
        if alike {
            return self.is_level(to, ups)
                && (a.point.x - b.point.x).abs() <= SAME
                && (a.point.y - b.point.y).abs() <= SAME;
        }
        let across = |pose: &ResolvedPose| {
            let Orientation::Rotary { degrees, .. } = pose.position.orientation else {
                return None;
            };
            let pose = self.gauge.machine_pose(&pose.position, degrees).ok()?;
            Some(pose.linear.truncate()).filter(|axes| axes.is_finite())
        };
        matches!((across(&self.here), across(to)), (Some(a), Some(b)) if a.distance(b) <= slack)
    }

    /// Home where it is known to be lower than the tool has to be: the table has swung the part up to it.
    fn low_home(&mut self, to: &ResolvedPose) -> Option<Diagnostic> {
        let Gauge { machine, tool_length, .. } = self.gauge;
        let home = machine.safe_height.unwrap_or(machine.linear[2].max);
        let (Some(zero), Some(length)) = (machine.work_zero, tool_length) else { return None };
        if !home.is_finite() {
            return None;
        }
        let stances = self.standing.at(&to.position.orientation).to_vec();
        let low = |degrees: [f64; 3]| {
            if machine.unsaid(degrees, tool_length).is_some() {
                return f64::NEG_INFINITY;
            }
            let linear = Vec3::new(0.0, 0.0, home - length - zero.z);
            let (tip, axis) = machine.forward(linear, degrees, length);
            let up = machine.up_at(degrees);
            self.beyond_cuts(up) + self.hanging(up, axis) - tip.dot(up)
        };
        let short = stances.into_iter().map(low).fold(f64::NEG_INFINITY, f64::max);
        if short.is_nan() || short <= machine.resolution() {
            return None;
        }
        let message = format!(
            "{}with Z home the tool is {} mm short of {} mm above all that the source cuts, as the table \
             and the head stand",
            SourceLine(self.cursor.line),
            Number(short),
            Number(machine.capabilities.rapid_clearance)
        );
        let help = "a shorter tool, a part that lies lower or nearer to the rotary axes, or another `safe_height` and \
                    `work_zero` in the machine file";
        Some(Diagnostic::error(Rule::HomeHeight, message).help(help).line(to.line))
    }
}

/// Whether each of `ups` is `axis`; not where there is none.
fn is_along(gauge: &Gauge, ups: &[Vec3], axis: Vec3) -> bool {
    let along =
        |up: &Vec3| geom::angle_between(*up, axis).to_degrees() <= gauge.allowed.axis_degrees;
    !ups.is_empty() && ups.iter().all(along)
}
