//! FreeCAD's own commands, in which its CAM workbench keeps toolpaths (`docs/sources/freecad.md`): ISO code whose lengths are mm
//! and times s, whatever the job shows.

use control::iso::{
    Canned, Dictionary, Facts, FeedMode, G, GRow, Group, M, MRow, Motion, Plane, Refused, Side,
    SourceRules,
};

const MOTION: &[GRow] = &[
    (0, Group::Motion, G::Motion(Motion::Rapid)),
    (10, Group::Motion, G::Motion(Motion::Line)),
    (20, Group::Motion, G::Motion(Motion::Arc { clockwise: true })),
    (30, Group::Motion, G::Motion(Motion::Arc { clockwise: false })),
    (40, Group::OneShot, G::Dwell),
    (280, Group::OneShot, G::Home),
    (382, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: true })),
    (383, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: false })),
    (384, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: true })),
    (385, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: false })),
    (530, Group::OneShot, G::Machine),
];

const CYCLES: &[GRow] = &[
    (730, Group::Motion, G::Cycle(Canned::BreakChip)),
    (740, Group::Motion, G::Cycle(Canned::LeftTap)),
    (800, Group::Cycle, G::CancelCycle),
    (810, Group::Motion, G::Cycle(Canned::Drill)),
    (820, Group::Motion, G::Cycle(Canned::DwellDrill)),
    (830, Group::Motion, G::Cycle(Canned::Deep)),
    (840, Group::Motion, G::Cycle(Canned::Tap)),
    (850, Group::Motion, G::Cycle(Canned::Ream)),
    (860, Group::Motion, G::Cycle(Canned::Bore)),
    (880, Group::Motion, G::Cycle(Canned::HandBore)),
    (890, Group::Motion, G::Cycle(Canned::DwellReam)),
    (980, Group::Return, G::ReturnToR(false)),
    (990, Group::Return, G::ReturnToR(true)),
];

const MODES: &[GRow] = &[
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (180, Group::Plane, G::Plane(Plane::Zx)),
    (190, Group::Plane, G::Plane(Plane::Yz)),
    (210, Group::Units, G::Inches(false)),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
    (900, Group::Distance, G::Incremental(false)),
    (910, Group::Distance, G::Incremental(true)),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (920, Group::OneShot, G::ShiftHere),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
    (950, Group::FeedMode, G::FeedMode(FeedMode::PerTurn)),
];

const WORK_OFFSETS: &[GRow] = &[
    (540, Group::WorkOffset, G::WorkOffset(54)),
    (550, Group::WorkOffset, G::WorkOffset(55)),
    (560, Group::WorkOffset, G::WorkOffset(56)),
    (570, Group::WorkOffset, G::WorkOffset(57)),
    (580, Group::WorkOffset, G::WorkOffset(58)),
    (590, Group::WorkOffset, G::WorkOffset(59)),
    (591, Group::WorkOffset, G::WorkOffset(60)),
    (592, Group::WorkOffset, G::WorkOffset(61)),
    (593, Group::WorkOffset, G::WorkOffset(62)),
    (594, Group::WorkOffset, G::WorkOffset(63)),
    (595, Group::WorkOffset, G::WorkOffset(64)),
    (596, Group::WorkOffset, G::WorkOffset(65)),
    (597, Group::WorkOffset, G::WorkOffset(66)),
    (598, Group::WorkOffset, G::WorkOffset(67)),
    (599, Group::WorkOffset, G::WorkOffset(68)),
];

const FUNCTIONS: &[MRow] = &[
    (0, Group::Flow, M::Stop),
    (1, Group::Flow, M::OptionalStop),
    (2, Group::Flow, M::End),
    (3, Group::Spindle, M::Clockwise),
    (4, Group::Spindle, M::CounterClockwise),
    (5, Group::Spindle, M::SpindleOff),
    (6, Group::ToolChange, M::ChangeTool),
    (7, Group::Coolant, M::Mist),
    (8, Group::Coolant, M::Flood),
    (9, Group::Coolant, M::CoolantOff),
    (30, Group::Flow, M::End),
];

const REFUSED: &[Refused] = &[
    (200, "FreeCAD keeps its toolpaths in mm, also where the job shows inches"),
    (430, "the post calls the length of the tool with the tool"),
    (490, "the post calls the length of the tool with the tool"),
];

/// The dialect of the commands.
pub(crate) static COMMANDS: Facts = Facts::source(
    Dictionary::new(b"ABCDFGIJKLMNPQRSTXYZ", usize::MAX)
        .with(MOTION, FUNCTIONS)
        .with(CYCLES, &[])
        .with(MODES, &[])
        .with(WORK_OFFSETS, &[])
        .refusing(REFUSED, &[]),
    SourceRules {
        feed: per_minute,
        // It writes a NaN as -922337203685.477581, and nothing is a kilometre long.
        largest: 1e6,
    },
);

/// How many digits FreeCAD's shorter form of a number has (`Command G1 [ F:3.3333 ]`). It leaves zeros
/// at the end out, so that a number with fewer digits is as good as one with so many.
const DIGITS: u8 = 5;

/// No decimals to the most of a feed in mm/min that somebody has typed, as powers of ten.
const TYPED: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// The feed a minute that `value` gives a second, which is written with so many digits before and behind its
/// point (FreeCAD's posts write 60 F, in `G93` and `G95`, too): where a number with few decimals lies within what these leave
/// open, that number, since it is what was typed (3.333333 is 200, not 199.99998).
fn per_minute(value: f64, [whole, decimals]: [u8; 2]) -> f64 {
    let places = decimals.max(DIGITS.saturating_sub(whole)).min(15);
    let open = 60.0 * 0.5 * (1.0 / 10f64.powi(places.into()));
    let exact = value * 60.0;
    let mut typed = TYPED.iter().map(|scale| (exact * scale).round() / scale);
    // Half of the last place, and what the doubles add to it.
    typed.find(|typed| (typed - exact).abs() <= open * 1.000_001).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::{COMMANDS, per_minute};
    use control::kernel::decimal;
    use control::{Dialect, Settings, Setup};
    use geom::Vec3;

    fn read(text: &str) -> f64 {
        let number = decimal::parse(&text.as_bytes()[1..]).unwrap();
        per_minute(number.value, number.digits.map(|count| count as u8))
    }

    #[test]
    fn a_feed_is_what_was_typed_in_mm_per_minute() {
        // Six decimals: 200/60, 254/60, 0.05/60.
        assert_eq!(read("F3.333333"), 200.0);
        assert_eq!(read("F4.233333"), 254.0);
        assert_eq!(read("F0.000833"), 0.05);
        // Five digits: 200/60, 1000/60, 10000/60, 73.8/60.
        assert_eq!(read("F3.3333"), 200.0);
        assert_eq!(read("F16.667"), 1000.0);
        assert_eq!(read("F166.67"), 10000.0);
        assert_eq!(read("F1.23"), 73.8);
        assert_eq!(read("F1.5"), 90.0);
        assert_eq!(read("F3"), 180.0);
    }

    #[test]
    fn a_feed_that_nobody_has_typed_stays_what_it_is() {
        // No number with three decimals is as near as the text says.
        assert_eq!(read("F5.123457"), 5.123457 * 60.0);
    }

    /// The records of a text, as text, or the line that is refused.
    fn records(text: &str) -> Result<String, u32> {
        let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
        let settings = Settings { setup, ..Settings::new(Dialect::Source(&COMMANDS), [true; 3]) };
        let mut records = Vec::new();
        let read = control::read(&settings, "", text.as_bytes(), &mut |event| {
            records.push(event);
            Ok(())
        });
        read.map(|()| format!("{records:?}")).map_err(|found| found.line)
    }

    /// A blank between a letter and its number leads past the short path of straight moves behind each other.
    #[test]
    fn a_straight_move_does_the_same_on_the_short_path_behind_every_command() {
        const PARAMETERS: [&str; 10] = [
            "",
            " X5. F3.0",
            " Z0. F0.0",
            " X5. Y6. I2. J3.",
            " A10. F2.0",
            " P1",
            " X1. Y1. Z-3. R5. F0.5",
            " X1. Y1. Z-3. R5. F0.5 Q1. P1.",
            " D1 X5. Y5.",
            " T2",
        ];
        let before = "M6 T1\nM3 S100\nG0 X1. Y2. Z30.\nG1 Z-1. F1.666667\nG1 X3.";
        let behind = "G0 X4. Y5. F50.0\nG0 Z6.\nG1 X7. F1.666667\nG1 Y8. F1.666667\nX9. Y9. Z2.";
        let words = control::vocabulary(Dialect::Source(&COMMANDS));
        assert!(words.len() > 50);
        for (word, parameters) in words.iter().flat_map(|word| PARAMETERS.map(|p| (word, p))) {
            let text = format!("{before}\n{word}{parameters}\n{behind}");
            let mut kept: Vec<&str> = text.lines().collect();
            while let Err(line) = records(&kept.join("\n")) {
                kept.remove(line as usize - 1);
            }
            let short = kept.join("\n");
            let blank = |c: char| if c.is_ascii_uppercase() { format!("{c} ") } else { c.into() };
            let past: String = short.chars().map(blank).collect();
            assert_eq!(records(&short), records(&past), "{short}");
        }
    }
}
