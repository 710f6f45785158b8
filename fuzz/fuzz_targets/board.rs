//! Any bytes as a board by hand: no panic, and what comes out is a board.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcb::model::read;

fuzz_target!(|data: &[u8]| match read("fuzz.toml", data) {
    Ok(reading) => {
        let (low, high) = reading.board.extents().expect("something is on the board");
        assert!(low.is_finite() && high.is_finite() && low.cmple(high).all());
        assert!(reading.warnings.iter().all(|found| !found.is_error()));
        for side in [&reading.board.front, &reading.board.back] {
            if let Some(copper) = &side.copper {
                assert_eq!(copper.nets.len(), copper.region.islands().len());
            }
        }
    }
    Err(errors) => {
        assert!(!errors.is_empty());
        assert!(errors.iter().all(|error| error.is_error() && !error.to_string().is_empty()));
    }
});
