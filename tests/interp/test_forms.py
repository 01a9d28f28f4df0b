# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms: what ngcgui makes of them is cut as filled in, and verify has no finding in it."""

import re

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.judged_programs import prove
from support.ngcgui import NGC, fields, filled_in
from support.sim_machines import SIM

FORMS = sorted(path.stem for path in NGC.glob("form_*_mm.ngc"))
INCH = 25.4
UNITS = {"mm": ("G21", 1.0), "inch": ("G20", INCH)}
LONGEST = 18  # letters beside an entry, for two columns on a screen 1024 dots wide
TOOLS = {1: 10.0, 2: 4.0}  # mm; on inch machines the same in inches
MILLS = {"haas": "mill_mm", "circle_mill": "mill_mm", "yasnac": "mill_yasnac_mm",
         "mitsubishi": "mill_mitsubishi_mm", "bore": "mill_mm", "thread": "mill_mm",
         "frame": "mill_mm"}  # fmt: skip
NUMBERS = (  # entries that are no lengths
    *("tool", "speed", "code", "event", "levels", "circles", "d", "c"),
    *("sides", "angle", "on", "off", "count", "first_angle", "step"),
)
BESIDE = "G21 G8 G0 X60 Z20"  # where a lathe's tool comes from


@pytest.fixture(scope="module")
def machine():
    """Return the machine of a form, opened once."""
    opened = {}

    def of(form):
        name = MILLS.get(form, "lathe_mm")
        if name not in opened:
            opened[name] = Tracer(SIM / f"{name}.ini", tools=TOOLS)
        return opened[name]

    yield of
    for tracer in opened.values():
        tracer.close()


def program_of(folder, form, unit="mm", before="", **values):
    """Write a form filled in; lengths are given in mm and entered in its unit."""
    scale = UNITS[unit][1]
    entered = {name: value if name in NUMBERS else value / scale for name, value in values.items()}
    program = filled_in(f"form_{form}_{unit}", folder / "auto.ngc", **{"tool": 1, **entered})
    program.write_text(f"{before}\n{program.read_text()}")
    return program


@pytest.fixture
def cut(machine, tmp_path):
    """Return what a form filled in cuts."""

    def traced(form, unit, before="", **values):
        program = program_of(tmp_path, form, unit, before, **values)
        return machine(form).trace_text(program.read_text())

    return traced


@pytest.mark.parametrize("form", FORMS)
def test_every_entry_has_words_and_a_default_and_every_form_a_picture(form):
    found = fields(form)
    assert found[0].name == "tool"
    for field in found:
        float(field.default)
        assert 0 < len(field.words) <= LONGEST, field
    assert all((NGC / f"{form.replace('_mm', f'_{unit}')}.png").is_file() for unit in UNITS)


POCKETS = [  # a form filled in; its pocket, X, Y, floor, radius; its levels, circles, turn, moves
    ("haas", dict(x=12, y=-7, retract=20, top=3, z=-6, levels=3, i=8, k=25, q=6, feed=500,
                  code=12), (12, -7, -6, 25), ([0, -3, -6], [3, 9, 15, 20] * 3, -1, 36)),
    ("yasnac", dict(x=4, y=5, retract=15, top=1, z=-8, code=12, i=50, r=30, k=0, q=0, circles=2,
                    feed=600), (4, 5, -8, 50), ([-8], [45] * 2, -1, 4)),
    ("mitsubishi", dict(x=-3, y=2, retract=15, top=1, z=-8, code=13, i=30), (-3, 2, -8, 30),
     ([-8], [25], 1, 3)),
    ("circle_mill", dict(event=7, x=5, y=6, z=-4, w=2, o=12, r=30, d=1, c=1, k=3, j=7, l=0.5,
                         p=100, f=400, v=200), (5, 6, -4, 30),
     ([-1, -3.5, -4], [6.125, 12.25, 18.375, 24.5] * 3 + [25], 1, 27)),
    ("circle_mill", dict(event=0, z=-2, w=1, o=9, r=20, d=0, c=1, k=0, j=0, l=0, p=0, v=0,
                         f=300), (0, 0, -2, 20), ([-2], [25], -1, 1)),
]  # fmt: skip


@pytest.mark.parametrize(("form", "values", "pocket", "made"), POCKETS)
def test_a_pocket_comes_out_as_filled_in(form, values, pocket, made, tmp_path):
    program = program_of(tmp_path, form, "inch", **values)  # the forms of both units are one text
    bored = StockText(f"bore {2 * values['r']}mm") if form == "yasnac" and values["r"] else None
    proof = prove(program, read_ini(SIM / f"{MILLS[form]}_headless.ini"), tools=TOOLS, stock=bored)
    assert proof.findings == []
    (facts,) = proof.pockets
    traced, values_of = proof.program.trace, facts.values
    measured = *values_of["centre"], values_of["lowest"], values_of["radius"]
    assert measured == pytest.approx(pocket, abs=1e-6)
    levels, radii, turns, count = made
    cuts, circles = cut_geometry.cutting(traced.moves), cut_geometry.full_circles(traced.moves)
    assert [circle.radius for circle in circles] == pytest.approx(radii, abs=1e-5)
    assert list(dict.fromkeys(round(circle.z, 5) for circle in circles)) == levels
    assert {circle.turns for circle in circles} == {turns}
    assert len(cut_geometry.in_plane(cuts)) == count
    named = {values[name] for name in ("feed", "f", "v", "p") if values.get(name)}
    assert not named or {round(move.feed) for move in cuts} == named
    assert traced.moves[-1].end[2] == pytest.approx(values.get("retract", values.get("o")))
    assert {"M5", "M9"} <= set(traced.modes.mcodes)


SHAPES = {  # a form filled in, and what else its call names
    "polygon": dict(sides=6, across_flats=27, depth=5, stock_diameter=32, corner_radius=2,
                    per_pass=3, allowance=0.3, feed=500, angle=10),
    "slot": dict(width=13, length=28, depth=3, per_pass=2, angle=-20),
    "face_pocket": dict(x=12, c=4, diameter=15, depth=3),
}  # fmt: skip


@pytest.mark.parametrize("form", SHAPES)
def test_a_shape_comes_out_as_filled_in(form, tmp_path):
    program = program_of(tmp_path, form, "inch", f"G18 {BESIDE}", retract=4, **SHAPES[form])
    proof = prove(program, read_ini(SIM / "lathe_mm_headless.ini"), tools=TOOLS)
    assert proof.findings == []
    (facts,) = proof.shapes
    called = facts.values["entries"]
    for name, value in SHAPES[form].items():
        entry = called["depth_per_pass" if name == "per_pass" else name]
        assert entry == pytest.approx(value if name in NUMBERS else value / INCH)
    assert proof.program.trace.moves[-1].end[2] == pytest.approx(4)
    assert {"M5", "M9"} <= set(proof.program.trace.modes.mcodes)


def test_holes_come_out_as_filled_in(cut):
    face = cut("face_holes", "inch", BESIDE, circle_diameter=30, first_angle=20, depth=8, height=2,
               count=3)  # fmt: skip
    side = cut("side_holes", "inch", BESIDE, z=-10, first_angle=30, surface_diameter=40, depth=8,
               height=2, count=2, step=90, clear=60)  # fmt: skip
    assert face.error is None and side.error is None, (face.error, side.error)
    for found, bottom in ((face, (15, -8)), (side, (12, -10))):
        drilled = [move.end for move in found.moves if move.kind == "feed"]
        assert [(end[0], end[2]) for end in drilled] == [pytest.approx(bottom)] * len(drilled)
    assert [move.end[5] for move in side.moves if move.kind == "feed"] == pytest.approx([30, 120])


@pytest.mark.parametrize("active", ["G20 G7", "G20 G8", "G21 G7", "G21 G8"])
@pytest.mark.parametrize(("form", "unit"), [("mitsubishi", "inch"), ("slot", "mm")])
def test_the_modes_of_lengths_are_put_back(cut, form, unit, active):
    found = cut(form, unit, active, retract=50, tool=2)
    assert found.error is None, found.error
    assert {*active.split(), "G90"} <= set(found.modes.gcodes)


def test_the_tool_goes_up_before_it_goes_sideways_and_never_first_down(cut):
    low = cut("mitsubishi", "mm", "G21 G0 X9 Y9 Z-20", x=1, y=2, retract=15)
    high = cut("mitsubishi", "mm", "G21 G0 X9 Y9 Z40", x=1, y=2, retract=15)
    places = [[pytest.approx(move.end[:3]) for move in found.moves[1:3]] for found in (low, high)]
    assert places == [[(9, 9, 15), (1, 2, 15)], [(1, 2, 40), (1, 2, 15)]]


REFUSED = [
    ("haas", {"speed": 0}, "form: the spindle speed must be above zero, not 0"),
    ("haas", {"coolant": 3}, "form: coolant must be 7, 8 or 9, not 3"),
    ("haas", {"retract": -1}, "form: the retract height -1.000000 must be above 0.000000"),
    ("haas", {"z": 0}, "form: Z 0.000000 must be below 0.000000, where the cut begins"),
    ("haas", {"code": 2}, "form: G must be 12 or 13, not 2"),
    ("haas", {"i": 4}, "line 31 of form_haas_mm.ngc: I4 must be greater than the tool radius"),
    ("haas", {"levels": 0}, "form: L must be a whole number from 1, not 0"),
    ("circle_mill", {"event": 1}, "form: G must be 0 or 7, not 1"),
    ("circle_mill", {"o": 1}, "form: the retract height 1.000000 must be above 2.000000"),
    ("bore", {"code": 13}, "form: G must be 12.5 or 13.5, not 13"),
    ("polygon", {"speed": 0}, "form: the tool's speed must be above zero, not 0"),
    ("polygon", {"coolant": 1}, "form: coolant must be 7, 8 or 9, not 1"),
    ("polygon", {"retract": 0}, "form: the retract height 0.000000 must be above the face at Z0"),
    ("slot", {"length": 4}, "form_slot_mm.ngc: length 4 must be greater than width 8"),
]


@pytest.mark.parametrize(("form", "wrong", "message"), REFUSED)
def test_a_wrong_entry_is_refused_and_nothing_is_cut(cut, form, wrong, message):
    found = cut(form, "mm", **wrong)
    assert found.error is not None
    assert message in found.error.text
    assert not cut_geometry.in_plane(cut_geometry.cutting(found.moves))


def test_two_features_of_one_program_the_second_with_the_loaded_tool(machine, tmp_path):
    first = filled_in("form_haas_mm", tmp_path / "1.ngc", tool=1, x=0).read_text()
    second = filled_in("form_haas_mm", tmp_path / "2.ngc", x=80).read_text()
    together = [line for line in first.splitlines() if "m2" not in line] + second.splitlines()
    found = machine("haas").trace_text(together)
    assert found.error is None and {move.tool for move in found.moves} == {1}
    assert {circle.x for circle in cut_geometry.full_circles(found.moves)} == {0, 80}


def test_an_entry_of_zero_leaves_its_word_out(cut):
    """A thread's K is then that of ISO, a frame's the whole depth."""
    for form, given, zero in (
        ("thread", {"tool": 2, "k": 5 - 0.5413 * 1.5, "q": 0}, {"tool": 2, "k": 0}),
        ("frame", {"tool": 2, "k": 4, "z": -4}, {"tool": 2, "k": 0, "z": -4}),
    ):
        moves = [cut_geometry.cutting(cut(form, "mm", **values).moves) for values in (given, zero)]
        ends = [[move.end[:3] for move in each] for each in moves]
        assert ends[0] == [pytest.approx(end, abs=1e-3) for end in ends[1]]


def test_the_live_tool_beside_a_main_spindle_that_is_c(tmp_path):
    """A tap is refused unless spindle 1 turns; the main spindle never does."""
    tap = {"tool": 1, "kind": 1, "feed": 1.5, "on": 3, "off": 5}
    with Tracer(SIM / "lathe_spindle_c_mm.ini", tools={1: 6.0}) as spindle_lathe:
        for spindle in (0, 1):
            path = tmp_path / f"{spindle}.ngc"
            program = filled_in("form_face_holes_mm", path, spindle=spindle, **tap).read_text()
            found = spindle_lathe.trace_text(["G0 X60 Z20", *program.splitlines()])
            assert (found.error is None) == (spindle == 1)
            assert ("M3" in [event.text for event in found.events]) == (spindle == 0)


SHOWN = {
    ini: re.findall(r"^NGCGUI_SUBFILE = (\S+)\.ngc$", ini.read_text(), re.MULTILINE)
    for ini in sorted(SIM.glob("*.ini"))
}


@pytest.mark.parametrize("ini", [ini for ini in SHOWN if SHOWN[ini]], ids=lambda ini: ini.stem)
def test_the_defaults_are_right_for_the_machines_that_show_a_form(ini, tmp_path):
    with Tracer(ini, tools={1: 0.25 if "inch" in ini.stem else 6.0}) as running:
        for form in SHOWN[ini]:
            program = filled_in(form, tmp_path / "auto.ngc")
            found = running.trace_text(["T1 M6", *program.read_text().splitlines()])
            assert found.error is None, (form, found.error)
            assert all("C has turned" in message.text for message in found.messages)
            assert cut_geometry.cutting(found.moves)


# ---------------------------------------------------------------- T0

LOADED = "T needs a number; 0 is the loaded tool, and none is loaded"


@pytest.mark.parametrize("form", FORMS)
def test_tool_0_is_the_loaded_one(cut, form):
    name = form.removeprefix("form_").removesuffix("_mm")
    assert cut(name, "mm", tool=0).error.text == f"form: {LOADED}"
    loaded = cut(name, "mm", before="G21 G8 T2 M6", tool=0)
    assert {move.tool for move in loaded.moves} == {2}
