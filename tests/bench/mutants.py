# SPDX-License-Identifier: GPL-2.0-or-later
"""verify: what it says of valid programs with one wrong word, by a height map of its own.

The map is a grid of heights, lowered by the disc of the cutter along each traced move at feed.
"""

import math
import random
import re
import tempfile
from pathlib import Path

import numpy as np

from bench import Figure
from g12.tools.machine.ini import read_ini
from g12.tools.path.part import arc_points
from g12.tools.preview.tracer import Tracer
from g12.tools.verify.judge import judge_trace
from g12.tools.verify.model.program import TracedProgram
from support.sim_machines import PROGRAMS, SIM

VALID = {  # programs without a finding by machine
    "mill_mm": ["haas_mm/three_pockets", "haas_mm/levels", "haas_mm/turned", "circle_mill/outside"],
    "mill_mitsubishi_mm": ["mitsubishi/circle"],
    "lathe_mm": ["polar/hexagon", "polar/slot", "holes/face", "lathe_mm/shape_slot"],
}
SEED, EACH = 44, 24  # mutants of a program
WORD = re.compile(r"([A-Z])([-+]?\d*\.?\d+)")
COMMENT = re.compile(r"\(.*?\)|;.*")
SWAPPED = "G0 G1, G2 G3, G12 G13, G41 G42, G90 G91, G20 G21, G7 G8, M3 M4, M3 M5"
SWAPS = [pair.split() for pair in SWAPPED.split(", ")]
CELL, AROUND, STEP = 0.4, 12.0, 0.4  # mm
DEEPER, AREA = 0.1, 2.0  # mm and mm² of a difference that counts
SLACK, INTO = 0.5, 0.1  # mm beside a rapid's cutter, and below what is solid


def mutants(text, chance):
    """Return texts with one word changed or left out, in a random order."""
    found = set()
    for word in WORD.finditer(text):
        if any(c.start() <= word.start() < c.end() for c in COMMENT.finditer(text)):
            continue
        letter, value = word[1], float(word[2])
        changes = ["", *(b if word[0] == a else a for a, b in SWAPS if word[0] in (a, b))]
        if letter not in "GMNOTDH":
            changes += [f"{letter}{value * by:.6g}" for by in (0.1, 1.1, 10, -1)]
        found |= {text[: word.start()] + new + text[word.end() :] for new in changes}
    ordered = sorted(found - {text})
    chance.shuffle(ordered)
    return ordered


class Heights:
    """What a program leaves of solid material below Z0, and whether a rapid went through it."""

    def __init__(self, trace, turning, bounds, by_table):
        low, high = bounds
        self.across = np.arange(low[0], high[0], CELL), np.arange(low[1], high[1], CELL)
        self.z = np.zeros([len(axis) for axis in self.across])
        self.crashed = False
        for index, move in enumerate(trace.moves):
            radius = trace.radius(index)
            if radius > 0:
                points = points_of(move, turning)
                if by_table:  # the tip of this tool where the offset of another is in force
                    own = trace.table_at(index).lengths.get(move.tool, 0.0)
                    points[:, 2] += move.tool_offset[2] - own
                self._go(points, radius, move.kind == "rapid")

    def _go(self, points, radius, is_rapid):
        for x, y, z in points[points[:, 2] < 0]:
            ends = [
                np.searchsorted(a, (v - radius, v + radius)) for a, v in zip(self.across, (x, y))
            ]
            at = [slice(*end) for end in ends]
            away = np.hypot(self.across[0][at[0], None] - x, self.across[1][None, at[1]] - y)
            near = self.z[at[0], at[1]]
            if is_rapid:
                self.crashed |= bool((near[away < radius - SLACK] > z + INTO).any())
            else:
                np.copyto(near, z, where=(away <= radius) & (near > z))

    def differs(self, other):
        apart = np.abs(self.z - other.z) > DEEPER
        inner = apart[1:-1, 1:-1] & apart[:-2, 1:-1] & apart[2:, 1:-1] & apart[1:-1, :-2]
        return inner.sum() * CELL**2 > AREA


def points_of(move, turning):
    """Return points of the part (n, 3) along a move, no farther apart than STEP."""
    start, end = np.array(move.start, float), np.array(move.end, float)
    turned = math.radians(abs(end[5] - start[5])) * max(abs(start[0]), abs(end[0]))
    long = move.length if move.kind == "arc" else np.abs(end - start)[:3].max()
    shares = np.linspace(0.0, 1.0, 2 + int(max(long, turned * turning) / STEP))
    is_arc = move.kind == "arc"
    at = arc_points(move, shares) if is_arc else start + shares[:, None] * (end - start)
    if not turning:
        return at[:, :3]
    plane = at[:, 0] * np.exp(1j * np.radians(at[:, 5]))
    return np.stack([plane.real, plane.imag, at[:, 2]], axis=1)


def figures():
    """Yield how many of the mutants that cut another part, or crash, verify says nothing of."""
    counted, silent = 0, []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.ngc"
        for machine, programs in VALID.items():
            ini = read_ini(SIM / f"{machine}_headless.ini")
            with Tracer(ini, reports=True) as tracer:
                for name in programs:
                    for text, said in harmful(tracer, ini, name, file):
                        counted += 1
                        silent += [] if said else [(name, text)]
    how = f"{len(silent)} of {counted} that cut another part, or rapid through it"
    yield Figure("verify: wrong words it is silent about", len(silent) / counted, 0.5, how)


def harmful(tracer, ini, name, file):
    """Yield the mutants of a program that cut another part: each with what verify says anew."""
    text = (PROGRAMS / f"{name}.ngc").read_text()
    turning, chance = "C" in ini.axes, random.Random(f"{SEED} {name}")
    right = traced(tracer, text, file)
    usual = judged(file, ini, right)
    fed = [points_of(m, turning) for m in right.moves if m.kind != "rapid" and m.end[2] < 0]
    points = np.concatenate(fed)[:, :2]
    bounds = points.min(axis=0) - AROUND, points.max(axis=0) + AROUND
    by_table = any(move.tool_offset[2] for move in right.moves)
    expected = Heights(right, turning, bounds, by_table)
    for wrong in mutants(text, chance)[:EACH]:
        trace = traced(tracer, wrong, file)
        if trace.error is None:
            heights = Heights(trace, turning, bounds, by_table)
            if heights.differs(expected) or heights.crashed > expected.crashed:
                yield wrong, judged(file, ini, trace) - usual


def traced(tracer, text, file):
    file.write_text(text)
    return tracer.trace(file)


def judged(file, ini, trace):
    """Return the codes of what verify finds and warns of."""
    return {each.code for each in judge_trace(TracedProgram(file, ini, trace)).found}
