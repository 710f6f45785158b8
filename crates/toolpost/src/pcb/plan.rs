//! Which programs a board becomes.

use crate::answer::Stop;
use crate::args::pcb::{Part, Pcb};
use pcb::Board;
use pcb::board::{Artwork, Face};
use program::Diagnostic;

/// The programs that `args` ask for of a board, in the order in which they are run.
///
/// # Errors
/// Where it has nothing of what is asked for.
pub fn parts(artwork: &Artwork, args: &Pcb) -> Result<Vec<Part>, Stop> {
    artwork.board().extents().ok_or_else(empty)?;
    let has = |part: Part| has(artwork, part, args);
    let mut parts = Part::ALL.to_vec();
    parts.retain(|part| match &args.only[..] {
        [] => has(*part) && is_usual(*part, args),
        only => only.contains(part),
    });
    parts.sort_by_key(|part| order(*part, args));
    if let Some(part) = parts.iter().find(|part| !has(**part)) {
        let message = format!("there is no {} on {}", part.what(), artwork.board().name);
        let help = "look which files of the board were read, and as what";
        return Err(Diagnostic::error("no-such-part", message).help(help).into());
    }
    let tools = [
        (args.clearing.mask_tool, [Part::FrontMask, Part::BackMask]),
        (args.clearing.legend_tool, [Part::FrontLegend, Part::BackLegend]),
    ];
    for (_, parts) in tools.iter().filter(|(tool, _)| tool.is_some()) {
        if !parts.iter().any(|part| has(*part)) {
            let message =
                format!("a tool is given, and there is no {} nor of the back", parts[0].what());
            let help = "give the layer too, or leave out the tool";
            return Err(Diagnostic::error("no-such-part", message).help(help).into());
        }
    }
    if parts.is_empty() {
        return Err(empty().into());
    }
    Ok(parts)
}

/// Whether a program is made where nobody says which, of a board that has what it is about.
fn is_usual(part: Part, args: &Pcb) -> bool {
    match part {
        Part::Front | Part::Back | Part::Drill | Part::Outline => true,
        Part::FrontMask | Part::BackMask => args.clearing.mask_tool.is_some(),
        Part::FrontLegend | Part::BackLegend => args.clearing.legend_tool.is_some(),
    }
}

/// Whether the board has what a program is about.
fn has(artwork: &Artwork, part: Part, args: &Pcb) -> bool {
    let Board { front, back, outline, holes, .. } = artwork.board();
    match part {
        Part::Front => artwork.has_copper(Face::Front),
        Part::Back => artwork.has_copper(Face::Back),
        Part::Drill => !holes.is_empty() || args.placing.alignment.is_some(),
        Part::Outline => outline.is_some(),
        Part::FrontMask => front.mask.is_some(),
        Part::BackMask => back.mask.is_some(),
        Part::FrontLegend => front.legend.is_some(),
        Part::BackLegend => back.legend.is_some(),
    }
}

/// The side that is up when a program runs.
pub fn face(part: Part, args: &Pcb) -> Face {
    part.face().unwrap_or(args.drilling.from.into())
}

/// Tells of pins that are drilled when the board has been turned over already.
pub fn late_pins(parts: &[Part], args: &Pcb) -> Option<Diagnostic> {
    let from_back = parts.contains(&Part::Drill) && face(Part::Drill, args) == Face::Back;
    let turned = parts.iter().any(|part| face(*part, args) == Face::Front);
    (from_back && turned && args.placing.alignment.is_some()).then(|| {
        let message =
            "the pins that align the board are drilled when it has been turned over already";
        let help = "drill from the front, or run drill.nc first and turn the board then";
        Diagnostic::warning("pins-late", message).help(help)
    })
}

/// Whether the holes are there already when a program runs.
pub fn is_drilled(part: Part, args: &Pcb) -> bool {
    order(Part::Drill, args) < order(part, args)
}

/// Where a program is in the order in which they are run: the front, then the back, on each side the holes at last,
/// so that pins are there before the board is turned over; and the outline behind all of it.
pub fn order(part: Part, args: &Pcb) -> (bool, bool, bool) {
    let is_back = face(part, args) == Face::Back;
    (part == Part::Outline, is_back, part == Part::Drill)
}

/// What is said of a board with nothing on it.
pub fn empty() -> Diagnostic {
    Diagnostic::error("board-empty", "there is nothing to make of this board")
        .help("look which files of the board were read, and as what")
}
