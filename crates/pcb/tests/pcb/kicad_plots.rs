//! Boards of KiCad 6 against the Gerber and drill files that KiCad plotted of them.

use crate::data;
use geom::region::Region;
use geom::{Element, Vec2};
use std::collections::BTreeMap;
use std::path::Path;
use toolpost_pcb::board::covered;
use toolpost_pcb::{Hole, HoleShape, excellon, gerber, kicad};

const BOARDS: [&str; 4] = ["StickHub", "ecc83-pp", "interf_u", "pic_programmer"];

fn board(folder: &Path, name: &str) -> kicad::Reading {
    let file = folder.join(format!("kicad/{name}.kicad_pcb"));
    kicad::read(&format!("{name}.kicad_pcb"), &data::bytes(&file))
        .unwrap_or_else(|errors| panic!("{name}: {errors:#?}"))
}

fn plotted(folder: &Path, name: &str, layer: &str) -> gerber::Image {
    let file = folder.join(format!("kicad/{name}/{name}-{layer}.gbr"));
    gerber::read(layer, &data::bytes(&file)).unwrap().image
}

/// A boundary, by squares of 1 mm, so that what is near a point is found at once.
struct Boundary(BTreeMap<(i64, i64), Vec<Element>>);

impl Boundary {
    fn of(region: &Region) -> Boundary {
        let mut squares = BTreeMap::<_, Vec<Element>>::new();
        for element in region.rings().flat_map(|ring| ring.elements()) {
            let (low, high) = element.extents();
            let (low, high) = ((low - 0.1).floor(), (high + 0.1).floor());
            for x in low.x as i64..=high.x as i64 {
                for y in low.y as i64..=high.y as i64 {
                    squares.entry((x, y)).or_default().push(*element);
                }
            }
        }
        Boundary(squares)
    }

    /// How far a point is from the boundary, mm; infinite beyond 0.1 mm or more.
    fn distance(&self, point: Vec2) -> f64 {
        let square = (point.x.floor() as i64, point.y.floor() as i64);
        let near = self.0.get(&square).into_iter().flatten();
        near.map(|element| element.nearest(point).1).fold(f64::INFINITY, f64::min)
    }
}

fn way(shape: &HoleShape) -> (Vec2, Vec2) {
    match shape {
        HoleShape::Round(at) => (*at, *at),
        HoleShape::Slot(a, b) => (*a, *b),
        // KiCad's drill files route slots.
        HoleShape::Route(way) => (way[0].start, way[way.len() - 1].end),
    }
}

#[test]
fn copper_is_what_kicad_plots() {
    let Some(folder) = data::folder() else { return };
    for name in BOARDS {
        let reading = board(&folder, name);
        // Copper within a hole is drilled away; the plots have marks there.
        let within_hole = |point: Vec2| {
            reading.board.holes.iter().any(|hole| {
                let (a, b) = way(&hole.shape);
                Element::line(a, b).nearest(point).1 < hole.diameter / 2.0 + 1e-3
            })
        };
        for (side, layer) in [(&reading.board.front, "F_Cu"), (&reading.board.back, "B_Cu")] {
            let ours = &side.copper.as_ref().unwrap().region;
            let mut image = plotted(&folder, name, layer);
            // Texts, whose letters are KiCad's own.
            let text: Vec<bool> = image
                .objects
                .iter()
                .map(|object| image.function(object) == Some("NonConductor"))
                .collect();
            let mut text = text.iter();
            image.objects.retain(|_| !text.next().unwrap());
            let theirs = &covered(&image).unwrap();
            let mut worst = 0.0f64;
            for (one, other) in [(ours, theirs), (theirs, ours)] {
                let other = Boundary::of(other);
                for element in one.rings().flat_map(|ring| ring.elements()) {
                    for point in [0.0, 0.25, 0.5, 0.75].map(|t| element.at(t)) {
                        if !within_hole(point) {
                            let beside = other.distance(point);
                            assert!(beside < 1e-3, "{name} {layer}: {beside} mm at {point}");
                            worst = worst.max(beside);
                        }
                    }
                }
            }
            println!("{name} {layer}: {worst} mm");
        }
    }
}

#[test]
fn holes_are_where_kicad_drills() {
    let Some(folder) = data::folder() else { return };
    for name in BOARDS {
        let mut theirs: Vec<Hole> = Vec::new();
        for (kind, plated) in [("PTH", true), ("NPTH", false)] {
            let file = folder.join(format!("kicad/{name}/{name}-{kind}.drl"));
            let drill = excellon::read(kind, &data::bytes(&file)).unwrap().drill;
            theirs.extend(drill.cuts.iter().map(|cut| Hole {
                shape: cut.path.clone(),
                diameter: drill.tools[cut.tool as usize].diameter,
                plated: Some(plated),
            }));
        }
        let mut ours = board(&folder, name).board.holes;
        assert_eq!(ours.len(), theirs.len(), "{name}");
        for hole in &theirs {
            let (a, b) = way(&hole.shape);
            let same = |other: &Hole| {
                let (c, d) = way(&other.shape);
                let near = |a: Vec2, b: Vec2| a.distance(b) < 1e-3;
                (near(a, c) && near(b, d) || near(a, d) && near(b, c))
                    && (hole.diameter - other.diameter).abs() < 1e-3
                    && hole.plated == other.plated
            };
            let found = ours.iter().position(same);
            ours.remove(found.unwrap_or_else(|| panic!("{name}: {hole:?}")));
        }
    }
}

#[test]
fn the_edge_is_what_kicad_plots() {
    let Some(folder) = data::folder() else { return };
    for name in BOARDS {
        let mut ours = board(&folder, name).edges;
        let image = plotted(&folder, name, "Edge_Cuts");
        assert_eq!(ours.len(), image.objects.len(), "{name}");
        for object in &image.objects {
            let gerber::Shape::Stroke { path, .. } = object.shape else { panic!("{object:?}") };
            let same = |other: &Element| {
                let near = |a: Vec2, b: Vec2| a.distance(b) < 1e-4;
                let same = |a: &Element| {
                    near(a.start, path.start)
                        && near(a.at(0.5), path.at(0.5))
                        && near(a.end, path.end)
                };
                same(other) || same(&other.reversed())
            };
            let found = ours.iter().position(same);
            ours.remove(found.unwrap_or_else(|| panic!("{name}: {path:?}")));
        }
    }
}
