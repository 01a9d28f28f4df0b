# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1: real deviation on the unrolled surface, section times."""

import numpy as np

from bench import Figure
from support.contour_geometry import FROM_COLUMNS, deviation, distance
from support.cylinder_drawings import DRAWINGS, Surface
from support.operated_machine import Machine
from support.sim_machines import PROGRAMS, SIM

TOLERANCE = 0.005  # POLAR_TOLERANCE, mm


def figures():
    """Yield the rows of the samples on the cylinder, each run once at its own feed of F250."""
    with Machine(SIM / "lathe_mm.ini") as lathe:
        for name, drawing in DRAWINGS.items():
            run = lathe.run(PROGRAMS / "cylinder" / f"{name}.ngc")
            assert run.error is None, run.error
            cut = Surface(run, drawing.radius)
            yield real_deviation(name, drawing, cut)
            yield against_ideal(name, drawing, cut)


def real_deviation(name, drawing, cut):
    """Compare the motion, sampled at 1 kHz, with the drawing, or with the way beside it."""
    points = cut.of(drawing.contour)
    if drawing.beside:
        away = distance(points @ FROM_COLUMNS, drawing.segments) - drawing.beside
        worst, how = np.abs(away).max(), f"{len(points)} samples, a cutter's radius beside it"
    else:
        worst = max(deviation(drawing.segments, points, 0.1))
        how = f"{len(points)} samples, and the contour against them"
    what = f"cylinder: real motion against the programmed contour, {name}"
    return Figure(what, worst, TOLERANCE + 0.001, " mm", how)


def against_ideal(name, drawing, cut):
    """Compare the time of a contour at F250 with its length over the feed.

    The way beside a contour that ends in the direction in which it began is as long as it.
    """
    length = sum(segment.length for segment in drawing.segments)
    seconds = cut.seconds(drawing.contour)
    return Figure(
        f"cylinder: section time against the ideal at F250, {name}",
        seconds / (length / 250 * 60),
        1.05,
        "",
        f"{seconds:.2f} s for {length:.1f} mm",
    )
