# SPDX-License-Identifier: GPL-2.0-or-later
"""The order in which the programs of a file are written: each below all of its calls.

LinuxCNC looks for a subprogram from the call on downwards; other controls do not mind. A file whose
main program is first and whose subprograms stand below their calls stays in its order.
"""

from collections.abc import Collection, Iterator, Mapping
from heapq import heapify, heappop, heappush
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
    """Return the order of the ``count`` lines of a file."""
    parts = [*_file_parts(followed.structure, count), *_copied_parts(followed.structure)]
    part_of = {number: at for at, part in enumerate(parts) for number in part.numbers}
    below: dict[int, set[int]] = {at: set() for at in range(len(parts))}
    for number, callers in followed.callers.items():
        for caller in callers:
            below[part_of[caller]].add(part_of[number])
    done = _sorted_parts(below)
    unsorted = below.keys() - set(done)
    circular = frozenset(
        number for at in _in_circles(unsorted, below) for number in parts[at].numbers
    )
    return WrittenOrder([row for at in done for row in parts[at].rows], circular)


def _file_parts(structure: Structure, count: int) -> list[FilePart]:
    """Return the parts of a file: one for each program that begins a line, and the text around."""
    rows = [WrittenRow(line, []) for line in range(1, count + 1)]
    for index, block in enumerate(structure.blocks[: structure.own]):
        rows[block.line - 1].indices.append(index)
    parts: list[FilePart] = []
    begun, numbers = 1, [] if MAIN in structure.starts.values() else [MAIN]
    for index in sorted(index for index in structure.starts if index < structure.own):
        line = structure.blocks[index].line
        if line > begun and _begins_line(structure, index):
            parts.append(FilePart(rows[begun - 1 : line - 1], numbers))
            begun, numbers = line, []
        numbers.append(structure.starts[index])
    end = _end_of_programs(structure, begun, count)
    return [*parts, FilePart(rows[begun - 1 : end - 1], numbers), FilePart(rows[end - 1 :], [])]


def _copied_parts(structure: Structure) -> Iterator[FilePart]:
    starts = sorted(index for index in structure.starts if index >= structure.own)
    for start, end in zip(starts, [*starts[1:], len(structure.blocks)]):
        indices = groupby(range(start, end), lambda index: structure.blocks[index].line)
        rows = [WrittenRow(line, list(found)) for line, found in indices]
        yield FilePart(rows, [structure.starts[start]])


def _begins_line(structure: Structure, index: int) -> bool:
    blocks = structure.blocks
    return index == 0 or blocks[index - 1].line != blocks[index].line


def _end_of_programs(structure: Structure, begun: int, count: int) -> int:
    """Return the line of the closing ``%``, or the line after the last."""
    last = structure.blocks[structure.own - 1] if structure.own else None
    return last.line if last and last.kind == "tape" and last.line > begun else count + 1


def _sorted_parts(below: Mapping[int, set[int]]) -> list[int]:
    """Return parts so that each is below its callers, and otherwise in their order."""
    above = dict.fromkeys(below, 0)
    for called in below.values():
        for at in called:
            above[at] += 1
    ready = [at for at, callers in above.items() if callers == 0]
    heapify(ready)
    done: list[int] = []
    while ready:
        done.append(heappop(ready))
        for at in below[done[-1]]:
            above[at] -= 1
            if above[at] == 0:
                heappush(ready, at)
    return done


def _in_circles(unsorted: Collection[int], below: Mapping[int, set[int]]) -> Iterator[int]:
    """Yield the unsorted parts that are in a circle, not only below one."""
    inside = set(unsorted)
    above = {at: below[at] & inside for at in inside}
    callers: dict[int, list[int]] = {at: [] for at in inside}
    for at, called in above.items():
        for one in called:
            callers[one].append(at)
    bare = [at for at, called in above.items() if not called]
    while bare:
        at = bare.pop()
        inside.discard(at)
        for caller in callers[at]:
            above[caller].discard(at)
            if not above[caller]:
                bare.append(caller)
    yield from sorted(inside)
