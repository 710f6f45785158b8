//! What is cut in which order: openings, passes, leads, tabs.

use crate::contour::Contour;
use crate::lead::{Lead, LeadShape};
use crate::offset::{Corner, Corners};
use crate::order::order;
use crate::path::Path;
use crate::room::Room;
use crate::round::Round;
use crate::taper::Rounding;
use geom::Vec2;
use program::{Diagnostic, Rule};
use sketch::{Element, FAR};
use std::f64::consts::FRAC_PI_3;

/// A contour to cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// What shall remain, on the lower face of the part. The first pass runs in its direction.
    pub contour: Contour,
    /// On which side of it the wire runs.
    pub side: Side,
    /// Where the wire is threaded. `None`: [`Lead::length`] from the start of the contour, on the wire's side.
    pub thread: Option<Vec2>,
    /// Where the cut of a closed contour starts: the place nearest to this point. `None`: nearest to
    /// where the wire is threaded, or else where the contour starts, and where that is an inner corner
    /// for the wire, in the middle of its longest element.
    pub start: Option<Vec2>,
}

impl Opening {
    /// Whether the wire runs on the left of the contour.
    pub fn left(&self) -> bool {
        match self.side {
            Side::Left => true,
            Side::Right => false,
            Side::Inside => self.contour.area() > 0.0,
            Side::Outside => self.contour.area() < 0.0,
        }
    }
}

/// On which side of a contour the wire runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Within a closed contour: an opening of a die.
    Inside,
    /// Round a closed contour: a punch.
    Outside,
    /// Left of the direction of travel (`G41`).
    Left,
    /// Right of it (`G42`).
    Right,
}

/// How everything is cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The rough pass and the trim passes after it.
    pub passes: Vec<Cut>,
    /// In which direction the trim passes run.
    pub trims: Trims,
    /// From where the wire is threaded to the contour, and back.
    pub lead: Lead,
    /// How much of a closed contour holds the part until everything else of it is cut, mm.
    pub tab: f64,
    /// What becomes of inner corners that the wire of the last pass is too thick for.
    pub corners: Corners,
    /// How the wire leans, if it does.
    pub taper: Option<Taper>,
    /// Whether the control offsets and leans (`G41 D`, `G51 T`): the paths are then those of an upright
    /// wire without thickness, and everything is checked all the same.
    pub by_control: bool,
}

/// One pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Distance of the wire's centre from the contour, mm: its radius, the spark gap, and what later
    /// passes take.
    pub offset: f64,
    /// Feed, mm/min.
    pub feed: f64,
}

/// In which direction the trim passes run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trims {
    /// Each the other way than the one before: the wire stays threaded.
    #[default]
    Alternate,
    /// Each in the direction of the first. A tab blocks the path back: the wire is cut and threaded again.
    Repeat,
}

/// How the wire leans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// Radians from upright. Positive: what a closed contour encloses is larger at the top; along an
    /// open one the wire leans to the left.
    pub angle: f64,
    /// Height of the part, mm: how far the upper contour lies above the lower one.
    pub height: f64,
    /// What becomes of rounded corners between the lower and the upper contour.
    pub rounding: Rounding,
}

/// One pass, cut without a break.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Index of the opening.
    pub opening: usize,
    /// 0 for the rough pass, then the trim passes.
    pub number: usize,
    /// Whether it is the tab that is cut.
    pub tab: bool,
    /// Whether the wire is threaded at the start of the path before.
    pub thread: bool,
    /// Whether the wire is cut at the end of the path.
    pub cut: bool,
    /// Whether the operator has to hold the part before: it comes free.
    pub stop: bool,
    /// Where the wire goes, lead-in and lead-out and all.
    pub path: Path,
    /// Whether the wire runs on the left of the contour as this pass travels it.
    pub left: bool,
    /// What of [`Settings::passes`] it is.
    pub settings: Cut,
}

/// What is cut, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The passes.
    pub passes: Vec<Pass>,
    /// The inner corners that became round, by opening.
    pub rounded: Vec<(usize, Corner)>,
}

impl Plan {
    /// Time under feed, s.
    pub fn cutting_time(&self) -> f64 {
        self.passes.iter().map(|pass| pass.path.length() / pass.settings.feed * 60.0).sum()
    }

    /// Length of the moves from opening to opening without a wire, mm.
    pub fn travel(&self) -> f64 {
        let ends = self.passes.windows(2);
        let ends = ends.map(|p| p[0].path.lower().end().distance(p[1].path.lower().start()));
        ends.sum()
    }
}

/// Plans the cutting of `openings`: inner ones before those around them, then the shortest route found;
/// of each the rough pass, the trim passes, and last the tab.
///
/// # Errors
/// `passes`, `taper-angle`, `lead` and `tab` for values that cannot be; `open-contour` where a closed one is needed;
/// `tab` as well for one that is no part of its contour; `no-thread` where nobody says where to thread;
/// `cuts-part` where a lead or a pass would cut into a contour; `taper-lead` where the wire cannot come to lean on its lead; those of [`offset`](crate::offset),
/// [`lean`](crate::taper::lean) and [`Path::by_block`].
pub fn plan(openings: &[Opening], settings: &Settings) -> Result<Plan, Box<Diagnostic>> {
    sensible(settings)?;
    let mut rounded = Vec::new();
    let mut rounds = Vec::with_capacity(openings.len());
    for (index, opening) in openings.iter().enumerate() {
        let (round, corners) = Round::new(opening, settings)?;
        rounded.extend(corners.into_iter().map(|corner| (index, corner)));
        rounds.push(round);
    }
    let contours: Vec<&Contour> = openings.iter().map(|opening| &opening.contour).collect();
    let threads: Vec<Vec2> = rounds.iter().map(Round::thread).collect();
    let order = order(&contours, &threads);
    let all: Vec<Element> = contours.iter().flat_map(|c| c.elements()).copied().collect();
    let above: Vec<Element> = rounds.iter().flat_map(Round::last_above).copied().collect();
    let room = Room::new(&all, &above, settings);
    let mut passes = Vec::new();
    for index in order {
        let (Some(round), Some(opening)) = (rounds.get(index), openings.get(index)) else {
            continue;
        };
        let computed = room.passes(round, index, opening)?;
        passes.extend(match settings.by_control {
            true => round.at_contour(opening).passes(index, settings)?,
            false => computed,
        });
    }
    Ok(Plan { passes, rounded })
}

/// Refuses values that cannot be.
fn sensible(settings: &Settings) -> Result<(), Box<Diagnostic>> {
    let refused = |rule, message: String, way_out: &str| -> Box<Diagnostic> {
        Diagnostic::error(rule, message).help(way_out).into()
    };
    let way_out = "offsets from 0 mm on that do not grow, feeds above 0";
    if settings.passes.is_empty() {
        return Err(refused(Rule::Passes, "not one pass".into(), way_out));
    }
    let mut last = f64::INFINITY;
    for Cut { offset, feed } in &settings.passes {
        if !(0.0..=100.0).contains(offset) {
            return Err(refused(Rule::Passes, format!("a wire offset of {offset} mm"), way_out));
        }
        if *offset > last {
            let message = format!("a wire offset of {offset} mm after one of {last} mm");
            return Err(refused(Rule::Passes, message, way_out));
        }
        if !feed.is_finite() || *feed <= 0.0 {
            return Err(refused(Rule::Passes, format!("a feed of {feed} mm/min"), way_out));
        }
        last = *offset;
    }
    if let Some(Taper { angle, height, .. }) = settings.taper
        && (!(-FRAC_PI_3..=FRAC_PI_3).contains(&angle) || !height.is_finite() || height <= 0.0)
    {
        let message = format!("a taper of {}° over {height} mm", angle.to_degrees());
        return Err(refused(Rule::TaperAngle, message, "at most 60°, and a height above 0"));
    }
    let Lead { length, shape } = settings.lead;
    let radius = if let LeadShape::Arc(radius) = shape { radius } else { 0.0 };
    if !(0.0..=FAR).contains(&length) || !(0.0..=FAR).contains(&radius) {
        let message = format!("a lead-in of {length} mm with an arc of {radius} mm");
        return Err(refused(Rule::Lead, message, "lengths from 0 mm on"));
    }
    if !(0.0..=FAR).contains(&settings.tab) {
        return Err(refused(Rule::Tab, format!("a tab of {} mm", settings.tab), "0 mm for none"));
    }
    Ok(())
}

impl Settings {
    /// How far the centre of the wire runs from the contour on the lower face, mm: what is round
    /// across a leaning wire is longer in the plane.
    pub(crate) fn wire_offset(&self, cut: &Cut) -> f64 {
        cut.offset / self.taper.map_or(1.0, |taper| taper.angle.cos())
    }
}
