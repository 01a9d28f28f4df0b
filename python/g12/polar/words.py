# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of a polar section: lengths in the flat X-C plane, and Z at right angles to it."""

from __future__ import annotations

from g12.section.block_rules import NO_TOOL_CHANGE, OWN_RADIUS
from g12.section.line import plain_line_of
from g12.section.words import SectionWords

POLAR_WORDS = SectionWords(
    plane="XCZ",
    c_is_length=True,
    letters=(("X", "XU"), ("C", "CYH")),
    foreign={"u": "x", "h": "c", "y": "c"},
    relative={"U": "X", "H": "C"},
    plain=plain_line_of("XCZIJRF"),
    planes=frozenset({170, 180}),
    plane_name="X-C",
    centre_name="I and J",
    refused={
        **dict.fromkeys("ABVW@^", "the section's words are X, C (or Y), Z, U and H"),
        "T": NO_TOOL_CHANGE,
        "D": OWN_RADIUS,
        "K": "the centre of an arc in the X-C plane is I and J",
    },
    own_block="Z needs a block of its own, or [G12] POLAR_Z = allow",
    origin="the origin must stay in the spindle's centre",
)
