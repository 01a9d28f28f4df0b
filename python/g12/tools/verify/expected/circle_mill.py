# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a circle mill event, by ngc/circle_mill.md.

Radii are those of the tool's centre in mm, levels are measured from where the tool stands.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from g12.tools.verify.expected.toolpath import Expected, Writer

RETRACT = 2.54  # mm, of a pocket between its levels
NARROWER = 0.254  # mm: the roughing width without J is the cutter's diameter less this
ROUNDING = 1e-6  # mm
POCKET = 7.0  # the event's G of a pocket
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns by D

Entries = Mapping[str, float]  # by the control's letters; lengths and feeds in mm


class FinishPass(NamedTuple):
    """The pass along the wall: its radius, turn and feed, and the turn of the arcs at its ends."""

    radius: float
    turn: int
    entry_turn: int
    feed: float | None


class EventWords(NamedTuple):
    """An event's entries: where the tool stands from the centre, the planes W and O, the circles.

    ``rings`` are those of a level, outward; a perimeter has one. ``turn`` is +1
    counterclockwise, -1 clockwise.
    """

    start: complex
    first_plane: float
    second_plane: float
    pocket: bool
    rings: Sequence[float]
    levels: Sequence[float]
    turn: int
    feed: float | None
    plunge_feed: float | None
    finish: FinishPass | None = None
    line: int = 0
    per_rev: bool = False

    @property
    def stepover(self) -> float | None:
        """Return the distance between neighbouring passes, None with one ring."""
        return self.rings[0] if len(self.rings) > 1 else None

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: to the plunge point, the levels, the finish, and back."""
        writer = Writer(self.start, 0.0, self.line, self.per_rev)
        writer.vertical("rapid up", max(0.0, self.first_plane), rapid=True)
        writer.straight("rapid to the plunge point", self._plunge_point, rapid=True)
        writer.vertical("rapid to the first reference plane", self.first_plane, rapid=True)
        for index, level in enumerate(self.levels):
            if index and self.pocket:
                self._back_to_centre(writer)
            self._level(writer, level)
        if self.finish:
            self._side(writer, self.finish)
        writer.vertical("rapid to the second reference plane", self.second_plane, rapid=True)
        writer.straight("rapid back to the start", self.start, rapid=True)
        return writer.path

    @property
    def _plunge_point(self) -> complex:
        return 0j if self.pocket else complex(0.0, -self.rings[-1])

    def _level(self, writer: Writer, level: float) -> None:
        writer.vertical("plunge", level, self.plunge_feed)
        for radius in self.rings:
            writer.straight("stepover", complex(0.0, -radius), self.feed)
            writer.arc("circle", 0j, 2 * math.pi * self.turn, self.feed)

    def _back_to_centre(self, writer: Writer) -> None:
        retracted = min(writer.level + RETRACT, self.first_plane)
        writer.vertical("retract", retracted, rapid=True)
        writer.straight("rapid back to the centre", 0j, rapid=True)

    def _side(self, writer: Writer, finish: FinishPass) -> None:
        middle = complex(0.0, -(self.rings[-1] + finish.radius) / 2)
        writer.arc("lead-in of the finish", middle, math.pi * finish.entry_turn, finish.feed)
        writer.arc("finish circle", 0j, 2 * math.pi * finish.turn, finish.feed)
        writer.arc("lead-out of the finish", middle, math.pi * finish.entry_turn, finish.feed)


def event_of(
    entries: Entries, place: EventPlace, cutter: float, feed: float | None, per_rev: bool = False
) -> EventWords:
    """Return the event of some entries; ``cutter`` is a radius, ``feed`` the block's or modal."""
    side, finish = side_of(entries), entries.get("L")
    turn, finish_turn = ROUGH_FINISH[int(entries.get("D", 0.0))]
    rough = entries.get("F", feed)
    second = entries.get("O", place.plane)
    last = None
    if finish is not None:
        entry = finish_turn if side < 0 else -finish_turn
        radius = entries["R"] + side * cutter
        last = FinishPass(radius, finish_turn, entry, entries.get("V", rough))
    return EventWords(
        place.start,
        place.plane - place.level,
        second - place.level,
        entries.get("G", 0.0) == POCKET,
        event_rings(entries, side, cutter),
        [level - place.level for level in event_levels(entries, place)],
        turn,
        rough,
        entries.get("P", rough),
        last,
        place.line,
        per_rev,
    )


class EventPlace(NamedTuple):
    """Where an event begins: from the centre, its level, the plane W, both as the program has them.

    ``absolute`` says that Z is measured from the program's zero, not from W.
    """

    start: complex
    level: float
    plane: float
    absolute: bool
    line: int = 0


def side_of(entries: Entries) -> int:
    """Return where the cutter works: -1 inside the wall, +1 outside, 0 on the circle."""
    left_is = 1 if int(entries.get("D", 0.0)) in (0, 2) else -1  # clockwise: outside is on its left
    return {0: 0, 1: left_is, 2: -left_is}[int(entries["C"])]


def event_rings(entries: Entries, side: int, cutter: float) -> list[float]:
    """Return the radii of a level's circles, outward and equally far apart."""
    rough = entries["R"] + side * (cutter + abs(entries.get("L", 0.0)))
    if entries.get("G", 0.0) != POCKET:
        return [rough]
    widest = entries.get("J", 2 * cutter - NARROWER)
    count = max(1, math.ceil((rough - ROUNDING) / widest))
    return [rough * (ring + 1) / count for ring in range(count)]


def event_levels(entries: Entries, place: EventPlace) -> list[float]:
    """Return the levels in program coordinates, downward from W."""
    final = entries["Z"] if place.absolute else place.plane + entries["Z"]
    rough = final + max(0.0, entries.get("L", 0.0))
    peck = entries.get("K", place.plane - rough)
    levels = [place.plane - peck]
    while levels[-1] > rough + ROUNDING:
        levels.append(levels[-1] - peck)
    levels[-1] = rough
    return levels + [final] * (rough > final)
