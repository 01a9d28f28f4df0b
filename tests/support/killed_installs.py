# SPDX-License-Identifier: GPL-2.0-or-later
"""install, an update and uninstall of real configs, killed at a system call that strace counts."""

import os
import re
import shutil
import subprocess
from collections import Counter
from itertools import product
from typing import NamedTuple

from g12.tools.install import package_copy
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import load_config
from g12.tools.install.rules import findings_of
from g12.tools.system import PYTHON
from support.sim_machines import ROOT
from support.small_configs import MILL, TURNING, TURNING_HAL, content_of, write_config

G12 = [PYTHON, ROOT / "python" / "g12"]
PINS = 'velocity = "drive.velocity"\nposition = "drive.position"\nholds = "drive.mode"\n'
HAL = {"motion_hal": TURNING_HAL, "later_hal": ""}
MACHINES = {  # a feature: all that are installed, the INI, other files
    "haas": (["haas"], MILL, {}),
    "polar-kinematics": (["polar", "polar-kinematics"], TURNING, HAL),
    "spindle-c": (["spindle-c", "--pins", "pins.toml"], TURNING, {**HAL, "pins_toml": PINS}),
}
CASES = list(product(MACHINES, ("install", "update", "uninstall")))
CALL = re.compile(r"^(\w+)\(", re.MULTILINE)
OLDER = {".ngc": b"(older)\n", ".py": b"# older\n"}  # a line at the end of each file


class Point(NamedTuple):
    """A system call: ``number`` of its name, and whether files are being put in place by then."""

    call: str
    number: int
    puts: bool


class KilledInstalls:
    """A config before a command, for any number of kills."""

    def __init__(self, folder, feature, command):
        words, text, files = MACHINES[feature]
        self.folder, self.kept = folder / "machine", folder / "kept"
        self.folder.mkdir()
        self.ini = write_config(self.folder, text, **files)
        install = ["install", "mill.ini", "--with", *words]
        self.words = [*G12, *(["uninstall", "mill.ini"] if command == "uninstall" else install)]
        if command != "install":
            self.run(*G12, *install)
            make_older(self.folder / "g12", edited="ngc/circle_mill.ngc")
        shutil.copytree(self.folder, self.kept, symlinks=True)
        self.states = [self.state()]
        self.points = points_of(self.run("strace", "-o", "/dev/stderr", *self.words).stderr)
        self.states.append(self.state())

    def run(self, *words):
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done

    def state(self):
        """Return the files, and what `check` says of them."""
        return content_of(self.folder), findings_of(load_config(IniText(self.ini)))

    def sample(self, chance, number):
        """Yield calls at random, every other one of those that put files in place."""
        placing_now = [point for point in self.points if point.puts][:20]
        for index in range(number):
            yield chance.choice(placing_now if index % 2 else self.points)

    def kill(self, point):
        """Kill the command at a call; judge what is there, then what a second run makes of it."""
        shutil.rmtree(self.folder)
        shutil.copytree(self.kept, self.folder, symlinks=True)
        inject = f"inject={point.call}:signal=KILL:when={point.number}"
        strace = ["strace", "-o", "/dev/null", "-e", f"trace={point.call}", "-e", inject]
        subprocess.run([*strace, *self.words], cwd=self.folder, capture_output=True, check=False)
        config = load_config(IniText(self.ini))
        findings = findings_of(config)
        assert config.failure is None and not config.python.error
        assert findings in [said for _, said in self.states]
        self.run(*self.words)
        after, _ = self.states[1]
        assert content_of(self.folder) == after
        assert set(os.listdir(self.folder)) == {name.partition("/")[0] for name in after}


def make_older(copy, edited):
    """Make a copy one of an older package, with a file that the user has edited."""
    names = {name: OLDER.get(name[name.rfind(".") :], b"") for name in package_copy.listed(copy)}
    for name, line in names.items():
        (copy / name).write_bytes((copy / name).read_bytes() + line)
    digests = {name: package_copy.digest_of(copy / name) for name in names}
    lines = [f"{value}  {name}\n" for name, value in digests.items()]
    (copy / package_copy.MANIFEST).write_text("".join(lines))
    (copy / edited).write_text("(mine)\n")


def points_of(trace):
    """Return the calls that strace printed."""
    counted, puts, points = Counter(), False, []
    for call in CALL.findall(trace):
        counted[call] += 1
        puts |= call == "syncfs"
        points.append(Point(call, counted[call], puts))
    return points
