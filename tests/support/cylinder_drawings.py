# SPDX-License-Identifier: GPL-2.0-or-later
"""The drawings of the sample programs for the cylinder, on the unrolled surface, block by block.

C as a length is x and to the right, Z is c and upwards (`support.contour_geometry`). Nothing here
knows the package.
"""

import math
from typing import NamedTuple

import numpy as np

from support.contour_geometry import Straight, arc, lines

FEED, ROUND = 2, 3  # kinds of a sampled move: straight and circular


class Unrolled(NamedTuple):
    """The contour of a program by its lines, and how far beside it the tool's centre goes."""

    radius: float
    contour: dict
    beside: float = 0.0

    @property
    def segments(self):
        return [segment for segments in self.contour.values() for segment in segments]


def degrees(radius, *places):
    """Return places (C in degrees, Z) as lengths on the surface."""
    return [(math.radians(c) * radius, z) for c, z in places]


def by_line(first, segments):
    """Return segments by program lines that follow each other."""
    return {line: [segment] for line, segment in enumerate(segments, first)}


def _rise(start, end):
    """Return two equal tangent arcs between places that lie on parallels."""
    (x0, z0), (x1, z1) = start, end
    half, high = (x1 - x0) / 2, (z1 - z0) / 2
    radius = (half**2 + high**2) / (2 * abs(high))
    angle = math.degrees(math.asin(half / radius))
    up = math.copysign(1.0, high)
    first = arc((x0, z0 + up * radius), radius, -90 * up, up * angle)
    second = arc((x1, z1 - up * radius), radius, 90 * up + up * angle, -up * angle)
    return [first, second]


D = 20.0
_CAM = degrees(D, (0, -30), (60, -30), (110, -20), (220, -20), (270, -30), (360, -30))
_ONE = 57.299 * math.pi / 180  # a degree on the text-book's surface


def _textbook():
    """Return the contour under G42 as its drawing has it; the arcs' centres by Pythagoras."""
    place = [(c * _ONE, z) for c, z in (
        (0, 120), (30, 120), (60, 90), (60, 70), (70, 60), (150, 60), (190, 70), (230, 110),
        (270, 120), (360, 120),
    )]  # fmt: skip
    bends = {1: (-1, 30), 3: (1, 10), 5: (1, 75), 7: (-1, 75)}
    segments = []
    for k, (start, end) in enumerate(zip(place, place[1:])):
        segments.append(bend(start, end, *bends[k]) if k in bends else Straight(*_two(start, end)))
    return by_line(9, segments)


def _two(start, end):
    return complex(*start), complex(*end)


def bend(start, end, turn, radius):
    """Return the arc of at most a half turn between two places."""
    a, b = _two(start, end)
    height = math.sqrt(radius**2 - abs(b - a) ** 2 / 4)
    centre = (a + b) / 2 + turn * 1j * (b - a) / abs(b - a) * height
    sweep = turn * 2 * math.degrees(math.asin(abs(b - a) / 2 / radius))
    arm = a - centre
    return arc(
        (centre.real, centre.imag), radius, math.degrees(math.atan2(arm.imag, arm.real)), sweep
    )


DRAWINGS = {
    "helix": Unrolled(
        D, by_line(7, lines(*degrees(D, (0, -10), (90, -10), (990, -40), (1080, -40))))
    ),
    "slot": Unrolled(
        D, by_line(7, lines(*degrees(D, (10, -10), (10, -30), (55, -30), (55, -10), (10, -10))))
    ),
    "cam_groove": Unrolled(
        D,
        by_line(
            7,
            [
                *lines(*_CAM[:2]), *_rise(_CAM[1], _CAM[2]), *lines(*_CAM[2:4]),
                *_rise(_CAM[3], _CAM[4]), *lines(*_CAM[4:]),
            ],
        ),
    ),
    "textbook": Unrolled(57.299, _textbook(), 6.0),
}  # fmt: skip


class Surface:
    """The part of a run that was cut at a feed, unrolled: places (C as a length, Z)."""

    def __init__(self, run_or_samples, radius):
        samples = getattr(run_or_samples, "samples", run_or_samples)
        cutting = np.isin(samples.kind, (FEED, ROUND))
        every = np.column_stack([np.radians(samples.axes["C"]) * radius, samples.axes["Z"]])
        self.points, self.lines = every[cutting], samples.line[cutting]
        self.x, self.c = samples.axes["X"][cutting], samples.axes["C"]
        steps = np.hypot(*np.diff(every, axis=0, prepend=every[:1]).T)
        self.speeds = steps[cutting] / 0.001 * 60

    def of(self, blocks):
        """Return the places of some blocks."""
        return self.points[np.isin(self.lines, list(blocks))]

    def speed(self, line):
        """Return the speed on the surface in the middle of a block, per minute."""
        chosen = self.speeds[self.lines == line]
        cut = int(len(chosen) * 0.3)
        return np.median(chosen[cut : len(chosen) - cut])

    def seconds(self, blocks):
        """Return the time spent in some blocks."""
        return np.isin(self.lines, list(blocks)).sum() * 0.001
