# SPDX-License-Identifier: GPL-2.0-or-later
"""Maps each line of a filter's output to its line in the source, by comparing both texts.

Anchors are lines that occur once in each text with the same block number, or the same text apart
from blanks and case; the longest run of them in order counts. An equal number of lines between two
anchors is mapped one to one. Inserted lines belong to the line before them, and the lines that
replace one line belong to it. Where a stretch has another number of lines, the mapping is unknown.
"""

import re
from collections.abc import Iterator, Sequence

from patiencediff import unique_lcs

BLOCK_NUMBER = re.compile(rb"/?N[0-9]+")


def aligned_lines(source: Sequence[bytes], written: Sequence[bytes]) -> tuple[int, ...] | None:
    """Return the source line (from 1) of each line of the output, None where it is unknown."""
    before, after = [_key(row) for row in source], [_key(row) for row in written]
    found: list[int] = []
    last = (-1, -1)
    for pair in [*_anchors(before, after), (len(before), len(after))]:
        stretch = range(last[0] + 1, pair[0])
        lines = _lines_of_stretch(stretch, range(last[1] + 1, pair[1]), before, after)
        if lines is None or (not source and written):
            return None
        found += [*lines, pair[0]]
        last = pair
    return tuple(line + 1 for line in found[: len(written)])


def _key(row: bytes) -> bytes:
    text = b"".join(row.upper().split())
    number = BLOCK_NUMBER.match(text)
    return number[0] if number else text


def _anchors(before: Sequence[bytes], after: Sequence[bytes]) -> list[tuple[int, int]]:
    """Return the indices of lines that occur once in both texts, in the order of both."""
    return unique_lcs([key or row for row, key in enumerate(before)], after)  # not empty lines


def _lines_of_stretch(
    stretch: range, written: range, before: Sequence[bytes], after: Sequence[bytes]
) -> list[int] | None:
    """Return the index of the source's line for each line between two anchors."""
    head = list(_same(stretch, written, before, after))
    stretch, written = stretch[len(head) :], written[len(head) :]
    tail = list(_same(stretch[::-1], written[::-1], before, after))[::-1]
    changed, count = stretch[: len(stretch) - len(tail)], len(written) - len(tail)
    if len(changed) == count:
        middle = list(changed)
    elif len(changed) <= 1:
        middle = [changed[0] if changed else max(0, changed.start - 1)] * count
    elif count == 0:
        middle = []
    else:
        return None
    return [*head, *middle, *tail]


def _same(
    stretch: range, written: range, before: Sequence[bytes], after: Sequence[bytes]
) -> Iterator[int]:
    """Yield the equal lines at the start."""
    for old, new in zip(stretch, written):
        if before[old] != after[new]:
            return
        yield old
