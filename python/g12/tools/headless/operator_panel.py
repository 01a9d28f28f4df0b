# SPDX-License-Identifier: GPL-2.0-or-later
"""The operator's side of a running LinuxCNC: enable, home, cycle start.

Used inside a LinuxCNC session, by the headless screen and by the recording screen.
"""

import time
from collections.abc import Callable
from typing import Any

import linuxcnc

from g12.tools.headless.errors import MachineError, Timeout

POLL_PERIOD = 0.01  # s
HOMING = 60.0  # s, for the longest homing
QUIET = 1.0  # s without a joint homing: nothing to home, or done
STALLED = 5.0  # s without motion while a joint is homing: longer than any home switch takes
JOINT_DECIMALS = 6  # of its position; less is noise
GRACE = 5.0  # s, for the machine to react to a command
ERRORS = (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)
NOTICE = "motion.switchkins-type is deprecated"  # once a session, by a LinuxCNC with its own G12.1
TASK_MODES = {
    linuxcnc.MODE_MANUAL: "manual",
    linuxcnc.MODE_AUTO: "auto",
    linuxcnc.MODE_MDI: "mdi",
}


class Panel:
    """One operator.  ``tick`` is called while waiting; errors and messages are collected."""

    def __init__(self, tick: Callable[[], None] = lambda: None) -> None:
        self._command = linuxcnc.command()
        self._stat = linuxcnc.stat()
        self._channel = linuxcnc.error_channel()
        self._tick = tick
        self._errors: list[tuple[str, int]] = []
        self._messages: list[tuple[str, int]] = []

    # Status.

    def poll(self):
        """Return LinuxCNC's present status and collect its messages to the operator."""
        self._stat.poll()
        report = self._channel.poll()
        while report:
            kind, text = report
            is_error = kind in ERRORS and NOTICE not in text
            reports = self._errors if is_error else self._messages
            reports.append((text.strip(), self._stat.read_line))
            report = self._channel.poll()
        return self._stat

    def errors(self) -> list[tuple[str, int]]:
        """Return the errors since the last call: text and the line read at that time."""
        self.poll()
        errors, self._errors = self._errors, []
        return errors

    def messages(self) -> list[tuple[str, int]]:
        """Return the messages since the last call: text and the line read at that time."""
        self.poll()
        messages, self._messages = self._messages, []
        return messages

    def wait(self, condition: Callable[[Any], bool], timeout: float, what: str) -> None:
        """Wait up to ``timeout`` seconds until ``condition`` of the status holds."""
        end = time.monotonic() + timeout
        while not condition(self.poll()):
            self._tick()
            if time.monotonic() > end:
                raise Timeout(f"no {what} within {timeout:g} s{self._complaints()}")
            time.sleep(POLL_PERIOD)

    def _complaints(self) -> str:
        return "".join(f"; {text}" for text, _ in self._errors)

    # Getting ready.

    def enable(self) -> None:
        """Leave e-stop and switch the machine on."""
        self._do(self._command.state, linuxcnc.STATE_ESTOP_RESET)
        self.wait(lambda stat: not stat.estop, GRACE, "release of e-stop")
        self._do(self._command.state, linuxcnc.STATE_ON)
        self.wait(lambda stat: stat.enabled, GRACE, "machine power")

    def home(self) -> None:
        """Home all joints: in the INI's sequence, then those without one."""
        self._mode(linuxcnc.MODE_MANUAL)
        self._do(self._command.teleop_enable, 0)
        self._home(-1)
        for joint in range(self.poll().joints):
            if not self._stat.homed[joint]:
                self._home(joint)
        self.wait(self._homed, GRACE, "homing of every joint")

    def _home(self, joint: int) -> None:
        """Home a joint, or all with -1; raise when homing makes no progress."""
        self._do(self._command.home, joint)
        homing_at = moved_at = time.monotonic()
        last = None

        def over(stat) -> bool:
            nonlocal homing_at, moved_at, last
            now = time.monotonic()
            positions = [round(position, JOINT_DECIMALS) for position in stat.joint_position]
            if positions != last:
                last, moved_at = positions, now
            if any(one["homing"] for one in stat.joint[: stat.joints]):
                homing_at = now
                if now - moved_at > STALLED:
                    raise MachineError(f"homing stands still at {self._joint_positions(stat)}")
            return self._homed(stat) or now - homing_at > QUIET

        self.wait(over, HOMING, "end of homing")

    def _joint_positions(self, stat) -> str:
        joints = enumerate(zip(stat.joint_position[: stat.joints], stat.homed))
        texts = (f"joint {n} {at:g}{' (homed)' * bool(homed)}" for n, (at, homed) in joints)
        return ", ".join(texts) + self._complaints()

    def _homed(self, stat) -> bool:
        return all(stat.homed[: stat.joints])

    # Running.

    def open(self, program: str) -> None:
        self._mode(linuxcnc.MODE_AUTO)
        self._do(self._command.program_open, program)
        self.wait(lambda stat: stat.file == program, GRACE, f"opening of {program}")

    def start(self) -> None:
        self._mode(linuxcnc.MODE_AUTO)
        self._do(self._command.auto, linuxcnc.AUTO_RUN, 0)

    def feed_override(self, scale: float) -> None:
        """Set the feed override; 1 is 100 %."""
        self._do(self._command.feedrate, scale)

    def finish(self, timeout: float) -> None:
        """Wait until the program is done, resuming at program stops (M0, M1)."""
        self.wait(lambda stat: self.is_idle(stat) or self._resume(stat), timeout, "end")

    def _resume(self, stat) -> bool:
        """Resume at a program stop; return False: the program has not ended."""
        if stat.interp_state == linuxcnc.INTERP_PAUSED:
            self._do(self._command.auto, linuxcnc.AUTO_RESUME)
        return False

    @staticmethod
    def is_idle(stat) -> bool:
        done = stat.interp_state == linuxcnc.INTERP_IDLE and not stat.queue
        return done and stat.inpos and stat.exec_state in (linuxcnc.EXEC_DONE, linuxcnc.EXEC_ERROR)

    def _mode(self, mode: int) -> None:
        if self.poll().task_mode != mode:
            self._do(self._command.mode, mode)
            self.wait(lambda stat: stat.task_mode == mode, GRACE, f"{TASK_MODES[mode]} mode")

    def _do(self, action: Callable, *arguments) -> None:
        """Send a command and wait until LinuxCNC has accepted it."""
        action(*arguments)
        serial = self._command.serial
        self.wait(lambda stat: stat.echo_serial_number >= serial, GRACE, "answer from LinuxCNC")
