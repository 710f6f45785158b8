//! What a program leaves on where it ends. Each control keeps another part of it; what it keeps, or may keep by a parameter, is
//! reported, for the next program takes it as off.

use toolpost_control::{Action, Dialect, Kinematics, Settings};

/// What is reported of the end of a program: what stands behind "the program".
fn left_on(settings: &Settings, text: &str) -> Vec<&'static str> {
    let actions = crate::common::ops(settings, "p.nc", text)
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let left = |action: Action| match action {
        Action::Risk(risk) if risk.rule.name() == "left-on" && risk.refused => Some(risk.what),
        _ => None,
    };
    actions.into_iter().filter_map(left).collect()
}

/// A machine with B and C.
fn machine(dialect: Dialect) -> Settings {
    Settings {
        kinematics: (dialect == Dialect::LinuxCnc).then_some(Kinematics { tip: 428, axes: 429 }),
        path_tolerance: 0.05,
        ..Settings::new(dialect, [false, true, true])
    }
}

/// A program of Klartext with its numbers.
fn numbered(blocks: &str) -> String {
    let text = format!("BEGIN PGM P MM\n{blocks}\nEND PGM P MM");
    let lines = text.lines().filter(|line| !line.is_empty());
    lines.enumerate().map(|(i, line)| format!("{i} {line}\n")).collect()
}

/// `on` behind the last motion is reported, and `off` behind it takes it back.
#[track_caller]
fn is_kept(dialect: Dialect, on: &str, off: &str) {
    let program = |blocks: &str| match dialect {
        Dialect::Fanuc | Dialect::Haas => format!(
            "G21\nG17 G40 G49 G80 G90 G94 G98 G54\nT1 M6\nG91 G28 Z0.\nG90 G0 X0. Y0. B0. C0.\nG91 G28 Z0.\nG90 \
             G49\n{blocks}\nM30\n"
        ),
        Dialect::Mach3 => format!("G21 G17 G40 G49 G80 G90 G94 G54\nG0 X0 Y0 Z9\n{blocks}\nM30\n"),
        Dialect::Marlin => format!("G21\nG90\nG17\nG54\nG0 X0 Y0 Z9 F900\n{blocks}\n"),
        Dialect::LinuxCnc => {
            format!("G21 G17 G40 G49 G80 G90 G94 G54\nM429\nG0 X0 Y0 Z9\n{blocks}\nM2\n")
        }
        Dialect::Sinumerik => format!(
            "G17 G40 G54 G90 G94 G710\nT1\nM6\nS900\nG0 X0 Y0 Z9\nG0 SUPA Z0 D0\n{blocks}\nM30\n"
        ),
        Dialect::Klartext => numbered(&format!(
            "TOOL CALL 1 Z S900\nL X+0 Y+0 Z+9 R0 FMAX\nL Z+0 R0 FMAX M91\n{blocks}\nM30"
        )),
        _ => format!("G21 G40 G90 G54\nG0 X0. Y0.\n{blocks}\nM30\n"),
    };
    let settings = machine(dialect);
    assert_eq!(left_on(&settings, &program("")), [""; 0], "{dialect:?}");
    assert_eq!(left_on(&settings, &program(on)).len(), 1, "{dialect:?} {on}");
    let both = format!("{on}\n{off}");
    assert_eq!(left_on(&settings, &program(&both)), [""; 0], "{dialect:?} {both}");
}

/// Parameter manual: 3402#6 (CLR) says whether a reset clears the G codes, 3406 to 3408 which; 1202#3 (RLC) whether it ends G52; whether
/// M30 is a reset at all the builder says.
#[test]
fn a_fanuc_keeps_over_its_end_what_parameters_say() {
    for (on, off) in [
        ("G91", "G90"),
        ("G18", "G17"),
        ("G93", "G94"),
        ("G95", "G94"),
        ("G99", "G98"),
        ("G41 D1", "G40"),
        ("G52 Z-50.", "G52 Z0."),
        ("G51.1 X0.", "G50.1 X0."),
        ("G51 X0. Y0. Z0. P2.", "G50"),
        ("G68 X0. Y0. R45.", "G69"),
        ("G68.2 X0. Y0. Z0. I0. J30. K0.", "G69"),
        ("G16", "G15"),
        ("G43.4 H1", "G49"),
    ] {
        is_kept(Dialect::Fanuc, on, off);
    }
    let fanuc = machine(Dialect::Fanuc);
    let modal = |end: &str| left_on(&fanuc, &format!("G21\nG90\nG66 P100\n{end}\nO100\nM99\n"));
    assert_eq!((modal("M30").len(), modal("M99").len(), modal("G67\nM30").len()), (1, 1, 0));
    is_kept(Dialect::FanucWire, "G41 D1", "G40");
    is_kept(Dialect::FanucWire, "G91", "G90");
}

/// Setting 56: whether `M30` brings the G codes back.
#[test]
fn a_haas_keeps_over_its_end_what_setting_56_says() {
    for (on, off) in [
        ("G91", "G90"),
        ("G18", "G17"),
        ("G99", "G98"),
        ("G41 D1", "G40"),
        ("G68 X0. Y0. R45.", "G69"),
        ("G234 H1", "G49"),
    ] {
        is_kept(Dialect::Haas, on, off);
    }
}

/// Machine data 20110, 20150, 20152 (G groups, transformation), 24006 and 24010 (frames).
#[test]
fn a_sinumerik_keeps_over_its_end_what_machine_data_say() {
    for (on, off) in [
        ("G91", "G90"),
        ("G18", "G17"),
        ("G95", "G94"),
        ("G70", "G71"),
        ("G700", "G710"),
        ("DIAMON", "DIAMOF"),
        ("TRANS X50", "TRANS"),
        ("G58 X5", "TRANS"),
        ("ROT RPL=45", "ROT"),
        ("MIRROR X0", "MIRROR"),
        ("SCALE X2", "SCALE"),
        ("RNDM=2", "RNDM=0"),
        ("FGROUP(X,Y,Z,C)", "FGROUP()"),
        ("FGREF[C]=100", "FGREF[C]=57.29577951308232"),
        ("FRCM=100", "FRCM=0"),
        ("TRAORI", "TRAFOOF"),
        ("CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,1)", "CYCLE800()"),
        ("MCALL CYCLE81(5,0,2,-5)", "MCALL"),
    ] {
        is_kept(Dialect::Sinumerik, on, off);
    }
}

/// NC programming 12/2019, 4.3 and Fundamentals 10.2004, 12.3: of each modal G group the command that the maker delivers as active
/// (MD20150), which stands behind the others. `G60` and `G64` are both free: neither leaves the path.
#[test]
fn of_each_g_group_a_sinumerik_keeps_what_its_maker_has_not_delivered() {
    for (delivered, others) in [
        ("G60", &["G641", "G642", "G643", "G644", "G645"][..]),
        ("G64", &["G641"]),
        ("G601", &["G602", "G603"]),
        ("CFC", &["CFTCP", "CFIN"]),
        ("NORM", &["KONT", "KONTC", "KONTT"]),
        ("G450", &["G451"]),
        ("BRISK", &["SOFT", "DRIVE"]),
        ("CUT2D", &["CUT2DF"]),
        ("CDOF", &["CDON", "CDOF2"]),
        ("FFWOF", &["FFWON"]),
        ("WALIMON", &["WALIMOF"]),
        ("COMPOF", &["COMPON", "COMPCURV", "COMPCAD", "COMPSURF"]),
        ("OSOF", &["OSC", "OSS", "OSSE", "OSD", "OST"]),
        ("LFOF", &["LFON"]),
        ("SPATH", &["UPATH"]),
        ("LFTXT", &["LFWP", "LFPOS"]),
        ("G460", &["G461", "G462"]),
        ("ORIEULER", &["ORIRPY", "ORIRPY2"]),
        ("RTLION", &["RTLIOF"]),
        ("DYNNORM", &["DYNPOS", "DYNROUGH", "DYNSEMIFIN", "DYNFINISH", "DYNPREC"]),
        ("ORISOF", &["ORISON"]),
        // No G groups, and kept as well.
        ("CYCLE832(0,_OFF,1)", &["CYCLE832(0.01,_FINISH,1)"]),
        ("CTOL=-1", &["CTOL=0.01"]),
        ("OTOL=-1", &["OTOL=0.01"]),
        ("ADIS=0", &["ADIS=0.01"]),
        ("ADISPOS=0", &["ADISPOS=0.01"]),
        ("DISC=0", &["DISC=50"]),
    ] {
        for other in others {
            is_kept(Dialect::Sinumerik, other, delivered);
        }
    }
}

/// Fundamentals, "Feed optimization on curved path sections": with CFTCP and CFIN the edge of the tool goes at another feed than F.
#[test]
fn f_of_a_sinumerik_counts_on_the_contour() {
    let found = |blocks: &str| {
        let text = format!(
            "G17 G40 G54 G90 G94 G710\nT1\nM6\nS900 M3\nF200\nG0 X0 Y0 Z9\n{blocks}\nM30\n"
        );
        let actions = crate::common::ops(&machine(Dialect::Sinumerik), "p.nc", &text).unwrap();
        let feeds = |action: &Action| matches!(action, Action::Risk(risk) if risk.rule.name() == "feed" && risk.refused);
        actions.iter().filter(|action| feeds(action)).count()
    };
    let contour = "G1 G41 X10 Y0\nX20\nG40 X30";
    assert_eq!(found(contour), 0);
    for word in ["CFTCP", "CFIN"] {
        assert_eq!(found(&format!("{word}\n{contour}")), 1);
        assert_eq!(found(&format!("{word}\nCFC\n{contour}")), 0);
        assert_eq!(found(&format!("G1 G41 X10 Y0\n{word}\nX20\nG40 X30")), 1);
    }
}

/// 530, "Coordinate transformation cycles": cancelled by M2, M30, END PGM as a machine parameter says. 410/426/430 p. 169: M128 stays until
/// M129 or until another program is selected.
#[test]
fn a_heidenhain_keeps_over_its_end_what_parameters_say_and_m128_and_plane() {
    for (on, off) in [
        (
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+50",
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0",
        ),
        ("TRANS DATUM AXIS X+50", "TRANS DATUM RESET"),
        (
            "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+45",
            "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0",
        ),
        ("CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X", "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1"),
        (
            "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2",
            "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 1",
        ),
        ("PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY", "PLANE RESET STAY"),
        ("M128", "M129"),
        ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM"),
        ("M136", "M137"),
    ] {
        is_kept(Dialect::Klartext, on, off);
    }
}

/// B-64484EN-2, "Rigid tapping": between `M29` and its `G84` no axis moves (alarm PS0204), and so not in the next program.
#[test]
fn m29_without_its_tap_waits_for_the_next_program() {
    let program =
        |tap: &str| format!("G21\nG90 G94 G17 G54\nG0 X0. Y0. Z9.\nM29 S500\n{tap}\nM30\n");
    assert_eq!(left_on(&machine(Dialect::Fanuc), &program("")).len(), 1);
    let tapped = program("G98 G84 Z-9. R2. F500.\nG80");
    assert_eq!(left_on(&machine(Dialect::Fanuc), &tapped), [""; 0]);
}

/// LinuxCNC, "M2, M30 Program End", and `gcode.c` of GRBL 1.1, step 21: `G17 G90 G94 G40 G54 M5 M9`, and nothing else.
#[test]
fn linuxcnc_and_grbl_reset_at_the_end_what_their_manuals_list() {
    const START: &str = "G21 G17 G40 G49 G90 G94 G54\nG0 X0 Y0 Z9\n";
    for (dialect, blocks) in [
        (Dialect::Grbl, "G91"),
        (Dialect::Grbl, "G18"),
        (Dialect::Grbl, "G93"),
        (Dialect::Grbl, "G20"),
        (Dialect::Grbl, "G55"),
        (Dialect::LinuxCnc, "G91"),
        (Dialect::LinuxCnc, "G19"),
        (Dialect::LinuxCnc, "G95"),
        (Dialect::LinuxCnc, "G41.1 D3"),
        (Dialect::LinuxCnc, "G98 G81 Z-1 R2 F100"),
    ] {
        let settings = Settings::new(dialect, [false; 3]);
        let found = left_on(&settings, &format!("{START}{blocks}\nM2\n"));
        assert_eq!(found, [""; 0], "{dialect:?} {blocks}");
    }
    for (on, off) in [("G7", "G8"), ("G90.1", "G91.1"), ("G96 S100", "G97 S900"), ("M428", "M429")]
    {
        is_kept(Dialect::LinuxCnc, on, off);
    }
    // The work offset goes back, which is an event.
    let offset = |text: &str| {
        let ops =
            crate::common::ops(&Settings::new(Dialect::Grbl, [false; 3]), "p.nc", text).unwrap();
        ops.into_iter().rev().find_map(|op| match op {
            Action::WorkOffset(offset) => Some(offset.number()),
            _ => None,
        })
    };
    assert_eq!(offset(&format!("{START}G55\nM2\n")), Some(54));
    assert_eq!(offset("G21 G90 G55\nM2\n"), Some(54));
}

/// Marlin has no word for the end, and nothing is reset; the same on Mach3, where its configuration says what `M30` resets.
#[test]
fn marlin_and_mach3_keep_over_their_end_what_is_on() {
    for dialect in [Dialect::Marlin, Dialect::Mach3] {
        is_kept(dialect, "G91", "G90");
        is_kept(dialect, "G18", "G17");
    }
    for (on, off) in
        [("G68 A0 B0 R45", "G69"), ("G51 X2", "G50"), ("G90.1", "G91.1"), ("G93", "G94")]
    {
        is_kept(Dialect::Mach3, on, off);
    }
}

/// `M17`, `RET` and `M99` reset nothing: besides, the caller gets its feed group, no tool that waits for `M6`, and Z home.
#[test]
fn a_program_that_goes_back_to_its_caller_gives_back_what_it_took() {
    const START: &str = "G17 G54 G90 G94\nT1\nM6\nS900\nG0 X0 Y0 Z9\n";
    let settings = machine(Dialect::Sinumerik);
    let found = |blocks: &str, end: &str| left_on(&settings, &format!("{START}{blocks}\n{end}\n"));
    for end in ["M17", "RET"] {
        assert_eq!(found("G75 Z0", end), [""; 0]);
        for blocks in [
            "",
            "G75 Z0\nFGROUP(X,Y,Z,C)",
            "G75 Z0\nFGREF[C]=100",
            "G75 Z0\nRNDM=2",
            "G75 Z0\nFRCM=100",
            "G75 Z0\nT5",
            "G75 Z0\nROT RPL=45",
            "G75 Z0\nG91",
            "G75 Z0\nG18",
        ] {
            assert_eq!(found(blocks, end).len(), 1, "{blocks} {end}");
        }
        for blocks in
            ["G75 Z0\nFGROUP(X,Y,Z,C)\nFGROUP()", "G75 Z0\nT5\nM6", "G75 Z0\nRNDM=2\nRNDM=0"]
        {
            assert_eq!(found(blocks, end), [""; 0], "{blocks} {end}");
        }
    }
    // At M30 T is ready for the next start.
    assert_eq!(found("T5", "M30"), [""; 0]);
    let fanuc = machine(Dialect::Fanuc);
    let found = |blocks: &str| {
        left_on(&fanuc, &format!("G21\nG90 G94 G17 G54\nT1 M6\nG0 X0. Y0. Z9.\n{blocks}\nM99\n"))
    };
    assert_eq!(found("").len(), 1);
    assert_eq!(found("G91 G28 Z0.\nG90"), [""; 0]);
    assert_eq!(found("G91 G28 Z0.").len(), 1);
}

/// "Spindle": the S of the program before is in the control still.
#[test]
fn the_spindle_of_a_sinumerik_starts_with_a_speed_of_the_program() {
    let settings = machine(Dialect::Sinumerik);
    for (text, rule) in [
        ("M3\nM30\n", Some("spindle")),
        ("M4\nM30\n", Some("spindle")),
        ("S900\nM3\nM30\n", None),
        ("M3 S900\nM5\nM4\nM30\n", None),
    ] {
        let found =
            crate::common::ops(&settings, "p.mpf", text).err().map(|error| error.rule.name());
        assert_eq!(found, rule, "{text}");
    }
}

/// Parameter 5006#6 is 0: `G49` at the head of the next program moves Z down by the length, unless Z is home (B-64484EN-2, "Tool length
/// compensation"; B-63844EN p. 204: G28 has taken the length away). On Haas `G49` moves nothing.
#[test]
fn a_fanuc_ends_with_z_home_or_without_a_length() {
    let found = |dialect, length_moves_axis, end: &str| {
        let text = format!(
            "G21\nG17 G40 G49 G80 G90 G94 G98 G54\nT1 M6\nG91 G28 Z0.\nG90 G0 X0. Y0.\nG43 H1 Z40.\n{end}\nM30\n"
        );
        left_on(&Settings { length_moves_axis, ..machine(dialect) }, &text).len()
    };
    let fanuc = |end: &str| found(Dialect::Fanuc, None, end);
    assert_eq!(fanuc(""), 1);
    assert_eq!(fanuc("G91 G28 Z0.\nG90"), 0);
    assert_eq!(fanuc("G91 G28 Z0.\nG90 G0 X90. Y90."), 0);
    assert_eq!(fanuc("G91 G28 X0. Y0.\nG90"), 1);
    assert_eq!(fanuc("G49 Z90."), 0);
    assert_eq!(found(Dialect::Fanuc, Some(true), ""), 1);
    assert_eq!(found(Dialect::Fanuc, Some(false), ""), 0);
    assert_eq!(found(Dialect::Haas, None, ""), 0);
}
