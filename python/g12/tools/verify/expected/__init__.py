# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that the words of a block, a section or a shape's call ask for, by their pages.

One file for each kind. Written from the page of the code, never from the planner: what the two have
in common is the page alone.
"""
