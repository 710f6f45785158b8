//! Photographs, black and white pictures and depth maps.

use crate::common::k9;
use image::{DynamicImage, GrayImage, ImageFormat, Luma, LumaA, RgbImage};
use std::io::Cursor;
use toolpost_glass::cloud::{Point, distances, squared};
use toolpost_glass::job::{Made, Settings, make};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::Shape;
use toolpost_glass::order::Effort;
use toolpost_glass::picture::{self, Manner, Plane, Setting, light};

fn setting(manner: Manner) -> Setting {
    Setting { plane: Plane::Xz, width: None, manner, invert: false, sheets: (1, None) }
}

/// The bytes of a picture.
fn bytes(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A grey PNG whose pixels are these, row by row from above.
fn grey(width: u32, values: &[u8]) -> Vec<u8> {
    let height = values.len() as u32 / width;
    bytes(GrayImage::from_raw(width, height, values.to_vec()).unwrap(), ImageFormat::Png)
}

fn shape(bytes: &[u8], setting: Setting) -> Shape {
    Shape::Picture(picture::read(bytes, setting, "face.png").unwrap_or_else(|e| panic!("{e}")))
}

/// Engraves it in a block with 16 x 16 x 26 mm of room.
fn engraved(
    shape: Shape,
    change: impl Fn(&mut Settings),
) -> Result<Made, Vec<program::Diagnostic>> {
    let effort = Effort { rounds: 0, tries: 0, until: None };
    let mut settings = Settings { effort, ..crate::common::settings([20.0, 20.0, 30.0], 0) };
    change(&mut settings);
    let machine = Machine::read(library("glass-xyz-100hz").unwrap(), "").unwrap();
    make(vec![shape], &k9(), &machine, &settings)
}

fn cloud(shape: Shape) -> Vec<Point> {
    let made = engraved(shape, |_| ()).unwrap();
    let is_small = |found: &program::Diagnostic| found.rule == "small";
    assert!(made.proven && made.findings.iter().all(is_small), "{:?}", made.findings);
    assert_eq!(distances(&made.cloud, 130).too_close, 0);
    made.cloud
}

#[test]
fn the_density_of_dots_follows_the_light_of_a_grey_value() {
    // IEC 61966-2-1 at three values, by hand.
    for (value, expected) in [(10.0, 0.003_035), (137.0, 0.250_158), (188.0, 0.502_886)] {
        assert!((light(value / 255.0) - expected).abs() < 2e-6, "{}", light(value / 255.0));
    }
    let dots = |value: u8| cloud(shape(&grey(2, &[value; 4]), setting(Manner::Dither))).len();
    // 16 x 16 mm; a saturated random packing has 0.6966 points in a square of the spacing.
    let white = dots(255);
    let density = white as f64 * 0.13 * 0.13 / 256.0;
    assert!((0.65..0.71).contains(&density), "{density}");
    for (value, part) in [(188, 0.502_886), (137, 0.250_158), (10, 0.003_035)] {
        let expected = part * white as f64;
        assert!((dots(value) as f64 - expected).abs() <= 1.0, "{value}: {expected}");
    }
}

#[test]
fn dots_of_a_dark_grey_lie_far_apart_and_leave_no_holes() {
    let dots = cloud(shape(&grey(2, &[137; 4]), setting(Manner::Dither)));
    // A quarter of the points: a packing of twice the spacing would have as many. By chance some would be one spacing apart.
    let nearest = |a: &Point| {
        let others = dots.iter().filter(|b| *b != a);
        (others.map(|b| squared(*a, *b)).min().unwrap() as f64).sqrt()
    };
    let least = dots.iter().map(nearest).fold(f64::MAX, f64::min);
    assert!(least > 1.4 * 130.0, "{least}");
    let inside = |value: i32| (3_000..17_000).contains(&value);
    for x in (3_000..17_000).step_by(200) {
        for z in (8_000..22_000).step_by(200) {
            let gap = dots.iter().map(|dot| squared(*dot, [x, dot[1], z])).min().unwrap();
            assert!(!inside(x) || (gap as f64).sqrt() < 3.2 * 130.0, "{x} {z} {gap}");
        }
    }
}

#[test]
fn a_picture_stands_upright_in_its_plane() {
    // White at the upper left only.
    let corner = [255, 0, 0, 0, 0, 0, 0, 0];
    let picture = grey(4, &corner);
    for (plane, right, up, across) in
        [(Plane::Xz, 0, 2, 1), (Plane::Xy, 0, 1, 2), (Plane::Yz, 1, 2, 0)]
    {
        let setting = Setting { plane, ..setting(Manner::Dither) };
        let middle = [10_000, 10_000, 15_000];
        // 16 x 8 mm, as wide as the block has room; a pixel is 4 x 4 mm.
        for point in cloud(shape(&picture, setting)) {
            let at = |axis: usize| point[axis] - middle[axis];
            assert!((-8_000..=-3_900).contains(&at(right)), "{plane:?} {point:?}");
            assert!((-100..=4_000).contains(&at(up)) && at(across) == 0, "{plane:?} {point:?}");
        }
    }
}

#[test]
fn a_raster_has_a_point_in_each_bright_cell() {
    // 0.13 mm, 2 µm of depth that rounding takes, and one of the cells: 0.133 mm. Three columns and two rows.
    let picture = grey(3, &[255, 0, 128, 0, 200, 100]);
    let setting =
        |threshold| Setting { width: Some(0.399_001), ..setting(Manner::Raster(threshold)) };
    let mut points = cloud(shape(&picture, setting(0.5)));
    points.sort_unstable();
    let expected: Vec<Point> =
        vec![[9_867, 10_000, 15_067], [10_000, 10_000, 14_934], [10_133, 10_000, 15_067]];
    let off = |(a, b): (&Point, &Point)| (0..3).map(|i| (a[i] - b[i]).abs()).max().unwrap();
    assert_eq!(points.len(), 3, "{points:?}");
    assert!(points.iter().zip(&expected).all(|pair| off(pair) <= 1), "{points:?}");
    assert_eq!(cloud(shape(&picture, setting(0.9))).len(), 1);
    let inverted = Setting { invert: true, ..setting(0.5) };
    assert_eq!(cloud(shape(&picture, inverted)).len(), 3);
}

#[test]
fn sheets_stand_behind_each_other_as_far_apart_as_the_spacing_and_more() {
    let sheets = |distance| Setting { sheets: (3, distance), ..setting(Manner::Raster(0.5)) };
    let picture = grey(2, &[255; 4]);
    for plane in [Plane::Xz, Plane::Xy] {
        let points = cloud(shape(&picture, Setting { plane, ..sheets(None) }));
        // 16 mm / 0.133 mm: 120 cells.
        assert_eq!(points.len(), 3 * 120 * 120);
    }
    let found = engraved(shape(&picture, sheets(Some(0.1))), |_| ()).unwrap_err();
    assert_eq!(found[0].rule, "spacing");
}

#[test]
fn a_depth_map_is_a_surface_that_is_nearer_where_it_is_bright() {
    // Black on the left: nothing. Then from a quarter of white to white.
    let picture = grey(4, &[0, 64, 128, 255, 0, 64, 128, 255]);
    let points = cloud(shape(&picture, setting(Manner::Relief(4.0))));
    let at = |axis: usize| points.iter().map(move |point| point[axis]);
    // 3 mm of depth, (255 - 64) / 255 x 4 mm, in the middle of 20 mm: towards -Y.
    let deep = at(1).max().unwrap() - at(1).min().unwrap();
    assert!((deep - 2_996).abs() < 150, "{deep}");
    assert!((at(1).max().unwrap() + at(1).min().unwrap() - 20_000).abs() < 150);
    let rightmost = points.iter().max_by_key(|point| point[0]).unwrap();
    assert!(rightmost[0] > 15_250 && rightmost[1] < 8_700, "{rightmost:?}");
    // Two of three columns of 16 / 3 mm, in the middle of 20 mm.
    assert!((at(0).min().unwrap() - 4_667).abs() < 90 && points.len() > 3_000, "{}", points.len());
}

#[test]
fn photographs_are_read_as_png_jpeg_and_bmp_and_transparent_pixels_are_black() {
    let picture = RgbImage::from_pixel(8, 8, image::Rgb([255, 255, 255]));
    let white = cloud(shape(&grey(2, &[255; 4]), setting(Manner::Dither)));
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp] {
        let bytes = bytes(picture.clone(), format);
        assert_eq!(cloud(shape(&bytes, setting(Manner::Dither))).len(), white.len(), "{format:?}");
    }
    let clear = image::ImageBuffer::from_pixel(2, 2, LumaA([255u8, 0]));
    let clear = shape(&bytes(clear, ImageFormat::Png), setting(Manner::Dither));
    assert_eq!(engraved(clear, |_| ()).unwrap_err()[0].rule, "empty");
    let deep = image::ImageBuffer::from_pixel(2, 2, Luma([u16::MAX]));
    let deep = shape(&bytes(deep, ImageFormat::Png), setting(Manner::Dither));
    assert_eq!(cloud(deep).len(), white.len());
}

/// A PCX picture of 3 x 2 pixels: version 5, so many bits a plane and planes, four bytes a row and plane, the first colours of the
/// palette in the header, and packed rows.
fn pcx(bits: u8, planes: u8, colors: &[u8], packed: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; 128];
    bytes[..12].copy_from_slice(&[10, 5, 1, bits, 10, 0, 20, 0, 12, 0, 21, 0]);
    bytes[16..16 + colors.len()].copy_from_slice(colors);
    (bytes[65], bytes[66]) = (planes, 4);
    bytes.extend(packed);
    bytes
}

#[test]
fn pcx_pictures_are_read_in_all_their_depths() {
    // Above white, black, white; below black, black, white.
    let bright = |bytes: &[u8]| {
        let setting = Setting { width: Some(0.399_001), ..setting(Manner::Raster(0.5)) };
        let mut points = cloud(shape(bytes, setting));
        points.sort_unstable();
        points
    };
    let want = bright(&grey(3, &[255, 0, 255, 0, 0, 255]));
    assert_eq!(want.len(), 3);
    // One bit: 101, 001; a run of two bytes 0 after each first one, and one alone.
    assert_eq!(bright(&pcx(1, 1, &[], &[0xa0, 0xc3, 0, 0x20, 0xc3, 0])), want);
    // Four planes of a bit: colour 9 (planes 1 and 4) is white, 0 is black.
    let mut colors = [0; 48];
    colors[27..30].fill(255);
    let row = |bits: u8| [&[bits, 0xc3, 0][..], &[0xc8, 0], &[bits, 0xc3, 0]].concat();
    assert_eq!(bright(&pcx(1, 4, &colors, &[row(0xa0), row(0x20)].concat())), want);
    // Four bits: colours 9, 0 and 9, 0 in two bytes.
    assert_eq!(bright(&pcx(4, 1, &colors, &[0x90, 0x90, 0xc2, 0, 0, 0x90, 0xc2, 0])), want);
    // 256 colours at the end: number 200 is white. A run of three 0 goes on in the next row.
    let mut bytes = pcx(8, 1, &[], &[0xc1, 200, 0, 0xc1, 200, 0xc3, 0, 0xc1, 200, 0]);
    bytes.push(12);
    bytes.extend((0..256).flat_map(|i| [if i == 200 { 255u8 } else { 0 }; 3]));
    assert_eq!(bright(&bytes), want);
    // Red, green and blue, one plane after the other in each row: 255 is a run of one.
    let planes = |row: [u8; 3]| {
        let one = row.iter().flat_map(|&value| [0xc1, value]).chain([0]).collect::<Vec<u8>>();
        one.repeat(3)
    };
    let packed = [planes([255, 0, 255]), planes([0, 0, 255])].concat();
    assert_eq!(bright(&pcx(8, 3, &[], &packed)), want);
    let refused = |bytes: &[u8]| {
        picture::read(bytes, setting(Manner::Dither), "a.pcx").unwrap_err().rule.name()
    };
    assert_eq!(refused(&pcx(8, 3, &[], &packed[..20])), "image");
    assert_eq!(refused(&pcx(8, 1, &[], &[0xc8, 0])), "image");
    assert_eq!(refused(&pcx(8, 4, &[], &packed)), "image");
    assert_eq!(refused(&pcx(1, 1, &[], &[])[..100]), "image");
    let mut large = pcx(8, 3, &[], &packed);
    large[8..12].fill(255);
    assert_eq!(refused(&large), "too-large");
    large[8..12].fill(0);
    assert_eq!(refused(&large), "empty");
}

#[test]
fn pictures_that_cannot_be_are_refused() {
    let good = grey(40, &(0..1600).map(|i| (i * 37 % 251) as u8).collect::<Vec<u8>>());
    let refused = |bytes: &[u8]| {
        let found = picture::read(bytes, setting(Manner::Dither), "face.png").unwrap_err();
        assert!(found.file == "face.png" && !found.help.is_empty(), "{found}");
        found.rule.name()
    };
    assert_eq!(refused(b""), "image");
    assert_eq!(refused(b"no picture"), "image");
    assert_eq!(refused(&good[..good.len() / 2]), "image");
    // 100,000 x 100,000 pixels are stated in the head, whose sum is that of these bytes.
    let mut huge = good.clone();
    huge[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
    let sum = crc(&huge[12..29]);
    huge[29..33].copy_from_slice(&sum.to_be_bytes());
    assert_eq!(refused(&huge), "too-large");
}

/// The sum of a chunk of PNG (ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    let bit = |sum: u32, _| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 };
    !bytes.iter().fold(!0u32, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), bit))
}
