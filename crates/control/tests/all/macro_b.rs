//! FANUC's custom macro B as its manuals tell it (B-63684EN, 13.3 and 16; `docs/controls/fanuc.md`).

use geom::Vec3;
use program::Diagnostic;
use proptest::prelude::*;
use std::path::PathBuf;
use toolpost_control::{Action, Dialect, Settings, Setup, WholeNumbers};

fn settings(dialect: Dialect, folders: &[PathBuf]) -> Settings {
    let setup =
        Setup { folders: folders.to_vec().into(), start: Some(Vec3::ZERO), ..Setup::default() };
    Settings { setup, ..Settings::new(dialect, [false; 3]) }
}

fn records(settings: &Settings, text: &str) -> Result<Vec<(u32, Action)>, Box<Diagnostic>> {
    let records = crate::common::records(settings, "main.nc", text)?;
    Ok(records.into_iter().map(|record| (record.line, record.action)).collect())
}

/// The ends of the moves of a program in mm, which begins with `G21` and `G0`.
#[track_caller]
fn ends(text: &str) -> Vec<[f64; 3]> {
    let text = format!("G21 G90 G0\n{text}");
    let records = records(&settings(Dialect::Fanuc, &[]), &text);
    let records = records.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let end = |(_, op): &(u32, Action)| op.position().map(|pose| pose.point.to_array());
    records.iter().filter_map(end).collect()
}

/// X of each move.
#[track_caller]
fn xs(text: &str) -> Vec<f64> {
    ends(text).iter().map(|end| end[0]).collect()
}

#[track_caller]
fn refused(text: &str) -> Box<Diagnostic> {
    let text = format!("G21 G90 G0\n{text}\nM30\n");
    let Err(error) = records(&settings(Dialect::Fanuc, &[]), &text) else {
        panic!("taken:\n{text}")
    };
    assert!(error.line > 0 && error.column > 0, "{error}");
    error
}

/// The value of an expression.
#[track_caller]
fn value(expression: &str) -> f64 {
    xs(&format!("#30={expression}\nX#30\n"))[0]
}

#[test]
fn operators_and_functions() {
    for (expression, expected) in [
        ("1+2*3", 7.0),
        ("[1+2]*3", 9.0),
        ("8/4/2", 1.0),
        // AND goes with the products, OR and XOR with the sums, of 32 bits.
        ("12 AND 10", 8.0),
        ("12 OR 3", 15.0),
        ("12 XOR 10", 6.0),
        ("1 OR 2*2", 5.0),
        ("7 MOD 4", 3.0),
        // Both rounded to whole numbers, the sign of the first.
        ("-7.4 MOD 3.6", -3.0),
        ("SIN[30]", 0.5),
        ("COS[60]", 0.5),
        ("TAN[45]", 1.0),
        ("ASIN[0.5]", 30.0),
        // Angles begin at 0.
        ("ASIN[-0.5]", 330.0),
        ("ACOS[0.5]", 60.0),
        ("ATAN[1]", 45.0),
        ("ATAN[1]/[1]", 45.0),
        ("ATAN[-1]/[1]", 315.0),
        ("ATAN[1,-1]", 135.0),
        ("SQRT[16]", 4.0),
        ("SQR[16]", 4.0),
        ("ABS[-2.5]", 2.5),
        ("ROUND[2.5]", 3.0),
        ("ROUND[-2.5]", -3.0),
        ("RND[1.2]", 1.0),
        // Towards 0 and away from it (16.3).
        ("FIX[1.2]", 1.0),
        ("FIX[-1.2]", -1.0),
        ("FUP[1.2]", 2.0),
        ("FUP[-1.2]", -2.0),
        ("FUP[2]", 2.0),
        ("LN[1]", 0.0),
        ("EXP[0]", 1.0),
        ("POW[2,10]", 1024.0),
        ("BCD[25]", 37.0),
        ("BIN[37]", 25.0),
        ("-SIN[30]", -0.5),
    ] {
        let got = value(expression);
        assert!((got - expected).abs() < 1e-9, "{expression}: {got}");
    }
    assert_eq!(value("[[[[[1+1]+1]+1]+1]+1]"), 6.0);
    for wrong in
        ["[[[[[[1]]]]]]", "1/0", "SQRT[-1]", "ASIN[2]", "LN[0]", "BIN[10]", "[1.5", "##1", "sin[1]"]
    {
        refused(&format!("#1={wrong}"));
    }
}

#[test]
fn a_word_whose_variable_is_null_is_not_there() {
    assert_eq!(
        ends("X1. Y2. Z3.\n#2=5\nX#1 Y#2\nZ-#2\nX[#2*2+1] Y#1\n"),
        [[1.0, 2.0, 3.0], [1.0, 5.0, 3.0], [1.0, 5.0, -5.0], [11.0, 5.0, -5.0]]
    );
    assert_eq!(xs("#1=91\nG#1 X1.\nX1.\nG[#1-1] X7.\n"), [1.0, 2.0, 7.0]);
}

#[test]
fn the_last_d_and_h_can_be_read() {
    // B-63684EN, 16.2: modal information.
    assert_eq!(xs("T1 D14 M6\nG43 H4 Z1.\n#1=#4107+#4111\nG0 X#1 Y0 Z0\n")[1..], [18.0]);
    refused("#1=#4107");
    refused("#1=#4111");
}

#[test]
fn round_in_a_word_is_that_of_the_machine() {
    // B-63684EN, 16.3: there it rounds to the least input increment of the address.
    refused("#1=1.23456\nG0 X[ROUND[#1]]\n");
    refused("#1=1.23456\nG0 X-RND[#1]\n");
    assert_eq!(xs("#1=1.23456\n#2=ROUND[#1*1000]/1000\nG0 X#2\n"), [1.235]);
}

#[test]
fn null_is_0_but_for_eq_and_ne() {
    // B-63684EN, 16.1: the table of conditional expressions.
    for (condition, null, zero) in [
        ("#1 EQ #0", true, false),
        ("#1 NE 0", true, false),
        ("#1 GE #0", true, true),
        ("#1 GT 0", false, false),
        ("#1 NE #0", false, true),
        ("#1 LE #0", true, true),
        ("#1 LT 0", false, false),
    ] {
        for (set, expected) in [("#1=#0", null), ("#1=0", zero)] {
            let text = format!("{set}\nIF[{condition}]GOTO 5\nX1.\nN5 X2.\n");
            let expected = if expected { vec![2.0] } else { vec![1.0, 2.0] };
            assert_eq!(xs(&text), expected, "{text}");
        }
    }
    // A copy of null is null, a calculation with it is 0.
    assert_eq!(xs("#2=#1\n#3=#1*5\nX9. \nX#2\nX#3\n"), [9.0, 0.0]);
}

#[test]
fn jumps_look_downwards_first_and_then_from_the_start() {
    assert_eq!(xs("GOTO 2\nN1 X1.\nN2 X2.\nGOTO 9\nX3.\nN9 X4.\n"), [2.0, 4.0]);
    // Two blocks N5: the one below is found, and from behind it that one from the start.
    assert_eq!(
        xs(
            "N5 #1=#1+1\nX#1\nIF [#1 GE 3] GOTO 9\nGOTO 5\nX100.\nN5 #1=#1+10\nX#1\nIF [#1 LT 12] GOTO 5\nN9\n"
        ),
        [1.0, 11.0, 12.0]
    );
    assert_eq!(xs("#1=7\nGOTO #1\nX1.\nN7 X2.\nGOTO[#1+1]\nN8 X3.\n"), [2.0, 3.0]);
    assert!(refused("GOTO 5").message.contains("N5"));
    assert_eq!(refused("N1 GOTO 1").rule.name(), "endless");
    refused("WHILE[1 EQ 2]DO1\nN5 X1.\nEND1\nGOTO 5");
}

#[test]
fn loops_nest_three_deep_and_may_be_left() {
    assert_eq!(xs("#1=1\nWHILE[#1 LE 3]DO 1\nX#1\n#1=#1+1\nEND 1\nX9.\n"), [1.0, 2.0, 3.0, 9.0]);
    assert_eq!(
        xs(
            "WHILE[#1 LT 2]DO1\n#1=#1+1\n#2=0\nWHILE[#2 LT 2]DO2\n#2=#2+1\n#3=0\nWHILE[#3 LT 1]DO3\n\
            #3=#3+1\nX[#1*10+#2]\nEND3\nEND2\nEND1\n"
        ),
        [11.0, 12.0, 21.0, 22.0]
    );
    assert_eq!(xs("DO1\n#1=#1+1\nX#1\nIF[#1 EQ 2]GOTO 7\nEND1\nN7\n"), [1.0, 2.0]);
    assert_eq!(
        xs("WHILE[#1 GT 0]DO1\nX1.\nEND1\nX2.\nWHILE[#1 LT 1]DO1\n#1=1\nX3.\nEND1\n"),
        [2.0, 3.0]
    );
    assert_eq!(xs("IF[1 EQ 1]THEN #1=4\nIF[1 EQ 2]THEN #1=5\nX#1\n"), [4.0]);
    for wrong in [
        "WHILE[1 EQ 1]DO4\nEND4",
        "WHILE[1 EQ 1]DO1\nX1.",
        "END1",
        "DO1\nDO2\nEND1\nEND2",
        "DO1\nDO1\nEND1\nEND1",
        "WHILE[1 EQ 1]\nX1.",
        "IF[1 EQ 1]X1.",
        "#1=5 X1.",
        "X1. #1=5",
        "#1",
        "X#501",
        "#0=1",
        "#40=1",
    ] {
        refused(wrong);
    }
}

#[test]
fn macros_take_arguments_by_letter() {
    let text = "G65 P9010 A1. B2. X24.5 D7. F9. Z26.\nX5.\nM30\n\
                O9010\nG0 X#1 Y#2 Z#7\nX#24 Y#9 Z#26\nM99\n";
    assert_eq!(ends(text), [[1.0, 2.0, 7.0], [24.5, 9.0, 26.0], [5.0, 9.0, 26.0]]);
    // I J K again and again are argument specification II; the last word for a variable holds.
    let text = "G65 A1. B2. I-3. I4. D5. P1000\nM30\nO1000\nX#1 Y#2 Z#4\nX#7\nM99\n";
    assert_eq!(ends(text), [[1.0, 2.0, -3.0], [5.0, 2.0, -3.0]]);
    let text = "G65 P1 I1. J2. K3. I4. J5. K6. I7.\nM30\nO1\nX#4 Y#5 Z#6\nX#7 Y#8 Z#9\nX#10\nM99\n";
    assert_eq!(ends(text)[1], [4.0, 5.0, 6.0]);
    assert_eq!(ends(text)[2][0], 7.0);
    // Letters of numbers count as they are; the others need their point.
    assert_eq!(
        xs("G65 P1 M4 S5 T6 H7\nM30\nO1\nX#13\nX#19\nX#20\nX#11\nM99\n"),
        [4.0, 5.0, 6.0, 7.0]
    );
    assert_eq!(refused("G65 P1 A1\nM30\nO1\nM99").rule.name(), "decimal-point");
    assert_eq!(refused("G65 P1 G1.\nM30\nO1\nM99").rule.name(), "call");
    assert_eq!(refused("G65 A1.\nM30").rule.name(), "call");
}

#[test]
fn macros_have_variables_of_their_own_and_subprograms_those_of_their_caller() {
    assert_eq!(
        xs(
            "#1=5\n#100=1\nG65 P1 A3. L2\nX#1\nM98 P2\nX#1\nM30\nO1\nX#1\n#1=#1+1\n#100=#100+1\nX#100\nM99\n\
            O2\nX#1\n#1=8\nM99\n"
        ),
        [3.0, 2.0, 3.0, 3.0, 5.0, 5.0, 8.0]
    );
}

#[test]
fn subprograms_are_repeated_and_return_to_a_block() {
    assert_eq!(xs("G91\nM98 P1 L2\nM98 P30001\nM30\nO1\nX1.\nM99\n"), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(xs("M98 P1\nX1.\nN7 X2.\nM30\nO1\nX9.\nM99 P7\n"), [9.0, 2.0]);
    // M99 P in the program itself is a jump.
    assert_eq!(
        xs("#1=#1+1\nN3 #1=#1+1\nX#1\nIF[#1 GE 4]GOTO 9\nM99 P3\nN9 M30\n"),
        [2.0, 3.0, 4.0]
    );
    // A move in the block of the call comes first.
    assert_eq!(xs("X3. M98 P1\nM30\nO1\nX4.\nM99\n"), [3.0, 4.0]);
    assert_eq!(xs("M98 P1\nM30\n:1\nX4.\nM99\n"), [4.0]);
    assert_eq!(xs("M98 P1\nM30\nO1 (SUB)\nX4.\nX5. M99\n"), [4.0, 5.0]);
    for (wrong, rule) in [
        ("M98", "call"),
        ("M98 P5", "call"),
        ("M98 P1\nM30\nO1\nM98 P1\nM99", "call"),
        ("G65 P1\nM30\nO1\nG65 P1\nM99", "call"),
        ("M98 P1\nM30\nO1\nX1.\nO2\nM99", "program-number"),
        ("M98 P1\nM30\nO1\nM99\nO1\nM99", "macro"),
        ("X1.\nO5\nX2.", "program-number"),
    ] {
        assert_eq!(refused(wrong).rule.name(), rule, "{wrong}");
    }
    // The control begins its program again at M99: what follows is not reached.
    assert_eq!(xs("X1.\nM99\nX2.\n"), [1.0]);
    let ends_early = "G21 G0\nM98 P1\nM30\nO1\nX1.\n";
    let error = records(&settings(Dialect::Fanuc, &[]), ends_early).unwrap_err();
    assert!(error.message.contains("without M99"), "{error}");
}

#[test]
fn g66_calls_after_each_move_until_g67() {
    let text = "G66 P1 A2.\nX1.\n#5=1\nX2.\nM8\nG67\nX3.\nM30\nO1\nY[#5042+#1]\n#1=#1+1\nM99\n";
    // The macro's variables are set by G66 alone and keep what they become.
    let expected =
        [[1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 5.0, 0.0], [3.0, 5.0, 0.0]];
    assert_eq!(ends(text), expected);
    assert_eq!(refused("G66.1 P1 A1.").rule.name(), "unknown-word");
    assert_eq!(refused("G66 P1\nG66 P1\nM30\nO1\nM99").rule.name(), "call");
}

#[test]
fn system_variables_tell_what_the_program_has_done() {
    assert_eq!(
        ends("X1. Y2. Z3.\nX#5042 Y#5003 Z#5001\nG91 G18 F500.\nX#4003\nX#4002 Y#4109\n")[1..],
        [[2.0, 3.0, 1.0], [93.0, 3.0, 1.0], [111.0, 503.0, 1.0]]
    );
    assert_eq!(xs("G55\nS900\nX#4014\nX#4119\nX[#4006+#4010]\n"), [55.0, 900.0, 119.0]);
    let stop = "G21 G0\n#3006=1 (LOOK)\nX1.\n";
    let got = records(&settings(Dialect::Fanuc, &[]), stop).unwrap();
    assert!(got.iter().any(|(line, op)| *line == 2 && *op == Action::Stop));
    let alarm = refused("IF[1 EQ 1]GOTO 5\nN5 #3000=12 (TOOL BROKEN)");
    assert_eq!(alarm.rule.name(), "alarm");
    assert!(alarm.message.contains("3012") && alarm.message.contains("TOOL BROKEN"), "{alarm}");
    for unknown in ["#5021", "#5061", "#3901", "#1000", "#2001", "#3001", "#9999", "#510"] {
        let error = refused(&format!("#1={unknown}"));
        assert_eq!(error.rule.name(), "parameter", "{error}");
    }
    assert_eq!(refused("X1.\n#5221=5.").rule.name(), "macro");
}

#[test]
fn programs_are_found_in_the_folders() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("O0050", "%\nO0050\nX7.\nM98 P60\nM99\n%\n");
    write("O0060.nc", "O60\nX8.\nM99\n");
    write("O0070.nc", "O70\n\nX[1/0]\nM99\n");
    let settings = settings(Dialect::Fanuc, &[folder.path().to_path_buf()]);
    let got = records(&settings, "G21 G0\n\nM98 P50\nX9.\nM30\n").unwrap();
    let moves: Vec<(u32, f64)> =
        got.iter().filter_map(|(l, op)| op.position().map(|p| (*l, p.point.x))).collect();
    assert_eq!(moves, [(3, 7.0), (3, 8.0), (4, 9.0)]);
    let error = records(&settings, "G21 G0\nM98 P70\nM30\n").unwrap_err();
    assert_eq!((error.file.as_str(), error.line), ("O0070.nc", 3));
    let error = records(&settings, "G21 G0\nM98 P80\nM30\n").unwrap_err();
    assert!(error.message.contains("O0080"), "{error}");
}

#[test]
fn a_control_that_is_not_fresh_does_not_know_its_common_variables() {
    let settings = Settings::new(Dialect::Fanuc, [false; 3]);
    for text in ["#1=#100\n", "#1=#500\n", "#1=#5041\n"] {
        let error = records(&settings, &format!("G21\n{text}")).unwrap_err();
        assert_eq!(error.rule.name(), "parameter", "{text}");
    }
    assert_eq!(records(&settings, "G21\n#1=#2\n#100=#1\n#2=#100\n").unwrap(), []);
}

#[test]
fn arguments_without_a_point_are_units_where_the_machine_is_set_so() {
    let mut settings = settings(Dialect::Fanuc, &[]);
    settings.setup.whole_numbers = WholeNumbers::Units;
    let got = records(&settings, "G21 G0\nG65 P1 A3\nM30\nO1\nX#1\nM99\n").unwrap();
    assert_eq!(got.iter().find_map(|(_, op)| op.position()).unwrap().point.x, 3.0);
}

#[test]
fn arguments_without_a_point_count_the_increments_of_their_address() {
    let run = |unit: &str, argument: &str| {
        let mut settings = settings(Dialect::Fanuc, &[]);
        settings.setup.whole_numbers = WholeNumbers::Increments;
        let text = format!("{unit} G0\nG65 P1 {argument}\nM30\nO1\nX[#1+#9+#17+#19+#24]\nM99\n");
        let got = records(&settings, &text)?;
        Ok::<_, Box<Diagnostic>>(got.iter().find_map(|(_, op)| op.position()).unwrap().point.x)
    };
    for (unit, argument, x) in [
        ("G21", "X3000", 3.0),
        ("G21", "Q-1500", -1.5),
        ("G21", "A45000", 45.0),
        ("G21", "X3.", 3.0),
        // S, like D, H, M and T, counts as it is.
        ("G21", "S12", 12.0),
        // A ten-thousandth of an inch.
        ("G20", "X30000", 3.0 * 25.4),
    ] {
        assert!((run(unit, argument).unwrap() - x).abs() < 1e-9, "{unit} {argument}");
    }
    for (unit, argument) in [("G21", "F100"), ("G20", "A45000")] {
        let error = run(unit, argument).unwrap_err();
        assert_eq!((error.rule.name(), error.help.is_empty()), ("decimal-point", false), "{error}");
    }
}

#[test]
fn haas_and_mach3_call_subprograms_too() {
    let run = |dialect, text: &str| {
        let got = records(&settings(dialect, &[]), text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        got.iter().filter_map(|(_, op)| op.position().map(|p| p.point.x)).collect::<Vec<_>>()
    };
    assert_eq!(
        run(Dialect::Haas, "G21 G0\nM98 P12345 L2\nM97 P50\nM30\nN50 X2.\nM99\nO12345\nX1.\nM99\n"),
        [1.0, 1.0, 2.0]
    );
    assert_eq!(run(Dialect::Haas, "G21 G0\nG65 P1 A1.5\nM30\nO1\nX#1\nM99\n"), [1.5]);
    assert_eq!(
        run(Dialect::Mach3, "G21 G0\n#1=2\n#2=[#1**3]\nx#2\nM98 P5 L2\nM30\nO5\nx[#1+1]\nM99\n"),
        [8.0, 3.0, 3.0]
    );
}

/// A random program: what a loop or a branch of macro B does with a running number.
#[derive(Clone, Debug)]
enum Piece {
    Step(i32),
    Skip(bool, Vec<Piece>),
    Loop(u8, Vec<Piece>),
    Macro(i32, Vec<Piece>),
}

fn write(
    pieces: &[Piece],
    depth: usize,
    number: &mut u32,
    text: &mut String,
    programs: &mut String,
) {
    use std::fmt::Write as _;
    for piece in pieces {
        *number += 1;
        let n = *number;
        match piece {
            Piece::Step(by) => writeln!(text, "G91 G0 X{by}.").unwrap(),
            Piece::Skip(skips, body) => {
                writeln!(text, "IF [{} EQ 1] GOTO {n}", u8::from(*skips)).unwrap();
                write(body, depth, number, text, programs);
                writeln!(text, "N{n}").unwrap();
            }
            Piece::Loop(times, body) if depth < 3 => {
                let (level, variable) = (depth + 1, 20 + depth);
                writeln!(text, "#{variable}=0\nWHILE [#{variable} LT {times}] DO{level}").unwrap();
                writeln!(text, "#{variable}=#{variable}+1").unwrap();
                write(body, depth + 1, number, text, programs);
                writeln!(text, "END{level}").unwrap();
            }
            Piece::Loop(_, body) => write(body, depth, number, text, programs),
            Piece::Macro(argument, body) => {
                let mut inside = format!("O{n}\nG91 G0 X#1\n");
                write(body, 0, number, &mut inside, programs);
                writeln!(text, "G65 P{n} A{argument}.").unwrap();
                programs.push_str(&inside);
                programs.push_str("M99\n");
            }
        }
    }
}

fn steps(pieces: &[Piece], depth: usize, made: &mut Vec<f64>) {
    for piece in pieces {
        match piece {
            Piece::Step(by) => made.push(f64::from(*by)),
            Piece::Skip(skips, body) if !skips => steps(body, depth, made),
            Piece::Skip(..) => {}
            Piece::Loop(times, body) if depth < 3 => {
                (0..*times).for_each(|_| steps(body, depth + 1, made));
            }
            Piece::Loop(_, body) => steps(body, depth, made),
            Piece::Macro(argument, body) => {
                made.push(f64::from(*argument));
                steps(body, 0, made);
            }
        }
    }
}

fn pieces() -> impl Strategy<Value = Vec<Piece>> {
    let piece = (1..9).prop_map(Piece::Step).prop_recursive(4, 30, 4, |inner| {
        let body = || proptest::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            (any::<bool>(), body()).prop_map(|(skips, b)| Piece::Skip(skips, b)),
            (0..3u8, body()).prop_map(|(n, b)| Piece::Loop(n, b)),
            (1..9, body()).prop_map(|(n, b)| Piece::Macro(n, b)),
        ]
    });
    proptest::collection::vec(piece, 1..6)
}

fn make_their_steps(pieces: &[Piece]) {
    let (mut text, mut programs) = (String::new(), String::new());
    write(pieces, 0, &mut 0, &mut text, &mut programs);
    let mut made = Vec::new();
    steps(pieces, 0, &mut made);
    let mut at = 0.0;
    let step = |step: &f64| {
        at += step;
        at
    };
    let expected: Vec<f64> = made.iter().map(step).collect();
    assert_eq!(xs(&format!("{text}M30\n{programs}")), expected);
}

proptest! {
    #[test]
    fn random_programs_make_their_steps(pieces in pieces()) {
        make_their_steps(&pieces);
    }
}

#[test]
fn a_loop_around_nothing_makes_no_steps() {
    make_their_steps(&[Piece::Loop(1, Vec::new())]);
}

#[test]
fn the_seeds_of_the_fuzz_target_with_flow_are_legal_programs() {
    for (name, dialect) in [
        ("fanuc-macro.nc", Dialect::Fanuc),
        ("linuxcnc-flow.nc", Dialect::LinuxCnc),
        ("haas-subprograms.nc", Dialect::Haas),
    ] {
        let seeds = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/iso");
        let text = std::fs::read_to_string(seeds.join(name)).unwrap();
        let got = records(&settings(dialect, &[]), &text[1..]);
        assert!(got.unwrap_or_else(|e| panic!("{name}: {e}")).len() > 3, "{name}");
    }
}
