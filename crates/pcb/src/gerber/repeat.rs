//! Step and repeat (section 4.12) and block apertures (section 4.11): objects that are collected to be
//! painted several times.

use super::image::Object;
use super::reader::Budget;
use crate::Transform;
use crate::decimal::{decimal, whole};
use crate::report::{Outcome, fault};
use geom::Vec2;
use geom::ending::go_on;
use program::Rule;

/// A statement that collects objects.
pub(super) struct Collector {
    pub(super) purpose: Purpose,
    pub(super) objects: Vec<Object>,
}

/// What is to become of the objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Purpose {
    /// A block aperture of this number.
    Block(u32),
    /// Copies at these steps.
    Repeat(Steps),
}

/// How often and how far apart a block is repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steps {
    count: [u32; 2],
    /// mm
    distance: Vec2,
}

impl Steps {
    /// Reads what stands behind `SR`, in units of so many mm.
    ///
    /// # Errors
    /// `step-and-repeat`
    pub(super) fn of(text: &[u8], unit: f64) -> Outcome<Steps> {
        let odd = || {
            let help = "it is such as %SRX3Y2I5.0J4.0*%, with counts from 1 on";
            fault(Rule::StepAndRepeat, "not a step and repeat", help)
        };
        let mut steps = Steps { count: [1; 2], distance: Vec2::ZERO };
        let mut rest = text.trim_ascii();
        while let Some((letter, after)) = rest.split_first() {
            let end = after.iter().position(u8::is_ascii_uppercase).unwrap_or(after.len());
            let (number, next) = after.split_at(end);
            let count = || whole(number.trim_ascii()).filter(|count| *count > 0).ok_or_else(odd);
            let distance = || {
                let distance = decimal(number.trim_ascii()).map(|distance| distance * unit);
                distance.filter(|distance| distance.abs() <= crate::FAR).ok_or_else(odd)
            };
            match letter {
                b'X' => steps.count[0] = count()?,
                b'Y' => steps.count[1] = count()?,
                b'I' => steps.distance.x = distance()?,
                b'J' => steps.distance.y = distance()?,
                _ => return Err(odd()),
            }
            rest = next;
        }
        Ok(steps)
    }

    /// The objects at all their places: first along Y, then along X, since the order matters where copies
    /// overlap.
    ///
    /// # Errors
    /// `too-large`
    pub(super) fn copies(&self, objects: &[Object], budget: &mut Budget) -> Outcome<Vec<Object>> {
        let [columns, rows] = self.count;
        let all = (columns as usize).saturating_mul(rows as usize).saturating_mul(objects.len());
        budget.spend(all)?;
        let mut copies = Vec::with_capacity(all);
        for column in 0..columns {
            for row in 0..rows {
                let at = self.distance * Vec2::new(f64::from(column), f64::from(row));
                for object in objects {
                    go_on();
                    copies.push(object.placed(&Transform::NONE, at, true)?);
                }
            }
        }
        Ok(copies)
    }
}
