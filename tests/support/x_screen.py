# SPDX-License-Identifier: GPL-2.0-or-later
"""LinuxCNC's own screens on an X display that nobody sees, isolated."""

import shutil
import subprocess
import time
from contextlib import contextmanager, suppress

import pytest

from g12.tools.headless.namespaces import Isolated

XVFB_START = 240.0  # s, at most, for a screen to come up and for a session at it
INCOMPLETE = "Namespace GtkSource not available"


def kept_display():
    """Return a fixture: the name of an X display of our own."""

    @pytest.fixture(scope="module")
    def display():
        if not shutil.which("Xvfb"):
            pytest.skip("Xvfb is not installed")
        command = ["Xvfb", "-displayfd", "1", "-screen", "0", "1280x900x24", "-nolisten", "tcp"]
        # A program in namespaces has no shared memory with the server: the number of its segment
        # is that of a stranger's there, or of none.
        command += ["-extension", "MIT-SHM"]
        with subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as server:
            yield f":{server.stdout.readline().strip()}"
            server.terminate()

    return display


@contextmanager
def launched(ini, screen, command, text=None):
    """Yield a function that waits for a condition while a shell command runs with a machine's INI.

    ``text`` of the INI, with {folder} for the scratch directory, replaces the file's own.
    """
    isolated = Isolated()

    def wait(until):
        """Wait until a condition of the log and the scratch directory holds; return the log."""
        end = time.monotonic() + XVFB_START
        while not until(isolated.log(), isolated.folder):
            if INCOMPLETE in isolated.log():
                pytest.skip("gmoccapy lacks a package of its own here")
            assert time.monotonic() < end, isolated.log()
            assert not has_ended(isolated), isolated.log()
        return isolated.log()

    try:
        own = text.replace("{folder}", str(isolated.folder)) if text else ""
        isolated.launch(
            ["env", f"DISPLAY={screen}", "LIBGL_ALWAYS_SOFTWARE=1", "sh", "-c", command],
            copies={ini.parent: {ini.name: own} if own else {}},
        )
        yield wait
    finally:
        isolated.close()


def has_ended(isolated):
    with suppress(subprocess.TimeoutExpired):
        isolated.wait(0.2)
        return True
    return False
