//! What a machine's files must hold so that nothing is missing when it is needed: checked before
//! anything is written.

use crate::arm::{MIDDLE, POSE, PoseWords};
use crate::catalogue::{BlockName, WordName};
use crate::template::Templates;
use machine::{COMMA, CycleName, FileLocation, HARMLESS_SIGNS, Machine, OrientationMode};
use program::{Diagnostic, Findings, Rule, nearest};

/// The first parameter that can keep a height: those below are a subroutine's own (LinuxCNC, "Numbered Parameters": #1 to
/// #30).
const FIRST_KEPT: u32 = 31;

/// For so many unknown names it is guessed what they were meant to be.
const MOST_GUESSED: usize = 20;

/// Checks words against the catalogue, words that blocks place against the words that there are, and
/// blocks against the capabilities.
///
/// # Errors
/// Each promise that is not kept.
pub(crate) fn check(machine: &Machine, templates: &Templates) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Findings::default();
    let file = |error: Diagnostic| error.file(machine.file.clone());
    let at =
        |error: Diagnostic, place: &FileLocation| error.file(place.file.clone()).line(place.line);
    let unknown = machine.words.iter().filter(|(name, _)| WordName::named(name).is_none());
    for (i, (name, word)) in unknown.enumerate() {
        let near = match i < MOST_GUESSED {
            true => nearest(name, WordName::TABLE.iter().map(|row| row.name)),
            false => String::new(),
        };
        let help = if near.is_empty() { near } else { format!("did you mean {near}?") };
        let message = format!("no word is called `{name}`");
        errors.push(at(Diagnostic::error(Rule::MachineWord, message).help(help), &word.place));
    }
    for (word, block) in templates.words() {
        let name = word.name();
        if word == WordName::SafeHeight && machine.safe_height.is_none() {
            // The same block goes to a height over the work zero there.
            if machine.retract_height().is_some() {
                continue;
            }
            let message = "the block retracts in machine coordinates, and the machine's file gives no safe \
                           height";
            let error =
                Diagnostic::error(Rule::SafeHeight, message).help(machine::SAFE_HEIGHT_HELP);
            errors.push(error.file(block.file.clone()).line(block.line));
            continue;
        }
        if word == WordName::RapidFeed && machine.linear.iter().all(|axis| axis.rapid.is_none()) {
            let message = "the block goes by rapid at an F, and the machine's file does not say how fast an axis is";
            let help = "add `rapid` in mm/min below [axes]: `X = { rapid = 6000 }`";
            let error = Diagnostic::error(Rule::RapidFeed, message).help(help);
            errors.push(error.file(block.file.clone()).line(block.line));
            continue;
        }
        let Some(known) = machine.words.get(name) else {
            let message = format!("the block places `{name}`, and [words.{name}] is missing");
            let error = Diagnostic::error(Rule::MachineWord, message);
            errors.push(error.file(block.file.clone()).line(block.line));
            continue;
        };
        let lacks = |code: &&str| !known.codes.contains_key(*code) && needs(machine, word, code);
        for code in word.codes().filter(lacks) {
            let message = format!("[words.{name}] has no text for `{code}` in its `codes`");
            errors.push(at(Diagnostic::error(Rule::MachineWord, message), &known.place));
        }
        for code in known.codes.keys().filter(|code| word.codes().all(|known| known != **code)) {
            let message = format!("[words.{name}] has no code called `{code}`");
            errors.push(at(Diagnostic::error(Rule::MachineWord, message), &known.place));
        }
    }
    let axes = [WordName::X, WordName::Y, WordName::Z];
    // A wire has no height.
    let axes = if machine.wire.is_some() { &axes[..2] } else { &axes[..] };
    for word in axes {
        if !machine.words.contains_key(word.name()) {
            let message = format!("[words.{}] is missing", word.name());
            errors.push(file(Diagnostic::error(Rule::MachineWord, message)));
        }
    }
    if let Some(word) = machine.words.get(WordName::Height.name()) {
        let numbered = word.decimals == 0 && word.scale == 1.0;
        if !(numbered && word.first >= FIRST_KEPT && f64::from(word.first) <= word.max) {
            let message = format!(
                "[words.HEIGHT] is no number of a parameter: {} decimals, a scale of {}, from {} to {}",
                word.decimals, word.scale, word.first, word.max
            );
            let help = format!(
                "`decimals = 0`, no `scale`, `first` from {FIRST_KEPT} to `max`: subroutines keep what they \
                 are called with below"
            );
            errors.push(at(Diagnostic::error(Rule::MachineWord, message).help(help), &word.place));
        }
    }
    if let Some(sign) =
        machine.format.comment_signs.chars().find(|c| !HARMLESS_SIGNS.contains(*c) && *c != COMMA)
    {
        let message =
            format!("`{sign}` in `comment_signs` may end a comment or be a command in it");
        let help = format!("signs that no control misreads are `{HARMLESS_SIGNS}{COMMA}`");
        errors.push(file(Diagnostic::error(Rule::CommentSigns, message).help(help)));
    }
    for (block, why) in promised(machine) {
        if !templates.has(block) {
            let message = format!("the block `{}` is missing: {why}", block.name());
            errors.push(file(Diagnostic::error(Rule::MissingBlock, message)));
        }
    }
    let can = &machine.capabilities;
    let mut placed = |block: BlockName, words: &[WordName], why: &str| {
        let Some(text) = machine.blocks.get(block.name()) else { return };
        for word in words.iter().filter(|word| !templates.places(block, **word)) {
            let message = format!("the block `{}` lacks `{}`: {why}", block.name(), word.name());
            let help = format!("put {{{{{}}}}} where the control reads it", word.name());
            let error = Diagnostic::error(Rule::MissingWord, message).help(help);
            errors.push(error.file(text.file.clone()).line(text.line));
        }
    };
    placed(BlockName::KeepHeight, &[WordName::Height], "no height could be kept");
    placed(BlockName::Rapid, axes, "no move could go there");
    if templates.places(BlockName::ToolCenterOn, WordName::Z) {
        placed(BlockName::ToolCenterOn, axes, "it says Z, and is the first move");
    }
    placed(BlockName::Linear, axes, "no move could go there");
    for (promise, why, word) in [
        (machine.wire.is_none(), "no feed could be said", WordName::F),
        (can.compensation, "`compensation` is promised", WordName::Compensation),
        (can.feed_per_turn, "`feed_per_turn` is promised", WordName::FeedMode),
        (can.inverse_time, "`inverse_time` is promised", WordName::FeedMode),
    ] {
        if promise {
            placed(BlockName::Linear, &[word], why);
        }
    }
    orientation(machine, templates).into_iter().for_each(|error| errors.push(error));
    let errors = errors.finish();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// The same for the control of an arm: it has the blocks and words without which no program of it can be written.
///
/// # Errors
/// Each promise that is not kept.
pub(crate) fn check_arm(machine: &Machine, templates: &Templates) -> Result<(), Vec<Diagnostic>> {
    use BlockName as B;
    use WordName as W;
    let mut errors = Findings::default();
    for (name, word) in machine.words.iter().filter(|(name, _)| WordName::named(name).is_none()) {
        let near = nearest(name, WordName::TABLE.iter().map(|row| row.name));
        let help = if near.is_empty() { near } else { format!("did you mean {near}?") };
        let found =
            Diagnostic::error(Rule::MachineWord, format!("no word is called `{name}`")).help(help);
        errors.push(found.file(word.place.file.clone()).line(word.place.line));
    }
    for (word, block) in templates.words() {
        let name = word.name();
        let known = machine.words.get(name);
        let lacks = known.is_none_or(|known| {
            word.codes().any(|code| !known.codes.contains_key(code) && word == W::CornerMode)
        });
        if lacks {
            let message = format!(
                "the block places `{name}`, and [words.{name}] is missing, or lacks a code"
            );
            errors.push(
                Diagnostic::error(Rule::MachineWord, message)
                    .file(block.file.clone())
                    .line(block.line),
            );
        }
    }
    let joints = [W::J1, W::J2, W::J3, W::J4, W::J5, W::J6];
    // What a control does not say in blocks of its own stands in each motion.
    let mut along = match templates.has(B::CornerDistance) {
        true => vec![W::CornerMode],
        false => vec![W::Corner],
    };
    if !templates.has(B::Feed) {
        along.push(W::F);
    }
    let mut needed = vec![
        (
            B::Frames,
            [pose_words(templates, B::Frames, &POSE), pose_words(templates, B::Frames, &MIDDLE)]
                .concat(),
        ),
        (B::Dwell, vec![W::P]),
    ];
    // Where positions stand behind the instructions, these have their numbers.
    if templates.has(B::Position) {
        needed.extend([
            (B::Position, pose_words(templates, B::Position, &POSE)),
            (B::PositionJoints, joints.to_vec()),
            (B::Joints, vec![W::Point]),
            (B::Linear, [&[W::Point], &along[..]].concat()),
            (B::ArcThrough, [&[W::Point, W::MiddlePoint], &along[..]].concat()),
        ]);
    } else {
        // Of the point half way many controls take the position alone.
        let arc = [pose_words(templates, B::ArcThrough, &POSE), MIDDLE.tip.to_vec()].concat();
        needed.extend([
            (B::Joints, joints.to_vec()),
            (B::Linear, [pose_words(templates, B::Linear, &POSE), along.clone()].concat()),
            (B::ArcThrough, [arc, along].concat()),
        ]);
    }
    for (block, word) in [(B::Feed, W::F), (B::CornerDistance, W::Corner)] {
        if templates.has(block) {
            needed.push((block, vec![word]));
        }
    }
    rail(machine, templates).into_iter().for_each(|error| errors.push(error));
    for (block, words) in needed {
        if !templates.has(block) {
            let message = format!("the block `{}` is missing: a robot needs it", block.name());
            errors.push(Diagnostic::error(Rule::MissingBlock, message).file(machine.file.clone()));
        }
        for word in
            words.into_iter().filter(|word| templates.has(block) && !templates.places(block, *word))
        {
            let message = format!("the block `{}` lacks `{}`", block.name(), word.name());
            errors.push(Diagnostic::error(Rule::MissingWord, message).file(machine.file.clone()));
        }
    }
    let errors = errors.finish();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// What is wrong with where the blocks place the position of a rail: in motions of the joints, which move it; and nowhere without a rail.
fn rail(machine: &Machine, templates: &Templates) -> Option<Diagnostic> {
    use BlockName as B;
    let joints = if templates.has(B::Position) { B::PositionJoints } else { B::Joints };
    let has = machine.cell.as_ref().is_some_and(|cell| cell.rail.is_some());
    let places = templates.has(joints) && templates.places(joints, WordName::Rail);
    let (message, help) = match (has, places) {
        (true, true) | (false, false) => return None,
        (true, false) => (
            format!(
                "the arm stands on a rail (`rail` below [cell]), and the block `{}` lacks `RAIL`",
                joints.name()
            ),
            "`{{RAIL}}` in the blocks of motions, as docs/machines.md shows for each control; URScript has no word for a rail",
        ),
        (false, true) => (
            format!("the block `{}` places `RAIL`, and the arm stands on no rail", joints.name()),
            "`rail` below [cell]",
        ),
    };
    Some(Diagnostic::error(Rule::MissingWord, message).help(help).file(machine.file.clone()))
}

/// The words that a block needs for a pose: with those of the form of the orientation of which it places any.
fn pose_words(templates: &Templates, block: BlockName, words: &PoseWords) -> Vec<WordName> {
    let forms = [&words.turns[..], &words.vector, &words.quaternion];
    let placed = forms.iter().find(|form| form.iter().any(|word| templates.places(block, *word)));
    [&words.tip[..], placed.unwrap_or(&forms[0])].concat()
}

/// What the blocks lack to write the tool's orientation as the machine's file says.
fn orientation(machine: &Machine, templates: &Templates) -> Vec<Diagnostic> {
    use BlockName as B;
    let letters: Vec<WordName> = machine
        .rotary
        .iter()
        .filter_map(|axis| WordName::named(&axis.letter.to_string()))
        .collect();
    let vector = [WordName::VX, WordName::VY, WordName::VZ];
    let settings = &machine.orientation;
    let mut errors: Vec<Diagnostic> = Vec::new();
    for (key, mode) in
        [("simultaneous", settings.simultaneous), ("positioned", settings.positioned)]
    {
        let (name, blocks): (&str, &[BlockName]) = match mode {
            OrientationMode::Fixed => continue,
            OrientationMode::MachineAngles => ("machine-angles", &[B::Retract, B::Rotate]),
            OrientationMode::ToolCenterAngles => {
                ("tool-center-angles", &[B::Retract, B::Rotate, B::ToolCenterOn, B::ToolCenterOff])
            }
            OrientationMode::Vectors => {
                ("vectors", &[B::Retract, B::Rotate, B::ToolCenterOn, B::ToolCenterOff])
            }
            OrientationMode::TiltedPlane => {
                ("tilted-plane", &[B::Retract, B::PlaneTilt, B::PlaneTiltOff])
            }
            OrientationMode::DynamicOffset => (
                "dynamic-offset",
                &[B::Retract, B::Rotate, B::DynamicOffsetOn, B::DynamicOffsetOff],
            ),
        };
        let why = format!("`orientation.{key}` is \"{name}\"");
        for &block in blocks {
            // The axes turn away from the part, and the way of writing is switched: an empty block does neither.
            let switches = [B::ToolCenterOn, B::PlaneTilt, B::DynamicOffsetOn].contains(&block);
            if !templates.has(block) || (switches && machine.leaves_out(block.name())) {
                let message = format!("the block `{}` is missing: {why}", block.name());
                let help = format!("write the block, or let `{key}` be what the blocks can write");
                let error = Diagnostic::error(Rule::MissingBlock, message).help(help);
                errors.push(error.file(machine.file.clone()));
            }
        }
        let cuts = [B::Rapid, B::Linear];
        let placed: Vec<(BlockName, &[WordName])> = match mode {
            OrientationMode::Vectors => cuts.map(|block| (block, &vector[..])).to_vec(),
            OrientationMode::MachineAngles | OrientationMode::ToolCenterAngles
                if key == "simultaneous" =>
            {
                cuts.map(|block| (block, &letters[..])).to_vec()
            }
            OrientationMode::MachineAngles
            | OrientationMode::ToolCenterAngles
            | OrientationMode::TiltedPlane
            | OrientationMode::DynamicOffset
            | OrientationMode::Fixed => Vec::new(),
        };
        let turns = (B::Rotate, &letters[..]);
        let placed =
            placed.into_iter().chain((mode != OrientationMode::TiltedPlane).then_some(turns));
        for (block, words) in placed {
            let Some(text) = machine.blocks.get(block.name()) else { continue };
            for word in words.iter().filter(|word| !templates.places(block, **word)) {
                let message =
                    format!("the block `{}` lacks `{}`: {why}", block.name(), word.name());
                let mut help = format!("put {{{{{}}}}} where the control reads it", word.name());
                if mode == OrientationMode::Vectors {
                    help += "; a control that takes no vectors is given \"tool-center-angles\"";
                }
                let error = Diagnostic::error(Rule::MissingWord, message).help(help);
                errors.push(error.file(text.file.clone()).line(text.line));
            }
        }
        let spatial = [WordName::RX, WordName::SpatialA, WordName::Euler1];
        let tilts = spatial.iter().any(|word| templates.places(B::PlaneTilt, *word));
        let tilt = machine.blocks.get(B::PlaneTilt.name()).filter(|_| templates.has(B::PlaneTilt));
        if let (OrientationMode::TiltedPlane, Some(text), false) = (mode, tilt, tilts) {
            let message = format!("the block `plane_tilt` says no angle of the plane: {why}");
            let help = "put {{RX}} {{RY}} {{RZ}}, {{SPA}} {{SPB}} {{SPC}} or {{E1}} {{E2}} {{E3}} where the control reads them";
            let error = Diagnostic::error(Rule::MissingWord, message).help(help);
            errors.push(error.file(text.file.clone()).line(text.line));
        }
    }
    errors
}

/// Whether the machine can come to say this entry of a code.
fn needs(machine: &Machine, word: WordName, code: &str) -> bool {
    let can = &machine.capabilities;
    // A control has as many of these as it has.
    let any = [WordName::ProbeMode, WordName::Output, WordName::AnalogOutput, WordName::Until];
    if any.contains(&word) {
        return false;
    }
    let plane = |name: &str| can.arcs.iter().any(|p| format!("{p:?}").eq_ignore_ascii_case(name));
    match code {
        "arc_cw" | "arc_ccw" => !can.arcs.is_empty(),
        "xz" | "yz" => plane(code),
        "left" | "right" => can.compensation,
        "per_turn" => can.feed_per_turn,
        "inverse_time" => can.inverse_time,
        // A control has as many work offsets as it has; the first is the one that it works in.
        number if number.starts_with(|c: char| c.is_ascii_digit()) => number == "54",
        _ => true,
    }
}

/// The blocks that a machine needs, and why.
fn promised(machine: &Machine) -> Vec<(BlockName, &'static str)> {
    use BlockName as B;
    let can = &machine.capabilities;
    let mut all = vec![
        (B::Rapid, "every program moves"),
        (B::Linear, "every program cuts"),
        (B::ProgramEnd, "every program ends"),
    ];
    match machine.wire {
        None => all.push((B::ToolChange, "every program calls a tool")),
        Some(_) => {
            all.extend([B::ThreadWire, B::CutWire].map(|block| (block, "the machine has a wire")))
        }
    }
    if !can.arcs.is_empty() {
        all.extend([B::ArcCw, B::ArcCcw].map(|block| (block, "`arcs` are promised")));
    }
    if can.arcs.len() > 1 {
        all.push((B::PlaneSelect, "`arcs` are promised in several planes"));
    }
    for cycle in &can.cycles {
        let block = match cycle {
            CycleName::Drill => B::CycleDrill,
            CycleName::Deep => B::CycleDeep,
            CycleName::BreakChip => B::CycleBreakChip,
            CycleName::Tap => B::CycleTap,
            CycleName::Ream => B::CycleReam,
            CycleName::Bore => B::CycleBore,
        };
        all.push((block, "its cycle is promised"));
        all.extend([B::CycleHole, B::CycleOff].map(|block| (block, "`cycles` are promised")));
    }
    if machine.spindle.dwell > 0.0 {
        all.push((B::Dwell, "`dwell` of [spindle] is given"));
    }
    if machine.has_clamps() {
        all.extend([B::Unclamp, B::Clamp].map(|block| (block, "a rotary axis has a clamp")));
    }
    all.dedup();
    all
}
