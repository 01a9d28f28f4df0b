# SPDX-License-Identifier: GPL-2.0-or-later
"""A LinuxCNC in namespaces of its own, with scratch directories, log and clean-up.

The namespaces are made by ``namespaces_init.py``, a process that ends with everything inside when
this one closes its standard input, also by dying. No other user can enter the scratch directory.
"""

from __future__ import annotations

import contextlib
import fcntl
import functools
import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any

from g12.tools.headless.errors import StartupError
from g12.tools.system import PYTHON

ISOLATE = Path(__file__).with_name("namespaces_init.py")
CONTAINED = Path(__file__).with_name("contained_init.py")
TURNS = "/tmp/g12-turns-{}"  # without namespaces: a user's folder, whose lock marks the turn
HOME_TURNS = "~/.g12-turns"  # where another user has taken that name
LONGEST_QUEUE = 3600.0  # s, for the turn
TURN_POLL = 0.1  # s
NO_SCREEN = ("DISPLAY", "WAYLAND_DISPLAY", "INI_FILE_NAME")


class OneAtATime(RuntimeError):
    """A second process was started without namespaces while the first still runs."""


class Isolated:
    """One isolated process: ``folder`` is its scratch directory."""

    _contained: Isolated | None = None  # the process of this program that is running

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="g12-", dir="/tmp"))
        for name in ("bin", "home", "programs"):
            (self.folder / name).mkdir()
        self._process: subprocess.Popen | None = None

    def install(self, name: str, code: str) -> Path:
        """Install Python code as a program that the process finds by its name."""
        program = self.folder / "bin" / name
        program.write_text(f"#!{PYTHON}\n{code}", encoding="utf-8")
        program.chmod(0o755)
        return program

    def launch(
        self,
        command: Sequence[str],
        copies: Mapping[Path, Mapping[str, str]],
        covers: Mapping[str, Path] | None = None,
        inherited: tuple[int, ...] = (),
    ) -> None:
        """Start ``command``.

        ``copies`` are directories that are replaced by private copies, with texts for some of their
        files. ``covers`` are files that replace others. ``inherited`` are descriptors that the
        command gets. Without namespaces it waits for its turn among the user's runs.
        """
        job: dict[str, Any] = {
            "command": list(command),
            "environment": self._environment(),
            "copies": {str(directory): dict(files) for directory, files in copies.items()},
            "covers": {covered: str(file) for covered, file in (covers or {}).items()},
            "scratch": str(self.folder),
        }
        with open(self.folder / "log.txt", "wb") as log:
            if has_namespaces():
                self._process = started(ISOLATE, job, log, inherited)
                return
            turn = job["turn"] = self._turn()
            try:
                self._process = started(CONTAINED, job, log, (*inherited, turn))
            finally:
                os.close(turn)

    def wait(self, timeout: float) -> int:
        """Wait up to ``timeout`` seconds for the end and return the exit code."""
        return self._process.wait(timeout)

    def log(self) -> str:
        return (self.folder / "log.txt").read_text(encoding="utf-8", errors="replace")

    def close(self) -> None:
        """End everything at once and remove the scratch directory."""
        if self._process:
            self._process.stdin.close()
            self._process.wait()
        if Isolated._contained is self:
            Isolated._contained = None
        shutil.rmtree(self.folder, ignore_errors=True)

    def _turn(self) -> int:
        if Isolated._contained:
            raise OneAtATime("one LinuxCNC at a time: there are no namespaces here")
        turn = next_turn()
        Isolated._contained = self
        return turn

    def _environment(self) -> dict[str, str]:
        kept = {key: value for key, value in os.environ.items() if key not in NO_SCREEN}
        private = {
            "HOME": str(self.folder / "home"),
            "PATH": f"{self.folder / 'bin'}:{os.environ.get('PATH', os.defpath)}",
            "TMPDIR": "/tmp",
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        return {**kept, **private}


def next_turn() -> int:
    """Wait for this user's other runs; return the descriptor whose lock marks the turn."""
    folder = folder_of_turns()
    end = time.monotonic() + LONGEST_QUEUE
    while True:
        with contextlib.suppress(BlockingIOError):
            fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return folder
        if time.monotonic() > end:
            os.close(folder)
            raise StartupError(f"another run of yours has not ended in {LONGEST_QUEUE:g} s")
        time.sleep(TURN_POLL)


def folder_of_turns() -> int:
    """Open a folder that this user alone can open, and so lock.

    Another user may have taken the usual one; nobody else can take one in the user's home.
    """
    user, known = os.geteuid(), TURNS.format(os.geteuid())
    paths = (known, os.path.expanduser(HOME_TURNS))
    for path in paths:
        with contextlib.suppress(OSError):
            os.mkdir(path, 0o700)
        with contextlib.suppress(OSError):
            folder = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
            status = os.fstat(folder)
            if (status.st_uid, stat.S_IMODE(status.st_mode)) == (user, 0o700):
                return folder
            os.close(folder)
    raise StartupError(f"{known}: not a folder that only you can enter: remove it")


@functools.cache
def has_namespaces() -> bool:
    """Return whether this system allows namespaces, and the user if it does not."""
    nothing = {"command": ["true"], "environment": {}, "copies": {}, "covers": {}, "scratch": ""}
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8") as log,
        started(ISOLATE, nothing, log) as init,
    ):
        refused = init.wait()
        log.seek(0)
        why = (log.read().strip().splitlines() or ["no reason given"])[-1]
    if refused:
        print(f"g12: without namespaces ({why}): one LinuxCNC at a time", file=sys.stderr)
    return not refused


def started(
    script: Path, job: Mapping[str, object], log: IO, inherited: tuple[int, ...] = ()
) -> subprocess.Popen:
    """Start a script with its job; it ends when its standard input is closed."""
    streams: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": log, "stderr": log}
    command = [PYTHON, str(script)]
    process = subprocess.Popen(command, **streams, pass_fds=inherited, start_new_session=True)
    process.stdin.write(json.dumps(job).encode() + b"\n")
    process.stdin.flush()
    return process
