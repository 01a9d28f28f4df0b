# SPDX-License-Identifier: GPL-2.0-or-later
"""From a tool-centre path to the moves of slides and a rotary axis: what all sections share.

1. ``setup``: what a kind of section takes from the machine, the order in which it is planned, its
   travel.
2. ``exact_stops``: where the tool must stop, because LinuxCNC's blending would cut the corner.
3. ``steps``: the moves of a plan: the fewest segments along an element that stay within the
   tolerance, and their F words.

LinuxCNC's planner is the reason for most. With a rotary axis in motion it looks ahead by one move
only, so short segments cost speed. F applies to the linear axes. The P of G64 does not limit the
blending.
"""
