# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of turning cycles that repeat a plain path, and the lines that they are written as.

- finishing (G70): the contour with its own words, then back, first away from the part in X
- single passes (G90, G94 of system A): in, along, out, back: a rectangle or a trapezium
- pecking (G74 along Z, G75 along X): cuts of one peck, each with a retract, in several columns
"""

from collections.abc import Iterator, Sequence
from math import copysign
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.positions import value_text
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
    return CycleMove("G0", point)


def feed_to(point: complex) -> CycleMove:
    return CycleMove("G1", point)


def moves_along(contour: Sequence[ContourMove], own_words: bool = False) -> list[CycleMove]:
    """Return the moves along a contour, with the words beside them for a finishing cut."""
    return [
        CycleMove(m.block.motion, m.end, m.centre, 0.0, m.block.others if own_words else ())
        for m in contour
    ]


def lines_of_moves(moves: Sequence[CycleMove], start: complex) -> Iterator[str]:
    """Yield the lines of moves, X as a diameter; those that go nowhere are left out."""
    at, code = start, ""
    for move in moves:
        end, moved = move.end, move.end - at
        values = {"X": 2 * end.imag} if abs(moved.imag) > DIGITS else {}
        values |= {"Z": end.real} if abs(moved.real) > DIGITS else {}
        if move.centre is not None:
            arm = move.centre - at
            values = {"X": 2 * end.imag, "Z": end.real, "I": arm.imag, "K": arm.real}
        elif move.pitch and values:
            values["K"] = move.pitch
        words = [f"{letter}{value_text(value)}" for letter, value in values.items()]
        if not words and not move.others:
            continue
        own = [move.code] if words and (move.code != code or move.code == "G33") else []
        yield " ".join([*own, *words, *move.others])
        at, code = move.end, move.code if words else code


def return_by(start: complex, end: complex, side: int) -> list[CycleMove]:
    """Return the rapids from a contour's end to the start, first away from the part in X.

    ``side`` is 1 where the tool is outside of the part, -1 in a bore.
    """
    clear = side * max(side * start.imag, side * end.imag)
    ways = [complex(end.real, clear), complex(start.real, clear), start]
    return [rapid_to(point) for point in ways if abs(point - end) > SAME]


MOST_CYCLE_PASSES = 5000


def finishing_cut(start: complex, contour: Sequence[ContourMove]) -> list[CycleMove]:
    return [*moves_along(contour, True), *return_by(start, contour[-1].end, _tool_side(contour))]


def _tool_side(contour: Sequence[ContourMove]) -> int:
    """Return on which side of the part the tool is: 1 outside, -1 in a bore."""
    start, ends = contour[0].start.imag, [segment.end.imag for segment in contour]
    return 1 if start - min(ends) >= max(ends) - start else -1


def turning_pass(start: complex, end: complex, taper: float) -> list[CycleMove]:
    """Return G90 of system A: along Z; ``taper`` the radius at the start less the end's."""
    begin = complex(start.real, end.imag + taper)
    return [rapid_to(begin), feed_to(end), feed_to(complex(end.real, start.imag)), rapid_to(start)]


def facing_pass(start: complex, end: complex, taper: float) -> list[CycleMove]:
    """Return G94 of system A: along X; ``taper`` is Z at the start less that at the end."""
    begin = complex(end.real + taper, start.imag)
    return [rapid_to(begin), feed_to(end), feed_to(complex(start.real, end.imag)), rapid_to(start)]


class Pecking(NamedTuple):
    """What G74 or G75 is given: where it ends, a peck, the step to the next peck, the retract.

    ``shift`` is by how much the tool goes aside at the bottom; ``along_x`` is G75.
    """

    end: complex
    peck: float
    step: float
    retract: float
    shift: float
    along_x: bool


def pecks(start: complex, given: Pecking) -> list[CycleMove]:
    depth, offsets = _offsets(given.end - start, given)
    if not depth:
        raise NotTranslated("the cycle cuts nothing: it ends at the tool's position")
    peck = given.peck or abs(depth)
    if abs(depth) / peck > MOST_CYCLE_PASSES:
        raise NotTranslated(f"{abs(depth) / peck:.0f} pecks: they are too small")
    point = lambda along, aside: start + _turned(complex(along, aside), given.along_x)  # noqa: E731
    away, moves = copysign(1.0, -depth), []
    for number, aside in enumerate(offsets):
        moves.append(rapid_to(point(0.0, aside)))
        done = 0.0
        while abs(depth) - done > SAME:
            done = min(done + peck, abs(depth))
            moves.append(feed_to(point(-away * done, aside)))
            if abs(depth) - done > SAME:
                moves.append(rapid_to(point(-away * max(done - given.retract, 0.0), aside)))
        if given.shift and number:
            aside -= copysign(given.shift, offsets[-1])
            moves.append(rapid_to(point(depth, aside)))
        moves.append(rapid_to(point(0.0, aside)))
    return [*moves, rapid_to(start)]


def _offsets(span: complex, given: Pecking) -> tuple[float, list[float]]:
    """Return the depth, and the offset of each peck from the start."""
    turned = _turned(span, given.along_x)
    depth, width = turned.real, turned.imag
    if abs(width) < SAME:
        return depth, [0.0]
    if not given.step:
        raise NotTranslated("the cycle has no step to the next peck")
    count = int(abs(width) / given.step - SAME)
    if count > MOST_CYCLE_PASSES:
        raise NotTranslated(f"{count} steps: the step is too small")
    steps = [copysign(given.step * number, width) for number in range(count + 1)]
    return depth, [*steps, width]


def _turned(point: complex, along_x: bool) -> complex:
    return complex(point.imag, point.real) if along_x else point
