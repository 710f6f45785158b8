//! Both solutions of the kinematics, compared with what others have computed and with each other.

mod outside;
mod properties;
mod robots;
mod vectors;
