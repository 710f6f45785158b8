//! A proof that hands out its walk, beside the same proof alone. Whoever follows keeps the motions as columns, as the studio does.

use crate::{fastest, path};
use program::Diagnostic;
use proof::{AxisPositions, MachineState, Motion, MotionKind, Observer, Tolerances};

/// The motions of a program, as columns.
#[derive(Default)]
struct Columns {
    kind: Vec<u8>,
    state: Vec<u32>,
    states: Vec<MachineState>,
    block: Vec<u32>,
    record: Vec<u32>,
    source_line: Vec<u32>,
    end_time: Vec<f64>,
    feed: Vec<f32>,
    tip: Vec<[f64; 3]>,
    axis: Vec<[f32; 3]>,
    axes: Vec<[f64; 6]>,
    time: f64,
}

impl Observer for Columns {
    fn wants_motions(&self) -> bool {
        true
    }

    fn stated(&mut self, state: &MachineState) {
        self.states.push(state.clone());
    }

    fn moved(&mut self, motion: &Motion) {
        self.kind.push(match motion.kind {
            MotionKind::Rapid => 0,
            MotionKind::Line => 1,
            MotionKind::Arc(_) => 2,
            MotionKind::Joints => 3,
        });
        self.state.push(self.states.len() as u32);
        self.block.push(motion.line);
        self.record.push(motion.record as u32);
        self.source_line.push(motion.source_line);
        self.time += motion.waited + motion.seconds;
        self.end_time.push(self.time);
        self.feed.push(motion.feed.map_or(f32::NAN, |feed| feed.value() as f32));
        self.tip.push(motion.tool[1].tip.to_array());
        self.axis.push(motion.tool[1].axis.to_array().map(|part| part as f32));
        self.axes.push(match motion.axes {
            AxisPositions::Mill { linear, rotary: [a, b, c] } => {
                [linear.x, linear.y, linear.z, a, b, c]
            }
            AxisPositions::Wire { guide, lean: [u, v] } => {
                [guide.x, guide.y, guide.z, u, v, f64::NAN]
            }
            AxisPositions::Arm { joints, .. } => joints,
        });
    }
}

/// Prints what the walk of a proof of so many points takes, on a machine with three axes and on these.
///
/// # Errors
/// What is wrong with a program.
pub fn measure(records: usize, machines: &[String], rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let upright = String::from("generic-3axis-linuxcnc");
    for name in std::iter::once(&upright).chain(machines) {
        let machine = machine::load(name).map_err(|finding| vec![*finding])?;
        let text = path::cutter_location_data(records, !machine.rotary.is_empty());
        let options = source::apt::Options::default();
        let source = source::apt::read("wave.apt", text.as_bytes(), &options)?.program;
        let output = post::write(&source, &machine)?;
        let prove = |observer: &mut dyn Observer| {
            let tolerances = Tolerances::default();
            let text = &output.text;
            let report =
                proof::prove_for(&source, &machine, "wave.nc", text, &tolerances, observer);
            if report.proven { Ok(()) } else { Err(report.mismatches) }
        };
        let alone = fastest(rounds, &mut || prove(&mut ()))?;
        let mut moves = 0;
        let walked = fastest(rounds, &mut || {
            let mut columns = Columns::default();
            prove(&mut columns)?;
            moves = columns.kind.len();
            std::hint::black_box(columns);
            Ok(())
        })?;
        println!(
            "{name}: a proof of {records} points alone: {}\n  that hands out its walk of {moves} motions, kept as columns: {}\n    \
             divided by the proof alone: {:.2}; peak {} bytes a motion",
            alone.time,
            walked.time,
            walked.time.times(alone.time),
            walked.peak.div_ceil(moves.max(1)),
        );
    }
    Ok(())
}
