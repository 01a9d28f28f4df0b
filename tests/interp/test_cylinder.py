# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 on the stock interpreter: its words, its state after, every refusal.

Its geometry is proved in test_valid_cuts.py.
"""

import math
from functools import partial
from itertools import groupby

import pytest

from g12.tools.preview.tracer import Tracer
from support import polar_programs
from support.polar_programs import FIRST, feed_moves, refused, tracer
from support.sim_machines import SIM, kept_tracer

R = 20.0
X, Z, C = 0, 2, 5
section = partial(
    polar_programs.section, start="G0 X22 Z0 C0", tool="T3 M6", feed="F250", on=f"G07.1 C{R:g}",
    off="G07.1 C0",
)  # fmt: skip


lathe = kept_tracer("lathe_mm")


def ends(traced):
    """Return X, Z and C at the end of each block that moved at a feed."""
    blocks = groupby(feed_moves(traced), key=lambda move: move.line)
    last = [list(moves)[-1].end for _, moves in blocks]
    return [tuple(round(end[axis], 6) + 0.0 for axis in (X, Z, C)) for end in last]


TINY = 1e-7  # mm: less is no move of an axis, to LinuxCNC


def seconds(move):
    """Return how long LinuxCNC takes: F is for X and Z, or for C where neither moves."""
    dx, dz, dc = (move.end[axis] - move.start[axis] for axis in (X, Z, C))
    length = math.hypot(dx, dz)
    return 60.0 * (length if length > TINY else abs(dc)) / move.feed


# ---------------------------------------------------------------- words


def test_z_is_a_length_and_c_an_angle_and_a_line_is_one_move(lathe):
    traced = lathe.trace_text(section("G1 X18", "Z-10", "C90", "Z-20 C-720.5"))
    assert ends(traced) == [(18, 0, 0), (18, -10, 0), (18, -10, 90), (18, -20, -720.5)]
    assert len(feed_moves(traced)) == 4


def test_w_h_and_u_are_increments(lathe):
    traced = lathe.trace_text(section("G1 W-5 C10", "H-30 Z-7", "W1 H1", "U-4", "G91 W1", "H2"))
    assert ends(traced) == [
        (22, -5, 10), (22, -7, -20), (22, -6, -19), (18, -6, -19), (18, -5, -19), (18, -5, -17),
    ]  # fmt: skip


def test_position_parameters_show_the_programmed_position(lathe):
    body = ["G41 G1 Z-20", "G1 Z[#5422-1] C[#<_c>+15]", "C[#5425+15]", "G40 Z0"]
    traced = lathe.trace_text(section(*body, start="G0 X22 Z0 C33"))
    plain = ["G41 G1 Z-20", "G1 Z-21 C48", "C63", "G40 Z0"]
    assert ends(traced) == ends(lathe.trace_text(section(*plain, start="G0 X22 Z0 C33")))


def test_rapids_as_feeds_where_they_are_allowed():
    with tracer(POLAR_G0="feed", POLAR_G0_FEED="4000") as lathe:
        moves = feed_moves(lathe.trace_text(section("G0 C90", "G1 C0")))
    assert [seconds(move) for move in moves] == pytest.approx(
        [math.pi / 2 * R / feed * 60 for feed in (4000, 250)]
    )


# ---------------------------------------------------------------- refusals


INSIDE = [  # those of one planner are in unit/test_cylinder.py
    ("G12.1", "G12.1 is refused: only G1, G2 and G3 move inside the section"),
    ("G7.1 C30", "the section is already on: G7.1 C0 ends it"),
    ("G18 G7.1 C30", "G7.1 must be alone in its block"),
    ("G1 X5 Z3", "X needs a block of its own, or [G12] CYLINDER_X = allow"),
    ("G1 Z501", "the Z axis would go to 501 mm, beyond its limit 500 mm"),
]  # fmt: skip


@pytest.mark.parametrize(("block", "why"), INSIDE)
def test_refused_inside(lathe, block, why):
    text, line = refused(lathe, section("G1 Z0", "C1", "C0", block, "G1 Z1"))
    assert (text, line) == (f"G7.1 line 9: {why}", 9)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"on": "G7.1"}, "needs C, the cylinder's radius; C0 ends a section"),
        ({"on": "G7.1 C20 Z5"}, "must be alone in its block"),
    ],
)  # fmt: skip
def test_refused_to_begin(lathe, given, why):
    assert refused(lathe, section("G1 Z5", **given)) == (f"G7.1 line 5: {why}", 5)


def test_words_beside_the_code_that_ends_no_section(lathe):
    traced = lathe.trace_text([FIRST, "G7.1 C0 K3", "M2"])
    assert traced.error.text == "G7.1 line 2: C0 must be alone in its block"


def test_a_machine_without_z_is_told():
    overrides = {"TRAJ": {"COORDINATES": "X C"}, "KINS": {"KINEMATICS": "trivkins coordinates=XC"}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        error = lathe.trace_text([FIRST.replace("G18 ", ""), "G7.1 C5", "M2"]).error
    assert error.text == "G7.1 line 2: needs a machine with an X, Z and a C axis"
