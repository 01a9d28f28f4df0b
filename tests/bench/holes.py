# SPDX-License-Identifier: GPL-2.0-or-later
"""Holes with C: interpreting time against the same moves as plain G-code, and verify."""

import statistics
import tempfile
from pathlib import Path

from bench import Figure
from bench.haas import cpu_seconds
from bench.verify import LATHE, used
from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

INI = SIM / "lathe_mm.ini"
CALLS, HOLES, PAIRS = 20, 360, 5
FIRST = ["G21 G18 G8 G40 G90 G94 G61", "T1 M6", "S2000 M3", "G0 X40 Z10 C0", "F120"]
CALL = f"o<face_holes> call [{HOLES}] [30] [0] [-9999] [8] [2] [120] [3] [0] [0]"
X, Z, C = 0, 2, 5


def figures():
    """Yield the rows of holes."""
    with tempfile.TemporaryDirectory() as folder:
        yield interpreting(Path(folder))
        proof = used(folder, LATHE, [*FIRST, *[CALL] * CALLS])
        what = f"verify: CPU time of {CALLS * HOLES:,} holes in three pecks"
        yield Figure(what, proof.seconds, 10.0, " s", f"{proof.memory:.0f} MB")


def interpreting(scratch):
    """Compare calls with the same moves as plain G-code, in the stock interpreter."""
    calls, plain, empty = (scratch / f"{name}.ngc" for name in ("calls", "plain", "empty"))
    calls.write_text("\n".join([*FIRST, *[CALL] * CALLS, "M2\n"]))
    plain.write_text("\n".join([*FIRST, *list(moves_of_a_call()) * CALLS, "M2\n"]))
    empty.write_text("M2\n")
    (scratch / "machine.ini").write_text(read_ini(INI).text)
    (scratch / "tool.tbl").write_text("T1 P1 D6\n")
    programs = (calls, plain, empty)
    times = [[cpu_seconds(scratch, program) for program in programs] for _ in range(PAIRS)]
    start_up = statistics.median(time[2] for time in times)
    ratios = sorted((time[0] - start_up) / (time[1] - start_up) for time in times)
    return Figure(
        f"holes: interpreting {CALLS * HOLES:,} holes in three pecks, against the same moves",
        statistics.median(ratios),
        3.0,
        "",
        f"CPU time of rs274 less its start-up, median of {PAIRS} pairs"
        f" ({ratios[0]:.2f} to {ratios[-1]:.2f})",
    )


def moves_of_a_call():
    """Yield the moves of a call as plain G-code."""
    with Tracer(INI, tools={1: 6.0}) as tracer:
        moves = tracer.trace_text([*FIRST, CALL, "M2"]).moves
    for move in moves[1:]:
        code = "G0" if move.kind == "rapid" else "G1"
        yield f"{code} X{move.end[X]:.6f} Z{move.end[Z]:.6f} C{move.end[C]:.6f}"
