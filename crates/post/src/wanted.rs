//! What the source wants: the technology of the records so far. It is sent when something needs it.

use program::{Compensation, Coolant, Cycle, Feed, Spindle, Surface, Tool};

/// The technology of the records so far.
#[derive(Debug)]
pub(crate) struct Wanted<'a> {
    tool: Option<Tool>,
    spindle: Spindle,
    coolant: Coolant,
    feed: Option<Feed>,
    compensation: Compensation,
    compensation_line: u32,
    cycle: Option<&'a Cycle>,
    surface: Option<&'a Surface>,
    path_tolerance: f64,
}

impl<'a> Wanted<'a> {
    /// Before the first record; the control may leave the path by `path_tolerance`, mm.
    pub(crate) fn nothing(path_tolerance: f64) -> Wanted<'a> {
        Wanted {
            tool: None,
            spindle: Spindle::Off,
            coolant: Coolant::Off,
            feed: None,
            compensation: Compensation::Off,
            compensation_line: 0,
            cycle: None,
            surface: None,
            path_tolerance,
        }
    }

    /// How far the control may leave the path in the cuts to come, mm.
    #[inline]
    pub(crate) fn path_tolerance(&self) -> f64 {
        self.path_tolerance
    }

    /// The control may leave the path by so much from the next cut on, mm.
    pub(crate) fn set_path_tolerance(&mut self, tolerance: f64) {
        self.path_tolerance = tolerance;
    }

    /// The tool that was called last.
    pub(crate) fn tool(&self) -> Option<&Tool> {
        self.tool.as_ref()
    }

    /// A tool is called.
    pub(crate) fn call_tool(&mut self, tool: Tool) {
        self.tool = Some(tool);
    }

    #[inline]
    pub(crate) fn spindle(&self) -> Spindle {
        self.spindle
    }

    /// The spindle turns so from here on; what was wanted before.
    pub(crate) fn set_spindle(&mut self, spindle: Spindle) -> Spindle {
        std::mem::replace(&mut self.spindle, spindle)
    }

    #[inline]
    pub(crate) fn coolant(&self) -> Coolant {
        self.coolant
    }

    /// This coolant runs from the next cut on.
    pub(crate) fn set_coolant(&mut self, coolant: Coolant) {
        self.coolant = coolant;
    }

    #[inline]
    pub(crate) fn feed(&self) -> Option<Feed> {
        self.feed
    }

    /// Cuts have this feed from here on; what was wanted before.
    pub(crate) fn set_feed(&mut self, feed: Option<Feed>) -> Option<Feed> {
        std::mem::replace(&mut self.feed, feed)
    }

    #[inline]
    pub(crate) fn compensation(&self) -> Compensation {
        self.compensation
    }

    /// Where the source has switched the compensation last.
    pub(crate) fn compensation_line(&self) -> u32 {
        self.compensation_line
    }

    /// The next straight move in the plane switches the compensation, as `line` of the source asks for.
    pub(crate) fn set_compensation(&mut self, compensation: Compensation, line: u32) {
        (self.compensation, self.compensation_line) = (compensation, line);
    }

    /// The cycle by which holes are made.
    pub(crate) fn cycle(&self) -> Option<&'a Cycle> {
        self.cycle
    }

    /// Holes are made by this cycle from here on, or by none.
    pub(crate) fn set_cycle(&mut self, cycle: Option<&'a Cycle>) {
        self.cycle = cycle;
    }

    /// The surface that moves count from, where the control finds it.
    #[inline]
    pub(crate) fn surface(&self) -> Option<&'a Surface> {
        self.surface
    }

    /// Moves count from this surface from here on.
    pub(crate) fn set_surface(&mut self, surface: &'a Surface) {
        self.surface = Some(surface);
    }

    /// Whether straight cuts in one orientation differ in where they go alone, where the control has been sent the compensation `sent`:
    /// what the short path of a straight cut asks of what is wanted. Every field is named, so that a new one stops the compiler here.
    #[inline]
    pub(crate) fn repeats_straight_cuts(&self, sent: Compensation) -> bool {
        let Wanted {
            // The length of the cut, or the way that it goes, counts in its block.
            feed,
            compensation,
            surface,
            // A record changes them, and a cut behind another record than a cut takes the long path.
            tool: _,
            spindle: _,
            coolant: _,
            compensation_line: _,
            cycle: _,
            path_tolerance: _,
        } = self;
        matches!(feed, Some(Feed::PerMinute(_))) && *compensation == sent && surface.is_none()
    }
}
