//! Keys that a machine's file states and that do nothing there: nobody should rely on them.

use crate::catalogue::{BlockName, WordName};
use crate::template::Templates;
use machine::{Machine, OptionKey, OptionValue, OrientationMode, RapidPath, StatedKey};
use program::{Diagnostic, Rule};

/// Parameters that are one family of controls' own, by the beginnings of `reader`.
const SETTINGS_OF: [(&str, &[&str]); 9] = [
    ("dwell_p_milliseconds", &["fanuc", "mach3"]),
    ("edge_at_change", &["sinumerik"]),
    ("length_along_z", &["fanuc", "sinumerik"]),
    ("length_moves_axis", &["fanuc"]),
    ("rotary_by_sign", &["fanuc"]),
    ("swivel_direction", &["sinumerik"]),
    ("table_frame_at_zero", &["fanuc"]),
    ("tilt_second_axis_first", &["fanuc"]),
    ("tilt_within_travel", &["fanuc"]),
];

/// Parameters of rotary axes.
const OF_ROTARY: [&str; 6] = [
    "rotary_by_sign",
    "rotary_feed",
    "swivel_direction",
    "table_frame_at_zero",
    "tilt_second_axis_first",
    "tilt_within_travel",
];

/// Parameters of tilted planes.
const OF_TILTED_PLANES: [&str; 3] =
    ["swivel_direction", "tilt_second_axis_first", "tilt_within_travel"];

/// Capabilities that robots alone have.
const OF_ROBOTS: [&str; 5] =
    ["arc_sweep", "fits_corners", "program_bytes", "program_lines", "program_points"];

/// A warning (`no-effect`) for each key that the nearest file of `machine`, or another one of the user's, states and that changes neither a
/// program nor its proof, with its place and, where there is one, what gives it an effect. None where its templates do not compile.
pub fn without_effect(machine: &Machine) -> Vec<Diagnostic> {
    let Ok(templates) = Templates::compile(machine) else { return Vec::new() };
    let about = |stated: &StatedKey| {
        let (message, help) = idle(machine, &templates, stated)?;
        let found = Diagnostic::warning(Rule::NoEffect, message);
        let found = found.file(stated.place.file.clone()).line(stated.place.line);
        Some(if help.is_empty() { found } else { found.help(help) })
    };
    machine.loaded_from.keys.iter().filter_map(about).collect()
}

/// That a key does nothing and why, and what gives it an effect.
fn idle(machine: &Machine, templates: &Templates, stated: &StatedKey) -> Option<(String, String)> {
    let key = stated.key.as_str();
    let says = |why: &str| Some((format!("`{key}` has no effect: {why}"), String::new()));
    let places = |word: WordName| templates.words().any(|(placed, _)| placed == word);
    let (is_robot, is_wire) = (machine.arm.is_some(), machine.wire.is_some());
    match stated.table.as_str() {
        "" if is_robot
            && ["approach", "auxiliary", "operator_parameters", "safe_height", "work_zero"]
                .contains(&key) =>
        {
            says("a robot has a place in its cell (`part`), and no axes of a mill")
        }
        table @ ("axes" | "coolant" | "orientation" | "settings") if is_robot => {
            says(&format!("[{table}] is for mills"))
        }
        "spindle" | "tools" | "coolant" if is_wire => says("a wire has no spindle"),
        "" if key == "safe_height" && !places(WordName::SafeHeight) => Some(safe_height(machine)),
        "capabilities" if !is_robot && OF_ROBOTS.contains(&key) => says("it is for robots"),
        "options"
            if OptionKey::named(key).is_none() && !templates.reads(&format!("options.{key}")) =>
        {
            says("no block of this machine reads this option")
        }
        "settings" => says(&setting(machine, key)?),
        "cell" => {
            let word = match key {
                "own_frame" => WordName::OwnFrame,
                "load_number" => WordName::LoadNumber,
                "load_mass" | "load_center" => WordName::LoadMass,
                _ => return None,
            };
            if places(word) { None } else { says("no block of this control says it") }
        }
        "words" => {
            let can = &machine.capabilities;
            // Forms of F, which is what blocks place.
            let forms = [
                (WordName::FeedPerTurn, can.feed_per_turn),
                (WordName::FeedInverse, can.inverse_time),
                (WordName::FeedFine, is_robot),
            ];
            let word = WordName::named(key)?;
            let form = forms.into_iter().find(|(form, _)| *form == word);
            if form.map_or_else(|| places(word), |(_, is_written)| is_written) {
                None
            } else {
                says("no block of this machine places this word")
            }
        }
        _ => None,
    }
}

/// Retracts do not go to the safe height: which option would have them do it.
fn safe_height(machine: &Machine) -> (String, String) {
    let message = "no retract goes to `safe_height`: no block of this machine does; only moves of the source in machine coordinates are compared with it";
    let other = |(name, value): (&String, &OptionValue)| {
        let (value, text) = match value {
            OptionValue::Flag(flag) => (OptionValue::Flag(!flag), (!flag).to_string()),
            OptionValue::Number(number) if *number != 0.0 => (OptionValue::Number(0.0), "0".into()),
            OptionValue::Number(_) | OptionValue::Text(_) => return None,
        };
        let mut changed = machine.clone();
        changed.options.insert(name.clone(), value);
        let templates = Templates::compile(&changed).ok()?;
        let goes = templates.places(BlockName::Retract, WordName::SafeHeight);
        goes.then(|| format!("`{name} = {text}` below [options]: retracts then go to it"))
    };
    (String::from(message), machine.options.iter().find_map(other).unwrap_or_default())
}

/// Why a parameter of the control does nothing; `None` where it may do something.
fn setting(machine: &Machine, key: &str) -> Option<String> {
    let of = SETTINGS_OF.iter().find(|(name, _)| *name == key).map(|(_, families)| *families);
    if let Some(families) = of
        && !families.iter().any(|family| machine.reader.starts_with(family))
    {
        let families = families.join(" and ");
        return Some(format!(
            "it is a parameter of {families}, and `reader` is {}",
            machine.reader
        ));
    }
    let modes = [machine.orientation.simultaneous, machine.orientation.positioned];
    let why = if OF_ROTARY.contains(&key) && machine.rotary.is_empty() {
        "the machine has no rotary axis"
    } else if OF_TILTED_PLANES.contains(&key) && !modes.contains(&OrientationMode::TiltedPlane) {
        "the machine writes no tilted plane"
    } else if key == "high_feed" && machine.settings.rapid_path == Some(RapidPath::Linear) {
        "rapids go straight on this machine (`rapid_path`), and none is written with a feed"
    } else {
        return None;
    };
    Some(String::from(why))
}
