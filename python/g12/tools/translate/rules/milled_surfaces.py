# SPDX-License-Identifier: GPL-2.0-or-later
"""The surfaces on which a machine runs a mill's flat program: words, sections and holes of each.

On the face of a bar X and Y become those of G12.1, and Z is along the spindle. Round a part one
axis is a length along it, the other one an angle in G07.1, and Z is the height above the axis: the
program's Z0 is the surface. Seen from the tool the drawing keeps its hands.

| machine | along the part | round it | out of it |
|---|---|---|---|
| lathe with C | X is Z | Y is C, the other way round | Z is X, a diameter |
| mill with A | X | Y is A, the other way round | Z |
| mill with B | Y | X is B | Z |
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
LEAST_RADIUS = {"G20": 0.2, "G21": 5.0}  # a section begins off the spindle's axis
WOUND = {"A": ("Y", -1.0), "B": ("X", 1.0)}  # what a mill's rotary axis takes, in its sense


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
    """Where a mill's program goes.

    ``section`` is the state's name for a section, ``y_in`` the axis whose position is followed for
    Y in it. ``words`` rewrites the words of a block, ``home`` those of one that goes to a machine
    position. ``begin`` and ``end`` return the lines of a section's ends, ``hole`` those of a hole.
    """

    section: str
    y_in: str
    words: Callable[[Draft], None]
    home: Callable[[Draft], None]
    begin: Callable[[Draft, tuple[str, str], float], list[str]]
    end: Callable[[Draft], list[str]]
    hole: Callable[[Draft, str, DrilledHole], list[str]]
    away: str = ""  # the axis along which the tool leaves a lathe's part


def is_plain_number(value: str) -> bool:
    return bool(SIGNED_NUMBER.fullmatch(value))


def times(value: str, factor: float, plus: float = 0.0) -> str:
    """Return a value multiplied, and something added, with six decimals or as an expression."""
    if is_plain_number(value):
        text = f"{float(value) * factor + plus:.6f}".rstrip("0")
        return "0." if text == "-0." else text
    added = f" + {plus:g}" if plus else ""
    return f"[{value}] * {factor:.10g}{added}"


def _word(letter: str, value: str) -> ForeignWord:
    if is_plain_number(value):
        return ForeignWord(letter, value)
    return ForeignWord(letter, f"[{value}]", "expression")


Changes = dict[str, tuple[str, float, float]]  # letter: the new one, a factor, something to add


def _change(draft: Draft, changes: Changes) -> None:
    for at, word in enumerate(draft.words):
        if word.letter in changes:
            letter, factor, added = changes[word.letter]
            draft.words[at] = _word(letter, times(word.value, factor, added))


def surface_of(draft: Draft) -> MilledSurface:
    if draft.control.onto == "face":
        return FACE
    return ON_MILL if _turn(draft) else ON_LATHE


# ---------------------------------------------------------------- on the face of a bar


def _same_words(draft: Draft) -> None:
    """Y is C in a section: the words stay."""


def _without_y(draft: Draft) -> None:
    draft.comment_out("Y", ": no Y here")


def _begin_on_face(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    least = LEAST_RADIUS[draft.state.units]
    start = f"[2 * SQRT[[{x}] ** 2 + [{y}] ** 2 + {least:g} ** 2]]"
    if is_plain_number(x) and is_plain_number(y):
        start = f"{2 * max(abs(complex(float(x), float(y))), least):.4f}"
    return [f"G0 X{start} C0", "G8", draft.control.polar_codes[0], f"G1 X{x} C{y} G94 F{feed:g}"]


def _end_on_face(draft: Draft) -> list[str]:
    return [draft.control.polar_codes[1], "G7"]


def _face_hole(draft: Draft, cycle: str, hole: DrilledHole) -> list[str]:
    entries = (times(hole.x, 2), *hole[1:])
    return [f"o<face_hole_at> call {' '.join(f'[{entry}]' for entry in entries)} [0]"]


FACE = MilledSurface(
    "on", "C", _same_words, _without_y, _begin_on_face, _end_on_face, _face_hole, "Z"
)


# ---------------------------------------------------------------- round a part


def _diameter(draft: Draft) -> float:
    value = draft.control.value("mill", "diameter", 0.0)
    if not value:
        raise NotTranslated(
            "the diameter of the part is not known: say --diameter, or diameter = … under [mill]"
        )
    return value


def _degrees_per_length(draft: Draft) -> float:
    return degrees(2 / _diameter(draft))


def _on_code(draft: Draft, letter: str) -> str:
    code, word = draft.control.cylinder_code
    size = _diameter(draft) if word == "diameter" else _diameter(draft) / 2
    return f"{code} {letter}{size:g}"


def _raised(draft: Draft, by: float) -> float:
    """Return what is added to Z where it is no increment."""
    return by if draft.state.distance == "G90" else 0.0


def _words_on_lathe(draft: Draft) -> None:
    changes: Changes = {
        "X": ("Z", 1.0, 0.0),
        "Y": ("C", -_degrees_per_length(draft), 0.0),
        "Z": ("X", 2.0, _raised(draft, _diameter(draft))),
        "I": ("K", 1.0, 0.0),
        "J": ("J", -1.0, 0.0),
    }
    _change(draft, changes)


def _slides_alone(draft: Draft) -> None:
    _words_on_lathe(draft)
    if draft.take("C"):
        draft.comments.append("Y: no such slide here")


def _begin_on_lathe(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    c = _word("C", times(y, -_degrees_per_length(draft)))
    return [f"G0 Z{x} {c.text}", _on_code(draft, "C")]


def _end_on_lathe(draft: Draft) -> list[str]:
    return [f"{draft.control.cylinder_code[0]} C0"]


def _side_hole(draft: Draft, cycle: str, hole: DrilledHole) -> list[str]:
    angle = times(hole.y, -_degrees_per_length(draft))
    if is_plain_number(angle):
        angle = times(str(fmod(float(angle), DEGREES_PER_TURN)), 1.0)
    position = f"[1] [{hole.x}] [{angle}] [-9999] [{_diameter(draft):g}]"
    return [f"o<side_holes> call {position} {' '.join(f'[{entry}]' for entry in hole[2:])} [0]"]


ON_LATHE = MilledSurface(
    "cylinder",
    "Y",
    _words_on_lathe,
    _slides_alone,
    _begin_on_lathe,
    _end_on_lathe,
    _side_hole,
    "X",
)


def _turn(draft: Draft) -> str:
    """Return the letter of a mill's rotary axis, "" on a lathe."""
    return draft.control.value("mill", "turn", "")


def _wound(draft: Draft) -> tuple[str, float]:
    """Return the axis that becomes an angle, and the degrees of a length."""
    letter, sense = WOUND[_turn(draft)]
    return letter, sense * draft.control.value("mill", "sense", 1.0) * _degrees_per_length(draft)


def _words_on_mill(draft: Draft) -> None:
    letter, scale = _wound(draft)
    height = ("Z", 1.0, _raised(draft, _diameter(draft) / 2))
    _change(draft, {letter: (_turn(draft), scale, 0.0), "Z": height})


def _raise_home(draft: Draft) -> None:
    """Raise the point through which G28 and G30 go; G53 is the machine's own."""
    if "G53" not in draft.codes():
        _change(draft, {"Z": ("Z", 1.0, _raised(draft, _diameter(draft) / 2))})


def _above(draft: Draft, point: tuple[str, str]) -> str:
    """Return the words of a point on the surface, with the tool above the axis of rotation."""
    letter, scale = _wound(draft)
    values = dict(zip("XY", point))
    angle = _word(_turn(draft), times(values[letter], scale))
    return " ".join(
        [*(_word(a, "0" if a == letter else v).text for a, v in values.items()), angle.text]
    )


def _begin_on_mill(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    return [f"G0 {_above(draft, point)}", _on_code(draft, _turn(draft))]


def _end_on_mill(draft: Draft) -> list[str]:
    return [f"{draft.control.cylinder_code[0]} {_turn(draft)}0"]


def _hole_on_mill(draft: Draft, cycle: str, hole: DrilledHole) -> list[str]:
    radius, (x, y) = _diameter(draft) / 2, hole[:2]
    above = _above(draft, (x, y))
    letter, _ = _wound(draft)
    there = " ".join(f"{a}{'0' if a == letter else v}" for a, v in (("X", x), ("Y", y)))
    bottom, retract = times(hole.depth, -1, radius), times(hole.retract, 1, radius)
    more = {"G82": f" P{hole.dwell}"}.get(cycle, "")
    if cycle in ("G73", "G83"):
        more = f" Q{times(hole.peck, -1 if cycle == 'G73' else 1)}"
    heights = f"{_word('Z', bottom).text} {_word('R', retract).text}"
    return [f"G0 {above}", f"G98 {cycle} {there} {heights}{more} F{hole.feed}", "G80"]


ON_MILL = MilledSurface(
    "cylinder", "Y", _words_on_mill, _raise_home, _begin_on_mill, _end_on_mill, _hole_on_mill
)
