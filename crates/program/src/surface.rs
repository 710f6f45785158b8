//! Surfaces that the control finds while the program runs.

use crate::{Diagnostic, Rule};

/// A surface of which the program knows the places alone: their heights are kept where probing moves find them
/// ([`crate::Probe::place`]). Between the places it is bilinear; outside it is as high as at the nearest place of the
/// edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    columns: Vec<f64>,
    rows: Vec<f64>,
    reach: [f64; 2],
    clear: f64,
}

impl Surface {
    /// The surface over the places where `columns`, X in mm, meet `rows`, Y in mm. `reach` is its lowest and its
    /// highest place, mm from Z 0: what lies lower is not found, and stops the program; what lies higher is found as
    /// far as the probe starts above it, and cuts follow it, but rapids and limits count on this. Poses below Z
    /// `clear`, mm, count from the surface; where that is infinite, all do.
    ///
    /// # Errors
    /// `surface` where columns or rows are not two at least, finite and rising, where the reach is not finite and
    /// rising, or where `clear` is not a number.
    pub fn new(
        columns: Vec<f64>,
        rows: Vec<f64>,
        reach: [f64; 2],
        clear: f64,
    ) -> Result<Surface, Box<Diagnostic>> {
        let rises = |lines: &[f64]| {
            lines.iter().all(|line| line.is_finite())
                && lines.windows(2).all(|pair| pair[0] < pair[1])
        };
        let message = if [&columns, &rows].iter().any(|lines| lines.len() < 2 || !rises(lines)) {
            "a surface whose columns and rows are not two at least, and rising"
        } else if !rises(&reach) || clear.is_nan() {
            "a surface without a lowest and a highest place"
        } else {
            return Ok(Surface { columns, rows, reach, clear });
        };
        Err(Diagnostic::error(Rule::Surface, message).into())
    }

    /// The same surface, from which poses below Z `clear`, mm, count.
    ///
    /// # Errors
    /// `surface` where `clear` is not a number.
    pub fn counted_below(self, clear: f64) -> Result<Surface, Box<Diagnostic>> {
        Surface::new(self.columns, self.rows, self.reach, clear)
    }

    /// X of the columns, rising, mm; two at least.
    pub fn columns(&self) -> &[f64] {
        &self.columns
    }

    /// Y of the rows, rising, mm; two at least.
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// Its lowest and its highest place, mm from Z 0.
    pub fn reach(&self) -> &[f64; 2] {
        &self.reach
    }

    /// Z below which poses count from the surface, mm.
    pub fn clear(&self) -> f64 {
        self.clear
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_has_a_grid_and_a_reach() {
        let of = |columns: &[f64], reach| {
            Surface::new(columns.to_vec(), vec![0.0, 5.0], reach, f64::INFINITY).map(|_| ())
        };
        assert_eq!(of(&[0.0, 10.0, 20.0], [-1.0, 1.0]), Ok(()));
        for columns in [&[][..], &[0.0], &[0.0, 0.0], &[5.0, 0.0], &[0.0, f64::INFINITY]] {
            assert_eq!(of(columns, [-1.0, 1.0]).unwrap_err().rule, "surface", "{columns:?}");
        }
        for reach in [[1.0, -1.0], [f64::NAN, 1.0], [f64::NEG_INFINITY, 1.0]] {
            assert_eq!(of(&[0.0, 10.0], reach).unwrap_err().rule, "surface", "{reach:?}");
        }
    }
}
