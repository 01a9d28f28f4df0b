# SPDX-License-Identifier: GPL-2.0-or-later
"""The gain of a polar section from kinematics: its estimated time with and without, and the least.

Lengths are mm, times seconds, angles radians. The tool's path is divided into even steps from one
corner to the next, where the tool stops; C also turns at rest at the pole.

In segments, LinuxCNC is no faster within a segment than it can brake in it. A segment of X and C is
a spiral. Where the path makes the angle p with the radius r, the spiral has the curvature sin p (1
+ cos(p)**2) / r, and its difference from the path's own curvature gives the segment's length.

On the face the planner may brake anywhere with all of its acceleration A, and C and the slide have
to follow. The path takes the share p v**2 of an axis's acceleration, braking q times the planner's:
p v**2 + q sqrt(A**2 - v**4 / R**2) is at most 1. A is chosen once a section, for the least time.

The least time, a lower bound for any planner, is a time-optimal path parametrisation: with z the
square of the speed along the path and u half its change, an axis q(s) has the acceleration
q' u + q'' z. Backwards along the path, the greatest z is found from which the rest can still be
followed; forwards, the greatest of these that can be reached.

An axis of acceleration A allows |u + w z| <= A / |q'|, with w = q'' / q'. That is a pair of
straight lines in the plane of u and z, so the greatest z is where two of them meet.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from g12.geometry.curve import Curve
from g12.machine_ini import face_of
from g12.tools.machine.ini import Ini

STEP, FEWEST, MOST = 0.1, 40, 4000  # mm; greatest number from one corner to the next
SMOOTH_CORNER = math.radians(5.0)  # a sharper corner is a stop
SEGMENT_BULGE = 1.44  # of the tolerance
STOPPED_IN = 0.4  # measured: the square of the speed by length times acceleration of a segment
TRIED_SHARES = 0.8 ** np.arange(10)  # of the face's acceleration: the tried values
PLANNED, SWITCHING = 0.7, 0.05  # of it along the path; seconds for both switches
OF_SLIDE = 0.7  # acceleration of X and Y on a machine without kinematics
TINY = 1e-9  # a smaller slope of an axis along the path, among others, counts as this
STRAIGHT = 1e-6  # 1/mm: a smaller curvature is a line's
Pair = tuple[np.ndarray, np.ndarray]  # of an axis: two values at each point of the path


class Rates(NamedTuple):
    """The greatest speed and acceleration of an axis."""

    speed: float
    acceleration: float


class LatheAxes(NamedTuple):
    """The limits of the slide in mm, and of C in degrees.

    ``face`` are the accelerations of X and of Y on the face of the kinematics, empty without them;
    ``tolerance`` is POLAR_TOLERANCE.
    """

    slide: Rates
    c: Rates
    face: tuple[float, ...] = ()
    tolerance: float = 0.0

    @property
    def c_radians(self) -> Rates:
        return Rates(*map(math.radians, self.c))


def lathe_axes(ini: Ini) -> LatheAxes:
    """Return the limits in an INI; the slide's are those of its joint with kinematics."""
    axes, face, mm = ini.axis_limits, face_of(ini.get), ini.mm
    slide, c = (face.slide if face else axes["X"]), axes["C"]
    return LatheAxes(
        Rates(slide.velocity * mm, slide.acceleration * mm),
        Rates(c.velocity, c.acceleration),
        (face.x.acceleration * mm, face.y.acceleration * mm) if face else (),
        ini.settings.tolerance(mm) * mm,
    )


class Leg(NamedTuple):
    """A move of the tool across the face: its curve, and its feed along it in mm/s."""

    curve: Curve
    feed: float


class SectionTimes(NamedTuple):
    """Seconds of a section: in segments, with kinematics, and at the limits of slide and C."""

    segments: float
    kinematics: float
    least: float


class _Stretch(NamedTuple):
    """Points (complex) one step apart from one stop to the next, with their feeds."""

    points: np.ndarray
    feed: np.ndarray

    @property
    def step(self) -> float:
        return float(np.abs(np.diff(self.points)).mean())

    @property
    def bend(self) -> np.ndarray:
        """The path's signed curvature."""
        heading = np.gradient(self.points, self.step)
        return (np.gradient(heading, self.step) * heading.conj()).imag

    @property
    def derivatives(self) -> tuple[Pair, Pair]:
        """Both derivatives along the path of the slide's position, and of C's angle."""
        axes = np.abs(self.points), np.unwrap(np.angle(self.points))
        slopes = [np.gradient(axis, self.step) for axis in axes]
        slide, c = ((slope, np.gradient(slope, self.step)) for slope in slopes)
        return slide, c


def section_times(legs: Sequence[Leg], axes: LatheAxes) -> SectionTimes:
    stretches = [stretch for run in _smooth(legs) for stretch in _off_pole(_drawn(run))]
    turns = sum(
        _turn(one.points[-1], other.points[0], axes) for one, other in zip(stretches, stretches[1:])
    )
    segments = [_in_segments(each, axes) for each in stretches]
    chorded = sum(_seconds(each, *how) for each, how in zip(stretches, segments))
    face = min(
        sum(_on_face(each, *how, axes, share) for each, how in zip(stretches, segments))
        for share in TRIED_SHARES
    )
    least = sum(
        least_seconds(each.points, each.feed, axes.slide, axes.c_radians) for each in stretches
    )
    return SectionTimes(chorded + turns, min(chorded, face + SWITCHING) + turns, least + turns)


def _smooth(legs: Iterable[Leg]) -> Iterator[list[Leg]]:
    run: list[Leg] = []
    for leg in legs:
        if run and abs(leg.curve.direction(0.0) - run[-1].curve.direction(1.0)) > SMOOTH_CORNER:
            yield run
            run = []
        run.append(leg)
    if run:
        yield run


def _drawn(run: Sequence[Leg]) -> _Stretch:
    """Return moves without a corner as evenly spaced points."""
    ends = np.cumsum([0.0, *(leg.curve.length for leg in run)])
    count = int(min(MOST, max(FEWEST, ends[-1] / STEP)))
    lengths = np.linspace(0.0, ends[-1], count + 1)
    owners = np.clip(np.searchsorted(ends, lengths, side="right") - 1, 0, len(run) - 1)
    shares = (lengths - ends[owners]) / np.diff(ends)[owners]
    points = np.array([run[n].curve.point(share) for n, share in zip(owners, shares)])
    return _Stretch(points, np.array([leg.feed for leg in run])[owners])


def _off_pole(stretch: _Stretch) -> Iterator[_Stretch]:
    """Yield the portions of a stretch that are off the pole, by more than a step."""
    off = np.abs(stretch.points) > max(STEP, stretch.step)
    edges = np.flatnonzero(np.diff([0, *off.astype(int), 0]))
    for first, last in zip(edges[::2], edges[1::2]):
        if last - first > 2:
            yield _Stretch(*(each[first:last] for each in stretch))


def _turn(end: complex, start: complex, axes: LatheAxes) -> float:
    """Return the time of C's turn at the pole between two points, 0 where they coincide."""
    turn = abs(np.angle(start * np.conj(end)))
    speed, acceleration = axes.c_radians
    top = min(speed, math.sqrt(turn * acceleration))
    return float(turn / top + top / acceleration) if turn > TINY else 0.0


def _in_segments(stretch: _Stretch, axes: LatheAxes) -> tuple[np.ndarray, np.ndarray]:
    """Return the speeds in segments, and the acceleration along the path."""
    (along, _), (turn, _) = stretch.derivatives
    radius, slope = np.abs(stretch.points), _size(along)
    (speed, slide), (c_speed, spindle) = axes.slide, axes.c_radians
    spiral = turn * (1.0 + along**2)
    deviation = np.minimum(axes.tolerance, 0.5 * radius)
    bulge = 8.0 * SEGMENT_BULGE * deviation / _size(stretch.bend - spiral)
    length = np.minimum(np.sqrt(bulge), len(radius) * stretch.step)
    length = np.where(np.abs(turn) > TINY, np.minimum(length, radius / slope), length)
    quick = np.minimum(slide / slope, spindle / _size(turn))
    most = np.minimum(speed / slope, c_speed / _size(turn))
    chorded = np.sqrt(STOPPED_IN * quick * length)
    return np.minimum(np.minimum(stretch.feed, most), chorded), quick


def _on_face(
    stretch: _Stretch,
    chorded: np.ndarray,
    quick: np.ndarray,
    axes: LatheAxes,
    share: float,
) -> float:
    """Return the seconds with kinematics, with segments where those are quicker."""
    face = axes.face or [OF_SLIDE * axes.slide.acceleration] * 2
    whole = share * math.hypot(*face)
    most = np.where(np.abs(stretch.bend) > STRAIGHT, share * min(face), whole)
    followed = np.minimum(stretch.feed, _followed(stretch, axes, most))
    braking = np.where(followed >= chorded, PLANNED * whole, quick)
    return _seconds(stretch, np.maximum(followed, chorded), braking)


def _followed(stretch: _Stretch, axes: LatheAxes, most: np.ndarray) -> np.ndarray:
    """Return the highest speed that C and the slide can follow, wherever the planner brakes."""
    square = most / _size(stretch.bend)
    for (first, second), (speed, limit) in zip(stretch.derivatives, (axes.slide, axes.c_radians)):
        p, q = np.abs(second) / limit, np.abs(first) / limit
        both = np.maximum(p * p + (q * stretch.bend) ** 2, TINY**2)
        under = p * p - both * (1.0 - (q * most) ** 2)
        bound = (p - np.sqrt(np.maximum(under, 0.0))) / both
        square = np.minimum(square, (speed / _size(first)) ** 2)
        square = np.where(under >= 0.0, np.minimum(square, np.maximum(bound, 0.0)), square)
        square = np.where(q * most > 1.0 + 1e-6, 0.0, square)
    return np.sqrt(square)


def _size(values: np.ndarray) -> np.ndarray:
    """Return absolute values that may be divided by."""
    return np.maximum(np.abs(values), TINY)


def _seconds(stretch: _Stretch, speeds: np.ndarray, braking: np.ndarray) -> float:
    """Return the time of a stretch from stop to stop, at most at these speeds."""
    gains = 2.0 * stretch.step * braking
    return _quickest(np.square(speeds), stretch.step, [(gains, np.zeros(len(gains)))])


def least_seconds(
    points: np.ndarray, speed: float | np.ndarray, slide: Sequence[float], spindle: Sequence[float]
) -> float:
    """Return the least time of a path of points (complex), from stop to stop.

    ``speed`` is the programmed one, perhaps one for each point; ``spindle`` is in radians. The
    points are evenly spaced along the path, none of them in the centre.
    """
    stretch = _Stretch(points, np.broadcast_to(np.asarray(speed, float), points.shape))
    step, most = stretch.step, np.square(stretch.feed)
    limits = []
    for (slope, bend), (velocity, acceleration) in zip(stretch.derivatives, (slide, spindle)):
        slope = np.where(np.abs(slope) < TINY, TINY, slope)
        most = np.minimum(most, np.square(velocity / slope))
        limits.append((2.0 * step * acceleration / np.abs(slope), 2.0 * step * bend / slope))
    (reserve, swing), (other, other_swing) = limits
    apart = np.maximum(np.abs(swing - other_swing), TINY**2)
    return _quickest(np.minimum(most, (reserve + other) / apart), step, limits)


def _quickest(most: np.ndarray, step: float, limits: Sequence[Pair]) -> float:
    """Return the least time from stop to stop over points one step apart.

    ``most`` are the squares of the speed there. The limits are those of an axis each: by how much
    the square can change in a step (its reserve), and by what share of it more or less (its swing).
    An axis that brakes more at a higher speed is evaluated at the step's end: no step brakes below
    zero.
    """
    axes = [*zip(*(zip(*(values.tolist() for values in limit)) for limit in limits))]
    squares, greatest = most.tolist(), 0.0
    for at in reversed(range(len(squares))):  # from which the rest can be followed
        squares[at] = min(squares[at], greatest)
        swinging = (pair for pair in axes[at - 1] if pair[1] < 1.0)
        braked = ((squares[at] + reserve) / (1.0 - swing) for reserve, swing in swinging)
        greatest = min(braked, default=math.inf)
    squares[0] = 0.0
    for at in range(len(squares) - 1):  # of these, what can be reached
        square = squares[at]
        gained = (
            (square + reserve) / (1.0 + swing) if swing > 0.0 else square + reserve - swing * square
            for reserve, swing in axes[at]
        )
        squares[at + 1] = min(squares[at + 1], *gained)
    speeds = np.sqrt(np.maximum(squares, 0.0))
    return float((2.0 * step / np.maximum(speeds[1:] + speeds[:-1], 1e-9)).sum())
