# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a circle mill event, by ngc/circle_mill.md.

Radii are those of the tool's centre in mm, levels are measured from the tool before the event.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

from g12.tools.verify.expected.toolpath import CircleWords, Expected, Writer
from g12.tools.verify.expected.words import LEFT_OUT, BlockInMm

RETRACT = 2.54  # mm, of a pocket between its levels
NARROWER = 0.254  # mm: the roughing width without J is the cutter's diameter less this
ROUNDING = 1e-6  # mm
POCKET = 7.0  # the event's G of a pocket
CALL_ENTRIES = "GXYZWORDCKJLPFV"  # of the sub, in order
NUMBERS = "GDC"  # entries that are no lengths
ENTRIES_OF_CALL = {entry: entry for entry in "GZWORDCKJLPV"}
ENTRIES_OF_CODE = {**{entry: entry for entry in "RZKPJD"}, "W": "I", "O": "E", "L": "Q", "C": "H"}
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns by D

Entries = Mapping[str, float]  # by the control's letters; lengths and feeds in mm


@dataclass(frozen=True)
class EventWords(CircleWords):
    """An event's entries, the tool's position from the centre, and the cutter's radius.

    The levels Z, W and O of the entries are measured from the tool before the event.
    """

    entries: Entries
    start: complex
    cutter: float
    feed: float | None

    @classmethod
    def of(cls, view: BlockInMm, entries: Entries, cutter: float) -> Self:
        """Return the event of a block; W and O, which are modal, are among its entries."""
        level, plane = view.position("z"), entries["W"]
        base = 0.0 if view.absolute else plane
        levels = {"W": plane - level, "Z": entries["Z"] + base - level}
        levels |= {"O": entries["O"] - level} if "O" in entries else {}
        return cls(
            {**entries, **levels},
            view.from_centre(),
            cutter,
            view.feed(),
            line=view.line,
            per_rev=view.per_rev,
        )

    @property
    def pocket(self) -> bool:
        """Whether it clears all that is within the wall."""
        return self.entries.get("G", 0.0) == POCKET

    @property
    def side(self) -> int:
        """Where the cutter works: -1 inside the wall, +1 outside, 0 on the circle."""
        turn = -self._turns[0]
        return {0: 0, 1: turn, 2: -turn}[int(self.entries["C"])]  # clockwise: left is outside

    @property
    def inside(self) -> bool:
        return self.side <= 0

    @property
    def word(self) -> str:
        """The entry of the circle on which the tool's centre goes, "" beside a wall."""
        return "" if self.side else "R"

    @property
    def final(self) -> float:
        return self.entries["R"] + self.side * self.cutter

    def cleared(self, cutter: float) -> float:
        """Return the radius within which material may remain."""
        return 0.0 if self.pocket else max(0.0, self.rings[-1] - cutter)

    @property
    def plunge_feed(self) -> float | None:
        return self.entries.get("P", self.feed)

    @property
    def rings(self) -> list[float]:
        """The radii of a level's circles, outward and equally far apart."""
        rough = self.final + self.side * abs(self.entries.get("L", 0.0))
        if not self.pocket:
            return [rough]
        widest = self.entries.get("J", 2 * self.cutter - NARROWER)
        count = max(1, math.ceil((rough - ROUNDING) / widest))
        return [rough * (ring + 1) / count for ring in range(count)]

    @property
    def levels(self) -> list[float]:
        """The levels of the passes, downward."""
        first, final = self.entries["W"], self.entries["Z"]
        rough = final + max(0.0, self.entries.get("L", 0.0))
        peck = self.entries.get("K", first - rough)
        levels = [first - peck]
        while levels[-1] > rough + ROUNDING:
            levels.append(levels[-1] - peck)
        levels[-1] = rough
        return levels + [final] * (rough > final)

    @property
    def stepover(self) -> float | None:
        """The distance between neighbouring passes, None with one ring."""
        return self.rings[0] if len(self.rings) > 1 else None

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: to the plunge point, the levels, the finish, and back."""
        writer, plane = self.writer(self.start), self.entries["W"]
        writer.vertical("rapid up", max(0.0, plane), rapid=True)
        plunge_point = 0j if self.pocket else complex(0.0, -self.rings[-1])
        writer.straight("rapid to the plunge point", plunge_point, rapid=True)
        writer.vertical("rapid to the first reference plane", plane, rapid=True)
        for index, level in enumerate(self.levels):
            if index and self.pocket:
                self._back_to_centre(writer)
            self._level(writer, level)
        if "L" in self.entries:
            self._finish(writer)
        second = self.entries.get("O", plane)
        writer.vertical("rapid to the second reference plane", second, rapid=True)
        writer.straight("rapid back to the start", self.start, rapid=True)
        return writer.path

    @property
    def _turns(self) -> tuple[int, int]:
        """The turns of roughing and of the finish."""
        return ROUGH_FINISH[int(self.entries.get("D", 0.0))]

    def _level(self, writer: Writer, level: float) -> None:
        writer.vertical("plunge", level, self.plunge_feed)
        for radius in self.rings:
            writer.straight("stepover", complex(0.0, -radius), self.feed)
            writer.arc("circle", 0j, 2 * math.pi * self._turns[0], self.feed)

    def _back_to_centre(self, writer: Writer) -> None:
        retracted = min(writer.level + RETRACT, self.entries["W"])
        writer.vertical("retract", retracted, rapid=True)
        writer.straight("rapid back to the centre", 0j, rapid=True)

    def _finish(self, writer: Writer) -> None:
        middle = complex(0.0, -(self.rings[-1] + self.final) / 2)
        turn, feed = math.pi * self._turns[1], self.entries.get("V", self.feed)
        entry = turn if self.side < 0 else -turn
        writer.arc("lead-in of the finish", middle, entry, feed)
        writer.arc("finish circle", 0j, 2 * turn, feed)
        writer.arc("lead-out of the finish", middle, entry, feed)


def words_of_call(arguments: Sequence[float]) -> dict[str, float]:
    """Return the entries of ``o<circle_mill> call`` as if they were words of a block."""
    given = zip(CALL_ENTRIES, arguments)
    return {letter: value for letter, value in given if value != LEFT_OUT}


def entries_of_call(view: BlockInMm) -> dict[str, float]:
    return _entries(view, ENTRIES_OF_CALL)


def entries_of_code(view: BlockInMm, pocket: bool) -> dict[str, float]:
    """Return the entries of a G12.2 or G13.2 block; with L0 only the side has a finish."""
    entries = _entries(view, ENTRIES_OF_CODE)
    if view.words.get("L") == 0.0:
        entries["L"] = -entries["L"]
    return {**entries, "G": POCKET if pocket else 0.0}


def _entries(view: BlockInMm, words: Mapping[str, str]) -> dict[str, float]:
    """Return the entries of a block, lengths in mm; ``words`` are their letters."""
    return {
        entry: view.words[word] if entry in NUMBERS else view.length(word)
        for entry, word in words.items()
        if word in view.words
    }
