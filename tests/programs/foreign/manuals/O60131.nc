%
O60131 (G13 G91 CCW EXAMPLE);
(G54 X0 Y0 is center of 1st pocket);
(Z0 is on top of the part);
(T1 is a 0.5 in. dia endmill);
(BEGIN PREPARATION BLOCKS);
T1 M06 (Select tool 1);
G00 G90 G40 G49 G54 (Safe startup);
G00 G54 X0 Y0 (Rapid to 1st position);
S1000 M03 (Spindle on CW);
G43 H01 Z0.1 (Activate tool offset 1);
M08 (Coolant on);
(BEGIN CUTTING BLOCKS);
G13 G91 Z-.5 I.400 K2.0 Q.400 L4 D01 F20.;
(Rough & finish CCW);
(BEGIN COMPLETION BLOCKS);
G00 G90 Z0.1 M09 (Rapid retract, coolant off);
G53 G49 Z0 M05 (Z home, spindle off);
G53 Y0 (Y home);
M30 (End program);
%
