//! The image that a file describes.

use super::{Aperture, Attributes};
use crate::contour::{self, around};
use crate::report::{Outcome, fault};
use crate::stroke::{self, Pen};
use crate::{Contour, FAR, Piece, Transform};
use geom::{Element, Vec2};
use program::Rule;

/// So many lines and arcs of an aperture that erases are worked on as fast as any.
const FEW: usize = 64;

/// How many times the work of adding it is that of a piece among many that add and erase in turn.
const ERASING: usize = 250;

/// What a Gerber file describes: objects that are painted one over the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// In the order in which they are painted.
    pub objects: Vec<Object>,
    /// What objects are flashed and drawn with.
    pub apertures: Vec<Aperture>,
    /// The regions.
    pub regions: Vec<Region>,
    /// The attributes of the file (`TF`): name, values.
    pub file_attributes: Vec<(String, Vec<String>)>,
    /// What objects are part of; many share one.
    pub(super) attributes: Vec<Attributes>,
}

/// Something that is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Object {
    /// Line of the file (from 1) with its last command.
    pub line: u32,
    /// Whether it adds to the image; otherwise it erases what is under it.
    pub dark: bool,
    /// Index of its attributes.
    pub(super) attributes: u32,
    /// What it is.
    pub shape: Shape,
}

/// The shape of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// An aperture at a point.
    Flash {
        /// Index of the aperture.
        aperture: u32,
        /// How it is transformed about its origin.
        transform: Transform,
        /// Where its origin is, mm.
        at: Vec2,
    },
    /// An aperture drawn along a line or an arc.
    Stroke {
        /// Index of the aperture.
        aperture: u32,
        /// How it is transformed about its origin.
        transform: Transform,
        /// The path of its origin, mm.
        path: Element,
    },
    /// A region.
    Region {
        /// Index of the region.
        region: u32,
        /// How it is transformed about the origin.
        transform: Transform,
        /// Where the origin goes, mm.
        at: Vec2,
    },
}

/// An area given by its contours: the union of what each of them goes round.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Counter-clockwise, mm.
    pub contours: Vec<Contour>,
    /// What it is for (`.AperFunction`), such as `Conductor`.
    pub function: Option<String>,
}

impl Image {
    /// The exact shape of an object: its pieces in order. Empty for an aperture without size.
    pub fn pieces(&self, object: &Object) -> Vec<Piece> {
        match &object.shape {
            Shape::Flash { aperture, transform, at } => {
                let pieces = self.aperture(*aperture).map_or(&[][..], |aperture| &aperture.pieces);
                pieces.iter().map(|piece| piece.placed(transform, *at)).collect()
            }
            Shape::Stroke { aperture, transform, path } => {
                let pen = self.aperture(*aperture).and_then(|aperture| aperture.pen);
                pen.map(|pen| pen.sweep(transform, path)).unwrap_or_default()
            }
            Shape::Region { region, transform, at } => {
                let contours = self.regions.get(*region as usize).map_or(&[][..], |r| &r.contours);
                let place = |contour: &Contour| Piece::new(true, contour.placed(transform, *at));
                contours.iter().map(place).collect()
            }
        }
    }

    /// The path of a round pen and its diameter, mm, where an object is a stroke.
    pub fn stroke(&self, object: &Object) -> Option<(Element, f64)> {
        let Shape::Stroke { aperture, transform, path } = &object.shape else { return None };
        match self.aperture(*aperture)?.pen? {
            Pen::Round(diameter) => Some((*path, diameter * transform.scale())),
            Pen::Rectangle(_) => None,
        }
    }

    /// What an object is part of.
    pub fn attributes(&self, object: &Object) -> &Attributes {
        const NONE: &Attributes = &Attributes::NONE;
        self.attributes.get(object.attributes as usize).unwrap_or(NONE)
    }

    /// What an object is for (`.AperFunction`), such as `SMDPad,CuDef`.
    pub fn function(&self, object: &Object) -> Option<&str> {
        match &object.shape {
            Shape::Flash { aperture, .. } | Shape::Stroke { aperture, .. } => {
                self.aperture(*aperture)?.function.as_deref()
            }
            Shape::Region { region, .. } => self.regions.get(*region as usize)?.function.as_deref(),
        }
    }

    /// The values of an attribute of the file, such as `.FileFunction`.
    pub fn file_attribute(&self, name: &str) -> Option<&[String]> {
        let found = self.file_attributes.iter().find(|(known, _)| known == name);
        found.map(|(_, values)| &values[..])
    }

    /// The corners of the smallest box around everything that is dark; `None` where nothing is.
    pub fn extents(&self) -> Option<(Vec2, Vec2)> {
        let dark = self.objects.iter().filter(|object| object.dark);
        dark.filter_map(|object| self.extents_of(object)).reduce(around)
    }

    /// The corners of the smallest box around an object; `None` where it paints nothing.
    pub(crate) fn extents_of(&self, object: &Object) -> Option<(Vec2, Vec2)> {
        match (self.stroke(object), object.shape) {
            (Some((path, diameter)), _) => stroke::extents(&path, diameter),
            (None, Shape::Region { region, transform, at }) => {
                let contours = &self.regions.get(region as usize)?.contours;
                contours.iter().map(|contour| contour.placed_extents(&transform, at)).reduce(around)
            }
            (None, _) => contour::extents(&self.pieces(object)),
        }
    }

    /// The same elsewhere: transformed about the origin, which goes to `at`.
    pub(crate) fn placed(&self, transform: &Transform, at: Vec2) -> Image {
        let place =
            |object: &Object| Object { shape: object.shape.placed(transform, at), ..*object };
        Image { objects: self.objects.iter().map(place).collect(), ..self.clone() }
    }

    /// What its objects come to once they are drawn: lines and arcs, those of an aperture that erases so often as
    /// they are worked on.
    pub(super) fn size(&self) -> usize {
        let elements = |contours: &[Contour]| -> usize {
            contours.iter().map(|contour| contour.elements().len()).sum()
        };
        let of_aperture = |aperture: &Aperture| {
            let drawn: usize = aperture.pieces.iter().map(|piece| elements(&piece.contours)).sum();
            let erases = aperture.pieces.iter().any(|piece| !piece.solid);
            if erases && drawn > FEW { drawn.saturating_mul(ERASING) } else { drawn }
        };
        let apertures: Vec<usize> = self.apertures.iter().map(of_aperture).collect();
        let regions: Vec<usize> =
            self.regions.iter().map(|region| elements(&region.contours)).collect();
        let size = |object: &Object| match &object.shape {
            Shape::Flash { aperture, .. } => apertures.get(*aperture as usize).copied(),
            Shape::Region { region, .. } => regions.get(*region as usize).copied(),
            Shape::Stroke { .. } => None,
        };
        self.objects.iter().map(|o| size(o).unwrap_or(1)).fold(0, usize::saturating_add)
    }

    fn aperture(&self, index: u32) -> Option<&Aperture> {
        self.apertures.get(index as usize)
    }
}

impl Object {
    /// The same within a block that is flashed: transformed about the origin, which goes to `to`; where
    /// the block is not `dark`, dark is clear and clear is dark.
    ///
    /// # Errors
    /// `not-a-place` where that leads out of this world.
    pub(super) fn placed(&self, outer: &Transform, to: Vec2, dark: bool) -> Outcome<Object> {
        let shape = self.shape.placed(outer, to);
        let (place, transform) = match &shape {
            Shape::Flash { transform, at, .. } | Shape::Region { transform, at, .. } => {
                (at, transform)
            }
            Shape::Stroke { transform, path, .. } => (&path.end, transform),
        };
        let far = place.abs().max_element().max(transform.scale());
        if far.is_nan() || far > FAR {
            let message = format!("a copy of the object of line {} beyond {FAR} mm", self.line);
            return Err(fault(Rule::NotAPlace, message, "look at distances, scales and the unit"));
        }
        Ok(Object { dark: self.dark == dark, shape, ..*self })
    }
}

impl Shape {
    /// The same, transformed about the origin, which goes to `to`.
    fn placed(&self, outer: &Transform, to: Vec2) -> Shape {
        match *self {
            Shape::Flash { aperture, transform, at } => {
                let at = to + outer.apply(at);
                Shape::Flash { aperture, transform: outer.after(&transform), at }
            }
            Shape::Stroke { aperture, transform, path } => {
                let path = outer.element(&path, to);
                Shape::Stroke { aperture, transform: outer.after(&transform), path }
            }
            Shape::Region { region, transform, at } => {
                let at = to + outer.apply(at);
                Shape::Region { region, transform: outer.after(&transform), at }
            }
        }
    }
}
