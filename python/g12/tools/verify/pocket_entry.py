# SPDX-License-Identifier: GPL-2.0-or-later
"""How a pocket's tool comes down: straight in the centre, or along a helix.

A helix is asked for by a machine's [G12] ENTRY; what it is like is measured from the moves. Lengths
are millimetres, angles degrees.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.preview.moves import Move
from g12.tools.units import Unit
from g12.tools.verify.wanted_circle import HelixAsked, Wall

FALLS = 1e-6
RING_FALLS = 0.1
SAME_RADIUS = 2e-3
SAME_ANGLE = 0.01
SAME_SLOPE = 1e-3
LEAST_STEEP = 3  # half turns that fall alike, of which two may be left out


class EntryMoves(NamedTuple):
    """One way down: the move onto the helix, None if there is no arc, and the falling ones."""

    lead: int | None
    falling: tuple[int, ...]


class HelixFacts(NamedTuple):
    """The helices of a pocket: their number, least and greatest radius, greatest angle.

    ``shorter`` is the least angle that one of them would have with a turn less, None if none can.
    """

    count: int
    least: float
    greatest: float
    steepest: float
    shorter: float | None = None


def helices_of(own: range, moves: Sequence[Move], wall: Wall) -> list[EntryMoves]:
    """Return the helices among some moves, given by their indices."""
    entries: list[EntryMoves] = []
    falling: list[int] = []
    for index in own:
        if falls(moves[index], wall):
            falling.append(index)
        elif falling:
            entries.append(_entry(falling, own, moves))
            falling = []
    return [*entries, *([_entry(falling, own, moves)] if falling else [])]


def _entry(falling: list[int], own: range, moves: Sequence[Move]) -> EntryMoves:
    before = falling[0] - 1
    on_arc = before in own and moves[before].kind == "arc"
    return EntryMoves(before if on_arc else None, tuple(falling))


def is_full_circle(move: Move) -> bool:
    """Tell whether a move is a full circle."""
    return move.kind == "arc" and abs(move.sweep) > 2 * math.pi - 1e-9


def falls(move: Move, wall: Wall) -> bool:
    """Tell whether a move is an arc that goes down; a circle that does by little is a ring."""
    least = RING_FALLS if is_full_circle(move) else FALLS
    return move.kind == "arc" and _fall(move, wall) > least


def _fall(move: Move, wall: Wall) -> float:
    ends = wall.local(np.array([move.start[:3], move.end[:3]]))
    return float(ends[0, 2] - ends[1, 2])


def helix_facts(
    entries: Sequence[EntryMoves], moves: Sequence[Move], wall: Wall
) -> HelixFacts | None:
    """Return what the helices are like, None if there are none."""
    falling = [moves[index] for entry in entries for index in entry.falling]
    if not falling:
        return None
    ends = [move.start[:3] for move in falling] + [move.end[:3] for move in falling]
    radii = np.hypot(*wall.local(np.array(ends))[:, :2].T)
    steepest = math.degrees(max(_angle(move, wall) for move in falling))
    shorter = filter(None, (_with_a_turn_less(entry, moves, wall) for entry in entries))
    least = min(shorter, default=None)
    return HelixFacts(len(entries), float(radii.min()), float(radii.max()), steepest, least)


def _angle(move: Move, wall: Wall) -> float:
    """Return by which angle an arc falls, radians."""
    return math.asin(min(1.0, _fall(move, wall) / move.length))


def _with_a_turn_less(entry: EntryMoves, moves: Sequence[Move], wall: Wall) -> float | None:
    """Return the angle of a helix with a turn less, None if hardly any of it is so steep."""
    falling = [moves[index] for index in entry.falling]
    angles = [_angle(move, wall) for move in falling]
    as_steep = [angle > max(angles) * (1.0 - SAME_SLOPE) for angle in angles]
    if sum(as_steep) < LEAST_STEEP:
        return None
    way = sum(_fall(move, wall) for move in falling) / math.tan(max(angles))
    shortened = way - 2 * math.pi * falling[0].radius
    return math.degrees(math.atan(math.tan(max(angles)) * way / shortened))


def entry_findings(facts: HelixFacts | None, asked: HelixAsked | None, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the way down."""
    if not asked or not facts:
        if facts:
            yield "it goes down along a helix and not straight"
        elif asked and asked.count:
            yield "it goes straight down and not along a helix"
        return
    if facts.count != asked.count:
        yield f"it goes down along a helix {facts.count} times, not {asked.count}"
    wrong = [r for r in (facts.least, facts.greatest) if abs(r - asked.radius) > SAME_RADIUS]
    if wrong:
        found, radius = (unit.text(radius) for radius in (wrong[0], asked.radius))
        yield f"its helix has the radius {found} {unit.name} (tool centre), not {radius}"
    if facts.steepest > asked.angle + SAME_ANGLE:
        yield f"its helix falls by {facts.steepest:.3g} degrees, not {asked.angle:.3g} at most"
    elif facts.shorter and facts.shorter < asked.angle - SAME_ANGLE:
        yield (
            f"its helix falls by {facts.steepest:.3g} degrees: with a turn less it would be "
            f"{facts.shorter:.3g}, {asked.angle:.3g} are allowed"
        )


def entry_text(facts: HelixFacts | None, unit: Unit) -> str:
    """Return how the tool comes down in words."""
    if facts is None:
        return "straight down"
    return f"helix of radius {unit.text(facts.greatest)} (tool centre), {facts.steepest:.3g}°"


def entry_json(facts: HelixFacts | None) -> dict:
    """Return how the tool comes down as plain values, radii in mm, the angle in degrees."""
    if facts is None:
        return {"way": "straight"}
    radii = {"radius": facts.greatest, "least_radius": facts.least}
    return {"way": "helix", "helices": facts.count, **radii, "angle": facts.steepest}
