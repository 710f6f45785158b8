1G21 G90
F100
#<_depth>=[-2.5 + ABS[#100]] #101=[3 MOD 2]
o<hole> sub
  o10 if [#3 LT 0]
    G0 X#1 Y#2 Z[#3 ** 2]
  o10 elseif [EXISTS[#<_depth>] AND #4]
    G1 Z#<_depth>
    o<hole> return [#<_z>]
  o10 else
    (debug, no hole at #1 #2)
  o10 endif
o<hole> endsub [1]
#1=0
o100 while [#1 LE 3]
  #1=[#1 + 1]
  o101 if [#1 EQ 2]
    o100 continue
  o101 endif
  o<hole> call [#1 * 10] [ATAN[1]/[2]] [-1] [1]
  G1 X#<_value> Y[SIN[30]] Z-#1
o100 endwhile
o200 repeat [2]
  G91 X1
o200 endrepeat
o300 do
  #2=[#2+1]
  o300 break
o300 while [#2 LT 5]
M73
M98 P500 L2
M2
o500
G0 X##1
M99
