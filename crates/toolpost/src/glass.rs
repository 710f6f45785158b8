//! `toolpost glass`: engraving inside glass.

use crate::answer::{Answer, not_saved};
use crate::args::glass::{
    self as args, Drawn, Engrave, Filled, Glass, GlassCommand, Job, Ordering, Sorting,
};
use crate::progress::Progress;
use ::glass::curve::{self, Layers};
use ::glass::engraver::State;
use ::glass::fill::{self, Fill, Filling, Sections, Shells};
use ::glass::job::{self, Made, Order, Placing, Settings};
use ::glass::list::Columns;
use ::glass::machine::{LIBRARY, Machine};
use ::glass::mesh::{self, Form, Shape};
use ::glass::optics::Ray;
use ::glass::order::Effort;
use ::glass::picture::{self, Manner};
use ::glass::profile::Limits;
use ::glass::scenario::{Blocks, Scenario};
use ::glass::simulate::{Events, simulate};
use ::glass::source::surrogate::FITTED;
use ::glass::{cloud, comparison, control, material, source};
use app::files::{self, Target};
use app::{Account, Stop, Verdict, Watch};
use drawing::Format;
use program::{Diagnostic, Rule, encoding};
use serde_json::json;
use std::path::{Component, Path};
use std::time::{Duration, Instant};

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
    let machine = machine(name)?;
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
    Ok(control::read(&program_text(program, machine)?, machine).map_err(in_program)?)
}

/// What a program takes on other drives.
fn swept(program: &Path, name: &str, output: Option<&Path>) -> Result<Answer, Stop> {
    let inputs = [program, Path::new(name)];
    let drawn = output.map(|file| Ok::<_, Stop>((Target::new(file, &inputs)?, Format::of(file)?)));
    let drawn = drawn.transpose()?;
    let machine = machine(name)?;
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
    let machine = machine(name)?;
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
    let text = if name == "materials" { material::TABLE } else { library(name)? };
    Ok(Answer::product(text, json!({ "name": name, "text": text })))
}

/// The text of a machine of the library.
fn library(name: &str) -> Result<&'static str, Stop> {
    ::glass::machine::library(name).ok_or_else(|| {
        let names = LIBRARY.map(|(name, _)| name).join(", ");
        let found =
            Diagnostic::error(Rule::MachineUnknown, format!("there is no glass engraver `{name}`"));
        found.help(format!("there are: {names}; or give a file ending in .toml")).into()
    })
}

/// The form of a file, by its ending.
fn form(path: &Path, columns: Columns) -> Result<Form, Stop> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "stl" => Ok(Form::Stl),
        "obj" => Ok(Form::Obj),
        "ply" => Ok(Form::Ply),
        "3mf" => Ok(Form::ThreeMf),
        "xyz" | "txt" | "csv" | "cft" | "asc" | "pts" => Ok(Form::List(columns)),
        _ => {
            let found = Diagnostic::error(
                Rule::Form,
                format!("`.{ending}` is no form of bodies, pictures, curves or points"),
            );
            Err(found.file(files::name(path)).into())
        }
    }
}

fn shape(path: &Path, columns: Columns) -> Result<Shape, Stop> {
    let form = form(path, columns)?;
    Ok(mesh::read(&files::read(path)?, form, &files::name(path))?)
}

/// A body with its colours and textures.
fn painted(path: &Path, columns: Columns) -> Result<Shape, Stop> {
    let form = form(path, columns)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut beside = |name: &str| {
        // What a body names lies in its folder or below.
        let is_below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(name).components().all(is_below) {
            return Err(format!("`{name:.80}` does not lie in the folder of the body"));
        }
        files::read(&folder.join(name)).map_err(|found| format!("{name:.80}: {}", found.message))
    };
    Ok(mesh::read_painted(&files::read(path)?, form, &files::name(path), Some(&mut beside))?)
}

/// What a file of a job holds.
fn shape_of_job(path: &Path, job: &Job) -> Result<Shape, Stop> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let curves = |form| -> Result<Shape, Stop> {
        Ok(Shape::Curves(curve::read(&files::read(path)?, form, &files::name(path))?))
    };
    match ending.as_str() {
        "png" | "jpg" | "jpeg" | "bmp" | "pcx" => {}
        "dxf" => return curves(curve::Form::Dxf),
        "plt" | "hpgl" | "hpg" => return curves(curve::Form::Hpgl),
        _ if job.filling.fill == Filled::Shaded => return painted(path, job.columns),
        _ => return shape(path, job.columns),
    }
    let args = &job.image;
    let setting = picture::Setting {
        plane: args.plane,
        width: args.width,
        manner: match args.manner {
            Drawn::Dither => Manner::Dither,
            Drawn::Raster => Manner::Raster(args.threshold),
            // Without a depth the command line is not taken.
            Drawn::Relief => Manner::Relief(args.depth.unwrap_or_default()),
        },
        invert: args.invert,
        sheets: (args.sheets, args.sheet_distance),
    };
    Ok(Shape::Picture(picture::read(&files::read(path)?, setting, &files::name(path))?))
}

/// The text of a file that must be UTF-8.
fn text(path: &Path) -> Result<String, Stop> {
    let bytes = files::read(path)?;
    Ok(encoding::utf_8(&bytes).map_err(|found| found.file(files::name(path)))?.to_owned())
}

/// Checks the distances of a list of points.
fn check(path: &Path, spacing: f64, columns: Columns) -> Result<Answer, Stop> {
    let places = match shape(path, columns)? {
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
    rows.push(("nearest", nearest(&found, &points)));
    rows.push((
        "too close",
        format!("{} pairs under {spacing} mm, {} points", found.too_close, found.crowded),
    ));
    let data = json!({ "points": points.len(), "spacing": spacing, "distances": found });
    let verdict = if found.too_close == 0 { Verdict::Done } else { Verdict::Failed };
    Ok(Answer::summary(verdict, app::summary::rows(&rows), data))
}

/// The nearest two points of a cloud.
fn nearest(found: &cloud::Distances, points: &[cloud::Point]) -> String {
    match found.nearest {
        Some(cloud::Pair { points: [a, b], distance }) => {
            let show = |i: u32| {
                let place = cloud::place(points[i as usize]);
                format!("{:.3} {:.3} {:.3}", place.x, place.y, place.z)
            };
            format!("{distance:.4} mm: {} and {}", show(a), show(b))
        }
        None => String::from("no two points within twice the spacing"),
    }
}

/// What a job takes besides its bodies; the order is left as it is where there is none to make.
fn settings(args: &Job, ray: Ray, order: Order, effort: Effort) -> Settings {
    let placing = Placing {
        block: args.block,
        margin: args.placing.margin,
        scale: args.placing.scale,
        fit: args.placing.fit,
        turn: args.placing.turn,
        mirror: [0, 1, 2].map(|axis| args.placing.mirror.contains(&axis)),
        shift: args.placing.r#move,
    };
    let alone = |own: &args::Alone| {
        let args::Alone { body, scale, fit, turn, mirror, r#move } = *own;
        (body, Placing { scale, fit, turn, mirror, shift: r#move, ..placing })
    };
    Settings {
        alone: args.placing.place.iter().map(alone).collect(),
        placing,
        blocks: args.blocks,
        focal: args.lens,
        spacing: args.spacing,
        filling: filling(&args.filling, args.image.invert),
        shells: Shells { count: args.filling.shells, distance: args.filling.shell_distance },
        layers: Layers {
            count: args.filling.layers,
            distance: args.filling.layer_distance,
            twist: args.filling.twist.unwrap_or_default(),
            ends: !args.filling.no_ends,
        },
        ray,
        order,
        effort,
        seed: args.seed,
        accept_shadowed: !args.accept.is_empty(),
    }
}

/// How bodies become points.
fn filling(args: &args::Filling, invert: bool) -> Filling {
    let fill = match args.fill {
        Filled::Surface => Fill::Surface,
        Filled::Shaded => Fill::Shaded(invert),
        Filled::Solid => Fill::Solid,
        Filled::Triangles => Fill::Triangles(args.full),
        Filled::Rays => Fill::Rays,
        Filled::Sections => Fill::Sections(Sections {
            layer: args.layer_distance,
            first: args.first_distance,
            twist: args.twist.unwrap_or_default(),
            ends: !args.no_ends,
        }),
    };
    Filling { fill, step: args.step, direction: fill::direction(args.axis, args.tilt) }
}

/// The order that is asked for, and how much is tried for it.
fn ordering(args: &Ordering, begun: Instant) -> (Order, Effort) {
    let order = match args.order {
        Sorting::Fastest => Order::Fastest,
        Sorting::Kdz => Order::Kdz(args.slopes[0], args.slopes[1]),
        Sorting::Layers => Order::Layers(args.layer),
        Sorting::Arcs => Order::Scenario(Scenario::Arcs),
        Sorting::Tracks => Order::Scenario(Scenario::Tracks),
    };
    let until = args.seconds.and_then(|s| begun.checked_add(Duration::try_from_secs_f64(s).ok()?));
    (order, Effort { rounds: args.rounds, until, ..Effort::default() })
}

/// A machine of the library, or of a file.
fn machine(name: &str) -> Result<Machine, Stop> {
    Ok(match Path::new(name) {
        path if path.extension().is_some_and(|ending| ending == "toml") => {
            Machine::read(&text(path)?, &files::name(path))?
        }
        _ => Machine::read(library(name)?, name)?,
    })
}

/// The bytes of a program: only a binary one need not be text.
fn program_text(program: &Path, machine: &Machine) -> Result<Vec<u8>, Stop> {
    match machine.program.format {
        ::glass::machine::Format::Binary => Ok(files::read(program)?),
        _ => Ok(files::text(program)?),
    }
}

/// The files of a job, read.
struct Read {
    machine: Machine,
    material: material::Material,
    shapes: Vec<Shape>,
}

impl Read {
    fn new(job: &Job) -> Result<Read, Stop> {
        let machine = machine(&job.machine)?;
        let (table, file) = match &job.materials {
            Some(path) => (text(path)?, files::name(path)),
            None => (material::TABLE.to_owned(), String::from("materials.toml")),
        };
        let material = material::find(&table, &file, &job.material, machine.laser.wavelength)?;
        let shapes = job.bodies.iter().map(|path| shape_of_job(path, job));
        let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
        Ok(Read { machine, material, shapes })
    }
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
    let progress = Progress::new(3, silent);
    progress.step("reading");
    let Read { machine, material, shapes } = Read::new(&args.job)?;
    progress.step("engraving");
    let (order, effort) = ordering(&args.ordering, begun);
    let settings = settings(&args.job, args.ray, order, effort);
    let made = job::make(shapes, &material, &machine, &settings)?;
    let mut account = account(&made, &machine, &material);
    if account.verdict != Verdict::Done {
        return Ok(not_saved(account));
    }
    progress.step("saving");
    let picture = drawing
        .as_ref()
        .map(|drawing| drawing.drawn(&made, &material, &machine, &settings))
        .transpose()?;
    let report = account.report();
    let mut saved: Vec<(&Target, &[u8])> =
        vec![(&report_target, report.as_bytes()), (&target, &made.text)];
    let cloud = cloud_target.as_ref().map(|target| (target, mesh::ply(&made.cloud)));
    saved.extend(cloud.iter().map(|(target, bytes)| (*target, &bytes[..])));
    saved
        .extend(drawing.iter().zip(&picture).map(|(drawing, bytes)| (&drawing.target, &bytes[..])));
    files::save(&saved)?;
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

    fn drawn(
        &self,
        made: &Made,
        material: &material::Material,
        machine: &Machine,
        settings: &Settings,
    ) -> Result<Vec<u8>, Stop> {
        let points = job::places(made, material, machine, settings)?;
        let (block, view) = (settings.placing.block, self.view);
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
    let Read { machine, material, shapes } = Read::new(job)?;
    let text = program_text(program, &machine)?;
    progress.step("proving");
    let settings = settings(job, Ray::Marginal, Order::Fastest, Effort::default());
    let in_program = |found: Vec<Diagnostic>| -> Vec<Diagnostic> {
        found.into_iter().map(|found| in_file(found, &files::name(program))).collect()
    };
    let made = job::prove(text, shapes, &material, &machine, &settings).map_err(in_program)?;
    let mut account = account(&made, &machine, &material);
    account.findings = in_program(account.findings);
    if let Some(drawing) = drawing {
        let picture = drawing.drawn(&made, &material, &machine, &settings)?;
        files::save(&[(&drawing.target, &picture)])?;
        account.rows.extend(job.picture.iter().map(|file| ("picture", file.display().to_string())));
    }
    Ok(account.into())
}

/// A finding with a line is one of the program.
fn in_file(found: Diagnostic, program: &str) -> Diagnostic {
    match found.line > 0 && found.file.is_empty() {
        true => found.file(program),
        false => found,
    }
}

/// What is reported of a job.
fn account(made: &Made, machine: &Machine, material: &material::Material) -> Account {
    let Made { report, cloud, findings, .. } = made;
    let proof = &report.proof;
    let three = |at: [f64; 3]| format!("{:.3} {:.3} {:.3}", at[0], at[1], at[2]);
    let mut rows = vec![("machine", machine.title.clone())];
    rows.push((
        "material",
        format!("{}, index {} at {} nm", material.title, material.index, material.wavelength),
    ));
    rows.push((
        "points",
        format!("{} from {} to {} mm", report.points, three(report.from), three(report.to)),
    ));
    for body in &report.alone {
        let (from, to) = (three(body.from), three(body.to));
        rows.push((
            "placed",
            format!("body {} by itself, scale {}, from {from} to {to} mm", body.body, body.scale),
        ));
    }
    if report.welded > 0 {
        rows.push((
            "left out",
            format!("{} points nearer than {} mm to another one", report.welded, report.spacing),
        ));
    }
    rows.push(("nearest", nearest(&report.distances, cloud)));
    if let Some(energy) = report.energy {
        rows.push(("energy", format!("{energy:.3} mJ of a pulse in the glass of each block")));
    }
    if report.blocks > 1 {
        rows.push(("blocks", format!("{}, each with all points", report.blocks)));
    }
    if let Some((moved, merged)) = report.moved {
        rows.push((
            "moved",
            format!("by {moved:.3} mm at most, to where a motion passes on a tick; {merged} points fell together or out of the margin"),
        ));
    }
    if report.in_motion > 0 {
        rows.push(("in motion", format!("{} of {} pulses", report.in_motion, proof.pulses)));
    }
    if let Some(part) = report.unreachable {
        rows.push(("reach", format!("the arm misses {:.1} % of the block", 100.0 * part)));
    }
    if made.report.planned_ticks.is_some() {
        let ray = match report.ray {
            Ray::Marginal => "marginal",
            Ray::Paraxial => "paraxial",
        };
        rows.push((
            "refraction",
            format!(
                "focus by the {ray} ray; by the other one the deepest point is {:.3} mm off",
                report.rays_apart
            ),
        ));
    }
    rows.push((
        "time",
        format!(
            "{:.2} s, {} ticks at {} Hz; {:.2} % of the pulses are used",
            proof.seconds,
            proof.ticks,
            machine.laser.rate,
            100.0 * proof.used
        ),
    ));
    if let Some(least) = report.least_ticks {
        rows.push((
            "bound",
            format!(
                "no order takes fewer than {least} ticks (by assignment, with the shadow rule)"
            ),
        ));
    }
    rows.push(("travel", format!("{:.1} mm from pulse to pulse", proof.travel)));
    rows.push(("proof", match made.proven {
        true => format!(
            "passed: {} pulses, each within {:.4} mm across and {:.4} mm along the beam of its point{}; {} points shadowed",
            proof.pulses,
            proof.across,
            proof.along,
            proof.nearest.map_or(String::new(), |pair| format!(", no two nearer than {:.4} mm", pair.distance)),
            proof.shadowed
        ),
        false => String::from("FAILED"),
    }));
    if !report.accepted.is_empty() {
        let rules: Vec<&str> = report.accepted.iter().map(|rule| rule.name()).collect();
        rows.push(("accepted", format!("{}, which the proof would refuse", rules.join(", "))));
    }
    Account {
        verdict: if made.proven { Verdict::Done } else { Verdict::Failed },
        rows,
        data: json!({ "machine": machine.title, "material": material.title, "glass": report }),
        findings: findings.clone(),
    }
}
