%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE MOD_Calls(NOSTEPIN)
LOCAL PERS tooldata t:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
CONST robtarget p:=[[1,2,3],[0,0,1,0],[-1,0,1,4],[9E9,9E+09,9E9,9E9,9E9,9E9]];
! a comment
PROC main()
VAR num n:=2;
SingArea\Off;
CirPathMode\ObjectFrame;
sub;
n:=(n+1)*3 DIV 2;
t.tframe.trans.z:=150;
MoveL Offs(p,n,0,5),v100\V:=20,z5\Z:=2,t,\WObj:=wobj0;
MoveC RelTool(p,1,1,0\Rz:=10),Offs(p,9,0,0),v100,[FALSE,0.1,0.1,0.1,1,0.1,1],t;
ChangeTool 2;
SetAO AO10_1,0.5;
WaitDI D_IN_5,1;
TPWrite "two "" marks";
EXIT;
ENDPROC
PROC sub()
AccSet 50,100;
RETURN;
ENDPROC
ENDMODULE
