//! Any bytes as a picture for glass: no panic, no picture beyond the limit, and what is refused says where to go.
#![no_main]

use glass::picture::{Manner, Plane, Setting, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let setting = Setting {
        plane: Plane::Xz,
        width: None,
        manner: Manner::Dither,
        invert: false,
        sheets: (1, None),
    };
    if let Err(found) = read(data, setting, "fuzz.png") {
        assert!(found.is_error() && !found.help.is_empty());
    }
});
