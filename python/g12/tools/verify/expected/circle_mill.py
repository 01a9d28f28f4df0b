# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a circle mill event, by ngc/circle_mill.md.

Radii are those of the tool's centre in mm, levels are measured from where the tool stands.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from g12.tools.verify.expected.toolpath import CircleWords, Expected, Writer
from g12.tools.verify.expected.words import LEFT_OUT, BlockInMm

RETRACT = 2.54  # mm, of a pocket between its levels
NARROWER = 0.254  # mm: the roughing width without J is the cutter's diameter less this
ROUNDING = 1e-6  # mm
POCKET = 7.0  # the event's G of a pocket
ENTRIES = "GXYZWORDCKJLPFV"
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns by D

Entries = Mapping[str, float]  # by the control's letters; lengths and feeds in mm


class EventPlace(NamedTuple):
    """Where an event begins: from the centre, its level, the plane W, both as the program has them.

    ``absolute`` says that Z is measured from the program's zero, not from W.
    """

    start: complex
    level: float
    plane: float
    absolute: bool
    line: int = 0


@dataclass(frozen=True)
class EventWords(CircleWords):
    """An event's entries, where it begins, and the cutter by its radius.

    ``block_feed`` is the feed without F among the entries: the block's, or the one in force.
    """

    entries: Entries
    place: EventPlace
    cutter: float
    block_feed: float | None
    per_rev: bool = False

    @property
    def pocket(self) -> bool:
        """Tell whether it clears all that is within the wall."""
        return self.entries.get("G", 0.0) == POCKET

    @property
    def side(self) -> int:
        """Return where the cutter works: -1 inside the wall, +1 outside, 0 on the circle."""
        turn = -self._turns[0]
        return {0: 0, 1: turn, 2: -turn}[int(self.entries["C"])]  # clockwise: left is outside

    @property
    def inside(self) -> bool:
        """Tell whether the cutter works inside the wall."""
        return self.side <= 0

    @property
    def word(self) -> str:
        """Return the entry of the circle on which the tool's centre goes, "" beside a wall."""
        return "" if self.side else "R"

    @property
    def final(self) -> float:
        """Return the radius of the last circle."""
        return self.entries["R"] + self.side * self.cutter

    def cleared(self, cutter: float) -> float:
        """Return the radius within which material may remain."""
        return 0.0 if self.pocket else max(0.0, self.rings[-1] - cutter)

    @property
    def feed(self) -> float | None:
        """Return the feed of roughing."""
        return self.entries.get("F", self.block_feed)

    @property
    def plunge_feed(self) -> float | None:
        """Return the feed down."""
        return self.entries.get("P", self.feed)

    @property
    def rings(self) -> list[float]:
        """Return the radii of a level's circles, outward and equally far apart."""
        rough = self.final + self.side * abs(self.entries.get("L", 0.0))
        if not self.pocket:
            return [rough]
        widest = self.entries.get("J", 2 * self.cutter - NARROWER)
        count = max(1, math.ceil((rough - ROUNDING) / widest))
        return [rough * (ring + 1) / count for ring in range(count)]

    @property
    def levels(self) -> list[float]:
        """Return the levels from where the tool stands, downward."""
        entries, place = self.entries, self.place
        final = entries["Z"] + (0.0 if place.absolute else place.plane) - place.level
        rough = final + max(0.0, entries.get("L", 0.0))
        peck = entries.get("K", self._first_plane - rough)
        levels = [self._first_plane - peck]
        while levels[-1] > rough + ROUNDING:
            levels.append(levels[-1] - peck)
        levels[-1] = rough
        return levels + [final] * (rough > final)

    @property
    def stepover(self) -> float | None:
        """Return the distance between neighbouring passes, None with one ring."""
        return self.rings[0] if len(self.rings) > 1 else None

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: to the plunge point, the levels, the finish, and back."""
        place = self.place
        writer = Writer(place.start, 0.0, place.line, self.per_rev)
        writer.vertical("rapid up", max(0.0, self._first_plane), rapid=True)
        plunge_point = 0j if self.pocket else complex(0.0, -self.rings[-1])
        writer.straight("rapid to the plunge point", plunge_point, rapid=True)
        writer.vertical("rapid to the first reference plane", self._first_plane, rapid=True)
        for index, level in enumerate(self.levels):
            if index and self.pocket:
                self._back_to_centre(writer)
            self._level(writer, level)
        if "L" in self.entries:
            self._finish(writer)
        second = self.entries.get("O", place.plane) - place.level
        writer.vertical("rapid to the second reference plane", second, rapid=True)
        writer.straight("rapid back to the start", place.start, rapid=True)
        return writer.path

    @property
    def _turns(self) -> tuple[int, int]:
        """The turns of roughing and of the finish."""
        return ROUGH_FINISH[int(self.entries.get("D", 0.0))]

    @property
    def _first_plane(self) -> float:
        return self.place.plane - self.place.level

    def _level(self, writer: Writer, level: float) -> None:
        writer.vertical("plunge", level, self.plunge_feed)
        for radius in self.rings:
            writer.straight("stepover", complex(0.0, -radius), self.feed)
            writer.arc("circle", 0j, 2 * math.pi * self._turns[0], self.feed)

    def _back_to_centre(self, writer: Writer) -> None:
        retracted = min(writer.level + RETRACT, self._first_plane)
        writer.vertical("retract", retracted, rapid=True)
        writer.straight("rapid back to the centre", 0j, rapid=True)

    def _finish(self, writer: Writer) -> None:
        middle = complex(0.0, -(self.rings[-1] + self.final) / 2)
        turn, feed = math.pi * self._turns[1], self.entries.get("V", self.feed)
        entry = turn if self.side < 0 else -turn
        writer.arc("lead-in of the finish", middle, entry, feed)
        writer.arc("finish circle", 0j, 2 * turn, feed)
        writer.arc("lead-out of the finish", middle, entry, feed)


def event_of(entries: Entries, plane: float, view: BlockInMm, cutter: float) -> EventWords:
    """Return the event of a block; ``plane`` is W in program coordinates."""
    start = view.seen_from(view.centre())
    place = EventPlace(start, view.present("z"), plane, view.absolute, view.line)
    return EventWords(entries, place, cutter, view.feed(), view.rev)


def called_event(view: BlockInMm) -> dict[str, float]:
    """Return the entries of ``o<circle_mill> call``, mm; X and Y go where the words would."""
    given = dict(zip(ENTRIES, view.arguments))
    entries = {
        letter: value * (1.0 if letter in "GDC" else view.unit)
        for letter, value in given.items()
        if value != LEFT_OUT
    }
    view.words = {letter: given[letter] for letter in "XY"}
    return entries


def coded_event(view: BlockInMm, pocket: bool) -> dict[str, float]:
    """Return the entries of a G12.2 or G13.2 block, mm."""
    letters = {entry: entry for entry in "RZKPJ"} | {"W": "I", "O": "E", "L": "Q"}
    entries = {entry: view.length(word) for entry, word in letters.items() if word in view.words}
    if view.words.get("L") == 0.0:
        entries["L"] = -entries["L"]
    entries["D"], entries["C"] = view.words.get("D", 0.0), view.words["H"]
    entries["G"] = POCKET if pocket else 0.0
    return entries
