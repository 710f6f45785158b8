//! Rules that whoever posts a program may let pass for one run: each depends on how the machine is set up, which the
//! program does not say.

use program::Rule;

/// The rules that may be accepted, each with what its acceptance answers for.
pub const ACCEPTABLE: [(Rule, &str); 27] = [
    (Rule::AdaptiveFeed, "an input of the machine multiplies the feed"),
    (Rule::AxisDynamics, "axes may be faster than their machine data allow"),
    (Rule::DwellUnit, "what a dwell counts in"),
    (Rule::FloatingTap, "taps are held in a floating chuck"),
    (Rule::Gear, "in which gear the spindle reaches its speeds"),
    (Rule::LeaningRetract, "a retract along the tool brings Z to its end"),
    (Rule::LeftOn, "what the program leaves on for the next one"),
    (Rule::LengthChange, "Z moves by the tool length where parameter 5006#6 is 0"),
    (Rule::LengthPlane, "along which axis the tool length counts in G18 and G19"),
    (Rule::LineEnd, "the control takes a last block without a line end"),
    (Rule::OperatorControls, "the operator can neither stop the program nor slow it down"),
    (Rule::OperatorData, "work offsets and tool data that the program rewrites"),
    (
        Rule::OrientationTolerance,
        "the tool may lean otherwise by more than the machine's file allows",
    ),
    (Rule::OrientationWay, "how the tool turns within a block while the control keeps its tip"),
    (Rule::PathTolerance, "corners may be cut by more than the machine's file allows"),
    (Rule::ProgramRepeats, "the program begins again at its end, without end"),
    (Rule::RapidPath, "room for the tool where it goes by rapid on another path than the source"),
    (Rule::ReplacementTool, "where and how the control changes a tool whose life is over"),
    (Rule::RotaryWay, "which way the rotary axes turn"),
    (Rule::StopRunning, "M0 and M1 of the machine stop spindle and coolant, M6 the coolant"),
    (Rule::StoredPosition, "where the stored position is to which Z goes"),
    (Rule::SwivelData, "the data set that the program names is that of this kinematics"),
    (Rule::TableFrame, "in which frame X, Y and Z count behind G43.4 with a turned table"),
    (Rule::ToolChangeHeight, "the tool change of the machine brings Z up by itself"),
    (Rule::ToolChangeTilt, "the tool change of the machine turns the head upright by itself"),
    (Rule::ToolEdge, "which edge of the tool counts behind M6"),
    (Rule::TurnHeight, "room for the part and the tool where rotary axes turn"),
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
        match ACCEPTABLE.iter().position(|(known, _)| Rule::named(rule).contains(known)) {
            Some(index) => Ok(Accepted(self.0 | 1 << index)),
            None => {
                let all: Vec<&str> = ACCEPTABLE.iter().map(|(rule, _)| rule.name()).collect();
                Err(format!("no rule that may be accepted; these may: {}", all.join(", ")))
            }
        }
    }

    /// The accepted ones.
    pub fn rules(self) -> impl Iterator<Item = Rule> {
        let rules = ACCEPTABLE.iter().enumerate();
        rules.filter(move |(index, _)| self.0 & (1 << index) != 0).map(|(_, (rule, _))| *rule)
    }

    pub(crate) fn holds(self, rule: Rule) -> bool {
        self.rules().any(|accepted| accepted == rule)
    }
}
