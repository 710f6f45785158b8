//! Pieces as pixels: a rasteriser that shares nothing with the crate.

use geom::{Element, Vec2};
use toolpost_pcb::Piece;
use toolpost_pcb::excellon::Drill;
use toolpost_pcb::gerber::Image;

/// Which pixels are dark. A pixel is dark where its centre is.
pub struct Raster {
    pub width: usize,
    pub height: usize,
    /// Lower left corner, mm.
    pub origin: Vec2,
    /// Size of a pixel, mm.
    pub pixel: f64,
    /// Row by row, from the top.
    pub dark: Vec<bool>,
    /// Which pixels are next to an edge of some piece, also where another piece covers it.
    near: Vec<bool>,
}

impl Raster {
    /// All light, over the box from `low` to `high` and some pixels more; its corner is on a whole pixel.
    pub fn over((low, high): (Vec2, Vec2), pixel: f64) -> Raster {
        let low = (low / pixel).floor() - Vec2::splat(20.0);
        let high = (high / pixel).ceil() + Vec2::splat(20.0);
        let (width, height) = ((high.x - low.x) as usize, (high.y - low.y) as usize);
        let none = vec![false; width * height];
        Raster { width, height, origin: low * pixel, pixel, dark: none.clone(), near: none }
    }

    /// The image, or of a large one the middle, `most` mm wide and high.
    pub fn of_image(image: &Image, pixel: f64, most: f64) -> Option<Raster> {
        let mut raster = Raster::over(middle(image.extents()?, most), pixel);
        for object in &image.objects {
            raster.paint(&image.pieces(object), object.dark);
        }
        Some(raster)
    }

    /// The same of what is drilled.
    pub fn of_drill(drill: &Drill, pixel: f64, most: f64) -> Option<Raster> {
        let mut raster = Raster::over(middle(drill.extents()?, most), pixel);
        for cut in &drill.cuts {
            raster.paint(&drill.pieces(cut), true);
        }
        Some(raster)
    }

    /// How much is dark, mm².
    pub fn area(&self) -> f64 {
        self.dark.iter().filter(|dark| **dark).count() as f64 * self.pixel * self.pixel
    }

    /// Paints a shape: the pieces are put together first, then they darken or clear.
    pub fn paint(&mut self, pieces: &[Piece], dark: bool) {
        match pieces {
            [piece] if piece.solid => {
                for (row, from, to) in self.spans(piece) {
                    self.dark[row * self.width + from..row * self.width + to].fill(dark);
                }
            }
            _ => {
                let spans: Vec<_> = pieces.iter().map(|p| (p.solid, self.spans(p))).collect();
                let rows = spans.iter().flat_map(|(_, spans)| spans).map(|span| span.0);
                let Some(last) = rows.clone().max() else { return };
                let first = rows.min().unwrap_or(last);
                let mut shape = vec![false; (last + 1 - first) * self.width];
                for (solid, spans) in &spans {
                    for (row, from, to) in spans {
                        let start = (row - first) * self.width;
                        shape[start + from..start + to].fill(*solid);
                    }
                }
                let under = &mut self.dark[first * self.width..(last + 1) * self.width];
                for (pixel, covered) in under.iter_mut().zip(shape) {
                    if covered {
                        *pixel = dark;
                    }
                }
            }
        }
    }

    /// What a piece covers, by the winding number: row, first pixel, pixel after the last.
    fn spans(&mut self, piece: &Piece) -> Vec<(usize, usize, usize)> {
        let mut edges: Vec<(Vec2, Vec2)> = Vec::new();
        for element in piece.contours.iter().flat_map(|contour| contour.elements()) {
            let mut last = self.to_pixels(element.start);
            for point in flattened(element) {
                let next = self.to_pixels(point);
                self.mark(last, next);
                edges.push((last, next));
                last = next;
            }
        }
        let low = edges.iter().map(|(a, b)| a.y.min(b.y)).fold(f64::INFINITY, f64::min);
        let high = edges.iter().map(|(a, b)| a.y.max(b.y)).fold(0.0, f64::max);
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let last = ((high - 0.5).ceil().max(0.0) as usize).min(self.height);
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); last.saturating_sub(first)];
        for (a, b) in edges {
            let (up, low, high) = if a.y < b.y { (1, a, b) } else { (-1, b, a) };
            let from = (low.y - 0.5).ceil().max(first as f64) as usize;
            let to = ((high.y - 0.5).ceil().max(0.0) as usize).min(last);
            for row in from..to {
                let y = row as f64 + 0.5;
                let x = low.x + (high.x - low.x) * (y - low.y) / (high.y - low.y);
                crossings[row - first].push((x, up));
            }
        }
        let mut spans = Vec::new();
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut winding = 0;
            for pair in crossings.windows(2) {
                winding += pair[0].1;
                let column = |x: f64| ((x - 0.5).ceil().max(0.0) as usize).min(self.width);
                let (from, to) = (column(pair[0].0), column(pair[1].0));
                if winding != 0 && from < to {
                    spans.push((first + row, from, to));
                }
            }
        }
        spans
    }

    /// Pixels from the upper left corner.
    fn to_pixels(&self, point: Vec2) -> Vec2 {
        let from = (point - self.origin) / self.pixel;
        Vec2::new(from.x, self.height as f64 - from.y)
    }

    /// Marks the pixels that an edge runs through, and those around them.
    fn mark(&mut self, a: Vec2, b: Vec2) {
        let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
        let slope = (high.x - low.x) / (high.y - low.y).max(1e-9);
        let cell = |value: f64, most: usize| (value.max(0.0) as usize).min(most - 1);
        let outside = high.y < -2.0 || low.y > self.height as f64 + 2.0;
        if outside || a.x.max(b.x) < -2.0 || a.x.min(b.x) > self.width as f64 + 2.0 {
            return;
        }
        for row in cell(low.y, self.height)..=cell(high.y, self.height) {
            let at = |y: f64| low.x + (y.clamp(low.y, high.y) - low.y) * slope;
            let (p, q) = (at(row as f64), at(row as f64 + 1.0));
            let (p, q) = if high.y - low.y < 1e-6 { (low.x, high.x) } else { (p, q) };
            let from = cell(p.min(q) - 1.0, self.width);
            let to = cell(p.max(q) + 1.0, self.width);
            for near in row.saturating_sub(1)..(row + 2).min(self.height) {
                self.near[near * self.width + from..=near * self.width + to].fill(true);
            }
        }
    }

    /// How many pixels differ from `other` away from all edges, and how many differ at all.
    pub fn differences(&self, other: &[bool]) -> (usize, usize) {
        let differ = |i: &usize| self.dark[*i] != other[*i];
        let all: Vec<usize> = (0..other.len()).filter(differ).collect();
        (all.iter().filter(|i| !self.near[**i]).count(), all.len())
    }
}

/// The middle of a box, at most so many mm wide and high.
fn middle((low, high): (Vec2, Vec2), most: f64) -> (Vec2, Vec2) {
    let (center, half) = (low.midpoint(high), ((high - low) / 2.0).min(Vec2::splat(most / 2.0)));
    (center - half, center + half)
}

/// Points of an element after its start; chords leave an arc by 0.1 µm at most.
fn flattened(element: &Element) -> Vec<Vec2> {
    let Some(turn) = element.turn else { return vec![element.end] };
    let from = element.start - turn.center;
    let step = 2.0 * (1.0 - 1e-4 / from.length().max(1e-3)).acos();
    let count = (turn.sweep.abs() / step).ceil().max(4.0) as usize;
    let point = |i: usize| {
        let angle = turn.sweep * i as f64 / count as f64;
        turn.center + Vec2::from_angle(angle).rotate(from)
    };
    (1..count).map(point).chain([element.end]).collect()
}
