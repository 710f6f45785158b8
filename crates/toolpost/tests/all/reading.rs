//! `docs/controls/reading` reads each sample program aloud. What it quotes is the sample, block by block and without
//! a gap: whoever changes what is written reads it anew.

use crate::files::root;
use std::collections::BTreeMap;

/// What a page says of one sample.
struct Reading {
    /// The sample that this one is compared with, where it is the same but for some blocks.
    like: Option<String>,
    quoted: Vec<String>,
    /// Whether each quoted stretch has words behind it.
    explained: bool,
}

/// The readings of a page, by the name of the sample.
fn readings(page: &str) -> BTreeMap<String, Reading> {
    let mut all = BTreeMap::new();
    for section in page.split("\n## ").skip(1) {
        let (heading, text) = section.split_once('\n').unwrap();
        let (name, like) = match heading.split_once(", as ") {
            Some((name, like)) => (name, Some(like.to_owned())),
            None => (heading, None),
        };
        let parts: Vec<&str> = text.split("```").collect();
        assert!(parts.len() % 2 == 1, "{name}: a quotation is not closed");
        let quoted = parts.iter().skip(1).step_by(2);
        let quoted = quoted.flat_map(|part| part.strip_prefix("text\n").unwrap().lines());
        let reading = Reading {
            like,
            quoted: quoted.map(str::to_owned).collect(),
            explained: parts.iter().skip(2).step_by(2).all(|words| words.trim().len() > 2),
        };
        assert!(all.insert(name.to_owned(), reading).is_none(), "{name} is read twice");
    }
    all
}

#[test]
fn every_block_of_every_sample_is_read() {
    let mut all = BTreeMap::new();
    for page in std::fs::read_dir(root().join("docs/controls/reading")).unwrap() {
        let page = std::fs::read_to_string(page.unwrap().path()).unwrap();
        all.extend(readings(&page));
    }
    let samples = root().join("machines/samples");
    let sample = |name: &str| -> Vec<String> {
        let text = std::fs::read_to_string(samples.join(name)).unwrap();
        text.lines().map(str::to_owned).collect()
    };
    for file in std::fs::read_dir(&samples).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".cls") {
            continue;
        }
        let Some(reading) = all.remove(&name) else { panic!("nobody has read {name}") };
        assert!(reading.explained, "{name}: blocks without a word on them");
        let mut blocks = sample(&name);
        if let Some(like) = &reading.like {
            let read = sample(like);
            blocks.retain(|block| !read.contains(block));
        }
        let differs = blocks.iter().zip(&reading.quoted).position(|(block, read)| block != read);
        let at = differs.unwrap_or(blocks.len().min(reading.quoted.len()));
        let (block, read) = (blocks.get(at), reading.quoted.get(at));
        assert!(block == read, "{name}: the sample has {block:?}, and {read:?} was read");
    }
    let names: Vec<&String> = all.keys().collect();
    assert!(names.is_empty(), "there are no samples {names:?}");
}

/// Each row of the side effects names the tests that hold it, and these are there.
#[test]
fn every_side_effect_is_held_by_a_test() {
    let mut tests = std::collections::BTreeSet::new();
    for folder in ["crates/control/tests/all", "crates/toolpost/tests/all"] {
        for file in std::fs::read_dir(root().join(folder)).unwrap() {
            let Ok(text) = std::fs::read_to_string(file.unwrap().path()) else { continue };
            let named = text.split("#[test]\n").skip(1).filter_map(|test| {
                let (name, _) = test.strip_prefix("fn ")?.split_once('(')?;
                Some(name.to_owned())
            });
            tests.extend(named);
        }
    }
    let page = std::fs::read_to_string(root().join("docs/controls/side-effects.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| ") && !line.ends_with(" test |"));
    let mut count = 0;
    for row in rows {
        let names = row.trim_end_matches('|').rsplit('|').next().unwrap();
        let names: Vec<&str> = names.split('`').skip(1).step_by(2).collect();
        assert!(!names.is_empty(), "no test holds {row}");
        for name in names {
            assert!(tests.contains(name), "there is no test `{name}`: {row}");
        }
        count += 1;
    }
    assert!(count > 50, "{count} rows");
}
