# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds every fault of the tables beside.

A table names its machine, its programs (a file of tests/programs, or their text) and the faults:
what is ``emitted`` otherwise (`support.emitted_faults`), or the ``function`` or ``sub`` of the
package that does something else (`support.faulty_machines`); and the finding's code that ``finds``
it, or what its sentence has, and perhaps its ``line``.

The unbroken programs are good and verify itself is sound: a finding shows that something else is
emitted.
"""

import pytest

from g12.tools.preview.tracer import Tracer
from g12.tools.verify.proof import prove
from support.emitted_faults import EmittedFault
from support.fault_tables import TABLES, program_of
from support.faulty_machines import with_fault
from support.sim_machines import ROOT

USED = [(name, program) for name, table in TABLES.items() for program in table["programs"]]
FAULTS = [
    pytest.param(name, fault, id=f"{name}-{fault['what']}")
    for name, table in TABLES.items()
    for fault in table["fault"]
]


def findings(name, program, folder, fault=None):
    """Return what verify finds in a program of a table on its machine: codes, lines, sentences."""
    asked = program_of(name, program)
    ini = asked.ini(ROOT)
    if fault and "emitted" not in fault:
        ini = with_fault(ini, fault, folder)
    proof = prove(asked.written(folder), ini, tools=asked.tools)
    return [(each.code, each.line, each.text()) for each in proof.judged if each.is_finding]


@pytest.mark.parametrize(("name", "program"), USED)
def test_an_unbroken_program_is_good(name, program, tmp_path):
    assert findings(name, program, tmp_path) == []


@pytest.mark.parametrize(("name", "fault"), FAULTS)
def test_a_fault_is_found(name, fault, tmp_path, monkeypatch):
    emitted, sound = EmittedFault(fault.get("emitted", ())), Tracer.trace
    monkeypatch.setattr(
        Tracer, "trace", lambda *args, **options: emitted.made(sound(*args, **options))
    )
    found = findings(name, fault["program"], tmp_path, fault)
    finds = fault["finds"]
    lines = [line for code, line, text in found if code == finds or finds in text]
    assert fault.get("line") in lines if "line" in fault else lines, found
