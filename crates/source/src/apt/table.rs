//! The table from major word to handler. Each handler is headed by the syntax it takes.

use super::Reader;
use super::report::{Fault, Outcome};
use super::statement::Statement;
use program::Rule;

/// What becomes of a statement.
#[derive(Clone, Copy)]
pub(super) enum Use {
    /// The handler takes it.
    By(fn(&mut Reader, &Statement) -> Outcome),
    /// The handler takes it, and what follows the word is free text.
    Text(fn(&mut Reader, &Statement) -> Outcome),
    /// It says nothing that a program needs: display, tolerances already applied, bookkeeping.
    Ignored,
    /// As [`Use::Ignored`], with free text after the word.
    IgnoredText,
    /// It would change what the machine does, and is not passed on: a warning.
    NotPassedOn,
    /// It would change where the tool goes, and cannot be resolved: an error.
    Refused,
}

use Use::{By, Ignored, IgnoredText, NotPassedOn, Refused, Text};

/// Every major word that is known, in alphabetical order.
pub(super) const WORDS: &[(&str, Use)] = &[
    ("", By(Reader::further_point)),
    ("$$", Text(Reader::remark)),
    ("$$->", By(Reader::creo_directive)),
    ("ARCSLP", Refused),
    ("AUTOPS", Ignored),
    ("AUXFUN", By(Reader::auxfun)),
    ("CALL", Refused),
    ("CIRCLE", By(Reader::circle)),
    ("CLAMP", NotPassedOn),
    ("CLEARP", Ignored),
    ("CLPRNT", Ignored),
    ("COOLNT", By(Reader::coolnt)),
    ("COPY", Refused),
    ("CSYS", By(Reader::csys)),
    ("CUTCOM", By(Reader::cutcom)),
    ("CUTTER", By(Reader::cutter)),
    ("CYCLE", By(Reader::cycle_statement)),
    ("DELAY", By(Reader::delay)),
    ("DISPLY", IgnoredText),
    ("END", By(Reader::fini)),
    ("END-OF-PATH", By(Reader::end_of_path)),
    ("FEDRAT", By(Reader::fedrat)),
    ("FINI", By(Reader::fini)),
    ("FROM", By(Reader::from)),
    ("GOBACK", Refused),
    ("GODLTA", By(Reader::godlta)),
    ("GODOWN", Refused),
    ("GOFWD", Refused),
    ("GOHOME", Refused),
    ("GOLFT", Refused),
    ("GORGT", Refused),
    ("GOTO", By(Reader::goto)),
    ("GOUP", Refused),
    ("HEAD", By(Reader::head)),
    ("INCLUD", Refused),
    ("INDEX", Refused),
    ("INDIRP", Refused),
    ("INDIRV", By(Reader::indirv)),
    ("INSERT", Text(Reader::insert)),
    ("INTOL", By(Reader::tolerance)),
    ("LINTOL", Ignored),
    ("LOAD", By(Reader::load)),
    ("LOADTL", By(Reader::load)),
    ("MACHIN", IgnoredText),
    ("MCHTOL", Ignored),
    ("MODE", By(Reader::mode)),
    ("MSYS", By(Reader::msys)),
    ("MULTAX", By(Reader::multax)),
    ("NOPOST", Ignored),
    ("OPSKIP", NotPassedOn),
    ("OPSTOP", By(Reader::opstop)),
    ("ORIGIN", By(Reader::origin)),
    ("OUTTOL", By(Reader::tolerance)),
    ("PAINT", IgnoredText),
    ("PARTNO", Text(Reader::partno)),
    ("PPRINT", Text(Reader::pprint)),
    ("PREFUN", Refused),
    ("PSIS", Ignored),
    ("RAPID", By(Reader::rapid)),
    ("RETRCT", Refused),
    ("REWIND", Ignored),
    ("ROTABL", By(Reader::rotate)),
    ("ROTATE", By(Reader::rotate)),
    ("ROTHED", By(Reader::rotate)),
    ("SCALE", Refused),
    ("SELCTL", By(Reader::select)),
    ("SELECT", By(Reader::select)),
    ("SEQNO", Ignored),
    ("SET", By(Reader::set)),
    ("SPINDL", By(Reader::spindl)),
    ("STOP", By(Reader::stop)),
    ("THREAD", Refused),
    ("TLAXIS", By(Reader::tlaxis)),
    ("TLDATA", By(Reader::tldata)),
    ("TLON,GOFWD", By(Reader::tlon)),
    ("TLON,GOLFT", Refused),
    ("TLON,GORGT", Refused),
    ("TMARK", Ignored),
    ("TOLER", By(Reader::tolerance)),
    ("TOOL PATH", Text(Reader::tool_path)),
    ("TOOLNO", By(Reader::toolno)),
    ("TPRINT", Text(Reader::tprint)),
    ("TRACUT", Refused),
    ("TRANS", By(Reader::trans)),
    ("TRNTYP", By(Reader::trntyp)),
    ("TURRET", Refused),
    ("UNIT", By(Reader::units)),
    ("UNITS", By(Reader::units)),
];

/// Private words of SolidWorks CAM: they describe tools for its own simulation.
const PRIVATE: &[u8] = b"CSI_";

/// What becomes of statements with the major word `word`; `None` where it is not known.
pub(super) fn find(word: &[u8]) -> Option<Use> {
    if word.get(..PRIVATE.len()).is_some_and(|head| head.eq_ignore_ascii_case(PRIVATE)) {
        return Some(IgnoredText);
    }
    let upper = |c: &u8| c.to_ascii_uppercase();
    WORDS
        .binary_search_by(|(known, _)| known.bytes().cmp(word.iter().map(upper)))
        .ok()
        .and_then(|index| WORDS.get(index))
        .map(|(_, use_)| *use_)
}

/// Whether `word` is a major word, and whether what follows it is free text.
pub(super) fn takes_text(word: &[u8]) -> Option<bool> {
    find(word).map(|use_| matches!(use_, Text(_) | IgnoredText))
}

impl Reader {
    /// Obeys a statement by the table.
    pub(super) fn obey(&mut self, statement: &Statement) -> Outcome {
        let known = find(statement.major);
        self.line = statement.line;
        if !statement.major.is_empty() {
            self.inside_goto = false;
        }
        if let Some(By(_) | Text(_)) = known
            && self.ended
            && statement.major != b"$$"
            && !statement.major.eq_ignore_ascii_case(b"FINI")
        {
            return Err(Fault::new(Rule::AfterEnd, "a statement after the end of the program")
                .help("post the programs of this file one by one"));
        }
        let ignored = !matches!(known, Some(By(_) | Text(_) | Refused));
        if ignored && (0..statement.fields.len()).any(|i| statement.is(i, "GOTO")) {
            let message = "a GOTO within a statement that is ignored";
            return Err(Fault::new(Rule::Malformed, message).help("write it on a line of its own"));
        }
        match known {
            Some(By(handler) | Text(handler)) => {
                self.known = true;
                handler(self, statement)
            }
            Some(Ignored | IgnoredText) => {
                self.known = true;
                Ok(())
            }
            Some(NotPassedOn) => self.not_passed_on(statement),
            Some(Refused) => {
                let word = super::text::decode(statement.major);
                let message = format!("{word} changes where the tool goes, and cannot be resolved");
                Err(Fault::new(Rule::Unsupported, message)
                    .help("let the CAM system write points (GOTO) instead"))
            }
            None => self.unknown(statement),
        }
    }

    /// A statement that says something of the job which is not passed on: a warning.
    fn not_passed_on(&mut self, statement: &Statement) -> Outcome {
        let word = super::text::decode(statement.major);
        let message = format!("{word} is not passed on");
        self.report.warn(statement, Rule::IgnoredWord, &message, "check whether the job needs it");
        Ok(())
    }

    /// `SET/MODE,ABSOL`; others set the machine up: `SET/HOLDER,90` a head, `SET/OFFSETL,7` a register.
    fn set(&mut self, statement: &Statement) -> Outcome {
        self.mode(statement)?;
        if statement.is(0, "MODE") { Ok(()) } else { self.not_passed_on(statement) }
    }

    /// `TOOLNO/number,diameter`: bookkeeping beside `LOADTL`; with words it names a register or a length, which that has to say.
    fn toolno(&mut self, statement: &Statement) -> Outcome {
        let words = ["ADJUST", "LENGTH", "OSETNO"];
        let says = |i: usize| words.iter().any(|word| statement.is(i, word));
        let says_more = (0..statement.fields.len()).any(says);
        if says_more { self.not_passed_on(statement) } else { Ok(()) }
    }

    /// A word that is not known: one warning for each, but not without end.
    fn unknown(&mut self, statement: &Statement) -> Outcome {
        const RULE: Rule = Rule::UnknownWord;
        /// More different unknown words than any CAM system has of its own.
        const MAX_WORDS: usize = 20;
        let mut parts = statement.major.split(|c| b" \t,".contains(c));
        if parts.any(|part| !part.is_empty() && find(part).is_some()) {
            return Err(Fault::new(Rule::Malformed, "this statement does not begin with its word")
                .help("a statement is a word, a slash, and values with commas between them"));
        }
        let word = super::text::decode(statement.major.get(..40).unwrap_or(statement.major));
        let message = format!("the word {word} is not known and its statements are ignored");
        self.report.warn(statement, RULE, &message, "check whether the job needs it");
        if self.report.count_of(RULE) > MAX_WORDS {
            self.hopeless = true;
            let message = "too many words that are not cutter-location data";
            return Err(Fault::new(Rule::NotCldata, message));
        }
        Ok(())
    }

    /// `MODE/...`, `SET/MODE,ABSOL`: only absolute coordinates of a mill are known.
    pub(super) fn mode(&mut self, statement: &Statement) -> Outcome {
        let foreign = ["INCR", "TURN", "LATHE", "WIRE"];
        let word = |i: &usize| foreign.iter().any(|word| statement.is(*i, word));
        match (0..statement.fields.len()).find(word) {
            Some(i) => Err(Fault::new(Rule::Unsupported, "coordinates in this mode are not known")
                .fields(i, 1)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_in_order_so_that_each_is_found() {
        for pair in WORDS.windows(2) {
            assert!(pair[0].0 < pair[1].0, "{} {}", pair[0].0, pair[1].0);
        }
        for (word, _) in WORDS {
            assert!(find(word.as_bytes()).is_some());
            assert!(find(word.to_lowercase().as_bytes()).is_some());
        }
        assert!(find(b"NOSUCH").is_none());
        assert!(find(b"CSI_SET_FLUTE_LENGTH").is_some());
    }

    #[test]
    fn the_manual_explains_every_word() {
        let manual = include_str!("../../../../docs/sources/apt.md");
        for (word, _) in WORDS.iter().filter(|(word, _)| !word.is_empty()) {
            assert!(manual.contains(&format!("`{word}")), "{word} is not in docs/sources/apt.md");
        }
    }
}
