//! `toolpost show`: what a toolpath amounts to, and what it looks like.

use crate::answer::Answer;
use crate::args::Show;
use crate::fit;
use crate::progress::Progress;
use ::post::{ArmMargins, ArmSample, arm_samples};
use app::files::{self, Target};
use app::post;
use app::summary::{Shape, rows};
use app::toolpath::{self, Frame, Toolpath};
use app::{Source, Stop, Watch};
use drawing::{ArmPicture, Format, arm_path};
use program::{Diagnostic, Purpose, Rule};
use serde_json::json;

/// Counts and measures a toolpath and, where a place is given, draws it.
pub fn run(args: &Show, silent: bool) -> Result<Answer, Stop> {
    let path = &args.source.path;
    let output = args.output.as_deref();
    let target = match output {
        Some(output) => Some((Target::new(output, &[path])?, Format::of(output)?)),
        None => None,
    };
    let progress = Progress::new(if target.is_some() { 2 } else { 1 }, silent);
    progress.step("reading");
    let (source, origin) = (Source::from(path.as_path()), args.source.origin.origin());
    let mut toolpath =
        toolpath::read(&source, args.source.strict, &origin, None, Purpose::Picture)?;
    let shape = Shape::of(&toolpath.program);
    let led = args.machine.as_deref().map(|name| led(&mut toolpath, name)).transpose()?;
    if let Some((target, format)) = target {
        progress.step("drawing");
        let swinging = toolpath::swinging(&source, &origin, args.frame)?;
        if swinging.is_none() && args.frame == Frame::Machine {
            let message = "only an NC program says where the axes of a machine go";
            let found = Diagnostic::error(Rule::MachineFrame, message)
                .help("name the machine of the program: `--from MACHINE`");
            return Err(Box::new(found.file(&toolpath.file)).into());
        }
        let program = swinging.as_ref().unwrap_or(&toolpath.program);
        let drawn = match &led {
            Some(led) => arm_path(&toolpath.file, &led.picture),
            None => drawing::tool_path(&toolpath.file, program),
        };
        let picture = format.bytes(drawn)?;
        target.spare(&toolpath.files())?;
        files::save(&[(&target, &picture)])?;
    }
    let mut lines = toolpath.rows(None);
    lines.extend(shape.rows());
    lines.extend(shape.extents());
    lines.extend(led.iter().map(|led| ("margins", led.picture.text.clone())));
    lines.extend(output.map(|output| ("drawing", output.display().to_string())));
    let data = json!({
        "source": toolpath.describe(&shape),
        "drawing": output,
        "margins": led.and_then(|led| led.margins).as_ref().map(fit::data),
    });
    Ok(Answer::product(rows(&lines), data).findings(toolpath.warnings))
}

/// How a robot leads the tool.
struct Led {
    picture: ArmPicture,
    margins: Option<ArmMargins>,
}

/// # Errors
/// The machine is no robot, or it cannot lead the tool along the path.
fn led(toolpath: &mut Toolpath, name: &str) -> Result<Led, Stop> {
    let machine = toolpath::machine_with(name, &[])?;
    let (samples, margins) = arm_samples(&toolpath.program, &machine).map_err(|mut findings| {
        toolpath.quote(&mut findings);
        Stop { verdict: post::verdict(&findings), findings }
    })?;
    let limits = machine
        .arm
        .as_ref()
        .map(|arm| arm.joints().map(|joint| [joint.min, joint.max].map(f64::to_degrees)));
    let drawn = |at: ArmSample| drawing::ArmSample {
        cuts: at.cuts,
        enters_again: at.enters_again,
        time: at.time,
        tip: at.tip,
        joints: at.joints,
        speeds: at.speeds,
        rail: at.rail,
        ease: at.ease,
    };
    let text =
        format!("{}: {}", machine.title, margins.as_ref().map_or_else(String::new, fit::margins));
    let samples = samples.into_iter().map(drawn).collect();
    let rail = machine.cell.as_ref().and_then(|cell| cell.rail);
    let rail = rail.map(|rail| [rail.min, rail.max]);
    let picture = ArmPicture { samples, limits: limits.unwrap_or_default(), rail, text };
    Ok(Led { picture, margins })
}
