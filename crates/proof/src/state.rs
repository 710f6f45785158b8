//! What holds while the tool moves: feed, spindle, coolant, tool, offsets.

use crate::expected::ExpectedState;
use crate::observer::MachineState;
use crate::resolved_pose::Number;
use crate::tolerance::Applied;
use control::{Corners, Dialect, FeedPath};
use machine::{LengthOffset, Machine, RotaryAxis};
use program::{Compensation, Coolant, Cycle, Feed, PathMode, Rule, Spindle, Tool, WorkOffset};

/// What the program has switched on.
#[derive(Clone, Debug)]
pub(crate) struct Running {
    pub feed: Option<Feed>,
    /// What the control counts for it.
    pub feed_path: FeedPath,
    pub spindle: Spindle,
    /// How long the spindle still takes to its speed, s, where the machine's file says that the control does not wait.
    pub runs_up: f64,
    /// Whether nothing has been cut since the spindle started, or may have been started anew behind a stop or a cycle.
    pub just_started: bool,
    /// Constant surface speed, m/min.
    pub surface_speed: Option<f64>,
    pub coolant: Coolant,
    /// Line on which the spindle and the coolant were set last.
    pub spindle_line: u32,
    pub coolant_line: u32,
    pub tool: Option<Tool>,
    /// Whether the program has had another tool before.
    pub tool_is_further: bool,
    /// Whether the control takes the length of a tool by a word alone.
    pub length_by_word: bool,
    pub compensation: Compensation,
    /// Lean of the wire by the control, degrees.
    pub taper: f64,
    pub length_offset: Option<u32>,
    pub work_offset: Option<WorkOffset>,
    /// Whether another work offset counts since the last move, with Z not at home.
    pub offset_changed: bool,
    /// Work offset and register of the length in the last motion that had those of the source, since the tool change.
    pub last_offsets: Option<(Option<WorkOffset>, Option<u32>)>,
    pub cycle: Option<Cycle>,
    /// What happens at corners.
    pub path: PathMode,
    /// Whether the clamps of A, B and C are closed; `None` where no block has said so.
    pub clamps: [Option<bool>; 3],
}

impl Running {
    /// What runs before the first block.
    pub fn at_reset(machine: &Machine) -> Running {
        let dialect = Dialect::named(&machine.reader);
        Running {
            feed: None,
            feed_path: nc::feed_path(machine),
            spindle: Spindle::Off,
            runs_up: 0.0,
            just_started: false,
            surface_speed: None,
            coolant: Coolant::Off,
            spindle_line: 0,
            coolant_line: 0,
            tool: None,
            tool_is_further: false,
            length_by_word: dialect.is_some_and(Dialect::takes_length_by_word),
            compensation: Compensation::Off,
            taper: 0.0,
            length_offset: None,
            work_offset: dialect.and_then(Dialect::work_offset_at_reset),
            offset_changed: false,
            last_offsets: None,
            cycle: None,
            path: PathMode::AsSetUp,
            clamps: [None; 3],
        }
    }

    /// What an observer is told of it.
    pub fn state(&self) -> MachineState {
        MachineState {
            spindle: self.spindle.into(),
            surface_speed: self.surface_speed,
            coolant: self.coolant,
            tool: self.tool.clone(),
            compensation: self.compensation,
            length_offset: self.length_offset,
            work_offset: self.work_offset,
            cycle: self.cycle,
            path: self.path,
            taper: self.taper,
            joint_speed: None,
        }
    }

    /// The spindle is switched on `line`. From a stand, or the other way round, it takes `dwell` s to its speed.
    pub fn switch_spindle(&mut self, line: u32, spindle: Spindle, dwell: f64) {
        let goes_on = matches!(
            (self.spindle, spindle),
            (Spindle::Clockwise(_), Spindle::Clockwise(_))
                | (Spindle::CounterClockwise(_), Spindle::CounterClockwise(_))
        );
        if !goes_on {
            self.runs_up = if spindle == Spindle::Off { 0.0 } else { dwell };
            self.just_started = spindle != Spindle::Off;
        }
        (self.spindle, self.spindle_line) = (spindle, line);
    }

    /// A dwell of that many seconds, `allowed` of which are rounding: whether it is the `dwell` of the machine's file
    /// behind a start of the spindle.
    pub fn waits_for_spindle(&mut self, seconds: f64, dwell: f64, allowed: f64) -> bool {
        self.runs_up = if self.runs_up <= seconds + allowed { 0.0 } else { self.runs_up - seconds };
        let is_own = self.just_started && dwell > 0.0 && (seconds - dwell).abs() <= allowed;
        self.just_started &= !is_own;
        is_own
    }

    /// A tool change on `line`: the machine stops spindle and coolant for it, except what the same
    /// block switches on.
    pub fn change_tool(&mut self, line: u32, tool: Tool) {
        if self.spindle_line != line {
            (self.spindle, self.runs_up, self.just_started) = (Spindle::Off, 0.0, false);
        }
        if self.coolant_line != line {
            self.coolant = Coolant::Off;
        }
        self.tool_is_further |= self.tool.as_ref().is_some_and(|last| !same_tool(last, &tool));
        self.tool = Some(tool);
        self.last_offsets = None;
    }
}

/// A difference: the rule and what is wrong.
pub(crate) type Difference = (Rule, String);

/// What must be right on every move to a known place: tool, length offset, work offset.
pub(crate) fn set_up(
    machine: &Machine,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<Difference> {
    if let Some(tool) = wanted.tool {
        match &running.tool {
            None => return Some((Rule::Tool, format!("{} is not called", named(tool)))),
            Some(other) if !same_tool(tool, other) => {
                return Some((Rule::Tool, format!("{} runs, not {}", named(other), named(tool))));
            }
            Some(_) => {}
        }
    }
    let called = running.tool.as_ref().or(wanted.tool).map_or(0, |tool| tool.number);
    let offset = match machine.capabilities.length_offset {
        LengthOffset::Implicit => running.length_offset,
        LengthOffset::One => Some(1),
        LengthOffset::ToolNumber => {
            wanted.tool.and_then(|tool| tool.offset).or((called > 0).then_some(called))
        }
    };
    // One tool alone may have been touched off.
    let named = wanted.tool.is_some_and(|tool| tool.offset.is_some());
    if running.length_by_word && offset.is_none() && (named || running.tool_is_further) {
        let message = format!(
            "no length offset is active for T{called}: this control takes the length by a word, not with the tool"
        );
        return Some((Rule::LengthOffset, message));
    }
    let shown = |offset: Option<u32>| offset.map_or("none".into(), |n| n.to_string());
    if offset.is_some() && running.length_offset != offset {
        let (found, wanted) = (shown(running.length_offset), shown(offset));
        return Some((
            Rule::LengthOffset,
            format!("length offset {found} is active, not {wanted}"),
        ));
    }
    work_offset(wanted, running)
}

/// The same on the way of a rapid to a known height. The tool comes out of a cut with the offsets of that cut, whatever the source
/// has next; on its way to a tool change the last tool is still in the spindle.
pub(crate) fn on_the_way(
    machine: &Machine,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<Difference> {
    let difference = set_up(machine, wanted, running)?;
    if running.last_offsets == Some((running.work_offset, running.length_offset)) {
        return None;
    }
    if difference.0 != "tool" {
        return Some(difference);
    }
    let called = running.tool.as_ref().map(|tool| tool.number).filter(|number| *number > 0);
    let own = match machine.capabilities.length_offset {
        LengthOffset::Implicit => return work_offset(wanted, running),
        LengthOffset::One => Some(1),
        LengthOffset::ToolNumber => called,
    };
    let message = match running.length_offset {
        None => "no length offset is active on the way to the tool change".into(),
        Some(is) if own.is_some_and(|own| own != is) => format!(
            "length offset {is} is active on the way to the tool change, which is not that of the tool in the spindle"
        ),
        Some(_) => return work_offset(wanted, running),
    };
    Some((Rule::LengthOffset, message))
}

/// The work offset, or the register of a tool length, that is active at the end and was not in the last cut. The first work offset
/// may stay, and the one at reset.
pub(crate) fn offset_left(
    machine: &Machine,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<String> {
    let at_reset = Dialect::named(&machine.reader).and_then(Dialect::work_offset_at_reset);
    let may_stay = [wanted.work_offset, at_reset, Some(WorkOffset::FIRST)];
    if let Some(active) = running.work_offset.filter(|active| !may_stay.contains(&Some(*active))) {
        let number = active.number();
        return Some(format!(
            "work offset {number} active (54 is the first), in which it has not cut last"
        ));
    }
    running.length_offset?;
    let difference = set_up(machine, wanted, running)?;
    (difference.0 == "length-offset").then_some(difference.1)
}

fn work_offset(wanted: &ExpectedState, running: &Running) -> Option<Difference> {
    let expected = wanted.work_offset.unwrap_or(WorkOffset::FIRST);
    match running.work_offset {
        Some(active) if active != expected => {
            let (n, expected) = (active.number(), expected.number());
            let message = format!("work offset {n} is active, not {expected} (54 is the first)");
            Some((Rule::WorkOffset, message))
        }
        None if wanted.work_offset.is_some() => {
            let expected = expected.number();
            let message = format!("no work offset is named, but should be {expected}");
            Some((Rule::WorkOffset, message))
        }
        _ => None,
    }
}

/// What must be right in the cut besides: spindle and coolant.
pub(crate) fn spindle_and_coolant(
    allowed: &Applied,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<Difference> {
    if !same_spindle(allowed, wanted.spindle, running.spindle) {
        return Some(wrong_spindle(wanted.spindle, running.spindle));
    }
    if running.runs_up > 0.0 {
        let seconds = Number(running.runs_up);
        let message =
            format!("cuts {seconds} s before the spindle has its speed (`dwell` in [spindle])");
        return Some((Rule::SpindleDwell, message));
    }
    if wanted.surface_speed != running.surface_speed {
        let shown = |speed: Option<f64>| {
            speed.map_or("its own".into(), |speed| format!("that of {} m/min at X", Number(speed)))
        };
        let (is, should) = (shown(running.surface_speed), shown(wanted.surface_speed));
        return Some((
            Rule::Spindle,
            format!("the spindle's speed is {is}, but should be {should}"),
        ));
    }
    (wanted.coolant != running.coolant).then(|| {
        let (is, should) = (coolant(running.coolant), coolant(wanted.coolant));
        (Rule::Coolant, format!("coolant is {is}, but should be {should}"))
    })
}

/// A spindle that is as it should not be.
pub(crate) fn wrong_spindle(wanted: Spindle, is: Spindle) -> Difference {
    let (is, should) = (spindle(is), spindle(wanted));
    (Rule::Spindle, format!("the spindle is {is}, but should be {should}"))
}

/// No source asks for less at corners, mm: most programs have no words for it.
const CLOSEST: f64 = 0.001;

/// What the machine's file says of corners: its options are looked up once for a proof, not for each cut.
#[derive(Clone, Copy)]
pub(crate) struct CornerLimits {
    /// Its tolerance of the path, mm.
    own: f64,
    /// The most that the control may be let leave the path in a cut, mm.
    most: f64,
    /// The same between rapids, mm.
    corridor: f64,
    /// What the control does where a program says nothing; `None` where its reader is not known.
    unsaid: Option<Corners>,
}

impl CornerLimits {
    /// Those of a machine.
    pub fn of(machine: &Machine) -> CornerLimits {
        let own = machine.path_tolerance();
        CornerLimits {
            own,
            most: own.max(machine.roughing_tolerance()),
            corridor: machine.capabilities.rapid_corridor,
            unsaid: Dialect::named(&machine.reader).map(Dialect::corners),
        }
    }
}

/// By how much the control may leave the path at corners of cuts: as the source says, and no more than the machine's file.
pub(crate) fn corners(
    limits: &CornerLimits,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<Difference> {
    let asked = match wanted.path {
        PathMode::AsSetUp => return rounded(limits, running, limits.own, OWN),
        PathMode::ExactStop | PathMode::ExactPath => 0.0,
        PathMode::Blend(asked) => asked,
    };
    let asked = asked.max(CLOSEST);
    match asked < limits.most {
        true => rounded(limits, running, asked, SOURCE),
        false => rounded(limits, running, limits.most, OWN),
    }
}

/// What a program says that follows the path of cuts more closely than the source asks for: that is slower, and right.
pub(crate) fn closer_than_asked(
    limits: &CornerLimits,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<String> {
    let (PathMode::Blend(asked), PathMode::Blend(is)) = (wanted.path, running.path) else {
        return None;
    };
    let asked = asked.max(CLOSEST).min(limits.most);
    (is + 1e-6 < asked).then(|| {
        format!(
            "the control keeps to the path within {} mm, the source asks for {} mm: the cuts are slower",
            Number(is),
            Number(asked)
        )
    })
}

/// The same at corners of rapids, which may be as far from their way as elsewhere.
pub(crate) fn rapid_corners(limits: &CornerLimits, running: &Running) -> Option<Difference> {
    match limits.corridor > limits.most {
        true => rounded(limits, running, limits.corridor, CORRIDOR),
        false => rounded(limits, running, limits.most, OWN),
    }
}

/// By how much the control may leave the path at corners of a rapid that it goes by feed.
pub(crate) fn fed_rapid_corners(limits: &CornerLimits, running: &Running) -> Option<Difference> {
    rounded(limits, running, limits.most, OWN)
}

/// Who says how far corners may be cut, and where.
type Says = (&'static str, &'static str);

const SOURCE: Says = ("the source", "for these cuts");
const OWN: Says = ("the machine file", "`path_tolerance` in [options]");
const CORRIDOR: Says = ("the machine file", "`rapid_corridor` in [capabilities], at rapids");

fn rounded(
    limits: &CornerLimits,
    running: &Running,
    allowed: f64,
    (who, place): Says,
) -> Option<Difference> {
    let most = match running.path {
        PathMode::ExactStop | PathMode::ExactPath => 0.0,
        PathMode::Blend(most) => most,
        PathMode::AsSetUp => match limits.unsaid? {
            Corners::Followed => 0.0,
            // What its operator has set, the machine's file says.
            Corners::AsSetUp if limits.own > 0.0 => limits.own,
            Corners::AsSetUp | Corners::Unbounded => f64::INFINITY,
        },
    };
    // Programs write six decimals at the most.
    if most <= allowed + 1e-6 {
        return None;
    }
    let by = if most.is_finite() { format!("{} mm", Number(most)) } else { "any amount".into() };
    let message = format!(
        "the control may leave the path at corners by {by}, {who} allows {} mm ({place})",
        Number(allowed)
    );
    Some((Rule::PathTolerance, message))
}

/// A rotary axis that turns against its clamp; `turns` says which of A, B and C do.
pub(crate) fn clamps(machine: &Machine, turns: [bool; 3], running: &Running) -> Option<Difference> {
    let held = |axis: &&RotaryAxis| {
        let index = axis.index();
        axis.clamp.is_some() && turns[index] && running.clamps[index] != Some(false)
    };
    let axis = machine.rotary.iter().find(held)?;
    let state = match running.clamps[axis.index()] {
        Some(_) => "its clamp is closed",
        None => "nothing has opened its clamp",
    };
    let open = axis.clamp.map_or(0, |clamp| clamp.open);
    Some((Rule::Clamp, format!("{} turns, but {state}: M{open} opens it", axis.letter)))
}

/// What leans the wire in the cut.
pub(crate) fn taper(
    allowed: &Applied,
    wanted: &ExpectedState,
    running: &Running,
) -> Option<Difference> {
    let (is, should) = (running.taper, wanted.taper);
    // Rounding does not turn a lean round, nor end it.
    let same = (is - should).abs() <= allowed.taper_degrees && (is == 0.0) == (should == 0.0);
    let shown = |degrees: f64| match degrees {
        0.0 => String::from("not at all"),
        left if left > 0.0 => format!("by {}° to the left", Number(left)),
        right => format!("by {}° to the right", Number(-right)),
    };
    let message =
        || format!("the control leans the wire {}, but should {}", shown(is), shown(should));
    (!same).then(|| (Rule::Taper, message()))
}

/// Compares a feed with what the source wants, where it is the speed of the tip: by the spindle where one counts a minute
/// and the other a turn. How fast the tip is in inverse time, [`Pace`](crate::pace::Pace) finds.
pub(crate) fn feed(
    machine: &Machine,
    allowed: &Applied,
    wanted: Option<Feed>,
    running: Option<Feed>,
    spindle: Spindle,
) -> Option<Difference> {
    let Some(wanted) = wanted else {
        // A wire goes as fast as its generator lets it, where nobody says otherwise.
        if machine.wire.is_some() {
            return running.map(|feed| {
                (Rule::Feed, format!("the feed is {}, but should be none", shown(feed)))
            });
        }
        return Some((Rule::Feed, "the source names no feed".into()));
    };
    let Some(running) = running else {
        return Some((Rule::Feed, format!("no feed is set, but should be {}", shown(wanted))));
    };
    let speed = speed(spindle);
    let same = match (wanted, running) {
        (Feed::PerMinute(a), Feed::PerMinute(b)) => (a - b).abs() <= allowed.feed,
        (Feed::PerTurn(a), Feed::PerTurn(b)) => (a - b).abs() <= allowed.feed_per_turn,
        (Feed::PerMinute(a), Feed::PerTurn(b)) => {
            (a - b * speed).abs() <= allowed.feed_per_turn * speed
        }
        (Feed::PerTurn(a), Feed::PerMinute(b)) => (a * speed - b).abs() <= allowed.feed,
        (Feed::InverseTime(a), Feed::InverseTime(b)) => (a - b).abs() <= allowed.inverse_time,
        (Feed::InverseTime(_), feed) | (_, feed @ Feed::InverseTime(_)) => feed.value() > 0.0,
    };
    (!same).then(|| {
        (Rule::Feed, format!("the feed is {}, but should be {}", shown(running), shown(wanted)))
    })
}

/// Turns of a spindle a minute.
pub(crate) fn speed(spindle: Spindle) -> f64 {
    match spindle {
        Spindle::Off => 0.0,
        Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed) => speed,
    }
}

/// Whether the program's compensation is the source's. A register that the source does not name may
/// be that of the tool; where the cutting edge holds length and radius, it is the first edge.
pub(crate) fn same_compensation(
    machine: &Machine,
    source: Compensation,
    block: Compensation,
    tool: Option<&Tool>,
) -> bool {
    let edge = machine.capabilities.length_offset == LengthOffset::One;
    let register = |wanted: Option<u32>, named: Option<u32>| match (wanted, named) {
        (_, None) => true,
        (_, Some(named)) if edge => named == 1,
        (Some(wanted), Some(named)) => wanted == named,
        (None, Some(named)) => tool.is_none_or(|tool| {
            tool.number == 0 || tool.number == named || tool.offset == Some(named)
        }),
    };
    match (source, block) {
        (Compensation::Off, Compensation::Off) => true,
        (Compensation::Left(a), Compensation::Left(b))
        | (Compensation::Right(a), Compensation::Right(b)) => register(a, b),
        _ => false,
    }
}

/// Whether two tools are one: by number, or by name where a side knows only a name. `T0` is no tool.
pub fn same_tool(source: &Tool, block: &Tool) -> bool {
    match (source.number, block.number) {
        (_, 0) if block.name.is_empty() => false,
        (0, _) if source.name.is_empty() || block.name.is_empty() => true,
        (0, _) | (_, 0) => {
            let name = source.name.trim();
            [name, &plain(name)].iter().any(|name| name.eq_ignore_ascii_case(&block.name))
        }
        (a, b) => a == b,
    }
}

/// A name without what a control does not take in a tool name.
pub(crate) fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

pub(crate) fn same_spindle(allowed: &Applied, a: Spindle, b: Spindle) -> bool {
    match (a, b) {
        (Spindle::Off, Spindle::Off) => true,
        (Spindle::Clockwise(a), Spindle::Clockwise(b))
        | (Spindle::CounterClockwise(a), Spindle::CounterClockwise(b)) => {
            // Rounding does not stop a spindle.
            (a - b).abs() <= allowed.speed_per_min && (b > 0.0) == (a > 0.0)
        }
        _ => false,
    }
}

fn named(tool: &Tool) -> String {
    match tool.number {
        0 => format!("tool \"{}\"", tool.name),
        number => format!("tool {number}"),
    }
}

fn spindle(spindle: Spindle) -> String {
    match spindle {
        Spindle::Off => "stopped".into(),
        Spindle::Clockwise(speed) => format!("clockwise at {} 1/min", Number(speed)),
        Spindle::CounterClockwise(speed) => {
            format!("counter-clockwise at {} 1/min", Number(speed))
        }
    }
}

fn coolant(coolant: Coolant) -> &'static str {
    match coolant {
        Coolant::Off => "off",
        Coolant::Flood => "flood",
        Coolant::Mist => "mist",
        Coolant::FloodAndMist => "flood and mist",
        Coolant::Through => "through the tool",
    }
}

/// A side of compensation, for a person.
pub(crate) fn compensation(side: Compensation) -> String {
    let register = |n: Option<u32>| n.map_or(String::new(), |n| format!(" with register {n}"));
    match side {
        Compensation::Off => "off".into(),
        Compensation::Left(n) => format!("left{}", register(n)),
        Compensation::Right(n) => format!("right{}", register(n)),
    }
}

pub(crate) fn shown(feed: Feed) -> String {
    match feed {
        Feed::PerMinute(f) => format!("{} mm/min", Number(f)),
        Feed::PerTurn(f) => format!("{} mm per turn", Number(f)),
        Feed::InverseTime(f) => format!("{} per minute (inverse time)", Number(f)),
    }
}
