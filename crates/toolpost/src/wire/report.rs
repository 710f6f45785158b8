//! What a wire cuts, in numbers: points, chord errors, areas, time, and what came from which line.

use super::leg::{self, End, Leg};
use crate::args::Division;
use crate::drawing::{WireLeg, WirePicture};
use crate::summary::{duration, length, number};
use ::wire::points::Step;
use ::wire::{Accuracy, Chords};
use machine::Machine;
use program::Program;
use serde_json::{Value, json};

/// What is cut.
pub struct Cut {
    /// The ways of the wire, in their order.
    pub legs: Vec<Leg>,
    /// How well the points of each follow the lower and the upper contour.
    accuracy: Vec<(Accuracy, Option<Accuracy>)>,
    /// Height of the upper contour, mm.
    height: Option<f64>,
    memory: Option<usize>,
    /// mm/s.
    feed: Option<f64>,
    /// Whether the program says the feed.
    says_feed: bool,
}

impl Cut {
    pub fn of(legs: Vec<Leg>, machine: &Machine, how: &Division) -> Cut {
        let measured = |leg: &Leg| match &leg.points {
            Some(points) => Accuracy::of(&leg.path, points),
            None => (Accuracy::default(), None),
        };
        Cut {
            accuracy: legs.iter().map(measured).collect(),
            height: machine.wire.and_then(|wire| wire.height),
            memory: machine.wire.and_then(|wire| wire.memory),
            feed: how.feed,
            says_feed: machine.words.contains_key("F"),
            legs,
        }
    }

    /// The program to write.
    pub fn program(&self, name: &str) -> Program {
        leg::program(name, &self.legs, self.height.unwrap_or(f64::INFINITY), self.feed_word())
    }

    /// The same as one end of the wire goes, arcs and all.
    pub fn end(&self, name: &str, end: End) -> Program {
        leg::end(name, &self.legs, end, self.feed_word())
    }

    /// mm/min, where the program says it.
    fn feed_word(&self) -> Option<f64> {
        self.feed.filter(|_| self.says_feed).map(|feed| feed * 60.0)
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

    fn points(&self) -> Option<usize> {
        self.legs.iter().map(|leg| Some(leg.points.as_ref()?.lower.len())).sum()
    }

    fn length(&self) -> f64 {
        self.legs.iter().map(|leg| leg.path.length()).sum()
    }

    /// Cutting time, s.
    fn time(&self) -> Option<f64> {
        self.feed.map(|feed| self.length() / feed)
    }

    /// By how much the area within the points differs from that within the contour, mm².
    fn area_error(&self, end: End) -> Option<f64> {
        let of = |(lower, upper): &(Accuracy, Option<Accuracy>)| match end {
            End::Lower => lower.area_error,
            End::Upper => upper.as_ref()?.area_error,
        };
        self.accuracy.iter().map(of).sum()
    }

    /// The points that came from a line, as leg, first and last.
    fn of_line(&self, line: u32) -> impl Iterator<Item = (usize, usize, usize)> {
        self.legs.iter().enumerate().flat_map(move |(i, leg)| {
            let ranges = leg.points.iter().flat_map(move |points| points.of_line(line));
            ranges.map(move |range| (i + 1, range.start + 1, range.end))
        })
    }

    /// The numbers, as JSON.
    pub fn summary(&self, selected: Option<u32>) -> Value {
        let legs = self.legs.iter().zip(&self.accuracy);
        let openings: Vec<Value> = legs.map(|(leg, accuracy)| opening(leg, accuracy)).collect();
        let selected =
            selected.map(|line| json!({ "line": line, "points": ranges(self.of_line(line)) }));
        json!({
            "openings": openings,
            "height_mm": self.height,
            "memory": self.memory,
            "points": self.points(),
            "chord_error": chords(&self.chords()),
            "area_error_mm2": self.area_error(End::Lower),
            "upper_area_error_mm2": self.area_error(End::Upper),
            "length_mm": self.length(),
            "feed_mm_per_s": self.feed,
            "cutting_time_s": self.time(),
            "selected": selected,
        })
    }

    /// Which points came from which line of the source, as JSON. Points count from 1 in each opening.
    pub fn instructions(&self) -> Value {
        let mut all = Vec::new();
        for (i, leg) in self.legs.iter().enumerate() {
            let Some(points) = &leg.points else { continue };
            for (element, found) in leg.path.lower().elements().iter().enumerate() {
                let range = points.of_element(element);
                all.push(json!({
                    "line": found.line,
                    "opening": i + 1,
                    "first_point": range.start + 1,
                    "last_point": range.end,
                }));
            }
        }
        json!(all)
    }

    /// The lines of a summary.
    pub fn rows(&self, selected: Option<u32>) -> Vec<(&'static str, String)> {
        let mut rows = Vec::new();
        for (i, leg) in self.legs.iter().enumerate() {
            let contour = leg.path.lower();
            let area = match contour.is_closed() {
                true => format!("closed, {} mm²", number(contour.area().abs(), 3)),
                false => String::from("open"),
            };
            let leans = if leg.leans() { ", the wire leans" } else { "" };
            let head = if i == 0 { "openings" } else { "" };
            rows.push((head, format!("{}, {area}{leans}", length(leg.path.length()))));
        }
        if let Some(points) = self.points() {
            let chords = self.chords();
            let step = self.legs.iter().find_map(|leg| Some(leg.points.as_ref()?.step));
            rows.push(("points", format!("{points}, {}", step.map_or(String::new(), shown))));
            rows.push((
                "chord error",
                format!(
                    "{} mm at most, {} mm in the mean, {} of the radius",
                    small(chords.largest),
                    small(chords.mean),
                    small(chords.mean_relative)
                ),
            ));
            if let Some(area) = self.area_error(End::Lower) {
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
        rows.push((
            "time",
            match (self.time(), self.feed) {
                (Some(time), Some(feed)) => format!("{} at {feed} mm/s", duration(time)),
                _ => String::from("not known: --feed gives the feed"),
            },
        ));
        if let Some(line) = selected {
            let found: Vec<String> = self
                .of_line(line)
                .map(|(opening, first, last)| {
                    let place = if self.legs.len() > 1 {
                        format!(" of opening {opening}")
                    } else {
                        String::new()
                    };
                    format!("points {first} to {last}{place}")
                })
                .collect();
            let found = if found.is_empty() { String::from("no points") } else { found.join(", ") };
            rows.push(("selected", format!("line {line}: {found}")));
        }
        rows
    }

    /// What is drawn.
    pub fn picture(&self, selected: Option<u32>) -> WirePicture<'_> {
        let legs =
            self.legs.iter().map(|leg| WireLeg { path: &leg.path, points: leg.points.as_ref() });
        WirePicture { legs: legs.collect(), height: self.height, selected }
    }
}

fn opening(leg: &Leg, (lower, upper): &(Accuracy, Option<Accuracy>)) -> Value {
    let contour = leg.path.lower();
    let arcs = |accuracy: &Accuracy| -> Vec<Value> {
        let arcs = accuracy.arcs.iter();
        arcs.map(|arc| json!({ "line": arc.line, "radius_mm": arc.radius, "chord_error": chords(&arc.chords) }))
            .collect()
    };
    let step = leg.points.as_ref().map(|points| match points.step {
        Step::Length(mm) => json!({ "arc_length_mm": mm }),
        Step::ChordError(mm) => json!({ "chord_error_mm": mm }),
        Step::Fit => json!("fit"),
    });
    json!({
        "line": leg.line(),
        "closed": contour.is_closed(),
        "start_mm": contour.start().to_array(),
        "area_mm2": contour.is_closed().then(|| contour.area().abs()),
        "length_mm": leg.path.length(),
        "leans": leg.leans(),
        "points": leg.points.as_ref().map(|points| points.lower.len()),
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

fn ranges(of_line: impl Iterator<Item = (usize, usize, usize)>) -> Vec<Value> {
    of_line
        .map(|(opening, first, last)| json!({ "opening": opening, "first": first, "last": last }))
        .collect()
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
