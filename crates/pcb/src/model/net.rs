//! Which elements are joined: those that share a node on a side, and so they are of one net.

use super::Findings;
use crate::board::Face;
use program::{Diagnostic, Rule};
use std::collections::HashMap;
use std::sync::Arc;
use toml::Spanned;

/// Elements, and which of them are joined.
#[derive(Default)]
pub(super) struct Nets<'a> {
    /// For each element another one that it is joined with, or itself: they lead to one of all of them.
    next: Vec<usize>,
    /// The name that each was given.
    names: Vec<Option<&'a Spanned<String>>>,
    /// An element at a node on a side.
    at: HashMap<(usize, Face), usize>,
}

impl<'a> Nets<'a> {
    /// Adds an element on these nodes and sides; gives its number.
    pub(super) fn add(
        &mut self,
        nodes: &[usize],
        faces: &[Face],
        name: Option<&'a Spanned<String>>,
    ) -> usize {
        let element = self.next.len();
        self.next.push(element);
        self.names.push(name);
        for node in nodes {
            for face in faces {
                let other = *self.at.entry((*node, *face)).or_insert(element);
                let (one, other) = (self.first(element), self.first(other));
                if let Some(next) = self.next.get_mut(one.max(other)) {
                    *next = one.min(other);
                }
            }
        }
        element
    }

    /// The net of each element, by its number.
    pub(super) fn named(mut self, findings: &mut Findings) -> Vec<Option<Arc<str>>> {
        let mut nets: HashMap<usize, Arc<str>> = HashMap::new();
        let firsts: Vec<usize> = (0..self.next.len()).map(|element| self.first(element)).collect();
        for (first, name) in firsts.iter().zip(&self.names) {
            let Some(name) = name else { continue };
            let net = nets.entry(*first).or_insert_with(|| name.get_ref().as_str().into());
            if **net != *name.get_ref() {
                let message = format!("net `{}` is joined with `{net}` by nodes", name.get_ref());
                let help = "what shares a node on a side is one net: give it one name";
                findings.error(name.span(), Diagnostic::error(Rule::NetTwice, message).help(help));
            }
        }
        firsts.iter().map(|first| nets.get(first).cloned()).collect()
    }

    /// The element that stands for all that are joined with this one; the links to it become shorter.
    fn first(&mut self, mut element: usize) -> usize {
        while let Some(next) = self.next.get(element).copied().filter(|next| *next != element) {
            let beyond = self.next.get(next).copied().unwrap_or(next);
            if let Some(link) = self.next.get_mut(element) {
                *link = beyond;
            }
            element = beyond;
        }
        element
    }
}
