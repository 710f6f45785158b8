//! Any bytes as a SINUMERIK program: no panic, and what runs makes sense.
#![no_main]

use control::{Action, Dialect, Orientation, Settings, read};
use libfuzzer_sys::fuzz_target;
use program::{Diagnostic, Rule};

/// After so many records a program is left: loops may go round for long.
const MOST_RECORDS: u32 = 10_000;

fuzz_target!(|data: &[u8]| {
    for rotary in [[false; 3], [true, false, true]] {
        let settings = Settings {
            auxiliary: vec![26, 60],
            operator_parameters: vec![24],
            path_tolerance: 0.1,
            ..Settings::new(Dialect::Sinumerik, rotary)
        };
        let lines = data.split(|byte| *byte == b'\n').count();
        let (mut ended, mut records) = (false, 0);
        let ran = read(&settings, "fuzz.mpf", data, &mut |event| {
            assert!(!ended && event.line as usize <= lines);
            ended = event.action == Action::End;
            records += 1;
            if records > MOST_RECORDS {
                return Err(Diagnostic::error(Rule::Stopped, "a loop that moves")
                    .line(event.line)
                    .into());
            }
            if let Action::Arc(arc) = &event.action {
                assert!(arc.end.point.is_finite() && arc.center.is_finite());
                assert!((arc.normal.length() - 1.0).abs() < 1e-9);
            }
            if let Action::Cycle(cycle) = &event.action {
                assert!(cycle.depth > 0.0 && cycle.clearance >= 0.0 && cycle.retract >= 0.0);
            }
            if let Some(Orientation::Axis(axis)) =
                event.action.position().map(|position| position.orientation)
            {
                assert!((axis.length() - 1.0).abs() < 1e-9);
            }
            Ok(())
        });
        match ran {
            Ok(()) => assert!(ended),
            Err(error) => assert!(error.is_error() && error.line as usize <= lines),
        }
    }
});
