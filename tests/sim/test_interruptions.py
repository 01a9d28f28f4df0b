# SPDX-License-Identifier: GPL-2.0-or-later
"""After an interruption nothing that a cycle, a section or a shape has changed remains."""

import random
import time

import numpy as np
import pytest

from g12.tools.machine.ini import read_ini
from support.interruptions import HOWS, Interrupted, machine_of
from support.kinematics import needs_kinematics, on_the_face
from support.operated_machine import Machine
from support.sim_machines import SIM

MACHINES = [
    pytest.param(name, marks=[pytest.mark.xdist_group(f"interruptions {name}"), *marks])
    for name, marks in (
        ("mill_mm", []),
        ("mill_a_mm", []),
        ("lathe_mm", []),
        ("lathe_mm_kinematics", [needs_kinematics]),
    )
]


@pytest.mark.parametrize("name", MACHINES)
def test_modes_and_next_motion_after_each_interruption(name):
    ini, overrides = machine_of(name)
    with Machine(ini, overrides=overrides) as machine:
        interrupted = Interrupted(machine, name)
        for number, how in enumerate(HOWS):
            interrupted.once(random.Random(f"{name} {number}"), how, number)


SECTION = ["G12.1", "G1 C20", "X-30", "C-20", "X30", "C0", "G13.1"]
INCREMENTAL = ["G12.1", "G1 C20", "X-60", "C-40", "X60", "C20", "G13.1"]
ENDLESS = ["G12.1", "G1 C1 F3000", "o1 while [1]", "G91 G1 X0.1", "X-0.1", "o1 endwhile", "G13.1"]


@pytest.fixture(scope="module")
def lathe():
    """Run a lathe with the face's kinematics, the codes G12.3 and G13.3, and no abort handler."""
    ini = read_ini(SIM / "lathe_mm_kinematics.ini")
    pair = {"G12.1": "G12.3", "G13.1": "G13.3"}
    remaps = [
        " ".join([pair.get(code, code), *words])
        for code, *words in map(str.split, ini.all("RS274NGC", "REMAP"))
    ]
    overrides = {
        "RS274NGC": {"REMAP": remaps, "ON_ABORT_COMMAND": None},
        "AXIS_C": {"WRAPPED_ROTARY": "1"},
    }
    with Machine(ini.path, overrides=overrides) as running:
        yield running


def standing(machine):
    machine.abort()
    modes = "G21 G18 G8 G90 G94 G64 P0.01"
    for block in ("G13.3", "M52 P0", modes, "F1000", "G0 Z5", "G0 X30 C0"):
        machine.mdi(block)
    machine.wait_for(lambda now: not now.adaptive)
    machine.errors(), machine.messages()


def with_pair(lines):
    return [line.replace("G12.1", "G12.3").replace("G13.1", "G13.3") for line in lines]


def aborted_on_the_face(machine, section=SECTION):
    machine.open_text(["%", *with_pair(section), "%"])
    machine.start()
    machine.wait_for(lambda _: on_the_face(machine))
    time.sleep(0.2)
    machine.abort()
    machine.estop()  # which ends the request for the face
    machine.enable()
    machine.wait_for(lambda _: not on_the_face(machine))


def accelerations(machine):
    return [machine.get(f"ini.{axis}.max_acceleration") for axis in "xy"]


@needs_kinematics
def test_without_a_handler_the_next_code_restores_what_no_operator_sees(lathe):
    standing(lathe)
    lathe.mdi("G61")
    aborted_on_the_face(lathe)
    lathe.mdi("G18 G64 P0.003")  # the operator's modes since
    run = lathe.run_text(["%", "G0 X30 C0", *with_pair(SECTION), "G0 C10", "%"])
    assert run.error is None
    assert lathe.stat().modes.blending[0] == 0.003
    assert "G64" in lathe.stat().modes.gcodes and accelerations(lathe) == [707, 707]
    said = [message.text for message in run.messages]
    assert any("G12.3: a code before it was interrupted" in text for text in said), said
    lathe.mdi("G0 C400")
    lathe.wait_for_error("wrapped rotary")


@needs_kinematics
def test_without_a_handler_g13_1_in_mdi_restores_all(lathe):
    standing(lathe)
    for block in ("G61", "G95 F1 S1000 M3", "G91"):
        lathe.mdi(block)
    before = lathe.stat().modes
    aborted_on_the_face(lathe, INCREMENTAL)
    lathe.mdi("G13.3")
    assert lathe.errors() == []
    lathe.wait_for(lambda now: not now.adaptive)  # the next block reads it from motion
    lathe.mdi("M3")
    found = lathe.stat().modes
    assert (set(found.gcodes) - {"G0", "G1"}, found.mcodes, found.feed) == (
        set(before.gcodes) - {"G0", "G1"}, before.mcodes, before.feed,
    )  # fmt: skip
    assert lathe.errors() == []


def test_without_a_handler_g13_1_in_mdi_restores_the_path_control_of_motion():
    """The interpreter had read past the section: it shows G61 all the time."""
    without = {"RS274NGC": {"ON_ABORT_COMMAND": None}}
    with Machine(SIM / "lathe_mm.ini", overrides=without) as machine:
        for block in ("G21 G18 G8 G90 G94 G61 F1000", "G0 Z20", "G0 X30 C0"):
            machine.mdi(block)
        machine.open_text(["%", *SECTION, "%"])
        machine.start()
        machine.wait_for(lambda _: machine.get("axis.c.pos-cmd") > 5)
        machine.abort()
        machine.mdi("G13.1")
        machine.mdi("G0 X30 Z20")
        run = machine.run_text(["%", "G1 X36 F1500", "Z14", "%"])
        axes = run.samples.axes
        assert np.hypot(axes["X"] - 36, axes["Z"] - 20).min() < 1e-4


@needs_kinematics
def test_a_refusal_at_the_switch_is_a_sentence_with_its_line():
    with Machine(SIM / "lathe_mm_kinematics.ini") as machine:
        machine.connect("ini.x.max_acceleration")
        run = machine.run_text(["G21 G18 G8 G90 G94 F1000", "G0 X30 Z2", *SECTION, "M2"])
        rule = "ini.x.max_acceleration is connected to a HAL signal"
        assert run.error.text.startswith(f"G12.1 line 4: {rule}")  # its first move on the face
        assert not on_the_face(machine)


def test_an_abort_while_an_endless_section_is_read(tmp_path):
    with Machine(SIM / "lathe_mm.ini") as machine:
        for block in ("G21 G18 G8 G90 G61", "G0 X30 Z2"):
            machine.mdi(block)
        before = machine.stat().modes
        machine.open_text(["%", *ENDLESS, "%"])
        machine.start()
        time.sleep(1.1)
        machine.abort()
        machine.mdi("G4 P0")
        assert set(machine.stat().modes.gcodes) - {"G4"} == set(before.gcodes) - {"G4"}
        assert machine.errors() == []


def test_a_command_of_the_user_s_own_runs_as_well(tmp_path):
    sub = "o<on_abort> sub\n(DEBUG, aborted for #1)\nM68 E1 Q7\no<on_abort> endsub\n"
    (tmp_path / "on_abort.ngc").write_text(sub)
    ini = read_ini(SIM / "mill_mm.ini")
    path = f"{ini.get('RS274NGC', 'SUBROUTINE_PATH')}:{tmp_path}"
    overrides = {
        "RS274NGC": {"SUBROUTINE_PATH": path},
        "G12": {"ON_ABORT_COMMAND": "O <on_abort> call"},
    }
    with Machine(ini.path, overrides=overrides) as machine:
        for block in ("T3 M6", "G91 G61", "F600"):
            machine.mdi(block)
        machine.messages()
        machine.open_text(["%", "G13 I5 K40 Q.2 Z-1 D3", "%"])
        machine.start()
        time.sleep(0.5)
        machine.abort()
        machine.wait_for(lambda _: machine.get("motion.analog-out-01") == 7)
        said = "aborted for 8.000000"  # the message may arrive after the output
        machine.wait_for(lambda _: said in {text.strip() for _, text in machine.messages()})
        assert {"G91", "G61"} <= set(machine.stat().modes.gcodes) and machine.errors() == []


@needs_kinematics
@pytest.mark.parametrize("section", ["RS274NGC", "G12"])
def test_the_command_of_an_earlier_version_restores_all(section):
    """Install wrote G13.1 P, and a later one kept it as the user's own."""
    overrides = {section: {"ON_ABORT_COMMAND": "G13.1 P"}}
    with Machine(SIM / "lathe_mm_kinematics.ini", overrides=overrides) as machine:
        for block in ("G21 G18 G8 G91 G94 G64 P0.05 Q0.03", "F1000", "G0 Z5", "G0 X30 C0"):
            machine.mdi(block)
        before = machine.stat().modes
        machine.errors(), machine.messages()
        machine.open_text(["%", *INCREMENTAL, "%"])
        machine.start()
        machine.wait_for(lambda _: on_the_face(machine))
        time.sleep(0.2)
        machine.abort()
        machine.wait_for(lambda now: not on_the_face(machine) and not now.adaptive)
        machine.mdi("G0 C5")
        found = machine.stat().modes
        assert (found.gcodes, found.blending) == (before.gcodes, before.blending)
        assert found.feed == pytest.approx(before.feed)
        assert machine.errors() == [] and machine.messages() == []
