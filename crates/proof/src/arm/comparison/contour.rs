//! The tool's centre along a contour: what the program does is gathered up to its end, compared as a whole, and then taken as lines and
//! arcs of the source, with all that is asked of those.

use super::super::expected::{Contour, Element, Expected, Step};
use super::{Comparison, arc_through, refused};
use crate::compensation::centre::{self, Fault, Slack};
use crate::compensation::trail::Piece;
use crate::resolved_pose::{Number, PartialPose};
use control::{Action, ArmAction, ArmPath, Event};
use geom::{Arc, Vec3};
use program::{Diagnostic, Outcome, Pose, Rule};

/// How far rounding moves the centre from where it should be, in tip tolerances: as for mills.
const ROUNDINGS: f64 = 3.0;

/// So often a program may come to the end of a contour before it is at its end.
const MOST_TRIES: u32 = 16;

/// What the program has done since a contour began.
#[derive(Default)]
pub(super) struct Gathered {
    events: Vec<Event>,
    pieces: Vec<Piece>,
    tries: u32,
    /// What was wrong at the last end.
    fault: Option<Fault>,
}

impl Comparison<'_> {
    /// Gathers an event on a contour; whether it is one of it.
    ///
    /// # Errors
    /// The centre does not go along the contour, or something of a line or an arc on it is wrong.
    pub(super) fn gather(&mut self, event: &Event) -> Outcome<bool> {
        let path = moved(event);
        if self.gathered.is_none() {
            let cuts = matches!(path, Some(ArmPath::Line(_) | ArmPath::Arc { .. }));
            if !cuts {
                return Ok(false);
            }
            self.leave_out();
            let next = self.expected.get(self.next).map(|expected| &expected.step);
            if self.done != 0.0 || !matches!(next, Some(Step::Contour(_))) {
                return Ok(false);
            }
            self.gathered = Some(Gathered::default());
        }
        let Some(Step::Contour(contour)) =
            self.expected.get(self.next).map(|expected| expected.step.clone())
        else {
            return Ok(false);
        };
        let to = match (path, &event.action) {
            (Some(ArmPath::Line(end)), _) => Some((None, end)),
            (Some(ArmPath::Arc { via, end }), _) => Some((Some(via), end)),
            (Some(ArmPath::Joints(_) | ArmPath::Point(_)), _)
            | (
                None,
                Action::Stop
                | Action::End
                | Action::Tool(_)
                | Action::Dwell(_)
                | Action::Arm(ArmAction::File(_)),
            ) => {
                return self.off_contour(&contour);
            }
            (None, _) => None,
        };
        let (from, at_end) = match to {
            None => (Vec3::ZERO, false),
            Some((_, end)) => {
                let tip = self.in_part(&end).translation;
                let at_end = tip.distance(contour.end.point()) <= ROUNDINGS * self.tip(true);
                let standing = self.standing.map(|standing| self.in_part(&standing.tool));
                let Some(standing) = standing else {
                    return refused(Rule::UnknownPosition, "a contour from where nobody knows");
                };
                (standing.translation, at_end)
            }
        };
        let via = to.and_then(|(via, _)| via).map(|via| self.in_part(&via).translation);
        let to = to.map(|(_, end)| self.in_part(&end).translation);
        let Some(gathered) = &mut self.gathered else { return Ok(false) };
        gathered.events.push(event.clone());
        let Some(to) = to else { return Ok(true) };
        let from = gathered.pieces.last().map_or(from, |last| last.to.tip);
        let axis = contour.end.axis();
        let arc = via.map(|via| in_plane([from, via, to], axis)).transpose()?;
        let place = |tip: Vec3| PartialPose { tip, axis };
        gathered.pieces.push(Piece { line: event.line, from: place(from), to: place(to), arc });
        if at_end {
            self.at_end(&contour)?;
        }
        Ok(true)
    }

    /// The program has come to where the contour ends: that may be its end.
    fn at_end(&mut self, contour: &Contour) -> Outcome {
        let tolerances = &self.report.tolerances;
        let along = ROUNDINGS * tolerances.tip_mm;
        let slack = Slack { along, chord: tolerances.chord_mm, start: Some(along) };
        let Some(gathered) = &mut self.gathered else { return Ok(()) };
        let found =
            centre::compare(&contour.moves, &gathered.pieces, contour.radius, contour.left, slack);
        let most = contour.moves.pieces.len();
        let found = found.and_then(|belongs| one_way_in_and_out(belongs, most, &gathered.pieces));
        let belongs = match found {
            Ok(belongs) => belongs,
            Err(fault) => {
                gathered.tries += 1;
                gathered.fault = Some(fault);
                return match gathered.tries < MOST_TRIES {
                    true => Ok(()),
                    false => self.off_contour(contour).map(drop),
                };
            }
        };
        let Some(Gathered { events, pieces, .. }) = self.gathered.take() else { return Ok(()) };
        let axis = contour.end.axis();
        let steps = pieces.iter().zip(belongs).map(|(piece, of)| {
            let element = contour.elements[of.min(contour.elements.len() - 1)];
            let Element { line, record, state } = element;
            let pose = |place: &PartialPose| Pose::new(place.tip, axis);
            let (from, to) = (pose(&piece.from)?, pose(&piece.to)?);
            let step = match piece.arc {
                Some(arc) => Step::Arc(Box::new(arc), to),
                None => Step::Line(from, to),
            };
            Ok(Expected { line, record, step, state })
        });
        let steps: Vec<Expected> = steps.collect::<Outcome<_>>()?;
        self.expected.splice(self.next..=self.next, steps);
        self.report.compared.contours += 1;
        let at = |found: Box<Diagnostic>, line| match found.line {
            0 => Box::new(found.line(line)),
            _ => found,
        };
        // Each is compared with itself from here on.
        self.follows_contour = true;
        let taken = events
            .iter()
            .try_for_each(|event| self.take(event).map_err(|found| at(found, event.line)));
        self.follows_contour = false;
        taken
    }

    /// # Errors
    /// Always: what was wrong with the contour when it seemed to end, or that it has not been gone along.
    fn off_contour(&mut self, contour: &Contour) -> Outcome<bool> {
        let fault = self.gathered.take().and_then(|gathered| gathered.fault);
        let radius = Number(contour.radius);
        let message = match &fault {
            Some(Fault { how, element, .. }) => {
                let at = element.map(|line| format!(", at the element of source line {line}"));
                format!("with a radius of {radius} mm {how}{}", at.unwrap_or_default())
            }
            None => format!(
                "the program does not lead the tool's centre, with a radius of {radius} mm, along the contour to its end"
            ),
        };
        let line = fault.and_then(|fault| fault.block).unwrap_or_default();
        Err(Diagnostic::error(Rule::Compensation, message).line(line).into())
    }

    /// The program has ended on a contour.
    pub(super) fn ends_on_contour(&mut self) -> Outcome {
        match self.expected.get(self.next).map(|expected| expected.step.clone()) {
            Some(Step::Contour(contour)) if self.gathered.is_some() => {
                self.off_contour(&contour).map(drop)
            }
            _ => Ok(()),
        }
    }
}

/// The way in, and the way out behind the `count` pieces of the contour, are one block each, as the source has them.
fn one_way_in_and_out(
    belongs: Vec<usize>,
    count: usize,
    pieces: &[Piece],
) -> Result<Vec<usize>, Fault> {
    for (of, what) in [(0, "to"), (count, "off")] {
        if let Some((_, piece)) =
            belongs.iter().zip(pieces).filter(|(belongs, _)| **belongs == of).nth(1)
        {
            let message = format!("the way {what} the contour has a further point");
            return Err(Fault::at_block(piece.line, message));
        }
    }
    Ok(belongs)
}

/// Where a motion of the arm goes.
fn moved(event: &Event) -> Option<ArmPath> {
    let Action::Arm(ArmAction::Move(motion)) = &event.action else { return None };
    Some(motion.path)
}

/// The arc through three points, seen along the tool.
fn in_plane([from, via, to]: [Vec3; 3], axis: Vec3) -> Outcome<Arc> {
    let flat = |point: Vec3| point - axis * (point - from).dot(axis);
    arc_through([from, flat(via), flat(to)])
}
