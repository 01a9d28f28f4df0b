# SPDX-License-Identifier: GPL-2.0-or-later
"""The first question to the material: does a rapid go through it, anywhere."""

from collections.abc import Container, Iterator

import numpy as np

from g12.cut_report import ThreadCut
from g12.tools.material.material import ALLOWED, Touch
from g12.tools.path.part import C, X, Y, Z
from g12.tools.preview.moves import Move
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down
from g12.tools.verify.model.solid import FACE, Solids

BELOW = 1e-3  # mm
RAPID = kind(
    "rapid", FINDING, "a rapid goes {how} {area:mm2} of material, at {at:xyz}{to:to}{hint}"
)
BY_MACHINE = kind("rapid-by-machine", NOT_JUDGED, "low rapids by G53, G28 or G30")
ROTARY = kind("rotary", NOT_JUDGED, "what follows: A or B has turned what was solid")
OTHER_TOOL = kind(
    "rapid-other-tool",
    NOT_JUDGED,
    "low rapids of turning tools, without a diameter, or between face and side",
)
OUTSIDE = kind("c-outside", NOT_JUDGED, "what is cut where C turns at feed outside of a section")
ROTARY_IN_PART = kind("rotary-in-part", FINDING, "A or B turns with the tool in the part")
BORED = "; was it bored before? (--stock 'bore DIAMETER')"
THREAD = "; a thread outside? H1 is missing"


def judge_rapids(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield every rapid through solid material, and those that cannot be judged."""
    turned = program.turned_at
    if turned is not None:
        yield program.found(ROTARY, turned)
        before = program.tip(turned, FACE)[0]
        if program.known_before[turned] and solids.surrounds(before, turned, FACE):
            yield program.found(ROTARY_IN_PART, turned, before)
    for index, move in enumerate(program.moves):
        if move.kind == "rapid" and program.is_known(index):
            yield from _judge(index, program, solids)
        elif move.kind == "feed" and _turns_in_bar(index, program, solids):
            yield program.found(OUTSIDE, index)


def _turns_in_bar(index: int, program: TracedProgram, solids: Solids) -> bool:
    """Return whether C turns at feed, outside of a section, with the tool in the bar."""
    move = program.moves[index]
    if not program.turning or move.start[C] == move.end[C] or move.remap:
        return False
    slide = min(move.start[X], move.end[X]) - program.zero[X] - program.cutter(index)
    reaches = not solids.bar or slide < solids.bar
    return reaches and min(move.start[Z], move.end[Z]) < program.z0


def _judge(index: int, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Judge a rapid on each side that its tool may be on: it is a finding if it is one on all."""
    move, sides = program.moves[index], program.sides[index]
    radius, below = program.cutter(index), {}
    for side in sides or {FACE}:
        points = _known_tip(index, program, side)
        if points[:, 2].min(initial=np.inf) < solids.top(side) - BELOW:
            below[side] = points
    if move.by_machine and not program.is_placed:
        if below and not _is_upward(move, below):
            yield program.found(BY_MACHINE, index)
    elif sides is None or radius <= ALLOWED:
        if len(below) == len(sides or {FACE}):
            yield program.found(OTHER_TOOL, index)
    else:
        touches = [(side, solids.of(side).touched(at, radius, index)) for side, at in below.items()]
        touched = [(side, touch) for side, touch in touches if touch]
        if len(touched) == len(sides):
            yield _rapid(index, program, below[touched[0][0]], *touched[0])
        elif touched:
            yield program.found(OTHER_TOOL, index)


def _known_tip(index: int, program: TracedProgram, side: float) -> np.ndarray:
    """Return the points (n, 3) of a rapid as far as the program has said where they are.

    One to a machine position is known where it begins.
    """
    points = program.tip(index, side)
    if program.moves[index].by_machine and not program.is_placed:
        return points[:1] if program.known_before[index] else points[:0]
    if not program.known_after[index]:
        return points[:0]
    return points if program.known_before[index] else points[-1:]


def _is_upward(move: Move, sides: Container[float]) -> bool:
    along = move.start[X] == move.end[X] and move.start[Y] == move.end[Y]
    return along and move.end[Z] >= move.start[Z] and FACE in sides


def _rapid(
    index: int, program: TracedProgram, points: np.ndarray, side: float, touch: Touch
) -> Finding:
    path = touch.points if len(touch.points) else points[-1:]
    down = straight_down(points)
    after = program.cut_at(index) or next((cut for cut in program.cuts if cut.at > index), None)
    is_circle = down and after and after.is_circle and not program.turning
    is_inside = is_circle and isinstance(after.plan, ThreadCut) and not after.plan.outside
    return program.found(
        *(RAPID, index, path[0]),
        how="straight down into" if down else "through",
        area=touch.area,
        at=program.words(index, path[0], side),
        to=[] if down else program.words(index, path[-1], side),
        hint=BORED * bool(is_circle) + THREAD * bool(is_inside),
        path=path,
        surface=side,
    )
