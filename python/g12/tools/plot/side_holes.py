# SPDX-License-Identifier: GPL-2.0-or-later
"""The surface drilled by `o<side_holes> call`, drawn as an unrolled cylinder."""

from __future__ import annotations

from collections.abc import Sequence

from g12.lengths import MM_PER_INCH
from g12.tools.path.part import C, X, Z
from g12.tools.preview.executed_blocks import executed
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.subject import Subject

SUB, DIAMETER = "side_holes", 4  # the entry of the call


def drilled_surface(subject: Subject, tools: Tools = None, parameters: Parameters = None) -> float:
    """Return the radius, mm, of the surface of a program that drills only its side, else 0."""
    if not only_radial(subject.trace.moves):
        return 0.0
    with Tracer(subject.ini, tools=tools) as tracer:
        blocks = executed(
            tracer, subject.program, subject.trace, lambda text: text.call == SUB, parameters
        )
    for block in blocks:
        if len(block.arguments) > DIAMETER:
            unit = 1.0 if block.state["_metric"] else MM_PER_INCH
            return block.arguments[DIAMETER] / 2 * unit
    return 0.0


def only_radial(moves: Sequence[Move]) -> bool:
    """Return whether every move at feed is along X alone."""
    feeds = [move for move in moves if move.kind == "feed"]
    still = all(move.start[axis] == move.end[axis] for move in feeds for axis in (Z, C))
    return still and any(move.start[X] != move.end[X] for move in feeds)
