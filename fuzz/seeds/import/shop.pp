+================================================
+ Own post in the public style
+================================================

POST_NAME = "Shop Grbl (mm) (*.nc)"
FILE_EXTENSION = "nc"
UNITS = "MM"
LINE_ENDING = "[13][10]"
LINE_NUMBER_START     = 0
LINE_NUMBER_INCREMENT = 10
LINE_NUMBER_MAXIMUM = 999999
VAR LINE_NUMBER = [N|A|N|1.0]
VAR SPINDLE_SPEED = [S|A|S|1.0]
VAR FEED_RATE = [F|C|F|1.1]
VAR X_POSITION = [X|C|X|1.4]
VAR Y_POSITION = [Y|C|Y|1.4]
VAR Z_POSITION = [Z|C|Z|1.4]
VAR ARC_CENTRE_I_INC_POSITION = [I|A|I|1.4]
VAR ARC_CENTRE_J_INC_POSITION = [J|A|J|1.4]
VAR X_HOME_POSITION = [XH|A|X|1.4]
VAR Y_HOME_POSITION = [YH|A|Y|1.4]
VAR Z_HOME_POSITION = [ZH|A|Z|1.4]

begin HEADER
"(shop)"
"G17"
"G21"
"G90"
"T[T]"
"[S]M3"
"G0[ZH]"
"G0[XH][YH]"

begin TOOLCHANGE
"M5"
"M6 T[T]"
"M3[S]"

begin RAPID_MOVE
"G0[X][Y][Z]"

begin FIRST_FEED_MOVE
"G1[X][Y][Z][F]"

begin FEED_MOVE
"G1[X][Y][Z]"

begin FIRST_CW_ARC_MOVE
"G2[X][Y][I][J][F]"
begin CW_ARC_MOVE
"G2[X][Y][I][J]"
begin FIRST_CCW_ARC_MOVE
"G3[X][Y][I][J][F]"
begin CCW_ARC_MOVE
"G3[X][Y][I][J]"
begin DWELL_MOVE
"G04 P[DWELL]"
begin FOOTER
"M5"
"G0[ZH]"
"G0[XH][YH]"
"M2"
