//! The path of the centre along one contour, from switching on to switching off.

use super::faults::{error, inverse_time, on_arc};
use super::leaving::{self, Leaving};
use super::plane::{Plane, SAME};
use super::rules::{Entry, Outer, Rules};
use crate::Sink;
use crate::event::{Action, ArcTo, Event, Orientation, Position};
use crate::kernel::Outcome;
use geom::{Arc, Element, Turn, Vec2, Vec3, turn_angle};
use program::{Diagnostic, Feed, Rule};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Most events between two elements of the contour.
const LOOK_AHEAD: usize = 10_000;

/// By how much an arc may turn farther for where the element before it has ended, radians (`rs274`).
const LONGER: f64 = 0.025;

/// Farther than any tool radius can shorten a move, mm.
const FAR: f64 = 1e6;

/// A contour in the making.
pub(super) struct Path {
    rules: Rules,
    plane: Plane,
    /// How far the centre is on the left of the contour, mm; on its right where negative.
    left: f64,
    /// Where the program, which knows of no radius, has brought the tool.
    at: Position,
    stage: Stage,
    /// What happens between the element that is held back and the next one.
    waiting: Vec<Event>,
}

/// How far the contour has come.
enum Stage {
    /// Nothing has moved in the plane.
    On,
    /// The move that switches compensation on, held back: its end depends on the next element.
    Entering(Piece),
    /// An element, held back: its end depends on the next one.
    Following(Piece),
}

/// An element of the contour on its way out.
#[derive(Clone, Copy)]
struct Piece {
    line: u32,
    rapid: bool,
    /// It is the move that switches compensation on: no contour belongs to it.
    begins: bool,
    contour: Element,
    /// Its parallel, of which the part `from..to` (0 to 1) remains ...
    parallel: Element,
    from: f64,
    to: f64,
    /// ... with this as its end.
    end: Vec2,
    /// Heights above the plane, mm: start, end, and centre of an arc.
    heights: [f64; 3],
}

/// A move of the centre.
struct CentreMove {
    line: u32,
    rapid: bool,
    end: Vec2,
    height: f64,
    /// What makes it an arc: the turn that remains, and the height of its centre.
    turn: Option<(Turn, f64)>,
}

impl Path {
    /// Compensation by `left` mm across `normal` for a tool that stands at `at`.
    pub(super) fn new(rules: Rules, normal: Vec3, left: f64, at: Position) -> Path {
        let plane = Plane::new(normal);
        Path { rules, plane, left, at, stage: Stage::On, waiting: Vec::new() }
    }

    /// Where the program has brought the tool.
    pub(super) fn programmed(&self) -> Position {
        self.at
    }

    /// Takes an event while compensation is on.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "what moves the tool is found by `Action::position`, which names each"
    )]
    pub(super) fn take(&mut self, event: Event, sink: &mut Sink) -> Outcome {
        let line = event.line;
        match &event.action {
            Action::Rapid(pose) | Action::Line(pose) => {
                let ((from, start), (to, end)) = self.arrive(line, pose)?;
                if from.distance(to) < SAME {
                    if matches!(self.stage, Stage::On) && self.rules.entry == Entry::OfItself {
                        return Err(self.too_short(line, 0.0));
                    }
                    return self.pass(event, sink);
                }
                let rapid = matches!(event.action, Action::Rapid(_));
                let piece = self.piece(line, Element::line(from, to), [start, end, end])?;
                self.element(Piece { rapid, ..piece }, sink)
            }
            Action::Arc(arc) => {
                let sweep = self.sweep(line, arc)?;
                let ((from, start), (to, end)) = self.arrive(line, &arc.end)?;
                let (center, height) = self.plane.flat(arc.center);
                let contour = Element::arc(from, to, center, sweep);
                let piece = self.piece(line, contour, [start, end, height])?;
                self.element(piece, sink)
            }
            Action::Feed(Feed::InverseTime(_)) => Err(inverse_time(line)),
            Action::Home(_)
            | Action::MachineMove(_)
            | Action::WorkOffset(_)
            | Action::WorkOffsetData(_)
            | Action::Tool(_)
            | Action::Cycle(_) => {
                let message = "a tool change, a cycle, another frame or a move to a fixed position \
                               while compensation is on";
                Err(error(Rule::CompensationOn, line, message)
                    .help("switch it off (G40, R0) with a straight move first")
                    .into())
            }
            action if action.position().is_some() || matches!(action, Action::Probe(_)) => {
                let message = "only straight moves and arcs lead the tool while compensation is on";
                Err(error(Rule::CompensationOn, line, message).into())
            }
            _ => self.pass(event, sink),
        }
    }

    /// Ends the contour: the tool then stands across the end of its last element.
    pub(super) fn finish(&mut self, sink: &mut Sink) -> Outcome<Option<Leaving>> {
        match std::mem::replace(&mut self.stage, Stage::On) {
            Stage::On => Ok(None),
            Stage::Entering(Piece { line, .. }) => {
                let message = "compensation ends before a contour has begun: where this move ends \
                               depends on the next element";
                Err(error(Rule::CompensationEntry, line, message).into())
            }
            Stage::Following(piece) => {
                self.send(piece.way(), sink)?;
                self.send_waiting(piece.end, sink)?;
                let Piece { contour, parallel, .. } = piece;
                let guarded = self.rules.guarded;
                Ok(Some(Leaving { plane: self.plane, guarded, contour, parallel }))
            }
        }
    }

    /// The program goes to `pose`: place in the plane and height before, and there.
    fn arrive(&mut self, line: u32, pose: &Position) -> Outcome<((Vec2, f64), (Vec2, f64))> {
        if pose.point.is_nan() || self.at.point.is_nan() {
            let message = "compensation, and where the tool stands is not known";
            return Err(error(Rule::CompensationUnknownPosition, line, message)
                .help("move X, Y and Z to a known position before it is switched on")
                .into());
        }
        if matches!(self.stage, Stage::On) {
            self.at.orientation = pose.orientation;
        }
        if !same(&self.at.orientation, &pose.orientation) {
            let message = "the tool is turned while compensation is on";
            return Err(error(Rule::CompensationOrientation, line, message)
                .help("switch compensation off before a rotary axis moves")
                .into());
        }
        let from = std::mem::replace(&mut self.at.point, pose.point);
        Ok((self.plane.flat(from), self.plane.flat(pose.point)))
    }

    /// The angle through which an arc turns in the plane, positive counter-clockwise.
    fn sweep(&self, line: u32, arc: &ArcTo) -> Outcome<f64> {
        let side = arc.normal.dot(self.plane.normal);
        if side.abs() < 1.0 - 1e-9 {
            let message = "an arc out of the plane of compensation";
            return Err(error(Rule::CompensationPlane, line, message).into());
        }
        // How far the radii may differ is the control's affair, and it has looked.
        let (start, end) = (self.at.point, arc.end.point);
        match Arc::new(start, end, arc.center, arc.normal, arc.turns, f64::INFINITY) {
            Ok(arc) => Ok(arc.sweep * side.signum()),
            Err(_) => {
                let message = "an arc without a radius, or from where the tool is not known to be";
                Err(error(Rule::CompensationArc, line, message).into())
            }
        }
    }

    /// The parallel of an element of the contour, whole.
    fn piece(&self, line: u32, contour: Element, heights: [f64; 3]) -> Outcome<Piece> {
        let Some(parallel) = contour.parallel(self.left) else {
            let radius = contour.turn.map_or(0.0, |turn| contour.start.distance(turn.center));
            let message = format!(
                "the tool's radius of {:.4} mm does not fit into an arc of radius {radius:.4} mm",
                self.left.abs()
            );
            return Err(error(Rule::CompensationArcRadius, line, message)
                .help("take a smaller tool")
                .into());
        };
        let end = parallel.end;
        let (rapid, begins, from, to) = (false, false, 0.0, 1.0);
        Ok(Piece { line, rapid, begins, contour, parallel, from, to, end, heights })
    }

    /// The next element of the contour, which ends the one held back.
    fn element(&mut self, mut piece: Piece, sink: &mut Sink) -> Outcome {
        match std::mem::replace(&mut self.stage, Stage::On) {
            Stage::On => {
                self.stage = self.enter(piece)?;
                return Ok(());
            }
            Stage::Entering(entry) => {
                let Piece { contour, parallel, .. } = &piece;
                if self.rules.guarded && leaving::cuts(entry.contour.start, contour, parallel) {
                    let message = "the way to the contour cuts into it";
                    return Err(error(Rule::CompensationGouge, entry.line, message)
                        .help("begin on the tool's side of the contour, or behind its start")
                        .into());
                }
                let way = CentreMove { end: piece.parallel.start, ..entry.way() };
                let end = way.end;
                self.send(way, sink)?;
                self.send_waiting(end, sink)?;
            }
            Stage::Following(last) => self.corner(last, &mut piece, sink)?,
        }
        self.stage = Stage::Following(piece);
        Ok(())
    }

    /// The first move in the plane.
    fn enter(&self, piece: Piece) -> Outcome<Stage> {
        if piece.contour.turn.is_some() {
            if self.rules.entry == Entry::OfItself {
                return self.enter_on_arc(piece);
            }
            return Err(on_arc(piece.line));
        }
        if self.rules.entry == Entry::OfNext {
            return Ok(Stage::Entering(piece));
        }
        let length = piece.contour.length();
        if length <= self.left.abs() {
            return Err(self.too_short(piece.line, length));
        }
        // An inner corner may cut off all of it.
        let end = piece.parallel.end;
        let start = end - piece.parallel.tangent(1.0) * FAR;
        let parallel = Element::line(start, end);
        Ok(Stage::Following(Piece { begins: true, parallel, ..piece }))
    }

    /// The arc from where the tool stands that ends next to the end of the programmed one and in its direction.
    fn enter_on_arc(&self, piece: Piece) -> Outcome<Stage> {
        let Piece { contour, parallel, .. } = piece;
        let (start, end) = (contour.start, parallel.end);
        let sweep = contour.turn.map_or(0.0, |turn| turn.sweep);
        // Its centre lies on the line across the end, as far from there as from the start.
        let inward = contour.tangent(1.0).perp() * sweep.signum();
        let (chord, along) = (start.distance_squared(end), (start - end).dot(inward));
        let radius = chord / (2.0 * along);
        if !(along > 0.0 && radius > self.left.abs()) {
            let message = format!(
                "the arc that switches compensation on must be larger than the tool's radius of \
                 {:.4} mm",
                self.left.abs()
            );
            return Err(error(Rule::CompensationEntry, piece.line, message).into());
        }
        let center = end + inward * radius;
        let once = turn_angle((start - center) / radius, (end - center) / radius);
        let turns = ((sweep.abs() / TAU - 1e-9).ceil() - 1.0).max(0.0);
        let sweep = ((once * sweep.signum()).rem_euclid(TAU) + turns * TAU) * sweep.signum();
        let parallel = Element::arc(start, end, center, sweep);
        Ok(Stage::Following(Piece { begins: true, parallel, ..piece }))
    }

    /// The move of `length` mm that switches compensation on is too short.
    fn too_short(&self, line: u32, length: f64) -> Box<Diagnostic> {
        let message = format!(
            "the move that switches compensation on is {length:.4} mm long in the plane: it must be \
             longer than the tool's radius of {:.4} mm",
            self.left.abs()
        );
        error(Rule::CompensationEntry, line, message).into()
    }

    /// Brings `last` to its end and the tool around the corner to the start of `next`.
    fn corner(&mut self, mut last: Piece, next: &mut Piece, sink: &mut Sink) -> Outcome {
        let arriving = last.contour.tangent(1.0);
        let turn = turn_angle(arriving, next.contour.tangent(0.0));
        let inner = if PI - turn.abs() > self.rules.smooth {
            turn * self.left > 0.0
        } else {
            self.inner_on_way_back(&last, next)?
        };
        let mut around = Vec::new();
        if turn.abs() <= self.rules.smooth {
            self.join(&last, next)?;
        } else {
            self.sees(next.line)?;
            if inner {
                self.shorten(&mut last, next)?;
            } else if last.end.distance(next.parallel.start) > SAME {
                around = self.around(&mut last, next, turn.abs())?;
            }
        }
        self.send(last.way(), sink)?;
        self.send_waiting(last.end, sink)?;
        around.into_iter().try_for_each(|way| self.send(way, sink))
    }

    /// The next element begins where the last one ends, a little before or behind its own start.
    fn join(&self, last: &Piece, next: &mut Piece) -> Outcome {
        let Element { start, turn, .. } = next.parallel;
        let longer = match turn {
            None => {
                let ahead = (last.end - start).dot(next.parallel.tangent(0.0));
                next.from = ahead / next.parallel.length();
                0.0
            }
            Some(Turn { center, sweep }) => {
                let (from, to) = (start - center, last.end - center);
                next.from = turn_angle(from.normalize_or_zero(), to.normalize_or_zero()) / sweep;
                -next.from * sweep.abs()
            }
        };
        match next.from < 1.0 && longer <= LONGER {
            true => Ok(()),
            false => Err(self.no_reach(last, next)),
        }
    }

    /// Whether the tool lies between two elements of which the second goes back where the first came
    /// from. Between lines it never does.
    ///
    /// # Errors
    /// Two arcs that turn different ways, of which the second is the flatter: LinuxCNC looks at the
    /// second alone and takes the wrong side (`rs274`).
    fn inner_on_way_back(&self, last: &Piece, next: &Piece) -> Outcome<bool> {
        let (first, second) = (last.contour.curvature(), next.contour.curvature());
        if second * (first + second) < 0.0 {
            return Err(self.no_reach(last, next));
        }
        Ok((first + second) * self.left < 0.0)
    }

    /// At an inner corner both elements end where their parallels cross.
    fn shorten(&self, last: &mut Piece, next: &mut Piece) -> Outcome {
        let crossings = last.parallel.crossings(&next.parallel);
        let mut crossings: Vec<_> = crossings.filter(|c| c.on_first > last.from).collect();
        crossings.sort_by(|a, b| a.cut.total_cmp(&b.cut));
        match crossings.as_slice() {
            // Two elements that cross twice come together again after the corner.
            [crossing, others @ ..] if others.is_empty() || last.begins => {
                (last.to, last.end) = (crossing.on_first, crossing.point);
                next.from = crossing.on_next;
                Ok(())
            }
            _ => Err(self.no_reach(last, next)),
        }
    }

    fn no_reach(&self, last: &Piece, next: &Piece) -> Box<Diagnostic> {
        let message = format!(
            "a tool of radius {:.4} mm does not reach the inner corner between line {} and line {} \
             without cutting into the contour",
            self.left.abs(),
            last.line,
            next.line
        );
        error(Rule::CompensationInnerCorner, next.line, message)
            .help("take a smaller tool, or leave out what is shorter than it")
            .into()
    }

    /// The moves around an outer corner at which the way turns by `turn`.
    fn around(&self, last: &mut Piece, next: &Piece, turn: f64) -> Outcome<Vec<CentreMove>> {
        let Piece { line, rapid, heights: [height, ..], .. } = *next;
        let corner = next.contour.start;
        let start = next.parallel.start;
        let straight = |end| CentreMove { line, rapid, end, height, turn: None };
        let lines = last.contour.turn.is_none() && next.contour.turn.is_none();
        let mut points = match self.rules.outer {
            Outer::Intersection if turn <= Outer::SHARPEST && !lines => {
                let message = "an outer corner of an arc that is left by the intersection (G451)";
                return Err(error(Rule::CompensationUnsupported, line, message)
                    .help("write G450: the tool then goes around the corner")
                    .into());
            }
            Outer::Polygon if turn > FRAC_PI_2 => {
                let on = last.contour.tangent(1.0) * self.left.abs();
                let back = next.contour.tangent(0.0) * self.left.abs();
                vec![last.end + on, start - back]
            }
            Outer::Polygon | Outer::Intersection if turn <= Outer::SHARPEST => {
                vec![corner + (last.end + start - 2.0 * corner) / (1.0 + turn.cos())]
            }
            _ if rapid && !self.rules.rounds_rapids => return Ok(vec![straight(start)]),
            Outer::Arc | Outer::Polygon | Outer::Intersection | Outer::Peak => {
                let turn = Turn { center: corner, sweep: -turn * self.left.signum() };
                return Ok(vec![CentreMove { turn: Some((turn, height)), ..straight(start) }]);
            }
        };
        // A line is longer by that; an arc ends, and begins, where it would.
        if last.contour.turn.is_none() {
            last.end = points.remove(0);
        }
        if next.contour.turn.is_some() {
            points.push(start);
        }
        Ok(points.into_iter().map(straight).collect())
    }

    /// # Errors
    /// The control does not see as far as the element in `line`.
    fn sees(&self, line: u32) -> Outcome {
        let silent = |action: &Action| matches!(action, Action::Comment(_));
        let mut blocks = 0;
        let mut last = line;
        for event in self.waiting.iter().filter(|event| !silent(&event.action)) {
            blocks += usize::from(event.line != last);
            last = event.line;
        }
        if blocks <= self.rules.blind {
            return Ok(());
        }
        let message = format!(
            "{blocks} blocks without a move in the plane before this one: the control sees past {} \
             and would cut the corner",
            self.rules.blind
        );
        Err(error(Rule::CompensationLookAhead, line, message)
            .help("put them before or after the contour, or into one block")
            .into())
    }

    /// An event that moves nothing in the plane.
    fn pass(&mut self, event: Event, sink: &mut Sink) -> Outcome {
        if matches!(self.stage, Stage::On) {
            return sink(event);
        }
        if self.waiting.len() >= LOOK_AHEAD {
            let message =
                format!("{LOOK_AHEAD} events without a move in the plane of compensation");
            return Err(error(Rule::CompensationLookAhead, event.line, message).into());
        }
        self.waiting.push(event);
        Ok(())
    }

    /// What has waited happens at `point` of the plane.
    fn send_waiting(&mut self, point: Vec2, sink: &mut Sink) -> Outcome {
        for mut event in self.waiting.drain(..) {
            if let Action::Rapid(pose) | Action::Line(pose) = &mut event.action {
                pose.point = self.plane.lift(point, self.plane.flat(pose.point).1);
            }
            sink(event)?;
        }
        Ok(())
    }

    fn send(&self, way: CentreMove, sink: &mut Sink) -> Outcome {
        let CentreMove { line, rapid, end, height, turn } = way;
        let end = Position { point: self.plane.lift(end, height), ..self.at };
        // An arc of no length would be read as a full circle.
        let arc = turn.filter(|(turn, _)| {
            turn.sweep.abs() * self.plane.flat(end.point).0.distance(turn.center) > SAME
        });
        let action = match arc {
            Some((Turn { center, sweep }, height)) => Action::Arc(Box::new(ArcTo {
                end,
                center: self.plane.lift(center, height),
                normal: self.plane.normal * sweep.signum(),
                turns: ((sweep.abs() / TAU - 1e-9).ceil() - 1.0).max(0.0) as u32,
            })),
            None if rapid => Action::Rapid(end),
            None => Action::Line(end),
        };
        sink(Event { line, action })
    }
}

impl Piece {
    /// What remains of it.
    fn way(&self) -> CentreMove {
        let Piece { line, rapid, end, heights: [_, height, center], .. } = *self;
        let part = self.to - self.from;
        let turn = self.parallel.turn;
        let turn = turn.map(|turn| (Turn { sweep: turn.sweep * part, ..turn }, center));
        CentreMove { line, rapid, end, height, turn }
    }
}

/// Whether the tool points the same way; where a rotary axis stands may be unknown throughout.
fn same(a: &Orientation, b: &Orientation) -> bool {
    let equal = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
    match (a, b) {
        (Orientation::Axis(a), Orientation::Axis(b)) => a == b,
        (
            Orientation::Rotary { degrees: a, tool_center: first },
            Orientation::Rotary { degrees: b, tool_center: second },
        ) => first == second && a.iter().zip(b).all(|(a, b)| equal(*a, *b)),
        _ => false,
    }
}
