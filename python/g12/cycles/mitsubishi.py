# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 circular cutting, dialect mitsubishi: words and modes in, one checked circle out.

The motions of `ngc/g12_mitsubishi.ngc`, in the plane of G17, G18 or G19, from the tool's position,
which is the centre:

1. half circle out along the plane's first axis (X, Z, Y), in the direction of the cut
2. full circle
3. half circle back to the centre

Rules, in the order of the checks: G17, G18 or G19 and the modes of `check_modes`; every word known;
`check_start`; I required; D required, whole, from 0, in the tool table; I, whose sign is ignored,
greater than the offset. A negative diameter in the tool table enlarges the circle.
"""

from g12.cut_report import BY_D, PocketCut, UsedCutter
from g12.cycles.plan import CyclePlan
from g12.request import (
    CycleExtent,
    Words,
    check_fits,
    check_modes,
    check_start,
    commanded_tool,
    other_cutter,
)
from g12.state import XY, XZ, YZ

MITSUBISHI_WORDS = "I D F"
FIRST_AXIS = {XY: "x", XZ: "z", YZ: "y"}
AXIS_ACROSS = {XY: "z", XZ: "y", YZ: "x"}


def plan_circle(words: Words) -> CyclePlan:
    context, other = words.context, other_cutter(words)
    check_modes(words, planes=tuple(FIRST_AXIS))
    words.check_known(MITSUBISHI_WORDS)
    check_start(words)
    commanded = words.require("I", "the radius of the circle")
    tool = commanded_tool(words)
    if tool is None:
        raise words.refuse("D is missing: the tool whose radius reduces the circle, D0 for none")
    check_fits(words, "I", commanded, tool.radius, f"D{tool.number}")
    radius = abs(commanded) - tool.radius
    numbers = {
        "plane": int(context.plane[1:]),
        "centre": getattr(context, FIRST_AXIS[context.plane]),
        "radius": radius,
    }
    extent = CycleExtent(context.plane, context.xyz, radius)

    def cut() -> PocketCut:
        return PocketCut(
            plane=context.plane,
            centre=context.xyz,
            wall=abs(commanded),
            first=abs(commanded),
            step=0.0,
            inner=radius - tool.radius,
            levels=(getattr(context, AXIS_ACROSS[context.plane]),),
            cutter=UsedCutter(tool.radius, BY_D, tool.number),
        )

    return CyclePlan(numbers, extent, cut, other_cutter=other)
