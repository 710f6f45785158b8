//! The SINUMERIK virtual control, against motion that the manuals and hand calculation give.

use program::{Diagnostic, Op, Orientation, Pose, Record};
use toolpost_control::{Dialect, Settings};

fn settings() -> Settings {
    Settings {
        dialect: Dialect::Sinumerik,
        rotary: [true, false, true],
        auxiliary: vec![26, 27, 28, 29],
    }
}

fn run(text: &str) -> Result<Vec<Record>, Box<Diagnostic>> {
    let mut records = Vec::new();
    toolpost_control::read(&settings(), "p.mpf", text.as_bytes(), &mut |record| {
        records.push(record);
        Ok(())
    })?;
    Ok(records)
}

fn ops(text: &str) -> Vec<Op> {
    run(text).unwrap_or_else(|d| panic!("{d}")).into_iter().map(|record| record.op).collect()
}

#[test]
fn the_block_style_of_the_source_system_runs() {
    let text = "N1T1D1\nN2M6\nN3G0G54G64G90G94\nN4FGROUP(X,Y,Z,A,C)\nN5S3000M3\nN6M27M29\n\
                N7G0A30C=45+R24\nN8M26M28\nN9X10\nN10Y20M8\nN11Z30\nN12G1X12.5F200\nN13G41Y25\n\
                N14G40Y30\nN15Z100\nN16G54\nN17G75Z0M5M9\nN18M17\n";
    let ops = ops(text);
    let last_line = ops.iter().rev().find(|op| matches!(op, Op::Line(_))).unwrap();
    let Op::Line(Pose { point, orientation }) = last_line else { unreachable!() };
    assert_eq!(point.to_array(), [12.5, 30.0, 100.0]);
    let degrees = [30.0, 0.0, 45.0];
    assert_eq!(*orientation, Orientation::Rotary { degrees, tool_center: false });
    assert!(matches!(
        &ops[ops.len() - 4..],
        [Op::Spindle(_), Op::Coolant(_), Op::Home(4), Op::End]
    ));
}
