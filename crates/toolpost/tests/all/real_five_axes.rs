//! A real control for five axes: proven programs run on a whole LinuxCNC with the kinematics of its package, and each
//! millisecond of its joints, by the machine's kinematics and by formulas from LinuxCNC's documentation, is the source: tip
//! and tool axis in the cuts, rapids within their corridor or clear of the part, the joints within the travel.
//!
//! Some programs; with `make judges-long` many generated ones besides. Each takes some ten seconds.

use geom::{Arc, Vec3, angle_between, between};
use machine::{Machine, load_text};
use program::lowering::{self, HoleMove};
use program::{Builder, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool};
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Beyond the path tolerance, mm: the words have four decimals, of degrees too, and the samples six.
const ROUNDING: f64 = 0.002;

/// How far a rapid may be from the straight line of the source, mm, and the tool axis from its own in the cut, degrees.
const CORRIDOR: f64 = 0.1;
const SWEEP: f64 = 1.001;

/// How far the tool is beyond all cuts where it goes by rapid elsewhere, mm.
const CLEARANCE: f64 = 1.0;

/// A machine on the real control: its file, and how the control is set up for it.
struct Mill {
    machine: Machine,
    /// Of the script.
    kinematics: &'static str,
    /// Values of the HAL file.
    pins: &'static [(&'static str, f64)],
    /// The place of each rotary axis by LinuxCNC's names.
    formula: Formula,
}

impl Mill {
    /// Whether the kinematics of the tip are on.
    fn follows_tip(&self, sample: &Sample) -> bool {
        let on = match self.kinematics {
            "5axis" => 0.0,
            "plain" => f64::NAN,
            _ => 1.0,
        };
        sample.kinematics == on
    }
}

/// How LinuxCNC's documentation ("5-Axis Kinematics", and the manual page `kins`) has the tip from the joints.
#[derive(Clone, Copy)]
enum Formula {
    /// `xyzac-trt-kins`: `rot-point`, `y-offset`, `z-offset`.
    Ac([f64; 3], f64, f64),
    /// `xyzbc-trt-kins`: `rot-point`, `x-offset`, `z-offset`.
    Bc([f64; 3], f64, f64),
    /// `5axiskins`: `pivot-length` without the tool.
    Head(f64),
}

impl Formula {
    /// Tip and axis in the coordinates of the machine that turn with the table, for joints X Y Z, the tilting one, C.
    fn forward(self, joints: [f64; 5], length: f64) -> (Vec3, Vec3) {
        let [x, y, z, tilt, turn] = joints;
        let (st, ct) = tilt.to_radians().sin_cos();
        let (sc, cc) = turn.to_radians().sin_cos();
        match self {
            Formula::Ac([rx, ry, rz], dy, dz) => {
                // From where the two axes cross, with the tool: out of the tilt, then out of the turn.
                let (px, py, pz) = (x - rx, y - ry - dy, z - rz - dz - length);
                let (qy, qz) = (ct * py + st * pz + dy, ct * pz - st * py + dz);
                let tip = Vec3::new(cc * px + sc * qy + rx, cc * qy - sc * px + ry, qz + rz);
                (tip, Vec3::new(sc * st, cc * st, ct))
            }
            Formula::Bc([rx, ry, rz], dx, dz) => {
                let (px, py, pz) = (x - rx - dx, y - ry, z - rz - dz - length);
                let (qx, qz) = (ct * px - st * pz + dx, st * px + ct * pz + dz);
                let tip = Vec3::new(cc * qx + sc * py + rx, cc * py - sc * qx + ry, qz + rz);
                (tip, Vec3::new(-cc * st, sc * st, ct))
            }
            Formula::Head(pivot) => {
                let arm = pivot + length;
                let tip = Vec3::new(x + arm * st * cc, y + arm * st * sc, z + pivot - arm * ct);
                (tip, Vec3::new(-st * cc, -st * sc, ct))
            }
        }
    }
}

/// Where the control was at a millisecond.
struct Sample {
    joints: [f64; 5],
    /// X Y Z of the control.
    world: Vec3,
    kinematics: f64,
    length: f64,
    line: u32,
}

/// Tip and axis in the work frame.
#[derive(Clone, Copy, Debug)]
struct Spot {
    tip: Vec3,
    axis: Vec3,
}

fn library(name: &str, more: &str) -> Machine {
    let text = format!("extends = \"{name}\"\n{more}\n[options]\npath_tolerance = 0.01\n");
    load_text("mill.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// The machines of the library as they are, and set up elsewhere.
fn mills() -> Vec<Mill> {
    let moved = "work_zero = [12, -34, 56]\n";
    let rotary = |letter, axis: &str, point: &str, more: &str| {
        format!(
            "[[rotary]]\nletter = \"{letter}\"\non = \"table\"\naxis = {axis}\npoint = {point}\nrapid = 3600\n\
             acceleration = 300\nmodulo = false\n{more}\n"
        )
    };
    let off_centre = format!(
        "{moved}{}{}",
        rotary('A', "[1, 0, 0]", "[0, 17, 17]", "min = -100\nmax = 50"),
        rotary('C', "[0, 0, 1]", "[5, -3, 0]", "")
    );
    let plain = format!(
        "work_zero = [0, 0, 0]\nsafe_height = 300\n[orientation]\nsimultaneous = \"machine-angles\"\ntolerance = 0.005\n\
         [axes]\n{}{}{}[words]\nA = {{ decimals = 4 }}\nC = {{ decimals = 4 }}\n{}{}",
        "X = { min = -400, max = 400 }\n",
        "Y = { min = -400, max = 400 }\n",
        "Z = { min = -300, max = 300 }\n",
        rotary('A', "[1, 0, 0]", "[0, 0, -50]", "min = -100\nmax = 50"),
        rotary('C', "[0, 0, 1]", "[0, 0, -50]", "")
    );
    vec![
        Mill {
            machine: library("linuxcnc-xyzac", ""),
            kinematics: "xyzac-trt",
            pins: &[("y-offset", 20.0), ("z-offset", 10.0)],
            formula: Formula::Ac([0.0; 3], 20.0, 10.0),
        },
        Mill {
            machine: library("linuxcnc-xyzbc", ""),
            kinematics: "xyzbc-trt",
            pins: &[("x-offset", -20.0), ("z-offset", -15.0)],
            formula: Formula::Bc([0.0; 3], -20.0, -15.0),
        },
        Mill {
            machine: library("linuxcnc-xyzbc-head", ""),
            kinematics: "5axis",
            pins: &[("pivotsum.in0", 250.0)],
            formula: Formula::Head(250.0),
        },
        Mill {
            machine: library("linuxcnc-xyzac", &off_centre),
            kinematics: "xyzac-trt",
            pins: &[
                ("y-offset", 20.0),
                ("z-offset", 10.0),
                ("x-rot-point", 5.0),
                ("y-rot-point", -3.0),
                ("z-rot-point", 7.0),
            ],
            formula: Formula::Ac([5.0, -3.0, 7.0], 20.0, 10.0),
        },
        // No kinematics of the control: the program has the positions of the axes.
        Mill {
            machine: library("linuxcnc", &plain),
            kinematics: "plain",
            pins: &[],
            formula: Formula::Ac([0.0, 0.0, -50.0], 0.0, 0.0),
        },
    ]
}

/// The length of a tool in the tables of the tests, mm.
fn length_of(tool: &Tool) -> f64 {
    tool.length.unwrap_or(30.0 * f64::from(tool.number))
}

/// Runs `text` on the real control, with feeds at `feed` times what they are; what it said where something was wrong.
fn run(
    ui: &Path,
    mill: &Mill,
    name: &str,
    source: &Program,
    text: &str,
    feed: u32,
) -> Result<Vec<Sample>, String> {
    let folder = std::env::temp_dir().join(format!("toolpost-5axes-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("program.ngc", text);
    let tools = source.records.iter().filter_map(|record| match &record.op {
        Op::Tool(tool) => Some(format!("T{0} P{0} Z+{1} D6\n", tool.number, length_of(tool))),
        _ => None,
    });
    write("tools.tbl", &tools.collect::<String>());
    // Every work offset of the control is 0 but the first.
    let zero = mill.machine.work_zero.unwrap().to_array();
    let offsets = (5161..=5169).chain(5181..=5189).chain(5210..=5390).map(|number: usize| {
        let value = match number {
            5220 => 1.0,
            5221..=5223 => zero[number - 5221],
            _ => 0.0,
        };
        format!("{number} {value}\n")
    });
    write("offsets.var", &offsets.collect::<String>());
    let mut rotary: Vec<_> = mill.machine.rotary.iter().collect();
    rotary.sort_by_key(|axis| axis.letter);
    let travels = mill.machine.linear.iter().map(|axis| (axis.min, axis.max));
    let travels = travels.chain(rotary.iter().map(|axis| (axis.min, axis.max)));
    let limits = travels.map(|(min, max)| format!("{} {}\n", min.max(-36e3), max.min(36e3)));
    write("limits", &limits.collect::<String>());
    let pins = mill.pins.iter().map(|(name, value)| format!("{name} {value}\n"));
    write("pins", &pins.collect::<String>());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/all/linuxcnc/five-axes-run");
    let output = Command::new(script)
        .arg(ui)
        .arg(mill.kinematics)
        .arg(&folder)
        .args(["200", &feed.to_string()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let samples = std::fs::read_to_string(folder.join("samples.txt"));
    std::fs::remove_dir_all(&folder).unwrap();
    if !output.status.success() {
        return Err(format!("{said}{}", String::from_utf8_lossy(&output.stderr)));
    }
    let sample = |row: &str| {
        let numbers: Vec<f64> = row.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let [_, j0, j1, j2, j3, j4, x, y, z, _, _, _, kinematics, length, line] = numbers[..]
        else {
            return None;
        };
        let joints = [j0, j1, j2, j3, j4];
        let world = Vec3::new(x, y, z);
        Some(Sample { joints, world, kinematics, length, line: line as u32 })
    };
    // A line of the sampler that was lost says so.
    Ok(samples
        .unwrap()
        .lines()
        .filter(|row| !row.starts_with("overrun"))
        .filter_map(sample)
        .collect())
}

/// Tip and axis of a sample in the work frame, by the machine's kinematics and by LinuxCNC's formulas, which agree.
fn spot(mill: &Mill, sample: &Sample) -> Spot {
    let zero = mill.machine.work_zero.unwrap();
    let [x, y, z, tilt, turn] = sample.joints;
    let mut degrees = [0.0, 0.0, turn];
    degrees[usize::from(mill.machine.rotary.iter().any(|axis| axis.letter == 'B'))] = tilt;
    let gauge = Vec3::new(x, y, z) - zero - Vec3::Z * sample.length;
    let (tip, axis) = mill.machine.forward(gauge, degrees, sample.length);
    let (theirs, their_axis) = mill.formula.forward(sample.joints, sample.length);
    let apart = tip.distance(theirs - zero).max(axis.distance(their_axis));
    assert!(
        apart < 1e-9,
        "{:?}: {tip} {axis}, LinuxCNC {} {their_axis}",
        sample.joints,
        theirs - zero
    );
    Spot { tip, axis }
}

/// A motion of the source.
struct PathSegment {
    line: u32,
    cuts: bool,
    /// One point where nobody knows from where.
    points: Vec<Vec3>,
    /// At its ends.
    axes: [Vec3; 2],
}

impl PathSegment {
    /// How far `tip` is from it, mm, and at which part of it.
    fn apart(&self, tip: Vec3) -> (f64, f64) {
        let lengths: Vec<f64> = self.points.windows(2).map(|p| p[0].distance(p[1])).collect();
        let whole: f64 = lengths.iter().sum();
        let mut best = (tip.distance(*self.points.last().unwrap()), 1.0);
        let mut before = 0.0;
        for (piece, length) in self.points.windows(2).zip(lengths) {
            let (at, off) = geom::nearest_on_segment(piece[0], piece[1], tip);
            if off < best.0 {
                best = (off, if whole > 0.0 { (before + at * length) / whole } else { 1.0 });
            }
            before += length;
        }
        best
    }

    fn end(&self) -> Vec3 {
        *self.points.last().unwrap()
    }

    /// Whether the tip stands and the tool turns alone.
    fn stands(&self) -> bool {
        self.points.len() > 1 && self.points.iter().all(|point| point.distance(self.end()) < 1e-6)
    }
}

/// The motions of the source, holes as moves.
fn segments(source: &Program) -> Vec<PathSegment> {
    let (mut all, mut here, mut cycle, mut spindle) =
        (Vec::new(), None::<Pose>, None, Spindle::Off);
    let mut go = |line, cuts, points: Vec<Vec3>, to: Pose, here: &mut Option<Pose>| {
        let from = here.map_or(to.axis(), |pose| pose.axis());
        let start = here.map(|pose| pose.point());
        let points = start.into_iter().chain(points).collect();
        all.push(PathSegment { line, cuts, points, axes: [from, to.axis()] });
        *here = Some(to);
    };
    for record in &source.records {
        let line = record.line;
        match &record.op {
            Op::Rapid(to) => go(line, false, vec![to.point()], *to, &mut here),
            Op::Line(to) => go(line, true, vec![to.point()], *to, &mut here),
            Op::Arc(to) => {
                let (circle, end) = (to.circle, to.end);
                let start = here.unwrap().point();
                let arc = Arc::new(
                    start,
                    end.point(),
                    circle.center(),
                    circle.normal(),
                    circle.turns(),
                    0.01,
                )
                .unwrap();
                let points = (1..=360).map(|i| arc.at(f64::from(i) / 360.0)).collect();
                go(line, true, points, end, &mut here);
            }
            Op::Hole(at) => {
                let cycle: &Cycle = cycle.unwrap();
                let over = at.at(at.point() + at.axis() * cycle.clearance).unwrap();
                // Across as high as it is, then down, as a canned cycle does.
                let height = here.map_or(0.0, |pose| (pose.point() - over.point()).dot(at.axis()));
                let across = over.point() + at.axis() * height.max(0.0);
                let points =
                    if here.is_some() { vec![across, over.point()] } else { vec![over.point()] };
                go(line, false, points, over, &mut here);
                for part in lowering::hole(cycle, at, spindle).unwrap() {
                    match part {
                        HoleMove::Rapid(to) => go(line, false, vec![to.point()], to, &mut here),
                        HoleMove::Line(to) => go(line, true, vec![to.point()], to, &mut here),
                        _ => {}
                    }
                }
            }
            Op::Cycle(given) => cycle = Some(&**given),
            Op::Spindle(given) => spindle = *given,
            Op::Tool(_) | Op::Home | Op::WorkOffset(_) => here = None,
            _ => {}
        }
    }
    all
}

/// What is worst of a run.
#[derive(Debug, Default)]
struct Worst {
    /// Tip in the cut, mm; source line.
    tip: (f64, u32),
    /// Tool axis in the cut, degrees.
    axis: (f64, u32),
    /// How far a rapid is from the straight line, mm, where it is on it.
    rapid: (f64, u32),
    /// Milliseconds in the cut, by rapid on the line, and clear of the part.
    counts: [usize; 3],
}

impl Worst {
    fn note(worst: &mut (f64, u32), value: f64, line: u32) {
        if value > worst.0 {
            *worst = (value, line);
        }
    }
}

/// The walk along the source, millisecond by millisecond.
struct Walk {
    segments: Vec<PathSegment>,
    /// Every point of a cut.
    cuts: Vec<Vec3>,
    tolerance: f64,
    at: usize,
    /// Whether the end of the motion at hand has been reached.
    reached: bool,
    worst: Worst,
}

impl Walk {
    fn new(source: &Program, tolerance: f64) -> Walk {
        let segments = segments(source);
        let points = segments
            .iter()
            .filter(|segment| segment.cuts)
            .flat_map(|segment| segment.points.iter().copied());
        let cuts = points.collect();
        Walk { segments, cuts, tolerance, at: 0, reached: false, worst: Worst::default() }
    }

    /// How far `spot` is from a motion, mm and degrees, where it is on it. Past a point to which nobody knows the path
    /// it goes between two milliseconds.
    fn on(&self, segment: &PathSegment, here: &Spot, spot: &Spot) -> Option<(f64, f64)> {
        let (off, part) = match segment.points[..] {
            [point] => (geom::nearest_on_segment(here.tip, spot.tip, point).1, 1.0),
            _ => segment.apart(spot.tip),
        };
        let [from, to] = segment.axes;
        let bend = match segment.stands() {
            true => geom::off_great_circle(from, to, spot.axis),
            false => angle_between(spot.axis, between(from, to, part)),
        };
        let within = if segment.cuts { self.tolerance } else { CORRIDOR };
        (off <= within && bend.to_degrees() <= SWEEP).then_some((off, bend.to_degrees()))
    }

    /// Whether the tool is where nothing is cut: beyond all cuts along its axis, or on the line along its axis over a place
    /// to which it goes or from which it comes.
    fn is_clear(&self, spot: &Spot) -> bool {
        let height = spot.tip.dot(spot.axis);
        if self.cuts.iter().all(|cut| height >= cut.dot(spot.axis) + CLEARANCE - ROUNDING) {
            return true;
        }
        let over = |place: Vec3, axis: Vec3| {
            let up = spot.tip - place;
            let across = up - axis * up.dot(axis);
            angle_between(axis, spot.axis) < 1e-3
                && up.dot(axis) > -self.tolerance
                && across.length() <= CORRIDOR
        };
        let last = self.at.checked_sub(1).map(|last| &self.segments[last]);
        let segment = &self.segments[self.at];
        let comes = last.is_some_and(|last| over(last.end(), last.axes[1]));
        comes
            || over(segment.end(), segment.axes[1]) && (segment.points.len() == 1 || !segment.cuts)
    }

    /// The tool goes on from `here` to `spot`.
    fn step(&mut self, here: &Spot, spot: &Spot) -> Result<(), String> {
        loop {
            let segment = &self.segments[self.at];
            let off = |place| geom::nearest_on_segment(here.tip, spot.tip, place).1;
            let (passed, within) = (off(segment.end()), self.tolerance.max(0.02));
            let turned = angle_between(spot.axis, segment.axes[1]).to_degrees();
            self.reached |= passed <= within && turned <= SWEEP;
            let next = self.segments.get(self.at + 1);
            // A rapid from elsewhere may pass the end of its line between two samples.
            let passes = |next: &PathSegment| !next.cuts && off(next.end()) <= within;
            let goes_on = self.reached
                && next.is_some_and(|next| self.on(next, here, spot).is_some() || passes(next));
            if !goes_on && let Some((off, bend)) = self.on(segment, here, spot) {
                // At a corner it is on the motion before or behind as well.
                let next = [self.at.wrapping_sub(1), self.at + 1].map(|at| self.segments.get(at));
                let next = next.into_iter().flatten().map(|segment| segment.apart(spot.tip).0);
                let off = next.fold(off, f64::min);
                let worst = &mut self.worst;
                if segment.cuts {
                    Worst::note(&mut worst.tip, off, segment.line);
                    Worst::note(&mut worst.axis, bend, segment.line);
                } else {
                    Worst::note(&mut worst.rapid, off, segment.line);
                }
                worst.counts[usize::from(!segment.cuts)] += 1;
                return Ok(());
            }
            if !goes_on && self.is_clear(spot) {
                self.worst.counts[2] += 1;
                return Ok(());
            }
            if !self.reached || next.is_none() {
                let (off, _) = segment.apart(spot.tip);
                let kind = if segment.cuts { "cut" } else { "rapid" };
                return Err(format!(
                    "{spot:?} is {off} mm off the {kind} of source line {}",
                    segment.line
                ));
            }
            (self.at, self.reached) = (self.at + 1, false);
        }
    }
}

/// Walks along the source with the samples of the real control: each is on the motion at hand, or clear of the part.
fn compared(
    mill: &Mill,
    source: &Program,
    samples: &[Sample],
    tolerance: f64,
) -> Result<Worst, String> {
    let mut walk = Walk::new(source, tolerance);
    let mut here = None;
    // Where the machine stands before the program has sent Z up, no program knows.
    let top = mill.machine.safe_height.unwrap() - ROUNDING;
    let begun = samples.iter().enumerate().skip_while(|(_, sample)| sample.joints[2] < top);
    for (i, sample) in begun {
        let spot = spot(mill, sample);
        // Where it stands, the control itself says the same of the tip.
        let before = &samples[i.saturating_sub(1)];
        let stands = before.joints == sample.joints && before.world == sample.world;
        if stands && mill.follows_tip(sample) && mill.follows_tip(before) {
            let says = sample.world - mill.machine.work_zero.unwrap() - Vec3::Z * sample.length;
            if says.distance(spot.tip) > 1e-5 {
                return Err(format!(
                    "millisecond {i}: the tip is at {says}, and not at {}",
                    spot.tip
                ));
            }
        }
        let from = here.replace(spot).unwrap_or(spot);
        let step = walk.step(&from, &spot);
        step.map_err(|why| format!("millisecond {i}, program line {}: {why}", sample.line))?;
    }
    match walk.at + 1 == walk.segments.len() && walk.reached {
        true => Ok(walk.worst),
        false => Err(format!("it has come to source line {} only", walk.segments[walk.at].line)),
    }
}

/// The same numbers everywhere (xorshift).
struct Dice(u64);

impl Dice {
    fn number(&mut self, low: f64, high: f64) -> f64 {
        for shift in [13, -7, 17] {
            self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
        }
        let part = (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        ((low + (high - low) * part) * 1e3).round() / 1e3
    }

    fn leaning(&mut self, tilt: f64) -> Vec3 {
        leaning(self.number(0.0, tilt), self.number(0.0, 360.0))
    }

    fn place(&mut self) -> Vec3 {
        Vec3::new(self.number(-40.0, 40.0), self.number(-40.0, 40.0), self.number(-10.0, 10.0))
    }
}

/// The unit vector that leans by `tilt` degrees towards `azimuth`.
fn leaning(tilt: f64, azimuth: f64) -> Vec3 {
    let (tilt, azimuth) = (tilt.to_radians(), azimuth.to_radians());
    Vec3::new(tilt.sin() * azimuth.cos(), tilt.sin() * azimuth.sin(), tilt.cos()).normalize()
}

/// A job of tilted faces and holes, ridges over which the tool turns, some through the pole, and moves round and round.
fn generated(seed: u64) -> Program {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut job = Builder::new(format!("JOB {seed}"));
    let [p, a] = [|v: Vec3| v.to_array(), |v: Vec3| v.to_array()];
    for number in 1..=2 {
        let length = Some(dice.number(20.0, 70.0));
        job.tool(Tool { number, length, diameter: Some(6.0), ..Tool::default() }).unwrap();
        job.spindle(Spindle::Clockwise(2000.0)).unwrap();
        job.feed(Feed::PerMinute(dice.number(300.0, 1500.0).round())).unwrap();
        let (place, axis) = (dice.place(), dice.leaning(45.0));
        match (seed + number as u64) % 4 {
            0 => {
                job.rapid(p(place + axis * 60.0), Some(a(axis))).unwrap();
                job.rapid(p(place + axis * 2.0), Some(a(axis))).unwrap();
                let side = axis.any_orthonormal_vector() * 15.0;
                let across = axis.cross(side);
                for to in [place, place + side, place + side + across, place + across] {
                    job.line(p(to), Some(a(axis))).unwrap();
                }
                // Half a circle in the plane of the face.
                let (end, center) = (place - across, place);
                job.arc(p(end), p(center), p(axis), 0).unwrap();
                job.rapid(p(end + axis * 60.0), Some(a(axis))).unwrap();
            }
            1 => {
                let to =
                    if seed.is_multiple_of(3) { Vec3::Z * 2.0 - axis } else { dice.leaning(45.0) };
                let (to, across) = (to.normalize(), dice.place() / 2.0);
                job.rapid(p(place + axis * 60.0), Some(a(axis))).unwrap();
                job.rapid(p(place + axis * 2.0), Some(a(axis))).unwrap();
                for i in 0..=12 {
                    let part = f64::from(i) / 12.0;
                    let now = between(axis, to, part);
                    job.line(p(place + across * part), Some(a(now))).unwrap();
                }
                job.rapid(p(place + across + to * 60.0), Some(a(to))).unwrap();
            }
            2 => {
                let (tilt, start) = (dice.number(5.0, 40.0), dice.number(0.0, 360.0));
                let radius = dice.number(5.0, 25.0);
                let at = |angle: f64| (place + leaning(90.0, angle) * radius, leaning(tilt, angle));
                let (first, out) = at(start);
                job.rapid(p(first + out * 60.0), Some(a(out))).unwrap();
                job.rapid(p(first + out * 2.0), Some(a(out))).unwrap();
                for i in 0..=60 {
                    let (to, axis) = at(start + 7.0 * f64::from(i));
                    job.line(p(to), Some(a(axis))).unwrap();
                }
                let (last, out) = at(start + 420.0);
                job.rapid(p(last + out * 60.0), Some(a(out))).unwrap();
            }
            _ => {
                let cycle = Cycle {
                    kind: CycleKind::Drill,
                    depth: 6.0,
                    clearance: 2.0,
                    retract: 5.0,
                    feed: Some(Feed::PerMinute(600.0)),
                    dwell: 0.0,
                    first_peck: None,
                    peck: None,
                };
                job.rapid(p(place + axis * 60.0), Some(a(axis))).unwrap();
                let side = axis.any_orthonormal_vector() * 12.0;
                job.drill(cycle, &[p(place), p(place + side)], Some(a(axis))).unwrap();
                job.rapid(p(place + side + axis * 60.0), Some(a(axis))).unwrap();
            }
        }
    }
    job.build()
}

fn sample_of_the_library() -> Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples/five-axes.cls");
    let text = std::fs::read(file).unwrap();
    let mut program =
        source::apt::read("five-axes.cls", &text, &Default::default()).unwrap().program;
    // The tools of the tests have lengths.
    for record in &mut program.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.length = Some(length_of(tool));
        }
    }
    program
}

fn posted(program: &Program, machine: &Machine) -> String {
    let output = post::write(program, machine).unwrap_or_else(|found| panic!("{found:?}"));
    String::from_utf8(output.text).unwrap()
}

fn prove(program: &Program, machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(program, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

/// Does each of the jobs; as the root user, for whom the script keeps runs apart, five at once: a run is in real time, and mostly waits.
fn each<T: Sync>(jobs: &[T], work: impl Fn(&T) + Sync) {
    let root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..if root { 5 } else { 1 } {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(job);
                }
            });
        }
    });
}

/// The user interface of the real control, where there is one.
fn ui() -> Option<std::path::PathBuf> {
    judge::linuxcnc().map(|script| script.with_file_name("ui.py"))
}

#[test]
fn the_joints_of_a_real_control_bring_the_tool_where_the_source_does() {
    let Some(ui) = ui() else { return };
    let mills = mills();
    let mut jobs: Vec<(usize, String, Program)> = (0..mills.len())
        .map(|mill| (mill, String::from("sample"), sample_of_the_library()))
        .collect();
    if judge::long() {
        let generated = (1..=60)
            .map(|seed| (seed as usize % mills.len(), format!("job-{seed}"), generated(seed)));
        jobs.extend(generated);
    }
    let failed = std::sync::Mutex::new(Vec::new());
    each(&jobs, |(mill, name, program)| {
        let mill = &mills[*mill];
        let name = format!("{name}-{}-{}", mill.kinematics, mill.pins.len());
        let text = posted(program, &mill.machine);
        assert_eq!(prove(program, &mill.machine, &text), Ok(()), "{name}\n{text}");
        // The bound of corners; without kinematics of the control the tip leaves the line between two points, too.
        let follows = mill.machine.settings.kinematics.is_some();
        let bow = if follows { 0.0 } else { mill.machine.orientation.tolerance };
        let tolerance = mill.machine.path_tolerance() + ROUNDING + bow;
        let result = run(&ui, mill, &name, program, &text, 5)
            .and_then(|samples| compared(mill, program, &samples, tolerance));
        match result {
            Ok(worst) => println!("{name}: {worst:?}"),
            Err(why) => failed.lock().unwrap().push(format!("{name}: {why}\n{text}")),
        }
    });
    let failed = failed.into_inner().unwrap();
    assert!(failed.is_empty(), "{} of {}:\n{}", failed.len(), jobs.len(), failed.join("\n"));
}

/// A damage of a proven program, and the block that it puts in.
const DAMAGES: [(&str, &str, &str); 4] = [
    ("another length by the kinematics of the tip", "M428\n", "M428\nG43 H1\n"),
    ("up by the kinematics of the tip", "M429\nG53 G0 Z300\n", "G53 G0 Z300\nM429\n"),
    ("home by the kinematics of the tip", "M429\nG53 G0 Z300\n", "G91 G28 Z0\nG90\nM429\n"),
    ("whatever kinematics the program before has left", "\nM429\nG64", "\nG64"),
];

#[test]
fn the_real_control_shows_why_the_kinematics_of_the_tip_are_left_first() {
    let Some(ui) = ui() else { return };
    let mills = mills();
    let (mill, source) = (&mills[0], sample_of_the_library());
    let text = posted(&source, &mill.machine);
    for (name, block, damaged) in DAMAGES {
        let damaged = text.replacen(block, damaged, 1);
        assert_ne!(damaged, text, "{name}");
        assert_eq!(prove(&source, &mill.machine, &damaged), Err("kinematics"), "{name}");
    }
    let blocks = [
        "G21 G17 G40 G49 G80 G90 G94 G54",
        "M429",
        "G61",
        "T1 M6",
        "G53 G0 Z100",
        "G0 A30 C40",
        "X0 Y0",
        "G43 Z50 H1",
        "M428",
        "G0 X10 Y0 Z20",
        "G43 H2",
        "X10 Y0 Z20",
        "G53 G0 Z100",
        "G0 X10 Y0 Z20",
        "G91 G28 Z0",
        "G90",
        "M429",
        "M2",
    ];
    let samples = run(&ui, mill, "why", &source, &blocks.join("\n"), 1).unwrap();
    let step = |pair: &[Sample]| {
        (0..5).map(|i| (pair[1].joints[i] - pair[0].joints[i]).abs()).fold(0.0, f64::max)
    };
    let where_it = |changes: fn(&Sample, &Sample) -> bool| {
        samples.windows(2).position(|pair| changes(&pair[0], &pair[1])).unwrap()
    };
    // A switch moves nothing.
    let switch = where_it(|a, b| a.kinematics != b.kinematics);
    assert!(samples[switch - 2..switch + 3].windows(2).map(step).all(|mm| mm < 1e-3));
    // The longer tool: an axis that does 0.5 mm in a millisecond at the most jumps by 15 mm.
    let longer = where_it(|a, b| a.length == 30.0 && b.length == 60.0);
    let jump = samples[longer..longer + 30].windows(2).map(step).fold(0.0, f64::max);
    assert!(jump > 3.0, "{jump}");
    let last = |line: u32| samples.iter().rfind(|sample| sample.line == line).unwrap().joints;
    // G53 Z100 is no Z100 of the slide, and G28 goes down.
    assert!((last(13)[2] - 100.0).abs() > 5.0, "{:?}", last(13));
    assert!(last(15)[2] < last(14)[2] - 30.0 && last(15)[2] < 20.0, "{:?}", last(15));
}

/// A tool that hangs on one millimetre: the test would see a machine file that says it wrong.
#[test]
fn a_real_control_whose_table_lies_elsewhere_than_the_file_says_is_seen() {
    let Some(ui) = ui() else { return };
    let mills = mills();
    let source = sample_of_the_library();
    for pins in
        [&[("y-offset", 21.0), ("z-offset", 10.0)], &[("y-offset", 20.0), ("z-offset", 11.0)]]
    {
        let Mill { machine, kinematics, .. } = &mills[0];
        let formula = Formula::Ac([0.0; 3], 20.0, 10.0);
        let mill = Mill { machine: machine.clone(), kinematics, pins, formula };
        let text = posted(&source, &mill.machine);
        let samples =
            run(&ui, &mill, &format!("elsewhere-{}", pins[0].1), &source, &text, 5).unwrap();
        let compared = compared(&mill, &source, &samples, 0.05);
        assert!(compared.is_err(), "{pins:?}: {compared:?}");
    }
}

/// LinuxCNC, "Feed Rate" (G-code overview): F is the speed of X, Y and Z as the block says them, and of the rotary axes
/// where they turn alone. The seconds are those of these blocks at F600 and F6000.
#[test]
fn the_feed_of_a_real_control_is_that_of_x_y_and_z_or_of_rotary_axes_alone() {
    let Some(ui) = ui() else { return };
    let blocks: [(&str, f64); 6] = [
        ("G1 X20 A10 F600", 2.0),
        ("G1 X0 A40", 2.0),
        ("G1 A10 C40 F6000", 0.5),
        ("G1 C0", 0.4),
        ("G93 G1 X5 A0 C20 F60", 1.0),
        // The axis goes as fast as it can: 500 degrees/s, 10,000 degrees/s2. F would have it in 0.01 s.
        ("G94 G1 X5.1 A40 F600", 0.13),
    ];
    let mills = mills();
    let source = sample_of_the_library();
    let follows = [(&mills[0], "M428"), (&mills[4], "")];
    each(&follows, |(mill, follow)| {
        let axes = if follow.is_empty() { "" } else { "M429" };
        let mut text = format!(
            "G21 G17 G40 G49 G80 G90 G94 G54\nG61\n{axes}\nT1 M6\nG0 A0 C0\nX0 Y0\nG43 Z50 H1\n{follow}\nX0 Y0 Z50\n"
        );
        let first = text.lines().count() as u32 + 1;
        text.extend(blocks.iter().map(|(block, _)| format!("{block}\n")));
        text.push_str(&format!("{axes}\nM2\n"));
        let samples =
            run(&ui, mill, &format!("feed-{}", mill.kinematics), &source, &text, 1).unwrap();
        for (line, (block, seconds)) in (first..).zip(blocks) {
            let taken = samples.iter().filter(|sample| sample.line == line).count() as f64 / 1e3;
            assert!((taken - seconds).abs() < 0.03, "{} {block}: {taken} s", mill.kinematics);
        }
    });
}
