# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 circular cutting, dialect mitsubishi: words and modes in, one checked circle out.

The motions of `ngc/g12_mitsubishi.ngc`, in the plane of G17, G18 or G19, from the tool's position,
which is the centre:

1. half circle out along the plane's first axis (X, Z, Y), in the direction of the cut
2. full circle
3. half circle back to the centre

Rules, in the order of the checks: the modes and words of `check_block`, in G17, G18 or G19; I
required; D required, whole, from 0, in the tool table; I, whose sign is ignored,
greater than the offset. A negative diameter in the tool table enlarges the circle.
"""

from g12.cut_report import PocketCut
from g12.cycles.plan import CyclePlan
from g12.request import Words
from g12.settings import Settings
from g12.state import XY, XZ, YZ

MITSUBISHI_WORDS = "I D F"
FIRST_AXIS = {XY: "x", XZ: "z", YZ: "y"}
AXIS_ACROSS = {XY: "z", XZ: "y", YZ: "x"}


def plan(words: Words, arc: int, _: Settings) -> CyclePlan:
    context = words.context
    words.check_block(MITSUBISHI_WORDS, planes=tuple(FIRST_AXIS))
    commanded = words.require("I", "the radius of the circle")
    cutter = words.offset_cutter()
    if not cutter:
        raise words.refuse("D is missing: the tool whose radius reduces the circle, D0 for none")
    words.check_fits("I", commanded, cutter.radius, cutter.source)
    wall, radius = abs(commanded), abs(commanded) - cutter.radius
    numbers = {
        "plane": int(context.plane[1:]),
        "centre": getattr(context, FIRST_AXIS[context.plane]),
        "radius": radius,
        "arc": arc,
    }
    words.check_travel(context.xyz, radius)
    level, inner = getattr(context, AXIS_ACROSS[context.plane]), radius - cutter.radius
    cut = PocketCut(context.plane, context.xyz, wall, wall, 0.0, inner, (level,), cutter.used)
    return CyclePlan(numbers, cut, cutter)
