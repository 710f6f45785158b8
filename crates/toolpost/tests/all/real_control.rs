//! A real control: programs that are proven run on a whole LinuxCNC, and its axes are where the proof says, every
//! millisecond. Where the proof refuses a program, the axes show why.
//!
//! Ten programs; with `make judges-long` a hundred generated ones besides. Each takes some seconds.

use control::{Action, Event};
use geom::{Arc, Vec3, nearest_on_segment};
use machine::Machine;

use program::lowering::{self, HoleMove};
use program::{Builder, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool};
use proof::{Motion, MotionKind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Lengths of T1 and T2, mm.
const LENGTHS: [f64; 2] = [30.0, 50.0];

/// Besides the path tolerance, mm: the axes are printed to six decimals, the program has four.
const ROUNDING: f64 = 0.002;

/// Where the axes were at a millisecond, machine coordinates, and the line of the program.
struct Sample {
    at: Vec3,
    line: u32,
}

/// A segment of the program as the proof follows it, in machine coordinates; what is not known is NaN.
struct PathSegment {
    line: u32,
    points: Vec<Vec3>,
}

/// Runs `text` on the real control, with feeds at `feed` times what they are.
fn run(script: &Path, name: &str, text: &str, feed: u32) -> Vec<Sample> {
    let folder =
        std::env::temp_dir().join(format!("toolpost-linuxcnc-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str| folder.join(name);
    std::fs::write(file("program.ngc"), text).unwrap();
    let [first, second] = LENGTHS;
    let tools = format!("T1 P1 Z+{first} D6\nT2 P2 Z+{second} D3.3\n");
    std::fs::write(file("tools.tbl"), tools).unwrap();
    let output = Command::new(script)
        .args([file("program.ngc"), file("samples.csv")])
        .args(["100", &feed.to_string()])
        .arg(file("tools.tbl"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("ended") && !said.contains("not ended"), "{name}: {said}");
    let samples = std::fs::read_to_string(file("samples.csv")).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    let sample = |row: &str| {
        let mut numbers = row.split(',').map(|number| number.parse::<f64>().unwrap());
        let mut next = || numbers.next().unwrap();
        let at = Vec3::new(next(), next(), next());
        next();
        Sample { at, line: next() as u32 }
    };
    samples.lines().skip(1).map(sample).collect()
}

/// The segments that our virtual control follows, in the machine coordinates of a control whose work zero is its own.
fn followed(machine: &Machine, text: &str) -> Vec<PathSegment> {
    let settings = nc::settings(machine, control::Setup::default()).unwrap();
    let mut events: Vec<Event> = Vec::new();
    let keep = &mut |event: Event| {
        events.push(event);
        Ok(())
    };
    control::read(&settings, "p.ngc", text.as_bytes(), keep).unwrap();
    let (mut segments, mut here, mut length) = (Vec::new(), Vec3::NAN, Vec3::ZERO);
    let (mut cycle, mut spindle) = (None::<Cycle>, Spindle::Off);
    for Event { line, action } in events {
        let mut points = vec![here];
        match action {
            Action::Rapid(to) | Action::Line(to) => points.push(to.point + length),
            Action::Arc(to) => {
                let (end, centre) = (to.end.point + length, to.center + length);
                let arc = Arc::new(here, end, centre, to.normal, to.turns, 0.01).unwrap();
                let pieces = 90 * to.turns.max(1);
                points.extend((1..=pieces).map(|i| arc.at(f64::from(i) / f64::from(pieces))));
            }
            Action::Hole(to) => {
                let cycle = cycle.unwrap();
                let hole = Pose::upright(to.point + length).unwrap();
                let over = hole.point() + Vec3::Z * cycle.clearance;
                points.extend([over.with_z(here.z), over]);
                for part in lowering::hole(&cycle, &hole, spindle).unwrap() {
                    if let HoleMove::Rapid(pose) | HoleMove::Line(pose) = part {
                        points.push(pose.point());
                    }
                }
            }
            Action::MachineMove(to) => {
                let mut end = here;
                for (i, value) in to.linear.into_iter().enumerate() {
                    end[i] = value.unwrap_or(end[i]);
                }
                points.push(end);
            }
            Action::Home(_) | Action::Tool(_) => here = Vec3::NAN,
            Action::LengthOffset(register) => {
                length = Vec3::Z * register.map_or(0.0, |h| LENGTHS[h as usize - 1]);
            }
            Action::Cycle(given) => cycle = Some(*given),
            Action::Spindle(given) => spindle = given,
            _ => {}
        }
        if points.len() > 1 {
            here = points[points.len() - 1];
            segments.push(PathSegment { line, points });
        }
    }
    segments
}

/// The segments that the proof tells whoever follows it, for tools that are [`LENGTHS`] long.
fn told(program: &Program, machine: &Machine, text: &str) -> Vec<PathSegment> {
    let mut motions: Vec<Motion> = Vec::new();
    let tolerances = Default::default();
    let report =
        proof::prove_for(program, machine, "p", text.as_bytes(), &tolerances, &mut motions);
    assert!(report.proven, "{:#?}\n{text}", report.mismatches);
    let (mut length, mut lengths) = (Vec3::ZERO, Vec::new());
    for record in &program.records {
        if let Op::Tool(tool) = &record.op {
            length = Vec3::Z * LENGTHS[tool.number as usize - 1];
        }
        lengths.push(length);
    }
    let moved = |motion: &Motion| {
        // On the way to a tool change, and home, it is the tool before.
        let length = lengths[motion.record.min(lengths.len() - 1)];
        let points: Vec<Vec3> = match &motion.kind {
            MotionKind::Arc(arc) => {
                let points = std::iter::once(arc.start).chain(arc.flatten(1e-4));
                points.map(|point| point + length).collect()
            }
            _ => motion.tool.iter().map(|tool| tool.tip + length).collect(),
        };
        PathSegment { line: motion.line, points }
    };
    motions.iter().map(moved).collect()
}

/// How far `point` is from a line through `points`, mm; coordinates that are not known count for nothing.
fn apart(point: Vec3, points: &[Vec3]) -> f64 {
    let pieces = points.windows(2).map(|piece| {
        let [mut a, mut b, mut p] = [piece[0], piece[1], point];
        for i in 0..3 {
            if b[i].is_nan() {
                (a[i], b[i], p[i]) = (0.0, 0.0, 0.0);
            } else if a[i].is_nan() {
                // It comes from anywhere.
                a[i] = p[i];
                b[i] = p[i];
            }
        }
        nearest_on_segment(a, b, p).1
    });
    pieces.fold(f64::INFINITY, f64::min)
}

/// How far the real axes leave the segments of the proof at the most, mm, and the line where they do.
fn deviation(segments: &[PathSegment], samples: &[Sample]) -> (f64, u32) {
    let mut worst = (0.0, 0);
    let mut note = |off: f64, line: u32| {
        if off > worst.0 {
            worst = (off, line);
        }
    };
    for sample in samples {
        // A line that is blended into the next may be reported as either; one that calls the tool goes where the machine likes.
        let Some(at) = segments.iter().position(|segment| segment.line == sample.line) else {
            continue;
        };
        let last = segments.iter().rposition(|segment| segment.line == sample.line).unwrap();
        let near = &segments[at.saturating_sub(2)..(last + 3).min(segments.len())];
        let off = near.iter().map(|segment| apart(sample.at, &segment.points));
        note(off.fold(f64::INFINITY, f64::min), sample.line);
    }
    for segment in segments {
        let near: Vec<Vec3> = samples
            .iter()
            .filter(|sample| sample.line.abs_diff(segment.line) <= 4 || sample.line == 0)
            .map(|sample| sample.at)
            .collect();
        for &point in segment.points.iter().skip(1).filter(|point| !point.is_nan()) {
            note(apart(point, &near), segment.line);
        }
    }
    worst
}

fn read(file: &str) -> Program {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../machines/samples").join(file);
    let text = std::fs::read(&file).unwrap();
    source::apt::read("sample.cls", &text, &Default::default()).unwrap().program
}

/// A job of cuts, arcs among them or not, and holes: the same for the same number.
fn generated(seed: u64, arcs: bool) -> Program {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut below = |end: u32| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % u64::from(end)) as u32
    };
    let mut job = Builder::new(format!("JOB {seed}"));
    for number in 1..=2 {
        job.tool(Tool { number, ..Tool::default() }).unwrap();
        job.spindle(Spindle::Clockwise(2000.0)).unwrap();
        job.feed(Feed::PerMinute(200.0 + 100.0 * f64::from(below(20)))).unwrap();
        for _ in 0..2 + below(3) {
            let mut place = || [f64::from(below(120)) / 2.0, f64::from(below(80)) / 2.0];
            let [x, y] = place();
            let z = -0.5 * f64::from(1 + below(6));
            job.rapid([x, y, 10.0], None).unwrap();
            if number == 2 {
                let kind = if below(2) == 0 { CycleKind::Drill } else { CycleKind::Deep };
                let cycle = Cycle {
                    kind,
                    depth: 6.0,
                    clearance: 2.0,
                    retract: 5.0,
                    feed: Some(Feed::PerMinute(600.0)),
                    dwell: 0.0,
                    first_peck: None,
                    peck: (kind == CycleKind::Deep).then_some(2.5),
                };
                job.drill(cycle, &[[x, y, 0.0], [x + 5.0, y, 0.0]], None).unwrap();
                continue;
            }
            job.rapid([x, y, 2.0], None).unwrap();
            job.line([x, y, z], None).unwrap();
            let mut here = [x, y];
            for _ in 0..1 + below(5) {
                let to = [f64::from(below(120)) / 2.0, f64::from(below(80)) / 2.0];
                if arcs && below(3) == 0 {
                    // A quarter of a circle about a point next to it.
                    let r = f64::from(1 + below(10));
                    let end = [here[0] + r, here[1] + r];
                    job.arc([end[0], end[1], z], [here[0], here[1] + r, z], [0.0, 0.0, 1.0], 0)
                        .unwrap();
                    here = end;
                } else {
                    job.line([to[0], to[1], z], None).unwrap();
                    here = to;
                }
            }
            job.rapid([here[0], here[1], 10.0], None).unwrap();
        }
    }
    job.build()
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

/// The machine of the tests, which leaves the path by so much, mm.
fn mill(path_tolerance: f64) -> Machine {
    let text = format!(
        "extends = \"generic-3axis-linuxcnc\"\n[options]\npath_tolerance = {path_tolerance}\n"
    );
    machine::load_text("mill.toml", &text).unwrap()
}

fn posted(program: &Program, machine: &Machine) -> String {
    let output = post::write(program, machine).unwrap_or_else(|found| panic!("{found:?}"));
    String::from_utf8(output.text).unwrap()
}

fn prove(program: &Program, machine: &Machine, text: &str) -> Result<(), &'static str> {
    let report = proof::prove(program, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.first().map_or(Ok(()), |found| Err(found.rule.name()))
}

/// A job on a machine with this path tolerance, and how much faster than programmed it runs. Where arcs meet a real control
/// leaves the path by more than P of G64 when it is fast: the sample by up to 0.015 mm at five times its feeds, by 0.106 mm
/// at twenty times.
struct Job {
    name: String,
    program: Program,
    path_tolerance: f64,
    feed: u32,
}

#[test]
fn the_axes_of_a_real_control_are_where_the_proof_says() {
    let Some(script) = judge::linuxcnc() else { return };
    let script: PathBuf = script;
    let sample = |path_tolerance, feed| {
        let name = format!("sample-{path_tolerance}");
        Job { name, program: read("three-axes.cls"), path_tolerance, feed }
    };
    let mut jobs = vec![sample(0.01, 2), sample(0.0, 20)];
    jobs.extend((1..=if judge::long() { 100 } else { 4 }).map(|seed| {
        let arcs = seed % 2 == 0;
        let path_tolerance = if arcs { 0.0 } else { 0.01 };
        Job {
            name: format!("job-{seed}"),
            program: generated(seed, arcs),
            path_tolerance,
            feed: 20,
        }
    }));
    each(&jobs, |Job { name, program, path_tolerance, feed }| {
        let machine = mill(*path_tolerance);
        let text = posted(program, &machine);
        let told = told(program, &machine, &text);
        let segments = followed(&machine, &text);
        let samples = run(&script, name, &text, *feed);
        for (segments, whose) in [(&segments, "control"), (&told, "motions")] {
            let (off, line) = deviation(segments, &samples);
            let allowed = path_tolerance + ROUNDING;
            assert!(off <= allowed, "{name}, {whose}: {off} mm off at line {line}\n{text}");
        }
    });
}

/// A damage of a proven program: the line that it changes, the rule of the proof, and what the real axes do.
struct Damage {
    name: &'static str,
    edit: fn(&str) -> String,
    rule: &'static str,
    shows: fn(&[Sample], f64) -> bool,
}

const DAMAGES: [Damage; 5] = [
    Damage {
        name: "a corner is cut",
        edit: |text| text.replacen("G64 P0.005 Q0.005", "G64", 1),
        rule: "path-tolerance",
        shows: |_, off| off > 0.1,
    },
    Damage {
        name: "a corner of rapids is cut",
        edit: |text| {
            let out = text.replacen("G0 Z5\n", "G64 P20\nG0 Z5\n", 1);
            out.replacen("G2 X32.5", "G64 P0.005 Q0.005\nG2 X32.5", 1)
        },
        rule: "path-tolerance",
        shows: |_, off| off > 0.1,
    },
    Damage {
        name: "the axis goes below the table",
        edit: |text| text.replacen("T2 M6", "G53 G0 Z-100\nT2 M6", 1),
        rule: "machine-position",
        shows: |samples, _| samples.iter().any(|sample| sample.at.z < -99.99),
    },
    Damage {
        name: "the tool drops by its length",
        edit: |text| text.replacen("Z2\n", "G49\nZ2\n", 1),
        rule: "length-offset",
        // 2 mm over the part the gauge line is: the tool of 30 mm is in it.
        shows: |samples, _| samples.iter().any(|sample| (sample.at.z - 2.0).abs() < 1e-3),
    },
    Damage {
        name: "the tool is another one's length",
        edit: |text| text.replacen("G43 Z20 H1", "G43 Z20 H2", 1),
        rule: "length-offset",
        shows: |samples, _| samples.iter().any(|sample| (sample.at.z - 48.0).abs() < 1e-3),
    },
];

#[test]
fn the_axes_of_a_real_control_show_why_the_proof_refuses() {
    let Some(script) = judge::linuxcnc() else { return };
    let script: PathBuf = script;
    let machine = mill(0.01);
    let source = read("three-axes.cls");
    let text = posted(&source, &machine);
    let segments = followed(&machine, &text);
    each(&DAMAGES, |damage| {
        let damaged = (damage.edit)(&text);
        assert_ne!(damaged, text, "{}", damage.name);
        assert_eq!(prove(&source, &machine, &damaged), Err(damage.rule), "{}", damage.name);
        let samples = run(&script, &damage.name.replace([' ', '\''], "-"), &damaged, 20);
        let (off, _) = deviation(&segments, &samples);
        assert!((damage.shows)(&samples, off), "{}: {off} mm", damage.name);
    });
}

/// `G33.1` goes on in step with the spindle while that comes to rest and turns back, so it goes deeper than its word by
/// what the spindle still turns, and comes back. `G84` turns the axis where its word says, whatever the spindle does: a
/// tap that is held fast breaks there.
#[test]
fn a_tap_of_the_real_control_follows_the_spindle_by_g33_1_and_not_by_g84() {
    let Some(script) = judge::linuxcnc() else { return };
    let lowest = |name: &str, tap: &str| {
        let start =
            "G21 G17 G40 G49 G80 G90 G94 G54\nG61\nT1 M6\nS500 M3\nG0 X10 Y5\nG43 Z-5 H1\nZ-10\n";
        let samples = run(&script, name, &format!("{start}{tap}\nG80\nG0 Z-5\nM5\nM2\n"), 1);
        // From the R plane on.
        let below = samples.iter().filter(|sample| sample.line >= 7);
        let heights = below.map(|sample| sample.at.z - LENGTHS[0]);
        heights.fold(f64::INFINITY, f64::min)
    };
    let coupled = lowest("rigid-tap", "G33.1 Z-22 K1.25");
    let not_coupled = lowest("floating-tap", "G98 G84 Z-22 R-10 F625");
    assert!(coupled < -22.1 && coupled > -25.0, "{coupled}");
    assert!((not_coupled + 22.0).abs() < ROUNDING, "{not_coupled}");
}
