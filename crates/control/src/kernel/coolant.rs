//! Which coolant runs behind an M function.

use program::{Coolant, CoolantFunctions, CoolantSwitch};

/// How the coolants of a machine go with each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coolants {
    /// The M functions that the machine file names.
    pub functions: CoolantFunctions,
    /// Whether flood and mist run next to each other.
    pub adds: bool,
    /// The control's own M function that ends coolant through the tool, where that for all coolant leaves it on.
    pub ends_through: Option<u32>,
}

/// Why an M function of coolant is refused, and what to write instead.
#[derive(Debug)]
pub(crate) struct Doubtful {
    pub message: String,
    pub help: String,
}

impl Doubtful {
    /// Why an M function, as the program shows it, is none of coolant: the control uses it itself.
    pub fn of_the_control(shown: &str) -> Doubtful {
        let message = format!(
            "{shown} is a function of the control itself, and [coolant] of the machine file takes it for coolant"
        );
        let help = "name the M function that switches the coolant of this machine in [coolant]";
        Doubtful { message, help: help.into() }
    }
}

impl Coolants {
    /// What runs behind this function.
    ///
    /// # Errors
    /// Whether it ends what `running` says, or runs next to it, only the builder of the machine knows.
    pub fn behind(&self, running: Coolant, switch: CoolantSwitch) -> Result<Coolant, Doubtful> {
        let on = match switch {
            CoolantSwitch::Flood => Coolant::Flood,
            CoolantSwitch::Mist => Coolant::Mist,
            CoolantSwitch::Through => Coolant::Through,
            CoolantSwitch::ThroughOff if running == Coolant::Through => return Ok(Coolant::Off),
            CoolantSwitch::ThroughOff => return Ok(running),
            CoolantSwitch::Off => {
                let Some(number) = self.ends_through().filter(|_| running == Coolant::Through)
                else {
                    return Ok(Coolant::Off);
                };
                return Err(Doubtful {
                    message: format!(
                        "this leaves the coolant through the tool on, which has a function of its own to end it (M{number})"
                    ),
                    help: format!("write M{number}"),
                });
            }
        };
        match (running, on) {
            (Coolant::Off, _) => Ok(on),
            (Coolant::FloodAndMist, Coolant::Flood | Coolant::Mist) => Ok(running),
            (Coolant::Flood, Coolant::Mist) | (Coolant::Mist, Coolant::Flood) if self.adds => {
                Ok(Coolant::FloodAndMist)
            }
            _ if running == on => Ok(running),
            _ => Err(Doubtful {
                message: "one coolant runs already: whether both then run is up to the machine"
                    .into(),
                help: format!("write M{} first", self.ends(running)),
            }),
        }
    }

    /// What runs behind an event that ends the coolants of the control itself, as the end of the program is one: a coolant by an M
    /// function of the builder's ends where the builder has it so.
    pub fn behind_reset(&self, running: Coolant) -> Coolant {
        if self.is_builders(running) { running } else { Coolant::Off }
    }

    /// Refuses a tool change with a coolant that only the builder knows to end there.
    ///
    /// # Errors
    /// Such a coolant runs.
    pub fn allow_change(&self, running: Coolant) -> Result<(), Doubtful> {
        if !self.is_builders(running) {
            return Ok(());
        }
        Err(Doubtful {
            message: "the tool is changed while a coolant runs that the machine's builder has added: whether the change ends it, only \
                      the builder knows"
                .into(),
            help: format!("write M{} before the tool change", self.ends(running)),
        })
    }

    /// The number of the M function that ends what runs.
    fn ends(&self, running: Coolant) -> u32 {
        let apart = self.ends_through().filter(|_| running == Coolant::Through);
        apart.or(self.functions.off).unwrap_or(9)
    }

    /// The M function that ends coolant through the tool, where that for all coolant does not.
    fn ends_through(&self) -> Option<u32> {
        self.functions.through_off.or(self.ends_through)
    }

    fn is_builders(&self, running: Coolant) -> bool {
        let CoolantFunctions { flood, mist, through, off: _, through_off } = self.functions;
        match running {
            Coolant::Off => false,
            Coolant::Flood => flood.is_some_and(|number| number != 8),
            Coolant::Mist => mist.is_some_and(|number| number != 7),
            Coolant::FloodAndMist => {
                self.is_builders(Coolant::Flood) || self.is_builders(Coolant::Mist)
            }
            // That of the control itself is ended by its own function.
            Coolant::Through => {
                through.is_some()
                    && (self.ends_through.is_none() || through_off != self.ends_through)
            }
        }
    }
}
