//! Both sides of a board on a sheet to print, as large as they are: to compare with the blank, and to lie on the machine.

use super::{BASE, EDGE, NETS, STOCK, TURNING, hole_color, key_of, widths};
use crate::board::{chords, trace};
use crate::lettering;
use crate::paper::{INK, escape};
use crate::trace::Trace;
use crate::view::View;
use geom::region::Region;
use geom::{Vec2, Vec3};
use glam::DVec2;
use pcb::board::Axis;
use pcb::{Copper, Hole, HoleShape};
use std::fmt::Write as _;

/// What is on the sheet: each side as it lies when it is up.
pub struct BoardSheet<'a> {
    /// With the front up and with the back up.
    pub sides: [BoardSide<'a>; 2],
    /// The line about which it is turned over.
    pub turning: Axis,
    /// The corners of the least blank, mm.
    pub stock: (Vec2, Vec2),
}

/// Where there is board, its copper and its holes.
pub type BoardSide<'a> = (Option<&'a Region>, Option<&'a Copper>, Vec<&'a Hole>);

/// The paper, mm: A4 upright.
const PAPER: DVec2 = DVec2::new(210.0, 297.0);

/// What no printer reaches, mm.
const MARGIN: f64 = 12.0;

/// Above each side for its name, mm.
const HEAD: f64 = 9.0;

/// Below both for the list of holes, mm.
const FOOT: f64 = 34.0;

/// The scales of drawings (ISO 5455), the largest that fits is taken.
const SCALES: [(f64, &str); 10] = [
    (5.0, "5:1"),
    (2.0, "2:1"),
    (1.0, "1:1"),
    (0.5, "1:2"),
    (0.2, "1:5"),
    (0.1, "1:10"),
    (0.05, "1:20"),
    (0.02, "1:50"),
    (0.01, "1:100"),
    (0.001, "1:1000"),
];

/// Draws the sheet as SVG, in mm, under a title.
pub fn board_sheet(title: &str, sheet: &BoardSheet) -> String {
    let (low, high) = sheet.stock;
    let size = DVec2::new(high.x - low.x, high.y - low.y);
    let room = DVec2::new(
        PAPER.x - 2.0 * MARGIN,
        (PAPER.y - 2.0 * MARGIN - 2.0 * HEAD - FOOT) / 2.0 - 4.0,
    );
    // Larger than it is only where it would be hard to see.
    let fits = |(scale, _): &&(f64, &str)| (size * *scale).cmple(room).all();
    let usual = SCALES.iter().skip(2).find(fits);
    let (scale, named) = *usual.unwrap_or(&SCALES[SCALES.len() - 1]);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"{}mm\" height=\"{}mm\" fill=\"none\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>{}</title>\n<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n",
        PAPER.x,
        PAPER.y,
        PAPER.x,
        PAPER.y,
        escape(&format!("Front and back of {title}")),
        PAPER.x,
        PAPER.y
    );
    words(&mut out, &crate::paper::shorten(title, 60), DVec2::new(MARGIN, MARGIN), 3.2);
    let size_text = format!("{:.1} X {:.1} MM BLANK, SCALE {named}", size.x, size.y);
    words(&mut out, &size_text, DVec2::new(MARGIN, MARGIN + 5.0), 2.4);
    let mut top = MARGIN + 8.0;
    for ((outline, copper, holes), name) in sheet.sides.iter().zip(["FRONT UP", "BACK UP"]) {
        words(&mut out, name, DVec2::new(MARGIN, top + 4.0), 2.8);
        let corner = DVec2::new((PAPER.x - size.x * scale) / 2.0, top + HEAD - 3.0);
        let field = [corner, corner + size * scale];
        let view = View::plan([low.extend(0.0), high.extend(0.0)], field);
        side(&mut out, &view, (*outline, *copper, holes), sheet);
        top += HEAD + room.y;
    }
    let holes = widths(sheet.sides[0].2.iter().copied());
    let rows = holes.iter().enumerate().flat_map(|(i, (width, [round, slots]))| {
        let width = *width as f64 / 1e3;
        let plural = if *slots == 1 { "" } else { "S" };
        let rows = [(*round, "".to_owned()), (*slots, format!("SLOT{plural} "))];
        rows.into_iter()
            .filter(|(count, _)| *count > 0)
            .map(move |(count, what)| (i, format!("{count} {what}OF {width} MM")))
    });
    let rows: Vec<(usize, String)> = rows.collect();
    let bottom = PAPER.y - MARGIN - FOOT + 8.0;
    // Five columns of six; of more the last says how many are left out.
    let most = 30;
    for (i, (width, text)) in rows.iter().enumerate().take(most) {
        let at = DVec2::new(MARGIN + (i / 6) as f64 * 37.0, bottom + (i % 6) as f64 * 4.5);
        let more = rows.len() > most && i + 1 == most;
        let text = match more {
            true => format!("{} WIDTHS MORE", rows.len() + 1 - most),
            false => text.clone(),
        };
        let _ = writeln!(
            out,
            "<path stroke=\"{}\" stroke-width=\"2\" d=\"M{:.2} {:.2}h0\"/>",
            hole_color(Some(*width)),
            at.x + 1.0,
            at.y - 1.0
        );
        words(&mut out, &text, at + DVec2::new(4.0, 0.0), 2.0);
    }
    out.push_str("</svg>\n");
    out
}

fn words(out: &mut String, text: &str, at: DVec2, height: f64) {
    let _ = writeln!(
        out,
        "<path aria-label=\"{}\" stroke=\"{INK}\" stroke-width=\"{:.2}\" d=\"{}\"/>",
        escape(text),
        height * 0.12,
        lettering::strokes(text, at.x, at.y, height)
    );
}

fn side(
    out: &mut String,
    view: &View,
    (outline, copper, holes): (Option<&Region>, Option<&Copper>, &[&Hole]),
    sheet: &BoardSheet,
) {
    let area = |out: &mut String, region: &Region, fill: &str, stroke: &str| {
        // In tenths of a mm of the paper would be too coarse: in hundredths.
        let mut pen = Trace::new(0.05);
        let fine = View::plan(
            [view.low, view.high],
            [
                view.at(Vec3::new(view.low.x, view.high.y, 0.0)) * 10.0,
                view.at(Vec3::new(view.high.x, view.low.y, 0.0)) * 10.0,
            ],
        );
        for ring in region.rings() {
            trace(&mut pen, ring, &fine, 0.01);
        }
        let data = pen.finish();
        if !data.is_empty() {
            let _ = writeln!(
                out,
                "<path transform=\"scale(.01)\" fill=\"{fill}\" fill-rule=\"evenodd\" stroke=\"{stroke}\" \
                 stroke-width=\"15\" d=\"{data}\"/>"
            );
        }
    };
    if let Some(outline) = outline {
        area(out, outline, BASE, EDGE);
    }
    if let Some(copper) = copper {
        area(out, &copper.region, NETS[0], "none");
    }
    let known = widths(holes.iter().copied());
    for hole in holes {
        let at = |point: Vec2| view.at(point.extend(0.0));
        let points: Vec<DVec2> = match &hole.shape {
            HoleShape::Round(center) => vec![at(*center), at(*center)],
            HoleShape::Slot(from, to) => vec![at(*from), at(*to)],
            HoleShape::Route(elements) => {
                let along = |element: &geom::Element| {
                    let pieces = chords(element, 0.02);
                    let element = *element;
                    (0..=pieces).map(move |k| element.at(f64::from(k) / f64::from(pieces)))
                };
                elements.iter().flat_map(along).map(at).collect()
            }
        };
        let mut data = String::new();
        for (i, point) in points.iter().enumerate() {
            let letter = if i == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{letter}{:.2} {:.2}", point.x, point.y);
        }
        let color = hole_color(known.keys().position(|key| *key == key_of(hole)));
        let width = hole.diameter * view.scale;
        let _ =
            writeln!(out, "<path stroke=\"{color}\" stroke-width=\"{width:.3}\" d=\"{data}\"/>");
    }
    let (low, high) = sheet.stock;
    let (a, b) = (view.at(low.extend(0.0)), view.at(high.extend(0.0)));
    let thin = |style: &str| {
        style
            .replace("stroke-width=\"1.2\"", "stroke-width=\"0.25\"")
            .replace("stroke-width=\"1.4\"", "stroke-width=\"0.25\"")
            .replace("14 4 3 4", "4 1 0.6 1")
            .replace("7 5", "2 1.4")
    };
    let _ = writeln!(
        out,
        "<path {} d=\"M{:.2} {:.2}H{:.2}V{:.2}H{:.2}Z\"/>",
        thin(STOCK),
        a.x,
        a.y,
        b.x,
        b.y,
        a.x
    );
    let (from, to) = match sheet.turning {
        Axis::X(x) => (Vec2::new(x, low.y), Vec2::new(x, high.y)),
        Axis::Y(y) => (Vec2::new(low.x, y), Vec2::new(high.x, y)),
    };
    let (from, to) = (view.at(from.extend(0.0)), view.at(to.extend(0.0)));
    let _ = writeln!(
        out,
        "<path {} d=\"M{:.2} {:.2}L{:.2} {:.2}\"/>",
        thin(TURNING),
        from.x,
        from.y,
        to.x,
        to.y
    );
}
