# SPDX-License-Identifier: GPL-2.0-or-later
"""C's clamp in a call of holes: closed in every hole, open whenever C turns and after the call."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import NamedTuple

from g12.tools.preview.executed_blocks import CLAMP, Block
from g12.tools.verify.compare.path import Laid
from g12.tools.verify.expected.holes import Holes
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding


class Clamp(NamedTuple):
    """The M codes that close and open the clamp, if any; ``seen``: events tell of them."""

    codes: Sequence[str]
    seen: bool


def judge_clamp(
    holes: Holes, expected: Sequence[Expected], laid: Laid, block: Block, clamp: Clamp
) -> Iterator[Finding]:
    """Yield the first move of each kind in which the clamp is otherwise, or that it stays so.

    Also that it was not judged, where there are codes of which no event tells.
    """
    if not clamp.codes:
        return
    (close, opens), call = clamp.codes, holes.call
    if not clamp.seen:
        yield Finding("clamp-unseen", call.line, {"codes": f"{close} and {opens}"}, file=call.file)
        return
    for closed, name, code in ((True, "clamp-open", close), (False, "clamp-closed", opens)):
        wrong = (
            move.name
            for move, made in zip(expected, laid.moves)
            if holes.clamped(move) is closed and any(in_force(block, at) != code for at in made)
        )
        for what in islice(wrong, 1):
            yield Finding(name, call.line, {"what": what, "code": code}, file=call.file)
    if in_force(block, block.end) != opens:
        yield Finding("clamp-left", call.line, {"code": opens}, file=call.file)


def in_force(block: Block, index: int) -> str:
    """Return the clamp's code that came last in a block before a move, "" before the first."""
    texts = [each.text for each in block.own_events if each.at <= index]
    codes = [text.split()[1] for text in texts if text.startswith(f"{CLAMP} ")]
    return codes[-1] if codes else ""
