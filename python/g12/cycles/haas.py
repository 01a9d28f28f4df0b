# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 circular pocket, dialect haas: words and modes in, one checked pocket out.

Source: Haas Mill Operator's Manual, "G12 Circular Pocket Milling CW / G13 CCW".

The motions of `ngc/g12_haas.ngc`, per level:

1. with X or Y in the block: rapid to the centre at the present Z (before the first level)
2. feed to the level's Z in the centre; without Z in the block it is the present one. Or, with a
   helix (`ngc/g12_helix.ngc`), in place of 2 to 4: a half circle onto it, down along it (`entry`),
   one full circle, and a half turn onto the first ring, if that is larger
3. half circle from the centre to (+b, 0), in the direction of the cut, tangent to the ring
4. full circle of radius b
5. for each further ring: a tangent link outward, then its full circle; the last is K exactly
6. tangent half circle back to the centre; Z stays at depth after the last level

A tool-centre radius b is the programmed radius less the tool radius.

Rules, in the order of the checks: G17 and the modes of `check_modes`; every word known; I
required; K and Q together, both above 0; L whole, from 1; without X and Y `check_start`; D whole,
from 0, in the tool table, or a cutter known without it; I above 0, greater than the tool radius by
a ring that can be cut, less than K; not too many circles; a helix of not too many turns.
"""

from typing import NamedTuple

from g12.cycles.entry import STRAIGHT_DOWN, PocketDescent, PocketEntry, pocket_descent
from g12.errors import number
from g12.lengths import ROUNDING_MM
from g12.request.common import (
    CLEARED,
    SMALLEST_RING_MM,
    check_count,
    check_modes,
    check_start,
    commanded_tool,
    coordinate,
    sound_tool,
    steps_between,
)
from g12.request.context import XY, Context, Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words

HAAS_WORDS = "X Y Z I K Q L D F"


class Pocket(NamedTuple):
    """A checked pocket. Lengths in program units, radii of the tool centre."""

    x: float
    y: float
    move_to_centre: bool
    z: float  # depth of the first level
    z_step: float  # signed distance to each further level, 0 for spring passes
    levels: int
    first_radius: float
    last_radius: float
    links: int  # stepovers, or half turns of the spiral; the last ends at last_radius
    first_grow: float  # growth of the radius by the first link
    shrink: float  # the share of that by which the last of several is shorter
    spiral: bool
    down: PocketDescent
    commanded_radius: float | None  # of the cutter that D names, None without D
    message: str | None  # for the operator, never a refusal

    def extent(self) -> CycleExtent:
        """Return the largest circle, and the first and last depth."""
        deepest = self.z + self.z_step * (self.levels - 1)
        return CycleExtent(XY, (self.x, self.y, self.z), self.last_radius, (self.z, deepest))

    def locals(self) -> dict[str, float]:
        """Return the named locals of `ngc/g12_haas.ngc`, but for the direction."""
        goes_on = not self.z_step or self.down.further.turns
        return {
            "x": self.x,
            "y": self.y,
            "move_to_centre": self.move_to_centre,
            "z": self.z,
            "z_step": self.z_step,
            "levels": self.levels,
            "first_radius": self.first_radius,
            "links": self.links,
            "step": self.first_grow,
            "shorter": self.shrink * self.first_grow,
            "restart": not goes_on,
            "rings": not self.spiral,
            **self.down.locals(self.first_radius),
        }


def plan_pocket(
    words: Words, context: Context, clearing: str = "rings", entry: PocketEntry = STRAIGHT_DOWN
) -> Pocket:
    check_modes(words, context)
    words.check_known(HAAS_WORDS)
    first = words.require("I", "the radius of the first circle")
    outward = words.take_pair("K", "Q")
    levels = words.take_whole("L", least=1, default=1)
    centre_word = "X" in words or "Y" in words
    x = coordinate(words.take("X"), context.x, context)
    y = coordinate(words.take("Y"), context.y, context)
    depth = words.take("Z")
    if not centre_word:
        check_start(words, context)
    with_d = "D" in words
    cutter, source = choose_cutter(words, context)
    check_radii(words, context, first, outward, cutter, source)

    finished, links, first_grow, shrink = links_outward(
        words, first, outward, clearing, levels, context
    )
    z = coordinate(depth, context.z, context)
    z_step = depth or 0.0 if context.incremental else 0.0
    heights = context.z - z, -z_step
    down = pocket_descent(words, context, entry, first - cutter.radius, cutter.radius, heights)
    return Pocket(
        x=x,
        y=y,
        move_to_centre=centre_word,
        z=z,
        z_step=z_step,
        levels=levels,
        first_radius=first - cutter.radius,
        last_radius=finished - cutter.radius,
        links=links,
        first_grow=first_grow,
        shrink=shrink,
        spiral=clearing == "spiral",
        down=down,
        commanded_radius=cutter.radius if with_d else None,
        message=upward(words, depth, context)
        or uncut_material(words, outward, first, cutter, context, CLEARED * entry.helix),
    )


def links_outward(
    words: Words,
    first: float,
    outward: tuple[float, float] | None,
    clearing: str,
    levels: int,
    context: Context,
) -> tuple[float, int, float, float]:
    """Return the finished radius, the links to it, the first one's growth, and `Pocket.shrink`."""
    finished, stepover = outward or (first, first)
    growth = stepover / 2 if clearing == "spiral" else stepover
    links = steps_between(first, finished, growth, context.length(ROUNDING_MM))
    check_count(words, (links + 1) * levels, f"Q{number(stepover)} makes" if links else "L makes")
    last_grow = finished - first - growth * (links - 1)
    return finished, links, min(growth, finished - first), 1 - last_grow / growth


def choose_cutter(words: Words, context: Context) -> tuple[Tool, str]:
    """Return the cutter of the block and its source, for messages.

    The source is D in the block, else the D last commanded, else the tool in the spindle.
    """
    tool = commanded_tool(words, context)
    if tool is not None:
        return sound_tool(words, tool, f"D{tool.number}"), f"D{tool.number}"
    if context.last_radius is not None:
        return Tool(0, context.last_radius), "the D last commanded"
    if context.spindle_tool is None:
        raise words.refuse("D is missing, none was commanded before and no tool is loaded")
    source = f"T{context.spindle_tool.number} in the spindle"
    return sound_tool(words, context.spindle_tool, source), source


def check_radii(
    words: Words,
    context: Context,
    first: float,
    outward: tuple[float, float] | None,
    cutter: Tool,
    source: str,
) -> None:
    """Refuse circles that the cutter cannot mill, or that do not grow."""
    rounding = context.length(ROUNDING_MM)
    if first <= rounding:
        raise words.refuse(f"I{number(first)} must be greater than 0")
    if first <= cutter.radius + rounding:
        raise words.refuse(
            f"I{number(first)} must be greater than the tool radius"
            f" {context.tool_size(cutter.radius)} ({source})"
        )
    smallest = context.length(SMALLEST_RING_MM)
    if first - cutter.radius < smallest - rounding:
        raise words.refuse(
            f"I{number(first)} must exceed the tool radius {context.tool_size(cutter.radius)}"
            f" ({source}) by at least {number(smallest)}"
        )
    if outward and outward[0] <= first + rounding:
        raise words.refuse(f"I{number(first)} must be less than K{number(outward[0])}")


def upward(words: Words, depth: float | None, context: Context) -> str | None:
    """Return the operator message of a pocket that begins above the tool, or None.

    It looks like a lost minus sign. The control would go up and cut there, too.
    """
    first = coordinate(depth, context.z, context)
    if depth is None or first <= context.z + context.length(ROUNDING_MM):
        return None
    return (
        f"{words.code}: Z{number(depth)} is up from the tool at Z{number(context.z)}:"
        " has it lost its minus sign?"
    )


def uncut_material(
    words: Words,
    outward: tuple[float, float] | None,
    first: float,
    cutter: Tool,
    context: Context,
    helix: float,
) -> str | None:
    """Return the operator message of a pocket that leaves material uncut, or None.

    ``helix`` is the greatest radius of a helix in tool radii, 0 without.

    The control's own sample programs do this, so it is no error. With D0 the cutter's size
    is not known, and a single circle may well finish a bored hole: no message then.
    """
    if outward is None or cutter.radius == 0:
        return None
    (finished, stepover), rounding = outward, context.length(ROUNDING_MM)
    if min(stepover, finished - first) > 2 * cutter.radius + rounding:
        return (
            f"{words.code}: Q{number(stepover)} is greater than the tool diameter"
            f" {context.tool_size(2 * cutter.radius)}: material is left between the rings"
        )
    # The entry cuts up to the tool radius plus the helix, the first ring from I - 2 tool radii on.
    most = 3 + helix
    if first > most * cutter.radius + rounding:
        remains = "a ring is left about the centre" if helix else "a core is left in the centre"
        return (
            f"{words.code}: I{number(first)} is greater than {number(most / 2)} x the tool diameter"
            f" {context.tool_size(2 * cutter.radius)}: {remains}"
        )
    return None
