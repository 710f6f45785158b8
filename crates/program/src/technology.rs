//! Feed, spindle, coolant, tool, compensation, and what else the machine is sent in addition to its motion.

/// How fast the tool moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// mm/min.
    PerMinute(f64),
    /// mm for each turn of the spindle.
    PerTurn(f64),
    /// Moves in a minute: 1 / (minutes the move takes).
    InverseTime(f64),
}

impl Feed {
    /// The number, in the unit of its kind.
    pub fn value(self) -> f64 {
        match self {
            Feed::PerMinute(value) | Feed::PerTurn(value) | Feed::InverseTime(value) => value,
        }
    }
}

/// What the spindle does; speeds in 1/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spindle {
    /// Stopped.
    Off,
    /// Clockwise, seen from the spindle to the part (`M3`).
    Clockwise(f64),
    /// Counter-clockwise (`M4`).
    CounterClockwise(f64),
}

/// Which coolant runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coolant {
    /// None.
    Off,
    /// Flood (`M8`).
    Flood,
    /// Mist (`M7`).
    Mist,
    /// Flood and mist together.
    FloodAndMist,
    /// Through the tool.
    Through,
}

/// What an M function does with the coolant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoolantSwitch {
    /// Flood on.
    Flood,
    /// Mist on.
    Mist,
    /// Coolant through the tool on.
    Through,
    /// All coolant off; that through the tool where no function of its own ends it.
    Off,
    /// Coolant through the tool off.
    ThroughOff,
}

/// The M functions that switch coolant on a machine whose builder has given them other numbers than the usual ones of its control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoolantFunctions {
    /// Flood on, M8 on most controls.
    pub flood: Option<u32>,
    /// Mist on, M7 on most controls.
    pub mist: Option<u32>,
    /// Coolant through the tool on; no usual number but M88 of Haas.
    pub through: Option<u32>,
    /// Coolant off, M9 on all controls.
    pub off: Option<u32>,
    /// Coolant through the tool off, where `off` does not end it.
    pub through_off: Option<u32>,
}

impl CoolantFunctions {
    /// What the machine file says that M of this number does with the coolant.
    pub fn switch(&self, number: u32) -> Option<CoolantSwitch> {
        let rows = self.rows().into_iter();
        let mut found = rows.filter(|(stated, _)| *stated == Some(number));
        found.next().map(|(_, switch)| switch)
    }

    /// The numbers that the machine file gives to coolant.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.rows().into_iter().filter_map(|(stated, _)| stated)
    }

    /// Whether the machine file gives this to another function than the usual one.
    pub fn is_stated(&self, switch: CoolantSwitch) -> bool {
        !self.rows().contains(&(None, switch))
    }

    /// Whether one function does two things.
    pub fn contradicts(&self) -> bool {
        let mut numbers: Vec<u32> = self.numbers().collect();
        let count = numbers.len();
        numbers.sort_unstable();
        numbers.dedup();
        numbers.len() < count
    }

    fn rows(&self) -> [(Option<u32>, CoolantSwitch); 5] {
        [
            (self.flood, CoolantSwitch::Flood),
            (self.mist, CoolantSwitch::Mist),
            (self.through, CoolantSwitch::Through),
            (self.off, CoolantSwitch::Off),
            (self.through_off, CoolantSwitch::ThroughOff),
        ]
    }
}

/// A tool as the source describes it. What the source does not say is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tool {
    /// Place in the magazine, from 1.
    pub number: u32,
    /// Its name or description.
    pub name: String,
    /// Cutting diameter, mm.
    pub diameter: Option<f64>,
    /// Corner radius, mm.
    pub corner_radius: Option<f64>,
    /// Length from the gauge line of the spindle to the tip, mm.
    pub length: Option<f64>,
    /// Register of the length offset where the source names one.
    pub offset: Option<u32>,
    /// Whether its side or its end leans (a drill, a countersink, a cone), so that the radius with which it cuts aside depends
    /// on the depth.
    pub tapered: bool,
}

/// Cutter radius compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// None (`G40`).
    Off,
    /// Tool on the left of the path (`G41`), with its register where one is named.
    Left(Option<u32>),
    /// Tool on the right of the path (`G42`).
    Right(Option<u32>),
}

/// A work offset, by its place among those that the control can set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WorkOffset(u32);

impl WorkOffset {
    /// None: positions count from the zero of the machine, or from what the operator has set (`G53`, `G500`).
    pub const NONE: WorkOffset = WorkOffset(53);

    /// The first that a control can set (`G54`).
    pub const FIRST: WorkOffset = WorkOffset(54);

    /// The offset of that number: 54 is the first, 55 the second, and 53 is none.
    /// `None` for a smaller number.
    pub fn numbered(number: u32) -> Option<WorkOffset> {
        (number >= WorkOffset::NONE.0).then_some(WorkOffset(number))
    }

    /// The offset of that place: 1 is the first, 0 is none. `None` where the place is too great.
    pub fn at(place: u32) -> Option<WorkOffset> {
        place.checked_add(WorkOffset::NONE.0).map(WorkOffset)
    }

    /// Its number: 54 is the first, 53 is none.
    pub fn number(self) -> u32 {
        self.0
    }
}

/// Where a work offset puts its zero: what a program writes into the table of the control (`G10 L2`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkOffsetData {
    /// The work offset that is written.
    pub offset: WorkOffset,
    /// X, Y, Z (mm) and A, B, C (degrees) of the zero in machine coordinates; those that are not given keep what
    /// they have.
    pub zero: [Option<f64>; 6],
}

/// A set of axes of the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axes(u8);

impl Axes {
    /// X.
    pub const X: Axes = Axes(1);
    /// Y.
    pub const Y: Axes = Axes(1 << 1);
    /// Z.
    pub const Z: Axes = Axes(1 << 2);
    /// A, which turns about X.
    pub const A: Axes = Axes(1 << 3);
    /// B, which turns about Y.
    pub const B: Axes = Axes(1 << 4);
    /// C, which turns about Z.
    pub const C: Axes = Axes(1 << 5);
    /// None.
    pub const NONE: Axes = Axes(0);
    /// X, Y and Z.
    pub const LINEAR: Axes = Axes(0b111);

    /// Of X, Y, Z, A, B and C those that are so marked.
    pub fn of(marked: [bool; 6]) -> Axes {
        let bits = marked.into_iter().enumerate();
        bits.fold(Axes::NONE, |axes, (bit, marked)| Axes(axes.0 | u8::from(marked) << bit))
    }

    /// The linear axis of that index: 0 is X, 1 Y, 2 Z. No axis for any other.
    pub fn linear(index: usize) -> Axes {
        if index < 3 { Axes(1 << index) } else { Axes::NONE }
    }

    /// The rotary axis of that index: 0 is A, 1 B, 2 C. No axis for any other.
    pub fn rotary(index: usize) -> Axes {
        if index < 3 { Axes(8 << index) } else { Axes::NONE }
    }

    /// Whether each axis of `others` is one of these.
    pub fn contains(self, others: Axes) -> bool {
        self.0 & others.0 == others.0
    }

    /// Whether there is none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Their letters, in the order X, Y, Z, A, B, C.
    pub fn letters(self) -> String {
        let letters = "XYZABC".chars().enumerate();
        letters.filter(|(bit, _)| self.0 >> bit & 1 == 1).map(|(_, letter)| letter).collect()
    }
}

impl std::ops::BitOr for Axes {
    type Output = Axes;

    fn bitor(self, others: Axes) -> Axes {
        Axes(self.0 | others.0)
    }
}

impl std::ops::BitOrAssign for Axes {
    fn bitor_assign(&mut self, others: Axes) {
        self.0 |= others.0;
    }
}

/// What the machine does with the corner between two moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathMode {
    /// It stops at the end of each move, and waits until the axes are there (`G61.1`, `G9`, `fine` of a robot).
    ExactStop,
    /// It keeps to the path, however slow that makes it (`G61`).
    ExactPath,
    /// It leaves the path at corners, by so many mm at most (`G64 P`, `zone` of a robot).
    Blend(f64),
    /// It leaves the path at corners as the control is set up (`G64`).
    AsSetUp,
}

/// An output of the machine that the program sets: a gripper, a valve, a laser's shutter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// Number of the output.
    pub number: u32,
    /// What it is set to.
    pub value: OutputValue,
    /// Whether it changes with the beginning of the next motion (`M62`, `M63`, `M67`), and not at once (`M64`, `M65`, `M68`).
    pub with_motion: bool,
}

/// What an output is set to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutputValue {
    /// On or off.
    Digital(bool),
    /// A number in the unit of the machine.
    Analog(f64),
}

/// An input of the machine for which the program waits (`M66`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// Number of the input.
    pub number: u32,
    /// What it waits for.
    pub until: Until,
    /// How long it waits at the most, s. What the program does afterwards does not depend on the answer.
    pub timeout: f64,
}

/// What a program waits for at an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// For nothing: the input is read.
    Read,
    /// The input of this number is analog, and is read.
    ReadAnalog,
    /// It goes on.
    Rise,
    /// It goes off.
    Fall,
    /// It is on.
    High,
    /// It is off.
    Low,
}

/// A function that the builder of the machine has added, called by the number of its M function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Auxiliary {
    /// Number of the M function.
    pub number: u32,
    /// Values that are handed to it: P and Q of LinuxCNC's `M100` to `M199`.
    pub values: [Option<f64>; 2],
}

impl Auxiliary {
    /// The function of this number, without values.
    pub fn of(number: u32) -> Auxiliary {
        Auxiliary { number, values: [None; 2] }
    }
}

/// What a beam does: a laser, or plasma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Beam {
    /// It is off.
    Off,
    /// It is on with this part of its greatest power, 0 to 1.
    On(f64),
    /// The same, and the power falls with the speed of the tool (`M4` of GRBL's laser mode).
    WithSpeed(f64),
}

/// Brakes of axes, which hold them or let them go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clamp {
    /// The axes.
    pub axes: Axes,
    /// Whether they are held.
    pub closed: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_offsets_count_from_the_first_that_a_control_can_set() {
        assert_eq!(WorkOffset::numbered(54), Some(WorkOffset::FIRST));
        assert_eq!(WorkOffset::numbered(53), Some(WorkOffset::NONE));
        assert_eq!(WorkOffset::numbered(52), None);
        assert_eq!(WorkOffset::at(1), Some(WorkOffset::FIRST));
        assert_eq!(WorkOffset::at(u32::MAX), None);
        assert_eq!(WorkOffset::at(2).map(WorkOffset::number), Some(55));
    }

    #[test]
    fn axes_are_named_by_their_letters() {
        assert_eq!((Axes::C | Axes::X | Axes::Z).letters(), "XZC");
        assert!(Axes::LINEAR.contains(Axes::X | Axes::Z) && !Axes::LINEAR.contains(Axes::A));
        assert_eq!(Axes::linear(1) | Axes::rotary(2), Axes::Y | Axes::C);
        assert!(Axes::linear(3).is_empty() && Axes::rotary(3).is_empty());
    }
}
