//! Jobs of FreeCAD's CAM workbench as a source.
//!
//! A job is a list of operations, each with a label and its commands as text: as JSON, which our part of
//! FreeCAD writes, or as FreeCAD's own dump (a [`Job`]). Joined to one [`Listing`], with what the job alone
//! says as commands of their own (coolant), they run on a virtual control that knows FreeCAD's words and
//! become a neutral program as any NC program does. What the commands do not say is added to that: the
//! names of the operations, and the data of the tools.
//!
//! What is wrong is told with the operation and the number of its command.

mod dump;
mod job;
mod lift;
mod listing;
mod way;

pub use job::{Job, Operation};
pub use lift::{Reading, read};
pub use listing::{Listing, Place};
