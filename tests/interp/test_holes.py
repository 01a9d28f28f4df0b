# SPDX-License-Identifier: GPL-2.0-or-later
"""Holes with C on the stock interpreter: modes, clamp, a tool beside X, refusals.

What valid calls drill is proved in test_verify_holes.py.
"""

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from support.clamped import with_clamp
from support.sim_machines import SIM, kept_tracer

X, Z, C = 0, 2, 5
LEFT = -9999
START = ["G21 G18 G7 G90 G94 G64 P.02", "T1 M6", "S500 M3", "G0 X60 Z10 C100", "F77"]
FACE = dict(count=3, circle_diameter=30, first_angle=20, step_angle=LEFT, depth=8, retract=2,
            feed=120, peck=0, dwell=0, kind=0)  # fmt: skip
SIDE = dict(count=2, z=-10, first_angle=30, step_angle=270, surface_diameter=40, depth=8,
            retract=2, feed=120, peck=0, dwell=0, kind=0)  # fmt: skip
AT = dict(x=20, c=5, depth=8, retract=2, feed=120, peck=0, dwell=0, kind=0)
CALLS = {"face_holes": FACE, "side_holes": SIDE, "face_hole_at": AT}

HOLES = ("face_holes", "side_holes", "face_hole_at")
SHAPES = ("polar_polygon", "polar_slot", "polar_pocket")


lathe = kept_tracer("lathe_mm", tools={1: 6.0})


def call(name, **changed):
    values = {**CALLS[name], **changed}.values()
    return f"o<{name}> call {' '.join(f'[{value:.9f}]' for value in values)}"


def program(*blocks):
    return [*START, *blocks, "M2"]


def drilled(traced):
    """Return X (radius), Z, C of the deepest end of every run of feed moves at one place."""
    assert traced.error is None, traced.error
    ends = {}
    for move in traced.moves:
        if move.kind == "feed":
            place = round(move.end[C], 6)
            ends.setdefault(place, []).append((move.end[X], move.end[Z], place))
    return [min(points) for points in ends.values()]


@pytest.mark.parametrize(
    "modes", ["G91 G95 F0.3 G61 G1", "G90 G94 G64 P0.02 G0", "G8 G91.1 G2 X25 Z5 R9"]
)
def test_modes_and_f_are_afterwards_as_before(lathe, modes):
    before = program(modes)
    ends = [
        lathe.trace_text([*lines[:-1], "(print,#<_feed>)"])
        for lines in (before, [*before[:-1], call("face_holes"), "M2"])
    ]
    assert ends[1].error is None
    assert ends[0].printed == ends[1].printed
    path = [set(end.modes.gcodes) for end in ends]
    assert path[0] == path[1] and ends[0].modes.blending == ends[1].modes.blending


@pytest.mark.parametrize("name", HOLES)
def test_entries_are_absolute_under_g91_too(lathe, name):
    absolute, incremental = (
        lathe.trace_text(program(modes, call(name))) for modes in ("G90", "G91")
    )
    ends = [[(move.kind, move.end) for move in each.moves] for each in (absolute, incremental)]
    assert len(ends[0]) >= 8 and ends[0] == ends[1]


def test_on_a_wrapped_axis_too_c_turns_the_shorter_way():
    overrides = {"AXIS_C": {"WRAPPED_ROTARY": 1}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides, tools={1: 6.0}) as lathe:
        traced = lathe.trace_text(program(call("face_holes", first_angle=-30, step_angle=-100)))
    assert [c % 360 for _, _, c in drilled(traced)] == pytest.approx([330, 230, 130])
    turns = [move.end[C] - move.start[C] for move in traced.moves[1:]]
    assert [turn for turn in turns if abs(turn) > 1e-9] == pytest.approx([-130, -100, -100])


def test_a_tool_beside_the_x_line_drills_where_it_should():
    overrides = {"G12": {"POLAR_TOOL_OFFSET": 9}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides, tools={1: 6.0}) as lathe:
        traced = lathe.trace_text(program(call("face_holes")))
        refused = lathe.trace_text(program(call("side_holes")))
    ends = [move.end for move in traced.moves if move.kind == "feed"]
    points = [complex(end[X], end[1]) * np.exp(1j * np.radians(end[C])) for end in ends]
    drawn = [15 * np.exp(1j * np.radians(c)) for c in (20, 140, 260)]
    assert np.allclose(points, drawn, atol=1e-6)
    assert "needs a tool on the X line" in refused.error.text


SECTIONS = {
    "polar": ["C0", "G12.1", "G1 X40 C5", "X30", "G13.1"],
    "cylinder": ["G7.1 C20", "G1 C30 Z3", "G7.1 C0"],
    "shape": ["C0", "o<polar_slot> call [8] [30] [1] [-9999] [-9999] [300] [-9999] [0]"],
}


@pytest.mark.parametrize("name", SECTIONS)
def test_sections_and_shapes_are_cut_with_a_light_drag(tmp_path, name):
    overrides = with_clamp("lathe_mm", tmp_path, C_CLAMP_SHAPES="M12")
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides, tools={1: 6.0}) as lathe:
        traced = lathe.trace_text(program(*SECTIONS[name], "(DEBUG,#<_c>)"))
    assert traced.error is None, traced.error
    drag, off = [e.at for e in traced.events if e.text in ("message m12", "message m11")]
    cuts = [n for n, move in enumerate(traced.moves) if move.kind != "rapid"]
    assert drag == cuts[0] and off in (cuts[-1] + 1, cuts[-1] + 2) and cuts


A_REMAP = "a REMAP line?"


@pytest.mark.parametrize("name", ["lathe_mm", "lathe_mm_kinematics"])
@pytest.mark.parametrize("block", ["G12.1", call("face_holes")])
@pytest.mark.parametrize(
    ("settings", "code", "cure"),
    [
        ({"C_CLAMP": "M10 M14"}, "C_CLAMP: M14", A_REMAP),
        ({"C_CLAMP": "M14 M11"}, "C_CLAMP: M14", A_REMAP),
        ({"C_CLAMP_SHAPES": "M14"}, "C_CLAMP_SHAPES: M14", A_REMAP),
        ({"C_CLAMP": "M10 M111"}, "C_CLAMP: M111", "an executable file M111?"),
    ],
)  # fmt: skip
def test_a_clamp_of_which_one_code_is_unknown_is_refused(
    tmp_path, name, block, settings, code, cure
):
    overrides = with_clamp(name, tmp_path, **{"C_CLAMP_SHAPES": "M8", **settings})
    (tmp_path / "M111").touch(mode=0o644)
    overrides["RS274NGC"]["USER_M_PATH"] = str(tmp_path)
    with Tracer(SIM / f"{name}.ini", overrides=overrides) as lathe:
        traced = lathe.trace_text(program(block, "G1 X3", "G13.1"))
    what = "G12.1" if block == "G12.1" else "face_holes"
    assert traced.error.text == f"{what} line 6: [G12] {code} is no code of this machine: {cure}"
    assert len(traced.moves) == 1


def test_a_call_that_is_too_short_has_zeros_at_its_end(lathe):
    text = call("face_holes")
    short, kind = text[: text.rindex(" [")], text[text.rindex("[") :]
    traces = [lathe.trace_text(program(each)) for each in (short, f"{short} [0]")]
    assert (
        kind == "[0.000000000]" and traces[0].error is None and traces[0].moves == traces[1].moves
    )
    shorter = short[: short.index("]") + 1]
    error = lathe.trace_text(program(shorter)).error
    assert error.text.startswith("face_holes line 6: circle_diameter 0 must be greater")


@pytest.mark.parametrize(
    ("block", "entries", "rule"),
    [
        ("G93", {}, "needs G94 or G95, not G93"),
        ("G0 Z-1", {}, "Z-1: the tool must be above the face at Z0"),
        ("", dict(depth=2000), "the Z axis would go to -2000 mm, beyond its limit -500 mm"),
        ("", dict(circle_diameter=9000), "the X axis would go to 4500 mm (radius), beyond its"),
    ],
)
def test_where_no_hole_can_be_made(lathe, block, entries, rule):
    traced = lathe.trace_text(program(block, call("face_holes", **entries)))
    assert traced.error.text.startswith(f"face_holes line 7: {rule}")
    assert traced.error.line == 7 and not [m for m in traced.moves if m.line == 7]


@pytest.mark.parametrize("name", [*HOLES, *SHAPES])
@pytest.mark.parametrize(("on", "off"), [("G12.1", "G13.1"), ("G7.1 C20", "G7.1 C0")])
def test_inside_a_section_the_refusal_says_what_to_write(lathe, name, on, off):
    inside = [on, f"N7 o<{name.upper()}> call [1] (here)", off]
    traced = lathe.trace_text(program("C0", *inside))
    assert traced.error.text == (
        f"{on.split()[0]} line 8: o<{name}> must be called outside of a section: "
        f"{off} in the line before it, {on.split()[0]} again after it"
    )
    assert traced.error.line == 8 and len(traced.moves) == 2


spindle_lathe = kept_tracer("lathe_spindle_c_mm", tools={1: 6.0})


@pytest.mark.parametrize(
    ("blocks", "why"),
    [
        ([], "M3 and S, $1 beside them"),
        (["S500 M3", "M3 $1"], "M3 and S, $1 beside them"),
        (["S500 M4 $1"], "M3 and S, $1 beside them"),
        (["S500 M3 $1"], None),
    ],
)
def test_a_tap_is_the_live_tools_where_the_main_spindle_is_c(spindle_lathe, blocks, why):
    head = ["G21 G18 G7 G90 G94", "T1 M6", "G0 X60 Z10", *blocks]
    tap = call("face_hole_at", kind=1, feed=1.5)
    traced = spindle_lathe.trace_text([*head, tap, "M2"])
    if why:
        assert traced.error.text.endswith(f"the tool's spindle must turn, by {why}")
        assert len(traced.moves) == 1
    else:
        assert traced.error is None and "pitch 1.5 mm" in [e.text for e in traced.events]


def test_the_spindle_in_use_is_afterwards_the_same(spindle_lathe):
    """LinuxCNC refuses G33.1 where the one in use stands: here spindle 0 does."""
    head = ["G21 G18 G7 G90 G94", "T1 M6", "G0 X60 Z10", "S500 M3 $1"]
    tap = call("face_hole_at", kind=1, feed=1.5)
    for code, works in (("G97 S200", False), ("S500 G97 $1", True)):
        traced = spindle_lathe.trace_text([*head, code, tap, "G33.1 Z5 K1", "M2"])
        assert (traced.error is None) == works, traced.error
        assert works or "not turning in G33.1" in traced.error.text
