# SPDX-License-Identifier: GPL-2.0-or-later
"""The G12 family for LinuxCNC: circular pockets, circle mill event, polar interpolation.

Data flow of one block, one way only::

    words and modes -> request -> named locals -> motion
    (host, words)      (haas)     (host)          (ngc/)

The planners (`haas`, `geometry`, `polar`) are pure: numbers in, values out, no LinuxCNC.
Lengths are in program units unless a docstring says otherwise, angles in radians.
"""
