//! Kinds of positioners compared, as the source does: stiffness, the step of a motor (spec 2.17, 1.7), and what a program takes on other
//! drives (spec 4.11).

use crate::clock::Clock;
use crate::control::Run;
use crate::machine::Machine;
use crate::profile::Limits;
use program::{Diagnostic, Rule};
use rayon::prelude::*;
use serde::Serialize;

/// How the stiffnesses of a positioner's two members act together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Positioner {
    /// Screw drives: one axis carries the other.
    Screw,
    /// A planar motor: the two members do not act on each other. The stiffness is that of the first.
    Planar,
    /// Arm and table, side by side. That they add up is the source's assumption, not shown by it.
    Polar,
}

impl Positioner {
    /// The stiffness of members with the stiffnesses `a` and `b`, in their unit.
    pub fn stiffness(self, a: f64, b: f64) -> f64 {
        match self {
            Positioner::Screw => a * b / (a + b),
            Positioner::Planar => a,
            Positioner::Polar => a + b,
        }
    }
}

/// A micro step of a motor with teeth every `pitch` mm, divided into `steps`: mm.
pub fn micro_step(pitch: f64, steps: u32) -> f64 {
    pitch / f64::from(steps)
}

/// A full step of a motor with teeth every `pitch` mm: four states to a tooth, mm.
pub fn full_step(pitch: f64) -> f64 {
    0.25 * pitch
}

/// What a program takes with other drives and another laser.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Swept {
    /// Pulses of the laser, Hz.
    pub rate: f64,
    /// Acceleration of the first axis, m/s² or °/s²; that of the others is changed in the same proportion.
    pub acceleration: f64,
    /// Time, s.
    pub seconds: f64,
    /// Pulses of the program in a second.
    pub points: f64,
}

/// Accelerations, as parts of those of the machine.
const PARTS: [f64; 9] = [0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0];

/// What the program of `run` takes at 50, 100 and 200 Hz and the rate of `machine`, each with accelerations from a quarter of those of
/// `machine` to four times as much, from rest to rest with its profile and speed limits: rate by rate, from low to high.
///
/// # Errors
/// The program fires in motion, has fields, or stops elsewhere than at its pulses: what it takes is then no sum of such steps.
pub fn sweep(run: &Run, machine: &Machine) -> Result<Vec<Swept>, Box<Diagnostic>> {
    if !run.motions.is_empty() || !run.fields.is_empty() || !run.stops.is_empty() {
        let message = "the program has pulses in motion, fields, or stops without a pulse";
        let found = Diagnostic::error(Rule::GlassProgram, message);
        return Err(Box::new(found.help("sweep a program of single pulses from rest to rest")));
    }
    let all = machine.coordinates();
    let place = |number: usize| {
        let at = run.pulses.get(number).unwrap_or_default().at;
        [0, 1, 2].map(|axis| (at[axis] * all[axis].steps()).round() as i32)
    };
    let mut rates = vec![50.0, 100.0, 200.0, machine.laser.rate];
    rates.sort_by(f64::total_cmp);
    rates.dedup();
    let swept = |(rate, part): (f64, f64)| {
        let axes = all.map(|of| {
            let Limits { acceleration, speed } = of.limits();
            let turn = of.endless.then(|| (360.0 * of.steps()) as i64);
            (Limits { acceleration: part * acceleration, speed }, of.steps(), turn)
        });
        let clock = Clock::of(rate, machine.drive.profile, axes);
        let step = |number: usize| u64::from(clock.step(place(number - 1), place(number)));
        // The first pulse takes a tick too.
        let ticks = 1 + (1..run.pulses.len()).into_par_iter().map(step).sum::<u64>();
        let seconds = ticks as f64 / rate;
        let acceleration = part * all[0].axis.acceleration;
        Swept { rate, acceleration, seconds, points: run.pulses.len() as f64 / seconds }
    };
    let each = rates.iter().flat_map(|rate| PARTS.map(|part| (*rate, part)));
    Ok(each.map(swept).collect())
}
