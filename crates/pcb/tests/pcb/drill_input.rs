//! Bad drill files: a clear error, at its place, in bounded time.

use program::Diagnostic;
use toolpost_pcb::excellon::read;

fn errors(text: &str) -> Vec<Diagnostic> {
    let errors = read("bad.drl", text.as_bytes()).unwrap_err();
    for error in &errors {
        assert!(error.is_error() && error.file == "bad.drl" && error.line > 0, "{error}");
        assert!(!error.help.is_empty(), "{error}");
    }
    errors
}

#[test]
fn each_fault_has_its_rule_and_its_line() {
    for (text, rule, line) in [
        ("T2", "missing-tool", 6),
        ("T0\nX1.0Y1.0", "no-tool", 7),
        ("X1.0Y1.0\nT3C-1.0", "diameter", 7),
        ("T1C2.0", "diameter", 6),
        ("X1.0Y1.0Q5", "data-word", 6),
        ("X1.0.0Y1.0", "data-word", 6),
        ("X#", "data-word", 6),
        ("X1234567Y1.0", "format", 6),
        ("X1234Y1.0", "no-zeros", 6),
        ("X9999999.0Y1.0", "not-a-place", 6),
        ("G01X1.0Y1.0", "route", 6),
        ("G00X0.0Y0.0\nM15\nG02X1.0Y0.0", "arc", 8),
        ("G00X0.0Y0.0\nM15\nG02X5.0Y0.0A1.0", "arc", 8),
        ("G00X0.0Y0.0\nM15\nG02X5.0Y0.0I1.0", "arc", 8),
        ("G00X0.0Y0.0\nR5X1.0", "repeat", 7),
        ("X1.0Y1.0\nR0X1.0", "repeat", 7),
        ("X1.0Y1.0\nR4000000000X0.1", "too-large", 7),
        ("X1.0Y1.0\nR100000X100.0", "not-a-place", 7),
        ("M25", "pattern", 6),
        ("X1.0Y1.0M02X1.0", "pattern", 6),
        ("G84X1.0", "unknown-command", 6),
        ("M77", "unknown-command", 6),
        ("M97,TEXT", "unknown-command", 6),
        ("/X1.0Y1.0", "block-delete", 6),
        ("G93X1.0Y1.0", "unknown-command", 6),
    ] {
        let all = errors(&format!("M48\nMETRIC\nT1C1.0\n%\nT1\n{text}\nM30\n"));
        assert_eq!((all[0].rule.name(), all[0].line), (rule, line), "{text}: {}", all[0]);
    }
}

#[test]
fn what_a_file_has_to_say_first() {
    let first = |text: &str| errors(text)[0].rule.name();
    // 0.125 may be inches or mm.
    assert_eq!(first("M48\nT1C0.125\n%\nT1\nX1.0Y1.0\nM30"), "no-unit");
    assert_eq!(first("M48\nMETRIC\nT1F200S65\n%\nT1\nX1.0Y1.0\nM30"), "no-diameter");
    assert_eq!(first("M48\nMETRIC,TZ\n%\nX1.0Y1.0\nM30"), "no-tool");
    assert_eq!(first("M48\nMETRIC,QZ\n%\nM30"), "unit");
    assert_eq!(first("M48\nMETRIC\nVER,5\n%\nM30"), "axes");
    assert_eq!(first("M48\nMETRIC\nT1C1.0\n%\nT1\nX1.0Y1.0\n"), "no-end");
    assert_eq!(first("G04 a Gerber file*\n%FSLAX36Y36*%\n"), "data-word");
}

#[test]
fn at_most_twenty_errors() {
    let text = format!("M48\nMETRIC\nT1C1.0\n%\n{}M30\n", "T7\n".repeat(1000));
    assert_eq!(errors(&text).len(), 20);
}
