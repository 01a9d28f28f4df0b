# SPDX-License-Identifier: GPL-2.0-or-later
"""The first and the fourth question: does a rapid go through the part, is the tool left in it."""

import math
from collections.abc import Container, Iterator, Sequence

import numpy as np

from g12.cut_report import ThreadCut
from g12.tools.material.material import ALLOWED, Touch
from g12.tools.path.part import C, X, Y, Z, disc
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING, Finding, kind
from g12.tools.verify.model.program import (
    RUNS,
    Stretch,
    TracedProgram,
    straight_down,
    turns_part,
)
from g12.tools.verify.model.solid import FACE, NEAR, Solids

RAPID = kind(
    "rapid", FINDING, "a rapid goes {how} {area:mm2} of material, at {at:xyz}{to:to}{hint}"
)
BY_MACHINE = kind(
    "rapid-by-machine",
    NOT_JUDGED,
    "rapids from below the top by G53, G28 or G30: their way depends on the work offset (--var)",
)
ROTARY = kind("rotary", NOT_JUDGED, "this and what follows: A or B turns what was solid")
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
HELD = kind("start-in-cut", FINDING, "the spindle starts ({code}) with the cutter in the material")
ROTARY_IN_PART = kind("rotary-in-part", FINDING, "A or B turns with the tool in the part")
END = kind("ends-in-part", FINDING, "the program ends with the tool in the part")
KINDS = {"tool": CHANGE, "M5": STOP, "M3": START, "M4": START}
PLUNGE = kind(
    "plunge", WARNING, "T{tool} mills, and plunges with its centre here: can it cut there?"
)
PLUNGE_FAST = kind(
    "plunge-fast", FINDING, "it plunges at {feed:feed}, {per_turn:fine} a revolution"
)


def judge_rapids(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield every rapid through solid material, and those that cannot be judged."""
    if program.turned_at is not None:
        yield program.found(ROTARY, program.turned_at)
    for stretch in program.stretches:
        if not stretch.is_rapid:
            turning = (i for i in stretch.moves if _turns_in_bar(i, stretch.radius, solids))
            yield from (program.found(C_OUTSIDE, index) for index in turning)
        elif stretch.is_known:
            yield from _judge(stretch, program, solids)


def _turns_in_bar(index: int, radius: float, solids: Solids) -> bool:
    """Return whether C turns at feed, outside of a section, with the tool in the bar."""
    program, move = solids.program, solids.program.moves[index]
    if not program.turning or move.start[C] == move.end[C] or move.remap:
        return False
    slide = min(move.start[X], move.end[X]) - program.zero[X] - radius
    return (not solids.bar or slide < solids.bar) and min(move.start[Z], move.end[Z]) < program.z0


def _judge(stretch: Stretch, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Judge a rapid on each side that its tool may be on: it is a finding if it is one on all."""
    index, sides, radius = stretch.moves[0], stretch.sides, stretch.radius
    move, below = program.moves[index], {}
    for side in sides or {FACE}:
        points = _known_tip(index, program, side)
        if points[:, 2].min(initial=np.inf) < solids.top(side) - LEAST:
            below[side] = points
    if move.by_machine and not program.is_placed:
        if below and not _is_upward(move, below):
            yield program.found(BY_MACHINE, index)
    elif not sides or radius <= ALLOWED:
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
    points, known = program.tip(index, side), program.known_after
    before = index > 0 and known[index - 1]
    if program.moves[index].by_machine and not program.is_placed:
        return points[:before]
    return points[0 if before else -1 :] if known[index] else points[:0]


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
    for code, event, starts in _changes(program.trace.events):
        if 0 < event.at <= last + (code != "M5"):
            yield from _event(code, event, starts, program, solids)
    if last >= 0:
        tips = in_part(last, program, solids, plain=True)
        yield from (Finding(END, program.end_line, {}, tip) for tip in tips)
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
    stretch = program.stretch_at(index)
    if not program.known_after[index] or not stretch.is_known:
        return
    for side in stretch.sides or ({FACE} if plain and program.turning else ()):
        tip = program.tip(index, side)[-1]
        if solids.surrounds(tip, stretch.radius, side):
            yield tip


def _changes(events: Sequence[Event]) -> Iterator[tuple[str, Event, bool]]:
    """Yield tool changes, starts and stops of the spindle; whether it starts from a standstill.

    Not a stop by M6, nor one of a boring cycle, which starts it again in the same block.
    """
    stopped = {event.line for event in events if event.text == "M5"}
    others = [event for event in events if event.text.startswith(("tool ", *RUNS))]
    lines, places = {event.line for event in others}, {event.at for event in others}
    runs = False
    for event in events:
        code = event.text.split()[0]
        starts = code in RUNS and not runs and event.line not in stopped
        runs = code in RUNS or (runs and code != "M5")
        if code in KINDS and not (code == "M5" and (event.line in lines or event.at in places)):
            yield code, event, starts


def _event(
    code: str, event: Event, starts: bool, program: TracedProgram, solids: Solids
) -> Iterator[Finding]:
    """Yield a tool change, a stop of the spindle or a start from a standstill in the part."""
    if code == "tool" and program.ini.number("EMCIO", "TOOL_CHANGE_QUILL_UP", 0):
        return
    for tip in in_part(event.at - 1, program, solids, plain=code == "tool"):
        held = starts and _is_held(tip, event.at - 1, program, solids)
        yield Finding(HELD if held else KINDS[code], event.line, {"code": code}, tip)


def _is_held(tip: np.ndarray, index: int, program: TracedProgram, solids: Solids) -> bool:
    """Return whether material stands beside a tool at the end of a move."""
    stretch = program.stretch_at(index)
    around = disc(tip[:2], stretch.radius + NEAR)
    found = (solids.standing(around, tip[2], side, index + 1) for side in stretch.sides)
    return any(each.area > 0.0 for each in found)


def plunges(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield feed moves straight into the material.

    Of a drill, and without a given stock, only those that are too fast for any tool; no tap.
    """
    made = [cut for cut in program.cuts if cut.at < cut.end]
    tools = {program.moves[cut.at].tool for cut in made}
    if not program.turning:  # whose other tools turn the part
        tools |= {move.tool for move in program.moves}
    cutters = {program.moves[cut.at].tool for cut in made if not cut.places and solids.stock}
    for stretch in program.stretches:
        at_feed = not stretch.is_rapid and stretch.is_known and stretch.radius > 0
        if not at_feed or len(stretch.sides) != 1:
            continue
        (side,) = stretch.sides
        for index in stretch.moves:
            move, speed = program.moves[index], program.speed(index)
            taps = stretch.cut.is_tap if stretch.cut else move.block in program.tapping
            per_minute = move.feed * (speed if move.feed_mode == "G95" else 1)
            per_turn = per_minute / speed if speed else 0.0
            fast = per_turn > PER_TURN
            if move.kind != "feed" or taps or move.tool not in (tools if fast else cutters):
                continue
            tip = program.tip(index, side)
            if _plunges(tip, CENTRE * stretch.radius, side, index, solids):
                values = {"feed": per_minute, "per_turn": per_turn, "tool": move.tool}
                yield program.found(PLUNGE_FAST if fast else PLUNGE, index, tip[-1], **values)


def _plunges(tip: np.ndarray, radius: float, side: float, index: int, solids: Solids) -> bool:
    """Return whether a tool goes straight down into what stands below its centre."""
    if not straight_down(tip) or tip[-1, 2] >= min(tip[0, 2], solids.top(side) - LEAST):
        return False
    standing = solids.standing(disc(tip[-1, :2], radius), tip[-1, 2], side, before=index)
    return standing.area > 0.5 * math.pi * radius**2
