# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar coordinate interpolation: a flat X-C contour becomes moves of an X slide and a C axis.

A section is collected in a `g12.compensation.contour.Contour`, then planned as a whole by
`polar_section.Polar`; what cannot be cut is refused there, before anything moves. Lengths are in
program units throughout.

1. `g12.compensation`: blocks become lines and arcs in the flat plane, then the path of the tool's
   centre.
2. ``pole``: moves that touch the spindle's centre end there; the path of a tool beside the X line
   stays clear of it.
3. `g12.moves.exact_stops`: where the tool must stop.
4. ``face``: moves that LinuxCNC plans itself as lines and arcs, with the kinematics of the face;
   ``quickest`` chooses which.
5. ``segments``: of the rest the fewest straight moves in X and C that stay within the tolerance;
   `g12.moves.steps`: their F words.
"""
