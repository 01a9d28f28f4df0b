# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a call of holes with C was drilled: its moves, laid along the expected toolpath."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from g12.geometry.curve import Line
from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.track import STILL
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.compare.clamp import Clamp, judge_clamp
from g12.tools.verify.compare.path import Laid, Made, lay
from g12.tools.verify.compare.path_judge import judge_path
from g12.tools.verify.compare.section import SectionPath
from g12.tools.verify.compare.state import judge_state, state_differences
from g12.tools.verify.expected.calls import SubCall
from g12.tools.verify.expected.contour import ACTS
from g12.tools.verify.expected.holes import Holes, HolesPath, holes_of
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL


@dataclass(frozen=True)
class HolesFacts:
    """What was measured of the holes of one call, and its findings."""

    holes: Holes
    path: SectionPath
    judged: tuple[Finding, ...]

    @property
    def deviation(self) -> float:
        """The greatest distance from the toolpath, inf if part of it is missing; mm."""
        return self.path.off


def measure_holes(
    called: tuple[Block, SubCall],
    moves: Sequence[Move],
    tolerance: float,
    clamp: Clamp,
    real: Followed | None = None,
) -> HolesFacts:
    """Return the facts of a call."""
    block, call = called
    holes, own = holes_of(call), range(block.at, block.end)
    turns = (moves[i].end[C] - moves[i].start[C] for i in own)
    expected = HolesPath(holes, next((turn for turn in turns if abs(turn) > STILL), 0.0)).toolpath()
    laid, run = lay(expected, made_of_holes(holes, moves, own), tolerance), None
    if real and not laid.difference and not holes.pitch:
        run = laid_run(holes, expected, real, own, tolerance)
    found, where = SectionPath(expected, [], laid, run), (call.line, call.file)
    events = [each for each in block.own_events if ACTS.match(each.text) and not clamp.codes]
    texts = dict.fromkeys(each.text for each in events if not each.text.startswith("dwell"))
    state = state_differences(block.left, call.leaves())
    judged = [
        *judge_path(found.laid, *where, holes.place, holes.words),
        *passed_over(holes, expected, laid),
        *judge_rapids(call, moves, own),
        *judge_dwells(holes, block.own_events, moves),
        *judge_clamp(holes, expected, laid, block, clamp),
        *judge_state(state, texts, *where),
    ]
    return HolesFacts(holes, found, tuple(judged))


def laid_run(
    holes: Holes, expected: Sequence[Expected], real: Followed, own: range, tolerance: float
) -> Laid:
    """Return the motion of a run laid along the moves, from where they begin.

    Which of its samples are rapids is not known: at the ends of moves they are not told apart.
    """
    points = [holes.point(at) for index in own for at in real.positions[real.during(index)]]
    begin, level = expected[0].point(0.0)
    near = (n for n, at in enumerate(points) if abs(at[0] - begin) + abs(at[1] - level) < tolerance)
    path = [move._replace(rapid=False, feed=None) for move in expected]
    made = Made(own.start, points[next(near, 0) :], sampled=True)
    return lay(path, [made] if len(made.points) > 1 else [], tolerance)


def made_of_holes(holes: Holes, moves: Sequence[Move], own: range) -> Iterator[Made]:
    """Yield the moves of a call that go anywhere."""
    for index in own:
        move = moves[index]
        ends = [holes.point(move.start), holes.point(move.end)]
        if max(abs(ends[0][0] - ends[1][0]), abs(ends[0][1] - ends[1][1])) > STILL:
            rapid = move.kind == "rapid"
            feed = None if rapid else move.feed
            curve = Line(ends[0][0], ends[1][0])
            yield Made(index, ends, curve, feed, rapid, move.feed_mode == "G95")


def judge_dwells(holes: Holes, events: Sequence[Event], moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield what is wrong with the dwells at the bottoms, and with the pitches of taps."""
    call = holes.call
    asked = f"dwell {holes.dwell:g}" if holes.dwell else f"pitch {holes.pitch:.10g} mm"
    found = [e for e in events if e.text.startswith(("dwell", "pitch")) and e.text != "dwell 0"]
    others = dict.fromkeys(each.text for each in found if each.text != asked)
    for text in others:
        yield Finding("extra-event", call.line, {"event": text}, file=call.file)
    same = [each for each in found if each.text == asked]
    if len(same) < holes.count and (holes.dwell or holes.pitch):
        yield Finding("act-missing", call.line, {"act": asked}, file=call.file)
    bottom = -holes.depth if holes.dwell else call.length("retract")
    levels = [holes.point(moves[each.at].start)[1] for each in same]
    if any(abs(level - bottom) > LEVEL for level in levels):
        yield Finding("act-off-bottom", call.line, {"act": asked}, file=call.file)


def passed_over(holes: Holes, expected: Sequence[Expected], laid: Laid) -> Iterator[Finding]:
    """Yield the first move that is not made: a way back and again lies on the way down."""
    missing = [move for move, made in zip(expected, laid.moves) if not made]
    for move in missing[:1] if not laid.difference else ():
        at = move.point(1.0)
        values = {"what": move.name, "at": holes.words(at)}
        yield Finding("path-missing", move.line, values, holes.place(at), holes.call.file)


def judge_rapids(call: SubCall, moves: Sequence[Move], own: range) -> Iterator[Finding]:
    """Yield that a rapid is not in exact path mode."""
    if any(moves[i].kind == "rapid" and not moves[i].exact for i in own):
        yield Finding("blended-hole", call.line, file=call.file)
