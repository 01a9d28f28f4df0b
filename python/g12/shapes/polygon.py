# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules and numbers of ``o<polar_polygon> call``: a polygon, or two flats, on a bar's end.

The tool's centre runs clockwise, outside the polygon. In a frame whose zero line runs
through the middle of a corner, each round begins and ends at (``outside``, 0), clear of the stock:

1. an arc about the spindle's centre, away from the zero line
2. a straight lead-in, tangent to the corner's arc in its middle
3. flat after flat, with an arc about each corner; where the flats extend beyond the stock, an arc
   about the spindle's centre replaces the corner
4. straight out where the last arc is on the zero line again, and back

Rounds are the final one moved outward by equal steps, so that the stepover is the same at corners
and flats. The moves between them and the plunges are clear of the stock.

Rules, in the order of the checks: a tool with a diameter in the spindle; sides from 2;
across_flats, stock_diameter above 0, the stock larger than the flats; corner_radius from 0, none
with two flats, less than half of across_flats; depth, depth_per_pass and feeds above 0; the tool
above the face; allowance from 0, less than the material to cut, and no more than one round removes;
not too many moves; angle.
"""

from __future__ import annotations

from math import acos, degrees, fmod, hypot, radians, sqrt, tan
from typing import NamedTuple

from g12.cut_report import PolygonCut
from g12.errors import number
from g12.request import loaded_tool
from g12.shapes.entries import (
    CLEAR_MM,
    PASS_ENTRIES,
    Extent,
    ShapeEntries,
    ShapeMachine,
    ShapePlan,
    check_finish,
    check_moves,
    descent_of,
    locals_of,
    passes_of,
    rounds_between,
)

FORM_ENTRIES = ("sides", "across_flats", "depth", "stock_diameter", "corner_radius")
POLYGON_ENTRIES = (*FORM_ENTRIES, *PASS_ENTRIES, "angle")
TWO_FLATS = 2  # sides: two flats, which have no corner
MOST_SIDES = 100  # more are a circle
FLUSH = 1e-6  # greatest rounding difference between the sub's arithmetic and this one
UNLIMITED_FLAT = 1e9  # half the length of an unlimited flat


class PolygonForm(NamedTuple):
    """A polygon: its flats are ``apothem`` from the centre, its corners rounded by ``radius``.

    ``inner`` is the apothem of the polygon that the centres of the corners' arcs make, ``side``
    half the length of its sides, ``corner`` the distance of its corners from the centre.
    """

    sides: int
    apothem: float
    radius: float

    @property
    def inner(self) -> float:
        """Return the apothem of the corners' centres."""
        return self.apothem - self.radius

    @property
    def half_turn(self) -> float:
        """Return half the angle from corner to corner in degrees."""
        return 180.0 / self.sides

    @property
    def moves(self) -> int:
        """Return the number of moves of a round, lead-in and lead-out included."""
        return 2 * self.sides + 6

    @property
    def side(self) -> float:
        if self.sides == TWO_FLATS:
            return UNLIMITED_FLAT
        return self.inner * tan(radians(self.half_turn))

    @property
    def corner(self) -> float:
        return hypot(self.inner, self.side)


class PolygonRounds(NamedTuple):
    """The rounds of the tool's centre by the distance of their flats from the spindle's centre.

    ``rounds`` at every level, from ``apothem`` on inward by ``step``, and a ``finish`` round (1 or
    0) at ``finish_apothem``. ``clip`` is a flat's greatest distance from the centre, ``outside``
    that of the rounds' start.
    """

    rounds: int
    apothem: float
    step: float
    finish: int
    finish_apothem: float
    clip: float
    outside: float


def plan_polygon(entries: ShapeEntries, machine: ShapeMachine) -> ShapePlan:
    cutter = loaded_tool(entries).radius
    form, stock = form_of(entries)
    descent = descent_of(entries, machine)
    rounds = rounds_of(entries, form, stock, cutter, descent.levels)
    angle = fmod(entries.angle("angle") + form.half_turn, 360.0)
    # every round is one turn of C, backwards
    turns = descent.levels * rounds.rounds + rounds.finish
    extent = Extent(
        (rounds.finish_apothem, rounds.outside),
        descent.extent,
        (
            angle - 360.0 * turns - lead_angle(form, rounds, rounds.finish_apothem),
            angle + lead_angle(form, rounds, rounds.apothem),
        ),
    )
    own = {name: getattr(form, name) for name in ("inner", "side", "corner", "half_turn")}
    own |= {"start_angle": angle, "flush": FLUSH}
    return ShapePlan(
        own | locals_of(rounds, descent),
        extent,
        lambda: PolygonCut(
            form.sides,
            2 * form.apothem,
            form.radius,
            2 * stock,
            angle - form.half_turn,
            passes_of(entries, descent),
        ),
    )


def lead_angle(form: PolygonForm, rounds: PolygonRounds, apothem: float) -> float:
    """Return the angle of a round's lead-in and lead-out from the zero line, in degrees."""
    return degrees(acos(corner_distance(form, apothem, rounds.clip) / rounds.outside))


def form_of(entries: ShapeEntries) -> tuple[PolygonForm, float]:
    sides = entries.require_whole("sides", "how many, 2 for two flats", TWO_FLATS, MOST_SIDES)
    flats = entries.require_positive("across_flats", "the distance between two flats")
    stock = entries.require_positive("stock_diameter", "the bar's")
    if not stock > flats:
        rule = f"must be greater than across_flats {number(flats)}"
        raise entries.refuse_word("stock_diameter", stock, rule)
    radius = entries.from_zero("corner_radius")
    if radius and sides == TWO_FLATS:
        word = entries.written("corner_radius", radius)
        raise entries.refuse(f"{word}: two flats have no corners")
    if not radius < flats / 2:
        rule = f"must be less than half of across_flats {number(flats)}"
        raise entries.refuse_word("corner_radius", radius, rule)
    return PolygonForm(sides, flats / 2, radius), stock / 2


def rounds_of(
    entries: ShapeEntries, form: PolygonForm, stock: float, cutter: float, levels: int
) -> PolygonRounds:
    """Return the rounds from the stock's radius to the polygon and its allowance."""
    allowance, context = entries.from_zero("allowance"), entries.context
    height = stock - form.apothem - allowance
    if not height > context.rounding:
        rule = f"must be less than the {number(stock - form.apothem)} from the stock to the flats"
        raise entries.refuse_word("allowance", allowance, rule)
    check_finish(entries, allowance, cutter)
    rounds = max(1, rounds_between(0.0, height, cutter, context.rounding))
    check_moves(entries, levels * rounds * form.moves, "stock_diameter and depth_per_pass make")
    step = height / rounds
    final = form.apothem + cutter
    clip = stock + cutter + context.length(CLEAR_MM)
    first = stock + cutter - step
    tops = (corner_distance(form, first - index * step, clip) for index in range(rounds))
    return PolygonRounds(
        rounds=rounds,
        apothem=first,
        step=step,
        finish=int(allowance > 0),
        finish_apothem=final,
        clip=clip,
        outside=max(clip, *tops, corner_distance(form, final, clip)),
    )


def corner_distance(form: PolygonForm, apothem: float, clip: float) -> float:
    """Return the distance of a round's corner, on the tool's centre, from the spindle's centre."""
    if sqrt(clip * clip - apothem * apothem) + FLUSH < form.side:
        return clip
    return form.corner + apothem - form.inner
