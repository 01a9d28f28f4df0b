# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs of other controls cut what the LinuxCNC programs beside them cut."""

import pytest

from g12.tools.errors import ProgramError
from g12.tools.translate.program import translate_program
from support.foreign_programs import (
    FOREIGN,
    MACHINES,
    OPTIONS,
    assert_same_part,
    control_of,
    kept_tracers,
    near,
    path_of,
    tracer_of,
    translation,
)
from support.sim_machines import PROGRAMS, SIM

PAIRS = sorted(
    p.relative_to(FOREIGN).with_suffix("") for c in MACHINES for p in FOREIGN.glob(f"{c}/*.nc")
)


tracers = kept_tracers()


@pytest.mark.parametrize("name", PAIRS, ids=str)
def test_a_translated_program_is_the_same_part(tracers, name):
    control = name.parent.name
    text = translation(FOREIGN / f"{name}.nc", control, *OPTIONS.get(str(name), []))
    tracer = tracers(control)
    translated = tracer.trace_text(text, alone=True)
    assert_same_part(translated, tracer.trace(FOREIGN / f"{name}.ngc", alone=True))


MANUALS = FOREIGN / "manuals"


@pytest.mark.parametrize("name", ["O60121", "O60131"])
def test_the_haas_manuals_programs_unedited(tracers, name):
    printed = PROGRAMS / "haas" / f"{name}.ngc"
    text = translation(printed, "haas-mill")
    tracer = tracers("haas-mill")
    assert_same_part(tracer.trace_text(text), tracer.trace(printed))


def test_the_yasnac_manuals_example_unedited(tracers, tmp_path):
    own = tmp_path / "own.toml"  # a machine that is in millimetres and G91 when it is switched on
    own.write_text('based_on = "yasnac-mill"\ndecimals = "least"\nstart = "G17 G21 G91 G94"\n')
    tracer = tracers("yasnac-mill")
    setup = ["G21 T10 M6", "G0 X5 Y6 Z40"]
    translated = tracer.trace_text(translation(MANUALS / "yasnac.nc", own), setup=setup)
    expected = ["G17 G21 G91 G94", "G0 Z-40", "G12 I50 R40 D10 F300", "G0 Z40", "M2"]
    assert_same_part(translated, tracer.trace_text(expected, setup=setup))


@pytest.fixture(scope="module")
def manuals_lathe():
    with tracer_of("haas-lathe", tools={1: 0.5, 8: 0.0}) as opened:  # the manual's cutters, inches
        yield opened


OPEN_WORDS = ("G0 X—Z—M35", "G0 X4. Z2. M35")  # the print leaves the numbers to the reader


@pytest.mark.parametrize("name", ["method_a", "method_b"])
def test_the_open_words_of_the_print_are_refused(name):
    with pytest.raises(ProgramError, match=r":2[07]: X has no value: —Z—M35"):
        translation(MANUALS / f"{name}.nc", "fanuc-lathe")


@pytest.mark.parametrize("name", ["method_a", "method_b", "sample"])
def test_the_lathe_manuals_programs(manuals_lathe, tmp_path, name):
    printed = (MANUALS / f"{name}.nc").read_text(encoding="utf-8")
    path = tmp_path / f"{name}.nc"
    path.write_text(printed.replace(*OPEN_WORDS), encoding="utf-8")
    assert (name == "sample") == (path.read_text(encoding="utf-8") == printed)
    setup = ["G20 G0 X4 Z2 C30"]
    text = translation(path, "fanuc-lathe", "--ini", str(SIM / "lathe_inch.ini"))
    translated = manuals_lathe.trace_text(text, setup=setup)
    adapted = manuals_lathe.trace(
        PROGRAMS / "polar" / f"manual_{name.rpartition('_')[2]}.ngc", setup=setup
    )
    assert cut_at_feed(translated) == near_each(cut_at_feed(adapted))


def cut_at_feed(traced):
    """Return where each move at a feed ends, and how fast it is."""
    assert traced.error is None, traced.error
    return [(*move.end[:6], move.feed) for move in traced.moves if move.kind == "feed"]


def near_each(rows):
    """Return what equals rows of numbers to 1e-6."""
    return [near(row) for row in rows]


@pytest.mark.parametrize(
    ("control", "words", "own"),
    [
        ("fanuc-mill", "X10. Y5. (TO THE PART)", "G0 X10 Y5"),
        ("fanuc-lathe", "U10. Z5.", "G0 X10 Z5"),
    ],
)
def test_words_before_any_g0_run_as_g0_and_say_so(tracers, control, words, own):
    result = translate_program(f"G21\nN1 {words}\nZ1.\nM30\n", control_of(control))
    traced = tracers(control).trace_text(result.text, alone=True)
    start = "G7 G18 G90 G95" if "lathe" in control else "G17 G90 G94"
    expected = tracers(control).trace_text(f"{start} G21\n{own}\nZ1\nM30\n", alone=True)
    assert path_of(traced) == path_of(expected)
    (message,) = traced.messages
    assert message.text.strip() == "line 2: no G0 or G1 before it, it runs as G0"


MODES = "G90 G18 G40\nG91 G28 U0\nG90 G50 S2000\nT0101\nG97 S500 M3\nG0 X50. Z2.\nG95 G1 Z-5. F.2\n"
MODES_SAID = "G90, G91, G94, G95 are modes in this program, not cycles"


def test_modes_of_system_b_in_a_program_of_system_a(tracers):
    foreign = f"O1\nG21\n{MODES}U2.\nG91 X3. Z1.\nG90 G94 X60. F90.\nG0 W3.\nM30\n"
    own = (
        "G7 G18 G21 G90\nG53 G0 X0\nT1 M6\nS500 M3\nG0 X50 Z2\nG95 G1 Z-5 F.2\nX52\n"
        "X55 Z-4\nG94 X60 F90\nG0 Z-1\nM30\n"
    )
    result = translate_program(foreign.replace("94 X60", "94\nX60"), control_of("fanuc-lathe"))
    traced = tracers("fanuc-lathe").trace_text(result.text, alone=True)
    assert path_of(traced) == path_of(tracers("fanuc-lathe").trace_text(own, alone=True))
    assert [message.text.strip() for message in traced.messages] == [MODES_SAID]


@pytest.mark.parametrize(
    "uncertain",
    ["G90 X40. Z-9.", "G98 G1 X60. F9.", "G92 S900", "G94 X40. Z-1.", "G33 Z-9. F1.", "G77 X9."],
)
def test_what_could_be_a_cycle_leaves_the_modes_to_the_user(uncertain):
    refused = translate_program(
        f"O1\nG21\n{MODES}{uncertain}\nM30\n", control_of("fanuc-lathe")
    ).refused
    assert refused[0].line == 4
    assert "fanuc-lathe-b" in refused[0].sentence


@pytest.mark.parametrize(("decimals", "x"), [("least", 3.0), ("whole", 3000.0)])
def test_numbers_with_and_without_a_point_are_said(tracers, tmp_path, decimals, x):
    path = tmp_path / "part.nc"
    path.write_text("G21 G0 X5. Y2\nG4 X1.\nZ1.\nX3000 Y0\nM30\n")
    text = translation(path, "fanuc-mill", "--decimals", decimals)
    traced = tracers("fanuc-mill").trace_text(text, alone=True)
    assert traced.moves[-1].end[0] == near(x)
    assert [message.text.strip() for message in traced.messages] == [
        "X has a decimal point in line 1, none in line 4: look at both"
    ]


NATIVE = """\
%
(OWN)
G21 G90 G64 P0.01
o100 sub
G0 X#1
o100 endsub
o100 call [5]
#<_high> = 1
o<loop> while [#<_high> lt 3]
G0 Z#<_high> ; up
#<_high> = [#<_high> + 1]
o<loop> endwhile
M2
%
"""


def test_a_program_of_linuxcnc_stays_as_it_is(tracers):
    result = translate_program(NATIVE, control_of("fanuc-mill"))
    lines = zip(result.text.splitlines(), NATIVE.splitlines())
    assert [line for line, as_it_was in lines if line != as_it_was] == [
        "(OWN) (MSG, this is a program of LinuxCNC: it runs as it is)"
    ]
    traced = tracers("fanuc-mill").trace_text(result.text, alone=True)
    assert path_of(traced) == path_of(tracers("fanuc-mill").trace_text(NATIVE, alone=True))
    assert len(path_of(traced)) == 3 and len(traced.messages) == 1
