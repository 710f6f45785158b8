//! How fast the tool tip really goes where the number behind F does not say it: in inverse time, and where rotary axes turn
//! and the control counts other ways than the tip's.

use crate::gauge::Gauge;
use crate::resolved_pose::Number;
use crate::state::{self, Difference};
use control::{FeedPath, Orientation, Position};
use geom::Vec3;
use machine::Machine;
use program::{Feed, Rule, Spindle};

/// A way of the tip below this, mm, is none: the tool turns about its tip.
pub(crate) const STANDS: f64 = 1e-6;

/// A way that is so many times its rounding is long enough to have a speed.
pub(crate) const TIMED: f64 = 8.0;

/// By how much a difference of times may be off, as a part of them.
const ROUNDED: f64 = 1e-12;

/// A cut of the program, and what the source wants of it.
pub(crate) struct Cut<'a> {
    pub gauge: &'a Gauge<'a>,
    pub from: &'a Position,
    pub to: &'a Position,
    /// Length of its arc, mm; without a value it is straight.
    pub arc: Option<f64>,
    /// What its control counts.
    pub path: FeedPath,
    /// How far it goes on the way of the source, mm.
    pub way: f64,
    /// Line of the source's move.
    pub line: u32,
    /// Whether the tip may stand in it, but for rounding, in a move whose time the source gives: the axes turn about it.
    pub stands: bool,
    /// Length of the source's move, mm.
    pub source: f64,
    /// Rounding of the way, mm.
    pub rounding: f64,
    pub wanted: Feed,
    pub running: Feed,
    pub spindle: Spindle,
}

/// What the cuts have taken since the last comparison, in minutes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    /// Path length of the source for which no block has moved yet, mm.
    owed: f64,
    /// Path length of the tip, mm.
    way: f64,
    /// The largest rounding of one of them, mm.
    rounding: f64,
    /// By F, from its larger and from its smaller value within its rounding.
    took: [f64; 2],
    /// At the speed of the source.
    wanted: f64,
    /// The same, but where an axis or F itself cannot go so fast.
    slowest: f64,
    /// How long the tool may have stood, by F, while axes turned about it.
    stood: f64,
    /// What it has stood in the move of the source at hand.
    within: Within,
}

/// How long the tool has stood in a move of the source whose time the source gives.
#[derive(Clone, Copy, Debug, Default)]
struct Within {
    /// Line of that move.
    line: u32,
    /// Longer than its way takes, and what its axes need at least, minutes.
    longer: f64,
    least: f64,
}

/// An average speed of the tip that has been compared.
pub(crate) struct Compared {
    /// How much faster (or slower, below 0) the tip is than the source wants it, percent.
    pub percent: f64,
    /// Whether it is slower since an axis cannot go faster.
    pub is_slowed: bool,
    pub difference: Option<Difference>,
}

impl Cut<'_> {
    /// The speed that the source wants, mm/min.
    fn speed(&self) -> f64 {
        match self.wanted {
            Feed::PerMinute(feed) => feed,
            Feed::PerTurn(feed) => feed * state::speed(self.spindle),
            Feed::InverseTime(rate) => rate * self.source,
        }
    }

    /// Whether F is the speed of the source in mm/min: while the tool turns about its tip it says how fast the axes are.
    pub fn is_by_number(&self) -> bool {
        let speed = self.speed();
        matches!(self.running, Feed::PerMinute(feed) if (feed - speed).abs() <= self.gauge.allowed.feed)
    }

    /// Length that the control divides by F, mm.
    fn counted(&self) -> Option<f64> {
        match self.arc {
            Some(length) => Some(length),
            None => self.path.length(self.from, self.to),
        }
    }

    /// What the cut takes by F, from the largest value that F may stand for and from the smallest, minutes.
    fn took(&self) -> Option<[f64; 2]> {
        let allowed = &self.gauge.allowed;
        let (length, feed, half_step) = match self.running {
            Feed::PerMinute(feed) => (self.counted()?, feed, allowed.feed),
            Feed::PerTurn(feed) => {
                let speed = state::speed(self.spindle);
                (self.counted()?, feed * speed, allowed.feed_per_turn * speed)
            }
            Feed::InverseTime(rate) => (1.0, rate, allowed.inverse_time),
        };
        let within = |feed: f64| if feed > 0.0 { length / feed } else { f64::INFINITY };
        Some([within(feed + half_step), within(feed - half_step)])
    }

    /// What it takes at least: by the slowest axis at its rapid, and by the fastest F there is, minutes.
    fn least(&self, machine: &Machine) -> f64 {
        let (way, turns) = match (self.from.orientation, self.to.orientation) {
            (
                Orientation::Rotary { degrees: a, .. },
                Orientation::Rotary { degrees: b, tool_center },
            ) => {
                // With tool-centre control the way of the linear axes is not that of the block.
                let way = if tool_center { Vec3::ZERO } else { self.to.point - self.from.point };
                (way, [0, 1, 2].map(|i| b[i] - a[i]))
            }
            (Orientation::Rotary { .. } | Orientation::Axis(_), _) => (Vec3::ZERO, [0.0; 3]),
        };
        let linear = machine.linear.iter().zip(way.to_array());
        let linear = linear.map(|(axis, way)| axis.rapid.map_or(0.0, |rapid| way.abs() / rapid));
        let rotary = machine.rotary.iter();
        let rotary = rotary.map(|axis| turns[axis.index()].abs() / axis.rapid);
        let most = |word: &str| machine.words.get(word).map_or(f64::INFINITY, |word| word.max);
        let by_word = match self.running {
            Feed::PerMinute(_) => self.counted().unwrap_or(0.0) / machine.feed_max.min(most("F")),
            Feed::InverseTime(_) => 1.0 / most("F_inverse_time"),
            Feed::PerTurn(_) => 0.0,
        };
        linear.chain(rotary).fold(by_word, f64::max)
    }
}

impl Pace {
    /// Adds a way of the source for which no block has moved.
    pub fn owe(&mut self, way: f64) {
        self.owed += way;
    }

    /// Adds a cut. Compares the speed of the tip as soon as it has gone far enough to have one.
    pub fn add(&mut self, cut: &Cut) -> Option<Compared> {
        let Some(took) = cut.took() else {
            self.begin();
            return Some(Compared {
                percent: 0.0,
                is_slowed: false,
                difference: Some((Rule::Feed, unknown(cut.path))),
            });
        };
        let speed = cut.speed();
        // What an arc is longer by rounding, the tip goes.
        let way = cut.arc.unwrap_or(cut.way) + std::mem::take(&mut self.owed);
        self.way += way;
        self.rounding = self.rounding.max(cut.rounding);
        for (sum, took) in self.took.iter_mut().zip(took) {
            *sum += took;
        }
        self.wanted += way / speed;
        let least = cut.least(cut.gauge.machine);
        self.slowest += (way / speed).max(least);
        if self.within.line != cut.line {
            self.within = Within { line: cut.line, ..Within::default() };
        }
        if cut.stands {
            self.stood += took[0];
            self.within.least += least;
        }
        if self.way <= TIMED * self.rounding {
            return None;
        }
        let stood = self.standing(cut);
        let compared = self.compare(cut, speed, stood);
        self.begin();
        Some(compared)
    }

    /// Begins anew, in the same move of the source.
    fn begin(&mut self) {
        *self = Pace { within: self.within, ..Pace::default() };
    }

    /// What part of its way the rounding of the ends is.
    fn blur(&self) -> f64 {
        2.0 * self.rounding / self.way
    }

    /// How long the tool has stood while axes turned about it, minutes: out of a singular pose an axis turns before the tip sets out.
    /// The source gives the time of its whole move. So long may the tool stand, or as long as the axes need, besides its way.
    fn standing(&mut self, cut: &Cut) -> f64 {
        let Feed::InverseTime(rate) = cut.wanted else { return 0.0 };
        let longer = self.took[0] - self.slowest * (1.0 + self.blur());
        let stood = longer.min(self.stood).max(0.0);
        let most = self.within.least.max(1.0 / rate);
        let stood = stood.min(most - self.within.longer).max(0.0);
        self.within.longer += stood;
        stood
    }

    fn compare(&self, cut: &Cut, speed: f64, stood: f64) -> Compared {
        let Pace { way, took: [least, most], wanted, slowest, .. } = *self;
        let (blur, [least, most]) = (self.blur(), [least - stood, most - stood]);
        let took = (least + if most.is_finite() { most } else { least }) / 2.0;
        let is_fast = most < wanted * (1.0 - blur);
        // Not a number is never right.
        let is_in_time = least <= slowest * (1.0 + blur) * (1.0 + ROUNDED);
        let is_slow = !is_in_time;
        let message = || {
            let (goes, should) = (Number(way / took), Number(speed));
            let why = match cut.counted() {
                Some(counted) if counted > 0.0 && !matches!(cut.running, Feed::InverseTime(_)) => {
                    format!(
                        " (the control counts {} mm for F, {})",
                        Number(counted),
                        counts(cut.path)
                    )
                }
                _ => String::new(),
            };
            let source = state::shown(cut.wanted);
            format!(
                "the tip goes at {goes} mm/min on average, but should go at {should}: the feed is {}, the source wants {source}{why}",
                state::shown(cut.running)
            )
        };
        Compared {
            percent: (wanted / took - 1.0) * 100.0,
            is_slowed: !is_slow && least > wanted * (1.0 + blur),
            difference: (is_fast || is_slow).then(|| (Rule::Feed, message())),
        }
    }
}

/// What a control counts, for a person.
fn counts(path: FeedPath) -> &'static str {
    match path {
        FeedPath::Group([a, b, c]) if a == 0.0 && b == 0.0 && c == 0.0 => "X, Y and Z alone",
        FeedPath::Group(_) => "the axes of FGROUP",
        FeedPath::AllAxes => "a degree as a mm",
        FeedPath::LinearAxes => "X, Y and Z alone",
        FeedPath::AsSetUp => "as it is set up",
    }
}

/// Why nobody knows how fast the tip is.
fn unknown(path: FeedPath) -> String {
    match path {
        FeedPath::Group(_) => "none of the axes that move is in FGROUP: how fast they go, F does not say; name the rotary axes in \
             FGROUP, or write G93"
            .into(),
        FeedPath::AllAxes | FeedPath::LinearAxes | FeedPath::AsSetUp => {
            "rotary axes turn in the cut, and which axes F in mm/min counts, a parameter of the control decides: write inverse \
             time (G93), or say `rotary_feed` in [settings] of the machine file"
                .into()
        }
    }
}
