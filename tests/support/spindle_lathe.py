# SPDX-License-Identifier: GPL-2.0-or-later
"""The lathe whose spindle becomes C, with its spindle and its drive recorded beside the axes."""

import random
import time
from typing import ClassVar

import numpy as np
import pytest

from support.operated_machine import Machine
from support.sim_machines import SIM

SPINDLE_LATHE = SIM / "lathe_spindle_c_mm.ini"
PINS = {
    "F": "joint.2.pos-fb",
    "E": "joint.2.f-error",
    "T": "encoder-turns.out",
    "P": "sc-to-position.out",
    "L": "sc-least.out",
}
FIRST = ["G21 G18 G8 G40 G90 G94 G97 G64 P0.01", "G0 X40 Z5"]
TEN_CHANGES = [block for turn in range(10) for block in ("M254", f"G0 C{37 * turn % 100}", "M255")]
FLATS = ["M254", "G0 X40 Z2 C0", "G12.1", "G1 X20 C20 F3000", "X20 C-20", "X40", "G13.1", "M255"]
UNLOCKED = -1000.0  # least C, below it while the spindle is C


class SpindleLathe(Machine):
    """A machine of `SPINDLE_LATHE`'s kind; samples have these axes too, degrees and turns.

    F and E are C's feedback and following error, T the encoder, P the drive's position input, L the
    least that C may command.
    """

    recorded: ClassVar = PINS

    def is_c(self):
        """Tell whether the spindle is C."""
        return self.get("spindle-c-on")


CUT = [*FIRST, "S600 M3", "G4 P0.3", "M254", *FLATS[1:-1], "G0 C50", "M255", "S500 M4", "G4 P0.3"]
LOST = "The spindle is no longer C: the machine was off. C on again before C moves"
TYPED = (
    "M254",
    "M255",
    "G0 C77",
    "S300 M3",
    "G0 C-30",
    "o<face_hole_at> call [9] [0] [1] [1]",
)
PINS_OFF = {  # what makes LinuxCNC switch the machine off, and what ends it
    "machine off": ("motion.enable", False),
    "limit": ("joint.0.pos-lim-sw-in", True),
}
INTERRUPTS = ("abort", "estop", *PINS_OFF, "mdi", "mdi estop")


def interrupted(lathe, interrupt, chance):
    """Interrupt the program or MDI at a random moment, look at what is left, run the next one."""
    if interrupt.startswith("mdi"):
        for block in chance.choices(TYPED, k=3):
            lathe.mdi(block)
        lathe.errors()
        lathe.mdi(chance.choice(TYPED), wait=False)
        time.sleep(chance.uniform(0, 1.5))
    else:
        lathe.open_text([*CUT, "M5", "M2"])
        lathe.start()
        time.sleep(chance.uniform(0.1, 7))
    commanded, pin = lathe.get("motion.digital-out-02"), PINS_OFF.get(interrupt)
    was_c = lathe.is_c()
    if pin:
        lathe.set(*pin)
        lathe.wait_for(lambda _: not lathe.get("motion.motion-enabled"), timeout=60)
        lathe.set(pin[0], not pin[1])
    else:
        (lathe.estop if "estop" in interrupt else lathe.abort)()
    changed = commanded != lathe.get("motion.digital-out-02")  # since it was looked at
    becoming_c = changed or (commanded and not was_c)  # or becoming it
    check_what_is_left(lathe, was_c, interrupt in ("abort", "mdi"), becoming_c)
    lathe.errors()
    lathe.enable()
    stood = lathe.get("spindle-turns")
    time.sleep(0.2)
    assert lathe.get("spindle-turns") == pytest.approx(stood, abs=1e-3)
    lathe.mdi("M5")
    lathe.motion_of([*FIRST, "M254", "G0 C10", "M255", "M2"])


def check_what_is_left(lathe, was_c, keeps, becoming_c):
    """Assert that the spindle is at rest, in the right one of its two states, and reported.

    Nothing is reported after the program's M255, either is valid where it was just becoming C.
    """
    lathe.wait_for(lambda _: abs(lathe.get("spindle-rps")) < 0.01, timeout=60)
    stood = lathe.get("spindle-turns")
    time.sleep(0.3)
    assert lathe.get("spindle-turns") == pytest.approx(stood, abs=1e-3)
    assert lathe.is_c() == (was_c and keeps) or (becoming_c and keeps)
    assert lathe.get("spindle-c-holds") == lathe.is_c()
    lost = was_c and not keeps and bool(lathe.get("motion.digital-out-02"))
    if lost and not becoming_c:
        lathe.wait_for_error(LOST)
    elif not becoming_c:
        assert LOST not in [error.text for error in lathe.errors()]


def random_changes(seed, count):
    """Return blocks with that many changes each way, from any angle and speed."""
    chance = random.Random(seed)
    blocks = []
    for _ in range(count):
        way, speed = chance.choice(("M3", "M4")), chance.uniform(50, 900)
        blocks += [f"S{speed:.1f} {way}", f"G4 P{chance.uniform(0.1, 1):.3f}"]
        blocks += ["M254", "G4 P0.1", f"G0 C{chance.uniform(-200, 200):.3f}"]
        blocks += ["G4 P0.2", "M255", "G4 P0.1"]
    return [*blocks, "M5", "M2"]


def changes_of(samples):
    """Return the samples at which the spindle becomes C, and at which it becomes the spindle."""
    is_c = samples.axes["L"] < UNLOCKED
    steps = np.diff(is_c.astype(int))
    return np.flatnonzero(steps > 0) + 1, np.flatnonzero(steps < 0) + 1


def jumps(samples, changes, around=20):
    """Return the greatest steps of C's command, feedback (degrees a sample) and error (degrees).

    They are those within ``around`` samples of the changes.
    """
    c, feedback, error = (samples.axes[name] for name in "CFE")
    steps = np.array([np.diff(c), np.diff(feedback), error[1:]])
    near = [steps[:, max(at - around, 0) : at + around] for at in changes]
    return np.abs(np.concatenate(near, axis=1)).max(axis=1)


def motor_jumps(samples, changes, around=50):
    """Return the greatest change of the motor's speed from sample to sample, degrees/s."""
    turns = samples.axes["T"]
    return max(
        np.abs(np.diff(turns[max(at - around, 0) : at + around], 2)).max() * 360e3 for at in changes
    )


def pitch_and_start(samples, line):
    """Return the pitch of a thread, and the angle in turns at which it would be at Z0."""
    cut = samples.line == line
    turns, z = samples.axes["T"][cut], samples.axes["Z"][cut]
    inside = (z < 0) & (z > -7)
    slope, at_zero = np.polyfit(z[inside], turns[inside], 1)
    return abs(1 / slope), at_zero


def angle_of_flat(samples, line):
    """Return the direction of a line on the face, in degrees, by the spindle's own encoder."""
    cut = samples.line == line
    angle = 2 * np.pi * samples.axes["T"][cut]
    points = samples.axes["X"][cut] * np.exp(1j * angle)
    middle = np.abs(points.imag) < 15
    slope, _ = np.polyfit(points.imag[middle], points.real[middle], 1)
    return np.degrees(np.arctan(slope))
