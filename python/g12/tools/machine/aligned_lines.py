# SPDX-License-Identifier: GPL-2.0-or-later
"""Maps each line of a filter's output to its line in the source, by comparing both texts.

Lines are equal with the same block number, or the same text apart from blanks and case. Inserted
lines belong to the line before them, and the lines that replace one line belong to it. An equal
number of lines that differ is mapped one to one; otherwise the mapping is unknown.
"""

import re
from collections.abc import Sequence
from difflib import SequenceMatcher
from itertools import takewhile

BLOCK_NUMBER = re.compile(rb"/?N[0-9]+")
MOST_COMPARED = 1000  # lines of which repeated ones are compared each with each


def aligned_lines(source: Sequence[bytes], written: Sequence[bytes]) -> tuple[int, ...] | None:
    """Return the source line (from 1) of each line of the output, None where it is unknown."""
    before, after = [_key(row) for row in source], [_key(row) for row in written]
    if not before:
        return None if after else ()
    head = _equal(before, after)
    tail = _equal(before[head:][::-1], after[head:][::-1])
    end = len(before) - tail
    middle = before[head:end], after[head : len(after) - tail]
    many = max(map(len, middle)) > MOST_COMPARED
    found = list(range(head))
    for _, first, last, at, to in SequenceMatcher(None, *middle, autojunk=many).get_opcodes():
        lines, count = list(range(head + first, head + last)), to - at
        if len(lines) != count:
            if len(lines) > 1 and count:
                return None
            lines = [max(0, head + last - 1)] * count
        found += lines
    return tuple(line + 1 for line in (*found, *range(end, len(before))))


def _key(row: bytes) -> bytes:
    text = b"".join(row.upper().split())
    number = BLOCK_NUMBER.match(text)
    return number[0] if number else text


def _equal(before: Sequence[bytes], after: Sequence[bytes]) -> int:
    """Return how many lines are equal at the start."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(before, after)))
