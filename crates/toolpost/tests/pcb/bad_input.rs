//! Boards and calls that nothing can be made of.
