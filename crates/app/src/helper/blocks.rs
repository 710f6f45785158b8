//! Bytes as blocks: a length of 4 octets, the sum (CRC-32) of all bytes up to the end of the block, and so many bytes. A block of no bytes is the end. Both numbers
//! are little-endian.

use crc32fast::Hasher;
use std::io::{self, Read, Write};

/// The most bytes of a block.
const MOST: usize = 1 << 16;

/// Before the bytes of a block.
const HEAD: usize = 8;

/// Writes blocks.
pub struct Writer<W> {
    to: W,
    sum: Hasher,
    /// The block that is begun, with room for its head.
    block: Vec<u8>,
}

impl<W: Write> Writer<W> {
    pub fn new(to: W) -> Writer<W> {
        let mut block = Vec::with_capacity(HEAD + MOST);
        block.resize(HEAD, 0);
        Writer { to, sum: Hasher::new(), block }
    }

    /// Writes the block that is begun, which may have no bytes.
    fn end_block(&mut self) -> io::Result<()> {
        let (head, bytes) = self.block.split_at_mut(HEAD);
        self.sum.update(bytes);
        head[..4].copy_from_slice(&(bytes.len() as u32).to_le_bytes());
        head[4..].copy_from_slice(&self.sum.clone().finalize().to_le_bytes());
        self.to.write_all(&self.block)?;
        self.block.truncate(HEAD);
        Ok(())
    }

    /// Says that this is all.
    pub fn finish(&mut self) -> io::Result<()> {
        self.flush()?;
        self.end_block()?;
        self.to.flush()
    }
}

impl<W: Write> Write for Writer<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.block.len() == HEAD + MOST {
            self.end_block()?;
        }
        let count = bytes.len().min(HEAD + MOST - self.block.len());
        self.block.extend_from_slice(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.block.len() > HEAD { self.end_block() } else { Ok(()) }
    }
}

/// Reads blocks, and gives no byte of one that is damaged.
pub struct Reader<R> {
    from: R,
    sum: Hasher,
    block: Vec<u8>,
    /// How many bytes of the block were given.
    given: usize,
    is_over: bool,
}

impl<R: Read> Reader<R> {
    pub fn new(from: R) -> Reader<R> {
        Reader { from, sum: Hasher::new(), block: Vec::new(), given: 0, is_over: false }
    }

    /// Reads a block, where the end was not read yet.
    fn next(&mut self) -> io::Result<()> {
        if self.is_over {
            return Ok(());
        }
        let mut head = [0; HEAD];
        self.from.read_exact(&mut head)?;
        let [a, b, c, d, sum @ ..] = head;
        let count = u32::from_le_bytes([a, b, c, d]) as usize;
        if count > MOST {
            return Err(io::ErrorKind::InvalidData.into());
        }
        self.given = 0;
        self.block.resize(count, 0);
        let read = self.from.read_exact(&mut self.block);
        self.sum.update(&self.block);
        let is_whole = self.sum.clone().finalize() == u32::from_le_bytes(sum);
        if read.is_err() || !is_whole {
            self.block.clear();
            return Err(read.err().unwrap_or_else(|| io::ErrorKind::InvalidData.into()));
        }
        self.is_over = count == 0;
        Ok(())
    }

    /// Checks that all was read.
    ///
    /// # Errors
    /// There is more, or the end is missing.
    pub fn finish(&mut self) -> io::Result<()> {
        if self.given == self.block.len() {
            self.next()?;
        }
        if self.is_over { Ok(()) } else { Err(io::ErrorKind::InvalidData.into()) }
    }
}

impl<R: Read> Read for Reader<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.given == self.block.len() {
            self.next()?;
        }
        let bytes = &self.block[self.given..];
        let count = bytes.len().min(to.len());
        to[..count].copy_from_slice(&bytes[..count]);
        self.given += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(parts: &[&[u8]]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut writer = Writer::new(&mut bytes);
        for part in parts {
            writer.write_all(part).unwrap();
        }
        writer.finish().unwrap();
        bytes
    }

    fn read(bytes: &[u8]) -> io::Result<Vec<u8>> {
        let (mut reader, mut all) = (Reader::new(bytes), Vec::new());
        reader.read_to_end(&mut all)?;
        reader.finish()?;
        Ok(all)
    }

    #[test]
    fn a_block_is_as_it_is_described() {
        // The check value of CRC-32/ISO-HDLC, which is that of the catalogue of CRCs.
        let sum = 0xCBF4_3926_u32.to_le_bytes();
        let end = [&[0; 4][..], &sum].concat();
        assert_eq!(
            written(&[b"1234", b"56789"]),
            [&[9, 0, 0, 0][..], &sum, b"123456789", &end].concat()
        );
        assert_eq!(written(&[]), [0; 8]);
    }

    #[test]
    fn what_is_written_is_read() {
        for count in [0, 1, MOST - 1, MOST, MOST + 1, 3 * MOST] {
            let bytes: Vec<u8> = (0..count).map(|i| (i.wrapping_mul(i) >> 7) as u8).collect();
            let (one, other) = bytes.split_at(count / 3);
            assert!(read(&written(&[one, other])).unwrap() == bytes, "{count}");
        }
    }

    #[test]
    fn nothing_is_given_of_a_damaged_block_and_an_end_is_no_end_before_its_time() {
        let bytes: Vec<u8> = (0..2 * MOST + 100).map(|i| (i.wrapping_mul(i) >> 5) as u8).collect();
        let whole = written(&[&bytes]);
        let blocks = [0, HEAD + MOST, 2 * (HEAD + MOST), whole.len() - HEAD];
        for end in (0..whole.len()).step_by(1009).chain(blocks) {
            assert!(read(&whole[..end]).is_err(), "{end}");
        }
        let places = (0..whole.len()).step_by(4001);
        for place in places.chain(blocks.into_iter().flat_map(|block| block..block + HEAD)) {
            for bit in [1, 0x80] {
                let mut damaged = whole.clone();
                damaged[place] ^= bit;
                let (mut reader, mut given) = (Reader::new(&*damaged), Vec::new());
                let read = reader.read_to_end(&mut given).and_then(|_| reader.finish());
                assert!(read.is_err(), "{place}");
                assert!(bytes.starts_with(&given) && given.len() <= place, "{place}");
                assert!(reader.block.capacity() <= MOST, "{place}");
            }
        }
        // A block less, or two that have changed places.
        let (first, second) = (&whole[..HEAD + MOST], &whole[HEAD + MOST..2 * (HEAD + MOST)]);
        let rest = &whole[2 * (HEAD + MOST)..];
        assert!(read(&[first, rest].concat()).is_err());
        assert!(read(&[second, first, rest].concat()).is_err());
        // More than was asked for.
        let mut reader = Reader::new(&*whole);
        reader.read_exact(&mut [0; 5]).unwrap();
        assert!(reader.finish().is_err());
    }
}
