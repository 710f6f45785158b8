//! Any bytes as ISO code, the flavour by the first byte: no panic, and what runs makes sense.
#![no_main]

use control::{Dialect, Settings, Wire, read};
use libfuzzer_sys::fuzz_target;
use program::{Op, Orientation};

fuzz_target!(|data: &[u8]| {
    let Some((&first, text)) = data.split_first() else { return };
    let dialects = [
        Dialect::Fanuc,
        Dialect::LinuxCnc,
        Dialect::Grbl,
        Dialect::FanucWire,
        Dialect::Sodick,
        Dialect::Agie,
        Dialect::Points,
    ];
    let dialect = dialects[usize::from(first) % dialects.len()];
    let wire = Wire { height: (first > 127).then_some(40.0), thread: Some(60), cut: Some(50) };
    for rotary in [[false; 3], [true, false, true]] {
        let settings = Settings { auxiliary: vec![26], wire, ..Settings::new(dialect, rotary) };
        let lines = text.split(|&byte| byte == b'\n').count();
        let mut line = 0;
        let mut ended = false;
        let ran = read(&settings, "fuzz.nc", text, &mut |record| {
            assert!(!ended || matches!(record.op, Op::Comment(_) | Op::Message(_)));
            assert!(record.line >= line && record.line as usize <= lines);
            line = record.line;
            ended |= record.op == Op::End;
            match &record.op {
                Op::Arc(arc) => {
                    assert!(arc.end.point.is_finite() && arc.center.is_finite());
                    assert!((arc.normal.length() - 1.0).abs() < 1e-9);
                }
                Op::Cycle(cycle) => {
                    assert!(cycle.depth > 0.0 && cycle.clearance >= 0.0 && cycle.retract >= 0.0);
                    assert!(cycle.peck.is_none_or(|peck| peck > 0.0) && cycle.dwell >= 0.0);
                }
                Op::Hole(pose) => assert!(pose.point.is_finite()),
                _ => {}
            }
            if let Some(Orientation::Axis(axis)) = record.op.pose().map(|pose| pose.orientation) {
                assert!((axis.length() - 1.0).abs() < 1e-9);
            }
            Ok(())
        });
        if let Err(error) = ran {
            assert!(error.line > 0 && error.column > 0 && error.is_error());
        }
    }
});
