MODULE Job
  PERS tooldata tSp:=[TRUE,[[0,0,150],[1,0,0,0]],[1.5,[0,0,75],[1,0,0,0],0,0,0]];
PERS wobjdata wPart:=[FALSE,TRUE,"",[[450,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
CONST speeddata vPlunge:=[5,500,5000,1000];
  CONST speeddata vCut:=[20,500,5000,1000];
CONST jointtarget jStart:=[[0,34.622,-4.659,0,60.037,0],[250,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p1:=[[0,0,-2],[0,0,1,0],[0,0,0,0],[250,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p2:=[[60,0,-2],[0,0,1,0],[0,0,0,0],[250,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p3:=[[74.142,5.858,-2],[0,0,1,0],[0,0,0,0],[250,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p4:=[[80,20,-2],[0,0,1,0],[0,0,0,0],[250,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p5:=[[80,20,50],[0,0,1,0],[0,0,0,0],[250,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfL\Off;
MoveAbsJ jStart,v50,fine,tSp\WObj:=wPart;
    SetDO doSpindle,1;
    WaitTime 2;
MoveL p1,vPlunge,fine,tSp\WObj:=wPart;
    MoveL p2,vCut,z1,tSp\WObj:=wPart;
MoveC p3,p4,vCut,fine,tSp\WObj:=wPart;
    MoveL p5,v100,fine,tSp\WObj:=wPart;
    SetDO doSpindle,0;
WaitTime 1;
  ENDPROC
ENDMODULE
