//! Programs: where the axes stand at each pulse, written for a machine.

use crate::cloud::Point;
use crate::fly::Run;
use crate::machine::{Coordinate, Format, Kind, Machine};

/// The program of pulses at `axes` (steps of the machine's coordinates), in their order, in `blocks` equal blocks of `block` (mm);
/// those of `runs` are fired in motion. `fields` are those of a scanner: the first pulse of each, and its middle.
pub fn write(
    axes: &[Point],
    runs: &[Run],
    fields: &[(usize, [i32; 2])],
    machine: &Machine,
    (block, blocks): ([f64; 3], u32),
) -> Vec<u8> {
    let sides = block.map(|side| (side * 1e3).round() as i32);
    let is_text = machine.program.format != Format::Binary;
    let mut text = Text(Vec::with_capacity(if is_text { axes.len() * 40 + 200 } else { 0 }));
    match (machine.program.format, &machine.program.fire) {
        (Format::Binary, _) => return binary(axes, sides),
        (Format::Points, _) => {
            let [a, b, c] = machine.coordinates().map(|of| of.word);
            text.line(&match machine.kind {
                Kind::Xyz | Kind::Galvo => String::from(
                    "# Toolpost: X Y Z of each pulse in mm, from the block's corner and its top face",
                ),
                Kind::Polar | Kind::Chain => {
                    format!("# Toolpost: {a} {b} {c} of each pulse, mm and degrees")
                }
            });
            axes.iter().for_each(|&at| text.point(at, machine));
        }
        (Format::Gcode, fire) => {
            let fire = fire.as_deref().unwrap_or_default();
            text.line("(Toolpost: pulses inside glass)");
            if machine.chain.is_none() {
                text.line(
                    "(X and Y from a corner of the block, Z of the focus in air from its top face)",
                );
            }
            text.line("G21 G90");
            for &at in axes {
                text.word("G0");
                for (of, at) in machine.coordinates().iter().zip(at) {
                    text.coordinate(of, at);
                }
                text.end();
                text.line(fire);
            }
            text.line("M2");
        }
        (Format::Numbered, _) => {
            text.numbered(1, "BEGIN BLOCK");
            text.axes(sides);
            text.word(" POINTS ");
            text.whole(axes.len() as u64);
            if blocks > 1 {
                text.word(" BLOCKS ");
                text.whole(u64::from(blocks));
            }
            text.end();
            text.numbered_pulses(axes, runs, fields, machine);
        }
    }
    text.0
}

/// The binary program: its mark, the block's sides, the count, the pulses, and the sum of all that (CRC-32); numbers are whole µm, the
/// lowest byte first.
fn binary(axes: &[Point], sides: Point) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(axes.len() * 12 + 32);
    bytes.extend_from_slice(b"TPGLASS1");
    sides.iter().for_each(|side| bytes.extend_from_slice(&side.to_le_bytes()));
    bytes.extend_from_slice(&(axes.len() as u64).to_le_bytes());
    for value in axes.iter().flatten() {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    let sum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(&sum.to_le_bytes());
    bytes
}

/// Text being written.
struct Text(Vec<u8>);

impl Text {
    fn word(&mut self, word: &str) {
        self.0.extend_from_slice(word.as_bytes());
    }

    fn end(&mut self) {
        self.0.push(b'\n');
    }

    fn line(&mut self, line: &str) {
        self.word(line);
        self.end();
    }

    fn numbered(&mut self, number: u64, command: &str) {
        self.0.push(b'N');
        self.whole(number);
        self.0.push(b' ');
        self.word(command);
    }

    fn numbered_pulses(
        &mut self,
        axes: &[Point],
        runs: &[Run],
        fields: &[(usize, [i32; 2])],
        machine: &Machine,
    ) {
        let mut fields = fields.iter().peekable();
        let mut center = [0; 2];
        let coordinates = machine.coordinates();
        let late = machine.late();
        let mut number = 2;
        let mut command = |text: &mut Text, name| {
            text.numbered(number, name);
            number += 1;
        };
        let mut runs = runs.iter().peekable();
        let mut moving: Option<&Run> = None;
        for (i, &at) in axes.iter().enumerate() {
            if let Some((_, middle)) = fields.next_if(|(first, _)| *first == i) {
                center = *middle;
                command(self, "FIELD");
                for (word, at) in [" X", " Y"].into_iter().zip(center) {
                    self.word(word);
                    self.length(at);
                }
                self.end();
            }
            let at = [at[0] - center[0], at[1] - center[1], at[2]];
            if let Some(run) = runs.next_if(|run| run.first == i) {
                command(self, "RUN");
                for (of, speed) in coordinates.iter().zip(run.speed) {
                    // Nine decimals: over a whole turn they are less than a step.
                    self.word(&format!(" {}{:.9}", of.word, speed / of.steps()));
                }
                self.end();
                moving = Some(run);
            }
            command(self, "PULSE");
            // The trigger leads by what the axes go until the pulse.
            let led = moving.map_or([0.0; 3], |run| run.speed.map(|speed| speed * late));
            for ((of, at), lead) in coordinates.iter().zip(at).zip(led) {
                self.coordinate(of, (f64::from(at) - lead).round() as i32);
            }
            self.end();
            if moving.is_some_and(|run| run.first + run.count == i + 1) {
                command(self, "REST");
                self.end();
                moving = None;
            }
        }
        command(self, "END");
        self.end();
    }

    /// A coordinate in steps.
    fn coordinate(&mut self, of: &Coordinate, at: i32) {
        self.0.push(b' ');
        self.word(of.word);
        self.value(of, at);
    }

    fn value(&mut self, of: &Coordinate, at: i32) {
        let turn = (360.0 * of.steps()) as i32;
        let at = if of.endless { at.rem_euclid(turn) } else { at };
        self.fixed(at, of.decimals);
    }

    fn whole(&mut self, value: u64) {
        let mut digits = [0; 20];
        let mut at = digits.len();
        let mut rest = value;
        loop {
            at -= 1;
            digits[at] = b'0' + (rest % 10) as u8;
            rest /= 10;
            if rest == 0 {
                break;
            }
        }
        self.0.extend_from_slice(&digits[at..]);
    }

    /// µm as mm with three decimals: exact.
    fn length(&mut self, micrometres: i32) {
        self.fixed(micrometres, 3);
    }

    /// Steps as a number with so many decimals: exact.
    fn fixed(&mut self, steps: i32, decimals: u32) {
        let size = u64::from(steps.unsigned_abs());
        if steps < 0 {
            self.0.push(b'-');
        }
        self.whole(size / 10u64.pow(decimals));
        self.0.push(b'.');
        for place in (0..decimals).rev() {
            self.0.push(b'0' + (size / 10u64.pow(place) % 10) as u8);
        }
    }

    fn axes(&mut self, at: Point) {
        for (name, value) in [" X", " Y", " Z"].into_iter().zip(at) {
            self.word(name);
            self.length(value);
        }
    }

    fn point(&mut self, at: Point, machine: &Machine) {
        for (i, (of, value)) in machine.coordinates().iter().zip(at).enumerate() {
            if i > 0 {
                self.0.push(b' ');
            }
            self.value(of, value);
        }
        self.end();
    }
}
