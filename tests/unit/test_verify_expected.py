# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpaths that words ask for, by the pages and the manuals' golden cases."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.verify.expected import haas
from g12.tools.verify.expected.circle_mill import EventWords
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.expected.mitsubishi import MitsubishiWords
from g12.tools.verify.expected.yasnac import YasnacWords

TURNS = (1, -1)
THREE = math.radians(3)


def pocket(rings=(3.0, 7.0, 12.0), depths=(-2.0,), turn=1, **words):
    return HaasWords(0j, rings, depths, turn, 600.0, 60.0, **words)


def circles(path):
    """Return the depth and the radius of each full circle."""
    full = [m for m in path if abs(getattr(m.curve, "sweep", 0.0)) > 2 * math.pi - 1e-9]
    assert all(abs(move.curve.centre) < 1e-9 for move in full)
    return [(round(m.end_level, 6), round(m.curve.radius, 6)) for m in full]


def assert_joined(path):
    for one, other in zip(path, path[1:]):
        assert abs(one.curve.end - other.curve.start) < 1e-9 and one.end_level == other.start_level


def corners(path):
    """Return the changes of direction in the plane, degrees, between moves that stay at a level."""
    flat = [move for move in path if move.start_level == move.end_level]
    return [
        math.degrees(abs(cmath.phase(other.curve.direction(0.0) / one.curve.direction(1.0))))
        for one, other in zip(flat, flat[1:])
        if abs(one.curve.end - other.curve.start) < 1e-9 and one.end_level == other.end_level
    ]


def turned_back(path, about):
    """Return points along a toolpath, with the imaginary axis turned round by ``about``."""
    points = [move.curve.point(share / 8) for move in path for share in range(9)]
    return [complex(p.real, about * p.imag) for p in points]


@pytest.mark.parametrize(
    ("words", "rings"),
    [
        ((0.1, 0.7, 0.1), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]),
    ],
)
def test_haas_rings_grow_by_q_and_end_on_k(words, rings):
    assert haas.rings_between(*words) == pytest.approx(rings)
    assert [radius for _, radius in circles(pocket(rings).toolpath())] == pytest.approx(rings)


@given(
    gaps=st.lists(st.floats(0.1, 9.0), min_size=1, max_size=5),
    pitch=st.sampled_from([0.0, 1.0, 4.0]),
    turn=st.sampled_from(TURNS),
)
def test_haas_turns_no_corner_at_a_level(gaps, pitch, turn):
    rings = [3.0 + sum(gaps[:at]) for at in range(len(gaps))]
    rings = [rings[0], rings[-1]] if pitch and len(rings) > 1 else rings
    path = pocket(rings, pitch=pitch, turn=turn).toolpath()
    assert_joined(path)
    assert max(corners(path)) < 1e-6
    assert path[-1].curve.end == pytest.approx(0, abs=1e-9)
    assert all(move.curve.sweep * turn > 0 for move in path if hasattr(move.curve, "sweep"))


def test_haas_levels_begin_at_plus_x_and_spring_passes_where_the_last_ring_ended():
    levels = [m for m in pocket(depths=(-2, -4)).toolpath() if m.name == "lead-in"]
    assert [move.curve.end for move in levels] == pytest.approx([3, 3])
    springs = [m for m in pocket((3.0, 7.0), (-2, -2)).toolpath() if m.name == "lead-in"]
    assert [move.curve.end for move in springs] == pytest.approx([3, 3j])


def test_haas_spiral_grows_by_half_a_pitch_in_half_a_turn():
    path = pocket((3.0, 10.0), pitch=4.0).toolpath()
    ends = [move.curve.end for move in path if move.name == "spiral"]
    assert ends == pytest.approx([-5, 7, -9, 10])
    assert circles(path) == [(-2, 3), (-2, 10)]


@given(
    height=st.floats(0.05, 40),
    radius=st.floats(0.3, 20),
    angle=st.floats(0.5, 15).map(math.radians),
)
def test_the_helix_falls_no_steeper_than_its_angle_and_flattens_out(height, radius, angle):
    falls = haas.falls_of(height, radius, angle)
    slopes = [math.atan2(fall, math.pi * radius) for fall in falls]
    assert sum(falls) == pytest.approx(height)
    assert len(falls) % 2 == 0 and max(slopes) <= angle * (1 + 1e-9)
    changes = [one - other for one, other in zip(slopes, [*slopes[1:], 0.0])]
    assert max(changes) < math.radians(1.0)
    shorter = len(falls) - 2
    eased = sum(fall / falls[0] for fall in falls if fall < falls[0] * (1 - 1e-12))
    steep = shorter - sum(fall < falls[0] * (1 - 1e-12) for fall in falls)
    if steep > 0:  # two half turns less would be too steep
        assert height / (steep + eased) > math.pi * radius * math.tan(angle) * (1 - 1e-9)


@pytest.mark.parametrize("turn", TURNS)
def test_haas_helix_goes_once_round_and_onto_the_first_ring(turn):
    path = pocket((6.0, 9.0), (-2, -4, -4), turn, helix=4.5, angle=THREE).toolpath()
    assert_joined(path)
    assert max(corners(path)) < 1e-6
    level = [4.5, 6, 9]
    assert circles(path) == [(-2.0, r) for r in level] + [(-4.0, r) for r in [*level, 6, 9]]
    assert {move.feed for move in path if move.name == "helix"} == {60.0}


@pytest.mark.parametrize(("turn", "over"), [(-1, 1)])
def test_yasnac_golden_case(turn, over):
    fast, out, circle, back, home = YasnacWords(30, 40, 40, 1, turn, 600.0).toolpath()
    assert fast.rapid and (fast.curve.end, home.curve.end) == (30, 0)
    assert out.curve.point(0.5) == pytest.approx(35 + over * 5j)
    assert back.curve.point(0.5) == pytest.approx(35 - over * 5j)
    assert circle.curve.radius == pytest.approx(40)
    other = YasnacWords(-30, -40, -40, 1, turn, 600.0).toolpath()
    points = [-point for point in turned_back([fast, out, circle, back, home], 1)]
    assert turned_back(other, 1) == pytest.approx(points)


def test_yasnac_spiral_grows_in_whole_turns():
    path = YasnacWords(0.0, 10.0, 40.0, 2, 1, 600.0, pitch=12.0, traverse=3000.0).toolpath()
    ends = [abs(move.curve.end) for move in path if move.name == "spiral"]
    assert ends == pytest.approx([16, 22, 28, 34, 37, 40])
    assert circles(path) == [(0, 40)] * 2
    assert max(corners(path)) < 1e-6


def test_mitsubishi_golden_case():
    out, circle, back = MitsubishiWords(40.0, -1, 600.0).toolpath()
    assert out.curve.point(0.5) == pytest.approx(20 + 20j)
    assert (circle.curve.radius, back.curve.end) == (40, pytest.approx(0))


# ---------------------------------------------------------------- the event

START, LEVEL, PLANE = 3 + 4j, 5.0, 0.1


def event(cutter=0.25, feed=20.0, **entries):
    """Return an event whose levels are given from the program's zero."""
    given = {"R": 1.5, "Z": -0.5, "W": PLANE, "C": 2.0, **entries}
    levels = {entry: given[entry] - LEVEL for entry in "ZWO" if entry in given}
    return EventWords({**given, **levels}, START, cutter, feed)


@pytest.mark.parametrize(
    ("entries", "rings"),
    [
        ({"J": 0.49}, [0.416667, 0.833333, 1.25]),
    ],
)
def test_event_steps_are_alike(entries, rings):
    assert event(G=7.0, **entries).rings == pytest.approx(rings, abs=1e-6)


@pytest.mark.parametrize(
    ("entries", "rough", "finish"),
    [
        ({"C": 2.0}, 0.75, None),
        ({"C": 0.0}, 1.0, None),
    ],
)
def test_event_perimeters(entries, rough, finish):
    found = event(R=1.0, **entries)
    assert found.rings == pytest.approx([rough])
    wall = [move.curve.radius for move in found.toolpath() if move.name == "finish circle"]
    assert wall == pytest.approx([finish] if finish else [])


@pytest.mark.parametrize(
    ("entries", "levels"),
    [
        ({}, [-1]),
        ({"K": 0.3, "L": 0.02}, [-0.2, -0.5, -0.8, -0.98, -1]),
    ],
)
def test_event_pecks_from_its_first_plane(entries, levels):
    from_tool = [level - LEVEL for level in levels]
    assert event(**{"Z": -1.0, **entries}).levels == pytest.approx(from_tool)


def feeds_of(found):
    """Return the feeds of the plunge, of roughing and of the finish."""
    made = {move.name: move.feed for move in found.toolpath()}
    return tuple(made[name] for name in ("plunge", "circle", "finish circle"))


def test_event_has_feeds_of_its_own():
    found = event(feed=8.0, P=1.0, V=4.0, L=0.1)
    assert feeds_of(found) == (1, 8, 4)
    found = event(L=-0.1)
    assert feeds_of(found) == (20, 20, 20)


@pytest.mark.parametrize(
    ("direction", "compensation", "side"),
    [(3, 1, -1)],
)
def test_event_puts_the_cutter_where_the_manual_says(direction, compensation, side):
    assert event(D=direction, C=compensation).side == side


@pytest.mark.parametrize("entries", [{"G": 7.0, "K": 0.3}, {"C": 1.0}])
def test_event_goes_out_and_comes_back(entries):
    path = event(O=0.5, L=0.02, **entries).toolpath()
    assert_joined(path)
    assert path[-1].curve.end == 3 + 4j and path[-1].end_level == pytest.approx(-4.5)
    finish = next(at for at, move in enumerate(path) if move.name == "finish circle")
    lead_in, circle, lead_out = path[finish - 1 : finish + 2]
    assert lead_in.curve.direction(1.0) == pytest.approx(circle.curve.direction(0.0))
    assert lead_out.curve.direction(0.0) == pytest.approx(circle.curve.direction(1.0))
