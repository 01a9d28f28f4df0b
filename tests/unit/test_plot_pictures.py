# SPDX-License-Identifier: GPL-2.0-or-later
"""The geometry that pictures show, and that a picture of every kind comes out in every format."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from shapely.geometry import Point

from g12.tools.errors import UsageError
from g12.tools.machine.ini import Ini
from g12.tools.path.follow import worst_of
from g12.tools.plot import plan_view, style
from g12.tools.plot.deviation import clearest_axes, window_lines
from g12.tools.plot.history import history_of
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import scene_of
from g12.tools.plot.side_view import cut_through, removed_to
from g12.tools.preview.moves import Event
from g12.tools.units import MM, UNITS, clock, plain
from g12.tools.verify.in_part import RAPID
from g12.tools.verify.model.finding import Finding
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.remains import UNCUT, WALL
from support.made_moves import Hand, samples_of

FAST = [line for axis in "XYZ" for line in (f"[AXIS_{axis}]", "MAX_VELOCITY = 1e12")]
MILL = Ini(Path("mill.ini"), ("[TRAJ]", "COORDINATES = X Y Z", *FAST))
LATHE = Ini(
    Path("lathe.ini"), ("[TRAJ]", "COORDINATES = XZC", *FAST, "[AXIS_C]", "MAX_VELOCITY = 360")
)
PROGRAM = Path(__file__)
RED = to_rgba(style.CRASH)


def scene(hand, ini=MILL, **options):
    return scene_of(TracedProgram(PROGRAM, ini, hand.trace()), **options)


def pocket():
    hand = Hand().rapid(z=5).rapid(x=50).pocket([5, 10], depth=-2)
    return hand.pocket([5, 10], depth=-4).rapid(z=5)


def flats():
    points = [complex(20, y) for y in (0, 5, 10)] + [complex(x, 10) for x in (10, 0, -10, -20)]
    return Hand().rapid(z=2).rapid(x=20).line(z=-3).polar(points).rapid(z=2)


def groove():
    hand = Hand().rapid(z=2).rapid(x=24).line(x=18)
    return hand.line(c=90).line(z=-10, c=180).line(c=270).rapid(x=24)


def floors_of(hand, ini=MILL):
    return plan_view.floors_of(scene(hand, ini))


def on_surface(shown):
    return replace(shown, program=shown.program.on_surface(20.0))


def turned():
    return Hand().rapid(z=2).rapid(x=20).line(z=-30).line(x=25).rapid(z=2)


# ---------------------------------------------------------------- numbers as text


def test_numbers_in_words():
    for value, decimals, text in (
        (1.5, 3, "1.5"),
        (-2.0, 3, "−2"),
        (-0.0001, 3, "0"),
        (10, 0, "10"),
        (1234.5678, 2, "1234.57"),
    ):
        assert plain(value, decimals) == text
    fine = {0.0: "0", 0.0048: "0.0048", 0.00033: "0.00033", 1.23456: "1.235", np.inf: "∞"}
    assert {length: MM.fine(length) for length in fine} == fine
    assert (UNITS["inch"].text(25.4), UNITS["inch"].area(25.4**2 / 2)) == ("1", "0.5 in²")
    times = {9.96: "10.0 s", 59.94: "59.9 s", 59.96: "1 min 0 s", 299.7: "5 min 0 s"}
    assert {seconds: clock(seconds) for seconds in times} == times


# ---------------------------------------------------------------- what is shown


def helix():
    hand = Hand().rapid(x=50).line(z=-2).arc(1, 53, 0, x=56)
    return hand.arc(1, 50, 0, x=44, z=-3).arc(1, 50, 0, x=56, z=-4).arc(1, 50, 0)


def face_spiral():
    hand = Hand().rapid(x=9, z=1)
    for step in range(1, 9):
        hand.line(c=45.0 * step, z=1 - step / 2)
    return hand.line(c=720.0)


def two_tools():
    hand = Hand().line(x=100)
    hand.tool = 2
    return hand.rapid(y=50).line(x=0)


@pytest.mark.parametrize(
    ("hand", "ini", "floors"),  # each its level and its bounds
    [
        (pocket().pocket([5], depth=-6), MILL, {-4: (37, -13, 63, 13), -6: (42, -8, 58, 8)}),
        (helix(), MILL, {-2: (47, -3, 53, 3), -4: (41, -9, 59, 9)}),  # its turns are no floors
        (face_spiral(), LATHE, {-3: (-12, -12, 12, 12)}),
        (
            Hand().rapid(x=9).line(z=-5).rapid(z=1).rapid(x=30).line(z=-5),
            MILL,
            {-5: (6, -3, 33, 3)},
        ),
        (two_tools(), MILL, {0: (-5, -3, 105, 55)}),
    ],
)
def test_floors_that_remain_are_shown_each_darker_than_those_above(hand, ini, floors):
    shown = floors_of(hand, ini)
    assert [floor.z for floor in shown] == pytest.approx([*floors])
    for floor, bounds in zip(shown, floors.values()):
        assert floor.area.bounds == pytest.approx(bounds, abs=0.03)
    lights = [sum(floor.shade.line[:3]) for floor in shown]
    assert lights == sorted(lights, reverse=True)


@pytest.mark.parametrize(("count", "shown_at_most"), [(50, 50), (120, plan_view.BANDS)])
def test_very_many_depths_become_bands_and_few_are_in_the_legend(count, shown_at_most):
    hand = Hand()
    for step in range(count):
        hand.rapid(y=7.0 * step, z=5).line(z=-1 - step / 10)
    shown = scene(hand)
    floors = plan_view.floors_of(shown)
    assert len(floors) == shown_at_most
    said = [entry.get_label() for entry in plan_view.legend_entries(shown, floors)]
    assert (said[0], said[9]) == ("swept at Z−1", f"swept at Z−{1 + (count - 1) / 10:g}")
    assert said[10:] == ["cutter T1, ⌀ 6 mm", "plunge", "rapid"]


@pytest.mark.parametrize("tool", [0, 8])
def test_a_tool_without_a_diameter_is_only_its_centre(tool):
    shown, name = scene(Hand(tool=tool).line(x=5)), "T8 has no diameter" if tool else "no tool"
    assert plan_view.cutter_text(shown, tool) == f"{name}: tool centre only"


def test_the_history_begins_where_the_first_rapid_ends_and_c_obeys_its_limit():
    hand = Hand(feed=100000).rapid(x=10, z=2).line(c=360).line(c=0)
    history = history_of(scene(hand, LATHE))
    assert (history.time[0], history.x[0], history.z[0]) == (0, 10, 2)
    assert history.c_speed.max() == pytest.approx(360) and not history.rapid[1:].any()
    assert history.time[-1] == pytest.approx(2.0)
    assert history.feed[-1] == pytest.approx(2 * np.pi * 10 * 60, rel=1e-3)


def uncut(centre):
    """Return that a ring stands about a centre."""
    ring = Point(centre).buffer(30).difference(Point(centre).buffer(20))
    values = {"area": ring.area, "shape": ring, "floor": -4.0}
    return Finding(UNCUT, 1, values, (*centre, -4.0))


def drawn_in_red(shown):
    """Return how many polylines and marks a plan has in red."""
    axes = Figure().add_subplot()
    plan_view.draw_paths(plan_view.SceneView(axes, shown))
    lines = [one for one in axes.collections if one.get_edgecolor()[0] == pytest.approx(RED)]
    return len(lines[0].get_paths()), len([one for one in axes.lines if one.get_marker() == "X"])


def rapid_through(*points, **values):
    values |= {"at": (), "to": (), "area": 1.0, "path": np.array(points, dtype=float)}
    return Finding(RAPID, 2, values, points[0])


def warned(shown):
    return [entry.get_label() for entry in plan_view.warning_entries(shown)]


@pytest.mark.parametrize("units", ["mm", "inch"])
def test_a_rapid_that_is_seen_end_on_has_a_mark(units):
    down, through = "rapid straight down into material", "rapid through material"
    for hit, said in (
        (rapid_through([0, 0, 5], [0.1, 0, 5]), [through]),
        (rapid_through([9, 0, 5], [9, 0, 2]), [down, through]),  # a line in the side view
    ):
        shown = replace(scene(pocket(), units=units), findings=[hit])
        assert warned(shown) == said and drawn_in_red(shown) == (True, down in said)


@pytest.mark.parametrize(("surface", "shown_at"), [(20.0, 5.5), (22.0, 5.0)])
def test_a_plunge_by_rapid_is_marked_on_the_unrolled_surface(surface, shown_at):
    """The path may be unrolled on a bar's radius."""
    hit = rapid_through([5.5, 0, 24], [5.5, 0, 18], surface=surface)
    shown = replace(on_surface(scene(groove(), LATHE)), findings=[hit])
    assert warned(shown) == ["rapid straight down into material"]
    assert drawn_in_red(shown) == (1, 1)
    assert [path[0][0] for path in shown.hits] == [pytest.approx(shown_at)]


def test_uncut_material_and_a_finding_with_a_place_are_in_the_legend_and_the_view():
    found = Finding(WALL, 3, {"size": 0.1, "at": (60.0, 0, -4)}, (60.0, 0.0, -4.0))
    shown = replace(scene(pocket()), findings=[uncut((50.0, 0.0)), found])
    assert warned(shown) == ["uncut material", "finding in line 3"]
    low, high = plan_view.bounds_of(shown, [])
    assert low[0] < 20 and high[0] > 80 and low[1] < -30


@pytest.mark.parametrize(("hand", "ini", "at"), [(pocket, MILL, (2, 0)), (turned, LATHE, (-1, 2))])
def test_a_sign_is_where_its_finding_is(hand, ini, at):
    found = Finding(WALL, 3, {"size": 0.1}, (50.8, 0.0, -25.4))
    shown = replace(scene(hand(), ini, units="inch"), findings=[found])
    lines = picture_of(shown).axes[0].lines
    signs = [line.get_xydata()[0] for line in lines if line.get_marker() == style.SIGN["marker"]]
    assert signs == [pytest.approx(at)]


def test_a_boss_and_uncut_material_are_cut_through_their_middle_in_the_side_view():
    found = uncut((50.0, 7.0))
    floor = plan_view.Floor(-4.0, found.values["shape"], style.shade(1.0))
    for boxes in (cut_through(found, 0.0), removed_to(floor, 0.0)):
        left, right = sorted(part.bounds for part in boxes.geoms)
        assert left == pytest.approx((20, -4, 30, 0)) and right == pytest.approx((70, -4, 80, 0))


def test_the_top_of_the_part_is_z0_if_the_tool_goes_through_it():
    shown = scene(pocket())
    assert plan_view.top_of(shown) == 0.0
    shown.program.z0 = -1.5
    assert plan_view.top_of(shown) == -1.5
    assert plan_view.top_of(scene(Hand().rapid(z=-1).line(z=-3).line(x=5))) == -1.0


def test_segments_of_one_block_are_one_element_of_the_face():
    hand = flats()
    hand.block = 7
    hand.line(z=-3).polar([complex(-20, y) for y in (8, 4, 0)])
    assert len(plan_view.elements(scene(hand, LATHE))) == 2


def test_rapids_from_nobody_knows_where_are_not_shown():
    for hand, first in (
        (Hand().rapid(x=5).rapid(z=2).rapid(x=9).line(z=-1), 2),
        (Hand().line(z=-1).rapid(z=5).line(x=3), 0),
    ):
        assert plan_view.first_shown(scene(hand)) == first


def test_all_that_turns_is_drawn_as_a_cut():
    assert len(plan_view.fed_paths(scene(turned(), LATHE))[0]) == 1


def test_holes_in_an_area_stay_holes():
    outline = style.outline_of(Point(0, 0).buffer(10).difference(Point(0, 0).buffer(5)))
    assert outline.contains_point((7, 0))
    assert len(outline.to_polygons()) == 2
    assert style.outline_of(Point(0, 0).buffer(0)) is None


# ---------------------------------------------------------------- deviations


def with_real_motion(hand, ini, aside):
    """Return a scene whose real motion is the path, moved aside by a vector at one place."""
    shown = scene(hand, ini)
    axes = "XZC" if ini is LATHE else "XYZ"
    samples = samples_of(shown.path, 4000, axes=axes)
    middle = slice(1900, 2100)
    for letter, value in aside.items():
        samples.axes[letter][middle] += value
    return replace(shown, program=replace(shown.program, samples=samples))


def test_the_largest_deviation_is_reported_with_its_line_in_the_axes_that_show_it():
    shown = with_real_motion(Hand().line(x=100), MILL, {"Y": 0.0123})
    lines = list(window_lines(worst_of(shown.real, shown.moves), shown, [0, 1], 0.05))
    assert lines == ["0.012 mm,", "line 1, in X and Y", "the window is 0.1 mm wide"]
    shown = with_real_motion(flats(), LATHE, {"X": 0.0123})
    shown = replace(shown, override=1500.0, contour=0.0025)
    lines = list(window_lines(worst_of(shown.real, shown.moves), shown, [0, 1], 0.05))
    assert lines[0].endswith(" mm at 1500 % feed,")
    assert lines[1].endswith(", in X and C") and lines[2] == "off the contour: 0.0025 mm"
    assert clearest_axes(np.array([0, 0.1, -0.1]), np.array([0, -1, -1])) == [1, 2]


def test_a_cylinder_is_drawn_unrolled_with_the_motion_of_a_run():
    flat = on_surface(with_real_motion(groove(), LATHE, {"Z": 0.0123}))
    (level,) = plan_view.floors_of(flat)
    along_c = 20 * np.radians(270)
    assert level.z == pytest.approx(18)
    assert level.area.bounds == pytest.approx((-3, -13, along_c + 3, 5), abs=0.02)
    assert flat.path.points[-1] == pytest.approx((along_c, -10, 24))
    assert flat.path.part.letters == "CZX"
    assert worst_of(flat.real, flat.moves).deviation == pytest.approx(0.0123, abs=1e-4)
    assert flat.real.points[-1, :2] == pytest.approx((along_c, -10), abs=1e-3)


def test_what_the_spindle_turns_is_no_swept_area():
    events = [Event(at, 1, code) for at, code in ((1, "M3"), (3, "M5"))]
    hand = Hand().rapid(z=2).rapid(x=20).line(z=-3).line(c=90)
    trace = replace(hand.trace(), events=events)
    for spindles, found in (("2", ([2], [3])), ("1", ([], [2, 3]))):
        ini = LATHE.replaced({"TRAJ": {"SPINDLES": spindles}})
        shown = scene_of(TracedProgram(PROGRAM, ini, trace))
        assert (shown.turned, shown.sweeping) == found


# ---------------------------------------------------------------- files


@pytest.mark.parametrize(
    ("make", "suffix", "start"),
    [
        (lambda: with_real_motion(pocket(), MILL, {"Y": 0.01}), "png", b"\x89PNG"),
        (lambda: with_real_motion(turned(), LATHE, {"X": 0.01}), "png", b"\x89PNG"),
        (lambda: scene(Hand().rapid(x=10).rapid(z=5)), "png", b"\x89PNG"),
        (lambda: scene(Hand().line(z=-1)), "PNG", b"\x89PNG"),
        (lambda: with_real_motion(flats(), LATHE, {"X": 0.01}), "pdf", b"%PDF"),
        (lambda: on_surface(with_real_motion(groove(), LATHE, {"X": 0.01})), "svg", b"<?xml"),
    ],
)
def test_every_kind_of_picture_is_drawn_the_same_every_time(make, suffix, start, tmp_path):
    paths = [tmp_path / f"{name}.{suffix}" for name in ("one", "other")]
    for path in paths:
        style.save(picture_of(make()), path)
    one, other = (path.read_bytes() for path in paths)
    assert one.startswith(start) and one == other


@pytest.mark.parametrize(
    ("x", "units", "place"), [(12.7, "mm", "X12.7"), (-12.7, "inch", "X−0.5"), (0.0, "mm", "")]
)
def test_the_place_of_a_lathes_x0_is_said_where_it_is_not_the_machines(x, units, place):
    shown = scene(flats(), LATHE, units=units)
    shown.program.zero = (x, 0.0, 0.0)
    assert shown.x0_text == (place and f"X0, the spindle's axis, is at machine {place}")
    assert scene(pocket()).x0_text == ""


def test_other_suffixes_are_refused_by_name(tmp_path):
    for name in ("picture", "picture.bmp"):
        with pytest.raises(UsageError, match=r"\.png, \.svg, \.pdf"):
            style.check_format(tmp_path / name)
