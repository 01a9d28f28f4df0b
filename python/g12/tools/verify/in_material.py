# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: rapids through it, plunges, and what remains of a bar.

A rapid is held to the material where the tool's position and the material there are known. Without
a stock the part is known where the program cuts, and as far as a wall is assumed around that.

Lengths are mm, areas mm². Points are those of the part: on a lathe's face they turn with C, on a
cylinder they are those of its unrolled surface. Only cutters with a diameter count, on a lathe
those that cut sections.
"""

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from shapely.affinity import rotate
from shapely.geometry import LineString, Point, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, NOTHING, SAME_LEVEL
from g12.tools.path.part import X, Z, disc, is_sideways
from g12.tools.units import plain
from g12.tools.verify.compare.plane import plane_of, turned_plane
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.mistakes.neighbours import judge_circles
from g12.tools.verify.mistakes.tool import length_set_by, missing_length, uses_lengths
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import SIZE
from g12.tools.verify.sections.outline import outlines_of
from g12.tools.verify.subject import Subject
from g12.tools.verify.walls import FAR, beyond, flat_circles
from g12.tools.verify.workpiece import PartView, Workpiece

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock


def judge_material(workpiece: Workpiece, cuts: Sequence[MeasuredCut]) -> Iterator[Finding]:
    yield from judge_rapids(workpiece)
    yield from _on_surfaces(workpiece)
    yield from judge_circles(flat_circles(workpiece.subject), workpiece.material)
    yield from _judged_in_stock(workpiece, cuts) if workpiece.stock else ()
    yield from _started_in_cut(workpiece)
    yield from _undrilled_taps(workpiece)
    yield from _upright(workpiece.subject)
    yield from assumptions(workpiece)


def _once_a_line(found: Iterable[Finding]) -> Iterator[Finding]:
    lines: dict[int, Finding] = {}
    for each in found:
        lines.setdefault(each.line, each)
    yield from lines.values()


# ---------------------------------------------------------------- rapids


def judge_rapids(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids that go through material, and the lines of those not judged, by cause."""
    found = list(_rapids(workpiece))
    through = list(_once_a_line(each for each in found if each.is_finding))
    yield from through
    judged = {each.line for each in through}
    causes: dict[str, list[Finding]] = {}
    for each in (each for each in found if each.line not in judged):
        causes.setdefault(each.code, []).append(each)
    for same in causes.values():
        lines = [each.line for each in same]
        yield replace(same[0], line=min(lines), values={"lines": lines})


def _rapids(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield each rapid through material, and each of which something is not known, by its cause.

    It is judged from where the program says that it begins to where it says that it ends, in the
    views of the part at which its tool points.
    """
    subject, face = workpiece.subject, workpiece.views[0]
    known = [False, *subject.ends_known]
    levels = [(view, subject.lowest(view.part)) for view in workpiece.views]
    low = [(view, lowest <= workpiece.top_in(view) - SAME_LEVEL) for view, lowest in levels]
    z0 = subject.z0 if subject.commanded.sections or subject.commanded.holes else -math.inf
    idle = levels[0][1] < max(z0, face.material.top) - SAME_LEVEL
    reported: set[int] = set()  # lines: of one the first rapid through material is enough
    for index in (i for i, move in enumerate(subject.moves) if move.kind == "rapid"):
        begins, ends = known[index : index + 2]
        for view in (view for view, is_low in low if is_low[index]):
            if view.meets(subject, index) and not (reported and subject.line(index) in reported):
                found = list(_in_view(workpiece, view, index, begins, ends))
                reported |= {each.line for each in found if each.is_finding}
                yield from found
        if begins and ends and len(subject.sideways[index]) > 1:
            yield Finding("rapid-turned", subject.line(index))
        elif ends and idle[index] and not subject.sideways[index]:
            yield Finding("rapid-idle-tool", subject.line(index))
        end = subject.end(index)
        if ends and not begins and end[Z] < workpiece.top_in(face) - SAME_LEVEL:
            yield Finding("rapid-from-unknown", subject.line(index), place=end)


def _in_view(
    workpiece: Workpiece, view: PartView, index: int, begins: bool, ends: bool
) -> Iterator[Finding]:
    """Yield a low rapid if it goes through the material of a view, or why that is not known."""
    subject, material, cutter = workpiece.subject, view.material, workpiece.subject.cutter(index)
    points = subject.points(index, view.part)
    touch = ends and material.touched(points if begins else points[-1:], cutter, index)
    if touch:
        at, to = touch.points[[0, -1]].tolist()
        values = {
            "at": _words_of(subject, view, index, at),
            "to": _words_of(subject, view, index, to),
            "area": touch.area,
            "path": touch.points,
            "surface": view.surface,
        }
        code = "rapid-through" if at[:2] != to[:2] else "rapid-into"
        yield Finding(code, subject.line(index), values, at)
    if begins and not ends:
        if points[0, Z] < material.top - SAME_LEVEL:
            yield Finding("rapid-by-machine", subject.line(index))
    elif begins and not (workpiece.stock and workpiece.stock.is_whole):
        in_front = view.surface and points[:, 1].min() > subject.z0 - SAME_LEVEL
        if not (in_front or cutter):
            yield Finding("rapid-no-diameter", subject.line(index))
        elif not (in_front or material.covers(points, cutter, index, workpiece.top_in(view))):
            yield Finding("rapid-beside", subject.line(index))
    elif begins and not touch and material.touched(points, cutter, index, perhaps=True):
        yield Finding("rapid-after-cuts", subject.line(index))


def judge_rapid_lengths(subject: Subject, known: set[int]) -> Iterator[Finding]:
    """Yield rapids that lead the tip below Z0, as another length than the tool's is in force.

    Of one tool and length the first is reported, if no cut is: ``known`` are the moves of cuts.
    """
    moves, trace, z0 = subject.moves, subject.trace, float(subject.zero[Z])
    deeper = [missing_length(trace, index) for index in range(len(moves))]
    reported = {(moves[index].tool, deeper[index]) for index in known}
    for index, move in enumerate(moves if uses_lengths(moves) else ()):
        of, level = (move.tool, deeper[index]), move.end[Z] - deeper[index] - z0
        is_low = deeper[index] > SIZE and level < -SAME_LEVEL and subject.ends_known[index]
        if move.kind == "rapid" and is_low and of not in reported:
            reported.add(of)
            values = {"tool": move.tool, "length": move.tool_offset[Z], "level": level}
            cancelled = length_set_by(trace.events, index) == "G49"
            code = "rapid-length-not-used" if cancelled else "rapid-length"
            yield Finding(code, subject.line(index), values, subject.end(index))


def _words_of(
    subject: Subject, view: PartView, index: int, point: Sequence[float]
) -> tuple[tuple[str, float | str], ...]:
    """Return a point of a move as words: X Y Z of a mill, X C Z of a lathe.

    In a section on the face they are the section's own.
    """
    if not view.part.turning:
        return tuple(zip("XYZ", point))
    for section in subject.commanded.on_face:
        if section.at <= index < section.end:
            plane = plane_of(section, subject.moves[section.at])
            at = complex(plane.points(np.array([point]))[0])
            return plane.words((at, point[2] - plane.base), section.diameters)
    if view.surface:
        around, along, level = point
        x, c, z = level - view.part.centre, math.degrees(around / view.surface), along
    else:
        x, z, c = math.hypot(*point[:2]), point[2], math.degrees(math.atan2(point[1], point[0]))
    factor = 2 if subject.commanded.in_diameters(index) else 1
    return ("X", factor * x), ("C", plain(c, 3)), ("Z", z)


# ---------------------------------------------------------------- what is assumed


def _started_in_cut(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the tool changes and the starts of a spindle with the tool in the part.

    A machine may take the tool up before it changes it. A turret cannot turn with a tool in a hole
    of the part. What is beside a bar is no part: how far a turret reaches is not known.
    """
    subject = workpiece.subject
    taken_up = subject.ini.number("EMCIO", "TOOL_CHANGE_QUILL_UP", 0)
    starts = ("M3", "M4") if taken_up else ("M3", "M4", "tool")
    events = [each for each in subject.trace.events if each.at and each.text.split()[0] in starts]
    for event, view in product(events, workpiece.views):
        last = event.at - 1
        point = view.part.points(np.array(subject.moves[last].end))[0]
        region = Point(point[:2]).buffer(subject.cutter(last) or ALLOWED)
        known = subject.ends_known[last] and view.meets(subject, last)
        code, _, tool = event.text.partition(" ")
        is_below = known and point[Z] < view.material.top - SAME_LEVEL
        anywhere = tool and not subject.part.turning
        in_part = view.material.surrounds if tool else view.material.was_solid
        if is_below and (anywhere or in_part(region, point[Z], event.at)):
            found = "change-in-cut" if tool else "start-in-cut"
            yield Finding(found, event.line, {"code": code, "tool": tool}, subject.end(last))


def _undrilled_taps(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the taps that go deeper than all cuts before them."""
    calls = (call for call in workpiece.subject.commanded.holes if call.is_tapped)
    found = [call for call in calls if _meets_material(workpiece, call)]
    for call in found[:1]:
        more = {each.line for each in found} - {call.line}
        yield Finding("tap-undrilled", call.line, {"more": more}, file=call.file)


def _meets_material(workpiece: Workpiece, call: SubCall) -> bool:
    """Tell whether a feed move of a call ends in material, at the tool's axis."""
    subject, first = workpiece.subject, call.moves.start
    ends = np.array([subject.moves[i].end for i in call.moves if subject.moves[i].kind != "rapid"])
    return any(
        view.material.standing(Point(end[:2]).buffer(ALLOWED), end[Z], first)
        for view in workpiece.views
        if view.meets(subject, first)
        for end in view.part.points(ends)
    )


def _upright(subject: Subject) -> Iterator[Finding]:
    """Yield the circles in another plane than XY, whose material is not known."""
    lines = [target.line for _, target in subject.commanded.circles if target.wall.plane != Z]
    if lines:
        yield Finding("upright", lines[0], {"lines": lines})


def _on_surfaces(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that begin inside of its surface, where nothing is cut.

    Also those that cut nothing of it, or nothing of a bar.
    """
    subject, stock = workpiece.subject, workpiece.stock
    for section in (each for each in subject.commanded.sections if each.surface):
        first, *_ = own = subject.moves[section.at : section.end]
        base = plane_of(section, first).base
        inside = base + section.surface - first.start[X]
        in_front = first.start[Z] > subject.z0 - SAME_LEVEL
        if inside > SAME_LEVEL and not in_front and not _is_cut_before(section, workpiece):
            values = {"code": section.code, "radius": section.surface, "inside": inside}
            yield Finding("inside-surface", section.line, values, first.start[:3])
        lowest = min((move.end[X] for move in own if move.kind != "rapid"), default=math.inf) - base
        if lowest < -SAME_LEVEL:
            yield Finding("beyond-axis", section.line, {"size": -lowest}, file=section.file)
        if lowest > section.surface - SAME_LEVEL:
            values = {"radius": section.surface, "size": lowest - section.surface}
            yield Finding("above-surface", section.line, values)
        elif stock and stock.diameter and lowest > stock.diameter / 2 - SAME_LEVEL:
            yield Finding("no-stock-met", section.line)


def _is_cut_before(section: SectionContour, workpiece: Workpiece) -> bool:
    subject, radius = workpiece.subject, round(section.surface, 6)
    view = next(view for view in workpiece.views if view.surface == radius)
    point = view.part.points(np.array(subject.moves[section.at].start))[0]
    region = Point(point[:2]).buffer(subject.cutter(section.at) or ALLOWED)
    return view.material.is_cut(region, point[2], section.at)


def assumptions(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    for line, place, radius, _ in workpiece.holes[:1]:
        more = {hole.line for hole in workpiece.holes} - {line}
        why = " or ".join(dict.fromkeys(hole.why for hole in workpiece.holes))
        values = {"radius": radius, "at": tuple(zip("XYZ", place)), "why": why, "more": more}
        yield Finding("bored-assumed", line, values, place)


# ---------------------------------------------------------------- in a stock that is given


def _judged_in_stock(workpiece: Workpiece, cuts: Sequence[MeasuredCut]) -> Iterator[Finding]:
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
    yield from _once_a_line(filter(None, plunges))
    for cut in (each for each in cuts if not each.surface and subject.cutter(each.own.start)):
        if not any(_meets_stock(workpiece, index) for index in cut.own):
            yield Finding("no-stock-met", cut.line, file=cut.file)
    yield from _once_a_line(_over_the_edge(workpiece)) if workpiece.stock.is_whole else ()
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
    at, beside, _ = _words_of(subject, workpiece.views[0], index, place)
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
