//! What every front end of Toolpost does: open a source, write its program, prove it, save both, and meanwhile be
//! watched and cancelled. Each program comes with its verdict. The command line, the Python
//! package and whatever comes next are made of this.
//!
//! A source ([`Source`]) is a file or bytes in memory; [`toolpath::read`] opens it, with what it does not say itself
//! ([`Origin`]). [`toolpath::machine`] opens a machine; where its file and all that it extends may lie is the caller's to
//! say ([`Reach`](machine::Reach)). [`post::proven`] writes and proves, [`prove::compare`] proves any text,
//! [`wire::make`], [`pcb::Job`] and [`glass::Job`] plan, write and prove what a wire, a board or a block of glass needs. [`files::save_program`] saves a
//! program with its report, or neither. Whoever waits hands over a [`Watch`], which hears of each step and may end the work.
//!
//! Lengths are mm, feeds mm/min, times s, as in every crate. The same input gives the same program, report and findings,
//! whoever watches: there is no clock in them, no order of threads and no folder.
//!
//! ```
//! use app::{Origin, Source, Verdict, files, post, toolpath};
//! use program::Purpose;
//! use toolpost_app as app;
//!
//! let text = "PPRINT/HOLE\nUNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\nGOTO/0,0,-2\nRAPID\nGOTO/0,0,10\n";
//! let source = Source::memory("hole.cls", text.as_bytes());
//! let machine = toolpath::machine("generic-3axis-linuxcnc").unwrap();
//! let toolpath = toolpath::read(&source, false, &Origin::default(), Some(&machine), Purpose::Program).unwrap();
//! let tolerances = proof::Tolerances::default();
//! let posted = post::proven(&toolpath, &machine, "hole.ngc", &tolerances, &()).unwrap();
//! assert_eq!(posted.account.verdict, Verdict::Done);
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("hole.ngc");
//! let report = posted.account.report();
//! files::save_program(&path, &posted.text, &[], Some(&report), &toolpath.files()).unwrap();
//! assert!(folder.path().join("hole.ngc.report.json").is_file());
//! ```
//!
//! Nothing is printed here, nothing ends the process, and nothing but [`files`] writes a file.

mod account;
mod fcstd;
pub mod files;
pub mod fit;
pub mod glass;
pub mod helper;
mod input;
mod parallel;
pub mod pcb;
pub mod post;
pub mod prove;
pub mod report;
pub mod summary;
pub mod toolpath;
mod watch;
pub mod wire;

pub use account::{Account, Stop, Verdict};
pub use input::Source;
pub use toolpath::Origin;
pub use watch::Watch;
