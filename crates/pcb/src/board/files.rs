//! A board from its Gerber and Excellon files.
//!
//! Which file is which says the file itself (`.FileFunction`), or else its name; what is taken by its
//! name, is left out or had to be mended is a warning. Two files of one layer are refused.

use super::copper::way_out;
use super::layer::{Face, Format, Layer};
use super::outline::BrokenEdge;
use super::{Artwork, Board, Drawn, Pattern, covered, holes, outline};
use crate::excellon::Unit;
use crate::{excellon, gerber};
use program::{Diagnostic, Rule};
use rayon::prelude::*;

/// A file of a board.
#[derive(Clone, Copy, Debug)]
pub struct File<'a> {
    /// Its name, with or without folders: for the messages, and to see what it holds.
    pub name: &'a str,
    /// What it holds, where somebody has said so; otherwise that is found out.
    pub layer: Option<Layer>,
    /// The unit of a drill file that does not say it.
    pub unit: Option<Unit>,
    /// Its bytes.
    pub text: &'a [u8],
}

/// The name of each file that is part of a board, and what it holds, in the order of the files.
pub type Layers = Vec<(String, Layer)>;

/// What the files of a board give.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The board.
    pub board: Board,
    /// Its files.
    pub layers: Layers,
    /// What had to be assumed or is not used, and what is odd about the board.
    pub warnings: Vec<Diagnostic>,
}

/// Reads the files of a board of this name. Files that hold no layer are left out, with one warning.
///
/// # Errors
/// All that [`artwork`] and [`Artwork::united`] refuse.
pub fn read(name: &str, files: &[File]) -> Result<Reading, Vec<Diagnostic>> {
    let (artwork, layers) = artwork(name, files, |_| true)?;
    let (board, warnings) = artwork.united()?;
    Ok(Reading { board, layers, warnings })
}

/// The same, with copper that is still to be united, of the layers that are `wanted`: others are not read.
///
/// # Errors
/// `layer-twice` where two files hold the same layer, `layer-negative`, `no-board` where no file has
/// anything of a board, `layers-apart` where a layer lies wholly outside the board, and all that the readers
/// refuse; `layer` where copper cannot be united that reaches beyond the outline. An edge that is no outline is the board's
/// [`broken_edge`](Board::broken_edge).
pub fn artwork(
    name: &str,
    files: &[File],
    wanted: impl Fn(Layer) -> bool,
) -> Result<(Artwork, Layers), Vec<Diagnostic>> {
    let mut artwork = Artwork::default();
    artwork.board.name = name.into();
    let known = distinguished(files, &wanted, &mut artwork.warnings)?;
    let mut errors = Vec::new();
    // Some at the same time, and put together in the order of the files.
    for part in known.par_iter().map(Known::read).collect::<Vec<_>>() {
        match part {
            Ok(part) => artwork.take(part),
            Err(found) => errors.extend(found),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    artwork.warnings.extend(holes::once(&mut artwork.board.holes));
    let layers = known.iter().map(|layer| (layer.file.name.to_owned(), layer.layer)).collect();
    Ok((artwork.whole()?, layers))
}

/// A file of which is known what it holds.
struct Known<'a> {
    file: &'a File<'a>,
    layer: Layer,
    format: Format,
    source: From,
}

/// Who says what a file holds, the surest last.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum From {
    /// Its name has a side in it.
    Side,
    /// Its name is as a CAD system gives it.
    Name,
    /// The file itself.
    File,
    /// The user.
    User,
}

/// Which file is which: those that have something of a board that is wanted.
fn distinguished<'a>(
    files: &'a [File<'a>],
    wanted: &impl Fn(Layer) -> bool,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Known<'a>>, Vec<Diagnostic>> {
    let (mut known, mut unwanted) = (Vec::new(), Vec::new());
    let (mut others, mut not_through, mut unknown) = (Vec::new(), Vec::new(), Vec::new());
    for file in files {
        let format = Format::of(file.text);
        let named = || match (format, Layer::named(file.name)) {
            (Some(Format::Excellon), _) => Some((Layer::Holes(None), From::File)),
            // A drawing of the holes, or a list of the drills, is named like them.
            (_, Some(Layer::Holes(_))) => None,
            (Some(Format::Gerber), None) => Some((Layer::by_side(file.name)?, From::Side)),
            (_, named) => Some((named?, From::Name)),
        };
        let stated = || Some((Layer::stated(file.text)?, From::File));
        let given = file.layer.map(|layer| (layer, From::User));
        let (layer, source) = given.or_else(stated).or_else(named).unzip();
        let source = source.unwrap_or(From::Side);
        match layer {
            None if format == Some(Format::Gerber) => unknown.push(file.name),
            Some(Layer::Other) if Layer::is_not_through(file.text) => not_through.push(file.name),
            None | Some(Layer::Other) => others.push(file.name),
            Some(layer) if !wanted(layer) => unwanted.push(file.name),
            Some(layer) => {
                let holes = matches!(layer, Layer::Holes(_));
                let usual = if holes { Format::Excellon } else { Format::Gerber };
                known.push(Known { file, layer, format: format.unwrap_or(usual), source });
            }
        }
    }
    others.extend(less_sure(&mut known));
    let guessed: Vec<String> = known.iter().filter_map(Known::guessed).collect();
    if !guessed.is_empty() {
        let message = format!("taken by the names of the files: {}", guessed.join("; "));
        let help = "say it where one is another layer: --front, --back, --outline or --drill with the file";
        warnings.push(Diagnostic::warning(Rule::LayerByName, message).help(help));
    }
    if !unknown.is_empty() {
        let message = format!(
            "left out, as neither they nor their names say which layer they are: {}",
            listed(&unknown)
        );
        let help =
            "say it for those of this board: --front, --back, --outline or --drill with the file";
        warnings.push(Diagnostic::warning(Rule::LayerUnknown, message).help(help));
    }
    if !others.is_empty() {
        let message = format!("left out, as they hold no layer that is cut: {}", listed(&others));
        warnings.push(Diagnostic::warning(Rule::FileUnused, message));
    }
    if !not_through.is_empty() {
        let message = format!(
            "holes that do not go through the board are not drilled: {}",
            listed(&not_through)
        );
        let help = "drill them in their layers, before these are joined";
        warnings.push(Diagnostic::warning(Rule::HolesNotThrough, message).help(help));
    }
    if known.is_empty() && unwanted.is_empty() {
        let message = format!("none of {} files is a layer of a board", files.len());
        let help = "give the Gerber and Excellon files of a board; copper files end in .gtl and .gbl, \
                    or -F_Cu.gbr and -B_Cu.gbr, or say what they are (X2); or name them by --front and --back";
        return Err(vec![Diagnostic::error(Rule::NoBoard, message).help(help)]);
    }
    let twice = known.iter().enumerate().filter_map(|(i, one)| {
        let same = |earlier: &&Known| earlier.layer == one.layer;
        let earlier = known.iter().take(i).find(same)?;
        (!matches!(one.layer, Layer::Holes(_))).then(|| twice(one, earlier))
    });
    let twice: Vec<Diagnostic> = twice.collect();
    if twice.is_empty() { Ok(known) } else { Err(twice) }
}

impl Known<'_> {
    /// What it is taken for by its name alone.
    fn guessed(&self) -> Option<String> {
        let is_guessed = self.source <= From::Name && self.format == Format::Gerber;
        is_guessed.then(|| format!("{} as {}", self.file.name, self.layer))
    }

    /// A board with nothing but this layer.
    fn read(&self) -> Result<Artwork, Vec<Diagnostic>> {
        let File { name, text, unit, .. } = *self.file;
        let mut artwork = Artwork::default();
        let Artwork { board, warnings, .. } = &mut artwork;
        if let (Layer::Holes(plated), Format::Excellon) = (self.layer, self.format) {
            let reading = excellon::read_in(name, text, unit)?;
            board.holes.extend(holes::of_drill(reading.drill, plated));
            warnings.extend(reading.warnings);
            return Ok(artwork);
        }
        let gerber::Reading { image, warnings: found } = gerber::read(name, text)?;
        warnings.extend(found);
        let placed = |found: Diagnostic| found.file(name);
        if image.objects.is_empty() {
            let message = format!("nothing is on this layer: there is no {}", self.layer);
            let help = "plot it anew, or leave it out where there should be nothing";
            warnings.push(placed(Diagnostic::warning(Rule::LayerEmpty, message).help(help)));
            return Ok(artwork);
        }
        let negative =
            image.file_attribute(".FilePolarity").is_some_and(|value| value == ["Negative"]);
        match self.layer {
            Layer::Copper(_) if negative => {
                let message = "this layer of copper is drawn as a negative";
                let help = "plot it as a positive: what is painted is copper";
                let found = Diagnostic::error(Rule::LayerNegative, message).help(help);
                return Err(vec![placed(found)]);
            }
            Layer::Copper(face) => {
                let pattern = Pattern { file: name.to_owned(), drawn: Drawn::Image(image) };
                match face {
                    Face::Front => artwork.front = Some(pattern),
                    Face::Back => artwork.back = Some(pattern),
                }
            }
            Layer::Mask(face) => {
                let mask = covered(&image).map_err(|error| {
                    let message = format!("this layer cannot be taken: {error}");
                    let found = Diagnostic::error(Rule::Layer, message);
                    vec![placed(found.help(way_out(&error)))]
                })?;
                board.side_mut(face).mask = Some(mask);
            }
            Layer::Legend(face) => board.side_mut(face).legend = Some(image),
            Layer::Outline => {
                let broken = |findings| BrokenEdge::of_image(findings, &image).file(name);
                let mended = board.take_outline(outline::of_image(&image), broken);
                warnings.extend(mended.into_iter().map(placed));
            }
            Layer::Holes(plated) => {
                let found =
                    holes::of_image(&image, plated).map_err(|error| vec![placed(*error)])?;
                board.holes.extend(found);
            }
            Layer::Other => {}
        }
        Ok(artwork)
    }
}

/// Takes out files of which a surer one holds the same layer; answers their names.
fn less_sure<'a>(known: &mut Vec<Known<'a>>) -> Vec<&'a str> {
    let sure: Vec<(Layer, From)> = known.iter().map(|one| (one.layer, one.source)).collect();
    let is_surer = |one: &Known| {
        let holes = matches!(one.layer, Layer::Holes(_));
        !holes && sure.iter().any(|(layer, source)| *layer == one.layer && *source > one.source)
    };
    let names = known.iter().filter(|one| is_surer(one)).map(|one| one.file.name).collect();
    known.retain(|one| !is_surer(one));
    names
}

fn twice(one: &Known, earlier: &Known) -> Diagnostic {
    let message = format!("the {}, as is {}", one.layer, earlier.file.name);
    let help = "give the files of one board, and of two outlines the one that holds";
    Diagnostic::error(Rule::LayerTwice, message).help(help).file(one.file.name)
}

/// At most a dozen names.
fn listed(names: &[&str]) -> String {
    const MOST: usize = 12;
    let shown: Vec<&str> = names.iter().take(MOST).copied().collect();
    match names.len().saturating_sub(MOST) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
