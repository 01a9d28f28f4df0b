# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13, dialect haas: interpreting time."""

import os
import statistics
import tempfile
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from bench import Figure, used
from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.sim_machines import SIM

INI = SIM / "mill_inch.ini"
TOOLS = {1: 0.25}
MM_PER_INCH = 25.4
POCKETS, PAIRS = 1000, 9
FIRST = "G20 G17 G40 G54 G64 G90 G91.1 G94 F10"
TEN_RINGS = "G13 I.3 K2.1 Q.2 Z-.5 D1"


def figures():
    """Compare 1,000 pockets with the same moves as plain G-code."""
    what = "G12: interpreting 1,000 pockets of 10 rings, against the same moves as plain G-code"
    cycle, plain = [FIRST, *starts(TEN_RINGS), "M2"], [FIRST, *expanded(), "M2"]
    yield against_plain(what, 3.0, INI, "T1 P1 D0.25", cycle, plain)


def against_plain(what, limit, ini, tool, lines, plain):
    """Compare the CPU time of two programs in the stock interpreter."""
    with interpreter(read_ini(ini), tool) as seconds:
        times = [[seconds(program) for program in (lines, plain, ["M2"])] for _ in range(PAIRS)]
    start_up = statistics.median(time[2] for time in times)
    ratios = sorted((time[0] - start_up) / (time[1] - start_up) for time in times)
    spread = f"({ratios[0]:.2f} to {ratios[-1]:.2f})"
    how = f"CPU time of rs274 less its start-up, median of {PAIRS} pairs {spread}"
    return Figure(what, statistics.median(ratios), limit, how)


@contextmanager
def interpreter(ini, tool):
    """Yield a function: the CPU seconds of rs274 for a program, where a machine's paths resolve."""
    with tempfile.TemporaryDirectory() as folder:
        machine, table, program = (Path(folder) / n for n in ("m.ini", "tool.tbl", "program.ngc"))
        machine.write_text(ini.text)
        table.write_text(f"{tool}\n")
        command = ["rs274", "-g", "-i", machine, "-t", table, program]

        def seconds(lines):
            program.write_text("\n".join([*lines, ""]))
            return used(*command, cwd=SIM, env={**os.environ, "HOME": folder}).seconds

        yield seconds


def starts(block):
    """Yield a block at each of the pocket positions, with the rapids there."""
    for index in range(POCKETS):
        yield f"G0 Z.1\nG0 X{index % 40} Y{index // 40}\n{block}"


def expanded():
    """Yield the moves of `starts` as plain G-code, taken from a trace of one pocket."""
    with Tracer(INI, tools=TOOLS) as tracer:
        moves = cut_geometry.cutting(tracer.trace_text([FIRST, "G0 Z.1", TEN_RINGS]).moves)
    for index in range(POCKETS):
        x, y = index % 40, index // 40
        yield f"G0 Z.1\nG0 X{x} Y{y}"
        yield from map(partial(plain_block, unit=MM_PER_INCH, shift=(x, y)), moves)


def plain_block(move, axes="XYZ", unit=1.0, shift=(0.0, 0.0)):
    """Return a move as a block of plain G-code, lengths in a unit of mm, shifted in X and Y."""
    places = {"X": shift[0], "Y": shift[1]}
    ends = zip("XYZABC", (*(value / unit for value in move.end[:3]), *move.end[3:6]))
    end = " ".join(f"{axis}{at + places.get(axis, 0):.6f}" for axis, at in ends if axis in axes)
    if move.kind != "arc":
        return f"{'G0' if move.kind == 'rapid' else 'G1'} {end}"
    i, j = ((move.centre[axis] - move.start[axis]) / unit for axis in (0, 1))
    return f"{'G3' if move.turns > 0 else 'G2'} {end} I{i:.6f} J{j:.6f} P{abs(move.turns)}"
