# SPDX-License-Identifier: GPL-2.0-or-later
"""Traces of programs that run to their end, and the error of one that does not."""

import re
from collections.abc import Container
from dataclasses import replace
from pathlib import Path

from g12.machine_ini import remap_lines
from g12.tools.errors import ProgramError
from g12.tools.machine.ini import Ini, read_ini
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Tracer
from g12.tools.system import COMMAND
from g12.tools.translate.blocks.control import read_control, shipped_controls
from g12.tools.translate.blocks.lexer import blocks_of, program_text, source_lines
from g12.tools.translate.whole_program import CODES

UNKNOWN_G_CODES = ("Unknown g code used", "G-code out of range")
UNKNOWN_M_CODE = re.compile("Unknown m code used: (M[0-9]+)")
OUR_CODE = re.compile(r"G(?:1[23](?!\d)|7\.1$)")
POLAR_CODES = ("G12.1", "G13.1")
PYTHON_FAILED = re.compile(r"pycall\(.*\) failed")
PACKAGE_MESSAGE = re.compile(r"^g12: (.*)$", re.MULTILINE)  # printed at its start
CONTROLS_NAMED = 3
COMMONEST = ("fanuc", "haas")
NO_AXIS = re.compile(r"Bad character '([abcuvwxyz])' used")


def ended(program: Path | str, result: Trace) -> Trace:
    """Return the trace of a program that ran to its end, or raise ProgramError."""
    error = result.error
    if error:
        line = f":{error.line}" if error.line else ""  # an empty file has none
        raise ProgramError(f"{program}{line}: {error.rule}")
    return result


def explained(result: Trace, ini: Path, program: Path) -> Trace:
    """Return a trace whose error has what LinuxCNC leaves out; see ``explained_text``."""
    error = result.error
    if not error:
        return result
    text = explained_text(error.text, ini, block_at(program, error.line))
    return replace(result, error=error._replace(text=text))


def block_at(program: Path, line: int) -> str:
    """Return a line of a program, "" where there is none."""
    rows = source_lines(program_text(program.read_bytes()))
    return rows[line - 1] if 0 < line <= len(rows) else ""


def explained_text(text: str, ini: Path, block: str = "") -> str:
    """Return the interpreter's error with the unknown code of ``block``, and what the INI has."""
    machine = read_ini(ini)
    remapped = {remap.code for remap in remap_lines(machine.all)}
    word, m_code = NO_AXIS.match(text), UNKNOWN_M_CODE.fullmatch(text)
    if word and word[1].upper() not in machine.axes:
        return f"{text}: this INI's machine has axes {' '.join(machine.axes)}"
    if m_code:
        return f"{text}{of_other_controls(m_code[1], machine.axes)}"
    if text in UNKNOWN_G_CODES:
        return _unknown_g_code(text, unknown_code(block, remapped), machine)
    if remapped.intersection(POLAR_CODES):
        with Tracer(ini) as tracer:
            errors = PACKAGE_MESSAGE.findall(tracer.printed)
        if errors:
            return f"{text}: {'; '.join(errors)}"
    return f"{text}; see {COMMAND} check" if PYTHON_FAILED.match(text) else text


def _unknown_g_code(text: str, code: str, machine: Ini) -> str:
    """Return the error with its code: one of ours that the machine lacks, or another control's."""
    named = f"{text}: {code}" if code else text
    if code and not OUR_CODE.match(code):
        return f"{named}{of_other_controls(code, machine.axes)}"
    present = [remap.code for remap in remap_lines(machine.all) if OUR_CODE.match(remap.code)]
    has = " ".join(present) or "none"
    return f"{named}: of G12, G13 and G7.1 this INI has {has}; see {COMMAND} check"


def unknown_code(block: str, remapped: Container[str]) -> str:
    """Return the first G code of a block that LinuxCNC lacks; "" if that is not certain."""
    words = [word for part in blocks_of(1, block) for word in part.words]
    codes = [word.code for word in words if word.code[:1] == "G" and word.code not in remapped]
    lacking = [code for code in codes if code not in CODES]
    return next(iter(lacking or codes * (len(codes) == 1)), "")


def of_other_controls(code: str, axes: str) -> str:
    """Return the end of a sentence about a code: the controls that have it, "" if none is known."""
    controls = (read_control(name) for name in shipped_controls())
    having = [c for c in controls if not c.onto and _is_known(c.meanings.get(code, ""))]
    fitting = [c for c in having if c.is_lathe == ("Y" not in axes)] or having
    names = sorted((c.name for c in fitting), key=_rank)
    if not names:
        return ""
    known = ", ".join(names[:CONTROLS_NAMED]) + " and others" * (len(names) > CONTROLS_NAMED)
    return f", a code of {known}: {COMMAND} translate --control NAME makes a LinuxCNC program of it"


def _is_known(meaning: str) -> bool:
    return meaning not in ("", "same", "machine") and not meaning.startswith("refuse: ")


def _rank(name: str) -> tuple[bool, int, str]:
    return not name.startswith(COMMONEST), len(name), name
