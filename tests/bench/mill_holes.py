# SPDX-License-Identifier: GPL-2.0-or-later
"""Bore, thread and frame: motion time against the same toolpath written by hand, planning time."""

import tempfile
import time
from pathlib import Path

from bench import Figure
from bench.haas import plain_block
from g12.cycles import bore, frame, thread
from g12.request import COUNTERCLOCKWISE, Words
from g12.settings import Settings
from g12.state import Tool
from g12.tools.headless.machine import run_program
from g12.tools.preview.tracer import Tracer
from support.planner_context import MM, words_of
from support.sim_machines import SIM

INI, TOOLS, PLANS = SIM / "mill_mm_headless.ini", {1: 6.0}, 200
STANDING = MM._replace(tools={1: Tool(1, 3.0)})
FIRST = ["G21 G17 G40 G49 G90 G91.1 G94 G64 P.01 F900", "T1 M6", "S3000 M3", "G0 X0 Y0 Z5"]
BLOCKS = {
    "bore": "G13.5 Z-1 R0 I8 P.3 Q2 D1",
    "thread": "G13.6 Z-8 R0 I6 P1.5 Q.3 D1",
    "frame": "G13.7 Z-1 I30 J20 R5 Q3 E.2 D1",
}
PLANNERS = {"bore": bore.plan, "thread": thread.plan, "frame": frame.plan}


def figures():
    """Yield two rows for each code."""
    for name, block in BLOCKS.items():
        by_code, by_hand = motion_time([block]), motion_time(written_out(block))
        what = f"{name}: motion time of {block}, against the same toolpath written by hand"
        yield Figure(what, by_code / by_hand, 1.01, f"{by_code:.2f} s against {by_hand:.2f} s")
        yield Figure(f"{name}: planning a block", planning(name, block), 2.0, "the mean", " ms")


def motion_time(lines):
    """Return the seconds of a real run in which the tool moves."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.ngc"
        program.write_text("\n".join([*FIRST, *lines, "M2", ""]))
        samples = run_program(program, INI, TOOLS).samples
    moving = samples.only(samples.moving()).time
    return float(moving[-1] - moving[0])


def written_out(block):
    """Return the moves of a block as plain G-code."""
    with Tracer(INI, tools=TOOLS) as tracer:
        moves = tracer.trace_text([*FIRST, block, "M2"]).moves[1:]
    return [plain_block(move) for move in moves]


def planning(name, block):
    """Return the milliseconds of planning a block."""
    code, text = block.split(maxsplit=1)
    begun = time.perf_counter()
    for _ in range(PLANS):
        PLANNERS[name](Words(code, words_of(text), STANDING), COUNTERCLOCKWISE, Settings())
    return (time.perf_counter() - begun) / PLANS * 1000
