# SPDX-License-Identifier: GPL-2.0-or-later
"""The one exception of the package: a block, a section or a setting that is refused."""

from __future__ import annotations

LONGEST_MESSAGE = 255  # LinuxCNC cuts an operator message there
LONGEST_BLOCK = 254  # characters that LinuxCNC reads of a line


class Refusal(ValueError):
    """A refused block: nothing has moved and nothing has changed.

    ``code`` is the block's, or the name of its sub; a setting has none. ``line`` is None until a
    handler adds it (`at`), 0 in MDI. ``file`` is that of the line, if it is not the program's own.
    """

    def __init__(self, rule: str, code: str = "", line: int | None = None, file: str = "") -> None:
        super().__init__(rule)
        self.rule, self.code, self.line = rule, code, line
        self.file = file or getattr(line, "file", "")

    @property
    def lacks_line(self) -> bool:
        """Whether a block is refused whose line the planner did not know."""
        return bool(self.code) and self.line is None

    def at(self, line: int | None) -> None:
        """Add the line, which may be one of another file."""
        self.line, self.file = line, getattr(line, "file", "")

    @property
    def message(self) -> str:
        """The text for the operator, at most 255 characters.

        It names the code, its line, the word, the rule and the value, for example
        ``G12 line 13: I0.125 must be greater than the tool radius 0.125 (D1)``.
        """
        if not self.code:
            return self.rule[:LONGEST_MESSAGE]
        file = f" of {self.file:.80}" if self.file else ""  # room for the rule
        line = f" line {int(self.line)}{file}" if self.line else ""
        return f"{self.code}{line}: {self.rule}"[:LONGEST_MESSAGE]

    def __str__(self) -> str:
        return self.message


def number(value: float) -> str:
    """Return ``value`` as an operator would write it: six decimals at most, no trailing zeros.

    A value that six decimals cannot show has an exponent: 1e-07, 1e+300.
    """
    if value and not 5e-7 <= abs(value) < 1e15:
        return f"{value:.6g}"
    return f"{value:.6f}".rstrip("0").rstrip(".")
