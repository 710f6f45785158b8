//! Fixed places of the machine: reference positions, machine coordinates, the swing to a tilted plane;
//! and where a probe stops.

use super::motion::{LINEAR, Target};
use super::state::{Length, Tilt, UNKNOWN};
use super::step::Step;
use crate::event::{Action, Risk, TiltChoice};
use crate::iso::language::Fault;
use crate::iso::language::words::{Group, Motion};
use geom::Vec3;
use program::{Axes, MachineMove, Probe, Rule};

/// How far from a probe, across its way, a point of the surface may be that it touches, mm: words are rounded, those of two decimals
/// by up to 0.005 mm along X and along Y.
const REACH: f64 = 0.0075;

impl Step<'_, '_, '_> {
    /// `G28`, `G30`: by rapid through the point of the block to the reference position, the named axes
    /// only; LinuxCNC and GRBL without a word: all axes at once.
    pub(super) fn home(&mut self, second: bool) -> Result<(), Fault> {
        self.before_fixed_position()?;
        // FANUC goes to the reference position out of a tilted plane (B-64484EN-2, "Tilted working plane").
        if self.state.tilt != Tilt::None && !self.facts.homes.leaves_tilt {
            return Err(self.in_tilted_plane());
        }
        if self.facts.homes.switches {
            return self.home_switches();
        }
        if second && self.facts.homes.numbered {
            let message = "P names the reference position 2, 3 or 4";
            if !matches!(self.take_whole(b'P')?, None | Some(2..=4)) {
                return Err(self.block.at_word(b'P', Rule::Home, message));
            }
        }
        let mut target = self.target(true)?;
        if target.named == 0 {
            if self.facts.homes.names_axes {
                let message = "name the axes that go to the reference position";
                return Err(self.block.at_group(Group::OneShot, Rule::Home, message));
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
        self.state.via = Some(self.state.place.point(target.point));
        // "G28 ... also cancels tool length offsets" is the Haas manual's word for it.
        if self.facts.homes.cancels_length {
            self.change_length(Length::None);
        }
        let home = self.state.homes[usize::from(second)];
        if !home.is_nan() && target.named < 8 {
            let action = home_action(target.named);
            return self.go_to_machine(home, target.named, true, action);
        }
        let is_stored = second || self.facts.homes.stored;
        if is_stored && target.named & 4 != 0 {
            self.actions.push(Action::Risk(Risk::STORED_POSITION.into()));
        }
        self.leave_for(target.named);
        Ok(())
    }

    /// Marlin: to the switches of the axes that are named, with or without a number; all without one.
    fn home_switches(&mut self) -> Result<(), Fault> {
        let mut named = 0;
        for (axis, letter) in b"XYZABC".iter().copied().enumerate() {
            if self.block.take(letter).is_some() {
                if axis >= 3 {
                    self.has_axis(axis - 3, letter)?;
                }
                named |= 1 << axis;
            }
        }
        let named = if named == 0 { self.all_axes() } else { named };
        if named & 4 != 0 {
            self.actions.push(Action::Risk(Risk::STORED_POSITION.into()));
        }
        if self.facts.offsets.homing_takes_away {
            self.state.frames.taken_away(named);
        }
        self.leave_for(named);
        Ok(())
    }

    /// `G28.1`, `G30.1`: the reference position is where the machine stands.
    pub(super) fn store_home(&mut self, second: bool) -> Result<(), Fault> {
        self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
        self.counts_machine()?;
        self.state.homes[usize::from(second)] = self.machine();
        self.go()
    }

    /// `G29`: by rapid through the point on the way of the last `G28`.
    pub(super) fn leave_home(&mut self) -> Result<(), Fault> {
        self.before_fixed_position()?;
        if self.state.tilt != Tilt::None {
            return Err(self.in_tilted_plane());
        }
        let Some(via) = self.state.via else {
            let message = "G29 goes through the point of the last G28, and there was none";
            return Err(self.block.at_group(Group::OneShot, Rule::Home, message));
        };
        // "In general, it is commanded immediately following the G28 command" (B-64484EN-2, "Reference position return").
        let away = |axis: usize| self.block.has(LINEAR[axis]) && self.state.position[axis].is_nan();
        if !(0..3).any(away) {
            let message =
                "G29 comes from the reference position, and no axis that it names is there";
            let fault = self.block.at_group(Group::OneShot, Rule::Home, message);
            return Err(fault
                .help("write it right behind its G28; or G0 to the place itself")
                .into());
        }
        let via = self.state.place.programmed(via);
        let mut first = self.place_of_tool();
        for axis in 0..3 {
            if self.block.has(LINEAR[axis]) {
                if via[axis].is_nan() {
                    let message = "G29 goes through the point of the last G28, which is not known";
                    return Err(self.block.at_word(LINEAR[axis], Rule::Home, message));
                }
                first.point[axis] = via[axis];
            }
        }
        self.straight(first, true)?;
        // In G91 the words count from the point on the way.
        let target = self.target(false)?;
        self.straight(target, true)
    }

    fn place_of_tool(&self) -> Target {
        Target { point: self.state.position, rotary: self.state.rotary, named: 0 }
    }

    /// Where the gauge line stands in machine coordinates, NaN where not known.
    fn machine(&self) -> Vec3 {
        let tip = self.state.place.point(self.state.position);
        self.state.frames.to_machine(tip) + Vec3::Z * self.length_in_use()
    }

    /// The named axes go to `place`, given for the gauge line in machine coordinates: `unknown` is that where nobody
    /// knows where it is in the work.
    fn go_to_machine(
        &mut self,
        place: Vec3,
        named: u8,
        rapid: bool,
        unknown: Action,
    ) -> Result<(), Fault> {
        let mut machine = self.machine();
        for axis in 0..3 {
            if named & 1 << axis != 0 {
                machine[axis] = place[axis];
            }
        }
        let tip = machine - Vec3::Z * self.length_in_use();
        let point = self.state.place.programmed(self.state.frames.of_machine(tip));
        if (0..3).any(|axis| named & 1 << axis != 0 && point[axis].is_nan()) {
            self.leave(named, unknown);
            return Ok(());
        }
        let point = Vec3::select(point.is_nan_mask(), self.state.position, point);
        self.straight(Target { point, named, ..self.place_of_tool() }, rapid)?;
        self.sends_home(named);
        Ok(())
    }

    /// `G60`: by rapid, from one side whichever way it comes: past the end where it must.
    pub(super) fn one_sided(&mut self) -> Result<(), Fault> {
        let target = self.target(false)?;
        if target.named == 0 {
            return Ok(());
        }
        self.actions.push(Action::Risk(Risk::ONE_SIDED.into()));
        self.straight(target, true)
    }

    /// `G38.2` to `G38.5`, `G31`: towards a point until the probe answers.
    pub(super) fn probe(&mut self, away: bool, must_answer: bool) -> Result<(), Fault> {
        self.not_compensated("probing")?;
        let target = self.target(false)?;
        if target.named == 0 {
            return self.has_no_axis_word();
        }
        if target.named >= 8 {
            return Err(self.block.whole(Rule::Probe, "a rotary axis in a probing move"));
        }
        self.feed_for_cut()?;
        self.state.probed = if away { None } else { self.touched(&target, must_answer)? };
        let end = self.state.pose(target.point, target.rotary);
        self.actions.push(Action::Probe(Box::new(Probe { end, away, must_answer, place: None })));
        self.state.arrive(target.point, target.rotary);
        for axis in 0..3 {
            if target.named & 1 << axis != 0 {
                self.state.position[axis] = f64::NAN;
            }
        }
        self.state.touching = target.named == 4 && !away && must_answer;
        Ok(())
    }

    /// Where a probe on its way to `target` touches the surface: as high as at the nearest point; none where that is
    /// not known. The tool comes to rest somewhat beyond.
    ///
    /// # Errors
    /// It has to touch it, and does not.
    fn touched(&self, target: &Target, must_answer: bool) -> Result<Option<Vec3>, Fault> {
        let place = &self.state.place;
        let (from, to) = (place.point(self.state.position), place.point(target.point));
        let across = |point: &Vec3| point.truncate().distance(to.truncate());
        let below = self.state.touches.iter().filter(|point| across(point) <= REACH);
        let nearest = below.min_by(|a, b| across(a).total_cmp(&across(b)));
        let straight = from.truncate() == to.truncate();
        let Some(point) = nearest.filter(|_| straight) else {
            return Ok(None);
        };
        match (to.z..=from.z).contains(&point.z) {
            true => {
                let unit = if self.state.inches == Some(true) { geom::INCH } else { 1.0 };
                Ok(Some(place.programmed(to.with_z(point.z)) / unit))
            }
            false if !must_answer => Ok(None),
            false => {
                let message = format!(
                    "the surface is at Z{} mm, not on the way of the probe: the control stops here",
                    point.z
                );
                Err(self.block.whole(Rule::Probe, message))
            }
        }
    }

    /// `G53`: to a position in machine coordinates, by rapid.
    pub(super) fn machine_position(&mut self) -> Result<(), Fault> {
        self.before_fixed_position()?;
        if self.state.tilt != Tilt::None {
            return Err(self.in_tilted_plane());
        }
        if self.state.incremental {
            let message = "G53 takes absolute positions; write G90";
            return Err(self.block.at_group(Group::OneShot, Rule::MachinePosition, message));
        }
        let rapid = self.facts.homes.numbered || self.state.motion == Some(Motion::Rapid);
        if !rapid && self.state.motion != Some(Motion::Line) {
            let message = "G53 needs G0 or G1";
            return Err(self.block.at_group(Group::OneShot, Rule::MachinePosition, message));
        }
        let mut place = UNKNOWN;
        let mut named = 0;
        let diameter = std::mem::replace(&mut self.state.diameter, false);
        for axis in 0..3 {
            if let Some(value) = self.take_length(LINEAR[axis])? {
                place[axis] = value;
                named |= 1 << axis;
            }
        }
        self.state.diameter = diameter;
        let linear = named;
        let target = self.target(false)?;
        named |= target.named;
        if named == 0 {
            let message = "name the axes that G53 moves";
            return Err(self.block.at_group(Group::OneShot, Rule::MachinePosition, message));
        }
        self.state.frames.taken_up(self.state.work_offset.is_some());
        let value = |axis: usize, value: f64| (named & 1 << axis != 0).then_some(value);
        let to = MachineMove {
            linear: [0, 1, 2].map(|axis| value(axis, place[axis])),
            rotary: [0, 1, 2].map(|axis| value(axis + 3, target.rotary[axis])),
        };
        if rapid && named != linear {
            self.leave(named, Action::MachineMove(Box::new(to)));
            return Ok(());
        }
        if !rapid {
            self.feed_for_cut()?;
            let known = !self.machine().is_nan();
            if !known || named != linear {
                let message = "G53 is followed with G0 only: where a cut in machine coordinates is, \
                               only the machine knows";
                return Err(self.block.at_group(Group::OneShot, Rule::MachinePosition, message));
            }
        }
        self.go_to_machine(place, named, rapid, Action::MachineMove(Box::new(to)))
    }

    /// What holds before each move to a fixed place of the machine.
    fn before_fixed_position(&mut self) -> Result<(), Fault> {
        self.counts_machine()?;
        self.not_compensated("a move to a fixed position")?;
        if self.facts.homes.cancels_length && self.state.keeps_center() {
            let message = "a move to a fixed position while G234 keeps the tool centre point";
            let fault = self.block.at_group(Group::OneShot, Rule::MachinePosition, message);
            return Err(fault.help("end it by G49 before").into());
        }
        if self.state.cycle.is_some() {
            let message = "a move to a fixed position in a cycle; cancel it with G80 first";
            return Err(self.block.at_group(Group::OneShot, Rule::Cycle, message));
        }
        Ok(())
    }

    /// `G29`, `G53`, and `G28` of most controls, are not for a tilted plane.
    fn in_tilted_plane(&self) -> Fault {
        let message = "a move to a fixed position in a tilted plane; cancel it with G69 first";
        self.block.at_group(Group::OneShot, Rule::TiltedPlane, message)
    }

    /// The named axes go to their fixed positions.
    fn leave_for(&mut self, named: u8) {
        self.leave(named, home_action(named));
    }

    /// The named axes go where only the machine knows, by `action`.
    fn leave(&mut self, named: u8, action: Action) {
        self.switch_compensation();
        let mut point = self.state.place.point(self.state.position);
        if self.state.tilt != Tilt::None || self.state.keeps_center() {
            // Each axis of the machine moves the tip along all of the work.
            point = UNKNOWN;
        }
        for (axis, gone) in self.state.frames.depend_on(named).into_iter().enumerate() {
            if gone {
                point[axis] = f64::NAN;
            }
            if named & 8 << axis != 0 {
                self.state.rotary[axis] = f64::NAN;
            }
        }
        self.state.position = self.state.place.programmed(point);
        (self.state.moved, self.state.touching) = (true, false);
        self.sends_home(named);
        self.actions.push(action);
    }

    /// The named axes stand at a fixed position: Z without its tool length, where the control takes that away there.
    fn sends_home(&mut self, named: u8) {
        let z = named & 4 != 0;
        self.state.z_is_home |= z;
        self.state.length_is_suspended |=
            z && self.facts.tools.length_as_set_up && self.state.length != Length::None;
    }

    fn all_axes(&self) -> u8 {
        (0..3).filter(|&axis| self.axes[axis]).fold(7, |bits, axis| bits | 8 << axis)
    }

    /// `G53.1`: the rotary axes bring the tool along Z of the tilted plane. Where they then stand and
    /// where the tip is depends on the machine.
    pub(super) fn swing(&mut self) -> Result<(), Fault> {
        let Tilt::Declared(frame) = self.state.tilt else {
            let message = "G53.1 and no tilted plane has been declared by G68.2";
            return Err(self.block.at_group(Group::OneShot, Rule::TiltedPlane, message));
        };
        self.state.tilt = Tilt::Reached(frame);
        self.state.frames.tilt = Some(frame);
        self.state.place = self.state.frames.place();
        self.state.position = UNKNOWN;
        for axis in 0..3 {
            if self.axes[axis] {
                self.state.rotary[axis] = f64::NAN;
            }
        }
        self.state.moved = true;
        self.actions.push(Action::Swivel(TiltChoice::LeastTurn));
        Ok(())
    }
}

/// The axes whose bits are set go to their fixed positions.
fn home_action(named: u8) -> Action {
    Action::Home(Axes::of([0, 1, 2, 3, 4, 5].map(|bit| named >> bit & 1 == 1)))
}
