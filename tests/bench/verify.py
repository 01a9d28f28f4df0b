# SPDX-License-Identifier: GPL-2.0-or-later
"""verify: CPU time and memory of the whole process for programs of many pockets."""

import math
import random
import sys
import tempfile
from pathlib import Path

from bench import Figure, used
from support.sim_machines import ROOT, SIM
from support.valid_programs import valid_program

MILL, LATHE = SIM / "mill_mm_headless.ini", SIM / "lathe_mm_headless.ini"
FIRST = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6", "S2000 M3", "G0 Z5"]
ROW, PITCH = 20, 45  # pockets side by side, mm from one to the next
STOCK = "1000x3000x20@-30,-30"
LEAST, MOST = 12, 20  # mm, radii of pockets
FACE = ["G21 G18 G8 G40 G90 G94", "T1 M6", "S2000 M3", "G0 X40 Z2 C0", "G12.1", "G1 Z-1 F1000"]
LAP = 1000  # lines of a lap of a contour


def figures():
    """Yield the rows of verify."""
    with tempfile.TemporaryDirectory() as folder:
        few, many = (verified(folder, MILL, milled(n), "--stock", STOCK) for n in (50, 200))
        yield against("verify: CPU time of 200 pockets in a stock, against 50", many, few, 6.0)
        thousand = verified(folder, MILL, milled(1000))
        how = "pockets of 1,000 sizes, without a stock"
        yield Figure("verify: CPU time of 1,000 pockets", thousand.seconds, 6.0, how, " s")
        few, many = (verified(folder, MILL, valid(n)) for n in (100, 1000))
        yield against("verify: CPU time of 1,000 random pockets, against 100", many, few, 12.0)
        most = max(thousand.memory, many.memory)
        for name, contour in CONTOURS.items():
            few, many = (verified(folder, LATHE, contour(n)) for n in (1000, 10_000))
            what = f"verify: CPU time of 10,000 polar lines, {name}, against 1,000"
            yield against(what, many, few, 12.0)
            most = max(most, many.memory)
        yield Figure("verify: memory at the most", most, 300.0, "of the largest of these", " MB")


def against(what, many, few, limit):
    """Return the ratio of what two programs take."""
    how = f"{many.seconds:.2f} s against {few.seconds:.2f} s"
    return Figure(what, many.seconds / few.seconds, limit, how)


def verified(folder, ini, lines, *words):
    """Return what ``verify`` uses for a program."""
    program = Path(folder) / "program.ngc"
    program.write_text("\n".join([*lines, "M2", ""]))
    command = [sys.executable, ROOT / "python" / "g12", "verify", program, "--ini", ini, *words]
    return used(*command, codes=(0, 1))


def milled(count):
    """Return a program of so many pockets, each of a size of its own."""
    lines = [*FIRST]
    for index in range(count):
        x, y = PITCH * (index % ROW), PITCH * (index // ROW)
        radius = LEAST + (MOST - LEAST) * index / count
        lines += [f"G0 X{x} Y{y}", "G0 Z1", f"G13 I7 K{radius:.3f} Q4 Z-3 D4", "G0 Z5"]
    return lines


def valid(count):
    """Return a program of so many random pockets."""
    return valid_program("haas", random.Random(1), count).splitlines()


def plain(count):
    """Return a section round a wavy contour of so many lines."""
    return [*FACE, *wave(count, 20.0), "Z2", "G13.1"]


def compensated(count):
    """Return the same with the tool outside of it."""
    lead = ["G1 X40 C20", "G42 G1 X20 C0"]
    return [*FACE, *lead, *wave(count, 20.0), "G40 G1 X40 C20", "Z2", "G13.1"]


def in_laps(count):
    """Return laps round the contour, each a thousandth inside the one before."""
    laps = (wave(LAP, 20.0 - lap / 1000) for lap in range(count // LAP))
    return [*FACE, *(line for lap in laps for line in lap), "Z2", "G13.1"]


CONTOURS = {"plain": plain, "compensated": compensated, "in laps": in_laps}


def wave(count, radius):
    """Yield the lines of a closed contour about the spindle."""
    for index in range(count + 1):
        angle = 2 * math.pi * index / count
        reach = radius + 2 * math.sin(5 * angle)
        yield f"X{reach * math.cos(angle):.4f} C{reach * math.sin(angle):.4f}"
