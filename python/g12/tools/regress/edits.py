# SPDX-License-Identifier: GPL-2.0-or-later
"""The edits from the steps of one recording to those of another.

Moves are paired by end point and curvature, within a tolerance, so an inserted block is one edit
and the moves after it are none. All properties of a pair are compared. Between pairs, an equal
number of moves is compared in order. Where the number has changed, moves are paired by their
displacement if most of those are unchanged, as in a shifted program; else they are one edit.

Lengths are millimetres, angles degrees.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.preview.moves import IS_LENGTH, Move
from g12.tools.regress.alignment import pairs
from g12.tools.regress.recording_text import Note, RecordedStep, turns_only

NO_CENTRE = (0.0, 0.0, 0.0)
MOST_OF = 0.8


class Tolerance(NamedTuple):
    """What counts as equal: ends in mm, ends in degrees, feeds as a share."""

    length: float
    angle: float
    feed: float

    @property
    def ends(self) -> tuple[float, ...]:
        """Return the tolerance of each axis."""
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
    found: list[Edit] = []
    paired = _paired(was, now, _end_and_centre, tolerance)
    for before, after, pair in _walk(paired, range(len(was)), range(len(now))):
        found += _gap(was, now, before, after, tolerance)
        found += _pair(was, now, pair, tolerance) if pair else []
    return found


def _paired(was, now, numbers, tolerance: Tolerance) -> list[tuple[int, int]]:
    """Return pairs of steps whose moves are equal within the tolerance."""
    keys = _keys([*was, *now], numbers, tolerance)
    return pairs(keys[: len(was)], keys[len(was) :])


def _keys(steps: Sequence[RecordedStep], numbers, tolerance: Tolerance) -> list[tuple[int, int]]:
    """Return a key for each step, equal for moves that are equal within the tolerance."""
    rows = [numbers(step) for step in steps if isinstance(step, Move)]
    columns = np.array(rows).reshape(-1, 12).T
    tolerances = (*tolerance.ends, *[tolerance.length] * 3)
    clusters = iter(zip(*(_clusters(column, tol) for column, tol in zip(columns, tolerances))))
    return [
        (step.text,) if isinstance(step, Note) else (step.kind, step.turns, *next(clusters))
        for step in steps
    ]


def _end_and_centre(move: Move) -> tuple[float, ...]:
    return (*move.end, *(move.centre or NO_CENTRE))


def _displacement(move: Move) -> tuple[float, ...]:
    """Return a move's end and its centre, relative to its start."""
    points = zip(move.start * 2, (*move.end, *(move.centre or move.start[:3])))
    return tuple(b - a for a, b in points)


def _walk(paired, before: range, after: range) -> Iterator[tuple[range, range, tuple | None]]:
    """Yield the steps on both sides before each pair, and the pair; None as the last pair."""
    i, j = before.start, after.start
    for pair in paired:
        yield range(i, pair[0]), range(j, pair[1]), pair
        i, j = pair[0] + 1, pair[1] + 1
    yield range(i, before.stop), range(j, after.stop), None


def _clusters(values: np.ndarray, tolerance: float) -> list[int]:
    """Return cluster numbers of values; values nearer than the tolerance share one."""
    order = np.argsort(values)
    numbers = np.empty(len(values), int)
    numbers[order] = np.cumsum(np.diff(values[order], prepend=values[order][:1]) > tolerance)
    return numbers.tolist()


def _gap(was, now, before: range, after: range, tolerance: Tolerance) -> Iterator[Edit]:
    """Yield the edits of the steps between two pairs."""
    if _same_number(was, now, before, after):
        return _in_order(was, now, before, after, tolerance)
    some, others = was[before.start : before.stop], now[after.start : after.stop]
    paired = _paired(some, others, _displacement, tolerance)
    if paired and len(paired) >= MOST_OF * min(len(some), len(others)):
        paired = [(before.start + i, after.start + j) for i, j in paired]
        return _shifted(was, now, paired, before, after, tolerance)
    return iter([Edit(tuple(before), tuple(after))])


def _shifted(was, now, paired, before, after, tolerance: Tolerance) -> Iterator[Edit]:
    """Yield the edits of steps most of which have the same displacement from another position."""
    for some, others, pair in _walk(paired, before, after):
        if _same_number(was, now, some, others):
            yield from _in_order(was, now, some, others, tolerance)
        else:
            yield Edit(tuple(some), tuple(others))
        yield from _pair(was, now, pair, tolerance) if pair else ()


def _same_number(was, now, before: range, after: range) -> bool:
    return len(_only(was, before, Move)) == len(_only(now, after, Move))


def _in_order(was, now, before: range, after: range, tolerance: Tolerance) -> Iterator[Edit]:
    """Yield the edits between two pairs with an equal number of moves."""
    both = list(zip(_only(was, before, Move), _only(now, after, Move)))
    notes, other_notes = _only(was, before, Note), _only(now, after, Note)
    if len(notes) == len(other_notes):
        both = sorted([*both, *zip(notes, other_notes)])
    elif notes or other_notes:
        yield Edit(notes, other_notes)
    for i, j in both:
        yield from _pair(was, now, (i, j), tolerance)


def _only(steps: Sequence[RecordedStep], indices: range, kind: type) -> tuple[int, ...]:
    return tuple(index for index in indices if isinstance(steps[index], kind))


def _pair(was, now, pair: tuple[int, int], tolerance: Tolerance) -> Iterator[Edit]:
    i, j = pair
    found = changes(was[i], now[j], tolerance)
    if found:
        yield Edit((i,), (j,), tuple(found))


def changes(was: RecordedStep, now: RecordedStep, tolerance: Tolerance) -> list[Change]:
    """Return the changes between two steps of the same kind."""
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
    by = math.dist(was.point(0.5)[:3], now.point(0.5)[:3])
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
