# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of one block: a dialect takes the words it knows, and any other is refused.

Every rule about a single word lives here, so that each refusal names the code, the word,
the rule and the value in the same way. Plain data, no LinuxCNC.
"""

from g12.errors import Refusal, number
from g12.lengths import LARGEST
from g12.state import State

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
