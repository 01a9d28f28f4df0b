# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 translate``: programs of other controls as LinuxCNC programs.

It prints nothing if any block is refused. For a [FILTER] of LinuxCNC's INI:

  [FILTER]
  PROGRAM_EXTENSION = .nc,.NC Haas programs
  nc = python3 /path/to/g12/python/g12 translate --control haas-mill
  NC = python3 /path/to/g12/python/g12 translate --control haas-mill

LinuxCNC passes its INI to a filter (INI_FILE_NAME): M codes of this machine are not changed.
"""

import argparse
import os
import re
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from g12.lengths import is_inch
from g12.tools.commands.arguments import GOOD, Parser, number_above
from g12.tools.errors import ProgramError, UsageError
from g12.tools.machine.files import existing
from g12.tools.machine.ini import Ini, read_ini
from g12.tools.translate.blocks.control import Control, read_control, shipped_controls
from g12.tools.translate.blocks.lexer import program_text
from g12.tools.translate.on_machine import on_machine
from g12.tools.translate.program import RefusedBlock, translate_program

EXAMPLES = """\
examples:
  g12 translate --list
  g12 translate --control haas-mill part.nc > part.ngc
  g12 translate --control my_lathe.toml --ini lathe.ini part.nc

exit code: 0 the program is printed, 2 a block is refused, or wrong use
"""
SAYS_UNITS = re.compile(r"G\s*0*(2[01])(?![0-9.])", re.IGNORECASE)
UNIT_CODES = {"inch": "G20", "mm": "G21"}
PROGRESS_EVERY = 0.2  # s
OTHERS_NAMED = 4


def main(options: argparse.Namespace) -> int:
    given = options.control, options.program
    if any(given) if options.list else not all(given):
        command_parser().error("--control and a program are needed, or --list alone")
    if options.list:
        print(contents(), end="")
        return GOOD
    control = changed(read_control(options.control), options)
    sys.stdout.flush()
    sys.stdout.buffer.write(translated(options, control).encode())  # independent of the locale
    return GOOD


def command_parser() -> Parser:
    parser = Parser(prog="g12 translate", description=__doc__, epilog=EXAMPLES)
    parser.add_argument("program", type=Path, nargs="?", help="program of the other control")
    parser.add_argument("--control", help="name, or a .toml file of your own")
    parser.add_argument("--list", action="store_true", help="print the controls")
    parser.add_argument("--ini", type=Path, help="INI of the machine (a filter knows it)")
    parser.add_argument(
        "--units", choices=UNIT_CODES, help="of a program that says neither G20 nor G21"
    )
    parser.add_argument(
        "--decimals", choices=("least", "whole"), help="what numbers without a decimal point are"
    )
    length = number_above(0.0)
    parser.add_argument("--safe", type=length, help="Z from which on a mill's rapids are clear")
    parser.add_argument(
        "--diameter", type=length, help="of the part that a mill's program is round"
    )
    parser.add_argument("--polar-x", choices=("diameter", "radius"), help="X in polar mode")
    return parser


def contents() -> str:
    controls = [read_control(name) for name in shipped_controls()]
    return "".join(
        f"{control.name:16} {control.title} (.{', .'.join(control.extensions)})\n"
        for control in controls
    )


def changed(control: Control, options: argparse.Namespace) -> Control:
    """Return a control with the command line's settings instead of its file's."""
    tables = dict(control.tables)
    if options.polar_x:
        tables["polar"] = {**tables.get("polar", {}), "x": options.polar_x}
    mill = {key: value for key in ("safe", "diameter") if (value := getattr(options, key))}
    if mill and not control.onto:
        raise UsageError(f"--{min(mill)} is for mill-on-face and mill-round-part")
    tables["mill"] = {**tables.get("mill", {}), **mill}
    start = (*control.start, *([UNIT_CODES[options.units]] if options.units else []))
    return replace(
        control, start=start, decimals=options.decimals or control.decimals, tables=tables
    )


def translated(options: argparse.Namespace, control: Control) -> str:
    """Return the LinuxCNC program, or raise ProgramError with the first refused block."""
    text = program_text(existing(options.program).read_bytes())
    path = options.ini or os.environ.get("INI_FILE_NAME")
    ini = read_ini(path) if path else None
    control = on_machine(control, ini) if ini else control
    if ini and not options.units and not SAYS_UNITS.search(text):
        control = replace(control, start=(*control.start, units_code(ini)))
    result = translate_program(text, control, progress())
    if result.refused:
        raise ProgramError(f"{options.program}:{refusal_sentence(result.refused)}")
    return result.text


def units_code(ini: Ini) -> str:
    """Return the code of a machine's initial units."""
    startup = SAYS_UNITS.findall(ini.get("RS274NGC", "RS274NGC_STARTUP_CODE") or "")
    return f"G{startup[-1]}" if startup else "G20" if is_inch(ini.mm) else "G21"


def refusal_sentence(refused: list[RefusedBlock]) -> str:
    """Return the first refusal, and the others with their reasons within the length limit."""
    first, *others = refused
    reasons: dict[str, list[str]] = {}
    for block in others:
        if block.line != first.line or block.sentence != first.sentence:
            reasons.setdefault(block.sentence, []).append(str(block.line))
    same = reasons.pop(first.sentence, [])
    too = f"; {lines_text(same)} too" if same else ""
    more = [f"; {lines_text(lines)}: {text}" for text, lines in reasons.items()]
    rest = f"; {len(more) - OTHERS_NAMED} further reasons" if len(more) > OTHERS_NAMED else ""
    return f"{first.line}: {first.sentence}{too}{''.join(more[:OTHERS_NAMED])}{rest}"


def lines_text(lines: list[str]) -> str:
    named = ", ".join(lines[:OTHERS_NAMED]) + (" …" if lines[OTHERS_NAMED:] else "")
    return f"line{'s' if len(lines) > 1 else ''} {named}"


def progress() -> Callable[[float], None]:
    """Return a function that reports the progress to LinuxCNC's screen, in a filter only."""
    if "INI_FILE_NAME" not in os.environ or sys.stderr.isatty():
        return lambda share: None
    last = time.monotonic()

    def report(share: float) -> None:
        nonlocal last
        if time.monotonic() - last > PROGRESS_EVERY:
            last = time.monotonic()
            print(f"FILTER_PROGRESS={100 * share:.0f}", file=sys.stderr, flush=True)

    return report
