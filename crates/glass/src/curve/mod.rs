//! Curves: their readers (DXF, HPGL), and points along them.
//!
//! A curve is kept as corners so near to each other that their chords leave it by no more than `FINE` of its drawing. Points
//! follow one another at equal chords, so that neighbours on a bent curve are no nearer than on a straight one.

mod dxf;
mod hpgl;

use crate::cloud::{self, Point};
use crate::mesh::{Fault, LARGEST};
use geom::ending::go_on;
use glam::{DVec2, DVec3};
use program::{Diagnostic, Rule, encoding};
use std::f64::consts::TAU;

/// By which part of the size of a drawing chords leave its curves, at most: 1 µm of 100 mm.
const FINE: f64 = 1e-5;

/// The most corners that curves may come to.
const MOST: usize = 20_000_000;

/// A curve, or a single point, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its corners, one at least; of a closed one the last is the first.
    pub corners: Vec<DVec3>,
}

impl Curve {
    /// Whether it ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.corners.len() > 2 && self.corners.first() == self.corners.last()
    }
}

/// What a drawing holds.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Its curves, in the order of the file.
    pub curves: Vec<Curve>,
    /// What was left out or assumed.
    pub warnings: Vec<Diagnostic>,
}

/// The form of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// DXF, ASCII.
    Dxf,
    /// HP-GL, in units of 0.025 mm.
    Hpgl,
}

/// Reads the bytes of the file `file`.
///
/// # Errors
/// What is wrong with it, with its line.
pub fn read(bytes: &[u8], form: Form, file: &str) -> Result<Curves, Box<Diagnostic>> {
    if encoding::is_utf_16(bytes) {
        return Err(encoding::utf_16().file(file).into());
    }
    let bytes = encoding::without_mark(bytes);
    let read = match form {
        Form::Dxf => dxf::read(bytes),
        Form::Hpgl => hpgl::read(bytes).map_err(|fault| fault.diagnostic("")),
    };
    let mut curves = read.map_err(|found| Box::new(found.file(file)))?;
    if curves.curves.is_empty() {
        let fault = Fault::new(Rule::Empty, "has no curve that is read");
        return Err(fault.diagnostic(file));
    }
    let all = curves.curves.iter().flat_map(|curve| &curve.corners);
    let is_far = |at: &&DVec3| !at.is_finite() || at.abs().max_element() > LARGEST;
    if let Some(far) = all.into_iter().find(is_far) {
        let message = format!("a curve passes {far}: beyond 1 km");
        return Err(Fault::new(Rule::Coordinate, message).diagnostic(file));
    }
    for warning in &mut curves.warnings {
        *warning = warning.clone().file(file);
    }
    Ok(curves)
}

/// The corners of an arc about `center` after `start`, turned by `sweep` (radians): their chords leave it by `tolerance` at most.
fn arc(start: DVec2, center: DVec2, sweep: f64, tolerance: f64) -> impl Iterator<Item = DVec2> {
    let from = start - center;
    let bend = (1.0 - tolerance / from.length().max(tolerance)).clamp(-1.0, 1.0).acos();
    let count = (sweep.abs() / (2.0 * bend)).ceil().clamp(1.0, 1e6) as u32;
    let turned = move |i| DVec2::from_angle(sweep * f64::from(i) / f64::from(count)).rotate(from);
    (1..=count).map(move |i| center + turned(i))
}

/// Copies of curves along an axis (spec 4.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// How many there are, 1 at least; the middle one lies where the drawing does.
    pub count: u32,
    /// Their distance, mm; without, the least that rounding takes.
    pub distance: Option<f64>,
    /// By which part of the step the points of each begin later than those of the one before.
    pub twist: f64,
    /// Whether an open curve has a point on its end.
    pub ends: bool,
}

impl Default for Layers {
    fn default() -> Layers {
        Layers { count: 1, distance: None, twist: 0.0, ends: true }
    }
}

impl Layers {
    /// Points `step` mm apart along `curves`, each given as its corners, on all layers, `distance` mm apart along `direction`. A closed curve, and one with a
    /// point on its end, has a step as much larger as makes it come out even. Those of different curves may be too close.
    pub fn points<'c>(
        &self,
        curves: impl Iterator<Item = &'c [DVec3]> + Clone,
        step: f64,
        distance: f64,
        direction: DVec3,
    ) -> Vec<Point> {
        let mut points = Vec::new();
        for layer in 0..self.count {
            let moved = f64::from(layer) - 0.5 * f64::from(self.count - 1);
            let shift = direction * (moved * distance);
            let phase = (f64::from(layer) * self.twist).fract() * step;
            for corners in curves.clone() {
                let is_closed = corners.len() > 2 && corners.first() == corners.last();
                let along = walked(corners, is_closed, step, phase, self.ends);
                points.extend(along.into_iter().filter_map(|place| cloud::point(place + shift)));
            }
        }
        points
    }
}

/// A place on corners: after which of them, and which part of the way to the next.
#[derive(Clone, Copy)]
struct At(usize, f64);

fn place(corners: &[DVec3], At(i, part): At) -> DVec3 {
    corners[i].lerp(corners[(i + 1).min(corners.len() - 1)], part)
}

/// The first place after `from` that is `chord` away from it as the crow flies.
fn next(corners: &[DVec3], from: At, chord: f64) -> Option<At> {
    go_on();
    let center = place(corners, from);
    let square = chord * chord;
    for i in from.0..corners.len() - 1 {
        let end = corners[i + 1];
        if end.distance_squared(center) < square {
            continue;
        }
        // The begin of this side lies within the chord, its end does not.
        let (start, way) = (corners[i], end - corners[i]);
        let (a, b) = (way.length_squared(), way.dot(start - center));
        let c = start.distance_squared(center) - square;
        let root = (b * b - a * c).max(0.0).sqrt();
        return Some(At(i, ((root - b) / a).clamp(0.0, 1.0)));
    }
    None
}

/// The place `length` along corners.
fn forward(corners: &[DVec3], mut length: f64) -> Option<At> {
    for i in 0..corners.len() - 1 {
        let side = corners[i].distance(corners[i + 1]);
        if length < side {
            return Some(At(i, length / side));
        }
        length -= side;
    }
    None
}

/// How often the step that comes out even is halved.
const HALVED: u32 = 48;

/// The places along a curve.
fn walked(corners: &[DVec3], is_closed: bool, step: f64, phase: f64, ends: bool) -> Vec<DVec3> {
    if corners.len() < 2 {
        return corners.to_vec();
    }
    let Some(start) = forward(corners, phase) else { return Vec::new() };
    // A closed curve begins anew where it starts.
    let turned: Vec<DVec3>;
    let (corners, start) = match is_closed && phase > 0.0 {
        true => {
            let at = place(corners, start);
            let (before, after) = corners.split_at(start.0 + 1);
            turned = [&[at], after, &before[1..], &[at]].concat();
            (&turned[..], At(0, 0.0))
        }
        false => (corners, start),
    };
    let walk = |chord: f64| {
        let next = move |at: &At| next(corners, *at, chord);
        std::iter::successors(Some(start), next)
    };
    let count = walk(step).count() - 1;
    if count == 0 || !(is_closed || ends) {
        let mut places: Vec<DVec3> = walk(step).map(|at| place(corners, at)).collect();
        if ends && !is_closed {
            places.extend(corners.last());
        }
        return places;
    }
    let (mut low, mut high) = (step, 2.0 * step);
    for _ in 0..HALVED {
        let middle = 0.5 * (low + high);
        match walk(middle).nth(count).is_some() {
            true => low = middle,
            false => high = middle,
        }
    }
    let mut places: Vec<DVec3> = walk(low).take(count).map(|at| place(corners, at)).collect();
    if !is_closed {
        places.extend(corners.last());
    }
    places
}

/// Counts corners of curves as they come.
#[derive(Default)]
struct Count(usize);

impl Count {
    /// # Errors
    /// There are too many.
    fn more(&mut self, corners: usize, line: u32) -> Result<(), Fault> {
        go_on();
        self.0 += corners;
        if self.0 > MOST {
            let message = format!("the curves come to more than {MOST} corners");
            return Err(Fault::new(Rule::Points, message).line(line as usize));
        }
        Ok(())
    }
}

/// A whole turn in the direction of `sweep`.
fn whole(sweep: f64) -> f64 {
    sweep.clamp(-TAU, TAU)
}
