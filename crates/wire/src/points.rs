//! A path as points, for a control that knows no arcs.

use crate::contour::Contour;
use crate::path::Path;
use geom::Vec2;
use program::{Diagnostic, Rule};
use sketch::Element;
use std::f64::consts::TAU;
use std::ops::Range;

/// The most points that are made, whatever the memory.
pub const MOST: usize = 20_000_000;

/// The longest chord turns through this angle: a full circle keeps at least three points.
const LONGEST: f64 = TAU / 3.0;

/// How finely arcs are divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Every so many mm of arc from its start; what is left over comes last.
    Length(f64),
    /// Into equal chords that leave the arc by at most so many mm.
    ChordError(f64),
    /// By the smallest chord error whose points fit the memory.
    Fit,
}

/// A path as points.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Where the lower end goes; the first is the start.
    pub lower: Vec<Vec2>,
    /// Where the upper end is at the same times; empty for an upright wire.
    pub upper: Vec<Vec2>,
    /// The step that was asked for; of [`Step::Fit`] the chord error that it found.
    pub step: Step,
    /// For each element of the path the index of its last point.
    ends: Vec<u32>,
    /// For each element of the path its line of the source.
    lines: Vec<u32>,
}

/// Why there are no points.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// What is wrong.
    pub diagnostic: Box<Diagnostic>,
    /// The finest step that would fit the memory, where the step is all that is wrong.
    pub offer: Option<Step>,
}

impl From<Box<Diagnostic>> for Refusal {
    fn from(diagnostic: Box<Diagnostic>) -> Refusal {
        Refusal { diagnostic, offer: None }
    }
}

/// Divides `paths`, which share the memory of one program, into points, of which the control takes at
/// most `memory`. Straight moves give their ends, arcs are divided by `step`; where the wire leans both
/// ends are divided into as many parts as the one that needs more. The last point of each element is
/// exactly its end.
///
/// # Errors
/// `step` for a step that is not positive, or longer than every path; `memory` where the points do
/// not fit (or are more than [`MOST`]), with the step that would; `fit-without-memory`.
pub fn points(paths: &[&Path], step: Step, memory: Option<usize>) -> Result<Vec<Points>, Refusal> {
    let most = memory.unwrap_or(MOST).min(MOST);
    let refuse = |rule, message: String, way_out: String| -> Refusal {
        Box::new(Diagnostic::error(rule, message).help(way_out)).into()
    };
    let (kind, size, name): (fn(f64) -> Step, f64, &str) = match step {
        Step::Length(length) => (Step::Length, length, "step"),
        Step::ChordError(error) => (Step::ChordError, error, "chord error"),
        Step::Fit if memory.is_some() => (Step::ChordError, 0.0, "chord error"),
        Step::Fit => {
            let message = "a step that fits the memory, and the memory is not known".into();
            let way_out =
                "give the number of points that the control holds by --memory, or a --step".into();
            return Err(refuse(Rule::FitWithoutMemory, message, way_out));
        }
    };
    let length = paths.iter().map(|path| path.length()).fold(0.0, f64::max);
    let positive = size.is_finite() && size > 0.0;
    if step != Step::Fit && (!positive || size > length) {
        let message = format!("a {name} of {size} mm on a contour of {length:.4} mm");
        let way_out = format!("give a {name} above 0 and below the length of the contour");
        return Err(refuse(Rule::Step, message, way_out));
    }
    let least = count(paths, Step::Fit);
    if least > most {
        let message = format!("the ends of the moves alone are {least} points, and {most} fit");
        return Err(refuse(
            Rule::Memory,
            message,
            "divide the contour into several programs".into(),
        ));
    }
    if step == Step::Fit {
        let step = Step::ChordError(finest(paths, kind, most));
        return Ok(paths.iter().map(|path| divide(path, step)).collect());
    }
    let count = count(paths, step);
    if count > most {
        let finest = finest(paths, kind, most);
        let message = format!("a {name} of {size} mm makes {count} points, and {most} fit");
        let way_out = format!("a {name} of {finest:.6} mm is the finest that fits");
        return Err(Refusal {
            offer: Some(kind(finest)),
            ..refuse(Rule::Memory, message, way_out)
        });
    }
    Ok(paths.iter().map(|path| divide(path, step)).collect())
}

/// The smallest step of a kind whose points fit, by halving: more points never come from a larger
/// step.
fn finest(paths: &[&Path], kind: fn(f64) -> Step, most: usize) -> f64 {
    // A step as long as the longest path leaves every arc its fewest chords.
    let longest = paths.iter().map(|path| path.length()).fold(1e-6, f64::max);
    let (mut fits, mut fails) = (longest, 0.0);
    for _ in 0..100 {
        // By orders of magnitude first, then evenly.
        let middle = if fails == 0.0 { fits / 1024.0 } else { f64::midpoint(fails, fits) };
        if middle <= 1e-9 || fits - fails <= fits * 1e-12 {
            break;
        }
        if count(paths, kind(middle)) <= most { fits = middle } else { fails = middle }
    }
    fits
}

/// How many points `step` makes, the starts among them; [`Step::Fit`]: the fewest.
fn count(paths: &[&Path], step: Step) -> usize {
    let parts = paths.iter().flat_map(|path| path.elements());
    let parts = parts.map(|(p, q)| Parts::of_pair(p, q, step).count);
    parts.fold(paths.len(), usize::saturating_add)
}

/// Into how many parts an element is divided and how long all but the last are, of 1.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Parts {
    count: usize,
    each: f64,
}

impl Parts {
    fn equal(count: usize) -> Parts {
        Parts { count, each: 1.0 / count as f64 }
    }

    fn of(element: &Element, step: Step) -> Parts {
        let (Some(radius), Some(turn)) = (element.radius(), element.turn) else {
            return Parts::equal(1);
        };
        let sweep = turn.sweep.abs();
        let angle = match step {
            Step::Length(length) => length / radius,
            // 1 − cos x = 2 sin² x/2 keeps its digits for small x.
            Step::ChordError(error) => 4.0 * (error / (2.0 * radius)).min(1.0).sqrt().asin(),
            Step::Fit => LONGEST,
        };
        let angle = angle.min(LONGEST);
        // Rounding must not add a point where the step goes up exactly.
        let count = (sweep / angle * (1.0 - 1e-12)).ceil().max(1.0) as usize;
        match step {
            Step::Length(_) if count > 1 => Parts { count, each: angle / sweep },
            _ => Parts::equal(count),
        }
    }

    /// Those of the end of the wire that needs more.
    fn of_pair(below: &Element, above: &Element, step: Step) -> Parts {
        let (p, q) = (Parts::of(below, step), Parts::of(above, step));
        if q.count > p.count { q } else { p }
    }

    /// Where they end.
    fn ends(self) -> impl Iterator<Item = f64> {
        (1..=self.count).map(move |i| if i == self.count { 1.0 } else { self.each * i as f64 })
    }
}

fn divide(path: &Path, step: Step) -> Points {
    let start = |contour: &Contour| vec![contour.start()];
    let mut points = Points {
        lower: start(path.lower()),
        upper: path.upper().map_or_else(Vec::new, start),
        step,
        ends: Vec::new(),
        lines: Vec::new(),
    };
    for (below, above) in path.elements() {
        for t in Parts::of_pair(below, above, step).ends() {
            points.lower.push(below.at(t));
            if path.upper().is_some() {
                points.upper.push(above.at(t));
            }
        }
        points.ends.push((points.lower.len() - 1) as u32);
        points.lines.push(below.line);
    }
    points
}

impl Points {
    /// The points that came from an element: its end and those before it, not its start.
    pub fn of_element(&self, element: usize) -> Range<usize> {
        let last = |i: usize| self.ends.get(i).map_or(0, |end| *end as usize);
        match element {
            i if i >= self.ends.len() => 0..0,
            0 => 1..last(0) + 1,
            i => last(i - 1) + 1..last(i) + 1,
        }
    }

    /// The points that came from a line of the source, one range for each of its elements.
    pub fn of_line(&self, line: u32) -> impl Iterator<Item = Range<usize>> {
        let elements = self.lines.iter().enumerate().filter(move |(_, l)| **l == line);
        elements.map(|(i, _)| self.of_element(i))
    }

    /// The element that a point came from; none for the start.
    pub fn element_of(&self, point: usize) -> Option<usize> {
        let element = self.ends.partition_point(|end| (*end as usize) < point);
        (point > 0 && element < self.ends.len()).then_some(element)
    }

    /// The line of the source that a point came from; none for the start.
    pub fn line_of(&self, point: usize) -> Option<u32> {
        self.element_of(point).and_then(|element| self.lines.get(element).copied())
    }
}
