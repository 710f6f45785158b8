//! FANUC 30i, milling, G code list of B-64484EN-2. Group 09, the canned cycles, is apart from group
//! 01, the interpolation.

use super::facts::{
    Arcs, CornerWords, Cycles, DwellUnit, Facts, FeedMeaning, FeedRules, FrameRules, Functions,
    Homes, Language, MotionRules, Numbers, Offsets, Reset, Rollover, Syntax, Tools, further,
    within_a_hundredth,
};
use super::{END_M, FRAME_G, MACRO_G, MILL_G, POLAR_G, SUBPROGRAM_M, TOOL_G, TOOL_M, cycles, mill};
use crate::StartModes;
use crate::iso::language::words::{
    Canned, Dictionary, G, GRow, Group, M, MRow, Motion, Path, Refused,
};

const G_WORDS: &[GRow] = &[
    (50, Group::OneShot, G::LookAhead { letter: b'P', on: 10_000 }),
    (51, Group::OneShot, G::LookAhead { letter: b'Q', on: 1 }),
    (80, Group::OneShot, G::LookAhead { letter: b'P', on: 1 }),
    (90, Group::OneShot, G::ExactBlock),
    (100, Group::OneShot, G::WriteData),
    (290, Group::OneShot, G::FromHome),
    (310, Group::OneShot, G::Skip),
    (330, Group::Motion, G::Motion(Motion::Thread)),
    (434, Group::Length, G::ToolCenter),
    (501, Group::Mirror, G::Mirror(false)),
    (511, Group::Mirror, G::Mirror(true)),
    (531, Group::OneShot, G::SwingToTilt),
    (541, Group::WorkOffset, G::FurtherOffset { most: 300 }),
    (600, Group::OneShot, G::OneSided),
    (620, Group::Path, G::Neutral(b"")),
    (630, Group::Path, G::LockOverrides),
    (640, Group::Path, G::Path(Path::Blend { bounded: false })),
    (682, Group::Tilt, G::Tilt),
    (760, Group::Cycle, G::Cycle(Canned::FineBore)),
    (800, Group::Cycle, G::CancelCycle),
    (870, Group::Cycle, G::Cycle(Canned::BackBore)),
];

const M_WORDS: &[MRow] = &[(7, Group::Coolant, M::Mist), (29, Group::Spindle, M::RigidTap)];

const REFUSED_G: &[Refused] = &[
    (71, "cylindrical interpolation depends on the machine's axes; write plain moves"),
    (121, "polar interpolation depends on the machine's axes; write plain moves"),
    (131, "polar interpolation depends on the machine's axes; write plain moves"),
    (440, "it subtracts the register of the tool length; write G43 with the sign in the register"),
    (435, "tool vectors in the block are not followed; use G43.4"),
    (411, "a tool radius in the block is not followed; use G41 D"),
    (421, "a tool radius in the block is not followed; use G42 D"),
    (661, "a macro called for every block is not followed; use G66"),
    (921, "it goes back to an offset that stands in the control"),
    (960, "constant surface speed is for turning"),
];

const WORDS: Dictionary = mill(b"ABCDFGHIJKLMNOPQRSTXYZ", usize::MAX)
    .with(MILL_G, END_M)
    .with(TOOL_G, TOOL_M)
    .with(FRAME_G, SUBPROGRAM_M)
    .with(POLAR_G, &[])
    .with(MACRO_G, &[])
    .with(&cycles(Group::Cycle), &[])
    .with(G_WORDS, M_WORDS)
    .refusing(
        REFUSED_G,
        &[(198, "a program in the memory of another device is not read; copy it next to this one")],
    );

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax { corners: CornerWords::AtAll, repeats_in_p: true, ..Syntax::FANUC },
    numbers: Numbers {
        factor_needs_point: true,
        // Parameters 1013, 1015#7 say how long an increment is.
        dwell: DwellUnit::AsSetUp,
        dwell_letter: Some(b'X'),
        dwells_by_turns: true,
        ..Numbers::FANUC
    },
    feed: FeedRules { meaning: FeedMeaning::PointedTime, ..FeedRules::FANUC },
    functions: Functions {
        // It is the choice of the builder.
        end_switches_off: false,
        ..Functions::FANUC
    },
    motion: MotionRules { rollover: Rollover::AsSetUp, units_alone: true, ..MotionRules::FANUC },
    arcs: Arcs {
        // Parameter 3410, which the machine sets.
        is_circle: within_a_hundredth,
        counts_radii: true,
        ..Arcs::ISO
    },
    cycles: Cycles { repeats: (b'K', 0), ..Cycles::FANUC },
    offsets: Offsets { written: |l, p, _| further(300, l, p), external: true, ..Offsets::FANUC },
    frames: FrameRules {
        // Parameter 5400#0 says whether it does.
        turns_add: false,
        ..FrameRules::FANUC
    },
    homes: Homes { leaves_tilt: true, names_axes: true, ..Homes::FANUC },
    tools: Tools { remembers_registers: true, length_as_set_up: true, ..Tools::FANUC },
    reset: Reset {
        // Parameter 3402#1 to #4; G98 and the work offset, where 3402#6 keeps them.
        modes: StartModes { centers_from_start: true, metric: true, ..StartModes::NONE },
        ..Reset::FANUC
    },
    ..Facts::fanuc(WORDS, Language::MacroB)
};
