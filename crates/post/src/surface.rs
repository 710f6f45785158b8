//! Moves over a surface that the control finds: what Z counts from it, and how.

use crate::catalogue::{BlockName, WordName};
use crate::walk::{Outcome, Walk, refuse};
use geom::{Vec2, Vec3};
use program::{Rule, Surface};

/// Parts of kept heights are written to so many decimals: a height of a metre is then right to a micrometre.
pub(crate) const DECIMALS: usize = 6;

/// The way out where the machine cannot follow a surface by itself.
pub(crate) const LEVEL_FIRST: &str =
    "probe it by a program of its own, and level this one with what that finds";

/// A height that is kept, and how much of it is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Part {
    /// Number of the parameter that keeps it.
    pub(crate) parameter: u32,
    pub(crate) part: f64,
}

impl<'a> Walk<'a> {
    /// From here on moves count from `surface`.
    pub(crate) fn set_surface(&mut self, surface: &'a Surface) -> Outcome {
        let message = if !self.templates.has(BlockName::KeepHeight) {
            "the control keeps no heights that a probe finds"
        } else if !self.machine.rotary.is_empty() {
            "a machine with rotary axes follows no surface that it finds itself"
        } else if self.wanted.surface().is_some() {
            "a second surface"
        } else {
            self.wanted.set_surface(surface);
            return Ok(());
        };
        Err(refuse(Rule::Surface, message).help(LEVEL_FIRST).into())
    }

    /// # Errors
    /// `what` is not done over a surface.
    pub(crate) fn not_over_surface(&self, what: &str) -> Outcome {
        match self.wanted.surface() {
            None => Ok(()),
            Some(_) => {
                Err(refuse(Rule::Surface, format!("{what} over a surface that the control finds")))
            }
        }
    }

    /// Whether a pose at this point counts from the surface.
    pub(crate) fn is_over_surface(&self, point: Vec3) -> bool {
        self.over(point).is_some()
    }

    /// The surface from which a pose at this point counts.
    fn over(&self, point: Vec3) -> Option<&'a Surface> {
        self.wanted.surface().filter(|surface| point.z < surface.clear())
    }

    /// Says in the next block, besides Z, what the surface adds to it at `point`.
    pub(crate) fn say_surface(&mut self, point: Vec3) {
        let parts = |surface| parts(surface, point.truncate(), self.first());
        self.writer.raise(self.over(point).map(parts));
    }

    /// By how much the surface can change Z at `point`, mm: the least and the most, where it can.
    pub(crate) fn sways(&self, point: Vec3) -> &'a [f64] {
        self.over(point).map_or(&[0.0], |surface| surface.reach())
    }

    /// What the probe has found is kept for a place of the surface.
    pub(crate) fn keep_height(&mut self, place: u32) -> Outcome {
        self.writer.set(WordName::Height, f64::from(self.first().saturating_add(place)));
        self.required(BlockName::KeepHeight)?;
        Ok(())
    }

    /// Number of the first parameter that keeps a height.
    fn first(&self) -> u32 {
        self.machine.words.get(WordName::Height.name()).map_or(0, |word| word.first)
    }
}

/// The four corners of the patch about a point, and how much of the height of each is in that of the surface
/// there.
fn parts(surface: &Surface, at: Vec2, first: u32) -> [Part; 4] {
    let wide = surface.columns().len();
    let (column, right) = share(surface.columns(), at.x);
    let (row, up) = share(surface.rows(), at.y);
    let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
    corners.map(|(x, y)| {
        let part =
            (if x == 0 { 1.0 - right } else { right }) * (if y == 0 { 1.0 - up } else { up });
        let place = u32::try_from((row + y) * wide + column + x).unwrap_or(u32::MAX);
        Part { parameter: first.saturating_add(place), part }
    })
}

/// The line before a coordinate that has one behind it, and the share of that one, from 0 to 1.
fn share(lines: &[f64], at: f64) -> (usize, f64) {
    let last = lines.len().saturating_sub(2);
    let before = lines.iter().skip(1).take(last).filter(|line| **line < at).count();
    let (from, to) = (lines[before], lines[before + 1]);
    (before, ((at - from) / (to - from)).clamp(0.0, 1.0))
}
