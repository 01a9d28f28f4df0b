# SPDX-License-Identifier: GPL-2.0-or-later
"""How the spindle turns where the program cuts, and the tool length in force there.

LinuxCNC believes G43's H as the cycles believe D. A program that never commands G43 may have
touched off Z with its tool, and so may one that cancels it by G49 before the tool cuts; any other
works with the lengths of the table.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import groupby

from g12.tools.machine.ini import Ini
from g12.tools.path.part import C, X, Z
from g12.tools.path.track import Limits, Track
from g12.tools.preview.moves import Event, Move, Trace
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL, SIZE

USER_CODE = re.compile(r"M1\d\d P.*")  # may turn a spindle of its own
SPEED = re.compile(r"S[\d.]+")
SPINDLE = re.compile(rf"M[345]|{SPEED.pattern}")
MOST_PER_TURN = 3.0  # mm per revolution: above it the number was meant per minute
LEAST_PER_MINUTE = 1.0  # mm/min: below it the number was meant per revolution
CUT_DOWN = 0.98  # of the feed
TURNS = 1e-6  # degrees or mm


def judge_spindle(
    cuts: Sequence[MeasuredCut], events: Sequence[Event], ini: Ini
) -> Iterator[Finding]:
    """Yield the first cut of each kind whose spindle is off, or turns the wrong way.

    Where that begins inside of a section, its line is that of the move after it.
    """
    reported: set[str] = set()
    several = ini.number("TRAJ", "SPINDLES", 1) > 1
    for cut in cuts:
        before = [event for event in events if event.at < cut.own.stop]
        code = _unusual_spindle(cut.turning, [event.text for event in before], several)
        if code and code not in reported:
            reported.add(code)
            at_start = [event.text for event in before if event.at <= cut.own.start]
            changes = [event.line for event in before if SPINDLE.fullmatch(event.text)]
            inside = not cut.file and _unusual_spindle(cut.turning, at_start, several) != code
            line = changes[-1] if inside else cut.line
            yield Finding(code, line, {"code": cut.code}, file=cut.file)


def _unusual_spindle(turning: bool, texts: Sequence[str], several: bool) -> str:
    """Return the code of what is unusual about the spindle in front of a cut, "" if nothing.

    ``texts`` are the events before it. A trace shows the first spindle alone: of a machine with
    ``several`` that is the main one, and nothing is known of the tool's.
    """
    if any(USER_CODE.fullmatch(text) for text in texts):
        return ""
    spindle = next((text for text in reversed(texts) if text in ("M3", "M4", "M5")), "")
    speed = next((text for text in reversed(texts) if SPEED.fullmatch(text)), "")
    runs = spindle in ("M3", "M4") and speed != "S0"
    if several and turning:
        return "main-spindle-turns" if runs else "tool-spindle-unseen"
    if several:
        return ""
    if turning and not runs:
        return "tool-spindle"
    if spindle == "M5" or speed == "S0":
        return "spindle-off"
    return "spindle-m4" if spindle == "M4" and runs else ""


def judge_tool_length(cuts: Sequence[MeasuredCut], trace: Trace) -> Iterator[Finding]:
    """Yield the cuts that are made with another length than the loaded tool's, or offset in X.

    Those without a tool are reported as such.
    """
    moves, events = trace.moves, trace.events
    compensated = uses_lengths(moves)
    reported: set[tuple[int, int, float]] = set()  # axis, tool, how far off
    with_length: set[int] = set()  # the tools that have cut with the length of the table
    for cut in (each for each in cuts if moves[each.own.start].tool > 0):
        at, first = cut.own.start, moves[cut.own.start]
        deeper, set_by = missing_length(trace, at), length_set_by(events, at)
        beside = trace.table_at(at).offsets.get(first.tool, 0.0) - first.tool_offset[X]
        intended = set_by in ("G49", "G43.1", "G43.2") or not compensated
        touched_off = set_by == "G49" and first.tool not in with_length
        code = _length_code(deeper, set_by, used=compensated and not touched_off)
        if abs(deeper) < SIZE:
            with_length.add(first.tool)
        wrong = [("offset-beside", X, 0.0 if intended else beside), (code, Z, deeper)]
        for found, axis, off in wrong:
            if abs(off) > SIZE and (axis, first.tool, off) not in reported:
                reported.add((axis, first.tool, off))
                values = {"tool": first.tool, "offset": first.tool_offset[axis], "off": abs(off)}
                values |= {"code": set_by, "where": "deeper" if off > 0.0 else "higher"}
                yield Finding(found, cut.line, values, first.end[:3], cut.file)


def _length_code(deeper: float, set_by: str, used: bool) -> str:
    """Return what it is to cut by so much deeper, with a tool whose length is ``used`` or not."""
    if set_by == "G43.2" or (set_by == "G43.1" and deeper < 0.0):
        return "length-commanded"
    if not used:
        return "length-not-used"
    return "length-deeper" if deeper > 0.0 else "length-higher"


def uses_lengths(moves: Sequence[Move]) -> bool:
    """Tell whether a program works with tool lengths at all."""
    return any(abs(move.tool_offset[axis]) > SIZE for move in moves for axis in (X, Z))


def missing_length(trace: Trace, at: int) -> float:
    """Return by how much the loaded tool is longer than the length in force."""
    move = trace.moves[at]
    return trace.table_at(at).lengths.get(move.tool, 0.0) - move.tool_offset[Z]


def length_set_by(events: Sequence[Event], at: int) -> str:
    """Return the code that set the tool length of a move (index), if no tool was changed since."""
    changes = (event.text for event in reversed(events) if event.at <= at)
    return next((each for each in changes if each.startswith(("tool ", "G43", "G49"))), "")


def judge_levels(cuts: Sequence[MeasuredCut], moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the cuts of which nothing goes below Z0, the top of the part as a rule."""
    for cut in cuts:
        lowest = cut.lowest(moves)
        if lowest > cut.face - LEVEL:
            values = {"level": lowest - cut.face}
            yield Finding("above-zero", cut.line, values, moves[cut.own.start].end[:3], cut.file)


def judge_feeds(
    cuts: Sequence[MeasuredCut], moves: Sequence[Move], limits: Limits
) -> Iterator[Finding]:
    """Yield what to know of the feeds of cuts."""
    for cut in cuts:
        fed = [move for move in cut.fed(moves) if move.feed and cut.feeds is None]
        per_turn = [cut.per_turn, *(move.feed for move in fed if move.feed_mode == "G95")]
        feeds = cut.feeds or [move.feed for move in fed if move.feed_mode != "G95"]
        most = 60.0 * min(limits.path, *limits.axes[X : Z + 1])
        if max(per_turn) > MOST_PER_TURN:
            values = {"feed": max(per_turn)}
            yield Finding("feed-per-revolution", cut.line, values, file=cut.file)
        if min(feeds, default=LEAST_PER_MINUTE) < LEAST_PER_MINUTE:
            yield Finding("feed-per-minute", cut.line, {"feed": min(feeds)}, file=cut.file)
        if most < CUT_DOWN * max(feeds, default=0.0):
            values = {"feed": max(feeds), "most": most}
            yield Finding("feed-cut-down", cut.line, values, file=cut.file)


def judge_native_c(moves: Sequence[Move], known: set[int], path: Track) -> Iterator[Finding]:
    """Yield feed moves of X or Z together with C outside of cuts; ``known`` are the cuts' moves."""
    found = [
        index
        for index, move in enumerate(moves)
        if index not in known and move.kind == "feed" and _turns_and_goes(move)
    ]
    for _, group in groupby(enumerate(found), lambda pair: pair[1] - pair[0]):
        indices = [index for _, index in group]
        speeds = [path.part_feed(index) for index in indices]
        values = {"feeds": (min(speeds), max(speeds))}
        yield Finding("native-c", moves[indices[0]].block, values, moves[indices[0]].end[:3])


def _turns_and_goes(move: Move) -> bool:
    change = [abs(end - start) > TURNS for start, end in zip(move.start, move.end)]
    return change[C] and (change[X] or change[Z]) and move.feed_mode != "G93"
