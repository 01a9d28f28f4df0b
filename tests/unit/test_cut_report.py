# SPDX-License-Identifier: GPL-2.0-or-later
"""What the planners report of their cuts: the record of a literal block, and its text."""

import json
import math

import pytest

from g12 import cut_report
from g12.cut_report import (
    CutElement,
    CutReport,
    EventCut,
    FrameCut,
    HolesCut,
    PocketCut,
    PolygonCut,
    ProgramFrame,
    RoundPocketCut,
    SectionCut,
    ShapePasses,
    SlotCut,
    ThreadCut,
    UsedCutter,
    more_text,
    report_text,
)
from g12.cycles import haas, mitsubishi, yasnac
from g12.cycles.circle_mill import plan_call, plan_code
from g12.cycles.plan import EventPlanes
from g12.request import CLOCKWISE, LEFT_OUT, Words
from g12.settings import Settings
from g12.shapes import holes, pockets, polygon
from g12.shapes.entries import ShapeEntries, ShapeMachine
from g12.shapes.holes import HoleMachine
from g12.state import Tool
from g12.tools.preview.reports import read_report
from support.planner_context import MM, words_of

TOOLS = {1: Tool(1, 5.0), 2: Tool(2, 2.0)}
MILL = MM._replace(z=1.0, spindle_tool=TOOLS[1], tools=TOOLS)
LATHE = MM._replace(x=30.0, z=5.0, speed=500.0, spindle_tool=TOOLS[2])
BY_D1, NO_D = UsedCutter(5.0, "D", 1), UsedCutter(0.0, "")
LOADED_1, LOADED_2 = UsedCutter(5.0, "loaded", 1), UsedCutter(2.0, "loaded", 2)
FRAME = ProgramFrame(1.0, (0.0, 0.0, 0.0, 0.0), 0.0, False)


def cut_of(planner, words, *arguments, found=MILL):
    return planner(Words("G12", words_of(words), found), *arguments).cut


def shape_cut(planner, names, values, machine):
    given_values = {**dict.fromkeys(names, LEFT_OUT), **values}
    return planner(ShapeEntries("shape", names, given_values, LATHE), machine).cut()


def rounded(cut):
    """Return a record without the last digits of its numbers."""
    return json.loads(json.dumps(cut), parse_float=lambda text: round(float(text), 9))


# ---------------------------------------------------------------- a block, and what is reported

STANDING = MILL._replace(x=1.0, y=2.0, z=3.0)
AT, HERE = (0.0, 0.0, 1.0), (1.0,)
LAST_D = MILL._replace(last_cutter=Tool(4, 2.0))


@pytest.mark.parametrize(
    ("cycle", "words", "found", "cut"),
    [
        (haas, "X10 Y5 I6 K20 Q4 Z-3 D1", MILL,
         PocketCut("G17", (10.0, 5.0, -3.0), 20.0, 6.0, 4.0, -4.0, (-3.0,), BY_D1)),
        (haas, "I18 Z-2 L3 D1", MILL._replace(incremental=True),
         PocketCut("G17", (0.0, 0.0, -1.0), 18.0, 18.0, 0.0, 8.0, (-1.0, -3.0, -5.0), BY_D1)),
        (haas, "I6", LAST_D,
         PocketCut("G17", AT, 6.0, 6.0, 0.0, 2.0, HERE, UsedCutter(2.0, "last D", 4))),
        (haas, "I6", MILL, PocketCut("G17", AT, 6.0, 6.0, 0.0, -4.0, HERE, LOADED_1)),
        (haas, "I6 D0", MILL,
         PocketCut("G17", AT, 6.0, 6.0, 0.0, 6.0, HERE, UsedCutter(0.0, "D", 0))),
        (yasnac, "I-20 D1", MILL, PocketCut("G17", AT, 20.0, 20.0, 0.0, 10.0, HERE, BY_D1)),
        (yasnac, "I20", MILL, PocketCut("G17", AT, 20.0, 20.0, 0.0, 20.0, HERE, NO_D)),
        # the first turn grows from 3 to 6: what is inside of it minus the cutter's radius stays
        (yasnac, "I20 K8 Q3 D1", MILL, PocketCut("G17", AT, 20.0, 8.0, 3.0, 1.0, HERE, BY_D1)),
        *((mitsubishi, "I20 D1", STANDING._replace(plane=plane),
           PocketCut(plane, (1.0, 2.0, 3.0), 20.0, 20.0, 0.0, 10.0, (level,), BY_D1))
          for plane, level in (("G17", 3.0), ("G18", 2.0), ("G19", 1.0))),
    ],
)  # fmt: skip
def test_a_block_of_circles(cycle, words, found, cut):
    assert cut_of(cycle.plan, words, CLOCKWISE, Settings(), found=found) == cut


LEVELS = (-1.0, -4.0, -5.7, -6.0)  # W2, three times K3 from there, the bottom
EVENTS = [
    ("X1 Y2 Z-6 I2 E10 R20 H2 K3 J5 Q.3 P150", True,
     EventCut((1.0, 2.0), -1, 20.0, 0.0, LEVELS, LOADED_1)),
    ("X1 Y2 Z-6 I2 R20 H1", False, EventCut((1.0, 2.0), 1, 30.0, 20.0, (-6.0,), LOADED_1)),
    ("X0 Y0 Z-6 I2 R20 H0", False, EventCut((0.0, 0.0), 0, 25.0, 15.0, (-6.0,), LOADED_1)),
]  # fmt: skip


@pytest.mark.parametrize(("words", "pocket", "cut"), EVENTS)
def test_an_event(words, pocket, cut):
    assert rounded(cut_of(plan_code, words, EventPlanes(), pocket)) == rounded(cut)


def test_the_event_of_a_call():
    entries = "G7 X1 Y2 Z-6 W2 O10 R20 C2 K3 J5 L.3 P150 F200 V100"
    assert rounded(cut_of(plan_call, entries, None)) == rounded(EVENTS[0][2])


SHAPE = ShapeMachine(False, 3.0, 0.5, 0.0025, False)
DRILL = HoleMachine(c=100.0, spindle=0, spindle_code=3, speed=500.0, beside=0.0, diameters=True)
PASSES = ShapePasses((-1.5, -3.0), LOADED_2, 400.0, 200.0)
TWO_PASSES = dict(depth=3.0, depth_per_pass=1.5, feed=400.0)


HOLE = dict(depth=8.0, retract=2.0, feed=120.0)
SHAPES = [
    (polygon.plan_polygon, polygon.POLYGON_ENTRIES, SHAPE,
     dict(sides=6, across_flats=20.0, stock_diameter=30.0, corner_radius=1.0, angle=10.0,
          **TWO_PASSES),
     PolygonCut(6, 20.0, 1.0, 30.0, 10.0, PASSES)),
    (pockets.plan_slot, pockets.SLOT_ENTRIES, SHAPE,
     dict(width=12.0, length=30.0, angle=-40.0, **TWO_PASSES),
     SlotCut(12.0, 30.0, -40.0, PASSES)),
    (pockets.plan_round_pocket, pockets.ROUND_POCKET_ENTRIES, SHAPE,
     dict(x=8.0, c=5.0, diameter=20.0, **TWO_PASSES),
     RoundPocketCut((8.0, 5.0), 20.0, PASSES)),
    # from C100 the shorter way to 20, then by thirds of a turn
    (holes.plan_face_holes, holes.FACE_HOLES, DRILL,
     dict(count=3, circle_diameter=30.0, first_angle=20.0, peck=3.0, dwell=0.5, **HOLE),
     HolesCut(0.0, ((15.0, 0.0, 20.0), (15.0, 0.0, 140.0), (15.0, 0.0, 260.0)), 8.0, 0, 120.0)),
    (holes.plan_side_holes, holes.SIDE_HOLES, DRILL,
     dict(count=2, z=-10.0, first_angle=30.0, step_angle=-100.0, surface_diameter=40.0, **HOLE),
     HolesCut(20.0, ((20.0, -10.0, 30.0), (20.0, -10.0, -70.0)), 8.0, 0, 120.0)),
    (holes.plan_face_hole_at, holes.FACE_HOLE_AT, DRILL,
     dict(x=0.0, c=-5.0, depth=8.0, retract=2.0, feed=1.25, kind=1),
     HolesCut(0.0, ((5.0, 0.0, 270.0),), 8.0, 1, 1.25)),
]  # fmt: skip


@pytest.mark.parametrize(("planner", "names", "machine", "values", "cut"), SHAPES)
def test_a_shape_or_holes(planner, names, machine, values, cut):
    assert rounded(shape_cut(planner, names, values, machine)) == rounded(cut)


# ---------------------------------------------------------------- the text, and the frame

ELEMENTS = (
    CutElement(7, 1, 5.0, 300.0, 0.0, -1.0, 20 + 0j, 20 + 5j),
    CutElement(8, -1, 0.0, 300.0, -1.0, -1.0, 20 + 5j, 10 + 5j, 15 + 5j, -math.pi),
    CutElement(9, 0, 0.0, 100.0, -1.0, 2.0),
)
CUTS = [
    EVENTS[0][2],
    *(cut for *_, cut in SHAPES),
    PocketCut("G18", (1.0, 2.0, 3.0), 20.0, 8.0, 3.0, 1.0, (1.0, 0.0), BY_D1),
    ThreadCut((1.0, 2.0), 6.0, 5.0, -1.0, True, 0.0625, 2, 0.0, (-10.0,), BY_D1),
    FrameCut((0.0, 0.0), (40.0, 30.0), 5.0, -1, True, (-2.0, -4.0), BY_D1),
    SectionCut(0.0, True, ELEMENTS),
]


def report(cut):
    at, words = (1.0, 0.0, 2.0, 10.0), {"I": 20.0}
    return CutReport("G12", 6, "sub.ngc", FRAME, at, 300.0, False, True, words, cut)


def test_a_report_of_each_kind_is_read_as_it_was_written():
    for cut in CUTS:
        text = report_text(report(cut))
        assert text.startswith(cut_report.CUT)
        assert read_report(text) == report(cut)
    assert {type(cut) for cut in CUTS} == set(cut_report.KINDS.values())


def test_further_elements_continue_a_section():
    whole, first = (report(SectionCut(20.0, False, ELEMENTS[:n])) for n in (3, 1))
    texts = report_text(first), more_text(ELEMENTS[1:2]), more_text(ELEMENTS[2:])
    assert read_report(*texts) == whole


@pytest.mark.parametrize("other", [('"schema": 1', '"schema": 2'), ('"section"', '"keyway"')])
def test_a_report_of_another_schema_is_refused(other):
    text = report_text(report(CUTS[-1])).replace(*other)
    with pytest.raises(ValueError, match="reports its cuts by schema"):
        read_report(text)


def test_a_frame_leads_to_the_machine():
    frame = ProgramFrame(25.4, (1.0, 2.0, -0.5, 0.0), 90.0, False)
    assert frame.level(-0.1) == pytest.approx(-0.6 * 25.4)
    assert frame.point(3.0, 0.0) == pytest.approx((1 + 5j) * 25.4)
