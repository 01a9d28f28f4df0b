# SPDX-License-Identifier: GPL-2.0-or-later
"""verify has no finding in any program that is here, but in those that are wrong by design."""

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.regress.recordings import load
from support.foreign_programs import MACHINES as CONTROLS
from support.foreign_programs import with_builders_codes
from support.judged_programs import prove
from support.sim_machines import PROGRAMS, SIM

MACHINES = {**CONTROLS, "dynapath": "mill_inch", "polar": "lathe_mm"}
MANUALS = {"manual_a": "lathe_inch", "manual_b": "lathe_inch", "manual_sample": "lathe_inch"}
TOOLS = {"manual_sample": {8: 0.0}, "O60131": {1: 0.5}, "O60121": {1: 0.25}}
WRONG = {
    "haas/O60121": ["uncut", "uncut"],  # Q is wider than its cutter
    "polar/manual_sample": ["no-diameter"],  # its contour is the tool centre's
    "mitsubishi/planes": ["air"],
    # holes that are bored before, --stock would say
    "yasnac/example": ["rapid", "rapid"],
    "samples/mill_yasnac_mm": ["rapid"],
}
BEFORE = {"flange": "T2 M6\nG0 Z1\n"}
SUBS = ("clamp", "subs")
PLANNERS = ("lathe_", "yasnac_", "mill_helix", "mill_spiral", "haas_mm")  # folders, as they begin


def is_part(path):
    """Return whether a program makes a part; others are recorded for what a planner does there."""
    folder = path.parent.name
    return folder not in SUBS and path.stem != "every" and not folder.startswith(PLANNERS)


EVERY = [
    *sorted(path for path in PROGRAMS.rglob("*.ngc") if is_part(path)),
    *sorted((SIM / "samples").glob("*.ngc")),
]


def machine_of(program):
    """Return the machine that a program is for; lathes know the builders' codes."""
    folder, recorded = program.parent.name, program.parent / "regress"
    if recorded.is_dir() and folder not in MACHINES:
        return read_ini(load(recorded).ini)
    name = MACHINES.get(folder, program.stem.removesuffix("_cylinder"))
    ini = read_ini(SIM / f"{MANUALS.get(program.stem, name)}_headless.ini")
    return ini.replaced(with_builders_codes(ini)) if name.startswith("lathe") else ini


@pytest.mark.parametrize("program", EVERY, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_program_is_without_a_finding(program, tmp_path):
    text = BEFORE.get(program.stem, "") + program.read_text(encoding="utf-8")
    (tmp_path / program.name).write_text(text, encoding="utf-8")
    proof = prove(tmp_path / program.name, machine_of(program), tools=TOOLS.get(program.stem))
    found = sorted(code for code in proof.finding_codes)
    assert found == WRONG.get(f"{program.parent.name}/{program.stem}", [])
