# SPDX-License-Identifier: GPL-2.0-or-later
"""What the tools cannot do: told in one line, with an exit code, by the commands."""

from __future__ import annotations


class UsageError(ValueError):
    """The command cannot do what was asked: a wrong file, suffix or word."""


class ProgramError(RuntimeError):
    """The program itself does not come to its end; names its line and LinuxCNC's text."""
