# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of a headless run; the screen inside LinuxCNC sends those of ``SENT``, by name."""


class StartupError(RuntimeError):
    """LinuxCNC did not start; the text ends with LinuxCNC's own log."""


class MachineError(RuntimeError):
    """LinuxCNC did not carry out a command."""


class Timeout(MachineError):
    """The machine did not reach a state in time."""


SENT = {kind.__name__: kind for kind in (MachineError, Timeout)}
