//! The states of an engraver at work (spec 4.16): what must be settled before the laser fires, and what stops it.

use serde::Serialize;

/// What an engraver is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// Nothing is settled.
    Idle,
    /// All of [`Settled`] is.
    Checked,
    /// The operator has said from which point on, with which channels.
    Confirmed,
    /// The warning that the laser fires is on.
    Warned,
    /// The axes move to where the block is put in.
    MovingToLoad,
    /// The lamp warms up.
    WarmingUp,
    /// Points are made.
    Running,
    /// The operator has stopped the run; it can go on.
    Stopped,
    /// The last point is made.
    Finished,
    /// The axes move to where the block is taken out.
    MovingToSample,
    /// The door was opened or the emergency stop pressed: shutter closed, axes at rest.
    Fault,
}

/// What is settled before a run: the list that D's program asks for (appendix E).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settled {
    /// The zero was taught for the chosen lens.
    pub taught: bool,
    /// The extents of the block are given.
    pub extents: bool,
    /// Its material is chosen.
    pub material: bool,
    /// The points are in an order.
    pub sorted: bool,
    /// No two points are the same.
    pub tested: bool,
}

/// What happens to an engraver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The list before the run is gone through.
    Check(Settled),
    /// The operator confirms.
    Confirm,
    /// The warning is switched on.
    Warn,
    /// The operator starts the run.
    Start,
    /// The axes have arrived.
    Arrive,
    /// The lamp is warm.
    Warm,
    /// The operator stops the run.
    Stop,
    /// The operator lets it go on.
    Continue,
    /// The last point is made, or the operator ends a stopped run.
    End,
    /// The block is to be taken out.
    Unload,
    /// The door is opened.
    OpenDoor,
    /// The emergency stop is pressed.
    EmergencyStop,
    /// Door closed, emergency stop released, and the fault acknowledged.
    Reset,
}

/// What an engraver would not do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    /// These are not settled.
    Unsettled(Vec<&'static str>),
    /// Nothing of that kind follows this state.
    Now(State),
}

impl Settled {
    /// What is missing, in the order of the list.
    pub fn missing(&self) -> Vec<&'static str> {
        let all = [
            (self.taught, "zero taught for the lens"),
            (self.extents, "extents of the block"),
            (self.material, "material"),
            (self.sorted, "order of the points"),
            (self.tested, "test for equal points"),
        ];
        all.into_iter().filter(|(settled, _)| !settled).map(|(_, name)| name).collect()
    }
}

impl State {
    /// The state after an event.
    ///
    /// # Errors
    /// The event cannot be in this state; it stays as it is.
    pub fn after(self, event: Event) -> Result<State, Refused> {
        match (self, event) {
            // From any state.
            (_, Event::OpenDoor | Event::EmergencyStop) => Ok(State::Fault),
            (State::Fault, Event::Reset) => Ok(State::Idle),
            (State::Idle, Event::Check(settled)) => match settled.missing() {
                missing if missing.is_empty() => Ok(State::Checked),
                missing => Err(Refused::Unsettled(missing)),
            },
            (State::Checked, Event::Confirm) => Ok(State::Confirmed),
            (State::Confirmed, Event::Warn) => Ok(State::Warned),
            (State::Warned, Event::Start) => Ok(State::MovingToLoad),
            (State::MovingToLoad, Event::Arrive) => Ok(State::WarmingUp),
            (State::WarmingUp, Event::Warm) | (State::Stopped, Event::Continue) => {
                Ok(State::Running)
            }
            (State::Running, Event::Stop) => Ok(State::Stopped),
            (State::Running | State::Stopped, Event::End) => Ok(State::Finished),
            (State::Finished, Event::Unload) => Ok(State::MovingToSample),
            (State::MovingToSample, Event::Arrive) => Ok(State::Idle),
            (now, _) => Err(Refused::Now(now)),
        }
    }

    /// Whether the shutter is open.
    pub fn fires(self) -> bool {
        self == State::Running
    }
}
