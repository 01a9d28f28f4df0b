# SPDX-License-Identifier: GPL-2.0-or-later
"""Traces of programs that run to their end, and the error of one that does not."""

import re
from dataclasses import replace
from pathlib import Path

from g12.machine_ini import remap_lines
from g12.tools.errors import ProgramError
from g12.tools.machine.ini import read_ini
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Tracer
from g12.tools.system import COMMAND

UNKNOWN_CODE = "Unknown g code used"
OUR_CODE = re.compile(r"G(?:1[23](?!\d)|7\.1$)")
POLAR_CODES = ("G12.1", "G13.1")
PYTHON_FAILED = re.compile(r"pycall\(.*\) failed")
PACKAGE_MESSAGE = re.compile(r"^g12: (.*)$", re.MULTILINE)  # printed at its start
NO_AXIS = re.compile(r"Bad character '([abcuvwxyz])' used")


def ended(program: Path | str, result: Trace) -> Trace:
    """Return the trace of a program that ran to its end, or raise ProgramError."""
    error = result.error
    if error:
        line = f":{error.line}" if error.line else ""  # an empty file has none
        raise ProgramError(f"{program}{line}: {error.rule}")
    return result


def explained(result: Trace, ini: Path) -> Trace:
    """Return a trace whose error has what LinuxCNC leaves out; see ``explained_text``."""
    error = result.error
    if not error:
        return result
    return replace(result, error=error._replace(text=explained_text(error.text, ini)))


def explained_text(text: str, ini: Path) -> str:
    """Return the interpreter's error, with what the machine has instead of the unknown code."""
    machine = read_ini(ini)
    codes = [remap.code for remap in remap_lines(machine.all) if OUR_CODE.match(remap.code)]
    word = NO_AXIS.match(text)
    if word and word[1].upper() not in machine.axes:
        return f"{text}: this INI's machine has axes {' '.join(machine.axes)}"
    if text == UNKNOWN_CODE:
        present = " ".join(codes) or "none"
        return f"{text}: of G12, G13 and G7.1 this INI has {present}; see {COMMAND} check"
    if set(POLAR_CODES) & set(codes):
        with Tracer(ini) as tracer:
            errors = PACKAGE_MESSAGE.findall(tracer.printed)
        if errors:
            return f"{text}: {'; '.join(errors)}"
    return f"{text}; see {COMMAND} check" if PYTHON_FAILED.match(text) else text
