//! A job: its tools, and its operations with their commands as text.

use crate::dump;
use program::{Coolant, Diagnostic, Rule};
use serde::Deserialize;
use serde_json::Value;

/// A job of FreeCAD's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// What it is called.
    pub name: String,
    /// The box around its stock, where it says it.
    pub stock: Option<Stock>,
    /// Its tools. A tool that it does not describe has a number only.
    pub tools: Vec<Tool>,
    /// What it does, in this order: operations, and what stands between them, tool controllers and work
    /// offsets.
    pub operations: Vec<Operation>,
}

/// The box around the stock of a job, in the coordinates of its commands.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Stock {
    /// Smallest X, Y, Z, mm.
    pub low: [f64; 3],
    /// Largest X, Y, Z, mm.
    pub high: [f64; 3],
}

/// A tool of a job.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Tool {
    /// Its number.
    pub number: u32,
    /// What it is called.
    #[serde(default)]
    pub name: String,
    /// Cutting diameter, mm.
    pub diameter: Option<f64>,
    /// What kind of cutter it is (`endmill`, `ballend`), where the job says it.
    pub shape: Option<String>,
    /// Feed of cuts along X and Y, mm/s, where the job says it.
    pub horizontal_feed: Option<f64>,
}

/// An object of a job with commands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Operation {
    /// Its label.
    pub label: String,
    /// Number of the tool that it is made for, where the job says it.
    pub tool: Option<u32>,
    /// The coolant with which it cuts; none where the job does not say it.
    pub coolant: Option<Coolant>,
    /// How many commands it has, where the job says it.
    pub count: Option<u32>,
    /// Its commands, one a line.
    pub commands: String,
}

/// The file as it stands.
#[derive(Deserialize)]
struct Sheet {
    toolpost: String,
    version: u32,
    #[serde(default)]
    name: String,
    stock: Option<Stock>,
    #[serde(default)]
    tools: Vec<Tool>,
    operations: Vec<OperationSheet>,
}

#[derive(Deserialize)]
struct OperationSheet {
    label: String,
    tool: Option<u32>,
    coolant: Option<CoolantSheet>,
    #[serde(default = "yes")]
    active: bool,
    #[serde(default)]
    invalid: bool,
    count: Option<u32>,
    commands: String,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum CoolantSheet {
    Flood,
    Mist,
}

fn yes() -> bool {
    true
}

/// What `toolpost` says in the head of a job.
const HEAD: &str = "freecad-job";

/// The form of the file that is read.
const VERSION: u32 = 1;

impl Job {
    /// Whether `text` begins as a job does: as JSON, or as FreeCAD's dump of one.
    pub fn begins(text: &[u8]) -> bool {
        text.trim_ascii_start().starts_with(b"{") || dump::begins(text)
    }

    /// Reads a job; one that has no name is called as its file is.
    ///
    /// # Errors
    /// What is no job, with `file_name`, line and column.
    pub fn of(file_name: &str, text: &[u8]) -> Result<Job, Box<Diagnostic>> {
        let read = if dump::begins(text) { dump::read(text) } else { from_json(text) };
        read.map(|job| job.called(file_name)).map_err(|found| found.file(file_name).into())
    }

    /// The same of a job that was never text: what its JSON would hold.
    ///
    /// # Errors
    /// What is no job, with `file_name`.
    pub fn of_value(file_name: &str, value: Value) -> Result<Job, Box<Diagnostic>> {
        let read = serde_json::from_value(value).map_err(|error| no_job(&error.to_string()).into());
        let read = read.and_then(from_sheet);
        read.map(|job| job.called(file_name)).map_err(|found| found.file(file_name).into())
    }

    /// With the name of its file where it has none.
    fn called(mut self, file_name: &str) -> Job {
        if self.name.is_empty() {
            let stem = file_name.rsplit_once('.').map_or(file_name, |(stem, _)| stem);
            self.name = stem.to_owned();
        }
        self
    }
}

fn from_json(text: &[u8]) -> Result<Job, Box<Diagnostic>> {
    let sheet = serde_json::from_slice(text).map_err(|error| {
        let line = u32::try_from(error.line()).unwrap_or(u32::MAX);
        let shown = text.split(|&byte| byte == b'\n').nth(error.line().saturating_sub(1));
        let column = error.column().saturating_sub(1);
        // serde_json ends its message with the place.
        let message = error.to_string();
        let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(said, _)| said);
        no_job(message).at(line, shown.unwrap_or_default(), column, column + 1)
    })?;
    from_sheet(sheet)
}

fn no_job(message: &str) -> Diagnostic {
    Diagnostic::error(Rule::FreecadJob, format!("this is no job of FreeCAD: {message}"))
        .help("post from FreeCAD, or let FreeCAD write the job anew")
}

fn from_sheet(sheet: Sheet) -> Result<Job, Box<Diagnostic>> {
    if sheet.toolpost != HEAD || sheet.version != VERSION {
        let (head, version) = (sheet.toolpost, sheet.version);
        let message = format!("`{head}`, version {version}: `{HEAD}`, version {VERSION} is read");
        let help = "the part of Toolpost in FreeCAD and this one have to be of one version";
        return Err(Diagnostic::error(Rule::FreecadJob, message).help(help).into());
    }
    let active = || sheet.operations.iter().filter(|operation| operation.active);
    if let Some(invalid) = active().find(|operation| operation.invalid) {
        let message =
            format!("{}: FreeCAD could not recompute this operation (Invalid)", invalid.label);
        let help = "mend it and recompute, or switch it off (Active)";
        return Err(Diagnostic::error(Rule::FreecadInvalid, message).help(help).into());
    }
    let active = sheet.operations.into_iter().filter(|operation| operation.active);
    let operations = active.map(|operation| Operation {
        label: operation.label,
        tool: operation.tool,
        coolant: operation.coolant.map(|coolant| match coolant {
            CoolantSheet::Flood => Coolant::Flood,
            CoolantSheet::Mist => Coolant::Mist,
        }),
        count: operation.count,
        commands: operation.commands,
    });
    let operations = operations.collect();
    Ok(Job { name: sheet.name, stock: sheet.stock, tools: sheet.tools, operations })
}
