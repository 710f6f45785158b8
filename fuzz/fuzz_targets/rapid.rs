//! Any bytes as a RAPID program: no panic, and what runs makes sense.
#![no_main]

use control::{Action, ArmAction, ArmPath, Dialect, Settings, read};
use libfuzzer_sys::fuzz_target;
use program::{Diagnostic, Rule};

fuzz_target!(|data: &[u8]| {
    let mut settings = Settings::new(Dialect::Rapid, [false; 3]);
    settings.tool_change = String::from("ChangeTool");
    settings.signals = [String::from("DO10_"), String::from("AO10_")];
    let lines = data.split(|byte| *byte == b'\n').count();
    let (mut ended, mut records) = (false, 0);
    let ran = read(&settings, "fuzz.mod", data, &mut |event| {
        assert!(!ended && event.line > 0 && event.line as usize <= lines);
        ended = event.action == Action::End;
        records += 1;
        if records > 50_000 {
            return Err(Diagnostic::error(Rule::Stopped, "").at(1, b"", 0, 0).into());
        }
        if let Action::Arm(ArmAction::Move(motion)) = &event.action {
            match motion.path {
                ArmPath::Joints(joints) => assert!(joints.iter().all(|joint| joint.is_finite())),
                ArmPath::Point(end) | ArmPath::Line(end) => assert!(end.is_finite()),
                ArmPath::Arc { via, end } => assert!(via.is_finite() && end.is_finite()),
            }
        }
        Ok(())
    });
    match ran {
        Ok(()) => assert!(ended),
        Err(error) => assert!(error.line > 0 && error.is_error()),
    }
});
