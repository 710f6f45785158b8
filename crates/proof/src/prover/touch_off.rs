//! The touch-off of a tool, on a machine whose file describes a plate for it:
//!
//! ```text
//!   Z home ─▶ over the plate ─▶ tool, stop ─▶ G38.2 down ─▶ G10 L20 Z ─▶ Z home ─▶ stop: the plate is taken away
//! ```
//!
//! Where the stop is no tool change (LinuxCNC) the tool comes first, and then over the plate; its length in the tool table is set by `G10 L10`.
//! The first tool is not touched off: the operator sets Z 0 with it.

use super::*;
use machine::TouchPlate;
use program::{Rule, WorkOffset};

/// How far it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Touch {
    /// No tool waits for it.
    #[default]
    Done,
    /// The tool is in, nobody knows how long it is, and the plate is not below it yet.
    Due,
    /// The program has stopped for the plate to be put below it.
    Ready,
    /// It rests on the plate.
    Touching,
    /// Z has been set, the tool still rests on the plate.
    Set,
    /// Z is home, the plate still there.
    Raised,
}

impl Prover<'_> {
    /// A tool is in: the first one has been set up by the operator.
    pub(super) fn awaits_touch_off(&mut self) {
        let is_first = self.report.compared.tool_changes <= 1;
        if self.plate.is_some() && !is_first {
            // A tool that is put in by hand is so at a stop.
            self.touch = if self.running.length_by_word { Touch::Due } else { Touch::Ready };
        }
    }

    /// Whether an event is part of a touch-off alone. What is wrong with it, or missing before another event, is reported.
    pub(super) fn touches_off(&mut self, event: &Event) -> bool {
        let Some(plate) = self.plate else { return false };
        match (self.touch, &event.action) {
            (Touch::Done | Touch::Due, Action::Rapid(to))
                if self.goes_over_plate(event.line, &plate, to) =>
            {
                true
            }
            (Touch::Due, Action::Stop) => {
                self.touch = Touch::Ready;
                false
            }
            (Touch::Ready, Action::Probe(probe)) => {
                self.probes_plate(event.line, &plate, probe);
                self.touch = Touch::Touching;
                true
            }
            (Touch::Touching, Action::TouchOff(height)) => {
                self.sets_height(event.line, &plate, *height);
                self.touch = Touch::Set;
                true
            }
            (Touch::Set, action) if self.leaves_plate(action) => {
                self.touch = Touch::Raised;
                false
            }
            (Touch::Raised, Action::Stop) => {
                self.touch = Touch::Done;
                false
            }
            (touch, action) => {
                if touch != Touch::Done && needs_tool(action) {
                    let what = match touch {
                        Touch::Due if matches!(action, Action::Probe(_)) => {
                            "does not stop for the touch plate to be put below the tool"
                        }
                        Touch::Due | Touch::Ready | Touch::Done => {
                            "goes on with a tool that has not been touched off"
                        }
                        Touch::Touching => {
                            "goes on where the plate has been touched, and does not set Z there"
                        }
                        Touch::Set => "does not go straight up from the touch plate",
                        Touch::Raised => "does not stop for the touch plate to be taken away",
                    };
                    self.differs(event.line, (Rule::Probe, what.into()));
                    self.touch = Touch::Done;
                }
                false
            }
        }
    }

    /// By rapid at home in Z to over the plate, before a tool is changed.
    fn goes_over_plate(&mut self, line: u32, plate: &TouchPlate, to: &Position) -> bool {
        let here = self.here.position;
        let is_up = here.point.z.is_nan() && (to.point.z.is_nan() || to.point.z == self.top);
        let stays = to.orientation == here.orientation;
        if !is_up || !stays || !self.is_over(plate, to.point) || !self.at_tool_change() {
            return false;
        }
        self.hold_travel(&self.gauge.resolve(line, *to), None);
        let room = self.gauge.machine.capabilities.rapid_clearance;
        if self.retract_height.is_some() && self.top < plate.height + room {
            let what = format!(
                "goes over the touch plate at Z{}, whose top is at Z{}: {} mm of room are needed",
                Number(self.top),
                Number(plate.height),
                Number(room)
            );
            self.differs(line, (Rule::Probe, what));
        }
        let over = Position { point: to.point.with_z(f64::NAN), ..here };
        self.here = self.gauge.resolve(line, over);
        self.progress.start = Some(self.here);
        true
    }

    fn is_over(&self, plate: &TouchPlate, point: Vec3) -> bool {
        point.truncate().distance(plate.at) <= self.gauge.machine.resolution() + SAME
    }

    fn probes_plate(&mut self, line: u32, plate: &TouchPlate, probe: &Probe<Position>) {
        let end = probe.end.point;
        self.hold_travel(&self.gauge.resolve(line, probe.end), None);
        let slack = self.gauge.machine.resolution() / 2.0 + SAME;
        let lowest = plate.height - plate.travel;
        let here = self.here.position.point;
        let what = if probe.away || !probe.must_answer {
            "touches off by a probing move that goes on where it touches nothing: G38.2 stops"
                .into()
        } else if self.running.spindle != Spindle::Off {
            String::from("touches off a tool that turns")
        } else if !self.is_over(plate, end) || !self.is_over(plate, here) {
            format!(
                "touches off at X{} Y{}; the plate is at X{} Y{}",
                Number(end.x),
                Number(end.y),
                Number(plate.at.x),
                Number(plate.at.y)
            )
        } else if let Some(what) = self.other_offsets() {
            what
        } else if !self.is_slow(plate) {
            format!(
                "touches off faster than {} mm/min, or at a feed that is not known",
                Number(plate.feed)
            )
        } else if !here.z.is_nan() {
            "touches off from a height to which Z has not been home".into()
        } else if end.z >= plate.height || end.z < lowest - slack {
            format!(
                "touches off down to Z{}; the plate is at Z{}, and the tool goes down to Z{} at most",
                Number(end.z),
                Number(plate.height),
                Number(lowest)
            )
        } else {
            return;
        };
        self.differs(line, (Rule::Probe, what));
    }

    /// What is wrong with the offsets by which the heights of a touch-off count: the plate's from the first work offset, and on a
    /// control whose words name a length by that of the last cut with the tool before, since nobody knows that of this one.
    fn other_offsets(&self) -> Option<String> {
        let counts = "the height of the plate counts";
        if self.running.work_offset != Some(WorkOffset::FIRST) {
            return Some(format!(
                "touches off in another work offset than the first, by which {counts}"
            ));
        }
        (self.running.length_offset != self.length_before_tool).then(|| {
            format!("touches off by another length offset than the last cut had, by which {counts}")
        })
    }

    /// Whether the feed that is on is no more than the plate's.
    fn is_slow(&self, plate: &TouchPlate) -> bool {
        matches!(self.running.feed, Some(Feed::PerMinute(feed)) if feed <= plate.feed * (1.0 + 1e-9))
    }

    fn sets_height(&mut self, line: u32, plate: &TouchPlate, height: f64) {
        if (height - plate.height).abs() > self.gauge.machine.resolution() / 2.0 + SAME {
            let what = format!(
                "says that the tool stands at Z{} on the touch plate, whose top is at Z{}",
                Number(height),
                Number(plate.height)
            );
            self.differs(line, (Rule::Probe, what));
        }
        if let Some(what) = self.other_offsets() {
            self.differs(line, (Rule::Probe, what));
        }
        let mut on = self.here.position;
        on.point.z = height;
        self.here = self.gauge.resolve(line, on);
        self.raised = false;
    }

    /// Whether an action takes the tool home in Z from the plate.
    fn leaves_plate(&self, action: &Action) -> bool {
        if let Action::Rapid(to) = action {
            return self.retracts(to);
        }
        matches!(action, Action::Home(axes) if *axes == Axes::Z)
            || matches!(action, Action::MachineMove(to) if to.axes() == Axes::Z)
    }
}

/// Whether an action moves the tool, or turns it.
fn needs_tool(action: &Action) -> bool {
    let turns = matches!(action, Action::Spindle(spindle) if *spindle != Spindle::Off);
    let moves = matches!(
        action,
        Action::Home(_) | Action::MachineMove(_) | Action::Probe(_) | Action::Swivel(_)
    );
    turns || moves || action.position().is_some()
}
