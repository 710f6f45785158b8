//! Where the axes of the machine stand for a position of the program, whatever coordinates its blocks give: positions of
//! the axes, tool-centre control by angles, vectors, tilted planes.
//!
//! **Frame.** X, Y and Z are what the control shows in machine coordinates, mm: they count from the machine's zero, and
//! for Z to the gauge line of the spindle, with the head in its zero position. Rotary axes are degrees, in whole turns as
//! far as they are known.
//!
//! **Length.** That of the tool that the source calls, from the gauge line to the tip. Where nobody says it, Z counts to
//! the tip instead; where `work_zero` of the machine's file is missing, X, Y and Z count from the work zero. Differences
//! between two poses of the same tool are right all the same.

use crate::gauge::Gauge;
use crate::tilt::{self, Degrees};
use control::{Orientation, Position, TiltChoice};
use geom::{Vec3, angle_between, between};
use machine::{Inverse, Machine, Solutions, Unsaid};

/// Positions of the axes of the machine; NaN where they are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MachinePose {
    /// X, Y, Z, mm.
    pub linear: Vec3,
    /// A, B, C, degrees.
    pub rotary: [f64; 3],
}

impl Gauge<'_> {
    /// Where the axes stand at a position of the program, with the rotary axes at `rotary` (degrees of A, B, C), which
    /// is one of [`PossiblePositions::at`].
    ///
    /// # Errors
    /// The fact on which it hangs, where nobody says it.
    pub fn machine_pose(
        &self,
        position: &Position,
        rotary: [f64; 3],
    ) -> Result<MachinePose, Unsaid> {
        let Gauge { machine, tool_length, .. } = *self;
        let length = tool_length.unwrap_or(0.0);
        let linear = match position.orientation {
            Orientation::Rotary { tool_center: false, .. } => position.point,
            Orientation::Rotary { .. } | Orientation::Axis(_) => {
                if let Some(unsaid) = machine.unsaid(rotary, tool_length) {
                    return Err(unsaid);
                }
                machine.linear_for(position.point, rotary, length)
            }
        };
        let zero = machine.work_zero.unwrap_or_default();
        Ok(MachinePose { linear: linear + Vec3::Z * length + zero, rotary })
    }
}

/// Where the rotary axes stand, as far as the program lets it be known.
///
/// A block that says their positions leaves no question. Along a vector the control turns the tool on the great circle,
/// and the axes follow without a jump from where they stand, also beyond half a turn; behind an unknown place they may
/// stand at any solution that is within the travel. Of a tilted plane the control takes those that its rule of choice
/// allows ([`crate::tilt`]).
pub(crate) struct PossiblePositions<'a> {
    machine: &'a Machine,
    inverse: Inverse<'a>,
    /// Degrees of A, B, C; several where it is not known which the control has taken, none where nothing is known.
    angles: Vec<Degrees>,
    /// The tool axis that they give, where the program has said that.
    axis: Option<Vec3>,
    /// How far that is from the pole, radians.
    from_pole: f64,
    /// How the control is about to turn to a tilted plane.
    swivels: Option<TiltChoice>,
    /// How it has turned to the one in which it is.
    choice: Option<TiltChoice>,
    /// Angles of the block looked at, and the tool axis for which they were worked out.
    next: Vec<Degrees>,
    next_axis: Option<Vec3>,
    next_from_pole: f64,
    /// The first position beyond the travel on the way there.
    strayed: Option<Degrees>,
}

/// Part of the angle to the pole by which the tool turns from one position that is looked at to the next: the axis that is
/// free in the pole then turns by less than 20°, and the other solution is at least half a turn less that away.
const POLE_PART: f64 = 0.25;

/// Nearer to a pole than four times this, radians (0.002°), the tool goes through it.
const LEAST_STEP: f64 = 3.5e-5;

/// Within this angle of a pole, radians, a SINUMERIK leads a vector that goes past it through it: 2°, MD24530
/// `$MC_TRAFO5_NON_POLE_LIMIT_1` as it is delivered.
const POLE_LIMIT: f64 = std::f64::consts::PI / 90.0;

/// A way that comes nearer to the pole than this, radians, goes through it: 0.001°.
const THROUGH_POLE: f64 = std::f64::consts::PI / 180_000.0;

/// How often the stretch in which a way is nearest to a pole is cut by a third: to 1e-7 of it.
const POLE_STEPS: u32 = 40;

/// The tool turns at most this much between two places that are looked at near a pole, radians: a tenth of a degree.
const POLE_SAMPLE: f64 = std::f64::consts::PI / 1800.0;

impl<'a> PossiblePositions<'a> {
    /// How far from the pole, degrees, the vector of a block to `axis` goes past it, where that is so near that the control
    /// leads it through the pole. Ends that are themselves so near are not judged, nor a way through the pole itself.
    pub fn passes_pole(&mut self, axis: Vec3) -> Option<f64> {
        let start = self.axis.filter(|start| *start != axis)?;
        self.at(&Orientation::Axis(axis));
        let outside = [self.from_pole, self.next_from_pole].map(|near| near - POLE_LIMIT);
        let turn = angle_between(start, axis);
        if outside.iter().any(|far| *far < 0.0) || outside[0] + outside[1] > turn {
            return None;
        }
        let count = (turn / POLE_SAMPLE).ceil().max(2.0) as u32;
        let near = |part: f64| {
            let solutions = self.inverse.solve(between(start, axis, part));
            solutions.map_or(f64::INFINITY, |all| from_pole(self.machine, &all))
        };
        let part = |i: u32| f64::from(i) / f64::from(count);
        let places = (1..count).map(|i| (i, near(part(i))));
        let (least, _) = places.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let (mut low, mut high) = (part(least - 1), part(least + 1));
        for _ in 0..POLE_STEPS {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if near(a) < near(b) { high = b } else { low = a }
        }
        let nearest = near((low + high) / 2.0);
        (nearest < POLE_LIMIT && nearest > THROUGH_POLE).then_some(nearest.to_degrees())
    }

    /// Before the first block: nowhere that is known.
    pub fn new(machine: &'a Machine) -> PossiblePositions<'a> {
        PossiblePositions {
            machine,
            inverse: Inverse::of(machine),
            angles: Vec::new(),
            axis: None,
            from_pole: 0.0,
            swivels: None,
            choice: None,
            next: Vec::new(),
            next_axis: None,
            next_from_pole: 0.0,
            strayed: None,
        }
    }

    /// The control turns the axes to a tilted plane.
    pub fn swivel(&mut self, choice: TiltChoice) {
        (self.swivels, self.axis, self.next_axis) = (Some(choice), None, None);
    }

    /// What a person can do where several positions are possible.
    pub fn way_out(&self) -> Option<&'static str> {
        tilt::way_out(self.machine, self.swivels.or(self.choice)?)
    }

    /// Whether it has turned them, and no block has moved since.
    pub fn has_swivelled(&self) -> bool {
        self.swivels.is_some()
    }

    /// The axes stand where nobody knows.
    pub fn forget(&mut self) {
        self.angles.clear();
        (self.axis, self.next_axis) = (None, None);
    }

    /// Degrees of A, B, C where the axes stand.
    pub fn here(&self) -> &[Degrees] {
        &self.angles
    }

    /// The first position beyond the travel on the way to what [`PossiblePositions::at`] was asked for last.
    pub fn strayed(&self) -> Option<Degrees> {
        self.strayed
    }

    /// Degrees of A, B, C for a block that goes to `orientation` from here: several where each is possible, none where
    /// nothing is known.
    #[inline]
    pub fn at(&mut self, orientation: &Orientation) -> &[Degrees] {
        match *orientation {
            Orientation::Rotary { degrees, .. } => {
                self.next.clear();
                self.next.push(degrees);
                (self.next_axis, self.strayed) = (None, None);
            }
            Orientation::Axis(axis) if self.axis == Some(axis) => {
                self.strayed = None;
                return &self.angles;
            }
            Orientation::Axis(axis) if self.next_axis == Some(axis) => {}
            Orientation::Axis(axis) => self.solve(axis),
        }
        &self.next
    }

    /// The axes have turned to `orientation`.
    #[inline]
    pub fn arrive(&mut self, orientation: &Orientation) {
        self.at(orientation);
        match *orientation {
            Orientation::Axis(axis) if self.axis == Some(axis) => return,
            Orientation::Axis(axis) => self.axis = Some(axis),
            Orientation::Rotary { .. } => self.axis = None,
        }
        std::mem::swap(&mut self.angles, &mut self.next);
        self.from_pole = self.next_from_pole;
        (self.choice, self.next_axis) = (self.swivels.take(), None);
    }

    /// Finds where the axes may stand with the tool along `axis`.
    fn solve(&mut self, axis: Vec3) {
        self.next.clear();
        (self.next_axis, self.strayed) = (Some(axis), None);
        if self.machine.rotary.is_empty() {
            self.next.push([0.0; 3]);
            return;
        }
        let Ok(solutions) = self.inverse.solve(axis) else { return };
        self.next_from_pole = from_pole(self.machine, &solutions);
        if let Some(choice) = self.swivels {
            tilt::take(self.machine, choice, &self.angles, &solutions, &mut self.next);
            return;
        }
        if !tilt::is_known(&self.angles) {
            return tilt::reachable(self.machine, &solutions, &mut self.next);
        }
        let angles = std::mem::take(&mut self.angles);
        for from in &angles {
            let (start, near) = self.start(*from);
            let turn = angle_between(start, axis);
            if turn <= longest_step(near, self.next_from_pole) {
                self.step(from, &solutions);
            } else {
                for degrees in self.followed(*from, [start, axis], turn, near) {
                    self.add(degrees);
                }
            }
        }
        self.angles = angles;
    }

    /// The tool axis with the rotary axes at `from`, and how far it is from the pole, radians.
    fn start(&self, from: Degrees) -> (Vec3, f64) {
        if let Some(axis) = self.axis {
            return (axis, self.from_pole);
        }
        let axis = self.machine.axis_at(from);
        let solutions = self.inverse.solve(axis);
        (axis, solutions.map_or(0.0, |all| from_pole(self.machine, &all)))
    }

    /// Where the axes come from one place (degrees of A, B, C) while the tool turns on the great circle from one axis to
    /// another; `None` where several positions are possible, or none.
    pub fn follow(&mut self, from: Degrees, axes: [Vec3; 2]) -> Option<Degrees> {
        let solutions = self.inverse.solve(axes[0]).ok()?;
        let near = from_pole(self.machine, &solutions);
        match self.followed(from, axes, angle_between(axes[0], axes[1]), near)[..] {
            [one] => Some(one),
            _ => None,
        }
    }

    /// Adds where the axes come from one place in a turn so short that they cannot leave the solution in which they are.
    #[inline]
    fn step(&mut self, from: &Degrees, solutions: &Solutions) {
        for degrees in tilt::nearest(self.machine, from, solutions).into_iter().flatten() {
            self.stray(&degrees);
            self.add(degrees);
        }
    }

    fn add(&mut self, degrees: Degrees) {
        if !self.next.contains(&degrees) {
            self.next.push(degrees);
        }
    }

    /// Notes a position on the way that is beyond the travel.
    fn stray(&mut self, degrees: &Degrees) {
        if self.strayed.is_none() && !tilt::is_within(self.machine, degrees) {
            self.strayed = Some(*degrees);
        }
    }

    /// Where the axes come from one place while the tool turns on the great circle to `to`: to several positions where it
    /// leaves a pole in the middle between two solutions. `turn` is the angle between both tool axes, `near` that from the
    /// first to the pole, radians.
    fn followed(
        &mut self,
        from: Degrees,
        [start, to]: [Vec3; 2],
        turn: f64,
        near: f64,
    ) -> Vec<Degrees> {
        let mut stands = vec![from];
        let (mut done, mut step, mut before) = (0.0, turn, near);
        loop {
            let goal = (done + step).min(turn);
            let is_end = goal >= turn;
            let axis = if is_end { to } else { between(start, to, goal / turn) };
            let Ok(solutions) = self.inverse.solve(axis) else { return Vec::new() };
            let near = from_pole(self.machine, &solutions);
            if goal - done > longest_step(near, before) {
                step = (goal - done) / 2.0;
                continue;
            }
            let mut reached: Vec<Degrees> = Vec::new();
            for degrees in
                stands.iter().flat_map(|at| tilt::nearest(self.machine, at, &solutions)).flatten()
            {
                if !reached.contains(&degrees) {
                    reached.push(degrees);
                }
            }
            reached.iter().for_each(|degrees| self.stray(degrees));
            if is_end {
                return reached;
            }
            (stands, done, step, before) = (reached, goal, 2.0 * (goal - done), near);
        }
    }
}

/// The longest turn of the tool between two positions that are looked at, radians, so far from the pole at either.
fn longest_step(near: f64, before: f64) -> f64 {
    (POLE_PART * near.min(before)).max(LEAST_STEP)
}

/// How far the tool is from the pole in which its solutions are one, radians; as far as can be where there is one alone.
fn from_pole(machine: &Machine, solutions: &Solutions) -> f64 {
    let [one, other] = solutions.degrees;
    if solutions.free.is_some() {
        return 0.0;
    }
    if one == other {
        return std::f64::consts::PI;
    }
    let apart = |axis: &machine::RotaryAxis| {
        tilt::short(one[axis.index()] - other[axis.index()]).abs().to_radians() / 2.0
    };
    machine.rotary.iter().map(apart).fold(std::f64::consts::PI, f64::min)
}
