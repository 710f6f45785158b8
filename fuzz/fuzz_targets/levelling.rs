//! Any bytes as a log of heights, and behind a line `%%` a toolpath that follows them: no panic, each move
//! ends where the toolpath has it, and is higher by no more than the surface is.
#![no_main]

use geom::Vec3;
use levelling::{Allowed, level, read};
use libfuzzer_sys::fuzz_target;
use program::Program;
use program::heights::HeightMap;

const ALLOWED: Allowed = Allowed { deviation: 0.02, outside: 5.0 };

/// How far from zero a toolpath may be, mm: a longer one is divided into millions of moves.
const BOARD: f64 = 500.0;

/// Where each line of the source ends.
fn ends(program: &Program) -> Vec<(u32, Vec3)> {
    let mut ends: Vec<(u32, Vec3)> = Vec::new();
    for record in &program.records {
        let Some(pose) = record.op.pose() else { continue };
        match ends.last_mut() {
            Some(last) if last.0 == record.line => last.1 = pose.point(),
            _ => ends.push((record.line, pose.point())),
        }
    }
    ends
}

fn follow(map: &HeightMap, text: &[u8]) {
    let Ok(reading) = source::apt::read("fuzz.cls", text, &Default::default()) else { return };
    let program = reading.program;
    let ends_of_source = ends(&program);
    if ends_of_source.iter().any(|(_, point)| point.abs().max_element() > BOARD) {
        return;
    }
    match level(&program, map, &ALLOWED) {
        Ok(levelled) => {
            let ends = ends(&levelled);
            assert_eq!(ends.len(), ends_of_source.len());
            let (low, high) = (map.lowest().min(0.0) - 1e-6, map.highest().max(0.0) + 1e-6);
            for ((line, point), (of_source, planned)) in ends.iter().zip(&ends_of_source) {
                assert!(line == of_source && point.is_finite());
                assert!(point.truncate().distance(planned.truncate()) < 1e-6, "line {line}");
                assert!((low..=high).contains(&(point.z - planned.z)), "line {line}: {point}");
            }
        }
        Err(found) => assert!(found.is_error() && !found.to_string().is_empty()),
    }
}

fuzz_target!(|data: &[u8]| {
    let mark = b"\n%%\n";
    let behind = data.windows(mark.len()).position(|part| part == mark);
    let (log, toolpath) = match behind {
        Some(at) => (&data[..at + 1], &data[at + mark.len()..]),
        None => (data, &[][..]),
    };
    match read("fuzz.txt", log) {
        Ok(map) => {
            assert!(map.lowest() <= map.highest() && map.highest() - map.lowest() <= 20.0);
            follow(&map, toolpath);
        }
        Err(findings) => {
            assert!(!findings.is_empty() && findings.len() <= 20);
            assert!(findings.iter().all(|found| found.is_error() && !found.to_string().is_empty()));
        }
    }
});
