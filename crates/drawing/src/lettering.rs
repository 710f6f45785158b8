//! Texts of a drawing as SVG path data.

use geom::lettering;
use std::fmt::Write as _;

/// The strokes of `text`, baseline from (`x`, `y`), capitals `height` pixels tall.
pub fn strokes(text: &str, x: f64, y: f64, height: f64) -> String {
    let mut data = String::new();
    for stroke in lettering::strokes(text) {
        for (i, point) in stroke.iter().enumerate() {
            let pen = if i == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{pen}{:.1} {:.1}", x + point.x * height, y - point.y * height);
        }
    }
    data
}

/// How wide `text` is, in pixels, for capitals `height` pixels tall.
pub fn width(text: &str, height: f64) -> f64 {
    lettering::width(text) * height
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_is_a_stroke_down_and_one_along_the_baseline() {
        assert_eq!(strokes("L", 10.0, 100.0, 6.0), "M10.0 94.0L10.0 100.0L14.0 100.0");
    }
}
