//! Cuts: lines and arcs, and what must hold in them.

use super::*;
use program::Rule;

impl Prover<'_> {
    /// A feed move while the source cuts a line or an arc.
    pub(super) fn cut(&mut self, to: &ResolvedPose, block: Option<&Arc>) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let here = self.here;
        if !here.place.known() || goal.from.is_none() {
            return self.cut_from_nowhere(to, block);
        }
        let followed = match (&goal.kind, block) {
            (Kind::Arc(arc), Some(block)) => {
                arc::follow(&self.gauge, arc, goal, self.progress.t, block, &here, to)
            }
            (Kind::Arc(arc), None) => {
                arc::follow_chord(&self.gauge, arc, goal, self.progress.t, &here, to)
            }
            (_, Some(_)) => Err("makes an arc where the source has a line".into()),
            (_, None) => line::follow(&self.gauge, goal, self.progress.t, &here, to),
        };
        let Followed { t, path_mm, axis_degrees, left_mm } = followed.map_err(|how| {
            let message = format!("goes to {} and {how}; the source goes to {}", to.place, goal.to);
            self.lost_at(to.line, Rule::Path, &message)
        })?;
        let (rounding, source) = (self.gauge.slack(to), goal.length());
        let done = self.gauge.at(to, &goal.to) && left_mm <= arc::PAST * rounding;
        // What is left by rounding is not made good by the next cut.
        let way = (if done { 1.0 } else { t } - self.progress.t) * source;
        self.progress.t = t;
        let feed = self.feed_of(to, block.map(Arc::length), way, source);
        self.check_cut(to, feed, block.is_some());
        self.report.deviations.path_mm.note(path_mm, self.cursor.line, to.line);
        self.has_compared((path_mm, axis_degrees));
        if done {
            self.arrive(to);
        }
        Ok(())
    }

    /// A feed move from where the tool is not known: only the first motion, or the first after a tool
    /// change, may be one, and it has to go to the end at once.
    pub(super) fn cut_from_nowhere(&mut self, to: &ResolvedPose, block: Option<&Arc>) -> Outcome {
        let Step::Move(goal) = &self.cursor.step else { return Ok(()) };
        let first = goal.from.is_none() || goal.tool_change;
        let straight = block.is_none() && self.gauge.at(to, &goal.to);
        let start = self.progress.start.unwrap_or(self.here);
        let explained = stops::explain(&self.gauge, &start, &self.progress.stops, to, true).is_ok();
        if !(first && straight && explained) {
            let message = format!(
                "feeds to {} from a place that is not known; the source goes to {}",
                to.place, goal.to
            );
            return Err(self.lost_at(to.line, Rule::UnknownStart, &message));
        }
        let message =
            format!("{}feeds to {} from an unknown place", SourceLine(goal.line), to.place);
        self.report.warn(Diagnostic::warning(Rule::UnknownStart, message).line(to.line));
        let feed = self.feed_by_number();
        self.check_cut(to, feed, false);
        self.arrive(to);
        Ok(())
    }

    /// What is wrong with the feed of a cut to `to` along `way` mm of a move of the source that is `source` mm long; `arc` is
    /// the length of an arc, mm.
    pub(super) fn feed_of(
        &mut self,
        to: &ResolvedPose,
        arc: Option<f64>,
        way: f64,
        source: f64,
    ) -> Option<Difference> {
        let (Some(wanted), Some(running)) = (self.cursor.wanted.feed, self.running.feed) else {
            return self.feed_by_number();
        };
        let (from, path) = (&self.here.position, self.running.feed_path);
        let inverse = [wanted, running].iter().any(|feed| matches!(feed, Feed::InverseTime(_)));
        if !inverse && path.is_of_tip(from, &to.position) {
            self.pace = Pace::default();
            return self.feed_by_number();
        }
        let rounding = self.gauge.slack(to);
        let stands = self.here.place.tip.distance(to.place.tip) <= rounding;
        let is_standing = source <= pace::STANDS;
        let is_timed = matches!(wanted, Feed::InverseTime(_)) && stands && !is_standing;
        if !is_timed && (is_standing || way.abs() <= rounding) {
            let by_number = self.feed_by_number();
            if is_standing || by_number.is_none() {
                // The tool turns about its tip, which has no speed: the number says how fast the axes are.
                return if inverse { None } else { by_number };
            }
        }
        let spindle = self.cursor.wanted.spindle;
        let (gauge, to_position) = (&self.gauge, &to.position);
        let cut = pace::Cut {
            gauge,
            from,
            to: to_position,
            arc,
            path,
            way,
            source,
            rounding,
            wanted,
            running,
            spindle,
            line: self.cursor.line,
            stands: is_timed,
        };
        if is_timed && cut.is_by_number() {
            return None;
        }
        let Compared { percent, is_slowed, difference } = self.pace.add(&cut)?;
        let deviations = &mut self.report.deviations;
        deviations.tip_speed_percent.note(percent.abs(), self.cursor.line, to.line);
        self.report.compared.slowed += usize::from(is_slowed);
        difference
    }

    /// What is wrong with the feed where its number is the speed of the tip.
    pub(super) fn feed_by_number(&self) -> Option<Difference> {
        let (wanted, running) = (&self.cursor.wanted, &self.running);
        let Gauge { machine, allowed, .. } = &self.gauge;
        state::feed(machine, allowed, wanted.feed, running.feed, wanted.spindle)
    }

    /// What must hold in a cut, whose feed has been compared.
    pub(super) fn check_cut(&mut self, to: &ResolvedPose, feed: Option<Difference>, on_arc: bool) {
        let rounding = self.gauge.slack(to);
        self.check_set_up(to.line);
        let (allowed, wanted, running) = (&self.gauge.allowed, &self.cursor.wanted, &self.running);
        let found = [
            state::spindle_and_coolant(allowed, wanted, running),
            state::taper(allowed, wanted, running),
            state::corners(&self.gauge.corners, wanted, running),
            feed,
        ];
        let closer = state::closer_than_asked(&self.gauge.corners, wanted, running);
        let in_plane = to.place.is_across(self.here.place.tip, rounding);
        if let Some(message) = closer {
            let message = format!("{}{message}", SourceLine(self.cursor.line));
            self.report.warn(Diagnostic::warning(Rule::PathMode, message).line(to.line));
        }
        for difference in found {
            self.check(to.line, difference);
        }
        self.check_compensation(to.line, in_plane, on_arc);
    }

    /// Compensation goes on with the first straight cut in the plane at the latest, off with the first
    /// straight move there, and neither on an arc, which has to be as the source wants it.
    pub(super) fn check_compensation(&mut self, line: u32, must: bool, on_arc: bool) {
        let (wanted, is) = (self.cursor.wanted.compensation, self.running.compensation);
        let tool = self.cursor.wanted.tool;
        let switched = state::same_compensation(self.gauge.machine, wanted, is, tool);
        let kept = state::same_compensation(self.gauge.machine, self.compensation, is, tool);
        if switched && (kept || !on_arc) {
            self.compensation = wanted;
        } else if switched {
            self.differs(line, (Rule::Compensation, "compensation is switched on an arc".into()));
        } else if !kept || must {
            let (is, should) = (state::compensation(is), state::compensation(wanted));
            let why = match self.cursor.compensates() {
                true => "",
                false => {
                    ": the source gives the path of the tool's centre, and the control offsets it by the tool once more"
                }
            };
            let message = format!("compensation is {is}, but should be {should}{why}");
            self.differs(line, (Rule::Compensation, message));
        }
    }
}
