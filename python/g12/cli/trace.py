# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact traces: a program and an INI in, the list of moves at full precision out.

LinuxCNC's own preview module interprets the program in a process of its own
(``trace_worker.py``), so nothing here needs a running LinuxCNC or a screen.

Lengths are millimetres and angles degrees, whatever the program and the machine use.
Positions are those of the controlled point in machine coordinates: work offsets, G92 and the
rotation of the work coordinate system are resolved.  The tool length offset is not added, so
with no work offset they are the program's positions.  (A real machine's axes stand at the
position plus ``Move.tool_offset``.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

AXES = "XYZABCUVW"

Position = tuple  # nine floats in the order of AXES: mm, degrees for A, B, C


class Message(NamedTuple):
    """A text for the operator that is no error: ``(MSG, …)`` or a handler's MESSAGE."""

    line: int
    text: str


class Error(NamedTuple):
    """The interpreter's own text for the block that was refused, and that block's line."""

    text: str
    line: int


@dataclass(frozen=True)
class Modes:
    """The modal state of an interpreter, in LinuxCNC's words.

    ``gcodes`` and ``mcodes`` are like ``("G1", "G17", "G90.1", …)``, one per modal group with
    a code active.  ``feed`` and ``speed`` are the F and S words in program units, ``blending``
    is G64's (P, Q) in program units.
    """

    gcodes: tuple[str, ...]
    mcodes: tuple[str, ...]
    feed: float
    speed: float
    blending: tuple[float, float]


@dataclass(frozen=True)
class Move:
    """One canonical move.

    ``kind`` is ``rapid``, ``feed``, ``arc`` or ``probe``; ``line`` the line of the program the
    interpreter gives it (what a GUI would highlight).  ``feed`` is mm/min under ``feed_mode``
    G94, 1/min under G93, mm/rev under G95 (degrees for a move of rotary axes alone), and 0 for
    a rapid.  ``plane`` is 17, 18 or 19.

    Of an arc, ``centre`` is the centre (x, y, z) at the level of the start, ``turns`` the
    interpreter's count (positive counterclockwise seen from the plane's positive third axis,
    1 or -1 for anything up to a full circle) and ``rotation`` the angle of the work coordinate
    system about Z in degrees, which tilts G18 and G19 planes.
    """

    kind: str
    line: int
    start: Position
    end: Position
    feed: float
    feed_mode: str
    plane: int
    tool: int
    tool_offset: Position
    centre: tuple[float, float, float] | None = None
    turns: int = 0
    rotation: float = 0.0

    @property
    def radius(self) -> float:
        """Radius of an arc at its start, mm."""

    @property
    def sweep(self) -> float:
        """Signed angle of an arc in radians, positive counterclockwise."""

    @property
    def length(self) -> float:
        """Length of the path in X, Y, Z, mm (helix included)."""

    def point(self, fraction: float) -> Position:
        """Position after ``fraction`` (0 to 1) of the move."""

    def tangent(self, fraction: float) -> tuple[float, float, float]:
        """Unit direction in X, Y, Z after ``fraction`` of the move; zeros if X Y Z stand still."""


@dataclass(frozen=True)
class Trace:
    """What one program did.

    ``error`` is None for a program that ran to its end.  ``modes`` is the state behind the last
    block, M2 included, ``printed`` the text of ``(print, …)``, ``globals`` the global named
    parameters, ``numbered`` the parameters asked for, ``seconds`` the interpreter's time.
    """

    moves: list[Move]
    messages: list[Message]
    error: Error | None
    modes: Modes
    printed: str
    position: Position
    globals: dict[str, float]
    numbered: dict[int, float]
    seconds: float


class TraceFailure(RuntimeError):
    """The interpreter itself died or ran out of time: no statement about the program."""


class Tracer:
    """A running interpreter for one machine; each program starts from a clean interpreter.

    ``overrides`` replaces or adds INI values, ``{"G12": {"CLEARING": "spiral"}}``; a list
    gives several lines of one key, None takes the key out.  ``tools`` is a tool table file or
    ``{tool number: diameter in machine units}``.  Settings are read when LinuxCNC's Python
    modules load, so other overrides or tools need another Tracer.
    """

    def __init__(self, ini, *, overrides=None, tools=None) -> None: ...

    def trace(self, program, *, setup=(), parameters=None, ask=(), timeout=60.0) -> Trace:
        """Trace the file ``program``.

        ``setup`` holds blocks executed before it whose moves are not reported, ``parameters``
        numbered parameters as the var file would hold them (``{5221: 10.0}`` is G54 X10 in
        machine units), ``ask`` numbered parameters to report back.
        """

    def trace_text(self, text, **options) -> Trace:
        """Trace a program given as text or as a list of lines; see ``trace``."""

    def close(self) -> None:
        """End the interpreter."""


def trace(program, ini, *, overrides=None, tools=None, **options) -> Trace:
    """Trace one program file in an interpreter of its own; see ``Tracer``."""


def trace_text(text, ini, *, overrides=None, tools=None, **options) -> Trace:
    """Trace one program given as text or as a list of lines; see ``Tracer``."""
