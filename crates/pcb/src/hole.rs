//! Holes of a board: what is drilled, chained or routed through it.

use geom::{Element, Vec2};

/// A hole, a slot or a route.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Where, and of which form.
    pub shape: HoleShape,
    /// Its width, mm, greater than 0.
    pub diameter: f64,
    /// Whether its wall is plated; `None` where the file does not say.
    pub plated: Option<bool>,
}

/// Where a hole is, and of which form: the path of the centre of a round tool as wide as the hole.
#[derive(Clone, Debug, PartialEq)]
pub enum HoleShape {
    /// Round.
    Round(Vec2),
    /// From hole to hole.
    Slot(Vec2, Vec2),
    /// Along lines and arcs, each of which starts where the one before ends; at least one.
    Route(Vec<Element>),
}

impl Hole {
    /// The corners of the smallest box around it whose sides are parallel to the axes, mm.
    pub fn extents(&self) -> (Vec2, Vec2) {
        let (low, high) = match &self.shape {
            HoleShape::Round(at) => (*at, *at),
            HoleShape::Slot(from, to) => (from.min(*to), from.max(*to)),
            HoleShape::Route(elements) => {
                let each = elements.iter().map(Element::extents);
                each.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
            }
        };
        let radius = Vec2::splat(self.diameter / 2.0);
        (low - radius, high + radius)
    }

    /// How far `place` is from its edge, mm, less than 0 within it.
    pub fn distance(&self, place: Vec2) -> f64 {
        let from_middle = match &self.shape {
            HoleShape::Round(at) => at.distance(place),
            HoleShape::Slot(from, to) => Element::line(*from, *to).away(place),
            HoleShape::Route(elements) => {
                elements.iter().map(|element| element.away(place)).fold(f64::INFINITY, f64::min)
            }
        };
        from_middle - self.diameter / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_of_a_hole_is_half_its_width_from_its_middle() {
        let (from, to) = (Vec2::new(2.0, 1.0), Vec2::new(6.0, 1.0));
        let turned = vec![Element::line(from, to), Element::line(to, Vec2::new(6.0, 4.0))];
        for (shape, place, right) in [
            (HoleShape::Round(from), Vec2::new(5.0, 5.0), 4.5),
            (HoleShape::Round(from), from, -0.5),
            (HoleShape::Slot(from, to), Vec2::new(4.0, 3.0), 1.5),
            (HoleShape::Slot(from, to), Vec2::new(9.0, 5.0), 4.5),
            (HoleShape::Route(turned), Vec2::new(7.0, 3.0), 0.5),
        ] {
            let hole = Hole { shape, diameter: 1.0, plated: None };
            assert_eq!(hole.distance(place), right, "{hole:?} {place}");
        }
    }
}
