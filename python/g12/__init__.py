# SPDX-License-Identifier: GPL-2.0-or-later
"""The G12 family for LinuxCNC: circular pockets, circle mill event, polar interpolation.

Data flow of one block, in one direction::

    words and modes -> request -> named locals -> motion
    (host)             (cycles)   (host)          (ngc/)

and of one section, whose lines the host reads by itself::

    start -> setup -> lines ->  contour ->     toolpath ->     moves of X and C
    (host)   (polar)  (section) (compensation) (compensation)  (polar; executed by host)

The planners (`cycles`, `section`, `compensation`, `polar`) are pure: numbers in, values out, no
LinuxCNC.
README.md beside this file describes the rooms, and the path of a block and a section through them.
Lengths are in program units unless a docstring has another unit, angles in radians.
"""

__version__ = "0.1.0"
