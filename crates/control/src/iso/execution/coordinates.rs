//! The words that move, turn, scale or mirror the coordinates.

use super::motion::LINEAR;
use super::state::frames::{Six, Transform, Unknown};
use super::state::{Polar, Tilt, UNKNOWN};
use super::step::Step;
use crate::event::{Action, Risk};
use crate::iso::language::Fault;
use crate::iso::language::block::Word;
use crate::iso::language::words::{G, Group};
use geom::{Frame, Mat3, Vec3};
use program::{Purpose, Rule, WorkOffset, WorkOffsetData};

/// The letters of the axes, in the order of [`Six`].
const AXES: [u8; 6] = *b"XYZABC";

impl Step<'_, '_, '_> {
    /// `G92` and its kin, `G52`, `G10`.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "`Step::motion` names each word and asks for these alone"
    )]
    pub(super) fn coordinates(&mut self, word: G) -> Result<(), Fault> {
        if word == G::WriteData {
            return self.write_data();
        }
        self.may_change_coordinates(Group::OneShot)?;
        if !matches!(word, G::CancelShift { .. }) && self.state.frames.is_transformed() {
            let message = "a shift while the coordinates are turned, scaled, mirrored or tilted";
            return Err(self.block.at_group(Group::OneShot, Rule::Frame, message));
        }
        match word {
            G::ShiftHere => {
                // It stays when the program has ended. Many programs of a wire-EDM machine begin so: a contour that is read from
                // one hangs on no zero.
                if self.facts.wire.is_none() || self.state.purpose != Purpose::Contour {
                    self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
                }
                let values = self.axis_values()?;
                let here = self.here();
                // After a way home the events do not say what G92 does.
                self.state.is_reported &=
                    (0..3).all(|i| values[i].is_none() || here[i].is_finite());
                let shifted = self.state.frames.shift_here(here, values);
                self.known(shifted)?;
                self.reframe();
                self.stand_at(values);
            }
            G::ShiftTo => {
                let values = self.axis_values()?;
                if self.facts.offsets.local_apart {
                    for (local, value) in self.state.frames.local.iter_mut().zip(values) {
                        *local = value.unwrap_or(*local);
                    }
                } else {
                    // It is kept where G92 is, and stays when the program has ended.
                    if values.iter().flatten().any(|value| *value != 0.0) {
                        self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
                    }
                    let shifted = self.state.frames.shift_to(values);
                    self.known(shifted)?;
                }
                self.reframe();
            }
            G::CancelShift { keep } => {
                let known = self.state.frames.unshift(keep);
                self.reframe();
                if !known {
                    // A shift that somebody else has set.
                    self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
                    self.state.position = UNKNOWN;
                }
            }
            _ => {
                let shifted = self.state.frames.restore();
                self.known(shifted)?;
                self.reframe();
            }
        }
        Ok(())
    }

    /// What holds before the coordinates change.
    fn may_change_coordinates(&mut self, group: Group) -> Result<(), Fault> {
        self.not_compensated("a change of the coordinates")?;
        if self.state.cycle.is_some() {
            let message = "the coordinates change within a cycle; cancel it with G80 first";
            return Err(self.block.at_group(group, Rule::Cycle, message));
        }
        Ok(())
    }

    fn known<T>(&self, answer: Result<T, Unknown>) -> Result<T, Fault> {
        answer.map_err(|Unknown| {
            let message = "by how much this moves the zero depends on what stands in the control";
            self.block
                .at_group(Group::OneShot, Rule::UnknownShift, message)
                .help("write the offset, or clear G92, before the first move")
                .into()
        })
    }

    /// Where the tool stands, in programmed coordinates.
    fn here(&self) -> Six {
        let (p, r) = (self.state.position, self.state.rotary);
        [p.x, p.y, p.z, r[0], r[1], r[2]]
    }

    /// The tool stands at these coordinates.
    fn stand_at(&mut self, values: [Option<f64>; 6]) {
        for axis in 0..3 {
            if let Some(value) = values[axis] {
                self.state.position[axis] = value;
            }
            if let Some(value) = values[axis + 3] {
                self.state.rotary[axis] = value;
            }
        }
    }

    /// The axis words of a block that moves nothing.
    ///
    /// # Errors
    /// There is none, or the machine lacks the axis.
    fn axis_values(&mut self) -> Result<[Option<f64>; 6], Fault> {
        let mut values = [None; 6];
        for (axis, letter) in AXES.into_iter().enumerate() {
            if axis < 3 {
                values[axis] = self.take_length(letter)?;
            } else if self.block.has(letter) {
                self.has_axis(axis - 3, letter)?;
                values[axis] = self.take_degrees(letter)?;
            }
        }
        if values == [None; 6] {
            let message = "no axis word says by how much";
            return Err(self.block.at_group(Group::OneShot, Rule::Frame, message));
        }
        Ok(values)
    }

    /// The zero has moved and the tool has not: new coordinates for where it stands.
    pub(super) fn reframe(&mut self) {
        let state = &mut *self.state;
        let (old, new) = (state.place, state.frames.place());
        let point = old.point(state.position);
        let rotary = old.rotary(state.rotary);
        let shift = new.rotary([0.0; 3]);
        state.position = new.programmed(point);
        state.rotary = [0, 1, 2].map(|i| rotary[i] - shift[i]);
        state.place = new;
    }

    /// `G54` and the others.
    pub(super) fn work_offset(&mut self) -> Result<(), Fault> {
        let number = match self.block.g(Group::WorkOffset) {
            Some(G::FurtherOffset { most }) => 59 + self.further_offset(most)?,
            // The first six of these are G54 to G59.
            Some(G::WorkOffset(number)) => match self.facts.offsets.by_g59 {
                Some(most) if number == 59 && self.block.has(b'P') => {
                    53 + self.further_offset(most)?
                }
                _ => number,
            },
            _ => return Ok(()),
        };
        let before = self.state.work_offset;
        self.state.frames.named(before.is_some_and(|before| before != number));
        if before == Some(number) {
            return Ok(());
        }
        self.may_change_coordinates(Group::WorkOffset)?;
        let frames = &mut self.state.frames;
        if frames.active() != number {
            let machine = frames.to_machine(self.state.place.point(self.state.position));
            frames.select(number);
            self.state.place = frames.place();
            self.state.position = self.state.place.programmed(frames.of_machine(machine));
        }
        self.state.work_offset = Some(number);
        self.actions.extend(WorkOffset::numbered(number).map(Action::WorkOffset));
        Ok(())
    }

    /// The P that names one of `most` work offsets.
    fn further_offset(&mut self, most: u32) -> Result<u32, Fault> {
        match self.take_whole(b'P')? {
            Some(number) if (1..=most).contains(&number) => Ok(number),
            _ => {
                let message = format!("the work offset is named by P1 to P{most}");
                Err(self.block.at_group(Group::WorkOffset, Rule::WorkOffset, message))
            }
        }
    }

    /// `G10`: data of the control. What is written before it is used sets the control up.
    fn write_data(&mut self) -> Result<(), Fault> {
        let Some(kind) = self.take_whole(b'L')? else {
            let message = "G10 needs L, which says what is written";
            return Err(self.block.at_group(Group::OneShot, Rule::Data, message));
        };
        match kind {
            2 | 20 => self.write_offset(kind),
            1 | 10..=13 => self.write_tool(kind),
            _ => {
                let message = format!("G10 L{kind} is not known to this control");
                Err(self.block.at_word(b'L', Rule::Data, message))
            }
        }
    }

    fn write_offset(&mut self, kind: u32) -> Result<(), Fault> {
        self.may_change_coordinates(Group::OneShot)?;
        if self.state.frames.is_transformed() {
            let message = "an offset is written while the coordinates are turned, scaled or tilted";
            return Err(self.block.at_group(Group::OneShot, Rule::Frame, message));
        }
        let which = self.take_whole(b'P')?;
        let active = self.state.frames.active();
        let offsets = &self.facts.offsets;
        let number = (offsets.written)(kind, which, active);
        let external = offsets.external && (kind, which) == (2, Some(0));
        let Some(number) = number.or(external.then_some(active)) else {
            let message = "P names no work offset that can be written here";
            return Err(self.block.at_group(Group::OneShot, Rule::Data, message));
        };
        let sets_here = kind == 20 && offsets.sets_here;
        let angle = match offsets.turn && !sets_here {
            true => self.take_degrees(b'R')?,
            false => None,
        };
        let values = if angle.is_some() && !AXES.iter().any(|&letter| self.block.has(letter)) {
            [None; 6]
        } else {
            self.axis_values()?
        };
        if sets_here && self.facts.tools.by_hand && number == active && self.is_touch_off(values) {
            // How long the tool is the control does not know: as much longer, as much higher is the zero.
            self.state.touching = false;
            self.stand_at(values);
            let at = self.state.place.point(self.state.position).z;
            self.actions.push(Action::TouchOff(at));
            return Ok(());
        }
        // Values that are added, turned or counted from the tool are not the place of a zero.
        let add = offsets.adds && self.state.incremental;
        let places_zero = !sets_here && !external && !add && angle.is_none();
        if !(places_zero && self.state.sets_work_offsets) {
            self.actions.push(Action::Risk(Risk::OPERATOR_DATA.into()));
        }
        if let (true, Some(offset)) = (places_zero, WorkOffset::numbered(number)) {
            let data = WorkOffsetData { offset, zero: values };
            self.actions.push(Action::WorkOffsetData(Box::new(data)));
        }
        let here = self.here();
        let point = self.state.place.point(self.state.position);
        let frames = &mut self.state.frames;
        if sets_here {
            let written = frames.write_here(number, here, values);
            if self.known(written)? {
                self.reframe();
                self.stand_at(values);
            }
            return Ok(());
        }
        let (machine, used) = (frames.to_machine(point), frames.is_used());
        let rotary = frames.rotary_origin();
        let written = match external {
            true => frames.write_external(values, add),
            false => frames.write(number, values, angle, add),
        };
        if self.known(written)? {
            if used {
                self.reframe();
            } else {
                let point = self.state.frames.of_machine(machine);
                self.state.position = self.state.place.programmed(point);
                let now = self.state.frames.rotary_origin();
                for axis in (0..3).filter(|axis| values[axis + 3].is_some()) {
                    self.state.rotary[axis] -= now[axis] - rotary[axis];
                }
            }
        }
        Ok(())
    }

    /// Whether Z alone is written, where the tool rests on what its probing move has touched.
    fn is_touch_off(&self, values: [Option<f64>; 6]) -> bool {
        let names_z = values.iter().enumerate().all(|(axis, value)| value.is_some() == (axis == 2));
        names_z && self.is_touching()
    }

    /// Whether the tool rests on what its probing move has touched.
    pub(super) fn is_touching(&self) -> bool {
        self.state.touching && self.state.position.z.is_nan()
    }

    /// Polar coordinates, mirror, scale, turn and tilt, as the block switches them on or off.
    pub(super) fn transforms(&mut self) -> Result<(), Fault> {
        match self.block.g(Group::Polar) {
            Some(G::Polar(true)) => {
                // FANUC counts from the zero, Mach3 from where the tool stands.
                let at_zero = self.facts.frames.pole_at_zero;
                let pole = if at_zero { Vec3::ZERO } else { self.state.position };
                self.state.polar = Some(Polar { pole, radius: f64::NAN, angle: f64::NAN });
            }
            Some(_) => self.state.polar = None,
            None => {}
        }
        if let Some(G::Mirror(on)) = self.block.g(Group::Mirror) {
            self.mirror(on)?;
        }
        if let Some(G::Scale(on)) = self.block.g(Group::Scaling) {
            self.scale(on)?;
        }
        match self.block.g(Group::Tilt) {
            Some(G::Turn) => self.turn_coordinates(),
            Some(G::Tilt) => self.tilt(),
            Some(_) => self.upright(),
            None => Ok(()),
        }
    }

    /// Takes over changed coordinates.
    fn transformed(&mut self, transform: Transform, group: Group) -> Result<(), Fault> {
        self.may_change_coordinates(group)?;
        if self.state.tilt != Tilt::None || self.state.keeps_center() {
            let message = "coordinates turned, scaled or mirrored in a tilted plane or with G43.4";
            return Err(self.block.at_group(group, Rule::Frame, message));
        }
        let before = std::mem::replace(&mut self.state.frames.transform, transform).turn;
        if before != transform.turn {
            let about = [before, transform.turn].into_iter().flatten();
            self.state.loose = about.fold(0, |axes, (axis, ..)| axes | 7 & !(1 << axis));
        }
        self.reframe();
        Ok(())
    }

    /// `G51.1` mirrors about the coordinates that it names; `G50.1` ends the mirrors that it names.
    /// Haas `G101`, `G100` name axes and mirror about the zero.
    fn mirror(&mut self, on: bool) -> Result<(), Fault> {
        let mut transform = self.state.frames.transform;
        if transform.scale.is_some() || transform.turn.is_some() {
            let message = "a mirror goes on before G51 and G68 and off after G69 and G50";
            return Err(self.block.at_group(Group::Mirror, Rule::Frame, message));
        }
        let mut named = 0;
        for (axis, letter) in LINEAR.into_iter().enumerate() {
            if let Some(at) = self.take_length(letter)? {
                if self.facts.frames.mirrors_at_zero && at != 0.0 {
                    let message = "G101 mirrors about the zero: write 0";
                    return Err(self.block.at_word(letter, Rule::Frame, message));
                }
                transform.mirror[axis] = on.then_some(at);
                named += 1;
            }
        }
        if named == 0 {
            let message = "no axis word says which axis is mirrored";
            return Err(self.block.at_group(Group::Mirror, Rule::Frame, message));
        }
        self.transformed(transform, Group::Mirror)
    }

    /// `G51 X Y Z P` or `I J K`: factors about a centre, which is where the tool stands unless said.
    fn scale(&mut self, on: bool) -> Result<(), Fault> {
        let mut transform = self.state.frames.transform;
        if !on && transform.scale.is_none() {
            return Ok(());
        }
        if transform.turn.is_some() {
            let message = "a scale changes while the coordinates are turned; write G69 first";
            return Err(self.block.at_group(Group::Scaling, Rule::Frame, message));
        }
        transform.scale = None;
        if on {
            if self.state.frames.transform.scale.is_some() {
                let message = "a scale is on already; write G50 first";
                return Err(self.block.at_group(Group::Scaling, Rule::Frame, message));
            }
            transform.scale = Some(self.factors_and_center()?);
        }
        self.transformed(transform, Group::Scaling)
    }

    fn factors_and_center(&mut self) -> Result<(Vec3, Vec3), Fault> {
        let by_axis = self.facts.frames.scales_by_axis;
        let letters = if by_axis { *b"XYZ" } else { *b"IJK" };
        let one = if by_axis { None } else { self.factor(b'P')? };
        let (mut factors, mut center) = (Vec3::splat(one.unwrap_or(1.0)), Vec3::ZERO);
        let mut given = usize::from(one.is_some());
        for axis in 0..3 {
            if let Some(factor) = self.factor(letters[axis])? {
                factors[axis] = factor;
                given += 1;
            }
            let at = if by_axis { None } else { self.take_length(AXES[axis])? };
            if factors[axis] != 1.0 && !by_axis {
                center[axis] = at.unwrap_or(self.state.position[axis]);
            }
        }
        if given == 0 {
            let message = "G51 needs its factor";
            return Err(self.block.at_group(Group::Scaling, Rule::Frame, message));
        }
        if center.is_nan() {
            let message = "the scale is about where the tool stands, which is not known";
            return Err(self.block.at_group(Group::Scaling, Rule::UnknownPosition, message));
        }
        Ok((factors, center))
    }

    /// A factor, written with its point: without it the control counts thousandths or hundred
    /// thousandths (FANUC, parameter 5400#7).
    fn factor(&mut self, letter: u8) -> Result<Option<f64>, Fault> {
        let Some(Word { value, point, .. }) = self.block.take(letter) else { return Ok(None) };
        if self.facts.numbers.factor_needs_point && !point {
            let message = "a factor without a point counts thousandths or hundred thousandths";
            return Err(self.block.at_word(letter, Rule::DecimalPoint, message));
        }
        if value == 0.0 || !value.is_finite() {
            return Err(self.block.at_word(letter, Rule::Frame, "a factor of 0"));
        }
        Ok(Some(value))
    }

    /// `G68 X Y R`: turned about a centre in the plane.
    fn turn_coordinates(&mut self) -> Result<(), Fault> {
        let [first, second, axis] = self.state.plane.axes();
        let mut transform = self.state.frames.transform;
        let uneven = transform.factor(first) != transform.factor(second);
        if uneven {
            let message = "the coordinates are turned while the axes of the plane have two scales";
            return Err(self.block.at_group(Group::Tilt, Rule::Frame, message));
        }
        let Some(degrees) = self.take_degrees(b'R')? else {
            let message = "G68 needs its angle R";
            return Err(self.block.at_group(Group::Tilt, Rule::Frame, message));
        };
        let before = transform.turn;
        if before.is_some_and(|(about, ..)| about != axis) {
            let message = "the coordinates are turned in another plane already; write G69 first";
            return Err(self.block.at_group(Group::Tilt, Rule::Frame, message));
        }
        let degrees = match before {
            // Haas adds in G91; on FANUC parameter 5400#0 says whether it does.
            Some((.., turned)) if self.state.incremental && self.facts.frames.turns_add => {
                turned + degrees
            }
            Some(_) if self.state.incremental => {
                let message = "in G91 a second G68 adds or replaces, as parameter 5400#0 is set";
                return Err(self.block.at_group(Group::Tilt, Rule::Frame, message));
            }
            _ => degrees,
        };
        let letters = self.facts.frames.turn_center.unwrap_or([AXES[first], AXES[second]]);
        // What the turn replaces does not count for where the tool stands.
        transform.turn = None;
        self.transformed(transform, Group::Tilt)?;
        let mut center = Vec3::ZERO;
        for (axis, letter) in [first, second].into_iter().zip(letters) {
            center[axis] = match self.take_length(letter)? {
                Some(value) => value,
                None => self.state.position[axis],
            };
        }
        if center.is_nan() {
            let message = "the coordinates turn about where the tool stands, which is not known";
            return Err(self.block.at_group(Group::Tilt, Rule::UnknownPosition, message));
        }
        transform.turn = Some((axis, center, degrees));
        self.transformed(transform, Group::Tilt)
    }

    /// `G69`.
    fn upright(&mut self) -> Result<(), Fault> {
        if self.state.frames.transform.turn.is_some() {
            let mut transform = self.state.frames.transform;
            transform.turn = None;
            self.transformed(transform, Group::Tilt)?;
        }
        if self.state.tilt != Tilt::None {
            self.not_compensated("G69")?;
            self.state.tilt = Tilt::None;
            self.state.frames.tilt = None;
            self.state.place = self.state.frames.place();
            self.state.position = UNKNOWN;
        }
        Ok(())
    }

    /// `G68.2 X Y Z I J K`: origin, and Euler angles about Z, the new X, the newest Z (B-64484EN-2,
    /// "Tilted working plane command").
    fn tilt(&mut self) -> Result<(), Fault> {
        self.has_rotary_axes(Group::Tilt)?;
        self.not_compensated("a tilted plane")?;
        self.looks_ahead_no_more();
        let busy = self.state.frames.is_transformed() || self.state.keeps_center();
        if busy || self.state.tilt != Tilt::None {
            let message = "G68.2 while other coordinates or G43.4 are active; cancel them first";
            return Err(self.block.at_group(Group::Tilt, Rule::TiltedPlane, message));
        }
        let mut values = [0.0; 6];
        for (value, letter) in values.iter_mut().zip(*b"XYZIJK") {
            let word =
                if letter >= b'X' { self.take_length(letter)? } else { self.take_degrees(letter)? };
            *value = word.ok_or_else(|| {
                let message = format!("G68.2 needs {}: write all six", char::from(letter));
                self.block.at_group(Group::Tilt, Rule::TiltedPlane, message)
            })?;
        }
        let [x, y, z, i, j, k] = values;
        let turn = Mat3::from_rotation_z(i.to_radians())
            * Mat3::from_rotation_x(j.to_radians())
            * Mat3::from_rotation_z(k.to_radians());
        self.state.tilt = Tilt::Declared(Frame::from_mat3_translation(turn, Vec3::new(x, y, z)));
        self.state.position = UNKNOWN;
        Ok(())
    }
}
