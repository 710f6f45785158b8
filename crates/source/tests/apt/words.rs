//! Names, comments, unknown words, and the published sample of CATIA.

use crate::support::{HEAD, HEAD_OPS, at, error, ops, reading, warnings};
use geom::Vec3;
use program::{ArcTo, Circle, Feed, Op, Spindle, Tool};
use toolpost_source::apt::{Dialect, Options, read};

/// The published sample of CATIA (with a start for its first motion): centre (-42, 8), radius 21, end
/// (-42, 29) = centre + (0, 21), setting out along +Y.
const CATIA: &str = "$$ OPERATION NAME : Profile Contouring.2
$$ Start generation of : Profile Contouring.2
LOADTL/3,1
FEDRAT/ 300.0000,MMPM
SPINDL/ 70.0000,RPM,CLW
FEDRAT/ 1000.0000,MMPM
GOTO / -62.00000, -48.00000, 14.00000
RAPID
GOTO / -63.00000, -47.00000, 14.00000
GOTO / -63.00000, 8.00000, 14.00000
INDIRV/ 0.00000, 1.00000, 0.00000
TLON,GOFWD/(CIRCLE/-42.00000,8.00000,14.00000,$21.00000),
ON,(LINE/-42.00000, 8.00000, 14.00000,$-42.00000, 29.00000,14.00000)
";

#[test]
fn the_published_sample_of_catia_is_read() {
    let reading = reading(CATIA);
    assert_eq!(reading.dialect, Dialect::Catia);
    let ops: Vec<&Op> = reading.program.records.iter().map(|r| &r.op).collect();
    let center = Vec3::new(-42., 8., 14.);
    // From (-63, 8) up: clockwise, a quarter.
    let arc =
        ArcTo { end: at(-42., 29., 14.), circle: Circle::new(center, Vec3::NEG_Z, 0).unwrap() };
    let tool = Tool { number: 3, offset: Some(1), ..Tool::default() };
    let expected = [
        Op::Operation("Profile Contouring.2".into()),
        Op::Comment("Start generation of : Profile Contouring.2".into()),
        Op::Tool(Box::new(tool)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Spindle(Spindle::Clockwise(70.0)),
        Op::Feed(Feed::PerMinute(1000.0)),
        Op::Line(at(-62., -48., 14.)),
        Op::Rapid(at(-63., -47., 14.)),
        Op::Line(at(-63., 8., 14.)),
        Op::Arc(Box::new(arc)),
        Op::End,
    ];
    assert_eq!(ops, expected.iter().collect::<Vec<_>>());
    let rules: Vec<&str> = reading.warnings.iter().map(|w| w.rule.name()).collect();
    assert_eq!(rules, ["unknown-unit", "no-fini"]);
}

#[test]
fn words_for_people_stay_words() {
    let cases = [
        ("PPRINT/clamp the part", Op::Comment("clamp the part".into())),
        ("PPRINT clamp, then go", Op::Comment("clamp, then go".into())),
        ("$$ a remark", Op::Comment("a remark".into())),
        ("PPRINT OPERATION NAME : Pocketing.1", Op::Operation("Pocketing.1".into())),
    ];
    for (text, op) in cases {
        assert_eq!(ops(&format!("{text}\nGOTO/0,0,0"))[0], op, "{text}");
    }
    let inserted =
        reading(&format!("{HEAD}INSERT/M00 G91\nINSERT/STOP turn the part\nGOTO/0,0,0\nFINI"));
    let ops: Vec<&Op> =
        inserted.program.records[HEAD_OPS..HEAD_OPS + 3].iter().map(|r| &r.op).collect();
    assert_eq!(
        ops,
        [&Op::Comment("M00 G91".into()), &Op::Message("turn the part".into()), &Op::Stop]
    );
    assert_eq!(
        inserted.warnings.iter().map(|w| w.rule.name()).collect::<Vec<_>>(),
        ["insert", "insert"]
    );
    assert_eq!(
        reading(&format!("PARTNO/Housing 7\n{HEAD}GOTO/0,0,0\nFINI")).program.name,
        "Housing 7"
    );
    assert_eq!(reading(&format!("{HEAD}GOTO/0,0,0\nFINI")).program.name, "test");
}

#[test]
fn words_that_are_not_known_are_one_warning_each() {
    let text = format!("{HEAD}FOO/1\nBAR\nFOO/2\nGOTO/1,2,3\nOPSKIP/ON\nFINI");
    let found = reading(&text).warnings;
    let seen: Vec<(&str, u32, u32)> =
        found.iter().map(|w| (w.rule.name(), w.line, w.count)).collect();
    assert_eq!(seen, [("unknown-word", 5, 2), ("unknown-word", 6, 1), ("ignored-word", 9, 1)]);
    let strict = read("s.apt", text.as_bytes(), &Options { strict: true, ..Options::default() })
        .unwrap_err();
    assert!(strict.iter().all(|e| e.is_error()));
    assert_eq!(
        strict.iter().map(|e| (e.rule.name(), e.line)).collect::<Vec<_>>()[..2],
        [("unknown-word", 5), ("unknown-word", 6)]
    );
    for text in ["FOO/it's 5 o'clock (yes", "(remark)", "%", "FOO 1 2 3", "FOO/1,"] {
        assert_eq!(warnings(&format!("{text}\nGOTO/1,2,3")), ["unknown-word"], "{text}");
    }
    for text in
        ["FOO/1,$\nGOTO/1,2,3", "INTOL/.1,$\nGOTO/1,2,3", "N10 GOTO/1,2,3", "FOO GOTO/1,2,3"]
    {
        assert_eq!(error(text), "malformed", "{text}");
    }
    let many = |n: u8| -> String { (0..n).map(|i| format!("W{i}\n")).collect() };
    assert_eq!(warnings(&format!("{}{}GOTO/1,2,3", many(20), many(20))).len(), 20);
    assert_eq!(error(&format!("{}GOTO/1,2,3", many(21))), "not-cldata");
    let silent = "PAINT/COLOR,1\nDISPLY/ON\nLINTOL/0.01\nCSI_ANY/X\nMACHIN/ANY, 3\nREWIND/0";
    assert_eq!(ops(&format!("{silent}\nGOTO/1,2,3")), [Op::Line(at(1., 2., 3.))]);
}
