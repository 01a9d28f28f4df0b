# SPDX-License-Identifier: GPL-2.0-or-later
"""Random valid programs: pockets and events by their pages, shapes by their drawings.

`support.drawn_cuts` reads the pages, the drawings are shapely's. Sections are compared with what
LinuxCNC itself makes of the same lines where a mill has X and Y. `verify`, the judge of users'
programs, has no finding in them. `make soak` tries the same kinds with other seeds.
"""

import random

import pytest
from shapely.affinity import rotate
from shapely.geometry import LineString
from shapely.ops import unary_union

from g12.tools.path.part import Part
from g12.tools.verify.judge import judge
from support import drawn_cuts
from support.flat_sections import FlatSections
from support.shape_geometry import area_off, disc, polygon, slot
from support.valid_programs import MACHINES, machine_of, valid_program

POCKETS, SECTIONS, SHAPES = 24, 8, 4  # in a program
SAME = 1e-4  # mm: words of inches have five decimals
WALL = 0.01  # mm of a shape's wall
SEGMENTS = 48  # of a quarter circle
SLIVER = 0.02  # mm², where drawings have chords


def count_of(kind):
    """Return how many pockets, sections or shapes a program of a kind gets."""
    if kind.startswith("shapes"):
        return SHAPES
    return SECTIONS if kind.startswith(("polar", "cylinder")) else POCKETS


def check_cuts(kind, folder, seed):
    """Judge the cuts of a random program; verify has no finding in it."""
    program, ini = folder / "valid.ngc", machine_of(kind)
    text = valid_program(kind, random.Random(seed), count_of(kind))
    program.write_text(text)
    judgement = judge(program, ini)
    trace = judgement.program.trace
    assert trace.error is None and len(trace.cuts) >= count_of(kind), seed
    if kind.startswith(("polar", "cylinder")):
        sections = FlatSections(text, "inch" if "inch" in kind else "mm", ini)
        for cut in trace.cuts:
            sections.check(cut, trace)
        assert not sections.blocks
    elif kind.startswith("shapes"):
        for cut in trace.cuts:
            check_shape(trace, cut, ini, diameters="\nG7" in text)
    else:
        drawn_cuts.check_cuts(trace, ini, kind.split()[0])
    assert [each.text() for each in judgement.found if each.severity == "finding"] == [], seed


@pytest.mark.parametrize("kind", MACHINES)
def test_a_valid_program_is_cut_as_its_words_ask(kind, tmp_path):
    check_cuts(kind, tmp_path, kind)


# ---------------------------------------------------------------- a shape as it is drawn


def check_shape(trace, cut, ini, diameters):
    """Compare what is left, or cut out, at the last depth with the drawing of a call."""
    words, unit, zero = cut.report.words, cut.report.frame.mm, cut.report.frame.zero
    given = {name: value * unit for name, value in words.items() if name not in ("sides", "angle")}
    moves = [move for move in trace.moves[cut.at : cut.end] if move.kind != "rapid"]
    bottom = min(move.end[2] for move in moves)
    assert bottom == pytest.approx(zero[2] * unit - given["depth"], abs=SAME)
    part = Part(True, ini.tool_beside, zero[0] * unit)
    level = [move for move in moves if move.start[2] == move.end[2] == bottom]
    lines = [LineString(part.polyline(move, 1e-3)[:, :2]) for move in level]
    swept = unary_union([line.buffer(trace.radius(cut.at), SEGMENTS) for line in lines])
    swept = rotate(swept, -zero[3], origin=(0, 0))
    if cut.report.code == "polar_polygon":
        bar = disc(0, 0, given["stock_diameter"])
        rounding, angle = given.get("corner_radius", 0.0), words.get("angle", 0.0)
        drawn = polygon(round(words["sides"]), given["across_flats"], rounding, angle)
        assert area_off(bar.difference(swept), drawn.intersection(bar), WALL) < SLIVER, cut.line
    elif cut.report.code == "polar_slot":
        drawn = slot(given["width"], given["length"], words.get("angle", 0.0))
        assert area_off(swept, drawn, WALL) < SLIVER, cut.line
    else:
        x = given.get("x", 0.0) / (2 if diameters else 1)
        drawn = disc(x, given.get("c", 0.0), given["diameter"])
        assert area_off(swept, drawn, WALL) < SLIVER, cut.line
