//! Tool changes, dwells, stops, the wire, outputs and inputs, functions of the machine's builder.

use super::*;
use machine::RotaryAxis;
use program::{Output, OutputValue, Rule};

impl Prover<'_> {
    /// A tool change.
    pub(super) fn change_tool(&mut self, line: u32, tool: &Tool) -> Outcome {
        if !self.at_tool_change() {
            let message = "changes the tool where the source does not";
            return Err(self.lost_at(line, Rule::ExtraToolChange, message));
        }
        if !self.gauge.machine.tools.retracts && self.here.position.point.z.is_finite() {
            let message = format!(
                "{}the program changes the tool where Z has not been home since the last move",
                SourceLine(self.cursor.line)
            );
            let help = "send Z home before it, or say `retracts = true` in [tools] of the machine's file where its \
                        tool change brings Z up by itself";
            self.found(Diagnostic::error(Rule::ToolChangeHeight, message).help(help).line(line));
        }
        if !self.gauge.machine.tools.retracts && !self.raised && !self.has_stood {
            let message =
                "changes the first tool wherever Z stands: nothing before it has sent Z home";
            let message = format!("{}the program {message}", SourceLine(self.cursor.line));
            match self.retract_height {
                // Z 0 is set with the tool after it: up before the start is not up then.
                Some(height) => {
                    let help = format!("raise Z to {} mm by rapid before it", Number(height));
                    let found = Diagnostic::error(Rule::ToolChangeHeight, message).help(help);
                    self.found(found.line(line));
                }
                None => {
                    let help = "send Z home before it, or bring the spindle up before you start";
                    let found = Diagnostic::warning(Rule::ToolChangeHeight, message).help(help);
                    self.report.warn(found.line(line));
                }
            }
        }
        if self.gauge.machine.tools.retracts {
            self.leaves_for_home(line);
            self.raised = true;
        }
        self.upright_for_tool(line);
        self.gauge.tool_length = self.cursor.tool_length();
        self.report.compared.tool_changes += 1;
        let name = if tool.number > 0 { tool.number.to_string() } else { tool.name.clone() };
        self.report.program.tool(name);
        if let Some((_, length)) = self.running.last_offsets {
            self.length_before_tool = length;
        }
        self.running.change_tool(line, tool.clone());
        self.awaits_touch_off();
        Ok(())
    }

    /// Holds the axes of a head at 0, or whole turns from it, where the magazine takes the tool.
    fn upright_for_tool(&mut self, line: u32) {
        let machine = self.gauge.machine;
        if machine.tools.turns_upright {
            return;
        }
        let rounding = machine.rotary_resolution();
        let stances = self.standing.at(&self.here.position.orientation);
        let turned = |axis: &&RotaryAxis| {
            let off = |degrees: &[f64; 3]| (degrees[axis.index()] / 360.0).fract().abs() * 360.0;
            let is_upright = |degrees: &[f64; 3]| {
                let off = off(degrees);
                off.min(360.0 - off) <= rounding
            };
            axis.on == Mount::Head && (stances.is_empty() || !stances.iter().all(is_upright))
        };
        let Some(letter) = machine.rotary.iter().find(turned).map(|axis| axis.letter) else {
            return;
        };
        let message = format!(
            "{}the program changes the tool while the head is turned: {letter} does not stand at 0, or nobody knows \
             that it does",
            SourceLine(self.cursor.line)
        );
        let help = "turn the axes of the head to 0 behind the retract, or say `turns_upright = true` in [tools] of the machine's \
                    file where its tool change does that by itself";
        self.found(Diagnostic::error(Rule::ToolChangeTilt, message).help(help).line(line));
    }

    /// Something that happens between motions: a dwell, a stop, an output.
    ///
    /// Functions of the builder that the source does not call are the machine's own: blocks of its file write them.
    pub(super) fn happens(&mut self, line: u32, event: Step) -> Outcome {
        if let (
            Step::Move(ExpectedMotion { kind: Kind::Hole(cycle), to, .. }),
            Step::Dwell(seconds),
        ) = (&self.cursor.step, &event)
        {
            let hole = Hole { gauge: &self.gauge, point: to, cycle };
            if self.progress.hole.dwell(&hole, &self.here, *seconds) {
                return Ok(());
            }
        }
        if self.progress.t == 0.0 && self.progress.stops.is_empty() && self.progress.left.is_none()
        {
            self.pass_left_out(|_| false);
        }
        if let Step::Unproven(what) = self.cursor.step {
            return Err(self.unproven(line, what));
        }
        let allowed = self.gauge.allowed.dwell_s;
        let same = match (&self.cursor.step, &event) {
            (Step::Dwell(a), Step::Dwell(b)) => (a - b).abs() <= allowed,
            (Step::Stop, Step::Stop)
            | (Step::OptionalStop, Step::OptionalStop)
            | (Step::ThreadWire, Step::ThreadWire)
            | (Step::CutWire, Step::CutWire) => true,
            (Step::Output(a), Step::Output(b)) => same_output(a, b),
            (Step::Input(a), Step::Input(b)) => {
                (a.number, a.until) == (b.number, b.until)
                    && (a.timeout - b.timeout).abs() <= allowed
            }
            (Step::WorkOffsetData(a), Step::WorkOffsetData(b)) => {
                let same = |(a, b): (&Option<f64>, Option<f64>)| match (a, b) {
                    (Some(a), Some(b)) => (a - b).abs() <= OFFSET_DATA,
                    (a, b) => a.is_none() && b.is_none(),
                };
                a.offset == b.offset && a.zero.iter().zip(b.zero).all(same)
            }
            (Step::Auxiliary(a), Step::Auxiliary(b)) => {
                a.number == b.number
                    && a.values.iter().zip(b.values).all(|(a, b)| match (a, b) {
                        (Some(a), Some(b)) => (a - b).abs() <= SIGNAL,
                        (a, b) => a.is_none() && b.is_none(),
                    })
            }
            _ => false,
        };
        if same {
            self.report.compared.events += 1;
            if self.cursor.wanted.spindle == Spindle::Off && self.running.spindle != Spindle::Off {
                let message = "the spindle turns at a stop, but should be stopped";
                self.differs(line, (Rule::Spindle, message.into()));
            }
            // DELAY behind SPINDL is for the spindle to run up, or to turn.
            let stands = self.running.spindle == Spindle::Off;
            if matches!(event, Step::Dwell(_))
                && self.cursor.wanted.spindle != Spindle::Off
                && stands
            {
                let message = "the spindle stands in a dwell, but should turn";
                self.differs(line, (Rule::Spindle, message.into()));
            }
            self.advance();
        } else if let (Step::Dwell(a), Step::Dwell(b)) = (&self.cursor.step, &event) {
            let message = format!("dwells {} s, but should {} s", Number(*b), Number(*a));
            self.differs(line, (Rule::Dwell, message));
            self.advance();
        } else if matches!(event, Step::Auxiliary(_)) {
            // Of the machine's own blocks.
        } else if !matches!(event, Step::Stop | Step::OptionalStop) || !self.at_tool_change() {
            let (rule, what) = match event {
                Step::Dwell(_) => (Rule::Dwell, "dwells"),
                Step::ThreadWire => (Rule::Wire, "threads the wire"),
                Step::CutWire => (Rule::Wire, "cuts the wire"),
                Step::Stop => (Rule::Stop, "stops"),
                Step::OptionalStop => (Rule::Stop, "stops if the operator asks for it"),
                Step::Output(_) => (Rule::Output, "sets an output"),
                Step::Input(_) => (Rule::Input, "reads an input or waits for it"),
                Step::WorkOffsetData(_) => (Rule::OperatorData, "writes a work offset"),
                Step::Auxiliary(_) | Step::Move(_) | Step::Unproven(_) | Step::End => return Ok(()),
            };
            self.differs(line, (rule, format!("{what} where the source does not")));
        }
        Ok(())
    }

    /// Whether the source has a tool change here, or nothing before. Goes there past motions that may
    /// be left out.
    pub(super) fn at_tool_change(&mut self) -> bool {
        if self.progress.t > 0.0 || self.progress.hole.over {
            return false;
        }
        if !self.cursor.at_tool_change() {
            self.pass_left_out(|goal| goal.tool_change);
        }
        self.cursor.at_tool_change()
    }

    /// Reports what stands before the next motion of the source, and is missing.
    pub(super) fn miss_events(&mut self, line: u32) {
        loop {
            let (rule, what) = match &self.cursor.step {
                Step::Dwell(seconds) => (Rule::Dwell, format!("a dwell of {} s", Number(*seconds))),
                Step::Stop => (Rule::Stop, "a stop".into()),
                Step::OptionalStop => (Rule::Stop, "an optional stop".into()),
                Step::ThreadWire => (Rule::Wire, "threading the wire".into()),
                Step::CutWire => (Rule::Wire, "cutting the wire".into()),
                Step::Output(output) => {
                    (Rule::Output, format!("output {} being set", output.number))
                }
                Step::Input(input) => (Rule::Input, format!("reading input {}", input.number)),
                Step::Auxiliary(function) => {
                    (Rule::Auxiliary, format!("the auxiliary function M{}", function.number))
                }
                Step::WorkOffsetData(data) => {
                    let number = data.offset.number();
                    (Rule::OperatorData, format!("writing work offset {number} (54 is the first)"))
                }
                Step::Move(_) | Step::Unproven(_) | Step::End => return,
            };
            self.differs(line, (rule, format!("{what} is missing before this")));
            self.advance();
        }
    }
}

/// How far a value of an output or a function may be off: half a step of the four decimals that are written.
const SIGNAL: f64 = 0.5e-4 + 1e-9;

/// The same of the zero of a work offset, mm or degrees: half a step of three decimals.
const OFFSET_DATA: f64 = 0.5e-3 + 1e-9;

fn same_output(a: &Output, b: &Output) -> bool {
    let value = match (a.value, b.value) {
        (OutputValue::Digital(a), OutputValue::Digital(b)) => a == b,
        (OutputValue::Analog(a), OutputValue::Analog(b)) => (a - b).abs() <= SIGNAL,
        (OutputValue::Digital(_), OutputValue::Analog(_))
        | (OutputValue::Analog(_), OutputValue::Digital(_)) => false,
    };
    value && (a.number, a.with_motion) == (b.number, b.with_motion)
}
