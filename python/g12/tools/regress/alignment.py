# SPDX-License-Identifier: GPL-2.0-or-later
"""Which items of two long sequences correspond, when some were inserted, removed or changed.

Equal items at both ends are paired, then items that occur once on each side, in the longest order
they have in common (the "patience" of version control), and so on between these anchors. Only a
short stretch without an anchor is compared item by item, so the time grows with the length and not
with its square.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Hashable, Sequence
from difflib import SequenceMatcher

MOST_COMPARED = 250_000  # product of the lengths of a stretch without anchors

Pair = tuple  # index in the one sequence, index in the other


def pairs(one: Sequence[Hashable], other: Sequence[Hashable]) -> list[Pair]:
    """Return the indices of equal items that correspond, rising in both sequences."""
    found: list[Pair] = []
    stretches = [(0, len(one), 0, len(other))]
    while stretches:
        stretch, ends = _without_ends(one, other, *stretches.pop())
        found += ends
        anchors = _anchors(one, other, *stretch)
        if anchors:
            stretches += _between(anchors, *stretch)
            found += anchors
        else:
            found += _short(one, other, *stretch)
    return sorted(found)


def _without_ends(one, other, low, high, other_low, other_high) -> tuple[tuple, list[Pair]]:
    """Return a stretch without its equal ends, and the pairs of these."""
    ends = []
    while low < high and other_low < other_high and one[low] == other[other_low]:
        ends.append((low, other_low))
        low, other_low = low + 1, other_low + 1
    while low < high and other_low < other_high and one[high - 1] == other[other_high - 1]:
        high, other_high = high - 1, other_high - 1
        ends.append((high, other_high))
    return (low, high, other_low, other_high), ends


def _anchors(one, other, low, high, other_low, other_high) -> list[Pair]:
    """Items that occur once on each side, as many as are in the same order."""
    here, there = Counter(one[low:high]), Counter(other[other_low:other_high])
    place = {other[j]: j for j in range(other_low, other_high) if there[other[j]] == 1}
    once = [(i, place[one[i]]) for i in range(low, high) if here[one[i]] == 1 and one[i] in place]
    return _longest_rising(once)


def _longest_rising(candidates: list[Pair]) -> list[Pair]:
    """Return most of the pairs, rising in both indices."""
    ends: list[int] = []  # least last value of a rising part of each length
    owners: list[int] = []
    before: list[int] = []
    for index, (_, value) in enumerate(candidates):
        length = bisect_left(ends, value)
        before.append(owners[length - 1] if length else -1)
        ends[length : length + 1], owners[length : length + 1] = [value], [index]
    found, index = [], owners[-1] if owners else -1
    while index >= 0:
        found.append(candidates[index])
        index = before[index]
    return found[::-1]


def _between(anchors: list[Pair], low, high, other_low, other_high) -> list[tuple]:
    starts = [(low, other_low), *((i + 1, j + 1) for i, j in anchors)]
    stops = [*anchors, (high, other_high)]
    gaps = [(i, stop, j, other_stop) for (i, j), (stop, other_stop) in zip(starts, stops)]
    return [gap for gap in gaps if gap[0] < gap[1] and gap[2] < gap[3]]


def _short(one, other, low, high, other_low, other_high) -> list[Pair]:
    if (high - low) * (other_high - other_low) > MOST_COMPARED:
        return []
    matcher = SequenceMatcher(None, one[low:high], other[other_low:other_high], autojunk=False)
    blocks = matcher.get_matching_blocks()
    return [(low + b.a + k, other_low + b.b + k) for b in blocks for k in range(b.size)]
