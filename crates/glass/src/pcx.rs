//! PCX pictures (ZSoft, *PCX Technical Reference Manual*, version 5): run-length packed rows of one plane or several.

use crate::mesh::Fault;
use geom::ending::go_on;
use image::{DynamicImage, RgbImage};
use program::Rule;

/// The header.
const HEADER: usize = 128;

/// A palette of 256 colours at the end of the file: its mark, and three bytes each.
const PALETTE: usize = 1 + 3 * 256;

/// Whether the bytes are those of a PCX picture: its mark, a version that there is, and packed rows.
pub(crate) fn is_pcx(bytes: &[u8]) -> bool {
    matches!(bytes, [10, 0 | 2..=5, 1, ..])
}

/// The pixels of a picture of at most `most` of them.
pub(crate) fn read(bytes: &[u8], most: u64) -> Result<DynamicImage, Fault> {
    let cut_off = || Fault::new(Rule::Image, "the PCX picture is cut off");
    let header = bytes.get(..HEADER).ok_or_else(cut_off)?;
    let word = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
    let [left, top, right, bottom] = [4, 6, 8, 10].map(word);
    let (version, bits, planes, wide) = (header[1], header[3], usize::from(header[65]), word(66));
    if right < left || bottom < top {
        return Err(Fault::new(Rule::Empty, "has no pixel"));
    }
    let (width, height) = (right - left + 1, bottom - top + 1);
    if (width * height) as u64 > most {
        return Err(super::picture::too_many(width as u64, height as u64));
    }
    let colors = &header[16..64];
    let at_end = bytes.len().checked_sub(PALETTE).filter(|at| *at >= HEADER);
    let of_256 = at_end.map(|at| &bytes[at..]).filter(|palette| palette[0] == 12);
    // What the value of a pixel, the bits of its planes from the first, is.
    let palette = match (bits, planes) {
        (1, 1) => &[0, 0, 0, 255, 255, 255][..],
        (1, 2..=4) | (2 | 4, 1) if version != 3 => colors,
        (8, 1) => match of_256 {
            Some(palette) if version == 5 => &palette[1..],
            _ => return Err(Fault::new(Rule::Image, "the PCX picture has no palette")),
        },
        (8, 3) => &[],
        _ => {
            let message =
                format!("PCX of {planes} planes of {bits} bits, version {version}, is not read");
            return Err(Fault::new(Rule::Image, message));
        }
    };
    if wide * 8 < width * usize::from(bits) {
        return Err(Fault::new(Rule::Image, "the rows of the PCX picture are too short"));
    }
    let end = if bits == 8 && planes == 1 { at_end.unwrap_or(HEADER) } else { bytes.len() };
    let mut packed = bytes[HEADER..end].iter().copied();
    let mut row = Vec::with_capacity(wide * planes);
    let mut pixels = Vec::with_capacity(3 * width * height);
    // A run may go on in the next row.
    let mut run = (0, 0);
    for _ in 0..height {
        go_on();
        row.clear();
        while row.len() < wide * planes {
            if run.0 == 0 {
                let byte = packed.next().ok_or_else(cut_off)?;
                run = match byte {
                    0xc0.. => (usize::from(byte & 0x3f), packed.next().ok_or_else(cut_off)?),
                    _ => (1, byte),
                };
            }
            let count = run.0.min(wide * planes - row.len());
            row.resize(row.len() + count, run.1);
            run.0 -= count;
        }
        for x in 0..width {
            if palette.is_empty() {
                pixels.extend([0, wide, 2 * wide].map(|plane| row[plane + x]));
                continue;
            }
            let bit = x * usize::from(bits);
            let own = |plane: usize| {
                let byte = row[plane * wide + bit / 8];
                let shift = 8 - usize::from(bits) - bit % 8;
                usize::from(byte >> shift) & ((1 << bits) - 1)
            };
            let value = (0..planes).fold(0, |value, plane| value | own(plane) << plane);
            pixels.extend(&palette[3 * value..3 * value + 3]);
        }
    }
    let picture = RgbImage::from_raw(width as u32, height as u32, pixels);
    picture.map(DynamicImage::ImageRgb8).ok_or_else(cut_off)
}
