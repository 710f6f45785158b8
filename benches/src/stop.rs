//! How long work goes on that somebody ends: each step is ended at a tenth of its time, at two tenths and so on, on threads of its own as in the studio.

use crate::{clock, glass, layer, path};
use ::glass::sample::{Apart, surface};
use geom::ending::{Ended, go_on};
use program::Diagnostic;
use proof::{Observer, Tolerances};
use std::thread;
use std::time::Duration;

/// How often a step is ended, evenly over its time.
const TIMES: u32 = 9;

/// Asks as the studio does.
struct Asks;

impl Observer for Asks {
    fn reached(&mut self, _part: f64) -> bool {
        go_on();
        true
    }
}

/// Whoever waits for reading and writing.
fn asks(_part: f64) -> bool {
    go_on();
    true
}

/// Prints how long steps of a toolpath of so many points, of a layer of so many strokes, and of a body with some points go on.
///
/// # Errors
/// What is wrong with a program.
pub fn measure(records: usize, strokes: usize, pulses: usize) -> Result<(), Vec<Diagnostic>> {
    println!("work that is ended goes on for, at {TIMES} places of each step:");
    for name in ["generic-3axis-linuxcnc", "fanuc-table-bc"] {
        let machine = machine::load(name).map_err(|finding| vec![*finding])?;
        let text = path::cutter_location_data(records, !machine.rotary.is_empty());
        let options = source::apt::Options::default();
        let read = || source::apt::read_for("wave.apt", text.as_bytes(), &options, &asks);
        let program = read()?.program;
        let write = || post::write_named(&program, &machine, "wave.nc", &asks);
        let output = write()?;
        let tolerances = Tolerances::default();
        let prove = || {
            proof::prove_for(&program, &machine, "wave.nc", &output.text, &tolerances, &mut Asks)
        };
        row(&format!("{records} points read"), read);
        row(&format!("written, {name}"), write);
        row("proven", prove);
    }
    let text = layer::layer(strokes);
    let read = || pcb::gerber::read("layer.gbr", text.as_bytes());
    row(&format!("a layer of {strokes} strokes read"), read);
    let image = read()?.image;
    row("its copper united", || pcb::board::covered(&image));
    let body = glass::torus();
    // In squares of the spacing there are 0.7 points.
    let spacing = 1e3 * (0.7 * body.area() / pulses.max(1) as f64).sqrt();
    let apart = Apart { spacing: spacing as u32, lost: 0.0 };
    row(&format!("{pulses} points of a torus"), || surface(&body, apart, 1));
    Ok(())
}

/// Prints how long a step goes on behind its end: what who waits for it waits, and what it takes of the processor.
fn row<T: Send>(name: &str, work: impl Fn() -> T + Send + Sync) {
    let (_, whole) = clock::time(|| Ended::default().run(|| drop(work())));
    let mut behind: Vec<clock::Taken> =
        (1..=TIMES).map(|part| ended(&work, whole.wall * part / (TIMES + 1))).collect();
    behind.sort_by_key(|taken| taken.processor);
    let milliseconds = |time: Duration| 1e3 * time.as_secs_f64();
    let most = behind.iter().map(|taken| taken.wall).max().unwrap_or_default();
    println!(
        "  {name:34} {:6.1} ms of processor time in the middle, {:6.1} at most, {:6.1} ms of wall at most; {:.3} s without an end",
        milliseconds(behind[behind.len() / 2].processor),
        milliseconds(behind.last().map_or(Duration::ZERO, |taken| taken.processor)),
        milliseconds(most),
        whole.wall.as_secs_f64(),
    );
}

/// What work takes behind its end.
fn ended<T: Send>(work: &(impl Fn() -> T + Send + Sync), at: Duration) -> clock::Taken {
    let ended = Ended::default();
    thread::scope(|scope| {
        let running = scope.spawn(|| ended.run(|| drop(work())));
        thread::sleep(at);
        clock::time(|| {
            ended.end();
            running.join()
        })
        .1
    })
}
