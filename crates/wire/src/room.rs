//! Whether passes and their leads have room between what remains, and which lead would have.

use crate::near::Near;
use crate::offset::EXACT;
use crate::plan::{Opening, Pass, Settings};
use crate::round::{Round, middle};
use cavalier_contours::static_aabb2d_index::Control;
use geom::Vec2;
use program::{Diagnostic, Rule};
use sketch::Element;

/// How near to its own end a lead may touch the upper path of the last pass, mm.
const JOINS: f64 = 0.01;

/// What remains of all openings.
pub(crate) struct Room<'a> {
    /// Their contours on the lower face.
    below: Near<'a>,
    /// Where the wires of their last passes go on the upper face; empty where no wire leans.
    above: Near<'a>,
    leaning: &'a [Element],
    settings: &'a Settings,
}

/// Another lead for an opening.
struct Offer {
    begin: Option<Vec2>,
    length: f64,
}

impl<'a> Room<'a> {
    /// The room between the contours `remaining` and the last paths of wires on the upper face, `leaning`.
    pub fn new(
        remaining: &'a [Element],
        leaning: &'a [Element],
        settings: &'a Settings,
    ) -> Room<'a> {
        Room { below: Near::new(remaining), above: Near::new(leaning), leaning, settings }
    }

    /// The passes of an opening, where they have room.
    ///
    /// # Errors
    /// `cuts-part` and `taper-lead`, with a lead that has room, if one is found.
    pub fn passes(
        &self,
        round: &Round,
        index: usize,
        opening: &Opening,
    ) -> Result<Vec<Pass>, Box<Diagnostic>> {
        self.fitting(round, index, self.settings).map_err(|found| {
            let leads = [Rule::CutsPart, Rule::TaperLead].contains(&found.rule);
            let offers = if leads { self.offers(round, opening) } else { Vec::new() };
            let offer = offers.into_iter().find(|offer| self.has_room(offer, index, opening));
            match offer {
                None => found,
                Some(Offer { begin, length }) => {
                    let begin = begin.map(|p| format!("--begin {:.4},{:.4} ", p.x, p.y));
                    let without = opening.thread.map_or("", |_| " and without --thread");
                    let begin = begin.unwrap_or_default();
                    let way_out = format!("there is room with {begin}--lead {length}{without}");
                    Box::new(found.help(way_out))
                }
            }
        })
    }

    fn fitting(
        &self,
        round: &Round,
        index: usize,
        settings: &Settings,
    ) -> Result<Vec<Pass>, Box<Diagnostic>> {
        let passes = round.passes(index, settings)?;
        for pass in &passes {
            self.unhurt(pass)?;
        }
        round.leads_above(settings).try_for_each(|lead| self.unhurt_above(round, index, &lead))?;
        Ok(passes)
    }

    /// Leads that may do, the nearest to what is asked for first.
    fn offers(&self, round: &Round, opening: &Opening) -> Vec<Offer> {
        let asked = self.settings.lead.length;
        let rounded = |mm: f64| (mm * 10.0).ceil() / 10.0;
        let reach = round.reach(self.settings);
        let longer = [1.1, 1.5, 2.0].map(|more| rounded(reach * more));
        let longer = longer.into_iter().filter(|length| *length > asked);
        let shorter = [0.7, 0.5, 0.3, 0.2].map(|part| rounded(asked * part));
        let shorter = shorter.into_iter().filter(|length| *length < asked && *length >= reach);
        let lengths: Vec<f64> = [asked].into_iter().chain(longer).chain(shorter).collect();
        let begins = [opening.start, Some(middle(&opening.contour).point)];
        let offer = |begin| lengths.iter().map(move |&length| Offer { begin, length });
        begins.into_iter().flat_map(offer).filter(|offer| offer.length > 0.0).collect()
    }

    fn has_room(&self, offer: &Offer, index: usize, opening: &Opening) -> bool {
        let mut settings = self.settings.clone();
        settings.lead.length = offer.length;
        let opening = Opening { thread: None, start: offer.begin, ..opening.clone() };
        let round = Round::new(&opening, &settings);
        round.is_ok_and(|(round, _)| self.fitting(&round, index, &settings).is_ok())
    }

    /// Refuses a pass that comes nearer to any contour than the last one may.
    fn unhurt(&self, pass: &Pass) -> Result<(), Box<Diagnostic>> {
        let last = self.settings.passes.last().map_or(0.0, |cut| self.settings.wire_offset(cut));
        for element in pass.path.lower().elements() {
            if let Some(distance) = self.below.clearance(element, last - EXACT) {
                let lines = pass.path.lower().elements().iter().map(|e| e.line);
                let message = format!(
                    "pass {} of opening {} comes as near as {distance:.4} mm to a contour on its path \
                     from X{:.4} Y{:.4} to X{:.4} Y{:.4}, and the last offset is {last:.4} mm",
                    pass.number + 1,
                    pass.opening + 1,
                    element.start.x,
                    element.start.y,
                    element.end.x,
                    element.end.y
                );
                return Err(Diagnostic::error(Rule::CutsPart, message)
                    .help("thread elsewhere (--thread), start elsewhere (--begin), or take a shorter lead-in (--lead)")
                    .line(lines.into_iter().find(|line| *line > 0).unwrap_or_default())
                    .into());
            }
        }
        Ok(())
    }

    /// Refuses a lead whose upper end cuts into what remains of any opening on the upper face, and one that begins there.
    fn unhurt_above(
        &self,
        round: &Round,
        index: usize,
        lead: &[Element],
    ) -> Result<(), Box<Diagnostic>> {
        let end = lead.last().map_or(Vec2::ZERO, |element| element.end);
        let mut place = round.threads_in_part().then(|| round.thread());
        for element in lead {
            self.above.around(element, 0.0, &mut |i| {
                let meets =
                    self.leaning.get(i).into_iter().flat_map(|other| other.meets(element, 0.0));
                place = place.or(meets.into_iter().find(|at| at.distance(end) > JOINS));
                if place.is_some() { Control::Break(()) } else { Control::Continue }
            });
        }
        let Some(at) = place else { return Ok(()) };
        let message = format!(
            "the lead-in of opening {} cuts into the part on its upper face, at X{:.4} Y{:.4}: there the wire leans towards where \
             it is threaded",
            index + 1,
            at.x,
            at.y
        );
        let help = format!(
            "thread the wire more than {:.4} mm from the contour, where there is room",
            round.reach(self.settings)
        );
        Err(Diagnostic::error(Rule::TaperLead, message).help(help).into())
    }
}
