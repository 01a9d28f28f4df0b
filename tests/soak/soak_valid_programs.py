# SPDX-License-Identifier: GPL-2.0-or-later
"""Random programs in which nothing is wrong, for the pages' judge and for verify."""

import json
import random
import re

from g12.tools.commands import main
from interp.test_valid_cuts import check_cuts
from soak import SEED, tries
from support.sim_machines import ROOT, copy_of_machines
from support.valid_programs import MACHINES, machine_of, valid_program

KINEMATICS = ROOT / "configs" / "kinematics"
OFFSET = "beside kinematics"  # in the name of a kind: the component has to know of the tool's place


def with_offset_pin(text):
    """Return an INI that tells the kinematics where the tool stands, after its other HAL files."""
    *_, last = (line for line in text.splitlines() if line.startswith("HALFILE"))
    return text.replace(last, f"{last}\nHALFILE = {KINEMATICS}/polar_tool_offset.hal")


def kinds():
    """Yield kinds of programs, all of them before one comes again."""
    chance = random.Random(SEED)
    while True:
        yield from chance.sample(list(MACHINES), len(MACHINES))


def test_cuts_as_their_words_ask(tmp_path):
    for number, kind in zip(tries("valid programs judged by their words"), kinds()):
        check_cuts(kind, tmp_path, f"{SEED} {number}")


def test_programs_as_they_run(tmp_path, capsys):
    """With feeds ten times as high, so that it does not take an hour."""
    program, ini = tmp_path / "run.ngc", copy_of_machines(tmp_path) / "machine.ini"
    for number, kind in zip(tries("valid programs judged as they run"), kinds()):
        text = valid_program(kind, random.Random(f"{SEED} {number}"), 1)
        program.write_text(re.sub(r"\bF([\d.]+)", lambda word: f"F{10 * float(word[1]):g}", text))
        machine = machine_of(kind).text
        ini.write_text(with_offset_pin(machine) if OFFSET in kind else machine)
        main.main(["verify", str(program), "--ini", str(ini), "--run", "--json"])
        found = json.loads(capsys.readouterr().out)["findings"]
        assert {each["code"] for each in found} <= {"plunge-fast"}, (kind, found)  # ten times F
