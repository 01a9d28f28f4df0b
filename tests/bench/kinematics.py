# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 with kinematics beside G12.1 with segments."""

import cmath
import math

import numpy as np

from bench import Figure
from bench.polar import (
    at_feed,
    contour_of,
    seconds_at,
    seconds_in,
)
from g12.tools.path.section_times import least_seconds
from support.contour_geometry import Round
from support.operated_machine import Machine
from support.sim_machines import SIM

FEEDS = {1000: 1.02, 2000: 1.03, 3000: 1.03}  # and the most of the ideal time
NO_SLOWER = 1.04  # than segments at 1000 mm/s²: AXIS_X of the face has 707, in segments too
THIRD = 2 * math.pi / 3  # C turns the other way in between
CIRCLE = [  # r 10, 20 off the axis
    Round(20 + 10 * cmath.rect(1, turn), 20, THIRD) for turn in (0, THIRD, 2 * THIRD)
]
SLIDE, SPINDLE = (150.0, 1000.0), (math.radians(360), math.radians(3600))  # speed, acceleration
SLOW_SLIDE, SLOW_SPINDLE = (150.0, 1500.0), (math.radians(90), math.radians(1200))
OF_LEAST = {1000: 1.05, 2000: 1.12, 3000: 1.20}  # the circle's time on the face
OF_LEAST_SLOW = {500: 1.05, 1000: 1.12, 2000: 1.20}
HEXAGON_SLOW = {500: 1.05, 2000: 1.15}
SLOT_LENGTH = 36.0  # of slot.ngc: through the pole
SLOT_SLOW = {500: 1.10, 2000: 1.10}
SWITCH_MS, STANDING = 20, 8  # servo cycles: a plain stop is shorter than the second


def figures():
    """Yield the rows of kinematics and segments side by side."""
    with (
        Machine(SIM / "lathe_mm.ini") as segments,
        Machine(SIM / "lathe_mm_kinematics.ini") as face,
    ):
        for feed in FEEDS:
            yield hexagon(face, segments, feed)
        for feed in FEEDS:
            yield circle(face, segments, feed)
            yield slot(face, segments, feed)
        yield deviation_on_face(face)
        yield switch(face)
    with Machine(SIM / "lathe_slow_c_mm_kinematics.ini") as slow:
        yield from slow_spindle(slow)


def hexagon(face, segments, feed):
    """Compare the hexagon on the face with its length over the feed."""
    around = contour_of("hexagon", face.ini)
    ideal = sum(segment.length for segment in around) / feed * 60
    ours, others = (seconds_at(lathe, "hexagon", feed) / ideal for lathe in (face, segments))
    what = f"polar with kinematics: hexagon against the ideal at F{feed}"
    return Figure(what, ours, FEEDS[feed], f"with segments {others:.3f}")


def circle(face, segments, feed):
    """Compare the times of a circle beside the axis."""
    shortest = least(CIRCLE, feed)
    ours, others = (
        seconds_in(lathe.run_text(circle_at(feed)), (4,)) / shortest for lathe in (face, segments)
    )
    what = f"polar with kinematics: circle r 10, 20 off the axis, F{feed}, against least time"
    return Figure(what, ours, OF_LEAST[feed], f"with segments {others:.3f}")


def circle_at(feed):
    """Return the program of the circle."""
    return ["G21 G18 G8 G90 G94 G64", "G0 X30 Z2 C0", "G12.1", f"G3 I-10 F{feed}", "G13.1", "M2"]


def least(segments, feed, slide=SLIDE, spindle=SPINDLE):
    """Return the least time that the slide's and C's own limits allow, whoever plans it."""
    points = np.concatenate([segment.points(1000)[:-1] for segment in segments])
    return least_seconds(points, feed / 60, slide, spindle)


def slow_spindle(lathe):
    """Yield the rows of a lathe whose C is slow, against what its axes can do."""
    axes = SLOW_SLIDE, SLOW_SPINDLE
    title = "polar with kinematics, C 90 degrees/s:"
    for feed, most in OF_LEAST_SLOW.items():
        ratio = seconds_in(lathe.run_text(circle_at(feed)), (4,)) / least(CIRCLE, feed, *axes)
        yield Figure(f"{title} circle r 10, 20 off the axis, F{feed}", ratio, most)
    around = contour_of("hexagon", lathe.ini)
    for feed, most in HEXAGON_SLOW.items():
        shortest = sum(least([segment], feed, *axes) for segment in around)
        ratio = seconds_at(lathe, "hexagon", feed) / shortest
        yield Figure(f"{title} hexagon, F{feed}", ratio, most, "side by side")
    half = np.linspace(SLOT_LENGTH / 2, 0.001, 1000) + 0j
    turn = math.pi / SLOW_SPINDLE[0] + SLOW_SPINDLE[0] / SLOW_SPINDLE[1]
    for feed, most in SLOT_SLOW.items():
        ours = seconds_at(lathe, "slot", feed)
        ratio = (ours - turn) / (2 * least_seconds(half, feed / 60, *axes))
        what = f"{title} slot through the centre besides C turning in place, F{feed}"
        yield Figure(what, ratio, most, f"{ours:.3f} s, of which C turns {turn:.3f} s")


def slot(face, segments, feed):
    """Compare the times of a slot through the pole, where C has to turn."""
    ours, others = (seconds_at(lathe, "slot", feed) for lathe in (face, segments))
    ideal = SLOT_LENGTH / feed * 60
    shares = f"against the ideal {ours / ideal:.3f} and {others / ideal:.3f}"
    what = f"polar both ways: slot through the pole, F{feed}, with kinematics against segments"
    return Figure(what, ours / others, NO_SLOWER, f"{shares}, C turns in place for 0.6 s")


def switch(face):
    """Return how long the machine stands to go to the face, or back from it."""
    head, up, *section, end = circle_at(3000)
    run = face.run_text([head, *([up, *section, "G0 Z3"] * 6), end])
    stops = np.diff(np.flatnonzero(run.samples.velocity))
    stops = stops[stops > STANDING]
    what = "polar with kinematics: the machine stands at a switch"
    how = f"median of {len(stops)}, {stops.min()} to {stops.max()} ms; more on a busy computer"
    return Figure(what, float(np.median(stops)), SWITCH_MS, how, " ms")


def deviation_on_face(face):
    """Compare the motion of the hexagon at F3000, G64 P0.002, with what its words command."""
    program = at_feed("hexagon", 3000)
    program[1] += " P0.002"  # of G64
    face.reset()
    (section,) = face.proof_of_run(program).sections
    what = "polar with kinematics: real motion against the hexagon at F3000, G64 P0.002"
    how = "of the tool's centre, sampled at 1 kHz"
    return Figure(what, section.deviation, 0.002, how, " mm")
