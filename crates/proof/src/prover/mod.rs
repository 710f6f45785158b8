//! The walk of the program along the source.

mod approach;
mod contact;
mod cut;
mod drilling;
mod ending;
mod events;
mod motions;
mod rapid;
mod rapid_path;
mod single;
mod touch_off;
mod travel;

use crate::accepted::Accepted;
use crate::compensation::Part;
use crate::compensation::trail::{CompensatedMoves, Piece, Terms, Trail};
use crate::expected::{Cursor, ExpectedMotion, Kind, Step};
use crate::gauge::Gauge;
use crate::hole::{Drilled, Hole, Run};
use crate::line::Followed;
use crate::machine_pose::PossiblePositions;
use crate::observer::Observer;
use crate::pace::{self, Compared, Pace};
use crate::report::{Excursion, Report, SourceLine, TravelChecked};
use crate::resolved_pose::{Number, PartialPose, ResolvedPose};
use crate::state::{self, CornerLimits, Difference, Running};
use crate::tolerance::{Applied, Tolerances};
use crate::travel::Travel;
use crate::{arc, line, stops};
use control::{Action, ArcTo, Event, Orientation, Position};
use geom::{Arc, Vec3};
use machine::{Machine, Mount, TouchPlate};
use program::Rule;
use program::statistics::Statistics;
use program::{
    Axes, Compensation, Coolant, CutBox, Diagnostic, Feed, MachineMove, Probe, Program, Severity,
    Spindle, Tool, Tops,
};

/// The way out of a difference.
const ALIKE: &str =
    "change the program here, or the toolpath if the program is right: both have to say the same";

/// The way out where nothing can be compared.
const COMPARABLE: &str = "take this record out of the toolpath";

/// Compares a program with its source, record by record, as a control runs it.
pub struct Prover<'a> {
    source: &'a Program,
    /// How far the source reaches; counted where it is asked for.
    statistics: Option<Statistics>,
    /// What it cuts; counted where it is asked for.
    cuts: Option<CutBox>,
    /// How high it goes; looked for where it is asked for.
    tops: Option<Tops<'a>>,
    gauge: Gauge<'a>,
    cursor: Cursor<'a>,
    running: Running,
    /// How the spindle has turned near the part.
    contact: contact::Contact,
    /// Compensation of the source as far as moves have switched it.
    compensation: Compensation,
    /// The stretches in which the program compensates, where they are wanted.
    trail: Option<Trail>,
    /// How long the motions take, and what is told of them.
    motions: motions::Motions,
    here: ResolvedPose,
    /// Where the rotary axes stand.
    standing: PossiblePositions<'a>,
    travel: Travel,
    progress: MotionProgress,
    /// What the cuts have taken, where the number behind F does not say it.
    pace: Pace,
    report: Report,
    accepted: Accepted,
    /// Whether Z is home, or where the tool change brings it, so that axes may turn.
    raised: bool,
    /// The height over the work zero to which a machine without switches has retracted, mm: from there it only comes down.
    top: f64,
    /// Whether the operator has set up a machine without switches, or the tool has moved.
    is_set_up: bool,
    /// The plate on which tools are touched off, where there is one. Options of the machine's file are looked up once for a proof, not for
    /// each event.
    plate: Option<TouchPlate>,
    /// How high a machine without switches retracts in place of home, mm.
    retract_height: Option<f64>,
    /// How far the touch-off of the tool is that has been put in by hand.
    touch: touch_off::Touch,
    /// The length register of the last cut with the tool before.
    length_before_tool: Option<u32>,
    /// Whether the control has turned the rotary axes to a tilted plane, and nothing has moved since.
    swivelled: bool,
    /// Whether the tool has stood at a place that is known.
    has_stood: bool,
    /// Where it stood last, Z not having been home since.
    down: Option<ResolvedPose>,
    /// The line along the tool axis on which the tool stands in a tilted plane, at a height that nobody knows.
    over: Option<PartialPose>,
    ended: bool,
    lost: bool,
}

/// How far the program is with the source motion at hand.
#[derive(Default)]
struct MotionProgress {
    /// Part of a line or an arc that is done, 0 to 1.
    t: f64,
    /// Where the last motion ended.
    start: Option<ResolvedPose>,
    /// Where rapids have stopped since then, or since the tool left the path.
    stops: Vec<ResolvedPose>,
    /// Where an excursion left the path.
    left: Option<ResolvedPose>,
    /// Where the tool has left the path for a stop of the program, for which it goes home.
    away: Option<ResolvedPose>,
    /// Whether Z was sent home since.
    homed: bool,
    hole: Run,
}

/// How a block moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MotionKind {
    Rapid,
    Feed,
}

/// The most stops that a rapid may have: a corner for each of five axes, and retracts.
const MOST_STOPS: usize = 16;

/// A coordinate of a block counts as repeated below this, mm.
const SAME: f64 = 1e-6;

use program::Outcome;

impl<'a> Prover<'a> {
    /// Before the first record of a program for `machine`.
    pub fn new(source: &'a Program, machine: &'a Machine, tolerances: &Tolerances) -> Prover<'a> {
        let allowed = Applied::new(machine, tolerances);
        let cursor = Cursor::new(machine, source);
        let gauge = Gauge {
            machine,
            allowed,
            corners: CornerLimits::of(machine),
            tool_length: cursor.tool_length(),
            straight_rapids: machine.has_straight_rapids(),
        };
        let unknown = Position {
            point: Vec3::NAN,
            orientation: Orientation::Rotary { degrees: [f64::NAN; 3], tool_center: false },
        };
        let mut prover = Prover {
            source,
            statistics: None,
            cuts: None,
            tops: None,
            here: gauge.resolve(0, unknown),
            standing: PossiblePositions::new(machine),
            travel: Travel::new(machine),
            gauge,
            cursor,
            running: Running::at_reset(machine),
            contact: contact::Contact::new(),
            compensation: Compensation::Off,
            trail: None,
            motions: motions::Motions::default(),
            progress: MotionProgress::default(),
            pace: Pace::default(),
            report: Report { tolerances: allowed, ..Report::default() },
            accepted: tolerances.accepted,
            raised: false,
            top: f64::NEG_INFINITY,
            is_set_up: false,
            plate: machine.touch_plate(),
            retract_height: machine.retract_height(),
            touch: touch_off::Touch::default(),
            length_before_tool: None,
            swivelled: false,
            has_stood: false,
            down: None,
            over: None,
            ended: false,
            lost: false,
        };
        prover.look_for_two_tools();
        prover.enter();
        prover
    }

    /// Refuses a source with two different tools under one number: the control skips the change from the one to the other.
    fn look_for_two_tools(&mut self) {
        for found in self.source.tools_under_one_number() {
            let message = format!("{}{}", SourceLine(found.line), found.message);
            let line = found.line;
            let found = Diagnostic { message, ..found }.line(0);
            match found.severity {
                Severity::Error => self.report.mismatch(line, found),
                Severity::Warning => self.report.warn(found),
            }
        }
    }

    /// Keeps the stretches in which the program compensates.
    pub(crate) fn keep_trail(&mut self) {
        self.trail = Some(Trail::default());
    }

    /// Those stretches, and what places in them need.
    pub(crate) fn stretches(&mut self) -> (Gauge<'a>, Vec<CompensatedMoves>) {
        (self.gauge, self.trail.take().map_or_else(Vec::new, Trail::finish))
    }

    /// The next event of the program.
    ///
    /// # Errors
    /// The mismatch after which nothing can be compared any more; it is in the report too.
    pub fn event(&mut self, event: &Event) -> Outcome {
        self.event_for(event, &mut ())
    }

    /// The same for an observer, who is told its motions where it wants them.
    ///
    /// # Errors
    /// The same.
    pub(crate) fn event_for(&mut self, event: &Event, observer: &mut dyn Observer) -> Outcome {
        if self.lost {
            return Ok(());
        }
        self.follow(event);
        self.begin_motion();
        let outcome = self.take(event);
        if outcome.is_ok() {
            self.end_motion(event, observer);
        }
        if event.action.position().is_some() {
            self.contact.moved(self.running.spindle);
        }
        if let Err(found) = &outcome {
            self.lost = true;
            self.report.mismatch(self.cursor.line, (**found).clone());
        }
        outcome
    }

    /// What differs so far.
    pub(crate) fn mismatches(&self) -> &[Diagnostic] {
        &self.report.mismatches
    }

    /// The report, after the last event.
    pub fn finish(mut self) -> Report {
        if !self.lost {
            self.pass_left_out(|_| false);
            self.miss_events(0);
            let stop = self.nearest_stop().filter(|_| self.progress.left.is_none());
            match (&self.cursor.step, stop) {
                (Step::End, _) => {}
                (Step::Unproven(what), _) => {
                    let found = self.unproven(0, what);
                    self.report.mismatch(self.cursor.line, *found);
                }
                (_, Some(stop)) => {
                    self.differs(stop.line, (Rule::EndPoint, self.not_reached(&stop)))
                }
                _ => self.differs(0, (Rule::Missing, "the program ends before this".into())),
            }
            if !self.ended {
                self.differs(0, (Rule::NoEnd, "the program has no end".into()));
            }
        }
        let linear = self.travel.known();
        self.report.travel = TravelChecked { linear, unsaid: self.travel.into_unsaid() };
        self.report.proven = self.report.mismatches.is_empty();
        self.report
    }

    /// The control refused a block, so the rest is not known. What [`Prover::event`] answered is
    /// in the report already.
    pub(crate) fn refused(&mut self, found: Diagnostic) {
        if !self.lost {
            self.lost = true;
            self.report.mismatch(self.cursor.line, found);
        }
    }

    /// Keeps a move where the stretches with compensation are wanted.
    fn follow(&mut self, event: &Event) {
        let Some(trail) = &mut self.trail else { return };
        let (position, arc) = match Part::of(&event.action) {
            Part::Move(position, arc) => (position, arc),
            Part::End => return trail.close(),
            Part::Side(_) | Part::Other => return,
        };
        let to = self.gauge.resolve(event.line, *position);
        let arc = arc.and_then(|arc| arc::of_block(&self.gauge, &self.here, arc));
        let terms = Terms {
            source_line: self.cursor.line,
            side: self.running.compensation,
            radius: self.cursor.wanted.tool.and_then(Tool::cutting_radius),
            tool_length: self.gauge.tool_length,
        };
        trail.moved(terms, Piece { line: event.line, from: self.here.place, to: to.place, arc });
    }

    fn take(&mut self, event: &Event) -> Outcome {
        let line = event.line;
        let passive = matches!(event.action, Action::Comment(_) | Action::Message(_) | Action::End);
        if self.ended && !passive {
            return Err(self.lost_at(line, Rule::AfterEnd, "goes on after the end of the program"));
        }
        self.awaits_set_up(event);
        if self.touches_off(event) {
            return Ok(());
        }
        if let Action::Rapid(position) = &event.action
            && self.retracts(position)
        {
            self.running.just_started = false;
            return self.retract(line, position);
        }
        let running = &mut self.running;
        running.just_started &= !matches!(
            event.action,
            Action::Line(_)
                | Action::Arc(_)
                | Action::Thread(_)
                | Action::Probe(_)
                | Action::Hole(_)
        );
        match &event.action {
            Action::Rapid(position) => return self.motion(line, MotionKind::Rapid, position, None),
            Action::Line(position) => return self.motion(line, MotionKind::Feed, position, None),
            Action::Arc(to) => return self.motion(line, MotionKind::Feed, &to.end, Some(to)),
            Action::Hole(position) => return self.drilled(line, position),
            Action::Thread(thread) => {
                return self.single(line, &thread.end, Kind::Thread(thread.pitch));
            }
            Action::Probe(probe) => {
                let Probe { end, away, must_answer, .. } = **probe;
                return self.single(line, &end, Kind::Probe { away, must_answer });
            }
            Action::Home(axes) => return self.home(line, *axes),
            Action::MachineMove(to) => return self.machine_move(line, to),
            Action::Swivel(choice) => {
                self.standing.swivel(*choice);
                self.check_height(line);
                self.turns(line, [true; 3]);
                self.swivelled = true;
                self.over = None;
            }
            Action::Across(position) => return self.across(line, position),
            Action::Tool(tool) => return self.change_tool(line, tool),
            Action::Dwell(seconds) if *seconds == 0.0 => {}
            Action::Dwell(seconds) => {
                let allowed = self.gauge.allowed.dwell_s;
                let dwell = self.gauge.machine.spindle.dwell;
                // Of two dwells alike, one of the source's and one for a spindle that may have been started anew, this is the source's.
                let is_due = matches!(self.cursor.step, Step::Dwell(due) if (due - seconds).abs() <= allowed);
                let is_sources = is_due && running.runs_up == 0.0;
                if !is_sources && running.waits_for_spindle(*seconds, dwell, allowed) {
                    return Ok(());
                }
                return self.happens(line, Step::Dwell(*seconds));
            }
            Action::Stop | Action::OptionalStop => {
                running.just_started = running.spindle != Spindle::Off;
                let stop = event.action == Action::Stop;
                return self.happens(line, if stop { Step::Stop } else { Step::OptionalStop });
            }
            Action::ThreadWire => return self.happens(line, Step::ThreadWire),
            Action::CutWire => return self.happens(line, Step::CutWire),
            Action::Output(output) => return self.happens(line, Step::Output(*output)),
            Action::WorkOffsetData(data) if self.gauge.machine.settings.sets_work_offsets => {
                return self.happens(line, Step::WorkOffsetData(**data));
            }
            // Of no touch-off of the machine's own.
            Action::TouchOff(_) => {
                let message = "sets Z by what a probe has touched where no tool is touched off";
                self.differs(line, (Rule::Probe, message.into()));
            }
            // The risk before it is refused, or accepted.
            Action::WorkOffsetData(_) => {}
            Action::Input(input) => return self.happens(line, Step::Input(**input)),
            Action::Auxiliary(function) => {
                let Some(clamp) = self.gauge.machine.clamps(function.number) else {
                    return self.happens(line, Step::Auxiliary(*function));
                };
                for (i, state) in running.clamps.iter_mut().enumerate() {
                    if clamp.axes.contains(Axes::rotary(i)) {
                        *state = Some(clamp.closed);
                    }
                }
            }
            Action::Feed(feed) => running.feed = Some(*feed),
            Action::FeedPath(path) => running.feed_path = *path,
            Action::RapidsTogether(together) => {
                let machine = self.gauge.machine;
                self.gauge.straight_rapids = together.unwrap_or(machine.has_straight_rapids());
            }
            Action::Spindle(spindle) => {
                running.switch_spindle(line, *spindle, self.gauge.machine.spindle.dwell);
                self.check_speed(line, *spindle);
                self.check_direction(line, *spindle);
                self.check_fastest(line, *spindle);
                self.check_standing(line);
            }
            Action::SurfaceSpeed(speed) => running.surface_speed = *speed,
            Action::Coolant(coolant) => {
                (running.coolant, running.coolant_line) = (*coolant, line);
                self.check_coolant(line, *coolant);
            }
            Action::Compensation(side) => running.compensation = *side,
            Action::Taper(degrees) => running.taper = *degrees,
            Action::PathMode(mode) => running.path = *mode,
            Action::LengthOffset(register) => running.length_offset = *register,
            Action::WorkOffset(offset) => {
                if running.work_offset.is_some_and(|before| before != *offset) {
                    running.offset_changed = self.has_stood && !self.raised;
                }
                running.work_offset = Some(*offset);
                let position = Position { point: Vec3::NAN, ..self.here.position };
                self.here = self.gauge.resolve(line, position);
            }
            Action::Cycle(cycle) => running.cycle = Some(**cycle),
            Action::CycleOff => {
                // Taps and bores stop the spindle themselves; a program that starts it anew is not waited for either.
                running.just_started = running.spindle != Spindle::Off;
                running.cycle = None;
            }
            Action::Risk(risk) => {
                let message = format!("{}the program {}", SourceLine(self.cursor.line), risk.what);
                if risk.refused {
                    self.found(Diagnostic::error(risk.rule, message).help(risk.help).line(line));
                } else {
                    let found = Diagnostic::warning(risk.rule, message).help(risk.help);
                    self.report.warn(found.line(line));
                }
            }
            Action::Arm(_) => {
                let message = "a motion of an arm, and the machine's file describes none";
                let help = "prove it with the machine file of the robot";
                self.found(Diagnostic::error(Rule::MachineKind, message).help(help).line(line));
            }
            Action::End => self.ends(line),
            // A tool that is made ready changes nothing, and words are for people.
            Action::Preselect(_) | Action::Comment(_) | Action::Message(_) => {}
        }
        Ok(())
    }

    /// A move to a position.
    fn motion(
        &mut self,
        line: u32,
        motion: MotionKind,
        position: &Position,
        arc: Option<&ArcTo>,
    ) -> Outcome {
        if arc.is_none() && *position == self.here.position {
            // By another length it moves all the same.
            let here = self.here;
            self.check_offsets(&ResolvedPose { line, ..here });
            return Ok(());
        }
        self.unclamped(line, &position.orientation);
        if motion == MotionKind::Rapid {
            self.pace = Pace::default();
        }
        let is_up = position.point.z.is_nan();
        if is_up && motion == MotionKind::Rapid && self.turns_by_words(&position.orientation) {
            self.check_height(line);
        }
        self.measured(line, position)?;
        let to = self.gauge.resolve(line, *position);
        let block = arc.map(|arc| arc::of_block(&self.gauge, &self.here, arc));
        if block == Some(None) {
            return Err(self.lost_at(line, Rule::Arc, "makes no arc"));
        }
        let block = block.flatten();
        self.motions.arc = block;
        self.count(motion, &to, arc, block.as_ref());
        self.hold_travel(&to, block.as_ref());
        if self.progress.left.is_none() {
            let gauge = self.gauge;
            self.pass_left_out(|goal| {
                let alike = match goal.kind {
                    Kind::Rapid => motion == MotionKind::Rapid,
                    Kind::Line => motion == MotionKind::Feed && block.is_none(),
                    Kind::Arc(_) => motion == MotionKind::Feed,
                    Kind::Hole(_) | Kind::Thread(_) | Kind::Probe { .. } | Kind::Broken(_) => false,
                };
                alike && gauge.at(&to, &goal.to)
            });
        }
        if motion == MotionKind::Rapid || self.progress.left.is_some() || !self.is_cutting() {
            self.check_contact(line, Some(&to));
            self.check_offsets(&to);
        }
        let is_free = motion == MotionKind::Rapid || self.lifts(motion, &to);
        if is_free && self.goes_nowhere_yet(&to) {
            if motion == MotionKind::Feed {
                self.check_air_feed(line);
            }
            return Ok(());
        }
        self.miss_events(line);
        let wrong_way = if motion == MotionKind::Rapid { self.wrong_way(&to) } else { None };
        if motion == MotionKind::Rapid {
            self.check_rapid_corners(&to);
        }
        let outcome = match &self.cursor.step {
            Step::Move(goal) => match &goal.kind {
                Kind::Rapid => self.rapid(motion, &to),
                Kind::Line | Kind::Arc(_)
                    if motion == MotionKind::Rapid
                        || self.progress.left.is_some()
                        || goal.tool_change && self.lifts(motion, &to) =>
                {
                    self.excursion(motion, &to)
                }
                Kind::Line | Kind::Arc(_) => self.cut(&to, block.as_ref()),
                Kind::Hole(_) if block.is_some() => {
                    Err(self.lost_at(line, Rule::Hole, "makes an arc where the source has a hole"))
                }
                Kind::Hole(_) => self.hole_move(motion, &to),
                kind @ (Kind::Thread(_) | Kind::Probe { .. }) => {
                    let message = format!("moves where the source {}", single::does(kind));
                    Err(self.lost_at(line, Rule::SingleBlock, &message))
                }
                Kind::Broken(why) => {
                    let message = format!("has no motion to compare with: {why}");
                    Err(self.lost_at(line, Rule::Source, &message).help(COMPARABLE).into())
                }
            },
            Step::Unproven(what) => Err(self.unproven(line, what)),
            Step::Dwell(_)
            | Step::Stop
            | Step::OptionalStop
            | Step::ThreadWire
            | Step::CutWire
            | Step::Output(_)
            | Step::Input(_)
            | Step::Auxiliary(_)
            | Step::WorkOffsetData(_)
            | Step::End => self.closing(motion, &to),
        };
        if let (Ok(()), Some(found)) = (&outcome, wrong_way) {
            self.found(found);
        }
        self.standing.arrive(&to.position.orientation);
        self.here = to;
        self.raised &= is_up;
        self.stands_at(&to);
        self.over = None;
        outcome
    }

    /// Whether axes turn while Z is home, or the tool goes out along its axis on the way to home, before what the source has
    /// next, which is no move: it may still come.
    fn goes_nowhere_yet(&mut self, to: &ResolvedPose) -> bool {
        if matches!(self.cursor.step, Step::Move(_)) {
            return false;
        }
        if self.turns_at_home(to) {
            if let Some(found) = self.wrong_approach(to) {
                self.found(found);
            }
        } else if stops::lifted(&self.gauge, &self.here, to) && self.stops_next() {
            self.progress.away.get_or_insert(self.here);
        } else if !self.cursor.leaves_part() || !stops::lifted(&self.gauge, &self.here, to) {
            return false;
        }
        self.standing.arrive(&to.position.orientation);
        self.stands_at(to);
        self.here = *to;
        self.raised &= to.position.point.z.is_nan();
        true
    }

    /// Whether the source has something next whose feed moves are compared as cuts.
    fn is_cutting(&self) -> bool {
        matches!(&self.cursor.step, Step::Move(goal) if goal.kind != Kind::Rapid)
    }

    /// Whether the source has a stop next.
    fn stops_next(&self) -> bool {
        matches!(self.cursor.step, Step::Stop | Step::OptionalStop)
    }

    /// Behind a stop for which the tool has gone home it comes back to where it was, before a cut that begins there.
    fn comes_back(&mut self) {
        let Step::Move(goal) = &self.cursor.step else { return };
        let cuts = matches!(goal.kind, Kind::Line | Kind::Arc(_));
        let away = self
            .progress
            .away
            .take()
            .filter(|_| self.progress.homed && cuts && goal.from.is_some());
        if let Some(away) = away {
            self.progress.left = Some(away);
            self.progress.stops.push(self.here);
        }
    }

    /// Keeps where the tool stands, where that is known.
    fn stands_at(&mut self, to: &ResolvedPose) {
        if to.place.known() {
            self.has_stood = true;
            self.down = Some(*to);
        }
    }

    /// Holds the clamps open of the rotary axes that turn from here on.
    fn unclamped(&mut self, line: u32, to: &Orientation) {
        // The control has turned them already; the clamps were looked at then.
        if std::mem::take(&mut self.swivelled) && matches!(to, Orientation::Axis(_)) {
            return;
        }
        self.turns(line, self.turning(to));
    }

    /// Which of A, B and C turn on the way from here.
    fn turning(&self, to: &Orientation) -> [bool; 3] {
        let here = &self.here.position.orientation;
        match (here, to) {
            (
                Orientation::Rotary { degrees: from, .. },
                Orientation::Rotary { degrees: to, .. },
            ) => [0, 1, 2].map(|i| from[i] != to[i] && !to[i].is_nan()),
            (Orientation::Axis(_), _) | (_, Orientation::Axis(_)) => [here != to; 3],
        }
    }

    /// Whether the words of a block turn axes that the tool does not follow.
    fn turns_by_words(&self, to: &Orientation) -> bool {
        matches!(to, Orientation::Rotary { tool_center: false, .. })
            && self.turning(to).contains(&true)
    }

    /// Holds Z up where axes turn at a height that nobody knows: a table swings the part up, a head its tool down.
    fn check_height(&mut self, line: u32) {
        if self.raised || self.gauge.machine.rotary.is_empty() {
            return;
        }
        let message = format!(
            "{}the program turns rotary axes where Z has not been home since the last move",
            SourceLine(self.cursor.line)
        );
        let help = "send Z home before it";
        self.found(Diagnostic::error(Rule::TurnHeight, message).help(help).line(line));
    }

    /// Holds the clamps of these axes open.
    fn turns(&mut self, line: u32, turns: [bool; 3]) {
        let found = state::clamps(self.gauge.machine, turns, &self.running);
        self.check(line, found);
    }

    /// Passes motions that the tool need not make: those shorter than the resolution of the machine,
    /// at whose end it already is. Stops before one that `wanted` asks for.
    fn pass_left_out(&mut self, wanted: impl Fn(&ExpectedMotion) -> bool) {
        while self.progress.stops.is_empty()
            && self.progress.left.is_none()
            && !self.progress.hole.over
        {
            let Step::Move(goal) = &self.cursor.step else { return };
            let slack = self.gauge.slack(&self.here);
            let short = match &goal.kind {
                Kind::Rapid => true,
                Kind::Line => goal.from.is_some(),
                Kind::Arc(arc) => arc.length() <= 2.0 * slack,
                Kind::Hole(_) | Kind::Thread(_) | Kind::Probe { .. } | Kind::Broken(_) => false,
            };
            if !short || goal.homed || !self.gauge.at(&self.here, &goal.to) || wanted(goal) {
                return;
            }
            self.report.compared.left_out += 1;
            self.pace.owe((1.0 - self.progress.t) * goal.length());
            self.advance();
        }
    }

    /// The source motion is done.
    fn arrive(&mut self, to: &ResolvedPose) {
        if let Step::Move(goal) = &self.cursor.step {
            let compared = &mut self.report.compared;
            match goal.kind {
                Kind::Rapid => compared.rapids += 1,
                Kind::Line | Kind::Thread(_) | Kind::Probe { .. } => compared.lines += 1,
                Kind::Arc(_) => compared.arcs += 1,
                Kind::Hole(_) => compared.holes += 1,
                Kind::Broken(_) => {}
            }
            let (tip, axis) = to.place.apart(&goal.end());
            self.report.deviations.tip_mm.note(tip, goal.line, to.line);
            self.report.deviations.axis_degrees.note(axis, goal.line, to.line);
            self.has_compared((tip, axis));
        }
        self.here = *to;
        self.has_arrived();
        self.advance();
    }

    fn advance(&mut self) {
        // What happens between two motions brings Z nowhere.
        self.progress.homed &= !matches!(self.cursor.step, Step::Move(_));
        self.cursor.advance();
        self.enter();
    }

    /// Makes ready for the step at hand.
    fn enter(&mut self) {
        self.progress.t = 0.0;
        self.progress.start = Some(self.here);
        self.progress.stops.clear();
        self.progress.left = None;
        self.comes_back();
        // On the way to a tool change the last tool is still in the spindle.
        if self.running.tool.is_none() || !self.cursor.at_tool_change() {
            self.gauge.tool_length = self.cursor.tool_length();
        }
        if let Step::Move(ExpectedMotion { kind: Kind::Hole(cycle), .. }) = &self.cursor.step {
            self.progress.hole.restart(cycle);
        } else {
            self.progress.hole.over = false;
        }
    }

    /// Adds a move to the totals of the program.
    fn count(
        &mut self,
        motion: MotionKind,
        to: &ResolvedPose,
        arc: Option<&ArcTo>,
        block: Option<&Arc>,
    ) {
        let summary = &mut self.report.program;
        summary.include(&to.position);
        let lean = self
            .gauge
            .machine
            .wire
            .zip(to.position.axis())
            .and_then(|(wire, axis)| wire.lean(axis));
        lean.into_iter().for_each(|uv| summary.include_lean(uv));
        let length = block.map_or(self.here.place.tip.distance(to.place.tip), Arc::length);
        if length.is_finite() {
            match motion {
                MotionKind::Rapid => summary.rapid_length_mm += length,
                MotionKind::Feed => summary.cutting_length_mm += length,
            }
        }
        if let Some(to) = arc {
            let (start, end) = (self.here.position.point, to.end.point);
            let radius = start.distance(to.center);
            // No point of a helix is farther from a point of its axis than its ends are together.
            if summary.holds(to.center, radius + end.distance(to.center)) {
                return;
            }
            if let Ok(arc) = Arc::new(start, end, to.center, to.normal, to.turns, radius) {
                summary.include_arc(&arc);
            }
        }
    }

    /// A difference after which the comparison goes on.
    fn differs(&mut self, line: u32, (rule, what): Difference) {
        let source = self.cursor.line;
        let message = format!("{}{what}", SourceLine(source));
        self.found(Diagnostic::error(rule, message).help(ALIKE).line(line));
    }

    /// What does not keep the motions from being compared.
    fn found(&mut self, found: Diagnostic) {
        match self.accepted.holds(found.rule) {
            true => self.report.accept(found),
            false => self.report.mismatch(self.cursor.line, found),
        }
    }

    fn check(&mut self, line: u32, difference: Option<Difference>) {
        if let Some(difference) = difference {
            self.differs(line, difference);
        }
    }

    /// The source has something before this that no program can be compared with.
    fn unproven(&self, line: u32, what: &str) -> Box<Diagnostic> {
        let message = format!("cannot be compared: the source has {what} before this");
        self.lost_at(line, Rule::Unproven, &message).help(COMPARABLE).into()
    }

    /// Holds known what the position of the tip depends on.
    ///
    /// # Errors
    /// The control does not keep the tip, and a fact of the machine or the tool is missing to know where it is. Where
    /// a coordinate is not known either, as at a reference position, nothing is compared with it.
    fn measured(&self, line: u32, position: &Position) -> Outcome {
        let Orientation::Rotary { degrees, tool_center: false } = position.orientation else {
            return Ok(());
        };
        let Gauge { machine, tool_length, .. } = self.gauge;
        match machine.unsaid(degrees, tool_length) {
            Some(unsaid) if position.point.is_finite() => {
                let what = format!("turns axes, and nobody says {unsaid}");
                Err(self.lost_at(line, unsaid.rule(), &what).help(unsaid.way_out()).into())
            }
            _ => Ok(()),
        }
    }

    /// The mismatch on `line` of the program after which the comparison cannot go on.
    fn lost_at(&self, line: u32, rule: Rule, what: &str) -> Box<Diagnostic> {
        let message = format!("{}the program {what}", SourceLine(self.cursor.line));
        Diagnostic::error(rule, message).help(ALIKE).line(line).into()
    }
}
