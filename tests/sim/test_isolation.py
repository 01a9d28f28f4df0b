# SPDX-License-Identifier: GPL-2.0-or-later
"""The namespaces of a headless run while others use the machine too."""

import os
import subprocess
import tempfile
import threading
from pathlib import Path

import pytest

from g12.tools.headless.errors import StartupError, Timeout
from g12.tools.headless.namespaces import Isolated, has_namespaces
from support.operated_machine import UnhomedMachine
from support.sim_machines import SIM


@pytest.fixture
def busy_tmp():
    """Others make and remove folders in /tmp all the time."""
    done = threading.Event()

    def others():
        while not done.is_set():
            made = [tempfile.TemporaryDirectory(dir="/tmp") for _ in range(30)]
            for folder in made:
                folder.cleanup()

    thread = threading.Thread(target=others)
    thread.start()
    yield
    done.set()
    thread.join()


def exit_code_of_nothing():
    isolated = Isolated()
    try:
        isolated.launch(["true"], {})
        return isolated.wait(300), isolated.log()
    finally:
        isolated.close()


def test_what_others_remove_from_tmp_does_not_matter(busy_tmp):
    assert [exit_code_of_nothing() for _ in range(8)] == [(0, "")] * 8


@pytest.mark.skipif(not has_namespaces(), reason="a container is the isolation itself")
def test_linuxcncs_own_files_in_tmp_are_those_of_one_run():
    with (
        tempfile.NamedTemporaryFile(prefix="linuxcnc.", dir="/tmp") as file,
        tempfile.TemporaryDirectory(prefix="linuxcnc.", dir="/tmp") as clone,
    ):
        isolated, name = Isolated(), Path(file.name)
        look = f"test -e {name} || echo none; test -d {clone} && touch {name}.own && ls {name}.own"
        isolated.launch(["sh", "-c", look], {})
        said = isolated.wait(300), isolated.log()
        isolated.close()
        assert said == (0, f"none\n{name}.own\n")
        assert not Path(f"{name}.own").exists()


def test_a_machine_whose_folder_is_tmp_itself_has_an_ini_of_its_own():
    with tempfile.NamedTemporaryFile("w+", dir="/tmp", suffix=".ini") as file:
        file.write("outside\n")
        file.flush()
        isolated, name = Isolated(), Path(file.name)
        isolated.launch(["cat", file.name, file.name], {Path("/tmp"): {name.name: "inside\n"}})
        said = isolated.wait(300), isolated.log()
        isolated.close()
        assert said == (0, "inside\n" * 2)
        assert name.read_text() == "outside\n"


def test_where_the_system_makes_namespaces_so_do_we():
    """Else every run would wait for the others, and no test of a run say why."""
    user = [] if os.geteuid() == 0 else ["--user", "--map-current-user"]
    kinds = ["--ipc", "--net", "--pid", "--fork", "--mount", "--mount-proc"]
    made = subprocess.run(["unshare", *user, *kinds, "true"], capture_output=True)
    assert has_namespaces() == (made.returncode == 0)


def test_a_milltask_that_does_not_come_up_is_named():
    nobody = {"TASK": {"TASK": "yes"}}
    named = pytest.raises((StartupError, Timeout), match=r"no milltask within|inihal")
    with named, UnhomedMachine(SIM / "mill_mm.ini", overrides=nobody) as machine:
        machine.stat()
