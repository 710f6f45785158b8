//! How fast a five-axis program is read, written and proven, and how much memory that takes, compared with a
//! floor in the same run.
//!
//! Every figure is two: **processor time**, which counts all threads of the process together, also those that have
//! ended, and **wall**, from start to end ([`clock`]). A program that works on two threads takes more processor time
//! than wall. Each stage runs `--rounds` times, a short one until 0.3 s have gone by; the round that is fastest by
//! wall counts, with its own processor time. Against a floor or a peer, processor time is divided by processor time and wall by wall. Other work on the
//! machine makes the wall longer and changes the processor time little: compare runs by processor time, and wall
//! only on an idle machine.
//!
//! The clock itself is checked ([`outside`]): a stage runs again in a process of its own, and the processor time that
//! the system accounts to that process has to agree. Otherwise the run fails.
//!
//! The toolpath is generated ([`path`]). NC programs are run on the virtual controls ([`programs`]), the contour of a
//! wire becomes points ([`wire`]). Circuit boards: copper united and grown ([`copper`]), a Gerber layer read
//! ([`layer`]), real boards made whole ([`board`]). Joints of an arm are found for frames ([`mod@arm`]), points
//! in glass are found and ordered ([`mod@glass`]). Memory is what the program asks the allocator for
//! ([`memory`]), the most of all rounds. A path ten times as long, for the first machine, shows that time
//! and memory grow no faster. A proof that hands out its walk, kept and not kept, is compared with the proof alone ([`walk`]). Steps that are ended in their middle ([`stop`]). Then come real files
//! ([`library`]).

mod arm;
mod board;
mod clock;
mod copper;
mod floor;
mod glass;
mod layer;
mod library;
mod memory;
mod outside;
mod path;
mod programs;
mod stop;
mod walk;
mod wire;

use clap::Parser;
use clock::Taken;
use machine::Machine;
use program::{Diagnostic, Program};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting;

/// Measures reading, writing and proving against a floor.
#[derive(Parser)]
struct Arguments {
    /// Points of the toolpath; 0 leaves it out.
    #[arg(long, default_value_t = 2_000_000)]
    records: usize,
    /// Machine of the library, or the path of its file; may be given several times.
    #[arg(long, default_values_t = [String::from("dmu50-heidenhain")])]
    machine: Vec<String>,
    /// Rounds of each stage at least; the fastest by wall counts, with its processor time.
    #[arg(long, default_value_t = 3)]
    rounds: usize,
    /// Blocks of the NC programs; 0 leaves them out.
    #[arg(long, default_value_t = 200_000)]
    blocks: usize,
    /// Arcs of the contour of a wire; 0 leaves it out.
    #[arg(long, default_value_t = 100_000)]
    arcs: usize,
    /// Pads and tracks of a circuit board, and sixteen times as many; 0 leaves it out.
    #[arg(long, default_value_t = 2000)]
    shapes: usize,
    /// Strokes of a copper layer; 0 leaves it out.
    #[arg(long, default_value_t = 16_000)]
    strokes: usize,
    /// Frames that an arm is to reach; 0 leaves it out.
    #[arg(long, default_value_t = 200_000)]
    frames: usize,
    /// Points on a sphere and a torus in glass; 0 leaves them out.
    #[arg(long, default_value_t = 100_000)]
    pulses: usize,
    /// Body (.stl, .obj, .ply, .3mf) that gets as many points; may be given several times.
    #[arg(long)]
    body: Vec<PathBuf>,
    /// Points of a solid ball in glass, from its mesh to a proven program; 0 leaves it out.
    #[arg(long, default_value_t = 200_000)]
    solid: usize,
    /// Folder of a real circuit board, to be made whole; may be given several times.
    #[arg(long)]
    board: Vec<PathBuf>,
    /// Real files of cutter-location data, to be proven on every machine of the library.
    files: Vec<PathBuf>,
}

/// What a stage took.
struct Measured {
    /// The fastest round by wall.
    time: Taken,
    /// The most bytes in use at once, beyond those before it, of all rounds.
    peak: usize,
}

fn main() -> ExitCode {
    if let Some(code) = outside::asked() {
        return code.into();
    }
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(findings) => {
            findings.iter().take(5).for_each(|finding| eprintln!("{finding}"));
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Vec<Diagnostic>> {
    let machine = arguments.machine.first().map_or("", String::as_str);
    outside::check(arguments.blocks, arguments.records, machine, arguments.rounds)?;
    if arguments.blocks > 0 {
        programs::measure(arguments.blocks, arguments.rounds)?;
    }
    if arguments.arcs > 0 {
        wire::measure(arguments.arcs, arguments.rounds)?;
    }
    if arguments.shapes > 0 {
        copper::measure(arguments.shapes, arguments.rounds)?;
    }
    if arguments.strokes > 0 {
        layer::measure(arguments.strokes, arguments.rounds)?;
    }
    if arguments.frames > 0 {
        arm::measure(arguments.frames, arguments.rounds)?;
    }
    if arguments.pulses > 0 {
        glass::measure(arguments.pulses, &arguments.body, arguments.rounds)?;
    }
    if arguments.solid > 0 {
        glass::solid(arguments.solid)?;
    }
    board::measure(&arguments.board, arguments.rounds)?;
    if arguments.records > 0 {
        five_axes(arguments)?;
        walk::measure(arguments.records, &arguments.machine, arguments.rounds)?;
    }
    if arguments.records > 0 {
        stop::measure(arguments.records / 2, arguments.strokes, arguments.pulses)?;
    }
    library::measure(&arguments.files, arguments.rounds)
}

/// A five-axis toolpath, read, written and proven.
fn five_axes(arguments: &Arguments) -> Result<(), Vec<Diagnostic>> {
    let text = path::cutter_location_data(arguments.records, true);
    let table = Table { records: arguments.records };
    println!("{} GOTO, {} MB of cutter-location data", arguments.records, text.len() / 1_000_000);
    let measure =
        |work: &mut dyn FnMut() -> Result<(), Vec<Diagnostic>>| fastest(arguments.rounds, work);

    let by_hand = measure(&mut || keep(floor::by_hand(text.as_bytes())))?;
    let standard = measure(&mut || keep(floor::standard(text.as_bytes())))?;
    table.head();
    table.row("floor: numbers in and out, by hand", &by_hand, &by_hand, &standard);
    table.row("floor: the same, standard library", &standard, &by_hand, &standard);
    let reading = measure(&mut || keep(read(&text)?))?;
    table.row("read", &reading, &by_hand, &standard);
    let before = memory::live();
    let source = read(&text)?;
    let stored = memory::live() - before;

    let folder = tempfile::tempdir().map_err(|error| outside::failed(&error))?;
    let path = folder.path().join("wave.apt");
    let saved = folder.path().join("wave.nc").display().to_string();
    std::fs::write(&path, &text).map_err(|error| outside::failed(&error))?;

    for (i, name) in arguments.machine.iter().enumerate() {
        let machine = machine::load(name).map_err(|finding| vec![*finding])?;
        println!("{name}");
        let writing = measure(&mut || keep(post::write(&read(&text)?, &machine)?))?;
        table.row("read, kinematics, write", &writing, &by_hand, &standard);
        let output = post::write(&source, &machine)?;
        let proving = measure(&mut || read_write_prove(&text, &machine))?;
        table.row("read, kinematics, write, prove", &proving, &by_hand, &standard);
        println!(
            "  the proof: {:.3}\n    all divided by all without the proof: {:.2}\n  \
             program text {} MB; in addition to the texts {} bytes a move to write, {} to prove",
            proving.time.beyond(writing.time),
            proving.time.times(writing.time),
            output.text.len() / 1_000_000,
            table.each(writing.peak.saturating_sub(output.text.capacity())),
            table.each(proving.peak.saturating_sub(output.text.capacity())),
        );
        drop(output);
        let file = path.display().to_string();
        let words = ["--quiet", "post", &file, "--machine", name, "--output", &saved];
        let whole = outside::command(&words, arguments.rounds)?;
        println!(
            "  the whole command `toolpost post`: {whole}; of it read, write, prove: {:.0} % of the processor time",
            100.0 * proving.time.times(whole).processor
        );
        if i == 0 {
            ten_times(arguments.records, &machine, &proving)?;
        }
    }
    println!("the program in memory: {} bytes a move", table.each(stored));
    Ok(())
}

/// Reads, writes and proves a path ten times as long as that of `once`.
fn ten_times(records: usize, machine: &Machine, once: &Measured) -> Result<(), Vec<Diagnostic>> {
    let text = path::cutter_location_data(10 * records, true);
    let all = fastest(1, &mut || read_write_prove(&text, machine))?;
    println!(
        "  {} GOTO to read, write and prove: {:.1}\n  \
         a tenth of it divided by the above: {:.2}; peak {} bytes a move, program text included",
        10 * records,
        all.time,
        all.time.share(10).times(once.time),
        all.peak.div_ceil(10 * records.max(1)),
    );
    Ok(())
}

fn read(text: &str) -> Result<Program, Vec<Diagnostic>> {
    let options = source::apt::Options::default();
    Ok(source::apt::read("wave.apt", text.as_bytes(), &options)?.program)
}

fn read_write_prove(text: &str, machine: &Machine) -> Result<(), Vec<Diagnostic>> {
    let program = read(text)?;
    let output = post::write(&program, machine)?;
    let report =
        proof::prove(&program, machine, "wave.nc", &output.text, &proof::Tolerances::default());
    if report.proven { Ok(()) } else { Err(report.mismatches) }
}

/// Keeps a result from being optimised away.
fn keep<T>(result: T) -> Result<(), Vec<Diagnostic>> {
    std::hint::black_box(&result);
    Ok(())
}

/// How long all rounds of a stage take together at least.
const LEAST: Duration = Duration::from_millis(300);

/// The fastest of several rounds by wall, and the most memory. A short stage has more rounds.
fn fastest(
    rounds: usize,
    work: &mut dyn FnMut() -> Result<(), Vec<Diagnostic>>,
) -> Result<Measured, Vec<Diagnostic>> {
    let mut best = Measured { time: Taken::MAX, peak: 0 };
    let (start, mut round) = (Instant::now(), 0);
    while round < rounds.max(1) || start.elapsed() < LEAST {
        round += 1;
        let ((result, peak), taken) = clock::time(|| memory::peak(&mut *work));
        result?;
        best = Measured { time: best.time.faster(taken), peak: best.peak.max(peak) };
    }
    Ok(best)
}

/// The figures, a row a stage: processor time on the left, wall on the right.
struct Table {
    records: usize,
}

impl Table {
    fn head(&self) {
        let columns = format!("{:>9}{:>8}{:>9}{:>10}", "s", "M/s", "by hand", "standard");
        println!("{:36}{:>36}{:>36}", "", "processor time", "wall");
        println!("{:36}{columns}{columns}", "");
    }

    fn row(&self, name: &str, stage: &Measured, by_hand: &Measured, standard: &Measured) {
        let (by_hand, standard) = (stage.time.times(by_hand.time), stage.time.times(standard.time));
        let half = |time: Duration, by_hand: f64, standard: f64| {
            let seconds = time.as_secs_f64();
            let millions = self.records as f64 / seconds / 1e6;
            format!("{seconds:9.3}{millions:8.2}{by_hand:8.2}x{standard:9.2}x")
        };
        println!(
            "{name:36}{}{}",
            half(stage.time.processor, by_hand.processor, standard.processor),
            half(stage.time.wall, by_hand.wall, standard.wall),
        );
    }

    /// Bytes for each record, rounded up.
    fn each(&self, bytes: usize) -> usize {
        bytes.div_ceil(self.records.max(1))
    }
}
