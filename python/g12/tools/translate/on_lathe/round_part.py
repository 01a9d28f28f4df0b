# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's words round a part: X along it, Y round it in G07.1, Z out of its surface.

Y is C the other way round: seen from outside with X upwards, the mill's Y points to the left, C to
the right. Arcs and compensation keep their sense.
"""

from math import degrees, fmod

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotSaid
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.on_lathe.values import DrilledHole, MilledSurface, is_plain_number, times

TURN = 360.0


def _slides_alone(draft: Draft) -> None:
    """Write Z as the X slide's diameter, X as Z, and drop Y."""
    _words_round(draft)
    word = draft.take("C")
    draft.comments += ["Y: no such slide here"] if word else []


def _words_round(draft: Draft) -> None:
    plus = diameter(draft) if draft.state.distance == "G90" else 0.0
    changed = {
        "X": ("Z", 1.0, 0.0),
        "Y": ("C", _degrees_per_length(draft), 0.0),
        "Z": ("X", 2.0, plus),
        "I": ("K", 1.0, 0.0),
        "J": ("J", -1.0, 0.0),
    }
    draft.words = [
        _converted(word, *changed[word.letter]) if word.letter in changed else word
        for word in draft.words
    ]


def _converted(word: ForeignWord, letter: str, factor: float, plus: float) -> ForeignWord:
    value = times(word.value, factor, plus)
    return ForeignWord(letter, value) if is_plain_number(value) else bracketed(letter, value)


def bracketed(letter: str, value: str) -> ForeignWord:
    """Return a word whose value is an expression."""
    return ForeignWord(letter, f"[{value}]", "expression")


def diameter(draft: Draft) -> float:
    """Return the surface's diameter in the program's units."""
    value = draft.control.value("mill", "diameter", 0.0)
    if not value:
        raise NotSaid(
            "the diameter of the part is not known: say --diameter, or diameter = … under [mill]",
            "mill",
            "diameter = …",
        )
    return value


def _degrees_per_length(draft: Draft) -> float:
    """Return degrees of C per length along Y."""
    return -degrees(2 / diameter(draft))


def _begin_round(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    code, word = draft.control.cylinder_code
    size = diameter(draft) if word == "diameter" else diameter(draft) / 2
    c = times(y, _degrees_per_length(draft))
    return [f"G0 Z{x} C{c if is_plain_number(c) else f'[{c}]'}", f"{code} C{size:g}"]


def _end_round(draft: Draft) -> list[str]:
    return [f"{draft.control.cylinder_code[0]} C0"]


def _side_hole(draft: Draft, hole: DrilledHole) -> str:
    angle = times(hole.y, _degrees_per_length(draft))
    if is_plain_number(angle):
        angle = times(str(fmod(float(angle), TURN)), 1.0)
    surface = f"{diameter(draft):g}"
    entries = (hole.depth, hole.retract, hole.feed, hole.peck, hole.dwell)
    place = f"[1] [{hole.x}] [{angle}] [-9999] [{surface}]"
    return f"o<side_holes> call {place} {' '.join(f'[{entry}]' for entry in entries)} [0]"


ROUND = MilledSurface(
    "X", "cylinder", "Y", _words_round, _slides_alone, _begin_round, _end_round, _side_hole
)
