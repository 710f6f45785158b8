/PROG SAMPLEROBOT
/ATTR
OWNER = MNEDITOR;
COMMENT = "TOOLPOST";
PROG_SIZE = 0;
CREATE = DATE 25-01-01 TIME 12:00:00;
MODIFIED = DATE 25-01-01 TIME 12:00:00;
FILE_NAME = ;
VERSION = 0;
LINE_COUNT = 63;
MEMORY_SIZE = 0;
PROTECT = READ_WRITE;
TCD: STACK_SIZE = 0,
TASK_PRIORITY = 50,
TIME_SLICE = 0,
BUSY_LAMP_OFF = 0,
ABORT_REQUEST = 0,
PAUSE_REQUEST = 0;
DEFAULT_GROUP = 1,*,*,*,*;
CONTROL_CODE = 00000000 00000000;
/MN
1:!What each robot of the... ;
2:!CONTOUR ;
3:PR[9,1]=1400.000 ;
4:PR[9,2]=0.000 ;
5:PR[9,3]=-300.000 ;
6:PR[9,4]=0.0000 ;
7:PR[9,5]=0.0000 ;
8:PR[9,6]=0.0000 ;
9:UFRAME[9]=PR[9] ;
10:PR[9,1]=0.000 ;
11:PR[9,2]=0.000 ;
12:PR[9,3]=150.000 ;
13:PR[9,4]=0.0000 ;
14:PR[9,5]=0.0000 ;
15:PR[9,6]=0.0000 ;
16:UTOOL[9]=PR[9] ;
17:UFRAME_NUM=9 ;
18:UTOOL_NUM=9 ;
19:J P[1] 20% FINE ;
20:J P[2] 20% FINE ;
21:L P[3] 600cm/min FINE ;
22:L P[4] 600cm/min FINE ;
23:AO[1]=500 ;
24:DO[1]=ON ;
25:WAIT 3.00(sec) ;
26:DO[2]=ON ;
27:L P[5] 30cm/min FINE ;
28:L P[6] 120cm/min FINE ;
29:C P[7]
: P[8] 120cm/min FINE ;
30:L P[9] 120cm/min FINE ;
31:C P[10]
: P[11] 120cm/min FINE ;
32:C P[12]
: P[13] 120cm/min FINE ;
33:L P[14] 30cm/min FINE ;
34:L P[15] 120cm/min FINE ;
35:L P[16] 120cm/min FINE ;
36:L P[17] 600cm/min FINE ;
37:WAIT 0.50(sec) ;
38:!TILTED ;
39:L P[18] 600cm/min FINE ;
40:L P[19] 600cm/min FINE ;
41:L P[20] 60cm/min FINE ;
42:L P[21] 60cm/min FINE ;
43:L P[22] 60cm/min FINE ;
44:J P[23] 20% FINE ;
45:DO[2]=OFF ;
46:!HOLES ;
47:L P[24] 600cm/min FINE ;
48:L P[25] 600cm/min FINE ;
49:L P[26] 15cm/min FINE ;
50:J P[27] 20% FINE ;
51:J P[28] 20% FINE ;
52:J P[29] 20% FINE ;
53:L P[30] 15cm/min FINE ;
54:J P[31] 20% FINE ;
55:J P[32] 20% FINE ;
56:L P[33] 15cm/min FINE ;
57:J P[34] 20% FINE ;
58:J P[35] 20% FINE ;
59:L P[36] 15cm/min FINE ;
60:J P[37] 20% FINE ;
61:L P[38] 600cm/min FINE ;
62:DO[1]=OFF ;
63:J P[39] 20% FINE ;
/POS
P[1]{
GP1:
UF : 9, UT : 9,
J1= 0.0000 deg, J2= 0.0000 deg, J3= 0.0000 deg,
J4= 0.0000 deg, J5= -90.0000 deg, J6= 0.0000 deg
};
P[2]{
GP1:
UF : 9, UT : 9,
J1= 0.0000 deg, J2= 10.3520 deg, J3= -56.4560 deg,
J4= 0.0000 deg, J5= -33.5440 deg, J6= 0.0000 deg
};
P[3]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 0.000 mm, Z = 30.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[4]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 0.000 mm, Z = 2.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[5]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 0.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[6]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 60.000 mm, Y = 0.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[7]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 74.142 mm, Y = 5.858 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[8]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 80.000 mm, Y = 20.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[9]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 80.000 mm, Y = 40.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[10]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 74.142 mm, Y = 54.142 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[11]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 60.000 mm, Y = 60.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[12]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 45.858 mm, Y = 54.142 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[13]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 40.000 mm, Y = 40.000 mm, Z = -1.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[14]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 40.000 mm, Y = 40.000 mm, Z = -2.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[15]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 40.000 mm, Z = -2.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[16]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 0.000 mm, Z = -2.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[17]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 0.000 mm, Z = 30.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[18]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 60.000 mm, Z = 30.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[19]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 60.000 mm, Z = 5.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[20]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 0.000 mm, Y = 60.000 mm, Z = 0.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[21]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 40.000 mm, Y = 60.000 mm, Z = 0.000 mm,
W = 170.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[22]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 80.000 mm, Y = 60.000 mm, Z = 0.000 mm,
W = 160.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[23]{
GP1:
UF : 9, UT : 9,
J1= 7.3794 deg, J2= 16.8721 deg, J3= -58.0445 deg,
J4= 32.3932 deg, J5= -39.2818 deg, J6= -34.0026 deg
};
P[24]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 20.000 mm, Y = 20.000 mm, Z = 30.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[25]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 20.000 mm, Y = 20.000 mm, Z = 2.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[26]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 20.000 mm, Y = 20.000 mm, Z = -4.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[27]{
GP1:
UF : 9, UT : 9,
J1= 0.8069 deg, J2= 13.1790 deg, J3= -58.3584 deg,
J4= 0.0000 deg, J5= -31.6416 deg, J6= -0.8069 deg
};
P[28]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 13.6112 deg, J3= -58.2338 deg,
J4= 0.0000 deg, J5= -31.7662 deg, J6= -0.8013 deg
};
P[29]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 13.9994 deg, J3= -58.6503 deg,
J4= 0.0000 deg, J5= -31.3497 deg, J6= -0.8013 deg
};
P[30]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 30.000 mm, Y = 20.000 mm, Z = -2.500 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[31]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 13.9994 deg, J3= -58.6503 deg,
J4= 0.0000 deg, J5= -31.3497 deg, J6= -0.8013 deg
};
P[32]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 14.1944 deg, J3= -58.8583 deg,
J4= 0.0000 deg, J5= -31.1417 deg, J6= -0.8013 deg
};
P[33]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 30.000 mm, Y = 20.000 mm, Z = -5.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[34]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 13.9994 deg, J3= -58.6503 deg,
J4= 0.0000 deg, J5= -31.3497 deg, J6= -0.8013 deg
};
P[35]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 14.3166 deg, J3= -58.9882 deg,
J4= 0.0000 deg, J5= -31.0118 deg, J6= -0.8013 deg
};
P[36]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 30.000 mm, Y = 20.000 mm, Z = -6.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[37]{
GP1:
UF : 9, UT : 9,
J1= 0.8013 deg, J2= 13.6112 deg, J3= -58.2338 deg,
J4= 0.0000 deg, J5= -31.7662 deg, J6= -0.8013 deg
};
P[38]{
GP1:
UF : 9, UT : 9, CONFIG : 'N U T, 0, 0, 0',
X = 30.000 mm, Y = 20.000 mm, Z = 50.000 mm,
W = 180.0000 deg, P = 0.0000 deg, R = 0.0000 deg
};
P[39]{
GP1:
UF : 9, UT : 9,
J1= 0.0000 deg, J2= 0.0000 deg, J3= 0.0000 deg,
J4= 0.0000 deg, J5= -90.0000 deg, J6= 0.0000 deg
};
/END
