# SPDX-License-Identifier: GPL-2.0-or-later
"""Holes with C: interpreting time against the same moves as plain G-code, and verify."""

import tempfile

from bench import Figure
from bench.haas import against_plain, plain_block
from bench.verify import LATHE, verified
from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

INI = SIM / "lathe_mm.ini"
CALLS, HOLES = 20, 360
FIRST = ["G21 G18 G8 G40 G90 G94 G61", "T1 M6", "S2000 M3", "G0 X40 Z10 C0", "F120"]
CALL = f"o<face_holes> call [{HOLES}] [30] [0] [-9999] [8] [2] [120] [3] [0] [0]"


def figures():
    """Yield the rows of holes."""
    yield interpreting()
    with tempfile.TemporaryDirectory() as folder:
        proof = verified(folder, LATHE, [*FIRST, *[CALL] * CALLS])
        what = f"verify: CPU time of {CALLS * HOLES:,} holes in three pecks"
        yield Figure(what, proof.seconds, 10.0, f"{proof.memory:.0f} MB", " s")


def interpreting():
    """Compare calls with the same moves as plain G-code."""
    what = f"holes: interpreting {CALLS * HOLES:,} holes in three pecks, against the same moves"
    calls, plain = ([*FIRST, *lines * CALLS, "M2"] for lines in ([CALL], moves_of_a_call()))
    return against_plain(what, 3.0, INI, "T1 P1 D6", calls, plain)


def moves_of_a_call():
    """Return the moves of a call as plain G-code."""
    with Tracer(INI, tools={1: 6.0}) as tracer:
        moves = tracer.trace_text([*FIRST, CALL, "M2"]).moves
    return [plain_block(move, axes="XZC") for move in moves[1:]]
