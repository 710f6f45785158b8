//! DXF: what `sketch` reads of it, each entity at its height.

use super::{Count, Curve, Curves, FINE, arc};
use glam::{DVec2, DVec3};
use program::Diagnostic;
use sketch::dxf::{self, Options, Piece};

fn flat(at: geom::Vec2) -> DVec2 {
    DVec2::new(at.x, at.y)
}

pub(super) fn read(bytes: &[u8]) -> Result<Curves, Box<Diagnostic>> {
    let dxf::Drawing { pieces, warnings } = dxf::read(bytes, &Options::default())?;
    let ends = pieces.iter().flat_map(|piece| &piece.elements).map(|element| {
        let around = element.radius().unwrap_or_default();
        let start = flat(element.start);
        (start - around, start + around)
    });
    let bounds = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let size = bounds.map_or(1.0, |(low, high)| (high - low).max_element()).max(1e-3);
    let mut count = Count::default();
    let mut curves = Vec::with_capacity(pieces.len());
    for Piece { height, elements } in &pieces {
        let Some(first) = elements.first() else { continue };
        let raised = |at: DVec2| at.extend(*height);
        let mut corners: Vec<DVec3> = vec![raised(flat(first.start))];
        for element in elements {
            let before = corners.len();
            if let Some(turn) = element.turn {
                let on_arc = arc(flat(element.start), flat(turn.center), turn.sweep, FINE * size);
                corners.extend(on_arc.map(raised));
                corners.pop();
            }
            corners.push(raised(flat(element.end)));
            count.more(corners.len() - before, element.line).map_err(|f| f.diagnostic(""))?;
        }
        curves.push(Curve { corners });
    }
    Ok(Curves { curves, warnings })
}
