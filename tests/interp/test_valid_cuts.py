# SPDX-License-Identifier: GPL-2.0-or-later
"""Random valid programs: pockets, events and sections by their pages, shapes by their drawings.

`support.drawn_cuts` reads the pages, the drawings are shapely's. Contours that sections report are
those that LinuxCNC itself reads where C is the Y of a mill.
"""

import random
import re

import pytest
from shapely.affinity import rotate
from shapely.geometry import LineString
from shapely.ops import unary_union

from g12.cut_report import SectionCut
from g12.tools.path.part import Part
from g12.tools.preview.tracer import Tracer
from support import drawn_cuts
from support.shape_geometry import area_off, disc, polygon, slot
from support.sim_machines import SIM
from support.valid_programs import MACHINES, machine_of, valid_program

POCKETS, SECTIONS, SHAPES = 24, 8, 4  # in a program
SAME = 1e-4  # mm: words of inches have five decimals
POLAR = [kind for kind in MACHINES if kind.startswith("polar") and "beside" not in kind]
WALL = 0.01  # mm of a shape's wall
SEGMENTS = 48  # of a quarter circle
SLIVER = 0.02  # mm², where drawings have chords


def count_of(kind):
    """Return how many pockets, sections or shapes a program of a kind gets."""
    if kind.startswith("shapes"):
        return SHAPES
    return SECTIONS if kind.startswith(("polar", "cylinder")) else POCKETS


def traced(kind, folder, seed):
    """Return a random program's text and its trace with reports."""
    program = folder / "valid.ngc"
    program.write_text(valid_program(kind, random.Random(seed), count_of(kind)))
    with Tracer(machine_of(kind), reports=True) as tracer:
        trace = tracer.trace(program)
    assert trace.error is None and len(trace.cuts) >= count_of(kind), seed
    return program.read_text(), trace


def check_cuts(kind, folder, seed):
    """Judge the cuts of a random program."""
    text, trace = traced(kind, folder, seed)
    if kind.startswith("shapes"):
        for cut in trace.cuts:
            check_shape(trace, cut, machine_of(kind), diameters="\nG7" in text)
    else:
        drawn_cuts.check_cuts(trace, machine_of(kind), kind.split()[0])


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


# ---------------------------------------------------------------- a contour as LinuxCNC reads it

SECTION = re.compile(r"^G12\.1$(.*?)^G13\.1$", re.MULTILINE | re.DOTALL)


def as_on_a_mill(text):
    """Return a program whose sections are plain moves in X and Y, without compensation."""

    def plain(section):
        own = re.sub(r"G4[012]", "", section[1].replace("C", "Y"))
        return f"G17 G0 Y0{own}G18"

    return re.sub(r" C(-?[\d.]+|#1)$", "", SECTION.sub(plain, text), flags=re.MULTILINE)


def moves_of_mill(trace, lines):
    """Return line, start, end, centre and Z of each move that goes anywhere in some lines."""
    for move in trace.moves:
        start, end = (complex(*ends[:2]) for ends in (move.start, move.end))
        goes = abs(end - start) > 1e-6 or move.kind == "arc" or move.start[2] != move.end[2]
        if goes and move.line in lines:
            centre = complex(*move.centre[:2]) if move.centre else None
            yield move.line, start, end, centre, move.end[2]


@pytest.mark.parametrize("kind", POLAR)
def test_a_reported_contour_is_what_linuxcnc_reads_on_a_mill(kind, tmp_path):
    text, trace = traced(kind, tmp_path, f"{kind} contour")
    lines = {
        line
        for found in SECTION.finditer(text)
        for line in range(
            text[: found.start()].count("\n") + 2, text[: found.end()].count("\n") + 1
        )
    }
    unit = "inch" if "inch" in kind else "mm"
    with Tracer(SIM / f"mill_{unit}.ini") as tracer:
        mill = tracer.trace_text(as_on_a_mill(text))
    assert mill.error is None, mill.error
    read = list(moves_of_mill(mill, lines))
    reported = []
    for report in (cut.report for cut in trace.cuts):
        assert isinstance(report.cut, SectionCut)
        zero, mm, at = report.frame.zero, report.frame.mm, complex(report.at[0])
        for each in report.cut.elements:
            start, end = (at, at) if each.start is None else (each.start, each.end)
            points = [point and (point + zero[0]) * mm for point in (start, end, each.centre)]
            reported.append((each.line, *points, (each.z1 + zero[2]) * mm))
            at = end
    assert [line for line, *_ in reported] == [line for line, *_ in read]
    for (line, *mine, z), (_, *its, level) in zip(reported, read):
        assert mine == pytest.approx(its, abs=SAME) and z == pytest.approx(level, abs=SAME), line
