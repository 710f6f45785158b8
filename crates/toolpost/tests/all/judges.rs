//! Programs we write, run by interpreters that others wrote: `rs274` of LinuxCNC (Debian package
//! `linuxcnc-uspace`) and `nc-gcode-interpreter` (PyPI). Both are programs run and compared with ours; their
//! motion is compared with the source, so nothing of ours but the reader and the writer is trusted.
//!
//! A judge that is not installed is named on stderr and its test passes; in CI it fails.

use crate::files::sources;
use geom::{Arc, Vec2, Vec3};
use machine::Machine;
use program::{ArcTo, Circle, Cycle, CycleKind, Feed, Op, Pose, Program, Spindle};
use proof::Motion;
use std::path::Path;
use std::process::{Command, Stdio};

/// The source and what is written of it for `machine`; `None` where the machine refuses it.
fn posted(file: &Path, machine: &str) -> Option<(Program, Vec<u8>)> {
    let text = std::fs::read(file).unwrap();
    let reading =
        source::apt::read(&file.display().to_string(), &text, &Default::default()).unwrap();
    let machine = machine::load(machine).unwrap();
    match post::write(&reading.program, &machine) {
        Ok(output) => Some((reading.program, output.text)),
        Err(refusals) => {
            eprintln!("{}: refused: {}", file.display(), refusals[0]);
            None
        }
    }
}

/// A cutting move that a judge reports.
#[derive(Debug)]
struct Cut {
    from: Vec3,
    to: Vec3,
    /// Length of the way, mm; `None` where the judge tells ends only.
    length: Option<f64>,
}

/// Holds the judge's cuts against the source: every cut of the source is made by one or more of the
/// judge's, from its start to its end, over its length; every hole goes to its bottom and not
/// below; and nothing else is cut. Positions agree within `tolerance` mm.
fn assert_same_cuts(program: &Program, cuts: &[Cut], tolerance: f64, holes: bool) -> (usize, f64) {
    let mut cuts = cuts.iter();
    let mut here: Option<Vec3> = None;
    let mut cycle: Option<Cycle> = None;
    let (mut count, mut total) = (0, 0.0);
    for record in &program.records {
        let line = record.line;
        let mut follow = |from: Option<Vec3>, end: Vec3, length: Option<f64>| {
            let (mut at, mut way) = (from, 0.0);
            loop {
                let cut =
                    cuts.next().unwrap_or_else(|| panic!("line {line}: the judge stops early"));
                if let Some(at) = at {
                    let apart = cut.from.distance(at);
                    assert!(apart <= tolerance, "line {line}: starts {apart} mm off: {cut:?}");
                }
                at = Some(cut.to);
                way += cut.length.unwrap_or(f64::NAN);
                if cut.to.distance(end) <= tolerance {
                    // A full circle ends where it began: the length tells whether it was run.
                    if length.is_none_or(|length| way.is_nan() || way >= length - 0.05) {
                        break;
                    }
                }
                assert!(
                    length.is_none_or(|l| way.is_nan() || way <= l + 0.05),
                    "line {line}: {cut:?}"
                );
            }
            if let (Some(length), false) = (length, way.is_nan()) {
                let allowed = 0.003 + 1e-4 * length;
                assert!((way - length).abs() <= allowed, "line {line}: {way} mm, not {length} mm");
                total += way;
            }
            count += 1;
        };
        match &record.op {
            Op::Line(to) => {
                let length = here.map(|from| from.distance(to.point()));
                // A move shorter than the resolution is not there on the control.
                if length.is_none_or(|length| length > tolerance) {
                    follow(here, to.point(), length);
                }
            }
            Op::Arc(to) => {
                let from = here.expect("an arc has a start");
                let arc = to.circle.arc(from, to.end.point(), 0.01).unwrap();
                follow(here, to.end.point(), Some(arc.length()));
            }
            Op::Cycle(new) => cycle = Some(**new),
            Op::Hole(at) if holes => {
                let cycle = cycle.expect("a hole has a cycle");
                let bottom = at.point() - at.axis() * cycle.depth;
                // Pecks, if any, then the bottom; never off the axis of the hole nor below it.
                loop {
                    let cut = cuts.next().unwrap_or_else(|| panic!("line {line}: no more holes"));
                    let off = (cut.to - bottom).truncate().length();
                    assert!(
                        off <= tolerance && cut.to.z >= bottom.z - tolerance,
                        "{line}: {cut:?}"
                    );
                    if cut.to.z <= bottom.z + tolerance {
                        break;
                    }
                }
                if let CycleKind::Tap { .. } | CycleKind::Ream = cycle.kind {
                    let out =
                        cuts.next().unwrap_or_else(|| panic!("line {line}: stays in the hole"));
                    assert!(
                        out.from.distance(bottom) <= tolerance && out.to.z > bottom.z,
                        "{out:?}"
                    );
                }
            }
            _ => {}
        }
        match (&record.op, &cycle) {
            (Op::Hole(at), Some(cycle)) => {
                here = Some(at.point() + at.axis() * cycle.retract);
            }
            (op, _) => here = op.pose().map(|pose| pose.point()).or(here),
        }
    }
    assert!(cuts.next().is_none(), "the judge cuts on after the end of the source");
    (count, total)
}

/// What `rs274 -g` says of a program, or against it.
fn rs274_says(folder: &Path, text: &[u8]) -> Result<String, String> {
    let program = folder.join("program.ngc");
    std::fs::write(&program, text).unwrap();
    // Every tool is there, without length and without wear.
    let table: String = (1..100).map(|tool| format!("T{tool} P{tool} D0 Z0\n")).collect();
    std::fs::write(folder.join("tools.tbl"), table).unwrap();
    // It keeps its tool table in a file in HOME: with one of its own, two at once do not meet there.
    let run = Command::new("rs274")
        .args(["-t", "tools.tbl", "-g", "program.ngc"])
        .current_dir(folder)
        .env("HOME", folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    if !run.status.success() {
        return Err(format!(
            "{}{}",
            said.lines().last().unwrap_or_default(),
            String::from_utf8_lossy(&run.stderr)
        ));
    }
    Ok(said)
}

/// The cuts that `rs274 -g` makes of a program, or what it says against it.
fn rs274(folder: &Path, text: &[u8]) -> Result<Vec<Cut>, String> {
    let said = rs274_says(folder, text)?;
    let (mut at, mut plane, mut cuts) = (Vec3::ZERO, 0, Vec::new());
    for line in said.lines() {
        // A line is `   19 N..... STRAIGHT_TRAVERSE(1.0000, 2.0000, ...)`.
        let Some((head, rest)) = line.split_once('(') else { continue };
        let call = head.rsplit(' ').next().unwrap_or_default();
        let numbers: Vec<f64> =
            rest.trim_end_matches(')').split(',').filter_map(|n| n.trim().parse().ok()).collect();
        match call {
            "SELECT_PLANE" => {
                plane = ["XY", "YZ", "XZ"].iter().position(|p| rest.contains(p)).unwrap()
            }
            "STRAIGHT_TRAVERSE" => at = Vec3::new(numbers[0], numbers[1], numbers[2]),
            "STRAIGHT_FEED" => {
                let to = Vec3::new(numbers[0], numbers[1], numbers[2]);
                cuts.push(Cut { from: at, to, length: Some(at.distance(to)) });
                at = to;
            }
            // In, and with the spindle reversed out again.
            "RIGID_TAP" => {
                let to = Vec3::new(numbers[0], numbers[1], numbers[2]);
                let length = Some(at.distance(to));
                cuts.extend([Cut { from: at, to, length }, Cut { from: to, to: at, length }]);
            }
            "ARC_FEED" => {
                // First and second axis of the plane (X Y, Y Z, Z X), then the one it rises along.
                let turned = |a: f64, b: f64, c: f64| match plane {
                    0 => Vec3::new(a, b, c),
                    1 => Vec3::new(c, a, b),
                    _ => Vec3::new(b, c, a),
                };
                let to = turned(numbers[0], numbers[1], numbers[5]);
                let center = turned(numbers[2], numbers[3], numbers[5]);
                let normal = turned(0.0, 0.0, numbers[4].signum());
                let turns = numbers[4].abs() as u32 - 1;
                let arc = Arc::new(at, to, center, normal, turns, 0.01)
                    .map_err(|e| format!("{line}: {e:?}"))?;
                cuts.push(Cut { from: at, to, length: Some(arc.length()) });
                at = to;
            }
            _ => {}
        }
    }
    Ok(cuts)
}

#[test]
fn linuxcnc_itself_runs_our_programs_along_the_source() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut judged = 0;
    for file in sources() {
        let Some((program, text)) = posted(&file, "generic-3axis-linuxcnc") else { continue };
        let cuts =
            rs274(folder.path(), &text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let (count, length) = assert_same_cuts(&program, &cuts, 1e-3, true);
        eprintln!("{}: {count} cuts, {length:.1} mm", file.display());
        judged += 1;
    }
    assert!(judged > 0);
}

/// The blocks that move, each with where its last motion ends, in the order of the motions; of several motions of a block in a row one.
type Blocks = Vec<(u32, Vec3)>;

fn note(blocks: &mut Blocks, line: u32, end: Vec3) {
    match blocks.last_mut() {
        Some((last, at)) if *last == line => *at = end,
        _ => blocks.push((line, end)),
    }
}

/// The blocks of a program as `rs274` has them: it prints the block number of each motion, which is that of its line here.
fn blocks_of_rs274(folder: &Path, text: &str) -> Blocks {
    let number = |(i, line): (usize, &str)| {
        // What is no block has no number: comments, and the lines of loops and subprograms.
        let plain = line.trim_start().starts_with(|c: char| c.is_ascii_alphabetic());
        let is_block = plain && !line.trim_start().starts_with(['o', 'O']);
        if is_block { format!("N{} {line}\n", i + 1) } else { format!("{line}\n") }
    };
    let numbered: String = text.lines().enumerate().map(number).collect();
    let said = rs274_says(folder, numbered.as_bytes()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let (mut plane, mut blocks) = (0, Vec::new());
    let mut at = Vec3::ZERO;
    for line in said.lines() {
        let Some((head, rest)) = line.split_once('(') else { continue };
        let mut words = head.split_whitespace().rev();
        let (call, block) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let numbers: Vec<f64> =
            rest.trim_end_matches(')').split(',').filter_map(|n| n.trim().parse().ok()).collect();
        match call {
            "SELECT_PLANE" => {
                plane = ["XY", "YZ", "XZ"].iter().position(|p| rest.contains(p)).unwrap();
                continue;
            }
            "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" | "STRAIGHT_PROBE" => {
                at = Vec3::new(numbers[0], numbers[1], numbers[2]);
            }
            // It comes out again.
            "RIGID_TAP" => {}
            "ARC_FEED" => {
                let (a, b, c) = (numbers[0], numbers[1], numbers[5]);
                at = match plane {
                    0 => Vec3::new(a, b, c),
                    1 => Vec3::new(c, a, b),
                    _ => Vec3::new(b, c, a),
                };
            }
            _ => continue,
        }
        let block = block.strip_prefix('N').and_then(|number| number.parse().ok());
        note(&mut blocks, block.unwrap_or_else(|| panic!("no block number: {line}")), at);
    }
    blocks
}

/// The same as whoever follows the proof is told.
fn blocks_of_proof(program: &Program, machine: &Machine, text: &str) -> Blocks {
    let mut motions: Vec<Motion> = Vec::new();
    let tolerances = Default::default();
    let report =
        proof::prove_for(program, machine, "p", text.as_bytes(), &tolerances, &mut motions);
    assert!(report.proven, "{:#?}\n{text}", report.mismatches);
    let mut blocks = Vec::new();
    for motion in &motions {
        note(&mut blocks, motion.line, motion.tool[1].tip);
    }
    blocks
}

fn assert_same_blocks(ours: &Blocks, theirs: &Blocks, text: &str) {
    let lines = |blocks: &Blocks| blocks.iter().map(|(line, _)| *line).collect::<Vec<_>>();
    assert_eq!(lines(ours), lines(theirs), "{text}");
    for ((line, is), (_, should)) in ours.iter().zip(theirs) {
        // Where axes are home, the proof does not know where that is.
        let off = (*is - *should).to_array().into_iter().filter(|off| off.is_finite());
        let off = off.map(f64::abs).fold(0.0, f64::max);
        assert!(off < 1e-3, "line {line}: {is}, and {should} of rs274");
    }
}

/// A click on a motion leads to the block that LinuxCNC says makes it.
#[test]
fn the_block_of_each_motion_is_the_one_that_linuxcnc_prints() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (mut programs, mut blocks) = (0, 0);
    for name in ["generic-3axis-linuxcnc", "linuxcnc-mill"] {
        let machine = machine::load(name).unwrap();
        let samples = crate::files::root().join("machines/samples/three-axes.cls");
        for file in sources().into_iter().chain([samples]) {
            let Some((program, text)) = posted(&file, name) else { continue };
            let text = String::from_utf8(text).unwrap();
            let theirs = blocks_of_rs274(folder.path(), &text);
            let ours = blocks_of_proof(&program, &machine, &text);
            assert_same_blocks(&ours, &theirs, &file.display().to_string());
            (programs, blocks) = (programs + 1, blocks + ours.len());
        }
    }
    eprintln!("{programs} programs, {blocks} blocks");
    assert!(programs > 3 && blocks > 300, "{programs} {blocks}");
}

/// A block of a loop or a subprogram moves once in each turn.
#[test]
fn the_blocks_of_loops_and_subprograms_are_those_that_linuxcnc_prints() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let mut job = program::Builder::new("job");
    job.tool(program::Tool { number: 1, ..Default::default() }).unwrap();
    job.spindle(Spindle::Clockwise(5000.0)).unwrap();
    job.feed(Feed::PerMinute(300.0)).unwrap();
    job.rapid([0.0, 0.0, 5.0], None).unwrap();
    for pass in 1..=3 {
        let z = -f64::from(pass);
        job.line([0.0, 0.0, z], None).unwrap();
        job.line([10.0, 0.0, z], None).unwrap();
        job.arc([0.0, 0.0, z], [5.0, 0.0, z], [0.0, 0.0, 1.0], 0).unwrap();
    }
    job.rapid([0.0, 0.0, 5.0], None).unwrap();
    let text = "o10 sub\nG1 Z#1 F300\nG1 X10\nG3 X0 Y0 I-5 J0\no10 endsub\n\
        G21 G17 G40 G49 G80 G90 G91.1 G94 G54\nG64 P0.005 Q0.005\nG53 G0 Z0\nT1 M6\nS5000 M3\nG43 H1\nG0 X0 Y0\nZ5\n\
        #2=0\no20 repeat [3]\n#2=[#2-1]\n(a pass)\no10 call [#2]\no20 endrepeat\nG0 Z5\nM5\nG53 G0 Z0\nM2\n";
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let ours = blocks_of_proof(&job.build(), &machine, text);
    assert_same_blocks(&ours, &blocks_of_rs274(folder.path(), text), text);
    let cuts: Vec<u32> = ours.iter().map(|(line, _)| *line).filter(|line| *line <= 4).collect();
    assert_eq!(cuts, [2, 3, 4, 2, 3, 4, 2, 3, 4]);
}

/// Every probing move ends where the interpreter goes: its end is where it touches. With another end for each place it
/// finds a surface as uneven as we like.
#[test]
fn linuxcnc_itself_follows_a_surface_that_it_finds() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let pose = |x: f64, y: f64, z: f64| Pose::upright(Vec3::new(x, y, z)).unwrap();
    let arc = |end: Pose, center: Vec3, normal: Vec3| {
        Op::Arc(Box::new(ArcTo { end, circle: Circle::new(center, normal, 0).unwrap() }))
    };
    let mut board = Program::new("board");
    for op in [
        Op::Tool(Box::new(program::Tool { number: 1, ..Default::default() })),
        Op::Spindle(Spindle::Clockwise(9000.0)),
        Op::Feed(Feed::PerMinute(100.0)),
        Op::Rapid(pose(10.0, 5.0, 2.0)),
        Op::Rapid(pose(10.0, 5.0, 0.5)),
        Op::Line(pose(10.0, 5.0, -0.1)),
        arc(pose(30.0, 5.0, -0.1), Vec3::new(20.0, 5.0, 0.0), Vec3::NEG_Z),
        Op::Line(pose(31.5, 17.25, -0.3)),
        arc(pose(31.5, 17.25, -0.3), Vec3::new(25.0, 12.0, 0.0), Vec3::Z),
        Op::Line(pose(-2.0, 22.0, -0.1)),
        Op::Rapid(pose(-2.0, 22.0, 2.0)),
        Op::End,
    ] {
        board.push(1, op);
    }
    let grid = levelling::Grid::new(Vec2::ZERO, Vec2::new(40.0, 20.0), 5, 4).unwrap();
    let probing = levelling::Probing { travel: 2.0, reach: 1.0, feed: 50.0 };
    let allowed = levelling::Allowed { deviation: 0.005, outside: 5.0 };
    let program = levelling::follow(&board, &grid, &probing, 0.02, &allowed).unwrap();
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let text = String::from_utf8(post::write(&program, &machine).unwrap().text).unwrap();
    let mut parts = text.split("G38.2 Z-1");
    let mut text = String::from(parts.next().unwrap());
    let mut points = Vec::new();
    for (place, part) in grid.places().zip(parts) {
        // Heights of four decimals, without order.
        let height = (points.len() * 7919 % 1901) as f64 / 1000.0 - 0.95;
        points.push(place.extend(height));
        text += &format!("G38.2 Z{height}{part}");
    }
    assert_eq!(points.len(), 20);
    let folder = tempfile::tempdir().unwrap();
    let cuts = rs274(folder.path(), text.as_bytes()).unwrap();
    let heights = levelling::height_map(&points).unwrap();
    let raised = heights.raise(&program).unwrap();
    let (count, _) = assert_same_cuts(&raised, &cuts, 2e-4, false);
    assert!(count > 30, "{count}");
}

/// Prints a line `x y z` for every block that cuts.
const INTERPRET: &str = r#"
import sys, nc_gcode_interpreter as judge
frame, _ = judge.nc_to_dataframe(open(sys.argv[1]).read())
for row in frame.iter_rows(named=True):
    if row.get("gg01_motion") in ("G1", "G2", "G3") and row.get("function_call") is None:
        print(row["gg01_motion"], *(row.get(axis) for axis in "XYZ"))
"#;

#[test]
fn another_sinumerik_interpreter_ends_every_block_where_the_source_does() {
    let Some(python) = judge::python("nc_gcode_interpreter") else { return };
    let folder = tempfile::tempdir().unwrap();
    // Arcs in every plane.
    let machine = folder.path().join("mill.toml");
    let says = "extends = \"generic-3axis-sinumerik\"\n[settings]\nlength_along_z = true\n\
                [capabilities]\narcs = [\"XY\", \"XZ\", \"YZ\"]\n";
    std::fs::write(&machine, says).unwrap();
    let mut judged = 0;
    for file in sources() {
        let Some((program, text)) = posted(&file, machine.to_str().unwrap()) else { continue };
        let path = folder.path().join("program.mpf");
        std::fs::write(&path, text).unwrap();
        let run = Command::new(&python).args(["-c", INTERPRET]).arg(&path).output().unwrap();
        let said = String::from_utf8_lossy(&run.stdout);
        assert!(
            run.status.success(),
            "{}: {}",
            file.display(),
            String::from_utf8_lossy(&run.stderr)
        );
        let end = |line: &str| {
            let numbers = line.split(' ').skip(1).filter_map(|number| number.parse().ok());
            Vec3::from_slice(&numbers.collect::<Vec<f64>>())
        };
        let ends: Vec<Vec3> = said.lines().map(end).collect();
        let near = |a: Vec3, b: Vec3| a.distance(b) < 1.5e-3;
        let mut here = Vec3::NAN;
        let mut left = ends.iter().copied().peekable();
        for record in &program.records {
            let (Op::Line(_) | Op::Arc(_), Some(pose)) = (&record.op, record.op.pose()) else {
                continue;
            };
            // Blocks without a motion of their own (M8, F) repeat the last position; so does a full
            // circle, which this judge cannot tell from them.
            while let Some(end) = left.next_if(|end| near(*end, here) && !near(*end, pose.point()))
            {
                here = end;
            }
            match left.next_if(|end| near(*end, pose.point())) {
                Some(end) => here = end,
                None => assert!(
                    near(here, pose.point()),
                    "{}:{}: {:?}, then {:?}, is not {}",
                    file.display(),
                    record.line,
                    here,
                    left.peek(),
                    pose.point()
                ),
            }
        }
        assert!(left.all(|end| near(end, here)), "{}: cuts on after its end", file.display());
        eprintln!("{}: {} blocks", file.display(), ends.len());
        judged += 1;
    }
    assert!(judged > 0);
}
