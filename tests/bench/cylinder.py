# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1: real deviation on the unrolled surface, section times."""

from collections.abc import Iterator

from bench import Figure
from support.operated_machine import Machine
from support.sim_machines import PROGRAMS, SIM

TOLERANCE = 0.005  # POLAR_TOLERANCE, mm


def figures() -> Iterator[Figure]:
    """Yield the rows of the samples on the cylinder, each run once at its own feed of F250."""
    with Machine(SIM / "lathe_mm.ini") as lathe:
        for program in sorted((PROGRAMS / "cylinder").glob("*.ngc")):
            lathe.reset()
            (section,) = lathe.proof_of_run(program.read_text()).sections
            yield Figure(
                f"cylinder: real motion against the programmed contour, {program.stem}",
                section.deviation,
                TOLERANCE + 0.001,
                " mm",
                "of the tool's centre, sampled at 1 kHz",
            )
            seconds, ideal = (section.values[name] for name in ("seconds", "seconds_programmed"))
            yield Figure(
                f"cylinder: section time against the ideal at F250, {program.stem}",
                seconds / ideal,
                1.05,
                "",
                f"{seconds:.2f} s",
            )
