//! The commands of a file, obeyed one after the other.

use super::Reading;
use super::aperture::{Aperture, Definition};
use super::attribute::Dictionary;
use super::block::{Blocks, Token};
use super::header::{self, Format};
use super::image::{Image, Object, Region, Shape};
use super::load::Loaded;
use super::plot::{Mode, Operation, Quadrant};
use super::region;
use super::repeat::{Collector, Purpose, Steps};
use super::template::Template;
use crate::Transform;
use crate::contour::Contour;
use crate::decimal::whole;
use crate::report::{Location, Outcome, Report, fault};
use geom::Vec2;
use program::{Diagnostic, Rule};
use std::collections::HashMap;
use std::sync::Arc;

/// How much a file may make of itself: objects, segments of regions, steps of macros.
pub(super) struct Budget {
    left: usize,
}

/// So many objects and segments are more than the largest boards have, and fit into the memory.
const MOST: usize = 5_000_000;

/// So many lines and arcs are drawn, some 600 MB of them.
const MOST_DRAWN: usize = 8_000_000;

/// So often a file may go from dark to clear and back: each change costs a union.
const MOST_CHANGES: usize = 10_000;

impl Budget {
    /// # Errors
    /// `too-large`
    pub(super) fn spend(&mut self, amount: usize) -> Outcome {
        match self.left.checked_sub(amount) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => {
                let message = format!("more than {MOST} objects, segments and values of macros");
                let help = "look at the counts of step and repeat, or divide the layer";
                Err(fault(Rule::TooLarge, message, help))
            }
        }
    }
}

/// What a D code stands for.
pub(super) enum Entry {
    /// An aperture of the image.
    Plain(u32),
    /// A block aperture.
    Block(Arc<[Object]>),
}

/// What has been read, and what holds.
pub(super) struct Reader<'a> {
    report: Report<'a>,
    location: Location,
    pub(super) image: Image,
    pub(super) budget: Budget,
    /// mm in the unit of the file.
    unit: Option<f64>,
    pub(super) format: Option<Format>,
    pub(super) entries: HashMap<u32, Entry>,
    templates: HashMap<&'a [u8], Template>,
    /// The macro whose statements come next.
    open_template: Option<(&'a [u8], Template)>,
    attributes: Dictionary,
    /// Number of the aperture that is selected.
    pub(super) current: Option<u32>,
    pub(super) mode: Mode,
    pub(super) quadrant: Option<Quadrant>,
    pub(super) point: Option<Vec2>,
    pub(super) loaded: Loaded,
    pub(super) region: Option<region::Statement>,
    collectors: Vec<Collector>,
    pub(super) last: Option<Operation>,
    pub(super) ended: bool,
}

/// Reads a file; see [`super::read`].
pub(super) fn read(file_name: &str, text: &[u8]) -> Result<Reading, Vec<Diagnostic>> {
    let mut reader = Reader {
        report: Report::new(file_name, text),
        location: Location::default(),
        image: Image::default(),
        budget: Budget { left: MOST },
        unit: None,
        format: None,
        entries: HashMap::new(),
        templates: HashMap::new(),
        open_template: None,
        attributes: Dictionary::default(),
        current: None,
        mode: Mode::Linear,
        quadrant: None,
        point: Some(Vec2::ZERO),
        loaded: Loaded::default(),
        region: None,
        collectors: Vec::new(),
        last: None,
        ended: false,
    };
    let mut blocks = Blocks::of(text);
    loop {
        let token = blocks.next();
        reader.location = blocks.location;
        let obeyed = match token {
            Ok(None) => break,
            Ok(Some(token)) => reader.obey(token),
            Err(fault) => Err(fault),
        };
        if let Err(fault) = obeyed {
            let hopeless = fault.rule == Rule::TooLarge;
            reader.report.error(reader.location, *fault);
            if hopeless || reader.report.is_full() {
                return Err(reader.report.errors);
            }
        }
    }
    reader.finish()
}

impl<'a> Reader<'a> {
    fn obey(&mut self, token: Token<'a>) -> Outcome {
        match token {
            Token::Close => {
                if let Some((name, template)) = self.open_template.take() {
                    if template.is_deprecated() {
                        self.deprecated("the macro primitives 2, 6 and 22");
                    }
                    self.templates.insert(name, template);
                }
                Ok(())
            }
            Token::Block { .. } if self.ended => {
                self.report.warn(
                    self.location,
                    Rule::AfterEnd,
                    "commands after M02",
                    "they are not read",
                );
                Ok(())
            }
            Token::Block { text, extended: true } => self.extended(text),
            Token::Block { text, .. } => {
                // A comment may hold an attribute (section 5.1.1).
                let comment = text.strip_prefix(b"G04").or(text.strip_prefix(b"G4 "));
                match comment.map(|comment| comment.trim_ascii().strip_prefix(b"#@!")) {
                    None => self.command(text),
                    Some(None) => Ok(()),
                    Some(Some(text)) => self.attributes.obey(text.trim_ascii(), &mut self.image),
                }
            }
        }
    }

    /// Obeys a command between two `%`.
    fn extended(&mut self, text: &'a [u8]) -> Outcome {
        if let Some((_, template)) = &mut self.open_template {
            return template.push(self.location, text);
        }
        let Some((name, rest)) = text.split_first_chunk::<2>() else {
            return Err(unknown(text));
        };
        match name {
            b"FS" => {
                let format = Format::of(rest)?;
                if format.is_deprecated() {
                    self.deprecated("a format other than %FSLA with equal digits");
                }
                if self.format.replace(format).is_some_and(|known| known != format) {
                    let help = "a file has one format";
                    return Err(fault(Rule::Format, "another format of coordinates", help));
                }
                Ok(())
            }
            b"MO" => self.set_unit(header::unit(rest)?),
            b"AD" => self.define(rest),
            b"AM" => {
                self.open_template = Some((rest.trim_ascii(), Template::default()));
                Ok(())
            }
            b"AB" => self.block(rest.trim_ascii()),
            b"SR" => self.repeat(rest),
            [b'L', b'P' | b'M' | b'R' | b'S'] => self.loaded.load(name[1], rest),
            b"TF" | b"TA" | b"TO" | b"TD" => {
                self.attributes.obey(text.trim_ascii(), &mut self.image)
            }
            b"AS" | b"IP" | b"IR" | b"MI" | b"OF" | b"SF" => {
                self.deprecated("AS, IP, IR, MI, OF and SF");
                header::transformation(name, rest)
            }
            b"IN" | b"LN" => {
                self.deprecated("IN and LN");
                Ok(())
            }
            // Old files put these between % too.
            [b'G' | b'D' | b'M' | b'X' | b'Y', b'0'..=b'9'] => {
                self.deprecated("G, D and M codes between %");
                self.command(text)
            }
            _ => Err(unknown(text)),
        }
    }

    fn define(&mut self, text: &[u8]) -> Outcome {
        let definition = Definition::of(text)?;
        let unit = self.unit()?;
        let (pieces, pen) = match definition.standard(unit)? {
            Some(standard) => standard,
            None => {
                let name = String::from_utf8_lossy(definition.template).into_owned();
                let template = self.templates.get(definition.template).ok_or_else(|| {
                    let help = "define it with %AM before it is used";
                    fault(Rule::MissingMacro, format!("there is no macro {name}"), help)
                })?;
                let drawn = template.pieces(&definition.values, unit, &mut self.budget);
                let pieces = drawn.map_err(|(location, mut fault)| {
                    self.location = location;
                    fault.message.push_str(&format!(", in {name} for D{}", definition.number));
                    fault
                })?;
                (pieces, None)
            }
        };
        let index = u32::try_from(self.image.apertures.len()).unwrap_or(u32::MAX);
        self.budget.spend(1)?;
        let (number, function) = (definition.number, self.attributes.function.clone());
        self.image.apertures.push(Aperture { number, pieces, pen, function });
        self.enter(number, Entry::Plain(index));
        Ok(())
    }

    fn enter(&mut self, number: u32, entry: Entry) {
        if self.entries.insert(number, entry).is_some() {
            let help = "what comes after it uses the new one";
            self.report.warn(
                self.location,
                Rule::ApertureAgain,
                "an aperture that is defined again",
                help,
            );
        }
    }

    fn block(&mut self, text: &[u8]) -> Outcome {
        if !text.is_empty() {
            let number = text.strip_prefix(b"D").and_then(whole).filter(|number| *number >= 10);
            let number = number.ok_or_else(|| {
                let help = "a block aperture begins with %ABD12*% and ends with %AB*%";
                fault(Rule::Block, "not the number of an aperture", help)
            })?;
            self.collect(Purpose::Block(number));
            return Ok(());
        }
        let (objects, number) = match self.collectors.pop() {
            Some(Collector { purpose: Purpose::Block(number), objects }) => (objects, number),
            other => {
                self.collectors.extend(other);
                let help = "a block aperture begins with %ABD12*%";
                return Err(fault(Rule::Block, "the end of a block that was not begun", help));
            }
        };
        self.point = None;
        self.enter(number, Entry::Block(objects.into()));
        Ok(())
    }

    fn repeat(&mut self, text: &[u8]) -> Outcome {
        let open = match self.collectors.last().map(|collector| collector.purpose) {
            Some(Purpose::Block(_)) => {
                let help = "flash the block several times instead";
                return Err(fault(Rule::StepAndRepeat, "a step and repeat within a block", help));
            }
            Some(Purpose::Repeat(_)) => true,
            None => false,
        };
        // An open one ends where another begins (section 8.3.4).
        if open {
            self.close_repeat()?;
        }
        if text.trim_ascii().is_empty() {
            return Ok(());
        }
        if open {
            self.deprecated("a step and repeat that is not ended by %SR*%");
        }
        let steps = Steps::of(text, self.unit()?)?;
        self.collect(Purpose::Repeat(steps));
        Ok(())
    }

    fn collect(&mut self, purpose: Purpose) {
        self.collectors.push(Collector { purpose, objects: Vec::new() });
    }

    fn close_repeat(&mut self) -> Outcome {
        if let Some(Collector { purpose: Purpose::Repeat(steps), objects }) = self.collectors.pop()
        {
            let copies = steps.copies(&objects, &mut self.budget)?;
            self.image.objects.extend(copies);
            self.point = None;
        }
        Ok(())
    }

    /// Where objects go now.
    pub(super) fn objects(&mut self) -> &mut Vec<Object> {
        match self.collectors.last_mut() {
            Some(collector) => &mut collector.objects,
            None => &mut self.image.objects,
        }
    }

    pub(super) fn paint(&mut self, shape: Shape) -> Outcome {
        self.budget.spend(1)?;
        let attributes = self.attributes.index(&mut self.image);
        let (line, dark) = (self.location.line, self.loaded.dark);
        self.objects().push(Object { line, dark, attributes, shape });
        Ok(())
    }

    pub(super) fn paint_region(&mut self, contours: Vec<Contour>) -> Outcome {
        if contours.is_empty() {
            return Ok(());
        }
        let region = u32::try_from(self.image.regions.len()).unwrap_or(u32::MAX);
        let function = self.attributes.function.clone();
        self.image.regions.push(Region { contours, function });
        // Mirroring, rotation and scaling are for apertures (section 4.9.1).
        self.paint(Shape::Region { region, transform: Transform::NONE, at: Vec2::ZERO })
    }

    /// What is selected.
    pub(super) fn entry(&self) -> Outcome<&Entry> {
        self.current.and_then(|number| self.entries.get(&number)).ok_or_else(|| {
            let help = "select one before it, such as D10";
            fault(Rule::MissingAperture, "no aperture is selected", help)
        })
    }

    pub(super) fn unit(&self) -> Outcome<f64> {
        self.unit.ok_or_else(|| {
            let help = "a Gerber file says it at its start: %MOMM*% or %MOIN*%";
            fault(Rule::NoUnit, "a length before the unit", help)
        })
    }

    pub(super) fn set_unit(&mut self, unit: f64) -> Outcome {
        match self.unit.replace(unit) {
            Some(known) if known != unit => {
                self.unit = Some(known);
                let help = "a file has one unit";
                Err(fault(Rule::Unit, "another unit", help))
            }
            _ => Ok(()),
        }
    }

    /// Warns of what the current specification no longer has.
    #[cold]
    pub(super) fn deprecated(&mut self, what: &str) {
        let help = "it is read as chapter 8 of the Gerber specification says";
        self.report.warn(self.location, Rule::Deprecated, what, help);
    }

    fn finish(mut self) -> Result<Reading, Vec<Diagnostic>> {
        let last = match self.collectors.last().map(|collector| collector.purpose) {
            Some(Purpose::Repeat(_)) => {
                self.deprecated("a step and repeat that is not ended by %SR*%");
                self.close_repeat()
            }
            Some(Purpose::Block(number)) => {
                let message = format!("the block D{number} is not ended");
                Err(fault(Rule::Block, message, "end it with %AB*%"))
            }
            None => Ok(()),
        };
        let region = match self.region {
            Some(_) => Err(fault(Rule::Region, "the last region is not ended", "end it with G37")),
            None => Ok(()),
        };
        let end = match self.ended {
            true => Ok(()),
            false => {
                let help = "the file may be cut off: write it again";
                Err(fault(Rule::NoEnd, "the file does not end with M02", help))
            }
        };
        let size = self.bounded();
        for fault in [last, region, end, size].into_iter().filter_map(Result::err) {
            self.report.error(self.location, *fault);
        }
        if !self.report.errors.is_empty() {
            return Err(self.report.errors);
        }
        Ok(Reading { image: self.image, warnings: self.report.warnings })
    }
}

impl Reader<'_> {
    /// # Errors
    /// `too-large` where painting the image takes more memory than boards need, `polarity-changes` where it takes
    /// more time.
    fn bounded(&self) -> Outcome {
        let size = self.image.size();
        if size > MOST_DRAWN {
            let message =
                format!("its objects have {size} lines and arcs; {MOST_DRAWN} are the most");
            let help =
                "look at the counts of step and repeat and at the macros, or divide the layer";
            return Err(fault(Rule::TooLarge, message, help));
        }
        let changes = self.image.objects.chunk_by(|a, b| a.dark == b.dark).count();
        if changes > MOST_CHANGES {
            let message = format!(
                "the polarity (%LP) changes {changes} times where objects are painted; {MOST_CHANGES} are the most"
            );
            let help = "write the layer again with what is clear in one place, or divide it";
            return Err(fault(Rule::PolarityChanges, message, help));
        }
        Ok(())
    }
}

#[cold]
fn unknown(text: &[u8]) -> crate::report::Fault {
    let shown = String::from_utf8_lossy(&text[..text.len().min(20)]).into_owned();
    let help = "see chapter 4 of the Gerber specification";
    fault(Rule::UnknownCommand, format!("there is no command {:?}", shown.trim()), help)
}
