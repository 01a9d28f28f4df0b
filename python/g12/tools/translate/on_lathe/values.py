# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of words, what a hole is given, and what differs between a face and a round part."""

import re
from collections.abc import Callable
from typing import NamedTuple

from g12.tools.translate.blocks.draft import Draft

NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")


class DrilledHole(NamedTuple):
    """A hole: where it is in the mill's X and Y, and the entries of its call, all as text."""

    x: str
    y: str
    depth: str
    retract: str
    feed: str
    peck: str
    dwell: str


class MilledSurface(NamedTuple):
    """Where a mill's program goes on a lathe.

    ``home`` is the axis along which the tool leaves the part, ``section`` the state's name for a
    section, ``y_in`` the axis whose place is followed for Y in it. ``inside`` and ``outside``
    rewrite the words of a block, ``begin`` and ``end`` return the lines of a section's ends,
    ``call`` that of a hole.
    """

    home: str
    section: str
    y_in: str
    inside: Callable[[Draft], None]
    outside: Callable[[Draft], None]
    begin: Callable[[Draft, tuple[str, str], float], list[str]]
    end: Callable[[Draft], list[str]]
    call: Callable[[Draft, DrilledHole], str]


def is_plain_number(value: str) -> bool:
    """Tell whether a value is a plain number."""
    return bool(NUMBER.fullmatch(value))


def times(value: str, factor: float, plus: float = 0.0) -> str:
    """Return a value multiplied, and something added, with six decimals or as an expression."""
    if is_plain_number(value):
        text = f"{float(value) * factor + plus:.6f}".rstrip("0")
        return "0." if text == "-0." else text
    added = f" + {plus:g}" if plus else ""
    return f"[{value}] * {factor:.10g}{added}"
