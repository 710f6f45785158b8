//! What is to be cut: the contours of the source, for both ends of the wire.

use super::{Settings, Sync};
use crate::account::Stop;
use crate::input;
use crate::toolpath::{self, Origin, Toolpath, is_unknown_position};
use crate::watch::Watch;
use geom::Vec2;
use machine::Machine;
use program::{Circle, Diagnostic, NoPose, Op, Pose, Program, Rule};
use wire::{Contour, Cut, OffsetContour, Path, contours, cuts, dxf, offset_contours};

/// A source with the wire paths that it gives.
pub struct Source {
    /// The source; the lower contour where there are two.
    pub toolpath: Toolpath,
    /// One path for each opening.
    pub paths: Vec<Path>,
    /// The contours from which the control of the source program offsets the wire; empty where it does not.
    pub offset: Vec<OffsetContour>,
    /// Height of the part, mm, where it is given: of the upper contour over the lower.
    pub height: Option<f64>,
}

/// One file of the source.
enum File {
    /// A drawing with its contours.
    Drawing(Toolpath, Vec<Contour>),
    /// A program with its moves.
    Program(Toolpath),
}

impl Source {
    /// Reads `source`, and the upper contour that `settings` name.
    ///
    /// # Errors
    /// What is wrong with a file, or cannot be cut.
    pub fn read(
        source: &input::Source,
        strict: bool,
        origin: &Origin,
        (settings, machine): (&Settings, &Machine),
        watch: &dyn Watch,
    ) -> Result<Source, Stop> {
        let is_drawn = is_drawing(source) || settings.upper.as_ref().is_some_and(is_drawing);
        if let Some(found) = without_drawing(settings).filter(|_| !is_drawn) {
            return Err(found.file(source.name()).into());
        }
        let own = origin.from.as_ref().map(|from| origin.reach.load_origin(from)).transpose()?;
        let plane = || own.as_ref().and_then(|own| toolpath::wire_of(own, machine)?.height);
        let height = settings.height.or_else(plane);
        let read = |source: &input::Source| {
            let file = File::read(source, strict, origin, (settings, machine), watch)?;
            match &own {
                Some(own) if own.wire.is_some() => file.without_feeds(strict),
                _ => Ok(file),
            }
        };
        let start = origin.start.map(|start| start.truncate());
        let lower = read(source)?;
        let upper = match &settings.upper {
            Some(source) => Some(read(source)?),
            None => None,
        };
        let offset = match (&lower, &upper) {
            (File::Program(below), None) if settings.cutting.side.is_some() => {
                let found =
                    lower.in_one_frame().and_then(|()| offset_contours(&below.program, start));
                found.map_err(|found| below.refused(*found))?.unwrap_or_default()
            }
            _ => Vec::new(),
        };
        let contours_offset = || offset.iter().map(|found| found.contour.clone()).collect();
        let paths = match (&lower, &upper) {
            _ if !offset.is_empty() => Ok(upright(contours_offset())),
            (File::Program(below), None) => match leaning(&below.program, height) {
                Some(ends) => ends.and_then(|(below, above)| {
                    lower.in_one_frame()?;
                    by_block(cuts(&below, start)?, cuts(&above, start)?)
                }),
                None => lower.contours(start).map(upright),
            },
            (_, None) => lower.contours(start).map(upright),
            (_, Some(upper)) => {
                let above = |found: Box<Diagnostic>| upper.toolpath().refused(*found);
                match settings.sync {
                    Sync::Block if settings.pairs.is_empty() => {
                        let above = upper.cuts(start).map_err(above)?;
                        lower.cuts(start).and_then(|below| by_block(below, above))
                    }
                    Sync::Block | Sync::Length => {
                        let above = upper.contours(start).map_err(above)?;
                        let below = lower.contours(start);
                        below.and_then(|below| by_points(&below, &above, &settings.pairs))
                    }
                }
            }
        };
        let paths = paths.map_err(|found| lower.toolpath().refused(*found))?;
        let leans = |path: &Path| path.upper().is_some();
        if paths.iter().any(leans) && height.is_none() {
            return Err(without_height_of_part().into());
        }
        let (File::Drawing(mut toolpath, _) | File::Program(mut toolpath)) = lower;
        if let Some(File::Drawing(above, _) | File::Program(above)) = upper {
            toolpath = toolpath.read_with(above);
        }
        Ok(Source { toolpath, paths, offset, height })
    }
}

/// Whether a file is a drawing, by its ending.
pub fn is_drawing(source: &input::Source) -> bool {
    source.path().extension().unwrap_or_default().eq_ignore_ascii_case("dxf")
}

/// What refuses settings of a drawing where there is none.
fn without_drawing(settings: &Settings) -> Option<Diagnostic> {
    let default = Settings::default();
    let given = [
        ("--layer", settings.layers != default.layers),
        ("--close", settings.close != default.close),
    ];
    let (name, _) = given.into_iter().find(|(_, given)| *given)?;
    let message = format!("{name} is for a drawing (.dxf), which this is not");
    Some(Diagnostic::error(Rule::Origin, message).help("leave it out"))
}

impl File {
    fn read(
        source: &input::Source,
        strict: bool,
        origin: &Origin,
        (settings, machine): (&Settings, &Machine),
        watch: &dyn Watch,
    ) -> Result<File, Stop> {
        if !is_drawing(source) {
            let toolpath = toolpath::read_wire(source, strict, origin, machine, watch);
            let toolpath = toolpath.map_err(without_height)?;
            if let Some(found) = within_contour(&toolpath.program) {
                return Err(toolpath.refused(found));
            }
            let mut warnings = left_out(&toolpath.program);
            toolpath.quote(&mut warnings);
            warnings.splice(0..0, toolpath.warnings.clone());
            return Ok(File::Program(toolpath.warned(warnings, strict)?));
        }
        origin.goes_with(&source.name())?;
        origin.is_of_no_record(&source.name())?;
        let text = source.text()?;
        let options = dxf::Options {
            layers: settings.layers.clone(),
            gap: settings.close,
            ..dxf::Options::default()
        };
        let toolpath = Toolpath::of_drawing(source, &text, "DXF");
        let drawing = dxf::read(&text, &options).map_err(|found| toolpath.refused(*found))?;
        let toolpath = toolpath.warned(drawing.warnings, strict)?;
        Ok(File::Drawing(toolpath, drawing.contours))
    }

    /// With a warning about the feeds of a wire that are in it.
    fn without_feeds(self, strict: bool) -> Result<File, Stop> {
        let File::Program(toolpath) = self else { return Ok(self) };
        let feeds = toolpath.program.records.iter();
        let mut lines =
            feeds.filter(|record| matches!(record.op, Op::Feed(_))).map(|record| record.line);
        let Some(first) = lines.next() else { return Ok(File::Program(toolpath)) };
        let message = "the feeds of the source are left out: a contour alone is taken from it";
        let help = "--feed says those of each pass; conditions of the generator are left out, too";
        let mut found = Diagnostic::warning(Rule::Feed, message).help(help).line(first);
        lines.for_each(|line| found.again(line));
        let mut warnings = vec![found];
        toolpath.quote(&mut warnings);
        warnings.splice(0..0, toolpath.warnings.clone());
        Ok(File::Program(toolpath.warned(warnings, strict)?))
    }

    fn toolpath(&self) -> &Toolpath {
        match self {
            File::Drawing(toolpath, _) | File::Program(toolpath) => toolpath,
        }
    }

    /// A program that goes from one work offset to another has contours whose distance is not in it.
    fn in_one_frame(&self) -> Result<(), Box<Diagnostic>> {
        let File::Program(toolpath) = self else { return Ok(()) };
        let records = &toolpath.program.records;
        match records.iter().rfind(|record| matches!(record.op, Op::WorkOffset(_))) {
            None => Ok(()),
            Some(record) => {
                let message =
                    "another work offset: how far it is from the first, only the machine knows";
                let help = "cut what belongs to each work offset by a program of its own";
                let found = Diagnostic::error(Rule::WorkOffset, message).help(help);
                Err(found.line(record.line).into())
            }
        }
    }

    fn contours(&self, start: Option<Vec2>) -> Result<Vec<Contour>, Box<Diagnostic>> {
        match self {
            File::Drawing(_, contours) => Ok(contours.clone()),
            File::Program(toolpath) => {
                self.in_one_frame()?;
                contours(&toolpath.program, start)
            }
        }
    }

    /// Move by move.
    fn cuts(&self, start: Option<Vec2>) -> Result<Vec<Cut>, Box<Diagnostic>> {
        match self {
            File::Drawing(_, contours) => {
                let cut = |contour: &Contour| Cut {
                    elements: contour.elements().to_vec(),
                    ..Cut::default()
                };
                Ok(contours.iter().map(cut).collect())
            }
            File::Program(toolpath) => {
                self.in_one_frame()?;
                cuts(&toolpath.program, start)
            }
        }
    }
}

fn upright(contours: Vec<Contour>) -> Vec<Path> {
    contours.into_iter().map(Path::upright).collect()
}

/// What refuses a source that stops, or cuts and threads the wire, between two cuts of a contour: there a slug or the part is held before it
/// falls, and the path of the wire, which is made anew, has no such place.
fn within_contour(program: &Program) -> Option<Diagnostic> {
    let (mut cuts, mut between) = (false, None);
    for record in &program.records {
        let what = match record.op {
            Op::Line(_) | Op::Arc(_) => {
                if let Some(found) = between.take().filter(|_| cuts) {
                    return Some(found);
                }
                cuts = true;
                continue;
            }
            Op::Rapid(_) | Op::MachineMove(_) | Op::Home => {
                (cuts, between) = (false, None);
                continue;
            }
            Op::Stop => "the source stops",
            Op::OptionalStop => "the source has an optional stop",
            Op::ThreadWire => "the source threads the wire",
            Op::CutWire => "the source cuts the wire",
            _ => continue,
        };
        let message = format!(
            "{what} within a contour, and the path of the wire, which is made anew, has no such place"
        );
        let help = "take it out of the source; --tab MM leaves a tab, before which the program stops for the operator";
        let found = Diagnostic::error(Rule::StopInCut, message).help(help).line(record.line);
        between.get_or_insert(found);
    }
    None
}

/// What a source calls besides its contour, and the program of a wire does not.
fn left_out(program: &Program) -> Vec<Diagnostic> {
    let found = program.records.iter().filter_map(|record| {
        let what = match &record.op {
            Op::Auxiliary(function) => format!("M{}", function.number),
            Op::Stop => "M0".to_owned(),
            Op::OptionalStop => "M1".to_owned(),
            Op::Output(output) => format!("output {}", output.number),
            Op::WorkOffsetData(_) => "G10".to_owned(),
            Op::Input(input) => format!("input {}", input.number),
            _ => return None,
        };
        let message = format!("{what} of the source is left out: a contour alone is taken from it");
        let help = "write it into the blocks of the machine file, if every program needs it";
        Some(Diagnostic::warning(Rule::Auxiliary, message).help(help).line(record.line))
    });
    let mut all: Vec<Diagnostic> = Vec::new();
    for warning in found {
        match all.iter_mut().find(|known| known.message == warning.message) {
            Some(known) => known.again(warning.line),
            None => all.push(warning),
        }
    }
    all
}

/// Says how a program that never names Z is read.
fn without_height(mut stop: Stop) -> Stop {
    for found in stop.findings.iter_mut().filter(|f| is_unknown_position(f.rule)) {
        found.help =
            "--from with a wire machine, which has no Z; or --start with where it starts".into();
    }
    stop
}

fn by_block(below: Vec<Cut>, above: Vec<Cut>) -> Result<Vec<Path>, Box<Diagnostic>> {
    as_many(below.len(), above.len())?;
    let path = |(below, above): (Cut, Cut)| {
        let path = Path::by_block(below.elements, above.elements)?;
        Ok(path.starting_by(below.brought_by))
    };
    below.into_iter().zip(above).map(path).collect()
}

/// By the points of `pairs`, each of which belongs to the lower contour that is nearest to it; between
/// them by length.
fn by_points(
    below: &[Contour],
    above: &[Contour],
    pairs: &[[f64; 4]],
) -> Result<Vec<Path>, Box<Diagnostic>> {
    as_many(below.len(), above.len())?;
    let mut own = vec![Vec::new(); below.len()];
    for &[x, y, u, v] in pairs {
        let (point, over) = (Vec2::new(x, y), Vec2::new(u, v));
        let away = |contour: &Contour| contour.nearest(point).point.distance(point);
        let contours = below.iter().map(away).zip(&mut own);
        if let Some((_, own)) = contours.min_by(|a, b| a.0.total_cmp(&b.0)) {
            own.push((point, over));
        }
    }
    let contours = below.iter().zip(above).zip(&own);
    contours.map(|((below, above), own)| Path::by_points(below, above, own)).collect()
}

/// Both ends go through the same openings.
fn as_many(below: usize, above: usize) -> Result<(), Box<Diagnostic>> {
    if below == above {
        return Ok(());
    }
    let message = format!("the lower end cuts {below} contours and the upper {above}");
    let help = "a rapid parts two contours: both sources need the same ones in the same order";
    Err(Diagnostic::error(Rule::SyncOpenings, message).help(help).into())
}

/// The refusal of an upper contour without a height.
fn without_height_of_part() -> Diagnostic {
    let message = "the wire leans, and the height of the part is not known";
    Diagnostic::error(Rule::WireHeight, message).help("give it with --height")
}

/// The paths of both ends of a wire that the program itself tilts, such as by U and V.
fn leaning(
    program: &Program,
    height: Option<f64>,
) -> Option<Result<(Program, Program), Box<Diagnostic>>> {
    let leans = |pose: &Pose| pose.axis().truncate() != Vec2::ZERO;
    let mut poses = program.records.iter().filter_map(|record| record.op.pose());
    if !poses.any(leans) {
        return None;
    }
    let (mut lower, mut upper) = (program.clone(), program.clone());
    for (below, above) in lower.records.iter_mut().zip(&mut upper.records) {
        let Some(axis) = below.op.pose().map(Pose::axis) else { continue };
        let Some(lean) = height.and_then(|height| machine::lean(axis, height)) else {
            return Some(Err(without_height_of_part().line(below.line).into()));
        };
        if let Err(numbers) =
            shift(&mut below.op, Vec2::ZERO).and_then(|()| shift(&mut above.op, lean))
        {
            return Some(Err(numbers.into()));
        }
    }
    Some(Ok((lower, upper)))
}

/// The same move of an upright wire, moved by `by`.
fn shift(op: &mut Op, by: Vec2) -> Result<(), NoPose> {
    let upright = |pose: &mut Pose| {
        *pose = Pose::upright(pose.point() + by.extend(0.0))?;
        Ok(())
    };
    match op {
        Op::Rapid(pose) | Op::Line(pose) => upright(pose),
        Op::Arc(arc) => {
            let circle = arc.circle;
            arc.circle =
                Circle::new(circle.center() + by.extend(0.0), circle.normal(), circle.turns())?;
            upright(&mut arc.end)
        }
        _ => Ok(()),
    }
}
