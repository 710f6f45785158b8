//! What a virtual control reports: the motion that it makes, in the words of its blocks.

use crate::arm::ArmAction;
use geom::Vec3;
use program::{
    Auxiliary, Axes, Compensation, Coolant, Cycle, Feed, Input, MachineMove, Output, PathMode,
    Probe, Rule, Spindle, Tool, WorkOffset, WorkOffsetData,
};

/// One thing that the control does, and the line (from 1) of the program that makes it do so.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Line of the program, from 1.
    pub line: u32,
    /// What the control does.
    pub action: Action,
}

/// An arc or helix from where the tool is. Where the start is not known, its centre may be NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcTo {
    /// Where it ends.
    pub end: Position,
    /// A point of the axis of the arc, in the frame of the position.
    pub center: Vec3,
    /// Unit vector about which the arc turns counter-clockwise.
    pub normal: Vec3,
    /// Full turns more than the shortest.
    pub turns: u32,
}

/// A thread from where the tool is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thread {
    /// Where it ends.
    pub end: Position,
    /// mm along the way for each turn of the spindle.
    pub pitch: f64,
}

/// What a control does. Modal words (feed, spindle, coolant, compensation, cycle) hold from their event on; every
/// position is absolute.
///
/// It is no [`program::Op`]: a position says what the block says, and a coordinate that nobody knows is NaN. `nc`
/// alone makes a neutral program of it, and the proof compares it with one.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Rapid to a position. The way there is the machine's own, only its end counts.
    Rapid(Position),
    /// Straight line to a position at the active feed.
    Line(Position),
    /// Arc or helix at the active feed.
    Arc(Box<ArcTo>),
    /// Straight line whose feed is tied to the turn of the spindle (`G33`).
    Thread(Box<Thread>),
    /// Straight line at the active feed that ends where the probe answers.
    Probe(Box<Probe<Position>>),
    /// The tool rests on what its probing move along Z has touched, and the work offset, or its length in the tool table, becomes
    /// such that its tip stands at this Z, mm: `G10 L20`, or `G10 L10`, behind `G38.2`.
    TouchOff(f64),
    /// One hole of the active [`Cycle`]; the position is the point of the cycle on the surface. The tool ends at
    /// the cycle's retract level.
    Hole(Position),
    /// Axes go to a fixed position of the machine. Where they stand afterwards only the machine knows.
    Home(Axes),
    /// Axes go by rapid to positions that count from the zero of the machine, for Z that of the gauge line of the
    /// spindle. A position is NaN where the block does not say that (an active tool length is part of it). Where
    /// they stand afterwards in the work, only the machine knows.
    MachineMove(Box<MachineMove>),
    /// The control turns the rotary axes to its tilted plane, by a solution that it chooses itself; the linear axes stand
    /// still. Where the tool then stands in the work, only the machine knows.
    Swivel(TiltChoice),
    /// By rapid in a tilted plane while nobody knows how high the tool is over it: to the line along the tool axis
    /// through this point.
    Across(Box<Position>),
    /// The hole cycle for the [`Action::Hole`]s that follow.
    Cycle(Box<Cycle>),
    /// End of the hole cycle.
    CycleOff,
    /// Feed from here on.
    Feed(Feed),
    /// Which axes the feed of a cut is the speed of, from here on.
    FeedPath(FeedPath),
    /// Whether the axes of a rapid go together, on a straight line, from here on; `None` is as the control is set up.
    RapidsTogether(Option<bool>),
    /// Spindle from here on.
    Spindle(Spindle),
    /// Constant surface speed from here on, m/min; `None` is the speed of the spindle itself again.
    SurfaceSpeed(Option<f64>),
    /// Coolant from here on.
    Coolant(Coolant),
    /// Change to this tool.
    Tool(Box<Tool>),
    /// Make this tool number ready; nothing is changed yet.
    Preselect(u32),
    /// Tool length offset from here on: its register, or none.
    LengthOffset(Option<u32>),
    /// Cutter radius compensation from here on.
    Compensation(Compensation),
    /// Work offset from here on. Positions are in its frame.
    WorkOffset(WorkOffset),
    /// What happens at corners from here on.
    PathMode(PathMode),
    /// An output of the machine is set.
    Output(Output),
    /// The program waits for an input of the machine, or reads it.
    Input(Box<Input>),
    /// A function that the builder of the machine has added.
    Auxiliary(Auxiliary),
    /// The wire is threaded (wire EDM).
    ThreadWire,
    /// The wire is cut.
    CutWire,
    /// The zero of a work offset is written into the table of the control.
    WorkOffsetData(Box<WorkOffsetData>),
    /// The control leans the wire from here on, degrees: to the left of its way where positive, to the right where
    /// negative, 0 for not at all.
    Taper(f64),
    /// Dwell, seconds.
    Dwell(f64),
    /// Unconditional stop.
    Stop,
    /// Stop when the operator has asked for it.
    OptionalStop,
    /// What the block does depends on something that the program does not say, or stays when the program has ended.
    Risk(Box<Risk>),
    /// What an arm does beyond what every machine does.
    Arm(ArmAction),
    /// Words for the reader of the program.
    Comment(Box<str>),
    /// Words for the operator's screen; none where what stood there is taken away.
    Message(Box<str>),
    /// End of the program.
    End,
}

/// By which rule a control takes one of the two solutions (positions of the rotary axes) for a tilted plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TiltChoice {
    /// FANUC `G53.1`: the one whose first rotary axis turns least, of those that are alike the one whose second does, then
    /// the one whose first and whose second stand nearest to 0°. On a machine with one axis in the head and one in the
    /// table the table counts first. Parameters 19608#5 (the second axis first) and 19741 to 19744 (within a range)
    /// change it.
    LeastTurn,
    /// HEIDENHAIN `PLANE` without `SEQ`: of those within the travel the one with the shorter way.
    ShorterWithin,
    /// HEIDENHAIN `SEQ+` (`true`), `SEQ-`: of those within the travel the one whose main rotary axis is positive, or
    /// negative; an error where there is none.
    Sequence(bool),
    /// HEIDENHAIN `SYM+`, `SYM-`: of those within the travel one, on a side of a point that the machine's builder has set.
    Symmetry,
    /// SINUMERIK `CYCLE800` with `_DIR` 1 (`true`) or -1: of those within the travel the one with the higher, or lower,
    /// position of the rotary axis that the swivel data set refers to.
    Higher(bool),
}

/// Along which way a control counts the feed of a straight cut. Where no rotary axis turns, that is the way of the tool tip
/// on every control, and so it is where the control keeps the tip (`G43.4`, `M128`), unless its feed group says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeedPath {
    /// X, Y, Z and the axes A, B, C of a feed group together, each degree as so many mm; an axis with 0 goes along
    /// (SINUMERIK `FGROUP`, `FGREF`). It counts so with tool-centre control too.
    Group([f64; 3]),
    /// All axes together, a degree as a mm.
    AllAxes,
    /// X, Y and Z, and the rotary axes arrive with them; where these stand still, the degrees of all rotary axes together.
    LinearAxes,
    /// A parameter of the control decides, and nobody has said how it stands.
    AsSetUp,
}

/// A way below this, mm, is none: far below any word, and what frames add to a position (LinuxCNC `emccanon.cc`, `tiny`).
const STILL: f64 = 1e-7;

impl FeedPath {
    /// Whether the number behind F is the speed of the tool tip in a straight cut between two positions: no rotary axis turns,
    /// or none whose degrees count while the control keeps the tip.
    #[inline]
    pub fn is_of_tip(&self, from: &Position, to: &Position) -> bool {
        match (from.orientation, to.orientation) {
            (
                Orientation::Rotary { degrees: a, .. },
                Orientation::Rotary { degrees: b, tool_center },
            ) => a == b || (tool_center && !self.counts_turns()),
            (a, b) => a == b || !self.counts_turns(),
        }
    }

    /// Whether degrees count also while the control keeps the tip.
    fn counts_turns(&self) -> bool {
        matches!(self, FeedPath::Group(weights) if *weights != [0.0; 3])
    }

    /// The length of the straight way between two positions, mm, by which the control divides the feed to find the time
    /// of a cut. `None` where nobody knows it: a parameter decides, or none of the axes that move is in the feed group.
    pub fn length(&self, from: &Position, to: &Position) -> Option<f64> {
        let linear = from.point.distance(to.point);
        let (turns, tool_center) = match (from.orientation, to.orientation) {
            (
                Orientation::Rotary { degrees: a, tool_center: s },
                Orientation::Rotary { degrees: b, tool_center: t },
            ) if s == t => ([0, 1, 2].map(|i| b[i] - a[i]), t),
            (Orientation::Axis(a), Orientation::Axis(b)) => {
                // How far a vector turns each axis, only the control knows.
                return (a == b || !self.counts_turns()).then_some(linear);
            }
            (Orientation::Rotary { .. } | Orientation::Axis(_), _) => return None,
        };
        let together = |weights: [f64; 3]| {
            let squares = [0, 1, 2].map(|i| (weights[i] * turns[i]).powi(2));
            (linear * linear + squares.iter().sum::<f64>()).sqrt()
        };
        match self {
            _ if turns == [0.0; 3] => Some(linear),
            FeedPath::Group(weights) => Some(together(*weights)).filter(|way| *way > STILL),
            _ if tool_center => Some(linear),
            FeedPath::AllAxes => Some(together([1.0; 3])),
            FeedPath::LinearAxes if linear > STILL => Some(linear),
            FeedPath::LinearAxes => Some(together([1.0; 3])),
            FeedPath::AsSetUp => None,
        }
    }
}

/// What may do harm although the motion is known: a state that depends on a setting of the control or on its operator, or
/// data that the program rewrites. In a source it is a warning; a program that is to be proven is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Risk {
    /// Its name, by which it may be accepted.
    pub rule: Rule,
    /// What may happen, after "the program".
    pub what: &'static str,
    /// The way out.
    pub help: &'static str,
    /// Whether a program that is to be proven is refused for it; otherwise it is a warning.
    pub refused: bool,
}

impl Risk {
    /// `#3003`, `#3004` of FANUC and Haas (B-64484EN-2, "Automatic operation control"): they hold until the control is
    /// reset. `M49`, `M50 P0`, `M51 P0`, `M53 P0` of LinuxCNC ("M Codes", "Override Control"), `M49` of the others, `G63` of
    /// FANUC ("Cutting feedrate control") and of SINUMERIK.
    pub(crate) const OPERATOR_CONTROLS: Risk = Risk {
        rule: Rule::OperatorControls,
        what: "takes single block, feed hold, an override or exact stop from the operator",
        help: "leave it out; where the operator knows of it, `--accept operator-controls` lets it pass",
        refused: true,
    };

    /// `G9`: an exact stop for one block.
    pub(crate) const EXACT_BLOCK: Risk = Risk {
        rule: Rule::PathMode,
        what: "stops exactly at the end of single blocks (G9), which is not carried over: the corner there is one like the others",
        help: "write G60 or G61 before such corners and G64 behind them where they have to be sharp",
        refused: false,
    };

    /// `LFON`, `POLF`, `POLFMASK` and their kin (SINUMERIK, "Rapid retraction"): ways that the axes take at a stop alone.
    pub(crate) const STOP_RETRACT: Risk = Risk {
        rule: Rule::StopRetract,
        what: "says where the axes go when it is stopped (LFON, POLF and the like), which is not followed",
        help: "nothing to do, if the machine may stop where it stands",
        refused: false,
    };

    /// `G60` of FANUC and Haas (B-64484EN-2, "Single direction positioning (G60)"): past the end by parameter 5440, and back.
    pub(crate) const ONE_SIDED: Risk = Risk {
        rule: Rule::RapidPath,
        what: "goes past the end of a rapid and comes back from one side (G60), as far as a parameter of the control says (5440 of FANUC)",
        help: "write G0 in the place of G60",
        refused: true,
    };

    /// `A0` in a program of which only the control is known.
    pub(crate) const ROTARY_AT_ZERO: Risk = Risk {
        rule: Rule::RotaryAtZero,
        what: "has rotary axes that stand at 0 throughout: it is read as that of a machine without them",
        help: "nothing to do, if they are not meant to turn; `--from` with the machine's file says what they do",
        refused: false,
    };

    /// `M30` without a line end behind it (SINUMERIK, found on an 828D): where the motion goes does not depend on it.
    pub(crate) const LINE_END: Risk = Risk {
        rule: Rule::LineEnd,
        what: "ends without a line end behind its last block, and a control (828D) may not take it as ended",
        help: "end the last line of the file by a line feed",
        refused: true,
    };

    /// `WALIMOF` of SINUMERIK (PM, "Working area limitation"): the limits that whoever set the machine up has entered hold
    /// no longer.
    pub(crate) const WORK_AREA_OFF: Risk = Risk {
        rule: Rule::OperatorControls,
        what: "switches off the limits of the work area, which protect what the operator has set up",
        help: "leave WALIMOF out; where the operator knows of it, `--accept operator-controls` lets it pass",
        refused: true,
    };

    /// `M107` and `M141` of HEIDENHAIN (iTNC 530, "Miscellaneous functions"): the control no longer stops for a replacement
    /// tool with a positive delta value, nor for a touch probe that touches.
    pub(crate) const MONITORING_OFF: Risk = Risk {
        rule: Rule::OperatorControls,
        what: "switches off a check at which the control stops: oversize of replacement tools (M107), the touch probe (M141)",
        help: "leave it out; where the operator knows of it, `--accept operator-controls` lets it pass",
        refused: true,
    };

    /// `M101` of HEIDENHAIN (iTNC 530, "Automatic tool change if the tool life expires").
    pub(crate) const REPLACEMENT_TOOL: Risk = Risk {
        rule: Rule::ReplacementTool,
        what: "changes a tool whose life is over for its replacement by itself (M101): between which blocks, and by which way, the \
               program does not say",
        help: "leave M101 out, or write M102 before the cut",
        refused: true,
    };

    /// `_TC` of CYCLE800 (PM p. 678): the swivel data set is the kinematics by which the plane is reached.
    pub(crate) const SWIVEL_DATA: Risk = Risk {
        rule: Rule::SwivelData,
        what: "swivels by another swivel data set than the machine file names: another kinematics",
        help: "name the data set of this machine in `swivel_data` in [options] of the machine file, and in _TC",
        refused: true,
    };

    /// `M52` of LinuxCNC ("M Codes", "Adaptive Feed Control"): F times the value of a pin.
    pub(crate) const ADAPTIVE_FEED: Risk = Risk {
        rule: Rule::AdaptiveFeed,
        what: "has an input of the machine multiply the feed (M52), so that F is not the speed of the cut",
        help: "write M52 P0, or leave it out",
        refused: true,
    };

    /// `ACC`, `ACCLIMA`, `JERKLIMA`, `VELOLIMA` of SINUMERIK above 100 percent (PM, "Percentage acceleration override"): more
    /// than the machine data let the axis do.
    pub(crate) const AXIS_DYNAMICS: Risk = Risk {
        rule: Rule::AxisDynamics,
        what: "lets an axis accelerate, jerk or go faster than the machine data allow it: more than 100 percent",
        help: "write at most 100 percent, as in ACC[X]=100",
        refused: true,
    };

    /// `M41` to `M45` of SINUMERIK (PM 2.13): a gear stage holds the spindle within the speeds of the stage (S1, "Minimum /
    /// maximum speed of the gear stage").
    pub(crate) const GEAR: Risk = Risk {
        rule: Rule::Gear,
        what: "chooses a gear of the spindle (M41 to M45): in which gear the speeds of the program are reached it does not say",
        help: "leave it out or write M40; a machine with gears lists the number in `auxiliary`",
        refused: true,
    };

    /// P of a dwell counts least increments of time on a FANUC: a millisecond, and a tenth of one with increment system C
    /// and parameter 1015#7 = 0.
    pub(crate) const DWELL_UNIT: Risk = Risk {
        rule: Rule::DwellUnit,
        what: "dwells by P, which counts milliseconds or tenths of them, as parameters 1013 and 1015#7 say",
        help: "write G4 X with a decimal point, or say `dwell_p_milliseconds` in [settings] of the machine file",
        refused: true,
    };

    /// Mach3 General Config, "G04 Dwell param in Milliseconds".
    pub(crate) const DWELL_AS_SET_UP: Risk = Risk {
        rule: Rule::DwellUnit,
        what: "dwells by P, which counts seconds or milliseconds, as General Config says (\"G04 Dwell param in Milliseconds\")",
        help: "say `dwell_p_milliseconds` in [settings] of the machine file: false where that is not ticked, true where it is",
        refused: true,
    };

    /// FANUC parameter 3405#1: under `G95` a dwell counts seconds or turns of the spindle.
    pub(crate) const DWELL_TURNS: Risk = Risk {
        rule: Rule::DwellUnit,
        what: "dwells under G95: seconds, or turns of the spindle, as parameter 3405#1 says",
        help: "write G94 before the dwell",
        refused: true,
    };

    /// `M99` of a program that nobody has called (B-64484EN-2, "Subprogram"; Haas, M99).
    pub(crate) const PROGRAM_REPEATS: Risk = Risk {
        rule: Rule::ProgramRepeats,
        what: "ends with M99, by which the control begins it again without end",
        help: "write M30 where it shall run once; where it is to run again and again, `--accept program-repeats` lets it pass",
        refused: true,
    };

    /// LinuxCNC `M61` ("Set Current Tool"): the spindle keeps the tool that it has.
    pub(crate) const TOOL_DECLARED: Risk = Risk {
        rule: Rule::OperatorData,
        what: "tells the control which tool is in the spindle, and changes none",
        help: "call the tool by T and M6; where the operator puts it in before, `--accept operator-data` lets it pass",
        refused: true,
    };

    /// B-64484EN-2, "Inch/metric conversion": `G20`, `G21` stand in a block of their own.
    pub(crate) const UNIT_BLOCK: Risk = Risk {
        rule: Rule::UnitBlock,
        what: "says G20 or G21 in a block with other words, which the manual does not allow",
        help: "write it in a block of its own at the start of the program",
        refused: false,
    };

    /// `G7` of LinuxCNC ("G7 Lathe Diameter Mode"), `DIAMON` and `DIAM90` of SINUMERIK (PM, "Channel-specific diameter/radius
    /// programming").
    pub(crate) const DIAMETERS: Risk = Risk {
        rule: Rule::DiameterMode,
        what: "counts X as a diameter from here on, as lathes do (G7, DIAMON, DIAM90): X10 goes to 5",
        help: "leave the word out, and write X as the place where the axis goes",
        refused: true,
    };

    /// A stop behind which somebody opens the door, reaches in or jogs, while the spindle turns or coolant runs. That the
    /// control stops both is sure on Haas alone (*Mill Operator's Manual*, M00); on a HEIDENHAIN `M0` stops the spindle.
    pub(crate) const STOP_RUNNING: Risk = Risk {
        rule: Rule::StopRunning,
        what: "stops and waits for somebody while the spindle turns or coolant runs: this control need not stop them",
        help: "write M5 and M9 before it, with the tool out of the cut; where the machine's builder has M0 and M1 stop both, \
               `--accept stop-running` lets it pass",
        refused: true,
    };

    /// `M6` stops the spindle, which turns to its place for the change; of the coolant LinuxCNC ("M6") and RS274/NGC 3.6 say
    /// that it runs on, and on the others the machine's builder decides.
    pub(crate) const CHANGE_RUNNING: Risk = Risk {
        rule: Rule::StopRunning,
        what: "changes the tool while coolant runs: this control need not stop it",
        help: "write M9 before it; where the machine's builder has M6 stop it, `--accept stop-running` lets it pass",
        refused: true,
    };

    /// `G84` and `G74` that do not couple feed and spindle: LinuxCNC ("Canned Cycles": for a floating chuck), Mach3, and
    /// FANUC without `M29` (parameter 5200#0).
    pub(crate) const FLOATING_TAP: Risk = Risk {
        rule: Rule::FloatingTap,
        what: "taps without coupling feed and spindle: a tap that is held fast breaks",
        help: "tap by G33.1 (LinuxCNC) or behind M29 (FANUC); or say `floating_holder = true` in [settings] of the machine file",
        refused: true,
    };

    /// FANUC moves Z by a length that begins, ends or changes, or it moves the coordinates: parameter 5006, bit 6
    /// (B-64484EN-2, "Tool length compensation"; B-63943EN-1 p. 1654).
    pub(crate) const LENGTH_CHANGE: Risk = Risk {
        rule: Rule::LengthChange,
        what: "changes the tool length offset in a block that does not say Z: whether Z moves by it, parameter 5006#6 says",
        help: "say Z in the block of G43 or G43.4 (`G43 Z50. H1`); before G49 send Z home (`G91 G28 Z0`); where 5006#6 is 1, say \
               `length_moves_axis = false` in [settings] of the machine file",
        refused: true,
    };

    /// G28, G30 and G53 take the length away at their end, and G43 stays on (B-63844EN p. 204, "G53, G28, and G30 commands in
    /// tool length offset mode").
    pub(crate) const LENGTH_SUSPENDED: Risk = Risk {
        rule: Rule::LengthChange,
        what: "moves Z behind G28, G30 or G53 without G43 and H: whether the tool length counts again, parameter 5001#6 says",
        help: "write G43 and H in the block that moves Z",
        refused: true,
    };

    /// Which edge, and so which length and radius, counts behind `M6` where no `D` stands in its block or behind it: none, one that
    /// MD20270 names, the number of the tool before, or its data until the next `D` (W1, "Selection of the cutting edge when
    /// changing tool").
    pub(crate) const EDGE_AS_SET_UP: Risk = Risk {
        rule: Rule::ToolEdge,
        what: "moves a tool behind M6 without a D for it: which edge counts, and so its length, MD20270 says; a D before M6 is for the \
               tool before",
        help: "write D1 in the block of M6 or behind it; or say `edge_at_change` in [settings] of the machine file (MD20270)",
        refused: true,
    };

    /// What holds of these modes before a program says them is data of the machine, which its builder, its integrator or its operator
    /// has set up (`docs/controls/start.md`).
    const fn start_mode(what: &'static str, help: &'static str) -> Risk {
        Risk { rule: Rule::StartMode, what, help, refused: true }
    }

    /// FANUC 3402#1, #2; SINUMERIK MD20150; LinuxCNC RS274NGC_STARTUP_CODE; GRBL $N; Mach3 General Config. Haas with setting 56 off and
    /// Marlin go on in what was run before.
    pub(crate) const START_PLANE: Risk = Risk::start_mode(
        "has an arc, a hole, compensation or coordinates that count in a plane, and has not said in which: in which the control starts is \
         set up at the machine, or left by what was run before",
        "write G17 at the start; or state it in `start_modes` in [settings] of the machine file",
    );

    /// The plane at the start, and the axis of a length ([`Risk::LENGTH_PLANE`]).
    pub(crate) const START_LENGTH_PLANE: Risk = Risk::start_mode(
        "uses a tool length and has not said in which plane: along which axis a length counts, the plane may say (SD42940, 5001), and in \
         which the control starts is set up at the machine",
        "write G17 before the tool length; or state G17 in `start_modes`, or `length_along_z = true`, in [settings] of the machine file",
    );

    /// FANUC 3402#3, and the others as the plane.
    pub(crate) const START_DISTANCE: Risk = Risk::start_mode(
        "moves and has not said whether its positions are absolute: how the control starts is set up at the machine, or left by what was run \
         before",
        "write G90 at the start; or state it in `start_modes` in [settings] of the machine file",
    );

    /// FANUC 3402#4, and the others as the plane.
    pub(crate) const START_FEED: Risk = Risk::start_mode(
        "cuts and has not said what F counts: how the control starts is set up at the machine, or left by what was run before",
        "write G94 at the start; or state it in `start_modes` in [settings] of the machine file",
    );

    /// FANUC with 3402#6, Haas with setting 56 off.
    pub(crate) const START_RETURN: Risk = Risk::start_mode(
        "has a cycle and has not said whether it goes back to the initial level or to R: what was run before may have left either",
        "write G98 or G99 with the cycle; or state G98 in `start_modes` in [settings] of the machine file",
    );

    /// Mach3 General Config, "IJ Mode"; LinuxCNC RS274NGC_STARTUP_CODE, and `G90.1` of a program before.
    pub(crate) const START_CENTERS: Risk = Risk::start_mode(
        "has an arc by I, J or K and has not said whether these count from its start or are places: the operator has set that up",
        "write G91.1 at the start; or state it in `start_modes` in [settings] of the machine file",
    );

    /// FANUC 3402#6 and 1202#3, Haas setting 56, Mach3's page "Logic": the program before. LinuxCNC: parameter 5220 of its file, so what
    /// the operator has chosen last by MDI, and RS274NGC_STARTUP_CODE; GRBL: MDI and $N.
    pub(crate) const START_OFFSET: Risk = Risk {
        rule: Rule::WorkOffset,
        what: "moves to a place of the work and has named no work offset: that of the program before or of the operator may be active",
        help: "write G54, or the offset of the job, before the first move; or state G54 in `start_modes` in [settings] of the machine file",
        refused: true,
    };

    /// Marlin 2 up to 2.1.2 (`gcode.cpp`: no offset after power on; `motion.cpp`, `set_axis_is_at_home`; `G53-G59.cpp`,
    /// `select_coordinate_system`).
    pub(crate) const MACHINE_ZERO: Risk = Risk {
        rule: Rule::WorkOffset,
        what: "moves an axis that may count from the zero of the machine: no work offset is active after power on, G28 takes it away, at the \
               start too, and G54 said again does not bring it back",
        help: "write G54 (or the offset of the job) and a move by G53 before the axis moves: at the start and behind each G28",
        refused: true,
    };

    /// SINUMERIK MD20150, G group 13, and MD10240.
    pub(crate) const START_UNITS: Risk = Risk::start_mode(
        "moves and has not said in which unit: how the control starts is set up at the machine",
        "write G710 (or G71) at the start; or state G71 in `start_modes` in [settings] of the machine file",
    );

    /// A tool length counts along the axis that stands on the plane, or along Z always (SINUMERIK SD42940, "Tool offsets";
    /// FANUC parameter 5001, tool length types A and B).
    pub(crate) const LENGTH_PLANE: Risk = Risk {
        rule: Rule::LengthPlane,
        what: "uses a tool length in G18 or G19: whether it counts along Z there, a parameter says (SD42940, 5001)",
        help: "write G17, or say `length_along_z = true` in [settings] of the machine file where it does",
        refused: true,
    };

    /// Where `G30` goes, and `G28` of LinuxCNC and GRBL, parameters or the operator have set, and Marlin's `G28` goes to
    /// a switch, which may be at the bed.
    pub(crate) const STORED_POSITION: Risk = Risk {
        rule: Rule::StoredPosition,
        what: "sends Z to a position that only the machine knows: one that is stored, or a switch",
        help: "retract by G53 to the safe height of the machine, or by the G28 of a control whose G28 is the reference position",
        refused: true,
    };

    /// `G642` to `G645` and the compressors of SINUMERIK keep to tolerances of machine data (MD33100, MD33120), unless CTOL or
    /// CYCLE832 says another; G644 never takes that of CTOL (B1, "Contour/Orientation tolerance").
    pub(crate) const SMOOTHING: Risk = Risk {
        rule: Rule::PathTolerance,
        what: "lets the control leave the path by as much as its machine data say",
        help: "write G64 (G64 in place of G644 in any case), or say how far by CTOL= or CYCLE832 before the first move",
        refused: true,
    };

    /// Turns over the part whose way the program does not say ([`modulo`](crate::kernel::modulo)).
    pub(crate) const ROTARY_WAY: Risk = Risk {
        rule: Rule::RotaryWay,
        what: "turns a rotary axis, and which way depends on whether the control counts it modulo 360°",
        help: "say `modulo` of the axis in the machine file, or write M126 (HEIDENHAIN), DC() (SINUMERIK)",
        refused: true,
    };

    /// Where X, Y and Z count under `G43.4` that comes with a turned table: in the frame of the part with the table at 0, or
    /// in the work offset as it lies over the turned table (A-79348E p. 19, parameter 19696#5).
    pub(crate) const TABLE_FRAME: Risk = Risk {
        rule: Rule::TableFrame,
        what: "switches G43.4 on with a turned table, and in which frame X, Y and Z count then the machine file does not say",
        help: "turn the table to 0 before G43.4; or try a place away from the centre of the table on the machine, and write \
               `table_frame_at_zero = true` below [settings] where it is that of the part",
        refused: true,
    };

    /// How the tool turns within a block while the control keeps its tip: about the shortest way between its ends (`ORIVECT`,
    /// `ORIWKS`; `PATHCTRL VECTOR`), or as its axes turn evenly (`ORIAXES`, `ORIMKS`; `M128`, `PATHCTRL AXIS`). Which of the two
    /// G groups says it on a SINUMERIK, MD21104 decides.
    pub(crate) const ORIENTATION_WAY: Risk = Risk {
        rule: Rule::OrientationWay,
        what: "turns the tool while the control keeps its tip, and does not say that it turns the way that its words need",
        help: "SINUMERIK: ORIWKS and ORIVECT where the tool turns by vectors, ORIMKS and ORIAXES where it turns by positions of axes: with \
               both it is so whatever MD21104 is; HEIDENHAIN: PATHCTRL VECTOR with vectors, M128 or PATHCTRL AXIS with positions",
        refused: true,
    };

    /// `TA` of cycle 32 (HEIDENHAIN), `CYCLE832` with `_ORI_...` and `OTOL` (SINUMERIK), `OSC` to `OST` and `ORISON`, which go by
    /// setting data: by how much the control may turn the tool out
    /// of the orientation of the program.
    pub(crate) const ORIENTATION_TOLERANCE: Risk = Risk {
        rule: Rule::OrientationTolerance,
        what: "lets the control turn the tool out of its orientation by more than the machine file allows",
        help: "say how far in `orientation_tolerance` in [options] of the machine file (degrees), or write no more than that",
        refused: true,
    };

    /// `M140 MB MAX` (HEIDENHAIN) and `CYCLE800` with `_FR` 4 or 5 (SINUMERIK) go back along the tool, by as much as the travels or a
    /// word say. Where the tool leans in a head, Z is not home behind it.
    pub(crate) const LEANING_RETRACT: Risk = Risk {
        rule: Rule::LeaningRetract,
        what: "goes back along a tool that may lean in its head: how far the axes then are from their ends the program does not say",
        help: "send Z home in machine coordinates behind it (`L Z+0 R0 FMAX M91`, `SUPA Z0 D0`; CYCLE800 with _FR 0 or 1)",
        refused: true,
    };

    /// Haas setting 52 ("G83 Retract Above R"): chips are cleared that far above the R plane.
    pub(crate) const PECK_RETRACT: Risk = Risk {
        rule: Rule::PeckRetract,
        what: "clears chips above the R plane of G83, and how far setting 52 says, which the machine file does not state",
        help: "say `retract_above_r` in mm below [settings] (setting 52 of the control; 0 as it is delivered)",
        refused: false,
    };

    /// `G5.1 Q1` and `G5 P10000` are for contours; with cycles, a tool change, `G43.4` and `G68.2` the control may give an
    /// alarm, and what it does at the end is a parameter.
    pub(crate) const LOOK_AHEAD: Risk = Risk {
        rule: Rule::LookAhead,
        what: "has look-ahead on at a cycle, a tool change, G43.4, a tilted plane or the end, where not every control takes that",
        help: "write G5.1 Q0 (G5 P0) in a block of its own before it",
        refused: true,
    };

    /// SST1 of CYCLE84 (PGZ, "CYCLE84": 0 is as SST), Q403 of cycle 209: the speed of the spindle on the way out of a thread.
    pub(crate) const TAP_RETURN: Risk = Risk {
        rule: Rule::Spindle,
        what: "comes out of a thread at another speed than it goes in (SST1 of CYCLE84, Q403 of cycle 209)",
        help: "leave SST1 out or write that of SST; Q403=+1",
        refused: true,
    };

    /// SDAC of CYCLE84 (PGZ): what the spindle does behind the cycle.
    pub(crate) const TURNS_BACK: Risk = Risk {
        rule: Rule::Spindle,
        what: "leaves the spindle turning against the tool behind a thread (SDAC of CYCLE84)",
        help: "write SDAC as the spindle turns before the cycle: 3 for M3, 4 for M4; or 5, which stops it",
        refused: true,
    };

    /// DTS of CYCLE83 (PGZ: with VARI 1, seconds or, below 0, turns), and DTB with a `_DTD` that differs: dwells that the
    /// source does not have.
    pub(crate) const PECK_DWELL: Risk = Risk {
        rule: Rule::Dwell,
        what: "dwells between the pecks of CYCLE83 (DTS, or DTB with another _DTD)",
        help: "write DTS as 0, and leave _DTD out",
        refused: true,
    };

    /// Q258, Q259 of cycle 205, Q200 of 200 and 203 (TNC 640 cycles): how far above the last depth the rapid back into the hole
    /// ends.
    pub(crate) const RAPID_TO_DEPTH: Risk = Risk {
        rule: Rule::Peck,
        what: "goes back into the hole by rapid down to the last depth itself: what keeps it above is 0 (Q258, Q259 of cycle 205; Q200 \
               of cycles 200 and 203)",
        help: "write more than 0, as in Q258=+0.5 and Q259=+0.5",
        refused: true,
    };

    /// `MOVE` of `PLANE` (TNC 620 10/2017 p. 556: "tilts the tool (or table) relative to the tool tip").
    pub(crate) const PLANE_MOVE: Risk = Risk {
        rule: Rule::TurnHeight,
        what: "turns rotary axes by PLANE ... MOVE, by which X, Y and Z go along with the tool tip: Z is home no longer",
        help: "write TURN, with Z home before it, or STAY",
        refused: true,
    };

    /// `CFTCP`, `CFIN` of SINUMERIK with a compensated contour (Fundamentals, "Feed optimization on curved path sections").
    pub(crate) const FEED_OF_CENTRE: Risk = Risk {
        rule: Rule::Feed,
        what: "has F count at the centre of the compensated tool (CFTCP, CFIN): on arcs its edge goes at another feed",
        help: "write CFC before G41 or G42",
        refused: true,
    };

    /// `G53` of SINUMERIK (Fundamentals 11/2006, p. 100): it suppresses the settable and the programmable offset; `G153` the total basic
    /// frame too, `SUPA` all.
    pub(crate) const BASIC_FRAME: Risk = Risk {
        rule: Rule::MachinePosition,
        what: "moves by G53, which leaves basic frames in (a zero set in JOG, a pallet, a swivelled table): where that is in the machine is \
               not known",
        help: "write SUPA, or G153, which suppress the basic frames too",
        refused: true,
    };

    /// `G25`, `G26` of SINUMERIK (PM, "Working area limitation", "Programmable spindle speed limitation"): SD43420, SD43430,
    /// SD43210, SD43220 keep them.
    pub(crate) const LIMITS_WRITTEN: Risk = Risk {
        rule: Rule::OperatorData,
        what: "rewrites the limits of the work area or of the spindle (G25, G26), and they stay so when it has ended",
        help: "leave them to the operator; for one run `--accept operator-data` lets it pass",
        refused: true,
    };

    /// R parameters in `operator_parameters` of the machine file: what the operator has entered there shifts a rotary axis.
    pub(crate) const OPERATOR_PARAMETER: Risk = Risk {
        rule: Rule::OperatorData,
        what: "sets a parameter that the operator sets at the machine (`operator_parameters`), and it stays so when it has ended",
        help: "leave it to the operator, or calculate with another parameter",
        refused: true,
    };

    /// `#500` to `#999` of FANUC and Haas, QR of HEIDENHAIN: they stay when the power is switched off, and macros of the shop
    /// and of probes keep their data there.
    pub(crate) const KEPT_VARIABLE: Risk = Risk {
        rule: Rule::OperatorData,
        what: "sets a variable that is kept when it has ended and the power is off, where macros of the shop keep their data",
        help: "use #100 to #149 (FANUC, Haas), Q0 to Q99 (HEIDENHAIN); for one run `--accept operator-data` lets it pass",
        refused: true,
    };

    /// A state that the control keeps, or may keep, when the program has ended, and that each program takes as off at its start
    /// (`docs/proof.md`, "What a program finds, and what it leaves"). `what` begins with "ends".
    pub(crate) const fn left_on(what: &'static str, help: &'static str) -> Risk {
        Risk { rule: Rule::LeftOn, what, help, refused: true }
    }

    /// `SetDO` and `SetAO` of RAPID with a name of the controller's configuration.
    pub(crate) const OPERATOR_SIGNAL: Risk = Risk {
        rule: Rule::OperatorData,
        what: "names a signal whose number the machine file does not say",
        help: "`address` of [words.SIGNAL] and [words.CHANNEL] is what names of signals begin with, their number follows",
        refused: true,
    };

    /// Work offsets, tool lengths and radii belong to the operator, who has measured them.
    pub(crate) const OPERATOR_DATA: Risk = Risk {
        rule: Rule::OperatorData,
        what: "rewrites work offsets, stored positions or tool data of the operator, and they stay so when it has ended",
        help: "leave them to the operator; for one run `--accept operator-data` lets it pass, and a machine whose shop sets its fixtures by G10 L2 says `sets_work_offsets` in [settings]",
        refused: true,
    };
}

/// What a block says of where the tool goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Tool tip, or position of the linear axes ([`Orientation`]), mm. A coordinate that no block has set yet, or
    /// that an [`Action::Home`] or an [`Action::MachineMove`] has made unknown, is NaN.
    pub point: Vec3,
    /// Where the tool points.
    pub orientation: Orientation,
}

/// How a block says where the tool points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// Unit vector from the tool tip towards the spindle, in the work frame; the point is the tip in the work
    /// frame, too.
    Axis(Vec3),
    /// Positions of the rotary axes in degrees, in the order A, B, C (those the machine lacks are 0). With
    /// `tool_center` the control keeps the tip where the block says, in the work frame (`TRAORI`, `G43.4`,
    /// `M128`); without, the point is the linear axes' position and the tip follows from the machine's kinematics.
    Rotary {
        /// Degrees of A, B, C.
        degrees: [f64; 3],
        /// Whether the control does the tool-center-point transformation.
        tool_center: bool,
    },
}

impl Position {
    /// The tip at `point`, mm, in the work frame, with the tool along the unit vector `axis`.
    pub fn new(point: Vec3, axis: Vec3) -> Position {
        Position { point, orientation: Orientation::Axis(axis) }
    }

    /// The tool axis in the work frame, where the block says it.
    pub fn axis(&self) -> Option<Vec3> {
        match self.orientation {
            Orientation::Axis(axis) => Some(axis),
            Orientation::Rotary { .. } => None,
        }
    }
}

impl Action {
    /// Where the tool is after it, where it moves the tool to a position.
    #[inline]
    pub fn position(&self) -> Option<&Position> {
        match self {
            Action::Rapid(position) | Action::Line(position) | Action::Hole(position) => {
                Some(position)
            }
            Action::Arc(arc) => Some(&arc.end),
            Action::Thread(thread) => Some(&thread.end),
            Action::Probe(_)
            | Action::TouchOff(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Swivel(_)
            | Action::Across(_)
            | Action::Cycle(_)
            | Action::CycleOff
            | Action::Feed(_)
            | Action::FeedPath(_)
            | Action::RapidsTogether(_)
            | Action::Spindle(_)
            | Action::SurfaceSpeed(_)
            | Action::Coolant(_)
            | Action::Tool(_)
            | Action::Preselect(_)
            | Action::LengthOffset(_)
            | Action::Compensation(_)
            | Action::WorkOffset(_)
            | Action::WorkOffsetData(_)
            | Action::PathMode(_)
            | Action::Output(_)
            | Action::Input(_)
            | Action::Auxiliary(_)
            | Action::ThreadWire
            | Action::CutWire
            | Action::Taper(_)
            | Action::Dwell(_)
            | Action::Stop
            | Action::OptionalStop
            | Action::Risk(_)
            | Action::Arm(_)
            | Action::Comment(_)
            | Action::Message(_)
            | Action::End => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each event is copied some times on its way to the proof, and thousands wait on the way.
    #[test]
    fn an_event_takes_at_most_72_bytes() {
        assert!(size_of::<Event>() <= 72, "{}", size_of::<Event>());
    }
}
