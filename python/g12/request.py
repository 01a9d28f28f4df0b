# SPDX-License-Identifier: GPL-2.0-or-later
"""The input of a cycle: the words of its block, and the rules that the dialects share.

A dialect takes the words it knows, and any other is refused. Every rule about a single word lives
here, so that each refusal names the code, the word, the rule and the value in the same way. Counts
of rings, levels and turns are decided here once, never rounded again in NGC.

Lengths are in program units.
"""

import math
from collections.abc import Collection, Sequence
from math import hypot
from typing import NamedTuple

from g12.cut_report import BY_D, BY_LAST_D, LOADED, UsedCutter
from g12.errors import Refusal, number
from g12.lengths import LARGEST
from g12.state import LINEAR_AXES, XY, XZ, YZ, SpacePoint, State, Tool, beyond_travel, refused_mode

WHOLE = 1e-4  # LinuxCNC's own tolerance for "close to an integer"
CLEARED = 0.9  # of the cutter's radius: a helix or first ring up to this radius leaves no core
CLOCKWISE, COUNTERCLOCKWISE = 2, 3  # G codes of arcs
LEFT_OUT = -9999.0  # an entry of a call that is left out
WEAR = 0.05  # of a tool's radius: D may differ by that from the loaded tool
COUNTLESS = 1e9  # steps: more are not counted, as a huge quotient has no ceiling
MOST_CIRCLES = 100_000  # a Q typed a thousand times too small must not hang the preview


class Cutter(NamedTuple):
    """The cutter of a block, its name in messages, and what the operator hears of it.

    ``other``: it is not the loaded tool. ``kept``: the program does not show it. ``is_modal``: it
    counts in later blocks without D.
    """

    used: UsedCutter
    source: str
    other: str | None
    kept: str | None = None
    is_modal: bool = False

    @property
    def radius(self) -> float:
        return self.used.radius


_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
DIRECTIONS = {XY: (_X, _Y), XZ: (_Z, _X), YZ: (_Y, _Z)}  # a plane's axes


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

    def take(self, letter: str) -> float | None:
        """Return the word's value, or None if the block does not have it."""
        return self._remaining.pop(letter, None)

    def require(self, letter: str, meaning: str) -> float:
        """Return the word's value; refuse a block without it."""
        if letter not in self._remaining:
            raise self.refuse(f"{letter} is missing: {meaning}")
        return self._remaining.pop(letter)

    def take_positive(self, letter: str) -> float | None:
        """Return the word's value, which must be above zero, or None."""
        return self.require_positive(letter, "") if letter in self else None

    def require_positive(self, letter: str, meaning: str) -> float:
        """Return the word's value, above zero; refuse a block without it."""
        value = self.require(letter, meaning)
        if not value > 0:
            raise self.refuse_word(letter, value, self.positive_rule)
        return value

    def take_whole(self, letter: str, least: int, default: int = 0, most: float = math.inf) -> int:
        """Return the word's value, a whole number from ``least`` (to ``most``), or the default."""
        return self.require_whole(letter, "", least, most) if letter in self else default

    def require_whole(self, letter: str, meaning: str, least: int, most: float) -> int:
        """Return the word's value, a whole number; refuse a block without it."""
        value = self.require(letter, meaning)
        whole = round(value)
        if abs(value - whole) > WHOLE:
            raise self.refuse_word(letter, value, "must be a whole number")
        if whole < least:
            raise self.refuse_word(letter, value, f"must be at least {least}")
        if whole > most:
            raise self.refuse_word(letter, value, f"must be at most {most}")
        return whole

    def check_least(self, letter: str, value: float, least: float) -> None:
        if value < least:
            raise self.refuse_word(letter, value, f"must be at least {number(least)}")

    def check_pair(self, first: str, second: str) -> None:
        """Refuse one of two words without the other."""
        for present, absent in ((first, second), (second, first)):
            if present in self and absent not in self:
                value = self._remaining[present]
                raise self.refuse_word(present, value, f"needs {absent} as well")

    def check_known(self, known: str) -> None:
        """Refuse a word that the dialect does not have; ``known`` lists its letters."""
        for letter, value in self._remaining.items():
            if letter not in known:
                rule = f"is not a word of this cycle, which knows {known}"
                raise self.refuse_word(letter, value, rule)

    def absolute(self, word: float | None, present: float) -> float:
        """Return the absolute coordinate of a word in G90 or G91; without it, the present one."""
        if word is None:
            return present
        return present + word if self.context.incremental else word

    def take_centre(self) -> tuple[float, float]:
        """Return X and Y, the present ones where the block does not have them."""
        x, y, context = self.take("X"), self.take("Y"), self.context
        return self.absolute(x, context.x), self.absolute(y, context.y)

    def check_block(self, known: str, planes: Collection[str] = (XY,)) -> None:
        """Refuse the modes in which no circle can be cut, and a word that the dialect lacks.

        In this order: another plane, the modes that all codes refuse (a tool that is still offset
        may be moved by X or Y), G95 without a spindle speed, a feed of 0; the words.
        """
        context = self.context
        if context.plane not in planes:
            *others, last = planes
            needed = f"plane {', '.join(others)} or {last}" if others else f"the XY plane {last}"
            raise self.refuse(f"needs {needed}, but {context.plane} is active")
        wrong = refused_mode(context, moves_first="X" in self or "Y" in self)
        if wrong:
            raise self.refuse(wrong)
        if context.per_revolution and context.speed == 0:
            raise self.refuse("needs a spindle speed for feed per revolution (G95), but S is 0")
        if not context.feed > 0:
            raise self.refuse(
                f"F{number(context.feed)} must be greater than 0 (no feed commanded?)"
            )
        self.check_known(known)

    def commanded_tool(self) -> Tool | None:
        """Return the tool that D names, None without D; D0 is a cutter without size."""
        if "D" not in self:
            return None
        tool_number = self.take_whole("D", least=0)
        if tool_number == 0:
            return Tool(0, 0.0)
        if tool_number not in self.context.tools:
            raise self.refuse(f"D{tool_number} is not in the tool table")
        return self.context.tools[tool_number]

    def chosen_cutter(self) -> Cutter:
        """Return the cutter: D in the block, else the D last commanded, else the loaded tool."""
        context, tool = self.context, self.commanded_tool()
        if tool is not None:
            by, source = BY_D, f"D{tool.number}"
        elif context.last_cutter is not None:
            tool, by, source = context.last_cutter, BY_LAST_D, "the D last commanded"
        elif context.spindle_tool is not None:
            tool, by = context.spindle_tool, LOADED
            source = f"T{tool.number} in the spindle"
        else:
            raise self.refuse("D is missing, none was commanded before and no tool is loaded")
        if by != BY_LAST_D:
            self.check_sound(tool.radius, source)
        cutter = self.cutter_of(tool, by, source)
        if by == BY_D:
            return cutter._replace(is_modal=True)
        return cutter._replace(kept=self.kept_cutter(tool))

    def offset_cutter(self) -> Cutter | None:
        """Return the cutter of D, which counts in this block alone; None without D."""
        tool = self.commanded_tool()
        return self.cutter_of(tool, BY_D, f"D{tool.number}") if tool else None

    def cutter_of(self, tool: Tool, by: str, source: str) -> Cutter:
        used = UsedCutter(tool.radius, by, tool.number)
        return Cutter(used, source, self.other_cutter(tool, source))

    def sized_cutter(self) -> Cutter:
        """Return the cutter of the block, which must have a diameter."""
        cutter = self.chosen_cutter()
        if not cutter.radius:
            raise self.refuse(f"{cutter.source} has no diameter: it sets the path")
        return cutter

    def check_sound(self, radius: float, source: str) -> None:
        """Refuse a tool of a negative radius. ``source`` names the tool: ``D1``."""
        if radius < 0:
            negative = number(2 * radius)
            raise self.refuse(f"{source} has the negative diameter {negative} in the tool table")

    def other_cutter(self, tool: Tool, source: str) -> str | None:
        """Return the operator message of a cutter that is not the loaded tool, by more than wear.

        The cycle uses the cutter: the loaded tool may be the mistake. There is no comparison
        without a tool, or with one without a diameter.
        """
        context, loaded = self.context, self.context.spindle_tool
        if not tool.radius or loaded is None or loaded.radius <= 0:
            return None
        if abs(tool.radius - loaded.radius) <= WEAR * loaded.radius:
            return None
        size, loaded_size = (context.tool_size(2 * each.radius) for each in (tool, loaded))
        used = f"the cycle uses {source}, diameter {size}"
        return f"{self.code}: {used}; the loaded tool T{loaded.number} has {loaded_size}"

    def kept_cutter(self, cutter: Tool) -> str | None:
        """Return the operator message where the program does not show the cutter: without D.

        It may be that of an older line of the tool table, or depend on what ran before.
        """
        context, before = self.context, "the D of what ran before"
        size = context.tool_size(2 * cutter.radius)
        named = context.tools.get(cutter.number)
        if named and abs(named.radius - cutter.radius) > context.rounding:
            now = context.tool_size(2 * named.radius)
            return (
                f"{self.code}: D{cutter.number} has the diameter {now} in the tool table now, but"
                f" counts as it was commanded, with {size}. Give D{cutter.number} again"
            )
        if not context.d_is_earlier():
            return None
        counts = f"{before} counts, diameter {size}"
        if context.last_cutter is None:
            counts = f"the loaded tool T{cutter.number} counts, diameter {size}, or {before}"
        return f"{self.code}: no D above this block in the program: {counts}. Give D"

    def check_fits(
        self,
        letter: str,
        radius: float,
        cutter: float,
        source: str,
        finish: tuple[float, str] = (0.0, ""),
    ) -> None:
        """Refuse a circle that the cutter, here its radius, cannot mill: its centre needs a ring.

        ``source`` names the cutter. A ``finish`` dimension has to fit too, which the text adds.
        """
        context, sized = self.context, " in size" if radius < 0 else ""
        room, smallest = abs(radius) - cutter - finish[0], context.smallest_ring
        if room >= smallest - context.rounding:
            return
        least = number(smallest)
        if not cutter:
            raise self.refuse_word(letter, radius, f"must be at least {least}{sized}")
        by = f" by at least {least}" if room > context.rounding else ""
        size = f"{context.tool_size(cutter)} ({source}){finish[1]}{by}"
        raise self.refuse_word(
            letter, radius, f"must be greater{sized} than the tool radius {size}"
        )

    def check_count(self, circles: int, cause: str) -> None:
        """Refuse steps so small that the block would never end; ``cause`` names their words."""
        if circles > MOST_CIRCLES:
            raise self.refuse(f"{cause} {circles} circles, the most is {MOST_CIRCLES}")

    def check_travel(
        self,
        centre: SpacePoint,
        radius: float,
        heights: Sequence[float] = (),
        corners: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Refuse a cycle whose largest circle of the tool centre leaves the limits of an axis.

        ``heights`` are the other Z levels of the cycle. A rectangle's circle is that of its
        corners, whose centres are as far as ``corners`` from its own.
        """
        state, (x, y, z) = self.context, centre
        if not state.travel:
            return
        points = [(x, y, height) for height in heights or (z,)]
        ranges = []
        for axis, there, one, two in zip(
            LINEAR_AXES,
            zip(*map(state.point_on_machine, points)),
            *(state.turned(*axis) for axis in DIRECTIONS[state.plane]),
        ):
            beside = abs(one * corners[0]) + abs(two * corners[1])
            half = (radius * hypot(one, two) + beside) / state.machine_unit
            ranges.append((axis, min(there) - half, max(there) + half))
        beyond = beyond_travel(state, state.travel, ranges)
        if beyond:
            raise Refusal(beyond.rule, self.code)


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


def opposite(arc: int) -> int:
    """Return the G code of arcs in the other direction."""
    return CLOCKWISE + COUNTERCLOCKWISE - arc


def steps_between(first: float, last: float, step: float, tolerance: float) -> int:
    """Return how many steps, none longer than ``step``, lead from ``first`` to ``last``.

    A remainder shorter than ``tolerance`` is rounding, not a step of its own.
    """
    return math.ceil(max(0.0, min((last - first - tolerance) / step, COUNTLESS)))
