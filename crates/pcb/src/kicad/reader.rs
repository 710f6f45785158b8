//! The items of a board, and what becomes of them.

use super::Items;
use super::frame::Frame;
use super::graphic::{Graphic, arc};
use super::layer::Layers;
use super::pad::{self, Pad};
use super::text::Text;
use super::tree::{Node, Outcome, Tree};
use super::zone::Zone;
use crate::board::{Artwork, Pattern, Shape, holes};
use crate::contour::{Contour, Piece};
use crate::report::Report;
use crate::{Board, Hole, HoleShape};
use geom::Element;
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The first version that is read: `module` became `footprint`, before KiCad 6.
const FIRST_VERSION: u32 = 20201115;

/// The versions of KiCad 5, which are read too: those between had no release.
const KICAD_5: std::ops::RangeInclusive<u32> = 20171114..=20171130;

/// The last version that is read: that of KiCad 9.
const LAST_VERSION: u32 = 20241229;

/// The net of an item.
type Net = Option<Arc<str>>;

/// A board that is read.
struct Reader<'a> {
    report: Report<'a>,
    /// The names of the nets by their numbers.
    nets: BTreeMap<u32, Arc<str>>,
    /// The drill of vias that name none, mm, and those of nets that have another (KiCad 5).
    via_drill: Option<f64>,
    class_drills: BTreeMap<Arc<str>, f64>,
    front: Vec<(Shape, Net)>,
    back: Vec<(Shape, Net)>,
    holes: Vec<Hole>,
    /// The lines and arcs of the edge, each with its line in the file.
    edges: Vec<(Element, u32)>,
    /// The lines in the file of what is on the front, on the back, and of the holes.
    lines: [Vec<u32>; 3],
}

/// What is known to have no copper, though it may name a layer of copper.
const NO_COPPER: &[&[u8]] = &[
    b"layer",
    b"layers",
    b"general",
    b"setup",
    b"group",
    b"generated",
    b"private_layers",
    b"model",
];

pub(super) fn read(file_name: &str, text: &[u8]) -> Result<Artwork, Vec<Diagnostic>> {
    obeyed(file_name, text).finish(file_name)
}

/// What a board draws, each with its line in the file.
pub(super) fn items(file_name: &str, text: &[u8]) -> Result<Items, Vec<Diagnostic>> {
    let Reader { report, front, back, holes, edges, lines, .. } = obeyed(file_name, text);
    if !report.errors.is_empty() {
        return Err(report.errors);
    }
    let [of_front, of_back, of_holes] = lines;
    let side = |shapes: Vec<(Shape, Net)>, lines: Vec<u32>| {
        shapes.into_iter().map(|(shape, _)| shape).zip(lines).collect()
    };
    let holes = holes.into_iter().zip(of_holes).collect();
    Ok(Items { front: side(front, of_front), back: side(back, of_back), holes, edges })
}

/// A board that has been read, with the errors that were found in it.
fn obeyed<'a>(file_name: &'a str, text: &'a [u8]) -> Reader<'a> {
    let mut reader = Reader {
        report: Report::new(file_name, text),
        nets: BTreeMap::new(),
        via_drill: None,
        class_drills: BTreeMap::new(),
        front: Vec::new(),
        back: Vec::new(),
        holes: Vec::new(),
        edges: Vec::new(),
        lines: Default::default(),
    };
    let tree = Tree::new(text);
    let board = tree.and_then(|tree| {
        reader.header(tree.root())?;
        reader.items(tree.root());
        Ok(())
    });
    if let Err(fault) = board {
        reader.report.error(fault.location, *fault.what);
    }
    reader
}

impl Reader<'_> {
    /// Refuses what is no board, or is of a version that is not known.
    fn header(&mut self, root: Node) -> Outcome {
        if root.name() != b"kicad_pcb" {
            let message =
                format!("this is no board but \"{}\"", String::from_utf8_lossy(root.name()));
            return Err(root.fault(Rule::NotKicad, message, "a board begins with \"(kicad_pcb\""));
        }
        let list = root.need("version")?;
        let Some(version) = list.whole(0) else {
            return Err(list.fault(Rule::Version, "the version is no number", "see another file"));
        };
        if version < FIRST_VERSION && !KICAD_5.contains(&version) {
            let message =
                format!("version {version} is older than KiCad 5, or of none of its releases");
            return Err(list.fault(
                Rule::Version,
                message,
                "open the board in KiCad 6 to 9, and save it",
            ));
        }
        if KICAD_5.contains(&version) {
            self.header_of_5(root)?;
        }
        if version > LAST_VERSION {
            let message = format!(
                "version {version} is newer than KiCad 9, whose version is {LAST_VERSION}: it is not known"
            );
            let help = "plot Gerber and Excellon files in KiCad, and read those";
            return Err(list.fault(Rule::Version, message, help));
        }
        for net in root.all("net") {
            if let (Some(number), Some(name)) = (net.whole(0), net.item(1)) {
                self.nets.insert(number, name.text().into());
            }
        }
        Ok(())
    }

    /// What a board of KiCad 5 says otherwise: its layers may have names of their own, by which items call them, and vias may
    /// have the drill of their class of nets.
    ///
    /// # Errors
    /// `layer` where a layer that is cut has another name.
    fn header_of_5(&mut self, root: Node) -> Outcome {
        let usual: [(&[u8], &[u8]); 3] = [(b"0", b"F.Cu"), (b"31", b"B.Cu"), (b"44", b"Edge.Cuts")];
        for layer in root.find("layers").into_iter().flat_map(Node::items) {
            let name = layer.item(0).map_or(&b""[..], |name| name.word());
            let Some((_, known)) = usual.iter().find(|(number, _)| *number == layer.name()) else {
                continue;
            };
            if name != *known {
                let message = format!(
                    "layer {} is called \"{}\", and not \"{}\"",
                    String::from_utf8_lossy(layer.name()),
                    String::from_utf8_lossy(name),
                    String::from_utf8_lossy(known)
                );
                let help = "open the board in KiCad 6 to 9, and save it: then its layers have their own names";
                return Err(layer.fault(Rule::Layer, message, help));
            }
        }
        for class in root.all("net_class") {
            let Some(drill) = class.find("via_drill") else { continue };
            let drill = drill.length(0)?;
            if class.item(0).is_some_and(|name| name.word() == b"Default") {
                self.via_drill = Some(drill);
            }
            for net in class.all("add_net") {
                if let Some(name) = net.item(0) {
                    self.class_drills.insert(name.text().into(), drill);
                }
            }
        }
        Ok(())
    }

    /// The drill of a via that names none, as that of its class of nets in KiCad 5.
    fn class_drill(&self, item: Node) -> Outcome<f64> {
        let net = self.net(item)?;
        let own = net.and_then(|net| self.class_drills.get(&net).copied());
        match own.or(self.via_drill) {
            Some(drill) => Ok(drill),
            None => item.need("drill")?.length(0),
        }
    }

    /// Reads the items of the board.
    fn items(&mut self, root: Node) {
        for item in root.items().filter(|item| item.is_list()) {
            let done = match item.name() {
                b"footprint" | b"module" => self.footprint(item),
                b"segment" | b"arc" => self.track(item),
                b"via" => self.via(item),
                _ => self.item(item, Frame::BOARD),
            };
            self.note(item);
            if let Err(fault) = done {
                self.report.error(fault.location, *fault.what);
            }
            if self.report.is_full() {
                return;
            }
        }
    }

    /// What has been added since is of this item.
    fn note(&mut self, item: Node) {
        let counts = [self.front.len(), self.back.len(), self.holes.len()];
        for (lines, count) in self.lines.iter_mut().zip(counts) {
            lines.resize(count, item.location().line);
        }
    }

    fn footprint(&mut self, footprint: Node) -> Outcome {
        let frame = Frame::BOARD.of(footprint)?;
        for item in footprint.items().filter(|item| item.is_list()) {
            let done = match item.name() {
                b"pad" => self.pad(item, &frame),
                _ => self.item(item, frame),
            };
            self.note(item);
            if let Err(fault) = done {
                self.report.error(fault.location, *fault.what);
            }
        }
        Ok(())
    }

    /// An item that boards and footprints may have.
    fn item(&mut self, item: Node, frame: Frame) -> Outcome {
        let layers = Layers::of(item);
        match item.name() {
            b"zone" => self.zone(item),
            // Zones in footprints are where they are on the board.
            name if NO_COPPER.contains(&name) => Ok(()),
            _ if layers == Layers::default() => Ok(()),
            b"gr_text" | b"fp_text" | b"property" if layers.copper() => {
                self.text(item, layers, &frame)
            }
            b"gr_text" | b"fp_text" | b"property" | b"target" if !layers.copper() => {
                let message = "texts and targets on Edge.Cuts are left out";
                let help = "they are no edge: move them to another layer";
                self.report.warn(item.location(), Rule::NotAnEdge, message, help);
                Ok(())
            }
            name => {
                let Some(graphic) = Graphic::of(item)? else {
                    let message = format!(
                        "\"{}\" on copper or on the edge is not read",
                        String::from_utf8_lossy(name)
                    );
                    let help =
                        "move it to another layer in KiCad, or plot Gerber files and read those";
                    return Err(item.fault(Rule::Item, message, help));
                };
                self.graphic(item, &graphic, layers, &frame)
            }
        }
    }

    fn graphic(&mut self, item: Node, graphic: &Graphic, layers: Layers, frame: &Frame) -> Outcome {
        if layers.edge {
            let line = item.location().line;
            let placed = graphic.elements.iter().map(|element| (frame.element(element), line));
            self.edges.extend(placed);
        }
        let style = item.find("stroke").and_then(|stroke| stroke.find("type"));
        let style = style.and_then(|style| style.item(0)).map_or(&b"solid"[..], |word| word.word());
        if layers.outer() && !matches!(style, b"solid" | b"default") {
            let message = format!(
                "a line of the style \"{}\" is taken as a whole one",
                String::from_utf8_lossy(style)
            );
            let help = "on copper draw the dashes one by one";
            self.report.warn(item.location(), Rule::LineStyle, &message, help);
        }
        if layers.copper() {
            let net = self.net(item)?;
            for shape in graphic.shapes(item)? {
                self.add(item, layers, frame.shape(&shape), &net);
            }
        }
        Ok(())
    }

    fn track(&mut self, item: Node) -> Outcome {
        let path = match item.name() {
            b"arc" => arc(item)?,
            _ => Element::line(item.need("start")?.point()?, item.need("end")?.point()?),
        };
        let shape = Shape::Stroke(path, item.need("width")?.length(0)?);
        let net = self.net(item)?;
        self.add(item, Layers::of(item), shape, &net);
        Ok(())
    }

    fn via(&mut self, item: Node) -> Outcome {
        let at = item.need("at")?.point()?;
        let size = item.need("size")?;
        let drill = item.find("drill").unwrap_or(item);
        let diameter = match item.find("drill") {
            Some(drill) => drill.length(0)?,
            None => self.class_drill(item)?,
        };
        let layers = pad::copper(item, true)?;
        if !(layers.front && layers.back) {
            let message = "a via that does not go through the board from F.Cu to B.Cu";
            let help = "a drill goes through: only vias through the whole board can be made";
            return Err(item.fault(Rule::BlindVia, message, help));
        }
        if diameter <= 0.0 {
            let message = format!("a drill of {diameter} mm");
            return Err(drill.fault(Rule::Drill, message, "drills have a diameter above 0"));
        }
        let back = pad::back_of_stack(item).map_or(Ok(size), |layer| layer.need("size"))?;
        let net = self.net(item)?;
        for (size, side) in [(size, &mut self.front), (back, &mut self.back)] {
            let diameter = size.length(0)?;
            if diameter <= 0.0 {
                return Err(size.fault(
                    Rule::Via,
                    "a via without copper",
                    "vias have a size above 0",
                ));
            }
            let disc = Piece::new(true, Contour::circle(at, diameter / 2.0));
            side.push((Shape::Pieces(vec![disc]), net.clone()));
        }
        self.holes.push(Hole { shape: HoleShape::Round(at), diameter, plated: Some(true) });
        Ok(())
    }

    fn pad(&mut self, item: Node, footprint: &Frame) -> Outcome {
        let frame = footprint.of(item)?;
        let pad = Pad::of(item)?;
        let net = self.net(item)?;
        for (shapes, side) in [(pad.front, &mut self.front), (pad.back, &mut self.back)] {
            side.extend(shapes.iter().map(|shape| (frame.shape(shape), net.clone())));
        }
        self.holes.extend(pad.hole.map(|hole| {
            let shape = match hole.shape {
                HoleShape::Round(at) => HoleShape::Round(frame.point(at)),
                HoleShape::Slot(a, b) => HoleShape::Slot(frame.point(a), frame.point(b)),
                HoleShape::Route(route) => {
                    HoleShape::Route(route.iter().map(|element| frame.element(element)).collect())
                }
            };
            Hole { shape, ..hole }
        }));
        Ok(())
    }

    fn zone(&mut self, item: Node) -> Outcome {
        let zone = Zone::of(item)?;
        let net = self.net(item)?;
        for (layers, shape) in zone.fills {
            self.add(item, layers, shape, &net);
        }
        if zone.hollow {
            let message = "a zone has no fill on a side of the board: there it is no copper";
            let help = "fill all zones (key B) in KiCad, and save; if it stays so, the zone has no room there";
            self.report.warn(item.location(), Rule::ZoneFill, message, help);
        }
        Ok(())
    }

    fn text(&mut self, item: Node, layers: Layers, footprint: &Frame) -> Outcome {
        let shapes = match Text::of(item)? {
            Text::Hidden => Vec::new(),
            Text::Stored(shapes) => shapes,
            Text::Lettered(shapes) => {
                let message = "a text on copper is drawn with other letters than KiCad's, which are \
                    narrower or wider";
                let help = "look at the picture where it stands close to other copper";
                self.report.warn(item.location(), Rule::TextLetters, message, help);
                let frame = footprint.of(item)?;
                shapes.iter().map(|shape| frame.shape(shape)).collect()
            }
            Text::Variable => {
                let message = "a text on copper with variables (${…}) is left out";
                let help = "write out in KiCad what is to be there";
                self.report.warn(item.location(), Rule::TextVariable, message, help);
                Vec::new()
            }
        };
        for shape in shapes {
            self.add(item, layers, shape, &None);
        }
        Ok(())
    }

    /// Adds copper where the layers are.
    fn add(&mut self, item: Node, layers: Layers, shape: Shape, net: &Net) {
        if layers.front {
            self.front.push((shape.clone(), net.clone()));
        }
        if layers.back {
            self.back.push((shape, net.clone()));
        }
        if layers.inner && !layers.outer() {
            let message = "copper within the board is left out";
            let help = "only the two sides can be milled";
            self.report.warn(item.location(), Rule::InnerLayer, message, help);
        }
    }

    /// The net of an item; `None` where it has none.
    fn net(&self, item: Node) -> Outcome<Net> {
        let Some(list) = item.find("net") else { return Ok(None) };
        let net = list.whole(0).filter(|number| *number > 0).map(|number| {
            let known = self.nets.get(&number);
            known.cloned().ok_or_else(|| {
                let message = format!("there is no net {number}");
                list.fault(Rule::Net, message, "the file is damaged: save it again in KiCad")
            })
        });
        net.transpose()
    }

    /// The board, when all of it is read.
    fn finish(mut self, file_name: &str) -> Result<Artwork, Vec<Diagnostic>> {
        if !self.report.errors.is_empty() {
            return Err(self.report.errors);
        }
        let placed = |found: Diagnostic| found.file(file_name);
        let all = |found: Vec<Diagnostic>| found.into_iter().map(placed).collect::<Vec<_>>();
        let mut warnings = self.report.warnings;
        let mut board = Board::default();
        if !self.edges.is_empty() {
            warnings.extend(all(board.take_edge(&self.edges)));
        }
        board.broken_edge = board.broken_edge.map(|edge| edge.file(file_name));
        warnings.extend(holes::once(&mut self.holes).map(placed));
        let name = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
        let name = name.strip_suffix(".kicad_pcb").unwrap_or(name).to_owned();
        let board = Board { name, holes: self.holes, ..board };
        let side = |shapes| Pattern::of_shapes(file_name, shapes);
        let (front, back) = (side(self.front), side(self.back));
        Artwork { board, front, back, file: Some(file_name.to_owned()), warnings }.whole()
    }
}
