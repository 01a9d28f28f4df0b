# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the tool length in force is that of the loaded tool.

LinuxCNC believes G43's H as the cycles believe D. A program that never commands G43 may have
touched off Z with its tool, and so may one that cancels it by G49 after the tool change; any other
works with the lengths of the table.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from g12.tools.path.part import Z
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import SIZE


def judge_tool_length(
    cuts: Sequence[ProgramCut],
    moves: Sequence[Move],
    lengths: Mapping[int, float],
    events: Sequence[Event],
) -> Iterator[Finding]:
    """Yield where a cut is made with another length than the loaded tool's; ``lengths`` in mm."""
    compensated = any(abs(move.tool_offset[Z]) > SIZE for move in moves)
    reported: set[tuple[int, float]] = set()
    for cut in cuts:
        first = moves[cut.at]
        expected = compensated and last_of(events, cut.at) != "G49"
        deeper = lengths.get(first.tool, 0.0) - first.tool_offset[Z]
        if abs(deeper) < SIZE or (first.tool, deeper) in reported:
            continue
        reported.add((first.tool, deeper))
        values = {"tool": first.tool, "length": first.tool_offset[Z], "off": abs(deeper)}
        yield Finding(_code_of(deeper, expected), cut.line, values, file=cut.file)


def last_of(events: Sequence[Event], before: int) -> str:
    """Return the last tool change, G43 or G49 in front of a move, "" without one."""
    texts = (event.text for event in reversed(events) if event.at <= before)
    return next((text for text in texts if text.startswith(("tool ", "G43", "G49"))), "")


def _code_of(deeper: float, expected: bool) -> str:
    """Return the code of a length that is off; ``expected``: the words ask for the table's."""
    if not expected:
        return "length-not-used"
    return "length-deeper" if deeper > 0.0 else "length-higher"
