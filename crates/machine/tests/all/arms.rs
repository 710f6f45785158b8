//! The arms of the library, figure by figure, and what a file of an arm is refused for.

use arm::{Coupling, Spherical, Structure};
use serde_json::Value;
use toolpost_machine::{library, load, load_text};

/// The file of each, and its name in `robots.json` of the real input.
const ARMS: [(&str, &str); 12] = [
    ("abb-irb120", "abb-irb120-3-58"),
    ("abb-irb2400", "abb-irb2400-12-155"),
    ("abb-irb6700-235-265", "abb-irb6700-235-265"),
    ("fanuc-lrmate-200id", "fanuc-lrmate-200id"),
    ("fanuc-m20ia", "fanuc-m20ia"),
    ("fanuc-r2000ic-165f", "fanuc-r2000ic-165f"),
    ("kuka-kr10-r1100-2", "kuka-kr10-r1100-2"),
    ("kuka-kr120-r2700-2", "kuka-kr120-r2700-2"),
    ("kuka-kr6-r900-sixx", "kuka-kr6-r900-sixx"),
    ("staubli-tx60", "staubli-tx60"),
    ("ur10e", "ur10e"),
    ("ur5e", "ur5e"),
];

#[test]
fn every_arm_of_the_library_is_listed_here_and_loads() {
    let names: Vec<&str> = library::names(library::ARMS).collect();
    assert_eq!(names, ARMS.map(|(name, _)| name));
    for name in names {
        let machine = load(name).unwrap();
        assert!(machine.arm.is_some() && !machine.has_control(), "{name}");
        // None of the mills is found under it, and none of the arms among the mills.
        assert!(library::find(name, library::MACHINES).is_none(), "{name}");
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn every_figure_of_an_arm_is_that_of_its_source() {
    let Some(folder) = judge::data("robots") else { return };
    let text = std::fs::read_to_string(folder.join("robots.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    for (name, id) in ARMS {
        let arm = load(name).unwrap().arm.unwrap();
        let source = all["robots"].as_array().unwrap().iter().find(|arm| arm["id"] == id).unwrap();
        let stated = |table: &str, key: &str| number(&source[table][key]);
        match arm.structure() {
            Structure::Spherical(Spherical { a1, a2, b, c1, c2, c3, c4, offsets, signs }) => {
                let ours = [
                    ("a1", a1),
                    ("a2", a2),
                    ("b", b),
                    ("c1", c1),
                    ("c2", c2),
                    ("c3", c3),
                    ("c4", c4),
                ];
                for (key, length) in ours {
                    assert_eq!(*length, stated("opw_mm", key), "{name} {key}");
                }
                for i in 0..6 {
                    let offset = number(&source["opw_offsets_deg"][i]);
                    assert_eq!(offsets[i], offset.to_radians(), "{name} {i}");
                    assert_eq!(signs[i], number(&source["opw_signs"][i]), "{name} {i}");
                }
            }
            Structure::Ur(dh, None) => {
                let ours = [
                    ("d1", dh.d1),
                    ("a2", dh.a2),
                    ("a3", dh.a3),
                    ("d4", dh.d4),
                    ("d5", dh.d5),
                    ("d6", dh.d6),
                ];
                for (key, length) in ours {
                    assert_eq!(length, stated("dh_mm", key), "{name} {key}");
                }
            }
            Structure::Ur(_, Some(_)) => panic!("{name} is calibrated"),
        }
        assert_eq!(arm.world_height(), number(&source["world_origin_above_base_mm"]), "{name}");
        let coupling = match (source["maker"].as_str(), id) {
            (Some("fanuc"), _) => Some(Coupling::LessJoint2),
            // Asked for, never assumed.
            (_, "abb-irb2400-12-155") => None,
            _ => Some(Coupling::None),
        };
        assert_eq!(arm.coupling(), coupling, "{name}");
        for (i, joint) in arm.joints().iter().enumerate() {
            let near =
                |ours: f64, theirs: &Value| (ours.to_degrees() - number(theirs)).abs() < 1e-4;
            let limits = &source["limits_deg"][i];
            assert!(near(joint.min, &limits[0]) && near(joint.max, &limits[1]), "{name} {i}");
            assert!(near(joint.speed, &source["velocity_deg_s"][i]), "{name} {i}");
            let published = source.get("acceleration_deg_s2").map(|table| &table["values"][i]);
            assert_eq!(joint.acceleration.is_some(), published.is_some(), "{name} {i}");
            assert!(
                published.is_none_or(|rate| near(joint.acceleration.unwrap(), rate)),
                "{name} {i}"
            );
        }
    }
}

const ARM: &str = r#"[arm]
lengths = { a1 = 25, a2 = -35, b = 0, c1 = 400, c2 = 455, c3 = 420, c4 = 80 }
offsets = [0, -90, 0, 0, 0, 0]
signs = [-1, 1, 1, -1, 1, -1]
coupling = "none"
world_height = 0
reach = 901.5
joints = [
    { min = -170, max = 170, speed = 360 },
    { min = -190, max = 45, speed = 300 },
    { min = -120, max = 156, speed = 360 },
    { min = -185, max = 185, speed = 381 },
    { min = -120, max = 120, speed = 388 },
    { min = -350, max = 350, speed = 615 },
]
"#;

fn refusal(text: &str) -> String {
    load_text("arm.toml", text).unwrap_err().to_string()
}

#[test]
fn what_does_not_make_an_arm_is_refused_at_its_place() {
    let refused = |from: &str, to: &str, what: &str| {
        assert!(ARM.contains(from), "{from}");
        let shown = refusal(&ARM.replacen(from, to, 1));
        assert!(shown.starts_with("arm.toml:") && shown.contains(what), "{from}: {shown}");
    };
    refused(
        "reach = 901.5",
        "reach = 930",
        "its lengths reach 901.5 mm, and `reach` states 930 mm",
    );
    refused("c2 = 455", "c2 = 0", "c2 is 0");
    refused(", c4 = 80", "", "`lengths.c4` is missing");
    refused("c4 = 80", "c5 = 80", "no key of this table is called `c5`");
    refused("world_height = 0\n", "", "`world_height` is missing");
    refused("offsets = [0, -90, 0, 0, 0, 0]\n", "", "`offsets` is missing");
    refused("-90, 0, 0, 0, 0]", "-900, 0, 0, 0, 0]", "six numbers from -360 to 360 degrees");
    refused("signs = [-1", "signs = [-2", "signs are 1 or -1");
    refused("coupling = \"none\"", "coupling = \"fanuc\"", "less-joint-2");
    refused("    { min = -170, max = 170, speed = 360 },\n", "", "six `joints` are needed, not 5");
    refused("max = 170", "max = -170", "joint 1: the lower limit is not below the upper one");
    refused("max = 170", "maximum = 170", "no key of this table is called `maximum`");
    refused("speed = 388", "speed = 0", "a number above 0");
    refused(", speed = 388", "", "`speed` of joint 5 in `joints` is missing");
    refused("world_height = 0\n", "world_height = 0\ncoupled_min = 1\n", "both or not at all");
    refused(
        "world_height = 0\n",
        "world_height = 0\ncoupled_min = 1\ncoupled_max = 2\n",
        "that `coupling` couples",
    );
    refused("world_height = 0\n", "world_height = 0\ncalibration = []\n", "an arm with `dh`");
    refused("[arm]\n", "[arm]\ndh = { d1 = 1 }\n", "one of `lengths` and `dh`");
    // A mill with an arm is neither: what has a control and an arm is a robot, with its cell.
    let both = format!("reader = \"grbl\"\n[wire]\nheight = 100\n{ARM}");
    assert!(refusal(&both).contains("it needs both"), "{}", refusal(&both));
}

#[test]
fn an_arm_of_ones_own_extends_another_and_changes_single_figures() {
    let text = "extends = \"ur5e\"\n[arm]\ncalibration = [\n[0, 0, 162.6, 0, 0, 0], [0, 0, 0, 90, 0, 0], \
                [-425.1, 0, 0, 0, 0, 0],\n[-392.2, 0, 133.3, 0, 0, 0], [0, -99.7, 0, 90, 0, 0], [0, 99.6, 0, 90, 180, 180]]\n";
    let arm = load_text("mine.toml", text).unwrap().arm.unwrap();
    let nominal = load("ur5e").unwrap().arm.unwrap();
    let joints = [0.3, -1.2, 1.4, -0.5, 0.7, 0.2];
    let off = arm.flange(&joints).translation.distance(nominal.flange(&joints).translation);
    // A tenth of a millimetre higher, a tenth longer.
    assert!(off > 0.05 && off < 0.25, "{off}");
    let shown = refusal(&text.replace("[0, 99.6, 0, 90, 180, 180]", ""));
    assert!(
        shown.starts_with("arm.toml:2:1: ") && shown.contains("six rows of six numbers"),
        "{shown}"
    );
    let limits = "extends = \"fanuc-lrmate-200id\"\n[arm]\ncoupled_min = -70\ncoupled_max = 120\n";
    let arm = load_text("mine.toml", limits).unwrap().arm.unwrap();
    assert!(arm.allows(&[0.0; 6]) && !arm.allows(&[0.0, 1.5, 0.0, 0.0, 0.0, 0.0]));
}

#[test]
fn a_rail_carries_the_foot_of_an_arm_and_its_figures_have_to_make_one() {
    let robot = |rail: &str| format!("extends = \"kuka-kr6-r900\"\n[cell]\nrail = {{ {rail} }}\n");
    let good = "direction = [0, -3, 0], origin = [100, 0, 600, 90, 0, 0], min = -500, max = 3000, speed = 90000, home = 250";
    let cell = load_text("mine.toml", &robot(good)).unwrap().cell.unwrap();
    let rail = cell.rail.unwrap();
    assert_eq!((rail.min, rail.max, rail.home, rail.speed), (-500.0, 3000.0, 250.0, 90_000.0));
    // By hand: 2 m along -Y, and what lies 1 m before the foot, which is turned by 90 degrees about Z, lies 1 m along Y.
    let foot = cell.foot(2000.0);
    let before = foot.transform_point3([1000.0, 0.0, 0.0].into());
    assert!(before.distance([100.0, -1000.0, 600.0].into()) < 1e-9, "{before}");
    // Without a rail the arm's world is that of the controller.
    let floor = load("kuka-kr6-r900").unwrap().cell.unwrap();
    assert_eq!(floor.foot(0.0).translation, [0.0; 3].into());
    for (from, to, what) in [
        ("[0, -3, 0]", "[0, 0, 0]", "`direction` has no length"),
        ("min = -500", "min = 3500", "`min` is below `max`"),
        ("home = 250", "home = 3001", "`home` between them"),
        ("speed = 90000", "speed = 0", "above 0"),
        (", home = 250", "", "`rail.home` is missing"),
        ("origin = [100, 0, 600, 90, 0, 0], ", "", "`rail.origin` is missing"),
        ("max = 3000", "most = 3000", "no key of this table is called `most`"),
    ] {
        let shown = refusal(&robot(&good.replace(from, to)));
        assert!(shown.contains(what), "{to}: {shown}");
    }
}
