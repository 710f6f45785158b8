//! The way out of each rule, for findings that have none of their own.

/// What to do about a finding of a rule, in the order of the names. A finding whose way out depends on its values
/// gives its own by [`Diagnostic::help`](crate::Diagnostic::help); all others need a row here.
const WAYS_OUT: &[(&str, &str)] = &[
    ("after-end", "move the end of the program behind its last block, or delete what follows it"),
    (
        "alarm",
        "the program stops itself here: set the variables so that it does not come here, or remove the alarm",
    ),
    ("angle", "give the angle in degrees, within the range that the control takes"),
    ("arc", "correct the end point, the centre or the radius of the arc"),
    ("arc-direction", "give the direction in which the tool leaves, tangent to the circle"),
    (
        "arc-lowered",
        "nothing to do, if the tolerance suits the part; a control with the block `arc_cw` or `helix_cw` writes the arc itself",
    ),
    ("arc-radius", "correct the radius: the end point must be reachable with it"),
    ("arc-start", "give a rapid to the start before the arc"),
    ("argument", "give one of the values that the documentation of the function lists"),
    ("arithmetic", "correct the formula or the values that it gets"),
    ("array-index", "use an index within the declared size of the array"),
    ("array-shape", "give an array of the named shape"),
    ("aside", "choose one of these cycles, or leave the way aside out"),
    (
        "auxiliary",
        "add the block `auxiliary` to the control's file where the machine needs this function",
    ),
    (
        "axis-limit",
        "move the part in the machine (`work_zero`), or choose a machine with more travel",
    ),
    ("blank", "give two corners, the second above the first in X, Y and Z, or leave both out"),
    ("block-length", "divide the block into several"),
    ("block-number", "give a block number that the control takes, or none"),
    ("board-too-large", "take a part of the board, or a wider tool"),
    (
        "call",
        "correct the name or the parameters of the call; a called program lies in the folder of the main program",
    ),
    ("call-depth", "call fewer programs within each other"),
    (
        "called-program",
        "save the called program, in the control's own format, in the folder of the main program",
    ),
    (
        "carried-otherwise",
        "compare this with the manual of the machine, and correct the new file where they differ",
    ),
    ("clamp", "check that `unclamp` and `clamp` in the machine file are those of this machine"),
    (
        "compensated-path",
        "leave `--cutcom` out, or give what the points of the toolpath are (`centre` or `contour`)",
    ),
    (
        "compensation",
        "switch the compensation in a straight move in the plane, with a tool radius set",
    ),
    ("compensation-arc", "make the inside arc larger than the tool radius, or use a smaller tool"),
    (
        "compensation-entry",
        "approach the contour by a straight move that is longer than the tool radius",
    ),
    (
        "compensation-look-ahead",
        "put fewer blocks without movement between two moves of the compensated contour",
    ),
    ("compensation-on", "switch the compensation off (G40) before this block"),
    ("compensation-open", "switch the compensation off (G40) before the end of the program"),
    ("compensation-pending", "let a straight cut follow the switch of the compensation"),
    ("compensation-plane", "select the plane before the compensation is switched on"),
    ("compensation-radius", "give the radius of the tool, in the tool table or by the program"),
    (
        "contour",
        "correct the approach or the departure: it needs a known start, a tangent, and a length or radius that fits",
    ),
    (
        "control-structure",
        "close each structure in its own order: IF with ENDIF, FOR with ENDFOR, WHILE with ENDWHILE, REPEAT with UNTIL, LOOP with ENDLOOP",
    ),
    (
        "copper-outside",
        "correct the outline or the copper in the CAD program; only copper within the outline is cut around",
    ),
    ("corner", "put the corner between two moves in the plane, each longer than it takes away"),
    ("corner-rounded", "a thinner wire leaves less"),
    (
        "cycle",
        "define the cycle before it is called, and call it where nothing forbids it (compensation off, plane selected)",
    ),
    ("cycle-depth", "give one depth, below the reference plane"),
    ("cycle-expanded", "nothing to do; a control with the block of this cycle writes it itself"),
    ("cycle-missing", "give a CYCLE record before the first hole"),
    (
        "cycle-parameter",
        "correct the parameter; the maker's manual names the range and the order of the parameters",
    ),
    ("cycle-peck", "give a peck above 0, and less than the depth"),
    ("cycle-tap", "give the pitch of the thread (feed divided by speed) and a spindle speed"),
    (
        "definition",
        "correct the definition: type, name and size, before the first block that uses it",
    ),
    ("diameter", "choose a tool within the range of the machine, or correct the tool's data"),
    ("drawing", "save the picture as SVG, or make it smaller"),
    ("dwell", "give one time, in seconds or turns, not below 0, in a block of its own"),
    ("dxf-binary", "save the drawing as ASCII DXF"),
    ("dxf-code", "save the drawing again as ASCII DXF; the file is damaged or cut off"),
    ("dxf-doubled", "nothing to do; delete the doubled entities in the drawing to be rid of this"),
    ("dxf-gap", "nothing to do, if the gaps are not meant; close them in the drawing"),
    (
        "dxf-left-out",
        "nothing to do, if they are no part of the contour; else draw it with lines, arcs and polylines",
    ),
    ("dxf-options", "give a value in the range that is named"),
    (
        "dxf-unit",
        "set the unit of the drawing ($INSUNITS) in the CAD program, or give `unit` in Python",
    ),
    ("empty-contour", "choose the layer by `--layer`, or draw a closed contour"),
    ("encoding", "save the file as UTF-8"),
    ("end-height", "send Z home before the end of the program"),
    (
        "endless",
        "correct the condition that ends the loop; the control follows a limited number of blocks",
    ),
    ("feed", "give a feed above 0 before the first cut, in a mode that the control knows"),
    (
        "feed-approach",
        "check where the tool is before it, or add a rapid to the start in the CAM system",
    ),
    (
        "feed-group",
        "add the axes to the feed group (FGROUP), or give the feed of this move in inverse time (G93)",
    ),
    (
        "feed-inverse-time",
        "nothing to do; the block takes the same time as the feed of the toolpath",
    ),
    (
        "feed-limited",
        "nothing to do, if the slower cut suits the part; the limits are those of the axes in the machine file",
    ),
    ("feed-missing", "give FEDRAT before the first cut"),
    ("feed-per-turn", "nothing to do; the feed was multiplied by the spindle speed"),
    ("feed-zero", "give a feed above 0 that the decimals of the word F can hold"),
    (
        "file-unused",
        "name the file as the layer that it holds, if it should be cut (see `toolpost pcb --help`)",
    ),
    ("fit-without-memory", "give a larger tolerance, or divide the contour"),
    ("flat-contour", "nothing to do, if the contour is flat; else give Z in its first block"),
    ("folder", "check the name of the folder and the right to read it"),
    ("formula", "correct the formula: parentheses, functions and the values that they get"),
    (
        "frame",
        "correct the frame: one instruction a block, with axes and values that the control takes",
    ),
    (
        "freecad",
        "save the document again in FreeCAD 1.0 or newer, or export the job as G-code and read that by `--from`",
    ),
    ("freecad-dump", "read the document again; where it fails again, report it with the document"),
    ("group-conflict", "divide the block: the two words exclude each other"),
    ("header", "begin the program with %_N_NAME_MPF, or without a header"),
    ("helix-end-point", "give an end point that lies on the circle"),
    ("home", "retract the tool first; then send axes home by the block `home` of the machine file"),
    (
        "import",
        "begin with a machine of the library instead: `toolpost machines new NAME --from OTHER`",
    ),
    ("jump", "correct the target of the jump: a label or block number of this program"),
    (
        "label",
        "give each label once, and call only labels that are there; a subprogram ends with its own end block",
    ),
    ("layers-apart", "plot all layers with the same origin"),
    ("left-on", "switch it off before the end of the program: the next one takes it as off"),
    ("length", "choose a tool within the range of the machine, or correct the tool's data"),
    ("length-offset", "activate the length offset of the tool that is in the spindle"),
    ("line-length", "shorten the text in the source, or the block in the control's file"),
    ("linearised", "nothing to do, if the tolerance suits the part; `--tolerance` sets it"),
    ("m-function", "correct the M function: its words, and where it may stand"),
    (
        "machine-file",
        "correct the file at the mark; `toolpost explain NAME` says what a name takes",
    ),
    (
        "machine-incomplete",
        "add what is missing to the machine file; `toolpost explain` lists names and units",
    ),
    (
        "machine-position",
        "add `safe_height` of the machine that the program was written for to its file",
    ),
    ("malformed", "correct the record, or write the file again from the CAM system"),
    ("memory", "divide the contour into several programs"),
    ("missing-block", "add this block to the control's file, or choose a control that has it"),
    ("missing-feed", "give F before the first cut"),
    ("missing-word", "add the word that is missing to the block"),
    ("modulo-position", "give the position within one turn of the axis"),
    ("nc-after-end", "delete what stands behind the end of the program, or move the end"),
    (
        "nc-alarm",
        "the program stops itself here: set the variables so that it does not come here, or remove the alarm",
    ),
    ("nc-arc", "correct the end point, the centre (I J K) or the radius of the arc"),
    ("nc-arithmetic", "correct the formula or the values that it gets"),
    (
        "nc-axis",
        "name the machine that the program was written for: its file says which rotary axes there are",
    ),
    ("nc-block-number", "give a block number that the control takes, or none"),
    (
        "nc-call",
        "correct the number or name of the called program; it lies in the same file or the same folder",
    ),
    ("nc-comment", "close the comment in its own line; comments cannot be nested"),
    (
        "nc-compensation",
        "switch the compensation by a straight move in the plane, with a tool radius set",
    ),
    ("nc-coolant", "give one M function of coolant a block, and one that the control knows"),
    (
        "nc-corner",
        "put `,R` or `,C` between two moves in the plane, each longer than the corner takes away",
    ),
    (
        "nc-cycle",
        "give the words that the cycle needs (depth, retract plane, peck, dwell), each in the range that the control takes",
    ),
    (
        "nc-data",
        "write offsets and tool data by the forms that docs/controls names, or set them at the control",
    ),
    (
        "nc-decimal-point",
        "write the decimal point, or say how numbers without it count (`--whole-numbers`)",
    ),
    ("nc-dwell", "give the time of the dwell, not below 0"),
    (
        "nc-endless",
        "correct the condition that ends the loop; the control follows a limited number of blocks",
    ),
    ("nc-expression", "correct the expression at the mark"),
    ("nc-feed", "give a feed above 0 before the first cut"),
    (
        "nc-frame",
        "end the transformation before the next one begins, and give it the words that the control takes",
    ),
    ("nc-home", "name each axis once, and give its intermediate point"),
    ("nc-input", "give the number of the input and how to wait for it"),
    (
        "nc-kinematics",
        "switch the kinematics at a place where no cycle, compensation or other transformation is active",
    ),
    ("nc-length", "give the length offset with its register (G43 H...)"),
    ("nc-long-block", "divide the block into several"),
    ("nc-look-ahead", "divide the block: the control reads this word ahead of the moves"),
    ("nc-m-beside-cut", "put the M function in a block of its own"),
    (
        "nc-machine-position",
        "give the positions of the machine in the machine file (`home`, `work_zero`), or move in the work frame",
    ),
    ("nc-macro", "correct the macro: each DO has its END, and each GOTO its block"),
    ("nc-many-commands", "divide the block: the control takes one of these commands a block"),
    ("nc-many-m", "divide the block: the control takes fewer M functions a block"),
    ("nc-modal-group", "divide the block: the two words exclude each other"),
    ("nc-modes", "switch the mode in a block of its own, where the control permits it"),
    ("nc-no-motion", "give the axis words of the move"),
    ("nc-number", "correct the number: its range, its digits, its decimal point"),
    (
        "nc-o-word",
        "close each O word in its own order (if with endif, while with endwhile, sub with endsub)",
    ),
    ("nc-output", "give the number of the output, in the range that the control has"),
    ("nc-parameter", "set the variable before it is read, within the numbers that the control has"),
    ("nc-path-mode", "give the tolerance that the path mode needs, not below 0"),
    ("nc-pattern", "give the words that the pattern needs, in the plane that it works in"),
    (
        "nc-polar",
        "give the pole and the radius, and end polar coordinates before another transformation",
    ),
    ("nc-probe", "probe along linear axes, with a feed, to a point other than the start"),
    (
        "nc-program-number",
        "give a program number from 1 to 9999 (or 8 digits where the control takes them)",
    ),
    ("nc-repeated-word", "give each word once in a block"),
    ("nc-spindle", "give a spindle speed and start the spindle before it is needed"),
    ("nc-spline", "give the words that the spline needs, in the plane that it works in"),
    ("nc-syntax", "correct the block at the mark"),
    ("nc-taper", "switch the taper in a straight cut, with an angle that the machine can lean"),
    ("nc-thread", "start the spindle, and give a pitch and linear axes only"),
    (
        "nc-tilt",
        "end the tilted plane before this block, or give it the words that the control takes",
    ),
    (
        "nc-tool",
        "choose a tool (T) before it is changed or used, in the range that the control has",
    ),
    ("nc-units", "switch the unit in a block of its own at the start of the program"),
    (
        "nc-unknown-position",
        "move to a known position first, with every axis named in absolute coordinates",
    ),
    ("nc-unknown-shift", "set the shift before, or leave it out: its value is not in the program"),
    (
        "nc-unknown-word",
        "remove the word, or read the program with the control that it was written for (`--from`, `--control`)",
    ),
    ("nc-unused-word", "remove the word: nothing in this block uses it"),
    ("nc-wire", "thread the wire before the first cut, and cut it before it is threaded again"),
    ("nc-work-offset", "use a work offset that the control has"),
    ("nesting", "use fewer levels within each other"),
    (
        "no-clear-plane",
        "correct the heights of the cycle: clearance and retract above the bottom of the hole",
    ),
    ("no-fini", "add FINI, or write the file again: it may be cut off"),
    ("no-motion", "check that this is the right file, and that the operations were calculated"),
    ("no-start", "give a move to the start point before the arc"),
    ("no-tool", "call the tool (LOAD/TOOL) before its first move"),
    ("node", "give each node another name"),
    ("not-carried-over", "add this to the new file by hand, where the machine needs it"),
    ("not-cldata", "give a file of cutter-location data; for an NC program add `--from CONTROL`"),
    ("number", "give a number in the range that is named"),
    (
        "number-range",
        "move the part nearer to the work zero, or allow more digits for the word in the control's file",
    ),
    (
        "off-the-circle",
        "correct the arc: start and end must have the same distance from the centre",
    ),
    ("offset-divides", "use a thinner wire, or make the contour wider where it is narrow"),
    ("offset-vanishes", "use a thinner wire, or a larger contour"),
    ("operator-offset", "reset the offset of the operator in the program, or do not read it"),
    ("operator-rank", "put parentheses around the part that comes first"),
    ("option", "give a value of the kind that is named"),
    (
        "optional-stop",
        "add the block `optional_stop` to the control's file where the control has one",
    ),
    ("orientation", "give the orientation in one way, complete, in a mode that takes it"),
    (
        "orientation-in-cut",
        "retract before the plane of work changes, or post for a machine that turns while it cuts",
    ),
    ("out-of-range", "check units and frames of the file: the values lead too far away"),
    ("outline-empty", "draw a closed outline around the board"),
    ("parameter", "set the parameter before it is read, within the numbers that the control has"),
    (
        "path-mode",
        "check that the part allows this; `path_tolerance` of the machine file says how far the control leaves the path",
    ),
    ("path-tolerance", "give the tolerance of the path that the machine file allows"),
    ("pattern", "give the points or the lengths that the pattern needs"),
    ("peck", "nothing to do, if more pecks suit the hole"),
    ("pitch", "use the kind `tap`, or leave the pitch out"),
    (
        "plane",
        "give the words that the plane needs, with compensation off, on a machine with rotary axes",
    ),
    ("polar", "give pole, radius and angle in the plane"),
    (
        "probe",
        "give the probing move a feed in mm/min, a fixed tool axis, and an end other than its start",
    ),
    ("program-end", "add the end of the program; the file may be cut off"),
    ("program-error", "the program reports this error itself: correct the values that it checks"),
    (
        "program-frame",
        "begin the program with BEGIN PGM and end it with END PGM, both with its name and unit",
    ),
    ("r-parameter", "use R0 to R999, and set a parameter before the block that reads it"),
    (
        "rapid-feed",
        "write the `rapid` of the machine, in mm/min, below [axes]; a rapid of the toolpath is a rapid (G0) in the program",
    ),
    (
        "rapid-path",
        "nothing to do; a control that brings all axes to their ends together (`rapid_path = \"linear\"`) needs fewer blocks",
    ),
    ("reader", "name the control that the machine has (`reader`)"),
    ("reference-plane", "put the retraction plane above the reference plane"),
    ("register", "set the value at the control with the tool, if the program needs this register"),
    ("repeated-word", "give each word once in a block"),
    ("report-pair", "post the program anew for a report of its own, or remove the report"),
    (
        "rewind",
        "check the marks of the interrupted cut; a machine with more travel, or the part turned, avoids it",
    ),
    ("safe-height", "write the `safe_height` of the machine, mm in machine coordinates"),
    ("spindle", "give a spindle speed above 0 and a direction before the first cut"),
    ("stopped", "it was cancelled: start it again"),
    ("surface", "level the program with measured heights (`--heights`) instead"),
    (
        "sweep",
        "nothing to do; the tolerance holds; points in the CAM system that are closer make it unnecessary",
    ),
    ("syntax", "correct the block at the mark, as the control's programming manual has it"),
    ("taper", "switch the taper in a straight cut"),
    ("taper-active", "end the taper before this record"),
    ("taper-limit", "give a smaller angle, or a machine whose wire may lean more"),
    (
        "template",
        "correct the template at the mark: words, `{{ name }}`, `{% if %}`, `{% for %}` and `{% set %}` are there",
    ),
    ("template-name", "use a name that `toolpost explain` lists"),
    ("template-output", "make the template shorter: what it writes is bounded"),
    ("thread", "give a pitch above 0, a turning spindle and a straight way"),
    ("tool", "call the tool that the toolpath names, by a number or name that the control takes"),
    (
        "tool-center",
        "switch tool centre control on with the tool called, on a machine with rotary axes",
    ),
    ("tool-number", "give the tool its number in a tool table (`--tools`)"),
    ("tool-range", "choose a tool within the range of the machine, or correct the tool's data"),
    (
        "tool-twice",
        "give each tool a number of its own in the toolpath, or the same data everywhere where it is one tool",
    ),
    (
        "transformation",
        "end one transformation before the next begins, and give it the words that the control takes",
    ),
    ("truncated", "write the file again from the CAM system: it may be cut off"),
    ("type", "give a value of the type that is needed here"),
    (
        "unknown-axis",
        "name the machine that the program was written for: its file says which axes there are",
    ),
    (
        "unknown-block",
        "check the spelling of the block, or read the program with the control that it was written for",
    ),
    ("unknown-m", "check the number, or describe the M function in the machine file"),
    (
        "unknown-position",
        "move to a known position first, with every axis named in absolute coordinates",
    ),
    ("unknown-program", "save the called program in the folder of the main program"),
    ("unknown-start", "give a rapid move with X, Y and Z before the first cut"),
    (
        "unknown-word",
        "check the spelling, or read the program with the control that it was written for",
    ),
    (
        "unreachable-orientation",
        "choose a machine whose axes reach this orientation, or set the part up differently",
    ),
    ("unreadable", "check the name of the file and the right to read it"),
    ("unsupported", "write this in another way; docs/controls and docs/sources list what is read"),
    ("upper-plane", "give the height of the upper plane in the machine file or the program"),
    ("variable", "define the variable before it is read"),
    ("wire-leans", "choose a control with U and V, or a contour without taper"),
    ("wire-missing", "thread the wire before the first cut"),
    ("wire-threaded", "cut the wire before it is threaded again"),
    (
        "word",
        "add the word or its code below [words] of the control's file; `toolpost explain` lists them",
    ),
    ("word-twice", "give each word once in a block"),
    ("work-offset", "use the work offset of the toolpath, one that the control has"),
    ("zero-vector", "give a direction with a length above 0"),
];

/// The way out of `rule`; empty where each of its findings has its own.
pub fn way_out(rule: &str) -> &'static str {
    match WAYS_OUT.binary_search_by_key(&rule, |(name, _)| name) {
        Ok(index) => WAYS_OUT[index].1,
        Err(_) => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_stands_once_in_the_order_of_the_names() {
        assert!(WAYS_OUT.is_sorted_by(|a, b| a.0 < b.0));
        assert!(WAYS_OUT.iter().all(|(_, text)| !text.is_empty()));
    }
}
