# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the simulated machines and the manuals' programs are."""

import os
import shutil
from pathlib import Path

import pytest

from g12.tools.headless.namespaces import has_namespaces
from g12.tools.preview.tracer import Tracer

ROOT = Path(__file__).resolve().parents[2]
SIM = ROOT / "configs" / "sim"
PROGRAMS = ROOT / "tests" / "programs"

BRISK = {  # overrides for a simulated mill in mm: real runs in a fraction of the time
    section: {"MAX_ACCELERATION": 20000, "MAX_VELOCITY": 250}
    for section in ("JOINT_0", "JOINT_1", "JOINT_2", "AXIS_X", "AXIS_Y", "AXIS_Z")
}


def trace_text(text, ini, **machine):
    """Trace a program given as text or as lines, in an interpreter of its own."""
    with Tracer(ini, **machine) as tracer:
        return tracer.trace_text(text)


def kept_tracer(name, **machine):
    """Return a fixture: an interpreter of a simulated machine, for the tests of a module."""

    @pytest.fixture(scope="module")
    def opened():
        with Tracer(SIM / f"{name}.ini", **machine) as tracer:
            yield tracer

    return opened


def machine_scope(**_asked):
    """Return how long a fixture keeps its machine: one test where only one machine can run."""
    return "module" if has_namespaces() else "function"


def copy_of_machines(folder):
    """Copy the simulated machines to a folder; return the new folder of their INI files."""
    shutil.copytree(SIM.parent, folder / "configs")
    for part in ("ngc", "python"):
        (folder / part).symlink_to(ROOT / part)
    return folder / "configs" / "sim"


def with_package(environment):
    """Return an environment in which Python finds the package, and LinuxCNC's modules as before."""
    folders = (str(ROOT / "python"), environment.get("PYTHONPATH"))
    return {**environment, "PYTHONPATH": os.pathsep.join(filter(None, folders))}
