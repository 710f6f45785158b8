//! Statements that are words for people: names, comments, the end.

use super::report::{Fault, Outcome};
use super::statement::Statement;
use super::{Dialect, Reader, Ready};
use program::{Op, Rule};

/// The longest comment that is passed on, characters.
const LONGEST_COMMENT: usize = 250;

/// Bytes as text: UTF-8 where they are, else Latin-1; control characters as blanks, without the
/// blanks at both ends.
pub(super) fn decode(bytes: &[u8]) -> String {
    let clean = |c: char| if c.is_control() { ' ' } else { c };
    let text: String = match std::str::from_utf8(bytes) {
        Ok(text) => text.chars().map(clean).take(LONGEST_COMMENT).collect(),
        Err(_) => bytes.iter().map(|c| clean(char::from(*c))).take(LONGEST_COMMENT).collect(),
    };
    text.trim().to_owned()
}

/// What follows `key` in `text`, where `text` begins with it in any case.
fn after<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    text.get(..key.len()).filter(|head| head.eq_ignore_ascii_case(key))?;
    text.get(key.len()..)
}

impl Reader {
    /// `$$ text`. CATIA gives its axis system so.
    pub(super) fn remark(&mut self, statement: &Statement) -> Outcome {
        let text = decode(statement.body.0);
        if self.axis_system(statement, &text)? || text.starts_with('*') || text.is_empty() {
            return Ok(());
        }
        self.comment(statement, &text);
        Ok(())
    }

    /// A comment; CATIA names its operations in such.
    fn comment(&mut self, statement: &Statement, text: &str) {
        let op = match after(text, "OPERATION NAME") {
            Some(name) => Op::Operation(name.trim_start_matches([' ', ':']).into()),
            None => Op::Comment(text.into()),
        };
        self.push(statement.line, op);
    }

    /// `$$-> word / values` of Creo: the diameter of the tool and the coordinate system. What its other
    /// directives say is in the statements too.
    pub(super) fn creo_directive(&mut self, statement: &Statement) -> Outcome {
        if statement.is(0, "CSYS") {
            return self.creo_csys(statement);
        }
        if statement.is(0, "CUTTER") {
            let diameter = self.diameter(statement, 1)?;
            self.describe_tool(statement, |tool| tool.diameter = Some(diameter));
        }
        Ok(())
    }

    /// `PARTNO/text`: the name of the program.
    pub(super) fn partno(&mut self, statement: &Statement) -> Outcome {
        let name = decode(statement.body.0);
        if !name.is_empty() {
            self.program.name = name;
        }
        Ok(())
    }

    /// `PPRINT/text`: a comment. Makino states there what its points are; the rest of its sections
    /// repeats the statements.
    pub(super) fn pprint(&mut self, statement: &Statement) -> Outcome {
        let text = decode(statement.body.0);
        if self.dialect != Dialect::Makino {
            self.comment(statement, &text);
            return Ok(());
        }
        match text.split_once(',') {
            Some(("TOOL-POSITION", place)) if place != "TOOL-NOSE" => {
                let message = format!("the points of this file are not the tool tip but {place}");
                Err(Fault::new(Rule::ToolPosition, message)
                    .help("let the CAM system write the tool nose"))
            }
            Some(("BEGIN-SECTION", name)) => {
                self.sections.push((statement.line, name.into()));
                Ok(())
            }
            Some(("END-SECTION", name)) => match self.sections.pop() {
                Some((_, open)) if *open == *name => Ok(()),
                _ => {
                    Err(Fault::new(Rule::Malformed, format!("section {name} ends but is not open")))
                }
            },
            _ => Ok(()),
        }
    }

    /// `INSERT/text`. The text is meant for one control and is never passed on as code: it is a
    /// comment, and `INSERT/STOP text` a message and a stop.
    pub(super) fn insert(&mut self, statement: &Statement) -> Outcome {
        let text = decode(statement.body.0);
        if let Some(message) = after(&text, "STOP") {
            let help = "check that the operator is to stop here";
            self.report.warn(
                statement,
                Rule::Insert,
                "INSERT/STOP is read as a stop and a message",
                help,
            );
            // First what the operator is to do, then the stop at which it is read.
            let message = message.trim();
            if !message.is_empty() {
                self.push(statement.line, Op::Message(message.into()));
            }
            self.push(statement.line, Op::Stop);
            return Ok(());
        }
        // SolidWorks CAM writes the names of tools and the size of the stock so.
        if self.dialect != Dialect::SolidWorksCam {
            let help = "what the control must do has to be in a statement of its own";
            self.report.warn(
                statement,
                Rule::Insert,
                "INSERT is passed on as a comment, not as code",
                help,
            );
        }
        self.push(statement.line, Op::Comment(text.into()));
        self.inserted = Some(self.program.records.len());
        Ok(())
    }

    /// `TOOL PATH/name,TOOL,tool name`: an operation of Siemens NX begins.
    pub(super) fn tool_path(&mut self, statement: &Statement) -> Outcome {
        let text = decode(statement.body.0);
        let (name, tool) = text.split_once(",TOOL,").unwrap_or((&text, ""));
        self.operation = Some((statement.line, name.into()));
        self.next_tool = program::Tool { name: tool.trim().into(), ..Default::default() };
        self.tool_record = None;
        self.ready = Ready::No;
        self.push(statement.line, Op::Operation(name.trim().into()));
        Ok(())
    }

    /// `END-OF-PATH`: the operation ends.
    pub(super) fn end_of_path(&mut self, statement: &Statement) -> Outcome {
        self.no_pending_circle()?;
        if self.operation.take().is_none() {
            return Err(Fault::new(Rule::Malformed, "no TOOL PATH is open here"));
        }
        self.push(statement.line, Op::EndOfOperation);
        Ok(())
    }

    /// `FINI`, `END`: the end of the program.
    pub(super) fn fini(&mut self, statement: &Statement) -> Outcome {
        self.no_pending_circle()?;
        if !self.ended {
            self.ended = true;
            self.ready = Ready::No;
            self.push(statement.line, Op::End);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latin_1_and_utf_8_are_both_read() {
        assert_eq!(decode(b" Fr\xe4ser \x00 10 "), "Fräser   10");
        assert_eq!(decode("Fräser".as_bytes()), "Fräser");
    }

    #[test]
    fn a_key_is_found_in_any_case_and_never_cuts_a_character() {
        assert_eq!(after("stop here", "STOP"), Some(" here"));
        assert_eq!(after("stö", "STOP"), None);
    }
}
