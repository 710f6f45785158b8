//! Any bytes as a board of KiCad's: no panic, and what comes out is a board.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcb::kicad::read;

fuzz_target!(|data: &[u8]| {
    let lines = data.split(|byte| *byte == b'\n').count();
    match read("fuzz.kicad_pcb", data) {
        Ok(reading) => {
            assert!(reading.warnings.iter().all(|warning| !warning.is_error()));
            assert!(reading.board.holes.iter().all(|hole| hole.diameter > 0.0));
            for side in [&reading.board.front, &reading.board.back] {
                let Some(copper) = &side.copper else { continue };
                assert_eq!(copper.region.islands().len(), copper.nets.len());
                for ring in copper.region.rings() {
                    let next = ring.elements().iter().cycle().skip(1);
                    for (element, next) in ring.elements().iter().zip(next) {
                        assert!(element.start.is_finite() && element.end == next.start);
                    }
                }
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            for error in &errors {
                assert!(error.is_error() && error.file == "fuzz.kicad_pcb");
                assert!(error.line as usize <= lines && !error.to_string().is_empty());
            }
        }
    }
});
