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

from __future__ import annotations

import cmath
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby, islice
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from g12.machine_ini import face_of
from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.section import SectionPath
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.sections.face_follow import FollowLimits, follow_off, is_slow_enough

G64_P = re.compile(r"G64 P(\S+)")
STILL = 1e-7  # mm: C turns in place
SMOOTH = math.radians(1.0)
CORNER = math.radians(15.0)  # chords of an arc make smaller ones
LESS_ON_FACE, LEAST_ON_FACE = 0.86, 0.05  # of the feed: what C cannot follow is made at between


class SectionAxes(NamedTuple):
    """What a machine's axes can do: accelerations of X and Z in mm, of C in radians, per second².

    ``c_speed`` is C's greatest speed, degrees/s; ``face`` tells of the kinematics of the face,
    ``slide`` is the acceleration of the X slide there and ``override`` what the feed may be turned
    up to, ``beside`` how far the tool stands from the X line, mm. ``surface`` is the radius of the
    cylinder whose unrolled surface the part is, mm, 0 of its face.
    """

    x: float
    z: float
    c: float
    c_speed: float
    face: bool = False
    beside: float = 0.0
    surface: float = 0.0
    slide: float = 0.0
    override: float = 1.0

    def of(self, section: SectionContour) -> SectionAxes:
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


class Joint(NamedTuple):
    """Where a move of a section ends and another begins.

    ``into`` and ``out`` are the directions (3,), zero where C turns in place.
    """

    place: np.ndarray
    into: np.ndarray
    out: np.ndarray

    @property
    def half_sine(self) -> float:
        """The sine of half the angle that the path turns by."""
        return float(np.linalg.norm(self.out - self.into)) / 2


class OffMotion(NamedTuple):
    """A line whose motion is not as it should be: the code of its sentence, and its values."""

    line: int
    code: str
    values: Mapping[str, object] = MappingProxyType({})


def axes_of_section(ini: Ini) -> SectionAxes:
    """Return what the axes of an INI can do."""
    x, z, c = (ini.axis_limits[letter].acceleration for letter in "XZC")
    speed, face = ini.axis_limits["C"].velocity, face_of(ini.get)
    lengths, beside = (x * ini.mm, z * ini.mm, math.radians(c)), ini.tool_beside
    if not face:
        return SectionAxes(*lengths, speed, beside=beside)
    slide, override = face.slide.acceleration * ini.mm, max(1.0, face.override)
    return SectionAxes(*lengths, speed, True, beside, slide=slide, override=override)


def motion_off(
    section: SectionContour,
    moves: Sequence[Move],
    path: Track,
    axes: SectionAxes,
    tolerance: float,
) -> Iterator[OffMotion]:
    """Yield the first of each kind of motion that is not as it should be."""
    if is_blended_into(section, moves):
        yield OffMotion(section.line, "blended-in")
    yield from islice(rounded(section, moves, path, axes, tolerance), 1)
    if axes.face:
        yield from islice(not_followed(section, moves, path, axes), 1)
    else:  # to go there and back the machine stands, also inside a line
        yield from islice(stopped_inside(section, moves, path), 1)
    yield from islice(not_exact(section, moves), 1)


def slower_on_face(
    found: SectionPath, moves: Sequence[Move], path: Track, axes: SectionAxes
) -> dict[int, float]:
    """Return the moves (indices) on the face that may be slower, down to which share of the feed.

    Those are as fast as C and the slide can follow with the acceleration in force.
    """
    if not axes.face:
        return {}
    slower = {}
    for index, span in found.emitted.spans.items():
        move, feed = moves[index], path.part_feed(index)
        asked = (found.expected[span.last].feed or 0.0) * LESS_ON_FACE
        place = path.part.centre, axes.beside, follow_limits(move, axes)
        if (
            not turns(move)
            and feed <= asked
            and is_slow_enough(move, axes.override * feed / 60.0, *place)
        ):
            slower[index] = LEAST_ON_FACE
    return slower


def follow_limits(move: Move, axes: SectionAxes) -> FollowLimits:
    """Return what X, Y, the slide and C can do while a move is made on the face."""
    plane, speed = move.acceleration * axes.x, math.radians(axes.c_speed)
    return FollowLimits(plane, axes.slide, axes.c, speed)


def not_followed(
    section: SectionContour, moves: Sequence[Move], path: Track, axes: SectionAxes
) -> Iterator[OffMotion]:
    """Yield the moves on the face that ask more of C or the slide than they can do."""
    for index in range(section.at, section.end):
        move, speed = moves[index], path.part_feed(index) / 60.0
        off = follow_off(move, speed, path.part.centre, axes.beside, follow_limits(move, axes))
        if off:
            yield OffMotion(moves[index].line, "face-acceleration", off._asdict())


def is_blended_into(section: SectionContour, moves: Sequence[Move]) -> bool:
    """Tell whether the move in front of a section is blended into its first one."""
    return section.at > 0 and not (section.stopped or moves[section.at - 1].exact)


def rounded(
    section: SectionContour,
    moves: Sequence[Move],
    path: Track,
    axes: SectionAxes,
    tolerance: float,
) -> Iterator[OffMotion]:
    """Yield the corners that blending rounds by more than a tolerance, the section's end first.

    On the kinematics' face, and where it is gone to or left, there is other motion than C's.
    """
    end = section.end - 1
    stands = axes.face and not turns(moves[end])
    if section.end < len(moves) and not (moves[end].exact or stands):
        yield OffMotion(moves[end].line, "blended-out")
    lengths = lengths_of_lines(section, moves, path)
    corners = corners_of(section)
    for index in sharp_joints(section, path):
        one, other = moves[index], moves[index + 1]
        if one.exact or (axes.face and is_switch(one, other)):
            continue
        if axes.face and not turns(one) and is_limited(section, index, tolerance):
            continue
        joint = joint_behind(index, path)
        if not (joint.into.any() and joint.out.any()):
            yield OffMotion(one.line, "blended-turn")
        elif corners.get((one.line, other.line)) and joint.half_sine > math.sin(CORNER / 2):
            off = rounding(joint, index, path, axes, lengths)
            if off > tolerance:
                yield OffMotion(one.line, "blended-corner", {"off": off})


def is_switch(one: Move, other: Move) -> bool:
    """Tell whether the machine goes to the face or back between two moves, and so stands."""
    return turns(one) != turns(other) or one.end != other.start


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


def corners_of(section: SectionContour) -> dict[tuple[int, int], bool]:
    """Tell by the lines of neighbours whether the tool's path has a corner between them.

    An outside corner of a compensated contour becomes an arc.
    """
    return {
        (one.line, other.line): is_corner(one, other)
        for one, other in zip(section.elements, section.elements[1:])
        if one.line != other.line
    }


def is_corner(one: Element, other: Element) -> bool:
    """Tell whether the tool's path turns where an element meets the next one."""
    leave, meet = one.normal(1.0), other.normal(0.0)
    if not (leave and meet) or one.ramp or other.ramp:
        return True
    turned = cmath.phase(meet / leave)
    return abs(turned) > CORNER and turned * one.side >= 0.0


def rounding(
    joint: Joint, index: int, path: Track, axes: SectionAxes, lengths: dict[int, float]
) -> float:
    """Return by how much a corner behind a move is rounded at least; see the formula above.

    A line too short to reach its feed is as fast as its ``lengths`` allow.
    """
    into, out = (axes.along(direction, joint.place) for direction in (joint.into, joint.out))
    speed = min(path.part_feed(index), path.part_feed(index + 1)) / 60.0
    square = min(speed * speed, into * lengths[index], out * lengths[index + 1])
    return joint.half_sine * square * out / (into * (into + out))


def stopped_inside(
    section: SectionContour, moves: Sequence[Move], path: Track
) -> Iterator[OffMotion]:
    """Yield the lines inside which the tool stops where the path goes straight on."""
    often = {line for line, count in Counter(lines_drawn(section)).items() if count > 1}
    for index in range(section.at, section.end - 1):
        line = moves[index].line
        if moves[index].exact and moves[index + 1].line == line and line not in often:
            joint = joint_behind(index, path)
            if joint.into.any() and joint.out.any() and joint.half_sine < SMOOTH:
                yield OffMotion(line, "stops-inside")


def not_exact(section: SectionContour, moves: Sequence[Move]) -> Iterator[OffMotion]:
    """Yield the lines with G9, or under G61, that do not end in an exact stop."""
    exact = {
        element.line: section.exact if element.exact is None else element.exact
        for element in section.elements
    }
    for line, run in groupby(range(section.at, section.end), lambda index: moves[index].line):
        if exact.get(line) and not moves[list(run)[-1]].exact:
            yield OffMotion(line, "not-exact")


def lines_drawn(section: SectionContour) -> list[int]:
    """Return the line of each element of a section's contour."""
    return [element.line for element in section.elements]


def lengths_of_lines(
    section: SectionContour, moves: Sequence[Move], path: Track
) -> dict[int, float]:
    """Return for each move of a section the length of the moves of one line that it is among."""
    lengths = {}
    for _, run in groupby(range(section.at, section.end), lambda index: moves[index].line):
        indices = list(run)
        lengths.update(dict.fromkeys(indices, sum(map(path.part_length, indices))))
    return lengths


def turns(move: Move) -> bool:
    """Tell whether a move turns C."""
    return move.start[C] != move.end[C]


def joint_behind(index: int, path: Track) -> Joint:
    """Return the joint between a move and the one after it."""
    one, other = (path.points[path.vertices(each)] for each in (index, index + 1))
    return Joint(one[-1], *(directions_of(points)[0] for points in (one[-2:], other[:2])))


def sharp_joints(section: SectionContour, path: Track) -> list[int]:
    """Return the moves behind which the path turns, or C turns in place."""
    begin, end = path.vertices(section.at).start, path.vertices(section.end - 1).stop
    owner, directions = path.move[begin:end], directions_of(path.points[begin:end])
    ends = np.flatnonzero(np.diff(owner[1:])) + 1
    turned = np.linalg.norm(directions[ends] - directions[ends - 1], axis=1) / 2
    return [int(owner[each]) for each in ends[turned > math.sin(SMOOTH / 2)]]


def directions_of(points: np.ndarray) -> np.ndarray:
    """Return the directions (n - 1, 3) between points (n, 3), zero between equal ones."""
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)[:, None]
    return np.where(lengths > STILL, steps / np.maximum(lengths, STILL), 0.0)
