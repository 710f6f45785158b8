//! What a program calculates with.

/// A calculated number; `None` is the null of a macro variable that holds nothing.
pub(super) type Value = Option<f64>;

/// Which parameter is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target<'t> {
    Number(u32),
    /// As it is written.
    Name(&'t [u8]),
}
