//! Tool changes, dwells, stops, and the wire.

use super::*;

impl Prover<'_> {
    /// A tool change.
    pub(super) fn change_tool(&mut self, line: u32, tool: &Tool) -> Outcome {
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

    /// A dwell, a stop, or the wire threaded or cut.
    pub(super) fn event(&mut self, line: u32, event: Step) {
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
            (Step::Stop, Step::Stop)
            | (Step::OptionalStop, Step::OptionalStop)
            | (Step::ThreadWire, Step::ThreadWire)
            | (Step::CutWire, Step::CutWire) => true,
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
        } else if !matches!(event, Step::Stop | Step::OptionalStop) || !self.at_tool_change() {
            let (rule, what) = match event {
                Step::Dwell(_) => ("dwell", "dwells"),
                Step::ThreadWire => ("wire", "threads the wire"),
                Step::CutWire => ("wire", "cuts the wire"),
                Step::Stop => ("stop", "stops"),
                _ => ("stop", "stops if the operator asks for it"),
            };
            self.differs(line, (rule, format!("{what} where the source does not")));
        }
    }

    /// Whether the source has a tool change here, or nothing before. Goes there past motions that may
    /// be left out.
    pub(super) fn at_tool_change(&mut self) -> bool {
        if self.leg.t > 0.0 || self.leg.hole.over {
            return false;
        }
        if !self.cursor.at_tool_change() {
            self.pass_left_out(|goal| goal.tool_change);
        }
        self.cursor.at_tool_change()
    }

    /// Tells dwells, stops and the wire's events that stand before the next motion of the source.
    pub(super) fn miss_events(&mut self, line: u32) {
        loop {
            let (rule, what) = match &self.cursor.step {
                Step::Dwell(seconds) => ("dwell", format!("a dwell of {} s", Number(*seconds))),
                Step::Stop => ("stop", "a stop".into()),
                Step::OptionalStop => ("stop", "an optional stop".into()),
                Step::ThreadWire => ("wire", "threading the wire".into()),
                Step::CutWire => ("wire", "cutting the wire".into()),
                _ => return,
            };
            self.differs(line, (rule, format!("{what} is missing before this")));
            self.advance();
        }
    }
}
