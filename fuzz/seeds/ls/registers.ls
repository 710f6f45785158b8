/PROG  JOB
/ATTR
OWNER		= MNEDITOR;
LINE_COUNT	= 11;
/MN
   1:  !text ;
   2:  R[1:speed]=100+20-(-5) ;
   3:  PR[9,1]=(-30.000) ;
   4:  PR[9,2]=R[1] ;
   5:  PR[9,3]=R[1]/2*3 ;
   6:  PR[9,4]=0 ;
   7:  PR[9,5]=0 ;
   8:  PR[9,6]=90 ;
   9:  UFRAME[1]=PR[9] ;
  10:  UTOOL[1]=PR[9] ;
  11:  UFRAME_NUM=1 ;
  12:  UTOOL_NUM=1 ;
  13:L P[2] R[1]mm/sec FINE Wjnt ;
  14:  AO[1]=500 ;
  15:  WAIT DI[5:gate]=OFF ;
  16:  MESSAGE[text] ;
  17:  //L P[3] 1mm/sec FINE ;
  18:  CALL CHANGE(2) ;
  19:  LBL[1] ;
  20:  PAUSE ;
  21:  END ;
/POS
P[1]{
   GP1:
	UF : 1, UT : 1,
	J1=     0.000 deg,	J2=    23.408 deg,	J3=   -42.993 deg,
	J4=     0.000 deg,	J5=   -47.007 deg,	J6=     0.000 deg
};
P[2]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =     0.000  mm,	Y =     0.000  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =    74.142  mm,	Y =     5.858  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[4]{
   GP1:
	UF : 1, UT : 1,		CONFIG : 'F D B, 1, -1, 0',
	X =    80.000  mm,	Y =    20.000  mm,	Z =    -2.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
