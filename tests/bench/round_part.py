# SPDX-License-Identifier: GPL-2.0-or-later
"""An engraving round a part: translated, with A for Y and F as it was, and as lines of G93."""

import math
import random
import tempfile
from pathlib import Path

import numpy as np

from bench import Figure
from g12.tools.headless.machine import Machine
from support.contour_geometry import distances
from support.foreign_programs import translation
from support.polar_programs import FEED
from support.sim_machines import SIM

LINES, STEP, DEPTH = 2000, 0.1, 0.2  # mm
FEED_RATE = 1200.0  # mm/min
RADIUS, HEIGHT, WIDTH = 50.0, 75.0, 60.0  # mm, of the part and of half the drawing
MOST, SLOWEST = 0.006, 1.05  # POLAR_TOLERANCE and a sample's share, mm; a ratio
EVERY = 5  # one of so many samples is looked at
INI = SIM / "mill_a_mm_headless.ini"
HEAD = ["G21 G17 G40 G90 G94", "T3 M6", "G43 H3"]


def figures():
    """Yield the deviation and the time of the real motion."""
    points = drawing()
    ideal = LINES * STEP / FEED_RATE * 60
    with Machine(INI) as machine:
        runs = {name: measured(machine, lines, points) for name, lines in programs(points).items()}
    (deviation, seconds), naive, g93 = (runs[name] for name in ("translated", "naive", "G93"))
    what = f"round a part: an engraving of {LINES} lines of {STEP:g} mm at F{FEED_RATE:g},"
    how = f"with A for Y {naive[0]:.4f}, as lines of G93 {g93[0]:.4f} mm"
    yield Figure(f"{what} real deviation on the surface", deviation, MOST, how, " mm")
    how = f"{seconds:.1f} s, with A for Y {naive[1]:.1f} s; length over F is {ideal:.1f} s"
    yield Figure(f"{what} time against lines of G93", seconds / g93[1], SLOWEST, how)


def drawing():
    """Return the points of a line that winds over a sheet."""
    chance, at, heading, bend = random.Random(5), 0j, 0.0, 0.0
    points = [at]
    for number in range(LINES):
        if number % 60 == 0:
            bend = chance.uniform(-0.06, 0.06)
        heading += bend
        if not (abs(at.real) < WIDTH and abs(at.imag) < HEIGHT):
            heading = math.atan2(-at.imag, -at.real)
        at += STEP * complex(math.cos(heading), math.sin(heading))
        points.append(complex(round(at.real, 4), round(at.imag, 4)))
    return points


def programs(points):
    """Return the three programs, as lines."""
    degrees = [math.degrees(-at.imag / RADIUS) for at in points]
    lengths = [abs(end - start) for start, end in zip(points, points[1:])]
    turned = [f"G1 X{at.real:.4f} A{a:.6f}" for at, a in zip(points, degrees)][1:]
    down = [*HEAD, "G64 P0.005", f"G0 Z{RADIUS + 30:g}", "G0 X0 Y0 A0", f"G0 Z{RADIUS + 2:g}"]
    down += [f"G1 Z{RADIUS - DEPTH:g} F{FEED_RATE:g}"]
    up = ["G94", f"G0 Z{RADIUS + 30:g}", "M2"]
    inverse = [f"G93 {row} F{FEED_RATE / length:.4f}" for row, length in zip(turned, lengths)]
    return {
        "translated": translated(points),
        "naive": [*down, *turned, *up],
        "G93": [*down, *inverse, *up],
    }


def translated(points):
    flat = [*HEAD, "G0 Z30", "G0 X0 Y0", "G0 Z2", f"G1 Z-{DEPTH:g} F{FEED_RATE:g}"]
    flat += [f"G1 X{at.real:.4f} Y{at.imag:.4f}" for at in points[1:]]
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "engraving.nc"
        program.write_text("\n".join([*flat, "G0 Z30", "M2", ""]))
        options = "--diameter", f"{2 * RADIUS:g}", "--ini", str(INI)
        text = translation(program, "mill-round-part", *options)
    return ["G21 G90", f"G0 Z{RADIUS + 30:g}", *text.splitlines()]


def measured(machine, lines, points):
    """Return how far the tool leaves the drawing in a real run, and the seconds of the cut."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.ngc"
        program.write_text("\n".join([*lines, ""]))
        run = machine.run(program, 600)
    assert run.error is None, run.error
    axes, deep = run.samples.axes, run.samples.kind == FEED
    deep &= axes["Z"] - axes["Z"][run.samples.kind == FEED].min() < 1e-4
    length_round = -np.radians(axes["A"]) * RADIUS
    cut = np.column_stack([axes["X"], length_round])[deep][::EVERY]
    path = np.array([(at.real, at.imag) for at in points])
    return max(distances(cut, path).max(), distances(path, cut).max()), deep.sum() / 1000
