//! The walk of the program along the source.

use crate::expected::{Cursor, Goal, Kind, Step};
use crate::gauge::Gauge;
use crate::hole::{Drilled, Hole, Run};
use crate::line::Followed;
use crate::place::{Number, Place, Station};
use crate::report::{Excursion, Report};
use crate::state::{self, Difference, Lengths, Running};
use crate::tolerance::{Applied, Tolerances};
use crate::{arc, line, stops};
use geom::{Arc, Vec3};
use machine::{Machine, Mount};
use program::statistics::Statistics;
use program::{
    ArcTo, Compensation, Diagnostic, Op, Orientation, Pose, Program, Record, Spindle, Tool,
};

/// Compares a program with its source, record by record, as a control runs it.
pub struct Prover<'a> {
    source: &'a Program,
    /// How far the source reaches; counted where it is asked for.
    statistics: Option<Statistics>,
    gauge: Gauge<'a>,
    cursor: Cursor<'a>,
    running: Running,
    /// Compensation of the source as far as moves have switched it.
    compensation: Compensation,
    here: Station,
    leg: Leg,
    report: Report,
    ended: bool,
    lost: bool,
}

/// How far the program is with the source motion at hand.
#[derive(Default)]
struct Leg {
    /// Part of a line or an arc that is done, 0 to 1.
    t: f64,
    /// Where the last motion ended.
    start: Option<Station>,
    /// Where rapids have stopped since then, or since the tool left the path.
    stops: Vec<Station>,
    /// Where an excursion left the path.
    left: Option<Station>,
    /// Whether Z was sent home since.
    homed: bool,
    hole: Run,
}

/// How a block moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Gait {
    Rapid,
    Feed,
}

/// The most stops that a rapid may have: a corner for each of five axes, and lifts.
const MOST_STOPS: usize = 16;

/// What a comparison answers: the mismatch after which the two motions cannot be laid beside each
/// other any more.
type Outcome = Result<(), Box<Diagnostic>>;

impl<'a> Prover<'a> {
    /// Before the first record of a program for `machine`.
    pub fn new(source: &'a Program, machine: &'a Machine, tolerances: &Tolerances) -> Prover<'a> {
        let allowed = Applied::new(machine, tolerances);
        let cursor = Cursor::new(machine, &source.records);
        let gauge = Gauge { machine, allowed, tool_length: cursor.tool_length() };
        let unknown = Pose {
            point: Vec3::NAN,
            orientation: Orientation::Rotary { degrees: [f64::NAN; 3], tool_center: false },
        };
        let mut prover = Prover {
            source,
            statistics: None,
            here: gauge.station(0, unknown),
            gauge,
            cursor,
            running: Running::at_reset(machine),
            compensation: Compensation::Off,
            leg: Leg::default(),
            report: Report { tolerances: allowed, ..Report::default() },
            ended: false,
            lost: false,
        };
        prover.enter();
        prover
    }

    /// The next record of the program.
    ///
    /// # Errors
    /// The mismatch after which nothing can be compared any more; it is in the report too.
    pub fn record(&mut self, record: &Record) -> Outcome {
        if self.lost {
            return Ok(());
        }
        let outcome = self.take(record);
        if let Err(found) = &outcome {
            self.lost = true;
            self.report.mismatch(self.cursor.line, (**found).clone());
        }
        outcome
    }

    /// The report, after the last record.
    pub fn finish(mut self) -> Report {
        if !self.lost {
            self.pass_left_out(|_| false);
            let stop = self.nearest_stop().filter(|_| self.leg.left.is_none());
            match (&self.cursor.step, stop) {
                (Step::End, _) => {}
                (_, Some(stop)) => self.differs(stop.line, ("end-point", self.not_reached(&stop))),
                _ => self.differs(0, ("missing", "the program ends before this".into())),
            }
            if !self.ended {
                self.differs(0, ("no-end", "the program has no end".into()));
            }
        }
        self.report.proven = self.report.mismatches.is_empty();
        self.report
    }

    /// The control refused a block, so the rest is not known. What [`Prover::record`] answered is
    /// in the report already.
    pub(crate) fn refused(&mut self, found: Diagnostic) {
        if !self.lost {
            self.lost = true;
            self.report.mismatch(self.cursor.line, found);
        }
    }

    fn take(&mut self, record: &Record) -> Outcome {
        let line = record.line;
        let passive = matches!(
            record.op,
            Op::Comment(_) | Op::Message(_) | Op::Operation(_) | Op::EndOfOperation | Op::End
        );
        if self.ended && !passive {
            return Err(self.lost_at(line, "after-end", "goes on after the end of the program"));
        }
        match &record.op {
            Op::Rapid(pose) => self.motion(line, Gait::Rapid, pose, None),
            Op::Line(pose) => self.motion(line, Gait::Feed, pose, None),
            Op::Arc(to) => self.motion(line, Gait::Feed, &to.end, Some(to)),
            Op::Hole(pose) => self.drilled(line, pose),
            Op::Home(axes) => self.home(line, *axes),
            Op::Tool(tool) => self.change_tool(line, tool),
            op => {
                match op {
                    Op::Dwell(seconds) if *seconds == 0.0 => {}
                    Op::Dwell(seconds) => self.event(line, Step::Dwell(*seconds)),
                    Op::Stop => self.event(line, Step::Stop),
                    Op::OptionalStop => self.event(line, Step::OptionalStop),
                    op => self.switch(line, op),
                }
                Ok(())
            }
        }
    }

    /// A modal word.
    fn switch(&mut self, line: u32, op: &Op) {
        let running = &mut self.running;
        match op {
            Op::Feed(feed) => running.feed = Some(*feed),
            Op::Spindle(spindle) => (running.spindle, running.spindle_line) = (*spindle, line),
            Op::Coolant(coolant) => (running.coolant, running.coolant_line) = (*coolant, line),
            Op::Compensation(side) => running.compensation = *side,
            Op::LengthOffset(register) => running.length_offset = *register,
            Op::WorkOffset(number) => running.work_offset = Some(*number),
            Op::Cycle(cycle) => running.cycle = Some(**cycle),
            Op::CycleOff => running.cycle = None,
            Op::End => self.ended = true,
            _ => {}
        }
    }

    /// A move to `pose`.
    fn motion(&mut self, line: u32, gait: Gait, pose: &Pose, arc: Option<&ArcTo>) -> Outcome {
        if arc.is_none() && *pose == self.here.pose {
            return Ok(());
        }
        let to = self.gauge.station(line, *pose);
        let block = arc.map(|arc| arc::of_block(&self.gauge, &self.here, arc));
        if block == Some(None) {
            return Err(self.lost_at(line, "arc", "makes no arc"));
        }
        let block = block.flatten();
        self.count(gait, &to, arc, block.as_ref());
        if self.leg.left.is_none() {
            let gauge = self.gauge;
            self.pass_left_out(|goal| {
                let alike = match goal.kind {
                    Kind::Rapid => gait == Gait::Rapid,
                    Kind::Line => gait == Gait::Feed && block.is_none(),
                    Kind::Arc(_) => gait == Gait::Feed,
                    Kind::Hole(_) | Kind::Broken(_) => false,
                };
                alike && gauge.at(&to, &goal.to)
            });
        }
        self.miss_events(line);
        let outcome = match &self.cursor.step {
            Step::Move(goal) => match &goal.kind {
                Kind::Rapid => self.rapid(gait, &to),
                Kind::Line | Kind::Arc(_) if gait == Gait::Rapid || self.leg.left.is_some() => {
                    self.excursion(gait, &to)
                }
                Kind::Line | Kind::Arc(_) => self.cut(&to, block.as_ref()),
                Kind::Hole(_) if block.is_some() => {
                    Err(self.lost_at(line, "hole", "makes an arc where the source has a hole"))
                }
                Kind::Hole(_) => self.hole_move(gait, &to),
                Kind::Broken(why) => {
                    let message = format!("has no motion to hold against: {why}");
                    Err(self.lost_at(line, "source", &message))
                }
            },
            _ => self.closing(gait, &to),
        };
        self.here = to;
        outcome
    }

    /// A move while the source goes by rapid.
    fn rapid(&mut self, gait: Gait, to: &Station) -> Outcome {
        if gait == Gait::Feed {
            return Err(match self.nearest_stop() {
                Some(stop) => self.lost_at(stop.line, "end-point", &self.not_reached(&stop)),
                None => self.lost_at(to.line, "rapid-feed", "feeds where the source goes by rapid"),
            });
        }
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        if self.gauge.at(to, &goal.to) {
            let across = goal.from.is_none_or(|from| {
                let way = goal.to.tip - from.tip;
                way.reject_from_normalized(from.axis).length() > self.gauge.slack(to)
            });
            // What is switched off is off from the first straight move on, before the tool comes down.
            let off = self.cursor.wanted.compensation == Compensation::Off;
            self.check_compensation(to.line, across && off, false);
            self.approached(to)?;
            self.arrive(to);
            return Ok(());
        }
        self.stop_at(to)
    }

    /// Keeps a stop of a rapid until its end explains it.
    fn stop_at(&mut self, to: &Station) -> Outcome {
        if to.place.known() {
            let found = state::at_stop(self.gauge.machine, &self.cursor.wanted, &self.running);
            self.check(to.line, found);
        }
        if self.leg.stops.len() >= MOST_STOPS {
            let stop = self.nearest_stop().unwrap_or(*to);
            return Err(self.lost_at(stop.line, "end-point", &self.not_reached(&stop)));
        }
        self.leg.stops.push(*to);
        Ok(())
    }

    /// Explains the stops of a rapid that has come to its end.
    fn approached(&mut self, to: &Station) -> Outcome {
        self.check(to.line, state::set_up(self.gauge.machine, &self.cursor.wanted, &self.running));
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let free = goal.free(self.gauge.allowed.axis_degrees);
        if self.leg.stops.is_empty() {
            return Ok(());
        }
        let start = self.leg.start.unwrap_or(self.here);
        match stops::explain(&self.gauge, &start, &self.leg.stops, to, free) {
            Ok(lift) => {
                if self.leg.homed && !free || lift.left_mm > 0.0 && lift.came_mm > 0.0 {
                    self.note_excursion(to, lift.left_mm);
                }
                Ok(())
            }
            Err(stop) => {
                let message = format!(
                    "stops by rapid at {}, on no way axis by axis to {}",
                    stop.place, to.place
                );
                Err(self.lost_at(stop.line, "rapid-stop", &message))
            }
        }
    }

    /// A move off the path of a cut, or back to it.
    fn excursion(&mut self, gait: Gait, to: &Station) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let Some(left) = self.leg.left else {
            if goal.from.is_none() {
                return self.stop_at(to);
            }
            if self.gauge.at(to, &goal.to) || !stops::lifted(&self.gauge, &self.here, to) {
                let message = "goes by rapid where the source feeds";
                return Err(self.lost_at(to.line, "rapid-feed", message));
            }
            self.leg.left = Some(self.here);
            return self.stop_at(to);
        };
        if gait == Gait::Feed && goal.tool_change && !self.here.place.known() {
            return self.cut_from_nowhere(to, None);
        }
        if self.gauge.at(to, &left.place) {
            let last = self.leg.stops.last().copied().unwrap_or(left);
            if !self.comes_down(&last, to) {
                return Err(self.lost_at(
                    to.line,
                    "excursion",
                    "comes back, but not along the tool axis",
                ));
            }
            let lift =
                stops::explain(&self.gauge, &left, &self.leg.stops, to, true).map_err(|stop| {
                    let message = format!("stops by rapid at {}, away from the path", stop.place);
                    self.lost_at(stop.line, "rapid-stop", &message)
                })?;
            self.note_excursion(to, lift.left_mm);
            self.leg.left = None;
            self.leg.homed = false;
            self.leg.stops.clear();
            return Ok(());
        }
        if gait == Gait::Feed {
            let line = self.leg.stops.first().map_or(to.line, |stop| stop.line);
            let message = "leaves the cut by rapid and does not come back to where it left";
            return Err(self.lost_at(line, "rapid-feed", message));
        }
        self.stop_at(to)
    }

    /// Whether the last move of an excursion goes along the tool axis, towards the part.
    fn comes_down(&self, last: &Station, to: &Station) -> bool {
        if last.place.known() {
            return stops::lifted(&self.gauge, to, last);
        }
        // From home only Z is left to go.
        let (a, b) = (last.pose.point, to.pose.point);
        (a.x - b.x).abs() <= 1e-6
            && (a.y - b.y).abs() <= 1e-6
            && last.pose.orientation == to.pose.orientation
    }

    fn note_excursion(&mut self, to: &Station, lift_mm: f64) {
        let first = self.leg.stops.first().map_or(to.line, |stop| stop.line);
        self.report.excursion(Excursion {
            source_line: self.cursor.line,
            first_program_line: first,
            last_program_line: to.line,
            lift_mm,
        });
    }

    /// A feed move while the source cuts a line or an arc.
    fn cut(&mut self, to: &Station, block: Option<&Arc>) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let here = self.here;
        if !here.place.known() || goal.from.is_none() {
            return self.cut_from_nowhere(to, block);
        }
        let followed = match (&goal.kind, block) {
            (Kind::Arc(arc), Some(block)) => {
                arc::follow(&self.gauge, arc, goal, self.leg.t, block, &here, to)
            }
            (Kind::Arc(arc), None) => {
                arc::follow_chord(&self.gauge, arc, goal, self.leg.t, &here, to)
            }
            (_, Some(_)) => Err("makes an arc where the source has a line".into()),
            (_, None) => line::follow(&self.gauge, goal, self.leg.t, &here, to),
        };
        let Followed { t, path_mm, left_mm } = followed.map_err(|how| {
            let message = format!("goes to {} and {how}; the source goes to {}", to.place, goal.to);
            self.lost_at(to.line, "path", &message)
        })?;
        let length = block.map_or(here.place.tip.distance(to.place.tip), Arc::length);
        let lengths =
            Lengths { source: goal.length(), block: length, rounding: self.gauge.slack(to) };
        let done = self.gauge.at(to, &goal.to) && left_mm <= arc::PAST * lengths.rounding;
        self.leg.t = t;
        self.check_cut(to, &lengths, block.is_some());
        self.report.deviations.path_mm.note(path_mm, self.cursor.line, to.line);
        if done {
            self.arrive(to);
        }
        Ok(())
    }

    /// A feed move from where the tool is not known: only the first motion, or the first after a tool
    /// change, may be one, and it has to go to the end at once.
    fn cut_from_nowhere(&mut self, to: &Station, block: Option<&Arc>) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let first = goal.from.is_none() || goal.tool_change;
        let straight = block.is_none() && self.gauge.at(to, &goal.to);
        let start = self.leg.start.unwrap_or(self.here);
        let explained = stops::explain(&self.gauge, &start, &self.leg.stops, to, true).is_ok();
        if !(first && straight && explained) {
            let message = format!(
                "feeds to {} from a place that is not known; the source goes to {}",
                to.place, goal.to
            );
            return Err(self.lost_at(to.line, "unknown-start", &message));
        }
        let message =
            format!("source line {}: feeds to {} from an unknown place", goal.line, to.place);
        self.report.warn(Diagnostic::warning("unknown-start", message).line(to.line));
        let lengths = Lengths { source: 0.0, block: 0.0, rounding: self.gauge.slack(to) };
        self.check_cut(to, &lengths, false);
        self.arrive(to);
        Ok(())
    }

    /// What must hold in a cut.
    fn check_cut(&mut self, to: &Station, lengths: &Lengths, on_arc: bool) {
        let (allowed, wanted, running) = (&self.gauge.allowed, &self.cursor.wanted, &self.running);
        let found = [
            state::set_up(self.gauge.machine, wanted, running),
            state::spindle_and_coolant(allowed, wanted, running),
            state::feed(allowed, wanted.feed, running.feed, wanted.spindle, lengths),
        ];
        let travel = to.place.tip - self.here.place.tip;
        let across = travel.reject_from_normalized(to.place.axis).length();
        let in_plane = across.is_nan() || across > lengths.rounding;
        for difference in found {
            self.check(to.line, difference);
        }
        self.check_compensation(to.line, in_plane, on_arc);
    }

    /// Compensation goes on with the first straight cut in the plane at the latest, off with the first
    /// straight move there, and neither on an arc, which has to be as the source wants it.
    fn check_compensation(&mut self, line: u32, must: bool, on_arc: bool) {
        let (wanted, is) = (self.cursor.wanted.compensation, self.running.compensation);
        let tool = self.cursor.wanted.tool;
        let switched = state::same_compensation(self.gauge.machine, wanted, is, tool);
        let kept = state::same_compensation(self.gauge.machine, self.compensation, is, tool);
        if switched && (kept || !on_arc) {
            self.compensation = wanted;
        } else if switched {
            self.differs(line, ("compensation", "compensation is switched on an arc".into()));
        } else if !kept || must {
            let (is, should) = (state::compensation(is), state::compensation(wanted));
            let message = format!("compensation is {is}, but should be {should}");
            self.differs(line, ("compensation", message));
        }
    }

    /// A single move while the source drills.
    fn hole_move(&mut self, gait: Gait, to: &Station) -> Outcome {
        let Step::Move(Goal { kind: Kind::Hole(cycle), to: point, .. }) = &self.cursor.step else {
            return Ok(());
        };
        let (gauge, cycle, point) = (self.gauge, *cycle, *point);
        let hole = Hole { gauge: &gauge, point: &point, cycle: &cycle };
        let here = self.here;
        if !self.leg.hole.over {
            if gait == Gait::Rapid && !hole.is_over(to) {
                return self.stop_at(to);
            }
            if gait == Gait::Rapid {
                self.approached(to)?;
                self.comes_from_above(&hole, Some(to))?;
                self.leg.stops.clear();
                self.leg.hole.over = true;
                return Ok(());
            }
            if !hole.is_over(&here) {
                let message = format!("feeds to {}, but the hole is at {point}", to.place);
                return Err(self.lost_at(to.line, "hole", &message));
            }
            self.leg.hole.over = true;
        }
        let stopped = self.running.spindle == Spindle::Off;
        let run = &mut self.leg.hole;
        let done = match gait {
            Gait::Rapid => run.rapid(&hole, &here, to, stopped),
            Gait::Feed => run.feed(&hole, &here, to),
        }
        .map_err(|how| self.lost_at(to.line, "hole", &how))?;
        if gait == Gait::Feed {
            self.check_drilling(to.line, cycle.feed, self.running.feed);
        }
        if done {
            self.arrive(to);
        }
        Ok(())
    }

    /// A hole of a canned cycle.
    fn drilled(&mut self, line: u32, pose: &Pose) -> Outcome {
        let Some(own) = self.running.cycle else {
            return Err(self.lost_at(line, "hole", "drills without a cycle"));
        };
        self.pass_left_out(|_| false);
        self.miss_events(line);
        let Step::Move(Goal { kind: Kind::Hole(cycle), to: point, .. }) = &self.cursor.step else {
            let message = "drills a hole that the source does not have";
            return Err(match self.nearest_stop() {
                Some(stop) => self.lost_at(stop.line, "end-point", &self.not_reached(&stop)),
                None => self.lost_at(line, "hole", message),
            });
        };
        let (gauge, cycle, point) = (self.gauge, *cycle, *point);
        let hole = Hole { gauge: &gauge, point: &point, cycle: &cycle };
        let drilled = Drilled::new(&gauge, line, pose, own);
        if self.leg.hole.begun(&cycle) {
            return Err(self.lost_at(line, "hole", "drills a hole that has been begun by moves"));
        }
        drilled.place(&hole).map_err(|how| self.lost_at(line, "hole", &how))?;
        self.approached(&drilled.r_plane)?;
        // A cycle itself goes across first, then down.
        self.comes_from_above(&hole, None)?;
        for difference in drilled.kind(&hole) {
            self.differs(line, difference);
        }
        self.check_drilling(line, cycle.feed, own.feed.or(self.running.feed));
        let summary = &mut self.report.program;
        summary.cutting_length_mm += own.clearance + own.depth;
        for station in [&drilled.bottom, &drilled.r_plane, &drilled.retracted] {
            summary.include(&station.pose);
        }
        let over = self.here.place.tip.distance(drilled.r_plane.place.tip);
        let out = drilled.bottom.place.tip.distance(drilled.retracted.place.tip);
        summary.rapid_length_mm += if over.is_nan() { out } else { over + out };
        self.here = drilled.retracted;
        self.arrive(&drilled.retracted);
        Ok(())
    }

    /// Whether the way to a hole goes down nowhere but over it: as a canned cycle goes, for what the
    /// tool was drawn back from may stand between the holes.
    fn comes_from_above(&self, hole: &Hole, to: Option<&Station>) -> Outcome {
        let mut last = self.leg.start.unwrap_or(self.here);
        for stop in self.leg.stops.iter().chain(to) {
            if hole.beside_and_down(&last, stop) {
                let message = format!("goes down by rapid to {}, beside the hole", stop.place);
                return Err(self.lost_at(stop.line, "hole", &message));
            }
            last = *stop;
        }
        Ok(())
    }

    /// What must hold while a hole is drilled. A tap's feed is its pitch, which the cycle compares.
    fn check_drilling(
        &mut self,
        line: u32,
        cycle: Option<program::Feed>,
        is: Option<program::Feed>,
    ) {
        let (allowed, wanted, running) = (&self.gauge.allowed, &self.cursor.wanted, &self.running);
        let lengths = Lengths { source: 0.0, block: 0.0, rounding: 1.0 };
        let tapping = matches!(
            &self.cursor.step,
            Step::Move(Goal { kind: Kind::Hole(c), .. })
                if matches!(c.kind, program::CycleKind::Tap { .. })
        );
        let found = [
            state::set_up(self.gauge.machine, wanted, running),
            state::spindle_and_coolant(allowed, wanted, running),
            match tapping {
                true => None,
                false => state::feed(allowed, cycle.or(wanted.feed), is, wanted.spindle, &lengths),
            },
        ];
        for difference in found {
            self.check(line, difference);
        }
        self.check_compensation(line, true, false);
    }

    /// Axes sent to a fixed position.
    fn home(&mut self, line: u32, axes: u8) -> Outcome {
        let axis_degrees = self.gauge.allowed.axis_degrees;
        self.pass_left_out(|goal| goal.free(axis_degrees));
        let (first, free, holding) = match &self.cursor.step {
            Step::Move(goal) => {
                let free = goal.free(axis_degrees) && self.leg.left.is_none();
                (goal.from.is_none(), free, matches!(goal.kind, Kind::Line | Kind::Arc(_)))
            }
            _ => (false, true, false),
        };
        let z = axes & 4 != 0;
        let retracted = self.here.pose.point.z.is_nan() || self.leg.homed;
        if !first && !retracted && !z {
            return Err(self.lost_at(line, "home", "sends axes home before the tool is retracted"));
        }
        let up = axes == 4 && (self.hangs_down() || self.clear_of_part());
        if !first && !free && (!up || self.leg.hole.over) {
            return Err(self.lost_at(line, "home", "sends axes home in the middle of the work"));
        }
        if !first && !retracted && axes != 4 {
            if !self.clear_of_part() {
                let message = "sends axes home together with Z, not after it, beside the part";
                return Err(self.lost_at(line, "home", message));
            }
            let message = "Z goes home together with other axes, not before them";
            self.report.warn(Diagnostic::warning("home", message).line(line));
        }
        if holding && !first && self.leg.left.is_none() {
            self.leg.left = Some(self.here);
        }
        self.leg.homed |= z;
        let mut pose = self.here.pose;
        for (i, bit) in [(0, 1), (1, 2), (2, 4)] {
            if axes & bit != 0 {
                pose.point[i] = f64::NAN;
            }
        }
        match &mut pose.orientation {
            Orientation::Axis(axis) if *axis != Vec3::Z => pose.point = Vec3::NAN,
            Orientation::Axis(_) => {}
            Orientation::Rotary { degrees, .. } => {
                for (i, degrees) in degrees.iter_mut().enumerate() {
                    if axes & (8 << i) != 0 {
                        *degrees = f64::NAN;
                    }
                }
            }
        }
        let to = self.gauge.station(line, pose);
        if self.leg.left.is_some() {
            self.stop_at(&to)?;
        }
        self.here = to;
        Ok(())
    }

    /// Whether the tool is beyond every point of the source along its axis, which does not point
    /// down: then Z home is away from all of them.
    fn clear_of_part(&mut self) -> bool {
        let Place { tip, axis } = self.here.place;
        let statistics = self.statistics.get_or_insert_with(|| Statistics::of(self.source));
        axis.z >= 0.0 && tip.dot(axis) >= statistics.reach(axis)
    }

    /// Whether the tool hangs along Z of the machine, so that Z home is away from the part.
    fn hangs_down(&self) -> bool {
        let machine = self.gauge.machine;
        let mut heads = machine.rotary.iter().filter(|axis| axis.on == Mount::Head).peekable();
        if heads.peek().is_none() {
            return true;
        }
        match self.here.pose.orientation {
            Orientation::Rotary { degrees, .. } => {
                heads.all(|axis| axis.turned(degrees[axis.index()]).abs() < 1e-6)
            }
            Orientation::Axis(axis) => {
                machine.rotary.iter().all(|axis| axis.on == Mount::Head) && axis == Vec3::Z
            }
        }
    }

    /// A tool change.
    fn change_tool(&mut self, line: u32, tool: &Tool) -> Outcome {
        if !self.at_tool_change() {
            let message = "changes the tool where the source does not";
            return Err(self.lost_at(line, "extra-tool-change", message));
        }
        self.report.compared.tool_changes += 1;
        let name = if tool.number > 0 { tool.number.to_string() } else { tool.name.clone() };
        self.report.program.tool(name);
        self.running.change_tool(line, tool.clone());
        Ok(())
    }

    /// A dwell or a stop.
    fn event(&mut self, line: u32, event: Step) {
        if let (Step::Move(Goal { kind: Kind::Hole(cycle), to, .. }), Step::Dwell(seconds)) =
            (&self.cursor.step, &event)
        {
            let hole = Hole { gauge: &self.gauge, point: to, cycle };
            if self.leg.hole.dwell(&hole, &self.here, *seconds) {
                return;
            }
        }
        if self.leg.t == 0.0 && self.leg.stops.is_empty() && self.leg.left.is_none() {
            self.pass_left_out(|_| false);
        }
        let allowed = self.gauge.allowed.dwell_s;
        let same = match (&self.cursor.step, &event) {
            (Step::Dwell(a), Step::Dwell(b)) => (a - b).abs() <= allowed,
            (Step::Stop, Step::Stop) | (Step::OptionalStop, Step::OptionalStop) => true,
            _ => false,
        };
        if same {
            self.report.compared.events += 1;
            if self.cursor.wanted.spindle == Spindle::Off && self.running.spindle != Spindle::Off {
                let message = "the spindle turns at a stop, but should be stopped";
                self.differs(line, ("spindle", message.into()));
            }
            self.advance();
        } else if let (Step::Dwell(a), Step::Dwell(b)) = (&self.cursor.step, &event) {
            let message = format!("dwells {} s, but should {} s", Number(*b), Number(*a));
            self.differs(line, ("dwell", message));
            self.advance();
        } else if matches!(event, Step::Dwell(_)) || !self.at_tool_change() {
            let (rule, what) = match event {
                Step::Dwell(_) => ("dwell", "dwells"),
                Step::Stop => ("stop", "stops"),
                _ => ("stop", "stops if the operator asks for it"),
            };
            self.differs(line, (rule, format!("{what} where the source does not")));
        }
    }

    /// Whether the source has a tool change here, or nothing before. Goes there past motions that may
    /// be left out.
    fn at_tool_change(&mut self) -> bool {
        if self.leg.t > 0.0 || self.leg.hole.over {
            return false;
        }
        if !self.cursor.at_tool_change() {
            self.pass_left_out(|goal| goal.tool_change);
        }
        self.cursor.at_tool_change()
    }

    /// Passes motions that the tool need not make: those shorter than the resolution of the machine,
    /// at whose end it already is. Stops before one that `wanted` asks for.
    fn pass_left_out(&mut self, wanted: impl Fn(&Goal) -> bool) {
        while self.leg.stops.is_empty() && self.leg.left.is_none() && !self.leg.hole.over {
            let Step::Move(goal) = &self.cursor.step else { return };
            let slack = self.gauge.slack(&self.here);
            let short = match &goal.kind {
                Kind::Rapid => true,
                Kind::Line => goal.from.is_some(),
                Kind::Arc(arc) => arc.length() <= 2.0 * slack,
                Kind::Hole(_) | Kind::Broken(_) => false,
            };
            if !short || !self.gauge.at(&self.here, &goal.to) || wanted(goal) {
                return;
            }
            self.report.compared.left_out += 1;
            self.advance();
        }
    }

    /// A move after the last motion of the source: away along the tool axis, or turning rotary axes
    /// while the machine is at home.
    fn closing(&mut self, gait: Gait, to: &Station) -> Outcome {
        let lifts = stops::lifted(&self.gauge, &self.here, to);
        let turns_at_home = to.pose.point.z.is_nan() && self.leg.homed && {
            let (a, b) = (self.here.pose.point, to.pose.point);
            (0..3).all(|i| a[i] == b[i] || b[i].is_nan())
        };
        match gait == Gait::Rapid && (lifts || turns_at_home) {
            true => Ok(()),
            false => {
                let message = format!("goes to {} after the last motion of the source", to.place);
                Err(self.lost_at(to.line, "extra-motion", &message))
            }
        }
    }

    /// Tells dwells and stops that stand before the next motion of the source.
    fn miss_events(&mut self, line: u32) {
        loop {
            let (rule, what) = match &self.cursor.step {
                Step::Dwell(seconds) => ("dwell", format!("a dwell of {} s", Number(*seconds))),
                Step::Stop => ("stop", "a stop".into()),
                Step::OptionalStop => ("stop", "an optional stop".into()),
                _ => return,
            };
            self.differs(line, (rule, format!("{what} is missing before this")));
            self.advance();
        }
    }

    /// The source motion is done.
    fn arrive(&mut self, to: &Station) {
        if let Step::Move(goal) = &self.cursor.step {
            let compared = &mut self.report.compared;
            match goal.kind {
                Kind::Rapid => compared.rapids += 1,
                Kind::Line => compared.lines += 1,
                Kind::Arc(_) => compared.arcs += 1,
                Kind::Hole(_) => compared.holes += 1,
                Kind::Broken(_) => {}
            }
            let (tip, axis) = to.place.apart(&goal.end());
            self.report.deviations.tip_mm.note(tip, goal.line, to.line);
            self.report.deviations.axis_degrees.note(axis, goal.line, to.line);
        }
        self.here = *to;
        self.advance();
    }

    fn advance(&mut self) {
        self.cursor.advance();
        self.enter();
    }

    /// Makes ready for the step at hand.
    fn enter(&mut self) {
        self.leg.t = 0.0;
        self.leg.start = Some(self.here);
        self.leg.stops.clear();
        self.leg.left = None;
        self.leg.homed = false;
        self.gauge.tool_length = self.cursor.tool_length();
        if let Step::Move(Goal { kind: Kind::Hole(cycle), .. }) = &self.cursor.step {
            self.leg.hole.restart(cycle);
        } else {
            self.leg.hole.over = false;
        }
    }

    /// Adds a move to the totals of the program.
    fn count(&mut self, gait: Gait, to: &Station, arc: Option<&ArcTo>, block: Option<&Arc>) {
        let summary = &mut self.report.program;
        summary.include(&to.pose);
        let length = block.map_or(self.here.place.tip.distance(to.place.tip), Arc::length);
        if length.is_finite() {
            match gait {
                Gait::Rapid => summary.rapid_length_mm += length,
                Gait::Feed => summary.cutting_length_mm += length,
            }
        }
        if let Some(to) = arc {
            let (start, end) = (self.here.pose.point, to.end.point);
            let radius = start.distance(to.center);
            if let Ok(arc) = Arc::new(start, end, to.center, to.normal, to.turns, radius) {
                summary.include_arc(&arc);
            }
        }
    }

    /// The stop that comes nearest to where the source goes.
    fn nearest_stop(&self) -> Option<Station> {
        let Step::Move(goal) = &self.cursor.step else { return None };
        let far = |stop: &Station| {
            let apart = stop.place.tip.distance(goal.to.tip);
            if apart.is_nan() { f64::INFINITY } else { apart }
        };
        self.leg.stops.iter().min_by(|a, b| far(a).total_cmp(&far(b))).copied()
    }

    fn not_reached(&self, stop: &Station) -> String {
        let Step::Move(goal) = &self.cursor.step else { return String::new() };
        let (tip, axis) = stop.place.apart(&goal.to);
        format!(
            "goes to {}, but the source goes to {}: {} mm and {}° apart",
            stop.place,
            goal.to,
            Number(tip),
            Number(axis)
        )
    }

    /// A difference after which the comparison goes on.
    fn differs(&mut self, line: u32, (rule, what): Difference) {
        let source = self.cursor.line;
        let message = format!("source line {source}: {what}");
        self.report.mismatch(source, Diagnostic::error(rule, message).line(line));
    }

    fn check(&mut self, line: u32, difference: Option<Difference>) {
        if let Some(difference) = difference {
            self.differs(line, difference);
        }
    }

    /// The mismatch on `line` of the program after which the comparison cannot go on.
    fn lost_at(&self, line: u32, rule: &'static str, what: &str) -> Box<Diagnostic> {
        let message = format!("source line {}: the program {what}", self.cursor.line);
        Diagnostic::error(rule, message).line(line).into()
    }
}
