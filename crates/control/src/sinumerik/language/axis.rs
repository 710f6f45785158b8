//! The names of axes.

/// The names of the axes, in the order of their numbers.
pub(crate) const AXIS_NAMES: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

/// The index of the axis of that name (in capitals).
pub(super) fn axis(name: &str) -> Option<usize> {
    AXIS_NAMES.iter().position(|axis| *axis == name)
}

/// The name of the axis with that index.
pub(super) fn axis_name(index: usize) -> &'static str {
    AXIS_NAMES.get(index).copied().unwrap_or("")
}
