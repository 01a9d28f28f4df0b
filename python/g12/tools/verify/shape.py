# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a shape was cut: its moves, laid along the toolpath that its call asks for.

What a run makes of them is judged with the section in the shape's sub. Lengths are mm.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from g12.tools.path.track import Track
from g12.tools.preview.executed_blocks import Block, Text
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import OFF, Point, lay
from g12.tools.verify.compare.path_judge import judge_path
from g12.tools.verify.compare.section import OffFeed, SectionPath, feed_off, made_of
from g12.tools.verify.compare.section_plane import FacePlane
from g12.tools.verify.compare.state import StateDifference, judge_state, state_differences
from g12.tools.verify.expected.calls import CallReading, SubCall
from g12.tools.verify.expected.contour import ACTS
from g12.tools.verify.expected.shapes import shape_path
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LAST_DECIMAL
from g12.tools.verify.sections.section_motion import SectionAxes, slower_on_face

CalledShape = tuple[Block, SubCall]


@dataclass(frozen=True)
class ShapeFacts:
    """What was measured of one shape.

    ``feed_off`` is the first feed along its toolpath that is not the call's, ``state`` what it
    leaves otherwise, ``events`` what it does besides moving.
    """

    call: SubCall
    plane: FacePlane
    path: SectionPath
    feed_off: OffFeed | None
    state: tuple[StateDifference, ...]
    events: tuple[str, ...]

    def words(self, at: Point) -> tuple[tuple[str, float], ...]:
        """Return a point as a program writes it: X, C and Z."""
        return self.plane.words(at, self.call.diameters)

    @property
    def deviation(self) -> float:
        """The tool centre's greatest distance from where it should be, inf if part is missing."""
        difference = self.path.difference
        if difference is None:
            return self.path.deviation
        return difference.size if difference.kind == OFF else math.inf

    @property
    def lowest(self) -> float:
        """The lowest Z of its toolpath."""
        return min(move.end_level for move in self.path.expected)


def called_subs(
    blocks: Sequence[Block],
    moves: Sequence[Move],
    diameters: Mapping[int, float],
    reading: CallReading,
    named: Callable[[Text], str],
) -> Iterator[CalledShape]:
    """Yield each call of the subs that are ``named`` which moves anything."""
    for block in blocks:
        if named(block.text) and block.end > block.at:
            first = moves[block.at]
            yield block, SubCall(block, first, diameters.get(first.tool, 0.0) / 2, reading)


def measure_shape(
    called: CalledShape, path: Track, moves: Sequence[Move], axes: SectionAxes, tolerance: float
) -> ShapeFacts:
    """Return the facts of a shape; ``path`` is that of the face about its X0."""
    block, call = called
    plane, expected = FacePlane(*call.zero), shape_path(call)
    pieces = ((index, path.positions[path.vertices(index)]) for index in call.moves)
    laid = lay(expected, made_of(pieces, moves, plane), tolerance + LAST_DECIMAL)
    found = SectionPath(expected, [], laid)
    return ShapeFacts(
        call,
        plane,
        found,
        feed_off(found, moves, slower_on_face(found, moves, path, axes)),
        state_differences(block.left, call.leaves()),
        tuple(dict.fromkeys(each.text for each in block.own_events if ACTS.match(each.text))),
    )


def judge_shape(facts: ShapeFacts) -> Iterator[Finding]:
    """Yield what is wrong with a shape."""
    call, plane = facts.call, facts.plane
    yield from judge_path(facts.path.emitted, call.line, call.file, plane.place, facts.words)
    off = facts.feed_off
    if off:
        at = off.expected.point(1.0)
        values = {"what": off.expected.name, "made": off.made, "expected": off.asked}
        yield Finding("feed", call.line, values, plane.place(at), call.file)
    yield from judge_state(facts.state, facts.events, call.line, call.file)
