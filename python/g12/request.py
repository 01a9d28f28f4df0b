# SPDX-License-Identifier: GPL-2.0-or-later
"""The input of a cycle: the words of its block, and the rules that the dialects share.

A dialect takes the words it knows, and any other is refused. Every rule about a single word lives
here, so that each refusal names the code, the word, the rule and the value in the same way. Counts
of rings, levels and turns are decided here once, never rounded again in NGC.

Lengths are in program units.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from math import hypot
from typing import NamedTuple

from g12.errors import Refusal, number
from g12.lengths import LARGEST
from g12.state import LINEAR_AXES, XY, XZ, YZ, SpacePoint, State, Tool, beyond_travel

WHOLE = 1e-4  # LinuxCNC's own tolerance for "close to an integer"


class Words:
    """The words of a block, to be taken one by one, and the state before it.

    ``code`` names the block in messages (``G12``), ``values`` maps upper-case letters to
    numbers as the parser gave them: program units, expressions already resolved; they stay
    ``given``. A number beyond any machine is refused at once.
    """

    positive_rule = "must be greater than 0"

    def __init__(self, code: str, values: dict[str, float], context: State) -> None:
        self.code, self.context, self.given = code, context, values
        self._remaining = dict(values)
        for letter, value in values.items():
            if not abs(value) <= LARGEST:
                raise self.refuse_word(letter, value, f"is beyond {number(LARGEST)}")

    def __contains__(self, letter: str) -> bool:
        """Return whether the word is in the block and not yet taken."""
        return letter in self._remaining

    def refuse(self, rule: str) -> Refusal:
        return Refusal(rule, self.code)

    def refuse_word(self, letter: str, value: float, rule: str) -> Refusal:
        """Return the refusal of a word and its value for breaking ``rule``."""
        return self.refuse(f"{self.written(letter, value)} {rule}")

    @staticmethod
    def written(letter: str, value: float) -> str:
        """Return a word as it is written in a program: ``I0.125``."""
        return f"{letter}{number(value)}"

    def value(self, letter: str) -> float | None:
        """Return the word's value without taking it, None if it is absent."""
        return self._remaining.get(letter)

    def take(self, letter: str) -> float | None:
        """Return the word's value, or None if the block does not have it."""
        return self._remaining.pop(letter, None)

    def require(self, letter: str, meaning: str) -> float:
        """Return the word's value; refuse a block without it."""
        self._check_present(letter, meaning)
        return self._remaining.pop(letter)

    def take_positive(self, letter: str) -> float | None:
        """Return the word's value, which must be above zero, or None."""
        return self._positive(letter) if letter in self._remaining else None

    def require_positive(self, letter: str, meaning: str) -> float:
        """Return the word's value, above zero; refuse a block without it."""
        self._check_present(letter, meaning)
        return self._positive(letter)

    def take_whole(self, letter: str, least: int, default: int = 0, most: int | None = None) -> int:
        """Return the word's value, a whole number from ``least`` (to ``most``), or the default."""
        return self._whole(letter, least, most) if letter in self._remaining else default

    def require_whole(self, letter: str, meaning: str, least: int, most: int) -> int:
        """Return the word's value, a whole number; refuse a block without it."""
        self._check_present(letter, meaning)
        return self._whole(letter, least, most)

    def _check_present(self, letter: str, meaning: str) -> None:
        if letter not in self._remaining:
            raise self.refuse(f"{letter} is missing: {meaning}")

    def _positive(self, letter: str) -> float:
        value = self._remaining.pop(letter)
        if not value > 0:
            raise self.refuse_word(letter, value, self.positive_rule)
        return value

    def _whole(self, letter: str, least: int, most: int | None) -> int:
        value = self._remaining.pop(letter)
        if abs(value - round(value)) > WHOLE:
            raise self.refuse_word(letter, value, "must be a whole number")
        if round(value) < least:
            raise self.refuse_word(letter, value, f"must be at least {least}")
        if most is not None and round(value) > most:
            raise self.refuse_word(letter, value, f"must be at most {most}")
        return round(value)

    def has_pair(self, first: str, second: str) -> bool:
        """Return whether two words are in the block; refuse one without the other."""
        if (first in self) != (second in self):
            present, absent = (first, second) if first in self else (second, first)
            raise self.refuse_word(present, self._remaining[present], f"needs {absent} as well")
        return first in self

    def take_pair(self, first: str, second: str) -> tuple[float, float] | None:
        """Return two positive words that need each other, or None if both are absent."""
        if not self.has_pair(first, second):
            return None
        return self._positive(first), self._positive(second)

    def check_known(self, known: str) -> None:
        """Refuse a word that the dialect does not have; ``known`` lists its letters."""
        for letter, value in self._remaining.items():
            if letter not in known:
                rule = f"is not a word of this cycle, which knows {known}"
                raise self.refuse_word(letter, value, rule)


CLEARED = 0.9  # of the cutter's radius: a helix or first ring up to this radius leaves no core
CLOCKWISE, COUNTERCLOCKWISE = 2, 3  # G codes of arcs
LEFT_OUT = -9999.0  # an entry of a call that is left out
WEAR = 0.05  # of a tool's radius: D may differ by that from the loaded tool
COUNTLESS = 1e9  # steps: more are not counted, as a huge quotient has no ceiling
MOST_CIRCLES = 100_000  # a Q typed a thousand times too small must not hang the preview


def check_modes(words: Words, planes: Collection[str] = (XY,)) -> None:
    """Refuse the modes in which no circle can be cut.

    In this order: another plane, G93, G95 without a spindle speed, G41/G42, a feed of 0.
    """
    context = words.context
    if context.plane not in planes:
        *others, last = planes
        needed = f"plane {', '.join(others)} or {last}" if others else f"the XY plane {last}"
        raise words.refuse(f"needs {needed}, but {context.plane} is active")
    if context.inverse_time:
        raise words.refuse("needs feed per minute or revolution (G94, G95), but G93 is active")
    if context.per_revolution and context.speed == 0:
        raise words.refuse("needs a spindle speed for feed per revolution (G95), but S is 0")
    if context.compensated:
        raise words.refuse("brings its own cutter compensation: program G40 first")
    if not context.feed > 0:
        raise words.refuse(f"F{number(context.feed)} must be greater than 0 (no feed commanded?)")


def check_start(words: Words) -> None:
    """Refuse to begin while the tool is still offset from the programmed point after a G40."""
    if words.context.offset_pending:
        raise words.refuse("the tool is still offset: after G40 move in X or Y first")


def commanded_tool(words: Words) -> Tool | None:
    """Return the tool that D names, None without D; D0 is a cutter without size."""
    if "D" not in words:
        return None
    tool_number = words.take_whole("D", least=0)
    if tool_number == 0:
        return Tool(0, 0.0)
    tool = words.context.tool_in_table(tool_number)
    if tool is None:
        raise words.refuse(f"D{tool_number} is not in the tool table")
    return tool


def sound_tool(words: Words, tool: Tool, source: str) -> Tool:
    """Return the tool; refuse a negative diameter. ``source`` names the tool: ``D1``."""
    if tool.radius < 0:
        raise words.refuse(
            f"{source} has the negative diameter {number(2 * tool.radius)} in the tool table"
        )
    return tool


def check_fits(
    words: Words,
    letter: str,
    radius: float,
    cutter: float,
    source: str,
    finish: tuple[float, str] = (0.0, ""),
) -> None:
    """Refuse a circle that the cutter, here its radius, cannot mill: its centre needs a ring.

    ``source`` names the cutter. A ``finish`` dimension has to fit too, which the text adds.
    """
    context, sized = words.context, " in size" if radius < 0 else ""
    room, least = abs(radius) - cutter - finish[0], number(context.smallest_ring)
    if room >= context.smallest_ring - context.rounding:
        return
    if not cutter:
        raise words.refuse_word(letter, radius, f"must be at least {least}{sized}")
    by = f" by at least {least}" if room > context.rounding else ""
    size = f"{context.tool_size(cutter)} ({source}){finish[1]}{by}"
    raise words.refuse_word(letter, radius, f"must be greater{sized} than the tool radius {size}")


def loaded_tool(words: Words) -> Tool:
    """Return the tool in the spindle, which must have a diameter."""
    tool = words.context.spindle_tool
    if tool is None:
        raise words.refuse("no tool is loaded: its diameter sets the path")
    if tool.radius <= 0:
        raise words.refuse(
            f"T{tool.number} in the spindle needs a diameter above 0 in the tool table,"
            f" not {number(2 * tool.radius)}"
        )
    return tool


def other_cutter(words: Words, last: Tool | None = None) -> str | None:
    """Return the operator message where D is not the loaded tool by more than wear, or None.

    The cycle uses D: the loaded tool may be the mistake. Without D the ``last`` one counts. There
    is no comparison without a tool, or with one without a diameter.
    """
    d_word, context = words.value("D"), words.context
    named = context.tool_in_table(round(d_word)) if d_word else None
    counting = named or (last if d_word is None else None)
    loaded = context.spindle_tool
    if not counting or not counting.radius or loaded is None or loaded.radius <= 0:
        return None
    radius = counting.radius
    if abs(radius - loaded.radius) <= WEAR * loaded.radius:
        return None
    source = f"D{named.number}" if named else "the D last commanded"
    size, loaded_size = (context.tool_size(2 * size) for size in (radius, loaded.radius))
    used = f"the cycle uses {source}, diameter {size}"
    return f"{words.code}: {used}; the loaded tool T{loaded.number} has {loaded_size}"


def check_count(words: Words, circles: int, cause: str) -> None:
    """Refuse steps so small that the block would never end; ``cause`` names their words."""
    if circles > MOST_CIRCLES:
        raise words.refuse(f"{cause} {circles} circles, the most is {MOST_CIRCLES}")


def steps_between(first: float, last: float, step: float, tolerance: float) -> int:
    """Return how many steps, none longer than ``step``, lead from ``first`` to ``last``.

    A remainder shorter than ``tolerance`` is rounding, not a step of its own.
    """
    return math.ceil(max(0.0, min((last - first - tolerance) / step, COUNTLESS)))


_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
DIRECTIONS = {XY: (_X, _Y), XZ: (_Z, _X), YZ: (_Y, _Z)}  # a plane's axes


class CycleExtent(NamedTuple):
    """The largest circle that a cycle's tool centre follows, in program coordinates and units.

    ``heights`` are the other Z levels of the cycle. A rectangle's circle is that of its corners,
    whose centres are as far as ``corners`` from its own.
    """

    plane: str
    centre: SpacePoint
    radius: float
    heights: tuple[float, ...] = ()
    corners: tuple[float, float] = (0.0, 0.0)

    def points(self) -> list[SpacePoint]:
        x, y, z = self.centre
        return [(x, y, height) for height in self.heights or (z,)]


def check_travel(words: Words, extent: CycleExtent, limits: Mapping[str, Sequence[float]]) -> None:
    """Refuse a cycle that leaves the limits of an axis, its lowest and highest machine position."""
    state = words.context
    centres = zip(*map(state.point_on_machine, extent.points()))
    beyond = beyond_travel(
        state,
        limits,
        [
            (axis, min(centre) - half, max(centre) + half)
            for axis, centre, half in zip(LINEAR_AXES, centres, half_widths(state, extent))
        ],
    )
    if beyond:
        raise words.refuse(beyond.rule)


def half_widths(state: State, extent: CycleExtent) -> list[float]:
    """Return the path's extent from its centre along each axis, in machine units."""
    first, second = (state.turned(*axis) for axis in DIRECTIONS[extent.plane])
    along, across = extent.corners
    return [
        (extent.radius * hypot(one, two) + abs(one * along) + abs(two * across))
        / state.machine_unit
        for one, two in zip(first, second)
    ]
