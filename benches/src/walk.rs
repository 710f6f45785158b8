//! A proof that hands out its walk, beside the same proof alone: to whoever looks at each motion and keeps none, and to the studio,
//! which keeps them as columns. The three take turns, so that other work on the machine meets all of them alike.

use crate::clock::{self, Taken};
use crate::{memory, path};
use geom::ending::Ended;
use program::Diagnostic;
use proof::{Motion, Observer, Tolerances};
use studio::walk::{Follower, Slot};

/// Looks at each motion, and keeps none.
#[derive(Default)]
struct Looks {
    motions: usize,
    seconds: f64,
}

impl Observer for Looks {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &Motion) {
        self.motions += 1;
        self.seconds += motion.waited + motion.seconds;
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
        let prove = |observer: &mut dyn Observer, least: &mut Taken| {
            let tolerances = Tolerances::default();
            let text = &output.text;
            let (report, taken) = clock::time(|| {
                proof::prove_for(&source, &machine, "wave.nc", text, &tolerances, observer)
            });
            *least = least.least(taken);
            if report.proven { Ok(()) } else { Err(report.mismatches) }
        };
        let [mut alone, mut told, mut kept] = [Taken::MAX; 3];
        let (mut motions, mut peak) = (0, 0);
        for _ in 0..rounds.max(1) {
            prove(&mut (), &mut alone)?;
            let mut looks = Looks::default();
            prove(&mut looks, &mut told)?;
            std::hint::black_box(looks.seconds);
            motions = looks.motions;
            let ended = Ended::default();
            let mut follower =
                Follower::new("wave.nc", &source, &machine, (&(), &ended), Slot::default());
            let (followed, most) = memory::peak(|| prove(&mut follower, &mut kept));
            followed?;
            peak = peak.max(most);
        }
        println!(
            "{name}: a proof of {records} points alone: {alone}\n  that hands out its {motions} motions: {told}\n    \
             divided by the proof alone: {:.2}\n  that has them kept as columns: {kept}\n    \
             divided by the proof alone: {:.2}; peak {} bytes a motion",
            told.times(alone),
            kept.times(alone),
            peak.div_ceil(motions.max(1)),
        );
    }
    Ok(())
}
