# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands started as a terminal starts them, and whatever they have started in turn."""

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def start_in_terminal(*command, ignored=(), **options):
    """Return a running command in a session of its own, which obeys all signals not ``ignored``.

    The tests themselves may run where an interrupt is ignored, with ``&`` or in a service.
    """

    def set_signals():
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN if number in ignored else signal.SIG_DFL)

    return subprocess.Popen(command, preexec_fn=set_signals, start_new_session=True, **options)


def living(session):
    """Return the processes of a session that still run."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            state, _, _, its = path.read_text().rpartition(")")[2].split()[:4]
            found += [int(path.parent.name)] if its == str(session) and state != "Z" else []
    return found


def until(condition, seconds):
    """Wait up to so many seconds for a condition; return whether it holds."""
    end = time.monotonic() + seconds
    while not (held := condition()) and time.monotonic() < end:
        time.sleep(0.1)
    return bool(held)


def kill_session(process):
    """End a command and everything of its session at once."""
    for number in living(process.pid):
        with contextlib.suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
    with process:  # waits, and closes its pipes
        pass
