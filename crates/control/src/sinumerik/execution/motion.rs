//! Where a block sends the axes.

use super::interpreter::Interpreter;
use super::polar::axes_of_plane;
use super::state::ToolAxis;
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::kernel::compensation::{Outer, Terms};
use crate::kernel::corner::Element;
use crate::kernel::modulo::{self, Modulo};
use crate::kernel::source::Source;
use crate::sinumerik::language::axis::AXIS_NAMES;
use crate::sinumerik::language::block::{Block, Coordinate, Count, Rare};
use crate::sinumerik::language::commands::{Code, Diameter, Motion};
use geom::{Vec3, direction};
use program::{Axes, Compensation, MachineMove, Rule};

impl Interpreter<'_, '_> {
    /// The motion of a block, if it has one.
    #[inline]
    pub fn motion(&mut self, source: &Source, block: &Block) -> Outcome {
        if block.rotation.is_some()
            || block.fixed_point.is_some()
            || block.machine_axes.contains(&true)
        {
            let message = "RPL=, FP= and machine axes belong to ROT, G75 and G74";
            return Err(source.block_error(Rule::Syntax, message));
        }
        if block.code(9) == Some(Code::MachineCoordinates) {
            return self.machine_position(source, block);
        }
        if block.rare.as_ref().is_some_and(|rare| rare.positioned.iter().any(Option::is_some)) {
            return self.position_axes(source, block);
        }
        let motion = self.state.motion;
        let straight = matches!(motion, Motion::Rapid | Motion::Line);
        let thread = matches!(motion, Motion::Thread | Motion::TapIn | Motion::TapOut);
        let round = !straight && !thread;
        if straight && block.has_arc_word() {
            let message = "words of an arc without G2, G3 or CIP";
            return Err(source.block_error(Rule::Arc, message));
        }
        if !(block.has_position() || round && block.has_arc_word()) {
            let path_word = |rare: &Rare| rare.angle.is_some() || rare.corner.is_some();
            if block.rare.as_deref().is_some_and(path_word) {
                let message = "ANG=, CHF=, CHR= and RND= belong to a block that moves";
                return Err(source.block_error(Rule::Syntax, message));
            }
            return self.no_motion(source, block);
        }
        if !self.state.moved {
            self.state.move_first();
        }
        if thread {
            self.thread(source, block)?;
        } else if round {
            self.settle_compensation(source, block, true)?;
            self.use_feed(source)?;
            self.arc(source, block)?;
        } else {
            let (position, programmed) = self.target(source, block)?;
            self.orient(source, block)?;
            self.settle_compensation(source, block, false)?;
            if motion == Motion::Line {
                self.use_feed(source)?;
            }
            let [x, y, z] = position.to_array();
            let over = x.is_finite() && y.is_finite();
            if self.state.frames.turned() && z.is_finite() && !over {
                let message =
                    "Z in a turned frame before X and Y: where the tool goes down is not known";
                return Err(source.block_error(Rule::UnknownPosition, message));
            }
            self.state.head_for(position);
            let start = std::mem::replace(&mut self.state.position, position);
            self.state.programmed = programmed;
            let pose = self.state.pose(position);
            let cut = motion == Motion::Line;
            let at_no_height = self.state.frames.swivel().is_some() && z.is_nan() && over;
            let action = match cut {
                true => Action::Line(pose),
                false if at_no_height => {
                    Action::Across(Box::new(self.state.pose(position.with_z(0.0))))
                }
                false => Action::Rapid(pose),
            };
            if self.cornered(block) {
                let element = Element { start, end: position, circle: None, cut };
                self.go_round(source, block, element, action)?;
            } else {
                self.emit(source, action)?;
            }
        }
        self.call_modal(source)
    }

    /// A block without a motion. While a call is modal, `F`, `S` or `G0` alone would do it once more
    /// (Programming Manual 06/2019, 3.2.3.4): nobody means that.
    fn no_motion(&self, source: &Source, block: &Block) -> Outcome {
        let drills = block.feed.is_some() || block.speed.is_some() || block.code(1).is_some();
        if drills && self.state.modal.waits() {
            let message = "F, S or a motion command without a position drills or calls once more \
                           while MCALL is active";
            return Err(source.block_error(Rule::Cycle, message));
        }
        Ok(())
    }

    /// The linear axes' end of a block: where they are in the coordinates of the program, and what
    /// incremental words count from afterwards; mm.
    #[inline]
    pub fn target(&mut self, source: &Source, block: &Block) -> Outcome<(Vec3, Vec3)> {
        let mut position = self.state.position;
        let mut programmed = self.state.programmed;
        for i in 0..3 {
            if let Some(mut coordinate) = block.axes[i] {
                if i == 0 && self.state.diameter != Diameter::Off {
                    coordinate.value *= self.radius_of_diameter(coordinate.count);
                }
                let base = self.state.programmed[i];
                let value = self.linear(source, coordinate, base, AXIS_NAMES[i])?;
                position[i] = value;
                programmed[i] = value;
            }
        }
        if let Some(rare) = &block.rare {
            if block.has_polar() {
                self.polar_target(source, block, &mut position)?;
            }
            if let Some(angle) = rare.angle {
                self.angle_target(source, block, angle, &mut position)?;
            }
            if block.has_polar() || rare.angle.is_some() {
                for i in (0..3).filter(|i| *i != self.state.plane_normal) {
                    programmed[i] = position[i];
                }
            }
        }
        Ok((position, programmed))
    }

    /// What a value of X is multiplied by where it is a diameter (`DIAMON`, `DIAM90`).
    fn radius_of_diameter(&self, count: Count) -> f64 {
        let incremental =
            count == Count::Incremental || count == Count::Modal && !self.state.absolute;
        if self.state.diameter == Diameter::On || !incremental { 0.5 } else { 1.0 }
    }

    /// `ANG=`: the coordinate of the plane that is not named, on the line under that angle to the first
    /// axis of the plane.
    #[cold]
    fn angle_target(
        &self,
        source: &Source,
        block: &Block,
        angle: f64,
        position: &mut Vec3,
    ) -> Outcome {
        let error = |message: &str| Err(source.block_error(Rule::Angle, message));
        let (first, second) = axes_of_plane(self.state.plane_normal);
        let start = self.state.position;
        if !matches!(self.state.motion, Motion::Rapid | Motion::Line) || block.has_polar() {
            return error("ANG= belongs to a straight line");
        }
        if start[first].is_nan() || start[second].is_nan() {
            return error("ANG= from a point that is not known");
        }
        let (sin, cos) = angle.to_radians().sin_cos();
        let (named, other, slope) = match (block.axes[first], block.axes[second]) {
            (Some(_), None) => (first, second, (sin, cos)),
            (None, Some(_)) => (second, first, (cos, sin)),
            _ => {
                return error(
                    "ANG= takes one coordinate of the plane; two lines by their angles are \
                               not supported",
                );
            }
        };
        let way = position[named] - start[named];
        if slope.1.abs() < 1e-9 || way * slope.1 <= 0.0 {
            return error("the line under ANG= does not reach that coordinate");
        }
        position[other] = start[other] + way * slope.0 / slope.1;
        Ok(())
    }

    /// A linear coordinate, mm, that counts from `base` where it is incremental.
    #[inline]
    pub fn linear(
        &self,
        source: &Source,
        coordinate: Coordinate,
        base: f64,
        name: &str,
    ) -> Outcome<f64> {
        let value = coordinate.value * self.state.unit;
        let incremental = match coordinate.count {
            Count::Modal => !self.state.absolute,
            Count::Absolute => false,
            Count::Incremental => true,
            Count::Shorter | Count::Positive | Count::Negative => {
                let message = format!("DC, ACP and ACN are for rotary axes, not for {name}");
                return Err(source.block_error(Rule::Syntax, message));
            }
        };
        if !incremental {
            return Ok(value);
        }
        if base.is_nan() {
            let message = format!("{name} is incremental, but it is not known from where");
            let mut error = source.block_error(Rule::UnknownPosition, message);
            error.help = format!(
                "write an absolute position of {name} before it (G90, or {name}=AC()), also behind ROT, SCALE and \
                 MIRROR"
            );
            return Err(error);
        }
        Ok(base + value)
    }

    /// Rotary positions and tool vectors of a block.
    #[inline]
    fn orient(&mut self, source: &Source, block: &Block) -> Outcome {
        if block.has_vector() {
            return self.orient_by_vector(source, block);
        }
        if !block.has_rotary() {
            return Ok(());
        }
        if self.state.frames.swivel().is_some() {
            let message = "a rotary axis moves in a plane swivelled by CYCLE800";
            return Err(source.block_error(Rule::Orientation, message));
        }
        let (before, axis) = (self.state.rotary, self.state.tool_axis);
        for i in 0..3 {
            if let Some(coordinate) = block.axes[i + 3] {
                let to = self.turned_to(source, coordinate, i)?;
                self.hold_way(source, coordinate, i, to)?;
                self.state.rotary[i] = to;
                self.check_offset(source, coordinate, i)?;
            }
        }
        self.state.tool_axis = ToolAxis::Rotary;
        let turns = !matches!(axis, ToolAxis::Rotary) || self.state.rotary != before;
        self.hold_turning(source, turns, false)
    }

    /// Tells where the tool turns under `TRAORI` over the part, and not surely on the great circle, or not surely by its axes.
    fn hold_turning(&mut self, source: &Source, turns: bool, great_circle: bool) -> Outcome {
        let state = &self.state;
        let over_part = state.tool_center && !state.position.z.is_nan();
        if !(turns && over_part) || state.turning.on_great_circle() == Some(great_circle) {
            return Ok(());
        }
        self.emit(source, Action::Risk(Risk::ORIENTATION_WAY.into()))
    }

    /// Position of rotary axis `index`, degrees. `DC`, `ACP` and `ACN` go on counting, so that the way
    /// shows in the value.
    fn turned_to(&self, source: &Source, coordinate: Coordinate, index: usize) -> Outcome<f64> {
        let name = AXIS_NAMES[index + 3];
        self.check_rotary(source, index)?;
        let value = coordinate.value;
        let from = self.state.rotary[index];
        let incremental = coordinate.count == Count::Incremental
            || coordinate.count == Count::Modal && !self.state.absolute;
        if incremental && from.is_nan() {
            let message = format!("{name} is incremental, but it is not known from where");
            return Err(source.block_error(Rule::UnknownPosition, message));
        }
        let is_modulo =
            matches!(coordinate.count, Count::Shorter | Count::Positive | Count::Negative);
        if is_modulo && !(0.0..360.0).contains(&value) {
            let message = format!(
                "{name} is counted modulo 360°, and {value} is not within 0 to 359.999 (alarm 16830)"
            );
            return Err(source.block_error(Rule::ModuloPosition, message));
        }
        Ok(match coordinate.count {
            _ if incremental => from + value,
            Count::Shorter | Count::Positive | Count::Negative if from.is_nan() => value,
            Count::Shorter => from + geom::wrap((value - from).to_radians()).to_degrees(),
            Count::Positive => from + (value - from).rem_euclid(360.0),
            Count::Negative => from - (from - value).rem_euclid(360.0),
            Count::Modal | Count::Absolute | Count::Incremental => value,
        })
    }

    /// Tells where nobody knows which way the axis turns to `to`: one that is counted modulo 360° (MD30310) goes to its
    /// plain position the shorter way, or without passing 0° (MD30455, bit 2), as Axes and Spindles 12/2019 says.
    fn hold_way(
        &mut self,
        source: &Source,
        coordinate: Coordinate,
        index: usize,
        to: f64,
    ) -> Outcome {
        let (from, counted) = (self.state.rotary[index], self.settings.modulo[index]);
        let is_absolute = match coordinate.count == Count::Modal {
            true => self.state.absolute,
            false => coordinate.count == Count::Absolute,
        };
        let modulo = match coordinate.count {
            Count::Shorter => Modulo::Shorter,
            Count::Absolute => Modulo::AsSetUp,
            Count::Modal if self.state.absolute => Modulo::AsSetUp,
            Count::Modal | Count::Incremental | Count::Positive | Count::Negative => return Ok(()),
        };
        // Away from the part an axis may turn as it likes.
        if self.state.position.z.is_nan() {
            return Ok(());
        }
        // MD30455, bit 0: alarm 16830, or the place within the turn.
        let within =
            !is_absolute || counted != Some(true) || (0.0..360.0).contains(&coordinate.value);
        if within && modulo::is_sure(from, to, counted, modulo) {
            return Ok(());
        }
        self.emit(source, Action::Risk(Risk::ROTARY_WAY.into()))
    }

    /// The proof takes the operator's offset as 0. So it must shift every position of its axis alike:
    /// one block without it, or with another, and the axis would go elsewhere by that much.
    fn check_offset(&mut self, source: &Source, coordinate: Coordinate, i: usize) -> Outcome {
        let name = AXIS_NAMES[i + 3];
        let incremental = coordinate.count == Count::Incremental
            || coordinate.count == Count::Modal && !self.state.absolute;
        if let (true, Some(index)) = (incremental, coordinate.offset) {
            let message = format!("{name} is incremental, and R{index} would be added once more");
            return Err(source.block_error(Rule::OperatorOffset, message));
        }
        if incremental {
            return Ok(());
        }
        let (first, line) = *self.state.offsets[i].get_or_insert((coordinate.offset, source.line));
        if first == coordinate.offset {
            return Ok(());
        }
        let with = |offset: Option<usize>| match offset {
            Some(index) => format!("with +R{index}"),
            None => String::from("without an operator's offset"),
        };
        let message = format!(
            "{name} is written {} here and {} in line {line}: the axis would stand elsewhere by that",
            with(coordinate.offset),
            with(first)
        );
        let mut error = source.block_error(Rule::OperatorOffset, message);
        error.help = format!("write every position of {name} with the same one");
        Err(error)
    }

    fn check_rotary(&self, source: &Source, index: usize) -> Outcome {
        if self.settings.rotary[index] {
            return Ok(());
        }
        let message = format!("the machine has no axis {}", AXIS_NAMES[index + 3]);
        Err(source.block_error(Rule::UnknownAxis, message))
    }

    /// `A3= B3= C3=`: any length, what is left out is 0 (Programming Guide Advanced 04.00, 7.1).
    fn orient_by_vector(&mut self, source: &Source, block: &Block) -> Outcome {
        if block.has_rotary() {
            let message = "positions of rotary axes and a vector of the tool in one block";
            return Err(source.block_error(Rule::Orientation, message));
        }
        if !self.state.tool_center {
            let message = "A3= B3= C3= need TRAORI";
            return Err(source.block_error(Rule::Orientation, message));
        }
        if !self.state.vectors_in_work_frame {
            let message = "a vector of the tool in machine coordinates (ORIMKS) is not supported";
            return Err(source.block_error(Rule::Unsupported, message));
        }
        let [x, y, z] = block.vector.map(|v| v.unwrap_or(0.0));
        let Some(axis) = direction(self.state.frames.direction(Vec3::new(x, y, z))) else {
            let message = "the vector of the tool (A3= B3= C3=) has no length";
            return Err(source.block_error(Rule::ZeroVector, message));
        };
        let turns = !matches!(self.state.tool_axis, ToolAxis::Vector(before) if before == axis);
        self.state.tool_axis = ToolAxis::Vector(axis);
        self.state.rotary = self.settings.rotary.map(|exists| if exists { f64::NAN } else { 0.0 });
        self.hold_turning(source, turns, true)
    }

    /// Compensation takes effect with the first move in the plane, which must be straight.
    fn settle_compensation(&mut self, source: &Source, block: &Block, round: bool) -> Outcome {
        let state = &mut self.state;
        let normal = state.plane_normal;
        let in_plane = round || (0..3).any(|i| i != normal && block.axes[i].is_some());
        if state.compensation == state.compensation_in_effect || !in_plane {
            return Ok(());
        }
        if round {
            let message =
                "cutter radius compensation starts or ends in an arc (alarms 10753, 10754)";
            return Err(source.block_error(Rule::Compensation, message));
        }
        if state.compensation != Compensation::Off && state.edge.is_none() {
            let message = "cutter radius compensation without a tool edge D (alarm 10750)";
            return Err(source.block_error(Rule::Compensation, message));
        }
        // A mirrored contour has the tool on its other side.
        let mirrored = match state.frames.sense_about(normal) {
            _ if state.compensation == Compensation::Off || state.frames.moved_only() => false,
            Some(sense) => sense < 0.0,
            None => {
                let message = "cutter radius compensation in a frame that is scaled, or mirrored \
                               across its plane";
                return Err(source.block_error(Rule::Unsupported, message));
            }
        };
        state.compensation_in_effect = state.compensation;
        let compensation = match (state.compensation, mirrored) {
            (Compensation::Left(_), false) | (Compensation::Right(_), true) => {
                Compensation::Left(state.edge)
            }
            (Compensation::Right(_), false) | (Compensation::Left(_), true) => {
                Compensation::Right(state.edge)
            }
            (Compensation::Off, _) => Compensation::Off,
        };
        let axis = |index: usize| {
            let mut axis = Vec3::ZERO;
            axis[index % 3] = 1.0;
            self.state.frames.direction(axis)
        };
        // A mirror turns the plane's own sense round, against which the side has been swapped.
        let sense = if mirrored { -1.0 } else { 1.0 };
        let across = axis(normal + 1).cross(axis(normal + 2)) * sense;
        let terms = Terms {
            normal: across.normalize_or(Vec3::Z),
            across_tool: normal == 2,
            radius: None,
            outer: Some(match self.state.corner == Outer::Arc && self.state.peak {
                true => Outer::Peak,
                false => self.state.corner,
            }),
            around: self.state.goes_around,
        };
        self.switch(source, compensation, terms)
    }

    /// `POS[X]=`: axes that each go to a place by themselves, and the block with them.
    #[cold]
    fn position_axes(&mut self, source: &Source, block: &Block) -> Outcome {
        if block.has_position() || block.has_arc_word() {
            let message = "POS and a way of the tool in one block";
            return Err(source.block_error(Rule::Syntax, message));
        }
        self.check_free(source, "POS")?;
        let mut alone = Block::empty();
        alone.axes = block.rare.as_ref().map_or([None; 6], |rare| rare.positioned);
        let modal = std::mem::replace(&mut self.state.motion, Motion::Rapid);
        self.motion(source, &alone)?;
        self.state.motion = modal;
        Ok(())
    }

    /// `G53`, `G153`, `SUPA`: a position of the machine, not of the work frame.
    fn machine_position(&mut self, source: &Source, block: &Block) -> Outcome {
        if !block.has_position() {
            return self.no_motion(source, block);
        }
        if block.has_polar() {
            let message = format!("{} with polar coordinates", block.command(9));
            return Err(source.block_error(Rule::MachinePosition, message));
        }
        if !matches!(self.state.motion, Motion::Rapid | Motion::Line)
            || block.has_arc_word()
            || block.has_vector()
        {
            let name = block.command(9);
            let message = format!("{name} is for straight moves of axes");
            return Err(source.block_error(Rule::MachinePosition, message));
        }
        self.check_free(source, block.command(9))?;
        if self.state.motion == Motion::Line {
            self.use_feed(source)?;
        }
        let to = self.machine_target(source, block)?;
        if block.command(9) == "G53" {
            self.emit(source, Action::Risk(Risk::BASIC_FRAME.into()))?;
        }
        self.leave_for(
            source,
            block.axes.map(|axis| axis.is_some()),
            Action::MachineMove(to.into()),
        )
    }

    /// The positions of a block in machine coordinates. `SUPA` and its kin leave the tool length on (Programming
    /// Manual Fundamentals, "Deselect frame": `D0` in their block ends it), so Z of the spindle is not known with an edge, nor before
    /// the program has said one.
    fn machine_target(&self, source: &Source, block: &Block) -> Outcome<MachineMove> {
        let mut to = MachineMove::default();
        for (axis, word) in block.axes.iter().enumerate() {
            let Some(coordinate) = word else { continue };
            if axis >= 3 {
                to.rotary[axis - 3] = Some(coordinate.value);
                continue;
            }
            let value = self.linear(source, *coordinate, f64::NAN, AXIS_NAMES[axis])?;
            let with_length = axis == 2 && (self.state.edge.is_some() || !self.state.edge_is_known);
            to.linear[axis] = Some(if with_length { f64::NAN } else { value });
        }
        Ok(to)
    }

    /// `G74`, `G75`: the values of the axes mean nothing, only their names.
    pub fn approach_fixed_point(&mut self, source: &Source, block: &Block) -> Outcome {
        let name = block.command(2);
        let mut named = block.machine_axes;
        for (named, axis) in named.iter_mut().zip(&block.axes) {
            *named |= axis.is_some();
        }
        if !named.contains(&true) {
            return Err(source.block_error(Rule::Home, format!("{name} needs the names of axes")));
        }
        if block.has_arc_word() || block.has_vector() || block.rotation.is_some() {
            let message = format!("{name} takes axes and FP= only");
            return Err(source.block_error(Rule::Home, message));
        }
        self.check_free(source, name)?;
        self.hold_fixed_point(source, block.fixed_point, named[2])?;
        self.leave_for(source, named, Action::Home(Axes::of(named)))
    }

    /// `FP=` of `G75`: the first fixed point is the one that the machine's file sends Z to; the others lie wherever `MD30600[1]` to `[3]`
    /// say.
    fn hold_fixed_point(&mut self, source: &Source, number: Option<f64>, z: bool) -> Outcome {
        match number {
            None | Some(1.0) => Ok(()),
            Some(2.0 | 3.0 | 4.0) if z => {
                self.emit(source, Action::Risk(Risk::STORED_POSITION.into()))
            }
            Some(2.0 | 3.0 | 4.0) => Ok(()),
            Some(_) => Err(source.block_error(Rule::Home, "FP= of G75 takes 1 to 4")),
        }
    }

    /// Moves in machine coordinates are made neither with compensation nor between modal holes, nor
    /// with `TRAORI`: what they switch off are offsets, so positions would still be the tool tip's.
    pub fn check_free(&self, source: &Source, name: &str) -> Outcome {
        if self.state.compensation != Compensation::Off
            || self.state.compensation_in_effect != Compensation::Off
        {
            let message = format!("{name} while cutter radius compensation is active");
            return Err(source.block_error(Rule::Compensation, message));
        }
        if self.state.modal.waits() {
            let message = format!("{name} while MCALL is active, which would drill or call");
            return Err(source.block_error(Rule::Cycle, message));
        }
        if self.state.tool_center {
            let message = format!("{name} while TRAORI is active; switch it off (TRAFOOF) first");
            return Err(source.block_error(Rule::Home, message));
        }
        Ok(())
    }

    /// The named axes go to a place of the machine, by `action`.
    fn leave_for(&mut self, source: &Source, named: [bool; 6], action: Action) -> Outcome {
        let turned = self.state.frames.turned();
        for (i, _) in named.iter().enumerate().filter(|(_, named)| **named) {
            if i >= 3 {
                self.check_rotary(source, i - 3)?;
                self.state.rotary[i - 3] = f64::NAN;
                self.state.tool_axis = ToolAxis::Rotary;
            } else if turned {
                self.state.lose_position();
            } else {
                self.state.position[i] = f64::NAN;
                self.state.programmed[i] = f64::NAN;
            }
        }
        self.emit(source, action)
    }
}
