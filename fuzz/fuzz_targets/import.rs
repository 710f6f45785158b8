//! Any bytes as a post of another system: no panic, and what comes out is a machine.
#![no_main]

use import::import;
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|data: &[u8]| {
    for file in ["fuzz.pp", "fuzz.txt"] {
        match import(file, data, Some("grbl"), Path::new("")) {
            Ok(import) => drop(machine::load_text("fuzz.toml", &import.text).expect("it loads")),
            Err(errors) => assert!(errors.iter().any(|error| error.is_error())),
        }
    }
});
