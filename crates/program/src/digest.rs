//! Fingerprints of files, by which a report knows what it was made of.

use geom::ending::go_on;
use sha2::{Digest as _, Sha256};

/// Between so many bytes it asks whether its work was ended.
const AT_ONCE: usize = 1 << 16;

/// SHA-256 of texts, one after the other.
#[derive(Clone, Debug, Default)]
pub struct Digest(Sha256);

impl Digest {
    /// The digest of `texts`, in hexadecimal digits; of a single one that of `sha256sum`.
    pub fn of<'t>(texts: impl IntoIterator<Item = &'t [u8]>) -> String {
        let mut digest = Digest::default();
        let mut texts = texts.into_iter();
        if let Some(first) = texts.next() {
            digest.take(first);
        }
        texts.for_each(|text| digest.add(text));
        digest.finish()
    }

    /// Adds a text. Its length stands before it, so that what ends one text cannot begin the next.
    pub fn add(&mut self, text: &[u8]) {
        self.0.update((text.len() as u64).to_le_bytes());
        self.take(text);
    }

    fn take(&mut self, text: &[u8]) {
        for piece in text.chunks(AT_ONCE) {
            go_on();
            self.0.update(piece);
        }
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
    fn the_digest_of_many_pieces_is_that_of_the_whole_and_ends_with_its_work() {
        // FIPS 180-4, example of a long message: a million times "a".
        let expected = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
        let text = "a".repeat(1_000_000);
        assert_eq!(Digest::of([text.as_bytes()]), expected);
        let ended = geom::ending::Ended::default();
        let texts = std::iter::once(text.as_bytes()).cycle().inspect(|_| ended.end());
        assert_eq!(ended.run(|| Digest::of(texts)), None);
    }

    #[test]
    fn where_one_text_ends_and_the_next_begins_counts() {
        let digests = [["ab", "c", ""], ["a", "bc", ""], ["a", "b", "c"]]
            .map(|texts| Digest::of(texts.map(str::as_bytes)));
        assert!(digests[0] != digests[1] && digests[1] != digests[2], "{digests:?}");
    }
}
