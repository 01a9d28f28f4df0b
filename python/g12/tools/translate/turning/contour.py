# SPDX-License-Identifier: GPL-2.0-or-later
"""A turned contour: lines and arcs from a program's blocks.

A point is a complex number in the program's unit: Z is its real part, X as a radius its imaginary
one. Counter-clockwise is G3, as LinuxCNC has it in G18.
"""

from collections.abc import Mapping, Sequence
from math import sqrt
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


class ContourMove(NamedTuple):
    """A line, or an arc about ``centre``, counter-clockwise if ``sense`` is 1, else -1."""

    start: complex
    end: complex
    block: ContourBlock
    centre: complex | None = None
    sense: int = 0


def contour_of(blocks: Sequence[ContourBlock], start: complex) -> list[ContourMove]:
    at, moves = start, []
    for block in blocks:
        z = _coordinate(block, at.real, "Z", "W", 1.0)
        end = complex(z, _coordinate(block, at.imag, "X", "U", 0.5))
        if end != at or (block.motion in ARC_CODES and block.values.keys() & {"I", "K"}):
            moves.append(_move(block, at, end))
        at = end
    return moves


def _coordinate(
    block: ContourBlock, at: float, absolute: str, increment: str, scale: float
) -> float:
    if increment in block.values:
        return at + block.values[increment] * scale
    if absolute not in block.values:
        return at
    return block.values[absolute] * scale + (at if block.relative else 0.0)


def _move(block: ContourBlock, start: complex, end: complex) -> ContourMove:
    values = block.values
    if block.motion not in ARC_CODES:
        if corner := next((letter for letter in "RIK" if letter in values), ""):
            raise NotTranslated(
                f"line {block.line}: {corner} beside {block.motion}: write the corner's line or "
                "arc as a block"
            )
        return ContourMove(start, end, block)
    sense = 1 if block.motion == "G3" else -1
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


def offset_by(moves: Sequence[ContourMove], by: complex) -> list[ContourMove]:
    return [
        move._replace(
            start=move.start + by,
            end=move.end + by,
            centre=None if move.centre is None else move.centre + by,
        )
        for move in moves
    ]
