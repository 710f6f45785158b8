//! Tools: their change, their lengths, and the registers that hold these.

use super::state::{Length, Registers, Tilt, UNKNOWN};
use super::step::Step;
use crate::event::{Action, Risk};
use crate::iso::language::Fault;
use crate::iso::language::words::{G, Group, M, Plane, bit};
use program::{Coolant, Rule, Spindle, Tool};

impl Length {
    /// By how much the tip is nearer to the part than the gauge line, mm; NaN where not known.
    fn value(self, registers: &Registers) -> f64 {
        match self {
            Length::None => 0.0,
            Length::Register(register) | Length::Center(register) => registers.length(register),
            Length::Value(length) => length,
        }
    }
}

impl Step<'_, '_, '_> {
    /// `T`, `M6`, `M61`.
    pub(super) fn tool(&mut self) -> Result<(), Fault> {
        let number = self.take_whole(b'T')?;
        self.state.selected = number.or(self.state.selected);
        if self.facts.tools.by_hand {
            // There is no tool change: the first T names the tool that is set up.
            if self.state.tool.is_none() && !self.state.cut {
                self.change_by_hand();
            }
            return Ok(());
        }
        match self.block.m(Group::ToolChange) {
            Some(M::ChangeTool) => self.change_tool(),
            Some(_) => {
                let Some(number) = self.take_whole(b'Q')? else {
                    let message = "M61 needs Q, the number of the tool that is in";
                    return Err(self.block.at_group(Group::ToolChange, Rule::Tool, message));
                };
                self.actions.push(Action::Risk(Risk::TOOL_DECLARED.into()));
                self.put_in(number);
                Ok(())
            }
            None => {
                self.actions.extend(number.map(Action::Preselect));
                Ok(())
            }
        }
    }

    fn change_tool(&mut self) -> Result<(), Fault> {
        let Some(number) = self.state.selected else {
            let message = "M6 and no tool has been named by T";
            return Err(self.block.at_group(Group::ToolChange, Rule::Tool, message));
        };
        if number == 0 && self.facts.source.is_some() {
            let message = "the tool has no number";
            return Err(self.block.at_group(Group::ToolChange, Rule::Tool, message));
        }
        self.not_compensated("a tool change")?;
        self.looks_ahead_no_more();
        if let Err(doubt) = self.coolants.allow_change(self.state.coolant) {
            let fault = self.block.at_group(Group::ToolChange, Rule::Coolant, doubt.message);
            return Err(fault.help(doubt.help).into());
        }
        if self.state.coolant != Coolant::Off {
            self.actions.push(Action::Risk(Risk::CHANGE_RUNNING.into()));
        }
        self.put_in(number);
        self.turn(Spindle::Off);
        // The machine may go to a place of its own for the change.
        self.state.position = UNKNOWN;
        Ok(())
    }

    /// The operator puts in the tool that T has named; its length is another one.
    pub(super) fn change_by_hand(&mut self) {
        let Some(number) = self.state.selected else { return };
        self.put_in(number);
        self.state.position.z = f64::NAN;
    }

    fn put_in(&mut self, number: u32) {
        self.state.tool = Some(number);
        self.state.touching = false;
        // The place of the last G28 and the H of another tool are not meant.
        (self.state.via, self.state.registers.h) = (None, None);
        self.actions.push(Action::Tool(Box::new(Tool { number, ..Tool::default() })));
    }

    /// D and H are modal by themselves (B-64484EN-2, "Tool length compensation", "Cutter compensation"):
    /// while `G43` is on, another H is another length at once.
    pub(super) fn remember_registers(&mut self) -> Result<(), Fault> {
        if !self.block.has_any(bit(b'D') | bit(b'H')) || !self.facts.tools.remembers_registers {
            return Ok(());
        }
        if let Some(register) = self.take_whole(b'D')? {
            let compensates = self.state.compensation.is_on();
            let stays = self.block.g(Group::Compensation).is_none();
            if compensates && stays && self.state.registers.d != Some(register) {
                let message = "another radius while radius compensation is on";
                let fault = self.block.at_word(b'D', Rule::Compensation, message);
                return Err(fault.help("write it with G41 or G42, after G40").into());
            }
            self.state.registers.d = Some(register);
        }
        if let Some(register) = self.take_whole(b'H')? {
            self.state.registers.h = Some(register);
            let kept = match self.state.length {
                Length::Register(_) => G::Length,
                Length::Center(_) => G::ToolCenter,
                Length::None | Length::Value(_) => return Ok(()),
            };
            if self.block.g(Group::Length).is_none() {
                self.block.put_g(Group::Length, kept);
            }
        }
        Ok(())
    }

    /// The register that H names: in the block, or before where the dialect remembers it.
    fn length_register(&mut self) -> Result<Option<u32>, Fault> {
        if self.facts.tools.remembers_registers {
            return Ok(self.state.registers.h);
        }
        self.take_whole(b'H')
    }

    /// `G43` and its kin, `G49`.
    pub(super) fn length(&mut self) -> Result<(), Fault> {
        // B-63844EN p. 204: a block with G43, G43.4, H or G49 gives back, or ends, what G28 and G53 have taken away.
        self.state.length_is_suspended &= self.block.g(Group::Length).is_none();
        if self.facts.tools.follows_tool && self.block.g(Group::Length).is_some() {
            self.not_compensated("another length offset")?;
        }
        let length = match self.block.g(Group::Length) {
            Some(G::Length) => match self.length_register()? {
                Some(0) if self.facts.tools.h0_cancels => Length::None,
                Some(register) => Length::Register(register),
                // LinuxCNC: without H the tool in the spindle.
                None if self.facts.tools.follows_tool => {
                    Length::Register(self.state.tool.ok_or_else(|| self.no_register())?)
                }
                None => return Err(self.no_register()),
            },
            Some(G::ToolCenter) => {
                self.has_rotary_axes(Group::Length)?;
                if self.state.tilt != Tilt::None || self.state.frames.is_transformed() {
                    let message = "cancel the turned, scaled or tilted coordinates first";
                    return Err(self.block.at_group(Group::Length, Rule::TiltedPlane, message));
                }
                Length::Center(self.length_register()?.ok_or_else(|| self.no_register())?)
            }
            Some(G::DynamicLength) => {
                if self.block.g(Group::Motion).is_some() || !self.block.has(b'Z') {
                    let message = "G43.1 takes Z alone, and no motion in its block";
                    return Err(self.block.at_group(Group::Length, Rule::LengthOffset, message));
                }
                // No program has measured it.
                self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
                Length::Value(self.take_length(b'Z')?.unwrap_or(0.0))
            }
            Some(_) => {
                self.state.registers.h = None;
                Length::None
            }
            None => return Ok(()),
        };
        if length == self.state.length {
            return Ok(());
        }
        if self.facts.tools.length_as_set_up {
            self.hold_length(length);
        }
        self.keeps_length()?;
        self.change_length(length);
        Ok(())
    }

    /// Tells where parameters of the control say what `length` does.
    ///
    /// Where Z is home a length that begins moves it as well, beyond the end of its travel or, where the registers hold negative
    /// numbers, down onto the part; one that ends moves nothing there, since G28 and G53 have taken it away before.
    fn hold_length(&mut self, length: Length) {
        let ends_at_home = length == Length::None && self.state.z_is_home;
        if self.state.length_moves_axis != Some(false) && !ends_at_home && !self.goes_to_z() {
            self.actions.push(Action::Risk(Risk::LENGTH_CHANGE.into()));
        }
        if [length, self.state.length].iter().any(|length| matches!(length, Length::Center(_))) {
            self.looks_ahead_no_more();
        }
        let turned = |i: usize| self.state.table[i] && self.state.rotary[i] != 0.0;
        if matches!(length, Length::Center(_))
            && (0..3).any(turned)
            && self.state.table_frame_at_zero != Some(true)
        {
            self.actions.push(Action::Risk(Risk::TABLE_FRAME.into()));
        }
        let begins = length != Length::None && self.state.plane != Plane::Xy;
        if begins && self.state.length_along_z != Some(true) {
            self.actions.push(Action::Risk(Risk::LENGTH_PLANE.into()));
        }
    }

    /// Whether the block itself says where Z goes: its end is the same then, whether the length moves Z or the coordinates.
    fn goes_to_z(&self) -> bool {
        let cycle = match self.block.g(Group::Cycle) {
            Some(word) => word != G::CancelCycle,
            None => self.state.cycle.is_some() && self.block.g(Group::Motion).is_none(),
        };
        let incremental = match self.block.g(Group::Distance) {
            Some(G::Incremental(incremental)) => incremental,
            _ => self.state.incremental,
        };
        self.block.has(b'Z') && self.block.g(Group::OneShot).is_none() && !cycle && !incremental
    }

    /// Tells of Z that has moved while nobody knows whether the length counts: G28, G30 and G53 take it away at their end, G43 stays
    /// on, and parameter 5001#6 says whether the next block gives it back, or one with G43 or H (B-63844EN p. 204).
    pub(super) fn holds_suspended_length(&mut self) {
        if self.state.length_is_suspended && !self.state.z_is_home {
            self.state.length_is_suspended = false;
            self.actions.push(Action::Risk(Risk::LENGTH_SUSPENDED.into()));
        }
    }

    /// Another length counts from here on; nothing moves.
    pub(super) fn change_length(&mut self, length: Length) {
        if length == self.state.length {
            return;
        }
        let center = |l: Length| matches!(l, Length::Center(_));
        // The tip's coordinates change by a length that may be known only to the machine; with the
        // tool centre point in play and the axes turned, in all directions.
        let turned = self.state.rotary != [0.0; 3];
        if turned && (center(length) || center(self.state.length)) {
            self.state.position = UNKNOWN;
        }
        let registers = &self.state.registers;
        self.state.position.z += self.state.length.value(registers) - length.value(registers);
        self.state.length = length;
        self.actions.push(Action::LengthOffset(match length {
            Length::None => None,
            Length::Register(register) | Length::Center(register) => Some(register),
            Length::Value(_) => Some(0),
        }));
    }

    /// The length that is in use, mm; NaN where not known.
    pub(super) fn length_in_use(&self) -> f64 {
        self.state.length.value(&self.state.registers)
    }

    fn no_register(&self) -> Fault {
        self.block.at_group(
            Group::Length,
            Rule::LengthOffset,
            "the length offset needs its register H",
        )
    }

    /// `G10 L1` and `L10` to `L13`: a length or a radius into the register P.
    pub(super) fn write_tool(&mut self, kind: u32) -> Result<(), Fault> {
        let Some(register) = self.take_whole(b'P')? else {
            let message = "P names the tool whose data is written";
            return Err(self.block.at_group(Group::OneShot, Rule::Data, message));
        };
        let touches_off = kind == 10 && self.touches_off(register);
        if !touches_off {
            self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
        }
        let in_use = match self.state.length {
            Length::Register(active) | Length::Center(active) => active == register,
            Length::None | Length::Value(_) => false,
        };
        let ngc = self.facts.tools.rs274_data;
        let mut written = None;
        let (length, radius) = match kind {
            1 if ngc => (self.take_length(b'Z')?, self.take_length(b'R')?),
            // Measured at the machine: the length follows from where the tool stands.
            10 | 11 if ngc => {
                written = self.take_length(b'Z')?;
                (written.map(|_| f64::NAN), self.take_length(b'R')?)
            }
            10 if !ngc => (self.take_length(b'R')?, None),
            // Wear adds to what is in the register.
            11 if !ngc => (self.take_length(b'R')?.map(|_| f64::NAN), None),
            12 | 13 if !ngc => (None, self.take_length(b'R')?),
            _ => {
                let message = format!("G10 L{kind} is not known to this control");
                return Err(self.block.at_word(b'L', Rule::Data, message));
            }
        };
        if length.is_none() && radius.is_none() {
            let message = "no word says what is written";
            return Err(self.block.at_group(Group::OneShot, Rule::Data, message));
        }
        if let Some(length) = length {
            if in_use {
                let message = format!("the register {register} is written while it is in use");
                let fault = self.block.at_group(Group::OneShot, Rule::Data, message);
                return Err(fault.help("write it before G43, or cancel with G49 first").into());
            }
            self.state.registers.write_length(register, length);
        }
        if let (true, Some(z)) = (touches_off, written) {
            self.state.touching = false;
            let at = self.state.place.point(self.state.position.with_z(z)).z;
            self.actions.push(Action::TouchOff(at));
        }
        if radius.is_some() && !self.state.registers.radii.contains(&register) {
            self.not_compensated("a radius that is written")?;
            self.state.registers.radii.push(register);
        }
        Ok(())
    }

    /// Whether `G10 L10` writes the length of the tool in the spindle, and that alone, where it rests on what its probing move has
    /// touched.
    fn touches_off(&self, register: u32) -> bool {
        let names_z_alone = self.block.has(b'Z') && !self.block.has(b'R');
        let tools = &self.facts.tools;
        tools.rs274_data && names_z_alone && self.is_touching() && self.state.tool == Some(register)
    }

    /// # Errors
    /// The program has written the radius itself, which is not followed.
    pub(super) fn radius_is_set_up(&self, register: Option<u32>) -> Result<(), Fault> {
        let register = register.or(self.state.tool);
        if !register.is_some_and(|register| self.state.registers.radii.contains(&register)) {
            return Ok(());
        }
        let message = "compensation with a radius that the program has written by G10";
        let fault = self.block.at_group(Group::Compensation, Rule::Compensation, message);
        Err(fault.help("put the radius into the tool table").into())
    }
}
