# SPDX-License-Identifier: GPL-2.0-or-later
"""The programs that the pages begin with cut what they say, on the simulated machines."""

import json
import re

import pytest

from g12.tools.commands.main import main
from support.sim_machines import ROOT, SIM, trace_text

PAGES = {
    "README.md": ("mill_inch", 2),
    "ngc/haas.md": ("mill_inch", 2),
    "ngc/yasnac.md": ("mill_yasnac_mm", 2),
    "ngc/mitsubishi.md": ("mill_mitsubishi_mm", 2),
    "ngc/circle_mill.md": ("mill_mm", 2),
    "ngc/polar.md": ("lathe_mm", 1),
    "ngc/polar_shapes.md": ("lathe_mm", 3),
    "ngc/cylinder.md": ("lathe_mm", 1),
}
BORED = {"ngc/yasnac.md": "bore 80"}  # it enters such a hole by rapid
PROGRAM = re.compile(r"(?:^ {4}.*\n)+?^ {4}M2\n", re.MULTILINE)


def program_of(page):
    """Return the first program of a page, the code block that ends with M2."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return programs_in(text)[0]


def programs_in(text):
    """Return the programs in a page's text."""
    found = (match[0] for match in PROGRAM.finditer(text))
    return [re.sub("^ {4}", "", program, flags=re.MULTILINE) for program in found]


@pytest.mark.parametrize("page", PAGES)
def test_the_first_program_of_a_page_cuts_what_it_says(page, tmp_path, capsys):
    machine, cuts = PAGES[page]
    program = tmp_path / "page.ngc"
    program.write_text(program_of(page), encoding="utf-8")
    ini = SIM / f"{machine}_headless.ini"
    stock = ["--stock", BORED[page]] if page in BORED else []
    assert main(["verify", str(program), "--ini", str(ini), "--json", *stock]) == 0
    reported = json.loads(capsys.readouterr().out)
    assert sum(len(reported[kind]) for kind in ("pockets", "sections", "shapes")) == cuts


def test_what_the_page_of_verify_shows_is_what_it_prints(tmp_path, capsys):
    program = tmp_path / "pocket.ngc"
    first, second = program_of("ngc/haas.md").rsplit("Q.2", 1)
    program.write_text(f"{first}Q.3{second}", encoding="utf-8")
    assert main(["verify", str(program), "--ini", str(SIM / "mill_inch_headless.ini")]) == 1
    page = (ROOT / "python" / "README.md").read_text(encoding="utf-8")
    assert f"```\n{capsys.readouterr().out}```" in page


@pytest.mark.parametrize(("number", "sections"), [(1, 1), (2, 2)])
def test_further_programs_of_polar_cut_their_shapes_from_a_bar(number, sections, tmp_path, capsys):
    text = (ROOT / "ngc" / "polar.md").read_text(encoding="utf-8")
    program = tmp_path / "page.ngc"
    program.write_text(programs_in(text)[number], encoding="utf-8")
    words = [str(program), "--ini", str(SIM / "lathe_mm_headless.ini"), "--stock", "40"]
    assert main(["verify", *words, "--json"]) == 0
    reported = json.loads(capsys.readouterr().out)
    assert [part["deviation"] < 0.005 for part in reported["sections"]] == [True] * sections
    traced = trace_text(programs_in(text)[number], SIM / "lathe_mm_headless.ini")
    cutting = [move.end[0] for move in traced.moves if move.kind == "feed" and move.end[2] == -5]
    assert min(cutting) == pytest.approx(27 / 2 + 12 / 2, abs=0.05)  # the flats, the cutter
    assert reported["warnings"] == []
