//! `toolpost glass`: engraving inside glass.

use crate::answer::{Answer, not_saved};
use crate::args::glass::{self as args, Engrave, Glass, GlassCommand, Job};
use crate::progress::Progress;
use ::glass::engraver::State;
use ::glass::list::Columns;
use ::glass::machine::Machine;
use ::glass::mesh::{self, Shape};
use ::glass::optics::Ray;
use ::glass::order::Effort;
use ::glass::profile::Limits;
use ::glass::scenario::Blocks;
use ::glass::simulate::{Events, simulate};
use ::glass::source::surrogate::FITTED;
use ::glass::{cloud, comparison, control, material, source};
use app::files::{self, Target};
use app::glass::job::Order;
use app::glass::{self, Settings};
use app::{Stop, Verdict, Watch};
use drawing::Format;
use program::{Diagnostic, Rule};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Obeys the command.
pub fn run(args: &Glass, silent: bool) -> Result<Answer, Stop> {
    match args {
        Glass::Engrave(engraving) => engrave(engraving, silent),
        Glass::Command(GlassCommand::Tables { output }) => tables(output.as_deref()),
        Glass::Command(GlassCommand::Show { name }) => show(name),
        Glass::Command(GlassCommand::Prove { program, job }) => prove(program, job, silent),
        Glass::Command(GlassCommand::Simulate {
            program,
            machine,
            from,
            until,
            door,
            misses,
            feedback,
            seed,
            start,
            output,
        }) => {
            let events = Events {
                from: *from,
                until: *until,
                door: *door,
                misses: misses.unwrap_or_default(),
                feedback: *feedback,
                seed: *seed,
            };
            simulated(program, machine, events, *start, output.as_deref())
        }
        Glass::Command(GlassCommand::Sweep { program, machine, output }) => {
            swept(program, machine, output.as_deref())
        }
        Glass::Command(GlassCommand::Reach { machine, block, output }) => {
            reach(machine, *block, output)
        }
        Glass::Command(GlassCommand::Check { points, spacing, columns }) => {
            check(points, *spacing, *columns)
        }
    }
}

/// The tables of the source next to ours.
fn tables(output: Option<&Path>) -> Result<Answer, Stop> {
    if let Some(output) = output {
        let target = Target::new(output, &[])?;
        let drawn = drawing::charts("THROUGHPUT: MARKS ARE THE SOURCE, LINES THE MODEL", &charts());
        let bytes = Format::of(output)?.bytes(drawn)?;
        files::save(&[(&target, &bytes)])?;
    }
    let data = json!({ "series": source::series(), "checks": source::checks() });
    Ok(Answer::product(source::report(), data))
}

/// The series of the source as charts, and what other drives would reach.
fn charts() -> Vec<drawing::Chart> {
    let all = source::series();
    let (by_angle, swept): (Vec<_>, Vec<_>) =
        all.iter().partition(|series| series.rows.iter().all(|row| row.ours.is_none()));
    let curve = |color: usize, name: &str, is_marked: bool, points: Vec<[f64; 2]>| drawing::Curve {
        name: name.to_uppercase().replace('²', "2"),
        points,
        is_marked,
        color,
    };
    type Value = fn(&source::Row) -> Option<f64>;
    let chart = |up: &str, across: &str, series: &[&source::Series], values: [Value; 2]| {
        let curves = series.iter().enumerate().flat_map(|(color, series)| {
            let name = series.title.split(", by").next().unwrap_or_default();
            [true, false].map(|is_marked| {
                let place = |row: &source::Row| {
                    Some([row.parameter, values[usize::from(!is_marked)](row)?])
                };
                let points: Vec<_> = series.rows.iter().filter_map(place).collect();
                curve(color, name, is_marked, points)
            })
        });
        let curves = curves.filter(|curve| !curve.points.is_empty()).collect();
        drawing::Chart { up: up.to_owned(), across: across.to_owned(), curves }
    };
    let rates: [Value; 2] = [|row| Some(row.rate), |row| Some(source::POINTS / row.ours?)];
    let times: [Value; 2] = [|row| Some(row.time), |row| row.ours];
    let drive = |color: usize, rate: f64| {
        let of = |acceleration: f64| {
            let limits = Limits::metric(acceleration, 1.5);
            [acceleration, rate / FITTED.ticks_per_point(rate, limits)]
        };
        let points = (4..=60).map(|half| of(0.5 * f64::from(half))).collect();
        curve(color, &format!("{rate} Hz, 1.5 m/s"), false, points)
    };
    let drives = [50.0, 100.0, 200.0].into_iter().enumerate();
    vec![
        chart("POINTS/S", "ACCELERATION, M/S2", &swept, rates),
        chart("TIME OF 16179 POINTS, S", "ACCELERATION, M/S2", &swept, times),
        chart("POINTS/S", "SORTING ANGLE, DEGREES", &by_angle, rates),
        drawing::Chart {
            up: String::from("POINTS/S, PREDICTED"),
            across: String::from("ACCELERATION, M/S2"),
            curves: drives.map(|(color, rate)| drive(color, rate)).collect(),
        },
    ]
}

/// Cells of a map of reach along X.
const CELLS: u32 = 200;

/// Draws what an arm reaches.
fn reach(name: &str, block: [f64; 3], output: &Path) -> Result<Answer, Stop> {
    let target = Target::new(output, &[Path::new(name)])?;
    let format = Format::of(output)?;
    let machine = glass::machine(name)?;
    let Some(table) = machine.polar else {
        let message = format!("{} has no arm and no turning table", machine.title);
        let found = Diagnostic::error(Rule::GlassBlock, message);
        return Err(found.help("name a machine of kind = \"polar\"").into());
    };
    if let Some(message) = machine.refuses(block, 1) {
        let found = Diagnostic::error(Rule::GlassBlock, message);
        return Err(found.help("take a smaller --block").into());
    }
    let cells = Blocks { machine: &machine, table, block, count: 1 }.map(CELLS);
    let picture = drawing::ReachPicture {
        block: [block[0], block[1]],
        offset: table.offset,
        table: table.radius,
        arm: [table.distance, table.arm],
        cells: (CELLS as usize, &cells),
    };
    let bytes = format.bytes(drawing::reach(&machine.title, &picture))?;
    files::save(&[(&target, &bytes)])?;
    let missed = cells.iter().filter(|reached| !**reached).count() as f64 / cells.len() as f64;
    let rows = [
        ("machine", machine.title.clone()),
        ("not reached", format!("{:.1} % of the block", 100.0 * missed)),
        ("saved", output.display().to_string()),
    ];
    let data = json!({ "machine": machine.title, "block": block, "unreachable": missed });
    Ok(Answer::summary(Verdict::Done, app::summary::rows(&rows), data))
}

/// A program as its machine runs it.
fn run_of(program: &Path, machine: &Machine) -> Result<control::Run, Stop> {
    let in_program = |found: Vec<Diagnostic>| {
        found.into_iter().map(|found| found.file(files::name(program))).collect::<Vec<_>>()
    };
    Ok(control::read(&glass::program(&program.into(), machine)?, machine).map_err(in_program)?)
}

/// What a program takes on other drives.
fn swept(program: &Path, name: &str, output: Option<&Path>) -> Result<Answer, Stop> {
    let inputs = [program, Path::new(name)];
    let drawn = output.map(|file| Ok::<_, Stop>((Target::new(file, &inputs)?, Format::of(file)?)));
    let drawn = drawn.transpose()?;
    let machine = glass::machine(name)?;
    let run = run_of(program, &machine)?;
    let swept =
        comparison::sweep(&run, &machine).map_err(|found| found.file(files::name(program)))?;
    let unit = if machine.coordinates()[0].turns { "deg/s2" } else { "m/s2" };
    let rates: Vec<&[comparison::Swept]> = swept.chunk_by(|a, b| a.rate == b.rate).collect();
    let mut text = format!(
        "{}: {} pulses; points/s, and s, by the acceleration of {} (all axes in proportion)\n\n{unit:>10}",
        machine.title,
        run.pulses.len(),
        machine.coordinates()[0].word
    );
    rates.iter().for_each(|own| text.push_str(&format!("{:>17} Hz", own[0].rate)));
    text.push('\n');
    for row in 0..rates.first().map_or(0, |own| own.len()) {
        text.push_str(&format!("{:>10.3}", rates[0][row].acceleration));
        for own in &rates {
            text.push_str(&format!("{:>8.2} {:>9.1} s", own[row].points, own[row].seconds));
        }
        text.push('\n');
    }
    if let Some((target, format)) = drawn {
        let chart = |up: &str, value: fn(&comparison::Swept) -> f64| {
            let curve = |(color, own): (usize, &&[comparison::Swept])| drawing::Curve {
                name: format!("{} HZ", own[0].rate),
                points: own.iter().map(|of| [of.acceleration, value(of)]).collect(),
                is_marked: false,
                color,
            };
            let curves = rates.iter().enumerate().map(curve).collect();
            let across = format!("ACCELERATION, {}", unit.to_uppercase());
            drawing::Chart { up: up.to_owned(), across, curves }
        };
        let charts = [chart("POINTS/S", |of| of.points), chart("TIME, S", |of| of.seconds)];
        let title = format!("{} on {}", files::name(program), machine.title);
        files::save(&[(&target, &format.bytes(drawing::charts(&title, &charts))?)])?;
    }
    Ok(Answer::product(text, json!({ "machine": machine.title, "swept": swept })))
}

/// Runs a program tick by tick.
fn simulated(
    program: &Path,
    name: &str,
    events: Events,
    start: i64,
    output: Option<&Path>,
) -> Result<Answer, Stop> {
    let target = output.map(|file| Target::new(file, &[program, Path::new(name)])).transpose()?;
    let machine = glass::machine(name)?;
    let run = run_of(program, &machine)?;
    if events.from as usize > run.pulses.len() {
        let message =
            format!("the program has {} points, no point {}", run.pulses.len(), events.from);
        return Err(Diagnostic::error(Rule::Points, message).help("take a smaller --from").into());
    }
    let made = simulate(&run, &machine, events);
    let text = made.text(start);
    if let Some(target) = &target {
        files::save(&[(target, text.as_bytes())])?;
    }
    let mut rows = vec![("machine", machine.title.clone())];
    rows.push((
        "time",
        format!("{:.2} s; the whole program is done after {:.2} s", made.seconds, made.predicted),
    ));
    rows.push((
        "pulses",
        format!(
            "{} fired, {} passed unused, {} points counted",
            made.fired, made.unused, made.counted
        ),
    ));
    let missed = made.missed.iter().take(10).map(|point| point.to_string()).collect::<Vec<_>>();
    if !missed.is_empty() {
        let more = if made.missed.len() > missed.len() { ", …" } else { "" };
        rows.push(("missed", format!("{} points: {}{more}", made.missed.len(), missed.join(", "))));
    }
    if let Some(next) = made.next {
        rows.push((
            "stopped",
            format!(
                "{}{:.1} % done; go on by --from {next}",
                if made.states.contains(&State::Fault) { "the door is open; " } else { "" },
                100.0 * made.progress()
            ),
        ));
    }
    rows.extend(output.map(|file| ("saved", file.display().to_string())));
    let data = json!({ "machine": machine.title, "statistics": made });
    Ok(Answer::summary(Verdict::Done, app::summary::rows(&rows), data))
}

/// A file of the library.
fn show(name: &str) -> Result<Answer, Stop> {
    let text = if name == "materials" { material::TABLE } else { glass::library(name)? };
    Ok(Answer::product(text, json!({ "name": name, "text": text })))
}

/// Checks the distances of a list of points.
fn check(path: &Path, spacing: f64, columns: Columns) -> Result<Answer, Stop> {
    let places = match glass::shape(&path.into(), columns)? {
        Shape::Points(places) => places,
        Shape::Mesh(mesh) => mesh.vertices,
        // No form of lists is one of these.
        Shape::Picture(_) | Shape::Curves(_) => Vec::new(),
    };
    let points: Option<Vec<_>> = places.iter().map(|place| cloud::point(*place)).collect();
    let points = points.ok_or_else(|| {
        let found =
            Diagnostic::error(Rule::Coordinate, "a point is beyond 2 m").file(files::name(path));
        Stop::from(found.help("lengths are mm"))
    })?;
    let found = cloud::distances(&points, (spacing * 1e3).ceil() as i64);
    let mut rows = vec![("points", points.len().to_string())];
    rows.push(("nearest", glass::nearest(&found, &points)));
    rows.push((
        "too close",
        format!("{} pairs under {spacing} mm, {} points", found.too_close, found.crowded),
    ));
    let data = json!({ "points": points.len(), "spacing": spacing, "distances": found });
    let verdict = if found.too_close == 0 { Verdict::Done } else { Verdict::Failed };
    Ok(Answer::summary(verdict, app::summary::rows(&rows), data))
}

/// The files that a job is made of, which nothing may be saved over.
fn inputs(job: &Job) -> Vec<&Path> {
    let mut inputs: Vec<&Path> = job.bodies.iter().map(|path| path.as_path()).collect();
    inputs.push(Path::new(&job.machine));
    inputs.extend(job.materials.as_deref());
    inputs
}

/// Makes a program, proves it, and only then saves it with its report.
fn engrave(args: &Engrave, silent: bool) -> Result<Answer, Stop> {
    let begun = Instant::now();
    let inputs = inputs(&args.job);
    let report_path = files::report_of(&args.output);
    let target = Target::new(&args.output, &inputs)?;
    let report_target = Target::new(&report_path, &inputs)?;
    let cloud_target = args.cloud.as_ref().map(|file| Target::new(file, &inputs)).transpose()?;
    let drawing = Drawing::new(&args.job, &inputs)?;
    let progress = Progress::new(5, silent);
    progress.step("reading");
    let machine = glass::machine(&args.job.machine)?;
    let settings = args.settings(begun);
    let read = glass::Job::read(&args.job.sources(), machine, &settings, &mut glass::beside)?;
    let made = read.make(&progress)?;
    if made.account.verdict != Verdict::Done {
        return Ok(not_saved(made.account));
    }
    progress.step("saving");
    let picture = drawing.as_ref().map(|drawing| drawing.drawn(&made, &settings)).transpose()?;
    let report = made.account.report();
    let mut saved: Vec<(&Target, &[u8])> =
        vec![(&report_target, report.as_bytes()), (&target, &made.made.text)];
    let cloud = cloud_target.as_ref().map(|target| (target, mesh::ply(&made.made.cloud)));
    saved.extend(cloud.iter().map(|(target, bytes)| (*target, &bytes[..])));
    saved
        .extend(drawing.iter().zip(&picture).map(|(drawing, bytes)| (&drawing.target, &bytes[..])));
    files::save(&saved)?;
    let mut account = made.account;
    account.rows.push(("saved", args.output.display().to_string()));
    account.rows.push(("", report_path.display().to_string()));
    let more = args.cloud.iter().chain(&args.job.picture);
    account.rows.extend(more.map(|file| ("", file.display().to_string())));
    Ok(account.into())
}

/// Where the picture of a job is saved.
struct Drawing {
    target: Target,
    format: Format,
    title: String,
    view: drawing::GlassView,
}

impl Drawing {
    /// That of `job`, where one is asked for; nothing of `inputs` is saved over.
    fn new(job: &Job, inputs: &[&Path]) -> Result<Option<Drawing>, Stop> {
        let Some(file) = &job.picture else { return Ok(None) };
        let title = job.bodies.iter().map(|path| files::name(path)).collect::<Vec<_>>().join(", ");
        let args::View { camera, distance, zoom, grid } = job.view;
        let view = drawing::GlassView { angles: camera, distance, zoom, grid };
        view.check(job.block)?;
        let (target, format) = (Target::new(file, inputs)?, Format::of(file)?);
        Ok(Some(Drawing { target, format, title, view }))
    }

    fn drawn(&self, made: &glass::Made, settings: &Settings) -> Result<Vec<u8>, Stop> {
        let points = made.places(settings)?;
        let (block, view) = (settings.job.placing.block, self.view);
        let picture = drawing::GlassPicture { block, points: &points, view };
        Ok(self.format.bytes(drawing::glass(&self.title, &picture))?)
    }
}

/// Proves a program, also one edited by hand.
fn prove(program: &Path, job: &Job, silent: bool) -> Result<Answer, Stop> {
    let progress = Progress::new(2, silent);
    let mut inputs = inputs(job);
    inputs.push(program);
    let drawing = Drawing::new(job, &inputs)?;
    progress.step("reading");
    let machine = glass::machine(&job.machine)?;
    let settings = job.settings(Ray::Marginal, Order::Fastest, Effort::default());
    let read = glass::Job::read(&job.sources(), machine, &settings, &mut glass::beside)?;
    let text = read.program(&program.into())?;
    let made = read.prove(&files::name(program), text, &progress)?;
    let picture = drawing.as_ref().map(|drawing| drawing.drawn(&made, &settings)).transpose()?;
    let mut account = made.account;
    if let (Some(drawing), Some(picture)) = (drawing, picture) {
        files::save(&[(&drawing.target, &picture)])?;
        account.rows.extend(job.picture.iter().map(|file| ("picture", file.display().to_string())));
    }
    Ok(account.into())
}
