# SPDX-License-Identifier: GPL-2.0-or-later
"""Faults of what LinuxCNC emits: the moves and events of a trace, changed as a table says.

A change picks moves of the sound trace: those made by a ``line`` of the program (or by each of
several), those ``where`` an expression holds, and of these in each line the ``moves`` by number,
"1 4-6 9- -1". What it does with them:

- ``drop``: they are missing; ``again``: they come once more, all together
- ``before``, ``after``: moves beside each, straight ones at its feed unless their fields say more
- fields: ``x y z c`` of the end and ``cx cy cz`` of the centre (machine coordinates, mm), ``p``
  of both as x + iy, ``w`` of the end on a lathe's face, as X and C turned by C's angle, ``feed``,
  ``feed_mode``, ``kind``, ``turns``, ``exact``
- ``event``: what happens in front of each

The value of a field is an expression of the sound move's fields, of its start ``x0 y0 z0 c0``, its
``line``, the line in a sub's file, ``source``, and its number ``n`` in its line. Without moves,
``event`` picks events by a pattern: ``drop``, ``again``, ``becomes`` another text, or come ``late``
by so many moves.

Each move begins where the one before it ends, and each arc's centre is at the level of its start.
"""

from __future__ import annotations

import cmath
import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from g12.tools.preview.moves import THIRD_AXIS, Event, Move, Trace

Change = Mapping[str, object]
AXES = {"x": 0, "y": 1, "z": 2, "c": 5}
PICKING = ("line", "where", "moves")
OF_MOVES = (*PICKING, "drop", "again", "before", "after", "event")
SPAN = re.compile(r"(-?\d+)(-?)(\d*)")


def fields_of(move: Move, number: int) -> dict[str, object]:
    """Return what an expression may use of a move, the ``number``-th of its line."""
    axes = {name: move.end[axis] for name, axis in AXES.items()}
    start = {f"{name}0": move.start[axis] for name, axis in AXES.items()}
    centre = dict(zip(("cx", "cy", "cz"), move.centre or ()))
    place = {"line": move.block, "source": move.line, "n": number}
    own = {name: getattr(move, name) for name in ("kind", "feed", "turns", "exact", "feed_mode")}
    points = {"p": complex(*move.end[:2]), "w": on_face(move)}
    return {"hypot": math.hypot, **axes, **start, **centre, **place, **own, **points}


def on_face(move: Move) -> complex:
    """Return where a move of X and C ends on the face."""
    return cmath.rect(move.end[0], math.radians(move.end[AXES["c"]]))


def worked_out(value: object, names: Mapping[str, object]) -> object:
    """Return the value of a field: an expression's, or itself."""
    return eval(value, dict(names)) if isinstance(value, str) else value


def with_fields(move: Move, fields: Change, names: Mapping[str, object]) -> Move:
    """Return a move with other fields."""
    values = {
        name: value if name in ("kind", "feed_mode") else worked_out(value, names)
        for name, value in fields.items()
    }
    end, centre = list(move.end), list(move.centre or ())
    if "p" in values:
        end[:2] = values["p"].real, values["p"].imag
        if centre:
            moved = worked_out(fields["p"], {**names, "p": complex(*centre[:2])})
            centre[:2] = moved.real, moved.imag
    if "w" in values and names["w"]:
        turn = values["w"] / names["w"]
        end[0] *= abs(turn)
        end[AXES["c"]] += math.degrees(cmath.phase(turn))
    for name, axis in AXES.items():
        end[axis] = values.get(name, end[axis])
    for axis, name in enumerate(("cx", "cy", "cz")):
        if name in values:
            centre[axis : axis + 1] = [values[name]]
    own = {name: values[name] for name in values if name in Move._fields}
    move = move._replace(end=tuple(end), centre=tuple(centre) or None, **own)
    return of_kind(move)


def of_kind(move: Move) -> Move:
    """Return a move without what its kind has not."""
    if move.kind == "rapid":
        move = move._replace(feed=0.0, feed_mode="")
    return move if move.kind == "arc" else move._replace(centre=None, turns=0)


def picked(change: Change, moves: Sequence[Move]) -> dict[int, dict[str, object]]:
    """Return the moves that a change picks: their indices, and what expressions may use."""
    lines, found = change.get("line"), defaultdict(dict)
    lines = [lines] if isinstance(lines, int) else lines
    where = compile(change.get("where", "1"), "where", "eval")
    for index, move in enumerate(moves):
        own = found[move.block]
        if lines is None or move.block in lines:
            names = fields_of(move, len(own) + 1)
            if eval(where, names):
                own[index] = names
    return {
        index: own[index]
        for own in found.values()
        for index in numbered(change.get("moves", "1-"), list(own))
    }


def numbered(numbers: str, indices: Sequence[int]) -> Iterator[int]:
    """Yield the indices whose numbers, from 1 on or -1 for the last, stand in a text."""
    for text in numbers.split():
        first, to, last = SPAN.fullmatch(text).groups()
        begin = int(first) - 1 if int(first) > 0 else len(indices) + int(first)
        yield from indices[begin : (int(last) if last else None) if to else begin + 1]


class EmittedFault:
    """Changes of all traces of one program, picked in the first, which is the sound one."""

    def __init__(self, changes: Iterable[Change]) -> None:
        self._changes = list(changes)
        self._ends: list = []
        self._picked: list = []

    def made(self, trace: Trace) -> Trace:
        """Return a trace with the fault; one with other moves than the first stays as it is."""
        ends = [move.end for move in trace.moves]
        if not self._ends:
            self._ends = ends
            self._picked = [picked(change, trace.moves) for change in self._changes]
        return self._changed(trace) if ends == self._ends else trace

    def _changed(self, trace: Trace) -> Trace:
        groups, events = [[move] for move in trace.moves], list(trace.events)
        for change, found in zip(self._changes, self._picked):
            if "event" in change and not any(name in change for name in PICKING):
                events = [event for each in events for event in changed_event(each, change)]
                continue
            if "event" in change:
                events = with_events(events, change["event"], found, trace.moves)
            change_groups(groups, change, found, trace.moves)
        starts = [0]
        for group in groups:
            starts.append(starts[-1] + len(group))
        events = [event._replace(at=starts[min(event.at, len(groups))]) for event in events]
        cuts = [cut._replace(at=starts[cut.at], end=starts[cut.end]) for cut in trace.cuts]
        return replace(trace, moves=list(chained(groups, trace.moves)), events=events, cuts=cuts)


def change_groups(
    groups: list[list[Move]], change: Change, found: Mapping[int, Mapping], moves: Sequence[Move]
) -> None:
    """Change the moves that stand for those found, each by its index."""
    fields = {name: value for name, value in change.items() if name not in OF_MOVES}
    for index, names in found.items():
        if change.get("drop"):
            groups[index] = []
            continue
        move = moves[index]
        straight = move._replace(kind="feed", centre=None, turns=0)
        groups[index] = [
            *(
                with_fields(straight._replace(end=move.start), each, names)
                for each in change.get("before", ())
            ),
            *(with_fields(each, fields, names) for each in groups[index]),
            *(with_fields(straight, each, names) for each in change.get("after", ())),
        ]
    if change.get("again"):
        groups[max(found)] += [move for index in sorted(found) for move in groups[index]]


def chained(groups: Sequence[Sequence[Move]], moves: Sequence[Move]) -> Iterator[Move]:
    """Yield moves, each from the end of the one before where the sound ones hang together."""
    at = None
    for index, group in enumerate(groups):
        apart = not index or moves[index].start != moves[index - 1].end
        for move in group:
            move = move if at is None or apart else begun_at(move, at)
            at, apart = move.end, False
            yield move


def begun_at(move: Move, start: tuple) -> Move:
    """Return a move from another start."""
    if move.centre is None:
        return move._replace(start=start)
    centre, third = list(move.centre), THIRD_AXIS[move.plane]
    centre[third] = start[third]
    return move._replace(start=start, centre=tuple(centre))


def with_events(
    events: Sequence[Event], text: str, found: Iterable[int], moves: Sequence[Move]
) -> list[Event]:
    """Return events and another in front of each of the moves found."""
    added = [Event(index, moves[index].block, text) for index in found]
    return sorted([*events, *added], key=lambda event: event.at)


def changed_event(event: Event, change: Change) -> list[Event]:
    """Return what a change of events makes of one."""
    if not re.fullmatch(change["event"], event.text):
        return [event]
    if change.get("drop"):
        return []
    event = event._replace(
        text=change.get("becomes", event.text), at=event.at + change.get("late", 0)
    )
    return [event, event] if change.get("again") else [event]
