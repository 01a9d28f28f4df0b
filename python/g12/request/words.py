# SPDX-License-Identifier: GPL-2.0-or-later
"""The state before a block, and its words: a dialect takes those it knows, others are refused.

Every rule about a single word lives here, so that each refusal names the code, the word,
the rule and the value in the same way. Plain data, no LinuxCNC.
"""

from collections.abc import Callable
from typing import NamedTuple

from g12.errors import Refusal, number
from g12.lengths import LARGEST, MM_PER_INCH, ROUNDING_MM

XY, YZ, XZ = "G17", "G19", "G18"
SMALLEST_RING_MM = 0.00508  # 0.0002 in: its half circles are twice what LinuxCNC needs


class Tool(NamedTuple):
    """A cutter: its number in the tool table and its radius in program units."""

    number: int
    radius: float


class Context(NamedTuple):
    """The interpreter's state before a block. Lengths are in program units.

    Position is in the active work coordinate system, tool offset applied, X as a radius.
    ``speed`` is the commanded spindle speed in rpm. ``offset_pending``: G40 came after the last
    move, and the tool is still offset from the programmed point by its radius. ``last_cutter`` is
    that of the last D commanded (None: none ever was), tool 0 where its number is not known;
    ``d_is_earlier()`` tells whether this run of the program has not commanded it.
    ``tool_in_table(n)`` gives tool n or None. ``unit`` is the program's where the machine has
    another, "mm" or "in": for sizes of the tool table in messages.
    """

    inch: bool
    x: float
    y: float
    z: float
    incremental: bool
    plane: str
    inverse_time: bool
    per_revolution: bool
    speed: float
    feed: float
    compensated: bool
    offset_pending: bool
    spindle_tool: Tool | None
    last_cutter: Tool | None
    d_is_earlier: Callable[[], bool]
    tool_in_table: Callable[[int], Tool | None]
    unit: str = ""

    def length(self, millimetres: float) -> float:
        """Return a length given in mm in program units."""
        return millimetres / MM_PER_INCH if self.inch else millimetres

    @property
    def position(self) -> tuple[float, float, float]:
        """The tool's X, Y and Z."""
        return self.x, self.y, self.z

    @property
    def rounding(self) -> float:
        """The greatest difference of equal lengths."""
        return self.length(ROUNDING_MM)

    @property
    def smallest_ring(self) -> float:
        """The smallest radius of a circle, and of a difference of two."""
        return self.length(SMALLEST_RING_MM)

    def absolute(self, word: float | None, present: float) -> float:
        """Return the absolute coordinate of a word in G90 or G91; without it, the present one."""
        if word is None:
            return present
        return present + word if self.incremental else word

    def tool_size(self, length: float) -> str:
        """Return a tool's radius or diameter for a message: ``3.175``, or ``3.175 mm``."""
        return f"{number(length)} {self.unit}".rstrip()


WHOLE = 1e-4  # LinuxCNC's own tolerance for "close to an integer"


class Words:
    """The words of a block, to be taken one by one, and the state before it.

    ``code`` names the block in messages (``G12``), ``values`` maps upper-case letters to
    numbers as the parser gave them: program units, expressions already resolved; they stay
    ``given``. A number beyond any machine is refused at once.
    """

    positive_rule = "must be greater than 0"

    def __init__(self, code: str, values: dict[str, float], context: Context) -> None:
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
