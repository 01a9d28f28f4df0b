# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to a stock that is given: plunges, misses, edges, and what remains of it.

Lengths are mm in machine coordinates, areas mm². Only cutters with a diameter count.
"""

import cmath
import math
from collections.abc import Iterator, Sequence

import numpy as np
from shapely.affinity import rotate
from shapely.geometry import LineString, Point, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, NOTHING, SAME_LEVEL
from g12.tools.path.part import Z, disc, is_sideways
from g12.tools.verify.compare.plane import plane_of, turned_plane
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding, once_a_line
from g12.tools.verify.sections.outline import outlines_of
from g12.tools.verify.walls import FAR, beyond, flat_circles
from g12.tools.verify.workpiece import Workpiece

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock


def judge_in_stock(workpiece: Workpiece, cuts: Sequence[MeasuredCut]) -> Iterator[Finding]:
    """Yield plunges, what meets no stock or its edge, cuts below a block, and what remains."""
    subject, view = workpiece.subject, workpiece.views[0]
    commanded, moves = subject.commanded, subject.moves
    fed = [
        index
        for index in np.flatnonzero(subject.ends_known)
        if moves[index].kind != "rapid" and subject.cutter(index) and view.meets(subject, index)
    ]
    drilled = {index for call in commanded.holes for index in call.moves}
    plunges = (_plunge(workpiece, index) for index in fed if index not in drilled)
    yield from once_a_line(filter(None, plunges))
    for cut in (each for each in cuts if not each.surface and subject.cutter(each.own.start)):
        if not any(_meets_stock(workpiece, index) for index in cut.own):
            yield Finding("no-stock-met", cut.line, file=cut.file)
    yield from once_a_line(_over_the_edge(workpiece)) if workpiece.stock.is_whole else ()
    lowest = min(fed, key=lambda index: moves[index].end[Z], default=0)
    if workpiece.bottom is not None and fed:
        below = workpiece.bottom - moves[lowest].end[Z]
        if below > SAME_LEVEL:
            yield Finding("below-block", subject.line(lowest), {"size": below}, subject.end(lowest))
    if workpiece.stock.diameter:
        yield from filter(None, (_remaining(workpiece, *each) for each in _cut_away(workpiece)))


def _over_the_edge(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the pockets and the holes of which a portion lies outside of the stock, or in front."""
    subject, whole = workpiece.subject, workpiece.shape.convex_hull
    pockets = [target for _, target in flat_circles(subject) if target.wall.inside]
    found = [(pocket.line, tuple(pocket.wall.origin), pocket.wall.radius) for pocket in pockets]
    for call in subject.commanded.shapes:
        if call.name == "polar_pocket":
            centre = _on_part(call, complex(call.x(), call.length("c")))
            found.append((call.line, (centre.real, centre.imag), call.length("diameter") / 2))
    for call in subject.commanded.holes:
        fed = (index for index in call.moves if subject.moves[index].kind != "rapid")
        found += [(call.line, subject.end(index), call.cutter) for index in fed if not call.is_side]
        if call.is_side and abs(call.length("z")) < call.cutter - ALLOWED:
            yield Finding("over-the-edge", call.line)
    for line, place, radius in found:
        area = disc(place, radius - ALLOWED) if radius > ALLOWED else NOTHING
        if area.intersects(whole) and not whole.covers(area):
            yield Finding("over-the-edge", line)


def _on_part(call: SubCall, point: complex) -> complex:
    """Return a point of a shape on the part."""
    return complex(turned_plane(math.radians(call.zero[2]), call.zero[1]).on_part(point))


def _cut_away(workpiece: Workpiece) -> Iterator[tuple[int, range, BaseGeometry]]:
    """Yield the cuts that a bar is to be cut away by: the line, the moves, the area."""
    subject, bar = workpiece.subject, workpiece.shape
    for section in subject.commanded.on_face:
        plane = plane_of(section, subject.moves[section.at])
        areas = [beyond(outline, plane, bar) for outline in outlines_of(section)]
        yield section.line, range(section.at, section.end), unary_union(areas)
    for call in (each for each in subject.commanded.shapes if each.name == "polar_polygon"):
        beside, sides = box(call.length("across_flats") / 2, -FAR, FAR, FAR), call.given["sides"]
        angles = math.radians(call.given.get("angle", 0.0)) + math.tau / sides * np.arange(sides)
        turns = (cmath.phase(_on_part(call, cmath.rect(1.0, angle))) for angle in angles)
        flats = [rotate(beside, turn, origin=(0, 0), use_radians=True) for turn in turns]
        yield call.line, call.moves, bar.intersection(unary_union(flats))


def _plunge(workpiece: Workpiece, index: int) -> Finding | None:
    subject, move = workpiece.subject, workpiece.subject.moves[index]
    if is_sideways(move) or move.end[Z] >= move.start[Z] or not _meets_stock(workpiece, index):
        return None
    place = subject.end(index)
    cutter = Point(place[:2]).buffer(subject.cutter(index))
    share = workpiece.material.standing(cutter, place[Z], index).area / cutter.area
    if share <= LEAST_SHARE:
        return None
    at, beside, _ = workpiece.views[0].words(subject, index, place)
    values = {"share": 100 * share, "at": (at, beside)}
    return Finding("plunge-into-stock", subject.line(index), values, place)


def _meets_stock(workpiece: Workpiece, index: int) -> bool:
    subject = workpiece.subject
    cutter, move = subject.cutter(index), subject.moves[index]
    if move.end[Z] >= workpiece.top:
        return False
    points = subject.part.polyline(move)[:, :2]
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return line.distance(workpiece.shape) < cutter - SAME_LEVEL


def _remaining(workpiece: Workpiece, line: int, own: range, region: BaseGeometry) -> Finding | None:
    """Return what remains of a region of the bar that a cut is to cut away, if anything."""
    level = min(workpiece.subject.moves[index].end[Z] for index in own)
    if level < workpiece.top - SAME_LEVEL:
        uncut = workpiece.material.standing(region, level)
        region = uncut.buffer(-ALLOWED).buffer(ALLOWED)  # slivers are the contour's rounding
    if region.area <= LEAST_AREA:
        return None
    place = (*region.representative_point().coords[0], level)
    values = {"area": region.area, "level": level - workpiece.top, "shape": region}
    return Finding("bar-remains", line, values, place)
