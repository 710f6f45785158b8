//! The rows of the catalogue, in the order of the names: name, former names, meaning, way out, example.

use super::{Entry, rules};

rules! {
    Acceleration "acceleration" []
        "A robot is to accelerate faster than the options of its machine file state."
        "write `a` as the options `acceleration` and `joint_acceleration` state it, or less"
        "`acc=1000` in a program of a UR5e whose options state 1.2 m/s2";
    AdaptiveFeed "adaptive-feed" []
        "An input of the machine multiplies the feed, so that F is not the speed of the cut."
        "write M52 P0, or leave it out"
        "linuxcnc: `M52 P1`";
    AfterEnd "after-end" ["nc-after-end", "after-the-end"]
        "A program, or a record of one, goes on behind its end."
        "move the end of the program behind its last block, or delete what follows it"
        "linuxcnc: `M2`, `G1 X10`";
    Alarm "alarm" ["nc-alarm", "program-error"]
        "The program reports an error or an alarm by itself."
        "the program stops itself here: set the variables so that it does not come here, or remove the alarm"
        "fanuc: `#3000=1(NO TOOL)`";
    Angle "angle" []
        "An angle is missing, out of range, or does not fit the move."
        "give the angle in degrees, within the range that the control takes"
        "`rotation = nan` of a group in a board file";
    Aperture "aperture" []
        "The definition of a Gerber aperture is wrong, or its values are."
        "correct the definition: a number from 10 on, a template, and the values that it takes"
        "`%ADD10C*%`: a circle without a diameter";
    ApertureAgain "aperture-again" []
        "A Gerber file defines an aperture twice."
        "use another number for the second aperture"
        "`%ADD10C,1*%` and later `%ADD10C,2*%`";
    Arc "arc" ["nc-arc"]
        "An arc cannot be: its end, its centre and its radius do not fit."
        "correct the end point, the centre or the radius of the arc"
        "fanuc: `G2 X100. Y0 R1.`";
    ArcCenter "arc-center" []
        "The centre of an arc does not fit its ends."
        "correct the centre or the ends of the arc"
        "A Gerber arc from X0 to X2 with I0.5";
    ArcChord "arc-chord" []
        "An arc turns by a whole circle or more and does not end where it began, or a long arc has nearly equal ends."
        "give the same point for a full circle"
        "`CIRCLE/0,0,0,0,0,1,10,TIMES,2` and a GOTO off the start";
    ArcDirection "arc-direction" []
        "The direction in which the tool leaves does not fit the circle."
        "give the direction in which the tool leaves, tangent to the circle"
        "`INDIRV/0,0,1` before a circle in XY";
    ArcLowered "arc-lowered" []
        "Arcs are written as lines, within the tolerance, because the control has no block for them."
        "nothing to do, if the tolerance suits the part; a control with the block `arc_cw` or `helix_cw` writes the arc itself"
        "A helix for a control without `helix_cw`";
    ArcOrientation "arc-orientation" []
        "The tool axis changes along an arc."
        "split the arc into lines, or give its end the tool axis of its start"
        "An arc whose end has another tool axis than its start, on a machine with rotary axes";
    ArcPoints "arc-points" []
        "The points of an arc do not say which arc it is."
        "let the CAM system write one point for an arc (Creo: NUMBER_OF_ARC_PTS 1)"
        "A Creo circle with two points between its ends that do not lie on it";
    ArcRadius "arc-radius" []
        "The radius of an arc does not reach from its start to its end."
        "correct the radius: the end point must be reachable with it"
        "sinumerik: `G2 X100 Y0 CR=1`";
    ArcStart "arc-start" []
        "An arc starts at a position that is not known."
        "give a rapid to the start before the arc"
        "A toolpath that begins with an arc";
    Argument "argument" []
        "An argument of a command is missing or not known, or it or one of a function of the Python package has a value that is not taken."
        "give one of the values that `--help`, or the documentation of the function, lists"
        "`toolpost.post(path, machine, tolerance=\"fine\")`";
    Arithmetic "arithmetic" ["nc-arithmetic"]
        "The value of an expression is not a finite number."
        "correct the formula or the values that it gets"
        "linuxcnc: `#1=[1/0]`";
    ArmBranch "arm-branch" []
        "A joint of an arm carries nothing that leads to the flange."
        "compare the reach of the new file with the data sheet: the joint is left out"
        "A joint for a hose, besides the six of the arm";
    ArmCalibration "arm-calibration" []
        "The calibration of an arm differs from the arm that it is for."
        "give the calibration of this very arm, and compare the difference that the message names"
        "A calibration of a UR10e given with a UR5e";
    ArmCoupling "arm-coupling" []
        "What the controller shows for joint 3 may count from joint 2, and the file that is imported does not say it."
        "look in the manual of the arm what joint 3 counts from, and write `coupling` into the new file"
        "An ABB arm with a parallel rod";
    ArmExtends "arm-extends" []
        "Which arm a calibration is for is missing, or given where it is not needed."
        "give the arm by `--extends`, for a calibration alone"
        "`machines import calibration.yaml` without `--extends`";
    ArmKind "arm-kind" []
        "The joints of a description are no arm that is known."
        "import an arm of six revolute joints whose wrist meets in a point, or that is offset as a UR is"
        "Seven revolute joints in a row";
    ArmKinematics "arm-kinematics" []
        "Of this arm the kinematics are known, but no program can be written or read for it yet."
        "name a machine that has a control"
        "`post` with `kuka-kr6-r900-sixx`, whose file states no control";
    ArmPath "arm-path" []
        "An arm cannot follow the toolpath: a point is out of reach, or no turn about the tool and no posture passes a cut within the limits and the speeds of the joints."
        "move the part, tilt the spindle on the flange, or take a lower feed"
        "A line to a point 10 m away from the robot";
    ArmReach "arm-reach" []
        "The reach of an arm is missing, is not that of its kinematics, or is given where it is not needed."
        "give the reach of the data sheet by `--reach`"
        "`--reach 850` for an arm whose links reach 900 mm";
    ArmSnapped "arm-snapped" []
        "Angles of a description that are nearly right angles are taken as right angles."
        "nothing to do; a calibration says how the arm really stands"
        "A joint turned by 1.5708 in place of half of pi";
    ArrayIndex "array-index" []
        "An index is outside the size of its array."
        "use an index within the declared size of the array"
        "`DEF REAL A[2]` and later `A[5]=1` (SINUMERIK)";
    ArrayShape "array-shape" []
        "An array of the Python package has the wrong shape."
        "give an array of the named shape"
        "Points of shape (10, 2) where X, Y and Z are needed";
    Aside "aside" []
        "The step aside of a boring cycle is missing, or stands in another cycle."
        "choose one of these cycles, or leave the way aside out"
        "`fine-bore` without a direction";
    Attribute "attribute" []
        "A Gerber attribute has no name."
        "write the name of the attribute, or leave it out"
        "`%TF*%`";
    Auxiliary "auxiliary" []
        "A function of the machine's builder is left out, or the machine does not know it."
        "list the number under `auxiliary` of the machine file, where the machine has the function"
        "M81 in the source, and no 81 in `auxiliary` of the machine file";
    Axes "axes" []
        "A drill file gives its axes other directions."
        "write X to the right and Y up (VER,1)"
        "`VER,2` in an Excellon header";
    AxisDynamics "axis-dynamics" []
        "Axes may be faster than their machine data allow."
        "write at most 100 percent, as in ACC[X]=100"
        "sinumerik: `ACC[X]=150`";
    AxisLimit "axis-limit" []
        "An axis would leave its travel."
        "move the part in the machine (`work_zero`), or choose a machine with more travel"
        "Z -310 on a machine with Z from -300 to 0";
    AxisSwing "axis-swing" []
        "Between the ends of a cut the rotary axes swing the tool axis off its path by more than is allowed."
        "make the steps of the tool axis smaller in the CAM system"
        "A cut in which C turns by 180° while the tool leans";
    BeamCut "beam-cut" []
        "Side faces of a block of glass cut off part of the beam of some points."
        "take the margin that the finding names, or a larger block"
        "A point 1 mm from a side, 79 mm deep, at f = 70 mm";
    Blank "blank" []
        "The corners of the blank are missing, or not in order."
        "give two corners, the second above the first in X, Y and Z, or leave both out"
        "`BLK FORM 0.2` without `BLK FORM 0.1`";
    BlindVia "blind-via" []
        "A board has a via that does not go through, which is not drilled."
        "let vias go through the board, or drill this one elsewhere"
        "A KiCad via from F.Cu to In1.Cu";
    Block "block" []
        "A Gerber block aperture has no number, or no end."
        "begin it with %ABD10*% (a number from 10 on), and end it with %AB*%"
        "`%ABD5*%`";
    BlockDelete "block-delete" []
        "A drill file has lines that may be skipped."
        "decide which holes are drilled, and write those alone"
        "`/X1Y1`";
    BlockLength "block-length" ["nc-long-block"]
        "A block is longer than the control takes."
        "divide the block into several"
        "A SINUMERIK block of 600 characters";
    BlockNumber "block-number" ["nc-block-number"]
        "A block number is out of range, or stands where none may stand."
        "give a block number that the control takes, or none"
        "linuxcnc: `G1 N5 X1`";
    BlockSkip "block-skip" []
        "Blocks are marked as skippable, and what the program does depends on the switch at the control."
        "give `--block-delete`, where the operator skips them, or take the marks out of the program"
        "`/G1 X10`";
    Board "board" []
        "A file of a board is not what is needed here."
        "give the files of one board"
        "Two .kicad_pcb files for one board";
    BoardEmpty "board-empty" []
        "There is nothing on the board that could be made."
        "check which files of the board were read, and as what"
        "A folder of Gerber files without copper, holes and outline";
    BoardFile "board-file" []
        "A board file (TOML or JSON) cannot be read."
        "correct the file at the mark; docs/sources/board.md lists what stands in it"
        "`[[pads]]` without `node`";
    BoardTooLarge "board-too-large" []
        "A board is too large to be worked on in one piece."
        "take a part of the board, or a wider tool"
        "A board of 10 m with conductors of 0.1 mm";
    Branch "branch" []
        "More than two lines of a drawing meet in one point."
        "choose layers by `--layer` so that a contour has no branches, or delete what is too much"
        "A T of three lines on the layer of the contour";
    ByControl "by-control" []
        "The control cannot offset the wire: it has no offset, or the contour is open."
        "leave `--by-control` out: the path of the wire's centre is then calculated here"
        "`--by-control` on a machine without wire offset";
    Calibration "calibration" []
        "A calibration cannot be read."
        "take the file as the driver of Universal Robots saves it: six links, each with x, y, z, roll, pitch and yaw"
        "A file with the rows of five links";
    Call "call" ["nc-call"]
        "A program is called by a wrong number, name or parameter."
        "correct the number, the name or the parameters of the call; called programs are looked for in the folder of `--folder`, and nowhere else"
        "fanuc: `M98`";
    CalledProgram "called-program" ["unknown-program"]
        "A called program cannot be found or used."
        "save the called program, in the control's own format, in the folder that `--folder` names"
        "klartext: `CALL PGM MISSING.H`";
    Cancelled "cancelled" []
        "The work was cancelled. There is no result."
        "start it again"
        "Ctrl-C while a program is proven";
    CarriedOtherwise "carried-otherwise" []
        "An imported post differs here from the new machine file."
        "compare this with the manual of the machine, and correct the new file where they differ"
        "A post whose safe height is written in inches";
    ChainTooLong "chain-too-long" []
        "A slot takes more holes than are drilled."
        "have slots milled (`--hole-mill`), or divide the slot"
        "A slot of 3 m with a drill of 0.8 mm";
    CircleWithoutGoto "circle-without-goto" []
        "A CIRCLE statement has no GOTO that ends it."
        "add the GOTO that ends the arc"
        "`CIRCLE/0,0,0,0,0,1,10` and then `FINI`";
    Clamp "clamp" []
        "A rotary axis turns while its clamp is closed, or a clamp of the source is left out."
        "check that `unclamp` and `clamp` in the machine file are those of this machine"
        "A turn of A with M10 active, where M11 opens the clamp";
    ClearPlane "clear-plane" []
        "A cycle names its clear plane twice."
        "leave CLEAR or RAPTO out"
        "`CYCLE/DRILL,...,CLEAR,2,RAPTO,3`";
    Comment "comment" ["nc-comment"]
        "A comment is not closed, or stands within another."
        "close the comment in its own line; comments cannot be nested"
        "linuxcnc: `(no end`";
    CommentSigns "comment-signs" []
        "A sign in `comment_signs` of the machine file may end a comment or be a command in it."
        "leave the sign out; letters, digits and blanks harm no control"
        "`comment_signs = \")\"`";
    CompensatedPath "compensated-path" []
        "The points of the toolpath are the centre of the tool where the machine wants the contour, or the other way round, or it is not known which."
        "give what the points of the toolpath are by `--cutcom` (`centre` or `contour`), and what the tool table keeps by `tool_radius` of the machine file"
        "`CUTCOM/LEFT` in a file whose points may be either";
    Compensation "compensation" ["nc-compensation"]
        "Cutter compensation is switched where the control does not take it."
        "switch the compensation in a straight move in the plane, with a tool radius set"
        "fanuc: `G41 D1 G2 X10. Y0 R5.`";
    CompensationActive "compensation-active" []
        "A record needs cutter compensation off, and it is on."
        "switch the compensation off (CUTCOM/OFF) before it"
        "A tool change between `CUTCOM/LEFT` and `CUTCOM/OFF`";
    CompensationArc "compensation-arc" []
        "An arc under compensation has no radius, or starts where the tool is not known to be."
        "give the arc a radius above 0, and a move to its start before it"
        "An arc of radius 0 under G41";
    CompensationArcRadius "compensation-arc-radius" []
        "An inside arc is smaller than the radius of the tool."
        "use a smaller tool"
        "An inside arc of R 3 with a tool of R 5 under G41";
    CompensationChange "compensation-change" []
        "Side or radius of the compensation change while it is on."
        "switch the compensation off with a straight move first"
        "`G42` behind `G41` without `G40`";
    CompensationEntry "compensation-entry" []
        "The move that switches compensation on cannot do so."
        "approach the contour by a straight move that is longer than the tool radius"
        "An approach that is shorter than the radius of the tool";
    CompensationExit "compensation-exit" []
        "The move that switches compensation off cannot do so."
        "switch it off in a straight move in the plane"
        "`G40` with an arc behind it";
    CompensationFeed "compensation-feed" []
        "Compensation is on with the feed as inverse time."
        "use G94 while compensation is on: corners add moves whose time is not known"
        "`G93` behind `G41`";
    CompensationGouge "compensation-gouge" []
        "The way to or from a compensated contour cuts into it."
        "begin and end on the tool's side of the contour, beyond its ends"
        "An approach from the other side of the contour";
    CompensationInnerCorner "compensation-inner-corner" []
        "An inside corner is too narrow for the tool."
        "use a smaller tool, or leave out what is shorter than it"
        "A slot of 8 mm with a tool of 10 mm";
    CompensationLookAhead "compensation-look-ahead" []
        "Too many blocks without movement stand within a compensated contour."
        "put fewer blocks without movement between two moves of the compensated contour"
        "Three dwells between two cuts under G41";
    CompensationOn "compensation-on" []
        "This block needs cutter compensation off."
        "switch the compensation off (G40) before this block"
        "`M6` under G41";
    CompensationOpen "compensation-open" []
        "Where the control leads the tool's centre along a contour is not compared: the tool's radius, or how the control joins the contour, is not known. The contour itself is compared."
        "give the diameter of the tool: `CUTTER` or `TLDATA` in cutter-location data, a tool table (`--tools`) with an NC program; else try the contour on the machine"
        "A contour with `G41` and no tool table";
    CompensationOrientation "compensation-orientation" []
        "A rotary axis moves while compensation is on."
        "switch the compensation off before a rotary axis moves"
        "`G1 A10` under G41";
    CompensationPending "compensation-pending" []
        "Compensation is switched, and no straight cut follows."
        "let a straight cut follow the switch of the compensation"
        "`CUTCOM/LEFT` at the end of the file";
    CompensationPlane "compensation-plane" []
        "Compensation is on outside of the plane in which it was switched on."
        "select the plane before the compensation is switched on"
        "`G18` under G41";
    CompensationRadius "compensation-radius" []
        "Compensation is switched on, and the radius of the tool is not known."
        "give the radius of the tool by the program or, with an NC program as the source, in its tool table (`--tools`)"
        "`G41 D5` and no tool 5 in the tool table";
    CompensationUnknownPosition "compensation-unknown-position" []
        "Compensation is on at a position that is not known."
        "give a block with X, Y and Z before compensation is switched on, or `--start` with the place where the tool stands"
        "`G41` behind `G28`";
    CompensationUnsupported "compensation-unsupported" []
        "This form of compensation cannot be resolved into a path."
        "leave the tool out of the table of `--tools`: compensation then stays a state, as the program has it"
        "`KONT` with a tool table";
    ConductorSevered "conductor-severed" []
        "A cut down the middle of a narrow gap leaves a conductor in pieces."
        "use a narrower tool, or leave narrow gaps out (`--narrow leave-out`)"
        "A track of 0.1 mm, a cut of 0.2 mm and `--narrow middle`";
    Contour "contour" []
        "A contour cannot be approached, left or followed as the block says."
        "correct the approach or the departure: it needs a known start, a tangent, and a length or radius that fits"
        "klartext: `RND`";
    ControlStructure "control-structure" []
        "IF, FOR, WHILE or another structure has no end, or ends in the wrong order."
        "close each structure in its own order: IF with ENDIF, FOR with ENDFOR, WHILE with ENDWHILE, REPEAT with UNTIL, LOOP with ENDLOOP"
        "sinumerik: `ENDIF`";
    Coolant "coolant" ["nc-coolant"]
        "Coolant is switched in a way that the control does not take, or not as the source has it."
        "give one M function of coolant a block, and one that the control knows"
        "The source switches flood on, and the program does not";
    Coordinate "coordinate" []
        "A coordinate of a body or a point is no number, is missing, or is beyond what can be engraved."
        "export the body again, in mm"
        "A vertex of a PLY file without z";
    CopperOutside "copper-outside" []
        "Copper lies outside the outline of the board, and is left out there."
        "check whether the outline is the right one: the board ends there"
        "A pad on the edge of the board";
    Corner "corner" ["nc-corner"]
        "A chamfer or rounding of a corner does not fit the moves around it."
        "put the corner between two moves in the plane, each longer than it takes away"
        "fanuc: `G1 X10. ,R20.`, `G1 Y10.`";
    CornerRounded "corner-rounded" []
        "An inside corner becomes as round as the wire, as `--round-corners` lets it."
        "a thinner wire leaves less"
        "A sharp inside corner with `--wire 0.25 --round-corners`";
    Curve "curve" []
        "A Bézier curve of a KiCad board has not four points."
        "draw it again in KiCad"
        "`(gr_curve (pts (xy 0 0) (xy 1 1)))`";
    CurveFit "curve-fit" []
        "Arcs do not follow a curve of a drawing within the tolerance."
        "draw the curve again, as lines and arcs or in pieces"
        "An ellipse of 10 m with a tolerance of 0.000001 mm";
    CutTooWide "cut-too-wide" []
        "A cut is wider than the board can be worked with."
        "use a narrower tool"
        "A tool of 100 mm for isolation";
    CutoutTooSmall "cutout-too-small" []
        "A cutout of the board is too small for the tool."
        "use a smaller `--outline-tool`, or draw the cutout larger"
        "A slot of 1 mm with a tool of 2 mm";
    CutsPart "cuts-part" []
        "The way of the wire to its contour cuts into the part."
        "thread elsewhere (`--thread`), start elsewhere (`--begin`), or use a shorter lead-in (`--lead`)"
        "A place to thread on the wrong side of the contour";
    Cutter "cutter" []
        "The tool for the outline or for holes is no end mill."
        "use an end mill"
        "A V-bit in place of the mill for the outline";
    Cycle "cycle" ["nc-cycle"]
        "A canned cycle lacks a word, or stands where the control does not take it."
        "define the cycle before it is called, and call it where nothing forbids it (compensation off, plane selected)"
        "fanuc: `G81 Z-10. F100.`";
    CycleBore "cycle-bore" []
        "The control has no cycle for this bore, and it cannot be made of moves."
        "use a control that has the cycle, or another kind of bore"
        "`CYCLE/BORE` that stops the spindle and goes aside";
    CycleDepth "cycle-depth" []
        "The depth of a cycle is missing, said twice, or not below the reference plane."
        "give one depth, below the reference plane"
        "sinumerik: `CYCLE81(10,0,2,5)`";
    CycleExpanded "cycle-expanded" []
        "A cycle is written as moves: the control has no block for it, or what its words count is not stated."
        "nothing to do where the control has no such cycle; on a FANUC, which has it, state what P of a dwell counts (`dwell_p_milliseconds` in [settings])"
        "A boring cycle for GRBL";
    CycleOn "cycle-on" []
        "A hole cycle is still on where the tool changes."
        "add CYCLE/OFF behind the last hole"
        "A second `LOAD/TOOL` without `CYCLE/OFF` behind the last hole";
    CycleParameter "cycle-parameter" []
        "A parameter of a cycle is out of range."
        "correct the parameter; the maker's manual names the range and the order of the parameters"
        "klartext: `CYCL DEF 200 DRILLING Q200=-5`";
    CyclePeck "cycle-peck" []
        "The pecks of a cycle have no end."
        "give a peck above 0, and less than the depth"
        "A peck of 0 mm";
    CycleTap "cycle-tap" []
        "A thread cannot be tapped: the control has no tapping cycle, or the spindle turns against the thread."
        "tap by hand, mill the thread or take a machine whose control has a tapping cycle; turn the spindle as the hand of the thread needs"
        "`CYCLE/TAP` for GRBL";
    Data "data" ["nc-data"]
        "Data of the control are written in a form that is not read."
        "write offsets and tool data by the forms that docs/controls names, or set them at the control"
        "fanuc: `G10 L99 P1 X0`";
    DataWord "data-word" ["word"]
        "A word of a Gerber, drill or STL file is not known, or its number is malformed."
        "write the file again, or correct the word; docs/sources lists what is read"
        "`X1#` in a drill file";
    DecimalPoint "decimal-point" ["nc-decimal-point"]
        "A number has no decimal point, and how the control counts it is not known."
        "write the decimal point, or say what numbers without it count: `--whole-numbers units` or `--whole-numbers increments`"
        "fanuc: `G1 X10` for a machine without `whole_numbers`";
    DeepCut "deep-cut" []
        "A cut that is meant for copper, mask or legend goes deep into the board, or through it."
        "give the depth of the layer and a little more, such as 0.1, or the thickness of the board"
        "`--depth 2` on a board of 1.6 mm";
    Definition "definition" []
        "The definition of a variable is wrong, or stands too late."
        "correct the definition: type, name and size, before the first block that uses it"
        "sinumerik: `R1=1`, `DEF REAL A`";
    Deprecated "deprecated" []
        "A Gerber file uses a command that the specification has withdrawn."
        "nothing to do; newer CAD programs write it otherwise"
        "`G54D10*`";
    Diameter "diameter" []
        "The diameter of a tool is not above 0, is beyond what a tool can have, or is given twice."
        "give the diameter of the tool, mm"
        "`T1C0` in a drill file";
    DiameterMode "diameter-mode" []
        "X counts as a diameter, as on a lathe: the machine goes to half of it."
        "leave the word out, and write X as the place where the axis goes"
        "linuxcnc: `G7`";
    DocumentSize "document-size" []
        "A FreeCAD document is larger than is read."
        "save the job alone, or post from within FreeCAD"
        "A .FCStd with an entry of 10 GB";
    DoesNotFit "does-not-fit" []
        "A body does not fit into its block within the margins."
        "scale it, fit it, or move it"
        "A body of 60 mm in a block of 20 mm";
    Drawing "drawing" []
        "A picture cannot be made."
        "save the picture as SVG, or make it smaller"
        "`--output part.bmp`";
    Drill "drill" []
        "A drill of a KiCad pad or via has no size."
        "drills have a diameter above 0: correct it in KiCad"
        "`(drill 0)`";
    DrillDiffers "drill-differs" []
        "No drill has the diameter of this hole; the nearest is used."
        "nothing to do, if the difference does not matter; else add the drill to `--drills`, or allow less by `--drill-tolerance`"
        "A hole of 0.85 mm with drills of 0.8 and 1.0 mm";
    Dwell "dwell" ["nc-dwell"]
        "A dwell is missing, negative, or stands where none may stand, or it is not that of the source."
        "give one time, in seconds or turns, not below 0, in a block of its own"
        "fanuc: `G4`";
    DwellUnit "dwell-unit" []
        "What the dwell counts in depends on a setting that is not known."
        "write G4 X with a decimal point (FANUC), or state `dwell_p_milliseconds` in [settings] of the machine file"
        "fanuc: `G4 P500`";
    DxfBinary "dxf-binary" []
        "The drawing is a binary DXF file."
        "save the drawing as ASCII DXF"
        "A file that begins with `AutoCAD Binary DXF`";
    DxfCode "dxf-code" []
        "A DXF file is damaged or cut off."
        "save the drawing again as ASCII DXF; the file is damaged or cut off"
        "A line of text where a group code must stand";
    DxfDoubled "dxf-doubled" []
        "A drawing holds entities twice, of which one is read."
        "nothing to do; delete the doubled entities in the drawing to be rid of this"
        "Two equal lines over each other";
    DxfEntity "dxf-entity" []
        "An entity of a drawing lacks a value, or has one that cannot be."
        "draw it again, or save the drawing again"
        "A CIRCLE of radius 0";
    DxfGap "dxf-gap" []
        "Gaps of the contour were closed."
        "nothing to do, where the ends belong together; `--close` says how large a gap is closed"
        "Two lines whose ends are 0.0005 mm apart";
    DxfInsert "dxf-insert" []
        "A block of a drawing cannot be inserted as it stands."
        "explode the block in the CAD program"
        "An INSERT of a block that is not there";
    DxfLayer "dxf-layer" []
        "There is no contour on this layer."
        "name a layer by `--layer` that holds lines or arcs"
        "`--layer CONTOUR` for a drawing whose lines are on layer 0";
    DxfLeftOut "dxf-left-out" []
        "Entities of these kinds are not read."
        "nothing to do, if they are no part of the contour; else draw it with lines, arcs and polylines"
        "TEXT and DIMENSION in a drawing";
    DxfNumber "dxf-number" []
        "A number of a DXF file is none."
        "save the drawing again"
        "`abc` behind group code 10";
    DxfOptions "dxf-options" []
        "A setting for reading drawings is out of range."
        "give a value in the range that is named"
        "A gap of 100 mm";
    DxfSize "dxf-size" []
        "A drawing has too many entities."
        "choose layers by `--layer`, or divide the drawing"
        "A drawing of 10 million lines";
    DxfSlanted "dxf-slanted" []
        "An entity does not lie in the plane of the drawing."
        "draw the contour in one plane"
        "A LINE from Z 0 to Z 5";
    DxfSpline "dxf-spline" []
        "A spline of a drawing cannot be read."
        "save it with control points"
        "A SPLINE with fit points alone";
    DxfUnit "dxf-unit" []
        "The unit of a drawing is not known."
        "set the unit of the drawing ($INSUNITS) in the CAD program"
        "A drawing without $INSUNITS";
    DynamicOffset "dynamic-offset" []
        "The work zero that turns with the table goes on or off where the control does not take it, or something happens under it that is not followed."
        "turn first, then write G254 in a block of its own, then X and Y, then Z; write G255 before the next turn, work offset or shift"
        "haas: `G254` and then `B30.`";
    Empty "empty" []
        "A file has no triangle and no point."
        "give a body or points"
        "An STL file of `solid x` and `endsolid x`";
    EmptyContour "empty-contour" []
        "There is no contour, or it has no length."
        "choose the layer by `--layer`, or draw a closed contour"
        "A drawing of texts alone";
    Encoding "encoding" []
        "The file is not plain text."
        "save the file as UTF-8"
        "A file in UTF-16";
    EndHeight "end-height" []
        "The program ends where the tool is not home."
        "send Z home before the end of the program"
        "`M30` behind the last cut, with Z at the part";
    EndPoint "end-point" []
        "The program leaves its path at a point that the source does not have."
        "report this with the toolpath: the program differs from it"
        "The source goes from X0 to X10, the program stops at X5";
    Endless "endless" ["nc-endless"]
        "A loop or a chain of calls has no end."
        "correct the condition that ends the loop; the control follows a limited number of blocks"
        "sinumerik: `WHILE TRUE`, `R1=1`, `ENDWHILE`";
    EndsInCut "ends-in-cut" []
        "The program ends, or stops for good, while the tool is in a cut."
        "retract the tool before the end of the program"
        "`M30` behind `G1 Z-5`";
    Excursion "excursion" []
        "The tool leaves a cut and comes back, but not along its axis."
        "report this with the toolpath: the program differs from it"
        "A retract along Z with a tool that leans";
    Expression "expression" ["nc-expression", "formula"]
        "An expression is not written as the control takes it."
        "correct the expression at the mark"
        "linuxcnc: `#1=[1+]`";
    ExtraMotion "extra-motion" []
        "The program makes a move that the source does not have."
        "report this with the toolpath: the program differs from it"
        "A rapid to X100 and back between two cuts";
    ExtraToolChange "extra-tool-change" []
        "The program changes the tool where the source does not."
        "report this with the toolpath: the program differs from it"
        "Two `M6` for one `LOAD/TOOL`";
    Face "face" []
        "A face names a vertex that is not there, has fewer than three corners, or is not convex."
        "export the body again"
        "OBJ: `f 1 2 9` after three vertices";
    Facet "facet" []
        "A facet of an STL file does not have three vertices."
        "export the body again"
        "An STL facet with two vertices";
    Feed "feed" ["nc-feed"]
        "The feed is missing, not above 0, or not that of the source."
        "give a feed above 0 before the first cut, in a mode that the control knows"
        "fanuc: `G1 X10 F-5`";
    FeedApproach "feed-approach" []
        "The tool goes to its first point by feed."
        "check where the tool is before it, or add a rapid to the start in the CAM system"
        "A toolpath whose first record is a cut";
    FeedGroup "feed-group" []
        "The feed counts axes that FGROUP does not name, or names that the machine lacks."
        "add the axes to the feed group (FGROUP), or give the feed of this move in inverse time (G93)"
        "sinumerik: `FGROUP(Q)`";
    FeedInverseTime "feed-inverse-time" []
        "Feeds are written as inverse time."
        "nothing to do; the block takes the same time as the feed of the toolpath"
        "A five-axis cut on a control that counts F otherwise";
    FeedLimited "feed-limited" []
        "Cuts are slower than the feed of the toolpath, because an axis is at its limit."
        "nothing to do, if the slower cut suits the part; the limits are those of the axes in the machine file"
        "A cut near the pole of a table";
    FeedPerTurn "feed-per-turn" []
        "Feeds per turn are written in mm/min."
        "nothing to do; the feed was multiplied by the spindle speed"
        "`FEDRAT/0.1,MMPR` for a control without G95";
    FeedRange "feed-range" []
        "A feed is outside the range of the machine."
        "give a feed within the range of the machine, or correct its file"
        "F 20000 on a machine with 10000 mm/min at most";
    FeedZero "feed-zero" []
        "A feed is written as 0 with the decimals of the word F."
        "give a feed above 0 that the decimals of the word F can hold"
        "0.2 mm/min on a control that writes whole numbers";
    FileBorder "file-border" []
        "A program of several files goes on in another one while the tool is in a cut: the arm stops there and leaves a mark."
        "divide the program where a rapid has taken the tool off the part, as `toolpost post` does"
        "ls: `CALL JOB_2` between two lines of a contour";
    FileOlder "file-older" []
        "Programs of an earlier call are still in the folder, and this call does not write them anew."
        "remove them, or write all programs in one call"
        "`front.nc` of an earlier run next to the new `drill.nc`";
    FileSize "file-size" []
        "The file is larger than is read."
        "divide the file"
        "A KiCad board of 5 GiB";
    FileUnused "file-unused" []
        "A file of the folder was not used."
        "name the file as the layer that it holds, if it should be cut (see `toolpost pcb --help`)"
        "A text file among the Gerber files";
    Fill "fill" []
        "A shape of a KiCad board says in an unknown way whether it is filled."
        "write yes or no"
        "`(fill maybe)`";
    FitWithoutMemory "fit-without-memory" []
        "Points are to fit the memory of the control, and how many it holds is not given."
        "give `--memory`, or `memory` in [wire] of the machine file; or a `--step` or `--chord-error` in place of `--fit`"
        "`--fit` without `--memory`";
    FlatContour "flat-contour" []
        "The contour has no heights: it is taken as flat."
        "nothing to do, if the contour is flat; else give Z in its first block"
        "A wire program without Z";
    FloatingTap "floating-tap" []
        "Taps are not coupled to the feed, so that they need a floating holder."
        "tap by G33.1 (LinuxCNC) or behind M29 (FANUC), or state `floating_holder = true` in [settings] of the machine file"
        "linuxcnc: `G98 G84 Z-10 R2 F1000`";
    Folder "folder" []
        "A folder cannot be read."
        "check the name of the folder and the right to read it"
        "`toolpost pcb no-such-folder`";
    FolderReach "folder-reach" []
        "A path leads out of the folder that the studio was started in."
        "copy the file into that folder, or start `toolpost studio` in a folder that holds both"
        "`../part.cls`, or a link to a file elsewhere";
    Form "form" []
        "A file has no form of bodies, pictures or points that is read, or a body is made of more than triangles."
        "give .stl, .obj, .ply or .3mf with triangles, a .png, .jpg or .bmp, or a list of points"
        "`roof.step`";
    Format "format" []
        "A drill file has numbers that its format does not take."
        "write the format of the numbers, such as METRIC,LZ,000.000"
        "`X1234567` with the format 2.4";
    Frame "frame" ["nc-frame"]
        "A shift, turn, scale or mirror is incomplete, or stands where the control does not take it."
        "correct the frame: one instruction a block, with axes and values that the control takes"
        "sinumerik: `ROT RPL=45 X10`";
    Freecad "freecad" []
        "There is no FreeCAD to open a document with, or it gives no job."
        "install FreeCAD, or post from its window with the post `toolpost`"
        "A .FCStd without a job";
    FreecadDump "freecad-dump" []
        "A FreeCAD document could not be read whole."
        "read the document again; where it fails again, report it with the document"
        "An operation without its commands";
    FreecadInvalid "freecad-invalid" []
        "Operations of the job are not valid in FreeCAD."
        "calculate the job again in FreeCAD"
        "An operation that is marked as touched or failed";
    FreecadJob "freecad-job" []
        "This is no job of FreeCAD, or of another version."
        "post from FreeCAD, or let FreeCAD write the job again"
        "A JSON file of something else";
    FreecadLines "freecad-lines" []
        "The commands of an operation do not stand on a line each."
        "make the operation anew: no name of a command may have a line break"
        "A command whose name has a line break";
    From "from" []
        "A FROM statement is the first position, and how the tool came there is not known."
        "check that the way there is free"
        "`FROM/0,0,100`";
    Gap "gap" []
        "The ends of a contour are apart."
        "close the gap in the source; of a drawing, `--close` allows a larger one"
        "A profile that ends 0.5 mm from its start";
    Gear "gear" []
        "The program chooses a gear of the spindle."
        "leave it out or write M40; a machine with gears lists the number in `auxiliary`"
        "sinumerik: `M41`";
    GlassBlock "glass-block" ["block"]
        "A block of glass is higher than the lens can engrave, its margins leave nothing of it, or the program is for another block."
        "take a lens of a longer focal length (`--lens`), or a smaller `--margin`"
        "A block of 20 mm with `--margin 10`";
    GlassProgram "glass-program" ["program"]
        "A line of a glass program is none that the machine takes, or the program is cut off."
        "write the program again; docs/sources/glass.md says what stands in it"
        "`N2 PULS X1 Y1 Z1`";
    Group "group" []
        "A group of a board file has no place of its own, or a name that another has."
        "give each group another name, and put none within itself"
        "Two groups called `sensor` in one group";
    Head "head" []
        "The head of a PLY file is wrong."
        "export the body again"
        "A PLY file that does not begin with `ply`";
    Header "header" []
        "The header of a program or drill file is wrong."
        "begin the program with %_N_NAME_MPF, or without a header"
        "sinumerik: `%_N_PART_XYZ`";
    HeightMap "height-map" []
        "A file of measured heights cannot be used."
        "give a file with X, Y and Z in columns, on a grid of 2 columns and 2 rows or more"
        "A height map with one row";
    Heights "heights" []
        "Measured heights are of one side of the board, and programs of both sides would be written."
        "make the programs of each side with its own heights: name them with `--only`"
        "`--heights` of the front, and programs of front and back";
    HelixEndPoint "helix-end-point" []
        "An arc that moves a third axis lacks an end point in its plane."
        "give both coordinates of the end point, also one that does not change"
        "sinumerik: `G2 X10 Z-5 CR=10`";
    Hole "hole" []
        "A hole of the program is not that of the source."
        "report this with the toolpath: the program differs from it"
        "A cycle at X 20.1 where the source has X 20";
    HoleForm "hole-form" []
        "A layer of holes has something else on it."
        "draw holes by flashes of round apertures, or slots by lines"
        "A filled region on a Gerber layer of holes";
    HoleOutside "hole-outside" []
        "A hole lies outside the outline of the board."
        "correct the outline or the hole in the CAD program"
        "A hole 1 mm outside the edge";
    HoleTwice "hole-twice" []
        "A hole is in the files twice, and is drilled once."
        "nothing to do, if one hole is meant"
        "The same hole in two drill files";
    HolesNotThrough "holes-not-through" []
        "Holes that do not go through the board are not drilled."
        "drill them elsewhere, or let them go through"
        "A drill file for layers 1 to 2";
    Home "home" ["nc-home"]
        "Axes are sent home in a way that the control or the machine does not take."
        "retract the tool first; then name the axes that go home, in a block that the control takes"
        "fanuc: `G28`";
    HomeHeight "home-height" []
        "The way from home to the first point may meet the part."
        "send Z home at the start, or set `safe_height` of the machine; for a robot begin and end the toolpath with a rapid above the part"
        "Z not at its upper end when the first rapid begins";
    Hpgl "hpgl" []
        "A command of an HP-GL file is none that is read, or lacks numbers."
        "write the file in plain HP-GL: absolute units of 0.025 mm, without SC and PE"
        "`SC0,100,0,100;`";
    IgnoredWord "ignored-word" []
        "A word of the source is not used."
        "nothing to do, if the part does not need it"
        "`CYCLE/DRILL,...,RAPOUT,5`";
    Image "image" []
        "A picture cannot be read."
        "save it again as PNG, JPEG or BMP"
        "A photograph that ends within its pixels";
    ImageTransformation "image-transformation" []
        "A Gerber file moves, turns or inverts the image as a whole."
        "write the file again without it"
        "`%SFA2B2*%`";
    Import "import" []
        "A post of another system cannot be imported."
        "begin with a machine of the library instead: `toolpost machines new NAME --from OTHER`"
        "A file without a block of a program";
    ImportControl "import-control" []
        "A file that is imported does not say for which control it is, or names one that is not there."
        "name the control by `--extends`"
        "Templates that name no control";
    Index "index" []
        "An index of refraction is below 1 or above 4."
        "correct the index in the table of materials"
        "`index = 0.9`";
    InnerCorner "inner-corner" []
        "An inside corner is sharper than the wire can cut."
        "round the corner by the offset of the wire or more, or let it become as round as the wire by `--round-corners`"
        "An inside corner of R 0.05 with a wire of 0.25 mm";
    InnerLayer "inner-layer" []
        "Copper of an inner layer is left out."
        "nothing to do: front and back are milled"
        "A track on In1.Cu of a KiCad board";
    Input "input" ["nc-input"]
        "An input is waited for in a way that the control does not take, or not as the source has it."
        "give the number of the input and how to wait for it"
        "linuxcnc: `M66`";
    Insert "insert" []
        "INSERT text is passed on as a comment or a stop, not as code."
        "use the statements of cutter-location data for what the machine is to do"
        "`INSERT/M98 P100`";
    Internal "internal" []
        "The program met a state that should not be."
        "report it, with the input if possible"
        "A fault of Toolpost itself";
    Item "item" []
        "An item of a KiCad board is not read."
        "remove it from copper and edge"
        "A dimension on F.Cu";
    Jump "jump" []
        "A jump has no target, or more than one."
        "correct the target of the jump: a label or block number of this program"
        "sinumerik: `GOTOF NOWHERE`";
    Kinematics "kinematics" ["nc-kinematics"]
        "The kinematics of the control are switched where it does not take that, or a block does not fit them."
        "switch the kinematics at a place where no cycle, compensation or other transformation is active"
        "linuxcnc: `M428` under `G41`";
    Label "label" []
        "A label is not there, stands twice, or cannot be called."
        "give each label once, and call only labels that are there; a subprogram ends with its own end block"
        "klartext: `CALL LBL 5`";
    Layer "layer" []
        "A layer of a board cannot be used."
        "correct the layer in the CAD program"
        "Copper whose contours cross themselves";
    LayerByName "layer-by-name" []
        "What a file holds was concluded from its name."
        "nothing to do, if it is right"
        "`board-F_Cu.gbr` without attributes";
    LayerEmpty "layer-empty" []
        "A file of a board holds nothing."
        "nothing to do, if nothing is meant to be there"
        "A solder mask without openings";
    LayerNegative "layer-negative" []
        "A layer of copper is drawn as a negative."
        "plot copper as a positive"
        "`%TF.FilePolarity,Negative*%`";
    LayerTwice "layer-twice" []
        "Two files are the same layer of the board."
        "give the files of one board"
        "`front.gbr` and `F_Cu.gbr` in one folder";
    LayerUnknown "layer-unknown" []
        "What a file holds is not known."
        "name the file as the layer that it holds"
        "`layer1.gbr` without attributes";
    LayersApart "layers-apart" []
        "A layer lies outside the board as a whole."
        "plot all layers with the same origin"
        "Copper plotted from another origin";
    LayersShifted "layers-shifted" []
        "More than half of a layer lies outside the outline."
        "plot all layers with the same origin"
        "Copper 3 mm outside the edge";
    Lead "lead" []
        "A lead-in or lead-out has no length, or an arc, that can be."
        "give `--lead` from 0 mm on, and `--lead-arc` above 0 mm and no more than the lead"
        "A lead-in of -1 mm";
    LeaningRetract "leaning-retract" []
        "The tool goes back along its axis, and Z may not be home behind it."
        "send Z home in machine coordinates behind it"
        "`L M140 MB MAX` with a head that leans (HEIDENHAIN)";
    LeftOn "left-on" []
        "The program ends and leaves a state on that the next program takes as off."
        "switch it off before the end of the program"
        "`M30` with a shift by G92 active";
    Length "length" []
        "A length is not above 0, or beyond what can be."
        "give a length above 0, mm"
        "A tool of -1 mm";
    LengthChange "length-change" []
        "The tool length changes, or counts again behind G28, in a block that does not say where Z goes."
        "give Z in the block of G43 or G43.4 (`G43 Z50. H1`); send Z home before G49"
        "fanuc: `G43 H5`";
    LengthOffset "length-offset" ["nc-length"]
        "The length offset is missing, wrong, or not that of the tool in the spindle."
        "activate the length offset of the tool that is in the spindle"
        "fanuc: `G43 Z50` without H";
    LengthPlane "length-plane" []
        "The tool length is used in G18 or G19, and along which axis it counts is a setting."
        "write G17, or state `length_along_z = true` in [settings] of the machine file"
        "fanuc: `G18`, `G43 H1 Z60.`";
    Lens "lens" []
        "The machine has no lens of that focal length."
        "take one of the lenses that the finding names"
        "f = 50 mm on a machine with f = 43 and 70 mm";
    Levelling "levelling" []
        "A program cannot be levelled."
        "choose settings that the message names"
        "A program with arcs in XZ";
    LevellingTolerance "levelling-tolerance" []
        "Heights are to be followed more closely than can be."
        "give a larger tolerance"
        "A tolerance of 0 mm";
    LineEnd "line-end" []
        "The program ends without a line end behind its last block."
        "end the last line of the file by a line feed"
        "sinumerik: a file that ends with `M30` and no line feed";
    LineLength "line-length" []
        "A block is longer than the control takes."
        "shorten the text in the source, or the block in the control's file"
        "A comment of 300 characters on a control with 80";
    LineStyle "line-style" []
        "A dashed line of a KiCad board is read as a whole line."
        "nothing to do, if whole lines are meant"
        "`(stroke (width 0.1) (type dash))`";
    LineTooLong "line-too-long" []
        "A statement is longer than is read."
        "give cutter-location data in text form"
        "A binary file given as cutter-location data";
    Linearisation "linearisation" []
        "A move would need too many lines to stay within the tolerance."
        "allow a larger tolerance, or split the move in the source"
        "A move of 10 m with a turn of 180° and 0.000001 mm";
    Linearised "linearised" []
        "Moves with turning axes are split, within the tolerance."
        "nothing to do, if the tolerance suits the part; `--tolerance` sets it"
        "A five-axis move of 50 mm by 20°";
    LinesOnly "lines-only" []
        "The lines of the copper are cut along their middle; nothing else of it is."
        "nothing to do for a drawing; to isolate nets leave out `--isolate lines`"
        "`--isolate lines` for the copper of a board";
    List "list" []
        "A list of a PLY file has a length that cannot be."
        "export the body again"
        "A face of -1 corners";
    ListClosed "list-closed" []
        "A list of a KiCad file ends that was not begun."
        "the file is damaged: save it again in KiCad"
        "One `)` too many";
    ListDepth "list-depth" []
        "Lists of a KiCad file lie too deep within each other."
        "the file is damaged: save it again in KiCad"
        "10,000 opening brackets";
    ListOpen "list-open" []
        "A list of a KiCad file has no end."
        "the file is damaged: save it again in KiCad"
        "A file that is cut off";
    Load "load" []
        "The polarity, mirror, turn or scale of Gerber objects is wrong."
        "write %LPD*% or %LPC*%, and numbers that can be"
        "`%LPX*%`";
    LookAhead "look-ahead" ["nc-look-ahead"]
        "Look-ahead of the control is on where not every control takes that."
        "write G5.1 Q0 (G5 P0) in a block of its own before it"
        "fanuc: `G5.1 Q1`, `M6 T2`";
    Lost "lost" []
        "Points get no pulse."
        "write the program again"
        "A glass program from which a line was deleted";
    MFunction "m-function" ["nc-m-beside-cut", "nc-many-m"]
        "An M function is wrong, or stands where the control does not take it."
        "correct the M function: its words, and where it may stand"
        "fanuc: `M3 M8`";
    MachineFile "machine-file" []
        "A machine or control file is wrong."
        "correct the file at the mark; `toolpost explain NAME` says what a name takes"
        "`decimals = \"three\"`";
    MachineFrame "machine-frame" []
        "The frame of the machine cannot be drawn for this program."
        "draw it in the frame of the part, or name the machine by `--from`"
        "`show --frame machine` of a program with vectors";
    MachineIncomplete "machine-incomplete" []
        "A machine file lacks what every machine needs."
        "add what is missing to the machine file; `toolpost explain` lists names and units"
        "A file without `reader` and `extends`";
    MachineIsControl "machine-is-control" []
        "The name is that of a control, and a machine is needed."
        "name a machine of that control (`toolpost machines list`)"
        "`--machine fanuc-31i`";
    MachineKind "machine-kind" []
        "The machine does another kind of work."
        "choose a machine for this work (`toolpost machines list`)"
        "A wire machine for a milling program";
    MachineName "machine-name" []
        "This cannot be the name of a machine."
        "use letters, digits, - and _"
        "`machines new \"my mill\"`";
    MachinePosition "machine-position" ["nc-machine-position"]
        "A move in machine coordinates is not as the control takes it, or its position is not known."
        "add `safe_height` of the machine that the program was written for to its file"
        "fanuc: `G53 Z0` with `G2` active";
    MachineReach "machine-reach" []
        "A machine file may not be read from here."
        "put the file next to the one that names it"
        "`extends = \"../secret.toml\"` in a file of somebody else";
    MachineUnknown "machine-unknown" ["unknown-machine", "machine"]
        "There is no such machine or control in the library."
        "check the name (`toolpost machines list`)"
        "`--machine fanuk`";
    MachineUnreadable "machine-unreadable" []
        "A machine file cannot be read."
        "check the name of the file and the right to read it"
        "`--machine missing.toml`";
    MachineWord "machine-word" ["word"]
        "A word of a machine file is not known, or lacks its table or a code."
        "add the word or its code below [words] of the control's file; `toolpost explain` lists them"
        "A block that places `{{DEPTH}}`, and no `DEPTH` below [words]";
    Macro "macro" ["nc-macro"]
        "A macro is not written as the control takes it."
        "correct the macro: each DO has its END, and each GOTO its block"
        "fanuc: `WHILE [#1 LT 5] DO1`";
    MacroDivision "macro-division" []
        "An aperture macro divides by zero."
        "correct the macro"
        "`%AMA*1,1,$1/0*%`";
    MacroExpression "macro-expression" []
        "An expression of an aperture macro is wrong."
        "correct the macro"
        "`$1+`";
    MacroPrimitive "macro-primitive" []
        "A primitive of an aperture macro is not there, or has wrong values."
        "correct the macro; chapter 4.5 of the Gerber specification lists the primitives"
        "`%AMA*99,1*%`";
    MacroValue "macro-value" []
        "A value of an aperture macro is no number that can be."
        "correct the macro, or the values that %AD gives it"
        "`1000000x1000000x10`";
    Malformed "malformed" []
        "A statement is not written as its syntax says."
        "correct the statement, or write the file again from the CAM system"
        "apt: `GOTO/1,2`";
    ManyCommands "many-commands" ["nc-many-commands"]
        "A block has two commands of which the control takes one."
        "divide the block: the control takes one of these commands a block"
        "`M3 S1000 M8` for Marlin";
    Material "material" []
        "The table of materials does not have that material."
        "take one of the names that the finding lists, or add it"
        "`--material wood`";
    Materials "materials" []
        "A file is no table of materials."
        "start from `toolpost glass show materials`"
        "`index = one`";
    Memory "memory" []
        "The program has more points than the control holds, or that of a robot more lines than a file may have, and no retract at which it could be divided."
        "take a larger `--step` or `--chord-error`, or `--fit`; or divide the contour into several programs; of a robot, add rapids that take the tool beyond all cuts"
        "5000 points for a control that holds 4000";
    Mesh "mesh" []
        "A body has open edges or triangles without area."
        "close it in the program that made it if holes are not wanted"
        "An STL file of three faces of a tetrahedron";
    Missing "missing" []
        "Something that must be there is missing."
        "add what the message names"
        "A source with ten cuts, and a program with nine";
    MissingAperture "missing-aperture" []
        "A Gerber file draws with an aperture that it does not define."
        "define the aperture before it is used"
        "`D12*` without `%ADD12...*%`";
    MissingBlock "missing-block" []
        "The control's file lacks a block that is needed."
        "add this block to the control's file, or choose a control that has it"
        "A tapping cycle, and no block `tap`";
    MissingMacro "missing-macro" []
        "A Gerber file uses an aperture macro that it does not define."
        "define the macro before it is used"
        "`%ADD10NAME*%` without `%AMNAME*%`";
    MissingTool "missing-tool" []
        "A drill file uses a tool that it does not define."
        "define the tool in the header"
        "`T5` without `T5C0.8`";
    MissingWord "missing-word" ["nc-no-motion"]
        "A block lacks a word that it needs."
        "add the word that is missing to the block"
        "klartext: `CC X+10`, `C X+0 Y+0`";
    ModalGroup "modal-group" ["nc-modal-group", "group-conflict"]
        "A block has two words of one modal group."
        "divide the block: the two words exclude each other"
        "fanuc: `G0 G1 X10`";
    Modes "modes" ["nc-modes"]
        "Kept modes of the control are switched in a way that it does not take."
        "switch the mode in a block of its own, where the control permits it"
        "linuxcnc: `M72`";
    ModuloPosition "modulo-position" []
        "A position of a rotary axis is beyond one turn."
        "give the position within one turn of the axis"
        "sinumerik: `G0 C=DC(400)` on a machine with C";
    NarrowCorner "narrow-corner" []
        "A corner of the board is narrower than the tool."
        "nothing to do, if the rest may stay; else use a smaller `--outline-tool`"
        "An inside corner of R 0.5 with a tool of 2 mm";
    NarrowGap "narrow-gap" []
        "Gaps between conductors are narrower than the cut."
        "use a narrower tool, or cut the gaps all the same by `--narrow middle`"
        "A gap of 0.15 mm with a cut of 0.2 mm";
    NarrowSlot "narrow-slot" []
        "Slots within a conductor are narrower than the cut: copper stays in them."
        "nothing to do, if they only part a net from itself; else use a narrower tool"
        "A slot of 0.3 mm in a plane with a cut of 0.4 mm";
    Nesting "nesting" ["call-depth"]
        "Calls, loops or brackets lie too deep within each other."
        "use fewer levels within each other"
        "klartext: `LBL 1`, `CALL LBL 1`, `LBL 0`, `CALL LBL 1`";
    Net "net" []
        "A net of a board is not known."
        "save the board again in KiCad"
        "`(net 99)` in a board with 10 nets";
    NetTwice "net-twice" []
        "Two nets that are joined have different names."
        "give the nets one name, or separate them"
        "A track between GND and VCC in a board file";
    NetsJoined "nets-joined" []
        "Copper joins two nets."
        "nothing to do where the nets are tied on purpose; else correct the board"
        "A track over two pads of different nets";
    NoBoard "no-board" []
        "None of the files is a board."
        "give the Gerber and Excellon files, or the .kicad_pcb file"
        "A folder of PDF files";
    NoClearPlane "no-clear-plane" []
        "A cycle does not say from which height the tool feeds, or its heights are not in order."
        "correct the heights of the cycle: clearance and retract above the bottom of the hole"
        "apt: `CYCLE/DRILL,DEPTH,5,MMPM,100`";
    NoCutter "no-cutter" []
        "A hole needs to be milled, and there is no cutter for it."
        "give a `--hole-mill` that is no wider than the hole"
        "A slot of 0.6 mm with a cutter of 1 mm";
    NoCycle "no-cycle" ["cycle-missing"]
        "A hole has no cycle."
        "give a CYCLE statement before the first hole"
        "A hole in front of the cycle, in a program that other software builds";
    NoDiameter "no-diameter" []
        "A tool of a drill file has no diameter."
        "define it in the header, such as T1C0.8"
        "`T1` in the header without C";
    NoDrill "no-drill" []
        "There is no drill for a hole."
        "add the drill to `--drills`, allow more by `--drill-tolerance`, or mill the hole by `--hole-mill`"
        "A hole of 3.2 mm with drills up to 1 mm";
    NoEffect "no-effect" []
        "A key of the machine's file changes neither programs nor their proof."
        "take the key out, or state what gives it an effect"
        "`safe_height = -50` on a FANUC whose Z goes home by `G28` (`retract_by_g53` is false)";
    NoEnd "no-end" []
        "The file or the program has no end."
        "check that the file is not cut off"
        "A Gerber file without `M02*`";
    NoFeed "no-feed" ["missing-feed", "feed-missing"]
        "A cut comes before the first feed."
        "give F before the first cut"
        "sinumerik: `G1 X10` without F";
    NoFini "no-fini" []
        "A cutter-location file ends without FINI."
        "add FINI, or write the file again: it may be cut off"
        "A file that ends with GOTO";
    NoFormat "no-format" []
        "A Gerber file has coordinates before their format."
        "write %FS...*% before the first coordinate"
        "`X0Y0D02*` before `%FSLAX46Y46*%`";
    NoMotion "no-motion" []
        "Nothing moves in this file."
        "check that this is the right file, and that the operations were calculated"
        "A cutter-location file of comments";
    NoOperation "no-operation" []
        "A Gerber file has coordinates without an operation."
        "write D01, D02 or D03 behind the coordinates"
        "`X0Y0*`";
    NoOutline "no-outline" []
        "There is no outline of the board, and it is needed."
        "give the layer of the outline too; isolating and drilling do without, `--only` names them"
        "`--only outline` for a board without an edge layer";
    NoPlunge "no-plunge" []
        "A route of a drill file is not begun by M15."
        "write M15 where the tool goes down"
        "`G01X10` behind `G00X0Y0`";
    NoPoint "no-point" []
        "Nothing says where a line or a hole is."
        "give X and Y"
        "A Gerber file that begins with `D01*`";
    NoPose "no-pose" []
        "A pose has a number that is not finite, or a tool axis without length."
        "give finite numbers, and a direction with a length above 0"
        "A move of the Python builder to X NaN";
    NoQuadrant "no-quadrant" []
        "A Gerber arc comes before G75."
        "write G75 before the first arc"
        "`G02X1Y0I1J0D01*` before `G75*`";
    NoStart "no-start" []
        "An arc has no known start."
        "give a move to the start point before the arc"
        "apt: `CIRCLE/0,0,0,0,0,1,10`, `GOTO/0,10,0` as the first statements";
    NoSuchPart "no-such-part" []
        "The board has nothing for a program, or for a tool, that is asked for."
        "ask for parts that the board has"
        "`--only back` for a board with one side";
    NoThread "no-thread" []
        "The places to thread the wire are missing, or are more than the contours."
        "give one place for each contour by `--thread`, or the length of the lead-in by `--lead`"
        "`--side inside` with neither `--thread` nor `--lead`";
    NoTool "no-tool" []
        "Something is cut, and no tool is given for it."
        "call the tool (LOAD/TOOL) before its first move; for a board give `--tool` or `--vee`"
        "A cutter-location file whose first statement is a cut";
    NoUnit "no-unit" []
        "A length comes before the unit."
        "write the unit at the start of the file"
        "A Gerber file without `%MOMM*%`";
    NoWire "no-wire" ["wire-missing"]
        "The wire is used before it is threaded."
        "thread the wire before the first cut"
        "A list of moves of other software that cuts before it threads";
    NoZeros "no-zeros" []
        "A drill file does not say which zeros were left out."
        "write METRIC,LZ or METRIC,TZ"
        "`X15Y2` with METRIC alone";
    Node "node" []
        "A node of a board file is wrong."
        "give each node another name"
        "Two nodes with one name";
    NodeUnknown "node-unknown" []
        "A board file names a node that is not there."
        "check the name of the node"
        "`to = \"led.anode\"` without such a node";
    NotACut "not-a-cut" []
        "The source has something that a wire does not cut."
        "leave it out of the contour"
        "A drilling cycle in a contour for a wire";
    NotALength "not-a-length" []
        "A length of a KiCad board is below 0."
        "lengths are 0 or greater: save the board again"
        "`(width -1)`";
    NotANumber "not-a-number" []
        "A value of a KiCad board is no number."
        "save the board again in KiCad"
        "`(width abc)`";
    NotAPlace "not-a-place" []
        "A coordinate of a board or a contour is beyond what can be."
        "check the unit and the format"
        "X 9999999 mm in a drill file";
    NotAnEdge "not-an-edge" []
        "Something on the edge of a KiCad board is no line."
        "draw the edge with lines, arcs and circles"
        "A text on Edge.Cuts";
    NotCarriedOver "not-carried-over" []
        "Something of an imported post is not in the new machine file."
        "add this to the new file by hand, where the machine needs it"
        "A post that calls a script";
    NotCldata "not-cldata" []
        "The file is not cutter-location data of a mill."
        "give a file of cutter-location data; for an NC program add `--from CONTROL`"
        "An NC program given to `toolpost post` without `--from`";
    NotKicad "not-kicad" []
        "The file is no KiCad board."
        "give a .kicad_pcb file"
        "A schematic given as a board";
    NotParted "not-parted" []
        "A tool is too wide to separate two pieces of the board."
        "use a smaller `--outline-tool`, or move the pieces apart (`--spacing`)"
        "Two boards 1 mm apart with a tool of 2 mm";
    NotReached "not-reached" []
        "A tool does not reach all of an area."
        "nothing to do, if the rest may stay; else add a smaller tool"
        "Corners of an area that is cleared with 2 mm";
    NotUpright "not-upright" []
        "The tool leans or turns in a contour for a wire."
        "give a contour with the tool upright; `--taper` leans the wire"
        "`GOTO/0,0,0,0.1,0,1` in a flat contour";
    Number "number" ["nc-number"]
        "A number is out of range, or is not written as the control takes it."
        "give a number in the range that is named"
        "fanuc: `T1.5`";
    NumberRange "number-range" []
        "A value has more digits than the word takes."
        "move the part nearer to the work zero, or allow more digits for the word in the control's file"
        "X 12345.678 for a word with 4 digits before the point";
    OWord "o-word" ["nc-o-word"]
        "An O word has no partner, or stands in the wrong order."
        "close each O word in its own order (if with endif, while with endwhile, sub with endsub)"
        "linuxcnc: `O1 endif`";
    OffTheCircle "off-the-circle" []
        "The ends of an arc have different distances from its centre."
        "correct the arc: start and end must have the same distance from the centre"
        "apt: `GOTO/10,0,0`, `CIRCLE/0,0,0,0,0,1,10`, `GOTO/0,12,0`";
    OffsetDivides "offset-divides" []
        "The wire offset divides the contour."
        "use a thinner wire, or make the contour wider where it is narrow"
        "A neck of 0.2 mm with a wire of 0.25 mm";
    OffsetUnsure "offset-unsure" []
        "The wire offset cannot be found reliably."
        "simplify the contour near this line"
        "Arcs that nearly touch";
    OffsetVanishes "offset-vanishes" []
        "The wire offset leaves nothing of the contour."
        "use a thinner wire, or a larger contour"
        "A hole of 0.2 mm with a wire of 0.25 mm";
    OnControl "on-control" []
        "The control cannot follow heights that it measures."
        "level with measured heights (`--heights`), or choose another machine"
        "`--on-control` for GRBL";
    OneOpening "one-opening" []
        "The control cuts one opening in a program."
        "write a program for each opening"
        "Two contours for a control that takes a list of points, and threads once";
    OpenCompensation "open-compensation" []
        "By how much the source offsets the wire is not known, or the offset is on where the wire goes to or from its contour."
        "give `--side`, `--wire` and `--gap`: the offset path is then calculated here; a straight move switches the offset before the contour and behind it"
        "`G41 D1` in the source, and no `--side`";
    OpenContour "open-contour" []
        "A contour for a wire is not closed."
        "close the contour, or cut it by `--side left` or `--side right`, without a tab"
        "A slot of two lines with `--side inside`";
    OpenTaper "open-taper" []
        "A contour for a wire leans by words of the control."
        "take the contour without it, and lean the wire with `--taper`"
        "`G51 T2` in the source";
    OperatorControls "operator-controls" []
        "The program takes something from the operator: feed hold, override, single block, limits."
        "leave it out; where the operator knows of it, `--accept operator-controls` lets it pass"
        "linuxcnc: `M49`";
    OperatorData "operator-data" []
        "The program rewrites offsets, tool data or variables that belong to the operator."
        "leave them to the operator; for one run `--accept operator-data` lets it pass"
        "fanuc: `G10 L10 P1 R25.`";
    OperatorOffset "operator-offset" []
        "An offset of the operator shifts positions, and the program does not reset it."
        "reset the offset of the operator in the program, or do not read it"
        "sinumerik: `G0 Z=R1+50` with R1 in `operator_parameters`";
    OperatorRank "operator-rank" []
        "Operators stand in an order that reads otherwise than it counts."
        "put parentheses around the part that comes first"
        "sinumerik: `IF NOT 1==2`, `ENDIF`";
    Option "option" []
        "An option of the machine has a value that it does not take."
        "give a value of the kind that is named"
        "`--option path_tolerance=wide`";
    OptionalStop "optional-stop" []
        "An optional stop is left out, because the control has none."
        "add the block `optional_stop` to the control's file where the control has one"
        "`OPSTOP` for Marlin";
    Orientation "orientation" []
        "The orientation of the tool is incomplete, said twice, or stands where the control does not take it."
        "give the orientation in one way, complete, in a mode that takes it"
        "sinumerik: `G1 X10 A3=1 C3=1`";
    OrientationInCut "orientation-in-cut" []
        "The plane of work changes in a cut."
        "retract before the plane of work changes, or post for a machine that turns while it cuts"
        "A five-axis cut on a machine that tilts its plane";
    OrientationTolerance "orientation-tolerance" []
        "The control may turn the tool out of its orientation."
        "set `orientation_tolerance` in [options] of the machine file (degrees), or write no more than that"
        "`CYCL DEF 32.2 HSC-MODE:0 TA5` where the machine file allows 0.05°";
    OrientationWay "orientation-way" []
        "How the tool turns within a block is not said."
        "write ORIWKS and ORIVECT (SINUMERIK) or PATHCTRL VECTOR (HEIDENHAIN) with vectors, ORIMKS and ORIAXES or M128 with positions"
        "`TRAORI` without ORIWKS and ORIVECT";
    Origin "origin" []
        "A setting that tells how to read the source does not go with this source."
        "leave the option out"
        "`--csys world` with an NC program";
    OutOfRange "out-of-range" []
        "A point is farther away than any machine reaches."
        "check units and frames of the file: the values lead too far away"
        "apt: `GOTO/1e9,0,0`";
    Outline "outline" []
        "The outline of a board cannot be made of its lines."
        "check the unit and the arcs"
        "An outline in mm that was read as inches";
    OutlineBranch "outline-branch" []
        "More than two lines of the outline meet in one point."
        "take out the lines that are too much"
        "A T of three lines on the edge layer";
    OutlineCrosses "outline-crosses" []
        "The outline crosses itself."
        "draw the outline without crossings"
        "An eight on the edge layer";
    OutlineEmpty "outline-empty" []
        "The outline encloses nothing."
        "draw a closed outline around the board"
        "A single line on the edge layer";
    OutlineFlash "outline-flash" []
        "The outline has a flash, which is left out."
        "nothing to do, if it is no part of the edge"
        "A pad on the edge layer";
    OutlineGap "outline-gap" []
        "Gaps of the outline were closed."
        "nothing to do; let the lines end in one point"
        "Ends 0.01 mm apart";
    OutlineMixed "outline-mixed" []
        "The outline has lines and areas."
        "draw the edge with lines alone, or fill the board and nothing else"
        "A filled board and a line on one layer";
    OutlineOpen "outline-open" []
        "The outline is not closed."
        "close the outline"
        "Three sides of a rectangle";
    OutlineTangled "outline-tangled" []
        "Very many ends of the outline lie within one point."
        "take out what is too much"
        "1,000 short lines at a corner";
    Output "output" ["nc-output"]
        "An output is set in a way that the control does not take, or not as the source has it."
        "give the number of the output, in the range that the control has"
        "linuxcnc: `M62`";
    OutputFile "output-file" ["output"]
        "A file cannot be saved."
        "give another name, or allow writing to the file"
        "`-o` with the name of an input";
    OutputFolder "output-folder" []
        "The folder for the output is not there, cannot be made, or is that of the input."
        "give another folder, or make it first"
        "`-o missing/part.nc`";
    Overlap "overlap" []
        "Passes are to overlap by more than can be."
        "give a part from 0 to below 1, such as 0.4"
        "`--overlap 1`";
    Pad "pad" []
        "A pad of a KiCad board is not read, or has no size."
        "pads have a width and a height above 0: correct it in KiCad"
        "`(size 0 0)`";
    Panel "panel" []
        "A panel of boards cannot be made."
        "give `--panel` 1 or more in each direction, and no more than fit"
        "`--panel 1000x1000` of a board of 100 mm";
    Parameter "parameter" ["nc-parameter"]
        "A parameter or variable is read before it is set, or there is none of that number."
        "set the parameter before it is read, within the numbers that the control has"
        "linuxcnc: `#99999=1`";
    PartHeight "part-height" []
        "The height of the part is missing for a wire that leans."
        "give the height between the lower and the upper contour"
        "`--taper 2` without `--height`";
    Passes "passes" []
        "Passes do not go with another setting, or their offsets grow from one to the next."
        "leave `--passes` or `--isolate middle` out; let each pass of a wire leave less than the one before (`--leave`)"
        "`--passes 2 --isolate middle`";
    Path "path" []
        "The program leaves the path of the source."
        "correct the block of an edited program; report a program that `post` has just made, with its toolpath"
        "X 10.05 where the source goes by X 10";
    PathMode "path-mode" ["nc-path-mode"]
        "The path mode is not written as the control takes it, or cuts corners."
        "check that the part allows this; `path_tolerance` of the machine file says how far the control leaves the path"
        "linuxcnc: `G64 P-1`";
    PathTolerance "path-tolerance" []
        "The control may leave the path by an unknown amount, or by more than the machine file allows."
        "give the tolerance of the path that the machine file allows"
        "sinumerik: `G642`, `G1 X10`";
    Pattern "pattern" ["nc-pattern"]
        "A pattern of holes or a pocket lacks words, or has too many points."
        "give the points or the lengths that the pattern needs"
        "linuxcnc: a pocket (`G12`) whose position is not known";
    Payload "payload" []
        "What hangs on the flange of a robot is not stated, or is another load than that of the machine file."
        "weigh the spindle with a tool in it: `load_mass` and `load_center` below [cell] of the machine file"
        "`set_payload(2.0, [0, 0, 0.05])` where the machine file states 1.5 kg";
    Peck "peck" []
        "Pecks are smaller than those of the source, or go back to the last depth itself."
        "nothing to do, if more pecks suit the hole"
        "Pecks of 2 mm where the source has 5 mm";
    PeckRetract "peck-retract" []
        "How far G83 retracts above R is a setting that is not known."
        "state `retract_above_r` in mm below [settings] (setting 52; 0 as it is delivered)"
        "haas: `G83 Z-10. R2. Q1. F100.`, `G80`";
    Pen "pen" []
        "A Gerber aperture draws no lines of this form."
        "draw lines and arcs with a circle"
        "An arc drawn with a rectangle";
    PieceLoose "piece-loose" []
        "A milled route closes, and the piece within it comes loose."
        "hold that piece, or leave gaps in the route"
        "A closed slot around a piece of the board";
    Pins "pins" []
        "There is no place for pins."
        "give `--alignment` a diameter above 0 for which there is room"
        "Pins at a distance of -5 mm";
    PinsLate "pins-late" []
        "Pins are drilled behind a program that needs them."
        "begin with the holes"
        "The back before the holes of its pins";
    Pitch "pitch" []
        "A tap has no pitch, or another hole has one."
        "give the kind `tap` a pitch, and no other kind"
        "`drill` of the Python builder with a pitch";
    Points "points" []
        "There are more points than the controller holds or than can be made."
        "take a larger spacing or a smaller scale"
        "3 million points on a controller for 2 million";
    Polar "polar" ["nc-polar"]
        "Polar coordinates are incomplete, or stand where the control does not take them."
        "give pole, radius and angle in the plane"
        "linuxcnc: `G18`, `G1 @5 ^30`";
    PolarityChanges "polarity-changes" []
        "A Gerber file changes its polarity more often than is followed."
        "write the layer again with what is clear in one place, or divide it"
        "100,000 changes between `%LPD*%` and `%LPC*%`";
    PoleWay "pole-way" []
        "Along a vector the tool goes past the pole of the rotary axes, through which the control leads it in its own way."
        "lead the tool axis round the pole or through it in the CAM system, or write positions of the rotary axes (`simultaneous = \"tool-center-angles\"` in [orientation])"
        "A cut within 0.1° of the tool upright";
    Posture "posture" []
        "A robot's program states another posture than the one in which the arm comes to a position, or one at whose edge it stands."
        "correct the letters and turns of an edited program; report a program that `post` has just made, with its toolpath"
        "ls: `CONFIG : 'F U T, 0, 0, 0'` where joint 5 says that the wrist is not flipped";
    Probe "probe" ["nc-probe"]
        "A probing move is not as the control takes it."
        "give the probing move a feed in mm/min, a fixed tool axis, and an end other than its start"
        "`G38.2 A10 F100`: a probing move of a rotary axis";
    ProbeInHole "probe-in-hole" []
        "A place at which the height is measured lies in a hole or at its rim."
        "another number of columns or rows (`--probe`), or `--from back`"
        "A grid whose corner is over a mounting hole";
    Probing "probing" []
        "A probing program cannot be made."
        "correct the setting that the message names"
        "A name of the log with a bracket in it";
    ProbingGrid "probing-grid" []
        "A grid of places to probe cannot be made."
        "give 2 columns and 2 rows or more"
        "`--probe 1x5`";
    ProgramEnd "program-end" []
        "Something is wrong with the end of the program."
        "add the end of the program; the file may be cut off"
        "sinumerik: a program without `M30`";
    ProgramFrame "program-frame" []
        "What begins and ends a program is missing or does not fit: BEGIN PGM and END PGM of HEIDENHAIN, DEF and END of KUKA."
        "begin and end the program as the control has it: BEGIN PGM and END PGM with one name and unit, DEF with a name and END"
        "klartext: `END PGM OTHER MM`";
    ProgramLength "program-length" []
        "The program has more moves than are read."
        "divide the program"
        "A loop of 100 million moves";
    ProgramNumber "program-number" ["nc-program-number"]
        "A program number is out of range, or another program begins before this one has ended."
        "give a number from 1 to 7999 (`program_number` of the options), and end each program by M30 or M99"
        "fanuc: `O12345678901`";
    ProgramRepeats "program-repeats" []
        "The program ends with M99, by which it begins again without end."
        "write M30 where it shall run once"
        "fanuc: `M99`";
    ProjectKey "project-key" []
        "Keys of a millproject that have no meaning here, or none yet: each with the reason."
        "nothing to do where the reason is enough; else give the option that does it"
        "`optimise=1` in a millproject";
    RParameter "r-parameter" []
        "An R parameter is out of range, or set and read in one block."
        "use R0 to R999, and set a parameter before the block that reads it"
        "sinumerik: `R2000=1`";
    Rail "rail" []
        "The program does not say where the rail of an arm stands, or moves it while the tool goes straight, or the arm has none."
        "state the position of the rail in the motion to home, and change it in motions of the joints beyond all cuts alone"
        "`LIN {X 10,E1 500}` behind a motion that left `E1` at 400 (KRL)";
    RapidFeed "rapid-feed" []
        "How fast rapids are is not known, or faster than the machine file states, or a rapid is written as a cut."
        "write the `rapid` of the machine, in mm/min, below [axes]; a rapid of the toolpath is a rapid (G0) in the program"
        "A LinuxCNC file without `rapid` in [axes]";
    RapidPath "rapid-path" []
        "The tool would leave the straight line of a rapid, or comes from home or goes there, where a hole or a pocket may be around it; or the rapid is written in pieces or at a feed so that it does not."
        "nothing to do where it is a warning; a control that brings all axes to their ends together (`rapid_path = \"linear\"`) needs fewer blocks; a rapid within a pocket that was there before goes along the tool out of it, as high as the toolpath ever goes, or the zero is at the top of the part; a robot goes straight up along the tool to where the toolpath is highest, along the tool and along Z, and down so"
        "A turn of A by 60° in a rapid next to the part";
    RapidStop "rapid-stop" []
        "A rapid ends at a point that the source does not have."
        "report this with the toolpath: the program differs from it"
        "A rapid that stops 3 mm above a hole";
    Reader "reader" []
        "The machine has no control that reads a program."
        "name the control that the machine has (`reader`)"
        "`--from` with a machine file without `reader`";
    ReferencePlane "reference-plane" []
        "The retraction plane is not above the reference plane."
        "put the retraction plane above the reference plane"
        "sinumerik: `CYCLE81(0,10,2,-5)`";
    Region "region" []
        "A Gerber region is not begun or ended."
        "begin a region with G36, and end it with G37"
        "`G36*` within a region";
    RegionCrossesItself "region-crosses-itself" []
        "A contour of a Gerber region crosses itself."
        "draw the region without crossings"
        "An eight between G36 and G37";
    RegionOpen "region-open" []
        "A contour of a Gerber region is not closed."
        "end the contour where it begins"
        "Three sides between G36 and G37";
    RegionTooComplex "region-too-complex" []
        "A contour has too many crossings to be looked through."
        "divide the region"
        "A region of a million points in a knot";
    Register "register" []
        "The source names a register for the length or the radius of a tool, and the control takes both with the tool."
        "set the value at the control with the tool, if the program needs this register"
        "`LOAD/TOOL,1,ADJUST,5`";
    Repeat "repeat" []
        "A drill file repeats without a count."
        "write how often, as in R5X1"
        "`R`";
    RepeatedWord "repeated-word" ["nc-repeated-word", "word-twice"]
        "A word stands twice in a block."
        "give each word once in a block"
        "fanuc: `G1 X1 X2`";
    ReplacementTool "replacement-tool" []
        "The control changes a tool whose life is over by itself."
        "leave M101 out, or write M102 before the cut"
        "`M101` (HEIDENHAIN)";
    ReportPair "report-pair" []
        "The report does not belong to this program."
        "post the program anew for a report of its own, or remove the report"
        "A program that was edited behind its report";
    Retract "retract" []
        "A cycle retracts to a height below the one it feeds from."
        "give a higher RTRCTO"
        "`CYCLE/DRILL,RAPTO,5,RTRCTO,2,...`";
    Rewind "rewind" []
        "A rotary axis has to be turned back, or an arm has to take another turn about the tool or another posture, and the cut is interrupted."
        "check the marks of the interrupted cut; a machine with more travel, or the part turned or elsewhere, avoids it"
        "A spiral of 10 turns on an axis with ±180°";
    RotaryAtZero "rotary-at-zero" []
        "Rotary axes stand at 0 throughout, and are read as those of a machine without them."
        "nothing to do, if they are not meant to turn; `--from` with the machine's file tells what they do"
        "`G0 A0` in a program of which only the control is known";
    RotaryFeed "rotary-feed" []
        "How the feed of rotary axes counts is not known."
        "state `rotary_feed` in [settings] of the machine file (FANUC: parameter 1408#0)"
        "`G1 A90 F500` of a machine without `rotary_feed`";
    RotaryWay "rotary-way" []
        "Which way a rotary axis turns depends on a setting that is not known."
        "state `modulo` of the axis in the machine file, or write M126 (HEIDENHAIN), DC() (SINUMERIK)"
        "`G0 C350` from C10, without `modulo` in the machine file";
    Route "route" []
        "A route of a drill file is not begun, or not ended."
        "write G00 to the start of the route, and M15"
        "`G01X5` behind a hole";
    SafeHeight "safe-height" []
        "The safe height of the machine is not known."
        "write the `safe_height` of the machine, mm in machine coordinates"
        "`retract = \"G53 G0 Z{{ safe_height }}\"` in a file without `safe_height`";
    SelfCrossing "self-crossing" []
        "A contour crosses itself."
        "give a contour that goes round once"
        "An eight as a contour for a wire";
    Setting "setting" []
        "A setting is out of range, or two do not go together."
        "give a value within the range that is named"
        "`--tolerance 0`";
    SettingsKey "settings-key" []
        "A key or a value of the settings file of a board is not one of the command."
        "the names are those of `toolpost pcb --help`, without the dashes in front"
        "`passess = 2` in `toolpost.toml`";
    Shadowed "shadowed" []
        "Points are made below finished points that scatter their beam."
        "order by `--order fastest`"
        "A wall that is engraved from above";
    Shape "shape" []
        "A shape of a KiCad board cannot be read."
        "draw it again in KiCad"
        "A polygon that crosses itself many times";
    Side "side" []
        "`--side` does not go with the source: two contours, or another side of G41 or G42."
        "leave `--side` out for two contours; else take the side of the program"
        "`--side right` for a program with G41";
    SingleBlock "single-block" []
        "A thread or a probing move is not that of the source, or begins where no block says."
        "give a rapid to its start before it; a program that `post` has just made is reported with its toolpath"
        "`G38.3` in the program where the source probes by `G38.2`";
    Small "small" []
        "A body is so small in its block that its unit may be wrong."
        "scale it by 25.4 if its file is in inches"
        "A body of 0.4 mm in a block of 20 mm";
    Source "source" []
        "The source is not known, or cannot be compared."
        "add `--from` with a machine or a control"
        "A file of a kind that is not read";
    SourcePasses "source-passes" []
        "A contour for a wire has several passes already."
        "leave the first pass in the source: `--leave` makes the others"
        "A source that cuts the same contour twice";
    Spacing "spacing" []
        "The smallest distance of points is less than the cracks of the lens need, or no distance."
        "take a larger spacing, or a lens of a shorter focal length"
        "0.05 mm at f = 70 mm";
    Spindle "spindle" ["nc-spindle"]
        "The spindle is not on, has no speed, or does not run as in the source."
        "give a spindle speed above 0 and a direction before the first cut"
        "fanuc: `S-100`";
    SpindleDwell "spindle-dwell" []
        "The tool cuts before the spindle has come to its speed."
        "report this with the toolpath: the program lacks the dwell"
        "A cut right behind `M3` with `dwell` in [spindle] of the machine file";
    SpindleOff "spindle-off" []
        "A cut comes while the spindle stands."
        "start the spindle before the first cut"
        "A cut before `SPINDL/1000,CLW`";
    SpindleRange "spindle-range" []
        "A speed is outside the range of the machine."
        "give a speed within the range of the machine, or correct its file"
        "S 20000 on a machine with 12000 rpm at most";
    SpindleSpeed "spindle-speed" []
        "A tool of a FreeCAD job has no speed."
        "give the tool controller its speed and direction"
        "A tool controller with 0 rpm";
    Spline "spline" ["nc-spline"]
        "A spline lacks words, or stands where the control does not take it."
        "give the words that the spline needs, in the plane that it works in"
        "linuxcnc: `G18`, `G5.1 X10 Y0 I1 J1`";
    StartMode "start-mode" []
        "The program leans on a mode that it does not say, and how the control starts is set up at the machine."
        "write G17, G90, G94, G91.1, G98 or G710 at the start, as the finding says, or state it in `start_modes` in [settings] of the machine file"
        "mach3: `G2 X10 I5 J0` without G91.1";
    Step "step" []
        "A step down is smaller than can be."
        "give a larger step"
        "1,000,000 levels of 0.001 mm";
    StepAndRepeat "step-and-repeat" []
        "A Gerber step and repeat is wrong."
        "write counts above 0, and none within another or within a block"
        "`%SRX0Y2I1J1*%`";
    Stop "stop" []
        "The program stops where the source does not, or the other way round."
        "report this with the toolpath: the program differs from it"
        "`M0` in the program alone";
    StopInCut "stop-in-cut" []
        "The program stops while the tool is in a cut."
        "retract the tool before the stop"
        "`M0` behind `G1 Z-5`";
    StopRetract "stop-retract" []
        "Where axes go at a stop of the control is not followed."
        "nothing to do, if the machine may stop where it stands"
        "sinumerik: `POLF[X]=10`";
    StopRunning "stop-running" []
        "The program stops while spindle or coolant may run on, or changes the tool while coolant may."
        "write M5 and M9 before it"
        "`M0` without `M5` and `M9` before it";
    Stopped "stopped" []
        "The work was stopped from outside."
        "it was cancelled: start it again"
        "Ctrl-C";
    StoredPosition "stored-position" []
        "An axis goes to a position that only the machine knows."
        "retract by G53 to the safe height of the machine"
        "linuxcnc: `G30`";
    Stray "stray" []
        "A pulse lies in the crack of no point."
        "write the program again"
        "A glass program with a changed coordinate";
    StudioAsk "studio-ask" []
        "The studio is asked for something that it does not know, or with values that it does not take."
        "reload the page: it may be of another version than the command"
        "a message of the page that names no ask";
    StudioChanged "studio-changed" []
        "A file that the program was made of is another one now, or is gone: the program is not saved."
        "post again, and save what is proven then; put back a file that is gone"
        "a machine file that was edited after the program was proven";
    StudioDraft "studio-draft" []
        "Another page that is open keeps its edit under the name of this draft."
        "close one of the pages, or edit another program in it"
        "the same toolpath, edited in two tabs";
    StudioLimit "studio-limit" []
        "A file, a message or all open programs together are larger than the studio takes."
        "close what is no longer needed; the other commands take files of any size"
        "a file of 300 MB that is dropped on the page";
    StudioPage "studio-page" []
        "The command was built without the page of the studio."
        "install Node 20.19 or newer, run `make studio` in the source of Toolpost, and build the command again"
        "`toolpost studio` of a command that was built without Node";
    StudioPort "studio-port" []
        "The studio cannot listen on 127.0.0.1."
        "leave --port out, or give another one"
        "`toolpost studio --port 80`, where the port belongs to somebody else";
    Surface "surface" []
        "What follows a measured surface is not possible here."
        "level the program with measured heights (`--heights`) instead"
        "An arc in XZ over a surface";
    SurfaceSpeed "surface-speed" []
        "Constant surface speed is asked for, which mills do not have."
        "give the spindle a speed (G97)"
        "`SPINDL/100,SMM`";
    Sweep "sweep" []
        "Between points the tool leans otherwise than in the source, and points were added."
        "nothing to do; the tolerance holds; points in the CAM system that are closer make it unnecessary"
        "Two points 90° of tilt apart";
    SwivelData "swivel-data" []
        "The program swivels by another data set than the machine file names."
        "set `swivel_data` in [options] of the machine file, and name the same in _TC"
        "`_TC` of CYCLE800 with another name than `swivel_data`";
    SyncBlocks "sync-blocks" []
        "Upper and lower contour have different numbers of blocks."
        "synchronise them by arc length (`--sync length`) or by given points (`--pair`)"
        "4 lines below and 5 above";
    SyncClosed "sync-closed" []
        "One of two contours is closed, the other is not."
        "close both"
        "A circle below and a line above";
    SyncOpenings "sync-openings" []
        "Upper and lower contours are not the same number."
        "give one upper contour for each lower one"
        "2 contours below and 3 above";
    SyncPoint "sync-point" []
        "A point that synchronises two contours does not lie on them."
        "give points of the contours by `--pair`, in the order of travel"
        "`--pair` with a point 1 mm off the contour";
    Syntax "syntax" ["nc-syntax"]
        "A block is not written as the control takes it."
        "correct the block at the mark, as the control's programming manual has it"
        "linuxcnc: `G1 *`";
    Tab "tab" []
        "A tab needs something that the machine lacks, or has no room."
        "leave `--tab` out or make it shorter than the contour, or choose a machine that stops"
        "`--tab 2` on a machine without `stop`";
    TabCount "tab-count" []
        "More tabs are asked for than can be."
        "give a number of tabs that the message names"
        "`--tabs 0` with a height";
    TabHeight "tab-height" []
        "Tabs are higher than the board."
        "give a part of the thickness"
        "A tab of 2 mm in a board of 1.6 mm";
    TableFrame "table-frame" []
        "In which frame X, Y and Z count behind G43.4 with a turned table is not known."
        "turn the table to 0 before G43.4, or set `table_frame_at_zero` in [settings]"
        "`G43.4 H1` with B at 30";
    TabsBent "tabs-bent" []
        "Tabs lie on arcs or corners."
        "nothing to do, if they may be filed off there"
        "A round board with tabs";
    TabsLeftOut "tabs-left-out" []
        "There is no room for all tabs."
        "give fewer or shorter tabs"
        "8 tabs on a board of 10 mm";
    TapHolder "tap-holder" []
        "Whether taps are held fast or floating is not known from the source."
        "check the holder of the tap"
        "`CYCLE/TAP,...,FLOAT` for a control with rigid tapping";
    TapPitch "tap-pitch" []
        "The pitch of a tap is not known."
        "give MMPR,pitch or TPI,threads, or feed and spindle speed"
        "`CYCLE/TAP` without a pitch, and no feed per turn";
    Taper "taper" ["nc-taper"]
        "A taper of the wire is wrong, or not that of the source."
        "switch the taper in a straight cut"
        "fanuc-wire: `G51 T95.`";
    TaperActive "taper-active" []
        "A record needs the taper off, and it is on."
        "end the taper before this record"
        "The wire is cut while `Taper` is on";
    TaperAngle "taper-angle" []
        "A taper leans farther than can be."
        "give `--taper` 60° at most, and a `--height` above 0"
        "`--taper 70`";
    TaperCorner "taper-corner" []
        "A corner cannot be cut with this taper."
        "lean less, or round the corner"
        "An inside corner of R 0.2 with 10° over 50 mm";
    TaperLead "taper-lead" []
        "The lead-in is too short for the taper."
        "thread the wire farther from the contour (`--thread`, `--lead`)"
        "A lead-in of 1 mm with 10° over 50 mm";
    TaperLimit "taper-limit" []
        "The wire leans farther than the machine allows."
        "give a smaller `--taper`, or a machine whose wire may lean more"
        "15° on a machine with 10°";
    Template "template" []
        "A template of a machine file uses what templates may not use."
        "correct the template at the mark: words, `{{ name }}`, `{% if %}`, `{% for %}` and `{% set %}` are there"
        "`{{ f(x) }}`";
    TemplateBlock "template-block" []
        "A machine file has a block of a name that is not known."
        "check the name of the block; `toolpost explain` lists them"
        "`retrct = \"G53 G0 Z0\"` below [blocks]";
    TemplateComment "template-comment" []
        "A template writes a text of the source outside of a comment, where the control takes it for words."
        "put it between the signs of a comment of this control"
        "`{{N}} {{ tool.name }}`";
    TemplateName "template-name" []
        "A template uses a name that is not there."
        "use a name that `toolpost explain` lists"
        "`{{ tol.number }}`";
    TemplateOutput "template-output" []
        "A template writes too much."
        "make the template shorter: what it writes is bounded"
        "A loop of a million lines in a block";
    TextKnockout "text-knockout" []
        "A knocked-out text of a KiCad board is left out."
        "draw the text without knockout"
        "`(knockout)` on F.Cu";
    TextLetters "text-letters" []
        "Letters of a KiCad text were drawn by strokes of our own."
        "nothing to do, if the form of the letters does not matter"
        "A text on F.Cu without a stored outline";
    TextOpen "text-open" []
        "A text of a KiCad file is not closed."
        "the file is damaged: save it again in KiCad"
        "`\"GND`";
    TextVariable "text-variable" []
        "A text with variables is left out."
        "write the text itself"
        "`${REVISION}` on F.Cu";
    Thread "thread" ["nc-thread"]
        "A screw thread, or threading of the wire, is not as the control takes it."
        "give a pitch above 0, a turning spindle and a straight way"
        "linuxcnc: `G33 Z-10`";
    Ticks "ticks" []
        "A program takes other laser ticks than were planned."
        "report it with the body"
        "None is known";
    TiltedPlane "tilted-plane" ["nc-tilt", "plane"]
        "A tilted plane is incomplete, or stands where the control does not take it."
        "end the tilted plane before this block, or give it the words that the control takes"
        "fanuc: `G53.1`";
    TooLarge "too-large" []
        "The file has more objects than are read."
        "divide the file"
        "A drill file of 100 million holes";
    TooMuch "too-much" []
        "An area has more to clear than can be worked on."
        "clear the area in parts, or use a wider tool first"
        "A board of 1 m cleared with 0.05 mm";
    TooTangled "too-tangled" []
        "A drawing has too many lines that meet or cross."
        "divide the drawing into contours, choose layers by `--layer`, or close smaller gaps only (`--close`)"
        "100,000 lines over each other";
    Tool "tool" ["nc-tool"]
        "A tool is not called, or not the one of the source."
        "call the tool that the toolpath names, by a number or name that the control takes"
        "`M6`, and no T has chosen a tool (SINUMERIK)";
    ToolAxis "tool-axis" []
        "The tool axis is missing or incomplete."
        "give all three values of the vector"
        "A GOTO with a tool axis of two values";
    ToolByHand "tool-by-hand" []
        "Tools are put into the spindle by hand, at a stop of the program; a program that stops for another tool than it says, or goes on without what a stop needs, is refused."
        "name the program that changes tools (`tool_change` below [cell]), or correct the edited program"
        "krl: `HALT` behind `$LOOP_MSG[]=\"Tool 3\"` where the source calls tool 2";
    ToolCenter "tool-center" []
        "Tool centre control is switched where the control does not take it."
        "switch tool centre control on with the tool called, on a machine with rotary axes"
        "klartext: `M128`";
    ToolChange "tool-change" []
        "An operation, or a cut behind the description of a tool, is for another tool than the one that is in the spindle."
        "add LOAD/TOOL at the start of the operation, or behind the description"
        "`TOOL PATH/...,TOOL,DRILL` behind `LOAD/TOOL` of a mill";
    ToolChangeHeight "tool-change-height" []
        "The tool is changed where Z is not home."
        "send Z home before M6, or set `tools.retracts` of the machine"
        "`M6` behind a cut on a machine that does not raise Z itself";
    ToolChangeTilt "tool-change-tilt" []
        "The tool is changed while the head leans."
        "turn the head upright before M6"
        "`M6` with B at 30";
    ToolEdge "tool-edge" []
        "Which edge of the tool counts behind the tool change is a setting."
        "write D1 in the block of M6 or behind it, or state `edge_at_change` in [settings] of the machine file"
        "sinumerik: `T1 D1`, `M6`, `G0 Z20`";
    ToolLength "tool-length" []
        "The length of the tool is needed and not known."
        "give the tool a length: LENGTH in the tool call of cutter-location data, a tool table (`--tools`) with an NC program"
        "A tilted head, and a tool without length";
    ToolNumber "tool-number" []
        "A tool that is needed is not called, or has no number."
        "call the tool by its number, from 1 on; a tool that an NC program calls by its name has it in a tool table (`--tools`)"
        "apt: `LOADTL/0`";
    ToolOffset "tool-offset" []
        "An offset of a tool is not used."
        "nothing to do, if the control keeps the length"
        "`LOAD/TOOL,1,OFFSETL,50`";
    ToolPosition "tool-position" []
        "Positions are not those of the tool tip."
        "let the CAM system write the tool tip"
        "`TOOL PATH/...` with centre points";
    ToolRange "tool-range" []
        "A tool is larger than the machine takes."
        "choose a tool within the range of the machine, or correct the tool's data"
        "A tool of 200 mm for a magazine with 120 mm";
    ToolTable "tool-table" []
        "A line of the tool table is wrong."
        "a line is like `T1 P1 Z25 D6 ;end mill`, lengths in mm"
        "`T1 P1 Z`";
    ToolTooWide "tool-too-wide" []
        "A tool is too wide for every gap between conductors: nothing would be isolated."
        "use a narrower `--tool`, or cut gaps down the middle by `--narrow middle`"
        "A tool of 3 mm for a board with gaps of 0.2 mm";
    ToolTwice "tool-twice" []
        "Two tools have one number."
        "give each tool a number of its own in the toolpath, or the same data everywhere where it is one tool"
        "T1 as a drill of 5 mm and T1 as a mill of 10 mm";
    ToolWidth "tool-width" []
        "The width of a tool is missing, or tools are in the wrong order."
        "name the widest tool first, each once"
        "1 mm before 2 mm";
    Topic "topic" []
        "This is no name of machine and control files, and no rule."
        "`toolpost explain` lists them all"
        "`toolpost explain drlil`";
    Transformation "transformation" []
        "A transformation is not ended before the next, or is incomplete."
        "end one transformation before the next begins, and give it the words that the control takes"
        "`CYCL DEF 247` in a turned frame (HEIDENHAIN)";
    Travel "travel" []
        "A position is beyond the travel of the machine."
        "take a smaller block, or move the body (`--move`)"
        "A block of 400 mm on a machine with 300 mm";
    TravelHeight "travel-height" ["travel"]
        "Rapid moves would be lower over the board than the height from which tools feed."
        "give `--travel` no less than `--approach`"
        "`--travel 0.3 --approach 0.5`";
    Truncated "truncated" []
        "The file is cut off."
        "write the file again from the CAM system: it may be cut off"
        "A file that ends within a statement";
    TurnHeight "turn-height" []
        "Rotary axes turn where the tool may meet the part."
        "report this with the toolpath, or set `safe_height` of the machine"
        "A turn of A with the tool 1 mm above the part";
    Twice "twice" []
        "A point gets two pulses."
        "write the program again"
        "A glass program with a repeated line";
    TwoTools "two-tools" []
        "Two tool controllers of a FreeCAD job have one number, and different tools."
        "give one of the tool controllers another number"
        "T1 as a drill of 5 mm and T1 as a mill of 10 mm in one job";
    Type "type" []
        "A value has the wrong type."
        "give a value of the type that is needed here"
        "sinumerik: `R1=\"A\"`";
    Unit "unit" []
        "The unit of a board file is wrong."
        "write MM or IN"
        "`%MOXX*%`";
    UnitBlock "unit-block" []
        "G20 or G21 stands in a block with other words."
        "write it in a block of its own at the start of the program"
        "fanuc: `G21 G0 X0`";
    UnitConcluded "unit-concluded" []
        "The unit of a drill file was concluded from its numbers."
        "nothing to do, if it is right"
        "A drill file without METRIC or INCH";
    Units "units" ["nc-units"]
        "The unit is not known, or is switched where the control does not take it."
        "write G20 or G21 in a block of its own at the start of the program, or say what lengths count by `--units mm` or `--units inch`"
        "fanuc: a program without G20 and G21";
    UnknownAxis "unknown-axis" ["nc-axis"]
        "The program moves an axis that is not known."
        "name the machine that the program was written for: its file says which linear and rotary axes there are"
        "linuxcnc: `G1 A10`";
    UnknownBlock "unknown-block" []
        "A block of the program is not known."
        "check the spelling of the block, or read the program with the control that it was written for"
        "klartext: `FOO X+10`";
    UnknownCommand "unknown-command" []
        "A command of a board file is not read."
        "leave it out, or write the file again"
        "`G99` in a drill file";
    UnknownM "unknown-m" []
        "An M function is not known."
        "check the number, or describe the M function in the machine file"
        "sinumerik: `M77`";
    UnknownPosition "unknown-position" ["nc-unknown-position"]
        "A block needs a position that no block before has given."
        "move to a known position first, with every axis named in absolute coordinates; `--start` gives the place where the tool stands at the start"
        "fanuc: `G28 Z50.`, `G91 G1 Z5.`";
    UnknownShift "unknown-shift" ["nc-unknown-shift"]
        "A shift of the coordinates is used whose value is not in the program."
        "set the shift before, or leave it out: its value is not in the program"
        "linuxcnc: `G92.3`";
    UnknownStart "unknown-start" []
        "Where a cut starts is not known."
        "give a rapid move with X, Y and Z before the first cut, or `--start` with the place where the tool stands"
        "A program whose first move is `G1`";
    UnknownUnit "unknown-unit" []
        "The unit of a cutter-location file is not known."
        "write UNITS/MM or UNITS/INCHES before the first length"
        "apt: `UNITS/FEET`";
    UnknownWord "unknown-word" ["nc-unknown-word"]
        "A word is not known to the control."
        "check the spelling, or read the program with the control that it was written for"
        "fanuc: `G999`";
    Unproven "unproven" []
        "The source has something that no virtual control reports yet."
        "leave it out of the source: what no control reports is not written"
        "A toolpath for a laser";
    UnreachableOrientation "unreachable-orientation" []
        "The rotary axes have no position for this orientation."
        "choose a machine whose axes reach this orientation, or set the part up differently"
        "A tool that points from below on a table of ±110°";
    Unreadable "unreadable" []
        "A file cannot be read."
        "check the name of the file and the right to read it"
        "`toolpost post missing.cls`";
    Unsupported "unsupported" []
        "This is not supported."
        "write this in another way; docs/controls and docs/sources list what is read"
        "apt: `CYCLE/FACE,5`";
    Unterminated "unterminated" []
        "A command of a Gerber file has no end."
        "the file may be cut off: write it again"
        "`X0Y0D01` without `*`";
    UnusedLayers "unused-layers" []
        "Pads of a KiCad board have copper where it is not used."
        "nothing to do"
        "A via with `(remove_unused_layers)`";
    UnusedWord "unused-word" ["nc-unused-word"]
        "A word of the block is used by nothing."
        "remove the word: nothing in this block uses it"
        "linuxcnc: `G0 X1 P5`";
    UpperPlane "upper-plane" []
        "The height of the upper plane is not known, and a block gives U and V."
        "give the height of the upper plane: `height` in [wire] of the machine file, or `--uv-height` for one run"
        "fanuc-wire: `G1 X5. U1. F5.`";
    Urdf "urdf" []
        "The description of an arm (URDF) cannot be read."
        "correct the description: one foot, six revolute joints with limits in a row, a link `tool0` at the flange"
        "Two joints that have one child";
    UvLimit "uv-limit" []
        "The upper end of the wire leaves its travel."
        "give a smaller taper or a lower part, or choose another machine"
        "U 30 on a machine with ±25 mm";
    Variable "variable" []
        "A variable is read before it has a value."
        "define the variable before it is read"
        "`R1=A` before `A` has a value (SINUMERIK)";
    Version "version" []
        "A KiCad board is older or newer than is read."
        "open it in KiCad 6 or newer, and save it"
        "A board of KiCad 4";
    Via "via" []
        "A via of a KiCad board has no copper."
        "vias have a size above 0: correct it in KiCad"
        "`(via (size 0))`";
    Wavelength "wavelength" []
        "The index of a material belongs to another wavelength than that of the laser."
        "add the material with its index at the wavelength of the laser"
        "K9 at 532 nm for a laser of 1064 nm";
    Width "width" []
        "A width of a board file is not above 0."
        "give a width above 0, mm"
        "`width = 0`";
    Wire "wire" ["nc-wire"]
        "The wire is not threaded or cut as the control or the source has it."
        "thread the wire before the first cut, and cut it before it is threaded again"
        "A block that cuts the wire and moves: `M50 G1 X5.`";
    WireHeight "wire-height" []
        "The heights of a wire machine do not fit, or are missing."
        "give the height of the part by `--height`, and that of the plane of U and V by `height` in [wire] or `--uv-height`"
        "`--height` missing for a wire that leans";
    WireLeans "wire-leans" []
        "The wire leans, and the control has no U and V."
        "choose a control with U and V, or a contour without taper"
        "A tapered contour for a control without taper";
    WirePlane "wire-plane" []
        "A point does not lie in the plane of the wire."
        "give the contour in the lower plane, Z 0"
        "Z 5 in a contour of a flat part";
    WireThreaded "wire-threaded" []
        "The wire is threaded already."
        "cut the wire before it is threaded again"
        "A list of moves of other software that threads twice";
    WiresCross "wires-cross" []
        "Two positions of the wire cross each other."
        "lean less, or synchronise the contours by points (`--pair`)"
        "A short upper contour over a long lower one with 20°";
    WorkOffset "work-offset" ["nc-work-offset"]
        "The work offset is not one of the control, not that of the source, or not sure to be active."
        "use the work offset of the toolpath, one that the control has, and name it before the first move"
        "fanuc: `G54.1 P999`";
    ZeroVector "zero-vector" []
        "A direction has no length."
        "give a direction with a length above 0"
        "apt: `MULTAX/ON`, `GOTO/0,0,0,0,0,0`";
    ZerosConcluded "zeros-concluded" []
        "Which zeros a drill file leaves out was concluded from its numbers."
        "nothing to do, if it is right"
        "A drill file with METRIC alone";
    ZoneFill "zone-fill" []
        "A zone of a KiCad board is not filled."
        "fill all zones in KiCad, and save"
        "A zone that was drawn and not filled (key B)";
}
