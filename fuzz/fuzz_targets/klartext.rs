//! Any bytes as a Klartext program: no panic, and what runs makes sense.
#![no_main]

use control::{Action, Dialect, Orientation, Settings, read};
use libfuzzer_sys::fuzz_target;
use program::{Diagnostic, Rule};

fuzz_target!(|data: &[u8]| {
    for rotary in [[false; 3], [false, true, true]] {
        let settings = Settings { auxiliary: vec![60], ..Settings::new(Dialect::Klartext, rotary) };
        let lines = data.split(|byte| matches!(byte, b'\n' | b'\r')).count();
        let (mut ended, mut records) = (false, 0);
        let ran = read(&settings, "fuzz.h", data, &mut |event| {
            assert!(!ended && event.line > 0 && event.line as usize <= lines);
            ended = event.action == Action::End;
            records += 1;
            // A loop may make as many as it likes.
            if records > 50_000 {
                return Err(Diagnostic::error(Rule::Stopped, "").at(1, b"", 0, 0).into());
            }
            if let Action::Arc(arc) = &event.action {
                assert!(arc.end.point.is_finite() && arc.center.is_finite());
                assert!((arc.normal.length() - 1.0).abs() < 1e-9);
            }
            if let Some(Orientation::Axis(axis)) =
                event.action.position().map(|position| position.orientation)
            {
                assert!(axis.is_nan() || (axis.length() - 1.0).abs() < 1e-9);
            }
            Ok(())
        });
        match ran {
            Ok(()) => assert!(ended),
            Err(error) => assert!(error.line > 0 && error.column > 0 && error.is_error()),
        }
    }
});
