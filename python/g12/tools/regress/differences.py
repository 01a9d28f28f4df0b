# SPDX-License-Identifier: GPL-2.0-or-later
"""The differences between two recordings of a program as text: lines, moves, amounts.

Each step is a line of text with its numbers rounded to the tolerance, and patiencediff compares the
lines; so an inserted block is one difference and the moves after it are none. The steps of a
stretch that differs are compared one by one if their number is the same. Consecutive moves with the
same kind of change are one difference. Equal differences at several lines are one, too.
"""

import math
from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from difflib import SequenceMatcher
from itertools import groupby
from typing import NamedTuple

import numpy as np
from patiencediff import PatienceSequenceMatcher

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.part import Part, arc_points, gap_between
from g12.tools.preview.moves import IS_LENGTH, Move
from g12.tools.regress.recording_text import (
    Note,
    RecordedStep,
    Recording,
    feed_unit,
    in_machine_units,
    number_text,
)
from g12.tools.units import counted_as

SIZE_FORMAT = ".4g"
MOVED = {*AXIS_LETTERS, "arc"}
MAX_COMPARED = 250_000  # product of the lengths of a stretch that difflib compares
EXACT = 1e-9  # the tolerance, if it is 0


class Tolerance(NamedTuple):
    """What counts as equal: ends in machine units and degrees, feeds in per cent."""

    ends: float
    feeds: float


TOLERANCE = Tolerance(1e-6, 0.01)  # by default


class Change(NamedTuple):
    """A changed property of a step, its values as texts, and by how much if they are numbers.

    ``by`` is in machine units or degrees, for the feed a share, for "arc" how far its middle moved.
    """

    what: str
    was: str
    now: str
    by: float = 0.0


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
    edits = [*edits_of(was, now, tolerance)]
    is_cut_off = now.error and not was.error and edits and not edits[-1].now
    lost = edits.pop().was if is_cut_off else ()
    found = [_described(run, was, now, part) for run in _runs(edits)]
    return [_located(one, was, now) for one in (*_merged(found), *_endings(was, now, lost))]


def _located(difference: Difference, was: Recording, now: Recording) -> Difference:
    """Return a difference with the lines of its steps."""
    lines = difference.lines or sorted({now.steps[index].block for index in difference.now})
    recorded = sorted({was.steps[index].block for index in difference.was})
    block = now.blocks.get(lines[0], "") if lines else was.blocks.get((recorded or [0])[0], "")
    return replace(difference, lines=lines, recorded_lines=recorded, block=block)


def edits_of(was: Recording, now: Recording, tolerance: Tolerance) -> Iterator[Edit]:
    """Yield the edits between two recordings' steps, in order."""
    unit, size = now.unit.mm, tolerance.ends or EXACT
    old, new = ([_rounded(step, unit, size) for step in each.steps] for each in (was, now))
    for before, after in _stretches(old, new):
        if not (before and after):
            yield Edit(tuple(before), tuple(after))
            continue
        for kind in (Note, Move):
            some = tuple(i for i in before if isinstance(was.steps[i], kind))
            others = tuple(j for j in after if isinstance(now.steps[j], kind))
            if len(some) != len(others):
                yield Edit(some, others)
                continue
            for i, j in zip(some, others):
                changed = _changes(was.steps[i], now.steps[j], unit, tolerance)
                if changed:
                    yield Edit((i,), (j,), tuple(changed))


def _rounded(step: RecordedStep, unit: float, size: float) -> Hashable:
    """Return a step as a line of text without its feed, lengths and angles in ``size``."""
    if isinstance(step, Note):
        return step.text
    numbers = [*in_machine_units(step.end, unit), *in_machine_units(step.centre or (), unit)]
    return f"{step.kind} {step.turns} {[round(number / size) for number in numbers]}"


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


def _changes(
    was: RecordedStep, now: RecordedStep, unit: float, tolerance: Tolerance
) -> list[Change]:
    """Return what differs between two steps of the same sort."""
    if isinstance(was, Note) and isinstance(now, Note):
        return [Change("note", was.text, now.text)] if was.text != now.text else []
    assert isinstance(was, Move) and isinstance(now, Move)
    ends = zip(AXIS_LETTERS, in_machine_units(was.end, unit), in_machine_units(now.end, unit))
    found = [
        Change(axis, number_text(a), number_text(b), b - a)
        for axis, a, b in ends
        if abs(b - a) > tolerance.ends
    ]
    texts = zip(("kind", "plane", "turns", "feed mode"), _texts(was), _texts(now))
    found += [Change(what, a, b) for what, a, b in texts if a and b and a != b]
    ends_only = now.kind != "arc" or math.dist(was.centre, now.centre) <= tolerance.ends * unit
    by = 0.0 if found or ends_only else _middle_moved(was, now) / unit
    found += [Change("arc", "", "", by)] if by > tolerance.ends else []
    old, new = (move.feed / feed_unit(move, unit) for move in (was, now))
    if old and new and 100 * abs(new - old) > tolerance.feeds * max(old, new):
        found.append(
            Change("feed", number_text(old), number_text(new), (new - old) / max(old, new))
        )
    return found


def _texts(move: Move) -> tuple[str, ...]:
    """Return what of a move is no number, "" where it has none."""
    arc = (f"G{move.plane}", f"turns {move.turns}") if move.kind == "arc" else ("", "")
    return move.kind, *arc, move.feed_mode


def _middle_moved(was: Move, now: Move) -> float:
    """Return how far an arc's middle moved, mm: the centre of a flat arc is too sensitive."""
    return math.dist(*(arc_points(move, np.array([0.5]))[0, :3] for move in (was, now)))


def _runs(edits: Sequence[Edit]) -> Iterator[list[Edit]]:
    """Yield edits of consecutive pairs with the same kind of change; others alone.

    If most of a run have the same amounts, they are yielded together and the others together.
    """
    for kinds, group in groupby(enumerate(edits), _place_and_kinds):
        run = [edit for _, edit in group]
        common, count = Counter(map(_amounts, run)).most_common(1)[0]
        if not kinds:
            yield from ([edit] for edit in run)
        elif len(run) < 2 * count < 2 * len(run):
            yield [edit for edit in run if _amounts(edit) == common]
            yield [edit for edit in run if _amounts(edit) != common]
        else:
            yield run


def _place_and_kinds(numbered: tuple[int, Edit]) -> tuple:
    """Return what edits of one run have in common; nothing of an edit without changes."""
    number, edit = numbered
    kinds = frozenset("moved" if what in MOVED else what for what, *_ in edit.changes)
    return (kinds, edit.was[0] - number, edit.now[0] - number) if kinds else ()


def _amounts(edit: Edit) -> tuple:
    return tuple((change.what, f"{change.by:{SIZE_FORMAT}}") for change in edit.changes)


def _described(run: list[Edit], was: Recording, now: Recording, part: Part) -> Difference:
    """Return the difference of a run of edits."""
    old = tuple(index for edit in run for index in edit.was)
    new = tuple(index for edit in run for index in edit.now)
    before, after = [was.steps[index] for index in old], [now.steps[index] for index in new]
    changes = [change for edit in run for change in edit.changes]
    found = _of_changes(changes, now) if changes else _of_others(before, after, now, part)
    moves = sum(isinstance(step, Move) for step in after or before)
    return replace(found, was=old, now=new, moves=moves)


def _of_changes(changes: list[Change], now: Recording) -> Difference:
    kinds = dict.fromkeys(change.what for change in changes)
    groups = [[change for change in changes if change.what == what] for what in kinds]
    text = ", ".join(_change_text(group, now.unit.name) for group in groups)
    moved = [change for change in changes if change.what in MOVED]
    if not moved:
        return Difference("changed", text)
    worst = max(moved, key=lambda change: abs(change.by))
    axis = worst.what if worst.what in AXIS_LETTERS else ""
    return Difference("moved", text, axis=axis, by=round(worst.by, 10))


def _change_text(group: list[Change], unit: str) -> str:
    """Return the sentence of changes of one property."""
    what = group[0].what
    if not group[0].by:
        return ", ".join(dict.fromkeys(f"{change.was} → {change.now}" for change in group))
    values = {(change.was, change.now) for change in group}
    was, now = next(iter(values)) if len(values) == 1 else ("", "")
    most = max((change.by for change in group), key=abs)
    if what == "feed":
        return f"F{was} → F{now}" if was else f"feed by up to {most:+.3%}"
    if what == "arc":
        return f"middle of the arc {most:{SIZE_FORMAT}} {unit} off"
    size = f"{most:+{SIZE_FORMAT}} {'degrees' if what in 'ABC' else unit}"
    if was:
        return f"{what}{was} → {what}{now} ({size})"
    same = len({f"{change.by:{SIZE_FORMAT}}" for change in group}) == 1
    return f"{what} by {size}" if same else f"{what} by up to {size}"


def _of_others(
    before: list[RecordedStep], after: list[RecordedStep], now: Recording, part: Part
) -> Difference:
    """Return the difference of steps that were added, are missing, or replace others."""
    kind = "replaced" if before and after else "added" if after else "missing"
    moves = [[step for step in steps if isinstance(step, Move)] for steps in (before, after)]
    texts = [_moves_text(moves[0], moves[1], now, part)] if any(moves) else []
    for word, steps in (("missing", before), ("new", after)):
        notes = [step.text for step in steps if isinstance(step, Note)]
        texts += [f"{word}: {', '.join(notes)}"] if notes else []
    return Difference(kind, "; ".join(texts))


def _moves_text(before: list[Move], after: list[Move], now: Recording, part: Part) -> str:
    if not before or not after:
        count = counted_as(len(before or after), "move")
        return f"{count} {'added' if after else 'missing'}, {_extent(before or after, now.unit.mm)}"
    gap = gap_between(part, before, after)
    far = f", up to {gap.size / now.unit.mm:{SIZE_FORMAT}} {now.unit.name} apart" if gap else ""
    return f"{counted_as(len(before), 'move')} became {len(after)}{far}"


def _extent(moves: list[Move], unit: float) -> str:
    scales = np.where(IS_LENGTH, unit, 1.0)
    ends = np.array([position for move in moves for position in (move.start, move.end)]) / scales
    bounds = (map(number_text, bound) for bound in (ends.min(axis=0), ends.max(axis=0)))
    words = [f"{axis}{a} to {b}" for axis, a, b in zip(AXIS_LETTERS, *bounds) if a != b]
    return " ".join(words) or "standing still"


def _merged(found: Sequence[Difference]) -> Iterator[Difference]:
    """Yield equal differences as one, with its number where moves of other number are equal."""
    groups: dict[tuple, list[Difference]] = {}
    for difference in found:
        groups.setdefault((difference.kind, difference.text), []).append(difference)
    for (kind, text), group in groups.items():
        of_number = len(group) > 1 and kind in ("replaced", "added", "missing")
        yield replace(
            max(group, key=lambda difference: abs(difference.by)),
            text=f"{len(group)} times: {text}" if of_number else text,
            was=tuple(index for difference in group for index in difference.was),
            now=tuple(index for difference in group for index in difference.now),
            moves=sum(difference.moves for difference in group),
        )


def _endings(was: Recording, now: Recording, lost: tuple[int, ...]) -> Iterator[Difference]:
    """Yield the difference of the programs' ends: refusals, or the modal states.

    ``lost`` are the steps that a new refusal leaves out.
    """
    old, new = was.error, now.error
    before = f", was at line {old.line}: {old.rule}" if old else ""
    if new:
        edited = was.facts["program"] != now.facts["program"]
        if not (old and old.rule == new.rule and (edited or old.line == new.line)):
            yield Difference("refused", f"refused: {new.rule}{before}", [new.line], was=lost)
    elif old:
        yield Difference("accepted", f"no longer refused{before}", [old.line])
    else:
        ends = was.end.split(), now.end.split()
        gone = " ".join(code for code in ends[0] if code not in ends[1])
        came = " ".join(code for code in ends[1] if code not in ends[0])
        if gone or came:
            text = f"modal state at the end: {gone or 'nothing'} → {came or 'nothing'}"
            yield Difference("end", text)
