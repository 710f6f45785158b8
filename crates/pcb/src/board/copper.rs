//! What the objects of a layer cover, and which nets its copper belongs to.

use super::Face;
use crate::contour::{self, Piece, around};
use crate::gerber::{Image, Object};
use crate::report::Outcome;
use crate::stroke;
use geom::ending::go_on;
use geom::region::{Fill, Index, Region, RegionError, Ring, strokes};
use geom::{Element, Vec2};
use program::{Diagnostic, Rule};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The copper of a side of a board.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Copper {
    /// All of it. Each island is a conductor.
    pub region: Region,
    /// The net of each island, in their order; `None` where no file says.
    pub nets: Vec<Option<Arc<str>>>,
}

/// A shape of copper.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// What a round pen of this width, mm, covers along its path.
    Stroke(Element, f64),
    /// What remains of pieces that are added and taken away in their order.
    Pieces(Vec<Piece>),
}

/// The copper of a side as a file draws it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pattern {
    /// The file.
    pub(crate) file: String,
    /// What it draws.
    pub(crate) drawn: Drawn,
}

/// What copper is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Drawn {
    /// Objects that are painted in their order.
    Image(Image),
    /// Shapes, each of which may be part of a net.
    Shapes(Vec<(Shape, Option<Arc<str>>)>),
}

impl Pattern {
    /// Shapes of a file, if there are any.
    pub(crate) fn of_shapes(file: &str, shapes: Vec<(Shape, Option<Arc<str>>)>) -> Option<Pattern> {
        let something = !shapes.is_empty();
        something.then(|| Pattern { file: file.to_owned(), drawn: Drawn::Shapes(shapes) })
    }

    /// The corners of a box around all of it, mm; `None` where nothing is drawn.
    pub(super) fn extents(&self) -> Option<(Vec2, Vec2)> {
        match &self.drawn {
            Drawn::Image(image) => image.extents(),
            Drawn::Shapes(shapes) => {
                shapes.iter().filter_map(|(shape, _)| shape.extents()).reduce(around)
            }
        }
    }

    /// The middle of the lines that it is drawn with.
    pub(super) fn lines(&self) -> Vec<Element> {
        match &self.drawn {
            Drawn::Image(image) => {
                let dark = image.objects.iter().filter(|object| object.dark);
                dark.filter_map(|object| Some(image.stroke(object)?.0)).collect()
            }
            Drawn::Shapes(shapes) => {
                let line = |shape: &Shape| match shape {
                    Shape::Stroke(line, _) => Some(*line),
                    Shape::Pieces(_) => None,
                };
                shapes.iter().filter_map(|(shape, _)| line(shape)).collect()
            }
        }
    }

    /// What it covers, as copper of this side.
    ///
    /// # Errors
    /// `layer` where it cannot be united.
    pub(super) fn united(&self, face: Face) -> Outcome<Named> {
        let named = match &self.drawn {
            Drawn::Image(image) => Copper::of_image(image),
            Drawn::Shapes(shapes) => Copper::of_shapes(shapes),
        };
        let placed = |found: Diagnostic| found.file(&self.file);
        let (copper, found) = named.map_err(|error| {
            let message = format!("the {face} copper cannot be taken: {error}");
            Box::new(placed(Diagnostic::error(Rule::Layer, message).help(way_out(&error))))
        })?;
        Ok((copper, found.into_iter().map(placed).collect()))
    }
}

impl Shape {
    /// The corners of the smallest box around it, mm; `None` where nothing is added.
    fn extents(&self) -> Option<(Vec2, Vec2)> {
        match self {
            Shape::Stroke(path, width) => stroke::extents(path, *width),
            Shape::Pieces(pieces) => contour::extents(pieces),
        }
    }
}

/// What a layer gives: its copper, and islands to which objects of several nets belong.
pub type Named = (Copper, Vec<Diagnostic>);

impl Copper {
    /// The conductor that each island is part of, as the number of its first island: islands of one net are
    /// one conductor, an island without a net is one of its own.
    pub fn conductors(&self) -> Vec<usize> {
        let mut first = BTreeMap::new();
        let islands = 0..self.region.islands().len();
        let net = |island: usize| self.nets.get(island)?.as_deref();
        islands
            .map(|island| net(island).map_or(island, |net| *first.entry(net).or_insert(island)))
            .collect()
    }

    /// What an image of copper covers, its islands with the nets that its objects have.
    ///
    /// # Errors
    /// As [`covered`].
    pub fn of_image(image: &Image) -> Result<Named, RegionError> {
        let region = covered(image)?;
        let named = image.objects.iter().filter(|object| object.dark).filter_map(|object| {
            let net = image.attributes(object).nets.as_ref()?.first()?;
            let spot = match image.stroke(object) {
                Some((path, _)) => path.start,
                None => spot(&image.pieces(object))?,
            };
            Some((spot, net.as_str()))
        });
        Ok(Copper::named(region, named))
    }

    /// What shapes cover together, each of which may be part of a net.
    ///
    /// # Errors
    /// As [`covered`].
    pub fn of_shapes(shapes: &[(Shape, Option<Arc<str>>)]) -> Result<Named, RegionError> {
        let mut all = Shapes::default();
        for (shape, _) in shapes {
            go_on();
            match shape {
                Shape::Stroke(path, width) => all.strokes.push((*path, *width)),
                Shape::Pieces(pieces) => all.add(pieces)?,
            }
        }
        let named = shapes.iter().filter_map(|(shape, net)| {
            let spot = match shape {
                Shape::Stroke(path, _) => path.start,
                Shape::Pieces(pieces) => spot(pieces)?,
            };
            Some((spot, net.as_deref()?))
        });
        Ok(Copper::named(all.united()?, named))
    }

    /// Names the islands of `region` after the nets of places in them.
    fn named<'a>(region: Region, named: impl Iterator<Item = (Vec2, &'a str)>) -> Named {
        let mut nets: Vec<Option<Arc<str>>> = vec![None; region.islands().len()];
        let mut joined = BTreeMap::new();
        let index = Index::new(&region);
        // Names are shared: a net has thousands of objects.
        let mut known: BTreeMap<&str, Arc<str>> = BTreeMap::new();
        for (spot, name) in named.filter(|(_, name)| *name != NOT_CONNECTED) {
            go_on();
            let Some(island) = index.island_at(spot) else { continue };
            match nets.get_mut(island) {
                Some(Some(net)) if **net != *name => {
                    joined.entry((island, name)).or_insert(spot);
                }
                Some(net @ None) => {
                    *net = Some(known.entry(name).or_insert_with(|| name.into()).clone());
                }
                _ => {}
            }
        }
        let finding = |((island, name), spot): ((usize, &str), Vec2)| {
            let first = nets.get(island).and_then(|net| net.as_deref()).unwrap_or_default();
            let message = format!(
                "at X{:.3} Y{:.3} copper of net {name} is one piece with that of {first}",
                spot.x, spot.y
            );
            Diagnostic::warning(Rule::NetsJoined, message)
                .help("right where the nets are tied there; otherwise mend the board")
        };
        let findings = joined.into_iter().map(finding).collect();
        (Copper { region, nets }, findings)
    }
}

/// What to do where there is no region of a layer.
pub(super) fn way_out(error: &RegionError) -> &'static str {
    match error {
        RegionError::TooLarge { .. } | RegionError::TooTangled { .. } => {
            "look at the counts of step and repeat, and at areas that are filled with lines; or divide the layer"
        }
        _ => "look at the unit, and at the sizes of apertures",
    }
}

/// The net of pads that are connected to nothing (Gerber format specification, 5.6.15 `.N`).
const NOT_CONNECTED: &str = "N/C";

/// How far within the edge of a shape a place of it is looked for, mm.
const INSIDE: f64 = 0.002;

/// A place in a shape.
fn spot(pieces: &[Piece]) -> Option<Vec2> {
    let outline = pieces.iter().find(|piece| piece.solid)?.contours.first()?;
    // A long element bends away from another as late as any.
    let longest = outline.elements().iter().max_by(|a, b| a.length().total_cmp(&b.length()))?;
    Some(longest.at(0.5) + longest.tangent(0.5).perp() * INSIDE)
}

/// What an image covers when all its objects are painted in their order.
///
/// # Errors
/// [`RegionError`] where a shape is out of this world or there are too many.
pub fn covered(image: &Image) -> Result<Region, RegionError> {
    let runs: Vec<&[Object]> = image.objects.chunk_by(|a, b| a.dark == b.dark).collect();
    let paint = Paint::of(&runs, &|run: &&[Object]| {
        let mut shapes = Shapes::default();
        for object in *run {
            go_on();
            match image.stroke(object) {
                Some(stroke) => shapes.strokes.push(stroke),
                None => shapes.add(&image.pieces(object))?,
            }
        }
        Ok(Paint::new(run.first().is_some_and(|object| object.dark), shapes.united()?))
    })?;
    Ok(paint.dark)
}

/// Shapes that are to be united.
#[derive(Default)]
pub(crate) struct Shapes {
    /// The paths of round pens, with their width, mm.
    pub(crate) strokes: Vec<(Element, f64)>,
    /// What others are inside of.
    rings: Vec<Ring>,
}

impl Shapes {
    /// Adds the shape that is given by its pieces.
    pub(crate) fn add(&mut self, pieces: &[Piece]) -> Result<(), RegionError> {
        if pieces.iter().all(|piece| piece.solid) {
            for contour in pieces.iter().flat_map(|piece| &piece.contours) {
                self.rings.push(Ring::new(contour.elements().to_vec())?);
            }
            return Ok(());
        }
        let paint = Paint::of(pieces, &|piece: &Piece| {
            let mut area = Shapes::default();
            area.add(&[Piece { solid: true, ..piece.clone() }])?;
            Ok(Paint::new(piece.solid, area.united()?))
        })?;
        self.rings.extend(paint.dark.rings().cloned());
        Ok(())
    }

    /// What is in any of them.
    pub(crate) fn united(self) -> Result<Region, RegionError> {
        let Shapes { strokes: mut drawn, mut rings } = self;
        // An aperture without size draws nothing.
        drawn.retain(|(_, width)| *width > 0.0);
        rings.extend(strokes(&drawn)?);
        // Uniting them takes the most memory of all.
        drop(drawn);
        Region::inside(&rings, Fill::Positive)
    }
}

/// What painting does to the image under it: it takes `clear` away, and then adds `dark`.
#[derive(Default)]
struct Paint {
    clear: Region,
    dark: Region,
}

impl Paint {
    fn new(dark: bool, shape: Region) -> Paint {
        let nothing = Region::default();
        let (clear, dark) = if dark { (nothing, shape) } else { (shape, nothing) };
        Paint { clear, dark }
    }

    /// What `layers` do, one after the other. By halves: a layer is worked on again only as often as the
    /// logarithm of their number, however dark and clear alternate.
    fn of<T>(
        layers: &[T],
        each: &dyn Fn(&T) -> Result<Paint, RegionError>,
    ) -> Result<Paint, RegionError> {
        match layers {
            [] => Ok(Paint::default()),
            [one] => each(one),
            _ => {
                let (first, then) = layers.split_at(layers.len() / 2);
                let (first, then) = (Paint::of(first, each)?, Paint::of(then, each)?);
                Ok(Paint {
                    clear: first.clear.union(&then.clear)?,
                    dark: first.dark.difference(&then.clear)?.union(&then.dark)?,
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gerber::read;

    /// Net A: two discs of 1 mm and a stroke between them; net B: a square 3 mm further up. A clear disc
    /// cuts the stroke in two.
    const NAMED: &str = "%FSLAX46Y46*%%MOMM*%%ADD10C,1*%%ADD11R,2X2*%%ADD12C,0.5*%%ADD13C,2*%
%TO.N,A*%D10*X0Y0D03*X10000000Y0D03*D12*X0Y0D02*X10000000Y0D01*
%TO.N,B*%D11*X0Y3000000D03*
%TD*%%LPC*%D13*X5000000Y0D03*
%LPD*%%TO.N,N/C*%D10*X20000000Y0D03*M02*";

    #[test]
    fn islands_have_the_nets_of_their_objects() {
        let reading = read("named.gbr", NAMED.as_bytes()).unwrap();
        let (copper, joined) = Copper::of_image(&reading.image).unwrap();
        let mut found: Vec<(i32, Option<&str>)> = Vec::new();
        for (island, net) in copper.region.islands().iter().zip(&copper.nets) {
            found.push(((island.outer().extents().0.x * 2.0).round() as i32, net.as_deref()));
        }
        found.sort_unstable();
        // From -1 the square, from -0.5 and from 6 the two halves of A, from 19.5 the pad of no net.
        assert_eq!(found, [(-2, Some("B")), (-1, Some("A")), (12, Some("A")), (39, None)]);
        assert!(joined.is_empty());
    }

    #[test]
    fn nets_that_touch_are_reported() {
        let touching = NAMED.replace("Y3000000D03", "Y1000000D03");
        let reading = read("named.gbr", touching.as_bytes()).unwrap();
        let (_, joined) = Copper::of_image(&reading.image).unwrap();
        assert_eq!(joined.len(), 1);
        assert!(joined[0].message.contains("copper of net B is one piece with that of A"));
    }

    #[test]
    fn what_is_dark_clear_and_dark_again_is_painted_in_order() {
        // A square of 10 mm, a hole of 6 mm in it, a disc of 2 mm in the hole, a hole of 1 mm in that.
        let text = "%FSLAX46Y46*%%MOMM*%%ADD10R,10X10*%%ADD11C,6*%%ADD12C,2*%%ADD13C,1*%
D10*X0Y0D03*%LPC*%D11*X0Y0D03*%LPD*%D12*X0Y0D03*%LPC*%D13*X0Y0D03*M02*";
        let region = covered(&read("rings.gbr", text.as_bytes()).unwrap().image).unwrap();
        let right = 100.0 - std::f64::consts::PI * (9.0 - 1.0 + 0.25);
        assert!((region.area() - right).abs() < 1e-6 * right, "{}", region.area());
        assert_eq!(region.islands().len(), 2);
    }
}
