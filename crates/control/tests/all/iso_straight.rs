//! A straight move behind another one is executed on a short path of its own; a blank between a letter and its number leads past
//! it. Both give the same records, whatever words of the dialect come before: the words are those of its own table.

use geom::Vec3;
use program::Rule;
use proptest::prelude::*;
use toolpost_control::{Dialect, Settings, Setup, WholeNumbers, vocabulary};

/// The dialects of ISO code. Marlin takes no short path: texts stand behind some of its words.
fn dialects() -> impl Iterator<Item = Dialect> {
    let other = |dialect: &Dialect| {
        matches!(
            dialect,
            Dialect::Marlin
                | Dialect::Sinumerik
                | Dialect::Sinumerik828d
                | Dialect::Klartext
                | Dialect::Points
                | Dialect::Krl
                | Dialect::UrScript
                | Dialect::Ls
                | Dialect::Rapid
        )
    };
    Dialect::NAMES.into_iter().map(|(_, dialect)| dialect).filter(move |dialect| !other(dialect))
}

/// What stands behind a word: what some of them need, and what a modal one makes of a move.
const PARAMETERS: [&str; 28] = [
    "",
    " X5.",
    " Z0.",
    " X5. Y6. Z7.",
    " X5. Y6. R9.",
    " X5. Y6. I2. J3.",
    " X0. I1. J0.",
    " A10.",
    " P1",
    " P500",
    " P1 X5.",
    " P1 Q1",
    " H1",
    " H1 Z9.",
    " D1",
    " D1 X5. Y5.",
    " R30.",
    " X0. Y0. R30.",
    " X1. Y1. Z1. I1. J1. K1. P2.",
    " X0. Y0. Z0. I10. J20. K0.",
    " Z-9. R-2. F50.",
    " X5. Y6. ,C1.",
    " Z-5. F1.",
    " Q1 E0.1",
    " S100",
    " L2 P1 X1. Y2. Z3.",
    " Z-5. R2. F50.",
    " Z-5. R2. P100 Q1. F50.",
];

/// Two rapids and cuts before the word, so that a straight move would go on, ...
const BEFORE: &str =
    "G21\nG90\nG94\nG98\nT1 M6\nS100 M3\nG43 H1\nG0 X1. Y2. Z30.\nG1 Z-1. F100\nX3.";

/// ... or nothing but modes: no position, no tool and no cut.
const BARE: &str = "G21\nG90\nG94\nS100 M3\nG1 F100";

/// What may stand between: a block that moves nothing and still only says how to move, so that a move along one axis may go on from it;
/// and an F that is another one where the word has taken it as something else.
const BETWEEN: [&str; 4] = ["", "F100\nX6.\nN-5 X7.\n", "G1 X6. F1.\n", "G1 X6.\nX7. F1.\n"];

/// ... and straight moves behind it, along one axis after the other; then what depends on whether something has been cut.
const BEHIND: &str = "G0 X4. Y5.\nZ6.\nG1 X7. F100\nY8. F100\nG0 X8.\nZ9.\nG1 X9. Y9. Z2.\nX1\nT2";

/// The program that `G65`, `G66` and `M98` call by `P1`.
const CALLED: &str = "\nM30\nO1\nG4 P100\nM99";

/// A move that no line of a GRBL is long enough for.
fn long() -> String {
    format!("\nX{}7.", "0".repeat(300))
}

/// Runs the lines on the short path and past it, without the lines that are refused.
fn compare(dialect: Dialect, setup: &Setup, text: &str) -> Result<(), String> {
    let settings = Settings { setup: setup.clone(), ..Settings::new(dialect, [true; 3]) };
    let run = |text: String| -> Result<String, (Rule, u32)> {
        let read = crate::common::records(&settings, "t.nc", text);
        // As text, in which a position that is not known is as good as another.
        read.map(|records| format!("{records:?}")).map_err(|found| (found.rule, found.line))
    };
    let mut kept: Vec<&str> = text.lines().collect();
    loop {
        let lines = kept.join("\n");
        let (short, past) = (run(lines.clone()), run(blanks_within_words(&lines)));
        if short != past {
            return Err(format!("{dialect:?}\n{lines}\n{short:?}\n{past:?}"));
        }
        let Err((_, line)) = short else { return Ok(()) };
        kept.remove(line as usize - 1);
    }
}

/// The same with a blank between each letter and its number.
fn blanks_within_words(text: &str) -> String {
    let parted = |c: char| if c.is_ascii_uppercase() { format!("{c} ") } else { c.to_string() };
    text.chars().map(parted).collect()
}

#[test]
fn a_straight_move_on_a_long_line_does_the_same_on_the_short_path() {
    for dialect in dialects() {
        let text = format!("{BEFORE}\nX4.{}\nX5.", long());
        compare(dialect, &Setup::default(), &text).unwrap_or_else(|found| panic!("{found}"));
    }
}

#[test]
fn a_straight_move_does_the_same_on_the_short_path_behind_every_word() {
    let known =
        Setup { start: Some(Vec3::ZERO), whole_numbers: WholeNumbers::Units, ..Setup::default() };
    let unknown = Setup { start: None, ..known.clone() };
    for dialect in dialects() {
        let words = vocabulary(dialect);
        assert!(words.len() > 20, "{dialect:?}");
        for word in &words {
            for parameters in PARAMETERS {
                let runs = [
                    (&known, BEFORE, BETWEEN[0]),
                    (&unknown, BEFORE, BETWEEN[1]),
                    (&unknown, BARE, BETWEEN[1]),
                    (&known, BEFORE, BETWEEN[2]),
                    (&known, BEFORE, BETWEEN[3]),
                ];
                // The last ask what has become of an F.
                let count = if parameters.contains('F') { 5 } else { 3 };
                for (setup, before, between) in runs.into_iter().take(count) {
                    let called = if ["G65", "G66", "M98"].contains(&&**word) { CALLED } else { "" };
                    let text = format!("{before}\n{word}{parameters}\n{between}{BEHIND}{called}");
                    compare(dialect, setup, &text).unwrap_or_else(|found| panic!("{found}"));
                }
            }
        }
    }
}

/// A straight move as many write it, with an F that is the last one's or another.
fn straight() -> impl Strategy<Value = String> {
    let word = |letter: char| {
        let number = prop_oneof![
            8 => (-9..99i64).prop_map(|n| format!("{:.1}", n as f64 / 2.0)),
            2 => prop::sample::select(&["0", "-0", "-0.", "7", "2000000."][..]).prop_map(String::from),
        ];
        prop::option::of(number.prop_map(move |number| format!(" {letter}{number}")))
    };
    const HEADS: [&str; 12] =
        ["", "", "N5", "N-5", "N5.", "G1", "G01", "G0", "N7 G1", "G1 G1", "G1 N7", "G2"];
    const TAILS: [&str; 12] =
        ["", "", "", " F100", " F100.", " F100", " F50", " F0", " F200", " X1.", " A9.", " T2"];
    let (head, tail) = (prop::sample::select(&HEADS), prop::sample::select(&TAILS));
    (head, word('X'), word('Y'), word('Z'), tail).prop_map(|(head, x, y, z, tail)| {
        let words = [x, y, z].map(Option::unwrap_or_default).concat();
        format!("{head}{words}{tail}")
    })
}

/// A block: a straight move, or which of the words of a dialect with which parameters.
#[derive(Clone, Debug)]
enum Block {
    Straight(String),
    Word(prop::sample::Index, &'static str),
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn straight_moves_do_the_same_on_the_short_path_among_any_words(
        known in any::<bool>(),
        before in prop::sample::select(&[BEFORE, BARE]),
        whole in prop::sample::select(&WHOLE_NUMBERS),
        blocks in prop::collection::vec(prop_oneof![
            1 => (any::<prop::sample::Index>(), prop::sample::select(&PARAMETERS))
                .prop_map(|(word, parameters)| Block::Word(word, parameters)),
            3 => straight().prop_map(Block::Straight),
        ], 1..30)
    ) {
        let setup = Setup { start: known.then_some(Vec3::ZERO), whole_numbers: whole, ..Setup::default() };
        for dialect in dialects() {
            let words = vocabulary(dialect);
            let shown = blocks.iter().map(|block| match block {
                Block::Straight(block) => block.clone(),
                Block::Word(word, parameters) => format!("{}{parameters}", word.get(&words)),
            });
            let text = format!("{before}\n{}\n", shown.collect::<Vec<_>>().join("\n"));
            prop_assert_eq!(compare(dialect, &setup, &text), Ok(()));
        }
    }
}

const WHOLE_NUMBERS: [WholeNumbers; 3] =
    [WholeNumbers::Unknown, WholeNumbers::Units, WholeNumbers::Increments];
