# SPDX-License-Identifier: GPL-2.0-or-later
"""verify: CPU time and memory of the whole process for programs of many pockets."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from bench import Figure
from support.sim_machines import ROOT, SIM

INI = SIM / "mill_mm_headless.ini"
FIRST = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6", "S2000 M3", "G0 Z5"]
ROW, PITCH = 20, 45  # pockets side by side, mm from one to the next
STOCK = "1000x3000x20@-30,-30"
LEAST, MOST = 12, 20  # mm, radii of pockets


def figures():
    """Yield the rows of verify."""
    with tempfile.TemporaryDirectory() as folder:
        few, many = (used(folder, count, "--stock", STOCK) for count in (50, 200))
        yield Figure(
            "verify: CPU time of 200 pockets in a stock, against 50",
            many.seconds / few.seconds,
            6.0,
            "",
            f"{many.seconds:.2f} s against {few.seconds:.2f} s",
        )
        thousand = used(folder, 1000)
        how = "pockets of 1,000 sizes, without a stock"
        yield Figure("verify: CPU time of 1,000 pockets", thousand.seconds, 6.0, " s", how)
        yield Figure("verify: memory for 1,000 pockets", thousand.memory, 300.0, " MB", how)


class Used:
    """What a process and its children used: CPU seconds, and MB at most."""

    def __init__(self, pid):
        _, _, usage = os.wait4(pid, 0)
        self.seconds = usage.ru_utime + usage.ru_stime
        self.memory = usage.ru_maxrss / 1024


def used(folder, count, *words):
    """Return what ``verify`` uses for a program of so many pockets."""
    program = Path(folder) / f"{count}.ngc"
    program.write_text("\n".join([*FIRST, *pockets(count), "M2", ""]))
    command = [sys.executable, str(ROOT / "python" / "g12"), "verify", str(program)]
    process = subprocess.Popen(
        [*command, "--ini", str(INI), *words],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return Used(process.pid)


def pockets(count):
    """Yield the blocks of pockets, each of a size of its own."""
    for index in range(count):
        x, y = PITCH * (index % ROW), PITCH * (index // ROW)
        radius = LEAST + (MOST - LEAST) * index / count
        yield f"G0 X{x} Y{y}\nG0 Z1\nG13 I7 K{radius:.3f} Q4 Z-3 D4\nG0 Z5"
