//! A millproject of pcb2gcode 2: each key as the option that does the same, or with the reason why it is not taken.

use geom::INCH;
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;

/// Keys that mean what the machine file says here, or what is always done.
const NEEDLESS: [(&str, &[&str]); 6] = [
    (
        "what is always done",
        &[
            "fill-outline",
            "outline-width",
            "eulerian-paths",
            "tsp-2opt",
            "vectorial",
            "mirror-absolute",
            "metricoutput",
        ],
    ),
    (
        "the paths keep to 5 µm of what is calculated, in an order of short travel, whatever is said",
        &[
            "optimise",
            "backtrack",
            "path-finding-limit",
            "g0-vertical-speed",
            "g0-horizontal-speed",
            "min-path-length",
            "tolerance",
            "g64",
            "dpi",
            "preserve-thermal-reliefs",
        ],
    ),
    (
        "the control and machine files say how tools are changed and what the control understands",
        &["zchange", "zchange-absolute", "nom6", "nog81", "nog91-1", "software", "spindown-time"],
    ),
    (
        "programs have the names of their parts",
        &[
            "basename",
            "front-output",
            "back-output",
            "drill-output",
            "outline-output",
            "milldrill-output",
            "svg",
        ],
    ),
    (
        "heights are measured by --probe with columns and rows, and followed by --heights or --on-control",
        &[
            "al-front",
            "al-back",
            "al-x",
            "al-y",
            "al-probefeed",
            "al-probe-on",
            "al-probe-off",
            "al-probecode",
            "al-probevar",
            "al-setzzero",
            "al-2ndprobefeed",
        ],
    ),
    ("what is odd is a warning; --strict stops for it", &["ignore-warnings", "no-export"]),
];

/// An option of `toolpost pcb` that a file states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stated {
    /// As it is typed, without the dashes in front.
    pub name: String,
    /// What is typed behind it; none for one that needs nothing. Lengths are mm.
    pub values: Vec<String>,
    /// The line of the file, from 1; 0 for one that follows from what the file does not say.
    pub line: u32,
}

/// The keys of a project, with their lines.
struct Project<'a> {
    keys: BTreeMap<&'a str, (&'a str, u32)>,
    metric: bool,
    stated: Vec<Stated>,
    left: Vec<String>,
}

/// The options that a millproject states, and what of it is not taken.
///
/// # Errors
/// A line that is no `key=value`, a value that is none.
pub fn import_millproject(text: &str) -> Result<(Vec<Stated>, Vec<Diagnostic>), Box<Diagnostic>> {
    let mut keys = BTreeMap::new();
    for (i, line) in text.lines().enumerate() {
        let number = i as u32 + 1;
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() || line.starts_with('[') {
            continue;
        }
        let Some((key, value)) = line.split_once('=') else {
            let message = format!("`{}` is no key=value", shown(line));
            let help = "a millproject has one option on each line: `zwork=-0.1mm`";
            return Err(Diagnostic::error(Rule::SettingsKey, message)
                .help(help)
                .line(number)
                .into());
        };
        keys.insert(key.trim(), (value.trim(), number));
    }
    let metric = keys.get("metric").is_some_and(|(value, _)| is_on(value));
    let mut project = Project { keys, metric, stated: Vec::new(), left: Vec::new() };
    project.keys.remove("metric");
    project.taken()?;
    let mut found = Vec::new();
    if !project.left.is_empty() {
        let message = format!("not taken: {}", project.left.join("; "));
        let help = "nothing to do where the reason is enough; else give the option that does it";
        found.push(Diagnostic::warning(Rule::ProjectKey, message).help(help));
    }
    Ok((project.stated, found))
}

fn is_on(value: &str) -> bool {
    matches!(value.to_lowercase().as_str(), "1" | "true" | "yes" | "on")
}

fn shown(text: &str) -> String {
    text.chars().take(60).collect()
}

/// A number to a tenth of a micrometre, as it is typed.
fn typed(mm: f64) -> String {
    ((mm * 1e4).round() / 1e4).to_string()
}

impl Project<'_> {
    fn taken(&mut self) -> Result<(), Box<Diagnostic>> {
        for name in ["front", "back", "outline", "drill"] {
            self.text(name, name);
        }
        self.text("output-dir", "output");
        let depth = self.length("zwork")?;
        self.put(depth.map(|(z, line)| (typed(z.abs()), line)), "depth");
        let travel = self.length("zsafe")?;
        self.put(travel.map(|(z, line)| (typed(z), line)), "travel");
        self.tool()?;
        self.passes()?;
        for (key, option) in [
            ("mill-feed", "feed"),
            ("mill-vertfeed", "plunge"),
            ("mill-infeed", "step"),
            ("drill-feed", "drill-feed"),
            ("cutter-diameter", "outline-tool"),
            ("cut-feed", "outline-feed"),
            ("cut-infeed", "outline-step"),
            ("mirror-axis", ""),
            ("cut-vertfeed", ""),
        ] {
            let found = self.length(key)?;
            match option {
                "" if found.is_some_and(|(value, _)| value != 0.0) => {
                    let why = match key {
                        "mirror-axis" => {
                            "the board is turned over about its middle; the summary says where that is"
                        }
                        _ => "all mills go down at --plunge",
                    };
                    self.left.push(format!("{key} ({why})"));
                }
                "" => {}
                _ => self.put(found.map(|(value, line)| (typed(value), line)), option),
            }
        }
        self.speeds()?;
        self.through()?;
        self.holes()?;
        self.placed()?;
        if let Some((value, line)) = self.keys.remove("mill-feed-direction") {
            // `any` is as it comes here.
            if matches!(value, "climb" | "conventional") {
                self.state("direction", value, line);
            }
        }
        for (key, option, value) in [
            ("voronoi", "isolate", "middle"),
            ("draw-gerber-lines", "isolate", "lines"),
            ("invert-gerbers", "invert", ""),
            ("mirror-yaxis", "turn", "x"),
        ] {
            let Some((_, line)) = self.keys.remove(key).filter(|(given, _)| is_on(given)) else {
                continue;
            };
            let before = self.stated.iter().find(|stated| stated.name == option);
            match before.map(|stated| stated.values.join(",")) {
                None => self.state(option, value, line),
                Some(before) => self.left.push(format!("{key} (--{option} is one: {before})")),
            }
        }
        if let Some((value, line)) = self.keys.remove("spinup-time") {
            let (number, unit) = parted(value);
            let seconds: Option<f64> = number.parse().ok();
            let part = if unit.starts_with("ms") || unit.is_empty() { 1e-3 } else { 1.0 };
            let part = if unit.starts_with("min") { 60.0 } else { part };
            let seconds = seconds.ok_or_else(|| wrong("spinup-time", value, line))?;
            self.state("spin-up", &typed(seconds * part), line);
        }
        for key in
            ["preamble-text", "preamble", "postamble", "pre-milling-gcode", "post-milling-gcode"]
        {
            if self.keys.remove(key).is_some() {
                self.left.push(format!(
                    "{key} (--text-before and --text-after say blocks of the control)"
                ));
            }
        }
        for (why, keys) in NEEDLESS {
            let there: Vec<&str> =
                keys.iter().copied().filter(|key| self.keys.remove(key).is_some()).collect();
            if !there.is_empty() {
                self.left.push(format!("{} ({why})", there.join(", ")));
            }
        }
        let unknown: Vec<String> = self.keys.keys().map(|key| shown(key)).collect();
        if !unknown.is_empty() {
            self.left.push(format!("{} (no key that is known)", unknown.join(", ")));
        }
        Ok(())
    }

    /// Diameters, or the old half of one.
    fn tool(&mut self) -> Result<(), Box<Diagnostic>> {
        let half = self.length("offset")?.filter(|(mm, _)| *mm > 0.0);
        let Some((value, line)) = self.keys.remove("mill-diameters") else {
            self.put(half.map(|(mm, line)| (typed(2.0 * mm), line)), "tool");
            return Ok(());
        };
        if half.is_some() {
            self.left.push(String::from(
                "offset (paths are half a tool from the copper: give a wider tool)",
            ));
        }
        let widths: Option<Vec<f64>> = value.split(',').map(|one| self.mm(one)).collect();
        let mut widths = widths.ok_or_else(|| wrong("mill-diameters", value, line))?;
        widths.sort_by(|a, b| b.total_cmp(a));
        widths.dedup();
        let widths: Vec<String> = widths.into_iter().map(typed).collect();
        self.state("tool", &widths.join(","), line);
        Ok(())
    }

    fn passes(&mut self) -> Result<(), Box<Diagnostic>> {
        let width = self.length("isolation-width")?.filter(|(mm, _)| *mm > 0.0);
        let has_width = width.is_some();
        self.put(width.map(|(mm, line)| (typed(mm), line)), "isolation-width");
        if let Some((value, line)) = self.keys.remove("extra-passes") {
            let more: u32 = value.parse().map_err(|_| wrong("extra-passes", value, line))?;
            if more > 0 && has_width {
                self.left.push(String::from("extra-passes (isolation-width says how wide)"));
            } else if more > 0 {
                self.state("passes", &(more + 1).to_string(), line);
                // Each pass widens the cut by half the tool.
                self.state("overlap", "0.5", line);
            }
        }
        if let Some((value, line)) = self.keys.remove("milling-overlap") {
            match value.strip_suffix('%').and_then(|part| part.trim().parse::<f64>().ok()) {
                Some(percent) if self.stated.iter().all(|stated| stated.name != "overlap") => {
                    self.state("overlap", &typed(percent / 100.0), line);
                }
                Some(_) => {}
                None => self.left.push(String::from(
                    "milling-overlap (--overlap is a part of the width, 0.5 for 50%)",
                )),
            }
        }
        Ok(())
    }

    /// One spindle speed for all tools.
    fn speeds(&mut self) -> Result<(), Box<Diagnostic>> {
        let mut first: Option<f64> = None;
        for key in ["mill-speed", "drill-speed", "cut-speed"] {
            let Some((value, line)) = self.keys.remove(key) else { continue };
            let (number, _) = parted(value);
            let speed: f64 = number.parse().map_err(|_| wrong(key, value, line))?;
            match first {
                None => {
                    first = Some(speed);
                    self.state("speed", &typed(speed), line);
                }
                Some(first) if first == speed => {}
                Some(first) => self.left.push(format!(
                    "{key}={value} (all tools turn at one speed: --speed, or else {first})"
                )),
            }
        }
        Ok(())
    }

    /// How thick the board is, how far drills go through it, and tabs.
    fn through(&mut self) -> Result<(), Box<Diagnostic>> {
        let (cut, drill) = (self.length("zcut")?, self.length("zdrill")?);
        let deepest = [cut, drill].into_iter().flatten();
        let deepest = deepest.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(z, line)| (-z, line));
        // pcb2gcode knows no thickness: with 1.6 mm of board, what is deeper goes through.
        let usual = 1.6;
        let thickness =
            deepest.map_or(usual, |(depth, _)| if depth < usual { depth } else { usual });
        if let Some((depth, line)) = deepest.filter(|(depth, _)| *depth > 0.0) {
            self.state("thickness", &typed(thickness), line);
            self.state("through", &typed(depth - thickness), line);
            if let (Some((a, _)), Some((b, _))) = (cut, drill)
                && a != b
            {
                let key = if a > b { "zcut" } else { "zdrill" };
                self.left
                    .push(format!("{key} (holes and edge go equally deep, {} mm)", typed(depth)));
            }
        }
        let width = self.length("bridges")?.filter(|(mm, _)| *mm > 0.0);
        let count = self.keys.remove("bridgesnum");
        match (width, count) {
            (None, _) => self.state("tabs", "0", 0),
            (Some((mm, line)), count) => {
                self.state("tab-width", &typed(mm), line);
                let (count, line) = count.unwrap_or(("2", line));
                self.state("tabs", count, line);
            }
        }
        if let Some((z, line)) = self.length("zbridges")?
            && width.is_some()
        {
            let height = thickness + z;
            match height > 0.0 && height < thickness {
                true => self.state("tab-height", &typed(height), line),
                false => self.left.push(String::from(
                    "zbridges (tabs are a part of the thickness high: --tab-height)",
                )),
            }
        }
        Ok(())
    }

    fn holes(&mut self) -> Result<(), Box<Diagnostic>> {
        let mill = self.length("milldrill-diameter")?;
        let cutter = self.stated.iter().find(|stated| stated.name == "outline-tool");
        let cutter = cutter.and_then(|stated| stated.values.first().cloned());
        let all = self.keys.remove("milldrill").filter(|(value, _)| is_on(value));
        let over = match self.keys.remove("min-milldrill-hole-diameter") {
            Some((value, _)) if value.eq_ignore_ascii_case("inf") => None,
            Some((value, line)) => {
                let mm = self
                    .mm(value)
                    .ok_or_else(|| wrong("min-milldrill-hole-diameter", value, line))?;
                Some((mm, line))
            }
            None => all.map(|(_, line)| (0.0, line)),
        };
        if let Some((mm, line)) = over {
            let mill = mill.map(|(mm, _)| typed(mm)).or(cutter);
            match mill {
                Some(mill) => {
                    self.state("hole-mill", &mill, line);
                    self.state("mill-holes-over", &typed(mm), line);
                }
                None => self.left.push(String::from("milldrill (no cutter is given: --hole-mill)")),
            }
        } else if mill.is_some() {
            self.left.push(String::from(
                "milldrill-diameter (nothing says which holes are milled: --mill-holes-over)",
            ));
        }
        if self.length("zmilldrill")?.is_some() {
            self.left.push(String::from("zmilldrill (milled holes go as deep as drilled ones)"));
        }
        if let Some((value, line)) = self.keys.remove("drills-available") {
            let one = |one: &str| self.mm(one.split(':').next().unwrap_or_default());
            let drills: Option<Vec<f64>> = value.split(',').map(one).collect();
            let drills = drills.ok_or_else(|| wrong("drills-available", value, line))?;
            let drills: Vec<String> = drills.into_iter().map(typed).collect();
            self.state("drills", &drills.join(","), line);
            if value.contains(':') {
                self.left.push(String::from(
                    "the tolerances of drills-available (one for all: --drill-tolerance)",
                ));
            }
        }
        if self.keys.remove("onedrill").is_some_and(|(value, _)| is_on(value)) {
            self.left
                .push(String::from("onedrill (--drills with one width and --drill-tolerance)"));
        }
        let mut from = None;
        for key in ["drill-side", "drill-front", "cut-side", "cut-front"] {
            let Some((value, line)) = self.keys.remove(key) else { continue };
            let side = match (key.ends_with("front"), value) {
                (true, value) if is_on(value) => "front",
                (true, _) => "back",
                (false, "front" | "back") => value,
                _ => continue,
            };
            match from {
                None => {
                    from = Some(side);
                    self.state("from", side, line);
                }
                Some(other) if other == side => {}
                Some(other) => self.left.push(format!(
                    "{key}={value} (holes and edge are cut from one side, the {other})"
                )),
            }
        }
        Ok(())
    }

    fn placed(&mut self) -> Result<(), Box<Diagnostic>> {
        let (x, y) = (self.length("x-offset")?, self.length("y-offset")?);
        let at = [x, y].map(|found| found.map_or(0.0, |(mm, _)| mm));
        let zero = self.keys.remove("zero-start");
        let line = zero.or(x.map(|(_, line)| ("", line))).map_or(0, |(_, line)| line);
        match (zero.is_some_and(|(value, _)| is_on(value)), at == [0.0; 2]) {
            (true, true) => {}
            (true, false) => self.state("corner", &at.map(typed).join(","), line),
            (false, true) => self.state("as-drawn", "", line),
            (false, false) => {
                self.state("as-drawn", "", line);
                self.left.push(String::from(
                    "x-offset, y-offset (--corner says where the board lies, without as-drawn)",
                ));
            }
        }
        let mut count = |key: &str| -> Result<Option<u32>, Box<Diagnostic>> {
            let Some((value, line)) = self.keys.remove(key) else { return Ok(None) };
            Ok(Some(value.parse().map_err(|_| wrong(key, value, line))?))
        };
        let (columns, rows) = (count("tile-x")?.unwrap_or(1), count("tile-y")?.unwrap_or(1));
        if columns > 1 || rows > 1 {
            self.state("panel", &format!("{columns}x{rows}"), 0);
            self.left.push(String::from(
                "the distance of tiles (pcb2gcode has none between them: --spacing, 4 mm)",
            ));
        }
        Ok(())
    }

    /// A length, or a feed with it, mm.
    fn mm(&self, value: &str) -> Option<f64> {
        let (number, unit) = parted(value);
        let number: f64 = number.parse().ok().filter(|number: &f64| number.abs() < 1e6)?;
        let unit = unit.split('/').next().unwrap_or_default();
        let factor = match unit {
            "" if self.metric => 1.0,
            "mm" | "millimeters" | "millimetres" => 1.0,
            "cm" => 10.0,
            "m" => 1000.0,
            "" | "in" | "inch" | "inches" | "\"" | "i" => INCH,
            "mil" | "mils" | "thou" => INCH / 1000.0,
            _ => return None,
        };
        Some(number * factor)
    }

    fn length(&mut self, key: &str) -> Result<Option<(f64, u32)>, Box<Diagnostic>> {
        let Some((value, line)) = self.keys.remove(key) else { return Ok(None) };
        let per_second = value.contains("/s");
        let mm = self.mm(value).ok_or_else(|| wrong(key, value, line))?;
        Ok(Some((if per_second { mm * 60.0 } else { mm }, line)))
    }

    fn text(&mut self, key: &str, option: &str) {
        if let Some((value, line)) = self.keys.remove(key).filter(|(value, _)| !value.is_empty()) {
            self.state(option, value, line);
        }
    }

    fn put(&mut self, found: Option<(String, u32)>, option: &str) {
        if let Some((value, line)) = found {
            self.state(option, &value, line);
        }
    }

    fn state(&mut self, option: &str, value: &str, line: u32) {
        let values = if value.is_empty() { Vec::new() } else { vec![value.to_owned()] };
        self.stated.push(Stated { name: option.to_owned(), values, line });
    }
}

/// A number and the unit behind it.
fn parted(value: &str) -> (&str, &str) {
    let value = value.trim();
    let end =
        value.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(value.len());
    let (number, unit) = value.split_at(end);
    (number, unit.trim())
}

fn wrong(key: &str, value: &str, line: u32) -> Box<Diagnostic> {
    let message = format!("`{key}={}` is no value of this key", shown(value));
    let help = "a number, with or without a unit: `zwork=-0.1mm`";
    Box::new(Diagnostic::error(Rule::SettingsKey, message).help(help).line(line))
}
