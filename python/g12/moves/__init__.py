# SPDX-License-Identifier: GPL-2.0-or-later
"""From a tool-centre path to the moves of slides and a C axis: what all sections share.

1. ``exact_stops``: where the tool must stop, because LinuxCNC's blending would cut the corner.
2. ``spacing``: the fewest segments along an element that stay within the tolerance.
3. ``feed``: their F words.
4. ``soft_limits``: whether they stay within the travel of the axes.

LinuxCNC's planner is the reason for each. With a rotary axis in motion it looks ahead by one move
only, so short segments cost speed. F applies to the linear axes. The P of G64 does not limit the
blending.
"""
