//! Bad Gerber files: a clear error, at its place, in bounded time.

use program::Diagnostic;
use std::time::Instant;
use toolpost_pcb::gerber::read;

fn errors(text: &str) -> Vec<Diagnostic> {
    let errors = read("bad.gbr", text.as_bytes()).unwrap_err();
    for error in &errors {
        assert!(error.is_error() && error.file == "bad.gbr" && error.line > 0, "{error}");
        assert!(!error.help.is_empty(), "{error}");
    }
    errors
}

/// The first error's rule, line and column.
fn first(text: &str) -> (&'static str, u32, u32) {
    let errors = errors(text);
    (errors[0].rule.name(), errors[0].line, errors[0].column)
}

const HEAD: &str = "%FSLAX36Y36*%\n%MOMM*%\n%ADD10C,1*%\nD10*\n";

#[test]
fn each_fault_has_its_rule_and_its_place() {
    for (text, rule, line, column) in [
        ("D11*", "missing-aperture", 5, 1),
        ("X0Y0D03*D12*", "missing-aperture", 5, 9),
        ("%ADD11NONE,1*%", "missing-macro", 5, 2),
        ("%ADD11C,-1*%", "aperture", 5, 2),
        ("%ADD11R,1X0*%", "aperture", 5, 2),
        ("%ADD11C,1X2X3X4*%", "aperture", 5, 2),
        ("%ADD11P,1X2*%", "aperture", 5, 2),
        ("%ADD9C,1*%", "aperture", 5, 2),
        ("%ADD11C,abc*%", "aperture", 5, 2),
        ("%AMM*\n1,1,1/($1-1),0,0*%\n%ADD11M,1*%", "macro-division", 6, 1),
        ("%AMM*\n9,1,1*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n1,2,1,0,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n1,1*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n5,1,2,0,0,1,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n4,1,3,0,0,1,0,1,1,0,1,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n4,1,4,0,0,2,2,2,0,0,2,0,0,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n4,1,1000000000,0,0,1,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n7,0,0,4,5,1,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n7,0,0,4,2,3,0*%\n%ADD11M,1*%", "macro-primitive", 6, 1),
        ("%AMM*\n1,1,1+,0,0*%", "macro-expression", 6, 1),
        ("%AMM*\n1,1,1,9999999,0*%\n%ADD11M*%", "macro-value", 6, 1),
        ("G36*X0Y0D02*X1000000D01*Y1000000D01*G37*", "region-open", 5, 37),
        (
            "G36*\nX0Y0D02*X2000000Y2000000D01*X2000000Y0D01*X0Y2000000D01*X0Y0D01*\nG37*",
            "region-crosses-itself",
            7,
            1,
        ),
        ("G36*X0Y0D02*X1000000D01*M02*", "region", 5, 29),
        ("G37*", "region", 5, 1),
        ("G36*X0Y0D03*G37*", "region", 5, 5),
        ("G03*X0Y0D02*X5000000D01*", "no-quadrant", 5, 13),
        ("G75*G03*X0Y0D02*X5000000I1000000J0D01*", "arc-center", 5, 17),
        ("G75*G03*X0Y0D02*X5000000D01*", "arc-center", 5, 17),
        ("G74*G03*X0Y0D02*X5000000I1000000J0D01*", "arc-center", 5, 17),
        ("X9999999999999Y0D03*", "not-a-place", 5, 1),
        ("X1.5Y0D03*", "data-word", 5, 1),
        ("X0Y0*", "no-operation", 5, 1),
        ("G05*", "data-word", 5, 1),
        ("Q1*", "data-word", 5, 1),
        ("%XX*%", "unknown-command", 5, 2),
        ("%LPX*%", "load", 5, 2),
        ("%LS0*%", "load", 5, 2),
        ("%MIA1*%", "image-transformation", 5, 2),
        ("%IPNEG*%", "image-transformation", 5, 2),
        ("%MOIN*%", "unit", 5, 2),
        ("%FSLAX24Y24*%", "format", 5, 2),
        ("%SRX0Y1*%", "step-and-repeat", 5, 2),
        ("%ABD11*%%SRX2Y1I1J0*%", "step-and-repeat", 5, 10),
        ("%AB*%", "block", 5, 2),
        ("%ABD11*%X0Y0D03*", "block", 5, 0),
        ("%ABD11*%X0Y0D03*%AB*%X1000000D01*", "no-point", 5, 22),
        ("X0Y0D03", "unterminated", 5, 1),
        ("%LPD%", "unterminated", 5, 2),
        ("%ADD11R,1X1*%D11*G75*G03*X0Y0D02*X0I1000000J0D01*", "pen", 5, 34),
        ("%ADD11O,1X2*%D11*X0Y0D02*X1000000D01*", "pen", 5, 26),
    ] {
        let end = if text.contains("M02") || rule == "unterminated" { "" } else { "\nM02*" };
        let (found, at, on) = first(&format!("{HEAD}{text}{end}"));
        let placed = if rule == "block" && column == 0 { true } else { (at, on) == (line, column) };
        assert!(found == rule && placed, "{text}: {found} at {at}:{on}");
    }
}

#[test]
fn what_a_file_has_to_say_first() {
    assert_eq!(first("%MOMM*%\n%ADD10C,1*%\nD10*\nX0Y0D03*\nM02*").0, "no-format");
    assert_eq!(first("%FSLAX36Y36*%\n%ADD10C,1*%\nM02*"), ("no-unit", 2, 2));
    // What follows from that is not said.
    let late = "%FSLAX24Y24*%\n%ADD10C,0.01*%\nG70*\nD10*\nX0Y0D02*\nX10000D01*\nM02*";
    assert_eq!(errors(late).len(), 1, "{:?}", errors(late));
    assert_eq!(first("%FSLAX36Y36*%%MOMM*%\nX0Y0D03*\nM02*"), ("missing-aperture", 2, 1));
    assert_eq!(first(&format!("{HEAD}X0Y0D03*\n")), ("no-end", 6, 1));
    assert_eq!(first("").0, "no-end");
    assert_eq!(first("PK\u{3}\u{4} not a layer at all").0, "unterminated");
}

#[test]
fn at_most_twenty_errors() {
    let text = format!("{HEAD}{}M02*", "D77*\n".repeat(1000));
    assert_eq!(errors(&text).len(), 20);
}

/// Each took more than 20 s and up to 4 GB.
#[test]
fn what_would_be_painted_for_minutes_is_refused_at_once() {
    let start = Instant::now();
    // A macro that adds and erases in turn, flashed four times.
    let turns = "1,1,1,$1,0*1,0,1,$1,1*".repeat(5000);
    let erasing = format!("{HEAD}%AMM*{turns}%%ADD100M,1*%D100*{}M02*", "X0Y0D03*".repeat(4));
    assert_eq!(first(&erasing).0, "too-large");
    let once = format!("{HEAD}%AMM*{turns}%%ADD100M,1*%D100*X0Y0D03*M02*");
    assert!(read("once.gbr", once.as_bytes()).is_ok());
    // A large macro, and a region of a thousand lines, painted often.
    let disc = format!("%AMM*{}%%ADD100M,1*%D100*", "1,1,1,$1,0*".repeat(10_000));
    assert_eq!(first(&format!("{HEAD}{disc}{}M02*", "X0Y0D03*".repeat(1000))).0, "too-large");
    let region: String = (0..1000).map(|i| format!("X{i}000000Y{}D01*", i * i)).collect();
    let region = format!("G36*X0Y0D02*{region}X0Y1000000000D01*X0Y0D01*G37*");
    let copies = format!("{HEAD}%SRX100Y100I1J1*%{region}%SR*%M02*");
    assert_eq!(first(&copies).0, "too-large");
    // Dark and clear in turn.
    let turns = "%LPD*%X0Y0D03*%LPC*%X1Y1D03*".repeat(5001);
    assert_eq!(first(&format!("{HEAD}D10*{turns}M02*")).0, "polarity-changes");
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn what_grows_without_bound_is_refused_at_once() {
    let start = Instant::now();
    let repeat = format!("{HEAD}%SRX1000000000Y1I1J1*%X0Y0D03*%SR*%M02*");
    assert_eq!(first(&repeat).0, "too-large");
    assert_eq!(
        first(&format!("{HEAD}%SRX4294967295Y4294967295I1J1*%X0Y0D03*%SR*%M02*")).0,
        "too-large"
    );
    // Each block flashes the one before twice.
    let mut doubling = format!("{HEAD}%ABD100*%D10*X0Y0D03*%AB*%");
    for number in 101..200 {
        doubling += &format!("%ABD{number}*%D{}*X0Y0D03*X1D03*%AB*%", number - 1);
    }
    assert_eq!(first(&format!("{doubling}M02*")).0, "too-large");
    // Each block makes the one before a million times as large.
    let mut growing = format!("{HEAD}%ABD100*%D10*X1Y0D03*%AB*%%LS999999*%");
    for number in 101..200 {
        growing += &format!("%ABD{number}*%D{}*X1Y0D03*%AB*%", number - 1);
    }
    assert_eq!(first(&format!("{growing}M02*")).0, "not-a-place");
    // A long macro, evaluated often.
    let long = format!("%AMM*{}%", "1,1,$1+$2+$3,0,0*".repeat(10_000));
    let often: String = (11..10_011).map(|i| format!("%ADD{i}M,1*%")).collect();
    assert_eq!(first(&format!("{HEAD}{long}{often}M02*")).0, "too-large");
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn a_thousand_blocks_in_each_other_are_read() {
    let open: String = (1000..2000).map(|i| format!("%ABD{i}*%")).collect();
    let close: String = (1000..2000).rev().map(|i| format!("X0Y0D03*%AB*%D{i}*")).collect();
    let text = format!("{HEAD}{open}{close}X5000000Y0D03*M02*");
    let image = read("deep.gbr", text.as_bytes()).unwrap().image;
    assert_eq!(image.objects.len(), 1);
}

#[test]
fn a_tangle_is_refused_or_read_but_never_endless() {
    let start = Instant::now();
    // A comb of long teeth, all above each other: no crossing, and no quick test for that.
    let teeth: String =
        (0..20_000).map(|i| format!("X{}Y{}D01*", (i % 2) * 900_000_000, i * 10)).collect();
    let comb = format!("{HEAD}G36*X-1000000Y0D02*{teeth}X-1000000D01*Y0D01*G37*M02*");
    if let Err(errors) = read("comb.gbr", comb.as_bytes()) {
        assert!(
            ["region-too-complex", "region-crosses-itself"].contains(&errors[0].rule.name()),
            "{}",
            errors[0]
        );
    }
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}

#[test]
fn time_and_memory_are_linear_in_the_file() {
    // 18 MB of strokes.
    let mut text = String::from(HEAD);
    for i in 0..800_000 {
        text += &format!("X{}Y{}D01*\n", 10_000_000 + i % 1000 * 1000, 10_000_000 + i * 100);
    }
    text += "M02*";
    assert!(text.len() > 18_000_000, "{}", text.len());
    let start = Instant::now();
    assert_eq!(read("large.gbr", text.as_bytes()).unwrap().image.objects.len(), 800_000);
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}

#[test]
fn an_empty_layer_is_empty() {
    let reading = read("empty.gbr", format!("{HEAD}M02*").as_bytes()).unwrap();
    assert!(reading.image.objects.is_empty() && reading.image.extents().is_none());
}
