# SPDX-License-Identifier: GPL-2.0-or-later
"""The two surfaces on which a lathe runs a mill's program: words, sections and holes of each.

On the face of a bar X and Y become those of G12.1, and Z is along the spindle. Round a part X is
along it, Y round it in G07.1, and Z is radial. Seen from outside with X upwards, the mill's Y
points to the left, C to the right: Y is C with the other sign. Arcs and compensation keep their
sense.
"""

import re
from collections.abc import Callable
from math import degrees, fmod
from typing import NamedTuple

from g12.lengths import DEGREES_PER_TURN
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord

SIGNED_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")


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
    section, ``y_in`` the axis whose position is followed for Y in it. ``inside`` and ``outside``
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
    return bool(SIGNED_NUMBER.fullmatch(value))


def times(value: str, factor: float, plus: float = 0.0) -> str:
    """Return a value multiplied, and something added, with six decimals or as an expression."""
    if is_plain_number(value):
        text = f"{float(value) * factor + plus:.6f}".rstrip("0")
        return "0." if text == "-0." else text
    added = f" + {plus:g}" if plus else ""
    return f"[{value}] * {factor:.10g}{added}"


LEAST_SURFACE_RADIUS = {"G20": 0.2, "G21": 5.0}  # a section begins off the spindle's axis


def _without_y(draft: Draft) -> None:
    draft.comment_out("Y", ": no Y here")


def _same_words(draft: Draft) -> None:
    """Y is C in a section: the words stay."""


def _begin_on_face(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    least = LEAST_SURFACE_RADIUS[draft.state.units]
    start = f"[2 * SQRT[[{x}] ** 2 + [{y}] ** 2 + {least:g} ** 2]]"
    if is_plain_number(x) and is_plain_number(y):
        start = f"{2 * max(abs(complex(float(x), float(y))), least):.4f}"
    on, _ = draft.control.polar_codes
    return [f"G0 X{start} C0", "G8", on, f"G1 X{x} C{y} G94 F{feed:g}"]


def _end_on_face(draft: Draft) -> list[str]:
    return [draft.control.polar_codes[1], "G7"]


def _face_hole(draft: Draft, hole: DrilledHole) -> str:
    entries = (times(hole.x, 2), hole.y, hole.depth, hole.retract, hole.feed, hole.peck, hole.dwell)
    return f"o<face_hole_at> call {' '.join(f'[{entry}]' for entry in entries)} [0]"


FACE = MilledSurface(
    "Z", "on", "C", _same_words, _without_y, _begin_on_face, _end_on_face, _face_hole
)


def _slides_alone(draft: Draft) -> None:
    """Write Z as the X slide's diameter, X as Z, and drop Y."""
    _words_round(draft)
    if draft.take("C"):
        draft.comments.append("Y: no such slide here")


def _words_round(draft: Draft) -> None:
    plus = diameter(draft) if draft.state.distance == "G90" else 0.0
    changed = {
        "X": ("Z", 1.0, 0.0),
        "Y": ("C", _degrees_per_length(draft), 0.0),
        "Z": ("X", 2.0, plus),
        "I": ("K", 1.0, 0.0),
        "J": ("J", -1.0, 0.0),
    }
    for at, word in enumerate(draft.words):
        if word.letter in changed:
            letter, factor, added = changed[word.letter]
            draft.words[at] = _word(letter, times(word.value, factor, added))


def _word(letter: str, value: str) -> ForeignWord:
    if is_plain_number(value):
        return ForeignWord(letter, value)
    return ForeignWord(letter, f"[{value}]", "expression")


def diameter(draft: Draft) -> float:
    value = draft.control.value("mill", "diameter", 0.0)
    if not value:
        raise NotTranslated(
            "the diameter of the part is not known: say --diameter, or diameter = … under [mill]"
        )
    return value


def _degrees_per_length(draft: Draft) -> float:
    return -degrees(2 / diameter(draft))


def _begin_round(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    code, word = draft.control.cylinder_code
    size = diameter(draft) if word == "diameter" else diameter(draft) / 2
    c = _word("C", times(y, _degrees_per_length(draft)))
    return [f"G0 Z{x} {c.text}", f"{code} C{size:g}"]


def _end_round(draft: Draft) -> list[str]:
    return [f"{draft.control.cylinder_code[0]} C0"]


def _side_hole(draft: Draft, hole: DrilledHole) -> str:
    angle = times(hole.y, _degrees_per_length(draft))
    if is_plain_number(angle):
        angle = times(str(fmod(float(angle), DEGREES_PER_TURN)), 1.0)
    surface = f"{diameter(draft):g}"
    entries = (hole.depth, hole.retract, hole.feed, hole.peck, hole.dwell)
    position = f"[1] [{hole.x}] [{angle}] [-9999] [{surface}]"
    return f"o<side_holes> call {position} {' '.join(f'[{entry}]' for entry in entries)} [0]"


ROUND = MilledSurface(
    "X", "cylinder", "Y", _words_round, _slides_alone, _begin_round, _end_round, _side_hole
)
