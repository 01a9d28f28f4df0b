# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 on the stock interpreter: what the words of a section mean, and what it leaves behind."""

import math

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from support.mode_matrix import remaps
from support.polar_programs import FIRST, ends, feed_moves, in_plane, section, texts, tracer
from support.sim_machines import ROOT, SIM

INCH = 25.4


@pytest.fixture(scope="module")
def lathe():
    with tracer() as opened:
        yield opened


@pytest.fixture(scope="module")
def inch_lathe():
    tools = {1: 12 / INCH, 2: 10 / INCH, 3: 6 / INCH}
    overrides = {"G12": {"POLAR_TOLERANCE": 0.005 / INCH}}
    with Tracer(SIM / "lathe_inch.ini", tools=tools, overrides=overrides) as opened:
        yield opened


def cut(lathe, *body, **around):
    return lathe.trace_text(section(*body, **around))


def test_the_manuals_sample_runs_with_the_machines_own_tools():
    with Tracer(SIM / "lathe_inch.ini") as lathe:
        traced = lathe.trace(ROOT / "tests/programs/polar/manual_sample.ngc")
    assert traced.error is None and traced.diameters[8] == 0.0


def part_speeds(traced):
    """Speed along the part of each segment, in mm/min: its length in the plane over its time."""
    speeds = []
    for move in feed_moves(traced):
        start, end = in_plane(move.start), in_plane(move.end)
        linear = math.hypot(move.end[0] - move.start[0], move.end[2] - move.start[2])
        travel = linear if linear > 1e-9 else abs(move.end[5] - move.start[5])
        speeds.append(math.dist(start, end) / (travel / move.feed))
    return speeds


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


def test_a_negative_radius_is_the_long_arc(lathe):
    short, long = (cut(lathe, "G1 X12", f"G3 X0 C12 R{radius}") for radius in (12, -12))
    assert ends(short) == ends(long) == [(12, 0), (0, 12)]
    turned = [traced.moves[-1].end[5] for traced in (short, long)]
    assert turned == pytest.approx([90, 90])
    assert max(move.end[0] for move in long.moves) == pytest.approx(
        12 * (1 + math.sqrt(2)), abs=0.01
    )


@pytest.mark.parametrize("units", ["G20", "G21"])
@pytest.mark.parametrize("mode", ["G7", "G8"])
def test_x_stands_still_on_an_arc_about_the_centre(lathe, units, mode):
    first = FIRST.replace("G21", units).replace("G8 ", f"{mode} ")
    traced = cut(lathe, "G1 X1.1 C.3", "G3 I-[#5420] J-.3", first=first, start="G0 X3 Z0 C0")
    arc = [move for move in feed_moves(traced) if move.line == 7]
    assert len(arc) > 0
    assert {move.end[0] for move in arc} == {arc[0].start[0]}


def test_negative_x_turns_c(lathe):
    traced = cut(lathe, "G1 C10", "X-20", "C-10", "X20", "C0")
    assert ends(traced)[1] == (-20, 10)
    assert min(move.end[0] for move in traced.moves) > 0
    assert traced.moves[-1].end[5] == pytest.approx(360)


def test_the_zero_angle_is_where_c_stands(lathe):
    traced = cut(lathe, "G1 X12 C3", "C0", start="G0 X20 Z5 C75")
    assert ends(traced, zero=75) == [(12, 3), (12, 0)]


def test_work_offsets_of_c_and_z_go_along(lathe):
    before = ["G10 L2 P1 C10 Z-3", "G92 Z1"]
    traced = cut(lathe, "G1 X12 C3", "Z-2", start="G0 X20 Z5 C75", before=before)
    assert ends(traced, zero=75)[0] == (12, 3)
    assert traced.position[2] - traced.moves[0].end[2] == pytest.approx(-3)


def test_g91_stays_behind_the_section(lathe):
    traced = cut(lathe, "G91 G1 X-8", "C3", after=["X5"])
    assert ends(traced)[:2] == [(12, 0), (12, 3)]
    assert traced.position[0] == pytest.approx(math.hypot(12, 3) + 5)


def test_bare_words_behind_the_section_move_in_the_mode_commanded_last(lathe):
    assert cut(lathe, "G1 X12", after=["X5"]).moves[-1].kind == "feed"
    assert cut(lathe, after=["X5"]).moves[-1].kind == "rapid"


# ---------------------------------------------------------------- Z


def test_z_alone(lathe):
    traced = cut(lathe, "G1 X12 C3", "Z-5 F40", "G91 Z2")
    assert [move.end[2] for move in traced.moves[-2:]] == [-5, -3]
    assert [move.feed for move in traced.moves[-2:]] == pytest.approx([40, 40])


def test_z_with_x_where_it_is_allowed():
    with tracer(POLAR_Z="allow") as lathe:
        traced = cut(lathe, "G1 X12 C3 Z-5", "G3 I-2 Z-8")
    points = [in_plane(move.end) for move in feed_moves(traced)]
    assert points[-1] == pytest.approx((12, 3, -8))
    assert part_speeds(traced)[:-1] == pytest.approx([100] * (len(points) - 1), rel=0.02)


# ---------------------------------------------------------------- feed


@pytest.mark.parametrize(
    ("before", "body", "speed"),
    [
        ([], "F250", 250),
        ([], "G94 F250", 250),
        ([], "G98 F250", 250),
        (["G95 F.5 S500 M3"], "", 250),
        (["S500"], "G99 F.5", 250),
        (["S500"], "G95 F.5", 250),
        (["G95 F.5 S500"], "G98 F60", 60),
        (["G95 F.5 S500"], "S1000", 500),
    ],
)
def test_feed_is_the_speed_along_the_part(lathe, before, body, speed):
    traced = cut(lathe, body, "G1 C15", "G3 X-10 C0 R20", before=before)
    assert part_speeds(traced) == pytest.approx([speed] * len(feed_moves(traced)), rel=0.02)


def test_the_speed_may_come_inside_the_section_and_feed_per_revolution_behind_it(lathe):
    traced = cut(lathe, "G1 C2", "S100", "G95 F.1 C4")
    assert part_speeds(traced)[0] == pytest.approx(100, rel=0.02)
    assert part_speeds(traced)[-1] == pytest.approx(10, rel=0.02)


def test_feed_mode_and_f_commanded_inside_stay(lathe):
    for code, kept in (("G95 F.2", "G95"), ("G99 F.2", "G95"), ("G98 F60", "G94")):
        traced = cut(lathe, f"{code} G1 X12", before=["S500"], after=["X5 C0"])
        assert traced.moves[-1].feed_mode == kept
        assert traced.moves[-1].feed == pytest.approx(float(code.split("F")[1]))


def test_f_of_the_other_feed_mode_is_forgotten(lathe):
    traced = cut(lathe, "G1 X12", "G99 X10", before=["S500"])
    assert traced.error.text == "G12.1 line 8: F0 must be above zero (no feed commanded?)"


def test_rapids_as_feeds():
    with tracer(POLAR_G0="feed", POLAR_G0_FEED=1500) as lathe:
        traced = cut(lathe, "G0 X12 C3", "C-3", "G1 X10", "G0 Z2", after=["X20"])
        assert ends(traced)[:3] == [(12, 3), (12, -3), (10, -3)]
        assert part_speeds(traced)[0] == pytest.approx(1500, rel=0.02)
        assert traced.moves[-1].kind == "rapid"
        inch = lathe.trace_text(
            section("G0 X.5 C.1", first=FIRST.replace("G21", "G20"), start="G0 X1 Z0 C0")
        )
        assert part_speeds(inch)[0] == pytest.approx(1500, rel=0.02)


# ---------------------------------------------------------------- compensation


FLAT = ["G1 C9", "G1 {on} X12", "C-9", "G40 X20"]


@pytest.mark.parametrize(("on", "x"), [("G41", 18), ("G42", 6)])
def test_compensation_by_half_the_loaded_tools_diameter(lathe, on, x):
    traced = cut(lathe, *(block.format(on=on) for block in FLAT))
    assert ends(traced) == [(20, 9), (x, 9), (x, -9), (20, -9)]


def test_compensation_in_inches_on_a_metric_machine(lathe):
    body = ["G1 C.9", "G1 G41 X1.2", "C-.9", "G40 X2"]
    traced = cut(lathe, *body, first=FIRST.replace("G21", "G20"), start="G0 X2 Z0 C0", feed="F9")
    assert ends(traced)[1] == (round(1.2 * INCH + 6, 6), round(0.9 * INCH, 6))


def test_offset_zero_is_legal():
    with Tracer(SIM / "lathe_mm.ini", tools={1: 0.0}) as lathe:
        traced = cut(lathe, *(block.format(on="G41") for block in FLAT))
    assert ends(traced) == [(20, 9), (12, 9), (12, -9), (20, -9)]


def test_actions_between_the_blocks_of_a_compensated_corner(lathe):
    plain = ["G1 C9", "G41 X12", "C-9", "G2 X-12 R15", "G1 C9", "G40 X-20"]
    busy = ["G1 C9", "M8", "(MSG, x)", "G41 X12 (ramp)", "Z-2", "S500", "C-9", "M9"]
    busy += ["G2 X-12 R15", "#1=2", "G1 C9", "Z5", "G40 X-20"]
    points = [set(ends(cut(lathe, *body))) for body in (plain, busy)]
    assert points[0] == points[1]


# ---------------------------------------------------------------- actions


def test_actions_keep_their_place_among_the_moves(lathe):
    body = ["G1 X12", "(MSG, one)", "X10 M8 (two)", "G4 P.5", "X8", "S500 M3", "X6 (MSG, three)"]
    traced = cut(lathe, *body)
    assert texts(traced) == ["one", "three"]
    assert ends(traced) == [(12, 0), (10, 0), (8, 0), (6, 0)]


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
        ("G61.1", "", "G61.1", None),
        ("G64", "G61", "G61", None),
        ("G61", "G64 P.02", "G64", (0.02, 0.02)),
        ("G64 P.1", "G64", "G64", (0, 0)),
    ],
)
def test_path_control_is_given_back_or_stays_as_commanded(lathe, commanded, inside, code, blending):
    traced = cut(lathe, "G1 X12 C3", inside, "G9 X10", "C-3", before=[commanded])
    assert code in traced.modes.gcodes
    if blending is not None:
        assert traced.modes.blending == pytest.approx(blending)


SPY = """\
import sys
sys.path.insert(0, "{python}")
import remap
from g12.host.section.output import PathControl
within = PathControl.within = getattr(PathControl, "within", PathControl.inside)  # loaded twice
def spied(self, turning):
    within(self, turning)
    self.interp.params[7] = self.interp.active_settings[3]
PathControl.inside = spied
"""


@pytest.mark.parametrize(("units", "tolerance"), [("G21", 0.0025), ("G20", 0.0025 / INCH)])
def test_segments_are_blended_with_half_the_tolerance(tmp_path, units, tolerance):
    toplevel = tmp_path / "toplevel.py"
    toplevel.write_text(SPY.format(python=SIM.parents[1] / "python"))
    program = section("G1 X7 C3", "X2 C5", first=FIRST.replace("G21", units), start="G0 X8 Z0 C0")
    with Tracer(SIM / "lathe_mm.ini", overrides={"PYTHON": {"TOPLEVEL": str(toplevel)}}) as lathe:
        assert lathe.trace_text(program, ask=[7]).numbered[7] == pytest.approx(tolerance)


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


# ---------------------------------------------------------------- machines


def test_inches_and_millimetres_make_the_same_machine_path(lathe, inch_lathe):
    body = ["G1 C{9}", "G41 X{12}", "Z{-2}", "C-{9}", "G2 X-{12} R{15}", "G1 C{9}", "G40 X-{20}"]
    paths = []
    for machine in (lathe, inch_lathe):
        for units, factor in (("G21", 1.0), ("G20", 1 / INCH)):
            first = FIRST.replace("G21", units)
            program = section(*body, first=first, start="G0 X{20} Z{5} C0", feed="F{100}")
            traced = machine.trace_text([_scaled(line, factor) for line in program])
            paths.append([(*move.end, move.feed) for move in feed_moves(traced)])
    for path in paths[1:]:
        assert len(path) == len(paths[0])
        for one, other in zip(paths[0], path):
            assert one == pytest.approx(other, rel=1e-6, abs=1e-6)


def _scaled(line, factor):
    parts = line.replace("{", "}").split("}")
    return "".join(
        f"{float(part) * factor:.9f}" if at % 2 else part for at, part in enumerate(parts)
    )


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


@pytest.mark.parametrize("machine", ["lathe_mm", "lathe_mm_kinematics"])
def test_the_other_pair_of_codes(machine):
    pair = remaps(ROOT / "configs" / "include" / "polar_g12_3.inc")
    overrides = {"RS274NGC": {"REMAP": (*pair, "M33 modalgroup=10 ngc=m33")}}
    with Tracer(SIM / f"{machine}.ini", overrides=overrides) as lathe:
        traced = lathe.trace_text([line.replace(".1", ".3") if line in ("G12.1", "G13.1") else line
                                   for line in section("G1 X12", "U-2")])  # fmt: skip
        assert ends(traced) == [(12, 0), (10, 0)]
        assert ends(lathe.trace_text([FIRST, "G13.3", "F100", "G1 X15", "M2"])) == [(15, 0)]
        refused = lathe.trace_text(
            ["G12.3" if line == "G12.1" else line for line in section("G1 X12")[:-2]]
        )
    assert refused.error.text == "G12.3 line 6: G13.3 is missing: the program ends before it"


def test_both_pairs_of_codes_on_one_machine():
    pairs = [f"G{on}.{pair} modalgroup=1 python=polar_{name}"
             for pair in (1, 3) for on, name in ((12, "on"), (13, "off"))]  # fmt: skip
    lines = [*pairs, "M33 modalgroup=10 ngc=m33"]
    with Tracer(SIM / "lathe_mm.ini", overrides={"RS274NGC": {"REMAP": lines}}) as lathe:

        def with_codes(on, off, *body):
            program = section(*body)
            return lathe.trace_text(
                [{"G12.1": on, "G13.1": off}.get(line, line) for line in program]
            )

        for on in ("G12.1", "G12.3"):
            for off in ("G13.1", "G13.3"):
                assert ends(with_codes(on, off, "G1 X12", "U-2")) == [(12, 0), (10, 0)]
            refused = with_codes(on, "M9", "G1 X12")
            assert refused.error.text.startswith(f"{on} line 8: G13{on[3:]} is missing")
            refused = with_codes(on, "G13.1", "G12.3")
            assert (
                refused.error.text == f"{on} line 6: the section is already on: G13{on[3:]} ends it"
            )


# ---------------------------------------------------------------- the machine's INI


def on_lathe(name, overrides, *body, tools=None, **around):
    with Tracer(SIM / name, overrides=overrides, tools=tools) as lathe:
        return cut(lathe, *body, **around)


def test_a_machine_unit_may_be_a_number():
    body = ["G1 X12 C0", "G3 X-12 C0 I-12 J0", "U-2"]
    machines = [
        ("lathe_inch.ini", "inch", {1: 0.5}),
        ("lathe_inch.ini", f"{1 / INCH:.12f} # units per mm", {1: 0.5}),
        ("lathe_mm.ini", "mm", {1: 12.7}),
        ("lathe_mm.ini", "1.0", {1: 12.7}),
    ]
    traces = [
        on_lathe(name, {"TRAJ": {"LINEAR_UNITS": text}}, *body, tools=tools)
        for name, text, tools in machines
    ]
    moves = [[move.end for move in traced.moves] for traced in traces]
    assert np.allclose(moves[0], moves[1], atol=1e-6)
    assert np.allclose(moves[2], moves[3], atol=1e-6)


def test_the_first_of_repeated_limits_counts():
    refused = on_lathe("lathe_mm.ini", {"AXIS_X": {"MAX_LIMIT": [100, 300]}}, "G1 X150")
    assert refused.error.text.endswith("the X axis would go to 150 mm, beyond its limit 100 mm")


def test_keywords_of_remap_lines_may_be_shortened(tmp_path):
    (tmp_path / "m33.ngc").write_text("o<m33> sub\nG1 X9\no<m33> endsub\n")
    lines = [
        "G12.4 modal=1 py=polar_on",
        "G13.5 MODALGROUP=1 Py=polar_off # another pair",
        "M33 modalgroup=10 n=m33",
    ]
    overrides = {"RS274NGC": {"REMAP": lines, "SUBROUTINE_PATH": f"{tmp_path}:../../ngc:subs"}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        codes = {"G12.1": "G12.4", "G13.1": "G13.5"}
        program = [codes.get(line, line) for line in section("G1 X12", "M33", "U-2")]
        assert ends(lathe.trace_text(program)) == [(12, 0), (9, 0), (7, 0)]


@pytest.mark.parametrize(("turns", "wrapped", "told"), [(1, 0, []), (2, 0, ["2.0"]), (2, 1, [])])
def test_turns_that_c_has_to_unwind_are_reported_once(turns, wrapped, told):
    circle = ["G0 X20 C0", "G12.1", *["G2 I-20"] * turns, "G13.1"]
    overrides = {"AXIS_C": {"WRAPPED_ROTARY": wrapped}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        traced = lathe.trace_text([FIRST, "F300", *circle, *circle, "M2"])
    assert traced.error is None
    says = "G12.1: C has turned {} times, and G0 C0 unwinds all of it. With [AXIS_C] {} it takes"
    assert [message.text for message in traced.messages] == [
        says.format(times, "WRAPPED_ROTARY = 1") + " the short way" for times in told
    ]
