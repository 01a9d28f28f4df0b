# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar coordinate interpolation: a contour in the flat X-C plane becomes moves of an X slide and a C axis.

A section is collected in a :class:`~g12.polar.contour.Contour`, then planned as a whole by :func:`plan`;
what cannot be cut is refused there, before anything moves. Lengths are in program units throughout.
"""

from __future__ import annotations

from typing import NamedTuple

from g12.polar.contour import Contour


class Settings(NamedTuple):
    """What the machine and its owner want of a section; lengths in program units."""

    chord: float  # deviation of the pieces from the contour; see shares()
    least_x: float  # 0.001 mm: no piece changes X by less, other than not at all
    pole_feed: float  # deg/min of a turn in place at X0: the C axis's MAX_VELOCITY
    pole_refused: bool = False  # POLAR_POLE = refuse


class Run(NamedTuple):
    """Moves of one block: G1 moves in ``axes``, one after the other, all in G90 G94.

    ``axes`` is "XC", "XCZ" or "Z". Each piece is ``(x, c, z, feed)``: X radius value, C in degrees, continuous
    over the section (it may leave 0..360), F as G94 wants it: for the X and Z part of the move, or in degrees
    per minute where neither changes. A piece that keeps X repeats the same number.
    """

    line: int
    axes: str
    pieces: list[tuple[float, float, float, float]]


class Plan(NamedTuple):
    """The moves of a section: ``steps`` holds each :class:`Run`, and each mark's action, in order.

    ``c`` is the C axis in degrees at the end.
    """

    steps: list[Run | object]
    c: float


def shares(tolerance: float) -> tuple[float, float]:
    """Return the parts of a deviation that are left to the chords and to the blending (the P of G64)."""


def plan(contour: Contour, settings: Settings, *, c: float) -> Plan:
    """Return the moves of a whole section that starts with the C axis at ``c`` degrees.

    Raises Refusal, naming the blocks by their lines, when the contour cannot be cut as programmed.
    """


def resume(contour: Contour) -> Contour:
    """Return an empty contour that goes on where a planned one ended, compensation included.

    For a section that is cut in two by a block that waits for the machine. Plan it with ``c`` of the first
    part's plan.
    """
