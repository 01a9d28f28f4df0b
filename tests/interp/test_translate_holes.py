# SPDX-License-Identifier: GPL-2.0-or-later
"""Drilling cycles of lathes with C: the holes that their moves drill, and what is refused."""

from dataclasses import replace

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.translate.on_machine import on_machine
from g12.tools.translate.program import translate_program
from support.foreign_programs import control_of, kept_tracer_of, near, tracer_of
from support.sim_machines import PROGRAMS, SIM

X, Z, C = 0, 2, 5
PER_MINUTE = {"fanuc-lathe-b": "G94", "okuma-lathe": "G94"}


tracer = kept_tracer_of("fanuc-lathe")


def with_holes(name, **settings):
    """Return a control with settings of its drilling cycles."""
    control = control_of(name)
    return replace(control, tables={**control.tables, "holes": control.tables["holes"] | settings})


def translated(text, control):
    head = f"G21 {PER_MINUTE.get(control.name, 'G98')} G97 S500 M3\nG0 X60. Z10. C0\n"
    return translate_program(f"%\n{head}{text}\nM30\n", control)


def traced(tracer, text, control):
    result = translated(text, control)
    assert result.refused == []
    found = tracer.trace_text(result.text, alone=True)
    assert found.error is None, found.error
    return found


def holes(found, axis=Z):
    """Return for each hole: X (a radius), Z and C of its end, and the level where F begins.

    Neither C nor the other slide moves but in rapids, above all of F.
    """
    ends = []
    other = X if axis == Z else Z
    low = max(m.start[axis] for m in found.moves if m.kind == "feed")
    start = next(n for n, m in enumerate(found.moves) if m.start[X] == near(30))
    for move in found.moves[start:]:
        across = (move.start[other], move.start[C]) != (move.end[other], move.end[C])
        if across:
            assert move.kind == "rapid" and min(move.start[axis], move.end[axis]) >= low - 1e-9
        if move.kind == "feed" and move.end[axis] < move.start[axis]:
            place = (round(move.end[other], 6), round(move.end[C], 6))
            if not ends or ends[-1][0] != place:
                ends.append((place, move.start[axis], []))
            ends[-1][2].append(move.end[axis])
    return [
        (*((place[0], min(deep)) if axis == Z else (min(deep), place[0])), place[1], top)
        for place, top, deep in ends
    ]


def test_the_face_in_pecks_with_modal_blocks(tracer):
    text = "G83 X40. C0. Z-12. R-5. Q3000 F120.\nC90.\nC120.\nG80\nX50."
    found = traced(tracer, text, control_of("fanuc-lathe"))
    angles = (0, 90, 120)
    assert holes(found) == [near((20, -12, c, 5)) for c in angles]
    one = [m.end[Z] for m in found.moves if m.kind == "feed" and not m.end[C]]
    assert one == near((2, -1, -4, -7, -10, -12))
    assert [m.feed for m in found.moves if m.kind == "feed"] == near([120] * 18)
    assert found.moves[-1].kind == "rapid" and found.moves[-1].end[X] == near(25)
    stops = sum(event.text.startswith("dwell") for event in found.events)
    assert stops == 1 + 3 * 3  # before, above each hole, in it, and after it


def test_the_recorded_program_is_what_translate_makes():
    """Its moves are those of tests/programs/holes/regress; here the holes that they drill."""
    recorded = (PROGRAMS / "holes" / "from_haas.ngc").read_text()
    foreign = (PROGRAMS / "foreign" / "recorded" / "holes.nc").read_text()
    assert translate_program(foreign, control_of("haas-lathe")).text == recorded
    with tracer_of("haas-lathe") as tracer:
        found = tracer.trace_text(recorded, alone=True)
    assert found.error is None
    deep = [m.end for m in found.moves if m.kind == "feed" and (m.end[Z] < -11 or m.end[X] < 16)]
    face = [(20, -12, c) for c in (0, 90, 120, 150)]
    side = [(15, -10, 45), (15, -10, 135), (15, -15, 135)]
    assert [(end[X], end[Z], end[C]) for end in deep] == [near(each) for each in face + side]


def test_the_side_and_its_clamp(tracer):
    control = with_holes("fanuc-lathe", clamp="M10 M11")
    text = "G87 Z-10. C45. X30. R-5. F120. M10\nC135. M10\nC225. M10\nZ-15.\nG80"
    result = translated(text, control)
    lines = [line.split(" (")[0] for line in result.text.splitlines()]
    cut = lines[lines.index("M10") - 2 : lines.index("M11") + 3]
    assert cut == ["G0 Z-10. C45.", "G4 P0", "M10", "G0 X50.", "G1 X30.", "G4 P0", "G0 X50.",
                   "M11", "G0 X60.", "G4 P0"]  # fmt: skip
    assert lines.count("M10") == lines.count("M11") == 3
    found = traced(tracer, text.replace(" M10", ""), control)
    ends = [(15, -10, 45), (15, -10, 135), (15, -10, 225), (15, -15, 225)]
    assert holes(found, X) == [near((*end, 25)) for end in ends]


@pytest.mark.parametrize(
    ("control", "text", "expected"),
    [
        # R away from the part: whatever it means there, F from where the tool stands is right
        ("fanuc-lathe", "G83 X40. C0. Z-12. R5. F120.\nC90.\nG80",
         [(20, -12, c, 10) for c in (0, 90)]),
        ("fanuc-lathe", "G85 X40. Z-2. R-8. F50.\nG0 X70. C9.", [(20, -2, 0, 2)]),
        ("fanuc-lathe-b", "G99 G83 X40. Z-5. R-7. F50.\nC9.\nG98 C8.\nG80",
         [(20, -5, c, 3) for c in (0, 9, 8)]),
        ("haas-lathe", "G81 X40. C3. Z-5. R2. F50.\nC9.\nG80",
         [(20, -5, c, 2) for c in (3, 9)]),
        ("haas-lathe", "G83 Z-5. R2. Q4. F50.\nX30. R12.\nG80", [(30, -5, 0, 2), (15, -5, 0, 10)]),
    ],
)  # fmt: skip
def test_holes_in_the_face(tracer, control, text, expected):
    assert holes(traced(tracer, text, control_of(control))) == [near(each) for each in expected]


@pytest.mark.parametrize(
    ("control", "text", "top"),
    [
        ("haas-lathe", "G241 C35. X30. R52. Z-4. F50.\nC125.\nG80", 26),
        ("fanuc-lathe", "G87 C35. X30. R-4. Z-4. F50.\nC125.\nG80", 26),
    ],
)
def test_holes_in_the_side(tracer, control, text, top):
    ends = holes(traced(tracer, text, control_of(control)), X)
    assert ends == [near((15, -4, c, top)) for c in (35, 125)]


@pytest.mark.parametrize(
    ("control", "text", "start"),
    [
        ("fanuc-lathe", "G83 X40. R-5. F50.", "a drilling cycle needs Z, where the hole ends"),
        ("fanuc-lathe", "G83 X40. Z2. R-9. F50.", "R lies beyond Z2., where the hole ends"),
        ("fanuc-lathe", "G83 X40. Z2. B3.", "B3. in G83 is not translated: write each hole with"),
        ("fanuc-lathe", "G83 X40. Z-5. Q1", "15000 pecks in one cycle: at most 5000"),
        ("fanuc-lathe", "G87 Z-4. U-9. F500.", "a drilling cycle needs X, where the hole ends"),
        ("fanuc-lathe", "G83 X40. Z-5. M31", "M31 in the block of a drilling cycle"),
        ("fanuc-lathe", "G12.1\nG1 X39. F9.\nG83 X40. Z-5.", "a drilling cycle in a section"),
        ("fanuc-lathe", "G83 Z-5. F9.\nG28 H0\nC9.", "a drilling cycle may be on"),
        ("fanuc-lathe-b", "G91 G83 X4. Z-5.", "a drilling cycle of a lathe is translated under"),
    ],
)
def test_what_is_not_sure_is_refused(control, text, start):
    refused = translated(text, control_of(control)).refused
    assert refused and refused[0].sentence.startswith(start), refused
    assert refused[0].line == 4 + text.count("\n")


def test_the_spindle_becomes_c_by_the_machines_codes():
    path = SIM / "lathe_spindle_c_inch.ini"
    text = "%\nG20 M154\nG0 X2. Z1.\nM155\nM30\n"
    for ini, codes in ((path, ("M254", "M255")), (SIM / "lathe_inch.ini", ("(M154)", "(M155)"))):
        control = on_machine(control_of("haas-lathe"), read_ini(ini))
        lines = translate_program(text, control).text.splitlines()
        assert (lines[1].split()[-1], lines[3]) == codes


def test_pecks_in_the_side_are_radius_values_and_g99_stays_at_r(tracer):
    text = "G99 G87 C35. X30. R-4. Q4000 Z-4. F50.\nC125.\nG80"
    moves = traced(tracer, text, control_of("fanuc-lathe-b")).moves
    assert [m.end[X] for m in moves if m.kind == "feed"] == near((22, 18, 15) * 2)
    (turn,) = [m for m in moves if m.end[C] != m.start[C] == 35]
    assert turn.end[X] == near(26)
