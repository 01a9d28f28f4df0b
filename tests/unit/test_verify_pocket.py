# SPDX-License-Identifier: GPL-2.0-or-later
"""Pockets made by hand, right and wrong, and what is measured of them."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.path.follow import follow
from g12.tools.path.part import Part
from g12.tools.path.track import track
from g12.tools.units import UNITS
from g12.tools.verify.findings import pocket_findings, pocket_notes
from g12.tools.verify.pocket import measure_pocket
from g12.tools.verify.pocket_entry import HelixFacts, entry_json
from g12.tools.verify.wanted_circle import CircleFeeds, Cutter, Schedule, Source, Target, Wall
from support.made_moves import LIMITS, Hand, samples_of

TOLERANCE = 0.005
UNSAID = CircleFeeds(None, None, None, None)
MILL = Part(turning=False)


def target(radius=20.0, **changes):
    parts = {
        Wall: {"origin": np.array([50.0, 0, 0]), "axes": np.eye(3), "radius": radius},
        Cutter: {"radius": 3.0},
        Schedule: {"levels": (-1.0,), "passes": 1, "feeds": UNSAID, "turn": -1},
    }
    for part, about in parts.items():
        own = {field.name for field in fields(part)} & changes.keys()
        about.update({name: changes.pop(name) for name in own})
    assert not changes
    return Target(Source(1, "", "G12", "haas"), *(part(**about) for part, about in parts.items()))


def measure(hand, wanted, real_shift=None):
    path = track(MILL, hand.moves, LIMITS)
    real = None
    if real_shift is not None:
        samples = samples_of(path, 8000, shift=real_shift)
        real = follow(path, hand.moves, samples, 1.0)
    last = len(hand.moves)
    return measure_pocket(wanted, range(1, last), path, hand.moves, TOLERANCE, real)


def cut(rings, **options):
    return Hand().rapid(x=50).pocket(rings, **options)


def findings(facts):
    return " | ".join(pocket_findings(facts, TOLERANCE))


WRONG_WAY = "it turns the wrong way: a circle of {} mm (tool centre) at −1"


def test_a_good_pocket_has_no_findings():
    facts = measure(cut([4, 8, 12, 17]), target(), None)
    assert facts.reached == pytest.approx(20)
    assert facts.deviation < 1e-9
    assert (facts.left, facts.gouge) == (0, 0)
    assert facts.rings == (4, 8, 12, 17)
    assert facts.stepover == pytest.approx(5, abs=1e-4)
    assert facts.depths == pytest.approx((-1,))
    assert facts.turns == (-1,)
    (jump,) = pocket_findings(facts, TOLERANCE)  # these links are no tangents
    assert jump.startswith("the direction jumps by 90 degrees at X")


def test_one_ring_is_smooth_and_leaves_its_core():
    facts = measure(cut([17]), target(cleared=14.0))
    assert facts.jump < 1e-6 and facts.stepover is None
    assert findings(facts) == ""


@pytest.mark.parametrize("ring", [0.02, 0.3, 1.0, 1.06, 2.5])
def test_a_small_ring_is_round(ring):
    facts = measure(cut([ring]), target(ring + 3))
    assert facts.deviation < 1e-4 and findings(facts) == ""


@pytest.mark.parametrize(("ring", "gouged"), [(17.02, True), (16.98, False)])
def test_a_wrong_size_is_found(ring, gouged):
    facts = measure(cut([ring]), target(cleared=14.1))
    assert facts.deviation == pytest.approx(0.02)
    assert facts.reached == pytest.approx(ring + 3)
    band = 2 * math.pi * 20 * (0.02 - TOLERANCE)
    assert (facts.gouge if gouged else facts.left) == pytest.approx(band, rel=0.01)
    assert "the wall is 0.02 mm off" in findings(facts)


@settings(max_examples=8, deadline=None)
@given(step=st.floats(6.1, 12.0))
def test_too_wide_a_stepover_leaves_the_area_between_the_rings(step):
    inner, outer = 30.0, 30.0 + step
    hand = cut([inner, outer], lead=False)
    facts = measure(hand, target(outer + 3, cleared=inner))
    between = math.pi * ((outer - 3 - 2 * TOLERANCE) ** 2 - (inner + 3) ** 2)
    link, lead_out = 6 * (step - 6), 6 * (step - 6)  # cut through the band, about
    assert facts.left == pytest.approx(between - link - lead_out, rel=0.15, abs=3)
    assert facts.stepover == pytest.approx(step, abs=1e-3)


def test_a_missing_piece_of_the_wall_is_found():
    hand = cut([17])
    half = hand.moves[3]._replace(end=(33.0, *hand.moves[3].end[1:]))
    hand.moves[3] = half
    facts = measure(hand, target(cleared=14.0))
    assert facts.deviation > 10
    assert "left standing" in findings(facts)


def test_the_wrong_turn_is_found():
    assert findings(measure(cut([17], turns=1), target(cleared=14))) == WRONG_WAY.format(17)


def test_a_wrong_depth_is_found():
    facts = measure(cut([17], depth=-0.9), target(cleared=14))
    assert findings(facts) == "the depth is off by 0.1 mm"


def test_a_dive_below_the_depth_is_found():
    hand = Hand().rapid(x=50).line(z=-6).line(z=-1).pocket([17])
    assert findings(measure(hand, target(cleared=14))) == "it goes 5 mm below its depth"


def test_levels_are_those_asked_for():
    hand = cut([17], depth=-0.6).pocket([17], depth=-1.0)
    assert findings(measure(hand, target(cleared=14, passes=2, levels=(-0.6, -1.0)))) == ""
    found = findings(measure(hand, target(cleared=14, passes=2, levels=(-0.3, -0.6, -1.0))))
    assert found == "it is cut at −0.6, −1, not at −0.3, −0.6, −1 mm"
    assert "not at −0.5, −1 mm" in findings(
        measure(hand, target(cleared=14, passes=2, levels=(-0.5, -1.0)))
    )


def test_circles_along_the_wall_are_counted():
    hand = cut([10, 17]).arc(-1, 58.5, 0, x=67).arc(-1, 50, 0).arc(-1, 58.5, 0, x=50)
    assert findings(measure(hand, target(cleared=14, passes=2, smooth=False))) == ""
    found = findings(measure(hand, target(cleared=14, passes=3, smooth=False)))
    assert found == "full circles along the wall: 2, not 3"


@pytest.mark.parametrize(
    ("turn", "finish", "found"),
    [
        (-1, 1, ""),
        (1, 1, WRONG_WAY.format(10)),
        (-1, -1, "its finish pass turns the wrong way"),
        (-1, 0, WRONG_WAY.format(17)),
    ],
)
def test_rough_and_finish_turn_as_asked(turn, finish, found):
    hand = cut([10, 16]).line(x=67).arc(1, 50, 0)
    wanted = target(cleared=14, turn=turn, finish_turn=finish, smooth=False)
    assert findings(measure(hand, wanted)) == found


@pytest.mark.parametrize(
    ("feeds", "found"),
    [
        (CircleFeeds(600, 600, 600, None), ""),
        (CircleFeeds(None, 600, None, 600), ""),
        (CircleFeeds(60, 600, 600, None), "a move has the feed 600, not 60"),
        (CircleFeeds(600, 60, 600, None), "a move has the feed 600, not 60"),
        (CircleFeeds(600, 600, 60, None), "a move has the feed 600, not 60"),
        (CircleFeeds(600, 600, 600, 60), "a move has the feed 600, not 60"),
    ],
)
def test_feeds_are_those_asked_for(feeds, found):
    assert findings(measure(cut([10, 17]), target(cleared=14, feeds=feeds, smooth=False))) == found


def test_a_ring_that_falls_a_little_is_no_way_down():
    hand = cut([17])
    ring = hand.moves[-2]
    hand.moves[-2] = ring._replace(start=(*ring.start[:2], -0.996, *ring.start[3:]))
    facts = measure(hand, target(cleared=14))
    assert facts.helix is None and facts.left == 0


def test_a_block_that_cuts_nothing_is_found():
    hand = Hand().rapid(x=50).rapid(z=-1).rapid(z=0)
    assert findings(measure(hand, target())) == "nothing is cut"


def test_an_eccentric_circle_is_found():
    hand = Hand().rapid(x=50.03).pocket([17])
    facts = measure(hand, target(cleared=14.1))
    assert facts.deviation == pytest.approx(0.03, rel=1e-3)


def test_a_deeper_level_clears_the_ones_above():
    hand = cut([10], depth=-1).line(x=50, y=0).pocket([4, 8, 12, 17], depth=-2)
    assert measure(hand, target(levels=(-2.0,))).left == 0


def test_a_wall_cut_from_outside():
    hand = Hand().rapid(x=50, y=-26).rapid(x=50, y=-23).line(z=-1).arc(-1, 50, 0)
    wanted = target(inside=False, smooth=False)
    facts = measure(hand, wanted)
    assert facts.reached == pytest.approx(20) and findings(facts) == ""
    closer = Hand().rapid(x=50, y=-22.9).line(z=-1).arc(-1, 50, 0)
    facts = measure(closer, wanted)
    ring = 2 * math.pi * 20 * (0.1 - TOLERANCE)
    assert facts.gouge == pytest.approx(ring, rel=0.02)


def test_pockets_of_one_shape_are_measured_once():
    hand = Hand().rapid(x=50).pocket([17]).rapid(x=90.3, y=7.1).pocket([17])
    hand.rapid(x=130).pocket([17.02])
    path, known = track(MILL, hand.moves, LIMITS), {}
    found = []
    for first, x, y in ((1, 50, 0), (6, 90.3, 7.1), (11, 130, 7.1)):
        wanted = target(cleared=14.1, origin=np.array([x, y, 0.0]))
        pocket = (range(first, first + 4), path, hand.moves, TOLERANCE)
        found.append(measure_pocket(wanted, *pocket, known=known))
        alone = measure_pocket(wanted, *pocket)
        assert found[-1].deviation == pytest.approx(alone.deviation, abs=1e-6)
    assert len(known) == 2
    assert [findings(facts) == "" for facts in found] == [True, True, False]


def test_another_plane_is_measured_the_same():
    axes = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]], float)  # G18
    hand = Hand().rapid(x=0, z=17)
    hand.arc(1, 0, 0, plane=18)
    hand.moves[-1] = hand.moves[-1]._replace(centre=(0.0, 0.0, 0.0))
    wanted = target(cleared=14, origin=np.zeros(3), axes=axes, levels=(0.0,), turn=1)
    facts = measure(hand, wanted)
    assert facts.deviation < 1e-9 and facts.left == 0 and findings(facts) == ""


def test_real_motion_beside_the_path_is_found():
    facts = measure(cut([17]), target(cleared=14.1), real_shift=0.03)
    assert facts.off_rings == pytest.approx(0.03, rel=0.01)
    assert facts.deviation == pytest.approx(0.03, rel=0.02)
    assert facts.gouge > 0
    exact = measure(cut([17]), target(cleared=14.1), real_shift=0.0)
    assert exact.deviation < 1e-3 and exact.gouge == 0


# ---------------------------------------------------------------- the loaded tool and D


@pytest.mark.parametrize(
    ("loaded", "found", "noted"),
    [
        (3.0, "", ""),
        (
            1.5,
            "the loaded tool T1 (⌀ 3) is not D2 (⌀ 6): the wall comes out at radius 18.5, not 20",
            "",
        ),
        (3.1, "", "T1 (⌀ 6.2) is not D2 (⌀ 6): measured with the cutter of D2"),
        (0.0, "", "T1 has no diameter: measured with the diameter of D2"),
    ],
)
def test_a_tool_that_is_not_that_of_d(loaded, found, noted):
    wanted = target(loaded=loaded, tool=1, named=2, smooth=False)
    facts = measure(cut([5, 11, 17]), wanted)
    assert " | ".join(pocket_findings(facts, TOLERANCE)) == found
    assert noted in " | ".join(pocket_notes(facts)) and bool(noted) == any(pocket_notes(facts))


def test_sizes_of_tools_are_told_in_the_units_asked_for():
    facts = measure(cut([5, 11, 17]), target(loaded=12.7, tool=1, named=2))
    assert "T1 (⌀ 1)" in next(pocket_findings(facts, TOLERANCE, UNITS["inch"]))


def test_a_program_is_told_the_greatest_and_the_least_radius_of_the_helices():
    told = entry_json(HelixFacts(count=2, least=1.0, greatest=2.0, steepest=3.0))
    assert told == {"way": "helix", "helices": 2, "radius": 2.0, "least_radius": 1.0, "angle": 3.0}
    assert entry_json(None) == {"way": "straight"}
