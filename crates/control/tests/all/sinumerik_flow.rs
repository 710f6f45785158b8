//! Variables, loops, jumps and calls of the SINUMERIK virtual control, against hand calculation.

use crate::common::sinumerik::{poses, settings};
use program::Diagnostic;
use toolpost_control::{Action, Event, Settings, Setup, read};

/// The X positions that a program moves to, with the line of each.
fn moves_with(settings: &Settings, text: &str) -> Result<Vec<(u32, f64)>, Box<Diagnostic>> {
    let x = |record: &Event| Some((record.line, record.action.position()?.point.x));
    Ok(crate::common::records(settings, "p.mpf", text)?.iter().filter_map(x).collect())
}

/// The same at the machine of [`settings`].
fn moves(text: &str) -> Result<Vec<(u32, f64)>, Box<Diagnostic>> {
    moves_with(&settings(), text)
}

/// The X positions of blocks that an end follows.
#[track_caller]
fn xs(text: &str) -> Vec<f64> {
    let moves = moves(&format!("{text}\nM30\n")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    moves.into_iter().map(|(_, x)| x).collect()
}

/// The error of blocks, which begin with line 1.
#[track_caller]
fn refused(text: &str) -> Diagnostic {
    match moves(&format!("{text}\nM30\n")) {
        Ok(moves) => panic!("no error in\n{text}\n{moves:?}"),
        Err(error) => *error,
    }
}

#[test]
fn variables_have_types_and_keep_values() {
    for (definitions, expression, x) in [
        ("DEF REAL AA=1.5", "AA*2", 3.0),
        ("DEF INT AA=7", "AA/2", 3.5),
        ("DEF INT AA=2.5", "AA", 3.0),
        ("DEF INT AA=7, BB=2", "AA DIV BB + AA MOD BB", 4.0),
        ("DEF BOOL AA=TRUE", "AA+AA", 2.0),
        ("DEF BOOL AA=5", "AA", 1.0),
        ("DEF CHAR AA=\"A\"", "AA", 65.0),
        ("DEF INT AA='HFF', BB='B101'", "AA+BB", 260.0),
        ("DEF REAL AA", "aa", 0.0),
        ("DEF STRING[10] AA=\"12.5\"", "NUMBER(AA)", 12.5),
        ("DEF STRING[10] AA=\"otto\"", "STRLEN(AA<<12)", 6.0),
        ("DEF INT FIELD[2,3]=SET(1,2,3,4,,6)", "FIELD[0,2]*100+FIELD[1,1]*10+FIELD[1,2]", 306.0),
        ("DEF INT FIELD[4]=REP(7)", "FIELD[0]+FIELD[3]", 14.0),
        ("DEF REAL FIELD[3]=(1,2)", "FIELD[1]+FIELD[2]", 2.0),
        ("DEF AXIS WHICH=Y", "(WHICH==Y)*5", 5.0),
        ("DEF INT AA=12", "MINVAL(AA,9)+MAXVAL(AA,9)+BOUND(0,10,AA)", 31.0),
        ("DEF INT AA=1 ; one", "AA", 1.0),
    ] {
        assert_eq!(xs(&format!("{definitions}\nG0 X={expression}")), [x], "{definitions}");
    }
}

/// PM19 p. 383: any name but the keywords of the language. (What is refused stands below: `DEF REAL NUMBER`.)
#[test]
fn a_variable_may_have_any_name_that_is_no_word_of_the_language() {
    for name in [
        "NUMBERS",
        "NUM",
        "COUNT",
        "DEPTH",
        "STEP",
        "RADIUS",
        "LENGTH",
        "WIDTH",
        "ANGLE",
        "SIZE",
        "LEVEL",
        "TOTAL",
        "NEXT",
        "LAST",
        "OFFSET",
        "START_X",
        "X_POS",
        "FEED",
        "SPEED",
        "TOOL",
        "PART",
        "INDEX_1",
        "MAXIMUM",
        "UMAX",
        "_LOCAL",
        "RR1",
        "XX",
        "TTOOL",
        "MYCYCLE",
        "WHILE_1",
        "LOOPS",
        "PROCESS",
        "CASES",
        "TOWER",
        "ELSEWHERE",
        "DIVISOR",
        "MODULE",
        "NOTE",
        "ORDER",
        "ANDY",
    ] {
        assert_eq!(xs(&format!("DEF REAL {name}=3\nG0 X={name}")), [3.0], "{name}");
    }
}

#[test]
fn operators_have_the_ranks_of_the_manual() {
    for (expression, x) in [
        ("(1==1) AND (2==3)", 0.0),
        ("(1==1) OR (2==3) AND (1==2)", 1.0),
        ("NOT 0 AND 0", 0.0),
        ("NOT(1==2)", 1.0),
        ("1 XOR 1 OR 1", 1.0),
        ("6 B_AND 3 B_OR 8", 10.0),
        ("6 B_XOR 3", 5.0),
        ("B_NOT 0", -1.0),
        ("2+3 > 4", 1.0),
        ("3*2 >= 6", 1.0),
        ("\"A\"<<1 == \"A1\"", 1.0),
        ("\"ABC\"<\"ABD\"", 1.0),
        // Relative equality: 0.1 + 0.2 is 0.3.
        ("0.1+0.2 == 0.3", 1.0),
        ("0.1+0.2 > 0.3", 0.0),
        ("1 <> 1.000001", 1.0),
        // Both readings agree.
        ("1==1 AND 0==1", 0.0),
    ] {
        assert_eq!(xs(&format!("G0 X={expression}")), [x], "{expression}");
    }
    // R1==(1 AND 2)==2 is FALSE; whoever writes it means TRUE.
    assert_eq!(refused("R1=1 R2=2\nIF R1==1 AND R2==2\nENDIF").rule.name(), "operator-rank");
    assert_eq!(refused("IF NOT 1==2\nENDIF").rule.name(), "operator-rank");
}

#[test]
fn conditions_choose_their_branch() {
    let program = |value| {
        format!(
            "R1={value}\nIF R1==1\nG0 X1\nELSE\nIF R1==2\nG0 X2\nELSE\nG0 X3\nENDIF\nENDIF\nG0 X9"
        )
    };
    assert_eq!(xs(&program(1)), [1.0, 9.0]);
    assert_eq!(xs(&program(2)), [2.0, 9.0]);
    assert_eq!(xs(&program(3)), [3.0, 9.0]);
    assert_eq!(xs("IF FALSE\nG0 X1\nENDIF ; none\nG0 X2"), [2.0]);
    // What is not run is not read.
    assert_eq!(xs("IF FALSE\nNONSENSE X=1/0\nENDIF\nG0 X2"), [2.0]);
}

#[test]
fn loops_turn_as_often_as_their_conditions_say() {
    for (text, expected) in [
        ("FOR R1=1 TO 3\nG0 X=R1\nENDFOR\nX=R1", vec![1.0, 2.0, 3.0, 4.0]),
        ("DEF INT II\nFOR II=3 TO 1\nG0 X=II\nENDFOR\nG0 X=II", vec![3.0]),
        ("R1=0\nWHILE R1<2\nG0 X=R1\nR1=R1+1\nENDWHILE", vec![0.0, 1.0]),
        ("R1=5\nREPEAT\nG0 X=R1\nR1=R1+1\nUNTIL R1>6", vec![5.0, 6.0]),
        ("R1=0\nREPEAT\nG0 X=R1\nUNTIL TRUE", vec![0.0]),
        ("R1=0\nLOOP\nG0 X=R1\nR1=R1+1\nIF R1==2 GOTOF OUT\nENDLOOP\nOUT: X9", vec![0.0, 1.0, 9.0]),
        ("FOR R1=0 TO 1\nFOR R2=0 TO 1\nG0 X=R1*10+R2\nENDFOR\nENDFOR", vec![0.0, 1.0, 10.0, 11.0]),
    ] {
        assert_eq!(xs(text), expected, "{text}");
    }
}

#[test]
fn jumps_find_labels_and_block_numbers() {
    for (text, expected) in [
        ("GOTOF LAB\nG0 X1\nLAB: G0 X2", vec![2.0]),
        ("R1=0\nLA1: G0 X=R1\nR1=R1+1\nIF R1<3 GOTOB LA1", vec![0.0, 1.0, 2.0]),
        ("GOTO N30\nN20 G0 X1\nN30 G0 X2", vec![2.0]),
        ("GOTOF :30\n:20 G0 X1\n:30 G0 X2", vec![2.0]),
        ("GOTOC NOWHERE\nG0 X1", vec![1.0]),
        ("R1=2\nGOTOF \"LAB_\"<<R1\nLAB_1: G0 X1\nLAB_2: G0 X2", vec![2.0]),
        ("DEF STRING[9] TO_WHERE=\"LAB_B\"\nGOTOF TO_WHERE\nG0 X1\nLAB_B: G0 X2", vec![2.0]),
        // The next one in the direction of the jump.
        ("GOTOF LAB\nLAB: G0 X1\nLAB: G0 X2", vec![1.0, 2.0]),
        ("R1=0\nIF R1==1 GOTOF AA1 IF R1==0 GOTOF BB1\nG0 X0\nAA1: G0 X1\nBB1: G0 X2", vec![2.0]),
        (
            "R1=7\nCASE(R1-5) OF 1 GOTOF ONE 2 GOTOF TWO DEFAULT GOTOF REST\nONE: G0 X1\nGOTOF OUT\n\
             TWO: G0 X2\nGOTOF OUT\nREST: G0 X3\nOUT: G0 X4",
            vec![2.0, 4.0],
        ),
        // Out of two loops at once.
        ("LOOP\nLOOP\nGOTOF OUT\nENDLOOP\nENDLOOP\nOUT: G0 X1", vec![1.0]),
    ] {
        assert_eq!(xs(text), expected, "{text}");
    }
}

#[test]
fn sections_are_repeated_as_often_as_p_says() {
    for (text, expected) in [
        ("LAB: G0 X1\nX2\nREPEAT LAB P=2\nX3", vec![1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 3.0]),
        ("LAB: G0 X1\nX2\nREPEATB LAB P2\nX3", vec![1.0, 2.0, 1.0, 1.0, 3.0]),
        ("AA1: G0 X1\nX2\nBB1: X3\nX4\nREPEAT AA1 BB1", vec![1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0]),
        ("AA1: G0 X1\nENDLABEL: X2\nX3\nREPEAT AA1", vec![1.0, 2.0, 3.0, 1.0, 2.0]),
        ("REPEAT AA1\nG0 X0\nAA1: G0 X1\nENDLABEL:\nX2", vec![1.0, 0.0, 1.0, 2.0]),
        ("R1=0\nLAB: R1=R1+1\nREPEAT LAB P=R1+2\nG0 X=R1", vec![4.0]),
    ] {
        assert_eq!(xs(text), expected, "{text}");
    }
}

#[test]
fn programs_of_the_same_file_are_called_with_parameters() {
    let text = "%_N_MAIN_MPF\nDEF REAL LENGTH=3, RESULT, LIST[2]=SET(4,5)\nG0 X0\n\
                TWICE(LENGTH,RESULT)\nX=RESULT\nSUM(LIST,RESULT)\nX=RESULT\nTWICE(,RESULT)\nX=RESULT\n\
                L12 P2\nCALL \"L12\"\nPCALL /_N_SPF_DIR/L12\nM30\n\
                %_N_TWICE_SPF\nPROC TWICE(REAL AA=10, VAR REAL BB) SAVE SBLOF DISPLOF\nBB=AA*2\nM17\n\
                %_N_SUM_SPF\nPROC SUM(VAR REAL AA[2], VAR REAL BB)\nBB=AA[0]+AA[1]\nRET\n\
                %_N_L12_SPF\nG91 G0 X1\nG90\nM17\n";
    let expected = [(3, 0.0), (5, 6.0), (7, 9.0), (9, 20.0)];
    let moves = moves(text).unwrap();
    assert_eq!(moves[..4], expected);
    // Records of a program of the same file carry their own lines.
    assert_eq!(moves[4..], [(23, 21.0), (23, 22.0), (23, 23.0), (23, 24.0)]);
}

#[test]
fn what_a_program_changes_stays_unless_it_says_save() {
    let program = |attributes| {
        format!(
            "%_N_A_MPF\nG0 X1\nSUB\nX1\nM30\n%_N_SUB_SPF\nPROC SUB {attributes}\nG91\nTRANS X10\nM17\n"
        )
    };
    let xs = |text: &str| moves(text).unwrap().into_iter().map(|m| m.1).collect::<Vec<_>>();
    // 1 further than 1, and the frame's 10.
    assert_eq!(xs(&program("")), [1.0, 12.0]);
    assert_eq!(xs(&program("SAVE")), [1.0, 1.0]);
}

#[test]
fn a_called_main_program_returns_at_its_end_and_variables_are_its_own() {
    let text =
        "%_N_A_MPF\nDEF REAL AA=1\nBB\nG0 X=AA\nM30\n%_N_BB_SPF\nDEF REAL AA=5\nG0 X=AA\nM30\n";
    assert_eq!(moves(text).unwrap(), [(8, 5.0), (4, 1.0)]);
    let unended = moves("%_N_A_MPF\nBB\nM30\n%_N_BB_SPF\nG0 X1\n").unwrap_err();
    assert_eq!((unended.rule.name(), unended.line), ("program-end", 5));
    let hidden = "%_N_A_MPF\nDEF REAL AA=1\nBB\nM30\n%_N_BB_SPF\nG0 X=AA\nM17\n";
    let error = moves(hidden).unwrap_err();
    assert_eq!((error.rule.name(), error.line), ("unknown-word", 6));
}

/// Job Planning, "Modal subprogram call (MCALL)": the program runs after each block with a motion, wherever
/// that stands; its parameters are passed once.
#[test]
fn a_modal_call_runs_after_every_motion() {
    let xs = |text: &str| -> Result<Vec<f64>, &'static str> {
        let moves = moves(&format!("%_N_A_MPF\n{text}")).map_err(|found| found.rule.name())?;
        Ok(moves.into_iter().map(|(_, x)| x).collect())
    };
    let l70 = "\nM30\n%_N_L70_SPF\nG91 G0 X1\nX-1\nG90\nM17\n";
    let manual = format!("G0 X0 Y0\nMCALL L70\nX10 Y10\nR1=1\nM8\nX50 Y50\nMCALL\nX60{l70}");
    assert_eq!(xs(&manual), Ok(vec![0.0, 10.0, 11.0, 10.0, 50.0, 51.0, 50.0, 60.0]));
    // The second example: the motion is in a program that is called.
    let called = format!("G0 X0 Y0\nMCALL L70\nL80\nMCALL{l70}%_N_L80_SPF\nX5\nX6\nM17\n");
    assert_eq!(xs(&called), Ok(vec![0.0, 5.0, 6.0, 5.0, 6.0, 7.0, 6.0]));
    // The value is that at MCALL.
    let hole = "\nM30\n%_N_HOLE_SPF\nPROC HOLE(REAL AA, REAL BB=3)\nG91 G0 X=AA\nX=BB\nG90\nM17\n";
    let passed = format!("R1=2\nG0 X0\nMCALL HOLE(R1)\nR1=7\nX10\nX20\nMCALL{hole}");
    assert_eq!(xs(&passed), Ok(vec![0.0, 10.0, 12.0, 15.0, 20.0, 22.0, 25.0]));
    // Another MCALL takes its place, a cycle too.
    let another = format!("G0 X0 Y0\nMCALL HOLE(1)\nMCALL L70\nX10{}{}", l70, &hole[5..]);
    assert_eq!(xs(&another), Ok(vec![0.0, 10.0, 11.0, 10.0]));
    let repeated = format!(
        "G0 X0\nMCALL L70\nFROM_HERE:\nX10\nTO_HERE:\nREPEAT FROM_HERE TO_HERE P=1\nMCALL{l70}"
    );
    assert_eq!(xs(&repeated), Ok(vec![0.0, 10.0, 11.0, 10.0, 10.0, 11.0, 10.0]));
    for (text, rule) in [
        (format!("G0 X0\nMCALL L71\nX1{l70}"), "called-program"),
        (format!("G0 X0\nMCALL HOLE(1,2,3)\nX1{hole}"), "call"),
        (format!("G0 X0\nMCALL L70\nG1 F100{l70}"), "cycle"),
        (format!("G0 X0\nMCALL L70\nX1 M30{l70}"), "call"),
        (format!("G0 X0\nMCALL L70 P3\nX1{l70}"), "call"),
        (format!("G0 X0\nMCALL L70\nHOLES1(0,0,0,0,5,3){l70}"), "cycle"),
        (format!("G0 X0\nMCALL L70\nX1{}", l70.replace("G90", "MCALL")), "call"),
        ("G0 X0\nMCALL BB\nX1\nM30\n%_N_BB_SPF\nPROC BB(VAR REAL AA)\nM17\n".into(), "call"),
        ("DEF REAL AA[2]\nMCALL BB(AA)\nM30\n".into(), "unsupported"),
    ] {
        assert_eq!(xs(&text), Err(rule), "{text}");
    }
}

#[test]
fn programs_of_the_folders_carry_the_line_of_their_call() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("OUTER.SPF"), "G0 X1\ninner(2)\nM17\n").unwrap();
    std::fs::write(folder.path().join("inner.spf"), "PROC INNER(INT NN)\nX=10*NN\nRET\n").unwrap();
    std::fs::write(folder.path().join("BAD.SPF"), "G0 X1\nX=1/0\nM17\n").unwrap();
    let mut settings = settings();
    settings.setup = Setup { folders: vec![folder.path().to_owned()].into(), ..Setup::default() };
    let run = |text: &str| moves_with(&settings, text);
    assert_eq!(run("X0 F100\nOUTER\nG0 X5\nM30\n").unwrap()[1..], [(2, 1.0), (2, 20.0), (3, 5.0)]);
    let error = run("G0 X0\nBAD\nM30\n").unwrap_err();
    assert_eq!((error.file.as_str(), error.line, error.rule.name()), ("BAD.SPF", 2, "arithmetic"));
    assert!(error.help.contains("line 2"), "{error}");
    let missing = run("G0 X0\nCALL \"../SECRET\"\nM30\n").unwrap_err();
    assert_eq!(
        (missing.file.as_str(), missing.line, missing.rule.name()),
        ("p.mpf", 2, "called-program")
    );
    let missing = run("G0 X0\nNOT_THERE(5)\nM30\n").unwrap_err();
    assert!(missing.message.contains("NOT_THERE.SPF is not there"), "{missing}");
}

#[test]
fn block_delete_skips_what_the_operator_says() {
    let mut settings = settings();
    let count = |settings: &Settings| {
        moves_with(settings, "G0 X1\n/X2\n /3 N5 X3\nM30\n").map(|moves| moves.len())
    };
    assert_eq!(count(&settings).unwrap(), 3);
    settings.setup.block_delete = true;
    assert_eq!(count(&settings).unwrap(), 1);
}

#[test]
fn texts_are_shown() {
    let text = "R1=5\nMSG(\"PART \"<<R1<<\" OF \"<<2.5)\nSETAL(66001,\"CHECK\")\nM30\n";
    let message = |op| if let Action::Message(text) = op { Some(text.to_string()) } else { None };
    let ops = crate::common::ops(&settings(), "p.mpf", text).unwrap();
    let messages: Vec<String> = ops.into_iter().filter_map(message).collect();
    assert_eq!(messages, ["PART 5 OF 2.5", "alarm 66001: CHECK"]);
}

#[test]
fn actual_positions_are_known_where_blocks_have_said_them() {
    assert_eq!(xs("G0 X5 Y7\nX=$AA_IW[Y]+$P_EP[X]"), [5.0, 12.0]);
    // In the coordinates of the program: 5 lies at -5 after the zero point has moved by 10.
    assert_eq!(xs("G0 X5 Y0\nTRANS X10\nR1=$AA_IW[X]\nTRANS\nX=R1"), [5.0, -5.0]);
    let machine = refused("G0 X1\nR1=$AA_IM[X]");
    assert_eq!(machine.rule.name(), "unknown-position");
}

#[test]
fn work_offsets_that_the_program_writes_are_known() {
    let start = geom::Vec3::new(100.0, 0.0, 0.0);
    let mut settings = settings();
    settings.setup.start = Some(start);
    let run = |text: &str| {
        let ops = crate::common::ops(&settings, "p.mpf", text)?;
        Ok::<_, Box<Diagnostic>>(poses(&ops).iter().map(|pose| pose.point.x).collect::<Vec<_>>())
    };
    // G54 lies at 30: what stands at 100 is at 70 in it.
    assert_eq!(run("$P_UIFR[1,X,TR]=30\nG54\nG0 X=$AA_IW[X]\nM30\n").unwrap(), [70.0]);
    // Once the program has moved in it, a change is a shift of its poses.
    let text = "G54 G0 X1\n$P_UIFR[1,X,TR]=30\nX2\nG54 X3\nR1=$P_UIFR[1,X,TR]\nX=R1\nM30\n";
    assert_eq!(run(text).unwrap(), [1.0, 2.0, 33.0, 60.0]);
    settings.setup.start = None;
    let unknown = |text: &str| read(&settings, "p.mpf", text.as_bytes(), &mut |_| Ok(()));
    let error = unknown("G54 G0 X1\n$P_UIFR[1,X,TR]=30\nG54 X3\nM30\n").unwrap_err();
    assert_eq!((error.rule.name(), error.line), ("work-offset", 3));
    assert!(unknown("$P_UIFR[1,X,TR]=30\nG54 G0 X3\nM30\n").is_ok());
    assert_eq!(unknown("R1=$P_UIFR[1,X,TR]\nM30\n").unwrap_err().rule.name(), "unknown-position");
}

#[test]
fn what_never_ends_is_refused() {
    // A long way round takes as long as many turns, and what is only said is nothing.
    let way = format!("R1={}1\n", " ".repeat(400)).repeat(1000);
    let long = format!("LOOP\n{way}ENDLOOP");
    let called = format!("%_N_A_MPF\nLOOP\nBB\nENDLOOP\nM30\n%_N_BB_SPF\n{way}M17");
    for text in ["LOOP\nENDLOOP", "GOTOS", "LOOP\n; ROUND\nMSG(\"A\")\nENDLOOP", &long, &called] {
        assert_eq!(refused(text).rule.name(), "endless", "{:.40}", text);
    }
    assert_eq!(refused("%_N_A_MPF\nG0 X1\nBB\nM30\n%_N_BB_SPF\nBB\nM17").rule.name(), "nesting");
}

#[test]
fn what_is_wrong_with_flow_is_said_where_it_stands() {
    let mut wrong = Vec::new();
    for (text, rule, line) in [
        ("IF TRUE\nG0 X1", "control-structure", 1),
        ("IF TRUE\nLOOP\nENDIF\nENDLOOP", "control-structure", 3),
        ("G0 X1\nENDFOR", "control-structure", 2),
        ("ELSE", "control-structure", 1),
        ("FOR R1=1 TO R2\nENDFOR", "r-parameter", 1),
        ("R2=3\nFOR R1=1 TO R2\nR2=9\nENDFOR", "control-structure", 2),
        ("FOR R1=1 3\nENDFOR", "syntax", 1),
        ("GOTOF LAB", "jump", 1),
        ("LAB:\nGOTOF LAB", "jump", 2),
        ("GOTOB LAB\nLAB:", "jump", 1),
        ("GOTOF LAB\nIF TRUE\nLAB: G0 X1\nENDIF", "jump", 1),
        ("IF TRUE\nGOTOF LAB\nELSE\nLAB:\nENDIF", "jump", 2),
        ("LAB:\nR1=1\nGOTOF OUT\nREPEAT LAB\nOUT: GOTOB AFTER\nAFTER:", "jump", 5),
        ("REPEAT LAB\nLAB: G0 X1", "jump", 1),
        ("LAB: G0 X1\nREPEATB LAB P=1.5", "number", 2),
        ("IF TRUE GOTO", "jump", 1),
        ("IF TRUE X5", "syntax", 1),
        ("G0 X1 IF TRUE", "unknown-word", 1),
        ("IF \"A\"\nENDIF", "type", 1),
        ("IF 1==\"A\"\nENDIF", "type", 1),
        ("G0 X=\"A\"", "type", 1),
        ("G0 X=Y", "type", 1),
        ("DEF REAL AA\nAA=\"A\"", "type", 2),
        ("DEF INT AA=3EX9", "type", 1),
        ("DEF INT AA=2147483648", "type", 1),
        ("DEF STRING[2] AA=\"ABC\"", "type", 1),
        ("DEF REAL AA[2]=SET(1,2,3)", "type", 1),
        ("DEF REAL AA[2]\nG0 X=AA[2]", "array-index", 2),
        ("DEF REAL AA[2]\nAA[-1]=5", "array-index", 2),
        ("DEF REAL AA[2]\nG0 X=AA", "syntax", 2),
        ("DEF REAL AA[16385]", "number", 1),
        ("DEF REAL AA[999,999]", "definition", 1),
        ("DEF REAL AA, AA", "definition", 1),
        ("DEF REAL CR", "definition", 1),
        ("DEF REAL R1", "definition", 1),
        ("DEF FRAME AA", "unsupported", 1),
        ("DEF NUMBER AA", "definition", 1),
        ("DEF REAL NUMBER", "definition", 1),
        ("DEF REAL INDEX", "definition", 1),
        ("DEF REAL TRANS", "definition", 1),
        ("DEF REAL CYCLE81", "definition", 1),
        ("G0 X1\nDEF REAL AA", "definition", 2),
        ("DEF REAL AA\nAA=1 AA=2", "repeated-word", 2),
        ("DEF REAL AA\nAA=1 X=AA", "variable", 2),
        ("DEF AXIS AA\nPOS[AA]=5", "variable", 2),
        ("UNDEFINED=5", "unknown-word", 1),
        ("G0 X=UNDEFINED", "unknown-word", 1),
        ("R1=$MC_AXES", "unsupported", 1),
        ("$TC_DP6[1,1]=5", "unsupported", 1),
        ("WHEN TRUE DO M8", "unsupported", 1),
        ("POCKET3(1,2)", "unsupported", 1),
        ("TRACYL(40)", "unsupported", 1),
        ("SETAL(61000)", "alarm", 1),
        ("CALL 5", "type", 1),
        ("X=SUBSTR(\"A\",5)", "arithmetic", 1),
        ("X='H'", "number", 1),
        ("%_N_A_MPF\nBB(1)\nM30\n%_N_BB_SPF\nM17", "call", 2),
        ("%_N_A_MPF\nBB(1)\nM30\n%_N_BB_SPF\nPROC BB(VAR REAL AA)\nM17", "call", 2),
        ("%_N_A_MPF\nDEF INT II\nBB(II)\nM30\n%_N_BB_SPF\nPROC BB(VAR REAL AA)\nM17", "call", 3),
        ("%_N_A_MPF\nBB\nM30\n%_N_BB_SPF\nPROC BB(REAL AA) WRONG\nM17", "unsupported", 5),
        ("%_N_A_MPF\nBB X5\nM30\n%_N_BB_SPF\nM17", "syntax", 2),
    ] {
        let found = refused(text);
        if (found.rule.name(), found.line) != (rule, line) {
            wrong.push(format!("{text:?} should be {rule} in line {line}: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_words_that_frame_a_program_end_it_or_mean_nothing() {
    let text = "%_N_A_MPF\nGROUP_BEGIN(0,\"A\",0,0)\nBB(3)\nG0 X1\nM30\nGROUP_END(0,0)\n; END\n\
                %_N_BB_SPF\nPROC BB(REAL AA)\nG0 X=AA\nENDPROC\n";
    assert_eq!(xs(text), [3.0, 1.0]);
    assert_eq!(refused("M30\nGROUP_BEGIN(0,\"A\",0,0)").rule.name(), "program-end");
}

#[test]
fn a_program_is_called_by_its_name_with_blanks_comments_and_repeats_behind_it() {
    let part = "%_N_TEIL_SPF\nG91\nG0 X1\nG90\nM17\n";
    for (call, times) in [
        ("TEIL", 1),
        ("TEIL ", 1),
        ("TEIL ; rough", 1),
        ("TEIL P3", 3),
        ("TEIL P3 ; rough", 3),
        ("TEIL P=R1", 2),
        ("TEIL  P = R1", 2),
        ("teil P2", 2),
        ("N10 TEIL P2", 2),
        ("TEIL() P2", 2),
    ] {
        let text = format!("%_N_MAIN_MPF\nR1=2\nG0 X0\n{call}\nM30\n{part}");
        let found = moves(&text).unwrap_or_else(|error| panic!("{error}\n{call}"));
        let expected: Vec<f64> = (0..=times).map(f64::from).collect();
        assert_eq!(found.into_iter().map(|(_, x)| x).collect::<Vec<_>>(), expected, "{call}");
    }
    let error = moves(&format!("%_N_MAIN_MPF\nTEIL P3 X1\nM30\n{part}")).unwrap_err();
    assert_eq!((error.rule.name(), error.line), ("syntax", 2), "{error}");
}
