//! The path of the tool's centre along a contour, for machines that offset nothing: parallel to each line and arc at the radius of the
//! tool, around outer corners by an arc about the corner, from the crossing of both parallels at inner ones.
//!
//! What switches compensation on is a straight segment to the first element's parallel, what switches it off one from the end of the last.
//! Where the tool does not fit, the contour is refused: at an arc that is too small, between neighbours, or in a neck whose two sides lie
//! anywhere along it.

use geom::{Element, Turn, Vec2, Vec3, angle_between, turn_angle};
use program::{
    ArcTo, Circle, CompensatedPath, Compensation, Diagnostic, Op, Outcome, Pose, Program, Record,
    Rule,
};
use std::f64::consts::{PI, TAU};

/// A move shorter than this goes nowhere in the plane, mm.
const NOWHERE: f64 = 1e-6;

/// The centre may be so much nearer to the contour than the radius, mm: rounding of the source's points.
const NEAR: f64 = 1e-3;

/// Parallels whose ends are no farther apart are joined, mm.
const JOINED: f64 = 2e-4;

/// Around an outer corner of two lines the centre goes straight to where the parallels cross, if that is no farther off than this, mm.
const BEYOND: f64 = 2e-4;

/// What corners leave of an element has to be at least so many steps of the program's words long.
const SHOWN: f64 = 4.0;

/// How far the radii at the ends of an arc of the source may differ, as a part of them.
const RADII: f64 = 0.01;

/// At so many points a part of the path is compared with an element near it.
const SAMPLES: u32 = 16;

/// `program` with the path of the tool's centre in the place of each contour that compensation offsets, and where the first one begins;
/// nothing where there is none. Pieces that are no longer than `resolution`, mm, are left to their neighbours.
///
/// # Errors
/// The tool does not fit, its radius is not known, or something happens on the contour that no path of the centre has.
pub(crate) fn centered(
    program: &Program,
    resolution: f64,
) -> Outcome<Option<(Program, Diagnostic)>> {
    if program.compensated_path != Some(CompensatedPath::Contour) {
        return Ok(None);
    }
    let Some(line) = program.compensates() else { return Ok(None) };
    let mut walk = Walk {
        records: Vec::new(),
        resolution,
        here: None,
        radius: None,
        used: None,
        section: None,
    };
    for record in program.each() {
        walk.record(record).map_err(|found| {
            Box::new(if found.line == 0 { found.line(record.line) } else { *found })
        })?;
    }
    walk.finish(None)?;
    let made = Program {
        compensated_path: Some(CompensatedPath::Center),
        ..program.with_records(walk.records)
    };
    let radius = walk.used.unwrap_or_default();
    let message = format!(
        "the source gives the contour, which this machine cannot offset: the path of the tool's centre is written, first with a radius of \
         {radius} mm, and offsets at the control do not change the size of what is cut"
    );
    let help = "have the diameter of the tool in the source as it has been measured";
    Ok(Some((made, Diagnostic::warning(Rule::CompensatedPath, message).help(help).line(line))))
}

/// What is between two moves of a contour, or one of them.
enum Item {
    /// What moves nothing.
    Record(Record),
    /// Along the tool, to a height.
    Along(u32, f64),
    Move(Move),
}

/// A move of a contour in its plane.
#[derive(Clone, Copy)]
pub(crate) struct Move {
    pub(crate) line: u32,
    pub(crate) element: Element,
    /// Height above the plane at its start and end.
    pub(crate) heights: [f64; 2],
}

impl Move {
    /// Height at its higher end.
    pub(crate) fn high(&self) -> f64 {
        self.heights[0].max(self.heights[1])
    }
}

/// With which elements a segment is compared.
#[derive(Clone, Copy)]
enum Reach {
    All,
    /// Those that are no neighbours; of them not what runs on past a crossing with the segment's own.
    Necks,
}

/// What is wrong with a contour that a control offsets by so many mm to its left, where the tool fits to each element and its neighbours
/// but not between two others: no control looks so far ahead.
pub(crate) fn neck(moves: &[Move], left: f64, axis: Vec3, resolution: f64) -> Option<Diagnostic> {
    let section = Section {
        line: 0,
        left: left.signum(),
        radius: left.abs(),
        shortest: resolution,
        axis,
        lead: None,
        items: Vec::new(),
        leaves: false,
    };
    let seen = |step: &&Move| step.element.length() > resolution;
    let moves: Vec<Move> = moves.iter().filter(seen).copied().collect();
    // What does not fit at a corner is the control's own rule.
    let segments = section.parallels(&moves).ok()?;
    section.keeps_off(&moves, &segments, Reach::Necks).err().map(|found| *found)
}

/// A stretch in which compensation is on.
struct Section {
    line: u32,
    /// 1 where the tool is on the left, -1 where it is on the right.
    left: f64,
    radius: f64,
    /// A piece that is no longer is left to its neighbours, mm.
    shortest: f64,
    /// The tool; the plane is across it.
    axis: Vec3,
    /// Where the lead-in ends, once it has come.
    lead: Option<Move>,
    items: Vec<Item>,
    /// Whether compensation is off, from the next move in the plane on.
    leaves: bool,
}

struct Walk {
    records: Vec<Record>,
    /// The smallest step of the program's words, mm.
    resolution: f64,
    here: Option<Pose>,
    radius: Option<f64>,
    /// The radius of the first contour.
    used: Option<f64>,
    section: Option<Section>,
}

fn refused<T>(rule: Rule, message: impl Into<String>, help: &str) -> Outcome<T> {
    Err(Diagnostic::error(rule, message).help(help).into())
}

const OFF_BEFORE: &str = "CUTCOM/OFF and a straight move in the plane before it";

impl Walk {
    fn record(&mut self, record: &Record) -> Outcome {
        if let Op::Compensation(side) = &record.op {
            return self.switch(record.line, *side);
        }
        if let Op::Tool(tool) = &record.op {
            self.radius = tool.cutting_radius();
        }
        if self.section.is_some() && !self.within(record)? {
            return Ok(());
        }
        let before = self.here.filter(|_| !record.op.loses_position());
        self.here = record.op.pose().copied().or(before);
        self.records.push(record.clone());
        Ok(())
    }

    fn switch(&mut self, line: u32, side: Compensation) -> Outcome {
        let left = match side {
            Compensation::Off => {
                if let Some(section) = &mut self.section {
                    section.leaves = true;
                    // Nothing has been offset.
                    if section.lead.is_none() {
                        self.finish(None)?;
                    }
                }
                return Ok(());
            }
            Compensation::Left(_) => 1.0,
            Compensation::Right(_) => -1.0,
        };
        match &self.section {
            Some(section) if !section.leaves && section.left == left => return Ok(()),
            Some(_) => {
                let message = "cutter compensation changes while it is on";
                return refused(Rule::CompensationChange, message, OFF_BEFORE);
            }
            None => {}
        }
        let Some(radius) = self.radius else {
            let message = "the source states no radius of the tool by which this contour would be offset, or one that depends on the depth";
            let help = "the diameter in the source's tool call (CUTTER, TLDATA), or the path of the tool's centre from the CAM system";
            return refused(Rule::Compensation, message, help);
        };
        let Some(here) = self.here else {
            let message = "cutter compensation is switched on where the source does not say where the tool is";
            return refused(Rule::UnknownStart, message, "a move to a point before it");
        };
        self.used.get_or_insert(radius);
        self.section = Some(Section {
            line,
            left,
            radius,
            shortest: self.resolution,
            axis: here.axis(),
            lead: None,
            items: Vec::new(),
            leaves: false,
        });
        Ok(())
    }

    /// A record while compensation is on, or in its lead-out; whether it is then to be written as it is.
    fn within(&mut self, record: &Record) -> Outcome<bool> {
        let (Some(section), Some(here)) = (&mut self.section, self.here) else { return Ok(true) };
        let line = record.line;
        match &record.op {
            Op::Line(to) => {
                let step = section.plane(to.point()) - section.plane(here.point());
                if section.leaves && step.length() > NOWHERE {
                    self.finish(Some((line, *to)))?;
                    return Ok(false);
                }
                section.upright(to)?;
                let heights = [section.height(here.point()), section.height(to.point())];
                if step.length() <= NOWHERE {
                    // Before the lead-in nothing is offset.
                    if section.lead.is_none() {
                        return Ok(true);
                    }
                    section.along(line, heights);
                } else {
                    let [start, end] = [here, *to].map(|pose| section.plane(pose.point()));
                    section.go(Move { line, element: Element::line(start, end), heights })?;
                }
                self.here = Some(*to);
                Ok(false)
            }
            Op::Arc(to) => {
                if section.lead.is_none() || section.leaves {
                    let message = "an arc switches cutter compensation: where the tool's centre then goes is not defined";
                    return refused(
                        Rule::Compensation,
                        message,
                        "a straight move that switches it",
                    );
                }
                section.upright(&to.end)?;
                let radius = here.point().distance(to.circle.center());
                let arc = to.circle.arc(here.point(), to.end.point(), radius * RADII);
                let arc = arc.map_err(|_| {
                    Diagnostic::error(Rule::Arc, "the ends of the arc are not on its circle")
                })?;
                let facing = arc.normal.dot(section.axis);
                if facing.abs() < 1.0 - geom::ANGLE_EPSILON {
                    let message =
                        "an arc out of the plane across the tool, while cutter compensation is on";
                    return refused(Rule::Compensation, message, "have the CAM system write lines");
                }
                let turn =
                    Turn { center: section.plane(arc.center), sweep: arc.sweep * facing.signum() };
                let [start, end] = [here, to.end].map(|pose| section.plane(pose.point()));
                let heights = [section.height(here.point()), section.height(to.end.point())];
                let element = Element { start, end, turn: Some(turn) };
                section.go(Move { line, element, heights })?;
                self.here = Some(to.end);
                Ok(false)
            }
            Op::Rapid(to) if section.leaves => {
                let step = section.plane(to.point()) - section.plane(here.point());
                let up = section.height(to.point()) - section.height(here.point());
                self.finish(None)?;
                let Some(end) = self.here.filter(|_| step.length() <= NOWHERE) else {
                    return Ok(true);
                };
                // Up from where the centre is.
                let to = end.lifted(up)?;
                self.records.push(Record { line, op: Op::Rapid(to) });
                self.here = Some(to);
                Ok(false)
            }
            Op::Rapid(to)
                if section.lead.is_none()
                    && section.plane(to.point()).distance(section.plane(here.point()))
                        <= NOWHERE =>
            {
                Ok(true)
            }
            Op::Rapid(_) => {
                let message = "a rapid while cutter compensation is on";
                let help = "make it a cut, or switch compensation on behind it";
                refused(Rule::CompensationActive, message, help)
            }
            Op::Feed(_)
            | Op::PathMode(_)
            | Op::Spindle(_)
            | Op::Coolant(_)
            | Op::Frame(_)
            | Op::Preselect(_)
            | Op::Comment(_)
            | Op::Message(_)
            | Op::Operation(_)
            | Op::EndOfOperation => {
                if section.lead.is_none() {
                    return Ok(true);
                }
                section.items.push(Item::Record(record.clone()));
                Ok(false)
            }
            _ if section.leaves => {
                self.finish(None)?;
                Ok(true)
            }
            _ if section.lead.is_none() => Ok(true),
            op => {
                let message = format!("cutter compensation is still on at `{}`", op.kind().name());
                refused(Rule::CompensationActive, message, OFF_BEFORE)
            }
        }
    }

    /// Writes the path of the centre, and the lead-out to a pose.
    fn finish(&mut self, exit: Option<(u32, Pose)>) -> Outcome {
        let Some(section) = self.section.take() else { return Ok(()) };
        if let Some(lead) = section.lead {
            self.here = Some(section.write(&lead, &mut self.records)?);
        }
        if let Some((line, to)) = exit {
            self.records.push(Record { line, op: Op::Line(to) });
            self.here = Some(to);
        }
        Ok(())
    }
}

impl Section {
    fn plane(&self, point: Vec3) -> Vec2 {
        let x = self.axis.any_orthonormal_vector();
        Vec2::new(point.dot(x), point.dot(self.axis.cross(x)))
    }

    fn height(&self, point: Vec3) -> f64 {
        point.dot(self.axis)
    }

    fn point(&self, at: Vec2, height: f64) -> Vec3 {
        let x = self.axis.any_orthonormal_vector();
        x * at.x + self.axis.cross(x) * at.y + self.axis * height
    }

    fn upright(&self, to: &Pose) -> Outcome {
        match angle_between(to.axis(), self.axis) < geom::ANGLE_EPSILON {
            true => Ok(()),
            false => refused(
                Rule::Compensation,
                "the tool turns while cutter compensation is on",
                OFF_BEFORE,
            ),
        }
    }

    /// A move to another height; a point that the source gives twice is none.
    fn along(&mut self, line: u32, [from, to]: [f64; 2]) {
        if (to - from).abs() > NOWHERE {
            self.items.push(Item::Along(line, to));
        }
    }

    /// # Errors
    /// The contour goes on in pieces that the program cannot show.
    fn go(&mut self, step: Move) -> Outcome {
        let Some(lead) = &self.lead else {
            self.lead = Some(step);
            return Ok(());
        };
        if step.element.length() > self.shortest {
            self.items.push(Item::Move(step));
            return Ok(());
        }
        let last = self.items.iter().rev().find_map(Item::as_move);
        let last = last.as_ref().unwrap_or(lead);
        if last.element.end.distance(step.element.end) > self.shortest {
            let message = format!(
                "pieces of the contour, one behind the other, are shorter than a step of the program, {} mm",
                self.shortest
            );
            let help = "have the CAM system leave out points so near to each other";
            return Err(Diagnostic::error(Rule::Compensation, message)
                .help(help)
                .line(step.line)
                .into());
        }
        self.along(step.line, step.heights);
        Ok(())
    }

    /// Writes the path of the centre behind `records`; where it ends.
    fn write(&self, lead: &Move, records: &mut Vec<Record>) -> Outcome<Pose> {
        let moves: Vec<Move> = self.items.iter().filter_map(Item::as_move).collect();
        let segments = self.parallels(&moves)?;
        self.keeps_off(&moves, &segments, Reach::All)?;
        let pose = |at: Vec2, height: f64| Pose::new(self.point(at, height), self.axis);
        let Some(first) = segments.first() else {
            let message = "cutter compensation is on and off again with no contour between";
            let help = "leave it out, or give the contour behind the move that switches it on";
            return Err(Diagnostic::error(Rule::Compensation, message)
                .help(help)
                .line(self.line)
                .into());
        };
        let (mut at, mut height) = (first.element.start, lead.heights[1]);
        let to = pose(at, height)?;
        records.push(Record { line: lead.line, op: Op::Line(to) });
        let mut segments = segments.iter();
        for item in &self.items {
            let segment = match item {
                Item::Record(record) => {
                    records.push(record.clone());
                    continue;
                }
                Item::Along(line, to) => {
                    height = *to;
                    records.push(Record { line: *line, op: Op::Line(pose(at, height)?) });
                    continue;
                }
                Item::Move(_) => segments.next(),
            };
            let Some(segment) = segment else { continue };
            if let Some(around) = segment.around.as_ref().filter(|around| self.shows(around)) {
                let op = self.op(around, height)?;
                records.push(Record { line: segment.line, op });
            }
            height = segment.height;
            at = segment.element.end;
            // Nothing of an arc may be left at the radius of the tool.
            if self.shows(&segment.element) {
                let op = self.op(&segment.element, height)?;
                records.push(Record { line: segment.line, op });
            }
        }
        Ok(pose(at, height)?)
    }

    /// Whether the program can show it.
    fn shows(&self, element: &Element) -> bool {
        element.length() > self.shortest
    }

    /// A line or an arc to the end of an element.
    fn op(&self, element: &Element, height: f64) -> Outcome<Op> {
        let end = Pose::new(self.point(element.end, height), self.axis)?;
        let Some(turn) = element.turn else { return Ok(Op::Line(end)) };
        let turns = (turn.sweep.abs() / TAU - 1e-9).floor().max(0.0) as u32;
        let normal = self.axis * turn.sweep.signum();
        let circle = Circle::new(self.point(turn.center, height), normal, turns)?;
        Ok(Op::Arc(Box::new(ArcTo { end, circle })))
    }

    /// The parallels of the elements, cut off or joined at the corners.
    fn parallels(&self, moves: &[Move]) -> Outcome<Vec<CenterMove>> {
        let mut parallel = Vec::with_capacity(moves.len());
        for step in moves {
            let Some(element) = step.element.parallel(self.left * self.radius) else {
                let radius = step.element.radius().unwrap_or_default();
                return self.too_thick(step.line, &format!("into an arc of radius {radius:.4} mm"));
            };
            parallel.push(element);
        }
        // From where to where each parallel is left, as parts of it.
        let mut parts = vec![[0.0, 1.0]; moves.len()];
        let mut around = vec![None; moves.len()];
        for k in 1..moves.len() {
            let (before, after) = (&moves[k - 1].element, &moves[k].element);
            let turn = turn_angle(before.tangent(1.0), after.tangent(0.0));
            let corner = after.start;
            let (from, to) = (parallel[k - 1].end, parallel[k].start);
            // A short piece between may have been left out.
            if from.distance(to) <= JOINED + before.end.distance(after.start) {
                continue;
            }
            if turn * self.left < 0.0 || turn.abs() > PI - 1e-9 {
                let beyond = self.radius / (turn / 2.0).cos() - self.radius;
                let lines = before.turn.is_none() && after.turn.is_none();
                if lines && (0.0..=BEYOND).contains(&beyond) {
                    let middle = (from + to) / 2.0 - corner;
                    let at = corner + middle.normalize_or_zero() * (self.radius + beyond);
                    // What is cut off at its start stays so long.
                    let cut = parts[k - 1][0] * parallel[k - 1].length();
                    (parallel[k - 1].end, parallel[k].start) = (at, at);
                    parts[k - 1][0] = cut / parallel[k - 1].length();
                } else {
                    let sweep = -self.left * turn.abs();
                    around[k] = Some(Element::arc(from, to, corner, sweep));
                }
                continue;
            }
            let crossing = parallel[k - 1].crossings(&parallel[k]);
            let Some(crossing) = crossing.min_by(|a, b| a.cut.total_cmp(&b.cut)) else {
                let what = format!("into the inner corner behind line {}", moves[k - 1].line);
                return self.too_thick(moves[k].line, &what);
            };
            (parts[k - 1][1], parts[k][0]) = (crossing.on_first, crossing.on_next);
        }
        let mut segments = Vec::with_capacity(moves.len());
        for (k, step) in moves.iter().enumerate() {
            let [from, to] = parts[k];
            // What is left between its neighbours' corners is seen in the program.
            let (left, whole) = ((to - from) * parallel[k].length(), parallel[k].length());
            let least = (SHOWN * self.shortest).min(whole / 3.0);
            if from > to + 1e-9 || self.shows(&parallel[k]) && left < least {
                return self.too_thick(step.line, "between the neighbours of this element");
            }
            segments.push(CenterMove {
                line: step.line,
                around: around[k],
                element: parallel[k].part(from, to),
                height: step.heights[1],
            });
        }
        Ok(segments)
    }

    fn too_thick<T>(&self, line: u32, what: &str) -> Outcome<T> {
        let message = format!("the tool, of radius {} mm, does not fit {what}", self.radius);
        let help = "a thinner tool; or have the CAM system write the path of the tool's centre, which leaves such places out";
        Err(Diagnostic::error(Rule::Compensation, message).help(help).line(line).into())
    }

    /// No segment comes nearer than the radius to another element that faces it.
    fn keeps_off(&self, moves: &[Move], segments: &[CenterMove], reach: Reach) -> Outcome {
        let away = match reach {
            Reach::All => 1,
            Reach::Necks => 2,
        };
        // By where they begin along X: what begins behind the end of a segment is not near it.
        let mut order: Vec<(usize, Vec2, Vec2)> = moves
            .iter()
            .enumerate()
            .map(|(i, step)| {
                let (low, high) = step.element.extents();
                (i, low, high)
            })
            .collect();
        order.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
        let widest = order.iter().map(|(_, low, high)| high.x - low.x).fold(0.0, f64::max);
        for (k, segment) in segments.iter().enumerate() {
            for element in segment.around.iter().chain([&segment.element]) {
                let (low, high) = element.extents();
                let (low, high) = (low - self.radius, high + self.radius);
                let first = order.partition_point(|(_, from, _)| from.x < low.x - widest);
                let near = order[first..].iter().take_while(|(_, from, _)| from.x <= high.x);
                for (i, from, to) in near {
                    let is_apart = to.x < low.x || to.y < low.y || from.y > high.y;
                    if is_apart || i.abs_diff(k) < away {
                        continue;
                    }
                    let step = &moves[*i];
                    let is_above = moves[k].heights[0].min(segment.height) > step.high() + NEAR;
                    if is_above || element.distance(&step.element, NEAR) >= self.radius - NEAR {
                        continue;
                    }
                    let evenly = (0..=SAMPLES).map(|i| f64::from(i) / f64::from(SAMPLES));
                    let points = evenly.chain(self.within(element, &step.element));
                    let mut points = points.map(|t| element.at(t));
                    let is_neighbour = i.abs_diff(k) == 1;
                    let crosses =
                        |own: &&Move| own.element.meets(&step.element, NEAR).next().is_some();
                    // Of a contour that the writer offsets every place counts.
                    let crossing: Vec<Element> = match reach {
                        Reach::All => Vec::new(),
                        Reach::Necks => moves[k.saturating_sub(1)..=k]
                            .iter()
                            .filter(crosses)
                            .map(|own| own.element)
                            .collect(),
                    };
                    let cuts = |at: Vec2| match is_neighbour {
                        true => step.element.away(at) < self.radius - NEAR,
                        false => {
                            self.cuts_into(&step.element, &moves[k], at)
                                && !self.is_cut_away(
                                    step.element.at(step.element.nearest(at).0),
                                    &crossing,
                                )
                        }
                    };
                    if points.any(cuts) {
                        let what = format!("between this element and that of line {}", step.line);
                        return self.too_thick(segment.line, &what);
                    }
                }
            }
        }
        Ok(())
    }

    /// Where a segment is nearest to an element, or crosses it, and up to where on both sides of that the tool cuts into it.
    fn within(&self, segment: &Element, other: &Element) -> impl Iterator<Item = f64> {
        let nearest = segment.closest(other).0;
        let near: Vec<f64> = segment
            .meets(other, NEAR)
            .chain([nearest])
            .map(|point| segment.nearest(point).0)
            .collect();
        let cuts = |t: f64| other.nearest(segment.at(t)).1 < self.radius - NEAR;
        let last = |from: f64, end: f64| {
            let (mut inside, mut outside) = (from, end);
            if cuts(end) {
                return end;
            }
            for _ in 0..40 {
                let middle = (inside + outside) / 2.0;
                if cuts(middle) { inside = middle } else { outside = middle }
            }
            inside
        };
        let ends: Vec<f64> = near.iter().flat_map(|&t| [last(t, 0.0), t, last(t, 1.0)]).collect();
        ends.into_iter()
    }

    /// Whether a place of an element is on that side of one that crosses it on which the tool goes along that one: what runs on there past
    /// the crossing, as a contour that begins and ends beyond its corner does, bounds nothing.
    fn is_cut_away(&self, at: Vec2, crossing: &[Element]) -> bool {
        crossing.iter().any(|own| {
            let t = own.nearest(at).0;
            own.tangent(t).perp_dot(at - own.at(t)) * self.left > NEAR
        })
    }

    /// Whether the tool at `at`, which touches the contour at `own`, cuts into an element whose own side of the tool is that from which
    /// the contour comes: from the other side it takes what an earlier or a later pass leaves.
    fn cuts_into(&self, other: &Element, own: &Move, at: Vec2) -> bool {
        let (t, near) = other.nearest(at);
        let touched = own.element.at(own.element.nearest(at).0);
        let inward = other.tangent(t).perp() * self.left;
        near < self.radius - NEAR && inward.dot(touched - other.at(t)) > NOWHERE
    }
}

impl Item {
    fn as_move(&self) -> Option<Move> {
        match self {
            Item::Move(step) => Some(*step),
            Item::Record(_) | Item::Along(..) => None,
        }
    }
}

/// What the centre does for an element.
#[derive(Debug)]
struct CenterMove {
    line: u32,
    /// The arc around the corner before it.
    around: Option<Element>,
    element: Element,
    /// Height at its end.
    height: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Numbers from 0 to 1 that look like chance: a linear congruence (Knuth, MMIX).
    struct Chance(u64);

    impl Chance {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn between(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * self.next()
        }
    }

    fn section(radius: f64, left: f64) -> Section {
        Section {
            line: 1,
            left,
            radius,
            shortest: 1e-3,
            axis: Vec3::Z,
            lead: None,
            items: Vec::new(),
            leaves: false,
        }
    }

    /// The path of the centre, where the tool fits.
    fn fitted(section: &Section, moves: &[Move]) -> Outcome<Vec<CenterMove>> {
        let segments = section.parallels(moves)?;
        section.keeps_off(moves, &segments, Reach::All).map(|()| segments)
    }

    fn moves(elements: &[Element]) -> Vec<Move> {
        let step =
            |(line, element): (u32, &Element)| Move { line, element: *element, heights: [0.0; 2] };
        (1..).zip(elements).map(step).collect()
    }

    /// Lines and arcs, one behind the other, each turned against the one before by up to `most` radians.
    fn contour(chance: &mut Chance, most: f64) -> Vec<Element> {
        let (mut at, mut heading) = (Vec2::ZERO, 0.0_f64);
        let count = 3 + (chance.next() * 8.0) as usize;
        let element = |_: usize| {
            heading += chance.between(-most, most);
            let start = at;
            let along = Vec2::from_angle(heading);
            if chance.next() < 0.6 {
                at = start + along * chance.between(1.0, 30.0);
                return Element::line(start, at);
            }
            let (radius, sweep) = (chance.between(1.0, 20.0), chance.between(-2.5, 2.5));
            let center = start + along.perp() * radius * sweep.signum();
            at = center + Vec2::from_angle(sweep).rotate(start - center);
            heading += sweep;
            Element::arc(start, at, center, sweep)
        };
        (0..count).map(element).collect()
    }

    /// Between the points of a segment and a contour, looked at point by point.
    fn nearest(element: &Element, contour: &[Element]) -> f64 {
        let points = (0..=200).map(|i| element.at(f64::from(i) / 200.0));
        let near = |point: Vec2| contour.iter().map(move |other| other.nearest(point).1);
        points.flat_map(near).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_centre_of_chance_contours_touches_them_and_comes_no_nearer() {
        let mut chance = Chance(17);
        let (mut made, mut tight) = (0, 0);
        for _ in 0..1500 {
            let most = chance.between(0.0, 2.0);
            let contour = contour(&mut chance, most);
            let radius = chance.between(0.2, 6.0);
            let left = if chance.next() < 0.5 { 1.0 } else { -1.0 };
            let Ok(segments) = fitted(&section(radius, left), &moves(&contour)) else {
                tight += 1;
                continue;
            };
            made += 1;
            let mut before: Option<Vec2> = None;
            for (k, segment) in segments.iter().enumerate() {
                for element in segment.around.iter().chain([&segment.element]) {
                    // One path, whose parts begin where those before end.
                    if let Some(before) = before.filter(|_| element.length() > NOWHERE) {
                        assert!(before.distance(element.start) <= JOINED, "{contour:?}");
                    }
                    before = Some(element.end);
                }
                let off = contour[k].nearest(segment.element.at(0.5)).1;
                assert!((off - radius).abs() <= BEYOND + 1e-9, "{off} {radius} {contour:?}");
                // A contour that comes back over itself from behind is cut by what it says itself.
                for element in segment.around.iter().chain([&segment.element]) {
                    for i in 0..=100 {
                        let at = element.at(f64::from(i) / 100.0);
                        let touched = contour[k].at(contour[k].nearest(at).0);
                        let cut = contour.iter().find(|other| {
                            let (t, near) = other.nearest(at);
                            let inward = other.tangent(t).perp() * left;
                            near < radius - NEAR && inward.dot(touched - other.at(t)) > NOWHERE
                        });
                        assert_eq!(cut, None, "{at} {radius} {k} {contour:?}");
                    }
                }
            }
        }
        assert!(made > 150 && tight > 150, "{made} {tight}");
    }

    #[test]
    fn around_chance_convex_parts_the_centre_goes_at_every_radius() {
        let mut chance = Chance(4);
        for _ in 0..500 {
            // The corners of a polygon on a circle, clockwise: the tool on the left is outside.
            let count = 3 + (chance.next() * 40.0) as usize;
            let mut angles: Vec<f64> = (0..count).map(|_| chance.between(0.0, TAU)).collect();
            angles.sort_by(|a, b| b.total_cmp(a));
            angles.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
            let corner = |angle: &f64| Vec2::from_angle(*angle) * 25.0;
            let corners: Vec<Vec2> = angles.iter().map(corner).collect();
            let lines = corners.windows(2).map(|pair| Element::line(pair[0], pair[1]));
            let contour: Vec<Element> = lines.collect();
            let radius = chance.between(0.1, 30.0);
            let segments = fitted(&section(radius, 1.0), &moves(&contour)).unwrap();
            for segment in &segments {
                for element in segment.around.iter().chain([&segment.element]) {
                    let near = nearest(element, &contour);
                    assert!((near - radius).abs() < BEYOND, "{near} {radius} {contour:?}");
                }
            }
        }
    }

    #[test]
    fn a_pocket_corner_is_cut_to_where_the_parallels_cross() {
        // A corner of 90° in a pocket, and an arc of radius 8 that a tool of radius 3 passes at radius 5.
        let contour = [
            Element::line(Vec2::new(0.0, 0.0), Vec2::new(20.0, 0.0)),
            Element::line(Vec2::new(20.0, 0.0), Vec2::new(20.0, 12.0)),
            Element::arc(
                Vec2::new(20.0, 12.0),
                Vec2::new(12.0, 20.0),
                Vec2::new(12.0, 12.0),
                FRAC_PI_2,
            ),
        ];
        let segments = fitted(&section(3.0, 1.0), &moves(&contour)).unwrap();
        assert!(segments.iter().all(|segment| segment.around.is_none()));
        assert_eq!(segments[0].element.end, Vec2::new(17.0, 3.0));
        assert_eq!(
            (segments[1].element.start, segments[1].element.end),
            (Vec2::new(17.0, 3.0), Vec2::new(17.0, 12.0))
        );
        assert!(segments[2].element.end.distance(Vec2::new(12.0, 17.0)) < 1e-12);
        let refused = fitted(&section(8.0, 1.0), &moves(&contour)).unwrap_err();
        assert_eq!(refused.line, 3, "{refused}");
    }
}
