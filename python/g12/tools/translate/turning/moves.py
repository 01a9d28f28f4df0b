# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of turning cycles: of a contour, plain passes, pecks and threads; and their lines.

A point is a complex number in the program's unit: Z is its real part, X as a radius its imaginary
one. Counter-clockwise is G3, as LinuxCNC has it in G18.

- finishing (G70): the contour with its own words, then back, first away from the part in X
- single passes (G90, G94 of system A): in, along, out, back: a rectangle or a trapezium
- pecking (G74 along Z, G75 along X): cuts of one peck, each with a retract, in several columns
- threads: one pass (G92 of system A), and all of them (G76), each as G33. LinuxCNC's own G76 has
  another rule for the depth of its passes. G33's K is the travel along the path for each
  revolution, the lead of these controls that along Z (or X, if steeper).
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import count
from math import copysign, radians, sqrt, tan
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.positions import value_text

ARC_CODES = ("G2", "G3")
SAME = 1e-7  # points and lengths that are nearer are the same
ROUNDED = 0.01  # what R may be too short by, or two radii of I and K may differ
DIGITS = 1e-6  # a word is written where its value changes by that
MOST_CUTS = 5000  # of one cycle


def limited(count: float, cuts: str) -> int:
    """Return the number of a cycle's cuts, or refuse one that only a wrong word can have."""
    if count > MOST_CUTS:
        raise NotTranslated(f"{count:.0f} {cuts} in one cycle: at most {MOST_CUTS}, go in deeper")
    return int(count)


class CycleMove(NamedTuple):
    """A move to a point: ``code`` G0 to G3 or G33, ``others`` words written with it.

    ``pitch`` is what G33 goes for each revolution, along its path. A move of a contour knows where
    it starts, and the line of its block.
    """

    code: str
    end: complex
    centre: complex | None = None
    pitch: float = 0.0
    others: tuple[str, ...] = ()
    start: complex = 0.0
    line: int = 0


def centre_of(code: str, shape: Mapping[str, float], start: complex, end: complex) -> complex:
    """Return the centre of an arc from its I, K and R."""
    if "R" in shape:
        return _centre_by_radius(start, end, shape["R"] * (1 if code == "G3" else -1))
    if not shape:
        raise NotTranslated(f"{code} needs R, or I and K; a line is G1")
    centre = start + complex(shape.get("K", 0.0), shape.get("I", 0.0))
    if abs(abs(start - centre) - abs(end - centre)) > ROUNDED or centre == start:
        raise NotTranslated("I and K are no centre of the arc to its end")
    return centre


def _centre_by_radius(start: complex, end: complex, radius: float) -> complex:
    """Return the centre of an arc; ``radius`` is below 0 for G2, or for more than half a turn."""
    chord = end - start
    if abs(chord) < SAME or abs(chord) / 2 > abs(radius) + ROUNDED:
        raise NotTranslated(f"R{abs(radius):g} is too small for the arc to its end")
    height = sqrt(max(0.0, radius**2 - abs(chord) ** 2 / 4))
    return (start + end) / 2 + 1j * chord / abs(chord) * (height if radius > 0 else -height)


def offset_by(moves: Sequence[CycleMove], by: complex) -> list[CycleMove]:
    """Return a contour beside another one, without the words of its blocks."""
    return [
        move._replace(
            start=move.start + by,
            end=move.end + by,
            centre=None if move.centre is None else move.centre + by,
            others=(),
        )
        for move in moves
    ]


def rapid_to(point: complex) -> CycleMove:
    return CycleMove("G0", point)


def feed_to(point: complex) -> CycleMove:
    return CycleMove("G1", point)


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


def return_by(start: complex, ends: Sequence[complex], side: int) -> list[CycleMove]:
    """Return the rapids from the last of a contour's ends to the start, clear of all of them.

    ``side`` is 1 where the tool is outside of the part, -1 in a bore.
    """
    end, clear = ends[-1], side * max(side * point.imag for point in (start, *ends))
    ways = [complex(end.real, clear), complex(start.real, clear), start]
    return [rapid_to(point) for point in ways if abs(point - end) > SAME]


def finishing_cut(start: complex, contour: Sequence[CycleMove]) -> list[CycleMove]:
    ends = [move.end for move in contour]
    return [*contour, *return_by(start, ends, _tool_side(contour))]


def _tool_side(contour: Sequence[CycleMove]) -> int:
    """Return on which side of the part the tool is: 1 outside, -1 in a bore."""
    start, ends = contour[0].start.imag, [segment.end.imag for segment in contour]
    return 1 if start - min(ends) >= max(ends) - start else -1


def single_pass(start: complex, end: complex, taper: float, along_x: bool) -> list[CycleMove]:
    """Return G90 of system A, along Z, or G94, along X: in, along, out, back.

    ``taper`` is the radius (of G94: Z) at the start less that at the end.
    """
    begin, out = complex(start.real, end.imag + taper), complex(end.real, start.imag)
    if along_x:
        begin, out = complex(end.real + taper, start.imag), complex(start.real, end.imag)
    return [rapid_to(begin), feed_to(end), feed_to(out), rapid_to(start)]


class Pecking(NamedTuple):
    """What G74 or G75 is given: where it ends, a peck, the step to the next peck, the retract.

    ``along_x`` is G75.
    """

    end: complex
    peck: float
    step: float
    retract: float
    along_x: bool


def pecks(start: complex, given: Pecking) -> list[CycleMove]:
    depth, offsets = _offsets(given.end - start, given)
    if not depth:
        raise NotTranslated("the cycle cuts nothing: it ends at the tool's position")
    peck = given.peck or abs(depth)
    limited(abs(depth) / peck, "pecks")
    point = lambda along, aside: start + _turned(complex(along, aside), given.along_x)  # noqa: E731
    away, moves = copysign(1.0, -depth), []
    for aside in offsets:
        moves.append(rapid_to(point(0.0, aside)))
        done = 0.0
        while abs(depth) - done > SAME:
            done = min(done + peck, abs(depth))
            moves.append(feed_to(point(-away * done, aside)))
            if abs(depth) - done > SAME:
                moves.append(rapid_to(point(-away * max(done - given.retract, 0.0), aside)))
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
    count = limited(abs(width) / given.step - SAME, "steps")
    steps = [copysign(given.step * number, width) for number in range(count + 1)]
    return depth, [*steps, width]


def _turned(point: complex, along_x: bool) -> complex:
    return complex(point.imag, point.real) if along_x else point


class Thread(NamedTuple):
    """A thread: where it ends at full depth, its lead, its taper, how it runs out.

    ``taper`` is the radius at the start less that at the end, ``chamfer`` the length over which the
    tool leaves at 45 degrees.
    """

    end: complex
    lead: float
    taper: float = 0.0
    chamfer: float = 0.0


class Infeed(NamedTuple):
    """How the passes of G76 go in: thread's height, first depth, least depth, the last ones.

    ``allowance`` remains for the first of ``finishing`` passes, ``angle`` that of the thread along
    whose flank the tool goes in.
    """

    height: float
    first: float
    least: float = 0.0
    allowance: float = 0.0
    finishing: int = 1
    angle: float = 0.0


def thread_pass(start: complex, thread: Thread, up: float = 0.0) -> list[CycleMove]:
    """Return one pass; ``up`` is how much higher than the thread's full depth it is."""
    side = 1 if start.imag > thread.end.imag else -1
    begin = complex(start.real, thread.end.imag + thread.taper + side * up)
    end = complex(thread.end.real, thread.end.imag + side * up)
    path = end - begin
    if abs(path.real) < SAME:
        raise NotTranslated("the thread has no length in Z")
    pitch = pitch_along(path, thread.lead)
    chamfer = min(thread.chamfer, abs(path.real))
    turning = end - path / abs(path.real) * chamfer
    moves = [rapid_to(begin), CycleMove("G33", turning, None, pitch)]
    if chamfer > SAME:
        out = complex(end.real, turning.imag + side * chamfer)
        moves.append(CycleMove("G33", out, None, pitch_along(out - turning, thread.lead)))
    return [*moves, *return_by(start, [moves[-1].end], side)]


def pitch_along(path: complex, lead: float) -> float:
    """Return the travel along the path for each revolution."""
    longer = max(abs(path.real), abs(path.imag))
    return lead * abs(path) / longer


def _depths(infeed: Infeed) -> list[float]:
    """Return the depth of each pass, roughing passes first."""
    full, least = infeed.height - infeed.allowance, infeed.least
    if infeed.first <= 0 or full <= 0:
        raise NotTranslated("the thread's height and the depth of its first pass must be above 0")
    found: list[float] = []
    for number in count(1):
        last = found[-1] if found else 0.0
        depth = infeed.first if number == 1 else max(infeed.first * sqrt(number), last + least)
        if depth > full - SAME:
            break
        found.append(depth)
        limited(number, "passes")
    finishing = infeed.finishing if infeed.allowance > SAME else infeed.finishing - 1
    return [*found, full, *[infeed.height] * max(finishing, 0)]


def all_passes(start: complex, thread: Thread, infeed: Infeed) -> list[CycleMove]:
    """Return the passes of G76; shallower ones are shifted along the flank, away from the end."""
    moves: list[CycleMove] = []
    away = 1 if start.real > thread.end.real else -1
    for depth in _depths(infeed):
        up = infeed.height - depth
        aside = away * up * tan(radians(infeed.angle / 2))
        shifted = thread._replace(end=thread.end + aside)
        one = thread_pass(start + aside, shifted, up)
        moves += [*one[:-1], rapid_to(start)]
    return moves
