# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 with [G12] ENTRY = helix on the stock interpreter: plunge feed, refusals, messages.

The helix itself is proved in test_valid_programs.py. Programs are in inches, the cutter is 0.5.
"""

import re

import pytest

from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM, kept_tracer

FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F10"


def tracer(**changed):
    overrides = {"ENTRY": "helix", **changed}
    return Tracer(SIM / "mill_inch.ini", tools={1: 0.5}, overrides={"G12": overrides})


mill = kept_tracer("mill_inch", tools={1: 0.5}, overrides={"G12": {"ENTRY": "helix"}})


def program(block, first=FIRST):
    """Return a program that cuts a pocket about X1 Y2 from Z.1."""
    return [first, "G0 X1 Y2 Z0.1", block, "M2"]


def pocket(machine, *arguments):
    """Return the moves of a pocket, from the first at its feed on."""
    found = machine.trace_text(program(*arguments))
    assert found.error is None, found.error
    return [move for move in found.moves if move.kind != "rapid"], found


def falling(moves):
    return [move for move in moves if move.start[2] - move.end[2] > 1e-9]


def test_a_pocket_that_needs_no_way_down_has_no_helix(mill):
    moves, _ = pocket(mill, "G12 I.75 D1")
    assert not falling(moves)
    up, found = pocket(mill, "G12 I.75 Z.5 D1")
    assert not falling(up) and "lost its minus sign" in found.messages[0].text


def test_half_of_the_feed_down_and_all_of_it_elsewhere():
    with tracer(PLUNGE_FEED=50) as machine:
        moves, found = pocket(machine, "G13 I.4 K.8 Q.2 Z-.3 D1")
    assert {move.feed for move in falling(moves)} == {127.0}
    assert {move.feed for move in moves if move not in falling(moves)} == {254.0}
    assert found.modes.feed == pytest.approx(10.0)


def test_a_slow_plunge_however_little_a_revolution_feeds():
    feed = 0.00015  # LinuxCNC's EQ takes numbers 0.0001 apart for equal
    per_revolution = f"{FIRST}\nG95 S1000 F{feed}"
    with tracer(ENTRY="plunge", PLUNGE_FEED=50) as machine:
        moves, _ = pocket(machine, "G13 I.4 Z-.3 D1", per_revolution)
    down = {move.feed for move in falling(moves)}
    plane = {move.feed for move in moves if move not in falling(moves)}
    assert [*down, *plane] == pytest.approx([feed / 2 * 25.4, feed * 25.4])


@pytest.mark.parametrize(
    ("words", "fits"),
    [
        ("I.252 Z-2 D1", r"I from (\S+) fits"),
        ("I.252 Z-99 D1", r"(\S+) down fits at most"),
        ("I.001 Z-2 D0", r"I from (\S+) fits"),
    ],
)
def test_a_helix_that_hardly_comes_down_is_refused_and_told_what_fits(mill, words, fits):
    found = mill.trace_text(program(f"G12 {words}"))
    assert found.error.text.startswith("G12 line 3: a helix of radius 0.00")
    assert found.error.text.endswith(", or [G12] ENTRY = plunge") and len(found.error.text) < 256
    assert all(move.kind == "rapid" for move in found.moves)
    value = float(re.search(f"the most is 1000: {fits}", found.error.text)[1])
    depth = value - 0.1
    better = f"I.5 Z-{depth} D1" if "down" in fits else re.sub(r"I\S+", f"I{value}", words)
    assert falling(pocket(mill, f"G12 {better}")[0])


def test_a_ring_about_the_centre_is_told(mill):
    good, large = (pocket(mill, f"G12 I{i} K1.5 Q.5 Z-.1 D1")[1] for i in (0.97, 0.98))
    assert not good.messages
    assert large.messages[0].text.strip() == (
        "G12: I0.98 is greater than 1.95 x the tool diameter 0.5: a ring is left about the centre"
    )
