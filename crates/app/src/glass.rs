//! Engraving inside glass: bodies, pictures, curves and lists of points in, the proven program of a pulsed laser out. All of it is done by
//! the crate `glass`.

use crate::account::{Account, Stop, Verdict};
use crate::files;
use crate::input::Source;
use crate::watch::Watch;
use ::glass::cloud::{self, Pair};
use ::glass::curve;
use ::glass::fill::Fill;
use ::glass::list::{self, Columns};
use ::glass::machine::LIBRARY;
use ::glass::material::{self, Material};
use ::glass::mesh::{self, Form, Shape};
use ::glass::optics::Ray;
use ::glass::picture;
use glam::DVec3;
use program::{Diagnostic, Digest, Rule, encoding};
use serde_json::json;
use std::borrow::Cow;
use std::path::{Component, Path};

pub use ::glass::chain::Moves;
pub use ::glass::cloud::{Point, point};
pub use ::glass::control::Run;
pub use ::glass::job;
pub use ::glass::machine::{Format, Machine, Table};
pub use ::glass::proof::{Focus, Steps};

/// What is engraved, and how.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What the block is made of: a name of the table of materials.
    pub material: String,
    /// That table, where it is not the one of Toolpost.
    pub materials: Option<Source>,
    /// In which columns of a list the coordinates stand.
    pub columns: Columns,
    /// What becomes of pictures.
    pub picture: picture::Setting,
    /// All that does not depend on files.
    pub job: job::Settings,
}

/// Reads a file that a body names, such as its texture: the body, and the name.
///
/// # Errors
/// Why it cannot be read.
pub type Beside<'b> = &'b mut dyn FnMut(&Source, &str) -> Result<Vec<u8>, String>;

/// Files of the computer that lie in the folder of a body or below.
///
/// # Errors
/// It lies elsewhere, or cannot be read.
pub fn beside(body: &Source, name: &str) -> Result<Vec<u8>, String> {
    let folder = body.path().parent().unwrap_or(Path::new(""));
    files::read(&folder.join(name)).map_err(|found| format!("{name:.80}: {}", found.message))
}

/// Which of the bodies of a job a pulse comes from.
#[derive(Debug)]
pub struct Origins {
    places: ::glass::origin::Origins,
    /// The lines of the points of each body that is a list.
    lines: Vec<Vec<u32>>,
}

impl Origins {
    /// The body of a point of the block, from 0, and its line there, where the body is a list of points; `None` where it may be of several.
    pub fn of(&self, at: Point) -> Option<(usize, Option<u32>)> {
        let found = self.places.of(at)?;
        let line = |point: usize| self.lines.get(found.body)?.get(point).copied();
        Some((found.body, found.point.and_then(line)))
    }
}

/// A job whose files have been read.
#[derive(Debug)]
pub struct Job<'s> {
    machine: Machine,
    material: Material,
    shapes: Vec<Shape>,
    settings: &'s Settings,
    most: u64,
    /// SHA-256 of the bodies, in their order.
    digest: String,
}

/// A program with its verdict.
#[derive(Debug)]
pub struct Made {
    /// What was made, and what the virtual machine has read of it.
    pub made: job::Made,
    /// What is reported of it.
    pub account: Account,
    /// Its machine.
    pub machine: Machine,
    material: Material,
}

/// The machine that a text describes, which is the file `file`.
///
/// # Errors
/// It is none.
pub fn machine_of(text: &[u8], file: &str) -> Result<Machine, Stop> {
    Ok(Machine::read(utf_8(text, file)?, file)?)
}

/// A machine of the library, or of a file that ends in `.toml`.
///
/// # Errors
/// There is none of this name, or its file has a mistake.
pub fn machine(name: &str) -> Result<Machine, Stop> {
    let path = Path::new(name);
    match path.extension() {
        Some(ending) if ending == "toml" => machine_of(&files::read(path)?, &files::name(path)),
        _ => machine_of(library(name)?.as_bytes(), name),
    }
}

/// The text of a machine of the library.
///
/// # Errors
/// There is none of this name.
pub fn library(name: &str) -> Result<&'static str, Stop> {
    ::glass::machine::library(name).ok_or_else(|| {
        let names = LIBRARY.map(|(name, _)| name).join(", ");
        let found =
            Diagnostic::error(Rule::MachineUnknown, format!("there is no glass engraver `{name}`"));
        found.help(format!("there are: {names}; or give a file ending in .toml")).into()
    })
}

/// The names of the machines of the library.
pub fn names() -> impl Iterator<Item = &'static str> {
    LIBRARY.into_iter().map(|(name, _)| name)
}

/// Whether a text is meant as a machine that fires inside glass: no other file has a table `[laser]`.
pub fn is_machine(text: &[u8]) -> bool {
    text.split(|byte| *byte == b'\n').any(|line| line.trim_ascii().starts_with(b"[laser]"))
}

/// Whether a file is a body, a picture or a list of points, by its ending, and nothing that another machine cuts.
pub fn is_body(source: &Source) -> bool {
    let bodies = [
        "stl", "obj", "ply", "3mf", "png", "jpg", "jpeg", "bmp", "pcx", "xyz", "cft", "asc", "plt",
        "hpgl", "hpg",
    ];
    bodies.contains(&&*files::ending(source.path()))
}

/// How the names of the programs of a machine end.
pub fn extension(machine: &Machine) -> &'static str {
    match machine.program.format {
        Format::Numbered => "prg",
        Format::Points => "txt",
        Format::Gcode => "ngc",
        Format::Binary => "bin",
    }
}

/// A text that must be UTF-8.
fn utf_8<'t>(text: &'t [u8], file: &str) -> Result<&'t str, Stop> {
    Ok(encoding::utf_8(text).map_err(|found| found.file(file))?)
}

/// The form of a file, by its ending.
fn form(path: &Path, columns: Columns) -> Result<Form, Stop> {
    let ending = files::ending(path);
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

/// Whether a file has the form of a body, a picture, curves or points.
///
/// # Errors
/// It has none of them.
pub fn check(source: &Source) -> Result<(), Stop> {
    match files::ending(source.path()).as_str() {
        "png" | "jpg" | "jpeg" | "bmp" | "pcx" | "dxf" | "plt" | "hpgl" | "hpg" => Ok(()),
        _ => form(source.path(), Columns::default()).map(|_| ()),
    }
}

/// Whether a file has the form of a list of points.
pub fn is_list(source: &Source) -> bool {
    matches!(form(source.path(), Columns::default()), Ok(Form::List(_)))
}

/// The body or the points of a file.
///
/// # Errors
/// It is neither, or cannot be read.
pub fn shape(source: &Source, columns: Columns) -> Result<Shape, Stop> {
    let form = form(source.path(), columns)?;
    Ok(mesh::read(&source.read()?, form, &source.name())?)
}

/// A body with its colours and textures.
fn painted(
    (source, bytes): (&Source, &[u8]),
    columns: Columns,
    beside: Beside,
) -> Result<Shape, Stop> {
    let form = form(source.path(), columns)?;
    let mut beside = |name: &str| {
        // What a body names lies in its folder or below.
        let is_below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(name).components().all(is_below) {
            return Err(format!("`{name:.80}` does not lie in the folder of the body"));
        }
        beside(source, name)
    };
    Ok(mesh::read_painted(bytes, form, &source.name(), Some(&mut beside))?)
}

/// What a file of a job holds, and its bytes.
fn shape_of_job<'b>(
    source: &'b Source,
    settings: &Settings,
    beside: Beside,
) -> Result<(Shape, Cow<'b, [u8]>), Stop> {
    check(source)?;
    let (bytes, name) = (source.read()?, source.name());
    let curves = |form| curve::read(&bytes, form, &name).map(Shape::Curves);
    let shape = match files::ending(source.path()).as_str() {
        "png" | "jpg" | "jpeg" | "bmp" | "pcx" => {
            Shape::Picture(picture::read(&bytes, settings.picture, &name)?)
        }
        "dxf" => curves(curve::Form::Dxf)?,
        "plt" | "hpgl" | "hpg" => curves(curve::Form::Hpgl)?,
        _ => match settings.job.filling.fill {
            Fill::Shaded(_) => painted((source, &bytes), settings.columns, beside)?,
            _ => mesh::read(&bytes, form(source.path(), settings.columns)?, &name)?,
        },
    };
    Ok((shape, bytes))
}

/// The bytes of a program of a machine: only a binary one need not be text.
///
/// # Errors
/// It cannot be read, or is in UTF-16.
pub fn program(program: &Source, machine: &Machine) -> Result<Vec<u8>, Stop> {
    match machine.program.format {
        Format::Binary => Ok(program.read()?.into_owned()),
        Format::Numbered | Format::Points | Format::Gcode => Ok(program.text()?.into_owned()),
    }
}

impl<'s> Job<'s> {
    /// Reads the table of materials and the bodies of a job.
    ///
    /// # Errors
    /// One of the files cannot be read, is no such file, or there is no such material.
    pub fn read(
        bodies: &[Source],
        machine: Machine,
        settings: &'s Settings,
        beside: Beside,
    ) -> Result<Job<'s>, Stop> {
        let (table, file) = match &settings.materials {
            Some(source) => (source.read()?, source.name()),
            None => (material::TABLE.as_bytes().into(), String::from("materials.toml")),
        };
        let (table, wavelength) = (utf_8(&table, &file)?, machine.laser.wavelength);
        let material = material::find(table, &file, &settings.material, wavelength)?;
        let read = bodies.iter().map(|body| shape_of_job(body, settings, beside));
        let (shapes, read): (Vec<_>, Vec<_>) = read.collect::<Result<_, _>>()?;
        let digest = Digest::of(read.iter().map(|bytes| &bytes[..]));
        Ok(Job { machine, material, shapes, settings, most: u64::MAX, digest })
    }

    /// The same for who has memory for so many pulses: more are refused before they are made.
    pub fn within(self, most: u64) -> Job<'s> {
        Job { most, ..self }
    }

    /// Which of its `bodies` its points come from.
    ///
    /// # Errors
    /// What cannot be engraved.
    pub fn origins(&self, bodies: &[Source]) -> Result<Origins, Stop> {
        let Job { machine, material, shapes, settings, .. } = self;
        let lines = |body: &Source| {
            let bytes = is_list(body).then(|| body.read()).transpose()?;
            Ok(bytes.map_or(Vec::new(), |bytes| list::lines_of_points(&bytes, settings.columns)))
        };
        let lines = bodies.iter().map(lines).collect::<Result<_, Stop>>()?;
        let places = job::origins(shapes.clone(), material, machine, &settings.job)?;
        Ok(Origins { places, lines })
    }

    /// The text of a program of its machine.
    ///
    /// # Errors
    /// As [`program()`].
    pub fn program(&self, source: &Source) -> Result<Vec<u8>, Stop> {
        program(source, &self.machine)
    }

    /// Writes the program, and proves it.
    ///
    /// # Errors
    /// What cannot be engraved, or that the work was ended.
    pub fn make(self, watch: &dyn Watch) -> Result<Made, Stop> {
        watch.begin("engraving")?;
        let Job { machine, material, shapes, settings, most, digest } = self;
        let watch = Engraves { watch, most };
        let made = job::make_for(shapes, &material, &machine, &settings.job, &watch);
        let made = made.map_err(|found| watch.stop(found))?;
        Ok(Made::new(made, machine, material, digest))
    }

    /// Proves the program of this name and text, also one edited by hand.
    ///
    /// # Errors
    /// What cannot be engraved, what the machine would not take, or that the work was ended.
    pub fn prove(self, name: &str, text: Vec<u8>, watch: &dyn Watch) -> Result<Made, Stop> {
        let Job { machine, material, shapes, settings, most, digest } = self;
        let in_program = |found: Vec<Diagnostic>| -> Vec<Diagnostic> {
            found.into_iter().map(|found| in_file(found, name)).collect()
        };
        let watch = Engraves { watch, most };
        let made = job::prove_for(text, shapes, &material, &machine, &settings.job, &watch);
        let made = made.map_err(|found| watch.stop(in_program(found)))?;
        let mut made = Made::new(made, machine, material, digest);
        made.account.findings = in_program(made.account.findings);
        Ok(made)
    }
}

/// Whoever watches, as the crate `glass` tells it.
struct Engraves<'a> {
    watch: &'a dyn Watch,
    most: u64,
}

impl ::glass::watch::Watch for Engraves<'_> {
    fn step(&self, what: &'static str) {
        self.watch.step(what);
    }

    fn most_pulses(&self) -> u64 {
        self.most
    }

    fn is_ended(&self) -> bool {
        self.watch.is_cancelled()
    }
}

impl Engraves<'_> {
    /// Why work has stopped.
    fn stop(&self, found: Vec<Diagnostic>) -> Stop {
        if self.watch.is_cancelled() { Stop::cancelled() } else { found.into() }
    }
}

impl Made {
    fn new(made: job::Made, machine: Machine, material: Material, source: String) -> Made {
        let mut account = account(&made, &machine, &material);
        account.data["sha256"] =
            json!({ "program": Digest::of([&made.text[..]]), "source": source });
        Made { made, account, machine, material }
    }

    /// Where the beam comes to its focus.
    ///
    /// # Errors
    /// The machine has no such lens.
    pub fn focus(&self, settings: &Settings) -> Result<Focus, Stop> {
        Ok(job::focus(&self.made, &self.material, &self.machine, &settings.job)?)
    }

    /// Where the pulses lie in the glass, in their order, mm.
    ///
    /// # Errors
    /// The machine has no such lens.
    pub fn places(&self, settings: &Settings) -> Result<Vec<DVec3>, Stop> {
        Ok(job::places(&self.made, &self.material, &self.machine, &settings.job)?)
    }
}

/// The nearest two points of a cloud.
pub fn nearest(found: &cloud::Distances, points: &[Point]) -> String {
    match found.nearest {
        Some(Pair { points: [a, b], distance }) => {
            let show = |i: u32| {
                let place = cloud::place(points[i as usize]);
                format!("{:.3} {:.3} {:.3}", place.x, place.y, place.z)
            };
            format!("{distance:.4} mm: {} and {}", show(a), show(b))
        }
        None => String::from("no two points within twice the spacing"),
    }
}

/// A finding with a line is one of the program.
fn in_file(found: Diagnostic, program: &str) -> Diagnostic {
    match found.line > 0 && found.file.is_empty() {
        true => found.file(program),
        false => found,
    }
}

/// What is reported of a job.
fn account(made: &job::Made, machine: &Machine, material: &Material) -> Account {
    let job::Made { report, cloud, findings, .. } = made;
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
