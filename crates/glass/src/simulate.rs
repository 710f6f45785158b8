//! A run of a program, tick by tick: pulses that make no point, a stop, and going on from a point (spec 4.12, 4.16).
//!
//! The lamp ticks at the rate of the laser. When the axes have reached a point, the next tick fires; a sensor counts the crack. With
//! feedback a pulse that made none is fired again on the next tick, where the axes stand still.

use crate::control::Run;
use crate::engraver::{Event, Settled, State};
use crate::machine::Machine;
use crate::proof;
use crate::sample::Dice;
use serde::Serialize;

/// How often a pulse is fired at a place, with feedback.
const TIMES: u32 = 4;

/// What happens in a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Events {
    /// The first point that is made, from 1: those before it are made already.
    pub from: u32,
    /// When the run is stopped, s; without, at its end.
    pub until: Option<f64>,
    /// When the door is opened, s.
    pub door: Option<f64>,
    /// The part of the pulses that make no point, from 0 to 1.
    pub misses: f64,
    /// Whether the sensor is listened to.
    pub feedback: bool,
    /// Chooses which pulses make no point.
    pub seed: u64,
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Points of the program.
    pub points: u64,
    /// The first one made, from 1.
    pub from: u32,
    /// Cracks that the sensor counted.
    pub counted: u64,
    /// Pulses fired, also those again.
    pub fired: u64,
    /// Pulses of the laser that passed unused while the axes moved.
    pub unused: u64,
    /// Points without a crack, from 1: all of them.
    pub missed: Vec<u32>,
    /// Time of the run, s.
    pub seconds: f64,
    /// Time until the whole program is done, s: as far as it came, and what is left without misses.
    pub predicted: f64,
    /// The point to go on from, where the run was stopped.
    pub next: Option<u32>,
    /// What the engraver did, from the list before the run to its end.
    pub states: Vec<State>,
}

impl Statistics {
    /// How much of the program is made, from 0 to 1.
    pub fn progress(&self) -> f64 {
        let passed = self.next.map_or(self.points, |next| u64::from(next) - 1);
        passed as f64 / self.points.max(1) as f64
    }

    /// The file that the source's program writes (spec 1.4): duration, progress, start, predicted end, counted points. `start` is
    /// seconds since 1970-01-01 00:00:00.
    pub fn text(&self, start: i64) -> String {
        let end = start + self.predicted.ceil() as i64;
        format!(
            "Duration: {}\nProgress: {:.1} %\nStart date: {}\nPredicted end: {}\nCounted points: {} of {}\n",
            duration(self.seconds),
            100.0 * self.progress(),
            date(start),
            date(end),
            self.counted,
            self.points
        )
    }
}

/// h:mm:ss.
fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}

/// A day of the Gregorian calendar from the days since 1970-01-01 (eras of 400 years that begin in March).
fn date(seconds: i64) -> String {
    let (days, rest) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let from = days + 719_468;
    let (era, day) = (from.div_euclid(146_097), from.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, more) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    let year = era * 400 + year + more;
    let (hours, minutes) = (rest / 3600, rest / 60 % 60);
    format!("{year:04}-{month:02}-{day:02} {hours:02}:{minutes:02}:{:02}", rest % 60)
}

/// Seconds since 1970-01-01 00:00:00 of a date such as `2026-11-26 20:15:00`; `None` where it is none.
pub fn seconds_of(text: &str) -> Option<i64> {
    let (day, time) = text.split_once([' ', 'T'])?;
    let whole = |part: &str| {
        let digits =
            !part.is_empty() && part.len() <= 4 && part.bytes().all(|b| b.is_ascii_digit());
        digits.then(|| part.parse::<i64>().ok()).flatten()
    };
    let day: Vec<i64> = day.split('-').map(whole).collect::<Option<_>>()?;
    let time: Vec<i64> = time.split(':').map(whole).collect::<Option<_>>()?;
    let ([year, month, day], [hour, minute, second]) = (*day.first_chunk()?, *time.first_chunk()?);
    let month_of_march = (month + 9) % 12;
    let year_of_march = year - i64::from(month <= 2);
    let days = 365 * year_of_march + year_of_march.div_euclid(4) - year_of_march.div_euclid(100)
        + year_of_march.div_euclid(400)
        + (153 * month_of_march + 2) / 5
        + day
        - 1
        - 719_468;
    let seconds = days * 86_400 + hour * 3600 + minute * 60 + second;
    // What is no date comes back as another one.
    let given = format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}");
    (date(seconds) == given).then_some(seconds)
}

/// Runs what a program does on `machine`; the time begins with the first pulse's tick.
pub fn simulate(run: &Run, machine: &Machine, events: Events) -> Statistics {
    let rate = machine.laser.rate;
    let steps = proof::Steps::new(run, machine);
    let skipped = (events.from.max(1) as usize - 1).min(steps.len());
    let mut dice = Dice(events.seed);
    let mut statistics = Statistics {
        points: steps.len() as u64,
        from: events.from.max(1),
        counted: 0,
        fired: 0,
        unused: 0,
        missed: Vec::new(),
        seconds: 0.0,
        predicted: 0.0,
        next: None,
        states: Vec::new(),
    };
    let mut tick = 0u64;
    // Whichever comes first.
    let stop = [events.until, events.door].into_iter().flatten().reduce(f64::min);
    for i in skipped..steps.len() {
        let step = if i == skipped { 1 } else { steps.get(i) };
        if stop.is_some_and(|until| (tick + step) as f64 / rate > until) {
            statistics.next = Some(i as u32 + 1);
            break;
        }
        tick += step;
        statistics.unused += step - 1;
        // The axes do not wait within a motion: from this pulse to the next it goes on.
        let is_moving = [i, i + 1]
            .into_iter()
            .any(|at| run.pulses.get(at).is_some_and(|pulse| pulse.passed > 0));
        let mut made = false;
        for again in 0..if events.feedback && !is_moving { TIMES } else { 1 } {
            tick += u64::from(again > 0);
            statistics.fired += 1;
            made = dice.part() >= events.misses;
            if made {
                break;
            }
        }
        statistics.counted += u64::from(made);
        if !made {
            statistics.missed.push(i as u32 + 1);
        }
    }
    let left: u64 = match statistics.next {
        Some(next) => (next as usize - 1..steps.len()).map(|i| steps.get(i)).sum(),
        None => 0,
    };
    let door_opened = statistics.next.is_some() && events.door == stop;
    statistics.states = states(match statistics.next {
        Some(_) if door_opened => &[Event::OpenDoor],
        Some(_) => &[Event::Stop],
        None => &[Event::End, Event::Unload, Event::Arrive],
    });
    statistics.seconds = tick as f64 / rate;
    statistics.predicted = (tick + left) as f64 / rate;
    statistics
}

/// The states of a run whose list is settled, as it is of every program that was proven against its block, and which ends so.
fn states(end: &[Event]) -> Vec<State> {
    let settled =
        Settled { taught: true, extents: true, material: true, sorted: true, tested: true };
    let begin = [
        Event::Check(settled),
        Event::Confirm,
        Event::Warn,
        Event::Start,
        Event::Arrive,
        Event::Warm,
    ];
    let mut states = vec![State::Idle];
    for event in begin.iter().chain(end) {
        let now = states.last().copied().unwrap_or(State::Idle);
        states.extend(now.after(*event));
    }
    states
}
