//! Random programs that move, turn and mirror their coordinates, and a model of a few lines in
//! complex numbers that goes forwards only: from what a block says to where the tool is.

use geom::Vec3;
use proptest::prelude::*;
use toolpost_control::{Action, Dialect, Settings, Setup};

/// A block of a random program; lengths are thousandths of a millimetre.
#[derive(Clone, Debug)]
enum Block {
    Move([i64; 2], i64),
    /// `G52`
    Local([i64; 2]),
    /// `G92`
    ShiftHere([i64; 2]),
    /// `G92.1`
    Unshift,
    /// `G10 L2`, with the turn of LinuxCNC.
    Offset([i64; 2], i64),
    /// `G10 L20`
    OffsetHere([i64; 2]),
    /// `G54`, `G55`
    Select(usize),
    /// `G68`, and `G69`
    Turn([i64; 2], i64),
    Upright,
    /// `G51.1`, and `G50.1`
    Mirror([Option<i64>; 2]),
    Unmirror,
}

fn blocks() -> impl Strategy<Value = Vec<Block>> {
    let place = || prop::array::uniform2(-100_000..100_000i64);
    let degrees = || -360..360i64;
    let moves = (place(), -9000..9000i64).prop_map(|(to, z)| Block::Move(to, z));
    prop::collection::vec(
        prop_oneof![
            6 => moves,
            1 => place().prop_map(Block::Local),
            1 => place().prop_map(Block::ShiftHere),
            1 => Just(Block::Unshift),
            1 => (place(), degrees()).prop_map(|(to, turn)| Block::Offset(to, turn)),
            1 => place().prop_map(Block::OffsetHere),
            1 => (0..2usize).prop_map(Block::Select),
            1 => (place(), degrees()).prop_map(|(center, turn)| Block::Turn(center, turn)),
            1 => Just(Block::Upright),
            1 => prop::array::uniform2(prop::option::of(-50_000..50_000i64)).prop_map(Block::Mirror),
            1 => Just(Block::Unmirror),
        ],
        1..40,
    )
}

/// A complex number: a place or a turn in the plane.
type Complex = [f64; 2];

fn add(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn less(a: Complex, b: Complex) -> Complex {
    [a[0] - b[0], a[1] - b[1]]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn unit(degrees: f64) -> Complex {
    let angle = degrees.to_radians();
    [angle.cos(), angle.sin()]
}

fn mm(place: [i64; 2]) -> Complex {
    place.map(|v| v as f64 / 1000.0)
}

fn written(place: [i64; 2]) -> String {
    format!("X{:.3} Y{:.3}", place[0] as f64 / 1000.0, place[1] as f64 / 1000.0)
}

/// A work offset: where its zero is in machine coordinates, its turn, and both as they were when the
/// program first moved in it.
#[derive(Clone, Copy, Default)]
struct Offset {
    origin: Complex,
    degrees: f64,
    first: Option<(Complex, f64)>,
}

/// A program as its writer knows it.
#[derive(Default)]
struct Writer {
    text: String,
    offsets: [Offset; 2],
    active: usize,
    shift: Complex,
    local: Complex,
    turn: Option<(Complex, f64)>,
    mirror: [Option<f64>; 2],
    /// Programmed place of the tool, while the coordinates are plain.
    here: Option<Complex>,
    expected: Vec<Vec3>,
}

impl Writer {
    fn is_plain(&self) -> bool {
        self.turn.is_none() && self.mirror == [None; 2]
    }

    /// Where a programmed place is in machine coordinates.
    fn machine(&self, mut place: Complex) -> Complex {
        if let Some((center, degrees)) = self.turn {
            place = add(center, times(unit(degrees), less(place, center)));
        }
        for (coordinate, at) in place.iter_mut().zip(self.mirror) {
            if let Some(at) = at {
                *coordinate = 2.0 * at - *coordinate;
            }
        }
        let offset = self.offsets[self.active];
        let shifted = add(place, add(self.shift, self.local));
        add(offset.origin, times(unit(offset.degrees), shifted))
    }

    /// The programmed place of a machine place, in plain coordinates.
    fn programmed(&self, machine: Complex) -> Complex {
        let offset = self.offsets[self.active];
        let turned = times(unit(-offset.degrees), less(machine, offset.origin));
        less(turned, add(self.shift, self.local))
    }

    fn go(&mut self, place: Complex, z: f64) {
        let machine = self.machine(place);
        let offset = &mut self.offsets[self.active];
        let (origin, degrees) = *offset.first.get_or_insert((offset.origin, offset.degrees));
        let work = times(unit(-degrees), less(machine, origin));
        self.expected.push(Vec3::new(work[0], work[1], z));
        self.here = Some(place);
    }

    /// The coordinates change, and the tool stays.
    fn change(&mut self, how: impl FnOnce(&mut Writer)) {
        let machine = self.here.filter(|_| self.is_plain()).map(|here| self.machine(here));
        how(self);
        self.here = machine.filter(|_| self.is_plain()).map(|machine| self.programmed(machine));
    }

    fn write(&mut self, block: &Block, fanuc: bool) {
        let plain = self.is_plain();
        match block {
            Block::Move(to, z) => {
                self.text += &format!("G0 {} Z{:.3}\n", written(*to), *z as f64 / 1000.0);
                self.go(mm(*to), *z as f64 / 1000.0);
            }
            Block::Local(to) if plain => {
                self.text += &format!("G52 {}\n", written(*to));
                let to = mm(*to);
                self.change(|w| if fanuc { w.local = to } else { w.shift = to });
            }
            Block::ShiftHere(to) if plain => {
                let Some(here) = self.here else { return };
                self.text += &format!("G92 {}\n", written(*to));
                // The sum of both is what brings the tool to these coordinates.
                self.shift = less(add(here, add(self.shift, self.local)), mm(*to));
                self.local = [0.0; 2];
                self.here = Some(mm(*to));
            }
            Block::Unshift if !fanuc => {
                self.text += "G92.1\n";
                self.change(|w| w.shift = [0.0; 2]);
            }
            Block::Offset(to, degrees) if plain => {
                let number = self.active + 1;
                let turn = if fanuc { 0 } else { *degrees };
                let word = if fanuc { String::new() } else { format!(" R{turn}.") };
                self.text += &format!("G10 L2 P{number} {}{word}\n", written(*to));
                let to = mm(*to);
                self.change(|w| {
                    let offset = &mut w.offsets[w.active];
                    (offset.origin, offset.degrees) = (to, turn as f64);
                });
            }
            Block::OffsetHere(to) if !fanuc => {
                let Some(here) = self.here else { return };
                let machine = self.machine(here);
                self.text += &format!("G10 L20 P{} {}\n", self.active + 1, written(*to));
                let inner = add(mm(*to), self.shift);
                let offset = &mut self.offsets[self.active];
                offset.origin = less(machine, times(unit(offset.degrees), inner));
                self.here = Some(mm(*to));
            }
            Block::Select(number) if plain => {
                self.text += &format!("G{}\n", 54 + number);
                let number = *number;
                self.change(|w| w.active = number);
            }
            Block::Turn(center, degrees) if fanuc && self.turn.is_none() => {
                self.text += &format!("G68 {} R{degrees}.\n", written(*center));
                self.turn = Some((mm(*center), *degrees as f64));
                self.here = None;
            }
            Block::Upright if fanuc => {
                self.text += "G69\n";
                self.here = self.here.filter(|_| self.turn.is_none());
                self.turn = None;
            }
            Block::Mirror(at) if fanuc && plain && *at != [None; 2] => {
                let words = [('X', at[0]), ('Y', at[1])];
                self.text += "G51.1";
                for (letter, at) in words {
                    if let Some(at) = at {
                        self.text += &format!(" {letter}{:.3}", at as f64 / 1000.0);
                    }
                }
                self.text += "\n";
                self.mirror = at.map(|at| at.map(|at| at as f64 / 1000.0));
                self.here = None;
            }
            Block::Unmirror if fanuc && self.turn.is_none() => {
                self.text += "G50.1 X0 Y0\n";
                self.here = self.here.filter(|_| plain);
                self.mirror = [None; 2];
            }
            _ => {}
        }
    }
}

fn check(dialect: Dialect, blocks: &[Block]) {
    let mut writer = Writer { text: "G21 G90 G54\n".into(), ..Writer::default() };
    writer.here = Some([0.0; 2]);
    for block in blocks {
        writer.write(block, dialect == Dialect::Fanuc);
    }
    let setup = Setup { start: Some(Vec3::ZERO), ..Setup::default() };
    let settings = Settings { setup, ..Settings::new(dialect, [false; 3]) };
    let text = &writer.text;
    let ops = crate::common::ops(&settings, "t.nc", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let rapid = |op: &Action| if let Action::Rapid(pose) = op { Some(pose.point) } else { None };
    let points: Vec<Vec3> = ops.iter().filter_map(rapid).collect();
    assert_eq!(points.len(), writer.expected.len(), "{text}");
    for (n, (got, expected)) in points.iter().zip(&writer.expected).enumerate() {
        assert!(got.distance(*expected) < 1e-6, "move {n}: {got} {expected}\n{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn moved_coordinates_lead_where_the_model_goes(blocks in blocks()) {
        check(Dialect::Fanuc, &blocks);
        check(Dialect::LinuxCnc, &blocks);
    }
}
