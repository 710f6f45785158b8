//! What a probe finds on a surface that the operator has described: LinuxCNC's `#5061` to `#5063`.

use geom::Vec3;
use toolpost_control::{Action, Dialect, Settings, Setup, read};

/// The ends of the straight cuts, on a surface of these points.
fn cuts(text: &str, surface: &[Vec3]) -> Result<Vec<Vec3>, String> {
    let setup = Setup { surface: surface.to_vec(), ..Setup::default() };
    let settings = Settings { setup, ..Settings::new(Dialect::LinuxCnc, [false; 3]) };
    let mut cuts = Vec::new();
    let read = read(&settings, "program.ngc", text.as_bytes(), &mut |record| {
        if let Action::Line(pose) = record.action {
            cuts.push(pose.point);
        }
        Ok(())
    });
    read.map(|()| cuts).map_err(|found| found.to_string())
}

const SURFACE: [Vec3; 2] = [Vec3::new(1.0, 2.0, -0.25), Vec3::new(25.4, 0.0, 0.5)];

#[test]
fn what_the_probe_finds_can_be_calculated_with() {
    let text = "G21 G90 G0 X1 Y2 Z1\nG38.2 Z-1 F50\n#1001=#5063\nG0 Z1\nX25.4 Y0\nG38.2 Z-1\n#1002=#5063\n\
        G0 Z1\nG1 X10 Y#5062 Z[-0.1+0.5*#1001+0.25*#1002]\nM2\n";
    // -0.1 - 0.125 + 0.125.
    let [cut] = cuts(text, &SURFACE).unwrap()[..] else { panic!() };
    assert!(cut.distance(Vec3::new(10.0, 0.0, -0.1)) < 1e-12, "{cut}");
}

/// Words of two decimals are off by up to 0.005 mm, each way.
#[test]
fn a_probe_touches_the_nearest_point_across_its_way() {
    let surface = [0.125, 0.134]
        .map(|x| Vec3::new(x, 2.005, x))
        .into_iter()
        .chain(SURFACE)
        .collect::<Vec<_>>();
    for (x, height) in [(0.12, 0.125), (0.129, 0.125), (0.13, 0.134), (0.139, 0.134)] {
        let text = format!("G21 G90 G0 X{x} Y2 Z1\nG38.2 Z-1 F50\nG0 Z1\nG1 Z#5063\nM2\n");
        let [cut] = cuts(&text, &surface).unwrap()[..] else { panic!() };
        assert!((cut.z - height).abs() < 1e-12, "{x} {cut}");
    }
}

/// The manual: in the current work coordinate system. The source: in the unit of the program.
#[test]
fn it_is_in_the_unit_and_the_zero_of_the_program() {
    let text = "G20 G90 G92.1\nG0 X1 Y0 Z.1\nG38.2 Z-.1 F5\nG0 Z.1\nG1 X2 Z#5063\nG21 Z#5063\nM2\n";
    let z: Vec<f64> = cuts(text, &SURFACE).unwrap().iter().map(|cut| cut.z).collect();
    assert!((z[0] - 0.5).abs() < 1e-9 && (z[1] - 0.5 / 25.4).abs() < 1e-9, "{z:?}");
    let text =
        "G21 G90 G92.1\nG0 X1 Y2 Z1\nG92 X11 Z3\nG38.2 Z1 F5\nG0 Z3\nG1 X#5061 Z[#5063-1]\nM2\n";
    // The surface is at Z1.75 of the shifted coordinates; reported in those of the work.
    let [cut] = cuts(text, &SURFACE).unwrap()[..] else { panic!() };
    assert!(cut.distance(Vec3::new(1.0, 2.0, -1.25)) < 1e-9, "{cut}");
}

#[test]
fn what_only_the_machine_knows_stays_unknown() {
    let refused = |text: &str, surface: &[Vec3], message: &str| {
        let found = cuts(&format!("G21 G90 G0 X1 Y2 Z1\nF50\n{text}\nM2\n"), surface).unwrap_err();
        assert!(found.contains(message), "{found}");
    };
    let unknown = "the result of probing is known only at the machine";
    refused("G1 Z#5063", &SURFACE, unknown);
    refused("G38.2 Z-1\nG0 Z1\nG1 Z#5063", &[], unknown);
    // Away from the points that are known, aslant, and back from the part.
    refused("G0 X1.01\nG38.2 Z-1\nG0 Z1\nG1 Z#5063", &SURFACE, unknown);
    refused("G0 X2\nG38.2 X1 Z-1\nG0 Z1\nG1 Z#5063", &SURFACE, unknown);
    refused("G38.2 Z-1\nG38.4 Z1\nG0 Z1\nG1 Z#5063", &SURFACE, unknown);
    // Not deep enough: `G38.2` stops the program, `G38.3` goes on.
    refused("G38.2 Z-.2\nG0 Z1", &SURFACE, "not on the way of the probe");
    refused("G0 Z-.3\nG38.2 Z-1\nG0 Z1", &SURFACE, "not on the way of the probe");
    refused("G38.3 Z-.2\nG0 Z1\nG1 Z#5063", &SURFACE, unknown);
    // The tool has come to rest somewhat beyond.
    refused("G38.2 Z-1\nG91 G1 Z1", &SURFACE, "where Z stands is not known");
}

/// What a GRBL does of a touch-off: the actions behind the stop for the second tool.
fn touch_off(text: &str) -> Result<Vec<Action>, String> {
    let settings = Settings::new(Dialect::Grbl, [false; 3]);
    let mut actions = Vec::new();
    let read = read(&settings, "program.gcode", text.as_bytes(), &mut |record| {
        actions.push(record.action.clone());
        Ok(())
    });
    read.map(|()| actions).map_err(|found| found.to_string())
}

/// `gcode.c`, step 19: `G10 L20` is `WCS = MPos - G92 - TLO - WPos`, so the tool stands at the value that is written; step 20:
/// behind a probing cycle the position is where the machine has come to rest.
#[test]
fn a_tool_that_rests_on_a_plate_is_touched_off() {
    let head = "G21 G90 G94 G54\nT1\nM3 S1000\nG0 X0 Y0 Z20\nM5\nT2\nM0\n";
    let read = |tail: &str| touch_off(&format!("{head}{tail}M2\n"));
    let actions = read("G38.2 Z-10 F30\nG10 L20 P0 Z1.5\nG0 Z20\n").unwrap();
    assert!(actions.contains(&Action::TouchOff(1.5)), "{actions:?}");
    assert!(!actions.iter().any(|action| matches!(action, Action::Risk(_))), "{actions:?}");
    let rapid = |action: &Action| matches!(action, Action::Rapid(to) if to.point == Vec3::new(0.0, 0.0, 20.0));
    assert!(actions.last_chunk::<3>().unwrap().iter().any(rapid), "{actions:?}");
    // P1 is G54, and in inches.
    let inches = read("G38.2 Z-10 F30\nG20\nG10 L20 P1 Z.0625\nG0 Z1\n").unwrap();
    assert!(inches.contains(&Action::TouchOff(1.5875)), "{inches:?}");
    // Without a probing move, after it has gone on, along X, off the plate, where nothing has to be touched, in another offset.
    for tail in [
        "G10 L20 P0 Z1.5\nG0 Z20\n",
        "G38.2 Z-10 F30\nT3\nM0\nG10 L20 P0 Z1.5\nG0 Z20\n",
        "G38.2 Z-10 F30\nG0 Z20\nG10 L20 P0 Z1.5\n",
        "G38.2 X-10 F30\nG10 L20 P0 X1.5\nG0 Z20\n",
        "G38.4 Z-10 F30\nG10 L20 P0 Z1.5\nG0 Z20\n",
        "G38.3 Z-10 F30\nG10 L20 P0 Z1.5\nG0 Z20\n",
        "G38.2 Z-10 F30\nG10 L20 P0 X0 Z1.5\nG0 Z20\n",
        "G38.2 Z-10 F30\nG10 L20 P2 Z1.5\nG0 Z20\n",
    ] {
        let is_touch_off = |action: &Action| matches!(action, Action::TouchOff(_));
        let actions = read(tail).unwrap_or_default();
        assert!(!actions.iter().any(is_touch_off), "{tail}");
    }
}

/// LinuxCNC, "G10 L10": the entry of tool P becomes such that, once the length is taken again, the tool stands at the value that is
/// written; `rs274` gives the tool the length by which it stands higher than that (`tools_get_their_lengths_on_a_plate`).
#[test]
fn a_tool_that_rests_on_a_plate_gets_its_length() {
    let head = "G21 G90 G94 G54\nT1 M6\nM3 S1000\nG0 X0 Y0\nG43 Z20 H1\nG53 G0 Z0\nM5\nT2 M6\nG0 X-3 Y2\nM0\n";
    let read = |tail: &str| {
        let settings = Settings::new(Dialect::LinuxCnc, [false; 3]);
        let mut actions = Vec::new();
        let text = format!("{head}{tail}M2\n");
        let read = read(&settings, "program.ngc", text.as_bytes(), &mut |record| {
            actions.push(record.action.clone());
            Ok(())
        });
        read.map(|()| actions).map_err(|found| found.to_string())
    };
    let actions = read("G38.2 Z-10 F30\nG10 L10 P2 Z1.5\nG53 G0 Z0\nG43 Z20 H2\n").unwrap();
    assert!(actions.contains(&Action::TouchOff(1.5)), "{actions:?}");
    assert!(!actions.iter().any(|action| matches!(action, Action::Risk(_))), "{actions:?}");
    // Where it stands is known by its own length alone.
    assert!(actions.contains(&Action::LengthOffset(Some(2))), "{actions:?}");
    assert!(read("G38.2 Z-10 F30\nG10 L10 P2 Z1.5\nG91 G0 Z1\n").is_err());
    // Without a probing move, after it has gone on, along X, off the plate, where nothing has to be touched, of another tool, of the
    // work offset, added to, and with a radius.
    for tail in [
        "G10 L10 P2 Z1.5\n",
        "G38.2 Z-10 F30\nT3 M6\nG10 L10 P3 Z1.5\n",
        "G38.2 Z-10 F30\nG53 G0 Z0\nG10 L10 P2 Z1.5\n",
        "G38.2 X-10 F30\nG10 L10 P2 Z1.5\n",
        "G38.4 Z-10 F30\nG10 L10 P2 Z1.5\n",
        "G38.3 Z-10 F30\nG10 L10 P2 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L10 P1 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L10 P3 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L11 P2 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L1 P2 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L20 P0 Z1.5\n",
        "G38.2 Z-10 F30\nG10 L10 P2 Z1.5 R1\n",
        "G38.2 Z-10 F30\nG10 L10 P2 Z1.5 X1\n",
    ] {
        let Ok(actions) = read(tail) else { continue };
        assert!(!actions.iter().any(|action| matches!(action, Action::TouchOff(_))), "{tail}");
        assert!(actions.iter().any(|action| matches!(action, Action::Risk(_))), "{tail}");
    }
}
