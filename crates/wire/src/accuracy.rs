//! How well points follow their contour, measured on the points.

use crate::contour::Contour;
use crate::path::Path;
use crate::points::Points;
use geom::{Vec2, turn_angle};
use sketch::Element;

/// The chord errors of some chords of arcs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chords {
    /// How many chords, and so points without the start.
    pub count: usize,
    /// The largest chord error, mm.
    pub largest: f64,
    /// The mean chord error, mm.
    pub mean: f64,
    /// The mean of chord error / radius.
    pub mean_relative: f64,
}

impl Chords {
    /// One more chord.
    fn add(&mut self, error: f64, radius: f64) {
        self.count += 1;
        self.largest = self.largest.max(error);
        self.mean += (error - self.mean) / self.count as f64;
        self.mean_relative += (error / radius - self.mean_relative) / self.count as f64;
    }
}

/// An arc and its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcChords {
    /// Index of the element in the path.
    pub element: usize,
    /// Line of the source.
    pub line: u32,
    /// Radius, mm.
    pub radius: f64,
    /// Its chords.
    pub chords: Chords,
}

/// How well the points of one end of the wire follow its contour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// Every arc, in order.
    pub arcs: Vec<ArcChords>,
    /// All arcs together.
    pub all: Chords,
    /// Area within the points less area within the contour, mm²; `None` for an open contour.
    pub area_error: Option<f64>,
}

impl Accuracy {
    /// Of the lower end, and of the upper one where the wire leans.
    pub fn of(path: &Path, points: &Points) -> (Accuracy, Option<Accuracy>) {
        let of = |contour, places| Accuracy::of_contour(contour, places, points);
        (of(path.lower(), &points.lower), path.upper().map(|upper| of(upper, &points.upper)))
    }

    fn of_contour(contour: &Contour, places: &[Vec2], points: &Points) -> Accuracy {
        let mut accuracy = Accuracy::default();
        for (i, element) in contour.elements().iter().enumerate() {
            let range = points.of_element(i);
            let Some(radius) = element.radius() else { continue };
            let mut chords = Chords::default();
            for pair in
                places.get(range.start.saturating_sub(1)..range.end).unwrap_or_default().windows(2)
            {
                let error = chord_error(element, pair[0], pair[1]);
                chords.add(error, radius);
                accuracy.all.add(error, radius);
            }
            accuracy.arcs.push(ArcChords { element: i, line: element.line, radius, chords });
        }
        if contour.is_closed() {
            let start = contour.start();
            let twice: f64 = places.windows(2).map(|p| (p[0] - start).perp_dot(p[1] - start)).sum();
            accuracy.area_error = Some(twice / 2.0 - contour.area());
        }
        accuracy
    }
}

/// The greatest distance between an arc and its chord from `from` to `to`, mm.
fn chord_error(arc: &Element, from: Vec2, to: Vec2) -> f64 {
    arc.turn.map_or(0.0, |turn| {
        let sweep = turn_angle(from - turn.center, to - turn.center);
        2.0 * from.distance(turn.center) * (sweep / 4.0).sin().powi(2)
    })
}
