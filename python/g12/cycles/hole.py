# SPDX-License-Identifier: GPL-2.0-or-later
"""What bore, thread and frame share: centre, top and floor, the cutter, the turns of a helix.

Lengths are in program units.
"""

from math import ceil, cos, pi, sin
from typing import NamedTuple

from g12.cycles.cutter import Cutter, chosen_cutter
from g12.errors import number
from g12.request.common import COUNTERCLOCKWISE, check_modes, check_start
from g12.request.words import Words

CLEARANCE_MM, CLEARANCE_INCH = 1.0, 0.04  # of the rapid down, above the top
WHOLE_TURN = 1e-5  # a smaller part of a turn is rounding: its arc would be a full circle


class Hole(NamedTuple):
    """Centre, the Z where the block begins, the end of the rapid down, top and floor."""

    x: float
    y: float
    start: float
    clear: float
    top: float
    z: float

    @property
    def depth(self) -> float:
        return self.top - self.z


def check_block(words: Words, known: str) -> None:
    check_modes(words)
    words.check_known(known)
    if "X" not in words and "Y" not in words:
        check_start(words)


def hole_of(words: Words, top: float | None = None) -> Hole:
    """Return where the cycle cuts; under G91 its Z counts from the top, which is R or ``top``."""
    context = words.context
    x = context.absolute(words.take("X"), context.x)
    y = context.absolute(words.take("Y"), context.y)
    depth = words.require("Z", "the depth")
    if top is None:
        given = words.take("R")
        top = context.absolute(given, context.z)
        if given is not None and top > context.z + context.rounding:
            rule = f"puts the top above the tool at Z{number(context.z)}: retract first"
            raise words.refuse_word("R", given, rule)
    z = top + depth if context.incremental else depth
    if z >= top - context.smallest_ring:
        raise words.refuse_word("Z", depth, f"must be below the top, Z{number(top)}")
    clearance = CLEARANCE_INCH if context.inch else CLEARANCE_MM
    return Hole(x, y, context.z, min(context.z, top + clearance), top, z)


def sized_cutter(words: Words) -> Cutter:
    """Return the cutter of the block, which must have a diameter."""
    cutter = chosen_cutter(words)
    if not cutter.radius:
        raise words.refuse(f"{cutter.source} has no diameter: it sets the path")
    return cutter


def turns_of(height: float, pitch: float, arc: int) -> dict[str, float]:
    """Return the locals of one helix from +X: turns begun, direction of its end from the centre."""
    turns = height / pitch
    if abs(turns - round(turns)) < WHOLE_TURN:
        turns = max(1, round(turns))
    angle = 2 * pi * (turns % 1) * (1 if arc == COUNTERCLOCKWISE else -1)
    return {"rounds": ceil(turns), "turn_x": cos(angle), "turn_y": sin(angle)}
