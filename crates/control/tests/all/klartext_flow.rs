//! Labels, calls and Q parameters of the Klartext control, against the manuals' rules and sums done by
//! hand.

use crate::common::klartext::*;
use program::{Diagnostic, Feed};
use toolpost_control::Action;

/// Where the rapids of these blocks go in X.
fn xs(blocks: &str) -> Vec<f64> {
    points(&run(&format!("{START}{blocks}")))[1..].iter().map(|point| point[0]).collect()
}

/// The value of a formula.
fn value(formula: &str) -> Result<f64, Box<Diagnostic>> {
    let blocks = format!("Q5 = 0.75\nQL7 = -4\nQ1 = {formula}\nL X+Q1 FMAX");
    let records = run_on([false; 3], "MM", &blocks)?;
    Ok(records[0].action.position().unwrap().point.x)
}

#[test]
fn a_subprogram_runs_where_it_is_called_and_returns() {
    // The order of the manual's example of a subprogram within a subprogram.
    let blocks = "CALL LBL \"UP1\"
L X+2 FMAX
L X+9 FMAX M2
LBL \"UP1\"
L X+10 FMAX
CALL LBL 2
L X+11 FMAX
LBL 0
LBL 2
L X+20 FMAX
LBL 0";
    assert_eq!(xs(blocks), [10.0, 20.0, 11.0, 2.0, 9.0]);
}

#[test]
fn a_subprogram_that_the_program_runs_into_is_run_once() {
    assert_eq!(xs("LBL 1\nL IX+1 FMAX\nLBL 0\nCALL LBL 1"), [1.0, 2.0]);
}

#[test]
fn a_part_is_repeated_so_often_more_and_inner_parts_begin_anew() {
    // Twice three, and one behind them.
    let blocks = "LBL 15\nLBL 20\nL IX+1 FMAX\nCALL LBL 20 REP 2\nCALL LBL 15 REP 1\nL X+0 FMAX";
    assert_eq!(xs(blocks), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0]);
    // As older controls show it, and with a number from a parameter.
    assert_eq!(xs("LBL 1\nL IX+1 FMAX\nCALL LBL 1 REP 2/2"), [1.0, 2.0, 3.0]);
    assert_eq!(xs("Q1 = 1\nLBL 1\nL IX+1 FMAX\nCALL LBL 1 REP Q1"), [1.0, 2.0]);
    // In a subprogram, at each call.
    let blocks = "CALL LBL 1\nCALL LBL 1\nM30\nLBL 1\nLBL 2\nL IX+1 FMAX\nCALL LBL 2 REP 1\nLBL 0";
    assert_eq!(xs(blocks), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn a_repetition_that_a_jump_has_left_is_not_taken_up_again() {
    let once =
        "LBL 1\nL IX+1 FMAX\nQ1 = Q1 + 1\nFN 9: IF +Q1 EQU +2 GOTO LBL 9\nCALL LBL 1 REP 5\nLBL 9";
    assert_eq!(xs(&format!("Q1 = 0\n{once}")), [1.0, 2.0]);
    let again = format!("Q1 = 0\n{once}\nFN 12: IF +Q1 LT +3 GOTO LBL 1");
    let error = refused(&format!("{START}{again}"));
    assert_eq!(error.rule.name(), "label");
    assert!(error.message.contains("4 still to go"), "{error}");
}

#[test]
fn a_loop_ends_by_its_condition() {
    for (condition, last) in [
        ("FN 12: IF +Q1 LT +4", 4.0),
        ("FN 10: IF Q1 NE 5", 5.0),
        ("FN 11: IF +3 GT +Q1", 3.0),
        ("FN 9: IF +Q1 EQU -Q2", 2.0),
    ] {
        let blocks = format!(
            "Q1 = 0\nFN 0: Q2 = -1\nLBL 1\nQ1 = Q1 + 1\nL X+Q1 FMAX\n{condition} GOTO LBL 1"
        );
        assert_eq!(xs(&blocks).last(), Some(&last), "{condition}");
    }
}

#[test]
fn labels_have_one_place_and_names_may_come_from_a_text() {
    assert_eq!(xs("QS1 = \"A\" || \"B\"\nCALL LBL QS1\nM30\nLBL \"AB\"\nL X+3 FMAX\nLBL 0"), [3.0]);
    assert_eq!(xs("Q1 = 7\nCALL LBL Q1\nM30\nLBL 7\nL X+3 FMAX\nLBL 0"), [3.0]);
    for (blocks, message) in [
        ("LBL 1\nLBL 1", "twice"),
        ("M30\nLBL 1\nLBL 0\nLBL 1", "twice"),
        ("CALL LBL 5", "no label 5"),
        ("CALL LBL 1\nLBL 1", "LBL 0 is missing"),
        ("CALL LBL 1 REP 3\nLBL 1", "before its call"),
        ("LBL 1\nCALL LBL 1 REP 2.5", "whole number"),
        ("LBL 1\nCALL LBL 1 REP 0", "whole number"),
        ("LBL 1\nCALL LBL 1", "nested more than 19"),
        ("FN 9: IF +1 EQU +1 GOTO LBL 3", "no label 3"),
        ("M30\nL X+1 FMAX\nLBL 1", "never runs"),
    ] {
        let error = refused(&format!("{START}{blocks}"));
        assert!(error.message.contains(message), "{blocks}: {error}");
    }
}

#[test]
fn a_program_that_never_ends_is_refused() {
    let error = refused("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1");
    assert_eq!((error.rule.name(), error.line), ("endless", 3));
    // What is only said is nothing, and a long way round takes as long as many jumps.
    let error = refused("LBL 1\n; ROUND\nFN 9: IF +1 EQU +1 GOTO LBL 1");
    assert_eq!((error.rule.name(), error.line), ("endless", 4));
    let way = format!("Q1 = {}1\n", " ".repeat(400)).repeat(1000);
    let error = refused(&format!("LBL 1\n{way}FN 9: IF +1 EQU +1 GOTO LBL 1"));
    assert_eq!((error.rule.name(), error.line), ("endless", 1003));
}

#[test]
fn formulas_are_calculated_in_the_order_of_the_manual() {
    for (formula, expected) in [
        // The manual's own examples.
        ("5 * 3 + 2 * 10", 35.0),
        ("SQ 10 - 3^3", 73.0),
        ("2 + 3 - 2", 3.0),
        ("2 ^ 3 ^ 2", 512.0),
        ("400 % 360", 40.0),
        ("3 * (2 + 4)", 18.0),
        // Sign and function before the power.
        ("-2^2", 4.0),
        ("SQ 3^2", 81.0),
        ("2^-1", 0.5),
        ("12 / 4 / 3", 1.0),
        ("8-5", 3.0),
        ("-QL7", 4.0),
        ("Q5*4+1", 4.0),
        ("SQRT 25", 5.0),
        ("SIN 30 * 10", 5.0),
        ("COS 60", 0.5),
        ("TAN 45", 1.0),
        ("ASIN 0.5", 30.0),
        ("ACOS 0", 90.0),
        ("ATAN 1", 45.0),
        ("LN EXP 2", 2.0),
        ("LOG 1000", 3.0),
        ("INT -2.7", -2.0),
        ("FRAC 2.75", 0.75),
        ("ABS -3", 3.0),
        ("NEG 3", -3.0),
        ("SGN -9", -1.0),
        ("INT (PI * 100)", 314.0),
        ("SIN (15 + 15) + SQRT SQ 3", 3.5),
    ] {
        let found = value(formula).unwrap_or_else(|error| panic!("{formula}: {error}"));
        assert!((found - expected).abs() < 1e-9, "{formula}: {found}");
    }
}

#[test]
fn what_cannot_be_calculated_is_refused() {
    for (formula, rule) in [
        ("1 / 0", "expression"),
        ("SQRT -1", "expression"),
        ("LN 0", "expression"),
        ("ASIN 2", "expression"),
        ("SGN 0", "expression"),
        ("2 * 7 % 3", "expression"),
        ("-7 % 3", "expression"),
        ("0 ^ -1", "expression"),
        ("10 ^ 11", "parameter"),
        ("TAN 90", "parameter"),
        ("Q99", "parameter"),
        ("QS1", "parameter"),
        ("Q2000", "syntax"),
        ("(1 + 2", "syntax"),
        ("1 +", "syntax"),
        ("1 2", "unknown-word"),
        ("SINH 1", "unknown-word"),
    ] {
        let error = value(formula).unwrap_err();
        assert_eq!(error.rule.name(), rule, "{formula}: {error}");
        assert!(error.line == 4 && error.column > 0);
    }
    let deep = format!("{}1{}", "(".repeat(10_000), ")".repeat(10_000));
    assert!(value(&deep).unwrap_err().message.contains("nested"));
    assert!(value(&"-".repeat(100_000)).is_err());
    assert!(value(&"2^".repeat(100_000)).is_err());
}

#[test]
fn numbered_functions_calculate() {
    // Opposite 25 and adjacent 50 (the manual's triangle): 26.5651 degrees; the second quadrant and the
    // fourth by hand.
    let angle = 0.5f64.atan().to_degrees();
    for (function, expected) in [
        ("FN 0: Q1 = +60", 60.0),
        ("FN 1: Q1 = -Q2 + -5", -7.0),
        ("FN 2: Q1 = +10 - +5", 5.0),
        ("FN 3: Q1 = +3 * +Q2", 6.0),
        ("FN 4: Q1 = +8 DIV +Q2", 4.0),
        ("FN 4: Q1 = +8 / +Q2", 4.0),
        ("FN 5: Q1 = SQRT 16", 4.0),
        ("FN 6: Q1 = SIN-30", -0.5),
        ("FN 7: Q1 = COS+60", 0.5),
        ("FN 8: Q1 = +3 LEN +4", 5.0),
        ("FN 13: Q1 = +25 ANG +50", angle),
        ("FN 13: Q1 = +25 ANG -50", 180.0 - angle),
        ("FN 13: Q1 = -25 ANG +50", 360.0 - angle),
        ("FN 1: Q1=+1++2", 3.0),
    ] {
        let found = xs(&format!("Q2 = 2\n{function}\nL X+Q1 FMAX"))[0];
        assert!((found - expected).abs() < 1e-9, "{function}: {found}");
    }
    for function in ["FN 4: Q1 = +8 DIV +0", "FN 5: Q1 = SQRT -1", "FN 1: Q1 = +1 - +2", "FN 9: Q1"]
    {
        refused(function);
    }
    let error = refused("FN 14: ERROR = 1000");
    assert_eq!(error.rule.name(), "alarm");
}

#[test]
fn words_take_their_numbers_from_parameters() {
    let ops = run("Q1 = 12.5\nQL1 = 3\nQR2 = 800\nQ10 = 4000
TOOL CALL 5 Z SQ10\nL X+Q1 Y-Q1 Z+QL1 R0 FMAX M3\nL IX-QL1 FQR2\nCC X+0 Y+0\nLP PR+Q1 PA+QL1");
    let polar = 3f64.to_radians();
    assert_near(
        &points(&ops),
        &[[12.5, -12.5, 3.0], [9.5, -12.5, 3.0], [12.5 * polar.cos(), 12.5 * polar.sin(), 3.0]],
    );
    assert!(ops.contains(&Action::Feed(Feed::PerMinute(800.0))));
    assert!(ops.contains(&Action::Spindle(program::Spindle::Clockwise(4000.0))));
    // A number in an inch program is in inches, wherever it comes from.
    let records = run_on([false; 3], "INCH", "Q1 = 2\nL X+Q1 FMAX").unwrap();
    assert_eq!(records[0].action.position().unwrap().point.x, 50.8);
}

#[test]
fn a_decimal_sign_may_be_a_comma() {
    assert_eq!(xs("L X+1,5 FMAX\nL X-0,25 FMAX\nQ1 = 2,5\nL X+Q1 FMAX"), [1.5, -0.25, 2.5]);
}

#[test]
fn the_control_knows_its_own_parameters() {
    let blocks = "TOOL CALL 5 Z S3000\nL X+Q108 Y+Q109 Z+Q110 FMAX";
    // The spindle has not been switched on: how it stands is not known.
    assert!(run_on([false; 3], "MM", blocks).is_err());
    let ops = run_with_radius(
        4.0,
        "TOOL CALL 5 Z S3000\nM4\nM8
L X+Q108 Y+Q109 Z+Q110 FMAX\nM5\nM9\nL X+Q110 Y+Q111 Z+Q113 FMAX\nL X+Q114 FMAX",
    );
    assert_near(&points(&ops), &[[4.0, 2.0, 1.0], [3.0, 0.0, 0.0], [100.0, 0.0, 0.0]]);
    // A tool that the program defines itself has its data.
    let defined = "TOOL DEF 7 L+90 R+6\nTOOL CALL 7 Z\nL X+Q108 Y+Q114 Z+0 FMAX";
    assert_near(&points(&run(defined)), &[[6.0, 90.0, 0.0]]);
    assert_eq!(refused("TOOL DEF 7 R+6").rule.name(), "missing-word");
    let system = "FN 18: SYSREAD Q1 = ID20 NR1\nFN 18: SYSREAD Q2 = ID270 NR1 IDX3
FN 18: SYSREAD Q3 = ID210 NR2\nL X+Q1 Y+Q2 Z+Q3 FMAX";
    assert_near(&points(&run(&format!("{START}{system}")))[1..], &[[5.0, 50.0, 0.0]]);
    assert_eq!(refused("FN 18: SYSREAD Q1 = ID1000 NR1").rule.name(), "parameter");
    assert_eq!(refused("FN 18: SYSREAD Q1 = ID270 NR1 IDX1").rule.name(), "parameter");
}

#[test]
fn cycle_parameters_can_be_changed_before_the_call() {
    // The parameters of a cycle are Q parameters; what was put into them at the definition stays.
    let blocks = "Q1 = -15
CYCL DEF 200 DRILLING Q200=2 Q201=Q1 ~
  Q206=+250 Q202=+20 ~
  Q210=+0 Q203=+0 Q204=+50
Q1 = -99
L X+1 FMAX M99
Q201 = -7
L X+2 FMAX M99
Q201 = 7";
    let depths: Vec<f64> =
        cycles(&run(&format!("{START}{blocks}"))).iter().map(|cycle| cycle.depth).collect();
    assert_eq!(depths, [15.0, 7.0]);
    assert_eq!(refused(&format!("{START}{blocks}\nCYCL CALL")).rule.name(), "cycle-parameter");
}

#[test]
fn a_called_program_runs_with_labels_and_local_parameters_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let sub = "Q1 = Q1 + 1\nQL1 = 50\nCALL LBL 1\nLBL 1\nL IX+Q1 FMAX\nLBL 0";
    std::fs::write(folder.path().join("SUB.H"), program("SUB", "MM", sub)).unwrap();
    std::fs::create_dir(folder.path().join("lower")).unwrap();
    std::fs::write(folder.path().join("lower/in.h"), program("IN", "INCH", "L X+1 FMAX")).unwrap();
    let main = "L X+0 FMAX\nQ1 = 4\nQL1 = 7\nLBL 1\nCALL PGM SUB\nCALL LBL 1 REP 1
L X+QL1 FMAX\nCALL PGM lower\\in.h\nL X+1 FMAX\nQS2 = \"SUB.H\"\nCALL PGM QS2";
    let records = run_in(folder.path(), main).unwrap();
    let moves: Vec<(u32, f64)> = records
        .iter()
        .filter_map(|record| Some((record.line, record.action.position()?.point.x)))
        .collect();
    let expected = [
        (2, 0.0),
        (6, 5.0),
        (6, 10.0),
        (6, 16.0),
        (6, 22.0),
        (8, 7.0),
        (9, 25.4),
        (10, 1.0),
        (12, 8.0),
        (12, 15.0),
    ];
    assert_eq!(moves, expected);
    assert_eq!(records.last().unwrap().action, Action::End);
    // The drive and its folders are the control's; of them the name of the file counts.
    for call in ["TNC:\\NC\\SUB.H", "sub", "Sub.h"] {
        let records =
            run_in(folder.path(), &format!("Q1 = 1\nL X+0 FMAX\nCALL PGM {call}")).unwrap();
        assert_eq!(records.iter().filter_map(|r| r.action.position()).count(), 3, "{call}");
    }
}

#[test]
fn a_called_program_is_refused_with_its_name_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    put("BAD.H", program("BAD", "MM", "Q1 = 1\nL X+1 Y FMAX"));
    put("END.H", program("END", "MM", "M30"));
    put("SELF.H", program("SELF", "MM", "CALL PGM SELF.H"));
    put("OPEN.H", "0 BEGIN PGM OPEN MM\n1 L X+1 FMAX\n".into());
    put("EMPTY.H", String::new());
    put("LOCAL.H", program("LOCAL", "MM", "L X+QL1 FMAX"));
    for (call, file, line, rule) in [
        ("CALL PGM BAD", "BAD.H", 3, "unknown-word"),
        ("CALL PGM END.H", "END.H", 2, "program-frame"),
        ("CALL PGM SELF", "SELF.H", 2, "nesting"),
        ("CALL PGM OPEN", "OPEN.H", 2, "program-frame"),
        ("CALL PGM EMPTY", "EMPTY.H", 1, "program-frame"),
        ("CALL PGM LOCAL", "LOCAL.H", 2, "parameter"),
        ("CALL PGM MISSING", "t.h", 3, "called-program"),
        ("CALL PGM ..\\SECRET.H", "t.h", 3, "called-program"),
        ("CALL PGM TNC:\\NC\\SUB.H", "t.h", 3, "called-program"),
        ("CALL PGM SUB.I", "t.h", 3, "called-program"),
    ] {
        let error = run_in(folder.path(), &format!("QL1 = 1\n{call}")).unwrap_err();
        assert_eq!(
            (&*error.file, error.line, error.rule.name()),
            (file, line, rule),
            "{call}: {error}"
        );
    }
}

#[test]
fn blocks_may_all_be_without_numbers() {
    let text = b"BEGIN PGM A MM\nLBL 1\nL IX+1 FMAX\nCALL LBL 1 REP 1\nEND PGM A MM\n";
    let error = read_on([false; 3], text).unwrap_err();
    assert_eq!((error.rule.name(), error.line), ("unknown-position", 3));
    let text = b"\xef\xbb\xbfBEGIN PGM A MM\nL X+1 FMAX\n* - HEAD\n; MORE ~\nLINES\nEND PGM A MM\n";
    assert_eq!(read_on([false; 3], text).unwrap().len(), 5);
    let error = read_on([false; 3], b"0 BEGIN PGM A MM\nEND PGM A MM\n").unwrap_err();
    assert!(error.help.contains("leave all numbers out"), "{error}");
}

#[test]
fn functions_of_the_control_are_neutral_or_refused_with_a_reason() {
    for neutral in [90, 108, 111, 126, 134] {
        assert_eq!(run(&format!("L X+1 FMAX M{neutral}")).len(), 2, "M{neutral}");
    }
    for refusal in [94, 97, 98, 103, 109, 110, 116, 118, 120, 124, 130, 138, 143, 144] {
        let error = refused(&format!("L X+1 FMAX M{refusal}"));
        assert!(error.message.contains("not supported: it"), "{error}");
    }
    let ops = run("TOOL CALL 5 Z S3000 F700\nL X+0 Y+0 Z+0 FMAX\nL X+1 F100\nL X+2 FAUTO");
    assert_eq!(ops.iter().filter(|op| **op == Action::Feed(Feed::PerMinute(700.0))).count(), 2);
    assert_eq!(refused("L X+1 FZ0.1").rule.name(), "feed");
}

#[test]
fn texts_end_at_their_longest() {
    let long = "Q".repeat(200);
    assert!(
        run_on([false; 3], "MM", &format!("QS1 = \"{long}\"\nQS2 = QS1 || \"{}\"", "Q".repeat(55)))
            .is_ok()
    );
    let error = refused(&format!("QS1 = \"{long}\"\nQS2 = QS1 || QS1"));
    assert_eq!(error.rule.name(), "parameter");
    refused(&format!("QS1 = \"{long}\"\nQS2 = QS1{}", " || QS1".repeat(100_000)));
}

#[test]
fn a_program_may_begin_at_a_place_that_is_known() {
    let setup = toolpost_control::Setup {
        start: Some(geom::Vec3::new(1.0, 2.0, 3.0)),
        ..toolpost_control::Setup::default()
    };
    let text = program("T", "MM", "L IX+1 IZ-1 F100");
    let records = read_with(setup, [false; 3], text.as_bytes()).unwrap();
    assert_eq!(records[1].action.position().unwrap().point.to_array(), [2.0, 2.0, 2.0]);
}

#[test]
fn a_program_may_end_within_a_subprogram() {
    assert_eq!(xs("CALL LBL 1\nM30\nLBL 1\nL X+3 FMAX M30\nLBL 0"), [3.0]);
    let ops = run("CALL LBL 1\nM30\nLBL 1\nL X+3 FMAX M30\nLBL 0");
    assert_eq!(ops.iter().filter(|op| **op == Action::End).count(), 1);
}
