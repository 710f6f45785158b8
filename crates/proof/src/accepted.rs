//! Rules that whoever posts a program may let pass for one run: each hangs on how the machine is set up, which the
//! program does not say.

use program::Rule;

/// The rules that may be accepted, each with what its acceptance answers for.
pub const ACCEPTABLE: [(&str, &str); 25] = [
    ("adaptive-feed", "an input of the machine multiplies the feed"),
    ("axis-dynamics", "axes may be faster than their machine data allow"),
    ("dwell-unit", "what a dwell counts in"),
    ("floating-tap", "taps are held in a floating chuck"),
    ("gear", "in which gear the spindle reaches its speeds"),
    ("leaning-retract", "a retract along the tool brings Z to its end"),
    ("left-on", "what the program leaves on for the next one"),
    ("length-change", "Z moves by the tool length where parameter 5006#6 is 0"),
    ("length-plane", "along which axis the tool length counts in G18 and G19"),
    ("line-end", "the control takes a last block without a line end"),
    ("operator-controls", "the operator can neither stop the program nor slow it down"),
    ("operator-data", "work offsets and tool data that the program rewrites"),
    ("orientation-tolerance", "the tool may lean otherwise by more than the machine's file allows"),
    ("orientation-way", "how the tool turns within a block while the control keeps its tip"),
    ("path-tolerance", "corners may be cut by more than the machine's file allows"),
    ("rapid-path", "room for the tool where it goes by rapid beside the way of the source"),
    ("replacement-tool", "where and how the control changes a tool whose life is over"),
    ("rotary-way", "which way the rotary axes turn"),
    ("stop-running", "M0 and M1 of the machine stop spindle and coolant"),
    ("stored-position", "where the stored position is to which Z goes"),
    ("swivel-data", "the data set that the program names is that of this kinematics"),
    ("table-frame", "in which frame X, Y and Z count behind G43.4 with a turned table"),
    ("tool-change-height", "the tool change of the machine brings Z up by itself"),
    ("tool-change-tilt", "the tool change of the machine turns the head upright by itself"),
    ("turn-height", "room for the part and the tool where rotary axes turn"),
];

/// Rules of [`ACCEPTABLE`] that are accepted: the program is proven all the same, and the report lists what was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Accepted(u32);

impl Accepted {
    /// These rules and `rule`.
    ///
    /// # Errors
    /// No rule of this name may be accepted.
    pub fn and(self, rule: &str) -> Result<Accepted, String> {
        match ACCEPTABLE.iter().position(|(name, _)| Rule::named(rule) == Some(Rule::from(*name))) {
            Some(index) => Ok(Accepted(self.0 | 1 << index)),
            None => {
                let all: Vec<&str> = ACCEPTABLE.iter().map(|(name, _)| *name).collect();
                Err(format!("no rule that may be accepted; these may: {}", all.join(", ")))
            }
        }
    }

    /// Their names.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let rules = ACCEPTABLE.iter().enumerate();
        rules.filter(move |(index, _)| self.0 & (1 << index) != 0).map(|(_, (name, _))| *name)
    }

    pub(crate) fn holds(self, rule: Rule) -> bool {
        self.names().any(|name| rule == name)
    }
}
