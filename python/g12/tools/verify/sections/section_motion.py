# SPDX-License-Identifier: GPL-2.0-or-later
"""How the moves of a section follow each other: no rapid, stops at corners and nowhere else.

LinuxCNC blends two moves by starting the second while the first slows down, each with half its
acceleration, a and b. At the time s of the t = 2 v / a that the first takes from the speed v, it is
a (t - s)**2 / 4 before the corner and the second b s**2 / 4 after it. Where the path turns by the
angle d, the tool is sin(d / 2) times the sum inside, or farther: v**2 b / (a (a + b)) at least.
With a C axis in motion G64 P limits it only where X turns back or rests: LinuxCNC takes the angle
of X, Y and Z alone. X20 C0, X16 C20, X12 C0 at F3000 misses its corner by 1.41 mm on 2.9.0, by 0.31
on 2.10, with P0.5 as with P0.001; X14 C0, X20 C20, X14 C40 by 0.51 and 0.12 mm with P0.5, and by
about P or less below. So only an exact path or stop counts. The speeds are those that F and the
axes allow: a corner that is reported is rounded by more, but where 2.10 exceeds the accelerations
(its issue 4539). On the face of the kinematics G64 P holds, if it is not 0. Chords make corners
too: so it must be one of the words between two lines, or C that turns in place.

Lengths are millimetres along the part.
"""

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby, islice

import numpy as np

from g12.tools.path.face_follow import face_demand
from g12.tools.path.part import C
from g12.tools.path.track import rate
from g12.tools.verify.compare.path import Span
from g12.tools.verify.compare.section import turns
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL, STATE
from g12.tools.verify.sections.view import G64_P, SectionView

STILL = 1e-7  # mm: C turns in place
REMAINDER = 1e-4  # mm, of what remains of a move
SMOOTH = math.radians(1.0)
CORNER = math.radians(15.0)  # chords of an arc make smaller ones
FOLLOWED = 1.1  # of a limit: the greatest value may lie between places that a planner looks at
HALF_TURN = 180.01  # degrees: the shorter way is no longer
SAME_ANGLE = 1e-3  # degree
WINDOW = 0.01  # s of a run, over which C's speed is taken: samples lie a servo period apart


@dataclass(frozen=True)
class Joint:
    """Where a move (``index``) of a section ends and the next one begins.

    ``into`` and ``out`` are the directions (3,), zero where C turns in place. ``before`` and
    ``after`` are the moves of the toolpath, by their indices.
    """

    index: int
    place: np.ndarray
    into: np.ndarray
    out: np.ndarray
    before: int
    after: int

    @property
    def goes_on(self) -> bool:
        """Tell whether the tool moves along the part before it and after it."""
        return bool(self.into.any() and self.out.any())

    @property
    def half_sine(self) -> float:
        """The sine of half the angle that the path turns by."""
        return float(np.linalg.norm(self.out - self.into)) / 2


def judge_motion(view: SectionView) -> Iterator[Finding]:
    """Yield the first of each kind of motion that is not as it should be."""
    section, moves = view.section, view.moves
    if section.at > 0 and not moves[section.at - 1].exact:
        yield Finding("blended-in", section.line)
    joints = list(joints_of(view))
    yield from islice(_blended(view, joints), 1)
    yield from islice(_not_followed(view) if view.on_face else _stops_inside(view, joints), 1)
    yield from islice(_not_exact(view), 1)


def joints_of(view: SectionView) -> Iterator[Joint]:
    """Yield the joints between the moves of a section, as far as it follows its toolpath."""
    spans = view.found.emitted.spans
    for index in view.own:
        if index in spans and index + 1 in spans:
            points, following = view.points(index), view.points(index + 1)
            directions = (_direction(points[-2:]), _direction(following[:2]))
            after = _first_made(view, spans[index + 1])
            yield Joint(index, points[-1], *directions, spans[index].last, after)


def _direction(ends: np.ndarray) -> np.ndarray:
    """Return the direction (3,) between two points, zero if they coincide."""
    step = ends[1] - ends[0]
    length = np.linalg.norm(step)
    return step / length if length > STILL else np.zeros(3)


def _first_made(view: SectionView, span: Span) -> int:
    """Return the first move of the toolpath of which a span has more than rounding."""
    rest = (1.0 - span.share) * view.expected[span.index].length
    return span.index + (rest < REMAINDER and span.index < span.last)


def _is_corner(one: Expected, other: Expected) -> bool:
    """Tell whether the toolpath turns where a move ends and another begins, or may turn."""
    leave, meet = one.curve.direction(1.0), other.curve.direction(0.0)
    return not (leave and meet) or abs(cmath.phase(meet / leave)) > CORNER


def _blended(view: SectionView, joints: list[Joint]) -> Iterator[Finding]:
    """Yield the corners that blending rounds by more than the tolerance, the section's end first.

    On the kinematics' face, and where that begins or ends, there is other motion than C's.
    """
    moves, end = view.moves, view.own.stop - 1
    c_rests = view.on_face and not turns(moves[end])
    if view.own.stop < len(moves) and not (moves[end].exact or c_rests):
        yield Finding("blended-out", moves[end].line)
    for joint in joints:
        one = moves[joint.index]
        if one.exact or joint.half_sine < math.sin(SMOOTH / 2) or _is_kept_on_face(view, joint):
            continue
        if not joint.goes_on:
            yield Finding("blended-turn", one.line)
        elif joint.before != joint.after and joint.half_sine > math.sin(CORNER / 2):
            expected = view.expected[joint.before], view.expected[joint.after]
            off = rounding(view, joint) if _is_corner(*expected) else 0.0
            if off > view.tolerance:
                yield Finding("blended-corner", one.line, {"off": off})


def _is_kept_on_face(view: SectionView, joint: Joint) -> bool:
    """Tell whether a joint is on the kinematics' face with G64 P, or where that begins or ends."""
    one, other = view.moves[joint.index], view.moves[joint.index + 1]
    switched = turns(one) != turns(other) or one.end != other.start
    return view.on_face and (switched or (not turns(one) and keeps_corners(view, joint.index)))


def keeps_corners(view: SectionView, index: int) -> bool:
    """Tell whether G61, or G64 with the P of the words or a tolerance, holds after a move."""
    section = view.section
    paths = [
        event.text for event in section.events if event.at <= index + 1 and event.text[:2] == "G6"
    ]
    path = paths[-1] if paths else section.path
    given = G64_P.match(path)
    most = math.inf if path in section.commanded_paths else view.tolerance / section.unit
    return not given or 0.0 < float(given[1]) <= most


def rounding(view: SectionView, joint: Joint) -> float:
    """Return by how much a corner is rounded at least; see the formula above.

    A line too short to reach its feed is as fast as its length allows.
    """
    index, surface = joint.index, view.plane.surface
    into, out = (view.axes.along(each, joint.place, surface) for each in (joint.into, joint.out))
    speed = min(view.path.part_feed(index), view.path.part_feed(index + 1)) / 60.0
    lengths = (view.expected[at].length for at in (joint.before, joint.after))
    square = min(speed * speed, *(a * length for a, length in zip((into, out), lengths)))
    return joint.half_sine * square * out / (into * (into + out))


def _stops_inside(view: SectionView, joints: list[Joint]) -> Iterator[Finding]:
    """Yield where the tool stops inside a line or an arc; to go there and back it has to."""
    for joint in joints:
        one, other = view.moves[joint.index], view.moves[joint.index + 1]
        inside = view.steps[joint.before].element is view.steps[joint.after].element
        smooth = joint.goes_on and joint.half_sine < SMOOTH
        if inside and smooth and one.exact and one.line == other.line:
            yield Finding("stops-inside", one.line)


def _not_exact(view: SectionView) -> Iterator[Finding]:
    """Yield the lines with G9, or under G61, that do not end in an exact stop."""
    section, moves = view.section, view.moves
    exact = {
        element.line: section.exact if element.exact is None else element.exact
        for element in section.elements
    }
    for line, run in groupby(view.own, lambda index: moves[index].line):
        if exact.get(line) and not moves[list(run)[-1]].exact:
            yield Finding("not-exact", line)


def _not_followed(view: SectionView) -> Iterator[Finding]:
    """Yield the moves on the face that demand more of C or the slide than they can do."""
    for index in view.own:
        found = face_demand(view.path, index, view.axes)
        for name, times in (("C", found.c), ("the slide", found.slide)) if found else ():
            if times > FOLLOWED:
                values = {"axis": name, "times": times}
                yield Finding("face-acceleration", view.moves[index].line, values)


# ---------------------------------------------------------------- C


def judge_c(view: SectionView) -> Iterator[Finding]:
    """Yield where C is faster than its limit, turns farther than it needs to, or rubs."""
    line, moves, in_place = view.section.line, view.moves, view.turned_in_place
    speed = max([c_speed(view), *(rate(moves[index], 0.0) for index in in_place)])
    if speed > view.axes.most_c_speed * (1.0 + STATE):
        yield Finding("c-speed", line, {"made": speed, "limit": view.axes.c.speed})
    far = [index for index, turn in in_place.items() if turn > HALF_TURN][:1]
    for index in far:
        yield Finding("c-turned-too-far", moves[index].line, {"turned": in_place[index]})
    rubbed = rubbing(view)
    if rubbed["degrees"] > SAME_ANGLE:
        yield Finding("rubs", line, rubbed)


def rubbing(view: SectionView) -> dict[str, float]:
    """Return how far (degrees) and how long (s) C turns in place with the tool below the face."""
    face = view.plane.base
    top = face - LEVEL if view.lowest < face - LEVEL else math.inf
    low = [i for i in view.turned_in_place if view.moves[i].end[view.section.third] < top]
    seconds = sum(view.path.seconds(index) for index in low)
    return {"degrees": sum(view.turned_in_place[index] for index in low), "seconds": seconds}


def c_speed(view: SectionView) -> float:
    """Return the highest speed of C, degrees/s: in the run, else as far as the axes allow."""
    if view.real is None:
        return max(_emitted_speed(view, index) for index in view.own)
    mask = np.isin(view.real.move, view.own)
    angle, time = view.real.positions[mask, C], view.real.time[mask]
    later = np.searchsorted(time, time + WINDOW)
    fitting = later < len(time)
    later = later[fitting]
    turned, seconds = angle[later] - angle[fitting], time[later] - time[fitting]
    return float((np.abs(turned) / seconds).max(initial=0.0))


def _emitted_speed(view: SectionView, index: int) -> float:
    found = face_demand(view.path, index, view.axes) if view.on_face else None
    if found:
        return found.c_speed * view.axes.c.speed
    move, seconds = view.moves[index], view.path.seconds(index)
    return abs(move.end[C] - move.start[C]) / seconds if seconds else 0.0
