# SPDX-License-Identifier: GPL-2.0-or-later
"""What a shape's call asks for: its entries as they are read, and the toolpath by its page."""

import cmath
import math

import numpy as np
import pytest
from shapely.ops import unary_union

from g12.geometry.curve import Arc
from g12.tools.machine.ini import read_ini
from g12.tools.preview.executed_blocks import STATE_NAMES, Block, read_line
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.shapes import shape_path
from g12.tools.verify.expected.words import SubCall, equal_steps
from g12.tools.verify.reading.codes import Codes
from support.shape_geometry import area_off, disc, polygon, slot, swept_by
from support.sim_machines import SIM

LATHE, MILL = (read_ini(SIM / f"{name}_mm_headless.ini") for name in ("lathe", "mill"))
INI = LATHE.replaced({"G12": {"PLUNGE_FEED": 50}})
FOUND = {"_x": 40.0, "_z": 5.0, "_c": 0.0, "_metric": 1.0, "_feed": 150.0, "_rpm": 1000.0}
CUTTER = 3.0
OUT = -9999


def call_of(shape, *entries, start=(40.0, 0.0, 5.0, 0.0, 0.0, 0.0), turned=0.0, **state):
    """Return a call; the tool stands at X40 Z5, in mm, G8, G94 and F150."""
    found = {**dict.fromkeys(STATE_NAMES, 0.0), **FOUND, **state}
    block = Block(read_line(7, f"o<{shape}> call"), {}, (), (), entries, found, 0, 1)
    place, end = (*start, 0.0, 0.0, 0.0), (*start[:5], start[5] + turned, 0.0, 0.0, 0.0)
    move = Move("rapid", 7, 7, place, end, 0.0, "G94", 18, 3, (0.0,) * 9)
    return SubCall(block, move, CUTTER, INI)


def hexagon(**state):
    return call_of("polar_polygon", 6, 20, 3, 30, 2, 1, 0.3, 600, OUT, 10, **state)


def named(path, *names):
    """Return the moves of a path whose names are those."""
    return [move for move in path if move.name in names]


# ---------------------------------------------------------------- entries


def test_entries_are_read_by_their_names():
    call = hexagon()
    assert (call.length("depth"), call.given["sides"], call.line) == (3, 6, 7)
    assert (call.feed(), call.plunge_feed(), call.length("absent", 4.0)) == (600, 300, 4.0)


def test_a_feed_per_revolution_and_one_that_is_forgotten():
    assert hexagon(_units_per_rev=1.0).feed() == 600 * 1000
    call = call_of("polar_slot", 8, 30, 4, 4, 0, OUT, OUT, 0, _feed=1.0)
    assert (call.feed(), call.plunge_feed()) == (None, None) and "_feed" not in call.leaves()


def test_inches_and_the_program_s_zero():
    state = {"_metric": 0.0, "_x": 1.5, "_z": 1.0, "_c": 10.0}
    call = call_of("polar_pocket", 1, 0.5, 0.4, 0.1, 1, start=(50.8, 0, 25.4, 0, 0, 40), **state)
    assert call.zero == pytest.approx((12.7, 0.0, 30.0))
    assert (call.x(), call.length("c")) == (25.4, 12.7)


@pytest.mark.parametrize(("x", "g7", "radius"), [("inherit", 1, 4), ("inherit", 0, 8),
                                                 ("radius", 1, 8), ("diameter", 0, 4)])  # fmt: skip
def test_x_of_a_pocket_is_read_as_x_words_are(x, g7, radius):
    call = call_of("polar_pocket", 8, 0, 9, 1, 1, _lathe_diameter_mode=float(g7))
    call.diameters = {"diameter": True, "radius": False}.get(x, call.diameters)
    assert call.x() == radius


@pytest.mark.parametrize(("turned", "to"), [(0, 30), (-330, -330), (390, 390), (700, 750)])
def test_whole_turns_of_c_are_the_machine_s(turned, to):
    assert hexagon(turned=turned).turn_to(30) == to


def test_equal_steps_are_the_fewest():
    assert equal_steps(0, -3, 1.5, 1e-6) == [-1.5, -3]
    assert equal_steps(10, 4, 2.5, 1e-6) == [8, 6, 4]
    assert equal_steps(2, 2.004, 4, 0.005) == []


def test_a_sub_of_that_name_without_its_code_is_another_s():
    call = read_line(1, "o<polar_slot> call [8] [30] [4]")
    assert (Codes(LATHE).shape_of(call), Codes(MILL).shape_of(call)) == ("polar_slot", "")


# ---------------------------------------------------------------- toolpaths

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
    (shape, *entries), _, _ = SHAPES[name]
    return shape_path(call_of(shape, *entries))


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


@pytest.mark.parametrize("name", SHAPES)
def test_a_toolpath_has_no_gap_and_ends_above_where_it_began(name):
    path = path_of(name)
    for one, other in zip(path, path[1:]):
        assert abs(one.curve.end - other.curve.start) < 1e-9 and one.end_level == other.start_level
    assert [move.name for move in path[:3]] == ["rapid of C", "rapid of X", "rapid down"]
    assert (path[-1].name, path[-1].end_level) == ("rapid up", 5.0)


@pytest.mark.parametrize(("name", "most"), [("slot", 3.0), ("groove", 3.0), ("pocket", 3.0)])
def test_the_way_down_is_the_shortest_of_one_slope(name, most):
    falling = named(path_of(name), "ramp", "helix")
    slopes = [(m.start_level - m.end_level) / m.curve.length for m in falling if m.curve.length]
    first = [slope for m, slope in zip(falling, slopes) if m.end_level > -1.4999]
    assert max(slopes) <= math.tan(math.radians(most)) and np.ptp(first) < 1e-9
    assert {move.feed for move in falling} == {200}


def test_a_polygon_comes_down_beside_the_stock_and_begins_with_half_a_corner():
    names = [move.name for move in path_of("hexagon")][3:]
    assert names[:5] == ["plunge", "lead-in", "lead-in", "corner", "flat"]
    (plunge, _) = named(path_of("hexagon"), "plunge")
    outside = 4.5 + 8 / math.cos(math.pi / 6) + 2  # the middle of the first round's corners
    assert plunge.curve.start == pytest.approx(cmath.rect(max(19.0, outside), math.radians(40)))
    rounds = named(path_of("hexagon"), "flat")[::6]
    assert [move.curve.distance(0j) for move in rounds[:2]] == pytest.approx([15.65, 13.3])


def test_rings_are_as_far_apart_as_the_page_says():
    radii = [round(move.curve.radius, 6) for move in named(path_of("slot"), "ring")
             if isinstance(move.curve, Arc)]  # fmt: skip
    assert list(dict.fromkeys(radii)) == [2.7, 5.7, 8.7]
    assert len(named(path_of("groove"), "ring")) == 4  # a line there and back at each level


def test_a_tool_beside_the_x_line_comes_onto_it():
    entries = ("polar_pocket", 8, 0, 20, 3, OUT, 0, 600, 200)
    path = shape_path(call_of(*entries, start=(40.0, 0.4, 5.0, 0, 0, 0)))
    there, approach = named(path, "rapid of X", "approach")
    assert there.curve.end == pytest.approx(10.7 + 0.4j)
    assert approach.curve.end == pytest.approx(10.7) and not approach.rapid
