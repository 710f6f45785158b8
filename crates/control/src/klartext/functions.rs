//! M functions: what they are and when in a block they act.

use super::scan::{Result, Scanner, Word};
use super::state::Control;
use super::words::{FeedWord, feed_word, unknown};

/// An M function with what belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    /// Stop of the program, the spindle and the coolant: `M0`, `STOP`.
    Stop,
    /// The same where the operator has asked for it: `M1`.
    OptionalStop,
    /// End of the program: `M2`, `M30`.
    End,
    /// Spindle clockwise, and coolant where `M13` says so.
    Clockwise { coolant: bool },
    /// Spindle counter-clockwise, and coolant where `M14` says so.
    CounterClockwise { coolant: bool },
    /// Spindle stop: `M5`, and `M6`, which the tool call before it has made a tool change.
    SpindleStop,
    /// `M8`.
    Coolant,
    /// `M9`.
    CoolantOff,
    /// The block gives machine coordinates: `M91`, `M92`.
    MachineCoordinates,
    /// Calls the cycle after every positioning block: `M89`.
    CallCyclesModally,
    /// Calls the cycle after this block: `M99`.
    CallCycle,
    /// How a rotary axis takes its way, not where it ends: `M126`, `M127`.
    RotaryWay,
    /// Keeps the tool tip while rotary axes turn: `M128`.
    KeepTip,
    /// Ends `M128` and `FUNCTION TCPM`: `M129`.
    ReleaseTip,
    /// Feed for each turn of the spindle (`M136`) or for each minute (`M137`).
    FeedPerTurn(bool),
    /// The builder's own: moves nothing.
    Auxiliary,
    /// Retracts along the tool axis: by so many mm, infinite for `M140 MB MAX`; at a feed of its own
    /// or by rapid.
    Retract(f64, Option<FeedWord>),
}

/// The number of an M function, and what it is. M140 takes its distance from the text.
const FUNCTIONS: [(u16, Function); 22] = [
    (0, Function::Stop),
    (1, Function::OptionalStop),
    (2, Function::End),
    (3, Function::Clockwise { coolant: false }),
    (4, Function::CounterClockwise { coolant: false }),
    (5, Function::SpindleStop),
    (6, Function::SpindleStop),
    (8, Function::Coolant),
    (9, Function::CoolantOff),
    (13, Function::Clockwise { coolant: true }),
    (14, Function::CounterClockwise { coolant: true }),
    (30, Function::End),
    (89, Function::CallCyclesModally),
    (91, Function::MachineCoordinates),
    (92, Function::MachineCoordinates),
    (99, Function::CallCycle),
    (126, Function::RotaryWay),
    (127, Function::RotaryWay),
    (128, Function::KeepTip),
    (129, Function::ReleaseTip),
    (136, Function::FeedPerTurn(true)),
    (137, Function::FeedPerTurn(false)),
];

/// When in its block a function acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum When {
    /// Before the motion.
    Start,
    /// After the motion.
    End,
}

impl Function {
    /// What the word `M..` says, with the words that belong to it.
    pub(super) fn read(s: &mut Scanner, word: &Word, control: &Control) -> Result<Function> {
        let Some(number) = word.number.filter(|_| word.sign == 0.0) else {
            return Err(unknown(s, word));
        };
        if number == 140.0 {
            return retract(s, control.unit);
        }
        let known = FUNCTIONS.iter().find(|(n, _)| f64::from(*n) == number);
        let Some((_, function)) = known else {
            if control.settings.auxiliary.iter().any(|n| f64::from(*n) == number) {
                return Ok(Function::Auxiliary);
            }
            let message = format!("M{number} is not understood");
            return Err(s.error("m-function", word.span, message));
        };
        // The feed behind M128 is that of the compensating motion, not of the path.
        if *function == Function::KeepTip {
            own_feed(s)?;
        }
        Ok(*function)
    }

    /// When it acts (TNC manuals, table of the M functions).
    pub(super) fn when(self) -> When {
        match self {
            Function::Stop
            | Function::OptionalStop
            | Function::End
            | Function::SpindleStop
            | Function::CoolantOff
            | Function::CallCyclesModally
            | Function::CallCycle
            | Function::ReleaseTip => When::End,
            _ => When::Start,
        }
    }
}

/// Behind `M140`: `MB MAX` or `MB 50 F750`. The feed is that of the retraction alone.
fn retract(s: &mut Scanner, unit: f64) -> Result<Function> {
    let distance = if s.take(b"MB") {
        if s.take(b"MAX") { f64::INFINITY } else { s.value()? }
    } else {
        match s.word()? {
            Some(Word { address: b"MB", number: Some(distance), .. }) => distance,
            _ => return Err(s.error_block("m-function", "M140 needs MB with a distance or MAX")),
        }
    };
    if distance <= 0.0 {
        return Err(s.error_block("m-function", "M140 retracts: MB must be greater than 0"));
    }
    Ok(Function::Retract(distance * unit, own_feed(s)?))
}

/// The feed that belongs to the function before it, where there is one.
fn own_feed(s: &mut Scanner) -> Result<Option<FeedWord>> {
    if !s.peek().starts_with(b"F") {
        return Ok(None);
    }
    match s.word()? {
        Some(word) => feed_word(s, &word).map(Some),
        None => Ok(None),
    }
}

/// The M functions of a block, at most two.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Functions([Option<Function>; 2]);

impl Functions {
    /// Adds one; answers why it cannot stand there.
    pub(super) fn push(&mut self, function: Function) -> std::result::Result<(), &'static str> {
        let place = self.0.iter_mut().find(|place| place.is_none());
        *place.ok_or("a block takes two M functions")? = Some(function);
        Ok(())
    }

    /// Those that act at that moment, in their order.
    pub(super) fn at(self, when: When) -> impl Iterator<Item = Function> {
        self.0.into_iter().flatten().filter(move |f| f.when() == when)
    }

    /// Whether there is none.
    pub(super) fn is_empty(self) -> bool {
        self.0 == [None; 2]
    }

    /// Whether one of them is `function`.
    pub(super) fn contains(self, function: Function) -> bool {
        self.0.contains(&Some(function))
    }
}
