# SPDX-License-Identifier: GPL-2.0-or-later
"""The recording screen with an operator: what a test does with a machine, inside LinuxCNC."""

import hal
import linuxcnc

from g12.tools.headless import recording_screen
from g12.tools.headless.operator_panel import GRACE, TASK_MODES, Panel
from g12.tools.headless.recording_screen import RecordingScreen, modes_of, signals_by_pin

AXIS_JOG = 0  # of an axis, not of a joint
PATIENCE = 20.0  # s, for milltask to come up
CYCLES = 20  # of milltask: more than an abort has queued
STEP_CYCLES = 4  # of it, within which a step begins to move
INTERPRETER = {
    linuxcnc.INTERP_IDLE: "idle",
    linuxcnc.INTERP_READING: "reading",
    linuxcnc.INTERP_PAUSED: "paused",
    linuxcnc.INTERP_WAITING: "waiting",
}


class OperatedPanel(Panel):
    """All that an operator does."""

    def enable(self):
        """Switch the machine on; what its last abort has queued is done then."""
        super().enable()
        self.settle()

    def estop(self):
        self._do(self._command.state, linuxcnc.STATE_ESTOP)
        self.wait(lambda stat: not stat.enabled, GRACE, "e-stop")

    def off(self):
        """Switch the machine off."""
        self._do(self._command.state, linuxcnc.STATE_OFF)
        self.wait(lambda stat: not stat.enabled, GRACE, "machine off")

    def manual(self):
        self._mode(linuxcnc.MODE_MANUAL)

    def mdi_mode(self):
        self._mode(linuxcnc.MODE_MDI)

    def jog(self, axis, speed):
        """Jog an axis, in units per second, until its speed is set to 0."""
        if speed:
            self._do(self._command.jog, linuxcnc.JOG_CONTINUOUS, AXIS_JOG, axis, speed)
        else:
            self._do(self._command.jog, linuxcnc.JOG_STOP, AXIS_JOG, axis)

    def mdi(self, text):
        self.mdi_mode()
        self._do(self._command.mdi, text)

    def start(self, line=0):
        """Cycle start, or run from a line."""
        self._mode(linuxcnc.MODE_AUTO)
        self._do(self._command.auto, linuxcnc.AUTO_RUN, line)

    def step(self):
        """Make one step; the machine stands again afterwards.

        A second step while it moves would make LinuxCNC pass over the stop of the first.
        """
        self._mode(linuxcnc.MODE_AUTO)
        self._do(self._command.auto, linuxcnc.AUTO_STEP)
        self.settle(STEP_CYCLES)
        while hal.get_value("motion.current-vel"):
            self.settle(STEP_CYCLES)

    def settle(self, cycles=CYCLES):
        """Wait until milltask has executed what it has queued: one command a cycle.

        Every answer is a cycle of it, however busy the computer is.
        """
        for _ in range(cycles):
            self._do(self._command.debug, self.poll().debug)

    def pause(self):
        self._do(self._command.auto, linuxcnc.AUTO_PAUSE)

    def resume(self):
        self._do(self._command.auto, linuxcnc.AUTO_RESUME)

    def abort(self, wait=True):
        """Abort; with ``wait`` until what the abort has queued is done, too.

        A change of the mode before that would drop it.
        """
        self._do(self._command.abort)
        if wait:
            self.wait_idle(PATIENCE)
            self.settle()

    def wait_idle(self, timeout):
        self.wait(self.is_idle, timeout, "end of motion")


class OperatedScreen(RecordingScreen):
    """The requests of a test to LinuxCNC, HAL and the sampler too."""

    panel_kind = OperatedPanel

    def stat(self):
        """Return the status as plain values, in machine units.

        ``idle``: the interpreter is done and the axes are at rest. ``position`` (commanded) and
        ``actual`` are nine floats. ``motion_line`` is the line of the move in motion.
        """
        self.panel.wait(lambda stat: stat.task_mode in TASK_MODES, PATIENCE, "milltask")
        stat = self.panel.poll()
        return {
            "task_mode": TASK_MODES[stat.task_mode],
            "interp": INTERPRETER[stat.interp_state],
            "enabled": bool(stat.enabled),
            "paused": bool(stat.paused),
            "idle": self.panel.is_idle(stat),
            "in_position": bool(stat.inpos),
            "position": tuple(stat.position),
            "actual": tuple(stat.actual_position),
            "motion_line": stat.motion_line,
            "feed_override": stat.feedrate,
            "tool": stat.tool_in_spindle,
            "queue": stat.queue,
            "adaptive": bool(stat.adaptive_feed_enabled),
            "modes": modes_of(stat),
        }

    def get(self, pin):
        return hal.get_value(pin)

    def set(self, pin, value):
        """Set a HAL parameter, a pin that nothing drives, or the signal that a pin reads."""
        signal = signals_by_pin().get(pin)
        text = str(int(value)) if isinstance(value, bool) else str(value)
        hal.set_s(signal, text) if signal else hal.set_p(pin, text)

    def connect(self, pin):
        """Connect a pin of a float to a signal of its own."""
        hal.new_sig(f"{pin}-net", hal.HAL_FLOAT)
        hal.connect(pin, f"{pin}-net")

    def sample(self):
        self.sampler.start()

    def samples(self):
        self.sampler.stop()


def serve_runner(descriptor, samples, positions):
    recording_screen.serve_runner(descriptor, samples, positions, OperatedScreen)
