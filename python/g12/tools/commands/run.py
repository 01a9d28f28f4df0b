# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 run``: a program to its end on a headless LinuxCNC.

It is isolated from any other LinuxCNC on the computer, and nothing of the machine's own files is
written. It resumes at M0 and M1.
"""

import argparse
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from g12.machine_ini import AXIS_LETTERS
from g12.tools.commands.arguments import (
    GOOD,
    Parser,
    add_override,
    number_above,
    program_of,
    program_parser,
)
from g12.tools.commands.cut import run_text
from g12.tools.errors import ProgramError
from g12.tools.headless.machine import Run, run_anyhow
from g12.tools.machine.ini import Ini
from g12.tools.path.track import program_seconds
from g12.tools.preview.ended import block_at, explained_text
from g12.tools.preview.moves import IS_LENGTH, Error, Trace
from g12.tools.preview.tracer import Parameters, Tools, TraceFailure, trace
from g12.tools.progress import working
from g12.tools.regress.recording_text import number_text
from g12.tools.units import UNITS, name_of_unit

EXAMPLES = """\
examples:
  g12 run pocket.ngc --ini mill.ini
  g12 run pocket.ngc --ini mill.ini --override 500
  g12 run pocket.ngc --ini mill.ini --tools other.tbl --timeout 3600

exit code: 0 the program came to its end, 2 it did not, or wrong use
"""
POSITION_DECIMALS = 6
LINE_IN_TEXT = re.compile(r"\bline \d")
PREVIEW_TIMEOUT = 20.0  # s for an estimate of the run's time
USUAL_TIMEOUT = 600.0  # s


def lines_of_run(result: Run, ini: Ini) -> Iterator[str]:
    """Yield the run's messages, and the machine's position at its end if anything has moved."""
    for message in result.messages:
        yield f"message: {message.text}"
    if result.error and not result.seconds:
        return
    axes = [(axis, AXIS_LETTERS.index(axis)) for axis in result.samples.axes]
    ends = (
        f"{axis}{number_text(round(result.position[at], POSITION_DECIMALS))}" for axis, at in axes
    )
    unit = UNITS[name_of_unit(ini.mm)].name
    units = unit if all(IS_LENGTH[at] for _, at in axes) else f"{unit} and degrees"
    what = "stopped at" if result.error else "ends at"
    yield f"{what} {' '.join(ends)} (machine position, {units})"
    yield f"{result.seconds:.3f} s in motion"


def preview_of(program: Path, ini: Path, tools: Tools, parameters: Parameters) -> Trace | None:
    """Return the trace of a program, None if the preview takes too long."""
    try:
        return trace(program, ini, tools=tools, parameters=parameters, timeout=PREVIEW_TIMEOUT)
    except TraceFailure:
        return None


def default_timeout(preview: Trace | None, ini: Ini, override: float) -> float:
    if preview is None or preview.error:
        return USUAL_TIMEOUT
    return max(USUAL_TIMEOUT, 2 * program_seconds(preview, ini, override))


def line_of_preview(error: Error, preview: Trace | None) -> int:
    """Return the line of an error whose text names none; 0 if it does or is unknown.

    LinuxCNC's task does not report the line, but a preview with the same error has it.
    """
    found = preview and preview.error
    names_line = LINE_IN_TEXT.search(error.text)
    return found.line if found and found.text == error.text and not names_line else 0


def command_parser() -> Parser:
    parser = program_parser("run", __doc__, EXAMPLES)
    add_override(parser, "of the run")
    usual = f"{USUAL_TIMEOUT:g}, or twice what the program needs"
    timeout: dict[str, Any] = {"type": number_above(0), "metavar": "SECONDS"}
    parser.add_argument("--timeout", **timeout, help=f"give up after this (default {usual})")
    return parser


def main(options: argparse.Namespace) -> int:
    with program_of(options) as (opened, ini):
        files = (options.ini, options.tools, options.var)
        preview = preview_of(opened.path, *files)
        timeout = options.timeout or default_timeout(preview, ini, options.override)
        with working(run_text(options.program, options.override, preview, ini), clock=True):
            result = run_anyhow(opened.path, *files, options.override, timeout=timeout)
        for text in lines_of_run(result, ini):
            print(text)
        if result.error:
            line = line_of_preview(result.error, preview)
            block = block_at(opened.path, line)
            text = explained_text(result.error.text, options.ini, block)
            location = f"{opened.path}:{line}" if line else opened.path
            raise ProgramError(f"{location}: {text}")
    return GOOD
