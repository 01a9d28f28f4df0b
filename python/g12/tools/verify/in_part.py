# SPDX-License-Identifier: GPL-2.0-or-later
"""The fourth question: is the tool in the part where it must not be."""

import math
from collections.abc import Iterator
from itertools import pairwise

from g12.tools.path.part import disc
from g12.tools.preview.moves import Event
from g12.tools.verify.model.finding import FINDING, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down
from g12.tools.verify.model.solid import FACE, Solids
from g12.tools.verify.model.spindles import LIVE

CENTRE = 0.2  # of a cutter's radius: where an end mill may have no edge
LEAST = 1e-3  # mm
PER_TURN = 0.6  # mm: no tool plunges so fast
CHANGE = kind("change-in-part", FINDING, "the tool is changed in the part: retract before M6")
CHANGE_LOW = kind(
    "change-low", WARNING, "the tool is changed below Z0, beside the part: retract before M6"
)
STOP = kind("stop-in-part", FINDING, "the spindle stops (M5) in the part: retract before it")
START = kind("start-in-part", WARNING, "the spindle starts ({code}) in the part: retract before it")
END = kind("ends-in-part", FINDING, "the program ends with the tool in the part: retract before M2")
CHANNEL = kind(
    "channel", WARNING, "it cuts {area:mm2} at feed on the way to the next: retract missing?"
)
PLUNGE = kind(
    "plunge", WARNING, "it plunges at {feed:feed} with its centre: can the tool cut there?"
)
PLUNGE_FAST = kind(
    "plunge-fast",
    FINDING,
    "it plunges at {feed:feed}, {per_turn:fine} a revolution, with its centre",
)


def judge_in_part(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    at_rest = len(program.moves) - 1
    for event in [*program.trace.events, *_live_tool(program)]:
        if 0 < event.at <= at_rest + (event.text != "M5"):
            yield from _event(event, program, solids)
    for side in (
        program.sides[at_rest] or () if at_rest >= 0 and program.known_after[at_rest] else ()
    ):
        tip = program.tip(at_rest, side)[-1]
        if program.is_known(at_rest) and solids.surrounds(tip, at_rest, side):
            line, file = program.where(at_rest)
            yield Finding(END, line, {}, tip, file)
    yield from between_cuts(program, solids)
    yield from plunges(program, solids)


def _event(event: Event, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield a tool change, a start or a stop of the spindle with the tip in the part."""
    index, code = event.at - 1, event.text.split()[0]
    if code not in ("M3", "M4", "M5", "tool") or not program.known_after[index]:
        return
    if not program.is_known(index) or (code == "M5" and _is_followed(event, program)):
        return
    lifted = code == "tool" and program.ini.number("EMCIO", "TOOL_CHANGE_QUILL_UP", 0)
    for side in () if lifted else program.sides[index] or ():
        tip = program.tip(index, side)[-1]
        if solids.surrounds(tip, index, side):
            of = {"tool": CHANGE, "M5": STOP}.get(code, START)
            yield Finding(of, event.line, {"code": code}, tip)
        elif code == "tool" and tip[2] < solids.top(side) - LEAST:
            yield Finding(CHANGE_LOW, event.line, {}, tip)


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
            is_rapid = program.moves[index].kind == "rapid"
            if is_rapid or straight_down(points) or points[:, 2].min() > solids.top(FACE) - 0.01:
                continue
            touch = solids.touched(points, index, FACE)
            if touch:
                line, file = program.where(index)
                yield Finding(CHANNEL, line, {"area": touch.area}, points[0], file)


def plunges(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield feed moves straight into the material.

    Of a drill, and without a given stock, only those that are too fast for any tool; no tap.
    """
    made = [cut for cut in program.cuts if cut.at < cut.end]
    tools = {program.moves[cut.at].tool for cut in made}
    cutters = {program.moves[cut.at].tool for cut in made if not cut.places}
    for index, move in enumerate(program.moves):
        sides, own = program.sides[index] or (), program.cut_at(index)
        straight = move.kind == "feed" and not (own and own.is_tap)
        if straight and len(sides) == 1 and move.tool in tools:
            yield from _plunge(index, program, solids, warned=move.tool in cutters)


def _plunge(
    index: int, program: TracedProgram, solids: Solids, *, warned: bool
) -> Iterator[Finding]:
    (side,) = program.sides[index]
    move, points = program.moves[index], program.tip(index, side)
    speed, radius = program.state(index).speed, program.cutter(index)
    per_turn = move.feed if move.feed_mode == "G95" else move.feed / speed if speed else 0.0
    fast = per_turn > PER_TURN
    down = straight_down(points) and points[-1, 2] < points[0, 2]
    if radius <= 0 or not down or points[-1, 2] >= solids.top(side) - LEAST:
        return
    at = points[points[:, 2].argmin()]
    if (fast or (warned and solids.stock)) and program.is_known(index):
        middle = disc(at[:2], CENTRE * radius)
        standing = solids.standing(middle, at[2], side, before=index)
        if standing.area > 0.5 * math.pi * (CENTRE * radius) ** 2:
            line, file = program.where(index)
            feed = per_turn * speed if move.feed_mode == "G95" else move.feed
            values = {"feed": feed, "per_turn": per_turn}
            yield Finding(PLUNGE_FAST if fast else PLUNGE, line, values, at, file)
