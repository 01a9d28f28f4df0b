# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section finds where nothing forbids it to begin: tests replace what they are about."""

from g12.machine_ini import Axis
from g12.moves.setup import SectionMachine
from g12.polar.polar_section import Polar
from g12.section.effects import SectionStart
from g12.section.line import BlockLocation
from g12.settings import Settings
from g12.state import State
from support.planner_context import MM

LATHE = MM._replace(
    x=20.0,
    z=5.0,
    offsets={"X": 1.0, "Y": 0.0, "Z": 2.0, "A": 0.0, "B": 0.0, "C": 90.0},
    feed=100.0,
    motion=10,
)
AXES = {"X": Axis(-100.0, 100.0, 50.0, 1000.0), "C": Axis(-9e9, 9e9, 360.0, 3600.0)}
START = SectionStart(BlockLocation("G12.1", 7), words={}, alone=True, level=1, state=LATHE)


def with_found(start, **found):
    """Return a start with other values of its block, or of the state before it."""
    state = {name: found.pop(name) for name in State._fields if name in found}
    return start._replace(state=start.state._replace(**state), **found)


def polar(c=0.0, tolerance=0.005, least=0.001, face=None, axes=AXES, **settings):
    """Return a section on a face whose zero line is at ``c`` degrees."""
    settings = Settings(polar_kinematics=face is not None, **settings)
    machine = SectionMachine(frozenset(axes), settings, axes, face)
    made = Polar(with_found(START, c=c), machine)
    made.tolerance, made.least = tolerance, least
    return made
