# SPDX-License-Identifier: GPL-2.0-or-later
"""The screen program of a headless run: takes the runner's requests.

LinuxCNC starts it instead of the INI's screen.  A request is a list of a method's name and its
arguments, the answer its result or its error. The samples of the motion are in a file.
"""

import array
import os
import socket
import subprocess
import time

import hal

from g12.tools.channel import Channel
from g12.tools.headless.errors import MachineError
from g12.tools.headless.operator_panel import Panel

DEPTH = 20000  # samples in HAL's buffer: 20 s at 1 kHz
DRAIN = 0.05  # s between reads of it
THREAD = "servo-thread"
MOTION_PINS = (
    ("f", "motion.current-vel"),
    ("s", "motion.program-line"),
    ("s", "motion.motion-type"),
)


class Sampler:
    """Records positions, by their pins, and motion at the servo rate: rows of doubles in a file."""

    def __init__(self, file: str, positions: list[str]) -> None:
        self._file = open(file, "wb")  # noqa: SIM115 (as long as the screen)
        pins = [("f", pin) for pin in positions] + list(MOTION_PINS)
        kinds = "".join(kind for kind, _ in pins)
        self._component = hal.component("g12-recording-screen")
        self._component.ready()
        halcmd("loadrt", "sampler", f"depth={DEPTH}", f"cfg={kinds}")
        hal.set_p("sampler.0.enable", "0")
        for number, (kind, pin) in enumerate(pins):
            connect(pin, f"sampler.0.pin.{number}", kind)
        halcmd("addf", "sampler.0", THREAD)
        self._stream = hal.stream(self._component, hal.sampler_base, kinds)

    def start(self) -> None:
        """Discard the samples so far and record from now on."""
        self._halt()
        self._file.seek(0)
        self._file.truncate()
        hal.set_p("sampler.0.overruns", "0")
        hal.set_p("sampler.0.enable", "1")

    def stop(self, complete: bool = True) -> None:
        """Stop; if the rows have to be ``complete``, a gap is an error."""
        self._halt()
        lost = int(hal.get_value("sampler.0.overruns"))
        if lost and complete:
            raise MachineError(f"{lost} samples of the motion are lost: run it on an idle computer")

    def _halt(self) -> None:
        hal.set_p("sampler.0.enable", "0")
        time.sleep(DRAIN)
        self.drain()
        self._file.flush()

    def drain(self) -> None:
        rows = array.array("d")
        while (row := self._stream.read()) is not None:
            rows.extend(row)
        rows.tofile(self._file)


class RecordingScreen:
    """The requests a runner can make, beside those of ``Panel``."""

    panel_kind = Panel

    def __init__(self, samples: str, positions: list[str]) -> None:
        self.sampler = Sampler(samples, positions)
        self._drained = 0.0
        self.panel = self.panel_kind(self.tick)

    def tick(self) -> None:
        """Keep HAL's buffer from overrunning."""
        if time.monotonic() - self._drained > DRAIN:
            self.sampler.drain()
            self._drained = time.monotonic()

    def answer(self, name: str, *arguments) -> dict:
        try:
            method = getattr(self if hasattr(self, name) else self.panel, name)
            return {"result": method(*arguments)}
        except MachineError as error:
            return {"error": type(error).__name__, "text": str(error)}
        except Exception as error:
            return {"error": MachineError.__name__, "text": f"{type(error).__name__}: {error}"}

    def run(self, program: str, timeout: float) -> dict:
        """Run a program to its end; return messages and how it ended."""
        panel = self.panel
        panel.open(program)
        panel.errors(), panel.messages()
        self.sampler.start()
        panel.start()
        panel.finish(timeout)
        errors, stat = panel.errors(), panel.poll()
        self.sampler.stop(complete=not errors)
        return {
            "position": tuple(stat.position),
            "modes": modes_of(stat),
            "errors": [*errors, *panel.errors()],
            "messages": panel.messages(),
        }


def modes_of(stat) -> tuple[tuple, tuple, tuple]:
    return stat.gcodes[1:], stat.mcodes[1:], stat.settings[1:]


def halcmd(*words: str) -> None:
    subprocess.run(["halcmd", *words], check=True, capture_output=True, text=True)


def connect(source: str, target: str, kind: str) -> None:
    """Connect ``target`` to the output pin ``source``, beside its other readers."""
    signal = signals_by_pin().get(source)
    if signal is None:
        signal = f"g12-{source}"
        hal.new_sig(signal, hal.HAL_FLOAT if kind == "f" else hal.HAL_S32)
        hal.connect(source, signal)
    hal.connect(target, signal)


def signals_by_pin() -> dict[str, str]:
    lines = subprocess.run(["halcmd", "-s", "show", "pin"], capture_output=True, text=True)
    words = (line.split() for line in lines.stdout.splitlines())
    return {line[4]: line[6] for line in words if len(line) > 6}


def serve_runner(
    descriptor: int, samples: str, positions: list[str], kind: type = RecordingScreen
) -> None:
    """Answer requests until the runner closes the connection, by a screen of that kind."""
    os.set_inheritable(descriptor, False)
    channel = Channel(socket.socket(fileno=descriptor))
    screen = kind(samples, positions)
    channel.send({"result": "ready"})
    while True:
        while not channel.is_ready(DRAIN):
            screen.tick()
        try:
            request = channel.receive()
        except EOFError:
            return
        channel.send(screen.answer(*request))
