//! Every name that a control file may use, in one table.
//!
//! The template compiler refuses what is not here, `toolpost explain` and the documentation print it,
//! and the writer's own names are generated from it, so that no name is known in two places.

use serde::Serialize;
use std::sync::LazyLock;

/// A name that a control file may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Parameter {
    /// What kind of name it is.
    pub kind: Kind,
    /// The name, as it is written in the file.
    pub name: &'static str,
    /// Unit of the value; empty where there is none.
    pub unit: &'static str,
    /// What it is or when it is written, in a sentence.
    pub help: &'static str,
}

/// The kinds of names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A template of `[blocks]`.
    Block,
    /// A number with its address, of `[words]`: `{{X}}`.
    Word,
    /// A word whose text comes from a table, of `[words]`: `{{motion}}`. Its unit names the entries.
    Code,
    /// A value that templates may read: `{{ tool.name }}`.
    Variable,
}

/// The whole catalogue: blocks, words, codes, variables.
pub fn catalogue() -> &'static [Parameter] {
    static ALL: LazyLock<Vec<Parameter>> =
        LazyLock::new(|| [BlockName::TABLE, WordName::TABLE, VARIABLES].concat());
    &ALL
}

/// An enum whose variants are the rows of a table of parameters, in the same order.
macro_rules! names {
    ($(#[$doc:meta])* $enum:ident { $($variant:ident $kind:ident $name:literal, $unit:literal, $help:literal;)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum $enum { $($variant),* }

        impl $enum {
            pub(crate) const TABLE: &'static [Parameter] =
                &[$(Parameter { kind: Kind::$kind, name: $name, unit: $unit, help: $help }),*];
            pub(crate) const ALL: &'static [$enum] = &[$($enum::$variant),*];
            pub(crate) const COUNT: usize = Self::ALL.len();

            pub(crate) fn name(self) -> &'static str {
                Self::TABLE[self as usize].name
            }

            pub(crate) fn named(name: &str) -> Option<$enum> {
                Self::TABLE.iter().position(|row| row.name == name).map(|i| Self::ALL[i])
            }
        }
    };
}

names! {
    /// The blocks.
    BlockName {
        ProgramStart Block "program_start", "", "Once, first. It has to bring the control to millimetres, absolute positions, plane XY, feed per minute, no cutter compensation and the work offset.";
        ProgramEnd Block "program_end", "", "Once, last: retract, spindle and coolant off, F in mm/min again ({{feed_mode}}), end of program.";
        Load Block "load", "", "On a robot, behind `frames`, where the cell states what hangs on the flange as the block places it: {{LOAD_MASS}} and its centre, or {{LOAD_NUMBER}}.";
        PartStart Block "part_start", "", "On a robot whose program is divided into files, first in each part; `program_start` where it is missing. `program.name` is the name of the part.";
        PartCall Block "part_call", "", "In the main program of those files, for each part in turn: `program.part` is its name. Programs are not divided where it is missing.";
        PartEnd Block "part_end", "", "Last in each part; `program_end` where it is missing.";
        OperationStart Block "operation_start", "", "At the start of each operation of the source.";
        OperationEnd Block "operation_end", "", "At the end of each operation of the source.";
        Comment Block "comment", "", "For each comment of the source; `text` is the comment.";
        Message Block "message", "", "For each message to the operator; `comment` where it is missing.";
        ToolPreselect Block "tool_preselect", "", "Where the source makes the next tool ready; nothing where it is missing.";
        ToolChange Block "tool_change", "", "At each tool change: to a safe place in machine coordinates, the tool, its length offset.";
        ToolByHand Block "tool_by_hand", "", "On a robot whose cell names no `tool_change`, where another tool is put into the spindle by hand: a message to the operator in which {{T}} is the first number, and a stop.";
        SpindleCw Block "spindle_cw", "", "Before the first motion that needs the spindle clockwise at a new speed.";
        SpindleCcw Block "spindle_ccw", "", "The same, counter-clockwise.";
        SpindleOff Block "spindle_off", "", "Where the source stops the spindle.";
        CoolantFlood Block "coolant_flood", "", "Before the first cut with flood coolant.";
        CoolantMist Block "coolant_mist", "", "Before the first cut with mist.";
        CoolantFloodAndMist Block "coolant_flood_and_mist", "", "Before the first cut with both, where both can run.";
        CoolantThrough Block "coolant_through", "", "Before the first cut with coolant through the tool.";
        CoolantOff Block "coolant_off", "", "Where the source stops the coolant.";
        Rapid Block "rapid", "", "Each rapid move.";
        Linear Block "linear", "", "Each straight cutting move.";
        RapidVector Block "rapid_vector", "", "Each rapid move while the tool axis is written as a vector; `rapid` where it is missing.";
        LinearVector Block "linear_vector", "", "Each straight cutting move while the tool axis is written as a vector; `linear` where it is missing.";
        ArcCw Block "arc_cw", "", "Each clockwise arc.";
        ArcCcw Block "arc_ccw", "", "Each counter-clockwise arc.";
        HelixCw Block "helix_cw", "", "Each clockwise arc that rises; `arc_cw` where it is missing.";
        HelixCcw Block "helix_ccw", "", "Each counter-clockwise arc that rises; `arc_ccw` where it is missing.";
        ArcThrough Block "arc_through", "", "Each arc outside the planes of arcs that the machine file lists: through the point half way, {{MX}} {{MY}} {{MZ}}, in any plane. Such arcs are lines where the block is missing.";
        Frames Block "frames", "", "On a robot, before anything moves and behind each tool change: the frame of the source in the world as {{X}} to {{C}}, the tool in the frame of the flange as {{MX}} to {{MC}}.";
        Joints Block "joints", "", "On a robot, each motion of all joints: {{J1}} to {{J6}}.";
        Position Block "position", "", "On a robot whose positions stand behind the instructions, each position of a line or an arc, by its number {{POINT}}.";
        PositionJoints Block "position_joints", "", "The same of a motion of joints.";
        PositionsStart Block "positions_start", "", "Before those positions.";
        Feed Block "feed", "", "On a robot, where the speed of lines and arcs changes: {{F}}. Without it `linear` and `arc_through` place {{F}}.";
        CornerDistance Block "corner_distance", "", "On a robot, where the distance changes within which corners are passed: {{CORNER}}. Without it `linear` and `arc_through` place {{CORNER}}.";
        Thread Block "thread", "", "Each straight move in step with the spindle, {{LEAD}} mm a turn. It runs along the axes whose words it places.";
        Probe Block "probe", "", "Each probing move: straight at the feed, until the probe answers.";
        KeepHeight Block "keep_height", "", "After a probing move whose height is kept: the control puts what the probe has found into {{HEIGHT}}. A control that has this block calculates in its words: Z becomes `[z+part*HEIGHT...]`.";
        PlaneSelect Block "plane_select", "", "Where the plane must change before a block that does not say it.";
        Retract Block "retract", "", "Before the rotary axes turn away from a known position, or the work offset changes: the tool leaves the part in machine coordinates.";
        WorkOffsetSelect Block "work_offset_select", "", "Where the source names a work offset: `{{work_offset}}` is active from here on.";
        WorkOffsetData Block "work_offset_data", "", "Where the source writes the zero of a work offset, {{OFFSET}}, as X, Y, Z, A, B, C in machine coordinates, and `sets_work_offsets` of the machine allows it.";
        Rotate Block "rotate", "", "Rotary axes to their positions while the tool is clear of the part.";
        Unclamp Block "unclamp", "", "The clamps of the rotary axes open: before they turn, where they may be closed.";
        Clamp Block "clamp", "", "The clamps of the rotary axes close: behind `rotate`, where the axes then stand in the cut.";
        PlaneTilt Block "plane_tilt", "", "Tilted plane of work on: frame and swivelling. Which solution the control takes is said by {{sequence}}, by {{DIR}}, or by a move of the rotary axes to it before, where the block places their words.";
        PlaneTiltOff Block "plane_tilt_off", "", "Tilted plane of work off. The rotary axes stay where they are; a block that places their words turns them to 0.";
        PlaneOrigin Block "plane_origin", "", "Where the origin of a tilted plane ({{OX}} {{OY}} {{OZ}}) is written in a block of its own: before `plane_tilt` where it is another than the last one, and with 0 where the tool stands upright again.";
        LookAheadOn Block "look_ahead_on", "", "Before the first line or arc that cuts: the control looks ahead from here on.";
        LookAheadOff Block "look_ahead_off", "", "Before what look-ahead must not be on for: a hole cycle, a thread, a probing move, a tool change, a turn of the rotary axes, a work offset, the end.";
        ToolCenterOn Block "tool_center_on", "", "Tool center point control on. A block that places {{X}} {{Y}} {{Z}} is the first move under it, from home to above all cuts.";
        ToolCenterOff Block "tool_center_off", "", "Tool center point control off.";
        DynamicOffsetOn Block "dynamic_offset_on", "", "The table carries the work zero along from here on, as it stands.";
        DynamicOffsetOff Block "dynamic_offset_off", "", "The work zero is where it was set up again.";
        ThreadWire Block "thread_wire", "", "Where the wire is threaded (wire EDM). Empty on a control that has no such word: its program cuts one opening.";
        CutWire Block "cut_wire", "", "Where the wire is cut (wire EDM).";
        CycleDrill Block "cycle_drill", "", "Definition of a drilling cycle. A definition that places {{X}} drills the first hole itself.";
        CycleDwell Block "cycle_dwell", "", "The same with a dwell at the bottom; `cycle_drill` where it is missing and places {{DWELL}}.";
        CycleDeep Block "cycle_deep", "", "Definition of deep drilling: out of the hole after each peck.";
        CycleBreakChip Block "cycle_break_chip", "", "Definition of drilling with chip breaking.";
        CycleTap Block "cycle_tap", "", "Definition of tapping, right-hand.";
        CycleTapLeft Block "cycle_tap_left", "", "Definition of tapping, left-hand.";
        CycleReam Block "cycle_ream", "", "Definition of reaming: feed in, feed out.";
        CycleReamDwell Block "cycle_ream_dwell", "", "The same with a dwell at the bottom; `cycle_ream` where it is missing and places {{DWELL}}.";
        CycleBore Block "cycle_bore", "", "Definition of boring: feed in, spindle stop, rapid out.";
        CycleHole Block "cycle_hole", "", "Each hole of the cycle that its definition has not drilled.";
        CycleOff Block "cycle_off", "", "End of the cycle. After tapping and boring the spindle is started again, for controls differ in whether it turns then.";
        Dwell Block "dwell", "", "A dwell.";
        Stop Block "stop", "", "An unconditional stop.";
        OptionalStop Block "optional_stop", "", "A stop that the operator can switch off.";
        Auxiliary Block "auxiliary", "", "A function of the machine's builder that the source calls ({{M}}) and `auxiliary` of the machine lists. Empty leaves such functions out.";
        DigitalOutput Block "digital_output", "", "Where the source switches an output: {{output}} says how, {{SIGNAL}} which.";
        AnalogOutput Block "analog_output", "", "Where the source sets an analog output: {{analog}} says when, {{CHANNEL}} which, {{VALUE}} to what.";
        DigitalInput Block "digital_input", "", "Where the source reads an input, or waits for it: {{SIGNAL}} says which, {{until}} for what, {{TIMEOUT}} how long.";
        AnalogInput Block "analog_input", "", "Where the source reads an analog input, {{CHANNEL}}.";
    }
}

names! {
    /// The words and codes.
    WordName {
        N Word "N", "", "Block number: counts the lines that carry it. With step 0 it is left out.";
        X Word "X", "mm", "End of the move.";
        Y Word "Y", "mm", "End of the move.";
        Z Word "Z", "mm", "End of the move.";
        A Word "A", "degrees", "Position of the rotary axis A; left out where the machine has none. On a robot the turn of the tool about Z.";
        B Word "B", "degrees", "Position of the rotary axis B; left out where the machine has none. On a robot the turn about the new Y.";
        C Word "C", "degrees", "Position of the rotary axis C; left out where the machine has none. On a robot the turn about the new X.";
        U Word "U", "mm", "How far the wire is from X at the upper plane (wire EDM); left out where it stands upright in the whole program.";
        V Word "V", "mm", "How far it is from Y there.";
        Taper Word "TAPER", "degrees", "By how much the control leans the wire, in a block that switches that on (wire EDM).";
        VX Word "VX", "", "Tool axis, a unit vector from the tip to the spindle: X.";
        VY Word "VY", "", "Tool axis: Y.";
        VZ Word "VZ", "", "Tool axis: Z.";
        I Word "I", "mm", "Centre of the arc from its start, X.";
        J Word "J", "mm", "Centre of the arc from its start, Y.";
        K Word "K", "mm", "Centre of the arc from its start, Z.";
        CX Word "CX", "mm", "Centre of the arc, absolute, X.";
        CY Word "CY", "mm", "Centre of the arc, absolute, Y.";
        CZ Word "CZ", "mm", "Centre of the arc, absolute, Z.";
        Radius Word "R", "mm", "Radius of the arc, negative where it turns by more than a half circle. A block that has it in place of the centre is cut into arcs of which it says enough.";
        PlainRadius Word "RADIUS", "mm", "Radius of the arc without that sign.";
        MX Word "MX", "mm", "Point half way along the arc, X. A block that has it in place of the centre turns less than a circle and does not rise.";
        MY Word "MY", "mm", "Point half way along the arc, Y.";
        MZ Word "MZ", "mm", "Point half way along the arc, Z.";
        MA Word "MA", "degrees", "Orientation of a robot's tool half way along an arc: the turn about Z.";
        MB Word "MB", "degrees", "The turn about the new Y there.";
        MC Word "MC", "degrees", "The turn about the new X there.";
        VectorX Word "RVX", "degrees", "Orientation of a robot's tool as a vector along its axis of rotation, as long as the angle: X.";
        VectorY Word "RVY", "degrees", "Y of that vector.";
        VectorZ Word "RVZ", "degrees", "Z of that vector.";
        MiddleVectorX Word "MRVX", "degrees", "The same half way along an arc: X.";
        MiddleVectorY Word "MRVY", "degrees", "Y of that vector.";
        MiddleVectorZ Word "MRVZ", "degrees", "Z of that vector.";
        Quaternion1 Word "Q1", "", "Orientation of a robot's tool as a quaternion of length 1: its scalar, not below 0.";
        Quaternion2 Word "Q2", "", "Its part along X.";
        Quaternion3 Word "Q3", "", "Its part along Y.";
        Quaternion4 Word "Q4", "", "Its part along Z.";
        MiddleQuaternion1 Word "MQ1", "", "The same half way along an arc: its scalar.";
        MiddleQuaternion2 Word "MQ2", "", "Its part along X.";
        MiddleQuaternion3 Word "MQ3", "", "Its part along Y.";
        MiddleQuaternion4 Word "MQ4", "", "Its part along Z.";
        Configuration1 Word "CF1", "", "Quarter of a turn in which joint 1 of a robot is at the end of a line or an arc: 0 from 0 to below 90°, -1 below 0.";
        Configuration4 Word "CF4", "", "That of joint 4.";
        Configuration6 Word "CF6", "", "That of joint 6.";
        ConfigurationX Word "CFX", "", "Posture of a robot there: 4 for a wrist behind axis 1, 2 for an elbow below, 1 for joint 5 below 0, added up.";
        J1 Word "J1", "degrees", "Position of joint 1 of a robot, as the controller shows it.";
        J2 Word "J2", "degrees", "Position of joint 2.";
        J3 Word "J3", "degrees", "Position of joint 3.";
        J4 Word "J4", "degrees", "Position of joint 4.";
        J5 Word "J5", "degrees", "Position of joint 5.";
        J6 Word "J6", "degrees", "Position of joint 6.";
        RailSpeed Word "RAIL_SPEED", "mm/s", "How fast that rail goes in motions of the joints: `joint_speed` of the cell, as percent of its `speed`.";
        Rail Word "RAIL", "mm", "Position of the rail on which a robot stands (`rail` below [cell]), at the end of each motion.";
        Point Word "POINT", "", "Number of the position at which a robot's motion ends, where positions stand behind the instructions.";
        MiddlePoint Word "MIDDLE_POINT", "", "Number of the position half way along an arc.";
        Turn1 Word "TURN1", "turns", "Turns of joint 1 in a position: 0 from -180 to below 180 degrees.";
        Turn4 Word "TURN4", "turns", "Turns of joint 4.";
        Turn6 Word "TURN6", "turns", "Turns of joint 6.";
        OwnFrame Word "OWN_FRAME", "", "`own_frame` of the cell, in every block.";
        Lines Word "LINES", "", "Number of the numbered lines of a robot's program, in `program_start`.";
        JointSpeed Word "JOINT_SPEED", "%", "Speed of motions of joints, of the fastest, in `frames` and `joints`.";
        JointRate Word "JOINT_RATE", "degrees/s", "The same part of the speed of the slowest joint: no joint turns faster.";
        TurnSpeed Word "TURN_SPEED", "degrees/s", "`turn_speed` of the options, in `frames`: how fast the tool may turn, its axis and about it each.";
        Corner Word "CORNER", "mm", "How far before its end a cut may leave its path: twice what the corner may be off; 0 where it stops.";
        LoadNumber Word "LOAD_NUMBER", "", "`load_number` of the cell, in `load`.";
        LoadMass Word "LOAD_MASS", "kg", "Mass of what hangs on a robot's flange, in `frames` or `load`.";
        LoadX Word "LOAD_X", "mm", "Its centre of gravity in the frame of the flange: X.";
        LoadY Word "LOAD_Y", "mm", "Its centre of gravity: Y.";
        LoadZ Word "LOAD_Z", "mm", "Its centre of gravity: Z.";
        SX Word "SX", "mm", "Start of the arc, X.";
        SY Word "SY", "mm", "Start of the arc, Y.";
        SZ Word "SZ", "mm", "Start of the arc, Z.";
        StartAngle Word "START_ANGLE", "degrees", "Direction from the centre to the start of the arc, counter-clockwise from the first axis of the plane, 0 to 360.";
        EndAngle Word "END_ANGLE", "degrees", "The same to its end: START_ANGLE and SWEEP together, so greater where the arc is counter-clockwise, else less.";
        Sweep Word "SWEEP", "degrees", "Angle of the arc, counter-clockwise positive, several turns over 360.";
        Rise Word "RISE", "mm", "Travel of a helix along the normal of the plane.";
        Turn Word "TURN", "turns", "Full turns of an arc before the one that ends it. An arc whose block lacks the word is cut into single turns.";
        F Word "F", "mm/min", "Feed of the move.";
        FeedFine Word "F_fine", "mm/min", "How a robot's {{F}} is written where its own word would round the feed by more than a two-hundredth, and this one by less: another unit, which {{feed_unit}} names.";
        FeedPerTurn Word "F_per_turn", "mm", "How {{F}} is written while the feed is per turn of the spindle.";
        FeedInverse Word "F_inverse_time", "1/min", "How {{F}} is written while the feed is inverse time.";
        Tolerance Word "TOLERANCE", "mm", "How far the control may leave the path: as the source says for its cuts, at the most `path_tolerance`, or `roughing_tolerance` where that is more. `look_ahead_on` may place it; without `look_ahead_off` that is written only where it changes.";
        S Word "S", "1/min", "Speed of the spindle.";
        T Word "T", "", "Number of the tool.";
        H Word "H", "", "Register of the tool length offset, 1 or the tool's as `length_offset` says: at the tool change, when tool center point control goes on, and with each straight move that says Z.";
        D Word "D", "", "Register of the cutter radius, in a block that switches compensation on: the source's or the tool's number.";
        P Word "P", "s", "Dwell of the `dwell` block.";
        OX Word "OX", "mm", "Origin of the tilted plane in the work frame, X.";
        OY Word "OY", "mm", "Origin of the tilted plane, Y.";
        OZ Word "OZ", "mm", "Origin of the tilted plane, Z.";
        RX Word "RX", "degrees", "Turn of the tilted plane about X, first of X-Y'-Z''.";
        RY Word "RY", "degrees", "Turn about the new Y, second.";
        RZ Word "RZ", "degrees", "Turn about the new Z, third.";
        SpatialA Word "SPA", "degrees", "Turn of the tilted plane about the fixed X, first of X-Y-Z.";
        SpatialB Word "SPB", "degrees", "Turn about the fixed Y, second.";
        SpatialC Word "SPC", "degrees", "Turn about the fixed Z, third.";
        Euler1 Word "E1", "degrees", "Turn of the tilted plane about Z, first of the Euler angles Z-X'-Z''.";
        Euler2 Word "E2", "degrees", "Turn about the new X, second.";
        Euler3 Word "E3", "degrees", "Turn about the new Z, third.";
        Direction Word "DIR", "", "Which of the two solutions for a tilted plane the control takes: 1 the one with the higher position of the axis that `swivel_direction` names, -1 the one with the lower. -1 where that makes no difference.";
        LowX Word "LOW_X", "mm", "Smallest X of the blank, in `program_start`, where `program.blank`: of the stock, or of the edges of the tools in all cuts.";
        LowY Word "LOW_Y", "mm", "Smallest Y of the blank.";
        LowZ Word "LOW_Z", "mm", "Smallest Z of the blank.";
        HighX Word "HIGH_X", "mm", "Largest X of the blank.";
        HighY Word "HIGH_Y", "mm", "Largest Y of the blank.";
        HighZ Word "HIGH_Z", "mm", "Largest Z of the blank.";
        SafeHeight Word "SAFE_HEIGHT", "mm", "The safe height of the machine, in machine coordinates (`safe_height`): in every block.";
        RetractHeight Word "RETRACT_HEIGHT", "mm", "Z over the work zero to which tools retract on a machine without switches: `retract_height` of the options above all that is cut, and no lower than the source goes. In every block.";
        RapidFeed Word "RAPID_FEED", "mm/min", "The fastest rapid of X, Y and Z, for a control whose rapids go at the last F: in every block. F is said anew behind it.";
        Surface Word "SURFACE", "mm", "Cycle: level of the point of the hole.";
        Clear Word "CLEAR", "mm", "Cycle: level from which the tool feeds (R plane).";
        RPlane Word "R_PLANE", "mm", "Cycle: the same level as a coordinate of a move. A cycle that places it makes one hole, by moves that end at the retract level, and is written for each.";
        Bottom Word "BOTTOM", "mm", "Cycle: level of the bottom.";
        Retract Word "RETRACT", "mm", "Cycle: level to which the tool goes back.";
        Depth Word "DEPTH", "mm", "Cycle: depth from the point of the hole, positive.";
        Safety Word "SAFETY", "mm", "Cycle: height of the R plane above the point of the hole.";
        Lift Word "LIFT", "mm", "Cycle: height of the retract level above the point of the hole.";
        Peck Word "PECK", "mm", "Cycle: depth of a peck, where it pecks.";
        Dwell Word "DWELL", "s", "Cycle: dwell at the bottom.";
        Pitch Word "PITCH", "mm", "Cycle: pitch of the thread, negative for left-hand.";
        Plunge Word "PLUNGE", "mm/min", "Cycle: feed into the hole, where it is a parameter; in the unit of {{F}}.";
        Speed Word "SPEED", "1/min", "Cycle: speed of the spindle, where it is a parameter.";
        Lead Word "LEAD", "mm", "Lead of a thread: how far the tool goes in a turn of the spindle.";
        Height Word "HEIGHT", "", "Parameter that keeps the height of a place of the surface, the first as `first` says.";
        M Word "M", "", "Number of a function of the machine's builder.";
        FirstValue Word "FIRST_VALUE", "", "First value that a function of the machine's builder is called with.";
        SecondValue Word "SECOND_VALUE", "", "Second value that it is called with.";
        Offset Word "OFFSET", "", "Number of the work offset that is written: 1 is the first.";
        Signal Word "SIGNAL", "", "Number of a digital output or input.";
        Channel Word "CHANNEL", "", "Number of an analog output or input.";
        Value Word "VALUE", "", "What an analog output is set to, in the unit of the machine.";
        Timeout Word "TIMEOUT", "s", "How long the program waits for an input at the most; left out where it only reads it.";
        Output Code "output", "on, off, on_with_motion, off_with_motion", "How an output is switched: at once, or with the beginning of the next motion. Those that the control lacks are left out.";
        AnalogOutput Code "analog", "at_once, with_motion", "When an analog output is set. Those that the control lacks are left out.";
        Until Code "until", "read, rise, fall, high, low", "What the program waits for at an input; `read` does not wait. Those that the control lacks are left out.";
        ProbeMode Code "probe_mode", "toward_or_error, toward, away_or_error, away", "Kind of probing move: until the probe touches the part or lets go of it, with an error where it does not or without. Those that the control lacks are left out.";
        Wrist Code "wrist", "plain, flipped", "Posture of a robot in a position: whether joint 5 of the model is negative.";
        Elbow Code "elbow", "up, down", "Whether the elbow is below the line from shoulder to wrist.";
        Shoulder Code "shoulder", "front, rear", "Whether the wrist is behind axis 1.";
        CornerMode Code "corner", "exact, blend", "How a robot passes the end of a line or an arc: it stops there, or within {{CORNER}}.";
        Motion Code "motion", "rapid, linear, arc_cw, arc_ccw", "Kind of motion.";
        Plane Code "plane", "xy, xz, yz", "Plane of arcs and of cutter compensation.";
        Compensation Code "compensation", "off, left, right", "Cutter radius compensation; switched with the first move in the plane.";
        TaperSide Code "taper", "off, left, right", "Lean of the wire by the control; switched with a straight cut (wire EDM).";
        Length Code "length", "on", "Tool length offset, with each straight move that says Z.";
        WorkOffset Code "work_offset", "54, 55, 56, 57, 58, 59, 60, 61, 62", "The active work offset, in every block: 54 is the first that the control can set. Those that it lacks are left out.";
        Sequence Code "sequence", "positive, negative", "The sign of the main rotary axis (the first from the tool, or the last from the table), in the block of a tilted plane that has two solutions within the travel.";
        FeedUnit Code "feed_unit", "coarse, fine", "In which unit a robot's {{F}} is: its own, or that of `F_fine`.";
        FeedMode Code "feed_mode", "per_minute, per_turn, inverse_time", "What {{F}} means.";
    }
}

/// What templates may read besides words. `options.` stands for the machine's own `[options]`.
pub(crate) const VARIABLES: &[Parameter] = &[
    variable("program.name", "", "Name of the program: letters, digits, `_` and `-` only."),
    variable("program.part", "", "In `part_call`, the name of the part that is called."),
    variable(
        "coolant.through",
        "",
        "Whether the coolant that was switched on last goes through the tool.",
    ),
    variable(
        "program.number",
        "",
        "Number of the program, without zeros before it: `program_number` of the options, else its name where that is 1 to 7999, with or without an O before it; otherwise undefined.",
    ),
    variable("program.tools", "", "The tools in the order of their first use, each as `tool`."),
    variable(
        "program.blank",
        "",
        "Whether there is a blank, {{LOW_X}} to {{HIGH_Z}} in `program_start`: the stock, or how far the cuts reach, more than 0.01 mm in X, in Y and in Z, in one work offset.",
    ),
    variable(
        "program.stock",
        "",
        "Whether that blank is the stock as the source states it, and not how far the cuts reach.",
    ),
    variable("machine.name", "", "Name of the machine, as `--machine` takes it."),
    variable("machine.title", "", "What a person calls the machine."),
    variable(
        "machine.vectors",
        "",
        "Whether cuts that turn the tool are written with its axis as a vector (`simultaneous` is `vectors`).",
    ),
    variable(
        "machine.tool_center",
        "",
        "Whether cuts that turn the tool are written for a control that keeps its tip (`simultaneous` is `tool-center-angles` or `vectors`).",
    ),
    variable(
        "machine.tilted_plane",
        "",
        "Whether a tool that stands inclined is written with a tilted plane of work (`positioned` is `tilted-plane`).",
    ),
    variable("operation.name", "", "Name of the operation, in its blocks and all that follow."),
    variable("tool.number", "", "Number of the tool."),
    variable("tool.first", "", "Whether no tool has been called before."),
    variable("tool.name", "", "Name of the tool."),
    variable(
        "tool.identifier",
        "",
        "Name of the tool where it can call the tool: letters, digits, `_`, `.` and `-` only, at most 32; otherwise undefined.",
    ),
    variable(
        "tool.next",
        "",
        "In `tool_change`: the number of the tool that is called next, behind the last that of the first; undefined where the program has one tool.",
    ),
    variable(
        "tool.next_identifier",
        "",
        "Name of that tool where it can call the tool, as `tool.identifier`; otherwise undefined.",
    ),
    variable("tool.diameter", "mm", "Cutting diameter; undefined where the source is silent."),
    variable("tool.corner_radius", "mm", "Corner radius; undefined where the source is silent."),
    variable("tool.length", "mm", "Length of the tool; undefined where the source is silent."),
    variable("spindle.clockwise", "", "Whether the spindle turns clockwise, while it turns."),
    variable("spindle.changed", "", "Whether the speed is another than the one last written."),
    variable(
        "spindle.stopped",
        "",
        "Whether the spindle is known to stand: since a stop or a tool change of the program.",
    ),
    variable(
        "coolant.stopped",
        "",
        "Whether the coolant is known to be off: since the program has switched it off, or changed a tool.",
    ),
    variable(
        "coolant.off",
        "",
        "The M function that ends the coolant that was switched on last: `M9`, or what `[coolant]` names.",
    ),
    variable(
        "place.home",
        "",
        "Whether Z is known to be home: since a `retract` or a tool change, and nothing has moved.",
    ),
    variable(
        "place.turned",
        "",
        "In `tool_change` and `program_end`: whether a rotary axis whose word the block places has to turn to 0, or on an axis without an end to the nearest whole turn.",
    ),
    variable("place.tilted", "", "Whether a tilted plane or tool center point control is on."),
    variable(
        "place.tool_center_off",
        "",
        "Whether `tool_center_off` has just been written: nothing has moved since.",
    ),
    variable(
        "place.plane_off",
        "",
        "Whether `plane_tilt_off` has just been written: nothing has moved since.",
    ),
    variable(
        "cut.exact",
        "",
        "In `look_ahead_on`: whether the cuts to come keep to the path. Where the block reads it and has no {{TOLERANCE}}, they do so whenever the source says less than `path_tolerance`.",
    ),
    variable(
        "cut.rough",
        "",
        "In `look_ahead_on`: whether the cuts to come are roughing: the source says more than `path_tolerance` for them, and `roughing_tolerance` of the options allows more.",
    ),
    variable("text", "", "The text of a comment or a message."),
    variable("options", "", "The values of `[options]` of the machine: `{{ options.NAME }}`."),
];

const fn variable(name: &'static str, unit: &'static str, help: &'static str) -> Parameter {
    Parameter { kind: Kind::Variable, name, unit, help }
}

impl WordName {
    /// The entries of a code word; none for a number.
    pub(crate) fn codes(self) -> impl Iterator<Item = &'static str> {
        let row = &WordName::TABLE[self as usize];
        row.unit.split(", ").filter(move |_| row.kind == Kind::Code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_stands_once_and_has_help() {
        let mut names: Vec<_> = catalogue().iter().map(|p| p.name).collect();
        assert!(catalogue().iter().all(|p| p.help.ends_with('.')));
        names.sort();
        let all = names.len();
        names.dedup();
        assert_eq!(names.len(), all);
    }

    #[test]
    fn names_and_variants_agree() {
        assert_eq!(WordName::named("PECK"), Some(WordName::Peck));
        assert_eq!(WordName::Peck.name(), "PECK");
        assert_eq!(WordName::Plane.codes().collect::<Vec<_>>(), ["xy", "xz", "yz"]);
        assert_eq!(WordName::X.codes().count(), 0);
    }
}
