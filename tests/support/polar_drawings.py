# SPDX-License-Identifier: GPL-2.0-or-later
"""The drawings of the polar sample programs: the path of the cutter's centre, block by block.

Each drawing maps a block's line in the program to the segments of its path in the plane, in the
program's units.
"""

import math
from typing import NamedTuple

from support.contour_geometry import Straight, arc, lines, outward


class Drawing(NamedTuple):
    """The path of the cutter's centre by program line, and its radius."""

    path: dict
    cutter: float

    @property
    def segments(self):
        return [segment for segments in self.path.values() for segment in segments]


def _compensated(first, contour, cutter, approach, leave=None):
    """Return the path of a contour that begins in block ``first``, with its ramps.

    ``approach`` maps blocks before it to points, the ramp's goes on to the contour;
    ``leave`` is the block and the point of the ramp off.
    """
    groups = outward(contour, cutter)
    blocks = list(approach)
    stops = [approach[block] for block in blocks]
    path = {block: lines(*stops[at : at + 2]) for at, block in enumerate(blocks[:-1])}
    path[blocks[-1]] = [Straight(complex(*stops[-1]), groups[0][0].start)]
    path.update(enumerate(groups, first))
    if leave:
        path[leave[0]] = [Straight(groups[-1][-1].end, complex(*leave[1]))]
    return path


HEXAGON = lines(
    (13.5, 18), (13.5, -7.7942), (0, -15.5885), (-13.5, -7.7942), (-13.5, 7.7942), (0, 15.5885),
    (13.5, 7.7942),
)  # fmt: skip
SQUARE = [
    *lines((15, 5), (15, -10)), arc((10, -10), 5, 0, -90), *lines((10, -15), (-10, -15)),
    arc((-10, -10), 5, -90, -90), *lines((-15, -10), (-15, 10)), arc((-10, 10), 5, 180, -90),
    *lines((-10, 15), (10, 15)), arc((10, 10), 5, 90, -90), *lines((15, 10), (15, 0)),
]  # fmt: skip
NOSE, BASE = (
    math.degrees(math.atan2(c, x)) for x, c in ((0.69625, -0.7177996), (0.078125, -0.996943))
)
CAM = [
    arc((16, 0), 5, 0, NOSE), arc((-1.40625, 17.94499), 30, NOSE, BASE - NOSE),
    arc((0, 0), 12, BASE, -360 - 2 * BASE), arc((-1.40625, -17.94499), 30, -BASE, BASE - NOSE),
    arc((16, 0), 5, -NOSE, NOSE),
]  # fmt: skip
CLEAR = math.degrees(math.asin(0.4153 / 0.65))
FLATS = [
    *lines((0.5, 0.4153), (0.5, -0.4153)), arc((0, 0), 0.65, -CLEAR, 2 * CLEAR - 180),
    *lines((-0.5, -0.4153), (-0.5, 0.4153)),
]  # fmt: skip
AROUND = math.degrees(math.asin(0.5339 / 1.025))
CENTRES = [
    *lines((0.875, 0.5339), (0.875, -0.5339)), arc((0, 0), 1.025, -AROUND, 2 * AROUND - 180),
    *lines((-0.875, -0.5339), (-0.875, 0.5339)),
]  # fmt: skip


def _flat(first, approach):
    """Return the path of method A for one flat, from X ``approach``."""
    points = [(approach, 0), (approach, 0.4153), (0.75, 0.4153), (0.75, -0.4153), (0.9, -0.4153)]
    return dict(zip((first, first + 1, first + 3, first + 4), ([line] for line in lines(*points))))


def _turned(path):
    """Return straight segments turned by 180 degrees."""
    return {
        block: [Straight(-segment.start, -segment.end) for segment in path[block]] for block in path
    }


SECOND_START = math.hypot(0.9, 0.4153)  # where the first flat leaves the X slide
SLOT = {7: lines((18, 0), (-18, 0)), 8: lines((-18, 0), (-18, 1)), 9: lines((-18, 1), (18, 1))}
CIRCLES = {
    7: [arc((4, 0), 10, 0, 360)],
    8: lines((14, 0), (19, 0)),
    9: [arc((19, -5), 5, 90, -360)],
}

MILLIMETRES = {
    "hexagon": Drawing(
        _compensated(10, HEXAGON, 6, {7: (30, 0), 8: (30, 18)}, (16, (30, 7.7942))), 6
    ),
    "square": Drawing(_compensated(9, SQUARE, 5, {6: (30, 0), 7: (30, 5)}, (18, (30, 0))), 5),
    "slot": Drawing(SLOT, 3),
    "circles": Drawing(CIRCLES, 0),
    "cam": Drawing(_compensated(10, CAM, 6, {8: (35, 0)}, (15, (35, 0))), 6),
}
INCHES = {
    "manual_a": Drawing({**_flat(11, 0.9), **_turned(_flat(20, SECOND_START))}, 0.25),
    "manual_b": Drawing(
        _compensated(14, FLATS, 0.25, {11: (0.9, 0), 12: (0.9, 0.4153)}, (17, (-0.9, 0.4153))), 0.25
    ),
    "manual_sample": Drawing(
        _compensated(15, CENTRES, 0, {12: (1.075, 0), 13: (1.075, 0.5339)}, (18, (-1.075, 0.5339))),
        0.375,
    ),
}
