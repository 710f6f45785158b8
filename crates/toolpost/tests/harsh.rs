//! Harsh five-axis jobs on fourteen shapes of machine: each is made and proven, or refused by the writer under a rule that a
//! machinist accepts. What is written never fails its own proof.

use geom::Vec3;
use machine::{Machine, load, load_text};
use program::{
    ArcTo, Circle, Coolant, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool, WorkOffset,
};
use std::collections::BTreeMap;

/// Rules under which the writer may refuse a job.
const ACCEPTED: &[&str] = &["axis-limit", "orientation-in-cut", "unreachable-orientation"];

/// How many jobs there are, and how many with `TOOLPOST_JUDGES=long`.
const JOBS: [u64; 2] = [300, 10_000];

/// SplitMix64: the same numbers everywhere.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0 to below `n`.
    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// Whether one of `n` times comes up.
    fn once_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// A number from `low` to `high`, in whole thousandths.
    fn number(&mut self, low: f64, high: f64) -> f64 {
        let part = self.below(1 << 20) as f64 / f64::from(1 << 20);
        ((low + (high - low) * part) * 1e3).round() / 1e3
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize]
    }
}

/// A rotary axis of a machine file.
fn rotary(letter: char, on: &str, axis: &str, point: &str, more: &str) -> String {
    format!(
        "[[rotary]]\nletter = \"{letter}\"\non = \"{on}\"\naxis = {axis}\npoint = {point}\nrapid = 9000\nacceleration = 300\n\
         {more}\n"
    )
}

/// Fourteen shapes of machine: tables, heads, both, nutating ones; axes that end and such that turn for ever; centres in
/// other places than the zero; each way to write a tool axis.
fn machines() -> Vec<(&'static str, Machine)> {
    let made = |name: &'static str,
                control: &str,
                way: [&str; 2],
                settings: &str,
                axes: [String; 2]| {
        let text = format!(
            "extends = \"{control}\"\nsafe_height = 800\nwork_zero = [10, -20, 30]\n[options]\n[settings]\n{settings}\n\
             [orientation]\nsimultaneous = \"{}\"\npositioned = \"{}\"\ntolerance = 0.01\n[axes]\n\
             X = {{ min = -3000, max = 3000, rapid = 20000, acceleration = 3 }}\n\
             Y = {{ min = -3000, max = 3000, rapid = 20000, acceleration = 3 }}\n\
             Z = {{ min = -3000, max = 3000, rapid = 20000, acceleration = 3 }}\n{}{}",
            way[0], way[1], axes[0], axes[1]
        );
        (
            name,
            load_text(&format!("{name}.toml"), &text).unwrap_or_else(|why| panic!("{why}\n{text}")),
        )
    };
    let library = |name: &'static str| (name, load(name).unwrap());
    let table =
        |letter, axis: &str, point: &str, more: &str| rotary(letter, "table", axis, point, more);
    let head =
        |letter, axis: &str, point: &str, more: &str| rotary(letter, "head", axis, point, more);
    let (x, y, z, slanted) = ("[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]", "[0, 1, 1]");
    let (angles, tip, vectors, plane) =
        ("machine-angles", "tool-center-angles", "vectors", "tilted-plane");
    let (plain, count) = ("modulo = false\n", "min = -360\nmax = 360\nmodulo = false\n");
    let fanuc = "rotary_by_sign = false\nlength_moves_axis = false\nlength_along_z = true\ndwell_p_milliseconds = true";
    let straight = format!("{fanuc}\nrapid_path = \"linear\"");
    vec![
        library("sinumerik-840d-table-ac"),
        library("fanuc-table-bc"),
        library("dmu50-heidenhain"),
        library("sinumerik-840d-traori"),
        made(
            "fork-head-fanuc",
            "fanuc-31i",
            [tip, tip],
            &straight,
            [
                head('C', z, "[0, 0, 0]", count),
                head('A', x, "[0, 0, 220]", "min = -115\nmax = 115"),
            ],
        ),
        made(
            "head-and-table",
            "sinumerik-840d",
            [tip, plane],
            "",
            [
                head('B', y, "[0, 0, 180]", "min = -100\nmax = 100"),
                table('C', z, "[5, 7, -40]", plain),
            ],
        ),
        made(
            "nutating-head",
            "heidenhain-tnc640",
            [tip, tip],
            "",
            [
                head('C', z, "[0, 0, 0]", count),
                head('B', slanted, "[0, 0, 150]", "min = -180\nmax = 180"),
            ],
        ),
        made(
            "off-centre-table",
            "sinumerik-840d",
            [angles, angles],
            "",
            [
                table('A', x, "[0, 12, -60]", "min = -30\nmax = 120"),
                table('C', z, "[3, -4, -60]", count),
            ],
        ),
        made(
            "fork-head-angles",
            "sinumerik-840d",
            [angles, angles],
            "",
            [
                head('C', z, "[0, 0, 0]", plain),
                head('A', x, "[0, 0, 220]", "min = -115\nmax = 115"),
            ],
        ),
        made(
            "head-and-table-angles",
            "sinumerik-840d",
            [angles, angles],
            "",
            [
                head('A', x, "[0, 0, 160]", "min = -100\nmax = 30"),
                table('C', z, "[20, 30, 0]", plain),
            ],
        ),
        made(
            "trunnion-linuxcnc",
            "linuxcnc",
            [angles, angles],
            "",
            [
                table('A', x, "[0, 0, -50]", "min = -100\nmax = 50\nmodulo = false"),
                table('C', z, "[0, 0, -50]", plain),
            ],
        ),
        made(
            "table-independent",
            "fanuc-31i",
            [tip, tip],
            fanuc,
            [
                table('B', y, "[0, 0, -80]", "min = -110\nmax = 110"),
                table('C', z, "[0, 0, 0]", count),
            ],
        ),
        made(
            "fork-head-vectors",
            "sinumerik-840d",
            [vectors, plane],
            "",
            [
                head('C', z, "[0, 0, 0]", count),
                head('A', x, "[0, 0, 200]", "min = -110\nmax = 110"),
            ],
        ),
        made(
            "nutating-table-angles",
            "sinumerik-840d",
            [angles, angles],
            "",
            [
                table('B', slanted, "[0, 0, -100]", "min = -1\nmax = 181"),
                table('C', z, "[0, 0, -100]", count),
            ],
        ),
    ]
}

/// A job in the making.
struct Job {
    dice: Dice,
    program: Program,
    line: u32,
    tools: u32,
}

impl Job {
    fn push(&mut self, op: Op) {
        self.line += 1;
        self.program.push(self.line, op);
    }

    fn rapid(&mut self, point: Vec3, axis: Vec3) {
        self.push(Op::Rapid(Pose::new(point, axis).unwrap()));
    }

    fn line(&mut self, point: Vec3, axis: Vec3) {
        self.push(Op::Line(Pose::new(point, axis).unwrap()));
    }

    /// A tool axis: upright, hardly tilted, at the edge of what tables reach, or anywhere above the part and a little below.
    fn axis(&mut self) -> Vec3 {
        let tilt = match self.dice.below(8) {
            0 => 0.0,
            1 => self.dice.number(0.001, 0.5),
            2 => 90.0,
            3 => 30.0,
            4 => self.dice.number(85.0, 105.0),
            _ => self.dice.number(1.0, 85.0),
        };
        let azimuth = match self.dice.below(3) {
            0 => 90.0 * self.dice.below(4) as f64,
            _ => self.dice.number(0.0, 360.0),
        };
        leaning(tilt, azimuth)
    }

    fn point(&mut self) -> Vec3 {
        let mut number = || self.dice.number(-80.0, 80.0);
        Vec3::new(number(), number(), number() / 4.0)
    }

    fn tool(&mut self) {
        self.tools += 1;
        let length = self.dice.number(40.0, 160.0);
        let (number, diameter) = (self.tools % 9 + 1, self.dice.number(2.0, 20.0));
        self.push(Op::Tool(Box::new(Tool {
            number,
            diameter: Some(diameter),
            length: Some(length),
            ..Tool::default()
        })));
        let speed = self.dice.number(100.0, 6000.0).round();
        self.push(Op::Spindle(Spindle::Clockwise(speed)));
        self.feed();
    }

    fn feed(&mut self) {
        let feed = self.dice.number(50.0, 2000.0).round();
        self.push(Op::Feed(Feed::PerMinute(feed)));
    }

    /// What is switched between operations.
    fn state(&mut self) {
        match self.dice.below(9) {
            0 => self.tool(),
            1 => self.feed(),
            2 => {
                let speed = self.dice.number(100.0, 6000.0).round();
                self.push(Op::Spindle(Spindle::CounterClockwise(speed)));
            }
            3 => self.push(Op::Coolant(Coolant::Flood)),
            4 => self.push(Op::Coolant(Coolant::Off)),
            5 => self.push(Op::Dwell(0.5)),
            6 => self.push(Op::Stop),
            7 => self.push(Op::Home),
            _ => {
                let offset = WorkOffset::numbered(54 + self.dice.below(3) as u32).unwrap();
                self.push(Op::WorkOffset(offset));
            }
        }
    }

    /// Down onto a place and away again, with what `work` does there.
    fn visit(&mut self, at: Vec3, axis: Vec3, work: impl FnOnce(&mut Job, Vec3, Vec3)) {
        let height = self.dice.number(60.0, 120.0);
        if !self.dice.once_in(4) {
            self.rapid(at + axis * height, axis);
        }
        self.rapid(at + axis * 3.0, axis);
        self.line(at, axis);
        work(self, at, axis);
        if !self.dice.once_in(5) {
            let here = self.here();
            self.rapid(here.point() + here.axis() * height, here.axis());
        }
    }

    fn here(&self) -> Pose {
        let mut poses = self.program.records.iter().rev().filter_map(|record| record.op.pose());
        *poses.next().unwrap()
    }

    /// Lines and arcs in one plane, and rapids near it.
    fn face(&mut self) {
        let (at, axis) = (self.point(), self.axis());
        self.push(Op::Operation("FACE".into()));
        self.visit(at, axis, |job, at, axis| {
            let side = axis.any_orthonormal_vector();
            let up = axis.cross(side);
            for _ in 0..=job.dice.below(4) {
                let (u, v) = (job.dice.number(-40.0, 40.0), job.dice.number(-40.0, 40.0));
                let to = at + side * u + up * v;
                match job.dice.below(5) {
                    0 => {
                        let here = job.here().point();
                        let normal = if job.dice.once_in(2) { axis } else { -axis };
                        let center = (here + to) / 2.0;
                        if here.distance(to) > 1.0
                            && let Ok(circle) = Circle::new(center, normal, 0)
                        {
                            let end = Pose::new(to, axis).unwrap();
                            job.push(Op::Arc(Box::new(ArcTo { end, circle })));
                        }
                    }
                    1 => {
                        job.rapid(to + axis * 0.5, axis);
                        job.line(to, axis);
                    }
                    _ => job.line(to, axis),
                }
            }
        });
    }

    /// The tool turns while it cuts.
    fn ridge(&mut self) {
        let at = self.point();
        let pole = self.dice.once_in(4);
        let azimuth = self.dice.number(0.0, 360.0);
        let [from, to] = match pole {
            true => [-1.0, 1.0].map(|side| leaning(20.0 * side, azimuth)),
            false => [self.axis(), self.axis()],
        };
        if from.dot(to) < -0.9 {
            return;
        }
        self.push(Op::Operation("RIDGE".into()));
        self.visit(at, from, |job, at, _| {
            let count = 2 + job.dice.below(30);
            let way = job.point() / 3.0;
            for i in 1..=count {
                let part = i as f64 / count as f64;
                job.line(at + way * part, geom::between(from, to, part));
            }
            if job.dice.once_in(3) {
                // A rapid between two cuts that turns.
                let next = geom::between(to, from, job.dice.number(0.0, 1.0));
                let place = at + way + next * 2.0;
                job.rapid(place, next);
                job.line(place - next, next);
            }
        });
    }

    /// Round and round with the tool leaning outwards.
    fn swirl(&mut self) {
        let (at, tilt) = (self.point(), self.dice.number(5.0, 60.0));
        let (start, sweep) = (self.dice.number(0.0, 360.0), self.dice.number(100.0, 900.0));
        let radius = self.dice.number(2.0, 30.0);
        let place = |angle: f64| at + leaning(90.0, angle) * radius;
        self.push(Op::Operation("SWIRL".into()));
        self.visit(place(start), leaning(tilt, start), |job, _, _| {
            let count = (sweep / 7.0) as u32;
            for i in 1..=count {
                let angle = start + sweep * f64::from(i) / f64::from(count);
                job.line(place(angle), leaning(tilt, angle));
            }
        });
    }

    fn holes(&mut self) {
        let axis = self.axis();
        let kind = self.dice.one_of(&[CycleKind::Drill, CycleKind::Deep, CycleKind::Ream]);
        let depth = self.dice.number(1.0, 20.0);
        let peck = (kind == CycleKind::Deep).then_some(self.dice.number(1.0, 5.0));
        let retract = self.dice.one_of(&[2.0, 5.0, 30.0]);
        self.push(Op::Operation("HOLES".into()));
        let at = self.point();
        self.rapid(at + axis * 80.0, axis);
        self.push(Op::Cycle(Box::new(Cycle {
            kind,
            depth,
            clearance: 2.0,
            retract,
            feed: Some(Feed::PerMinute(120.0)),
            dwell: 0.0,
            first_peck: peck,
            peck,
        })));
        let side = axis.any_orthonormal_vector();
        for i in 0..=self.dice.below(4) {
            self.push(Op::Hole(Pose::new(at + side * (12.0 * i as f64), axis).unwrap()));
        }
        self.push(Op::CycleOff);
        let here = self.here();
        self.rapid(here.point() + axis * 90.0, axis);
    }
}

/// The unit vector that leans by `tilt` degrees towards `azimuth`.
fn leaning(tilt: f64, azimuth: f64) -> Vec3 {
    let (tilt, azimuth) = (tilt.to_radians(), azimuth.to_radians());
    Vec3::new(tilt.sin() * azimuth.cos(), tilt.sin() * azimuth.sin(), tilt.cos()).normalize()
}

fn job(seed: u64) -> Program {
    let mut job = Job { dice: Dice(seed), program: Program::new("HARSH"), line: 0, tools: 0 };
    job.tool();
    for _ in 0..=job.dice.below(4) {
        match job.dice.below(5) {
            0 | 1 => job.face(),
            2 => job.ridge(),
            3 => job.swirl(),
            _ => job.holes(),
        }
        while job.dice.once_in(2) {
            job.state();
        }
    }
    job.push(Op::End);
    job.program
}

#[test]
fn a_harsh_job_is_proven_or_refused_before_it_is_written() {
    let machines = machines();
    let jobs = JOBS[usize::from(judge::long())];
    let (mut refused, mut failed) = (BTreeMap::<(&str, &str), u32>::new(), Vec::new());
    let mut made = 0;
    for seed in 0..jobs {
        let (name, machine) = &machines[(seed % machines.len() as u64) as usize];
        let program = job(seed);
        match post::write(&program, machine) {
            Ok(output) => {
                made += 1;
                let report =
                    proof::prove(&program, machine, "p", &output.text, &Default::default());
                if let Some(found) = report.mismatches.first() {
                    failed.push(format!("job {seed} on {name}: {found}"));
                }
            }
            Err(found) => {
                *refused.entry((name, found[0].rule)).or_default() += 1;
                if !ACCEPTED.contains(&found[0].rule) {
                    failed.push(format!("job {seed} on {name} is refused: {}", found[0]));
                }
            }
        }
    }
    println!("{made} of {jobs} made; refused: {refused:?}");
    assert!(failed.is_empty(), "{} of {jobs}:\n{}", failed.len(), failed.join("\n"));
}
