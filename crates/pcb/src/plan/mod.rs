//! What a user asks for, as programs: which ones a board becomes, in which order, how it lies for each, and what each
//! cuts.

mod settings;
mod setup;
mod work;

pub use settings::*;
pub use setup::Setup;
pub use work::{Problem, ProblemKind, Work};

use crate::Board;
use crate::board::{Artwork, Face, Layer};
use program::{Diagnostic, Rule};

/// The programs that `settings` ask for of a board, in the order in which they are run.
///
/// # Errors
/// Where it has nothing of what is asked for.
pub fn parts(artwork: &Artwork, settings: &Settings) -> Result<Vec<Part>, Vec<Diagnostic>> {
    artwork.board().extents().ok_or_else(|| Box::new(empty()))?;
    let has = |part: Part| has(artwork, part, settings);
    let mut parts = Part::ALL.to_vec();
    parts.retain(|part| match &settings.only[..] {
        [] => has(*part) && is_usual(*part, settings),
        only => only.contains(part),
    });
    parts.sort_by_key(|part| order(*part, settings));
    if let Some(part) = parts.iter().find(|part| !has(**part)) {
        let message = format!("there is no {} on {}", part.what(), artwork.board().name);
        let help = "look which files of the board were read, and as what";
        return Err(vec![Diagnostic::error(Rule::NoSuchPart, message).help(help)]);
    }
    let tools = [
        (settings.clearing.mask_tool, [Part::FrontMask, Part::BackMask]),
        (settings.clearing.legend_tool, [Part::FrontLegend, Part::BackLegend]),
    ];
    let asked = |tool: Option<f64>| tool.is_some() && settings.only.is_empty();
    for (_, parts) in tools.iter().filter(|(tool, _)| asked(*tool)) {
        if !parts.iter().any(|part| has(*part)) {
            let message =
                format!("a tool is given, and there is no {} nor of the back", parts[0].what());
            let help = "give the layer too, or leave out the tool";
            return Err(vec![Diagnostic::error(Rule::NoSuchPart, message).help(help)]);
        }
    }
    if parts.is_empty() {
        return Err(vec![empty()]);
    }
    Ok(parts)
}

/// Whether a program that `settings` ask for cuts a layer, or lies where it does by it. What masks and legends hold is
/// asked by their own programs alone: they do not say how large the board is.
pub fn needs(layer: Layer, settings: &Settings) -> bool {
    let made = |part: Part| match &settings.only[..] {
        [] => is_usual(part, settings),
        only => only.contains(&part),
    };
    match layer {
        Layer::Mask(Face::Front) => made(Part::FrontMask),
        Layer::Mask(Face::Back) => made(Part::BackMask),
        Layer::Legend(Face::Front) => made(Part::FrontLegend),
        Layer::Legend(Face::Back) => made(Part::BackLegend),
        Layer::Copper(_) | Layer::Outline | Layer::Holes(_) | Layer::Other => true,
    }
}

/// Whether a program is made where nobody says which, of a board that has what it is about.
fn is_usual(part: Part, settings: &Settings) -> bool {
    match part {
        Part::Front | Part::Back | Part::Drill | Part::Outline => true,
        Part::FrontMask | Part::BackMask => settings.clearing.mask_tool.is_some(),
        Part::FrontLegend | Part::BackLegend => settings.clearing.legend_tool.is_some(),
    }
}

/// Whether the board has what a program is about.
fn has(artwork: &Artwork, part: Part, settings: &Settings) -> bool {
    let Board { front, back, outline, broken_edge, holes, .. } = artwork.board();
    match part {
        Part::Front => artwork.has_copper(Face::Front),
        Part::Back => artwork.has_copper(Face::Back),
        Part::Drill => !holes.is_empty() || settings.placing.alignment.is_some(),
        Part::Outline => outline.is_some() || broken_edge.is_some(),
        Part::FrontMask => front.mask.is_some(),
        Part::BackMask => back.mask.is_some(),
        Part::FrontLegend => front.legend.is_some(),
        Part::BackLegend => back.legend.is_some(),
    }
}

/// The side that is up when a program runs.
pub fn face(part: Part, settings: &Settings) -> Face {
    part.face().unwrap_or(settings.drilling.from)
}

/// Tells of cuts into the surface that go deeper than half of the board: from both sides they would meet.
///
/// # Errors
/// `deep-cut` where one goes through the board.
pub fn deep_cuts(parts: &[Part], settings: &Settings) -> Result<Vec<Diagnostic>, Box<Diagnostic>> {
    let thickness = settings.placing.thickness;
    let is_cut =
        |is_copper| parts.iter().any(|part| part.face().is_some() && part.is_copper() == is_copper);
    let mut deep = Vec::new();
    for (name, what, depth, is_copper) in [
        ("depth", "copper", settings.isolation.depth, true),
        ("engrave", "mask and legend", settings.clearing.engrave, false),
    ] {
        if !is_cut(is_copper) || depth <= thickness / 2.0 {
            continue;
        }
        let into = format!("--{name} {depth} cuts into {what}");
        let board = format!("the board, which is {thickness} mm thick");
        let help = format!("a smaller --{name}, such as 0.1, or the --thickness of the board");
        if depth >= thickness {
            let message = format!("{into} and through {board}");
            return Err(Box::new(Diagnostic::error(Rule::DeepCut, message).help(help)));
        }
        let message = format!("{into} deeper than half of {board}");
        deep.push(Diagnostic::warning(Rule::DeepCut, message).help(help));
    }
    Ok(deep)
}

/// Tells of pins that are drilled when the board has been turned over already.
pub fn late_pins(parts: &[Part], settings: &Settings) -> Option<Diagnostic> {
    let from_back = parts.contains(&Part::Drill) && face(Part::Drill, settings) == Face::Back;
    let turned = parts.iter().any(|part| face(*part, settings) == Face::Front);
    (from_back && turned && settings.placing.alignment.is_some()).then(|| {
        let message =
            "the pins that align the board are drilled when it has been turned over already";
        let help = "drill from the front, or run drill.nc first and turn the board then";
        Diagnostic::warning(Rule::PinsLate, message).help(help)
    })
}

/// Whether the holes are there already when a program runs.
pub fn is_drilled(part: Part, settings: &Settings) -> bool {
    order(Part::Drill, settings) < order(part, settings)
}

/// Where a program is in the order in which they are run: the front, then the back, on each side the holes at last,
/// so that pins are there before the board is turned over; and the outline behind all of it.
pub fn order(part: Part, settings: &Settings) -> (bool, bool, bool) {
    let is_back = face(part, settings) == Face::Back;
    (part == Part::Outline, is_back, part == Part::Drill)
}

/// Whether a setting is wrong, for whatever board: nothing is made then. All else is about one program of this board.
pub fn is_about_settings(found: &Diagnostic) -> bool {
    let settings = [
        Rule::NoTool,
        Rule::Setting,
        Rule::Length,
        Rule::Step,
        Rule::Passes,
        Rule::Overlap,
        Rule::Cutter,
        Rule::DeepCut,
        Rule::ToolWidth,
        Rule::TabHeight,
        Rule::TabCount,
    ];
    settings.contains(&found.rule)
}

/// What is said of a board with nothing on it.
pub(crate) fn empty() -> Diagnostic {
    Diagnostic::error(Rule::BoardEmpty, "there is nothing to make of this board")
        .help("look which files of the board were read, and as what")
}
