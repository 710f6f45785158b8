//! How the contours are cut: along them, or beside them in passes with leads and tabs.

use super::leg::{ByControl, Leg};
use crate::args::{Cutting, Rounding, Side, Trims};
use ::wire::offset::Corners;
use ::wire::plan::{self, Opening, Pass, Settings, Taper, plan};
use ::wire::{Beside, Contour, Lead, LeadShape, Path, taper};
use geom::Vec2;
use program::{Compensation, Diagnostic};

/// The ways of the wire along `paths`, and what is worth knowing of them; `beside` is what the source says
/// of each, and `height` that of the upper contour, mm.
///
/// # Errors
/// What the call asks for and the contours do not allow.
pub fn legs(
    paths: Vec<Path>,
    beside: &[Beside],
    how: &Cutting,
    height: Option<f64>,
) -> Result<(Vec<Leg>, Vec<Diagnostic>), Box<Diagnostic>> {
    let passes = how.leave.len() + 1;
    if !matches!(how.feed.len(), 0 | 1) && how.feed.len() != passes {
        let message = format!("{} feeds for {passes} passes", how.feed.len());
        return Err(Diagnostic::error("feed", message).help("one feed, or one for each").into());
    }
    let feed = |pass: usize| how.feed.get(pass).or(how.feed.first()).map(|feed| feed * 60.0);
    let begin = how.begin.map(Vec2::from_array);
    let Some(side) = how.side else {
        let legs = paths.into_iter().enumerate().map(|(opening, path)| Leg {
            feed: feed(0),
            opening,
            ..Leg::of(begun(path, begin))
        });
        return Ok((legs.collect(), Vec::new()));
    };
    let openings = openings(&paths, beside, side, how)?;
    let plan = plan(&openings, &settings(how, height, feed)?)?;
    let corner = |(_, corner): &(usize, ::wire::offset::Corner)| {
        let (place, left) = (corner.place, corner.left);
        let message = format!(
            "the inner corner at X{:.4} Y{:.4} becomes as round as the wire: {left:.4} mm stay",
            place.x, place.y
        );
        Diagnostic::warning("corner-rounded", message).line(corner.line)
    };
    let warnings = plan.rounded.iter().map(corner).collect();
    let legs = plan.passes.into_iter().map(|pass| Leg {
        feed: feed(pass.number),
        opening: pass.opening,
        pass: pass.number,
        by_control: how.by_control.then(|| by_control(&pass, &openings, how.taper)),
        tab: pass.tab,
        thread: pass.thread,
        cut: pass.cut,
        stop: pass.stop,
        ..Leg::of(pass.path)
    });
    Ok((legs.collect(), warnings))
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

/// The path with its start moved to the place nearest to `begin`.
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
    beside: &[Beside],
    side: Side,
    how: &Cutting,
) -> Result<Vec<Opening>, Box<Diagnostic>> {
    if paths.iter().any(|path| path.upper().is_some()) {
        let message = "the wire leans between two contours, and its offset is asked for";
        let help = "leave --side out: two contours are the way of the wire itself";
        return Err(Diagnostic::error("side", message).help(help).into());
    }
    if how.by_control && paths.iter().any(|path| !path.lower().is_closed()) {
        // The offset ends with the straight way out, which only a closed contour is sure to have.
        let message = "an open contour, and the control is to offset the wire";
        let help = "leave --by-control out: the way of the wire's centre is then worked out here";
        return Err(Diagnostic::error("by-control", message).help(help).into());
    }
    if how.thread.len() > paths.len() {
        let message = format!("{} places to thread for {} contours", how.thread.len(), paths.len());
        return Err(Diagnostic::error("thread", message).help("one for each contour").into());
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
            Some(place) => Some(Vec2::from_array(*place)),
            None => beside.get(i).map(|source| source.thread),
        },
        start: how.begin.map(Vec2::from_array),
    };
    let openings: Vec<Opening> = paths.iter().map(Path::lower).enumerate().map(opening).collect();
    for (opening, source) in openings.iter().zip(beside) {
        if opening.left() != source.left {
            let (word, side) = if source.left { ("G41", "left") } else { ("G42", "right") };
            let message =
                format!("the program has the wire on the {side} ({word}), and --side has not");
            let line = opening.contour.elements().first().map_or(0, |element| element.line);
            let help = "take the side of the program, or take G41 and G42 out of it";
            return Err(Diagnostic::error("side", message).help(help).line(line).into());
        }
    }
    Ok(openings)
}

fn settings(
    how: &Cutting,
    height: Option<f64>,
    feed: impl Fn(usize) -> Option<f64>,
) -> Result<Settings, Box<Diagnostic>> {
    let offset = how.wire.unwrap_or(0.0) / 2.0 + how.gap.unwrap_or(0.0);
    let leave = how.leave.iter().copied().chain([0.0]).enumerate();
    // The plan wants a feed for its own estimate, which is not used.
    let pass = |(i, leave)| plan::Cut { offset: offset + leave, feed: feed(i).unwrap_or(1.0) };
    let taper = how.taper.map(|degrees| {
        let missing = || {
            let message = "a taper, and the height of the upper contour is not known";
            Box::new(Diagnostic::error("wire-height", message).help("give it with --height"))
        };
        let rounding = match how.rounding {
            Rounding::Conical => taper::Rounding::Conical,
            Rounding::Constant => taper::Rounding::Constant,
        };
        Ok::<_, Box<Diagnostic>>(Taper {
            angle: degrees.to_radians(),
            height: height.ok_or_else(missing)?,
            rounding,
        })
    });
    let taper = taper.transpose()?;
    Ok(Settings {
        passes: leave.map(pass).collect(),
        trims: match how.trims {
            Trims::Alternate => plan::Trims::Alternate,
            Trims::Repeat => plan::Trims::Repeat,
        },
        lead: Lead {
            length: how.lead.unwrap_or(0.0),
            shape: how.lead_arc.map_or(LeadShape::Straight, LeadShape::Arc),
        },
        tab: how.tab.unwrap_or(0.0),
        corners: if how.round_corners { Corners::Round } else { Corners::Refuse },
        taper,
        by_control: how.by_control,
    })
}
