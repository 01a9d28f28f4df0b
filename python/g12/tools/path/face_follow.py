# SPDX-License-Identifier: GPL-2.0-or-later
"""The demand of a move on the kinematics' face on the slide and on C, in multiples of their limits.

LinuxCNC keeps X and Y of the face within their limits, and does not limit the slide and C there.
For a tool at the complex point z, beside the X line by p, the slide is at r with
r**2 = |z|**2 - p**2 and C at the angle of z / (r + i p). At the speed v and the acceleration a
along the path s, an axis at q(s) is accelerated by v**2 q'' + a q'. The operator may stop the feed
anywhere: then a is at least that of X or Y alone, less the centripetal part on an arc. On an arc
LinuxCNC limits the speed to what X and Y can accelerate.

Lengths are millimetres, angles radians, times seconds.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.part import C, X, Y
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move

SAMPLES_OF_MOVE = 48  # samples of a move, beside those where a line's C is accelerated most
SHORTEST_SAMPLED = 4e-3  # mm: a shorter line is not sampled
POLE_RADIUS = 1e-6  # mm: there C has no angle, and a line that ends there needs none
Derivatives = tuple[np.ndarray, np.ndarray]  # of an axis along the path: the first, the second


class FaceDemand(NamedTuple):
    """Multiples of the limits: accelerations of slide and C, their speeds, an arc's X and Y."""

    slide: float
    c: float
    slide_speed: float
    c_speed: float
    plane: float


def face_demand(path: Track, index: int, axes: LatheAxes, faster: float = 1.0) -> FaceDemand | None:
    """Return the demand of a move at its feed times a factor; None off the kinematics' face.

    X and Y together have more acceleration than each along a line: ``faster`` is of that.
    """
    move = path.moves[index]
    if not (axes.face and _crosses_face(move)):
        return None
    together = math.sqrt(2.0) if faster > 1.0 and move.kind != "arc" else 1.0
    return demand(move, faster * path.part_feed(index) / 60.0, path.part.centre, axes, together)


def _crosses_face(move: Move) -> bool:
    """Return whether a move crosses the face, and is long enough to be sampled."""
    change = [move.end[axis] - move.start[axis] for axis in (X, Y)]
    across = move.kind == "arc" or (move.kind == "feed" and math.hypot(*change) > SHORTEST_SAMPLED)
    return across and move.start[C] == move.end[C]


def demand(
    move: Move, speed: float, centre: float, axes: LatheAxes, share: float = 1.0
) -> FaceDemand:
    """Return the demand of a move across the face at a speed; the pole is at X ``centre``.

    The planner has a ``share`` of the acceleration of X.
    """
    bend = math.copysign(1.0 / move.radius, move.sweep) if move.kind == "arc" else 0.0
    plane, c_limit = share * move.acceleration * axes.x_acceleration, axes.c_radians
    centripetal = speed * speed * abs(bend) / plane
    square = speed * speed / max(1.0, centripetal)
    along = plane * math.sqrt(1.0 - min(1.0, centripetal) ** 2)
    (slide, slide_bent), (c, c_bent) = followed_along(move, bend, centre, axes.beside)
    return FaceDemand(
        float(np.nanmax(square * abs(slide_bent) + along * abs(slide))) / axes.slide.acceleration,
        float(np.nanmax(square * abs(c_bent) + along * abs(c))) / c_limit.acceleration,
        math.sqrt(square) * float(np.nanmax(abs(slide))) / axes.slide.speed,
        math.sqrt(square) * float(np.nanmax(abs(c))) / c_limit.speed,
        centripetal,
    )


def followed_along(
    move: Move, bend: float, centre: float, beside: float
) -> tuple[Derivatives, Derivatives]:
    """Return the derivatives of the slide's position and C's angle, per mm of a move."""
    points, heading, flat = _sampled(move, centre)
    radius = np.maximum(np.abs(points), 1e-12)
    polar = heading * points.conj() / radius
    slide, c = axis_derivatives(radius, polar.real, polar.imag, bend, beside)
    share = flat / move.length
    return (slide[0] * share, slide[1] * share**2), (c[0] * share, c[1] * share**2)


def axis_derivatives(
    radius: np.ndarray,
    along: np.ndarray,
    around: np.ndarray,
    bend: np.ndarray | float,
    beside: float = 0.0,
) -> tuple[Derivatives, Derivatives]:
    """Return the derivatives of the slide's position and C's angle on a path of curvature ``bend``.

    ``along`` and ``around`` are its direction's components along the radius and around the pole.
    At the pole they are nan.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        radius = np.where(radius < POLE_RADIUS, np.nan, radius)
        slide = np.sqrt(radius**2 - beside**2)
        turn, lift = around / radius, around * (around / radius - bend)
        first = radius * along / slide
        second = (along**2 + radius * lift - first**2) / slide
        turned = along * (bend - 2.0 * turn) / radius
        if beside:
            turn = turn + beside * first / radius**2
            turned = turned + beside * (second - 2.0 * first * along / radius) / radius**2
    return (first, second), (turn, turned)


def _sampled(move: Move, centre: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Return points (complex) of a move relative to the pole, headings there, its plane length."""
    ends = (move.start, move.end)
    start, end = (complex(position[X] - centre, position[Y]) for position in ends)
    parts = np.linspace(0.0, 1.0, SAMPLES_OF_MOVE)
    if move.kind == "arc":
        middle = complex(move.centre[X] - centre, move.centre[Y])
        arms = (start - middle) * np.exp(1j * move.sweep * parts)
        heading = math.copysign(1.0, move.sweep) * 1j * arms / abs(arms)
        return middle + arms, heading, abs(move.sweep) * abs(start - middle)
    line = end - start
    foot = -start * line.conjugate() / abs(line) ** 2
    most = abs(foot.imag) / math.sqrt(3.0)
    beside = np.clip(foot.real + most * np.array([-1.0, 0.0, 1.0]), 0.0, 1.0)
    points = start + line * np.append(parts, beside)
    return points, np.full(len(points), line / abs(line)), abs(line)
