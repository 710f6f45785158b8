//! Rapids, excursions from the path of a cut, home positions, and the way out at the end.

use super::*;
use program::{Axes, Rule};

impl Prover<'_> {
    /// A move while the source goes by rapid.
    pub(super) fn rapid(&mut self, motion: MotionKind, to: &ResolvedPose) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        if motion == MotionKind::Feed {
            let from_a_place = self.here.place.known() && goal.from.is_some();
            let straight = self.gauge.straight_rapids;
            if !straight && self.goes_along_tool(to) {
                return self.along_tool_by_feed(to);
            }
            if !straight && from_a_place && self.progress.stops.is_empty() {
                return self.rapid_by_feed(to);
            }
            return Err(match self.nearest_stop() {
                Some(stop) => self.lost_at(stop.line, Rule::EndPoint, &self.not_reached(&stop)),
                None => {
                    self.lost_at(to.line, Rule::RapidFeed, "feeds where the source goes by rapid")
                }
            });
        }
        if self.gauge.at(to, &goal.to) {
            let slack = self.gauge.slack(to);
            let across = goal.from.is_none_or(|from| from.is_across(goal.to.tip, slack));
            // What is switched off is off from the first straight move on, before the tool comes down.
            let off = self.cursor.wanted.compensation == Compensation::Off;
            self.check_compensation(to.line, across && off, false);
            self.approached(to)?;
            self.arrive(to);
            return Ok(());
        }
        match self.goes_on_the_way(to) || self.begins_above(to) {
            true => Ok(()),
            false => self.stop_at(to),
        }
    }

    /// Whether a feed in place of a rapid goes along the tool, away from the part or down to where the source goes, and on no way of the
    /// source.
    fn goes_along_tool(&self, to: &ResolvedPose) -> bool {
        let Step::Move(goal) = &self.cursor.step else { return false };
        let gauge = &self.gauge;
        let is_on_way = goal.from.is_some()
            && self.progress.stops.is_empty()
            && line::follow(gauge, goal, self.progress.t, &self.here, to).is_ok();
        let is_down = gauge.at(to, &goal.to) && stops::lifted(gauge, to, &self.here);
        !is_on_way && (is_down || stops::lifted(gauge, &self.here, to))
    }

    /// The way along the tool by feed, which is straight where a rapid of the machine is not: before home, or from above all cuts.
    fn along_tool_by_feed(&mut self, to: &ResolvedPose) -> Outcome {
        self.check_air_feed(to.line);
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        if !self.gauge.at(to, &goal.to) {
            return self.stop_at(to);
        }
        self.approached(to)?;
        self.arrive(to);
        Ok(())
    }

    /// Holds a feed in place of a rapid to one that counts in the air.
    pub(super) fn check_air_feed(&mut self, line: u32) {
        if !matches!(self.running.feed, Some(Feed::PerMinute(feed)) if feed > 0.0) {
            self.differs(line, (Rule::Feed, "no feed in mm/min is set".into()));
        }
        self.check(line, state::fed_rapid_corners(&self.gauge.corners, &self.running));
    }

    /// Whether a move away along the tool, before home, is by rapid, or by feed where rapids are not straight.
    pub(super) fn lifts(&self, motion: MotionKind, to: &ResolvedPose) -> bool {
        let is_straight = motion == MotionKind::Rapid || !self.gauge.straight_rapids;
        is_straight && stops::lifted(&self.gauge, &self.here, to)
    }

    /// A rapid of the source by feed, which is straight where a rapid of the machine is not.
    fn rapid_by_feed(&mut self, to: &ResolvedPose) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let Followed { t, .. } = line::follow(&self.gauge, goal, self.progress.t, &self.here, to)
            .map_err(|how| {
            let message =
                format!("goes to {} and {how}; the source goes to {} by rapid", to.place, goal.to);
            self.lost_at(to.line, Rule::Path, &message)
        })?;
        let done = self.gauge.at(to, &goal.to);
        self.progress.t = t;
        self.check_air_feed(to.line);
        if done {
            self.approached(to)?;
            self.arrive(to);
        }
        Ok(())
    }

    /// Whether a rapid has come to a place on the straight way of the source, and not back. Before a tool change and home no
    /// place is on it: the way begins behind them.
    fn goes_on_the_way(&mut self, to: &ResolvedPose) -> bool {
        if matches!(&self.cursor.step, Step::Move(goal) if goal.tool_change || goal.homed) {
            return false;
        }
        let goes_on =
            |(t, length): &(f64, f64)| (self.progress.t - t) * length <= self.gauge.slack(to);
        let on_the_way = self.on_the_way(to).filter(|_| self.progress.stops.is_empty());
        let Some((t, _)) = on_the_way.filter(goes_on) else { return false };
        self.progress.t = t;
        self.progress.start = Some(*to);
        true
    }

    /// Keeps a stop of a rapid until its end explains it.
    pub(super) fn stop_at(&mut self, to: &ResolvedPose) -> Outcome {
        if self.progress.stops.len() >= MOST_STOPS {
            let stop = self.nearest_stop().unwrap_or(*to);
            return Err(self.lost_at(stop.line, Rule::EndPoint, &self.not_reached(&stop)));
        }
        self.progress.stops.push(*to);
        Ok(())
    }

    /// Holds the offsets in a rapid to a known height: by another length, or in another work offset, the tool goes elsewhere. Where it
    /// comes to what the source has next, the comparison there asks for more.
    pub(super) fn check_offsets(&mut self, to: &ResolvedPose) {
        if to.position.point.z.is_nan() || self.gauge.machine.wire.is_some() {
            return;
        }
        let offset_changed = std::mem::take(&mut self.running.offset_changed) && !self.raised;
        let found = state::on_the_way(self.gauge.machine, &self.cursor.wanted, &self.running);
        if offset_changed && found.is_none() {
            let message = "goes on in another work offset where Z has not been home: how high the tool stands there, nobody knows";
            self.differs(to.line, (Rule::Home, message.into()));
        }
        self.check(to.line, found);
    }

    /// Compares tool and offsets with those of the source, and keeps offsets that are right.
    pub(super) fn check_set_up(&mut self, line: u32) {
        let found = state::set_up(self.gauge.machine, &self.cursor.wanted, &self.running);
        if found.is_none() {
            self.running.last_offsets =
                Some((self.running.work_offset, self.running.length_offset));
        }
        self.check(line, found);
    }

    /// Explains the stops of a rapid that has come to its end.
    pub(super) fn approached(&mut self, to: &ResolvedPose) -> Outcome {
        // What is wrong on the way has been said.
        let machine = self.gauge.machine;
        if state::on_the_way(machine, &self.cursor.wanted, &self.running).is_none() {
            self.check_set_up(to.line);
        }
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let free = goal.free(self.gauge.allowed.axis_degrees);
        if goal.homed && !self.progress.homed {
            let message = "does not go home in Z before this, as the source does";
            return Err(self.lost_at(to.line, Rule::Home, message));
        }
        if self.progress.stops.is_empty() {
            return Ok(());
        }
        let start = self.progress.start.unwrap_or(self.here);
        match stops::explain(&self.gauge, &start, &self.progress.stops, to, free) {
            Ok(retract) => {
                if self.progress.homed && !free || retract.left_mm > 0.0 && retract.came_mm > 0.0 {
                    self.note_excursion(to, retract.left_mm);
                }
                Ok(())
            }
            Err(stop) => {
                let message = format!(
                    "stops by rapid at {}, on no way axis by axis to {}",
                    stop.place, to.place
                );
                Err(self.lost_at(stop.line, Rule::RapidStop, &message))
            }
        }
    }

    /// A move off the path of a cut, or back to it.
    pub(super) fn excursion(&mut self, motion: MotionKind, to: &ResolvedPose) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let Some(left) = self.progress.left else {
            if goal.from.is_none() {
                return self.stop_at(to);
            }
            if self.gauge.at(to, &goal.to) || !stops::lifted(&self.gauge, &self.here, to) {
                let message = "goes by rapid where the source feeds";
                return Err(self.lost_at(to.line, Rule::RapidFeed, message));
            }
            if motion == MotionKind::Feed {
                self.check_air_feed(to.line);
            }
            self.progress.left = Some(self.here);
            return self.stop_at(to);
        };
        if motion == MotionKind::Feed && goal.tool_change && !self.here.place.known() {
            return self.cut_from_nowhere(to, None);
        }
        if self.gauge.meet(to, &left) {
            let last = self.progress.stops.last().copied().unwrap_or(left);
            if !self.comes_down(&last, to) {
                return Err(self.lost_at(
                    to.line,
                    Rule::Excursion,
                    "comes back, but not along the tool axis",
                ));
            }
            let retract = stops::explain(&self.gauge, &left, &self.progress.stops, to, true)
                .map_err(|stop| {
                    let message = format!("stops by rapid at {}, away from the path", stop.place);
                    self.lost_at(stop.line, Rule::RapidStop, &message)
                })?;
            self.note_excursion(to, retract.left_mm);
            self.progress.left = None;
            self.progress.homed = false;
            self.progress.stops.clear();
            return Ok(());
        }
        if motion == MotionKind::Feed {
            let line = self.progress.stops.first().map_or(to.line, |stop| stop.line);
            let message = "leaves the cut by rapid and does not come back to where it left";
            return Err(self.lost_at(line, Rule::RapidFeed, message));
        }
        self.stop_at(to)
    }

    /// Whether the last move of an excursion goes along the tool axis, towards the part.
    pub(super) fn comes_down(&self, last: &ResolvedPose, to: &ResolvedPose) -> bool {
        if last.place.known() {
            return stops::lifted(&self.gauge, to, last);
        }
        // From home only Z is left to go.
        let (a, b) = (last.position.point, to.position.point);
        (a.x - b.x).abs() <= 1e-6
            && (a.y - b.y).abs() <= 1e-6
            && last.position.orientation == to.position.orientation
    }

    pub(super) fn note_excursion(&mut self, to: &ResolvedPose, lift_mm: f64) {
        let first = self.progress.stops.first().map_or(to.line, |stop| stop.line);
        self.report.excursion(Excursion {
            source_line: self.cursor.line,
            program_file: None,
            first_program_line: first,
            last_program_line: to.line,
            lift_mm,
        });
    }

    /// Axes sent to positions in machine coordinates: where the machine's file says that they are safe, that is a
    /// home position.
    pub(super) fn machine_move(&mut self, line: u32, to: &MachineMove) -> Outcome {
        if let Some(found) = self.gauge.machine.unsafe_position(to) {
            let message = format!("{}{}", SourceLine(self.cursor.line), found.message);
            return Err(Diagnostic { message, ..found }.line(line).into());
        }
        self.home(line, to.axes())
    }

    /// Whether a rapid goes up along Z alone, no less high than the `retract_height` of a machine without switches, and not to where
    /// the source goes.
    pub(super) fn retracts(&self, to: &Position) -> bool {
        let machine = self.gauge.machine;
        let Some(height) = self.retract_height else { return false };
        let (from, at) = (self.here.position.point, to.point);
        let same = |a: f64, b: f64| (a - b).abs() <= SAME || a.is_nan() && b.is_nan();
        // Where the tool stands there already, it counts before a stop, a tool and the end alone. Any other rapid that goes as high is
        // one of the source, or on its way, or of a hole.
        let stands = *to == self.here.position;
        let ends = self.stops_next()
            || self.cursor.at_tool_change()
            || matches!(self.cursor.step, Step::End);
        let goal = if let Step::Move(goal) = &self.cursor.step { Some(goal) } else { None };
        let begins = goal.is_some_and(|goal| goal.from.is_none() || goal.tool_change || goal.homed);
        let is_sources =
            || goal.is_some_and(|goal| self.gauge.at(&self.gauge.resolve(0, *to), &goal.to));
        at.z >= height - machine.resolution() / 2.0
            && (ends || begins && !stands)
            && (if from.z.is_nan() { self.top } else { from.z }) <= at.z + SAME
            && same(from.x, at.x)
            && same(from.y, at.y)
            && !is_sources()
    }

    /// A machine without switches waits for the operator before it first moves: its Z is where it was switched on until a tool has
    /// set it. One with a touch plate waits before it first leaves home: no table knows how long its first tool is.
    pub(super) fn awaits_set_up(&mut self, event: &Event) {
        let homes = matches!(event.action, Action::Home(_) | Action::MachineMove(_));
        let moves = matches!(event.action, Action::Probe(_)) || event.action.position().is_some();
        let why = if self.retract_height.is_some() && (homes || moves) {
            "the machine has no switches"
        } else if self.plate.is_some() && moves {
            "the machine has a touch plate, and no table of tools that are measured"
        } else {
            self.is_set_up |= event.action == Action::Stop;
            return;
        };
        if !self.is_set_up {
            let message = format!(
                "moves before it has stopped for the operator to fit the tool and set Z 0 with it: {why}"
            );
            self.differs(event.line, (Rule::Stop, message));
        }
        self.is_set_up = true;
    }

    /// A retract to the `retract_height`, which is home on a machine without switches: above all that the source cuts.
    pub(super) fn retract(&mut self, line: u32, to: &Position) -> Outcome {
        let to = self.gauge.resolve(line, *to);
        self.top = to.position.point.z;
        self.check_offsets(&to);
        self.hold_travel(&to, None);
        let short = self.beyond_cuts(Vec3::Z) - to.place.tip.z;
        if short > self.gauge.machine.resolution() {
            let message = format!(
                "{}the program retracts to Z{}, {} mm short of {} mm above all that the source cuts",
                SourceLine(self.cursor.line),
                Number(to.position.point.z),
                Number(short),
                Number(self.gauge.machine.capabilities.rapid_clearance)
            );
            let help = "a higher `retract_height` in [options] of the machine's file, or --option retract_height=MM";
            self.found(Diagnostic::error(Rule::HomeHeight, message).help(help).line(line));
        }
        self.home(line, Axes::Z)
    }

    /// Axes sent to a fixed position.
    pub(super) fn home(&mut self, line: u32, axes: Axes) -> Outcome {
        self.turns(line, [0, 1, 2].map(|i| axes.contains(Axes::rotary(i))));
        self.check_contact(line, None);
        let axis_degrees = self.gauge.allowed.axis_degrees;
        self.pass_left_out(|goal| goal.free(axis_degrees));
        let (first, free, holding) = match &self.cursor.step {
            Step::Move(goal) => {
                let free = goal.free(axis_degrees) && self.progress.left.is_none();
                (
                    goal.from.is_none() && !goal.homed,
                    free,
                    matches!(goal.kind, Kind::Line | Kind::Arc(_)),
                )
            }
            Step::Dwell(_)
            | Step::Stop
            | Step::OptionalStop
            | Step::ThreadWire
            | Step::CutWire
            | Step::Output(_)
            | Step::Input(_)
            | Step::Auxiliary(_)
            | Step::WorkOffsetData(_)
            | Step::Unproven(_)
            | Step::End => (false, true, false),
        };
        let z = axes.contains(Axes::Z);
        let is_up = self.here.position.point.z.is_nan();
        let retracted = is_up || self.progress.homed;
        if !first && !retracted && !z {
            return Err(self.lost_at(
                line,
                Rule::Home,
                "sends axes home before the tool is retracted",
            ));
        }
        let up = axes == Axes::Z && (is_up || self.hangs_down() || self.clear_of_part());
        if !first && !free && (!up || self.progress.hole.over) {
            return Err(self.lost_at(
                line,
                Rule::Home,
                "sends axes home in the middle of the work",
            ));
        }
        let along = !first && !retracted && axes != Axes::Z;
        if along && !self.clear_of_part() {
            let message = "sends axes home together with Z, not after it, next to the part";
            return Err(self.lost_at(line, Rule::Home, message));
        }
        // At the start nobody knows how high the tool stands, nor what is between it and home.
        let starts = !self.raised && !self.has_stood;
        let sideways = axes.contains(Axes::X) || axes.contains(Axes::Y);
        if along || starts && sideways {
            let message = if z {
                "Z goes home together with other axes, not before them"
            } else {
                "X or Y goes home before Z, as high as the tool stands"
            };
            self.report.warn(Diagnostic::warning(Rule::Home, message).line(line));
        }
        if holding && !first && self.progress.left.is_none() {
            self.progress.left = Some(self.here);
        }
        if z && self.stops_next() && self.here.place.known() {
            self.progress.away.get_or_insert(self.here);
        }
        if z {
            self.leaves_for_home(line);
            self.forget_lifts();
        }
        self.progress.homed |= z;
        self.raised |= z;
        self.over = None;
        let mut pose = self.here.position;
        for i in (0..3).filter(|i| axes.contains(Axes::linear(*i))) {
            pose.point[i] = f64::NAN;
        }
        match &mut pose.orientation {
            Orientation::Axis(axis) if *axis != Vec3::Z => pose.point = Vec3::NAN,
            Orientation::Axis(_) => {}
            Orientation::Rotary { degrees, .. } => {
                for (i, degrees) in degrees.iter_mut().enumerate() {
                    if axes.contains(Axes::rotary(i)) {
                        *degrees = f64::NAN;
                    }
                }
            }
        }
        if (0..3).any(|i| axes.contains(Axes::rotary(i))) {
            self.standing.forget();
        }
        let to = self.gauge.resolve(line, pose);
        if self.progress.left.is_some() {
            self.stop_at(&to)?;
        } else if self.progress.stops.is_empty() {
            // The way begins at home: the height where it left is none of its own any more.
            self.progress.start = Some(to);
        }
        self.here = to;
        Ok(())
    }

    /// Forgets the stops of a rapid on the way to home, where they lead out along the tool axis: the way begins at home.
    fn forget_lifts(&mut self) {
        let base = self.progress.start.unwrap_or(self.here);
        let lifts = |stop: &ResolvedPose| stops::lifted(&self.gauge, &base, stop);
        if self.progress.left.is_none() && self.progress.stops.iter().all(lifts) {
            self.progress.stops.clear();
        }
    }

    /// Whether the tool is beyond every point of the source along its axis, which does not point
    /// down: then Z home is away from all of them.
    pub(super) fn clear_of_part(&mut self) -> bool {
        let PartialPose { tip, axis } = self.here.place;
        let statistics = self.statistics.get_or_insert_with(|| Statistics::of(self.source));
        axis.z >= 0.0 && tip.dot(axis) >= statistics.reach(axis)
    }

    /// Whether the tool hangs along Z of the machine, so that Z home is away from the part.
    pub(super) fn hangs_down(&self) -> bool {
        let machine = self.gauge.machine;
        match self.here.position.orientation {
            _ if machine.rotary.iter().all(|axis| axis.on == Mount::Table) => true,
            Orientation::Rotary { degrees, .. } => {
                let mut heads = machine.rotary.iter().filter(|axis| axis.on == Mount::Head);
                heads.all(|axis| degrees[axis.index()].is_finite()) && !machine.tilts_tool(degrees)
            }
            Orientation::Axis(axis) => {
                machine.rotary.iter().all(|axis| axis.on == Mount::Head) && axis == Vec3::Z
            }
        }
    }

    /// A move after the last motion of the source: away along the tool axis.
    pub(super) fn closing(&mut self, motion: MotionKind, to: &ResolvedPose) -> Outcome {
        if !self.lifts(motion, to) {
            let message = format!("goes to {} after the last motion of the source", to.place);
            return Err(self.lost_at(to.line, Rule::ExtraMotion, &message));
        }
        if motion == MotionKind::Feed {
            self.check_air_feed(to.line);
        }
        Ok(())
    }

    /// Whether a move turns rotary axes alone, while the machine is at home.
    pub(super) fn turns_at_home(&self, to: &ResolvedPose) -> bool {
        let (a, b) = (self.here.position.point, to.position.point);
        b.z.is_nan() && self.progress.homed && (0..3).all(|i| a[i] == b[i] || b[i].is_nan())
    }

    /// The stop that comes nearest to where the source goes.
    pub(super) fn nearest_stop(&self) -> Option<ResolvedPose> {
        let Step::Move(goal) = &self.cursor.step else { return None };
        let far = |stop: &ResolvedPose| {
            let apart = stop.place.tip.distance(goal.to.tip);
            if apart.is_nan() { f64::INFINITY } else { apart }
        };
        self.progress.stops.iter().min_by(|a, b| far(a).total_cmp(&far(b))).copied()
    }

    pub(super) fn not_reached(&self, stop: &ResolvedPose) -> String {
        let Step::Move(goal) = &self.cursor.step else { return String::new() };
        let (tip, axis) = stop.place.apart(&goal.to);
        if tip.is_nan() || axis.is_nan() {
            return format!("goes to {}, and the source goes to {}", stop.place, goal.to);
        }
        format!(
            "goes to {}, but the source goes to {}: {} mm and {}° apart",
            stop.place,
            goal.to,
            Number(tip),
            Number(axis)
        )
    }
}
