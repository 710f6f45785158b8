//! The settings of the virtual control of a machine.

use control::{Dialect, FeedPath, Settings, Setup, StartModes, TableAxis, Wire};
use machine::{Machine, Mount, RotaryFeed, StartMode};
use program::{Diagnostic, Outcome, Rule};

/// The settings of the virtual control of `machine`, with what the operator has set up.
///
/// # Errors
/// `reader` where there is no control of the name that the machine file gives.
pub fn settings(machine: &Machine, setup: Setup) -> Outcome<Settings> {
    let Some(dialect) = Dialect::named(&machine.reader) else {
        let message = format!("there is no virtual control `{}`", machine.reader);
        let names = Dialect::NAMES.map(|(name, _)| name).join(", ");
        let place = &machine.reader_place;
        return Err(Diagnostic::error(Rule::Reader, message)
            .help(format!("`reader` is one of {names}"))
            .file(&place.file)
            .line(place.line)
            .into());
    };
    Ok(settings_in(dialect, machine, setup))
}

/// Where the table of `machine` turns, as its control has measured it; `None` where the file does not say it.
fn table_axes(machine: &Machine) -> Option<Vec<TableAxis>> {
    let zero = machine.work_zero?;
    let mut axes: Vec<TableAxis> = Vec::new();
    for axis in machine.rotary.iter().rev() {
        if axis.on != Mount::Table || !axis.is_placed {
            return None;
        }
        axes.push(TableAxis {
            index: axis.index(),
            point: axis.point - zero,
            axis: axis.axis * axis.sign,
            offset: axis.offset,
        });
    }
    Some(axes)
}

fn start_modes(stated: &[StartMode]) -> StartModes {
    StartModes {
        plane_xy: stated.contains(&StartMode::G17),
        absolute: stated.contains(&StartMode::G90),
        feed_per_minute: stated.contains(&StartMode::G94),
        centers_from_start: stated.contains(&StartMode::G91Dot1),
        metric: stated.contains(&StartMode::G71),
        returns_up: stated.contains(&StartMode::G98),
        first_offset: stated.contains(&StartMode::G54),
    }
}

/// The settings of a virtual control with the axes of `machine` that reads `dialect`, as [`settings`].
pub fn settings_in(dialect: Dialect, machine: &Machine, setup: Setup) -> Settings {
    let (mut rotary, mut table, mut modulo) = ([false; 3], [false; 3], [None; 3]);
    for axis in &machine.rotary {
        rotary[axis.index()] = true;
        table[axis.index()] = axis.on == Mount::Table;
        modulo[axis.index()] = axis.modulo;
    }
    let clamps = machine.rotary.iter().filter_map(|axis| axis.clamp);
    let clamps = clamps.flat_map(|clamp| [clamp.open, clamp.close]);
    Settings {
        auxiliary: machine.auxiliary.iter().copied().chain(clamps).collect(),
        coolant: machine.coolant,
        modulo,
        floating_holder: machine.settings.floating_holder,
        retract_above_r: machine.settings.retract_above_r,
        start_modes: start_modes(&machine.settings.start_modes),
        edge_at_change: machine.settings.edge_at_change,
        length_along_z: machine.settings.length_along_z,
        length_moves_axis: machine.settings.length_moves_axis,
        dwell_p_milliseconds: machine.settings.dwell_p_milliseconds,
        rotary_by_sign: machine.settings.rotary_by_sign,
        table,
        table_axes: table_axes(machine),
        table_frame_at_zero: machine.settings.table_frame_at_zero,
        sets_work_offsets: machine.settings.sets_work_offsets,
        operator_parameters: machine.operator_parameters.clone(),
        tool_change: machine.cell.as_ref().map(|cell| cell.tool_change.clone()).unwrap_or_default(),
        own_frame: machine.cell.as_ref().and_then(|cell| cell.own_frame),
        signals: ["SIGNAL", "CHANNEL"]
            .map(|word| machine.words.get(word).map_or("", |word| word.address.trim()).to_owned()),
        wire: machine.wire.map_or(Wire::default(), |wire| Wire {
            height: wire.height,
            thread: wire.thread,
            cut: wire.cut,
        }),
        kinematics: machine
            .settings
            .kinematics
            .map(|k| control::Kinematics { tip: k.tip, axes: k.axes }),
        swivel_data: machine.swivel_data().to_owned(),
        path_tolerance: machine.path_tolerance(),
        orientation_tolerance: machine.orientation_tolerance(),
        setup,
        ..Settings::new(dialect, rotary)
    }
}

/// Along which path the control of `machine` counts the feed until a program states it. Where a parameter of the control
/// decides, the machine file may state it.
pub fn feed_path(machine: &Machine) -> FeedPath {
    feed_path_in(Dialect::named(&machine.reader), machine)
}

/// The same of a control that reads `dialect`.
pub(crate) fn feed_path_in(dialect: Option<Dialect>, machine: &Machine) -> FeedPath {
    let path = dialect.map_or(FeedPath::AsSetUp, Dialect::feed_path);
    match (path, machine.settings.rotary_feed) {
        (FeedPath::AsSetUp, Some(RotaryFeed::AllAxes)) => FeedPath::AllAxes,
        (FeedPath::AsSetUp, Some(RotaryFeed::LinearAxes)) => FeedPath::LinearAxes,
        (path, _) => path,
    }
}
