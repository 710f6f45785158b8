//! Wire-EDM machines that read ISO code: FANUC ROBOCUT and what follows it, Sodick, Agie
//! (`docs/controls/wire-iso.md`). The M functions that thread and cut the wire stand in the machine's
//! file.

use super::super::words::{
    Dictionary, Flavor, G, GRow, Group, M, MRow, Motion, Plane, Refused, Side,
};
use super::SUBPROGRAM_M;

const G_WORDS: &[GRow] = &[
    (0, Group::Motion, G::Motion(Motion::Rapid)),
    (10, Group::Motion, G::Motion(Motion::Line)),
    (20, Group::Motion, G::Motion(Motion::Arc { clockwise: true })),
    (30, Group::Motion, G::Motion(Motion::Arc { clockwise: false })),
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
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

/// Taper by the control.
const TAPER: &[GRow] = &[
    (500, Group::Taper, G::Taper(Side::Off)),
    (510, Group::Taper, G::Taper(Side::Left)),
    (520, Group::Taper, G::Taper(Side::Right)),
];

/// Units as FANUC says them.
const UNITS_20: &[GRow] =
    &[(200, Group::Units, G::Inches(true)), (210, Group::Units, G::Inches(false))];

/// Units as ISO 6983 said them first.
const UNITS_70: &[GRow] =
    &[(700, Group::Units, G::Inches(true)), (710, Group::Units, G::Inches(false))];

const M_WORDS: &[MRow] = &[
    (0, Group::Flow, M::Stop),
    (1, Group::Flow, M::OptionalStop),
    (2, Group::Flow, M::End),
    (30, Group::Flow, M::End),
];

const REFUSED_BY_AGIE: &[Refused] = &[
    (510, "how this control says a taper is not known; give U and V"),
    (520, "how this control says a taper is not known; give U and V"),
];

pub(super) static FANUC: Dictionary =
    Dictionary::new(Flavor::FanucWire, b"DFGIJLMNOPRSTUVXY", usize::MAX)
        .with(G_WORDS, M_WORDS)
        .with(UNITS_20, SUBPROGRAM_M)
        .with(TAPER, &[]);

pub(super) static SODICK: Dictionary =
    Dictionary::new(Flavor::Sodick, b"ACFGHIJLMNOPRTUVXY", usize::MAX)
        .with(G_WORDS, M_WORDS)
        .with(UNITS_20, SUBPROGRAM_M)
        .with(UNITS_70, &[])
        .with(TAPER, &[]);

pub(super) static AGIE: Dictionary = Dictionary::new(Flavor::Agie, b"DFGIJMNPSTUVXY", usize::MAX)
    .with(G_WORDS, M_WORDS)
    .with(UNITS_70, &[])
    .refusing(REFUSED_BY_AGIE, &[]);
