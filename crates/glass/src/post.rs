//! Programs: where the axes stand at each pulse, written for a machine.

use crate::cloud::Point;
use crate::machine::{Format, Machine};

/// The program of pulses at `axes` (µm), in their order, in a block of `block` (mm).
pub fn write(axes: &[Point], machine: &Machine, block: [f64; 3]) -> Vec<u8> {
    let mut text = Text(Vec::with_capacity(axes.len() * 40 + 200));
    let sides = block.map(|side| (side * 1e3).round() as i32);
    match (machine.program.format, &machine.program.fire) {
        (Format::Binary, _) => return binary(axes, sides),
        (Format::Points, _) => {
            text.line(
                "# Toolpost: X Y Z of each pulse in mm, from the block's corner and its top face",
            );
            axes.iter().for_each(|&at| text.point(at));
        }
        (Format::Gcode, fire) => {
            let fire = fire.as_deref().unwrap_or_default();
            text.line("(Toolpost: pulses inside glass)");
            text.line(
                "(X and Y from a corner of the block, Z of the focus in air from its top face)",
            );
            text.line("G21 G90");
            for &at in axes {
                text.word("G0");
                text.axes(at);
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
            text.end();
            for (i, &at) in axes.iter().enumerate() {
                text.numbered(i as u64 + 2, "PULSE");
                text.axes(at);
                text.end();
            }
            text.numbered(axes.len() as u64 + 2, "END");
            text.end();
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
        let size = u64::from(micrometres.unsigned_abs());
        if micrometres < 0 {
            self.0.push(b'-');
        }
        self.whole(size / 1000);
        let part = size % 1000;
        self.0.extend_from_slice(&[
            b'.',
            b'0' + (part / 100) as u8,
            b'0' + (part / 10 % 10) as u8,
            b'0' + (part % 10) as u8,
        ]);
    }

    fn axes(&mut self, at: Point) {
        for (name, value) in [" X", " Y", " Z"].into_iter().zip(at) {
            self.word(name);
            self.length(value);
        }
    }

    fn point(&mut self, at: Point) {
        for (i, value) in at.into_iter().enumerate() {
            if i > 0 {
                self.0.push(b' ');
            }
            self.length(value);
        }
        self.end();
    }
}
