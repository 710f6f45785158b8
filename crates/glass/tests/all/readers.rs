//! Bodies and lists of points, good and bad.

use glam::DVec3;
use toolpost_glass::list::Columns;
use toolpost_glass::mesh::{Form, Mesh, Shape, read};

const LIST: Form = Form::List(Columns([0, 1, 2]));

/// The corners of a tetrahedron, and its faces seen from outside.
const CORNERS: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 10.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn binary_stl(title: &str, faces: &[[u32; 3]]) -> Vec<u8> {
    let mut bytes = title.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0u8; 12]);
        let values = face.iter().flat_map(|&corner| CORNERS[corner as usize]);
        values.for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    bytes
}

fn text_stl() -> String {
    let mut text = String::from("solid four\n");
    for face in FACES {
        text.push_str("  facet normal 0 0 0\n    outer loop\n");
        for corner in face {
            let [x, y, z] = CORNERS[corner as usize];
            text.push_str(&format!("      vertex {x} {y} {z:e}\n"));
        }
        text.push_str("    endloop\n  endfacet\n");
    }
    text + "endsolid four\n"
}

fn ply(format: &str, number: impl Fn(f32) -> Vec<u8>, count: impl Fn(u32) -> Vec<u8>) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\ncomment four\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uint uint vertex_indices\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    CORNERS.iter().flatten().for_each(|value| bytes.extend(number(*value)));
    for face in FACES {
        bytes.extend(count(3));
        face.iter().for_each(|corner| bytes.extend(count(*corner)));
    }
    bytes
}

fn mesh(bytes: &[u8], form: Form) -> Mesh {
    match read(bytes, form, "body").unwrap() {
        Shape::Mesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

fn refused(bytes: &[u8], form: Form) -> (&'static str, u32) {
    let found = read(bytes, form, "body").unwrap_err();
    assert!(!found.help.is_empty() && found.file == "body", "{found}");
    (found.rule.name(), found.line)
}

#[test]
fn the_same_body_comes_from_every_form() {
    let obj = "# four\nv 0 0 0\nv 10 0 0 1.0\nv 0 10 0\nv 0 0 10\nvn 0 0 1\nf 1 3 2\nf 1/1 2/2 4/3\nf -4//1 -1//1 -2//1\nf 2 3 4\n";
    let bodies = [
        mesh(&binary_stl("four", &FACES), Form::Stl),
        // Some programs begin binary files with the word of text files.
        mesh(&binary_stl("solid four", &FACES), Form::Stl),
        mesh(text_stl().as_bytes(), Form::Stl),
        mesh(text_stl().replace('\n', "\r\n").as_bytes(), Form::Stl),
        mesh(format!("\u{feff}{}", text_stl()).as_bytes(), Form::Stl),
        mesh(obj.as_bytes(), Form::Obj),
        mesh(&ply("ascii", |v| format!("{v} ").into(), |n| format!("{n} ").into()), Form::Ply),
        mesh(
            &ply("binary_little_endian", |v| v.to_le_bytes().into(), |n| n.to_le_bytes().into()),
            Form::Ply,
        ),
        mesh(
            &ply("binary_big_endian", |v| v.to_be_bytes().into(), |n| n.to_be_bytes().into()),
            Form::Ply,
        ),
    ];
    for (i, body) in bodies.iter().enumerate() {
        assert_eq!((body.vertices.len(), body.triangles.len()), (4, 4), "{i}");
        let health = body.health();
        assert_eq!((health.open, health.flat, health.crowded), (0, 0, 0), "{i}");
        // A sixth of the cube.
        assert!((health.volume - 1000.0 / 6.0).abs() < 1e-9, "{i}: {health:?}");
        assert_eq!(body.bounds(), Some((DVec3::ZERO, DVec3::splat(10.0))), "{i}");
    }
}

#[test]
fn open_and_inverted_bodies_and_flat_triangles_are_reported() {
    let open = mesh(&binary_stl("", &FACES[1..]), Form::Stl).health();
    assert_eq!(open.open, 3);
    assert!(open.first_open.is_some());
    let inverted = FACES.map(|[a, b, c]| [a, c, b]);
    assert!(mesh(&binary_stl("", &inverted), Form::Stl).health().volume < 0.0);
    let [first, ..] = inverted;
    let one = mesh(&binary_stl("", &[first, FACES[1], FACES[2], FACES[3]]), Form::Stl).health();
    // All three edges of the triangle that is turned.
    assert_eq!((one.open, one.turned), (0, 3));
    let flat = mesh(&binary_stl("", &[FACES[0], [1, 1, 2]]), Form::Stl).health();
    assert_eq!(flat.flat, 1);
    let twice = [FACES[0], FACES[0], FACES[1]];
    assert_eq!(mesh(&binary_stl("", &twice), Form::Stl).health().crowded, 1);
}

#[test]
fn files_that_are_cut_off_or_hold_no_numbers_are_refused() {
    let binary = binary_stl("", &FACES);
    assert_eq!(refused(&binary[..binary.len() - 1], Form::Stl), ("truncated", 0));
    assert_eq!(refused(&binary[..40], Form::Stl), ("truncated", 0));
    assert_eq!(refused(b"", Form::Stl), ("truncated", 0));
    let text = text_stl();
    let half = &text[..text.len() / 2];
    assert_eq!(refused(&half.as_bytes()[..half.rfind('\n').unwrap()], Form::Stl).0, "truncated");
    assert_eq!(
        refused(text.replacen("vertex 0 0 0e0", "vertex 0 NaN 0", 1).as_bytes(), Form::Stl),
        ("number", 4)
    );
    assert_eq!(refused(b"solid x\nendsolid x\n", Form::Stl), ("empty", 0));
    let mut not_a_number = binary;
    not_a_number[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(refused(&not_a_number, Form::Stl), ("coordinate", 0));
    // A count of four thousand million triangles in a file of 84 bytes.
    let mut lie = vec![0; 84];
    lie[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_eq!(refused(&lie, Form::Stl), ("truncated", 0));

    assert_eq!(refused(b"v 0 0\n", Form::Obj), ("number", 1));
    assert_eq!(refused(b"v 0 0 0\nf 1 2 3\n", Form::Obj), ("face", 2));
    assert_eq!(refused(b"v 0 0 0\nv 1 0 0\nf 1 2\n", Form::Obj), ("face", 3));
    assert_eq!(refused(b"v 0 0 0\nf 0 1 1\n", Form::Obj), ("face", 2));
    assert_eq!(refused(b"v 0 0 1e300\nf 1 1 1\n", Form::Obj), ("coordinate", 0));

    let good = ply("binary_little_endian", |v| v.to_le_bytes().into(), |n| n.to_le_bytes().into());
    assert_eq!(refused(&good[..good.len() - 1], Form::Ply), ("truncated", 0));
    assert_eq!(refused(&good[..20], Form::Ply), ("truncated", 0));
    assert_eq!(refused(b"plx\n", Form::Ply), ("head", 1));
    let lie =
        b"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n";
    assert_eq!(refused(lie, Form::Ply), ("truncated", 0));
    let list = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list int int vertex_index\nend_header\n0 0 0\n3 0 1 2\n";
    assert_eq!(refused(list, Form::Ply), ("face", 0));
    // A vertex without z has none: it is not zero.
    let flat = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n";
    assert_eq!(refused(flat, Form::Ply), ("coordinate", 0));
}

#[test]
fn lists_of_points_are_read_from_any_columns() {
    let points =
        |text: &str, columns| match read(text.as_bytes(), Form::List(Columns(columns)), "points")
            .unwrap()
        {
            Shape::Points(points) => points,
            other => panic!("{other:?}"),
        };
    let expected = vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 6e-1)];
    assert_eq!(points("# a cloud\n1 2 3\n\n-4 .5 6e-1\n", [0, 1, 2]), expected);
    assert_eq!(points("x;y;z\n1;2;3\n-4;.5;0.6\n", [0, 1, 2]), expected);
    assert_eq!(points("7,3, 1,2\r\n7,0.6,-4,0.5\r\n", [2, 3, 1]), expected);
    assert_eq!(refused(b"1 2 3\n1 2\n", LIST), ("number", 2));
    assert_eq!(refused(b"1 2 3\r\n1 2 x\r\n", LIST), ("number", 2));
    assert_eq!(refused(b"# nothing\n", LIST), ("empty", 0));
    // A cloud of PLY has no faces.
    let cloud = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    assert!(
        matches!(read(cloud, Form::Ply, "").unwrap(), Shape::Points(points) if points == [DVec3::new(1.0, 2.0, 3.0)])
    );
}

/// An L: from its corner at the origin a fan stays inside, from the one that is next along X it does not.
#[test]
fn a_face_that_is_not_convex_is_refused_where_its_fan_leaves_it() {
    let corners = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    let inside = format!("{corners}f 1 2 3 4 5 6\n");
    assert_eq!(mesh(inside.as_bytes(), Form::Obj).triangles.len(), 4);
    let outside = format!("{corners}f 2 3 4 5 6 1\n");
    assert_eq!(refused(outside.as_bytes(), Form::Obj), ("face", 7));
}

#[test]
fn a_decimal_comma_is_no_separator() {
    for line in ["1,5 2,5 3,5", "1,5;2,5;3,5", "1,5\t2,5\t3,5"] {
        assert_eq!(
            refused(line.as_bytes(), Form::List(Columns::default())),
            ("number", 1),
            "{line}"
        );
    }
    for line in ["1,2,3", "1, 2, 3", "1 , 2 ,3", "1;2;3", "1 2 3"] {
        let read = read(line.as_bytes(), Form::List(Columns::default()), "p.xyz").unwrap();
        assert!(
            matches!(read, Shape::Points(points) if points == [DVec3::new(1.0, 2.0, 3.0)]),
            "{line}"
        );
    }
}
