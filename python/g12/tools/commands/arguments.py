# SPDX-License-Identifier: GPL-2.0-or-later
"""Shared by the commands: command line arguments, the program that they name, errors."""

import argparse
import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

from g12.tools.errors import ERROR, ProgramError, UsageError, print_error
from g12.tools.headless.errors import MachineError, StartupError
from g12.tools.machine.files import existing
from g12.tools.machine.filter import OpenedProgram, opened_program
from g12.tools.machine.ini import Ini, IniError, read_machine_ini
from g12.tools.machine.tables import tool_table, var_file
from g12.tools.preview.tracer import TraceFailure
from g12.tools.system import COMMAND

GOOD, FINDING = 0, 1  # exit codes
WRONG_USE = (UsageError, IniError, OSError)
FAILURES = (ProgramError, TraceFailure, StartupError, MachineError)
VAR_HELP = "var file: the work offsets and parameters to start with (default: all are 0)"
COMMAND_NAME = re.compile(r"^( *)g12\b", re.MULTILINE)  # the command, at the beginning of a line
SUB_NOT_FOUND = "INTERP_REMAP: NGC file not found"
# Python's line of an exception, and LinuxCNC's of a HAL line or a sub that it cannot load.
SPECIFIC_LINE = re.compile(
    rf"[\w.]*(Error|Exception|Refusal)\b.*:|\S+\.(hal|tcl):\d+: |.*{SUB_NOT_FOUND}"
    r"|INI file HAL command .* failed"
)
HAL_REASON = re.compile(r"HAL: ERROR: (.* not found)|<commandline>:0: (.* does not exist)")


class Parser(argparse.ArgumentParser):
    """The argument parser of a command, which reports wrong use in one line.

    ``prog`` and the examples of ``epilog`` name the command ``g12``; the output has its call on
    this system.
    """

    def __init__(self, prog: str, description: str = "", epilog: str = "", **options: Any) -> None:
        options.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        text = description.replace("`", "")
        super().__init__(typed(prog), description=text, epilog=typed(epilog), **options)

    def error(self, message: str) -> NoReturn:
        """End the program; ``message`` is the fault of its arguments."""
        name = self.prog.replace(COMMAND, "g12")
        self.exit(ERROR, f"{name}: {message} (usage: {self.prog} --help)\n")


def typed(text: str) -> str:
    """Return a text with ``g12`` at the start of its lines as called on this system."""
    return COMMAND_NAME.sub(lambda name: name[1] + COMMAND, text)


def number_above(least: float) -> Callable[[str], float]:
    return _reader(float, lambda value: least < value < math.inf, f"a number above {least:g}")


def number_from(least: float) -> Callable[[str], float]:
    return _reader(float, lambda value: least <= value < math.inf, f"a number from {least:g}")


def count_from(least: int) -> Callable[[str], int]:
    return _reader(int, lambda value: value >= least, f"a whole number from {least}")


def _reader(kind: type, is_good: Callable[[float], bool], expected: str) -> Callable:
    def read(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not is_good(value):
            raise argparse.ArgumentTypeError(f"{text!r} is not {expected}")
        return value

    return read


def program_parser(name: str, description: str, epilog: str) -> Parser:
    """Return the parser of a command, with the arguments for a program and its machine."""
    parser = Parser(f"g12 {name}", description, epilog)
    parser.set_defaults(command=name)
    parser.add_argument("program", type=Path, help="program file")
    parser.add_argument("--ini", type=Path, required=True, help="INI file of the machine")
    parser.add_argument("--tools", type=Path, help="tool table in place of the INI's")
    parser.add_argument("--var", type=Path, help=VAR_HELP)
    return parser


def add_override(parser: argparse.ArgumentParser, whose: str) -> None:
    text = f"feed override {whose} (default 100); above it LinuxCNC rounds corners more"
    percent: dict[str, Any] = {"type": number_above(0), "default": 100.0, "metavar": "PERCENT"}
    parser.add_argument("--override", **percent, help=text)


@contextmanager
def program_of(options: argparse.Namespace) -> Iterator[tuple[OpenedProgram, Ini]]:
    """Yield the program and the machine that a command line names.

    In the end the command says so if the text or the lines are not those that the user expects.
    """
    ini = checked_ini(options)
    with opened_program(options.program, ini) as opened:
        try:
            yield opened, ini
        finally:
            if opened.note:
                print_error(f"g12 {options.command}", opened.note)


def checked_ini(options: argparse.Namespace) -> Ini:
    """Return the machine's INI after a check of the options and of all files named."""
    if not getattr(options, "run", True) and options.override != 100.0:
        raise UsageError("--override is the feed override of --run, which is not there")
    for path in filter(None, (options.program, options.ini, options.tools, options.var)):
        existing(path)
    if options.tools:
        tool_table(options.tools)
    if options.var:
        var_file(options.var)
    return read_machine_ini(options.ini)


def sentence_of(problem: Exception) -> str:
    """Return the error in one line, of a long log the most specific one."""
    if isinstance(problem, OSError) and problem.filename and problem.strerror:
        return f"{problem.filename}: {problem.strerror}"
    lines = [line.strip() for line in str(problem).splitlines() if line.strip()] or [""]
    specific = [line for line in lines if SPECIFIC_LINE.match(line)]
    reasons = [reason[0] for line in lines if (reason := HAL_REASON.match(line))]
    text = " … ".join(dict.fromkeys((lines[0], *reasons[:1], (specific or lines)[-1])))
    return f"{text}; see {COMMAND} check" if SUB_NOT_FOUND in text else text
