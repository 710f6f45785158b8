//! Boards of KiCad 6 against the Gerber and drill files that KiCad plotted of them.

use crate::data;
use geom::region::Region;
use geom::{Element, Vec2};
use std::collections::BTreeMap;
use std::path::Path;
use toolpost_pcb::board::{covered, outline};
use toolpost_pcb::{Copper, Hole, HoleShape, excellon, gerber, kicad};

const BOARDS: [&str; 4] = ["StickHub", "ecc83-pp", "interf_u", "pic_programmer"];

fn board(folder: &Path, name: &str) -> kicad::Reading {
    let file = folder.join(format!("kicad/{name}.kicad_pcb"));
    read(name, &String::from_utf8(data::bytes(&file)).unwrap())
}

/// The board without its own texts, whose letters are KiCad's.
fn board_without_texts(folder: &Path, name: &str) -> kicad::Reading {
    let file = folder.join(format!("kicad/{name}.kicad_pcb"));
    let text = String::from_utf8(data::bytes(&file)).unwrap();
    let mut parts = text.split("\n  (gr_text ");
    let first = parts.next().unwrap().to_owned();
    read(name, &parts.fold(first, |all, part| all + part.split_once("\n  )").unwrap().1))
}

fn read(name: &str, text: &str) -> kicad::Reading {
    kicad::read(&format!("{name}.kicad_pcb"), text.as_bytes())
        .unwrap_or_else(|errors| panic!("{name}: {errors:#?}"))
}

/// What KiCad plotted as text, or all but that.
fn texts(mut image: gerber::Image, kept: bool) -> gerber::Image {
    let text = |object| image.function(object) == Some("NonConductor");
    let text: Vec<bool> = image.objects.iter().map(text).collect();
    let mut text = text.iter();
    image.objects.retain(|_| text.next() == Some(&kept));
    image
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

fn ends(shape: &HoleShape) -> (Vec2, Vec2) {
    match shape {
        HoleShape::Round(at) => (*at, *at),
        HoleShape::Slot(a, b) => (*a, *b),
        // KiCad's drill files route slots.
        HoleShape::Route(route) => (route[0].start, route[route.len() - 1].end),
    }
}

#[test]
fn copper_is_what_kicad_plots() {
    let Some(folder) = data::folder() else { return };
    for name in BOARDS {
        let reading = board_without_texts(&folder, name);
        // Copper within a hole is drilled away; the plots have marks there.
        let within_hole = |point: Vec2| {
            reading.board.holes.iter().any(|hole| {
                let (a, b) = ends(&hole.shape);
                Element::line(a, b).nearest(point).1 < hole.diameter / 2.0 + 1e-3
            })
        };
        for (side, layer) in [(&reading.board.front, "F_Cu"), (&reading.board.back, "B_Cu")] {
            let ours = &side.copper.as_ref().unwrap().region;
            let theirs = &covered(&texts(plotted(&folder, name, layer), false)).unwrap();
            let mut worst = 0.0f64;
            for (one, other) in [(ours, theirs), (theirs, ours)] {
                let other = Boundary::of(other);
                for element in one.rings().flat_map(|ring| ring.elements()) {
                    for point in [0.0, 0.25, 0.5, 0.75].map(|t| element.at(t)) {
                        let off = other.distance(point);
                        let across = element.tangent(0.5).perp() * 1e-3;
                        // What is thinner than 1 µm is nothing (geom::region).
                        let slit = || [point - across, point + across].map(|p| one.contains(p));
                        if off >= 1e-3 && (within_hole(point) || slit() == [true; 2]) {
                            continue;
                        }
                        if !within_hole(point) {
                            assert!(off < 1e-3, "{name} {layer}: {off} mm at {point}");
                            worst = worst.max(off);
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
            let (a, b) = ends(&hole.shape);
            let same = |other: &Hole| {
                let (c, d) = ends(&other.shape);
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
        let ours = board(&folder, name).board.outline.unwrap();
        let theirs = outline::of_image(&plotted(&folder, name, "Edge_Cuts")).unwrap().0;
        let elements = |region: &Region| -> Vec<Element> {
            region.rings().flat_map(|ring| ring.elements()).copied().collect()
        };
        let (mut ours, theirs) = (elements(&ours), elements(&theirs));
        assert_eq!(ours.len(), theirs.len(), "{name}");
        for element in &theirs {
            let same = |other: &Element| {
                [0.0, 0.5, 1.0].iter().all(|t| other.at(*t).distance(element.at(*t)) < 1e-4)
            };
            let found = ours.iter().position(same);
            ours.remove(found.unwrap_or_else(|| panic!("{name}: {element:?}")));
        }
    }
}

/// Each connected piece of copper belongs to one net, as the plots say too (`TO.N`).
#[test]
fn islands_have_the_nets_that_kicad_plots() {
    let Some(folder) = data::folder() else { return };
    for name in BOARDS {
        let reading = board(&folder, name);
        assert!(
            reading.warnings.iter().all(|warning| warning.rule.name() != "nets-joined"),
            "{name}"
        );
        for (side, layer) in [(&reading.board.front, "F_Cu"), (&reading.board.back, "B_Cu")] {
            let ours = side.copper.as_ref().unwrap();
            let (theirs, _) = Copper::of_image(&plotted(&folder, name, layer)).unwrap();
            let mut named = 0;
            for (island, net) in theirs.region.islands().iter().zip(&theirs.nets) {
                let Some(net) = net else { continue };
                let within = island.outer().elements()[0];
                let within = within.at(0.5) + within.tangent(0.5).perp() * 1e-3;
                let found = ours.region.islands().iter().position(|other| other.contains(within));
                let found = found.unwrap_or_else(|| panic!("{name} {layer}: nothing at {within}"));
                assert_eq!(ours.nets[found].as_ref(), Some(net), "{name} {layer} at {within}");
                named += 1;
            }
            println!("{name} {layer}: {named} islands with nets");
            assert!(named > 5);
        }
    }
}

/// Our letters are not KiCad's, but stand where those stand.
#[test]
fn texts_stand_where_kicad_plots_them() {
    let Some(folder) = data::folder() else { return };
    let reading = board(&folder, "interf_u");
    assert_eq!(
        reading.warnings.iter().map(|w| (w.rule.name(), w.count)).collect::<Vec<_>>(),
        [("text-letters", 6)]
    );
    // The boxes of the texts on the front and on the back, as KiCad plots them.
    for (side, layer) in [(&reading.board.front, "F_Cu"), (&reading.board.back, "B_Cu")] {
        let ours = side.copper.as_ref().unwrap();
        let theirs =
            covered(&texts(plotted(&folder, "interf_u", layer), true)).unwrap().extents().unwrap();
        let letters = ours.region.islands().iter().zip(&ours.nets).filter(|(_, net)| net.is_none());
        let (low, high) = theirs;
        let near = letters
            .map(|(island, _)| island.outer().extents())
            .filter(|(a, b)| a.cmpgt(low - 1.0).all() && b.cmplt(high + 1.0).all());
        let ours = near.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap();
        assert!(ours.0.distance(low) < 0.8 && ours.1.distance(high) < 0.8, "{ours:?} {theirs:?}");
    }
}
