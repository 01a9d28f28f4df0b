# SPDX-License-Identifier: GPL-2.0-or-later
"""A fault in a handler: the operator reads what it is, not "pycall(...) failed"."""

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

RAISING = """\
import sys
sys.path.insert(0, "{python}")
import remap
def broken(*_, **__):
    raise KeyError("wire")
"""
TOPLEVEL = f"""\
{RAISING}
from g12.host.handlers import cycles
from g12.polar import polar_section
cycles.haas.plan = polar_section.Polar.plan = broken
"""
BROKEN = """\
import sys
sys.path.insert(0, "{python}")
sys.modules["{module}"] = None
import remap
"""
HALVES = ["g12.cycles.plan", "g12.polar.segments"]
PROGRAMS = {  # of the half whose codes they use
    "g12.cycles.plan": ("mill_mm", ["F600", "G0 X0 Y0", "G12 I20 D1 Z-1", "M2"]),
    "g12.polar.segments": (
        "lathe_mm",
        ["G18 G8 F100", "G0 X20 Z5 C0", "G12.1", "G1 X15", "G13.1", "M2"],
    ),
}
SHORT = "from g12.host import section_run\nsection_run.MOST_SECTION_LINES = 99\n"


def tracer_of(folder, machine, toplevel, module="", **overrides):
    """Return a Tracer of a machine whose Python starts with a text of its own."""
    path = folder / "toplevel.py"
    path.write_text(toplevel.format(python=SIM.parents[1] / "python", module=module))
    overrides["PYTHON"] = {"TOPLEVEL": str(path)}
    return Tracer(SIM / f"{machine}.ini", overrides=overrides, tools={1: 6.0})


def test_an_endless_loop_ends(tmp_path):
    program = ["G18 G8 F100", "G0 X20 Z5 C0", "G12.1", "o1 while [1]", "o1 endwhile", "G13.1", "M2"]
    with tracer_of(tmp_path, "lathe_mm", TOPLEVEL + SHORT) as tracer:
        error = tracer.trace_text(program).error
    assert error.text.endswith(": 99 lines were read and G13.1 did not come: an endless loop?")
    assert error.text.startswith(f"G12.1 line {error.line}: ")


@pytest.mark.parametrize(("machine", "program"), PROGRAMS.values())
def test_a_fault_in_a_handler_is_named(tmp_path, machine, program):
    with tracer_of(tmp_path, machine, TOPLEVEL) as tracer:
        error = tracer.trace_text(program).error
    assert error.text == "g12: a fault of the package, please report it: KeyError: 'wire'"
    assert program[error.line - 1] in ("G12 I20 D1 Z-1", "G13.1")


SECTION = ["G18 G8 F100", "G0 X20 Z5 C0", "G12.1", "G1 X15", "G13.1", "M2"]
RESTORING_FAILS = """
from g12.host import borrowed, kinematics_switch, messages
from g12.host.section_output import SectionOutput
kinematics_switch.leave = lambda interp: messages.message("off the face")
SectionOutput._move_on_face = borrowed.restore = broken
"""


def test_the_face_is_left_even_if_the_modes_cannot_be_restored(tmp_path):
    with tracer_of(tmp_path, "lathe_mm_kinematics", RAISING + RESTORING_FAILS) as tracer:
        trace = tracer.trace_text(SECTION)
    assert "off the face" in [text for _, text in trace.messages]


@pytest.mark.parametrize("broken", HALVES)
@pytest.mark.parametrize("used", HALVES)
def test_a_half_that_does_not_load_leaves_the_other(tmp_path, broken, used):
    """The operator is told when LinuxCNC comes up; the broken codes refuse with the same text."""
    machine, program = PROGRAMS[used]
    with tracer_of(tmp_path, machine, BROKEN, module=broken) as tracer:
        printed, traced = tracer.printed, tracer.trace_text(program)
    fault = (
        f"g12: a fault of the package, please report it: ModuleNotFoundError: import of {broken}"
    )
    assert fault in printed
    if used == broken:
        assert traced.error.text.startswith(fault)
        assert not [move for move in traced.moves if move.kind != "rapid"]
    else:
        assert traced.error is None
        assert len(traced.moves) > 1


ACTING = """\
import sys
sys.path.insert(0, "{python}")
import remap
from interpreter import INTERP_EXECUTE_FINISH, INTERP_OK
def moves(self, **_):
    self.execute("G0 X5")
    return INTERP_OK
def waits(self, **_):
    yield INTERP_EXECUTE_FINISH
remap.moves, remap.waits = moves, waits
"""


@pytest.mark.parametrize(
    ("handler", "rule"),
    [
        ("moves", "M411 moves the machine: not inside a section"),
        ("waits", "M411 waits for the machine"),
    ],
)
def test_an_m_code_of_python_that_moves_or_waits_is_refused_in_a_section(tmp_path, handler, rule):
    program = [*SECTION[:4], "M411", "X10", *SECTION[4:]]
    remaps = (
        *read_ini(SIM / "lathe_mm.ini").all("RS274NGC", "REMAP"),
        f"M411 modalgroup=10 python={handler}",
    )
    with tracer_of(tmp_path, "lathe_mm", ACTING, RS274NGC={"REMAP": remaps}) as tracer:
        error = tracer.trace_text(program).error
    assert error.text.startswith(f"G12.1 line 5: {rule}")


def test_an_axis_that_cannot_be_leaves_the_cycles():
    machine, program = PROGRAMS["g12.cycles.plan"]
    overrides = {"AXIS_X": {"MAX_ACCELERATION": "0"}}
    with Tracer(SIM / f"{machine}.ini", overrides=overrides, tools={1: 6.0}) as tracer:
        assert "g12: [AXIS_X] MAX_ACCELERATION = 0: must be above 0" in tracer.printed
        assert tracer.trace_text(program).error is None


def test_a_wrong_setting_is_told_once_and_every_code_refuses_with_it():
    reason = "[G12] CLEARING = zigzag: must be rings or spiral"
    for machine, program in PROGRAMS.values():
        with Tracer(SIM / f"{machine}.ini", overrides={"G12": {"CLEARING": "zigzag"}}) as tracer:
            assert tracer.printed.count(reason) == 1
            assert tracer.trace_text(program).error.text == reason
