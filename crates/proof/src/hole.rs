//! A hole of the source against a canned cycle of the program, or against the moves that make it.
//!
//! Heights are mm above the point of the source's hole along its axis; a depth is a negative height.

use crate::gauge::Gauge;
use crate::line::within;
use crate::resolved_pose::{Number, PartialPose, ResolvedPose};
use crate::state::Difference;
use control::{Orientation, Position};
use geom::Vec3;
use program::{Cycle, CycleKind, Rule, Withdrawal};

/// A hole of the source.
pub(crate) struct Hole<'a> {
    pub gauge: &'a Gauge<'a>,
    /// The point of the hole and its axis.
    pub point: &'a PartialPose,
    pub cycle: &'a Cycle,
}

/// How far a hole is that the program makes by single moves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Run {
    /// Whether the tool stands over the hole; before that it is on its way there.
    pub over: bool,
    /// Height of the deepest point so far; the R plane before the first.
    deepest: f64,
    /// Pecks that are done: drilled and left.
    pecks: u32,
    dwelled: bool,
    /// Whether the tool has left the bottom.
    left: bool,
    /// How far above the last depth a rapid back into the hole ends, mm: the writer's choice, but one
    /// for all holes.
    reentry: Option<f64>,
    /// How far the tool draws back to break the chip, mm: likewise.
    chip_break: Option<f64>,
}

/// A gap larger than this, mm, is not one any more: the feed would cut air, or the rapid is misplaced.
const LARGEST_GAP: f64 = 2.0;

/// A rest of a peck below this, mm, is rounding.
const REST: f64 = 1e-3;

impl Hole<'_> {
    /// Whether `pose` stands over the hole, at the R plane or higher.
    pub fn is_over(&self, pose: &ResolvedPose) -> bool {
        let aligned = pose.place.apart(self.point).1 <= self.gauge.allowed.axis_degrees;
        let height = self.gauge.height_over(self.point, pose);
        aligned && height.is_some_and(|h| h >= self.cycle.clearance - self.gauge.slack(pose))
    }

    /// Whether a move goes down next to the hole, with the tool along its axis. What is not known is not.
    pub fn off_axis_and_down(&self, from: &ResolvedPose, to: &ResolvedPose) -> bool {
        let aligned =
            |pose: &ResolvedPose| pose.place.apart(self.point).1 <= self.gauge.allowed.axis_degrees;
        let ((high, _), (low, _)) =
            (self.point.above(from.place.tip), self.point.above(to.place.tip));
        // Both ends are rounded, each for itself.
        let slack = self.gauge.slack(from) + self.gauge.slack(to);
        let aside = |pose: &ResolvedPose| self.point.above(pose.place.tip).1 > slack;
        aligned(from) && aligned(to) && high - low > slack && (aside(from) || aside(to))
    }

    /// How far a pose in the hole is off, mm and degrees: from its axis, and where it is at the depth of a peck, from that too.
    pub fn off(&self, run: &Run, pose: &ResolvedPose) -> (f64, f64) {
        let (height, aside) = self.point.above(pose.place.tip);
        let deep = height + self.depth_of_peck(run.pecks);
        let is_deep = deep.abs() <= self.gauge.slack(pose);
        let tip = if is_deep { aside.hypot(deep) } else { aside };
        (tip, pose.place.apart(self.point).1)
    }

    /// The height of a pose on the axis of the hole.
    fn height(&self, pose: &ResolvedPose) -> Result<f64, String> {
        let angle = pose.place.apart(self.point).1;
        within("tilts the tool in the hole", angle, self.gauge.allowed.axis_degrees, "°")?;
        let (height, aside) = self.point.above(pose.place.tip);
        within("leaves the axis of the hole", aside, self.gauge.slack(pose), "mm")?;
        Ok(height)
    }

    /// Depth below the point at which peck `done` + 1 ends, mm: the first counts from the point.
    fn depth_of_peck(&self, done: u32) -> f64 {
        let cycle = self.cycle;
        if !matches!(cycle.kind, CycleKind::Deep | CycleKind::BreakChip) {
            return cycle.depth;
        }
        let further = cycle.peck.or(cycle.first_peck).unwrap_or(cycle.depth);
        let depth = cycle.first_peck.unwrap_or(further) + f64::from(done) * further;
        if depth < cycle.depth - REST { depth } else { cycle.depth }
    }
}

/// What a cycle does: one whose first peck reaches the bottom drills in one go.
fn kind_in_effect(cycle: &Cycle) -> CycleKind {
    let first = cycle.first_peck.or(cycle.peck);
    let pecks = matches!(cycle.kind, CycleKind::Deep | CycleKind::BreakChip);
    match pecks && first.is_some_and(|first| first >= cycle.depth - REST) {
        true => CycleKind::Drill,
        false => cycle.kind,
    }
}

impl Run {
    /// Forgets the last hole, but not the writer's choices; the next is one of `cycle`.
    pub fn restart(&mut self, cycle: &Cycle) {
        let (reentry, chip_break) = (self.reentry, self.chip_break);
        *self = Run { deepest: cycle.clearance, reentry, chip_break, ..Run::default() };
    }

    /// A canned cycle has made the hole of `cycle`, and the tool stands at its R plane.
    pub fn drilled(&mut self, cycle: &Cycle) {
        (self.over, self.dwelled) = (true, true);
        (self.deepest, self.pecks) = (-cycle.depth, u32::MAX);
    }

    /// Whether the tool is in the hole.
    pub fn begun(&self, cycle: &Cycle) -> bool {
        self.over && self.deepest < cycle.clearance
    }

    /// A rapid over or in the hole. True where the hole is done.
    ///
    /// # Errors
    /// How the move is not one of this hole.
    pub fn rapid(
        &mut self,
        hole: &Hole,
        here: &ResolvedPose,
        to: &ResolvedPose,
        spindle_stopped: bool,
    ) -> Result<bool, String> {
        let (from, height) = (hole.height(here)?, hole.height(to)?);
        let (cycle, slack) = (hole.cycle, hole.gauge.slack(to));
        if height < from {
            return self.back_in(hole, height, slack).map(|()| false);
        }
        if !self.begun(cycle) {
            return Ok(false);
        }
        if !self.at_bottom(hole, slack) {
            return self.leave_peck(hole, height, slack).map(|()| false);
        }
        self.leave_bottom(cycle)?;
        self.left = true;
        if from < cycle.clearance - slack {
            if cycle.kind == CycleKind::Ream {
                return Err("leaves the hole by rapid, but should feed out".into());
            }
            if (cycle.kind == CycleKind::Bore) != spindle_stopped {
                let should = if spindle_stopped { "turning" } else { "stopped" };
                return Err(format!("leaves the hole, but not with the spindle {should}"));
            }
        }
        within("goes above the retract level", height - cycle.retract, slack, "mm")?;
        Ok((height - cycle.retract).abs() <= slack)
    }

    /// A feed move over or in the hole. True where the hole is done.
    ///
    /// # Errors
    /// How the move is not one of this hole.
    pub fn feed(
        &mut self,
        hole: &Hole,
        here: &ResolvedPose,
        to: &ResolvedPose,
    ) -> Result<bool, String> {
        let (from, height) = (hole.height(here)?, hole.height(to)?);
        let (cycle, slack) = (hole.cycle, hole.gauge.slack(to));
        if matches!(cycle.kind, CycleKind::Tap { .. }) {
            return Err("taps by single moves; the control has to couple feed and spindle".into());
        }
        if height < from {
            within("feeds from above the R plane", from - cycle.clearance, slack, "mm")?;
            within("feeds above the last depth", from - self.deepest, LARGEST_GAP, "mm")?;
            let floor = -hole.depth_of_peck(self.pecks);
            within("feeds deeper than one peck", floor - height, slack, "mm")?;
            self.deepest = self.deepest.min(height);
            return Ok(false);
        }
        if cycle.kind != CycleKind::Ream || !self.at_bottom(hole, slack) {
            return Err("feeds upwards".into());
        }
        self.leave_bottom(cycle)?;
        within("feeds above the R plane", height - cycle.clearance, slack, "mm")?;
        Ok((height - cycle.retract).abs() <= slack)
    }

    /// A dwell of `seconds` while the tool stands at `here`: whether it is that of the cycle.
    pub fn dwell(&mut self, hole: &Hole, here: &ResolvedPose, seconds: f64) -> bool {
        let (cycle, slack) = (hole.cycle, hole.gauge.slack(here));
        let height = hole.height(here).unwrap_or(f64::INFINITY);
        let right = !self.dwelled
            && self.begun(cycle)
            && self.at_bottom(hole, slack)
            && height <= self.deepest + slack
            && (seconds - cycle.dwell).abs() <= hole.gauge.allowed.dwell_s;
        self.dwelled |= right;
        right
    }

    /// Whether the last peck has reached the bottom: one before it may end within rounding of it.
    fn at_bottom(&self, hole: &Hole, slack: f64) -> bool {
        let last = hole.depth_of_peck(self.pecks) == hole.cycle.depth;
        last && self.deepest <= slack - hole.cycle.depth
    }

    /// A rapid down: to the R plane, or back to a little above the last depth.
    fn back_in(&mut self, hole: &Hole, height: f64, slack: f64) -> Result<(), String> {
        let cycle = hole.cycle;
        if !self.begun(cycle) {
            return within(
                "goes by rapid below the R plane",
                cycle.clearance - height,
                slack,
                "mm",
            );
        }
        if self.left || height <= self.deepest + slack {
            return Err("goes by rapid to the bottom of the hole".into());
        }
        gap("ends above the last depth", &mut self.reentry, height - self.deepest, slack)
    }

    /// A rapid up before the bottom is reached: the end of a peck.
    fn leave_peck(&mut self, hole: &Hole, height: f64, slack: f64) -> Result<(), String> {
        let short = (self.deepest + hole.depth_of_peck(self.pecks)).abs();
        within("ends a peck off its depth", short, slack, "mm")?;
        self.pecks += 1;
        let below = hole.cycle.clearance - height;
        match hole.cycle.kind {
            CycleKind::Deep => within("clears the chips off the R plane", below.abs(), slack, "mm"),
            CycleKind::BreakChip if below > slack => {
                gap("breaks the chip", &mut self.chip_break, height - self.deepest, slack)
            }
            CycleKind::BreakChip => {
                within("breaks the chip above the R plane", -below, slack, "mm")
            }
            CycleKind::Drill
            | CycleKind::Tap { .. }
            | CycleKind::Ream
            | CycleKind::Bore
            | CycleKind::FineBore(_)
            | CycleKind::BackBore { .. } => Err("leaves the hole before its bottom".into()),
        }
    }

    fn leave_bottom(&self, cycle: &Cycle) -> Result<(), String> {
        match cycle.dwell > 0.0 && !self.dwelled {
            true => Err("leaves the bottom of the hole without the dwell".into()),
            false => Ok(()),
        }
    }
}

/// Holds a gap against the one that the writer chose first.
fn gap(what: &str, chosen: &mut Option<f64>, gap: f64, slack: f64) -> Result<(), String> {
    within(what, gap, LARGEST_GAP, "mm")?;
    let usual = *chosen.get_or_insert(gap);
    match (gap - usual).abs() <= 2.0 * slack {
        true => Ok(()),
        false => Err(format!("{what} by {} mm, elsewhere by {} mm", Number(gap), Number(usual))),
    }
}

/// A hole of a canned cycle, as the program has it.
pub(crate) struct Drilled {
    /// The bottom, the R plane and the end of the retraction: where the tool is there.
    pub bottom: ResolvedPose,
    pub r_plane: ResolvedPose,
    pub retracted: ResolvedPose,
    /// Where the control clears chips, where its setting says that this is above the R plane.
    pub cleared: Option<ResolvedPose>,
    /// By how much the tool goes aside, in the work frame, mm.
    aside: Option<Vec3>,
    pub cycle: Cycle,
}

impl Drilled {
    /// Which way the heights of a cycle count at `pose`, in the frame of its coordinates.
    pub fn along(gauge: &Gauge, pose: &Position) -> Vec3 {
        match pose.orientation {
            Orientation::Axis(axis) => axis,
            Orientation::Rotary { degrees, tool_center: true } => gauge.machine.axis_at(degrees),
            Orientation::Rotary { .. } => Vec3::Z,
        }
    }

    /// The hole at `pose` on `line` of the program. The heights of a cycle count along Z of the
    /// block's coordinates, which in the work frame is the tool axis.
    pub fn new(gauge: &Gauge, line: u32, pose: &Position, cycle: Cycle) -> Drilled {
        let along = Drilled::along(gauge, pose);
        let moved = |by: Vec3| gauge.resolve(line, Position { point: pose.point + by, ..*pose });
        let at = |height: f64| moved(along * height);
        let tip = |by: Vec3| moved(by).place.tip;
        let above =
            gauge.machine.settings.retract_above_r.filter(|_| cycle.kind == CycleKind::Deep);
        Drilled {
            bottom: at(-cycle.depth),
            r_plane: at(cycle.clearance),
            retracted: at(cycle.retract),
            cleared: above.map(|above| at(cycle.clearance + above)),
            aside: cycle.kind.withdrawal().map(|way| tip(way.aside) - tip(Vec3::ZERO)),
            cycle,
        }
    }

    /// Holds the places of the hole against those of the source; where it ends only where it `ends` there. How far they are apart at
    /// the most: tip, mm, and axis, degrees.
    ///
    /// # Errors
    /// Which of them is elsewhere.
    pub fn place(&self, hole: &Hole, ends: bool) -> Result<(f64, f64), String> {
        let (cycle, mut most) = (hole.cycle, (0.0_f64, 0.0_f64));
        for (what, reached, height) in [
            ("bottom of the hole", &self.bottom, -cycle.depth),
            ("R plane", &self.r_plane, cycle.clearance),
            ("retract level", &self.retracted, cycle.retract),
        ] {
            let should = hole.point.lifted(height);
            let counts = ends || height != cycle.retract;
            if !counts {
                continue;
            }
            if !hole.gauge.at(reached, &should) {
                let apart = Number(reached.place.tip.distance(should.tip));
                let (is, should): (&PartialPose, _) = (&reached.place, should);
                return Err(format!("has the {what} at {is}, but should at {should}: {apart} mm"));
            }
            let (tip, axis) = reached.place.apart(&should);
            most = (most.0.max(tip), most.1.max(axis));
        }
        Ok(most)
    }

    /// Holds what the tool does in the hole against the source.
    pub fn kind(&self, hole: &Hole) -> Vec<Difference> {
        let cycle = hole.cycle;
        let mut found = Vec::new();
        let kinds = match cycle.kind == self.cycle.kind {
            true => (cycle.kind, self.cycle.kind),
            false => (kind_in_effect(cycle), kind_in_effect(&self.cycle)),
        };
        let same = match kinds {
            (CycleKind::Tap { pitch: a, left: l }, CycleKind::Tap { pitch: b, left: m }) => {
                l == m && (a - b).abs() <= PITCH
            }
            (should, is) => match (should.withdrawal(), self.aside) {
                (Some(way), Some(aside)) => {
                    let slack = 2.0 * hole.gauge.slack(&self.bottom);
                    way.aside.distance(aside) <= slack && should == is.with_aside(way.aside)
                }
                _ => should == is,
            },
        };
        if !same {
            let message =
                format!("the cycle is {}, but should be {}", name(kinds.1), name(kinds.0));
            found.push((Rule::Cycle, message));
        }
        let dwell = (self.cycle.dwell - cycle.dwell).abs();
        if dwell.is_nan() || dwell > hole.gauge.allowed.dwell_s {
            let (is, should) = (Number(self.cycle.dwell), Number(cycle.dwell));
            found.push((Rule::Dwell, format!("the cycle dwells {is} s, but should {should} s")));
        }
        if matches!(kinds.0, CycleKind::Deep | CycleKind::BreakChip)
            && same
            && let Err(message) = self.pecks(hole)
        {
            found.push((Rule::Peck, message));
        }
        found
    }

    /// Holds the pecks against the source: never deeper than it says, and each a depth that it names.
    /// A control with one peck for all may take either; where its first counts from its R plane, the
    /// clearance may be in it.
    fn pecks(&self, hole: &Hole) -> Result<(), String> {
        let cycle = hole.cycle;
        let slack = hole.gauge.slack(&self.bottom);
        let further = cycle.peck.or(cycle.first_peck).unwrap_or(cycle.depth).min(cycle.depth);
        let first = cycle.first_peck.unwrap_or(further).min(cycle.depth);
        let own = self.cycle.peck.or(self.cycle.first_peck).ok_or("the cycle does not peck")?;
        let own_first = self.cycle.first_peck.unwrap_or(own);
        let point = hole.point.above(self.bottom.place.tip).0 + self.cycle.depth;
        let own_depth = own_first - point;
        within("the first peck is too deep", own_depth - first, slack, "mm")?;
        let many = own_depth < cycle.depth - REST;
        if many {
            within("a peck is too deep", own - further, slack, "mm")?;
        }
        let named = |peck: f64| {
            let from_r = first + cycle.clearance;
            [first, further, from_r].iter().any(|wanted| (peck - wanted).abs() <= slack)
        };
        let as_said = (own_depth - first).abs() <= slack || named(own_first);
        match as_said && (!many || named(own)) {
            true => Ok(()),
            false => Err(format!(
                "the cycle pecks {} mm, then {} mm, but should {} mm, then {} mm",
                Number(own_first),
                Number(own),
                Number(first),
                Number(further)
            )),
        }
    }
}

/// Half a step of a pitch of three decimals, mm.
pub(crate) const PITCH: f64 = 5.1e-4;

fn name(kind: CycleKind) -> String {
    match kind {
        CycleKind::Drill => "drilling".into(),
        CycleKind::Deep => "deep drilling".into(),
        CycleKind::BreakChip => "drilling with chip break".into(),
        CycleKind::Tap { pitch, left } => {
            format!(
                "tapping a {} thread of {} mm",
                if left { "left" } else { "right" },
                Number(pitch)
            )
        }
        CycleKind::Ream => "reaming".into(),
        CycleKind::Bore => "boring".into(),
        CycleKind::FineBore(way) => format!("boring {}", withdrawn(&way)),
        CycleKind::BackBore { withdrawal, .. } => format!("back boring {}", withdrawn(&withdrawal)),
    }
}

/// How a boring bar leaves the wall, with the spindle's position where it is not the machine's own.
fn withdrawn(way: &Withdrawal) -> String {
    let [x, y, z] = way.aside.to_array().map(Number);
    let angle = way.angle.map_or(String::new(), |angle| format!(" at {}°", Number(angle)));
    format!("aside by X{x} Y{y} Z{z}{angle}")
}
