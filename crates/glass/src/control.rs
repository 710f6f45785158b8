//! Virtual machines: a program in, the places where the axes stop and the laser fires out. Nothing here knows how programs are written.
//!
//! A line that is not understood ends the reading with an error, and a coordinate that no line has stated is not zero.

use crate::machine::{Coordinate, Format, Machine};
use geom::ending::go_on;
use program::{Diagnostic, Rule};

/// A pulse of the laser.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulse {
    /// The line of the program, from 1; of a binary program the number of the pulse.
    pub line: u32,
    /// Where the axes are, mm or degrees.
    pub at: [f64; 3],
    /// Ticks since the pulse before, where both are fired in one motion at constant speed; else 0.
    pub passed: u32,
}

/// The pulses of a program, in their order.
#[derive(Clone, Debug, PartialEq)]
pub enum Pulses {
    /// Pulses with their lines.
    Listed(Vec<Pulse>),
    /// Pulses of a binary program, in whole steps of each axis, and how many of those are a mm or a degree.
    Whole(Vec<[i32; 3]>, [f64; 3]),
}

impl Default for Pulses {
    fn default() -> Pulses {
        Pulses::Listed(Vec::new())
    }
}

impl Pulses {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Pulses::Listed(pulses) => pulses.len(),
            Pulses::Whole(places, _) => places.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The pulse of this number, from 0.
    pub fn get(&self, number: usize) -> Option<Pulse> {
        match self {
            Pulses::Listed(pulses) => pulses.get(number).copied(),
            Pulses::Whole(places, steps) => {
                let line = u32::try_from(number + 1).unwrap_or(u32::MAX);
                let place = places.get(number)?;
                let at = [0, 1, 2].map(|axis| f64::from(place[axis]) / steps[axis]);
                Some(Pulse { line, at, passed: 0 })
            }
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Pulse> + Clone {
        (0..self.len()).filter_map(|number| self.get(number))
    }
}

/// A motion at constant speed in which pulses are fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Its first pulse, from 0.
    pub first: u32,
    /// How many pulses it has.
    pub count: u32,
    /// How far each axis goes in a tick, mm or degrees.
    pub speed: [f64; 3],
}

/// A place where the axes stop and the laser does not fire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The line of the program, from 1.
    pub line: u32,
    /// Where each axis stands, mm; `None` where no line has sent it anywhere.
    pub at: [Option<f64>; 3],
    /// How many pulses were made before.
    pub pulses: u32,
}

/// What a program does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// The sides of the block that the program states, mm.
    pub block: Option<[f64; 3]>,
    /// How many equal blocks it states.
    pub blocks: Option<u32>,
    /// The fields of a scanner: the first pulse of each, from 0, the line, and the middle of the field in the block, mm.
    pub fields: Vec<(u32, u32, [f64; 2])>,
    /// Its motions at constant speed, in their order.
    pub motions: Vec<Motion>,
    /// Its pulses, in their order.
    pub pulses: Pulses,
    /// Where else the axes stop, in their order.
    pub stops: Vec<Stop>,
}

/// Runs the program `text` on `machine`.
///
/// # Errors
/// The first line that the machine would not take, or that the program ends too early.
pub fn read(text: &[u8], machine: &Machine) -> Result<Run, Vec<Diagnostic>> {
    let read = match machine.program.format {
        Format::Numbered => numbered(text, machine),
        Format::Points => points(text),
        Format::Binary => binary(text, machine).map_err(|message| (0, message)),
        Format::Gcode => gcode(text, machine),
    };
    let run = read.map_err(|(line, message)| {
        let mut found = Diagnostic::error(Rule::GlassProgram, message);
        if let Some(before) = line.checked_sub(1) {
            let shown = text.split(|byte| *byte == b'\n').nth(before).unwrap_or_default();
            found = found.on(u32::try_from(line).unwrap_or(u32::MAX), shown);
        }
        vec![found.help("write the program anew; docs/sources/glass.md says what a program is")]
    })?;
    if run.pulses.len() as u64 > machine.program.points {
        let message = format!(
            "{} pulses are more than the {} that the controller holds",
            run.pulses.len(),
            machine.program.points
        );
        return Err(vec![Diagnostic::error(Rule::Points, message).help("take fewer points")]);
    }
    Ok(run)
}

/// The bytes of the mark, three sides and the count, and of the sum.
const HEAD: usize = 8 + 12 + 8;
const SUM: usize = 4;

fn binary(bytes: &[u8], machine: &Machine) -> Result<Run, String> {
    let whole = |at: usize| -> Option<i32> {
        Some(i32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
    };
    if !bytes.starts_with(b"TPGLASS1") || bytes.len() < HEAD + SUM {
        return Err(String::from("the program does not begin with TPGLASS1, or is cut off"));
    }
    let (own, sum) = bytes.split_at(bytes.len() - SUM);
    let stated =
        bytes[HEAD - 8..HEAD].iter().rev().fold(0u64, |sum, byte| sum << 8 | u64::from(*byte));
    let held = own.len() - HEAD;
    if !held.is_multiple_of(12) || stated != (held / 12) as u64 {
        return Err(format!("{} bytes of pulses where {stated} pulses are stated", held));
    }
    if crc32fast::hash(own).to_le_bytes() != *sum {
        return Err(String::from("the sum of the bytes is not the one that is stated"));
    }
    let pulse = |at| Some([whole(at)?, whole(at + 4)?, whole(at + 8)?]);
    let pulses = (HEAD..own.len()).step_by(12).filter_map(pulse).collect();
    let block = pulse(8).map(|sides| sides.map(|side| f64::from(side) / 1e3));
    let steps = machine.coordinates().map(|of| of.steps());
    Ok(Run { block, pulses: Pulses::Whole(pulses, steps), ..Run::default() })
}

/// A line, from 1 (0 of a binary program), and what is wrong with it.
type Wrong = (usize, String);

/// The lines of a program with their numbers, as words. Every line ends with a line feed.
fn lines(text: &[u8]) -> Result<impl Iterator<Item = (usize, &str)>, Wrong> {
    let text = std::str::from_utf8(text).map_err(|error| {
        let before = &text[..error.valid_up_to()];
        (1 + before.iter().filter(|byte| **byte == b'\n').count(), String::from("is not UTF-8"))
    })?;
    if !text.is_empty() && !text.ends_with('\n') {
        return Err((
            text.lines().count(),
            String::from("the last line has no end: the program is cut off"),
        ));
    }
    let asked = |_: &(usize, &str)| go_on();
    Ok(text.lines().enumerate().inspect(asked).map(|(i, line)| (i + 1, line)))
}

/// A whole number: digits alone, without a sign.
fn whole(word: &str) -> Option<u64> {
    let digits = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    digits.then(|| word.parse().ok()).flatten()
}

/// A plain decimal number: sign, digits, point, digits.
fn decimal(word: &str) -> Option<f64> {
    let digits = word.strip_prefix('-').unwrap_or(word);
    let plain = digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    let number = plain && digits.bytes().any(|byte| byte.is_ascii_digit());
    number.then(|| word.parse().ok()).flatten().filter(|value: &f64| value.is_finite())
}

/// Reads three coordinates, such as `X… Y… Z…`, all of them in this order.
fn place<'w>(
    words: &mut impl Iterator<Item = &'w str>,
    names: [&str; 3],
) -> Result<[f64; 3], String> {
    let mut at = [0.0; 3];
    for (value, name) in at.iter_mut().zip(names) {
        let word = words.next().and_then(|word| word.strip_prefix(name));
        *value =
            word.and_then(decimal).ok_or_else(|| format!("{name} and a number are needed here"))?;
    }
    Ok(at)
}

/// A motion at constant speed as it is read: its speed, and where it has come to.
struct Moving {
    speed: [f64; 3],
    /// The first pulse, and the ticks since then.
    from: Option<([f64; 3], u32)>,
}

impl Moving {
    /// The ticks since the pulse before at which the axes pass `to`, and where they are then; `None` where they never do.
    fn pass(&mut self, to: [f64; 3], axes: &[Coordinate; 3]) -> Option<(u32, [f64; 3])> {
        let Some((from, since)) = self.from else {
            self.from = Some((to, 0));
            return Some((0, to));
        };
        // The axis that moves most steps says how long it took.
        let steps = |axis: &usize| (self.speed[*axis] * axes[*axis].steps()).abs();
        let fastest = (0..3).max_by(|a, b| steps(a).total_cmp(&steps(b)))?;
        let speed = self.speed[fastest];
        let before = from[fastest] + speed * f64::from(since);
        let mut ticks = (to[fastest] - before) / speed;
        if axes[fastest].endless {
            ticks = ticks.rem_euclid(360.0 / speed.abs());
        }
        let ticks = ticks.round();
        if !(1.0..=1e9).contains(&ticks) {
            return None;
        }
        let since = since.checked_add(ticks as u32)?;
        let at = [0, 1, 2].map(|axis| {
            let at = from[axis] + self.speed[axis] * f64::from(since);
            if axes[axis].endless { at.rem_euclid(360.0) } else { at }
        });
        let is_near = |axis: usize| {
            let off = to[axis] - at[axis];
            let off = if axes[axis].endless { off - 360.0 * (off / 360.0).round() } else { off };
            // What whole steps of both ends take.
            off.abs() * axes[axis].steps() <= 1.0 + 1e-3
        };
        self.from = Some((from, since));
        (0..3).all(is_near).then_some((ticks as u32, at))
    }
}

/// The numbered form, `Nn` before each command: BEGIN, PULSE, RUN with the speed of each axis in a tick, REST, END.
fn numbered(text: &[u8], machine: &Machine) -> Result<Run, Wrong> {
    let axes = machine.coordinates();
    let names = axes.map(|axis| axis.word);
    // From the trigger to the pulse the axes go on.
    let late = machine.late();
    let mut moving: Option<Moving> = None;
    let mut run = Run::default();
    let mut pulses = Vec::new();
    let mut promised: Option<u64> = None;
    let mut ended = false;
    let mut last = 0;
    for (at, line) in lines(text)? {
        last = at;
        let wrong = |message: &str| Err((at, String::from(message)));
        if ended {
            return wrong("nothing may follow END");
        }
        let mut words = line.split(' ');
        let number = words.next().and_then(|word| word.strip_prefix('N'));
        if number.and_then(whole) != Some(at as u64) {
            return Err((at, format!("the line must have the number N{at}")));
        }
        match (words.next(), promised) {
            (Some("BEGIN"), None) => {
                if words.next() != Some("BLOCK") {
                    return wrong("BEGIN needs BLOCK and its sides");
                }
                let sides = place(&mut words, ["X", "Y", "Z"]).map_err(|message| (at, message))?;
                run.block = Some(sides);
                let count = (words.next() == Some("POINTS")).then(|| words.next()).flatten();
                promised = count.and_then(whole);
                if promised.is_none() {
                    return wrong("BEGIN needs POINTS and their number");
                }
                if let Some(word) = words.next() {
                    let blocks = (word == "BLOCKS").then(|| words.next()).flatten().and_then(whole);
                    let most = u64::from(machine.blocks());
                    let blocks = blocks.filter(|blocks| (1..=most).contains(blocks));
                    let Some(blocks) = blocks else {
                        return Err((
                            at,
                            format!("BLOCKS and a number from 1 to {most} are needed"),
                        ));
                    };
                    run.blocks = Some(blocks as u32);
                }
            }
            (Some("PULSE"), Some(_)) => {
                let place = place(&mut words, names).map_err(|message| (at, message))?;
                let number = u32::try_from(at).unwrap_or(u32::MAX);
                let [shift_x, shift_y] = match (run.fields.last(), machine.stage) {
                    (Some((_, _, center)), _) => *center,
                    (None, Some(_)) => return wrong("a pulse before the first FIELD"),
                    (None, None) => [0.0; 2],
                };
                let place = [place[0] + shift_x, place[1] + shift_y, place[2]];
                let (mut passed, mut fired) = (0, place);
                if let Some(moving) = &mut moving {
                    let Some((ticks, there)) = moving.pass(place, &axes) else {
                        return wrong("the motion at constant speed passes this place on no tick");
                    };
                    passed = ticks;
                    fired = [0, 1, 2].map(|axis| there[axis] + moving.speed[axis] * late);
                    run.motions.iter_mut().last().into_iter().for_each(|motion| motion.count += 1);
                }
                pulses.push(Pulse { line: number, at: fired, passed });
            }
            (Some("FIELD"), Some(_)) if machine.stage.is_some() => {
                let mut center = [0.0; 2];
                for (value, name) in center.iter_mut().zip(["X", "Y"]) {
                    let number = words.next().and_then(|word| word.strip_prefix(name));
                    let Some(number) = number.and_then(decimal) else {
                        return wrong("FIELD needs X and Y");
                    };
                    *value = number;
                }
                let first = u32::try_from(pulses.len()).unwrap_or(u32::MAX);
                if run.fields.last().is_some_and(|(before, _, _)| *before == first) {
                    return wrong("there is no pulse in the field before");
                }
                run.fields.push((first, u32::try_from(at).unwrap_or(u32::MAX), center));
            }
            (Some("RUN"), Some(_)) if moving.is_none() && machine.program.runs => {
                let speed = place(&mut words, names).map_err(|message| (at, message))?;
                let steps = [0, 1, 2].map(|axis: usize| speed[axis] * axes[axis].steps());
                if !machine.clock().allows(steps) {
                    return wrong("an axis is not as fast as that");
                }
                if steps.iter().all(|speed| speed.abs() < 1e-3) {
                    return wrong("RUN needs a speed of at least one axis");
                }
                let first = u32::try_from(pulses.len()).unwrap_or(u32::MAX);
                run.motions.push(Motion { first, count: 0, speed });
                moving = Some(Moving { speed, from: None });
            }
            (Some("REST"), Some(_)) if moving.is_some() => {
                if run.motions.last().is_some_and(|motion| motion.count == 0) {
                    return wrong("there is no pulse between RUN and REST");
                }
                moving = None;
            }
            (Some("END"), Some(_)) if moving.is_some() => {
                return wrong("REST is missing before END");
            }
            (Some("END"), Some(count)) => {
                if pulses.len() as u64 != count {
                    return Err((
                        at,
                        format!("{} pulses where BEGIN states {count}", pulses.len()),
                    ));
                }
                ended = true;
            }
            (_, None) => return wrong("a program begins with BEGIN"),
            (_, Some(_)) => {
                return wrong(
                    "PULSE or END is needed here, or RUN and REST on a machine with `runs`",
                );
            }
        }
        if words.next().is_some() {
            return wrong("the command has a word too many");
        }
    }
    run.pulses = Pulses::Listed(pulses);
    if ended { Ok(run) } else { Err((last, String::from("the program has no END"))) }
}

fn points(text: &[u8]) -> Result<Run, Wrong> {
    let mut pulses = Vec::new();
    for (at, line) in lines(text)? {
        if line.starts_with('#') {
            continue;
        }
        let values: Option<Vec<f64>> = line.split(' ').map(decimal).collect();
        let Some(Ok(place)) = values.map(<[f64; 3]>::try_from) else {
            return Err((at, String::from("three numbers are needed: X Y Z")));
        };
        pulses.push(Pulse { line: u32::try_from(at).unwrap_or(u32::MAX), at: place, passed: 0 });
    }
    Ok(Run { pulses: Pulses::Listed(pulses), ..Run::default() })
}

/// The G-code of LinuxCNC and GRBL, as far as an engraver needs it: G21, G90, G0 with X, Y and Z, the word that fires, and M2 or
/// M30. G1 is none of its words: it needs a feed, and how long it takes depends on that.
struct Gcode<'f> {
    fire: &'f str,
    /// What its axes are called.
    names: [&'static str; 3],
    metric: bool,
    absolute: bool,
    rapid: bool,
    ended: bool,
    at: [Option<f64>; 3],
    /// The line of a motion after which the laser has not fired.
    open: Option<u32>,
    run: Run,
    pulses: Vec<Pulse>,
}

/// Whether a line is a comment and nothing more: what stands between two comments is run.
fn is_comment(line: &str) -> bool {
    let inner = line.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    line.starts_with(';') || inner.is_some_and(|inner| !inner.contains(['(', ')']))
}

impl Gcode<'_> {
    /// Notes the place of a motion after which the laser did not fire.
    fn pass(&mut self) {
        if let Some(line) = self.open.take() {
            let pulses = u32::try_from(self.pulses.len()).unwrap_or(u32::MAX);
            self.run.stops.push(Stop { line, at: self.at, pulses });
        }
    }

    fn line(&mut self, number: u32, line: &str) -> Result<(), String> {
        if line.is_empty() || is_comment(line) {
            return Ok(());
        }
        if self.ended {
            return Err(String::from("nothing may follow the end of the program"));
        }
        if line == self.fire {
            let [Some(x), Some(y), Some(z)] = self.at else {
                return Err(String::from("a pulse where not every axis has been sent to a place"));
            };
            self.open = None;
            self.pulses.push(Pulse { line: number, at: [x, y, z], passed: 0 });
            return Ok(());
        }
        if ["M2", "M30"].contains(&line) {
            self.ended = true;
            self.pass();
            return Ok(());
        }
        let mut sent = [None; 3];
        for word in line.split_whitespace() {
            match word {
                "G21" => self.metric = true,
                "G90" => self.absolute = true,
                "G0" => self.rapid = true,
                _ => {
                    let axis = self.names.iter().position(|name| word.starts_with(name));
                    let (Some(axis), Some(value)) = (axis, word.get(1..).and_then(decimal)) else {
                        return Err(format!("`{word}` is no word of this machine"));
                    };
                    if !(self.metric && self.absolute && self.rapid) {
                        return Err(String::from("an axis moves before G21, G90 and G0 are set"));
                    }
                    if sent[axis].replace(value).is_some() {
                        return Err(format!("`{word}` is the second word of its axis in the line"));
                    }
                }
            }
        }
        if sent.iter().any(Option::is_some) {
            self.pass();
            self.at = [0, 1, 2].map(|axis| sent[axis].or(self.at[axis]));
            self.open = Some(number);
        }
        Ok(())
    }
}

fn gcode(text: &[u8], machine: &Machine) -> Result<Run, Wrong> {
    let mut machine = Gcode {
        fire: machine.program.fire.as_deref().unwrap_or_default(),
        names: machine.coordinates().map(|of| of.word),
        metric: false,
        absolute: false,
        rapid: false,
        ended: false,
        at: [None; 3],
        open: None,
        run: Run::default(),
        pulses: Vec::new(),
    };
    let mut last = 0;
    for (number, line) in lines(text)? {
        last = number;
        let own = u32::try_from(number).unwrap_or(u32::MAX);
        machine.line(own, line.trim()).map_err(|message| (number, message))?;
    }
    match machine.ended {
        true => Ok(Run { pulses: Pulses::Listed(machine.pulses), ..machine.run }),
        false => Err((last, String::from("the program has no end (M2)"))),
    }
}
