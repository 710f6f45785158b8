//! The cycle that is defined.

use super::older::Older;
use crate::klartext::execution::layout::{self, Layout, TENTH_INCH, Unit};

/// A cycle that is defined; its parameters are in the Q parameters of their numbers, where a program
/// may change them until it calls the cycle.
#[derive(Debug)]
pub(crate) struct Definition {
    pub(in crate::klartext::execution) layout: &'static Layout,
    pub given: Vec<u16>,
    /// mm in the unit of length of the program that defines it.
    pub unit: f64,
}

impl Definition {
    /// The number of the cycle.
    pub fn number(&self) -> u16 {
        self.layout.number
    }

    /// mm or mm/min in the unit of a parameter that the definition gave.
    pub fn unit_of(&self, q: u16) -> Option<f64> {
        let unit = layout::unit(q)?;
        self.given.contains(&q).then_some(match unit {
            Unit::Length => self.unit,
            Unit::Feed if self.unit != 1.0 => TENTH_INCH,
            Unit::Feed | Unit::Plain => 1.0,
        })
    }
}

/// A cycle that is ready to be called.
#[derive(Debug)]
pub(crate) enum Defined {
    /// With Q parameters: it starts at the surface that they say.
    Parameters(Definition),
    /// In parts: it starts where the tool stands.
    Older(Older),
}
