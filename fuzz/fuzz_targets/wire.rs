//! Any bytes as a drawing, and its contours as points and offset for the wire: no panic, bounds hold.
#![no_main]

use libfuzzer_sys::fuzz_target;
use wire::dxf::{Options, read};
use wire::offset::{Corners, offset};
use wire::points::{Step, points};
use wire::{Accuracy, Path};

fuzz_target!(|data: &[u8]| {
    let Ok(drawing) = read(data, &Options::default()) else { return };
    for contour in drawing.contours.iter().take(8) {
        let elements = contour.elements();
        assert!(elements.windows(2).all(|pair| pair[0].end == pair[1].start));
        let path = Path::upright(contour.clone());
        for (step, memory) in [(Step::ChordError(0.01), 10_000), (Step::Fit, 500)] {
            let Ok(found) = points(&[&path], step, Some(memory)) else { continue };
            assert!(found[0].lower.len() <= memory);
            assert!(found[0].lower.iter().all(|point| point.is_finite()));
            let Step::ChordError(bound) = found[0].step else { continue };
            let (accuracy, _) = Accuracy::of(&path, &found[0]);
            assert!(accuracy.all.largest <= bound * 1.001 + 1e-6);
        }
        if elements.len() > 200 {
            continue;
        }
        let Ok(parallel) = offset(contour, 0.15, Corners::Round) else { continue };
        for element in parallel.contour.elements() {
            let middle = element.at(0.5);
            let distance = contour.nearest(middle).point.distance(middle);
            assert!((distance - 0.15).abs() < 1e-3, "{distance}");
        }
    }
});
