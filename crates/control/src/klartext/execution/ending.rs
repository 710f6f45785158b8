//! What is still on where a program ends. The next program takes it as off when it starts, and so the proof does
//! (`docs/proof.md`, "What a program finds, and what it leaves").

use super::state::{Control, Tip};
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use program::Compensation;

const TRANSFORM: Risk = Risk::left_on(
    "ends with a datum shift, a mirror, a rotation or a scale",
    "set cycles 7, 8, 10, 11 and 26 back before the end (TRANS DATUM RESET)",
);
const PLANE: Risk =
    Risk::left_on("ends in a tilted plane", "write PLANE RESET STAY before the end");
const TOOL_CENTER: Risk = Risk::left_on(
    "ends while the control keeps the tool tip",
    "write M129 or FUNCTION RESET TCPM before the end",
);
const COMPENSATION: Risk =
    Risk::left_on("ends with radius compensation", "write R0 in a straight block before the end");
const FEED: Risk = Risk::left_on("ends with a feed per turn", "write M137 before the end");
const MODAL_CALL: Risk = Risk::left_on(
    "ends with a cycle that is called after each move",
    "write M99 with the last call before the end",
);

impl Control<'_, '_> {
    /// Reports what the end of the program leaves on. Parameters decide what of it M2, M30 and END PGM reset; PLANE and M128 stay for
    /// certain until they are reset, or another program is selected.
    pub(super) fn report_left_on(&mut self) -> Outcome {
        let inside = self.tilt.as_ref().is_some_and(|tilt| !tilt.inside.is_empty());
        let found = [
            (!self.outside.is_empty() || inside, TRANSFORM),
            (self.tilt.is_some(), PLANE),
            (self.tip != Tip::Free, TOOL_CENTER),
            (self.compensation != Compensation::Off, COMPENSATION),
            (self.per_turn, FEED),
            (self.calls_modally, MODAL_CALL),
        ];
        for (_, risk) in found.into_iter().filter(|(is_on, _)| *is_on) {
            self.emit(Action::Risk(risk.into()))?;
        }
        Ok(())
    }
}
