# SPDX-License-Identifier: GPL-2.0-or-later
"""The pole, the spindle's centre, and where the slide and C have to be for a point of the plane.

At the pole C has no angle of its own. A path that comes closer to it than ``pole_radius`` is
rerouted through it exactly: in along a radius, a rotation of C at the pole, out along another. A
line that close is nearly such a radius. Of an arc the portion next to the pole is replaced, as far
as a radius deviates from it by a fifth of ``pole_radius`` at most.

A tool beside the X line does not pass the pole. It is ``beside`` (POLAR_TOOL_OFFSET, Fanuc's
parameter 5464) away from the line on which the slide moves it, above zero on the side to which C
words grow. For the tool to be at the distance r from the pole the slide has to be at s, and C at
less than the angle of the point:

                       . * tool           s = sqrt(r**2 - beside**2)
                r . '    |
             . '         | beside         the slide's direction e is turned from the radius
        . '              |                by -asin(beside / r)
    pole +---------------+---> e
                 s

No point nearer to the pole than ``beside`` can be reached, and none is commanded:
`check_pole_distance` refuses a path within the tolerance of that circle, and segments deviate by
less.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, sqrt

from g12.compensation.contour import Contour, PathElement, PlaneMove, Plunge
from g12.errors import number
from g12.geometry.curve import Arc, Line

POLE = 0j
FLAT_SHARE = 0.2  # of the pole_radius: greatest deviation from an arc of the radii that replace it


def slide_at(point: complex, beside: float) -> tuple[float, complex]:
    """Return the slide's position for a point of the plane, and its direction in the plane."""
    square = (point * point.conjugate()).real
    if not square:
        return 0.0, 1 + 0j
    slide = sqrt(max(0.0, square - beside * beside))
    return slide, point * complex(slide, -beside) / square


def along_and_around(direction: complex, slide_direction: complex) -> tuple[float, float]:
    """Return the components of a direction along the slide's and to its left."""
    turned = direction * slide_direction.conjugate()
    return turned.real, turned.imag


def check_pole_distance(
    contour: Contour, path: Sequence[PathElement], beside: float, tolerance: float
) -> None:
    """Refuse a path that comes nearer to the pole than the tool can."""
    least = abs(beside) + tolerance
    for move in (element for element in path if isinstance(element, PlaneMove)):
        nearest = move.curve.distance(POLE)
        if nearest < least:
            contour.refuse(
                move.line,
                f"the tool's centre would come to {number(nearest)} from the spindle's centre: it "
                f"is {number(abs(beside))} beside X's line (POLAR_TOOL_OFFSET) and comes no "
                f"nearer than {number(least)}",
            )


def through_pole(
    contour: Contour, path: Sequence[PathElement], pole_radius: float, refused: bool
) -> list[PathElement]:
    """Return the path with each move within ``pole_radius`` of the pole rerouted through it."""
    rerouted: list[PathElement] = []
    for move in path:
        portions = _rerouted(move, pole_radius) if isinstance(move, PlaneMove) else None
        if portions is None:
            rerouted.append(move)
        elif refused:
            contour.refuse(
                move.line,
                "the path of the tool's centre runs through the spindle's centre "
                "(POLAR_POLE = refuse)",
            )
        else:
            rerouted.extend(portions)
    return rerouted


def _rerouted(move: PlaneMove, pole_radius: float) -> list[PathElement] | None:
    curve = move.curve
    ends = [float(k) for k, end in enumerate((curve.start, curve.end)) if abs(end) <= pole_radius]
    if isinstance(curve, Line):
        return _replaced(move, ends[:1] or _line_passes(curve, pole_radius), 1.0, pole_radius)
    # A chord of the angle 2 asin(s) from the pole has the sagitta radius s**2 / 2.
    sine = min(0.5, sqrt(2.0 * FLAT_SHARE * pole_radius / curve.radius))
    half = 2.0 * asin(sine) / abs(curve.sweep)
    inside = [
        share
        for share in _arc_passes(curve, pole_radius)
        if all(abs(share - end) > half for end in ends)
    ]
    return _replaced(move, sorted(ends + inside), half, pole_radius)


def _line_passes(line: Line, pole_radius: float) -> list[float]:
    """Return the share of a line at which it passes the pole, if it does within ``pole_radius``."""
    share = line.length_to(POLE) / line.length
    return [share] if 0.0 < share < 1.0 and line.distance(POLE) <= pole_radius else []


def _arc_passes(arc: Arc, pole_radius: float) -> list[float]:
    """Return the share of an arc at which it passes the pole, if it does within ``pole_radius``."""
    if abs(abs(arc.centre) - arc.radius) > pole_radius:
        return []
    share = arc.share_towards(POLE)
    return [share] if share < 1.0 else []


def _replaced(
    move: PlaneMove, passes: list[float], half: float, pole_radius: float
) -> list[PathElement] | None:
    """Return the move with its portions up to ``half`` from each pass replaced by radii."""
    if not passes:
        return None
    moves, done = list[PathElement](), 0.0
    for share in passes:
        if share - half > done:
            moves.append(move.portion(done, share - half))
            done = share - half
        moves.extend(_radius(move, done, share, pole_radius))
        done = min(share + half, 1.0)
        moves.extend(_radius(move, done, share, pole_radius, outwards=True))
    if done < 1.0:
        moves.append(move.portion(done, 1.0))
    return moves


def _radius(
    move: PlaneMove, share: float, at_pole: float, pole_radius: float, outwards: bool = False
) -> list[PathElement]:
    """Return the radius between a point of a move and the pole: none for a point at the pole."""
    point, level, pole_level = move.curve.point(share), move.level(share), move.level(at_pole)
    h0, h1 = (pole_level, level) if outwards else (level, pole_level)
    if abs(point) > pole_radius:
        radius = Line(POLE, point) if outwards else Line(point, POLE)
        return [move._replace(curve=radius, h0=h0, h1=h1)]
    return [] if h0 == h1 else [Plunge(move.line, move.feed, h0, h1)]
