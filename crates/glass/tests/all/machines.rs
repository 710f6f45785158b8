//! Machine files.

use toolpost_glass::machine::{LIBRARY, Machine, library};

#[test]
fn every_machine_of_the_library_is_one_and_says_its_rate_in_its_name() {
    for (name, text) in LIBRARY {
        let machine = Machine::read(text, name).unwrap();
        assert!(name.ends_with(&format!("-{}hz", machine.laser.rate)), "{name}");
        assert!(machine.title.contains(&format!("{} Hz", machine.laser.rate)), "{name}");
        // What the comment says of the reach in a tick.
        let stated =
            text.split("a triangle reaches ").nth(1).and_then(|rest| rest.split(' ').next());
        let stated: f64 = stated.unwrap().parse().unwrap();
        let steps = (machine.coordinates()[0].steps() * 1e-3) as i64;
        assert_eq!((stated * 1e3).floor() as i64, machine.clock().reach(1)[0] / steps, "{name}");
    }
}

#[test]
fn a_machine_file_that_cannot_be_is_refused_with_its_line() {
    let good = library("glass-xyz-100hz").unwrap();
    let refused = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        let found = Machine::read(&good.replacen(from, to, 1), "mine.toml").unwrap_err();
        assert!(
            found.rule == "machine-file" && found.file == "mine.toml" && !found.help.is_empty(),
            "{found}"
        );
        (found.line, found.message)
    };
    let line = |text: &str| 1 + good[..good.find(text).unwrap()].lines().count() as u32;
    assert_eq!(refused("rate = 100", "rate = fast").0, line("rate = 100"));
    assert_eq!(refused("beam = 5", "bean = 5").0, line("beam = 5"));
    // E f < 1000 W, strictly: 10 J at 100 Hz are on the limit.
    assert!(refused("rate = 100", "rate = 100\npump = 10").1.contains("below 100 Hz"));
    assert!(Machine::read(&good.replacen("rate = 100", "rate = 100\npump = 9.99", 1), "").is_ok());
    assert!(refused("rate = 100", "rate = 100\nenergy = nan").1.contains("laser.energy"));
    assert!(refused("rate = 100", "rate = 0").1.contains("laser.rate"));
    assert!(refused("travel = [0, 170]", "travel = [170, 0]").1.contains("travel"));
    assert!(refused("spacing = 0.09", "spacing = nan").1.contains("spacing"));
    assert!(refused("focal = 43", "focal = 4").1.contains("shorter than its beam"));
    // A tolerance of 25 mm; a crack that reaches over the next point; figures of another unit.
    assert!(refused("crack = [0.095, 0.135]", "crack = [50, 50]").1.contains("lenses.crack"));
    assert!(refused("crack = [0.095, 0.135]", "crack = [0.2, 0.135]").1.contains("its spacing"));
    assert!(refused("acceleration = 7.5", "acceleration = 1e9").1.contains("axes.x.acceleration"));
    assert!(refused("speed = 0.1", "speed = 1e300").1.contains("axes.x.speed"));
    assert!(refused("travel = [0, 170]", "travel = [-1e9, 170]").1.contains("travel"));
    assert!(refused("rate = 100", "rate = 1e300").1.contains("laser.rate"));
    assert!(refused("focal = 43", "focal = 70").1.contains("two lenses have f = 70 mm"));
    assert!(refused("\"numbered\"", "\"gcode\"").1.contains("program.fire"));
    assert!(refused("\"triangle\"", "\"square\"").1.contains("square"));
    for word in ["M30", "M2", "G91", "G20", "X5", "N5", "M64 X5", "M", "", "M98 P1", "(M64)"] {
        let gcode = format!("\"gcode\"\nfire = \"{word}\"");
        assert!(refused("\"numbered\"", &gcode).1.contains("more than fire once"), "{word}");
    }
}
