# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs: a headless LinuxCNC (milltask and motion) on any INI, isolated and measured.

Every machine has its own IPC, PID, mount and network namespace, its own HOME, /tmp and runtime
directory, so several run at once, and a LinuxCNC that is already running is not affected.  The
INI's directory is replaced by a private copy, so that nothing in it is ever written.

Positions and speeds are in machine units (``Machine.mm`` is one of them in mm), degrees for
rotary axes; sampled positions are those of the axes, tool length included, or of the joints where
the kinematics changes the meaning of the axes (`polar_xzc`).
"""

import re
import shutil
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from g12.machine_ini import face_joints
from g12.tools.channel import Channel
from g12.tools.errors import ProgramError
from g12.tools.headless.errors import SENT, MachineError, StartupError, Timeout
from g12.tools.headless.namespaces import Isolated
from g12.tools.machine.ini import Ini, Overrides, read_ini
from g12.tools.path.samples import Samples
from g12.tools.preview.ended import explained_text
from g12.tools.preview.moves import Error, Message, Modes, modes
from g12.tools.preview.tracer import (
    Parameters,
    ProgramPath,
    Tools,
    write_parameters,
    write_tools,
)

PACKAGE = Path(__file__).resolve().parents[3]  # the directory that holds the package g12
ANSWER_MARGIN = 10.0  # s that an answer may take beyond the requested timeout
START = 60.0  # s that LinuxCNC may take to start
MOST_SECONDS = 24 * 3600.0  # of a run
LOG_LINES = 60
INI_ERROR = re.compile(r"\.ini:(\d+): error: (.*)")  # of LinuxCNC 2.10
FAREWELL = "LinuxCNC terminated with an error"  # then come the files with the same text
NOISE = "Running with fallback_uid"  # for each module that is loaded
SHUTTING_DOWN = ("Shutting down", "Note: Using POSIX")

SCREEN_NAME = "g12-recording-screen"
SAMPLES_FILE = "samples"  # file of the scratch directory: rows of doubles
SCREEN = {"DISPLAY": SCREEN_NAME}
ANY_OVERRIDE = {"MAX_FEED_OVERRIDE": 100}

TOOL_CHANGE_DIALOGUE = "hal_manualtoolchange"
# Replaces the screen's tool change dialogue: every requested tool is confirmed.
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
sys.path[:0] = {folders!r}
from {module} import serve_runner
serve_runner({descriptor}, {samples!r}, {pins!r})
"""


@dataclass(frozen=True)
class Run:
    """A program run from its start; ``error`` is None if it ran to its end.

    LinuxCNC reports no lines with errors and messages: theirs is the line last read, 0 if that is
    unknown. ``trace`` has the exact ones. ``seconds`` is machine time from the first to the last
    sample in motion, ``position`` that of the axes at the end.
    """

    samples: Samples
    messages: list[Message]
    error: Error | None
    modes: Modes
    position: tuple[float, ...]
    seconds: float


class Machine:
    """A headless LinuxCNC, running, switched on and homed inside its ``with`` block.

    ``overrides`` and ``tools`` as for ``trace.Tracer``; ``parameters`` is the content of the var
    file at the start (``{5221: 10.0}`` is G54 X10 in machine units) or a var file.
    ``screen_module`` answers inside LinuxCNC; Python looks for it in ``screen_folders``.
    """

    screen_module = "g12.tools.headless.recording_screen"
    screen_folders = (str(PACKAGE),)

    def __init__(
        self,
        ini: ProgramPath,
        *,
        overrides: Overrides | None = None,
        tools: Tools = None,
        parameters: Parameters = None,
    ) -> None:
        self._isolated = Isolated()
        self._channel: Channel | None = None
        try:
            self.ini = self._private_ini(read_ini(ini).replaced(overrides or {}), tools, parameters)
            self.mm, self._pins = self.ini.mm, position_pins(self.ini)
            self.axes = "".join(self._pins)
            self._start()
            self._get_ready()
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    @property
    def folder(self) -> Path:
        """The machine's scratch directory: HOME, programs, tool table, log."""
        return self._isolated.folder

    def feed_override(self, scale: float) -> None:
        """Set the feed override; 1 is 100 %, without the INI's limit."""
        self._request("feed_override", scale)

    def run(self, program: ProgramPath, timeout: float = 600.0) -> Run:
        """Run a program file to its end or its error, resuming at M0 and M1.

        LinuxCNC works on a copy of it.
        """
        copy = self.folder / "programs" / Path(program).name
        shutil.copyfile(program, copy)
        answer = self._request("run", str(copy), timeout, timeout=timeout)
        samples, errors = self._samples(), answer["errors"]
        moving = samples.time[samples.moving()]
        return Run(
            samples=samples,
            messages=[Message(line, text) for text, line in answer["messages"]],
            error=Error(*errors[0]) if errors else None,
            modes=modes(*answer["modes"]),
            position=tuple(answer["position"]),
            seconds=float(moving[-1] - moving[0]) if len(moving) else 0.0,
        )

    def close(self) -> None:
        """End LinuxCNC and everything it started, at once."""
        if self._channel:
            self._channel.close()
        self._isolated.close()

    def _samples(self) -> Samples:
        columns = np.fromfile(self.folder / SAMPLES_FILE).reshape(-1, len(self.axes) + 3).T
        velocity, line, kind = columns[len(self.axes) :]
        return Samples(
            time=np.arange(len(velocity)) * self.ini.servo_period,
            axes=dict(zip(self.axes, columns)),
            velocity=velocity,
            line=line.astype(int),
            kind=kind.astype(int),
        )

    # Starting.

    def _private_ini(self, ini: Ini, tools: Tools, parameters: Parameters) -> Ini:
        """Return the INI with this machine's own screen and files, which it writes."""
        any_override = {} if face_joints(ini.get) else ANY_OVERRIDE  # no feed depends on it
        table = write_tools(tools, ini, self.folder / "tool.tbl")
        variables = write_parameters(parameters, self.folder / "machine.var")
        return ini.replaced(
            {
                "DISPLAY": {**SCREEN, **any_override, "INTRO_GRAPHIC": None, "OPEN_FILE": None},
                "APPLICATIONS": {"APP": None},
                "EMCIO": {"TOOL_TABLE": str(table), "DB_PROGRAM": None},
                "RS274NGC": {"PARAMETER_FILE": str(variables)},
            }
        )

    def _start(self) -> None:
        here, there = socket.socketpair()
        self._channel = Channel(here)
        with there:
            self._install_screen(there.fileno())
            dialogue = self._isolated.install(TOOL_CHANGE_DIALOGUE, TOOL_CHANGE)
            real_dialogue = shutil.which(TOOL_CHANGE_DIALOGUE)
            path = self.ini.path
            self._isolated.launch(
                ["linuxcnc", "-r", str(path)],
                copies={path.parent: {path.name: self.ini.text}},
                covers={real_dialogue: dialogue} if real_dialogue else None,
                inherited=(there.fileno(),),
            )
        if not self._channel.is_ready(START):
            raise self._startup_error("LinuxCNC did not come up in time")
        self._receive(START)

    def _install_screen(self, descriptor: int) -> None:
        screen = RECORDING_SCREEN.format(
            folders=self.screen_folders,
            module=self.screen_module,
            descriptor=descriptor,
            samples=str(self.folder / SAMPLES_FILE),
            pins=[*self._pins.values()],
        )
        self._isolated.install(SCREEN_NAME, screen)

    def _get_ready(self) -> None:
        try:
            self._request("enable")
            self._request("home")
        except MachineError as error:
            raise self._startup_error(str(error)) from error

    def _startup_error(self, what: str) -> StartupError:
        return StartupError(
            f"{self.ini.path}: {startup_error(what, self._isolated.log(), self.ini)}"
        )

    # Requests to the recording screen.

    def _request(self, name: str, *arguments, timeout: float = 60.0):
        try:
            self._channel.send([name, *arguments])
        except OSError as error:
            raise self._startup_error("LinuxCNC ended") from error
        return self._receive(timeout)

    def _receive(self, timeout: float):
        try:
            if not self._channel.is_ready(timeout + ANSWER_MARGIN):
                raise Timeout("hangs")
            answer = self._channel.receive()
        except (EOFError, ConnectionError) as error:
            raise self._startup_error("LinuxCNC ended") from error
        if "error" in answer:
            raise SENT[answer["error"]](answer["text"])
        return answer["result"]


# Whole runs, each on a machine of its own.


def run_program(
    program: Path,
    ini: Path,
    tools: Tools = None,
    parameters: Parameters = None,
    override: float = 100.0,
) -> Run:
    """Return the run of a program that runs to its end, or raise ProgramError.

    ``override`` is the feed override in per cent.
    """
    result = run_anyhow(program, ini, tools, parameters, override)
    if result.error:
        raise ProgramError(f"{program}: {explained_text(result.error.text, ini)}")
    return result


def run_anyhow(
    program: Path,
    ini: Path,
    tools: Tools = None,
    parameters: Parameters = None,
    override: float = 100.0,
    timeout: float = MOST_SECONDS,
) -> Run:
    """Return the run of a program that may end with an error; ``timeout`` is in seconds.

    LinuxCNC runs a copy of the program; the program's own name replaces the copy's in its texts.
    """
    faster = {"DISPLAY": {"MAX_FEED_OVERRIDE": max(1.0, override / 100.0)}}
    with Machine(ini, tools=tools, parameters=parameters, overrides=faster) as machine:
        machine.feed_override(override / 100.0)
        try:
            return machine.run(program, timeout)
        except MachineError as problem:
            copy = rf"[^\s'\"]*/{re.escape(program.name)}"
            raise type(problem)(re.sub(copy, str(program), str(problem))) from None


# The machine's INI and log.


def position_pins(ini: Ini) -> dict[str, str]:
    """Return the pin with the position of each axis that the machine has."""
    joints = face_joints(ini.get)
    if joints:
        return {letter: f"joint.{joint}.pos-cmd" for joint, letter in enumerate(joints)}
    return {letter: f"axis.{letter.lower()}.pos-cmd" for letter in ini.axes}


def startup_error(what: str, log: str, ini: Ini) -> str:
    """Return a text for what happened at LinuxCNC's start with an INI, by its log."""
    refused = INI_ERROR.search(log)
    if refused:  # with the line's text: its number is that of a copy
        line = ini.lines[int(refused[1]) - 1].strip()
        return f"LinuxCNC does not read it: {refused[2]}: {line}"
    last = "\n".join(lines_to_last_error(log)[-LOG_LINES:])
    return f"{what}; its log ends:\n{last}"


def lines_to_last_error(log: str) -> list[str]:
    """Return the lines of LinuxCNC's log up to the last one that reports an error."""
    lines = [line for line in log.partition(FAREWELL)[0].splitlines() if NOISE not in line]
    while lines and lines[-1].startswith(SHUTTING_DOWN):
        lines.pop()
    return lines or log.splitlines()
