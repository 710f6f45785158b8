//! One block, in the order in which a control executes it.

use super::state::State;
use crate::event::{Action, Risk};
use crate::iso::dialects::facts::{AtEnd, Facts};
use crate::iso::language::Fault;
use crate::iso::language::block::Block;
use crate::iso::language::words::{FeedMode, G, Group, M, Motion, Path, Plane, Side};
use crate::kernel::coolant::{Coolants, Doubtful};
use crate::{Settings, StartModes, WholeNumbers};
use program::Rule;
use program::{Coolant, CoolantSwitch, PathMode, Spindle, WorkOffset};

/// A virtual control: its dialect, its axes and its state.
#[derive(Debug)]
pub(crate) struct Control {
    pub facts: &'static Facts,
    /// Which of A, B, C exist.
    pub axes: [bool; 3],
    pub whole_numbers: WholeNumbers,
    pub coolants: Coolants,
    pub state: State,
}

/// A block in the making: the control's rules, the state as it changes, the events so far.
pub(super) struct Step<'s, 'b, 't> {
    pub facts: &'static Facts,
    pub axes: [bool; 3],
    pub whole_numbers: WholeNumbers,
    pub coolants: &'s Coolants,
    pub state: &'s mut State,
    pub block: &'b mut Block<'t>,
    pub actions: &'s mut Vec<Action>,
}

impl Control {
    /// The control of `settings` at the start of a program.
    pub(crate) fn new(settings: &Settings, facts: &'static Facts) -> Control {
        let axes = if facts.reset.three_axes { [false; 3] } else { settings.rotary };
        let whole_numbers = match facts.numbers.point_counts {
            true => settings.setup.whole_numbers,
            false => WholeNumbers::Units,
        };
        let coolants = Coolants {
            functions: settings.coolant,
            adds: !facts.functions.builders,
            ends_through: facts.functions.ends_through,
        };
        Control { facts, axes, whole_numbers, coolants, state: State::new(facts, axes, settings) }
    }

    /// # Errors
    /// A NURBS is open, along which the tool has not gone.
    pub(crate) fn ends_no_curve(&self) -> Result<(), &'static str> {
        match self.state.nurbs {
            None => Ok(()),
            Some(_) => Err("the program ends between G5.2 and G5.3"),
        }
    }

    /// Executes `block` and puts its events into `actions`.
    ///
    /// # Errors
    /// The block means nothing, or is not legal here: the run ends with it.
    pub(crate) fn execute(
        &mut self,
        block: &mut Block,
        actions: &mut Vec<Action>,
    ) -> Result<(), Fault> {
        let Control { facts, axes, whole_numbers, coolants, state } = self;
        let (facts, axes, whole_numbers) = (*facts, *axes, *whole_numbers);
        if state.flat && state.position.z.is_nan() {
            state.position.z = 0.0;
        }
        Step { facts, axes, whole_numbers, coolants, state, block, actions }.run()
    }
}

impl Step<'_, '_, '_> {
    /// The order is that of LinuxCNC ("Order of Execution") and GRBL (`gcode.c`, steps 1 to 21), which
    /// is that of RS274/NGC 3.8. FANUC leaves the moment of an M function to the builder of the
    /// machine: what could matter there is refused.
    fn run(&mut self) -> Result<(), Fault> {
        // What is left out where it only moves acts on G and M words of other groups, and on other letters.
        let more = !self.block.only_moves();
        let before = self.actions.len();
        self.one_command()?;
        self.inside_nurbs()?;
        self.wire()?;
        if more {
            self.m_functions_with_motion()?;
        }
        self.feed()?;
        if more {
            self.speed()?;
        }
        self.tool()?;
        self.keeps_dynamic_offset()?;
        if more {
            self.spindle_and_coolant()?;
            self.neutral_m()?;
            self.kinematics()?;
            self.dwell()?;
            self.modes()?;
            self.dynamic_offset()?;
        }
        self.motion()?;
        self.holds_suspended_length();
        if self.state.sure != StartModes::SURE {
            self.lean_on_start(before);
        }
        // A contour that a wire cuts, or a picture, may lie anywhere.
        if self.state.frames.unsaid != 0 && self.state.purpose.asks_technology() {
            self.lean_on_offset(before);
        }
        if more {
            self.flow()?;
        }
        self.block.all_taken()
    }

    /// Reports, once each, modes that the events from `first` on lean on and nobody has said.
    #[cold]
    fn lean_on_start(&mut self, first: usize) {
        let says = |group| self.block.g(group).is_some();
        let said = StartModes {
            plane_xy: says(Group::Plane),
            absolute: says(Group::Distance),
            feed_per_minute: says(Group::FeedMode),
            centers_from_start: says(Group::ArcDistance),
            metric: true,
            returns_up: says(Group::Return),
            first_offset: true,
        };
        self.state.sure = self.state.sure.or(said);
        let sure = &mut self.state.sure;
        let events = self.actions.get(first..).unwrap_or_default();
        let any = |is: fn(&Action) -> bool| events.iter().any(is);
        let moves = any(|event| event.position().is_some() || matches!(event, Action::Probe(_)));
        let cuts = self.state.purpose.asks_technology()
            && any(|event| {
                matches!(
                    event,
                    Action::Line(_) | Action::Arc(_) | Action::Hole(_) | Action::Probe(_)
                )
            });
        let polar = self.state.polar.is_some() || b"@^".iter().any(|sign| self.block.gives(*sign));
        let turns = moves && polar
            || self.block.corner.is_some()
            || self.block.g(Group::Tilt) == Some(G::Turn)
            || any(|event| {
                matches!(
                    event,
                    Action::Arc(_)
                        | Action::Hole(_)
                        | Action::Compensation(
                            program::Compensation::Left(_) | program::Compensation::Right(_)
                        )
                )
            });
        // A length counts along the axis that stood on the plane when it began.
        let lengthens = self.facts.tools.length_as_set_up
            && self.state.length_along_z != Some(true)
            && any(|event| matches!(event, Action::LengthOffset(Some(_))));
        let by_center = b"IJK".iter().any(|letter| self.block.gives(*letter))
            && any(|event| matches!(event, Action::Arc(_)));
        let drills = any(|event| matches!(event, Action::Hole(_)));
        let plane = if turns { Risk::START_PLANE } else { Risk::START_LENGTH_PLANE };
        for (leans, sure, risk) in [
            (by_center, &mut sure.centers_from_start, Risk::START_CENTERS),
            (moves, &mut sure.absolute, Risk::START_DISTANCE),
            (cuts, &mut sure.feed_per_minute, Risk::START_FEED),
            (turns || lengthens, &mut sure.plane_xy, plane),
            (drills, &mut sure.returns_up, Risk::START_RETURN),
        ] {
            if leans && !std::mem::replace(sure, true) {
                self.actions.push(Action::Risk(risk.into()));
            }
        }
    }

    /// Reports, once, that an event from `first` on goes to a place that counts from a zero of which nobody has said where it lies.
    #[cold]
    fn lean_on_offset(&mut self, first: usize) {
        let mut events = self.actions.get(first..).unwrap_or_default().iter();
        let goes =
            events.any(|event| event.position().is_some() || matches!(event, Action::Probe(_)));
        let named = (0..6).filter(|&axis| self.block.gives(b"XYZABC"[axis]));
        let named = named.fold(0, |bits, axis| bits | 1 << axis);
        // A place of the machine counts from its own zero.
        let leans = goes
            && self.block.g(Group::OneShot) != Some(G::Machine)
            && self.state.frames.unsaid & named != 0;
        if leans {
            self.state.frames.unsaid = 0;
            let homing = self.facts.offsets.homing_takes_away;
            let risk = if homing { Risk::MACHINE_ZERO } else { Risk::START_OFFSET };
            self.actions.push(Action::Risk(risk.into()));
        }
    }

    /// Marlin takes the first command of a line and what follows as its parameters; a line without one
    /// means nothing to it (`GCODE_MOTION_MODES` as delivered).
    fn one_command(&mut self) -> Result<(), Fault> {
        if !self.facts.syntax.one_command {
            return Ok(());
        }
        self.state.motion = None;
        // G53 stands before the move that it is for.
        let others = self.block.g(Group::OneShot) == Some(G::Machine);
        let commands = self.block.commands() + usize::from(self.block.has(b'T'));
        if commands > 1 + usize::from(others) {
            let message = "this control takes one command a line";
            return Err(self.block.whole(Rule::ManyCommands, message));
        }
        Ok(())
    }

    /// FANUC runs one M function a block (parameter 3404, bit 7, as delivered), and only the builder
    /// says whether it comes before or after the motion of its block.
    fn m_functions_with_motion(&mut self) -> Result<(), Fault> {
        if self.block.m_count == 0 || !self.facts.functions.builders {
            return Ok(());
        }
        if self.block.m_count > 1 {
            let message = "this control runs one M function a block (FANUC: parameter 3404#7)";
            let fault = self.block.whole(Rule::MFunction, message);
            return Err(fault.help("write each in a block of its own").into());
        }
        let drills = match self.block.g(Group::Cycle) {
            Some(word) => word != G::CancelCycle,
            // A word of group 01 ends the cycle.
            None => self.state.cycle.is_some() && self.block.g(Group::Motion).is_none(),
        };
        let cuts = !matches!(self.motion_of_block(), Some(Motion::Rapid) | None) || drills;
        let moves = b"XYZABC".iter().any(|&letter| self.block.has(letter))
            && self.block.g(Group::OneShot).is_none();
        for group in [Group::Spindle, Group::Coolant] {
            let off =
                matches!(self.block.m(group), Some(M::SpindleOff | M::CoolantOff | M::Orient));
            if off && cuts && moves {
                let message = "whether this acts before or after the cut is up to the machine";
                let fault = self.block.at_group(group, Rule::MFunction, message);
                return Err(fault.help("write it in a block of its own").into());
            }
        }
        Ok(())
    }

    fn speed(&mut self) -> Result<(), Fault> {
        // On Marlin S belongs to the command of its line: the seconds of G4, and the like.
        if self.facts.syntax.one_command {
            match self.block.m(Group::Spindle) {
                None => return Ok(()),
                // `M3-M5.cpp` of Marlin: at SPEED_POWER_STARTUP of the firmware, whatever turned before.
                Some(M::Clockwise | M::CounterClockwise) if !self.block.has(b'S') => {
                    let message =
                        "the spindle starts without S, at a speed that the firmware was built with";
                    let fault = self.block.at_group(Group::Spindle, Rule::Spindle, message);
                    return Err(fault.help("write S with M3 or M4").into());
                }
                Some(_) => {}
            }
        }
        self.surface_speed()?;
        let Some(word) = self.block.take(b'S') else { return Ok(()) };
        if word.value < 0.0 {
            return Err(self.block.at_word(b'S', Rule::Spindle, "the speed is below 0"));
        }
        self.state.speed = Some(word.value);
        if self.state.surface.is_some() {
            // Metres, or feet where lengths are inches.
            let meters = if self.unit(self.state.inches, b'S')? == 1.0 { 1.0 } else { 0.3048 };
            self.actions.push(Action::SurfaceSpeed(Some(word.value * meters)));
        }
        let most = self.state.surface.unwrap_or(word.value);
        match self.state.spindle {
            Spindle::Off => {}
            Spindle::Clockwise(_) => self.turn(Spindle::Clockwise(most)),
            Spindle::CounterClockwise(_) => self.turn(Spindle::CounterClockwise(most)),
        }
        Ok(())
    }

    /// `G96 D S`, `G97`: S is the surface speed, or the speed of the spindle.
    fn surface_speed(&mut self) -> Result<(), Fault> {
        let Some(G::SurfaceSpeed(constant)) = self.block.g(Group::SpindleMode) else {
            return Ok(());
        };
        let wrong = |step: &Self, message| {
            Err(step.block.at_group(Group::SpindleMode, Rule::Spindle, message))
        };
        // `rs274` takes G97 without S, and does not say how fast the spindle then turns.
        if !self.block.has(b'S') && (constant || self.state.surface.is_some()) {
            return wrong(self, "the block needs S, which is another thing from here on");
        }
        if !constant {
            if self.state.surface.take().is_some() {
                self.actions.push(Action::SurfaceSpeed(None));
            }
            return Ok(());
        }
        if self.block.g(Group::Units).is_some() {
            return wrong(
                self,
                "in which unit S counts in the block that says the unit is not clear",
            );
        }
        let most = self.block.take(b'D').map_or(f64::INFINITY, |word| word.value);
        if most <= 0.0 {
            return Err(self.block.at_word(b'D', Rule::Spindle, "the most speed D is above 0"));
        }
        self.state.surface = Some(most);
        Ok(())
    }

    /// Brings the spindle into a state and says so where that is news.
    pub(super) fn turn(&mut self, spindle: Spindle) {
        if self.state.spindle != spindle {
            self.state.spindle = spindle;
            self.actions.push(Action::Spindle(spindle));
        }
    }

    fn spindle_and_coolant(&mut self) -> Result<(), Fault> {
        if self.block.take(b'$').is_some_and(|word| word.value != 0.0) {
            return Err(self.block.at_word(b'$', Rule::Spindle, "there is one spindle, $0"));
        }
        let speed = || {
            self.state.surface.or(self.state.speed).ok_or_else(|| {
                let message = "the spindle starts and no speed has been given by S";
                let fault = self.block.at_group(Group::Spindle, Rule::Spindle, message);
                Fault::from(fault.help("write S with M3 or M4, or before"))
            })
        };
        let is_own = self.block.m(Group::Spindle).is_some_and(|m| m != M::RigidTap);
        if is_own && self.taps_on() {
            let message =
                "the spindle is switched between two holes of a rigid tap, which turns it itself";
            let fault = self.block.at_group(Group::Spindle, Rule::Cycle, message);
            return Err(fault.help("write G80 before it").into());
        }
        match self.block.m(Group::Spindle) {
            Some(M::Clockwise) => {
                let spindle = Spindle::Clockwise(speed()?);
                self.turn(spindle);
            }
            Some(M::CounterClockwise) => {
                let spindle = Spindle::CounterClockwise(speed()?);
                self.turn(spindle);
            }
            Some(M::RigidTap) => {
                speed()?;
                self.state.rigid = true;
            }
            Some(M::Orient) => {
                self.block.take(b'R');
                if self.facts.functions.orients_by_pq {
                    self.block.pass(b"PQ");
                }
                self.turn(Spindle::Off);
            }
            Some(_) if !self.facts.functions.builders => self.turn(Spindle::Off),
            _ => {}
        }
        match self.coolant_switch() {
            // What switches off comes last where the builder may have it so.
            Some(CoolantSwitch::Off | CoolantSwitch::ThroughOff)
                if self.facts.functions.builders =>
            {
                Ok(())
            }
            Some(switch) => self.switch_coolant(switch),
            None => Ok(()),
        }
    }

    /// M functions for which nothing moves.
    fn neutral_m(&mut self) -> Result<(), Fault> {
        self.signals()?;
        for group in [Group::Override, Group::Output] {
            match self.block.m(group) {
                Some(M::Neutral(letters)) => self.block.pass(letters),
                Some(M::LockOverrides) => {
                    self.actions.push(Action::Risk(Risk::OPERATOR_CONTROLS.into()));
                }
                // P0 is off; P1, and the word without P, is on (LinuxCNC, "M Codes").
                Some(M::Override) if self.is_switched_off() => {
                    self.actions.push(Action::Risk(Risk::OPERATOR_CONTROLS.into()));
                }
                Some(M::AdaptiveFeed) if !self.is_switched_off() => {
                    self.actions.push(Action::Risk(Risk::ADAPTIVE_FEED.into()));
                }
                Some(M::IdleTime) if self.block.take(b'S').is_none() => {
                    let message =
                        "the axes are let go: where the tool stands afterwards is not known";
                    return Err(self.block.at_group(group, Rule::UnknownPosition, message));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether P of the block is 0.
    fn is_switched_off(&mut self) -> bool {
        self.block.take(b'P').is_some_and(|word| word.value == 0.0)
    }

    /// What the block does with the coolant.
    fn coolant_switch(&self) -> Option<CoolantSwitch> {
        self.block.m(Group::Coolant).and_then(M::coolant)
    }

    /// Switches the coolant as the block says.
    fn switch_coolant(&mut self, switch: CoolantSwitch) -> Result<(), Fault> {
        let doubt = |doubt: Doubtful| {
            self.block.at_group(Group::Coolant, Rule::Coolant, doubt.message).help(doubt.help)
        };
        let coolant = self.coolants.behind(self.state.coolant, switch).map_err(doubt)?;
        self.set_coolant(coolant);
        Ok(())
    }

    /// The end of the program, or a stop that ends all coolant of the control itself.
    fn reset_coolant(&mut self) {
        self.set_coolant(self.coolants.behind_reset(self.state.coolant));
    }

    fn set_coolant(&mut self, coolant: Coolant) {
        if coolant != self.state.coolant {
            self.state.coolant = coolant;
            self.actions.push(Action::Coolant(coolant));
        }
    }

    fn dwell(&mut self) -> Result<(), Fault> {
        if self.block.g(Group::OneShot) != Some(G::Dwell) {
            return Ok(());
        }
        let letter = self.facts.numbers.dwell_letter.filter(|&letter| self.block.has(letter));
        let seconds = match letter {
            Some(letter) => {
                self.take_pointed(letter)?.map(|(value, increments)| match increments {
                    true => value / 1000.0,
                    false => value,
                })
            }
            None => self.dwell_p()?,
        };
        match seconds {
            Some(seconds) if seconds >= 0.0 => {
                let per_turn = self.state.feed_mode == FeedMode::PerTurn;
                if self.facts.numbers.dwells_by_turns && per_turn && seconds > 0.0 {
                    self.actions.push(Action::Risk(Risk::DWELL_TURNS.into()));
                }
                self.actions.push(Action::Dwell(seconds));
                Ok(())
            }
            Some(_) => Err(self.block.whole(Rule::Dwell, "the dwell is below 0")),
            None => Err(self.block.at_group(Group::OneShot, Rule::Dwell, "G4 and no time")),
        }
    }

    /// What happens at corners. LinuxCNC cuts them by P, and makes one line of lines within Q, or P without it; by any
    /// amount without P or with P 0 (G codes, "G64 Path Blending"; P 0 found on LinuxCNC 2.9 itself).
    fn corners(&mut self) -> Result<(), Fault> {
        if self.block.g(Group::Path) == Some(G::LockOverrides) {
            self.actions.push(Action::Risk(Risk::OPERATOR_CONTROLS.into()));
        }
        let mode = match (self.block.g(Group::Path), self.block.g(Group::OneShot)) {
            (Some(G::Path(Path::ExactStop)), _) => PathMode::ExactStop,
            (Some(G::Path(Path::Exact)), _) => PathMode::ExactPath,
            (Some(G::Path(Path::Blend { bounded: true })), _) => {
                let corner = self.take_length(b'P')?;
                let lines = self.take_length(b'Q')?;
                if [corner, lines].iter().flatten().any(|mm| *mm < 0.0) {
                    let message = "P and Q of G64 are distances, not below 0";
                    return Err(self.block.at_group(Group::Path, Rule::PathMode, message));
                }
                match corner {
                    Some(corner) if corner > 0.0 => {
                        PathMode::Blend(corner + lines.unwrap_or(corner))
                    }
                    _ => PathMode::AsSetUp,
                }
            }
            (Some(G::Path(Path::Blend { .. })), _) => self.smoothness(),
            (_, Some(G::Smoothness)) => {
                if let Some(level) = self.block.take(b'P')
                    && ![1.0, 2.0, 3.0].contains(&level.value)
                {
                    let message = "P of G187 is 1 (rough), 2 (medium) or 3 (finish)";
                    return Err(self.block.at_word(b'P', Rule::Number, message));
                }
                self.state.rounds_corners = self.take_length(b'E')?;
                self.smoothness()
            }
            (_, Some(G::ExactBlock)) => {
                self.actions.push(Action::Risk(Risk::EXACT_BLOCK.into()));
                return Ok(());
            }
            _ => return Ok(()),
        };
        self.actions.push(Action::PathMode(mode));
        Ok(())
    }

    /// By how much corners are cut as `G187` says, or as the control is set up.
    fn smoothness(&self) -> PathMode {
        self.state.rounds_corners.map_or(PathMode::AsSetUp, PathMode::Blend)
    }

    /// Plane, units, compensation, length, work offset, path, distance, return, tilt.
    fn modes(&mut self) -> Result<(), Fault> {
        if let Some(G::Plane(plane)) = self.block.g(Group::Plane)
            && plane != self.state.plane
        {
            self.not_compensated("a change of plane")?;
            self.state.plane = plane;
        }
        if let Some(G::Inches(inches)) = self.block.g(Group::Units)
            && self.state.inches != Some(inches)
        {
            self.not_compensated("a change of units")?;
            if self.facts.motion.units_at_start && self.state.moved {
                let message = "this control takes G20 or G21 before the first move only";
                return Err(self.block.at_group(Group::Units, Rule::Units, message));
            }
            self.state.inches = Some(inches);
        }
        if self.facts.motion.units_alone
            && self.block.g(Group::Units).is_some()
            && !self.block.has_only(&[], Group::Units)
        {
            self.actions.push(Action::Risk(Risk::UNIT_BLOCK.into()));
        }
        self.remember_registers()?;
        if let Some(g) = self.block.g(Group::Compensation) {
            self.compensation(g)?;
        }
        self.length()?;
        self.work_offset()?;
        self.corners()?;
        if let Some(G::Neutral(letters)) = self.block.g(Group::OneShot) {
            self.block.pass(letters);
        }
        if let Some(G::Diameter(diameter)) = self.block.g(Group::Diameter) {
            self.state.diameter = diameter;
            if diameter {
                self.actions.push(Action::Risk(Risk::DIAMETERS.into()));
            }
        }
        if let Some(G::Incremental(incremental)) = self.block.g(Group::Distance) {
            self.state.incremental = incremental;
        }
        if let Some(G::CentersAbsolute(absolute)) = self.block.g(Group::ArcDistance) {
            self.state.centers_absolute = absolute;
        }
        if let Some(G::ReturnToR(to_r)) = self.block.g(Group::Return) {
            self.state.return_to_r = Some(to_r);
        }
        self.transforms()
    }

    /// `G40` to `G42` with the register D; LinuxCNC's `G41.1`, `G42.1` with D as the diameter.
    fn compensation(&mut self, g: G) -> Result<(), Fault> {
        let refused = |step: &Self, message: String| {
            Err(step.block.at_group(Group::Compensation, Rule::Compensation, message))
        };
        let (side, mut register, radius) = if let G::Compensation(side) = g {
            (side, None, None)
        } else if let G::DynamicCompensation(side) = g {
            match self.take_length(b'D')? {
                Some(diameter) => (side, None, Some(diameter / 2.0)),
                None => return refused(self, "G41.1 and G42.1 need the diameter D".into()),
            }
        } else {
            return Ok(());
        };
        if self.facts.tools.follows_tool && side != Side::Off {
            if self.state.compensation.is_on() {
                return refused(self, "compensation is on already: G40 first".into());
            }
            if self.state.plane == Plane::Yz {
                return refused(
                    self,
                    "the control compensates in the planes G17 and G18 only".into(),
                );
            }
        }
        if side != Side::Off && radius.is_none() {
            register = match self.facts.tools.remembers_registers {
                true => self.state.registers.d,
                false => self.take_whole(self.facts.tools.radius_letter)?,
            };
            self.radius_is_set_up(register)?;
            if register.is_none() && self.facts.tools.needs_radius_register {
                let letter = char::from(self.facts.tools.radius_letter);
                return refused(self, format!("G41 and G42 need their register {letter}"));
            }
        }
        self.state.compensation.asked = side.with(register);
        self.state.compensation.radius = radius;
        Ok(())
    }

    /// Stops and the end; on FANUC what switches off, too, since it comes with the end of a move.
    fn flow(&mut self) -> Result<(), Fault> {
        if self.facts.functions.builders {
            if self.block.m(Group::Spindle) == Some(M::SpindleOff) {
                self.turn(Spindle::Off);
            }
            if let Some(switch @ (CoolantSwitch::Off | CoolantSwitch::ThroughOff)) =
                self.coolant_switch()
            {
                self.switch_coolant(switch)?;
            }
        }
        match self.block.m(Group::Flow) {
            Some(M::Stop) if self.state.awaits_tool(self.facts) => {
                if self.state.spindle != Spindle::Off {
                    let message =
                        "a tool is changed by hand while the spindle turns; write M5 first";
                    return Err(self.block.at_group(Group::Flow, Rule::Tool, message));
                }
                self.stops_while_running();
                self.change_by_hand();
            }
            Some(M::Stop) => {
                self.stops_while_running();
                self.actions.push(Action::Stop);
                self.stop_all();
            }
            Some(M::OptionalStop) if !self.facts.functions.ignores_optional_stop => {
                self.stops_while_running();
                self.actions.push(Action::OptionalStop);
                self.stop_all();
            }
            Some(M::End) => {
                self.looks_ahead_no_more();
                self.end()?;
            }
            // What follows is executed elsewhere (spindle, coolant, outputs, calls). Each function is named: a new one does not compile
            // before it is decided here.
            Some(
                M::OptionalStop
                | M::Clockwise
                | M::CounterClockwise
                | M::SpindleOff
                | M::Orient
                | M::ChangeTool
                | M::ToolIsIn
                | M::Mist
                | M::Flood
                | M::Through
                | M::ThroughOff
                | M::CoolantOff
                | M::RigidTap
                | M::Call
                | M::CallBlock
                | M::Return
                | M::SaveModes { .. }
                | M::ForgetModes
                | M::RestoreModes
                | M::ThreadWire
                | M::CutWire
                | M::Neutral(_)
                | M::LockOverrides
                | M::Override
                | M::AdaptiveFeed
                | M::Message
                | M::IdleTime
                | M::Digital { .. }
                | M::Analog { .. }
                | M::Input
                | M::FollowTip(_)
                | M::Program(_),
            )
            | None => {}
        }
        Ok(())
    }

    /// `M2` and `M30`.
    fn end(&mut self) -> Result<(), Fault> {
        let left_on = self.state.left_on(self.facts);
        self.actions.extend(left_on.map(|risk| Action::Risk(risk.into())));
        // The others switch off by themselves; on FANUC it is the builder's choice, on Mach3 the operator's.
        if self.facts.functions.end_switches_off {
            self.turn(Spindle::Off);
            self.reset_coolant();
        }
        if self.facts.reset.at_end == AtEnd::Resets
            && self.state.work_offset.is_some_and(|number| number != WorkOffset::FIRST.number())
        {
            self.actions.push(Action::WorkOffset(WorkOffset::FIRST));
        }
        self.state.ended = true;
        self.actions.push(Action::End);
        Ok(())
    }

    /// Tells of a stop with spindle or coolant on.
    fn stops_while_running(&mut self) {
        if self.facts.functions.stop_leaves_on && self.state.is_running() {
            self.actions.push(Action::Risk(Risk::STOP_RUNNING.into()));
        }
    }

    /// `M0` and `M1` of Haas stop the spindle and the coolant, and nothing starts them again (*Mill Operator's Manual*,
    /// M00). `M1` counts as if the operator had asked for it.
    fn stop_all(&mut self) {
        if self.facts.functions.stop_switches_off {
            self.turn(Spindle::Off);
            self.reset_coolant();
            // A coolant that the builder has added goes on, or not.
            if self.state.is_running() {
                self.actions.push(Action::Risk(Risk::STOP_RUNNING.into()));
            }
        }
    }

    /// What happens without radius compensation: where `G40` still waits for a move, it ends here.
    ///
    /// # Errors
    /// It is on while `what` happens.
    pub(super) fn not_compensated(&mut self, what: &str) -> Result<(), Fault> {
        if !self.state.compensation.is_on() {
            self.switch_compensation();
            return Ok(());
        }
        let message = format!("{what} while radius compensation is on; cancel it with G40 first");
        Err(self.block.whole(Rule::Compensation, message))
    }

    pub(super) fn has_rotary_axes(&self, group: Group) -> Result<(), Fault> {
        if self.axes.contains(&true) {
            return Ok(());
        }
        Err(self.block.at_group(group, Rule::UnknownAxis, "the machine has no rotary axis"))
    }
}
