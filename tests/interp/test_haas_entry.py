# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 with [G12] ENTRY = helix on the stock interpreter: down along a helix, nothing stands.

Geometry from the moves alone, by numpy and shapely.
"""

import math
import re
from itertools import product

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.sim_machines import SIM

TOOL = 0.5
UNITS = {"G20": ("mill_inch", 1.0), "G21": ("mill_mm", 25.4)}
ANGLE = 3.0
SMOOTH = 1.0  # degrees


def tracer(unit, clearing, **more):
    machine, scale = UNITS[unit]
    overrides = {"CLEARING": clearing, "ENTRY": "helix", **more}
    return Tracer(
        SIM / f"{machine}.ini",
        tools={1: TOOL * scale, 2: 0.2 * scale},
        overrides={"G12": {key: str(value) for key, value in overrides.items()}},
    )


@pytest.fixture(scope="module")
def machines():
    opened = {}
    for unit, clearing in product(UNITS, ("rings", "spiral")):
        opened[unit, clearing] = tracer(unit, clearing)
    yield opened
    for machine in opened.values():
        machine.close()


def program(code, words, *, unit="G20", distance="G90"):
    """Return a program that cuts a pocket about X1 Y2 from Z.1; numbers are in inches."""
    scale = UNITS[unit][1]
    numbers = {word[0]: float(word[1:]) for word in words.split()}
    scaled = " ".join(
        f"{letter}{value if letter in 'LD' else value * scale:.10g}"
        for letter, value in numbers.items()
    )
    first = f"{unit} G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F{10 * scale}"
    return [first, f"G0 X{scale} Y{2 * scale} Z{0.1 * scale}", f"{distance} {code} {scaled}", "M2"]


def traced(machine, lines):
    found = machine.trace_text(lines)
    assert found.error is None, found.error
    return found


def pocket(machine, *arguments, **options):
    """Return the moves of a pocket, from the first at its feed on."""
    found = traced(machine, program(*arguments, **options))
    return [move for move in found.moves if move.kind != "rapid"], found


def falling(moves):
    return [move for move in moves if move.start[2] - move.end[2] > 1e-9]


def corner(before, after):
    one, other = np.array(before.tangent(1.0)), np.array(after.tangent(0.0))
    return math.degrees(math.atan2(np.linalg.norm(np.cross(one, other)), one @ other))


WORDS = [
    "I.75 Z-.6 D1",  # the helix is smaller than the ring
    "I.4 Z-.6 D1",  # the ring itself
    "I.4 K2 Q.4 Z-.55 D1 L3",
    "I.3 K1.31 Q.25 Z-.01 D1",  # less deep than the last half turns
    "I.3 K.9 Q.3 Z-.5 D0",
]


@pytest.mark.parametrize("words", WORDS)
@pytest.mark.parametrize("distance", ["G90", "G91"])
@pytest.mark.parametrize(("unit", "clearing", "code"), [
    ("G20", "rings", "G12"), ("G21", "rings", "G13"), ("G20", "spiral", "G13"),
    ("G21", "spiral", "G12"),
])  # fmt: skip
def test_down_along_a_helix_and_nothing_stands(machines, unit, clearing, code, distance, words):
    moves, found = pocket(machines[unit, clearing], code, words, unit=unit, distance=distance)
    inches = {word[0]: float(word[1:]) for word in words.split()}
    cutter = TOOL / 2 * 25.4 if inches["D"] else 0.0
    first = inches["I"] * 25.4 - cutter
    helix = min(first, 0.9 * cutter) if cutter else first
    centre = np.array([25.4, 50.8])
    down = falling(moves)
    turn = {"G12": -1, "G13": 1}[code]
    for move in down:
        assert move.kind == "arc" and math.copysign(1, move.turns) == turn
        points = cut_geometry.dense_points([move])[:, :2]
        assert np.hypot(*(points - centre).T) == pytest.approx(helix, abs=1e-6)
        slope = (move.start[2] - move.end[2]) / move.length
        assert 0 < math.degrees(math.asin(slope)) <= ANGLE + 1e-9
    for before, after in zip(moves, moves[1:]):
        entry = after in down and before not in down
        assert corner(before, after) <= (ANGLE + 1e-6 if entry else SMOOTH)
    levels = int(inches.get("L", 1))
    heights = [0.1 + inches["Z"] * (k + 1) for k in range(levels)]
    if distance == "G90":
        heights = [inches["Z"]] * levels
    reached = [move.end[2] for move in moves if math.dist(move.start, move.end) < 1e-9]
    assert sorted({round(z, 6) for z in reached}, reverse=True) == pytest.approx(
        [25.4 * z for z in dict.fromkeys(heights)]
    )
    assert moves[-1].end[:3] == pytest.approx((*centre, 25.4 * heights[-1]))
    finished = inches.get("K", inches["I"]) * 25.4
    for move in moves:
        points = cut_geometry.dense_points([move])[:, :2]
        assert np.hypot(*(points - centre).T).max() <= finished - cutter + 1e-6
    if inches["D"]:
        floor = [move for move in moves if abs(move.start[2] - 25.4 * heights[-1]) < 1e-6]
        area = cut_geometry.swept(floor, cutter)
        wanted = cut_geometry.disc(*centre, finished)
        assert wanted.buffer(-0.001 * 25.4).difference(area).area == pytest.approx(0, abs=0.02)
    assert not found.messages


def test_a_pocket_that_needs_no_way_down_has_no_helix(machines):
    moves, _ = pocket(machines["G20", "rings"], "G12", "I.75 D1")
    assert not falling(moves)
    up, found = pocket(machines["G20", "rings"], "G12", "I.75 Z.5 D1")
    assert not falling(up) and "lost its minus sign" in found.messages[0].text


def test_half_of_the_feed_down_and_all_of_it_elsewhere():
    with tracer("G21", "rings", PLUNGE_FEED=50) as machine:
        found = traced(machine, program("G13", "I.4 K.8 Q.2 Z-.3 D1", unit="G21"))
        moves = [move for move in found.moves if move.kind != "rapid"]
    assert {move.feed for move in falling(moves)} == {127.0}
    assert {move.feed for move in moves if move not in falling(moves)} == {254.0}
    assert found.modes.feed == pytest.approx(254.0)


def test_a_slow_plunge_however_little_a_revolution_feeds():
    feed = 0.00015  # LinuxCNC's EQ takes numbers 0.0001 apart for equal
    with tracer("G20", "rings", ENTRY="plunge", PLUNGE_FEED=50) as machine:
        first, *lines = program("G13", "I.4 Z-.3 D1")
        found = traced(machine, [first, f"G95 S1000 F{feed}", *lines])
    moves = [move for move in found.moves if move.kind != "rapid"]
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
def test_a_helix_that_hardly_comes_down_is_refused_and_told_what_fits(machines, words, fits):
    machine = machines["G20", "rings"]
    found = machine.trace_text(program("G12", words))
    assert found.error.text.startswith("G12 line 3: a helix of radius 0.00")
    assert found.error.text.endswith(", or [G12] ENTRY = plunge") and len(found.error.text) < 256
    assert all(move.kind == "rapid" for move in found.moves)
    value = float(re.search(f"the most is 1000: {fits}", found.error.text)[1])
    depth = value - 0.1
    better = f"I.5 Z-{depth} D1" if "down" in fits else re.sub(r"I\S+", f"I{value}", words)
    assert falling(pocket(machine, "G12", better)[0])


def test_a_ring_about_the_centre_is_told(machines):
    words = "I{} K1.5 Q.5 Z-.1 D1"
    _, good = pocket(machines["G20", "rings"], "G12", words.format(0.97))
    _, large = pocket(machines["G20", "rings"], "G12", words.format(0.98))
    assert not good.messages
    assert large.messages[0].text.strip() == (
        "G12: I0.98 is greater than 1.95 x the tool diameter 0.5: a ring is left about the centre"
    )
