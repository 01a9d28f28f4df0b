# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a called shape or its holes were cut: their moves, laid along the expected toolpath.

What a run makes of a shape is judged with the section in its sub. Lengths are mm.
"""

import math
from bisect import bisect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any, NamedTuple

from g12.geometry.curve import Line
from g12.tools.path.follow import Followed
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.part import C
from g12.tools.path.slowest import Pace
from g12.tools.path.track import CART_FUZZ
from g12.tools.preview.executed_blocks import CLAMP, Block
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.compare.path import Laid, Made, judge_path, lay
from g12.tools.verify.compare.plane import turned_plane
from g12.tools.verify.compare.section import LaidMoves, ToolpathView, judge_toolpath
from g12.tools.verify.compare.state import judge_events, judge_state
from g12.tools.verify.expected.contour import ACTS
from g12.tools.verify.expected.holes import Holes, HolesPath, holes_of
from g12.tools.verify.expected.shapes import shape_path
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.result.cut import MeasuredCut, finite, in_file
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LAST_DECIMAL, LEVEL
from g12.tools.verify.subject import Subject


def measure_shape(
    call: SubCall, subject: Subject, axes: LatheAxes, tolerance: float
) -> MeasuredCut:
    """Return what was measured of a shape; the ``subject`` is that of the face about its X0."""
    block, expected = call.block, shape_path(call)
    view = ToolpathView(
        expected=expected,
        plane=turned_plane(math.radians(call.zero[2]), call.zero[1]),
        own=call.moves,
        moves=subject.trace.moves,
        path=subject.path,
        real=None,
        axes=axes,
        allowed=(tolerance + LAST_DECIMAL, math.inf),
        diameters=call.diameters,
        last=call.line,
    )
    events = (each.text for each in block.own_events if ACTS.match(each.text))
    judged = [
        *judge_toolpath(view),
        *judge_state(block.state_after, call.leaves(), call.line),
        *judge_events(events, call.line),
    ]
    values = {
        "cutter": 2 * call.cutter,
        "entries": call.given,
        "lowest": min(move.end_level for move in expected),
    }
    return _called_cut(call, view.found, values, judged)


def _called_cut(
    call: SubCall,
    found: LaidMoves,
    values: Mapping[str, Any],
    judged: Iterable[Finding],
) -> MeasuredCut:
    where = call.line, call.file, call.name, call.moves
    values = {**values, "deviation": finite(found.off)}
    return MeasuredCut(call, *where, call.zero[1], found.off, values, in_file(judged, call.file))


class Clamp(NamedTuple):
    """The M codes that close and open the clamp, if any; ``traced``: events show them."""

    codes: Sequence[str]
    traced: bool


def measure_holes(
    call: SubCall,
    moves: Sequence[Move],
    tolerance: float,
    clamp: Clamp,
    pace: Callable[[Sequence[int], Sequence[int]], Pace],
    real: Followed | None = None,
) -> MeasuredCut:
    """Return what was measured of a call.

    ``pace`` is a function of all its moves and of those that cut.
    """
    block, holes, own = call.block, holes_of(call), call.moves
    turns = (moves[i].end[C] - moves[i].start[C] for i in own)
    expected = HolesPath(
        holes, next((turn for turn in turns if abs(turn) > CART_FUZZ), 0.0)
    ).toolpath()
    laid, run = lay(expected, _made_of_holes(holes, moves, own), tolerance), None
    if real and not laid.difference and not holes.pitch:
        run = _laid_run(holes, expected, real, own, tolerance)
    found = LaidMoves(laid, run)
    events = [each for each in block.own_events if ACTS.match(each.text) and not clamp.codes]
    texts = (each.text for each in events if not each.text.startswith("dwell"))
    blended = [i for i in own if moves[i].kind == "rapid" and not moves[i].exact][:1]
    judged = [
        *judge_path(found.laid, call.line, holes.place, holes.words),
        *_passed_over(holes, expected, laid),
        *(Finding("blended-hole", call.line) for _ in blended),
        *_judge_dwells(holes, block.own_events, moves),
        *_judge_clamp(holes, expected, laid, block, clamp),
        *([] if call.cutter else [Finding("no-diameter", call.line)]),
        *judge_state(block.state_after, call.leaves(), call.line),
        *judge_events(texts, call.line),
    ]
    values = {
        "circle": 2 * holes.circle,
        "angles": holes.angles,
        "along_z": holes.z if holes.side else None,
        "depth": holes.depth,
        "count": holes.count,
        "pitch": holes.pitch or None,
        "entries": call.given,
        **_times_of_holes(holes, pace(own, []), real),
    }
    cut = _called_cut(call, found, values, judged)
    tapping = [holes.pitch * call.speed] if call.speed else []
    surface = holes.circle if holes.side else 0.0
    feeds = tuple(tapping) if holes.pitch else None
    return replace(cut, feeds=feeds, per_turn=holes.pitch, surface=surface)


def _times_of_holes(holes: Holes, pace: Pace, real: Followed | None) -> dict[str, float | None]:
    """Return the seconds of a call; without a run those of taps, by the spindle, are not known."""
    programmed = None if holes.pitch else pace.expected + holes.count * (holes.dwell or 0.0)
    return {"seconds": pace.seconds if real else programmed, "seconds_programmed": programmed}


def _laid_run(
    holes: Holes, expected: Sequence[Expected], real: Followed, own: range, tolerance: float
) -> Laid:
    """Return the motion of a run laid along the moves, from where they begin.

    Which of its samples are rapids is not known: at the ends of moves they are not distinguished.
    """
    points = [holes.point(at) for index in own for at in real.positions[real.during(index)]]
    begin, level = expected[0].point(0.0)
    near = (n for n, at in enumerate(points) if abs(at[0] - begin) + abs(at[1] - level) < tolerance)
    path = [move._replace(rapid=False, feed=None) for move in expected]
    made = Made(own.start, points[next(near, 0) :], sampled=True)
    return lay(path, [made] if len(made.points) > 1 else [], tolerance)


def _made_of_holes(holes: Holes, moves: Sequence[Move], own: range) -> Iterator[Made]:
    """Yield the moves of a call that go anywhere."""
    for index in own:
        move = moves[index]
        ends = [holes.point(move.start), holes.point(move.end)]
        if max(abs(ends[0][0] - ends[1][0]), abs(ends[0][1] - ends[1][1])) > CART_FUZZ:
            yield Made.of(index, move, ends, Line(ends[0][0], ends[1][0]))


def _judge_dwells(
    holes: Holes, events: Sequence[Event], moves: Sequence[Move]
) -> Iterator[Finding]:
    """Yield what is wrong with the dwells at the bottoms, and with the pitches of taps."""
    call = holes.call
    act = f"dwell {holes.dwell:g}" if holes.dwell else f"pitch {holes.pitch:.10g} mm"
    found = [e for e in events if e.text.startswith(("dwell", "pitch")) and e.text != "dwell 0"]
    others = dict.fromkeys(each.text for each in found if each.text != act)
    for text in others:
        yield Finding("extra-event", call.line, {"event": text})
    same = [each for each in found if each.text == act]
    if len(same) < holes.count and (holes.dwell or holes.pitch):
        yield Finding("act-missing", call.line, {"act": act})
    bottom = -holes.depth if holes.dwell else call.length("retract")
    levels = [holes.point(moves[each.at].start)[1] for each in same]
    if any(abs(level - bottom) > LEVEL for level in levels):
        yield Finding("act-off-bottom", call.line, {"act": act})


def _passed_over(holes: Holes, expected: Sequence[Expected], laid: Laid) -> Iterator[Finding]:
    """Yield the first move that is missing: a retract and its return lie on the way down."""
    missing = [move for move, made in zip(expected, laid.moves) if not made]
    for move in missing[:1] if not laid.difference else ():
        at = move.point(1.0)
        values = {"what": move.name, "at": holes.words(at)}
        yield Finding("path-missing", move.line, values, holes.place(at))


def _judge_clamp(
    holes: Holes, expected: Sequence[Expected], laid: Laid, block: Block, clamp: Clamp
) -> Iterator[Finding]:
    """Yield the first move of each kind in which the clamp is otherwise, or that it stays so.

    Also that it was not judged, where there are codes that no event shows.
    """
    if not clamp.codes:
        return
    (close, opens), call = clamp.codes, holes.call
    if not clamp.traced:
        yield Finding("clamp-unseen", call.line, {"codes": f"{close} and {opens}"})
        return
    events = [each for each in block.own_events if each.text.startswith(f"{CLAMP} ")]
    at, codes = [each.at for each in events], ["", *(each.text.split()[1] for each in events)]
    for closed, name, code in ((True, "clamp-open", close), (False, "clamp-closed", opens)):
        wrong = (
            move.name
            for move, made in zip(expected, laid.moves)
            if holes.clamped(move) is closed
            and any(codes[bisect(at, index)] != code for index in made)
        )
        for what in islice(wrong, 1):
            yield Finding(name, call.line, {"what": what, "code": code})
    if codes[-1] != opens:
        yield Finding("clamp-left", call.line, {"code": opens})
