//! How large a document of FreeCAD's is once it is unpacked. FreeCAD reads whatever a small file unpacks to, for minutes
//! and into gigabytes; so the file is unpacked here before, and what comes out only counted.

use flate2::{Decompress, FlushDecompress, Status};
use memchr::memmem;
use program::{Diagnostic, Rule};

/// A document of this size, bytes, is read however small its file is.
const ENOUGH: u64 = 32 << 20;

/// A document may be so many times as large as its file: text of CAD systems packs to a fifth to a twentieth.
const MOST_TIMES: u64 = 40;

/// Refuses a document that unpacks to far more than its file holds.
///
/// # Errors
/// `document-size`
pub fn check(file: &[u8]) -> Result<(), Box<Diagnostic>> {
    let most = ENOUGH.max(MOST_TIMES.saturating_mul(file.len() as u64));
    if listed(file) <= most && unpacked(file, most) <= most {
        return Ok(());
    }
    let message = format!(
        "a document of {} KiB that unpacks to more than {} MiB: this is no drawing of FreeCAD's",
        file.len() >> 10,
        most >> 20
    );
    let help = "open it in FreeCAD and save it again, or post from FreeCAD's window, with the post `toolpost`";
    Err(Diagnostic::error(Rule::DocumentSize, message).help(help).into())
}

/// A number of the archive, least byte first; 0 beyond its end.
fn number(bytes: &[u8], at: usize, length: usize) -> u64 {
    let field = bytes.get(at..).and_then(|rest| rest.get(..length)).unwrap_or_default();
    field.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// The sizes of all entries, as the directory at the end of the archive gives them, bytes.
fn listed(file: &[u8]) -> u64 {
    let Some(end) = memmem::rfind(file, b"PK\x05\x06") else { return 0 };
    let mut at = number(file, end + 16, 4) as usize;
    let mut size = 0u64;
    while file.get(at..).is_some_and(|rest| rest.starts_with(b"PK\x01\x02")) {
        size = size.saturating_add(number(file, at + 24, 4));
        at +=
            46 + [28, 30, 32].iter().map(|part| number(file, at + part, 2) as usize).sum::<usize>();
    }
    size
}

/// What the entries hold, one behind the other, counted up to a little more than `most` bytes. Their own sizes are not
/// asked for: they may be wrong.
fn unpacked(file: &[u8], most: u64) -> u64 {
    let (mut at, mut size) = (0, 0u64);
    while let Some(entry) = memmem::find(&file[at..], b"PK\x03\x04").map(|found| at + found) {
        let names = (number(file, entry + 26, 2) + number(file, entry + 28, 2)) as usize;
        at = (entry + 30 + names).min(file.len());
        if number(file, entry + 8, 2) == DEFLATED {
            let (read, made) = inflated(&file[at..], most.saturating_sub(size));
            (at, size) = (at + read, size.saturating_add(made));
        }
        if size > most {
            break;
        }
    }
    size
}

/// The method of packing that archives use.
const DEFLATED: u64 = 8;

/// How many bytes of `packed` are one stream, and how many it unpacks to, a little more than `most` at the most.
fn inflated(packed: &[u8], most: u64) -> (usize, u64) {
    let mut inflate = Decompress::new(false);
    let mut buffer = vec![0; 1 << 16];
    loop {
        let (read, made) = (inflate.total_in(), inflate.total_out());
        let rest = &packed[read as usize..];
        let status = inflate.decompress(rest, &mut buffer, FlushDecompress::None);
        let is_stuck = (read, made) == (inflate.total_in(), inflate.total_out());
        if !matches!(status, Ok(Status::Ok)) || is_stuck || inflate.total_out() > most {
            return (inflate.total_in() as usize, inflate.total_out());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::DeflateEncoder;
    use std::io::Write;

    /// An archive with one entry of so many equal bytes, in whose own header `said` stands as its size.
    fn archive(size: usize, said: u32) -> Vec<u8> {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        for _ in 0..size >> 10 {
            encoder.write_all(&[b' '; 1 << 10]).unwrap();
        }
        let packed = encoder.finish().unwrap();
        let mut file = b"PK\x03\x04\x14\0\0\0\x08\0".to_vec();
        file.extend([0; 8]);
        file.extend((packed.len() as u32).to_le_bytes());
        file.extend(said.to_le_bytes());
        file.extend([1, 0, 0, 0, b'x']);
        file.extend(packed);
        let directory = file.len() as u32;
        file.extend(b"PK\x01\x02");
        file.extend([0; 20]);
        file.extend(said.to_le_bytes());
        file.extend([0; 18]);
        file.extend(b"PK\x05\x06");
        file.extend([0; 12]);
        file.extend(directory.to_le_bytes());
        file.extend([0; 2]);
        file
    }

    #[test]
    fn a_document_is_refused_by_what_it_unpacks_to() {
        assert!(check(b"a document").is_ok());
        assert!(check(&archive(20 << 20, 20 << 20)).is_ok());
        for said in [40 << 20, 1] {
            let found = check(&archive(40 << 20, said)).unwrap_err();
            assert_eq!(found.rule, "document-size", "{found}");
        }
        // What its directory says alone.
        assert!(check(&archive(1 << 10, u32::MAX)).is_err());
    }

    #[test]
    fn what_is_cut_off_anywhere_is_counted_as_far_as_it_goes() {
        let whole = archive(1 << 20, 1 << 20);
        for length in 0..whole.len() {
            assert!(check(&whole[..length]).is_ok(), "{length}");
        }
    }
}
