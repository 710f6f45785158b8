//! A program that finds the surface itself, and follows it.

use crate::grid::{Grid, Probing};
use crate::ground::Ground;
use crate::level::{Allowed, levelled, refused};
use geom::Vec3;
use program::{Diagnostic, Op, Program, Record, Rule, Spindle, Surface, lowering};

/// The program that probes the surface with its first tool before that cuts, and then has the surface where
/// `program` has Z 0, as [`crate::level()`] has it of a map: [`Op::Surface`] says so. It stops before the probing and
/// behind it, for the operator to clip the probe on and off. Cuts are divided for a surface that rises by `steepness`
/// mm a mm along X and along Y at most; on one that is twice as steep the deviation is up to twice that allowed.
/// Holes are drilled by moves, rapids rise by the reach of the probe.
///
/// # Errors
/// Those of [`crate::level()`]; a grid or a probing that is none; a program without tool, with a move or a turning
/// spindle before the first; a cycle that moves cannot make; rapids across the board that are no higher than cuts.
pub fn follow(
    program: &Program,
    grid: &Grid,
    probing: &Probing,
    steepness: f64,
    allowed: &Allowed,
) -> Result<Program, Box<Diagnostic>> {
    if !(steepness > 0.0 && steepness <= 1.0) {
        let message = format!("a surface that rises by {steepness} mm a mm");
        let help = "more than 0, and 1 at most";
        return Err(Diagnostic::error(Rule::LevellingTolerance, message).help(help).into());
    }
    let [columns, rows] = grid.lines();
    let wide = columns.len();
    let mut moves = probing.moves(grid, |(column, row)| u32::try_from(row * wide + column).ok())?;
    let reach = [-probing.reach, probing.reach];
    let surface = Surface::new(columns.to_vec(), rows.to_vec(), reach, f64::INFINITY)?;
    let ground = Ground::Found(&surface, steepness);
    let level = levelled(&drilled(program)?, ground, allowed)?;
    let (mut records, clear) = (level.records, level.clears);
    if level.follows >= clear {
        let message =
            format!("a cut at Z{}, and a rapid across the board at Z{clear} mm", level.follows);
        return Err(refused(message, "higher rapids"));
    }
    let first = first_tool(&records)?;
    // From the last place the tool goes up as high as it then goes across.
    if let Some(Op::Rapid(last)) = moves.last_mut().filter(|_| clear.is_finite()) {
        *last = last.at(last.point().with_z(last.point().z.max(clear)))?;
    }
    let line = records.get(first).map_or(0, |record| record.line);
    let said = |text: &str| [Op::Message(text.into()), Op::Stop];
    let probed = said("clip the probe to the board and to the tool").into_iter().chain(moves);
    let probed = probed.chain(said("take the probe off the tool"));
    let probed = probed.chain([Op::Surface(Box::new(surface.counted_below(clear)?))]);
    let probed: Vec<Record> = probed.map(|op| Record { line, op }).collect();
    records.splice(first + 1..first + 1, probed);
    Ok(program.with_records(records))
}

/// Where the first tool is called, with which the surface is probed.
fn first_tool(records: &[Record]) -> Result<usize, Box<Diagnostic>> {
    for (index, record) in records.iter().enumerate() {
        let message = match &record.op {
            Op::Tool(_) => return Ok(index),
            Op::Spindle(Spindle::Clockwise(_) | Spindle::CounterClockwise(_)) => {
                "a spindle that turns"
            }
            op if op.pose().is_some() => "a move",
            _ => continue,
        };
        let message =
            format!("{message} before a tool is called, with which the surface is probed");
        return Err(Box::new(refused(message, "call the tool first").line(record.line)));
    }
    Err(refused("no tool is called, with which the surface is probed", "call one first"))
}

/// The program with the moves of holes in place of cycles.
fn drilled(program: &Program) -> Result<Program, Box<Diagnostic>> {
    let mut moves = Program::new(program.name.clone());
    let (mut cycle, mut feed, mut spindle) = (None, None, Spindle::Off);
    let mut height = f64::NEG_INFINITY;
    for Record { line, op } in &program.records {
        match op {
            Op::Cycle(defined) => cycle = Some(**defined),
            Op::CycleOff => {
                if let Some(feed) = feed.filter(|_| cycle.take().is_some()) {
                    moves.push(*line, Op::Feed(feed));
                }
            }
            Op::Hole(pose) => {
                let made =
                    cycle.and_then(|cycle| Some((cycle, lowering::hole(&cycle, pose, spindle)?)));
                let Some((cycle, hole)) = made else {
                    let message = "a hole that moves cannot make";
                    return Err(Box::new(
                        refused(message, "drill it in a program of its own").line(*line),
                    ));
                };
                let at = |z: f64| pose.at(pose.point() + Vec3::Z * z).map(Op::Rapid);
                let across = cycle.retract.max(height - pose.point().z);
                moves.push(*line, at(across)?);
                moves.push(*line, at(cycle.clearance)?);
                if let Some(feed) = cycle.feed {
                    moves.push(*line, Op::Feed(feed));
                }
                hole.into_iter().for_each(|part| moves.push(*line, part.into()));
                height = pose.point().z + cycle.retract;
            }
            op => {
                match op {
                    Op::Feed(found) => feed = Some(*found),
                    Op::Spindle(found) => spindle = *found,
                    Op::Tool(_) => height = f64::NEG_INFINITY,
                    op => height = op.pose().map_or(height, |pose| pose.point().z),
                }
                moves.push(*line, op.clone());
            }
        }
    }
    Ok(moves)
}
