# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A and B on a mill: words, refusals, settings, and what AXIS shows of the part.

Its geometry is proved in test_valid_cuts.py; what a lathe's cylinder shares is in test_cylinder.py.
"""

import math
import re
from functools import partial
from itertools import groupby

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from support import polar_programs
from support.sim_machines import SIM, kept_tracer

FIRST = polar_programs.FIRST.replace("G18", "G17")
mill_a = kept_tracer("mill_a_mm", overrides={"G12": {"CYLINDER_X": "refuse"}})


# ---------------------------------------------------------------- words, messages, settings

R = 20.0
section = partial(
    polar_programs.section, first=FIRST, start="G0 X0 Y0 Z22 A0", tool="T3 M6", feed="F250",
    on=f"G07.1 A{R:g}", off="G07.1 A0",
)  # fmt: skip


def ends(traced):
    """Return X, Z and A at the end of each block that moved at a feed."""
    blocks = groupby(polar_programs.feed_moves(traced), key=lambda move: move.line)
    last = [list(moves)[-1].end for _, moves in blocks]
    return [tuple(round(end[axis], 6) + 0.0 for axis in (0, 2, 3)) for end in last]


def traced(text, **overrides):
    with Tracer(SIM / "mill_a_mm.ini", overrides=overrides) as tracer:
        return tracer.trace_text(text)


def test_x_is_a_length_and_a_an_angle_that_goes_on_after_the_section(mill_a):
    after = ["G90 G1 A5", "G91 A1 X2"]
    text = section("G1 Z18", "X-10", "A90", "X-20 A-720.5", "G91 A1", "X1 A-1", after=after)
    assert ends(mill_a.trace_text(text)) == [
        (0, 18, 0), (-10, 18, 0), (-10, 18, 90), (-20, 18, -720.5), (-20, 18, -719.5),
        (-19, 18, -720.5), (-19, 18, 5), (-17, 18, 6),
    ]  # fmt: skip


def test_f_is_the_speed_along_the_surface(mill_a):
    """LinuxCNC takes F for X, and for degrees where X does not move."""
    moves = polar_programs.feed_moves(mill_a.trace_text(section("G1 A-90", "X10 A-180", "Z30")))
    assert [move.feed for move in moves] == pytest.approx(
        [250 * 180 / math.pi / R, 250 * 10 / math.hypot(10, math.pi * R / 2), 250]
    )


def test_wrapped_rotary_turns_on_inside_and_takes_the_short_way_after():
    text = section("G1 A-400", "A-370", after=["G0 A350", "A10"])
    wrapped = traced(text, AXIS_A={"WRAPPED_ROTARY": "1"})
    assert wrapped.error is None
    turned = [move.end[3] for move in wrapped.moves][-4:]
    assert turned == pytest.approx([-400, -370, -370, -350])


CYLINDER = "G7.1 modalgroup=1 python=cylinder_mode"


def test_a_drag_of_the_rotary_axis_begins_and_ends_the_section(tmp_path):
    for code in (12, 11):
        (tmp_path / f"m{code}.ngc").write_text(
            f"o<m{code}> sub\n(debug, M{code})\no<m{code}> endsub\n"
        )
    codes = [f"M{code} modalgroup=10 ngc=m{code}" for code in (12, 11)]

    def found(remaps):
        paths = {"REMAP": [*remaps, CYLINDER], "SUBROUTINE_PATH": f"../../ngc:{tmp_path}"}
        text = section("(debug, in)", "G1 X5", after=["(debug, after)"])
        return traced(text, RS274NGC=paths, G12={"ROTARY_DRAG": "M12 M11"})

    assert polar_programs.texts(found(codes)) == ["M12", "in", "M11", "after"]
    unknown = found(codes[1:])
    assert unknown.error.text == (
        "G7.1 line 5: [G12] ROTARY_DRAG: M12 is no code of this machine: a REMAP line?"
    )


INSIDE = [
    ("Y3", "Y is refused: Y stays on the axis of rotation inside the section"),
    ("G18", "G18 is refused: the section's plane is X-A"),
    ("C3", "C is refused: the section's words are X, A, Z, I and J"),
    ("G7.1 C30", "C is refused: the section's words are X, A, Z, I and J"),
    ("G1 Z5 X3", "Z needs a block of its own, or [G12] CYLINDER_X = allow"),
    ("G1 A1e5", "the A axis would go to 100000 degrees, beyond its limit 99999 degrees"),
]  # fmt: skip


@pytest.mark.parametrize(("block", "why"), INSIDE)
def test_refused_inside(mill_a, block, why):
    text, line = polar_programs.refused(
        mill_a, section("G1 X0", "A1", "A0", block.replace("1e5", "100000"), "G1 X1")
    )
    assert (text, line) == (f"G7.1 line 9: {why}", 9)


def test_refused_to_begin(mill_a):
    text, _ = polar_programs.refused(mill_a, section("G1 X5", start="G0 X5 Y0.5 Z22"))
    assert text.endswith("needs Y0: the tool must stand on the axis of rotation, not at Y0.5")


# ---------------------------------------------------------------- as AXIS draws it


def drawn_by_axis(geometry, position):
    """Return the point of the part that AXIS draws for a position (vertex9 of its emcmodule.cc).

    It reads GEOMETRY from its end; B turns there from Z to X-, not to X+.
    """
    x = y = z = 0.0
    for sign, letter in reversed(re.findall("(-?)([XYZAB])", geometry)):
        value = -position[letter] if sign else position[letter]
        cos, sin = math.cos(math.radians(value)), math.sin(math.radians(value))
        if letter == "A":
            y, z = y * cos - z * sin, y * sin + z * cos
        elif letter == "B":
            x, z = x * cos - z * sin, x * sin + z * cos
        else:
            x, y, z = (at + value * (letter == own) for at, own in zip((x, y, z), "XYZ"))
    return x, y


@pytest.mark.parametrize(
    ("turn", "geometry", "sense"),
    [
        ("A", read_ini(SIM / "mill_a_mm.ini").get("DISPLAY", "GEOMETRY"), 1.0),
        ("A", "-AXYZ!", -1.0),
        ("B", "-BXYZ!", 1.0),
    ],
)
def test_a_drawing_reads_right_on_the_part_that_axis_shows(turn, geometry, sense):
    """Seen from the tool, X is to the right and Y upwards, as on the flat drawing."""
    radius = 25.0
    for x, y in ((3.0, 4.0), (-3.0, 4.0), (3.0, -4.0)):
        words = {"X": x, "Y": y, "Z": radius}
        letter = {"A": "Y", "B": "X"}[turn]
        grows = {"A": -sense, "B": sense}[turn]
        words[turn] = math.degrees(grows * words.pop(letter) / radius)
        shown = drawn_by_axis(geometry, dict.fromkeys("XYZAB", 0.0) | words)
        flat = {"A": (x, radius * math.sin(y / radius)), "B": (radius * math.sin(x / radius), y)}
        assert shown == pytest.approx(flat[turn])
