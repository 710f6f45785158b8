//! Boards that are built, element by element.

use crate::arguments::number;
use crate::error::{findings, raised, refused};
use crate::posting::save;
use pcb::model;
use program::{Diagnostic, Rule};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// A printed circuit board; :func:`toolpost.pcb` makes its programs, and ``toolpost pcb`` of what
/// :meth:`save` saves.
#[pyclass(module = "toolpost", frozen)]
pub struct Board {
    reading: model::Reading,
    text: String,
}

#[pymethods]
impl Board {
    /// A builder of a board of this name.
    #[staticmethod]
    #[pyo3(signature = (name = "board"))]
    fn builder(name: &str) -> BoardBuilder {
        let mut sheet = Map::new();
        sheet.insert("name".into(), name.into());
        BoardBuilder { sheet, depth: 0, length: 0 }
    }

    /// What it is called.
    #[getter]
    pub fn name(&self) -> &str {
        &self.reading.board.name
    }

    /// The board as JSON.
    #[getter]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What is odd about it.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        findings(py, &self.reading.warnings)
    }

    /// Its lower left and its upper right corner, mm.
    #[getter]
    fn extents(&self) -> ((f64, f64), (f64, f64)) {
        let (low, high) = self.reading.board.extents().unwrap_or_default();
        (low.into(), high.into())
    }

    /// Save the board as a JSON file.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        save(py, path, self.text.as_bytes(), Vec::new(), None, Vec::new())
    }

    fn __repr__(&self) -> String {
        format!("<Board {}>", self.reading.board.name)
    }
}

/// Builds a :class:`Board`; every method but :meth:`build` answers the builder, for a chain of calls.
///
/// Lengths are mm, rotations degrees counter-clockwise, layers ``front``, ``back`` or ``both``; the board is
/// seen from the front. A node is given by its name, or by its position ``(x, y)``. Elements that share a
/// node on a side are joined. What a name means, and whether all fits together, is looked at by
/// :meth:`build`.
#[pyclass(module = "toolpost")]
pub struct BoardBuilder {
    sheet: Map<String, Value>,
    /// How deep groups lie in it.
    depth: usize,
    /// How many bytes its elements and nodes are, about, as JSON without blanks: never more than the text.
    length: usize,
}

/// The builder again.
type Built<'py> = PyResult<PyRefMut<'py, BoardBuilder>>;

/// A node: its name, or a position, mm.
#[derive(FromPyObject)]
enum Node {
    Name(String),
    Position([f64; 2]),
}

impl Node {
    fn value(self, py: Python<'_>) -> PyResult<Value> {
        match self {
            Node::Name(name) => Ok(name.into()),
            Node::Position(position) => place(py, position),
        }
    }
}

#[pymethods]
impl BoardBuilder {
    /// A node of this name at a position.
    fn node<'py>(mut slf: PyRefMut<'py, Self>, name: &str, position: [f64; 2]) -> Built<'py> {
        let py = slf.py();
        let position = place(py, position)?;
        let nodes = slf.sheet.entry("nodes").or_insert_with(|| json!({}));
        if nodes.as_object().is_some_and(|nodes| nodes.contains_key(name)) {
            let found = Diagnostic::error(Rule::Node, format!("there is a node `{name}` already"));
            return Err(refused(py, found.help("give each node a name of its own")));
        }
        let length = name.len() + position.to_string().len();
        nodes[name] = position;
        slf.length += length;
        Ok(slf)
    }

    /// Copper of a width from node to node, with round ends.
    #[pyo3(signature = (nodes, width, *, layer = "front", net = None))]
    fn track<'py>(
        mut slf: PyRefMut<'py, Self>,
        nodes: Vec<Node>,
        width: f64,
        layer: &str,
        net: Option<&str>,
    ) -> Built<'py> {
        let py = slf.py();
        let nodes = values(py, nodes)?;
        let width = number(py, "width", width)?;
        slf.add("tracks", json!({"nodes": nodes, "width": width, "layer": layer}), net);
        Ok(slf)
    }

    /// Copper about a node: a ``circle``, ``square`` or ``octagon``, whose size is its diameter, or the
    /// distance of two opposite sides.
    #[pyo3(signature = (node, shape, size, *, rotation = 0.0, layer = "front", net = None))]
    fn pad<'py>(
        mut slf: PyRefMut<'py, Self>,
        node: Node,
        shape: &str,
        size: f64,
        rotation: f64,
        layer: &str,
        net: Option<&str>,
    ) -> Built<'py> {
        let py = slf.py();
        let (node, size) = (node.value(py)?, number(py, "size", size)?);
        let rotation = number(py, "rotation", rotation)?;
        let pad = json!({
            "node": node, "shape": shape, "size": size, "rotation": rotation, "layer": layer
        });
        slf.add("pads", pad, net);
        Ok(slf)
    }

    /// A hole at a node.
    #[pyo3(signature = (node, diameter, *, plated = None))]
    fn hole<'py>(
        mut slf: PyRefMut<'py, Self>,
        node: Node,
        diameter: f64,
        plated: Option<bool>,
    ) -> Built<'py> {
        let py = slf.py();
        let (node, diameter) = (node.value(py)?, number(py, "diameter", diameter)?);
        let mut hole = json!({"node": node, "diameter": diameter});
        if let Some(plated) = plated {
            hole["plated"] = plated.into();
        }
        slf.add("holes", hole, None);
        Ok(slf)
    }

    /// The edge of the board, or of a cut-out in it: closed, by straight lines.
    fn edge<'py>(mut slf: PyRefMut<'py, Self>, nodes: Vec<Node>) -> Built<'py> {
        let nodes = values(slf.py(), nodes)?;
        slf.add("edges", json!({ "nodes": nodes }), None);
        Ok(slf)
    }

    /// All that another builder has so far, as a group: turned about its origin, which goes to a node.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     What it is called here: a node of it is ``name.node``.
    /// group : BoardBuilder
    ///     What is in it; a copy is taken.
    /// at : str or tuple of 2 floats
    ///     Where its origin goes.
    /// rotation : float
    ///     Degrees, counter-clockwise.
    /// mirrored : bool
    ///     Whether it lies on the other side: left and right, front and back change places.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``group`` or ``board-file`` where groups lie deeper in each other, or copies are more, than a board
    ///     may have.
    #[pyo3(signature = (name, group, at, *, rotation = 0.0, mirrored = false))]
    fn group<'py>(
        mut slf: PyRefMut<'py, Self>,
        name: &str,
        group: PyRef<'py, BoardBuilder>,
        at: Node,
        rotation: f64,
        mirrored: bool,
    ) -> Built<'py> {
        let py = slf.py();
        let refuse = |rule, message: String, help: &str| {
            Err(refused(py, Diagnostic::error(rule, message).help(help)))
        };
        let (depth, length) = (group.depth + 1, slf.length + group.length);
        if depth > model::DEEPEST {
            let message = format!("groups lie more than {} deep in each other", model::DEEPEST);
            return refuse(Rule::Group, message, "put groups next to each other");
        }
        if length > model::LONGEST {
            let message = format!("{length} bytes are no board; {} are the most", model::LONGEST);
            return refuse(Rule::BoardFile, message, "take fewer copies");
        }
        let mut sheet = group.sheet.clone();
        sheet.insert("name".into(), name.into());
        sheet.insert("at".into(), at.value(py)?);
        sheet.insert("rotation".into(), number(py, "rotation", rotation)?.into());
        sheet.insert("mirrored".into(), mirrored.into());
        slf.add("groups", sheet.into(), None);
        slf.depth = slf.depth.max(depth);
        Ok(slf)
    }

    /// The board as it is so far.
    ///
    /// Raises
    /// ------
    /// toolpost.Error
    ///     ``node-unknown``, ``net-twice``, ``width`` and whatever else makes it no board.
    fn build(&self, py: Python<'_>) -> PyResult<Board> {
        let text = format!("{:#}\n", Value::Object(self.sheet.clone()));
        let reading = model::read("built", text.as_bytes()).map_err(|found| raised(py, &found))?;
        Ok(Board { reading, text })
    }

    fn __repr__(&self) -> String {
        format!("<BoardBuilder {}>", self.sheet.get("name").and_then(Value::as_str).unwrap_or(""))
    }
}

impl BoardBuilder {
    /// Adds an element, which may be part of a net.
    fn add(&mut self, table: &str, mut element: Value, net: Option<&str>) {
        if let Some(net) = net {
            element["net"] = net.into();
        }
        self.length += element.to_string().len();
        if let Value::Array(elements) = self.sheet.entry(table).or_insert_with(|| json!([])) {
            elements.push(element);
        }
    }
}

fn values(py: Python<'_>, nodes: Vec<Node>) -> PyResult<Vec<Value>> {
    nodes.into_iter().map(|node| node.value(py)).collect()
}

fn place(py: Python<'_>, position: [f64; 2]) -> PyResult<Value> {
    let [x, y] = position;
    Ok(json!([number(py, "X", x)?, number(py, "Y", y)?]))
}
