# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that a shape's call asks for, against a drawing of the shape."""

import math

import numpy as np
import pytest
from shapely.ops import unary_union

from g12.tools.machine.ini import read_ini
from g12.tools.preview.executed_blocks import STATE_NAMES, Block, read_line
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.shapes import shape_path
from g12.tools.verify.expected.words import SubCall
from support.shape_geometry import area_off, disc, polygon, slot, swept_by
from support.sim_machines import SIM

INI = read_ini(SIM / "lathe_mm_headless.ini")
STATE = {"_x": 40.0, "_z": 5.0, "_c": 0.0, "_metric": 1.0, "_feed": 150.0, "_rpm": 1000.0}
CUTTER = 3.0
OUT = -9999


def named(path, *names):
    """Return the moves of a path whose names are those."""
    return [move for move in path if move.name in names]


SHAPES = {  # entries, what is drawn with more material on its walls, and the bar
    "hexagon": (("polar_polygon", 6, 20, 3, 30, 2, 1.5, 0.3, 600, 200, 10),
                lambda more: polygon(6, 20 + 2 * more, 2 + more, 10), 30),
    "clipped": (("polar_polygon", 4, 20, 3, 22, 0, 1.5, 0.3, 600, 200, 0),
                lambda more: polygon(4, 20 + 2 * more, more), 22),
    "flats": (("polar_polygon", 2, 20, 3, 30, 0, 1.5, 0.3, 600, OUT, -40),
              lambda more: polygon(2, 20 + 2 * more, 0, -40), 30),
    "slot": (("polar_slot", 24, 40, 3, 1.5, 0.3, 600, 200, 30),
             lambda more: slot(24 - 2 * more, 40 - 2 * more, 30), 0),
    "groove": (("polar_slot", 6.6, 24, 3, 1.5, 0.3, 600, 200, 30),
               lambda more: slot(6.6 - 2 * more, 24 - 2 * more, 30), 0),
    "pocket": (("polar_pocket", 8, 5, 20, 3, 1.5, 0.3, 600, 200),
               lambda more: disc(8, 5, 20 - 2 * more), 0),
}  # fmt: skip


def path_of(name):
    """Return the toolpath of a call where the tool stands at X40 Z5, in mm and radii."""
    (shape, *entries), _, _ = SHAPES[name]
    state = {**dict.fromkeys(STATE_NAMES, 0.0), **STATE}
    block = Block(read_line(7, f"o<{shape}> call"), {}, (), (), entries, state, 0, 1)
    place = (40.0, 0.0, 5.0, *[0.0] * 6)
    move = Move("rapid", 7, 7, place, place, 0.0, "G94", 18, 3, (0.0,) * 9)
    return shape_path(SubCall(block, move, CUTTER, INI))


def off(name, moves, more):
    """Return how much what moves leave, or cut away, differs from the drawing."""
    _, drawn, bar = SHAPES[name]
    lines = [[move.curve.point(share) for share in np.linspace(0, 1, 120)] for move in moves]
    cut = unary_union([area for line in lines for area in swept_by(np.array(line), CUTTER)])
    if bar:
        return area_off(disc(0, 0, bar).difference(cut), drawn(more) & disc(0, 0, bar), 0.004)
    return area_off(cut, drawn(more), 0.004)


@pytest.mark.parametrize("name", SHAPES)
def test_a_pass_leaves_the_allowance_and_the_finish_takes_it(name):
    path = path_of(name)
    for level in (-1.5, -3.0):
        levels = [(move.start_level, move.end_level) for move in path]
        flat = [m for m, ends in zip(path, levels) if ends == pytest.approx((level, level))]
        assert off(name, named(flat, "ring", "flat", "corner"), 0.3) < 0.02
    assert off(name, flat, 0.0) < 0.02


@pytest.mark.parametrize("name", ["slot", "groove", "pocket"])
def test_the_way_down_is_the_shortest_of_one_slope(name):
    falling = named(path_of(name), "ramp", "helix")
    slopes = [(m.start_level - m.end_level) / m.curve.length for m in falling if m.curve.length]
    first = [slope for m, slope in zip(falling, slopes) if m.end_level > -1.4999]
    assert max(slopes) <= math.tan(math.radians(3)) and np.ptp(first) < 1e-9
    assert {move.feed for move in falling} == {200}
