//! HP-GL, the language of plotters: two letters, numbers, and a semicolon. A unit is 0.025 mm.
//!
//! Facts: Hewlett-Packard, *HP-GL/2 and HP RTL Reference Guide* (5959-9733). Curves that are drawn are read; text and what fills
//! areas is left out and counted. What changes where all else lies (`SC`, `RO`), and the packed form `PE`, is refused.

use super::{Count, Curve, Curves, arc, whole};
use crate::mesh::Fault;
use geom::ending::go_on;
use glam::DVec2;
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;

/// mm in a unit.
const UNIT: f64 = 0.025;

/// By how much chords leave arcs, units: 0.5 µm.
const TOLERANCE: f64 = 0.02;

/// Into how many chords a Bézier curve is divided.
const CHORDS: u32 = 64;

/// Commands that draw nothing and move nothing.
const QUIET: [&[u8; 2]; 45] = [
    b"AC", b"AS", b"CA", b"CF", b"CO", b"CP", b"CR", b"CS", b"CT", b"DI", b"DR", b"DV", b"EC",
    b"EP", b"ES", b"FR", b"FS", b"FT", b"IP", b"IR", b"LA", b"LM", b"LO", b"LT", b"MC", b"MG",
    b"MT", b"NP", b"PC", b"PG", b"PS", b"PT", b"PW", b"QL", b"RF", b"SA", b"SD", b"SI", b"SL",
    b"SM", b"SP", b"SR", b"SS", b"UL", b"VS",
];

/// Text and fillings, which are left out.
const LEFT_OUT: [(&[u8; 2], &str); 9] = [
    (b"LB", "LB, text"),
    (b"BL", "BL, text"),
    (b"PB", "PB, text"),
    (b"SB", "SB, text"),
    (b"FP", "FP, the filling of a polygon"),
    (b"RA", "RA, the filling of a rectangle"),
    (b"RR", "RR, the filling of a rectangle"),
    (b"WG", "WG, the filling of a wedge"),
    (b"IW", "IW, a window that cuts off what lies outside"),
];

/// Ends a text where `DT` says nothing else: ETX.
const ETX: u8 = 3;

pub(super) fn read(bytes: &[u8]) -> Result<Curves, Fault> {
    let mut text = Text { bytes, at: 0, line: 1, ends: ETX };
    let mut plotter = Plotter::default();
    while let Some((name, line)) = text.command()? {
        go_on();
        if let Some((_, kind)) = LEFT_OUT.iter().find(|(left_out, _)| **left_out == name) {
            plotter.left_out.entry(kind).or_insert((line, 0)).1 += 1;
        }
        match &name {
            b"LB" | b"BL" => text.skip_text(),
            b"DT" => text.terminator(),
            b"PE" => {
                let message = "PE, curves in packed form, is not read: switch that off in the program that wrote the file";
                return Err(Fault::new(Rule::Hpgl, message).line(line as usize));
            }
            _ => {
                let numbers = text.numbers()?;
                plotter.obey(name, &numbers, line)?;
            }
        }
    }
    plotter.lift();
    let warnings = plotter.left_out.into_iter().map(|(kind, (line, count))| {
        let warning = Diagnostic::warning(Rule::Hpgl, format!("{kind}: not read")).line(line);
        let warning = warning.help("draw it as curves, if it is to be engraved");
        Diagnostic { count, ..warning }
    });
    Ok(Curves { curves: plotter.curves, warnings: warnings.collect() })
}

/// The file as commands.
struct Text<'b> {
    bytes: &'b [u8],
    at: usize,
    line: u32,
    /// The byte that ends a text.
    ends: u8,
}

impl Text<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn step(&mut self) {
        self.line += u32::from(self.peek() == Some(b'\n'));
        self.at += 1;
    }

    /// The next command and its line.
    fn command(&mut self) -> Result<Option<([u8; 2], u32)>, Fault> {
        loop {
            match self.peek() {
                None => return Ok(None),
                // Escape sequences: `ESC . x…:` and `ESC . x`, `ESC % 0 B` and what ends with another capital.
                Some(0x1b) => self.skip_escape(),
                Some(byte) if byte.is_ascii_alphabetic() => break,
                Some(b';' | b',') => self.step(),
                Some(byte) if byte.is_ascii_whitespace() || byte < b' ' => self.step(),
                Some(byte) => {
                    let message = format!("a command is needed, not `{}`", byte.escape_ascii());
                    return Err(Fault::new(Rule::Hpgl, message).line(self.line as usize));
                }
            }
        }
        let line = self.line;
        let first = self.peek().unwrap_or_default().to_ascii_uppercase();
        self.step();
        match self.peek() {
            Some(second) if second.is_ascii_alphabetic() => {
                self.step();
                Ok(Some(([first, second.to_ascii_uppercase()], line)))
            }
            _ => {
                let message = format!("`{}` alone is no command", char::from(first));
                Err(Fault::new(Rule::Hpgl, message).line(line as usize))
            }
        }
    }

    fn skip_escape(&mut self) {
        self.step();
        let device = self.peek() == Some(b'.');
        self.step();
        match device {
            true => {
                let long = self.peek().is_some_and(|kind| b"@HIMNTPR".contains(&kind));
                self.step();
                while long && self.peek().is_some_and(|byte| byte != b':') {
                    self.step();
                }
                if long {
                    self.step();
                }
            }
            // Up to the capital that ends it.
            false => {
                while self.peek().is_some_and(|byte| !byte.is_ascii_uppercase()) {
                    self.step();
                }
                self.step();
            }
        }
    }

    fn skip_text(&mut self) {
        while self.peek().is_some_and(|byte| byte != self.ends) {
            self.step();
        }
        self.step();
    }

    fn terminator(&mut self) {
        match self.peek() {
            Some(b';') | None => self.ends = ETX,
            Some(byte) => {
                self.ends = byte;
                self.step();
                // The mode may follow.
                while self.peek().is_some_and(|byte| byte != b';' && !byte.is_ascii_alphabetic()) {
                    self.step();
                }
            }
        }
    }

    /// The numbers up to the next command.
    fn numbers(&mut self) -> Result<Vec<f64>, Fault> {
        let mut numbers = Vec::new();
        loop {
            match self.peek() {
                Some(b',') => self.step(),
                Some(byte) if byte.is_ascii_whitespace() => self.step(),
                Some(b'+' | b'-' | b'.' | b'0'..=b'9') => {
                    let start = self.at;
                    self.step();
                    while self.peek().is_some_and(|byte| byte.is_ascii_digit() || byte == b'.') {
                        self.step();
                    }
                    let word = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
                    let number = word.parse::<f64>().ok().filter(|number| number.abs() <= 1e9);
                    numbers.push(number.ok_or_else(|| {
                        let message = format!("`{word:.40}` is no number that a plotter takes");
                        Fault::new(Rule::Number, message).line(self.line as usize)
                    })?);
                }
                _ => return Ok(numbers),
            }
        }
    }
}

/// A plotter as it draws.
#[derive(Default)]
struct Plotter {
    /// Where the pen is, units.
    at: DVec2,
    down: bool,
    relative: bool,
    /// What the pen has drawn since it went down.
    drawn: Vec<DVec2>,
    curves: Vec<Curve>,
    count: Count,
    left_out: BTreeMap<&'static str, (u32, u32)>,
}

impl Plotter {
    fn obey(&mut self, name: [u8; 2], numbers: &[f64], line: u32) -> Result<(), Fault> {
        let shown = String::from_utf8_lossy(&name).into_owned();
        let wrong =
            |what: &str| Err(Fault::new(Rule::Hpgl, format!("{shown} {what}")).line(line as usize));
        let pairs = || numbers.chunks_exact(2).map(|pair| DVec2::new(pair[0], pair[1]));
        let is_moved = matches!(&name, b"PU" | b"PD" | b"PA" | b"PR");
        if is_moved && !numbers.len().is_multiple_of(2) {
            return wrong("has an X without a Y");
        }
        match &name {
            b"IN" => {
                self.lift();
                (self.at, self.relative) = (DVec2::ZERO, false);
            }
            b"DF" => self.relative = false,
            b"PU" => self.lift(),
            b"PD" => self.lower(),
            b"PA" => self.relative = false,
            b"PR" => self.relative = true,
            b"AA" | b"AR" => {
                let [x, y, angle, ..] = *numbers else {
                    return wrong("needs a centre and an angle");
                };
                let center = self.meant(DVec2::new(x, y), name == *b"AR");
                self.turn(center, angle.to_radians(), line)?;
            }
            b"AT" | b"RT" => {
                let [a, b, c, d, ..] = *numbers else { return wrong("needs two points") };
                let of = |x, y| self.meant(DVec2::new(x, y), name == *b"RT");
                self.through(of(a, b), of(c, d), line)?;
            }
            b"CI" => {
                let [radius, ..] = *numbers else { return wrong("needs a radius") };
                let center = self.at;
                self.apart(|pen| {
                    pen.go(center + DVec2::X * radius.abs(), line)?;
                    pen.lower();
                    pen.turn(center, std::f64::consts::TAU, line)
                })?;
            }
            b"EA" | b"ER" => {
                let [x, y, ..] = *numbers else { return wrong("needs a corner") };
                let (from, to) = (self.at, self.meant(DVec2::new(x, y), name == *b"ER"));
                self.apart(|pen| {
                    pen.lower();
                    let corners = [DVec2::new(to.x, from.y), to, DVec2::new(from.x, to.y), from];
                    corners.into_iter().try_for_each(|corner| pen.go(corner, line))
                })?;
            }
            b"EW" => {
                let [radius, start, sweep, ..] = *numbers else {
                    return wrong("needs a radius and two angles");
                };
                let center = self.at;
                self.apart(|pen| {
                    pen.lower();
                    pen.go(center + DVec2::from_angle(start.to_radians()) * radius, line)?;
                    pen.turn(center, sweep.to_radians(), line)?;
                    pen.go(center, line)
                })?;
            }
            b"BZ" | b"BR" => {
                if numbers.is_empty() || !numbers.len().is_multiple_of(6) {
                    return wrong("needs three points for each curve");
                }
                for curve in numbers.chunks_exact(6) {
                    let of =
                        |i: usize| self.meant(DVec2::new(curve[i], curve[i + 1]), name == *b"BR");
                    let [a, b, c, d] = [self.at, of(0), of(2), of(4)];
                    for i in 1..=CHORDS {
                        let t = f64::from(i) / f64::from(CHORDS);
                        let s = 1.0 - t;
                        let at = a * (s * s * s)
                            + b * (3.0 * s * s * t)
                            + c * (3.0 * s * t * t)
                            + d * (t * t * t);
                        self.go(if i == CHORDS { d } else { at }, line)?;
                    }
                }
            }
            // In a polygon the pen draws its edge.
            b"PM" => {}
            b"SC" | b"RO" if numbers.iter().all(|number| *number == 0.0) => {}
            b"SC" | b"RO" => {
                return wrong(
                    "moves or scales all that follows and is not read: switch it off in the program that wrote the file",
                );
            }
            _ if QUIET.contains(&&name) => {}
            _ if LEFT_OUT.iter().any(|(left_out, _)| **left_out == name) => {}
            _ => return wrong("is no command that is read"),
        }
        if is_moved {
            for to in pairs() {
                let to = self.meant(to, self.relative);
                self.go(to, line)?;
            }
        }
        Ok(())
    }

    fn meant(&self, at: DVec2, relative: bool) -> DVec2 {
        if relative { self.at + at } else { at }
    }

    fn go(&mut self, to: DVec2, line: u32) -> Result<(), Fault> {
        if self.down && to != self.at {
            self.count.more(1, line)?;
            self.drawn.push(to);
        }
        self.at = to;
        Ok(())
    }

    fn turn(&mut self, center: DVec2, sweep: f64, line: u32) -> Result<(), Fault> {
        let sweep = whole(sweep);
        let start = self.at;
        let is_whole = sweep.abs() > std::f64::consts::TAU - 1e-9;
        let corners: Vec<DVec2> = arc(start, center, sweep, TOLERANCE).collect();
        let (last, before) = corners.split_last().unwrap_or((&start, &[]));
        before.iter().try_for_each(|corner| self.go(*corner, line))?;
        self.go(if is_whole { start } else { *last }, line)
    }

    /// The arc through a point to another one; straight where they lie on a line.
    fn through(&mut self, middle: DVec2, to: DVec2, line: u32) -> Result<(), Fault> {
        let (b, c) = (middle - self.at, to - self.at);
        let area = 2.0 * b.perp_dot(c);
        if area.abs() < 1e-9 * (b.length_squared() + c.length_squared()) {
            self.go(middle, line)?;
            return self.go(to, line);
        }
        let (bb, cc) = (b.length_squared(), c.length_squared());
        let center = self.at + DVec2::new(c.y * bb - b.y * cc, b.x * cc - c.x * bb) / area;
        let turned = |to: DVec2| (self.at - center).angle_to(to - center);
        let left = area > 0.0;
        let sweep = turned(to);
        let tau = std::f64::consts::TAU;
        let sweep = if left { sweep.rem_euclid(tau) } else { -(-sweep).rem_euclid(tau) };
        self.turn(center, sweep, line)
    }

    /// Draws something of its own: the pen is then where and as it was.
    fn apart(&mut self, draw: impl FnOnce(&mut Plotter) -> Result<(), Fault>) -> Result<(), Fault> {
        let (at, down) = (self.at, self.down);
        self.lift_for_another();
        draw(self)?;
        self.lift();
        (self.at, self.down) = (at, false);
        if down {
            self.down = true;
            self.drawn.clear();
            self.drawn.push(at);
        }
        Ok(())
    }

    /// Lifts the pen; a line that has not begun yet is no point.
    fn lift_for_another(&mut self) {
        if self.drawn.len() < 2 {
            self.drawn.clear();
        }
        self.lift();
    }

    fn lower(&mut self) {
        if !std::mem::replace(&mut self.down, true) {
            self.drawn.push(self.at);
        }
    }

    fn lift(&mut self) {
        self.down = false;
        let corners: Vec<_> =
            self.drawn.drain(..).map(|corner| (corner * UNIT).extend(0.0)).collect();
        if !corners.is_empty() {
            self.curves.push(Curve { corners });
        }
    }
}
