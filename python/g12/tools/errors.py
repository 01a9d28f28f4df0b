# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of the tools, which the commands print in one line, with an exit code."""

import sys

ERROR = 2  # exit code


class UsageError(ValueError):
    """A wrong file, suffix or word on the command line."""


class ProgramError(RuntimeError):
    """The program does not run to its end; has its line and LinuxCNC's text."""


def print_error(command: str, text: object) -> None:
    """Print a command's error on standard error, after everything that it has printed before."""
    sys.stdout.flush()
    print(f"{command}: {text}", file=sys.stderr)
