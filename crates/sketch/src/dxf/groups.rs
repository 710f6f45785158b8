//! The file as pairs of a code and a value, each on a line of its own.

use program::{Diagnostic, Rule};

/// One pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group<'a> {
    /// What the value means.
    pub code: i32,
    /// The value, without the blanks around it.
    pub value: &'a [u8],
    /// Line of the value, from 1.
    pub line: u32,
}

impl Group<'_> {
    /// The value as a number.
    pub fn number(&self) -> Result<f64, Box<Diagnostic>> {
        let text = std::str::from_utf8(self.value).unwrap_or("");
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.refused(Rule::DxfNumber, "this is no number")),
        }
    }

    /// The value as a whole number.
    pub fn whole(&self) -> Result<i64, Box<Diagnostic>> {
        let text = std::str::from_utf8(self.value).unwrap_or("");
        text.parse().map_err(|_| self.refused(Rule::DxfNumber, "this is no whole number"))
    }

    fn refused(&self, rule: Rule, what: &str) -> Box<Diagnostic> {
        let message = format!("{what}, and code {} needs one", self.code);
        let refused = Diagnostic::error(rule, message).help("save the drawing again");
        refused.on(self.line, self.value).into()
    }
}

/// The pairs of `text`, up to the end of the file.
pub(super) fn groups(text: &[u8]) -> Result<Vec<Group<'_>>, Box<Diagnostic>> {
    if text.starts_with(b"AutoCAD Binary DXF") {
        let refused = Diagnostic::error(Rule::DxfBinary, "the drawing is a binary DXF file");
        return Err(refused.help("save it as an ASCII DXF file").line(1).into());
    }
    let text = text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text);
    let mut lines = text.split(|byte| *byte == b'\n').zip(1u32..);
    let mut groups = Vec::new();
    while let Some((code, number)) = lines.next() {
        let code = code.trim_ascii();
        let parsed = std::str::from_utf8(code).ok().and_then(|text| text.parse::<i32>().ok());
        let Some(parsed) = parsed else {
            if code.is_empty() && lines.all(|(rest, _)| rest.trim_ascii().is_empty()) {
                break;
            }
            let refused = Diagnostic::error(Rule::DxfCode, "this is no group code of a DXF file");
            let refused = refused.help("save the drawing as an ASCII DXF file");
            return Err(refused.on(number, code).into());
        };
        let Some((value, line)) = lines.next() else {
            let refused = Diagnostic::error(Rule::DxfCode, "the file ends after a group code");
            return Err(refused.help("the file is not whole").on(number, code).into());
        };
        let value = value.trim_ascii();
        groups.push(Group { code: parsed, value, line });
        if parsed == 0 && value == b"EOF" {
            return Ok(groups);
        }
    }
    let refused = Diagnostic::error(Rule::DxfCode, "the file ends without EOF");
    Err(refused.help("the file is not whole").into())
}
