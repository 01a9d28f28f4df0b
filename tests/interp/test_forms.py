# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms: what ngcgui makes of them comes out as filled in; geometry from the moves alone."""

import re

import pytest
from matplotlib.image import imread

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.ngcgui import NGC, fields, filled_in
from support.sim_machines import SIM

FORMS = sorted(path.stem for path in NGC.glob("form_*_mm.ngc"))
UNITS = {"mm": ("G21", 1.0), "inch": ("G20", 25.4)}
BOTH = pytest.mark.parametrize("unit", UNITS)
ONE = pytest.mark.parametrize("unit", ["inch"])  # the forms of both units are one text
WIDEST, HIGHEST = 319, 239  # dots of a picture that ngcgui does not halve
LONGEST = 18  # letters beside an entry, for two columns on a screen 1024 dots wide
TOOLS = {1: 10.0, 2: 4.0}  # mm; on inch machines the same in inches
MACHINES = {"haas": "mill_mm", "circle_mill": "mill_mm", "yasnac": "mill_yasnac_mm",
            "mitsubishi": "mill_mitsubishi_mm"}  # fmt: skip


@pytest.fixture(scope="module")
def machine():
    """Return the machine of a form, opened once."""
    opened = {}

    def of(form):
        name = MACHINES[form]
        if name not in opened:
            opened[name] = Tracer(SIM / f"{name}.ini", tools=TOOLS)
        return opened[name]

    yield of
    for tracer in opened.values():
        tracer.close()


@pytest.fixture
def cut(machine, tmp_path):
    """Return what a form filled in cuts; lengths are given in mm and entered in the form's unit."""

    def moves_of(form, unit, before=(), counts=(), **values):
        scale = UNITS[unit][1]
        entered = {
            name: value if name in ("tool", "speed", "code", "event", *counts) else value / scale
            for name, value in values.items()
        }
        program = filled_in(f"form_{form}_{unit}", tmp_path / "auto.ngc", tool=1, **entered)
        return machine(form).trace_text([*before, *program.read_text().splitlines()])

    return moves_of


def without_numbers(form, unit):
    """Return a form's text without its defaults and its unit."""
    text = (NGC / f"form_{form}_{unit}.ngc").read_text()
    text = re.sub(r"\(=[-.\d]+", "(=", text.replace(f"{form}_{unit}", form))
    for word in (unit + "es", unit, UNITS[unit][0], f"call [{UNITS[unit][0][1:]}]"):
        text = text.replace(word, "")
    return text.replace("in/min", "/min")


@pytest.mark.parametrize("form", FORMS)
def test_the_forms_of_both_units_are_one(form):
    name = form.removeprefix("form_").removesuffix("_mm")
    assert without_numbers(name, "mm") == without_numbers(name, "inch")


@BOTH
@pytest.mark.parametrize("form", FORMS)
def test_every_entry_has_words_and_a_default_and_every_form_a_picture(form, unit):
    form = form.replace("_mm", f"_{unit}")
    found = fields(form)
    assert found[0].name == "tool"
    for field in found:
        float(field.default)
        assert 0 < len(field.words) <= LONGEST, field
    height, width = imread(NGC / f"{form}.png").shape[:2]
    assert width <= WIDEST and height <= HIGHEST


def is_disc(moves, cutter, x, y, radius):
    """Tell whether moves clear exactly a disc (mm)."""
    area, wanted = cut_geometry.swept(moves, cutter), cut_geometry.disc(x, y, radius)
    return area.symmetric_difference(wanted).area < 2e-4 * wanted.area


def ended_well(found, retract, unit="G21"):
    """Check the end: at the retract height, spindle off, units back, no error."""
    assert found.error is None, found.error
    assert found.moves[-1].end[2] == pytest.approx(retract, abs=1e-9)
    assert unit in found.modes.gcodes and "G90" in found.modes.gcodes
    assert {"M5", "M9"} <= set(found.modes.mcodes)


def rapids_stay_up(found, retract):
    """Check that no rapid goes sideways below the retract height."""
    below = [move for move in found.moves if move.kind == "rapid" and move.end[2] < retract - 1e-9]
    assert all(move.start[:2] == move.end[:2] for move in below)


@ONE
def test_a_haas_pocket_comes_out_as_filled_in(cut, unit):
    found = cut("haas", unit, counts=["levels"], x=12, y=-7, retract=20, top=3, z=-6, levels=3,
                i=8, k=25, q=6, feed=500, code=12)  # fmt: skip
    ended_well(found, 20)
    rapids_stay_up(found, 20)
    cuts = [move for move in cut_geometry.cutting(found.moves) if move.end[2] < 3 - 1e-9]
    assert {round(move.feed, 6) for move in cuts} == {500}
    assert cut_geometry.levels(found.moves) == pytest.approx([0, -3, -6])
    for level in (0, -3, -6):
        there = [move for move in cut_geometry.in_plane(cuts) if abs(move.end[2] - level) < 1e-6]
        assert cut_geometry.radii(there) == pytest.approx([3, 9, 15, 20])
        assert {circle.turns for circle in cut_geometry.full_circles(there)} == {-1}
    assert is_disc(there, 5, 12, -7, 25)


@ONE
def test_a_haas_pocket_without_k_is_one_circle(cut, unit):
    found = cut("haas", unit, counts=["levels"], z=-2, levels=1, i=9, k=0)
    ended_well(found, UNITS[unit][1] * float(fields(f"form_haas_{unit}")[6].default))
    assert cut_geometry.radii(found.moves) == pytest.approx([4])


@ONE
@pytest.mark.parametrize("r", [0, 30])
def test_a_yasnac_circle_comes_out_as_filled_in(cut, unit, r):
    found = cut("yasnac", unit, counts=["circles"], x=4, y=5, retract=15, top=1, z=-8, code=12,
                i=50, r=r, k=0, q=0, circles=2, feed=600)  # fmt: skip
    ended_well(found, 15)
    circles = cut_geometry.full_circles(found.moves)
    assert [(c.x, c.y, c.z, c.radius, c.turns) for c in circles] == [
        pytest.approx((4, 5, -8, 45, -1), abs=1e-6)
    ] * 2
    fast = [move for move in found.moves if move.kind == "rapid" and move.start[2] < 0]
    assert [move.end[0] for move in fast][:-1] == pytest.approx([4 + 25, 4] if r else [])


@ONE
def test_a_spiral_of_yasnac_comes_out_as_filled_in(cut, unit):
    found = cut("yasnac", unit, counts=["circles"], z=-3, i=-40, r=0, k=-9, q=6, circles=1)
    assert found.error is None
    assert cut_geometry.radii(found.moves) == pytest.approx([35])
    in_plane = cut_geometry.in_plane(cut_geometry.cutting(found.moves))
    assert is_disc(in_plane, 5, 0, 0, 40)
    assert in_plane[0].end[0] < 0  # begins on the -X side


@ONE
def test_a_mitsubishi_circle_comes_out_as_filled_in(cut, unit):
    found = cut("mitsubishi", unit, x=-3, y=2, retract=15, top=1, z=-8, code=13, i=30)
    ended_well(found, 15)
    rapids_stay_up(found, 15)
    circles = cut_geometry.full_circles(found.moves)
    assert circles == [pytest.approx((-3, 2, -8, 25, 1), abs=1e-6)]


@ONE
def test_a_circle_mill_pocket_comes_out_as_filled_in(cut, unit):
    found = cut("circle_mill", unit, counts=["d", "c"], event=7, x=5, y=6, z=-4, w=2, o=12, r=30,
                d=1, c=1, k=3, j=7, l=0.5, p=100, f=400, v=200)  # fmt: skip
    ended_well(found, 12)
    assert cut_geometry.levels(found.moves) == pytest.approx([-1, -3.5, -4])
    in_plane = cut_geometry.in_plane(cut_geometry.cutting(found.moves))
    last = [move for move in in_plane if abs(move.end[2] + 4) < 1e-6]
    assert is_disc(last, 5, 5, 6, 30)
    assert cut_geometry.radii(last)[-1] == pytest.approx(25)
    assert {round(move.feed, 6) for move in last} == {400, 200}


@ONE
def test_a_perimeter_without_its_optional_entries(cut, unit):
    found = cut("circle_mill", unit, counts=["d", "c"], event=0, z=-2, w=1, o=9, r=20, d=0, c=1,
                k=0, j=0, l=0, p=0, v=0, f=300)  # fmt: skip
    ended_well(found, 9)
    circles = cut_geometry.full_circles(found.moves)
    assert circles == [pytest.approx((0, 0, -2, 25, -1), abs=1e-6)]
    assert {round(move.feed, 6) for move in cut_geometry.cutting(found.moves)} == {300}


@BOTH
@pytest.mark.parametrize("active", ["G20", "G21"])
def test_the_units_are_put_back(cut, unit, active):
    ended_well(cut("mitsubishi", unit, [active], i=30, retract=50), 50, active)


def test_the_tool_goes_up_before_it_goes_sideways_and_never_first_down(cut):
    low = cut("mitsubishi", "mm", ["G21 G0 X9 Y9 Z-20"], x=1, y=2, retract=15)
    high = cut("mitsubishi", "mm", ["G21 G0 X9 Y9 Z40"], x=1, y=2, retract=15)
    places = [[pytest.approx(move.end[:3]) for move in found.moves[1:3]] for found in (low, high)]
    assert places == [[(9, 9, 15), (1, 2, 15)], [(1, 2, 40), (1, 2, 15)]]


REFUSED = [
    ("haas", {"tool": 0}, "form: the tool number must be 1 or more, not 0"),
    ("haas", {"tool": 99}, "Requested tool 99 not found"),
    ("haas", {"speed": 0}, "form: the spindle speed must be above zero, not 0"),
    ("haas", {"coolant": 3}, "form: coolant must be 7, 8 or 9, not 3"),
    ("haas", {"retract": -1}, "form: the retract height -1.000000 must be above 0.000000"),
    ("haas", {"z": 0}, "form: Z 0.000000 must be below 0.000000, where the cut begins"),
    ("haas", {"code": 2}, "form: G must be 12 or 13, not 2"),
    ("haas", {"feed": 0}, "Cannot do g1 with zero feed rate"),
    ("haas", {"i": 4}, "G13 line 29 of form_haas_mm.ngc: I4 must be greater than the tool radius"),
    ("haas", {"q": 0}, "G13 line 29 of form_haas_mm.ngc: Q0 must be greater than 0"),
    ("haas", {"k": 7}, "G13 line 29 of form_haas_mm.ngc: I10 must be less than K7"),
    ("haas", {"levels": 0}, "form: L must be a whole number from 1, not 0"),
    ("haas", {"levels": 1.5}, "form: L must be a whole number from 1, not 1.5"),
    ("yasnac", {"code": 12.5}, "form: G must be 12 or 13, not 12.5"),
    ("yasnac", {"circles": 0}, "form: L must be a whole number from 1, not 0"),
    ("yasnac", {"r": 60}, "G13 line 31 of form_yasnac_mm.ngc: R60 puts"),
    ("mitsubishi", {"code": 1}, "form: G must be 12 or 13, not 1"),
    ("mitsubishi", {"i": 5}, "G13 line 23 of form_mitsubishi_mm.ngc: I5 must be"),
    ("circle_mill", {"event": 1}, "form: G must be 0 or 7, not 1"),
    ("circle_mill", {"o": 1}, "form: the retract height 1.000000 must be above 2.000000"),
    ("circle_mill", {"c": 5}, "form_circle_mill_mm.ngc: C5 must be at most 2"),
    ("circle_mill", {"d": 0, "c": 1}, "D0 with C1 does not put the tool inside the pocket"),
]


@pytest.mark.parametrize(("form", "wrong", "message"), REFUSED)
def test_a_wrong_entry_is_refused_and_nothing_is_cut(machine, tmp_path, form, wrong, message):
    values = {"tool": 1, **wrong}
    program = filled_in(f"form_{form}_mm", tmp_path / "auto.ngc", **values)
    found = machine(form).trace_text(program.read_text().splitlines())
    assert found.error is not None
    assert message in found.error.text
    cuts = cut_geometry.in_plane(cut_geometry.cutting(found.moves))
    assert not cuts


def test_two_features_of_one_program(machine, tmp_path):
    first = filled_in("form_haas_mm", tmp_path / "1.ngc", tool=1, x=0).read_text()
    second = filled_in("form_haas_mm", tmp_path / "2.ngc", tool=1, x=80).read_text()
    together = [line for line in first.splitlines() if "m2" not in line] + second.splitlines()
    found = machine("haas").trace_text(together)
    assert found.error is None
    assert {circle.x for circle in cut_geometry.full_circles(found.moves)} == {0, 80}


SHOWN = {
    ini: re.findall(r"^NGCGUI_SUBFILE = (\S+)\.ngc$", ini.read_text(), re.MULTILINE)
    for ini in sorted(SIM.glob("*.ini"))
}


def test_every_machine_with_a_screen_shows_forms_of_its_own_unit():
    for ini, forms in SHOWN.items():
        assert bool(forms) != ini.stem.endswith("_headless"), ini
        unit = "inch" if "inch" in ini.stem else "mm"
        assert all(form.endswith(f"_{unit}") for form in forms), ini


@pytest.mark.parametrize("ini", [ini for ini in SHOWN if SHOWN[ini]], ids=lambda ini: ini.stem)
def test_the_defaults_are_right_for_the_machines_that_show_a_form(ini, tmp_path):
    with Tracer(ini) as running:
        for form in SHOWN[ini]:
            program = filled_in(form, tmp_path / "auto.ngc")
            found = running.trace_text(program.read_text().splitlines())
            assert found.error is None, (form, found.error)
            assert all("C has turned" in message.text for message in found.messages)
            assert cut_geometry.cutting(found.moves)
