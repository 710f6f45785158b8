//! Moves: straight ones, those to fixed places of the machine, and the swing to a tilted plane.

use super::block::Fault;
use super::execute::Step;
use super::state::{Length, Tilt, UNKNOWN};
use super::words::{FeedMode, Flavor, G, Group, Motion};
use geom::Vec3;
use program::{Feed, Op};

/// Where a block goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// In the programmed frame, mm.
    pub point: Vec3,
    /// Degrees of A, B, C.
    pub rotary: [f64; 3],
    /// The axes that the block names: bit 0 is X, 3 is A.
    pub named: u8,
}

impl Step<'_, '_, '_> {
    /// What the block moves.
    pub(super) fn motion(&mut self) -> Result<(), Fault> {
        let one_shot = self.block.g(Group::OneShot);
        match one_shot {
            Some(G::Home | G::SecondHome) => {
                self.interpolation()?;
                self.home(one_shot == Some(G::SecondHome))
            }
            Some(G::Machine) => {
                self.interpolation()?;
                self.machine_position()
            }
            Some(G::SwingToTilt) => {
                self.interpolation()?;
                self.swing()
            }
            Some(G::LookAhead) => self.look_ahead(),
            _ => self.interpolation().and_then(|()| self.go()),
        }
    }

    /// The motion word of the block: on LinuxCNC and GRBL also a cycle or `G80`.
    pub(super) fn motion_of_block(&self) -> Option<Motion> {
        match self.block.g(Group::Motion) {
            Some(G::Motion(motion)) => Some(motion),
            Some(_) => None,
            None => self.state.motion,
        }
    }

    /// Takes over the words for interpolation and cycles.
    fn interpolation(&mut self) -> Result<(), Fault> {
        let motion = self.block.g(Group::Motion);
        let cycle = self.block.g(Group::Cycle);
        if cycle.is_some() && matches!(motion, Some(G::Cycle(_)))
            || motion.is_some() && matches!(cycle, Some(G::Cycle(_)))
        {
            let message = "a cycle and another motion word in a block";
            return Err(self.block.at_group(Group::Cycle, "nc-modal-group", message));
        }
        for word in [cycle, motion].into_iter().flatten() {
            match word {
                G::Motion(motion) => {
                    self.end_cycle();
                    self.state.motion = Some(motion);
                }
                G::CancelCycle => {
                    self.end_cycle();
                    // FANUC goes on with the interpolation of before: a cycle is no part of group 01.
                    if self.flavor != Flavor::Fanuc {
                        self.state.motion = None;
                    }
                }
                G::Cycle(canned) => self.begin_cycle(canned)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Moves as the modes say.
    fn go(&mut self) -> Result<(), Fault> {
        if self.state.cycle.is_some() {
            return self.holes();
        }
        let arc_words = b"IJKR".iter().any(|&letter| self.block.has(letter));
        let Some(motion) = self.state.motion else {
            return match b"XYZABC".iter().find(|&&letter| self.block.has(letter)) {
                Some(&letter) => {
                    let message = "an axis word, and no G0, G1, G2 or G3 says how to move";
                    Err(self.block.at_word(letter, "nc-no-motion", message))
                }
                None => Ok(()),
            };
        };
        match motion {
            Motion::Arc { clockwise } => {
                let target = self.target(false)?;
                let asked = matches!(self.block.g(Group::Motion), Some(G::Motion(_)));
                if target.named == 0 && !arc_words && !asked {
                    return Ok(());
                }
                self.feed_for_cut()?;
                self.arc(target, clockwise)
            }
            Motion::Rapid | Motion::Line => {
                let target = self.target(false)?;
                if target.named == 0 {
                    return Ok(());
                }
                if motion == Motion::Line {
                    self.feed_for_cut()?;
                }
                self.straight(target, motion == Motion::Rapid)
            }
        }
    }

    /// The axis words of the block. With `unknown_stays` an increment of 0 from an unknown position
    /// is legal and leaves it unknown.
    ///
    /// # Errors
    /// An increment from an unknown position; an axis that the machine lacks; a rotary axis in a
    /// tilted plane.
    pub(super) fn target(&mut self, unknown_stays: bool) -> Result<Target, Fault> {
        let mut target = Target { point: self.state.position, rotary: self.state.rotary, named: 0 };
        for (axis, letter) in b"XYZ".iter().copied().enumerate() {
            if let Some(value) = self.take_length(letter)? {
                target.named |= 1 << axis;
                target.point[axis] =
                    self.advance(target.point[axis], value, letter, unknown_stays)?;
            }
        }
        for (axis, letter) in b"ABC".iter().copied().enumerate() {
            if !self.block.has(letter) {
                continue;
            }
            if !self.axes[axis] {
                let message = format!("the machine has no axis {}", char::from(letter));
                return Err(self.block.at_word(letter, "nc-axis", message));
            }
            if self.state.tilt != Tilt::None {
                let message =
                    "a rotary axis moved by hand in a tilted plane; G53.1 or G69 moves it";
                return Err(self.block.at_word(letter, "nc-tilt", message));
            }
            if let Some(value) = self.take_degrees(letter)? {
                target.named |= 1 << (axis + 3);
                target.rotary[axis] =
                    self.advance(target.rotary[axis], value, letter, unknown_stays)?;
            }
        }
        Ok(target)
    }

    /// The coordinate that `value` gives an axis that stands at `from`.
    pub(super) fn advance(
        &self,
        from: f64,
        value: f64,
        letter: u8,
        unknown_stays: bool,
    ) -> Result<f64, Fault> {
        if !self.state.incremental {
            return Ok(value);
        }
        if from.is_nan() && !(unknown_stays && value == 0.0) {
            let message =
                format!("an increment, and where {} stands is not known", char::from(letter));
            let fault = self.block.at_word(letter, "nc-unknown-position", message);
            return Err(fault.help("give the position in G90 first").into());
        }
        Ok(from + value)
    }

    /// Whether the block may move at feed.
    ///
    /// # Errors
    /// No feed is active, or in `G93` the block has none of its own, or the tool is not in.
    pub(super) fn feed_for_cut(&mut self) -> Result<(), Fault> {
        let message = match self.state.feed {
            None => "a move at feed, and no feed has been given by F",
            Some(Feed::InverseTime(_)) if !self.block.gives(b'F') => {
                "in G93 each move needs its own F"
            }
            Some(_) if self.state.feed_mode == FeedMode::PerTurn && self.spindle_stands() => {
                "a feed per turn while the spindle stands"
            }
            Some(_) if self.awaits_tool() => {
                let message = "T has named a tool, and no M0 has stopped the program to put it in";
                return Err(self.block.whole("nc-tool", message));
            }
            Some(_) => {
                self.state.cut = true;
                return Ok(());
            }
        };
        Err(self.block.whole("nc-feed", message))
    }

    fn spindle_stands(&self) -> bool {
        self.state.spindle == program::Spindle::Off && !self.state.rigid
    }

    /// A straight move to `target`.
    pub(super) fn straight(&mut self, target: Target, rapid: bool) -> Result<(), Fault> {
        if let Tilt::Declared(_) = self.state.tilt {
            let message =
                "a move in a tilted plane before G53.1 has brought the tool upright to it";
            return Err(self.block.whole("nc-tilt", message));
        }
        let (from, to) = (self.state.position, target.point);
        let aside = !(to.x.is_finite() && to.y.is_finite());
        if matches!(self.state.tilt, Tilt::Reached(_)) && to.z.is_finite() && aside {
            let message =
                "Z in a tilted plane before X and Y: where the tool goes down is not known";
            return Err(self.block.whole("nc-unknown-position", message));
        }
        // On LinuxCNC with any straight move (`rs274`).
        let [first, second, _] = self.state.plane.axes();
        if from[first] != to[first] || from[second] != to[second] || self.flavor == Flavor::LinuxCnc
        {
            self.switch_compensation();
        }
        let pose = self.state.pose(to, target.rotary);
        self.ops.push(if rapid { Op::Rapid(pose) } else { Op::Line(pose) });
        self.arrive(target);
        Ok(())
    }

    /// The machine stands at `target` from here on.
    pub(super) fn arrive(&mut self, target: Target) {
        self.state.position = target.point;
        self.state.rotary = target.rotary;
        self.state.moved = true;
    }

    /// Compensation starts and ends with the next linear move in the plane.
    fn switch_compensation(&mut self) {
        let compensation = &mut self.state.compensation;
        if compensation.active != compensation.asked {
            compensation.active = compensation.asked;
            self.ops.push(Op::Compensation(compensation.asked));
        }
    }

    /// `G28`, `G30`: by rapid through the point of the block to the reference position, the named axes
    /// only; LinuxCNC and GRBL without a word: all axes at once.
    fn home(&mut self, second: bool) -> Result<(), Fault> {
        self.before_fixed_position()?;
        // On LinuxCNC and GRBL two words that use axis words exclude each other.
        let motion = self.block.g(Group::Motion);
        if motion.is_some_and(|g| g != G::Motion(Motion::Rapid) || self.flavor != Flavor::Fanuc) {
            let message = "G28 or G30 beside a motion word: which one has the axis words?";
            return Err(self.block.at_group(Group::OneShot, "nc-modal-group", message));
        }
        if second && self.flavor == Flavor::Fanuc {
            let message = "P names the reference position 2, 3 or 4";
            if !matches!(self.take_whole(b'P')?, None | Some(2..=4)) {
                return Err(self.block.at_word(b'P', "nc-home", message));
            }
        }
        let mut target = self.target(true)?;
        if target.named == 0 {
            if self.flavor == Flavor::Fanuc {
                let message = "name the axes that go to the reference position";
                return Err(self.block.at_group(Group::OneShot, "nc-home", message));
            }
            target.named = self.all_axes();
        }
        // An unknown coordinate is unequal to itself: compare what the block changes.
        let changes = |from: f64, to: f64| from != to && !to.is_nan();
        let moves = (0..3).any(|i| {
            changes(self.state.position[i], target.point[i])
                || changes(self.state.rotary[i], target.rotary[i])
        });
        if moves {
            self.straight(target, true)?;
        }
        self.leave_for(target.named);
        Ok(())
    }

    /// `G53`: to a position in machine coordinates, by rapid.
    fn machine_position(&mut self) -> Result<(), Fault> {
        self.before_fixed_position()?;
        if self.state.incremental {
            let message = "G53 takes absolute positions; write G90";
            return Err(self.block.at_group(Group::OneShot, "nc-machine-position", message));
        }
        if self.flavor != Flavor::Fanuc && self.state.motion != Some(Motion::Rapid) {
            let message = "G53 is followed with G0 only: where a cut in machine coordinates is, only \
                           the machine knows";
            return Err(self.block.at_group(Group::OneShot, "nc-machine-position", message));
        }
        let named = self.target(false)?.named;
        if named == 0 {
            let message = "name the axes that G53 moves";
            return Err(self.block.at_group(Group::OneShot, "nc-machine-position", message));
        }
        self.leave_for(named);
        Ok(())
    }

    /// What holds before each move to a fixed place of the machine.
    fn before_fixed_position(&mut self) -> Result<(), Fault> {
        self.not_compensated("a move to a fixed position")?;
        if self.state.cycle.is_some() {
            let message = "a move to a fixed position in a cycle; cancel it with G80 first";
            return Err(self.block.at_group(Group::OneShot, "nc-cycle", message));
        }
        if self.state.tilt != Tilt::None {
            let message = "a move to a fixed position in a tilted plane; cancel it with G69 first";
            return Err(self.block.at_group(Group::OneShot, "nc-tilt", message));
        }
        Ok(())
    }

    /// The named axes go where only the machine knows.
    fn leave_for(&mut self, named: u8) {
        self.switch_compensation();
        for axis in 0..3 {
            if named & 1 << axis != 0 {
                self.state.position[axis] = f64::NAN;
            }
            if named & 8 << axis != 0 {
                self.state.rotary[axis] = f64::NAN;
            }
        }
        self.state.moved = true;
        self.ops.push(Op::Home(named));
    }

    fn all_axes(&self) -> u8 {
        (0..3).filter(|&axis| self.axes[axis]).fold(7, |bits, axis| bits | 8 << axis)
    }

    /// `G53.1`: the rotary axes bring the tool along Z of the tilted plane. Where they then stand and
    /// where the tip is depends on the machine.
    fn swing(&mut self) -> Result<(), Fault> {
        let Tilt::Declared(frame) = self.state.tilt else {
            let message = "G53.1 and no tilted plane has been declared by G68.2";
            return Err(self.block.at_group(Group::OneShot, "nc-tilt", message));
        };
        self.state.tilt = Tilt::Reached(frame);
        self.state.position = UNKNOWN;
        for axis in 0..3 {
            if self.axes[axis] {
                self.state.rotary[axis] = f64::NAN;
            }
        }
        self.state.moved = true;
        Ok(())
    }

    /// `G5.1 Q1` and `Q0`: look-ahead, which changes how fast the path is run and not where it is.
    fn look_ahead(&mut self) -> Result<(), Fault> {
        match self.take_whole(b'Q')? {
            Some(0 | 1) => Ok(()),
            _ => {
                let message = "G5.1 needs Q1 or Q0";
                Err(self.block.at_group(Group::OneShot, "nc-look-ahead", message))
            }
        }
    }

    /// Whether compensation is about to change with the next linear move.
    pub(super) fn compensation_waits(&self) -> bool {
        self.state.compensation.active != self.state.compensation.asked
    }

    /// Whether the control keeps the tool centre point.
    pub(super) fn keeps_center(&self) -> bool {
        matches!(self.state.length, Length::Center(_))
    }
}
