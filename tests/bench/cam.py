# SPDX-License-Identifier: GPL-2.0-or-later
"""10,000 lines of CAM output: translated, read as a section before it moves, verified."""

import math
import statistics
import tempfile
import time
from pathlib import Path

from bench import Figure
from bench.haas import interpreter
from bench.verify import against, verified
from g12.tools.machine.ini import read_ini
from g12.tools.translate.blocks.control import read_control
from g12.tools.translate.program import translate_program
from support.sim_machines import SIM, copy_of_machines

LINES, RUNS = 10000, 3
LONGEST_TRANSLATION, LONGEST_READING = 5.0, 2.0  # s of CPU time
CONTROL = read_control("mill-on-face")
SLOPES = {"G12": {"POLAR_Z": "allow"}}
MOST_OF_A_TENTH = 12.0  # times the CPU time of a tenth of the lines


def figures():
    """Yield the rows of CAM output."""
    before = time.process_time()
    program = on_face(LINES)
    what = "translate: 10,000 lines of a mill's program onto the face, CPU time"
    seconds = time.process_time() - before
    yield Figure(
        what, seconds, LONGEST_TRANSLATION, f"lines of {mean_length():.2f} mm with Z", " s"
    )
    yield reading(program)
    yield verifying(program, on_face(LINES // 10))


def on_face(count):
    """Return the first lines of the path, translated."""
    return translate_program(spiral(count), CONTROL).text.replace(" $1", "").splitlines()


def spiral(count):
    """Return the first lines of a surface's path, as a post for mills writes it."""
    rows = ["G21 G90 G17", "T1 M6", "G43 H1", "G0 X15 Y0", "G0 Z3", "G1 Z-1 F500"]
    rows += [f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f}" for x, y, z in map(point, range(1, count + 1))]
    return "\n".join([*rows, "G0 Z5", "M2", ""])


def point(number):
    """Return one point of the path."""
    angle = 0.02 * number
    radius = 15 - 10 * number / LINES + 0.3 * math.sin(7 * angle)
    return radius * math.cos(angle), radius * math.sin(angle), -1 - 0.2 * math.sin(3 * angle)


def mean_length():
    """Return the mean length of a line, mm."""
    points = [point(number) for number in range(LINES)]
    return statistics.mean(map(math.dist, points, points[1:]))


def reading(program):
    """Measure how long the stock interpreter reads and plans the section."""
    with interpreter(read_ini(SIM / "lathe_mm.ini").replaced(SLOPES), "T1 P1 D12") as seconds:
        times = [seconds(program) - seconds(["M2"]) for _ in range(RUNS)]
    what = "polar: reading a section of 10,000 lines of CAM output, CPU time"
    how = f"the least of {RUNS} runs, without start-up"
    return Figure(what, min(times), LONGEST_READING, how, " s")


def verifying(program, tenth):
    """Compare the time that ``verify`` takes for a section with that for a tenth of it."""
    with tempfile.TemporaryDirectory() as folder:
        ini = copy_of_machines(Path(folder)) / "lathe_mm_headless.ini"
        ini.write_text(f"{ini.read_text()}\n[G12]\nPOLAR_Z = allow\n")
        many, few = (verified(folder, ini, lines[:-1]) for lines in (program, tenth))
    what = "verify: CPU time of 10,000 lines of CAM output, against 1,000"
    return against(what, many, few, MOST_OF_A_TENTH)
