//! Loops that move and do not end are refused after a bounded run: all languages count their jumps in one budget.

use geom::Vec3;
use toolpost_control::{Dialect, Settings, Setup, StartModes, read};

#[test]
fn an_endless_loop_that_moves_is_refused_after_two_million_jumps_and_calls() {
    for (dialect, rule, text) in [
        (Dialect::Fanuc, "endless", "G21\nG0 X0. Y0. Z0.\nG91\nN10 X1.\nGOTO 10\nM30\n"),
        (Dialect::Sinumerik, "endless", "G0 X0 Y0 Z0\nR1=0\nLOOP\nX=R1\nR1=R1+1\nENDLOOP\nM30\n"),
    ] {
        let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
        let settings =
            Settings { setup, start_modes: StartModes::SURE, ..Settings::new(dialect, [false; 3]) };
        let mut moves = 0u32;
        let end = read(&settings, "p.nc", text.as_bytes(), &mut |event| {
            moves += u32::from(event.action.position().is_some());
            Ok(())
        });
        let error = end.expect_err(text);
        assert_eq!(error.rule, rule, "{error}");
        assert!((100_000..=2_000_001).contains(&moves), "{moves} moves before\n{error}");
    }
}

#[test]
fn a_loop_of_half_a_million_moves_is_followed() {
    let text = "G21\nG0 X0. Y0. Z0.\n#1=0\nWHILE [#1 LT 500000] DO1\nX#1\n#1=#1+1\nEND1\nM30\n";
    let start_modes = StartModes::SURE;
    let settings = Settings { start_modes, ..Settings::new(Dialect::Fanuc, [false; 3]) };
    let events = crate::common::records(&settings, "p.nc", text);
    assert_eq!(events.unwrap().len(), 500_002);
}
