# SPDX-License-Identifier: GPL-2.0-or-later
"""The rapids of a program: whether they go through material.

A rapid is held to the material where the tool's position and the material there are known. Without
a stock the part is known where the program cuts, and as far as a wall is assumed around that.

Lengths are mm, areas mm². Points are those of the part: on a lathe's face they turn with C, on a
cylinder they are those of its unrolled surface. Only cutters with a diameter count, on a lathe
those that cut sections.
"""

from collections.abc import Iterator
from dataclasses import replace

from g12.tools.material.material import SAME_LEVEL
from g12.tools.path.part import Z
from g12.tools.verify.mistakes.tool import length_set_by, missing_length, uses_lengths
from g12.tools.verify.result.finding import Finding, once_a_line
from g12.tools.verify.result.tolerances import SIZE
from g12.tools.verify.subject import Subject
from g12.tools.verify.workpiece import PartView, Workpiece


def judge_rapids(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids that go through material, and the lines of those not judged, by cause."""
    found = list(_rapids(workpiece))
    through = list(once_a_line(each for each in found if each.is_finding))
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
    idle = levels[0][1] < subject.z0 - SAME_LEVEL
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
            "at": view.words(subject, index, at),
            "to": view.words(subject, index, to),
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
    After a cut with the length of the table G49 does not mean that Z was touched off.
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
            with_length = any(
                at < index and moves[at].tool == move.tool and abs(deeper[at]) < SIZE
                for at in known
            )
            touched_off = length_set_by(trace.events, index) == "G49" and not with_length
            code = "rapid-length-not-used" if touched_off else "rapid-length"
            yield Finding(code, subject.line(index), values, subject.end(index))
