# SPDX-License-Identifier: GPL-2.0-or-later
"""Holes with C as verify judges them: valid calls, and a bar in the way."""

import random

import pytest

from g12.tools.commands.main import main
from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from support.clamped import with_clamp
from support.judged_programs import prove
from support.sim_machines import SIM

HEAD = ["{units} G18 {mode} G40 G90 G94 G64 P0.02", "T1 M6", "S500 M3", "G0 X{x} Z{z} C100", "F{f}"]
FACE = "o<face_holes> call [3] [30] [20] [-9999] [8] [2] [120] [3] [.5] [0]"
SIDE = "o<side_holes> call [3] [-10] [20] [-9999] [40] [8] [2] [120] [-3] [0] [0]"
TAP = "o<face_hole_at> call [20] [5] [8] [2] [1.25] [0] [0] [1]"


def written(folder, *calls, units="G21", mode="G7", f=77):
    scale = 25.4 if units == "G20" else 1.0
    x = 60 / scale / (1 if mode == "G7" else 2)
    head = [line.format(units=units, mode=mode, x=x, z=10 / scale, f=f) for line in HEAD]
    path = folder / "holes.ngc"
    path.write_text("\n".join([*head, *calls, "M2", ""]))
    return path


def test_the_line_of_a_call_has_its_time_but_for_taps(tmp_path, capsys):
    program = written(tmp_path, FACE, TAP)
    assert main(["verify", str(program), "--ini", str(SIM / "lathe_mm_headless.ini")]) == 0
    holes, tap = capsys.readouterr().out.splitlines()[:2]
    fed = 3 * (10 / (120 / 60) + 0.5)  # from the retract to the depth, and the dwell
    assert holes.endswith(" s") and fed < float(holes.split()[-2]) < fed + 3
    assert tap.endswith("allowed)")


def findings(path, ini):
    return prove(path, ini, tools={1: 6.0}).finding_codes


def a_call(chance, scale):
    """Return a valid call of any kind, a tap's after its drill's; lengths are in some unit."""
    length = lambda low, high: f"[{round(chance.uniform(low, high) / scale, 4)}]"  # noqa: E731
    angle = lambda: f"[{round(chance.uniform(-360, 360), 3)}]"  # noqa: E731
    kind = chance.choice([0, 0, 0, 1, 3])
    peck = chance.choice(["[0]", length(1, 5), length(-5, -1)]) if not kind else "[0]"
    feed = length(0.5, 2) if kind == 1 else chance.choice([length(50, 900), "[-9999]"])
    levels = [length(1, 15), length(0.5, 9)]
    hole = [*levels, feed, peck, f"[{chance.choice([0, 0.5])}]", f"[{kind}]"]
    turns = [angle(), chance.choice([angle(), "[-9999]"])]
    count = f"[{chance.randint(1, 6)}]"
    name, place = chance.choice(
        [
            ("face_holes", [count, length(1, 50), *turns]),
            ("side_holes", [count, length(-50, -1), *turns, length(10, 50)]),
            ("face_hole_at", [length(-30, 30), length(-20, 20)]),
        ]
    )
    drill = [*levels, "[-9999]", "[0]", "[0]", "[0]"]
    holes = [drill, hole] if kind == 1 else [hole]
    return "\n".join(f"o<{name}> call {' '.join([*place, *each])}" for each in holes)


@pytest.mark.parametrize(
    ("units", "mode", "back"),
    [("G21", "G7", "X60 Z10"), ("G20", "G8", "X1.5 Z1"), ("G21", "G8", "X30 Z10")],
)
def test_random_valid_calls_have_no_finding(tmp_path, units, mode, back):
    chance, calls = random.Random(f"{units}{mode}"), []
    for _ in range(60):
        turned = f"C{chance.uniform(-400, 400):.3f}"
        between = chance.choice(["G91\nG90", turned, "G95 F.2\nG94 F90"])
        calls += [a_call(chance, 25.4 if units == "G20" else 1.0), f"G0 {back}", between]
    path = written(tmp_path, *calls, units=units, mode=mode)
    assert findings(path, read_ini(SIM / "lathe_mm_headless.ini")) == []


def test_a_clamp_that_is_right_has_no_finding(tmp_path):
    chance = random.Random("clamp")
    calls = [line for _ in range(40) for line in (a_call(chance, 1.0), "G0 X60 Z10")]
    section = ["C0", "G12.1", "G1 Z-1 F90", "X40 C5", "X30", "G13.1", "G0 X60 Z10"]
    slot = "o<polar_slot> call [8] [30] [1] [-9999] [-9999] [300] [-9999] [0]"
    path = written(tmp_path, *calls, *section, slot, "G0 X60 Z10", SIDE, "M10", "M11")
    clamp = with_clamp("lathe_mm", tmp_path, C_CLAMP_SHAPES="M10")
    ini = read_ini(SIM / "lathe_mm.ini").replaced(clamp)
    assert findings(path, ini) == []


def test_each_tap_has_its_pitch_in_a_trace():
    with Tracer(SIM / "lathe_mm.ini", tools={1: 6.0}) as lathe:
        traced = lathe.trace_text(["G21 G8", "T1 M6", "S5 M3", "G0 X9 Z5", TAP, TAP, "M2"])
    assert [e.text for e in traced.events if "pitch" in e.text] == ["pitch 1.25 mm"] * 2
