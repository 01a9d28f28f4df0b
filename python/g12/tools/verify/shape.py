# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a shape was cut: its moves, laid along the toolpath that its call asks for.

What a run makes of them is judged with the section in the shape's sub. Lengths are mm.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from g12.tools.machine.ini import Ini
from g12.tools.path.track import Track
from g12.tools.preview.executed_blocks import Block, Text
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import lay
from g12.tools.verify.compare.section import SectionPath, judge_toolpath, made_of
from g12.tools.verify.compare.section_plane import FacePlane
from g12.tools.verify.compare.state import judge_state, state_differences
from g12.tools.verify.expected.calls import SubCall
from g12.tools.verify.expected.contour import ACTS
from g12.tools.verify.expected.shapes import shape_path
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LAST_DECIMAL
from g12.tools.verify.sections.section_motion import SectionAxes, slower_on_face

CalledShape = tuple[Block, SubCall]


@dataclass(frozen=True)
class ShapeFacts:
    """What was measured of one shape, and its findings."""

    call: SubCall
    path: SectionPath
    judged: tuple[Finding, ...]

    @property
    def deviation(self) -> float:
        """The tool centre's greatest distance from where it should be, inf if part is missing."""
        return self.path.off

    @property
    def lowest(self) -> float:
        """The lowest Z of its toolpath."""
        return min(move.end_level for move in self.path.expected)


def called_subs(
    blocks: Sequence[Block],
    moves: Sequence[Move],
    diameters: Mapping[int, float],
    ini: Ini,
    named: Callable[[Text], str],
) -> Iterator[CalledShape]:
    """Yield each call of the subs that are ``named`` which moves anything."""
    for block in blocks:
        if named(block.text) and block.end > block.at:
            first = moves[block.at]
            yield block, SubCall(block, first, diameters.get(first.tool, 0.0) / 2, ini)


def measure_shape(
    called: CalledShape, path: Track, moves: Sequence[Move], axes: SectionAxes, tolerance: float
) -> ShapeFacts:
    """Return the facts of a shape; ``path`` is that of the face about its X0."""
    block, call = called
    plane, expected = FacePlane(*call.zero), shape_path(call)
    segments = ((index, path.positions[path.vertices(index)]) for index in call.moves)
    laid = lay(expected, made_of(segments, moves, plane), tolerance + LAST_DECIMAL)
    found = SectionPath(expected, [], laid)
    slower, where = slower_on_face(found, moves, path, axes), (call.line, call.file)
    state = state_differences(block.left, call.leaves())
    events = dict.fromkeys(each.text for each in block.own_events if ACTS.match(each.text))
    judged = [
        *judge_toolpath(found, plane, call.diameters, moves, slower, *where),
        *judge_state(state, events, *where),
    ]
    return ShapeFacts(call, found, tuple(judged))
