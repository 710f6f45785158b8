//! The drilling cycles and patterns that a call may name, with their parameters.

/// A cycle and its parameters.
pub(crate) struct Form {
    /// Its name.
    pub name: &'static str,
    /// What it does in the hole.
    pub action: Operation,
    /// Its parameters in the order of the call.
    pub parameters: &'static [&'static str],
}

/// What a cycle does in the hole.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operation {
    /// Feed in, rapid out.
    Drill,
    /// Feed in by pecks.
    Peck,
    /// Tap with the spindle in step.
    RigidTap,
    /// Tap with a compensating chuck.
    Tap,
    /// Feed in, feed out.
    Ream,
    /// Feed in, spindle stop in position, rapid out.
    Bore,
    /// Known and not supported, as the operator has to act in the hole.
    StopInHole,
}

/// The drilling cycles (Programming Manual 06/2019, 3.25.1; `CYCLE87` to `89`: Programming Guide
/// Cycles 11.02).
pub(crate) const CYCLES: &[Form] = &[
    Form {
        name: "CYCLE81",
        action: Operation::Drill,
        parameters: &["RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "_GMODE", "_DMODE", "_AMODE"],
    },
    Form {
        name: "CYCLE82",
        action: Operation::Drill,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "_GMODE", "_DMODE", "_AMODE", "_VARI",
            "S_ZA", "S_FA", "S_ZD", "S_FD",
        ],
    },
    Form {
        name: "CYCLE83",
        action: Operation::Peck,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "FDEP", "FDPR", "DAM", "DTB", "DTS", "FRF", "VARI",
            "_AXN", "_MDEP", "_VRT", "_DTD", "_DIS1", "_GMODE", "_DMODE", "_AMODE",
        ],
    },
    Form {
        name: "CYCLE84",
        action: Operation::RigidTap,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "SDAC", "MPIT", "PIT", "POSS", "SST", "SST1",
            "_AXN", "_PITA", "_TECHNO", "_VARI", "_DAM", "_VRT", "_PITM", "_PTAB", "_PTABA",
            "_GMODE", "_DMODE", "_AMODE",
        ],
    },
    Form {
        name: "CYCLE840",
        action: Operation::Tap,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "SDR", "SDAC", "ENC", "MPIT", "PIT", "_AXN",
            "_PITA", "_TECHNO", "_PITM", "_PTAB", "_PTABA", "_GMODE", "_DMODE", "_AMODE",
        ],
    },
    Form {
        name: "CYCLE85",
        action: Operation::Ream,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "FFR", "RFF", "_GMODE", "_DMODE", "_AMODE",
        ],
    },
    Form {
        name: "CYCLE86",
        action: Operation::Bore,
        parameters: &[
            "RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "SDIR", "RPA", "RPO", "RPAP", "POSS",
            "_GMODE", "_DMODE", "_AMODE",
        ],
    },
    Form {
        name: "CYCLE87",
        action: Operation::StopInHole,
        parameters: &["RTP", "RFP", "SDIS", "DP", "DPR", "SDIR"],
    },
    Form {
        name: "CYCLE88",
        action: Operation::StopInHole,
        parameters: &["RTP", "RFP", "SDIS", "DP", "DPR", "DTB", "SDIR"],
    },
    Form {
        name: "CYCLE89",
        action: Operation::Ream,
        parameters: &["RTP", "RFP", "SDIS", "DP", "DPR", "DTB"],
    },
];

/// A pattern of holes and its parameters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pattern {
    /// `HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM)`.
    Row,
    /// `HOLES2(CPA, CPO, RAD, STA1, INDA, NUM)`.
    Circle,
    /// `CYCLE801(SPCA, SPCO, STA, DIS1, DIS2, NUM1, NUM2)`.
    Grid,
}
