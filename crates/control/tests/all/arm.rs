//! What the tests of languages of robots have in common.

use toolpost_control::{Action, ArmAction, ArmMove, Event, Settings, read};

/// The events of a file, or the finding that ends it.
pub fn run(settings: &Settings, file_name: &str, text: &str) -> Result<Vec<Event>, String> {
    let mut events = Vec::new();
    let taken = read(settings, file_name, text.as_bytes(), &mut |event| {
        events.push(event);
        Ok(())
    });
    taken.map(|()| events).map_err(|found| found.to_string())
}

/// The motions, each with its line.
pub fn moves(events: &[Event]) -> Vec<(u32, ArmMove)> {
    let of = |event: &Event| match &event.action {
        Action::Arm(ArmAction::Move(motion)) => Some((event.line, **motion)),
        _ => None,
    };
    events.iter().filter_map(of).collect()
}
