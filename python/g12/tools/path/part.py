# SPDX-License-Identifier: GPL-2.0-or-later
"""Paths in the workpiece's coordinates: the tool's position on the part, the area swept by it.

A ``Part`` turns machine positions into part positions. On a mill they are the same. On a lathe
whose work spindle turns as C the part plane is the face as one looks at it: with C at 0, machine
X points right; angles grow counterclockwise, so a tool at X, C is at (X cos C, X sin C).

Lengths are millimetres, angles radians unless a name says degrees.
"""

import cmath
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.lengths import MM_PER_INCH
from g12.machine_ini import AXIS_LETTERS, face_joints
from g12.tools.machine.ini import Ini
from g12.tools.preview.moves import THIRD_AXIS, Move, Trace

CHORD_ERROR = 2e-4  # of the polylines of curves
LONGEST_ARC_CHORD = math.radians(10)
DISC_SEGMENTS = 64  # per quarter of a swept disc
LEAST_CHORDS = 12  # of half a circle
STRETCH = 32  # chords whose swept area is computed at once
X, Y, Z, C = 0, 1, 2, 5
FLAT = 17  # the plane whose arcs keep their level
INCHES = 1  # length_units of the interpreter


class Roles(NamedTuple):
    """The axes of a part that turns, by their places in a position.

    The slide ``along`` its axis, the one square to it, and the one ``across`` both.
    """

    turn: int
    along: int
    height: int
    across: int


ROLES = {  # by the rotary axis
    turn: Roles(*(AXIS_LETTERS.index(axis) for axis in (turn, *others)))
    for turn, others in {"C": "ZXY", "A": "XZY", "B": "YZX"}.items()
}


@dataclass(frozen=True)
class Part:
    """The transformation from machine to part; ``turning`` if a work spindle turns the part as C.

    A lathe has a Y only on the face of its kinematics, rotated by C's angle at the switch.
    Elsewhere Y is the tool's distance ``beside`` the X line, mm. The spindle's axis is at machine X
    ``centre``.
    """

    turning: bool
    beside: float = 0.0
    centre: float = 0.0
    roles: Roles = ROLES["C"]

    @property
    def letters(self) -> str:
        """The axes that its points depend on."""
        return "XCZ" if self.turning else "XYZ"

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return part points (n, 3) of machine positions (n, 9)."""
        positions = np.atleast_2d(positions)
        if not self.turning:
            return positions[:, :3]
        turn = np.exp(1j * np.radians(positions[:, C]))
        points = (positions[:, X] - self.centre + 1j * positions[:, Y]) * turn
        return np.stack([points.real, points.imag, positions[:, Z]], axis=1)

    def machine_points(self, move: Move, chord_error: float = CHORD_ERROR) -> np.ndarray:
        """Return machine positions (n, 9) along a move, its ends included.

        They are dense enough for chords to follow the curves on the part.
        """
        count = self._segments(move, chord_error)
        if move.kind == "arc":
            return arc_points(move, np.linspace(0.0, 1.0, count + 1))
        if count == 1:
            return np.array([move.start, move.end])
        return np.linspace(move.start, move.end, count + 1)

    def polyline(self, move: Move, chord_error: float = CHORD_ERROR) -> np.ndarray:
        """Return part points (n, 3) along a move, its ends included."""
        return self.points(self.machine_points(move, chord_error))

    def _segments(self, move: Move, chord_error: float) -> int:
        if move.kind == "arc":
            return arc_segments(move.radius, move.sweep, chord_error)
        if self.turning:
            turn = math.radians(move.end[C] - move.start[C]) + self._face_turn(move)
            radius = max(abs(position[X] - self.centre) for position in (move.start, move.end))
            return max(arc_segments(radius, turn, chord_error), _spiral_segments(move, chord_error))
        return 1

    def _face_turn(self, move: Move) -> float:
        """Return the angle, radians, of a straight move on the face about the spindle."""
        positions = (move.start, move.end)
        start, end = (complex(position[X] - self.centre, position[Y]) for position in positions)
        return cmath.phase(end * start.conjugate()) if start.imag or end.imag else 0.0


def part_of(ini: Ini) -> Part:
    """Return the part of an INI's machine; one with X and C, and no joint of Y, is a lathe."""
    turning = "C" in ini.axes and ("Y" not in ini.axes or bool(face_joints(ini.get)))
    return Part(turning, ini.tool_beside)


def part_of_program(ini: Ini, trace: Trace, is_milled: bool) -> Part:
    """Return the part of a program; on a lathe C turns it about X0, if C moves or mills at all."""
    part = part_of(ini)
    turning = part.turning and (is_milled or any(map(_turns_part, trace.moves)))
    return replace(part, turning=turning, centre=last_zero(trace) if turning else 0.0)


def _turns_part(move: Move) -> bool:
    """Return whether C turns a lathe's part; a circle on the face ends where it begins."""
    circle = move.kind == "arc" and move.plane == FLAT
    return circle or any(move.start[axis] != move.end[axis] for axis in (Y, C))


def last_zero(trace: Trace, axis: int = X) -> float:
    """Return the machine coordinate of the program's X0, or of another axis, at its end, mm."""
    state, name = trace.state, f"current_{'xyz'[axis]}"
    unit = MM_PER_INCH if state.get("length_units") == INCHES else 1.0
    return trace.position[axis] - state[name] * unit if name in state else 0.0


def _spiral_segments(move: Move, chord_error: float) -> int:
    """Return the number of segments of a move across the part while C turns.

    The turn's own sagitta is left out. The second derivative of w exp(ic) has the further term
    2i w' c' exp(ic): a sagitta of distance times turn / 4.
    """
    length = math.hypot(move.end[X] - move.start[X], move.end[Y] - move.start[Y])
    turn = math.radians(abs(move.end[C] - move.start[C]))
    return math.ceil(math.sqrt(length * turn / (4.0 * chord_error))) if turn else 1


def slide_positions(points: np.ndarray, beside: float) -> np.ndarray:
    """Return the X slide's positions for the tool's, as points (complex) of the plane that C turns.

    Off the face, where the tool is ``beside`` the X line, they are on the real axis.
    """
    radius = np.maximum(np.abs(points), 1e-12)
    slide = np.sqrt(np.maximum(radius**2 - beside**2, 0.0))
    turned = slide * points * (slide - 1j * beside) / radius**2
    return np.where(np.abs(points.imag - beside) < 1e-12, points.real, turned)


def spindle_angles(points: np.ndarray, c: np.ndarray, beside: float = 0.0) -> np.ndarray:
    """Return the C axis's angles, degrees, for points (complex) on a face turned by ``c``.

    On the face C follows the angle of the points. A change of ``c`` between a point on the face and
    another is a switch of kinematics, during which C does not move. ``beside`` is the tool's
    distance from the X line.
    """
    on_face = slide_positions(points, beside)
    turned = np.degrees(np.angle(on_face[1:] * np.conj(on_face[:-1])))
    off_line = (on_face.imag[1:] != 0.0) | (on_face.imag[:-1] != 0.0)
    changed = np.diff(c)
    changed = changed - 360.0 * np.round(changed / 360.0)  # counts whole turns on the face
    beyond = on_face.real[1:] * on_face.real[:-1] < 0.0  # X changes its sign
    off_line |= beyond & (changed != 0.0)
    steps = np.where(off_line, np.where(changed != 0.0, 0.0, turned), changed)
    return c[0] + np.append(0.0, np.cumsum(steps))


def arc_segments(radius: float, sweep: float, chord_error: float) -> int:
    """Return the number of chords of an arc within ``chord_error``."""
    if abs(sweep) < 1e-12:
        return 1
    fitting = 2 * math.acos(max(0.0, 1 - chord_error / max(radius, chord_error)))
    return max(1, math.ceil(abs(sweep) / min(fitting, LONGEST_ARC_CHORD)))


def arc_points(move: Move, fractions: np.ndarray) -> np.ndarray:
    """Return machine positions (n, 9) after fractions of an arc."""
    axes, centre = plane_axes(move), np.array(move.centre)
    start, end = (axes @ (np.array(point[:3]) - centre) for point in (move.start, move.end))
    angles, radius = move.sweep * fractions, math.hypot(*start[:2])
    growth = 1 + (math.hypot(*end[:2]) / radius - 1) * fractions
    cos, sin = np.cos(angles) * growth, np.sin(angles) * growth
    points, local = np.empty((len(fractions), 9)), np.empty((len(fractions), 3))
    points[:, 3:] = move.start[3:]
    if move.start[3:] != move.end[3:]:
        points[:, 3:] = np.outer(1 - fractions, move.start[3:]) + np.outer(fractions, move.end[3:])
    local[:, 0], local[:, 1] = start[0] * cos - start[1] * sin, start[0] * sin + start[1] * cos
    local[:, 2] = start[2] + (end[2] - start[2]) * fractions
    points[:, :3] = local @ axes + centre
    return points


def turning_points(move: Move) -> np.ndarray:
    """Return the positions (n, 9) of a move's ends, and of an arc where X, Y or Z turns back."""
    if move.kind != "arc":
        return np.array([move.start, move.end])
    one, two, _ = plane_axes(move)
    first, sweep = np.subtract(move.start[:3], move.centre), move.sweep
    ahead = np.arctan2(two, one) - math.atan2(two @ first, one @ first)
    turns = (math.copysign(1.0, sweep) * ahead) % math.pi
    shares = np.concatenate([turns, turns + math.pi]) / max(abs(sweep), 1e-12)
    return arc_points(move, np.concatenate([[0.0], np.sort(shares[shares < 1.0]), [1.0]]))


def paths(part: Part, moves: Iterable[Move], chord_error: float = CHORD_ERROR) -> list[np.ndarray]:
    """Return the moves as polylines (n, 3) on the part, one for each run without a gap."""
    found: list[list[np.ndarray]] = []
    for move in moves:
        points = part.polyline(move, chord_error)
        if found and np.allclose(found[-1][-1][-1], points[0], atol=1e-9):
            found[-1].append(points[1:])
        else:
            found.append([points])
    return [np.concatenate(segments) for segments in found]


def swept(lines: Iterable[np.ndarray], radius: float) -> BaseGeometry:
    """Return the area in the part plane that a cutter of ``radius`` sweeps along polylines."""
    return unary_union([_swept_line(line[:, :2], radius) for line in lines])


def _swept_line(line: np.ndarray, radius: float) -> BaseGeometry:
    """Return the area along one line.

    It is the union of short stretches: the time and memory of a buffer grow with the crossings of
    its own line, and GEOS 3.11 loses the middle of a closed one. A circle is the disc of its outer
    edge without that of its inner one, which is much quicker.
    """
    changed = np.any(np.abs(np.diff(line, axis=0)) > 1e-9, axis=1)
    line = line[np.concatenate([[True], changed])]
    if len(line) > 2 * LEAST_CHORDS + 1 and np.abs(line[0] - line[-1]).max() < 1e-9:
        middle = line[:-1].mean(axis=0)
        away = np.linalg.norm(line - middle, axis=1)
        if np.ptp(away) < 1e-6:
            edges = max(away[0] - radius, 0.0), away[0] + radius
            inner, outer = (Point(middle).buffer(edge, DISC_SEGMENTS) for edge in edges)
            return outer.difference(inner)
    if len(line) == 1:
        return Point(line[0]).buffer(radius, DISC_SEGMENTS)
    step = min(STRETCH, max(1, len(line) // 2))
    stretches = (line[first : first + step + 1] for first in range(0, len(line) - 1, step))
    return unary_union([LineString(each).buffer(radius, DISC_SEGMENTS) for each in stretches])


def disc(centre: Sequence[float], radius: float, chord_error: float = CHORD_ERROR) -> BaseGeometry:
    segments = arc_segments(radius, math.pi / 2, chord_error)
    return Point(centre[0], centre[1]).buffer(radius, segments)


def plane_axes(move: Move) -> np.ndarray:
    """Return the directions of a move's plane: first, second and third axis, as rows."""
    return axes_of_plane(move.plane, move.rotation)


@lru_cache(maxsize=64)
def axes_of_plane(plane: int, rotation: float) -> np.ndarray:
    """Return the same of a plane by its number, in a system rotated about Z by degrees."""
    cos, sin = np.cos(np.radians(rotation)), np.sin(np.radians(rotation))
    turned = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    axes = np.roll(turned, 2 - THIRD_AXIS[plane], axis=0)
    axes.flags.writeable = False
    return axes
