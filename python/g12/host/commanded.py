# SPDX-License-Identifier: GPL-2.0-or-later
"""What a cycle commands for later blocks of the program, and where it did so.

LinuxCNC tells no handler that a program begins. The place in the text tells it: a value that was
commanded further down is an earlier run's, or that of a loop's last turn.
"""

from __future__ import annotations

from typing import NamedTuple

from g12.cycles.plan import EventPlanes
from g12.host.interp import Interp
from g12.host.messages import in_mdi, main_program


class Place(NamedTuple):
    """A block's place: the program's file with its time of change, and the bytes above the block.

    ``offsets`` are those of the blocks that call, from the program down, and of the block itself;
    none of a block typed in MDI, which belongs to the loaded program.
    """

    program: tuple[str, int] | None
    offsets: tuple[int, ...]

    def reaches(self, later: Place) -> bool:
        """Return whether a value commanded here is still in force there.

        In MDI that of the loaded program is, in a program none that was typed.
        """
        in_order = not later.offsets or () < self.offsets <= later.offsets
        return self.program == later.program and in_order


def place_of_block(interp: Interp) -> Place:
    """Return the place of the block being remapped."""
    if in_mdi(interp):
        return Place(main_program(interp), ())
    levels = range(interp.call_level - 1)  # the last frame is that of the remap
    calls = (interp.sub_context[level].position - 1 for level in levels)
    return Place(main_program(interp), (*calls, interp.blocks[interp.remap_level].offset))


class CommandedValues:
    """The commanded values of one interpreter: the circle mill's reference planes, in mm."""

    def __init__(self) -> None:
        self.planes = EventPlanes()
        self.planes_place: Place | None = None


def commanded_of(interp: Interp) -> CommandedValues:
    commanded = getattr(interp, "g12_commanded", None)
    if commanded is None:
        commanded = interp.g12_commanded = CommandedValues()
    return commanded
