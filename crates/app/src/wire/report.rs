//! What a wire cuts, in numbers: points, chord errors, areas, time, and what came from which line.

use crate::account::Account;
use crate::summary::{duration, length, number};
use ::wire::points::Step;
use ::wire::segment::{self, End, Segment};
use ::wire::{Accuracy, Chords};
use drawing::{WirePicture, WireSegment};
use machine::Machine;
use program::{NoPose, Op, Program, Record};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// The most segments that a summary lists.
const MOST_ROWS: usize = 12;

/// What is cut.
#[derive(Debug)]
pub struct Cut {
    /// The segments of the wire path, in their order.
    pub segments: Vec<Segment>,
    /// How well the points of each follow the lower and the upper contour.
    accuracy: Vec<(Accuracy, Option<Accuracy>)>,
    /// Height of the part, and so of the upper contour, mm.
    height: Option<f64>,
    memory: Option<usize>,
    /// Whether the program says how fast.
    says_feed: bool,
}

impl Cut {
    /// `segments` as `machine` cuts them, in a part `height` mm high.
    pub fn of(segments: Vec<Segment>, height: Option<f64>, machine: &Machine) -> Cut {
        let measured = |segment: &Segment| match &segment.points {
            Some(points) => Accuracy::of(&segment.path, points),
            None => (Accuracy::default(), None),
        };
        Cut {
            accuracy: segments.iter().map(measured).collect(),
            height,
            memory: machine.wire.and_then(|wire| wire.memory),
            says_feed: machine.words.contains_key("F"),
            segments,
        }
    }

    /// Height of the part, mm, where it is given.
    pub fn height(&self) -> Option<f64> {
        self.height
    }

    /// The feeds of a program that does not say them, mm/min: of each record of [`Cut::source`] the one that is set at the machine.
    /// Empty where the program says them.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn feeds_aside(&self, name: &str) -> Result<Vec<Option<f64>>, NoPose> {
        if self.says_feed {
            return Ok(Vec::new());
        }
        let program = self.whole(name, true)?;
        let mut feed = None;
        let of_record = |record: &Record| match record.op {
            Op::Feed(new) => {
                feed = Some(new.value());
                None
            }
            _ => Some(feed),
        };
        Ok(program.records.iter().filter_map(of_record).collect())
    }

    /// What the program is compared with as a whole: the contour with its arcs where the wire is upright, where it leans its points.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn source(&self, name: &str) -> Result<Program, NoPose> {
        self.whole(name, self.says_feed)
    }

    fn whole(&self, name: &str, feeds: bool) -> Result<Program, NoPose> {
        match self.segments.iter().any(Segment::leans) {
            true => self.points_program(name, feeds),
            false => segment::end(name, &self.segments, End::Lower, feeds),
        }
    }

    /// The program to write.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn program(&self, name: &str) -> Result<Program, NoPose> {
        self.points_program(name, self.says_feed)
    }

    fn points_program(&self, name: &str, feeds: bool) -> Result<Program, NoPose> {
        segment::program(name, &self.segments, self.height.unwrap_or(f64::INFINITY), feeds)
    }

    /// The same for one end of the wire, with its arcs.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn end(&self, name: &str, end: End) -> Result<Program, NoPose> {
        segment::end(name, &self.segments, end, self.says_feed)
    }

    /// The chord errors of both ends together.
    fn chords(&self) -> Chords {
        let ends = self.accuracy.iter().flat_map(|(lower, upper)| [Some(lower), upper.as_ref()]);
        let mut all = Chords::default();
        for chords in ends.flatten().map(|end| end.all).filter(|chords| chords.count > 0) {
            let (a, b) = (all.count as f64, chords.count as f64);
            let mean = |x: f64, y: f64| (x * a + y * b) / (a + b);
            all = Chords {
                count: all.count + chords.count,
                largest: all.largest.max(chords.largest),
                mean: mean(all.mean, chords.mean),
                mean_relative: mean(all.mean_relative, chords.mean_relative),
            };
        }
        all
    }

    /// The largest chord error, mm.
    pub fn chord_error(&self) -> f64 {
        self.chords().largest
    }

    /// Points of the program: a segment that goes on from where the last one ended begins with its last.
    pub fn points(&self) -> Option<usize> {
        let points = |segment: &Segment| {
            Some(segment.points.as_ref()?.lower.len() - usize::from(!segment.thread))
        };
        self.segments.iter().map(points).sum()
    }

    /// The segments with the number of points before each, which its own are counted on from.
    fn counted(&self) -> impl Iterator<Item = (usize, &Segment)> {
        let mut all = 0;
        self.segments.iter().map(move |segment| {
            let before = all - usize::from(!segment.thread);
            all = before + segment.points.as_ref().map_or(1, |points| points.lower.len());
            (before, segment)
        })
    }

    fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.path.length()).sum()
    }

    /// Cutting time, s.
    fn time(&self) -> Option<f64> {
        self.segments
            .iter()
            .map(|segment| segment.feed.map(|feed| segment.path.length() / feed * 60.0))
            .sum()
    }

    /// By how much the area within the points differs from that within the contour, mm².
    fn area_error(&self, end: End) -> Option<f64> {
        let of = |(lower, upper): &(Accuracy, Option<Accuracy>)| match end {
            End::Lower => lower.area_error,
            End::Upper => upper.as_ref()?.area_error,
        };
        self.accuracy.iter().map(of).sum()
    }

    /// The points that came from a line, first and last, as the program counts them from 1.
    fn of_line(&self, line: u32) -> impl Iterator<Item = (usize, usize)> {
        self.counted().flat_map(move |(before, segment)| {
            let ranges = segment.points.iter().flat_map(move |points| points.of_line(line));
            ranges.map(move |range| (before + range.start + 1, before + range.end))
        })
    }

    /// The numbers, as JSON, with the first `most` segments.
    pub fn summary(&self, selected: Option<u32>, most: usize) -> Summary<'_> {
        let ranges = |line| -> Vec<Value> {
            let found = self.of_line(line);
            found.map(|(first, last)| json!({ "first": first, "last": last })).collect()
        };
        let left_out = self.segments.len().saturating_sub(most);
        Summary {
            segments: Listed { cut: self, most },
            segments_left_out: (left_out > 0).then_some(left_out),
            height_mm: self.height,
            memory: self.memory,
            points: self.points(),
            chord_error: chords(&self.chords()),
            area_error_mm2: self.area_error(End::Lower),
            upper_area_error_mm2: self.area_error(End::Upper),
            length_mm: self.length(),
            cutting_time_s: self.time(),
            selected: selected.map(|line| json!({ "line": line, "points": ranges(line) })),
        }
    }

    /// Which points came from which line of the source, as JSON; points count from 1.
    pub fn instructions(&self) -> Instructions<'_> {
        Instructions(self)
    }

    /// The lines of a summary.
    pub fn rows(&self, selected: Option<u32>) -> Vec<(&'static str, String)> {
        let mut rows = Vec::new();
        for (i, segment) in self.segments.iter().enumerate().take(MOST_ROWS) {
            rows.push((if i == 0 { "segments" } else { "" }, row(segment)));
        }
        if self.segments.len() > MOST_ROWS {
            rows.push(("", format!("and {} more", self.segments.len() - MOST_ROWS)));
        }
        rows.push(("length", length(self.length())));
        if let Some(points) = self.points() {
            let step = self.segments.iter().find_map(|segment| Some(segment.points.as_ref()?.step));
            let chords = self.chords();
            // What has no arcs has no chords either: its points are where the source has them.
            let step = if chords.count > 0 {
                step.map_or(String::new(), shown)
            } else {
                "the ends of straight moves".into()
            };
            rows.push(("points", format!("{points}, {step}")));
            if chords.count > 0 {
                let (largest, mean) = (small(chords.largest), small(chords.mean));
                let of_radius = small(chords.mean_relative);
                let text =
                    format!("{largest} mm at most, mean {mean} mm, {of_radius} of the radius");
                rows.push(("chord error", text));
            }
            if let Some(area) = self.area_error(End::Lower).filter(|_| chords.count > 0) {
                let upper = self.area_error(End::Upper);
                let upper = upper.map(|area| format!(" below, {} mm² above", number(area, 6)));
                let text = format!("{} mm²{}", number(area, 6), upper.unwrap_or_default());
                rows.push(("area error", text));
            }
            rows.push((
                "memory",
                match self.memory {
                    Some(most) => format!("holds {most} points"),
                    None => {
                        String::from("not checked: neither the machine file nor --memory gives it")
                    }
                },
            ));
        }
        let time = self.time().map_or(String::from("not known: --feed gives the feed"), duration);
        rows.push(("time", time));
        if let Some(line) = selected {
            let found = self.of_line(line).map(|(first, last)| format!("points {first} to {last}"));
            let found: Vec<String> = found.collect();
            let found = if found.is_empty() { String::from("no points") } else { found.join(", ") };
            rows.push(("selected", format!("line {line}: {found}")));
        }
        rows
    }

    /// What is drawn.
    pub fn picture(&self, selected: Option<u32>) -> WirePicture<'_> {
        let segments = self.segments.iter().map(|segment| WireSegment {
            path: &segment.path,
            points: segment.points.as_ref(),
            threaded: segment.thread,
        });
        WirePicture { segments: segments.collect(), height: self.height, selected }
    }
}

/// The report of a program: what its account says, with all segments, and points. Its lists are written entry by entry: as JSON values
/// 500,000 segments took 3.5 GB.
pub struct Report<'a> {
    pub account: &'a Account,
    pub cut: &'a Cut,
    pub selected: Option<u32>,
}

impl Report<'_> {
    /// The report as it is saved.
    pub fn text(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("all keys are texts");
        text.push('\n');
        text
    }
}

impl Serialize for Report<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Report { account, cut, selected } = self;
        let mut report = serializer.serialize_map(None)?;
        for (key, value) in account.data.as_object().into_iter().flatten() {
            if key == "wire" {
                report.serialize_entry(key, &cut.summary(*selected, usize::MAX))?;
            } else {
                report.serialize_entry(key, value)?;
            }
        }
        report.serialize_entry("instructions", &cut.instructions())?;
        report.serialize_entry("warnings", &account.findings)?;
        report.end()
    }
}

/// The numbers of a cut.
#[derive(Serialize)]
pub struct Summary<'a> {
    segments: Listed<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    segments_left_out: Option<usize>,
    height_mm: Option<f64>,
    memory: Option<usize>,
    points: Option<usize>,
    chord_error: Value,
    area_error_mm2: Option<f64>,
    upper_area_error_mm2: Option<f64>,
    length_mm: f64,
    cutting_time_s: Option<f64>,
    selected: Option<Value>,
}

/// The first segments of a cut.
struct Listed<'a> {
    cut: &'a Cut,
    most: usize,
}

impl Serialize for Listed<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let segments = self.cut.segments.iter().zip(&self.cut.accuracy).take(self.most);
        serializer.collect_seq(segments.map(|(segment, accuracy)| data(segment, accuracy)))
    }
}

/// Which points came from which line of the source.
pub struct Instructions<'a>(&'a Cut);

impl Serialize for Instructions<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let divided = self.0.counted().filter_map(|(before, segment)| {
            let elements = segment.path.lower().elements();
            Some((before, segment.points.as_ref()?, elements))
        });
        serializer.collect_seq(divided.flat_map(|(before, points, elements)| {
            elements.iter().enumerate().map(move |(element, found)| {
                let range = points.of_element(element);
                json!({
                    "line": found.line,
                    "first_point": before + range.start + 1,
                    "last_point": before + range.end,
                })
            })
        }))
    }
}

/// A segment of the wire path, as JSON.
fn data(segment: &Segment, (lower, upper): &(Accuracy, Option<Accuracy>)) -> Value {
    let contour = segment.path.lower();
    let arcs = |accuracy: &Accuracy| -> Vec<Value> {
        let arcs = accuracy.arcs.iter();
        arcs.map(|arc| json!({ "line": arc.line, "radius_mm": arc.radius, "chord_error": chords(&arc.chords) }))
            .collect()
    };
    let step = segment.points.as_ref().map(|points| match points.step {
        Step::Length(mm) => json!({ "arc_length_mm": mm }),
        Step::ChordError(mm) => json!({ "chord_error_mm": mm }),
        Step::Fit => json!("fit"),
    });
    json!({
        "contour": segment.opening + 1,
        "pass": segment.pass + 1,
        "tab": segment.tab,
        "line": segment.line(),
        "feed_mm_per_s": segment.feed.map(|feed| feed / 60.0),
        "closed": contour.is_closed(),
        "start_mm": contour.start().to_array(),
        "area_mm2": contour.is_closed().then(|| contour.area().abs()),
        "length_mm": segment.path.length(),
        "leans": segment.leans(),
        "points": segment.points.as_ref().map(|points| points.lower.len()),
        "step": step,
        "arcs": arcs(lower),
        "upper_arcs": upper.as_ref().map(arcs),
        "area_error_mm2": lower.area_error,
        "upper_area_error_mm2": upper.as_ref().and_then(|upper| upper.area_error),
    })
}

fn chords(chords: &Chords) -> Value {
    json!({
        "points": chords.count,
        "largest_mm": chords.largest,
        "mean_mm": chords.mean,
        "mean_relative": chords.mean_relative,
    })
}

/// A segment of the wire path, for a person.
fn row(segment: &Segment) -> String {
    let contour = segment.path.lower();
    let area = match contour.is_closed() {
        true => format!("closed, {} mm²", number(contour.area().abs(), 3)),
        false => String::from("open"),
    };
    let pass = match (segment.tab, segment.pass) {
        (true, _) => String::from("the tab"),
        (false, pass) => format!("pass {}", pass + 1),
    };
    let leans = if segment.leans() { ", the wire leans" } else { "" };
    format!(
        "contour {}, {pass}: {}, {area}{leans}",
        segment.opening + 1,
        length(segment.path.length())
    )
}

fn shown(step: Step) -> String {
    match step {
        Step::Length(mm) => format!("a step of {} mm on arcs", number(mm, 6)),
        Step::ChordError(mm) => format!("a chord error of {} mm", small(mm)),
        Step::Fit => String::new(),
    }
}

/// A small number to four digits.
fn small(value: f64) -> String {
    if value == 0.0 || (1e-3..1e3).contains(&value) {
        number(value, 6)
    } else {
        format!("{value:.3e}")
    }
}
