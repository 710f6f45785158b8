//! Long steps end in their middle where the work was ended: each of these asks, or it would be done all the same.

use crate::bodies::sphere;
use geom::ending::Ended;
use glam::DVec3;
use image::{DynamicImage, GrayImage, ImageFormat};
use std::io::Cursor;
use toolpost_glass::cloud::distances;
use toolpost_glass::curve::{self, Layers};
use toolpost_glass::fill::{Fill, Filling, Sections, Shells, points, shells};
use toolpost_glass::list::Columns;
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::mesh::{self, Form};
use toolpost_glass::picture::{self, Manner, Plane, Setting};
use toolpost_glass::sample::{Apart, surface};
use toolpost_glass::{control, weld};

const APART: Apart = Apart { spacing: 100, lost: 0.0 };

/// Asserts that a step is done where nobody ends it, and not where the work was ended.
fn asks<T: Send>(step: &str, work: impl Fn() -> T + Send + Sync) {
    assert!(Ended::default().run(&work).is_some(), "{step}");
    let ended = Ended::default();
    ended.end();
    assert!(ended.run(&work).is_none(), "{step} does not ask");
}

#[test]
fn reading_asks_whether_it_goes_on() {
    let binary = [&[0; 80][..], &1_u32.to_le_bytes(), &[1; 50]].concat();
    let bodies: [(&str, &[u8], Form); 6] = [
        ("STL", &binary, Form::Stl),
        ("STL as text", b"solid x\nendsolid x\n", Form::Stl),
        ("OBJ", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Form::Obj),
        (
            "PLY",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
            Form::Ply,
        ),
        ("list", b"0 0 0\n", Form::List(Columns::default())),
        ("list of one line", b"1 2 3", Form::List(Columns::default())),
    ];
    for (name, bytes, form) in bodies {
        asks(name, || mesh::read(bytes, form, "body").is_ok());
    }
    asks("HPGL", || curve::read(b"IN;PU0,0;PD1,1;", curve::Form::Hpgl, "curve").is_ok());
    let machine = Machine::read(library("glass-xyz-100hz").unwrap(), "x.toml").unwrap();
    asks("program", || control::read(b"N1 END\n", &machine).is_ok());
}

fn setting(manner: Manner) -> Setting {
    Setting { plane: Plane::Xz, width: None, manner, invert: false, sheets: (1, None) }
}

fn grey(format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = GrayImage::from_fn(64, 64, |x, y| image::Luma([(3 * x + y) as u8]));
    DynamicImage::from(picture).write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

#[test]
fn pictures_ask_whether_they_go_on() {
    for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Jpeg] {
        let bytes = grey(format);
        asks("picture", || picture::read(&bytes, setting(Manner::Dither), "picture").is_ok());
    }
    let bytes = grey(ImageFormat::Png);
    let room = DVec3::splat(5.0);
    for manner in [Manner::Dither, Manner::Raster(0.2)] {
        let picture = picture::read(&bytes, setting(manner), "picture").unwrap();
        let sheet = picture.sheets(room, APART)[0];
        asks("dots", || picture.points(&sheet, APART, 1).len());
    }
    let relief = picture::read(&bytes, setting(Manner::Relief(2.0)), "picture").unwrap();
    asks("relief", || relief.relief(room, APART).triangles.len());
}

#[test]
fn getting_points_asks_whether_it_goes_on() {
    let mesh = sphere(2.0, 12);
    let cut = Sections { layer: None, first: 0.0, twist: 0.0, ends: false };
    let fills =
        [Fill::Surface, Fill::Solid, Fill::Sections(cut), Fill::Triangles(true), Fill::Rays];
    for fill in fills {
        let filling = Filling { fill, step: None, direction: DVec3::Z };
        asks("fill", || points(&mesh, &filling, APART, 1).others.len());
    }
    asks("shells", || shells(&mesh, Shells { count: 2, distance: None }, APART, 1).len());
    asks("health", || mesh.health().open);
    let cloud = surface(&mesh, APART, 1);
    asks("weld", || weld::welded(&cloud, 120).len());
    asks("clear", || weld::clear(&cloud, &cloud[..9], APART).len());
    asks("distances", || distances(&cloud, 100).too_close);
    let corners = [DVec3::ZERO, DVec3::X, DVec3::ONE];
    let layers = Layers::default();
    asks("curves", || layers.points([&corners[..]].into_iter(), 0.1, 0.1, DVec3::Z).len());
}
