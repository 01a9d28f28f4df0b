# SPDX-License-Identifier: GPL-2.0-or-later
"""One cycle in all modes and coordinate systems: the same machine path.

A ``Case`` writes its block for a scale (25.4 for a program in mm) and for G90 or G91.
"""

import itertools
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from hypothesis import strategies as st

from support import cut_geometry
from support.refusals import at_line

INCH = 25.4
OUT = -9999  # an entry that is left out
PAIRS = [("G20", "G21"), ("G90", "G91"), ("G90.1", "G91.1"), ("G94", "G95"), ("G8", "G7")]
PATHS = ("G61", "G64", "G64 P0.01")
# Any four of the five pairs meet in every way: the sum of the places is even.
HALF = [places for places in itertools.product((0, 1), repeat=5) if sum(places) % 2 == 0]
MODES = [
    (*(pair[at] for pair, at in zip(PAIRS, places)), PATHS[number % 3])
    for number, places in enumerate(HALF)
]
COORDINATES = {  # parameters in inches and degrees
    "plain": {},
    "shifted": {5221: 3.0, 5222: -2.0, 5223: 0.5},
    "rotated": {5221: 3.0, 5222: -2.0, 5223: 0.5, 5230: 30.0},
    "G92": {5211: 0.25, 5212: 0.125, 5213: -0.0625, 5210: 1.0, 5230: -12.5},
    "far": {5221: 900.0, 5222: -900.0, 5230: 45.0},
}
FRACTIONS = (0.0, 0.3, 0.5, 0.8, 1.0)  # of each move: enough to tell an arc from any other
UNSCALED = (5210, 5230)  # G92 is on, the rotation


class Case(NamedTuple):
    """A cycle from ``start``, an absolute point in inches; ``block(scale, incremental)``."""

    block: Callable[[float, bool], str]
    start: tuple = (0.5, 0.25, 0.1)
    feed: float = 5.0

    def program(self, units, distance, centres, feed, diameter, path):
        """Return the blocks before the cycle, and the cycle's."""
        scale = 1.0 if units == "G20" else INCH
        start = " ".join(f"{axis}{v * scale:.10f}" for axis, v in zip("XYZ", self.start))
        modes = f"{distance} {centres} {feed} {path} {diameter} F{self.feed * scale:.10f}"
        before = [f"{units} G90 G8 G0 {start}", "T1 M6", "S1000 M3", modes]
        block = self.block(scale, distance == "G91")
        return before, diameters(block) if diameter == "G7" else block


def words(scale, **values):
    """Return scaled words: ``words(25.4, X=1.0)`` is ``X25.4``."""
    return " ".join(f"{letter}{value * scale:.10f}" for letter, value in values.items())


def event_call(**entries):
    """Return the call of an event of the circle mill with these entries, the others left out."""
    values = " ".join(f"[{entries.get(letter, OUT)}]" for letter in "gxyzwordckjlpfv")
    return f"o<circle_mill> call {values}"


def diameters(block):
    """Return a block with its X words doubled, as G7 reads them."""
    return re.sub(r"\bX(-?[\d.]+)", lambda word: f"X{2 * float(word[1]):.10f}", block)


def path_of(traced):
    """Return points along all that moves, and each move's kind and feed."""
    moves = cut_geometry.moving(traced.moves)
    points = [cut_geometry.points_at(move, FRACTIONS) for move in moves]
    return np.concatenate(points), [(move.kind, round(move.feed, 6)) for move in moves]


def check_same_path(inch, metric, case):
    """Check that all modes give themselves back, and make one path on both machines.

    A coordinate system meets every fifth of the modes. Under G95 the feed is per revolution, so
    kinds and feeds are compared for each of the two.
    """
    for number, coordinates in enumerate(COORDINATES.values()):
        points, feeds = None, {}
        for tracer, unit in ((inch, 1.0), (metric, INCH)):
            parameters = {
                key: value * (1.0 if key in UNSCALED else unit)
                for key, value in coordinates.items()
            }
            for modes in MODES[number :: len(COORDINATES)]:
                before, block = case.program(*modes)
                found = tracer.trace_text(before, parameters=parameters)
                after = tracer.trace_text([*before, block], parameters=parameters)
                check_modes(found, after)
                path, kinds = path_of(after)
                points = path if points is None else points
                assert path.shape == points.shape, modes
                assert np.abs(path - points).max() < 1e-6, modes
                assert kinds == feeds.setdefault("G95" in modes, kinds), modes


def check_modes(found, after):
    """Check that a good block left the modes as it found them."""
    assert after.error is None, after.error
    assert after.modes == found.modes
    assert after.globals == found.globals


def check_refused(tracer, before, block, message, keeps=None):
    """Check that a block is refused with a text that begins so, moves and changes nothing.

    ``keeps`` names the state that it keeps where codes of its own have changed some: all of it.
    """
    found = tracer.trace_text(before)
    after = tracer.trace_text([*before, block])
    assert after.error is not None, block
    line = len(before) + 1
    assert after.error.text.startswith(at_line(message, line)) and after.error.line == line
    assert len(after.error.text) <= 255
    assert moved(after) == moved(found)
    assert after.modes == found.modes
    kept = found.state if keeps is None else keeps
    assert [after.state[name] for name in kept] == [found.state[name] for name in kept]
    assert after.globals == found.globals
    assert after.messages == found.messages


def moved(traced):
    """Return the moves but for what a G4 of the refused block, executed before it, makes exact."""
    return [move._replace(exact=False) for move in traced.moves]


OF_THE_PARSER = ("Non integer value for integer", "Negative h word used", "Negative l word used")
VALUES = st.sampled_from(
    [-9999, -2, -1, -0.5, -0.001, 0, 0.00005, 0.02, 0.1, 0.25, 0.3, 0.5, 1, 2, 3, 7, 10, 50, 1e6]
)


def blocks(code, letters):
    """Return a strategy of blocks with any of the letters and any odd values."""
    entries = st.dictionaries(st.sampled_from(letters), VALUES, max_size=len(letters))
    return entries.map(
        lambda values: " ".join([code, *(f"{letter}{values[letter]:.5f}" for letter in values)])
    )


def check_cut_or_refused(tracer, before, block, name):
    """Check that any block either cuts or is refused in words, without a move or a change."""
    found = tracer.trace_text(before)
    after = tracer.trace_text([*before, block])
    assert after.printed == ""
    if after.error is None:
        assert len(after.moves) > len(found.moves)
        assert after.modes == found.modes
    else:
        assert after.error.text.startswith((f"{name} line {len(before) + 1}: ", *OF_THE_PARSER))
        assert (after.moves, after.modes) == (found.moves, found.modes)


def remaps(include):
    """Return the REMAP lines of a file of `configs/include`, for an INI override."""
    lines = include.read_text().splitlines()
    return [line.partition("=")[2].strip() for line in lines if line.startswith("REMAP")]
