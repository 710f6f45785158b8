//! Input that is broken, hostile or something else: a clear refusal, in bounded time and memory.

use program::Diagnostic;
use toolpost_source::apt::{Options, Reading, read};

fn try_read(text: impl AsRef<[u8]>) -> Result<Reading, Vec<Diagnostic>> {
    read("part.cls", text.as_ref(), &Options::default())
}

/// The first error of `text`.
#[track_caller]
fn refusal(text: impl AsRef<[u8]>) -> Diagnostic {
    try_read(text).expect_err("this must not be read").remove(0)
}

const GOOD: &str = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\n\
                    RAPID\nGOTO/0,0,10\nGOTO/1.5,2.5,-3\nFINI\n";

#[test]
fn an_empty_file_is_refused() {
    for text in ["", "\n\n\n", " \t\r\n", "\0\0\0", "\u{feff}"] {
        let error = refusal(text);
        assert_eq!(
            (error.rule.name(), error.file.as_str()),
            ("not-cldata", "part.cls"),
            "{text:?}"
        );
    }
}

#[test]
fn a_binary_file_is_refused_before_it_is_read_to_its_end() {
    // A linear congruential generator: any bytes, the same each time.
    let mut state = 1u32;
    let bytes: Vec<u8> = (0..4_000_000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        })
        .collect();
    let errors = try_read(&bytes).unwrap_err();
    assert!(errors.len() <= 20);
    assert!(errors.iter().all(|e| e.line > 0 && e.file == "part.cls"));
    assert_eq!(refusal(b"\xff\xfeG\0O\0T\0O\0").rule.name(), "encoding");
    let elf = [b"\x7fELF\x02\x01\x01".as_slice(), &[0; 5000]].concat();
    assert_eq!(refusal(elf).rule.name(), "not-cldata");
}

#[test]
fn line_ends_blanks_and_control_characters_change_nothing() {
    let good = try_read(GOOD).unwrap();
    for text in [
        GOOD.replace('\n', "\r\n"),
        GOOD.replace('\n', "\r"),
        GOOD.replace('\n', " \0\n"),
        GOOD.replace('\n', "\t\x1a\n"),
        GOOD.replace('/', "  /  ").replace(',', " , "),
        format!("\u{feff}{GOOD}"),
        GOOD.trim_end().to_owned(),
    ] {
        assert_eq!(try_read(&text).unwrap(), good, "{text:?}");
    }
}

#[test]
fn latin_1_names_are_read() {
    let text = [b"PARTNO/Geh\xe4use\n".as_slice(), GOOD.as_bytes()].concat();
    assert_eq!(try_read(text).unwrap().program.name, "Gehäuse");
}

#[test]
fn one_endless_line_costs_nothing_but_its_reading() {
    // One gigabyte; the allocator gives it as zero pages, which are control characters. Then one of
    // digits, a hundredth of that.
    let mut huge = vec![0u8; 1 << 30];
    huge[..5].copy_from_slice(b"GOTO/");
    let error = refusal(&huge);
    assert_eq!((error.rule.name(), error.line), ("line-too-long", 1));
    assert!(error.to_string().len() < 1000);
    drop(huge);
    let mut digits = b"GOTO/1,2,".to_vec();
    digits.resize(10 << 20, b'7');
    assert_eq!(refusal(&digits).rule.name(), "line-too-long");
    for head in ["$$ ", "PPRINT/", "NOSUCH/", "INSERT/STOP "] {
        let text = format!("{head}{}\n{GOOD}", "x".repeat(10 << 20));
        assert_eq!(refusal(&text).rule.name(), "line-too-long", "{head}");
    }
}

#[test]
fn endless_continuation_is_refused() {
    assert_eq!(refusal("GOTO/1,$\n".repeat(200_000)).rule.name(), "line-too-long");
    assert_eq!(refusal("GOTO/1,2,3$").rule.name(), "truncated");
    assert_eq!(refusal("GOTO/1,2,").rule.name(), "truncated");
}

#[test]
fn deep_nesting_and_many_fields_are_only_long_lines() {
    assert_eq!(refusal(format!("GOTO/{}", "(".repeat(60_000))).rule.name(), "malformed");
    assert_eq!(refusal(format!("GOTO/{}1", "1,".repeat(30_000))).rule.name(), "malformed");
    assert_eq!(
        refusal(format!("CYCLE/DRILL,{}1", "FEDTO,1,".repeat(8_000))).rule.name(),
        "malformed"
    );
}

#[test]
fn errors_are_all_shown_up_to_a_cap_and_there_is_no_partial_program() {
    let text = GOOD.replace("FINI", "GOTO/1\nGOTO/A,B,C\nCIRCLE/0\nFINI");
    let errors = try_read(&text).unwrap_err();
    let places: Vec<(u32, u32)> = errors.iter().map(|e| (e.line, e.column)).collect();
    assert_eq!(places, [(8, 6), (9, 6), (10, 8)]);
    assert_eq!(try_read(format!("{GOOD}{}", "GOTO/1\n".repeat(1000))).unwrap_err().len(), 20);
}

#[test]
fn an_error_says_which_word_is_no_number() {
    for (word, message) in [
        ("nan", "nan is not a number"),
        ("A12", "A12 is not a number"),
        ("-inf", "-inf is not a number"),
        ("1E", "1E is not a number"),
        ("1D999", "this number is too large"),
    ] {
        let error = refusal(GOOD.replace("2.5", word));
        assert_eq!((error.rule.name(), error.line, error.column), ("malformed", 7, 10), "{word}");
        assert_eq!(error.message, message);
        assert!(!error.help.is_empty());
    }
    let missing = refusal(GOOD.replace("LOAD/TOOL,1", "CUTTER/\nLOAD/TOOL,1"));
    assert_eq!(missing.message, "the diameter is missing");
    // An exponent as Fortran writes it.
    assert_eq!(try_read(GOOD.replace("2.5", ".25D1")), try_read(GOOD));
}

#[test]
fn an_error_shows_its_place() {
    let text = GOOD.replace("GOTO/1.5,2.5,-3", "GOTO/1.5,2.5,-3,0,0,0");
    let shown = refusal(&text).to_string();
    let expected = "part.cls:7:17: error[zero-vector]: this vector has no direction\n\
                    \u{20}   | GOTO/1.5,2.5,-3,0,0,0\n\
                    \u{20}   |                 ^^^^^\n";
    assert!(shown.starts_with(expected), "{shown}");
    // In a statement over several lines, on the line where it is.
    let text = GOOD.replace("GOTO/1.5,2.5,-3", "GOTO/1.5,$\n2.5,$\n1E9");
    let error = refusal(&text);
    assert_eq!((error.rule.name(), error.line, error.column), ("out-of-range", 9, 1));
}

#[test]
fn cuts_need_a_spindle_and_a_feed_and_tools_a_number() {
    for (from, to, rule, line) in [
        ("SPINDL/1000,RPM,CLW\n", "", "spindle-off", 6),
        ("SPINDL/1000,RPM,CLW\n", "SPINDL/0,RPM,CLW\n", "spindle-off", 7),
        ("RAPID\n", "SPINDL/OFF\nRAPID\n", "spindle-off", 8),
        ("FEDRAT/100,MMPM\n", "", "no-feed", 6),
        ("FEDRAT/100", "FEDRAT/0", "no-feed", 7),
        ("LOAD/TOOL,1", "LOAD/TOOL,0", "tool-number", 2),
        ("UNITS/MM", "UNITS/CUBIT", "unknown-unit", 1),
        ("UNITS/MM\n", "FEDRAT/5,IPM\n", "unknown-unit", 1),
    ] {
        let error = refusal(GOOD.replace(from, to));
        assert_eq!((error.rule.name(), error.line), (rule, line), "{to}");
    }
}

#[test]
fn a_unit_that_comes_after_the_first_length_is_refused_where_it_changes_that() {
    let rest = "FEDRAT/10,MMPM\nRAPID\nGOTO/0,0,2\nGOTO/0,0,-1\nFINI";
    // A cutter of 0.5 inches read as 0.5 mm would turn 25.4 times too fast by its surface speed.
    for (before, line) in [
        ("CUTTER/0.5", 2),
        ("SPINDL/3000,CLW\nFEDRAT/10", 3),
        ("SPINDL/3000,CLW\nFEDRAT/0.1,PERREV", 3),
        ("RAPID\nGOTO/0,0,2", 3),
        ("SPINDL/9,CLW\nFEDRAT/1,MMPM\nGOTO/0,0,0\nGOTO/1,2,3", 4),
        ("ORIGIN/0,0,1", 2),
        ("LOADTL/2,LENGTH,100", 2),
    ] {
        let units = before.lines().count() as u32 + 2;
        let text = format!("LOAD/TOOL,1\n{before}\nUNITS/INCHES\nSPINDL/9,CLW\n{rest}");
        let mut errors = try_read(text).unwrap_err();
        assert_eq!(errors.len(), 1, "{errors:?}");
        let error = errors.remove(0);
        assert_eq!((error.rule.name(), error.line), ("unknown-unit", units), "{before}");
        assert!(error.message.contains(&format!("line {line} ")), "{}", error.message);
        assert!(!error.help.is_empty());
    }
    // Nothing was read that the unit would change.
    for before in
        ["ORIGIN/0,0,0", "MSYS/0,0,0,1,0,0,0,1,0", "FEDRAT/10,MMPM", "UNITS/MM\nCUTTER/0.5"]
    {
        let text = format!("LOAD/TOOL,1\n{before}\nUNITS/INCHES\nSPINDL/9,CLW\n{rest}");
        assert!(try_read(text).is_ok(), "{before}");
    }
    let millimetres = format!("LOAD/TOOL,1\nCUTTER/10\nUNITS/MM\nSPINDL/9,CLW\n{rest}");
    assert_eq!(try_read(millimetres).unwrap().warnings, []);
}

#[test]
fn what_is_cut_off_is_refused_or_said() {
    let nx =
        "UNITS/MM\nTOOL PATH/A,TOOL,B\nLOAD/TOOL,1\nSPINDL/RPM,1,CLW\nFEDRAT/1,MMPM\nGOTO/1,2,3\n";
    assert_eq!(refusal(nx).rule.name(), "truncated");
    let makino = "PPRINT/APTCL-SPEC,MAKINO-FF,1\nPPRINT/BEGIN-SECTION,PATH\nUNITS/MM\nLOAD/TOOL,1\nRAPID\nGOTO/1,2,3\n";
    assert_eq!(refusal(makino).rule.name(), "truncated");
    let plain = GOOD.replace("FINI\n", "");
    assert_eq!(try_read(&plain).unwrap().warnings[0].rule.name(), "no-fini");
    assert_eq!(refusal("UNITS/MM\nFINI\n").rule.name(), "no-motion");
    assert_eq!(refusal(format!("{GOOD}GOTO/1,2,3\n")).rule.name(), "after-end");
}

#[test]
fn a_makino_file_of_tool_centres_is_refused() {
    let text = format!("PPRINT/APTCL-SPEC,MAKINO-FF,1\nPPRINT/TOOL-POSITION,TOOL-CENTER\n{GOOD}");
    assert_eq!(refusal(text).rule.name(), "tool-position");
}
