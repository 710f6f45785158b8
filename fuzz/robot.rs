//! Any bytes as a program of a robot: no panic, and what runs makes sense.

use control::{Action, ArmAction, ArmPath, Settings, read};
use program::{Diagnostic, Rule};

pub fn run(settings: &Settings, file_name: &str, data: &[u8]) {
    let lines = data.split(|byte| *byte == b'\n').count();
    let (mut ended, mut records) = (false, 0);
    let ran = read(settings, file_name, data, &mut |event| {
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
}
