//! What is still on where a program ends. The next program takes it as off when it starts, and so the proof does
//! (`docs/proof.md`, "What a program finds, and what it leaves").

use super::state::State;
use super::state::modal::Modal;
use crate::event::Risk;
use crate::sinumerik::language::commands::{DELIVERED, Delivered, Diameter, FeedType};
use geom::Frame;
use program::Compensation;

const PLANE: Risk = Risk::left_on("ends in another plane than G17", "write G17 before the end");
const INCREMENTAL: Risk = Risk::left_on(
    "ends with G91, from which the next one would count on",
    "write G90 before the end",
);
const FEED_TYPE: Risk =
    Risk::left_on("ends with another feed than G94", "write G94 before the end");
const INCHES: Risk = Risk::left_on("ends with G70 or G700", "write G710 before the end");
const DIAMETER: Risk = Risk::left_on("ends with X as a diameter", "write DIAMOF before the end");
const COMPENSATION: Risk =
    Risk::left_on("ends with radius compensation", "write G40 with a straight move before the end");
const PROGRAMMABLE: Risk = Risk::left_on(
    "ends with a programmable frame (TRANS, ROT, SCALE, MIRROR, G58, G59)",
    "write TRANS alone in a block before the end",
);
const SWIVEL: Risk = Risk::left_on("ends in a swivelled plane", "write CYCLE800() before the end");
const TOOL_CENTER: Risk =
    Risk::left_on("ends while the control keeps the tool tip", "write TRAFOOF before the end");
const MODAL_CALL: Risk = Risk::left_on(
    "ends with a cycle or a program that is called after each move",
    "write MCALL before the end",
);
const FEED_GROUP: Risk = Risk::left_on(
    "ends with rotary axes in the feed group, by which F would count in the next one too",
    "write FGROUP() before the end",
);
const FEED_REFERENCE: Risk = Risk::left_on(
    "ends with another radius for the feed of a rotary axis (FGREF)",
    "write FGREF of the axis with 57.296 mm (57.29577951308232) before the end",
);
const ROUNDING: Risk = Risk::left_on("ends with RNDM", "write RNDM=0 before the end");
const CORNER_FEED: Risk =
    Risk::left_on("ends with a feed of corners (FRCM)", "write FRCM=0 before the end");
const TOLERANCE: Risk = Risk::left_on(
    "ends with a tolerance or a distance by which the control leaves the path (CYCLE832, CTOL, OTOL, ADIS, ADISPOS)",
    "write CYCLE832(0,_OFF,1), CTOL=-1, OTOL=-1, ADIS=0 or ADISPOS=0 before the end",
);
const PEAK: Risk = Risk::left_on("ends with DISC above 0", "write DISC=0 before the end");
const PREPARED: Risk = Risk::left_on(
    "goes back to its caller with a tool that is chosen and not changed, which the next M6 takes",
    "leave T out, or change the tool",
);
const TOOL_DOWN: Risk = Risk::left_on(
    "goes back to its caller where Z has not been home since the last move",
    "send Z home before the end (SUPA, G74, G75)",
);

impl State {
    /// What the end of the program leaves on. At `M2` and `M30` machine data decide what of it is gone: MD20110 and MD20152 for the G
    /// groups and transformations, MD24006 and MD24010 for the frames. Where it `returns` (`M17`, `RET`), nothing is reset.
    pub(super) fn left_on(&self, returns: bool) -> impl Iterator<Item = Risk> {
        let chosen = self.selected.is_some() && self.selected != self.tool;
        let found = [
            (self.plane_normal != 2, PLANE),
            (!self.absolute, INCREMENTAL),
            (self.feed_type != FeedType::PerMinute, FEED_TYPE),
            (self.unit != 1.0 || self.feed_unit != 1.0, INCHES),
            (self.diameter != Diameter::Off, DIAMETER),
            (self.compensation != Compensation::Off, COMPENSATION),
            (self.frames.programmable() != Frame::IDENTITY, PROGRAMMABLE),
            (self.frames.swivel().is_some(), SWIVEL),
            (self.tool_center, TOOL_CENTER),
            (!matches!(self.modal, Modal::None), MODAL_CALL),
            (self.feed_group != [false; 3], FEED_GROUP),
            (self.mm_per_degree != [1.0; 3], FEED_REFERENCE),
            (self.modal_round > 0.0, ROUNDING),
            (self.corner_feed.is_some_and(|feed| feed > 0.0), CORNER_FEED),
            (self.smoothed.is_programmed(), TOLERANCE),
            (self.peak, PEAK),
            (returns && chosen, PREPARED),
            (returns && !self.position.z.is_nan(), TOOL_DOWN),
        ];
        let found = found.into_iter().filter_map(|(is_on, risk)| is_on.then_some(risk));
        let said = |group: &&Delivered| !group.allows(self.said[usize::from(group.group)]);
        found.chain(DELIVERED.iter().filter(said).map(|group| group.risk))
    }
}
