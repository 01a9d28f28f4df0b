# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 plot``: the texts beside a picture, cuts on the face and in the side, refused sections."""

import re

import pytest

from g12.tools.commands.main import main
from g12.tools.machine.ini import read_ini
from g12.tools.plot.refused import with_refused_contour
from g12.tools.preview.tracer import Tracer
from support.polar_programs import in_plane
from support.sim_machines import PROGRAMS, SIM, kept_tracer

HEXAGON = (PROGRAMS / "polar" / "hexagon.ngc").read_text()
WRONG_SIDE = HEXAGON.replace("G41 ", "G42 ")
LATHE = SIM / "lathe_mm_headless.ini"
TIGHT = "cannot follow both lines 10 and 15: beside one of them it cuts into the other"

HOLES = "G0 X60 Z5\no<side_holes> call [4] [-10] [45] [-9999] [40] [8] [2] [120] [-3] [0] [0]\nM2\n"
GROOVE = (PROGRAMS / "cylinder" / "cam_groove.ngc").read_text()

FIRST_THE_FACE = HEXAGON.replace("M2", "T3 M6")


lathe = kept_tracer("lathe_mm")


@pytest.fixture
def plotted(tmp_path, capsys):
    """Return a function: the lines that `plot` prints after the first, and the picture's text."""

    def plot(text, ini, *words):
        program, picture = tmp_path / "part.ngc", tmp_path / "part.svg"
        program.write_text(text)
        assert main(["plot", str(program), "--ini", str(ini), "-o", str(picture), *words]) == 0
        return capsys.readouterr().out.splitlines()[1:], picture.read_text()

    return plot


@pytest.mark.parametrize("side", [GROOVE, HOLES])
def test_a_picture_of_the_face_shows_no_swept_area_of_cuts_in_the_side(plotted, side):
    texts, picture = plotted(FIRST_THE_FACE + side, LATHE)
    assert not [text for text in texts if text.startswith("in red")]
    assert "toolpath in the side" in picture
    assert re.findall("swept at Z([^<]*)", picture) == ["2", "−5"]


def test_the_bar_is_shown_on_the_unrolled_surface(plotted):
    assert "bar 40" in plotted(GROOVE, LATHE, "--stock", "40")[1]


def test_only_what_the_picture_marks_is_said_to_be_in_red(plotted):
    """A rapid into the side has no position in the picture of the face."""
    into = GROOVE.replace("G0 Z5", "G0 X50\nC180\nX32\nX50\nG1 X52\nG0 Z5")
    texts, picture = plotted(FIRST_THE_FACE + into, LATHE)
    assert [text.partition(": ")[0] for text in texts] == [
        "finding, line 25",
        "finding, line 38",
    ]
    assert "into material" not in picture
    texts, picture = plotted(into, LATHE)
    assert any(t.startswith("in red, line 18: a rapid goes straight down into ") for t in texts)
    assert "into material" in picture


def test_a_closed_contour_on_the_wrong_side_is_asked_about(lathe):
    assert lathe.trace_text(HEXAGON).error is None
    assert lathe.trace_text(WRONG_SIDE).error.text.endswith(f"{TIGHT}. G41?")


def test_where_neither_side_can_be_cut_nothing_is_asked(lathe):
    across = lathe.trace_text(HEXAGON.replace("G40 X60.", "G40 X-60.")).error
    assert "beside one of them it cuts into the other" in across.text and "?" not in across.text


def test_with_wrong_settings_nothing_is_drawn(tmp_path, capsys):
    program, ini, picture = (tmp_path / name for name in ("wrong.ngc", "wrong.ini", "wrong.svg"))
    program.write_text(WRONG_SIDE)
    ini.write_text(read_ini(LATHE).replaced({"G12": {"POLAR_TOLERANCE": "x"}}).text)
    assert main(["plot", str(program), "--ini", str(ini), "-o", str(picture)]) == 2
    said = f"g12 plot: {ini}: [G12] POLAR_TOLERANCE = x: must be a number"
    assert capsys.readouterr().err.startswith(said) and not picture.exists()


def test_a_refused_section_is_drawn_without_compensation(tmp_path, capsys):
    program, picture = tmp_path / "wrong.ngc", tmp_path / "wrong.svg"
    program.write_text(WRONG_SIDE)
    assert main(["plot", str(program), "--ini", str(LATHE), "-o", str(picture)]) == 2
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
