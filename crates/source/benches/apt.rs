//! How fast cutter-location data is read, beside the time of only reading its numbers.
//!
//! `cargo bench -p toolpost-source --bench apt [records]`

use std::fmt::Write as _;
use std::time::Instant;

fn main() {
    let records = std::env::args().find_map(|a| a.parse().ok()).unwrap_or(2_000_000);
    let text = five_axis(records);
    let best = |what: &str, run: &dyn Fn() -> usize| {
        let seconds = (0..5).map(|_| {
            let start = Instant::now();
            assert_eq!(run(), records);
            start.elapsed().as_secs_f64()
        });
        let seconds = seconds.fold(f64::INFINITY, f64::min);
        println!(
            "{what:<24} {:>8.1} ms {:>7.2} M records/s {:>7.1} MB/s",
            seconds * 1e3,
            records as f64 / seconds / 1e6,
            text.len() as f64 / seconds / 1e6
        );
    };
    best("numbers only (std)", &|| {
        let values = text.lines().filter_map(|line| line.strip_prefix("GOTO/"));
        values.filter(|v| v.split(',').filter(|v| v.parse::<f64>().is_ok()).count() == 6).count()
    });
    best("source::apt::read", &|| {
        let reading = toolpost_source::apt::read("bench.cls", text.as_bytes(), &Default::default());
        let moves = reading.expect("the bench file is sound").program.records;
        moves.iter().filter(|record| record.op.pose().is_some()).count()
    });
}

/// `records` five-axis points of a wavy surface, as Siemens NX writes them.
fn five_axis(records: usize) -> String {
    let mut text = String::from(
        "UNITS/MM\nTOOL PATH/WAVE,TOOL,BALL10\nTLDATA/MILL,10.0,5.0,75.0,0.0,0.0\n\
         LOAD/TOOL,1\nSPINDL/RPM,12000,CLW\nFEDRAT/MMPM,3000\n",
    );
    for i in 0..records {
        let (u, v) = ((i % 1000) as f64 * 0.1, (i / 1000) as f64 * 0.05);
        let (slope_u, slope_v) = (0.3 * (u * 0.2).cos(), 0.2 * (v * 0.3).sin());
        let length = (slope_u * slope_u + slope_v * slope_v + 1.0).sqrt();
        let z = 1.5 * (u * 0.2).sin() - 0.66 * (v * 0.3).cos();
        let (a, b, c) = (-slope_u / length, -slope_v / length, 1.0 / length);
        let _ = writeln!(text, "GOTO/{u:.4},{v:.4},{z:.4},{a:.7},{b:.7},{c:.7}");
    }
    text.push_str("END-OF-PATH\n");
    text
}
