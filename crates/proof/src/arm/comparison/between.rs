//! What happens between motions: outputs, dwells, stops, tool changes, the load, the end.

use super::super::expected::Step;
use super::{Comparison, refused};
use geom::Vec3;
use program::{Diagnostic, Outcome, Output, OutputValue, Rule, Tool};

/// So much longer than the spindle needs to its speed a program may wait for it, s.
const MOST_WAITING: f64 = 60.0;

impl Comparison<'_> {
    /// What hangs on the flange.
    ///
    /// # Errors
    /// The machine's file states another load.
    pub(super) fn load(&mut self, mass: f64, center: Vec3) -> Outcome {
        self.loaded = true;
        let Some(load) = self.cell.load else {
            let message =
                format!("the load of the program is {mass} kg, and the machine's file states none");
            return refused(Rule::Payload, message);
        };
        let off = center.distance(load.center);
        match (mass - load.mass).abs() <= 5e-3 && off <= 0.1 {
            true => Ok(()),
            false => refused(
                Rule::Payload,
                format!(
                    "the load of the program is {mass} kg, its centre {off:.1} mm off; the machine's file states {} kg",
                    load.mass
                ),
            ),
        }
    }

    /// # Errors
    /// It is not the load that the cell states.
    pub(super) fn load_number(&mut self, number: u32) -> Outcome {
        self.loaded = true;
        let states = match self.cell.load_number {
            Some(own) if own == number => return Ok(()),
            Some(own) => format!("the machine's file states {own}"),
            None => "and the machine's file states none".into(),
        };
        refused(Rule::Payload, format!("the program chooses load {number}, {states}"))
    }

    /// An output: the spindle's, the coolant's, or one of the source's own.
    pub(super) fn output(&mut self, output: &Output) -> Outcome {
        self.exact()?;
        let running = &mut self.running;
        match output.value {
            OutputValue::Digital(on) if self.cell.spindle_output == Some(output.number) => {
                if on && !running.is_on {
                    running.runs_up = self.machine.spindle.dwell;
                }
                running.is_on = on;
                return self.turns_no_faster();
            }
            OutputValue::Digital(on) if self.cell.coolant_output == Some(output.number) => {
                running.coolant = on;
            }
            OutputValue::Analog(part)
                if self.cell.spindle_analog.is_some_and(|(number, _)| number == output.number) =>
            {
                let full = self.cell.spindle_analog.map_or(0.0, |(_, full)| full);
                // What the output counts at its full value.
                let scale = self.machine.words.get("VALUE").map_or(1.0, |word| word.scale);
                let speed = part / scale * full;
                if running.is_on && running.speed != Some(speed) {
                    running.runs_up = self.machine.spindle.dwell;
                }
                running.speed = Some(speed);
                return self.turns_no_faster();
            }
            OutputValue::Digital(_) | OutputValue::Analog(_) => {
                let output = *output;
                return self.happens(
                    Rule::Output,
                    "sets an output",
                    |step| matches!(step, Step::Output(wanted) if *wanted == output),
                );
            }
        }
        Ok(())
    }

    /// # Errors
    /// The spindle turns faster than the source names a speed for the tool in it, also where nothing is cut.
    fn turns_no_faster(&self) -> Outcome {
        let (is_on, Some(speed)) = self.turns() else { return Ok(()) };
        let held = self.changes.held.map(|number| Tool { number, ..Tool::default() });
        let fastest = self.speeds.fastest(held.as_ref());
        if !is_on || speed <= fastest + self.speed_step() {
            return Ok(());
        }
        let message = format!(
            "the spindle turns at {speed:.0} 1/min, and the source names no speed above {fastest:.0} for this tool"
        );
        let help = "state the speed of the tool before the output that switches the spindle on";
        Err(Diagnostic::error(Rule::Spindle, message).help(help).into())
    }

    /// A dwell: one of the source, or the wait for the speed of the spindle.
    pub(super) fn dwell(&mut self, seconds: f64) -> Outcome {
        self.exact()?;
        // Its word rounds it: a few turns of the spindle are no whole hundredths of a second.
        let rounds = self.machine.words.get("P").map_or(0.0, |word| 0.5 * word.resolution());
        let allowed = self.report.tolerances.dwell_s;
        let sources = allowed.max(rounds * (1.0 + 1e-6));
        let is_sources = |step: &Step| matches!(step, Step::Dwell(wanted) if (wanted - seconds).abs() <= sources);
        self.leave_out();
        let runs_up = self.running.runs_up;
        if let Some(expected) = self.expected.get(self.next).filter(|next| is_sources(&next.step)) {
            let wanted = expected.state.spindle;
            if !self.turns_as(wanted) {
                let message = format!(
                    "the program dwells with the spindle {}, the source has {wanted:?} there",
                    self.spindle()
                );
                let help = "the outputs that switch the spindle stand before the dwell, as SPINDL stands before DELAY";
                return Err(Diagnostic::error(Rule::Spindle, message).help(help).into());
            }
            if seconds + allowed >= runs_up {
                self.running.runs_up = 0.0;
            }
        } else if runs_up > 0.0 && (runs_up - allowed..=runs_up + MOST_WAITING).contains(&seconds) {
            self.running.runs_up = 0.0;
            return Ok(());
        }
        let done = self.happens(Rule::Dwell, "dwells", is_sources);
        done.map_err(|found| match self.running.is_on || self.machine.spindle.dwell == 0.0 {
            true => found,
            false => Box::new(found.help(
                "the spindle is off here: a wait for its speed stands behind the output that switches it on",
            )),
        })
    }

    /// Something between motions that the source has there too.
    pub(super) fn happens(
        &mut self,
        rule: Rule,
        what: &str,
        is: impl Fn(&Step) -> bool,
    ) -> Outcome {
        self.leave_out();
        match self.expected.get(self.next) {
            Some(expected) if self.done == 0.0 && is(&expected.step) => {
                self.next += 1;
                self.report.compared.events += 1;
                Ok(())
            }
            _ => {
                refused(rule, format!("the program {what} where the source does not, or otherwise"))
            }
        }
    }

    /// # Errors
    /// No tool is changed where the arm stands, or while something is on.
    fn may_change(&self) -> Outcome {
        if self.running.is_on || self.running.coolant || !self.is_home {
            let message = "the tool is changed where the arm is not home, or with the spindle or the coolant on";
            return refused(Rule::ToolChange, message);
        }
        Ok(())
    }

    /// A tool change by the operator's program.
    pub(super) fn tool(&mut self, number: u32) -> Outcome {
        self.exact()?;
        self.may_change()?;
        let running = &mut self.running;
        running.turn_speed = [None; 2];
        running.joint_speed = None;
        running.on_flange = None;
        self.loaded = false;
        self.standing = None;
        self.leave_out();
        let wanted = self.expected.get(self.next).map(|expected| &expected.step);
        match wanted {
            Some(Step::Tool(tool)) if tool.number == number => {
                self.changed(number);
                Ok(())
            }
            _ => refused(
                Rule::ExtraToolChange,
                format!("the program changes to tool {number}, the source does not"),
            ),
        }
    }

    /// A stop at which the operator puts another tool into the spindle.
    pub(super) fn tool_by_hand(&mut self, number: u32) -> Outcome {
        self.may_change()?;
        if self.changes.asked.take() != Some(number) {
            let message = format!(
                "the program stops for tool {number}, and no message before it says that to the operator"
            );
            return refused(Rule::ToolByHand, message);
        }
        // Where the operator has led the arm is not known.
        self.standing = None;
        self.changed(number);
        Ok(())
    }

    fn changed(&mut self, number: u32) {
        self.changes.held = Some(number);
        self.report.compared.tool_changes += 1;
        self.report.program.tool(number.to_string());
        self.next += 1;
    }

    pub(super) fn ends(&mut self) -> Outcome {
        self.exact()?;
        self.ended = true;
        let running = &self.running;
        if running.is_on || running.coolant {
            return refused(Rule::LeftOn, "the program ends with the spindle or the coolant on");
        }
        match self.is_home {
            true => Ok(()),
            false => refused(Rule::Home, "the program does not end with the joints at home"),
        }
    }
}
