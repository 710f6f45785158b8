//! Programs that the SINUMERIK virtual control refuses, and where it says so.

use crate::common::sinumerik::{blocks, error, run, settings};
use program::{Diagnostic, Rule};
use toolpost_control::{Action, FeedPath, read};

#[test]
fn an_error_names_its_rule_and_place() {
    let mut wrong = Vec::new();
    for (text, rule, column) in [
        // words
        ("G1 X10 Q5", "unknown-word", 8),
        ("G1 X10 U5", "unknown-word", 8),
        ("N10 N20 X1", "syntax", 5),
        ("G0 X1 X=3", "repeated-word", 7),
        ("G43 H1", "unknown-word", 1),
        ("H5", "unsupported", 1),
        ("GOTOF END", "jump", 1),
        ("LATE: DEF REAL AA", "definition", 1),
        ("IF R1", "r-parameter", 4),
        ("(comment)", "syntax", 1),
        ("G75 X0\nG1 X=$AA_IW[X]", "unknown-position", 6),
        ("$P_UIFR", "syntax", 8),
        ("R1=$AN_MAGAZINE", "unsupported", 4),
        ("PART_2", "called-program", 1),
        ("G1X1GO", "unknown-word", 5),
        ("TRANSX10", "called-program", 1),
        ("MSG(\"open)", "syntax", 5),
        ("G1 X", "number", 5),
        ("G1 X--5", "number", 6),
        ("G1 X1.2.3", "syntax", 8),
        ("G1 X1e5", "unknown-word", 6),
        ("G1 X1EX", "number", 8),
        ("G1 X999999999", "number", 5),
        ("G1 X=1EX9*1EX300", "arithmetic", 6),
        ("S1.5 M3.5", "number", 6),
        ("T-1", "number", 1),
        ("T=\"\"", "tool", 1),
        ("G1 \u{0}", "syntax", 4),
        // expressions
        ("X=1/0", "arithmetic", 4),
        ("X=5 MOD 0", "arithmetic", 4),
        ("X=SQRT(-1)", "arithmetic", 3),
        ("X=ASIN(2)", "arithmetic", 3),
        ("X=R1000", "r-parameter", 4),
        ("R1=5 X=R1", "r-parameter", 8),
        ("X=FOO(1)", "unknown-word", 3),
        ("X=(1+2", "syntax", 7),
        ("X=", "syntax", 3),
        ("C=45+R24F100", "syntax", 9),
        ("X=SIN 30", "syntax", 7),
        // groups
        ("G1 G0 X1", "modal-group", 4),
        ("G54 G505", "repeated-word", 5),
        ("G505 G54", "modal-group", 6),
        ("G90 G91", "modal-group", 5),
        ("M3 M5", "modal-group", 1),
        ("M0 M30", "modal-group", 1),
        ("M8 M9", "modal-group", 1),
        ("M26 M27 M28 M29 M3 M8", "syntax", 20),
        // functions
        ("M10", "unknown-m", 1),
        ("M70", "unknown-m", 1),
        ("M1=30", "unknown-word", 1),
        ("S2=100", "unknown-word", 1),
        ("CT X5 Y5", "arc", 1),
        ("G1 X5\nCT X9", "arc", 1),
        ("G1 X5\nCT X9 Y5 CR=5", "arc", 1),
        ("G33 Z5 K1", "thread", 1),
        ("S100 M3\nG33 Z5", "thread", 1),
        ("S100 M3\nG33 X5 Z5 K1", "thread", 1),
        ("S100 M3\nG33 Z5 I1", "thread", 1),
        ("G331 Z5 K1", "thread", 1),
        ("G63 Z5", "thread", 1),
        ("G34 Z5 K1", "unsupported", 1),
        ("FLIN F100", "unsupported", 1),
        ("SETMS(2)", "unsupported", 1),
        ("GROUP_BEGIN(0,\"A\",0,1)", "unsupported", 1),
        ("M8 H10", "unsupported", 4),
        ("G110 X5 F5", "polar", 1),
        ("G0 AP=30", "polar", 1),
        ("G0 AP=30 RP=-5", "polar", 1),
        ("G0 AP=30 RP=5 X5", "polar", 1),
        ("G0 AP=IC(30) RP=5", "polar", 1),
        ("G91 G0 AP=30 RP=5", "polar", 1),
        ("G111 X5\nG18\nG0 AP=30 RP=5", "polar", 1),
        ("SUPA G0 AP=30 RP=5", "machine-position", 1),
        ("G1 ANG=30", "syntax", 1),
        ("G1 ANG=90 X5", "angle", 1),
        ("G1 ANG=180 X5", "angle", 1),
        ("G1 ANG=45 X5 Y5", "angle", 1),
        ("G2 ANG=45 X5", "angle", 1),
        ("SCALE X0", "frame", 1),
        ("SCALE X-2", "frame", 1),
        ("SCALE X2\nG2 X10 Y0 I5", "arc", 1),
        ("SCALE X2 Y2 Z2\nCYCLE81(10,0,2,-15)", "unsupported", 1),
        ("MIRROR Z0\nCYCLE81(10,0,2,-15)", "unsupported", 1),
        ("MIRROR Z0\nG1 G41 X5", "unsupported", 1),
        ("ROT Z45\nG58 X5", "unsupported", 1),
        ("G26 S100\nS200 M3", "spindle", 1),
        ("DIAMON\nTRANS X5", "unsupported", 1),
        ("DIAMON\nCIP X20 Y20 I1=5 J1=5 K1=100", "arc", 1),
        ("POS[X]=5 Y5", "syntax", 1),
        ("G96 S100", "unsupported", 1),
        ("G291", "unsupported", 1),
        // axes
        ("G0 B5", "unknown-axis", 1),
        ("X=DC(5)", "syntax", 1),
        ("G75 B0", "unknown-axis", 1),
        ("G74", "home", 1),
        ("SUPA G2 X5 Y5", "machine-position", 1),
        ("G75 Z0\nG91 G0 Z5", "unknown-position", 1),
        ("X1=5", "syntax", 1),
        // feed and arcs
        ("G95\nG1 X5", "no-feed", 1),
        ("G93 G1 X5 F10\nX6", "no-feed", 1),
        ("F0", "feed", 1),
        ("F-5", "feed", 1),
        ("G1 X5 I3", "arc", 1),
        ("G2 X5 Y5", "arc", 1),
        ("G2 X5 Y5 K5", "arc", 1),
        ("G2 X5 Y5 I5 CR=5", "arc", 1),
        ("G2 X0 Y0 CR=5", "arc", 1),
        ("G2 X20 Y0 CR=9", "arc-radius", 1),
        ("G2 X20.011 Y0 I10 J0", "arc-radius", 1),
        ("G2 X0 Y5 I0 J0", "arc", 1),
        ("G2 X5 Y5 AR=360", "arc", 1),
        ("G2 X5 AR=90 I5", "arc", 1),
        ("G2 X20 Y0 I10 TURN=1.5", "arc", 1),
        ("G2 X20 Y0 I10 A5", "arc", 1),
        ("G2 X20 Z90 I10 J0", "helix-end-point", 1),
        ("G2 Y0 Z90 I10 J0", "helix-end-point", 1),
        ("G75 X0\nG2 X20 Y0 I10", "arc", 1),
        ("CIP X20 Y0 I1=10 J1=0", "arc", 1),
        ("CIP X20 Y20 I1=10", "arc", 1),
        ("CIP X20 Y0 I1=10 J1=5 TURN=1", "arc", 1),
        // compensation
        ("G2 G41 X20 Y0 I10 J0", "compensation", 1),
        ("G1 G41\nG2 X20 Y0 I10 J0", "compensation", 1),
        ("G1 G41 X5\nG2 G40 X20 Y0 CR=20", "compensation", 1),
        ("D0\nG1 G42 X5", "compensation", 1),
        ("G1 G41 X5\nG18", "compensation", 1),
        ("G1 G41 X5\nG75 Z0", "compensation", 1),
        ("G1 G41 X5\nTRAORI", "compensation", 1),
        ("G1 G41 X5\nTRANS X5", "compensation", 1),
        // dwell, frames, orientation
        ("G4", "dwell", 1),
        ("G4 F1 X5", "dwell", 1),
        ("G4 S5", "dwell", 1),
        ("TRANS X5 F5", "frame", 1),
        ("ROT RPL=5 X5", "frame", 1),
        ("TRANS RPL=5", "frame", 1),
        ("A3=0 B3=0 C3=1", "orientation", 1),
        ("TRAORI\nA3=0 B3=0 C3=0", "zero-vector", 1),
        ("TRAORI\nORIMKS\nA3=1", "unsupported", 1),
        ("TRAORI\nA3=1 C5", "orientation", 1),
        ("TRAORI(2)", "unsupported", 1),
        ("TRAORI\nG75 Z0", "home", 1),
        ("TRAORI\nG0 SUPA Z0 D0", "home", 1),
        ("TRAORI X5", "syntax", 1),
        ("CYCLE800(1,\"\",0,192,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,0)", "unsupported", 1),
        ("CYCLE800(3,\"\",0,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",100,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,5,0,57,0,0,0,30,45,0,0,0,0,1)", "cycle-parameter", 1),
        // _ST: internal, frame without motion, directions that differ, and what no source says.
        ("CYCLE800(1,\"\",1000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",10000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",220000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",100000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",200000,57,0,0,0,30,45,0,0,0,0,-1)", "unsupported", 1),
        ("CYCLE800(1,\"\",300000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",1000000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",2200000,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        ("CYCLE800(1,\"\",20,57,0,0,0,30,45,0,0,0,0,1)", "unsupported", 1),
        // _DMODE: the plane that is not G17, and what no source says.
        ("CYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,1,0,2)", "unsupported", 1),
        ("CYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,1,0,3)", "unsupported", 1),
        ("CYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,1,0,11)", "unsupported", 1),
        ("G18\nCYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,1,0,0)", "unsupported", 1),
        ("G19\nCYCLE800(1,\"\",0,57,0,0,0,30,45,0,0,0,0,1,0,1)", "unsupported", 1),
        ("CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,1)\nG0 A5", "orientation", 1),
        ("CYCLE832(0.01,112103)", "unsupported", 1),
        ("CYCLE800(1,\"\",0,57,0,0,0,90,0,0,0,0,0,1)\nG0 X5 Z50", "unknown-position", 1),
    ] {
        let found = error(text);
        let line = text.lines().count() as u32;
        if (found.rule.name(), found.line, found.column) != (rule, line, column) {
            wrong.push(format!("{text:?} should be {rule} at column {column}: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_program_ends_once_at_its_last_line() {
    for (text, line) in
        [("G0 X1\n", 1), ("", 0), ("M30\nG0 X1\n", 2), ("M17\nM30\n", 2), ("G0 X1 RET\n", 1)]
    {
        let error = run(text).unwrap_err();
        assert!(error.line == line && error.is_error(), "{text:?}: {error}");
    }
    assert!(run("RET\n\n; words\n").is_ok());
    // Where the motion goes does not depend on it: a source is read, and a program that is to be proven refused.
    let risks =
        |text| run(text).unwrap().into_iter().filter(|e| matches!(e.action, Action::Risk(_)));
    assert_eq!(risks("G0 X1\nM30\n").count(), 0);
    let found: Vec<_> = risks("G0 X1\nM30").map(|event| (event.line, event.action)).collect();
    let [(2, Action::Risk(risk))] = found.as_slice() else { panic!("{found:?}") };
    assert!(risk.rule.name() == "line-end" && risk.refused);
}

#[test]
fn a_block_is_not_longer_than_512_characters() {
    let longest = format!(";{}\nM30\n", "x".repeat(510));
    assert!(run(&longest).is_ok());
    let longer = format!(";{}\nM30\n", "x".repeat(511));
    assert_eq!(run(&longer).unwrap_err().rule.name(), "block-length");
}

#[test]
fn a_header_stands_first_and_names_a_program() {
    assert!(run("%_N_A_MPF\nM30\n").is_ok());
    assert_eq!(run("%\nM30\n").unwrap_err().rule.name(), "header");
    let unended = run("G0 X1\n%_N_A_MPF\nM30\n").unwrap_err();
    assert_eq!((unended.rule.name(), unended.line), ("program-end", 1));
}

#[test]
fn traori_needs_rotary_axes() {
    let three_axes = toolpost_control::Settings { rotary: [false; 3], ..settings() };
    let text = b"TRAORI\nM30\n";
    let error = read(&three_axes, "p.mpf", text, &mut |_| Ok(())).unwrap_err();
    assert_eq!(error.rule.name(), "orientation");
}

#[test]
fn brackets_and_signs_nest_so_deep_and_no_deeper() {
    let nested = |n: usize| format!("G0 X={}1{}", "(".repeat(n), ")".repeat(n));
    assert_eq!(blocks(&nested(30)).len(), 2);
    assert_eq!(error(&nested(100)).rule.name(), "syntax");
    assert_eq!(error(&format!("G0 X={}1", "-".repeat(200))).rule.name(), "syntax");
}

#[test]
fn what_the_sink_answers_stops_the_program_unchanged() {
    let answer = Diagnostic::error(Rule::Stop, "enough");
    let mut count = 0;
    let error = read(&settings(), "p.mpf", b"G0 X1\nG0 X2\nM30\n", &mut |record| {
        count += 1;
        if matches!(record.action, Action::Rapid(_)) { Err(answer.clone().into()) } else { Ok(()) }
    })
    .unwrap_err();
    assert_eq!((count, error.rule.name(), error.line), (1, "stop", 0));
}

#[test]
fn a_parameter_that_no_block_has_set_keeps_what_another_program_left_there() {
    let found = error("G0 C=45+R25");
    assert_eq!((found.rule.name(), found.line, found.column), ("r-parameter", 1, 9), "{found}");
    assert!(found.help.contains("operator_parameters = [\"R25\"]"), "{found}");
    assert_eq!(error("R1=R2+1").rule.name(), "r-parameter");
    assert_eq!(error("G0 X=R[R24]").rule.name(), "operator-offset");
    assert_eq!(blocks("R25=5\nG0 X=R25").len(), 2);
}

#[test]
fn an_axis_that_the_operator_shifts_is_shifted_in_every_block() {
    // The start of the tests has written C0: the operator's 5 degrees would move C from there.
    let jump = error("G0 C=45+R24");
    assert_eq!((jump.rule.name(), jump.line), ("operator-offset", 1), "{jump}");
    assert!(jump.message.contains("in line 2"), "{jump}");
    let start = "T1 M6\nG0 X0 Y0 Z100 A0 C=0+R24 F500\n";
    let found = |text: &str| run(&format!("{start}{text}\nM30\n"));
    assert!(found("G0 C=45+R24\nG1 C=R24+50.5 X5\nG0 C=AC(10+R24)\nG91 C5\nG90 C=R24").is_ok());
    for text in ["C45", "C=45", "C=DC(45)", "R24=0\nC=45+R24"] {
        let found = *found(text).expect_err(text);
        assert_eq!(found.rule.name(), "operator-offset", "{found}");
        assert!(found.message.contains("in line 2"), "{found}");
    }
    for text in [
        "C=45-R24",
        "C=45+2*R24",
        "C=45+(R24)",
        "C=45+R24+R24",
        "C=ABS(R24)",
        "C=-R24",
        "G91 C=5+R24",
        "C=IC(5+R24)",
        "X=5+R24",
        "G1 X5 F=100+R24",
        "R1=R24",
        "M=R24",
    ] {
        let found = *found(text).expect_err(text);
        assert_eq!(found.rule.name(), "operator-offset", "{text}: {found}");
    }
}

#[test]
fn a_feed_group_without_a_linear_axis_makes_another_feed() {
    assert_eq!(error("FGROUP(X,Y,A,C)").rule.name(), "feed-group");
    assert!(error("FGROUP(X,Y)").message.contains("without Z"));
    assert_eq!(error("FGROUP(X,Y,Z,Q)").rule.name(), "feed-group");
    assert_eq!(error("FGROUP(X,Y,Z,B)").rule.name(), "unknown-axis");
    let group = |c| Action::FeedPath(FeedPath::Group([1.0, 0.0, c]));
    let none = Action::FeedPath(FeedPath::Group([0.0; 3]));
    let path = [group(1.0), group(20f64.to_radians()), group(1.0), none, Action::End];
    let program = "FGROUP()\nFGROUP(X,Y,Z)\nFGROUP(X,Y,Z,A,C)\nFGREF[C]=20\nFGREF[C]=57.29577951308232\nFGROUP()";
    assert_eq!(blocks(program), path);
    assert_eq!(error("FGREF[X]=20").rule.name(), "feed-group");
    assert_eq!(error("FGREF[C]=0").rule.name(), "feed-group");
}

/// What is too far, the proof says. `ADISPOS` is the distance of rapids.
#[test]
fn how_far_the_path_may_be_left_is_reported() {
    use program::PathMode::{AsSetUp, Blend};
    let modes = |text: &str| {
        let found = blocks(text).into_iter().filter_map(|action| match action {
            Action::PathMode(mode) => Some(mode),
            _ => None,
        });
        found.collect::<Vec<_>>()
    };
    assert_eq!(
        modes("CYCLE832(0.1,_FINISH,1)\nCTOL=0.1\nCTOL=0.05\nCYCLE832(0,_OFF,1)\nCYCLE832()"),
        [Blend(0.1), Blend(0.05), AsSetUp]
    );
    assert_eq!(modes("CYCLE832(5,_ROUGH,1)\nCYCLE832(0.01,_FINISH,1)"), [Blend(5.0), Blend(0.01)]);
    assert_eq!(modes("G70 CTOL=0.01\nCTOL=-1"), [Blend(0.254), AsSetUp]);
    // Both may act at one corner.
    assert_eq!(
        modes("G641 ADIS=1\nCTOL=0.5\nCTOL=2\nADIS=0\nCTOL=-1"),
        [Blend(1.0), Blend(2.0), AsSetUp]
    );
    assert_eq!(modes("CTOL=0"), [Blend(0.0)]);
    let found = error("G641 ADISPOS=0.2");
    assert_eq!(found.rule.name(), "path-tolerance", "{found}");
    assert!(found.message.contains("allows 0.1 mm"), "{found}");
    assert_eq!(modes("G641 ADISPOS=0.1\nADISPOS=0"), [AsSetUp; 0]);
}
