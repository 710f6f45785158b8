//! Random structured programs: what they move to is what this file works out by itself, and what CEAD's
//! `nc-gcode-interpreter` says where it is installed (PyPI).

use crate::common::sinumerik::settings;
use program::Rule;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::fmt::Write;
use std::io::Write as _;
use std::process::{Command, Stdio};
use toolpost_control::read;

const VARIABLES: [&str; 4] = ["R1", "R[2]", "VALUE", "LIST[1]"];

/// An expression over the variables.
#[derive(Clone, Debug)]
enum Expression {
    Number(i32),
    Variable(usize),
    Sum(Box<Expression>, Box<Expression>),
    Difference(Box<Expression>, Box<Expression>),
    Product(Box<Expression>, i32),
    Half(Box<Expression>),
    Size(Box<Expression>),
}

/// A condition: two expressions compared, or two conditions joined.
#[derive(Clone, Debug)]
enum Condition {
    Compare(Expression, &'static str, Expression),
    Join(Box<Condition>, &'static str, Box<Condition>),
    Not(Box<Condition>),
}

/// A part of a program.
#[derive(Clone, Debug)]
enum Part {
    Move(Expression),
    Assign(usize, Expression),
    If(Condition, Vec<Part>, Vec<Part>),
    For(u32, Vec<Part>),
    While(u32, Vec<Part>),
    Repeat(u32, Vec<Part>),
    Loop(u32, Vec<Part>),
    JumpBack(u32, Vec<Part>),
    Case(Expression, Vec<Part>, Vec<Part>),
    /// Adds to a variable that it is given itself, and moves there.
    Call(usize, i32),
}

fn expression() -> impl Strategy<Value = Expression> {
    let leaf = prop_oneof![
        (-50i32..50).prop_map(Expression::Number),
        (0..VARIABLES.len()).prop_map(Expression::Variable),
    ];
    leaf.prop_recursive(3, 12, 2, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            (boxed(), boxed()).prop_map(|(a, b)| Expression::Sum(a, b)),
            (boxed(), boxed()).prop_map(|(a, b)| Expression::Difference(a, b)),
            (boxed(), -3i32..3).prop_map(|(a, b)| Expression::Product(a, b)),
            boxed().prop_map(Expression::Half),
            boxed().prop_map(Expression::Size),
        ]
    })
}

fn condition() -> impl Strategy<Value = Condition> {
    let operators = prop::sample::select(vec!["==", "<>", "<", ">", "<=", ">="]);
    let leaf = (expression(), operators, expression())
        .prop_map(|(a, operator, b)| Condition::Compare(a, operator, b));
    leaf.prop_recursive(2, 6, 2, |inner| {
        let words = prop::sample::select(vec!["AND", "OR", "XOR"]);
        let boxed = || inner.clone().prop_map(Box::new);
        prop_oneof![
            (boxed(), words, boxed()).prop_map(|(a, word, b)| Condition::Join(a, word, b)),
            boxed().prop_map(Condition::Not),
        ]
    })
}

fn parts() -> impl Strategy<Value = Vec<Part>> {
    let leaf = prop_oneof![
        expression().prop_map(Part::Move),
        (0..VARIABLES.len(), expression()).prop_map(|(v, e)| Part::Assign(v, e)),
        (0..VARIABLES.len(), -9i32..9).prop_map(|(v, n)| Part::Call(v, n)),
    ];
    let part = leaf.prop_recursive(3, 24, 4, |inner| {
        let body = || prop::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            (condition(), body(), body()).prop_map(|(c, a, b)| Part::If(c, a, b)),
            (0u32..4, body()).prop_map(|(n, b)| Part::For(n, b)),
            (0u32..4, body()).prop_map(|(n, b)| Part::While(n, b)),
            (1u32..4, body()).prop_map(|(n, b)| Part::Repeat(n, b)),
            (1u32..4, body()).prop_map(|(n, b)| Part::Loop(n, b)),
            (1u32..4, body()).prop_map(|(n, b)| Part::JumpBack(n, b)),
            (expression(), body(), body()).prop_map(|(e, a, b)| Part::Case(e, a, b)),
        ]
    });
    prop::collection::vec(part, 1..6)
}

impl Expression {
    fn write(&self) -> String {
        match self {
            Expression::Number(number) => number.to_string(),
            Expression::Variable(index) => VARIABLES[*index].into(),
            Expression::Sum(a, b) => format!("({}+{})", a.write(), b.write()),
            Expression::Difference(a, b) => format!("({}-{})", a.write(), b.write()),
            Expression::Product(a, b) => format!("{}*{b}", a.write()),
            Expression::Half(a) => format!("{}/2", a.write()),
            Expression::Size(a) => format!("ABS({})", a.write()),
        }
    }

    fn value(&self, values: &[f64; 4]) -> f64 {
        match self {
            Expression::Number(number) => f64::from(*number),
            Expression::Variable(index) => values[*index],
            Expression::Sum(a, b) => a.value(values) + b.value(values),
            Expression::Difference(a, b) => a.value(values) - b.value(values),
            Expression::Product(a, b) => a.value(values) * f64::from(*b),
            Expression::Half(a) => a.value(values) / 2.0,
            Expression::Size(a) => a.value(values).abs(),
        }
    }
}

impl Condition {
    fn write(&self) -> String {
        match self {
            Condition::Compare(a, operator, b) => {
                format!("({} {operator} {})", a.write(), b.write())
            }
            Condition::Join(a, word, b) => format!("({} {word} {})", a.write(), b.write()),
            Condition::Not(a) => format!("(NOT {})", a.write()),
        }
    }

    fn holds(&self, values: &[f64; 4]) -> bool {
        match self {
            Condition::Compare(a, operator, b) => {
                let (a, b) = (a.value(values), b.value(values));
                match *operator {
                    "==" => a == b,
                    "<>" => a != b,
                    "<" => a < b,
                    ">" => a > b,
                    "<=" => a <= b,
                    _ => a >= b,
                }
            }
            Condition::Join(a, word, b) => {
                let (a, b) = (a.holds(values), b.holds(values));
                match *word {
                    "AND" => a && b,
                    "OR" => a || b,
                    _ => a != b,
                }
            }
            Condition::Not(a) => !a.holds(values),
        }
    }
}

/// Writes parts. Every structure has a counter and labels of its own.
fn write(parts: &[Part], count: &mut u32, text: &mut String) {
    for part in parts {
        *count += 1;
        let n = *count;
        let counter = format!("COUNT_{n}");
        let mut inside = |parts: &[Part], text: &mut String| write(parts, count, text);
        match part {
            Part::Move(e) => writeln!(text, "X={}", e.write()).unwrap(),
            Part::Assign(v, e) => writeln!(text, "{}={}", VARIABLES[*v], e.write()).unwrap(),
            Part::If(condition, then, otherwise) => {
                writeln!(text, "IF {}", condition.write()).unwrap();
                inside(then, text);
                if !otherwise.is_empty() {
                    text.push_str("ELSE\n");
                    inside(otherwise, text);
                }
                text.push_str("ENDIF\n");
            }
            Part::For(turns, body) => {
                writeln!(text, "FOR {counter}=1 TO {turns}").unwrap();
                inside(body, text);
                text.push_str("ENDFOR\n");
            }
            Part::While(turns, body) => {
                writeln!(text, "{counter}=0\nWHILE {counter}<{turns}\n{counter}={counter}+1")
                    .unwrap();
                inside(body, text);
                text.push_str("ENDWHILE\n");
            }
            Part::Repeat(turns, body) => {
                writeln!(text, "{counter}=0\nREPEAT\n{counter}={counter}+1").unwrap();
                inside(body, text);
                writeln!(text, "UNTIL {counter}>={turns}").unwrap();
            }
            Part::Loop(turns, body) => {
                writeln!(text, "{counter}=0\nLOOP\n{counter}={counter}+1").unwrap();
                inside(body, text);
                writeln!(text, "IF {counter}=={turns} GOTOF OUT_{n}\nENDLOOP\nOUT_{n}:").unwrap();
            }
            Part::JumpBack(turns, body) => {
                writeln!(text, "{counter}=0\nBACK_{n}: {counter}={counter}+1").unwrap();
                inside(body, text);
                writeln!(text, "IF {counter}<{turns} GOTOB BACK_{n}").unwrap();
            }
            Part::Case(e, zero, other) => {
                let e = e.write();
                writeln!(text, "CASE({e}) OF 0 GOTOF ZERO_{n} DEFAULT GOTOF REST_{n}").unwrap();
                writeln!(text, "ZERO_{n}:").unwrap();
                inside(zero, text);
                writeln!(text, "GOTOF END_{n}\nREST_{n}:").unwrap();
                inside(other, text);
                writeln!(text, "END_{n}:").unwrap();
            }
            Part::Call(v, by) => {
                writeln!(text, "WHAT={}\nADD(WHAT,{by})\n{}=WHAT", VARIABLES[*v], VARIABLES[*v])
                    .unwrap();
            }
        }
    }
}

/// Works out where parts move to.
fn moved(parts: &[Part], values: &mut [f64; 4], xs: &mut Vec<f64>) {
    for part in parts {
        match part {
            Part::Move(e) => xs.push(e.value(values)),
            Part::Assign(v, e) => values[*v] = e.value(values),
            Part::If(condition, then, otherwise) => {
                let branch = if condition.holds(values) { then } else { otherwise };
                moved(branch, values, xs);
            }
            Part::For(turns, body)
            | Part::While(turns, body)
            | Part::Repeat(turns, body)
            | Part::Loop(turns, body)
            | Part::JumpBack(turns, body) => {
                for _ in 0..*turns {
                    moved(body, values, xs);
                }
            }
            Part::Case(e, zero, other) => {
                moved(if e.value(values) == 0.0 { zero } else { other }, values, xs);
            }
            Part::Call(v, by) => {
                values[*v] += f64::from(*by);
                xs.push(values[*v]);
            }
        }
    }
}

fn program(parts: &[Part]) -> String {
    let (mut body, mut count) = (String::new(), 0);
    write(parts, &mut count, &mut body);
    let mut text = String::from("DEF REAL VALUE=3, LIST[2]=SET(0,4), WHAT\n");
    for n in 1..=count {
        writeln!(text, "DEF INT COUNT_{n}").unwrap();
    }
    if body.contains("R1") || body.contains("R[") {
        text.push_str("R1=1\nR2=2\n");
    }
    text + "G0 X0\n" + &body + "M30\n"
}

fn run(text: &str) -> Vec<f64> {
    let records =
        crate::common::sinumerik::run(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    records.iter().filter_map(|record| Some(record.action.position()?.point.x)).collect()
}

proptest! {
    #[test]
    fn a_random_program_moves_where_its_parts_say(parts in parts()) {
        let called = "%_N_ADD_SPF\nPROC ADD(VAR REAL AA, INT BY)\nAA=AA+BY\nX=AA\nM17\n";
        let text = format!("%_N_MAIN_MPF\n{}{called}", program(&parts));
        let mut xs = vec![0.0];
        moved(&parts, &mut [1.0, 2.0, 3.0, 4.0], &mut xs);
        prop_assert_eq!(run(&text), xs, "{}", text);
    }
}

/// Pieces of the language, of which a random program is made.
const PIECES: &[&str] = &[
    "IF",
    "ELSE",
    "ENDIF",
    "FOR",
    "TO",
    "ENDFOR",
    "WHILE",
    "ENDWHILE",
    "REPEAT",
    "UNTIL",
    "LOOP",
    "ENDLOOP",
    "REPEATB",
    "GOTOF",
    "GOTOB",
    "GOTO",
    "GOTOC",
    "GOTOS",
    "CASE",
    "OF",
    "DEFAULT",
    "LAB",
    "LAB:",
    "ENDLABEL:",
    "P=2",
    "DEF",
    "REAL",
    "INT",
    "STRING[9]",
    "BOOL",
    "AXIS",
    "VALUE",
    "AA[2]",
    "=",
    "==",
    "<>",
    "<",
    "<<",
    "+",
    "-",
    "*",
    "/",
    "DIV",
    "MOD",
    "(",
    ")",
    "[",
    "]",
    ",",
    "\"T\"",
    "NOT",
    "AND",
    "B_OR",
    "R1",
    "R[R1]",
    "1",
    "0",
    "2.5",
    "'HF'",
    "TRUE",
    "SIN",
    "SUBSTR",
    "SET",
    "REP",
    "$AA_IW[X]",
    "$P_UIFR[1,X,TR]",
    "PROC",
    "SUB",
    "CALL",
    "VAR",
    "SAVE",
    "M17",
    "M30",
    "RET",
    "G0",
    "G1",
    "G2",
    "X1",
    "Y2",
    "Z3",
    "X=",
    "CR=5",
    "AP=30",
    "RP=5",
    "G111",
    "ANG=30",
    "RND=1",
    "CHF=1",
    "RNDM=1",
    "FRC=5",
    "F100",
    "S100",
    "M3",
    "G41",
    "G40",
    "D1",
    "G54",
    "TRANS",
    "ATRANS",
    "ROT",
    "SCALE",
    "MIRROR",
    "G58",
    "MCALL",
    "CYCLE81(10,0,2,-5)",
    "HOLES2(0,0,9,0,0,3)",
    "CT",
    "G33",
    "K1",
    "G331",
    "POS[X]=1",
    "SPOS=0",
    "DIAMON",
    "G18",
    "MSG(",
    "SETAL(66000)",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n",
    "\n%_N_SUB_SPF\n",
];

proptest! {
    #[test]
    fn any_mixture_of_words_ends_or_is_refused_in_its_line(
        pieces in prop::collection::vec(prop::sample::select(PIECES), 0..60),
        start in any::<bool>(),
    ) {
        let begin = if start { "R1=1\nG1 X0 Y0 Z0 F100 D1\n" } else { "" };
        let text = format!("{begin}{}\nM30\n", pieces.join(" "));
        let mut settings = settings();
        settings.setup.start = start.then_some(geom::Vec3::ZERO);
        let mut most = 5000;
        let result = read(&settings, "p.mpf", text.as_bytes(), &mut |_| {
            most -= 1;
            if most == 0 { Err(program::Diagnostic::error(Rule::Stopped, "").into()) } else { Ok(()) }
        });
        if let Err(error) = result {
            prop_assert!(error.is_error() && error.line as usize <= text.lines().count());
        }
    }
}

/// The X positions after each block that the outside interpreter finds in `programs`, or its error;
/// nothing where it is not installed.
fn judged(programs: &[String]) -> Option<Vec<String>> {
    let script = "import sys\nfrom nc_gcode_interpreter import nc_to_dataframe\n\
                  for p in sys.stdin.read().split('\\0'):\n    \
                  try:\n        d, _ = nc_to_dataframe(p, iteration_limit=100000)\n        \
                  print(' '.join(str(x) for x in d['X'] if x is not None))\n    \
                  except ValueError as e:\n        print(repr(e))\n";
    let mut child = Command::new(judge::python("nc_gcode_interpreter")?)
        .args(["-c", script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(programs.join("\0").as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "the interpreter stops: {}", output.status);
    let text = String::from_utf8(output.stdout).unwrap();
    Some(text.lines().map(str::to_owned).collect())
}

#[test]
fn an_outside_interpreter_moves_there_too() {
    // Its release on PyPI (0.1.9) knows these words not yet.
    let unknown =
        ["R1", "R[", "ABS", "GOTO", "REPEAT", "LOOP", "CASE", "AND", "OR ", "NOT", "ADD(", "BACK_"];
    let (mut runner, parts) = (TestRunner::deterministic(), parts());
    let programs: Vec<String> =
        std::iter::repeat_with(|| program(&parts.new_tree(&mut runner).unwrap().current()))
            .filter(|text| {
                let body = text.split_once("G0 X0").unwrap().1;
                body.contains("END") && !unknown.iter().any(|word| text.contains(word))
            })
            .take(40)
            .collect();
    let Some(judged) = judged(&programs) else { return };
    assert_eq!(programs.len(), judged.len());
    for (text, judged) in programs.iter().zip(judged) {
        let numbers: Result<Vec<f64>, _> = judged.split(' ').map(str::parse).collect();
        let mut judged = numbers.unwrap_or_else(|_| panic!("{judged}\n{text}"));
        let mut xs = run(text);
        // It says where X is after every block, also where that does not move.
        judged.dedup();
        xs.dedup();
        let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9;
        let equal = xs.len() == judged.len() && xs.iter().zip(&judged).all(same);
        assert!(equal, "{xs:?}\nnot\n{judged:?}\n{text}");
    }
}
