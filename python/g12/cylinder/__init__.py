# SPDX-License-Identifier: GPL-2.0-or-later
"""Cylindrical interpolation: a contour on the unrolled surface becomes moves of Z and a C axis.

The surface of radius r is flat in C as a length, r times the angle, and Z; X is at right angles to
it. Both are proportional to the axes' positions, so a line is one move of Z and C; only arcs are
split into segments. `section`, `compensation` and `moves` hold what polar mode shares.
"""
