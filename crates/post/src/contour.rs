//! Whether the tool of the source can follow a contour that the control offsets by its radius: known before the program is
//! written, and not only by whoever runs it.
//!
//! A control that meets what the tool does not reach stops with an alarm, or cuts into the contour. So a contour is written only
//! where the path at the tool's radius exists: parallel to each element, shortened at inner corners to where the parallels of the two
//! cross, and nowhere nearer than the radius to the elements on both sides of it. Elements are those of the blocks, after
//! rounding. What controls do differently, `[capabilities]` says (`compensation_start`, `compensation_blind`).

use crate::walk::{Outcome, refuse};
use geom::{Element, Turn, Vec2, turn_angle};
use machine::{CompensationStart, Machine};
use program::{Diagnostic, Rule};
use std::f64::consts::{FRAC_PI_2, PI};

/// A move below this goes nowhere in the plane, mm.
const NOWHERE: f64 = 1e-9;

/// Below this turn, radians, two elements join without a corner.
const SMOOTH: f64 = 1e-5;

/// The same where the control joins elements (LinuxCNC), and how much farther an arc may then turn there.
const JOINED: f64 = 0.05;
const LONGER: f64 = 0.024;

/// Places of a way that are looked at.
const SAMPLES: u32 = 128;

/// How many steps of the last decimal something must be at least to count, and how near counts as on it.
const STEPS: f64 = 6.0;

/// A contour as its blocks say it, from the move that switches compensation on to the one that switches it off.
pub(crate) struct Contour {
    /// How far the centre is on the left of the contour, mm; on its right where negative; 0 where the table keeps wear alone.
    left: f64,
    start: CompensationStart,
    /// Blocks without a move in the plane past which the control sees the next element.
    blind: Option<u32>,
    /// How deep the control may cut into a joint, mm.
    joint: f64,
    /// Smallest step of a linear axis, mm.
    resolution: f64,
    at: Vec2,
    stage: Stage,
    /// Blocks since the last element, that of the next one among them.
    pub blocks: usize,
}

/// How far the contour has come.
enum Stage {
    /// Nothing has moved in the plane.
    On,
    /// The move that switches compensation on, from here.
    Entering(Vec2),
    Following(OffsetElement),
}

/// An element of the contour, and the path parallel to it.
#[derive(Clone, Copy)]
struct OffsetElement {
    element: Element,
    parallel: Element,
    /// Where on `parallel` the tool comes to it, 0 to 1.
    from: f64,
    /// It is the move that switches compensation on, counted as an element.
    leads_in: bool,
    before: Option<Element>,
}

impl Contour {
    /// A contour whose first move begins at `at`, with a tool of `radius` mm on its left (`side` 1) or right (-1).
    pub fn new(machine: &Machine, at: Vec2, radius: f64, side: f64) -> Contour {
        Contour {
            left: side * radius,
            start: machine.capabilities.compensation_start,
            blind: machine.capabilities.compensation_blind,
            joint: machine.path_tolerance(),
            resolution: machine.resolution(),
            at,
            stage: Stage::On,
            blocks: 0,
        }
    }

    /// The tool goes to `to`, along an arc where it is one.
    ///
    /// # Errors
    /// The control cannot lead it so.
    pub fn go(&mut self, to: Vec2, turn: Option<Turn>, rapid: bool) -> Outcome {
        let element = Element { start: self.at, end: to, turn };
        if element.length() < NOWHERE {
            return Ok(());
        }
        self.at = to;
        let between = std::mem::take(&mut self.blocks).saturating_sub(1);
        self.stage = match std::mem::replace(&mut self.stage, Stage::On) {
            Stage::On if self.start == CompensationStart::NextStart => {
                Stage::Entering(element.start)
            }
            Stage::On => Stage::Following(self.first(element)?),
            Stage::Entering(from) => {
                let next = self.parallel(element)?;
                if self.cuts(from, &next.element, &next.parallel) {
                    return Err(gouge("the way to the contour", "begin"));
                }
                Stage::Following(next)
            }
            Stage::Following(last) => {
                let mut next = self.parallel(element)?;
                self.corner(last, &mut next, rapid, between)?;
                Stage::Following(OffsetElement { before: Some(last.element), ..next })
            }
        };
        Ok(())
    }

    /// Compensation is switched off by a move to `to`.
    ///
    /// # Errors
    /// The control cannot end the contour so.
    pub fn leave(self, to: Vec2) -> Outcome {
        let last = match &self.stage {
            Stage::On => return Ok(()),
            Stage::Entering(_) => {
                let message = "cutter compensation is switched on and off with no contour between";
                let help = "leave CUTCOM out, or a cut in the plane between";
                return Err(refuse(Rule::CompensationEntry, message).help(help).into());
            }
            Stage::Following(last) => last,
        };
        self.complete(last, 1.0, None)?;
        if !last.leads_in && self.cuts(to, &last.element.reversed(), &last.parallel.reversed()) {
            return Err(gouge("the way off the contour", "end"));
        }
        Ok(())
    }

    fn radius(&self) -> f64 {
        self.left.abs()
    }

    /// How near is on it, mm.
    fn near(&self) -> f64 {
        let joint = match self.start {
            CompensationStart::NextStart => 0.0,
            CompensationStart::OwnEnd => self.joint,
        };
        2.0 * self.resolution + joint
    }

    fn smooth(&self) -> f64 {
        match self.start {
            CompensationStart::NextStart => SMOOTH,
            CompensationStart::OwnEnd => JOINED,
        }
    }

    /// The path parallel to an element.
    fn parallel(&self, element: Element) -> Result<OffsetElement, Box<Diagnostic>> {
        let Some(parallel) = element.parallel(self.left) else {
            let message = format!(
                "with cutter compensation a tool of radius {} mm does not fit into this arc of radius {} mm",
                shown(self.radius()),
                shown(element.radius().unwrap_or_default())
            );
            return Err(refuse(Rule::CompensationArcRadius, message).help(SMALLER).into());
        };
        Ok(OffsetElement { element, parallel, from: 0.0, leads_in: false, before: None })
    }

    /// The move that switches compensation on, where it counts as an element.
    fn first(&self, element: Element) -> Result<OffsetElement, Box<Diagnostic>> {
        let (length, radius) = (element.length(), self.radius());
        if length <= radius {
            let message = format!(
                "the move that switches cutter compensation on is {} mm long in the plane: this control needs more than the radius \
                 of the tool, {} mm",
                shown(length),
                shown(radius)
            );
            let help = "a longer way to the contour";
            return Err(refuse(Rule::CompensationEntry, message).help(help).into());
        }
        Ok(OffsetElement { leads_in: true, ..self.parallel(element)? })
    }

    /// From `last` to `next`, with so many blocks between.
    fn corner(
        &self,
        last: OffsetElement,
        next: &mut OffsetElement,
        rapid: bool,
        between: usize,
    ) -> Outcome {
        let turn = turn_angle(last.element.tangent(1.0), next.element.tangent(0.0));
        if turn.abs() <= self.smooth() {
            self.join(&last, next, turn)?;
            return self.complete(&last, 1.0, Some(&next.element));
        }
        self.sees(between)?;
        if self.left == 0.0 {
            return Ok(());
        }
        let is_back = PI - turn.abs() <= self.smooth();
        if is_back && (last.element.turn.is_some() || next.element.turn.is_some()) {
            return Err(self.no_reach());
        }
        if turn * self.left > 0.0 && !is_back {
            let to = self.shorten(&last, next)?;
            return self.complete(&last, to, Some(&next.element));
        }
        if rapid && self.start == CompensationStart::OwnEnd {
            let message = "before a rapid this control leaves an outer corner of a contour on a straight way, which cuts it";
            let help = "a cut in place of the rapid, or cutter compensation switched off before it";
            return Err(refuse(Rule::CompensationGouge, message).help(help).into());
        }
        self.around(&last, next, turn.abs())?;
        self.complete(&last, 1.0, Some(&next.element))
    }

    /// Two elements join without a corner: the next way begins where the last one ends.
    fn join(&self, last: &OffsetElement, next: &mut OffsetElement, turn: f64) -> Outcome {
        let deep = self.radius() * (1.0 - turn.cos());
        if deep > self.joint && turn.abs() > SMOOTH {
            let message = format!(
                "this control joins elements that turn by less than {JOINED} rad without a corner: with a tool of radius {} mm it \
                 cuts {} mm into the contour, {} are allowed (`path_tolerance`)",
                shown(self.radius()),
                shown(deep),
                shown(self.joint)
            );
            let help = "an arc in place of the short lines, or a smaller tool";
            return Err(refuse(Rule::CompensationGouge, message).help(help).into());
        }
        if self.start == CompensationStart::NextStart {
            return Ok(());
        }
        next.from = next.parallel.nearest(last.parallel.end).0;
        let farther =
            next.parallel.radius().map_or(0.0, |radius| self.radius() * turn.abs() / radius);
        match next.from < 1.0 && farther <= LONGER {
            true => Ok(()),
            false => Err(self.no_reach()),
        }
    }

    /// # Errors
    /// The control does not see as far as the next element.
    fn sees(&self, between: usize) -> Outcome {
        match self.blind {
            Some(most) if between > most as usize => {
                let message = format!(
                    "{between} blocks without a move in the plane before this corner of a contour: the control sees past {most} and \
                     would cut the corner"
                );
                let help = "put them before or behind the contour";
                Err(refuse(Rule::CompensationLookAhead, message).help(help).into())
            }
            _ => Ok(()),
        }
    }

    /// At an inner corner both ways end where they cross. Answers where on the last one.
    fn shorten(
        &self,
        last: &OffsetElement,
        next: &mut OffsetElement,
    ) -> Result<f64, Box<Diagnostic>> {
        let crossings = last.parallel.crossings(&next.parallel);
        let mut crossings: Vec<_> = crossings.filter(|found| found.on_first > last.from).collect();
        crossings.sort_by(|a, b| a.cut.total_cmp(&b.cut));
        match crossings.as_slice() {
            // Where they cross twice they come together again after the corner.
            [crossing, others @ ..] if others.is_empty() || last.leads_in => {
                next.from = crossing.on_next;
                Ok(crossing.on_first)
            }
            _ => Err(self.no_reach()),
        }
    }

    /// The ways around an outer corner, on an arc or along the tangents, keep off what follows and what came before.
    fn around(&self, last: &OffsetElement, next: &OffsetElement, turn: f64) -> Outcome {
        let (corner, from, to) = (next.element.start, last.parallel.end, next.parallel.start);
        let on = last.element.tangent(1.0) * self.radius();
        let back = next.element.tangent(0.0) * self.radius();
        let points = match turn > FRAC_PI_2 {
            true => vec![from, from + on, to - back, to],
            false => vec![from, corner + (from + to - 2.0 * corner) / (1.0 + turn.cos()), to],
        };
        let arc = Element::arc(from, to, corner, -turn * self.left.signum());
        let lines = points.windows(2).map(|pair| Element::line(pair[0], pair[1]));
        for way in lines.chain([arc]) {
            self.holds_off(&way, [Some(&last.element), Some(&next.element)])?;
        }
        Ok(())
    }

    /// The path parallel to `last` ends at `to`: there is one, and it keeps off the elements before and behind it.
    fn complete(&self, last: &OffsetElement, to: f64, next: Option<&Element>) -> Outcome {
        if self.left == 0.0 {
            return Ok(());
        }
        if last.leads_in {
            let way = Element::line(last.element.start, last.parallel.at(to));
            return match next {
                Some(next) if self.gets_near(&way, next, last.element.start) => {
                    Err(gouge("the way to the contour", "begin"))
                }
                _ => Ok(()),
            };
        }
        let part = to - last.from;
        if part < 0.25 && part * last.parallel.length() < STEPS * self.resolution {
            return Err(self.no_reach());
        }
        let way = last.parallel.part(last.from, to);
        self.holds_off(&way, [last.before.as_ref(), next])
    }

    /// # Errors
    /// A way of the tool's centre comes nearer to an element than its radius.
    fn holds_off(&self, way: &Element, elements: [Option<&Element>; 2]) -> Outcome {
        let least = self.radius() - self.near();
        let near = |element: &Element| samples(way).any(|point| element.away(point) < least);
        match elements.into_iter().flatten().any(near) {
            true => Err(self.no_reach()),
            false => Ok(()),
        }
    }

    /// Whether the straight way from `from`, off the contour, to the start of `parallel` cuts into its element.
    fn cuts(&self, from: Vec2, element: &Element, parallel: &Element) -> bool {
        let (back, out) = (from - parallel.start, parallel.start - element.start);
        if self.left == 0.0 || back.length() < NOWHERE {
            return false;
        }
        // Ahead of the first point the tool may come from its own side alone.
        if back.dot(element.tangent(0.0)) > NOWHERE && back.dot(out) < -NOWHERE {
            return true;
        }
        let way = Element::line(from, parallel.start);
        way.crossings(parallel).any(|crossing| crossing.cut > NOWHERE)
            || self.gets_near(&way, element, from)
    }

    /// Whether a way comes nearer to an element than its radius, or than its start is, but for the first point of that.
    fn gets_near(&self, way: &Element, element: &Element, from: Vec2) -> bool {
        let least = self.radius().min(element.away(from)) - self.near();
        samples(way).any(|point| {
            let (along, near) = element.nearest(point);
            along > 0.0 && near < least
        })
    }

    fn no_reach(&self) -> Box<Diagnostic> {
        let message = format!(
            "with cutter compensation a tool of radius {} mm does not follow the contour here without cutting into it: an inner \
             corner, or elements shorter than the tool needs",
            shown(self.radius())
        );
        refuse(Rule::CompensationInnerCorner, message).help(SMALLER).into()
    }
}

/// The way out where a tool is too large.
const SMALLER: &str = "a smaller tool, a contour without elements that it does not reach, or the path of the tool's centre from the CAM \
                       system (`--cutcom centre` where the source gives it)";

/// The way to a contour, or off it, cuts it.
fn gouge(way: &str, at: &str) -> Box<Diagnostic> {
    let message = format!("{way} with cutter compensation cuts into it");
    let help =
        format!("{at} on the tool's side of the contour, farther from it than the tool's radius");
    refuse(Rule::CompensationGouge, message).help(help).into()
}

/// Places of a way, both ends among them.
fn samples(way: &Element) -> impl Iterator<Item = Vec2> + '_ {
    (0..=SAMPLES).map(|i| way.at(f64::from(i) / f64::from(SAMPLES)))
}

/// A length as a message shows it, mm.
fn shown(length: f64) -> f64 {
    (length * 1e4).round() / 1e4
}
