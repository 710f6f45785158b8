//! What a user asks for: which programs, by which tools, how deep, how fast.

use crate::board::Face;
use crate::excellon::Unit;
use crate::isolation::{Direction, Narrow};
use geom::Vec2;
use program::{Diagnostic, LEAST_SETTING, MOST_SETTING, needs, not_both, within};

/// How a board is made. The default has no tool that cuts around copper.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// What to make; nothing: all that the board has and that tools are given for.
    pub only: Vec<Part>,
    /// The unit of drill files that do not say it.
    pub unit: Option<Unit>,
    /// How copper is isolated.
    pub isolation: Isolation,
    /// What else is cut of copper, mask and legend.
    pub clearing: Clearing,
    /// How holes are made.
    pub drilling: Drilling,
    /// How the board is cut out.
    pub outline: Outline,
    /// Where the board lies on the machine.
    pub placing: Placing,
    /// How the machine runs.
    pub running: Running,
}

/// The least angle of a V-bit, and the least by which it is no flat end, degrees.
const SHARPEST: f64 = 0.1;

/// The thinnest step down that a machine makes, mm.
const THINNEST: f64 = 0.001;

/// The widest gap of an edge that is closed, mm.
const WIDEST_GAP: f64 = 10.0;

/// The most times around, and tabs.
const MOST: f64 = 100.0;

/// The longest start of a spindle, s.
const LONGEST_START: f64 = 600.0;

/// The most columns and rows.
const MOST_LINES: f64 = 1000.0;

impl Settings {
    /// Checks that every number is one that makes sense by itself.
    ///
    /// # Errors
    /// `setting`, with the name of the first that does not; two settings that exclude each other, or one that has no meaning without another.
    pub fn check(&self) -> Result<(), Box<Diagnostic>> {
        let Settings { only: _, unit: _, isolation, clearing, drilling, outline, placing, running } =
            self;
        let given = |name, value: Option<f64>, low| (name, value.unwrap_or(low), low, MOST_SETTING);
        let lines = |name, [a, b]: [u32; 2]| [a, b].map(|n| (name, f64::from(n), 1.0, MOST_LINES));
        let widths =
            clearing.clear.iter().map(|width| ("clear", *width, LEAST_SETTING, MOST_SETTING));
        let drills =
            drilling.drills.iter().map(|width| ("drills", *width, LEAST_SETTING, MOST_SETTING));
        let wider =
            isolation.wider.iter().map(|width| ("tool", *width, LEAST_SETTING, MOST_SETTING));
        let tabs = outline.tab_at.iter().flat_map(|at| at.to_array());
        let tabs = tabs.map(|value| ("tab_at", value, -MOST_SETTING, MOST_SETTING));
        let corner = placing.corner.unwrap_or_default();
        let all = [
            given("tool", isolation.tool, LEAST_SETTING),
            ("vee", isolation.vee.unwrap_or(SHARPEST), SHARPEST, 180.0 - SHARPEST),
            ("tip", isolation.tip, 0.0, MOST_SETTING),
            ("depth", isolation.depth, LEAST_SETTING, MOST_SETTING),
            given("step", isolation.step, THINNEST),
            ("passes", f64::from(isolation.passes), 1.0, MOST),
            ("overlap", isolation.overlap, 0.0, 0.95),
            given("isolation_width", isolation.isolation_width, LEAST_SETTING),
            ("margin", clearing.margin, 0.0, MOST_SETTING),
            given("mask_tool", clearing.mask_tool, LEAST_SETTING),
            given("legend_tool", clearing.legend_tool, LEAST_SETTING),
            ("engrave", clearing.engrave, LEAST_SETTING, MOST_SETTING),
            ("drill_tolerance", drilling.drill_tolerance, 0.0, MOST_SETTING),
            given("hole_mill", drilling.hole_mill, LEAST_SETTING),
            given("mill_holes_over", drilling.mill_holes_over, 0.0),
            given("peck", drilling.peck, THINNEST),
            ("outline_tool", outline.outline_tool, LEAST_SETTING, MOST_SETTING),
            ("outline_step", outline.outline_step, THINNEST, MOST_SETTING),
            ("tabs", f64::from(outline.tabs), 0.0, MOST),
            ("tab_width", outline.tab_width, LEAST_SETTING, MOST_SETTING),
            ("tab_height", outline.tab_height, LEAST_SETTING, MOST_SETTING),
            ("close_gaps", outline.close_gaps, 0.0, WIDEST_GAP),
            given("board_margin", outline.board_margin, 0.0),
            ("thickness", placing.thickness, LEAST_SETTING, MOST_SETTING),
            ("through", placing.through, 0.0, MOST_SETTING),
            ("rotate", placing.rotate, -360.0, 360.0),
            ("corner", corner.x, -MOST_SETTING, MOST_SETTING),
            ("corner", corner.y, -MOST_SETTING, MOST_SETTING),
            given("alignment", placing.alignment, LEAST_SETTING),
            ("spacing", placing.spacing, 0.0, MOST_SETTING),
            ("feed", running.feed, LEAST_SETTING, MOST_SETTING),
            ("plunge", running.plunge, LEAST_SETTING, MOST_SETTING),
            ("drill_feed", running.drill_feed, LEAST_SETTING, MOST_SETTING),
            ("outline_feed", running.outline_feed, LEAST_SETTING, MOST_SETTING),
            given("speed", running.speed, LEAST_SETTING),
            ("spin_up", running.spin_up.unwrap_or(0.0), 0.0, LONGEST_START),
            ("travel", running.travel, LEAST_SETTING, MOST_SETTING),
            ("approach", running.approach, LEAST_SETTING, MOST_SETTING),
        ];
        let grids = lines("panel", placing.panel.unwrap_or([1, 1])).into_iter();
        let grids = grids.chain(lines("probe", running.probe.unwrap_or([1, 1])));
        let lists = widths.chain(drills).chain(wider).chain(tabs).chain(grids);
        for (name, value, low, high) in all.into_iter().chain(lists) {
            within(name, value, low, high)?;
        }
        let default = Settings::default();
        not_both("tool", "vee", isolation.tool.is_some() && isolation.vee.is_some())?;
        not_both("corner", "as_drawn", placing.corner.is_some() && placing.as_drawn)?;
        let tip = isolation.tip != default.isolation.tip;
        needs("tip", "vee", tip && isolation.vee.is_none())?;
        let passes = isolation.passes != default.isolation.passes;
        not_both("passes", "isolation_width", passes && isolation.isolation_width.is_some())?;
        let is_around = isolation.isolate == Isolate::Contours;
        let width = isolation.isolation_width.is_some();
        not_both("isolate", "isolation_width", !is_around && width)?;
        not_both("isolate", "several tools", !is_around && !isolation.wider.is_empty())?;
        not_both("isolate", "invert", !is_around && isolation.invert)?;
        not_both("clear", "invert", !clearing.clear.is_empty() && isolation.invert)?;
        let over = drilling.mill_holes_over.is_some();
        needs("mill_holes_over", "hole_mill", over && drilling.hole_mill.is_none())?;
        let margin = clearing.margin != default.clearing.margin;
        needs("margin", "clear", margin && clearing.clear.is_empty())?;
        let spacing = placing.spacing != default.placing.spacing;
        needs("spacing", "panel", spacing && placing.panel.is_none())?;
        needs("on_control", "probe", running.on_control && running.probe.is_none())
    }
}

/// A program of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The copper of the front.
    Front,
    /// The copper of the back, from the back.
    Back,
    /// The holes.
    Drill,
    /// The edge of the board and its cut-outs.
    Outline,
    /// The solder mask of the front.
    FrontMask,
    /// The solder mask of the back, from the back.
    BackMask,
    /// The legend of the front.
    FrontLegend,
    /// The legend of the back, from the back.
    BackLegend,
}

impl Part {
    /// All.
    pub const ALL: [Part; 8] = [
        Part::Front,
        Part::FrontMask,
        Part::FrontLegend,
        Part::Drill,
        Part::Back,
        Part::BackMask,
        Part::BackLegend,
        Part::Outline,
    ];

    /// What its program and picture are called.
    pub fn name(self) -> &'static str {
        match self {
            Part::Front => "front",
            Part::Back => "back",
            Part::Drill => "drill",
            Part::Outline => "outline",
            Part::FrontMask => "front-mask",
            Part::BackMask => "back-mask",
            Part::FrontLegend => "front-legend",
            Part::BackLegend => "back-legend",
        }
    }

    /// What of the board it is about.
    pub fn what(self) -> &'static str {
        match self {
            Part::Front => "copper of the front",
            Part::Back => "copper of the back",
            Part::Drill => "hole",
            Part::Outline => "outline",
            Part::FrontMask => "solder mask of the front",
            Part::BackMask => "solder mask of the back",
            Part::FrontLegend => "legend of the front",
            Part::BackLegend => "legend of the back",
        }
    }

    /// Whether it cuts copper from the top.
    pub fn is_copper(self) -> bool {
        matches!(self, Part::Front | Part::Back)
    }

    /// The side that it is about; `None` for what goes through the board.
    pub fn face(self) -> Option<Face> {
        match self {
            Part::Front | Part::FrontMask | Part::FrontLegend => Some(Face::Front),
            Part::Back | Part::BackMask | Part::BackLegend => Some(Face::Back),
            Part::Drill | Part::Outline => None,
        }
    }
}

/// How copper is isolated.
#[derive(Clone, Debug, PartialEq)]
pub struct Isolation {
    /// Widths of end mills that cut around copper before `tool` or `vee`, the widest first, mm: each as far as it goes in, the next
    /// one what is left.
    pub wider: Vec<f64>,
    /// Width of the end mill that cuts around copper, mm.
    pub tool: Option<f64>,
    /// Angle between the edges of a V-bit that does it, degrees; its width follows from `tip` and `depth`.
    pub vee: Option<f64>,
    /// Width of the tip of the V-bit, mm.
    pub tip: f64,
    /// How deep below the surface, mm.
    pub depth: f64,
    /// How deep at once, mm; `None`: all of `depth`.
    pub step: Option<f64>,
    /// How often around, each time farther out.
    pub passes: u32,
    /// How wide around copper all passes together cut, mm, in place of a number of passes.
    pub isolation_width: Option<f64>,
    /// Which part of the width passes overlap.
    pub overlap: f64,
    /// In which direction around.
    pub direction: Direction,
    /// What is done between nets where the tool is wider than the gap.
    pub narrow: Narrow,
    /// Where the cuts are.
    pub isolate: Isolate,
    /// Whether what is drawn is cut away, and all else of the board stays.
    pub invert: bool,
}

impl Default for Isolation {
    fn default() -> Isolation {
        Isolation {
            wider: Vec::new(),
            tool: None,
            vee: None,
            tip: 0.1,
            depth: 0.1,
            step: None,
            passes: 1,
            isolation_width: None,
            overlap: 0.25,
            direction: Direction::Climb,
            narrow: Narrow::Bite,
            isolate: Isolate::Contours,
            invert: false,
        }
    }
}

/// Where the cuts are that isolate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isolate {
    /// Around copper, as near as the tool allows.
    Contours,
    /// In the middle between nets: they keep all copper that is nearer to them than to others.
    Middle,
    /// Along the middle of the lines that copper is drawn with, whatever their width.
    Lines,
}

/// What else is cut of copper, mask and legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearing {
    /// Widths of end mills that take away all copper that is part of no net, the widest first, mm.
    pub clear: Vec<f64>,
    /// How far they stay from nets, mm.
    pub margin: f64,
    /// Width of the end mill that opens the solder mask over pads, mm.
    pub mask_tool: Option<f64>,
    /// Width of the tool that engraves the legend, mm.
    pub legend_tool: Option<f64>,
    /// How deep masks and legends are cut, mm.
    pub engrave: f64,
}

impl Default for Clearing {
    fn default() -> Clearing {
        Clearing {
            clear: Vec::new(),
            margin: 0.0,
            mask_tool: None,
            legend_tool: None,
            engrave: 0.05,
        }
    }
}

/// How holes are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Drilling {
    /// The drills that there are, mm; none: one for each width of holes.
    pub drills: Vec<f64>,
    /// By how much a drill may be wider or narrower than its hole, mm.
    pub drill_tolerance: f64,
    /// Width of the end mill for holes without a drill, for slots and routes, mm.
    pub hole_mill: Option<f64>,
    /// Holes so wide and wider are milled with `hole_mill` though there is a drill, mm.
    pub mill_holes_over: Option<f64>,
    /// How deep a drill goes at once, mm; `None`: through.
    pub peck: Option<f64>,
    /// From which side holes and edges are cut.
    pub from: Face,
}

impl Default for Drilling {
    fn default() -> Drilling {
        Drilling {
            drills: Vec::new(),
            drill_tolerance: 0.05,
            hole_mill: None,
            mill_holes_over: None,
            peck: None,
            from: Face::Front,
        }
    }
}

/// How the board is cut out.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Width of the end mill, mm.
    pub outline_tool: f64,
    /// How deep at once, mm.
    pub outline_step: f64,
    /// How many tabs hold the board.
    pub tabs: u32,
    /// Where tabs are put by hand, mm, as the program has it: each on the nearest contour, whose other tabs are left out.
    pub tab_at: Vec<Vec2>,
    /// How wide a tab is, mm.
    pub tab_width: f64,
    /// How high a tab is, mm.
    pub tab_height: f64,
    /// How wide a gap between lines of the edge may be that is closed, mm.
    pub close_gaps: f64,
    /// How far the board reaches beyond its copper and holes where no file has its edge, mm: it is a rectangle then. `None`: it
    /// has no edge.
    pub board_margin: Option<f64>,
    /// Whether the board is a rectangle around its edge, `board_margin` larger, whatever form that has; its cut-outs stay.
    pub rectangular: bool,
}

impl Default for Outline {
    fn default() -> Outline {
        Outline {
            outline_tool: 2.0,
            outline_step: 0.5,
            tabs: 4,
            tab_at: Vec::new(),
            tab_width: 2.0,
            tab_height: 0.6,
            close_gaps: 0.3,
            board_margin: None,
            rectangular: false,
        }
    }
}

/// Where the board lies on the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Placing {
    /// How thick the board is, mm.
    pub thickness: f64,
    /// How far drills and mills go through it, mm.
    pub through: f64,
    /// By how much the board is turned counter-clockwise before it is put there, degrees.
    pub rotate: f64,
    /// Where the lower left corner of the board is put, mm; `None`: at 0, 0.
    pub corner: Option<Vec2>,
    /// Whether the board stays where its files have it.
    pub as_drawn: bool,
    /// The line through its middle about which the board is turned over for its back.
    pub turn: Turn,
    /// Diameter of holes next to the board, drilled with the others, by which it is aligned when it is turned, mm.
    pub alignment: Option<f64>,
    /// Columns and rows of a panel of boards.
    pub panel: Option<[u32; 2]>,
    /// How far the boards of a panel are apart, mm.
    pub spacing: f64,
}

impl Default for Placing {
    fn default() -> Placing {
        Placing {
            thickness: 1.6,
            through: 0.2,
            rotate: 0.0,
            corner: None,
            as_drawn: false,
            turn: Turn::Y,
            alignment: None,
            panel: None,
            spacing: 4.0,
        }
    }
}

/// The line about which a board is turned over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Along Y: left and right change places.
    Y,
    /// Along X: up and down change places.
    X,
}

/// How the machine runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Running {
    /// Feed along copper, mm/min.
    pub feed: f64,
    /// Feed straight down into copper, mm/min.
    pub plunge: f64,
    /// Feed of drills, mm/min.
    pub drill_feed: f64,
    /// Feed of the end mill that cuts the board out, mm/min.
    pub outline_feed: f64,
    /// Speed of the spindle, 1/min; `None`: 10000, or what the machine has.
    pub speed: Option<f64>,
    /// How long each start of the spindle is waited for, s; `None`: as the machine's file says.
    pub spin_up: Option<f64>,
    /// What each program begins with behind the machine's own beginning, and ends with before its end: blocks of its control.
    pub text: [String; 2],
    /// Height of rapid moves over the board, mm.
    pub travel: f64,
    /// Height from which tools feed, mm.
    pub approach: f64,
    /// Columns and rows of the places at which the height of the board is measured.
    pub probe: Option<[u32; 2]>,
    /// Whether the programs that cut copper measure these heights themselves, with the tool that cuts, and follow them.
    pub on_control: bool,
    /// Whether each tool has a program of its own.
    pub split_tools: bool,
}

impl Default for Running {
    fn default() -> Running {
        Running {
            feed: 200.0,
            plunge: 60.0,
            drill_feed: 100.0,
            outline_feed: 150.0,
            speed: None,
            spin_up: None,
            text: [String::new(), String::new()],
            travel: 2.0,
            approach: 0.5,
            probe: None,
            on_control: false,
            split_tools: false,
        }
    }
}
