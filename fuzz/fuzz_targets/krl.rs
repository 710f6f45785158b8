//! Any bytes as a KRL program: no panic, and what runs makes sense.
#![no_main]

#[path = "../robot.rs"]
mod robot;

use control::{Dialect, Settings};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut settings = Settings::new(Dialect::Krl, [false; 3]);
    settings.tool_change = String::from("TOOL_CHANGE");
    robot::run(&settings, "fuzz.src", data);
});
