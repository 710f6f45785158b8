//! What a control says of itself: LinuxCNC's predefined parameters, FANUC's system variables.
//!
//! What only the machine knows is an error that says so.

use super::state::{Length, State};
use crate::iso::language::parameters::{System, Values, is_ngc_name};
use crate::iso::language::words::{FeedMode, Motion, Plane};
use program::{Compensation, Coolant, Spindle};

impl System for State {
    fn ngc_parameter(&self, values: &Values, number: u32) -> Result<f64, String> {
        ngc_parameter(self, values, number)
    }

    fn ngc_named(&self, values: &Values, name: &[u8]) -> Option<Result<f64, String>> {
        ngc_named(self, values, name)
    }

    fn macro_variable(&self, values: &Values, number: u32) -> Result<f64, String> {
        macro_variable(self, values, number)
    }
}

/// LinuxCNC's parameters from 5001 on ("Numbered Parameters").
fn ngc_parameter(state: &State, values: &Values, number: u32) -> Result<f64, String> {
    match number {
        5420..=5428 => position(state, number - 5420),
        5220 => match state.work_offset {
            Some(offset) => Ok(f64::from(offset) - 53.0),
            None => fresh(values, 1.0, "which work offset is active"),
        },
        5161..=5169 | 5181..=5189 if state.homes.iter().all(|home| home.is_nan()) => {
            fresh(values, 0.0, "where the reference position is")
        }
        5210..=5219 | 5221..=5390 if state.frames.is_fresh() => {
            fresh(values, 0.0, "how large the offset is")
        }
        5161..=5169 | 5181..=5189 | 5210..=5219 | 5221..=5390 => {
            Err("what the program has written there is kept in the machine's unit".into())
        }
        5400 => tool_number(state, values),
        5401..=5413 => match state.tool {
            None | Some(0) => fresh(values, 0.0, "which tool is in the spindle"),
            Some(_) => Err("the tool table counts in the units of the machine".into()),
        },
        5599 => Ok(1.0),
        5061..=5070 => match (state.probed, number) {
            (Some(probed), 5061..=5063) => Ok(probed[number as usize - 5061]),
            _ => Err("the result of probing is known only at the machine".into()),
        },
        5399 => Err("what M66 has read is known only at the machine".into()),
        5600 | 5601 => Err("the tool changer's fault is known only at the machine".into()),
        _ => Err(format!("there is no parameter #{number} that can be read")),
    }
}

/// LinuxCNC's predefined named parameters; none where there is none of that name.
fn ngc_named(state: &State, values: &Values, name: &[u8]) -> Option<Result<f64, String>> {
    let yes = |holds: bool| f64::from(u8::from(holds));
    let units = |inches: bool| match state.inches {
        Some(is_inches) => Ok(yes(is_inches == inches)),
        None => Err("neither G20 nor G21 has been given".into()),
    };
    let turns = match state.spindle {
        Spindle::Off => None,
        Spindle::Clockwise(_) => Some(true),
        Spindle::CounterClockwise(_) => Some(false),
    };
    Some(Ok(match name {
        b"_x" => return Some(position(state, 0)),
        b"_y" => return Some(position(state, 1)),
        b"_z" => return Some(position(state, 2)),
        b"_a" => return Some(position(state, 3)),
        b"_b" => return Some(position(state, 4)),
        b"_c" => return Some(position(state, 5)),
        b"_u" | b"_v" | b"_w" => return Some(position(state, 6)),
        b"_metric" => return Some(units(false)),
        b"_imperial" => return Some(units(true)),
        b"_feed" => return Some(feed(state, values)),
        b"_rpm" => match state.speed {
            Some(speed) => speed,
            None => return Some(fresh(values, 0.0, "the speed")),
        },
        b"_current_tool" => return Some(tool_number(state, values)),
        b"_selected_tool" => state.selected.map_or(-1.0, f64::from),
        b"_plane" => f64::from(plane_word(state.plane)) * 10.0,
        b"_absolute" => yes(!state.incremental),
        b"_incremental" => yes(state.incremental),
        b"_inverse_time" => yes(state.feed_mode == FeedMode::InverseTime),
        b"_units_per_minute" => yes(state.feed_mode == FeedMode::PerMinute),
        b"_units_per_rev" => yes(state.feed_mode == FeedMode::PerTurn),
        b"_coord_system" => match state.work_offset {
            Some(offset @ 54..=59) => f64::from(offset) * 10.0,
            // G59.1 to G59.3.
            Some(offset) => f64::from(offset) + 531.0,
            None => return Some(fresh(values, 540.0, "which work offset is active")),
        },
        b"_ccomp" => match state.compensation.asked {
            Compensation::Off => 400.0,
            Compensation::Left(_) => 410.0,
            Compensation::Right(_) => 420.0,
        },
        b"_tool_offset" => yes(state.length != Length::None),
        b"_retract_r_plane" | b"_retract_old_z" => match state.return_to_r {
            // The manual's names and numbers are crossed; the interpreter's names are right.
            Some(to_r) => yes(to_r == (name == b"_retract_r_plane")),
            None => return Some(Err("neither G98 nor G99 has been given".into())),
        },
        b"_ijk_absolute_mode" => yes(state.centers_absolute),
        b"_motion_mode" => return Some(motion_word(state).map(|word| word * 10.0)),
        b"_spindle_on" => yes(turns.is_some()),
        b"_spindle_cw" => yes(turns == Some(true)),
        b"_spindle_rpm_mode" => yes(state.surface.is_none()),
        b"_spindle_css_mode" => yes(state.surface.is_some()),
        b"_lathe_radius_mode" => 1.0,
        b"_lathe_diameter_mode" => 0.0,
        b"_mist" => yes(state.coolant == Coolant::Mist),
        b"_flood" => yes(state.coolant == Coolant::Flood),
        b"_value" => values.parameters.returned.unwrap_or(0.0),
        b"_value_returned" => yes(values.parameters.returned.is_some()),
        b"_call_level" => values.parameters.level() as f64,
        b"_remap_level" => 0.0,
        // What is followed is what the machine does, not what its preview shows.
        b"_task" => 1.0,
        b"_line" => f64::from(values.line),
        b"_vmajor" => 2.9,
        b"_vminor" => 0.0,
        _ if is_ngc_name(name) => {
            let name = String::from_utf8_lossy(name);
            return Some(Err(format!("what #<{name}> holds is known only at the machine")));
        }
        _ => return None,
    }))
}

/// FANUC's system variables that follow from the program (B-63684EN, 16.2).
fn macro_variable(state: &State, values: &Values, number: u32) -> Result<f64, String> {
    Ok(match number {
        4001 => return motion_word(state),
        4002 => f64::from(plane_word(state.plane)),
        4003 => 90.0 + f64::from(u8::from(state.incremental)),
        4005 => match state.feed_mode {
            FeedMode::InverseTime => 93.0,
            FeedMode::PerMinute => 94.0,
            FeedMode::PerTurn => 95.0,
        },
        4006 => match state.inches {
            Some(inches) => 21.0 - f64::from(u8::from(inches)),
            None => return Err("neither G20 nor G21 has been given".into()),
        },
        4007 => match state.compensation.asked {
            Compensation::Off => 40.0,
            Compensation::Left(_) => 41.0,
            Compensation::Right(_) => 42.0,
        },
        4010 => match state.return_to_r {
            Some(to_r) => 98.0 + f64::from(u8::from(to_r)),
            None => return Err("neither G98 nor G99 has been given".into()),
        },
        4014 => match state.work_offset {
            Some(offset @ 54..=59) => f64::from(offset),
            Some(_) => return Err("a further work offset has no G word of its own".into()),
            None => return Err("no block has named a work offset".into()),
        },
        4107 => match state.registers.d {
            Some(register) => f64::from(register),
            None => return Err("no block has given D".into()),
        },
        4109 => return feed(state, values),
        4111 => match state.registers.h {
            Some(register) => f64::from(register),
            None => return Err("no block has given H".into()),
        },
        4119 => match state.speed {
            Some(speed) => speed,
            None => return Err("no block has given S".into()),
        },
        4120 => match state.selected {
            Some(tool) => f64::from(tool),
            None => return Err("no block has given T".into()),
        },
        // Axis by axis; which axes beyond the third there are is the machine's. At the end of the last
        // block and now are the same where no block runs.
        5001..=5003 => return position(state, number - 5001),
        5041..=5043 => return position(state, number - 5041),
        5021..=5026 => return Err("a machine position is known only at the machine".into()),
        5061..=5066 => return Err("where G31 was stopped is known only at the machine".into()),
        2001..=2999 | 10001..=14999 | 5081..=5086 => {
            return Err("tool offsets are set up at the machine".into());
        }
        5201..=5326 | 7001..=7956 => return Err("work offsets are set up at the machine".into()),
        1000..=1199 => return Err("signals are known only at the machine".into()),
        3001 | 3002 | 3011 | 3012 => return Err("clocks run at the machine".into()),
        3901 | 3902 => return Err("the number of parts is counted at the machine".into()),
        _ => return Err(format!("#{number} is not a variable whose value is known")),
    })
}

/// The programmed position of an axis in units of the program: 0 is X, 3 is A, 6 is U.
fn position(state: &State, axis: u32) -> Result<f64, String> {
    if state.compensation.asked != Compensation::Off
        || state.compensation.active != Compensation::Off
    {
        return Err("a position cannot be read while radius compensation is on".into());
    }
    let value = match axis {
        0..=2 => state.position[axis as usize] / unit(state)?,
        3..=5 => state.rotary[axis as usize - 3],
        _ => 0.0,
    };
    if value.is_finite() {
        return Ok(value);
    }
    let letter = char::from(b"XYZABC"[axis.min(5) as usize]);
    Err(format!("where {letter} stands is not known here"))
}

/// mm in the unit of the program.
fn unit(state: &State) -> Result<f64, String> {
    match state.inches {
        Some(true) => Ok(geom::INCH),
        Some(false) => Ok(1.0),
        None => Err("a length, and neither G20 nor G21 has been given".into()),
    }
}

/// F as it was written last: another unit does not change the number (`rs274`).
fn feed(state: &State, values: &Values) -> Result<f64, String> {
    match state.f {
        Some(f) => Ok(f),
        None => fresh(values, 0.0, "the feed"),
    }
}

fn tool_number(state: &State, values: &Values) -> Result<f64, String> {
    match state.tool {
        Some(tool) => Ok(f64::from(tool)),
        None => fresh(values, 0.0, "which tool is in the spindle"),
    }
}

/// `value` where the control has just been switched on and everything in it is 0.
fn fresh(values: &Values, value: f64, what: &str) -> Result<f64, String> {
    if values.fresh {
        return Ok(value);
    }
    Err(format!("{what} is set up at the machine; no block has said it"))
}

/// The G word of a plane.
fn plane_word(plane: Plane) -> u8 {
    match plane {
        Plane::Xy => 17,
        Plane::Zx => 18,
        Plane::Yz => 19,
    }
}

/// The G word of the active motion; 80 for none.
fn motion_word(state: &State) -> Result<f64, String> {
    if state.cycle.is_some() {
        return Err("the motion word is that of a cycle; write G80 first".into());
    }
    Ok(match state.motion {
        Some(Motion::Rapid) => 0.0,
        Some(Motion::Line) => 1.0,
        Some(Motion::Arc { clockwise: true }) => 2.0,
        Some(Motion::Arc { clockwise: false }) => 3.0,
        Some(Motion::Thread) => 33.0,
        Some(Motion::RigidTap) => 33.1,
        Some(Motion::Spline { cubic: true }) => 5.0,
        Some(Motion::Spline { cubic: false }) => 5.1,
        Some(Motion::Nurbs) => 5.2,
        Some(Motion::EndOfNurbs) => 5.3,
        Some(Motion::Probe { away: false, must_answer: true }) => 38.2,
        Some(Motion::Probe { away: false, must_answer: false }) => 38.3,
        Some(Motion::Probe { away: true, must_answer: true }) => 38.4,
        Some(Motion::Probe { away: true, must_answer: false }) => 38.5,
        None => 80.0,
    })
}
