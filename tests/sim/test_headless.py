# SPDX-License-Identifier: GPL-2.0-or-later
"""The headless runner itself: control, samples, isolation, clean-up, other people's INIs."""

import os
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from g12.tools.headless.errors import MachineError, StartupError, Timeout
from g12.tools.headless.namespaces import PYTHON, Isolated, has_namespaces
from support.operated_machine import Machine, kept_machine
from support.sim_machines import ROOT, SIM, trace_text, with_package
from support.small_configs import content_of

PATIENCE = 15.0  # s that a container gives LinuxCNC to end by itself, and again after SIGTERM


running = kept_machine("mill_mm")


@pytest.fixture
def machine(running):
    running.reset()
    return running


# Whole programs.


def test_a_recording_with_gaps_is_an_error(machine):
    machine.sample()
    machine.set("sampler.0.overruns", 3)
    with pytest.raises(MachineError, match="3 samples of the motion are lost"):
        machine.samples()


def test_samples_tell_line_speed_and_kind_at_the_servo_rate(machine):
    run = machine.run_text(["G21 G90 G61", "G1 X20 F1200", "G0 Y20", "G4 P.2", "M2"])
    samples = run.samples
    assert run.seconds == pytest.approx(1.35, abs=0.15)  # of the machine, not of the clock
    assert samples.time[1] == pytest.approx(0.001)
    feeding = samples.line == 2
    assert np.max(samples.velocity[feeding]) == pytest.approx(20.0, rel=0.01)
    assert set(samples.kind[feeding]) == {2}
    assert set(samples.kind[samples.line == 3]) == {1}
    speed = np.diff(samples.axes["X"]) / 0.001
    assert np.max(speed) == pytest.approx(20.0, rel=0.01)


def test_modes_behind_a_real_run_are_those_of_the_trace(machine):
    program = "G91 G18 G64 P.01 G95 F.1 S500\nT1 M6\nG43 G0 X.1"
    real = machine.run_text(f"%\n{program}\n%").modes
    assert real == trace_text(program, SIM / "mill_mm.ini").modes


def test_program_stops_are_passed_over(machine):
    result = machine.run_text(["G21 G0 X1", "M0", "G0 X2", "M1", "G0 X3", "M2"])
    assert result.position[0] == pytest.approx(3.0)


# Control.


def test_a_program_without_end_times_out(machine):
    with pytest.raises(Timeout):
        machine.run_text(["o1 while [1]", "o1 endwhile", "M2"], timeout=0.5)


# Isolation.


def test_machines_side_by_side_do_not_touch_each_other(machine):
    with Machine(SIM / "mill_inch.ini") as other:
        machine.mdi("G21 G0 X5")
        other.mdi("G20 G0 X1 Y2")
        assert machine.stat().position[:2] == pytest.approx((5.0, 0.0))
        assert other.stat().position[:2] == pytest.approx((1.0, 2.0))


def shared():
    """Return what LinuxCNC instances share on this computer: memory segments and the lock."""
    lines = subprocess.run(["ipcs", "-m"], capture_output=True, text=True).stdout.splitlines()
    found = {line.split()[1] for line in lines if line.startswith("0x")}
    return found | {name for name in ("/tmp/linuxcnc.lock",) if Path(name).exists()}


def test_nothing_shared_with_the_system():
    before = shared()
    with Machine(SIM / "mill_mm.ini"):
        assert shared() <= before or not has_namespaces()  # a container is the isolation itself
    assert shared() <= before


def test_the_machines_directory_is_never_written(tmp_path):
    folder = copy_of_the_package(tmp_path)
    ini = folder / "configs" / "sim" / "mill_mm.ini"
    (ini.parent / "mill_mm.var").write_text("5221\t7.0\n")
    before = content_of(folder)
    with Machine(ini) as machine:
        machine.mdi("G10 L1 P1 Z5")
        machine.mdi("G10 L2 P1 X3")
        machine.mdi("M2")
    assert content_of(folder) == before


def copy_of_the_package(folder):
    for name in ("configs", "ngc", "python"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def processes_of(folder):
    """Return the processes of the system that a machine in ``folder`` started."""
    found = []
    for status in Path("/proc").glob("[0-9]*"):
        try:
            if str(folder).encode() in (status / "environ").read_bytes():
                found.append(status.name)
        except OSError:
            continue
    return found


def test_nothing_is_left_after_close_or_failure():
    with Machine(SIM / "mill_mm.ini") as machine:
        folder = machine.folder
        assert processes_of(folder)
    assert not processes_of(folder)
    assert not folder.exists()
    with pytest.raises(ZeroDivisionError), Machine(SIM / "mill_mm.ini") as machine:
        folder = machine.folder
        raise ZeroDivisionError
    assert not processes_of(folder)


def test_close_ends_what_hangs():
    isolated = Isolated()
    isolated.launch(["sh", "-c", "trap '' TERM INT HUP; sleep 1000 & sleep 1000"], {})
    while not processes_of(isolated.folder):
        time.sleep(0.05)
    started = time.monotonic()
    isolated.close()
    assert time.monotonic() - started < (PATIENCE if has_namespaces() else 4 * PATIENCE)
    assert not processes_of(isolated.folder)


def test_nothing_is_left_when_the_runner_is_killed():
    code = (
        "import os, sys; from g12.tools.headless.machine import Machine;"
        "machine = Machine(sys.argv[1]);"
        "print(machine.folder, flush=True); os.kill(os.getpid(), 9)"
    )
    command = [PYTHON, "-c", code, str(SIM / "mill_mm.ini")]
    options = {"capture_output": True, "text": True, "env": with_package(os.environ)}
    killed = subprocess.run(command, **options)
    folder = Path(killed.stdout.strip())
    end = time.monotonic() + 120
    while folder.exists() or processes_of(folder):
        assert time.monotonic() < end
        time.sleep(0.05)


def test_a_machine_that_does_not_start_says_why():
    with pytest.raises(StartupError, match=r"CANNOT FIND FILE FOR:nothing\.hal"):
        Machine(SIM / "mill_mm.ini", overrides={"HAL": {"HALFILE": "nothing.hal"}})


def test_homing_that_stands_still_is_not_waited_for():
    still = {"JOINT_0": {"HOME": 5, "MAX_VELOCITY": 1e-9}}
    with pytest.raises(
        StartupError, match=r"homing stands still at joint 0 .*, joint 1 0 \(homed\),"
    ):
        Machine(SIM / "mill_mm.ini", overrides=still)


def test_a_machine_that_cannot_be_switched_on_says_why():
    with pytest.raises(StartupError, match="release of e-stop"):
        Machine(
            SIM / "mill_mm.ini", overrides={"HAL": {"HALCMD": "unlinkp iocontrol.0.emc-enable-in"}}
        )
