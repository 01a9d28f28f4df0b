# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: rapids through it, plunges, and what remains of a bar.

Lengths are mm, areas mm². Places are those of the part: on a lathe's face they turn with C, on a
cylinder they are those of its unrolled surface. Only cutters with a diameter count, on a lathe
those that cut sections.
"""

import math
from collections.abc import Iterator

import numpy as np
from shapely.geometry import LineString, Point
from shapely.ops import unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, SAME_LEVEL
from g12.tools.path.part import X, Z, is_sideways
from g12.tools.verify.compare.section import Plane, plane_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.mistakes.neighbours import judge_circles
from g12.tools.verify.result.finding import Finding, also_in
from g12.tools.verify.sections.outline import outlines_of
from g12.tools.verify.unjudged_rapids import unjudged_rapids
from g12.tools.verify.walls import beyond
from g12.tools.verify.workpiece import PartView, Program, Workpiece

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock
Place = tuple[float, float, float]


def judge_material(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield what a program does to what it is cut from."""
    yield from once_a_line(rapids_through(workpiece))
    yield from first_way(workpiece)
    yield from inside_surfaces(workpiece)
    yield from above_surfaces(workpiece)
    yield from judge_circles(workpiece.program.circles, workpiece.material)
    yield from unjudged_rapids(workpiece)
    yield from judged_in_stock(workpiece) if workpiece.stock else ()
    yield from assumptions(workpiece)


def once_a_line(found: Iterator[Finding]) -> list[Finding]:
    """Return the first finding of each line."""
    return list({each.line: each for each in reversed(list(found))}.values())[::-1]


# ---------------------------------------------------------------- rapids


def rapids_through(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids that go through material."""
    program, known = workpiece.program, workpiece.known
    rapids = [i for i in known if program.moves[i].kind == "rapid"]
    for view in workpiece.views:
        for index in (each for each in rapids if view.judges(program.moves[each])):
            touch = workpiece.touched(view, index) if index <= view.until else None
            if touch:
                at, to = (place_at(point) for point in touch.points[[0, -1]])
                values = {
                    "at": words_of(program, view, at),
                    "to": words_of(program, view, to),
                    "area": touch.area,
                    "path": touch.points,
                    "surface": view.surface,
                }
                code = "rapid-through" if at[:2] != to[:2] else "rapid-into"
                yield Finding(code, program.line(index), values, at)


def words_of(program: Program, view: PartView, point: Place) -> tuple[tuple[str, float], ...]:
    """Return a place of the part as words: X Y Z of a mill, X C Z of a lathe."""
    if not view.part.turning:
        return tuple(zip("XYZ", point))
    diameters = [section.diameters for section in program.sections]
    diameters += [call.diameters for call in program.holes]
    double = 2 if any(diameters) else 1
    if view.surface:
        around, along, level = point
        x, c, z = level - view.part.centre, math.degrees(around / view.surface), along
    else:
        x, z, c = math.hypot(*point[:2]), point[2], math.degrees(math.atan2(point[1], point[0]))
    return ("X", double * x), ("C", c), ("Z", z)


def first_way(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield that the way of a first rapid that ends in a part is not judged."""
    program, view = workpiece.program, workpiece.views[0]
    for first in list(workpiece.known)[:1]:
        place = program.end(first)
        if program.moves[first].kind == "rapid" and place[Z] < view.material.top - SAME_LEVEL:
            values = {"at": words_of(program, view, place)}
            yield Finding("first-rapid", program.line(first), values, place)


def place_at(point: np.ndarray) -> Place:
    """Return a point (3,) as a place."""
    x, y, z = map(float, point)
    return x, y, z


# ---------------------------------------------------------------- what is assumed


def inside_surfaces(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that begin inside of its surface, where nothing is cut."""
    for section in workpiece.program.sections:
        first = workpiece.program.moves[section.at]
        inside = (
            section.surface and plane_of(section, first).base + section.surface - first.start[X]
        )
        if inside > SAME_LEVEL and not is_cut_before(section, workpiece):
            values = {"code": section.code, "radius": section.surface, "inside": inside}
            yield Finding("inside-surface", section.line, values, first.start[:3])


def above_surfaces(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that cut nothing of it, or nothing of a bar."""
    bar = workpiece.stock.diameter / 2 if workpiece.stock else 0.0
    for section in workpiece.program.sections:
        outside = lowest_over_axis(workpiece.program, section) + SAME_LEVEL
        if section.surface and outside > section.surface:
            values = {"radius": section.surface, "size": outside - SAME_LEVEL - section.surface}
            yield Finding("above-surface", section.line, values)
        elif section.surface and bar and outside > bar:
            yield Finding("no-stock-met", section.line)


def lowest_over_axis(program: Program, section: SectionContour) -> float:
    """Return how far a section on a cylinder stays from the spindle's axis."""
    own = program.moves[section.at : section.end]
    base = plane_of(section, own[0]).base
    return min((move.end[X] for move in own if move.kind != "rapid"), default=math.inf) - base


def is_cut_before(section: SectionContour, workpiece: Workpiece) -> bool:
    """Tell whether something is cut where a section begins."""
    view = next(view for view in workpiece.views if view.surface == round(section.surface, 6))
    point = view.part.points(np.array(workpiece.program.moves[section.at].start))[0]
    region = Point(point[:2]).buffer(workpiece.program.radius(section.at) or ALLOWED)
    return view.material.is_cut(region, point[2], section.at)


def assumptions(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    if workpiece.holes:
        line, place, _ = workpiece.holes[0]
        more = also_in({hole.line for hole in workpiece.holes} - {line})
        values = {"at": tuple(zip("XYZ", place)), "more": more}
        yield Finding("bored-assumed", line, values, place)


# ---------------------------------------------------------------- in a stock that is given


def judged_in_stock(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield plunges, what meets no stock, cuts below a block, and what remains of a bar."""
    program, view = workpiece.program, workpiece.views[0]
    moves = program.moves
    fed = [
        index
        for index in workpiece.known
        if moves[index].kind != "rapid" and program.radius(index) and view.judges(moves[index])
    ]
    yield from once_a_line(filter(None, (plunge(workpiece, index) for index in fed)))
    cuts = [(each.line, each.at, each.end) for each in program.on_face]
    cuts += [(target.source.line, block.at, block.end) for block, target in program.circles]
    drilled = (call for call in program.holes if not call.is_side)
    cuts += [(call.line, call.moves.start, call.moves.stop) for call in drilled]
    for line, at, end in cuts:
        if not any(meets_stock(workpiece, index) for index in range(at, end)):
            yield Finding("no-stock-met", line)
    if workpiece.bottom is not None and fed:
        lowest = min(fed, key=lambda index: moves[index].end[Z])
        below = workpiece.bottom - moves[lowest].end[Z]
        if below > SAME_LEVEL:
            place = program.end(lowest)
            yield Finding("below-block", program.line(lowest), {"size": below}, place)
    if workpiece.stock.diameter:
        yield from filter(None, (remaining(workpiece, section) for section in program.on_face))
    for call in (each for each in program.holes if each.is_side):
        first, sides = call.moves.start, (each for each in workpiece.views if each.surface)
        if program.radius(first) and any(side.judges(moves[first]) for side in sides):
            continue  # its rapids are held to the bar
        level, bar = (
            call.length("surface_diameter") + 2 * call.length("retract"),
            workpiece.stock.diameter,
        )
        if level < bar - SAME_LEVEL:  # its tool goes by rapid to where the bar is
            values = {"level": level, "bar": bar}
            yield Finding("in-the-bar", call.line, values, file=call.file)


def plunge(workpiece: Workpiece, index: int) -> Finding | None:
    """Return that a move at feed goes straight down into the stock, if it does."""
    program, move = workpiece.program, workpiece.program.moves[index]
    if is_sideways(move) or move.end[Z] >= move.start[Z]:
        return None
    place = program.end(index)
    cutter = Point(place[:2]).buffer(program.radius(index))
    share = workpiece.material.standing(cutter, place[Z], index).area / cutter.area
    if share <= LEAST_SHARE:
        return None
    of = " of the face" if workpiece.stock.diameter else ""
    values = {"share": 100 * share, "at": tuple(zip("XY", place)), "of": of}
    return Finding("plunge-into-stock", program.line(index), values, place)


def meets_stock(workpiece: Workpiece, index: int) -> bool:
    """Tell whether a move's cutter comes into the stock."""
    radius, move = workpiece.program.radius(index), workpiece.program.moves[index]
    if not radius or move.end[Z] >= workpiece.top:
        return False
    points = workpiece.program.part.polyline(move)[:, :2]
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return line.distance(workpiece.shape) < radius - SAME_LEVEL


def remaining(workpiece: Workpiece, section: SectionContour) -> Finding | None:
    """Return what remains of a bar beyond a contour that it is to be cut away to, if anything."""
    moves = workpiece.program.moves
    level = min(moves[index].end[Z] for index in range(section.at, section.end))
    plane = Plane(section, moves[section.at])
    wanted = unary_union([beyond(each, plane, workpiece.shape) for each in outlines_of(section)])
    if level < workpiece.top - SAME_LEVEL:
        left = workpiece.material.standing(wanted, level)
        wanted = left.buffer(-ALLOWED).buffer(ALLOWED)  # slivers are the contour's rounding
    if wanted.area <= LEAST_AREA:
        return None
    place = (*wanted.representative_point().coords[0], level)
    values = {"area": wanted.area, "level": level - workpiece.top, "shape": wanted}
    return Finding("bar-remains", section.line, values, place)
