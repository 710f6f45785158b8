//! What is cut of a board: the operations of each program.

use super::{Isolate, Part, Settings, Setup};
use crate::drilling::{Drilling, Mill, Slots};
use crate::gerber::Image;
use crate::isolation::{
    Direction, Fate, Isolated, Isolation, Narrow, NarrowGap, Severed, Slot, severed,
};
use crate::linking;
use crate::outline::{Outline, Tabs};
use crate::setting::shown;
use crate::tour::Tour;
use crate::{
    Board, Clearing, Copper, Cut, Cutter, Division, Engraving, Hole, MERGED, Operation, Path, Tool,
    depths,
};
use geom::ending::{go_on, is_ended};
use geom::region::{Fill, Index, Region, RegionError, Ring};
use geom::{Element, Vec2};
use program::{Diagnostic, Progress, Rule};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The speed of a spindle that has no limit in its machine file, 1/min.
const USUAL_SPEED: f64 = 10_000.0;

/// By how much the cut may be wider where the tool goes on to the next path without leaving the board, mm.
const JOINED: f64 = 0.002;

/// How high may be what stays between the holes of a slot along its wall, mm.
const SCALLOP: f64 = 0.02;

/// How much of what a wider tool has taken the next one goes into, so that nothing stays between the two, mm.
const TOUCHED: f64 = 0.02;

/// How far paths in few elements are off where gaps are bitten, mm.
const BITTEN: f64 = 0.001;

/// From place to place down the middle of a gap at which is looked how much is taken, mm.
const LOOKED: f64 = 0.02;

/// How far apart what was worked out one after the other may be, mm.
const HAIR: f64 = 0.003;

/// The most times around.
const MOST_PASSES: f64 = 100.0;

/// Which part of a pass may be missing to a width that is asked for.
const AS_WIDE: f64 = 1e-6;

/// Which part of their width the rings overlap that clear an area.
const RINGS_OVERLAP: f64 = 0.4;

/// What one program does.
#[derive(Default)]
pub struct Work {
    /// Tool by tool.
    pub operations: Vec<Operation>,
    /// Places to look at; of each kind the worst first.
    pub problems: Vec<Problem>,
    /// What stays that should not.
    pub rest: Vec<Region>,
    /// Where tabs stay, as the path of the tool over them.
    pub tabs: Vec<Element>,
    /// What is odd about it.
    pub warnings: Vec<Diagnostic>,
}

/// A place with a problem, to be looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where, mm.
    pub at: Vec2,
    /// Why.
    pub kind: ProblemKind,
    /// What is there.
    pub what: String,
}

/// What the problem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// Two nets stay joined.
    Joined,
    /// A slot within a net is not cut.
    Slot,
    /// A cut down the middle of a gap takes copper from both nets.
    Bitten,
    /// A cut leaves a net in pieces.
    Severed,
    /// Something is not made, since the tool is too wide.
    NotMade,
}

impl ProblemKind {
    /// What it is called in reports.
    pub fn name(self) -> &'static str {
        match self {
            ProblemKind::Joined => "joined",
            ProblemKind::Slot => "slot",
            ProblemKind::Bitten => "bitten",
            ProblemKind::Severed => "severed",
            ProblemKind::NotMade => "not-made",
        }
    }
}

impl Work {
    /// What is cut for `part` of a board that lies so, by a spindle that turns `fastest` 1/min at most, while who waits for it goes on.
    ///
    /// # Errors
    /// Where a tool is missing, or cannot do it; or that the work shall end (`cancelled`), which is asked between the steps of a part.
    pub fn of(
        part: Part,
        setup: &Setup,
        settings: &Settings,
        fastest: f64,
        progress: &dyn Progress,
    ) -> Result<Work, Vec<Diagnostic>> {
        let board = &setup.board;
        let speed = settings.running.speed.unwrap_or(USUAL_SPEED.min(fastest));
        let mut work = Work::default();
        let worker = Worker { asked: settings, speed, progress };
        let side = &board.front;
        match part {
            Part::Front | Part::Back => {
                if let Some(copper) = &side.copper {
                    worker.copper(&mut work, copper, board)?;
                }
            }
            Part::Drill => {
                let holes: Vec<Hole> = setup.drilled().cloned().collect();
                worker.drill(&mut work, &holes)?;
            }
            Part::Outline => worker.outline(&mut work, board)?,
            Part::FrontMask | Part::BackMask => {
                if let Some(mask) = &side.mask {
                    worker.mask(&mut work, mask)?;
                }
            }
            Part::FrontLegend | Part::BackLegend => {
                if let Some(legend) = &side.legend {
                    worker.legend(&mut work, legend)?;
                }
            }
        }
        Ok(work)
    }

    /// Has one of several tools cut what is left for it; a tool for which nothing is left is not called, and that is said.
    fn go_on(&mut self, what: &str, tool: Tool, cuts: Vec<Cut>) {
        if cuts.is_empty() {
            let message = format!("{what}: nothing is left that {} reaches", tool.name);
            let help = "take a narrower tool, or leave it out";
            self.warnings.push(Diagnostic::warning(Rule::NotReached, message).help(help));
        } else {
            self.operations.push(Operation { name: format!("{what}, {}", tool.name), tool, cuts });
        }
    }
}

struct Worker<'a> {
    asked: &'a Settings,
    speed: f64,
    progress: &'a dyn Progress,
}

impl Worker<'_> {
    /// # Errors
    /// The work shall end.
    fn go_on(&self) -> Result<(), Vec<Diagnostic>> {
        if self.progress.reached(0.0) { Ok(()) } else { Err(vec![program::cancelled()]) }
    }

    /// Isolates copper, and takes away what is surplus where that is asked for.
    fn copper(
        &self,
        work: &mut Work,
        copper: &Copper,
        board: &Board,
    ) -> Result<(), Vec<Diagnostic>> {
        let settings = &self.asked.isolation;
        let bit = self.bit()?;
        let step = settings.step.unwrap_or(settings.depth);
        crate::setting::step("the step of the isolation", step, settings.depth)?;
        let depths = depths(settings.depth, step);
        let width = bit.cutter.width(settings.depth);
        let running = &self.asked.running;
        // As far as the tool cuts while it would come up, go on and come down.
        let down = running.approach + settings.depth;
        let detour = running.travel + running.feed * down / running.plunge;
        let (lines, dots) = match settings.isolate {
            Isolate::Contours => {
                let inverted = settings.invert.then(|| inverted(copper, board)).transpose()?;
                let (copper, area) = match &inverted {
                    Some((inverted, area)) => (inverted, Some(area)),
                    None => (copper, None),
                };
                let rest = self.by_wider(work, copper, area, width, &depths, detour)?;
                let area = rest.as_ref().or(area);
                let (paths, around) = self.around(work, copper, area, bit.cutter)?;
                self.go_on()?;
                let (lines, dots) = merged_to(&linking::trails(&paths, detour), tolerance(work));
                self.go_on()?;
                (linking::linked(&lines, &around, detour), dots)
            }
            Isolate::Middle => {
                merged(&linking::trails(&self.between(work, copper, board, width)?, detour))
            }
            Isolate::Lines => merged(&linking::trails(&along_lines(work, board)?, detour)),
        };
        self.go_on()?;
        let cuts = cuts(&lines, &dots, width, &depths);
        match settings.wider.is_empty() {
            true => work.operations.push(Operation {
                name: format!("isolation, {}", bit.name),
                tool: bit,
                cuts,
            }),
            false => work.go_on("isolation", bit, cuts),
        }
        if self.asked.clearing.clear.is_empty() {
            return Ok(());
        }
        self.go_on()?;
        let area = area(board)?;
        let clearing = self.clearing(self.asked.clearing.clear.clone());
        let cleared = clearing.rub_out(&copper.region, self.asked.clearing.margin, &area)?;
        self.cleared(work, "surplus copper", &clearing, &cleared.passes, &depths);
        self.missing(work, &cleared.rest, "not cleared: the tools are too wide");
        Ok(())
    }

    /// Isolates by each of the wider tools as far as it goes in; answers where the middle of the one that cuts `width` mm has
    /// still to go, `None` where there is no wider one.
    fn by_wider(
        &self,
        work: &mut Work,
        copper: &Copper,
        area: Option<&Region>,
        width: f64,
        depths: &[f64],
        detour: f64,
    ) -> Result<Option<Region>, Vec<Diagnostic>> {
        let wider = &self.asked.isolation.wider;
        let narrower = wider.iter().skip(1).copied().chain([width]);
        let mut taken = copper.region.clone();
        let mut left: Option<Region> = None;
        for (tool, next) in wider.iter().zip(narrower) {
            if *tool <= next {
                let message = format!("{tool} mm is not wider than the next tool, {next:.3} mm");
                let help = "give the widest first: what one leaves, the next cuts";
                return Err(vec![Diagnostic::error(Rule::ToolWidth, message).help(help)]);
            }
            let mill = self.end_mill(*tool);
            let isolation = Isolation { narrow: Narrow::LeaveOut, ..self.isolation(mill.cutter)? };
            self.go_on()?;
            let isolated = isolation.isolate(copper, left.as_ref().or(area))?;
            let (lines, dots) = merged(&linking::trails(&isolated.paths, detour));
            let lines = linking::linked(&lines, &isolated.around, detour);
            work.go_on("isolation", mill, cuts(&lines, &dots, *tool, depths));
            let farther = tool * (isolation.passes - 1) as f64 * (1.0 - isolation.overlap);
            let swept = swept(&isolated.around, *tool, farther);
            let rest = swept.and_then(|swept| {
                taken = taken.union(&swept)?;
                rest(&taken, *tool, next, area)
            });
            left = Some(rest.map_err(|error| too_large(&error))?);
        }
        Ok(left)
    }

    /// How copper is isolated by a tool.
    ///
    /// # Errors
    /// `passes` where it would have to go around too often.
    fn isolation(&self, cutter: Cutter) -> Result<Isolation, Vec<Diagnostic>> {
        let settings = &self.asked.isolation;
        let mut isolation = Isolation {
            cutter,
            depth: settings.depth,
            passes: settings.passes as usize,
            overlap: settings.overlap,
            direction: self.direction(),
            narrow: settings.narrow,
        };
        if let Some(wanted) = settings.isolation_width {
            let width = isolation.width();
            let more = (wanted - width) / (width * (1.0 - settings.overlap));
            if more > MOST_PASSES {
                let message = format!(
                    "a cut of {width:.3} mm makes no isolation of {wanted} mm in {MOST_PASSES} times around"
                );
                let help =
                    "a wider tool, or --clear with one that takes away all copper between nets";
                return Err(vec![Diagnostic::error(Rule::Passes, message).help(help)]);
            }
            isolation.passes = 1 + (more - AS_WIDE).ceil().max(0.0) as usize;
        }
        Ok(isolation)
    }

    /// The paths around copper, and what the middle of the tool stays out of.
    fn around(
        &self,
        work: &mut Work,
        copper: &Copper,
        area: Option<&Region>,
        cutter: Cutter,
    ) -> Result<(Vec<Path>, Region), Vec<Diagnostic>> {
        let isolation = self.isolation(cutter)?;
        let isolated = isolation.isolate(copper, area)?;
        let Isolated { paths, narrow, slots, unreached, around, is_around_all, severed } = isolated;
        let width = isolation.width();
        self.narrow(work, copper, &narrow, width, is_around_all)?;
        self.slots(work, copper, &slots, width);
        tell_severed(work, copper, &severed);
        work.rest.push(unreached);
        Ok((paths, around))
    }

    /// Tells of gaps that are too narrow; refuses where nothing would be apart: all nets stay joined, and no path is
    /// between any two.
    fn narrow(
        &self,
        work: &mut Work,
        copper: &Copper,
        gaps: &[NarrowGap],
        width: f64,
        is_around_all: bool,
    ) -> Result<(), Vec<Diagnostic>> {
        let of = |fate: Fate| gaps.iter().filter(move |gap| gap.fate == fate);
        let sum = |fate: Fate| -> f64 { of(fate).map(|gap| gap.length).sum() };
        let nets = |gap: &NarrowGap| gap.islands.map(|island| net(copper, island)).join(" and ");
        let too_narrow = |fate: Fate| {
            let gaps = counted(of(fate).count(), "gap");
            format!("{gaps} narrower than the cut of {width:.3} mm")
        };
        let joined: Vec<&NarrowGap> = of(Fate::Joined).collect();
        for (gap, length) in together(&joined, width, nets) {
            let what = format!(
                "{} are {:.3} mm apart over {length:.2} mm, left out: they stay joined here",
                nets(gap),
                gap.width
            );
            work.problems.push(Problem { at: gap.at, kind: ProblemKind::Joined, what });
        }
        if let Some(widest) = joined.first().map(|gap| gap.widest_cut()) {
            let mut help = self.fitting(widest, "part the nets there by hand, or change the board");
            if widest > 0.0 && self.asked.isolation.narrow != Narrow::Middle {
                help += "; or cut them by --narrow middle, whatever it takes of the copper";
            }
            let is_nothing_apart = all_joined(copper, &joined);
            if is_nothing_apart && is_around_all {
                let message = format!(
                    "a cut {width:.3} mm wide fits between no two nets that are not joined elsewhere: \
                     nothing would be isolated"
                );
                return Err(vec![Diagnostic::error(Rule::ToolTooWide, message).help(help)]);
            }
            let all = if is_nothing_apart { "; all nets are joined by them" } else { "" };
            let message = format!(
                "{}: left out, {:.2} mm in all{all}",
                too_narrow(Fate::Joined),
                sum(Fate::Joined)
            );
            work.warnings.push(Diagnostic::warning(Rule::NarrowGap, message).help(help));
        }
        let index = Index::new(&copper.region);
        let bitten =
            |gap: &'_ NarrowGap| gap.middle.as_ref().map(|middle| bite(&index, middle, width));
        let mut cut: Vec<(&NarrowGap, (f64, Vec2))> =
            of(Fate::Cut).filter_map(|gap| Some((gap, bitten(gap)?))).collect();
        let narrowest = cut.first().map_or(0.0, |(gap, _)| gap.widest_cut());
        cut.sort_by(|(_, (a, _)), (_, (b, _))| b.total_cmp(a));
        let Some((_, (deepest, at))) = cut.first().copied() else { return Ok(()) };
        // Of bites, none of which is deep, the deepest stands for all.
        let many = if self.asked.isolation.narrow == Narrow::Bite { 1 } else { cut.len() };
        for (gap, (bite, at)) in cut.iter().take(many) {
            let what = format!(
                "{} are {:.3} mm apart over {:.2} mm, cut all the same: {bite:.3} mm thinner each",
                nets(gap),
                width - 2.0 * bite,
                gap.length
            );
            work.problems.push(Problem { at: *at, kind: ProblemKind::Bitten, what });
        }
        let message = format!(
            "{}: cut down the middle, {:.2} mm in all, which takes at most {:.3} mm from either side, at X {:.3} Y {:.3}",
            too_narrow(Fate::Cut),
            sum(Fate::Cut),
            deepest,
            at.x,
            at.y
        );
        let help = format!(
            "nothing to do, if the copper may be so much thinner; {}",
            self.fitting(narrowest, "it has to be")
        );
        work.warnings.push(Diagnostic::warning(Rule::NarrowGap, message).help(help));
        Ok(())
    }

    /// Tells of slots within nets which the tool does not enter.
    fn slots(&self, work: &mut Work, copper: &Copper, slots: &[Slot], width: f64) {
        for Slot { at, island, width, length } in slots {
            let net = net(copper, *island);
            let what = format!(
                "a slot of {net} is {width:.3} mm wide over {length:.2} mm: the tool does not go in"
            );
            work.problems.push(Problem { at: *at, kind: ProblemKind::Slot, what });
        }
        let Some(longest) = slots.first() else { return };
        let message = format!(
            "{} within nets narrower than the cut of {width:.3} mm: copper stays in them, over {:.2} mm in all; the longest \
             is {:.3} mm wide, at X {:.3} Y {:.3}",
            counted(slots.len(), "slot"),
            slots.iter().map(|slot| slot.length).sum::<f64>(),
            longest.width,
            longest.at.x,
            longest.at.y
        );
        let narrowest = slots.iter().map(|slot| slot.width).fold(f64::INFINITY, f64::min);
        let help = format!(
            "nothing to do, if they only part a net from itself; {}",
            self.fitting(narrowest, "the copper in them stays, or is etched or scraped out")
        );
        work.warnings.push(Diagnostic::warning(Rule::NarrowSlot, message).help(help));
    }

    /// Advice on a tool that cuts no wider than `widest` mm, or what to do `else_` where there is none.
    fn fitting(&self, widest: f64, else_: &str) -> String {
        let depth = self.asked.isolation.depth;
        if widest <= 0.0 {
            return String::from("where copper touches no tool fits: look at the board");
        }
        let fits = format!("a cut of {widest:.3} mm fits everywhere");
        if let Some(mill) = MILLS.iter().chain(&FINE_MILLS).find(|mill| **mill <= widest) {
            return format!("{fits}, such as that of an end mill of {mill} mm (--tool {mill})");
        }
        let width =
            |degrees: f64| Cutter::Vee { tip: VEE_TIP, angle: degrees.to_radians() }.width(depth);
        match VEES.iter().find(|degrees| width(**degrees) <= widest) {
            Some(degrees) => format!(
                "{fits}, such as that of a V-bit, {:.3} mm (--vee {degrees} --tip {VEE_TIP} --depth {depth})",
                width(*degrees)
            ),
            None => format!("{fits}, and no usual tool is so thin: {else_}"),
        }
    }

    /// The paths in the middle between conductors.
    fn between(
        &self,
        work: &mut Work,
        copper: &Copper,
        board: &Board,
        width: f64,
    ) -> Result<Vec<Path>, Vec<Diagnostic>> {
        if self.asked.isolation.passes > 1 {
            let message = "one path in the middle separates two nets: several passes do not apply";
            let help = "leave out --passes, or --isolate middle";
            return Err(vec![Diagnostic::error(Rule::Passes, message).help(help)]);
        }
        let asked = self.asked.isolation.narrow;
        let Division { paths, narrow } = crate::divided(copper, &area(board)?, width, asked)?;
        self.narrow(work, copper, &narrow, width, paths.is_empty())?;
        let is_cut = |gap: &NarrowGap| gap.fate == Fate::Cut;
        let middles: Vec<Path> =
            narrow.into_iter().filter(is_cut).filter_map(|gap| gap.middle).collect();
        tell_severed(work, copper, &severed(copper, &middles, width)?);
        Ok(paths)
    }

    /// Drills, and mills what no drill makes.
    fn drill(&self, work: &mut Work, holes: &[Hole]) -> Result<(), Vec<Diagnostic>> {
        let (settings, placing, running) =
            (&self.asked.drilling, &self.asked.placing, &self.asked.running);
        let mill = settings.hole_mill.map(|diameter| Mill {
            tool: Tool { feed: running.outline_feed, ..self.end_mill(diameter) },
            step: self.asked.outline.outline_step,
            direction: self.direction(),
            instead: settings.mill_holes_over.unwrap_or(f64::INFINITY),
        });
        let drilling = Drilling {
            thickness: placing.thickness,
            below: placing.through,
            drills: Some(settings.drills.clone()).filter(|drills| !drills.is_empty()),
            tolerance: settings.drill_tolerance,
            peck: settings.peck,
            plunge: running.drill_feed,
            speed: self.speed,
            slots: if mill.is_some() { Slots::Mill } else { Slots::Chain { scallop: SCALLOP } },
            mill,
            from: Vec2::ZERO,
        };
        let drilled = drilling.drill(holes)?;
        work.operations.extend(drilled.operations);
        work.warnings.extend(drilled.warnings);
        Ok(())
    }

    /// Cuts the board out, and small cut-outs by the mill for holes.
    fn outline(&self, work: &mut Work, board: &Board) -> Result<(), Vec<Diagnostic>> {
        let (settings, placing) = (&self.asked.outline, &self.asked.placing);
        let outline = Outline {
            tool: Tool {
                feed: self.asked.running.outline_feed,
                ..self.end_mill(settings.outline_tool)
            },
            thickness: placing.thickness,
            below: placing.through,
            step: settings.outline_step,
            direction: self.direction(),
            tabs: (settings.tabs > 0 || !settings.tab_at.is_empty()).then_some(Tabs {
                count: settings.tabs as usize,
                width: settings.tab_width,
                height: settings.tab_height,
            }),
            tabs_at: settings.tab_at.clone(),
            from: Vec2::ZERO,
        };
        let too_large = |error: RegionError| {
            let message = format!("the outline of the board: {error}");
            vec![Diagnostic::error(Rule::TooLarge, message).help("correct the outline")]
        };
        let (board, small) = by_size(&area(board)?, settings.outline_tool).map_err(too_large)?;
        self.small(work, &small, &outline).map_err(too_large)?;
        let cut = outline.cut(&board)?;
        work.tabs = tabs(&cut.operation);
        let name = format!("outline, {}", cut.operation.tool.name);
        work.operations.push(Operation { name, ..cut.operation });
        work.warnings.extend(cut.warnings);
        Ok(())
    }

    /// Cuts small cut-outs by the mill for holes where it fits, and marks the others.
    fn small(&self, work: &mut Work, small: &[Ring], outline: &Outline) -> Result<(), RegionError> {
        let mill = self.asked.drilling.hole_mill.unwrap_or(f64::INFINITY);
        let (mut paths, mut missing) = (Vec::new(), Vec::new());
        for ring in small {
            let inside = Region::inside([ring], Fill::NonZero)?;
            let reached =
                if mill.is_finite() { inside.offset(-mill / 2.0)? } else { Region::default() };
            match reached.is_empty() {
                true => missing.push(ring.extents()),
                // Counter-clockwise the board is on the right.
                false => paths.extend(reached.rings().filter_map(Path::around)),
            }
        }
        if let Direction::Conventional = self.direction() {
            paths = paths.iter().map(Path::reversed).collect();
        }
        let depths = depths(outline.thickness + outline.below, outline.step);
        let tour = Tour { from: Vec2::ZERO, to: None, reversible: false };
        let cuts: Vec<Cut> =
            tour.of_paths(&paths).iter().map(|path| Cut::along(path, &depths)).collect();
        if !cuts.is_empty() {
            let tool = Tool { feed: self.asked.running.outline_feed, ..self.end_mill(mill) };
            work.operations.push(Operation {
                name: format!("small cut-outs, {}", tool.name),
                tool,
                cuts,
            });
        }
        let Some((low, high)) = missing.first().copied() else { return Ok(()) };
        let size =
            |(low, high): (Vec2, Vec2)| format!("{:.3} x {:.3} mm", high.x - low.x, high.y - low.y);
        for (low, high) in &missing {
            let what =
                format!("a cut-out of {} is not cut: the tool is too wide", size((*low, *high)));
            work.problems.push(Problem {
                at: low.midpoint(*high),
                kind: ProblemKind::NotMade,
                what,
            });
        }
        let at = low.midpoint(high);
        let message = format!(
            "{} not cut: an end mill of {} mm does not go in, the first of {} at X {:.3} Y {:.3}",
            counted(missing.len(), "cut-out"),
            shown(outline.tool.cutter.width(0.0)),
            size((low, high)),
            at.x,
            at.y
        );
        let smallest = missing
            .iter()
            .map(|(low, high)| (high - low).min_element())
            .fold(f64::INFINITY, f64::min);
        let fits = MILLS.iter().find(|mill| **mill < smallest);
        let help = match fits {
            Some(mill) => {
                format!("give --hole-mill {mill}: it cuts all of them, the outline keeps its tool")
            }
            None => String::from("drill them, or change the outline: no usual mill is so thin"),
        };
        work.warnings.push(Diagnostic::warning(Rule::CutoutTooSmall, message).help(help));
        Ok(())
    }

    /// Opens solder mask.
    fn mask(&self, work: &mut Work, mask: &Region) -> Result<(), Vec<Diagnostic>> {
        let clearing = self.clearing(self.asked.clearing.mask_tool.into_iter().collect());
        let cleared = clearing.clear(mask)?;
        self.cleared(
            work,
            "solder mask",
            &clearing,
            &cleared.passes,
            &[self.asked.clearing.engrave],
        );
        self.missing(work, &cleared.rest, "not opened: the tool is too wide");
        Ok(())
    }

    /// Engraves what is printed.
    fn legend(&self, work: &mut Work, legend: &Image) -> Result<(), Vec<Diagnostic>> {
        let width = self.asked.clearing.legend_tool.unwrap_or(0.0);
        let Engraving { paths, rest } = crate::engraved(legend, width)?;
        let tool = self.end_mill(width);
        work.operations.push(Operation {
            name: format!("legend, {}", tool.name),
            tool,
            cuts: along(&paths, width, &[self.asked.clearing.engrave]),
        });
        self.missing(work, &rest, "not engraved: the tool is too wide");
        Ok(())
    }

    /// Marks what is not done.
    fn missing(&self, work: &mut Work, rest: &Region, what: &str) {
        for island in rest.islands() {
            let (low, high) = island.outer().extents();
            let (at, what) = (low.midpoint(high), what.to_owned());
            work.problems.push(Problem { at, kind: ProblemKind::NotMade, what });
        }
        work.rest.push(rest.clone());
        if !rest.is_empty() {
            let places = counted(rest.islands().len(), "place");
            let message = format!("{places}, {:.3} mm², {what}", rest.area());
            let help = "take a narrower tool";
            work.warnings.push(Diagnostic::warning(Rule::NotReached, message).help(help));
        }
    }

    fn cleared(
        &self,
        work: &mut Work,
        what: &str,
        clearing: &Clearing,
        passes: &[Vec<Path>],
        depths: &[f64],
    ) {
        for (width, paths) in clearing.widths.iter().zip(passes) {
            work.go_on(what, self.end_mill(*width), along(paths, *width, depths));
        }
    }

    fn clearing(&self, widths: Vec<f64>) -> Clearing {
        Clearing { widths, overlap: RINGS_OVERLAP, direction: self.direction() }
    }

    fn direction(&self) -> Direction {
        self.asked.isolation.direction
    }

    /// The tool that isolates.
    fn bit(&self) -> Result<Tool, Vec<Diagnostic>> {
        let settings = &self.asked.isolation;
        match (settings.tool, settings.vee) {
            (Some(diameter), _) => Ok(self.end_mill(diameter)),
            (None, Some(degrees)) => {
                let cutter = Cutter::Vee { tip: settings.tip, angle: degrees.to_radians() };
                Ok(self.tool(format!("V-bit {degrees} degrees"), cutter))
            }
            (None, None) => {
                let message = "no tool is given that cuts around copper";
                let help = "give --tool with the width of an end mill, or --vee with the angle of a V-bit; \
                            or leave copper out with --only";
                Err(vec![Diagnostic::error(Rule::NoTool, message).help(help)])
            }
        }
    }

    fn end_mill(&self, diameter: f64) -> Tool {
        self.tool(format!("end mill {diameter} mm"), Cutter::Cylinder { diameter })
    }

    /// A tool for copper.
    fn tool(&self, name: String, cutter: Cutter) -> Tool {
        let running = &self.asked.running;
        Tool { name, cutter, feed: running.feed, plunge: running.plunge, speed: self.speed }
    }
}

/// Widths of end mills that one can buy, mm, the widest first.
const MILLS: [f64; 9] = [3.0, 2.0, 1.5, 1.0, 0.8, 0.6, 0.5, 0.4, 0.3];

/// Widths of end mills for copper alone, mm.
const FINE_MILLS: [f64; 1] = [0.2];

/// Angles of V-bits that one can buy with a tip of [`VEE_TIP`] mm, degrees, the widest first.
const VEES: [f64; 6] = [60.0, 45.0, 30.0, 20.0, 15.0, 10.0];

/// mm.
const VEE_TIP: f64 = 0.1;

/// The board with the cut-outs that a tool of `width` mm goes into, and the others.
fn by_size(board: &Region, width: f64) -> Result<(Region, Vec<Ring>), RegionError> {
    let (mut rings, mut small) = (Vec::new(), Vec::new());
    for island in board.islands() {
        rings.push(island.outer().clone());
        for ring in island.holes() {
            let is_small = Region::inside([ring], Fill::NonZero)?.offset(-width / 2.0)?.is_empty();
            if is_small { &mut small } else { &mut rings }.push(ring.clone());
        }
    }
    match small.is_empty() {
        true => Ok((board.clone(), small)),
        false => Ok((Region::inside(&rings, Fill::EvenOdd)?, small)),
    }
}

/// So many of something.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Tells of conductors that cuts down the middle of gaps leave in pieces.
fn tell_severed(work: &mut Work, copper: &Copper, severed: &[Severed]) {
    for Severed { at, island, pieces } in severed {
        let net = net(copper, *island);
        let what = match pieces {
            0 => format!("nothing is left of {net}, by a cut down the middle of a gap"),
            _ => format!("{net} is cut into {pieces} pieces, down the middle of a gap"),
        };
        work.problems.push(Problem { at: *at, kind: ProblemKind::Severed, what });
    }
    if let Some(first) = severed.first() {
        let message = format!(
            "{} cut to pieces by cuts down the middle of gaps, {} among them",
            counted(severed.len(), "conductor"),
            net(copper, first.island)
        );
        let help = "take a narrower tool, or leave narrow gaps out (--narrow leave-out)";
        work.warnings.push(Diagnostic::warning(Rule::ConductorSevered, message).help(help));
    }
}

/// What a conductor is called.
fn net(copper: &Copper, island: usize) -> String {
    match copper.nets.get(island) {
        Some(Some(net)) => net.to_string(),
        _ => format!("conductor {}", island + 1),
    }
}

/// Cuts along `paths` at each depth, in an order of short travel. A path without length is a dot.
fn along(paths: &[Path], width: f64, depths: &[f64]) -> Vec<Cut> {
    let (lines, dots) = merged(paths);
    cuts(&lines, &dots, width, depths)
}

/// Paths in few elements, and where those are that have no length.
fn merged(paths: &[Path]) -> (Vec<Path>, Vec<Vec2>) {
    merged_to(paths, MERGED)
}

/// How far paths in few elements may be off, mm: less where they go down the middle of gaps that are bitten, since what they are
/// off is taken from one side.
fn tolerance(work: &Work) -> f64 {
    let is_bitten = work.problems.iter().any(|place| place.kind == ProblemKind::Bitten);
    if is_bitten { BITTEN } else { MERGED }
}

/// Paths in elements that are no more than `tolerance` mm off, and where those are that have no length.
fn merged_to(paths: &[Path], tolerance: f64) -> (Vec<Path>, Vec<Vec2>) {
    let mut lines = Vec::with_capacity(paths.len());
    let mut dots = Vec::new();
    let merged = |path: &Path| if is_ended() { None } else { path.merged(tolerance) };
    let merged: Vec<Option<Path>> = paths.par_iter().with_max_len(1).map(merged).collect();
    go_on();
    for (path, line) in paths.iter().zip(merged) {
        match line {
            Some(line) => lines.push(line),
            None => dots.push(path.start()),
        }
    }
    (lines, dots)
}

/// Cuts along `lines` and at `dots` at each depth, in an order of short travel.
fn cuts(lines: &[Path], dots: &[Vec2], width: f64, depths: &[f64]) -> Vec<Cut> {
    let tour = Tour { from: Vec2::ZERO, to: None, reversible: true };
    let mut lines = tour.of_paths(lines);
    if depths.len() == 1 {
        // Deeper, a way that is not closed any more would be cut the other way round.
        lines = crate::joined(&lines, width, JOINED);
    }
    let at = lines.last().map_or(Vec2::ZERO, Path::end);
    let order = Tour { from: at, ..tour }.of_points(dots);
    let depth = depths.iter().copied().fold(0.0, f64::max);
    let dot = |at: &Vec2| Cut::Hole { at: *at, depth, peck: None };
    let dots = order.into_iter().filter_map(|index| dots.get(index)).map(dot);
    lines.iter().map(|path| Cut::along(path, depths)).chain(dots).collect()
}

/// Where there is board.
fn area(board: &Board) -> Result<Region, Vec<Diagnostic>> {
    if let Some(outline) = &board.outline {
        return Ok(outline.clone());
    }
    if let Some(edge) = &board.broken_edge {
        return Err(edge.findings.clone());
    }
    let message = "no file says where the board ends";
    let help = "give the layer of its outline too, or --board-margin for a rectangle around copper and holes";
    Err(vec![Diagnostic::error(Rule::NoOutline, message).help(help)])
}

/// What a tool of `width` mm takes away around copper, from where its middle stays out of `around`, and `farther` mm beyond.
fn swept(around: &Region, width: f64, farther: f64) -> Result<Region, RegionError> {
    let outer = around.offset(farther + width / 2.0)?;
    outer.difference(&around.offset(-width / 2.0)?)
}

/// Where the middle of a tool of `width` mm has still to go, within `area` where one is given, for everything to be cut that it
/// reaches and that is not `taken` by one of `wider` mm, or copper.
fn rest(
    taken: &Region,
    wider: f64,
    width: f64,
    area: Option<&Region>,
) -> Result<Region, RegionError> {
    // What is a hair apart is together.
    let covered = taken.offset(HAIR)?.offset(-HAIR - TOUCHED - width / 2.0)?;
    let (low, high) = taken.extents().unwrap_or_default();
    let (low, high) = (low - wider, high + wider);
    let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
    let all = Region::inside([&Ring::polygon(&corners)?], Fill::NonZero)?;
    let rest = all.difference(&covered)?;
    match area {
        Some(area) => rest.intersection(area),
        None => Ok(rest),
    }
}

/// Gaps with the sum of their lengths, those of the same two nets that are no farther apart than the cut is wide as one.
fn together<'a>(
    gaps: &[&'a NarrowGap],
    width: f64,
    nets: impl Fn(&NarrowGap) -> String,
) -> Vec<(&'a NarrowGap, f64)> {
    let mut known: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    let mut places: Vec<(&NarrowGap, f64)> = Vec::with_capacity(gaps.len());
    for gap in gaps {
        let same = known.entry(nets(gap)).or_default();
        let near = |i: &&usize| {
            places.get(**i).is_some_and(|(other, _)| other.at.distance(gap.at) <= width)
        };
        match same.iter().find(near).copied() {
            Some(i) => places[i].1 += gap.length,
            None => {
                same.push(places.len());
                places.push((gap, gap.length));
            }
        }
    }
    places
}

/// How much copper a cut of `width` mm along `path` takes where it takes most, and where that is, mm.
fn bite(copper: &Index, path: &Path, width: f64) -> (f64, Vec2) {
    let mut most = (0.0, path.start());
    for element in path.elements() {
        let steps = (element.length() / LOOKED).ceil().clamp(1.0, 1e5);
        for step in 0..=steps as usize {
            let at = element.at(step as f64 / steps);
            let away = copper.nearest(at, width / 2.0).map_or(width / 2.0, |near| near.distance);
            if width / 2.0 - away > most.0 {
                most = (width / 2.0 - away, at);
            }
        }
    }
    most
}

/// Where the tool goes over a tab, the last time around each contour.
fn tabs(operation: &Operation) -> Vec<Element> {
    let over = |cut: &Cut| -> Vec<Element> {
        let Cut::Path(segments) = cut else { return Vec::new() };
        let deepest = segments.iter().map(|segment| segment.depth).fold(0.0, f64::max);
        let last = segments.iter().skip_while(|segment| segment.depth < deepest);
        last.filter(|segment| segment.depth < deepest).map(|segment| segment.element).collect()
    };
    operation.cuts.iter().flat_map(over).collect()
}

/// What is not copper of a board as its copper, and where there is board: within the outline, or the box around its copper.
fn inverted(copper: &Copper, board: &Board) -> Result<(Copper, Region), Vec<Diagnostic>> {
    let area = match &board.outline {
        Some(outline) => Ok(outline.clone()),
        None => {
            let (low, high) = copper.region.extents().unwrap_or_default();
            let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
            Ring::polygon(&corners).and_then(|ring| Region::inside([&ring], Fill::NonZero))
        }
    };
    let inverted = area.and_then(|area| Ok((area.difference(&copper.region)?, area)));
    let (region, area) = inverted.map_err(|error| too_large(&error))?;
    let nets = vec![None; region.islands().len()];
    Ok((Copper { region, nets }, area))
}

/// The lines with which the copper of a side is drawn, those that go on from each other in one.
///
/// # Errors
/// `no-such-part` where no line is drawn.
fn along_lines(work: &mut Work, board: &Board) -> Result<Vec<Path>, Vec<Diagnostic>> {
    let lines = &board.front.lines;
    if lines.is_empty() {
        let message =
            "the copper of this side is drawn with no lines, and --isolate lines cuts along them";
        let help = "leave it out: then it is cut around the copper";
        return Err(vec![Diagnostic::error(Rule::NoSuchPart, message).help(help)]);
    }
    let message = format!(
        "{} of the copper cut along the middle: pads and areas are not cut, and no net is isolated",
        counted(lines.len(), "line")
    );
    work.warnings.push(
        Diagnostic::warning(Rule::LinesOnly, message).help("nothing to do, if this is a drawing"),
    );
    Ok(lines.iter().filter_map(|line| Path::new(vec![*line])).collect())
}

fn too_large(error: &RegionError) -> Vec<Diagnostic> {
    let finding = Diagnostic::error(Rule::BoardTooLarge, error.to_string());
    vec![finding.help("take a part of the board")]
}

/// Whether gaps that are left out join all conductors, which are more than one, with each other.
fn all_joined(copper: &Copper, gaps: &[&NarrowGap]) -> bool {
    let mut group = copper.conductors();
    let conductors = group.iter().enumerate().filter(|(island, first)| island == *first).count();
    fn root(group: &mut [usize], mut of: usize) -> usize {
        while let Some(up) = group.get(of).copied().filter(|up| *up != of) {
            // The distance up is halved.
            let beyond = group.get(up).copied().unwrap_or(up);
            if let Some(place) = group.get_mut(of) {
                *place = beyond;
            }
            of = up;
        }
        of
    }
    for gap in gaps {
        let [a, b] = gap.islands.map(|island| root(&mut group, island));
        if let Some(place) = group.get_mut(a.max(b)) {
            *place = a.min(b);
        }
    }
    conductors > 1 && (0..group.len()).all(|island| root(&mut group, island) == 0)
}
