# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds every fault of the tables beside.

A table has its machine and its programs (a file of tests/programs, or their text), each with its
faults: a name; the code of the finding, or what its sentence has, and perhaps its line; and what is
emitted otherwise (`support.emitted_faults`), or the function or sub of the package that does
something else (`support.faulty_machines`). A fault may be in the program: ``words`` of it that
are others.

The unbroken programs are good and verify itself is sound: a finding shows that something else is
emitted.
"""

import re

import pytest

from g12.tools.preview.tracer import Tracer
from g12.tools.verify.proof import prove
from support.emitted_faults import EmittedFault
from support.fault_tables import TABLES, program_of
from support.faulty_machines import with_fault
from support.sim_machines import ROOT

USED = [(name, program) for name, table in TABLES.items() for program in table if program != "ini"]
FAULTS = [
    pytest.param(name, program, finds, changes, id=f"{name}-{what}")
    for name, program in USED
    for what, finds, *changes in TABLES[name][program]["faults"]
]
FINDS = re.compile(r"(?:line (\d+): )?(.+)")


class RememberedTraces:
    """What the sound machines did: an interpreter is started for what none has traced before."""

    def __init__(self):
        self._start, self._trace = Tracer._start, Tracer.trace
        self._known, self._no_end = {}, None

    def changed_by(self, emitted, patch):
        """Have every trace changed by a fault."""
        patch.setattr(Tracer, "_start", lambda tracer: setattr(tracer, "_process", None))
        patch.setattr(Tracer, "trace", lambda *args, **how: emitted.made(self.known(*args, **how)))

    def known(self, tracer, program, **how):
        """Return the sound trace of a program."""
        key = (
            tracer.ini.text,
            (tracer.folder / "tool.tbl").read_text(),
            program.read_text(),
            how,
        )
        if repr(key) not in self._known:
            if not tracer._process:
                self._start(tracer)
                self._no_end = tracer._no_end
            self._known[repr(key)] = self._trace(tracer, program, **how)
        tracer._no_end = self._no_end
        return self._known[repr(key)]


@pytest.fixture(scope="module")
def remembered():
    return RememberedTraces()


def findings(name, program, folder, fault=None, words=()):
    """Return what verify finds in a program of a table on its machine: codes, lines, sentences."""
    machined = program_of(name, program)
    for each in words:
        assert each["words"] in machined.text
        machined = machined._replace(text=machined.text.replace(each["words"], each["becomes"]))
    ini = with_fault(machined.ini(ROOT), fault, folder) if fault else machined.ini(ROOT)
    proof = prove(machined.written(folder), ini)
    return [(each.code, str(each.line), each.text()) for each in proof.judged if each.is_finding]


@pytest.mark.parametrize(("name", "program"), USED)
def test_an_unbroken_program_is_good(name, program, tmp_path):
    assert findings(name, program, tmp_path) == []


@pytest.mark.parametrize(("name", "program", "finds", "changes"), FAULTS)
def test_a_fault_is_found(name, program, finds, changes, tmp_path, monkeypatch, remembered):
    of_package = changes[0] if {"function", "sub"} & set(changes[0]) else None
    words = [each for each in changes if "words" in each]
    emitted = [each for each in changes if each not in words]
    if emitted and not of_package:
        remembered.changed_by(EmittedFault(emitted), monkeypatch)
    found = findings(name, program, tmp_path, of_package, words)
    line, says = FINDS.fullmatch(finds).groups()
    lines = [at for code, at, text in found if says == code or says in text]
    assert line in lines if line else lines, found
