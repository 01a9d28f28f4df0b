# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section finds where nothing forbids it to begin: tests replace what they are about."""

from g12.section.effects import SectionModes, SectionStart
from g12.section.line import BlockLocation

START = SectionStart(
    location=BlockLocation("G12.1", 7),
    words={},
    alone=True,
    level=1,
    position={"X": 20.0, "C": 0.0, "Z": 5.0},
    machine_unit=1.0,
    millimetre=1.0,
    offsets={"X": 1.0, "Y": 0.0, "Z": 2.0, "A": 0.0, "B": 0.0, "C": 90.0},
    shifts=dict.fromkeys("XYZ", 0.0),
    modes=SectionModes(False, False, 100.0, 0.0, 10),
    spindle=0,
    speeds=(0.0,),
    tool_radius=None,
    diameter=False,
    yz_plane=False,
    compensated=False,
    offset_pending=False,
    inverse_time=False,
    surface_speed=False,
    rotated=False,
)
