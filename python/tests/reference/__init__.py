"""An independent reference: it reads a source and its program, and compares the two motions.

Written from the makers' manuals, it shares nothing with the project but the facts in machine files:
no reader, no kinematics, no rule of the proof. It is small instead of complete. What it does not
know is an error.

Lengths are mm, angles of rotary axes degrees, feeds mm/min, times minutes. A *part* position is a
tool tip in the frame of the work zero, fixed to the part. An *axes* position is where the gauge
line of the spindle is in machine coordinates while the axes of the head are at 0.
"""
