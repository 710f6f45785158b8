//! Whether a program stays within what the machine can do.
//!
//! Where the work zero is known, every axis is checked against its travel in machine coordinates: the
//! position of the tool tip, the work zero and, along Z, the length of the tool. Otherwise only what
//! can be checked without it is: the stroke of no axis may be longer than its travel.

use crate::{LinearAxis, Machine};
use geom::{Arc, Vec2, Vec3, angle_between};
use program::Rule;
use program::{Diagnostic, Feed, Spindle, Tool};
use serde::Serialize;

/// What rounding may add to a position exactly on a limit, mm or degrees.
const ROUNDING: f64 = 1e-6;

/// What is known of the travel of the linear axes, and so how a program is checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Travel {
    /// No axis has a limit.
    #[default]
    Unlimited,
    /// The work zero is not known: only strokes are compared with the length of the travel.
    Lengths,
    /// Every position is compared with the travel in machine coordinates.
    MachineCoordinates,
}

impl Travel {
    /// What is known of `machine`.
    pub fn of(machine: &Machine) -> Travel {
        let limited = |axis: &LinearAxis| axis.min.is_finite() || axis.max.is_finite();
        match machine.work_zero {
            _ if !machine.linear.iter().any(limited) => Travel::Unlimited,
            None => Travel::Lengths,
            Some(_) => Travel::MachineCoordinates,
        }
    }
}

/// Holds one program after the other against the limits of a machine.
#[derive(Clone, Debug)]
pub struct Limits<'a> {
    machine: &'a Machine,
    travel: Travel,
    /// Lowest and highest position of each linear axis so far, with the line that asked for it.
    extent: [[(f64, u32); 2]; 3],
    /// The line that first asked for more than the length of the travel.
    too_far: [Option<u32>; 3],
}

impl<'a> Limits<'a> {
    /// The limits of `machine`, nothing having moved yet.
    pub fn new(machine: &'a Machine) -> Limits<'a> {
        let nowhere = [(f64::INFINITY, 0), (f64::NEG_INFINITY, 0)];
        Limits { machine, travel: Travel::of(machine), extent: [nowhere; 3], too_far: [None; 3] }
    }

    /// Checks positions of the linear axes (mm, as a program gives them) and the rotary axes (degrees
    /// of A, B, C) with a tool of `tool_length` mm, asked for by `line` of the source. A coordinate
    /// that is not known (NaN) breaks no limit, and how low the slide of a tool of unknown length goes is not known.
    /// Where the work zero is not known, [`Limits::ways`] reports the linear axes.
    ///
    /// # Errors
    /// `axis-limit`, with the axis, its position, the limit and by how much it is broken.
    pub fn position(
        &mut self,
        linear: Vec3,
        degrees: [f64; 3],
        tool_length: Option<f64>,
        line: u32,
    ) -> Result<(), Box<Diagnostic>> {
        for axis in &self.machine.rotary {
            let at = degrees[axis.index()];
            held(axis.letter, at, axis.min, axis.max, "°", line)?;
        }
        if self.travel == Travel::Unlimited {
            return Ok(());
        }
        let length = tool_length.unwrap_or(0.0);
        let slides = linear + Vec3::Z * length + self.machine.work_zero.unwrap_or_default();
        let known = self.travel == Travel::MachineCoordinates;
        for (i, (axis, letter)) in self.machine.linear.iter().zip(['X', 'Y', 'Z']).enumerate() {
            if known {
                // The slide of Z stands above the tip, by how much is not known.
                let is_measured = i != 2 || tool_length.is_some();
                let min = if is_measured { axis.min } else { f64::NEG_INFINITY };
                held(letter, slides[i], min, axis.max, " mm", line)?;
            } else {
                self.stretch(i, axis, slides[i], line);
            }
        }
        Ok(())
    }

    /// Checks every position of an arc that the linear axes run with the rotary axes standing still;
    /// else like [`Limits::position`].
    ///
    /// # Errors
    /// Those of [`Limits::position`].
    pub fn arc(
        &mut self,
        arc: &Arc,
        degrees: [f64; 3],
        tool_length: Option<f64>,
        line: u32,
    ) -> Result<(), Box<Diagnostic>> {
        if self.travel == Travel::Unlimited {
            return self.position(arc.end, degrees, tool_length, line);
        }
        let (low, high) = arc.extents();
        self.position(low, degrees, tool_length, line)?;
        self.position(high, degrees, tool_length, line)
    }

    /// Checks the lean of a wire: U and V (mm), and its axis (a unit vector).
    ///
    /// # Errors
    /// `uv-limit`, `taper-limit`.
    pub fn lean(&self, uv: Vec2, axis: Vec3, line: u32) -> Result<(), Box<Diagnostic>> {
        let Some(wire) = &self.machine.wire else { return Ok(()) };
        let (most, taper) = (wire.uv_travel, angle_between(axis, Vec3::Z).to_degrees());
        let (rule, message) = if uv.abs().max_element() > most + ROUNDING {
            let message =
                format!("U{:.4} V{:.4} mm: the travel is {most} mm either way", uv.x, uv.y);
            (Rule::UvLimit, message)
        } else if taper > wire.taper_max + ROUNDING {
            let most = wire.taper_max;
            (
                Rule::TaperLimit,
                format!("the wire leans by {taper:.4}°: the machine by {most}° at most"),
            )
        } else {
            return Ok(());
        };
        let help = "a smaller taper, or a machine whose wire leans farther";
        Err(Diagnostic::error(rule, message).help(help).line(line).into())
    }

    /// Checks that the control holds a program of so many points.
    ///
    /// # Errors
    /// `memory`.
    pub fn memory(&self, points: usize) -> Result<(), Box<Diagnostic>> {
        let most = self.machine.wire.and_then(|wire| wire.memory).unwrap_or(usize::MAX);
        if points <= most {
            return Ok(());
        }
        let message = format!("the program has {points} points, the control holds {most}");
        Err(Diagnostic::error(Rule::Memory, message)
            .help("a coarser step, or several programs")
            .into())
    }

    /// Checks the speed of the spindle.
    ///
    /// # Errors
    /// `spindle-range`.
    pub fn spindle(&self, spindle: Spindle, line: u32) -> Result<(), Box<Diagnostic>> {
        let (Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed)) = spindle else {
            return Ok(());
        };
        let range = self.machine.spindle;
        if speed >= range.min && speed <= range.max {
            return Ok(());
        }
        let message = format!("spindle speed {speed} 1/min");
        let help = format!("the spindle turns at {} to {} 1/min", range.min, range.max);
        Err(Diagnostic::error(Rule::SpindleRange, message).help(help).line(line).into())
    }

    /// Checks the feed of a cut, with the spindle as it turns. How fast a feed in inverse time is
    /// depends on the path of each block: it is not checked here.
    ///
    /// # Errors
    /// `feed-range`.
    pub fn feed(&self, feed: Feed, spindle: Spindle, line: u32) -> Result<(), Box<Diagnostic>> {
        let speed = match (feed, spindle) {
            (Feed::PerMinute(speed), _) => speed,
            (Feed::PerTurn(feed), Spindle::Clockwise(turns) | Spindle::CounterClockwise(turns)) => {
                feed * turns
            }
            (Feed::PerTurn(_), Spindle::Off) | (Feed::InverseTime(_), _) => return Ok(()),
        };
        let most = self.machine.feed_max;
        if speed <= most {
            return Ok(());
        }
        let message = format!("feed {speed} mm/min");
        let help = format!("the machine feeds at most {most} mm/min (feed_max)");
        Err(Diagnostic::error(Rule::FeedRange, message).help(help).line(line).into())
    }

    /// Checks what is known of a tool against what the magazine takes.
    ///
    /// # Errors
    /// `tool-range`.
    pub fn tool(&self, tool: &Tool, line: u32) -> Result<(), Box<Diagnostic>> {
        let range = self.machine.tools;
        let too_much = |what: &str, value: Option<f64>, most: f64| {
            let value = value.filter(|value| *value > most + ROUNDING)?;
            Some(format!("tool {} has a {what} of {value} mm, the most is {most} mm", tool.number))
        };
        let fault = if !(1..=range.max_number).contains(&tool.number) {
            Some(format!("tool {} is not one of 1 to {}", tool.number, range.max_number))
        } else {
            too_much("diameter", tool.diameter, range.max_diameter)
                .or_else(|| too_much("length", tool.length, range.max_length))
        };
        fault.map_or(Ok(()), |message| {
            Err(Diagnostic::error(Rule::ToolRange, message).line(line).into())
        })
    }

    /// What is wrong with the stroke of each axis: where the work zero is not known, it may not
    /// be longer than its travel (`axis-limit`).
    pub fn ways(&self) -> impl Iterator<Item = Diagnostic> {
        let axes = self.machine.linear.iter().zip(self.extent).zip(['X', 'Y', 'Z']);
        axes.zip(self.too_far).filter_map(|(((axis, ends), letter), line)| {
            let line = line?;
            let (stroke, travel) = (ends[1].0 - ends[0].0, axis.max - axis.min);
            let [low, high] = ends.map(|(at, line)| match line {
                0 => format!("{at:.4} mm"),
                line => format!("{at:.4} mm (line {line})"),
            });
            let message = format!(
                "{letter} moves from {low} to {high}: {:.4} mm more than its travel of {travel} mm",
                stroke - travel
            );
            let help = "lower the clearance planes in the CAM system where only retracts go that far; else divide the work, or take a larger \
                            machine";
            Some(Diagnostic::error(Rule::AxisLimit, message).help(help).line(line))
        })
    }

    /// Keeps how far an axis has moved, and whether that is too far.
    fn stretch(&mut self, i: usize, axis: &LinearAxis, at: f64, line: u32) {
        let [low, high] = &mut self.extent[i];
        if at < low.0 {
            *low = (at, line);
        }
        if at > high.0 {
            *high = (at, line);
        }
        if high.0 - low.0 > axis.max - axis.min + ROUNDING {
            self.too_far[i].get_or_insert(line);
        }
    }
}

/// Refuses a position out of its travel.
fn held(
    letter: char,
    at: f64,
    min: f64,
    max: f64,
    unit: &str,
    line: u32,
) -> Result<(), Box<Diagnostic>> {
    let (limit, beyond) = if at > max + ROUNDING {
        (max, at - max)
    } else if at < min - ROUNDING {
        (min, min - at)
    } else {
        return Ok(());
    };
    let message =
        format!("{letter} at {at:.4}{unit} is {beyond:.4}{unit} beyond its limit of {limit}{unit}");
    let help = format!("{letter} travels from {min}{unit} to {max}{unit} in machine coordinates");
    Err(Diagnostic::error(Rule::AxisLimit, message).help(help).line(line).into())
}
