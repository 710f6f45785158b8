//! Which parameters a cycle has, and why others are refused.

/// mm/min in the unit of F of an inch program, a tenth of an inch each minute.
pub(super) const TENTH_INCH: f64 = 2.54;

/// The unit of a cycle parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Length,
    /// mm/min; `MAX` is rapid.
    Feed,
    /// Seconds, counts, degrees, switches.
    Plain,
}

/// The parameters of the cycles and their units.
const UNITS: [(u16, Unit); 53] = [
    (200, Unit::Length),
    (201, Unit::Length),
    (202, Unit::Length),
    (203, Unit::Length),
    (204, Unit::Length),
    (205, Unit::Length),
    (206, Unit::Feed),
    (208, Unit::Feed),
    (210, Unit::Plain),
    (211, Unit::Plain),
    (212, Unit::Length),
    (213, Unit::Plain),
    (214, Unit::Plain),
    (216, Unit::Length),
    (217, Unit::Length),
    (224, Unit::Plain),
    (225, Unit::Length),
    (226, Unit::Length),
    (237, Unit::Length),
    (238, Unit::Length),
    (239, Unit::Length),
    (241, Unit::Plain),
    (242, Unit::Plain),
    (243, Unit::Plain),
    (244, Unit::Length),
    (245, Unit::Plain),
    (246, Unit::Plain),
    (247, Unit::Plain),
    (249, Unit::Length),
    (250, Unit::Length),
    (251, Unit::Length),
    (252, Unit::Length),
    (253, Unit::Feed),
    (254, Unit::Feed),
    (255, Unit::Plain),
    (256, Unit::Length),
    (257, Unit::Length),
    (258, Unit::Length),
    (259, Unit::Length),
    (301, Unit::Plain),
    (334, Unit::Length),
    (335, Unit::Length),
    (336, Unit::Plain),
    (339, Unit::Plain),
    (342, Unit::Length),
    (343, Unit::Plain),
    (344, Unit::Length),
    (351, Unit::Plain),
    (365, Unit::Plain),
    (379, Unit::Length),
    (395, Unit::Plain),
    (403, Unit::Plain),
    (421, Unit::Plain),
];

/// A cycle with Q parameters: its number, those it needs, and those newer software adds.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) number: u16,
    pub(super) needs: &'static [u16],
    pub(super) takes: &'static [u16],
}

const LAYOUTS: [Layout; 14] = [
    Layout { number: 200, needs: &[200, 201, 206, 202, 210, 203, 204], takes: &[211, 395] },
    Layout { number: 201, needs: &[200, 201, 206, 211, 208, 203, 204], takes: &[] },
    Layout { number: 202, needs: &[200, 201, 206, 211, 208, 203, 204, 214], takes: &[336] },
    Layout {
        number: 203,
        needs: &[200, 201, 206, 202, 210, 203, 204, 212, 213, 205, 211, 208, 256],
        takes: &[395],
    },
    Layout {
        number: 204,
        needs: &[200, 249, 250, 251, 252, 253, 254, 255, 203, 204, 214],
        takes: &[336],
    },
    Layout {
        number: 205,
        needs: &[200, 201, 206, 202, 203, 204, 212, 205, 258, 259, 257, 256, 211, 379, 253],
        takes: &[208, 395],
    },
    Layout { number: 206, needs: &[200, 201, 206, 211, 203, 204], takes: &[] },
    Layout { number: 207, needs: &[200, 201, 239, 203, 204], takes: &[] },
    Layout { number: 208, needs: &[200, 201, 206, 334, 203, 204, 335, 342], takes: &[351] },
    Layout { number: 209, needs: &[200, 201, 239, 203, 204, 257, 256, 336], takes: &[403] },
    Layout {
        number: 220,
        needs: &[216, 217, 244, 245, 246, 247, 241, 200, 203, 204, 301],
        takes: &[365],
    },
    Layout {
        number: 221,
        needs: &[225, 226, 237, 238, 242, 243, 224, 200, 203, 204, 301],
        takes: &[],
    },
    Layout { number: 240, needs: &[200, 343, 201, 344, 206, 211, 203, 204], takes: &[] },
    Layout { number: 247, needs: &[339], takes: &[] },
];

/// The cycle of that number.
pub(super) fn layout(number: u32) -> Option<&'static Layout> {
    LAYOUTS.iter().find(|layout| u32::from(layout.number) == number)
}

/// The unit of a parameter.
pub(super) fn unit(q: u16) -> Option<Unit> {
    UNITS.iter().find(|(number, _)| *number == q).map(|(_, unit)| *unit)
}

/// Why a cycle that is not understood is refused.
pub(super) fn refusal(cycle: u32) -> String {
    let reason = match cycle {
        3..=6
        | 14..=16
        | 20..=25
        | 27..=29
        | 39
        | 210..=215
        | 225
        | 230..=239
        | 251..=259
        | 267
        | 270..=276 => "the paths with which it mills are the control's own",
        241 | 262..=265 => "the paths with which it goes in and out are the control's own",
        12 => "it calls a program: use CALL PGM",
        13 => "it turns the spindle to an angle",
        18 => "it cuts a thread with a tool that turns with the spindle",
        1 | 2 | 17 => "it is defined in parts, 1.0 and so on",
        30 => "its points are in a file of the control",
        31..=99 | 291..=299 | 800..=899 => "it is for another machine",
        400..=499 | 1400..=1499 | 600..=699 => "it measures what is not in the program",
        300..=399 | 500..=599 => "it is one of the machine's builder",
        _ => "it is not known",
    };
    format!("cycle {cycle} is not supported: {reason}")
}
