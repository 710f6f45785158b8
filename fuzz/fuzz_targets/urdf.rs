//! Any bytes as a URDF: no panic, and what comes out is an arm.
#![no_main]

use import::import_urdf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| match import_urdf("fuzz.urdf", data, None) {
    Ok(import) => {
        let machine = machine::load_text("fuzz.toml", &import.text).expect("it loads");
        assert!(machine.arm.is_some());
    }
    Err(errors) => assert!(errors.iter().any(|error| error.is_error() && !error.help.is_empty())),
});
