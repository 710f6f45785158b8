//! The kinematic chain of a machine, for rows of poses.

use geom::{Vec3, direction};
use machine::Machine;
use program::{Diagnostic, Rule};

/// Two tables, row after row.
type Tables = (Vec<f64>, Vec<f64>);

/// The positions of the linear axes (mm) and of the rotary axes that there are (degrees) for tool tips and
/// tool axes.
///
/// # Errors
/// The first row that cannot be reached, or says nothing.
pub fn inverse(
    machine: &Machine,
    points: &[[f64; 3]],
    axes: &[[f64; 3]],
    tool_length: f64,
) -> Result<Tables, Box<Diagnostic>> {
    same_length(points.len(), axes.len())?;
    let mut linear = Vec::with_capacity(3 * points.len());
    let mut rotary = Vec::with_capacity(machine.rotary.len() * points.len());
    for (index, (point, axis)) in points.iter().zip(axes).enumerate() {
        let [point, axis] = [finite(index, point)?, finite(index, axis)?];
        let axis = direction(axis)
            .ok_or_else(|| row(Rule::ZeroVector, index, "the tool axis has no direction"))?;
        let solutions = machine.inverse(axis).map_err(|far| {
            let away = far.deviation.to_degrees();
            let message = format!("the nearest tool axis in reach is {away:.4} degrees away");
            row(Rule::UnreachableOrientation, index, message)
        })?;
        let degrees = solutions.degrees[0];
        linear.extend(machine.linear_for(point, degrees, tool_length).to_array());
        rotary.extend(machine.rotary.iter().map(|axis| degrees[axis.index()]));
    }
    Ok((linear, rotary))
}

/// The tool tips and tool axes at positions of the linear and rotary axes.
///
/// # Errors
/// The first row that says nothing.
pub fn forward(
    machine: &Machine,
    linear: &[[f64; 3]],
    rotary: &[[f64; 3]],
    tool_length: f64,
) -> Result<Tables, Box<Diagnostic>> {
    same_length(linear.len(), rotary.len())?;
    let mut points = Vec::with_capacity(3 * linear.len());
    let mut axes = Vec::with_capacity(3 * linear.len());
    for (index, (linear, rotary)) in linear.iter().zip(rotary).enumerate() {
        let [linear, rotary] = [finite(index, linear)?, finite(index, rotary)?];
        let mut degrees = [0.0; 3];
        for (axis, angle) in machine.rotary.iter().zip(rotary.to_array()) {
            degrees[axis.index()] = angle;
        }
        let (point, axis) = machine.forward(linear, degrees, tool_length);
        points.extend(point.to_array());
        axes.extend(axis.to_array());
    }
    Ok((points, axes))
}

/// Every pose has a row in both arrays.
fn same_length(a: usize, b: usize) -> Result<(), Box<Diagnostic>> {
    match a == b {
        true => Ok(()),
        false => {
            let message = format!("{a} rows in one array, {b} in the other");
            Err(Diagnostic::error(Rule::ArrayShape, message).into())
        }
    }
}

fn finite(index: usize, [x, y, z]: &[f64; 3]) -> Result<Vec3, Box<Diagnostic>> {
    let values = Vec3::new(*x, *y, *z);
    match values.is_finite() {
        true => Ok(values),
        false => Err(row(Rule::Number, index, format!("({x}, {y}, {z}) is not finite"))),
    }
}

/// What is wrong with row `index` (from 0) of an array.
fn row(rule: Rule, index: usize, message: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::error(rule, format!("row {index}: {message}")).into()
}
