# SPDX-License-Identifier: GPL-2.0-or-later
"""A refused section: G41 for G42 is asked about, `plot` draws it up to the refused line."""

import pytest

from g12.tools.commands.main import main
from g12.tools.plot.refused import with_refused_contour
from g12.tools.preview.tracer import Tracer
from support.polar_programs import in_plane
from support.sim_machines import PROGRAMS, SIM, kept_tracer

HEXAGON = (PROGRAMS / "polar" / "hexagon.ngc").read_text()
WRONG_SIDE = HEXAGON.replace("G41 ", "G42 ")
LATHE = SIM / "lathe_mm_headless.ini"
TIGHT = "cannot follow both lines 10 and 15: beside one of them it cuts into the other"


lathe = kept_tracer("lathe_mm")


def test_a_closed_contour_on_the_wrong_side_is_asked_about(lathe):
    assert lathe.trace_text(HEXAGON).error is None
    assert lathe.trace_text(WRONG_SIDE).error.text.endswith(f"{TIGHT}. G41?")


def test_where_neither_side_can_be_cut_nothing_is_asked(lathe):
    across = lathe.trace_text(HEXAGON.replace("G40 X60.", "G40 X-60.")).error
    assert "beside one of them it cuts into the other" in across.text and "?" not in across.text


def test_a_refused_section_is_drawn_without_compensation(tmp_path, capsys):
    program, picture = tmp_path / "wrong.ngc", tmp_path / "wrong.svg"
    program.write_text(WRONG_SIDE)
    assert main(["plot", str(program), "--ini", str(LATHE), "-o", str(picture)]) == 1
    said = capsys.readouterr()
    assert said.out == f"{picture} written\n"
    assert said.err.endswith(f"g12 plot: {program}:15: G12.1: the tool of radius 6 {TIGHT}. G41?\n")
    assert "refused in line 15" in picture.read_text()
    with Tracer(LATHE) as opened:
        refused = opened.trace(program)
        drawn = with_refused_contour(program, opened.ini, refused, None).moves
    assert drawn[: len(refused.moves)] == refused.moves
    c = [in_plane(move.end)[1] for move in drawn if move.block == 11]
    assert c[-1] == pytest.approx(-15.5885, abs=1e-3)  # a corner of the drawing
    assert {move.block for move in drawn} == {5, *range(7, 16)}
    assert all(move.tool == 0 for move in drawn[len(refused.moves) :])
