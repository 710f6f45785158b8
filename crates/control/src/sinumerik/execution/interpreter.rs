//! A block is carried out.
//!
//! Order within a block: assignments and G commands; then tool, offset, feed, spindle and coolant
//! (auxiliary functions come before the motion, Function Manual H2); then the motion; then the hole of
//! a modal cycle; then stops and the end of the program (`M0 M1 M2 M17 M30` come after the motion).

use super::state::State;
use super::state::modal::{Drilling, Modal, Pause};
use crate::event::{Action, Event, FeedPath, Risk};
use crate::kernel::Channel;
use crate::kernel::Outcome;
use crate::kernel::compensation::Terms;
use crate::kernel::coolant::{Coolants, Doubtful};
use crate::kernel::corner::Element;
use crate::kernel::source::Source;
use crate::sinumerik::language::axis::AXIS_NAMES;
use crate::sinumerik::language::block::{Block, Coordinate, Corner, Count, ToolCall};
use crate::sinumerik::language::call::{Argument, Call, Procedure};
use crate::sinumerik::language::commands::{self, Code, Diameter, FeedType, Motion};
use crate::sinumerik::language::value::Value;
use crate::sinumerik::language::variables::{AssignmentTarget, ELEMENTS_IN_A_TURN};
use crate::sinumerik::models::Facts;
use crate::{Settings, StartModes};
use program::{
    Auxiliary, Compensation, Coolant, CoolantSwitch, Cycle, Diagnostic, Feed, Rule, Spindle, Tool,
};

/// Runs blocks.
pub(crate) struct Interpreter<'a, 's> {
    /// What is remembered.
    pub state: State,
    /// The machine.
    pub settings: &'a Settings,
    /// Where the events go.
    channel: &'a mut Channel<'s>,
    /// The line of the main program that events carry, where another file runs.
    pub line: Option<u32>,
    /// Whether a called program runs.
    pub called: bool,
    /// Whether the sink has stopped the run.
    pub stopped: bool,
    /// The block whose corner waits for the next one.
    pub held: Option<Box<WaitingCorner>>,
    pub(super) reported_cycle: Option<Cycle>,
}

/// The kinds of machining of `CYCLE832` by their names (SINUMERIK ONE 12/2019, p. 1108; those behind the first also with `_ORI`).
const PRECISIONS: [&str; 5] = ["_OFF", "_FINISH", "_SEMIFIN", "_ROUGH", "_PRECISION"];

/// M functions of which a block has at most one, and those that stand for no motion at all.
const STOPS: &[u32] = &[0, 1, 2, 17, 30];
/// The G group of what F counts on a compensated contour.
const CONTOUR_FEED: usize = 16;
/// Back to the program that has called.
const RETURN: u32 = 17;
const SPINDLE: &[u32] = &[3, 4, 5];
const COOLANT: &[u32] = &[7, 8, 9];
/// The control chooses the gear of the spindle itself; gears 1 to 5.
const AUTOMATIC_GEAR: u32 = 40;
const GEARS: std::ops::RangeInclusive<u32> = 41..=45;

/// `M70`: the spindle becomes an axis. It is not followed.
const SPINDLE_AS_AXIS: u32 = 70;

/// Whether an M function is the control's own, and not one of the builder's.
fn is_own(m: u32) -> bool {
    matches!(m, 6 | 19 | AUTOMATIC_GEAR)
        || [STOPS, SPINDLE, COOLANT].iter().any(|group| group.contains(&m))
        || GEARS.contains(&m)
}

/// Why a block that switches or leaves on a coolant is refused.
fn refused(source: &Source, doubt: Doubtful) -> Box<Diagnostic> {
    let mut error = source.block_error(Rule::Coolant, doubt.message);
    error.help = doubt.help;
    error
}

/// A block whose corner waits for the next one.
pub(crate) struct WaitingCorner {
    pub(super) element: Element,
    pub(super) corner: Corner,
    /// Whether every block has such a corner (`RNDM`), so that there need not be one here.
    pub(super) modal: bool,
    pub(super) feed: Option<f64>,
    pub(super) line: u32,
    /// What has been said since.
    pub(super) between: Vec<Event>,
}

impl<'a, 's> Interpreter<'a, 's> {
    /// At the start of a program.
    pub fn new(
        facts: &'static Facts,
        settings: &'a Settings,
        channel: &'a mut Channel<'s>,
    ) -> Interpreter<'a, 's> {
        Interpreter {
            state: State::new(facts, settings),
            settings,
            channel,
            line: None,
            called: false,
            stopped: false,
            held: None,
            reported_cycle: None,
        }
    }

    /// Reports what happens.
    #[inline]
    pub fn emit(&mut self, source: &Source, action: Action) -> Outcome {
        if self.state.sure != StartModes::SURE {
            self.lean_on_start(source, &action)?;
        }
        let event = Event { line: self.line.unwrap_or(source.line), action };
        if self.held.is_some() { self.keep(source, event) } else { self.send(event) }
    }

    /// Reports, once each, modes that `action` leans on and no block has said.
    #[cold]
    fn lean_on_start(&mut self, source: &Source, action: &Action) -> Outcome {
        let moves = action.position().is_some();
        if moves {
            self.lean_on(source, 14, |sure| &mut sure.absolute, Risk::START_DISTANCE)?;
            self.lean_on(source, 13, |sure| &mut sure.metric, Risk::START_UNITS)?;
        }
        let asks = self.settings.setup.purpose.asks_technology();
        if asks && moves && !matches!(action, Action::Rapid(_)) {
            self.lean_on(source, 15, |sure| &mut sure.feed_per_minute, Risk::START_FEED)?;
        }
        let turns = matches!(action, Action::Arc(_) | Action::Hole(_) | Action::Swivel(_));
        let compensates = self.state.compensation != Compensation::Off;
        if turns || moves && compensates {
            self.lean_on_plane(source)?;
        }
        if moves && self.has_lengths_by_plane() {
            self.lean_on(source, 6, |sure| &mut sure.plane_xy, Risk::START_LENGTH_PLANE)?;
        }
        Ok(())
    }

    /// Reports, once, that the plane counts and no block has said it.
    pub fn lean_on_plane(&mut self, source: &Source) -> Outcome {
        self.lean_on(source, 6, |sure| &mut sure.plane_xy, Risk::START_PLANE)
    }

    /// Reports `risk`, once, where no block has said a mode that counts: the one of this G group.
    fn lean_on(
        &mut self,
        source: &Source,
        group: usize,
        mode: fn(&mut StartModes) -> &mut bool,
        risk: Risk,
    ) -> Outcome {
        let was_sure = std::mem::replace(mode(&mut self.state.sure), true);
        if was_sure || self.state.said[group] != 0 {
            return Ok(());
        }
        self.emit(source, Action::Risk(risk.into()))
    }

    /// Whether the plane says along which axis the length of the tool counts, or, under `TRAORI`, how the tool stands in its head: its
    /// basic orientation stands on the plane, and SD42940 keeps both along Z (W1 11/2006 p. 129, 130).
    fn has_lengths_by_plane(&self) -> bool {
        let counts = self.state.edge.is_some() || self.state.tool_center;
        counts && self.settings.length_along_z != Some(true)
    }

    #[inline]
    pub fn send(&mut self, event: Event) -> Outcome {
        self.channel.take(event).inspect_err(|_| self.stopped = true)
    }

    /// Reports that compensation changes with the move that follows.
    pub fn switch(&mut self, source: &Source, side: Compensation, terms: Terms) -> Outcome {
        let line = self.line.unwrap_or(source.line);
        if self.held.is_some() {
            return self.keep(source, Event { line, action: Action::Compensation(side) });
        }
        self.channel.switch(line, side, terms).inspect_err(|_| self.stopped = true)
    }

    /// Turns of loops, jumps and calls, of which there may not be too many between two events.
    pub fn spend(&mut self, source: &Source, turns: usize) -> Outcome {
        self.channel
            .budget
            .spend(turns)
            .map_err(|message| source.block_error(Rule::Endless, message))
    }

    /// So many bytes are read, again or in a called program.
    pub fn reads(&mut self, source: &Source, bytes: usize) -> Outcome {
        self.channel
            .budget
            .read(bytes)
            .map_err(|message| source.block_error(Rule::Endless, message))
    }

    /// Sets what a block or a loop assigns to.
    pub fn assign(&mut self, source: &Source, place: AssignmentTarget, value: Value) -> Outcome {
        self.state.assign(place, value);
        match place {
            AssignmentTarget::WorkOffset(..) => {
                self.emit(source, Action::Risk(Risk::OPERATOR_DATA.into()))
            }
            AssignmentTarget::Parameter(index) if self.is_operators(index) => {
                self.emit(source, Action::Risk(Risk::OPERATOR_PARAMETER.into()))
            }
            AssignmentTarget::Parameter(_) | AssignmentTarget::Element(..) => Ok(()),
        }
    }

    /// Whether the operator sets R parameter `index` at the machine.
    fn is_operators(&self, index: usize) -> bool {
        self.settings.operator_parameters.iter().any(|own| *own as usize == index)
    }

    /// Carries out a block.
    pub fn run(&mut self, source: &Source, block: &mut Block) -> Outcome {
        if let Some(comment) = block.comment.take() {
            self.emit(source, Action::Comment(comment.into()))?;
        }
        if !block.any {
            return Ok(());
        }
        self.settings.setup.flatten(&mut self.state.position);
        self.settings.setup.flatten(&mut self.state.programmed);
        if !block.assigned.is_empty() {
            self.spend(source, block.assigned.len() / ELEMENTS_IN_A_TURN)?;
            for (place, value) in block.assigned.drain(..) {
                self.assign(source, place, value)?;
            }
        }
        if let Some(message) = block.message.take() {
            self.emit(source, Action::Message(message.into()))?;
        }
        if self.held.is_some() && block.changes_frame() {
            self.release(source)?;
        }
        if let Some(call) = block.call.take() {
            return self.call(source, block, &call);
        }
        if block.m[0].is_some() {
            self.check_m(source, block)?;
        }
        self.modes(source, block)?;
        if let Some(degrees) = block.orientation_tolerance {
            self.state.smoothed.turn(degrees);
            self.hold_orientation(source, degrees)?;
        }
        if let Some(rare) = &block.rare {
            self.tolerances(source, rare.tolerances)?;
            if rare.is_dynamic {
                self.emit(source, Action::Risk(Risk::AXIS_DYNAMICS.into()))?;
            }
            if let Some(radius) = rare.modal_round {
                self.state.modal_round = radius.max(0.0) * self.state.unit;
            }
            self.state.corner_feed = rare.modal_corner_feed.or(self.state.corner_feed);
            self.feed_reference(source, rare.feed_reference)?;
        }
        // What the builder has added, before the motion; a gear that its machine's file lists does something there.
        for m in block.m.iter().flatten() {
            let is_gear = GEARS.contains(m) || *m == AUTOMATIC_GEAR;
            if self.settings.auxiliary.contains(m) && (!is_own(*m) || is_gear) {
                self.emit(source, Action::Auxiliary(Auxiliary::of(*m)))?;
            } else if GEARS.contains(m) {
                self.emit(source, Action::Risk(Risk::GEAR.into()))?;
            }
        }
        match block.code(3) {
            Some(Code::Frame(command)) => return self.frame_command(source, block, command),
            Some(Code::Pole(origin)) => return self.pole(source, block, origin),
            Some(Code::Limit(upper)) => return self.limit(source, block, upper),
            _ => {}
        }
        match block.code(2) {
            Some(Code::Dwell) => return self.dwell(source, block),
            Some(Code::FloatingTap) => {
                self.technology(source, block)?;
                self.lean_on_edge(source)?;
                self.emit(source, Action::Risk(Risk::OPERATOR_CONTROLS.into()))?;
                self.floating_tap(source, block)?;
            }
            Some(Code::Home) => {
                self.technology(source, block)?;
                self.approach_fixed_point(source, block)?;
            }
            _ => {
                self.technology(source, block)?;
                if self.state.plane_normal != 2
                    && self.has_lengths_by_plane()
                    && block.axes[..3].iter().any(Option::is_some)
                {
                    self.emit(source, Action::Risk(Risk::LENGTH_PLANE.into()))?;
                }
                if !self.state.edge_is_known {
                    self.hold_edge(source, block)?;
                }
                if self.state.smoothed.is_loose() {
                    self.hold_smoothing(source, block)?;
                }
                if self.state.smoothed.turns_unsaid() && self.state.tool_center {
                    self.hold_unsaid_turn(source, block)?;
                }
                self.motion(source, block)?;
            }
        }
        self.stops(source, block)
    }

    fn check_m(&self, source: &Source, block: &Block) -> Outcome {
        let ones = |is: &dyn Fn(u32) -> bool| block.m.iter().flatten().filter(|m| is(**m)).count();
        if ones(&|m| STOPS.contains(&m)) > 1
            || ones(&|m| SPINDLE.contains(&m)) > 1
            || ones(&|m| self.coolant_of(m).is_some()) > 1
        {
            let message = "two M functions of one kind in a block contradict each other";
            return Err(source.block_error(Rule::ModalGroup, message));
        }
        for m in block.m.iter().flatten() {
            let is_coolant = self.settings.coolant.switch(*m).is_some();
            if is_coolant && (is_own(*m) && !COOLANT.contains(m) || *m == SPINDLE_AS_AXIS) {
                return Err(refused(source, Doubtful::of_the_control(&format!("M{m}"))));
            }
            let is_known = match COOLANT.contains(m) {
                true => self.coolant_of(*m).is_some(),
                false => is_own(*m) || self.coolant_of(*m).is_some(),
            };
            if !is_known && !self.settings.auxiliary.contains(m) {
                let message = format!("M{m} is not an M function of the control");
                let mut error = source.block_error(Rule::UnknownM, message);
                error.help = "where the builder of the machine has added it and nothing moves for it, list it under `auxiliary` in the \
                              machine's file, or where it switches coolant, under [coolant]"
                    .into();
                return Err(error);
            }
        }
        Ok(())
    }

    /// How compensation leads the tool: `NORM KONT`, `G450 G451`, `DISC=`.
    #[cold]
    fn compensation_terms(&mut self, source: &Source, block: &Block) -> Outcome {
        let state = &mut self.state;
        let before = (state.corner, state.peak, state.goes_around);
        if let Some(Code::Corner(outer)) = block.code(18) {
            state.corner = outer;
        }
        if let Some(Code::Approach { around }) = block.code(17) {
            state.goes_around = around;
        }
        if let Some(peak) = block.rare.as_ref().and_then(|rare| rare.peak) {
            if !(0.0..=100.0).contains(&peak) {
                return Err(source.block_error(Rule::Compensation, "DISC= takes 0 to 100"));
            }
            state.peak = peak > 0.0;
        }
        if state.compensation_in_effect != Compensation::Off
            && before != (state.corner, state.peak, state.goes_around)
        {
            let message = "how the tool goes around corners changes while compensation is active";
            let mut error = source.block_error(Rule::Compensation, message);
            error.help = "write NORM, KONT, G450, G451 and DISC= before or with G41, G42".into();
            return Err(error);
        }
        Ok(())
    }

    /// The modal G commands.
    fn modes(&mut self, source: &Source, block: &Block) -> Outcome {
        for (said, now) in self.state.said.iter_mut().zip(block.groups) {
            *said = if now == 0 { *said } else { now };
        }
        let before = self.state.smoothed.path();
        self.state.smoothed.switch(block);
        self.report_path(source, before)?;
        if block.code(11) == Some(Code::ExactBlock) {
            self.emit(source, Action::Risk(Risk::EXACT_BLOCK.into()))?;
        }
        let turns_loosely =
            [34, 61].iter().any(|&group| block.code(group) == Some(Code::TurnsLoosely(true)));
        if turns_loosely && self.settings.rotary.contains(&true) {
            self.emit(source, Action::Risk(Risk::ORIENTATION_TOLERANCE.into()))?;
        }
        if block.code(28) == Some(Code::WorkArea(false)) {
            self.emit(source, Action::Risk(Risk::WORK_AREA_OFF.into()))?;
        }
        if let Some(Code::RapidsTogether(together)) = block.code(55) {
            self.state.rapids_together = Some(together);
            self.report_rapids(source)?;
        }
        if let Some(Code::Diameter(diameter)) = block.code(29)
            && diameter != Diameter::Off
        {
            self.emit(source, Action::Risk(Risk::DIAMETERS.into()))?;
        }
        let retracts = block.rare.as_ref().is_some_and(|rare| rare.retracts);
        if retracts || matches!(block.code(41), Some(Code::Retract)) {
            self.emit(source, Action::Risk(Risk::STOP_RETRACT.into()))?;
        }
        if let Some(Code::Motion(motion)) = block.code(1) {
            self.state.motion = motion;
        }
        if let Some(Code::Plane(normal)) = block.code(6) {
            let state = &self.state;
            if normal != state.plane_normal && state.compensation != Compensation::Off {
                let message = "the plane changes while cutter radius compensation is active";
                return Err(source.block_error(Rule::Compensation, message));
            }
            if normal != state.plane_normal && self.held.is_some() {
                let message = "the plane changes between the two sides of a corner";
                return Err(source.block_error(Rule::Corner, message));
            }
            self.state.select_plane(normal);
        }
        if block.groups[17] != 0 || block.groups[18] != 0 || block.rare.is_some() {
            self.compensation_terms(source, block)?;
        }
        let state = &mut self.state;
        if let Some(Code::Units(unit, of_feed)) = block.code(13) {
            state.unit = unit;
            // G70 and G71 leave feeds in the basic system, which is metric.
            let feed_unit = if of_feed { unit } else { 1.0 };
            if feed_unit != state.feed_unit {
                state.feed_unit = feed_unit;
                state.feed = None;
            }
        }
        if let Some(Code::Absolute(absolute)) = block.code(14) {
            state.absolute = absolute;
        }
        if let Some(Code::Feed(feed_type)) = block.code(15)
            && feed_type != state.feed_type
        {
            state.feed_type = feed_type;
            state.feed = None;
        }
        if let Some(Code::Diameter(diameter)) = block.code(29) {
            state.diameter = diameter;
        }
        if let Some(Code::VectorsInWorkFrame(in_work_frame)) = block.code(25) {
            state.vectors_in_work_frame = in_work_frame;
            state.turning.in_work_frame = Some(in_work_frame);
        }
        if let Some(Code::GreatCircle(great_circle)) = block.code(51) {
            state.turning.great_circle = Some(great_circle);
        }
        // They delete the rotations of $P_PARTFRAME and $P_TOOLFRAME (function manual K2 09/2011), of which the cycle may make its plane.
        let ends_frame =
            [52, 53].into_iter().any(|group| block.code(group) == Some(Code::FrameOff));
        if ends_frame && state.frames.swivel().is_some() {
            let message = "PAROTOF or TOROTOF in a plane of CYCLE800: it deletes frames by which the cycle may have turned the plane";
            let found = source.block_error(Rule::TiltedPlane, message);
            return Err(Box::new(found.help("write CYCLE800() before it")));
        }
        if let Some(Code::Compensation(compensation)) = block.code(7) {
            self.select_compensation(source, compensation)?;
        }
        self.hold_contour_feed(source, block)?;
        match block.code(8) {
            Some(Code::WorkOffset(number)) => self.work_offset(source, number),
            _ => Ok(()),
        }
    }

    /// Reports where F counts at the centre of a tool that is compensated, in place of its edge: `CFTCP` with all arcs, `CFIN` with
    /// those outside (Fundamentals, "Feed with cutter radius compensation").
    fn hold_contour_feed(&mut self, source: &Source, block: &Block) -> Outcome {
        let switched = block.groups[CONTOUR_FEED] != 0 || block.groups[7] != 0;
        let contour = commands::is_constant_on_contour(self.state.said[CONTOUR_FEED]);
        if !switched || contour || self.state.compensation == Compensation::Off {
            return Ok(());
        }
        self.emit(source, Action::Risk(Risk::FEED_OF_CENTRE.into()))
    }

    /// Says how rapids go where that is news. With a transformation they are straight, whatever `RTLIOF` and MD20730 say (PM19 p. 181;
    /// also with G64, a compressor or G41, which hang on more words than these).
    pub fn report_rapids(&mut self, source: &Source) -> Outcome {
        let together = match self.state.tool_center {
            true => Some(true),
            false => self.state.rapids_together,
        };
        if together == self.state.reported_rapids {
            return Ok(());
        }
        self.state.reported_rapids = together;
        self.emit(source, Action::RapidsTogether(together))
    }

    fn select_compensation(&mut self, source: &Source, compensation: Compensation) -> Outcome {
        if compensation == self.state.compensation {
            return Ok(());
        }
        if !matches!(self.state.motion, Motion::Rapid | Motion::Line) {
            let message = "cutter radius compensation is switched in a block with G0 or G1 \
                           (alarms 10753, 10754)";
            return Err(source.block_error(Rule::Compensation, message));
        }
        self.state.compensation = compensation;
        Ok(())
    }

    /// Tool, offset, feed, spindle, coolant.
    fn technology(&mut self, source: &Source, block: &mut Block) -> Outcome {
        if block.tool.is_some() || block.edge.is_some() || block.has_m(6) {
            self.tool(source, block)?;
        }
        if let Some(feed) = block.feed {
            self.feed(source, feed)?;
        }
        if block.speed.is_some() || block.m[0].is_some() || block.rare.is_some() {
            self.spindle_and_coolant(source, block)?;
        }
        Ok(())
    }

    fn tool(&mut self, source: &Source, block: &mut Block) -> Outcome {
        if let Some(call) = block.tool.take() {
            let tool = match call {
                ToolCall::Number(number) => Tool { number, ..Tool::default() },
                ToolCall::Name(name) => Tool { name, ..Tool::default() },
            };
            // A name has no number to report before the change.
            if !block.has_m(6) && tool.name.is_empty() {
                self.emit(source, Action::Preselect(tool.number))?;
            }
            self.state.selected = Some(Box::new(tool));
        }
        let mut edge = block.edge;
        if block.has_m(6) {
            let Some(tool) = self.state.selected.clone() else {
                return Err(
                    source.block_error(Rule::Tool, "M6 changes the tool, but no T has chosen one")
                );
            };
            let allowed = self.coolants().allow_change(self.state.coolant);
            allowed.map_err(|doubt| refused(source, doubt))?;
            if self.state.coolant != Coolant::Off {
                self.emit(source, Action::Risk(Risk::CHANGE_RUNNING.into()))?;
            }
            self.state.tool = Some(tool.clone());
            self.emit(source, Action::Tool(tool))?;
            self.report_spindle(source, Spindle::Off)?;
            self.report_coolant(source, Coolant::Off)?;
            // Which edge counts unless the block says one, MD20270 decides; as delivered the first.
            let stated = edge.or(self.settings.edge_at_change);
            self.state.edge_is_known = stated.is_some();
            edge = stated.or(Some(1));
        }
        if let Some(number) = edge {
            self.state.edge_is_known |= block.edge.is_some();
            let active = (number > 0).then_some(number);
            if active != self.state.edge || block.has_m(6) {
                self.state.edge = active;
                self.emit(source, Action::LengthOffset(active))?;
            }
        }
        Ok(())
    }

    /// Reports a motion of a tool whose edge no `D` has said since the change: along the axis of its length, compensated, or where
    /// all axes take part in the length. Once for each change.
    #[cold]
    fn hold_edge(&mut self, source: &Source, block: &Block) -> Outcome {
        let along = self.state.plane_normal;
        let positioned = block.rare.as_ref().and_then(|rare| rare.positioned[along]);
        let lengthwise = block.axes[along].or(positioned).is_some();
        let in_plane = !self.state.frames.moved_only() || self.state.tool_center;
        let moves = block.has_position() || block.has_arc_word() || positioned.is_some();
        let compensated = self.state.compensation != Compensation::Off;
        let leans = lengthwise || block.has_arc_word() || in_plane || compensated;
        match moves && leans && block.groups[9] == 0 {
            true => self.lean_on_edge(source),
            false => Ok(()),
        }
    }

    /// Reports that what follows leans on the edge that MD20270 makes active.
    pub fn lean_on_edge(&mut self, source: &Source) -> Outcome {
        if self.state.edge_is_known || self.state.tool.is_none() {
            return Ok(());
        }
        // It goes on as a control that is set up as delivered.
        self.state.edge_is_known = true;
        self.emit(source, Action::Risk(Risk::EDGE_AS_SET_UP.into()))
    }

    fn feed(&mut self, source: &Source, value: f64) -> Outcome {
        if value <= 0.0 {
            let message = "the feed must be above 0 (alarm 14800)";
            return Err(source.block_error(Rule::Feed, message));
        }
        let state = &mut self.state;
        let unit = if state.feed_type == FeedType::InverseTime { 1.0 } else { state.feed_unit };
        state.feed = Some(value * unit);
        if state.active_feed() != state.reported_feed {
            self.report_feed(source)?;
        }
        Ok(())
    }

    fn report_feed(&mut self, source: &Source) -> Outcome {
        self.state.reported_feed = self.state.active_feed();
        match self.state.reported_feed {
            Some(feed) => self.emit(source, Action::Feed(feed)),
            None => Ok(()),
        }
    }

    /// Says that the feed has been used by a motion; in inverse time it holds for one block only.
    pub fn use_feed(&mut self, source: &Source) -> Outcome {
        if self.state.feed.is_none() {
            if !self.settings.setup.purpose.asks_technology() {
                return Ok(());
            }
            let mut error = source.block_error(Rule::NoFeed, "there is no feed (alarm 10860)");
            error.help = "give F: once after G94 or G95, in every block under G93".into();
            return Err(error);
        }
        if let Some(Feed::InverseTime(_)) = self.state.reported_feed {
            self.state.feed = None;
            self.state.reported_feed = None;
        }
        Ok(())
    }

    fn spindle_and_coolant(&mut self, source: &Source, block: &Block) -> Outcome {
        if let Some(speed) = block.speed {
            if speed < 0.0 {
                return Err(
                    source.block_error(Rule::Spindle, "the speed of the spindle has no sign")
                );
            }
            self.state.speed = Some(speed);
        }
        let spindle = match block.m.iter().flatten().find(|m| SPINDLE.contains(m)) {
            Some(3) => Spindle::Clockwise(self.given_speed(source)?),
            Some(4) => Spindle::CounterClockwise(self.given_speed(source)?),
            Some(_) => Spindle::Off,
            None => match self.state.spindle {
                Spindle::Off => Spindle::Off,
                Spindle::Clockwise(before) => {
                    Spindle::Clockwise(self.state.speed.unwrap_or(before))
                }
                Spindle::CounterClockwise(before) => {
                    Spindle::CounterClockwise(self.state.speed.unwrap_or(before))
                }
            },
        };
        let positioned = block.rare.as_ref().is_some_and(|rare| rare.spindle_position.is_some());
        let spindle = if positioned || block.has_m(19) { Spindle::Off } else { spindle };
        self.report_spindle(source, spindle)?;
        let Some(switch) = block.m.iter().flatten().find_map(|m| self.coolant_of(*m)) else {
            return Ok(());
        };
        let coolant = self.coolants().behind(self.state.coolant, switch);
        self.report_coolant(source, coolant.map_err(|doubt| refused(source, doubt))?)
    }

    /// How the coolants of the machine go with each other: each of M7 and M8 switches its own, M9 both.
    fn coolants(&self) -> Coolants {
        Coolants { functions: self.settings.coolant, adds: true, ends_through: None }
    }

    /// What an M function does with the coolant: as the machine's file says, or M7, M8 and M9 where it does not.
    fn coolant_of(&self, m: u32) -> Option<CoolantSwitch> {
        let stated = self.settings.coolant;
        let usual = match m {
            7 => Some(CoolantSwitch::Mist),
            8 => Some(CoolantSwitch::Flood),
            9 => Some(CoolantSwitch::Off),
            _ => None,
        };
        stated.switch(m).or(usual.filter(|switch| !stated.is_stated(*switch)))
    }

    /// The speed that the program has given, 1/min.
    ///
    /// # Errors
    /// It has given none: the spindle would turn as the program before has left it.
    fn given_speed(&self, source: &Source) -> Outcome<f64> {
        self.state.speed.ok_or_else(|| {
            let message = "the spindle starts and no speed has been given by S";
            let mut error = source.block_error(Rule::Spindle, message);
            error.help = "write S next to M3 or M4, or before".into();
            error
        })
    }

    /// The coolant is this from here on.
    fn report_coolant(&mut self, source: &Source, coolant: Coolant) -> Outcome {
        if coolant == self.state.coolant {
            return Ok(());
        }
        self.state.coolant = coolant;
        self.emit(source, Action::Coolant(coolant))
    }

    /// The spindle does this from here on.
    pub fn report_spindle(&mut self, source: &Source, spindle: Spindle) -> Outcome {
        if spindle == self.state.spindle {
            return Ok(());
        }
        if let Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) = spindle {
            let [low, high] = self.state.speed_limits;
            if !(low..=high).contains(&speed) {
                let message =
                    format!("the speed of {speed} 1/min is not within G25 S{low} and G26 S{high}");
                return Err(source.block_error(Rule::Spindle, message));
            }
        }
        self.state.spindle = spindle;
        self.emit(source, Action::Spindle(spindle))
    }

    /// `G25`, `G26`: limits of the speed of the spindle, and of the work area. Where the tool would leave
    /// that, the control stops; it goes nowhere else.
    fn limit(&mut self, source: &Source, block: &Block, upper: bool) -> Outcome {
        plain_values(source, block)?;
        self.emit(source, Action::Risk(Risk::LIMITS_WRITTEN.into()))?;
        if !block.only_group(3) || block.feed.is_some() || block.has_rotary() {
            let message = format!("{} stands in a block of its own", block.command(3));
            return Err(source.block_error(Rule::Syntax, message));
        }
        if let Some(speed) = block.speed {
            self.state.speed_limits[usize::from(upper)] = speed;
        }
        Ok(())
    }

    fn stops(&mut self, source: &Source, block: &Block) -> Outcome {
        if block.m[0].is_none() {
            return Ok(());
        }
        let stop = block.m.iter().flatten().find(|m| STOPS.contains(m));
        let running = self.state.spindle != Spindle::Off || self.state.coolant != Coolant::Off;
        if running && matches!(stop, Some(0 | 1)) {
            self.emit(source, Action::Risk(Risk::STOP_RUNNING.into()))?;
        }
        match stop {
            Some(0) => self.emit(source, Action::Stop),
            Some(1) => self.emit(source, Action::OptionalStop),
            Some(number) => self.end(source, *number == RETURN),
            None => Ok(()),
        }
    }

    /// The end of a program, by which the main one `returns` to whatever has called it, or ends.
    fn end(&mut self, source: &Source, returns: bool) -> Outcome {
        self.state.ended = true;
        if self.called {
            return Ok(());
        }
        let left_on: Vec<Risk> = self.state.left_on(returns).collect();
        for risk in left_on {
            self.emit(source, Action::Risk(risk.into()))?;
        }
        // MD35040 as delivered; what becomes of the coolant the PLC says.
        if !returns {
            self.report_spindle(source, Spindle::Off)?;
        }
        self.emit(source, Action::End)
    }

    /// `G4`: in a block of its own; its `F` (seconds) and `S` (turns) change neither feed nor speed.
    fn dwell(&mut self, source: &Source, block: &Block) -> Outcome {
        let pause = match (block.feed, block.speed) {
            (Some(seconds), None) => Pause::Seconds(seconds),
            (None, Some(turns)) => Pause::Turns(turns),
            _ => return Err(source.block_error(Rule::Dwell, "G4 needs F (seconds) or S (turns)")),
        };
        if !block.only_group(2) || block.has_position() {
            return Err(source.block_error(Rule::Dwell, "G4 stands in a block of its own"));
        }
        match pause.seconds(self.state.spindle) {
            Some(seconds) if seconds >= 0.0 => self.emit(source, Action::Dwell(seconds)),
            Some(_) => Err(source.block_error(Rule::Dwell, "a dwell has no sign")),
            None => Err(source.block_error(Rule::Dwell, "turns of a spindle that stands")),
        }
    }

    /// A call stands in a block of its own.
    fn call(&mut self, source: &Source, block: &Block, call: &Call) -> Outcome {
        let alone = block.only_group(0)
            && !block.has_position()
            && block.feed.is_none()
            && block.speed.is_none();
        if !alone {
            let message = format!("{} stands in a block of its own", call.name);
            return Err(source.block_error(Rule::Syntax, message));
        }
        match call.procedure {
            Procedure::NoMotion => Ok(()),
            Procedure::Retract => self.emit(source, Action::Risk(Risk::STOP_RETRACT.into())),
            Procedure::Group => group(source, call),
            Procedure::MasterSpindle => match call.number(source, 0)? {
                None | Some(1.0) => Ok(()),
                Some(_) => {
                    let message = "SETMS is not supported: another master spindle than the first";
                    Err(source.block_error(Rule::Unsupported, message))
                }
            },
            Procedure::HighSpeed => self.high_speed(source, call),
            Procedure::FeedGroup => self.feed_group(source, call),
            Procedure::Traori => self.traori(source, call),
            Procedure::Trafoof => self.trafoof(source),
            Procedure::Swivel => self.swivel(source, call),
            Procedure::Return if !call.arguments.is_empty() => {
                let message =
                    "RET with a place or a number of levels goes on elsewhere than behind the call";
                let error = source.block_error(Rule::Call, message);
                Err(error.help("write RET alone").into())
            }
            Procedure::Return => self.end(source, true),
            Procedure::EndOfModalCall => {
                self.may_change_modal(source)?;
                self.state.modal = Modal::None;
                self.cycle_off(source)
            }
            Procedure::Pattern(pattern) => self.pattern(source, call, pattern),
            Procedure::Drill(form) => {
                let drilling = Drilling::read(source, call, form, &self.state)?;
                for risk in &drilling.risks {
                    self.emit(source, Action::Risk((*risk).into()))?;
                }
                if call.modal {
                    self.may_change_modal(source)?;
                    self.state.modal = Modal::Cycle(drilling);
                    return Ok(());
                }
                if self.state.modal.waits() {
                    let message = "a cycle is called while MCALL is active";
                    return Err(source.block_error(Rule::Cycle, message));
                }
                self.drill(source, &drilling)?;
                self.cycle_off(source)
            }
        }
    }

    /// `CYCLE832(S_TOL, S_TOLM, S_OTOL)`: the tolerance of the contour, the kind of machining, and the tolerance of the orientation
    /// where the kind says so (tens 1, `_ORI_FINISH` and its kin), else a version. The older form has a packed second argument that
    /// can switch the transformation too.
    fn high_speed(&mut self, source: &Source, call: &Call) -> Outcome {
        let tolerates_orientation = match call.arguments.get(1) {
            None | Some(Argument::None) => false,
            Some(Argument::Number(kind)) => {
                // Millions say whether Top Surface smooths; tens and units are the kind.
                let (top, kind) = (kind.div_euclid(1e6), kind.rem_euclid(1e6));
                if kind > 9999.0 {
                    let message =
                        "the older form of CYCLE832, which can switch TRAORI, is not supported";
                    return Err(source.block_error(Rule::Unsupported, message));
                }
                let (tens, units) = (kind.div_euclid(10.0), kind.rem_euclid(10.0));
                if kind.fract() != 0.0 || top > 2.0 || tens > 1.0 || units > 4.0 {
                    return Err(unknown_kind(source));
                }
                tens == 1.0
            }
            Some(Argument::Text(name)) => match PRECISIONS.contains(&name.as_str()) {
                true => false,
                false => match name.strip_prefix("_ORI") {
                    Some(rest) if PRECISIONS[1..].contains(&rest) => true,
                    _ => return Err(unknown_kind(source)),
                },
            },
        };
        let tolerance = call.number(source, 0)?.unwrap_or(0.0);
        self.cycle_tolerance(source, call.name, tolerance * self.state.unit)?;
        self.state.smoothed.turn_by_cycle(tolerance > 0.0, tolerates_orientation);
        if !tolerates_orientation {
            return Ok(());
        }
        match call.number(source, 2)? {
            Some(degrees) if degrees > 0.0 => self.hold_orientation(source, degrees),
            _ => {
                let message =
                    "this kind of CYCLE832 needs the tolerance of the orientation, in degrees";
                let mut error = source.block_error(Rule::CycleParameter, message);
                error.help = "CYCLE832(0.01,_ORI_FINISH,0.05), or CYCLE832(0.01,_FINISH,1)".into();
                Err(error)
            }
        }
    }

    /// Tells where the control may turn the tool by so many degrees out of its orientation, which is more than it may.
    fn hold_orientation(&mut self, source: &Source, degrees: f64) -> Outcome {
        let turns = self.settings.rotary.contains(&true);
        if !turns || degrees <= self.settings.orientation_tolerance {
            return Ok(());
        }
        self.emit(source, Action::Risk(Risk::ORIENTATION_TOLERANCE.into()))
    }

    /// Tells where the control keeps the tip, and setting data alone say by how much it may turn the tool: SD55441 to SD55443, ten
    /// times the tolerance of the path as delivered (IM9, "CYCLE832", SINUMERIK ONE).
    #[cold]
    fn hold_unsaid_turn(&mut self, source: &Source, block: &Block) -> Outcome {
        if !block.has_position() && !block.has_arc_word() {
            return Ok(());
        }
        self.state.smoothed.note_unsaid_turn();
        self.emit(source, Action::Risk(Risk::ORIENTATION_TOLERANCE.into()))
    }

    /// `FGROUP(...)`: the axes that F is the speed of. Without one of X, Y, Z the tool would move at
    /// another feed than F wherever that axis takes part.
    fn feed_group(&mut self, source: &Source, call: &Call) -> Outcome {
        let mut named = [false; 6];
        for argument in &call.arguments {
            let name = if let Argument::Text(name) = argument { name.as_str() } else { "" };
            let Some(index) = AXIS_NAMES.iter().position(|axis| *axis == name) else {
                let message = "FGROUP takes the names of axes: FGROUP(X,Y,Z)";
                return Err(source.block_error(Rule::FeedGroup, message));
            };
            if index >= 3 && !self.settings.rotary[index - 3] {
                let message = format!("the machine has no axis {name}");
                return Err(source.block_error(Rule::UnknownAxis, message));
            }
            named[index] = true;
        }
        // FGROUP() goes back to the basic setting: the geometry axes.
        let missing = (0..3).find(|i| !call.arguments.is_empty() && !named[*i]);
        if let Some(missing) = missing {
            let message = format!(
                "FGROUP without {}: F would not be the speed of the tool where that axis moves",
                AXIS_NAMES[missing]
            );
            return Err(source.block_error(Rule::FeedGroup, message));
        }
        let before = self.state.feed_path();
        self.state.feed_group = [named[3], named[4], named[5]];
        self.report_feed_path(source, before)
    }

    /// `FGREF[C]=...`: the radius at which a degree of an axis of the group counts, 57.296 mm as delivered (Programming
    /// Manual Fundamentals, "Feedrate": 1 mm a degree).
    fn feed_reference(&mut self, source: &Source, radii: [Option<f64>; 3]) -> Outcome {
        if radii == [None; 3] {
            return Ok(());
        }
        let before = self.state.feed_path();
        for (counts, radius) in self.state.mm_per_degree.iter_mut().zip(radii) {
            *counts = radius.map_or(*counts, |radius| (radius * self.state.unit).to_radians());
        }
        self.report_feed_path(source, before)
    }

    fn report_feed_path(&mut self, source: &Source, before: FeedPath) -> Outcome {
        match self.state.feed_path() {
            path if path == before => Ok(()),
            path => self.emit(source, Action::FeedPath(path)),
        }
    }
}

fn unknown_kind(source: &Source) -> Box<Diagnostic> {
    let message = "this kind of machining of CYCLE832 is not known";
    let mut error = source.block_error(Rule::CycleParameter, message);
    error.help = "one of _OFF _FINISH _SEMIFIN _ROUGH _PRECISION, or _ORI_FINISH and its kin with a tolerance of the \
                  orientation"
        .into();
    error
}

/// `GROUP_BEGIN(level, text, spindle, retract)`, `GROUP_END(level, retract)`: nothing, unless the control
/// is to retract by itself.
fn group(source: &Source, call: &Call) -> Outcome {
    let plain = |argument: &Argument| match argument {
        Argument::Number(value) => *value == 0.0,
        Argument::None | Argument::Text(_) => true,
    };
    if call.arguments.iter().skip(1).all(plain) {
        return Ok(());
    }
    let message = format!("{} with a way or code of the control's own is not supported", call.name);
    let mut error = source.block_error(Rule::Unsupported, message);
    error.help = "set its arguments behind the level to 0 or a text".into();
    Err(error)
}

/// X, Y and Z of a block, which count neither absolute nor incremental.
pub(super) fn plain_values(source: &Source, block: &Block) -> Outcome<[Option<f64>; 3]> {
    let mut values = [None; 3];
    for (place, coordinate) in values.iter_mut().zip(&block.axes) {
        *place = match coordinate {
            Some(Coordinate { count: Count::Modal, value, .. }) => Some(*value),
            Some(_) => {
                let message = format!("{} takes plain values", block.command(3));
                return Err(source.block_error(Rule::Frame, message));
            }
            None => None,
        };
    }
    Ok(values)
}
