//! LinuxCNC's own interpreter as the judge: programs run through `rs274` and through our control must
//! make the same moves, and what it refuses we refuse.

use crate::common::linuxcnc::{difference, ours, theirs};

/// No rotary axes: LinuxCNC has them at 0 at the start, and ours does not know.
const MILL: [bool; 3] = [false; 3];

fn makes_the_same_moves(program: &str) {
    let program = &format!("G21\n{program}");
    if let Err(error) = ours(program.as_bytes(), MILL, &[]) {
        panic!("we refuse\n{program}\n{error}");
    }
    if let Some(Some(difference)) = difference(program.as_bytes(), MILL, &[]) {
        panic!("{difference}\n{program}");
    }
}

fn is_refused_by_both(program: &str) {
    let program = &format!("G21\n{program}");
    assert!(ours(program.as_bytes(), MILL, &[]).is_err(), "we take\n{program}");
    if let Some(theirs) = theirs(program.as_bytes(), &[]) {
        assert!(theirs.is_err(), "LinuxCNC takes\n{program}");
    }
}

#[test]
fn a_line_has_252_bytes_at_most_with_blanks_comments_and_carriage_return() {
    let lines: [fn(usize) -> String; 6] = [
        |length| format!("({})", "x".repeat(length - 2)),
        |length| format!(";{}", "x".repeat(length - 1)),
        |length| format!("G0 X{}1", "0".repeat(length - 5)),
        |length| format!("G0 X1{}", " ".repeat(length - 5)),
        |length| format!("G0 X1{}\r", " ".repeat(length - 6)),
        |length| format!("G0 X1 ({})", "x".repeat(length - 8)),
    ];
    for line in lines {
        makes_the_same_moves(&format!("G0 X2\n{}\nG0 X3\nM2\n", line(252)));
        is_refused_by_both(&format!("G0 X2\n{}\nG0 X3\nM2\n", line(253)));
    }
    // What stands behind the end is not read.
    makes_the_same_moves(&format!("G0 X2\nM2\n({})\n", "x".repeat(300)));
}

#[test]
fn lines_in_both_units_and_both_distance_modes() {
    makes_the_same_moves(
        "G21 G90\nG0 X0 Y0 Z10\nG1 X10.5 F100\nY-3.25 Z1\nG91 X1 Y1\nX-2\nG0 Z5\nG90 G1 X0\n\
         G20 X1 Y2\nG91 Z-.5\nG21 Z-.5\nM2\n",
    );
}

#[test]
fn arcs_in_every_plane_turn_the_same_way() {
    makes_the_same_moves(
        "G21 G90 G17\nG0 X0 Y0 Z0\nF100\nG2 X10 Y0 I5 J0\nG3 X0 Y0 I-5 J0\nG2 I5 J5\n\
         G18 G2 X10 Z0 I5 K0\nG3 X0 Z0 I-5 K0\nG2 X5 Z-5 I5 K0\nG3 X0 Z0 R5\nG2 X5 Z5 R-5\n\
         G19 G2 Y10 Z5 J5 K0\nG3 Y0 Z5 J-5\nG2 Y5 Z0 R5\nG3 Y0 Z5 R-5\nM2\n",
    );
}

#[test]
fn arcs_by_radius_take_the_short_or_the_long_way() {
    makes_the_same_moves(
        "G90 G0 X0 Y0 Z0 F50\nG2 X10 Y0 R6\nG3 X0 R6\nG2 X10 R-6\nG3 X0 R-6\nG2 X10 Y0 R5\nG2 X0 R4.999\n\
         M2\n",
    );
}

#[test]
fn arcs_with_absolute_centres_helices_and_turns() {
    makes_the_same_moves(
        "G90 G0 X1 Y2 Z0 F50\nG90.1 G3 X11 Y2 I6 J2\nG91.1 G3 X1 I-5 Z-2\nG2 I5 P3 Z-4\nG3 X11 I5 P2\n\
         G18 G2 Z-14 X11 K-5 Y8 P2\nG17 G91 G2 X-10 I-5 Z1\nM2\n",
    );
}

#[test]
fn drilling_cycles_return_to_either_level() {
    makes_the_same_moves(
        "G21 G90 G0 X0 Y0 Z10\nF100\nG98 G81 X1 Y2 Z-5 R2\nX3\nG99 Y7\nX4\nG98 X5\nG80\n\
         G0 X0 Z20\nG99 G82 X5 Z-3 R1 P0.5\nX6 Z-4\nX7 R2\nG98 G81 X8 Z-1 R3\nG80\nG0 X0\nM2\n",
    );
}

#[test]
fn pecking_cycles_go_in_steps_of_q_from_the_r_plane() {
    makes_the_same_moves(
        "G21 G90 G0 X0 Y0 Z10\nF100\nG98 G83 X1 Y2 Z-5 R2 Q2\nX3\nG99 X4 Q3.5\nG80\nG73 X0 Y0 Z-7 R1 Q2\n\
         G98 Y4\nM2\n",
    );
}

#[test]
fn boring_reaming_and_tapping_cycles() {
    makes_the_same_moves(
        "G21 G90 G98 G0 X0 Y0 Z10\nF100 S500 M3\nG85 X1 Z-5 R2\nX2\nG89 X3 Z-5 R2 P0.25\nG86 X4 Z-5 R2 P0.5\n\
         G84 X5 Z-5 R2\nX6\nG80 M4\nG74 X7 Z-5 R2\nM2\n",
    );
}

#[test]
fn incremental_cycles_count_from_where_the_tool_is() {
    makes_the_same_moves(
        "G21 G90 G0 X0 Y0 Z10\nF100\nG91 G98 G81 X1 Y1 Z-3 R-1 L3\nX5\nG80\n\
         G99 G81 X1 Z-3 R-1 L2\nX5\nX5 Y1\nG80\nM2\n",
    );
}

#[test]
fn in_a_series_r_counts_from_where_the_series_began() {
    makes_the_same_moves(
        "G90 G98 G0 X2 Y0 Z0\nG81 R1 Z-5 F60\nX3\nG90 X4 R10\nX5\nG91 G81 X1 R1 Z-5 L2\nG99 X1\n\
         X1 R2 Z-3\nG90 @10 ^33\nG91 @1 R1 Z-5 L3\n^10 L2\nG80\nM2\n",
    );
}

#[test]
fn in_g91_r_counts_from_where_the_first_of_a_row_of_cycles_began() {
    for start in [
        "G98 G0 X0 Y0 Z0\nF60\nG81 X1 R1 Z-5\nX2\nG91 X3 R1 Z-5 L2",
        "G99 G0 X0 Y0 Z10\nF60\nG81 X1 R1 Z-5\nG91 G81 X3 R1 Z-5",
        "G98 G0 X0 Y0 Z10\nF60\nG81 X1 R1 Z-5\nG91 G81 X3 R-1 Z-5\nG82 X1 R-2 Z-3 P1",
    ] {
        makes_the_same_moves(&format!("G90 {start}\nM2\n"));
    }
}

#[test]
fn cycles_that_start_below_the_r_plane_go_up_first() {
    makes_the_same_moves("G90 G0 X0 Y0 Z0\nF100\nG98 G81 X1 Z-1 R2\nX2\nG99 X3 R4 Z-2\nM2\n");
}

#[test]
fn cycles_in_the_other_planes_drill_along_their_axis() {
    makes_the_same_moves(
        "G90 G18 G0 X0 Y20 Z0\nF100\nG98 G81 X1 Z4 Y-3 R2\nX5\nG80\nG19 G0 X30\nG99 G83 Y1 Z2 X-3 R2 Q2\n\
         G80\nM2\n",
    );
}

#[test]
fn homing_goes_through_the_point_of_the_block() {
    makes_the_same_moves(
        "G90 G0 X5 Y6 Z7\nG28 Z20\nG0 X5 Y6 Z7\nG91 G28 Z0\nG28 X1 Y0\nG90 G0 X1 Y1 Z1\nG30\n\
         G0 X1 Y1 Z1\nG53 G0 Z0\nM2\n",
    );
}

#[test]
fn tools_offsets_dwells_and_comments_leave_the_path_alone() {
    makes_the_same_moves(
        "(a comment) G21 ; and another\nN10 G17 G40 G49 G54 G64 P0.01 Q0.02 G80 G90 G94 G97\nT1 M6\n\
         S1000 M3\nG43 H1\nG0 X1 Y2 Z30 M8\nG4 P1.5\n/G1 X2 F100\ng1x3y4\nG 1 X5\nM5 M9\nG49\nM2\n",
    );
}

#[test]
fn work_offsets_are_written_by_value_and_by_place() {
    makes_the_same_moves(
        "G10 L2 P1 X5 Y-2\nG0 X3 Y4 Z3\nG10 L2 P1 X7 Z1\nG0 X1\nG91 G10 L2 P1 Y10\nX1\nG90\n\
         G10 L20 P1 X0 Z2\nG0 X2 Y1\nG10 L20 P0 Y0\nX9 Y9 Z9\nG10 L2 P0 X0 Y0 Z0\nX1 Y1 Z1\nM2\n",
    );
    makes_the_same_moves(
        "G54 G0 X1 Y2 Z3\nG10 L2 P2 X10\nG10 L2 P9 Z-5\nG55\nG0 X1\nG59.3\nY2\nG54\nG0 Z1\nM2\n",
    );
}

#[test]
fn a_work_offset_is_turned_about_its_zero() {
    makes_the_same_moves(
        "G10 L2 P1 X10 R90\nG0 X1 Y2 Z3\nX4\nG10 L2 P1 R30\nX5\nG91 Y1\nG90 G1 X1 Y1 F100\n\
         G2 X3 I1\nG18 G3 X5 Z3 I1 K0\nG17 G10 L2 P1 X3 Y4 R-45\nG0 X0 Y0\nG10 L20 P1 X7 Y8\n\
         G0 X1\nG10 L2 P2 X1 Y1 R10\nG55 G0 X0 Y0\nG54 X1 Y1\nG98 G81 X3 Y3 Z-1 R1\nX4\nG80\nM2\n",
    );
}

#[test]
fn shifts_are_set_suspended_brought_back_and_cleared() {
    makes_the_same_moves(
        "G0 X1 Y2 Z3\nG92 X5 Y0\nG0 X6\nG92.2\nX6\nG92.3\nX6\nG92.1\nX6 Y1\nG52 X1\nX0\nG91 X1\n\
         G90 G92 Z0\nG10 L20 P1 X0 Y0\nX1 Y1 Z1\nG52 X0 Y0 Z0\nX1 Y1 Z1\nG92.3\nX1 Y2 Z3\nM2\n",
    );
    makes_the_same_moves(
        "G20 G10 L2 P1 X1\nG0 X2\nG92 X0\nG21 G0 X10\nG55 X3\nG54 G52 X3\nG0 X10 Y5\nM2\n",
    );
    makes_the_same_moves("G10 L2 P1 R90\nG92 X5\nG0 X1 Y1\nG92 X0 Y3\nX1 Y1\nG92.1 G0 X0\nM2\n");
}

#[test]
fn polar_words_count_from_the_zero() {
    makes_the_same_moves(
        "G0 X3 Y4 Z3\n@10\n^90\n@5 ^45\nG91 @1 ^45\nG90 G1 @7 ^-30 Z1 F100\nG98 G81 @5 ^0 Z-1 R1\n^90\n\
         G80\nM2\n",
    );
}

#[test]
fn on_a_lathe_x_may_be_a_diameter() {
    makes_the_same_moves(
        "G7\nG0 X3 Y4 Z3\nG18 G2 X6 Z4.5 I1.5 K0 F9\nG92 X5\nG0 X4\nG8 G0 X5\nX6\nM2\n",
    );
}

#[test]
fn threads_and_probes() {
    makes_the_same_moves(
        "G0 X1 Y2 Z3\nS100 M3\nG33 Z-5 K1.25\nG0 Z5\nG33.1 Z-10 K1.5\nG0 Z5\nM4\nG33.1 Z-1 K1\n\
         G20 G33 Z1 K0.05\nG21\nF100\nG38.2 Z0\nG0 X1 Y1 Z5\nG38.5 X9 Y5\nG0 X0 Y0\nM2\n",
    );
}

#[test]
fn constant_surface_speed_moves_nothing_elsewhere() {
    makes_the_same_moves(
        "G0 X1 Y2 Z3\nG96 D2500 S100\nM3\nG1 X5 F100\nS70\nG95 F0.1\nX1\nG97 S500\nG94 F9\nX3\nG96 S0\nM2\n",
    );
}

#[test]
fn lengths_come_from_the_tool_table() {
    makes_the_same_moves(
        "T1 M6\nG0 X0 Y0 Z0\nG43\nG91 G0 Z1\nG43 H2\nZ1\nG90 G10 L1 P1 Z40\nG49\nG91 Z1\nG43 H1\nZ1\n\
         G43.1 Z7\nZ1\nG53 G90 G0 Z0\nG91 Z1\nM2\n",
    );
}

#[test]
fn machine_coordinates_are_those_without_offsets() {
    makes_the_same_moves(
        "G10 L2 P1 X5 Y6 Z7\nG0 X1 Y1 Z1\nG53 G0 X0\nG91 X1\nG90 G92 X3\nG53 G0 X2 Z1\nG91 Z1\n\
         G90 F9 G53 G1 X9\nX2\nM2\n",
    );
}

#[test]
fn home_is_where_the_program_stores_it() {
    makes_the_same_moves(
        "G92 X5\nG28.1\nG0 X7 Y2 Z1\nG30.1\nG28 X0\nG91 X1\nG90 G30\nG91 Z1\nG90 G10 L2 P1 X3 R30\nG0 X1 Y1\n\
         G28 Z4\nG0 X2 Y2\nG30 X1 Y0\nM2\n",
    );
}

#[test]
fn modes_and_functions_that_move_nothing() {
    makes_the_same_moves(
        "G61\nG61.1\nG64\nG64 P0.1 Q0.2\nM48\nM50 P0\nM51 P1\nM52\nM53 P0\nM62 P1\nM63 P1\nM64 P2\nM65 P2\n\
         M67 E1 Q2.5\nM68 E0 Q1\nS100 M4 $0\nM19 R90 Q2\nM60\nM61 Q2\nG43\nG0 X1 Y1 Z1\nM2\n",
    );
}

#[test]
fn boring_by_hand_stops_at_the_bottom() {
    // LinuxCNC leaves the tool there; the operator and the next block bring it up.
    makes_the_same_moves("G90 G98 G0 X0 Y0 Z9\nF10 S9 M3\nG88 X1 Z-1 R1 P0.5\nG80\nG0 Z9\nM2\n");
}

#[test]
fn what_the_judge_refuses_we_refuse() {
    for block in [
        "G5",
        "G21 G90 G5.1",
        "G1 X1",
        "X1",
        "G0 X1 X2",
        "G0 G1 X1",
        "G54 G55",
        "M3 M5 S1",
        "M8 M9",
        "M0 M30",
        "G4",
        "G4 P1 G28",
        "G0 G28 Z0",
        "G4 P1\nX1",
        "G0 X1 (a (b) )",
        "G0 X1 (a",
        "G0X1Y",
        "G0 U1",
        "T1.5",
        "M3.1",
        "G1.5",
        "G0 N10 X1",
        "F-1",
        "G92 X0 G0",
        "G92",
        "G10 L2 P1 G0 X1",
        "G10 L2 P10 X1",
        "G10 L20 P2 X1 R10",
        "G10 L3 P1 X1",
        "G10 P1 X1",
        "G33 Z-5 K1",
        "S9 M3\nG33 Z-5",
        "S9 M3\nG33 K1",
        "G33.1 Z-5 K1",
        "G96",
        "S100\nG96 D500",
        "G97 D500 S100",
        "G38.2 Z-5",
        "F9 G38.2",
        "F9 G93 G38.2 Z-5 F1",
        "G5 X1 Y1 I1 J1",
        "F9 G5.1 X1 Y1",
        "F9 G18 G5.1 X1 Y1 I1 J1",
        "G0 @-1 ^3 X1",
        "G0 @5 ^3 X1",
        "G18\nG0 @5 ^3",
        "G7 G8",
        "M50 P1 M52",
        "M62",
        "M61",
        "G0 X0 Y0 Z0 F10\nG2 X10",
        "G0 X0 Y0 Z0 F10\nG2 X10 I5 K1",
        "G0 X0 Y0 Z0 F10\nG2 X10 I5 R5",
        "G0 X0 Y0 Z0 F10\nG2 X10 R4.9",
        "G0 X0 Y0 Z0 F10\nG2 X0 Y0 R5",
        "G0 X0 Y0 Z0 F10\nG2 X10 I4",
        "G0 X0 Y0 Z0 F10\nG90.1 G2 X10 I5",
        "G0 X0 Y0 Z0 F10\nG2 I5 P0",
        "G0 X0 Y0 Z0 F10\nG2 I5 P1.5",
        "G0 X0 Y0 Z0 F10\nG2 I5\nX5",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 R2",
        "G98 G0 X0 Y0 Z9 F10\nG81 R2",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z5 R2",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1 R2 L0",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1 R2 K2",
        "G98 G0 X0 Y0 Z9 F10\nG83 X1 Z-1 R2",
        "G98 G0 X0 Y0 Z9 F10\nG82 X1 Z-1 R2",
        "G98 G0 X0 Y0 Z9 F10\nG89 X1 Z-1 R2",
        "G98 G0 X0 Y0 Z9 F10 S9 M3\nG86 X1 Z-1 R2",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1 R2\nR3",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1 R2\nG82 X2 P1",
        "G98 G0 X0 Y0 Z9 F10\nG81 X1 Z-1 R2\nG80\nX2",
        "G98 G0 X0 Y0 Z9 F10\nG91 G53 G0 X1",
        "G53 X1",
        "G93 F2 G1 X1\nX2",
        "G94 F10\nG93 G1 X1 F2\nG94 X2",
        "G95 F0.1 G1 X1",
    ] {
        is_refused_by_both(&format!("{block}\nM2\n"));
    }
}

#[test]
fn the_ends_of_an_arc_may_differ_in_radius_as_they_may_on_linuxcnc() {
    // 2√2 of 0.01 mm or 0.001 inch; a hundred times that where it is 0.1 % of the larger radius.
    for (unit, radius, apart, taken) in [
        (21, 5.0, 0.0282, true),
        (21, 5.0, 0.0284, false),
        (21, 5.0, -0.0282, true),
        (21, 100.0, 0.0999, true),
        (21, 100.0, 0.1002, false),
        (21, 3000.0, 2.82, true),
        (21, 3000.0, 2.84, false),
        (20, 0.5, 0.0028, true),
        (20, 0.5, 0.0029, false),
        (20, 10.0, 0.0099, true),
        (20, 10.0, 0.0102, false),
    ] {
        let end = 2.0 * radius + apart;
        let program = format!("G{unit}\nG90 G0 X0 Y0 Z0\nF50\nG2 X{end} Y0 I{radius} J0\nM2\n");
        match taken {
            true => makes_the_same_moves(&program),
            false => is_refused_by_both(&program),
        }
    }
    is_refused_by_both("G90 G0 X0 Y0 Z0 F50\nG2 X0.001 Y0.001 I0.001 J0\nM2\n");
}

/// `convert_feed_mode` sets F to 0 whatever was on before.
#[test]
fn a_word_of_the_feed_mode_ends_f_also_where_it_is_on_already() {
    for program in [
        "G94 F100\nG1 X1\nG94\nX2\nM2\n",
        "G94 F100\nG1 X1\nG94 X2\nM2\n",
        "F100\nG94\nG1 X2\nM2\n",
        "G94 F100\nG93\nG94\nG1 X2\nM2\n",
        "M3 S100\nG95 F0.1\nG1 X1\nG95\nX2\nM2\n",
    ] {
        is_refused_by_both(program);
    }
    for program in [
        "G94 F100\nG1 X1\nG94 F50 X2\nM2\n",
        "G94 F100\nG1 X1\nG94\nG0 X2\nM2\n",
        "G94 F100\nG1 X1\nG94\nF50\nX2\nM2\n",
        "G93\nG1 X1 F5\nG93 X2 F6\nM2\n",
    ] {
        makes_the_same_moves(program);
    }
}

#[test]
fn g1_needs_its_f_also_where_it_names_no_axis() {
    for program in [
        "G94\nG1\nM2\n",
        "G94\nG1\nF100 X1\nM2\n",
        "G93\nG1\nX1 F3\nM2\n",
        "G94\nG2\nF9\nM2\n",
        "G33\nM2\n",
    ] {
        is_refused_by_both(program);
    }
    for program in ["G94\nG1 F100\nX1\nM2\n", "G94 F9\nG1\nX1\nM2\n", "G93\nG1 F5\nX1 F3\nM2\n"] {
        makes_the_same_moves(program);
    }
}

/// The whole text, without a unit before it.
#[test]
fn a_percent_sign_stands_before_the_first_block_and_once_behind_it() {
    for (program, takes) in [
        ("%\nG21\nG94 F100\nG1 X1\n%\n", true),
        ("%\nG21\nG94 F100\nG1 X1\nM2\n%\n", true),
        ("\n \n%\nG21\nG94 F100\nG1 X1\n%\n", true),
        ("G21\nG94 F100\nG1 X1\n%\nG1 X2\nM2\n", false),
        ("G21\nG94 F100\nG1 X1\n%\n", false),
        ("G21\n%\nG94 F100\nG1 X1\n%\n", false),
        ("(c)\n%\nG21\nG94 F100\nG1 X1\n%\n", false),
        ("% x\nG21\nG94 F100\nG1 X1\n%\n", false),
    ] {
        assert_eq!(ours(program.as_bytes(), MILL, &[]).is_ok(), takes, "{program}");
        if let Some(theirs) = theirs(program.as_bytes(), &[]) {
            assert_eq!(theirs.is_ok(), takes, "{program}");
        }
    }
}
