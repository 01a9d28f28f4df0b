# SPDX-License-Identifier: GPL-2.0-or-later
"""What a cycle commands for later blocks of the program, and where it did so.

LinuxCNC tells no handler that a program begins. The place in the text tells it: a value that was
commanded further down is an earlier run's, or that of a loop's last turn.
"""

from __future__ import annotations

import functools
import re
from math import inf
from typing import NamedTuple

from g12.cycles.plan import EventPlanes
from g12.host.interp import Interp, kept
from g12.host.messages import in_mdi, main_program
from g12.request.context import Tool

COMPENSATION = re.compile(rb"^(?:[^(;\n]|\([^)\n]*\))*?[gG][ \t]*4[12](?!\d)", re.MULTILINE)


class Place(NamedTuple):
    """A block's place: the program's file with its time of change, and the bytes above the block.

    ``offsets`` are those of the blocks that call, from the program down, and of the block itself;
    none of a block typed in MDI, which belongs to the loaded program.
    """

    program: tuple[str, int] | None
    offsets: tuple[int, ...]

    @property
    def is_typed(self) -> bool:
        return not self.offsets

    def reaches(self, later: Place) -> bool:
        """Return whether a value commanded here is still in force there.

        In MDI that of the loaded program is, in a program none that was typed.
        """
        in_order = later.is_typed or () < self.offsets <= later.offsets
        return self.program == later.program and in_order


def place_of_block(interp: Interp) -> Place:
    """Return the place of the block being remapped."""
    if in_mdi(interp):
        return Place(main_program(interp), ())
    levels = range(interp.call_level - 1)  # the last frame is that of the remap
    calls = (interp.sub_context[level].position - 1 for level in levels)
    return Place(main_program(interp), (*calls, interp.blocks[interp.remap_level].offset))


class CommandedValues:
    """The commanded values of one interpreter, in mm.

    ``planes`` are the circle mill's reference planes, ``cutter`` is that of the last D, tool 0
    where G41 or G42 commanded it.
    """

    def __init__(self) -> None:
        self.planes = EventPlanes()
        self.cutter: Tool | None = None
        self._first: dict[tuple[str, bool], Place] = {}  # by value and whether it was typed

    def remember_planes(self, given: EventPlanes, place: Place) -> None:
        """Note the planes that a block gives."""
        for name, plane in given._asdict().items():
            if plane is not None:
                self.planes = self.planes._replace(**{name: plane})
                self._note(name, place)

    def planes_at(self, place: Place) -> EventPlanes:
        """Return those planes that a block above a place gives."""
        planes = self.planes._asdict().items()
        return EventPlanes(**{name: at for name, at in planes if self._stands_above(name, place)})

    def remember_cutter(self, cutter: Tool, place: Place) -> None:
        self.cutter = cutter
        self._note("D", place)

    def gives_d(self, place: Place) -> bool:
        """Return whether a cycle with D stands above a place."""
        return self._stands_above("D", place)

    def _note(self, name: str, place: Place) -> None:
        first = self._first.get((name, place.is_typed))
        if not first or not first.reaches(place):
            self._first[name, place.is_typed] = place

    def _stands_above(self, name: str, place: Place) -> bool:
        """Return whether the first block that commands a value stands above a place."""
        firsts = (self._first.get((name, typed)) for typed in (False, True))
        return any(first.reaches(place) for first in firsts if first)


def commanded_of(interp: Interp) -> CommandedValues:
    return kept(interp, CommandedValues)


def compensates_above(place: Place) -> bool:
    """Return whether the program switches G41 or G42 on above a place; subs are not searched."""
    if place.is_typed or not place.program:
        return False
    return first_compensation(*place.program) < place.offsets[0]


@functools.lru_cache(maxsize=8)
def first_compensation(filename: str, changed: int) -> float:
    """Return the byte in a file at which G41 or G42 first stands; inf if it has none."""
    with open(filename, "rb") as file:
        found = COMPENSATION.search(file.read())
    return found.end() if found else inf
