# SPDX-License-Identifier: GPL-2.0-or-later
"""The one exception of the package: a block, a section or a setting that is refused."""

from __future__ import annotations

LONGEST_MESSAGE = 255  # LinuxCNC cuts an operator message there
LONGEST_BLOCK = 254  # characters that LinuxCNC reads of a line


class Refusal(ValueError):
    """A refused block: nothing has moved and nothing has changed.

    The message names the code, its line, the word, the rule and the value, for example
    ``G12 line 13: I0.125 must be greater than the tool radius 0.125 (D1)``.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message[:LONGEST_MESSAGE])

    @property
    def message(self) -> str:
        """The text for the operator, at most 255 characters."""
        return self.args[0]


class BlockRefusal(Refusal):
    """A block of ``code`` that breaks ``rule``; its caller adds the line."""

    def __init__(self, code: str, rule: str, line: int | None = None) -> None:
        self.code, self.rule = code, rule
        super().__init__(f"{code}: {rule}" if line is None else f"{code} line {line}: {rule}")

    def at(self, line: int | None) -> BlockRefusal:
        """Return the refusal with its line in the message; None: without a line."""
        return BlockRefusal(self.code, self.rule, line)


def number(value: float) -> str:
    """Return ``value`` as an operator would write it: six decimals at most, no trailing zeros.

    A value that six decimals cannot show has an exponent: 1e-07, 1e+300.
    """
    if value and not 5e-7 <= abs(value) < 1e15:
        return f"{value:.6g}"
    return f"{value:.6f}".rstrip("0").rstrip(".")
