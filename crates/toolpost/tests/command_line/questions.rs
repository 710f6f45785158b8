//! What a reader asks for, and that it asks only for what changes the result.

use crate::folder::{Folder, Said};

const SQUARE: &str = "G1 X40. F100.\nG1 Y20.\nG1 X0.\nG1 Y0.\n";

/// The points of a wire along `source`, and what is said.
fn points(folder: &Folder, control: &str, source: &str) -> Said {
    folder.write("part.src", source);
    let call = ["wire", "part.src", "--from", control, "-m", "bp-95d", "--step", "5"];
    folder.run(&[&call[..], &["-o", "part.pts"]].concat())
}

fn show(folder: &Folder, name: &str, source: &str, more: &[&str]) -> Said {
    folder.write(name, source);
    folder.run(&[&["show", name][..], more].concat())
}

#[test]
fn a_contour_is_flat_behind_a_work_offset_a_length_and_z_home() {
    let folder = Folder::empty();
    let straight = points(&folder, "fanuc-31i", &format!("G21\nG0 X0. Y0. Z0.\n{SQUARE}M30\n"));
    assert_eq!(straight.code, 0, "{straight:?}");
    let expected = folder.read("part.pts");
    let heads = [
        ("sinumerik-840d", "G71 G90\nG54\nG0 X0. Y0.\n"),
        ("sinumerik-840d", "G71 G90\nG54 G0 X0. Y0.\n"),
        ("sinumerik-840d", "G71 G90\nG0 SUPA Z0 D0\nG54\nG0 X0. Y0.\n"),
        ("sinumerik-840d", "G71 G90\nG54\nG0 SUPA Z0 D0\nG0 X0. Y0.\n"),
        ("sinumerik-840d", "G71 G90\nG54\nG75 Z1=0\nG0 X0. Y0.\n"),
        ("fanuc-31i", "G21\nG91 G28 Z0.\nG90 G54\nG0 X0. Y0.\n"),
        ("fanuc-31i", "G21\nT1 M6\nG54 G90\nG0 X0. Y0.\nG43 H1\n"),
        ("haas", "G21\nG53 G0 Z0.\nG54\nG0 X0. Y0.\n"),
        ("linuxcnc", "G21\nG53 G0 Z0.\nG54\nG0 X0. Y0.\n"),
    ];
    for (control, head) in heads {
        // The machine axis is named otherwise on a control whose channel has Z alone.
        let head = head.replace("Z1=0", "Z0");
        let said = points(&folder, control, &format!("{head}{SQUARE}M30\n"));
        assert_eq!(said.code, 0, "{control} {head}: {said:?}");
        assert!(said.err.contains("warning[flat-contour]"), "{control} {head}: {said:?}");
        assert_eq!(folder.read("part.pts"), expected, "{control} {head}");
    }
    let home = "0 BEGIN PGM A MM\n1 L Z+0 R0 FMAX M91\n2 L X+0 Y+0 R0 FMAX\n3 L X+40 F100\n4 L Y+20\n\
                5 L X+0\n6 L Y+0\n7 M30\n8 END PGM A MM\n";
    let said = points(&folder, "heidenhain-tnc640", home);
    assert_eq!((said.code, folder.read("part.pts")), (0, expected), "{said:?}");
}

#[test]
fn a_contour_at_two_heights_of_which_one_is_not_said_is_refused_with_its_line() {
    let folder = Folder::empty();
    let next = "G0 Z5.\nG0 X100. Y0.\nG1 X110.\nG1 Y10.\nG1 X100. Y0.\n";
    for (control, unit) in [("fanuc-31i", "G21"), ("sinumerik-840d", "G71")] {
        let said =
            points(&folder, control, &format!("{unit}\nG54\nG0 X0. Y0.\n{SQUARE}{next}M30\n"));
        assert_eq!(said.code, 2, "{control}: {said:?}");
        let words = ["part.src:10", "error[flat-contour]", "Z 5"];
        assert!(words.iter().all(|word| said.err.contains(word)), "{control}: {said:?}");
        // A retract is no cut.
        let said =
            points(&folder, control, &format!("{unit}\nG54\nG0 X0. Y0.\n{SQUARE}G0 Z5.\nM30\n"));
        assert_eq!(said.code, 0, "{control}: {said:?}");
    }
}

#[test]
fn a_wire_needs_neither_the_feed_nor_the_spindle_of_its_source() {
    let folder = Folder::empty();
    let square = SQUARE.replace(" F100.", "");
    let sources = [
        ("fanuc-31i", "G21\nG90 G0 X0. Y0. Z0.\n"),
        ("linuxcnc", "G21\nG90 G0 X0. Y0. Z0.\n"),
        ("sinumerik-840d", "G71\nG90 G0 X0. Y0. Z0.\n"),
    ];
    for (control, head) in sources {
        let said = points(&folder, control, &format!("{head}{square}M30\n"));
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{control}");
    }
    let source =
        "PARTNO/A\nUNITS/MM\nRAPID\nGOTO/0,0,0\nGOTO/40,0,0\nGOTO/40,20,0\nGOTO/0,0,0\nFINI\n";
    folder.write("part.cls", source);
    let said = folder.run(&["wire", "part.cls", "-m", "bp-95d", "--step", "5", "-o", "part.pts"]);
    assert_eq!(said.code, 0, "{said:?}");
    // A mill that is to cut it asks.
    let call = ["post", "part.cls", "-m", "generic-3axis-iso", "-o", "part.nc"];
    let said = folder.run(&call);
    assert!(said.code == 2 && said.err.contains("error[spindle-off]"), "{said:?}");
    // A source that may be cut off is no source of a wire.
    let cut_off = points(&folder, "fanuc-31i", &format!("G21\nG0 X0. Y0. Z0.\n{SQUARE}"));
    assert!(cut_off.code == 2 && cut_off.err.contains("error[program-end]"), "{cut_off:?}");
}

#[test]
fn a_picture_asks_neither_for_feed_spindle_start_nor_end() {
    let folder = Folder::empty();
    let sources = [
        ("a.mpf", "sinumerik-840d", "G1 X0 Y0 Z0\nX10\nY5", 2),
        ("a.nc", "fanuc-31i", "G21\nG1 X0. Y0. Z0.\nX10.\nY5.\n", 2),
        ("a.ngc", "linuxcnc", "G21\nG1 X0 Y0 Z0\nX10\nY5\n", 2),
        ("b.mpf", "sinumerik-840d", "G54\nG0 X0 Y0\nG1 X10\nY5\n", 2),
    ];
    for (name, control, source, lines) in sources {
        let said = show(&folder, name, source, &["--from", control, "-o", "a.svg"]);
        assert_eq!(said.code, 0, "{name}: {said:?}");
        assert!(said.out.contains(&format!("{lines} lines")), "{name}: {said:?}");
        // What is not known is said.
        let rule = if source.contains("G0 ") { "flat-contour" } else { "unknown-start" };
        assert!(said.err.contains(&format!("warning[{rule}]")), "{name}: {said:?}");
        assert!(said.err.contains("warning[program-end]"), "{name}: {said:?}");
        let call = ["post", name, "--from", control, "-m", "generic-3axis-iso", "-o", "new.nc"];
        let said = folder.run(&call);
        assert!(said.code == 2 && !folder.names().contains(&"new.nc".into()), "{name}: {said:?}");
    }
}

#[test]
fn a_missing_line_end_behind_m30_changes_no_source_and_is_refused_in_a_program() {
    let folder = Folder::empty();
    let source = "G71\nT1 M6\nS1000 M3\nG0 X0 Y0\nZ5\nG1 Z-1 F100\nX40\nG0 Z5\nM5\nM30";
    folder.write("old.mpf", source);
    let call = ["post", "old.mpf", "--from", "sinumerik-840d", "-m", "generic-3axis-sinumerik"];
    let said = folder.run(&[&call[..], &["-o", "new.mpf"]].concat());
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.err.contains("warning[line-end]"), "{said:?}");
    let program = folder.read("new.mpf");
    folder.write("new.mpf", program.trim_end());
    let call = ["prove", "new.mpf", "-m", "generic-3axis-sinumerik", "--against", "old.mpf"];
    let said = folder.run(&[&call[..], &["--from", "sinumerik-840d"]].concat());
    assert!(said.code == 1 && said.err.contains("error[line-end]"), "{said:?}");
}

#[test]
fn rotary_axes_that_stay_at_0_need_no_machine_and_others_do() {
    let folder = Folder::empty();
    let source = "G21 G90 G17\nT1 M6\nS1000 M3\nG0 X0 Y0 A0 B0\nG43 H1 Z5\nG1 Z-1 F100\nX40 A0\nG0 Z5\nM5\nM2\n";
    folder.write("old.ngc", source);
    let call = |from: &str| {
        folder.run(&["post", "old.ngc", "--from", from, "-m", "generic-3axis-iso", "-o", "new.nc"])
    };
    let said = call("linuxcnc");
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.err.contains("warning[rotary-at-zero]"), "{said:?}");
    assert!(folder.read("new.nc").contains("X40"));
    // A machine of which it is known that it has no such axis stops there.
    let said = call("generic-3axis-linuxcnc");
    assert!(said.code == 2 && said.err.contains("error[unknown-axis]"), "{said:?}");
    // Where the tip goes that a table turns, only the machine says: it is asked for once.
    for source in [source.replace("X40 A0", "X40 A30"), source.replace("X40 A0", "G91 X40 A0")] {
        folder.write("old.ngc", &source);
        let said = call("linuxcnc");
        assert!(said.code == 2 && said.err.contains("error[unknown-axis]"), "{said:?}");
        assert_eq!(
            said.err.matches("name the machine that the program was written for").count(),
            1,
            "{said:?}"
        );
    }
}
