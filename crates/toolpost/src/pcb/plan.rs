//! Which programs a board becomes, and how the board lies on the machine for each.

use crate::answer::Stop;
use crate::args::pcb::{Part, Pcb, Turn};
use geom::Vec2;
use pcb::board::{Axis, Face};
use pcb::{Board, Hole};
use program::Diagnostic;

/// How much is left between the pins that align a board and the way on which it is cut out, mm.
const PINS_BESIDE: f64 = 1.0;

/// The programs of a board.
pub struct Plan {
    /// What the board is called.
    pub name: String,
    /// The board as it lies on the machine.
    front: Board,
    /// The same, turned over: its front is the back.
    back: Board,
    /// Holes beside the board by which it is aligned when it is turned over.
    pins: Vec<Hole>,
    /// The programs, in the order in which they are run.
    pub parts: Vec<Part>,
}

impl Plan {
    /// The programs that `args` ask for of a board.
    ///
    /// # Errors
    /// Where the board cannot be put there, or has nothing of what is asked for.
    pub fn of(board: Board, args: &Pcb) -> Result<Plan, Stop> {
        let placing = &args.placing;
        let board = match placing.panel {
            Some([columns, rows]) => {
                board.panel(columns as usize, rows as usize, Vec2::splat(placing.spacing))?
            }
            None => board,
        };
        let (low, _) = board.extents().ok_or_else(empty)?;
        let corner = placing.corner.map_or(Vec2::ZERO, Vec2::from);
        let front = if placing.as_drawn { board } else { board.moved(corner - low)? };
        let axis = match placing.turn {
            Turn::Y => Axis::X(front.middle().x),
            Turn::X => Axis::Y(front.middle().y),
        };
        let pins = match placing.alignment {
            Some(diameter) => {
                let beside = args.outline.outline_tool + PINS_BESIDE;
                front.pins(axis, diameter, beside)?.to_vec()
            }
            None => Vec::new(),
        };
        let back = front.turned_over(axis);
        let mut plan = Plan { name: front.name.clone(), front, back, pins, parts: Vec::new() };
        let mut parts = Part::ALL.to_vec();
        parts.retain(|part| match &args.only[..] {
            [] => plan.is_usual(*part, args),
            only => only.contains(part),
        });
        parts.sort_by_key(|part| plan.order(*part, args));
        plan.parts = parts;
        if let Some(part) = plan.parts.iter().find(|part| !plan.has(**part)) {
            let message = format!("there is no {} on {}", part.what(), plan.name);
            let help = "look which files of the board were read, and as what";
            return Err(Diagnostic::error("no-such-part", message).help(help).into());
        }
        let tools = [
            (args.clearing.mask_tool, [Part::FrontMask, Part::BackMask]),
            (args.clearing.legend_tool, [Part::FrontLegend, Part::BackLegend]),
        ];
        for (_, parts) in tools.iter().filter(|(tool, _)| tool.is_some()) {
            if !parts.iter().any(|part| plan.has(*part)) {
                let message =
                    format!("a tool is given, and there is no {} nor of the back", parts[0].what());
                let help = "give the layer too, or leave out the tool";
                return Err(Diagnostic::error("no-such-part", message).help(help).into());
            }
        }
        if plan.parts.is_empty() {
            return Err(empty().into());
        }
        Ok(plan)
    }

    /// Whether a program is made where nobody says which.
    fn is_usual(&self, part: Part, args: &Pcb) -> bool {
        let asked = match part {
            Part::Front | Part::Back | Part::Drill | Part::Outline => true,
            Part::FrontMask | Part::BackMask => args.clearing.mask_tool.is_some(),
            Part::FrontLegend | Part::BackLegend => args.clearing.legend_tool.is_some(),
        };
        asked && self.has(part)
    }

    /// Whether the board has what a program is about.
    fn has(&self, part: Part) -> bool {
        let Board { front, back, outline, holes, .. } = &self.front;
        match part {
            Part::Front => front.copper.is_some(),
            Part::Back => back.copper.is_some(),
            Part::Drill => !holes.is_empty() || !self.pins.is_empty(),
            Part::Outline => outline.is_some(),
            Part::FrontMask => front.mask.is_some(),
            Part::BackMask => back.mask.is_some(),
            Part::FrontLegend => front.legend.is_some(),
            Part::BackLegend => back.legend.is_some(),
        }
    }

    /// The board as it lies on the machine when its front is up.
    pub fn front(&self) -> &Board {
        &self.front
    }

    /// The board as it lies on the machine for a program: its front is up, whichever side that is.
    pub fn seen(&self, part: Part, args: &Pcb) -> &Board {
        match self.face(part, args) {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }

    /// The side that is up when a program runs.
    pub fn face(&self, part: Part, args: &Pcb) -> Face {
        part.face().unwrap_or(args.drilling.from.into())
    }

    /// The holes that are drilled, as they lie for a program: those of the board, and those of the pins. The line
    /// about which a board is turned over is in the middle between these, so that they stay where they are.
    pub fn drilled(&self, part: Part, args: &Pcb) -> impl Iterator<Item = &Hole> {
        self.seen(part, args).holes.iter().chain(&self.pins)
    }

    /// Tells of pins that are drilled when the board has been turned over already.
    pub fn late_pins(&self, args: &Pcb) -> Option<Diagnostic> {
        let is_face = |part: &Part, face| self.face(*part, args) == face;
        let from_back =
            self.parts.iter().any(|part| *part == Part::Drill && is_face(part, Face::Back));
        let turned = self.parts.iter().any(|part| is_face(part, Face::Front));
        (from_back && turned && !self.pins.is_empty()).then(|| {
            let message =
                "the pins that align the board are drilled when it has been turned over already";
            let help = "drill from the front, or run drill.nc first and turn the board then";
            Diagnostic::warning("pins-late", message).help(help)
        })
    }

    /// Whether the holes are there already when a program runs.
    pub fn is_drilled(&self, part: Part, args: &Pcb) -> bool {
        self.order(Part::Drill, args) < self.order(part, args)
    }

    /// Where a program is in the order in which they are run: the front, then the back, on each side the holes at last,
    /// so that pins are there before the board is turned over; and the outline behind all of it.
    fn order(&self, part: Part, args: &Pcb) -> (bool, bool, bool) {
        let is_back = self.face(part, args) == Face::Back;
        (part == Part::Outline, is_back, part == Part::Drill)
    }
}

fn empty() -> Diagnostic {
    Diagnostic::error("board-empty", "there is nothing to make of this board")
        .help("look which files of the board were read, and as what")
}
