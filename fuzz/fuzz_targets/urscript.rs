//! Any bytes as a URScript program: no panic, and what runs makes sense.
#![no_main]

#[path = "../robot.rs"]
mod robot;

use control::{Dialect, Settings};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut settings = Settings::new(Dialect::UrScript, [false; 3]);
    settings.tool_change = String::from("change_tool");
    robot::run(&settings, "fuzz.script", data);
});
