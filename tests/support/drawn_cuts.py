# SPDX-License-Identifier: GPL-2.0-or-later
"""What pockets and events have to cut, by the page of each code, and whether they did.

It shares nothing with the planners. Of a report it takes what LinuxCNC knew: words, position, modes
and frame. Lengths are mm; the plane of a pocket is seen from its centre, levels are measured from
the tool before the block.
"""

import cmath
import math
from collections import Counter
from itertools import groupby, pairwise

import numpy as np
import pytest

from g12.cut_report import EventCut
from g12.request import LEFT_OUT
from g12.tools.path.part import arc_points, plane_axes

NEAR = 1e-4  # mm, of a pocket's toolpath
SAME = 1e-5  # relative: a trace prints feeds with nine decimals
STRAIGHT = 1e-3  # radians of a corner
NARROWER = 0.254  # of an event's pocket: rings without J
ENTRIES = {"I": "W", "E": "O", "Q": "L", "H": "C", **{name: name for name in "XYZRKJPDF"}}
TURNS = {"G12": (-1, -1), "G13": (1, 1)}
EVENT_TURNS = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # rough, finish; by D


class Stroke:
    """A move of a pocket in its plane: its ends and middle, their levels, how it turns."""

    def __init__(self, move, origin, axes):
        shares = np.linspace(0.0, 1.0, 25)
        if move.kind == "arc":
            positions = arc_points(move, shares)[:, :3]
        else:
            positions = np.outer(1 - shares, move.start[:3]) + np.outer(shares, move.end[:3])
        across = (positions - origin) @ axes.T
        self.points, self.levels = across[:, 0] + 1j * across[:, 1], across[:, 2]
        self.start, self.end, self.move = self.points[0], self.points[-1], move
        self.turn = math.copysign(1, move.sweep) if move.kind == "arc" else 0
        self.is_half = bool(self.turn) and abs(abs(move.sweep) - math.pi) < STRAIGHT
        self.is_rapid, self.feed = move.kind == "rapid", (move.feed, move.feed_mode)
        self.is_level = abs(self.levels[-1] - self.levels[0]) < NEAR
        centre = move.centre and axes[:2] @ (np.array(move.centre) - origin)
        is_round = centre is not None and math.hypot(*centre) < NEAR and self.is_level
        self.circle = abs(self.start) if is_round and abs(self.end - self.start) < NEAR else None


class Pocket:
    """A pocket or an event as it was cut, and what its block commands."""

    def __init__(self, cut, trace, ini):
        self.report = report = cut.report
        self.mm, self.machine_mm, self.settings = report.frame.mm, ini.mm, ini.settings
        self.words, self.feed = report.words, report.feed * report.frame.mm
        x, y, z, _ = report.at
        given = [report.words.get(letter) for letter in "XY"]
        if report.incremental:
            x, y = (here + (word or 0.0) for here, word in zip((x, y), given))
        else:
            x, y = (here if word is None else word for here, word in zip((x, y), given))
        there = report.frame.point(x, y)
        origin = np.array([there.real, there.imag, report.frame.level(z)])
        moves = [move for move in trace.moves[cut.at : cut.end] if move.length > NEAR / 100]
        axes = plane_axes(moves[0])
        self.strokes = [Stroke(move, origin, axes) for move in moves]
        table = trace.table_at(cut.at).diameters
        loaded = isinstance(report.cut, EventCut)
        self.cutter = trace.radius(cut.at) if loaded else table.get(self.words.get("D"), 0.0) / 2
        for one, other in pairwise(moves):
            assert one.end[:3] == pytest.approx(other.start[:3], abs=NEAR), self.report.line

    def length(self, letter, default=0.0):
        return self.words[letter] * self.mm if letter in self.words else default

    @property
    def circles(self):
        return [stroke for stroke in self.strokes if stroke.circle is not None]

    def check_walls(self, radius, levels, turn):
        """Compare the levels of the circles of a radius, beyond which nothing goes at a feed."""
        walls = [one for one in self.circles if one.circle == pytest.approx(radius, abs=NEAR)]
        found = Counter(round(one.levels[0], 3) for one in walls)
        assert found == Counter(round(level, 3) for level in levels), self.report.line
        fed = [stroke for stroke in self.strokes if not stroke.is_rapid]
        assert max(abs(one.points).max() for one in fed) < radius + NEAR, self.report.line
        assert {one.turn for one in self.strokes if one.turn} == {turn}, self.report.line

    def check_feeds(self, feed, down=None, mode=None):
        """Compare the feed of the moves, ``down`` of those that go down."""
        mode = mode or ("G95" if self.report.per_revolution else "G94")
        for one in self.strokes:
            falls = one.levels[-1] < one.levels[0] - NEAR
            wanted = down if falls and down else feed
            if not one.is_rapid:
                assert one.feed == (pytest.approx(wanted, rel=SAME), mode), self.report.line

    def check_smooth(self):
        """Find no corner between moves at one level."""
        for one, other in pairwise(stroke for stroke in self.strokes if not stroke.is_rapid):
            if one.is_level and other.is_level:
                turned = cmath.phase((other.points[1] - other.start) / (one.end - one.points[-2]))
                bends = sum(abs(each.move.sweep) / 48 for each in (one, other) if each.turn)
                assert abs(turned) < bends + STRAIGHT, self.report.line

    def check_growth(self, step, first):
        """Find no circle or half turn of a spiral that is too far out of the last."""
        spiral = any(
            one.is_half and abs(one.end) > abs(one.start) > first - NEAR for one in self.strokes
        )
        for _, rings in groupby(self.circles, key=lambda one: round(one.levels[0], 3)):
            radii = [one.circle for one in rings if one.circle > first - NEAR]
            assert spiral or all(b - a < step + NEAR for a, b in pairwise(radii)), self.report.line
        halves = [one for one in self.strokes if one.is_half and one.is_level]
        grown = [abs(one.end) - abs(one.start) for one in halves if abs(one.start) > first - NEAR]
        assert max(grown, default=0.0) < step / 2 + NEAR, self.report.line


def check_haas(pocket):
    words, settings = pocket.words, pocket.settings
    first, step = pocket.length("I") - pocket.cutter, pocket.length("Q")
    last = pocket.length("K", pocket.length("I")) - pocket.cutter
    count, here = round(words.get("L", 1)), pocket.report.at[2] * pocket.mm
    depths = [
        pocket.length("Z") * (n + 1) if pocket.report.incremental else pocket.length("Z") - here
        for n in range(count)
    ]
    pocket.check_walls(last, depths, TURNS[pocket.report.code][0])
    pocket.check_feeds(pocket.feed, pocket.feed * settings.plunge_feed / 100)
    pocket.check_smooth()
    pocket.check_growth(step or last, first)
    radii = [one.circle for one in pocket.circles]
    assert first == pytest.approx(min(r for r in radii if r > first - NEAR), abs=NEAR)
    helix = [one for one in pocket.strokes if one.turn and not one.is_level]
    assert bool(helix) == (settings.entry == "helix")
    for one in helix:
        slope = (one.levels[0] - one.levels[-1]) / (math.pi * abs(one.start))
        assert slope < math.tan(math.radians(settings.entry_angle)) + SAME
    check_rapids(pocket, 0.0)
    assert abs(pocket.strokes[-1].end) < NEAR


def check_rapids(pocket, lowest):
    """Rapids are level, none is below a level."""
    for one in pocket.strokes:
        assert not one.is_rapid or min(one.levels) > lowest - NEAR, pocket.report.line


def check_yasnac(pocket):
    words, inward = pocket.words, math.copysign(pocket.cutter, pocket.words["I"])
    radius, bore = pocket.length("I") - inward, pocket.length("R") or pocket.length("J")
    approach, times = bore - inward if bore else 0.0, round(words.get("L", 1))
    first = pocket.length("K") - inward if "K" in words else radius
    traverse = pocket.settings.yasnac_traverse * pocket.machine_mm
    fast = [one for one in (pocket.strokes[0], pocket.strokes[-1]) if not one.turn]
    assert len(fast) == 2 * (abs(approach) > NEAR)
    for one in fast:
        assert max(abs(one.points)) == pytest.approx(abs(approach), abs=NEAR)
        assert one.is_rapid or one.feed == (pytest.approx(traverse), "G94")
    pocket.strokes = [one for one in pocket.strokes if one not in fast]
    assert all(one.turn for one in pocket.strokes), "a line beside the fast moves"
    pocket.check_walls(abs(radius), [0.0] * times, TURNS[pocket.report.code][0])
    pocket.check_feeds(pocket.feed)
    pocket.check_smooth()
    lead_in, lead_out = pocket.strokes[0], pocket.strokes[-1]
    assert (lead_in.start, lead_in.end) == pytest.approx((approach, first), abs=NEAR)
    assert (lead_out.start, lead_out.end) == pytest.approx((radius, approach), abs=NEAR)
    pocket.strokes = pocket.strokes[1:-1]
    pocket.check_growth(pocket.length("Q"), abs(first))


def check_mitsubishi(pocket):
    radius = abs(pocket.length("I")) - pocket.cutter
    pocket.check_walls(radius, [0.0], TURNS[pocket.report.code][0])
    pocket.check_feeds(pocket.feed)
    pocket.check_smooth()
    ends = [place for one in pocket.strokes for place in (one.start, one.end)]
    assert ends == pytest.approx([0, radius, radius, radius, radius, 0], abs=NEAR)


def entries_of(pocket):
    """Return the entries of an event by the control's letters, lengths in mm."""
    words, code = pocket.words, pocket.report.code
    if code == "circle_mill":
        given = {name: value for name, value in words.items() if value != LEFT_OUT}
    else:
        given = {ENTRIES[name]: words[name] for name in words if name in ENTRIES}
        given["G"] = 7.0 if code == "G13.2" else 0.0
        given["L"] = -given.get("L", 0.0) if words.get("L") == 0.0 else given.get("L", 0.0)
    return {name: value if name in "GDC" else value * pocket.mm for name, value in given.items()}


def check_event(pocket, planes):
    """Check an event; ``planes`` are W and O of the events before, which stay."""
    entries, here = entries_of(pocket), pocket.report.at[2] * pocket.mm
    planes |= {name: entries[name] for name in "WO" if name in entries}
    top, is_pocket, finish = planes["W"], entries.get("G") == 7.0, entries.get("L", 0.0)
    back = planes.get("O", top)
    bottom = entries["Z"] + (top if pocket.report.incremental else 0.0)
    turn, finish_turn = EVENT_TURNS[round(entries.get("D", 0.0))]
    side = {0: 0, 1: -turn, 2: turn}[round(entries["C"])]  # clockwise: left is outside
    final = entries["R"] + side * pocket.cutter
    rough, feed = final + side * abs(finish), entries.get("F", pocket.feed)
    start, strokes = pocket.strokes[0].start, pocket.strokes
    check_rapids(pocket, min(levels_of(entries, top, bottom, finish)) - here)
    finishing = strokes[len(strokes) - 5 : -2] if finish else []
    assert [one.turn for one in finishing[1:2]] == [finish_turn] * bool(finish)
    assert [one.circle for one in finishing[1:2]] == pytest.approx([final] * bool(finish))
    assert (strokes[-1].end, strokes[-1].levels[-1] + here) == pytest.approx((start, back))
    pocket.strokes = [one for one in strokes if one not in finishing]
    levels = [level - here for level in levels_of(entries, top, bottom, finish)]
    pocket.check_walls(rough, levels, turn)
    pocket.check_feeds(feed, entries.get("P", feed))
    if is_pocket:
        widest = entries.get("J", 2 * pocket.cutter - NARROWER)
        rings = max(1, math.ceil(rough / widest - SAME))
        assert len(pocket.circles) == rings * len(levels), pocket.report.line
        pocket.check_growth(widest, 0.0)
    pocket.strokes = finishing
    pocket.check_feeds(entries.get("V", feed))


def levels_of(entries, top, bottom, finish):
    """Return the levels of the passes, downward; a finish above 0 is for the bottom, too."""
    rough, peck = bottom + max(0.0, finish), entries.get("K")
    count = max(1, math.ceil((top - rough) / peck - SAME)) if peck else 1
    levels = [top - peck * n for n in range(1, count)] + [rough]
    return levels + [bottom] * (rough > bottom)


POCKETS = {"haas": check_haas, "yasnac": check_yasnac, "mitsubishi": check_mitsubishi}


def check_cuts(trace, ini, dialect):
    """Check every cut of a trace with reports."""
    planes = {}
    for cut in trace.cuts:
        if isinstance(cut.report.cut, EventCut):
            check_event(Pocket(cut, trace, ini), planes)
        else:
            POCKETS[dialect](Pocket(cut, trace, ini))
