# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds every fault of the tables beside.

A table names its machine, its programs (a file of tests/programs, or their text) and the faults:
what is ``emitted`` otherwise (`support.emitted_faults`), or which ``function`` of the package does
something else (`support.function_faults`); and the finding's code that ``finds`` it, or what its
sentence has, and perhaps its ``line``.

The unbroken programs are good and verify itself is sound: a finding shows that something else is
emitted.

Tables that still quote ``old`` and ``new`` text of a ``file`` put it into a copy of the package.
"""

import shutil

import pytest

from g12.tools.preview.tracer import Tracer
from g12.tools.verify.proof import prove
from support.emitted_faults import EmittedFault
from support.fault_tables import TABLES, program_of
from support.function_faults import with_fault
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


def findings(name, program, folder, fault=None, package=ROOT):
    """Return what verify finds in a program of a table on its machine: codes, lines, sentences."""
    asked = program_of(name, program)
    ini = asked.ini(package)
    if fault and "function" in fault:
        ini = with_fault(ini, fault, folder)
    proof = prove(asked.written(folder), ini, tools=asked.tools)
    return [(each.code, each.line, each.text()) for each in proof.judged if each.is_finding]


@pytest.mark.parametrize(("name", "program"), USED)
def test_an_unbroken_program_is_good(name, program, tmp_path):
    assert findings(name, program, tmp_path) == []


@pytest.mark.parametrize(("name", "fault"), FAULTS)
def test_a_fault_is_found(package, name, fault, tmp_path, monkeypatch):
    broken = package / fault.get("file", "ngc/g12_haas.ngc")
    text = broken.read_text()
    if "file" in fault:
        assert text.count(fault["old"]) == 1
        broken.write_text(text.replace(fault["old"], fault["new"]))
    emitted, sound = EmittedFault(fault.get("emitted", ())), Tracer.trace
    monkeypatch.setattr(
        Tracer, "trace", lambda *args, **options: emitted.made(sound(*args, **options))
    )
    try:
        found = findings(name, fault["program"], tmp_path, fault, package)
    finally:
        broken.write_text(text)
    finds = fault["finds"]
    lines = [line for code, line, text in found if code == finds or finds in text]
    assert fault.get("line") in lines if "line" in fault else lines, found
