# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves to draw of a refused program, with the refused contour."""

from dataclasses import replace
from itertools import takewhile
from pathlib import Path

from g12.tools.machine.ini import Ini
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import Parameters, trace


def with_refused_contour(program: Path, ini: Ini, refused: Trace, parameters: Parameters) -> Trace:
    """Return a refused program's trace with the contour of its section, up to the refused line.

    With a cutter of diameter 0 the path is the programmed contour, and no corner is too tight.
    """
    tools = dict.fromkeys(refused.diameters, 0.0)
    contour = trace(program, ini.path, tools=tools, parameters=parameters).moves
    section = section_up_to(refused.error.line, contour)
    lines = [move._replace(tool=0) for move in section]  # cutters without a swept area
    return replace(refused, moves=[*refused.moves, *lines])


def section_up_to(line: int, moves: list[Move]) -> list[Move]:
    """Return the moves of the section with a line, up to that line's first execution."""
    at = next((k for k, move in enumerate(moves) if move.remap and move.block == line), None)
    if at is None:
        return []
    before = list(takewhile(lambda move: move.remap == moves[at].remap, moves[at::-1]))
    after = list(takewhile(lambda move: move.block == line, moves[at + 1 :]))
    return [*before[::-1], *after]
