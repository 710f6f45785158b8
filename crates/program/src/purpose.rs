//! What a toolpath is read for.

/// What a toolpath is read for, which decides what it has to say: a reader asks only for what changes the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Purpose {
    /// To be written and proven. A cut needs its start, its feed and a spindle that turns, and the program its end.
    #[default]
    Program,
    /// The contour of a wire, which has its own speed and no spindle.
    Contour,
    /// A picture and measures: neither the start of the first cut nor the end of the program is asked for.
    Picture,
}

impl Purpose {
    /// Whether a cut needs a feed, and a spindle that turns.
    pub fn asks_technology(self) -> bool {
        self == Purpose::Program
    }

    /// Whether the first cut needs its start, and the program its end.
    pub fn asks_ends(self) -> bool {
        self != Purpose::Picture
    }
}
