//! Boards that are written by hand: hand calculation, and what is refused.

use geom::Vec2;
use program::Diagnostic;
use proptest::prelude::*;
use std::f64::consts::PI;
use std::path::Path;
use toolpost_pcb::board::{Board, Copper, Face};
use toolpost_pcb::model::{self, Reading};

fn root(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn read(text: &str) -> Result<Reading, Vec<Diagnostic>> {
    model::read("board.toml", text.as_bytes())
}

#[track_caller]
fn board(text: &str) -> Board {
    read(text).unwrap_or_else(|errors| panic!("{errors:#?}")).board
}

fn copper(board: &Board, face: Face) -> &Copper {
    board.side(face).copper.as_ref().expect("there is copper")
}

#[track_caller]
fn assert_area(board: &Board, face: Face, expected: f64) {
    let area = copper(board, face).region.area();
    assert!((area - expected).abs() < 1e-5, "{area} is not {expected}");
}

/// The first error, which is of this rule, at this line and column, and says this.
#[track_caller]
fn refused(text: &str, rule: &str, place: (u32, u32), says: &str) -> Diagnostic {
    let errors = read(text).expect_err("this is refused");
    let found = &errors[0];
    let all = format!("{} {}", found.message, found.help);
    assert_eq!((found.rule.name(), found.line, found.column), (rule, place.0, place.1), "{found}");
    assert!(all.contains(says) && !found.help.is_empty(), "{found}");
    assert_eq!(found.file, "board.toml");
    found.clone()
}

fn nets(copper: &Copper) -> Vec<&str> {
    copper.nets.iter().map(|net| net.as_deref().unwrap_or("")).collect()
}

#[test]
fn the_example() {
    let Reading { board, warnings } = read(&root("examples/lamp.toml")).unwrap();
    assert!(warnings.is_empty(), "{warnings:#?}");
    assert_eq!(board.name, "lamp");
    assert_eq!(board.outline.as_ref().unwrap().area(), 600.0);
    assert_eq!(board.holes.len(), 6);
    let (front, back) = (copper(&board, Face::Front), copper(&board, Face::Back));
    let mut names = nets(front);
    names.sort_unstable();
    assert_eq!(names, ["+5V", "GND", "GND", "LED"]);
    assert_eq!(nets(back), ["GND"]);
    // The diode stands upright: its anode is above.
    assert!(
        front.region.contains(Vec2::new(24.0, 9.27)) && back.region.contains(Vec2::new(24.0, 6.73))
    );
}

#[test]
fn the_example_of_the_documentation_is_that_board() {
    let page = root("docs/sources/board.md");
    let block = |language: &str| {
        let (_, rest) = page.split_once(&format!("```{language}\n")).unwrap();
        rest.split_once("```").unwrap().0.to_owned()
    };
    // Both say the same in two languages.
    let (toml, json) = (board(&block("toml")), board(&block("json")));
    assert_eq!(toml, json);
    // A track of 10 by 1 mm, a circle of 2 mm at one end: half a disc of 0.5 beyond the other end; what
    // the track has within the disc is not counted twice.
    let within = 0.5f64.asin() + 0.5 * 0.75f64.sqrt();
    assert_area(&toml, Face::Front, PI + 10.0 + PI / 8.0 - within);
}

#[test]
fn pads_have_the_areas_of_their_shapes() {
    let pad = |shape: &str, more: &str| {
        board(&format!("[[pads]]\nnode = [3, 4]\nshape = \"{shape}\"\nsize = 2\n{more}"))
    };
    assert_area(&pad("circle", ""), Face::Front, PI);
    assert_area(&pad("square", ""), Face::Front, 4.0);
    // An octagon of width 2: 2·(√2 − 1)·width².
    assert_area(&pad("octagon", ""), Face::Front, 8.0 * (2f64.sqrt() - 1.0));
    let extents = |board: &Board| copper(board, Face::Front).region.extents().unwrap();
    let near = |found: (Vec2, Vec2), half: f64| {
        let center = Vec2::new(3.0, 4.0);
        found.0.distance(center - half) < 1e-6 && found.1.distance(center + half) < 1e-6
    };
    assert!(near(extents(&pad("octagon", "")), 1.0) && near(extents(&pad("square", "")), 1.0));
    assert!(near(extents(&pad("square", "rotation = 45")), 2f64.sqrt()));
    let both = pad("circle", "layer = \"both\"");
    assert_area(&both, Face::Front, PI);
    assert_area(&both, Face::Back, PI);
    assert!(pad("circle", "layer = \"back\"").front.copper.is_none());
}

#[test]
fn groups_move_turn_and_mirror_what_is_in_them() {
    let group = |keys: &str| {
        board(&format!(
            "[[groups]]\nname = \"a\"\n{keys}\n[groups.nodes]\none = [2, 1]\n\
             [[groups.holes]]\nnode = \"one\"\ndiameter = 1\n\
             [[groups.pads]]\nnode = \"one\"\nshape = \"circle\"\nsize = 2\n"
        ))
    };
    let place = |board: &Board| {
        let (low, high) = board.holes[0].extents();
        low.midpoint(high)
    };
    let near = |board: &Board, x, y| place(board).distance(Vec2::new(x, y)) < 1e-9;
    assert!(near(&group(""), 2.0, 1.0));
    assert!(near(&group("at = [10, 20]"), 12.0, 21.0));
    assert!(near(&group("at = [10, 20]\nrotation = 90"), 9.0, 22.0));
    assert!(near(&group("at = [10, 20]\nrotation = -450"), 11.0, 18.0));
    let mirrored = group("at = [10, 20]\nrotation = 90\nmirrored = true");
    // Left to right first, and then turned.
    assert!(near(&mirrored, 9.0, 18.0));
    assert!(mirrored.front.copper.is_none());
    assert_area(&mirrored, Face::Back, PI);
}

#[test]
fn groups_in_groups_see_what_is_around_them() {
    let text = r#"
        nodes = { home = [1, 0] }
        [[groups]]
        name = "outer"
        at = "home"
        rotation = 180
        [groups.nodes]
        a = [1, 0]
        [[groups.groups]]
        name = "inner"
        at = "a"
        [groups.groups.nodes]
        b = [0, 2]
        [[groups.groups.tracks]]
        nodes = ["b", "a", "home"]
        width = 0.1
        [[tracks]]
        nodes = ["home", "outer.inner.b", "outer.a"]
        width = 0.1
        net = "N"
    "#;
    // A is at 0,0 and B, turned by half, at 0,-2; home at 1,0.
    let board = board(text);
    let copper = copper(&board, Face::Front);
    for place in [(0.5, 0.0), (0.0, -1.0), (0.5, -1.0)] {
        assert!(copper.region.contains(Vec2::new(place.0, place.1)), "{place:?}");
    }
    assert_eq!(nets(copper), ["N"]);
}

#[test]
fn what_shares_a_node_is_one_net() {
    let text = |layer: &str, other: &str| {
        format!(
            "[nodes]\na = [0, 0]\nb = [5, 0]\nc = [9, 0]\n\
             [[tracks]]\nnodes = [\"a\", \"b\"]\nwidth = 1\nnet = \"A\"\n\
             [[tracks]]\nnodes = [\"b\", \"c\"]\nwidth = 1\nlayer = \"{layer}\"\n\
             [[pads]]\nnode = \"c\"\nshape = \"circle\"\nsize = 2\nlayer = \"{layer}\"\n{other}"
        )
    };
    assert_eq!(nets(copper(&board(&text("front", "")), Face::Front)), ["A"]);
    // On another side it is not joined.
    assert_eq!(nets(copper(&board(&text("back", "")), Face::Back)), [""]);
    let found = refused(&text("front", "net = \"B\"\n"), "net-twice", (18, 7), "`B`");
    assert!(found.message.contains("`A`"));
    // Copper that touches without a node is reported by what the copper is.
    let touching = "[[pads]]\nnode = [2, 0]\nshape = \"circle\"\nsize = 2\nnet = \"C\"\n";
    let reading = read(&(text("front", "") + touching)).unwrap();
    assert_eq!(reading.warnings[0].rule.name(), "nets-joined");
}

#[test]
fn what_is_no_board() {
    refused("", "no-board", (0, 0), "nothing");
    refused("name = ", "board-file", (1, 8), "");
    refused("{\"name\": ", "board-file", (1, 9), "JSON");
    refused("[[pads]]\nnode = [0, 0]\nshape = \"circle\"\nsize = -1\n", "width", (4, 8), "-1 mm");
    refused("[[holes]]\nnode = [0, 0]\ndiameter = nan\n", "width", (3, 12), "NaN mm");
    refused("[[holes]]\nnode = [0, 0]\ndiameter = 1e-9\n", "width", (3, 12), "0.01 to 10000");
    refused("[[holes]]\nnode = [0, inf]\ndiameter = 1\n", "node", (2, 8), "100000 mm");
    let far = "[[edges]]\nnodes = [[0, 0], [1e300, 0], [0, -1e300]]\n";
    refused(far, "node", (2, 18), "not a place");
    refused("[[holes]]\nnode = [0]\ndiameter = 1\n", "board-file", (2, 8), "[x, y]");
    refused("[[holes]]\nnode = [0, 0]\ndiametr = 1\n", "board-file", (3, 1), "mean `diameter`");
    refused("[[holes]]\nnode = [0, 0]\n", "board-file", (1, 1), "`diameter` is missing");
    refused(
        "[[pads]]\nnode = [0, 0]\nshape = \"oval\"\nsize = 1\n",
        "board-file",
        (3, 9),
        "`octagon`",
    );
    let track =
        |nodes: &str| format!("[nodes]\nvcc = [0, 0]\n[[tracks]]\nnodes = {nodes}\nwidth = 1\n");
    refused(&track("[\"vc\", [1, 1]]"), "node-unknown", (4, 10), "did you mean `vcc`");
    refused(&track("[\"U1.vcc\", [1, 1]]"), "node-unknown", (4, 10), "U1.vcc");
    refused(&track("[\"vcc\"]"), "node", (3, 1), "two nodes or more");
    refused(&track("[\"vcc\", [0, 0]]"), "node", (3, 1), "without length");
    refused("nodes = { \"a.b\" = [0, 0] }\n", "node", (1, 19), "`a.b`");
    refused("[[groups]]\nrotation = inf\n", "angle", (2, 12), "inf degrees");
    let twice = "[[groups]]\nname = \"a\"\n[[groups]]\nname = \"a\"\n";
    refused(twice, "group", (3, 1), "two groups");
    refused("[[edges]]\nnodes = [[0, 0], [1, 0]]\n", "node", (1, 1), "three nodes");
    let crossing = "[[edges]]\nnodes = [[0, 0], [2, 2], [2, 0], [0, 2]]\n";
    refused(crossing, "outline-crosses", (0, 0), "X 1.0000 Y 1.0000");
    refused("\u{feff}x", "board-file", (1, 3), "");
    let errors = model::read("board.toml", b"name = \"\xff\"").unwrap_err();
    assert_eq!((errors[0].rule.name(), errors[0].line), ("board-file", 1));
}

#[test]
fn errors_of_json_have_their_places() {
    refused("{\n  \"holes\": [{\"node\": [0, 0], \"diameter\": -1}]\n}", "width", (2, 42), "-1 mm");
    refused("{\n \"pads\": [{\"node\": \"x\",\n", "board-file", (3, 1), "JSON");
    refused("{\"holes\": [{\"node\": \"xé\", \"diameter\": 1}]}", "node-unknown", (1, 21), "xé");
    refused("{\"hols\": []}", "board-file", (1, 3), "`holes`");
    refused("{\"name\": \"a\", \"name\": \"b\"}", "board-file", (1, 16), "twice");
    refused("{\"name\": null}", "board-file", (1, 10), "null");
    refused("{\"holes\": [{\"node\": [1e400, 0], \"diameter\": 1}]}", "board-file", (1, 22), "");
}

#[test]
fn depth_is_bounded() {
    let nested = |depth: usize| {
        let (open, close) = ("{\"groups\":[", "]}");
        let hole = "{\"holes\":[{\"node\":[0,0],\"diameter\":1}]}";
        open.repeat(depth) + hole + &close.repeat(depth)
    };
    assert_eq!(board(&nested(64)).holes.len(), 1);
    for depth in [65, 70, 100, 100_000] {
        let errors = read(&nested(depth)).unwrap_err();
        assert!(["group", "board-file"].contains(&errors[0].rule.name()), "{errors:#?}");
    }
    let header = |depth: usize| {
        let path = vec!["groups"; depth].join(".");
        format!("[[{path}]]\n[[{path}.holes]]\nnode = [0, 0]\ndiameter = 1\n")
    };
    let dotted: String = (1..=64).map(header).collect();
    assert_eq!(board(&dotted).holes.len(), 64);
    assert!(read(&"[".repeat(100_000)).is_err());
    assert!(read(&format!("nodes = {}", "{a=".repeat(100_000))).is_err());
}

proptest! {
    #[test]
    fn nothing_makes_it_panic(text in "(?s).{0,200}", head in 0..3usize) {
        let heads = ["", "{\"holes\":[", "[[pads]]\n"];
        let _ = read(&(heads[head].to_owned() + &text));
    }

    #[test]
    fn a_turned_group_is_a_turned_board(x in -50.0..50.0f64, y in -50.0..50.0f64, degrees in -720.0..720.0f64) {
        let text = format!(
            "[[groups]]\nrotation = {degrees}\n[[groups.pads]]\nnode = [{x}, {y}]\nshape = \"square\"\nsize = 2\n"
        );
        let board = board(&text);
        let region = &copper(&board, Face::Front).region;
        let turn = Vec2::from_angle(degrees.to_radians());
        // Just within and just beyond a corner and a side of the square.
        for (out, inside) in [((0.99, 0.99), true), ((1.01, 0.0), false), ((0.99, -0.5), true)] {
            let place = turn.rotate(Vec2::new(x + out.0, y + out.1));
            prop_assert_eq!(region.contains(place), inside);
        }
        prop_assert!((region.area() - 4.0).abs() < 1e-5);
    }
}
