//! Wire-EDM machines that read ISO code: FANUC ROBOCUT and what follows it, Sodick, Agie
//! (`docs/controls/wire-iso.md`). The M functions that thread and cut the wire stand in the machine's
//! file.

use super::facts::{Arcs, Facts, Language, Syntax, Tools, WireRules, within_a_hundredth};
use super::{BASIC_G, BASIC_M, END_M, SUBPROGRAM_M, UNITS_20};
use crate::iso::language::words::{Dictionary, G, GRow, Group, Refused, Side};

/// Offset of the wire by the control.
const COMPENSATION: &[GRow] = &[
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
];

/// Taper by the control.
const TAPER: &[GRow] = &[
    (500, Group::Taper, G::Taper(Side::Off)),
    (510, Group::Taper, G::Taper(Side::Left)),
    (520, Group::Taper, G::Taper(Side::Right)),
];

/// Units as ISO 6983 said them first.
const UNITS_70: &[GRow] =
    &[(700, Group::Units, G::Inches(true)), (710, Group::Units, G::Inches(false))];

const REFUSED_BY_AGIE: &[Refused] = &[
    (510, "how this control says a taper is not known; give U and V"),
    (520, "how this control says a taper is not known; give U and V"),
];

/// A wire machine with these words.
const fn wire(words: Dictionary) -> Facts {
    Facts {
        syntax: Syntax {
            further_axes: "a wire has X, Y, U and V; what moves Z or W is set up at the machine: take the word out",
            ..Syntax::FANUC
        },
        // FANUC parameter 3410, which the machine sets; of the others no rule is known.
        arcs: Arcs { is_circle: within_a_hundredth, ..Arcs::ISO },
        ..Facts::fanuc(words, Language::Plain)
    }
}

pub(crate) static FANUC: Facts = Facts {
    wire: Some(WireRules { conditions: b"S", taper_letter: b'T' }),
    ..wire(
        Dictionary::new(b"DFGIJLMNOPRSTUVXY", usize::MAX)
            .with(BASIC_G, BASIC_M)
            .with(COMPENSATION, END_M)
            .with(UNITS_20, SUBPROGRAM_M)
            .with(TAPER, &[]),
    )
};

pub(crate) static SODICK: Facts = Facts {
    tools: Tools { radius_letter: b'H', ..Tools::FANUC },
    wire: Some(WireRules { conditions: b"CT", taper_letter: b'A' }),
    ..wire(
        Dictionary::new(b"ACFGHIJLMNOPRTUVXY", usize::MAX)
            .with(BASIC_G, BASIC_M)
            .with(COMPENSATION, END_M)
            .with(UNITS_20, SUBPROGRAM_M)
            .with(UNITS_70, &[])
            .with(TAPER, &[]),
    )
};

pub(crate) static AGIE: Facts = Facts {
    wire: Some(WireRules { conditions: b"PST", taper_letter: b'T' }),
    ..wire(
        Dictionary::new(b"DFGIJMNPSTUVXY", usize::MAX)
            .with(BASIC_G, BASIC_M)
            .with(COMPENSATION, END_M)
            .with(UNITS_70, &[])
            .refusing(REFUSED_BY_AGIE, &[]),
    )
};
