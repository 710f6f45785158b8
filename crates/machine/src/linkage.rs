//! What carries what, for drawing a machine: its links, each moved by an axis on the one that carries it, and the bodies on them.
//!
//! **World.** mm, right-handed: of a mill its machine coordinates, with the gauge point of the spindle at the origin while all axes
//! stand at zero; of a wire the work frame; of a robot the world of its controller.
//!
//! **At zero.** Each body and each line of an axis is given where it is while all axes stand at zero. The matrix of a link brings what
//! is on it from there to where it is: that of the link that carries it, times the motion of its own axis. So a drawing needs the
//! positions of the axes alone.
//!
//! A linear axis whose file does not say `on` carries the tool: the part stands still. On either side Y carries X and X carries Z, and
//! the rotary axes are carried by these, in the order of the file.

use crate::model::{Body, Machine, Mount};
use geom::{Frame, Mat3, Vec3};
use serde::Serialize;
use std::f64::consts::{FRAC_PI_2, PI};

/// The links of a machine, its bodies, and where tool and part are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Linkage {
    /// What is positioned, in this order: X, Y, Z and the rotary axes of a mill; X, Y, Z, U and V of a wire; joints 1 to 6 and the rail of
    /// an arm.
    pub axes: Vec<Axis>,
    /// The first is the bed, which stands still; each other one comes behind the one that carries it.
    pub links: Vec<Link>,
    /// What is drawn.
    pub bodies: Vec<LinkBody>,
    /// Where the tool is held: the tip of a tool is its length below, along its Z.
    pub tool: Place,
    /// The work frame.
    pub part: Place,
}

/// An axis that is positioned.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// `X`, `A`, `U`, `J1`, `rail`.
    pub name: String,
    /// `mm` or `degrees`.
    pub unit: &'static str,
    /// Lower end of the travel; none where it has none.
    pub low: Option<f64>,
    /// Upper end of the travel.
    pub high: Option<f64>,
}

/// What an axis carries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Link {
    /// `bed`, or the axis that moves it.
    pub name: String,
    /// The link that carries it; none of the bed.
    pub on: Option<usize>,
    /// How it moves on that.
    pub kind: LinkKind,
    /// Unit vector along which it slides, or about which it turns right-handed.
    pub direction: [f64; 3],
    /// A point of the line about which it turns, mm.
    pub point: [f64; 3],
    /// Its amount, mm or degrees: `zero` and so many times the position of each of these axes.
    pub zero: f64,
    /// Place in [`Linkage::axes`], and the factor.
    pub terms: Vec<(usize, f64)>,
}

/// How a link moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinkKind {
    /// Not at all.
    Fixed,
    /// Along a vector.
    Slide,
    /// About a line.
    Turn,
}

/// A box on a link.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkBody {
    /// What it is called.
    pub name: String,
    /// The link.
    pub on: usize,
    /// Its corners, mm, while all axes stand at zero.
    pub low: [f64; 3],
    /// The opposite one.
    pub high: [f64; 3],
    /// Whether the machine's file gives it.
    pub is_given: bool,
}

/// A frame on a link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Place {
    /// The link.
    pub on: usize,
    /// Its unit vectors X, Y and Z and its origin (mm), in the world, while all axes stand at zero.
    pub frame: [[f64; 3]; 4],
}

impl Place {
    fn new(on: usize, frame: &Frame) -> Place {
        Place { on, frame: frame.to_cols_array_2d() }
    }

    /// Where it is with its link at this frame.
    fn at(&self, link: &Frame) -> Frame {
        *link * Frame::from_cols_array_2d(&self.frame)
    }
}

/// Half the width of bodies that no file gives, mm.
const HALF: f64 = 40.0;

/// How far below the work zero a table is drawn that no file gives, mm.
const BELOW: f64 = 60.0;

/// How far a table is drawn to each side at the most, mm.
const FARTHEST: f64 = 150.0;

impl Link {
    /// The bed, which stands still and is carried by nothing.
    pub fn bed() -> Link {
        Link {
            name: String::from("bed"),
            on: None,
            kind: LinkKind::Fixed,
            direction: [0.0; 3],
            point: [0.0; 3],
            zero: 0.0,
            terms: Vec::new(),
        }
    }
}

impl Linkage {
    /// That of a machine.
    pub fn of(machine: &Machine) -> Linkage {
        let mut linkage = match (&machine.arm, machine.wire) {
            (Some(arm), _) => Linkage::of_arm(machine, arm),
            (None, Some(_)) => Linkage::of_wire(machine),
            (None, None) => Linkage::of_mill(machine),
        };
        if !machine.bodies.is_empty() {
            linkage.bodies = Vec::new();
        }
        for Body { name, on, low, high } in &machine.bodies {
            if let Some(on) = linkage.link(on) {
                let (name, low, high) = (name.clone(), low.to_array(), high.to_array());
                linkage.bodies.push(LinkBody { name, on, low, high, is_given: true });
            }
        }
        linkage
    }

    /// The link of this name; `spindle` is the one that carries the tool, `table` the one that carries the part.
    pub fn link(&self, name: &str) -> Option<usize> {
        match name {
            "spindle" => Some(self.tool.on),
            "table" => Some(self.part.on),
            name => self.links.iter().position(|link| link.name == name),
        }
    }

    /// Where each link is, with the axes at these positions (mm, degrees).
    pub fn frames(&self, axes: &[f64]) -> Vec<Frame> {
        let mut frames: Vec<Frame> = Vec::with_capacity(self.links.len());
        for link in &self.links {
            let at = |(axis, factor): &(usize, f64)| factor * axes.get(*axis).unwrap_or(&f64::NAN);
            let amount = link.zero + link.terms.iter().map(at).sum::<f64>();
            let [direction, point] = [link.direction, link.point].map(Vec3::from_array);
            let own = match link.kind {
                LinkKind::Fixed => Frame::IDENTITY,
                LinkKind::Slide => Frame::from_translation(direction * amount),
                LinkKind::Turn => about(direction, point, amount.to_radians()),
            };
            frames.push(link.on.map_or(own, |on| frames[on] * own));
        }
        frames
    }

    /// The tip of a tool of this length, mm, in the work frame.
    pub fn tip(&self, axes: &[f64], length: f64) -> Vec3 {
        self.tool_in_part(&self.frames(axes)).transform_point3(Vec3::new(0.0, 0.0, -length))
    }

    /// The frame of the tool in the work frame, with the links at `frames`.
    pub(crate) fn tool_in_part(&self, frames: &[Frame]) -> Frame {
        let [tool, part] = [self.tool, self.part].map(|place| place.at(&frames[place.on]));
        part.inverse() * tool
    }

    /// By how much each link slides (mm) or turns (radians) on the one that carries it while the axes go so far.
    pub(crate) fn amounts<'a>(&'a self, way: &'a [f64]) -> impl Iterator<Item = (&'a Link, f64)> {
        self.links.iter().map(|link| {
            let amount: f64 = link.terms.iter().map(|(axis, factor)| factor * way[*axis]).sum();
            match link.kind {
                LinkKind::Turn => (link, amount.to_radians()),
                LinkKind::Fixed | LinkKind::Slide => (link, amount),
            }
        })
    }

    /// How far the tip, at `local` in the frame of the tool, is from the line about which a link turns, mm.
    pub(crate) fn lever(&self, link: &Link, frames: &[Frame], local: Vec3) -> f64 {
        let tip = self.tool.at(&frames[self.tool.on]).transform_point3(local);
        let [direction, point] = [link.direction, link.point].map(Vec3::from_array);
        let carrier = link.on.map_or(Frame::IDENTITY, |on| frames[on]);
        let way = tip - carrier.transform_point3(point);
        way.reject_from_normalized(carrier.transform_vector3(direction)).length()
    }

    fn bed(axes: Vec<Axis>) -> Linkage {
        let at_bed = Place::new(0, &Frame::IDENTITY);
        let mut linkage =
            Linkage { axes, links: Vec::new(), bodies: Vec::new(), tool: at_bed, part: at_bed };
        linkage.links.push(Link::bed());
        linkage
    }

    /// Adds a link that slides; its place.
    fn slide(&mut self, axis: usize, on: usize, direction: Vec3, factor: f64) -> usize {
        self.add(axis, on, LinkKind::Slide, [direction, Vec3::ZERO], (0.0, factor))
    }

    /// Adds a link that turns; its place.
    fn turn(&mut self, axis: usize, on: usize, line: [Vec3; 2], amount: (f64, f64)) -> usize {
        self.add(axis, on, LinkKind::Turn, line, amount)
    }

    fn add(
        &mut self,
        axis: usize,
        on: usize,
        kind: LinkKind,
        line: [Vec3; 2],
        (zero, factor): (f64, f64),
    ) -> usize {
        let [direction, point] = line.map(|vector| vector.to_array());
        let (name, on, terms) = (self.axes[axis].name.clone(), Some(on), vec![(axis, factor)]);
        self.links.push(Link { name, on, kind, direction, point, zero, terms });
        self.links.len() - 1
    }

    fn body(&mut self, name: &str, on: usize, low: [f64; 3], high: [f64; 3]) {
        self.bodies.push(LinkBody { name: name.to_owned(), on, low, high, is_given: false });
    }

    fn of_mill(machine: &Machine) -> Linkage {
        let mut axes = linear_axes(machine);
        axes.extend(machine.rotary.iter().map(|axis| {
            let [low, high] = [axis.min, axis.max].map(finite);
            Axis { name: axis.letter.into(), unit: "degrees", low, high }
        }));
        let mut linkage = Linkage::bed(axes);
        let (mut head, mut table) = (0, 0);
        // Y carries X, and X carries Z.
        for i in [1, 0, 2] {
            let direction = Vec3::AXES[i];
            match machine.linear[i].on {
                Mount::Head => head = linkage.slide(i, head, direction, 1.0),
                // A growing position brings the tool to where it grows on the part.
                Mount::Table => table = linkage.slide(i, table, direction, -1.0),
            }
        }
        let slides = head;
        let zero = machine.work_zero.unwrap_or_default();
        for (i, axis) in machine.rotary.iter().enumerate() {
            // Where nobody says where it lies, it is drawn through the work zero, or the gauge point.
            let point = match (axis.is_placed, axis.on) {
                (true, _) => axis.point,
                (false, Mount::Table) => zero,
                (false, Mount::Head) => Vec3::ZERO,
            };
            let (line, amount) = ([axis.axis, point], (-axis.sign * axis.offset, axis.sign));
            match axis.on {
                Mount::Head => head = linkage.turn(3 + i, head, line, amount),
                Mount::Table => table = linkage.turn(3 + i, table, line, amount),
            }
        }
        linkage.tool = Place::new(head, &Frame::IDENTITY);
        linkage.part = Place::new(table, &Frame::from_translation(zero));
        linkage.draw_mill(machine, slides);
        linkage
    }

    /// Boxes of a mill whose file gives none: the spindle above its gauge point, behind it what carries it, a table below the work zero,
    /// and the bed below all.
    fn draw_mill(&mut self, machine: &Machine, head: usize) {
        let (tool, part) = (self.tool.on, self.part.on);
        let lift = machine.rotary.iter().filter(|axis| axis.on == Mount::Head && axis.is_placed);
        let lift = lift.map(|axis| axis.point.z).fold(0.0, f64::max);
        self.body("spindle", tool, [-HALF, -HALF, 0.0], [HALF, HALF, lift + 3.0 * HALF]);
        // What carries the spindle, each behind the one that it carries.
        let mut link = Some(head);
        let mut back = HALF;
        while let Some(at) = link.filter(|at| *at > 0) {
            let name = self.links[at].name.clone();
            let low = [-2.0 * HALF, back, lift];
            let high = [2.0 * HALF, back + 2.0 * HALF, lift + 6.0 * HALF];
            self.body(&name, at, low, high);
            back += 2.0 * HALF;
            link = self.links[at].on;
        }
        let zero = Vec3::from_array(self.part.frame[3]);
        let top = zero.z - BELOW;
        let reach = |i: usize| {
            let axis = &machine.linear[i];
            let stroke = (axis.max - axis.min).min(2.0 * FARTHEST);
            if stroke.is_finite() { stroke / 2.0 } else { 5.0 * HALF }
        };
        let around = machine.rotary.iter().find(|axis| axis.on == Mount::Table && axis.is_placed);
        let middle = around.map_or(zero, |axis| axis.point);
        let half = match around {
            Some(_) => [3.0 * HALF; 2],
            None => [reach(0), reach(1)],
        };
        let mut depth = top;
        let mut link = Some(part);
        while let Some(at) = link.filter(|at| *at > 0) {
            let name = self.links[at].name.clone();
            let low = [middle.x - half[0], middle.y - half[1], depth - HALF / 2.0];
            let high = [middle.x + half[0], middle.y + half[1], depth];
            self.body(&name, at, low, high);
            depth -= HALF / 2.0;
            link = self.links[at].on;
        }
        let low = [middle.x - 1.5 * reach(0), middle.y - 1.5 * reach(1), depth - 3.0 * HALF];
        let high = [middle.x + 1.5 * reach(0), middle.y + 1.5 * reach(1), depth];
        self.body("bed", 0, low, high);
    }

    fn of_wire(machine: &Machine) -> Linkage {
        let mut axes = linear_axes(machine);
        let travel = machine.wire.map_or(f64::INFINITY, |wire| wire.uv_travel);
        axes.extend(["U", "V"].map(|name| {
            let [low, high] = [-travel, travel].map(finite);
            Axis { name: name.into(), unit: "mm", low, high }
        }));
        let mut linkage = Linkage::bed(axes);
        let mut at = 0;
        for (axis, i) in [(1, 1), (0, 0), (2, 2)] {
            at = linkage.slide(axis, at, Vec3::AXES[i], 1.0);
        }
        linkage.tool = Place::new(at, &Frame::IDENTITY);
        let lower = at;
        for (axis, i) in [(4, 1), (3, 0)] {
            at = linkage.slide(axis, at, Vec3::AXES[i], 1.0);
        }
        let height = machine.wire.and_then(|wire| wire.height).unwrap_or(BELOW);
        let half = HALF / 4.0;
        linkage.body("lower guide", lower, [-half, -half, -HALF], [half, half, -1.0]);
        linkage.body("upper guide", at, [-half, -half, height + 1.0], [half, half, height + HALF]);
        linkage
    }

    fn of_arm(machine: &Machine, arm: &arm::Arm) -> Linkage {
        let names = (1..).map(|number| format!("J{number}")).zip(arm.joints());
        let mut axes: Vec<Axis> = names
            .map(|(name, joint)| {
                let [low, high] = [joint.min, joint.max].map(|q| finite(q.to_degrees()));
                Axis { name, unit: "degrees", low, high }
            })
            .collect();
        let rail = machine.cell.as_ref().and_then(|cell| cell.rail);
        if let Some(rail) = rail {
            let [low, high] = [rail.min, rail.max].map(finite);
            axes.push(Axis { name: String::from("rail"), unit: "mm", low, high });
        }
        let mut linkage = Linkage::bed(axes);
        let (mut at, mut origin) = (0, Frame::IDENTITY);
        if let Some(rail) = rail {
            at = linkage.slide(6, at, rail.direction, 1.0);
            origin = rail.origin;
        }
        let start = arm.flange(&[0.0; 6]);
        let lines = [0, 1, 2, 3, 4, 5].map(|joint| line_of(arm, joint, &start));
        for (joint, (direction, point)) in lines.into_iter().enumerate() {
            let line = [origin.matrix3 * direction, origin.transform_point3(point)];
            at = linkage.turn(joint, at, line, (0.0, 1.0));
            // Joint 3 of the model is what the controller shows less the share of joint 2.
            let share = arm.shown(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]).map_or(0.0, |shown| shown[2]);
            if joint == 2 && share != 0.0 {
                linkage.links[at].terms.push((1, -share));
            }
        }
        // Z of the spindle points out of the tool.
        let over = Frame::from_mat3(Mat3::from_rotation_x(PI));
        let spindle = machine.cell.as_ref().map_or(Frame::IDENTITY, |cell| cell.spindle);
        let frame = origin * start * spindle * over;
        linkage.tool = Place::new(at, &frame);
        let part = machine.cell.as_ref().map_or(Frame::IDENTITY, |cell| cell.part);
        linkage.part = Place::new(0, &part);
        let foot = origin.transform_point3(Vec3::new(0.0, 0.0, -arm.world_height()));
        linkage.draw_arm(foot, (origin * start).translation);
        linkage
    }

    /// Boxes of an arm whose file gives none: from each joint to the next one, and the spindle.
    fn draw_arm(&mut self, foot: Vec3, flange: Vec3) {
        let first = self.links.len() - 6;
        // The point of a joint's line that is nearest to a place.
        let near = |joint: usize, to: Vec3| {
            let Link { direction, point, .. } = &self.links[first + joint];
            let [direction, point] = [*direction, *point].map(Vec3::from_array);
            point + direction * (to - point).dot(direction)
        };
        let shoulder = near(1, foot);
        let elbow = near(2, shoulder);
        let wrist = near(4, flange);
        let tool = self.tool;
        let end = Vec3::from_array(tool.frame[3]);
        // Joint 4 turns the forearm about itself, or (Universal Robots) bends what is behind it.
        let [third, fourth] =
            [2, 3].map(|joint| Vec3::from_array(self.links[first + joint].direction));
        let forearm = match third.dot(fourth).abs() > 0.5 {
            true => [(first + 2, [elbow, near(3, elbow)]), (first + 3, [near(3, elbow), wrist])],
            false => {
                let turned = near(3, elbow.lerp(wrist, 0.3));
                [(first + 2, [elbow, turned]), (first + 3, [turned, wrist])]
            }
        };
        let boxes = [
            ("foot", self.links[first].on.unwrap_or(0), [foot, foot.lerp(shoulder, 0.3)]),
            ("shoulder", first, [foot.lerp(shoulder, 0.4), shoulder]),
            ("upper arm", first + 1, [shoulder, elbow]),
            ("elbow", forearm[0].0, forearm[0].1),
            ("forearm", forearm[1].0, forearm[1].1),
            ("wrist", first + 4, [wrist, wrist.lerp(flange, 0.7)]),
            ("spindle", tool.on, [flange, end]),
        ];
        for (name, on, [a, b]) in boxes {
            let half = if on > first + 2 { HALF / 2.0 } else { HALF };
            let [low, high] = [a.min(b) - half, a.max(b) + half];
            self.body(name, on, low.to_array(), high.to_array());
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn linear_axes(machine: &Machine) -> Vec<Axis> {
    let axis = |(name, axis): (&str, &crate::LinearAxis)| {
        let [low, high] = [axis.min, axis.max].map(finite);
        Axis { name: name.into(), unit: "mm", low, high }
    };
    ["X", "Y", "Z"].into_iter().zip(&machine.linear).map(axis).collect()
}

/// The turn about a line.
fn about(direction: Vec3, point: Vec3, radians: f64) -> Frame {
    let turn = Mat3::from_axis_angle(direction, radians);
    Frame::from_mat3_translation(turn, point - turn * point)
}

/// The line about which a joint of the model turns while the others are at zero: from what half a turn and a quarter do to the flange.
fn line_of(arm: &arm::Arm, joint: usize, start: &Frame) -> (Vec3, Vec3) {
    let turned = |radians: f64| {
        let mut joints = [0.0; 6];
        joints[joint] = radians;
        arm.flange(&joints) * start.inverse()
    };
    let (half, quarter) = (turned(PI), turned(FRAC_PI_2));
    // Of a quarter turn the part that changes its sign with the direction is the axis itself.
    let [x, y, z] = [quarter.matrix3.x_axis, quarter.matrix3.y_axis, quarter.matrix3.z_axis];
    let direction = (Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x) / 2.0).normalize();
    // Half a turn leads the origin to twice its foot on the line; along the line nothing goes.
    (direction, half.translation / 2.0)
}
