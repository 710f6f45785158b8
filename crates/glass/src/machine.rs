//! Machines as text files: laser, axes, lenses, and how programs are written for them.
//!
//! This is all that the writer and the judge share.

use crate::clock::Clock;
use crate::profile::{Limits, Profile};
use program::{Diagnostic, Rule};
use serde::Deserialize;

/// The machines that come with Toolpost: name and text.
pub const LIBRARY: [(&str, &str); 3] = [
    ("glass-xyz-50hz", include_str!("../machines/glass-xyz-50hz.toml")),
    ("glass-xyz-100hz", include_str!("../machines/glass-xyz-100hz.toml")),
    ("glass-xyz-200hz", include_str!("../machines/glass-xyz-200hz.toml")),
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
    /// Along the block's first side.
    pub x: Axis,
    /// Along its second side.
    pub y: Axis,
    /// Up.
    pub z: Axis,
}

impl Axes {
    /// X, Y and Z with their names.
    pub fn named(&self) -> [(&'static str, Axis); 3] {
        [("X", self.x), ("Y", self.y), ("Z", self.z)]
    }
}

/// An axis.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// From where to where it moves, mm.
    pub travel: [f64; 2],
    /// Largest acceleration, m/s².
    pub acceleration: f64,
    /// Largest speed, m/s.
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
}

/// Whether words may be those that fire the laser: nothing that moves, ends, stops or calls, or changes how numbers count.
fn fires(words: &str) -> bool {
    let number = |word: &str, letters: &str| {
        let mut word = word.chars();
        let letter = word.next().filter(|letter| letters.contains(*letter));
        letter.and_then(|_| word.as_str().parse::<f64>().ok())
    };
    let mut words = words.split(' ');
    let own = |number: f64| ![0.0, 1.0, 2.0, 6.0, 30.0, 98.0, 99.0].contains(&number);
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
            let found =
                Diagnostic::error(Rule::MachineFile, format!("is no machine: {}", error.message()));
            found
                .file(file)
                .line(line_of(text, &error))
                .help("`toolpost glass show glass-xyz-100hz` prints one that is")
        })?;
        machine.check().map_err(|message| {
            let found = Diagnostic::error(Rule::MachineFile, message).file(file);
            Box::new(found.help("`toolpost glass show glass-xyz-100hz` prints a machine"))
        })?;
        Ok(machine)
    }

    fn check(&self) -> Result<(), String> {
        let Laser { rate, wavelength, beam } = self.laser;
        let mut positive = vec![
            (String::from("laser.rate"), rate),
            (String::from("laser.wavelength"), wavelength),
            (String::from("laser.beam"), beam),
        ];
        for (name, axis) in self.axes.named() {
            let name = name.to_lowercase();
            positive.push((format!("axes.{name}.acceleration"), axis.acceleration));
            positive.push((format!("axes.{name}.speed"), axis.speed));
            positive.push((
                format!("axes.{name}: the length of `travel`"),
                axis.travel[1] - axis.travel[0],
            ));
        }
        for lens in &self.lenses {
            let Lens { focal, crack, spacing, block } = *lens;
            positive.push((String::from("lenses.focal"), focal));
            positive.extend(crack.map(|size| (String::from("lenses.crack"), size)));
            positive.push((String::from("lenses.spacing"), spacing));
            positive.push((String::from("lenses.block"), block));
            if focal < beam {
                return Err(format!(
                    "a lens of f = {focal} mm is shorter than its beam of {beam} mm is wide"
                ));
            }
        }
        if let Some((name, value)) =
            positive.iter().find(|(_, value)| !(*value > 0.0 && value.is_finite()))
        {
            return Err(format!("{name} must be more than 0, not {value}"));
        }
        match (&self.program.fire, self.program.format) {
            (None, Format::Gcode) => {
                Err(String::from("program.fire is missing: the word that fires the laser once"))
            }
            (Some(_), Format::Numbered | Format::Points) => {
                Err(String::from("program.fire is for G-code only"))
            }
            (Some(word), Format::Gcode) if !fires(word) => Err(format!(
                "program.fire = \"{word}\" does more than fire: it is an M word other than M0 to M2, M6, M30, M98 and M99, with P, Q, R or S"
            )),
            (Some(_), Format::Gcode) | (None, Format::Numbered | Format::Points) => Ok(()),
        }
    }

    /// The lens of this focal length (mm).
    ///
    /// # Errors
    /// The machine has none.
    pub fn lens(&self, focal: f64) -> Result<Lens, Box<Diagnostic>> {
        let found = self.lenses.iter().copied().find(|lens| (lens.focal - focal).abs() < 1e-6);
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
        let limits =
            self.axes.named().map(|(_, axis)| Limits::metric(axis.acceleration, axis.speed));
        Clock::new(self.laser.rate, self.drive.profile, limits)
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
