# SPDX-License-Identifier: GPL-2.0-or-later
"""Recordings as text: what a trace file looks like, and that reading gives back the same."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.path.part import Part
from g12.tools.preview.moves import Error, Move
from g12.tools.regress.differences import Tolerance, differences
from g12.tools.regress.recording_text import (
    Note,
    Recording,
    TraceTextError,
    number_text,
    read_recording,
    text_of,
    without_folders,
)

STILL = (0.0,) * 9
FACTS = {"program": "a.ngc sha256:1", "machine": "m.ini sha256:2", "linuxcnc": "2.9.4"}
MM, INCH = {**FACTS, "units": "mm"}, {**FACTS, "units": "inch"}


def place(**axes):
    return tuple(axes.get(axis, 0.0) for axis in "XYZABCUVW")


def move(kind, start, end, feed=0.0, **more):
    mode = more.pop("feed_mode", "" if kind == "rapid" else "G94")
    block = more.pop("block", 1)
    return Move(kind, block, block, start, end, feed, mode, 17, -1, STILL)._replace(**more)


def test_a_trace_reads_like_this():
    up, down, right = place(Z=2.54), place(Z=-25.4), place(X=25.4, Z=-25.4)
    steps = [
        Note(2, "M3 S1000"),
        move("rapid", STILL, up, block=3),
        move("feed", up, down, 254.0, block=4),
        move("arc", down, right, 254.0, block=4, centre=(12.7, 0.0, -25.4), turns=-1),
        move("arc", right, right, 127.0, block=5, centre=(0.0, 0.0, -25.4), turns=1),
        move("feed", right, place(X=25.4, Z=-25.4, A=90.0), 360.0, block=6),
    ]
    blocks = {2: "M3 S1000", 3: "G0 Z.1", 4: "G12 I1 (pocket)", 5: "", 6: "G1 A90"}
    recording = Recording(INCH, steps, blocks, end="G1 G17 M2")
    assert text_of(recording) == (
        "g12 trace 1\n"
        "program a.ngc sha256:1\n"
        "machine m.ini sha256:2\n"
        "linuxcnc 2.9.4\n"
        "units inch\n"
        "\n2: M3 S1000\n  * M3 S1000\n"
        "\n3: G0 Z.1\n  rapid Z0.1\n"
        "\n4: G12 I1 (pocket)\n  feed Z-1 F10\n  arc X1 centre X0.5 turns -1\n"
        "\n5:\n  arc centre X0 turns 1 F5\n"
        "\n6: G1 A90\n  feed A90 F360\n"
        "\nend: G1 G17 M2\n"
    )


def test_a_refused_program_ends_with_its_error():
    recording = Recording(MM, [], {7: "G12 X"}, Error("G12: no I", 7))
    text = text_of(recording)
    assert text.endswith("\n7: G12 X\n\nerror at 7: G12: no I\n")
    assert read_recording(text) == recording


def test_zero_has_no_sign():
    assert number_text(-0.0) == "0"


def test_texts_do_not_tell_where_the_files_are():
    assert without_folders("EOF in file:/home/joe/nc/a.ngc seeking\n o100") == (
        "EOF in file:a.ngc seeking o100"
    )
    assert without_folders("F in mm/min, 1/2/3") == "F in mm/min, 1/2/3"


numbers = st.floats(-2000, 2000).map(lambda value: round(value, 7))
positions = st.tuples(*[numbers] * 9)
sorts = st.sampled_from(["rapid", "feed", "arc", "probe", "note"])
rows = st.tuples(
    sorts,
    positions,
    st.floats(0.001, 9000),
    st.sampled_from(["G93", "G94", "G95"]),
    st.sampled_from([17, 18, 19]),
    st.sampled_from([-2, -1, 1, 3]),
    st.integers(0, 4),
)


def steps_from(drawn):
    """Chain drawn rows into steps in mm."""
    at, steps = STILL, []
    for sort, end, feed, mode, plane, turns, block in drawn:
        if sort == "note":
            steps.append(Note(block, f"S{feed}"))
            continue
        arc = {"plane": plane, "turns": turns, "centre": end[2:5]} if sort == "arc" else {}
        arc["rotation"] = 12.5 if arc and plane != 17 else 0.0
        values = {} if sort == "rapid" else {"feed": feed, "feed_mode": mode}
        steps.append(move(sort, at, end, block=block, **values, **arc))
        at = end
    return steps


@given(st.lists(rows, max_size=12), st.sampled_from([MM, INCH]))
def test_reading_gives_back_what_was_written(drawn, facts):
    recording = Recording(facts, steps_from(drawn), end="G1")
    text = text_of(recording)
    again = read_recording(text)
    assert text_of(again) == text
    assert differences(recording, again, Tolerance(3e-9, 1e-3), Part(turning=False)) == []
    for step, known in zip(again.steps, recording.steps):
        assert step.block == known.block
        if isinstance(known, Move):
            assert step.start == pytest.approx(known.start, abs=3e-9)


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("g12 trace 1", "g12 trace 9", "line 1: not 'g12 trace 1'"),
        ("units mm", "units cubits", "lines 2 to 5: not program, machine, linuxcnc, units"),
        ("  feed X1 F9", "  feed XX F9", "line 8: neither a move nor a note"),
        ("  feed X1 F9", "  arc X1 F9", "line 8: neither a move nor a note"),
        ("  feed X1 F9", "  feed X1 centre X0 turns 1 F9", "line 8: neither a move nor a note"),
        ("  feed X1 F9", "<<<<<<< mine", "line 8: neither a line of the program nor its end"),
        ("\nend: M2\n", "", "the last line, end or error, is missing"),
        ("end: M2\n", "end: M2\n\njunk\n", "line 12: something after the end"),
    ],
)
def test_a_text_that_was_damaged_is_refused_with_its_line(old, new, problem):
    text = text_of(Recording(MM, [move("feed", STILL, place(X=1.0), 9.0)], end="M2"))
    assert old in text
    with pytest.raises(TraceTextError) as raised:
        read_recording(text.replace(old, new))
    assert str(raised.value) == problem
