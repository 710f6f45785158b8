//! The sections of the file, and blocks in their places.

use super::entity::{Entity, each, split, vertices};
use super::groups::Group;
use super::placement::Placement;
use super::shapes::{Shape, Shapes};
use super::{Drawing, Options, Piece};
use crate::element::{Element, FAR, finite};
use geom::Vec2;
use program::{Diagnostic, Rule};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The deepest nesting of blocks.
const DEEPEST: usize = 16;

/// The most elements that a drawing may come to.
const MOST: usize = 5_000_000;

/// A block: its base point and its entities.
#[derive(Clone, Copy)]
struct Block<'a> {
    base: Vec2,
    groups: &'a [Group<'a>],
}

/// Reads the sections of a file.
pub(super) struct Reader<'a> {
    groups: &'a [Group<'a>],
    options: &'a Options,
    unit: f64,
    blocks: HashMap<&'a [u8], Block<'a>>,
    /// Layers that are off or frozen, in capitals.
    hidden: Vec<Vec<u8>>,
    pieces: Vec<Piece>,
    count: usize,
    /// What was left out, by kind, with the first line and how often.
    left_out: BTreeMap<String, (u32, u32)>,
    /// Layers that hold something, in capitals.
    layers: BTreeSet<Vec<u8>>,
    warnings: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    pub fn new(groups: &'a [Group<'a>], options: &'a Options) -> Reader<'a> {
        Reader {
            groups,
            options,
            unit: 1.0,
            blocks: HashMap::new(),
            hidden: Vec::new(),
            pieces: Vec::new(),
            count: 0,
            left_out: BTreeMap::new(),
            layers: BTreeSet::new(),
            warnings: Vec::new(),
        }
    }

    /// Reads all sections. Blocks and layers come before the entities that use them.
    pub fn read(&mut self) -> Result<(), Box<Diagnostic>> {
        let mut unit = None;
        let mut drawn: &[Group] = &[];
        for section in split(self.groups, b"SECTION", b"ENDSEC") {
            match section.get(1).filter(|group| group.code == 2).map(|group| group.value) {
                Some(b"HEADER") => unit = insertion_unit(section)?,
                Some(b"TABLES") => self.tables(section)?,
                Some(b"BLOCKS") => self.read_blocks(section)?,
                Some(b"ENTITIES") => drawn = section.get(2..).unwrap_or_default(),
                _ => {}
            }
        }
        self.unit = match (self.options.unit, unit) {
            (Some(unit), _) if unit > 0.0 && unit <= FAR => unit,
            (Some(unit), _) => {
                let message = format!("a unit of {unit} mm");
                let refused = Diagnostic::error(Rule::DxfOptions, message);
                return Err(refused.help("give the mm in a unit of the drawing").into());
            }
            (None, Some(unit)) => unit,
            (None, None) => {
                let message = "the drawing names no unit: it is read in mm";
                let warning = Diagnostic::warning(Rule::DxfUnit, message);
                self.warnings
                    .push(warning.help("set $INSUNITS in the CAD program, if it is another"));
                1.0
            }
        };
        self.entities(drawn, &Placement::scaled(self.unit), b"0", 0)
    }

    /// What is drawn, and what there is to say.
    pub fn finish(mut self) -> Result<Drawing, Box<Diagnostic>> {
        for layer in &self.options.layers {
            if !self.layers.contains(layer.to_ascii_uppercase().as_bytes()) {
                let names = self.layers.iter().map(|name| String::from_utf8_lossy(name));
                let names: Vec<_> = names.take(20).collect();
                let message = format!("no contour on layer `{layer}`");
                return Err(Diagnostic::error(Rule::DxfLayer, message)
                    .help(format!("layers that hold some: {}", names.join(", ")))
                    .into());
            }
        }
        for (kind, (line, count)) in self.left_out {
            let message = format!("{kind}: not read");
            let warning = Diagnostic::warning(Rule::DxfLeftOut, message).line(line);
            self.warnings.push(Diagnostic { count, ..warning });
        }
        Ok(Drawing { pieces: self.pieces, warnings: self.warnings })
    }

    /// Which layers are off or frozen.
    fn tables(&mut self, section: &'a [Group<'a>]) -> Result<(), Box<Diagnostic>> {
        for entity in each(section).filter(|entity| entity.kind() == b"LAYER") {
            let off = entity.number(62)?.is_some_and(|color| color < 0.0);
            let frozen = entity.whole(70)?.is_some_and(|flags| flags & 1 != 0);
            if (off || frozen)
                && let Some(name) = entity.first(2)
            {
                self.hidden.push(name.value.to_ascii_uppercase());
            }
        }
        Ok(())
    }

    fn read_blocks(&mut self, section: &'a [Group<'a>]) -> Result<(), Box<Diagnostic>> {
        for groups in split(section, b"BLOCK", b"ENDBLK") {
            let head = groups.iter().skip(1).position(|group| group.code == 0);
            let (head, rest) = groups.split_at(head.map_or(groups.len(), |i| i + 1));
            let head = Entity { groups: head };
            if let Some(name) = head.first(2) {
                let base = head.point(10)?.unwrap_or_default();
                self.blocks.insert(name.value, Block { base, groups: rest });
            }
        }
        Ok(())
    }

    /// The entities of model space or of a block, whose layer 0 is that of the insertion.
    fn entities(
        &mut self,
        groups: &'a [Group<'a>],
        placement: &Placement,
        layer: &'a [u8],
        depth: usize,
    ) -> Result<(), Box<Diagnostic>> {
        let mut entities = each(groups);
        while let Some(entity) = entities.next() {
            self.spend(1, &entity)?;
            let own = entity.first(8).map_or(&b"0"[..], |group| group.value);
            let own = if own == b"0" { layer } else { own };
            let vertices = (entity.kind() == b"POLYLINE").then(|| vertices(&mut entities));
            if entity.whole(67)? == Some(1) {
                self.leave_out("paper space", &entity);
            } else if entity.whole(60)? == Some(1) {
                self.leave_out("invisible entity", &entity);
            } else if entity.kind() == b"INSERT" {
                self.insert(&entity, placement, own, depth)?;
            } else if self.shown(own, &entity) {
                let shapes = Shapes { options: self.options, unit: self.unit };
                let vertices = vertices.unwrap_or_default();
                match shapes.shape(&entity, &vertices)? {
                    Shape::Elements(piece) => self.keep(&piece, &entity, &vertices, placement)?,
                    Shape::Other(kind) => self.leave_out(&kind, &entity),
                    Shape::Nothing => {}
                }
            }
        }
        Ok(())
    }

    /// Whether what is on `layer` is read.
    fn shown(&mut self, layer: &[u8], entity: &Entity) -> bool {
        let name = layer.to_ascii_uppercase();
        let asked = &self.options.layers;
        if asked.is_empty() {
            let hidden = self.hidden.contains(&name);
            if hidden {
                self.leave_out("entity on a layer that is off or frozen", entity);
            }
            return !hidden;
        }
        let shown = asked.iter().any(|layer| layer.to_ascii_uppercase().as_bytes() == name);
        self.layers.insert(name);
        shown
    }

    fn leave_out(&mut self, kind: &str, entity: &Entity) {
        self.left_out.entry(kind.into()).or_insert((entity.line(), 0)).1 += 1;
    }

    fn keep(
        &mut self,
        piece: &[Element],
        entity: &Entity,
        vertices: &[Entity],
        placement: &Placement,
    ) -> Result<(), Box<Diagnostic>> {
        self.spend(piece.len(), entity)?;
        let placed = |element: &Element| placement.element(element).from_line(entity.line());
        let piece: Vec<Element> = piece.iter().map(placed).collect();
        for element in &piece {
            finite(&[element.start, element.end]).map_err(|d| d.line(entity.line()))?;
        }
        let height = placement.height(entity.height(vertices)?);
        if height.abs() > FAR {
            return Err(entity.refused(
                Rule::NotAPlace,
                format!("a height of {height} mm"),
                "look at the unit of the drawing",
            ));
        }
        self.pieces.push(Piece { height, elements: piece });
        Ok(())
    }

    /// Counts elements and entities: blocks within blocks grow fast.
    fn spend(&mut self, count: usize, entity: &Entity) -> Result<(), Box<Diagnostic>> {
        self.count = self.count.saturating_add(count);
        if self.count > MOST {
            let message = format!("the drawing comes to more than {MOST} elements");
            return Err(entity.refused(
                Rule::DxfSize,
                message,
                "choose layers by --layer, or divide it",
            ));
        }
        Ok(())
    }

    fn insert(
        &mut self,
        entity: &Entity<'a>,
        placement: &Placement,
        layer: &'a [u8],
        depth: usize,
    ) -> Result<(), Box<Diagnostic>> {
        let name = entity.first(2).map_or(&b""[..], |group| group.value);
        let Some(block) = self.blocks.get(name).copied() else {
            let message = format!("no block `{}`", String::from_utf8_lossy(name));
            return Err(entity.refused(Rule::DxfInsert, message, "the file is not whole"));
        };
        if depth >= DEEPEST {
            let message = format!("blocks within blocks, more than {DEEPEST} deep");
            return Err(entity.refused(Rule::DxfInsert, message, "explode them"));
        }
        let (x, y) = (entity.number(41)?.unwrap_or(1.0), entity.number(42)?.unwrap_or(1.0));
        if x == 0.0 || (x.abs() - y.abs()).abs() > 1e-9 * x.abs() {
            let message = format!("a block at scale {x} in X and {y} in Y");
            return Err(entity.refused(
                Rule::DxfInsert,
                message,
                "explode it: circles become ellipses",
            ));
        }
        let turned = Vec2::from_angle(entity.number(50)?.unwrap_or(0.0).to_radians());
        let here = Placement {
            axis: turned * x,
            mirrored: (x < 0.0) != (y < 0.0),
            shift: entity.point(10)?.unwrap_or_default(),
            up: entity.number(43)?.unwrap_or(1.0),
            rise: entity.number(30)?.unwrap_or(0.0),
        };
        let columns = entity.whole(70)?.unwrap_or(1).max(1);
        let rows = entity.whole(71)?.unwrap_or(1).max(1);
        let each = Vec2::new(entity.number(44)?.unwrap_or(0.0), entity.number(45)?.unwrap_or(0.0));
        let seen = if entity.behind()? { placement.of(&Placement::behind()) } else { *placement };
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |c| (row, c))) {
            self.spend(1, entity)?;
            let aside = turned.rotate(each * Vec2::new(column as f64, row as f64));
            let here = Placement { shift: here.shift + aside, ..here };
            let base = here.direction(-block.base);
            let here = Placement { shift: here.shift + base, ..here };
            self.entities(block.groups, &seen.of(&here), layer, depth + 1)?;
        }
        Ok(())
    }
}

/// mm in a unit of `$INSUNITS`; `None` where it says nothing.
fn insertion_unit(header: &[Group]) -> Result<Option<f64>, Box<Diagnostic>> {
    let named = header.iter().skip_while(|g| g.code != 9 || g.value != b"$INSUNITS").nth(1);
    let Some(group) = named else { return Ok(None) };
    Ok(Some(match group.whole()? {
        0 => return Ok(None),
        1 => 25.4,
        2 => 304.8,
        4 => 1.0,
        5 => 10.0,
        6 => 1000.0,
        8 => 25.4e-6,
        9 => 25.4e-3,
        10 => 914.4,
        12 => 1e-6,
        13 => 1e-3,
        14 => 100.0,
        unit => {
            let message = format!("the unit {unit} of $INSUNITS is none that parts are drawn in");
            let refused = Diagnostic::error(Rule::DxfUnit, message).line(group.line);
            return Err(refused.help("set $INSUNITS in the CAD program").into());
        }
    }))
}
