//! Any bytes as a millproject of pcb2gcode: no panic, each option once, and an error names its line.
#![no_main]

use import::import_millproject;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    match import_millproject(&String::from_utf8_lossy(data)) {
        Ok((stated, _)) => {
            let mut names: Vec<&str> = stated.iter().map(|option| option.name.as_str()).collect();
            names.sort_unstable();
            let all = names.len();
            names.dedup();
            assert_eq!(names.len(), all, "an option twice");
        }
        Err(error) => assert!(error.is_error() && error.line > 0),
    }
});
