# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: rapids through it, plunges, and what remains of a bar.

A rapid is held to the material where the tool's position and the material there are known. Without
a stock the part is known where the program cuts, and as far as a wall is assumed around that.

Lengths are mm, areas mm². Places are those of the part: on a lathe's face they turn with C, on a
cylinder they are those of its unrolled surface. Only cutters with a diameter count, on a lathe
those that cut sections.
"""

import math
from collections.abc import Iterable, Iterator

import numpy as np
from shapely.geometry import LineString, Point
from shapely.ops import unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, SAME_LEVEL, going, portions
from g12.tools.path.part import X, Z, is_sideways, swept
from g12.tools.verify.compare.plane import plane_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.mistakes.neighbours import judge_circles
from g12.tools.verify.result.finding import Finding, also_in
from g12.tools.verify.sections.outline import outlines_of
from g12.tools.verify.walls import beyond
from g12.tools.verify.workpiece import PartView, Program, Workpiece, tools_of

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock
Place = tuple[float, float, float]


def judge_material(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield what a program does to what it is cut from."""
    yield from _once_a_line(rapids_through(workpiece))
    yield from _first_rapid(workpiece)
    yield from _inside_surfaces(workpiece)
    yield from _above_surfaces(workpiece)
    yield from judge_circles(workpiece.program.circles, workpiece.material)
    yield from _unjudged_rapids(workpiece)
    yield from _judged_in_stock(workpiece) if workpiece.stock else ()
    yield from assumptions(workpiece)


def _once_a_line(found: Iterator[Finding]) -> list[Finding]:
    return list({each.line: each for each in reversed(list(found))}.values())[::-1]


# ---------------------------------------------------------------- rapids


def rapids_through(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids that go through material."""
    program, known = workpiece.program, workpiece.known
    rapids = [i for i in known if program.moves[i].kind == "rapid"]
    for view in workpiece.views:
        for index in (each for each in rapids if view.judges(program, each)):
            touch = workpiece.touched(view, index) if index <= view.until else None
            if touch:
                at, to = (_place_at(point) for point in touch.points[[0, -1]])
                values = {
                    "at": _words_of(program, view, at),
                    "to": _words_of(program, view, to),
                    "area": touch.area,
                    "path": touch.points,
                    "surface": view.surface,
                }
                code = "rapid-through" if at[:2] != to[:2] else "rapid-into"
                yield Finding(code, program.line(index), values, at)


def _words_of(program: Program, view: PartView, point: Place) -> tuple[tuple[str, float], ...]:
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


def _first_rapid(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield that a first rapid which ends in a part is not judged up to its end."""
    program, view = workpiece.program, workpiece.views[0]
    for first in list(workpiece.known)[:1]:
        place = program.end(first)
        if program.moves[first].kind == "rapid" and place[Z] < view.material.top - SAME_LEVEL:
            values = {"at": _words_of(program, view, place)}
            yield Finding("first-rapid", program.line(first), values, place)


def _place_at(point: np.ndarray) -> Place:
    x, y, z = map(float, point)
    return x, y, z


def _unjudged_rapids(workpiece: Workpiece) -> Iterator[Finding]:
    program, stock, known = workpiece.program, workpiece.stock, workpiece.known
    rapids = [i for i, move in enumerate(program.moves) if move.kind == "rapid" and i - 1 in known]
    for view in workpiece.views:
        own = [index for index in rapids if view.judges(program, index)]
        ends_known = [index for index in own if index in known]
        after = (i for i in ends_known if view.whole and _may_touch(workpiece, view, i))
        yield from _listed("rapid-after-cuts", program, after)
        if not (stock and (stock.diameter or stock.size)):
            yield from _listed(
                "rapid-beside", program, (i for i in ends_known if _beside(program, view, i))
            )
        leaving = (i for i in own if i not in known and _is_within(program, view, i))
        yield from _listed("rapid-by-machine", program, leaving)
    both = tools_of(program, side=True) & tools_of(program, side=False)
    turned = (i for i in rapids if i in known and program.points_sideways[i] is None)
    yield from _listed(
        "rapid-turned", program, (i for i in turned if program.moves[i].tool in both)
    )


def _may_touch(workpiece: Workpiece, view: PartView, index: int) -> bool:
    """Tell whether a rapid only goes through what cuts of another view may have removed."""
    whole = view._replace(material=view.whole or view.material)
    judged = index <= view.until and workpiece.touched(view, index)
    return not judged and workpiece.touched(whole, index) is not None


def _listed(code: str, program: Program, moves: Iterable[int]) -> Iterator[Finding]:
    """Yield one entry with the lines of moves, if there are any."""
    lines = sorted({program.line(index) for index in moves})
    if lines:
        yield Finding(code, lines[0], {"lines": ", ".join(map(str, lines))})


def _beside(program: Program, view: PartView, index: int) -> bool:
    """Tell whether a rapid goes, below the part's top, where nothing is cut or assumed."""
    radius, top = program.radius(index), view.material.top - SAME_LEVEL
    points = program.points(index, view.part)
    if not radius or points[:, 2].min() > top:
        return False
    low = [each.line for each in portions(going(points)) if each.high <= top]
    return bool(low) and not view.material.covers(swept(low, radius))


def _is_within(program: Program, view: PartView, index: int) -> bool:
    start = view.part.points(np.array(program.moves[index].start))[0]
    return bool(start[2] < view.material.top - SAME_LEVEL)


# ---------------------------------------------------------------- what is assumed


def _inside_surfaces(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that begin inside of its surface, where nothing is cut."""
    for section in workpiece.program.sections:
        first = workpiece.program.moves[section.at]
        inside = (
            section.surface and plane_of(section, first).base + section.surface - first.start[X]
        )
        if inside > SAME_LEVEL and not _is_cut_before(section, workpiece):
            values = {"code": section.code, "radius": section.surface, "inside": inside}
            yield Finding("inside-surface", section.line, values, first.start[:3])


def _above_surfaces(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that cut nothing of it, or nothing of a bar."""
    bar = workpiece.stock.diameter / 2 if workpiece.stock else 0.0
    for section in workpiece.program.sections:
        outside = _lowest_over_axis(workpiece.program, section) + SAME_LEVEL
        if section.surface and outside > section.surface:
            values = {"radius": section.surface, "size": outside - SAME_LEVEL - section.surface}
            yield Finding("above-surface", section.line, values)
        elif section.surface and bar and outside > bar:
            yield Finding("no-stock-met", section.line)


def _lowest_over_axis(program: Program, section: SectionContour) -> float:
    own = program.moves[section.at : section.end]
    base = plane_of(section, own[0]).base
    return min((move.end[X] for move in own if move.kind != "rapid"), default=math.inf) - base


def _is_cut_before(section: SectionContour, workpiece: Workpiece) -> bool:
    view = next(view for view in workpiece.views if view.surface == round(section.surface, 6))
    point = view.part.points(np.array(workpiece.program.moves[section.at].start))[0]
    region = Point(point[:2]).buffer(workpiece.program.radius(section.at) or ALLOWED)
    return view.material.is_cut(region, point[2], section.at)


def assumptions(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    if workpiece.holes:
        line, place, *_ = workpiece.holes[0]
        more = also_in({hole.line for hole in workpiece.holes} - {line})
        why = " or ".join(dict.fromkeys(hole.why for hole in workpiece.holes))
        values = {"at": tuple(zip("XYZ", place)), "why": why, "more": more}
        yield Finding("bored-assumed", line, values, place)


# ---------------------------------------------------------------- in a stock that is given


def _judged_in_stock(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield plunges, what meets no stock, cuts below a block, and what remains of a bar."""
    program, view = workpiece.program, workpiece.views[0]
    moves = program.moves
    fed = [
        index
        for index in workpiece.known
        if moves[index].kind != "rapid" and program.radius(index) and view.judges(program, index)
    ]
    yield from _once_a_line(filter(None, (_plunge(workpiece, index) for index in fed)))
    cuts = [(each.line, each.at, each.end) for each in program.on_face]
    cuts += [(target.line, block.at, block.end) for block, target in program.circles]
    drilled = (call for call in program.holes if not call.is_side)
    cuts += [(call.line, call.moves.start, call.moves.stop) for call in drilled]
    for line, at, end in cuts:
        if not any(_meets_stock(workpiece, index) for index in range(at, end)):
            yield Finding("no-stock-met", line)
    if workpiece.bottom is not None and fed:
        lowest = min(fed, key=lambda index: moves[index].end[Z])
        below = workpiece.bottom - moves[lowest].end[Z]
        if below > SAME_LEVEL:
            place = program.end(lowest)
            yield Finding("below-block", program.line(lowest), {"size": below}, place)
    if workpiece.stock.diameter:
        yield from filter(None, (_remaining(workpiece, section) for section in program.on_face))


def _plunge(workpiece: Workpiece, index: int) -> Finding | None:
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


def _meets_stock(workpiece: Workpiece, index: int) -> bool:
    radius, move = workpiece.program.radius(index), workpiece.program.moves[index]
    if not radius or move.end[Z] >= workpiece.top:
        return False
    points = workpiece.program.part.polyline(move)[:, :2]
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return line.distance(workpiece.shape) < radius - SAME_LEVEL


def _remaining(workpiece: Workpiece, section: SectionContour) -> Finding | None:
    """Return what remains of a bar beyond a contour that it is to be cut away to, if anything."""
    moves = workpiece.program.moves
    level = min(moves[index].end[Z] for index in range(section.at, section.end))
    plane = plane_of(section, moves[section.at])
    region = unary_union([beyond(each, plane, workpiece.shape) for each in outlines_of(section)])
    if level < workpiece.top - SAME_LEVEL:
        uncut = workpiece.material.standing(region, level)
        region = uncut.buffer(-ALLOWED).buffer(ALLOWED)  # slivers are the contour's rounding
    if region.area <= LEAST_AREA:
        return None
    place = (*region.representative_point().coords[0], level)
    values = {"area": region.area, "level": level - workpiece.top, "shape": region}
    return Finding("bar-remains", section.line, values, place)
