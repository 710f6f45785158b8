//! What can be typed after `toolpost glass`.

use super::{Choice, choice, length, lengths, point};
use ::glass::curve::Layers;
use ::glass::fill::{self, Fill, Sections, Shells};
use ::glass::list::Columns;
use ::glass::optics::Ray;
use ::glass::order::Effort;
use ::glass::picture::{MOST_SHEETS, Manner, Plane, Setting};
use ::glass::scenario::Scenario;
use app::Source;
use app::glass::Settings;
use app::glass::job::{self, Order};
use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What `glass` is to do. Written by hand: clap does not derive arguments that a subcommand takes the place of.
#[derive(Debug)]
pub enum Glass {
    /// Write a program.
    Engrave(Box<Engrave>),
    /// Something else.
    Command(GlassCommand),
}

impl FromArgMatches for Glass {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Glass, clap::Error> {
        Ok(match matches.subcommand_name() {
            Some(_) => Glass::Command(GlassCommand::from_arg_matches(matches)?),
            None => Glass::Engrave(Box::new(Engrave::from_arg_matches(matches)?)),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Glass::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Glass {
    fn augment_args(command: Command) -> Command {
        let command = GlassCommand::augment_subcommands(Engrave::augment_args(command));
        command
            .args_conflicts_with_subcommands(true)
            .subcommand_negates_reqs(true)
            .subcommand_required(false)
            .arg_required_else_help(false)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Glass::augment_args(command)
    }
}

/// Commands of `glass`.
#[derive(Debug, Subcommand)]
pub enum GlassCommand {
    /// Print the tables of the source of the models next to ours, its test vectors, and its known slips.
    Tables {
        /// Where to save charts of the tables and of what other drives would reach, as .svg or .png.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Print a machine of the library, or `materials`, ready to be copied.
    Show {
        /// Name of a machine, or `materials`.
        name: String,
    },
    /// Prove a program, also one edited by hand, against what it was made of; give the same bodies and options as for it.
    Prove {
        /// The program.
        program: PathBuf,
        #[command(flatten)]
        job: Box<Job>,
    },
    /// Run a program tick by tick: pulses that make no point, a stop, and going on from a point.
    Simulate {
        /// The program.
        program: PathBuf,
        /// Name in the library, or a file ending in .toml.
        #[arg(long, short, value_name = "NAME|FILE")]
        machine: String,
        /// The first point that is made, from 1; those before it are made already.
        #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
        from: u32,
        /// When the run is stopped [default: at its end].
        #[arg(long, value_name = "S", value_parser = length)]
        until: Option<f64>,
        /// When the door is opened, which stops the laser and the axes.
        #[arg(long, value_name = "S", value_parser = length)]
        door: Option<f64>,
        /// The part of the pulses that make no point.
        #[arg(long, value_name = "PART", value_parser = part)]
        misses: Option<f64>,
        /// Listen to the sensor: a pulse that made no point is fired again, up to three times, where the axes stand still.
        #[arg(long)]
        feedback: bool,
        /// Chooses which pulses make no point.
        #[arg(long, value_name = "NUMBER", default_value_t = 1)]
        seed: u64,
        /// When the run begins, as 2026-11-26 20:15:00.
        #[arg(long, value_name = "DATE", value_parser = start, default_value = "2000-01-01 00:00:00")]
        start: i64,
        /// Where to save the statistics: duration, progress, start, predicted end, counted points.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Say what a program takes at other rates of the laser and with other accelerations, also as charts.
    Sweep {
        /// The program.
        program: PathBuf,
        /// Name in the library, or a file ending in .toml.
        #[arg(long, short, value_name = "NAME|FILE")]
        machine: String,
        /// Where to save charts of it, as .svg or .png.
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Draw what the arm of a polar machine reaches of a block, from above.
    Reach {
        /// Name in the library, or a file ending in .toml.
        #[arg(long, short, value_name = "NAME|FILE")]
        machine: String,
        /// Sides of the block along X, Y and Z.
        #[arg(long, value_name = "XxYxZ", value_parser = block)]
        block: [f64; 3],
        /// Where to save the picture, as .svg or .png.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
    },
    /// Check the smallest distance of the points of a list or a cloud, and name the nearest two.
    Check {
        /// The points (.xyz, .txt, .csv, .cft, .ply).
        points: PathBuf,
        /// The smallest distance that they must have, mm.
        #[arg(long, value_name = "MM", value_parser = length)]
        spacing: f64,
        /// In which columns of a list X, Y and Z stand, from 1.
        #[arg(long, value_name = "N,N,N", value_parser = columns, default_value = "1,2,3")]
        columns: Columns,
    },
}

/// Arguments of an engraving.
#[derive(Debug, Args)]
pub struct Engrave {
    #[command(flatten)]
    pub job: Job,
    /// Where to save the program; the report goes next to it.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Where to save the points in the glass, in their order, as binary PLY.
    #[arg(long, value_name = "FILE")]
    pub cloud: Option<PathBuf>,
    #[command(flatten)]
    pub ordering: Ordering,
    /// By which ray of the beam the focus is found.
    #[arg(long, value_name = "RAY", default_value = "marginal", value_parser = choice(&RAYS))]
    pub ray: Ray,
}

/// What is engraved, and on what: the points of a job, the same whenever the same is given.
#[derive(Debug, Args)]
pub struct Job {
    /// Bodies (.stl, .obj, .ply, .3mf), pictures (.png, .jpg, .bmp, .pcx), curves (.dxf, .plt, .hpgl) and lists of points (.xyz, .txt,
    /// .csv, .cft), all in one block and in one frame; mm.
    #[arg(value_name = "BODY", required = true)]
    pub bodies: Vec<PathBuf>,
    /// Sides of the block along X, Y and Z.
    #[arg(long, value_name = "XxYxZ", value_parser = block)]
    pub block: [f64; 3],
    /// What the block is made of: a name of the table of materials (that of Toolpost has k9, bk7 and silica).
    #[arg(long, value_name = "NAME")]
    pub material: String,
    /// Table of materials instead of that of Toolpost (`toolpost glass show materials`).
    #[arg(long, value_name = "FILE")]
    pub materials: Option<PathBuf>,
    /// Focal length of the lens (machines of the library have 43 and 70).
    #[arg(long, value_name = "MM", value_parser = length)]
    pub lens: f64,
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// How many equal blocks are made, of machines with places for several.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub blocks: u32,
    /// Smallest distance of two points [default: that of the lens].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub spacing: Option<f64>,
    /// In which columns of a list X, Y and Z stand, from 1.
    #[arg(long, value_name = "N,N,N", value_parser = columns, default_value = "1,2,3")]
    pub columns: Columns,
    #[command(flatten)]
    pub filling: Filling,
    #[command(flatten)]
    pub image: Image,
    #[command(flatten)]
    pub placing: Placing,
    /// Take another cloud that is as good.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Let a rule pass in this run; the report names it.
    #[arg(long, value_name = "RULE", value_parser = ["shadowed"])]
    pub accept: Vec<String>,
    /// Draw the pulses in the block, as the eye sees them and in their order, as .svg or .png.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    #[command(flatten)]
    pub view: View,
}

/// How the eye looks at the points of a picture.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "View of the picture")]
pub struct View {
    /// Where the eye is, degrees: from X in the plane XY, above that plane, and how far it is rolled to its left.
    #[arg(long, value_name = "ALPHA,BETA,GAMMA", value_parser = camera, allow_hyphen_values = true, default_value = "-63,19,0", requires = "picture")]
    pub camera: [f64; 3],
    /// Distance of the eye from the middle of the points, mm [default: 2.4 diagonals of the block].
    #[arg(long, value_name = "MM", value_parser = length, requires = "picture")]
    pub distance: Option<f64>,
    /// How many times larger than where the whole block fits.
    #[arg(long, value_name = "FACTOR", value_parser = zoom, default_value = "1", requires = "picture")]
    pub zoom: f64,
    /// Lines of a grid so far apart, from the corner of the block, in all views.
    #[arg(long, value_name = "MM", value_parser = length, requires = "picture")]
    pub grid: Option<f64>,
}

/// How bodies become points.
#[derive(Debug, Args)]
#[command(next_help_heading = "Points of bodies and curves")]
pub struct Filling {
    /// Where a body gets points.
    #[arg(long, value_name = "HOW", default_value = "surface", value_parser = choice(&FILLS))]
    pub fill: Filled,
    /// How many surfaces a body has, itself and copies within it, of `surface`.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub shells: u32,
    /// Distance of those surfaces [default: the spacing and half as much again].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub shell_distance: Option<f64>,
    /// Distance of points along contours and curves, in triangles and columns, and of rays [default: the spacing and what rounding
    /// takes].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub step: Option<f64>,
    /// Distance of the planes of sections [default: --step], and of the layers of curves.
    #[arg(long, value_name = "MM", value_parser = length)]
    pub layer_distance: Option<f64>,
    /// Distance of the first and the last plane from the ends of the body.
    #[arg(long, value_name = "MM", value_parser = length, default_value = "0.1")]
    pub first_distance: f64,
    /// By which part of the distance each contour or curve begins later than that of the layer before.
    #[arg(long, value_name = "PART", value_parser = part)]
    pub twist: Option<f64>,
    /// Leave the end of an open contour or curve without a point.
    #[arg(long)]
    pub no_ends: bool,
    /// Put a point into triangles that are smaller than the grid, of `triangles`.
    #[arg(long)]
    pub full: bool,
    /// How often curves are repeated along the axis.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub layers: u32,
    /// Across the planes of sections and the layers of curves, or along the rays.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = choice(&AXES))]
    pub axis: usize,
    /// Turn that axis about X, then Y, then Z, degrees.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true, default_value = "0,0,0")]
    pub tilt: [f64; 3],
}

/// Where a body gets points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filled {
    /// On its surface.
    Surface,
    /// On its surface, as dense as it is bright.
    Shaded,
    /// Within as well.
    Solid,
    /// Along sections.
    Sections,
    /// In each triangle.
    Triangles,
    /// Where rays meet it.
    Rays,
}

const FILLS: [Choice<Filled>; 6] = [
    ("surface", "All over the surface, evenly and without order", Filled::Surface),
    (
        "shaded",
        "All over the surface, the denser the brighter its colours and textures are",
        Filled::Shaded,
    ),
    ("solid", "All over the surface, and within", Filled::Solid),
    ("sections", "Along the contours of parallel sections", Filled::Sections),
    ("triangles", "In a grid in each triangle", Filled::Triangles),
    ("rays", "Where parallel rays meet the surface", Filled::Rays),
];

/// What becomes of pictures.
#[derive(Debug, Args)]
#[command(next_help_heading = "Photographs, black and white pictures and depth maps")]
pub struct Image {
    /// What becomes of a picture; points are bright in glass, so white is dense.
    #[arg(long = "image", value_name = "HOW", default_value = "dither", value_parser = choice(&MANNERS))]
    pub manner: Drawn,
    /// In which plane it stands.
    #[arg(long, value_name = "PLANE", default_value = "xz", value_parser = choice(&PLANES))]
    pub plane: Plane,
    /// How wide it is [default: as large as fits within the margins].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub width: Option<f64>,
    /// Exchange black and white, also of `shaded`.
    #[arg(long)]
    pub invert: bool,
    /// From which part of white on a cell of `raster` gets a point.
    #[arg(long, value_name = "PART", value_parser = part, default_value = "0.5")]
    pub threshold: f64,
    /// How much nearer white is than black, of `relief`.
    #[arg(long, value_name = "MM", value_parser = length, required_if_eq("manner", "relief"))]
    pub depth: Option<f64>,
    /// How many sheets of it stand behind each other, of `dither` and `raster`.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SHEETS)))]
    pub sheets: u32,
    /// Distance of the sheets [default: the spacing and what rounding takes].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub sheet_distance: Option<f64>,
}

/// What becomes of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawn {
    /// Dots.
    Dither,
    /// A grid.
    Raster,
    /// A surface.
    Relief,
}

const MANNERS: [Choice<Drawn>; 3] = [
    ("dither", "Photograph: dots, as dense as it is bright", Drawn::Dither),
    ("raster", "Black and white: a point in each bright cell of a grid", Drawn::Raster),
    (
        "relief",
        "Depth map: a surface, nearer where it is bright; none where it is black",
        Drawn::Relief,
    ),
];

const PLANES: [Choice<Plane>; 3] = [
    ("xz", "Upright, seen from the front", Plane::Xz),
    ("xy", "Lying, seen from above", Plane::Xy),
    ("yz", "Upright, seen from the right", Plane::Yz),
];

/// How bodies lie in the block.
#[derive(Debug, Args)]
#[command(next_help_heading = "Place in the block")]
pub struct Placing {
    /// How far all points stay from the faces.
    #[arg(long, value_name = "MM", value_parser = length, default_value = "2")]
    pub margin: f64,
    /// Factor by which the bodies are scaled.
    #[arg(long, value_name = "FACTOR", value_parser = length, conflicts_with = "fit")]
    pub scale: Option<f64>,
    /// Scale the bodies to the largest size that fits.
    #[arg(long)]
    pub fit: bool,
    /// Turn them about X, then Y, then Z, degrees.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true, default_value = "0,0,0")]
    pub turn: [f64; 3],
    /// Mirror them along these axes, before they are turned.
    #[arg(long, value_name = "AXIS,...", value_delimiter = ',', value_parser = choice(&AXES))]
    pub mirror: Vec<usize>,
    /// Move them from the middle of the block.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true, default_value = "0,0,0")]
    pub r#move: [f64; 3],
    /// Place a body by itself, without regard to the others: its number in the order of the bodies, from 1, then what it has of
    /// mirror=x,y turn=X,Y,Z scale=FACTOR (or fit) move=X,Y,Z, as above; such as "2 scale=0.5 move=10,0,-5". Once for each such body.
    #[arg(long, value_name = "NUMBER ...", value_parser = alone)]
    pub place: Vec<Alone>,
}

/// How a body lies by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Alone {
    /// Its number, from 0.
    pub body: usize,
    /// Its scale.
    pub scale: Option<f64>,
    /// Whether it is scaled to fit.
    pub fit: bool,
    /// How it is turned, degrees.
    pub turn: [f64; 3],
    /// Along which axes it is mirrored.
    pub mirror: [bool; 3],
    /// How far its middle is from that of the block.
    pub r#move: [f64; 3],
}

/// The order of the points.
#[derive(Debug, Args)]
#[command(next_help_heading = "Order of the points")]
pub struct Ordering {
    /// How points are ordered.
    #[arg(long, value_name = "HOW", default_value = "fastest", value_parser = choice(&ORDERS))]
    pub order: Sorting,
    /// K for points above and for points below, of `kdz`.
    #[arg(long, value_name = "K,K", value_parser = slopes, default_value = "0.58,0.58")]
    pub slopes: [f64; 2],
    /// Height of a layer, of `layers` [default: the spacing].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub layer: Option<f64>,
    /// How often the order is improved, of `fastest`.
    #[arg(long, value_name = "NUMBER", default_value_t = 4)]
    pub rounds: u32,
    /// Stop improving after this time, with the best order so far: the program then depends on the speed of this computer.
    #[arg(long, value_name = "S", value_parser = length)]
    pub seconds: Option<f64>,
}

/// How points are ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sorting {
    /// Ours.
    Fastest,
    /// `Sort Kdz` of the source.
    Kdz,
    /// `Sort by layers` of the source.
    Layers,
    /// In motion along arcs of the arm.
    Arcs,
    /// In motion along tracks of the table.
    Tracks,
}

const ORDERS: [Choice<Sorting>; 5] = [
    ("fastest", "In the fewest laser ticks, without shadowing a point", Sorting::Fastest),
    ("kdz", "From the lowest point to that of least max(dx, dy) + K dz", Sorting::Kdz),
    ("layers", "Layer by layer from below, in each to the nearest point", Sorting::Layers),
    (
        "arcs",
        "In motion along arcs of a polar machine's arm, to which the points are moved",
        Sorting::Arcs,
    ),
    (
        "tracks",
        "In motion along circles of a polar machine's table, to which the points are moved",
        Sorting::Tracks,
    ),
];

const RAYS: [Choice<Ray>; 2] = [
    ("marginal", "The outermost ray of the cone", Ray::Marginal),
    ("paraxial", "Rays next to the axis: depth divided by the index", Ray::Paraxial),
];

const AXES: [Choice<usize>; 3] =
    [("x", "Left and right", 0), ("y", "Front and back", 1), ("z", "Up and down", 2)];

impl Engrave {
    /// What the words mean to a job that has begun at a time.
    pub fn settings(&self, begun: Instant) -> Settings {
        let (order, effort) = self.ordering.order(begun);
        self.job.settings(self.ray, order, effort)
    }
}

impl Job {
    /// The files of the bodies.
    pub fn sources(&self) -> Vec<Source> {
        self.bodies.iter().map(|path| Source::from(path.as_path())).collect()
    }

    /// What the words mean; the order is left as it is where there is none to make.
    pub fn settings(&self, ray: Ray, order: Order, effort: Effort) -> Settings {
        let placing = job::Placing {
            block: self.block,
            margin: self.placing.margin,
            scale: self.placing.scale,
            fit: self.placing.fit,
            turn: self.placing.turn,
            mirror: [0, 1, 2].map(|axis| self.placing.mirror.contains(&axis)),
            shift: self.placing.r#move,
        };
        let alone = |own: &Alone| {
            let Alone { body, scale, fit, turn, mirror, r#move } = *own;
            (body, job::Placing { scale, fit, turn, mirror, shift: r#move, ..placing })
        };
        let job = job::Settings {
            alone: self.placing.place.iter().map(alone).collect(),
            placing,
            blocks: self.blocks,
            focal: self.lens,
            spacing: self.spacing,
            filling: filling(&self.filling, self.image.invert),
            shells: Shells { count: self.filling.shells, distance: self.filling.shell_distance },
            layers: Layers {
                count: self.filling.layers,
                distance: self.filling.layer_distance,
                twist: self.filling.twist.unwrap_or_default(),
                ends: !self.filling.no_ends,
            },
            ray,
            order,
            effort,
            seed: self.seed,
            accept_shadowed: !self.accept.is_empty(),
        };
        Settings {
            material: self.material.clone(),
            materials: self.materials.clone().map(Source::from),
            columns: self.columns,
            picture: self.image.setting(),
            job,
        }
    }
}

impl Image {
    fn setting(&self) -> Setting {
        Setting {
            plane: self.plane,
            width: self.width,
            manner: match self.manner {
                Drawn::Dither => Manner::Dither,
                Drawn::Raster => Manner::Raster(self.threshold),
                // Without a depth the command line is not taken.
                Drawn::Relief => Manner::Relief(self.depth.unwrap_or_default()),
            },
            invert: self.invert,
            sheets: (self.sheets, self.sheet_distance),
        }
    }
}

/// How bodies become points.
fn filling(args: &Filling, invert: bool) -> fill::Filling {
    let fill = match args.fill {
        Filled::Surface => Fill::Surface,
        Filled::Shaded => Fill::Shaded(invert),
        Filled::Solid => Fill::Solid,
        Filled::Triangles => Fill::Triangles(args.full),
        Filled::Rays => Fill::Rays,
        Filled::Sections => Fill::Sections(Sections {
            layer: args.layer_distance,
            first: args.first_distance,
            twist: args.twist.unwrap_or_default(),
            ends: !args.no_ends,
        }),
    };
    fill::Filling { fill, step: args.step, direction: fill::direction(args.axis, args.tilt) }
}

impl Ordering {
    /// The order that is asked for, and how much is tried for it.
    fn order(&self, begun: Instant) -> (Order, Effort) {
        let order = match self.order {
            Sorting::Fastest => Order::Fastest,
            Sorting::Kdz => Order::Kdz(self.slopes[0], self.slopes[1]),
            Sorting::Layers => Order::Layers(self.layer),
            Sorting::Arcs => Order::Scenario(Scenario::Arcs),
            Sorting::Tracks => Order::Scenario(Scenario::Tracks),
        };
        let until =
            self.seconds.and_then(|s| begun.checked_add(Duration::try_from_secs_f64(s).ok()?));
        (order, Effort { rounds: self.rounds, until, ..Effort::default() })
    }
}

/// The sides of a block.
fn block(text: &str) -> Result<[f64; 3], String> {
    let sides: Option<[f64; 3]> = lengths(&text.replace(['x', 'X'], ","));
    let sides = sides.filter(|sides| sides.iter().all(|side| *side > 0.0 && *side <= 1000.0));
    sides.ok_or_else(|| String::from("three sides in mm are needed, up to 1000, such as 50x50x80"))
}

/// The place of a body by itself.
fn alone(text: &str) -> Result<Alone, String> {
    let mut words = text.split_whitespace();
    let number = words.next().and_then(|word| word.parse::<usize>().ok()?.checked_sub(1));
    let body = number.ok_or_else(|| {
        String::from("the number of a body comes first, from 1, such as \"2 scale=0.5\"")
    })?;
    let mut own = Alone { body, ..Alone::default() };
    let mut known: Vec<&str> = Vec::new();
    for word in words {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        if known.contains(&key) {
            return Err(format!("`{key}` stands twice"));
        }
        known.push(key);
        let three = || {
            lengths(value)
                .ok_or_else(|| format!("`{word}`: three numbers are needed, such as {key}=10,0,-5"))
        };
        match key {
            "fit" if word == "fit" => own.fit = true,
            "turn" => own.turn = three()?,
            "move" => own.r#move = three()?,
            "scale" => {
                let scale =
                    value.parse().ok().filter(|scale: &f64| scale.is_finite() && *scale > 0.0);
                let wrong = || format!("`{word}`: a number greater than 0 is needed");
                own.scale = Some(scale.ok_or_else(wrong)?);
            }
            "mirror" => {
                for axis in value.split(',') {
                    let found = AXES.iter().find(|(name, ..)| *name == axis);
                    let (.., axis) =
                        found.ok_or_else(|| format!("`{word}`: there are the axes x, y and z"))?;
                    own.mirror[*axis] = true;
                }
            }
            _ => return Err(format!("`{word}` is none of mirror=, turn=, scale=, fit and move=")),
        }
    }
    if own.fit && own.scale.is_some() {
        return Err(String::from("`fit` and `scale` cannot both be"));
    }
    Ok(own)
}

/// The angles of an eye.
fn camera(text: &str) -> Result<[f64; 3], String> {
    let angles: Option<[f64; 3]> = lengths(text);
    let angles = angles.filter(|[alpha, beta, gamma]| {
        alpha.abs() <= 360.0 && beta.abs() <= 90.0 && gamma.abs() <= 360.0
    });
    angles.ok_or_else(|| {
        String::from("three angles are needed, the second from -90 to 90, such as -63,19,0")
    })
}

/// How many times larger.
fn zoom(text: &str) -> Result<f64, String> {
    let zoom = text.parse::<f64>().ok().filter(|zoom| (0.1..=1000.0).contains(zoom));
    zoom.ok_or_else(|| String::from("a number from 0.1 to 1000 is needed, such as 2"))
}

/// A part of the whole.
fn part(text: &str) -> Result<f64, String> {
    let part = text.parse::<f64>().ok().filter(|part| *part > 0.0 && *part <= 1.0);
    part.ok_or_else(|| String::from("a number greater than 0 is needed, up to 1, such as 0.5"))
}

/// A date, as seconds since 1970.
fn start(text: &str) -> Result<i64, String> {
    ::glass::simulate::seconds_of(text)
        .ok_or_else(|| String::from("a date is needed, such as 2026-11-26 20:15:00"))
}

/// Two slopes.
fn slopes(text: &str) -> Result<[f64; 2], String> {
    let slopes: Option<[f64; 2]> = lengths(text);
    let slopes = slopes.filter(|slopes| slopes.iter().all(|slope| *slope >= 0.0));
    slopes.ok_or_else(|| String::from("two numbers are needed, 0 or more, such as 0.58,0.58"))
}

/// Three columns, from 1.
fn columns(text: &str) -> Result<Columns, String> {
    let column = |word: &str| word.trim().parse::<usize>().ok()?.checked_sub(1);
    let columns: Option<Vec<usize>> = text.split(',').map(column).collect();
    let columns = columns.and_then(|columns| columns.try_into().ok());
    columns
        .map(Columns)
        .ok_or_else(|| String::from("three columns from 1 are needed, such as 1,2,3"))
}
