# SPDX-License-Identifier: GPL-2.0-or-later
"""How fast C turns in a section, and how it turns in place where the tool is at the centre.

Angles are degrees, speeds degrees/s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.track import Track, rate
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.section_plane import Plane
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.result.tolerances import LEVEL

TURN = 1e-6  # mm along the part: C turns in place
HALF_TURN = 180.01  # the shorter way is no longer
WINDOW = 0.01  # s of a run, over which C's speed is taken: samples lie a servo period apart


class InPlace(NamedTuple):
    """Turns of C where the tool stays on its place on the part: degrees and seconds in all."""

    degrees: float
    seconds: float


class Turns(NamedTuple):
    """The highest speed of C, that asked of it where it turns in place, and how far it does.

    ``too_far`` is the first that is more than half a turn: its line and its degrees.
    """

    speed: float
    asked: float
    in_place: InPlace
    too_far: tuple[int, float] | None


def turns_of(
    section: SectionContour,
    plane: Plane,
    moves: Sequence[Move],
    path: Track,
    real: Followed | None,
) -> Turns:
    """Return how C turns in a section."""
    own = range(section.at, section.end)
    still = [index for index in own if turns_in_place(moves[index], path.part_length(index))]
    speed = run_speed(own, real) if real else emitted_speed(own, path, plane)
    asked = max((rate(moves[index], 0.0) for index in still), default=0.0)
    turned = ((moves[index].line, abs(turned_by(moves[index]))) for index in still)
    far = (each for each in turned if each[1] > HALF_TURN)
    return Turns(speed, asked, below_face(section, still, moves, path), next(far, None))


def turns_in_place(move: Move, length: float) -> bool:
    """Tell whether C turns while the tool stays where it is on the part."""
    return move.kind != "rapid" and turned_by(move) != 0.0 and length < TURN


def turned_by(move: Move) -> float:
    """Return how far a move turns C."""
    return move.end[C] - move.start[C]


def below_face(
    section: SectionContour, still: Sequence[int], moves: Sequence[Move], path: Track
) -> InPlace:
    """Return how far and how long C turns in place where the tool is below the part's face."""
    face = moves[section.at].start[section.third] - section.height
    lowest = min(moves[index].end[section.third] for index in range(section.at, section.end))
    top = face - LEVEL if lowest < face - LEVEL else math.inf
    low = [index for index in still if moves[index].end[section.third] < top]
    return InPlace(sum(abs(turned_by(moves[i])) for i in low), sum(path.seconds(i) for i in low))


def run_speed(own: range, real: Followed) -> float:
    """Return the highest speed of C in a run."""
    mask = np.isin(real.move, own)
    angle, time = real.positions[mask, C], real.time[mask]
    later = np.searchsorted(time, time + WINDOW)
    fitting = later < len(time)
    later = later[fitting]
    turned, seconds = angle[later] - angle[fitting], time[later] - time[fitting]
    return float((np.abs(turned) / seconds).max(initial=0.0))


def emitted_speed(own: range, path: Track, plane: Plane) -> float:
    """Return the highest speed of C at the programmed feeds, as far as the axes allow."""
    vertices = slice(path.vertices(own[0]).start, path.vertices(own[-1]).stop)
    positions, seconds = path.positions[vertices], np.maximum(np.diff(path.time[vertices]), 1e-12)
    turned = np.diff(plane.angles(positions, path.part.beside))
    return float((np.abs(turned) / seconds).max(initial=0.0))
