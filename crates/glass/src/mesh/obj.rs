//! Wavefront OBJ: vertices and faces. Textures, normals, groups and materials are passed over.

use super::{Fault, MOST, Mesh, fan, lines, number};
use glam::DVec3;
use program::Rule;

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut mesh = Mesh::default();
    for (at, line) in lines(bytes) {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut place = DVec3::ZERO;
                for axis in 0..3 {
                    place[axis] = number(words.next(), at)?;
                }
                mesh.vertices.push(place);
            }
            Some("f") => {
                let corners: Vec<u32> = words
                    .map(|word| corner(word, mesh.vertices.len(), at))
                    .collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    return Err(
                        Fault::new(Rule::Face, "a face needs three corners or more").line(at)
                    );
                }
                let triangles = fan(&corners, &mesh.vertices).map_err(|fault| fault.line(at))?;
                mesh.triangles.extend(triangles);
            }
            _ => {}
        }
        if mesh.vertices.len().max(mesh.triangles.len()) > MOST {
            return Err(Fault::new(Rule::TooLarge, "has more triangles than can be counted"));
        }
    }
    Ok(mesh)
}

/// The vertex that a corner of a face names: from 1, or from the end where it is negative; what follows a slash is
/// texture and normal.
fn corner(word: &str, count: usize, line: usize) -> Result<u32, Fault> {
    let own = word.split('/').next().unwrap_or(word);
    let wrong = || {
        let word: String = word.chars().take(40).collect();
        Fault::new(Rule::Face, format!("`{word}` names none of the {count} vertices before it"))
            .line(line)
    };
    let named: i64 = own.parse().map_err(|_| wrong())?;
    let number = if named < 0 { count as i64 + named } else { named - 1 };
    u32::try_from(number).ok().filter(|number| (*number as usize) < count).ok_or_else(wrong)
}
