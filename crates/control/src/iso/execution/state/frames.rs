//! Where the programmed zero lies: work offsets as the program writes them, shifts (`G92`, `G52`),
//! turned, scaled and mirrored coordinates, and the tilted plane, as one way into the work frame.
//!
//! The work frame is that of the active work offset as it was when the program first moved in it.

use crate::iso::dialects::facts::Offsets;
use geom::{Frame, Mat3, Vec3};

/// X, Y, Z in mm and A, B, C in degrees.
pub(in crate::iso::execution) type Six = [f64; 6];

/// X, Y, Z, A, B, C as bits.
const ALL_AXES: u8 = 0b11_1111;

/// Programmed coordinates in the work frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ProgramFrame {
    frame: Frame,
    /// Degrees by which the rotary axes are shifted.
    rotary: [f64; 3],
    /// Programmed coordinates are those of the work frame.
    same: bool,
}

impl ProgramFrame {
    /// Programmed coordinates that are those of the work frame.
    pub(in crate::iso::execution) const SAME: ProgramFrame =
        ProgramFrame { frame: Frame::IDENTITY, rotary: [0.0; 3], same: true };

    /// A programmed point in the work frame.
    pub(crate) fn point(&self, p: Vec3) -> Vec3 {
        if self.same { p } else { times(self.frame.matrix3, p) + self.frame.translation }
    }

    /// A point of the work frame in programmed coordinates.
    pub(in crate::iso::execution) fn programmed(&self, p: Vec3) -> Vec3 {
        if self.same {
            return p;
        }
        times(self.frame.matrix3.inverse(), p - self.frame.translation)
    }

    /// Programmed positions of the rotary axes as those of the work offset.
    pub(in crate::iso::execution) fn rotary(&self, degrees: [f64; 3]) -> [f64; 3] {
        if self.same { degrees } else { [0, 1, 2].map(|i| degrees[i] + self.rotary[i]) }
    }

    /// A programmed direction in the work frame, its length scaled with the coordinates.
    pub(in crate::iso::execution) fn direction(&self, v: Vec3) -> Vec3 {
        if self.same { v } else { self.frame.matrix3 * v }
    }

    /// The unit vector about which a programmed turn about the unit vector `axis` turns: a mirror
    /// reverses it.
    pub(crate) fn normal(&self, axis: Vec3) -> Vec3 {
        if self.same {
            return axis;
        }
        let sense = self.frame.matrix3.determinant().signum();
        clean(self.direction(axis).normalize() * sense)
    }
}

/// `m` times `v`, where a coordinate that is not known (NaN) spoils only those that depend on it.
fn times(m: Mat3, v: Vec3) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for axis in 0..3 {
        let column = m.col(axis);
        for row in 0..3 {
            if column[row] != 0.0 {
                sum[row] += column[row] * v[axis];
            }
        }
    }
    sum
}

/// Without negative zeros.
fn clean(v: Vec3) -> Vec3 {
    v + Vec3::ZERO
}

/// A turn about an axis (0 X, 1 Y, 2 Z), exact for quarters.
fn turn(axis: usize, degrees: f64) -> Mat3 {
    let quarter = degrees.rem_euclid(360.0) / 90.0;
    let (sin, cos) = match quarter {
        0.0 => (0.0, 1.0),
        1.0 => (1.0, 0.0),
        2.0 => (0.0, -1.0),
        3.0 => (-1.0, 0.0),
        _ => degrees.to_radians().sin_cos(),
    };
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut columns = [Vec3::ZERO; 3];
    columns[axis][axis] = 1.0;
    columns[second][second] = cos;
    columns[second][third] = sin;
    columns[third][second] = -sin;
    columns[third][third] = cos;
    Mat3::from_cols(columns[0], columns[1], columns[2])
}

/// A work offset as far as the program shows it.
#[derive(Clone, Copy, Debug)]
struct Offset {
    number: u32,
    /// Its value when the program first moved in it, in machine coordinates; NaN where not known.
    origin: Six,
    /// Its turn about Z then, degrees; NaN where not known.
    angle: f64,
    /// By how much it has changed since, in the work frame.
    slide: Six,
    turned: f64,
    /// The program has moved in it.
    used: bool,
}

impl Offset {
    /// Where its zero lies in the work frame.
    fn frame(&self) -> Frame {
        Frame::from_mat3_translation(turn(2, self.turned), linear(&self.slide))
    }

    /// Writes it: the given values replace those of before, or with `add` are added to them.
    ///
    /// # Errors
    /// The program has moved in it, and what it held before is not known.
    fn write(
        &mut self,
        values: [Option<f64>; 6],
        angle: Option<f64>,
        add: bool,
    ) -> Result<(), Unknown> {
        if !self.used {
            for (held, value) in self.origin.iter_mut().zip(values) {
                if let Some(value) = value {
                    *held = if add { *held + value } else { value };
                }
            }
            self.angle = angle.unwrap_or(self.angle);
            return Ok(());
        }
        // In machine axes: what it held, what it holds now.
        let back = turn(2, self.angle);
        let held = linear(&self.origin) + times(back, linear(&self.slide));
        let mut change = Vec3::ZERO;
        for axis in 0..3 {
            change[axis] = match values[axis] {
                Some(value) if add => value,
                Some(value) => value - held[axis],
                None => 0.0,
            };
        }
        let slide = if change == Vec3::ZERO { change } else { times(turn(2, -self.angle), change) };
        for axis in 0..6 {
            self.slide[axis] += match (values[axis], axis) {
                (_, 0..3) => slide[axis],
                (Some(value), _) if add => value,
                (Some(value), _) => value - self.origin[axis] - self.slide[axis],
                (None, _) => 0.0,
            };
        }
        if let Some(angle) = angle {
            self.turned = angle - self.angle;
        }
        if self.slide.iter().any(|v| v.is_nan()) || self.turned.is_nan() {
            return Err(Unknown);
        }
        Ok(())
    }
}

fn linear(six: &Six) -> Vec3 {
    Vec3::new(six[0], six[1], six[2])
}

/// Mirrored, scaled and turned coordinates, in the order in which FANUC takes them: the turn within
/// the scale within the mirror.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Transform {
    /// The coordinate about which each axis is mirrored.
    pub mirror: [Option<f64>; 3],
    /// Factors and their centre.
    pub scale: Option<(Vec3, Vec3)>,
    /// Axis about which the turn goes, centre, degrees.
    pub turn: Option<(usize, Vec3, f64)>,
}

impl Transform {
    pub(in crate::iso::execution) const NONE: Transform =
        Transform { mirror: [None; 3], scale: None, turn: None };

    fn frame(&self) -> Frame {
        let about = |center: Vec3, m: Mat3| {
            Frame::from_translation(center) * Frame::from_mat3(m) * Frame::from_translation(-center)
        };
        let sides = self.mirror.map(|at| if at.is_some() { -1.0 } else { 1.0 });
        let center = Vec3::from_array(self.mirror.map(|at| at.unwrap_or(0.0)));
        let mut frame = about(center, Mat3::from_diagonal(sides.into()));
        if let Some((factors, center)) = self.scale {
            frame *= about(center, Mat3::from_diagonal(factors));
        }
        if let Some((axis, center, degrees)) = self.turn {
            frame *= about(center, turn(axis, degrees));
        }
        frame
    }

    /// The factor of an axis.
    pub(in crate::iso::execution) fn factor(&self, axis: usize) -> f64 {
        self.scale.map_or(1.0, |(factors, _)| factors[axis])
    }

    /// Whether left and right change sides in the plane of these axes.
    pub(in crate::iso::execution) fn swaps_sides(&self, first: usize, second: usize) -> bool {
        let negative = |axis: usize| self.mirror[axis].is_some() != (self.factor(axis) < 0.0);
        negative(first) != negative(second)
    }
}

/// All that lies between programmed coordinates and the work frame.
#[derive(Clone, Debug)]
pub(crate) struct Frames {
    /// The offsets that the program has written or moved in.
    offsets: Vec<Offset>,
    /// The index of the active one.
    active: usize,
    /// FANUC's external offset, which adds to each of them.
    external: Six,
    /// Where a step was added to it while it was not known.
    stepped: [bool; 6],
    /// What an offset holds that the program has not written: 0 or, where that is not known, NaN.
    untouched: f64,
    /// Whether the control can turn a work offset.
    turns_offsets: bool,
    /// `G92`.
    pub shift: Six,
    /// What `G92.1` takes away beyond `shift`: NaN where a shift of the program before may stand in the
    /// control, or where `G92` has set the zero before any position was known.
    beyond: Six,
    /// Axes (bit 0 is X) of which nobody has said where their zero lies: the program by a work offset or by `G92`, or the machine's file.
    pub unsaid: u8,
    /// The active work offset counts, whichever it is: no `G28` has taken it away.
    counts: bool,
    /// `G92.1` has taken away what is not known.
    pub lost: Option<&'static str>,
    /// What `G92.3` brings back.
    stored: Option<Six>,
    /// `G52`.
    pub local: Six,
    pub transform: Transform,
    /// The tilted plane, once it is reached.
    pub tilt: Option<Frame>,
    /// By how much the table has moved the zero, mm, along the axes of the machine, while the dynamic offset is on.
    pub carried: Option<Vec3>,
}

impl Frames {
    /// Nothing shifted, in the work offset `number`, which is sure to be the one or not.
    pub(in crate::iso::execution) fn new(
        number: u32,
        all_zero: bool,
        rules: &Offsets,
        is_sure: bool,
    ) -> Frames {
        let untouched = if all_zero { 0.0 } else { f64::NAN };
        let mut frames = Frames {
            offsets: Vec::with_capacity(2),
            active: 0,
            external: [untouched; 6],
            stepped: [false; 6],
            untouched,
            turns_offsets: rules.turn,
            shift: [0.0; 6],
            beyond: [untouched; 6],
            unsaid: if is_sure { 0 } else { ALL_AXES },
            counts: is_sure || !rules.homing_takes_away,
            lost: None,
            stored: all_zero.then_some([0.0; 6]),
            local: [0.0; 6],
            transform: Transform::NONE,
            tilt: None,
            carried: None,
        };
        frames.index(number);
        frames
    }

    fn index(&mut self, number: u32) -> usize {
        if let Some(index) = self.offsets.iter().position(|o| o.number == number) {
            return index;
        }
        let untouched = self.untouched;
        self.offsets.push(Offset {
            number,
            origin: self.external.map(|external| untouched + external),
            angle: if self.turns_offsets { untouched } else { 0.0 },
            slide: [0.0; 6],
            turned: 0.0,
            used: false,
        });
        self.offsets.len() - 1
    }

    fn offset(&self) -> Option<&Offset> {
        self.offsets.get(self.active)
    }

    /// The way into the work frame.
    pub(in crate::iso::execution) fn place(&self) -> ProgramFrame {
        let Some(offset) = self.offset() else { return ProgramFrame::SAME };
        let shift: Six = std::array::from_fn(|i| self.shift[i] + self.local[i]);
        let mut frame = offset.frame() * Frame::from_translation(linear(&shift));
        if self.transform != Transform::NONE {
            frame *= self.transform.frame();
        }
        if let Some(tilt) = self.tilt {
            frame *= tilt;
        }
        if let Some(carried) = self.carried {
            frame = Frame::from_translation(carried) * frame;
        }
        let rotary = [3, 4, 5].map(|i| offset.slide[i] + shift[i]);
        ProgramFrame { frame, rotary, same: frame == Frame::IDENTITY && rotary == [0.0; 3] }
    }

    /// A point of the work frame in machine coordinates, NaN where it is not known.
    pub(in crate::iso::execution) fn to_machine(&self, work: Vec3) -> Vec3 {
        let Some(offset) = self.offset() else { return Vec3::NAN };
        times(turn(2, offset.angle), work) + linear(&offset.origin)
    }

    /// A point in machine coordinates in the work frame, NaN where it is not known.
    pub(in crate::iso::execution) fn of_machine(&self, machine: Vec3) -> Vec3 {
        let Some(offset) = self.offset() else { return Vec3::NAN };
        times(turn(2, -offset.angle), machine - linear(&offset.origin))
    }

    /// What the active work offset holds for the rotary axes, degrees; NaN where not known.
    pub(in crate::iso::execution) fn rotary_origin(&self) -> [f64; 3] {
        self.offset().map_or([f64::NAN; 3], |o| [o.origin[3], o.origin[4], o.origin[5]])
    }

    /// The work coordinates that are not known any more once the named axes of the machine (bit 0
    /// is X) are where only the machine knows.
    pub(in crate::iso::execution) fn depend_on(&self, named: u8) -> [bool; 3] {
        let axes = [0, 1, 2].map(|axis| named & 1 << axis != 0);
        let straight = |angle: f64| angle.is_nan() || angle % 180.0 == 0.0;
        if self.offset().is_none_or(|offset| straight(offset.angle)) {
            return axes;
        }
        let plane = axes[0] || axes[1];
        [plane, plane, axes[2]]
    }

    /// The program names a work offset; `changes` where it is another one than that of its last word.
    pub(in crate::iso::execution) fn named(&mut self, changes: bool) {
        self.counts |= changes;
        if self.counts {
            self.unsaid = 0;
        }
    }

    /// `G53` leaves the work offset and takes it up again; `is_named` where the program has named it.
    pub(in crate::iso::execution) fn taken_up(&mut self, is_named: bool) {
        self.counts = true;
        if is_named {
            self.unsaid = 0;
        }
    }

    /// These axes (bit 0 is X) count from the zero of the machine.
    pub(in crate::iso::execution) fn taken_away(&mut self, axes: u8) {
        self.counts = false;
        self.unsaid |= axes;
    }

    /// Another work offset is active.
    pub(in crate::iso::execution) fn select(&mut self, number: u32) {
        self.active = self.index(number);
    }

    /// The program has moved in the active work offset.
    pub(in crate::iso::execution) fn used(&mut self) {
        if let Some(offset) = self.offsets.get_mut(self.active) {
            offset.used = true;
        }
    }

    /// Whether the program has moved in the active work offset.
    pub(in crate::iso::execution) fn is_used(&self) -> bool {
        self.offset().is_some_and(|offset| offset.used)
    }

    /// Whether the program has written no offset and shifted nothing.
    pub(crate) fn is_fresh(&self) -> bool {
        let written = |offset: &Offset| {
            let kept = |value: &f64| value.to_bits() == self.untouched.to_bits();
            !offset.origin.iter().all(kept) || offset.slide != [0.0; 6] || offset.turned != 0.0
        };
        self.shift == [0.0; 6] && !self.offsets.iter().any(written)
    }

    /// The number of the active work offset.
    pub(crate) fn active(&self) -> u32 {
        self.offset().map_or(0, |offset| offset.number)
    }

    /// Whether coordinates are mirrored, scaled, turned or tilted.
    pub(in crate::iso::execution) fn is_transformed(&self) -> bool {
        self.transform != Transform::NONE || self.tilt.is_some()
    }

    /// Whether the program has moved or turned no zero, so that coordinates are those of the active work offset.
    pub(in crate::iso::execution) fn is_plain(&self) -> bool {
        let stays = |offset: &Offset| offset.frame() == Frame::IDENTITY;
        self.offset().is_none_or(stays)
            && !self.is_transformed()
            && [self.shift, self.local] == [[0.0; 6]; 2]
            && self.lost.is_none()
    }

    /// Writes a work offset (`G10 L2`): the given values replace those of before, or with `add` are
    /// added to them. Answers whether that one is active.
    ///
    /// # Errors
    /// The program has moved in it, and what it held before is not known; or a step was added to an
    /// external offset that is not.
    pub(in crate::iso::execution) fn write(
        &mut self,
        number: u32,
        values: [Option<f64>; 6],
        angle: Option<f64>,
        add: bool,
    ) -> Result<bool, Unknown> {
        let index = self.index(number);
        let lost = |axis: usize| values[axis].is_some() && self.stepped[axis];
        if !add && (0..6).any(lost) {
            return Err(Unknown);
        }
        // What is not known of the external one has moved all of them alike.
        let external = self.external.map(|value| if add || value.is_nan() { 0.0 } else { value });
        let values: [Option<f64>; 6] =
            std::array::from_fn(|axis| values[axis].map(|value| value + external[axis]));
        let Some(offset) = self.offsets.get_mut(index) else { return Err(Unknown) };
        offset.write(values, angle, add)?;
        Ok(index == self.active)
    }

    /// Writes the external work offset (FANUC, `G10 L2 P0`), with `add` by a step: all offsets move.
    ///
    /// # Errors
    /// The program has moved, and what it held before is not known.
    pub(in crate::iso::execution) fn write_external(
        &mut self,
        values: [Option<f64>; 6],
        add: bool,
    ) -> Result<bool, Unknown> {
        // Before the first move it does not matter what was there.
        let used = self.offsets.iter().any(|offset| offset.used);
        let mut steps = values;
        for ((step, held), stepped) in
            steps.iter_mut().zip(&mut self.external).zip(&mut self.stepped)
        {
            let Some(value) = step else { continue };
            if held.is_nan() && !add && *stepped {
                return Err(Unknown);
            }
            *stepped |= held.is_nan() && add;
            let before = if held.is_nan() && !used { 0.0 } else { *held };
            *held = if add { *held + *value } else { *value };
            if !add {
                *value -= before;
            }
        }
        self.offsets.iter_mut().try_for_each(|offset| offset.write(steps, None, true))?;
        Ok(true)
    }

    /// Moves a work offset so that the tool at `here` (programmed) has the coordinates `values`
    /// (`G10 L20`).
    ///
    /// # Errors
    /// The program has moved in that offset, and where the tool stands in it is not known.
    pub(in crate::iso::execution) fn write_here(
        &mut self,
        number: u32,
        here: Six,
        values: [Option<f64>; 6],
    ) -> Result<bool, Unknown> {
        let way: Six = std::array::from_fn(|i| values[i].map_or(0.0, |value| here[i] - value));
        let index = self.index(number);
        if index != self.active {
            let target = self.offsets.get_mut(index).filter(|offset| !offset.used);
            let Some(offset) = target else { return Err(Unknown) };
            // Where the machine stands is known to the program only in the active one.
            for (held, value) in offset.origin.iter_mut().zip(values) {
                if value.is_some() {
                    *held = f64::NAN;
                }
            }
            return Ok(false);
        }
        let Some(offset) = self.offsets.get_mut(index) else { return Err(Unknown) };
        let turned = if offset.used { offset.turned } else { offset.angle };
        let flat = linear(&way);
        let moved = if flat == Vec3::ZERO { flat } else { times(turn(2, turned), flat) };
        let target = if offset.used { &mut offset.slide } else { &mut offset.origin };
        for axis in 0..6 {
            target[axis] += if axis < 3 { moved[axis] } else { way[axis] };
        }
        if offset.used && offset.slide.iter().any(|v| v.is_nan()) {
            return Err(Unknown);
        }
        Ok(true)
    }

    /// `G92`: the tool at `here` (programmed) has the coordinates `values`. Before anything has moved
    /// that may set the zero where the operator has brought the tool.
    ///
    /// # Errors
    /// The program has moved, and where the tool stands is not known.
    pub(in crate::iso::execution) fn shift_here(
        &mut self,
        here: Six,
        values: [Option<f64>; 6],
    ) -> Result<(), Unknown> {
        let used = self.is_used();
        for axis in 0..6 {
            let Some(value) = values[axis] else { continue };
            let shift = here[axis] + self.shift[axis] + self.local[axis] - value;
            if !shift.is_nan() {
                self.shift[axis] = shift;
            } else if used {
                return Err(Unknown);
            } else {
                (self.shift[axis], self.beyond[axis]) = (0.0, f64::NAN);
            }
            self.local[axis] = 0.0;
            self.unsaid &= !(1 << axis);
        }
        self.stored = Some(self.shift);
        Ok(())
    }

    /// `G52` on controls where it is kept where `G92` is.
    ///
    /// # Errors
    /// The program has moved, and what `G92` had set before is not known.
    pub(in crate::iso::execution) fn shift_to(
        &mut self,
        values: [Option<f64>; 6],
    ) -> Result<(), Unknown> {
        let used = self.is_used();
        for ((shift, beyond), value) in self.shift.iter_mut().zip(&mut self.beyond).zip(values) {
            let Some(value) = value else { continue };
            if !used {
                *beyond = 0.0;
            }
            *shift = value - *beyond;
        }
        self.stored = Some(self.shift);
        if self.shift.iter().any(|v| v.is_nan()) { Err(Unknown) } else { Ok(()) }
    }

    /// `G92.1` and, with `keep`, `G92.2`. Answers whether it is known what goes away.
    pub(in crate::iso::execution) fn unshift(&mut self, keep: bool) -> bool {
        let known = !self.beyond.iter().any(|v| v.is_nan());
        if !known && self.is_used() {
            self.lost = self.lost.or(Some(if keep { "G92.2" } else { "G92.1" }));
        }
        let kept = if known { self.stored } else { None };
        self.stored = if keep { kept } else { Some([0.0; 6]) };
        (self.shift, self.beyond) = ([0.0; 6], [0.0; 6]);
        known
    }

    /// `G92.3`.
    ///
    /// # Errors
    /// The program has stored nothing.
    pub(in crate::iso::execution) fn restore(&mut self) -> Result<(), Unknown> {
        self.shift = self.stored.ok_or(Unknown)?;
        Ok(())
    }
}

/// What is asked for depends on what stands in the machine and not in the program.
#[derive(Clone, Copy, Debug)]
pub(in crate::iso::execution) struct Unknown;
