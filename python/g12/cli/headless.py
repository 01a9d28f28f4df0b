# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs: a headless LinuxCNC (milltask and motion) on any INI, isolated and measured.

Every machine has its own IPC, PID, mount and network namespace, its own HOME, /tmp and runtime
directory, so several run side by side and a LinuxCNC already running is never touched.  The
INI's tool table and var file are copied, the directory itself is never written.

Positions and speeds are in machine units (``Machine.mm`` is one machine unit in mm), degrees
for rotary axes; sampled positions are those of the axes, tool length included.
"""

from __future__ import annotations

from dataclasses import dataclass

from g12.cli.trace import Error, Message, Modes


class StartupError(RuntimeError):
    """LinuxCNC did not come up; the text ends with LinuxCNC's own log."""


class Timeout(RuntimeError):
    """The machine was not idle in time."""


@dataclass(frozen=True)
class Status:
    """What ``linuxcnc.stat()`` says, machine units.

    ``task_mode`` is ``manual``, ``auto`` or ``mdi``; ``interp`` is ``idle``, ``reading``,
    ``paused`` or ``waiting``; ``enabled`` and ``homed`` are of the whole machine.
    ``position`` and ``actual`` are nine floats in the order of X Y Z A B C U V W.
    ``motion_line`` is the line of the move being made, ``current_line`` the one read.
    """

    task_mode: str
    interp: str
    enabled: bool
    homed: bool
    paused: bool
    in_position: bool
    position: tuple
    actual: tuple
    current_line: int
    motion_line: int
    feed_override: float
    tool: int
    queue: int
    modes: Modes


@dataclass(frozen=True)
class Samples:
    """The motion recorded at the servo rate: numpy arrays of equal length.

    ``time`` in seconds from the first sample, ``axes`` maps ``"X"`` … to commanded positions,
    ``line`` is the program line in motion (0: none), ``velocity`` the speed of the path and
    ``requested`` the speed asked for, machine units per second; ``feed_scale`` the
    override; ``kind`` motion.motion-type (0 none, 1 rapid, 2 feed, 3 arc, 4 toolchange, 5
    probe, 6 indexing).
    """

    time: object
    axes: dict
    line: object
    velocity: object
    requested: object
    kind: object
    overruns: int


@dataclass(frozen=True)
class Run:
    """A program run from start to end: ``error`` is None if it got there.  ``seconds`` is
    machine time from the cycle start to the last motion."""

    samples: Samples
    messages: list[Message]
    error: Error | None
    modes: Modes
    seconds: float


class Machine:
    """A headless LinuxCNC, running and homed inside the ``with`` block.

    ``overrides`` and ``tools`` as for ``trace.Tracer``.  ``home=False`` leaves it in e-stop.
    """

    def __init__(self, ini, *, overrides=None, tools=None, parameters=None, home=True,
                 timeout=60.0) -> None: ...

    def mdi(self, text, *, wait=True, timeout=60.0) -> None:
        """Execute one block of MDI, or start it only (``wait=False``)."""

    def open(self, program) -> None:
        """Load a program file."""

    def open_text(self, text) -> None:
        """Load a program given as text or list of lines."""

    def start(self, line=0) -> None:
        """Cycle start, or run from line."""

    def step(self) -> None:
        """Single step: the next block of the program."""

    def pause(self) -> None: ...

    def resume(self) -> None: ...

    def abort(self) -> None: ...

    def feed_override(self, scale) -> None:
        """Feed override; 1 is 100 %."""

    def wait_idle(self, timeout=60.0) -> None: ...

    def wait_for(self, condition, timeout=60.0) -> Status:
        """Wait until ``condition(status)`` holds."""

    def stat(self) -> Status: ...

    def errors(self) -> list:
        """Operator errors since the last call (texts)."""

    def messages(self) -> list:
        """Operator messages (texts, display and information) since the last call."""

    def get(self, pin): ...

    def set(self, pin, value): ...

    def sample(self) -> None:
        """Start sampling."""

    def samples(self) -> Samples:
        """Stop sampling and hand over what was recorded."""

    def run(self, program, timeout=600.0) -> Run:
        """Open, sample, run to the end (or the error)."""

    def run_text(self, text, timeout=600.0) -> Run: ...


def run(program, ini, *, overrides=None, tools=None, parameters=None, timeout=600.0) -> Run:
    """Run one program on a machine of its own."""
