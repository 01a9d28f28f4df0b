# SPDX-License-Identifier: GPL-2.0-or-later
"""The fourth question: is the tool in the part where it must not be."""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from g12.tools.path.part import disc
from g12.tools.preview.moves import Event
from g12.tools.verify.model.finding import FINDING, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down
from g12.tools.verify.model.solid import FACE, Solids
from g12.tools.verify.model.spindles import LIVE

CENTRE = 0.2  # of a cutter's radius: where an end mill may have no edge
LEAST = 1e-3  # mm
PER_TURN = 0.6  # mm: no tool plunges so fast
CHANGE = kind("change-in-part", FINDING, "the tool is changed in the part")
CHANGE_LOW = kind("change-low", WARNING, "the tool is changed beside the part, below Z0")
STOP = kind("stop-in-part", FINDING, "the spindle stops (M5) in the part")
START = kind("start-in-part", WARNING, "the spindle starts ({code}) in the part")
END = kind("ends-in-part", FINDING, "the program ends with the tool in the part")
KINDS = {"tool": CHANGE, "M5": STOP, "M3": START, "M4": START}
CHANNEL = kind("channel", WARNING, "it cuts {area:mm2} at feed on the way to the next: no retract?")
PLUNGE = kind(
    "plunge", WARNING, "it plunges at {feed:feed} with its centre: can the tool cut there?"
)
PLUNGE_FAST = kind(
    "plunge-fast", FINDING, "it plunges at {feed:feed}, {per_turn:fine} a revolution"
)


def judge_in_part(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    last = len(program.moves) - 1
    for event in [*program.trace.events, *_live_tool(program)]:
        code = event.text.split()[0]
        if code in KINDS and 0 < event.at <= last + (code != "M5"):
            yield from _event(code, event, program, solids)
    if last >= 0:
        yield from (program.found(END, last, tip) for tip, _ in in_part(last, program, solids))
    yield from between_cuts(program, solids)
    yield from plunges(program, solids)


def in_part(
    index: int, program: TracedProgram, solids: Solids, *, below: bool = False
) -> Iterator[tuple[np.ndarray, bool]]:
    """Yield the tip at the end of a move where it is in the part, and that it is inside.

    With ``below`` also where it is beside the part, below its top.
    """
    if not program.known_after[index] or not program.is_known(index):
        return
    for side in program.sides[index] or ():
        tip = program.tip(index, side)[-1]
        inside = solids.surrounds(tip, index, side)
        if inside or (below and tip[2] < solids.top(side) - LEAST):
            yield tip, inside


def _event(code: str, event: Event, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield a tool change, a start or a stop of the spindle with the tip in the part."""
    changes = code == "tool"
    lifted = changes and program.ini.number("EMCIO", "TOOL_CHANGE_QUILL_UP", 0)
    if lifted or (code == "M5" and _is_followed(event, program)):
        return
    for tip, inside in in_part(event.at - 1, program, solids, below=changes):
        yield Finding(KINDS[code] if inside else CHANGE_LOW, event.line, {"code": code}, tip)


def _live_tool(program: TracedProgram) -> Iterator[Event]:
    """Yield where the lines start and stop the live tool, as events."""
    for line, (before, after) in enumerate(pairwise(program.spindles or ()), 1):
        if before.turns(LIVE) != after.turns(LIVE):
            blocks = (move.block for move in program.moves)
            at = next((index for index, block in enumerate(blocks) if block > line), -1)
            yield Event(at, line, "M3" if after.turns(LIVE) else "M5")


def _is_followed(event: Event, program: TracedProgram) -> bool:
    """Return whether M6 stops the spindle, or a boring cycle starts it again in the same block."""
    others = (e for e in program.trace.events if e.line == event.line or e.at == event.at)
    return any(e.text.startswith(("tool ", "M3", "M4")) for e in others)


def between_cuts(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield moves at feed from one circle to the next, at depth, through what stands there."""
    circles = [cut for cut in program.cuts if cut.is_circle]
    for before, after in zip(circles, circles[1:]):
        for index in range(before.end, after.at):
            points = program.tip(index, FACE)
            is_other = program.cut_at(index) or program.moves[index].kind == "rapid"
            if is_other or straight_down(points) or points[:, 2].min() > solids.top(FACE) - 0.01:
                continue
            touch = solids.of(FACE).touched(points, program.cutter(index), index)
            if touch:
                yield program.found(CHANNEL, index, points[0], area=touch.area)


def plunges(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield feed moves straight into the material.

    Of a drill, and without a given stock, only those that are too fast for any tool; no tap.
    """
    made = [cut for cut in program.cuts if cut.at < cut.end]
    tools = {program.moves[cut.at].tool for cut in made}
    cutters = {program.moves[cut.at].tool for cut in made if not cut.places and solids.stock}
    for index, move in enumerate(program.moves):
        sides, own = program.sides[index] or set(), program.cut_at(index)
        if move.kind != "feed" or (own and own.is_tap) or len(sides) != 1 or move.tool not in tools:
            continue
        (side,) = sides
        speed = program.state(index).speed
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
