//! Points in a block of glass: as the eye sees them, and from three sides in the order in which they are made.
//!
//! However many points there are, a picture has one dot a pixel at most.

use crate::paper::{INK, begin, shorten, write_text};
use geom::Vec3;
use glam::DVec2;
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What is drawn.
pub struct GlassPicture<'a> {
    /// Sides of the block, mm; its corner is the origin.
    pub block: [f64; 3],
    /// The points in the order in which they are made, mm.
    pub points: &'a [Vec3],
    /// How they are looked at.
    pub view: GlassView,
}

/// How points are looked at. The eye looks at the middle of the smallest box around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassView {
    /// Where the eye is, degrees: from X in the plane XY, above that plane, and by how much it is rolled to its left about its line of
    /// sight.
    pub angles: [f64; 3],
    /// How far it is from what it looks at, mm; without, some diagonals of the block.
    pub distance: Option<f64>,
    /// How many times larger than where the whole block fits.
    pub zoom: f64,
    /// Distance of the lines of a grid from the corner of the block, mm.
    pub grid: Option<f64>,
}

/// From the front and the right, a little from above.
impl Default for GlassView {
    fn default() -> GlassView {
        GlassView { angles: [-63.0, 19.0, 0.0], distance: None, zoom: 1.0, grid: None }
    }
}

impl GlassView {
    /// Whether a block (sides in mm) can be looked at so.
    ///
    /// # Errors
    /// The eye may be within the block, or the lines of the grid would hide it.
    pub fn check(&self, block: [f64; 3]) -> Result<(), Box<Diagnostic>> {
        let refused = |message: String, help: String| {
            Err(Box::new(Diagnostic::error(Rule::Drawing, message).help(help)))
        };
        let nearest = Vec3::from_array(block).length();
        if let Some(distance) = self.distance.filter(|distance| *distance <= nearest) {
            return refused(
                format!("an eye {distance} mm from the points may be within the block"),
                format!("take a --distance of more than {nearest:.1} mm, and --zoom to see more"),
            );
        }
        let longest = Vec3::from_array(block).max_element();
        if let Some(step) = self.grid.filter(|step| longest / step > MOST_LINES) {
            return refused(
                format!("a grid of {step} mm has more than {MOST_LINES} lines along a side"),
                format!("take a --grid of {:.3} mm or more", longest / MOST_LINES),
            );
        }
        Ok(())
    }
}

/// The field of the block as the eye sees it: low and high corner, pixels.
const EYE: [DVec2; 2] = [DVec2::new(40.0, 70.0), DVec2::new(590.0, 720.0)];

/// That of the three sides.
const SIDES: [DVec2; 2] = [DVec2::new(640.0, 70.0), DVec2::new(1160.0, 670.0)];

/// Between two sides, pixels.
const GAP: f64 = 24.0;

/// How far the eye is from what it looks at, diagonals of the block.
const FAR: f64 = 2.4;

/// Lines of a grid along a side, at most: more would leave nothing between them.
const MOST_LINES: f64 = 100.0;

const DARK: &str = "#10141a";
const EDGE: &str = "#4a5666";
const GRID: &str = "#2a323d";
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
    write_text(&mut out, &status(picture), DVec2::new(40.0, 60.0), 9.0, INK);
    eye(&mut out, picture);
    sides(&mut out, picture);
    legend(&mut out, picture.points.len());
    out.push_str("</svg>\n");
    out
}

/// The smallest box around the points, or the block where there are none.
fn box_of(picture: &GlassPicture) -> [Vec3; 2] {
    let both = picture.points.iter().map(|point| [*point; 2]);
    let both = both.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    both.unwrap_or([Vec3::ZERO, Vec3::from_array(picture.block)])
}

/// The sizes of block and points, and the grid.
fn status(picture: &GlassPicture) -> String {
    let [x, y, z] = picture.block;
    let [low, high] = box_of(picture);
    let size = high - low;
    let grid = picture.view.grid.map_or(String::new(), |step| format!(", GRID {step} MM"));
    format!(
        "BLOCK {x} X {y} X {z} MM, POINTS {:.3} X {:.3} X {:.3} MM{grid}",
        size.x, size.y, size.z
    )
}

/// Where the lines of a grid cross a side, mm.
fn lines(side: f64, step: Option<f64>) -> impl Iterator<Item = f64> {
    let inside = step.map_or(0, |step| (side / step - 1e-9).floor().clamp(0.0, MOST_LINES) as u32);
    (1..=inside).map(move |number| f64::from(number) * step.unwrap_or_default())
}

/// Straight lines of a colour.
fn strokes(out: &mut String, color: &str, ends: &[[DVec2; 2]]) {
    if ends.is_empty() {
        return;
    }
    let _ = write!(out, "<path stroke=\"{color}\" d=\"");
    for [from, to] in ends {
        let _ = write!(out, "M{:.1} {:.1}L{:.1} {:.1}", from.x, from.y, to.x, to.y);
    }
    out.push_str("\"/>\n");
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
    let GlassView { angles, distance, zoom, grid } = picture.view;
    let [alpha, beta, gamma] = angles.map(f64::to_radians);
    let towards = Vec3::new(beta.cos() * alpha.cos(), beta.cos() * alpha.sin(), beta.sin());
    // Of an eye that is not rolled, also straight above the block.
    let level = Vec3::new(-alpha.sin(), alpha.cos(), 0.0);
    let upright = towards.cross(level);
    let right = level * gamma.cos() + upright * gamma.sin();
    let up = upright * gamma.cos() - level * gamma.sin();
    let [from, to] = box_of(picture);
    let middle = 0.5 * (from + to);
    let corner = |bits: usize| {
        let side = |axis: usize| if bits >> axis & 1 == 1 { picture.block[axis] } else { 0.0 };
        Vec3::new(side(0), side(1), side(2))
    };
    let radius = (0..8).map(|bits| corner(bits).distance(middle)).fold(0.0, f64::max);
    let far = distance.unwrap_or(FAR * block.length());
    // The sphere around the middle that holds the block fills the field.
    let scale =
        0.47 * zoom * (high - low).min_element() * (far * far - radius * radius).sqrt() / radius;
    let center = 0.5 * (low + high);
    let seen = |place: Vec3| {
        let from = place - middle;
        let depth = far - from.dot(towards);
        center + DVec2::new(from.dot(right), -from.dot(up)) * (scale / depth)
    };
    let size = high - low;
    let _ = writeln!(
        out,
        "<clipPath id=\"eye\"><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/></clipPath>\n<g clip-path=\"url(#eye)\">",
        low.x, low.y, size.x, size.y
    );
    // On the floor of the block.
    let along = lines(block.x, grid).map(|x| [Vec3::X * x, Vec3::new(x, block.y, 0.0)]);
    let across = lines(block.y, grid).map(|y| [Vec3::Y * y, Vec3::new(block.x, y, 0.0)]);
    let floor: Vec<_> = along.chain(across).map(|ends| ends.map(seen)).collect();
    strokes(out, GRID, &floor);
    let edges = (0..8).flat_map(|bits| (0..3).map(move |axis| (bits, bits | 1 << axis)));
    let edges = edges.filter(|(from, to)| from != to);
    let edges: Vec<_> = edges.map(|(from, to)| [from, to].map(|bits| seen(corner(bits)))).collect();
    strokes(out, EDGE, &edges);
    let mut counts: BTreeMap<(i32, i32), u32> = BTreeMap::new();
    for at in picture.points.iter().map(|point| seen(*point)) {
        if at.cmpge(low).all() && at.cmple(high).all() {
            *counts.entry(pixel(at)).or_default() += 1;
        }
    }
    for (level, bright) in BRIGHT.iter().enumerate() {
        let own = |count: u32| (count.ilog2() as usize).min(BRIGHT.len() - 1) == level;
        let pixels: Vec<_> =
            counts.iter().filter(|(_, count)| own(**count)).map(|(at, _)| *at).collect();
        dots(out, LIGHT, *bright, &pixels);
    }
    out.push_str("</g>\n");
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
        let grid = |axis: usize| lines(picture.block[axis], picture.view.grid);
        let upright = grid(across).map(|at| low.x + at * scale);
        let upright = upright.map(|x| [DVec2::new(x, low.y), DVec2::new(x, high.y)]);
        let level = grid(up).map(|at| high.y - at * scale);
        let level = level.map(|y| [DVec2::new(low.x, y), DVec2::new(high.x, y)]);
        strokes(out, GRID, &upright.chain(level).collect::<Vec<_>>());
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
        let picture =
            GlassPicture { block: [10.0; 3], points: &points, view: GlassView::default() };
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
            let view = GlassView::default();
            let svg = glass("corners", &GlassPicture { block, points: &corners, view });
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

    /// Where the dots of the view in perspective are, pixels from the middle of its field.
    fn dots_seen(points: &[Vec3], view: GlassView) -> Vec<DVec2> {
        let svg = glass("dots", &GlassPicture { block: [10.0; 3], points, view });
        let eye = svg.split("stroke=\"#ffffff\"").skip(1).map(|path| path.split('>').next());
        let dots = eye.flatten().flat_map(|path| path.split('M').skip(1));
        let place = |dot: &str| {
            let (x, y) = dot.split_once('h')?.0.split_once(' ')?;
            Some(DVec2::new(x.parse().ok()?, y.parse().ok()?) - 0.5 * (EYE[0] + EYE[1]))
        };
        dots.filter_map(place).collect()
    }

    #[test]
    fn the_eye_is_where_its_angles_say() {
        // Points at the ends of the axes, 8 mm apart, around the middle of a block of 10 mm, seen from 100 mm: half of the field, 275
        // pixels, times 0.94, shows a sphere of 8.660 mm, so that a mm at the middle is 258.5 × √(1 - 0.0866²) / 8.660 = 29.738 pixels.
        let ends = |axis: Vec3| [Vec3::splat(5.0) - 4.0 * axis, Vec3::splat(5.0) + 4.0 * axis];
        let points: Vec<Vec3> = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(ends).collect();
        let seen = |angles: [f64; 3], zoom: f64| {
            let view = GlassView { angles, distance: Some(100.0), zoom, grid: None };
            let mut dots: Vec<[i64; 2]> =
                dots_seen(&points, view).iter().map(|at| [at.x as i64, at.y as i64]).collect();
            dots.sort_unstable();
            dots
        };
        // From the front (-Y): X to the right, Z up, both ends of Y in the middle. 4 mm are 118.95 pixels; the field is 550 x 650.
        let cross = vec![[-119, 0], [0, -119], [0, 0], [0, 119], [119, 0]];
        assert_eq!(seen([-90.0, 0.0, 0.0], 1.0), cross);
        // From straight above, with -Y towards the reader: Y up.
        assert_eq!(seen([-90.0, 90.0, 0.0], 1.0), cross);
        // Half as large.
        let half = vec![[-59, 0], [0, -59], [0, 0], [0, 59], [59, 0]];
        assert_eq!(seen([-90.0, 0.0, 0.0], 0.5), half);
        // Ten times as large, the ends are outside.
        assert_eq!(seen([-90.0, 0.0, 0.0], 10.0), [[0, 0]]);
        // An eye rolled to its left by 30°: the picture turns to the right, so that X goes down. 118.95 × (cos 30°, sin 30°).
        let rolled = vec![[-103, -59], [-59, 103], [0, 0], [59, -103], [103, 59]];
        assert_eq!(seen([-90.0, 0.0, 30.0], 1.0), rolled);
        // From the right (+X) and 30° above: Y to the right, Z up by cos 30°, X, which comes near, down by sin 30° and larger by 100 over
        // 100 - 4 cos 30°, and on the far side smaller.
        let above = vec![[-119, 0], [0, -105], [0, -57], [0, 62], [0, 101], [119, 0]];
        assert_eq!(seen([0.0, 30.0, 0.0], 1.0), above);
    }

    #[test]
    fn a_grid_has_a_line_each_step_and_the_size_is_told() {
        let points = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 6.5, 9.0)];
        let view = GlassView { grid: Some(2.5), ..GlassView::default() };
        let svg = glass("grid", &GlassPicture { block: [10.0, 5.0, 7.0], points: &points, view });
        // On the floor 3 and 1 lines (at the edges none), from above 3 and 1, the front 3 and 2, the right 1 and 2.
        let grids = svg.lines().filter(|line| line.contains(GRID));
        let counts: Vec<usize> = grids.map(|line| line.matches('M').count()).collect();
        assert_eq!(counts, [4, 4, 5, 3]);
        assert!(svg.contains("BLOCK 10 X 5 X 7 MM, POINTS 3.000 X 4.500 X 6.000 MM, GRID 2.5 MM"));
    }

    #[test]
    fn a_view_from_within_the_block_and_a_grid_without_gaps_are_refused() {
        let view = GlassView { distance: Some(17.0), ..GlassView::default() };
        // The diagonal is 17.32 mm.
        assert!(view.check([10.0; 3]).unwrap_err().message.contains("within the block"));
        assert!(GlassView { distance: Some(17.4), ..view }.check([10.0; 3]).is_ok());
        let view = GlassView { grid: Some(0.099), ..GlassView::default() };
        assert!(view.check([10.0; 3]).unwrap_err().help.contains("--grid of 0.100 mm"));
        assert!(GlassView { grid: Some(0.1), ..view }.check([10.0; 3]).is_ok());
    }
}
