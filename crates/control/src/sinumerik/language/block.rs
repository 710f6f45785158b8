//! A block: its words, before anything is done.

use super::call::Call;
use super::commands::{self, Code, GROUPS};
use super::statement::Statement;
use super::value::Value;
use super::variables::AssignmentTarget;

/// How a coordinate counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Count {
    /// As `G90` or `G91` says.
    Modal,
    /// `AC()`.
    Absolute,
    /// `IC()`.
    Incremental,
    /// `DC()`: rotary axis, the shorter way.
    Shorter,
    /// `ACP()`: rotary axis, in the positive direction.
    Positive,
    /// `ACN()`: rotary axis, in the negative direction.
    Negative,
}

/// A coordinate as it is programmed, in units of the program or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coordinate {
    /// How it counts.
    pub count: Count,
    /// Its value, without what the operator adds.
    pub value: f64,
    /// The R parameter with which the operator shifts it.
    pub offset: Option<usize>,
}

/// A tool as it is called.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ToolCall {
    /// By number.
    Number(u32),
    /// By name.
    Name(String),
}

/// What is put between a block and the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Corner {
    /// `CHF=`: a chamfer of that length.
    Chamfer(f64),
    /// `CHR=`: a chamfer that begins that far before the corner.
    ChamferSide(f64),
    /// `RND=`: an arc of that radius.
    Round(f64),
}

/// The addresses of tolerances of the path: of a contour, of corners, of corners between rapids.
pub(crate) const TOLERANCES: [&str; 3] = ["CTOL", "ADIS", "ADISPOS"];

/// The words that few blocks have.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rare {
    /// It says where axes go when the program is stopped.
    pub retracts: bool,
    /// AP, degrees.
    pub polar_angle: Option<Coordinate>,
    /// RP.
    pub polar_radius: Option<Coordinate>,
    /// ANG, degrees.
    pub angle: Option<f64>,
    /// CHF, CHR, RND.
    pub corner: Option<Corner>,
    /// DISC.
    pub peak: Option<f64>,
    /// RNDM.
    pub modal_round: Option<f64>,
    /// FRC.
    pub corner_feed: Option<f64>,
    /// FRCM.
    pub modal_corner_feed: Option<f64>,
    /// SPOS, degrees.
    pub spindle_position: Option<f64>,
    /// POS of X Y Z A B C.
    pub positioned: [Option<Coordinate>; 6],
    /// FGREF of A B C, in the units of the program.
    pub feed_reference: [Option<f64>; 3],
    /// CTOL, ADIS, ADISPOS.
    pub tolerances: [Option<f64>; 3],
    /// ACC and its kin above 100 percent.
    pub is_dynamic: bool,
}

/// Most M functions in a block (Programming Manual 06/2019, 2.13).
pub(super) const MOST_M: usize = 5;

/// The words of a block.
pub(crate) struct Block {
    /// X Y Z A B C.
    pub axes: [Option<Coordinate>; 6],
    /// Machine axes X1 Y1 Z1 A1 B1 C1 of `G74` and `G75`: named or not.
    pub machine_axes: [bool; 6],
    /// I J K.
    pub center: [Option<Coordinate>; 3],
    /// I1 J1 K1.
    pub through: [Option<Coordinate>; 3],
    /// A3 B3 C3.
    pub vector: [Option<f64>; 3],
    /// CR.
    pub radius: Option<f64>,
    /// AR, degrees.
    pub opening: Option<f64>,
    /// TURN.
    pub turns: Option<f64>,
    /// RPL, degrees.
    pub rotation: Option<f64>,
    /// FP.
    pub fixed_point: Option<f64>,
    /// F.
    pub feed: Option<f64>,
    /// S.
    pub speed: Option<f64>,
    /// T.
    pub tool: Option<ToolCall>,
    /// D.
    pub edge: Option<u32>,
    /// M functions.
    pub m: [Option<u32>; MOST_M],
    /// `OTOL=`, degrees.
    pub orientation_tolerance: Option<f64>,
    /// The words that few blocks have.
    pub rare: Option<Box<Rare>>,
    /// Assignments to R parameters and variables.
    pub assigned: Vec<(AssignmentTarget, Value)>,
    /// A call; it stands alone.
    pub call: Option<Call>,
    /// A statement; it stands alone.
    pub statement: Option<Box<Statement>>,
    /// `MSG`.
    pub message: Option<String>,
    /// Comment.
    pub comment: Option<String>,
    /// Whether there is any word.
    pub any: bool,
    /// Command of each group that the block has one of: its index plus one.
    pub groups: [u8; GROUPS],
    /// Number of a settable offset beyond `G57`.
    pub further_offset: Option<u32>,
}

impl Block {
    /// What the block's command of `group` does, if it has one.
    #[inline]
    pub fn code(&self, group: u8) -> Option<Code> {
        match self.further_offset {
            Some(number) if group == 8 => Some(Code::WorkOffset(number)),
            _ => self.groups[usize::from(group)].checked_sub(1).map(|i| commands::at(i).code),
        }
    }

    /// The name of the block's command of `group`.
    pub fn command(&self, group: u8) -> &'static str {
        self.groups[usize::from(group)].checked_sub(1).map_or("", |i| commands::at(i).name)
    }

    /// Whether it has M function `number`.
    pub fn has_m(&self, number: u32) -> bool {
        self.m.contains(&Some(number))
    }

    /// Whether it names a linear axis.
    pub fn has_linear(&self) -> bool {
        self.axes[..3].iter().any(Option::is_some)
    }

    /// Whether it names a rotary axis.
    pub fn has_rotary(&self) -> bool {
        self.axes[3..].iter().any(Option::is_some)
    }

    /// Whether it gives a tool axis as a vector.
    pub fn has_vector(&self) -> bool {
        self.vector.iter().any(Option::is_some)
    }

    /// Whether it gives a polar position.
    #[inline]
    pub fn has_polar(&self) -> bool {
        self.rare.as_ref().is_some_and(|r| r.polar_angle.is_some() || r.polar_radius.is_some())
    }

    /// Whether it gives a position or an orientation.
    pub fn has_position(&self) -> bool {
        self.axes.iter().any(Option::is_some) || self.has_vector() || self.has_polar()
    }

    /// Whether it gives something of an arc.
    pub fn has_arc_word(&self) -> bool {
        self.center.iter().chain(&self.through).any(Option::is_some)
            || self.radius.is_some()
            || self.opening.is_some()
            || self.turns.is_some()
    }

    /// Whether the blocks behind it may count in another frame, or with another tool axis.
    pub fn changes_frame(&self) -> bool {
        self.call.is_some()
            || self.has_rotary()
            || self.has_vector()
            || self.code(2) == Some(Code::Home)
            || [3, 8, 9].into_iter().any(|group| self.code(group).is_some())
    }

    /// Whether it has nothing but a command of `group` and perhaps a block number.
    pub fn only_group(&self, group: u8) -> bool {
        let others =
            self.groups.iter().enumerate().any(|(g, c)| *c != 0 && g != usize::from(group));
        !others
            && self.further_offset.is_none()
            && self.m.iter().all(Option::is_none)
            && self.tool.is_none()
            && self.edge.is_none()
            && self.rare.is_none()
            && self.assigned.is_empty()
            && !self.has_vector()
            && !self.has_arc_word()
    }

    /// No words.
    pub fn empty() -> Block {
        Block {
            axes: [None; 6],
            machine_axes: [false; 6],
            center: [None; 3],
            through: [None; 3],
            vector: [None; 3],
            radius: None,
            opening: None,
            turns: None,
            rotation: None,
            fixed_point: None,
            feed: None,
            speed: None,
            tool: None,
            edge: None,
            m: [None; MOST_M],
            orientation_tolerance: None,
            rare: None,
            assigned: Vec::new(),
            call: None,
            statement: None,
            message: None,
            comment: None,
            any: false,
            groups: [0; GROUPS],
            further_offset: None,
        }
    }
}
