# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 run INI PROGRAM``: run a program to its end on a headless, isolated LinuxCNC."""

from __future__ import annotations

import argparse
import sys

from g12.cli.headless import MachineError, Run, StartupError, run
from g12.cli.trace import AXES


def report(result: Run) -> None:
    """Print what the run said and where it ended."""
    for message in result.messages:
        print(f"message: {message.text}")
    if result.error:
        print(f"error: {result.error.text}", file=sys.stderr)
    ends = ((axis, result.position[AXES.index(axis)]) for axis in result.samples.axes)
    print("ends at", " ".join(f"{axis}{value:.6g}" for axis, value in ends))
    print(f"{result.seconds:.3f} s in motion")


def main(arguments: list[str]) -> int:
    """Run the command; the exit code is 0 if the program came to its end."""
    parser = argparse.ArgumentParser(prog="g12 run", description=__doc__)
    parser.add_argument("ini", help="INI file of the machine")
    parser.add_argument("program", help="program file")
    parser.add_argument("--tools", help="tool table in place of the INI's")
    parser.add_argument("--timeout", type=float, default=600.0, help="seconds (default 600)")
    asked = parser.parse_args(arguments)
    try:
        result = run(asked.program, asked.ini, tools=asked.tools, timeout=asked.timeout)
    except (MachineError, StartupError, OSError, ValueError) as error:
        print(f"g12 run: {error}", file=sys.stderr)
        return 1
    report(result)
    return 1 if result.error else 0
