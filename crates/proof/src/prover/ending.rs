//! The end of a program: what it leaves on, the next one begins with.

use super::*;
use program::Rule;

impl Prover<'_> {
    /// The end. What frames, planes and modes the program leaves on, its control reports ([`control::Risk`]).
    pub(super) fn ends(&mut self, line: u32) {
        self.ended = true;
        let (machine, running) = (self.gauge.machine, &self.running);
        let on = [
            (running.spindle != Spindle::Off, "the spindle turning (M5)"),
            (running.coolant != Coolant::Off, "the coolant on (M9)"),
            (running.taper != 0.0, "the wire leaning by the control (G50)"),
        ];
        let mut left: Vec<String> =
            on.iter().filter(|(is_on, _)| *is_on).map(|(_, what)| (*what).into()).collect();
        // Where a cut has been refused for its offset, that is known.
        let known = [Rule::WorkOffset, Rule::LengthOffset];
        if !self.report.mismatches.iter().any(|found| known.contains(&found.rule)) {
            left.extend(state::offset_left(machine, &self.cursor.wanted, running));
        }
        if !left.is_empty() {
            let (source, left) = (self.cursor.line, left.join(", "));
            let message = format!("{}the program ends and leaves {left}", SourceLine(source));
            let help = "switch it off, or select that of the last cut, before the end: the next program takes it as off";
            self.found(Diagnostic::error(Rule::LeftOn, message).help(help).line(line));
        }
        if machine.wire.is_none() && self.here.position.point.z.is_finite() {
            let message = format!(
                "{}the program ends where Z has not been home since the last move",
                SourceLine(self.cursor.line)
            );
            let help = "send Z home before the end: the next program, or the operator, may move X and Y first";
            self.report.warn(Diagnostic::warning(Rule::EndHeight, message).help(help).line(line));
        }
    }
}
