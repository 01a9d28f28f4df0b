# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves made by hand, for tests that need no LinuxCNC: paths of known shape, and known faults."""

import math

import numpy as np

from g12.tools.path.samples import Samples
from g12.tools.path.track import Limits
from g12.tools.preview.moves import Modes, Move, ToolTable, Trace

HOME = (0.0,) * 9
# X, Y and Z in mm/s, C in degrees/s, and along the path
LIMITS = Limits((100.0, 100.0, 50.0, math.inf, math.inf, 360.0, *[math.inf] * 3), 120.0)
METRIC = Modes(("G1", "G17", "G21", "G90"), ("M2",), 100.0, 0.0, (0.0, 0.0))


class Hand:
    """Draws moves from where the last one ended; X Y Z C in mm and degrees, feed in mm/min."""

    def __init__(self, *, tool=1, feed=600.0):
        self.moves, self.at, self.tool, self.feed = [], HOME, tool, feed
        self.block, self.offset = 1, HOME

    def rapid(self, **to):
        return self._add("rapid", self._to(to), 0.0)

    def line(self, **to):
        return self._add("feed", self._to(to), self.feed)

    def arc(self, turns, cx, cy, plane=17, **to):
        centre = (cx, cy, self.at[2])
        return self._add("arc", self._to(to), self.feed, plane, centre, turns)

    def next_block(self):
        self.block += 1
        return self

    def pocket(self, rings, depth):
        """Plunge in the centre, cut rings outward clockwise, half circles in and out."""
        x, y = self.at[:2]
        self.line(z=depth).arc(-1, x + rings[0] / 2, y, x=x + rings[0])
        for radius in rings:
            self.line(x=x + radius).arc(-1, x, y)
        return self.arc(-1, x + rings[-1] / 2, y, x=x)

    def polar(self, points, feed=600.0):
        """Straight segments in X and C through points (complex) of the part plane."""
        angle = self.at[5]
        for point in points:
            target = math.degrees(math.atan2(point.imag, point.real))
            angle += (target - angle + 180.0) % 360.0 - 180.0
            self.feed = feed
            self.line(x=abs(point), c=angle)
        return self

    def trace(self):
        nothing = {"state": {}, "globals": {}}
        return Trace(
            moves=self.moves,
            events=[],
            error=None,
            modes=METRIC,
            printed="",
            position=self.at,
            tables=[(0, ToolTable({1: 6.0, 2: 10.0}, {}, {}))],
            **nothing,
        )

    def _to(self, to):
        named = dict(zip("xyzabcuvw", self.at))
        return tuple({**named, **to}.values())

    def _add(self, kind, end, feed, plane=17, centre=None, turns=0):
        mode = "G94" if feed else ""
        where = (self.block, self.block, self.at, end)
        how = (feed, mode, plane, self.tool, self.offset, centre, turns)
        self.moves.append(Move(kind, *where, *how))
        self.at = end
        return self


def samples_of(path, count=2000, shift=0.0, axes="XYZ"):
    """Return evenly timed samples of a run along a track, ``shift`` beside it in Y (or X)."""
    times = np.linspace(0, path.time[-1], count)
    stands = path.positions + path.offsets
    found = {
        letter: np.interp(times, path.time, stands[:, "XYZABC".index(letter)]) for letter in axes
    }
    found["Y" if "Y" in axes else "X"] += shift
    ones = np.ones(count)
    return Samples(times, found, ones, ones.astype(int), 2 * ones.astype(int))
