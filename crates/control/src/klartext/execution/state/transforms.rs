//! The transformations that are active.

use geom::Vec3;

/// One transformation, from the coordinates behind it to those before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// Cycle 7, mm.
    Shift(Vec3),
    /// Cycle 8: 1 or −1 for each axis.
    Mirror(Vec3),
    /// Cycle 10: about Z through the datum, degrees counter-clockwise.
    Rotation(f64),
    /// Cycle 11: from the datum.
    Scale(f64),
    /// Cycle 26: from a center.
    AxisScale { factor: Vec3, center: Vec3 },
}

impl Step {
    fn is_same_kind(&self, other: &Step) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Whether it changes nothing.
    fn is_neutral(&self) -> bool {
        match self {
            Step::Shift(shift) => *shift == Vec3::ZERO,
            Step::Mirror(signs) => *signs == Vec3::ONE,
            Step::Rotation(degrees) => *degrees == 0.0,
            Step::Scale(factor) => *factor == 1.0,
            Step::AxisScale { factor, .. } => *factor == Vec3::ONE,
        }
    }

    // Axis by axis: an axis whose position is not known (NaN) leaves the others known.
    fn apply(&self, p: Vec3) -> Vec3 {
        match *self {
            Step::Shift(shift) => p + shift,
            Step::Mirror(signs) => p * signs,
            Step::Rotation(degrees) => turned(p, degrees),
            Step::Scale(factor) => p * factor,
            Step::AxisScale { factor, center } => center + (p - center) * factor,
        }
    }

    fn undo(&self, p: Vec3) -> Vec3 {
        match *self {
            Step::Shift(shift) => p - shift,
            Step::Mirror(signs) => p * signs,
            Step::Rotation(degrees) => turned(p, -degrees),
            Step::Scale(factor) => p / factor,
            Step::AxisScale { factor, center } => center + (p - center) / factor,
        }
    }

    /// What becomes of a direction; scales are none of it.
    fn direct(&self, v: Vec3) -> Vec3 {
        match *self {
            Step::Mirror(signs) => v * signs,
            Step::Rotation(degrees) => turned(v, degrees),
            Step::Shift(_) | Step::Scale(_) | Step::AxisScale { .. } => v,
        }
    }
}

fn turned(p: Vec3, degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
}

/// The active transformations, the outermost first: in the order in which they were switched on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Transforms(Vec<Active>);

#[derive(Clone, Debug, PartialEq)]
struct Active {
    step: Step,
    /// Whether it was changed while a later one was active: whether it then acts before or behind the
    /// later one the manuals do not say.
    unclear: bool,
}

impl Transforms {
    pub fn steps(&self) -> impl DoubleEndedIterator<Item = &Step> {
        self.0.iter().map(|active| &active.step)
    }

    /// A point of the coordinates of the program, outside.
    pub fn apply(&self, p: Vec3) -> Vec3 {
        self.steps().rev().fold(p, |p, step| step.apply(p))
    }

    /// A point outside, in the coordinates of the program.
    pub fn undo(&self, p: Vec3) -> Vec3 {
        self.steps().fold(p, |p, step| step.undo(p))
    }

    /// A direction in the coordinates of the program, outside.
    pub fn direct(&self, v: Vec3) -> Vec3 {
        self.steps().rev().fold(v, |v, step| step.direct(v))
    }

    /// Puts a transformation in the place of that of its kind.
    pub fn set(&mut self, step: Step) {
        let place = self.0.iter().position(|active| active.step.is_same_kind(&step));
        match place {
            Some(i) if step.is_neutral() => {
                self.0.remove(i);
            }
            Some(i) => {
                if let Some(active) = self.0.get_mut(i).filter(|active| active.step != step) {
                    *active = Active { step, unclear: true };
                }
            }
            None if step.is_neutral() => {}
            None => self.0.push(Active { step, unclear: false }),
        }
        if let Some(last) = self.0.last_mut() {
            last.unclear = false;
        }
    }

    pub fn find<T>(&self, pick: impl Fn(&Step) -> Option<T>) -> Option<T> {
        self.steps().find_map(pick)
    }

    /// The shift of cycle 7.
    pub fn shift(&self) -> Vec3 {
        let shift = |step: &Step| if let Step::Shift(v) = step { Some(*v) } else { None };
        self.find(shift).unwrap_or(Vec3::ZERO)
    }

    /// The angle of cycle 10, degrees.
    pub fn rotation(&self) -> f64 {
        let angle = |step: &Step| if let Step::Rotation(a) = step { Some(*a) } else { None };
        self.find(angle).unwrap_or(0.0)
    }

    /// Whether left and right are exchanged.
    pub fn mirrors(&self) -> bool {
        let signs = |step: &Step| if let Step::Mirror(v) = step { Some(*v) } else { None };
        self.find(signs).is_some_and(|signs| signs.x * signs.y < 0.0)
    }

    /// Whether there is anything but a shift.
    pub fn is_more_than_a_shift(&self) -> bool {
        self.steps().any(|step| !matches!(step, Step::Shift(_)))
    }

    /// Whether one acts that was changed while a later one was active.
    pub fn is_unclear(&self) -> bool {
        self.0.iter().any(|active| active.unclear)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether lengths change.
    pub fn scales(&self) -> bool {
        self.steps().any(|step| matches!(step, Step::Scale(_) | Step::AxisScale { .. }))
    }

    /// Whether circles in the plane stay circles.
    pub fn keeps_circles(&self) -> bool {
        let uneven =
            |step: &Step| matches!(step, Step::AxisScale { factor, .. } if factor.x != factor.y);
        !self.steps().any(uneven)
    }
}
