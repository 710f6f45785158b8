//! Any bytes as cutter-location data: no panic, and what comes out is whole.
#![no_main]

use libfuzzer_sys::fuzz_target;
use source::apt::{Options, read};

fuzz_target!(|data: &[u8]| {
    let lenient = read("fuzz.cls", data, &Options { strict: false, ..Options::default() });
    match &lenient {
        Ok(reading) => {
            for pose in reading.program.records.iter().filter_map(|record| record.op.pose()) {
                let axis = pose.axis();
                assert!(pose.point().is_finite());
                assert!((axis.length() - 1.0).abs() < 1e-6);
            }
        }
        Err(errors) => {
            assert!(!errors.is_empty() && errors.len() <= 20);
            assert!(errors.iter().all(|error| error.is_error() && !error.to_string().is_empty()));
        }
    }
    // Strict reading is lenient reading without warnings.
    let strict = read("fuzz.cls", data, &Options { strict: true, ..Options::default() });
    assert_eq!(strict.is_ok(), lenient.is_ok_and(|reading| reading.warnings.is_empty()));
});
