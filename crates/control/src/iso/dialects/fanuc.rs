//! FANUC 30i, milling, G code list of B-64484EN-2. Group 09, the canned cycles, is apart from group
//! 01, the interpolation.

use super::{END_M, FRAME_G, MACRO_G, MILL_G, POLAR_G, SUBPROGRAM_M, TOOL_G, TOOL_M, cycles, mill};
use crate::iso::language::words::{
    Canned, Dictionary, Flavor, G, GRow, Group, M, MRow, Motion, Path, Refused,
};

const G_WORDS: &[GRow] = &[
    (50, Group::OneShot, G::LookAhead { letter: b'P', on: 10_000 }),
    (51, Group::OneShot, G::LookAhead { letter: b'Q', on: 1 }),
    (80, Group::OneShot, G::Neutral(b"P")),
    (90, Group::OneShot, G::Neutral(b"")),
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
    (630, Group::Path, G::Neutral(b"")),
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

pub(super) static WORDS: Dictionary = mill(Flavor::Fanuc, b"ABCDFGHIJKLMNOPQRSTXYZ", usize::MAX)
    .with(MILL_G, END_M)
    .with(TOOL_G, TOOL_M)
    .with(FRAME_G, SUBPROGRAM_M)
    .with(POLAR_G, &[])
    .with(MACRO_G, &[])
    .with(&cycles(Group::Cycle), &[])
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, &[]);
