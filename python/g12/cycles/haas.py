# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 circular pocket, dialect haas: words and modes in, one checked pocket out.

Source: Haas Mill Operator's Manual, "G12 Circular Pocket Milling CW / G13 CCW".

The motions of `ngc/g12_haas.ngc`, per level:

1. with X or Y in the block: rapid to the centre at the present Z (before the first level)
2. feed to the level's Z in the centre; without Z in the block it is the present one. Or, with a
   helix, in place of 2 to 4: a half circle onto it, down along it, one full circle, and a half turn
   onto the first ring, if that is larger
3. half circle from the centre to (+b, 0), in the direction of the cut, tangent to the ring
4. full circle of radius b
5. for each further ring: a tangent link outward, then its full circle; the last is K exactly
6. tangent half circle back to the centre; Z stays at depth after the last level

A tool-centre radius b is the programmed radius less the tool radius.

Rules, in the order of the checks: the modes and words of `check_block`; I
required, above 0; K and Q together, both above 0; L whole, from 1;
D whole, from 0, in the tool table, or a cutter known without it; I greater than the tool radius by
a ring that can be cut, less than K; not too many circles; a helix of not too many turns.
"""

from typing import NamedTuple

from g12.cut_report import PocketCut
from g12.cycles.plan import CyclePlan, pocket_descent
from g12.errors import number
from g12.request import CLEARED, COUNTERCLOCKWISE, Cutter, Words, steps_between
from g12.settings import Settings
from g12.state import XY

HAAS_WORDS = "X Y Z I K Q L D F"


class Pocket(NamedTuple):
    """The radii of a pocket's first and last circle, the stepover, 0 where these are one."""

    first: float
    finished: float
    stepover: float


def plan(words: Words, arc: int, settings: Settings) -> CyclePlan:
    context = words.context
    names_centre = "X" in words or "Y" in words
    words.check_block(HAAS_WORDS)
    first = words.require_positive("I", "the radius of the first circle")
    words.check_pair("K", "Q")
    outermost, stepover = words.take_positive("K"), words.take_positive("Q")
    levels = words.take_whole("L", least=1, default=1)
    x, y = words.take_centre()
    depth = words.take("Z")
    z = words.absolute(depth, context.z)
    cutter = words.chosen_cutter()
    words.check_fits("I", first, cutter.radius, cutter.source)
    if outermost and outermost <= first + context.rounding:
        raise words.refuse_word("I", first, f"must be less than K{number(outermost)}")

    pocket = Pocket(first, outermost or first, stepover or 0.0)
    in_rings = settings.clearing == "rings"
    growth = pocket.stepover if in_rings else pocket.stepover / 2  # of a link
    links = growth and steps_between(first, pocket.finished, growth, context.rounding)
    cause = f"{words.written('Q', pocket.stepover)} makes" if links else "L makes"
    words.check_count(round(links + 1) * levels, cause)
    z_step = depth or 0.0 if context.incremental else 0.0
    last_level = z + z_step * (levels - 1)
    words.check_travel((x, y, z), pocket.finished - cutter.radius, (z, last_level))
    heights = context.z - z, -z_step
    first_radius = first - cutter.radius
    numbers = {
        "x": x,
        "y": y,
        "move_to_centre": names_centre,
        "z": z,
        "z_step": z_step,
        "levels": levels,
        "first_radius": first_radius,
        "rings": in_rings,
        "arc": arc,
        "hand": 1 if arc == COUNTERCLOCKWISE else -1,
        **pocket_descent(words, settings, first_radius, cutter.radius, heights),
        **links_outward(pocket, growth, links),
    }
    is_helix = settings.entry == "helix"
    message = upward(words, depth, z) or uncut_material(words, pocket, cutter, is_helix)
    cut = PocketCut(
        plane=XY,
        centre=(x, y, z),
        wall=pocket.finished,
        first=first,
        step=pocket.stepover,
        inner=first_radius - cutter.radius,
        levels=tuple(z + z_step * level for level in range(levels)),
        cutter=cutter.used,
    )
    return CyclePlan(numbers, cut, cutter, message)


def links_outward(pocket: Pocket, growth: float, links: float) -> dict[str, float]:
    """Return the locals of the links: stepovers, or half turns of the spiral."""
    if not links:
        return {"links": 0, "step": 0.0, "shorter": 0.0}
    width = pocket.finished - pocket.first
    step, last_step = min(growth, width), width - growth * (links - 1)
    return {"links": links, "step": step, "shorter": (1 - last_step / growth) * step}


def upward(words: Words, depth: float | None, z: float) -> str | None:
    """Return the operator message of a pocket that begins above the tool, or None.

    A depth without a minus sign has lost it, most likely. The control would go up and cut, too.
    """
    context = words.context
    if depth is None or z <= context.z + context.rounding:
        return None
    hint = ": has it lost its minus sign?" if depth > 0.0 else ""
    return f"{words.code}: Z{number(depth)} is up from the tool at Z{number(context.z)}{hint}"


def uncut_material(words: Words, pocket: Pocket, cutter: Cutter, is_helix: bool) -> str | None:
    """Return the operator message of a pocket that leaves material uncut, or None.

    The control's own sample programs do this, so it is no error. With D0 the cutter's size
    is not known, and a single circle may well finish a bored hole: no message then.
    """
    first, finished, stepover = pocket
    if not stepover or not cutter.radius:
        return None
    rounding, cut_by_entry = words.context.rounding, 3 + CLEARED * is_helix  # in tool radii
    if min(stepover, finished - first) > 2 * cutter.radius + rounding:
        wide, where = f"Q{number(stepover)} is greater than", "material is left between the rings"
    elif first > cut_by_entry * cutter.radius + rounding:
        # the entry cuts up to the tool radius plus the helix, the first ring from I - 2 of them on
        wide = f"I{number(first)} is greater than {number(cut_by_entry / 2)} x"
        where = "a ring is left about" if is_helix else "a core is left in"
        where += " the centre"
    else:
        return None
    diameter = words.context.tool_size(2 * cutter.radius)
    return f"{words.code}: {wide} the tool diameter {diameter}: {where}"
