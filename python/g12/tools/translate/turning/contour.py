# SPDX-License-Identifier: GPL-2.0-or-later
"""A turned contour: lines and arcs from a program's blocks, with corners and angles worked out.

A point is a complex number in the program's unit: Z is its real part, X as a radius its imaginary
one. Counter-clockwise is G3, as LinuxCNC has it in G18.
"""

from cmath import phase, rect
from collections.abc import Mapping, Sequence
from math import pi, radians, sqrt, tan
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated

ARC_CODES = ("G2", "G3")
SAME = 1e-7  # points and lengths that are nearer are the same
ROUNDED = 0.01  # what R may be too short by, or two radii of I and K may differ


class ContourBlock(NamedTuple):
    """A block of a contour: its motion code, the numbers of its words, what is beside them.

    ``relative`` says that X and Z are increments; ``others`` are codes and words that are written
    with its move, ``line`` is that of the file.
    """

    motion: str
    values: Mapping[str, float]
    line: int
    relative: bool = False
    others: tuple[str, ...] = ()

    @property
    def angle(self) -> float | None:
        """The direction of a line from the Z axis, in degrees."""
        return self.values.get(",A", self.values.get("A"))


class ContourMove(NamedTuple):
    """A line, or an arc about ``centre``, counter-clockwise if ``sense`` is 1, else -1."""

    start: complex
    end: complex
    block: ContourBlock
    centre: complex | None = None
    sense: int = 0

    @property
    def motion(self) -> str:
        return self.block.motion if self.centre is None else ("G3" if self.sense > 0 else "G2")


def contour_of(blocks: Sequence[ContourBlock], start: complex) -> list[ContourMove]:
    at, sides = start, []
    for block, end in zip(blocks, ends_of(blocks, start)):
        if end != at or (block.motion in ARC_CODES and block.values.keys() & {"I", "K"}):
            sides.append(_segment(block, at, end))
        at = end
    segments: list[ContourMove] = []
    for side, following in zip(sides, [*sides[1:], None]):
        begin = segments[-1].end if segments else side.start
        segments += _with_corner(side._replace(start=begin), following)
    return segments


def ends_of(blocks: Sequence[ContourBlock], start: complex) -> list[complex]:
    """Return where each block ends, corners being sharp."""
    ends = [start]
    for block, following in zip(blocks, [*blocks[1:], None]):
        ends.append(_end_of(block, following, ends[-1]))
    return ends[1:]


def _end_of(block: ContourBlock, following: ContourBlock | None, at: complex) -> complex:
    """Return where a block ends: its words, or its angle from the Z axis."""
    z = _coordinate(block, at.real, "Z", "W", 1.0)
    x = _coordinate(block, at.imag, "X", "U", 0.5)
    angle = block.angle
    if angle is None or (x is not None and z is not None):
        return complex(at.real if z is None else z, at.imag if x is None else x)
    if x is None and z is None:
        return _meeting(block, following, at, radians(angle))
    slope = tan(radians(angle))
    if z is None:
        if abs(slope) < SAME:
            raise NotTranslated(f"line {block.line}: A{angle:g} never reaches that X")
        return complex(at.real + (x - at.imag) / slope, x)
    return complex(z, at.imag + (z - at.real) * slope)


def _coordinate(
    block: ContourBlock, at: float, absolute: str, increment: str, scale: float
) -> float | None:
    if increment in block.values:
        return at + block.values[increment] * scale
    if absolute not in block.values:
        return None
    return block.values[absolute] * scale + (at if block.relative else 0.0)


def _meeting(
    block: ContourBlock, following: ContourBlock | None, at: complex, angle: float
) -> complex:
    """Return where a line of an angle meets the next one, which has its own and its end."""
    values = following.values if following else {}
    other = following.angle if following else None
    if other is None or not {"X", "Z"} <= values.keys() or following.relative:
        raise NotTranslated(
            f"line {block.line}: an angle alone needs X, Z and an angle in the next block"
        )
    end = complex(values["Z"], values["X"] / 2)
    one, two = rect(1, angle), rect(1, radians(other))
    cross = (one.conjugate() * two).imag
    if abs(cross) < SAME:
        raise NotTranslated(f"line {block.line}: the two lines are parallel and never meet")
    return at + one * ((end - at).conjugate() * two).imag / cross


def _segment(block: ContourBlock, start: complex, end: complex) -> ContourMove:
    if block.motion not in ARC_CODES:
        return ContourMove(start, end, block)
    sense = 1 if block.motion == "G3" else -1
    values = block.values
    if "R" in values:
        centre = _centre_by_radius(start, end, values["R"] * sense, block.line)
    elif not {"I", "K"} & values.keys():
        raise NotTranslated(f"line {block.line}: {block.motion} needs R, or I and K; a line is G1")
    else:
        centre = start + complex(values.get("K", 0.0), values.get("I", 0.0))
        if abs(abs(start - centre) - abs(end - centre)) > ROUNDED or centre == start:
            raise NotTranslated(f"line {block.line}: I and K are no centre of the arc to its end")
    return ContourMove(start, end, block, centre, sense)


def _centre_by_radius(start: complex, end: complex, radius: float, line: int) -> complex:
    """Return the centre of an arc; ``radius`` is below 0 for G2, or for more than half a turn."""
    chord = end - start
    if abs(chord) < SAME or abs(chord) / 2 > abs(radius) + ROUNDED:
        raise NotTranslated(f"line {line}: R{abs(radius):g} is too small for the arc to its end")
    height = sqrt(max(0.0, radius**2 - abs(chord) ** 2 / 4))
    return (start + end) / 2 + 1j * chord / abs(chord) * (height if radius > 0 else -height)


def _with_corner(side: ContourMove, following: ContourMove | None) -> list[ContourMove]:
    """Return a side and the chamfer or the rounding after it."""
    size, rounded = _corner_of(side)
    if not size:
        return [side]
    line = side.block.line
    if following is None or following.centre is not None or following.block.motion == "G0":
        raise NotTranslated(f"line {line}: a corner is broken between two lines of G1 only")
    one, two = following.start - side.start, following.end - following.start
    turn = phase(two / one)
    cut = size * tan(abs(turn) / 2) if rounded else size
    if abs(turn) < SAME or abs(abs(turn) - pi) < SAME or cut > min(abs(one), abs(two)) + SAME:
        raise NotTranslated(f"line {line}: a corner of {size:g} has no room between its lines")
    first, last = following.start - cut * one / abs(one), following.start + cut * two / abs(two)
    corner = ContourMove(first, last, side.block)
    if rounded:
        sense = 1 if turn > 0 else -1
        centre = first + 1j * sense * size * one / abs(one)
        corner = corner._replace(centre=centre, sense=sense)
    return [side._replace(end=first), corner]


def _corner_of(side: ContourMove) -> tuple[float, bool]:
    """Return the size of the corner after a line, 0 if it is sharp, and whether it is rounded."""
    values = side.block.values
    if side.centre is None and side.block.motion == "G1":
        for letter in (",R", "R", ",C", "C", "I", "K"):
            if values.get(letter):
                return abs(values[letter]), letter in (",R", "R")
    elif values.get(",R") or values.get(",C"):
        raise NotTranslated(f"line {side.block.line}: a corner is broken after a line of G1 only")
    return 0.0, False


def offset_by(segments: Sequence[ContourMove], by: complex) -> list[ContourMove]:
    return [
        s._replace(
            start=s.start + by,
            end=s.end + by,
            centre=None if s.centre is None else s.centre + by,
        )
        for s in segments
    ]
