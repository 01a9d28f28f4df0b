# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs: a headless LinuxCNC (milltask and motion) on any INI, isolated and measured.

Every machine has its own IPC, PID, mount and network namespace, its own HOME, /tmp and runtime
directory, so several run side by side and a LinuxCNC already running is never touched.  The
INI's directory is replaced by a private copy, so that nothing in it is ever written.

The commands only run whole programs; what an operator does step by step is here for tests.

Positions and speeds are in machine units (``Machine.mm`` is one of them in mm), degrees for
rotary axes; sampled positions are those of the axes, tool length included, or of the joints where
the kinematics makes the axes mean other things (`polar_xzc`).
"""

from __future__ import annotations

import shutil
import socket
import subprocess
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

from g12.machine_ini import face_joints
from g12.tools.headless.namespaces import Isolated
from g12.tools.machine.ini import Ini, Overrides, read_ini
from g12.tools.path.samples import Samples
from g12.tools.preview.moves import Error, Message, Modes, modes
from g12.tools.preview.tracer import (
    Parameters,
    Program,
    Tools,
    start_block,
    write_parameters,
    write_program,
    write_tools,
)

PACKAGE = Path(__file__).resolve().parents[3]  # the directory that holds the package g12
MARGIN = 10.0  # s that an answer may take beyond the timeout asked for
NS_PER_S = 1e9
LOG_LINES = 60

SCREEN_NAME = "g12-recording-screen"
SCREEN = {"DISPLAY": SCREEN_NAME}
ANY_OVERRIDE = {"MAX_FEED_OVERRIDE": 100}

TOOL_CHANGE_DIALOGUE = "hal_manualtoolchange"
# Stands in for the screen's tool change dialogue: whoever asks for a tool has it.
TOOL_CHANGE = """\
import hal, time
component = hal.component("hal_manualtoolchange")
component.newpin("number", hal.HAL_S32, hal.HAL_IN)
component.newpin("change", hal.HAL_BIT, hal.HAL_IN)
component.newpin("change_button", hal.HAL_BIT, hal.HAL_IN)
component.newpin("changed", hal.HAL_BIT, hal.HAL_OUT)
component.ready()
while True:
    component["changed"] = component["change"]
    time.sleep(0.01)
"""
RECORDING_SCREEN = """\
import sys
sys.path.insert(0, {package!r})
from g12.tools.headless.recording_screen import serve_runner
serve_runner({address!r}, {pins!r})
"""


class StartupError(RuntimeError):
    """LinuxCNC did not come up; the text ends with LinuxCNC's own log."""


class MachineError(RuntimeError):
    """LinuxCNC did not do what it was asked."""


class Timeout(MachineError):
    """The machine did not get there in time."""


@dataclass(frozen=True)
class Status:
    """What LinuxCNC says of itself, in machine units.

    ``task_mode`` is ``manual``, ``auto`` or ``mdi``; ``interp`` is ``idle``, ``reading``,
    ``paused`` or ``waiting``; ``idle`` says that the interpreter is done and the axes stand.
    ``position`` (commanded) and ``actual`` are nine floats in the order of X Y Z A B C U V W.
    ``motion_line`` is the line of the move being made, ``read_line`` the one last read,
    ``current_line`` what a screen highlights.
    """

    task_mode: str
    interp: str
    enabled: bool
    homed: bool
    paused: bool
    idle: bool
    in_position: bool
    position: tuple[float, ...]
    actual: tuple[float, ...]
    current_line: int
    motion_line: int
    read_line: int
    feed_override: float
    tool: int
    queue: int
    modes: Modes


@dataclass(frozen=True)
class Run:
    """A program run from its start; ``error`` is None if it came to its end.

    LinuxCNC does not tell lines with errors and messages: theirs is the line last read, 0 if
    that was gone.  ``trace`` has the exact ones.

    ``seconds`` is machine time from the first to the last sample in motion, ``position`` where
    the axes stood at the end.
    """

    samples: Samples
    messages: list[Message]
    error: Error | None
    modes: Modes
    position: tuple[float, ...]
    seconds: float


class Machine:
    """A headless LinuxCNC, running, switched on and homed inside its ``with`` block.

    ``overrides`` and ``tools`` as for ``trace.Tracer``; ``parameters`` is what stands in the
    var file at the start (``{5221: 10.0}`` is G54 X10 in machine units) or a var file.
    ``home=False`` leaves the machine in e-stop.  ``timeout`` in seconds is for coming up.
    """

    def __init__(
        self,
        ini: Program,
        *,
        overrides: Overrides | None = None,
        tools: Tools = None,
        parameters: Parameters = None,
        home: bool = True,
        timeout: float = 60.0,
    ) -> None:
        self._isolated = Isolated()
        self._connection: Connection | None = None
        try:
            self.ini = self._private_ini(read_ini(ini).replaced(overrides or {}), tools, parameters)
            self.mm, self._pins = self.ini.mm, position_pins(self.ini)
            self.axes = "".join(self._pins)
            self._start(timeout)
            if home:
                self._get_ready()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Machine:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    @property
    def folder(self) -> Path:
        """The machine's scratch directory: HOME, programs, tool table, log."""
        return self._isolated.folder

    # Operating.

    def mdi(self, text: str, *, wait: bool = True, timeout: float = 60.0) -> None:
        """Execute one block of MDI; without ``wait`` only start it."""
        self._ask("mdi", text)
        if wait:
            self.wait_idle(timeout)

    def open(self, program: Program) -> None:
        """Load a program file; LinuxCNC works on a copy of it."""
        copy = self.folder / "programs" / Path(program).name
        shutil.copyfile(program, copy)
        self._ask("open", str(copy))

    def open_text(self, text: str | Iterable[str]) -> None:
        """Load a program given as text or as lines."""
        path = self.folder / "programs" / "program.ngc"
        self._ask("open", str(write_program(text, path)))

    def start(self, line: int = 0) -> None:
        """Cycle start, or run from ``line``."""
        self._ask("start", line)

    def step(self) -> None:
        """Run the next block and pause."""
        self._ask("step")

    def pause(self) -> None:
        """Feed hold."""
        self._ask("pause")

    def resume(self) -> None:
        """Go on after a pause."""
        self._ask("resume")

    def abort(self) -> None:
        """Stop everything and wait until the axes stand."""
        self._ask("abort")

    def estop(self) -> None:
        """Press the emergency stop; `enable` switches the machine on again, homed as it was."""
        self._ask("estop")

    def enable(self) -> None:
        """Leave e-stop and switch the machine on."""
        self._ask("enable")

    def manual(self) -> None:
        """Go to where the axes are jogged."""
        self._ask("manual")

    def jog(self, axis: int, speed: float) -> None:
        """Jog an axis of `manual`, in units per second, until its speed is set to 0."""
        self._ask("jog", axis, speed)

    def feed_override(self, scale: float) -> None:
        """Set the feed override; 1 is 100 %, and the INI's limit does not hold here."""
        self._ask("feed_override", scale)

    def optional_stop(self, on: bool) -> None:
        """Let M1 stop the program."""
        self._ask("optional_stop", on)

    def block_delete(self, on: bool) -> None:
        """Let blocks that begin with / be skipped."""
        self._ask("block_delete", on)

    def wait_idle(self, timeout: float = 60.0) -> None:
        """Wait until the interpreter is done and the axes stand."""
        self._ask("wait_idle", timeout, timeout=timeout)

    def wait_for(self, condition: Callable[[Status], bool], timeout: float = 60.0) -> Status:
        """Wait until ``condition`` of the status holds, and return that status."""
        end = time.monotonic() + timeout
        while not condition(status := self.stat()):
            if time.monotonic() > end:
                raise Timeout(f"not within {timeout:g} s; last seen: {status}")
            time.sleep(0.005)
        return status

    # Looking.

    def stat(self) -> Status:
        """Return the present status."""
        values = self._ask("stat")
        return Status(**{**values, "modes": modes(*values["modes"])})

    def errors(self) -> list[Error]:
        """Return the operator errors since the last call."""
        return [Error(*said) for said in self._ask("errors")]

    def messages(self) -> list[Message]:
        """Return the operator messages that are no errors, since the last call."""
        return [Message(line, text) for text, line in self._ask("messages")]

    def get(self, pin: str):
        """Return the value of a HAL pin, parameter or signal."""
        return self._ask("get", pin)

    def set(self, pin: str, value) -> None:
        """Set a HAL parameter, a pin that nothing drives, or the signal that a pin reads."""
        self._ask("set", pin, value)

    def sample(self) -> None:
        """Start recording the motion."""
        self._ask("sample")

    def samples(self) -> Samples:
        """Stop recording and return the motion."""
        return self._samples(*self._ask("samples"))

    # Whole programs.

    def run(self, program: Program, timeout: float = 600.0) -> Run:
        """Run a program file to its end or its error, passing over M0 and M1."""
        self.open(program)
        return self._run(timeout)

    def run_text(self, text: str | Iterable[str], timeout: float = 600.0) -> Run:
        """Run a program given as text or as lines; see ``run``."""
        self.open_text(text)
        return self._run(timeout)

    def reset(self) -> None:
        """Go back to how the machine came up: modes, G54, no tool, override, axes at 0, silence."""
        self.abort()
        self.feed_override(1.0)
        zero = " ".join(f"{axis}0" for axis in self.axes)
        turn = " R0" if {"X", "Y"} <= set(self.axes) else ""
        modes_at_start = f"{start_block(self.mm)} G40 G49 G8 G91.1 G97"
        up = ["G53 G0 Z0"] if "Z" in self.axes else []
        away = ["T0 M6"] if self.stat().tool else []
        offsets = ["G92.1", f"G10 L2 P1 {zero}{turn}"]
        for block in ("M2", modes_at_start, *offsets, *away, *up, f"G53 G0 {zero}", "M2"):
            self.mdi(block)
        self.errors(), self.messages()

    def close(self) -> None:
        """End LinuxCNC and everything it started, at once."""
        if self._connection:
            self._connection.close()
        self._isolated.close()

    def log(self) -> str:
        """Return what LinuxCNC has printed so far."""
        return self._isolated.log()

    def _run(self, timeout: float) -> Run:
        self.errors(), self.messages()
        self.sample()
        self.start()
        self._ask("finish", timeout, timeout=timeout)
        samples, status, errors = self.samples(), self.stat(), self.errors()
        moving = samples.time[samples.moving()]
        return Run(
            samples=samples,
            messages=self.messages(),
            error=errors[0] if errors else None,
            modes=status.modes,
            position=status.position,
            seconds=float(moving[-1] - moving[0]) if len(moving) else 0.0,
        )

    def _samples(self, rows: bytes, lost: int) -> Samples:
        columns = np.frombuffer(rows).reshape(-1, len(self.axes) + 4).T
        velocity, requested, line, kind = columns[len(self.axes) :]
        period = self.ini.number("EMCMOT", "SERVO_PERIOD", 1e6) / NS_PER_S
        return Samples(
            time=np.arange(len(velocity)) * period,
            axes=dict(zip(self.axes, columns)),
            velocity=velocity,
            requested=requested,
            line=line.astype(int),
            kind=kind.astype(int),
            lost=lost,
        )

    # Starting.

    def _private_ini(self, ini: Ini, tools: Tools, parameters: Parameters) -> Ini:
        """Return the INI with this machine's own screen and files, which it writes."""
        any_override = {} if face_joints(ini.get) else ANY_OVERRIDE  # where no feed goes by it
        return ini.replaced(
            {
                "DISPLAY": {**SCREEN, **any_override, "INTRO_GRAPHIC": None, "OPEN_FILE": None},
                "APPLICATIONS": {"APP": None},
                "EMCIO": {
                    "TOOL_TABLE": write_tools(tools, ini, self.folder / "tool.tbl"),
                    "DB_PROGRAM": None,
                },
                "RS274NGC": {
                    "PARAMETER_FILE": write_parameters(parameters, self.folder / "machine.var")
                },
            }
        )

    def _start(self, timeout: float) -> None:
        address = str(self.folder / "run" / "socket")
        screen = RECORDING_SCREEN.format(
            package=str(PACKAGE), address=address, pins=[*self._pins.values()]
        )
        self._isolated.install(SCREEN_NAME, screen)
        dialogue = self._isolated.install(TOOL_CHANGE_DIALOGUE, TOOL_CHANGE)
        real_dialogue = shutil.which(TOOL_CHANGE_DIALOGUE)
        path = self.ini.path
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(address)
            listener.listen(1)
            self._isolated.launch(
                ["linuxcnc", "-r", str(path)],
                copies={path.parent: {path.name: self.ini.text}},
                covers={real_dialogue: dialogue} if real_dialogue else None,
            )
            self._connection = self._accept(listener, time.monotonic() + timeout)
        self._receive(timeout)

    def _get_ready(self) -> None:
        try:
            self._ask("enable")
            self._ask("home")
        except MachineError as error:
            raise self._startup_error(str(error)) from error

    def _accept(self, listener: socket.socket, end: float) -> Connection:
        listener.settimeout(0.2)
        while time.monotonic() < end:
            try:
                return Connection(listener.accept()[0].detach())
            except TimeoutError:
                if self._isolated.exit_code() is not None:
                    raise self._startup_error("LinuxCNC ended") from None
        raise self._startup_error("LinuxCNC did not come up in time")

    def _startup_error(self, what: str) -> StartupError:
        last = "\n".join(self.log().splitlines()[-LOG_LINES:])
        return StartupError(f"{self.ini.path}: {what}; its log ends:\n{last}")

    # Talking to the recording screen.

    def _ask(self, name: str, *arguments, timeout: float = 60.0):
        try:
            self._connection.send((name, *arguments))
        except OSError as error:
            raise self._startup_error("LinuxCNC is gone") from error
        return self._receive(timeout)

    def _receive(self, timeout: float):
        try:
            answered = self._connection.poll(timeout + MARGIN)
            worked, result = self._connection.recv() if answered else (False, ("timeout", "hangs"))
        except (EOFError, ConnectionError) as error:
            raise self._startup_error("LinuxCNC ended") from error
        if worked:
            return result
        kind, text = result
        raise (Timeout if kind == "timeout" else MachineError)(text)


def position_pins(ini: Ini) -> dict[str, str]:
    """Return the pin with the position of each axis that the machine has."""
    joints = face_joints(ini.get)
    if joints:
        return {letter: f"joint.{joint}.pos-cmd" for joint, letter in enumerate(joints)}
    return {letter: f"axis.{letter.lower()}.pos-cmd" for letter in ini.axes}


def run(
    program: Program,
    ini: Program,
    *,
    overrides: Overrides | None = None,
    tools: Tools = None,
    parameters: Parameters = None,
    timeout: float = 600.0,
) -> Run:
    """Run one program file on a machine of its own; see ``Machine``."""
    with Machine(ini, overrides=overrides, tools=tools, parameters=parameters) as machine:
        return machine.run(program, timeout)


def smoke(ini: Program, program: Program | None = None, timeout: float = 600.0) -> tuple[int, str]:
    """Run ``linuxcnc -r INI [PROGRAM]`` as it stands, isolated; return its exit code and log."""
    path = Path(ini).absolute()
    command = ["linuxcnc", "-r", str(path)]
    isolated = Isolated()
    try:
        named = [str(Path(program).absolute())] if program else []
        isolated.launch([*command, *named], copies={path.parent: {}})
        return isolated.wait(timeout), isolated.log()
    except subprocess.TimeoutExpired as error:
        raise Timeout(f"{path}: no end within {timeout:g} s\n{isolated.log()}") from error
    finally:
        isolated.close()
