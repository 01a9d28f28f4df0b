# SPDX-License-Identifier: GPL-2.0-or-later
"""The first and the fourth question: does a rapid go through the part, is the tool left in it."""

import math
from collections.abc import Container, Iterator

import numpy as np

from g12.cut_report import ThreadCut
from g12.tools.material.material import ALLOWED, Touch
from g12.tools.path.part import C, X, Y, Z, disc
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down, turns_part
from g12.tools.verify.model.solid import FACE, Solids

RAPID = kind(
    "rapid", FINDING, "a rapid goes {how} {area:mm2} of material, at {at:xyz}{to:to}{hint}"
)
BY_MACHINE = kind("rapid-by-machine", NOT_JUDGED, "low rapids by G53, G28 or G30")
ROTARY = kind("rotary", NOT_JUDGED, "what follows: A or B has turned what was solid")
C_OUTSIDE = kind("c-outside", NOT_JUDGED, "what is cut where C turns at feed outside of a section")
OTHER_TOOL = kind(
    "rapid-other-tool",
    NOT_JUDGED,
    "low rapids of tools that no code of the package moves, without a diameter, or between sides",
)
BORED = "; was it bored before? (--stock 'bore DIAMETER')"
THREAD = "; a thread outside? H1 is missing"
CENTRE = 0.2  # of a cutter's radius: where an end mill may have no edge
LEAST = 1e-3  # mm
PER_TURN = 0.6  # mm: no tool plunges so fast
CHANGE = kind("change-in-part", FINDING, "the tool is changed in the part")
STOP = kind("stop-in-part", FINDING, "the spindle stops (M5) in the part")
START = kind("start-in-part", WARNING, "the spindle starts ({code}) in the part")
ROTARY_IN_PART = kind("rotary-in-part", FINDING, "A or B turns with the tool in the part")
END = kind("ends-in-part", FINDING, "the program ends with the tool in the part")
KINDS = {"tool": CHANGE, "M5": STOP, "M3": START, "M4": START}
PLUNGE = kind(
    "plunge", WARNING, "it plunges at {feed:feed} with its centre: can the tool cut there?"
)
PLUNGE_FAST = kind(
    "plunge-fast", FINDING, "it plunges at {feed:feed}, {per_turn:fine} a revolution"
)


def judge_rapids(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield every rapid through solid material, and those that cannot be judged."""
    if program.turned_at is not None:
        yield program.found(ROTARY, program.turned_at)
    for index, move in enumerate(program.moves):
        if move.kind == "rapid" and program.is_known(index):
            yield from _judge(index, program, solids)
        elif move.kind == "feed" and _turns_in_bar(index, program, solids):
            yield program.found(C_OUTSIDE, index)


def _turns_in_bar(index: int, program: TracedProgram, solids: Solids) -> bool:
    """Return whether C turns at feed, outside of a section, with the tool in the bar."""
    move = program.moves[index]
    if not program.turning or move.start[C] == move.end[C] or move.remap:
        return False
    slide = min(move.start[X], move.end[X]) - program.zero[X] - program.cutter(index)
    return (not solids.bar or slide < solids.bar) and min(move.start[Z], move.end[Z]) < program.z0


def _judge(index: int, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Judge a rapid on each side that its tool may be on: it is a finding if it is one on all."""
    move, sides = program.moves[index], program.sides[index]
    radius, below = program.cutter(index), {}
    for side in sides or {FACE}:
        points = _known_tip(index, program, side)
        if points[:, 2].min(initial=np.inf) < solids.top(side) - LEAST:
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


# ------------------------------------------------------------ left in the part


def judge_in_part(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    last = len(program.moves) - 1
    for event in program.trace.events:
        code = event.text.split()[0]
        if code in KINDS and 0 < event.at <= last + (code != "M5"):
            yield from _event(code, event, program, solids)
    if last >= 0:
        tips = in_part(last, program, solids, plain=True)
        yield from (program.found(END, last, tip) for tip in tips)
    turned = program.turned_at
    if turned and turns_part(program.moves[turned]):
        tips = in_part(turned - 1, program, solids)
        yield from (program.found(ROTARY_IN_PART, turned, tip) for tip in tips)
    yield from plunges(program, solids)


def in_part(
    index: int, program: TracedProgram, solids: Solids, *, plain: bool = False
) -> Iterator[np.ndarray]:
    """Yield the tip at the end of a move where it is in the part.

    ``plain``: also that of a lathe's tool that no code of the package moves, beyond the face.
    """
    if not program.known_after[index] or not program.is_known(index):
        return
    for side in program.sides[index] or ({FACE} if plain and program.turning else ()):
        tip = program.tip(index, side)[-1]
        if solids.surrounds(tip, index, side):
            yield tip


def _event(code: str, event: Event, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield a tool change, a start or a stop of the spindle with the tip in the part."""
    lifted = code == "tool" and program.ini.number("EMCIO", "TOOL_CHANGE_QUILL_UP", 0)
    if lifted or (code == "M5" and _is_followed(event, program)):
        return
    for tip in in_part(event.at - 1, program, solids, plain=code == "tool"):
        yield Finding(KINDS[code], event.line, {"code": code}, tip)


def _is_followed(event: Event, program: TracedProgram) -> bool:
    """Return whether M6 stops the spindle, or a boring cycle starts it again in the same block."""
    others = (e for e in program.trace.events if e.line == event.line or e.at == event.at)
    return any(e.text.startswith(("tool ", "M3", "M4")) for e in others)


def plunges(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield feed moves straight into the material.

    Of a drill, and without a given stock, only those that are too fast for any tool; no tap.
    """
    made = [cut for cut in program.cuts if cut.at < cut.end]
    tools = {program.moves[cut.at].tool for cut in made}
    if not program.turning:  # whose other tools turn the part
        tools |= {move.tool for move in program.moves}
    cutters = {program.moves[cut.at].tool for cut in made if not cut.places and solids.stock}
    for index, move in enumerate(program.moves):
        sides, own = program.sides[index] or set(), program.cut_at(index)
        taps = own.is_tap if own else move.block in program.tapping
        if move.kind != "feed" or taps or len(sides) != 1 or move.tool not in tools:
            continue
        (side,) = sides
        speed = program.speed(index)
        per_minute = move.feed * (speed if move.feed_mode == "G95" else 1)
        values = {"feed": per_minute, "per_turn": per_minute / speed if speed else 0.0}
        fast = values["per_turn"] > PER_TURN
        if (fast or move.tool in cutters) and _plunges(index, side, solids):
            place = program.tip(index, side)[-1]
            yield program.found(PLUNGE_FAST if fast else PLUNGE, index, place, **values)


def _plunges(index: int, side: float, solids: Solids) -> bool:
    """Return whether a tool goes straight down into what stands below its centre."""
    radius, tip = CENTRE * solids.program.cutter(index), solids.program.tip(index, side)
    down = straight_down(tip) and tip[-1, 2] < min(tip[0, 2], solids.top(side) - LEAST)
    if radius <= 0 or not down or not solids.program.is_known(index):
        return False
    standing = solids.standing(disc(tip[-1, :2], radius), tip[-1, 2], side, before=index)
    return standing.area > 0.5 * math.pi * radius**2
