# SPDX-License-Identifier: GPL-2.0-or-later
"""A refusal of a cycle says the line of its block, wherever that stands."""

import pytest

from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

SUBS = {
    "flat": ["o<flat> sub", "", "G12 I.1 Z-1 D1", "o<flat> endsub"],
    "event": ["o<event> sub", "o<circle_mill> call [3]", "o<event> endsub"],
    "outer": ["o<outer> sub", "o<flat> call", "o<outer> endsub"],
    "m410": ["o<m410> sub", "G13 I.1", "o<m410> endsub"],
}
RULE = "I0.1 must be greater than the tool radius 3 (D1)"
SHORT_CALL = "V0 must be greater than 0 (a call has 15 entries, -9999 leaves one out)"


@pytest.fixture(scope="module")
def mill(tmp_path_factory):
    folder = tmp_path_factory.mktemp("subs")
    for name, lines in SUBS.items():
        (folder / f"{name}.ngc").write_text("\n".join([*lines, ""]))
    lines = {
        "SUBROUTINE_PATH": f"{folder}:../../ngc:subs",
        "REMAP": (
            "G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done",
            "G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done",
            "G12.2 modalgroup=1 prolog=circle_mill_perimeter ngc=g12_circle_mill epilog=cycle_done",
            "M410 modalgroup=10 ngc=m410",
        ),
    }
    with Tracer(SIM / "mill_mm.ini", tools={1: 6.0}, overrides={"RS274NGC": lines}) as tracer:
        yield tracer


@pytest.mark.parametrize(
    ("program", "text"),
    [
        (["G12 I.1 Z-1 D1"], f"G12 line 2: {RULE}"),
        (["", "(with a comment)", "  N90 G12 I.1 Z-1 D1 (here)"], f"G12 line 4: {RULE}"),
        (["o9 sub", "G12 I.1 Z-1 D1", "o9 endsub", "", "o9 call"], f"G12 line 3: {RULE}"),
        (["o9 repeat [2]", "G12 I5 Z-1 D1", "G12 I.1 Z-1", "o9 endrepeat"], "G12 line 4: I0.1"),
        (["G12 I5 Z-1 D1", "o<outer> call"], f"G12 line 3 of flat.ngc: {RULE}"),
        (["M410"], "G13 line 2 of m410.ngc: "),
        (["o<circle_mill> call [3]"], f"circle_mill line 2: {SHORT_CALL}"),
        (["o9 sub", "o<circle_mill> call [3]", "o9 endsub", "o9 call"], "circle_mill line 3: V0"),
        (["G12 I5 Z-1 D1", "o<event> call"], f"circle_mill line 2 of event.ngc: {SHORT_CALL}"),
    ],
)
def test_the_line_of_a_refused_block(mill, program, text):
    refused = mill.trace_text(["G21 G90 G17 F100", *program, "M2"]).error
    assert refused.text.startswith(text)
    assert len(refused.text) <= 255


SECTION = ["G12.1", "G1 X#1 F500", "G4 P0", "G0 C5", "G13.1"]
RAPID = "G0 is refused: a rapid leaves the contour."


@pytest.mark.parametrize(
    ("program", "text"),
    [
        (SECTION, "G12.1 line 5: "),
        (["o9 sub", *SECTION, "o9 endsub", "o9 call [20]"], "G12.1 line 6: "),
        (["o<outer> call"], "G12.1 line 5 of flat.ngc: "),
    ],
)
def test_the_line_of_a_refused_section(tmp_path, program, text):
    (tmp_path / "flat.ngc").write_text("\n".join(["o<flat> sub", *SECTION, "o<flat> endsub", ""]))
    (tmp_path / "outer.ngc").write_text("o<outer> sub\n\no<flat> call [20]\no<outer> endsub\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"{tmp_path}:../../ngc:subs"}}
    with Tracer(SIM / "lathe_mm.ini", tools={1: 6.0}, overrides=paths) as lathe:
        refused = lathe.trace_text(["G21 G18 G8 G90 G94 G0 X30 Z2 C0", *program, "M2"]).error
    assert refused.text.startswith(text + RAPID)


def test_a_line_far_down_in_a_file_with_crlf_and_umlauts(mill, tmp_path):
    program = tmp_path / "long.ngc"
    lines = ["G21 G90 G17 F100", *["(Größe)"] * 100_000, "G12 I.1 Z-1 D1", "M2", ""]
    program.write_bytes("\r\n".join(lines).encode())
    refused = mill.trace(program).error
    assert refused.text == f"G12 line 100002: {RULE}"
    assert refused.line == 100_002
    assert refused.rule == f"G12: {RULE}"


def test_the_name_of_a_file_leaves_room_for_the_rule(tmp_path):
    name = "n" * 240
    folder = tmp_path / "subs"
    folder.mkdir()
    (folder / f"{name}.ngc").write_text(f"o<{name}> sub\nG12 I.1 Z-1 D1\no<{name}> endsub\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"{folder}:../../ngc:subs"}}
    with Tracer(SIM / "mill_mm.ini", tools={1: 6.0}, overrides=paths) as tracer:
        refused = tracer.trace_text(["G21 G90 G17 F100", f"o<{name}> call", "M2"]).error
    assert refused.text == f"G12 line 2 of {name[:80]}: {RULE}"
