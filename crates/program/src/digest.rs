//! Fingerprints of files, by which a report knows what it was made of.

use sha2::{Digest as _, Sha256};

/// SHA-256 of texts, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Digest(Sha256);

impl Digest {
    /// The digest of `texts`, in hexadecimal digits; of a single one that of `sha256sum`.
    pub fn of<'t>(texts: impl IntoIterator<Item = &'t [u8]>) -> String {
        let mut digest = Digest::default();
        let mut texts = texts.into_iter();
        if let Some(first) = texts.next() {
            digest.0.update(first);
        }
        texts.for_each(|text| digest.add(text));
        digest.finish()
    }

    /// Adds a text. Its length stands before it, so that what ends one text cannot begin the next.
    pub fn add(&mut self, text: &[u8]) {
        self.0.update((text.len() as u64).to_le_bytes());
        self.0.update(text);
    }

    /// The digest of all texts, in hexadecimal digits.
    pub fn finish(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_of_one_text_is_its_sha_256() {
        // FIPS 180-4, example of one block: "abc".
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Digest::of([&b"abc"[..]]), expected);
    }

    #[test]
    fn where_one_text_ends_and_the_next_begins_counts() {
        let digests = [["ab", "c", ""], ["a", "bc", ""], ["a", "b", "c"]]
            .map(|texts| Digest::of(texts.map(str::as_bytes)));
        assert!(digests[0] != digests[1] && digests[1] != digests[2], "{digests:?}");
    }
}
