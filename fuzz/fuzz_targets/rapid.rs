//! Any bytes as a RAPID program: no panic, and what runs makes sense.
#![no_main]

#[path = "../robot.rs"]
mod robot;

use control::{Dialect, Settings};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut settings = Settings::new(Dialect::Rapid, [false; 3]);
    settings.tool_change = String::from("ChangeTool");
    settings.signals = [String::from("DO10_"), String::from("AO10_")];
    robot::run(&settings, "fuzz.mod", data);
});
