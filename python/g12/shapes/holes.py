# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules and numbers of ``o<face_holes>``, ``o<side_holes>`` and ``o<face_hole_at> call``.

Holes on a lathe's face lie along Z, those on its side along X. C turns from hole to hole, the
shorter way, while the tool is at the retract height or above. The motion is `ngc/g12_holes.ngc`.
LinuxCNC's own drilling cycles take no C; in G7 and G19 2.9.0 does not halve their R (its issue
2948), so they are not used.

Rules, in the order of the checks: a tool in the spindle; where the holes are; depth and retract
above 0; kind 0 to 3; feed above 0; no peck but in drilling; dwell from 0; a tap's spindle on, the
right direction; the tool above the face, or outside the surface; not too many moves.

Lengths are in program units, X is a radius, angles are in degrees. Heights are above the face or
the surface.
"""

from __future__ import annotations

from math import atan2, ceil, degrees, sqrt
from typing import NamedTuple

from g12.cut_report import HolesCut
from g12.errors import number
from g12.lengths import DEGREES_PER_TURN
from g12.request import steps_between
from g12.shapes.entries import (
    Extent,
    ShapeEntries,
    ShapePlan,
    check_moves,
    feed_of,
    locals_of,
    polar_position,
)

HOLE = ("depth", "retract", "feed", "peck", "dwell", "kind")
FACE_HOLES = ("count", "circle_diameter", "first_angle", "step_angle", *HOLE)
SIDE_HOLES = ("count", "z", "first_angle", "step_angle", "surface_diameter", *HOLE)
FACE_HOLE_AT = ("x", "c", *HOLE)
MOST_HOLES_OF_CALL = 360  # one a degree; more are a mistyped count
DRILL, TAP_RIGHT, TAP_LEFT, BORE = range(4)  # kind
TAP_SPINDLE_CODES = {TAP_RIGHT: 3, TAP_LEFT: 4}  # M codes
CHIP_MM = 0.254  # chip break: retract; full retract: clearance of the rapid back to the bottom


class HoleMachine(NamedTuple):
    """The machine's state that holes depend on.

    ``c`` is the position of C, ``spindle`` the number of the tool's spindle, ``spindle_code`` its M
    code, 3, 4 or 5, ``speed`` its S. ``beside`` is the tool's distance from the X line, towards C+.
    ``diameters``: an X entry is a diameter.
    """

    c: float
    spindle: int
    spindle_code: int
    speed: float
    beside: float
    diameters: bool


class HolePosition(NamedTuple):
    """The first hole: its X and Z at the face or surface, C there, and the tool's axis.

    ``x_axis`` and ``z_axis``: X and Z change by this times a height, 0 or 1. ``height`` is the
    tool's at the start.
    """

    x: float
    z: float
    angle: float
    x_axis: int
    z_axis: int
    height: float


class Hole(NamedTuple):
    """The values of one hole for the sub.

    ``pecks`` passes, each deeper by ``step``. ``full`` 1: retract to the retract height after each,
    else by ``clear``. ``feed`` is a tap's pitch.
    """

    depth: float
    retract: float
    feed: float
    pecks: int
    step: float
    full: int
    clear: float
    dwell: float
    kind: int


def plan_face_holes(entries: ShapeEntries, machine: HoleMachine) -> ShapePlan:
    check_tool(entries)
    count = count_of(entries)
    radius = entries.require_positive("circle_diameter", "of the circle of holes") / 2
    angle, turn = entries.angle("first_angle"), hole_turn(entries, count)
    return plan_holes(entries, machine, on_face(entries, machine, radius, angle), count, turn)


def plan_face_hole_at(entries: ShapeEntries, machine: HoleMachine) -> ShapePlan:
    check_tool(entries)
    position = on_face(entries, machine, *polar_position(entries, machine.diameters))
    return plan_holes(entries, machine, position, 1, 0.0)


def plan_side_holes(entries: ShapeEntries, machine: HoleMachine) -> ShapePlan:
    check_tool(entries)
    count = count_of(entries)
    z = entries.require("z", "where the holes are along the part")
    angle, turn = entries.angle("first_angle"), hole_turn(entries, count)
    radius = entries.require_positive("surface_diameter", "of the turned surface") / 2
    if machine.beside:
        raise entries.refuse("needs a tool on the X line, not [G12] POLAR_TOOL_OFFSET beside it")
    height = entries.context.x - radius
    if height <= 0:
        raise entries.refuse(
            f"X{number(entries.context.x)} (radius): the tool must be outside the surface, beyond"
            f" {number(radius)}"
        )
    return plan_holes(entries, machine, HolePosition(radius, z, angle, 1, 0, height), count, turn)


def plan_holes(
    entries: ShapeEntries, machine: HoleMachine, position: HolePosition, count: int, turn: float
) -> ShapePlan:
    """Return the holes from a position on, with a turn of C by ``turn`` from one to the next."""
    hole = hole_of(entries, machine)
    check_moves(entries, count * (3 * hole.pecks + 3), "count and peck make")
    first_turn, turn = shorter_turn(position.angle - machine.c), shorter_turn(turn)
    travel = max(position.height, hole.retract)  # the tool's height during the first turn
    first = machine.c + first_turn
    angles = (machine.c, first, first + turn * (count - 1))
    x, z = zip(
        *(
            (position.x + position.x_axis * height, position.z + position.z_axis * height)
            for height in (-hole.depth, travel)
        )
    )
    extent = Extent((min(x), max(x)), (min(z), max(z)), (min(angles), max(angles)))
    own = {"count": count, "first_turn": first_turn, "turn": turn, "travel": travel}
    places = tuple((position.x, position.z, first + turn * index) for index in range(count))
    return ShapePlan(
        own | locals_of(position, hole),
        extent,
        lambda: HolesCut(
            position.x * position.x_axis,
            places,
            *(hole.depth, hole.kind, hole.feed),
        ),
    )


def check_tool(entries: ShapeEntries) -> None:
    if entries.context.spindle_tool is None:
        raise entries.refuse("no tool is loaded")


def count_of(entries: ShapeEntries) -> int:
    return entries.require_whole("count", "how many holes", least=1, most=MOST_HOLES_OF_CALL)


def hole_turn(entries: ShapeEntries, count: int) -> float:
    """Return the angle from hole to hole: step_angle, or a full circle by the number of holes."""
    if "step_angle" not in entries:
        return DEGREES_PER_TURN / count
    return entries.angle("step_angle")


def shorter_turn(angle: float) -> float:
    """Return an angle as the shorter turn, from -180 to 180; a half turn has the angle's sign."""
    short = angle - DEGREES_PER_TURN * ceil((angle - DEGREES_PER_TURN / 2) / DEGREES_PER_TURN)
    return -short if short == DEGREES_PER_TURN / 2 and angle < 0 else short


def on_face(
    entries: ShapeEntries, machine: HoleMachine, radius: float, angle: float
) -> HolePosition:
    """Return the position of a hole on the face; with a tool beside the X line X is smaller."""
    height = entries.context.z
    if not height > 0:
        raise entries.refuse(f"Z{number(height)}: the tool must be above the face at Z0")
    beside = machine.beside
    if abs(beside) > radius:
        raise entries.refuse(
            f"the hole is {number(radius)} from the spindle's axis, where [G12] POLAR_TOOL_OFFSET"
            f" lets the tool no nearer than {number(abs(beside))}"
        )
    x = sqrt(radius**2 - beside**2)
    return HolePosition(x, 0.0, angle - degrees(atan2(beside, x)), 0, 1, height)


def hole_of(entries: ShapeEntries, machine: HoleMachine) -> Hole:
    depth = entries.require_positive("depth", "how deep, from the face or surface")
    retract = entries.require_positive("retract", "the height at which the tool is clear")
    kind = entries.take_whole("kind", least=DRILL, most=BORE, default=DRILL)
    tap = kind in TAP_SPINDLE_CODES
    feed = entries.require_positive("feed", "a tap's pitch") if tap else feed_of(entries)
    peck = entries.take("peck") or 0.0
    if peck and kind != DRILL:
        rule = f"is for drilling (kind {DRILL}), not for kind {kind}"
        raise entries.refuse_word("peck", peck, rule)
    dwell = entries.from_zero("dwell")
    if tap:
        check_tapping(entries, machine, kind)
    step, context = abs(peck) or depth, entries.context
    pecks = max(1, steps_between(0.0, depth, step, context.rounding))
    clear = min(context.length(CHIP_MM), step / 2) if peck else 0.0
    return Hole(depth, retract, feed, pecks, step, int(peck > 0), clear, dwell, kind)


def check_tapping(entries: ShapeEntries, machine: HoleMachine, kind: int) -> None:
    """Refuse a tap with its spindle off or reversed: the machine would wait, or the tap break."""
    code = TAP_SPINDLE_CODES[kind]
    if machine.spindle_code != code or not machine.speed:
        hand = "right" if kind == TAP_RIGHT else "left"
        its = f" and S, ${machine.spindle} beside them" if machine.spindle else " and S"
        raise entries.refuse(
            f"kind {kind} taps a {hand}-hand thread: the tool's spindle must turn, by M{code}{its}"
        )
