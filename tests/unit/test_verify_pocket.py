# SPDX-License-Identifier: GPL-2.0-or-later
"""Pockets made by hand, right and wrong, and what is measured of them."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.path.follow import follow
from g12.tools.path.part import Part
from g12.tools.path.slowest import pace_of
from g12.tools.path.track import track
from g12.tools.preview.executed_blocks import Block
from g12.tools.units import UNITS
from g12.tools.verify.commanded import Commanded
from g12.tools.verify.expected.circle_mill import EventWords
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.pocket import measure_pocket
from g12.tools.verify.reading.circles import Cutter, Target, Wall
from g12.tools.verify.subject import Subject
from g12.tools.verify.workpiece import assumed_workpiece
from support.made_moves import LIMITS, Hand, samples_of

TOLERANCE = 0.005
MILL = Part(turning=False)
CENTRE = np.array([50.0, 0.0, 0.0])
G18 = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]], float)


def target(rings=(3.0, 8.0, 13.0, 17.0), depths=(-1.0,), *, cutter=3.0, requested=None, **wall):
    requested = requested or HaasWords(0j, rings, depths, -1, 600.0, 600.0)
    wall = Wall(**{"origin": CENTRE, "axes": np.eye(3), "radius": rings[-1] + cutter, **wall})
    return Target(1, "", "G12", "haas", wall, Cutter(cutter), requested)


def made(expected, plane=17):
    """Return moves exactly as a target's words ask for them, and the one to their start before."""
    hand = Hand()
    start = expected.path[0]
    hand.rapid(**dict(zip("xyz", expected.wall.machine((start.curve.start, start.start_level)))))
    for move in expected.path:
        end = dict(zip("xyz", expected.wall.machine((move.curve.end, move.end_level))))
        if hasattr(move.curve, "sweep"):
            centre = expected.wall.machine((move.curve.centre, move.start_level))
            hand.arc(int(math.copysign(1, move.curve.sweep)), *centre[:2], plane=plane, **end)
            hand.moves[-1] = hand.moves[-1]._replace(centre=centre)
        elif move.rapid:
            hand.rapid(**end)
        else:
            hand.line(**end)
    return hand.moves


def measure(moves, expected, real_shift=None):
    real, path = None, track(MILL, moves, LIMITS)
    if real_shift is not None:
        real = follow(path, samples_of(path, 8000, shift=real_shift), 1.0)
    pace = partial(pace_of, path=path)
    block = Block(None, {}, (), (), (), {}, 1, len(moves))
    loaded = {1: 2 * expected.cutter.loaded}
    trace, words = (
        replace(Hand().trace(), moves=moves, diameters=loaded),
        Commanded([(block, expected)]),
    )
    subject = Subject(None, None, trace, MILL, commanded=words, drawn=(path, real))
    material = assumed_workpiece(subject).material
    return measure_pocket(block, expected, moves, material, TOLERANCE, pace, real)


def codes(moves, expected, **options):
    return [found.code for found in measure(moves, expected, **options).judged]


def event(**entries):
    words = {"R": 20.0, "Z": -4.0, "W": -2.0, "C": 2.0, "L": 0.5, **entries}
    requested = EventWords(words, 5 + 2j, 3.0, 600.0)
    core = 0.0 if "G" in entries else 13.5
    origin = np.array([50.0, 0.0, 3.0])
    return target((17.0,), requested=requested, origin=origin, cleared=core)


def test_a_good_pocket_has_no_findings():
    expected = target()
    facts = measure(made(expected), expected)
    assert facts.judged == ()
    assert (
        facts.values["reached"] == pytest.approx(20)
        and facts.deviation < 1e-9
        and facts.values["left"] == 0
    )
    assert (
        facts.values["rings"] == pytest.approx((3, 8, 13, 17))
        and facts.values["turns"] == "clockwise"
    )


@pytest.mark.parametrize("entries", [{"G": 7.0}, {"G": 7.0, "K": 0.7, "O": 3.0}, {"D": 2.0}])
def test_a_good_event_has_no_findings(entries):
    expected = event(**entries)
    assert codes(made(expected), expected) == []


def test_another_plane_is_measured_the_same():
    expected = target(axes=G18, origin=np.zeros(3))
    assert codes(made(expected, plane=18), expected) == []


@pytest.mark.parametrize("ring", [0.02, 0.3, 1.0, 1.06, 2.5])
def test_a_small_ring_is_round(ring):
    expected = target((ring,))
    facts = measure(made(expected), expected)
    assert facts.values["left"] == 0 and facts.judged == ()


@pytest.mark.parametrize("at", range(1, 14))
def test_every_move_is_needed_as_it_is(at):
    """Cut short, turned the other way or ending a hundredth lower: none of it passes."""
    expected = target()
    moves = made(expected)
    before, move, after = moves[:at], moves[at], moves[at + 1 :]
    if move.start != move.end:
        straight = move._replace(kind="feed", centre=None, end=(*before[0].end[:2], *move.end[2:]))
        assert codes([*before, straight, *after], expected) or straight.end == move.end
    lower = (*move.end[:2], move.end[2] - 0.011, *move.end[3:])
    assert codes([*before, move._replace(end=lower), *after], expected)
    if move.kind == "arc":
        assert codes([*before, move._replace(turns=-move.turns), *after], expected) == ["path-off"]


def test_a_straight_line_onto_the_finished_wall_is_off():
    expected = event(G=7.0)
    moves = made(expected)
    entry = next(at for at, m in enumerate(expected.path, 1) if m.name == "lead-in of the finish")
    straight = moves[entry]._replace(kind="feed", centre=None, turns=0)
    assert codes([*moves[:entry], straight, *moves[entry + 1 :]], expected) == ["path-off"]
    other = moves[entry]._replace(turns=-moves[entry].turns)
    assert codes([*moves[:entry], other, *moves[entry + 1 :]], expected) == ["path-off"]


@settings(max_examples=8, deadline=None)
@given(step=st.floats(6.1, 12.0))
def test_too_wide_a_stepover_leaves_the_area_between_the_rings(step):
    inner, outer = 30.0, 30.0 + step
    expected = target((inner, outer), cleared=inner)
    facts = measure(made(expected), expected)
    between = math.pi * ((outer - 3 - 2 * TOLERANCE) ** 2 - (inner + 3) ** 2)
    assert 0.6 * between < facts.values["left"] < between  # links and leads cut some of it
    assert [found.code for found in facts.judged] == ["uncut"]


def test_real_motion_beside_the_path_is_found():
    expected = target()
    facts = measure(made(expected), expected, real_shift=0.03)
    assert facts.values["off_circles"] == pytest.approx(0.03, rel=0.01)
    assert facts.values["too_far"] == pytest.approx(0.03, rel=0.02) and facts.values["left"] > 0.5
    found = [finding.code for finding in facts.judged]
    assert found == ["uncut", "wall-run"]
    assert codes(made(expected), expected, real_shift=0.0) == []


def test_a_pocket_above_the_tool_cuts_air():
    expected = target(depths=(1.0,))
    assert codes(made(expected), expected) == ["cuts-air"]


# ---------------------------------------------------------------- the loaded tool and D


@pytest.mark.parametrize(
    ("loaded", "found", "noted"),
    [
        (3.0, [], ""),
        (1.5, ["wrong-cutter", "uncut"], ""),
        (3.1, [], "the loaded tool T1 (⌀ 6.2) is not D2 (⌀ 6): measured with the cutter of D2"),
        (0.0, [], "T1 has no diameter: measured with the diameter of D2"),
    ],
)
def test_a_tool_that_is_not_that_of_d(loaded, found, noted):
    expected = replace(target(), cutter=Cutter(3.0, 1, loaded, 2))
    facts = measure(made(expected), expected)
    assert [each.code for each in facts.judged if each.is_finding] == found
    assert [each.text() for each in facts.judged if each.is_note] == [noted] * bool(noted)


def test_sizes_of_tools_are_reported_in_the_units_asked_for():
    expected = replace(target(), cutter=Cutter(3.0, 1, 12.7, 2))
    found = measure(made(expected), expected).judged[0]
    assert "T1 (⌀ 1)" in found.text(UNITS["inch"])
