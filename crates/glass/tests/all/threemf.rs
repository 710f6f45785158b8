//! 3MF archives: units, components, places, and archives that are wrong.

use glam::DVec3;
use std::io::{Cursor, Write};
use toolpost_glass::mesh::{Form, Mesh, Paint, Shape, read, read_painted};
use zip::write::{SimpleFileOptions, ZipWriter};

/// An archive of these files.
fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer.start_file(*name, SimpleFileOptions::default()).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

const NAMES: &str = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
    xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";

/// A tetrahedron of side `side`.
fn roof(id: u32, side: f64) -> String {
    format!(
        "<object id=\"{id}\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
        <vertex x=\"{side}\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"{side}\" z=\"0\"/>\
        <vertex x=\"0\" y=\"0\" z=\"{side}\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>\
        <triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/>\
        <triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>"
    )
}

fn model(unit: &str, objects: &str, items: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><model unit=\"{unit}\" {NAMES}><resources>{objects}</resources>\
        <build>{items}</build></model>"
    )
}

fn opened(text: &str) -> Result<Mesh, (&'static str, String)> {
    shape(&archive(&[("3D/3dmodel.model", text.as_bytes())]))
}

fn shape(bytes: &[u8]) -> Result<Mesh, (&'static str, String)> {
    match read(bytes, Form::ThreeMf, "roof.3mf") {
        Ok(Shape::Mesh(mesh)) => Ok(mesh),
        Ok(other) => panic!("{other:?}"),
        Err(found) => {
            assert!(found.file == "roof.3mf" && !found.help.is_empty(), "{found}");
            Err((found.rule.name(), found.message.clone()))
        }
    }
}

#[test]
fn what_is_built_stands_at_its_place_in_mm() {
    // A tenth of an inch, turned by 90° about Z (rows of the matrix are where X, Y and Z go) and moved by 1 inch along X, then, as a
    // component of what is built, by 2 inches along Z.
    let objects = roof(1, 0.1)
        + "<object id=\"2\"><components><component objectid=\"1\" \
            transform=\"0 1 0 -1 0 0 0 0 1 1 0 0\"/></components></object>";
    let items = "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 0 2\"/>";
    let mesh = opened(&model("inch", &objects, items)).unwrap();
    let expected = [(25.4, 0.0, 50.8), (25.4, 2.54, 50.8), (22.86, 0.0, 50.8), (25.4, 0.0, 53.34)];
    for (place, (x, y, z)) in mesh.vertices.iter().zip(expected) {
        assert!(place.distance(DVec3::new(x, y, z)) < 1e-12, "{place}");
    }
    let health = mesh.health();
    assert_eq!((health.open, health.turned, mesh.triangles.len()), (0, 0, 4));
    assert!((health.volume - 2.54f64.powi(3) / 6.0).abs() < 1e-9);
    // What is not built is not there, and a mirrored body is not inside out.
    let both = roof(1, 10.0) + &roof(2, 20.0);
    let items = "<item objectid=\"2\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>";
    let mesh = opened(&model("millimeter", &both, items)).unwrap();
    assert_eq!(mesh.bounds(), Some((DVec3::new(-20.0, 0.0, 0.0), DVec3::new(0.0, 20.0, 20.0))));
    assert!(mesh.health().volume > 0.0);
}

#[test]
fn parts_in_files_of_their_own_are_read_and_supports_are_left_out() {
    let root = model(
        "millimeter",
        "<object id=\"1\"><components><component objectid=\"5\" p:path=\"/3D/Objects/a.model\"/>\
        </components></object><object id=\"2\" type=\"support\"><mesh/></object>",
        "<item objectid=\"1\"/><item objectid=\"2\"/>",
    );
    let part = model("centimeter", &roof(5, 1.0), "");
    let relations = "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
        <Relationship Target=\"/3D/root.model\" Id=\"r\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let bytes = archive(&[
        ("_rels/.rels", relations.as_bytes()),
        ("3D/root.model", root.as_bytes()),
        ("3D/Objects/a.model", part.as_bytes()),
    ]);
    let mesh = shape(&bytes).unwrap();
    assert_eq!(mesh.bounds(), Some((DVec3::ZERO, DVec3::splat(10.0))));
}

#[test]
fn archives_that_are_cut_off_grow_or_hold_other_shapes_are_refused() {
    let item = "<item objectid=\"1\"/>";
    let good = model("millimeter", &roof(1, 10.0), item);
    assert_eq!(opened(&good).unwrap().triangles.len(), 4);
    let bytes = archive(&[("3D/3dmodel.model", good.as_bytes())]);
    assert_eq!(shape(&bytes[..bytes.len() / 2]).unwrap_err().0, "truncated");
    assert_eq!(shape(b"").unwrap_err().0, "truncated");
    assert_eq!(shape(&archive(&[("a.txt", b"a")])).unwrap_err().0, "truncated");
    let refused = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        opened(&good.replacen(from, to, 1)).unwrap_err().0
    };
    assert_eq!(refused("</model>", ""), "syntax");
    assert_eq!(refused("millimeter", "mile"), "number");
    assert_eq!(refused("x=\"10\"", "x=\"ten\""), "number");
    assert_eq!(refused("x=\"10\"", "x=\"inf\""), "number");
    assert_eq!(refused("v1=\"1\"", "v1=\"4\""), "face");
    assert_eq!(refused("v1=\"1\"", ""), "number");
    assert_eq!(refused(item, ""), "empty");
    assert_eq!(refused("objectid=\"1\"", "objectid=\"9\""), "empty");
    assert_eq!(refused(item, "<item objectid=\"1\" transform=\"1 0 0\"/>"), "number");
    assert_eq!(refused("</triangles>", "</triangles><beamlattice/>"), "form");
    assert_eq!(refused("<?xml version=\"1.0\"?>", "<!DOCTYPE m [<!ENTITY a \"b\">]>"), "syntax");
    // A component that names itself, and two that name each other twice in every step.
    let own = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    assert_eq!(opened(&model("millimeter", own, item)).unwrap_err().0, "too-large");
    let mut tower = String::from("<object id=\"30\" type=\"support\"><mesh/></object>");
    for id in 1..30 {
        let next = format!("<component objectid=\"{}\"/>", id + 1);
        tower += &format!("<object id=\"{id}\"><components>{next}{next}</components></object>");
    }
    assert_eq!(opened(&model("millimeter", &tower, item)).unwrap_err().0, "too-large");
    // 300 MB of blanks in some 300 kB.
    let bomb = archive(&[("3D/3dmodel.model", &vec![b' '; 300 << 20])]);
    assert!(bomb.len() < 1 << 20);
    assert_eq!(shape(&bomb).unwrap_err().0, "too-large");
}

/// What is painted of an archive with this model and a texture.
fn painted(text: &str) -> Result<Mesh, (&'static str, String)> {
    let mut png = Cursor::new(Vec::new());
    let grey = image::GrayImage::from_raw(2, 1, vec![0, 255]).unwrap();
    grey.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let files = [("3D/3dmodel.model", text.as_bytes()), ("3D/grey.png", png.get_ref())];
    match read_painted(&archive(&files), Form::ThreeMf, "roof.3mf", Some(&mut |_| unreachable!())) {
        Ok(Shape::Mesh(mesh)) => Ok(mesh),
        Ok(other) => panic!("{other:?}"),
        Err(found) => Err((found.rule.name(), found.message.clone())),
    }
}

#[test]
fn colours_materials_and_textures_are_the_light_of_triangles() {
    let properties = "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#000000\"/>\
        <base name=\"b\" displaycolor=\"#FFFFFF80\"/></basematerials>\
        <colorgroup id=\"6\"><color color=\"#FF0000\"/><color color=\"#00FF00\"/><color color=\"#0000FF\"/></colorgroup>\
        <texture2d id=\"7\" path=\"/3D/grey.png\" contenttype=\"image/png\"/><texture2dgroup id=\"8\" texid=\"7\">\
        <tex2coord u=\"0\" v=\"0\"/><tex2coord u=\"1\" v=\"0\"/><tex2coord u=\"0.5\" v=\"1\"/></texture2dgroup>";
    // The object is of the second material; the first triangle has a colour at each corner, the second one the first material, the third a
    // texture.
    let body = roof(1, 3.0)
        .replace("type=\"model\"", "pid=\"5\" pindex=\"1\"")
        .replace("v3=\"1\"/>", "v3=\"1\" pid=\"6\" p1=\"0\" p2=\"1\" p3=\"2\"/>")
        .replace("v2=\"1\" v3=\"3\"/>", "v2=\"1\" v3=\"3\" p1=\"0\"/>")
        .replace("v3=\"2\"/>", "v3=\"2\" pid=\"8\" p1=\"0\" p2=\"1\" p3=\"2\"/>");
    // As it is, and mirrored along X, which exchanges the last two corners.
    let items =
        "<item objectid=\"1\"/><item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>";
    let text = model("millimeter", &format!("{properties}{body}"), items);
    let mesh = painted(&text).unwrap();
    assert_eq!((mesh.paint.len(), mesh.textures.len()), (8, 1));
    // IEC 61966-2-1: red, green and blue have these parts of the light of white.
    assert_eq!(mesh.paint[0], Paint::Corners([0.2126, 0.7152, 0.0722]));
    assert_eq!(mesh.paint[1], Paint::Corners([0.0; 3]));
    assert_eq!(mesh.paint[2], Paint::Texture(0, [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]));
    assert_eq!(mesh.paint[3], Paint::Corners([1.0; 3]));
    assert_eq!(mesh.paint[4], Paint::Corners([0.2126, 0.0722, 0.7152]));
    assert_eq!(mesh.paint[6], Paint::Texture(0, [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]));
    let [first, second, _] = mesh.corners(2);
    assert_eq!((mesh.light(2, first), mesh.light(2, second)), (0.0, 1.0));
    // Nobody asked for it.
    let files = [("3D/3dmodel.model", text.as_bytes())];
    assert!(shape(&archive(&files)).unwrap().paint.is_empty());
    for (old, new, what) in [
        ("#FF0000", "red", "`red` is no colour"),
        ("pid=\"6\"", "pid=\"9\"", "group 9"),
        ("p3=\"2\"", "p3=\"3\"", "has no 3"),
        ("u=\"0.5\"", "u=\"x\"", "the numbers u and v"),
        ("texid=\"7\"", "texid=\"6\"", "no texture before it"),
        ("/3D/grey.png", "/3D/other.png", "3D/other.png"),
        ("contenttype", "tilestyleu=\"clamp\" contenttype", "not repeated"),
    ] {
        let found = painted(&text.replace(old, new)).unwrap_err();
        assert!(found.1.contains(what), "{old}: {found:?}");
    }
}
