//! The Python package of Toolpost: what `toolpost` in Python is made of.
//!
//! Nothing is decided here: each class holds a value of the crates, each function hands its arguments
//! to the one of the same name there. What takes long runs without the interpreter's lock, and what
//! goes wrong becomes a `toolpost.Error`.

mod arguments;
mod board;
mod builder;
mod columns;
mod error;
mod kinematics;
mod machine;
mod pcb;
mod posting;
mod program;
mod record;
mod wire;

use pyo3::prelude::*;

/// The compiled part of Toolpost; `toolpost` is what to import.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{
        board::{Board, BoardBuilder},
        builder::Builder,
        machine::{Machine, library, machine},
        pcb::{pcb, save_in},
        posting::{post, prove, run_command, save},
        program::{Program, read, read_job},
        record::Record,
        wire::wire,
    };

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::error::catch_panics();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
