# SPDX-License-Identifier: GPL-2.0-or-later
"""Haas's patterns of holes, each a place of the drilling cycle that is on.

- G70: L holes on a circle of radius I about the tool, the first at the angle J
- G71: L holes on an arc of radius I from the angle J, K degrees from hole to hole
- G72: L holes in a row from the tool on, I from hole to hole, at the angle J
"""

from cmath import rect
from math import radians

from g12.tools.translate.blocks.draft import Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import UNKNOWN
from g12.tools.translate.blocks.places import known_place, value_text

MOST_HOLES = 1000
WORDS = {"circle of holes": "IJL", "arc of holes": "IJKL", "row of holes": "IJL"}


def hole_pattern(draft: Draft) -> None:
    """Write the places of a pattern; the cycle's own rule completes the first of them."""
    meaning = next((name for name in WORDS if name in draft.meanings), "")
    if not meaning:
        return
    code = draft.meanings.pop(meaning).code
    if not draft.state.cycle and "drilling cycle" not in draft.meanings:
        raise NotTranslated(f"{code} needs a drilling cycle before it, as G81 Z R F L0")
    x, y = known_place(draft.state, "X"), known_place(draft.state, "Y")
    if x is None or y is None or draft.state.distance != "G90":
        raise NotTranslated(
            f"{code} is laid about where the tool stands, which is not known here: write X and Y "
            "as numbers, under G90"
        )
    numbers = {letter: _pattern_number(draft, code, letter) for letter in WORDS[meaning]}
    holes = [complex(x, y) + step for step in _steps_of(meaning, numbers)]
    first, *others = (f"X{value_text(p.real)} Y{value_text(p.imag)}" for p in holes)
    draft.words = [word for word in draft.words if word.letter not in "XY"]
    draft.words += [word_of(text) for text in first.split()]
    draft.after += others
    draft.comments.append(code)
    draft.change(at_x=holes[-1].real, at_y=holes[-1].imag, at_z=UNKNOWN)


def _pattern_number(draft: Draft, code: str, letter: str) -> float:
    word = draft.take(letter)
    if not word or word.kind != "number":
        raise NotTranslated(f"{code} needs {letter} as a number")
    if (
        letter != "L"
        and "." not in word.value
        and word.number
        and draft.control.decimals != "whole"
    ):
        raise NotTranslated(f"{word.text} of {code} has no decimal point: write {word.text}.")
    if letter == "L" and not 1 <= word.number <= MOST_HOLES:
        raise NotTranslated(f"{code} {word.text}: there must be from 1 to {MOST_HOLES} holes")
    return word.number


def _steps_of(meaning: str, numbers: dict[str, float]) -> list[complex]:
    """Return the holes relative to the tool."""
    count, begin = int(numbers["L"]), radians(numbers["J"])
    if meaning == "row of holes":
        return [rect(numbers["I"] * number, begin) for number in range(count)]
    step = radians(numbers.get("K", 360 / count))
    return [rect(numbers["I"], begin + number * step) for number in range(count)]
