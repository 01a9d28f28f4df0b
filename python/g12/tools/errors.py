# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of the tools, which the commands print in one line, with an exit code."""

from __future__ import annotations


class UsageError(ValueError):
    """A wrong file, suffix or word on the command line."""


class ProgramError(RuntimeError):
    """The program does not run to its end; has its line and LinuxCNC's text."""
