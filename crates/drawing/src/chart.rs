//! Charts: curves over a scale that both begin at 0, up to four on a sheet.

use crate::lettering;
use crate::paper::{COLORS, INK, begin, shorten, write_text};
use glam::DVec2;
use std::fmt::Write as _;

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it is: curves of one name, one after another, have one row of the key.
    pub name: String,
    /// Its places, from low to high; those that are no numbers, or less than 0, are left out.
    pub points: Vec<[f64; 2]>,
    /// Whether they are marks, each by itself, instead of a line.
    pub is_marked: bool,
    /// Which of the colours it has: curves that belong together have the same.
    pub color: usize,
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What goes up, with its unit.
    pub up: String,
    /// What goes across, with its unit.
    pub across: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Low corners of the fields, and their size, pixels.
const FIELDS: [DVec2; 4] = [
    DVec2::new(90.0, 90.0),
    DVec2::new(680.0, 90.0),
    DVec2::new(90.0, 440.0),
    DVec2::new(680.0, 440.0),
];
const FIELD: DVec2 = DVec2::new(470.0, 260.0);

const LINE: &str = "#d9dcdf";

/// Lines of a scale, at most.
const LINES: f64 = 8.0;

/// Draws charts, four at most, as SVG under a title.
pub fn charts(title: &str, charts: &[Chart]) -> String {
    let mut out = begin(title);
    write_text(&mut out, &shorten(title, 80), DVec2::new(40.0, 40.0), 12.0, INK);
    for (chart, low) in charts.iter().zip(FIELDS) {
        draw(&mut out, chart, low);
    }
    out.push_str("</svg>\n");
    out
}

/// The distance of the lines of a scale up to `most`: 1, 2 or 5 times a power of ten.
fn step(most: f64) -> f64 {
    let least = most / LINES;
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|part| part * power)
        .find(|step| *step >= least)
        .unwrap_or(10.0 * power)
}

fn draw(out: &mut String, chart: &Chart, low: DVec2) {
    let high = low + FIELD;
    let is_drawn = |at: &&[f64; 2]| at.iter().all(|value| value.is_finite() && *value >= 0.0);
    let all = || chart.curves.iter().flat_map(|curve| &curve.points).filter(is_drawn);
    // A scale ends with a line.
    let [across, up] = [0, 1].map(|axis: usize| {
        let most = all().map(|at| at[axis]).fold(0.0, f64::max).max(1e-9);
        (step(most), (most / step(most) - 1e-9).ceil() * step(most))
    });
    let seen = |at: [f64; 2]| {
        DVec2::new(low.x + at[0] / across.1 * FIELD.x, high.y - at[1] / up.1 * FIELD.y)
    };
    let places = |(step, most): (f64, f64)| {
        (0..=(most / step).round() as u32).map(move |i| f64::from(i) * step)
    };
    let number = |value: f64| format!("{}", (value * 1e6).round() / 1e6);
    let line = |out: &mut String, from: DVec2, to: DVec2| {
        let _ = writeln!(
            out,
            "<path stroke=\"{LINE}\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/>",
            from.x, from.y, to.x, to.y
        );
    };
    for value in places(across) {
        let at = seen([value, 0.0]);
        line(out, at, DVec2::new(at.x, low.y));
        let text = number(value);
        let half = 0.5 * lettering::width(&text, 8.0);
        write_text(out, &text, DVec2::new(at.x - half, at.y + 15.0), 8.0, INK);
    }
    for value in places(up) {
        let at = seen([0.0, value]);
        line(out, at, DVec2::new(high.x, at.y));
        let text = number(value);
        let width = lettering::width(&text, 8.0);
        write_text(out, &text, DVec2::new(at.x - width - 8.0, at.y + 4.0), 8.0, INK);
    }
    write_text(out, &chart.up, DVec2::new(low.x, low.y - 10.0), 9.0, INK);
    let width = lettering::width(&chart.across, 9.0);
    write_text(out, &chart.across, DVec2::new(high.x - width, high.y + 34.0), 9.0, INK);
    // A row of the key for each name.
    let mut names: Vec<&str> = chart.curves.iter().map(|curve| &*curve.name).collect();
    names.dedup();
    let widest = names.iter().map(|name| lettering::width(name, 8.0)).fold(0.0, f64::max);
    let key = high - DVec2::new(widest + 40.0, 14.0 * names.len() as f64);
    for (row, name) in names.iter().enumerate() {
        let at = key + DVec2::new(28.0, 14.0 * row as f64 + 4.0);
        write_text(out, name, at, 8.0, INK);
    }
    for curve in &chart.curves {
        let [r, g, b] = COLORS[curve.color % COLORS.len()];
        let color = format!("rgb({r},{g},{b})");
        let places = curve.points.iter().filter(is_drawn).map(|at| seen(*at));
        let row = names.iter().position(|name| *name == curve.name).unwrap_or_default();
        let key = key + DVec2::Y * (14.0 * row as f64);
        let (drawn, width) = if curve.is_marked {
            let dot = |at: DVec2| format!("M{:.1} {:.1}h.1", at.x, at.y);
            (places.chain([key + DVec2::X * 10.0]).map(dot).collect::<String>(), 5.0)
        } else {
            let corner = |(i, at): (usize, DVec2)| {
                format!("{}{:.1} {:.1}", if i == 0 { 'M' } else { 'L' }, at.x, at.y)
            };
            let key = format!("M{:.1} {:.1}h20", key.x, key.y);
            (places.enumerate().map(corner).collect::<String>() + &key, 1.5)
        };
        let _ = writeln!(out, "<path stroke=\"{color}\" stroke-width=\"{width}\" d=\"{drawn}\"/>");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_lie_where_their_scales_say() {
        let curve = |points: Vec<[f64; 2]>, is_marked| Curve {
            name: String::from("CURVE"),
            points,
            is_marked,
            color: 0,
        };
        // Up to 10 and 85: lines every 2 and every 20, so that the scales end at 10 and 100.
        let marks = curve(vec![[0.0, 0.0], [10.0, 85.0], [5.0, f64::NAN], [5.0, -1.0]], true);
        let line = curve(vec![[0.0, 50.0], [10.0, 25.0]], false);
        let chart = Chart {
            up: String::from("POINTS/S"),
            across: String::from("M/S2"),
            curves: vec![marks, line],
        };
        let svg = charts("TITLE", &[chart]);
        // The corner of the first field, and its far side: 85 % of 260 pixels above 350.
        assert!(svg.contains("M90.0 350.0h.1M560.0 129.0h.1M"), "{svg}");
        assert!(svg.contains("d=\"M90.0 220.0L560.0 285.0M"), "{svg}");
        for label in ["POINTS/S", "M/S2", "100", "80", "10", "CURVE", "TITLE"] {
            assert!(svg.contains(&format!("aria-label=\"{label}\"")), "{label}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("aria-label=\"120\""), "{svg}");
    }

    #[test]
    fn lines_of_a_scale_are_round_and_no_more_than_eight() {
        for (most, own) in
            [(8.0, 1.0), (8.1, 2.0), (17.0, 5.0), (0.5, 0.1), (85.0, 20.0), (371.0, 50.0)]
        {
            assert!((step(most) - own).abs() < 1e-12, "{most}: {}", step(most));
        }
    }

    #[test]
    fn a_chart_without_places_is_drawn() {
        let chart = Chart { up: String::new(), across: String::new(), curves: Vec::new() };
        assert!(charts("NONE", &[chart]).ends_with("</svg>\n"));
    }
}
