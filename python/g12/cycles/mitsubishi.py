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

from typing import NamedTuple

from g12.errors import number
from g12.lengths import ROUNDING_MM
from g12.request.common import SMALLEST_RING_MM, check_modes, check_start, commanded_tool
from g12.request.context import XY, XZ, YZ, Context, Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words

MITSUBISHI_WORDS = "I D F"
FIRST_AXIS = {XY: "x", XZ: "z", YZ: "y"}


class MitsubishiCircle(NamedTuple):
    """A checked circle: the named locals of `ngc/g12_mitsubishi.ngc`.

    ``plane`` is 17, 18 or 19, ``centre`` a coordinate of the plane's first axis, ``radius`` the
    tool centre's, in program units.
    """

    plane: int
    centre: float
    radius: float

    def extent(self, context: Context) -> CycleExtent:
        centre = (context.x, context.y, context.z)
        return CycleExtent(context.plane, centre, self.radius)


def plan_circle(words: Words, context: Context) -> MitsubishiCircle:
    check_modes(words, context, planes=tuple(FIRST_AXIS))
    words.check_known(MITSUBISHI_WORDS)
    check_start(words, context)
    radius = words.require("I", "the radius of the circle")
    tool = commanded_tool(words, context)
    if tool is None:
        raise words.refuse("D is missing: the tool whose radius reduces the circle, D0 for none")
    check_radius(words, context, radius, tool)
    return MitsubishiCircle(
        plane=int(context.plane[1:]),
        centre=getattr(context, FIRST_AXIS[context.plane]),
        radius=abs(radius) - tool.radius,
    )


def check_radius(words: Words, context: Context, radius: float, tool: Tool) -> None:
    smallest = context.length(SMALLEST_RING_MM)
    if abs(radius) - tool.radius < smallest - context.length(ROUNDING_MM):
        raise words.refuse(
            f"I{number(radius)} must be greater than the tool radius"
            f" {context.tool_size(tool.radius)} (D{tool.number}) by at least {number(smallest)}"
        )
