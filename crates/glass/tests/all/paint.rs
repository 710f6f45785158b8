//! Bodies with colours and textures: as many points as they are bright. Expected values are counted by hand.

use image::{ImageFormat, Luma};
use std::io::Cursor;
use toolpost_glass::cloud::{Point, distances};
use toolpost_glass::fill::{Fill, Filling, points};
use toolpost_glass::mesh::{Form, Mesh, Shape, read_painted};
use toolpost_glass::sample::Apart;

const APART: Apart = Apart { spacing: 130, lost: 0.0 };

/// A PNG of one row of grey pixels.
fn png(row: &[u8]) -> Vec<u8> {
    let picture = image::ImageBuffer::from_fn(row.len() as u32, 1, |x, _| Luma([row[x as usize]]));
    let mut bytes = Vec::new();
    picture.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png).unwrap();
    bytes
}

fn read(text: &[u8], form: Form, files: &[(&str, Vec<u8>)]) -> Result<Mesh, (&'static str, u32)> {
    let mut beside = |name: &str| {
        let found = files.iter().find(|(own, _)| *own == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| format!("there is no {name}"))
    };
    match read_painted(text, form, "body", Some(&mut beside)) {
        Ok(Shape::Mesh(mesh)) => Ok(mesh),
        Ok(_) => panic!("no body"),
        Err(found) => Err((found.rule.name(), found.line)),
    }
}

fn filled(mesh: &Mesh, fill: Fill) -> Vec<Point> {
    points(mesh, &Filling { fill, step: None, direction: glam::DVec3::Z }, APART, 1).sampled
}

/// A sheet of 20 mm whose corners have more words behind them, such as a colour.
fn sheet(more: [&str; 4]) -> String {
    let corners = ["0 0 0", "20 0 0", "20 20 0", "0 20 0"];
    corners.iter().zip(more).map(|(corner, more)| format!("v {corner} {more}\n")).collect()
}

const TEXTURED: &str =
    "mtllib sheet.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paper\nf 1/1 2/2 3/3 4/4\n";

fn textured(row: &[u8]) -> Mesh {
    let library = b"# a library\nnewmtl paper\nKd 1 1 1\nmap_Kd -clamp on grey.png\n".to_vec();
    let files = [("sheet.mtl", library), ("grey.png", png(row))];
    read((sheet([""; 4]) + TEXTURED).as_bytes(), Form::Obj, &files).unwrap()
}

#[test]
fn points_follow_the_colours_of_corners() {
    // Black on the left, white on the right: light grows evenly, so the left half has a quarter of the points.
    let colours = ["0 0 0", "1 1 1", "1 1 1", "0 0 0"];
    let obj = read((sheet(colours) + "f 1 2 3 4\n").as_bytes(), Form::Obj, &[]).unwrap();
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let body = "0 0 0 0 0 0\n20 0 0 255 255 255\n20 20 0 255 255 255\n0 20 0 0 0 0\n4 0 1 2 3\n";
    let ply = read((head.to_owned() + body).as_bytes(), Form::Ply, &[]).unwrap();
    for mesh in [obj, ply] {
        let (all, made) = (filled(&mesh, Fill::Surface), filled(&mesh, Fill::Shaded(false)));
        let part = made.len() as f64 / all.len() as f64;
        assert!((part - 0.5).abs() < 0.01, "{part}");
        let left = made.iter().filter(|point| point[0] < 10_000).count() as f64;
        assert!((left / made.len() as f64 - 0.25).abs() < 0.01, "{left} of {}", made.len());
        assert_eq!(distances(&made, 130).too_close, 0);
    }
}

#[test]
fn a_texture_says_how_many_points_there_are_and_where() {
    // A value of 188 is 0.5029 of the light of white (IEC 61966-2-1).
    let grey = textured(&[188]);
    let all = filled(&grey, Fill::Surface).len() as f64;
    let made = filled(&grey, Fill::Shaded(false)).len() as f64;
    assert!((made - 0.5029 * all).abs() < 1.0, "{made} of {all}");
    let dark = filled(&grey, Fill::Shaded(true)).len() as f64;
    assert!((dark - 0.4971 * all).abs() < 1.0, "{dark} of {all}");
    // Black on the left, white on the right: every point there is kept, and no other.
    let halves = textured(&[0, 255]);
    let made = filled(&halves, Fill::Shaded(false));
    let all = filled(&halves, Fill::Surface);
    let right = all.iter().filter(|point| point[0] > 10_000).count();
    let border = all.iter().filter(|point| point[0] == 10_000).count();
    assert!(made.iter().all(|point| point[0] >= 10_000));
    assert!((right..=right + border).contains(&made.len()), "{} {right} {border}", made.len());
}

#[test]
fn bodies_of_which_some_are_painted_keep_their_paint_as_they_are_joined() {
    let mut all = read((sheet([""; 4]) + "f 1 2 3 4\n").as_bytes(), Form::Obj, &[]).unwrap();
    let mut second = textured(&[0]);
    second.vertices.iter_mut().for_each(|place| place.x += 30.0);
    all.join(second);
    let made = filled(&all, Fill::Shaded(false));
    assert!(made.len() > 15_000 && made.iter().all(|point| point[0] <= 20_000), "{}", made.len());
}

#[test]
fn what_a_body_names_must_be_there() {
    let text = sheet([""; 4]) + TEXTURED;
    assert_eq!(read(text.as_bytes(), Form::Obj, &[]).unwrap_err(), ("image", 5));
    let library = ("sheet.mtl", b"newmtl paper\nmap_Kd grey.png\n".to_vec());
    assert_eq!(
        read(text.as_bytes(), Form::Obj, std::slice::from_ref(&library)).unwrap_err().0,
        "image"
    );
    let cut = ("grey.png", png(&[1, 2, 3])[..40].to_vec());
    assert_eq!(read(text.as_bytes(), Form::Obj, &[library, cut]).unwrap_err().0, "image");
    let other = ("sheet.mtl", b"newmtl glass\n".to_vec());
    assert_eq!(read(text.as_bytes(), Form::Obj, &[other]).unwrap_err(), ("image", 10));
    // Nobody asked for paint: nothing is read besides the body.
    assert!(toolpost_glass::mesh::read(text.as_bytes(), Form::Obj, "body").is_ok());
}
