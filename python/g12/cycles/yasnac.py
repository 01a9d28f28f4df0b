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

Rules, in the order of the checks: the modes and words of `check_block`; I required; R or J, not
both; K and Q together, Q above 0; L whole, from 1; D whole, from 0, in the tool table; no negative
diameter; I not 0, beyond the tool radius; R - d from 0 to less than I - d; K - d between R - d and
I - d; each of them apart by an arc that can be cut; not too many circles.
"""

from math import copysign
from typing import NamedTuple

from g12.cut_report import NO_CUTTER, PocketCut, UsedCutter
from g12.cycles.plan import CyclePlan
from g12.errors import Refusal, number
from g12.request import Cutter, Words, steps_between
from g12.settings import Settings
from g12.state import XY

YASNAC_WORDS = "I R (or J) K Q L D F"
WITHOUT_D = Cutter(UsedCutter(0.0, NO_CUTTER), "D0", None)


class OffsetRadii(NamedTuple):
    """Tool-centre positions along X of a block's radii: each less the tool radius, sign of I."""

    words: Words
    finished: float  # I
    radius: float  # of the tool
    cutter: str  # for messages

    def position(self, word: float) -> float:
        """Return the tool-centre position; exactly 0 if it differs from the centre by rounding."""
        position = word - copysign(self.radius, self.finished)
        return position if abs(position) > self.words.context.rounding else 0.0

    @property
    def last(self) -> float:
        """The position on the finished circle."""
        return self.position(self.finished)

    @property
    def source(self) -> str:
        return f"where I{number(self.finished)} puts it"

    def refuse(self, letter: str, word: float, rule: str) -> Refusal:
        """Return the refusal of a word whose position breaks ``rule`` (the caller raises it)."""
        position = f"X{number(self.position(word))} from the circle's centre ({self.cutter})"
        return self.words.refuse_word(letter, word, f"puts the tool centre at {position}: {rule}")

    def check_apart(self, letter: str, word: float, other: float, source: str) -> None:
        """Refuse a word whose position is nearer to another than the smallest arc."""
        apart, context = abs(self.position(word) - other), self.words.context
        if apart < context.smallest_ring - context.rounding:
            needed = f"the smallest arc needs {number(context.smallest_ring)}"
            rule = f"only {number(apart)} from X{number(other)}, {source}; {needed}"
            raise self.refuse(letter, word, rule)


def plan(words: Words, arc: int, settings: Settings) -> CyclePlan:
    context = words.context
    words.check_block(YASNAC_WORDS)
    finished = words.require("I", "the radius of the finished circle")
    if "R" in words and "J" in words:
        raise words.refuse("R and J are the same word: give one of them")
    letter = "R" if "R" in words else "J"
    traverse = words.take(letter)
    words.check_pair("K", "Q")
    start, pitch = words.take("K"), words.take_positive("Q")
    circles = words.take_whole("L", least=1, default=1)
    cutter = words.offset_cutter() or WITHOUT_D
    words.check_sound(cutter.radius, cutter.source)
    words.check_fits("I", finished, cutter.radius, cutter.source)
    size = f"tool radius {context.tool_size(cutter.radius)}, {cutter.source}"
    radii = OffsetRadii(words, finished, cutter.radius, size if cutter.used.number else "no D")
    approach = 0.0 if traverse is None else approach_of(radii, letter, traverse)
    spiral = None if start is None or pitch is None else (start, pitch)
    turns = half_turns_of(radii, spiral, approach)
    words.check_count(round(turns["half_turns"]) + circles, "K, Q and L make")
    numbers = {
        "x": context.x,
        "y": context.y,
        "approach": approach,
        "radius": radii.last,
        "circles": circles,
        "arc": arc,
        "traverse": settings.yasnac_traverse * context.machine_unit,
        "feed": context.feed,
        "per_revolution": context.per_revolution,
        **turns,
    }
    words.check_travel(context.xyz, abs(radii.last))
    first, growth = abs(turns["first"]), 2 * abs(turns["growth"])  # of a whole turn
    cut = PocketCut(
        plane=XY,
        centre=context.xyz,
        wall=abs(finished),
        first=first + cutter.radius,
        step=pitch or 0.0,
        inner=first + growth - cutter.radius,
        levels=(context.z,),
        cutter=cutter.used,
    )
    return CyclePlan(numbers, cut, cutter)


def approach_of(radii: OffsetRadii, letter: str, traverse: float) -> float:
    """Return the end of the fast move, which R commands."""
    approach = radii.position(traverse)
    if not 0.0 <= approach / radii.last < 1.0:
        rule = f"it must be from 0 to less than X{number(radii.last)}, {radii.source}"
        raise radii.refuse(letter, traverse, rule)
    radii.check_apart(letter, traverse, radii.last, radii.source)
    return approach


def half_turns_of(
    radii: OffsetRadii, spiral: tuple[float, float] | None, approach: float
) -> dict[str, float]:
    """Return the locals of the spiral's half turns, by K and Q.

    Whole turns only, so that the finished circle begins on the side of I. The last turn grows by
    the remainder.
    """
    last, source = radii.last, radii.source
    if spiral is None:
        return {"first": last, "half_turns": 0, "growth": 0.0, "shrink": 0.0}
    first, pitch = radii.position(spiral[0]), spiral[1]
    if not approach / last < first / last < 1.0:
        bounds = f"between X{number(approach)} and X{number(last)}, {source}"
        raise radii.refuse("K", spiral[0], f"it must be {bounds}")
    radii.check_apart("K", spiral[0], approach, "where the cut begins")
    radii.check_apart("K", spiral[0], last, source)
    turns = steps_between(abs(first), abs(last), pitch, radii.words.context.rounding)
    rest = abs(last) - abs(first) - pitch * (turns - 1)
    growth = copysign(pitch if turns > 1 else rest, last) / 2
    return {
        "first": first,
        "half_turns": 2 * turns,
        "growth": growth,
        "shrink": 1 - rest / pitch,
    }
