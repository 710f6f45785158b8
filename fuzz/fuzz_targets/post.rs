//! Any bytes as a toolpath, for a mill of the library by the first byte: a program that is proven, or
//! findings.
#![no_main]

use libfuzzer_sys::fuzz_target;
use machine::Machine;
use machine::library::{MACHINES, names};
use program::Program;
use proof::Tolerances;
use std::sync::LazyLock;

/// `0` is the first.
static MILLS: LazyLock<Vec<Machine>> = LazyLock::new(|| {
    let all = names(MACHINES).map(|name| machine::load(name).expect("the library loads"));
    all.filter(|machine| machine.wire.is_none()).collect()
});

/// How far from zero a part may be for its program to be proven, mm: numbers have their decimals there.
const PART: f64 = 2000.0;

fn is_near(program: &Program) -> bool {
    let mut poses = program.records.iter().filter_map(|record| record.op.pose());
    poses.all(|pose| pose.point().abs().max_element() < PART)
}

fuzz_target!(|data: &[u8]| {
    let Some((&first, text)) = data.split_first() else { return };
    let machine = &MILLS[usize::from(first.wrapping_sub(b'0')) % MILLS.len()];
    let Ok(reading) = source::apt::read("fuzz.cls", text, &Default::default()) else { return };
    match post::write(&reading.program, machine) {
        Ok(output) => {
            assert!(output.warnings.iter().all(|warning| !warning.is_error()));
            let proven = |text: &[u8]| {
                proof::prove(&reading.program, machine, "fuzz.nc", text, &Tolerances::default())
            };
            let report = proven(&output.text);
            if is_near(&reading.program) {
                let found = report.mismatches.first();
                assert!(
                    found.is_none(),
                    "{}: {found:?}\n{}",
                    machine.name,
                    String::from_utf8_lossy(&output.text)
                );
            }
            // A program that is cut off is compared with the same toolpath: no panic.
            let _ = proven(&output.text[..output.text.len() / 2]);
        }
        Err(findings) => {
            assert!(!findings.is_empty());
            for found in &findings {
                assert!(found.is_error() && !found.to_string().is_empty(), "{found:?}");
            }
        }
    }
});
