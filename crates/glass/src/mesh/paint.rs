//! How bright the surface of a body is: colours of its corners and materials, and textures.

use crate::mesh::Mesh;
use crate::picture::{Picture, light};
use glam::DVec3;

/// What a triangle is painted with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The light of each corner, from 0 to 1; between them it changes evenly.
    Corners([f32; 3]),
    /// A texture, by its number, and the place of each corner in it: to the right and up, 1 is its whole width and height. It
    /// repeats on all sides.
    Texture(u32, [[f32; 2]; 3]),
}

/// White.
pub(crate) const WHITE: Paint = Paint::Corners([1.0; 3]);

/// The light of a colour of sRGB from its parts, each from 0 to 1 (IEC 61966-2-1: relative luminance).
pub(crate) fn luminance([red, green, blue]: [f64; 3]) -> f32 {
    let [red, green, blue] = [red, green, blue].map(|part| light(part.clamp(0.0, 1.0)));
    (0.2126 * red + 0.7152 * green + 0.0722 * blue) as f32
}

impl Mesh {
    /// The light of its surface at a place of a triangle, from 0 to 1; without paint it is white.
    pub fn light(&self, triangle: u32, place: DVec3) -> f64 {
        let Some(paint) = self.paint.get(triangle as usize) else { return 1.0 };
        let parts = parts(self.corners(triangle), place);
        let mixed = |values: [f32; 3]| -> f64 {
            values.iter().zip(parts).map(|(value, part)| f64::from(*value) * part).sum()
        };
        match *paint {
            Paint::Corners(lights) => mixed(lights),
            Paint::Texture(number, places) => {
                let at = [0, 1].map(|axis: usize| mixed(places.map(|place| place[axis])));
                let texture = self.textures.get(number as usize);
                texture.map_or(1.0, |texture: &Picture| light(texture.repeated(at)))
            }
        }
    }
}

/// How much of each corner there is in a place of a triangle: 1 in all.
fn parts([a, b, c]: [DVec3; 3], place: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let whole = normal.length_squared();
    if whole == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let part = |from: DVec3, to: DVec3| (to - from).cross(place - from).dot(normal) / whole;
    let [first, second] = [part(b, c), part(c, a)].map(|part| part.clamp(0.0, 1.0));
    [first, second, (1.0 - first - second).max(0.0)]
}
