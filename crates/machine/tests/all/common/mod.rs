//! Machines for the tests of kinematics: three linear axes and the rotary axes given.

use geom::Vec3;
use std::collections::BTreeMap;
use toolpost_machine::*;

pub fn machine(rotary: Vec<RotaryAxis>) -> Machine {
    let linear = LinearAxis {
        min: -500.0,
        max: 500.0,
        rapid: Some(30_000.0),
        acceleration: 5.0,
        ..LinearAxis::default()
    };
    Machine {
        name: "test".into(),
        file: "test.toml".into(),
        loaded_from: Default::default(),
        title: "Test".into(),
        control: "iso".into(),
        reader: "fanuc".into(),
        reader_place: FileLocation::default(),
        extension: "nc".into(),
        capabilities: Capabilities {
            arcs: vec![Plane::XY],
            helix: true,
            full_circle: true,
            arc_tolerance: 0.01,
            cycles: Vec::new(),
            compensation: true,
            compensation_start: CompensationStart::NextStart,
            compensation_blind: None,
            feed_per_turn: true,
            inverse_time: true,
            inverse_time_arcs: true,
            length_offset: LengthOffset::Implicit,
            straight_tip_rapids: false,
            line_length: 120,
            lowering_tolerance: 0.01,
            rapid_corridor: 0.1,
            rapid_clearance: 1.0,
            fits_corners: false,
            arc_sweep: std::f64::consts::PI,
            program_lines: usize::MAX,
            program_bytes: usize::MAX,
            program_points: usize::MAX,
        },
        settings: ControlSettings::default(),
        format: Format {
            separator: " ".into(),
            line_end: "\n".into(),
            comment_start: "(".into(),
            comment_end: ")".into(),
            fresh_operations: false,
            comment_signs: " ".into(),
            comment_length: 96,
        },
        words: BTreeMap::new(),
        blocks: BTreeMap::new(),
        linear: [linear; 3],
        rotary,
        work_zero: Some(Vec3::ZERO),
        safe_height: None,
        wire: None,
        arm: None,
        cell: None,
        orientation: OrientationSettings {
            simultaneous: OrientationMode::MachineAngles,
            positioned: OrientationMode::MachineAngles,
            tolerance: 0.01,
        },
        spindle: SpindleRange { min: 50.0, max: 12_000.0, dwell: 0.0 },
        feed_max: f64::INFINITY,
        tools: ToolRange {
            max_number: 99,
            max_diameter: 80.0,
            max_length: 300.0,
            retracts: false,
            turns_upright: false,
        },
        coolant: Default::default(),
        auxiliary: Vec::new(),
        operator_parameters: Vec::new(),
        approach: Vec::new(),
        options: BTreeMap::new(),
        bodies: Vec::new(),
    }
}

/// An axis through the origin that turns for ever.
pub fn axis(letter: char, on: Mount, direction: Vec3, sign: f64) -> RotaryAxis {
    RotaryAxis {
        letter,
        on,
        axis: direction.normalize(),
        point: Vec3::ZERO,
        is_placed: true,
        sign,
        offset: 0.0,
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
        rapid: 10_800.0,
        acceleration: 500.0,
        modulo: None,
        clamp: None,
        prefer: 0.0,
    }
}

pub fn within(min: f64, max: f64, axis: RotaryAxis) -> RotaryAxis {
    RotaryAxis { min, max, ..axis }
}

pub fn prefer(sign: f64, axis: RotaryAxis) -> RotaryAxis {
    RotaryAxis { prefer: sign, ..axis }
}

/// The trunnion of `cldata-sinumerik.md`, section 3: A carries C, both carry the part.
pub fn table_ac() -> Machine {
    let a = within(-120.0, 180.0, axis('A', Mount::Table, Vec3::X, 1.0));
    machine(vec![prefer(1.0, a), axis('C', Mount::Table, Vec3::Z, -1.0)])
}
