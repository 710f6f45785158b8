//! Mach3, "Mach3 G and M-code Reference", table of G codes. The modal groups are those of RS274/NGC,
//! on which it is built; `G80` may stand in a block with `G0` to `G3`.

use super::facts::{
    DwellUnit, Facts, FrameRules, Functions, Language, Numbers, Offsets, Reset, Syntax, Tools,
};
use super::{END_M, FRAME_G, MILL_G, POLAR_G, SUBPROGRAM_M, TOOL_G, TOOL_M, cycles, mill};
use crate::iso::language::words::{Dictionary, G, GRow, Group, M, MRow, Path, Refused};
use crate::{Corners, StartModes};

const G_WORDS: &[GRow] = &[
    (100, Group::OneShot, G::WriteData),
    (120, Group::OneShot, G::Pocket { clockwise: true }),
    (130, Group::OneShot, G::Pocket { clockwise: false }),
    (310, Group::OneShot, G::Skip),
    (640, Group::Path, G::Path(Path::Blend { bounded: false })),
    (700, Group::Units, G::Inches(true)),
    (710, Group::Units, G::Inches(false)),
    (800, Group::Cycle, G::CancelCycle),
    (901, Group::ArcDistance, G::CentersAbsolute(true)),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (921, Group::OneShot, G::CancelShift { keep: false }),
    (922, Group::OneShot, G::CancelShift { keep: true }),
    (923, Group::OneShot, G::RestoreShift),
];

const M_WORDS: &[MRow] = &[(7, Group::Coolant, M::Mist)];

const REFUSED_G: &[Refused] = &[
    (281, "a stored home position is known only at the machine"),
    (301, "a stored home position is known only at the machine"),
    (320, "threading is for Mach3 Turn"),
    (740, "left-hand tapping is not in Mach3 Mill"),
    (760, "fine boring is not in Mach3 Mill"),
    (870, "back boring is not followed; write its moves"),
    (960, "constant surface speed is for turning"),
];

const REFUSED_M: &[Refused] = &[(47, "a program that begins again from its first line never ends")];

const WORDS: Dictionary = mill(b"ABCDFGHIJKLMNOPQRSTXYZ", usize::MAX)
    .with(MILL_G, END_M)
    .with(TOOL_G, TOOL_M)
    .with(FRAME_G, SUBPROGRAM_M)
    .with(POLAR_G, &[])
    .with(&cycles(Group::Motion), &[])
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, REFUSED_M);

/// How many work offsets there are.
const OFFSETS: u32 = 254;

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        further_axes: "this control has six axes, X Y Z and A B C: write the move with them",
        ..Syntax::ISO
    },
    // General Config, "G04 Dwell param in Milliseconds".
    numbers: Numbers { dwell: DwellUnit::SecondsAsSetUp, ..Numbers::ISO },
    functions: Functions {
        // Its page "Logic", the choice of the operator.
        end_switches_off: false,
        ..Functions::ISO
    },
    offsets: Offsets {
        by_g59: Some(OFFSETS),
        written: |l, p, _| p.filter(|p| l == 2 && (1..=OFFSETS).contains(p)).map(|p| 53 + p),
        ..Offsets::ISO
    },
    frames: FrameRules { scales_by_axis: true, turn_center: Some(*b"AB"), ..FrameRules::ISO },
    tools: Tools { rs274_data: true, ..Tools::ISO },
    reset: Reset {
        corners: Corners::AsSetUp,
        // General Config: "Active Plane of Movement", "Distance Mode", "IJ Mode"; its initialisation string; the page "Logic".
        modes: StartModes { metric: true, returns_up: true, ..StartModes::NONE },
        ..Reset::ISO
    },
    ..Facts::iso(WORDS, Language::Rs274)
};
