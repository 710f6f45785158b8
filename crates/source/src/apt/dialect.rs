//! Which CAM system wrote a file, as its content shows, and what follows from that.

use super::statement::{Lines, is_blank};
use std::fmt;

/// The CAM system whose habits a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// No habit of a known system: ISO 4343 without changes.
    Iso,
    /// Siemens NX, CLSF (`.cls`).
    Nx,
    /// SolidWorks CAM and CAMWorks (`.apt`).
    SolidWorksCam,
    /// Makino FF/CAM, APT-CL (`.cldata`).
    Makino,
    /// CATIA and 3DEXPERIENCE (`.aptsource`).
    Catia,
    /// Creo and Pro/NC (`.ncl`).
    Creo,
}

/// How an arc turns about the vector of its `CIRCLE` statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turn {
    /// Counter-clockwise, seen against the vector: the right-hand rule.
    RightHand,
    /// Clockwise.
    LeftHand,
}

/// What a file's lines begin with, and who writes so. The first that is met decides.
const SIGNS: [(&str, Dialect); 21] = [
    ("TOOL PATH/", Dialect::Nx),
    ("TLDATA/", Dialect::Nx),
    ("MSYS/", Dialect::Nx),
    ("PAINT/", Dialect::Nx),
    ("END-OF-PATH", Dialect::Nx),
    ("CSI_", Dialect::SolidWorksCam),
    ("TRNTYP/", Dialect::SolidWorksCam),
    ("CYCLE/INIT", Dialect::SolidWorksCam),
    ("CYCLE/DEEP2", Dialect::SolidWorksCam),
    ("PPRINT/APTCL-SPEC,MAKINO", Dialect::Makino),
    ("$$*CATIA", Dialect::Catia),
    ("$$ CATIA", Dialect::Catia),
    ("$$ START GENERATION OF", Dialect::Catia),
    ("$$ OPERATION NAME", Dialect::Catia),
    ("$$ MANUFACTURING PROGRAM", Dialect::Catia),
    ("CATPROCESS", Dialect::Catia),
    ("$$* PRO/CLFILE", Dialect::Creo),
    ("$$*PRO/CLFILE", Dialect::Creo),
    ("$$->", Dialect::Creo),
    ("MACHIN/UNCX", Dialect::Creo),
    ("MACHIN / UNCX", Dialect::Creo),
];

/// How far into the file its signs are looked for, bytes: every system shows itself in its header.
const HEAD: usize = 1 << 16;

impl Dialect {
    /// The dialect of `text`.
    pub(super) fn of(text: &[u8]) -> Dialect {
        let head = text.get(..HEAD).unwrap_or(text);
        for line in Lines::of(head) {
            let start = line.text.iter().position(|c| !is_blank(*c)).unwrap_or(0);
            let line = &line.text[start..];
            let begins = |sign: &str| {
                line.get(..sign.len()).is_some_and(|l| l.eq_ignore_ascii_case(sign.as_bytes()))
            };
            if let Some((_, dialect)) = SIGNS.iter().find(|(sign, _)| begins(sign)) {
                return *dialect;
            }
            // NX and Makino alone give a circle with the tolerances and the tool after the radius.
            if begins("CIRCLE/") && line.iter().filter(|c| **c == b',').count() >= 10 {
                return Dialect::Nx;
            }
        }
        Dialect::Iso
    }

    /// How the arcs of `CIRCLE` and `GOTO` turn; `None` where no source says so. The sources are in
    /// `docs/sources/apt.md`.
    pub(super) fn turn(self) -> Option<Turn> {
        match self {
            Dialect::Nx | Dialect::Makino => Some(Turn::LeftHand),
            Dialect::SolidWorksCam | Dialect::Creo => Some(Turn::RightHand),
            Dialect::Catia | Dialect::Iso => None,
        }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dialect::Iso => "ISO 4343",
            Dialect::Nx => "Siemens NX",
            Dialect::SolidWorksCam => "SolidWorks CAM",
            Dialect::Makino => "Makino",
            Dialect::Catia => "CATIA",
            Dialect::Creo => "Creo",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_system_is_detected_by_its_habits() {
        for (text, dialect) in [
            ("GOTO/1,2,3\n", Dialect::Iso),
            ("UNITS/MM\nTOOL PATH/A,TOOL,B\n", Dialect::Nx),
            ("CIRCLE/0,0,0,0,0,1,5,0.06,0.5,20,0\n", Dialect::Nx),
            ("PARTNO/1\r\nCSI_SET_FLUTE_LENGTH/16.\r\n", Dialect::SolidWorksCam),
            ("PPRINT/APTCL-SPEC,MAKINO-FF,1\n", Dialect::Makino),
            ("$$ OPERATION NAME : Profile Contouring.2\n", Dialect::Catia),
            ("$$* Pro/CLfile  Version Creo\n", Dialect::Creo),
        ] {
            assert_eq!(Dialect::of(text.as_bytes()), dialect, "{text}");
        }
    }
}
