/PROG  JOB
/ATTR
OWNER		= MNEDITOR;
LINE_COUNT	= 11;
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 20% FINE    ;
   4:  DO[1]=ON ;
   5:  WAIT   2.00(sec) ;
   6:L P[2] 30cm/min FINE    ;
   7:L P[3] 120cm/min CNT10    ;
   8:C P[3]
    :  P[4] 120cm/min FINE    ;
   9:L P[2] 100mm/sec CR3 ACC80    ;
  10:  DO[1]=OFF ;
  11:  WAIT   1.00(sec) ;
/POS
P[1]{
   GP1:
	UF : 1, UT : 1,
	J1=     0.000 deg,	J2=    23.408 deg,	J3=   -42.993 deg,
	J4=     0.000 deg,	J5=   -47.007 deg,	J6=     0.000 deg,
	E1=   250.000  mm
};
P[2]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg,
	E1=   250.000  mm
};
P[3]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    74.142  mm,	Y =     5.858  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg,
	E1=   250.000  mm
};
P[4]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'F D B, 1, -1, 0',
	X =    80.000  mm,	Y =    20.000  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg,
	E1=   250.000  mm
};
/END
