# SPDX-License-Identifier: GPL-2.0-or-later
"""Every tolerance of a comparison, with its reason. Lengths mm, areas mm², angles degrees."""

WALL = 0.005  # of a pocket's toolpath: a tenth of what a tool's diameter is measured to
RUN = 0.001  # added for a run: one servo period at a usual feed, and the joint's resolution
AREA = 0.01  # less material than this is rounding of chords
LEVEL = 1e-3  # of a Z level: words have three decimals
FEED = 0.002  # relative, of a section: a trace prints nine decimals of feeds beside C in degrees
STATE = 1e-5  # relative: a trace prints nine decimals
ANGLE = 0.01  # of C after a section
WEAR = 0.05  # of a cutter's diameter: D may differ from the loaded tool by an allowance for wear
SIZE = 1e-4  # of a diameter or a level: less is no difference
JOINT = 0.001  # of what a segment makes of a toolpath: its ends lie so near to their places
LAST_DECIMAL = 0.0005  # added for a section: arcs whose words are rounded do not close any better
