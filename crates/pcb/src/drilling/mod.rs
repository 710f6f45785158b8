//! Drilling: which drill makes which hole, what is milled instead, and in which order.
//!
//! Drills come in rising diameters, one change each, and then the cutter. A slot is drilled hole by hole
//! (`chain`) or milled; a route is milled, and so is what no drill makes (`milled`). Holes are drilled
//! whether they are plated or not.

mod chain;
mod milled;

use crate::isolation::Direction;
use crate::report::{Fault, Outcome, fault};
use crate::setting::{self, shown};
use crate::tour::Tour;
use crate::{Cut, Cutter, Hole, HoleShape, Operation, Tool};
use geom::Vec2;
use program::{Diagnostic, Rule};

/// Diameters this near to each other are one, mm.
const ALIKE: f64 = 1e-4;

/// Holes whose diameters differ by no more are made by one drill where there would be one for each, mm: 0.8 and 0.813, of mm and
/// of inches. It is less than a drill in a simple spindle is off.
const NEAR: f64 = 0.015;

/// How holes are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Drilling {
    /// Thickness of the board, mm.
    pub thickness: f64,
    /// How far tools go below the board, mm, 0 or more: for drills not less than the height of their tip.
    pub below: f64,
    /// Diameters of the drills at hand, mm; `None` where there is one for each hole, and for holes that are 0.015 mm apart one.
    pub drills: Option<Vec<f64>>,
    /// By how much a drill may be wider or narrower than its hole, mm.
    pub tolerance: f64,
    /// How deep a drill goes until it comes up to clear the chips, mm; `None` where it goes at once.
    pub peck: Option<f64>,
    /// Feed of drills, mm/min.
    pub plunge: f64,
    /// Speed of the spindle for drills, 1/min.
    pub speed: f64,
    /// How slots are made.
    pub slots: Slots,
    /// What is milled, and how; `None` where nothing is.
    pub mill: Option<Mill>,
    /// Where the tool comes from, mm.
    pub from: Vec2,
}

/// How slots are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slots {
    /// By holes that overlap, so that what stays between them along the wall is nowhere higher than
    /// `scallop` mm.
    Chain {
        /// mm, greater than 0.
        scallop: f64,
    },
    /// By the cutter.
    Mill,
}

/// How holes are milled.
#[derive(Clone, Debug, PartialEq)]
pub struct Mill {
    /// With what: an end mill.
    pub tool: Tool,
    /// How much deeper it goes each time around, mm.
    pub step: f64,
    /// In which direction around.
    pub direction: Direction,
    /// Holes of this diameter (mm) and wider are milled though there is a drill; infinite where none is.
    pub instead: f64,
}

/// What is done, and what is to be known of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drilled {
    /// One for each tool.
    pub operations: Vec<Operation>,
    /// Where holes are not as the board has them, and where pieces come loose.
    pub warnings: Vec<Diagnostic>,
}

/// What makes a hole.
enum Maker {
    /// A drill of this diameter, mm.
    Drill(f64),
    Cutter,
}

impl Drilling {
    /// Makes `holes`.
    ///
    /// # Errors
    /// `length`, `step` and `cutter` where a setting makes no sense; `no-drill` where neither a drill nor the
    /// cutter makes a hole, `no-cutter` where one is to be milled and there is no cutter or it is too wide;
    /// `chain-too-long` where a slot would take too many holes; `too-large` where a route is.
    pub fn drill(&self, holes: &[Hole]) -> Result<Drilled, Vec<Diagnostic>> {
        self.check().map_err(|fault| vec![*fault])?;
        let mut errors = Vec::new();
        let mut warnings = Vec::new();
        let mut drilled: Vec<(f64, &Hole)> = Vec::new();
        let mut milled: Vec<&Hole> = Vec::new();
        let drills = self.drills.clone();
        let drills = drills.unwrap_or_else(|| alike(holes, NEAR.min(self.tolerance)));
        for hole in holes {
            match self.maker(hole, &drills) {
                Ok(Maker::Cutter) => milled.push(hole),
                Ok(Maker::Drill(diameter)) => {
                    if (diameter - hole.diameter).abs() > ALIKE {
                        count(&mut warnings, differs(hole, diameter));
                    }
                    drilled.push((diameter, hole));
                }
                Err(fault) => count(&mut errors, *fault),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        drilled.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut made = Drilled { operations: Vec::new(), warnings };
        let mut at = self.from;
        for holes in drilled.chunk_by(|a, b| b.0 - a.0 <= ALIKE) {
            let operation = self.with_drill(holes, &mut at);
            made.operations.push(operation.map_err(|fault| vec![*fault])?);
        }
        if let (Some(mill), false) = (&self.mill, milled.is_empty()) {
            for hole in &milled {
                if milled::frees_a_piece(hole).map_err(|fault| vec![*fault])? {
                    count(&mut made.warnings, loose(hole));
                }
            }
            let operation = self.with_cutter(mill, &milled, &mut at);
            made.operations.push(operation.map_err(|fault| vec![*fault])?);
        }
        Ok(made)
    }

    fn check(&self) -> Outcome {
        setting::length("the thickness of the board", self.thickness)?;
        setting::length("the depth of drilling", self.depth())?;
        for diameter in self.drills.iter().flatten() {
            setting::length("a drill", *diameter)?;
        }
        if let Some(peck) = self.peck {
            setting::length("a peck", peck)?;
        }
        if let Slots::Chain { scallop } = self.slots {
            setting::length("the height between the holes of a slot", scallop)?;
        }
        if let Some(mill) = &self.mill {
            setting::step("a step of milling", mill.step, self.depth())?;
            setting::diameter(&mill.tool)?;
        }
        Ok(())
    }

    fn depth(&self) -> f64 {
        self.thickness + self.below.max(0.0)
    }

    fn maker(&self, hole: &Hole, drills: &[f64]) -> Outcome<Maker> {
        let long = match &hole.shape {
            HoleShape::Round(_) => false,
            HoleShape::Slot(a, b) => a.distance(*b) > ALIKE && self.slots == Slots::Mill,
            HoleShape::Route(_) => true,
        };
        let instead = self.mill.as_ref().is_some_and(|mill| hole.diameter >= mill.instead);
        if long || instead {
            return self.cutter_for(hole).ok_or_else(|| self.no_cutter(hole));
        }
        let off = |drill: f64| (drill - hole.diameter).abs();
        let nearest = drills.iter().copied().min_by(|a, b| off(*a).total_cmp(&off(*b)));
        match nearest.filter(|drill| off(*drill) <= self.tolerance + ALIKE) {
            Some(drill) => Ok(Maker::Drill(drill)),
            None => self.cutter_for(hole).ok_or_else(|| self.no_drill(hole, nearest)),
        }
    }

    /// The cutter, where it goes into the hole.
    fn cutter_for(&self, hole: &Hole) -> Option<Maker> {
        let width = setting::diameter(&self.mill.as_ref()?.tool).ok()?;
        (width <= hole.diameter + ALIKE).then_some(Maker::Cutter)
    }

    fn no_drill(&self, hole: &Hole, nearest: Option<f64>) -> Fault {
        let has = nearest.map_or_else(
            || "there is no drill".to_owned(),
            |drill| format!("the nearest drill has {} mm", shown(drill)),
        );
        let message = format!("{}: {has}, the tolerance is {} mm", of(hole), shown(self.tolerance));
        let help = format!(
            "add a drill of {} mm to --drills, allow more by --drill-tolerance, or mill by a --hole-mill of at most that",
            shown(hole.diameter)
        );
        fault(Rule::NoDrill, message, &help)
    }

    fn no_cutter(&self, hole: &Hole) -> Fault {
        let has = match &self.mill {
            None => "there is no cutter to mill with".to_owned(),
            Some(mill) => {
                format!("`{}` has {} mm", mill.tool.name, shown(mill.tool.cutter.width(0.0)))
            }
        };
        let help = format!("give a --hole-mill of at most {} mm", shown(hole.diameter));
        fault(Rule::NoCutter, format!("{}: {has}", of(hole)), &help)
    }

    /// What one drill does; `at` is where the tool comes from, and then where it is.
    fn with_drill(&self, holes: &[(f64, &Hole)], at: &mut Vec2) -> Outcome<Operation> {
        let diameter = holes.first().map_or(0.0, |(diameter, _)| *diameter);
        let hole = |at: Vec2| Cut::Hole { at, depth: self.depth(), peck: self.peck };
        let cuts = holes
            .iter()
            .map(|(_, made)| Ok(self.places(made, diameter)?.into_iter().map(hole).collect()));
        let cuts = cuts.collect::<Outcome<Vec<Vec<Cut>>>>()?;
        let name = format!("drill {} mm", shown(diameter));
        let cutter = Cutter::Cylinder { diameter };
        let (feed, plunge, speed) = (self.plunge, self.plunge, self.speed);
        Ok(Operation {
            name: name.clone(),
            tool: Tool { name, cutter, feed, plunge, speed },
            cuts: in_order(cuts, at),
        })
    }

    /// Where a drill goes down for a hole, in order.
    fn places(&self, hole: &Hole, drill: f64) -> Outcome<Vec<Vec2>> {
        match (&hole.shape, self.slots) {
            (HoleShape::Slot(a, b), Slots::Chain { scallop }) => {
                chain::places(*a, *b, drill, scallop).ok_or_else(|| {
                    let help = "have slots milled by --hole-mill";
                    let message = format!("{} takes more holes than can be drilled", of(hole));
                    fault(Rule::ChainTooLong, message, help)
                })
            }
            _ => Ok(vec![place(hole)]),
        }
    }

    fn with_cutter(&self, mill: &Mill, holes: &[&Hole], at: &mut Vec2) -> Outcome<Operation> {
        let cuts = holes.iter().map(|hole| milled::cuts(hole, mill, self.depth()));
        let cuts = cuts.collect::<Outcome<Vec<Vec<Cut>>>>()?;
        let name = "mill holes".to_owned();
        Ok(Operation { name, tool: mill.tool.clone(), cuts: in_order(cuts, at) })
    }
}

/// A drill for all holes, and for those whose diameters are no more than `near` mm apart one: that of most of them.
fn alike(holes: &[Hole], near: f64) -> Vec<f64> {
    let mut diameters: Vec<f64> = holes.iter().map(|hole| hole.diameter).collect();
    diameters.sort_by(f64::total_cmp);
    let mut drills = Vec::new();
    let mut rest = &diameters[..];
    while let Some(least) = rest.first() {
        let (near, others) =
            rest.split_at(rest.partition_point(|diameter| diameter - least <= near + ALIKE));
        let same = near.chunk_by(|a, b| b - a <= ALIKE).max_by_key(|same| same.len());
        drills.extend(same.and_then(<[f64]>::first));
        rest = others;
    }
    drills
}

/// Groups of cuts, one after the other in an order of short travel; `at` is where the tool comes from, and
/// then where it is.
fn in_order(mut groups: Vec<Vec<Cut>>, at: &mut Vec2) -> Vec<Cut> {
    let ends = |group: &Vec<Cut>| Some((group.first()?.start(), group.last()?.end()));
    let lines: Vec<(Vec2, Vec2)> =
        groups.iter().map(|group| ends(group).unwrap_or((*at, *at))).collect();
    let order = Tour { from: *at, to: None, reversible: false }.of_lines(&lines);
    let cuts: Vec<Cut> = order.into_iter().flat_map(|i| std::mem::take(&mut groups[i])).collect();
    *at = cuts.last().map_or(*at, Cut::end);
    cuts
}

/// Adds a finding, or counts it where it has been made of a hole of the same diameter.
fn count(findings: &mut Vec<Diagnostic>, finding: Diagnostic) {
    // What differs is the place.
    let same = |known: &&mut Diagnostic| known.rule == finding.rule && known.help == finding.help;
    match findings.iter_mut().find(same) {
        Some(known) => known.count = known.count.saturating_add(1),
        None => findings.push(finding),
    }
}

fn differs(hole: &Hole, drill: f64) -> Diagnostic {
    let message = format!("{} is drilled with {} mm", of(hole), shown(drill));
    let help = format!(
        "add a drill of {} mm to --drills where that matters, or allow less by --drill-tolerance",
        shown(hole.diameter)
    );
    Diagnostic::warning(Rule::DrillDiffers, message).help(help)
}

fn loose(hole: &Hole) -> Diagnostic {
    let message = format!("{} closes: the piece within it comes loose", of(hole));
    let help = "hold that piece, or leave gaps in the route; only the outline has tabs";
    Diagnostic::warning(Rule::PieceLoose, message).help(help)
}

/// A hole, its diameter and its place in words.
fn of(hole: &Hole) -> String {
    let at = place(hole);
    let what = match hole.shape {
        HoleShape::Round(_) => "hole",
        HoleShape::Slot(..) => "slot",
        HoleShape::Route(_) => "route",
    };
    format!("a {what} of {} mm at X {:.3} Y {:.3}", shown(hole.diameter), at.x, at.y)
}

/// Where a hole is, or begins, mm.
fn place(hole: &Hole) -> Vec2 {
    match &hole.shape {
        HoleShape::Round(at) | HoleShape::Slot(at, _) => *at,
        HoleShape::Route(elements) => elements.first().map_or(Vec2::ZERO, |first| first.start),
    }
}
