# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 circle cutting, dialect yasnac: words and modes in, one checked circle out.

Source: Yasnac instructions, 2.9.9 "Circle Cutting (G12, G13)". Its page states I, R, D, F and
their rules; K and Q (a spiral), L (repeats) and J (another letter for R) are our reading.

The motions of `ngc/g12_yasnac.ngc`, at the present Z, from the tool's position, which is the
centre:

1. fast along X to ``approach`` (R; without R the tool stays in the centre)
2. half circle to ``first``, in the direction of the cut
3. with K and Q: half circles outward that grow to the finished circle in whole turns
4. the finished circle, L times
5. half circle back to ``approach``
6. fast back to the centre

All of it lies on the side of X that I's sign picks: I-50 is I50 turned by 180 degrees.
With d = the tool radius, signed like I, R - d and K - d and I - d are tool-centre positions.

Rules, in the order of the checks: G17 and the modes of `check_modes`; every word known;
`check_start`; I required; R or J, not both; K and Q together, Q above 0; L whole, from 1; D whole,
from 0, in the tool table; no negative diameter; I not 0, beyond the tool radius; R - d from 0 to
less than I - d; K - d between R - d and I - d; each of them apart by an arc that can be cut; not
too many circles.
"""

from math import copysign
from typing import NamedTuple

from g12.errors import BlockRefusal, number
from g12.lengths import ROUNDING_MM
from g12.request.common import (
    SMALLEST_RING_MM,
    check_count,
    check_modes,
    check_start,
    commanded_tool,
    sound_tool,
    steps_between,
)
from g12.request.context import XY, Context, Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words

YASNAC_WORDS = "I R (or J) K Q L D F"


class YasnacCircle(NamedTuple):
    """A checked circle: the named locals of `ngc/g12_yasnac.ngc`.

    Lengths in program units; ``approach``, ``first``, ``growth`` and ``radius`` are those of the
    tool centre along X, with the sign of I.
    """

    x: float
    y: float
    approach: float
    first: float
    half_turns: int
    growth: float  # of the first half turn
    shrink: float  # relative reduction of that in the half turns of the last turn
    radius: float
    circles: int

    def extent(self, z: float) -> CycleExtent:
        return CycleExtent(XY, (self.x, self.y, z), abs(self.radius))


class OffsetRadii(NamedTuple):
    """Tool-centre positions along X of a block's radii: each less the tool radius, sign of I."""

    words: Words
    offset: float
    cutter: str  # for messages
    rounding: float
    smallest: float

    def position(self, word: float) -> float:
        """Return the tool-centre position; exactly 0 if it differs from the centre by rounding."""
        position = word - self.offset
        return position if abs(position) > self.rounding else 0.0

    def refuse(self, letter: str, word: float, rule: str) -> BlockRefusal:
        """Return the refusal of a word whose position breaks ``rule`` (the caller raises it)."""
        position = number(self.position(word))
        return self.words.refuse(
            f"{letter}{number(word)} puts the tool centre at X{position} from the circle's centre"
            f" ({self.cutter}): {rule}"
        )

    def check_apart(self, letter: str, word: float, other: float, source: str) -> None:
        """Refuse a word whose position is nearer to another than the smallest arc."""
        apart = abs(self.position(word) - other)
        if apart < self.smallest - self.rounding:
            raise self.refuse(
                letter,
                word,
                f"only {number(apart)} from X{number(other)}, {source};"
                f" the smallest arc needs {number(self.smallest)}",
            )


def plan_circle(words: Words, context: Context) -> YasnacCircle:
    check_modes(words, context)
    words.check_known(YASNAC_WORDS)
    check_start(words, context)
    finished = words.require("I", "the radius of the finished circle")
    traverse = take_traverse(words)
    spiral = take_spiral(words)
    circles = words.take_whole("L", least=1, default=1)
    tool = commanded_tool(words, context) or Tool(0, 0.0)
    radii = offset_radii(words, context, finished, sound_tool(words, tool, f"D{tool.number}"))

    radius = radii.position(finished)
    approach = approach_of(radii, traverse, finished)
    first, half_turns, growth, shrink = half_turns_of(radii, spiral, approach, finished)
    check_count(words, half_turns + circles, "K, Q and L make")
    return YasnacCircle(
        context.x, context.y, approach, first, half_turns, growth, shrink, radius, circles
    )


def take_traverse(words: Words) -> tuple[str, float] | None:
    if "R" in words and "J" in words:
        raise words.refuse("R and J are the same word: give one of them")
    letter = "R" if "R" in words else "J"
    value = words.take(letter)
    return None if value is None else (letter, value)


def take_spiral(words: Words) -> tuple[float, float] | None:
    """Return K, signed, and Q, above zero."""
    words.has_pair("K", "Q")
    first, pitch = words.take("K"), words.take_positive("Q")
    return None if first is None or pitch is None else (first, pitch)


def offset_radii(words: Words, context: Context, finished: float, tool: Tool) -> OffsetRadii:
    """Return the radii of a block; refuse a finished circle that the cutter cannot mill."""
    size = context.tool_size(tool.radius)
    cutter = f"tool radius {size}, D{tool.number}" if tool.number else "no D"
    smallest = context.length(SMALLEST_RING_MM)
    room = abs(finished) - tool.radius
    if abs(finished) < smallest:
        raise words.refuse(f"I{number(finished)} must not be 0")
    if room < smallest:
        raise words.refuse(
            f"I{number(finished)} must exceed the tool radius {size} (D{tool.number}) in size"
        )
    offset = copysign(tool.radius, finished)
    return OffsetRadii(words, offset, cutter, context.length(ROUNDING_MM), smallest)


def approach_of(radii: OffsetRadii, traverse: tuple[str, float] | None, finished: float) -> float:
    """Return the end of the fast move, 0 without R."""
    if traverse is None:
        return 0.0
    last, approach = radii.position(finished), radii.position(traverse[1])
    source = f"where I{number(finished)} puts it"
    if not 0.0 <= approach / last < 1.0:
        raise radii.refuse(*traverse, f"it must be from 0 to less than X{number(last)}, {source}")
    radii.check_apart(*traverse, last, source)
    return approach


def half_turns_of(
    radii: OffsetRadii, spiral: tuple[float, float] | None, approach: float, finished: float
) -> tuple[float, int, float, float]:
    """Return first radius, number, growth and shrink of the spiral's half turns.

    Whole turns only, so that the finished circle begins on the side of I. The last turn grows by
    the remainder.
    """
    last = radii.position(finished)
    if spiral is None:
        return last, 0, 0.0, 0.0
    first, pitch = radii.position(spiral[0]), spiral[1]
    source = f"where I{number(finished)} puts it"
    if not approach / last < first / last < 1.0:
        bounds = f"between X{number(approach)} and X{number(last)}, {source}"
        raise radii.refuse("K", spiral[0], f"it must be {bounds}")
    radii.check_apart("K", spiral[0], approach, "where the cut begins")
    radii.check_apart("K", spiral[0], last, source)
    turns = steps_between(abs(first), abs(last), pitch, radii.rounding)
    rest = abs(last) - abs(first) - pitch * (turns - 1)
    growth = copysign(pitch if turns > 1 else rest, last) / 2
    return first, 2 * turns, growth, 1 - rest / pitch
