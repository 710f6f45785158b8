//! O-words, parameters and expressions of LinuxCNC, with its own interpreter as the judge.

use crate::common::linuxcnc::difference;
use geom::Vec3;
use program::{Diagnostic, Rule};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use toolpost_control::{Action, Dialect, Settings, Setup, read};

/// Runs a program with everything in the control at 0.
fn run(text: &str, folders: &[PathBuf]) -> Result<Vec<(u32, Action)>, Box<Diagnostic>> {
    let setup =
        Setup { folders: folders.to_vec().into(), start: Some(Vec3::ZERO), ..Setup::default() };
    let settings = Settings { setup, ..Settings::new(Dialect::LinuxCnc, [true; 3]) };
    let records = crate::common::records(&settings, "main.ngc", text)?;
    Ok(records.into_iter().map(|record| (record.line, record.action)).collect())
}

/// X of each move.
fn path(text: &str) -> Vec<f64> {
    let records = run(text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let x = |(_, op): &(u32, Action)| op.position().map(|pose| pose.point.x);
    records.iter().filter_map(x).collect()
}

#[track_caller]
fn agrees(text: &str) {
    if let Some(Some(difference)) =
        difference(format!("G21\n{text}\nM2\n").as_bytes(), [false; 3], &[])
    {
        panic!("{difference}\n{text}");
    }
}

#[track_caller]
fn refused(text: &str) -> Box<Diagnostic> {
    let text = format!("G21\n{text}\nM2\n");
    let Err(error) = run(&text, &[]) else { panic!("taken:\n{text}") };
    assert!(error.line > 0 && error.column > 0, "{error}");
    if let Some(Some(difference)) = difference(text.as_bytes(), [false; 3], &[]) {
        panic!("LinuxCNC takes this: {difference}\n{text}");
    }
    error
}

fn temporary(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// So long that its lines are taken apart ahead of their run: loops go back behind that, and branches before it.
#[test]
fn a_long_program_is_followed_wherever_it_leads() {
    const COUNT: u32 = 5000;
    let mut text = String::from("G21\nG90 F100\no100 repeat [3]\n");
    for i in 0..COUNT {
        text.push_str(&format!("G1 X{i}.5 Y-{i}\n"));
        if i % 7 == 0 {
            text.push_str("(not plain) #1=[#1+1] g1 z#1\n");
        }
    }
    text.push_str("o100 endrepeat\no200 if [#1 LT 0]\n");
    (0..COUNT).for_each(|i| text.push_str(&format!("X-{i}.25 Y0.125\n")));
    text.push_str("o200 endif\n");
    let end = text.lines().count() as u32 + 1;
    let records = run(&format!("{text}X1\n"), &[]).unwrap();
    let moves: Vec<(u32, Vec3)> =
        records.iter().filter_map(|(line, op)| Some((*line, op.position()?.point))).collect();
    // The block reads #1 before it sets it.
    let (mut expected, mut z, mut counted) = (Vec::new(), 0.0, 0.0);
    for _ in 0..3 {
        let mut line = 3;
        for i in 0..COUNT {
            let (x, y) = (f64::from(i) + 0.5, -f64::from(i));
            line += 1;
            expected.push((line, Vec3::new(x, y, z)));
            if i % 7 == 0 {
                (line, z, counted) = (line + 1, counted, counted + 1.0);
                expected.push((line, Vec3::new(x, y, z)));
            }
        }
    }
    expected.push((end, Vec3::new(1.0, 1.0 - f64::from(COUNT), z)));
    assert_eq!(moves, expected);
    let error = run(&format!("{text}X1 X2\n"), &[]).unwrap_err();
    assert_eq!((error.rule.name(), error.line, error.column), ("repeated-word", end, 4));
}

#[test]
fn operators_functions_and_numbers() {
    for line in [
        "X[1+2*3-4/5] Y[2**3**2/10] Z[-7 MOD 3]",
        "X[1 EQ 1.00001] Y[1 NE 2] Z[2 GT 1]",
        "X[1 GE 2] Y[1 LT 2] Z[3 LE 2]",
        // EQ and NE have a tolerance of 0.0001, GE and LE have none.
        "X[1 EQ 1.00009] Y[1 EQ 1.00011] Z[1 NE 1.00009]",
        "X[1 LE 0.99999] Y[1 GE 1.00001] Z[1 LE 1]",
        "X[2 AND 0 OR 1] Y[1 XOR 1] Z[1 OR 0 AND 0]",
        "X[1 + 2 EQ 3 AND 4 * 2 GT 7] Y[10 - 4 - 3] Z[8 / 4 / 2]",
        "X ABS[-3] Y ACOS[0.5] Z ASIN[0.5]",
        "X ATAN[1]/[-1] Y COS[60] Z EXP[1]",
        "X FIX[-1.5] Y FUP[-1.5] Z ROUND[-2.5]",
        "X FIX[2.8] Y FUP[2.2] Z ROUND[2.5]",
        "X LN[10] Y SIN[30] Z SQRT[2]",
        "X TAN[45] Y - - 2 Z + [3]",
        "x -#1 y [ -#1 + 2 ] z - [ 4 ]",
        "X[[[1+2]*[3+4]]-[2*[1-[3]]]] Y1.5 Z.25",
        "X1 #1=5 Y#1",
        "X#7 (never set)",
    ] {
        agrees(&format!("#1=1.5\nG0 {line}\nX#1 Y#2"));
    }
}

#[test]
fn parameters_are_numbered_named_indirect_and_set_together() {
    agrees("#1=3 #3=7 #7=9\nG0 X##1 Y###1 Z#[#1+4]\n#2=#1 #1=#2\nX#1 Y#2");
    agrees("#<Width>=3\n#<_ global Depth>=4\nG0 X#<width> Y[#<WI DTH>*2] Z#<_globaldepth>");
    agrees("G0 X[EXISTS[#<a>]]\n#<a>=1\nX[5+EXISTS[#<a>]]\nX[EXISTS[#<_metric>] * 7]");
    agrees("G0 X1 Y2 Z3\nG91 X[#5420+#5421] Y#<_z>\nG20 X#<_x>\nG90 X[#<_y>]");
    agrees(
        "G0 X[#<_metric>] Y[#5220] Z[#<_absolute>]\nG91 G18 F30\nX#<_incremental> Y[#<_plane>]\n\
            X[#<_feed>] Y[#<_coord_system>] Z[#<_call_level>]\nG55 X[#5220] Y[#<_coord_system>]",
    );
    agrees("G98\nG0 X[1+#<_retract_r_plane>] Y[1+#<_retract_old_z>]\nG99 X[3+#<_retract_r_plane>]");
    agrees("#1=1 #2=0 F100\nG#2 X1\nG#1 X2\nG[90 + #1] X1\nN1 G#2 Y1 M[3+#2] S#1");
    agrees("T3 M6\nG0 X#5400 Y#<_current_tool>");
    agrees("S500 M3\nG0 X#<_rpm> Y#<_spindle_on> Z#<_spindle_cw>\nX[5*#<_ccomp>] Y#<_tool_offset>");
    agrees(
        "G1 F10 X1\nG0 X[#<_motion_mode>]\nX[1+#<_motion_mode>]\nG80\nG0 Y1\n#1=#<_motion_mode>\nX#1",
    );
}

#[test]
fn branches_take_the_first_clause_whose_condition_holds() {
    for value in 0..5 {
        agrees(&format!(
            "#1={value}\nG0 X9\no1 if [#1 EQ 0]\nX0\no1 elseif [#1 EQ 1]\nX1\no2 if [1]\nY1\no2 else\nY2\n\
             o2 endif\no1 elseif [#1 EQ 2]\nX2\no1 else\nX3\no1 endif\nY5\no<a> if [#1 GT 3]\nX7\n\
             o<a> endif"
        ));
    }
}

#[test]
fn loops_go_round_break_and_continue() {
    agrees(
        "G0 X0\no1 while [#1 LT 5]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\n\
            o3 if [#1 EQ 4]\no1 break\no3 endif\nX#1\no1 endwhile\nX9",
    );
    agrees(
        "G0 X0\no1 do\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\nX#1\n\
            o1 while [#1 LT 4]\nX9",
    );
    agrees("G91 G0\no1 repeat [3]\nX1\no2 repeat [#2]\nY1\no2 endrepeat\n#2=[#2+1]\no1 endrepeat");
    agrees(
        "G91 G0\no1 repeat [0]\nX1\no1 endrepeat\no2 repeat [-2]\nX1\no2 endrepeat\n\
            o3 repeat [1.6]\nY1\no3 endrepeat\no4 while [0]\nX8\no4 endwhile\nX1",
    );
    agrees(
        "G91 G0\n#1=0\no1 while [#1 LT 3]\n#1=[#1+1]\n#2=0\no2 do\n#2=[#2+1]\nX#2\n\
            o2 while [#2 LT #1]\no1 endwhile",
    );
}

#[test]
fn subroutines_take_arguments_and_give_values_back() {
    agrees(
        "o100 sub\nG0 X#1 Y#2 Z#30\n#1=99\n#<mine>=4\no100 endsub\n#1=7\no100 call [1] [2]\nX#1\n\
            o100 call\nY#1",
    );
    agrees(
        "o<half> sub\no1 if [#1 LT 0]\no<half> return [0]\no1 endif\no<half> endsub [#1/2]\n\
            o<half> call [9]\nG0 X#<_value> Y#<_value_returned>\no<half> call [-9]\nX#<_value> Y5\n\
            o<none> sub\no<none> endsub\no<none> call\nX[3+#<_value>] Y#<_value_returned>",
    );
    agrees("o1 sub\nG0 X#1\no2 call [#1+1]\nY#1\no1 endsub\no2 sub\nX#1\no2 endsub\no1 call [5]");
    // A subroutine that calls itself, within the depth of calls.
    agrees(
        "o<sum> sub\no1 if [#1 GT 0]\no<sum> call [#1-1]\n#2=#<_value>\no1 endif\n\
            o<sum> endsub [#1+#2]\no<sum> call [6]\nG0 X#<_value>",
    );
    agrees("#1=101\no101 sub\nG0 X#1 Y#<_call_level>\no101 endsub\no#1 call [3]\no[#1] call [4]");
    agrees(
        "(a subroutine that stands behind its call is found)\no5 call [3]\nM2\no5 sub\nG0 X#1\no5 endsub",
    );
}

#[test]
fn a_program_that_asks_is_followed_as_at_the_machine() {
    // LinuxCNC manual, "System parameters": 1 where the interpreter is that of the machine.
    assert_eq!(path("G21\no1 if [#<_task>]\nG0 X5\no1 else\nG0 X7\no1 endif\n"), [5.0]);
}

#[test]
fn fanuc_subprograms_see_the_numbers_of_their_caller() {
    agrees("#1=5 #100=2\nM98 P50 L2\nG0 X#1\nM2\nO50\nG91 G0 X#1\n#1=[#1+1]\nG90\nM99");
    agrees("M98 P50 L0\nG0 X1\nM2\nO50\nG0 X9\nM99");
}

#[test]
fn modes_are_kept_and_brought_back() {
    agrees("G90 F100 G1 X1\nM70\nG91 G20 G18\nF3 X1\nM72\nX5\nG1 X[#<_feed>] Y[#<_plane>]");
    agrees("o1 sub\nM73\nG91 G20\nG1 X1 F5\no1 endsub\nG1 X10 F100\no1 call\nX20\nY[#<_feed>]");
    let error = refused("M72");
    assert_eq!(error.rule.name(), "modes");
}

#[test]
fn a_feed_in_a_block_with_another_unit_is_in_the_old_one() {
    agrees("G1 X1 F254\nX[#<_feed>]\nG20 F25.4 X1\nX[#<_feed>]\nG21 X1\nX[#<_feed>]");
}

#[test]
fn what_does_not_hold_together_is_refused() {
    for text in [
        "o1 endif",
        "o1 while [1]\no2 endwhile",
        "o1 if [1]\no1 endwhile",
        "o1 break",
        "o1 repeat [2]\no1 break\no1 endrepeat",
        "o1 call",
        "o1 sub\no2 sub\no2 endsub\no1 endsub\no1 call",
        "o1 endsub",
        "o1 sub\no1 call\no1 endsub\no1 call",
        "o1 if [1]\nG0 X1\no1 endif\no1 if [1]\nX2\no1 endif",
        "o1 whatever",
        "o1 if 1\no1 endif",
        "G0 X#<nothing>",
        "G0 X[1/0]",
        "G0 X SQRT[-1]",
        "G0 X ACOS[2]",
        "G0 X LN[0]",
        "G0 X[[-8]**0.5]",
        "G0 X[1+]",
        "G0 X[1",
        "G0 X#0",
        "G0 X#6000",
        "#5420=1",
        "#<_x>=1",
        "#1",
        "#1 5",
        "G0 X#1.5",
        "G0 XATAN[1]",
        "G0 XSIN 30",
        "G[1.55] X1",
        "M[1.5]",
    ] {
        refused(text);
    }
}

#[test]
fn errors_name_line_and_way_out() {
    let error = run("G21\no1 while [1]\no1 endwhile\n", &[]).unwrap_err();
    assert_eq!((error.rule.name(), error.line), ("endless", 3));
    let error = run("G21\nG0 X1\n  o7 if [1]\nX2\nM2\n", &[]).unwrap_err();
    assert_eq!(
        (error.rule.name(), error.line, error.message.as_str()),
        ("o-word", 3, "what begins here has no end")
    );
    let error = run("o<gone> call\n", &[]).unwrap_err();
    assert_eq!(error.file, "main.ngc");
    assert!(error.message.contains("gone.ngc"), "{error}");
}

#[test]
fn a_control_that_is_not_fresh_does_not_know_what_no_block_has_set() {
    let settings = Settings::new(Dialect::LinuxCnc, [false; 3]);
    for (text, message) in [
        ("G0 X#100\n", "no block has set #100"),
        ("G0 X1\n#1=#5421\n", "where Y stands is not known"),
        ("#1=#5221\n", "set up at the machine"),
        ("T1 M6\n#1=#5403\n", "the units of the machine"),
        ("#1=#5070\n", "known only at the machine"),
        ("#1=#<_hal[a.b]>\n", "known only at the machine"),
    ] {
        let text = format!("G21\n{text}");
        let error = read(&settings, "a", text.as_bytes(), &mut |_| Ok(())).unwrap_err();
        assert!(error.message.contains(message), "{error}");
    }
}

#[test]
fn files_are_called_from_the_given_folders_and_errors_name_them() {
    let folder = temporary(&[
        (
            "outer.ngc",
            "(words before)\no<outer> sub\nG0 X#1\no<inner> call [#1 + 1]\no<outer> endsub\n",
        ),
        ("inner.ngc", "%\no<inner> sub\nX#1\no<inner> endsub\n%\n"),
        ("bad.ngc", "o<bad> sub\n\nG0 X[1/0]\no<bad> endsub\n"),
        ("other.ngc", "o<another> sub\no<another> endsub\n"),
        ("short.ngc", "o<short> sub\nG0 X1\n"),
        ("100.ngc", "o100\nG0 X7\nM99\n"),
    ]);
    let folders = [folder.path().to_path_buf()];
    let text = "G21\n\nO<OUTER> CALL [3]\nG0 X9\nM98 P100\nM2\n";
    let records = run(text, &folders).unwrap();
    let moves: Vec<(u32, f64)> =
        records.iter().filter_map(|(l, op)| op.position().map(|p| (*l, p.point.x))).collect();
    // Moves of another file carry the line of the call.
    assert_eq!(moves, [(3, 3.0), (3, 4.0), (4, 9.0), (5, 7.0)]);
    if let Some(Some(difference)) = difference(text.as_bytes(), [false; 3], &folders) {
        panic!("{difference}");
    }
    let error = |name: &str| run(&format!("G21\no<{name}> call\n"), &folders).unwrap_err();
    assert_eq!((error("bad").file.as_str(), error("bad").line), ("bad.ngc", 3));
    assert!(error("other").message.contains("does not define"), "{}", error("other"));
    assert_eq!((error("short").file.as_str(), error("short").line), ("short.ngc", 1));
    assert_eq!(error("../bad").file, "main.ngc");
    assert!(run("G21\no<outer> call\n", &[Path::new("/nowhere").into()]).is_err());
}

#[test]
fn messages_show_values_and_block_delete_skips() {
    let text = "G21\n#1=2.5 #<n>=3\n(debug, depth #1 of #<n> and #<none>)\n(print,now #[#<n>-2])\n\
                /G0 X5\nG0 X1\n/o1 if [1]\nM2\n";
    let op = |text: &str| Action::Message(text.into());
    let on = |block_delete: bool| {
        let setup = Setup { start: Some(Vec3::ZERO), block_delete, ..Setup::default() };
        let settings = Settings { setup, ..Settings::new(Dialect::LinuxCnc, [false; 3]) };
        crate::common::ops(&settings, "a", text)
    };
    let ops = on(true).unwrap();
    assert_eq!(ops[0], op("depth 2.500000 of 3.000000 and ######"));
    assert_eq!(ops[1], Action::Comment("now 2.500000".into()));
    assert_eq!(ops.iter().filter_map(Action::position).count(), 1);
    assert!(on(false).is_err(), "the if has no end");
}

/// A random expression and its value.
#[derive(Clone, Debug)]
enum Tree {
    Number(i32),
    Negative(Box<Tree>),
    Binary(Box<Tree>, &'static str, Box<Tree>),
    Function(&'static str, Box<Tree>),
}

impl Tree {
    /// Fully in brackets.
    fn write(&self) -> String {
        match self {
            Tree::Number(n) => format!("{}", f64::from(*n) / 4.0),
            Tree::Negative(a) => format!("[-{}]", a.write()),
            Tree::Binary(a, operator, b) => format!("[{} {operator} {}]", a.write(), b.write()),
            Tree::Function(name, a) => format!("{name}[{}]", a.write()),
        }
    }

    fn value(&self) -> f64 {
        let truth = |holds: bool| f64::from(u8::from(holds));
        match self {
            Tree::Number(n) => f64::from(*n) / 4.0,
            Tree::Negative(a) => -a.value(),
            Tree::Binary(a, operator, b) => {
                let (a, b) = (a.value(), b.value());
                match *operator {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "GT" => truth(a > b),
                    "LT" => truth(a < b),
                    "AND" => truth(a != 0.0 && b != 0.0),
                    "OR" => truth(a != 0.0 || b != 0.0),
                    _ => truth((a != 0.0) != (b != 0.0)),
                }
            }
            Tree::Function(name, a) => match *name {
                "abs" => a.value().abs(),
                "FIX" => a.value().floor(),
                "Fup" => a.value().ceil(),
                _ => a.value().to_radians().sin(),
            },
        }
    }
}

fn trees() -> impl Strategy<Value = Tree> {
    (-40..40).prop_map(Tree::Number).prop_recursive(5, 30, 2, |inner| {
        let operators =
            proptest::sample::select(vec!["+", "-", "*", "GT", "LT", "AND", "OR", "XOR"]);
        let functions = proptest::sample::select(vec!["abs", "FIX", "Fup", "sin"]);
        prop_oneof![
            (inner.clone(), operators, inner.clone()).prop_map(|(a, o, b)| Tree::Binary(
                a.into(),
                o,
                b.into()
            )),
            inner.clone().prop_map(|a| Tree::Negative(a.into())),
            (functions, inner).prop_map(|(f, a)| Tree::Function(f, a.into())),
        ]
    })
}

/// A chain of operators without brackets, evaluated by rank.
fn chain(numbers: &[i32], operators: &[&'static str]) -> f64 {
    let ranks: [&[&str]; 4] = [&["*"], &["+", "-"], &["GT", "LT"], &["AND", "OR", "XOR"]];
    let mut values: Vec<f64> = numbers.iter().map(|&n| f64::from(n)).collect();
    let mut operators = operators.to_vec();
    for rank in ranks {
        while let Some(n) = operators.iter().position(|o| rank.contains(o)) {
            let number = |v: f64| Box::new(Tree::Number((v * 4.0) as i32));
            let operator = operators.remove(n);
            let result = Tree::Binary(number(values[n]), operator, number(values[n + 1])).value();
            values.splice(n..n + 2, [result]);
        }
    }
    values[0]
}

/// A random program in pieces.
#[derive(Clone, Debug)]
enum Piece {
    Step(i32),
    If(bool, Vec<Piece>, Vec<Piece>),
    Repeat(u8, Vec<Piece>),
    While(u8, Option<u8>, Vec<Piece>),
    Call(u8, Vec<Piece>),
}

/// What makes O numbers and variables different from each other.
#[derive(Default)]
struct Writer {
    text: String,
    subroutines: String,
    number: u32,
}

impl Writer {
    fn next(&mut self) -> u32 {
        self.number += 1;
        self.number
    }

    fn write(&mut self, pieces: &[Piece]) {
        use std::fmt::Write as _;
        for piece in pieces {
            let n = self.next();
            match piece {
                Piece::Step(by) => writeln!(self.text, "G91 G0 X{by}").unwrap(),
                Piece::If(holds, yes, no) => {
                    let holds = if *holds { "2 GT 1" } else { "1 GT 2" };
                    writeln!(self.text, "o{n} if [{holds}]").unwrap();
                    self.write(yes);
                    writeln!(self.text, "o{n} else").unwrap();
                    self.write(no);
                    writeln!(self.text, "o{n} endif").unwrap();
                }
                Piece::Repeat(times, body) => {
                    writeln!(self.text, "o{n} repeat [{times}]").unwrap();
                    self.write(body);
                    writeln!(self.text, "o{n} endrepeat").unwrap();
                }
                Piece::While(times, stop, body) => {
                    let (variable, inner) = (1000 + n, self.next());
                    writeln!(self.text, "#{variable}=0\no{n} while [#{variable} LT {times}]")
                        .unwrap();
                    writeln!(self.text, "#{variable}=[#{variable}+1]").unwrap();
                    if let Some(stop) = stop {
                        writeln!(
                            self.text,
                            "o{inner} if [#{variable} EQ {stop}]\no{n} break\no{inner} endif"
                        )
                        .unwrap();
                    }
                    self.write(body);
                    writeln!(self.text, "o{n} endwhile").unwrap();
                }
                Piece::Call(argument, body) => {
                    let outside = std::mem::take(&mut self.text);
                    writeln!(self.text, "o{n} sub\nG91 G0 X#1").unwrap();
                    self.write(body);
                    writeln!(self.text, "o{n} endsub").unwrap();
                    self.subroutines.push_str(&std::mem::replace(&mut self.text, outside));
                    writeln!(self.text, "o{n} call [{argument}]").unwrap();
                }
            }
        }
    }
}

/// The steps that the pieces make.
fn steps(pieces: &[Piece], made: &mut Vec<f64>) {
    for piece in pieces {
        match piece {
            Piece::Step(by) => made.push(f64::from(*by)),
            Piece::If(true, body, _) | Piece::If(false, _, body) => steps(body, made),
            Piece::Repeat(times, body) => (0..*times).for_each(|_| steps(body, made)),
            Piece::While(times, stop, body) => {
                let rounds =
                    stop.filter(|stop| (1..=*times).contains(stop)).map_or(*times, |s| s - 1);
                (0..rounds).for_each(|_| steps(body, made));
            }
            Piece::Call(argument, body) => {
                made.push(f64::from(*argument));
                steps(body, made);
            }
        }
    }
}

fn pieces() -> impl Strategy<Value = Vec<Piece>> {
    let step = (1..9).prop_map(Piece::Step);
    let piece = step.prop_recursive(4, 40, 4, |inner| {
        let body = || proptest::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            (any::<bool>(), body(), body()).prop_map(|(c, a, b)| Piece::If(c, a, b)),
            (0..3u8, body()).prop_map(|(n, b)| Piece::Repeat(n, b)),
            (0..3u8, proptest::option::of(1..4u8), body())
                .prop_map(|(n, s, b)| Piece::While(n, s, b)),
            (1..9u8, body()).prop_map(|(n, b)| Piece::Call(n, b)),
        ]
    });
    proptest::collection::vec(piece, 1..6)
}

proptest! {
    #[test]
    fn random_expressions_have_their_value(tree in trees()) {
        let value = tree.value();
        prop_assume!(value.abs() < 1e9);
        let x = path(&format!("G21\n#1={}\nG0 X#1\n", tree.write()))[0];
        prop_assert!((x - value).abs() <= 1e-9 * value.abs().max(1.0), "{x} {value}");
    }

    #[test]
    fn operators_go_by_rank(
        numbers in proptest::collection::vec(0..9i32, 2..7),
        operators in proptest::collection::vec(
            proptest::sample::select(vec!["+", "-", "*", "GT", "LT", "AND", "OR", "XOR"]), 6),
    ) {
        let operators = &operators[..numbers.len() - 1];
        let mut text = numbers[0].to_string();
        for (operator, number) in operators.iter().zip(&numbers[1..]) {
            text += &format!(" {operator} {number}");
        }
        prop_assert_eq!(path(&format!("G21\nG0 X[{text}]\n"))[0], chain(&numbers, operators));
    }

    #[test]
    fn random_structured_programs_make_their_steps(pieces in pieces()) {
        let mut writer = Writer::default();
        writer.write(&pieces);
        let mut made = Vec::new();
        steps(&pieces, &mut made);
        let mut at = 0.0;
        let expected: Vec<f64> = made.iter().map(|step| { at += step; at }).collect();
        let before = path(&format!("G21\n{}{}M2\n", writer.subroutines, writer.text));
        prop_assert_eq!(&before, &expected);
        let behind = path(&format!("G21\n{}M2\n{}", writer.text, writer.subroutines));
        prop_assert_eq!(&behind, &expected);
    }

    #[test]
    fn any_flow_is_refused_or_run_but_never_panics(
        tokens in proptest::collection::vec(
            proptest::sample::select(vec![
                "o1", "o<a>", "o#1", "O2 ", "o[1]", " sub", " endsub", " call", " return", " if", " elseif", " else",
                " endif", " while", " endwhile", " do", " repeat", " endrepeat", " break", " continue", "[", "]", "[1]",
                "[#1 LT 3]", "#1", "#<a>", "#<_b>", "=", "=[#1+1]", "##2", "1", "-2.5", "SIN[30]", "ATAN", "/", "+",
                "IF[#1 EQ 2]", "THEN", "GOTO", "GOTO 1", "N1 ", "WHILE", "DO1", "END1", "DO2", "END2", "G65 P2 A1.",
                "G66 P2 ", "G67", "M98 P2", "M99", "M99 P1", "M30", "G1 X#1 F9", "G0 ", "X", "Y2.", "M70", "M72", "M73",
                "(debug, #1)", "%", "/", "#3000=1", "#3006=1", "#5041", "EXISTS[", "\n", "\n", "\n", "\n",
            ]),
            0..60,
        ),
        dialect in proptest::sample::select(vec![
            Dialect::LinuxCnc, Dialect::Fanuc, Dialect::Haas, Dialect::Mach3, Dialect::Marlin,
        ]),
    ) {
        let text = tokens.concat();
        let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
        let settings = Settings { setup, ..Settings::new(dialect, [true; 3]) };
        let mut records = 0;
        let ran = read(&settings, "a", format!("G21\n{text}").as_bytes(), &mut |_| {
            records += 1;
            match records < 1000 {
                true => Ok(()),
                false => Err(Diagnostic::error(Rule::Stopped, "").at(1, b" ", 0, 1).into()),
            }
        });
        if let Err(error) = ran {
            prop_assert!(error.line > 0 && error.column > 0, "{error}\n{text}");
        }
    }
}

#[test]
fn comments_stand_between_the_arguments_of_a_call() {
    for call in ["[1] (c) [2]", "(d) [1] (c)[2] (e)", "(d [3]) [1](c)[2] ; e"] {
        agrees(&format!("o<a> sub\nG0 X#1 Y#2 Z0\no<a> endsub\no<a> call {call}"));
        assert_eq!(
            path(&format!("G21\no<a> sub\nG0 X#1\no<a> endsub\no<a> call {call}\nM2\n")),
            [1.0]
        );
    }
    assert_eq!(refused("o<a> sub\no<a> endsub\no<a> call [1] (c").rule.name(), "expression");
}
