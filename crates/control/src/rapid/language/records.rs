//! Data types of RAPID: their parts, and what the control itself has defined of them.

use super::value::{Name, Value};

/// A type and its parts, each with its own type.
type Record = (&'static str, &'static [(&'static str, &'static str)]);

const NUM: &str = "NUM";

/// The records that are read ("Data types" of the RAPID manual).
const RECORDS: &[Record] = &[
    ("POS", &[("X", NUM), ("Y", NUM), ("Z", NUM)]),
    ("ORIENT", &[("Q1", NUM), ("Q2", NUM), ("Q3", NUM), ("Q4", NUM)]),
    ("POSE", &[("TRANS", "POS"), ("ROT", "ORIENT")]),
    ("CONFDATA", &[("CF1", NUM), ("CF4", NUM), ("CF6", NUM), ("CFX", NUM)]),
    (
        "EXTJOINT",
        &[
            ("EAX_A", NUM),
            ("EAX_B", NUM),
            ("EAX_C", NUM),
            ("EAX_D", NUM),
            ("EAX_E", NUM),
            ("EAX_F", NUM),
        ],
    ),
    (
        "ROBJOINT",
        &[
            ("RAX_1", NUM),
            ("RAX_2", NUM),
            ("RAX_3", NUM),
            ("RAX_4", NUM),
            ("RAX_5", NUM),
            ("RAX_6", NUM),
        ],
    ),
    (
        "ROBTARGET",
        &[("TRANS", "POS"), ("ROT", "ORIENT"), ("ROBCONF", "CONFDATA"), ("EXTAX", "EXTJOINT")],
    ),
    ("JOINTTARGET", &[("ROBAX", "ROBJOINT"), ("EXTAX", "EXTJOINT")]),
    ("SPEEDDATA", &[("V_TCP", NUM), ("V_ORI", NUM), ("V_LEAX", NUM), ("V_REAX", NUM)]),
    (
        "ZONEDATA",
        &[
            ("FINEP", "BOOL"),
            ("PZONE_TCP", NUM),
            ("PZONE_ORI", NUM),
            ("PZONE_EAX", NUM),
            ("ZONE_ORI", NUM),
            ("ZONE_LEAX", NUM),
            ("ZONE_REAX", NUM),
        ],
    ),
    (
        "LOADDATA",
        &[("MASS", NUM), ("COG", "POS"), ("AOM", "ORIENT"), ("IX", NUM), ("IY", NUM), ("IZ", NUM)],
    ),
    ("TOOLDATA", &[("ROBHOLD", "BOOL"), ("TFRAME", "POSE"), ("TLOAD", "LOADDATA")]),
    (
        "WOBJDATA",
        &[
            ("ROBHOLD", "BOOL"),
            ("UFPROG", "BOOL"),
            ("UFMEC", "STRING"),
            ("UFRAME", "POSE"),
            ("OFRAME", "POSE"),
        ],
    ),
];

/// The types of one part.
const ATOMS: &[&str] = &[NUM, "DNUM", "BOOL", "STRING"];

/// The type of that name.
pub(crate) fn kind_of(name: Name) -> Option<&'static str> {
    let records = RECORDS.iter().map(|(kind, _)| *kind);
    records.chain(ATOMS.iter().copied()).find(|kind| *kind == name.as_str())
}

/// Where a part of a record stands in it, and its type.
pub(super) fn part(kind: &str, part: &str) -> Option<(usize, &'static str)> {
    let (_, parts) = RECORDS.iter().find(|(name, _)| *name == kind)?;
    let place = parts.iter().position(|(name, _)| *name == part)?;
    Some((place, parts[place].1))
}

/// Whether a value is one of that type.
pub(crate) fn fits(kind: &str, value: &Value) -> bool {
    match (kind, value) {
        (NUM | "DNUM", Value::Number(number)) => number.is_finite(),
        ("BOOL", Value::Flag(_)) | ("STRING", Value::Text(_)) => true,
        (_, Value::List(values)) => {
            let record = RECORDS.iter().find(|(name, _)| *name == kind);
            record.is_some_and(|(_, parts)| {
                parts.len() == values.len()
                    && parts.iter().zip(values).all(|((_, kind), value)| fits(kind, value))
            })
        }
        (_, Value::Number(_) | Value::Flag(_) | Value::Text(_)) => false,
    }
}

/// The zones that the control knows by name: of the tip and of the orientation, mm ("zonedata").
const ZONES: &[(&str, f64, f64)] = &[
    ("Z0", 0.3, 0.3),
    ("Z1", 1.0, 1.0),
    ("Z5", 5.0, 8.0),
    ("Z10", 10.0, 15.0),
    ("Z15", 15.0, 23.0),
    ("Z20", 20.0, 30.0),
    ("Z30", 30.0, 45.0),
    ("Z40", 40.0, 60.0),
    ("Z50", 50.0, 75.0),
    ("Z60", 60.0, 90.0),
    ("Z80", 80.0, 120.0),
    ("Z100", 100.0, 150.0),
    ("Z150", 150.0, 225.0),
    ("Z200", 200.0, 300.0),
];

/// The speeds that the control knows by name, mm/s, each with a turn of 500°/s ("speeddata"). `vmax` is the robot's own.
const SPEEDS: &[u16] = &[
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500,
    3000, 4000, 5000, 6000, 7000,
];

/// A value that the control itself has defined, and its type.
pub(crate) fn predefined(name: Name) -> Option<(&'static str, Value)> {
    let name = name.as_str();
    let numbers = |all: &[f64]| Value::List(all.iter().copied().map(Value::Number).collect());
    let pose = || Value::List(vec![numbers(&[0.0; 3]), numbers(&[1.0, 0.0, 0.0, 0.0])]);
    let zone = |is_fine: bool, [tip, turn]: [f64; 2]| {
        let flag = [Value::Flag(is_fine)].into_iter();
        let sizes = [tip, turn, turn, turn / 10.0, turn, turn / 10.0];
        ("ZONEDATA", Value::List(flag.chain(sizes.map(Value::Number)).collect()))
    };
    match name {
        "FINE" => return Some(zone(true, [0.0; 2])),
        "DISKHOME" => return Some(("STRING", Value::Text("HOME:".into()))),
        "WOBJ0" => {
            let flags = [Value::Flag(false), Value::Flag(true), Value::Text("".into())];
            return Some((
                "WOBJDATA",
                Value::List(flags.into_iter().chain([pose(), pose()]).collect()),
            ));
        }
        "TOOL0" => {
            let cog = numbers(&[0.0, 0.0, 0.001]);
            let load = [Value::Number(0.001), cog, numbers(&[1.0, 0.0, 0.0, 0.0])];
            let moments = [0.0; 3].map(Value::Number);
            let load = Value::List(load.into_iter().chain(moments).collect());
            return Some(("TOOLDATA", Value::List(vec![Value::Flag(true), pose(), load])));
        }
        _ => {}
    }
    if let Some((_, tip, turn)) = ZONES.iter().find(|(zone, _, _)| *zone == name) {
        return Some(zone(false, [*tip, *turn]));
    }
    let speed = name.strip_prefix('V')?;
    let speed = SPEEDS.iter().find(|known| known.to_string() == speed)?;
    Some(("SPEEDDATA", numbers(&[f64::from(*speed), 500.0, 5000.0, 1000.0])))
}
