//! `toolpost show`: what a toolpath amounts to, and what it looks like.

use crate::answer::Answer;
use crate::args::Show;
use crate::progress::Progress;
use app::files::{self, Target};
use app::summary::{Shape, rows};
use app::toolpath::{self, Frame};
use app::{Source, Stop, Watch};
use drawing::Format;
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
    let toolpath = toolpath::read(&source, args.source.strict, &origin, None, Purpose::Picture)?;
    let shape = Shape::of(&toolpath.program);
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
        let picture = format.bytes(drawing::tool_path(&toolpath.file, program))?;
        target.spare(&toolpath.files())?;
        files::save(&[(&target, &picture)])?;
    }
    let mut lines = toolpath.rows(None);
    lines.extend(shape.rows());
    lines.extend(shape.extents());
    lines.extend(output.map(|output| ("drawing", output.display().to_string())));
    let data = json!({
        "source": toolpath.describe(&shape),
        "drawing": output,
    });
    Ok(Answer::product(rows(&lines), data).findings(toolpath.warnings))
}
