# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a Haas G12 or G13 block, by ngc/haas.md.

Radii are those of the tool's centre in mm, depths are measured from the tool before the block.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Self

from g12.tools.machine.ini import Ini
from g12.tools.verify.expected.toolpath import CircleWords, Expected, Writer, core_within
from g12.tools.verify.expected.words import BlockInMm

CLEARED = 0.9  # of the cutter's radius: the helix is not larger
LEAST_CORNER = math.radians(0.99)  # between two half turns of the helix
ROUNDING = 1e-6  # mm


@dataclass(frozen=True)
class HaasWords(CircleWords):
    """A block's words: the tool's position from the centre, the radii of the rings, the depths.

    ``depths`` has one for each pass. ``pitch`` is what a spiral grows by in a turn, 0 for rings.
    ``turn`` is +1 counterclockwise, -1 clockwise. ``helix`` is its radius, 0 for a plunge, and
    ``angle`` the greatest at which it falls, radians.
    """

    start: complex
    rings: Sequence[float]
    depths: Sequence[float]
    turn: int
    feed: float | None
    plunge_feed: float | None
    pitch: float = 0.0
    helix: float = 0.0
    angle: float = 0.0
    word: str = ""

    @classmethod
    def of(cls, view: BlockInMm, turn: int, offset: float, ini: Ini) -> Self:
        """Return the words of a block; ``offset`` is the radius in force."""
        word, step, feed = "K" if "K" in view.words else "I", view.length("Q"), view.feed()
        first, last = view.length("I") - offset, view.length(word) - offset
        settings = ini.settings
        is_spiral = settings.clearing == "spiral"
        helix = 0.0
        if settings.entry == "helix":
            helix = min(first, CLEARED * offset) if offset else first
        return cls(
            view.from_centre(),
            [first, last] if is_spiral and step else rings_between(first, last, step),
            _pass_depths(view),
            turn,
            feed,
            None if feed is None else feed * settings.plunge_feed / 100,
            step if is_spiral else 0.0,
            helix,
            math.radians(settings.entry_angle),
            "" if offset else word,
            line=view.line,
            per_rev=view.per_rev,
        )

    @property
    def final(self) -> float:
        return self.rings[-1]

    def cleared(self, cutter: float) -> float:
        """Return the radius within which material may remain: with one ring only."""
        if len(self.rings) > 1:
            return 0.0
        goes_down = min(self.depths) < 0.0 and self.helix < self.final
        return core_within(self.final, cutter, self.helix if goes_down else 0.0)

    @property
    def stepover(self) -> float | None:
        """Return the greatest distance between neighbouring passes, None with one ring."""
        apart = [outer - inner for inner, outer in zip(self.rings, self.rings[1:])]
        most = max(apart, default=None)
        return min(self.pitch, most) if self.pitch and most else most

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: to the centre, then each pass from there and back."""
        writer = self.writer(self.start)
        writer.straight("rapid to the centre", 0j, rapid=True)
        ahead = 1 + 0j  # the direction of the lead-in
        for above, depth in zip((0.0, *self.depths), self.depths):
            by_helix = self.helix > 0.0 and depth < above - ROUNDING
            is_repeat = abs(depth - above) <= ROUNDING
            ahead = ahead if by_helix or is_repeat else 1 + 0j
            ahead = self._pass(writer, ahead, depth, by_helix)
        return writer.path

    def _pass(self, writer: Writer, ahead: complex, depth: float, by_helix: bool) -> complex:
        """Write one pass; return the direction in which its last ring ended."""
        first = self.rings[0]
        if by_helix:
            ahead = self._down_along_helix(writer, ahead, depth)
        else:
            writer.vertical("plunge", depth, self.plunge_feed)
            writer.arc("lead-in", ahead * first / 2, self._half, self.feed)
            writer.arc("ring", 0j, 2 * self._half, self.feed)
        if len(self.rings) > 1:
            ahead = (self._spiral if self.pitch else self._links)(writer, ahead)
        writer.arc("lead-out", writer.at / 2, self._half, self.feed)
        return ahead

    @property
    def _half(self) -> float:
        """The sweep of half a turn."""
        return self.turn * math.pi

    def _down_along_helix(self, writer: Writer, ahead: complex, depth: float) -> complex:
        writer.arc("lead-in", ahead * self.helix / 2, self._half, self.feed)
        for fall in falls_of(writer.level - depth, self.helix, self.angle):
            writer.arc("helix", 0j, self._half, self.plunge_feed, fall)
        writer.arc("ring", 0j, 2 * self._half, self.feed)
        first = self.rings[0]
        if first <= self.helix:
            return ahead
        writer.arc("stepover", ahead * (self.helix - first) / 2, self._half, self.feed)
        writer.arc("ring", 0j, 2 * self._half, self.feed)
        return -ahead

    def _links(self, writer: Writer, ahead: complex) -> complex:
        """Write the further rings: straight on by the stepover, a quarter turn, the ring."""
        for inner, outer in zip(self.rings, self.rings[1:]):
            onward = ahead * 1j * self.turn * (outer - inner)
            writer.straight("stepover", writer.at + onward, self.feed)
            writer.arc("stepover", onward, self._half / 2, self.feed)
            ahead *= 1j * self.turn
            writer.arc("ring", 0j, 2 * self._half, self.feed)
        return ahead

    def _spiral(self, writer: Writer, ahead: complex) -> complex:
        """Write half turns that grow by half the pitch, and the last ring."""
        for radius, larger in _half_turns(self.rings[0], self.rings[-1], self.pitch):
            writer.arc("spiral", ahead * (radius - larger) / 2, self._half, self.feed)
            ahead = -ahead
        writer.arc("ring", 0j, 2 * self._half, self.feed)
        return ahead


def _half_turns(first: float, last: float, pitch: float) -> Iterator[tuple[float, float]]:
    """Yield the radii at both ends of each half turn of a spiral."""
    radius = first
    while radius < last - ROUNDING:
        larger = radius + pitch / 2
        larger = last if larger > last - ROUNDING else larger
        yield radius, larger
        radius = larger


def falls_of(height: float, radius: float, angle: float) -> list[float]:
    """Return by how much each half turn of a helix falls.

    As many as are needed and an even number; the last of them lose their slope in equal steps.
    """
    easing = math.ceil(angle / LEAST_CORNER)
    shares = [step / easing for step in range(easing - 1, 0, -1)]
    most = math.pi * radius * math.tan(angle)
    steep = max(1, math.ceil(height / most - sum(shares)))
    steep += (steep + len(shares)) % 2
    fall = height / (steep + sum(shares))
    return [fall] * steep + [fall * share for share in shares]


def rings_between(first: float, last: float, step: float) -> list[float]:
    """Return the radii of rings that grow by a step; the last step may be shorter."""
    count = math.ceil((last - first - ROUNDING) / step) if last > first + ROUNDING else 0
    return [first + index * step for index in range(count)] + [last]


def _pass_depths(view: BlockInMm) -> list[float]:
    return [view.depth(count + 1) for count in range(int(view.words.get("L", 1)))]
