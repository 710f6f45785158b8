//! Harsh five-axis jobs on fourteen shapes of machine: each is made and proven, or refused by the writer under a rule that a
//! machinist accepts. What is written never fails its own proof.

use crate::dice::Dice;
use geom::{Frame, Mat3, Vec3};
use machine::{Machine, load, load_text};
use program::{
    ArcTo, Circle, CompensatedPath, Compensation, Coolant, Cycle, CycleKind, Feed, Op, PathMode,
    Pose, Program, Spindle, Tool, Withdrawal, WorkOffset,
};
use std::collections::BTreeMap;

/// Rules under which the writer may refuse a job.
const ACCEPTED: &[&str] = &[
    "axis-limit",
    // Compensation across a tool that is tilted, or still on at the end.
    "compensation",
    "compensation-active",
    // The control does not lead the tool of the source along the contour: an arc, a corner or a way in that it does not reach.
    "compensation-arc-radius",
    "compensation-entry",
    "compensation-gouge",
    "compensation-inner-corner",
    // Whether the coordinates are the tool's centre or the contour nobody says, or the tool table does not go with it.
    "compensated-path",
    // No cycle goes aside from the wall of a hole.
    "cycle-bore",
    // A tap across Z of the control, or whose spindle turns the other way.
    "cycle-tap",
    // A feed in inverse time that comes to less than half a step of F.
    "feed-zero",
    // A coolant that the machine does not have.
    "missing-block",
    "orientation-in-cut",
    // A vector that goes past a pole so near that the control leads it through it.
    "pole-way",
    // Each axis goes at its own speed by rapid, and the source has no feed in mm/min.
    "rapid-path",
    // Somebody would open the door while the tool is in the cut.
    "stop-in-cut",
    "unreachable-orientation",
];

/// How many jobs there are, and how many with `TOOLPOST_JUDGES=long`.
const JOBS: [u64; 2] = [300, 10_000];

/// A job that failed once beyond the first ones: a rapid under vectors that begins 0.06° from the pole.
const FOUND: [u64; 1] = [9392];

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
            "extends = \"{control}\"\nsafe_height = 800\nwork_zero = [10, -20, 30]\n[options]\n[settings]\ntool_radius = \"full\"\n{settings}\n\
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
    let fanuc = "table_frame_at_zero = true\nrotary_by_sign = false\nlength_moves_axis = false\nlength_along_z = true\ndwell_p_milliseconds = true";
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

    /// A tool axis: upright, hardly tilted, at the edge of what tables reach, from below (an undercut), or anywhere above the
    /// part and a little below.
    fn axis(&mut self) -> Vec3 {
        let tilt = match self.dice.below(20) {
            0..=2 => 0.0,
            3 | 4 => self.dice.number(0.001, 0.5),
            5 | 6 => 90.0,
            7 | 8 => 30.0,
            9 => self.dice.number(85.0, 105.0),
            10 => self.dice.number(95.0, 135.0),
            _ => self.dice.number(1.0, 85.0),
        };
        leaning(tilt, self.azimuth())
    }

    /// A direction in the plane XY, degrees.
    fn azimuth(&mut self) -> f64 {
        match self.dice.below(3) {
            0 => 90.0 * self.dice.below(4) as f64,
            _ => self.dice.number(0.0, 360.0),
        }
    }

    fn point(&mut self) -> Vec3 {
        let mut number = || self.dice.number(-80.0, 80.0);
        Vec3::new(number(), number(), number() / 4.0)
    }

    fn tool(&mut self) {
        self.tools += 1;
        let length = self.dice.number(40.0, 160.0);
        let (number, diameter) = (self.tools % 9 + 1, self.dice.number(2.0, 20.0));
        let offset = self.dice.once_in(8).then_some(number + 10);
        self.push(Op::Tool(Box::new(Tool {
            number,
            diameter: Some(diameter),
            length: Some(length),
            offset,
            ..Tool::default()
        })));
        let speed = self.dice.number(100.0, 6000.0).round();
        self.push(Op::Spindle(Spindle::Clockwise(speed)));
        self.feed();
    }

    fn feed(&mut self) {
        let feed = self.dice.number(50.0, 2000.0).round();
        let feed = match self.dice.below(12) {
            0 => Feed::PerTurn(self.dice.number(0.02, 0.4)),
            1 => Feed::InverseTime(self.dice.number(0.5, 60.0)),
            _ => Feed::PerMinute(feed),
        };
        self.push(Op::Feed(feed));
    }

    fn spindle(&mut self) {
        let speed = self.dice.number(100.0, 6000.0).round();
        let spindle = match self.dice.once_in(3) {
            true => Spindle::CounterClockwise(speed),
            false => Spindle::Clockwise(speed),
        };
        self.push(Op::Spindle(spindle));
    }

    /// What is switched or said between operations.
    fn state(&mut self) {
        let op = match self.dice.below(24) {
            0..=2 => return self.tool(),
            3 | 4 => return self.feed(),
            5 => return self.spindle(),
            6 => {
                self.push(Op::Spindle(Spindle::Off));
                self.push(Op::Dwell(0.25));
                return self.spindle();
            }
            7 | 8 => Op::Coolant(Coolant::Flood),
            9 => Op::Coolant(Coolant::Mist),
            10 => Op::Coolant(self.dice.one_of(&[Coolant::FloodAndMist, Coolant::Through])),
            11 | 12 => Op::Coolant(Coolant::Off),
            13 => Op::Dwell(self.dice.number(0.1, 3.0)),
            14 => Op::Stop,
            15 => Op::OptionalStop,
            16 | 17 => Op::Home,
            18 => Op::PathMode(self.dice.one_of(&[
                PathMode::ExactStop,
                PathMode::Blend(0.05),
                PathMode::AsSetUp,
            ])),
            19 => Op::Preselect(self.dice.below(9) as u32 + 1),
            20 => Op::Message("TURN THE PART".into()),
            21 => Op::EndOfOperation,
            _ => {
                let number = 54 + self.dice.below(3) as u32;
                Op::WorkOffset(WorkOffset::numbered(number).unwrap())
            }
        };
        self.push(op);
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
        if self.dice.once_in(4) {
            self.set_up(axis);
        }
        let compensated = self.dice.once_in(8);
        if compensated && self.program.compensated_path.is_none() {
            let paths = [Some(CompensatedPath::Contour), Some(CompensatedPath::Center), None];
            self.program.compensated_path = self.dice.one_of(&paths);
        }
        self.visit(at, axis, |job, at, axis| {
            let side = axis.any_orthonormal_vector();
            let up = axis.cross(side);
            if compensated {
                job.push(Op::Compensation(Compensation::Left(None)));
                job.line(at + side * 30.0, axis);
                job.line(at + side * 30.0 + up * 20.0, axis);
            }
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
            if compensated {
                let here = job.here().point();
                job.push(Op::Compensation(Compensation::Off));
                job.line(here + side * 30.0, axis);
            }
        });
    }

    /// The frame of a set-up, with its Z along `axis`, turned about it in some way, and its zero anywhere.
    fn set_up(&mut self, axis: Vec3) {
        let turn = self.dice.number(0.0, 360.0).to_radians();
        let x = geom::rotate(axis.any_orthonormal_vector(), axis, turn);
        let matrix = Mat3::from_cols(x, axis.cross(x), axis);
        let zero = self.point();
        self.push(Op::Frame(Box::new(Frame::from_mat3_translation(matrix, zero))));
    }

    /// The tool turns while it cuts.
    fn ridge(&mut self) {
        let at = self.point();
        let azimuth = self.azimuth();
        let [from, to] = match self.dice.below(6) {
            0 => [-1.0, 1.0].map(|side| leaning(20.0 * side, azimuth)),
            // Past the pole by less than a degree, and in large steps.
            1 => {
                let off = self.dice.number(-2.0, 2.0);
                [leaning(-self.dice.number(1.0, 60.0), azimuth + off), leaning(60.0, azimuth)]
            }
            // Round the tool's cone, at the same tilt.
            2 => {
                let (tilt, turn) = (self.dice.number(5.0, 90.0), self.dice.number(90.0, 179.0));
                [leaning(tilt, azimuth), leaning(tilt, azimuth + turn)]
            }
            _ => [self.axis(), self.axis()],
        };
        if from.dot(to) < -0.9 {
            return;
        }
        self.push(Op::Operation("RIDGE".into()));
        self.visit(at, from, |job, at, _| {
            let count = 1 + job.dice.below(30);
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

    /// Into the pole, upright for a while, and out of it another way.
    fn pole(&mut self) {
        let (at, tilt) = (self.point(), self.dice.number(0.5, 40.0));
        let azimuths = [self.azimuth(), self.azimuth()];
        self.push(Op::Operation("POLE".into()));
        self.visit(at, leaning(tilt, azimuths[0]), |job, at, _| {
            for i in 1..=1 + job.dice.below(3) {
                job.line(at + Vec3::X * 4.0 * i as f64, Vec3::Z);
            }
            let here = job.here().point();
            job.line(here + Vec3::Y * 5.0, leaning(tilt, azimuths[1]));
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
        let aside = axis.any_orthonormal_vector() * 0.3;
        let pitch = self.dice.one_of(&[0.5, 1.0, 1.25]);
        let withdrawal = Withdrawal { aside, angle: None };
        let kind = match self.dice.below(24) {
            0..=6 => CycleKind::Drill,
            7..=11 => CycleKind::Deep,
            12..=14 => CycleKind::BreakChip,
            15..=18 => CycleKind::Ream,
            19 | 20 => CycleKind::Bore,
            21 => CycleKind::Tap { pitch, left: false },
            22 => {
                let speed = self.dice.number(100.0, 2000.0).round();
                self.push(Op::Spindle(Spindle::CounterClockwise(speed)));
                CycleKind::Tap { pitch, left: true }
            }
            _ if self.dice.once_in(2) => CycleKind::FineBore(withdrawal),
            _ => CycleKind::BackBore { withdrawal, through: None },
        };
        let depth = self.dice.number(1.0, 20.0);
        let pecks = matches!(kind, CycleKind::Deep | CycleKind::BreakChip);
        let peck = pecks.then_some(self.dice.number(1.0, 5.0));
        let first_peck = match self.dice.once_in(3) {
            true => peck.map(|peck| peck + 1.0),
            false => peck,
        };
        let dwell = if self.dice.once_in(4) { self.dice.number(0.1, 2.0) } else { 0.0 };
        let feed = (!self.dice.once_in(6)).then_some(Feed::PerMinute(120.0));
        let retract = self.dice.one_of(&[2.0, 5.0, 30.0]);
        self.push(Op::Operation("HOLES".into()));
        let at = self.point();
        self.rapid(at + axis * 80.0, axis);
        self.push(Op::Cycle(Box::new(Cycle {
            kind,
            depth,
            clearance: 2.0,
            retract,
            feed,
            dwell,
            first_peck,
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
        match job.dice.below(12) {
            0..=3 => job.face(),
            4 | 5 => job.ridge(),
            6 => job.pole(),
            7 | 8 => job.swirl(),
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
    for seed in (0..jobs).chain(FOUND) {
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
                *refused.entry((name, found[0].rule.name())).or_default() += 1;
                if !ACCEPTED.contains(&found[0].rule.name()) {
                    failed.push(format!("job {seed} on {name} is refused: {}", found[0]));
                }
            }
        }
    }
    println!("{made} of {jobs} made; refused: {refused:?}");
    assert!(failed.is_empty(), "{} of {jobs}:\n{}", failed.len(), failed.join("\n"));
}
