//! Keys that a machine's programs depend on, and that its file does not state: files that are older than a key lack it.

use crate::model::{Machine, Mount, OptionValue, OrientationMode};
use crate::option::OptionKey;

/// A key that a machine file lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The table that it stands in; empty for the top of the file.
    pub table: String,
    /// The line to add, with the value of a control as it is delivered, or an example where each machine has its own.
    pub line: String,
    /// Where on the control the value is read, and what depends on it.
    pub place: &'static str,
}

/// Keys of which no control is delivered with a value that may stay.
const OWN: [&str; 6] =
    ["safe_height", "work_zero", "point", "tip_kinematics", "axis_kinematics", "swivel_direction"];

impl Missing {
    /// The line below a comment that says where its value comes from.
    fn explained(&self) -> String {
        let key = self.line.split(' ').next().unwrap_or_default();
        let origin = match OWN.contains(&key) {
            true => "an example: write the value of your machine",
            false => "as delivered: read it on yours",
        };
        format!("# {}\n# ({origin})\n{}\n", self.place, self.line)
    }
}

/// The text of a machine file with the keys that it lacks, each in its table.
pub fn upgraded(text: &str, missing: &[Missing]) -> String {
    let mut lines: Vec<String> = text.lines().map(|line| format!("{line}\n")).collect();
    for key in missing {
        let place = match key.table.split_once("]] letter = ") {
            None => table(&lines, &key.table),
            Some((_, letter)) => rotary(&lines, letter),
        };
        match place {
            Some(at) => lines.insert(at, key.explained()),
            None if key.table.starts_with("[[") => {
                // The axis stands in a file that this one extends.
                let commented = key.explained().replace(&key.line, &format!("# {}", key.line));
                lines.push(format!("\n# In the file that has {}:\n{commented}", key.table));
            }
            None => lines.push(format!("\n{}\n{}", key.table, key.explained())),
        }
    }
    lines.concat()
}

/// Whether a line, outside of texts of several lines, begins a table.
pub(crate) fn is_header(line: &str) -> bool {
    line.trim_start().starts_with('[')
}

/// Whether a text of several lines begins or ends in a line.
pub(crate) fn turns_text(line: &str) -> bool {
    let count = |quotes| line.matches(quotes).count();
    (count("\"\"\"") + count("'''")) % 2 == 1
}

/// Where a new key of a table stands: at the top of the file behind the last key there, in a table before its first.
pub(crate) fn table(lines: &[String], table: &str) -> Option<usize> {
    match table {
        "" => {
            let first = lines.iter().position(|line| is_header(line));
            let end = first.unwrap_or(lines.len());
            let says =
                |line: &String| !line.trim().is_empty() && !line.trim_start().starts_with('#');
            Some(lines[..end].iter().rposition(says).map_or(end, |last| last + 1))
        }
        table => {
            let is = |line: &String| line.split('#').next().unwrap_or_default().trim() == table;
            lines.iter().position(is).map(|at| at + 1)
        }
    }
}

/// Where a key of the rotary axis of this letter (in quotes) stands: behind its letter.
fn rotary(lines: &[String], letter: &str) -> Option<usize> {
    let says = |line: &String| {
        let pair = line.split('#').next().and_then(|line| line.split_once('='));
        pair.is_some_and(|(key, value)| key.trim() == "letter" && value.trim() == letter)
    };
    lines.iter().position(says).map(|at| at + 1)
}

/// All keys that the file of `machine` lacks, in the order of their tables.
pub fn missing(machine: &Machine) -> Vec<Missing> {
    let mut all = Vec::new();
    let mut lacks = |table: String, line: &str, place| {
        all.push(Missing { table, line: line.to_owned(), place });
    };
    let retracts = machine.blocks.values().any(|block| block.text.contains("SAFE_HEIGHT"));
    if machine.safe_height.is_none() && retracts {
        lacks(
            String::new(),
            "safe_height = 0",
            "Z that the control shows in machine coordinates, homed and at its top (mm): retracts go there",
        );
    }
    let orientation = machine.orientation;
    let writes = |mode| [orientation.simultaneous, orientation.positioned].contains(&mode);
    let turns_axes =
        writes(OrientationMode::MachineAngles) || writes(OrientationMode::DynamicOffset);
    let follows_tip = writes(OrientationMode::ToolCenterAngles);
    let tilts = writes(OrientationMode::TiltedPlane);
    let turns_table = machine.rotary.iter().any(|axis| axis.on == Mount::Table);
    if turns_axes && machine.work_zero.is_none() && turns_table {
        lacks(
            String::new(),
            "work_zero = [0, 0, 0]",
            "G54 in machine coordinates (mm): every position on a turned table depends on how far the work is from its axes",
        );
    }
    if machine.reader == "linuxcnc" && follows_tip && machine.settings.kinematics.is_none() {
        lacks(
            "[settings]".into(),
            "tip_kinematics = 428",
            "the REMAP lines of the INI file: the M function that switches to the kinematics of the tip",
        );
        lacks(
            "[settings]".into(),
            "axis_kinematics = 429",
            "the REMAP lines of the INI file: the M function that switches back to those of the axes",
        );
    }
    let is_sinumerik = machine.reader.starts_with("sinumerik");
    let says_tolerance =
        matches!(machine.option(OptionKey::PathTolerance), Some(OptionValue::Number(_)));
    if is_sinumerik && !says_tolerance {
        lacks(
            "[options]".into(),
            "path_tolerance = 0.01",
            "MD33100 and MD33120 (mm): how far G642 to G645 and the compressors leave the path",
        );
    }
    if is_sinumerik && machine.settings.length_along_z.is_none() {
        lacks(
            "[settings]".into(),
            "length_along_z = false",
            "SD42940: true where it is 17; arcs of other planes than XY depend on it",
        );
    }
    let says_edge = machine.blocks.values().any(|block| block.text.contains("{{H}}"));
    if is_sinumerik && machine.settings.edge_at_change.is_none() && !says_edge {
        lacks(
            "[settings]".into(),
            "edge_at_change = 1",
            "MD20270: the edge that counts behind M6, since no block says D",
        );
    }
    if machine.reader == "mach3" && machine.settings.dwell_p_milliseconds.is_none() {
        lacks(
            "[settings]".into(),
            "dwell_p_milliseconds = false",
            "General Config, \"G04 Dwell param in Milliseconds\": true where it is ticked, with `P = { scale = 1000, decimals = 0 }` in [words]",
        );
    }
    if machine.reader == "fanuc" {
        if machine.settings.dwell_p_milliseconds.is_none() {
            lacks(
                "[settings]".into(),
                "dwell_p_milliseconds = true",
                "parameters 1013#1 and 1015#7: true where the first is 0 or the second is 1; cycles that dwell need it",
            );
        }
        if machine.settings.length_along_z.is_none() {
            lacks(
                "[settings]".into(),
                "length_along_z = true",
                "parameters 5001#0 and 5001#1: true where both are 0",
            );
        }
        if machine.settings.length_moves_axis.is_none() {
            lacks(
                "[settings]".into(),
                "length_moves_axis = true",
                "parameter 5006#6: true where it is 0; a block with G43, G43.4, G49 or another H then moves Z by the length",
            );
        }
    }
    if machine.reader == "haas" && machine.settings.retract_above_r.is_none() {
        lacks(
            "[settings]".into(),
            "retract_above_r = 0",
            "setting 52 (mm): how far above R G83 clears chips",
        );
    }
    if machine.settings.rapid_path.is_none() && machine.wire.is_none() {
        lacks(
            "[settings]".into(),
            "rapid_path = \"independent\"",
            "FANUC parameter 1401#1, SINUMERIK MD20730: \"linear\" where it is 1; else G0 goes by no straight line, and rapids near the part are refused",
        );
    }
    let compensates = machine.capabilities.compensation && machine.wire.is_none();
    if compensates && machine.settings.tool_radius.is_none() {
        lacks(
            "[settings]".into(),
            "tool_radius = \"full\"",
            "what the tool table keeps: the radius of the tool, or \"wear\", its difference from the tool of the toolpath; contours with compensation need it",
        );
    }
    if tilts && machine.reader == "fanuc" && machine.settings.tilt_within_travel.is_none() {
        lacks(
            "[settings]".into(),
            "tilt_within_travel = true",
            "parameters 19741 to 19744: true where they hold the travel of the rotary axes; which solution G53.1 takes depends on it",
        );
    }
    if tilts && machine.reader == "fanuc" && machine.settings.tilt_second_axis_first.is_none() {
        lacks(
            "[settings]".into(),
            "tilt_second_axis_first = false",
            "parameter 19608#5: true where it is 1; which solution G53.1 takes depends on it",
        );
    }
    if let Some(axis) = machine.rotary.first()
        && tilts
        && is_sinumerik
        && machine.settings.swivel_direction.is_none()
    {
        lacks(
            "[settings]".into(),
            &format!("swivel_direction = \"{}\"", axis.letter),
            "direction reference of the swivel data set ($TC_CARR37): the axis whose lower or higher position _DIR of CYCLE800 takes",
        );
    }
    if turns_axes && !machine.capabilities.inverse_time && machine.settings.rotary_feed.is_none() {
        lacks(
            "[settings]".into(),
            "rotary_feed = \"all-axes\"",
            "FANUC parameter 1408#0 is 0, HEIDENHAIN, SINUMERIK after FGROUP with the rotary axes: \"all-axes\"; LinuxCNC: \"linear-axes\"; F of a cut in which rotary axes turn depends on it",
        );
    }
    let rolls_over = machine.rotary.iter().any(|axis| axis.modulo != Some(false));
    if machine.reader == "fanuc" && rolls_over && machine.settings.rotary_by_sign.is_none() {
        lacks(
            "[settings]".into(),
            "rotary_by_sign = false",
            "parameter 1008#1 of the rotary axes: true where it is 1",
        );
    }
    if machine.reader == "fanuc"
        && follows_tip
        && turns_table
        && machine.settings.table_frame_at_zero.is_none()
    {
        lacks(
            "[settings]".into(),
            "table_frame_at_zero = true",
            "no parameter alone says it (19696#5): try G43.4 with a turned table at a point off its centre",
        );
    }
    for axis in &machine.rotary {
        let table = format!("[[rotary]] letter = \"{}\"", axis.letter);
        if turns_axes && !axis.is_placed {
            lacks(
                table.clone(),
                "point = [0, 0, 0]",
                "a point of the axis (mm): of a table in machine coordinates, of a head from the gauge point of the spindle",
            );
        }
        if axis.modulo.is_none() {
            lacks(
                table,
                "modulo = true",
                "SINUMERIK MD30310, FANUC parameter 1008#0, on a HEIDENHAIN a display that ends at 360 degrees",
            );
        }
    }
    all
}
