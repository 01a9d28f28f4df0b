# SPDX-License-Identifier: GPL-2.0-or-later
"""Interruptions of real runs: what the machine's modes and its next motion have to be afterwards.

Each interruption begins with modes that MDI commands, and with a program that commands none. It has
no M2, with which LinuxCNC would reset them as soon as it reads it.
"""

import time
from typing import NamedTuple

import numpy as np

from support.sim_machines import SIM

MM_PER_INCH = 25.4
SPINDLE = "M3 S1000"
LATHE_HOME = ["G21 G90 G94 G8 G18 G91.1 G64 P0.01 Q0", "G0 Z20", "G0 X35 C0 Z2"]
MILL_HOME = ["G21 G90 G94 G8 G17 G91.1 G64 P0.01 Q0", "G0 Z20", "G0 X0 Y0 Z2"]
ROTARY_HOME = [*MILL_HOME[:2], "G0 X2 Y0 Z2 A0"]
PATHS = ["G61", "G61.1", "G64 P0.05 Q0.03", "G64 P0.4"]
POLYGON = [(30, 20), (0, 30), (-25, 10), (-15, -25), (20, -20), (30, 0)]
SLOT_AROUND = [(-5, 0), (-5, 30), (-15, 30), (-15, 0), (2, 0)]
MOVING = {"G0", "G1", "G2", "G3", "G4", "G80", "G38.2"}
FAILING = "M66 P77 L0"  # an input that LinuxCNC does not have: refused between the moves
STARTING = {"M3", "M4", "M5", "M6", "M2"}  # an abort stops the spindle
LONGEST = 1.2  # s until an interruption
HOWS = ["abort", "estop", "off", "refusal", "run_from", "mdi_after"]


class Modes(NamedTuple):
    """Modes that an operator commands."""

    path: str
    incremental: bool
    per_revolution: bool
    inches: bool
    centres: str

    @property
    def unit(self):
        return MM_PER_INCH if self.inches else 1.0

    @property
    def blocks(self):
        path = self.path
        if self.inches and "P" in path:  # of the same length
            words = path.split()
            path = " ".join([words[0], *(f"{w[0]}{float(w[1:]) / 25.4:.5f}" for w in words[1:])])
        return [
            f"G{21 - self.inches} G{90 + self.incremental} G{94 + self.per_revolution} "
            f"{self.centres}",
            path,
            f"F{self.feed}",
        ]

    @property
    def feed(self):
        """Some 1500 mm/min; LinuxCNC rounds F to one decimal where it restores modes itself."""
        if self.per_revolution:
            return 0.1 if self.inches else 1.5
        return 59.1 if self.inches else 1500.0

    def moves(self, letters, points, start):
        """Return lines through points in mm and degrees, from ``start`` on."""
        lines = []
        for point in points:
            offsets = start if self.incremental else (0, 0)
            values = [there - off for there, off in zip(point, offsets)]
            lines.append("".join(f"{a}{self.word(a, v):.5f}" for a, v in zip(letters, values)))
            start = point
        return lines

    def word(self, letter, value):
        return value / self.unit if letter not in "ac" else value


def any_modes(chance, name):
    """Return modes, few enough that most interruptions find their reference made."""
    path, incremental = chance.choice(PATHS), chance.random() < 0.5
    inches = incremental == (path in ("G61", "G64 P0.4"))
    centres = "G90.1" if name.startswith("mill") and incremental else "G91.1"
    return Modes(path, incremental, path != "G61.1", inches, centres)


def machine_of(name):
    """Return the INI of a machine and its overrides: its rotary axis is wrapped."""
    turn = rotary_axis(name)
    return SIM / f"{name}.ini", {f"AXIS_{turn}": {"WRAPPED_ROTARY": "1"}} if turn else {}


def rotary_axis(name):
    """Return the letter of a machine's rotary axis, "" without one."""
    return "C" if name.startswith("lathe") else "A" if name.startswith("mill_a") else ""


def programs(name, modes, fails):
    """Return the programs of a machine; ``fails``: a line of the section fails between moves."""
    size = 1 / modes.unit
    failing = [FAILING] * fails
    if name.startswith("mill_a"):
        around = modes.moves("Xa", SLOT_AROUND, (2, 0))
        return {"round": [f"G7.1 A{20 * size:.5f}", *(f"G1{line.upper()}" for line in around),
                          *failing, "G7.1 A0"]}  # fmt: skip
    if name.startswith("mill"):
        depth = f"Z{(-5 if modes.incremental else -3) * size:.5f}"
        deep = f"Z-{3 * size:.5f}" if not modes.incremental else f"Z-{5 * size:.5f}"
        q = f"{2 * size:.5f}"
        place = "X0 Y0"
        return {
            "pocket": [f"G13 I{5 * size:.5f} K{40 * size:.5f} Q{q} {deep} D3", *failing],
            "event": [f"G13.2 {place} {depth} I{2 * size:.5f} E{9 * size:.5f} R{20 * size:.5f} "
                      f"D3 H1 J{4 * size:.5f} F{modes.feed}", *failing],
            "bore": [f"G13.5 I{20 * size:.5f} P{0.3 * size:.5f} Q{q} {deep} D3", *failing],
            "thread": [f"G12.6 I{20 * size:.5f} P{0.5 * size:.5f} Q{0.1 * size:.5f} L2 {deep} D3",
                       *failing],
            "frame": [f"G13.7 I{60 * size:.5f} J{40 * size:.5f} R{5 * size:.5f} K{size:.5f} "
                      f"{deep} D3", *failing],
        }  # fmt: skip
    contour = modes.moves("XC", POLYGON, (30, 0))
    around = modes.moves("Zc", SLOT_AROUND, (2, 0))
    feed = modes.feed
    slot = f"[{8 * size}] [{30 * size}] [{size}] [-9999] [-9999] [{feed}] [-9999] [0]"
    holes = f"[3] [{30 * size}] [20] [-9999] [{4 * size}] [{2 * size}] [{feed}] [0] [0.1] [0]"
    return {
        "section": ["G12.1", *(f"G1{line}" for line in contour), *failing, contour[0], "G13.1"],
        "cylinder": [f"G7.1 C{20 * size:.5f}", *(f"G1{line.upper()}" for line in around),
                     *failing, "G7.1 C0"],
        "shape": [f"o<polar_slot> call {slot}"],
        "holes": [f"o<face_holes> call {holes}"],
    }  # fmt: skip


class Interrupted:
    """A machine whose programs are interrupted, and what it does after that."""

    def __init__(self, machine, name):
        self.machine, self.name = machine, name
        self.home = MILL_HOME if name.startswith("mill") else LATHE_HOME
        if name.startswith("mill_a"):
            self.home = ROTARY_HOME
        self.references = {}
        for block in ("T3 M6", SPINDLE):
            machine.mdi(block)

    def once(self, chance, how, number):
        """Interrupt one program, of a kind by its ``number``.

        Raise AssertionError where the machine is not as before.
        """
        machine, modes = self.machine, any_modes(chance, self.name)
        every = [*programs(self.name, modes, how == "refusal").items()]
        kind, program = every[number % len(every)]
        self.stand(modes)
        before = self.state()
        said = self.run(chance, how, kind, program, modes)
        what = (how, kind, modes, said)
        machine.mdi("G4 P0")  # after an emergency stop LinuxCNC shows M52 until the next block
        if how == "mdi_after":
            modes = any_modes(chance, self.name)
            self.type(modes.blocks)
            before = None
        if before:
            assert self.state() == before, (what, self.state(), before)
        found = self.probe(modes)
        assert np.allclose(found, self.reference(modes), rtol=0.05, atol=(0.004, 0.04)), (
            what, found, self.reference(modes),
        )  # fmt: skip
        return what

    def stand(self, modes):
        self.type([*self.home, SPINDLE, *modes.blocks])

    def type(self, blocks):
        for block in blocks:
            self.machine.mdi(block)
        said = [error.text for error in self.machine.errors()]
        assert not said, (said, blocks)

    def state(self):
        """Return the modes of the machine, without those that a move or a stop changes.

        P and Q count under G64 only: LinuxCNC itself sets them to 0 under G61.
        """
        now = self.machine.stat().modes
        mcodes = {code for code in now.mcodes if code not in STARTING}
        blending = tuple(round(value, 6) for value in now.blending if "G64" in now.gcodes)
        return set(now.gcodes) - MOVING, mcodes, round(now.feed, 6), blending

    def run(self, chance, how, kind, program, modes):
        machine = self.machine
        axis, away = ("X", 30) if self.name.startswith("lathe") else ("Z", 2)
        step = modes.moves(axis, [(away,)], (35 if axis == "X" else 2,))[0]
        lines = ["%", f"G0 {step}", *program, f"G0 {modes.moves('Z', [(2,)], (2,))[0]}", "%"]
        machine.open_text(lines)
        machine.start(3 if how == "run_from" and kind != "section" else 0)
        if how == "refusal":
            machine.wait_for(lambda now: now.interp == "idle" and now.idle, timeout=60)
        else:
            time.sleep(chance.uniform(0, LONGEST))
            self.interrupt(how)
        machine.wait_idle()
        machine.settle()
        if "kinematics" in self.name:
            machine.wait_for(lambda _: not machine.get("polar-xzc.face"))
        said = [error.text for error in machine.errors()]
        if how == "refusal":
            assert all("Traceback" not in text and "pycall" not in text for text in said), said
        else:
            assert not said, (how, kind, modes, said)
        return said

    def interrupt(self, how):
        if how in ("estop", "off"):
            getattr(self.machine, how)()
            self.machine.enable()
        else:
            self.machine.abort()

    def reference(self, modes):
        """Return the next program's motion of a machine that was given the modes by MDI."""
        if modes not in self.references:
            self.stand(modes)
            self.references[modes] = self.probe(modes)
        return self.references[modes]

    def probe(self, modes):
        """Return how far the next program misses its corner in mm, and how long it takes."""
        machine = self.machine
        second = "Y" if self.name.startswith("mill") else "Z"
        self.type([SPINDLE, *self.away(modes)])
        start = dict(zip("XYZ", machine.stat().position))
        lines = [
            f"G1 {modes.moves('X', [(start['X'] + 6,)], (start['X'],))[0]}",
            f"{modes.moves(second, [(start[second] - 6,)], (start[second],))[0]}",
        ]
        run = machine.run_text(["%", *lines, "%"])
        assert run.error is None, run.error
        axes, moving = run.samples.axes, run.samples.moving()
        corner = np.hypot(axes["X"] - start["X"] - 6, axes[second] - start[second])
        if rotary_axis(self.name) and not modes.incremental:
            self.is_wrapped()
        return corner.min(), moving.sum() / 1000

    def away(self, modes):
        """Return the blocks that go to the place where the next program begins."""
        here = dict(zip("XYZ", self.machine.stat().position))
        return [
            f"G0 {modes.moves(letter, [(there,)], (here[letter],))[0]}"
            for letter, there in (("Z", 20), ("X", 60))
        ]

    def is_wrapped(self):
        """Check that C or A is wrapped, as in the INI: only then this block is refused."""
        self.machine.mdi(f"G0 {rotary_axis(self.name)}400")
        said = [error.text for error in self.machine.errors()]
        assert any("wrapped rotary" in text for text in said), said
