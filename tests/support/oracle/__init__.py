# SPDX-License-Identifier: GPL-2.0-or-later
"""An oracle of the planners: what a reported pocket or section has to move, and what differs.

It shares nothing with the planners but the geometry of lines and arcs. Of a report it takes what
LinuxCNC knew, words, position, modes and frame, and of a section the contour as it was read; the
page of each code says what follows from them.
"""
