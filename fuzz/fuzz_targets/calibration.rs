//! Any bytes as a calibration of Universal Robots: no panic, and what comes out is an arm.
#![no_main]

use import::import_calibration;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| match import_calibration("fuzz.yaml", data, Some("ur5e")) {
    Ok(import) => {
        let machine = machine::load_text("fuzz.toml", &import.text).expect("it loads");
        assert!(machine.arm.is_some());
    }
    Err(errors) => assert!(errors.iter().any(|error| error.is_error() && !error.help.is_empty())),
});
