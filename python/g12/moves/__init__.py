# SPDX-License-Identifier: GPL-2.0-or-later
"""What the contours of all sections have in common once they are moves of slides and a C axis.

1. ``exact_stops``: where the tool must stop, because LinuxCNC's blending would cut the corner.
2. ``spacing``: the fewest segments along an element that stay within the tolerance.
3. ``feed``: their F words.
4. ``soft_limits``: whether they stay within the travel of the axes.

LinuxCNC forces the shape of it: with a rotary axis in motion its planner looks ahead by one move
only, so short segments cost speed; F is meant for the linear axes; and the P of G64 does not limit
the blending.
"""
