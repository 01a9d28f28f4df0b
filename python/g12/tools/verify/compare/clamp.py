# SPDX-License-Identifier: GPL-2.0-or-later
"""C's clamp in a call of holes: closed in every hole, open whenever C turns and after the call."""

from __future__ import annotations

from bisect import bisect
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
    at, told = clamp_events(block)
    for closed, name, code in ((True, "clamp-open", close), (False, "clamp-closed", opens)):
        wrong = (
            move.name
            for move, made in zip(expected, laid.moves)
            if holes.clamped(move) is closed
            and any(told[bisect(at, index)] != code for index in made)
        )
        for what in islice(wrong, 1):
            yield Finding(name, call.line, {"what": what, "code": code}, file=call.file)
    if told[-1] != opens:
        yield Finding("clamp-left", call.line, {"code": opens}, file=call.file)


def clamp_events(block: Block) -> tuple[list[int], list[str]]:
    """Return before which moves of a block a code of the clamp came, and the codes.

    The codes begin with that before the first, "": the one in force at a move is `bisect`'s.
    """
    events = [each for each in block.own_events if each.text.startswith(f"{CLAMP} ")]
    return [each.at for each in events], ["", *(each.text.split()[1] for each in events)]
