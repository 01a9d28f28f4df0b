# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds every fault of the tables beside, each put into a copy of the package alone.

A table names its machine, its programs (a file of tests/programs, or their text) and the faults:
in which ``file`` which ``old`` text becomes the ``new`` one, and the sentence that ``finds`` it.
"""

import shutil
from pathlib import Path

import pytest
import tomllib

from g12.tools.machine.ini import read_ini
from g12.tools.verify.proof import prove
from support.sim_machines import PROGRAMS, ROOT

TABLES = {
    path.stem: tomllib.loads(path.read_text()) for path in Path(__file__).parent.glob("*.toml")
}
USED = [(name, program) for name, table in TABLES.items() for program in table["programs"]]
FAULTS = [
    pytest.param(name, fault, id=f"{name}-{fault['what']}")
    for name, table in TABLES.items()
    for fault in table["fault"]
]


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    folder = tmp_path_factory.mktemp("package")
    for part in ("configs", "ngc", "python"):
        shutil.copytree(ROOT / part, folder / part)
    return folder


def findings(package, name, program, folder):
    """Return what verify finds in a program of a table on its machine."""
    table = TABLES[name]
    asked = table["programs"][program]
    path = PROGRAMS / asked["file"] if "file" in asked else folder / f"{program}.ngc"
    if "text" in asked:
        path.write_text(asked["text"])
    ini = read_ini(package / "configs" / "sim" / f"{asked.get('ini', table['ini'])}_headless.ini")
    tools = {int(tool): size for tool, size in asked["tools"].items()} if "tools" in asked else None
    proof = prove(path, ini.replaced({"G12": asked.get("settings", {})}), tools=tools)
    return [text for _, text in proof.findings]


@pytest.mark.parametrize(("name", "program"), USED)
def test_an_unbroken_program_is_good(package, name, program, tmp_path):
    assert findings(package, name, program, tmp_path) == []


@pytest.mark.parametrize(("name", "fault"), FAULTS)
def test_a_fault_is_found(package, name, fault, tmp_path):
    broken = package / fault["file"]
    text = broken.read_text()
    assert text.count(fault["old"]) == 1
    broken.write_text(text.replace(fault["old"], fault["new"]))
    try:
        found = findings(package, name, fault["program"], tmp_path)
    finally:
        shutil.copy2(ROOT / fault["file"], broken)
    assert any(fault["finds"] in text for text in found), found
