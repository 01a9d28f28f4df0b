# SPDX-License-Identifier: GPL-2.0-or-later
"""The edits from the steps of one recording to those of another.

Moves are paired by end point and curvature, within a tolerance, so an inserted block is one edit
and the moves after it are none. All properties of a pair are compared. Between pairs, an equal
number of moves is compared in order. Where the number has changed, moves are paired by their
displacement if most of those are unchanged, as in a shifted program; else they are one edit.

Lengths are millimetres, angles degrees.
"""

import math
from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.part import arc_points
from g12.tools.preview.moves import IS_LENGTH, Move
from g12.tools.regress.alignment import pairs
from g12.tools.regress.recording_text import Note, RecordedStep, turns_only

Numbers = Callable[[Move], tuple[float, ...]]  # of a move: nine of its end, three of its centre
OfGap = Callable[[range, range], Iterator["Edit"]]

NO_CENTRE = (0.0, 0.0, 0.0)
MOST_OF = 0.8


class Tolerance(NamedTuple):
    """What counts as equal: ends in mm, ends in degrees, feeds as a share."""

    length: float
    angle: float
    feed: float

    @property
    def ends(self) -> tuple[float, ...]:
        return tuple(self.length if linear else self.angle for linear in IS_LENGTH)


class Change(NamedTuple):
    """One changed property of a step.

    ``what`` is an axis (``by`` in mm or degrees), radius (``by`` is how far the arc's middle
    moved, mm), feed or rotary feed (``by`` is a share), or kind, direction, plane, feed mode,
    note with texts.
    """

    what: str
    by: float
    was: float | str
    now: float | str


class Edit(NamedTuple):
    """An edit of steps, by their indices.

    ``changes`` are those of a pair; without them steps were added, are missing, or are replaced.
    """

    was: tuple[int, ...]
    now: tuple[int, ...]
    changes: tuple[Change, ...] = ()


def edits_of(
    was: Sequence[RecordedStep], now: Sequence[RecordedStep], tolerance: Tolerance
) -> list[Edit]:
    """Return the edits between two recordings' steps, in order."""
    return list(_Comparison(was, now, tolerance).edits())


class _Comparison:
    """Steps of two recordings; ``before`` and ``after`` are ranges of their indices."""

    def __init__(
        self, was: Sequence[RecordedStep], now: Sequence[RecordedStep], tolerance: Tolerance
    ) -> None:
        self._was, self._now, self._tolerance = was, now, tolerance

    def edits(self) -> Iterator[Edit]:
        before, after = range(len(self._was)), range(len(self._now))
        paired = self._paired(before, after, _end_and_centre)
        return self._around(paired, before, after, self._gap)

    def _paired(self, before: range, after: range, numbers: Numbers) -> list[tuple[int, int]]:
        """Return pairs of steps whose moves are equal in some numbers, within the tolerance."""
        steps = [*self._was[before.start : before.stop], *self._now[after.start : after.stop]]
        keys = _keys(steps, numbers, self._tolerance)
        found = pairs(keys[: len(before)], keys[len(before) :])
        return [(before.start + i, after.start + j) for i, j in found]

    def _around(
        self, paired: list[tuple[int, int]], before: range, after: range, of_gap: OfGap
    ) -> Iterator[Edit]:
        """Yield the edits of pairs, and of the steps between them."""
        i, j = before.start, after.start
        for pair in paired:
            yield from of_gap(range(i, pair[0]), range(j, pair[1]))
            yield from self._pair(*pair)
            i, j = pair[0] + 1, pair[1] + 1
        yield from of_gap(range(i, before.stop), range(j, after.stop))

    def _gap(self, before: range, after: range) -> Iterator[Edit]:
        same = len(_only(self._was, before, Move)) == len(_only(self._now, after, Move))
        paired = [] if same else self._paired(before, after, _displacement)
        if paired and len(paired) >= MOST_OF * min(len(before), len(after)):
            return self._around(paired, before, after, self._in_order)
        return self._in_order(before, after)

    def _in_order(self, before: range, after: range) -> Iterator[Edit]:
        """Yield the edits of an equal number of moves one by one, of others as one."""
        moves, other_moves = _only(self._was, before, Move), _only(self._now, after, Move)
        notes, other_notes = _only(self._was, before, Note), _only(self._now, after, Note)
        if len(moves) != len(other_moves):
            yield Edit(tuple(before), tuple(after))
            return
        paired = list(zip(moves, other_moves))
        if len(notes) == len(other_notes):
            paired = sorted([*paired, *zip(notes, other_notes)])
        else:
            yield Edit(notes, other_notes)
        for pair in paired:
            yield from self._pair(*pair)

    def _pair(self, i: int, j: int) -> Iterator[Edit]:
        found = changes(self._was[i], self._now[j], self._tolerance)
        if found:
            yield Edit((i,), (j,), tuple(found))


def _only(steps: Sequence[RecordedStep], indices: range, kind: type) -> tuple[int, ...]:
    return tuple(index for index in indices if isinstance(steps[index], kind))


def _keys(steps: Sequence[RecordedStep], numbers: Numbers, tolerance: Tolerance) -> list[Hashable]:
    """Return a key for each step, equal for moves that are equal within the tolerance."""
    rows = [numbers(step) for step in steps if isinstance(step, Move)]
    columns = np.array(rows).reshape(-1, 12).T
    tolerances = (*tolerance.ends, *[tolerance.length] * 3)
    clusters = iter(zip(*(_clusters(column, tol) for column, tol in zip(columns, tolerances))))
    return [
        (step.text,) if isinstance(step, Note) else (step.kind, step.turns, *next(clusters))
        for step in steps
    ]


def _clusters(values: np.ndarray, tolerance: float) -> list[int]:
    """Return cluster numbers of values; values nearer than the tolerance share one."""
    order = np.argsort(values)
    numbers = np.empty(len(values), int)
    numbers[order] = np.cumsum(np.diff(values[order], prepend=values[order][:1]) > tolerance)
    return numbers.tolist()


def _end_and_centre(move: Move) -> tuple[float, ...]:
    return (*move.end, *(move.centre or NO_CENTRE))


def _displacement(move: Move) -> tuple[float, ...]:
    """Return a move's end and its centre, relative to its start."""
    points = zip(move.start * 2, (*move.end, *(move.centre or move.start[:3])))
    return tuple(b - a for a, b in points)


def changes(was: RecordedStep, now: RecordedStep, tolerance: Tolerance) -> list[Change]:
    if isinstance(was, Note) and isinstance(now, Note):
        return [Change("note", 0.0, was.text, now.text)] if was.text != now.text else []
    assert isinstance(was, Move) and isinstance(now, Move)
    found = [
        Change(axis, b - a, a, b)
        for axis, a, b, most in zip(AXIS_LETTERS, was.end, now.end, tolerance.ends)
        if abs(b - a) > most
    ]
    if was.kind != now.kind:
        found.append(Change("kind", 0.0, was.kind, now.kind))
    elif was.kind == "arc":
        found += _arc_changes(was, now, tolerance, moved=bool(found))
    return found + _feed_changes(was, now, tolerance)


def _arc_changes(was: Move, now: Move, tolerance: Tolerance, moved: bool) -> list[Change]:
    """Compare arcs by their middle point: the centre of a flat arc is too sensitive."""
    if was.plane != now.plane:
        return [Change("plane", 0.0, f"G{was.plane}", f"G{now.plane}")]
    if was.turns != now.turns:
        return [Change("direction", 0.0, _direction(was), _direction(now))]
    if moved or math.dist(was.centre, now.centre) <= tolerance.length:
        return []
    by = math.dist(*(arc_points(move, np.array([0.5]))[0, :3] for move in (was, now)))
    return [Change("radius", by, was.radius, now.radius)] if by > tolerance.length else []


def _direction(move: Move) -> str:
    sense = "clockwise" if move.turns < 0 else "counterclockwise"
    return sense if abs(move.turns) == 1 else f"{sense}, {abs(move.turns)} turns"


def _feed_changes(was: Move, now: Move, tolerance: Tolerance) -> list[Change]:
    if "rapid" in (was.kind, now.kind):
        return []
    if was.feed_mode != now.feed_mode:
        return [Change("feed mode", 0.0, was.feed_mode, now.feed_mode)]
    larger = max(was.feed, now.feed)
    if abs(now.feed - was.feed) <= tolerance.feed * larger:
        return []
    what = "rotary feed" if turns_only(now) else "feed"
    return [Change(what, (now.feed - was.feed) / larger, was.feed, now.feed)]
