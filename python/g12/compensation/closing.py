# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a contour closes: its moves beyond that point are lead-in and lead-out.

A contour closes where one of its first moves meets one of its last: the one ends on the other, or
both are long enough to cross, as leads do that overrun a corner. Program units.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate, product
from typing import NamedTuple

from g12.compensation.contour import SAME_POINT
from g12.geometry.crossing import common_points
from g12.geometry.curve import Curve

LEADS = 3  # moves at either end of a contour that are searched for the point where it closes
CROSSING = 2  # moves at either end that may cross each other
LEAST_LEAD_SHARE = 0.5  # of a lead's length: a contour is at least this long, or
LEAST_RADII = 4.0  # tool radii
LEAST_SINE = 0.05  # of the angle between moves: below this they touch, they do not cross
LEAST_CONTOUR = 5  # least moves of a contour in which a crossing lead may have more than one move


class Closing(NamedTuple):
    """The contour from a length along its move ``first`` to one along its move ``last``.

    ``closed`` is False for an open contour, which has no leads. ``crossing``: the leads cross, and
    end on both sides of the contour.
    """

    first: int
    start: float
    last: int
    end: float
    closed: bool
    crossing: bool

    def shares(self, index: int, curve: Curve) -> tuple[float, float]:
        """Return the shares of a move between which it belongs to the contour; else (0, 0)."""
        if not self.first <= index <= self.last:
            return 0.0, 0.0
        length = curve.length
        start = self.start if index == self.first else 0.0
        end = self.end if index == self.last else length
        return (start / length, end / length) if end - start > SAME_POINT else (0.0, 0.0)


def closing_of(curves: Sequence[Curve], radius: float, near: float) -> Closing:
    """Return where a contour closes; points up to ``near`` apart meet.

    A loop much shorter than the leads and the tool is a spur of an open contour.
    """
    count, ends = len(curves), [0.0, *accumulate(curve.length for curve in curves)]
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        found = [each for each in _meetings(curves, i, j, near) if each.allowed] if j > i else []
        if found:
            start, end, crossing, _ = max(found, key=lambda each: each.start - each.end)
            lead = max(ends[i] + start, ends[-1] - ends[j] - end)
            least = min(LEAST_LEAD_SHARE * lead, LEAST_RADII * radius)
            if ends[j] + end - ends[i] - start >= least:
                return Closing(i, start, j, end, True, crossing)
    is_round = abs(curves[0].start - curves[-1].end) <= near
    return Closing(0, 0.0, count - 1, curves[-1].length, is_round, False)


class _Meeting(NamedTuple):
    start: float
    end: float
    crossing: bool
    allowed: bool


def _meetings(curves: Sequence[Curve], i: int, j: int, near: float) -> Iterator[_Meeting]:
    """Yield the meetings of moves ``i`` and ``j``; of neighbours in the later half of ``j``."""
    one, other, count = curves[i], curves[j], len(curves)
    skipped = 0.5 if j == i + 1 else 0.0
    if skipped:
        other = other.portion(skipped, 1.0)
    length, rest = one.length, other.length
    outer = (i, j) == (0, count - 1)
    leads = count >= LEAST_CONTOUR and i < CROSSING and j >= count - CROSSING
    for a, b in _points(one, other, near):
        start = min(max(one.length_to(a), 0.0), length)
        end = min(max(other.length_to(b, late=True), 0.0), rest)
        inside = near < start < length - near, near < end < rest - near
        joints = _joined_directions(curves, i, start), _joined_directions(curves, j, end)
        crossing = all(inside) or any(
            within and joint and _goes_through(joint, curve, point)
            for within, joint, curve, point in zip(inside[::-1], joints, (other, one), (b, a))
        )
        passed = skipped * curves[j].length
        yield _Meeting(start, passed + end, crossing, outer or leads or not crossing)


def _joined_directions(curves: Sequence[Curve], k: int, along: float) -> tuple[complex, ...]:
    """Return the directions on both sides of the nearer end of a move, if others join it."""
    at_end = along > 0.5 * curves[k].length
    first = k if at_end else k - 1
    if not 0 <= first < len(curves) - 1:
        return ()
    return curves[first].direction(1.0), curves[first + 1].direction(0.0)


def _goes_through(joint: tuple[complex, ...], curve: Curve, point: complex) -> bool:
    """Return whether two moves joined at a point of a third lie on both sides of it."""
    along = curve.direction(curve.share_of(point)).conjugate()
    sines = [(along * direction).imag for direction in joint]
    return min(sines) > LEAST_SINE or max(sines) < -LEAST_SINE


def _points(one: Curve, other: Curve, near: float) -> Iterator[tuple[complex, complex]]:
    """Yield points on two moves that are at most ``near`` apart."""
    for point in common_points(one, other):
        yield point, point
    pairs = [(end, other.point(other.share_of(end))) for end in (one.start, one.end)]
    pairs += [(one.point(one.share_of(end)), end) for end in (other.start, other.end)]
    yield from ((a, b) for a, b in pairs if abs(a - b) <= near)
