//! Points in a block of glass: as the eye sees them, and from three sides in the order in which they are made.
//!
//! However many points there are, a picture has one dot a pixel at most.

use crate::paper::{INK, begin, shorten, write_text};
use geom::Vec3;
use glam::DVec2;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What is drawn.
pub struct GlassPicture<'a> {
    /// Sides of the block, mm; its corner is the origin.
    pub block: [f64; 3],
    /// The points in the order in which they are made, mm.
    pub points: &'a [Vec3],
}

/// The field of the block as the eye sees it: low and high corner, pixels.
const EYE: [DVec2; 2] = [DVec2::new(40.0, 70.0), DVec2::new(590.0, 720.0)];

/// That of the three sides.
const SIDES: [DVec2; 2] = [DVec2::new(640.0, 70.0), DVec2::new(1160.0, 670.0)];

/// Between two sides, pixels.
const GAP: f64 = 24.0;

/// Where the eye is: its angles from X in the plane XY, and from that plane (radians), and its distance from the middle of the
/// block in diagonals of it.
const CAMERA: (f64, f64, f64) = (-1.1, 0.33, 2.4);

const DARK: &str = "#10141a";
const EDGE: &str = "#4a5666";
const LIGHT: &str = "#ffffff";

/// Colours from the first point to the last (viridis, whose lightness grows evenly).
const ORDER: [&str; 10] = [
    "#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58",
    "#b5de2b", "#fde725",
];

/// How bright a dot is by how many points it stands for: 1, 2 or 3, 4 to 7, and so on.
const BRIGHT: [f64; 6] = [0.45, 0.58, 0.7, 0.8, 0.9, 1.0];

/// Draws points in glass as SVG under a title.
pub fn glass(title: &str, picture: &GlassPicture) -> String {
    let mut out = begin(&format!("Points in glass of {title}"));
    write_text(&mut out, &shorten(title, 60), DVec2::new(40.0, 40.0), 12.0, INK);
    eye(&mut out, picture);
    sides(&mut out, picture);
    legend(&mut out, picture.points.len());
    out.push_str("</svg>\n");
    out
}

fn field(out: &mut String, low: DVec2, high: DVec2) {
    let size = high - low;
    let _ = writeln!(
        out,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{DARK}\" stroke=\"{EDGE}\"/>",
        low.x, low.y, size.x, size.y
    );
}

/// Dots at these pixels, all in one piece.
fn dots(out: &mut String, color: &str, opacity: f64, pixels: &[(i32, i32)]) {
    if pixels.is_empty() {
        return;
    }
    let _ = write!(
        out,
        "<path stroke=\"{color}\" stroke-opacity=\"{opacity}\" stroke-width=\"1.3\" d=\""
    );
    for (x, y) in pixels {
        let _ = write!(out, "M{x} {y}h.1");
    }
    out.push_str("\"/>\n");
}

fn pixel(at: DVec2) -> (i32, i32) {
    (at.x.round() as i32, at.y.round() as i32)
}

/// The block in perspective; where several points fall on a pixel, it is brighter.
fn eye(out: &mut String, picture: &GlassPicture) {
    let [low, high] = EYE;
    field(out, low, high);
    let block = Vec3::from_array(picture.block);
    let (alpha, beta, distance) = CAMERA;
    let towards = Vec3::new(beta.cos() * alpha.cos(), beta.cos() * alpha.sin(), beta.sin());
    let right = Vec3::Z.cross(towards).normalize();
    let up = towards.cross(right);
    let far = distance * block.length();
    // The block's sphere fills the field.
    let scale =
        0.47 * (high - low).min_element() * (far * far - 0.25 * block.length_squared()).sqrt()
            / (0.5 * block.length());
    let middle = 0.5 * (low + high);
    let seen = |place: Vec3| {
        let from = place - 0.5 * block;
        let depth = far - from.dot(towards);
        middle + DVec2::new(from.dot(right), -from.dot(up)) * (scale / depth)
    };
    let corner = |bits: usize| {
        let side = |axis: usize| if bits >> axis & 1 == 1 { picture.block[axis] } else { 0.0 };
        seen(Vec3::new(side(0), side(1), side(2)))
    };
    let _ = write!(out, "<path stroke=\"{EDGE}\" d=\"");
    for bits in 0..8 {
        for axis in (0..3).filter(|axis| bits >> axis & 1 == 0) {
            let (from, to) = (corner(bits), corner(bits | 1 << axis));
            let _ = write!(out, "M{:.1} {:.1}L{:.1} {:.1}", from.x, from.y, to.x, to.y);
        }
    }
    out.push_str("\"/>\n");
    let mut counts: BTreeMap<(i32, i32), u32> = BTreeMap::new();
    for point in picture.points {
        *counts.entry(pixel(seen(*point))).or_default() += 1;
    }
    for (level, bright) in BRIGHT.iter().enumerate() {
        let own = |count: u32| (count.ilog2() as usize).min(BRIGHT.len() - 1) == level;
        let pixels: Vec<_> =
            counts.iter().filter(|(_, count)| own(**count)).map(|(at, _)| *at).collect();
        dots(out, LIGHT, *bright, &pixels);
    }
}

/// From above, the front and the right, all of one scale; the colour says when a point is made.
fn sides(out: &mut String, picture: &GlassPicture) {
    let [low, high] = SIDES;
    let [x, y, z] = picture.block;
    let room = high - low - GAP;
    let scale = (room.x / (x + y)).min(room.y / (y + z));
    let above = [low, low + DVec2::new(x, y) * scale];
    let front_low = DVec2::new(low.x, above[1].y + GAP);
    let front = [front_low, front_low + DVec2::new(x, z) * scale];
    let right_low = DVec2::new(front[1].x + GAP, front_low.y);
    let right = [right_low, right_low + DVec2::new(y, z) * scale];
    let axes: [([DVec2; 2], usize, usize); 3] = [(above, 0, 1), (front, 0, 2), (right, 1, 2)];
    for ([low, high], across, up) in axes {
        field(out, low, high);
        let seen =
            |place: &Vec3| DVec2::new(low.x + place[across] * scale, high.y - place[up] * scale);
        let mut last: BTreeMap<(i32, i32), usize> = BTreeMap::new();
        for (i, point) in picture.points.iter().enumerate() {
            last.insert(pixel(seen(point)), i * ORDER.len() / picture.points.len());
        }
        for (class, color) in ORDER.iter().enumerate() {
            let own = last.iter().filter(|(_, own)| **own == class);
            let pixels: Vec<_> = own.map(|(at, _)| *at).collect();
            dots(out, color, 1.0, &pixels);
        }
    }
}

/// Which colour is first and which last.
fn legend(out: &mut String, points: usize) {
    let low = DVec2::new(SIDES[0].x + 90.0, 700.0);
    for (i, color) in ORDER.iter().enumerate() {
        let x = low.x + 20.0 * i as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{x}\" y=\"{}\" width=\"20\" height=\"12\" fill=\"{color}\"/>",
            low.y
        );
    }
    let y = low.y + 11.0;
    write_text(out, "FIRST", DVec2::new(SIDES[0].x, y), 9.0, INK);
    let end = low.x + 20.0 * ORDER.len() as f64 + 16.0;
    write_text(out, &format!("LAST OF {points}"), DVec2::new(end, y), 9.0, INK);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_a_dot_a_pixel_at_most_and_the_last_point_is_yellow() {
        // 100,000 points in one place, and one in the opposite corner, made last.
        let mut points = vec![Vec3::splat(1.0); 100_000];
        points.push(Vec3::splat(9.0));
        let picture = GlassPicture { block: [10.0; 3], points: &points };
        let svg = glass("cube", &picture);
        assert!(svg.len() < 20_000, "{}", svg.len());
        // Four views of two places.
        assert_eq!(svg.matches("h.1").count(), 8);
        assert_eq!(svg.matches("stroke=\"#fde725\"").count(), 3, "{svg}");
        // 1 mm from the corner, and 9 mm: the scale is (520 - 24) / 20 pixels a mm; above, Y goes up from 70 + 248 pixels.
        assert!(svg.contains("M665 293h.1") && svg.contains("M863 95h.1"), "{svg}");
        assert_eq!(svg, glass("cube", &picture));
    }

    #[test]
    fn the_eye_sees_the_whole_block() {
        for block in [[1.0, 1.0, 1.0], [300.0, 1.0, 1.0], [1.0, 1.0, 300.0], [50.0, 50.0, 80.0]] {
            let corners: Vec<Vec3> = (0..8)
                .map(|bits| {
                    let side = |axis: usize| if bits >> axis & 1 == 1 { block[axis] } else { 0.0 };
                    Vec3::new(side(0), side(1), side(2))
                })
                .collect();
            let svg = glass("corners", &GlassPicture { block, points: &corners });
            let [low, high] = EYE;
            let eye = svg.split("stroke=\"#ffffff\"").skip(1).map(|path| path.split('>').next());
            let dots = eye.flatten().flat_map(|path| path.split('M').skip(1));
            let mut count = 0;
            for dot in dots {
                let at: Vec<f64> = dot
                    .trim_end_matches(|c: char| !c.is_ascii_digit())
                    .split([' ', 'h'])
                    .map_while(|number| number.parse().ok())
                    .collect();
                assert!(
                    at[0] > low.x && at[0] < high.x && at[1] > low.y && at[1] < high.y,
                    "{dot}"
                );
                count += 1;
            }
            assert!((1..=8).contains(&count), "{count}");
        }
    }
}
