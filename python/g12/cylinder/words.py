# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of a section on a cylinder: Z a length, C an angle, X at right angles to the surface.

The unrolled surface is viewed from outside: C to the right and Z upwards, so G2 is clockwise there
and G41 has the tool on the left, whatever plane is active. An arc's centre is J (or I) along C and
K along Z, both lengths on the surface from the arc's start.
"""

from g12.section.block_rules import NO_TOOL_CHANGE, OWN_RADIUS
from g12.section.line import plain_line_of
from g12.section.words import SectionWords

CYLINDER_WORDS = SectionWords(
    plane="CZX",
    c_is_length=False,
    letters=(("X", "XU"), ("Z", "ZW"), ("C", "CH"), ("the centre along C", "IJ")),
    foreign={"u": "x", "w": "z", "h": "c"},
    relative={"U": "X", "W": "Z", "H": "C"},
    plain=plain_line_of("XCZRF"),
    planes=frozenset({170, 180, 190}),
    plane_name="Z-C",
    centre_name="J and K",
    refused={
        **dict.fromkeys("ABVY@^", "the section's words are Z, C, X, W, H and U"),
        "T": NO_TOOL_CHANGE,
        "D": OWN_RADIUS,
    },
    own_block="X needs a block of its own, or [G12] CYLINDER_X = allow",
    origin="the origin must stay where it is inside the section",
)
