# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A and B on a mill: what LinuxCNC reads of the flat drawing is what lies round the part.

The words, refusals and settings that a lathe's cylinder shares are in test_cylinder.py.
"""

import math
import random

from support.flat_contours import FlatContour, apart, flat_path, unrolled_path
from support.sim_machines import kept_tracer

FIRST = "G21 G17 G8 G40 G49 G54 G64 G80 G90 G91.1 G94 G97"
TOOL = 3.0  # mm, the radius of T3
TOLERANCE = 0.005  # POLAR_TOLERANCE, mm
RADII = (3.0, 25.0, 80.0)
CONTOURS = 60
WITH_B = {
    "TRAJ": {"COORDINATES": "X Y Z B"},
    "KINS": {"KINEMATICS": "trivkins coordinates=XYZB"},
    "AXIS_B": {"MIN_LIMIT": "-99999", "MAX_LIMIT": "99999", "MAX_VELOCITY": "360",
               "MAX_ACCELERATION": "3600"},
}  # fmt: skip

mill = kept_tracer("mill_mm")
mill_a = kept_tracer("mill_a_mm")
mill_b = kept_tracer("mill_a_mm", overrides=WITH_B)
reversed_a = kept_tracer("mill_a_mm", overrides={"G12": {"ROTARY_SENSE": "reversed"}})


def flat_program(contour):
    return [
        FIRST, "T3 M6", "G0 Z5", f"G0 X{contour.start.real:.9f} Y{contour.start.imag:.9f}",
        "G1 Z-1 F300", *contour.flat(), "G1 Z5", "M2",
    ]  # fmt: skip


def wrapped_program(contour, turn, radius, sense=1.0):
    x, y = contour.start.real, contour.start.imag
    if turn == "A":
        there = f"X{x:.9f} Y0 A{math.degrees(-sense * y / radius):.9f}"
    else:
        there = f"X0 Y{y:.9f} B{math.degrees(sense * x / radius):.9f}"
    return [
        FIRST, "T3 M6", f"G0 Z{radius + 5:g}", f"G0 {there}", f"G7.1 {turn}{radius:g}",
        f"G1 Z{radius - 1:g} F300", *contour.round_part(turn, radius, sense),
        f"G1 Z{radius + 5:g}", f"G7.1 {turn}0", "M2",
    ]  # fmt: skip


def check_contours(mill, machine, turn, sense, seed, count):
    """Compare random contours round a part with what LinuxCNC makes of them in the plane.

    One that crosses itself may gouge the part: LinuxCNC cuts it, and the section refuses it.
    """
    judged, number = {40: 0, 41: 0, 42: 0}, 0
    while min(judged.values()) < count // 4:
        contour = FlatContour(random.Random(f"{seed} {number}"), TOOL)
        radius = RADII[number % len(RADII)]
        number += 1
        trace = machine.trace_text(wrapped_program(contour, turn, radius, sense))
        if trace.error and contour.side != 40 and "cannot follow both" in trace.error.text:
            continue
        flat = flat_path(mill.trace_text(flat_program(contour)))
        round_part = unrolled_path(trace, turn, radius, sense)
        assert apart(flat, round_part) <= TOLERANCE, f"{seed} {number - 1}"
        across = {"A": 1, "B": 0}[turn]
        assert {move.end[across] for move in trace.moves} == {0.0}
        judged[contour.side] += 1
    return sum(judged.values())


def test_a_contour_round_a_is_that_of_the_flat_program(mill, mill_a):
    check_contours(mill, mill_a, "A", 1.0, "A", CONTOURS)


def test_a_contour_round_b_is_that_of_the_flat_program(mill, mill_b):
    check_contours(mill, mill_b, "B", 1.0, "B", CONTOURS)


def test_a_table_that_turns_the_other_way_mirrors_nothing(mill, reversed_a):
    check_contours(mill, reversed_a, "A", -1.0, "reversed", CONTOURS // 3)
