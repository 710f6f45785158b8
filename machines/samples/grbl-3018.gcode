(SAMPLE)
(T1 MILL_6 D6)
(T2 DRILL_3.3 D3.3)
G21 G17 G40 G49 G90 G94 G54
(What every machine with three axes can...)
(holes. The programs beside it are what the...)
(SLOT)
M5
(fit the tool, and set Z 0 with it)
(Z goes up next: see that there is room)
M0
G0 Z21
T1
(MILL_6)
S3000 M3
G4 P2
G0 X10 Y10
Z20
Z2
G1 Z-2 F200
X40 F600
G3 Y30 I0 J10
G1 X10
G4 P0.5
G0 Z5
(RING)
X32.5 Y20
Z1
G2 X32.5 Y20 Z-1 I-2.5 J0 F300
X32.5 Y20 I-2.5 J0
G0 Z20
(HOLES)
G0 Z21
M5
T2
(DRILL_3.3)
(change the tool by hand; its tip must stand where the last one stood)
M0
S2500 M3
G4 P2
G0 X15 Y20
Z20
Z5
Z2
G1 Z-6 F150
G0 Z5
X22
Z2
G1 Z-5
G0 Z2
Z-4.5
G1 Z-10
G0 Z2
Z-9.5
G1 Z-12
G0 Z5
Z20
M5
G0 Z21
M30
