//! What is to be cut: the contours of the source, for both ends of the wire.

use crate::answer::{Stop, Verdict};
use crate::args::{self, Sync};
use crate::toolpath::{self, Toolpath};
use geom::{Vec2, Vec3};
use machine::Machine;
use program::{Diagnostic, Op, Pose, Program};
use wire::{Contour, Path, contours, cuts};

/// A source with the ways that it gives the wire.
pub struct Source {
    /// The source; the lower contour where there are two.
    pub toolpath: Toolpath,
    /// One way for each opening.
    pub paths: Vec<Path>,
}

impl Source {
    /// Reads what `args` names, for `machine`.
    ///
    /// # Errors
    /// What is wrong with a file, or cannot be cut.
    pub fn read(args: &args::Wire, machine: &Machine) -> Result<Source, Stop> {
        let origin = &args.source.origin;
        let start = origin.start.map(|[x, y, _]| Vec2::new(x, y));
        let strict = args.source.strict;
        let read = |path| {
            toolpath::read_wire(path, strict, origin, args.ends.height).map_err(without_height)
        };
        let mut toolpath = read(&args.source.path)?;
        let told = |toolpath: &Toolpath, found: Box<Diagnostic>| {
            let mut findings = vec![*found];
            toolpath.quote(&mut findings);
            Stop { verdict: Verdict::Invalid, findings }
        };
        let lower = match leaning(&toolpath.program, machine) {
            Some(Ok((lower, upper))) => {
                if args.ends.upper.is_some() {
                    let message = "the source leans by itself, and has no second contour";
                    return Err(Diagnostic::error("upper", message)
                        .help("leave --upper out")
                        .into());
                }
                let both = (cuts(&lower, start), cuts(&upper, start));
                let found = match both {
                    (Ok(lower), Ok(upper)) => by_block(lower, upper),
                    (Err(found), _) | (_, Err(found)) => Err(found),
                };
                let paths = found.map_err(|found| told(&toolpath, found))?;
                return Ok(Source { toolpath, paths });
            }
            Some(Err(found)) => return Err(told(&toolpath, found)),
            None => &toolpath.program,
        };
        let paths = match &args.ends.upper {
            None => contours(lower, start).map(|all| all.into_iter().map(Path::upright).collect()),
            Some(path) => {
                let above = read(path)?;
                let upper = |found| told(&above, found);
                let paths = match args.ends.sync {
                    Sync::Block => {
                        let above = cuts(&above.program, start).map_err(upper)?;
                        cuts(lower, start).and_then(|below| by_block(below, above))
                    }
                    Sync::Length => {
                        let above = contours(&above.program, start).map_err(upper)?;
                        contours(lower, start).and_then(|below| by_length(&below, &above))
                    }
                };
                toolpath.warnings.extend(above.warnings);
                paths
            }
        };
        let paths: Vec<Path> = paths.map_err(|found| told(&toolpath, found))?;
        let leans = |path: &Path| path.upper().is_some();
        if paths.iter().any(leans) && machine.wire.is_none_or(|wire| wire.height.is_none()) {
            return Err(without_upper_plane().into());
        }
        Ok(Source { toolpath, paths })
    }
}

/// Says how a program that never names Z is read.
fn without_height(mut stop: Stop) -> Stop {
    for found in stop.findings.iter_mut().filter(|f| f.rule.ends_with("unknown-position")) {
        found.help =
            "--from with a wire machine, which has no Z; or --start with where it starts".into();
    }
    stop
}

fn by_block(
    below: Vec<Vec<wire::Element>>,
    above: Vec<Vec<wire::Element>>,
) -> Result<Vec<Path>, Box<Diagnostic>> {
    as_many(below.len(), above.len())?;
    below.into_iter().zip(above).map(|(below, above)| Path::by_block(below, above)).collect()
}

fn by_length(below: &[Contour], above: &[Contour]) -> Result<Vec<Path>, Box<Diagnostic>> {
    as_many(below.len(), above.len())?;
    below.iter().zip(above).map(|(below, above)| Path::by_length(below, above)).collect()
}

/// Both ends go through the same openings.
fn as_many(below: usize, above: usize) -> Result<(), Box<Diagnostic>> {
    if below == above {
        return Ok(());
    }
    let message = format!("the lower end cuts {below} contours and the upper {above}");
    let help = "a rapid parts two contours: both programs need the same ones in the same order";
    Err(Diagnostic::error("sync-openings", message).help(help).into())
}

/// Where the upper contour is, nobody has said.
fn without_upper_plane() -> Diagnostic {
    let message = "the wire leans, and the height of the upper contour is not known";
    Diagnostic::error("wire-height", message)
        .help("give it with --height, or as `height` in the [wire] table of the machine")
}

/// The ways of both ends of a wire that leans by itself, such as by U and V.
fn leaning(
    program: &Program,
    machine: &Machine,
) -> Option<Result<(Program, Program), Box<Diagnostic>>> {
    let leans = |pose: &Pose| pose.axis().is_some_and(|axis| axis.truncate() != Vec2::ZERO);
    let mut poses = program.records.iter().filter_map(|record| record.op.pose());
    if !poses.any(leans) {
        return None;
    }
    let (mut lower, mut upper) = (program.clone(), program.clone());
    for (below, above) in lower.records.iter_mut().zip(&mut upper.records) {
        let line = below.line;
        let Some(axis) = below.op.pose().and_then(Pose::axis) else { continue };
        let Some(lean) = machine.wire.and_then(|wire| wire.lean(axis)) else {
            return Some(Err(without_upper_plane().line(line).into()));
        };
        stand(&mut below.op, Vec2::ZERO);
        stand(&mut above.op, lean);
    }
    Some(Ok((lower, upper)))
}

/// The same move of an upright wire, moved by `by`.
fn stand(op: &mut Op, by: Vec2) {
    let upright = |pose: &mut Pose| *pose = Pose::new(pose.point + by.extend(0.0), Vec3::Z);
    match op {
        Op::Rapid(pose) | Op::Line(pose) => upright(pose),
        Op::Arc(arc) => {
            upright(&mut arc.end);
            arc.center += by.extend(0.0);
        }
        _ => {}
    }
}
