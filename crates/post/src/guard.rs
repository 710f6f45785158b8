//! What a template may say.
//!
//! The engine counts steps and caps what is written, but neither sees a value that grows while it is
//! built: forty doublings by `~` take forty steps. So a template is held, before it is compiled,
//! against a part of Jinja in which no value can be longer than [`MOST_PARTS`] values of the program
//! end to end, and every filter is one of a short list.

use crate::catalogue::WordName;
use machine::{Machine, OptionValue};
use minijinja::machinery::ast::{BinOpKind, CallArg, CompareOpKind, Expr, Filter, ForLoop, Stmt};
use minijinja::machinery::ast::{Test, UnaryOpKind};
use minijinja::machinery::{Span, parse};
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Rest, Value, ValueOrKwargs};
use minijinja::{Environment, Error, ErrorKind, State, filters, functions, tests};
use program::{Rule, nearest};
use std::collections::BTreeMap;
use std::ops::Range;

/// The longest template with statements, bytes.
const LONGEST: usize = 8 << 10;

/// How deep an expression may nest: `1+1+1` is two deep.
const DEEPEST: usize = 100;

/// The most values that one value may be put together from.
const MOST_PARTS: usize = 64;

/// The most bytes that `replace` and `format` may give.
const MOST_REPLACED: usize = 16 << 10;

/// The most turns of a loop over `range`.
const MOST_TURNS: usize = 1000;

type Install = fn(&mut Environment, &'static str);

/// The filters, and how each comes into the engine.
const FILTERS: &[(&str, Install)] = &[
    ("abs", |engine, name| engine.add_filter(name, filters::abs)),
    ("d", |engine, name| engine.add_filter(name, filters::default)),
    ("default", |engine, name| engine.add_filter(name, filters::default)),
    ("first", |engine, name| engine.add_filter(name, filters::first)),
    ("float", |engine, name| engine.add_filter(name, filters::float)),
    ("format", |engine, name| engine.add_filter(name, format)),
    ("int", |engine, name| engine.add_filter(name, filters::int)),
    ("last", |engine, name| engine.add_filter(name, filters::last)),
    ("length", |engine, name| engine.add_filter(name, filters::length)),
    ("lower", |engine, name| engine.add_filter(name, filters::lower)),
    ("replace", |engine, name| engine.add_filter(name, replace)),
    ("round", |engine, name| engine.add_filter(name, filters::round)),
    ("trim", |engine, name| engine.add_filter(name, filters::trim)),
    ("upper", |engine, name| engine.add_filter(name, filters::upper)),
];

/// The tests: `is defined`.
const TESTS: &[(&str, Install)] = &[
    ("defined", |engine, name| engine.add_test(name, tests::is_defined)),
    ("divisibleby", |engine, name| engine.add_test(name, divisible)),
    ("endingwith", |engine, name| engine.add_test(name, tests::is_endingwith)),
    ("even", |engine, name| engine.add_test(name, tests::is_even)),
    ("none", |engine, name| engine.add_test(name, tests::is_none)),
    ("number", |engine, name| engine.add_test(name, tests::is_number)),
    ("odd", |engine, name| engine.add_test(name, tests::is_odd)),
    ("startingwith", |engine, name| engine.add_test(name, tests::is_startingwith)),
    ("string", |engine, name| engine.add_test(name, tests::is_string)),
    ("undefined", |engine, name| engine.add_test(name, tests::is_undefined)),
];

/// An engine that knows nothing but what stands here.
pub(crate) fn engine<'a>() -> Environment<'a> {
    let mut engine = Environment::empty();
    for (name, install) in FILTERS.iter().chain(TESTS) {
        install(&mut engine, name);
    }
    engine.add_function("range", range);
    engine
}

fn refused(why: String) -> Error {
    Error::new(ErrorKind::InvalidOperation, why)
}

fn replace(text: &str, from: &str, to: &str) -> Result<String, Error> {
    if text.len() + text.matches(from).count() * to.len() > MOST_REPLACED {
        return Err(refused(format!("`replace` gives more than {MOST_REPLACED} bytes")));
    }
    Ok(text.replace(from, to))
}

/// A width stands in the text or, with `*`, by a value: `'%1000000000d'` takes a gigabyte.
fn format(state: &mut State, text: &Value, rest: Rest<ValueOrKwargs>) -> Result<Value, Error> {
    let shape = text.as_str().unwrap_or_default();
    let widths = shape.split(|c: char| !c.is_ascii_digit());
    if widths.map(str::len).max() > Some(2) || shape.contains('*') {
        return Err(refused("`format` takes a width of at most two digits, and no `*`".into()));
    }
    filters::format(state, text, rest)
}

/// The engine's own test panics where it divides by 0.
fn divisible(value: i64, by: i64) -> Result<bool, Error> {
    let rest = value.checked_rem(by).ok_or_else(|| refused(format!("{by} divides nothing")))?;
    Ok(rest == 0)
}

/// The engine counts the turns as the difference of two `isize`, which overflows for large ones.
fn range(lower: i32, upper: Option<i32>, step: Option<i32>) -> Result<Value, Error> {
    let wide = |value: Option<i32>| value.map(|value| value as isize);
    let turns = functions::range(lower as isize, wide(upper), wide(step))?;
    if turns.len().is_none_or(|turns| turns > MOST_TURNS) {
        return Err(refused(format!("`range` has more than {MOST_TURNS} numbers")));
    }
    Ok(turns)
}

/// What a template says that it may not: the rule, what is wrong, the way out, and the bytes it stands at.
pub(crate) struct Refusal {
    pub(crate) rule: Rule,
    pub(crate) message: String,
    pub(crate) help: String,
    pub(crate) place: Range<usize>,
}

type Checked<T> = Result<T, Box<Refusal>>;

/// Why a template is not compiled.
pub(crate) enum Fault {
    /// The engine does not understand it.
    Syntax(Error),
    /// It says what it may not.
    Refused(Box<Refusal>),
}

/// Holds `text` against the part of Jinja that templates may use.
///
/// # Errors
/// The first place at which it leaves that part.
pub(crate) fn check(text: &str, machine: &Machine) -> Result<(), Fault> {
    if text.len() > LONGEST {
        let message = format!("{} bytes are too much for a block with statements", text.len());
        let help = format!("at most {LONGEST} bytes");
        let place = 0..text.len();
        let refusal = Refusal { rule: Rule::TemplateOutput, message, help, place };
        return Err(Fault::Refused(Box::new(refusal)));
    }
    let parsed = parse(text, "", SyntaxConfig::default()).map_err(Fault::Syntax)?;
    let mut guard = Guard { machine, names: BTreeMap::new(), loops: 0, depth: 0 };
    guard.statement(&parsed).map_err(Fault::Refused)
}

/// What a value is, as far as it is known before the template runs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Number,
    /// Text, a flag, or something undefined.
    Text,
    /// A value with members: `tool`.
    Group(&'static str),
    /// `program.tools`.
    Tools,
}

/// A value: its kind, and how many values of the program it holds at most, end to end.
type Shape = (Kind, usize);

/// The values with members.
const GROUPS: [&str; 9] =
    ["coolant", "cut", "machine", "operation", "options", "place", "program", "spindle", "tool"];

struct Guard<'m> {
    machine: &'m Machine,
    /// Values that the template itself has named.
    names: BTreeMap<String, Shape>,
    /// How many loops are open.
    loops: usize,
    /// How deep the expression at hand nests.
    depth: usize,
}

impl Guard<'_> {
    fn statements(&mut self, all: &[Stmt]) -> Checked<()> {
        all.iter().try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Stmt) -> Checked<()> {
        match statement {
            Stmt::Template(template) => self.statements(&template.children),
            Stmt::EmitRaw(_) => Ok(()),
            Stmt::EmitExpr(emit) => self.plain(&emit.expr).map(drop),
            Stmt::IfCond(cond) => {
                self.shape(&cond.expr)?;
                self.statements(&cond.true_body)?;
                self.statements(&cond.false_body)
            }
            Stmt::ForLoop(turns) => self.turns(turns),
            Stmt::Set(set) if self.loops == 0 => {
                let value = self.plain(&set.expr)?;
                self.name(&set.target, value)
            }
            Stmt::Set(set) => {
                let message = "`set` stands in a loop, where a value could grow with each turn";
                refuse(Rule::TemplateOutput, message, "put `set` before the loop", set.span())
            }
            Stmt::WithBlock(other) => unknown(other.span()),
            Stmt::SetBlock(other) => unknown(other.span()),
            Stmt::AutoEscape(other) => unknown(other.span()),
            Stmt::FilterBlock(other) => unknown(other.span()),
            Stmt::Do(other) => unknown(other.span()),
        }
    }

    fn turns(&mut self, turns: &ForLoop) -> Checked<()> {
        let over = match &turns.iter {
            Expr::Call(call) if matches!(&call.expr, Expr::Var(name) if name.id == "range") => {
                self.arguments(&call.args, call.span())?;
                Some(Kind::Number)
            }
            list if self.shape(list)?.0 == Kind::Tools => Some(Kind::Group("tool")),
            _ => None,
        };
        let Some(kind) = over.filter(|_| !turns.recursive) else {
            let message = "this is nothing that a loop can go over";
            let help = "`for` goes over `program.tools` or `range(...)`, and is not recursive";
            return refuse(Rule::Template, message, help, turns.iter.span());
        };
        let outside = self.names.clone();
        self.name(&turns.target, (kind, 1))?;
        self.names.insert("loop".into(), (Kind::Group("loop"), 1));
        self.loops += 1;
        turns.filter_expr.as_ref().map_or(Ok(()), |only| self.shape(only).map(drop))?;
        self.statements(&turns.body)?;
        self.loops -= 1;
        self.names = outside;
        self.statements(&turns.else_body)
    }

    /// Gives a value a name. One that is named in two branches is what both have in common.
    fn name(&mut self, target: &Expr, (kind, parts): Shape) -> Checked<()> {
        let Expr::Var(name) = target else {
            return refuse(Rule::Template, "a single name is needed here", "", target.span());
        };
        let taken = GROUPS.contains(&name.id) || ["text", "loop", "range"].contains(&name.id);
        if taken || WordName::named(name.id).is_some() {
            let message = format!("`{}` has a meaning already", name.id);
            return refuse(Rule::TemplateName, message, "take another name", name.span());
        }
        let (before, most) = self.names.get(name.id).copied().unwrap_or((kind, parts));
        let kind = if before == kind { kind } else { Kind::Text };
        self.names.insert(name.id.into(), (kind, parts.max(most)));
        Ok(())
    }

    /// The parts of a value that can be written: a number or a text.
    fn plain(&mut self, expression: &Expr) -> Checked<Shape> {
        let shape = self.shape(expression)?;
        written(shape, expression.span())
    }

    fn shape(&mut self, expression: &Expr) -> Checked<Shape> {
        let span = expression.span();
        self.depth += 1;
        if self.depth > DEEPEST {
            return refuse(Rule::TemplateOutput, "this nests too deep", "write it in pieces", span);
        }
        let shape = self.nested(expression, span)?;
        self.depth -= 1;
        Ok(shape)
    }

    fn nested(&mut self, expression: &Expr, span: Span) -> Checked<Shape> {
        match expression {
            Expr::Const(value) => {
                let kind = if value.value.is_number() { Kind::Number } else { Kind::Text };
                Ok((kind, 1))
            }
            Expr::Var(name) => Ok(match self.names.get(name.id) {
                Some(shape) => *shape,
                None => match GROUPS.iter().find(|group| **group == name.id) {
                    Some(group) => (Kind::Group(group), 1),
                    None => (Kind::Text, 1),
                },
            }),
            Expr::GetAttr(get) => match self.shape(&get.expr)? {
                (Kind::Group(group), _) => self.member(group, get.name, span),
                _ => no_members(span),
            },
            Expr::GetItem(get) => match (self.shape(&get.expr)?.0, &get.subscript_expr) {
                (Kind::Group(group), Expr::Const(name)) => {
                    self.member(group, name.value.as_str().unwrap_or_default(), span)
                }
                (Kind::Tools, Expr::Const(_)) => Ok((Kind::Group("tool"), 1)),
                _ => no_members(span),
            },
            Expr::Slice(slice) => {
                let shape = self.plain(&slice.expr)?;
                for end in [&slice.start, &slice.stop, &slice.step].into_iter().flatten() {
                    self.plain(end)?;
                }
                Ok(shape)
            }
            Expr::UnaryOp(unary) => match unary.op {
                UnaryOpKind::Not => self.shape(&unary.expr).map(|_| (Kind::Text, 1)),
                UnaryOpKind::Neg => self.number(&unary.expr, "-"),
            },
            Expr::BinOp(binary) => {
                let sign = match binary.op {
                    BinOpKind::Concat => {
                        let (left, right) = (self.plain(&binary.left)?, self.plain(&binary.right)?);
                        return Ok((Kind::Text, left.1 + right.1));
                    }
                    BinOpKind::ScAnd | BinOpKind::ScOr => {
                        let (left, right) = (self.shape(&binary.left)?, self.shape(&binary.right)?);
                        return Ok(either(left, right));
                    }
                    BinOpKind::In => {
                        self.plain(&binary.left)?;
                        return self.members(&binary.right);
                    }
                    BinOpKind::Add => "+",
                    BinOpKind::Sub => "-",
                    BinOpKind::Mul => "*",
                    BinOpKind::Div => "/",
                    BinOpKind::FloorDiv => "//",
                    BinOpKind::Rem => "%",
                    BinOpKind::Pow => "**",
                    _ => {
                        self.plain(&binary.left)?;
                        self.plain(&binary.right)?;
                        return Ok((Kind::Text, 1));
                    }
                };
                self.number(&binary.left, sign)?;
                self.number(&binary.right, sign)
            }
            Expr::Compare(compare) => {
                self.plain(&compare.expr)?;
                for op in &compare.ops {
                    match op.op {
                        CompareOpKind::In | CompareOpKind::NotIn => self.members(&op.expr)?,
                        _ => self.plain(&op.expr)?,
                    };
                }
                Ok((Kind::Text, 1))
            }
            Expr::IfExpr(choice) => {
                self.shape(&choice.test_expr)?;
                let yes = self.shape(&choice.true_expr)?;
                let no = choice.false_expr.as_ref().map(|no| self.shape(no)).transpose()?;
                Ok(either(yes, no.unwrap_or((Kind::Text, 1))))
            }
            Expr::Filter(filter) => self.filter(filter, span),
            Expr::Test(test) => self.test(test, span),
            Expr::Call(_) => {
                refuse(Rule::TemplateName, "there are no functions but `range` of a loop", "", span)
            }
            Expr::List(_) | Expr::Tuple(_) | Expr::Map(_) => {
                refuse(Rule::Template, "a list stands only behind `in`", "", span)
            }
        }
    }

    /// What stands behind `in`: a text, or a list of values.
    fn members(&mut self, expression: &Expr) -> Checked<Shape> {
        let items = match expression {
            Expr::List(list) => &list.items,
            Expr::Tuple(tuple) => &tuple.items,
            text => return self.plain(text).map(|_| (Kind::Text, 1)),
        };
        items.iter().try_for_each(|item| self.plain(item).map(drop))?;
        Ok((Kind::Text, 1))
    }

    fn member(&self, group: &'static str, name: &str, span: Span) -> Checked<Shape> {
        let kind = match (group, name) {
            ("program", "tools") => Kind::Tools,
            ("tool", "number" | "diameter" | "corner_radius" | "length") => Kind::Number,
            ("loop", "index" | "index0" | "revindex" | "revindex0" | "length") => Kind::Number,
            ("loop", "first" | "last") => Kind::Text,
            ("loop", _) => {
                let help = "it has index, index0, revindex, revindex0, length, first, last";
                return refuse(Rule::TemplateName, "`loop` has no such member", help, span);
            }
            ("options", name) => match self.machine.options.get(name) {
                Some(OptionValue::Number(_)) => Kind::Number,
                _ => Kind::Text,
            },
            _ => Kind::Text,
        };
        Ok((kind, 1))
    }

    fn number(&mut self, expression: &Expr, sign: &str) -> Checked<Shape> {
        if self.shape(expression)?.0 == Kind::Number {
            return Ok((Kind::Number, 1));
        }
        let message = format!("`{sign}` needs a number here");
        let help = "`|float` or `|int` makes a number of a text, `~` puts texts together; a word has \
                    no value in a template";
        refuse(Rule::TemplateOutput, message, help, expression.span())
    }

    fn filter(&mut self, filter: &Filter, span: Span) -> Checked<Shape> {
        known("filter", filter.name, FILTERS, span)?;
        let Some(on) = &filter.expr else { return unknown(span) };
        let (kind, parts) = self.shape(on)?;
        let arguments = self.arguments(&filter.args, span)?;
        match (kind, filter.name) {
            (Kind::Tools, "length") => return Ok((Kind::Number, 1)),
            (Kind::Tools, "first" | "last") => return Ok((Kind::Group("tool"), 1)),
            _ => written((kind, parts), on.span())?,
        };
        let numbers = arguments.iter().all(|argument| argument.0 == Kind::Number);
        Ok(match filter.name {
            "length" => (Kind::Number, 1),
            // What cannot be made a number is given as the argument says.
            "int" | "float" | "abs" if arguments.is_empty() => (Kind::Number, 1),
            "round" => (Kind::Number, 1),
            "default" | "d" => arguments.into_iter().fold((kind, parts), either),
            "format" | "int" | "float" => {
                let kind =
                    if filter.name != "format" && numbers { Kind::Number } else { Kind::Text };
                (kind, parts + arguments.iter().map(|argument| argument.1).sum::<usize>())
            }
            _ => (Kind::Text, parts),
        })
    }

    fn test(&mut self, test: &Test, span: Span) -> Checked<Shape> {
        known("test", test.name, TESTS, span)?;
        self.shape(&test.expr)?;
        self.arguments(&test.args, span)?;
        Ok((Kind::Text, 1))
    }

    fn arguments(&mut self, arguments: &[CallArg], span: Span) -> Checked<Vec<Shape>> {
        let shapes = arguments.iter().map(|argument| match argument {
            CallArg::Pos(value) => self.plain(value),
            _ => refuse(Rule::Template, "arguments are given without names", "", span),
        });
        shapes.collect()
    }
}

/// A value that can be written: a number or a text, not too long.
fn written((kind, parts): Shape, span: Span) -> Checked<Shape> {
    let help = match kind {
        Kind::Group(_) => "name the member that is meant, such as `tool.number`",
        Kind::Tools => "`{% for t in program.tools %}` goes over them",
        Kind::Number | Kind::Text if parts > MOST_PARTS => {
            let message = format!("this is put together from more than {MOST_PARTS} values");
            return refuse(Rule::TemplateOutput, message, "write it in pieces", span);
        }
        Kind::Number | Kind::Text => return Ok((kind, parts)),
    };
    refuse(Rule::Template, "this has members and is no text", help, span)
}

/// One or the other of two values.
fn either(one: Shape, other: Shape) -> Shape {
    let kind = match (one.0, other.0) {
        (a, b) if a == b => a,
        (Kind::Number | Kind::Text, Kind::Number | Kind::Text) => Kind::Text,
        (Kind::Number | Kind::Text, members) | (members, _) => members,
    };
    (kind, one.1.max(other.1))
}

fn known(what: &str, name: &str, table: &[(&str, Install)], span: Span) -> Checked<()> {
    let names = || table.iter().map(|(name, _)| *name);
    if names().any(|known| known == name) {
        return Ok(());
    }
    let near = nearest(name, names());
    let near = if near.is_empty() { near } else { format!("did you mean {near}? ") };
    let all: Vec<_> = names().collect();
    let help = format!("{near}there are {}", all.join(", "));
    refuse(Rule::TemplateName, format!("there is no {what} `{name}`"), help, span)
}

fn unknown<T>(span: Span) -> Checked<T> {
    refuse(Rule::Template, "templates have no such statement", STATEMENTS, span)
}

/// The way out where a statement is not one of these.
const STATEMENTS: &str = "the statements are `if`, `for` and `set`";

/// The way out of what the engine does not understand: the text up to where that is, in which the last opened sign may lack its end.
pub(crate) fn way_out(before: &str) -> String {
    let opened = |sign: &str, end: &str| {
        let at = before.rfind(sign)?;
        (!before[at..].contains(end)).then_some((at, sign.to_owned(), end.to_owned()))
    };
    match opened("{%", "%}").max(opened("{{", "}}")) {
        Some((_, sign, end)) => {
            format!("what begins with `{sign}` ends with `{end}`; {STATEMENTS}")
        }
        None => STATEMENTS.into(),
    }
}

fn no_members<T>(span: Span) -> Checked<T> {
    refuse(Rule::TemplateName, "this has no such member", "`toolpost explain` lists them", span)
}

fn refuse<T>(
    rule: Rule,
    message: impl Into<String>,
    help: impl Into<String>,
    span: Span,
) -> Checked<T> {
    let place = span.start_offset as usize..span.end_offset as usize;
    Err(Box::new(Refusal { rule, message: message.into(), help: help.into(), place }))
}
