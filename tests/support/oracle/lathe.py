# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections and shapes on a lathe: moves laid along the toolpath, and how they follow each other.

All are points of the contour's plane with their levels: of the face, which turns with the part, or
of the unrolled surface. The feed of a segment is the length of toolpath that it makes in the time
that its F gives it. LinuxCNC blends two moves by starting the second while the first slows down,
each with half its acceleration, a and b: where the path turns by the angle d, the tool passes the
corner at v**2 b / (a (a + b)) times sin(d / 2) at least. With a C axis in motion G64 P limits that
only where X turns back or rests, so only an exact path or stop counts; on the kinematics' face it
holds. Chords make corners too: so it must be one of the contour, or C that turns in place.

Lengths are mm, angles degrees, C's speed degrees/s.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np

from g12.tools.path.face_follow import face_demand
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Event, Move
from support.oracle.calls import C
from support.oracle.contour import ContourStep
from support.oracle.follow import Made, judge_path, lay
from support.oracle.toolpath import NO_LENGTH, Difference, Expected

LAST_DECIMAL = 0.0005  # added: arcs whose words are rounded do not close any better
JOINT = 0.001  # of what a segment makes of a toolpath: its ends lie so near to their places
FEED = 0.002  # relative: a trace prints nine decimals of feeds beside C in degrees
LESS_ON_FACE, LEAST_ON_FACE = 0.86, 0.05  # of the feed: what C cannot follow is made at between
FEED_STEP, NEARLY = 0.8, 0.95  # a portion may be made at so much less than can be followed
STILL = 1e-7  # mm: C turns in place
REMAINDER = 1e-4  # mm, of what remains of a move
SMOOTH, CORNER = math.radians(1.0), math.radians(15.0)  # chords of an arc make smaller ones
FOLLOWED = 1.1  # of a limit: the greatest value may lie between places that a planner looks at
HALF_TURN = 180.01  # degrees: the shorter way is no longer
IN_PLACE = 1e-6  # mm along the part


@dataclass(frozen=True)
class LatheCut:
    """A cut as its part sees it: the expected toolpath, which of the moves are its ``own``.

    ``steps`` are those of a section, none of a shape. ``path`` is that of the moves on the part;
    ``zero`` is the plane's zero there, ``axis`` the direction of its first axis, ``base`` its level
    0. ``events`` are those of a section.
    """

    line: int
    last_line: int
    expected: Sequence[Expected]
    own: range
    moves: Sequence[Move]
    path: Track
    axes: LatheAxes
    zero: complex
    axis: complex
    base: float
    surface: float
    tolerance: float
    steps: Sequence[ContourStep] = ()
    events: Sequence[Event] = ()

    @property
    def on_face(self) -> bool:
        """Whether it is made by the kinematics of the face."""
        return bool(self.axes.face) and not self.surface

    def points(self, index: int) -> np.ndarray:
        """Return the points (n, 3) of the part along a move."""
        return self.path.points[self.path.vertices(index)]

    @cached_property
    def found(self):
        made = []
        for index in self.own:
            points = self.points(index)
            if len(points):
                flat = (points[:, 0] + 1j * points[:, 1] - self.zero) * self.axis.conjugate()
                levels = (points[:, 2] - self.base).tolist()
                rapid = self.moves[index].kind == "rapid"
                made.append(Made(index, list(zip(flat.tolist(), levels)), rapid=rapid))
        return lay(self.expected, made, self.tolerance + LAST_DECIMAL)

    def turned_in_place(self) -> dict[int, float]:
        """Return the turn of C of each feed move in which the tool stays on the part."""
        fed = (i for i in self.own if self.moves[i].kind != "rapid")
        still = (i for i in fed if self.path.part_length(i) < IN_PLACE)
        turned = {i: abs(self.moves[i].end[C] - self.moves[i].start[C]) for i in still}
        return {index: turn for index, turn in turned.items() if turn}


def turns(move: Move) -> bool:
    return move.start[C] != move.end[C]


def judge_lathe_cut(cut: LatheCut) -> Iterator[Difference]:
    """Yield the first of each kind of difference: path, feed; of a section also stops and C."""
    yield from judge_path(cut.found, cut.last_line)
    yield from islice(judge_feed(cut), 1)
    if cut.steps:
        yield from judge_c(cut)
        yield from judge_motion(cut)


def judge_feed(cut: LatheCut) -> Iterator[Difference]:
    for index, span in cut.found.spans.items():
        parts = list(span_parts(cut.expected, span))
        length, expected = sum(length for _, length in parts), seconds_of(parts)
        given = seconds_given(cut.moves[index])
        if not expected or not given or length < JOINT:
            continue
        share, rounding, least = expected / given, JOINT / length, 1.0 - FEED
        if share < least - rounding and may_be_slower(cut, index, parts):
            least *= LEAST_ON_FACE
        if not least - rounding <= share <= 1.0 + FEED + rounding:
            what, line = parts[0][0].name, parts[0][0].line or cut.line
            yield Difference("feed", line, f"{what}: {60 * length / given:.6g} mm/min")


def may_be_slower(cut: LatheCut, index: int, parts: Sequence[tuple[Expected, float]]) -> bool:
    """Tell whether a move on the face may be slower than its feed.

    It is nearly as fast as the axes can follow, or as a planner with their limits is.
    """
    if not cut.on_face or turns(cut.moves[index]):
        return False
    quicker = face_demand(cut.path, index, cut.axes, 1.0 / FEED_STEP)
    slow = cut.path.part_feed(index) <= LESS_ON_FACE * max(move.feed or 0.0 for move, _ in parts)
    return slow and (quicker is None or max(quicker) > NEARLY)


def seconds_given(move: Move) -> float:
    """Return the time that a move's F gives it, 0 of a rapid."""
    speed = 0.0 if move.kind == "rapid" else rate(move, 0.0)
    return speed and (move.length if move.kind == "arc" else feed_length(move)) / speed


def span_parts(path, span) -> Iterator[tuple[Expected, float]]:
    """Yield the moves of a span of a toolpath, each with the length of it that is made."""
    for at in range(span.index, span.last + 1):
        begin = span.share if at == span.index else 0.0
        end = span.last_share if at == span.last else 1.0
        length = (end - begin) * path[at].length
        if length > NO_LENGTH:
            yield path[at], length


def seconds_of(parts) -> float:
    """Return the time that lengths of moves take at their feeds, 0 if one is not known."""
    found = [60.0 * length / move.feed if move.feed else 0.0 for move, length in parts]
    return sum(found) if all(found) else 0.0


# ---------------------------------------------------------------- how moves follow each other


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
        """Whether the tool moves along the part before it and after it."""
        return bool(self.into.any() and self.out.any())

    @property
    def half_sine(self) -> float:
        """The sine of half the angle that the path turns by."""
        return float(np.linalg.norm(self.out - self.into)) / 2


def judge_motion(cut: LatheCut) -> Iterator[Difference]:
    """Yield the first of each kind of motion that is not as it should be."""
    if cut.own.start > 0 and not cut.moves[cut.own.start - 1].exact:
        yield Difference("blended-in", cut.line)
    joints = list(joints_of(cut))
    yield from islice(blended(cut, joints), 1)
    yield from islice(not_followed(cut) if cut.on_face else stops_inside(cut, joints), 1)


def joints_of(cut: LatheCut) -> Iterator[Joint]:
    """Yield the joints between the moves of a section, as far as it follows its toolpath."""
    spans = cut.found.spans
    for index in cut.own:
        if index in spans and index + 1 in spans:
            points, following, span = cut.points(index), cut.points(index + 1), spans[index + 1]
            directions = (direction(points[-2:]), direction(following[:2]))
            rest = (1.0 - span.share) * cut.expected[span.index].length
            after = span.index + (rest < REMAINDER and span.index < span.last)
            yield Joint(index, points[-1], *directions, spans[index].last, after)


def direction(ends: np.ndarray) -> np.ndarray:
    """Return the direction (3,) between two points, zero if they coincide."""
    step = ends[1] - ends[0]
    length = np.linalg.norm(step)
    return step / length if length > STILL else np.zeros(3)


def is_corner(one: Expected, other: Expected) -> bool:
    """Tell whether the toolpath turns where a move ends and another begins, or may turn."""
    leave, meet = one.curve.direction(1.0), other.curve.direction(0.0)
    return not (leave and meet) or abs(cmath.phase(meet / leave)) > CORNER


def blended(cut: LatheCut, joints: Sequence[Joint]) -> Iterator[Difference]:
    """Yield the corners that blending rounds beyond the tolerance, the section's end first."""
    moves, end = cut.moves, cut.own.stop - 1
    c_rests = cut.on_face and not turns(moves[end])
    if cut.own.stop < len(moves) and not (moves[end].exact or c_rests):
        yield Difference("blended-out", moves[end].line)
    for joint in joints:
        one = moves[joint.index]
        if one.exact or joint.half_sine < math.sin(SMOOTH / 2) or kept_on_face(cut, joint):
            continue
        if not joint.goes_on:
            yield Difference("blended-turn", one.line)
        elif joint.before != joint.after and joint.half_sine > math.sin(CORNER / 2):
            corner = is_corner(cut.expected[joint.before], cut.expected[joint.after])
            if corner and rounding_at(cut, joint) > cut.tolerance:
                yield Difference("blended-corner", one.line)


def kept_on_face(cut: LatheCut, joint: Joint) -> bool:
    """Tell whether a joint is on the kinematics' face with G64 P, or where that begins or ends."""
    one, other = cut.moves[joint.index], cut.moves[joint.index + 1]
    switched = turns(one) != turns(other) or one.end != other.start
    return cut.on_face and (switched or (not turns(one) and keeps_corners(cut, joint.index)))


def keeps_corners(cut: LatheCut, index: int) -> bool:
    """Tell whether G61, or G64 with a tolerance, holds after a move."""
    paths = [each.text for each in cut.events if each.at <= index + 1 and each.text[:2] == "G6"]
    return not paths or not paths[-1].startswith("G64 P0 ")


def rounding_at(cut: LatheCut, joint: Joint) -> float:
    """Return by how much a corner is rounded at least.

    A line too short to reach its feed is as fast as its length allows.
    """
    index, surface = joint.index, cut.surface
    into, out = (cut.axes.along(each, joint.place, surface) for each in (joint.into, joint.out))
    speed = min(cut.path.part_feed(index), cut.path.part_feed(index + 1)) / 60.0
    lengths = (cut.expected[at].length for at in (joint.before, joint.after))
    square = min(speed * speed, *(a * length for a, length in zip((into, out), lengths)))
    return joint.half_sine * square * out / (into * (into + out))


def stops_inside(cut: LatheCut, joints: Sequence[Joint]) -> Iterator[Difference]:
    """Yield where the tool stops inside a line or an arc; to go there and back it has to."""
    for joint in joints:
        one, other = cut.moves[joint.index], cut.moves[joint.index + 1]
        inside = cut.steps[joint.before].element is cut.steps[joint.after].element
        smooth = joint.goes_on and joint.half_sine < SMOOTH
        if inside and smooth and one.exact and one.line == other.line:
            yield Difference("stops-inside", one.line)


def not_followed(cut: LatheCut) -> Iterator[Difference]:
    """Yield the moves on the face that demand more of C or the slide than they can do."""
    for index in cut.own:
        found = face_demand(cut.path, index, cut.axes)
        if found and max(found.c, found.slide) > FOLLOWED:
            yield Difference("face-acceleration", cut.moves[index].line)


def judge_c(cut: LatheCut) -> Iterator[Difference]:
    """Yield where C is faster than its limit, or turns farther than it needs to."""
    in_place = cut.turned_in_place()
    speeds = [c_speed(cut, index) for index in cut.own]
    speeds += [rate(cut.moves[index], 0.0) for index in in_place]
    if max(speeds, default=0.0) > cut.axes.most_c_speed * (1.0 + 1e-5):
        yield Difference("c-speed", cut.line, f"{max(speeds):.6g} degrees/s")
    for index in [index for index, turn in in_place.items() if turn > HALF_TURN][:1]:
        yield Difference("c-turned-too-far", cut.moves[index].line)


def c_speed(cut: LatheCut, index: int) -> float:
    found = face_demand(cut.path, index, cut.axes) if cut.on_face else None
    if found:
        return found.c_speed * cut.axes.c.speed
    move, seconds = cut.moves[index], cut.path.seconds(index)
    return abs(move.end[C] - move.start[C]) / seconds if seconds else 0.0
