//! Any bytes as a Gerber file: no panic, and what comes out is a picture.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcb::gerber::read;

fuzz_target!(|data: &[u8]| {
    let lines = data.split(|byte| *byte == b'\n').count();
    match read("fuzz.gbr", data) {
        Ok(reading) => {
            // Repeats may make millions of them.
            for object in reading.image.objects.iter().take(10_000) {
                assert!(object.line > 0 && object.line as usize <= lines);
                for piece in reading.image.pieces(object) {
                    for elements in piece.contours.iter().map(|contour| contour.elements()) {
                        assert!(!elements.is_empty());
                        let next = elements.iter().cycle().skip(1);
                        for (element, next) in elements.iter().zip(next) {
                            assert!(element.start.is_finite() && element.end == next.start);
                        }
                    }
                }
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty() && errors.len() <= 20);
            assert!(errors.iter().all(|error| error.is_error() && !error.to_string().is_empty()));
        }
    }
});
