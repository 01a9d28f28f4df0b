# SPDX-License-Identifier: GPL-2.0-or-later
"""Traces that come to their end, and what a machine says of a program that does not."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from g12.tools.errors import ProgramError
from g12.tools.machine.ini import read_ini
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Parameters, Tools, trace

NO_AXIS = re.compile(r"Bad character '([abcuvwxyz])' used")


def traced(program: Path, ini: Path, tools: Tools = None, parameters: Parameters = None) -> Trace:
    """Return the trace of a program that comes to its end, or raise ProgramError."""
    found = trace(program, ini, tools=tools, parameters=parameters)
    return ended(program, with_axes(found, ini))


def ended(program: Path | str, result: Trace) -> Trace:
    """Return a trace that came to its end, or raise ProgramError."""
    if result.error:
        raise ProgramError(f"{program}:{result.error.line}: {result.error.rule}")
    return result


def with_axes(result: Trace, ini: Path) -> Trace:
    """Return a trace whose error names the machine's axes if the program asks for another one."""
    error = result.error
    if not error:
        return result
    return replace(result, error=error._replace(text=text_with_axes(error.text, ini)))


def text_with_axes(text: str, ini: Path) -> str:
    """Return the interpreter's error, with the machine's axes if it is about another one."""
    wanted = NO_AXIS.match(text)
    axes = read_ini(ini).axes
    if not wanted or wanted[1].upper() in axes:
        return text
    return f"{text}: this INI's machine has axes {' '.join(axes)}"
