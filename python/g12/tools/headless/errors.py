# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors that the screen inside LinuxCNC sends to the runner outside."""


class MachineError(RuntimeError):
    """LinuxCNC did not carry out a command."""


class Timeout(MachineError):
    """The machine did not reach a state in time."""
