//! Any bytes as a program of a glass engraver, in the form that the first byte chooses: no panic, and a program that is not the one of
//! its point is refused.
#![no_main]

use glass::control::read;
use glass::machine::{Machine, library};
use glass::proof::{Task, prove};
use libfuzzer_sys::fuzz_target;

const FORMS: [&str; 5] = [
    "numbered",
    "points",
    "gcode\"\nfire = \"M101 P0",
    "binary",
    // With the words after it in place of a comment: pulses in motion.
    "numbered\"\nruns = true #\"",
];

fuzz_target!(|data: &[u8]| {
    let Some((first, text)) = data.split_first() else { return };
    let form = FORMS[usize::from(*first) % FORMS.len()];
    let machine = library("glass-xyz-100hz").expect("it is there").replacen(
        "numbered\"",
        &format!("{form}\""),
        1,
    );
    let machine = Machine::read(&machine, "fuzz.toml").expect("it is one");
    let lens = machine.lens(70.0).expect("it has one");
    let task = Task {
        cloud: &[[10_000, 10_000, 15_000]],
        machine: &machine,
        lens,
        index: 1.5195,
        block: [20.0, 20.0, 30.0],
        blocks: 1,
        spacing: 0.13,
        accept_shadowed: false,
    };
    let proven = read(text, &machine).and_then(|run| Ok((run.pulses.len(), prove(&run, &task)?)));
    match proven {
        Ok((pulses, (proof, found))) => {
            let passes = !found.iter().any(program::Diagnostic::is_error);
            assert!(!passes || (pulses == 1 && proof.pulses == 1));
        }
        Err(found) => assert!(found.iter().any(|found| found.is_error() && !found.help.is_empty())),
    }
});
