# SPDX-License-Identifier: GPL-2.0-or-later
"""Aligns two long sequences, some of whose items were inserted, removed or changed.

patiencediff pairs items that occur once on each side, so the time grows with the length and not
with its square. A short stretch between them, of items that occur more than once, is compared item
by item.
"""

from collections.abc import Hashable, Iterator, Sequence
from difflib import SequenceMatcher

from patiencediff import PatienceSequenceMatcher

MOST_COMPARED = 250_000  # product of the lengths of a stretch

EqualRun = tuple[int, int, int]  # a run of equal items: its start in both sequences, its length


def pairs(one: Sequence[Hashable], other: Sequence[Hashable]) -> list[tuple[int, int]]:
    """Return the indices of equal items that correspond, rising in both sequences."""
    found = PatienceSequenceMatcher(None, one, other).get_matching_blocks()
    return [(i + k, j + k) for i, j, size in _filled(one, other, found) for k in range(size)]


def _filled(
    one: Sequence[Hashable], other: Sequence[Hashable], blocks: Sequence[EqualRun]
) -> Iterator[EqualRun]:
    """Yield blocks, and before each those of the short stretch that it leaves out."""
    i = j = 0
    for block in blocks:
        some, others = one[i : block[0]], other[j : block[1]]
        if 0 < len(some) * len(others) <= MOST_COMPARED:
            matcher = SequenceMatcher(None, some, others, autojunk=False)
            yield from ((i + a, j + b, size) for a, b, size in matcher.get_matching_blocks())
        yield block
        i, j = block[0] + block[2], block[1] + block[2]
