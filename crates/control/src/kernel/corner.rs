//! What goes between two ways in a plane: a chamfer between lines, or an arc that touches both.

use crate::Action;
use geom::{Arc, Vec3};

/// Ways that turn by less than this from a half turn, radians, go back where they have come.
const TURNED_BACK: f64 = 1e-6;

/// What a block with a corner, or one between its two ways, may say in addition to the path.
pub(crate) fn may_stand_at(action: &Action) -> bool {
    matches!(
        action,
        Action::Feed(_)
            | Action::Spindle(_)
            | Action::Coolant(_)
            | Action::Comment(_)
            | Action::Message(_)
            | Action::Risk(_)
    )
}

/// The way of a block, in whichever coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element {
    /// Where it starts.
    pub start: Vec3,
    /// Where it ends.
    pub end: Vec3,
    /// Centre and direction of an arc.
    pub circle: Option<(Vec3, Vec3)>,
    /// Whether it can have a corner: a cut without further turns.
    pub cut: bool,
}

/// What is put between two ways, mm.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    /// A chamfer of that length.
    Chamfer(f64),
    /// A chamfer that begins that far before the corner, and ends as far behind it.
    ChamferSide(f64),
    /// An arc of that radius.
    Round(f64),
}

/// Why there is nothing to put between two ways.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Misfit {
    /// The second goes back where the first has come.
    TurnsBack,
    /// A chamfer, and one of them is an arc.
    ChamferAtArc,
    /// It is longer than one of them.
    TooLarge,
}

/// Where a corner leaves the first block, where it meets the second, and its arc.
pub(crate) struct Joint {
    pub from: Vec3,
    pub to: Vec3,
    /// Its centre and the direction that it turns about.
    pub circle: Option<(Vec3, Vec3)>,
}

impl Element {
    /// The direction at the start (false) or the end (true), a unit vector.
    fn direction(&self, end: bool) -> Vec3 {
        match self.circle {
            None => (self.end - self.start).normalize_or_zero(),
            Some((center, normal)) => {
                let point = if end { self.end } else { self.start };
                normal.cross(point - center).normalize_or_zero()
            }
        }
    }

    /// Whether `point`, which lies on its line or circle, is within it.
    fn passes(&self, point: Vec3) -> bool {
        match self.circle {
            None => {
                let way = self.end - self.start;
                let t = (point - self.start).dot(way) / way.length_squared();
                (-1e-9..=1.0 + 1e-9).contains(&t)
            }
            Some((center, normal)) => {
                Arc::new(self.start, self.end, center, normal, 0, f64::INFINITY)
                    .is_ok_and(|arc| arc.nearest(point).1 < 1e-6)
            }
        }
    }

    /// Where centres of arcs of `radius` lie that touch it on its left (1) or right (-1) side: a line by a
    /// point and its direction, or a circle by its centre and radius.
    fn parallel(&self, up: Vec3, radius: f64, side: f64) -> Locus {
        match self.circle {
            None => {
                let way = self.direction(true);
                Locus::Line(self.end + up.cross(way) * (side * radius), way)
            }
            Some((center, normal)) => {
                let turn = normal.dot(up).signum();
                let own = (self.end - center).length();
                Locus::Circle(center, own - side * turn * radius)
            }
        }
    }

    /// Where an arc about `center` touches it.
    fn touched(&self, center: Vec3) -> Vec3 {
        match self.circle {
            None => {
                let way = self.direction(true);
                self.end + way * (center - self.end).dot(way)
            }
            Some((own, _)) => own + (center - own).normalize_or_zero() * (self.end - own).length(),
        }
    }
}

/// A line or a circle in the plane.
#[derive(Clone, Copy)]
enum Locus {
    Line(Vec3, Vec3),
    Circle(Vec3, f64),
}

impl Locus {
    /// The point of both that is nearest to `corner`.
    fn meet(self, other: Locus, up: Vec3, corner: Vec3) -> Option<Vec3> {
        let nearest = |a: Vec3, b: Vec3| {
            if a.distance_squared(corner) <= b.distance_squared(corner) { a } else { b }
        };
        match (self, other) {
            (Locus::Line(a, u), Locus::Line(b, v)) => {
                let cross = up.dot(u.cross(v));
                (cross.abs() > 1e-12).then(|| a + u * (up.dot((b - a).cross(v)) / cross))
            }
            (Locus::Line(a, u), Locus::Circle(c, r)) | (Locus::Circle(c, r), Locus::Line(a, u)) => {
                let foot = a + u * (c - a).dot(u);
                let half = r * r - foot.distance_squared(c);
                (r > 0.0 && half >= 0.0)
                    .then(|| nearest(foot + u * half.sqrt(), foot - u * half.sqrt()))
            }
            (Locus::Circle(c, r), Locus::Circle(d, s)) => {
                let way = d - c;
                let apart = way.length();
                if r <= 0.0 || s <= 0.0 || apart <= 1e-12 {
                    return None;
                }
                let along = (apart * apart + r * r - s * s) / (2.0 * apart);
                let half = r * r - along * along;
                let foot = c + way / apart * along;
                let aside = up.cross(way / apart);
                (half >= 0.0)
                    .then(|| nearest(foot + aside * half.sqrt(), foot - aside * half.sqrt()))
            }
        }
    }
}

/// What `shape` puts between `first` and `second`, which lie in the plane across the unit vector `up`; nothing where their
/// directions differ by less than `straight_on` (radians).
///
/// # Errors
/// There is no room for it.
pub(crate) fn joint(
    first: &Element,
    second: &Element,
    up: Vec3,
    shape: Shape,
    straight_on: f64,
) -> Result<Option<Joint>, Misfit> {
    let corner = first.end;
    let (before, behind) = (first.direction(true), second.direction(false));
    let turn = up.dot(before.cross(behind)).atan2(before.dot(behind));
    let (Shape::Chamfer(size) | Shape::ChamferSide(size) | Shape::Round(size)) = shape;
    if turn.abs() < straight_on || size == 0.0 {
        return Ok(None);
    }
    if turn.abs() > std::f64::consts::PI - TURNED_BACK {
        return Err(Misfit::TurnsBack);
    }
    let side = turn.signum();
    let back = match shape {
        Shape::Round(_) => 0.0,
        _ if first.circle.is_some() || second.circle.is_some() => return Err(Misfit::ChamferAtArc),
        Shape::Chamfer(length) => length / (2.0 * (turn / 2.0).cos()),
        Shape::ChamferSide(back) => back,
    };
    let joint = match shape {
        Shape::Round(radius) => {
            let one = first.parallel(up, radius, side);
            let other = second.parallel(up, radius, side);
            one.meet(other, up, corner).map(|center| Joint {
                from: first.touched(center),
                to: second.touched(center),
                circle: Some((center, up * side)),
            })
        }
        Shape::Chamfer(_) | Shape::ChamferSide(_) => {
            Some(Joint { from: corner - before * back, to: corner + behind * back, circle: None })
        }
    };
    joint
        .filter(|joint| first.passes(joint.from) && second.passes(joint.to))
        .map(Some)
        .ok_or(Misfit::TooLarge)
}
