//! Sheets that are in order by themselves, merged, and the machine that they make.

use super::Outcome;
use super::arm::{self, PlacedArm};
use super::file::SheetFile;
use crate::linkage::Linkage;
use crate::model::*;
use crate::option::{OptionKey, no_number, wrong_option};
use crate::sheet::*;
use geom::{Vec3, direction};
use program::{CoolantFunctions, Diagnostic, Rule};
use std::collections::BTreeMap;
use toml::Spanned;

/// A part of a file, with the location to report where it turns out wrong after merging.
struct Placed<T> {
    sheet: T,
    place: Diagnostic,
}

impl<T> Placed<T> {
    fn new(file: &SheetFile, what: &str, spanned: Spanned<T>) -> Placed<T> {
        let place = file.at(what, &spanned, "");
        Placed { sheet: spanned.into_inner(), place }
    }

    /// Both were right by themselves; an error of both together is reported at the nearer location.
    fn under(self, nearer: Placed<T>, join: impl Fn(T, T) -> T) -> Placed<T> {
        Placed { sheet: join(self.sheet, nearer.sheet), place: nearer.place }
    }
}

/// `under` for what both may lack.
fn joined<T>(
    farther: Option<Placed<T>>,
    nearer: Option<Placed<T>>,
    join: impl Fn(T, T) -> T,
) -> Option<Placed<T>> {
    match (farther, nearer) {
        (Some(farther), Some(nearer)) => Some(farther.under(nearer, join)),
        (farther, nearer) => nearer.or(farther),
    }
}

/// What is wrong at a place.
fn wrong(place: &Diagnostic, message: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic { message: format!("{}{message}", place.message), ..place.clone() })
}

/// A file whose own values are in order.
pub(super) struct CheckedSheet {
    pub(super) extends: Option<Spanned<String>>,
    title: Option<String>,
    reader: Option<(String, FileLocation)>,
    extension: Option<String>,
    capabilities: CapabilitiesSheet,
    format: FormatSheet,
    settings: SettingsSheet,
    words: BTreeMap<String, (WordSheet, FileLocation)>,
    blocks: BTreeMap<String, Block>,
    axes: BTreeMap<LinearName, Placed<LinearSheet>>,
    rotary: Option<Placed<Vec<RotaryAxis>>>,
    bodies: Option<Vec<Placed<Body>>>,
    work_zero: Option<Place3>,
    safe_height: Option<Placed<Position>>,
    orientation: Option<Placed<OrientationSheet>>,
    wire: Option<Placed<WireSheet>>,
    arm: Option<PlacedArm>,
    cell: Option<Placed<CellSheet>>,
    spindle: Option<Placed<SpindleSheet>>,
    coolant: Option<Placed<CoolantSheet>>,
    feed_max: Option<Rate>,
    tools: ToolsSheet,
    auxiliary: Option<Vec<u32>>,
    operator_parameters: Option<Vec<OperatorParameter>>,
    approach: Option<Vec<String>>,
    options: BTreeMap<String, Placed<OptionSheet>>,
}

impl CheckedSheet {
    /// Checks what serde cannot see; errors are reported at their location in the file.
    pub(super) fn new(sheet: Sheet, file: &SheetFile) -> Outcome<CheckedSheet> {
        let word = |(name, word)| (name, file.placed(word));
        let axis = |(name, axis): (LinearName, Spanned<LinearSheet>)| {
            let placed = Placed::new(file, &format!("axes.{name:?}"), axis);
            check_range(
                &placed.place,
                placed.sheet.min.map(|mm| mm.0),
                placed.sheet.max.map(|mm| mm.0),
                "mm",
            )?;
            Ok((name, placed))
        };
        let axes: Outcome<_> = sheet.axes.unwrap_or_default().into_iter().map(axis).collect();
        let blocks = sheet.blocks.unwrap_or_default().into_iter();
        let spindle = sheet.spindle.map(|spindle| Placed::new(file, "spindle", spindle));
        if let Some(Placed { sheet, place }) = &spindle {
            check_range(place, sheet.min.map(|s| s.0), sheet.max.map(|s| s.0), "1/min")?;
        }
        Ok(CheckedSheet {
            extends: sheet.extends,
            title: sheet.title,
            reader: sheet.reader.map(|reader| file.placed(reader)),
            extension: sheet.extension,
            capabilities: sheet.capabilities.unwrap_or_default(),
            format: sheet.format.unwrap_or_default(),
            settings: sheet.settings.unwrap_or_default(),
            words: sheet.words.unwrap_or_default().into_iter().map(word).collect(),
            blocks: blocks.map(|(name, text)| (name, file.block(text))).collect(),
            axes: axes?,
            rotary: sheet.rotary.map(|axes| check_rotary(file, axes)).transpose()?,
            bodies: sheet.body.map(|bodies| check_bodies(file, bodies)).transpose()?,
            work_zero: sheet.work_zero,
            safe_height: sheet.safe_height.map(|z| Placed::new(file, "safe_height", z)),
            orientation: sheet.orientation.map(|o| Placed::new(file, "orientation", o)),
            wire: sheet.wire.map(|wire| Placed::new(file, "wire", wire)),
            arm: sheet.arm.map(|sheet| PlacedArm::new(file, sheet)).transpose()?,
            cell: sheet.cell.map(|cell| Placed::new(file, "cell", cell)),
            spindle,
            coolant: sheet.coolant.map(|coolant| Placed::new(file, "coolant", coolant)),
            feed_max: sheet.feed_max,
            tools: sheet.tools.unwrap_or_default(),
            auxiliary: sheet.auxiliary,
            operator_parameters: sheet.operator_parameters,
            approach: sheet.approach.map(|order| check_approach(file, order)).transpose()?,
            options: check_options(file, sheet.options.unwrap_or_default())?,
        })
    }
}

/// Refuses a range that holds nothing.
fn check_range(place: &Diagnostic, min: Option<f64>, max: Option<f64>, unit: &str) -> Outcome {
    match (min, max) {
        (Some(min), Some(max)) if min >= max => {
            let message = format!("`min` is less than `max`, not {min} {unit} and {max} {unit}");
            Err(wrong(place, &message))
        }
        _ => Ok(()),
    }
}

/// The values of the options, each within its range.
fn check_options(
    file: &SheetFile,
    options: BTreeMap<String, Spanned<OptionSheet>>,
) -> Outcome<BTreeMap<String, Placed<OptionSheet>>> {
    let checked = |(name, value): (String, Spanned<OptionSheet>)| {
        let wrong = match value.get_ref() {
            OptionSheet::Number(number) => wrong_option(&name, *number),
            OptionSheet::Flag(flag) => no_number(&name, &flag.to_string()),
            OptionSheet::Text(text) => no_number(&name, &format!("the text {text:?}")),
        };
        match wrong {
            Some(message) => Err(file.at(&name, &value, &message).into()),
            None => {
                let placed = Placed::new(file, &name, value);
                Ok((name, placed))
            }
        }
    };
    options.into_iter().map(checked).collect()
}

/// A touch-off is asked for only where there is one.
fn check_touch_off(
    options: &BTreeMap<String, Placed<OptionSheet>>,
    blocks: &BTreeMap<String, Block>,
    rotary: &[RotaryAxis],
) -> Outcome {
    match options.get(OptionKey::TouchTravel.name()) {
        Some(Placed { sheet: OptionSheet::Number(travel), place }) if *travel > 0.0 => {
            let lacks = |why| Box::new(wrong(place, why).help(NO_TOUCH_OFF_HELP));
            no_touch_off(blocks, rotary).map_or(Ok(()), |why| Err(lacks(why)))
        }
        _ => Ok(()),
    }
}

/// Every linear axis comes once.
fn check_approach(file: &SheetFile, order: Spanned<Vec<String>>) -> Outcome<Vec<String>> {
    let mut letters: Vec<char> = order.get_ref().concat().chars().collect();
    letters.sort_unstable();
    if letters != ['X', 'Y', 'Z'] || order.get_ref().iter().any(String::is_empty) {
        let message = "X, Y and Z come once each, such as [\"XY\", \"Z\"]";
        return Err(file.at("approach", &order, message).into());
    }
    Ok(order.into_inner())
}

/// The boxes of a drawing.
fn check_bodies(file: &SheetFile, bodies: Vec<Spanned<BodySheet>>) -> Outcome<Vec<Placed<Body>>> {
    let body = |spanned: Spanned<BodySheet>| {
        let place = file.at("body", &spanned, "");
        let sheet = spanned.into_inner();
        let missing = |key: &str| wrong(&place, &format!("`{key}` is missing"));
        let on = sheet.on.ok_or_else(|| missing("on"))?;
        let low = Vec3::from_array(sheet.low.ok_or_else(|| missing("low"))?.0);
        let high = Vec3::from_array(sheet.high.ok_or_else(|| missing("high"))?.0);
        if low.cmpge(high).any() {
            return Err(wrong(&place, "`low` has a coordinate that is not below that of `high`"));
        }
        let name = sheet.name.unwrap_or_else(|| on.clone());
        Ok(Placed { sheet: Body { name, on, low, high }, place })
    };
    if let Some(first) = bodies.get(MOST_BODIES) {
        let message = format!("a machine is drawn of {MOST_BODIES} bodies at the most");
        return Err(Box::new(file.at("body", first, &message)));
    }
    bodies.into_iter().map(body).collect()
}

/// The most bodies of a machine.
const MOST_BODIES: usize = 100;

fn check_rotary(
    file: &SheetFile,
    axes: Spanned<Vec<Spanned<RotarySheet>>>,
) -> Outcome<Placed<Vec<RotaryAxis>>> {
    let place = file.at("rotary", &axes, "");
    let mut checked: Vec<RotaryAxis> = Vec::new();
    for spanned in axes.into_inner() {
        let sheet = spanned.get_ref();
        let what = sheet.letter.map_or("rotary".into(), |letter| format!("rotary {letter}"));
        let fail = |message: &str| Box::new(file.at(&what, &spanned, message));
        let missing = |key: &str| fail(&format!("`{key}` is missing"));
        let letter = sheet.letter.ok_or_else(|| missing("letter"))?;
        if !matches!(letter, 'A' | 'B' | 'C') {
            return Err(fail("`letter` is one of A, B, C"));
        }
        if checked.iter().any(|axis| axis.letter == letter) {
            return Err(fail("this letter is taken by another rotary axis"));
        }
        if checked.len() == 2 {
            return Err(fail("more than two rotary axes cannot be driven"));
        }
        let axis = sheet.axis.ok_or_else(|| missing("axis"))?.0;
        let axis = direction(Vec3::from_array(axis))
            .ok_or_else(|| fail("`axis` has no direction: give a vector of some length"))?;
        let sign = sheet.sign.unwrap_or(1.0);
        if sign.abs() != 1.0 {
            return Err(fail("`sign` is 1 or -1"));
        }
        let min = sheet.min.map_or(f64::NEG_INFINITY, |min| min.0);
        let max = sheet.max.map_or(f64::INFINITY, |max| max.0);
        check_range(&file.at(&what, &spanned, ""), Some(min), Some(max), "degrees")?;
        let clamp = match (sheet.clamp_open, sheet.clamp_close) {
            (None, None) => None,
            (Some(open), Some(close)) if open != close => Some(Clamp { open, close }),
            _ => {
                return Err(fail(
                    "`clamp_open` and `clamp_close` are two M functions, both or none",
                ));
            }
        };
        checked.push(RotaryAxis {
            letter,
            modulo: sheet.modulo.or((max - min < 360.0).then_some(false)),
            clamp,
            on: sheet.on.ok_or_else(|| missing("on"))?,
            axis,
            point: sheet.point.map_or(Vec3::ZERO, |point| Vec3::from_array(point.0)),
            is_placed: sheet.point.is_some(),
            sign,
            offset: sheet.offset.map_or(0.0, |offset| offset.0),
            min,
            max,
            rapid: sheet.rapid.ok_or_else(|| missing("rapid"))?.0,
            acceleration: sheet.acceleration.ok_or_else(|| missing("acceleration"))?.0,
            prefer: sheet.prefer.map_or(0.0, |prefer| prefer.0),
        });
    }
    Ok(Placed { sheet: checked, place })
}

/// A number opens clamps or closes them; and where the control turns the axes by itself, no word says when they turn.
/// A tilted plane whose block places the words of the axes turns them itself before.
fn check_clamps(
    place: &Diagnostic,
    rotary: &[RotaryAxis],
    modes: [OrientationMode; 2],
    blocks: &BTreeMap<String, Block>,
) -> Outcome {
    let clamps: Vec<Clamp> = rotary.iter().filter_map(|axis| axis.clamp).collect();
    if clamps.iter().any(|a| clamps.iter().any(|b| a.open == b.close)) {
        return Err(wrong(place, "one M function opens a clamp and closes another"));
    }
    let turned_by = |block: &Block| {
        let text = block.text.replace(' ', "");
        rotary.iter().all(|axis| text.contains(&format!("{{{{{}}}}}", axis.letter)))
    };
    let by_words = |mode| match mode {
        OrientationMode::MachineAngles
        | OrientationMode::ToolCenterAngles
        | OrientationMode::DynamicOffset => true,
        OrientationMode::TiltedPlane => blocks.get("plane_tilt").is_some_and(turned_by),
        OrientationMode::Fixed | OrientationMode::Vectors => false,
    };
    match modes.into_iter().all(by_words) {
        true => Ok(()),
        false => Err(wrong(
            place,
            "axes with clamps are written as positions (machine-angles, tool-center-angles or dynamic-offset), or turned by words of \
             the block `plane_tilt`: with vectors, and where a tilted plane turns them, no word says when they turn",
        )),
    }
}

/// `nearer` over `farther`, entry by entry; what both have is joined by `join`.
fn overlay<K: Ord, V>(
    mut farther: BTreeMap<K, V>,
    nearer: BTreeMap<K, V>,
    join: impl Fn(V, V) -> V,
) -> BTreeMap<K, V> {
    for (key, value) in nearer {
        let value = match farther.remove(&key) {
            Some(under) => join(under, value),
            None => value,
        };
        farther.insert(key, value);
    }
    farther
}

impl CheckedSheet {
    /// The arm of the library that it is.
    pub(super) fn arm_model(&self) -> Option<&str> {
        self.arm.as_ref().and_then(PlacedArm::model)
    }

    pub(super) fn under(self, nearer: CheckedSheet) -> CheckedSheet {
        CheckedSheet {
            extends: self.extends,
            title: nearer.title.or(self.title),
            reader: nearer.reader.or(self.reader),
            extension: nearer.extension.or(self.extension),
            capabilities: self.capabilities.under(nearer.capabilities),
            format: self.format.under(nearer.format),
            settings: self.settings.under(nearer.settings),
            words: overlay(self.words, nearer.words, |farther, nearer| {
                (farther.0.under(nearer.0), nearer.1)
            }),
            blocks: overlay(self.blocks, nearer.blocks, |_, nearer| nearer),
            axes: overlay(self.axes, nearer.axes, |farther, nearer| {
                farther.under(nearer, LinearSheet::under)
            }),
            rotary: nearer.rotary.or(self.rotary),
            bodies: nearer.bodies.or(self.bodies),
            work_zero: nearer.work_zero.or(self.work_zero),
            safe_height: nearer.safe_height.or(self.safe_height),
            orientation: joined(self.orientation, nearer.orientation, OrientationSheet::under),
            wire: joined(self.wire, nearer.wire, WireSheet::under),
            arm: arm::under(self.arm, nearer.arm),
            cell: joined(self.cell, nearer.cell, CellSheet::under),
            spindle: joined(self.spindle, nearer.spindle, SpindleSheet::under),
            coolant: joined(self.coolant, nearer.coolant, CoolantSheet::under),
            feed_max: nearer.feed_max.or(self.feed_max),
            tools: self.tools.under(nearer.tools),
            auxiliary: nearer.auxiliary.or(self.auxiliary),
            operator_parameters: nearer.operator_parameters.or(self.operator_parameters),
            approach: nearer.approach.or(self.approach),
            options: overlay(self.options, nearer.options, |_, nearer| nearer),
        }
    }

    pub(super) fn finish(
        mut self,
        name: String,
        file: String,
        control: String,
        missing: &dyn Fn(&str) -> Box<Diagnostic>,
    ) -> Outcome<Machine> {
        let mut linear = [LinearAxis::default(); 3];
        for (axis, name) in linear.iter_mut().zip([LinearName::X, LinearName::Y, LinearName::Z]) {
            if let Some(Placed { sheet, place }) = self.axes.remove(&name) {
                check_range(&place, sheet.min.map(|mm| mm.0), sheet.max.map(|mm| mm.0), "mm")?;
                *axis = finish_linear(&sheet);
            }
        }
        let safe_height = self.safe_height.map(|safe| check_safe_height(&safe, &linear[2]));
        let safe_height = safe_height.transpose()?;
        let (mut spindle, mut orientation) = (SpindleSheet::default(), OrientationSheet::default());
        if let Some(Placed { sheet, place }) = self.spindle {
            check_range(&place, sheet.min.map(|s| s.0), sheet.max.map(|s| s.0), "1/min")?;
            spindle = sheet;
        }
        let coolant = self.coolant.as_ref().map(check_coolant).transpose()?.unwrap_or_default();
        let (mut rotary, mut rotary_place) = (Vec::new(), None);
        if let Some(Placed { sheet, place }) = self.rotary {
            let modes = self.orientation.as_ref().and_then(|o| o.sheet.simultaneous);
            if matches!(modes, None | Some(OrientationMode::Fixed)) && !sheet.is_empty() {
                let message = "`orientation.simultaneous` does not say how their positions are \
                               written: machine-angles, tool-center-angles or vectors";
                return Err(wrong(&place, message));
            }
            (rotary, rotary_place) = (sheet, Some(place));
        }
        check_touch_off(&self.options, &self.blocks, &rotary)?;
        if let (Some(letter), Some(place)) = (self.settings.swivel_direction, &rotary_place)
            && rotary.iter().all(|axis| axis.letter != letter)
        {
            let message = format!("none of them is {letter}, as `swivel_direction` says");
            return Err(wrong(place, &message));
        }
        if let Some(Placed { sheet, place }) = self.orientation {
            let modes = [sheet.simultaneous, sheet.positioned];
            let turns = |mode: &OrientationMode| *mode != OrientationMode::Fixed;
            if rotary.is_empty() && modes.iter().flatten().any(turns) {
                return Err(wrong(&place, "there are no [[rotary]] axes to turn the tool with"));
            }
            orientation = sheet;
        }
        if let Some(Placed { place, .. }) = self.wire.as_ref().filter(|_| !rotary.is_empty()) {
            return Err(wrong(
                place,
                "a wire leans by U and V: a wire machine has no [[rotary]] axes",
            ));
        }
        let mut arm = self.arm.map(PlacedArm::finish).transpose()?;
        let cell = self.cell.map(|Placed { sheet, place }| {
            if let Some(whole) = arm.take() {
                arm = Some(arm::with_cables(whole, &sheet).map_err(|why| wrong(&place, &why))?);
            }
            arm::cell(sheet).map_err(|why| wrong(&place, &why))
        });
        let cell = cell.transpose()?;
        if arm.is_some() != cell.is_some() && self.reader.is_some() {
            return Err(missing(
                "`[arm]` or `[cell]` of a robot with a control: it needs both, and the missing one",
            ));
        }
        if arm.is_some() && (!rotary.is_empty() || self.wire.is_some()) {
            return Err(missing("a machine that is only one of arm, mill and wire machine"));
        }
        let simultaneous = orientation.simultaneous.unwrap_or(OrientationMode::Fixed);
        let positioned = orientation.positioned.unwrap_or(simultaneous);
        let is_clamp = |axis: &RotaryAxis| {
            let clamp = axis.clamp.map_or([None; 2], |clamp| [Some(clamp.open), Some(clamp.close)]);
            clamp.into_iter().flatten().any(|number| coolant.switch(number).is_some())
        };
        if let (Some(place), true) = (&rotary_place, rotary.iter().any(is_clamp)) {
            let message = "an M function of a clamp is one of [coolant] too";
            return Err(wrong(place, message));
        }
        if let Some(place) = rotary_place.filter(|_| rotary.iter().any(|axis| axis.clamp.is_some()))
        {
            check_clamps(&place, &rotary, [simultaneous, positioned], &self.blocks)?;
        }
        let kinematics = match (self.settings.tip_kinematics, self.settings.axis_kinematics) {
            (None, None) => None,
            (Some(tip), Some(axes)) if tip != axes => Some(Kinematics { tip, axes }),
            _ => {
                return Err(missing(
                    "`tip_kinematics` or `axis_kinematics` in [settings], two M functions,",
                ));
            }
        };
        let capabilities = self.capabilities;
        let format = self.format;
        let line_length = capabilities.line_length.unwrap_or(256);
        let (reader, reader_place) = match self.reader {
            Some(reader) => reader,
            None if arm.is_some() => (String::new(), FileLocation { file: file.clone(), line: 0 }),
            None => return Err(missing("`reader`, the virtual control,")),
        };
        if kinematics.is_some() && reader != "linuxcnc" {
            let message = format!(
                "`tip_kinematics` in [settings] is for LinuxCNC, and the reader is `{reader}`"
            );
            return Err(Diagnostic::error(Rule::MachineFile, message).file(file).into());
        }
        let bodies = self.bodies.take().unwrap_or_default();
        let machine = Machine {
            loaded_from: LoadedFrom::default(),
            title: self.title.unwrap_or_else(|| name.clone()),
            name,
            file,
            control,
            reader,
            reader_place,
            extension: self.extension.unwrap_or_else(|| "nc".into()),
            capabilities: Capabilities {
                arcs: capabilities.arcs.unwrap_or_default(),
                helix: capabilities.helix.unwrap_or(false),
                full_circle: capabilities.full_circle.unwrap_or(false),
                arc_tolerance: capabilities.arc_tolerance.map_or(0.001, |mm| mm.0),
                cycles: capabilities.cycles.unwrap_or_default(),
                compensation: capabilities.compensation.unwrap_or(false),
                compensation_start: capabilities
                    .compensation_start
                    .unwrap_or(CompensationStart::NextStart),
                compensation_blind: capabilities.compensation_blind,
                feed_per_turn: capabilities.feed_per_turn.unwrap_or(false),
                inverse_time: capabilities.inverse_time.unwrap_or(false),
                inverse_time_arcs: capabilities.inverse_time_arcs.unwrap_or(true),
                length_offset: capabilities.length_offset.unwrap_or(LengthOffset::Implicit),
                straight_tip_rapids: capabilities.straight_tip_rapids.unwrap_or(false),
                line_length,
                lowering_tolerance: capabilities.lowering_tolerance.map_or(0.005, |mm| mm.0),
                rapid_corridor: capabilities.rapid_corridor.map_or(0.1, |mm| mm.0),
                rapid_clearance: capabilities.rapid_clearance.map_or(1.0, |mm| mm.0),
                fits_corners: capabilities.fits_corners.unwrap_or(false),
                arc_sweep: capabilities.arc_sweep.map_or(180.0, |degrees| degrees.0).to_radians(),
                program_lines: capabilities.program_lines.unwrap_or(usize::MAX),
                program_bytes: capabilities.program_bytes.unwrap_or(usize::MAX),
                program_points: capabilities.program_points.unwrap_or(usize::MAX),
            },
            settings: ControlSettings {
                floating_holder: self.settings.floating_holder.unwrap_or(false),
                high_feed: self.settings.high_feed.map(|feed| feed.0),
                start_modes: self.settings.start_modes.unwrap_or_default(),
                edge_at_change: self.settings.edge_at_change,
                length_along_z: self.settings.length_along_z,
                length_moves_axis: self.settings.length_moves_axis,
                dwell_p_milliseconds: self.settings.dwell_p_milliseconds,
                retract_above_r: self.settings.retract_above_r.map(|mm| mm.0),
                kinematics,
                rapid_path: self.settings.rapid_path,
                tool_radius: self.settings.tool_radius,
                rotary_feed: self.settings.rotary_feed,
                rotary_by_sign: self.settings.rotary_by_sign,
                table_frame_at_zero: self.settings.table_frame_at_zero,
                sets_work_offsets: self.settings.sets_work_offsets.unwrap_or(false),
                swivel_direction: self.settings.swivel_direction,
                tilt_second_axis_first: self.settings.tilt_second_axis_first,
                tilt_within_travel: self.settings.tilt_within_travel,
            },
            format: Format {
                separator: format.separator.unwrap_or_else(|| " ".into()),
                line_end: format.line_end.unwrap_or_else(|| "\n".into()),
                comment_start: format.comment_start.unwrap_or_else(|| "(".into()),
                comment_end: format.comment_end.unwrap_or_else(|| ")".into()),
                fresh_operations: format.fresh_operations.unwrap_or(false),
                comment_signs: format.comment_signs.unwrap_or_else(|| HARMLESS_SIGNS.into()),
                comment_length: format
                    .comment_length
                    .unwrap_or(line_length.saturating_sub(24).max(8)),
            },
            words: self.words.into_iter().map(|(name, word)| finish_word(name, word)).collect(),
            blocks: self.blocks,
            linear,
            rotary,
            work_zero: self.work_zero.map(|point| Vec3::from_array(point.0)),
            safe_height,
            orientation: OrientationSettings {
                simultaneous,
                positioned,
                tolerance: orientation.tolerance.map_or(0.005, |mm| mm.0),
            },
            wire: self.wire.map(|wire| finish_wire(&wire.sheet)),
            arm,
            cell,
            spindle: SpindleRange {
                min: spindle.min.map_or(0.0, |speed| speed.0),
                max: spindle.max.map_or(f64::INFINITY, |speed| speed.0),
                dwell: spindle.dwell.map_or(0.0, |seconds| seconds.0),
            },
            coolant,
            feed_max: self.feed_max.map_or(f64::INFINITY, |feed| feed.0),
            tools: ToolRange {
                max_number: self.tools.max_number.unwrap_or(u32::MAX),
                max_diameter: self.tools.max_diameter.map_or(f64::INFINITY, |mm| mm.0),
                max_length: self.tools.max_length.map_or(f64::INFINITY, |mm| mm.0),
                retracts: self.tools.retracts.unwrap_or(false),
                turns_upright: self.tools.turns_upright.unwrap_or(false),
            },
            auxiliary: self.auxiliary.unwrap_or_default(),
            operator_parameters: (self.operator_parameters.into_iter().flatten())
                .map(|parameter| parameter.0)
                .collect(),
            approach: self.approach.unwrap_or_else(|| vec!["XY".into(), "Z".into()]),
            options: (self.options.into_iter())
                .map(|(name, value)| match value.sheet {
                    OptionSheet::Flag(flag) => (name, OptionValue::Flag(flag)),
                    OptionSheet::Number(number) => (name, OptionValue::Number(number)),
                    OptionSheet::Text(text) => (name, OptionValue::Text(text)),
                })
                .collect(),
            bodies: Vec::new(),
        };
        if bodies.is_empty() {
            return Ok(machine);
        }
        let linkage = Linkage::of(&machine);
        for Placed { sheet, place } in &bodies {
            if linkage.link(&sheet.on).is_none() {
                let links: Vec<&str> = linkage.links.iter().map(|link| &*link.name).collect();
                let message = format!(
                    "`{}` carries nothing: `on` is one of {}, spindle, table",
                    sheet.on,
                    links.join(", ")
                );
                return Err(wrong(place, &message));
            }
        }
        Ok(Machine { bodies: bodies.into_iter().map(|body| body.sheet).collect(), ..machine })
    }
}

/// The M functions for coolant, each of which does one thing.
fn check_coolant(coolant: &Placed<CoolantSheet>) -> Outcome<CoolantFunctions> {
    let CoolantSheet { flood, mist, through, off, through_off } = coolant.sheet;
    let functions = CoolantFunctions { flood, mist, through, off, through_off };
    if functions.contradicts() {
        return Err(wrong(&coolant.place, "one M function does two things with the coolant"));
    }
    Ok(functions)
}

/// The safe height, which Z must reach.
fn check_safe_height(safe: &Placed<Position>, z: &LinearAxis) -> Outcome<f64> {
    let (height, LinearAxis { min, max, .. }) = (safe.sheet.0, *z);
    if height < min || height > max {
        let message = format!("{height} mm, and Z travels from {min} to {max} mm");
        return Err(wrong(&safe.place, &message));
    }
    Ok(height)
}

fn finish_linear(sheet: &LinearSheet) -> LinearAxis {
    let default = LinearAxis::default();
    LinearAxis {
        min: sheet.min.map_or(default.min, |mm| mm.0),
        max: sheet.max.map_or(default.max, |mm| mm.0),
        rapid: sheet.rapid.map(|rate| rate.0),
        acceleration: sheet.acceleration.map_or(default.acceleration, |rate| rate.0),
        on: sheet.on.unwrap_or(default.on),
    }
}

fn finish_wire(sheet: &WireSheet) -> Wire {
    Wire {
        height: sheet.height.map(|mm| mm.0),
        uv_travel: sheet.uv_travel.map_or(f64::INFINITY, |mm| mm.0),
        taper_max: sheet.taper_max.map_or(90.0, |degrees| degrees.0),
        thread: sheet.thread,
        cut: sheet.cut,
        memory: sheet.memory.map(|points| points as usize),
    }
}

fn finish_word(name: String, (sheet, place): (WordSheet, FileLocation)) -> (String, Word) {
    let word = Word {
        address: sheet.address.unwrap_or_else(|| name.clone()),
        suffix: sheet.suffix.unwrap_or_default(),
        decimals: sheet.decimals.map_or(3, |decimals| decimals.0),
        trim: sheet.trim.unwrap_or(false),
        point: sheet.point.unwrap_or(false),
        plus: sheet.plus.unwrap_or(false),
        digits: sheet.digits.unwrap_or(1),
        modal: sheet.modal.unwrap_or(false),
        exact: sheet.exact.unwrap_or(false),
        within_turn: sheet.within_turn.unwrap_or(false),
        step: sheet.step.unwrap_or(10),
        first: sheet.first.or(sheet.step).unwrap_or(10),
        scale: sheet.scale.map_or(1.0, |scale| scale.0),
        max: sheet.max.map_or(f64::INFINITY, |max| max.0),
        codes: sheet.codes.unwrap_or_default(),
        place,
    };
    (name, word)
}
