# SPDX-License-Identifier: GPL-2.0-or-later
"""Cylindrical interpolation: a contour on the unrolled surface becomes moves of Z and a C axis.

The surface of radius r is flat in C as a length, r times the angle, and Z; X is at right angles to
it. Both are proportional to what the axes do, so a line is one move of Z and C; only arcs are made
of segments. What a section means, its compensation and what its moves have in common with polar
mode is elsewhere (`section`, `compensation`, `moves`).
"""
