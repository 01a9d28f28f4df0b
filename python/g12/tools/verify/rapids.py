# SPDX-License-Identifier: GPL-2.0-or-later
"""The first question to the material: does a rapid go through it, anywhere."""

from collections.abc import Iterator

import numpy as np

from g12.tools.material.material import ALLOWED, Touch
from g12.tools.path.part import C, X, Y, Z
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down
from g12.tools.verify.model.solid import FACE, Solids

BELOW = 1e-3  # mm
RAPID = kind(
    "rapid", FINDING, "a rapid goes {how} {area:mm2} of material, at {at:xyz}{to:to}{hint}"
)
BY_MACHINE = kind(
    "rapid-by-machine", NOT_JUDGED, "rapids by G53, G28 or G30 that begin below the part's top"
)
ROTARY = kind(
    "rotary", NOT_JUDGED, "everything from here on: A or B has turned what was solid to elsewhere"
)
NO_DIAMETER = kind(
    "rapid-no-diameter", NOT_JUDGED, "rapids below the top, of a tool without a diameter"
)
IDLE = kind(
    "rapid-idle-tool", NOT_JUDGED, "rapids below Z0 of turning tools, or of tools that cut nothing"
)
OUTSIDE = kind(
    "c-outside", NOT_JUDGED, "what the tool cuts where C turns at feed outside of a section"
)
ROTARY_IN_PART = kind("rotary-in-part", FINDING, "A or B turns with the tool in the part")
TURNED = kind(
    "rapid-turned", NOT_JUDGED, "rapids of a tool between cuts on the face and in the side"
)
BORED = "; was it bored before? (--stock 'bore DIAMETER')"


def judge_rapids(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield every rapid through solid material, and those that cannot be judged."""
    if program.turned_at is not None:
        line, file = program.where(program.turned_at)
        yield Finding(ROTARY, line, file=file)
        before = program.tip(program.turned_at, FACE)[0]
        known = program.known_before[program.turned_at]
        if known and solids.surrounds(before, program.turned_at, FACE):
            yield Finding(ROTARY_IN_PART, line, {}, before, file)
    for index, move in enumerate(program.moves):
        if move.kind == "rapid" and program.is_known(index):
            yield from _judge(index, program, solids)
        elif move.kind == "feed" and _turns_in_bar(index, program, solids):
            line, file = program.where(index)
            yield Finding(OUTSIDE, line, file=file)


def _turns_in_bar(index: int, program: TracedProgram, solids: Solids) -> bool:
    """Return whether C turns at feed, outside of a section, with the tool in the bar."""
    move = program.moves[index]
    if not program.turning or move.start[C] == move.end[C] or move.remap:
        return False
    slide = min(move.start[X], move.end[X]) - program.zero[X] - program.cutter(index)
    reaches = not solids.bar or slide < solids.bar
    return reaches and min(move.start[Z], move.end[Z]) < program.z0


def _judge(index: int, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    line, file = program.where(index)
    why = _unjudged(index, program)
    if why is BY_MACHINE:
        if program.known_before[index] and _begins_below(index, program, solids):
            yield Finding(why, line, file=file)
        return
    touches = list(_touches(index, program, solids, judged=not why))
    if not touches:
        return
    if why and all(below for below, *_ in touches):
        yield Finding(why, line, file=file)
    elif all(touch for _, touch, *_ in touches):
        yield _rapid(index, program, *touches[0][1:])
    elif any(touch for _, touch, *_ in touches):
        yield Finding(TURNED, line, file=file)


def _touches(
    index: int, program: TracedProgram, solids: Solids, *, judged: bool
) -> Iterator[tuple[bool, Touch | None, np.ndarray, float]]:
    """Yield for each side: is a rapid below its top, what it touches, its points, the side."""
    if not program.known_after[index]:
        return
    for side in program.sides[index] or {FACE}:
        points = program.tip(index, side)
        points = points if program.known_before[index] else points[-1:]
        below = bool(points[:, 2].min() < solids.top(side) - BELOW)
        touch = solids.touched(points, index, side) if below and judged else None
        yield below, touch, points, side


def _begins_below(index: int, program: TracedProgram, solids: Solids) -> bool:
    """Return whether a rapid to a machine position goes sideways from below the part's top."""
    move = program.moves[index]
    upward = move.start[X] == move.end[X] and move.start[Y] == move.end[Y]
    side = max(program.sides[index] or {FACE})
    low = program.tip(index, side)[0, 2] < solids.top(side) - BELOW
    return bool(low) and not (upward and not side and move.end[Z] >= move.start[Z])


def _rapid(
    index: int, program: TracedProgram, touch: Touch, points: np.ndarray, side: float
) -> Finding:
    line, file = program.where(index)
    path = touch.points if len(touch.points) else points[-1:]
    down = straight_down(points)
    values = {
        "how": "straight down into" if down else "through",
        "area": touch.area,
        "at": program.words(index, path[0], side),
        "to": [] if down else program.words(index, path[-1], side),
        "hint": BORED if down and _is_bored_by_words(index, program) else "",
        "path": path,
        "surface": side,
    }
    return Finding(RAPID, line, values, path[0], file)


def _is_bored_by_words(index: int, program: TracedProgram) -> bool:
    """Return whether a circle follows that goes no deeper: it may expect a bored hole."""
    after = next((cut for cut in program.cuts if cut.at > index), None)
    return bool(after and after.is_circle and not program.turning)


def _unjudged(index: int, program: TracedProgram):
    move = program.moves[index]
    if move.by_machine and not program.is_placed:
        return BY_MACHINE
    if program.sides[index] is None:
        return IDLE
    return None if program.cutter(index) > ALLOWED else NO_DIAMETER
