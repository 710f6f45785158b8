//! What is still on where a program ends. The next program takes it as off when it starts, and so the proof does
//! (`docs/proof.md`, "What a program finds, and what it leaves").

use super::state::frames::Transform;
use super::state::{Kinematics, Length, State, Tilt};
use crate::event::Risk;
use crate::iso::dialects::facts::{AtEnd, Facts};
use crate::iso::language::words::{FeedMode, Plane};

const PLANE: Risk = Risk::left_on("ends in another plane than G17", "write G17 before the end");
const INCREMENTAL: Risk = Risk::left_on(
    "ends with G91, from which the next one would count on",
    "write G90 before the end",
);
const FEED_MODE: Risk = Risk::left_on("ends in G93 or G95", "write G94 before the end");
const COMPENSATION: Risk = Risk::left_on(
    "ends with radius compensation",
    "write G40 with a straight move, or G40 alone, before the end",
);
const CYCLE: Risk = Risk::left_on("ends within a canned cycle", "write G80 before the end");
const RIGID_TAP: Risk = Risk::left_on("ends behind M29, which waits for a tap", "take M29 out");
const TRANSFORM: Risk = Risk::left_on(
    "ends with coordinates that are turned, scaled or mirrored",
    "write G69, G50 and G50.1 before the end, whichever belongs to what is on",
);
const LOCAL: Risk = Risk::left_on(
    "ends with coordinates that G52 has shifted",
    "write G52 with 0 for each axis that is shifted before the end",
);
const TILT: Risk = Risk::left_on("ends in a tilted plane", "write G69 before the end");
/// Parameter 5006#6: G49 at the head of the next program moves Z by the length where the axis moves.
const LENGTH: Risk = Risk::left_on(
    "ends with a tool length where Z is not home: G49 of the next one may move Z by it (parameter 5006#6)",
    "send Z home before the end (G91 G28 Z0); or say `length_moves_axis = false` in [settings] of the machine file where 5006#6 is 1",
);
const TOOL_CENTER: Risk =
    Risk::left_on("ends while the control keeps the tool tip", "write G49 before the end");
/// `M30` ends it, a stop by hand may not: the manual asks for `G255` right behind its use.
const DYNAMIC_OFFSET: Risk =
    Risk::left_on("ends while the table carries the work zero", "write G255 before the end");
const KINEMATICS: Risk = Risk::left_on(
    "ends with the kinematics of the tip",
    "switch to the kinematics of the axes before the end",
);
const POLAR: Risk = Risk::left_on("ends with polar coordinates", "write G15 before the end");
const SURFACE: Risk =
    Risk::left_on("ends with constant surface speed", "write G97 with S before the end");
const DIAMETER: Risk = Risk::left_on("ends with X as a diameter", "write G8 before the end");
const CENTERS: Risk =
    Risk::left_on("ends with absolute centres of arcs", "write G91.1 before the end");
const RETURN: Risk =
    Risk::left_on("ends with G99, the return of cycles to R", "write G98 before the end");

impl Risk {
    /// `G66`: the next program would call the macro behind each of its moves.
    pub(in crate::iso) const MODAL_MACRO: Risk = Risk::left_on(
        "ends with a macro that is called after each move",
        "write G67 before the end",
    );

    /// The program goes back to where the control has called it from, or begins again.
    pub(in crate::iso) const TOOL_DOWN: Risk = Risk::left_on(
        "ends and begins again where Z has not been home since the last move",
        "send Z home before the end",
    );
}

impl State {
    /// What the end of the program leaves on. `M2` and `M30` of LinuxCNC and GRBL go back to `G17 G90 G94 G40 G54` (M codes,
    /// "M2, M30 Program End"; `gcode.c`, step 21). On a FANUC parameters 3402#6 and 1202#3 decide what a reset clears and the
    /// builder whether `M30` is one, on Haas setting 56, on Mach3 the page "Logic" of its configuration.
    pub(in crate::iso) fn left_on(&self, facts: &Facts) -> impl Iterator<Item = Risk> {
        let is_read = facts.source.is_none();
        let keeps_modes = facts.reset.at_end == AtEnd::Keeps;
        let length_moves_z = facts.tools.length_as_set_up && self.length_moves_axis != Some(false);
        let returns_up = facts.cycles.returns == Some(false);
        let found = [
            (keeps_modes && self.plane != Plane::Xy, PLANE),
            (keeps_modes && self.incremental, INCREMENTAL),
            (keeps_modes && self.feed_mode != FeedMode::PerMinute, FEED_MODE),
            (keeps_modes && self.compensation.is_on(), COMPENSATION),
            (keeps_modes && self.cycle.is_some(), CYCLE),
            (self.rigid && self.cycle.is_none(), RIGID_TAP),
            (self.frames.transform != Transform::NONE, TRANSFORM),
            (self.frames.local != [0.0; 6], LOCAL),
            (self.tilt != Tilt::None, TILT),
            (length_moves_z && self.length != Length::None && !self.z_is_home, LENGTH),
            (matches!(self.length, Length::Center(_)), TOOL_CENTER),
            (self.frames.carried.is_some(), DYNAMIC_OFFSET),
            (self.kinematics == Kinematics::Tip, KINEMATICS),
            (self.polar.is_some(), POLAR),
            (self.surface.is_some(), SURFACE),
            (self.diameter, DIAMETER),
            (self.centers_absolute, CENTERS),
            (returns_up && self.return_to_r == Some(true), RETURN),
        ];
        found.into_iter().filter_map(move |(is_on, risk)| (is_read && is_on).then_some(risk))
    }

    /// Whether Z has been somewhere else since it was home.
    pub(in crate::iso) fn is_down(&self) -> bool {
        self.wire.is_none() && self.moved && !self.z_is_home
    }
}
