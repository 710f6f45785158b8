//! Outputs, inputs and functions of the machine's builder: what each control reports of them, and when.

use program::{Auxiliary, Input, Output, OutputValue, Until};
use toolpost_control::{Action, Dialect, Settings, read};

/// What the control does in addition to its motions, which are counted instead; or the rule by which it refuses.
fn signals(dialect: Dialect, text: &str) -> Result<Vec<(usize, Action)>, &'static str> {
    let settings = Settings { auxiliary: vec![21, 22, 101], ..Settings::new(dialect, [false; 3]) };
    let (mut moves, mut found) = (0, Vec::new());
    let read = read(&settings, "p", text.as_bytes(), &mut |event| {
        match event.action {
            Action::Rapid(_) | Action::Line(_) | Action::Arc(_) | Action::Hole(_) => moves += 1,
            action @ (Action::Output(_) | Action::Input(_) | Action::Auxiliary(_)) => {
                found.push((moves, action));
            }
            _ => {}
        }
        Ok(())
    });
    read.map(|()| found).map_err(|found| found.rule.name())
}

fn linuxcnc(blocks: &str) -> Result<Vec<Action>, &'static str> {
    let found = signals(Dialect::LinuxCnc, &format!("G21 G90\n{blocks}\nM2\n"))?;
    Ok(found.into_iter().map(|(_, action)| action).collect())
}

/// LinuxCNC, "M Codes": M62 and M63 switch with the next motion, M64 and M65 at once, M67 and M68 the same for an
/// analog output; M66 waits as L says, for Q seconds at the most.
#[test]
fn linuxcnc_switches_outputs_and_waits_for_inputs() {
    let digital = |number, on, with_motion| {
        Action::Output(Output { number, value: OutputValue::Digital(on), with_motion })
    };
    let analog = |number, value, with_motion| {
        Action::Output(Output { number, value: OutputValue::Analog(value), with_motion })
    };
    let input = |number, until, timeout| Action::Input(Box::new(Input { number, until, timeout }));
    let outputs = [digital(1, true, true), digital(2, false, true)];
    assert_eq!(linuxcnc("M62 P1\nM63 P2").unwrap(), outputs);
    let outputs = [digital(3, true, false), digital(0, false, false)];
    assert_eq!(linuxcnc("M64 P3\nM65 P0").unwrap(), outputs);
    let outputs = [analog(1, 2.5, true), analog(0, -1.0, false)];
    assert_eq!(linuxcnc("M67 E1 Q2.5\nM68 E0 Q-1").unwrap(), outputs);
    // The number of a word may be worked out.
    assert_eq!(linuxcnc("#1=60\nM[#1+4] P[1+2]").unwrap(), [digital(3, true, false)]);
    let waits = [
        input(2, Until::Rise, 5.0),
        input(2, Until::Fall, 0.5),
        input(2, Until::High, 5.0),
        input(2, Until::Low, 5.0),
    ];
    let text = "M66 P2 L1 Q5\nM66 P2 L2 Q0.5\nM66 P2 L3 Q5\nM66 P2 L4 Q5";
    assert_eq!(linuxcnc(text).unwrap(), waits);
    let reads = [input(2, Until::Read, 0.0), input(1, Until::ReadAnalog, 0.0)];
    assert_eq!(linuxcnc("M66 P2\nM66 E1 L0").unwrap(), reads);
}

#[test]
fn linuxcnc_refuses_what_its_words_leave_open() {
    for blocks in ["M62", "M64 P1.5", "M64 P-1", "M67 E1", "M68 Q1"] {
        assert!(matches!(linuxcnc(blocks), Err("output" | "number")), "{blocks}");
    }
    for blocks in ["M66", "M66 P1 E1", "M66 P1 L3", "M66 P1 L3 Q0", "M66 P1 L5 Q1", "M66 E1 L3 Q1"]
    {
        assert_eq!(linuxcnc(blocks), Err("input"), "{blocks}");
    }
}

/// "M100-M199, User Defined Commands": P and Q are handed to the program. Others of the builder stand alone.
#[test]
fn functions_of_the_builder_stand_between_the_motions_where_they_are_called() {
    let function = |number, values| Action::Auxiliary(Auxiliary { number, values });
    let none = [None; 2];
    let text = "G21 G90 G0 X0 Y0 Z5\nM101 P2 Q-3.5\nG1 X1 F100\nM101\nM2\n";
    let own = [(1, function(101, [Some(2.0), Some(-3.5)])), (2, function(101, none))];
    assert_eq!(signals(Dialect::LinuxCnc, text).unwrap(), own);

    let two = [(1, function(21, none)), (2, function(22, none))];
    let text = "G21 G90 G94 G17 G0 X0. Y0. Z5.\nM21\nG1 X1. F100.\nM22\nM30\n";
    assert_eq!(signals(Dialect::Fanuc, text).unwrap(), two);
    let text = "G17 G90 G94 G54 G0 X0 Y0 Z5\nM21\nG1 X1 F100\nM22\nM30\n";
    assert_eq!(signals(Dialect::Sinumerik, text).unwrap(), two);
    let text = "0 BEGIN PGM P MM\n1 L X+0 Y+0 Z+5 FMAX\n2 M21\n3 L X+1 F100\n4 M22\n5 M30\n6 END PGM P MM\n";
    assert_eq!(signals(Dialect::Klartext, text).unwrap(), two);
    // In a block with a motion it comes before that; M functions come out before the axes move (H2).
    let after = [(1, function(21, none))];
    let text = "G17 G90 G94 G54 G0 X0 Y0 Z5\nG1 X1 F100 M21\nM30\n";
    assert_eq!(signals(Dialect::Sinumerik, text).unwrap(), after);
}
