# SPDX-License-Identifier: GPL-2.0-or-later
"""The order in which the programs of a file are written: each below all of its calls.

LinuxCNC looks for a subprogram from the call on downwards; other controls do not mind. A file whose
main program is first and whose subprograms stand below their calls stays in its order.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from graphlib import CycleError, TopologicalSorter
from heapq import heappop, heappush
from itertools import groupby
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
    parts = [*_file_parts(followed.structure, count), *_copied_parts(followed.structure)]
    part_of = {number: at for at, part in enumerate(parts) for number in part.numbers}
    above: dict[int, set[int]] = {at: set() for at in range(len(parts))}
    below: dict[int, set[int]] = {at: set() for at in range(len(parts))}
    for number, callers in followed.callers.items():
        for caller in {followed.structure.programs[index] for index in callers}:
            above[part_of[number]].add(part_of[caller])
            below[part_of[caller]].add(part_of[number])
    done = _sorted_parts(above)
    circular = above.keys() - set(done) - set(_sorted_parts(below))
    return WrittenOrder(
        [row for at in done for row in parts[at].rows],
        frozenset(number for at in circular for number in parts[at].numbers),
    )


def _file_parts(structure: Structure, count: int) -> list[FilePart]:
    """Return the parts of a file: one for each program that begins a line, and the text around."""
    rows = [WrittenRow(line, []) for line in range(1, count + 1)]
    for index, block in enumerate(structure.blocks[: structure.own]):
        rows[block.line - 1].indices.append(index)
    parts: list[FilePart] = []
    begun, numbers = 1, [] if MAIN in structure.starts.values() else [MAIN]
    for index in sorted(index for index in structure.starts if index < structure.own):
        line = structure.blocks[index].line
        if line > begun and structure.blocks[index - 1].line != line:
            parts.append(FilePart(rows[begun - 1 : line - 1], numbers))
            begun, numbers = line, []
        numbers.append(structure.starts[index])
    last = structure.blocks[structure.own - 1] if structure.own else None
    closed = last and last.kind == "tape" and last.line > begun
    end = last.line if closed else count + 1
    return [*parts, FilePart(rows[begun - 1 : end - 1], numbers), FilePart(rows[end - 1 :], [])]


def _copied_parts(structure: Structure) -> Iterator[FilePart]:
    starts = sorted(index for index in structure.starts if index >= structure.own)
    for start, end in zip(starts, [*starts[1:], len(structure.blocks)]):
        indices = groupby(range(start, end), lambda index: structure.blocks[index].line)
        rows = [WrittenRow(line, list(found)) for line, found in indices]
        yield FilePart(rows, [structure.starts[start]])


def _sorted_parts(before: Mapping[int, set[int]]) -> list[int]:
    """Return parts so that each is behind those before it, and otherwise in their order.

    Those in a circle, and those behind one, are left out.
    """
    sorter = TopologicalSorter(before)
    with suppress(CycleError):
        sorter.prepare()
    ready, done = sorted(sorter.get_ready()), []
    while ready:
        done.append(heappop(ready))
        sorter.done(done[-1])
        for at in sorter.get_ready():
            heappush(ready, at)
    return done
