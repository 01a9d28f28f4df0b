# SPDX-License-Identifier: GPL-2.0-or-later
"""How the moves of a section follow each other: no rapid, stops at corners and nowhere else.

LinuxCNC blends two moves by starting the second while the first slows down, each with half its
acceleration, a and b. At the time s of the t = 2 v / a that the first takes from the speed v, it is
a (t - s)**2 / 4 in front of the corner and the second b s**2 / 4 behind it. Where the path turns by
the angle d, the tool is sin(d / 2) times the sum inside, or farther: v**2 b / (a (a + b)) at least.
With a C axis in motion G64 P limits it only where X turns back or stands: LinuxCNC takes the angle
of X, Y and Z alone. X20 C0, X16 C20, X12 C0 at F3000 misses its corner by 1.41 mm on 2.9.0, by 0.31
on 2.10, with P0.5 as with P0.001; X14 C0, X20 C20, X14 C40 by 0.51 and 0.12 mm with P0.5, and by
about P or less below. So only an exact path or stop counts. The speeds are those that F and the
axes allow: a corner that is told of is rounded by more, but where 2.10 exceeds the accelerations
(its issue 4539). On the face of the kinematics G64 P holds, if it is not 0. Chords make corners
too: so it must be one of the words between two lines, or C that turns in place.

Lengths are millimetres along the part.
"""

import cmath
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby, islice
from typing import NamedTuple, Self

import numpy as np

from g12.machine_ini import face_of
from g12.tools.machine.ini import Ini
from g12.tools.path.face_follow import FaceDemand, FollowLimits, crosses_face, demand
from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.track import Track, rate
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import Span
from g12.tools.verify.compare.section import SectionPath
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL

G64_P = re.compile(r"G64 P(\S+)")
STILL = 1e-7  # mm: C turns in place
NO_LENGTH = 1e-4  # mm, of what is left of a move
SMOOTH = math.radians(1.0)
CORNER = math.radians(15.0)  # chords of an arc make smaller ones
LESS_ON_FACE, LEAST_ON_FACE = 0.86, 0.05  # of the feed: what C cannot follow is made at between
FEED_STEP = 0.8  # of a feed: a portion of a move may be made at so much less than can be followed
FOLLOWED = 1.1  # of a limit: the greatest value may lie between places that a planner looks at
NEARLY = 0.95  # of a limit
TURN = 1e-6  # mm along the part: C turns in place
HALF_TURN = 180.01  # the shorter way is no longer
WINDOW = 0.01  # s of a run, over which C's speed is taken: samples lie a servo period apart


class SectionAxes(NamedTuple):
    """What a machine's axes can do: accelerations of X and Z in mm, of C in radians, per second².

    ``c_speed`` is C's greatest speed, degrees/s; ``period`` is the servo's. ``face`` tells of the
    kinematics of the face, ``slide`` and ``slide_speed`` are what the X slide can do there, per
    second² and per second, ``beside`` how far the tool stands from the X line, mm. ``surface`` is
    the radius of the cylinder whose unrolled surface the part is, mm, 0 of its face.
    """

    x: float
    z: float
    c: float
    c_speed: float
    face: bool = False
    beside: float = 0.0
    surface: float = 0.0
    slide: float = 0.0
    slide_speed: float = math.inf
    period: float = 1e-3

    @property
    def most_c_speed(self) -> float:
        """C's greatest speed in motion, degrees/s.

        Where LinuxCNC blends it adds half the acceleration of a servo period.
        """
        return self.c_speed + math.degrees(self.c) * self.period / 2

    def of(self, section: SectionContour) -> Self:
        """Return the same for a section: nothing but polar interpolation uses the kinematics."""
        on_face = self.face and not section.surface
        return self._replace(face=on_face, surface=section.surface)

    def along(self, direction: np.ndarray, place: np.ndarray) -> float:
        """Return the greatest acceleration along a direction (3,) at a place (3,) of the part."""
        if self.surface:
            limits = self.surface * self.c, self.z, self.x
            return 1.0 / max(*(abs(direction) / limits), 1e-12)
        tool, heading = complex(*place[:2]), complex(*direction[:2])
        radius = max(abs(tool), STILL)
        slide = max(math.sqrt(max(0.0, radius**2 - self.beside**2)), STILL)
        seen = heading * tool.conjugate() * (slide + 1j * self.beside) / radius**2
        moved = abs(seen.real + self.beside / slide * seen.imag)
        linear = max(moved, abs(direction[2])) / max(self.x, self.z)
        return 1.0 / max(linear, abs(seen.imag) / (slide * self.c), 1e-12)


@dataclass(frozen=True)
class Joint:
    """Where a move (``index``) of a section ends and the next one begins.

    ``into`` and ``out`` are the directions (3,), zero where C turns in place. ``within``: both are
    of one element of the contour; ``corner``: there the toolpath has a corner by the words.
    ``lengths`` are those of the toolpath's moves before and after it.
    """

    index: int
    place: np.ndarray
    into: np.ndarray
    out: np.ndarray
    within: bool
    corner: bool
    lengths: tuple[float, float]

    @property
    def goes_on(self) -> bool:
        """Tell whether the tool moves along the part before it and after it."""
        return bool(self.into.any() and self.out.any())

    @property
    def half_sine(self) -> float:
        """The sine of half the angle that the path turns by."""
        return float(np.linalg.norm(self.out - self.into)) / 2


def axes_of_section(ini: Ini) -> SectionAxes:
    """Return what the axes of an INI can do."""
    x, z, c = (ini.axis_limits[letter].acceleration for letter in "XZC")
    speed, face = ini.axis_limits["C"].velocity, face_of(ini.get)
    own = SectionAxes(
        x * ini.mm,
        z * ini.mm,
        math.radians(c),
        speed,
        beside=ini.tool_beside,
        period=ini.servo_period,
    )
    if not face:
        return own
    slide, most = face.slide.acceleration * ini.mm, face.slide.velocity * ini.mm
    return own._replace(face=True, slide=slide, slide_speed=most)


def judge_motion(
    section: SectionContour,
    found: SectionPath,
    moves: Sequence[Move],
    path: Track,
    axes: SectionAxes,
    tolerance: float,
) -> Iterator[Finding]:
    """Yield the first of each kind of motion that is not as it should be."""
    if section.at > 0 and not moves[section.at - 1].exact:
        yield Finding("blended-in", section.line)
    joints = list(joints_along(section, found, moves, path))
    yield from islice(rounded(section, joints, moves, path, axes, tolerance), 1)
    if axes.face:
        yield from islice(not_followed(section, moves, path, axes), 1)
    else:  # to go there and back the machine stands, also inside a line
        inside = (each for each in joints if each.within and moves[each.index].exact)
        smooth = (each for each in inside if each.goes_on and each.half_sine < SMOOTH)
        yield from (Finding("stops-inside", moves[each.index].line) for each in islice(smooth, 1))
    yield from islice(not_exact(section, moves), 1)


def joints_along(
    section: SectionContour, found: SectionPath, moves: Sequence[Move], path: Track
) -> Iterator[Joint]:
    """Yield the joints between the moves of a section, as far as it follows its toolpath."""
    points, owner = path.points, path.move
    spans = found.emitted.spans
    begin, end = path.vertices(section.at).start, path.vertices(section.end - 1).stop
    steps = np.diff(points[begin:end], axis=0)
    lengths = np.linalg.norm(steps, axis=1)[:, None]
    directions = np.where(lengths > STILL, steps / np.maximum(lengths, STILL), 0.0)
    for each in np.flatnonzero(np.diff(owner[begin + 1 : end])) + 1:
        index = int(owner[begin + each])
        if index in spans and index + 1 in spans:
            before, after = spans[index].last, first_made(found, spans[index + 1])
            within = found.elements[before] is found.elements[after]
            within = within and moves[index].line == moves[index + 1].line
            into, out = directions[each - 1], directions[each]
            one, other = found.expected[before], found.expected[after]
            corner, both = before != after and is_corner(one, other), (one.length, other.length)
            yield Joint(index, points[begin + each], into, out, within, corner, both)


def first_made(found: SectionPath, span: Span) -> int:
    """Return the first move of the toolpath of which a span has more than rounding."""
    rest = (1.0 - span.share) * found.expected[span.index].length
    return span.index + (rest < NO_LENGTH and span.index < span.last)


def is_corner(one: Expected, other: Expected) -> bool:
    """Tell whether the toolpath turns where a move ends and another begins, or may turn."""
    leave, meet = one.curve.direction(1.0), other.curve.direction(0.0)
    return not (leave and meet) or abs(cmath.phase(meet / leave)) > CORNER


def rounded(
    section: SectionContour,
    joints: Sequence[Joint],
    moves: Sequence[Move],
    path: Track,
    axes: SectionAxes,
    tolerance: float,
) -> Iterator[Finding]:
    """Yield the corners that blending rounds by more than a tolerance, the section's end first.

    On the kinematics' face, and where it is gone to or left, there is other motion than C's.
    """
    end = section.end - 1
    stands = axes.face and not turns(moves[end])
    if section.end < len(moves) and not (moves[end].exact or stands):
        yield Finding("blended-out", moves[end].line)
    for joint in joints:
        one, other = moves[joint.index], moves[joint.index + 1]
        if one.exact or joint.half_sine < math.sin(SMOOTH / 2):
            continue
        if axes.face and (
            turns(one) != turns(other)
            or one.end != other.start
            or (not turns(one) and is_limited(section, joint.index, tolerance))
        ):
            continue
        if not joint.goes_on:
            yield Finding("blended-turn", one.line)
        elif joint.corner and joint.half_sine > math.sin(CORNER / 2):
            off = rounding(joint, path, axes)
            if off > tolerance:
                yield Finding("blended-corner", one.line, {"off": off})


def is_limited(section: SectionContour, index: int, tolerance: float) -> bool:
    """Tell whether what is cut of the corner behind a move is limited, where C does not move.

    What is in force at a move is told when the next one begins, perhaps.
    """
    told = [event for event in section.told if event.text.startswith("G6")]
    before = [section.path, *(event.text for event in told if event.at <= index)]
    paths = [before[-1], *(event.text for event in told if event.at == index + 1)]
    return any(keeps_corners(path, section, tolerance) for path in paths)


def keeps_corners(path: str, section: SectionContour, tolerance: float) -> bool:
    """Tell whether a path control keeps to corners: its P is as asked for, or a tolerance."""
    given = G64_P.match(path)
    if not given or path in section.asked_paths:
        return not given or float(given[1]) > 0.0
    return 0.0 < float(given[1]) * section.unit <= tolerance


def rounding(joint: Joint, path: Track, axes: SectionAxes) -> float:
    """Return by how much a corner is rounded at least; see the formula above.

    A line too short to reach its feed is as fast as its length allows.
    """
    index = joint.index
    into, out = (axes.along(direction, joint.place) for direction in (joint.into, joint.out))
    speed = min(path.part_feed(index), path.part_feed(index + 1)) / 60.0
    square = min(speed * speed, *(a * way for a, way in zip((into, out), joint.lengths)))
    return joint.half_sine * square * out / (into * (into + out))


def not_exact(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the lines with G9, or under G61, that do not end in an exact stop."""
    exact = {
        element.line: section.exact if element.exact is None else element.exact
        for element in section.elements
    }
    for line, run in groupby(range(section.at, section.end), lambda index: moves[index].line):
        if exact.get(line) and not moves[list(run)[-1]].exact:
            yield Finding("not-exact", line)


def not_followed(
    section: SectionContour, moves: Sequence[Move], path: Track, axes: SectionAxes
) -> Iterator[Finding]:
    """Yield the moves on the face that ask more of C or the slide than they can do."""
    for index in range(section.at, section.end):
        found = demand_on_face(index, moves, path, axes)
        for name, times in (("C", found.c), ("the slide", found.slide)) if found else ():
            if times > FOLLOWED:
                yield Finding(
                    "face-acceleration", moves[index].line, {"axis": name, "times": times}
                )


def demand_on_face(
    index: int, moves: Sequence[Move], path: Track, axes: SectionAxes, faster: float = 1.0
) -> FaceDemand | None:
    """Return what a move asks of the axes at its feed times a factor; None of one off the face.

    X and Y together have more acceleration than each along a line: ``faster`` is of that.
    """
    move = moves[index]
    if not (axes.face and crosses_face(move)):
        return None
    plane, c_speed = move.acceleration * axes.x, math.radians(axes.c_speed)
    plane = plane * math.sqrt(2.0) if faster > 1.0 and move.kind != "arc" else plane
    limits = FollowLimits(plane, axes.slide, axes.c, c_speed, axes.slide_speed)
    speed = faster * path.part_feed(index) / 60.0
    return demand(move, speed, path.part.centre, axes.beside, limits)


def turns(move: Move) -> bool:
    """Tell whether a move turns C."""
    return move.start[C] != move.end[C]


def slower_on_face(
    found: SectionPath, moves: Sequence[Move], path: Track, axes: SectionAxes
) -> dict[int, float]:
    """Return the moves (indices) on the face that may be slower, down to which share of the feed.

    Those are nearly as fast as the axes can follow, or as a planner with their limits is.
    """
    slower = {}
    for index, span in found.emitted.spans.items() if axes.face else ():
        asked = max(move.feed or 0.0 for move in found.expected[span.index : span.last + 1])
        if not turns(moves[index]) and path.part_feed(index) <= LESS_ON_FACE * asked:
            quicker = demand_on_face(index, moves, path, axes, 1.0 / FEED_STEP)
            if quicker is None or max(quicker) > NEARLY:
                slower[index] = LEAST_ON_FACE
    return slower


class InPlace(NamedTuple):
    """Turns of C where the tool stays on its place on the part: degrees and seconds in all."""

    degrees: float
    seconds: float


class Turns(NamedTuple):
    """The highest speed of C, that asked of it where it turns in place, and how far it does.

    ``too_far`` is the first that is more than half a turn: its line and its degrees.
    """

    speed: float
    asked: float
    in_place: InPlace
    too_far: tuple[int, float] | None


def turns_of(
    section: SectionContour,
    moves: Sequence[Move],
    path: Track,
    axes: SectionAxes,
    real: Followed | None,
) -> Turns:
    """Return how C turns in a section; at the programmed feeds, as far as the axes allow."""
    own = range(section.at, section.end)
    turned = {i: abs(moves[i].end[C] - moves[i].start[C]) for i in own if moves[i].kind != "rapid"}
    still = {i: turn for i, turn in turned.items() if turn and path.part_length(i) < TURN}
    speed = max((emitted_speed(index, moves, path, axes) for index in own), default=0.0)
    speed = run_speed(own, real) if real else speed
    asked = max((rate(moves[index], 0.0) for index in still), default=0.0)
    far = ((moves[index].line, turn) for index, turn in still.items() if turn > HALF_TURN)
    return Turns(speed, asked, below_face(section, still, moves, path), next(far, None))


def below_face(
    section: SectionContour, still: Mapping[int, float], moves: Sequence[Move], path: Track
) -> InPlace:
    """Return how far and how long C turns in place where the tool is below the part's face."""
    face = moves[section.at].start[section.third] - section.height
    lowest = min(moves[index].end[section.third] for index in range(section.at, section.end))
    top = face - LEVEL if lowest < face - LEVEL else math.inf
    low = [index for index in still if moves[index].end[section.third] < top]
    return InPlace(sum(still[i] for i in low), sum(path.seconds(i) for i in low))


def run_speed(own: range, real: Followed) -> float:
    """Return the highest speed of C in a run."""
    mask = np.isin(real.move, own)
    angle, time = real.positions[mask, C], real.time[mask]
    later = np.searchsorted(time, time + WINDOW)
    fitting = later < len(time)
    later = later[fitting]
    turned, seconds = angle[later] - angle[fitting], time[later] - time[fitting]
    return float((np.abs(turned) / seconds).max(initial=0.0))


def emitted_speed(index: int, moves: Sequence[Move], path: Track, axes: SectionAxes) -> float:
    """Return the speed of C in a move as far as the axes allow, degrees/s."""
    on_face = demand_on_face(index, moves, path, axes)
    if on_face:
        return on_face.c_speed * axes.c_speed
    move, seconds = moves[index], path.seconds(index)
    return abs(move.end[C] - move.start[C]) / seconds if seconds else 0.0
