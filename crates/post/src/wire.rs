//! The wire of a machine for wire EDM: where it is threaded and cut, and how far it leans.

use crate::catalogue::{BlockName, WordName};
use crate::walk::{Outcome, Walk, refuse};
use geom::{Vec2, Vec3};
use machine::Machine;
use program::{Diagnostic, Pose, Program, Rule};

/// How far from the lower plane a pose may be, mm: rounding of its source.
const FLAT: f64 = 1e-6;

/// The wire while a program is written.
pub(crate) struct Wire {
    machine: machine::Wire,
    /// Whether it leans anywhere in the program: every block then says how far.
    leans: bool,
    threaded: bool,
    /// By how much the control is to lean it, degrees as [`program::Op::Taper`] counts them, and by how
    /// much it does.
    taper: f64,
    active_taper: f64,
    /// Openings that it has been threaded for.
    openings: usize,
}

impl Wire {
    /// The wire of `machine`, where it has one, not threaded.
    pub(crate) fn of(machine: &Machine, program: &Program) -> Option<Wire> {
        let leans = || {
            let mut poses = program.records.iter().filter_map(|record| record.op.pose());
            poses.any(|pose| pose.axis() != Vec3::Z)
        };
        machine.wire.map(|machine| Wire {
            machine,
            leans: leans(),
            threaded: false,
            taper: 0.0,
            active_taper: 0.0,
            openings: 0,
        })
    }
}

impl Walk<'_> {
    /// The wire is threaded where it stands.
    pub(crate) fn thread_wire(&mut self) -> Outcome {
        let threads = !self.machine.leaves_out(BlockName::ThreadWire.name());
        let Some(wire) = &mut self.wire else { return Err(no_wire()) };
        if wire.threaded {
            return Err(refuse(Rule::WireThreaded, "the wire is threaded already"));
        }
        (wire.threaded, wire.openings) = (true, wire.openings + 1);
        if wire.openings > 1 && !threads {
            let message = "a second opening: the control has no word that threads the wire again";
            return Err(refuse(Rule::OneOpening, message)
                .help("a program for each opening")
                .into());
        }
        self.block(BlockName::ThreadWire)
    }

    /// The wire is cut.
    pub(crate) fn cut_wire(&mut self) -> Outcome {
        self.uncompensated("the end of the opening")?;
        let Some(wire) = &mut self.wire else { return Err(no_wire()) };
        if wire.active_taper != 0.0 {
            let message = "the end of the opening while the control leans the wire";
            return Err(refuse(Rule::TaperActive, message));
        }
        if !std::mem::take(&mut wire.threaded) {
            return Err(refuse(Rule::NoWire, "the wire is cut, and none is threaded"));
        }
        self.block(BlockName::CutWire)
    }

    /// The control is to lean the wire from the next straight cut on.
    pub(crate) fn set_taper(&mut self, degrees: f64) -> Outcome {
        let written = self.templates.places(BlockName::Linear, WordName::Taper);
        let Some(wire) = &mut self.wire else { return Err(no_wire()) };
        if degrees != 0.0 && !written {
            let message = "the control leans no wire by an angle";
            let help = "a taper that is worked out here, or a machine that leans the wire";
            return Err(refuse(Rule::Taper, message).help(help).into());
        }
        if degrees.abs() > wire.machine.taper_max {
            let most = wire.machine.taper_max;
            let message =
                format!("a taper of {degrees}°: the machine leans the wire by {most}° at most");
            return Err(refuse(Rule::TaperLimit, message));
        }
        wire.taper = degrees;
        Ok(())
    }

    /// Says in the next block, a straight cut, how the control is to lean the wire.
    pub(crate) fn say_taper(&mut self) {
        let Some(wire) = &mut self.wire else { return };
        if wire.taper != wire.active_taper {
            wire.active_taper = wire.taper;
            if wire.taper != 0.0 {
                self.writer.set(WordName::Taper, wire.taper.abs());
            }
        }
        let side = match wire.active_taper {
            0.0 => 0,
            left if left > 0.0 => 1,
            _ => 2,
        };
        self.writer.code(WordName::TaperSide, side);
    }

    /// # Errors
    /// The lean by the control is about to change, and `what` cannot do it.
    pub(crate) fn same_taper(&self, what: &str) -> Outcome {
        match &self.wire {
            Some(wire) if wire.taper != wire.active_taper => Err(refuse(
                Rule::Taper,
                format!("a taper is switched by a straight cut, not by {what}"),
            )),
            _ => Ok(()),
        }
    }

    /// Holds the wire against what comes next: a cut needs it threaded, a rapid or the end needs it cut.
    pub(crate) fn wire_for(&self, cut: bool, what: &str) -> Outcome {
        match &self.wire {
            Some(wire) if wire.threaded && !cut => {
                let message =
                    format!("{what} while the wire is threaded: it would go through the part");
                Err(refuse(Rule::WireThreaded, message).help("cut the wire before").into())
            }
            Some(wire) if !wire.threaded && cut => {
                let message = format!("{what} before the wire is threaded");
                Err(refuse(Rule::NoWire, message).help("thread the wire at the start").into())
            }
            _ => Ok(()),
        }
    }

    /// Whether the wire can stand at `pose`.
    pub(crate) fn wire_stands(&self, wire: &Wire, pose: &Pose) -> Outcome {
        if pose.point().z.abs() > FLAT {
            let message = format!("Z{:.4}: a wire crosses the lower plane at Z0", pose.point().z);
            let help = "`toolpost wire` makes the way of a wire from a contour at any height";
            return Err(refuse(Rule::WirePlane, message).help(help).into());
        }
        if !wire.leans {
            return Ok(());
        }
        if !self.templates.places(BlockName::Linear, WordName::U) {
            return Err(refuse(Rule::WireLeans, "the wire leans, and the control has no U and V"));
        }
        let axis = pose.axis();
        let Some(lean) = wire.machine.lean(axis) else {
            let message = "the wire leans, and the height of the upper plane is not known";
            let help = "`height` in the [wire] table of the machine, or --uv-height for one run";
            return Err(refuse(Rule::WireHeight, message).help(help).into());
        };
        self.limits.lean(lean, axis, self.line)
    }

    /// Says in the next block how far the wire leans.
    pub(crate) fn say_lean(&mut self, axis: Vec3) {
        let Some(wire) = self.wire.as_ref().filter(|wire| wire.leans) else { return };
        let lean = wire.machine.lean(axis).unwrap_or(Vec2::ZERO);
        self.writer.set(WordName::U, lean.x);
        self.writer.set(WordName::V, lean.y);
    }
}

fn no_wire() -> Box<Diagnostic> {
    let help = "a machine for wire EDM: one whose file has a [wire] table";
    refuse(Rule::Unsupported, "the program threads a wire, and this machine has none")
        .help(help)
        .into()
}
