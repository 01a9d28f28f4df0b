# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether C and the slide can follow what LinuxCNC plans on the kinematics' face.

LinuxCNC holds X and Y of the face to their limits, and asks nobody what the C axis has to do for
it. For a tool at the complex place z, beside the X line by p, the slide stands at r with
r**2 = |z|**2 - p**2 and C at the angle of z / (r + i p). At the speed v and the acceleration a on
the way s, an axis at q(s) is accelerated by v**2 q'' + a q'. The operator may stop the feed
anywhere: then a is at least what X or Y alone has, less what an arc needs towards its centre. On an
arc LinuxCNC is no faster than X and Y let it be.

Lengths are millimetres, angles radians, times seconds.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.tools.path.part import C, X, Y
from g12.tools.preview.moves import Move

PLACES = 48  # on a move that are looked at, and those where a line's C is accelerated most
STEP = 1e-3  # mm, of the derivatives
AT_CENTRE = 1e-6  # mm: there C has no angle, and a line that ends there needs none
ALLOWED = 1.1  # of a limit: the greatest value may lie between places that a planner looks at
FEED_STEP = 0.8  # of a feed: a part of a move may be made at so much less than can be followed
NEARLY = 0.95  # of a limit


class FollowLimits(NamedTuple):
    """Accelerations: of X or Y on the face, of the slide, of C; and C's speed."""

    plane: float
    slide: float
    c: float
    c_speed: float = math.inf


class Exceeded(NamedTuple):
    """An axis, and how many times its acceleration a move asks of it."""

    axis: str
    times: float


def follow_off(
    move: Move, speed: float, centre: float, beside: float, limits: FollowLimits
) -> Exceeded | None:
    """Return what a move on the face at a speed asks of an axis that it has not, if anything."""
    if move.start[C] != move.end[C] or not crosses_face(move):
        return None
    slide, c, _ = asked(move, speed, centre, beside, limits)
    for name, times in (("C", c), ("the slide", slide)):
        if times > ALLOWED:
            return Exceeded(name, times)
    return None


def is_slow_enough(
    move: Move, speed: float, centre: float, beside: float, limits: FollowLimits
) -> bool:
    """Tell whether a move on the face that is slower than asked for need not be faster.

    X and Y together have more acceleration than each along a line.
    """
    if move.kind != "arc":
        limits = limits._replace(plane=math.hypot(limits.plane, limits.plane))
    return not crosses_face(move) or any(
        times > NEARLY for times in asked(move, speed / FEED_STEP, centre, beside, limits)
    )


def asked(
    move: Move, speed: float, centre: float, beside: float, limits: FollowLimits
) -> tuple[float, float, float]:
    """Return how many times the slide's and C's accelerations, and C's speed, a move asks for."""
    bent = 1.0 / move.radius if move.kind == "arc" else 0.0
    square = min(speed * speed, limits.plane / bent) if bent else speed * speed
    along = math.sqrt(max(0.0, limits.plane**2 - (square * bent) ** 2))
    slide, c = derivatives(move, centre, beside)
    turning = math.sqrt(square) * np.nanmax(abs(c[0])) / limits.c_speed
    slide, c = (
        np.nanmax(square * abs(second) + along * abs(first)) for first, second in (slide, c)
    )
    return slide / limits.slide, c / limits.c, turning


def crosses_face(move: Move) -> bool:
    """Tell whether a move goes across the face, and is long enough to be looked at."""
    way = [move.end[axis] - move.start[axis] for axis in (X, Y)]
    return move.kind == "arc" or (move.kind == "feed" and math.hypot(*way) > 4 * STEP)


def derivatives(move: Move, centre: float, beside: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return first and second derivatives along a move, of the slide's place and of C's angle."""
    step = STEP / move.length
    at = np.clip(looked_at(move, centre), step, 1.0 - step)
    seen = [places(move, at + change, centre) for change in (-step, 0.0, step)]
    slides = [np.sqrt(np.maximum(abs(z) ** 2 - beside**2, 0.0)) for z in seen]
    with np.errstate(invalid="ignore", divide="ignore"):
        turned = [z / (slide + 1j * beside) for z, slide in zip(seen, slides)]
        angles = [np.angle(after / before) for before, after in zip(turned, turned[1:])]
    moved = [after - before for before, after in zip(slides, slides[1:])]
    return [
        ((before + after) / (2 * STEP), (after - before) / STEP**2)
        for before, after in (moved, angles)
    ]


def looked_at(move: Move, centre: float) -> np.ndarray:
    """Return the parts of a move that are looked at."""
    parts = np.linspace(0.0, 1.0, PLACES)
    if move.kind == "arc":
        return parts
    start, end = places(move, np.array([0.0, 1.0]), centre)
    way = end - start
    foot = -start * np.conj(way) / abs(way) ** 2
    most = abs(foot.imag) / math.sqrt(3.0)
    return np.append(parts, foot.real + most * np.array([-1.0, 0.0, 1.0]))


def places(move: Move, parts: np.ndarray, centre: float) -> np.ndarray:
    """Return the places (complex) after parts of a move, seen from the spindle's centre."""
    start, end = (complex(place[X] - centre, place[Y]) for place in (move.start, move.end))
    found = start + (end - start) * parts
    if move.kind == "arc":
        middle = complex(move.centre[X] - centre, move.centre[Y])
        found = middle + (start - middle) * np.exp(1j * move.sweep * parts)
    return np.where(abs(found) < AT_CENTRE, 0.0, found)
