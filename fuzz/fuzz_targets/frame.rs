//! Any bytes as a frame of the studio: no panic, no more memory than the frame has, and what is read is written as the same frame again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use studio::message::{Values, read, write};

fuzz_target!(|data: &[u8]| {
    let Ok(frame) = read(data) else { return };
    let held: usize = frame
        .arrays
        .iter()
        .map(|array| match &array.values {
            Values::U8(values) => values.len(),
            Values::U32(values) => 4 * values.len(),
            Values::F32(values) => 4 * values.len(),
            Values::F64(values) => 8 * values.len(),
        })
        .sum();
    assert!(held <= data.len(), "more than the frame has");
    let written = write(&frame.head, &frame.arrays);
    let again = read(&written).expect("what is written is read");
    // Bit by bit: a NaN is not equal to itself.
    assert_eq!(write(&(), &again.arrays), write(&(), &frame.arrays));
});
