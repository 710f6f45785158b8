//! Any bytes as a listing of a FANUC robot: no panic, and what runs makes sense.
#![no_main]

#[path = "../robot.rs"]
mod robot;

use control::{Dialect, Settings};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut settings = Settings::new(Dialect::Ls, [false; 3]);
    settings.tool_change = String::from("CHANGE");
    robot::run(&settings, "FUZZ.LS", data);
});
