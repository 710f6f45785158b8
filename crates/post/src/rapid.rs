//! Rapids, from known positions and from unknown ones, so that the tool goes where the source goes: straight, or beyond
//! all that the source cuts.
//!
//! A control moves its axes, and not the tool. Where axes turn that the tip does not follow, or where each axis goes at
//! its own speed, the way between two points is another than the source's. It is then written in pieces, round a
//! corner, by feed, or from home, whichever keeps the tool on the way.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop, same};
use crate::template::{ORIENTATION, POSITION};
use crate::walk::{ByFeed, Outcome, Walk, motion, refuse};
use crate::words::{Words, bit};
use geom::{Vec3, angle_between, between, nearest_on_segment, off_great_circle};
use machine::linearise::RotaryPose;
use machine::plan::Step;
use machine::{Mount, Unsaid};
use program::{Diagnostic, Feed, Pose, Rule, Spindle};

/// Part of the corridor that is used, and of the angle by which the tool axis may be off its way: the rest is for the
/// rounding of words.
const USED: f64 = 0.8;

/// How far the tool axis may be off its way near the part, radians: half a degree.
const SWING: f64 = std::f64::consts::PI / 360.0;

/// What is added to the clearance for the rounding of words, mm.
const ROUNDING: f64 = 0.01;

/// Of less than this, which is noise of its numbers, no tool is too low, mm.
const NOISE: f64 = 1e-6;

/// Rotary axes turn at most this much between two places that are looked at, degrees.
const SAMPLE: f64 = 1.0;

/// A rapid that takes more pieces goes home instead.
const MOST_PIECES: usize = 200;

/// What to state where the axes go together by rapid.
const RAPID_PATH_HELP: &str = "`rapid_path = \"linear\"` in [settings] where its axes go together by rapid (FANUC: parameter 1401#1 is 1)";

/// How a rapid is written.
enum RapidMoves {
    /// In one block.
    AtOnce,
    /// By a corner from which, or to which, the tool goes along its axis.
    Corner(Pose),
    /// In pieces while axes turn.
    Pieces(Vec<RotaryPose>),
    /// By feed, which is straight on every control.
    Feed,
    /// From home, where the axes turn.
    Home,
}

/// Sine of the angle over level from which a tilted tool comes down along itself from above all cuts, and from as high as the source ever
/// goes along Z too: from below it would have to go far.
const STEEP: f64 = 0.5;

/// A tool that points down by more than this sine has no room next to it.
const NEARLY_DOWN: f64 = 0.9;

/// A tool that points down by less than this sine lies level.
const LEVEL: f64 = 1e-4;

/// By which places the tool comes from home to a pose.
struct Entry {
    /// Above all cuts: from anywhere at home all axes may go there together.
    above: Pose,
    /// Under it, from where the tool goes along its axis to the pose.
    beyond: Pose,
}

impl Walk<'_> {
    /// A rapid of the source.
    pub(crate) fn rapid(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        self.end_cycle()?;
        self.wire_for(false, "a rapid")?;
        self.same_taper("a rapid")?;
        self.spindle_before(pose)?;
        self.settle(pose, stop, false)?;
        let Some(from) = self.position.known() else {
            return self.approach(pose, stop);
        };
        if self.vector_strays(pose.axis()) || self.vector_past_pole(pose.axis()).is_some() {
            return self.by_home(pose, stop);
        }
        match self.course(&from, pose, stop, true)? {
            RapidMoves::AtOnce => self.rapid_at_once(pose, stop),
            RapidMoves::Corner(corner) => {
                self.rapid_at_once(&corner, stop)?;
                self.rapid_at_once(pose, stop)
            }
            RapidMoves::Pieces(poses) => self.in_pieces(pose, &poses),
            RapidMoves::Feed => self.by_feed(pose, stop),
            RapidMoves::Home => self.by_home(pose, stop),
        }
    }

    /// The spindle before a rapid to a pose: where the tool may touch, it turns, whether something is cut there or not; behind a
    /// bore that has stopped it, from above the hole on.
    pub(crate) fn spindle_before(&mut self, pose: &Pose) -> Outcome {
        let stands = self.sent.has_spindle(Spindle::Off);
        let from = self.position.known().filter(|_| stands);
        let touches = self.is_near_cuts(pose) || from.is_some_and(|from| self.is_near_cuts(&from));
        if touches { self.sync_spindle() } else { self.expect_spindle() }
    }

    /// Whether a pose is not beyond all that the source reaches by feed, along the tool axis there.
    fn is_near_cuts(&mut self, pose: &Pose) -> bool {
        pose.point().dot(pose.axis()) < self.fed_reach(pose.axis())
    }

    /// A rapid to a hole or in it: what the cycle of a control would do, axes that turn apart.
    pub(crate) fn rapid_to_hole(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        let Some(from) = self.position.known() else {
            return self.approach(pose, stop);
        };
        let at_once = match self.turns(stop) {
            true => matches!(self.course(&from, pose, stop, false)?, RapidMoves::AtOnce),
            false => !self.vector_strays(pose.axis()) && self.vector_is_free(&from, pose),
        };
        if !at_once {
            return self.by_home(pose, stop);
        }
        if !self.keeps_to_hole(&from, pose, stop) {
            let message = "each axis of the machine goes at its own speed by rapid, and on the way to this hole that takes the \
                           tool off its line near the part";
            let help = "`rapid_path = \"linear\"` in [settings] where its axes go together by rapid (FANUC: parameter 1401#1 is \
                        1), or a set-up in which the tool stands along Z of the machine";
            return Err(refuse(Rule::RapidPath, message).help(help).into());
        }
        self.rapid_at_once(pose, stop)
    }

    /// Whether a straight rapid to a hole stays on its line, however the axes go, or leaves it beyond all cuts alone.
    pub(crate) fn keeps_to_hole(&mut self, from: &Pose, to: &Pose, stop: &Stop) -> bool {
        let machine = self.machine;
        if self.has_straight_rapids() {
            return true;
        }
        let (a, b, axis) = (from.point(), to.point(), to.axis());
        let solutions = match &self.place.kind {
            Kind::Bare | Kind::Plain => vec![[0.0; 3]],
            Kind::ToolCenter | Kind::Machine => self.place.degrees().into_iter().collect(),
            Kind::Tilted(..) | Kind::Vectors => self.solutions(axis, stop),
        };
        let corridor = USED * machine.capabilities.rapid_corridor;
        let tips: Vec<Vec3> =
            solutions.iter().flat_map(|at| machine.wandering(a, b, *at)).collect();
        let is_straight = tips.iter().all(|tip| nearest_on_segment(a, b, *tip).1 <= corridor);
        !solutions.is_empty() && (is_straight || self.are_free(&tips, [from, to]))
    }

    /// How far `pose` has to go out along its axis, so that axes which go each at its own speed may lead the tool from there, mm.
    pub(crate) fn under(&mut self, pose: &Pose) -> f64 {
        let (height, axis) = (pose.point().dot(pose.axis()), pose.axis());
        let clearance = self.machine.capabilities.rapid_clearance + 2.0 * ROUNDING;
        ((self.cut_reach(axis) + clearance).max(self.floor(axis)) - height).max(0.0)
    }

    /// A rapid in one block, from a known position.
    pub(crate) fn rapid_at_once(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        self.switch_plane(pose.axis())?;
        self.aim(pose, stop);
        self.position.go_to(*pose);
        self.rapid_block()
    }

    /// The first position after a tool change or in a new orientation, from home.
    ///
    /// X and Y may stand anywhere. Where the Z of the program is that of the machine, they go first, at the height of
    /// home; otherwise all axes go together to a place above all cuts, as high as the source ever goes. What is left is a way along the
    /// tool axis.
    pub(crate) fn approach(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        let axis = pose.axis();
        let in_order = self.machine.approach.iter().map(String::as_str);
        if self.wire.is_some() {
            return self.in_groups(pose, stop, in_order);
        }
        self.home_clears(axis, stop)?;
        let ups = self.ups(axis, stop);
        let is_along = |other: Vec3| ups.iter().all(|up| same(*up, other));
        let is_level = match &self.place.kind {
            Kind::Bare | Kind::Plain | Kind::Machine => true,
            Kind::Tilted(_, tilted) => is_along(*tilted),
            // The block by which it goes on says X, Y and Z.
            Kind::ToolCenter | Kind::Vectors => is_along(Vec3::Z) && !self.place.begins,
        };
        if is_level && is_along(axis) {
            // Z that comes down while nobody knows X and Y has room above all cuts alone, and as high as the source ever goes.
            let z_last = self.machine.approach.last().is_some_and(|group| group == "Z");
            if !z_last && !self.is_free(pose.point(), axis) {
                return self.in_groups(pose, stop, ["XY", "Z"]);
            }
            return self.in_groups(pose, stop, in_order);
        }
        let entry = self.entry(pose, &ups, is_level)?;
        let Entry { above, beyond } = self.entry_as_written(entry, stop)?;
        if is_level {
            self.in_groups(&beyond, stop, in_order)?;
        } else {
            self.in_groups(&above, stop, ["XYZ"])?;
            self.in_groups(&beyond, stop, ["XYZ"])?;
        }
        match self.has_straight_rapids() || is_along(axis) || beyond == *pose {
            true => self.in_groups(pose, stop, ["XYZ"]),
            false => self.by_feed(pose, stop),
        }
    }

    /// A position in blocks that name these axes, one after the other.
    fn in_groups<'g>(
        &mut self,
        pose: &Pose,
        stop: &Stop,
        groups: impl IntoIterator<Item = &'g str>,
    ) -> Outcome {
        for group in groups {
            self.aim(pose, stop);
            let words = group.chars().filter_map(|c| WordName::named(c.encode_utf8(&mut [0; 4])));
            let group: Words = words.collect();
            let length = bit(WordName::H) | bit(WordName::Length);
            let held = if group.has(WordName::Z) { Words::NONE } else { length };
            self.writer.unset((POSITION & !group) | held);
            if self.writer.changes(POSITION | ORIENTATION) {
                self.writer.code(WordName::Motion, motion::RAPID);
                self.keep_compensation();
                let begins = std::mem::take(&mut self.place.begins);
                if begins {
                    self.say_length_offset();
                }
                self.block(if begins { BlockName::ToolCenterOn } else { BlockName::Rapid })?;
            }
            self.writer.unset(Words::ALL);
        }
        self.position.locate();
        self.position.go_to(*pose);
        self.check_limits()
    }

    /// Where +Z of the machine points on the part with the tool along `axis`: in both ways, where the control chooses.
    fn ups(&self, axis: Vec3, stop: &Stop) -> Vec<Vec3> {
        let machine = self.machine;
        if machine.rotary.iter().all(|rotary| rotary.on == Mount::Head) {
            return vec![Vec3::Z];
        }
        if machine.rotary.iter().all(|rotary| rotary.on == Mount::Table) {
            return vec![axis];
        }
        self.solutions(axis, stop).into_iter().map(|degrees| machine.up_at(degrees)).collect()
    }

    /// Degrees of A, B, C with the tool along `axis`: both solutions, where the control chooses.
    fn solutions(&self, axis: Vec3, stop: &Stop) -> Vec<[f64; 3]> {
        match stop.step {
            Some(step) => vec![self.written(step.degrees)],
            None if self.machine.rotary.is_empty() => vec![[0.0; 3]],
            None => self.inverse.solve(axis).map_or(Vec::new(), |all| all.degrees.to_vec()),
        }
    }

    /// Z goes home from here, straight up: a tilted tool first goes out along its axis, until it is beyond all cuts on its
    /// way up until it is above them.
    pub(crate) fn go_out(&mut self) -> Outcome {
        let Some(here) = self.position.known() else { return Ok(()) };
        if self.machine.rotary.iter().all(|rotary| rotary.on == Mount::Table) {
            return self.draw_back();
        }
        let (mode, degrees) = (self.machine.orientation.positioned, self.place.degrees());
        let step = degrees.map(|degrees| Step { degrees, rewind: None });
        let stop = Stop { mode, turning: false, first: false, step };
        let (axis, mut out) = (here.axis(), 0.0_f64);
        for up in self.ups(axis, &stop) {
            out = out.max(self.way_out(&here, up)?);
        }
        if out <= 0.0 {
            return Ok(());
        }
        let outside = here.at(here.point() + axis * out)?;
        match self.has_straight_rapids() {
            true => self.rapid_out(&outside),
            false => self.by_feed(&outside, &stop),
        }
    }

    /// How far the tool has to go out along its axis from `pose`, so that it may then go along `up`, mm.
    fn way_out(&mut self, pose: &Pose, up: Vec3) -> Result<f64, Box<Diagnostic>> {
        let (tip, axis) = (pose.point(), pose.axis());
        if same(axis, up) {
            return Ok(0.0);
        }
        let rise = axis.dot(up);
        let below = self.below(pose, up)?;
        if below <= 0.0 {
            return Ok(0.0);
        }
        let inside = (self.free_from(axis) - tip.dot(axis)).max(0.0);
        let hangs = (-rise).max(0.0);
        Ok(if rise >= STEEP {
            below / rise
        } else if rise > 0.0 {
            inside.min(below / rise)
        } else {
            (inside + hangs * below) / (1.0 - hangs * hangs)
        })
    }

    /// How far the whole tool at `pose` is below where it may leave the way of the source along `up`, mm.
    ///
    /// # Errors
    /// A tool that points down, whose length nobody says, or next to which there is no room.
    fn below(&mut self, pose: &Pose, up: Vec3) -> Result<f64, Box<Diagnostic>> {
        let rise = pose.axis().dot(up);
        let hangs = if rise < -LEVEL { -rise } else { 0.0 };
        let Some(length) = self.tool_length().or((hangs == 0.0).then_some(0.0)) else {
            let message = "the tool points down, and how far it hangs there nobody says: its length is missing";
            return Err(refuse(Rule::ToolLength, message)
                .help(Unsaid::ToolLength.way_out())
                .into());
        };
        let below = self.free_from(up) + hangs * length - pose.point().dot(up);
        let below = if below > NOISE { below } else { 0.0 };
        if below > 0.0 && hangs > NEARLY_DOWN {
            let message = "the tool points down along Z of the machine: from home it reaches no position next to the part";
            let help = "another set-up, in which it points to the side or up";
            return Err(refuse(Rule::RapidPath, message).help(help).into());
        }
        Ok(below)
    }

    /// How far a steep tool at `pose` has to go out along its axis to be as high along Z as the source ever goes, mm: the places that are as
    /// high along it as the highest lie on a slope, which reaches into a pocket far from there.
    fn below_top(&mut self, pose: &Pose) -> f64 {
        let (z, rise) = (pose.point().z, pose.axis().z);
        let low = self.top_along(Vec3::Z) - z;
        if rise >= STEEP && low > NOISE { low / rise } else { 0.0 }
    }

    /// Holds home, where its place is known, above all that the source cuts: a table swings the part up to it.
    ///
    /// # Errors
    /// `home-height`.
    fn home_clears(&mut self, axis: Vec3, stop: &Stop) -> Outcome {
        let (machine, length) = (self.machine, self.tool_length());
        let home = machine.safe_height.unwrap_or(machine.linear[2].max);
        let (Some(zero), Some(measured)) = (machine.work_zero, length) else { return Ok(()) };
        if !home.is_finite() {
            return Ok(());
        }
        let top = Vec3::new(0.0, 0.0, home - measured - zero.z);
        for degrees in self.solutions(axis, stop) {
            if machine.unsaid(degrees, length).is_some() {
                continue;
            }
            let up = machine.up_at(degrees);
            let hangs = (-axis.dot(up)).max(0.0) * measured;
            let clearance = machine.capabilities.rapid_clearance + ROUNDING;
            let needed = self.cut_reach(up) + clearance + hangs;
            let short = needed - machine.forward(top, degrees, measured).0.dot(up);
            if short > 0.0 {
                let message = format!(
                    "with Z home at {home} mm the tool, {measured} mm long, is {short:.3} mm short of {clearance} mm above \
                     all cuts: so far up do the rotary axes bring the part"
                );
                let help = "a shorter tool, a part nearer to the rotary axes, or the `safe_height` and `work_zero` that the machine has";
                return Err(refuse(Rule::HomeHeight, message).help(help).into());
            }
        }
        Ok(())
    }

    /// By which places the tool comes from home to `pose` where it does not stand along Z of the machine, or Z of the
    /// program does not.
    ///
    /// # Errors
    /// A tool that points up, whose length nobody says.
    fn entry(
        &mut self,
        pose: &Pose,
        ups: &[Vec3],
        is_level: bool,
    ) -> Result<Entry, Box<Diagnostic>> {
        let (tip, axis) = (pose.point(), pose.axis());
        let mut entry = Entry { above: *pose, beyond: *pose };
        let mut farthest = 0.0;
        for &up in ups {
            let rise = axis.dot(up);
            let (below, low) = (self.below(pose, up)?, self.below_top(pose));
            if below.max(low) <= 0.0 {
                continue;
            }
            let hangs = if rise < -LEVEL { -rise } else { 0.0 };
            let inside = (self.free_from(axis) - tip.dot(axis)).max(0.0);
            let (out, climb) = if rise >= STEEP || is_level && rise > 0.0 && below / rise <= inside
            {
                ((below / rise).max(low), 0.0)
            } else {
                let out = ((inside + hangs * below) / (1.0 - hangs * hangs)).max(low);
                (out, (below - out * rise).max(0.0))
            };
            if out + climb > farthest {
                farthest = out + climb;
                let beyond = tip + axis * out;
                entry = Entry { above: pose.at(beyond + up * climb)?, beyond: pose.at(beyond)? };
            }
        }
        Ok(entry)
    }

    /// The places of `entry`, farther out where the words of the rotary axes lean the tool so that it is lower along itself than where it
    /// may come from home: the rounding of an angle, far from the highest place of the source, is more than that of a length.
    fn entry_as_written(&mut self, entry: Entry, stop: &Stop) -> Result<Entry, Box<Diagnostic>> {
        let machine = self.machine;
        let tables = machine.rotary.iter().all(|rotary| rotary.on == Mount::Table);
        let Some(step) = stop.step.filter(|_| tables) else { return Ok(entry) };
        let written = machine.axis_at(self.written(step.degrees));
        let resolution = machine.resolution();
        let tip = (entry.above.point() / resolution).round() * resolution;
        if self.free_from(written) - tip.dot(written) <= USED * resolution {
            return Ok(entry);
        }
        let out = |pose: Pose| pose.at(pose.point() + pose.axis() * ROUNDING);
        Ok(Entry { above: out(entry.above)?, beyond: out(entry.beyond)? })
    }

    /// Writes the rapid that has been aimed.
    fn rapid_block(&mut self) -> Outcome {
        if !self.writer.changes(POSITION | ORIENTATION) {
            self.writer.unset(Words::ALL);
            return Ok(());
        }
        self.check_limits()?;
        self.compensate()?;
        self.writer.code(WordName::Motion, motion::RAPID);
        self.block(self.straight(BlockName::Rapid))?;
        self.follow(true)
    }

    fn in_pieces(&mut self, pose: &Pose, poses: &[RotaryPose]) -> Outcome {
        self.switch_plane(pose.axis())?;
        for piece in poses {
            self.aim_at(piece.tip, Vec3::Z, Some(piece.degrees));
            self.rapid_block()?;
        }
        self.position.go_to(*pose);
        let message =
            "rapids while axes turn are written in pieces, so that the tool goes straight";
        self.findings.warn(Diagnostic::warning(Rule::RapidPath, message).line(self.line));
        Ok(())
    }

    /// The warning about rapids that are written by feed, with the time that they take.
    pub(crate) fn slow_rapids(&self) -> Option<Diagnostic> {
        let ByFeed { count, line, length } = self.by_feed;
        let feed = self.known_feed().filter(|_| count > 0)?;
        let time = match 60.0 * length / feed {
            seconds if seconds < 60.0 => format!("{seconds:.0} s"),
            seconds => format!("{:.1} min", seconds / 60.0),
        };
        let message = format!(
            "rapids near the part are written with a feed of {feed} mm/min: each axis of the machine goes at its own speed \
             by rapid; together {:.2} m, {time}",
            length / 1000.0
        );
        let help = match self.machine.settings.high_feed {
            Some(_) => RAPID_PATH_HELP.to_owned(),
            None => format!(
                "`high_feed` (mm/min) in [settings] gives them a feed of their own; {RAPID_PATH_HELP}"
            ),
        };
        let mut found = Diagnostic::warning(Rule::RapidPath, message).help(help).line(line);
        found.count = count;
        Some(found)
    }

    fn by_feed(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        let Some(feed) = self.known_feed() else {
            let message = "a rapid near the part, where each axis of the machine goes at its own speed, and no feed is known \
                           by which it could be written instead";
            let help = format!("`high_feed` (mm/min) in [settings] says one; {RAPID_PATH_HELP}");
            return Err(refuse(Rule::RapidPath, message).help(help).into());
        };
        let by_feed = &mut self.by_feed;
        by_feed.count = by_feed.count.saturating_add(1);
        if by_feed.count == 1 {
            by_feed.line = self.line;
        }
        by_feed.length += self.position.distance(pose.point());
        let wanted = self.wanted.set_feed(Some(Feed::PerMinute(feed)));
        let done = self.line_to(pose, stop);
        self.wanted.set_feed(wanted);
        done
    }

    fn by_home(&mut self, pose: &Pose, stop: &Stop) -> Outcome {
        self.turn(pose.axis(), stop)?;
        self.approach(pose, stop)
    }

    /// Whether the axes go together in a rapid as the control stands.
    fn has_straight_rapids(&self) -> bool {
        let keeps_tip = matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors);
        let machine = self.machine;
        machine.has_straight_rapids() || keeps_tip && machine.capabilities.straight_tip_rapids
    }

    /// Whether rotary axes turn that the program names.
    fn turns(&self, stop: &Stop) -> bool {
        let (Kind::ToolCenter | Kind::Machine, Some(step)) = (&self.place.kind, stop.step) else {
            return false;
        };
        self.place.degrees().is_some_and(|degrees| self.written(step.degrees) != degrees)
    }

    /// Whether the tool is free of the part while the control turns it along a vector on the way from `from` to `to`, if
    /// it does.
    fn vector_is_free(&mut self, from: &Pose, to: &Pose) -> bool {
        let (a, b) = (from.axis(), to.axis());
        if same(a, b) {
            return true;
        }
        let count = (angle_between(a, b).to_degrees() / SAMPLE).ceil().max(8.0) as usize;
        (0..=count).all(|i| {
            let part = i as f64 / count as f64;
            self.is_free(from.point().lerp(to.point(), part), between(a, b, part))
        })
    }

    /// How a rapid from `from` to `to` is written; `is_straight` where the source goes straight.
    fn course(
        &mut self,
        from: &Pose,
        to: &Pose,
        stop: &Stop,
        is_straight: bool,
    ) -> Result<RapidMoves, Box<Diagnostic>> {
        let machine = self.machine;
        let linear = self.has_straight_rapids() || machine.wire.is_some();
        match (self.turns(stop), linear) {
            (true, false) => return Ok(RapidMoves::Home),
            (false, true) => return Ok(RapidMoves::AtOnce),
            (false, false) => return self.one_axis_at_a_time(from, to),
            (true, true) => {}
        }
        let (Some(step), Some(degrees)) = (stop.step, self.place.degrees()) else {
            return Ok(RapidMoves::AtOnce);
        };
        let here = RotaryPose { tip: from.point(), degrees };
        let there = RotaryPose { tip: to.point(), degrees: self.written(step.degrees) };
        let length = self.tool_length();
        let own = matches!(self.place.kind, Kind::Machine);
        if own
            && (machine.unsaid(degrees, length).or(machine.unsaid(there.degrees, length))).is_some()
        {
            // What its position depends on is asked for where the block is written.
            return Ok(RapidMoves::AtOnce);
        }
        let most = (0..3).map(|i| (there.degrees[i] - degrees[i]).abs()).fold(0.0, f64::max);
        let count = (most / SAMPLE).ceil().max(8.0) as usize;
        let measured = length.unwrap_or(0.0);
        let ends = [here, there].map(|end| machine.linear_for(end.tip, end.degrees, measured));
        let corridor = USED * machine.capabilities.rapid_corridor;
        let (mut at_once, mut in_pieces) = (true, true);
        let mut before = (true, true);
        for i in 0..=count {
            let part = i as f64 / count as f64;
            let degrees = [0, 1, 2].map(|k| degrees[k] + (there.degrees[k] - degrees[k]) * part);
            let axis = machine.axis_at(degrees);
            let on_way = from.point().lerp(to.point(), part);
            let tip = match own {
                true => machine.forward(ends[0].lerp(ends[1], part), degrees, measured).0,
                false => on_way,
            };
            let aligned = is_straight && off_great_circle(from.axis(), to.axis(), axis) <= SWING;
            let near = nearest_on_segment(from.point(), to.point(), tip).1 <= corridor;
            let is_free = match is_straight && near {
                true => self.is_beyond(tip, axis),
                false => self.is_free(tip, axis),
            };
            let keeps = (aligned && near, is_free);
            // Also between two places, for the same reason at both.
            at_once &= keeps.0 && before.0 || keeps.1 && before.1;
            before = keeps;
            in_pieces &= own && aligned;
        }
        if at_once {
            return Ok(RapidMoves::AtOnce);
        }
        if in_pieces {
            let poses = machine.linearise(here, there, length, corridor)?;
            if poses.len() <= MOST_PIECES {
                return Ok(RapidMoves::Pieces(poses.collect()));
            }
        }
        Ok(RapidMoves::Home)
    }

    /// How a rapid is written while no axis turns, and each goes at its own speed: anywhere in the box between the ends.
    fn one_axis_at_a_time(
        &mut self,
        from: &Pose,
        to: &Pose,
    ) -> Result<RapidMoves, Box<Diagnostic>> {
        let axis = to.axis();
        let degrees = match &self.place.kind {
            Kind::Bare | Kind::Plain => Some([0.0; 3]),
            Kind::ToolCenter | Kind::Machine => self.place.degrees(),
            Kind::Tilted(..) | Kind::Vectors => None,
        };
        let Some(degrees) = degrees.filter(|_| same(from.axis(), axis)) else {
            return Ok(RapidMoves::Feed);
        };
        let corridor = USED * self.machine.capabilities.rapid_corridor;
        let machine = self.machine;
        let wandering = |a, b| machine.wandering(a, b, degrees);
        let is_straight =
            |a, b| wandering(a, b).iter().all(|tip| nearest_on_segment(a, b, *tip).1 <= corridor);
        let (a, b) = (from.point(), to.point());
        let corner = corner(a, b, axis);
        let (legs, goes_up) = ([(a, corner), (corner, b)], (b - a).dot(axis) > 0.0);
        let [along, across] = if goes_up { legs } else { [legs[1], legs[0]] };
        let mut are_free = |(a, b)| self.are_free(&wandering(a, b), [from, to]);
        Ok(if is_straight(a, b) || are_free((a, b)) {
            RapidMoves::AtOnce
        } else if is_straight(along.0, along.1) && are_free(across) {
            RapidMoves::Corner(to.at(corner)?)
        } else {
            RapidMoves::Feed
        })
    }

    /// Whether the tool may go by these places off the straight way between two poses, where it does not turn: they are beyond all cuts,
    /// and, since a hole or a pocket may be around the tool, not below the higher end, nor below the floor.
    fn are_free(&mut self, tips: &[Vec3], ends: [&Pose; 2]) -> bool {
        let axis = ends[1].axis();
        let heights = ends.map(|end| end.point().dot(axis));
        let floor = heights[0].max(heights[1]).max(self.floor(axis)) - ROUNDING;
        tips.iter().all(|tip| tip.dot(axis) >= floor && self.is_beyond(*tip, axis))
    }

    /// Below which height along `axis` axes that go each at its own speed may be in a hole or a pocket, mm: where the source goes highest
    /// along it; of a tool along Z the zero of the part, where the source goes above it.
    fn floor(&mut self, axis: Vec3) -> f64 {
        let top = self.top_along(axis);
        if same(axis, Vec3::Z) { top.min(0.0) } else { top }
    }

    /// From how far along `axis` on the tool may leave the way of the source, mm: it is as high along it as the source ever goes, and beyond
    /// all cuts.
    fn free_from(&mut self, axis: Vec3) -> f64 {
        let clearance = self.machine.capabilities.rapid_clearance + ROUNDING;
        (self.cut_reach(axis) + clearance).max(self.top_along(axis))
    }

    /// Whether the tool may leave the way of the source there.
    fn is_free(&mut self, tip: Vec3, axis: Vec3) -> bool {
        let is_high = axis.z < STEEP || tip.z >= self.top_along(Vec3::Z) - NOISE;
        is_high && tip.dot(axis) >= self.free_from(axis) - NOISE
    }

    /// Whether the tool is beyond all cuts along its axis.
    fn is_beyond(&mut self, tip: Vec3, axis: Vec3) -> bool {
        let clearance = self.machine.capabilities.rapid_clearance + ROUNDING;
        tip.dot(axis) >= self.cut_reach(axis) + clearance
    }
}

/// Where a tool along `axis` (a unit vector) turns on its way: above `from` at the height of `to`, or above `to` at the
/// height of `from`, whichever is higher.
pub(crate) fn corner(from: Vec3, to: Vec3, axis: Vec3) -> Vec3 {
    let height = (to - from).dot(axis);
    if height > 0.0 { from + axis * height } else { to - axis * height }
}
