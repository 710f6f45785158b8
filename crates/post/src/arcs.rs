//! Arcs: written as arcs where the control takes them, also after rounding; as lines where not.

use crate::catalogue::{BlockName, WordName};
use crate::coordinate_mode::{Kind, Stop};
use crate::surface::LEVEL_FIRST;
use crate::walk::{Cut, Outcome, PLANE_XY, Walk, motion, refuse};
use crate::words::bit;
use geom::{ANGLE_EPSILON, Arc, ArcError, Vec3, angle_between};
use machine::Plane;
use program::{ArcTo, Diagnostic, Rule};
use std::f64::consts::{PI, TAU};

/// A plane of arcs: its code, its axes (first, second, normal) as places in X, Y, Z, and the words of
/// its centre.
struct Facts {
    plane: Plane,
    code: usize,
    axes: [usize; 3],
}

/// Counter-clockwise is counted about the third axis of each plane (ISO 6983: G18 is ZX).
const PLANES: [Facts; 3] = [
    Facts { plane: Plane::XY, code: PLANE_XY, axes: [0, 1, 2] },
    Facts { plane: Plane::XZ, code: 1, axes: [2, 0, 1] },
    Facts { plane: Plane::YZ, code: 2, axes: [1, 2, 0] },
];

const END: [WordName; 3] = [WordName::X, WordName::Y, WordName::Z];
const FROM_START: [WordName; 3] = [WordName::I, WordName::J, WordName::K];
const ABSOLUTE: [WordName; 3] = [WordName::CX, WordName::CY, WordName::CZ];
const MIDDLE: [WordName; 3] = [WordName::MX, WordName::MY, WordName::MZ];
const START: [WordName; 3] = [WordName::SX, WordName::SY, WordName::SZ];

/// By what a block says its circle, apart from the ends of the arc.
#[derive(Clone, Copy, PartialEq)]
enum Notation {
    /// The centre from the start, or absolute.
    Center([WordName; 3]),
    /// The radius, negative over a half circle.
    Radius,
    /// The point half way.
    Middle,
}

impl Notation {
    /// The angle up to which an arc that rounding spoils is not cut in two, radians.
    fn longest(self) -> f64 {
        match self {
            Notation::Radius => PI / 2.0,
            Notation::Center(_) | Notation::Middle => PI,
        }
    }
}

/// How many steps of the last decimal an arc may change in length when its ends are rounded.
const ROUNDING_STEPS: f64 = 6.0;

/// How many steps a point of an arc may move by the shift of its centre. Rounding a coordinate of the
/// centre to the nearest step moves no point of any arc further: √½ steps in the plane, twice that on the
/// side of a full circle that is opposite to its ends.
const CENTER_STEPS: f64 = std::f64::consts::SQRT_2;

/// How many steps the end of an arc that is written by its angle may be off: its start is rounded by up to
/// √½ steps in the plane, and its centre by less.
const ANGLE_STEPS: f64 = 0.85;

/// An arc of a smaller radius is written as lines, mm: a few steps of the last decimal do not say a circle, and LinuxCNC refuses radii
/// below 0.00127 mm.
const LEAST_RADIUS: f64 = 0.002;

/// How an arc is written.
struct Form {
    facts: &'static Facts,
    /// Whether it is a helix.
    rises: bool,
    ccw: bool,
    name: BlockName,
    notation: Notation,
    /// Whether its block says how far it turns, and not where it ends.
    by_angle: bool,
}

/// Part of an arc as one block.
struct Block {
    /// Where it ends, and where that is after rounding.
    to: Vec3,
    end: Vec3,
    center: Vec3,
    /// Half way along it.
    middle: Vec3,
    /// As the word says it: negative over a half circle.
    radius: f64,
    /// Signed angle about the plane's normal, radians.
    sweep: f64,
    rise: f64,
}

impl Walk<'_> {
    /// An arc of the source.
    pub(crate) fn arc(&mut self, to: &ArcTo, stop: &Stop) -> Outcome {
        if self.compensation_pending() {
            let help = "a straight move in the plane between CUTCOM and the arc";
            let message = "cutter compensation cannot be switched on an arc";
            return Err(refuse(Rule::Compensation, message).help(help).into());
        }
        self.same_taper("an arc")?;
        self.end_cycle()?;
        self.before_cut()?;
        self.settle(&to.end, stop, true)?;
        self.look_ahead_in_cuts()?;
        let Some(here) = self.position.known() else {
            return Err(refuse(Rule::ArcStart, "an arc from a position that is not known"));
        };
        // The reader holds arcs against its own tolerance; here the ends are what they are.
        let arc = to.circle.arc(here.point(), to.end.point(), f64::MAX).map_err(no_arc)?;
        self.position.begin_cut(if self.is_timed() { arc.length() } else { 0.0 });
        let local = Arc {
            start: self.local(arc.start),
            end: self.local(arc.end),
            center: self.local(arc.center),
            normal: self.local(arc.center + arc.normal) - self.local(arc.center),
            sweep: arc.sweep,
        };
        if let Kind::Plain | Kind::Machine = self.place.kind {
            let degrees = self.place.degrees().unwrap_or_default();
            for &sway in self.sways(arc.end) {
                let up = Vec3::Z * sway + self.place.carried();
                let local = Arc { start: local.start + up, end: local.end + up, ..local };
                self.limits.arc(&local, degrees, self.tool_length(), self.line)?;
            }
        }
        self.check_arc(&arc)?;
        let Some(facts) = self.plane_of(&local) else {
            if self.runs_through(&local) {
                return self.arc_through(&arc, &local, to, stop);
            }
            return self.lower(&arc, 0.0, 1.0, to, stop, "arcs outside the planes of the control");
        };
        let rises = local.rise().abs() > 0.5 * self.resolution || self.is_over_surface(arc.end);
        let form = self.form(&local, facts, rises);
        // A circle through three points of a helix is none.
        let flat = form.notation == Notation::Middle;
        if rises && (flat || !self.machine.capabilities.helix) {
            return self.lower(&arc, 0.0, 1.0, to, stop, "helices");
        }
        let pieces = self.pieces(&local, rises);
        // Ends of halves, the next one last.
        let mut halves = Vec::new();
        let (mut from, mut piece) = (0.0, 1);
        while piece <= pieces {
            let until = halves.last().copied().unwrap_or(piece as f64 / pieces as f64);
            match self.rounded_arc(&local, &form, from, until) {
                Some(block) => {
                    self.followed(&arc, until - from == 1.0, "arcs")?;
                    self.arc_block(&arc, &form, &block)?;
                    self.position.go_to(to.end.at(arc.at(until))?);
                }
                // Its ends are too near each other to say where its centre is, or too near the ends of a
                // diameter for its radius to say that: two halves are better.
                None if local.sweep * (until - from) > form.notation.longest() => {
                    halves.push((from + until) / 2.0);
                    continue;
                }
                None => {
                    self.lower(&arc, from, until, to, stop, "arcs too short for the decimals")?
                }
            }
            from = until;
            piece += if halves.pop().is_none() { 1 } else { 0 };
        }
        self.position.go_to(to.end);
        Ok(())
    }

    /// Whether the control cuts an arc of any plane by three points. Compensation counts in the plane that
    /// is active, and a tool center point control may turn the tool along the arc.
    fn runs_through(&self, arc: &Arc) -> bool {
        self.templates.places(BlockName::ArcThrough, WordName::MX)
            && matches!(
                self.place.kind,
                Kind::Bare | Kind::Plain | Kind::Machine | Kind::Tilted(..)
            )
            && !self.is_compensating()
            && arc.rise().abs() <= 0.5 * self.resolution
            && !self.follows(arc)
    }

    /// An arc by the point half way, in parts of a half circle at most; as lines where the decimals leave
    /// another circle than the source's.
    fn arc_through(&mut self, arc: &Arc, local: &Arc, to: &ArcTo, stop: &Stop) -> Outcome {
        let parts = (arc.sweep / PI - 1e-9).ceil().max(1.0) as usize;
        for part in 0..parts {
            let [from, until] = [part, part + 1].map(|part| part as f64 / parts as f64);
            let [middle, end] = [(from + until) / 2.0, until].map(|at| local.at(at));
            let round = |words: &[WordName; 3], p: Vec3| {
                Vec3::from_array([0, 1, 2].map(|i| self.writer.rounded(words[i], p[i])))
            };
            let start = self.stands(|| round(&END, local.at(from)));
            let read = through_in_space(start, round(&MIDDLE, middle), round(&END, end));
            let most = CENTER_STEPS * self.resolution;
            let quarters = [0.25, 0.75].map(|part| local.at(from + (until - from) * part));
            let near = |circle: &SpaceCircle| quarters.iter().all(|&p| circle.distance(p) <= most);
            if !read.is_some_and(|circle| near(&circle)) {
                self.lower(arc, from, until, to, stop, "arcs too short for the decimals")?;
                continue;
            }
            for i in 0..3 {
                self.writer.set(END[i], end[i]);
                self.writer.set(MIDDLE[i], middle[i]);
            }
            let length = local.radius() * local.sweep * (until - from);
            self.say_feed(if self.is_timed() { length } else { 0.0 }, 1, Cut::Arc)?;
            self.keep_compensation();
            self.block(BlockName::ArcThrough)?;
            // The block names its own motion.
            self.writer.forget(bit(WordName::Motion));
            self.position.go_to(to.end.at(arc.at(until))?);
        }
        self.position.go_to(to.end);
        Ok(())
    }

    /// The plane in which the control can cut the arc.
    fn plane_of(&self, arc: &Arc) -> Option<&'static Facts> {
        // Under tool center point control the plane turns with the tool.
        let upright = match self.place.kind {
            Kind::ToolCenter | Kind::Vectors => self
                .position
                .pose()
                .is_some_and(|here| crate::coordinate_mode::same(here.axis(), Vec3::Z)),
            Kind::Bare | Kind::Plain | Kind::Tilted(..) | Kind::Machine => true,
        };
        PLANES.iter().filter(|_| upright).find(|facts| {
            let along = Vec3::AXES[facts.axes[2]];
            let leans = || {
                let most = (self.resolution / (2.0 * arc.radius())).max(ANGLE_EPSILON);
                let off = angle_between(along, arc.normal);
                off.min(PI - off) > most
            };
            self.machine.capabilities.arcs.contains(&facts.plane)
                // The control offsets a contour in the plane XY alone.
                && (facts.plane == Plane::XY || !self.is_compensating())
                && (along.cross(arc.normal) == Vec3::ZERO || !leans())
        })
    }

    /// Into how many blocks the arc goes.
    fn pieces(&self, arc: &Arc, rises: bool) -> usize {
        let name = self.arc_name(true, rises);
        let turns = arc.sweep / TAU;
        if turns <= 1.0 - 1e-9 {
            return 1;
        }
        let takes = |word| self.templates.places(name, word);
        if takes(WordName::Sweep) || (turns > 1.0 + 1e-9 && takes(WordName::Turn)) {
            return 1;
        }
        let each = if self.machine.capabilities.full_circle { 1.0 } else { 0.5 };
        (turns / each - 1e-9).ceil() as usize
    }

    /// How the arc is written in a plane.
    fn form(&self, arc: &Arc, facts: &'static Facts, rises: bool) -> Form {
        let [first, second, normal] = facts.axes;
        let ccw = arc.normal[normal] > 0.0;
        let name = self.arc_name(ccw, rises);
        let takes = |word| self.templates.places(name, word);
        let centers = [FROM_START, ABSOLUTE];
        let notation =
            match centers.into_iter().find(|words| takes(words[first]) || takes(words[second])) {
                Some(words) => Notation::Center(words),
                None if takes(WordName::Radius) => Notation::Radius,
                None if takes(MIDDLE[first]) || takes(MIDDLE[second]) => Notation::Middle,
                None => Notation::Center(FROM_START),
            };
        Form { facts, rises, ccw, name, notation, by_angle: takes(WordName::Sweep) }
    }

    /// The part of the arc between two parameters as the control will read it; `None` where rounding
    /// leaves no legal arc.
    fn rounded_arc(&self, arc: &Arc, form: &Form, from: f64, until: f64) -> Option<Block> {
        let &Form { facts, notation, by_angle, .. } = form;
        let round = |words: &[WordName; 3], p: Vec3| {
            Vec3::from_array([0, 1, 2].map(|i| self.writer.rounded(words[i], p[i])))
        };
        let start = self.stands(|| round(&END, arc.at(from)));
        let to = arc.at(until);
        // An arc that is written by its angle ends as far from its centre as it begins, and not at a
        // rounded place.
        let end = if by_angle { to } else { round(&END, to) };
        let [u, v, w] = facts.axes;
        let flat = |p: Vec3| Vec3::new(p[u], p[v], 0.0);
        let (s, e, c) = (flat(start), flat(end), flat(arc.center));
        let sign = arc.normal[w].signum();
        let wanted = arc.sweep * (until - from);
        let chord = e - s;
        // Where the centre of the source is none of the rounded ends, the nearest one that has the same
        // radius at both, on the perpendicular bisector.
        let along = chord.normalize_or_zero();
        let even = c + along * ((s + e) * 0.5 - c).dot(along);
        let can = &self.machine.capabilities;
        let middle = match self.writer.has(&MIDDLE) {
            true => round(&MIDDLE, arc.at((from + until) / 2.0)),
            false => to,
        };
        let radius = if wanted > PI { -arc.radius() } else { arc.radius() };
        let said = self.writer.rounded(WordName::Radius, radius);
        // By as much an arc by its angle misses its end; any other is a spiral.
        let uneven = match by_angle {
            true => ANGLE_STEPS * self.resolution,
            false => can.arc_tolerance / 2.0,
        };
        let legal = |c: Vec3| {
            let mut center = arc.center;
            (center[u], center[v]) = (c.x, c.y);
            let written = match notation {
                Notation::Center(FROM_START) => start + round(&FROM_START, center - start),
                Notation::Center(words) => round(&words, center),
                Notation::Radius => {
                    (center[u], center[v]) = by_radius(s, e, said * sign)?.into();
                    center
                }
                Notation::Middle => {
                    (center[u], center[v]) = through(s, flat(middle), e)?.into();
                    center
                }
            };
            let (a, b) = (s - flat(written), e - flat(written));
            let mut sweep = sign * a.x.mul_add(b.y, -(a.y * b.x)).atan2(a.dot(b));
            if sweep <= 0.0 || chord == Vec3::ZERO {
                sweep += TAU;
            }
            sweep += TAU * ((wanted - sweep) / TAU).round().max(0.0);
            let radius = a.length();
            let near = (sweep - wanted).abs() * radius <= ROUNDING_STEPS * self.resolution;
            let even = (radius - b.length()).abs() <= uneven;
            let moved = flat(written).distance(flat(arc.center));
            let rise = end[w] - start[w];
            // The ends stay where they are; between them a shift of the centre moves the arc by as much
            // as its turn, and a short chord is a long lever for where the even centre lies. None is longer than 2.
            let lever = || 1.0 - (wanted.min(TAU) / 2.0).cos();
            let most = CENTER_STEPS * self.resolution * (1.0 + 1e-9);
            let close = moved * 2.0 <= most || moved * lever() <= most;
            let is_circle = radius >= LEAST_RADIUS;
            (near && even && moved <= can.lowering_tolerance && close && is_circle).then_some(
                Block { to, end, center: written, middle, radius: said, sweep: sign * sweep, rise },
            )
        };
        legal(c).or_else(|| legal(even))
    }

    fn arc_block(&mut self, arc: &Arc, form: &Form, block: &Block) -> Outcome {
        let &Form { facts, rises, ccw, name, by_angle, .. } = form;
        let [u, v, w] = facts.axes;
        let start = self.stands(|| self.local(arc.start));
        let full = [u, v].iter().all(|&i| block.end[i] == start[i]);
        if rises || full {
            // A helix or a circle says where it ends in the plane even where that is where it began:
            // the SINUMERIK takes the centre for wrong otherwise, GRBL and LinuxCNC miss the words.
            self.writer.forget(bit(END[u]) | bit(END[v]));
        }
        for i in [u, v] {
            self.writer.set(FROM_START[i], block.center[i] - start[i]);
            self.writer.set(ABSOLUTE[i], block.center[i]);
        }
        for i in [u, v, w] {
            self.writer.set(END[i], block.to[i]);
            self.writer.set(MIDDLE[i], block.middle[i]);
            self.writer.set(START[i], start[i]);
        }
        self.say_surface(block.to);
        if self.writer.has(&[WordName::StartAngle, WordName::EndAngle]) {
            let spoke = start - block.center;
            let begins = spoke[v].atan2(spoke[u]).rem_euclid(TAU);
            self.writer.set(WordName::StartAngle, begins.to_degrees());
            self.writer.set(WordName::EndAngle, (begins + block.sweep).to_degrees());
        }
        self.writer.set(WordName::Radius, block.radius);
        self.writer.set(WordName::PlainRadius, block.radius.abs());
        let turns = (block.sweep.abs() / TAU - 1e-9).floor();
        if turns > 0.0 {
            self.writer.set(WordName::Turn, turns);
        }
        self.writer.set(WordName::Sweep, block.sweep.to_degrees());
        self.writer.set(WordName::Rise, block.rise);
        let length = || {
            let radius = (start - block.center).reject_from_normalized(Vec3::AXES[w]).length();
            (radius * block.sweep).hypot(block.rise)
        };
        self.say_feed(if self.is_timed() { length() } else { 0.0 }, 1, Cut::Arc)?;
        self.keep_compensation();
        self.writer.code(WordName::Plane, facts.code);
        self.writer.code(WordName::Motion, if ccw { motion::ARC_CCW } else { motion::ARC_CW });
        let turned_to = by_angle.then(|| {
            let angle = self.writer.rounded(WordName::Sweep, block.sweep.to_degrees()).to_radians();
            let rise = self.writer.rounded(WordName::Rise, block.rise);
            let normal = Vec3::AXES[w];
            let turned = geom::rotate(start - block.center, normal, angle) + normal * rise;
            block.center + turned
        });
        self.position.turn_to(turned_to);
        self.block(name)?;
        self.follow_arc(turned_to.unwrap_or(block.end), block.center, block.sweep)
    }

    /// Where the control stands, in the coordinates of its blocks: as the last words say, or as the angle
    /// of the last arc leads to; `begin` where neither is known.
    fn stands(&self, begin: impl FnOnce() -> Vec3) -> Vec3 {
        match END.map(|word| self.writer.active(word)) {
            [Some(x), Some(y), Some(z)] => Vec3::new(x, y, z),
            known => {
                let begin = self.position.turned_to().unwrap_or_else(begin);
                Vec3::from_array([0, 1, 2].map(|i| known[i].unwrap_or(begin[i])))
            }
        }
    }

    fn arc_name(&self, ccw: bool, rises: bool) -> BlockName {
        let (arc, helix) = if ccw {
            (BlockName::ArcCcw, BlockName::HelixCcw)
        } else {
            (BlockName::ArcCw, BlockName::HelixCw)
        };
        if rises && self.templates.has(helix) { helix } else { arc }
    }

    /// Part of an arc as lines within the tolerance of the control.
    fn lower(
        &mut self,
        arc: &Arc,
        from: f64,
        until: f64,
        to: &ArcTo,
        stop: &Stop,
        what: &'static str,
    ) -> Outcome {
        let tolerance = self.machine.capabilities.lowering_tolerance;
        // Over a surface only one line ends where the arc does; round a quarter or less it cannot turn back.
        let bulge = arc.radius() * (1.0 - (arc.sweep / 2.0).cos());
        let over_surface = self.follows(arc) && arc.sweep <= PI / 2.0 && bulge <= tolerance;
        // No decimal says where such an arc goes between its ends.
        let within_a_step = !self.follows(arc) && arc.radius() <= self.resolution;
        let all = if over_surface || within_a_step { 1.0 } else { arc.chords(tolerance) as f64 };
        let lines = ((until - from) * all - 1e-9).ceil().max(1.0) as usize;
        self.followed(arc, lines == 1 && until - from == 1.0, what)?;
        for line in 1..=lines {
            let t = from + (until - from) * line as f64 / lines as f64;
            let point = if line == lines && until == 1.0 { arc.end } else { arc.at(t) };
            self.line_to(&to.end.at(point)?, stop)?;
        }
        self.findings.lowered(Rule::ArcLowered, what, self.line, lines);
        Ok(())
    }

    /// An arc over a surface rises evenly from one end to the other, the surface under it does not: it is written as
    /// one block, or not.
    ///
    /// # Errors
    /// It is not `whole`.
    fn followed(&self, arc: &Arc, whole: bool, what: &str) -> Outcome {
        if whole || !self.follows(arc) {
            return Ok(());
        }
        let message = format!(
            "{what} over a surface that the control finds: the machine takes this one in parts only"
        );
        Err(refuse(Rule::Surface, message).help(LEVEL_FIRST).into())
    }

    /// Whether an end of the arc counts from a surface.
    fn follows(&self, arc: &Arc) -> bool {
        [arc.start, arc.end].into_iter().any(|end| self.is_over_surface(end))
    }

    /// Back to the plane XY, which cutter compensation and cycles need.
    pub(crate) fn plane_xy(&mut self) -> Outcome {
        self.writer.code(WordName::Plane, PLANE_XY);
        if self.writer.changes(bit(WordName::Plane)) {
            return self.required(BlockName::PlaneSelect);
        }
        self.writer.unset(bit(WordName::Plane));
        Ok(())
    }
}

/// How near the centre of an arc that is written by its radius may lie to the chord between its ends, as part of
/// the radius. There the control finds it by the root of a difference of almost equal numbers: GRBL 1.1
/// (`gcode.c`, step 20) refuses a half circle where single precision makes that difference negative.
const NEAREST_CENTER: f64 = 0.1;

/// The centre of the arc in a plane from `start` to `end`, on the left of the way between them where the
/// radius is positive.
fn by_radius(start: Vec3, end: Vec3, radius: f64) -> Option<[f64; 2]> {
    let half = (end - start) * 0.5;
    let height = (radius * radius - half.length_squared()).sqrt();
    let left = half.normalize_or_zero().cross(Vec3::NEG_Z);
    let center = start + half + left * height.copysign(radius);
    let found = half != Vec3::ZERO && height >= NEAREST_CENTER * radius.abs();
    found.then_some([center.x, center.y])
}

/// A circle in space.
struct SpaceCircle {
    center: Vec3,
    /// Its axis, a unit vector.
    normal: Vec3,
    radius: f64,
}

impl SpaceCircle {
    /// How far a point is from the circle, mm.
    fn distance(&self, point: Vec3) -> f64 {
        let spoke = point - self.center;
        let across = spoke.reject_from_normalized(self.normal).length();
        (across - self.radius).hypot(spoke.dot(self.normal))
    }
}

/// The circle through three points of space; `None` where they lie on a line.
fn through_in_space(start: Vec3, middle: Vec3, end: Vec3) -> Option<SpaceCircle> {
    let (a, b) = (middle - start, end - start);
    let across = a.cross(b);
    let center = start
        + (across.cross(a) * b.length_squared() + b.cross(across) * a.length_squared())
            / (2.0 * across.length_squared());
    let normal = across.try_normalize()?;
    center.is_finite().then(|| SpaceCircle { center, normal, radius: center.distance(start) })
}

/// The arc through three points; `None` where they lie on a line.
pub(crate) fn arc_through(start: Vec3, middle: Vec3, end: Vec3) -> Option<Arc> {
    let circle = through_in_space(start, middle, end)?;
    Arc::new(start, end, circle.center, circle.normal, 0, circle.radius * 1e-6).ok()
}

/// The centre of the circle through three points of a plane.
fn through(start: Vec3, middle: Vec3, end: Vec3) -> Option<[f64; 2]> {
    let (a, b) = (middle - start, end - start);
    let area = 2.0 * a.x.mul_add(b.y, -(a.y * b.x));
    let off = (b * a.length_squared() - a * b.length_squared()).cross(Vec3::Z) / area;
    let center = start + off;
    center.is_finite().then_some([center.x, center.y])
}

fn no_arc(error: ArcError) -> Box<Diagnostic> {
    let why = match error {
        ArcError::NoAxis => "its axis has no direction".to_string(),
        ArcError::NoRadius => "it starts on its own axis".to_string(),
        ArcError::OffTheCircle(a, b) => format!("its ends have the radii {a} mm and {b} mm"),
    };
    refuse(Rule::Arc, format!("this is no arc: {why}"))
}
