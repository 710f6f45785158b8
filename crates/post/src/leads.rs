//! Whether the tool cuts into a contour on its way to it or off it, or in a neck of it.
//!
//! Where compensation is switched on, the tool's centre is where the source says; the way from there to the parallel of the first element
//! is the source's own choice, and so is the way off. A control follows both whatever they go through. Here a way of the centre over its
//! own contour, at its depth, is refused: the tool cuts a slot through what it has just cut, or is about to. Where it only comes nearer
//! than the radius, or goes over another contour of the program (which may be a pass that another one follows), that is a warning.

use crate::center::{Move, neck};
use geom::{Element, Turn, Vec2, Vec3, angle_between};
use program::{ArcTo, CompensatedPath, Compensation, Diagnostic, Op, Pose, Program, Rule};

/// A move shorter than this goes nowhere in the plane, mm.
const NOWHERE: f64 = 1e-6;

/// So much nearer to an element than the radius is rounding of the source's points, mm.
const NEAR: f64 = 2e-3;

/// How far the radii at the ends of an arc of the source may differ, as a part of them.
const RADII: f64 = 0.01;

/// At so many points a way is compared with an element near it.
const SAMPLES: u32 = 32;

/// The most pairs of ways and elements of other contours that are compared.
const MOST_PAIRS: usize = 30_000_000;

/// A way to a contour or off it, from its outer end to the contour.
struct Lead {
    line: u32,
    /// What the tool's centre does.
    way: Element,
    /// What the source says.
    said: Element,
    /// Height at its lower end.
    low: f64,
    is_exit: bool,
}

/// From where compensation is switched on to where it is off.
struct Stretch {
    /// How far the centre is on the left of the contour, mm.
    left: f64,
    axis: Vec3,
    /// Line, from, to, of the first move in the plane.
    entry: Option<(u32, [Vec3; 2])>,
    moves: Vec<Move>,
    exit: Option<(u32, [Vec3; 2])>,
    leaves: bool,
}

/// Errors and warnings about the ways to contours and off them, and about necks of contours. `offsets` is the smallest step of the words, mm,
/// where the control works out the path of the centre: how it goes from the way to the first element is then the control's.
pub(crate) fn check(program: &Program, offsets: Option<f64>) -> Vec<Diagnostic> {
    if program.compensated_path != Some(CompensatedPath::Contour) {
        return Vec::new();
    }
    let stretches = stretches(program);
    let mut found = Vec::new();
    let mut pairs = 0;
    let mut others = Others::of(&stretches);
    for (number, stretch) in stretches.iter().enumerate() {
        // Where the writer offsets, it finds them itself.
        let necks = offsets.and_then(|step| neck(&stretch.moves, stretch.left, stretch.axis, step));
        found.extend(necks);
        for lead in stretch.leads() {
            match stretch.own(&lead, offsets.is_some()) {
                Some(finding) => found.push(finding),
                None => found.extend(others.crossed(number, stretch, &lead, &mut pairs)),
            }
        }
    }
    found
}

#[expect(clippy::wildcard_enum_match_arm, reason = "one record switches")]
fn stretches(program: &Program) -> Vec<Stretch> {
    let mut done = Vec::new();
    let mut open: Option<Stretch> = None;
    let (mut here, mut radius): (Option<Pose>, Option<f64>) = (None, None);
    for record in program.each() {
        if let Op::Tool(tool) = &record.op {
            radius = tool.cutting_radius();
        }
        let side = match &record.op {
            Op::Compensation(Compensation::Left(_)) => Some(1.0),
            Op::Compensation(Compensation::Right(_)) => Some(-1.0),
            _ => None,
        };
        match (side, &mut open) {
            (None, Some(stretch)) if record.op == Op::Compensation(Compensation::Off) => {
                stretch.leaves = true;
            }
            (Some(side), None) => {
                open = here.zip(radius).map(|(here, radius)| Stretch {
                    left: side * radius,
                    axis: here.axis(),
                    entry: None,
                    moves: Vec::new(),
                    exit: None,
                    leaves: false,
                });
            }
            (None | Some(_), _) => {}
        }
        let goes_on = match (&mut open, here) {
            (Some(stretch), Some(here)) => stretch.record(record.line, &here, &record.op),
            _ => true,
        };
        let loses_position = record.op.loses_position();
        if !goes_on || loses_position {
            done.extend(open.take());
        }
        here = record.op.pose().copied().or(here.filter(|_| !loses_position));
    }
    done.extend(open);
    done
}

impl Stretch {
    /// A record from `here`; whether the contour goes on behind it: in another plane, and by a rapid, it does not.
    #[expect(clippy::wildcard_enum_match_arm, reason = "what is not named is none of a contour")]
    fn record(&mut self, line: u32, here: &Pose, op: &Op) -> bool {
        let Some(end) = op.pose() else { return true };
        let ends = [here.point(), end.point()];
        let [from, to] = ends.map(|point| self.plane(point));
        let is_line = matches!(op, Op::Line(_));
        if is_line && from.distance(to) <= NOWHERE {
            return true;
        }
        if is_line && self.leaves {
            self.exit = Some((line, ends));
            return false;
        }
        if is_line && self.entry.is_none() {
            self.entry = Some((line, ends));
            return true;
        }
        let element = match op {
            _ if self.entry.is_none() || self.leaves => None,
            Op::Line(_) => Some(Element::line(from, to)),
            Op::Arc(to) => self.arc(here, to),
            _ => None,
        };
        let Some(element) = element else { return false };
        let heights = ends.map(|point| point.dot(self.axis));
        self.moves.push(Move { line, element, heights });
        true
    }

    fn arc(&self, here: &Pose, to: &ArcTo) -> Option<Element> {
        let radius = here.point().distance(to.circle.center());
        let arc = to.circle.arc(here.point(), to.end.point(), radius * RADII).ok()?;
        let facing = arc.normal.dot(self.axis);
        let turn = Turn { center: self.plane(arc.center), sweep: arc.sweep * facing.signum() };
        let [start, end] = [here, &to.end].map(|pose| self.plane(pose.point()));
        (facing.abs() > 1.0 - geom::ANGLE_EPSILON).then_some(Element {
            start,
            end,
            turn: Some(turn),
        })
    }

    fn plane(&self, point: Vec3) -> Vec2 {
        let x = self.axis.any_orthonormal_vector();
        Vec2::new(point.dot(x), point.dot(self.axis.cross(x)))
    }

    /// The ways to the contour and off it, both from outside.
    fn leads(&self) -> impl Iterator<Item = Lead> + use<> {
        let ends = self.moves.first().zip(self.moves.last());
        let way = |(line, [from, to]): (u32, [Vec3; 2]), at: Vec2, touched: Vec2, is_exit: bool| {
            let outer = self.plane(if is_exit { to } else { from });
            let low = from.dot(self.axis).min(to.dot(self.axis));
            let way = Element::line(outer, at);
            Lead { line, way, said: Element::line(outer, touched), low, is_exit }
        };
        let leads = ends.map(|(first, last)| {
            let [start, end] = [first, last].map(|own| own.element.parallel(self.left));
            let entry = self.entry.zip(start);
            let exit = self.exit.zip(end);
            [
                entry.map(|(entry, own)| way(entry, own.start, first.element.start, false)),
                exit.map(|(exit, own)| way(exit, own.end, last.element.end, true)),
            ]
        });
        leads.into_iter().flatten().flatten()
    }

    /// What is wrong with a way on its own contour.
    fn own(&self, lead: &Lead, offsets: bool) -> Option<Diagnostic> {
        let radius = self.left.abs();
        let neighbour = if lead.is_exit { self.moves.len() - 1 } else { 0 };
        let mut bites: Option<(f64, u32)> = None;
        for (k, other) in self.moves.iter().enumerate() {
            let is_above = lead.low > other.high() + NEAR;
            // A control that offsets finds its own way to the first element, and off the last.
            let is_free = is_above || k == neighbour && offsets;
            if is_free || lead.way.distance(&other.element, NEAR) >= radius - NEAR {
                continue;
            }
            if lead.crossings(other, self.left).any(|at| !self.is_cut_away(k, at)) {
                return Some(lead.gouge(other.line));
            }
            let (least, near) = match k == neighbour {
                true => (other.element.away(lead.way.start), self.beside(lead, k)),
                false => {
                    let said = lead.said.distance(&other.element, NEAR);
                    (other.element.away(lead.way.start).min(said), self.facing(lead, k))
                }
            };
            if near < least.min(radius) - NEAR {
                return Some(lead.gouge(other.line));
            }
            if near < radius - NEAR && bites.is_none_or(|(deepest, _)| near < deepest) {
                bites = Some((near, other.line));
            }
        }
        bites.map(|(near, line)| {
            let message = format!(
                "{} comes within {} mm of its element of line {line}: the tool, of radius {radius} mm, cuts into that",
                lead.what(),
                shown(near)
            );
            Diagnostic::warning(Rule::CompensationGouge, message).help(lead.help()).line(lead.line)
        })
    }

    /// How near a way comes to the element that it leads to, but for the end of that which it touches, mm.
    fn beside(&self, lead: &Lead, k: usize) -> f64 {
        let element = &self.moves[k].element;
        let is_touched = |t: f64| if lead.is_exit { t >= 1.0 } else { t <= 0.0 };
        let near = samples(&lead.way).map(|point| element.nearest(point));
        near.filter(|(t, _)| !is_touched(*t)).map(|(_, near)| near).fold(f64::INFINITY, f64::min)
    }

    /// How near a way comes to an element on whose side of the tool the contour is where the way leads to, mm.
    fn facing(&self, lead: &Lead, k: usize) -> f64 {
        let element = &self.moves[k].element;
        let closest = lead.way.closest(element).0;
        let near = samples(&lead.way).chain([closest]).filter_map(|point| {
            let (t, near) = element.nearest(point);
            let place = element.at(t);
            let inward = element.tangent(t).perp() * self.left.signum();
            let faces = inward.dot(lead.said.end - place) > -NEAR;
            (near < self.left.abs() && faces && !self.is_cut_away(k, place)).then_some(near)
        });
        near.fold(f64::INFINITY, f64::min)
    }

    /// Whether a place of element `k` lies on the tool's side of another that crosses it: what runs on there past the crossing bounds nothing.
    fn is_cut_away(&self, k: usize, at: Vec2) -> bool {
        let own = &self.moves[k].element;
        let is_end = |element: &Element, point: Vec2| {
            point.distance(element.start).min(point.distance(element.end)) <= NEAR
        };
        self.moves.iter().any(|other| {
            let other = &other.element;
            let t = other.nearest(at).0;
            let aside = other.tangent(t).perp_dot(at - other.at(t)) * self.left.signum();
            aside > NEAR && own.meets(other, NEAR).any(|at| !(is_end(own, at) && is_end(other, at)))
        })
    }
}

impl Lead {
    /// Where the centre goes over an element; on the way off not from where the material is, since a pass before may have been there.
    fn crossings(&self, other: &Move, left: f64) -> impl Iterator<Item = Vec2> {
        let element = &other.element;
        let meets = self.way.meets(element, NEAR);
        meets.filter(move |at| !self.is_exit || self.enters(element, *at, left))
    }

    /// Whether the centre goes, at a place of an element, to that side of it on which the material is.
    fn enters(&self, element: &Element, at: Vec2, left: f64) -> bool {
        let way = self.way.tangent(0.0) * if self.is_exit { -1.0 } else { 1.0 };
        let out = element.tangent(element.nearest(at).0).perp() * left.signum();
        way.dot(out) < 0.0
    }

    fn what(&self) -> &'static str {
        match self.is_exit {
            false => "the way to the contour",
            true => "the way off the contour",
        }
    }

    fn help(&self) -> &'static str {
        match self.is_exit {
            false => {
                "begin on the tool's side of the contour, farther from it than the tool's radius"
            }
            true => "end on the tool's side of the contour, farther from it than the tool's radius",
        }
    }

    fn gouge(&self, line: u32) -> Diagnostic {
        let message = format!(
            "{} with cutter compensation goes through the contour itself: its element of line {line}",
            self.what()
        );
        Diagnostic::error(Rule::CompensationGouge, message).help(self.help()).line(self.line)
    }
}

/// The elements of all contours, by where they begin along X.
struct Others<'a> {
    stretches: &'a [Stretch],
    /// Number of the stretch, and of the element; from where to where it is along X.
    elements: Vec<(usize, usize, [f64; 2])>,
    widest: f64,
}

impl<'a> Others<'a> {
    fn of(stretches: &'a [Stretch]) -> Others<'a> {
        let elements = stretches.iter().enumerate().flat_map(|(number, stretch)| {
            stretch.moves.iter().enumerate().map(move |(k, own)| {
                let (low, high) = own.element.extents();
                (number, k, [low.x, high.x])
            })
        });
        let mut elements: Vec<_> = elements.collect();
        elements.sort_by(|a, b| a.2[0].total_cmp(&b.2[0]));
        let widest = elements.iter().map(|(.., [low, high])| high - low).fold(0.0, f64::max);
        Others { stretches, elements, widest }
    }

    /// A warning where a way goes over an element of another contour.
    fn crossed(
        &mut self,
        number: usize,
        stretch: &Stretch,
        lead: &Lead,
        pairs: &mut usize,
    ) -> Option<Diagnostic> {
        let (low, high) = lead.way.extents();
        let from = self.elements.partition_point(|(.., [x, _])| *x < low.x - self.widest);
        let near = self.elements[from..].iter().take_while(|(.., [x, _])| *x <= high.x);
        for (of, k, _) in near {
            *pairs += 1;
            if *pairs > MOST_PAIRS {
                return None;
            }
            let other = &self.stretches[*of];
            let own = &other.moves[*k];
            let is_apart = *of == number
                || lead.low > own.high() + NEAR
                || angle_between(other.axis, stretch.axis) > geom::ANGLE_EPSILON;
            if !is_apart && lead.crossings(own, other.left).next().is_some() {
                let message = format!(
                    "{} with cutter compensation goes over another contour: its element of line {}",
                    lead.what(),
                    own.line
                );
                let help = "look whether the material is to stay there";
                let found = Diagnostic::warning(Rule::CompensationGouge, message).help(help);
                return Some(found.line(lead.line));
            }
        }
        None
    }
}

/// Places of a way, both ends among them.
fn samples(way: &Element) -> impl Iterator<Item = Vec2> + '_ {
    (0..=SAMPLES).map(|i| way.at(f64::from(i) / f64::from(SAMPLES)))
}

/// A length as a message shows it, mm.
fn shown(length: f64) -> f64 {
    (length * 1e3).round() / 1e3
}
