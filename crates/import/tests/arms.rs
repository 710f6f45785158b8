//! Arms: the URDF files of others come to the lengths that the specification states for them, and what is no arm is refused.

use arm::{Arm, Coupling, Joints, Spherical, Structure};
use std::fs;
use std::path::PathBuf;
use toolpost_import::{Import, import_calibration, import_urdf};

/// An arm in order: shoulder, elbow, wrist, one right angle of 3.1416 radians, a lever next to it.
const ARM: &str = r#"<robot name="small arm">
  <link name="foot"/><link name="base"/><link name="tool0"/>
  <joint name="j1" type="revolute"><origin xyz="0 0 0.4"/><parent link="foot"/><child link="l1"/>
    <axis xyz="0 0 -1"/><limit lower="-2.967059728" upper="2.967059728" velocity="6.283185307"/></joint>
  <joint name="j2" type="revolute"><origin xyz="0.025 0 0"/><parent link="l1"/><child link="l2"/>
    <axis xyz="0 1 0"/><limit lower="-3.3" upper="0.8" velocity="5"/></joint>
  <joint name="j3" type="revolute"><origin xyz="0.455 0 0"/><parent link="l2"/><child link="l3"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2.7" velocity="5"/></joint>
  <joint name="j4" type="revolute"><origin xyz="0 0 0.035"/><parent link="l3"/><child link="l4"/>
    <axis xyz="-1 0 0"/><limit lower="-3.2" upper="3.2" velocity="5"/></joint>
  <joint name="j5" type="revolute"><origin xyz="0.42 0 0"/><parent link="l4"/><child link="l5"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="5"/></joint>
  <joint name="j6" type="revolute"><origin xyz="0.08 0 0"/><parent link="l5"/><child link="l6"/>
    <axis xyz="-1 0 0"/><limit lower="-6.1" upper="6.1" velocity="10"/></joint>
  <joint name="end" type="fixed"><origin rpy="0 1.570796 0"/><parent link="l6"/><child link="tool0"/></joint>
  <joint name="world" type="fixed"><parent link="foot"/><child link="base"/></joint>
  <joint name="lever" type="continuous"><parent link="l2"/><child link="rod"/></joint>
</robot>
"#;

fn said(import: &Import) -> String {
    import.findings.iter().map(|finding| format!("{finding}\n")).collect()
}

fn arm_of(import: &Import) -> Arm {
    let machine = machine::load_text("arm.toml", &import.text)
        .unwrap_or_else(|why| panic!("{why}\n{}", import.text));
    machine.arm.unwrap()
}

fn refusal(text: &str, reach: Option<f64>) -> String {
    let errors = import_urdf("arm.urdf", text.as_bytes(), reach).unwrap_err();
    errors.iter().map(|error| format!("{error}\n")).collect()
}

#[test]
fn a_description_becomes_an_arm_and_what_it_does_not_say_is_left_open() {
    let import = import_urdf("arm.urdf", ARM.as_bytes(), Some(901.5)).unwrap();
    let arm = arm_of(&import);
    let Structure::Spherical(lengths) = arm.structure() else { panic!("{arm:?}") };
    let Spherical { a1, a2, b, c1, c2, c3, c4, offsets, signs } = lengths;
    assert_eq!([*a1, *a2, *b, *c1, *c2, *c3, *c4], [25.0, -35.0, 0.0, 400.0, 455.0, 420.0, 80.0]);
    assert_eq!(offsets.map(f64::to_degrees), [0.0, -90.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(*signs, [-1.0, 1.0, 1.0, -1.0, 1.0, -1.0]);
    assert_eq!((arm.coupling(), arm.joints()[0].max.to_degrees()), (None, 170.0));
    let said = said(&import);
    assert!(said.contains("arm.urdf:15: warning[arm-snapped]: joint `end`"), "{said}");
    assert!(
        said.contains("arm.urdf:17: warning[arm-branch]: joint `lever` with link `rod`"),
        "{said}"
    );
    assert!(said.contains("warning[arm-coupling]") && !said.contains("arm-reach"), "{said}");
    // Without a stated reach it says what to compare.
    let import = import_urdf("arm.urdf", ARM.as_bytes(), None).unwrap();
    assert!(
        self::said(&import).contains("reaches 901.5 mm to the wrist centre"),
        "{}",
        self::said(&import)
    );
}

#[test]
fn what_is_no_arm_is_refused_with_its_line() {
    let refused = |from: &str, to: &str, what: &str| {
        assert!(ARM.contains(from), "{from}");
        let shown = refusal(&ARM.replacen(from, to, 1), None);
        assert!(shown.starts_with("arm.urdf:") && shown.contains(what), "{from}: {shown}");
    };
    assert!(
        refusal(ARM, Some(1101.0))
            .contains("reaches 901.5 mm to the wrist centre, and 1101 mm are stated")
    );
    // A joint is missing.
    let (before, after) =
        (ARM.find("  <joint name=\"j4\"").unwrap(), ARM.find("  <joint name=\"j5\"").unwrap());
    let missing = format!("{}{}", &ARM[..before], &ARM[after..]);
    assert!(
        refusal(&missing, None).contains("these links hang on nothing: foot, l4"),
        "{}",
        refusal(&missing, None)
    );
    refused(
        "<parent link=\"foot\"/><child link=\"l1\"/>",
        "<parent link=\"tool0\"/><child link=\"l1\"/>",
        "goes round in a circle",
    );
    refused(
        "type=\"fixed\"><origin rpy=\"0 1.570796 0\"/>",
        "type=\"floating\"><origin rpy=\"0 1.570796 0\"/>",
        "is floating",
    );
    refused(
        "name=\"j5\" type=\"revolute\"",
        "name=\"j5\" type=\"fixed\"",
        "5 joints turn between the foot and the flange",
    );
    refused(
        "name=\"j5\" type=\"revolute\"",
        "name=\"j5\" type=\"revolut\"",
        "did you mean `revolute`?",
    );
    refused(
        "<child link=\"rod\"/>",
        "<child link=\"l4\"/>",
        "link `l4` hangs on two joints, `j4` and `lever`",
    );
    refused("xyz=\"0.42 0 0\"", "xyz=\"0.42 0\"", "is not three numbers");
    refused("xyz=\"0.42 0 0\"", "xyz=\"0.42 0 1e9\"", "is not three numbers");
    refused("xyz=\"0.42 0 0\"", "xyz=\"0.42 0.02 0\"", "do not meet in one point");
    refused(
        "<axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2.7\"",
        "<axis xyz=\"0 1 0.1\"/><limit lower=\"-2\" upper=\"2.7\"",
        "not parallel to axis 3",
    );
    refused(
        "<axis xyz=\"0 0 -1\"/>",
        "<axis xyz=\"0 0 0\"/>",
        "the axis of joint `j1` has no direction",
    );
    refused("velocity=\"10\"", "", "says no `velocity`");
    refused("velocity=\"10\"", "velocity=\"6.1e3\"", "hold nothing");
    refused("xyz=\"0.42 0 0\"", "xyz=\"42 0 0\"", "a description has its lengths in metres");
    refused("<limit lower=\"-3.2\" upper=\"3.2\" velocity=\"5\"/>", "", "joint `j4` has no limit");
    refused("lower=\"-3.2\" upper=\"3.2\"", "lower=\"3.2\" upper=\"3.2\"", "hold nothing");
    refused(
        "<joint name=\"world\"",
        "<joint name=\"world\" type=\"prismatic\" a=\"",
        "this is no XML",
    );
    refused("<child link=\"base\"/>", "<child link=\"stand\"/>", "there is no link `base`");
    refused("rpy=\"0 1.570796 0\"", "rpy=\"0 0 0\"", "its Z out of the arm");
    refused("<robot name=\"small arm\">", "<xacro name=\"small arm\">", "this is no XML");
    for empty in ["", "<robot/>", "<a/>", "\u{0}"] {
        assert!(refusal(empty, None).contains("arm.urdf:"), "{}", refusal(empty, None));
    }
    let errors = import_urdf("arm.urdf", &[b' '; (4 << 20) + 1], None).unwrap_err();
    assert!(errors[0].message.contains("more than any description"), "{}", errors[0]);
    assert!(import_urdf("arm.urdf", &[b'<', 0xff], None).unwrap_err()[0].message.contains("UTF-8"));
}

fn data(file: &str) -> Option<PathBuf> {
    Some(judge::data("robots")?.join(file))
}

/// Each file of the real input, the arm of the library that it has to be like, and the reach of its data sheet.
const FILES: [(&str, &str, Option<f64>); 12] = [
    ("abb-irb120-3-58", "abb-irb120", Some(580.0)),
    ("abb-irb2400-12-155", "abb-irb2400", Some(1550.0)),
    ("abb-irb6700-235-265", "abb-irb6700-235-265", Some(2650.0)),
    ("fanuc-lrmate-200id", "fanuc-lrmate-200id", Some(717.0)),
    ("fanuc-m20ia", "fanuc-m20ia", Some(1811.0)),
    ("fanuc-r2000ic-165f", "fanuc-r2000ic-165f", Some(2655.0)),
    ("kuka-kr10-r1100-2", "kuka-kr10-r1100-2", Some(1101.0)),
    ("kuka-kr120-r2700-2", "kuka-kr120-r2700-2", Some(2701.0)),
    ("kuka-kr6-r900-sixx", "kuka-kr6-r900-sixx", Some(901.5)),
    ("staubli-tx60", "staubli-tx60", None),
    ("ur5e", "ur5e", None),
    ("ur10e", "ur10e", None),
];

#[test]
fn the_urdf_files_of_the_makers_arms_come_to_the_arms_of_the_library() {
    for (file, name, reach) in FILES {
        let Some(path) = data(&format!("urdf/{file}.urdf")) else { return };
        let import = import_urdf(file, &fs::read(path).unwrap(), reach);
        let import = import.unwrap_or_else(|errors| panic!("{file}: {}", errors[0]));
        let (ours, theirs) = (machine::load(name).unwrap().arm.unwrap(), arm_of(&import));
        assert_eq!(ours.structure(), theirs.structure(), "{file}\n{}", import.text);
        assert_eq!(ours.world_height(), theirs.world_height(), "{file}");
        for i in 0..6 {
            let (a, b) = (ours.joints()[i], theirs.joints()[i]);
            // Some round radians to two decimals; joint 3 of the M-20iA ends at 273.12 degrees there, at 273 in the library; the elbow of Universal Robots is halved.
            let near = |a: f64, b: f64| (a - b).abs() < 3e-3 || (i == 2 && name.starts_with("ur"));
            assert!(
                near(a.min, b.min) && near(a.max, b.max) && (a.speed - b.speed).abs() < 1e-3,
                "{file} {i}"
            );
        }
        let said = said(&import);
        assert_eq!(
            said.contains("arm-branch"),
            ["abb-irb2400", "abb-irb6700-235-265"].contains(&name),
            "{said}"
        );
        assert_eq!(said.contains("arm-snapped"), name.contains("kr120"), "{file}: {said}");
    }
}

#[test]
fn a_calibration_of_universal_robots_becomes_an_arm_that_extends_the_nominal_one() {
    let nominal = machine::load("ur5e").unwrap().arm.unwrap();
    let Some(path) = data("ur/ur5e_default_kinematics.yaml") else { return };
    let text = fs::read_to_string(path).unwrap();
    let read =
        |text: &str, extends| import_calibration("calibration.yaml", text.as_bytes(), extends);
    let import = read(&text, Some("ur5e")).unwrap();
    let arm = arm_of(&import);
    assert!(matches!(arm.structure(), Structure::Ur(_, Some(_))));
    let joints: Joints = [0.4, -1.1, 1.3, -0.2, 0.9, 2.0];
    // The file of the maker is the nominal arm.
    assert!(arm.flange(&joints).translation.distance(nominal.flange(&joints).translation) < 1e-5);
    assert_eq!(arm.coupling(), Some(Coupling::None));
    // A shoulder two tenths higher.
    let import = read(&text.replacen("z: 0.1625", "z: 0.1627", 1), Some("ur5e")).unwrap();
    let off = arm_of(&import).flange(&joints).translation - arm.flange(&joints).translation;
    assert!((off.z - 0.2).abs() < 1e-6, "{off}");
    assert!(said(&import).contains("up to 0.200 mm from `ur5e`"), "{}", said(&import));
    let refused = |text: &str, extends, what: &str| {
        let errors = read(text, extends).unwrap_err();
        let shown: String = errors.iter().map(|error| format!("{error}\n")).collect();
        assert!(shown.contains(what), "{shown}");
    };
    refused(&text, None, "--extends");
    refused(&text, Some("ur10e"), "mm from `ur10e`");
    refused(&text, Some("kuka-kr6-r900-sixx"), "no arm of Universal Robots");
    refused(&text, Some("nonesuch"), "`nonesuch` is not in the library");
    refused(&text.replacen("  forearm:", "  forarm:", 1), Some("ur5e"), "did you mean `forearm`?");
    refused(
        &text.replacen("    roll: 0\n", "", 1),
        Some("ur5e"),
        "`roll` of `shoulder` is missing",
    );
    refused(&text.replacen("    x: 0\n", "    x: 0\n    x: 0\n", 1), Some("ur5e"), "said twice");
    refused(&text.replacen("x: 0\n", "x: nought\n", 1), Some("ur5e"), "`nought` is no number");
    refused(&text.replacen("x: 0\n", "x: nan\n", 1), Some("ur5e"), "`nan` is no number");
    refused("kinematics\n", Some("ur5e"), "no `key: value`");
    refused("x: 1\n", Some("ur5e"), "belongs to no link");
    refused("", Some("ur5e"), "`x` of `shoulder` is missing");
}
