//! URDF: links and joints as a tree, and the chain of six revolute joints in it.

use super::{RIGHT, Read, fail};
use arm::{Frame, Vec3};
use geom::{Euler, direction};
use program::{Diagnostic, Rule, nearest};
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

/// The most elements that a description has.
const MOST_NODES: u32 = 100_000;

/// The way out of an angle that was snapped.
const SNAPPED: &str = "write it with more digits where it is meant otherwise: right angles are taken for what is within 0.0001 rad";

/// What a description comes to.
pub(super) struct Urdf {
    pub(super) name: String,
    pub(super) chain: Chain,
    /// Snapped angles, and branches that are left out.
    pub(super) findings: Vec<Diagnostic>,
}

/// The way from the foot to the flange; lengths are mm.
pub(super) struct Chain {
    pub(super) joints: Vec<Revolute>,
    /// The flange in the frame of the last joint.
    pub(super) flange: Frame,
    /// The controller's world in the frame of the foot.
    pub(super) world: Frame,
}

/// A joint that turns.
pub(super) struct Revolute {
    /// In the frame of the joint before it, or of the foot.
    pub(super) frame: Frame,
    /// Unit vector, in its own frame.
    pub(super) axis: Vec3,
    /// Radians.
    pub(super) min: f64,
    pub(super) max: f64,
    /// Radians/s.
    pub(super) speed: f64,
}

/// A joint as it stands in the file.
struct Joint<'a> {
    name: &'a str,
    kind: &'a str,
    parent: &'a str,
    child: &'a str,
    frame: Frame,
    node: Node<'a, 'a>,
    line: u32,
}

fn wrong(line: u32, message: impl Into<String>) -> Diagnostic {
    let help = "correct the description there: one foot, six revolute joints with limits in a row, a link `tool0` at the flange";
    Diagnostic::error(Rule::Urdf, message).line(line).help(help)
}

/// The chain of a description.
pub(super) fn read(text: &str) -> Read<Urdf> {
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| wrong(error.pos().row, format!("this is no XML: {error}")))?;
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        return fail(
            wrong(1, "the first element is not `robot`")
                .help("expand xacro first: `xacro arm.xacro > arm.urdf`"),
        );
    }
    let lines = Lines::of(text);
    let mut findings = Vec::new();
    let mut joints = Vec::new();
    for node in robot.children().filter(|node| node.has_tag_name("joint")) {
        joints.push(joint(node, &lines, &mut findings)?);
    }
    let tree = Tree::new(&joints)?;
    let tip = tree.tip()?;
    let way = tree.way(tip)?;
    findings.extend(tree.left_out(&way));
    let world = tree.world(&way)?;
    let chain = chain(&way, world, &mut findings)?;
    let name = robot.attribute("name").unwrap_or_default().to_owned();
    Ok(Urdf { name, chain, findings })
}

/// Where the lines of a description end. The document itself counts from its start for every line that it is asked for.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Lines {
        Lines(text.match_indices('\n').map(|(at, _)| at).collect())
    }

    /// The line on which an element begins.
    fn line_of(&self, node: Node<'_, '_>) -> u32 {
        let before = self.0.partition_point(|end| *end < node.range().start);
        u32::try_from(before + 1).unwrap_or(u32::MAX)
    }
}

/// The line on which an element begins, for the one error that ends the reading.
fn line_of(node: Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

fn joint<'a>(node: Node<'a, 'a>, lines: &Lines, findings: &mut Vec<Diagnostic>) -> Read<Joint<'a>> {
    let line = lines.line_of(node);
    let name = node.attribute("name").unwrap_or_default();
    let link = |tag: &str| {
        let found = node.children().find(|child| child.has_tag_name(tag));
        let found = found.and_then(|child| child.attribute("link"));
        found.ok_or_else(|| Box::new(wrong(line, format!("joint `{name}` has no `{tag}`"))))
    };
    let kind =
        node.attribute("type").ok_or_else(|| wrong(line, format!("joint `{name}` has no type")))?;
    const KINDS: [&str; 6] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"];
    if !KINDS.contains(&kind) {
        let meant = nearest(kind, KINDS.into_iter());
        let help = if meant.is_empty() {
            format!("there are {}", KINDS.join(", "))
        } else {
            format!("did you mean {meant}?")
        };
        return fail(wrong(line, format!("joint `{name}` is of no type `{kind}`")).help(help));
    }
    let frame = origin(node, name, lines, findings)?;
    Ok(Joint { name, kind, parent: link("parent")?, child: link("child")?, frame, node, line })
}

/// The frame of a joint in that of the link before it.
fn origin(
    node: Node<'_, '_>,
    name: &str,
    lines: &Lines,
    findings: &mut Vec<Diagnostic>,
) -> Read<Frame> {
    let Some(origin) = node.children().find(|child| child.has_tag_name("origin")) else {
        return Ok(Frame::IDENTITY);
    };
    let at = three(origin, "xyz")?.unwrap_or([0.0; 3]).map(|metres| metres * 1000.0);
    let mut turns = three(origin, "rpy")?.unwrap_or([0.0; 3]);
    for turn in &mut turns {
        let (right, off) = snapped(*turn);
        if off > 1e-9 {
            let message = format!(
                "joint `{name}`: {turn} rad is taken for {} degrees, from which it is {off:.1e} rad",
                (right.to_degrees()).round()
            );
            findings.push(
                Diagnostic::warning(Rule::ArmSnapped, message)
                    .line(lines.line_of(origin))
                    .help(SNAPPED),
            );
        }
        *turn = right;
    }
    Ok(Frame::from_mat3_translation(exact(Euler::FixedXyz.matrix(turns)), Vec3::from_array(at)))
}

/// The right angle near an angle, and how far it is from that; the angle itself where none is near.
fn snapped(angle: f64) -> (f64, f64) {
    let right = (angle / FRAC_PI_2).round() * FRAC_PI_2;
    let off = (angle - right).abs();
    if off <= RIGHT { (right, off) } else { (angle, 0.0) }
}

/// Rotations by right angles without the rounding of sines.
fn exact(rotation: geom::Mat3) -> geom::Mat3 {
    let clean = |part: f64| if (part - part.round()).abs() < 1e-12 { part.round() } else { part };
    geom::Mat3::from_cols_array(&rotation.to_cols_array().map(clean))
}

/// Three numbers of an attribute.
fn three(node: Node<'_, '_>, attribute: &str) -> Read<Option<[f64; 3]>> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    let numbers: Vec<f64> =
        text.split_whitespace().map_while(|number| number.parse().ok()).collect();
    let count = text.split_whitespace().count();
    match <[f64; 3]>::try_from(numbers) {
        Ok(numbers) if count == 3 && numbers.iter().all(|number| number.abs() <= 1e3) => {
            Ok(Some(numbers))
        }
        _ => {
            let message = format!(
                "`{attribute}=\"{text}\"` is not three numbers up to 1000 (metres, radians)"
            );
            fail(wrong(line_of(node), message))
        }
    }
}

/// Joints by the links that they carry.
struct Tree<'a> {
    joints: &'a [Joint<'a>],
    by_child: BTreeMap<&'a str, &'a Joint<'a>>,
    root: &'a str,
}

impl<'a> Tree<'a> {
    fn new(joints: &'a [Joint<'a>]) -> Read<Tree<'a>> {
        let mut by_child = BTreeMap::new();
        for joint in joints {
            if let Some(other) = by_child.insert(joint.child, joint) {
                let message = format!(
                    "link `{}` hangs on two joints, `{}` and `{}`",
                    joint.child, other.name, joint.name
                );
                return fail(wrong(joint.line, message));
            }
        }
        let roots: BTreeSet<&str> = joints
            .iter()
            .map(|joint| joint.parent)
            .filter(|link| !by_child.contains_key(link))
            .collect();
        let roots: Vec<&str> = roots.into_iter().collect();
        match roots[..] {
            [root] => Ok(Tree { joints, by_child, root }),
            [] if joints.is_empty() => fail(wrong(1, "there is no joint in it")),
            [] => {
                fail(wrong(joints[0].line, "the joints go round in a circle: no link is the foot"))
            }
            _ => fail(wrong(
                1,
                format!(
                    "these links hang on nothing: {}; one of them is the foot",
                    roots.join(", ")
                ),
            )),
        }
    }

    /// The joints from the root to a link.
    fn way(&self, link: &str) -> Read<Vec<&'a Joint<'a>>> {
        let mut way = Vec::new();
        let mut here = link;
        while let Some(joint) = self.by_child.get(here) {
            if way.len() > self.joints.len() {
                return fail(wrong(
                    joint.line,
                    format!("joint `{}` goes round in a circle", joint.name),
                ));
            }
            way.push(*joint);
            here = joint.parent;
        }
        way.reverse();
        Ok(way)
    }

    /// The link of the flange: `tool0`, or the end of the only way with six joints that turn.
    fn tip(&self) -> Read<&'a str> {
        if let Some(joint) = self.by_child.get("tool0") {
            return Ok(joint.child);
        }
        let parents: BTreeSet<&str> = self.joints.iter().map(|joint| joint.parent).collect();
        let mut tips = Vec::new();
        for joint in self.joints.iter().filter(|joint| !parents.contains(joint.child)) {
            if self.way(joint.child)?.iter().filter(|joint| joint.kind != "fixed").count() == 6 {
                tips.push(joint.child);
            }
        }
        match tips[..] {
            [tip] => Ok(tip),
            [] => fail(wrong(
                1,
                "no way from the foot has six joints that move, and there is no link `tool0`",
            )),
            _ => fail(
                wrong(1, format!("several links may be the flange: {}", tips.join(", ")))
                    .help("call the flange `tool0`, its Z out of the arm"),
            ),
        }
    }

    /// What moves and is not on the way.
    fn left_out(&self, way: &[&Joint<'a>]) -> Vec<Diagnostic> {
        let on_way: BTreeSet<&str> = way.iter().map(|joint| joint.name).collect();
        let moves = |joint: &&Joint<'a>| joint.kind != "fixed" && !on_way.contains(joint.name);
        let said = |joint: &Joint<'a>| {
            let message = format!(
                "joint `{}` with link `{}` is not in the chain from `{}` to the flange, and left out",
                joint.name, joint.child, self.root
            );
            Diagnostic::warning(Rule::ArmBranch, message)
                .line(joint.line)
                .help("it moves nothing that carries the flange: compare the reach")
        };
        self.joints.iter().filter(moves).map(said).collect()
    }

    /// The controller's world, which ROS-Industrial calls `base`.
    fn world(&self, way: &[&Joint<'a>]) -> Read<Frame> {
        if self.root == "base"
            || way.iter().any(|joint| joint.child == "base" || joint.parent == "base")
        {
            return Ok(Frame::IDENTITY);
        }
        let help = "where its maker puts the origin: <link name=\"base\"/>, and a fixed joint to it from the foot";
        if !self.by_child.contains_key("base") {
            let message = "there is no link `base`: where the controller's world lies is not known";
            return fail(wrong(1, message).help(help));
        }
        let to_base = self.way("base")?;
        match to_base.iter().find(|joint| joint.kind != "fixed") {
            Some(joint) => {
                fail(wrong(joint.line, "the link `base` moves against the foot").help(help))
            }
            None => Ok(to_base.iter().fold(Frame::IDENTITY, |frame, joint| frame * joint.frame)),
        }
    }
}

/// Fixed joints multiplied into the six that turn.
fn chain(way: &[&Joint<'_>], world: Frame, findings: &mut Vec<Diagnostic>) -> Read<Chain> {
    let (mut joints, mut frame) = (Vec::new(), Frame::IDENTITY);
    for joint in way {
        frame *= joint.frame;
        match joint.kind {
            "fixed" => {}
            "revolute" => {
                joints.push(revolute(joint, frame, findings)?);
                frame = Frame::IDENTITY;
            }
            kind => {
                let message = format!(
                    "joint `{}` on the way to the flange is {kind}, and every joint of an arm is revolute, with limits",
                    joint.name
                );
                return fail(wrong(joint.line, message));
            }
        }
    }
    match joints.len() {
        6 => Ok(Chain { joints, flange: frame, world }),
        count => {
            let line = way.first().map_or(1, |joint| joint.line);
            fail(wrong(
                line,
                format!("{count} joints turn between the foot and the flange, and an arm has six"),
            ))
        }
    }
}

fn revolute(joint: &Joint<'_>, frame: Frame, findings: &mut Vec<Diagnostic>) -> Read<Revolute> {
    let child = |tag: &str| joint.node.children().find(|child| child.has_tag_name(tag));
    let axis = match child("axis") {
        Some(axis) => three(axis, "xyz")?.unwrap_or([1.0, 0.0, 0.0]),
        None => [1.0, 0.0, 0.0],
    };
    let axis = direction(Vec3::from_array(axis)).ok_or_else(|| {
        wrong(joint.line, format!("the axis of joint `{}` has no direction", joint.name))
    })?;
    let clean = exact_axis(axis);
    let off = geom::angle_between(axis, clean);
    if off > 1e-9 {
        let message =
            format!("joint `{}`: the axis is turned by {off:.1e} rad to a right angle", joint.name);
        findings
            .push(Diagnostic::warning(Rule::ArmSnapped, message).line(joint.line).help(SNAPPED));
    }
    let limit = child("limit")
        .ok_or_else(|| wrong(joint.line, format!("joint `{}` has no limit", joint.name)))?;
    let number = |attribute: &str| {
        let value = limit.attribute(attribute).and_then(|text| text.trim().parse::<f64>().ok());
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            let message = format!("the limit of joint `{}` says no `{attribute}`", joint.name);
            Box::new(wrong(line_of(limit), message))
        })
    };
    let (min, max, speed) = (number("lower")?, number("upper")?, number("velocity")?);
    // A twentieth of a degree, a degree in a minute and 150 revolutions a second are bounds of what a joint does.
    if max - min < 1e-3 || !(3e-4..=1e3).contains(&speed) {
        let message = format!(
            "the limits of joint `{}` hold nothing: lower {min}, upper {max}, velocity {speed}",
            joint.name
        );
        return fail(wrong(line_of(limit), message));
    }
    Ok(Revolute { frame, axis: clean, min, max, speed })
}

/// The direction of a frame near an axis, or the axis itself.
fn exact_axis(axis: Vec3) -> Vec3 {
    let near = Vec3::from_array(axis.to_array().map(f64::round));
    let is_one = near.length() == 1.0 && geom::angle_between(axis, near) <= RIGHT;
    if is_one { near } else { axis }
}
