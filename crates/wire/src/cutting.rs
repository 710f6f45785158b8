//! How contours are cut: along them, or offset from them in passes with leads and tabs.

use crate::offset::{Corner, Corners};
use crate::plan::{self, Opening, Pass, Settings, Taper, Trims, plan};
use crate::segment::{ByControl, Segment};
use crate::taper::Rounding;
use crate::{Contour, Lead, LeadShape, OffsetContour, Path};
use geom::Vec2;
use program::Rule;
use program::{Compensation, Diagnostic, LEAST_SETTING, MOST_SETTING, needs, not_both, within};

/// How contours are cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Cutting {
    /// On which side of the contours the wire runs; `None`: along the contours themselves.
    pub side: Option<Side>,
    /// Diameter of the wire, mm.
    pub wire: f64,
    /// Spark gap of the last pass, mm.
    pub gap: f64,
    /// What each pass but the last leaves for those after it, mm.
    pub leave: Vec<f64>,
    /// In which direction the passes after the first run.
    pub trims: Trims,
    /// Where the wire is threaded: one place for each contour, in their order, mm.
    pub thread: Vec<Vec2>,
    /// How the wire comes to a contour.
    pub lead: Lead,
    /// Where the cut of a closed contour begins: the place nearest to this point, mm.
    pub begin: Option<Vec2>,
    /// How much of each closed contour holds the part until all else is cut, mm.
    pub tab: Option<f64>,
    /// How far the wire leans: the part larger at the top, or smaller where negative; degrees, as [`program::Op::Taper`]
    /// counts them.
    pub taper: Option<f64>,
    /// What becomes of rounded corners between the lower and the upper contour.
    pub rounding: Rounding,
    /// Whether the control offsets and leans the wire, each pass by the register of its number.
    pub by_control: bool,
    /// Whether inner corners that the wire is too thick for become as round as the wire.
    pub round_corners: bool,
    /// Feeds, mm/s: none, one for all passes, or one for each.
    pub feeds: Vec<f64>,
}

impl Cutting {
    /// Checks that every number is one that makes sense by itself.
    ///
    /// # Errors
    /// `setting`, with the name of the first that does not; a setting that has no meaning without another, such as the side.
    pub fn check(&self) -> Result<(), Box<Diagnostic>> {
        let above = |name, values: &[f64]| {
            values.iter().try_for_each(|value| within(name, *value, LEAST_SETTING, MOST_SETTING))
        };
        within("wire", self.wire, 0.0, MOST_SETTING)?;
        within("gap", self.gap, 0.0, MOST_SETTING)?;
        within("lead", self.lead.length, 0.0, MOST_SETTING)?;
        if let LeadShape::Arc(radius) = self.lead.shape {
            above("lead_arc", &[radius])?;
        }
        above("leave", &self.leave)?;
        above("feed", &self.feeds)?;
        above("tab", self.tab.as_slice())?;
        for place in self.thread.iter().chain(&self.begin) {
            [place.x, place.y]
                .into_iter()
                .try_for_each(|mm| within("thread", mm, -MOST_SETTING, MOST_SETTING))?;
        }
        let wants_side = Cutting { begin: None, feeds: Vec::new(), ..self.clone() };
        if self.side.is_none() && wants_side != Cutting::default() {
            let message = "how the wire runs next to the contours is given, and not on which side";
            return Err(Diagnostic::error(Rule::Setting, message).help("give `side`").into());
        }
        let rounding = self.rounding != Rounding::default();
        needs("rounding", "taper", rounding && self.taper.is_none())?;
        // A tab needs a path that is offset here.
        not_both("by_control", "tab", self.by_control && self.tab.is_some())
    }
}

/// Along the contours themselves, at no feed that is known.
impl Default for Cutting {
    fn default() -> Cutting {
        Cutting {
            side: None,
            wire: 0.0,
            gap: 0.0,
            leave: Vec::new(),
            trims: Trims::default(),
            thread: Vec::new(),
            lead: Lead { length: 0.0, shape: LeadShape::Straight },
            begin: None,
            tab: None,
            taper: None,
            rounding: Rounding::default(),
            by_control: false,
            round_corners: false,
            feeds: Vec::new(),
        }
    }
}

/// On which side of contours the wire runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Within closed contours, as for the openings of a die.
    Inside,
    /// Round closed contours, as for punches.
    Outside,
    /// Round the outer contours and within those inside of them, as for a part with openings.
    Part,
    /// On the left of the path.
    Left,
    /// On the right of the path.
    Right,
}

/// The segments of the wire path along `paths`, and warnings about them; `offset` says how the control of the source
/// offsets the wire along each path, `height` is that of the upper contour, mm.
///
/// # Errors
/// What the call asks for and the contours do not allow.
pub fn segments(
    paths: Vec<Path>,
    offset: &[OffsetContour],
    how: &Cutting,
    height: Option<f64>,
) -> Result<(Vec<Segment>, Vec<Diagnostic>), Box<Diagnostic>> {
    let passes = how.leave.len() + 1;
    if !matches!(how.feeds.len(), 0 | 1) && how.feeds.len() != passes {
        let message = format!("{} feeds for {passes} passes", how.feeds.len());
        return Err(Diagnostic::error(Rule::Feed, message)
            .help("one feed, or one for each")
            .into());
    }
    let feed = |pass: usize| how.feeds.get(pass).or(how.feeds.first()).map(|feed| feed * 60.0);
    let Some(side) = how.side else {
        let segments = paths.into_iter().enumerate().map(|(opening, path)| Segment {
            feed: feed(0),
            opening,
            ..Segment::of(begun(path, how.begin))
        });
        return Ok((segments.collect(), Vec::new()));
    };
    let openings = openings(&paths, offset, side, how)?;
    let plan = plan(&openings, &settings(how, height, feed)?)?;
    let corner = |(_, corner): &(usize, Corner)| {
        let (place, left) = (corner.place, corner.left);
        let message = format!(
            "the inner corner at X{:.4} Y{:.4} becomes as round as the wire: {left:.4} mm stay",
            place.x, place.y
        );
        Diagnostic::warning(Rule::CornerRounded, message).line(corner.line)
    };
    let warnings = plan.rounded.iter().map(corner).collect();
    // What brings the wire to a contour brings it to where that is cut from.
    let starting = |path: Path, opening: usize| {
        let line = openings.get(opening).map_or(0, |opening| opening.contour.starts_by());
        path.starting_by(line)
    };
    let segments = plan.passes.into_iter().map(|pass| Segment {
        feed: feed(pass.number),
        opening: pass.opening,
        pass: pass.number,
        by_control: how.by_control.then(|| by_control(&pass, &openings, how.taper)),
        tab: pass.tab,
        thread: pass.thread,
        cut: pass.cut,
        stop: pass.stop,
        ..Segment::of(starting(pass.path, pass.opening))
    });
    Ok((segments.collect(), warnings))
}

/// What the control does to the wire in a pass.
fn by_control(pass: &Pass, openings: &[Opening], taper: Option<f64>) -> ByControl {
    let register = Some(pass.number as u32 + 1);
    let offset = match pass.left {
        true => Compensation::Left(register),
        false => Compensation::Right(register),
    };
    // A part that is larger at the top has its upper end outside: that is on the right of who goes round
    // it counter-clockwise, as the wire inside of it then is on the left.
    let inside = openings
        .get(pass.opening)
        .is_some_and(|opening| opening.left() == (opening.contour.area() > 0.0));
    let counter_clockwise = pass.left == inside;
    let taper = taper.unwrap_or(0.0);
    ByControl { offset, taper: if counter_clockwise { -taper } else { taper } }
}

/// The path with its start moved to the point nearest to `begin`.
fn begun(path: Path, begin: Option<Vec2>) -> Path {
    match begin {
        Some(begin) if path.upper().is_none() => {
            let contour = path.lower();
            Path::upright(contour.started_at(&contour.nearest(begin)))
        }
        _ => path,
    }
}

fn openings(
    paths: &[Path],
    offset: &[OffsetContour],
    side: Side,
    how: &Cutting,
) -> Result<Vec<Opening>, Box<Diagnostic>> {
    if paths.iter().any(|path| path.upper().is_some()) {
        let message = "a wire between two contours cannot be offset";
        let help = "leave --side out: two contours are the path of the wire itself";
        return Err(Diagnostic::error(Rule::Side, message).help(help).into());
    }
    if how.by_control && paths.iter().any(|path| !path.lower().is_closed()) {
        // The offset ends with a straight lead-out, which only a closed contour is sure to have.
        let message = "an open contour cannot be offset by the control";
        let help = "leave --by-control out: the path of the wire's centre is then calculated here";
        return Err(Diagnostic::error(Rule::ByControl, message).help(help).into());
    }
    if how.thread.len() > paths.len() {
        let message = format!("{} thread points for {} contours", how.thread.len(), paths.len());
        return Err(Diagnostic::error(Rule::NoThread, message)
            .help("one `--thread` for each contour")
            .into());
    }
    let side_of = |contour: &Contour| match side {
        Side::Inside => plan::Side::Inside,
        Side::Outside => plan::Side::Outside,
        Side::Left => plan::Side::Left,
        Side::Right => plan::Side::Right,
        Side::Part => {
            let around = paths.iter().filter(|path| path.lower().encloses(contour.start()));
            let around = around.filter(|path| path.lower() != contour).count();
            if around % 2 == 0 { plan::Side::Outside } else { plan::Side::Inside }
        }
    };
    let opening = |(i, contour): (usize, &Contour)| Opening {
        contour: contour.clone(),
        side: side_of(contour),
        thread: match how.thread.get(i) {
            Some(place) => Some(*place),
            None => offset.get(i).map(|source| source.thread),
        },
        start: how.begin,
    };
    let openings: Vec<Opening> = paths.iter().map(Path::lower).enumerate().map(opening).collect();
    for (opening, source) in openings.iter().zip(offset) {
        if opening.left() != source.left {
            let (word, side) = if source.left { ("G41", "left") } else { ("G42", "right") };
            let message =
                format!("the program has the wire on the {side} ({word}), and --side has not");
            let line = opening.contour.elements().first().map_or(0, |element| element.line);
            let help = "take the side of the program, or take G41 and G42 out of it";
            return Err(Diagnostic::error(Rule::Side, message).help(help).line(line).into());
        }
    }
    Ok(openings)
}

fn settings(
    how: &Cutting,
    height: Option<f64>,
    feed: impl Fn(usize) -> Option<f64>,
) -> Result<Settings, Box<Diagnostic>> {
    let offset = how.wire / 2.0 + how.gap;
    let leave = how.leave.iter().copied().chain([0.0]).enumerate();
    // The plan wants a feed for its own estimate, which is not used.
    let pass = |(i, leave)| plan::Cut { offset: offset + leave, feed: feed(i).unwrap_or(1.0) };
    let taper = how.taper.map(|degrees| {
        let missing = || {
            let message = "a taper, and the height of the upper contour is not known";
            Box::new(Diagnostic::error(Rule::WireHeight, message).help("give it with --height"))
        };
        let height = height.ok_or_else(missing)?;
        Ok::<_, Box<Diagnostic>>(Taper {
            angle: degrees.to_radians(),
            height,
            rounding: how.rounding,
        })
    });
    let taper = taper.transpose()?;
    Ok(Settings {
        passes: leave.map(pass).collect(),
        trims: how.trims,
        lead: how.lead,
        tab: how.tab.unwrap_or(0.0),
        corners: if how.round_corners { Corners::Round } else { Corners::Refuse },
        taper,
        by_control: how.by_control,
    })
}
