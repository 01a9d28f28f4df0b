# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact traces: a program and an INI in, the list of moves at full precision out.

LinuxCNC's own preview module interprets the program in a process of its own
(``worker.py``), so nothing here needs a running LinuxCNC or a screen.

Lengths are millimetres and angles degrees, whatever the program and the machine use.
Positions are those of the controlled point in machine coordinates: work offsets, G92 and the
rotation of the work coordinate system are resolved.  The tool length offset is not added, so
with no work offset they are the program's positions.  (A real machine's axes stand at the
position plus ``Move.tool_offset``.)

The preview differs from a real machine in one thing that programs can see: when the units
change, it forgets F and G64's tolerances (it takes 1 and 0.1) where the machine converts them.
"""

from __future__ import annotations

import math
import os
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple, Union

from g12.tools.machine.ini import Ini, Overrides, read_ini
from g12.tools.system import PYTHON

WORKER = Path(__file__).with_name("worker.py")
LAUNCH = (
    "import sys; sys.path[0] = {folder!r}; import worker; sys.path.pop(0); "
    "worker.serve({descriptor})"
)
LEAVE_NO_TRACE = {"PYTHONDONTWRITEBYTECODE": "1"}  # nothing is written beside the INI
MM_PER_INCH = 25.4
SAME_POINT = 1e-6  # mm; an arc whose ends are nearer is a full circle, as in motion
START_BLOCKS = {1.0: "G21 G64 P0.0254 Q0", MM_PER_INCH: "G20 G64 P0.001 Q0"}  # as task starts
NO_END = "File ended with no percent sign or program end"
AXES = "XYZABCUVW"
THIRD_AXIS = {17: 2, 18: 1, 19: 0}

Position = tuple  # nine floats in the order of AXES: mm, degrees for A, B, C
Program = Union[str, os.PathLike]
Tools = Union[str, os.PathLike, Mapping[int, float], None]
Parameters = Union[str, os.PathLike, Mapping[int, float], None]


class Message(NamedTuple):
    """A text for the operator that is no error: ``(MSG, …)`` or a handler's MESSAGE."""

    line: int
    text: str


class Event(NamedTuple):
    """What the program does between two moves, as text: ``tool 1``, ``S1000``, ``M8 on``.

    ``at`` is the index of the move that follows, ``line`` the program's line.  LinuxCNC tells
    of spindle, coolant, work offset and path mode when the next line starts.
    """

    at: int
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


class Move(NamedTuple):
    """One canonical move.

    ``kind`` is ``rapid``, ``feed``, ``arc`` or ``probe``.  ``line`` is what the interpreter says
    and a GUI highlights: in a subroutine that subroutine's line, in a Python remap 0 unless the
    remap sets it.  ``block`` is the line of the program itself whose block makes the move; in a
    G12.1 section that is the contour's block.

    ``feed`` is mm/min under ``feed_mode`` G94 and G93 (the interpreter resolves inverse time),
    mm/rev under G95; degrees for a straight move of rotary axes alone; 0 for a rapid.
    ``plane`` is 17, 18 or 19, ``tool`` the number of the tool in the spindle, 0 or less for
    none.

    Of an arc, ``centre`` is the centre (x, y, z) at the level of the start, ``turns`` the
    interpreter's count (positive counterclockwise seen from the plane's positive third axis,
    1 or -1 for anything up to a full circle) and ``rotation`` the angle of the work coordinate
    system about Z in degrees, which turns G18 and G19 planes.

    ``remap`` is the remapped code that makes the move, ``G12``, "" without one.
    """

    kind: str
    line: int
    block: int
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
    remap: str = ""

    @property
    def radius(self) -> float:
        """Radius of an arc at its start, mm."""
        return math.hypot(*self._in_plane(self.start)[:2])

    @property
    def sweep(self) -> float:
        """Signed angle of an arc in radians, positive counterclockwise in its plane."""
        one, two, _ = self._in_plane(self.start)
        end_one, end_two, _ = self._in_plane(self.end)
        angle = math.atan2(one * end_two - two * end_one, one * end_one + two * end_two)
        turn = math.copysign(2 * math.pi, self.turns)
        closed = math.dist((one, two), (end_one, end_two)) < SAME_POINT
        first = turn if closed else angle + (turn if angle * turn < 0 else 0.0)
        return first + turn * (abs(self.turns) - 1)

    @property
    def length(self) -> float:
        """Length of the path in X, Y, Z, mm (the helix of an arc included)."""
        if self.kind != "arc":
            return math.dist(self.start[:3], self.end[:3])
        rise = self._in_plane(self.end)[2] - self._in_plane(self.start)[2]
        return math.hypot(self.radius * self.sweep, rise)

    def point(self, fraction: float) -> Position:
        """Return the position after ``fraction`` (0 to 1) of the move."""
        straight = tuple(a + (b - a) * fraction for a, b in zip(self.start, self.end))
        if self.kind != "arc":
            return straight
        one, two, three = self._in_plane(self.start)
        end_one, end_two, end_three = self._in_plane(self.end)
        growth = 1 + (math.hypot(end_one, end_two) / self.radius - 1) * fraction
        cos, sin = math.cos(self.sweep * fraction), math.sin(self.sweep * fraction)
        turned = ((one * cos - two * sin) * growth, (one * sin + two * cos) * growth)
        level = three + (end_three - three) * fraction
        return (*self._out_of_plane((*turned, level)), *straight[3:])

    def tangent(self, fraction: float) -> tuple[float, float, float]:
        """Return the unit direction in X, Y, Z after ``fraction``; zeros if they stand still."""
        if self.kind == "arc":
            direction = self._arc_direction(fraction)
        else:
            direction = [b - a for a, b in zip(self.start[:3], self.end[:3])]
        size = math.hypot(*direction)
        return tuple(value / size if size else 0.0 for value in direction)

    def _arc_direction(self, fraction: float) -> list[float]:
        one, two, _ = self._in_plane(self.point(fraction))
        rise = (self._in_plane(self.end)[2] - self._in_plane(self.start)[2]) / self.sweep
        around = math.copysign(1.0, self.sweep)
        velocity = (-two * around, one * around, rise * around)
        tip = self._out_of_plane(velocity)
        return [value - origin for value, origin in zip(tip, self.centre)]

    def _in_plane(self, position: Sequence[float]) -> tuple[float, float, float]:
        """First, second and third axis of the plane, seen from the centre of the arc."""
        x, y, z = (value - origin for value, origin in zip(position, self.centre))
        x, y = _turned(x, y, -self.rotation)
        third = THIRD_AXIS[self.plane]
        return ((x, y, z) * 2)[third + 1 : third + 4]

    def _out_of_plane(self, values: Sequence[float]) -> tuple[float, float, float]:
        """Back from the plane's axes to X, Y, Z."""
        third = THIRD_AXIS[self.plane]
        x, y, z = (tuple(values) * 2)[2 - third : 5 - third]
        x, y = _turned(x, y, self.rotation)
        return tuple(value + origin for value, origin in zip((x, y, z), self.centre))


@dataclass(frozen=True)
class Trace:
    """What one program did.

    ``error`` is None for a program that ran to its end.  ``modes`` is the state behind the last
    block that succeeded, M2 included; ``state`` the interpreter's variables themselves, after
    the refused block if there was one (motion_mode, plane, feed_rate …, program units).
    ``printed`` is the text of ``(print, …)`` and of Python, ``position`` where the last move
    ended, ``globals`` the global named parameters that the program left, ``numbered`` the
    parameters asked for, ``seconds`` the interpreter's time.  ``events`` holds the messages too.
    ``files`` are those of subs outside the program that execute a remapped code which moves.
    """

    moves: list[Move]
    messages: list[Message]
    events: list[Event]
    error: Error | None
    modes: Modes
    state: dict[str, float]
    printed: str
    position: Position
    globals: dict[str, float]
    numbered: dict[int, float]
    seconds: float
    files: tuple[str, ...] = ()


class TraceFailure(RuntimeError):
    """The interpreter died, ran out of time or did not start: no word about the program."""


class Tracer:
    """A running interpreter for one machine; each program starts from a clean interpreter.

    ``overrides`` replaces or adds INI values, ``{"G12": {"CLEARING": "spiral"}}``; a list
    gives several lines of one key, None takes the key out.  ``tools`` is a tool table file or
    ``{tool number: diameter in machine units}`` in place of the INI's table.  Settings are read
    when LinuxCNC's Python modules load, so other overrides or tools need another Tracer.
    ``folder`` is its scratch directory.
    ``printed`` is what the interpreter and the machine's modules said while loading.
    """

    def __init__(
        self, ini: Program | Ini, *, overrides: Overrides | None = None, tools: Tools = None
    ) -> None:
        self._scratch = tempfile.TemporaryDirectory(prefix="g12-trace-")
        self.folder = Path(self._scratch.name)
        ini = ini if isinstance(ini, Ini) else read_ini(ini)
        self.ini = ini.replaced(overrides or {})
        self._machine = _machine(self.ini, tools, self.folder)
        self._start()

    def __enter__(self) -> Tracer:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def trace(
        self,
        program: Program,
        *,
        setup: Iterable[str] = (),
        parameters: Parameters = None,
        ask: Iterable[int] = (),
        timeout: float = 60.0,
        alone: bool = False,
    ) -> Trace:
        """Trace the file ``program``.

        ``setup`` holds blocks executed before it whose moves are not reported.  ``parameters``
        are numbered parameters as the var file holds them (``{5221: 10.0}`` is G54 X10 in
        machine units) or a var file; without them all are 0.  ``ask`` names numbered parameters
        to report back.  ``timeout`` is in seconds.  ``alone`` makes sure that nothing is left
        of the program in Python modules of the machine that keep state between programs.
        """
        request = {
            "program": str(Path(program).absolute()),
            "parameter_file": str(write_parameters(parameters, self.folder / "trace.var")),
            "setup": list(setup),
            "ask": list(ask),
            "alone": alone,
        }
        if not self._process:
            self._start()
        self._connection.send(request)
        return _trace(self._answer(timeout))

    def trace_text(self, text: str | Iterable[str], **options) -> Trace:
        """Trace a program given as text or as lines; see ``trace``.

        Here a program need not end in M2 or %; without M2 the modal state stays as it is.
        """
        program = write_program(text, self.folder / "program.ngc")
        traced = self.trace(program, **options)
        unended = traced.error and traced.error.text == NO_END
        return replace(traced, error=None) if unended else traced

    def close(self) -> None:
        """End the interpreter."""
        self._stop()
        self._scratch.cleanup()

    def _start(self) -> None:
        here, there = socket.socketpair()
        launch = LAUNCH.format(folder=str(WORKER.parent), descriptor=there.fileno())
        with there, open(self._machine["output"], "ab") as output:
            self._process = subprocess.Popen(
                [PYTHON, "-c", launch],
                cwd=self.ini.directory,
                env={**os.environ, "HOME": str(self.folder), "LC_ALL": "C", **LEAVE_NO_TRACE},
                pass_fds=[there.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
            )
        self._connection = Connection(here.detach())
        self._connection.send(self._machine)
        answer = self._answer(60.0)
        if answer["error"]:
            self.close()
            raise TraceFailure(f"{self.ini.path}: {answer['printed']}{answer['error'][0]}")
        self.printed = answer["printed"]

    def _stop(self) -> None:
        if self._process:
            self._process.kill()
            self._process.wait()
            self._connection.close()
            self._process = None

    def _answer(self, timeout: float) -> dict:
        try:
            answer = self._connection.recv() if self._connection.poll(timeout) else None
        except (EOFError, ConnectionError):
            answer = {"failure": "the interpreter died"}
        if answer is None:
            answer = {"failure": f"no end within {timeout:g} s"}
        if "failure" in answer:
            self._stop()
            log = Path(self._machine["output"]).read_text(encoding="utf-8", errors="replace")
            raise TraceFailure(f"{answer['failure']}\n{log}".strip())
        return answer


def trace(
    program: Program,
    ini: Program,
    *,
    overrides: Overrides | None = None,
    tools: Tools = None,
    **options,
) -> Trace:
    """Trace one program file in an interpreter of its own; see ``Tracer``."""
    with Tracer(ini, overrides=overrides, tools=tools) as tracer:
        return tracer.trace(program, **options)


def trace_text(
    text: str | Iterable[str],
    ini: Program,
    *,
    overrides: Overrides | None = None,
    tools: Tools = None,
    **options,
) -> Trace:
    """Trace one program given as text or as lines; see ``Tracer``."""
    with Tracer(ini, overrides=overrides, tools=tools) as tracer:
        return tracer.trace_text(text, **options)


def write_program(text: str | Iterable[str], path: Path) -> Path:
    """Write a program given as text or as lines to ``path``."""
    text = text if isinstance(text, str) else "\n".join(text)
    path.write_text(text if text.endswith("\n") else text + "\n", encoding="utf-8")
    return path


def modes(gcodes: Iterable[int], mcodes: Iterable[int], settings: Sequence[float]) -> Modes:
    """Return the modal state from LinuxCNC's arrays, each without its first item."""
    return Modes(
        tuple(f"G{code / 10:g}" for code in gcodes if code >= 0),
        tuple(f"M{code}" for code in mcodes if code > 0),
        settings[0],
        settings[1],
        tuple(settings[2:4]),
    )


def write_tools(tools: Tools, ini: Ini, path: Path) -> Path:
    """Write the tool table to use to ``path``: the INI's own, a file's or the one given."""
    source = ini.file("EMCIO", "TOOL_TABLE") if tools is None else tools
    if isinstance(source, Mapping):
        lines = (f"T{tool} P{tool} D{diameter!r}\n" for tool, diameter in source.items())
        path.write_text("".join(lines), encoding="ascii")
    elif source and Path(source).exists():
        shutil.copyfile(source, path)
    else:
        path.write_text("", encoding="ascii")
    return path


def write_parameters(parameters: Parameters, path: Path) -> Path:
    """Write the var file to use to ``path``."""
    if isinstance(parameters, Mapping) or parameters is None:
        lines = (f"{number}\t{value!r}\n" for number, value in sorted((parameters or {}).items()))
        path.write_text("".join(lines), encoding="ascii")
    else:
        shutil.copyfile(parameters, path)
    return path


def mm_per_unit(ini: Ini) -> float:
    """Return the machine unit in mm."""
    units = ini.get("TRAJ", "LINEAR_UNITS", "mm").lower()
    return {"mm": 1.0, "metric": 1.0}.get(units, MM_PER_INCH)


def _machine(ini: Ini, tools: Tools, folder: Path) -> dict:
    """Return what the worker needs to know of the machine; its files go to ``folder``."""
    expanded = folder / "machine.ini"
    expanded.write_text(ini.text, encoding="utf-8", errors="surrogateescape")
    unit = mm_per_unit(ini)
    letters = "".join(ini.words("TRAJ", "COORDINATES", "XYZ")).upper()
    startup = ini.get("RS274NGC", "RS274NGC_STARTUP_CODE")
    return {
        "ini": str(expanded),
        "output": str(folder / "output.txt"),
        "tool_table": str(write_tools(tools, ini, folder / "tool.tbl")),
        "random": ini.get("EMCIO", "RANDOM_TOOLCHANGER", "0") not in ("0", ""),
        "units": 1.0 / unit,
        "axis_mask": sum(1 << AXES.index(letter) for letter in set(letters)),
        "setup": [START_BLOCKS[unit], "F0", *([startup] if startup else [])],
    }


def _trace(answer: dict) -> Trace:
    return Trace(
        moves=[Move._make(move) for move in answer["moves"]],
        messages=[Message._make(message) for message in answer["messages"]],
        events=[Event._make(event) for event in answer["events"]],
        error=Error._make(answer["error"]) if answer["error"] else None,
        modes=modes(answer["gcodes"], answer["mcodes"], answer["settings"]),
        **{key: answer[key] for key in ("state", "printed", "position", "seconds")},
        **{key: answer[key] for key in ("globals", "numbered")},
        files=tuple(answer["files"]),
    )


def _turned(x: float, y: float, degrees: float) -> tuple[float, float]:
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return x * cos - y * sin, x * sin + y * cos
