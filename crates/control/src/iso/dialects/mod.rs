//! The dialects of controls, each a file of [`facts`]: which words it has, in which modal group, why it refuses others, and in what it
//! differs from others besides. No other file of `iso` asks for a maker by name; compensation has its table in `kernel`.

pub(crate) mod facts;
pub(crate) mod fanuc;
pub(crate) mod grbl;
pub(crate) mod haas;
pub(crate) mod linuxcnc;
pub(crate) mod mach3;
pub(crate) mod marlin;
pub(crate) mod wire;

use crate::iso::language::words::{
    Canned, Dictionary, FeedMode, G, GRow, Group, M, MRow, Motion, Path, Plane, Side,
};

/// What every dialect has.
const BASIC_G: &[GRow] = &[
    (0, Group::Motion, G::Motion(Motion::Rapid)),
    (10, Group::Motion, G::Motion(Motion::Line)),
    (20, Group::Motion, G::Motion(Motion::Arc { clockwise: true })),
    (30, Group::Motion, G::Motion(Motion::Arc { clockwise: false })),
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (540, Group::WorkOffset, G::WorkOffset(54)),
    (550, Group::WorkOffset, G::WorkOffset(55)),
    (560, Group::WorkOffset, G::WorkOffset(56)),
    (570, Group::WorkOffset, G::WorkOffset(57)),
    (580, Group::WorkOffset, G::WorkOffset(58)),
    (590, Group::WorkOffset, G::WorkOffset(59)),
    (900, Group::Distance, G::Incremental(false)),
    (910, Group::Distance, G::Incremental(true)),
    (920, Group::OneShot, G::ShiftHere),
];

/// What every dialect has.
const BASIC_M: &[MRow] = &[(0, Group::Flow, M::Stop), (1, Group::Flow, M::OptionalStop)];

/// Units as FANUC says them.
const UNITS_20: &[GRow] =
    &[(200, Group::Units, G::Inches(true)), (210, Group::Units, G::Inches(false))];

/// What every dialect of a mill has besides.
const SPINDLE_G: &[GRow] = &[
    (40, Group::OneShot, G::Dwell),
    (180, Group::Plane, G::Plane(Plane::Zx)),
    (190, Group::Plane, G::Plane(Plane::Yz)),
    (280, Group::OneShot, G::Home),
    (530, Group::OneShot, G::Machine),
];

/// What every dialect of a mill has besides.
const SPINDLE_M: &[MRow] = &[
    (3, Group::Spindle, M::Clockwise),
    (4, Group::Spindle, M::CounterClockwise),
    (5, Group::Spindle, M::SpindleOff),
    (8, Group::Coolant, M::Flood),
    (9, Group::Coolant, M::CoolantOff),
];

/// What every dialect has that is a control of a mill by itself.
const MILL_G: &[GRow] = &[
    (300, Group::OneShot, G::SecondHome),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (490, Group::Length, G::CancelLength),
    (610, Group::Path, G::Path(Path::ExactStop)),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
];

/// Ends of a program.
const END_M: &[MRow] = &[(2, Group::Flow, M::End), (30, Group::Flow, M::End)];

/// Compensation, tool length, feed per turn.
const TOOL_G: &[GRow] = &[
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
    (430, Group::Length, G::Length),
    (520, Group::OneShot, G::ShiftTo),
    (950, Group::FeedMode, G::FeedMode(FeedMode::PerTurn)),
    (970, Group::SpindleMode, G::Neutral(b"")),
    (980, Group::Return, G::ReturnToR(false)),
    (990, Group::Return, G::ReturnToR(true)),
];

/// Tool changer, spindle stop with orientation, overrides.
const TOOL_M: &[MRow] = &[
    (6, Group::ToolChange, M::ChangeTool),
    (19, Group::Spindle, M::Orient),
    (48, Group::Override, M::Neutral(b"")),
    (49, Group::Override, M::LockOverrides),
];

/// Subprograms.
const SUBPROGRAM_M: &[MRow] = &[(98, Group::Flow, M::Call), (99, Group::Flow, M::Return)];

/// Calls of custom macro B.
const MACRO_G: &[GRow] = &[
    (650, Group::Macro, G::MacroCall { modal: false }),
    (660, Group::Macro, G::MacroCall { modal: true }),
    (670, Group::Macro, G::CancelMacroCall),
];

/// Polar coordinates.
const POLAR_G: &[GRow] =
    &[(150, Group::Polar, G::Polar(false)), (160, Group::Polar, G::Polar(true))];

/// Turned and scaled coordinates.
const FRAME_G: &[GRow] = &[
    (500, Group::Scaling, G::Scale(false)),
    (510, Group::Scaling, G::Scale(true)),
    (680, Group::Tilt, G::Turn),
    (690, Group::Tilt, G::Upright),
];

/// The words of a mill, as far as every dialect has them.
const fn mill(letters: &[u8], longest: usize) -> Dictionary {
    Dictionary::new(letters, longest)
        .with(BASIC_G, BASIC_M)
        .with(UNITS_20, &[])
        .with(SPINDLE_G, SPINDLE_M)
}

/// The canned cycles as words of `group`.
const fn cycles(group: Group) -> [GRow; 10] {
    [
        (730, group, G::Cycle(Canned::BreakChip)),
        (740, group, G::Cycle(Canned::LeftTap)),
        (810, group, G::Cycle(Canned::Drill)),
        (820, group, G::Cycle(Canned::DwellDrill)),
        (830, group, G::Cycle(Canned::Deep)),
        (840, group, G::Cycle(Canned::Tap)),
        (850, group, G::Cycle(Canned::Ream)),
        (860, group, G::Cycle(Canned::Bore)),
        (880, group, G::Cycle(Canned::HandBore)),
        (890, group, G::Cycle(Canned::DwellReam)),
    ]
}
