//! The execution of a block: what it does, from the state that the blocks before it have left.
//!
//! One [`step`] goes through the block in the order of the control and asks each of the others for its
//! part: the words that move ([`motion`], [`arcs`], [`splines`], [`threads`], [`places`]), what is made
//! of many moves ([`cycles`], [`patterns`]), the coordinates ([`coordinates`] say how frames
//! change), [`kinematics`] that a program switches, the [`dynamic_offset`], [`tools`], the [`wire`], and [`feeds`]. How a number
//! counts is asked of [`numbers`], what holds of the [`state`], which knows none of the others, which expressions read by
//! [`system`]. A straight move behind another goes [`straight`] without all that.

#![deny(clippy::wildcard_enum_match_arm)]

mod arcs;
mod coordinates;
mod cycles;
mod dynamic_offset;
mod ending;
mod feeds;
mod kinematics;
mod motion;
pub(super) mod numbers;
mod nurbs;
mod patterns;
mod places;
mod signals;
mod splines;
pub(super) mod state;
pub(super) mod step;
pub(super) mod straight;
mod system;
mod threads;
mod tools;
mod wire;
