# SPDX-License-Identifier: GPL-2.0-or-later
"""Rapids made by hand, through air and through material."""

from dataclasses import replace

import numpy as np
import pytest

from g12.tools.path.follow import follow
from g12.tools.path.part import Part, disc
from g12.tools.path.track import track
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.commanded import Commanded
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.in_material import assumptions, judge_rapids
from g12.tools.verify.reading.circles import Cutter, Target, Wall
from g12.tools.verify.subject import Subject
from g12.tools.verify.workpiece import assumed_workpiece
from support.made_moves import LIMITS, Hand, samples_of

MILL = Part(turning=False)
RINGS = [5, 9, 13, 17]  # of the tool's centre: the wall is at 20


class Pockets(Hand):
    """A hand that remembers which of its moves are pockets."""

    def __init__(self):
        super().__init__()
        self.commanded = []

    def mill(self, rings=RINGS, depth=-3.0, cutter=3.0, down=None, **of_wall):
        first, place = len(self.moves), np.array(self.at[:3])
        self.next_block()
        if down is not None:
            self.rapid(z=down)
        self.pocket(rings, depth)
        wall = Wall(place, np.eye(3), rings[-1] + 3.0, **of_wall)
        words = HaasWords(0j, rings, [depth - place[2]], -1, None, None)
        target = Target(self.block, "", "G12", "haas", wall, Cutter(cutter), words)
        self.commanded.append((Block(None, {}, (), (), (), {}, first, len(self.moves)), target))
        return self.next_block()

    def in_material(self, real=None):
        path = track(MILL, self.moves, LIMITS)
        run = follow(path, real(path), 1.0) if real else None
        words = Commanded(self.commanded)
        subject = Subject(None, None, self.trace(), MILL, commanded=words, drawn=(path, run))
        return assumed_workpiece(subject)

    def found(self, real=None):
        judged = judge_rapids(self.in_material(real))
        return [found for found in judged if found.is_finding]

    def assumed(self):
        return [note.text() for note in assumptions(self.in_material())]


def start(z=2.0):
    return Pockets().rapid(x=50, z=z)


FOUND = {
    "a retract before the next pocket": (
        start().mill().rapid(z=2).rapid(x=150).mill().rapid(z=2), []),
    "a slanting retract through the wall": (start().mill().rapid(x=150, z=2), [3]),
    "inside the pocket": (start().mill().rapid(x=60, y=8).rapid(x=50, y=0).rapid(z=2), []),
    "air from the pocket's top to Z0": (start(z=10).mill().rapid(z=1).rapid(x=150), []),
    "material below it": (start(z=10).mill().rapid(z=-1).rapid(x=150), [3]),
    # a pocket that is not below Z0 has its top where it began to feed, the lowest of several
    "below such a top": (start(z=10).mill(depth=5.0).rapid(z=7).rapid(x=150), [3]),
    "at such a top": (start(z=10).mill(depth=5.0).rapid(z=10).rapid(x=150), []),
    "at the feed after own rapids": (
        start(z=30).mill([17], depth=5.0, down=7).rapid(z=7).rapid(x=150), []),
    "below the feed after own rapids": (
        start(z=30).mill([17], depth=5.0, down=7).rapid(z=6).rapid(x=150), [3]),
    "at the lowest of two": (
        start(z=30).mill(depth=5.0).rapid(z=10).rapid(x=150).mill(depth=5.0).rapid(z=10)
        .rapid(x=50), []),
    "deeper in the same place": (
        start().mill(depth=-2.0).mill(depth=-4.0).rapid(z=2).rapid(x=150), []),
    "a channel that was cut before": (
        start().mill().line(x=150).mill().rapid(x=50).rapid(z=2), []),
    "in a bored hole": (
        Pockets().rapid(x=50, z=2).rapid(z=-3).mill([17], bore=16.0).rapid(x=60, y=2), []),
    "where no hole is": (
        Pockets().rapid(x=50, z=2).rapid(z=-3).mill([17]).rapid(x=60, y=2), [3]),
    "down to the floor": (
        start().mill(depth=-2.0).rapid(z=2).rapid(z=-2).mill(depth=-2.0), []),
}  # fmt: skip


@pytest.mark.parametrize("what", FOUND)
def test_a_rapid_through_material_is_found_and_no_other(what):
    program, lines = FOUND[what]
    assert [hit.line for hit in program.found()] == lines


def test_a_forgotten_retract_goes_through_the_wall():
    program = start().mill().rapid(x=150).mill().rapid(z=2)
    (hit,) = program.found()
    assert hit.line == 3
    assert hit.values["area"] == pytest.approx(6 * (2 + 22), rel=0.1)  # a wall, the next pocket
    assert hit.place == pytest.approx((67.3, 0, -3), abs=0.6)


def test_a_rapid_through_the_core_is_found():
    program = start().mill([17]).rapid(x=33).rapid(z=2)
    (hit,) = program.found()
    assert 6 * 8 < hit.values["area"] < 6 * 14.5  # the leads have cut some of the core


@pytest.mark.parametrize("shift", [{"inside": False}, {"axes": np.eye(3)[[2, 0, 1]]}])
def test_cuts_without_a_wall_are_not_judged(shift):
    program = start().mill().rapid(x=150)
    program.commanded = [
        (b, replace(t, wall=replace(t.wall, **shift))) for b, t in program.commanded
    ]
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
    program = Pockets().rapid(x=50, z=2).rapid(z=-3).mill([17], depth=-3.0, bore=16.0)
    material = program.in_material().material
    hole = disc((50, 0), 15)
    low, high = (material.standing(hole, level).area for level in (-5.0, -1.0))
    assert low == pytest.approx(hole.area - np.pi * 9, rel=1e-2) and high == 0


def test_a_rapid_down_into_the_floor_is_found():
    program = start().mill(depth=-2.0).rapid(z=2).rapid(z=-4.0).mill(depth=-1.0)
    (hit,) = program.found()
    assert hit.values["area"] == pytest.approx(np.pi * 9, rel=0.05) and hit.place[2] == -4


def bored(first):
    program = Pockets().rapid(x=150, z=10).rapid(z=first).mill([17], depth=-3.0).rapid(z=10)
    program.rapid(x=50).rapid(z=-3).mill([17], depth=-3.0)
    return program.rapid(z=2).rapid(z=-6).mill([17], depth=-6.0).rapid(z=10)


def test_holes_are_assumed_where_the_program_comes_down_to_its_first_cycle_by_rapid():
    program = bored(first=-3.0)
    (note,) = program.assumed()
    assert program.found() == [] and "(also in line 3)" in note
    assert note.startswith("verify assumes a bored hole down to X150 Y0 Z−3, because a rapid")


def test_no_hole_is_assumed_where_the_first_cycle_is_fed_down_to():
    program = bored(first=1.0)
    assert [hit.line for hit in program.found()] == [3, 5] and program.assumed() == []


@pytest.mark.parametrize("height", [-0.01, -0.1, -0.3, -2.9])
def test_a_retract_that_lost_its_sign_is_found_at_any_height(height):
    program = start().mill().rapid(z=2).rapid(x=110).mill().rapid(z=height)
    program.rapid(x=200).mill().rapid(z=2)
    assert 5 in [hit.line for hit in program.found()]


def test_below_z0_it_is_open_where_the_first_rapid_comes_down():
    program = start().rapid(z=-2).mill(depth=-4).rapid(z=-2).rapid(x=150).mill(depth=-4)
    assert program.found() == [] and len(program.assumed()) == 1


@pytest.mark.parametrize(("face", "lines"), [(0.0, []), (0.5, [3])])
def test_where_the_machine_is_says_nothing_without_a_work_offset(face, lines):
    program = start().mill(face=face).rapid(z=-40).rapid(x=150).rapid(z=2).rapid(x=50)
    down = len(program.moves) - 4
    program.moves[down] = program.moves[down]._replace(by_machine=True)
    assert [hit.line for hit in program.found()] == lines
