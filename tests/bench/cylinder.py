# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1: real deviation on the unrolled surface, section times."""

from bench import Figure
from bench.polar import real_deviation
from support.operated_machine import Machine
from support.sim_machines import PROGRAMS, SIM

TOLERANCE = 0.005  # POLAR_TOLERANCE, mm


def figures():
    """Yield the rows of the samples on the cylinder, each run once at its own feed of F250."""
    with Machine(SIM / "lathe_mm.ini") as lathe:
        for program in sorted((PROGRAMS / "cylinder").glob("*.ngc")):
            lathe.reset()
            proof = lathe.proof_of_run(program.read_text())
            yield real_deviation("cylinder", program.stem, proof, TOLERANCE)
            (section,) = proof.sections
            seconds, ideal = (section.values[name] for name in ("seconds", "seconds_programmed"))
            what = f"cylinder: section time against the ideal at F250, {program.stem}"
            yield Figure(what, seconds / ideal, 1.05, f"{seconds:.2f} s")
