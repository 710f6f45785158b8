//! Operations (sections 4.7 and 4.8): draws, arcs, moves and flashes.

use super::image::Shape;
use super::reader::{Entry, Reader};
use super::words::{Word, Words};
use crate::report::{Outcome, fault};
use crate::stroke::Pen;
use crate::{FAR, SAME, arc};
use geom::ending::go_on;
use geom::{Element, INCH, Vec2};
use program::Rule;
use std::f64::consts::FRAC_PI_2;

/// How a move from point to point runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    Linear,
    Clockwise,
    CounterClockwise,
}

/// How the centre of an arc is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quadrant {
    /// `G74`: without signs, for arcs of a quarter turn at most (deprecated, section 8.1.10).
    Single,
    /// `G75`
    Multi,
}

/// What coordinates are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    Plot,
    Move,
    Flash,
}

/// The coordinates of a command: X, Y, I, J.
type Coordinates = [Option<Word>; 4];

impl Reader<'_> {
    /// Obeys a command outside of `%`.
    pub(super) fn command(&mut self, text: &[u8]) -> Outcome {
        let mut words = Words::of(text);
        let mut coordinates: Coordinates = [None; 4];
        go_on();
        let mut operation = None;
        let mut modes = false;
        while let Some(word) = words.next()? {
            match word.letter {
                b'X' => coordinates[0] = Some(word),
                b'Y' => coordinates[1] = Some(word),
                b'I' => coordinates[2] = Some(word),
                b'J' => coordinates[3] = Some(word),
                b'D' => match word.value {
                    1 => operation = Some(Operation::Plot),
                    2 => operation = Some(Operation::Move),
                    3 => operation = Some(Operation::Flash),
                    number => self.select(number)?,
                },
                b'G' => {
                    modes = true;
                    self.general(word.value)?;
                }
                b'M' => self.end(word.value)?,
                b'N' => self.deprecated("N, the number of a block"),
                letter => {
                    let message = format!("there is no word {}", char::from(letter));
                    return Err(fault(
                        Rule::DataWord,
                        message,
                        "see chapter 4 of the Gerber specification",
                    ));
                }
            }
        }
        let given = coordinates.iter().any(Option::is_some);
        match operation {
            Some(operation) => {
                if modes {
                    self.deprecated("a G code and an operation in one command");
                }
                self.last = Some(operation);
                self.operate(operation, &coordinates)
            }
            None if !given => Ok(()),
            // Section 8.3.2.
            None if self.last == Some(Operation::Plot) => {
                self.deprecated("coordinates without D01");
                self.operate(Operation::Plot, &coordinates)
            }
            None => {
                let help = "say D01, D02 or D03 behind them";
                Err(fault(Rule::NoOperation, "coordinates without an operation", help))
            }
        }
    }

    fn select(&mut self, number: i64) -> Outcome {
        let number = u32::try_from(number).ok().filter(|number| *number >= 10);
        let number = number.ok_or_else(|| {
            fault(
                Rule::DataWord,
                "D codes are D01, D02, D03, and apertures from D10 on",
                "correct it",
            )
        })?;
        if !self.entries.contains_key(&number) {
            self.current = None;
            let help = "define it with %AD before it is used";
            return Err(fault(Rule::MissingAperture, format!("D{number} is not defined"), help));
        }
        self.current = Some(number);
        Ok(())
    }

    fn general(&mut self, code: i64) -> Outcome {
        match code {
            1 => self.mode = Mode::Linear,
            2 => self.mode = Mode::Clockwise,
            3 => self.mode = Mode::CounterClockwise,
            36 => {
                if self.region.replace(Default::default()).is_some() {
                    return Err(fault(
                        Rule::Region,
                        "G36 within a region",
                        "end the region with G37",
                    ));
                }
            }
            37 => {
                let Some(mut region) = self.region.take() else {
                    return Err(fault(
                        Rule::Region,
                        "G37 without G36",
                        "begin the region with G36",
                    ));
                };
                region.finish()?;
                self.paint_region(region.contours)?;
            }
            54 => self.deprecated("G54"),
            55 => self.deprecated("G55"),
            70 | 71 => {
                self.deprecated("G70 and G71 for the unit");
                self.set_unit(if code == 70 { INCH } else { 1.0 })?;
            }
            74 => {
                self.deprecated("G74, arcs of one quadrant");
                self.quadrant = Some(Quadrant::Single);
            }
            75 => self.quadrant = Some(Quadrant::Multi),
            90 | 91 => {
                self.deprecated("G90 and G91");
                match &mut self.format {
                    Some(format) => format.incremental = code == 91,
                    None => return Err(no_format()),
                }
            }
            code => {
                let help = "see chapters 4 and 8 of the Gerber specification";
                return Err(fault(Rule::DataWord, format!("there is no G{code:02}"), help));
            }
        }
        Ok(())
    }

    fn end(&mut self, code: i64) -> Outcome {
        match code {
            0 => self.deprecated("M00"),
            1 => {
                self.deprecated("M01");
                return Ok(());
            }
            2 => {}
            code => {
                let message = format!("there is no M{code:02}");
                return Err(fault(Rule::DataWord, message, "the end of a file is M02"));
            }
        }
        self.ended = true;
        Ok(())
    }

    fn operate(&mut self, operation: Operation, coordinates: &Coordinates) -> Outcome {
        let start = self.point;
        let [x, y, i, j] = coordinates;
        // Whatever is wrong with the operation, the next one starts here.
        let end = self.place(x, y)?;
        self.point = Some(end);
        match operation {
            Operation::Move => match &mut self.region {
                Some(region) => region.finish(),
                None => Ok(()),
            },
            Operation::Flash if self.region.is_some() => {
                Err(fault(Rule::Region, "D03 within a region", "a region has lines and arcs only"))
            }
            Operation::Flash => self.flash(end),
            Operation::Plot => {
                let start = start.ok_or_else(|| {
                    let help = "move there with D02 first";
                    fault(Rule::NoPoint, "nothing says where this line starts", help)
                })?;
                let path = match self.mode {
                    Mode::Linear => Element::line(start, end),
                    _ => self.arc(start, end, Vec2::new(self.offset(i)?, self.offset(j)?))?,
                };
                match &mut self.region {
                    Some(region) => {
                        region.push(path);
                        self.budget.spend(1)
                    }
                    None => self.stroke(path),
                }
            }
        }
    }

    /// Where X and Y lead; what is left out stays.
    fn place(&self, x: &Option<Word>, y: &Option<Word>) -> Outcome<Vec2> {
        let incremental = self.format.is_some_and(|format| format.incremental);
        let along = |word: &Option<Word>, last: Option<f64>| match (word, last) {
            (None, Some(last)) => Ok(last),
            (Some(word), Some(last)) if incremental => Ok(last + self.value(word)?),
            (Some(word), _) if !incremental => self.value(word),
            _ => {
                let help = "give X and Y";
                Err(fault(Rule::NoPoint, "nothing says where this is", help))
            }
        };
        let place =
            Vec2::new(along(x, self.point.map(|p| p.x))?, along(y, self.point.map(|p| p.y))?);
        if place.abs().max_element() > FAR {
            let message = format!("X {} Y {} is not a place within {FAR} mm", place.x, place.y);
            let help = "look at the format (%FS) and the unit (%MO)";
            return Err(fault(Rule::NotAPlace, message, help));
        }
        Ok(place)
    }

    fn offset(&self, word: &Option<Word>) -> Outcome<f64> {
        word.as_ref().map_or(Ok(0.0), |word| self.value(word))
    }

    /// The value of a coordinate, mm.
    fn value(&self, word: &Word) -> Outcome<f64> {
        let format = self.format.ok_or_else(no_format)?;
        Ok(format.value(word) * self.unit()?)
    }

    fn arc(&self, start: Vec2, end: Vec2, offset: Vec2) -> Outcome<Element> {
        let clockwise = self.mode == Mode::Clockwise;
        let step = self.format.ok_or_else(no_format)?.step() * self.unit()?;
        // The ends and the centre are rounded to the resolution of the file; some writers do so twice.
        let tolerance = (4.0 * step).max(0.005);
        let center = match self.quadrant {
            None => {
                let help = "say G75 before the first arc";
                return Err(fault(Rule::NoQuadrant, "an arc before G75", help));
            }
            Some(Quadrant::Multi) => start + offset,
            Some(Quadrant::Single) => {
                // Equal ends are an arc of no length here, not a circle.
                if start.distance(end) <= SAME {
                    return Ok(Element::line(start, end));
                }
                let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
                let centers = signs.map(|(x, y)| start + offset * Vec2::new(x, y));
                let quarter = |center: &Vec2| {
                    arc::turned(start, end, *center, clockwise)
                        <= FRAC_PI_2 + tolerance / offset.length()
                };
                let off = |center: &Vec2| arc::deviation(start, end, *center);
                let near = centers.into_iter().filter(quarter);
                near.min_by(|a, b| off(a).total_cmp(&off(b))).ok_or_else(|| {
                    let message =
                        "no centre at this distance makes an arc of a quarter turn or less";
                    fault(Rule::ArcCenter, message, "correct I and J, or use G75")
                })?
            }
        };
        let (from, to) = (start.distance(center), end.distance(center));
        if from <= SAME || to <= SAME || (from - to).abs() > tolerance {
            let message = format!(
                "the start is {from:.6} mm from the centre and the end {to:.6} mm, which is more than {tolerance:.6} mm apart"
            );
            return Err(fault(Rule::ArcCenter, message, "correct I and J, or the ends of the arc"));
        }
        Ok(arc::about(start, end, center, clockwise))
    }

    fn stroke(&mut self, path: Element) -> Outcome {
        let (aperture, pen) = match self.entry()? {
            Entry::Block(_) => (None, None),
            Entry::Plain(index) => {
                let aperture = self.image.apertures.get(*index as usize);
                (Some(*index), aperture.and_then(|aperture| aperture.pen))
            }
        };
        let Some((aperture, pen)) = aperture.zip(pen) else {
            // Without length it is the same as a flash.
            if path.turn.is_none() && path.start == path.end {
                return self.flash(path.end);
            }
            let help = "lines are drawn with a circle; with a rectangle if they are straight";
            return Err(fault(Rule::Pen, "this aperture draws no lines", help));
        };
        if let Pen::Rectangle(_) = pen {
            if path.turn.is_some() {
                let help = "draw arcs with a circle";
                return Err(fault(Rule::Pen, "an arc drawn with a rectangle", help));
            }
            self.deprecated("lines drawn with a rectangle");
        }
        let transform = self.loaded.transform();
        self.paint(Shape::Stroke { aperture, transform, path })
    }

    fn flash(&mut self, at: Vec2) -> Outcome {
        let transform = self.loaded.transform();
        let objects = match self.entry()? {
            Entry::Plain(aperture) => {
                let aperture = *aperture;
                return self.paint(Shape::Flash { aperture, transform, at });
            }
            Entry::Block(objects) => objects.clone(),
        };
        self.budget.spend(objects.len())?;
        let dark = self.loaded.dark;
        for object in objects.iter() {
            go_on();
            let copy = object.placed(&transform, at, dark)?;
            self.objects().push(copy);
        }
        Ok(())
    }
}

#[cold]
fn no_format() -> crate::report::Fault {
    let help = "a Gerber file says it at its start: %FSLAX36Y36*%";
    fault(Rule::NoFormat, "coordinates before the format of coordinates", help)
}
