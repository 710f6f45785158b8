; SAMPLE
G21
G90
G17
G54
; What every machine with three axes can make: a slot with a round end  a
; holes. The programs beside it are what the machines of the library run 
; SLOT
M5
M9
G53 G0 Z200
T1
; MILL_6
M3 S3000
G0 X10 Y10
G0 Z20
G0 Z2
G1 Z-2 F200
G1 X40 F600
G3 Y30 I0 J10
G1 X10
G4 P500
G0 Z5
; RING
G0 X32.5 Y20
G0 Z1
G2 X32.5 Y20 Z-1 I-2.5 J0 F300
G2 X32.5 Y20 I-2.5 J0
G0 Z20
; HOLES
M5
M9
G53 G0 Z200
T2
; DRILL_3.3
; its tip must stand where the last one stood
M0 Change the tool by hand
M3 S2500
G0 X15 Y20
G0 Z20
G0 Z5
G0 Z2
G1 Z-6 F150
G0 Z5
G0 X22
G0 Z2
G1 Z-5
G0 Z2
G0 Z-4.5
G1 Z-10
G0 Z2
G0 Z-9.5
G1 Z-12
G0 Z5
G0 Z20
M5
M5
M9
G53 G0 Z200
