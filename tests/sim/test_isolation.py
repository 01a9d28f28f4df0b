# SPDX-License-Identifier: GPL-2.0-or-later
"""The namespaces of a headless run while others use the machine too."""

import subprocess
import tempfile
import threading

import pytest

from g12.tools.headless import namespaces
from g12.tools.headless.machine import Machine, StartupError, Timeout
from g12.tools.headless.namespaces import obstacle
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


def test_what_others_remove_from_tmp_does_not_matter(busy_tmp):
    assert [obstacle() for _ in range(8)] == [None] * 8


def test_a_machine_that_is_only_slow_is_no_obstacle(monkeypatch):
    def late(*_):
        raise subprocess.TimeoutExpired("true", 60)

    monkeypatch.setattr(namespaces.Isolated, "wait", late)
    assert obstacle() is None


def test_a_refusal_of_the_kernel_is_an_obstacle(monkeypatch):
    monkeypatch.setattr(namespaces.Isolated, "wait", lambda *_: 125)
    monkeypatch.setattr(namespaces.Isolated, "log", lambda *_: "no namespaces\n")
    assert obstacle() == "no namespaces"


def test_a_milltask_that_does_not_come_up_is_named():
    nobody = {"TASK": {"TASK": "yes"}}
    named = pytest.raises((StartupError, Timeout), match=r"no milltask within 5 s|inihal")
    with named, Machine(SIM / "mill_mm.ini", overrides=nobody, home=False) as machine:
        machine.stat()
