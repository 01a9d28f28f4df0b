# SPDX-License-Identifier: GPL-2.0-or-later
"""Random valid blocks of bore, thread and frame, and what they must cut, from their words alone.

``chance`` is a `random.Random`. Lengths are mm, in the blocks those of their units.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
import pytest
from shapely.geometry import LineString, box
from shapely.ops import unary_union

from support import cut_geometry

TOOLS = {1: 6.0, 2: 10.0, 3: 3.2, 4: 16.0}
INCH = 25.4
LEAD, RADIUS, CONE, ANGLE = 1e-3, 5e-4, 2e-3, 0.01  # mm, degrees
STEEPEST = math.tan(math.radians(3)) * 2 * math.pi


class Block(NamedTuple):
    """A block with its words as the machine reads them; ``before`` are the lines before it."""

    code: str
    words: dict
    before: tuple
    text: str
    start: tuple
    cutter: float

    def __getattr__(self, letter):
        return self.words.get(letter, 0.0)

    @property
    def hand(self):
        return 1 if self.code.startswith("G13") else -1


def written(chance, code, words, start, diameter):
    """Return a block in units and distance mode by chance, its words rounded as written."""
    unit = chance.choice((1.0, INCH))
    incremental, shuffled = chance.random() < 0.4, list(words)
    chance.shuffle(shuffled)
    whole = {"H", "L", "D"} | ({"J"} if code.endswith(".6") else set())
    shown, read = [], {}
    for letter in sorted(shuffled, key="R".__ne__):  # under G91 Z counts from R as written
        value = words[letter]
        if letter in whole:
            shown.append(f"{letter}{value}")
            read[letter] = value
            continue
        scale = 1.0 if letter == "E" and code.endswith(".6") else unit
        base = {"X": start[0], "Y": start[1], "R": start[2]}.get(letter, 0.0) * incremental
        if code.endswith(".7") and letter == "R":
            base = 0.0
        if letter == "Z" and incremental:
            base = read.get("R", start[2]) if not code.endswith(".7") else start[2]
        given = round((value - base) / scale, 6)
        shown.append(f"{letter}{given:.6f}")
        read[letter] = given * scale + base
    at = " ".join(f"{axis}{value / unit:.9f}" for axis, value in zip("XYZ", start))
    modes = f"{'G21' if unit == 1.0 else 'G20'} G17 G40 G90 G94 G64 P{0.01 / unit:.6f}"
    before = (modes, f"G0 {at} F{300 / unit}", "G91" if incremental else "G90")
    return Block(code, read, before, f"{code} {' '.join(shown)}", start, diameter / 2)


def place(chance):
    words = {"Z": -chance.uniform(3, 25)}
    start = (chance.uniform(-40, 40), chance.uniform(-40, 40), chance.uniform(0.5, 9))
    if chance.random() < 0.7:
        words |= {"X": chance.uniform(-40, 40), "Y": chance.uniform(-40, 40)}
    tool = chance.choice(list(TOOLS))
    return words | {"D": tool}, start, TOOLS[tool]


def bore(chance):
    words, start, diameter = place(chance)
    top = chance.choice((None, 0.0, chance.uniform(-1.5, 0.4)))
    if top is not None:
        words["R"] = top
    radius = diameter / 2
    kind = chance.choice(("full", "open", "many"))
    wall = radius * (chance.uniform(1.1, 1.95) if kind == "full" else chance.uniform(2.1, 6))
    words["I"] = wall
    first = 0.9 * radius if kind == "many" else wall - radius
    if kind == "many":
        words["Q"] = chance.uniform(0.2, 1.5) * radius
        first = min(0.9 * radius, wall - radius)
    if kind == "open":
        words["K"] = wall - chance.uniform(0.02, 0.9) * radius
    steep = kind == "open" and words["K"] > 2 * radius + 0.01
    words["P"] = chance.uniform(0.2, 0.99) * (2.0 if steep else STEEPEST * first)
    if chance.random() < 0.4:
        words["L"] = chance.randint(0, 3)
    return written(chance, chance.choice(("G12.5", "G13.5")), words, start, diameter)


def thread(chance):
    words, start, diameter = place(chance)
    radius, pitch = diameter / 2, chance.uniform(0.3, 1.9)
    if chance.random() < 0.7:
        words["R"] = chance.uniform(-0.5, 0.4)
    outside, taper = chance.random() < 0.4, chance.random() < 0.3
    if taper:
        tapers = ((0.01, 0.2), (0.5, 1.0), (-0.1, -0.01))
        words["E"] = chance.choice((1 / 16, *(chance.uniform(*each) for each in tapers)))
    narrower = max(0.0, words.get("E", 0.0)) / 2 * 27
    if outside:
        words |= {"I": narrower + 2 * pitch + chance.uniform(1, 20), "H": 1}
    else:
        words["I"] = radius + narrower + 1.3 * pitch + chance.uniform(0.1, 15)
    if chance.random() < 0.5:
        words["K"] = words["I"] - chance.uniform(0.4, 0.8) * pitch
    if chance.random() < 0.4:
        words["Q"] = chance.uniform(0.1, 0.7) * pitch
    if chance.random() < 0.3:
        words["L"] = chance.randint(1, 2)
    if chance.random() < 0.4:
        words["J"] = chance.randint(1, 6)
    words["P"] = pitch * chance.choice((1, -1))
    return written(chance, chance.choice(("G12.6", "G13.6")), words, start, diameter)


def frame(chance):
    words, start, diameter = place(chance)
    radius = diameter / 2
    kind = chance.randint(0, 2)
    words["H"] = kind
    if chance.random() < 0.5:
        words["E"] = chance.uniform(0.05, 0.4)
    least = 2 * radius + 2 * words.get("E", 0.0) + 0.1
    words |= {letter: least + chance.uniform(0.1, 60) for letter in "IJ"}
    largest = min(words["I"], words["J"]) / 2
    low = 0.0 if kind == 2 else radius + 1e-4
    words["R"] = chance.choice((low, chance.uniform(low, largest), largest - 1e-4))
    if chance.random() < 0.6:
        words["K"] = chance.uniform(1.0, 6)
    if kind == 0 and chance.random() < 0.7:
        words["Q"] = chance.uniform(0.3, 1.3) * radius
    if chance.random() < 0.5:
        words["P"] = chance.uniform(50, 200)
    return written(chance, chance.choice(("G12.7", "G13.7")), words, start, diameter)


near = functools.partial(pytest.approx, abs=1e-6)
MAKERS = {"bore": bore, "thread": thread, "frame": frame}


# ---------------------------------------------------------------- what must be cut


def centre_of(block):
    return complex(block.words.get("X", block.start[0]), block.words.get("Y", block.start[1]))


def sampled(move, count=40):
    """Return points of a move in the plane, and their Z."""
    count = count * max(1, abs(move.turns)) if move.kind == "arc" else 2
    points = cut_geometry.points_at(move, np.linspace(0, 1, count + 1))
    return points[:, 0] + 1j * points[:, 1], points[:, 2]


def check_ends(block, moves):
    """Check that the tool ends in the centre at the Z where the block began, and its depth."""
    end = moves[-1].end
    assert abs(complex(*end[:2]) - centre_of(block)) < 1e-6
    assert abs(end[2] - block.start[2]) < 1e-6
    lowest = min(move.end[2] for move in moves)
    assert abs(lowest - block.Z) < 1e-6


def turned(before, after, flat):
    """Return the corner between two moves in degrees, in the plane or in space."""
    one, other = cut_geometry.tangent(before, 1.0), cut_geometry.tangent(after, 0.0)
    if flat:
        one, other = (np.array([*each[:2], 0.0]) / np.hypot(*each[:2]) for each in (one, other))
    return math.degrees(2 * math.asin(min(1.0, np.linalg.norm(one - other) / 2)))


def lead_of(move, centre):
    """Return the fall or rise per turn, positive right-hand, and the way round of an arc."""
    at, z = sampled(move, 90)
    angle = np.unwrap(np.angle(at - centre))
    return 2 * math.pi * (z[-1] - z[0]) / (angle[-1] - angle[0]), np.sign(angle[-1] - angle[0])


def check_bore(block, moves):
    check_ends(block, moves)
    centre, last = centre_of(block), block.I - block.cutter
    top = block.words.get("R", block.start[2])
    arcs = [move for move in moves if move.kind == "arc"]
    radii, previous = [], None
    for onto, helix, floor, off in zip(*(arcs[n::4] for n in range(4))):
        assert abs(abs(lead_of(helix, centre)[0]) - block.P) < LEAD
        assert all(lead_of(each, centre)[1] == block.hand for each in (helix, floor))
        for each in (helix, floor):
            away = np.abs(sampled(each)[0] - centre)
            assert np.ptp(away) < 2 * RADIUS
        radii.append(away[0])
        assert helix.start[2] == near(top) and floor.start[2] == near(block.Z)
        assert abs(floor.end[2] - block.Z) < 1e-6 and abs(off.end[2] - block.Z) < 1e-6
        assert turned(onto, helix, True) < ANGLE and turned(floor, off, True) < ANGLE
        assert abs(complex(*onto.start[:2]) - centre) < 1e-6
        previous = floor
    assert abs(radii[-1] - last) < RADIUS
    assert abs(previous.turns) == 1 + block.L
    if block.Q:
        grown = np.diff(radii)
        assert (grown > 0).all() and (grown < block.Q + RADIUS).all()
        assert radii[0] < block.cutter or radii[0] - block.cutter < block.K + RADIUS
    else:
        assert len(radii) == 1
    for move in moves:
        at, z = sampled(move)
        assert (np.abs(at - centre) < last + RADIUS).all() or z.min() > top - 1e-6
        assert move.kind != "rapid" or (np.abs(at - centre)[z < top - 1e-6] < 1e-6).all()
        falls = move.kind == "rapid" and move.end[2] < move.start[2]
        assert not falls or move.end[2] > min(block.start[2], top + 1) - 1e-6


def check_thread(block, moves):
    check_ends(block, moves)
    centre, outside = centre_of(block), block.H == 1
    top, pitch = block.words.get("R", block.start[2]), block.P
    depth = (5 / 8 if not outside else 17 / 24) * math.sqrt(3) / 2 * abs(pitch)
    small = block.words.get("K", block.I - depth)
    tolerance = CONE if block.E else RADIUS
    side = 1 if outside else -1

    def centre_radius(z, infeed):
        finished = small if outside else block.I
        return finished - block.E / 2 * (top - z) + side * (block.cutter + infeed)

    feeds = [k for k, move in enumerate(moves) if move.kind == "arc"]
    runs = np.split(feeds, np.flatnonzero(np.diff(feeds) > 1) + 1)
    assert all(moves[k].kind != "feed" for k in range(len(moves)))
    infeeds, lowest, highest, phases = [], [], [], []
    up = (pitch > 0) == (block.hand > 0)
    for run in runs:
        onto, *helix, off = (moves[k] for k in run)
        at, z = (np.concatenate(each) for each in zip(*map(sampled, helix)))
        at -= centre
        angle = np.unwrap(np.angle(at))
        assert (np.diff(angle) * block.hand > -1e-9).all() and (z[-1] > z[0]) == up
        phase = z - pitch * angle / (2 * math.pi)
        assert np.ptp(phase) < LEAD
        phases.append(phase[0])
        infeed = side * (abs(at[0]) - centre_radius(z[0], 0.0))
        assert (np.abs(np.abs(at) - centre_radius(z, infeed)) < tolerance).all()
        infeeds.append(infeed)
        lowest.append(z.min())
        highest.append(z.max())
        assert turned(onto, helix[0], False) < ANGLE and turned(helix[-1], off, False) < ANGLE
        assert len(helix) == 1 or max(map(turned, helix, helix[1:], [True] * len(helix))) < 0.5
        for lead in (onto, off):
            at, z = sampled(lead)
            assert (side * (np.abs(at - centre) - centre_radius(z, infeed)) > -tolerance).all()
            assert z.min() > block.Z - 1e-6
    turn = np.exp(2j * math.pi * (np.array(phases) - phases[0]) / pitch)
    assert np.abs(turn - 1).max() * abs(pitch) < LEAD * 2 * math.pi  # one groove
    infeeds = np.array(infeeds)
    assert abs(infeeds[-1]) < tolerance and (np.diff(infeeds) < tolerance).all()
    steps = -np.diff(infeeds)
    assert block.Q or np.abs(infeeds).max() < tolerance
    assert (steps < (block.Q or 1e9) + tolerance).all()
    assert infeeds[0] + (block.Q or 1e9) > block.I - small - tolerance
    teeth = int(block.words.get("J", 1))
    passes = sum(steps > tolerance) + 1 + int(block.L)
    assert len(runs) % passes == 0
    share = abs(pitch) / 4 if not outside else abs(pitch)
    assert min(lowest) <= block.Z + share + 1e-6
    reached = max(highest) + (teeth - 1) * abs(pitch)
    assert top - 1e-6 <= reached < top + abs(pitch) * (teeth if len(runs) == passes else 1) + 1e-6
    if teeth > 1:  # from run to run no pitch is left out
        ordered = sorted({round(z, 6) for z in lowest})
        assert (np.diff(ordered) < teeth * abs(pitch) + LEAD).all()
        assert all(abs(h - low - abs(pitch)) < LEAD for h, low in zip(highest, lowest))
    fits_in_hole = small - max(0.0, block.E / 2) * (top - block.Z) - block.cutter
    for move in moves:
        if move.kind == "rapid":
            at, z = sampled(move)
            away = np.abs(at - centre)[z < top - 1e-6]
            assert ((away > block.I + block.cutter) if outside else (away < fits_in_hole)).all()


def rectangle(block, by=0.0):
    """Return the finished rectangle, or the tool centre's beside it."""
    half_i, half_j, corner = block.I / 2, block.J / 2, block.R
    at = centre_of(block)
    inner = box(at.real - half_i + corner, at.imag - half_j + corner,
                at.real + half_i - corner, at.imag + half_j - corner)  # fmt: skip
    grown = corner + by
    return inner.buffer(grown, 256) if grown > 1e-9 else inner


def check_frame(block, moves):
    check_ends(block, moves)
    outside, radius = block.H == 2, block.cutter
    wall = rectangle(block)
    finished = rectangle(block, radius if outside else -radius)
    levels = {}
    for move in moves:
        at, z = sampled(move, 200)
        line = LineString(np.stack([at.real, at.imag], axis=1))
        low = z < block.start[2] - 1e-6
        if low.any() and line.length > 1e-9:
            assert move.kind != "rapid" or np.ptp(at) < 1e-6 or z.min() > block.start[2] - 1e-6 or (
                z.min() >= min(levels, default=1e9) + 0.9)  # fmt: skip
        if move.kind != "rapid" and np.ptp(z) < 1e-9 and line.length > 1e-9:
            levels.setdefault(round(z[0], 5), []).append(line)
        if low.any() and line.length > 1e-9:
            beyond = finished.buffer(-RADIUS) if outside else finished.buffer(RADIUS)
            assert not line.intersects(beyond) if outside else beyond.covers(line)
    rises = [move.end[2] - move.start[2] for move in moves if move.end[2] > move.start[2] + 1e-6]
    assert max(rises[:-1], default=0.0) < 1 + 1e-6  # between the levels
    assert max(move.end[2] for move in moves) < block.start[2] + 1e-6
    for move in moves:
        fall = move.start[2] - move.end[2]
        if move.kind != "rapid" and move.length > 1e-6:
            due = block.words.get("P", 300.0) if fall > 1e-6 else 300.0
            assert abs(move.feed - due) < 1e-3
        if move.kind == "arc":
            assert fall <= math.tan(math.radians(3)) * move.length * (1 + 1e-6)
    step = block.words.get("K", 1e9)
    heights = [block.start[2], *sorted(levels, reverse=True)]
    assert (-np.diff(heights) < step + 1e-5).all() and abs(heights[-1] - block.Z) < 1e-5
    for number, (_, lines) in enumerate(sorted(levels.items(), reverse=True)):
        last = number == len(levels) - 1
        allowance = 0.0 if last else block.E
        swept = unary_union([line.buffer(radius, 64) for line in lines])
        due = rectangle(block, allowance if outside else -allowance)
        if not outside:  # what the cutter can reach of its corners
            due = due.buffer(-radius + 1e-9, 256).buffer(radius, 256)
        band = due.boundary.buffer(0.5 * radius, 64)
        if block.H == 0:
            left = due.difference(swept)
        else:
            left = (band.difference(due) if outside else band.intersection(due)).difference(swept)
        assert left.buffer(-0.005).is_empty, left.area
        over = swept.intersection(wall) if outside else swept.difference(wall)
        assert over.buffer(-RADIUS).is_empty


CHECKS = {"bore": check_bore, "thread": check_thread, "frame": check_frame}
