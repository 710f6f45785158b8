//! What the control remembers from block to block.

mod cycle;
pub(super) mod frames;
mod kinematics;
mod nurbs;
mod registers;
mod wire;

use crate::event::{Orientation, Position};
use crate::iso::dialects::facts::Facts;
use crate::iso::language::words::{FeedMode, Motion, Plane, Side};
use crate::kernel::compensation::Terms;
use crate::{Settings, StartModes, TableAxis, Units};
use geom::{Frame, Vec3};
use program::{Coolant, Feed, Purpose, Spindle, WorkOffset};

pub(super) use cycle::Holding;
pub(super) use kinematics::Kinematics;
pub(super) use nurbs::Nurbs;
pub(super) use registers::Registers;
pub(super) use wire::Wire;

use frames::{Frames, ProgramFrame};

/// The modes, the position and what was reported last.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Interpolation; none where axis words mean nothing (LinuxCNC and GRBL after `G80`).
    pub motion: Option<Motion>,
    pub plane: Plane,
    pub incremental: bool,
    pub centers_absolute: bool,
    /// Which modes of a start are sure: by the control, its machine's file, or since the program has said them.
    pub sure: StartModes,
    /// `G20` or `G21`; none before the program has said it: controls keep the unit of the program before.
    pub inches: Option<bool>,
    pub feed_mode: FeedMode,
    pub feed: Option<Feed>,
    /// F as it was written last.
    pub f: Option<f64>,
    pub spindle: Spindle,
    /// Last S: 1/min, or with constant surface speed m/min or feet/min.
    pub speed: Option<f64>,
    /// While the surface speed is constant (`G96`): the most that the spindle turns, 1/min.
    pub surface: Option<f64>,
    /// `M29` has been given: the next tapping cycle turns the spindle itself.
    pub rigid: bool,
    pub coolant: Coolant,
    /// Last T.
    pub selected: Option<u32>,
    /// Tool in the spindle.
    pub tool: Option<u32>,
    pub length: Length,
    pub compensation: Compensation,
    /// What [`Action::WorkOffset`](crate::Action::WorkOffset) has said last.
    pub work_offset: Option<u32>,
    /// Whether Z counts for nothing where no block has said it: a flat contour.
    pub flat: bool,
    /// What the program is read for.
    pub purpose: Purpose,
    /// Whether words of rotary axes that the machine lacks may say 0.
    pub rotary_at_zero: bool,
    /// Programmed position in the frame in which words are read, mm; NaN where not known.
    pub position: Vec3,
    /// Positions of A, B, C in degrees; 0 for axes that the machine lacks, NaN where not known.
    pub rotary: [f64; 3],
    /// Whether the control counts A, B, C modulo 360°, where that is known.
    pub modulo: [Option<bool>; 3],
    /// Whether taps are held in a chuck that floats.
    pub floating_holder: bool,
    /// Whether it is known how far above R a peck cycle goes to clear chips.
    pub knows_peck_retract: bool,
    /// Whether the tool length counts along Z in every plane, and whether Z moves where it changes, where that is known.
    pub length_along_z: Option<bool>,
    pub length_moves_axis: Option<bool>,
    /// Whether P of a dwell counts milliseconds, or tenths of them, where that is known.
    pub dwell_p_milliseconds: Option<bool>,
    /// Whether the sign of a rotary word is the direction, where that is known.
    pub rotary_by_sign: Option<bool>,
    /// Which of A, B and C turn a table.
    pub table: [bool; 3],
    /// Where they turn it, in the order from the part to the bed, where that is known.
    pub table_axes: Option<Vec<TableAxis>>,
    /// Whether `G43.4` counts in the frame of the part with the table at 0, where that is known (FANUC).
    pub table_frame_at_zero: Option<bool>,
    /// Whether programs of this machine write work offsets.
    pub sets_work_offsets: bool,
    /// What lies between programmed coordinates and the work frame.
    pub frames: Frames,
    /// The same as one way: [`Frames::place`], kept.
    pub place: ProgramFrame,
    pub tilt: Tilt,
    pub kinematics: Kinematics,
    /// The wire of a wire-EDM machine.
    pub wire: Option<Wire>,
    /// Axes (bit 0 is X) of which the next absolute words must come together, since the coordinates
    /// have just been turned.
    pub loose: u8,
    /// Polar coordinates are on.
    pub polar: Option<Polar>,
    /// The curve whose `G5.3` has not come yet (LinuxCNC).
    pub nurbs: Option<Box<Nurbs>>,
    /// Lathe: X is a diameter.
    pub diameter: bool,
    pub registers: Registers,
    /// Where to a boring bar leaves the wall; none where nobody has said it.
    pub aside: Option<Vec3>,
    /// Stored by `G28.1` and `G30.1`, in machine coordinates, mm; NaN where not known.
    pub homes: [Vec3; 2],
    /// Points of the part's surface, in the work frame, that a probe touches.
    pub touches: Vec<Vec3>,
    /// Where the last probing move has been answered, in programmed coordinates and in the unit
    /// of the program then; none where nobody knows.
    pub probed: Option<Vec3>,
    /// The last probing move went down along Z alone, and stands where it has touched something.
    pub touching: bool,
    /// The point on the way of the last `G28`, in the work frame.
    pub via: Option<Vec3>,
    /// `G99`: holes end at the R plane; `G98`: at the initial level. LinuxCNC's manual names no
    /// default, so there it is open until the program says it.
    pub return_to_r: Option<bool>,
    /// The last P of a cycle, s.
    pub cycle_dwell: Option<f64>,
    pub cycle: Option<Holding>,
    /// The events say where the tool stands, as far as it is known.
    pub is_reported: bool,
    /// Z stands where `G28`, `G30` or `G53` has sent it.
    pub z_is_home: bool,
    /// `G28`, `G30` or `G53` of Z has taken the tool length away, and no block has given it back (FANUC).
    pub length_is_suspended: bool,
    /// Something has moved.
    pub moved: bool,
    /// Something has moved at feed.
    pub cut: bool,
    /// Look-ahead is on (FANUC `G5.1 Q1`, `G5 P10000`).
    pub looks_ahead: bool,
    /// By how much corners are cut at the most, mm, where `G187 E` has said it (Haas).
    pub rounds_corners: Option<f64>,
    /// `M2` or `M30` has been executed.
    pub ended: bool,
}

/// Tool length offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    None,
    /// `G43 H`: the register.
    Register(u32),
    /// `G43.4 H`: the register; the control keeps the tool centre point.
    Center(u32),
    /// `G43.1 Z`: the length itself, mm.
    Value(f64),
}

/// Cutter radius compensation: what runs, and what the next linear move in the plane switches to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compensation {
    pub active: program::Compensation,
    pub asked: program::Compensation,
    /// Radius that the block itself gives (`G41.1`), mm.
    pub radius: Option<f64>,
}

impl Compensation {
    /// Whether the program wants the path offset.
    pub(super) fn is_on(&self) -> bool {
        self.asked != program::Compensation::Off
    }
}

impl Side {
    /// The side with its register, for the neutral program.
    pub(super) fn with(self, register: Option<u32>) -> program::Compensation {
        match self {
            Side::Off => program::Compensation::Off,
            Side::Left => program::Compensation::Left(register),
            Side::Right => program::Compensation::Right(register),
        }
    }
}

/// Polar coordinates: X is a radius and Y an angle, or the like in other planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Polar {
    /// The pole, in programmed coordinates.
    pub pole: Vec3,
    /// mm; NaN where not given yet.
    pub radius: f64,
    /// Degrees; NaN where not given yet.
    pub angle: f64,
}

/// Tilted working plane (`G68.2`); the frame turns programmed coordinates into the work frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tilt {
    None,
    /// Declared; the tool does not stand along its Z yet.
    Declared(Frame),
    /// `G53.1` has brought the tool along its Z.
    Reached(Frame),
}

/// The unknown position.
pub(super) const UNKNOWN: Vec3 = Vec3::NAN;

impl State {
    /// The state at the start of a program: that of a control after power on. FANUC: parameters 3401
    /// and 3402 as delivered; LinuxCNC: `RS274NGC_STARTUP_CODE` empty; GRBL: its first `$G` report, but for the motion: `G0` after
    /// power on, `G1` behind `M2` and `M30`.
    pub(super) fn new(facts: &Facts, axes: [bool; 3], settings: &Settings) -> State {
        let all_zero = settings.setup.start.is_some();
        // A FANUC goes on in the work offset of the program before.
        let work_offset = facts.reset.work_offset.map_or(0, WorkOffset::number);
        let sure = facts.reset.modes.or(settings.start_modes);
        State {
            motion: None,
            plane: Plane::Xy,
            incremental: false,
            centers_absolute: false,
            // The work offset has a state of its own: `Frames::unsaid`.
            sure: StartModes { first_offset: true, ..sure },
            inches: match facts.source.is_some() {
                true => Some(false),
                false => settings.setup.units.map(|units| units == Units::Inches),
            },
            feed_mode: FeedMode::PerMinute,
            feed: None,
            f: None,
            spindle: Spindle::Off,
            speed: None,
            surface: None,
            rigid: false,
            coolant: Coolant::Off,
            selected: None,
            tool: None,
            length: Length::None,
            compensation: Compensation {
                active: program::Compensation::Off,
                asked: program::Compensation::Off,
                radius: None,
            },
            work_offset: None,
            flat: settings.setup.flat,
            purpose: settings.setup.purpose,
            rotary_at_zero: settings.setup.rotary_at_zero,
            position: settings.setup.position_at_start(),
            rotary: axes.map(|exists| if exists { f64::NAN } else { 0.0 }),
            modulo: settings.modulo,
            floating_holder: settings.floating_holder,
            knows_peck_retract: settings.retract_above_r.is_some(),
            length_along_z: settings.length_along_z,
            length_moves_axis: settings.length_moves_axis,
            dwell_p_milliseconds: settings.dwell_p_milliseconds,
            rotary_by_sign: settings.rotary_by_sign,
            table: settings.table,
            table_axes: settings.table_axes.clone(),
            table_frame_at_zero: settings.table_frame_at_zero,
            sets_work_offsets: settings.sets_work_offsets,
            frames: Frames::new(work_offset, all_zero, &facts.offsets, sure.first_offset),
            place: ProgramFrame::SAME,
            tilt: Tilt::None,
            kinematics: Kinematics::at_start(facts, settings),
            wire: facts.wire.map(|_| Wire::new(settings)),
            loose: 0,
            polar: None,
            nurbs: None,
            diameter: false,
            registers: Registers::new(&settings.setup.tools),
            aside: settings.setup.aside,
            homes: [UNKNOWN; 2],
            touches: settings.setup.surface.clone(),
            probed: None,
            touching: false,
            via: None,
            return_to_r: facts.cycles.returns,
            cycle_dwell: None,
            cycle: None,
            is_reported: all_zero,
            z_is_home: false,
            length_is_suspended: false,
            moved: false,
            cut: false,
            looks_ahead: false,
            rounds_corners: None,
            ended: false,
        }
    }

    /// The pose of a programmed point with the rotary axes at `rotary` (degrees).
    #[inline]
    pub(super) fn pose(&self, point: Vec3, rotary: [f64; 3]) -> Position {
        let point = self.place.point(point);
        if let Some(wire) = &self.wire {
            return Position { point, orientation: wire.orientation() };
        }
        match self.tilt {
            Tilt::Reached(_) => Position::new(point, self.place.direction(Vec3::Z)),
            Tilt::None | Tilt::Declared(_) => Position {
                point,
                orientation: Orientation::Rotary {
                    degrees: self.place.rotary(rotary),
                    tool_center: self.keeps_center(),
                },
            },
        }
    }

    /// Whether the tip stays where it is while rotary axes turn: under `G43.4`, or by the kinematics that are on.
    #[inline]
    pub(super) fn keeps_center(&self) -> bool {
        matches!(self.length, Length::Center(_)) || self.kinematics == Kinematics::Tip
    }

    /// The machine stands there from here on: `point` in the programmed frame, mm, `rotary` in degrees.
    #[inline]
    pub(super) fn arrive(&mut self, point: Vec3, rotary: [f64; 3]) {
        (self.position, self.rotary) = (point, rotary);
        (self.moved, self.is_reported) = (true, true);
        // Words of X and Y move Z as well where the axes are not those of the machine.
        let apart = self.tilt != Tilt::None || self.keeps_center();
        self.z_is_home &= point.z.is_nan() && !apart;
        self.frames.used();
    }

    /// Whether a block of X, Y and Z behind one that only moved is a straight move to there and nothing else: the one condition
    /// of the short path ([`super::straight`]). Every field is named, so that a new one stops the compiler here.
    pub(super) fn moves_straight(&self, facts: &Facts) -> bool {
        let State {
            // What such a block means depends on them.
            incremental,
            diameter,
            polar,
            tilt,
            loose,
            frames,
            compensation,
            cycle,
            nurbs,
            wire,
            feed,
            is_reported,
            cut,
            length_is_suspended,
            rigid,
            // The block says them itself, or the short path asks for them.
            motion: _,
            inches: _,
            flat: _,
            position: _,
            rotary: _,
            place: _,
            kinematics: _,
            length: _,
            // T is asked for where the operator changes tools.
            selected: _,
            tool: _,
            // They change how arcs, cycles, splines and words of other letters are read, ...
            plane: _,
            centers_absolute: _,
            // A cut has leaned on them before.
            sure: _,
            feed_mode: _,
            f: _,
            modulo: _,
            floating_holder: _,
            knows_peck_retract: _,
            length_along_z: _,
            length_moves_axis: _,
            dwell_p_milliseconds: _,
            rotary_by_sign: _,
            rotary_at_zero: _,
            table: _,
            table_axes: _,
            table_frame_at_zero: _,
            sets_work_offsets: _,
            registers: _,
            aside: _,
            touches: _,
            probed: _,
            touching: _,
            return_to_r: _,
            cycle_dwell: _,
            // ... what the machine does besides, or what is asked of the program as a whole.
            spindle: _,
            speed: _,
            surface: _,
            coolant: _,
            work_offset: _,
            purpose: _,
            homes: _,
            via: _,
            z_is_home: _,
            moved: _,
            looks_ahead: _,
            rounds_corners: _,
            ended: _,
        } = self;
        !(*incremental || *diameter || *length_is_suspended || *rigid)
            && polar.is_none()
            && cycle.is_none()
            && nurbs.is_none()
            && wire.is_none()
            && *tilt == Tilt::None
            && *loose == 0
            && frames.lost.is_none()
            && frames.unsaid == 0
            && compensation.active == compensation.asked
            && matches!(feed, Some(Feed::PerMinute(_)))
            && *cut
            // A cut has moved, and so it is reported where the tool stands; asked all the same.
            && *is_reported
            && !self.awaits_tool(facts)
    }

    /// Whether the spindle turns or coolant runs.
    pub(crate) fn is_running(&self) -> bool {
        self.spindle != Spindle::Off || self.coolant != Coolant::Off
    }

    /// T has named another tool, which the operator puts in at the next `M0`.
    pub(super) fn awaits_tool(&self, facts: &Facts) -> bool {
        facts.tools.by_hand && self.selected != self.tool
    }

    /// What compensation has to know of the block that switches it.
    pub(crate) fn compensation_terms(&self) -> Terms {
        let [first, second, third] = self.plane.axes();
        let mut normal = Vec3::ZERO;
        normal[third] = 1.0;
        // The side that is reported is that after a mirror, which has turned the sense of the plane round.
        let swaps = self.frames.transform.swaps_sides(first, second);
        let sense = if swaps { -1.0 } else { 1.0 };
        Terms {
            normal: self.place.normal(normal) * sense,
            across_tool: third == 2,
            radius: self.compensation.radius,
            outer: None,
            around: false,
        }
    }
}

impl Plane {
    /// Index of the first, the second and the perpendicular axis, right-handed: `G18` is Z, X, Y.
    pub(crate) fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }

    /// As the word says it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Plane::Xy => "G17",
            Plane::Zx => "G18",
            Plane::Yz => "G19",
        }
    }
}
