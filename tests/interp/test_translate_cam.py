# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs as six stock posts write them: on an installed lathe they cut their drawing."""

from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from g12.tools.commands import main
from g12.tools.preview.tracer import Tracer
from support.cam_parts import PARTS, points_of
from support.contour_geometry import FROM_COLUMNS, distances
from support.foreign_programs import FOREIGN, translation
from support.sim_machines import copy_of_machines

CAM = FOREIGN / "cam"
POSTED = sorted((p.parent.name, p.stem) for p in CAM.glob("*/*.nc") if p.stem in PARTS)
CUTTERS = {"mm": {1: 12.0, 2: 10.0, 3: 6.0}, "inch": {1: 12 / 25.4, 2: 10 / 25.4, 3: 6 / 25.4}}
TOLERANCE = 0.008  # mm: POLAR_TOLERANCE, and the last digit of the posts
DEEPEST_RAPID = 0.9  # mm: what is below is cut
TOP = 10.0  # mm: no part has anything above
SOME = 3  # one of so many points, 0.1 to 0.2 mm apart, is looked at
BAR = 20.5  # mm, its radius and a little
FACE_HOLES = [(12, 30, -8), (12, 150, -8), (5, 270, -8), (15, 0, -12), (15, 90, -12)]
SIDE_HOLES = [(15, 45, -10), (15, 135, -10), (15, 225, -20)]
FEEDS = {3: 120, 2: 100, 1: 90}  # mm/min, by tool
HOME = {
    "mm": ["G21 G7 G90", "G0 Z400", "G0 X300", "G0 C0"],
    "inch": ["G20 G7 G90", "G0 Z10", "G0 X10", "G0 C0"],
}


class DrilledWay(NamedTuple):
    """A move at feed into the part, and where it ends: radius, angle, Z."""

    tool: int
    feed: float
    end: tuple


@pytest.fixture(scope="module")
def lathe(tmp_path_factory):
    """Return a function: the Tracer of a lathe on which a control's programs were installed."""
    machines = copy_of_machines(tmp_path_factory.mktemp("lathes"))

    @cache
    def installed(control):
        unit = "inch" if control == "haas-lathe" else "mm"
        ini = machines / f"{control}.ini"
        text = (machines / f"lathe_{unit}.ini").read_text()
        ini.write_text(text.replace("[FILTER]\n", "[OLD_FILTER]\n"))
        assert main.main(["install", str(ini), "--with", "polar", f"programs-{control}"]) == 0
        return Tracer(ini, tools=CUTTERS[unit])

    yield installed


@pytest.mark.parametrize(("post", "part"), POSTED)
def test_a_posted_program_cuts_its_drawing(lathe, post, part):
    moves = moves_of(lathe(post), post, part)
    made, expected = on_the_part(moves), wanted_path(PARTS[part])
    assert distances(made[made[:, 2] < DEEPEST_RAPID][::SOME], expected).max() < TOLERANCE
    assert distances(expected[::SOME], made[made[:, 2] < TOP]).max() < TOLERANCE
    assert rapids_turn_above_the_part(moves)


def moves_of(tracer, post, part):
    """Return the moves of a posted program on an installed lathe."""
    home = HOME["inch" if post == "haas-lathe" else "mm"]
    text = translation(CAM / post / f"{part}.nc", post, "--ini", str(tracer.ini.path))
    traced = tracer.trace_text(text, setup=home, alone=True)
    assert traced.error is None, traced.error
    return traced.moves


def test_posted_holes_are_those_of_the_drawing(lathe):
    moves = moves_of(lathe("takisawa-lathe"), "takisawa-lathe", "holes")
    drilled = [hole_of(m) for m in moves if m.kind == "feed"]
    assert ends(hole for hole in drilled if hole.tool > 1) == near_to(FACE_HOLES)
    assert ends(hole for hole in drilled if hole.tool == 1) == near_to(SIDE_HOLES)
    assert all(hole.feed == pytest.approx(FEEDS[hole.tool], rel=1e-3) for hole in drilled)
    assert not [m for m in moves if turns_in_the_bar(m)]


def hole_of(move):
    """Return a feed move as a way into the part; C and the slide across it stand."""
    across = 0 if move.tool > 1 else 2
    assert (move.start[across], move.start[5]) == (move.end[across], move.end[5]), move
    return DrilledWay(move.tool, move.feed, (move.end[0], move.end[5] % 360, move.end[2]))


def ends(ways):
    """Return where the deepest of the ways at each place end: radius, angle, Z."""
    deepest = {}
    for tool, _, (x, c, z) in ways:
        place = (round(x, 2), round(c), tool) if tool > 1 else (round(z, 2), round(c), tool)
        deepest[place] = min(deepest.get(place, (x, c, z)), (x, c, z))
    return sorted(deepest.values())


def near_to(holes):
    return [pytest.approx(hole, abs=0.002) for hole in sorted(holes)]


def turns_in_the_bar(move):
    """Tell whether C or both slides move by rapid where the bar or a hole's wall is."""
    moved = [a != b for a, b in zip(move.start, move.end)]
    inside = [end[2] < DEEPEST_RAPID and end[0] < BAR for end in (move.start, move.end)]
    return move.kind == "rapid" and any(inside) and (moved[5] or (moved[0] and moved[2]))


def rapids_turn_above_the_part(moves):
    rapids = [m for m in moves if m.kind == "rapid"]
    turning = [m for m in rapids if m.start[:1] + m.start[5:6] != m.end[:1] + m.end[5:6]]
    return all(min(m.start[2], m.end[2]) > DEEPEST_RAPID for m in turning)


def on_the_part(moves):
    """Return points of the tool's way over the part, X and C as LinuxCNC goes them."""
    legs = []
    for m in moves:
        start, end = (np.array([e[0], e[2], e[5]]) for e in (m.start, m.end))
        length = np.hypot(*(end - start)[:2]) + np.radians(abs(end[2] - start[2])) * end[0]
        share = np.linspace(0, 1, max(2, int(np.ceil(length / 0.1))))
        legs.append(start + (end - start) * share[:, None])
    x, z, c = np.concatenate(legs).T
    return np.column_stack([x * np.cos(np.radians(c)), x * np.sin(np.radians(c)), z])


def wanted_path(part):
    """Return points along what the drawing has the tool's centre cut."""
    if part.side == 40:
        return points_of(part)
    entry = points_of(part._replace(path=part.path[: part.lead]))
    contour = compensated(part)
    level = np.full(len(contour), part.path[part.lead][3])
    path = np.column_stack([contour.real, contour.imag, level])
    leave = points_of(part._replace(path=(("line", *path[-1]), *part.path[-2:])))
    return np.concatenate([entry, path, leave])


def compensated(part):
    """Return the centre of a cutter that follows the contour on the left, round its corners."""
    contour = points_of(part._replace(path=part.path[part.lead : -2]))[:, :2] @ FROM_COLUMNS
    contour = contour[np.append(True, abs(np.diff(contour)) > 1e-9)]
    along = np.diff(contour)
    beside = 1j * CUTTERS["mm"][part.tool] / 2 * along / abs(along)
    turned = (beside[1:] / beside[:-1])[:, None] ** np.linspace(0, 1, 30)
    corners = contour[1:-1, None] + beside[:-1, None] * turned
    return np.array([contour[0] + beside[0], *corners.ravel(), contour[-1] + beside[-1]])
