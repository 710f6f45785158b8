//! Any bytes as ISO code, the dialect by the first byte: no panic, and what runs makes sense.
#![no_main]

use control::{Action, Dialect, Orientation, Settings, Setup, Wire, read};
use geom::Vec3;
use libfuzzer_sys::fuzz_target;
use program::{Diagnostic, Rule};

/// By the first byte: `0` is FANUC, `1` LinuxCNC and so on.
const DIALECTS: [Dialect; 10] = [
    Dialect::Fanuc,
    Dialect::LinuxCnc,
    Dialect::Grbl,
    Dialect::Haas,
    Dialect::Mach3,
    Dialect::Marlin,
    Dialect::FanucWire,
    Dialect::Sodick,
    Dialect::Agie,
    Dialect::Points,
];

/// After so many records a program is left: loops may go round for long.
const MOST_RECORDS: u32 = 10_000;

fuzz_target!(|data: &[u8]| {
    let Some((&first, text)) = data.split_first() else { return };
    let dialect = DIALECTS[usize::from(first.wrapping_sub(b'0')) % DIALECTS.len()];
    let wire = Wire { height: (first > 127).then_some(40.0), thread: Some(60), cut: Some(50) };
    for (rotary, start) in [([false; 3], None), ([true, false, true], Some(Vec3::ZERO))] {
        let setup = Setup { start, ..Setup::default() };
        let auxiliary = vec![26];
        let settings = Settings { auxiliary, wire, setup, ..Settings::new(dialect, rotary) };
        let lines = text.split(|&byte| byte == b'\n').count();
        let mut records = 0;
        let mut ended = false;
        let ran = read(&settings, "fuzz.nc", text, &mut |event| {
            assert!(!ended || matches!(event.action, Action::Comment(_) | Action::Message(_)));
            assert!(event.line > 0 && event.line as usize <= lines);
            records += 1;
            if records > MOST_RECORDS {
                return Err(Diagnostic::error(Rule::Stopped, "a loop that moves")
                    .at(1, b" ", 0, 1)
                    .into());
            }
            ended |= event.action == Action::End;
            match &event.action {
                Action::Arc(arc) => {
                    assert!(arc.end.point.is_finite() && arc.center.is_finite());
                    assert!((arc.normal.length() - 1.0).abs() < 1e-9);
                }
                Action::Cycle(cycle) => {
                    assert!(cycle.depth > 0.0 && cycle.clearance >= 0.0 && cycle.retract >= 0.0);
                    assert!(cycle.peck.is_none_or(|peck| peck > 0.0) && cycle.dwell >= 0.0);
                }
                Action::Hole(pose) => assert!(pose.point.is_finite()),
                _ => {}
            }
            if let Some(Orientation::Axis(axis)) =
                event.action.position().map(|position| position.orientation)
            {
                assert!((axis.length() - 1.0).abs() < 1e-9);
            }
            Ok(())
        });
        if let Err(error) = ran {
            assert!(error.line > 0 && error.column > 0 && error.is_error());
        }
    }
});
