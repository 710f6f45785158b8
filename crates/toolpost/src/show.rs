//! `toolpost show`: what a toolpath amounts to, and what it looks like.

use crate::answer::{Answer, Stop};
use crate::args::Show;
use crate::files::{self, Target};
use crate::progress::Progress;
use crate::summary::{Shape, rows};
use crate::{drawing, toolpath};
use program::Diagnostic;
use serde_json::json;
use std::path::Path;

/// Counts and measures a toolpath and, where a place is given, draws it.
pub fn run(args: &Show, silent: bool) -> Result<Answer, Stop> {
    let path = &args.source.path;
    let output = args.output.as_deref();
    let target = match output {
        Some(output) => Some((Target::new(output, &[path])?, is_png(output)?)),
        None => None,
    };
    let progress = Progress::new(if target.is_some() { 2 } else { 1 }, silent);
    progress.step("reading");
    let toolpath = toolpath::read(path, args.source.strict, &args.source.origin)?;
    let shape = Shape::of(&toolpath.program);
    if let Some((target, png)) = target {
        progress.step("drawing");
        let svg = drawing::svg(&toolpath.file, &toolpath.program);
        let picture = if png { drawing::png(&svg)? } else { svg.into_bytes() };
        files::save(&[(&target, &picture)])?;
    }
    let mut lines = vec![("toolpath", format!("{} ({})", toolpath.file, toolpath.dialect))];
    lines.extend(shape.rows());
    lines.extend(shape.extents());
    lines.extend(output.map(|output| ("drawing", output.display().to_string())));
    let data = json!({
        "source": toolpath.describe(&shape),
        "drawing": output,
    });
    Ok(Answer::product(rows(&lines), data).findings(toolpath.warnings))
}

/// Whether a drawing is saved as PNG; otherwise it is SVG.
fn is_png(output: &Path) -> Result<bool, Stop> {
    let ending = output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match ending.as_str() {
        "png" => Ok(true),
        "svg" => Ok(false),
        _ => Err(Diagnostic::error("drawing", format!("cannot draw {}", output.display()))
            .help("a drawing is a .svg or a .png")
            .into()),
    }
}
