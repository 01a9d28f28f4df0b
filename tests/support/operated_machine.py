# SPDX-License-Identifier: GPL-2.0-or-later
"""A headless LinuxCNC with an operator at it: MDI, cycle start, pause, step, HAL pins."""

import subprocess
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from g12.tools.headless import machine
from g12.tools.headless.errors import Timeout
from g12.tools.headless.machine import Run
from g12.tools.headless.namespaces import Isolated
from g12.tools.material.stock import StockText
from g12.tools.path.follow import Samples
from g12.tools.preview.moves import Error, Message, modes
from g12.tools.preview.tracer import start_block, write_program
from support.judged_programs import Proof, prove
from support.sim_machines import ROOT, SIM, machine_scope


class Machine(machine.Machine):
    """The machine of the commands, and an operator: the methods of `operated_screen` too."""

    screen_module = "support.operated_screen"
    screen_folders = (*machine.Machine.screen_folders, str(ROOT / "tests"))
    recorded: ClassVar[dict[str, str]] = {}  # pins in the samples beside the axes, by letters

    def _start(self) -> None:
        self._pins |= self.recorded
        self.axes = "".join(self._pins)
        super()._start()

    def __getattr__(self, name) -> Callable[..., Any]:
        """Return the request of a method of the screen or its panel."""
        if name.startswith("_"):
            raise AttributeError(name)
        return partial(self._request, name)

    def mdi(self, text, *, wait=True, timeout=60.0) -> None:
        """Execute one block of MDI; without ``wait`` only start it."""
        self._request("mdi", text)
        if wait:
            self.wait_idle(timeout)

    def open_text(self, text) -> None:
        """Load a program given as text or as lines."""
        self._request("open", str(write_program(text, self.folder / "programs" / "program.ngc")))

    def wait_idle(self, timeout=60.0) -> None:
        """Wait until the interpreter is done and the axes stand."""
        self._request("wait_idle", timeout, timeout=timeout)

    def wait_for(self, condition, timeout=60.0) -> SimpleNamespace:
        """Wait until ``condition`` of the status holds, and return that status."""
        end = time.monotonic() + timeout
        while not condition(status := self.stat()):
            if time.monotonic() > end:
                raise Timeout(f"not within {timeout:g} s; last seen: {status}")
            time.sleep(0.005)
        return status

    def wait_for_error(self, text, timeout=60.0) -> None:
        """Wait for an operator error that contains ``text``.

        Those of motion and of the kinematics may arrive when the block has already ended.
        """
        self.wait_for(lambda _: any(text in error.text for error in self.errors()), timeout)

    def stat(self) -> SimpleNamespace:
        """Return the present status, as `operated_screen` describes it."""
        values = self._request("stat")
        return SimpleNamespace(**{**values, "modes": modes(*values["modes"])})

    def errors(self) -> list[Error]:
        """Return the operator errors since the last call."""
        return [Error(*said) for said in self._request("errors")]

    def messages(self) -> list[Message]:
        """Return the operator messages that are no errors, since the last call."""
        return [Message(line, text) for text, line in self._request("messages")]

    def samples(self) -> Samples:
        """Stop recording, which ``sample`` started, and return the motion."""
        self._request("samples")
        return self._samples()

    def run_text(self, text, timeout=600.0) -> Run:
        """Run a program given as text or as lines; see ``run``."""
        return self.run(write_program(text, self.folder / "program.ngc"), timeout)

    def motion_of(self, text, timeout=600.0) -> Samples:
        """Run a program, which must end without an error; return its motion."""
        run = self.run_text(text, timeout)
        assert run.error is None, run.error
        return run.samples

    def proof_of_run(self, text, stock: str = "", tolerance: float | None = None) -> Proof:
        """Run a program, which must end without an error; return the proof of its real motion.

        Verify assumes the state of the machine at its start: see `reset`.
        """
        samples = self.motion_of(text)
        given = StockText(stock) if stock else None
        judged = {"samples": samples, "stock": given, "tolerance": tolerance}
        return prove(self.folder / "program.ngc", self.ini, **judged)

    def reset(self) -> None:
        """Go back to how the machine came up: modes, G54, no tool, override, axes at 0, silence."""
        self.abort()
        self.feed_override(1.0)
        zero = " ".join(f"{axis}0" for axis in self.axes if axis not in self.recorded)
        turn = " R0" if {"X", "Y"} <= set(self.axes) else ""
        modes_at_start = f"{start_block(self.mm)} G40 G49 G8 G91.1 G97"
        up = ["G53 G0 Z0"] if "Z" in self.axes else []
        away = ["T0 M6"] if self.stat().tool else []
        offsets = ["G92.1", f"G10 L2 P1 {zero}{turn}"]
        for block in ("M2", modes_at_start, *offsets, *away, *up, f"G53 G0 {zero}", "M2"):
            self.mdi(block)
        self.errors(), self.messages()


class UnhomedMachine(Machine):
    """A machine in e-stop."""

    def _get_ready(self) -> None:
        pass


def kept_machine(name, kind=Machine, **options):
    """Return a fixture: a simulated machine, for as long as `machine_scope` says."""

    @pytest.fixture(scope=machine_scope)
    def running():
        with kind(SIM / f"{name}.ini", **options) as machine:
            yield machine

    return running


def smoke(ini, program=None, timeout=600.0) -> tuple[int, str]:
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
