# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs beside another user of the computer, who reads, writes, replaces and connects."""

import os
import re
import subprocess

import pytest

from g12.tools.system import PYTHON
from support.sim_machines import ROOT

SYSTEM = ["unshare", "--mount", "--propagation=private", "--pid", "--fork", "--kill-child"]
SYSTEM += ["--mount-proc", "--ipc", "--net"]
# Without the right to mount, and in a chroot, where no one may make a user namespace.
PLAIN = "setpriv --bounding-set -sys_admin --inh-caps -sys_admin chroot /mnt env -C /tmp/package"
CALLERS = {"root": "", "user": "setpriv --reuid 54321 --regid 54321 --clear-groups"}
OTHER = "setpriv --reuid 12345 --regid 12345 --clear-groups"
SET_UP = f"""
mount -t tmpfs -o mode=1777 tmp /tmp
mkdir /tmp/package && cp -r {ROOT}/configs {ROOT}/ngc {ROOT}/python /tmp/package
printf 'G21 G90 F3000\\nT1 M6\\nG1 X1\\nG4 P2\\nM2\\n' >/tmp/program.ngc
mount --rbind / /mnt
cd /tmp/package
"""
RUN = f"env HOME=/tmp {PYTHON} python/g12 run /tmp/program.ngc --ini configs/sim/mill_mm.ini"
ATTACK = f"""
{PYTHON} - <{ROOT}/tests/support/other_user.py >/tmp/loot &
until grep -q here /tmp/loot; do sleep 0.05; done
"""
LOOT = "grep -v here /tmp/loot; ls /tmp/his"


@pytest.fixture(scope="module")
def computer():
    """Run shell commands on a computer of their own: /tmp, processes, shared memory, network."""
    if os.geteuid() or subprocess.run([*SYSTEM, "true"], capture_output=True).returncode:
        pytest.skip("only root can play several users")

    def run(commands):
        whole = [*SYSTEM, "sh", "-c", SET_UP + commands]
        return subprocess.run(whole, capture_output=True, text=True, timeout=600)

    return run


@pytest.mark.parametrize("caller", CALLERS)
@pytest.mark.parametrize("container", ["", PLAIN], ids=["namespaces", "container"])
def test_another_user_gets_at_nothing_of_a_run(computer, container, caller):
    done = computer(f"{ATTACK} timeout 300 {container} {CALLERS[caller]} {RUN}; {LOOT}")
    assert re.fullmatch(r"ends at X1 Y0 Z0 .*\n.* s in motion\n", done.stdout), done.stderr
    assert ("without namespaces" in done.stderr) == bool(container)


def test_runs_of_a_container_wait_for_those_of_the_same_user(computer):
    together = f"{PLAIN} {RUN} & {PLAIN} {RUN}; wait"
    done = computer(f"({together}); {PLAIN} {CALLERS['user']} {RUN}")
    assert done.stdout.count("s in motion") == 3, done.stderr


@pytest.mark.parametrize("plant", ["mkfifo", "ln -s /root"])
def test_a_queue_of_another_user_is_not_used(computer, plant):
    planted = f"{OTHER} {plant} /tmp/g12-turns-0"
    home = "/tmp/.g12-turns"  # HOME is /tmp in RUN
    done = computer(f"{planted}; timeout 300 {PLAIN} {RUN}; stat -c %u%a {home}")
    assert "s in motion" in done.stdout and done.stdout.endswith("\n0700\n"), done.stderr
    assert "Traceback" not in done.stderr
