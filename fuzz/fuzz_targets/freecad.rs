//! Any bytes as a job of FreeCAD's: no panic, and what is read is whole.
#![no_main]

use freecad::{Job, read};
use libfuzzer_sys::fuzz_target;
use machine::Machine;
use program::{Op, Purpose};
use std::sync::LazyLock;

static MILL: LazyLock<Machine> =
    LazyLock::new(|| machine::load("sinumerik-840d-table-ac").unwrap());

fuzz_target!(|data: &[u8]| {
    let job = match Job::of("fuzz.json", data) {
        Ok(job) => job,
        Err(found) => {
            assert!(found.is_error() && found.file == "fuzz.json");
            return;
        }
    };
    match read(&MILL, "fuzz.json", job, Purpose::Program) {
        Ok(reading) => {
            let records = &reading.program.records;
            assert!(
                records
                    .iter()
                    .any(|record| record.op.pose().is_some() || matches!(record.op, Op::Probe(_)))
            );
            for pose in records.iter().filter_map(|record| record.op.pose()) {
                assert!(pose.point().is_finite());
            }
            let begun = records.iter().filter(|record| matches!(record.op, Op::Operation(_)));
            let ended = records.iter().filter(|record| record.op == Op::EndOfOperation);
            assert_eq!(begun.count(), ended.count());
        }
        Err(found) => assert!(found.is_error() && found.file.starts_with("fuzz.json")),
    }
});
