# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 on the stock interpreter: what the words of a section mean, and the state after it."""

from itertools import chain

import numpy as np
import pytest
from shapely.geometry import LineString, Point, Polygon

from g12.tools.preview.tracer import Tracer
from support.mode_matrix import remaps
from support.polar_programs import FIRST, Z, cut, ends, feed_moves, in_plane, section, texts, tracer
from support.sim_machines import ROOT, SIM, kept_tracer

lathe = kept_tracer("lathe_mm")


# ---------------------------------------------------------------- X, C, arcs


@pytest.mark.parametrize(
    ("setting", "mode", "x"),
    [
        ("inherit", "G8", 12), ("inherit", "G7", 6), ("diameter", "G8", 6), ("diameter", "G7", 6),
        ("radius", "G8", 12), ("radius", "G7", 12),
    ],
)  # fmt: skip
def test_x_is_a_diameter_or_a_radius(setting, mode, x):
    with tracer(POLAR_X=setting) as lathe:
        body = ["G1 X12 C3", "U-2", "G91 X2", "G90 X-12", "G3 X12 C3 I[0-#5420] J0"]
        traced = cut(lathe, *body, first=FIRST.replace("G8 ", f"{mode} "), start="G0 X40 Z5 C0")
    assert ends(traced)[:4] == [(x, 3), (x - x / 6, 3), (x, 3), (-x, 3)]


@pytest.mark.parametrize("mode", ["G7", "G8"])
@pytest.mark.parametrize("centre", ["G90.1", "G91.1"])
def test_i_and_j_are_radius_values_and_incremental_always(lathe, mode, centre):
    first = FIRST.replace("G91.1", centre).replace("G8 ", f"{mode} ")
    x = 40 if mode == "G7" else 20
    traced = cut(
        lathe, f"G1 X{x}", "G3 X0 C20 I-20", "G2 J-20", f"G3 X-{x} C0 J-20", f"G2 X{x} R20",
        first=first, start="G0 X60 Z5 C0",
    )  # fmt: skip
    assert ends(traced) == [(20, 0), (0, 20), (0, 20), (-20, 0), (20, 0)]


def test_bare_words_behind_the_section_move_in_the_mode_commanded_last(lathe):
    assert cut(lathe, "G1 X12", after=["X5"]).moves[-1].kind == "feed"
    assert cut(lathe, after=["X5"]).moves[-1].kind == "rapid"


# ---------------------------------------------------------------- actions


def test_coolant_and_speed_commanded_inside_stay(lathe):
    traced = lathe.trace_text(section("M8", "G97 S500 M3", "G1 X12")[:-1])
    assert {"M8", "M3"} <= set(traced.modes.mcodes)
    assert traced.modes.speed == 500


@pytest.mark.parametrize(
    ("commanded", "inside", "code", "blending"),
    [
        ("G64", "", "G64", (0, 0)),
        ("G64 P.1 Q.2", "", "G64", (0.1, 0.2)),
        ("G61", "", "G61", None),
        ("G64", "G61", "G61", None),
        ("G61", "G64 P.02", "G64", (0.02, 0.02)),
    ],
)
def test_path_control_is_given_back_or_stays_as_commanded(lathe, commanded, inside, code, blending):
    traced = cut(lathe, "G1 X12 C3", inside, "G9 X10", "C-3", before=[commanded])
    assert code in traced.modes.gcodes
    if blending is not None:
        assert traced.modes.blending == pytest.approx(blending)


@pytest.mark.parametrize(
    "modes", ["G18 G91.1 G8 G98", "G17 G90.1 G8 G99", "G18 G90.1 G7 G61", "G18 G91.1 G7 G98"]
)
def test_every_other_mode_is_as_before(lathe, modes):
    first = f"G21 G40 G49 G54 G80 G90 G94 G97 {modes}"
    blocks = section("G1 X12 C3", "G17 G3 I-2", "G1 X10", first=first, before=["G1"])[:-1]
    left = lathe.trace_text(blocks)
    found = lathe.trace_text(blocks[: blocks.index("G12.1")])
    assert left.error is None, left.error
    assert left.modes == found.modes


# ---------------------------------------------------------------- size correction

CENTRE = [(24, 0), (12, -12), (-15, -6), (-9, 14), (12, 12), (24, 0)]  # clockwise
TABLE = {1: 0.0, 2: 0.4, 3: -0.4}  # diameters: as programmed, smaller, larger
SIDES = {"G41": 1, "G42": -1}


def centre_path(code, levels=(-1,), tool=1):
    """Return a program that mills the tool centre's path CENTRE with leads from outside."""
    around = [f"X{x} C{c}" for x, c in CENTRE]
    body = [
        [f"{code} X28 C0", f"Z{z}", *around, "X28", "G40 X35 C0.5", "Z5", "C0", "X34"]
        for z in levels
    ]
    return section("G1 X34", *chain.from_iterable(body), start="G0 X35 Z5 C0", tool=f"T{tool} M6")


def plane_path(traced, level):
    """Return the tool's path in the plane at a Z, of moves from the programmed path's first on."""
    points = []
    for move in feed_moves(traced):
        if round(move.start[Z], 6) == round(move.end[Z], 6) == level:
            between = np.linspace(move.start, move.end, 20)
            points += [in_plane(position)[:2] for position in between]
    return LineString(points)


@pytest.mark.parametrize(
    ("code", "tool"), [("G41", 1), ("G42", 1), ("G41", 2), ("G41", 3), ("G42", 3)]
)
def test_a_negative_diameter_corrects_the_size_to_the_other_side(code, tool):
    with Tracer(SIM / "lathe_mm.ini", tools=TABLE) as lathe:
        traced = lathe.trace_text(centre_path(code, (-1, -2), tool))
    corrected = Polygon(CENTRE).buffer(SIDES[code] * TABLE[tool] / 2, 64).exterior
    leads = Point(30, 0).buffer(7)
    part = corrected.difference(leads)
    for level in (-1, -2):
        path = plane_path(traced, level).difference(leads)
        assert path.buffer(0.006).covers(part) and part.buffer(0.006).covers(path)
    told = [
        "G12.1: the loaded tool has the negative diameter -0.4 in the tool table: "
        "G41 offsets the path by 0.2 to the right, G42 to the left"
    ]
    assert [text for text in texts(traced) if "C has" not in text] == (told if tool == 3 else [])


def test_g40_needs_no_tool(lathe):
    program = [line for line in section("G40", "G1 X12") if line != "T1 M6"]
    assert ends(lathe.trace_text(program)) == [(12, 0)]


# ---------------------------------------------------------------- machines


def test_a_wrapped_axis_winds_the_same_way():
    body = ["G1 X15", *["G3 I-15"] * 3, "G2 I-15", "G1 C-8"]
    with tracer() as straight:
        plain = [move.end for move in cut(straight, *body).moves]
    overrides = {"AXIS_C": {"WRAPPED_ROTARY": 1}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as wrapped:
        traced = cut(wrapped, *body, after=["G0 C350", "C10", "G90 C-20"])
    assert [move.end for move in traced.moves[: len(plain)]] == plain
    # C-20 turns back to the 20 below
    assert [round(move.end[5]) for move in traced.moves[len(plain) :]] == [710, 730, 380]


OWN = ("G12.1 modalgroup=1 python=polar_on", "G13.1 modalgroup=1 python=polar_off")
OTHER = remaps(ROOT / "configs" / "include" / "polar_g12_3.inc")


@pytest.mark.parametrize("machine", ["lathe_mm", "lathe_mm_kinematics"])
@pytest.mark.parametrize(("pairs", "codes"), [((*OWN, *OTHER), ".1 .3"), (OTHER, ".3")])
def test_the_other_pair_of_codes_alone_and_beside_the_usual_one(machine, pairs, codes):
    overrides = {"RS274NGC": {"REMAP": (*pairs, "M33 modalgroup=10 ngc=m33")}}
    with Tracer(SIM / f"{machine}.ini", overrides=overrides) as lathe:

        def with_codes(on, off, *body):
            named = {"G12.1": f"G12{on}", "G13.1": off}
            return lathe.trace_text([named.get(line, line) for line in section(*body)])

        for on in codes.split():
            for off in codes.split():
                found = with_codes(on, f"G13{off}", "G1 X12", "U-2")
                assert ends(found) == [(12, 0), (10, 0)]
            text = with_codes(on, "M9", "G1 X12").error.text
            assert text.startswith(f"G12{on} line 8: G13{on} is missing")
            text = with_codes(on, f"G13{on}", f"G12{codes[-2:]}").error.text
            assert text == f"G12{on} line 6: the section is already on: G13{on} ends it"
            safe = lathe.trace_text([FIRST, f"G13{on}", "F100", "G1 X15", "M2"])
            assert ends(safe) == [(15, 0)]


# ---------------------------------------------------------------- the machine's INI


@pytest.mark.parametrize(
    ("turns", "wrapped", "reported"), [(1, 0, []), (2, 0, ["2.0"]), (2, 1, [])]
)
def test_turns_that_c_has_to_unwind_are_reported_once(turns, wrapped, reported):
    circle = ["G0 X20 C0", "G12.1", *["G2 I-20"] * turns, "G13.1"]
    overrides = {"AXIS_C": {"WRAPPED_ROTARY": wrapped}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        traced = lathe.trace_text([FIRST, "F300", *circle, *circle, "M2"])
    assert traced.error is None
    says = "G12.1: C has turned {} times, and G0 C0 unwinds all of it. With [AXIS_C] {} it takes"
    assert [message.text for message in traced.messages] == [
        says.format(times, "WRAPPED_ROTARY = 1") + " the short way" for times in reported
    ]
