//! M functions that switch coolant by other numbers than the usual ones: what a machine file says of them, and two that cancel each
//! other.

use program::{Coolant, CoolantFunctions};
use toolpost_control::{Action, Dialect, Settings};

/// Flood by M28, coolant through the tool by M26, and what ends it, as a builder may have it.
const BUILDERS: CoolantFunctions = CoolantFunctions {
    flood: Some(28),
    mist: None,
    through: Some(26),
    off: None,
    through_off: None,
};

/// The coolants of a program, or the rule by which it is refused.
fn coolants(
    dialect: Dialect,
    functions: CoolantFunctions,
    blocks: &str,
) -> Result<Vec<Coolant>, &'static str> {
    let settings = Settings { coolant: functions, ..Settings::new(dialect, [false; 3]) };
    let text = match dialect {
        Dialect::Klartext => {
            let mut text = "0 BEGIN PGM T MM\n".to_owned();
            for (i, block) in blocks.lines().enumerate() {
                text += &format!("{} {block}\n", i + 1);
            }
            text + &format!("{} END PGM T MM\n", blocks.lines().count() + 1)
        }
        Dialect::Sinumerik => format!("{blocks}\nM30\n"),
        _ => format!("{blocks}\n"),
    };
    let actions = crate::common::ops(&settings, "p", &text).map_err(|found| found.rule.name())?;
    let coolant = |action: &Action| match action {
        Action::Coolant(coolant) => Some(*coolant),
        _ => None,
    };
    Ok(actions.iter().filter_map(coolant).collect())
}

const DIALECTS: [Dialect; 6] = [
    Dialect::Fanuc,
    Dialect::Haas,
    Dialect::LinuxCnc,
    Dialect::Mach3,
    Dialect::Sinumerik,
    Dialect::Klartext,
];

#[test]
fn coolant_is_switched_by_the_numbers_of_the_machine_file() {
    for dialect in DIALECTS {
        let own = |blocks: &str| coolants(dialect, BUILDERS, blocks);
        assert_eq!(own("M28\nM9"), Ok(vec![Coolant::Flood, Coolant::Off]), "{dialect:?}");
        // M8 is not what switches flood on this machine.
        assert!(own("M8").is_err(), "{dialect:?}");
        let usual = coolants(dialect, CoolantFunctions::default(), "M8\nM9");
        assert_eq!(usual, Ok(vec![Coolant::Flood, Coolant::Off]), "{dialect:?}");
        assert!(coolants(dialect, CoolantFunctions::default(), "M28").is_err());
        let off = CoolantFunctions { off: Some(79), ..CoolantFunctions::default() };
        assert_eq!(coolants(dialect, off, "M8\nM79"), Ok(vec![Coolant::Flood, Coolant::Off]));
        assert!(coolants(dialect, off, "M8\nM9").is_err(), "{dialect:?}");
    }
    // A number that usually is another coolant is what the machine file says.
    let seven = CoolantFunctions { through: Some(7), ..CoolantFunctions::default() };
    for dialect in [Dialect::Fanuc, Dialect::LinuxCnc, Dialect::Sinumerik] {
        assert_eq!(coolants(dialect, seven, "M7\nM9"), Ok(vec![Coolant::Through, Coolant::Off]));
    }
}

#[test]
fn coolant_through_the_tool_ends_by_its_own_function_where_there_is_one() {
    let own = CoolantFunctions { through_off: Some(27), ..BUILDERS };
    for dialect in DIALECTS {
        assert_eq!(
            coolants(dialect, own, "M26\nM27"),
            Ok(vec![Coolant::Through, Coolant::Off]),
            "{dialect:?}"
        );
    }
    // M9 leaves it on then; without such a function it ends it, but on a Haas, which has one itself.
    for dialect in DIALECTS {
        assert_eq!(coolants(dialect, own, "M26\nM9"), Err("coolant"), "{dialect:?}");
        if dialect != Dialect::Haas {
            let ended = coolants(dialect, BUILDERS, "M26\nM9");
            assert_eq!(ended, Ok(vec![Coolant::Through, Coolant::Off]), "{dialect:?}");
        }
    }
}

/// A coolant that the builder has added ends at a tool change, a stop or the end where the builder has it so, which nobody else
/// knows; the control's own M8 does.
#[test]
fn what_the_builder_has_added_ends_by_its_own_function_alone() {
    for dialect in [Dialect::Fanuc, Dialect::Haas, Dialect::LinuxCnc, Dialect::Sinumerik] {
        for (on, off) in [("M26", "M27"), ("M28", "M9")] {
            let own = CoolantFunctions { through_off: Some(27), ..BUILDERS };
            let change = format!("T1\n{on}\nM6\n{off}");
            assert_eq!(coolants(dialect, own, &change), Err("coolant"), "{dialect:?} {on}");
            let ended = coolants(dialect, own, &format!("T1\n{on}\n{off}\nM6"));
            assert_eq!(ended.map(|all| all.len()), Ok(2), "{dialect:?} {on}");
        }
        let end = if dialect == Dialect::Sinumerik { "" } else { "\nM30" };
        let end = coolants(dialect, BUILDERS, &format!("M26{end}"));
        assert_eq!(end, Ok(vec![Coolant::Through]), "{dialect:?}");
    }
    assert_eq!(
        coolants(Dialect::Klartext, BUILDERS, "TOOL CALL 1 Z S1000\nM26\nTOOL CALL 2 Z S1000"),
        Err("coolant")
    );
    // Those of Haas itself, as its machine files name them, end with the tool change and the program.
    let haas = CoolantFunctions {
        through: Some(88),
        through_off: Some(89),
        ..CoolantFunctions::default()
    };
    let own = coolants(Dialect::Haas, haas, "T1\nM88\nM6\nM88\nM30");
    assert!(own.is_ok_and(|all| all.ends_with(&[Coolant::Off])));
    let usual = coolants(Dialect::LinuxCnc, CoolantFunctions::default(), "M8\nM30");
    assert_eq!(usual, Ok(vec![Coolant::Flood, Coolant::Off]));
}

/// An M function that the control has itself is none for coolant, whatever the machine file says: M30 would end the program, M4
/// turn the spindle the other way round, M50 and M51 of LinuxCNC switch its overrides, M98 call a program, M40 change the gear.
#[test]
fn a_function_of_the_control_itself_is_not_taken_for_coolant() {
    let cases: [(Dialect, &[u32]); 6] = [
        (Dialect::Fanuc, &[0, 1, 3, 4, 5, 6, 19, 29, 30, 98, 99]),
        (Dialect::Haas, &[4, 30, 98]),
        (Dialect::LinuxCnc, &[4, 6, 30, 50, 51, 64, 70]),
        (Dialect::Mach3, &[4, 30]),
        (Dialect::Sinumerik, &[0, 2, 3, 4, 5, 6, 17, 19, 30, 40, 41]),
        (Dialect::Klartext, &[0, 3, 4, 6, 13, 30, 89, 90, 91, 99, 103, 118, 128]),
    ];
    for (dialect, numbers) in cases {
        for &number in numbers {
            let own = CoolantFunctions { through: Some(number), ..CoolantFunctions::default() };
            let blocks = format!("M{number}\nM9");
            assert_eq!(coolants(dialect, own, &blocks), Err("coolant"), "{dialect:?} M{number}");
        }
    }
}

/// Which of two coolants runs, or whether both do, the builder says: the second may end the first.
#[test]
fn a_second_coolant_that_may_cancel_the_first_is_refused() {
    for dialect in DIALECTS {
        for blocks in ["M28\nM26", "M26\nM28"] {
            assert_eq!(coolants(dialect, BUILDERS, blocks), Err("coolant"), "{dialect:?} {blocks}");
        }
        let off = if dialect == Dialect::Haas { "M89" } else { "M9" };
        assert_eq!(
            coolants(dialect, BUILDERS, &format!("M28\nM9\nM26\n{off}")),
            Ok(vec![Coolant::Flood, Coolant::Off, Coolant::Through, Coolant::Off]),
            "{dialect:?}"
        );
    }
    for dialect in [Dialect::Fanuc, Dialect::Haas] {
        let through = if dialect == Dialect::Haas { "M88" } else { "M7" };
        let blocks = format!("M8\n{through}");
        assert_eq!(coolants(dialect, CoolantFunctions::default(), &blocks), Err("coolant"));
    }
}

/// TNC 155, table of the M functions: the outputs of M13 and M14 are those of M3 and M4, and "Coolant on", that of M8.
#[test]
fn m13_and_m14_of_a_heidenhain_switch_the_coolant_of_m8() {
    let own = |functions, blocks: &str| {
        let blocks = format!("TOOL CALL 1 Z S100\n{blocks}\nM30");
        coolants(Dialect::Klartext, functions, &blocks)
    };
    let usual = CoolantFunctions::default();
    for code in ["M13", "M14"] {
        assert_eq!(own(usual, code), Ok(vec![Coolant::Flood, Coolant::Off]));
        // Flood is M28 on this machine, and what M8 does there, its file does not say.
        assert_eq!(own(BUILDERS, code), Err("m-function"));
        let mist = CoolantFunctions { mist: Some(8), ..BUILDERS };
        // Whether M30 ends that, the builder knows.
        assert_eq!(own(mist, code), Ok(vec![Coolant::Mist]));
        assert_eq!(own(mist, &format!("M28\n{code}")), Err("coolant"));
        let eight = CoolantFunctions { flood: Some(8), ..usual };
        assert_eq!(own(eight, code), Ok(vec![Coolant::Flood, Coolant::Off]));
        let through = CoolantFunctions { through: Some(13), ..usual };
        let flood = Ok(vec![Coolant::Flood, Coolant::Off]);
        assert_eq!(own(through, code), if code == "M13" { Err("coolant") } else { flood });
    }
}
