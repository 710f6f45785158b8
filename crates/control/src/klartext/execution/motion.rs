//! Path functions: lines, arcs and helices.

use super::contour::left_of;
use super::state::contour::{Bend, Element};
use super::state::{AXES, Control, Tip};
use crate::event::{Action, ArcTo, Orientation, Position, Risk};
use crate::kernel::Outcome;
use crate::kernel::modulo::{self, Modulo};
use crate::klartext::language::functions::{Function, When};
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{
    LINEAR, PA, PR, RADIUS, ROTARY, TURN, VECTORS, Words, slot,
};
use geom::{Arc, ArcError, Vec3, direction};
use program::{Axes, Compensation, MachineMove, Rule};

/// By how much the radii at the two ends of an arc may differ, mm: the most that the machine
/// parameter circleDeviation (MP7431) takes.
const ARC_TOLERANCE: f64 = 0.016;

/// The most turns of one helix; `IPA` is limited to 99 999.9999°.
const MAX_IPA: f64 = 99_999.999_9;

/// X and Y.
const PLANE: u32 = 1 << slot::X | 1 << slot::Y;

impl Control<'_, '_> {
    /// `L`: a straight line, or M functions alone. `corner`: RND or CHF follows.
    pub(crate) fn line(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let words = Words::read(s, LINEAR | ROTARY, self)?;
        self.positioning(s, &words, corner)
    }

    /// `LP`: a straight line to a point in polar coordinates about the pole.
    pub(crate) fn polar_line(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let mut words = Words::read(s, PR | PA | 1 << slot::Z, self)?;
        self.polar(s, &mut words)?;
        self.positioning(s, &words, corner)
    }

    /// `LN`: a straight line with the surface normal, and the direction of the tool.
    pub(crate) fn vector_line(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, LINEAR | VECTORS, self)?;
        // The normal turns tool oversizes into an offset, and oversizes are refused at TOOL CALL.
        vector(s, &words, slot::NX)?;
        vector(s, &words, slot::TX)?;
        self.positioning(s, &words, false)
    }

    /// Puts X and Y in the place of a polar radius and angle. What the block does not give stays.
    pub(super) fn polar(&self, s: &Scanner, words: &mut Words) -> Outcome {
        if !words.has(PR | PA) {
            return Ok(());
        }
        let pole = self.center(s)?;
        let spoke = (self.here - pole).with_z(0.0);
        let kept = !words.has_all(PR | PA) || words.is_incremental(PR | PA);
        // At the pole there is no angle to keep.
        if kept && (spoke.is_nan() || spoke.length() < 1e-9) {
            let message = "PR and PA count on from a place that is not known, or is the pole";
            return Err(s
                .error_block(Rule::UnknownPosition, message)
                .help("give PR and PA")
                .into());
        }
        let radius = words.target(slot::PR, spoke.length());
        let angle = words.target(slot::PA, spoke.y.atan2(spoke.x).to_degrees());
        let (sin, cos) = angle.to_radians().sin_cos();
        words.set(slot::X, pole.x + radius * cos);
        words.set(slot::Y, pole.y + radius * sin);
        Ok(())
    }

    /// Moves as the words say: M functions of the start, the motion, M functions of the end.
    fn positioning(&mut self, s: &Scanner, words: &Words, corner: bool) -> Outcome {
        let moves = words.has(LINEAR | ROTARY | VECTORS);
        // What waits ends elsewhere than at the corner from which the words count.
        let mut to = None;
        if self.waiting.is_some() {
            let (end, degrees) = self.targets(s, words)?;
            if !moves || words.is_rapid() || words.has(ROTARY | VECTORS) {
                let message = "a line or an arc at a feed must follow RND, CHF and APPR";
                return Err(s.error_block(Rule::Contour, message));
            }
            self.meet(s, &Element { start: self.here, end, arc: None })?;
            to = Some((end, degrees));
        }
        self.functions(s, words.functions, When::Start)?;
        let to = match to {
            Some(to) => to,
            None => self.targets(s, words)?,
        };
        let rapid = self.set_feed(s, words.feed)?;
        if let Some(builders) = words.functions.machine_coordinates() {
            self.machine_position(s, words, builders)?;
        } else {
            if let Some(compensation) = words.compensation {
                self.set_compensation(compensation)?;
            }
            if moves {
                self.needs_feed(s, rapid)?;
                self.move_to(s, words, to, rapid, corner)?;
            }
        }
        self.after_motion(s, words, moves, corner)
    }

    /// What follows the motion of a block: M functions of the end, the cycle that is called modally.
    fn after_motion(&mut self, s: &Scanner, words: &Words, moves: bool, corner: bool) -> Outcome {
        if corner && (self.calls_modally || words.functions.at(When::End).next().is_some()) {
            let message = "nothing can happen at a corner that RND or CHF cuts off";
            return Err(s.error_block(Rule::Contour, message));
        }
        self.functions(s, words.functions, When::End)?;
        if moves && self.calls_modally && !words.functions.contains(Function::CallCyclesModally) {
            self.call_cycle(s)?;
        }
        Ok(())
    }

    /// Where the axes go: X, Y, Z in mm and A, B, C in degrees.
    pub(super) fn targets(&self, s: &Scanner, words: &Words) -> Outcome<(Vec3, [f64; 3])> {
        self.transforms_are_clear(s)?;
        let here = self.here;
        let to = Vec3::new(
            words.target(slot::X, here.x),
            words.target(slot::Y, here.y),
            words.target(slot::Z, here.z),
        );
        if words.is_incremental(LINEAR | ROTARY) || words.has(ROTARY) {
            let mut degrees = self.degrees;
            for (i, value) in degrees.iter_mut().enumerate() {
                *value = words.target(slot::A + i, *value);
                self.check_rotary(s, words, i)?;
            }
            for i in 0..6 {
                let value = if i < 3 { to[i] } else { degrees[i - 3] };
                if words.is_incremental(1 << i) && value.is_nan() {
                    let message = format!("I{} counts from a position that is not known", AXES[i]);
                    return Err(s.error_block(Rule::UnknownPosition, message));
                }
            }
            return Ok((to, degrees));
        }
        Ok((to, self.degrees))
    }

    fn check_rotary(&self, s: &Scanner, words: &Words, axis: usize) -> Outcome {
        if !words.has(1 << (slot::A + axis)) {
            return Ok(());
        }
        let letter = AXES[slot::A + axis];
        if !self.settings.rotary[axis] && self.tip != Tip::KeptSpatial {
            return Err(
                s.error_block(Rule::UnknownAxis, format!("the machine has no axis {letter}"))
            );
        }
        if self.tilt.as_ref().is_some_and(|tilt| tilt.turned) {
            let message = format!("{letter} would turn the tool out of the tilted plane");
            return Err(s.error_block(Rule::TiltedPlane, message).help("PLANE RESET first").into());
        }
        if self.mirrors() || (self.tip == Tip::KeptSpatial && self.outside.is_more_than_a_shift()) {
            let message =
                format!("what {letter} is in mirrored or rotated coordinates is not known");
            return Err(s.error_block(Rule::Transformation, message));
        }
        Ok(())
    }

    fn move_to(
        &mut self,
        s: &Scanner,
        words: &Words,
        (to, degrees): (Vec3, [f64; 3]),
        rapid: bool,
        corner: bool,
    ) -> Outcome {
        if corner && (rapid || words.has(ROTARY | VECTORS)) {
            let message = "RND and CHF cut off the corner of a contour, not that of this motion";
            return Err(s.error_block(Rule::Contour, message));
        }
        let element = Element { start: self.here, end: to, arc: None };
        self.here = to;
        self.rapid = rapid;
        if let Some(tool) = vector(s, words, slot::TX)? {
            if self.tip == Tip::Free {
                let message = "TX TY TZ need M128 or FUNCTION TCPM";
                return Err(s.error_block(Rule::ToolCenter, message));
            }
            let turns = self.vector != Some(tool);
            self.forget_rotary();
            self.vector = Some(tool);
            self.hold_turning(turns, true, element.start)?;
        }
        if words.has(ROTARY) {
            let turns = self.vector.is_some() || self.degrees != degrees;
            self.vector = None;
            self.hold_way(words, degrees, element.start)?;
            self.degrees = degrees;
            self.hold_turning(turns, self.tip == Tip::KeptSpatial, element.start)?;
            // In a plane that is only declared the tip goes where the turning axes take it.
            if self.tilt.is_some() {
                if words.has(LINEAR) {
                    let message = "linear and rotary axes do not move together in a tilted plane";
                    return Err(s.error_block(Rule::TiltedPlane, message));
                }
                self.forget_position();
                return self.emit(match rapid {
                    true => Action::Rapid(self.pose(self.here)),
                    false => Action::Line(self.cutting_pose(s, self.here)?),
                });
            }
        }
        if rapid {
            self.path = Some(element);
            self.check_descent(s)?;
            let [x, y, z] = self.here.to_array();
            let turned = self.tilt.as_ref().is_some_and(|tilt| tilt.turned);
            return self.emit(match turned && z.is_nan() && x.is_finite() && y.is_finite() {
                true => Action::Across(Box::new(self.pose(self.here.with_z(0.0)))),
                false => Action::Rapid(self.pose(self.here)),
            });
        }
        self.tool_is_due = false;
        if self.turns_unsaid && self.tip != Tip::Free {
            // A parameter of the machine says by how much (TNC 640, cycle 32: TA acts with M128).
            self.turns_unsaid = false;
            self.emit(Action::Risk(Risk::ORIENTATION_TOLERANCE.into()))?;
        }
        self.contour_element(s, element, corner)
    }

    /// Tells where nobody knows which way an axis turns that goes to `degrees` from the place `here` of the tool.
    fn hold_way(&mut self, words: &Words, degrees: [f64; 3], here: Vec3) -> Outcome {
        let modulo = if self.shorter_way { Modulo::Shorter } else { Modulo::AsSetUp };
        let is_sure = |i: usize| {
            let (from, counted) = (self.degrees[i], self.settings.modulo[i]);
            words.is_incremental(1 << (slot::A + i))
                || modulo::is_sure(from, degrees[i], counted, modulo)
        };
        // Away from the part an axis may turn as it likes; and spatial angles are no positions of axes.
        if here.z.is_nan() || self.tip == Tip::KeptSpatial || (0..3).all(is_sure) {
            return Ok(());
        }
        self.emit(Action::Risk(Risk::ROTARY_WAY.into()))
    }

    /// Tells where the tool turns over the part while the control keeps its tip, and not the way that its words need: vectors and
    /// spatial angles are reported as turning on the great circle, positions of axes as turning evenly.
    fn hold_turning(&mut self, turns: bool, great_circle: bool, here: Vec3) -> Outcome {
        let over_part = self.tip != Tip::Free && !here.z.is_nan();
        if !(turns && over_part) || self.great_circle == great_circle {
            return Ok(());
        }
        self.emit(Action::Risk(Risk::ORIENTATION_WAY.into()))
    }

    /// Tells an element of the contour that is cut.
    pub(super) fn tell(&mut self, s: &Scanner, element: Element) -> Outcome {
        self.here = element.end;
        self.path = Some(element);
        let end = self.cutting_pose(s, element.end)?;
        let Some(Bend { center, sense, turns }) = element.arc else {
            return self.emit(Action::Line(end));
        };
        if !self.transforms().keeps_circles() {
            let message = "an arc in coordinates that are scaled differently in X and Y";
            return Err(s.error_block(Rule::Transformation, message));
        }
        // In mirrored coordinates an arc turns the other way round.
        let sense = if self.mirrors() { -sense } else { sense };
        let arc = ArcTo {
            end,
            center: self.work_point(center),
            normal: self.work_direction(Vec3::Z * sense),
            turns,
        };
        self.emit(Action::Arc(Box::new(arc)))
    }

    /// In a turned plane nothing goes down at a place that is not known.
    pub(super) fn check_descent(&self, s: &Scanner) -> Outcome {
        let [x, y, z] = self.here.to_array();
        let known = x.is_finite() && y.is_finite();
        if self.tilt.as_ref().is_some_and(|tilt| tilt.turned) && z.is_finite() && !known {
            let message =
                "Z in a tilted plane before X and Y: where the tool goes down is not known";
            return Err(s.error_block(Rule::UnknownPosition, message));
        }
        Ok(())
    }

    /// The pose at a programmed position where something is cut, which must be known.
    pub(super) fn cutting_pose(&self, s: &Scanner, programmed: Vec3) -> Outcome<Position> {
        let pose = self.pose(programmed);
        let rotary_known = match pose.orientation {
            Orientation::Axis(axis) => axis.is_finite(),
            Orientation::Rotary { degrees, .. } => degrees.iter().all(|d| d.is_finite()),
        };
        if pose.point.is_finite() && rotary_known {
            return Ok(pose);
        }
        let unknown: Vec<String> = (0..6)
            .filter(|i| match i {
                0..3 => programmed[*i].is_nan(),
                _ => !rotary_known && self.degrees[i - 3].is_nan(),
            })
            .map(|i| AXES[i].to_string())
            .collect();
        let message = format!("a cut where the position of {} is not known", unknown.join(", "));
        Err(s.error_block(Rule::UnknownPosition, message).help("move there with FMAX first").into())
    }

    /// `M91`, `M92`: the axes go to a place of the machine; where that is in the work is not known.
    fn machine_position(&mut self, s: &Scanner, words: &Words, builders: bool) -> Outcome {
        if words.is_incremental(LINEAR | ROTARY) {
            let message = "an incremental word with M91 is not supported";
            return Err(s.error_block(Rule::Unsupported, message));
        }
        if !matches!(words.compensation, None | Some(Compensation::Off))
            || self.compensation != Compensation::Off
        {
            return Err(s.error_block(Rule::MFunction, "M91 and M92 are used with R0"));
        }
        if self.tip != Tip::Free {
            let message = "M128 is reset before positioning with M91 or M92";
            return Err(s.error_block(Rule::ToolCenter, message).help("program M129 first").into());
        }
        let axes = Axes::of([0, 1, 2, 3, 4, 5].map(|i| words.has(1 << i)));
        if axes.is_empty() {
            return Err(s.error_block(Rule::MissingWord, "M91 and M92 need coordinates"));
        }
        // M91 leaves the tool length out. Where the datum of M92 is, only the builder knows.
        let datum = if builders { f64::NAN } else { 0.0 };
        let value = |slot: usize| words.get(slot).map(|value| datum + value);
        let to = MachineMove {
            linear: [slot::X, slot::Y, slot::Z].map(value),
            rotary: [slot::A, slot::A + 1, slot::A + 2].map(value),
        };
        if words.has(ROTARY) {
            self.vector = None;
        }
        for i in 0..3 {
            if words.has(1 << (slot::A + i)) {
                self.check_rotary(s, words, i)?;
                self.degrees[i] = f64::NAN;
            }
            // An axis of the machine is a mix of axes of the plane.
            if self.tilt.is_some() || words.has(1 << i) {
                self.here[i] = f64::NAN;
            }
        }
        self.emit(Action::MachineMove(Box::new(to)))
    }

    /// `CC`: the pole; without coordinates where the tool is.
    pub(crate) fn circle_center(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, PLANE, self)?;
        if !words.is_plain() {
            return Err(s.error_block(Rule::UnknownWord, "CC takes coordinates alone"));
        }
        if words.has(PLANE) && !words.has_all(PLANE) {
            return Err(s.error_block(Rule::MissingWord, "CC needs X and Y, or neither"));
        }
        let pole = (words.target(slot::X, self.here.x), words.target(slot::Y, self.here.y));
        if !pole.0.is_finite() || !pole.1.is_finite() {
            return Err(
                s.error_block(Rule::UnknownPosition, "the position of the tool is not known")
            );
        }
        self.pole = Some(pole);
        Ok(())
    }

    /// `C`: an arc about the pole.
    pub(crate) fn arc(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let words = Words::read(s, LINEAR | TURN, self)?;
        let center = self.center(s)?;
        let (end, _) = self.targets(s, &words)?;
        if words.is_incremental(LINEAR) && end.is_nan() {
            return Err(
                s.error_block(Rule::UnknownPosition, "the position of the tool is not known")
            );
        }
        self.arc_to(s, &words, Bend { center, sense: words.turn, turns: 0 }, end, corner)
    }

    /// `CR`: an arc of given radius; positive for at most a half circle, negative for more.
    pub(crate) fn arc_of_radius(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let words = Words::read(s, LINEAR | RADIUS | TURN, self)?;
        let (end, _) = self.targets(s, &words)?;
        let Some(radius) = words.get(slot::R).filter(|r| *r != 0.0) else {
            return Err(s.error_block(Rule::MissingWord, "CR needs R+ or R- with a radius"));
        };
        let chord = (end - self.here).with_z(0.0);
        let half = chord.length() / 2.0;
        if half.is_nan() {
            return Err(s.error_block(Rule::UnknownPosition, "where the arc begins is not known"));
        }
        if half < 1e-9 {
            let message = "CR cannot make a full circle: its ends are the same point";
            return Err(s.error_block(Rule::Arc, message).help("use CC and C").into());
        }
        if half > radius.abs() + ARC_TOLERANCE / 2.0 {
            let message = format!(
                "the ends of the arc are {:.4} mm apart, which is more than twice the radius {:.4} mm",
                half * 2.0,
                radius.abs()
            );
            return Err(s.error_block(Rule::Arc, message));
        }
        // The center is on the left of the chord for a short arc counter-clockwise.
        let away = (radius * radius - half * half).max(0.0).sqrt();
        let left = left_of(chord) / (2.0 * half);
        let center = self.here + chord / 2.0 + left * (away * words.turn * radius.signum());
        self.arc_to(s, &words, Bend { center, sense: words.turn, turns: 0 }, end, corner)
    }

    /// `CP`: an arc or a helix about the pole by a polar angle.
    pub(crate) fn polar_arc(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let words = Words::read(s, PA | 1 << slot::Z | TURN, self)?;
        let center = self.center(s)?;
        let Some(angle) = words.get(slot::PA) else {
            return Err(s.error_block(Rule::MissingWord, "CP needs PA or IPA"));
        };
        if angle.abs() > MAX_IPA {
            return Err(s.error_block(Rule::Arc, format!("a polar angle is at most {MAX_IPA}°")));
        }
        let spoke = (self.here - center).with_z(0.0);
        let height = words.target(slot::Z, self.here.z);
        if spoke.is_nan() || height.is_nan() {
            return Err(s.error_block(Rule::UnknownPosition, "where the arc begins is not known"));
        }
        let (end, turns) = if words.is_incremental(PA) {
            if angle * words.turn <= 0.0 {
                return Err(s.error_block(Rule::Arc, "IPA and DR must have the same sign"));
            }
            // What is left of a whole number of turns is a full turn.
            let turns = ((angle.abs() / 360.0).ceil() - 1.0).max(0.0);
            let rest = angle - 360.0 * turns.copysign(angle);
            let end = if rest.abs() == 360.0 {
                self.here
            } else {
                center + geom::rotate(spoke, Vec3::Z, rest.to_radians())
            };
            (end, turns as u32)
        } else {
            let (sin, cos) = angle.to_radians().sin_cos();
            (center + Vec3::new(cos, sin, 0.0) * spoke.length(), 0)
        };
        let bend = Bend { center, sense: words.turn, turns };
        self.arc_to(s, &words, bend, end.with_z(height), corner)
    }

    pub(super) fn center(&self, s: &Scanner) -> Outcome<Vec3> {
        let (x, y) = self.pole.ok_or_else(|| {
            s.error_block(Rule::MissingWord, "no pole: a CC block must come before")
        })?;
        Ok(Vec3::new(x, y, 0.0))
    }

    /// `CT`: an arc that goes on in the direction of the element before it.
    pub(crate) fn tangential_arc(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let words = Words::read(s, LINEAR, self)?;
        self.tangential_to(s, &words, corner)
    }

    /// `CTP`: the same to polar coordinates.
    pub(crate) fn polar_tangential_arc(&mut self, s: &mut Scanner, corner: bool) -> Outcome {
        let mut words = Words::read(s, PR | PA | 1 << slot::Z, self)?;
        self.polar(s, &mut words)?;
        self.tangential_to(s, &words, corner)
    }

    fn tangential_to(&mut self, s: &Scanner, words: &Words, corner: bool) -> Outcome {
        let (end, _) = self.targets(s, words)?;
        let before = self.path.filter(|path| path.end == self.here && self.waiting.is_none());
        let Some(tangent) = before.and_then(|path| path.tangent_at_end()) else {
            let message = "CT goes on in the direction of the line or arc directly before it, and there \
                           is none in the plane XY";
            return Err(s.error_block(Rule::Arc, message));
        };
        if end.z != self.here.z {
            return Err(s.error_block(Rule::Arc, "CT stays in the plane XY"));
        }
        let chord = (end - self.here).with_z(0.0);
        let left = left_of(tangent);
        let sine = chord.dot(left) / chord.length();
        if sine.is_nan() || sine.abs() < 1e-9 {
            let message = "CT leads straight on, straight back or nowhere: that is no arc";
            return Err(s.error_block(Rule::Arc, message));
        }
        let center = self.here + left * (chord.length() / (2.0 * sine));
        self.arc_to(s, words, Bend { center, sense: sine.signum(), turns: 0 }, end, corner)
    }

    /// The arc itself, checked as the control does, in the coordinates of the block.
    fn arc_to(
        &mut self,
        s: &Scanner,
        words: &Words,
        bend: Bend,
        end: Vec3,
        corner: bool,
    ) -> Outcome {
        if bend.sense == 0.0 {
            return Err(
                s.error_block(Rule::MissingWord, "the sense of rotation DR+ or DR- is missing")
            );
        }
        if words.functions.machine_coordinates().is_some() {
            return Err(s.error_block(Rule::MFunction, "M91 and M92 belong to straight lines"));
        }
        if words.compensation.is_some_and(|c| c != self.compensation) {
            let message = "radius compensation begins and ends in a straight line";
            return Err(s.error_block(Rule::Compensation, message));
        }
        let bend = Bend { center: bend.center.with_z(self.here.z), ..bend };
        let normal = Vec3::Z * bend.sense;
        match Arc::new(self.here, end, bend.center, normal, bend.turns, ARC_TOLERANCE) {
            Ok(_) => {}
            Err(ArcError::OffTheCircle(start, end)) => {
                let message = format!(
                    "the end of the arc is off the circle: radius {start:.4} mm at the start, {end:.4} mm \
                     at the end, at most {ARC_TOLERANCE} mm apart"
                );
                return Err(s.error_block(Rule::Arc, message));
            }
            Err(_) if self.here.is_nan() || end.is_nan() => {
                return Err(
                    s.error_block(Rule::UnknownPosition, "where the arc begins is not known")
                );
            }
            Err(_) => return Err(s.error_block(Rule::Arc, "the arc begins at its own center")),
        }
        if words.is_rapid() {
            return Err(s.error_block(Rule::Unsupported, "an arc at rapid is not supported"));
        }
        self.meet(s, &Element { start: self.here, end, arc: Some(bend) })?;
        self.functions(s, words.functions, When::Start)?;
        self.set_feed(s, words.feed)?;
        self.needs_feed(s, false)?;
        self.contour_element(s, Element { start: self.here, end, arc: Some(bend) }, corner)?;
        self.after_motion(s, words, true, corner)
    }

    pub(super) fn needs_feed(&self, s: &Scanner, rapid: bool) -> Outcome {
        if rapid || self.feed.is_some() || !self.settings.setup.purpose.asks_technology() {
            return Ok(());
        }
        Err(s
            .error_block(Rule::Feed, "no feed is active")
            .help("give F or FMAX in the block")
            .into())
    }
}

/// The unit vector of three words from `first`, where the block gives them.
fn vector(s: &Scanner, words: &Words, first: usize) -> Outcome<Option<Vec3>> {
    let all = 0b111 << first;
    if !words.has(all) {
        return Ok(None);
    }
    let at = |i| words.get(first + i);
    let (Some(x), Some(y), Some(z)) = (at(0), at(1), at(2)) else {
        return Err(s.error_block(Rule::MissingWord, "a vector has three components"));
    };
    match direction(Vec3::new(x, y, z)) {
        Some(direction) => Ok(Some(direction)),
        None => Err(s.error_block(Rule::ZeroVector, "the vector has no length")),
    }
}
