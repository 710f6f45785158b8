//! Kinds of positioners compared, as the source does: stiffness, and the step of a motor (spec 2.17, 1.7).

/// How the stiffnesses of a positioner's two members act together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Positioner {
    /// Screw drives: one axis carries the other.
    Screw,
    /// A planar motor: the two members do not act on each other. The stiffness is that of the first.
    Planar,
    /// Arm and table, side by side. That they add up is the source's assumption, not shown by it.
    Polar,
}

impl Positioner {
    /// The stiffness of members with the stiffnesses `a` and `b`, in their unit.
    pub fn stiffness(self, a: f64, b: f64) -> f64 {
        match self {
            Positioner::Screw => a * b / (a + b),
            Positioner::Planar => a,
            Positioner::Polar => a + b,
        }
    }
}

/// A micro step of a motor with teeth every `pitch` mm, divided into `steps`: mm.
pub fn micro_step(pitch: f64, steps: u32) -> f64 {
    pitch / f64::from(steps)
}

/// A full step of a motor with teeth every `pitch` mm: four states to a tooth, mm.
pub fn full_step(pitch: f64) -> f64 {
    0.25 * pitch
}
