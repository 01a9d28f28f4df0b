# SPDX-License-Identifier: GPL-2.0-or-later
"""Rapids made by hand, through air and through material."""

from dataclasses import replace

import numpy as np
import pytest

from g12.tools.path.follow import follow
from g12.tools.path.part import Part
from g12.tools.path.track import track
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.rapids import Cleared, collisions
from g12.tools.verify.reading.circles import Cutter, Source, Target, Wall
from support.made_moves import LIMITS, Hand, samples_of

MILL = Part(turning=False)
DIAMETERS = {1: 6.0}
RINGS = [5, 9, 13, 17]  # of the tool's centre: the wall is at 20


class Program(Hand):
    """A hand that remembers which of its moves are pockets."""

    def __init__(self):
        super().__init__()
        self.asked = []

    def mill(self, rings=RINGS, depth=-3.0, cutter=3.0, down=None, **wanted):
        first, place = len(self.moves), np.array(self.at[:3])
        self.next_block()
        if down is not None:
            self.rapid(z=down)
        self.pocket(rings, depth)
        wall = Wall(place, np.eye(3), rings[-1] + 3.0, **wanted)
        words = HaasWords(0j, rings, [depth - place[2]], -1, None, None)
        target = Target(Source(self.block, "", "G12", "haas"), wall, Cutter(cutter), words)
        self.asked.append((Block(None, {}, (), (), (), {}, first, len(self.moves)), target))
        return self.next_block()

    def found(self, real=None):
        path = track(MILL, self.moves, LIMITS)
        run = follow(path, self.moves, real(path), 1.0) if real else None
        return collisions(self.asked, self.moves, path, DIAMETERS, run)


def start(z=2.0):
    return Program().rapid(x=50, z=z)


def test_a_retract_before_the_next_pocket_is_good():
    assert start().mill().rapid(z=2).rapid(x=150).mill().rapid(z=2).found() == []


def test_a_forgotten_retract_goes_through_the_wall():
    program = start().mill().rapid(x=150).mill().rapid(z=2)
    (hit,) = program.found()
    assert hit.line == 3
    assert hit.area == pytest.approx(6 * 80, rel=0.05)  # from one wall to beyond the other
    assert hit.path[0] == pytest.approx((67.3, 0, -3), abs=0.6)


def test_a_slanting_retract_through_the_wall_is_found():
    assert [hit.line for hit in start().mill().rapid(x=150, z=2).found()] == [3]


def test_a_rapid_inside_the_pocket_is_good():
    assert start().mill().rapid(x=60, y=8).rapid(x=50, y=0).rapid(z=2).found() == []


def test_a_rapid_through_the_core_is_found():
    program = start().mill([17]).rapid(x=33).rapid(z=2)
    (hit,) = program.found()
    assert 6 * 8 < hit.area < 6 * 14.5  # the leads have cut some of the core


def test_between_the_pockets_top_and_z0_there_is_air():
    assert start(z=10).mill().rapid(z=1).rapid(x=150).found() == []
    assert len(start(z=10).mill().rapid(z=-1).rapid(x=150).found()) == 1


def test_a_pocket_that_is_not_below_z0_has_its_top_where_it_began():
    program = start(z=10).mill(depth=5.0).rapid(z=7).rapid(x=150)
    assert [hit.line for hit in program.found()] == [3]
    assert start(z=10).mill(depth=5.0).rapid(z=10).rapid(x=150).found() == []


@pytest.mark.parametrize(("height", "count"), [(7, 0), (6, 1)])
def test_the_top_is_where_a_cycle_begins_to_feed_behind_its_own_rapids(height, count):
    program = start(z=30).mill([17], depth=5.0, down=7).rapid(z=height).rapid(x=150)
    assert len(program.found()) == count


def test_the_lowest_height_that_a_pocket_began_at_is_the_top():
    program = start(z=30).mill(depth=5.0).rapid(z=10).rapid(x=150).mill(depth=5.0).rapid(z=10)
    assert program.rapid(x=50).found() == []


def test_going_deeper_in_the_same_place_is_good():
    program = start().mill(depth=-2.0).mill(depth=-4.0).rapid(z=2).rapid(x=150)
    assert program.found() == []


def test_a_channel_that_was_cut_before_lets_a_rapid_through():
    program = start().mill().line(x=150).mill().rapid(x=50).rapid(z=2)
    assert program.found() == []


@pytest.mark.parametrize(("bore", "count"), [(16.0, 0), (0.0, 1)])
def test_a_bored_hole_is_no_material(bore, count):
    program = Program().rapid(x=50, z=2).rapid(z=-3).mill([17], bore=bore)
    assert len(program.rapid(x=60, y=2).found()) == count


@pytest.mark.parametrize("shift", [{"inside": False}, {"axes": np.eye(3)[[2, 0, 1]]}])
def test_cuts_without_a_wall_are_not_judged(shift):
    program = start().mill().rapid(x=150)
    program.asked = [(b, replace(t, wall=replace(t.wall, **shift))) for b, t in program.asked]
    assert program.found() == []


def test_an_unknown_cutter_is_not_judged():
    program = start().mill(cutter=0.0).rapid(x=150)
    program.moves[:] = [move._replace(tool=7) for move in program.moves]
    assert program.found() == []


@pytest.mark.parametrize(("rings", "cuts"), [([17], True), (RINGS, False)])
def test_a_run_that_rounds_the_corner_of_a_retract_is_found_if_it_cuts(rings, cuts):
    program = start().mill(rings).rapid(z=2).rapid(x=150)

    def rounded(path):
        samples = samples_of(path, 6000)
        leaving = samples.time > path.time[path.vertices(len(program.moves) - 1).start]
        away = samples.axes["X"][leaving] - 50.0
        samples.axes["Z"][leaving] = np.clip(-3.0 + away / 3, -3.0, 2.0)
        return samples

    assert bool(program.found(real=rounded)) is cuts


def test_a_bore_counts_down_to_where_it_was_looked_at_and_no_deeper():
    program = Program().rapid(x=50, z=2).rapid(z=-3).mill([17], depth=-3.0, bore=16.0)
    path = track(MILL, program.moves, LIMITS)
    cleared = Cleared(program.asked, program.moves, path, DIAMETERS)
    low, high = (cleared.before(len(program.moves), height).area for height in (-5.0, -1.0))
    assert low == 0 and high > np.pi * 16**2


def test_a_height_is_looked_up_without_looking_at_every_move(monkeypatch):
    program = start(z=10)
    for _ in range(50):
        program.mill([5]).rapid(z=10)
    path = track(MILL, program.moves, LIMITS)
    cleared = Cleared(program.asked, program.moves, path, DIAMETERS)
    last = len(program.moves)
    cleared.before(last, -1.0)
    monkeypatch.setattr(cleared, "_floors_before", None)
    monkeypatch.setattr(cleared, "_area", None)
    areas = {cleared.before(last, height).area for height in np.linspace(-2.9, 9.0, 300)}
    assert len(areas) == 1


def test_a_rapid_down_into_the_floor_is_found():
    program = start().mill(depth=-2.0).rapid(z=2).rapid(z=-4.0).mill(depth=-1.0)
    (hit,) = program.found()
    assert hit.area == pytest.approx(np.pi * 9, rel=0.02) and hit.path[0][2] == -4


def test_a_rapid_down_to_the_floor_is_good():
    assert start().mill(depth=-2.0).rapid(z=2).rapid(z=-2).mill(depth=-2.0).found() == []


def test_a_rapid_down_is_good_where_the_first_cycle_began_with_one():
    program = Program().rapid(x=50, z=10).mill(depth=-0.5).rapid(z=10)
    program.rapid(x=150, z=10).rapid(z=-3).mill([17], depth=0.0)
    assert program.rapid(z=2).rapid(z=-6).mill([17], depth=0.0).rapid(z=10).found() == []


@pytest.mark.parametrize(("face", "count"), [(0.0, 0), (0.5, 2)])
def test_where_the_machine_is_says_nothing_without_a_work_offset(face, count):
    program = start().mill(face=face).rapid(z=-40).rapid(x=150).rapid(z=2).rapid(x=50)
    down = len(program.moves) - 4
    program.moves[down] = program.moves[down]._replace(by_machine=True)
    assert len(program.found()) == count
