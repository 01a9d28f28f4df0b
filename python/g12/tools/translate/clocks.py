# SPDX-License-Identifier: GPL-2.0-or-later
"""The control's clocks, which LinuxCNC lacks: what only keeps times is a comment.

Many programs note how long a cycle took. A variable that a clock gives a value, or another such
variable, may stand in assignments of its kind alone; where it decides or moves, it is refused.
"""

from collections.abc import Sequence

from g12.tools.translate.blocks.expressions import CLOCK
from g12.tools.translate.blocks.lexer import ForeignBlock


def without_clocks(blocks: Sequence[ForeignBlock]) -> list[ForeignBlock]:
    """Return the blocks with times as comments."""
    timed, known = {CLOCK}, 0
    while len(timed) > known:
        known = len(timed)
        timed.update(b.variable for b in blocks if b.kind == "assign" and timed & reads(b))
    return [_without_time(block, timed) for block in blocks]


def reads(block: ForeignBlock) -> set[int]:
    """Return the variables that a block reads."""
    read = {number for word in block.words for number in word.read}
    return read | block.expression.read if block.expression else read


def _without_time(block: ForeignBlock, timed: set[int]) -> ForeignBlock:
    """Return a block: a time is a comment, what hangs on one is refused."""
    if block.kind == "assign" and block.variable in timed:
        comments = ("a time: LinuxCNC has no clock", *block.comments)
        return block._replace(kind="words", variable=0, expression=None, comments=comments)
    if timed & reads(block):
        problem = "what stands here comes of the control's clock, which LinuxCNC lacks: take it out"
        return block._replace(problem=block.problem or problem)
    return block
