# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: each rule that compares moves with what stands there.

Lengths are mm in machine coordinates. Only cutters with a diameter count, on a lathe those that cut
sections.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from shapely.geometry import Point

from g12.tools.material.material import ALLOWED, SAME_LEVEL
from g12.tools.path.part import X, Z
from g12.tools.verify.compare.plane import plane_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.in_stock import judge_in_stock
from g12.tools.verify.mistakes.neighbours import judge_circles
from g12.tools.verify.rapids import judge_rapids
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.subject import Subject
from g12.tools.verify.walls import flat_circles
from g12.tools.verify.workpiece import Workpiece


def judge_material(workpiece: Workpiece, cuts: Sequence[MeasuredCut]) -> Iterator[Finding]:
    yield from judge_rapids(workpiece)
    yield from _on_surfaces(workpiece)
    yield from judge_circles(flat_circles(workpiece.subject), workpiece.material)
    yield from judge_in_stock(workpiece, cuts) if workpiece.stock else ()
    yield from _started_in_cut(workpiece)
    yield from _undrilled_taps(workpiece)
    yield from _upright(workpiece.subject)
    yield from _assumptions(workpiece)


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


def _assumptions(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    for line, place, radius, _ in workpiece.holes[:1]:
        more = {hole.line for hole in workpiece.holes} - {line}
        why = " or ".join(dict.fromkeys(hole.why for hole in workpiece.holes))
        values = {"radius": radius, "at": tuple(zip("XYZ", place)), "why": why, "more": more}
        yield Finding("bored-assumed", line, values, place)
