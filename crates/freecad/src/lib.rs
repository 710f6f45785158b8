//! Jobs of FreeCAD's CAM workbench as a source.
//!
//! The crate promises that every active operation of a job arrives in the neutral program, or that the job is refused with the
//! operation and the number of its command.
//!
//! A job is a list of operations, each with a label and its commands as text: as JSON, which our part of
//! FreeCAD writes, or as FreeCAD's own dump (a [`Job`]). Joined to one [`Listing`], with what the job alone
//! says as commands of their own (coolant), they run on the virtual control of ISO code, in the dialect of FreeCAD's words (`commands`), and
//! become a neutral program as any NC program does. The names of the operations and the data of the tools, which the commands
//! lack, are added.
//!
//! Lengths are mm in the work frame; FreeCAD's feeds are mm/s, ours mm/min. The same job gives the same program.
//!
//! ```
//! use program::{Op, Purpose};
//! use toolpost_freecad::{Job, read};
//!
//! let text = br#"{"toolpost": "freecad-job", "version": 1, "name": "Plate",
//!     "tools": [{"number": 1, "name": "6 mm", "diameter": 6}],
//!     "operations": [
//!         {"label": "TC: 6 mm", "commands": "M6 T1\nM3 S9000\n"},
//!         {"label": "Slot", "commands": "G0 X0 Y0 Z5\nG1 Z-1 F5\nG1 X10 F10\n"}]}"#;
//! let job = Job::of("plate.json", text).unwrap();
//! let machine = machine::load("generic-3axis-iso").unwrap();
//! let program = read(&machine, "plate.json", job, Purpose::Program).unwrap().program;
//! assert!(program.records.iter().any(|record| matches!(&record.op, Op::Operation(name) if &**name == "Slot")));
//! ```
//!
//! It never runs FreeCAD and never changes a job: what is wrong in it is refused with where FreeCAD corrects it.

mod between_holes;
mod commands;
mod dump;
mod job;
mod listing;
mod reading;

pub use job::{Job, Operation};
pub use listing::{CommandLocation, Listing};
pub use reading::{Reading, read, read_for};
