//! What carries what: links, bodies, and the vectors by which the page of the studio checks its own matrices.

use geom::{Frame, Vec3};
use serde_json::{Value, json};
use std::path::Path;
use toolpost_machine::linkage::{LinkKind, Linkage};
use toolpost_machine::{Machine, load, load_text};

/// A trunnion of a table, with X and Y on it; A about X through Z 100, C about Z.
fn mill(keys: &str) -> Result<Machine, Box<program::Diagnostic>> {
    load_text("shop.toml", &format!("extends = \"sinumerik-840d-table-ac\"\n{keys}"))
}

fn near(found: Vec3, wanted: [f64; 3]) {
    assert!(found.distance(Vec3::from_array(wanted)) < 1e-9, "{found}, not {wanted:?}");
}

#[test]
fn a_table_goes_the_other_way_and_carries_what_is_on_it() {
    let machine = load_text(
        "shop.toml",
        "extends = \"generic-3axis-fanuc\"\nwork_zero = [10, 20, -300]\n[axes]\nX.on = \"table\"\nY.on = \"table\"\n",
    );
    let linkage = Linkage::of(&machine.unwrap());
    let names: Vec<&str> = linkage.links.iter().map(|link| &*link.name).collect();
    let on: Vec<Option<usize>> = linkage.links.iter().map(|link| link.on).collect();
    // The bed carries Y, that carries X, and the bed carries Z beside them.
    assert_eq!((names, on), (vec!["bed", "Y", "X", "Z"], vec![None, Some(0), Some(1), Some(0)]));
    assert_eq!((linkage.tool.on, linkage.part.on), (3, 2));
    let frames = linkage.frames(&[5.0, 7.0, -250.0]);
    near(frames[1].translation, [0.0, -7.0, 0.0]);
    near(frames[2].translation, [-5.0, -7.0, 0.0]);
    near(frames[3].translation, [0.0, 0.0, -250.0]);
    // The tip of a tool of 40 mm: 5 - 10, 7 - 20, -250 - 40 + 300.
    near(linkage.tip(&[5.0, 7.0, -250.0], 40.0), [-5.0, -13.0, 10.0]);
    // Without the key the tool goes there itself.
    let machine =
        load_text("shop.toml", "extends = \"generic-3axis-fanuc\"\nwork_zero = [10, 20, -300]\n");
    let linkage = Linkage::of(&machine.unwrap());
    assert_eq!((linkage.tool.on, linkage.part.on), (3, 0));
    near(linkage.tip(&[5.0, 7.0, -250.0], 40.0), [-5.0, -13.0, 10.0]);
}

#[test]
fn rotary_axes_turn_what_they_carry_in_the_order_of_the_file() {
    let machine = mill("").unwrap();
    let linkage = Linkage::of(&machine);
    let names: Vec<&str> = linkage.links.iter().map(|link| &*link.name).collect();
    assert_eq!(names, ["bed", "Y", "X", "Z", "A", "C"]);
    let kinds: Vec<LinkKind> = linkage.links.iter().map(|link| link.kind).collect();
    assert_eq!(kinds[3..], [LinkKind::Slide, LinkKind::Turn, LinkKind::Turn]);
    // A stands on the bed and carries C.
    assert_eq!([linkage.links[4].on, linkage.links[5].on], [Some(0), Some(4)]);
    // A at 90 degrees: what points up on the table then points where A brings it.
    let a = machine.rotary.iter().find(|axis| axis.letter == 'A').unwrap();
    let frames = linkage.frames(&[0.0, 0.0, 0.0, 90.0, 0.0]);
    let up = frames[5].matrix3 * Vec3::Z;
    let wanted = a.axis.cross(Vec3::Z) * a.sign;
    near(up, wanted.to_array());
}

#[test]
fn every_machine_has_bodies_on_its_links_and_a_file_may_give_others() {
    for name in toolpost_machine::library::names(toolpost_machine::library::LOADABLE) {
        let machine = load(name).unwrap();
        let linkage = Linkage::of(&machine);
        assert!(linkage.bodies.len() > 1, "{name}");
        for body in &linkage.bodies {
            assert!(body.on < linkage.links.len() && !body.is_given, "{name}: {body:?}");
            let [low, high] = [body.low, body.high].map(Vec3::from_array);
            assert!(
                low.cmplt(high).all() && low.is_finite() && high.is_finite(),
                "{name}: {body:?}"
            );
        }
        for (i, link) in linkage.links.iter().enumerate() {
            assert!(link.on.is_none_or(|on| on < i), "{name}: {link:?}");
            assert!(link.terms.iter().all(|(axis, _)| *axis < linkage.axes.len()));
        }
    }
    let given = "[[body]]\non = \"C\"\nlow = [-100, -100, -20]\nhigh = [100, 100, 0]\n[[body]]\nname = \"nose\"\non = \"spindle\"\n\
                 low = [-30, -30, 0]\nhigh = [30, 30, 90]\n";
    let linkage = Linkage::of(&mill(given).unwrap());
    let bodies: Vec<(&str, usize, bool)> =
        linkage.bodies.iter().map(|body| (&*body.name, body.on, body.is_given)).collect();
    assert_eq!(bodies, [("C", 5, true), ("nose", 3, true)]);
}

#[test]
fn a_body_that_hangs_on_nothing_or_has_no_inside_is_refused_with_its_line() {
    let refused = |keys: &str| {
        let found = mill(keys).unwrap_err();
        (found.line, found.message)
    };
    let (line, message) = refused("[[body]]\non = \"Q\"\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\n");
    assert_eq!(line, 2);
    assert!(
        message.contains("`Q` carries nothing")
            && message.contains("bed, Y, X, Z, A, C, spindle, table"),
        "{message}"
    );
    let (line, message) = refused("[[body]]\non = \"X\"\nlow = [0, 0, 5]\nhigh = [1, 1, 1]\n");
    assert!(line == 2 && message.contains("not below"), "{message}");
    for key in ["on", "low", "high"] {
        let keys = ["on = \"X\"", "low = [0, 0, 0]", "high = [1, 1, 1]"];
        let keys: Vec<&str> = keys.into_iter().filter(|line| !line.starts_with(key)).collect();
        let (_, message) = refused(&format!("[[body]]\n{}\n", keys.join("\n")));
        assert!(message.contains(&format!("`{key}` is missing")), "{message}");
    }
    let many = "[[body]]\non = \"X\"\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\n".repeat(101);
    assert!(refused(&many).1.contains("100 bodies at the most"));
    let found = mill("[axes]\nX.on = \"ceiling\"\n").unwrap_err();
    assert!(
        found.message.starts_with("on: `ceiling`") && found.help.contains("`table`"),
        "{found}"
    );
}

/// Machines of each kind: heads and tables, a wire, arms by their lengths and by Denavit-Hartenberg parameters, joint 3 coupled.
const MACHINES: [&str; 11] = [
    "generic-3axis-linuxcnc",
    "sinumerik-840d-table-ac",
    "sinumerik-840d-traori",
    "linuxcnc-xyzbc-head",
    "dmu50-heidenhain",
    "haas-umc-750",
    "bp-95d",
    "kuka-kr6-r900",
    "fanuc-lrmate-200id-mill",
    "universal-ur10e",
    "kuka-kr120-rail",
];

/// Positions of axes, mm and degrees.
const POSITIONS: [[f64; 7]; 3] = [
    [0.0; 7],
    [10.0, -20.0, -30.0, 40.0, -50.0, 60.0, 700.0],
    [-123.456, 78.9, 12.5, -33.25, 271.0, -5.0, -80.0],
];

/// Whether two values are one, but for the last digits of numbers, in which libraries of mathematics differ.
fn alike(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let [a, b] = [a, b].map(|number| number.as_f64().unwrap_or(f64::NAN));
            (a - b).abs() <= 1e-10
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            let same = |(key, value)| b.get(key).is_some_and(|other| alike(value, other));
            a.len() == b.len() && a.iter().all(same)
        }
        _ => a == b,
    }
}

fn vectors() -> Value {
    let machine = |name: &&str| {
        let linkage = Linkage::of(&load(name).unwrap());
        let cases: Vec<Value> = POSITIONS
            .iter()
            .map(|position| {
                let axes = &position[..linkage.axes.len().min(7)];
                let frames = linkage.frames(axes);
                json!({
                    "axes": axes,
                    "links": frames.iter().map(Frame::to_cols_array).collect::<Vec<_>>(),
                    "tool_length": 80.0,
                    "tip": linkage.tip(axes, 80.0).to_array(),
                })
            })
            .collect();
        json!({ "machine": name, "linkage": linkage, "cases": cases })
    };
    MACHINES.iter().map(machine).collect()
}

/// The page of the studio has matrices of its own; its tests read this file. `TOOLPOST_DOCS=write` writes it.
#[test]
fn the_vectors_for_the_page_are_those_of_the_linkage() {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studio/tests/vectors/linkage.json");
    let vectors = vectors();
    if std::env::var("TOOLPOST_DOCS").is_ok_and(|how| how == "write") {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, format!("{vectors:#}\n")).unwrap();
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    let kept = serde_json::from_str(&kept).unwrap_or(Value::Null);
    assert!(alike(&vectors, &kept), "{} is stale: TOOLPOST_DOCS=write writes it", file.display());
}

/// Bodies of neighbouring links touch at every position: where a joint turns, what it carries begins.
#[test]
fn the_boxes_of_an_arm_stay_together_whatever_its_joints() {
    for name in toolpost_machine::library::names(toolpost_machine::library::ROBOTS) {
        let linkage = Linkage::of(&load(name).unwrap());
        let first = linkage.links.len() - 6;
        for joint in 1..6 {
            let link = &linkage.links[first + joint];
            let [direction, point] = [link.direction, link.point].map(Vec3::from_array);
            // How far the line about which the joint turns is from the body of a link, mm.
            let off = |on: usize| {
                let bodies = linkage.bodies.iter().filter(|body| body.on == on);
                let away = bodies.map(|body| {
                    let [low, high] = [body.low, body.high].map(Vec3::from_array);
                    let middle = (low + high) / 2.0;
                    let near = point + direction * (middle - point).dot(direction);
                    near.distance(near.clamp(low, high))
                });
                away.fold(f64::INFINITY, f64::min)
            };
            for on in [first + joint - 1, first + joint] {
                assert!(off(on) < 45.0, "{name}: J{}: {} mm from link {on}", joint + 1, off(on));
            }
        }
    }
}
