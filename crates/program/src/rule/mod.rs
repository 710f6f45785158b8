//! The catalogue of rules: every finding is of one of them.

mod catalogue;

pub use catalogue::Rule;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::fmt;

/// What is said of a rule, whatever the file at hand.
struct Entry {
    name: &'static str,
    former_names: &'static [&'static str],
    meaning: &'static str,
    way_out: &'static str,
    example: &'static str,
}

/// Makes the enum of the rows, and the table of what is said of each.
macro_rules! rules {
    ($($rule:ident $name:literal [$($former:literal),*] $meaning:literal $way_out:literal $example:literal;)*) => {
        /// The rule that a finding is of. Its name is stable, for machines: names that have changed stay known
        /// for one version ([`Rule::former_names`]).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Rule {
            $(#[doc = $meaning] $rule,)*
        }

        impl Rule {
            /// All rules, in the order of their names.
            pub const ALL: &[Rule] = &[$(Rule::$rule,)*];

            pub(super) fn entry(self) -> &'static Entry {
                const ENTRIES: &[Entry] = &[$(Entry {
                    name: $name,
                    former_names: &[$($former),*],
                    meaning: $meaning,
                    way_out: $way_out,
                    example: $example,
                },)*];
                &ENTRIES[self as usize]
            }
        }
    };
}
use rules;

impl Rule {
    /// Its name, in kebab case, such as `axis-limit`.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// The names that it had in the version before this one, where they differ.
    pub fn former_names(self) -> &'static [&'static str] {
        self.entry().former_names
    }

    /// What its findings say, in a sentence.
    pub fn meaning(self) -> &'static str {
        self.entry().meaning
    }

    /// What to do about a finding that names no way out of its own.
    pub fn way_out(self) -> &'static str {
        self.entry().way_out
    }

    /// Input of which there is such a finding. Where it begins with the name of a control, the quoted blocks are
    /// refused by the virtual control of that name; with `apt: `, the quoted records by the reader of cutter-location data.
    pub fn example(self) -> &'static str {
        self.entry().example
    }

    /// The rule of that name; where no rule has it today, those that had it: more than one where a rule was split.
    pub fn named(name: &str) -> Vec<Rule> {
        match Rule::ALL.binary_search_by_key(&name, |rule| rule.name()) {
            Ok(index) => vec![Rule::ALL[index]],
            Err(_) => {
                let formerly = |rule: &&Rule| rule.former_names().contains(&name);
                Rule::ALL.iter().filter(formerly).copied().collect()
            }
        }
    }

    /// Writes `rule`, and `former_rules` where it has had other names, as fields of a finding.
    pub(crate) fn fields<S: Serializer>(rule: &Rule, to: S) -> Result<S::Ok, S::Error> {
        let mut fields = to.serialize_map(None)?;
        fields.serialize_entry("rule", rule)?;
        if !rule.former_names().is_empty() {
            fields.serialize_entry("former_rules", rule.former_names())?;
        }
        fields.end()
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Serialize for Rule {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name())
    }
}

/// A rule as users see it, and as tests name it.
impl PartialEq<str> for Rule {
    fn eq(&self, name: &str) -> bool {
        self.name() == name
    }
}

impl PartialEq<&str> for Rule {
    fn eq(&self, name: &&str) -> bool {
        *self == **name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_stands_once_in_the_order_of_the_names() {
        assert!(Rule::ALL.is_sorted_by(|a, b| a.name() < b.name()));
        for rule in Rule::ALL {
            let variant: String = rule.name().split('-').map(capital).collect();
            assert_eq!(format!("{rule:?}"), variant);
        }
    }

    fn capital(word: &str) -> String {
        word[..1].to_uppercase() + &word[1..]
    }

    #[test]
    fn each_rule_has_a_sentence_a_way_out_and_an_example() {
        for rule in Rule::ALL {
            assert!(rule.meaning().ends_with('.'), "{rule}");
            assert!(!rule.way_out().is_empty() && !rule.way_out().ends_with('.'), "{rule}");
            assert!(
                !rule.example().is_empty() && rule.example().matches('`').count() % 2 == 0,
                "{rule}"
            );
        }
    }

    #[test]
    fn a_former_name_leads_to_one_rule_or_to_those_that_it_was_split_into() {
        let former: Vec<&str> =
            Rule::ALL.iter().flat_map(|rule| rule.former_names()).copied().collect();
        let split = [("word", [Rule::DataWord, Rule::MachineWord])];
        for name in &former {
            match split.iter().find(|(was, _)| was == name) {
                Some((_, rules)) => assert_eq!(Rule::named(name), rules, "{name}"),
                None => {
                    let count = former.iter().filter(|other| *other == name).count();
                    assert_eq!(count, 1, "{name}");
                }
            }
        }
        assert_eq!(Rule::named("nc-arc"), [Rule::Arc]);
        assert_eq!(Rule::named("output"), [Rule::Output], "the name of today goes first");
        assert!(Rule::named("no-such-rule").is_empty());
    }
}
