# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar sections for tests: programs around them, and their moves seen in the plane again."""

import math
from itertools import groupby

import numpy as np

from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

FIRST = "G21 G18 G8 G40 G49 G54 G64 G80 G90 G91.1 G94 G97"
START = "G0 X20 Z5 C0"
X, Z, C = 0, 2, 5
C_ACCELERATION = 3600  # of the lathes, degrees/s²
FEED, ROUND = 2, 3  # kinds of a sampled move: straight and circular
MILLIMETRES = ("hexagon", "square", "slot", "circles", "cam")  # programs of tests/programs/polar
INCHES = ("manual_a", "manual_b", "manual_sample")


def section(
    *body, before=(), after=(), first=FIRST, start=START, tool="T1 M6", feed="F100",
    on="G12.1", off="G13.1",
):  # fmt: skip
    """Return a program whose section holds ``body``, from line 6 on (``before`` adds lines)."""
    return [first, start, tool, feed, *before, on, *body, off, *after, "M2"]


def cut(lathe, *body, **around):
    """Return the trace of a program with a section."""
    return lathe.trace_text(section(*body, **around))


def refused(lathe, program):
    """Return text and line of the refusal; nothing of the section may have moved."""
    traced = lathe.trace_text(program)
    assert traced.error is not None
    assert [move.kind for move in traced.moves] == ["rapid"], "the section moved"
    assert len(traced.error.text) <= 255
    return traced.error.text, traced.error.line


def tracer(**overrides):
    """Return a Tracer of the millimetre lathe; ``overrides`` are settings of [G12]."""
    return Tracer(SIM / "lathe_mm.ini", overrides={"G12": overrides} if overrides else None)


def in_plane(position, zero=0.0):
    """Return (x, c, z) of a machine position in the plane whose zero angle is at C ``zero``."""
    angle = math.radians(position[C] - zero)
    return position[X] * math.cos(angle), position[X] * math.sin(angle), position[Z]


def feed_moves(traced):
    """Return the moves that are no rapids of a program that ran to its end."""
    assert traced.error is None, traced.error
    return [move for move in traced.moves if move.kind != "rapid"]


def ends(traced, zero=0.0):
    """Return the plane point (x, c) at the end of each block that moved at a feed."""
    blocks = groupby(feed_moves(traced), key=lambda move: move.line)
    points = [in_plane(list(moves)[-1].end, zero) for _, moves in blocks]
    return [(round(x, 6) + 0.0, round(c, 6) + 0.0) for x, c, _ in points]


def lines(traced):
    """Return the line of each block that moved at a feed."""
    return [line for line, _ in groupby(feed_moves(traced), key=lambda move: move.line)]


def texts(traced):
    """Return the operator's messages, without blanks around them."""
    assert traced.error is None, traced.error
    return [message.text.strip() for message in traced.messages]


class Cut:
    """The part of a run that was cut at a feed, in the plane."""

    def __init__(self, run_or_samples):
        samples = getattr(run_or_samples, "samples", run_or_samples)
        cutting = np.isin(samples.kind, (FEED, ROUND))
        angles = np.radians(samples.axes["C"])
        points = np.column_stack([np.cos(angles), np.sin(angles)]) * samples.axes["X"][:, None]
        self.all_points, self.points = points, points[cutting]
        self.z, self.lines = samples.axes["Z"][cutting], samples.line[cutting]
        steps = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
        self.speeds = steps[cutting] / 0.001 * 60
        self.c, self.x = samples.axes["C"], samples.axes["X"]

    def of(self, line, ends=0.15):
        """Return the points of a block without its two ends (a share of its samples)."""
        return self._inner(self.points, line, ends)

    def speed(self, line):
        """Return the speed along the part in the middle of a block, per minute."""
        return np.median(self._inner(self.speeds, line, 0.3))

    def _inner(self, values, line, ends):
        chosen = values[self.lines == line]
        cut = int(len(chosen) * ends)
        return chosen[cut : len(chosen) - cut]


def accelerations(positions):
    """Return those of positions sampled once a millisecond, without signs, per second squared."""
    return np.abs(np.diff(positions, 2)) * 1e6


def exceeds_limits_itself(lathe):
    """Tell whether three plain moves of C, with nothing of the package, exceed its acceleration.

    They do where LinuxCNC comes to a blend at the full rate and then stops at half of it, ten
    times beyond the limit: f44628a478 of July 2026 to its issue 4539 of September, in no release.
    """
    plain = ["G21 G18 G90 G94 G64", "G0 X20 Z5 C0", "F18000", "G1 C3", "C6", "C9", "M2"]
    run = lathe.run_text(plain)
    assert run.error is None
    return accelerations(run.samples.axes["C"]).max() > C_ACCELERATION * 1.01
