# SPDX-License-Identifier: GPL-2.0-or-later
"""The differences between two recordings, and their sentences."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.path.part import Part
from g12.tools.preview.moves import Error, Move
from g12.tools.regress.differences import TOLERANCE, differences
from g12.tools.regress.recording_text import Note, Recording
from support.growth import growth

STILL = (0.0,) * 9
FACTS = {"program": "a.ngc sha256:1", "machine": "m", "linuxcnc": "2.9.4", "units": "mm"}
FINE = TOLERANCE
MILL, LATHE = Part(turning=False), Part(turning=True)


def recording(*steps, error=None, end="M2", **facts):
    """Chain (kind, (x, y, z), feed) and texts into a recording; each step is a line."""
    at, made = STILL, []
    for line, step in enumerate(steps, start=1):
        if isinstance(step, str):
            made.append(Note(line, step))
            continue
        kind, target, *more = step
        more = dict(more[0]) if more else {}
        target = (*target, *STILL[len(target) :])
        mode = "" if kind == "rapid" else "G94"
        feed = 0.0 if kind == "rapid" else 100.0
        plain = Move(kind, line, line, at, target, feed, mode, 17, -1, STILL)
        made.append(plain._replace(**more))
        at = target
    return Recording({**FACTS, **facts}, made, error=error, end=end)


def found(was, now, part=MILL):
    return differences(was, now, FINE, part)


AROUND = [(0, 0, -1), (10, 0, -1), (10, 10, -1), (0, 10, -1), (0, 0, -1)]
SQUARE = [("rapid", (0, 0, 5)), *(("feed", at) for at in AROUND), ("rapid", (0, 0, 5))]


def circle(radius, turns=-1, **more):
    """Return a full circle from (0, 0, -1) with its centre on X."""
    return ("arc", (0, 0, -1), {"centre": (radius, 0.0, -1.0), "turns": turns, **more})


def test_a_changed_depth_is_one_difference_with_its_amount():
    now = [(kind, (x, y, -1.25 if z == -1 else z)) for kind, (x, y, z) in SQUARE]
    (difference,) = found(recording(*SQUARE), recording(*now))
    assert difference.text == "Z-1 → Z-1.25 (-0.25 mm)"
    assert (difference.axis, difference.by, difference.moves) == ("Z", -0.25, 5)


def feed(x=1.0, a=0.0, units="mm", **more):
    return recording(("feed", (x, 0, 0, a), more), units=units)


def arc_of(*words, **more):
    return recording(("feed", (0, 0, -1)), circle(*words, **more))


NOTED = recording("M8 on", *SQUARE, "M8 off")
RAPID = recording(*SQUARE[:3], ("rapid", SQUARE[3][1]), *SQUARE[4:])
ASIDE = [("feed", (10, 5, -1)), ("feed", (11, 5, -1))]
ROUGH = [("feed", (10, 0, 0)), ("feed", (10, 10, 0))]
REFUSED = recording(*SQUARE, error=Error("G12: no I", 8))


@pytest.mark.parametrize(
    ("was", "now", "kind", "text"),
    [
        (feed(25.4, units="inch"), feed(25.654, units="inch"), "moved", "X1 → X1.01 (+0.01 in)"),
        (feed(0, 10, units="inch"), feed(0, 12, units="inch"), "moved", "A10 → A12 (+2 degrees)"),
        (feed(feed=100.0), feed(feed=100.009), None, ""),  # within the tolerance
        (feed(feed=100.0), feed(feed=100.02), "changed", "F100 → F100.02"),
        (feed(), feed(feed_mode="G95"), "changed", "G94 → G95"),
        (recording(*SQUARE), RAPID, "changed", "feed → rapid"),
        (arc_of(5.0), arc_of(5.01), "moved", "middle of the arc 0.02 mm off"),
        (arc_of(5.0), arc_of(5.0, 1), "changed", "turns -1 → turns 1"),
        (arc_of(5.0), arc_of(5.0, plane=18), "changed", "G17 → G18"),
        (recording(*SQUARE), recording(*SQUARE[:3], *SQUARE[4:]), "missing",
         "1 move missing, Y0 to 10"),
        (NOTED, recording(*SQUARE, "M8 off"), "missing", "missing: M8 on"),
        (recording(*SQUARE), recording(*SQUARE, "dwell 2"), "added", "new: dwell 2"),
        (NOTED, recording("M7 on", *SQUARE, "M8 off"), "changed", "M8 on → M7 on"),
        (REFUSED, recording(*SQUARE), "accepted", "no longer refused, was at line 8: G12: no I"),
        (recording(end="G17 G90 M2"), recording(end="G17 G91 M2"), "end",
         "modal state at the end: G90 → G91"),
        (recording(*SQUARE), recording(*SQUARE[:3], *ASIDE, *SQUARE[3:]), "added",
         "2 moves added, X10 to 11 Y0 to 5"),
        (recording(*ROUGH), recording(("feed", (5, 0.25, 0)), ("feed", (9, 0, 0)), ROUGH[1]),
         "replaced", "1 move became 2, up to 1 mm apart"),
    ],
)  # fmt: skip
def test_one_thing_that_differs_is_reported(was, now, kind, text):
    reported = [(difference.kind, difference.text) for difference in found(was, now)]
    assert reported == ([(kind, text)] if kind else [])


def test_one_move_that_is_wrong_within_a_shifted_path_is_reported_alone():
    was = [("feed", (x, x % 7, -1)) for x in range(40)]
    now = [(kind, (x, y + 2, z)) for kind, (x, y, z) in was]
    now[20] = ("feed", (20, 60, -1))
    texts = [d.text for d in found(recording(*was), recording(*now))]
    assert texts == ["Y by +2 mm", "Y6 → Y60 (+54 mm)"]


def test_the_same_at_each_level_is_one_difference_that_says_how_often():
    def levels(*ring):
        return [("feed", (x, 0, z)) for z in (-1, -2, -3, -4) for x in (0, *ring)]

    (difference,) = found(recording(*levels(5)), recording(*levels(5, 7, 9)))
    assert difference.text == "4 times: 2 moves added, X5 to 9"


def test_the_centre_of_a_flat_arc_may_be_anywhere():
    """With 10 m of radius a change of the centre by 1 mm moves the arc by 50 nm."""

    def flat(radius):
        centre = (0.5, -math.sqrt(radius**2 - 0.25), 0.0)
        return recording(("arc", (1, 0, 0), {"centre": centre, "turns": -1}))

    assert found(flat(10_000.0), flat(10_001.0)) == []
    assert len(found(flat(100.0), flat(101.0))) == 1


def test_apart_is_measured_on_the_part_that_turns():
    """On the machine X moves by 0.1 and C by 0.01: the part is what counts."""
    quarter = recording(("rapid", (10,)), ("feed", (10, 0, 0, 0, 0, 90)))
    bent = [("feed", (10.1, 0, 0, 0, 0, 45)), ("feed", (10, 0, 0, 0, 0, 90.01))]
    (difference,) = found(quarter, recording(("rapid", (10,)), *bent), part=LATHE)
    assert difference.text == "1 move became 2, up to 0.1002 mm apart"


def test_a_program_that_is_refused_now_is_one_difference():
    now = recording(*SQUARE[:4], error=Error("G12: no I", 5))
    (difference,) = found(recording(*SQUARE, "M5"), now)
    assert (difference.kind, difference.text) == ("refused", "refused: G12: no I")
    assert (difference.lines, difference.recorded_lines) == ([5], [5, 6, 7, 8])


def test_the_same_refusal_is_no_difference_where_lines_moved():
    was = recording(error=Error("G12: no I", 5))
    assert found(was, recording(error=Error("G12: no I", 5))) == []
    moved = recording(error=Error("G12: no I", 6))
    assert [d.kind for d in found(was, moved)] == ["refused"]
    edited = recording(error=Error("G12: no I", 6), program="a.ngc sha256:2")
    assert found(was, edited) == []


coordinates = st.integers(-50, 50)
paths = st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=1, max_size=40)


@given(paths, st.data())
def test_inserted_blocks_are_all_that_is_found(points, data):
    """Whatever the program: blocks inserted anywhere are added moves and nothing else."""
    was = [("feed", point) for point in points]
    now = list(was)
    places = data.draw(st.lists(st.integers(0, len(was)), min_size=1, max_size=4, unique=True))
    for count, place in enumerate(sorted(places, reverse=True)):
        now.insert(place, ("feed", (1000 + count, 0, 0)))
    result = found(recording(*was), recording(*now))
    assert {difference.kind for difference in result} == {"added"}
    assert sum(difference.moves for difference in result) == len(places)
    lines = sorted(line for difference in result for line in difference.lines)
    assert lines == [place + count + 1 for count, place in enumerate(sorted(places))]


@given(paths, paths)
def test_nothing_is_found_only_between_equal_paths(points, others):
    was, now = ([("feed", point) for point in some] for some in (points, others))
    result = found(recording(*was), recording(*now))
    assert (not result) == (points == others)


def test_long_programs_are_not_compared_move_by_move():
    def compared(count):
        points = random.Random(2).sample(range(10**9), k=count)
        was = [("feed", (x, 0, 0)) for x in points]
        now = [("feed", (x if k % 9 else x + 1, 0, 0)) for k, x in enumerate(points)]
        recordings = recording(*was), recording(*now)
        return lambda: found(*recordings)

    assert sum(difference.moves for difference in compared(900)()) == 100
    assert growth(compared, 2_000) < 10
