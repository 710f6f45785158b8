//! Pictures: photographs as dots, black and white pictures as rows of points, depth maps as reliefs.
//!
//! Dots are a subset of the points that [`crate::sample`] puts on the sheet of a picture, so that their distance holds exactly.
//! Each of those points has a rank: the first ones by rank are as far apart as that many points can be. A point is kept where
//! the picture is brighter there than its rank, so that the density of dots follows the light of the picture, and dots never
//! gather by chance. In the glass a point is bright: white is dense, black is empty.

use crate::cloud::{self, Point};
use crate::mesh::{Fault, Mesh};
use crate::pcx;
use crate::sample::{self, Apart, Dice, SHRINK};
use geom::ending::{self, Does, Step, go_on};
use glam::{DVec2, DVec3};
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader, ImageResult, Limits};
use program::{Diagnostic, Rule};
use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};

/// The plane in which a picture stands, and from where it is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// Upright, seen from the front.
    Xz,
    /// Lying, seen from above.
    Xy,
    /// Upright, seen from the right.
    Yz,
}

impl Plane {
    /// To the right in the picture, up in it, and towards who looks at it.
    pub fn directions(self) -> [DVec3; 3] {
        match self {
            Plane::Xz => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
            Plane::Xy => [DVec3::X, DVec3::Y, DVec3::Z],
            Plane::Yz => [DVec3::Y, DVec3::Z, DVec3::X],
        }
    }
}

/// What becomes of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Manner {
    /// Dots, dense where the picture is bright.
    Dither,
    /// A point in each cell of a square grid whose mean brightness is at least this part of white.
    Raster(f64),
    /// A surface that is so many mm nearer to who looks at it where the picture is white; none where it is black.
    Relief(f64),
}

/// How a picture stands.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// In which plane.
    pub plane: Plane,
    /// How wide it is, mm; without, as large as its room.
    pub width: Option<f64>,
    /// What becomes of it.
    pub manner: Manner,
    /// Whether black is white.
    pub invert: bool,
    /// How often it stands behind itself, with the distance, mm (without, the smallest that keeps the spacing).
    pub sheets: (u32, Option<f64>),
}

/// The most pixels of a picture.
const MOST_PIXELS: u64 = 64_000_000;

/// To decode more pixels than this may take longer than 10 ms, in which a decoder does not ask whether it goes on.
const LONG: u64 = 1 << 19;

/// The largest file of a picture that is given to a helper, bytes.
const MOST_BYTES: u64 = 1 << 30;

/// So many pixels become grey at once.
const BAND: usize = 1 << 18;

/// Up to this part of white a depth map is black: what JPEG makes of it is no exact 0.
const BLACK: f64 = 0.02;

/// The most sheets of a picture.
pub const MOST_SHEETS: u32 = 100;

/// A grey picture, row by row from above.
#[derive(Clone, Debug)]
pub struct Picture {
    width: usize,
    height: usize,
    /// Its grey values, from 0 to 65535, as they are coded; where it is transparent, 0.
    values: Vec<u16>,
    /// How it stands.
    pub setting: Setting,
}

/// Reads the bytes of the picture `file`: PNG, JPEG, BMP or PCX, upright as its camera says.
///
/// # Errors
/// It is none, is cut off, or has more pixels than are read.
pub fn read(bytes: &[u8], setting: Setting, file: &str) -> Result<Picture, Box<Diagnostic>> {
    decoded(bytes, setting).map_err(|fault| fault.diagnostic(file))
}

/// What is said of a picture beyond the limit.
pub(crate) fn too_many(width: u64, height: u64) -> Fault {
    let message = format!(
        "{width} x {height} pixels are more than the {} million that are read",
        MOST_PIXELS / 1_000_000
    );
    Fault::new(Rule::TooLarge, message)
}

/// The bytes of a picture, of which a decoder gets a few at a time, so that it ends in the middle where the work was ended.
struct Asked<'b>(Cursor<&'b [u8]>);

/// So many bytes: packed as tightly as can be they are some million pixels.
const FEW_BYTES: usize = 1024;

impl Read for Asked<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        go_on();
        self.0.read(to)
    }
}

impl BufRead for Asked<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        go_on();
        let all = self.0.fill_buf()?;
        Ok(&all[..all.len().min(FEW_BYTES)])
    }

    fn consume(&mut self, count: usize) {
        self.0.consume(count);
    }
}

impl Seek for Asked<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// A decoder of a picture of one of the forms that the crate `image` reads.
fn decoder(bytes: &[u8]) -> ImageResult<impl ImageDecoder> {
    let mut reader = ImageReader::new(Asked(Cursor::new(bytes))).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(8 * MOST_PIXELS);
    reader.limits(limits);
    reader.into_decoder()
}

/// The picture of a decoder, upright.
fn upright(mut decoder: impl ImageDecoder) -> ImageResult<DynamicImage> {
    let orientation = decoder.orientation()?;
    let mut picture = DynamicImage::from_decoder(decoder)?;
    picture.apply_orientation(orientation);
    Ok(picture)
}

/// Width, height and the values, row by row from above: from 0 to 65535, as they are coded; where the picture is transparent, 0.
type Grey = (usize, usize, Vec<u16>);

/// The values of a picture, or those of its negative.
fn grey(picture: &DynamicImage, invert: bool) -> Grey {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let value = |pixel: &image::LumaA<u16>| {
        let image::LumaA([grey, alpha]) = *pixel;
        let grey = if invert { u16::MAX - grey } else { grey };
        (u32::from(grey) * u32::from(alpha) / u32::from(u16::MAX)) as u16
    };
    // Some rows at a time: no copy of all of it, and an end between them.
    let rows = BAND.div_ceil(width.max(1));
    let mut values = Vec::with_capacity(width * height);
    for first in (0..height).step_by(rows) {
        go_on();
        let rows = rows.min(height - first) as u32;
        let band = picture.crop_imm(0, first as u32, width as u32, rows);
        values.extend(band.into_luma_alpha16().pixels().map(value));
    }
    (width, height, values)
}

fn decoded(bytes: &[u8], setting: Setting) -> Result<Picture, Fault> {
    let (width, height, values) = if pcx::is_pcx(bytes) {
        grey(&pcx::read(bytes, MOST_PIXELS)?, setting.invert)
    } else {
        let wrong = |error: ImageError| Fault::new(Rule::Image, error.to_string());
        let decoder = decoder(bytes).map_err(wrong)?;
        let (width, height) = decoder.dimensions();
        let pixels = u64::from(width) * u64::from(height);
        if pixels > MOST_PIXELS {
            return Err(too_many(width.into(), height.into()));
        }
        let helped = if pixels > LONG { helped(bytes, setting.invert) } else { None };
        let here = || Ok(grey(&upright(decoder)?, setting.invert));
        let decoded =
            helped.unwrap_or_else(|| here().map_err(|wrong: ImageError| wrong.to_string()));
        decoded.map_err(|why| Fault::new(Rule::Image, why))?
    };
    if values.is_empty() {
        return Err(Fault::new(Rule::Empty, "has no pixel"));
    }
    Ok(Picture { width, height, values, setting })
}

/// The decoding of pictures, for a helper: its name and what it does. Asked is by a byte whether the negative is, and by the bytes of the file. The answer is
/// a byte, and 1 is followed by width and height (4 bytes each) and the grey values (2 bytes each), little-endian; 0 by why there are none.
pub const STEP: (&str, Step) = ("picture", step);

/// What the helper of this work decodes, or why it cannot be decoded; none where nobody helps.
fn helped(bytes: &[u8], invert: bool) -> Option<Result<Grey, String>> {
    ending::helped(STEP.0, || [&[u8::from(invert)], bytes].concat(), answer)
}

/// Reads what is asked, and answers what will do it.
fn step(from: &mut dyn Read) -> io::Result<Does> {
    let mut bytes = Vec::new();
    from.take(MOST_BYTES).read_to_end(&mut bytes)?;
    Ok(Box::new(move |to| {
        let (invert, bytes) = bytes.split_first().ok_or(io::ErrorKind::InvalidData)?;
        let decoded = decoder(bytes).and_then(|decoder| Ok(grey(&upright(decoder)?, *invert != 0)));
        match decoded {
            Ok((width, height, values)) => {
                to.write_all(&[1])?;
                to.write_all(&(width as u32).to_le_bytes())?;
                to.write_all(&(height as u32).to_le_bytes())?;
                values.iter().try_for_each(|value| to.write_all(&value.to_le_bytes()))
            }
            Err(why) => {
                to.write_all(&[0])?;
                to.write_all(why.to_string().as_bytes())
            }
        }
    }))
}

/// Reads the answer.
fn answer(from: &mut dyn Read) -> io::Result<Result<Grey, String>> {
    let mut is_decoded = [0];
    from.read_exact(&mut is_decoded)?;
    if is_decoded == [0] {
        let mut why = String::new();
        from.take(MOST_BYTES).read_to_string(&mut why)?;
        return Ok(Err(why));
    }
    let mut side = || {
        let mut bytes = [0; 4];
        from.read_exact(&mut bytes).map(|()| u32::from_le_bytes(bytes))
    };
    let (width, height) = (side()?, side()?);
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MOST_PIXELS {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let mut values = Vec::new();
    let mut band = vec![0; 2 * BAND];
    let mut left = pixels as usize;
    while left > 0 {
        let bytes = &mut band[..2 * left.min(BAND)];
        from.read_exact(bytes)?;
        let value = |pair: &[u8]| u16::from_le_bytes([pair[0], pair[1]]);
        values.extend(bytes.chunks_exact(2).map(value));
        left -= left.min(BAND);
    }
    Ok(Ok((width as usize, height as usize, values)))
}

/// Reads the bytes of a texture: PNG, JPEG, BMP or PCX.
pub(crate) fn texture(bytes: &[u8]) -> Result<Picture, Fault> {
    let (manner, sheets) = (Manner::Dither, (1, None));
    decoded(bytes, Setting { plane: Plane::Xz, width: None, manner, invert: false, sheets })
}

/// The light of a grey value of an sRGB picture, both from 0 to 1 (IEC 61966-2-1).
pub fn light(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Where a picture stands: a corner, and how far it goes to the right and up from there, mm.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// The lower left corner.
    pub corner: DVec3,
    /// To the lower right corner.
    pub right: DVec3,
    /// To the upper left corner.
    pub up: DVec3,
}

impl Picture {
    /// Its sides where it is as large as fits into `room` (mm along X, Y and Z), or has the width that is set, mm.
    fn size(&self, room: DVec3) -> (f64, f64) {
        let [right, up, _] = self.setting.plane.directions();
        let ratio = self.height as f64 / self.width as f64;
        let fitting = room.dot(right).min(room.dot(up) / ratio);
        let width = self.setting.width.unwrap_or(fitting.max(0.0));
        (width, width * ratio)
    }

    /// The sheets on which it stands, from the front; a relief has none. `room` (mm) is that within the margins of the block.
    pub fn sheets(&self, room: DVec3, apart: Apart) -> Vec<Sheet> {
        let [right, up, towards] = self.setting.plane.directions();
        let (width, height) = self.size(room);
        let (count, distance) = self.setting.sheets;
        let behind = distance.unwrap_or(apart.rounded());
        let sheet = |number: u32| Sheet {
            corner: towards * (-f64::from(number) * behind),
            right: right * width,
            up: up * height,
        };
        let is_relief = matches!(self.setting.manner, Manner::Relief(_));
        (0..if is_relief { 0 } else { count }).map(sheet).collect()
    }

    /// The points on a sheet; another `seed` gives other ones.
    pub fn points(&self, sheet: &Sheet, apart: Apart, seed: u64) -> Vec<Point> {
        match self.setting.manner {
            Manner::Dither => self.dots(sheet, apart, seed),
            Manner::Raster(threshold) => self.raster(sheet, apart, threshold),
            Manner::Relief(_) => Vec::new(),
        }
    }

    /// The points of a saturated sheet whose rank is below the light of the picture.
    fn dots(&self, sheet: &Sheet, apart: Apart, seed: u64) -> Vec<Point> {
        let Sheet { corner, right, up } = *sheet;
        let vertices = vec![corner, corner + right, corner + right + up, corner + up];
        let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let points = sample::surface(&mesh, apart, seed);
        let sides = DVec2::new(right.length(), up.length()) * 1e3;
        let flat = |point: &Point| DVec2::from(sheet.seen(cloud::place(*point))) * sides;
        let flat: Vec<DVec2> = points.iter().map(flat).collect();
        let ranked = ranked(&flat, f64::from(apart.spacing), seed);
        let count = ranked.len() as f64;
        // Half a pixel on each side of the place, so that a fine grain is not sampled by chance.
        let bright = |(rank, &i): (usize, &u32)| {
            let (u, v) = sheet.seen(cloud::place(points[i as usize]));
            let reach = 0.5 * f64::from(apart.spacing) * 1e-3;
            let (du, dv) = (reach / right.length(), reach / up.length());
            let light = light(self.mean([u - du, v - dv], [u + du, v + dv]));
            (rank as f64 + 0.5 < light * count).then(|| points[i as usize])
        };
        ranked.iter().enumerate().filter_map(bright).collect()
    }

    /// A point in the middle of each cell, as large as the spacing, whose mean value reaches the threshold.
    fn raster(&self, sheet: &Sheet, apart: Apart, threshold: f64) -> Vec<Point> {
        let side = apart.rounded();
        let (width, height) = (sheet.right.length(), sheet.up.length());
        let (columns, rows) = ((width / side).floor() as u32, (height / side).floor() as u32);
        let mut points = Vec::new();
        for row in 0..rows {
            for column in 0..columns {
                let from = [f64::from(column) * side / width, f64::from(row) * side / height];
                let to = [from[0] + side / width, from[1] + side / height];
                if self.mean(from, to) >= threshold {
                    let (u, v) = (0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]));
                    points.extend(cloud::point(sheet.corner + sheet.right * u + sheet.up * v));
                }
            }
        }
        points
    }

    /// How many pixels it has.
    pub(crate) fn pixels(&self) -> usize {
        self.values.len()
    }

    /// The value, from 0 to 1, of the pixel at a place, parts of the width from the left and of the height from below; the picture
    /// repeats on all sides.
    pub(crate) fn repeated(&self, [u, v]: [f64; 2]) -> f64 {
        let number = |part: f64, count: usize| {
            // The far edge belongs to the last pixel, not to the first one of the next picture.
            let within = if part > 0.0 { part - part.ceil() + 1.0 } else { part - part.floor() };
            ((within * count as f64) as usize).min(count - 1)
        };
        let (column, row) = (number(u, self.width), number(1.0 - v, self.height));
        f64::from(self.values[row * self.width + column]) / f64::from(u16::MAX)
    }

    /// The mean value, from 0 to 1, between two places of the sheet; these are parts of its width from the left and of its height
    /// from below.
    fn mean(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        // The pixels whose middles lie between, or else the one that holds the middle.
        let span = |low: f64, high: f64, count: usize| {
            let [first, last] = [low, high]
                .map(|part| (part * count as f64 - 0.5).ceil().clamp(0.0, count as f64) as usize);
            let middle = (0.5 * (low + high)).clamp(0.0, 1.0) * count as f64;
            let middle = (middle as usize).min(count - 1);
            if first < last { first..last } else { middle..middle + 1 }
        };
        let columns = span(from[0], to[0], self.width);
        let rows = span(1.0 - to[1], 1.0 - from[1], self.height);
        let count = (columns.len() * rows.len()) as f64;
        let row = |row: usize| -> u64 {
            go_on();
            let start = row * self.width;
            self.values[start + columns.start..start + columns.end]
                .iter()
                .map(|&v| u64::from(v))
                .sum()
        };
        let sum: u64 = rows.map(row).sum();
        sum as f64 / (count * f64::from(u16::MAX))
    }

    /// The surface of a depth map, mm; of other pictures nothing. Its facets are at least half a spacing wide.
    pub fn relief(&self, room: DVec3, apart: Apart) -> Mesh {
        let spacing = f64::from(apart.spacing) * 1e-3;
        let Manner::Relief(depth) = self.setting.manner else { return Mesh::default() };
        let [right, up, towards] = self.setting.plane.directions();
        let (width, height) = self.size(room);
        let nodes = |length: f64, pixels: usize| {
            let most = (2.0 * length / spacing).ceil().clamp(2.0, 10_000.0) as usize;
            most.min(pixels.max(2))
        };
        let (columns, rows) = (nodes(width, self.width), nodes(height, self.height));
        let mut mesh = Mesh::default();
        // The numbers of the nodes that are not black.
        let mut numbers: Vec<Option<u32>> = Vec::with_capacity(columns * rows);
        // The nodes are the middles of cells, moved apart so that the outer ones lie on the edges of the sheet.
        let span =
            |i: usize, count: usize| [i as f64 / count as f64, (i + 1) as f64 / count as f64];
        let part = |i: usize, count: usize| i as f64 / (count - 1) as f64;
        for row in 0..rows {
            for column in 0..columns {
                let ([left, end], [low, high]) = (span(column, columns), span(row, rows));
                let value = self.mean([left, low], [end, high]);
                if value <= BLACK {
                    numbers.push(None);
                    continue;
                }
                numbers.push(Some(mesh.vertices.len() as u32));
                mesh.vertices.push(
                    right * (part(column, columns) * width)
                        + up * (part(row, rows) * height)
                        + towards * (value * depth),
                );
            }
        }
        let number = |row: usize, column: usize| numbers[row * columns + column];
        for row in 0..rows - 1 {
            go_on();
            for column in 0..columns - 1 {
                let [a, b] = [number(row, column), number(row, column + 1)];
                let [c, d] = [number(row + 1, column + 1), number(row + 1, column)];
                if let (Some(a), Some(b), Some(c), Some(d)) = (a, b, c, d) {
                    mesh.triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        mesh
    }
}

impl Sheet {
    /// The sheet with these corners: those of [`Sheet::corners`], moved as one; four at least.
    pub fn new(corners: &[DVec3]) -> Sheet {
        Sheet { corner: corners[0], right: corners[1] - corners[0], up: corners[2] - corners[0] }
    }

    /// Its four corners: lower left, lower right, upper left, upper right.
    pub fn corners(&self) -> [DVec3; 4] {
        let Sheet { corner, right, up } = *self;
        [corner, corner + right, corner + up, corner + right + up]
    }

    /// Its surface, mm².
    pub fn area(&self) -> f64 {
        self.right.length() * self.up.length()
    }

    /// Which part of the sheet's width and height a place is from its corner.
    fn seen(&self, place: DVec3) -> (f64, f64) {
        let from = place - self.corner;
        let part = |side: DVec3| from.dot(side) / side.length_squared();
        (part(self.right), part(self.up))
    }
}

/// No number of a place.
const NONE: u32 = u32::MAX;

/// The numbers of `places` on a sheet (µm), which are at least `spacing` apart, in an order in which the first ones always lie as far
/// apart as that many can: those that are farther from all before them than a distance that shrinks turn by turn.
fn ranked(places: &[DVec2], spacing: f64, seed: u64) -> Vec<u32> {
    let mut waiting: Vec<u32> = (0..places.len() as u32).collect();
    Dice(seed).shuffle(&mut waiting);
    let mut ranked = Vec::with_capacity(places.len());
    let most = places.iter().fold(DVec2::ZERO, |most, place| most.max(*place));
    let mut distance = spacing * (places.len() as f64).sqrt().max(1.0);
    while !waiting.is_empty() && distance > spacing {
        distance = (distance * SHRINK).max(spacing);
        let mut near = Near::new(places, most, distance);
        for &i in &ranked {
            go_on();
            near.add(i);
        }
        waiting.retain(|&i| {
            go_on();
            let waits = near.is_near(i);
            if !waits {
                near.add(i);
                ranked.push(i);
            }
            waits
        });
    }
    ranked.extend(waiting);
    ranked
}

/// Places in squares whose side is a distance.
struct Near<'p> {
    places: &'p [DVec2],
    distance: f64,
    columns: usize,
    rows: usize,
    /// The last place of each square, and of each place the one before it in its square.
    last: Vec<u32>,
    before: Vec<u32>,
}

impl<'p> Near<'p> {
    fn new(places: &'p [DVec2], most: DVec2, distance: f64) -> Near<'p> {
        let count = |length: f64| (length / distance).floor() as usize + 1;
        let (columns, rows) = (count(most.x), count(most.y));
        let (last, before) = (vec![NONE; columns * rows], vec![NONE; places.len()]);
        Near { places, distance, columns, rows, last, before }
    }

    fn square(&self, i: u32) -> (usize, usize) {
        let place = (self.places[i as usize] / self.distance).floor();
        // Rounding may put a place some µm beyond the edge.
        let within = |value: f64, count: usize| (value.max(0.0) as usize).min(count - 1);
        (within(place.x, self.columns), within(place.y, self.rows))
    }

    fn add(&mut self, i: u32) {
        let (column, row) = self.square(i);
        let last = &mut self.last[row * self.columns + column];
        self.before[i as usize] = std::mem::replace(last, i);
    }

    /// Whether a place that was added is nearer than the distance.
    fn is_near(&self, i: u32) -> bool {
        let (column, row) = self.square(i);
        let here = self.places[i as usize];
        let least = self.distance * self.distance;
        let around = |at: usize, count: usize| at.saturating_sub(1)..=(at + 1).min(count - 1);
        around(row, self.rows).any(|row| {
            around(column, self.columns).any(|column| {
                let mut at = self.last[row * self.columns + column];
                while at != NONE {
                    if self.places[at as usize].distance_squared(here) < least {
                        return true;
                    }
                    at = self.before[at as usize];
                }
                false
            })
        })
    }
}
