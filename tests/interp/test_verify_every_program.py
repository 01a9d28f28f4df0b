# SPDX-License-Identifier: GPL-2.0-or-later
"""verify has no finding in any program that is here, but in those that are wrong by design."""

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.verify.proof import prove
from support.fault_tables import BEFORE, FOLDERS, OTHERWISE, TOOLS
from support.foreign_programs import MACHINES as CONTROLS
from support.foreign_programs import with_builders_codes
from support.sim_machines import PROGRAMS, SIM

MACHINES = {**FOLDERS, **CONTROLS, "holes": "lathe_mm"}
WRONG = {
    "haas/O60121": ["of material remain uncut"] * 2,  # Q is wider than its cutter
    "fanuc-lathe/cylinder": ["the tool crosses the contour on its way in"],
}
EVERY = [*sorted(PROGRAMS.rglob("*.ngc")), *sorted((SIM / "samples").glob("*.ngc"))]


def machine_of(program):
    """Return the machine that a program is for; lathes know the builders' codes."""
    folder = MACHINES.get(program.parent.name, program.stem.removesuffix("_cylinder"))
    ini = read_ini(SIM / f"{OTHERWISE.get(program.stem, folder)}_headless.ini")
    return ini.replaced(with_builders_codes(ini)) if folder.startswith("lathe") else ini


@pytest.mark.parametrize("program", EVERY, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_program_is_as_its_words_ask(program, tmp_path):
    text = BEFORE.get(program.stem, "") + program.read_text(encoding="utf-8")
    (tmp_path / program.name).write_text(text, encoding="utf-8")
    tools = TOOLS.get(program.stem)
    proof = prove(tmp_path / program.name, machine_of(program), tools=tools)
    found = [text for _, text in proof.findings]
    wrong = WRONG.get(f"{program.parent.name}/{program.stem}", [])
    assert len(found) == len(wrong)
    assert all(expected in reported for expected, reported in zip(wrong, found))
