//! What nobody has said is not zero: the length of a tool that a head tilts, where a rotary axis lies, where the work
//! lies on a turned table. A program that hangs on it is refused, by the writer and by the proof.

use crate::files::root;
use machine::{Machine, load_text};
use program::{Diagnostic, Op, Program};

/// A job that tilts the tool from -Y to +Y, its tool 120 mm long where `length` says so.
fn source(length: &str) -> Program {
    let text = format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1{length}\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/10,5,80,0,0,1\n\
         RAPID\nGOTO/10,5,80,0,0.5,0.8660254\nGOTO/20,5,70,0,0.5,0.8660254\nRAPID\nGOTO/20,5,80,0,0,1\nFINI\n"
    );
    source::apt::read("job.apt", text.as_bytes(), &Default::default())
        .unwrap_or_else(|found| panic!("{found:?}"))
        .program
}

/// A mill whose control turns A by its positions alone: the A of a head or a table, and further lines of its table and
/// of the machine.
fn mill(on: &str, axis: &str, top: &str) -> Machine {
    let text = format!(
        "extends = \"sinumerik-840d\"\nsafe_height = 400\n{top}\n[orientation]\nsimultaneous = \"machine-angles\"\n\
         [axes]\nZ = {{ min = -900, max = 900, rapid = 9000, acceleration = 3 }}\n\
         [[rotary]]\nletter = \"A\"\non = \"{on}\"\naxis = [1, 0, 0]\n{axis}\nmin = -100\nmax = 100\n\
         rapid = 9000\nacceleration = 300\n"
    );
    load_text("mill.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

fn written(machine: &Machine, source: &Program) -> Result<post::Output, Box<Diagnostic>> {
    post::write(source, machine).map_err(|found| Box::new(found.into_iter().next().unwrap()))
}

fn proven(machine: &Machine, source: &Program, text: &[u8]) -> Result<(), Box<Diagnostic>> {
    let report = proof::prove(source, machine, "p", text, &Default::default());
    report.mismatches.into_iter().next().map_or(Ok(()), |found| Err(Box::new(found)))
}

/// The tip of a tool that is 120 mm longer than somebody thinks stands 120 mm · sin 30° from the place.
#[test]
fn a_head_tilts_no_tool_of_unknown_length() {
    let (known, unknown) = (source(",LENGTH,120"), source(""));
    assert!(matches!(
        unknown.records.iter().find_map(|record| match &record.op {
            Op::Tool(tool) => Some(tool.length),
            _ => None,
        }),
        Some(None)
    ));
    let machine = mill("head", "point = [0, 0, 200]", "");
    let output = written(&machine, &known).unwrap();
    proven(&machine, &known, &output.text).unwrap();
    for found in [
        written(&machine, &unknown).unwrap_err(),
        proven(&machine, &unknown, &output.text).unwrap_err(),
    ] {
        assert_eq!(found.rule, "tool-length", "{found}");
        assert!(found.help.contains("LENGTH") && found.line > 0, "{found}");
    }
    // A table turns the part, whatever the tool is.
    let table = mill("table", "point = [0, 0, 0]", "work_zero = [0, 0, 0]");
    let output = written(&table, &unknown).unwrap();
    proven(&table, &unknown, &output.text).unwrap();
}

#[test]
fn an_axis_of_which_nobody_says_where_it_lies_turns_nothing() {
    let source = source(",LENGTH,120");
    for (on, whole, missing, key) in [
        ("head", ("point = [0, 0, 200]", ""), ("", ""), "`point = "),
        (
            "table",
            ("point = [0, 0, -50]", "work_zero = [0, 0, 0]"),
            ("", "work_zero = [0, 0, 0]"),
            "`point = ",
        ),
        (
            "table",
            ("point = [0, 0, -50]", "work_zero = [0, 0, 0]"),
            ("point = [0, 0, -50]", ""),
            "`work_zero = ",
        ),
    ] {
        let machine = mill(on, whole.0, whole.1);
        let output = written(&machine, &source).unwrap();
        proven(&machine, &source, &output.text).unwrap();
        let lacking = mill(on, missing.0, missing.1);
        for found in [
            written(&lacking, &source).unwrap_err(),
            proven(&lacking, &source, &output.text).unwrap_err(),
        ] {
            assert_eq!(found.rule, "kinematics", "{on}, {key}: {found}");
            assert!(found.help.contains(key) && found.line > 0, "{on}, {key}: {found}");
        }
    }
}

/// Where the control keeps the tip, it knows its axes itself; what Toolpost does not know of them, it does not check.
#[test]
fn travel_that_depends_on_it_is_reported_as_unchecked() {
    let unchecked = |machine: &Machine, source: &Program| {
        let text = written(machine, source).unwrap().text;
        let report = proof::prove(source, machine, "p", &text, &Default::default());
        assert!(report.proven, "{:?}", report.mismatches);
        report.travel.unsaid
    };
    let sample = root().join("machines/samples/five-axes.cls");
    let sample = std::fs::read(sample).unwrap();
    let sample = source::apt::read("five-axes.cls", &sample, &Default::default()).unwrap().program;
    let machine = machine::load("fanuc-table-bc").unwrap();
    assert_eq!(unchecked(&machine, &sample), [machine::Unsaid::AxisPoint('B')]);
    let table = mill("table", "point = [0, 0, 0]", "work_zero = [0, 0, 0]");
    assert_eq!(unchecked(&table, &source("")), [machine::Unsaid::ToolLength]);
    assert!(unchecked(&table, &source(",LENGTH,120")).is_empty());
}
