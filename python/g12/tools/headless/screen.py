#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The screen of a machine without one: ``[DISPLAY] DISPLAY`` of the headless INIs.

Switches the machine on, homes it, runs one program to its end and leaves, whereupon LinuxCNC
shuts down.  The program is the one named after the INI on LinuxCNC's command line, or else
``[DISPLAY] OPEN_FILE``; with neither it only homes.  It resumes at a program stop (M0, M1).
The exit code, also LinuxCNC's, is 0 if the program ran to its end, else 1.
"""

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path

if __name__ == "__main__":
    sys.path[0] = str(Path(__file__).resolve().parents[3])

from g12.tools.errors import ProgramError
from g12.tools.headless.errors import MachineError
from g12.tools.headless.operator_panel import Panel
from g12.tools.machine.filter import OpenedProgram, opened_program
from g12.tools.machine.ini import Ini, read_ini

LONGEST_PROGRAM = 24 * 3600.0  # s


def program_to_run(ini: Ini, named: list[str]) -> Path | None:
    """Return the program to run: named on the command line or in the INI."""
    if named:
        return Path(named[0]).absolute()
    return ini.file("DISPLAY", "OPEN_FILE")


def print_reports(panel: Panel, program: OpenedProgram | None) -> bool:
    """Print LinuxCNC's messages and errors; return whether there is an error."""
    for text, _ in panel.messages():
        print(f"message: {text}", flush=True)
    errors = panel.errors()
    for text, _ in errors:
        shown = program.in_source(text) if program else text
        print(f"error: {shown}", file=sys.stderr, flush=True)
    if errors and program and program.note:
        print(program.note, file=sys.stderr, flush=True)
    return bool(errors)


def run_to_end(panel: Panel, program: OpenedProgram | None) -> bool:
    """Home the machine, run the program, and return whether it ran to its end."""
    panel.enable()
    panel.home()
    if program:
        panel.open(str(program.path))
        panel.start()
        panel.finish(LONGEST_PROGRAM)
    return not print_reports(panel, program)


def main(arguments: list[str]) -> int:
    """Run with the arguments of a screen: ``-ini INI`` and the user's own after it."""
    parser = argparse.ArgumentParser(description="The screen of a machine without one.")
    parser.add_argument("-ini", required=True)
    parser.add_argument("program", nargs="*")
    named = parser.parse_args(arguments)
    ini = read_ini(named.ini)
    program = program_to_run(ini, named.program)
    panel = Panel()
    try:
        with opened_program(program, ini) if program else nullcontext() as opened:
            worked = run_to_end(panel, opened)
    except (MachineError, ProgramError) as error:
        print(f"error: {error}", file=sys.stderr)
        worked = False
    print(f"{program or 'homing'}: {'done' if worked else 'FAILED'}", flush=True)
    return 0 if worked else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
