# SPDX-License-Identifier: GPL-2.0-or-later
"""What verify reports of a program: each file of tests/verify_programs says it in its head.

The first line has the machine and the arguments of the command, the second the codes with their
lines, in that order: ``; mill_mm --stock "100x80x20"``, ``; plunge 9, rapid 11``. Arguments are
--stock, --accept, --var and --tools (``--var "5221=10"``), and values of the INI (``G12.KEY=1``).
"""

import shlex
from contextlib import ExitStack
from pathlib import Path

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.preview.tracer import Tracer
from g12.tools.verify.judge import judge_trace
from g12.tools.verify.model.finding import KINDS
from g12.tools.verify.model.program import TracedProgram
from support.sim_machines import SIM

PROGRAMS = sorted((Path(__file__).parents[1] / "verify_programs").glob("*.ngc"))


@pytest.fixture(scope="module")
def tracer_of():
    """Return a function: the tracer of a machine with values of the INI and tools, kept."""
    known = {}
    with ExitStack() as stack:

        def tracer(machine, changed, tools):
            key = machine, str(changed), str(tools)
            if key not in known:
                ini = read_ini(SIM / f"{machine}_headless.ini").replaced(changed)
                known[key] = stack.enter_context(Tracer(ini, tools=tools, reports=True))
            return known[key]

        yield tracer


def head_of(program):
    """Return the machine, the options by name, values of the INI, and the expected codes."""
    first, second = (line.lstrip("; ") for line in program.read_text().splitlines()[:2])
    machine, *words = shlex.split(first)
    options, changed = {}, {}
    for name, value in zip(words, [*words[1:], ""]):
        if name.startswith("--"):
            options[name] = value
        elif "." in name.partition("=")[0] and not name[0].isdigit():
            key, _, text = name.partition("=")
            section, _, key = key.partition(".")
            changed.setdefault(section, {})[key] = text
    return machine, options, changed, "" if second == "nothing" else second


def numbers(text):
    """Return the numbers of ``5221=10 5210=1``."""
    pairs = (word.split("=") for word in (text or "").split())
    return {int(name): float(value) for name, value in pairs} or None


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: path.stem)
def test_the_codes_of_a_program(program, tracer_of):
    machine, options, changed, expected = head_of(program)
    tracer = tracer_of(machine, changed, numbers(options.get("--tools")))
    stored = numbers(options.get("--var"))
    trace = tracer.trace(program, parameters=stored)
    assert trace.error is None
    traced = TracedProgram(program, tracer.ini, trace, None, stored or {})
    stock = StockText(options["--stock"]) if "--stock" in options else None
    judged = judge_trace(traced, stock=stock, accept=options.get("--accept", "").split())
    found = sorted((line, each.code) for each in judged.found for line in each.lines)
    assert ", ".join(f"{code} {line}" for line, code in found) == expected


def test_every_code_has_a_program():
    named = " ".join(head_of(program)[3] for program in PROGRAMS)
    found = {word.split()[0] for word in named.split(", ") if word} | set(named.split())
    assert {code for code in KINDS if code not in found} == ELSEWHERE


ELSEWHERE = {  # of a run or a clamp: test_verify_programs.py
    *("off", "run-off", "wall", "clamp-closed"),
}
