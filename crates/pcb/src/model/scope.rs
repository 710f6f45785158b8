//! Groups in their places, and what names of nodes mean in them.

use super::Findings;
use super::sheet::{At, Group};
use geom::{Transform, Vec2};
use program::{Diagnostic, Rule, nearest};
use std::collections::BTreeMap;
use std::iter;
use toml::Spanned;

/// How deep groups may lie in each other.
pub const DEEPEST: usize = 64;

/// The farthest coordinate, mm.
const FAR: f64 = 1e5;

/// All groups, each after the one that it lies in, and all nodes.
pub(super) struct Scopes<'a> {
    pub(super) all: Vec<Scope<'a>>,
    /// Where each node is, mm. A position in place of a name is a node of its own.
    nodes: Vec<Vec2>,
}

/// A group in its place.
pub(super) struct Scope<'a> {
    pub(super) group: &'a Group,
    /// How it is transformed about its origin,
    pub(super) transform: Transform,
    /// which goes here, mm.
    at: Vec2,
    /// The group that it lies in.
    outer: Option<usize>,
    /// Its nodes by their names, and the groups in it.
    nodes: BTreeMap<&'a str, usize>,
    groups: BTreeMap<&'a str, usize>,
}

impl<'a> Scopes<'a> {
    /// Puts `root` and all groups in it in their places.
    pub(super) fn of(root: &'a Spanned<Group>, findings: &mut Findings) -> Scopes<'a> {
        let mut scopes = Scopes { all: Vec::new(), nodes: Vec::new() };
        scopes.add(root, None, 0, findings);
        scopes
    }

    fn add(
        &mut self,
        placed: &'a Spanned<Group>,
        outer: Option<usize>,
        depth: usize,
        findings: &mut Findings,
    ) {
        let group = placed.get_ref();
        if depth > DEEPEST {
            let message = format!("groups lie more than {DEEPEST} deep in each other");
            let found =
                Diagnostic::error(Rule::Group, message).help("put groups next to each other");
            return findings.error(placed.span(), found);
        }
        let around = outer.and_then(|outer| self.all.get(outer));
        let around = around.map_or(Transform::NONE, |outer| outer.transform);
        let at = match &group.at {
            None => Some(self.place(outer, Vec2::ZERO)),
            Some(at) => self.node(outer, at, findings).map(|node| self.position(node)),
        };
        let rotation = group.rotation.as_ref().map_or(0.0, |degrees| *degrees.get_ref());
        if let Some(degrees) = group.rotation.as_ref().filter(|_| !rotation.is_finite()) {
            findings.error(degrees.span(), no_angle(rotation));
        }
        let transform = around.after(&Transform::new(group.mirrored, rotation, 1.0));
        let at = at.unwrap_or_default();
        let (nodes, groups) = (BTreeMap::new(), BTreeMap::new());
        let index = self.all.len();
        self.all.push(Scope { group, transform, at, outer, nodes, groups });
        for (name, position) in &group.nodes {
            if name.is_empty() || name.contains('.') {
                let message = format!("`{name}` is no name of a node");
                let help = "names have no dots: these stand between a group and a node of it";
                findings.error(position.span(), Diagnostic::error(Rule::Node, message).help(help));
            }
            let position = self.checked(index, position.get_ref(), position.span(), findings);
            let node = self.new_node(position);
            if let Some(scope) = self.all.get_mut(index) {
                scope.nodes.insert(name, node);
            }
        }
        for inner in &group.groups {
            if let (Some(name), next) = (&inner.get_ref().name, self.all.len())
                && let Some(scope) = self.all.get_mut(index)
                && scope.groups.insert(name, next).is_some()
            {
                let message = format!("two groups on one level are called `{name}`");
                let found =
                    Diagnostic::error(Rule::Group, message).help("call one of them otherwise");
                findings.error(inner.span(), found);
            }
            self.add(inner, Some(index), depth + 1, findings);
        }
    }

    /// Where a node is, mm.
    pub(super) fn position(&self, node: usize) -> Vec2 {
        self.nodes.get(node).copied().unwrap_or_default()
    }

    /// The node that is meant in a group; `None` is an error that was reported.
    pub(super) fn node(
        &mut self,
        scope: Option<usize>,
        at: &Spanned<At>,
        findings: &mut Findings,
    ) -> Option<usize> {
        let path = match at.get_ref() {
            At::Name(path) => path,
            At::Position(position) => {
                let place = match scope {
                    Some(scope) => self.checked(scope, position, at.span(), findings),
                    None => Vec2::from_array(*position),
                };
                return Some(self.new_node(place));
            }
        };
        let (groups, name) = match path.rsplit_once('.') {
            Some((groups, name)) => (Some(groups), name),
            None => (None, path.as_str()),
        };
        let outwards = iter::successors(scope, |scope| self.all.get(*scope)?.outer);
        let scopes = outwards.filter_map(|scope| match groups {
            None => self.all.get(scope),
            Some(groups) => self.within(scope, groups),
        });
        let found = scopes.clone().find_map(|scope| scope.nodes.get(name));
        if found.is_none() {
            let known = scopes.flat_map(|scope| scope.nodes.keys().copied());
            let message = format!("there is no node `{path}` in this group or around it");
            let help = match nearest(name, known).as_str() {
                "" => String::from("put it in `nodes`, or give its position [x, y]"),
                meant => format!("did you mean {meant}?"),
            };
            findings.error(at.span(), Diagnostic::error(Rule::NodeUnknown, message).help(help));
        }
        found.copied()
    }

    /// The group that a path of names leads to from another group.
    fn within(&self, scope: usize, path: &str) -> Option<&Scope<'a>> {
        let index = path
            .split('.')
            .try_fold(scope, |scope, name| self.all.get(scope)?.groups.get(name).copied())?;
        self.all.get(index)
    }

    /// Where a position of a group is on the board.
    fn place(&self, scope: Option<usize>, position: Vec2) -> Vec2 {
        let scope = scope.and_then(|scope| self.all.get(scope));
        scope.map_or(position, |scope| scope.at + scope.transform.apply(position))
    }

    /// The same, where it is a place of this world.
    fn checked(
        &self,
        scope: usize,
        position: &[f64; 2],
        span: std::ops::Range<usize>,
        findings: &mut Findings,
    ) -> Vec2 {
        let place = self.place(Some(scope), Vec2::from_array(*position));
        if !place.to_array().iter().all(|value| value.abs() <= FAR) {
            let [x, y] = position;
            let message = format!("X {x} Y {y} is not a place within {FAR} mm");
            let found = Diagnostic::error(Rule::Node, message).help("positions are in mm");
            findings.error(span, found);
        }
        place
    }

    fn new_node(&mut self, place: Vec2) -> usize {
        self.nodes.push(place);
        self.nodes.len() - 1
    }
}

/// What is no angle.
pub(super) fn no_angle(degrees: f64) -> Diagnostic {
    let message = format!("a rotation by {degrees} degrees");
    Diagnostic::error(Rule::Angle, message).help("give a number of degrees, counter-clockwise")
}
