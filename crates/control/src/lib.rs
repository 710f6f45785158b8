//! Virtual controls: an NC program in, the motion it makes out.
//!
//! Each dialect is written from the makers' manuals (`docs/controls/` names them), never from our own
//! writer: the two sides of a proof must not share a misunderstanding. A word or a block that a
//! control does not understand is an error, never skipped. A block is read, checked as a whole, and
//! only then executed, so that a bad block changes nothing.
//!
//! Records come out one by one as the program runs. Poses say what the block says: rotary positions
//! as [`program::Orientation::Rotary`]; vectors and tilted planes resolved into the work frame as
//! [`program::Orientation::Axis`]. Kinematics are not this crate's business.

mod decimal;
mod iso;
mod klartext;
mod sinumerik;

use program::{Diagnostic, Record};

/// The languages that are understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// FANUC 30i family, milling, G-code system of the mill.
    Fanuc,
    /// LinuxCNC's RS-274.
    LinuxCnc,
    /// GRBL 1.1.
    Grbl,
    /// SINUMERIK 840D sl and 828D.
    Sinumerik,
    /// HEIDENHAIN Klartext (TNC 640, iTNC 530).
    Klartext,
}

impl Dialect {
    /// Every dialect with the name that a control file gives as its `reader`.
    pub const NAMES: [(&'static str, Dialect); 5] = [
        ("fanuc", Dialect::Fanuc),
        ("linuxcnc", Dialect::LinuxCnc),
        ("grbl", Dialect::Grbl),
        ("sinumerik", Dialect::Sinumerik),
        ("klartext", Dialect::Klartext),
    ];

    /// The dialect of that name.
    pub fn named(name: &str) -> Option<Dialect> {
        Dialect::NAMES.iter().find(|(n, _)| *n == name).map(|(_, dialect)| *dialect)
    }

    /// The work offset that is active before a program names one: on a SINUMERIK `G500`, which is none.
    /// A FANUC may keep that of the last program, and Klartext takes the operator's preset.
    pub fn work_offset_at_reset(self) -> Option<u32> {
        match self {
            Dialect::Sinumerik => Some(sinumerik::WORK_OFFSET_AT_RESET),
            Dialect::LinuxCnc | Dialect::Grbl => Some(54),
            Dialect::Fanuc | Dialect::Klartext => None,
        }
    }
}

/// What a virtual control has to know of its machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The language.
    pub dialect: Dialect,
    /// Which of the rotary axes A, B, C exist; a word for one that does not is an error.
    pub rotary: [bool; 3],
    /// Numbers of the M functions that the machine's builder has added (clamps, flaps, chip conveyor),
    /// none of which moves an axis or touches spindle and coolant. Any other M function that is not
    /// the control's own is an error.
    pub auxiliary: Vec<u32>,
    /// R parameters that the operator sets at the machine to shift the zero of a rotary axis
    /// (SINUMERIK). They count as 0; any other that no block has set is an error.
    pub operator_parameters: Vec<u32>,
    /// How far the control may be allowed to leave the path while it smooths it, mm.
    pub path_tolerance: f64,
}

impl Settings {
    /// A machine with these rotary axes that has nothing of its own.
    pub fn new(dialect: Dialect, rotary: [bool; 3]) -> Settings {
        let (auxiliary, operator_parameters) = (Vec::new(), Vec::new());
        Settings { dialect, rotary, auxiliary, operator_parameters, path_tolerance: 0.0 }
    }
}

/// Where the records of a running program go. An error stops the run.
pub type Sink<'a> = dyn FnMut(Record) -> Result<(), Box<Diagnostic>> + 'a;

/// Runs `text` on the virtual control of `settings` and hands each record to `sink`, in order. The
/// line of a record is the line of the program (from 1).
///
/// # Errors
/// The first block that is not understood, or not legal where it stands, with `file_name`, line and
/// column; or what `sink` answered.
pub fn read(
    settings: &Settings,
    file_name: &str,
    text: &[u8],
    sink: &mut Sink,
) -> Result<(), Box<Diagnostic>> {
    let run = match settings.dialect {
        Dialect::Fanuc | Dialect::LinuxCnc | Dialect::Grbl => iso::run,
        Dialect::Sinumerik => sinumerik::run,
        Dialect::Klartext => klartext::run,
    };
    run(settings, text, sink)
        .map_err(|d| if d.file.is_empty() { d.file(file_name).into() } else { d })
}
