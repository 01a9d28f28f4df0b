# SPDX-License-Identifier: GPL-2.0-or-later
"""The order in which the programs of a file are written: each below all of its calls.

LinuxCNC looks for a subprogram from the call on downwards; other controls do not mind. A file whose
main program is first and whose subprograms stand below their calls stays in its order.
"""

from graphlib import CycleError, TopologicalSorter
from typing import NamedTuple

from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.structure import MAIN, Structure


class WrittenRow(NamedTuple):
    """A line of a file, and the indices of the blocks that are written for it."""

    line: int
    indices: list[int]


class FilePart(NamedTuple):
    """Lines that stay together, and the numbers of the programs in them."""

    rows: list[WrittenRow]
    numbers: list[int]


class WrittenOrder(NamedTuple):
    """The lines of a file in the order in which they are written.

    ``circular`` are the numbers of programs that cannot stand below all of their calls.
    """

    rows: list[WrittenRow]
    circular: frozenset[int]


def written_order(followed: FollowedProgram, count: int) -> WrittenOrder:
    parts = _file_parts(followed.structure, count)
    part_of = {number: at for at, part in enumerate(parts) for number in part.numbers}
    above: dict[int, set[int]] = {at: set() for at in range(len(parts))}
    for number, callers in followed.callers.items():
        callers_parts = {part_of[followed.structure.programs[index]] for index in callers}
        above[part_of[number]] |= callers_parts
    sorter = TopologicalSorter(above)
    try:
        sorter.prepare()
    except CycleError as cycle:
        return WrittenOrder([], frozenset(n for at in cycle.args[1] for n in parts[at].numbers))
    ready: list[int] = []
    rows: list[WrittenRow] = []
    while sorter.is_active():
        first, *ready = sorted((*ready, *sorter.get_ready()))
        rows += parts[first].rows
        sorter.done(first)
    return WrittenOrder(rows, frozenset())


def _file_parts(structure: Structure, count: int) -> list[FilePart]:
    """Return the parts of a file: one for each program that begins a line, and the text around."""
    rows = [WrittenRow(line, []) for line in range(1, count + 1)]
    for index, block in enumerate(structure.blocks):
        rows[block.line - 1].indices.append(index)
    parts: list[FilePart] = []
    begun, numbers = 1, [] if MAIN in structure.starts.values() else [MAIN]
    for index in sorted(structure.starts):
        line = structure.blocks[index].line
        if line > begun and structure.blocks[index - 1].line != line:
            parts.append(FilePart(rows[begun - 1 : line - 1], numbers))
            begun, numbers = line, []
        numbers.append(structure.starts[index])
    last = structure.blocks[-1] if structure.blocks else None
    closed = last and last.kind == "tape" and last.line > begun
    end = last.line if closed else count + 1
    return [*parts, FilePart(rows[begun - 1 : end - 1], numbers), FilePart(rows[end - 1 :], [])]
