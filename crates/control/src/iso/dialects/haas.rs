//! Haas NGC mills, "Mill Operator's Manual", chapters G codes and M codes.

use super::facts::{
    Arcs, CornerWords, Cycles, DwellUnit, Facts, FrameRules, Functions, Homes, Language, Numbers,
    Offsets, Reset, Syntax, Tools, further, within_a_hundredth,
};
use super::{END_M, FRAME_G, MACRO_G, MILL_G, SUBPROGRAM_M, TOOL_G, TOOL_M, cycles, mill};
use crate::iso::language::words::{
    Canned, Dictionary, G, GRow, Group, M, MRow, Path, Pattern, Refused,
};
use crate::{Corners, StartModes};
use program::WorkOffset;

const G_WORDS: &[GRow] = &[
    (90, Group::OneShot, G::ExactBlock),
    (100, Group::OneShot, G::WriteData),
    (290, Group::OneShot, G::FromHome),
    (310, Group::OneShot, G::Skip),
    (600, Group::OneShot, G::OneSided),
    (640, Group::Path, G::Path(Path::Blend { bounded: false })),
    (700, Group::OneShot, G::Pattern(Pattern::Circle)),
    (710, Group::OneShot, G::Pattern(Pattern::Arc)),
    (720, Group::OneShot, G::Pattern(Pattern::Line)),
    (760, Group::Cycle, G::Cycle(Canned::FineBore)),
    (800, Group::Cycle, G::CancelCycle),
    (1000, Group::Mirror, G::Mirror(false)),
    (1010, Group::Mirror, G::Mirror(true)),
    (1030, Group::OneShot, G::Neutral(b"P")),
    (1100, Group::WorkOffset, G::WorkOffset(60)),
    (1110, Group::WorkOffset, G::WorkOffset(61)),
    (1120, Group::WorkOffset, G::WorkOffset(62)),
    (1130, Group::WorkOffset, G::WorkOffset(63)),
    (1140, Group::WorkOffset, G::WorkOffset(64)),
    (1150, Group::WorkOffset, G::WorkOffset(65)),
    (1160, Group::WorkOffset, G::WorkOffset(66)),
    (1170, Group::WorkOffset, G::WorkOffset(67)),
    (1180, Group::WorkOffset, G::WorkOffset(68)),
    (1190, Group::WorkOffset, G::WorkOffset(69)),
    (1200, Group::WorkOffset, G::WorkOffset(70)),
    (1210, Group::WorkOffset, G::WorkOffset(71)),
    (1220, Group::WorkOffset, G::WorkOffset(72)),
    (1230, Group::WorkOffset, G::WorkOffset(73)),
    (1240, Group::WorkOffset, G::WorkOffset(74)),
    (1250, Group::WorkOffset, G::WorkOffset(75)),
    (1260, Group::WorkOffset, G::WorkOffset(76)),
    (1270, Group::WorkOffset, G::WorkOffset(77)),
    (1280, Group::WorkOffset, G::WorkOffset(78)),
    (1290, Group::WorkOffset, G::WorkOffset(79)),
    (1540, Group::WorkOffset, G::FurtherOffset { most: 99 }),
    (1870, Group::OneShot, G::Smoothness),
    (2340, Group::Length, G::ToolCenter),
    (2540, Group::DynamicOffset, G::DynamicOffset(true)),
    (2550, Group::DynamicOffset, G::DynamicOffset(false)),
];

const M_WORDS: &[MRow] = &[
    (88, Group::Coolant, M::Through),
    (89, Group::Coolant, M::ThroughOff),
    (97, Group::Flow, M::CallBlock),
];

const REFUSED_G: &[Refused] = &[
    (120, "the size of the pocket depends on the register D; write its moves"),
    (130, "the size of the pocket depends on the register D; write its moves"),
    (160, "this control has no polar coordinates"),
    (350, "a measured tool is known only at the machine"),
    (360, "a measured position is known only at the machine"),
    (370, "a measured tool is known only at the machine"),
    (440, "it subtracts the register of the tool length; write G43 with the sign in the register"),
    (470, "engraving is not followed; write its moves"),
    (770, "which of R and Z back boring begins at is not known; write its moves"),
    (870, "a cycle that ends by hand is followed as G88 only"),
    (1070, "cylindrical mapping depends on the machine's axes; write plain moves"),
    (1360, "a measured position is known only at the machine"),
    (1410, "3D cutter compensation is not followed; write the compensated path"),
    (1430, "tool length compensation of five axes is not followed"),
    (1500, "pocket milling calls a contour in a subprogram; write its moves"),
    (1840, "tapping out of the vertical is not followed"),
    (1740, "tapping out of the vertical is not followed"),
];

/// *Mill Operator's Manual*, chapter "M-Codes".
const REFUSED_M: &[Refused] = &[
    (10, BRAKE),
    (11, BRAKE),
    (12, BRAKE),
    (13, BRAKE),
    (16, "the tool changes by M6"),
    (82, "the tool is let go at the machine alone"),
    (86, "the tool is clamped at the machine alone"),
    (95, "how long the machine sleeps, no proof follows"),
    (96, "a jump that an input decides is not followed"),
    (109, "what the operator answers is known only at the machine"),
];

const BRAKE: &str =
    "it works the brake of a rotary axis: name it as clamp_open or clamp_close of [[rotary]]";

const WORDS: Dictionary = mill(b"ABCDEFGHIJKLMNOPQRSTXYZ", usize::MAX)
    .with(MILL_G, END_M)
    .with(TOOL_G, TOOL_M)
    .with(FRAME_G, SUBPROGRAM_M)
    .with(MACRO_G, &[])
    .with(&cycles(Group::Cycle), &[])
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, REFUSED_M);

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        corners: CornerWords::AtLines,
        further_axes: "U, V and W are auxiliary axes, on lathes increments of X, Y and Z; neither is followed: write X, Y and Z, with \
                       G91 where they are increments",
        ..Syntax::FANUC
    },
    numbers: Numbers { dwell: DwellUnit::ByPoint, ..Numbers::FANUC },
    functions: Functions {
        // *Mill Operator's Manual*, M00.
        stop_switches_off: true,
        ends_through: Some(89),
        stop_leaves_on: false,
        ..Functions::FANUC
    },
    arcs: Arcs { is_circle: within_a_hundredth, ..Arcs::ISO },
    cycles: Cycles {
        turns_spindle: true,
        repeats: (b'L', 0),
        // Setting 52.
        peck_retract_is_set: true,
        ..Cycles::FANUC
    },
    offsets: Offsets { written: |l, p, _| further(99, l, p), ..Offsets::FANUC },
    frames: FrameRules { mirrors_at_zero: true, ..FrameRules::FANUC },
    homes: Homes { cancels_length: true, ..Homes::FANUC },
    tools: Tools { remembers_registers: true, ..Tools::FANUC },
    reset: Reset {
        // By as much as setting 85 says, which no program sees.
        corners: Corners::Unbounded,
        work_offset: Some(WorkOffset::FIRST),
        // Setting 56 may leave those of the program before.
        modes: StartModes { centers_from_start: true, metric: true, ..StartModes::NONE },
        ..Reset::FANUC
    },
    ..Facts::fanuc(WORDS, Language::MacroB)
};
