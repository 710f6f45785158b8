//! Marlin 2 with the options for mills (`CNC_COORDINATE_SYSTEMS`, `CNC_WORKSPACE_PLANES`,
//! `SPINDLE_FEATURE` in revolutions, `COOLANT_CONTROL`), from its G-code index.

use super::facts::{
    BlockDelete, Brackets, DwellUnit, Facts, Homes, Language, Numbers, Offsets, Reset, Syntax,
    Tools,
};
use super::mill;
use crate::iso::language::words::{Dictionary, G, GRow, Group, M, MRow, Refused};
use crate::{Ending, FeedPath, StartModes};

const G_WORDS: &[GRow] = &[
    (591, Group::WorkOffset, G::WorkOffset(60)),
    (592, Group::WorkOffset, G::WorkOffset(61)),
    (593, Group::WorkOffset, G::WorkOffset(62)),
    (800, Group::Motion, G::CancelCycle),
];

const M_WORDS: &[MRow] = &[
    (7, Group::Coolant, M::Mist),
    (17, Group::Output, M::Neutral(b"")),
    (18, Group::Output, M::IdleTime),
    (82, Group::Output, M::Neutral(b"")),
    (84, Group::Output, M::IdleTime),
    (83, Group::Output, M::Neutral(b"")),
    (117, Group::Output, M::Message),
    (400, Group::Output, M::Neutral(b"")),
];

const REFUSED_G: &[Refused] = &[
    (50, "splines of this control are not followed; write plain moves"),
    (290, "a probed bed is known only at the machine"),
    (300, "a probed position is known only at the machine"),
    (382, "a probed position is known only at the machine"),
    (410, "this control has no radius compensation; write the compensated path"),
    (420, "this control has no radius compensation; write the compensated path"),
    (430, "this control has no tool table"),
    (810, "this control has no cycles; write their moves"),
];

const REFUSED_M: &[Refused] = &[
    (2, "this control has no program end: the program ends with its last line"),
    (6, "tool changes are T alone; stop with M0 to change by hand"),
    (30, "on this control M30 deletes a file; the program ends with its last line"),
    (81, "it switches the supply of the machine off"),
    (104, "a hot end is no tool of a mill"),
    (
        106,
        "what hangs at the fan output is the builder's; list M106 among the machine's own functions",
    ),
    (
        107,
        "what hangs at the fan output is the builder's; list M107 among the machine's own functions",
    ),
    (109, "a hot end is no tool of a mill"),
    (112, "it is the emergency stop"),
    (220, "it changes every feed that follows"),
];

const WORDS: Dictionary =
    mill(b"ABCFGIJKMNPRSTXYZ", 95).with(G_WORDS, M_WORDS).refusing(REFUSED_G, REFUSED_M);

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        small_letters: false,
        brackets: Brackets::None,
        block_delete: BlockDelete::None,
        percent: false,
        one_command: true,
        ending: Ending::Text,
        refused_letter: Some((b'E', "an extruder is no tool of a mill")),
        further_axes: "U, V and W are axes of a firmware that is built with them (AXIS4_NAME to AXIS9_NAME), and passed over by others: \
                       take the word out",
        ..Syntax::ISO
    },
    numbers: Numbers { dwell: DwellUnit::Milliseconds, dwell_letter: Some(b'S'), ..Numbers::ISO },
    homes: Homes { switches: true, ..Homes::ISO },
    tools: Tools { by_hand: true, ..Tools::ISO },
    offsets: Offsets { homing_takes_away: true, ..Offsets::ISO },
    reset: Reset {
        feed_path: FeedPath::LinearAxes,
        work_offset: None,
        // Nothing ends a program: what it, MDI or the host has said last goes on. A feed counts a minute always.
        modes: StartModes {
            plane_xy: false,
            absolute: false,
            first_offset: false,
            ..StartModes::SURE
        },
        ..Reset::ISO
    },
    ..Facts::iso(WORDS, Language::Plain)
};
