//! Letters as strokes, so that a text looks the same on every machine and needs no font.

use crate::Vec2;

/// Each character on a grid 4 wide and 6 high, baseline at 0: points as two digits (x, y) joined by
/// blanks, strokes parted by commas. Small letters are small capitals, as on engineering drawings.
const GLYPHS: &[(char, &str)] = &[
    ('A', "00 26 40,13 33"),
    ('B', "03 33 44 45 36 06 00 30 41 42 33"),
    ('C', "45 36 16 05 01 10 30 41"),
    ('D', "00 06 26 45 41 20 00"),
    ('E', "46 06 00 40,03 33"),
    ('F', "46 06 00,03 33"),
    ('G', "45 36 16 05 01 10 30 41 43 23"),
    ('H', "00 06,40 46,03 43"),
    ('I', "10 30,20 26,16 36"),
    ('J', "46 41 30 10 01"),
    ('K', "00 06,46 03 40"),
    ('L', "06 00 40"),
    ('M', "00 06 23 46 40"),
    ('N', "00 06 40 46"),
    ('O', "01 05 16 36 45 41 30 10 01"),
    ('P', "00 06 36 45 44 33 03"),
    ('Q', "01 05 16 36 45 41 30 10 01,22 40"),
    ('R', "00 06 36 45 44 33 03,23 40"),
    ('S', "45 36 16 05 04 13 33 42 41 30 10 01"),
    ('T', "06 46,26 20"),
    ('U', "06 01 10 30 41 46"),
    ('V', "06 20 46"),
    ('W', "06 10 23 30 46"),
    ('X', "00 46,06 40"),
    ('Y', "06 23 46,23 20"),
    ('Z', "06 46 00 40"),
    ('0', "01 05 16 36 45 41 30 10 01"),
    ('1', "15 26 20,10 30"),
    ('2', "05 16 36 45 44 00 40"),
    ('3', "05 16 36 45 44 33 42 41 30 10 01,13 33"),
    ('4', "30 36 02 42"),
    ('5', "46 06 03 33 42 41 30 10 01"),
    ('6', "45 36 16 05 01 10 30 41 42 33 13 02"),
    ('7', "06 46 20"),
    ('8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"),
    ('9', "01 10 30 41 45 36 16 05 04 13 33 44"),
    (' ', ""),
    ('.', "20 21"),
    (',', "21 10"),
    (':', "20 21,24 25"),
    (';', "21 10,24 25"),
    ('!', "20 21,23 26"),
    ('?', "05 16 36 45 44 23 22,20 21"),
    ('-', "13 33"),
    ('+', "03 43,21 25"),
    ('=', "02 42,04 44"),
    ('/', "00 46"),
    ('\\', "06 40"),
    ('|', "20 26"),
    ('(', "36 24 22 30"),
    (')', "16 24 22 10"),
    ('[', "36 16 10 30"),
    (']', "16 36 30 10"),
    ('<', "45 03 41"),
    ('>', "05 43 01"),
    ('_', "00 40"),
    ('\'', "25 26"),
    ('"', "15 16,35 36"),
    ('*', "13 33,12 34,14 32"),
    ('#', "10 16,30 36,02 42,04 44"),
    ('%', "00 46,05 16,30 41"),
    ('&', "40 05 16 25 01 10 30 42"),
    ('~', "02 13 32 43"),
    ('°', "16 26 25 15 16"),
    ('×', "11 35,15 31"),
    ('Ø', "01 05 16 36 45 41 30 10 01,00 46"),
];

/// What stands for a character that has no glyph: a box.
const UNKNOWN: &str = "00 40 46 06 00";

/// The height of a capital, in steps of the grid.
const CAPITAL: f64 = 6.0;

/// From one character to the next, in steps of the grid.
const ADVANCE: f64 = 5.6;

/// How tall a small letter is, of a capital.
const SMALL: f64 = 0.78;

/// The strokes of `text`, each by its points: the baseline begins at 0 and a capital is 1 tall, X to the right and
/// Y up.
pub fn strokes(text: &str) -> impl Iterator<Item = Vec<Vec2>> {
    text.chars().enumerate().flat_map(|(place, letter)| {
        let capital = letter.to_uppercase().next().unwrap_or(letter);
        let size = if capital == letter { 1.0 } else { SMALL } / CAPITAL;
        let left = Vec2::X * (place as f64 * ADVANCE / CAPITAL);
        let glyph = GLYPHS.iter().find(|(c, _)| *c == capital).map_or(UNKNOWN, |(_, glyph)| glyph);
        let point = move |digits: &str| {
            let mut digits = digits.bytes().map(|digit| f64::from(digit.saturating_sub(b'0')));
            let mut next = || digits.next().unwrap_or_default() * size;
            left + Vec2::new(next(), next())
        };
        let strokes = glyph.split(',').filter(|stroke| !stroke.is_empty());
        strokes.map(move |stroke| stroke.split(' ').map(point).collect())
    })
}

/// How wide `text` is, capitals being 1 tall.
pub fn width(text: &str) -> f64 {
    text.chars().count() as f64 * ADVANCE / CAPITAL
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_two_digit_points_on_the_grid() {
        for (letter, glyph) in GLYPHS {
            for point in glyph.split([' ', ',']).filter(|p| !p.is_empty()) {
                let on_grid = point.len() == 2 && point < "47" && &point[1..] < "7";
                assert!(on_grid, "{letter}: {point}");
            }
        }
    }

    #[test]
    fn an_l_is_a_stroke_down_and_one_along_the_baseline() {
        let corners = [(0.0, 1.0), (0.0, 0.0), (4.0 / 6.0, 0.0)].map(|(x, y)| Vec2::new(x, y));
        assert_eq!(strokes("L").collect::<Vec<_>>(), [corners]);
        let second: Vec<Vec<Vec2>> = strokes(" L").collect();
        assert_eq!((second.len(), second[0][1]), (1, Vec2::X * (5.6 / 6.0)));
        assert_eq!(width("LL"), 11.2 / 6.0);
    }

    #[test]
    fn a_letter_without_a_glyph_is_a_box() {
        assert!(strokes("中").eq(strokes("\u{7f}")));
        assert_eq!(strokes("中").map(|stroke| stroke.len()).sum::<usize>(), 5);
    }
}
