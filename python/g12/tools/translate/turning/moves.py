# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of a turning cycle, and the lines that they are written as."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from g12.tools.translate.blocks.places import value_text
from g12.tools.translate.turning.contour import SAME, ContourMove

DIGITS = 1e-6  # a word is written where its value changes by that


class CycleMove(NamedTuple):
    """A move to a point: ``code`` G0 to G3 or G33, ``others`` words written with it.

    ``pitch`` is what G33 goes for each revolution, along its path.
    """

    code: str
    end: complex
    centre: complex | None = None
    pitch: float = 0.0
    others: tuple[str, ...] = ()


def rapid_to(point: complex) -> CycleMove:
    """Return a rapid move."""
    return CycleMove("G0", point)


def feed_to(point: complex) -> CycleMove:
    """Return a cut."""
    return CycleMove("G1", point)


def moves_along(segments: Sequence[ContourMove], own_words: bool = False) -> list[CycleMove]:
    """Return the moves along segments, with the words beside them for a finishing cut."""
    moves: list[CycleMove] = []
    last = None
    for s in segments:
        others = s.block.others if own_words and s.block is not last else ()
        moves.append(CycleMove(s.motion, s.end, s.centre, 0.0, others))
        last = s.block
    return moves


def lines_of_moves(moves: Sequence[CycleMove], start: complex) -> Iterator[str]:
    """Yield the lines of moves, X as a diameter; those that go nowhere are left out."""
    at, code = start, ""
    for move in moves:
        words = [f"X{value_text(2 * move.end.imag)}"] if differs(move.end.imag, at.imag) else []
        words += [f"Z{value_text(move.end.real)}"] if differs(move.end.real, at.real) else []
        if move.centre is not None:
            words = [f"X{value_text(2 * move.end.imag)}", f"Z{value_text(move.end.real)}"]
            words += [f"I{value_text((move.centre - at).imag)}"]
            words += [f"K{value_text((move.centre - at).real)}"]
        words += [f"K{value_text(move.pitch)}"] if move.pitch and words else []
        if not words and not move.others:
            continue
        own = [move.code] if words and (move.code != code or move.code == "G33") else []
        yield " ".join([*own, *words, *move.others])
        at, code = move.end, move.code if words else code


def differs(one: float, other: float) -> bool:
    """Tell whether a word is needed."""
    return abs(one - other) > DIGITS


def return_by(start: complex, end: complex, side: int) -> list[CycleMove]:
    """Return the rapids from a contour's end to the start, first away from the part in X.

    ``side`` is 1 where the tool stands outside of the part, -1 in a bore.
    """
    clear = side * max(side * start.imag, side * end.imag)
    ways = [complex(end.real, clear), complex(start.real, clear), start]
    return [rapid_to(point) for point in ways if abs(point - end) > SAME]
