# SPDX-License-Identifier: GPL-2.0-or-later
"""Random contours as flat programs of a mill, the same round a part, and how far apart they are.

A contour is written with X and Y, which LinuxCNC reads itself, its cutter compensation included.
Round a part Y is an angle of A: a length of Y, upwards as seen from the tool, is -radians(A) times
the radius. With B X is the angle, and a length to the right is radians(B) times the radius.
"""

import cmath
import math

import numpy as np
from shapely.geometry import LineString

FIRST = "G21 G17 G8 G40 G49 G54 G64 G80 G90 G91.1 G94 G97"
SENSE = {"A": -1.0, "B": 1.0}  # LinuxCNC's: the right-hand rule, seen from the workpiece
WITH_B = {
    "TRAJ": {"COORDINATES": "X Y Z B"},
    "KINS": {"KINEMATICS": "trivkins coordinates=XYZB"},
    "AXIS_B": {"MIN_LIMIT": "-99999", "MAX_LIMIT": "99999", "MAX_VELOCITY": "360",
               "MAX_ACCELERATION": "3600"},
}  # fmt: skip
X, Y, Z, A, B = range(5)
# Radians: LinuxCNC itself takes a smaller turn for none, and its path is 0.003 mm off there.
LEAST_TURN, MOST_TURN = 0.15, math.pi / 2
CHORD = 1e-4  # mm


class FlatContour:
    """A contour of lines and arcs; ``blocks`` have the words X, Y, I, J and R as numbers."""

    def __init__(self, chance, tool_radius=3.0):
        self.chance, self.at, self.heading = chance, 0j, 1.0 + 0j
        self.start = complex(chance.uniform(-20, 20), chance.uniform(-20, 20))
        self.blocks = []
        self.at = self.start
        compensated = chance.random() < 0.5
        self.side = chance.choice((41, 42)) if compensated else 40
        self.least = (2.5 if compensated else 0.4) * tool_radius
        self._line(chance.uniform(self.least + 1, 15), f"G{self.side}" if compensated else "")
        if compensated:  # LinuxCNC's own first move is square to itself, not to the next one
            self._line(chance.uniform(self.least, 30), "", turning=False)
        for _ in range(chance.randint(2, 8)):
            if chance.random() < 0.5:
                self._arc()
            else:
                self._line(chance.uniform(self.least, 30), "")
        if compensated:
            self._line(chance.uniform(self.least + 1, 15), "G40")

    def _turn(self):
        """Turn at a corner, away from the tool's side where a part would be gouged."""
        turn = self.chance.uniform(LEAST_TURN, MOST_TURN)
        if self.side == 41 or (self.side == 40 and self.chance.random() < 0.5):
            turn = -turn
        self.heading *= cmath.exp(1j * turn)

    def _line(self, length, code, turning=True):
        if turning:
            self._turn()
        self.at += length * self.heading
        words = {"X": self.at.real} | {"Y": self.at.imag}
        if abs(self.heading.real) < 1e-9:
            del words["X"]
        self.blocks.append((f"G1 {code}".strip(), words))

    def _arc(self):
        turn = self.chance.choice((1, -1))
        if self.chance.random() < 0.5:
            self._turn()
        sweep = self.chance.uniform(0.2, 5.5)
        radius = self.chance.uniform(self.least + 1, 25)
        centre = self.at + turn * 1j * radius * self.heading
        end = centre + (self.at - centre) * cmath.exp(1j * turn * sweep)
        words = {"X": end.real, "Y": end.imag}
        if self.chance.random() < 0.5:
            words["R"] = radius if sweep < math.pi else -radius
            if abs(sweep - math.pi) < 0.3 or sweep > 5.2:  # R is ill-conditioned there
                del words["R"]
        if "R" not in words:
            words |= {"I": (centre - self.at).real, "J": (centre - self.at).imag}
        self.heading *= cmath.exp(1j * turn * sweep)
        self.at = end
        self.blocks.append((("G3" if turn > 0 else "G2"), words))

    def flat(self):
        """Return the blocks for a mill of X and Y."""
        return [_block(code, words) for code, words in self.blocks]

    def round_part(self, turn, radius, sense=1.0):
        """Return the blocks round a part; ``turn`` is the letter of the rotary axis."""
        return [_block(code, wrapped(words, turn, radius, sense)) for code, words in self.blocks]


def wrapped(words, turn, radius, sense=1.0):
    """Return the words of a block with the length round the part as an angle."""
    letter = {"A": "Y", "B": "X"}[turn]
    scale = math.degrees(SENSE[turn] * sense / radius)
    named = {turn if word == letter else word: value for word, value in words.items()}
    return {word: value * scale if word == turn else value for word, value in named.items()}


def _block(code, words):
    return " ".join([code, *(f"{word}{value:.9f}" for word, value in words.items())])


def flat_program(contour, feed=300):
    return [
        FIRST, "T3 M6", "G0 Z5", f"G0 X{contour.start.real:.9f} Y{contour.start.imag:.9f}",
        f"G1 Z-1 F{feed:g}", *contour.flat(), "G1 Z5", "M2",
    ]  # fmt: skip


def wrapped_program(contour, turn, radius, sense=1.0, feed=300):
    x, y = contour.start.real, contour.start.imag
    if turn == "A":
        there = f"X{x:.9f} Y0 A{math.degrees(-sense * y / radius):.9f}"
    else:
        there = f"X0 Y{y:.9f} B{math.degrees(sense * x / radius):.9f}"
    return [
        FIRST, "T3 M6", f"G0 Z{radius + 5:g}", f"G0 {there}", f"G7.1 {turn}{radius:g}",
        f"G1 Z{radius - 1:g} F{feed:g}", *contour.round_part(turn, radius, sense),
        f"G1 Z{radius + 5:g}", f"G7.1 {turn}0", "M2",
    ]  # fmt: skip


def flat_path(trace):
    """Return the path of a flat program's feed moves in X and Y, arcs as fine chords."""
    points = []
    for move in _level(trace):
        start, end = (complex(*place[:2]) for place in (move.start, move.end))
        points += [start, *_inner_points(move, start, end), end]
    return points


def _inner_points(move, start, end):
    if move.kind != "arc":
        return []
    centre = complex(*move.centre[:2])
    radius, sweep = abs(start - centre), move.sweep
    count = 2 + math.ceil(abs(sweep) * math.sqrt(radius / CHORD))
    return [centre + (start - centre) * cmath.exp(1j * sweep * k / count) for k in range(1, count)]


def unrolled_path(trace, turn, radius, sense=1.0):
    """Return the path of a wrapped program's feed moves on the unrolled surface."""
    axis = {"A": A, "B": B}[turn]
    points = []
    for move in _level(trace):
        middle = [(start + end) / 2 for start, end in zip(move.start, move.end)]
        for place in (move.start, middle, move.end):
            length = math.radians(place[axis]) * radius * SENSE[turn] * sense
            points.append(complex(place[X], length) if turn == "A" else complex(length, place[Y]))
    return points


def _level(trace):
    assert trace.error is None, trace.error
    return [move for move in trace.moves if move.kind != "rapid" and move.start[Z] == move.end[Z]]


def apart(one, other):
    """Return the greatest distance of the points of either path from the other one."""
    lines = [LineString(np.column_stack([np.real(path), np.imag(path)])) for path in (one, other)]
    return lines[0].hausdorff_distance(lines[1])
