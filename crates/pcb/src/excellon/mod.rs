//! Excellon.
