# SPDX-License-Identifier: GPL-2.0-or-later
"""The differences between two recordings of a program as text: lines, moves, amounts.

Each step is a line of text with its numbers rounded to the tolerance, and patiencediff compares the
lines; so an inserted block is one difference and the moves after it are none. The steps of a
stretch that differs are compared one by one if their number is the same. Consecutive moves with the
same kind of change are one difference. Equal differences at several lines are one, too.
"""

import math
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from difflib import SequenceMatcher
from itertools import groupby
from typing import NamedTuple

import numpy as np
from patiencediff import PatienceSequenceMatcher

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.farthest_apart import gap_between
from g12.tools.path.part import Part, arc_points
from g12.tools.preview.moves import IS_LENGTH, Move
from g12.tools.regress.recording_text import (
    Note,
    RecordedStep,
    Recording,
    number_text,
    turns_only,
)
from g12.tools.units import UNITS, counted_as

SHOWN_DECIMALS = 6  # shown, if the two numbers differ in them
LONG_RUN = 10  # edits; fewer are reported together even if they differ
SIZE_FORMAT = ".4g"
MOVED = (*AXIS_LETTERS, "radius")
MAX_COMPARED = 250_000  # product of the lengths of a stretch that difflib compares
EXACT = 1e-9  # the tolerance, if it is 0


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
    """Changed steps, by their indices.

    ``changes`` are those of a pair; without them steps were added, are missing, or are replaced.
    """

    was: tuple[int, ...]
    now: tuple[int, ...]
    changes: tuple[Change, ...] = ()


@dataclass(frozen=True)
class Difference:
    """A difference: ``text`` describes it; ``was`` and ``now`` are its steps.

    ``kind`` is moved, changed, added, missing, replaced, refused, accepted, end or failed. ``by``
    is the largest change in machine units or degrees, along ``axis`` if it is one axis's. ``moves``
    counts the moves, ``block`` is the text of the first line.
    """

    kind: str
    text: str
    lines: list[int] = field(default_factory=list)
    recorded_lines: list[int] = field(default_factory=list)
    moves: int = 0
    axis: str = ""
    by: float = 0.0
    block: str = ""
    was: tuple[int, ...] = ()
    now: tuple[int, ...] = ()


def differences(
    was: Recording, now: Recording, tolerance: Tolerance, part: Part
) -> list[Difference]:
    """Return the differences of a program, in its order; ``part`` is the machine's."""
    edits = list(edits_of(was.steps, now.steps, tolerance))
    lost = _lost(edits, was, now)
    phrases = Phrases(was, now, part)
    found = [phrases.of_run(run) for run in _runs(edits[: len(edits) - len(lost)])]
    found = [*_merged(found), *_endings(was, now, lost)]
    return [_located(difference, was, now) for difference in found]


def _located(difference: Difference, was: Recording, now: Recording) -> Difference:
    """Return a difference with the lines of its steps."""
    lines = [*filter(None, difference.lines)] or _program_lines(now, difference.now)
    recorded = _program_lines(was, difference.was)
    block = now.blocks.get(lines[0], "") if lines else was.blocks.get((recorded or [0])[0], "")
    return replace(difference, lines=lines, recorded_lines=recorded, block=block)


def _program_lines(recording: Recording, steps: Iterable[int]) -> list[int]:
    return sorted({recording.steps[index].block for index in steps})


# ---------------------------------------------------------------- edits


def edits_of(
    was: Sequence[RecordedStep], now: Sequence[RecordedStep], tolerance: Tolerance
) -> Iterator[Edit]:
    """Yield the edits between two recordings' steps, in order."""
    old, new = ([_rounded(step, tolerance) for step in steps] for steps in (was, now))
    for before, after in _stretches(old, new):
        if not (before and after):
            yield Edit(tuple(before), tuple(after))
            continue
        for kind in (Note, Move):
            some = tuple(i for i in before if isinstance(was[i], kind))
            others = tuple(j for j in after if isinstance(now[j], kind))
            if len(some) == len(others):
                pairs = ((i, j, changes(was[i], now[j], tolerance)) for i, j in zip(some, others))
                yield from (Edit((i,), (j,), tuple(found)) for i, j, found in pairs if found)
            else:
                yield Edit(some, others)


def _rounded(step: RecordedStep, tolerance: Tolerance) -> Hashable:
    """Return a step as a line of text, its numbers in units of the tolerance."""
    if isinstance(step, Note):
        return step.text
    numbers = zip((*step.end, *(step.centre or ())), (*tolerance.ends, *[tolerance.length] * 3))
    places = (f"{round(number / (size or EXACT))}" for number, size in numbers)
    return f"{step.kind} {step.turns} {' '.join(places)}"


def _stretches(old: Sequence[Hashable], new: Sequence[Hashable]) -> Iterator[tuple[range, range]]:
    """Yield stretches of the same lines and of others.

    patiencediff matches lines that occur once. What it leaves is matched by difflib where that is
    quick.
    """
    for tag, i, i_end, j, j_end in PatienceSequenceMatcher(None, old, new).get_opcodes():
        if tag == "replace" and (i_end - i) * (j_end - j) <= MAX_COMPARED:
            matcher = SequenceMatcher(None, old[i:i_end], new[j:j_end], autojunk=False)
            for _, a, a_end, b, b_end in matcher.get_opcodes():
                yield range(i + a, i + a_end), range(j + b, j + b_end)
        else:
            yield range(i, i_end), range(j, j_end)


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


def _lost(edits: list[Edit], was: Recording, now: Recording) -> list[Edit]:
    """Return the steps that are missing because the program is now refused before them."""
    if not now.error or not edits:
        return []
    last = edits[-1]
    at_end = last.was and not last.now and last.was[-1] == len(was.steps) - 1
    return [last] if at_end else []


def _runs(edits: Sequence[Edit]) -> Iterator[list[Edit]]:
    """Yield edits of consecutive pairs with the same kind of change; others alone.

    Of a long run those with the most frequent amounts are yielded together, if they are most.
    """
    for (kinds, *_), group in groupby(enumerate(edits), _place_and_kinds):
        run = [edit for _, edit in group]
        if not kinds:
            yield from ([edit] for edit in run)
            continue
        common, count = Counter(map(_amounts, run)).most_common(1)[0]
        if len(run) < LONG_RUN or not len(run) < 2 * count < 2 * len(run):
            yield run
            continue
        yield [edit for edit in run if _amounts(edit) == common]
        yield [edit for edit in run if _amounts(edit) != common]


def _place_and_kinds(numbered: tuple[int, Edit]) -> tuple:
    """Return what edits of one run have in common."""
    number, edit = numbered
    if not edit.changes:
        return (frozenset(),)
    kinds = {"moved" if change.what in MOVED else change.what for change in edit.changes}
    return (frozenset(kinds), edit.was[0] - number, edit.now[0] - number)


def _amounts(edit: Edit) -> tuple:
    return tuple((change.what, f"{change.by:{SIZE_FORMAT}}") for change in edit.changes)


# ---------------------------------------------------------------- sentences


class Phrases:
    """Describes edits of two recordings, lengths in machine units."""

    def __init__(self, was: Recording, now: Recording, part: Part) -> None:
        self._was, self._now, self._part = was.steps, now.steps, part
        self._unit, self._name = now.unit, UNITS[now.facts["units"]].name

    def of_run(self, run: list[Edit]) -> Difference:
        was = tuple(index for edit in run for index in edit.was)
        now = tuple(index for edit in run for index in edit.now)
        steps = [self._now[index] for index in now] or [self._was[index] for index in was]
        moves = sum(isinstance(step, Move) for step in steps)
        found = self._of_pairs(run) if run[0].changes else self._of_others(was, now)
        return replace(found, was=was, now=now, moves=moves)

    def _of_pairs(self, run: list[Edit]) -> Difference:
        changes = [change for edit in run for change in edit.changes]
        kinds = dict.fromkeys(change.what for change in changes)
        groups = [[change for change in changes if change.what == what] for what in kinds]
        text = ", ".join(map(self._of_changes, groups))
        moved = [change for change in changes if change.what in MOVED]
        if not moved:
            return Difference("changed", text)
        worst = max(moved, key=lambda change: abs(change.by))
        axis = worst.what if worst.what in AXIS_LETTERS else ""
        return Difference(
            "moved", text, axis=axis, by=round(worst.by / self._scale(worst.what), 10)
        )

    def _of_changes(self, group: list[Change]) -> str:
        what = group[0].what
        if isinstance(group[0].was, str):
            return ", ".join(dict.fromkeys(f"{c.was} → {c.now}" for c in group))
        scale = self._scale(what)
        values = {_distinguished(float(c.was) / scale, float(c.now) / scale) for c in group}
        was, now = next(iter(values))
        most = max((change.by for change in group), key=abs)
        if "feed" in what:
            return f"F{was} → F{now}" if len(values) == 1 else f"feed by up to {most:+.3%}"
        unit = "degrees" if what in "ABC" else self._name
        size = f"{most / scale:+{SIZE_FORMAT}} {unit}"
        if what == "radius":
            off = f"middle of the arc {size.lstrip('+')} off"
            return f"radius {was} → {now} ({off})" if len(values) == 1 else f"{off} at most"
        if len(values) == 1:
            return f"{what}{was} → {what}{now} ({size})"
        same = len({f"{change.by:{SIZE_FORMAT}}" for change in group}) == 1
        return f"{what} by {size}" if same else f"{what} by up to {size}"

    def _of_others(self, was: tuple[int, ...], now: tuple[int, ...]) -> Difference:
        """Return the difference of steps that were added, are missing, or replace others."""
        before = [step for step in map(self._was.__getitem__, was) if isinstance(step, Move)]
        after = [step for step in map(self._now.__getitem__, now) if isinstance(step, Move)]
        notes = _of_notes(self._was, was, "missing"), _of_notes(self._now, now, "new")
        kind = "replaced" if was and now else "added" if now else "missing"
        return Difference(kind, "; ".join([*self._of_moves(before, after), *filter(None, notes)]))

    def _of_moves(self, before: list[Move], after: list[Move]) -> list[str]:
        if before and after:
            gap = gap_between(self._part, before, after)
            far = f", up to {gap.size / self._unit:{SIZE_FORMAT}} {self._name} apart" if gap else ""
            return [f"{counted_as(len(before), 'move')} became {len(after)}{far}"]
        if not before and not after:
            return []
        kind = "added" if after else "missing"
        count = counted_as(len(before or after), "move")
        return [f"{count} {kind}, {self._extent(before or after)}"]

    def _extent(self, moves: list[Move]) -> str:
        ends = np.array([position for move in moves for position in (move.start, move.end)])
        low, high = ends.min(axis=0), ends.max(axis=0)
        scales = [self._scale(axis) for axis in AXIS_LETTERS]
        texts = [
            [number_text(round(v, SHOWN_DECIMALS)) for v in bound / scales] for bound in (low, high)
        ]
        words = [f"{axis}{a} to {b}" for axis, a, b in zip(AXIS_LETTERS, *texts) if a != b]
        return " ".join(words) or "standing still"

    def _scale(self, what: str) -> float:
        return 1.0 if what in "ABC" or what == "rotary feed" else self._unit


def _of_notes(steps: Sequence[RecordedStep], indices: tuple[int, ...], word: str) -> str:
    found = (steps[index] for index in indices)
    texts = [step.text for step in found if not isinstance(step, Move)]
    return f"{word}: {', '.join(texts)}" if texts else ""


def _distinguished(was: float, now: float) -> tuple[str, str]:
    """Return two numbers as text, with as few digits as distinguish them."""
    old, new = (number_text(round(value, SHOWN_DECIMALS)) for value in (was, now))
    return (old, new) if old != new else (number_text(was), number_text(now))


def _merged(found: Sequence[Difference]) -> list[Difference]:
    groups: dict[tuple, list[Difference]] = {}
    for difference in found:
        groups.setdefault((difference.kind, difference.text), []).append(difference)
    return [
        replace(
            max(group, key=lambda difference: abs(difference.by)),
            text=f"{_times(group)}{group[0].text}",
            was=tuple(index for difference in group for index in difference.was),
            now=tuple(index for difference in group for index in difference.now),
            moves=sum(difference.moves for difference in group),
        )
        for group in groups.values()
    ]


def _times(group: Sequence[Difference]) -> str:
    """Return how often moves of other number are the same difference, as at each of four levels."""
    of_number = group[0].kind in ("replaced", "added", "missing")
    return f"{len(group)} times: " if of_number and len(group) > 1 else ""


def _endings(was: Recording, now: Recording, lost: list[Edit]) -> list[Difference]:
    if not was.error and not now.error:
        return _ends(was.end, now.end)
    if was.error and now.error and was.error.rule == now.error.rule:
        same = was.error.line == now.error.line or was.facts["program"] != now.facts["program"]
        text = f"refused at this line, was at line {was.error.line}: {now.error.rule}"
        return [] if same else [Difference("refused", text, [now.error.line])]
    if not now.error:
        text = f"no longer refused, was at line {was.error.line}: {was.error.rule}"
        return [Difference("accepted", text, [was.error.line])]
    steps = tuple(index for edit in lost for index in edit.was)
    count = sum(isinstance(was.steps[index], Move) for index in steps)
    before = f", was refused at line {was.error.line}: {was.error.rule}" if was.error else ""
    verb = "is" if count == 1 else "are"
    missing = f"; {counted_as(count, 'move')} {verb} missing" if count else ""
    text = f"refused: {now.error.rule}{missing}{before}"
    return [Difference("refused", text, [now.error.line], was=steps, moves=count)]


def _ends(was: str, now: str) -> list[Difference]:
    before, after = was.split(), now.split()
    old = " ".join(word for word in before if word not in after)
    new = " ".join(word for word in after if word not in before)
    if not old and not new:
        return []
    return [Difference("end", f"modal state at the end: {old or 'nothing'} → {new or 'nothing'}")]
