# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar coordinate interpolation: a flat X-C contour becomes moves of an X slide and a C axis.

A section is collected in a :class:`~g12.flat.contour.Contour`, then planned as a whole by
:func:`~g12.polar.plan.plan`; what cannot be cut is refused there, before anything moves. Lengths
are in program units throughout.

1. ``contour``: blocks become lines and arcs, in the flat plane.
2. ``simplify``: those under compensation that are only rounding are left out.
3. ``offset``: cutter compensation makes them the path of the tool's centre; ``gouge`` tests it.
4. ``pole``: moves that touch the spindle's centre end there.
5. ``exact_stops``: where the tool must stop, because LinuxCNC's blending would cut the corner.
6. ``pieces``: the fewest straight moves in X and C that stay within the tolerance.
7. ``feed``: their F words.

LinuxCNC forces the shape of it: with a rotary axis in motion its planner looks ahead by one move
only, so short pieces cost speed; F is meant for the linear axes; and the P of G64 does not limit
the blending.
"""
