# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 in a headless LinuxCNC: the samples' real motion, MDI; test_polar.py has the operator."""

import math

import numpy as np
import pytest

from support.contour_geometry import FROM_COLUMNS, deviation, distance, lines
from support.cylinder_drawings import DRAWINGS, Surface, bend
from support.operated_machine import Machine, kept_machine
from support.polar_programs import C_ACCELERATION, accelerations, exceeds_limits_itself
from support.sim_machines import PROGRAMS, SIM, machine_scope

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add
FEED = {"helix": 2500, "textbook": 1500, "slot": 1000, "cam_groove": 1000}  # not 250 mm/min
C_SPEED = 360


lathe = kept_machine("lathe_mm")


@pytest.fixture(scope=machine_scope)
def cuts(request):
    """Every sample program, run once when it is asked for."""
    done = {}

    def cut(name):
        if name not in done:
            machine = request.getfixturevalue("lathe")
            text = (PROGRAMS / "cylinder" / f"{name}.ngc").read_text()
            run = machine.run_text(text.replace("F250", f"F{FEED[name]}").splitlines())
            assert run.error is None
            assert run.samples.lost == 0
            done[name] = Surface(run, DRAWINGS[name].radius)
        return done[name]

    return cut


@pytest.mark.parametrize("name", ["helix", "slot", "cam_groove"])
def test_the_real_motion_is_on_the_contour(cuts, name):
    drawing = DRAWINGS[name]
    there, back = deviation(drawing.segments, cuts(name).of(drawing.contour), step=0.1)
    assert there <= LIMIT
    assert back <= LIMIT


def test_the_textbooks_groove_is_cut_beside_its_contour(cuts):
    """The cutter of G42 touches the contour everywhere, and nowhere cuts into it."""
    drawing = DRAWINGS["textbook"]
    cut = cuts("textbook")
    points = cut.of(drawing.contour) @ FROM_COLUMNS
    away = distance(points, drawing.segments) - drawing.beside
    assert (away.min(), away.max()) == pytest.approx((0.0, 0.0), abs=LIMIT)
    assert cut.of([13])[:, 1].mean() == pytest.approx(60 - 6, abs=0.01)  # right of the way along C
    for line, (segment,) in drawing.contour.items():
        beside = np.abs(segment.distance(cut.of([line]) @ FROM_COLUMNS) - drawing.beside)
        assert np.median(beside) <= LIMIT, line


@pytest.mark.parametrize("name", DRAWINGS)
def test_feed_and_time_are_those_of_the_surface_and_c_keeps_its_limits(cuts, request, name):
    blocks, cut = DRAWINGS[name].contour, cuts(name)
    lengths = {line: sum(part.length for part in parts) for line, parts in blocks.items()}
    speeds = [cut.speed(line) for line, length in lengths.items() if length > 8.0]
    assert speeds == pytest.approx([FEED[name]] * len(speeds), rel=0.01)
    assert cut.seconds(blocks) <= 1.05 * sum(lengths.values()) / FEED[name] * 60
    assert np.abs(np.diff(cut.c)).max() * 1000 <= C_SPEED * 1.001
    if not exceeds_limits_itself(request.getfixturevalue("lathe")):
        assert accelerations(cut.c).max() <= C_ACCELERATION * 1.01


# ---------------------------------------------------------------- what an operator does


FIRST = "G21 G18 G8 G40 G49 G54 G64 G80 G90 G91.1 G94 G97"
R = 20.0
PART = ["G1 Z-8", "C40", "G3 Z-2 C60 R8", "G1 Z-10 C-30", "C0"]
AROUND = math.pi / 180 * R
OUTLINE = [
    *lines((0, 0), (0, -8), (40 * AROUND, -8)),
    *lines((60 * AROUND, -2), (-30 * AROUND, -10), (0, -10)),
]
BEND = bend((40 * AROUND, -8), (60 * AROUND, -2), 1, 8)


def section(*body, feed="F2500", before=(), after=()):
    """Return a program whose section holds ``body``, from line 6 on."""
    start = [FIRST, "G0 X22 Z0 C0", "T3 M6", feed, *before]
    return [*start, f"G07.1 C{R:g}", *body, "G07.1 C0", *after, "M2"]


@pytest.fixture
def ready(lathe):
    lathe.abort()
    lathe.mdi("G21 G90 G94 G40 G8 G64")
    lathe.mdi("G0 X22 Z0 C0")
    lathe.errors(), lathe.messages()
    return lathe


def on_the_part(samples):
    """Tell whether every sample lies on the straight blocks or the arc of the part."""
    points = Surface(samples, R).points @ FROM_COLUMNS
    return distance(points, [*OUTLINE, BEND]).max() < LIMIT


def test_a_sub_that_mdi_calls_has_the_lines_behind(tmp_path):
    groove = section(*PART[:2], "M66 P0 L0", *PART[2:])[4:-1]
    text = ["o<groove> sub", *groove, "G0 X25", "o<groove> endsub"]
    (tmp_path / "groove.ngc").write_text("\n".join(text) + "\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"../../ngc:subs:{tmp_path}"}}
    with Machine(SIM / "lathe_mm.ini", overrides=paths) as lathe:
        for block in (FIRST, "T3 M6", "G0 X22 Z0 C0", "F2500"):
            lathe.mdi(block)
        lathe.sample()
        lathe.mdi("o<groove> call")
        samples = lathe.samples()
        lathe.mdi("G0 X30")
        assert lathe.errors() == []
        assert lathe.stat().position[0] == pytest.approx(30)
    assert on_the_part(samples)
    assert samples.axes["C"].max() > 60 and samples.axes["Z"].min() == pytest.approx(-10)


def test_c_keeps_its_speed_on_the_way_into_an_exact_stop(ready):
    """LinuxCNC adds the segment that ends in G61 to the one before: 540 degrees a second."""
    run = ready.run_text(section("G1 C180", "C360", "Z-20", "C180", "C0", feed="F30000"))
    assert run.error is None
    cut = Surface(run, R)
    blended = 0.5 * C_ACCELERATION * 1e-3  # within one servo period LinuxCNC adds the two
    assert np.abs(np.diff(cut.c)).max() * 1000 <= C_SPEED + 1.01 * blended
    assert np.abs(cut.points @ FROM_COLUMNS - 360 * AROUND).min() <= LIMIT  # and it does stop


def test_more_speed_than_c_has_only_slows_the_way_down(ready):
    """At F30000 C would turn at 1400 degrees a second."""
    run = ready.run_text(section("G1 Z-20 C720", "G3 Z0 R10", "G1 C0", feed="F30000"))
    assert run.error is None
    cut = Surface(run, R)
    low, high = (720 * AROUND, -20), (720 * AROUND, 0)
    shapes = [*lines((0, 0), low), bend(low, high, 1, 10), *lines(high, (0, 0))]
    assert distance(cut.points @ FROM_COLUMNS, shapes).max() <= LIMIT
    assert np.abs(np.diff(cut.c)).max() * 1000 <= C_SPEED * 1.001
    assert cut.c.max() == pytest.approx(720, abs=60)
