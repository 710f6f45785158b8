//! The passes round one opening.

use crate::contour::{Contour, ContourPoint};
use crate::lead::{LeadShape, Pairs, reversed};
use crate::offset::{Corner, Corners, offset};
use crate::path::Path;
use crate::plan::{Cut, Opening, Pass, Settings, Side, Trims};
use crate::taper::{Remains, lean};
use geom::{Vec2, turn_angle};
use program::{Diagnostic, Rule};
use sketch::{Element, SAME};

/// From which turn on, radians, a contour has a corner.
const CORNER: f64 = 0.02;

/// An opening with the path of each of its passes.
pub(crate) struct Round {
    /// Where the wire is threaded; `None`: at the start of an open contour.
    thread: Option<Vec2>,
    /// Where the cut starts, on the contour.
    start: ContourPoint,
    /// Whether the wire runs on the left of the contour.
    left: bool,
    /// The path of each pass along the contour, from its start.
    paths: Vec<Path>,
}

impl Round {
    /// The paths of the wire's centre, and the corners that became round.
    pub fn new(
        opening: &Opening,
        settings: &Settings,
    ) -> Result<(Round, Vec<Corner>), Box<Diagnostic>> {
        let contour = &opening.contour;
        let line = contour.elements().first().map_or(0, |element| element.line);
        let closed = contour.is_closed();
        let refused = |rule, message: String, way_out: &str| -> Box<Diagnostic> {
            Diagnostic::error(rule, message).help(way_out).line(line).into()
        };
        if !closed && (matches!(opening.side, Side::Inside | Side::Outside) || settings.tab > 0.0) {
            let (from, to) = (contour.start(), contour.end());
            let message = format!(
                "the contour is open: from X{:.4} Y{:.4} to X{:.4} Y{:.4}",
                from.x, from.y, to.x, to.y
            );
            let way_out = "close it, or cut it without tab with the wire on its left or right";
            return Err(refused(Rule::OpenContour, message, way_out));
        }
        let left = opening.left();
        let start = match opening.start.or(opening.thread) {
            Some(point) if closed => contour.nearest(point),
            None if closed && narrows(contour, left, settings) => middle(contour),
            _ => contour.point_at(0.0),
        };
        let thread = match opening.thread {
            None if closed => {
                if settings.lead.length <= 0.0 {
                    let message = "the thread point is not given".into();
                    let way_out = "give the place to thread by --thread, or the length of the lead-in by --lead";
                    return Err(refused(Rule::NoThread, message, way_out));
                }
                let travel =
                    contour.elements().get(start.element).map(|element| element.tangent(start.t));
                let away = settings.lead.length * if left { 1.0 } else { -1.0 };
                Some(start.point + travel.unwrap_or_default().perp() * away)
            }
            given => given,
        };
        let mut round = Round { thread, start, left, paths: Vec::new() };
        let mut corners = Vec::new();
        for (number, cut) in settings.passes.iter().enumerate() {
            // What a pass leaves in a corner the next may take: only the last has to reach it.
            let last = number + 1 == settings.passes.len();
            let strict = if last { settings.corners } else { Corners::Round };
            let (path, rounded) = round.pass_path(opening, settings, cut, strict)?;
            if settings.tab > 0.0 && settings.tab >= path.lower().length() {
                let message = format!(
                    "a tab of {} mm on a path of {:.4} mm",
                    settings.tab,
                    path.lower().length()
                );
                return Err(refused(Rule::Tab, message, "a tab is shorter than the contour"));
            }
            corners = rounded;
            round.paths.push(path);
        }
        Ok((round, corners))
    }

    /// The path of one pass: offset from the contour, with its taper.
    fn pass_path(
        &self,
        opening: &Opening,
        settings: &Settings,
        cut: &Cut,
        corners: Corners,
    ) -> Result<(Path, Vec<Corner>), Box<Diagnostic>> {
        let distance = settings.wire_offset(cut) * if self.left { 1.0 } else { -1.0 };
        let centre = offset(&opening.contour, distance, corners)?;
        let start = self.start.point + self.out(&opening.contour) * distance.abs();
        let lower = centre.contour.started_at(&centre.contour.nearest(start));
        let Some(taper) = settings.taper else { return Ok((Path::upright(lower), centre.rounded)) };
        // Larger at the top is to the right of what goes round counter-clockwise.
        let out = if opening.contour.area() > 0.0 { -1.0 } else { 1.0 };
        let aside = out * taper.height * taper.angle.tan();
        let remains = Remains { contour: &opening.contour, distance };
        let upper = lean(&lower, aside, taper.rounding, Some(remains))?;
        upper.simple().map_err(|found| {
            let message = format!("no upper contour: {}", found.message);
            Diagnostic::error(Rule::TaperCorner, message).help("lean less").line(found.line)
        })?;
        let path = Path::by_block(lower.elements().to_vec(), upper.elements().to_vec())?;
        Ok((path, centre.rounded))
    }

    /// From the start to the wire: across the contour, and from a corner towards the thread.
    fn out(&self, contour: &Contour) -> Vec2 {
        let travel = contour.elements().get(self.start.element);
        let travel = travel.map_or(Vec2::X, |element| element.tangent(self.start.t));
        let across = if self.left { travel.perp() } else { -travel.perp() };
        let corner = self.start.t == 0.0 || self.start.t == 1.0;
        let thread = self.thread.map(|thread| (thread - self.start.point).normalize_or(across));
        thread.filter(|_| corner).unwrap_or(across)
    }

    /// The same passes along the contour itself, for a control that offsets and tilts the wire.
    pub fn at_contour(&self, opening: &Opening) -> Round {
        let path = Path::upright(opening.contour.started_at(&self.start));
        Round { paths: self.paths.iter().map(|_| path.clone()).collect(), ..*self }
    }

    /// Where the wire is threaded.
    pub fn thread(&self) -> Vec2 {
        let start = || self.paths.first().map(|path| path.lower().start());
        self.thread.or_else(start).unwrap_or_default()
    }

    /// Where the upper end of a leaning wire goes in the last pass.
    pub fn last_above(&self) -> &[Element] {
        let upper = self.paths.last().and_then(Path::upper);
        upper.map_or(&[], Contour::elements)
    }

    /// The leads of a leaning wire on the upper face, each from where it is threaded to the contour.
    pub fn leads_above(&self, settings: &Settings) -> impl Iterator<Item = Vec<Element>> {
        let leaning = self.paths.iter().filter(|path| path.upper().is_some());
        leaning.flat_map(move |path| {
            let into = self.lead_in(settings, path, self.left);
            let out = reversed(&self.lead_out(settings, path, self.left));
            [into, out].map(|pairs| pairs.into_iter().map(|(_, above)| above).collect())
        })
    }

    /// Whether the wire is threaded where the part is on the upper face.
    pub fn threads_in_part(&self) -> bool {
        let Some(last) = self.paths.last().and_then(Path::upper) else { return false };
        let inside = self.left == (last.area() > 0.0);
        last.is_closed() && self.thread.is_some_and(|thread| last.encloses(thread) != inside)
    }

    /// How far from the contour the wire has to be threaded for both of its ends to reach it, mm.
    pub fn reach(&self, settings: &Settings) -> f64 {
        let arc = if let LeadShape::Arc(radius) = settings.lead.shape { radius } else { 0.0 };
        let reach = |path: &Path| {
            let (below, above) =
                (path.lower().start(), path.upper().unwrap_or(path.lower()).start());
            let out = (below - self.start.point).normalize_or_zero();
            below.distance(self.start.point) + (above - below).dot(out).max(0.0) + arc
        };
        self.paths.iter().map(reach).fold(0.0, f64::max)
    }

    /// The passes in their order.
    pub fn passes(&self, index: usize, settings: &Settings) -> Result<Vec<Pass>, Box<Diagnostic>> {
        let leans = self.paths.iter().any(|path| path.upper().is_some());
        let mut passes = Passes { index, settings, leans, made: Vec::new() };
        if settings.tab > 0.0 {
            self.with_tab(&mut passes)?;
        } else {
            self.whole(&mut passes)?;
        }
        if let Some(last) = passes.made.last_mut() {
            last.cut = true;
        }
        Ok(passes.made)
    }

    /// Each pass along the whole contour.
    fn whole(&self, passes: &mut Passes) -> Result<(), Box<Diagnostic>> {
        let repeat = passes.settings.trims == Trims::Repeat;
        for (number, path) in self.paths.iter().enumerate() {
            let back = !repeat && number % 2 == 1;
            let reversed = path.reversed();
            let (path, left) = if back { (&reversed, !self.left) } else { (path, self.left) };
            let closed = path.lower().is_closed();
            let mut pairs = Pairs::new();
            // An open contour has its lead at its start only.
            if closed || !back {
                pairs.extend(self.lead_in(passes.settings, path, left));
            }
            pairs.extend(path.elements().map(|(below, above)| (*below, *above)));
            if closed || back {
                pairs.extend(self.lead_out(passes.settings, path, left));
            }
            let thread = number == 0 || (repeat && !closed);
            passes.add(PassDraft { number, tab: false, left, thread, pairs })?;
        }
        Ok(())
    }

    /// Each pass up to the tab, and then each pass through the tab.
    fn with_tab(&self, passes: &mut Passes) -> Result<(), Box<Diagnostic>> {
        let settings = passes.settings;
        let repeat = settings.trims == Trims::Repeat;
        let tab = |path: &Path| path.lower().point_at(path.lower().length() - settings.tab);
        let end = |path: &Path| path.lower().point_at(f64::INFINITY);
        let mut at_tab = false;
        for (number, path) in self.paths.iter().enumerate() {
            let mut pairs = self.lead_in(settings, path, self.left);
            pairs.extend(path.between(&path.lower().point_at(0.0), &tab(path)));
            let back = at_tab && !repeat;
            let pairs = if back { reversed(&pairs) } else { pairs };
            let (left, thread) = (self.left != back, number == 0 || repeat);
            passes.add(PassDraft { number, tab: false, left, thread, pairs })?;
            at_tab = !back;
        }
        for (number, path) in self.paths.iter().enumerate() {
            let mut pairs = path.between(&tab(path), &end(path));
            pairs.extend(self.lead_out(settings, path, self.left));
            let pairs = if at_tab { pairs } else { reversed(&pairs) };
            let left = self.left == at_tab;
            passes.add(PassDraft { number, tab: true, left, thread: false, pairs })?;
            at_tab = !at_tab;
        }
        Ok(())
    }

    fn lead_in(&self, settings: &Settings, path: &Path, left: bool) -> Pairs {
        self.thread.map_or_else(Pairs::new, |thread| settings.lead.shape.into(thread, path, left))
    }

    fn lead_out(&self, settings: &Settings, path: &Path, left: bool) -> Pairs {
        self.thread.map_or_else(Pairs::new, |thread| settings.lead.shape.out(thread, path, left))
    }
}

/// Whether a closed contour starts in an inner corner of the wire's side: what stands across its first
/// element there comes near the last, or one of both is a fillet that the wire of the first pass does not fit into.
fn narrows(contour: &Contour, left: bool, settings: &Settings) -> bool {
    let elements = contour.elements();
    let (Some(first), Some(last)) = (elements.first(), elements.last()) else { return false };
    let side = if left { 1.0 } else { -1.0 };
    let turn = turn_angle(last.tangent(1.0), first.tangent(0.0));
    let widest = settings.passes.first().map_or(0.0, |cut| settings.wire_offset(cut));
    let fillet = |element: &Element| {
        let inner = element.turn.is_some_and(|turn| turn.sweep * side > 0.0);
        inner && element.radius().is_some_and(|radius| radius < widest)
    };
    turn * side > CORNER || fillet(first) || fillet(last)
}

/// The middle of the longest element.
pub(crate) fn middle(contour: &Contour) -> ContourPoint {
    let (mut along, mut longest, mut place) = (0.0, 0.0, 0.0);
    for length in contour.elements().iter().map(|element| element.length()) {
        if length > longest {
            (longest, place) = (length, along + length / 2.0);
        }
        along += length;
    }
    contour.point_at(place)
}

/// A pass before its path is checked.
struct PassDraft {
    number: usize,
    tab: bool,
    left: bool,
    thread: bool,
    pairs: Pairs,
}

/// The passes so far.
struct Passes<'a> {
    index: usize,
    settings: &'a Settings,
    leans: bool,
    made: Vec<Pass>,
}

impl Passes<'_> {
    /// Adds a pass. Where the wire stays threaded, a straight line leads from its position to the start of the pass.
    fn add(&mut self, draft: PassDraft) -> Result<(), Box<Diagnostic>> {
        let PassDraft { number, tab, left, thread, mut pairs } = draft;
        if let (Some(before), Some(&(below, above))) = (self.made.last_mut(), pairs.first()) {
            if thread {
                before.cut = true;
            } else {
                let upper = before.path.upper().unwrap_or(before.path.lower());
                let from = (before.path.lower().end(), upper.end());
                let joint = (
                    Element::line(from.0, below.start).from_line(below.line),
                    Element::line(from.1, above.start).from_line(above.line),
                );
                pairs.insert(0, joint);
            }
        }
        let (lower, upper) = pairs.into_iter().unzip();
        let path = match self.leans {
            true => Path::by_block(lower, upper).map_err(short)?,
            false => Path::upright(Contour::new(lower, 10.0 * SAME)?),
        };
        let Some(settings) = self.settings.passes.get(number).copied() else { return Ok(()) };
        let (opening, stop) = (self.index, tab && number == 0);
        self.made.push(Pass {
            opening,
            number,
            tab,
            thread,
            cut: false,
            stop,
            path,
            left,
            settings,
        });
        Ok(())
    }
}

/// Along the contour the ends of the wire do not cross: where they do, a lead is shorter than the wire leans.
fn short(found: Box<Diagnostic>) -> Box<Diagnostic> {
    if found.rule != Rule::WiresCross {
        return found;
    }
    let message = format!("the lead is shorter than the wire leans: {}", found.message);
    let help = "thread the wire farther from the contour";
    Diagnostic::error(Rule::TaperLead, message).help(help).line(found.line).into()
}
