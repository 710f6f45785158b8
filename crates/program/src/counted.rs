//! Many findings that are alike, as a few and how many more there are.

use crate::diagnostic::MOST_PLACES;
use crate::{Diagnostic, Rule, Severity};
use std::collections::HashMap;

/// So many like findings are kept as they are.
const MOST: usize = 19;

/// So many of them are kept where there are more.
const FEW: usize = 3;

/// The lines of so many others are named.
const LINES: usize = 5;

/// So many kinds of messages of a rule are distinguished.
const KINDS: usize = 20;

/// Findings as they are collected. Like ones, which differ in names and numbers alone, are kept up to nineteen; of
/// more, the first three are kept, and the third counts the others. So a million findings take the room of some.
#[derive(Debug, Default)]
pub struct Findings {
    kept: Vec<Option<Diagnostic>>,
    groups: HashMap<(Severity, Rule, String), Group>,
    kinds: HashMap<(Severity, Rule), usize>,
}

/// Where like findings are kept.
#[derive(Debug, Default)]
struct Group {
    places: Vec<usize>,
    /// Whether there are more than are kept.
    is_large: bool,
}

impl Findings {
    /// Adds one.
    pub fn push(&mut self, found: Diagnostic) {
        let (severity, rule) = (found.severity, found.rule);
        let mut key = (severity, rule, format!("{}\n{}", found.file, kind(&found.message)));
        if !self.groups.contains_key(&key) {
            let kinds = self.kinds.entry((severity, rule)).or_default();
            match *kinds < KINDS {
                true => *kinds += 1,
                false => key.2 = String::new(),
            }
        }
        let group = self.groups.entry(key).or_default();
        if !group.is_large {
            group.places.push(self.kept.len());
            self.kept.push(Some(found));
            if group.places.len() > MOST {
                group.is_large = true;
                let others = group.places.split_off(FEW);
                let others: Vec<_> = others.iter().filter_map(|i| self.kept[*i].take()).collect();
                let last = group.places.last().and_then(|last| self.kept[*last].as_mut());
                last.into_iter()
                    .for_each(|last| others.iter().for_each(|other| count(last, other)));
            }
        } else if let Some(last) = group.places.last().and_then(|last| self.kept[*last].as_mut()) {
            count(last, &found);
        }
    }

    /// All that are kept, in their order.
    pub fn finish(self) -> Vec<Diagnostic> {
        self.kept.into_iter().flatten().collect()
    }
}

impl FromIterator<Diagnostic> for Findings {
    fn from_iter<All: IntoIterator<Item = Diagnostic>>(all: All) -> Findings {
        let mut findings = Findings::default();
        all.into_iter().for_each(|found| findings.push(found));
        findings
    }
}

/// Counts a finding that is not kept.
fn count(last: &mut Diagnostic, other: &Diagnostic) {
    last.count = last.count.saturating_add(other.count);
    let line = (other.line > 0).then_some(other.line);
    let room = MOST_PLACES.saturating_sub(last.places.len());
    last.places.extend(line.iter().chain(&other.places).take(room));
    if last.lines.len() < LINES && other.line > 0 {
        last.lines.push(other.line);
    }
}

/// A message without what it quotes and its numbers.
fn kind(message: &str) -> String {
    let (mut kind, mut quote) = (String::new(), None);
    for c in message.chars() {
        match quote {
            Some(end) if c == end => quote = None,
            Some(_) => {}
            None if matches!(c, '`' | '"') => {
                quote = Some(c);
                kind.push(c);
            }
            None if c.is_ascii_digit() => {}
            None => kind.push(c),
        }
    }
    kind
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(rule: Rule, message: String, line: u32) -> Diagnostic {
        Diagnostic::error(rule, message).help("correct it").line(line)
    }

    fn counts(findings: &[Diagnostic]) -> Vec<(u32, u32)> {
        findings.iter().map(|found| (found.line, found.count)).collect()
    }

    #[test]
    fn of_many_like_findings_the_third_counts_the_others() {
        let many =
            (1..=150_000).map(|i| found(Rule::MachineWord, format!("no word is called `W{i}`"), i));
        let kept = many.collect::<Findings>().finish();
        assert_eq!(counts(&kept), [(1, 1), (2, 1), (3, 149_998)]);
        assert_eq!(
            kept[2].to_string(),
            "3: error[machine-word]: no word is called `W3`\n    \
             … and 149,997 more like this, at lines 4, 5, 6, 7, 8 and on\n    = correct it"
        );
        // Once more it is the same.
        assert_eq!(kept.iter().cloned().collect::<Findings>().finish(), kept);
    }

    #[test]
    fn nineteen_like_findings_and_findings_of_other_kinds_stay() {
        let all: Vec<_> = (1..=19)
            .map(|i| found(Rule::Angle, format!("{i} mm"), i))
            .chain((20..=38).map(|i| found(Rule::Block, format!("{i} mm"), i)))
            .chain((39..=57).map(|i| found(Rule::Angle, format!("{i} degrees"), i)))
            .collect();
        assert_eq!(all.iter().cloned().collect::<Findings>().finish(), all);
    }

    #[test]
    fn messages_that_are_all_different_are_bounded_too() {
        let word = |i: u32| "x".repeat(i as usize % 997 + 1);
        let many = (1..=20_000).map(|i| found(Rule::Angle, format!("{} is unknown", word(i)), i));
        let kept = many.collect::<Findings>().finish();
        assert!(kept.len() <= (KINDS + 1) * MOST, "{}", kept.len());
        assert_eq!(kept.iter().map(|found| found.count).sum::<u32>(), 20_000);
    }

    #[test]
    fn the_places_of_those_that_are_counted_are_kept() {
        let many =
            (1..=30).map(|i| found(Rule::MachineWord, format!("no word is called `W{i}`"), i));
        let kept = many.collect::<Findings>().finish();
        assert_eq!(counts(&kept), [(1, 1), (2, 1), (3, 28)]);
        assert_eq!(kept[2].places, (4..=30).collect::<Vec<u32>>());
        let mut again = found(Rule::MachineWord, "no word".into(), 7);
        again.again(9);
        again.again(0);
        assert_eq!((again.count, &again.places[..]), (3, &[9][..]));
        let all = (1..=40_000).map(|i| found(Rule::MachineWord, "no word".into(), i));
        let kept = all.collect::<Findings>().finish();
        assert_eq!(kept[2].places.len(), MOST_PLACES);
    }
}
