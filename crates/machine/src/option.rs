//! The options of machine files that the code reads itself, beside what templates read of them: each has its name here alone.

/// The options, with their names and, of numbers that are no mere texts of the templates, what they may be where they are not 0: the least, the
/// most, the unit.
macro_rules! options {
    ($($(#[$help:meta])* $option:ident $name:literal $range:expr;)+) => {
        /// An option that the code reads.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum OptionKey {
            $($(#[$help])* $option,)+
        }

        impl OptionKey {
            /// All of them.
            pub const ALL: &[OptionKey] = &[$(OptionKey::$option,)+];

            /// Its key below `[options]`.
            pub const fn name(self) -> &'static str {
                match self {
                    $(OptionKey::$option => $name,)+
                }
            }

            /// The least, the most and the unit, where it is bounded.
            const fn range(self) -> Option<(f64, f64, &'static str)> {
                match self {
                    $(OptionKey::$option => $range,)+
                }
            }
        }
    };
}

options! {
    /// How fast an arm accelerates, m/s².
    Acceleration "acceleration" None;
    /// The tool that is called where the source calls none.
    DefaultTool "default_tool" None;
    /// How fast the joints of an arm accelerate, rad/s².
    JointAcceleration "joint_acceleration" None;
    /// By how much the control may turn the tool while it smooths the path.
    OrientationTolerance "orientation_tolerance" Some((0.0, 45.0, "degrees"));
    /// How far the control may leave the path while it smooths it.
    PathTolerance "path_tolerance" Some((0.0, 10.0, "mm"));
    /// The number by which the control knows the program.
    ProgramNumber "program_number" None;
    /// Over the work zero, where tools retract to on a machine without switches.
    RetractHeight "retract_height" Some((0.0, 1000.0, "mm"));
    /// How far the control may leave the path in cuts for which the source itself says more.
    RoughingTolerance "roughing_tolerance" Some((0.0, 10.0, "mm"));
    /// The swivel data set that describes the machine.
    SwivelData "swivel_data" None;
    /// The feed of a touch-off. From 100 mm/min a tool goes on for up to 0.05 mm after it has touched, at 30 mm/s².
    TouchFeed "touch_feed" Some((1.0, 100.0, "mm/min"));
    /// The top of the plate over the work zero.
    TouchHeight "touch_height" Some((0.0, 1000.0, "mm"));
    /// Turns the touch-off of further tools on: how far below its plate a tool goes at most.
    TouchTravel "touch_travel" Some((0.5, 1000.0, "mm"));
    /// X of the plate in the work, mm.
    TouchX "touch_x" None;
    /// Y of the plate in the work, mm.
    TouchY "touch_y" None;
    /// How fast the tool of an arm may turn, degrees/s.
    TurnSpeed "turn_speed" None;
}

impl OptionKey {
    /// The one of this name; `None` for what templates alone read.
    pub fn named(name: &str) -> Option<OptionKey> {
        OptionKey::ALL.iter().copied().find(|option| option.name() == name)
    }
}

/// Why a number cannot be the value of that option.
pub(crate) fn wrong_option(name: &str, value: f64) -> Option<String> {
    let (good, need) = match OptionKey::named(name).and_then(OptionKey::range) {
        Some(range) => {
            let good = value == 0.0 || (range.0..=range.1).contains(&value);
            (good, needed(range))
        }
        None => (value.abs() <= 1e9, String::from("a number from -10^9 to 10^9")),
    };
    (!good).then(|| format!("{value:?} is given, and {need} is needed"))
}

/// Why what is no number cannot be the value of that option, where its numbers are bounded.
pub(crate) fn no_number(name: &str, given: &str) -> Option<String> {
    let range = OptionKey::named(name)?.range()?;
    Some(format!("{given} is given, and {} is needed", needed(range)))
}

/// The numbers of a range: the least besides 0, the most and the unit.
fn needed((least, most, unit): (f64, f64, &str)) -> String {
    let none = if least > 0.0 { "0, or " } else { "" };
    format!("{none}a number from {least} to {most} {unit}")
}
