//! Wire EDM: a contour in, the proven program of a machine out. The path of the wire is planned by the crate `wire`.

mod proof;
mod report;
mod source;

use crate::account::{Account, Stop, Verdict};
use crate::input;
use crate::post::{self, Posted};
use crate::prove;
use crate::report::{Digests, SCHEMA};
use crate::toolpath::{self, Origin, Toolpath};
use crate::watch::Watch;
use ::proof::Tolerances;
use ::wire::Contour;
use ::wire::cutting::{self, Cutting};
use ::wire::points::{Refusal, Step, points};
use ::wire::segment::Segment;
use machine::{Machine, Wire};
use program::{Diagnostic, LEAST_SETTING, MOST_SETTING, Rule, needs, not_both, within};
use report::{Cut, Report};
use serde_json::json;
use source::Source;
pub use source::is_drawing;

/// The most segments that an [`Account`] lists; the report lists all.
const MOST_LISTED: usize = 1000;

/// What is cut, and how.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Layers of a drawing that are read; none: all.
    pub layers: Vec<String>,
    /// How far ends in a drawing that belong together may be apart, mm.
    pub close: f64,
    /// The upper contour; the source is then the lower one.
    pub upper: Option<input::Source>,
    /// Which point above belongs to which below.
    pub sync: Sync,
    /// Points below (X, Y) and those above that belong to them (X, Y), instead of `sync`, mm; in the order of travel,
    /// between which both ends cover the same part of their length.
    pub pairs: Vec<[f64; 4]>,
    /// Height of the part, mm: of the upper contour over the lower; else, of a source with U and V, that of its plane.
    pub height: Option<f64>,
    /// Height of the plane in which the machine counts U and V, mm, where its file does not say it.
    pub uv_height: Option<f64>,
    /// How the wire goes along the contours.
    pub cutting: Cutting,
    /// Into which points the paths are divided; `None`: into none where the control cuts arcs, else by its lowering
    /// tolerance.
    pub step: Option<Step>,
    /// How many points the control holds; else what its machine file says.
    pub memory: Option<usize>,
    /// The line of the source whose points are marked in the summary and the picture.
    pub select: Option<u32>,
}

impl Settings {
    /// Checks that every number is one that makes sense by itself, and that settings go together.
    ///
    /// # Errors
    /// `setting`, with the name of the first that does not.
    fn check(&self) -> Result<(), Box<Diagnostic>> {
        self.cutting.check()?;
        within("close", self.close, LEAST_SETTING, MOST_SETTING)?;
        within("height", self.height.unwrap_or(LEAST_SETTING), LEAST_SETTING, MOST_SETTING)?;
        within("uv_height", self.uv_height.unwrap_or(LEAST_SETTING), LEAST_SETTING, MOST_SETTING)?;
        let (alone, by_length) = (self.upper.is_none(), self.sync != Sync::Block);
        needs("sync", "upper", alone && by_length)?;
        needs("pair", "upper", alone && !self.pairs.is_empty())?;
        not_both("pair", "sync", by_length && !self.pairs.is_empty())
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            layers: Vec::new(),
            close: 0.01,
            upper: None,
            sync: Sync::Block,
            pairs: Vec::new(),
            height: None,
            uv_height: None,
            cutting: Cutting::default(),
            step: None,
            memory: None,
            select: None,
        }
    }
}

/// Into how many points arcs are divided: one every so many mm of arc, as many as keep a chord error in mm, or as many as
/// the memory of the control holds.
///
/// # Errors
/// More than one is asked for.
pub fn step(
    length: Option<f64>,
    chord_error: Option<f64>,
    fit: bool,
) -> Result<Option<Step>, Box<Diagnostic>> {
    not_both("step", "chord_error", length.is_some() && chord_error.is_some())?;
    not_both("step", "fit", length.is_some() && fit)?;
    not_both("chord_error", "fit", chord_error.is_some() && fit)?;
    let length = length.map(Step::Length);
    Ok(length.or(chord_error.map(Step::ChordError)).or(fit.then_some(Step::Fit)))
}

/// Which point above belongs to which below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sync {
    /// Both programs have the same moves, block for block.
    Block,
    /// Both ends have covered the same part of their length.
    Length,
}

/// The program of a wire.
pub struct Made {
    /// The program, and what is reported of it.
    pub posted: Posted,
    /// What it was read from.
    pub toolpath: Toolpath,
    /// What the wire cuts.
    pub listing: Listing,
}

impl Made {
    /// The contour, its points and the ruled surface as an SVG drawing.
    pub fn picture(&self) -> String {
        let Listing { cut, select } = &self.listing;
        drawing::wire_path(&self.toolpath.file, &cut.picture(*select))
    }

    /// The report to save next to the program, as JSON.
    pub fn report(&self) -> String {
        self.listing.report(&self.posted.account)
    }
}

/// The segments and points of a program, of which its account has the first alone.
#[derive(Debug)]
pub struct Listing {
    cut: Cut,
    select: Option<u32>,
}

impl Listing {
    /// The report to save next to the program that `account` is of, as JSON.
    pub fn report(&self, account: &Account) -> String {
        Report { account, cut: &self.cut, selected: self.select }.text()
    }
}

/// Writes the program, which is called `file`, that cuts the contours of `source` on `machine`, and proves it.
///
/// # Errors
/// Why there is no program.
#[expect(
    clippy::too_many_arguments,
    reason = "what is cut, by what, how, how closely, and for whom"
)]
pub fn make(
    source: &input::Source,
    strict: bool,
    origin: &Origin,
    mut machine: Machine,
    settings: &Settings,
    file: &str,
    tolerances: &Tolerances,
    watch: &dyn Watch,
) -> Result<Made, Stop> {
    let (toolpath, cut, mut warnings) =
        planned(source, strict, origin, &mut machine, settings, watch)?;
    let program = cut.program(&toolpath.program.name).map_err(Box::<Diagnostic>::from)?;
    let output = post::write((&program, file), &machine, &toolpath, &mut warnings, watch)?;
    watch.begin("proving")?;
    allow(&cut, &mut machine);
    let name = &toolpath.program.name;
    let proof = proof::of(&cut, &machine, name, file, &output.text, tolerances, watch)
        .map_err(Box::<Diagnostic>::from)?;
    let proven = cut.source(name).map_err(Box::<Diagnostic>::from)?;
    // An arc of the contour is made by several points of the path.
    let places = ::post::places(&proven, &program);
    let origins = output.origins.moved(|record| places.get(record).copied());
    watch.go_on()?;
    let select = settings.select;
    if !proof.proven {
        let mut account = prove::failed(&proof, &toolpath, file);
        account.findings.extend(warnings);
        let posted = Posted { text: output.text, origins, parts: Vec::new(), account };
        return Ok(Made { posted, toolpath, listing: Listing { cut, select } });
    }

    warnings.extend(proof.warnings.iter().cloned());
    let data = json!({
        "schema": SCHEMA,
        "toolpost": env!("CARGO_PKG_VERSION"),
        "sha256": Digests::of(&output.text, &[], &toolpath, &machine),
        "source": { "file": toolpath.file, "dialect": toolpath.dialect },
        "machine": toolpath::describe(&machine),
        "program": { "file": file, "blocks": output.blocks, "bytes": output.text.len() },
        "wire": cut.summary(select, MOST_LISTED),
        "proof": proof,
    });
    let mut rows = toolpath.rows(Some(&machine));
    rows.extend(cut.rows(select));
    rows.extend(prove::rows(&proof, &machine));
    let account = Account { verdict: Verdict::Done, rows, data, findings: warnings };
    let posted = Posted { text: output.text, origins, parts: Vec::new(), account };
    Ok(Made { posted, toolpath, listing: Listing { cut, select } })
}

/// Proves a program that is called `file` and that somebody has edited, against the contours of `source` on `machine`, as [`make`]
/// would cut them.
///
/// # Errors
/// Why there is nothing to compare it with, or that the work was ended.
#[expect(
    clippy::too_many_arguments,
    reason = "what is cut, by what, how, how closely, and for whom"
)]
pub fn prove(
    source: &input::Source,
    strict: bool,
    origin: &Origin,
    mut machine: Machine,
    settings: &Settings,
    (file, text): (&str, &[u8]),
    tolerances: &Tolerances,
    watch: &dyn Watch,
) -> Result<(Toolpath, Account), Stop> {
    let (toolpath, cut, warnings) = planned(source, strict, origin, &mut machine, settings, watch)?;
    watch.begin("proving")?;
    allow(&cut, &mut machine);
    let name = &toolpath.program.name;
    let proof = proof::of(&cut, &machine, name, file, text, tolerances, watch)
        .map_err(Box::<Diagnostic>::from)?;
    watch.go_on()?;
    if !proof.proven {
        let mut account = prove::failed(&proof, &toolpath, file);
        account.findings.extend(warnings);
        return Ok((toolpath, account));
    }
    let data = json!({
        "source": { "file": toolpath.file, "dialect": toolpath.dialect },
        "machine": toolpath::describe(&machine),
        "program": { "file": file, "blocks": proof.program.blocks, "bytes": text.len() },
        "wire": cut.summary(settings.select, MOST_LISTED),
        "proof": proof,
    });
    let mut rows = toolpath.rows(Some(&machine));
    rows.extend(cut.rows(settings.select));
    rows.extend(prove::rows(&proof, &machine));
    let findings = warnings.into_iter().chain(proof.warnings).collect();
    Ok((toolpath, Account { verdict: Verdict::Done, rows, data, findings }))
}

/// The contours of `source` as the wire cuts them on `machine`, which is set up for it; and what is odd about them.
fn planned(
    source: &input::Source,
    strict: bool,
    origin: &Origin,
    machine: &mut Machine,
    settings: &Settings,
    watch: &dyn Watch,
) -> Result<(Toolpath, Cut, Vec<Diagnostic>), Stop> {
    settings.check()?;
    set_up(machine, settings)?;
    watch.begin("reading")?;
    let Source { mut toolpath, paths, offset, height } =
        Source::read(source, strict, origin, (settings, machine), watch)?;
    let mut warnings = std::mem::take(&mut toolpath.warnings);
    watch.begin("writing")?;
    let planned = cutting::segments(paths, &offset, &settings.cutting, height);
    let (mut segments, rounded) = planned.map_err(|found| toolpath.refused(*found))?;
    warnings.extend(rounded);
    divide(&mut segments, settings.step, machine)?;
    let cut = Cut::of(segments, height, machine);
    Ok((toolpath, cut, warnings))
}

/// Chords may leave their arcs by what the conversion has made of them, and by no more.
fn allow(cut: &Cut, machine: &mut Machine) {
    if cut.points().is_some() {
        machine.capabilities.lowering_tolerance = cut.chord_error();
    }
}

/// The machine with what the call says of it.
fn set_up(machine: &mut Machine, settings: &Settings) -> Result<(), Stop> {
    let Some(wire) = machine.wire else {
        let message = format!("`{}` is a mill: its file has no [wire] table", machine.name);
        let help = "`toolpost post` writes for mills; `toolpost machines list` names the machines";
        return Err(Diagnostic::error(Rule::MachineKind, message).help(help).into());
    };
    if settings.cutting.by_control && !machine.capabilities.compensation {
        let message = format!("the control of `{}` offsets no wire", machine.name);
        let help = "leave --by-control out: the path of the wire's centre is then calculated here";
        return Err(Diagnostic::error(Rule::ByControl, message).help(help).into());
    }
    if settings.cutting.tab.is_some() && !machine.blocks.contains_key("stop") {
        let message = format!(
            "a tab is cut while the operator holds the part, and `{}` has no block `stop`",
            machine.name
        );
        let help = "leave --tab out, or write how the control stops into the machine's file";
        return Err(Diagnostic::error(Rule::Tab, message).help(help).into());
    }
    let height = match (wire.height, settings.uv_height) {
        (Some(own), Some(given)) if own != given => {
            let message = format!(
                "`{}` counts U and V in a plane {own} mm up, and --uv-height says {given} mm",
                machine.name
            );
            let help = "leave --uv-height out, or change `height` in [wire] of the machine's file";
            return Err(Diagnostic::error(Rule::WireHeight, message).help(help).into());
        }
        (own, given) => own.or(given),
    };
    machine.wire = Some(Wire { height, memory: settings.memory.or(wire.memory), ..wire });
    Ok(())
}

/// Divides the paths into points, where the control cannot cut all of them as they are, and where a step is
/// asked for.
fn divide(segments: &mut [Segment], asked: Option<Step>, machine: &Machine) -> Result<(), Stop> {
    let arcs = |contour: &Contour| contour.elements().iter().any(|e| e.turn.is_some());
    let no_arcs = machine.capabilities.arcs.is_empty();
    let cannot = |segment: &Segment| segment.leans() || (no_arcs && arcs(segment.path.lower()));
    if asked.is_none() && !segments.iter().any(cannot) {
        return Ok(());
    }
    let step = asked.unwrap_or(Step::ChordError(machine.capabilities.lowering_tolerance));
    let memory = machine.wire.and_then(|wire| wire.memory);
    let paths: Vec<_> = segments.iter().map(|segment| &segment.path).collect();
    let all = points(&paths, step, memory).map_err(refused)?;
    for (segment, points) in segments.iter_mut().zip(all) {
        segment.points = Some(points);
    }
    Ok(())
}

/// Why there are no points, with the step that would do where one would.
fn refused(Refusal { diagnostic, offer }: Refusal) -> Stop {
    let finest = |mm: f64| (mm * 1e6).ceil() / 1e6;
    let way_out = match offer {
        Some(Step::Length(mm)) => {
            format!("--step {} is the finest that fits, or --fit", finest(mm))
        }
        Some(Step::ChordError(mm)) => {
            format!("--chord-error {} is the smallest that fits, or --fit", finest(mm))
        }
        _ => diagnostic.help.clone(),
    };
    let verdict = if diagnostic.rule == Rule::Memory { Verdict::Failed } else { Verdict::Invalid };
    Stop { verdict, findings: vec![diagnostic.help(way_out)] }
}
