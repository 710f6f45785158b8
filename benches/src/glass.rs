//! Points on bodies in glass and their order, with the marks of the work: how many are found a second, how many of the laser's
//! pulses are used. The floor of sampling is to look once at every pair of the points within two spacings, which any proof of
//! the distance has to do; that of the order, to find who shadows whom and go greedily from point to point. A solid is taken from its
//! mesh to a program that is proven.

use crate::fastest;
use ::glass::clock::Clock;
use ::glass::cloud::{Point, distances};
use ::glass::curve::Layers;
use ::glass::fill::{Fill, Filling, Shells};
use ::glass::job::{self, Order, Placing, Settings};
use ::glass::machine::{self, Machine};
use ::glass::material;
use ::glass::mesh::{self, Form, Mesh, Shape};
use ::glass::optics::Ray;
use ::glass::order::{self, Effort, Shadow};
use ::glass::profile::{Limits, Profile};
use ::glass::sample::{Apart, surface};
use ::glass::source::surrogate::FITTED;
use geom::Vec3;
use program::{Diagnostic, Rule};
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

/// Rows of triangles from pole to pole.
const ROWS: u32 = 200;

/// Prints what a sphere, a torus and the bodies of `files` take, each with about so many points, at both lens presets, and the sphere
/// at 0.05 mm too.
///
/// # Errors
/// A file cannot be read, or two points are too close, which is a fault of the sampling.
pub fn measure(points: usize, files: &[PathBuf], rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let rate =
        |acceleration| 100.0 / FITTED.ticks_per_point(100.0, Limits::metric(acceleration, 0.08));
    println!(
        "points a second at 100 Hz and 0.08 m/s of steps like those of the source: {:.2} at 7.5 m/s², {:.2} at 10 m/s²",
        rate(7.5),
        rate(10.0)
    );
    sampled("a sphere", &sphere(1.0), points, 50, rounds)?;
    let mut bodies =
        vec![(String::from("a sphere"), sphere(1.0)), (String::from("a torus"), torus())];
    for file in files {
        bodies.push((file.display().to_string(), read(file)?));
    }
    for (name, body) in bodies {
        for (spacing, radius) in [(90, 47.5), (130, 67.5)] {
            let cloud = sampled(&name, &body, points, spacing, rounds)?;
            // The cone of a lens of 70 mm in K9.
            ordered(&cloud, Shadow { slope: 0.0235, radius }, rounds)?;
        }
    }
    Ok(())
}

/// Prints what orders of `cloud` take, and how many pulses they use, with the triangle profile at 7.5 m/s², 0.1 m/s and 100 Hz.
fn ordered(cloud: &[Point], shadow: Shadow, rounds: usize) -> Result<(), Vec<Diagnostic>> {
    let clock = &Clock::new(100.0, Profile::Triangle, [Limits::metric(7.5, 0.1); 3]);
    let used = |ticks: u64| 100.0 * cloud.len() as f64 / ticks.max(1) as f64;
    let mut ticks = 0;
    let mut of = |rounds: usize, order: &dyn Fn() -> Vec<u32>| {
        let measured = fastest(rounds, &mut || {
            // The first point's pulse counts too.
            ticks = 1 + order::ticks(cloud, &order(), clock);
            Ok(())
        })?;
        Ok::<_, Vec<Diagnostic>>((measured.time, used(ticks)))
    };
    let effort = |rounds| Effort { rounds, ..Effort::default() };
    let most = Effort::default().rounds;
    let (time, known) = of(1, &|| order::kdz(cloud, 0.58, 0.58))?;
    println!("  Sort Kdz, K = 0.58: {time}; {known:.2} of 100 pulses used, points shadowed");
    let by = |shadow, rounds| move || order::fastest(cloud, cloud, shadow, clock, effort(rounds));
    let (floor, greedy) = of(rounds.min(2), &by(shadow, 0))?;
    println!("  greedy order: {floor}; {greedy:.2} of 100 pulses used");
    let (time, best) = of(rounds.min(2), &by(shadow, most))?;
    println!("  order: {time}; {best:.2} of 100 pulses used");
    println!("    divided by the floor: {}", time.times(floor));
    let bound = 1 + order::bound(cloud, cloud, Some(shadow), clock);
    println!("  bound by assignment: {:.2} of 100", used(bound));
    // Nothing is nearer to an axis than 0.
    let (_, free) = of(1, &by(Shadow { slope: 0.0, radius: 0.0 }, most))?;
    println!("  order without the shadow rule: {free:.2}; the rule costs {:.2}", free - best);
    Ok(())
}

/// About `count` points, `spacing` µm apart, on a body that is scaled for it: prints what they take.
fn sampled(
    name: &str,
    body: &Mesh,
    count: usize,
    spacing: u32,
    rounds: usize,
) -> Result<Vec<Point>, Vec<Diagnostic>> {
    // There are some 0.72 points on a square of one spacing.
    let area = count as f64 / 0.72 * (f64::from(spacing) * 1e-3).powi(2);
    let own: f64 = (0..body.triangles.len() as u32)
        .map(|triangle| {
            let [a, b, c] = body.corners(triangle);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    let scale = (area / own).sqrt();
    let vertices = body.vertices.iter().map(|vertex| *vertex * scale).collect();
    let body = Mesh { vertices, triangles: body.triangles.clone(), ..Mesh::default() };
    let mut points = Vec::new();
    let sampling = fastest(rounds, &mut || {
        points = surface(&body, Apart { spacing, lost: 0.0 }, 1);
        Ok(())
    })?;
    let mut close = 0;
    let floor = fastest(rounds, &mut || {
        close = distances(&points, i64::from(spacing)).too_close;
        Ok(())
    })?;
    if close > 0 {
        let message = format!("{close} pairs of points are nearer than {spacing} µm");
        return Err(vec![Diagnostic::error(Rule::Internal, message)]);
    }
    println!("{} points on {name} in glass, {spacing} µm apart", points.len());
    println!(
        "  sampling: {}; {:.2} million points a second of wall",
        sampling.time,
        points.len() as f64 * 1e-6 / sampling.time.wall.as_secs_f64()
    );
    println!(
        "  floor: {}\n    divided by the floor: {}",
        floor.time,
        sampling.time.times(floor.time)
    );
    Ok(points)
}

/// Prints what a solid ball of about so many points takes from its mesh to a program that is proven: 0.09 mm apart, a planar motor, a
/// binary program, the greedy order.
///
/// # Errors
/// The program is not proven.
pub fn solid(points: usize) -> Result<(), Vec<Diagnostic>> {
    let found = |found: Box<Diagnostic>| vec![*found];
    let machine = machine::library("glass-planar-200hz").unwrap_or_default();
    let machine = Machine::read(machine, "glass-planar-200hz").map_err(found)?;
    let wavelength = machine.laser.wavelength;
    let material =
        material::find(material::TABLE, "materials.toml", "k9", wavelength).map_err(found)?;
    // There are some 1432 points in a mm³.
    let radius = (points as f64 / 1432.0 * 3.0 / (4.0 * PI)).cbrt();
    let placing = Placing {
        block: [100.0, 100.0, 60.0],
        margin: 2.0,
        scale: None,
        fit: false,
        turn: [0.0; 3],
        mirror: [false; 3],
        shift: [0.0; 3],
    };
    let settings = Settings {
        placing,
        alone: Vec::new(),
        blocks: 1,
        focal: 43.0,
        spacing: None,
        filling: Filling { fill: Fill::Solid, step: None, direction: Vec3::Z },
        shells: Shells { count: 1, distance: None },
        layers: Layers::default(),
        ray: Ray::Marginal,
        order: Order::Fastest,
        effort: Effort { rounds: 0, ..Effort::default() },
        seed: 1,
        accept_shadowed: false,
    };
    let mut used = (0, 0.0);
    let measured = fastest(1, &mut || {
        let made = job::make(vec![Shape::Mesh(sphere(radius))], &material, &machine, &settings)?;
        used = (made.report.points, 100.0 * made.report.proof.used);
        if made.proven { Ok(()) } else { Err(made.findings) }
    })?;
    let (points, used) = used;
    println!("{points} points of a solid ball in glass, 90 µm apart, from mesh to proven program");
    println!(
        "  all: {}; {used:.2} of 100 pulses used; peak {} MB, {} bytes a point",
        measured.time,
        measured.peak / 1_000_000,
        measured.peak.div_ceil(points.max(1) as usize)
    );
    Ok(())
}

/// The body of a file.
fn read(file: &Path) -> Result<Mesh, Vec<Diagnostic>> {
    let name = file.display().to_string();
    let unknown = || {
        let found = Diagnostic::error(Rule::Form, "a body is a .stl, .obj, .ply or .3mf");
        vec![found.file(&*name)]
    };
    let form = match file.extension().and_then(|ending| ending.to_str()) {
        Some("stl") => Form::Stl,
        Some("obj") => Form::Obj,
        Some("ply") => Form::Ply,
        Some("3mf") => Form::ThreeMf,
        _ => return Err(unknown()),
    };
    let bytes = std::fs::read(file).map_err(|error| crate::outside::failed(&error))?;
    match mesh::read(&bytes, form, &name).map_err(|found| vec![*found])? {
        Shape::Mesh(body) => Ok(body),
        Shape::Points(_) | Shape::Curves(_) | Shape::Picture(_) => Err(unknown()),
    }
}

/// A ring around Z, mm.
pub fn torus() -> Mesh {
    let (around, across) = (3 * ROWS, ROWS);
    let place = |(i, j): (u32, u32)| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
        let (up, out) = (TAU * f64::from(j) / f64::from(across)).sin_cos();
        let far = 1.0 + 0.4 * out;
        Vec3::new(far * cos, far * sin, 0.4 * up)
    };
    let all = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let number = |i: u32, j: u32| i % around * across + j % across;
    let faces = |(i, j): (u32, u32)| {
        let [a, b] = [number(i, j), number(i + 1, j)];
        let [c, d] = [number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = all.clone().flat_map(faces).collect();
    Mesh { vertices: all.map(place).collect(), triangles, ..Mesh::default() }
}

/// A sphere around the origin, mm.
fn sphere(radius: f64) -> Mesh {
    let columns = 2 * ROWS;
    let place = |(row, column): (u32, u32)| {
        let (out, up) = (PI * f64::from(row) / f64::from(ROWS)).sin_cos();
        let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        radius * Vec3::new(out * cos, out * sin, -up)
    };
    let all = (0..=ROWS).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let number = |row: u32, column: u32| row * columns + column % columns;
    let faces = |(row, column): (u32, u32)| {
        let [a, b] = [number(row, column), number(row, column + 1)];
        let [c, d] = [number(row + 1, column + 1), number(row + 1, column)];
        [[a, b, c], [a, c, d]]
    };
    let cells = all.clone().filter(|(row, _)| *row < ROWS);
    Mesh {
        vertices: all.map(place).collect(),
        triangles: cells.flat_map(faces).collect(),
        ..Mesh::default()
    }
}
