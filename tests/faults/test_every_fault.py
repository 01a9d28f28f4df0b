# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds every fault of the tables beside, each put into a copy of the package alone.

A table names its machine, its programs (a file of tests/programs, or their text) and the faults:
in which ``file`` which ``old`` text becomes the ``new`` one, and the finding's code that ``finds``
it, or what its sentence has, and perhaps its ``line``.
"""

import shutil

import pytest

from g12.tools.verify.proof import prove
from support.fault_tables import TABLES, program_of
from support.sim_machines import ROOT

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
    """Return what verify finds in a program of a table on its machine: codes, lines, sentences."""
    asked = program_of(name, program)
    proof = prove(asked.written(folder), asked.ini(package), tools=asked.tools)
    return [(each.code, each.line, each.text()) for each in proof.judged if each.is_finding]


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
    finds = fault["finds"]
    lines = [line for code, line, text in found if code == finds or finds in text]
    assert fault.get("line") in lines if "line" in fault else lines, found
