//! Entities and sections as runs of pairs.

use super::groups::Group;
use geom::Vec2;
use program::{Diagnostic, Rule};

/// An entity: its pairs, the first of which names its kind.
#[derive(Clone, Copy)]
pub(super) struct Entity<'a> {
    pub groups: &'a [Group<'a>],
}

impl<'a> Entity<'a> {
    pub fn kind(&self) -> &'a [u8] {
        self.groups.first().map_or(b"", |group| group.value)
    }

    pub fn line(&self) -> u32 {
        self.groups.first().map_or(0, |group| group.line)
    }

    pub fn all(&self, code: i32) -> impl Iterator<Item = &'a Group<'a>> {
        self.groups.iter().skip(1).filter(move |group| group.code == code)
    }

    pub fn first(&self, code: i32) -> Option<&'a Group<'a>> {
        self.all(code).next()
    }

    pub fn number(&self, code: i32) -> Result<Option<f64>, Box<Diagnostic>> {
        self.first(code).map(Group::number).transpose()
    }

    pub fn whole(&self, code: i32) -> Result<Option<i64>, Box<Diagnostic>> {
        self.first(code).map(Group::whole).transpose()
    }

    /// The point whose X has this code.
    pub fn point(&self, code: i32) -> Result<Option<Vec2>, Box<Diagnostic>> {
        let (x, y) = (self.number(code)?, self.number(code + 10)?);
        Ok(x.zip(y).map(|(x, y)| Vec2::new(x, y)))
    }

    pub fn needed(&self, code: i32) -> Result<Vec2, Box<Diagnostic>> {
        self.point(code)?.ok_or_else(|| {
            let message = format!("no X and Y with the codes {code} and {}", code + 10);
            self.refused(Rule::DxfEntity, message, "the file is not whole")
        })
    }

    pub fn radius(&self) -> Result<f64, Box<Diagnostic>> {
        match self.number(40)? {
            Some(radius) if radius > 0.0 => Ok(radius),
            other => {
                let message = format!("a radius of {}", other.unwrap_or(0.0));
                Err(self.refused(Rule::DxfEntity, message, "draw it anew"))
            }
        }
    }

    /// Whether it is seen from behind.
    pub fn behind(&self) -> Result<bool, Box<Diagnostic>> {
        let (x, y) = (self.number(210)?.unwrap_or(0.0), self.number(220)?.unwrap_or(0.0));
        let z = self.number(230)?.unwrap_or(1.0);
        if x.abs().max(y.abs()) > 1e-6 || z.abs() < 1e-6 {
            return Err(self.slanted());
        }
        Ok(z < 0.0)
    }

    /// The height at which it lies in the drawing or its block; of an old polyline its first vertex may say it.
    pub fn height(&self, vertices: &[Entity]) -> Result<f64, Box<Diagnostic>> {
        let (code, owner, turned) = match self.kind() {
            // The plane of lines, ellipses and splines is that of the drawing, whatever side they are seen from.
            b"LINE" | b"ELLIPSE" | b"SPLINE" => (30, self, false),
            b"LWPOLYLINE" => (38, self, self.behind()?),
            _ => (30, vertices.first().unwrap_or(self), self.behind()?),
        };
        let height = owner.number(code)?.unwrap_or(0.0);
        Ok(if turned { -height } else { height })
    }

    /// Refuses heights that differ by more than a micrometre, or a slope.
    pub fn level(&self, codes: &[i32], unit: f64) -> Result<(), Box<Diagnostic>> {
        let mut first = None;
        for code in codes {
            for group in self.all(*code) {
                let z = group.number()?;
                if (z - *first.get_or_insert(z)).abs() * unit > 1e-3 {
                    return Err(self.slanted());
                }
            }
        }
        Ok(())
    }

    pub fn slanted(&self) -> Box<Diagnostic> {
        let message = "it does not lie in the plane of X and Y".into();
        self.refused(Rule::DxfSlanted, message, "draw the contour in one plane")
    }

    pub fn refused(&self, rule: Rule, what: String, way_out: &str) -> Box<Diagnostic> {
        let message = format!("{}: {what}", String::from_utf8_lossy(self.kind()));
        Diagnostic::error(rule, message).help(way_out).line(self.line()).into()
    }
}

/// The parts of `groups` from each `0 first` up to its `0 last`.
pub(super) fn split<'a>(
    groups: &'a [Group<'a>],
    first: &'static [u8],
    last: &'static [u8],
) -> impl Iterator<Item = &'a [Group<'a>]> {
    let is = |group: &Group, name: &[u8]| group.code == 0 && group.value == name;
    let mut rest = groups;
    std::iter::from_fn(move || {
        let start = rest.iter().position(|group| is(group, first))?;
        let from = rest.get(start..)?;
        let end = from.iter().position(|group| is(group, last)).unwrap_or(from.len());
        rest = from.get(end..).unwrap_or_default();
        from.get(..end)
    })
}

/// The entities of `groups`, one after the other.
pub(super) fn each<'a>(groups: &'a [Group<'a>]) -> impl Iterator<Item = Entity<'a>> {
    let start = groups.iter().position(|group| group.code == 0).unwrap_or(groups.len());
    let mut rest = groups.get(start..).unwrap_or_default();
    std::iter::from_fn(move || {
        rest.first()?;
        let end = rest.iter().skip(1).position(|group| group.code == 0);
        let (entity, after) = rest.split_at(end.map_or(rest.len(), |end| end + 1));
        rest = after;
        Some(Entity { groups: entity })
    })
}

/// The vertices after a polyline, up to the end of their sequence.
pub(super) fn vertices<'a>(entities: &mut impl Iterator<Item = Entity<'a>>) -> Vec<Entity<'a>> {
    entities.take_while(|entity| entity.kind() == b"VERTEX").collect()
}
