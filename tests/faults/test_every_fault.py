# SPDX-License-Identifier: GPL-2.0-or-later
"""The oracle of the planners (`support.oracle`) sees every fault of the tables beside.

A table has its machine and its programs (a file of tests/programs, or their text), each with its
faults: a name; the code of the difference, or what its sentence has, and perhaps its line; and what
is emitted otherwise (`support.emitted_faults`), or the function or sub of the package that does
something else (`support.faulty_machines`). ``leaves`` and ``acts`` are what a section's words leave
behind and what happens in it, by its line, written by hand.

The unbroken programs are as their words ask and the oracle itself is sound: a difference shows that
something else is emitted.
"""

import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from support.emitted_faults import EmittedFault
from support.fault_tables import TABLES, program_of
from support.faulty_machines import with_fault
from support.oracle.judge import Oracle
from support.oracle.tracing import ModalTracer
from support.sim_machines import ROOT

USED = [(name, program) for name, table in TABLES.items() for program in table if program != "ini"]
FAULTS = [
    pytest.param(name, program, finds, changes, id=f"{name}-{what}")
    for name, program in USED
    for what, finds, *changes in TABLES[name][program]["faults"]
]
FINDS = re.compile(r"(?:line (\d+): )?(.+)")


def traced(name, program, folder, fault=None):
    """Return the trace of a program of a table on its machine, with a fault of that or without."""
    machined = program_of(name, program)
    ini = with_fault(machined.ini(ROOT), fault, folder) if fault else machined.ini(ROOT)
    with ModalTracer(ini) as tracer:
        return tracer.trace(machined.written(folder))


@cache
def sound(name, program):
    """Return the trace of an unbroken machine."""
    with TemporaryDirectory() as folder:
        return traced(name, program, Path(folder))


def differences(name, program, trace):
    machined = program_of(name, program)
    known = {key: TABLES[name][program].get(key, {}) for key in ("leaves", "acts")}
    return list(Oracle(trace, machined.ini(ROOT), machined.text, known).differences())


@pytest.mark.parametrize(("name", "program"), USED)
def test_an_unbroken_program_is_as_its_words_ask(name, program):
    trace = sound(name, program)
    assert trace.error is None and trace.cuts
    assert differences(name, program, trace) == []


@pytest.mark.parametrize(("name", "program", "finds", "changes"), FAULTS)
def test_a_fault_is_seen(name, program, finds, changes, tmp_path):
    if {"function", "sub"} & set(changes[0]):
        trace = traced(name, program, tmp_path, changes[0])
    else:
        fault = EmittedFault(changes)
        trace = fault.made(sound(name, program))
    found = differences(name, program, trace)
    line, says = FINDS.fullmatch(finds).groups()
    lines = [str(at) for code, at, text in found if says == code or says in text]
    assert line in lines if line else lines, found
