# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the kinematics of configs/kinematics are installed, and what needs them."""

import time

import numpy as np
import pytest

from g12.tools.install.lathe.kinematics_rules import is_outdated, module_file

MODULE = module_file()
needs_kinematics = pytest.mark.skipif(
    not MODULE or is_outdated(MODULE), reason="first: make kinematics"
)


def on_the_face(machine):
    """Tell whether X and Y are those of the face."""
    return machine.get("polar-xzc.face")


def place(machine):
    """Return X, Y and C of the world in force, as a screen shows them."""
    x, y, _, _, _, c, *_ = machine.stat().position
    return pytest.approx((x, y, c), abs=1e-6)


def keeps_its_limits(samples, seed=None):
    """Check that no joint ever went faster than it can: no jump between the worlds."""
    for axis, most in (("X", 150), ("C", 360)):
        assert np.abs(np.diff(samples.axes[axis])).max() * 1e3 <= most * 1.001, seed


ENDED = "polar mode: an abort or an error ended it, nothing moves until G13.1 or G12.1"
BEFORE = ["G13.1", "G40", "G21 G18 G8 G90 G94 G64 P0.01", "G0 Z5", "G0 X40 C30", "G12.1"]
COMPENSATED = ["G40", "G41.1 D4", "G1 X38 Y10 F3000", "G1 X30 Y20"]
LONG = ["G1 X20 Y20 F800", "G3 X-40 I-40 F2000", "G1 X-40 Y20 F3000", "G0 X-30 Y-30"]
WRONG = ["G4 P-1", "G1 X20 F0", "G3 X3 Y3 R1"]
WRONG_THERE = [*WRONG, "G1 X20 C10", "C5", "G42.1 D3", "G41 D1", "M52 P0"]
MEANT_FOR_THE_FACE = ["G0 X30 Y0", "G1 X10 F500", "G0 Z4", "G1 X5 Y5 F900", "G2 X38 I-1 F200"]
ADDED = "fails kinematicsInverse"
REFUSED_MOVE = (ENDED, "polar mode: Y moves only on the face", "Radius to end of arc differs")


def type_each(machine, *blocks):
    """Type blocks that move and are no errors."""
    for block in blocks:
        machine.mdi(block)
        said = machine.errors()
        assert not said, (block, said)


def refused_for(machine, reasons, timeout=5):
    """Wait until the operator was given one of the reasons; LinuxCNC adds more to a motion's."""
    said, end = "", time.monotonic() + timeout
    while not any(reason in said for reason in reasons) or ("polar mode" in said) > (ADDED in said):
        assert time.monotonic() < end, said
        said += "".join(error.text for error in machine.errors())
    time.sleep(0.2)  # LinuxCNC aborts by itself after it, and nothing shows when
    machine.wait_idle()
    machine.errors()


def joints_of(machine):
    """Return where the slides and C are commanded to be."""
    return [round(machine.get(f"joint.{number}.pos-cmd"), 6) for number in range(3)]


def interrupted_by_hand(machine, chance):
    """End G12.1 in MDI by an abort or an error: a line typed then does not move the lathe."""
    compensated = chance.random() < 0.5
    type_each(machine, *BEFORE, *COMPENSATED * compensated)
    if chance.random() < 0.5:
        machine.mdi(chance.choice(LONG), wait=False)
        time.sleep(chance.uniform(0, 0.6))
    how = chance.choice(["abort", "estop", "error"])
    if how == "error":
        machine.wait_idle()
        machine.mdi(chance.choice(WRONG if compensated else WRONG_THERE))
    else:
        getattr(machine, how)()
    if how == "estop":
        machine.enable()
    machine.wait_for(lambda now: not on_the_face(machine) and "G18" in now.modes.gcodes)
    machine.wait_for(lambda _: machine.get("motion.in-position"))
    machine.errors(), machine.messages()
    stood = joints_of(machine)
    for _ in range(chance.randint(1, 3)):
        machine.mdi(chance.choice(MEANT_FOR_THE_FACE))
        refused_for(machine, REFUSED_MOVE)
        assert joints_of(machine) == stood
    goes_on(machine, stood, chance.random() < 0.5)


def goes_on(machine, stood, face):
    """Go back to the face, or off it, and move there."""
    machine.errors()
    if face:
        type_each(machine, "G12.1", "G0 Z3", "G13.1")
    type_each(machine, "G13.1", "G0 Z4")
    machine.wait_for(lambda _: joints_of(machine) == [stood[0], 4, stood[2]], timeout=2)


def marked(inis):
    """Return INI files as parameters of a test, those with the kinematics marked."""
    marks = {True: needs_kinematics, False: ()}
    return [pytest.param(ini, marks=marks["kinematics" in ini.stem]) for ini in inis]
