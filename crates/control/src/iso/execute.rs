//! One block, in the order in which a control executes it.

use super::block::{Block, Fault, Word};
use super::state::{Length, State, Tilt, UNKNOWN};
use super::words::{FeedMode, Flavor, G, Group, M, Motion, Plane, Side};
use crate::Settings;
use crate::compensation::Terms;
use geom::{Frame, Mat3, Vec3};
use program::{Coolant, Feed, Op, Spindle, Tool};

/// mm in an inch.
const INCH: f64 = 25.4;

/// A virtual control: its flavour, its axes and its state.
#[derive(Debug)]
pub(super) struct Control {
    pub flavor: Flavor,
    /// Which of A, B, C exist.
    pub axes: [bool; 3],
    state: State,
}

/// A block in the making: the control's rules, the state as it changes, the records so far.
pub(super) struct Step<'s, 'b, 't> {
    pub flavor: Flavor,
    pub axes: [bool; 3],
    pub state: &'s mut State,
    pub block: &'b mut Block<'t>,
    pub ops: &'s mut Vec<Op>,
}

impl Control {
    /// The control of `settings` at the start of a program.
    pub(super) fn new(settings: &Settings, flavor: Flavor) -> Control {
        // GRBL drives three axes only.
        let axes = if flavor == Flavor::Grbl { [false; 3] } else { settings.rotary };
        Control { flavor, axes, state: State::new(flavor, axes) }
    }

    /// What holds for compensation from here on.
    pub(super) fn compensation(&self) -> Terms {
        self.state.compensation_terms()
    }

    /// Executes `block` and puts its records into `ops`. `closed`: the last `%` has gone by.
    ///
    /// # Errors
    /// The block means nothing, or is not legal here; the state is then as before.
    pub(super) fn execute(
        &mut self,
        block: &mut Block,
        closed: bool,
        ops: &mut Vec<Op>,
    ) -> Result<(), Fault> {
        ops.extend(block.comments());
        if block.is_empty {
            return Ok(());
        }
        if self.state.ended || closed {
            return Err(block.whole("nc-after-end", "the program has ended before this block"));
        }
        let mut state = self.state;
        Step { flavor: self.flavor, axes: self.axes, state: &mut state, block, ops }.run()?;
        self.state = state;
        Ok(())
    }
}

impl Step<'_, '_, '_> {
    /// The order is that of LinuxCNC ("Order of Execution") and GRBL (`gcode.c`, steps 1 to 21), which
    /// is that of RS274/NGC 3.8. FANUC leaves the moment of an M function to the builder of the
    /// machine: what could matter there is refused.
    fn run(&mut self) -> Result<(), Fault> {
        self.program_number()?;
        self.m_functions_beside_motion()?;
        self.feed()?;
        self.speed()?;
        self.tool()?;
        self.spindle_and_coolant()?;
        self.dwell()?;
        self.modes()?;
        self.motion()?;
        self.flow()?;
        self.block.all_taken()
    }

    /// `O` names the program and stands at its start: another one is another program.
    fn program_number(&mut self) -> Result<(), Fault> {
        if self.block.has(b'O') && self.state.begun {
            let message = "another program begins here; a program has its number O first";
            return Err(self.block.at_word(b'O', "nc-program-number", message));
        }
        self.state.begun = true;
        self.take_whole(b'O').map(|_| ())
    }

    /// FANUC runs one M function a block (parameter 3404, bit 7, as delivered), and only the builder
    /// says whether it comes before or after the motion beside it.
    fn m_functions_beside_motion(&mut self) -> Result<(), Fault> {
        if self.flavor != Flavor::Fanuc {
            return Ok(());
        }
        if self.block.m_count > 1 {
            let message = "FANUC runs one M function a block (parameter 3404#7)";
            return Err(self.block.whole("nc-many-m", message));
        }
        let drills = self.state.cycle.is_some() || self.block.g(Group::Cycle).is_some();
        let cuts = !matches!(self.motion_of_block(), Some(Motion::Rapid) | None) || drills;
        let moves = b"XYZABC".iter().any(|&letter| self.block.has(letter))
            && self.block.g(Group::OneShot).is_none();
        for group in [Group::Spindle, Group::Coolant] {
            let off =
                matches!(self.block.m(group), Some(M::SpindleOff | M::CoolantOff | M::Orient));
            if off && cuts && moves {
                let message = "whether this acts before or after the cut is up to the machine";
                return Err(self.block.at_group(group, "nc-m-beside-cut", message));
            }
        }
        Ok(())
    }

    fn feed(&mut self) -> Result<(), Fault> {
        if let Some(G::FeedMode(mode)) = self.block.g(Group::FeedMode)
            && mode != self.state.feed_mode
        {
            // The old number means nothing in the new mode.
            self.state.feed_mode = mode;
            self.state.feed = None;
        }
        let Some(word) = self.block.take(b'F') else { return Ok(()) };
        if let Some(G::Inches(inches)) = self.block.g(Group::Units)
            && self.state.inches != Some(inches)
        {
            let message = "F in the block that changes the units: controls differ in which it is";
            return Err(self.block.at_word(b'F', "nc-feed", message));
        }
        if word.value <= 0.0 {
            return Err(self.block.at_word(b'F', "nc-feed", "the feed must be greater than 0"));
        }
        let feed = match self.state.feed_mode {
            FeedMode::PerMinute => Feed::PerMinute(word.value * self.unit(b'F')?),
            FeedMode::PerTurn => Feed::PerTurn(word.value * self.unit(b'F')?),
            FeedMode::InverseTime => Feed::InverseTime(word.value),
        };
        if self.state.feed.replace(feed) != Some(feed) {
            self.ops.push(Op::Feed(feed));
        }
        Ok(())
    }

    fn speed(&mut self) -> Result<(), Fault> {
        let Some(word) = self.block.take(b'S') else { return Ok(()) };
        if word.value < 0.0 {
            return Err(self.block.at_word(b'S', "nc-spindle", "the speed is below 0"));
        }
        self.state.speed = Some(word.value);
        match self.state.spindle {
            Spindle::Off => {}
            Spindle::Clockwise(_) => self.turn(Spindle::Clockwise(word.value)),
            Spindle::CounterClockwise(_) => self.turn(Spindle::CounterClockwise(word.value)),
        }
        Ok(())
    }

    /// Brings the spindle into a state and says so where that is news.
    pub(super) fn turn(&mut self, spindle: Spindle) {
        if self.state.spindle != spindle {
            self.state.spindle = spindle;
            self.ops.push(Op::Spindle(spindle));
        }
    }

    fn tool(&mut self) -> Result<(), Fault> {
        let number = self.take_whole(b'T')?;
        self.state.selected = number.or(self.state.selected);
        if self.flavor == Flavor::Grbl {
            // There is no tool change: the first T names the tool that is set up.
            if self.state.tool.is_none() && !self.state.cut {
                self.change_by_hand();
            }
            return Ok(());
        }
        let Some(M::ChangeTool) = self.block.m(Group::ToolChange) else {
            self.ops.extend(number.map(|number| match self.flavor {
                // GRBL has no M6: T is all it is told of the tool that the operator has put in.
                Flavor::Grbl => Op::Tool(Box::new(Tool { number, ..Tool::default() })),
                _ => Op::Preselect(number),
            }));
            return Ok(());
        };
        let Some(number) = self.state.selected else {
            let message = "M6 and no tool has been named by T";
            return Err(self.block.at_group(Group::ToolChange, "nc-tool", message));
        };
        self.not_compensated("a tool change")?;
        self.turn(Spindle::Off);
        self.put_in(number);
        // The machine may go to a place of its own for the change.
        self.state.position = UNKNOWN;
        Ok(())
    }

    /// The operator puts in the tool that T has named; its length is another one.
    fn change_by_hand(&mut self) {
        let Some(number) = self.state.selected else { return };
        self.put_in(number);
        self.state.position.z = f64::NAN;
    }

    fn put_in(&mut self, number: u32) {
        self.state.tool = Some(number);
        self.ops.push(Op::Tool(Box::new(Tool { number, ..Tool::default() })));
    }

    /// GRBL: T has named another tool, which the operator puts in at the next `M0`.
    pub(super) fn awaits_tool(&self) -> bool {
        self.flavor == Flavor::Grbl && self.state.selected != self.state.tool
    }

    fn spindle_and_coolant(&mut self) -> Result<(), Fault> {
        let speed = || {
            self.state.speed.ok_or_else(|| {
                let message = "the spindle starts and no speed has been given by S";
                self.block.at_group(Group::Spindle, "nc-spindle", message)
            })
        };
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
                self.turn(Spindle::Off);
            }
            Some(_) if self.flavor != Flavor::Fanuc => self.turn(Spindle::Off),
            _ => {}
        }
        match self.block.m(Group::Coolant) {
            Some(M::Mist) => self.cool(Coolant::Mist)?,
            Some(M::Flood) => self.cool(Coolant::Flood)?,
            Some(_) if self.flavor != Flavor::Fanuc => self.cool(Coolant::Off)?,
            _ => {}
        }
        Ok(())
    }

    fn cool(&mut self, coolant: Coolant) -> Result<(), Fault> {
        if coolant == self.state.coolant {
            return Ok(());
        }
        if coolant != Coolant::Off && self.state.coolant != Coolant::Off {
            let message = "one coolant runs already: both together cannot be told; write M9 first";
            return Err(self.block.at_group(Group::Coolant, "nc-coolant", message));
        }
        self.state.coolant = coolant;
        self.ops.push(Op::Coolant(coolant));
        Ok(())
    }

    fn dwell(&mut self) -> Result<(), Fault> {
        if self.block.g(Group::OneShot) != Some(G::Dwell) {
            return Ok(());
        }
        let seconds = if self.flavor == Flavor::Fanuc {
            match self.block.take(b'X') {
                Some(word) if word.point => Some(word.value),
                Some(_) => return Err(self.ambiguous(b'X')),
                None => self.take_whole(b'P')?.map(|ms| f64::from(ms) / 1000.0),
            }
        } else {
            self.block.take(b'P').map(|word| word.value)
        };
        match seconds {
            Some(seconds) if seconds >= 0.0 => {
                self.ops.push(Op::Dwell(seconds));
                Ok(())
            }
            Some(_) => Err(self.block.whole("nc-dwell", "the dwell is below 0")),
            None => Err(self.block.at_group(Group::OneShot, "nc-dwell", "G4 and no time")),
        }
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
            if self.flavor == Flavor::Fanuc && self.state.moved {
                let message = "FANUC takes G20 or G21 before the first move only";
                return Err(self.block.at_group(Group::Units, "nc-units", message));
            }
            self.state.inches = Some(inches);
        }
        if let Some(g) = self.block.g(Group::Compensation) {
            self.compensation(g)?;
        }
        self.length()?;
        if let Some(G::WorkOffset(number)) = self.block.g(Group::WorkOffset)
            && self.state.work_offset != Some(number)
        {
            self.not_compensated("a change of work offset")?;
            self.state.work_offset = Some(number);
            self.state.position = UNKNOWN;
            self.ops.push(Op::WorkOffset(u32::from(number)));
        }
        if self.block.g(Group::Path) == Some(G::Blend) {
            self.block.take(b'P');
            self.block.take(b'Q');
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
        self.tilt()
    }

    /// `G40` to `G42` with the register D; LinuxCNC's `G41.1`, `G42.1` with D as the diameter.
    fn compensation(&mut self, g: G) -> Result<(), Fault> {
        let refused = |step: &Self, message| {
            Err(step.block.at_group(Group::Compensation, "nc-compensation", message))
        };
        let mut register = None;
        let mut radius = None;
        let side = match g {
            G::Compensation(side) => side,
            G::DynamicCompensation(side) => {
                let Some(diameter) = self.take_length(b'D')? else {
                    return refused(self, "G41.1 and G42.1 need the diameter D");
                };
                radius = Some(diameter / 2.0);
                side
            }
            _ => return Ok(()),
        };
        if side != Side::Off {
            if self.flavor == Flavor::LinuxCnc && self.state.compensation.is_on() {
                return refused(self, "compensation is on already: G40 first");
            }
            if self.flavor == Flavor::LinuxCnc && self.state.plane == Plane::Yz {
                return refused(self, "LinuxCNC compensates in the planes G17 and G18 only");
            }
            if radius.is_none() {
                register = self.take_whole(b'D')?;
            }
            if register.is_none() && self.flavor == Flavor::Fanuc {
                return refused(self, "G41 and G42 need their register D");
            }
        }
        self.state.compensation.asked = side.with(register);
        self.state.compensation.radius = radius;
        Ok(())
    }

    fn length(&mut self) -> Result<(), Fault> {
        let length = match self.block.g(Group::Length) {
            Some(G::Length) => match self.take_whole(b'H')? {
                Some(0) if self.flavor == Flavor::Fanuc => Length::None,
                Some(register) => Length::Register(register),
                // LinuxCNC: without H the tool in the spindle.
                None if self.flavor == Flavor::LinuxCnc => {
                    Length::Register(self.state.tool.ok_or_else(|| self.no_register())?)
                }
                None => return Err(self.no_register()),
            },
            Some(G::ToolCenter) => {
                self.has_rotary_axes(Group::Length)?;
                if self.state.tilt != Tilt::None {
                    let message = "cancel the tilted plane (G69) first";
                    return Err(self.block.at_group(Group::Length, "nc-tilt", message));
                }
                Length::Center(self.take_whole(b'H')?.ok_or_else(|| self.no_register())?)
            }
            Some(G::DynamicLength) => {
                if self.block.g(Group::Motion).is_some() || !self.block.has(b'Z') {
                    let message = "G43.1 takes Z alone, and no motion beside it";
                    return Err(self.block.at_group(Group::Length, "nc-length", message));
                }
                Length::Value(self.take_length(b'Z')?.unwrap_or(0.0))
            }
            Some(_) => Length::None,
            None => return Ok(()),
        };
        if length == self.state.length {
            return Ok(());
        }
        let center = |l: Length| matches!(l, Length::Center(_));
        // The tip's coordinates change by a length that only the machine knows; with the tool centre
        // point in play and the axes turned, in all directions.
        let turned = self.state.rotary != [0.0; 3];
        if turned && (center(length) || center(self.state.length)) {
            self.state.position = UNKNOWN;
        }
        self.state.position.z = f64::NAN;
        self.state.length = length;
        self.ops.push(Op::LengthOffset(match length {
            Length::None => None,
            Length::Register(register) | Length::Center(register) => Some(register),
            Length::Value(_) => Some(0),
        }));
        Ok(())
    }

    fn no_register(&self) -> Fault {
        self.block.at_group(Group::Length, "nc-length", "the length offset needs its register H")
    }

    /// `G68.2 X Y Z I J K`: origin, and Euler angles about Z, the new X, the newest Z (B-64484EN-2,
    /// "Tilted working plane command").
    fn tilt(&mut self) -> Result<(), Fault> {
        match self.block.g(Group::Tilt) {
            Some(G::Tilt) => {
                self.has_rotary_axes(Group::Tilt)?;
                self.not_compensated("a tilted plane")?;
                if self.state.tilt != Tilt::None || matches!(self.state.length, Length::Center(_)) {
                    let message = "G68.2 while a tilted plane or G43.4 is active; cancel it first";
                    return Err(self.block.at_group(Group::Tilt, "nc-tilt", message));
                }
                let mut values = [0.0; 6];
                for (value, letter) in values.iter_mut().zip(*b"XYZIJK") {
                    let word = if letter >= b'X' {
                        self.take_length(letter)?
                    } else {
                        self.take_degrees(letter)?
                    };
                    *value = word.ok_or_else(|| {
                        let message = format!("G68.2 needs {}: write all six", char::from(letter));
                        self.block.at_group(Group::Tilt, "nc-tilt", message)
                    })?;
                }
                let [x, y, z, i, j, k] = values;
                let turn = Mat3::from_rotation_z(i.to_radians())
                    * Mat3::from_rotation_x(j.to_radians())
                    * Mat3::from_rotation_z(k.to_radians());
                self.state.tilt =
                    Tilt::Declared(Frame::from_mat3_translation(turn, Vec3::new(x, y, z)));
                self.state.position = UNKNOWN;
            }
            Some(_) if self.state.tilt != Tilt::None => {
                self.not_compensated("G69")?;
                self.state.tilt = Tilt::None;
                self.state.position = UNKNOWN;
            }
            _ => {}
        }
        Ok(())
    }

    /// Stops and the end; on FANUC what switches off, too, since it comes with the end of a move.
    fn flow(&mut self) -> Result<(), Fault> {
        if self.flavor == Flavor::Fanuc {
            if self.block.m(Group::Spindle) == Some(M::SpindleOff) {
                self.turn(Spindle::Off);
            }
            if self.block.m(Group::Coolant) == Some(M::CoolantOff) {
                self.cool(Coolant::Off)?;
            }
        }
        match self.block.m(Group::Flow) {
            Some(M::Stop) if self.awaits_tool() => {
                if self.state.spindle != Spindle::Off {
                    let message =
                        "a tool is changed by hand while the spindle turns; write M5 first";
                    return Err(self.block.at_group(Group::Flow, "nc-tool", message));
                }
                self.change_by_hand();
            }
            Some(M::Stop) => self.ops.push(Op::Stop),
            // GRBL reads M1 and does nothing.
            Some(M::OptionalStop) if self.flavor != Flavor::Grbl => self.ops.push(Op::OptionalStop),
            Some(M::End) => {
                // LinuxCNC and GRBL switch off by themselves; on FANUC it is the builder's choice.
                if self.flavor != Flavor::Fanuc {
                    self.turn(Spindle::Off);
                    self.cool(Coolant::Off)?;
                }
                self.state.ended = true;
                self.ops.push(Op::End);
            }
            _ => {}
        }
        Ok(())
    }

    /// mm in the unit of length, for the word of this letter.
    ///
    /// # Errors
    /// The program has not said which unit it is in.
    fn unit(&self, letter: u8) -> Result<f64, Fault> {
        match self.state.inches {
            Some(true) => Ok(INCH),
            Some(false) => Ok(1.0),
            None => {
                let message = "a length, and neither G20 nor G21 has been given";
                let fault = self.block.at_word(letter, "nc-units", message);
                Err(fault.help("a control keeps the unit of the program before").into())
            }
        }
    }

    /// The length (mm) of this letter.
    ///
    /// # Errors
    /// A length other than 0 before the unit is known. On FANUC a number other than 0 without a point:
    /// whether it counts units or least increments is a setting of the machine (parameter 3401, bit 0).
    pub(super) fn take_length(&mut self, letter: u8) -> Result<Option<f64>, Fault> {
        match self.take_pointed(letter)? {
            Some(word) if word.value != 0.0 => Ok(Some(word.value * self.unit(letter)?)),
            word => Ok(word.map(|_| 0.0)),
        }
    }

    /// The angle (degrees) of this letter; errors as [`Step::take_length`].
    pub(super) fn take_degrees(&mut self, letter: u8) -> Result<Option<f64>, Fault> {
        Ok(self.take_pointed(letter)?.map(|word| word.value))
    }

    fn take_pointed(&mut self, letter: u8) -> Result<Option<Word>, Fault> {
        match self.block.take(letter) {
            Some(word) if self.flavor == Flavor::Fanuc && !word.point && word.value != 0.0 => {
                Err(self.ambiguous(letter))
            }
            word => Ok(word),
        }
    }

    fn ambiguous(&self, letter: u8) -> Fault {
        let message = format!(
            "{} has no decimal point: millimetres or thousandths, as the machine is set; write the \
             point",
            self.block.shown(letter)
        );
        self.block.at_word(letter, "nc-decimal-point", message)
    }

    /// The whole number of this letter.
    pub(super) fn take_whole(&mut self, letter: u8) -> Result<Option<u32>, Fault> {
        let Some(word) = self.block.take(letter) else { return Ok(None) };
        let pointed = word.point && self.flavor == Flavor::Fanuc;
        if pointed || word.value.fract() != 0.0 || !(0.0..=99_999_999.0).contains(&word.value) {
            let message = format!("{} must be a whole number", char::from(letter));
            return Err(self.block.at_word(letter, "nc-number", message));
        }
        Ok(Some(word.value as u32))
    }

    /// # Errors
    /// Radius compensation is on while `what` happens.
    pub(super) fn not_compensated(&self, what: &str) -> Result<(), Fault> {
        if !self.state.compensation.is_on() {
            return Ok(());
        }
        let message = format!("{what} while radius compensation is on; cancel it with G40 first");
        Err(self.block.whole("nc-compensation", message))
    }

    pub(super) fn has_rotary_axes(&self, group: Group) -> Result<(), Fault> {
        if self.axes.contains(&true) {
            return Ok(());
        }
        Err(self.block.at_group(group, "nc-axis", "the machine has no rotary axis"))
    }
}
