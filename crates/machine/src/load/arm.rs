//! The table `[arm]`: lengths, joints and limits that have to make an arm together.

use super::Outcome;
use super::file::SheetFile;
use crate::library;
use crate::model::{Cell, Load, Rail};
use crate::sheet::{
    Angle, ArmSheet, CellSheet, CouplingSheet, DhSheet, JointSheet, LengthsSheet, Position,
    RailSheet,
};
use arm::{Arm, Calibration, Coupling, CouplingLimit, Dh, Joint, Spherical, Structure};
use geom::direction;
use program::Diagnostic;
use toml::Spanned;

/// An `[arm]` of a file, with the place to report where it turns out wrong after merging.
pub(super) struct PlacedArm {
    sheet: ArmSheet,
    place: Diagnostic,
}

impl PlacedArm {
    /// The table of a file, over that of the arm of the library that its `model` names.
    ///
    /// # Errors
    /// The library has no such arm.
    pub(super) fn new(file: &SheetFile, sheet: Spanned<ArmSheet>) -> Outcome<PlacedArm> {
        let place = file.at("arm", &sheet, "");
        let nearer = PlacedArm { place, sheet: sheet.into_inner() };
        let Some(model) = &nearer.sheet.model else { return Ok(nearer) };
        let found = SheetFile::of_library(model.get_ref(), library::ARMS)
            .map_err(|found| Box::new(file.at("model", model, &found.message).help(found.help)))?;
        let Some(of_library) = found.parse()?.arm else { return Ok(nearer) };
        Ok(PlacedArm { sheet: of_library.into_inner().under(nearer.sheet), place: nearer.place })
    }

    /// The arm of the library that it is, where one is named.
    pub(super) fn model(&self) -> Option<&str> {
        self.sheet.model.as_ref().map(|model| model.get_ref().as_str())
    }

    /// The arm.
    ///
    /// # Errors
    /// What is missing, or does not go together.
    pub(super) fn finish(self) -> Outcome<Arm> {
        let PlacedArm { sheet, place } = self;
        let wrong = |message: &str| {
            let message = format!("{}{message}", place.message);
            Box::new(Diagnostic { message, ..place.clone() })
        };
        arm(&sheet).map_err(|why| wrong(&why))
    }
}

/// Both files' tables, the nearer one winning key by key.
pub(super) fn under(farther: Option<PlacedArm>, nearer: Option<PlacedArm>) -> Option<PlacedArm> {
    match (farther, nearer) {
        (Some(farther), Some(nearer)) => {
            Some(PlacedArm { sheet: farther.sheet.under(nearer.sheet), place: nearer.place })
        }
        (farther, nearer) => nearer.or(farther),
    }
}

/// The arm with the ranges that its cables leave.
///
/// # Errors
/// One is no range within the limits of its joint.
pub(super) fn with_cables(arm: Arm, sheet: &CellSheet) -> Said<Arm> {
    let ranges = [(4, sheet.cable_joint_4), (6, sheet.cable_joint_6)];
    ranges.into_iter().try_fold(arm, |arm, (number, range)| match range {
        Some(range) => arm
            .with_range(number, range.0.map(f64::to_radians))
            .map_err(|why| format!("`cable_joint_{number}`: {why}")),
        None => Ok(arm),
    })
}

/// The cell of a table, all of whose needed keys are there.
///
/// # Errors
/// Which is missing.
pub(super) fn cell(sheet: CellSheet) -> Said<Cell> {
    let spindle_analog = match (sheet.spindle_analog, sheet.spindle_full) {
        (Some(output), Some(full)) if full.0 > 0.0 => Some((output, full.0)),
        (None, None) => None,
        _ => {
            return Err(String::from(
                "`spindle_analog` and `spindle_full` are given both or not at all",
            ));
        }
    };
    let load = match (sheet.load_mass, sheet.load_center) {
        (Some(mass), Some(center)) => Some(Load { mass: mass.0, center: center.0.into() }),
        (None, None) => None,
        _ => {
            return Err(String::from("`load_mass` and `load_center` are given both or not at all"));
        }
    };
    let tool_change = sheet.tool_change.unwrap_or_default();
    let named = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if tool_change.len() > 24 || !tool_change.chars().all(named) {
        return Err(String::from("`tool_change` is a name of letters, digits and _, at most 24"));
    }
    let [joint_4, joint_6] = [&sheet.cable_joint_4, &sheet.cable_joint_6]
        .map(|range| range.as_ref().map(|range| range.0));
    Ok(Cell {
        spindle: Cell::frame(needed("spindle", sheet.spindle)?.0),
        tool_length: sheet.tool_length.map(|mm| mm.0),
        part: Cell::frame(needed("part", sheet.part)?.0),
        home: needed("home", sheet.home)?.0,
        joint_speed: needed("joint_speed", sheet.joint_speed)?.0,
        rapid: needed("rapid", sheet.rapid)?.0,
        reentry_feed: sheet.reentry_feed.map(|rate| rate.0),
        tool_change,
        spindle_output: sheet.spindle_output,
        spindle_analog,
        coolant_output: sheet.coolant_output,
        own_frame: sheet.own_frame.map(|number| number.0),
        load_number: sheet.load_number.map(|number| number.0),
        load,
        cables: [None, None, None, joint_4, None, joint_6],
        rail: sheet.rail.as_ref().map(|sheet| rail(sheet.get_ref())).transpose()?,
    })
}

/// # Errors
/// A key is missing, or its numbers make no rail.
fn rail(sheet: &RailSheet) -> Said<Rail> {
    fn of<T>(key: &str, value: Option<T>) -> Said<T> {
        needed(&format!("rail.{key}"), value)
    }
    let wrong = |what: &str| Err(format!("`rail`: {what}"));
    let Some(direction) = direction(of("direction", sheet.direction)?.0.into()) else {
        return wrong("`direction` has no length");
    };
    let rail = Rail {
        direction,
        origin: Cell::frame(of("origin", sheet.origin)?.0),
        min: of("min", sheet.min)?.0,
        max: of("max", sheet.max)?.0,
        speed: of("speed", sheet.speed)?.0,
        home: of("home", sheet.home)?.0,
    };
    match rail.min < rail.max && rail.holds(rail.home) {
        true => Ok(rail),
        false => wrong("`min` is below `max`, and `home` between them"),
    }
}

type Said<T> = std::result::Result<T, String>;

fn needed<T>(key: &str, value: Option<T>) -> Said<T> {
    value.ok_or_else(|| format!("`{key}` is missing"))
}

fn arm(sheet: &ArmSheet) -> Said<Arm> {
    let structure = match (&sheet.lengths, &sheet.dh) {
        (Some(lengths), None) => spherical(sheet, lengths.get_ref())?,
        (None, Some(dh)) => ur(sheet, dh.get_ref())?,
        (Some(_), Some(_)) | (None, None) => {
            return Err(String::from(
                "one of `lengths` and `dh` says how its links are put together",
            ));
        }
    };
    let coupling = sheet.coupling.map(|coupling| match coupling {
        CouplingSheet::None => Coupling::None,
        CouplingSheet::LessJoint2 => Coupling::LessJoint2,
        CouplingSheet::PlusJoint2 => Coupling::PlusJoint2,
    });
    let height = needed("world_height", sheet.world_height)?.0;
    let arm =
        Arm::new(structure, joints(sheet)?, coupling, height).map_err(|why| why.to_string())?;
    if let Some(stated) = sheet.reach.map(|mm| mm.0).filter(|stated| !arm.reaches(*stated)) {
        let made = arm.reach();
        return Err(format!("its lengths reach {made:.1} mm, and `reach` states {stated} mm"));
    }
    match (sheet.coupled_min, sheet.coupled_max) {
        (None, None) => Ok(arm),
        (Some(_), Some(_)) if matches!(coupling, None | Some(Coupling::None)) => Err(String::from(
            "`coupled_min` and `coupled_max` are of a joint 3 that `coupling` couples",
        )),
        (Some(min), Some(max)) => {
            let limit = CouplingLimit { min: min.0.to_radians(), max: max.0.to_radians() };
            arm.with_coupling_limit(limit).map_err(|why| why.to_string())
        }
        (Some(_), None) | (None, Some(_)) => {
            Err(String::from("`coupled_min` and `coupled_max` are given both or not at all"))
        }
    }
}

fn spherical(sheet: &ArmSheet, lengths: &LengthsSheet) -> Said<Structure> {
    if sheet.calibration.is_some() {
        return Err(String::from("a `calibration` is that of an arm with `dh`"));
    }
    let length = |name: &str, value| length("lengths", name, value);
    let offsets = needed("offsets", sheet.offsets)?.0.map(f64::to_radians);
    let signs = needed("signs", sheet.signs)?;
    Ok(Structure::Spherical(Spherical {
        a1: length("a1", lengths.a1)?,
        a2: length("a2", lengths.a2)?,
        b: length("b", lengths.b)?,
        c1: length("c1", lengths.c1)?,
        c2: length("c2", lengths.c2)?,
        c3: length("c3", lengths.c3)?,
        c4: length("c4", lengths.c4)?,
        offsets,
        signs,
    }))
}

fn ur(sheet: &ArmSheet, dh: &DhSheet) -> Said<Structure> {
    if sheet.offsets.is_some() || sheet.signs.is_some() {
        return Err(String::from("`offsets` and `signs` are those of an arm with `lengths`"));
    }
    let length = |name: &str, value| length("dh", name, value);
    let nominal = Dh {
        d1: length("d1", dh.d1)?,
        a2: length("a2", dh.a2)?,
        a3: length("a3", dh.a3)?,
        d4: length("d4", dh.d4)?,
        d5: length("d5", dh.d5)?,
        d6: length("d6", dh.d6)?,
    };
    let measured =
        sheet.calibration.as_ref().map(|rows| calibration(rows.get_ref())).transpose()?;
    Ok(Structure::Ur(nominal, measured.map(Box::new)))
}

/// A length of `table` that has to be there, mm.
fn length(table: &str, name: &str, value: Option<Position>) -> Said<f64> {
    needed(&format!("{table}.{name}"), value).map(|mm| mm.0)
}

fn calibration(rows: &[[f64; 6]]) -> Said<Calibration> {
    let good = rows.iter().flatten().all(|number| number.abs() <= 1e5);
    let rows = <[[f64; 6]; 6]>::try_from(rows).ok().filter(|_| good);
    rows.map(Calibration::of_rows).ok_or_else(|| {
        String::from("`calibration` has six rows of six numbers from -100000 to 100000")
    })
}

fn joints(sheet: &ArmSheet) -> Said<[Joint; 6]> {
    let listed = needed("joints", sheet.joints.as_ref())?.get_ref();
    let mut joints = Vec::with_capacity(6);
    for (number, joint) in (1..).zip(listed) {
        joints.push(finish_joint(number, joint)?);
    }
    <[Joint; 6]>::try_from(joints)
        .map_err(|joints| format!("six `joints` are needed, not {}", joints.len()))
}

fn finish_joint(number: usize, sheet: &JointSheet) -> Said<Joint> {
    let angle = |key: &str, value: Option<Angle>| {
        needed(&format!("{key}` of joint {number} in `joints"), value)
            .map(|degrees| degrees.0.to_radians())
    };
    let speed = needed(&format!("speed` of joint {number} in `joints"), sheet.speed)?;
    Ok(Joint {
        min: angle("min", sheet.min)?,
        max: angle("max", sheet.max)?,
        speed: speed.0.to_radians(),
        acceleration: sheet.acceleration.map(|rate| rate.0.to_radians()),
    })
}
