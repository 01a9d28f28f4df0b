# SPDX-License-Identifier: GPL-2.0-or-later
"""Cuts that stay above the program's Z0, which is the top of the part as a rule."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from g12.tools.preview.moves import Move
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL


def judge_levels(cuts: Sequence[ProgramCut], moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the cuts of which nothing goes below Z0."""
    for cut in cuts:
        lowest = cut.lowest(moves)
        if cut.face is not None and lowest > cut.face - LEVEL:
            values = {"level": lowest - cut.face}
            yield Finding("above-zero", cut.line, values, moves[cut.at].end[:3], cut.file)
