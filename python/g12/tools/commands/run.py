# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 run``: a program to its end on a headless LinuxCNC.

It is isolated from any other LinuxCNC on the computer, and nothing of the machine's own files is
written. M0 and M1 are passed over.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

from g12.machine_ini import AXES
from g12.tools.commands.arguments import (
    FINDING,
    GOOD,
    checked_ini,
    number_above,
    one_line,
    program_parser,
    tell_whose_lines,
)
from g12.tools.headless.machine import Run
from g12.tools.headless.run import run_anyhow
from g12.tools.machine.filter import opened_program
from g12.tools.machine.ini import Ini
from g12.tools.preview.ended import text_with_axes
from g12.tools.preview.moves import LINEAR
from g12.tools.regress.recording_text import number_text
from g12.tools.units import UNITS, name_of_unit

EXAMPLES = """\
examples:
  g12 run pocket.ngc --ini mill.ini
  g12 run pocket.ngc --ini mill.ini --tools other.tbl --timeout 3600

exit code: 0 the program came to its end, 1 it did not, 2 wrong use
"""
DECIMALS = 6


def lines_of_run(result: Run, ini: Ini) -> Iterator[str]:
    """Yield what the run said and where the machine stands at its end."""
    for message in result.messages:
        yield f"message: {message.text}"
    axes = [(axis, AXES.index(axis)) for axis in result.samples.axes]
    ends = (f"{axis}{number_text(round(result.position[at], DECIMALS))}" for axis, at in axes)
    unit = UNITS[name_of_unit(ini.mm)].name
    units = unit if all(LINEAR[at] for _, at in axes) else f"{unit} and degrees"
    yield f"ends at {' '.join(ends)} (machine position, {units})"
    yield f"{result.seconds:.3f} s in motion"


@one_line("run")
def main(arguments: list[str]) -> int:
    """Run the command."""
    parser = program_parser("run", __doc__, EXAMPLES)
    timeout = {"type": number_above(0), "default": 600.0, "metavar": "SECONDS"}
    parser.add_argument("--timeout", **timeout, help="give up after this (default 600)")
    options = parser.parse_args(arguments)
    ini = checked_ini(options)
    with opened_program(options.program, ini) as opened:
        result = run_anyhow(
            opened.path, options.ini, options.tools, options.var, timeout=options.timeout
        )
    for line in lines_of_run(result, ini):
        print(line)
    if result.error:
        text = opened.in_source(text_with_axes(result.error.text, options.ini))
        print(f"g12 run: {options.program}: {text}", file=sys.stderr)
        tell_whose_lines("run", opened)
    return FINDING if result.error else GOOD
