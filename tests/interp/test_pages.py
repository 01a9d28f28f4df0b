# SPDX-License-Identifier: GPL-2.0-or-later
"""What the pages show is what happens: programs cut, messages are made, commands print the same."""

import json
import os
import re
import subprocess

import pytest

from g12.tools.commands.main import main
from g12.tools.preview.tracer import Tracer
from support.sim_machines import ROOT, SIM, trace_text, with_package
from support.small_configs import MILL as MILL_CONFIG

MACHINES = {
    "README.md": "mill_inch",
    "ngc/README.md": "mill_inch",
    "ngc/haas.md": "mill_inch",
    "ngc/yasnac.md": "mill_yasnac_mm",
    "ngc/mitsubishi.md": "mill_mitsubishi_mm",
    "ngc/circle_mill.md": "mill_mm",
    "ngc/bore.md": "mill_mm",
    "ngc/thread.md": "mill_mm",
    "ngc/frame.md": "mill_mm",
    "ngc/polar.md": "lathe_mm",
    "ngc/compensation.md": "lathe_mm",
    "ngc/polar_shapes.md": "lathe_mm",
    "ngc/holes.md": "lathe_mm",
    "ngc/cylinder.md": "lathe_mm",
    "ngc/round_part.md": "mill_a_mm",
}
CUTS = {  # of the first program of a page
    "ngc/haas.md": 3,
    "ngc/yasnac.md": 2,
    "ngc/mitsubishi.md": 2,
    "ngc/circle_mill.md": 2,
    "ngc/bore.md": 2,
    "ngc/thread.md": 2,
    "ngc/frame.md": 2,
    "ngc/polar.md": 1,
    "ngc/polar_shapes.md": 3,
    "ngc/cylinder.md": 1,
    "ngc/round_part.md": 1,
}
BORED = {"ngc/yasnac.md": "bore 80"}  # the tool enters such a hole by rapid
PROGRAM = re.compile(r"(?:^ {4}.*\n)+?^ {4}M2\n(?:\n {4}(\S+ line \d+: .*)\n)?", re.MULTILINE)
CODE = r"(?:G\d[\d.]*|circle_mill|polar_\w+|face_\w+|side_\w+)"
MESSAGE = re.compile(rf"(?:^ {{4}}|`)({CODE}(?: line \d+(?: of [\w.]+)?)?: [^`\n]+)", re.MULTILINE)
LINE = re.compile(r" line \d+(?: of [\w.]+)?(?=:)")


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def programs_in(page):
    """Return the programs of a page, blocks that end with M2, each with its refusal if any."""
    found = (match.group(0, 1) for match in PROGRAM.finditer(text_of(page)))
    return [
        (re.sub("^ {4}", "", block.partition("\n    M2\n")[0], flags=re.MULTILINE) + "\nM2\n", said)
        for block, said in found
    ]


def judged(program, page, tmp_path, capsys):
    """Return verify's exit code and report of a program of a page."""
    path = tmp_path / "page.ngc"
    path.write_text(program, encoding="utf-8")
    ini = SIM / f"{MACHINES[page]}_headless.ini"
    stock = ["--stock", BORED[page]] if page in BORED else []
    code = main(["verify", str(path), "--ini", str(ini), "--json", *stock])
    said = capsys.readouterr()
    return code, said.out or said.err


@pytest.mark.parametrize("page", CUTS)
def test_the_programs_of_a_page_run_and_cut_what_it_says(page, tmp_path, capsys):
    for number, (program, _) in enumerate(programs_in(page)):
        code, said = judged(program, page, tmp_path, capsys)
        assert code == 0, said
        if number == 0:
            cut = json.loads(said)
            assert sum(len(cut[kind]) for kind in ("pockets", "sections", "shapes")) == CUTS[page]


@pytest.mark.parametrize("page", ["ngc/compensation.md", "ngc/holes.md"])
def test_a_program_runs_or_is_refused_as_the_page_says(page):
    for program, refusal in programs_in(page):
        traced = trace_text(program, SIM / f"{MACHINES[page]}_headless.ini")
        assert (traced.error and traced.error.text) == refusal


def test_further_programs_of_polar_cut_their_flats(tmp_path):
    for program, _ in programs_in("ngc/polar.md"):
        moves = trace_text(program, SIM / "lathe_mm_headless.ini").moves
        cutting = [move.end[0] for move in moves if move.kind == "feed" and move.end[2] == -5]
        assert min(cutting) == pytest.approx(27 / 2 + 12 / 2, abs=0.05)  # the flats, the cutter


# The messages: for each page a start, and the blocks that make its messages.

MILL = "T1 M6 G43\nG20 G17 G90 G54 G64 P.001 S3000 M3\nG0 X0 Y0\nZ.1\nF20\n"
MILL_MM = "T10 M6 G43\nG21 G17 G90 G54 G64 P.02 S3000 M3\nG0 X0 Y0\nZ-4\nF300\n"
HOLE = MILL_MM.replace("T10", "T3").replace("Z-4", "Z5")
EVENT = MILL_MM.replace("T10", "T5")
MILL_A = "T3 M6 G49\nG21 G17 G90 G54 G64 P.02 S3000 M3\nG0 X0 Y0 Z25 A0\nF300\n"
LATHE = "G21 G18 G7 G40 G90 G94\nT3 M6\nS2000 M3\nF500\nG0 X60 Z5 C0\n"
POCKET = "o<polar_pocket> call [800] [9] [7] [2] [-9999] [-9999] [800] [400]"
MESSAGES = {
    "ngc/haas.md": (
        MILL,
        "G12 I.125 D1",
        "G13 I.3 K1 D1",
        "G13 I1.5 K1.5 Q.2 D1",
        "G13 D1",
        "G13 I1 D99",
        "F0 G13 I1 D1",
        "G18 G13 I1 D1",
        "G41 D1 G1 X1\nX1.5\nG13 I1 D1",
        "G41 D1 G1 X1\nX1.5\nG40\nG13 I1 D1",
        "G13 I.3 K1 Q.3 Z-.5 D1",
        "G13 I.5 K1 Q.2 Z-.5 D1",
        "G13 I.3 Z.5 D1",
        "G13 I1 Z-.5",
        "G13 I.8 Z-.5 D2",
        "G10 L1 P3 R.375\nG13 I1 Z-.5 D3\nG10 L1 P3 R.37\nG13 I1 Z-.5",
    ),
    "ngc/README.md": (MILL, "G13 I.5 K1 D1", "G12 I.125 D1", "G18 G12 I1 D1", "G12 I1 R.1 D1"),
    "ngc/yasnac.md": (
        MILL_MM,
        "G12 I9 D10",
        "G12 I50 R55 D10",
        "G12 I50 K60 Q5 D10",
        "G12 I50 K20 D10",
        "G12 I50 R40 J40 D10",
        "G12 I50 Z-4 D10",
    ),
    "ngc/mitsubishi.md": (MILL_MM, "G12 D10", "G12 I20", "G12 I8 D10", "G12 I20 Z-4 D10"),
    "ngc/circle_mill.md": (
        EVENT,
        "G13.2 X0 Y0 Z-6 I2 R40 D1 H2",
        "G13.2 X0 Y0 Z-6 R40 H2",
        "G13.2 I2 R40 H2 Z-2",
        "G13.2 X0 Y0 I2 R5 H2 Z-2",
        "G12.2 X0 Y0 Z-6 I2 R40 H0 Q.02",
        "G12.2 X0 Y0 I12 R40 H2 Z-6 E10",
        "G13.2 X0 Y0 Z1 I2 R40 H2 Q2",
        "G13.2 X0 Y0 I2 R40 H2 Z-2 D4",
        "G13.2 X0 Y0 I2 R40 H2 Z-2 J30",
        "o<circle_mill> call [7] [0] [0] [-6] [2] [10] [40] [2] [2] [3] [-9999] [.3] [150]",
    ),
    "ngc/bore.md": (
        HOLE,
        "G13.5 Z-5 R0 I3 P.2 D3",
        "G13.5 Z-5 R0 I5 D3",
        "G13.5 Z-5 R0 I5 P.2 D0",
        "G13.5 Z1 R0 I5 P.2 D3",
        "G13.5 Z-5 R9 I5 P.2 D3",
        "G13.5 Z-5 R0 I5 K5 P.2 D3",
        "G13.5 Z-5 R0 I5 P1 D3",
        "G13.5 Z-5 R0 I8 P.2 D3",
        "G13.5 Z-5 R0 I20 P.2 Q7 D3",
    ),
    "ngc/thread.md": (
        HOLE,
        "G13.6 Z-5 R0 I5 D3",
        "G13.6 Z-5 R0 I5 P0 D3",
        "G13.6 Z-5 R0 I3.5 P1 D3",
        "G13.6 Z-5 R0 I5 K5 P1.5 D3",
        "G13.6 Z-1 R0 I5 P1.5 D3",
        "G13.6 Z-12 R0 I5 P1.5 E1 D3",
        "G13.6 Z-12 R0 I5 P1.5 E6.25 D3",
        "G12.6 Z-12 R0 I20 P1 K.1 H1 D3",
        "G13.6 Z-12 R0 I5 P1.5 H2 D3",
        "G13.6 Z-12 R0 I3.8 P1 E.0625 D3",
    ),
    "ngc/frame.md": (
        HOLE,
        "G13.7 Z-4 I40 J30 R2 D3",
        "G13.7 Z-4 I40 J30 D3",
        "G13.7 Z-4 I40 J30 R16 D3",
        "G13.7 Z9 I40 J30 R5 D3",
        "G13.7 Z-4 I40 J6 R3 D3",
        "G13.7 Z-4 I40 J30 R5 H1 Q4 D3",
        "G13.7 Z-4 I40 J30 R5 E4 D3",
        "G13.7 Z-4 I40 J30 R5 Q4.6 D3",
        "G13.7 Z-4 I40 J30 R5 K-2 D3",
    ),
    "ngc/polar.md": (
        LATHE,
        "o1 sub\nG12.1\nG1 X50 F200\no1 endsub\no1 call",
        "F0\nG12.1\nG1 X50\nG13.1",
        "G0 X0\nG12.1\nG1 X50\nG13.1",
        "G12.1\nG1 X620\nG13.1",
        "G12.1\nG1 Z-1\nG0 X20\nG13.1",
    ),
    "ngc/compensation.md": (LATHE,),
    "ngc/cylinder.md": (
        LATHE.replace("X60 Z5", "X120 Z100"),
        "G7.1 C20\nG1 X50 Z-10\nG7.1 C0",
        "G7.1 C57\nG1 C30\nG2 Z70 R5\nG7.1 C0",
        "G7.1 C20\nG1 Z501\nG7.1 C0",
    ),
    "ngc/round_part.md": (
        MILL_A,
        "G0 Y.5\nG7.1 A25\nG1 X1\nG7.1 A0",
        "G92 Z30\nG7.1 A25\nG1 X1\nG7.1 A0",
        "G7.1 A25\nG1 Y1\nG7.1 A0",
        "G7.1 A25\nG18\nG7.1 A0",
    ),
    "ngc/polar_shapes.md": (
        LATHE,
        "o<polar_polygon> call [6] [27] [4] [27] [2] [2] [.3] [1000] [500] [0]",
        "o<polar_slot> call [5.9] [24] [3] [-9999] [.2] [800] [400] [0]",
        "G0 Z0\no<polar_slot> call [8] [24] [3] [-9999] [.2] [800] [400] [0]",
        POCKET,
    ),
    "ngc/holes.md": (
        LATHE,
        "o<face_holes> call [6] [30] [0] [-9999] [8] [2] [120] [3] [0] [1]",
        "o<face_holes> call [6] [30] [0] [-9999] [8] [2] [2] [0] [0] [2]",
        "o<side_holes> call [4] [-10] [45] [-9999] [60] [8] [2] [120] [-3] [0] [0]",
        "o<side_holes> call [4] [-600] [45] [-9999] [40] [8] [2] [120] [-3] [0] [0]",
        "G12.1\no<face_hole_at> call [0] [0] [12] [2] [120] [3] [.2] [0]\nG13.1",
    ),
}


def said_by(text, tracer):
    traced = tracer.trace_text(text)
    return {*(message.text for message in traced.messages), traced.error and traced.error.text}


@pytest.mark.parametrize("page", MESSAGES)
def test_every_message_of_a_page_is_made(page):
    start, *blocks = MESSAGES[page]
    programs = [f"{start}{block}\nM2\n" for block in blocks]
    if start == LATHE:
        programs += [program for program, said in programs_in("ngc/compensation.md") if said]
    with Tracer(SIM / f"{MACHINES[page]}_headless.ini") as tracer:
        made = {LINE.sub("", text) for each in programs for text in said_by(each, tracer) if text}
    shown = {LINE.sub("", text.strip()) for text in MESSAGE.findall(text_of(page))}
    assert shown and shown - made == set()


# The commands: what stands below `$` in a block.

SESSION = re.compile(r"^```\n(\$ .*?)^```$", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"`(\w+\.ngc)`[^`]*?\n\n((?: {4}.*\n)+)", re.MULTILINE)
# what a slow machine tells of work that takes more than 5 s
PROGRESS = re.compile(r"^(?:drawing|interpreting|judging|looking for) .*\n", re.MULTILINE)
SECONDS = re.compile(r"\d+(\.\d+)?(?= s\b)")


def sessions_in(page):
    """Return the commands of a page in their order, each with what it prints."""
    text = "\n".join(match.rstrip() for match in SESSION.findall(text_of(page)))
    parts = re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]
    return [tuple(part.partition("\n")[::2]) for part in parts]


def pattern_of(shown):
    """Return a pattern of the output on a page: … in a line of its own stands for any lines."""
    rows = SECONDS.sub("N", shown).splitlines()
    return "".join(r"(?:.*\n)*" if row == "…" else re.escape(f"{row}\n") for row in rows)


@pytest.mark.parametrize("page", ["README.md", "python/README.md"])
def test_every_command_prints_what_the_page_shows(page, tmp_path):
    for folder in ("python", "configs", "ngc"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    for name, block in NAMED.findall(text_of("README.md")):
        (tmp_path / name).write_text(re.sub("^ {4}", "", block, flags=re.MULTILINE))
    config = tmp_path / "linuxcnc/configs/mill/mill.ini"
    config.parent.mkdir(parents=True)
    config.write_text(MILL_CONFIG)
    (config.parent / "mill.tbl").touch()
    environment = with_package(os.environ) | {"HOME": str(tmp_path)}
    sessions = sessions_in(page)
    assert sessions
    for command, shown in sessions:
        done = subprocess.run(
            ["bash", "-c", command], cwd=tmp_path, env=environment, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
        printed = SECONDS.sub("N", PROGRESS.sub("", done.stdout))
        assert re.fullmatch(pattern_of(shown), printed), f"{command}\n{done.stdout}"
