//! Machines as text files: laser, axes, lenses, and how programs are written for them.
//!
//! This is all that the writer and the judge share.

use crate::chain::{Chain, Joint};
use crate::clock::{Clock, pump_limit};
use crate::polar::{Branch, Polar};
use crate::profile::{Limits, Profile};
use program::{Diagnostic, Misread, Rule};
use serde::Deserialize;

/// The machines that come with Toolpost: name and text.
pub const LIBRARY: [(&str, &str); 6] = [
    ("glass-xyz-50hz", include_str!("../machines/glass-xyz-50hz.toml")),
    ("glass-xyz-100hz", include_str!("../machines/glass-xyz-100hz.toml")),
    ("glass-xyz-200hz", include_str!("../machines/glass-xyz-200hz.toml")),
    ("glass-planar-200hz", include_str!("../machines/glass-planar-200hz.toml")),
    ("glass-galvo-1000hz", include_str!("../machines/glass-galvo-1000hz.toml")),
    ("glass-polar-100hz", include_str!("../machines/glass-polar-100hz.toml")),
];

/// A machine that engraves inside glass.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// What it is called.
    pub title: String,
    /// How it moves.
    pub kind: Kind,
    /// Its laser.
    pub laser: Laser,
    /// What holds for every axis.
    pub drive: Drive,
    /// Its axes.
    pub axes: Axes,
    /// Table and arm, of a polar machine only.
    #[serde(default)]
    pub polar: Option<Table>,
    /// What moves block and beam, of a machine by declared axes only.
    #[serde(default)]
    pub chain: Option<Chain>,
    /// What carries the block from field to field, of a scanner only.
    #[serde(default)]
    pub stage: Option<Stage>,
    /// Its lenses.
    pub lenses: Vec<Lens>,
    /// How its programs are written.
    pub program: Form,
}

/// How a machine moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The block in X and Y, the lens in Z.
    Xyz,
    /// The blocks on a turning table, the lens on an arm, and in Z.
    Polar,
    /// By declared axes: two in the plane, each on block or beam, and the lens in Z.
    Chain,
    /// Mirrors in a field, the lens in Z, the block on a stage from field to field.
    Galvo,
}

/// The stage of a scanner: where the middle of its field is in the block.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Along the block's first side.
    pub x: Axis,
    /// Along its second side.
    pub y: Axis,
}

/// A turning table with blocks, and an arm with the lens (spec 2.16), mm.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// From the table's axis to the arm's.
    pub distance: f64,
    /// Length of the arm.
    pub arm: f64,
    /// From the table's axis to the near side of each block.
    pub offset: f64,
    /// Radius of the table.
    pub radius: f64,
    /// Places for blocks, evenly around the table.
    pub blocks: u32,
    /// Which way the elbow bends.
    pub branch: Branch,
}

impl Table {
    /// Its lengths, with a block of `side` mm across.
    pub fn with(&self, side: f64) -> Polar {
        Polar { side, distance: self.distance, offset: self.offset, arm: self.arm }
    }

    /// Why blocks of these sides cannot lie on it, side by side; `None` where they can.
    pub fn refuses(&self, [x, y, _]: [f64; 3]) -> Option<String> {
        let reach = (0.5 * x).hypot(self.offset + y);
        if reach > self.radius {
            return Some(format!(
                "the corners of the block are {reach:.1} mm from the table's axis, and the table has a radius of {} mm",
                self.radius
            ));
        }
        // Neighbours meet where the near side is as wide as the angle between them leaves room.
        let room = 2.0 * self.offset * (std::f64::consts::PI / f64::from(self.blocks)).tan();
        (self.blocks > 2 && x > room).then(|| {
            format!(
                "{} blocks of {x} mm do not lie side by side on the table: {room:.1} mm are the most",
                self.blocks
            )
        })
    }
}

/// A coordinate of a program, and the axis that it moves.
#[derive(Clone, Copy, Debug)]
pub struct Coordinate {
    /// The word in programs.
    pub word: &'static str,
    /// Decimals of the word.
    pub decimals: u32,
    /// Whether it is an angle.
    pub turns: bool,
    /// Whether it turns on and on: 360° is 0°.
    pub endless: bool,
    /// What the axis can do.
    pub axis: Axis,
}

impl Coordinate {
    /// Steps of a program's word in a mm or a degree.
    pub fn steps(&self) -> f64 {
        f64::from(10_u32.pow(self.decimals))
    }

    /// What the axis can do, in mm or degrees.
    pub fn limits(&self) -> Limits {
        let Axis { acceleration, speed, .. } = self.axis;
        match self.turns {
            true => Limits { acceleration, speed },
            false => Limits::metric(acceleration, speed),
        }
    }
}

/// A pulsed laser.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Laser {
    /// Pulses, Hz.
    pub rate: f64,
    /// Wavelength, nm.
    pub wavelength: f64,
    /// Diameter of the beam at the lens, mm.
    pub beam: f64,
    /// Equal beams, each over a block of its own: all fire at once.
    #[serde(default = "one")]
    pub channels: u32,
    /// Distance of those beams along X, mm; of several only.
    #[serde(default)]
    pub channel_distance: f64,
    /// Energy that the pump takes for a pulse, J: where it is stated, that of a second must be below 1000 W.
    #[serde(default)]
    pub pump: Option<f64>,
    /// Energy of a pulse, mJ, before it is divided among the beams that are open.
    #[serde(default)]
    pub energy: Option<f64>,
    /// From the place at which a pulse in motion is asked for until it fires, µs.
    #[serde(default)]
    pub delay: f64,
}

/// A laser has one beam where nothing else is said.
fn one() -> u32 {
    1
}

/// What holds for every axis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// The speed profile.
    pub profile: Profile,
}

/// The three axes.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axes {
    /// Along the block's first side; of a polar machine the arm, of a scanner its first mirror,
    /// of declared axes the first.
    #[serde(alias = "arm", alias = "u", alias = "a")]
    pub x: Axis,
    /// Along its second side; of a polar machine the table, of a scanner its second mirror, of declared axes the
    /// second.
    #[serde(alias = "table", alias = "v", alias = "b")]
    pub y: Axis,
    /// Up.
    pub z: Axis,
}

/// An axis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// From where to where it moves, mm or degrees.
    pub travel: [f64; 2],
    /// Largest acceleration, m/s² or °/s².
    pub acceleration: f64,
    /// Largest speed, m/s or °/s.
    pub speed: f64,
}

/// A lens, and the cracks that it makes.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lens {
    /// Focal length, mm.
    pub focal: f64,
    /// Diameter and height of a crack, mm.
    pub crack: [f64; 2],
    /// Smallest distance of two points, mm.
    pub spacing: f64,
    /// The highest block, mm.
    pub block: f64,
    /// From which energy of a pulse in the glass to which it makes that crack, mJ.
    #[serde(default)]
    pub energy: Option<[f64; 2]>,
}

impl Lens {
    /// Whether it is the lens of this focal length (mm).
    fn is(&self, focal: f64) -> bool {
        (self.focal - focal).abs() < 1e-6
    }

    /// A pulse belongs to the point in whose crack it lies: cracks that reach half way to the next point, and more, prove nothing.
    fn check(&self, beam: f64) -> Result<(), String> {
        let Lens { focal, crack: [diameter, height], spacing, .. } = *self;
        if focal < beam {
            return Err(format!(
                "a lens of f = {focal} mm is shorter than its beam of {beam} mm is wide"
            ));
        }
        if diameter.max(height) > 2.0 * spacing {
            return Err(format!(
                "the crack of f = {focal} mm, {diameter} x {height} mm, is more than twice as large as its spacing of {spacing} mm"
            ));
        }
        Ok(())
    }
}

/// How programs are written.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Form {
    /// The form.
    pub format: Format,
    /// The most points that the controller holds.
    pub points: u64,
    /// The word that fires the laser once; of G-code only.
    #[serde(default)]
    pub fire: Option<String>,
    /// Whether the controller fires while its axes move at constant speed; of the numbered form only.
    #[serde(default)]
    pub runs: bool,
}

/// The form of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Numbered commands, one a line.
    Numbered,
    /// X, Y and Z of one point a line.
    Points,
    /// G-code: a rapid and the word that fires.
    Gcode,
    /// Whole µm in binary, 12 bytes a pulse.
    Binary,
}

/// M words that do not fire once: those that stop, end, call or change the tool, and those that switch something on or off that
/// then stays so (RS274/NGC 3.6: M3 to M5, M7 to M9, M48, M49; LinuxCNC, "M Codes": M62 to M65).
const NEVER_ONCE: [f64; 19] = [
    0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 30.0, 48.0, 49.0, 62.0, 63.0, 64.0, 65.0,
    98.0, 99.0,
];

/// Whether words may be those that fire the laser: nothing that moves, ends, stops, calls or stays on, or changes how numbers count.
fn fires(words: &str) -> bool {
    let number = |word: &str, letters: &str| {
        let mut word = word.chars();
        let letter = word.next().filter(|letter| letters.contains(*letter));
        letter.and_then(|_| word.as_str().parse::<f64>().ok())
    };
    let mut words = words.split(' ');
    let own = |number: f64| !NEVER_ONCE.contains(&number);
    words.next().and_then(|word| number(word, "M")).is_some_and(own)
        && words.all(|word| number(word, "PQRS").is_some())
}

impl Machine {
    /// The machine that `text` describes, which is the file `file`.
    ///
    /// # Errors
    /// Where it is none, with the line; or where a number cannot be.
    pub fn read(text: &str, file: &str) -> Result<Machine, Box<Diagnostic>> {
        let machine: Machine = toml::from_str(text).map_err(|error| {
            let Misread { message, help } = Misread::of(error.message());
            let found = Diagnostic::error(Rule::MachineFile, format!("is no machine: {message}"));
            let found = found.help("`toolpost glass show glass-xyz-100hz` prints one that is");
            found.file(file).line(line_of(text, &error)).help(help)
        })?;
        machine.check().map_err(|message| {
            let found = Diagnostic::error(Rule::MachineFile, message).file(file);
            Box::new(found.help("`toolpost glass show glass-xyz-100hz` prints a machine"))
        })?;
        Ok(machine)
    }

    fn check(&self) -> Result<(), String> {
        match (self.kind, self.polar) {
            (Kind::Polar, None) => {
                return Err(String::from("[polar] is missing: the lengths of table and arm"));
            }
            (Kind::Xyz | Kind::Galvo | Kind::Chain, Some(_)) => {
                return Err(String::from("[polar] is for kind = \"polar\" only"));
            }
            _ => {}
        }
        match (self.kind, &self.chain) {
            (Kind::Chain, None) => {
                return Err(String::from(
                    "[chain] is missing: the axes a and b, spot, corner and near",
                ));
            }
            (Kind::Xyz | Kind::Galvo | Kind::Polar, Some(_)) => {
                return Err(String::from("[chain] is for kind = \"chain\" only"));
            }
            (Kind::Chain, Some(chain)) => chain.check()?,
            (Kind::Xyz | Kind::Galvo | Kind::Polar, None) => {}
        }
        if self.kind == Kind::Chain && self.program.runs {
            return Err(String::from("program.runs is not for kind = \"chain\""));
        }
        for (name, value, range) in self.figures() {
            // NaN is in no range.
            if !(range[0]..=range[1]).contains(&value) {
                return Err(format!(
                    "{name} must be from {} to {}, not {value}",
                    range[0], range[1]
                ));
            }
        }
        let Laser { rate, pump, .. } = self.laser;
        if let Some(limit) = pump.map(pump_limit).filter(|limit| rate >= *limit) {
            return Err(format!(
                "laser.rate = {rate} with laser.pump = {} J is 1000 W or more: the rate must be below {limit} Hz",
                pump.unwrap_or_default()
            ));
        }
        if self.lenses.is_empty() {
            return Err(String::from("there is no lens: add [[lenses]]"));
        }
        for (i, lens) in self.lenses.iter().enumerate() {
            lens.check(self.laser.beam)?;
            if self.lenses[..i].iter().any(|other| other.is(lens.focal)) {
                return Err(format!("two lenses have f = {} mm: leave one out", lens.focal));
            }
        }
        if self.laser.channels > 1
            && (self.kind != Kind::Xyz || self.program.format != Format::Numbered)
        {
            return Err(String::from(
                "laser.channels is for kind = \"xyz\" with the numbered format, which says how many are open",
            ));
        }
        if self.stage.is_some() != (self.kind == Kind::Galvo) {
            return Err(String::from(
                "[stage.x] and [stage.y] are for kind = \"galvo\", which needs them",
            ));
        }
        if self.kind == Kind::Galvo && self.program.runs {
            return Err(String::from(
                "program.runs is not for a scanner: its steps take a tick as it is",
            ));
        }
        if self.program.format != Format::Numbered
            && (self.program.runs || self.kind == Kind::Galvo)
        {
            return Err(String::from(
                "program.format must be \"numbered\" for a scanner, and for `runs`",
            ));
        }
        // A table that turns on and on takes the shorter way; which way G-code turns it depends on the sign of the word, and on
        // the control.
        if self.kind == Kind::Polar && self.program.format == Format::Gcode {
            return Err(String::from(
                "program.format = \"gcode\" does not say which way a table turns: take numbered, points or binary, or kind = \"chain\", whose axes turn between the ends of their travels",
            ));
        }
        match (&self.program.fire, self.program.format) {
            (None, Format::Gcode) => {
                Err(String::from("program.fire is missing: the word that fires the laser once"))
            }
            (Some(_), Format::Numbered | Format::Points | Format::Binary) => {
                Err(String::from("program.fire is for G-code only"))
            }
            (Some(word), Format::Gcode) if !fires(word) => Err(format!(
                "program.fire = \"{word}\" does more than fire once: name an M word that ends by itself (such as M101), with P, Q, R or S; not one that stops, calls, or stays on as M3, M8 and M64 do"
            )),
            (Some(_), Format::Gcode)
            | (None, Format::Numbered | Format::Points | Format::Binary) => Ok(()),
        }
    }

    /// Every figure with its name, and from what to what it may be.
    fn figures(&self) -> Vec<(String, f64, [f64; 2])> {
        let Laser { rate, wavelength, beam, channels, channel_distance, delay, pump, energy } =
            self.laser;
        let mut figures = vec![
            (String::from("laser.rate"), rate, [0.1, 1e6]),
            (String::from("laser.wavelength"), wavelength, [100.0, 20_000.0]),
            (String::from("laser.beam"), beam, [0.1, 100.0]),
            (String::from("laser.delay"), delay, [0.0, 1e4]),
            (String::from("laser.channels"), f64::from(channels), [1.0, 64.0]),
            (String::from("laser.channel_distance"), channel_distance, [0.0, 5000.0]),
        ];
        figures.extend(pump.map(|joule| (String::from("laser.pump"), joule, [1e-3, 1e4])));
        figures.extend(energy.map(|mj| (String::from("laser.energy"), mj, [1e-6, 1e6])));
        if let Some(Table { distance, arm, offset, radius, blocks, .. }) = self.polar {
            let lengths =
                [("distance", distance), ("arm", arm), ("offset", offset), ("radius", radius)];
            figures.extend(lengths.map(|(name, mm)| (format!("polar.{name}"), mm, [1.0, 5000.0])));
            figures.push((String::from("polar.blocks"), f64::from(blocks), [1.0, 64.0]));
        }
        for (Coordinate { axis, turns, .. }, name) in
            self.coordinates().into_iter().zip(self.names())
        {
            let most = if turns { [1e7, 1e5] } else { [1e4, 100.0] };
            figures.push((format!("axes.{name}.acceleration"), axis.acceleration, [1e-3, most[0]]));
            figures.push((format!("axes.{name}.speed"), axis.speed, [1e-4, most[1]]));
            let [low, high] = axis.travel;
            figures.push((format!("axes.{name}: the length of `travel`"), high - low, [0.1, 1e4]));
            figures.push((format!("axes.{name}.travel[0]"), low, [-1e4, 1e4]));
        }
        for (name, axis) in self.stage.iter().flat_map(|stage| [("x", stage.x), ("y", stage.y)]) {
            figures.push((format!("stage.{name}.acceleration"), axis.acceleration, [1e-3, 1e4]));
            figures.push((format!("stage.{name}.speed"), axis.speed, [1e-4, 100.0]));
            let length = axis.travel[1] - axis.travel[0];
            figures.push((format!("stage.{name}: the length of `travel`"), length, [0.1, 1e4]));
        }
        for Lens { focal, crack, spacing, block, energy } in &self.lenses {
            let energies = energy.iter().flatten();
            figures.extend(energies.map(|mj| (String::from("lenses.energy"), *mj, [0.0, 1e6])));
            figures.push((String::from("lenses.focal"), *focal, [1.0, 2000.0]));
            figures.extend(crack.map(|size| (String::from("lenses.crack"), size, [1e-3, 1.0])));
            figures.push((String::from("lenses.spacing"), *spacing, [1e-3, 10.0]));
            figures.push((String::from("lenses.block"), *block, [1.0, 1000.0]));
        }
        figures
    }

    /// The lens of this focal length (mm).
    ///
    /// # Errors
    /// The machine has none.
    pub fn lens(&self, focal: f64) -> Result<Lens, Box<Diagnostic>> {
        let found = self.lenses.iter().copied().find(|lens| lens.is(focal));
        found.ok_or_else(|| {
            let all: Vec<String> = self.lenses.iter().map(|lens| lens.focal.to_string()).collect();
            let found = Diagnostic::error(
                Rule::Lens,
                format!("{} has no lens of f = {focal} mm", self.title),
            );
            found.help(format!("it has f = {} mm", all.join(", "))).into()
        })
    }

    /// The tick and the axes.
    pub fn clock(&self) -> Clock {
        let axes = self.coordinates().map(|of| {
            let turn = of.endless.then(|| (360.0 * of.steps()) as i64);
            (of.limits(), of.steps(), turn)
        });
        Clock::of(self.laser.rate, self.drive.profile, axes)
    }

    /// The ticks in which the stage carries the block from field to field, mm.
    pub fn carried(&self, from: [f64; 2], to: [f64; 2]) -> u64 {
        let Some(stage) = self.stage else { return 0 };
        let time = |axis: Axis, way: f64| {
            let limits = Limits::metric(axis.acceleration, axis.speed);
            self.drive.profile.fastest(way.abs(), limits).time
        };
        let time = time(stage.x, to[0] - from[0]).max(time(stage.y, to[1] - from[1]));
        u64::from(crate::clock::ticks(time, self.laser.rate))
    }

    /// What its axes are called in machine files.
    fn names(&self) -> [&'static str; 3] {
        match self.kind {
            Kind::Xyz => ["x", "y", "z"],
            Kind::Polar => ["arm", "table", "z"],
            Kind::Galvo => ["u", "v", "z"],
            Kind::Chain => ["a", "b", "z"],
        }
    }

    /// The coordinates of its programs. A degree has four decimals: 0.35 µm at 200 mm.
    pub fn coordinates(&self) -> [Coordinate; 3] {
        let Axes { x, y, z } = self.axes;
        let linear =
            |word, axis| Coordinate { word, decimals: 3, turns: false, endless: false, axis };
        let turning =
            |word, endless, axis| Coordinate { word, decimals: 4, turns: true, endless, axis };
        match self.kind {
            Kind::Xyz => [linear("X", x), linear("Y", y), linear("Z", z)],
            Kind::Polar => [turning("A", false, x), turning("C", true, y), linear("Z", z)],
            Kind::Galvo => [linear("U", x), linear("V", y), linear("Z", z)],
            Kind::Chain => {
                let turns = |joint: Option<Joint>| joint.is_some_and(|joint| joint.turns());
                let [a, b] = [self.chain.map(|chain| chain.a), self.chain.map(|chain| chain.b)];
                let of = |turns: bool, words: [&'static str; 2], axis| match turns {
                    true => turning(words[1], false, axis),
                    false => linear(words[0], axis),
                };
                [of(turns(a), ["X", "A"], x), of(turns(b), ["Y", "C"], y), linear("Z", z)]
            }
        }
    }

    /// Why blocks of these sides do not lie side by side under its beams or on its table; `None` where they do.
    pub fn refuses(&self, block: [f64; 3], count: u32) -> Option<String> {
        if let Some(table) = self.polar {
            return table.refuses(block);
        }
        let Laser { channel_distance, .. } = self.laser;
        (count > 1 && block[0] > channel_distance).then(|| {
            format!(
                "blocks of {} mm do not lie side by side under beams {channel_distance} mm apart",
                block[0]
            )
        })
    }

    /// How many ticks pass from the trigger of a pulse until it fires.
    pub fn late(&self) -> f64 {
        self.laser.delay * 1e-6 * self.laser.rate
    }

    /// How many equal blocks it can make at most: only the numbered form says how many there are.
    pub fn blocks(&self) -> u32 {
        if self.program.format != Format::Numbered {
            return 1;
        }
        self.polar.map_or(self.laser.channels, |table| table.blocks)
    }
}

/// The line of an error in `text`, from 1.
pub(crate) fn line_of(text: &str, error: &toml::de::Error) -> u32 {
    let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
    1 + before.bytes().filter(|byte| *byte == b'\n').count() as u32
}

/// The text of a machine of the library.
pub fn library(name: &str) -> Option<&'static str> {
    LIBRARY.iter().find(|(own, _)| *own == name).map(|(_, text)| *text)
}
