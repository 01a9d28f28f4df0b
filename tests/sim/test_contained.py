# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs in a plain container: no right to mount, no namespaces; it is the isolation itself."""

import os
import re
import subprocess

import pytest

from g12.tools.system import PYTHON
from support.sim_machines import ROOT, SIM

CONTAINER = ["unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "--ipc", "--net"]
PLAIN = ["setpriv", "--bounding-set", "-sys_admin", "--inh-caps", "-sys_admin", "sh", "-c"]
RUN = f"{PYTHON} {ROOT}/python/g12 run {{}} --ini {SIM}/mill_mm.ini"
LEFT = "cat /proc/sysvipc/shm; ps -eo comm=; ls /tmp/linuxcnc.lock"
LISTENING = "grep -q ' 0A ' /proc/net/tcp && echo listens"
GONE = "for n in $(seq 70); do ps -eo comm= | grep -qE 'milltask|rtapi' || break; sleep 0.5; done"


@pytest.fixture
def contained():
    """Run shell commands as a container that starts with them does."""
    if os.geteuid() or subprocess.run([*CONTAINER, "true"], capture_output=True).returncode:
        pytest.skip("only root can make something like a container")

    def run(commands):
        whole = [*CONTAINER, *PLAIN, commands]
        return subprocess.run(whole, capture_output=True, text=True, timeout=600)

    return run


def run_of(folder, block):
    """Return the command that runs a program of one block."""
    program = folder / "program.ngc"
    program.write_text(f"G21 G90 F3000\n{block}\nM2\n")
    return RUN.format(program)


def test_a_run_is_told_to_be_without_namespaces_and_leaves_nothing(contained, tmp_path):
    done = contained(f"{run_of(tmp_path, 'G1 X1')} || exit; {LEFT}")
    assert "s in motion" in done.stdout
    assert done.stderr.count("g12: without namespaces (") == 1
    assert "milltask" not in done.stdout and "rtapi" not in done.stdout
    assert len([line for line in done.stdout.splitlines() if line.split()[0].isdigit()]) == 0


def test_one_that_is_killed_leaves_nothing(contained, tmp_path):
    killed = f"timeout -s KILL 6 {run_of(tmp_path, 'G4 P60')}; {GONE}; {LEFT}"
    done = contained(killed)
    assert "milltask" not in done.stdout and "rtapi" not in done.stdout
    assert "/tmp/linuxcnc.lock" not in done.stdout


def test_only_its_own_shared_memory_is_freed(contained, tmp_path):
    """LinuxCNC frees its own, unless it is killed."""
    up = "until ps -eo comm= | grep -q milltask; do sleep 0.1; done; sleep 1; ipcmk --shmem 4321"
    killed = "kill -KILL $(pidof -x linuxcnc)"
    done = contained(f"{run_of(tmp_path, 'G4 P60')} & {up}; {killed}; wait; {LEFT}")
    assert "LinuxCNC ended" in done.stderr
    segments = re.findall(r"^ *-?\d+ +\d+ +\d+ +(\d+) ", done.stdout, re.MULTILINE)
    assert segments == ["4321"]


def test_nobody_commands_its_linuxcnc_over_the_network(contained, tmp_path):
    listens = f"while kill -0 $!; do {LISTENING}; ps -eo comm=; sleep 0.2; done"
    done = contained(f"{run_of(tmp_path, 'G4 P2')} & {listens}")
    assert "milltask" in done.stdout
    assert "listens" not in done.stdout


def test_another_linuxcnc_is_left_alone(contained, tmp_path):
    other = tmp_path / "milltask"
    other.symlink_to("/usr/bin/sleep")
    done = contained(f"{other} 100 & {run_of(tmp_path, 'G1 X1')}; ps -eo comm=; kill $!")
    assert "a LinuxCNC runs here already, milltask (" in done.stderr
    assert done.stderr.count("Traceback") == 0
    assert "milltask" in done.stdout


def test_the_tool_change_dialogue_is_covered_beside_a_configs_own_programs(contained, tmp_path):
    """LinuxCNC puts the config's own bin in front of PATH."""
    (tmp_path / "machine" / "bin").mkdir(parents=True)
    for program in (tmp_path / "machine" / "bin" / "own", tmp_path / "dialogue"):
        program.write_text(f"#!/bin/sh\necho this is {program.name}\n")
        program.chmod(0o755)
    code = f"""if True:
        from pathlib import Path
        from g12.tools.headless.namespaces import Isolated
        machine, isolated = Path("{tmp_path}/machine"), Isolated()
        dialogue = "{tmp_path}/dialogue"
        shown = ["sh", "-c", "$0/bin/own; $0/bin/hal_manualtoolchange", f"{{machine}}/."]
        isolated.launch(shown, {{machine: {{}}}}, {{"/usr/bin/hal_manualtoolchange": dialogue}})
        assert isolated.wait(300) == 0
        print(isolated.log())
        isolated.close()"""
    done = contained(f"PYTHONPATH={ROOT}/python {PYTHON} -c '{code}'")
    assert done.stdout.split("\n")[:2] == ["this is own", "this is dialogue"]
    assert [path.name for path in (tmp_path / "machine" / "bin").iterdir()] == ["own"]
