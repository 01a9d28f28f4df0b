# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of the tools, which the commands print in one line, with an exit code."""

import re
import sys

ERROR = 2  # exit code
CONTROL_CHARACTER = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029]")  # but no line end


class UsageError(ValueError):
    """A wrong file, suffix or word on the command line."""


class ProgramError(RuntimeError):
    """The program does not run to its end; has its line and LinuxCNC's text."""


def print_error(command: str, text: object) -> None:
    """Print a command's error on standard error, after everything that it has printed before."""
    sys.stdout.flush()
    print(f"{command}: {CONTROL_CHARACTER.sub('?', str(text))}", file=sys.stderr)
