//! The page, as it stood in `studio/dist` when this was compiled.

use include_dir::{Dir, include_dir};

static PAGE: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../studio/dist");

/// Whether there is a page.
pub fn is_built() -> bool {
    PAGE.contains("index.html")
}

/// A file of the page by its path, and its type.
pub fn file(path: &str) -> Option<(&'static str, &'static [u8])> {
    let path = if path.is_empty() { "index.html" } else { path };
    let (_, ending) = path.rsplit_once('.')?;
    let kind = match ending {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "woff2" => "font/woff2",
        _ => return None,
    };
    Some((kind, PAGE.get_file(path)?.contents()))
}
