//! Any bytes as a drill file: no panic, and what comes out are holes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcb::HoleShape;
use pcb::excellon::read;

fuzz_target!(|data: &[u8]| {
    match read("fuzz.drl", data) {
        Ok(reading) => {
            let drill = &reading.drill;
            for cut in drill.cuts.iter().take(10_000) {
                assert!(drill.tools[cut.tool as usize].diameter > 0.0);
                let whole = match &cut.path {
                    HoleShape::Round(at) => at.is_finite(),
                    HoleShape::Slot(from, to) => from.is_finite() && to.is_finite(),
                    HoleShape::Route(elements) => {
                        elements.windows(2).all(|pair| pair[0].end == pair[1].start)
                    }
                };
                assert!(whole);
                assert!(drill.pieces(cut).iter().all(|piece| !piece.contours.is_empty()));
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty() && errors.len() <= 20);
            assert!(errors.iter().all(|error| error.is_error() && !error.to_string().is_empty()));
        }
    }
});
