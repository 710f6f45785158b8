//! Heights of drawings; what is drawn is tested by `crates/wire/tests/dxf.rs`.

use toolpost_sketch::dxf::{Options, read};

/// The heights of the pieces of a drawing with these blocks and entities, in inches; codes and values parted by blanks.
fn heights(blocks: &str, entities: &str) -> Vec<f64> {
    let text = format!(
        "0 SECTION 2 HEADER 9 $INSUNITS 70 1 0 ENDSEC 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC \
         0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
    );
    let text: String = text.split_whitespace().flat_map(|word| [word, "\n"]).collect();
    let drawing = read(text.as_bytes(), &Options::default()).unwrap();
    drawing.pieces.iter().map(|piece| piece.height / 25.4).collect()
}

#[test]
fn every_entity_keeps_its_height() {
    let entities = "0 LINE 10 0 20 0 30 1 11 5 21 0 31 1 \
         0 CIRCLE 10 0 20 0 30 2 40 1 \
         0 LWPOLYLINE 38 3 10 0 20 0 10 1 20 0 \
         0 POLYLINE 30 9 0 VERTEX 10 0 20 0 30 4 0 VERTEX 10 1 20 0 30 4 0 SEQEND \
         0 ELLIPSE 10 0 20 0 30 5 11 2 21 0 31 0 40 0.5 41 0 42 3";
    let heights = heights("", entities);
    assert_eq!(heights.len(), 5);
    for (height, wanted) in heights.iter().zip([1.0, 2.0, 3.0, 4.0, 5.0]) {
        assert!((height - wanted).abs() < 1e-12, "{heights:?}");
    }
}

/// The coordinates of a circle are its own; seen from behind its Z points down. Those of a line are the drawing's (DXF reference,
/// "Object Coordinate Systems").
#[test]
fn what_is_seen_from_behind_has_its_height_below() {
    let behind = "210 0 220 0 230 -1";
    let entities = format!(
        "0 CIRCLE 10 0 20 0 30 2 40 1 {behind} 0 LINE 10 0 20 0 30 2 11 5 21 0 31 2 {behind}"
    );
    assert_eq!(heights("", &entities), [-2.0, 2.0]);
}

/// 7 up, three times as high: 7 + 3 · 2 = 13.
#[test]
fn a_block_brings_its_height_and_scale() {
    let block = "0 BLOCK 2 dot 10 0 20 0 0 CIRCLE 10 0 20 0 30 2 40 1 0 ENDBLK";
    let insert = "0 INSERT 2 dot 10 5 20 0 30 7 41 3 42 3 43 3";
    assert!((heights(block, insert)[0] - 13.0).abs() < 1e-12);
}
