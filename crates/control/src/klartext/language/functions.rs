//! M functions: what they are and when in a block they act.

#![deny(clippy::wildcard_enum_match_arm)]

use super::feed::{FeedWord, Readable, feed_word, unknown};
use super::scan::{Scanner, Word};
use crate::kernel::Outcome;
use crate::kernel::coolant::Doubtful;
use program::{CoolantFunctions, CoolantSwitch, Rule};

/// An M function with what belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Function {
    /// Stop of the program, the spindle and the coolant: `M0`.
    Stop,
    /// Stop of the program alone: `STOP`, which no number stands for.
    ProgramStop,
    /// The same where the operator has asked for it: `M1`.
    OptionalStop,
    /// End of the program: `M2`, `M30`.
    End,
    /// Spindle clockwise, and coolant where `M13` says so.
    Clockwise { coolant: Option<CoolantSwitch> },
    /// Spindle counter-clockwise, and coolant where `M14` says so.
    CounterClockwise { coolant: Option<CoolantSwitch> },
    /// Spindle stop: `M5`.
    SpindleStop,
    /// `M6`: the tool call before it has made the tool change, and the spindle stands.
    ToolChange,
    /// `M8`, `M9`, and what the machine's file has besides.
    Coolant(CoolantSwitch),
    /// The block gives machine coordinates (`M91`), or coordinates that count from the datum of the builder (`M92`).
    MachineCoordinates { builders: bool },
    /// Calls the cycle after every positioning block: `M89`.
    CallCyclesModally,
    /// Calls the cycle after this block: `M99`.
    CallCycle,
    /// Keeps the tool tip while rotary axes turn: `M128`.
    KeepTip,
    /// Ends `M128` and `FUNCTION TCPM`: `M129`.
    ReleaseTip,
    /// Feed for each turn of the spindle (`M136`) or for each minute (`M137`).
    FeedPerTurn(bool),
    /// Rotary axes go the shorter way (`M126`), or as a parameter of the builder says (`M127`).
    ShorterWay(bool),
    /// A function that the builder of the machine has added.
    Auxiliary(u32),
    /// Moves nothing and changes no path.
    Nothing,
    /// Switches off a check at which the control stops: `M107`, `M141`.
    MonitoringOff,
    /// Changes a tool whose life is over for a replacement by itself, between two blocks: `M101`.
    ReplacesTool,
    /// Takes the tool off the contour where the program is stopped: `M148`.
    LiftsOff,
    /// Retracts along the tool axis: by so many mm, infinite for `M140 MB MAX`; at a feed of its own
    /// or by rapid.
    Retract(f64, Option<FeedWord>),
}

/// The number of an M function, and what it is. M140 takes its distance from the text.
const FUNCTIONS: [(u16, Function); 26] = [
    (0, Function::Stop),
    (1, Function::OptionalStop),
    (2, Function::End),
    (3, Function::Clockwise { coolant: None }),
    (4, Function::CounterClockwise { coolant: None }),
    (5, Function::SpindleStop),
    (6, Function::ToolChange),
    (8, Function::Coolant(CoolantSwitch::Flood)),
    (9, Function::Coolant(CoolantSwitch::Off)),
    (13, Function::Clockwise { coolant: Some(CoolantSwitch::Flood) }),
    (14, Function::CounterClockwise { coolant: Some(CoolantSwitch::Flood) }),
    (30, Function::End),
    (89, Function::CallCyclesModally),
    (91, Function::MachineCoordinates { builders: false }),
    (92, Function::MachineCoordinates { builders: true }),
    (99, Function::CallCycle),
    (101, Function::ReplacesTool),
    (107, Function::MonitoringOff),
    (126, Function::ShorterWay(true)),
    (127, Function::ShorterWay(false)),
    (128, Function::KeepTip),
    (129, Function::ReleaseTip),
    (136, Function::FeedPerTurn(true)),
    (137, Function::FeedPerTurn(false)),
    (141, Function::MonitoringOff),
    (148, Function::LiftsOff),
];

/// Functions that change neither where the tool goes nor what it does there: the speed in corners
/// (M90, M134, M135), feed in arcs as it is without (M111), the ends of what is reported or refused (M102, M108, M117, M121,
/// M145, M149).
const NEUTRAL: [u16; 10] = [90, 102, 108, 111, 117, 121, 134, 135, 145, 149];

/// Functions that are refused, and why.
const REFUSED: [(u16, &str); 18] = [
    (94, "changes the count of a rotary axis"),
    (97, "changes the compensated path at small steps"),
    (98, "changes the compensated path at open corners"),
    (103, "changes the feed of plunging moves"),
    (104, "activates the preset that was set last by hand"),
    (109, "changes the feed in arcs"),
    (110, "changes the feed in arcs"),
    (114, "compensates the geometry of the machine"),
    (115, "compensates the geometry of the machine"),
    (116, "changes the meaning of the feed of rotary axes"),
    (118, "lets the handwheel move the axes"),
    (120, "changes the compensated path at small steps"),
    (124, "leaves points out"),
    (130, "gives points of the untilted plane"),
    (138, "chooses the axes that tilt"),
    (143, "deletes the basic rotation of the preset"),
    (144, "compensates the geometry of the machine"),
    (197, "rounds the corners of the compensated path"),
];

/// The numbers of the functions that it knows.
pub(in crate::klartext) fn vocabulary() -> impl Iterator<Item = u16> {
    let known = FUNCTIONS.iter().map(|(number, _)| *number).chain(NEUTRAL);
    known.chain(REFUSED.iter().map(|(number, _)| *number)).chain([140])
}

/// When in its block a function acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum When {
    /// Before the motion.
    Start,
    /// After the motion.
    End,
}

impl Function {
    /// What the word `M..` says, with the words that belong to it.
    pub(super) fn read(s: &mut Scanner, word: &Word, control: &dyn Readable) -> Outcome<Function> {
        let Some(number) = word.number.filter(|_| word.sign == 0.0) else {
            return Err(unknown(s, word));
        };
        if number == 140.0 {
            return retract(s, control);
        }
        let is = |n: &u16| f64::from(*n) == number;
        let stated = control.coolant_functions();
        let whole = (number.fract() == 0.0).then_some(number as u32);
        if let Some(switch) = whole.and_then(|number| stated.switch(number)) {
            if vocabulary().any(|n| is(&n) && !matches!(n, 8 | 9)) {
                let Doubtful { message, help } = Doubtful::of_the_control(&format!("M{number}"));
                return Err(s.error(Rule::Coolant, word.span, message).help(help).into());
            }
            return Ok(Function::Coolant(switch));
        }
        let moved = [(8.0, CoolantSwitch::Flood), (9.0, CoolantSwitch::Off)];
        if moved.iter().any(|(usual, switch)| *usual == number && stated.is_stated(*switch)) {
            let message = format!(
                "M{number} is not what switches this coolant: [coolant] of the machine file names another M function"
            );
            return Err(s.error(Rule::MFunction, word.span, message));
        }
        if let Some((_, function)) = FUNCTIONS.iter().find(|(n, _)| is(n)) {
            // The feed behind M128 is that of the compensating motion, not of the path.
            if *function == Function::KeepTip {
                own_feed(s, control)?;
            }
            if *function == Function::ReplacesTool {
                delay(s, control)?;
            }
            if let Function::Clockwise { coolant: Some(_) } = function {
                let coolant = Some(coolant_of_m8(s, word, stated)?);
                return Ok(Function::Clockwise { coolant });
            }
            if let Function::CounterClockwise { coolant: Some(_) } = function {
                let coolant = Some(coolant_of_m8(s, word, stated)?);
                return Ok(Function::CounterClockwise { coolant });
            }
            return Ok(*function);
        }
        let added = control.auxiliary().iter().find(|n| f64::from(**n) == number);
        if let Some(number) = added {
            return Ok(Function::Auxiliary(*number));
        }
        if NEUTRAL.iter().any(is) {
            return Ok(Function::Nothing);
        }
        let reason = REFUSED.iter().find(|(n, _)| is(n)).map(|(_, reason)| *reason);
        let message = match reason {
            Some(reason) => format!("M{number} is not supported: it {reason}"),
            None => format!("M{number} is not understood"),
        };
        Err(s.error(Rule::MFunction, word.span, message))
    }

    /// When it acts (TNC manuals, table of the M functions).
    pub(super) fn when(self) -> When {
        match self {
            Function::Stop
            | Function::ProgramStop
            | Function::OptionalStop
            | Function::End
            | Function::SpindleStop
            | Function::ToolChange
            | Function::Coolant(CoolantSwitch::Off | CoolantSwitch::ThroughOff)
            | Function::CallCyclesModally
            | Function::CallCycle
            | Function::ReleaseTip => When::End,
            Function::Clockwise { .. }
            | Function::CounterClockwise { .. }
            | Function::Coolant(_)
            | Function::MachineCoordinates { .. }
            | Function::KeepTip
            | Function::FeedPerTurn(_)
            | Function::ShorterWay(_)
            | Function::Auxiliary(_)
            | Function::Nothing
            | Function::MonitoringOff
            | Function::ReplacesTool
            | Function::LiftsOff
            | Function::Retract(..) => When::Start,
        }
    }
}

/// The coolant of `M13` and `M14`: the control switches on what `M8` does (TNC 155, table of the M functions: their outputs are "Spindle
/// clockwise" and "Coolant on").
fn coolant_of_m8(s: &Scanner, word: &Word, stated: CoolantFunctions) -> Outcome<CoolantSwitch> {
    match stated.switch(8) {
        Some(switch @ (CoolantSwitch::Flood | CoolantSwitch::Mist | CoolantSwitch::Through)) => {
            Ok(switch)
        }
        None if !stated.is_stated(CoolantSwitch::Flood) => Ok(CoolantSwitch::Flood),
        Some(CoolantSwitch::Off | CoolantSwitch::ThroughOff) | None => {
            let message = "M13 and M14 switch the coolant of M8, and [coolant] of the machine file names another M function";
            let help = "write M3 or M4, and the M function of the coolant in a block of its own";
            Err(s.error(Rule::MFunction, word.span, message).help(help).into())
        }
    }
}

/// Behind `M140`: `MB MAX` or `MB 50 F750`. The feed is that of the retraction alone.
fn retract(s: &mut Scanner, control: &dyn Readable) -> Outcome<Function> {
    let distance = if s.take(b"MB") {
        if s.take(b"MAX") { f64::INFINITY } else { s.value(control.registers())? }
    } else {
        match s.word(control.registers())? {
            Some(Word { address: b"MB", number: Some(distance), .. }) => distance,
            _ => return Err(s.error_block(Rule::MFunction, "M140 needs MB with a distance or MAX")),
        }
    };
    if distance <= 0.0 {
        return Err(s.error_block(Rule::MFunction, "M140 retracts: MB must be greater than 0"));
    }
    Ok(Function::Retract(distance * control.unit(), own_feed(s, control)?))
}

/// Behind `M101`: by how many blocks the change may be late, `BT10`.
fn delay(s: &mut Scanner, control: &dyn Readable) -> Outcome {
    if s.peek().starts_with(b"BT") {
        s.word(control.registers())?;
    }
    Ok(())
}

/// The feed that belongs to the function before it, where there is one.
fn own_feed(s: &mut Scanner, control: &dyn Readable) -> Outcome<Option<FeedWord>> {
    if !s.peek().starts_with(b"F") {
        return Ok(None);
    }
    match s.word(control.registers())? {
        Some(word) => feed_word(s, &word, control.tool_feed()).map(Some),
        None => Ok(None),
    }
}

/// The M functions of a block, at most two.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Functions([Option<Function>; 2]);

impl Functions {
    /// One function alone.
    pub(crate) fn of(function: Function) -> Functions {
        Functions([Some(function), None])
    }

    /// Adds one; answers why it cannot stand there.
    pub(super) fn push(&mut self, function: Function) -> Result<(), &'static str> {
        let place = self.0.iter_mut().find(|place| place.is_none());
        *place.ok_or("a block takes two M functions")? = Some(function);
        Ok(())
    }

    /// Those that act at that moment, in their order.
    pub(crate) fn at(self, when: When) -> impl Iterator<Item = Function> {
        self.0.into_iter().flatten().filter(move |f| f.when() == when)
    }

    /// Whether there is none.
    pub(crate) fn is_empty(self) -> bool {
        self.0[0].is_none()
    }

    /// Whether the block gives machine coordinates, and then whether from the datum of the builder.
    pub(crate) fn machine_coordinates(self) -> Option<bool> {
        self.0.iter().find_map(|function| match function {
            Some(Function::MachineCoordinates { builders }) => Some(*builders),
            _ => None,
        })
    }

    /// Whether one of them is `function`.
    pub(crate) fn contains(self, function: Function) -> bool {
        self.0.contains(&Some(function))
    }
}
