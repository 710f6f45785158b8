//! `APPR` and `DEP`: to a contour and away from it.
//!
//! Names as in the manuals: from PS by PH to PA, the first point of the contour; from PE, its last
//! point, to PN. PS and PN are places of the tool's center; PH, PA and PE are places of the contour,
//! from which the tool is offset by its radius.

use super::contour::left_of;
use super::state::Control;
use super::state::contour::{Approach, ApproachShape, Bend, Element, Waiting};
use crate::event::Action;
use crate::kernel::Outcome;
use crate::klartext::language::functions::When;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{CCA, LEN, LINEAR, PA, PR, RADIUS, Words, slot};
use geom::Vec3;
use program::{Compensation, Diagnostic, Rule};

impl ApproachShape {
    /// The shape that the words say, and whether its point is in polar coordinates.
    fn read(s: &mut Scanner, control: &Control) -> Outcome<(ApproachShape, bool, Words)> {
        let (kind, span) = s.token();
        let (polar, kind) = match kind {
            [b'P', rest @ ..] => (true, rest),
            _ => (false, kind),
        };
        let point = if polar { PR | PA | 1 << slot::Z } else { LINEAR };
        let own = match kind {
            b"LT" | b"LN" => LEN,
            b"CT" => CCA | RADIUS,
            b"LCT" => RADIUS,
            _ => {
                return Err(s.error(Rule::UnknownWord, span, "LT, LN, CT or LCT is expected here"));
            }
        };
        let words = Words::read(s, point | own, control)?;
        let positive = |slot| words.get(slot).filter(|value| *value > 0.0);
        let shape = match kind {
            b"LT" => positive(slot::LEN).map(ApproachShape::Tangent),
            b"LN" => positive(slot::LEN).map(ApproachShape::Normal),
            b"CT" => words.get(slot::R).filter(|radius| *radius != 0.0).and_then(|radius| {
                let angle = positive(slot::CCA).filter(|angle| *angle <= 360.0)?;
                Some(ApproachShape::Arc(radius, angle.to_radians()))
            }),
            _ => positive(slot::R).map(ApproachShape::LineAndArc),
        };
        let shape = shape.ok_or_else(|| {
            let message = "LT and LN need LEN, CT needs CCA up to 360° and R, LCT needs R";
            s.error_block(Rule::MissingWord, message)
        })?;
        Ok((shape, polar, words))
    }
}

/// An arc that touches a line at a point, seen from there.
struct Touching {
    bend: Bend,
    radius: f64,
}

impl Touching {
    /// On the `side` (1 left, −1 right) of the direction.
    fn new(at: Vec3, along: Vec3, side: f64, radius: f64) -> Touching {
        let bend = Bend { center: at + left_of(along) * (side * radius), sense: side, turns: 0 };
        Touching { bend, radius }
    }

    /// The point of the arc so far from another, radians in the sense of the arc.
    fn turned(&self, from: Vec3, angle: f64) -> Vec3 {
        let center = self.bend.center.with_z(from.z);
        center + geom::rotate(from - center, Vec3::Z, angle * self.bend.sense)
    }

    /// The point at which a line from outside touches the arc and runs into it (`before`), or out of it
    /// to the point outside; the tool's radius makes the arc that its center makes smaller.
    fn tangent_point(&self, outside: Vec3, tool: f64, before: bool) -> Option<Vec3> {
        let inner = self.radius - tool;
        let spoke = (outside - self.bend.center).with_z(0.0);
        let away = spoke.length();
        if !(inner > 0.0 && away > inner) {
            return None;
        }
        let angle = (inner / away).acos() * self.bend.sense * if before { 1.0 } else { -1.0 };
        let on = geom::rotate(spoke / away, Vec3::Z, angle) * self.radius;
        Some((self.bend.center + on).with_z(outside.z))
    }
}

/// 1 where the tool is on the left of the contour, −1 on the right.
fn side(compensation: Compensation) -> Option<f64> {
    match compensation {
        Compensation::Off => None,
        Compensation::Left(_) => Some(1.0),
        Compensation::Right(_) => Some(-1.0),
    }
}

impl Control<'_, '_> {
    /// `APPR`, from behind it: what is known is kept until the contour is.
    pub(crate) fn approach(&mut self, s: &mut Scanner) -> Outcome {
        let (shape, polar, mut words) = ApproachShape::read(s, self)?;
        if polar {
            self.polar(s, &mut words)?;
        }
        if self.compensation != Compensation::Off {
            return Err(s.error_block(Rule::Compensation, "a contour is approached from R0"));
        }
        if words.is_rapid() || words.functions.at(When::End).next().is_some() {
            let message = "an approach takes a feed, and M functions of the start of a block";
            return Err(s.error_block(Rule::Contour, message));
        }
        let compensation = words.compensation.unwrap_or(Compensation::Off);
        if compensation == Compensation::Off && !matches!(shape, ApproachShape::Tangent(_)) {
            let message =
                "an approach with R0 is one with RR on the iTNC 530 and an error on others";
            return Err(s.error_block(Rule::Compensation, message).help("say RL or RR").into());
        }
        self.functions(s, words.functions, When::Start)?;
        let (end, _) = self.targets(s, &words)?;
        if !end.is_finite() {
            let message = "the point of the contour is not known: give X, Y and Z";
            return Err(s.error_block(Rule::UnknownPosition, message));
        }
        if matches!(shape, ApproachShape::LineAndArc(_)) && end.z != self.here.z {
            let message = "where LCT goes down differs between controls";
            return Err(s.error_block(Rule::Unsupported, message).help("go to Z before").into());
        }
        let (start, feed, rapid) = (self.here, words.feed, self.rapid);
        self.here = end;
        self.waiting =
            Some(Waiting::Approach(Approach { shape, start, compensation, feed, rapid }));
        Ok(())
    }

    /// The contour begins with `next`: the approach is reported.
    pub(super) fn finish_approach(
        &mut self,
        s: &Scanner,
        approach: &Approach,
        next: &Element,
    ) -> Outcome {
        let Approach { shape, start, compensation, feed, rapid } = *approach;
        let Some(along) = next.tangent_at_start() else {
            let message = "in which direction the contour begins is not known";
            return Err(s.error_block(Rule::Contour, message));
        };
        let contour = next.start;
        let sign = side(compensation).unwrap_or(0.0);
        let (before, arc) = match shape {
            ApproachShape::Tangent(length) => (contour - along * length, None),
            ApproachShape::Normal(length) => {
                let away = length + self.offset_from_contour(s, sign)?;
                (contour + left_of(along) * (sign * away), None)
            }
            ApproachShape::Arc(radius, angle) => {
                let arc = Touching::new(contour, along, sign * radius.signum(), radius.abs());
                (arc.turned(contour, -angle), Some(arc.bend))
            }
            ApproachShape::LineAndArc(radius) => {
                let arc = Touching::new(contour, along, sign, radius);
                let tool = self.offset_from_contour(s, sign)?;
                let before = arc.tangent_point(start, tool, true);
                (before.ok_or_else(|| no_tangent(s))?, Some(arc.bend))
            }
        };
        if matches!(shape, ApproachShape::LineAndArc(_)) {
            self.set_feed(s, feed)?;
        }
        // At right angles the compensation begins in the last line; else PH is compensated already.
        if !matches!(shape, ApproachShape::Normal(_)) {
            self.set_compensation(compensation)?;
        }
        let to = before.with_z(start.z);
        if rapid && !matches!(shape, ApproachShape::LineAndArc(_)) {
            self.here = to;
            self.emit(Action::Rapid(self.pose(to)))?;
        } else {
            self.needs_feed(s, false)?;
            self.tell(s, Element { start, end: to, arc: None })?;
        }
        self.set_feed(s, feed)?;
        self.needs_feed(s, false)?;
        let before = before.with_z(contour.z);
        if to != before {
            self.tell(s, Element { start: to, end: before, arc: None })?;
        }
        self.set_compensation(compensation)?;
        self.tell(s, Element { start: before, end: contour, arc })
    }

    /// `DEP`, from behind it.
    pub(crate) fn departure(&mut self, s: &mut Scanner) -> Outcome {
        let (shape, polar, mut words) = ApproachShape::read(s, self)?;
        if polar {
            self.polar(s, &mut words)?;
        }
        let to_a_point = matches!(shape, ApproachShape::LineAndArc(_));
        let plane = 1 << slot::X | 1 << slot::Y;
        if words.has(LINEAR) != to_a_point
            || (to_a_point && !words.has_all(plane))
            || words.has(1 << slot::Z)
            || words.is_rapid()
            || words.compensation.is_some()
        {
            let message = "DEP LCT takes X and Y, other departures no point; none takes R or FMAX, and \
                           where Z is reached differs between controls";
            return Err(s.error_block(Rule::Contour, message));
        }
        let path = self.path.filter(|path| path.end == self.here);
        let Some(along) = path.and_then(|path| path.tangent_at_end()) else {
            let message = "DEP goes on from the line or arc directly before it, and there is none";
            return Err(s.error_block(Rule::Contour, message));
        };
        let sign = side(self.compensation);
        let Some(sign) = sign.or(matches!(shape, ApproachShape::Tangent(_)).then_some(0.0)) else {
            let message = "on which side of the contour the tool leaves is said by RL or RR";
            return Err(s.error_block(Rule::Compensation, message));
        };
        self.functions(s, words.functions, When::Start)?;
        self.set_feed(s, words.feed)?;
        self.needs_feed(s, false)?;
        let tool = self.offset_from_contour(s, sign)?;
        let (last, across) = (self.here, |along: Vec3| left_of(along) * (sign * tool));
        let element = |end, arc| Element { start: last, end, arc };
        match shape {
            ApproachShape::Tangent(length) => {
                self.tell(s, element(last + along * length, None))?;
                self.leave_contour(self.here + across(along))
            }
            ApproachShape::Normal(length) => {
                self.set_compensation(Compensation::Off)?;
                let end = last + left_of(along) * (sign * (length + tool));
                self.tell(s, element(end, None))
            }
            ApproachShape::Arc(radius, angle) => {
                let arc = Touching::new(last, along, sign * radius.signum(), radius.abs());
                let element = element(arc.turned(last, angle), Some(arc.bend));
                self.tell(s, element)?;
                let along = element.tangent_at_end().unwrap_or(along);
                self.leave_contour(self.here + across(along))
            }
            ApproachShape::LineAndArc(radius) => {
                let (end, _) = self.targets(s, &words)?;
                let arc = Touching::new(last, along, sign, radius);
                let before = arc.tangent_point(end, tool, false).ok_or_else(|| no_tangent(s))?;
                self.tell(s, element(before, Some(arc.bend)))?;
                self.set_compensation(Compensation::Off)?;
                self.tell(s, Element { start: before, end, arc: None })
            }
        }?;
        self.functions(s, words.functions, When::End)
    }

    /// The compensation ends where the tool is: its center has this place.
    fn leave_contour(&mut self, center: Vec3) -> Outcome {
        self.here = center;
        self.path = None;
        self.set_compensation(Compensation::Off)
    }

    /// How far the center of the tool is offset from the contour.
    fn offset_from_contour(&self, s: &Scanner, sign: f64) -> Outcome<f64> {
        if sign == 0.0 {
            return Ok(0.0);
        }
        if self.transforms().scales() {
            let message = "the radius of the tool is not scaled, and the contour is";
            return Err(s.error_block(Rule::Transformation, message));
        }
        self.tool_radius.ok_or_else(|| {
            let message =
                "where the tool is off the contour depends on its radius, which is not known";
            let error: Box<Diagnostic> = s.error_block(Rule::Tool, message);
            error.help("give the tool in the tool table").into()
        })
    }
}

fn no_tangent(s: &Scanner) -> Box<Diagnostic> {
    let message = "no line touches the arc: its radius is not greater than that of the tool, or the \
                   point outside is within it";
    s.error_block(Rule::Contour, message)
}
