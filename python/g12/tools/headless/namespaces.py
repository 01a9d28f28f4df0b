# SPDX-License-Identifier: GPL-2.0-or-later
"""A LinuxCNC in namespaces of its own, with scratch directories, log and clean-up.

The namespaces are bubblewrap's: LinuxCNC sees its own processes, shared memory, network and /tmp,
so it and a LinuxCNC outside cannot affect each other. Files outside keep their names. Where the
system allows none, `supervisor` does without them. It is a process that ends with everything inside
when this one closes its standard input, also by dying. No other user can enter the scratch
directories.
"""

from __future__ import annotations

import contextlib
import fcntl
import functools
import json
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any

from g12.tools.headless.errors import StartupError
from g12.tools.system import PYTHON

SUPERVISOR = Path(__file__).with_name("supervisor.py")
BWRAP = ["bwrap", "--die-with-parent", "--unshare-ipc", "--unshare-pid", "--unshare-net"]
BWRAP += ["--dev-bind", "/", "/", "--proc", "/proc", "--perms", "1777", "--tmpfs", "/tmp"]
BWRAP += ["--dev-bind", "/tmp", "/tmp/.outside"]
# The private /tmp has links to what is outside, but for LinuxCNC's own files, as its lock.
FILL_TMP = """cd /tmp
find .outside -mindepth 1 -maxdepth 1 ! '(' -name 'linuxcnc.*' ! -type d ')' \\
    -exec ln -s -t . {} + 2>/dev/null
cd "$0" && exec "$@"
"""
LARGEST_COPY = 1 << 20  # bytes; larger files are shared with the real directory
TRANSIENT_USERS = range(61184, 65520)  # of no user and of no service for good, says systemd
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
        self.folder, self._realtime = (
            Path(tempfile.mkdtemp(prefix="g12-", dir="/tmp")) for _ in range(2)
        )
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
            "remove": [str(self.folder), str(self._realtime)],
        }
        covering = {covered: str(file) for covered, file in (covers or {}).items()}
        with open(self.folder / "log.txt", "wb") as log:
            if has_namespaces():
                job["command"] = [*self._namespaces(copies, covering), *command]
                self._process = started(job, log, inherited)
                return
            job["covers"] = covering
            job["copies"] = {str(directory): dict(files) for directory, files in copies.items()}
            turn = job["turn"] = self._turn()
            try:
                self._process = started(job, log, (*inherited, turn))
            finally:
                os.close(turn)

    def _namespaces(
        self, copies: Mapping[Path, Mapping[str, str]], covers: Mapping[str, str]
    ) -> Iterator[str]:
        """Yield the words of bubblewrap's command before the one that it starts."""
        yield from BWRAP
        yield from ["--cap-add", "ALL"] if os.geteuid() == 0 else []
        for directory, files in copies.items():
            yield from copied(directory, Path(tempfile.mkdtemp(dir=self.folder)), files)
        for covered, file in covers.items():
            yield from ["--bind", file, inside(covered)]
        yield from ["sh", "-c", FILL_TMP, os.getcwd()]

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
        for folder in (self.folder, self._realtime):
            shutil.rmtree(folder, ignore_errors=True)

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
            "RTAPI_FIFO_PATH": str(self._realtime / "rtapi"),
        }
        if os.geteuid() == 0:  # LinuxCNC's realtime part refuses to be root; the user is its alone
            user = TRANSIENT_USERS[int.from_bytes(os.urandom(4)) % len(TRANSIENT_USERS)]
            os.chown(self._realtime, user, -1)
            private["RTAPI_UID"] = str(user)
        return {**kept, **private}


def copied(directory: Path, copy: Path, files: Mapping[str, str]) -> Iterator[str]:
    """Fill a directory's private copy; yield bubblewrap's words that put it in place.

    ``files`` are texts that replace entries. Other directories, and large files, are the real ones;
    a file that cannot be read is left out. Of /tmp, which is private, only ``files`` are.
    """
    for name, text in files.items():
        (copy / name).write_text(text, encoding="utf-8", errors="surrogateescape")
    target = inside(directory)
    if target == "/tmp":
        for name in files:
            yield from ["--bind", str(copy / name), f"/tmp/{name}"]
        return
    shutil.copymode(directory, copy)
    yield from ["--bind", str(copy), target]
    for entry in (each for each in os.scandir(directory) if each.name not in files):
        if entry.is_symlink():
            (copy / entry.name).symlink_to(os.readlink(entry.path))
        elif entry.is_file() and entry.stat().st_size <= LARGEST_COPY:
            if os.access(entry.path, os.R_OK):
                shutil.copy(entry.path, copy / entry.name)
        else:
            yield from ["--dev-bind", entry.path, f"{target}/{entry.name}"]


def inside(path: os.PathLike | str) -> str:
    """Return where a path leads to in the namespaces."""
    real = os.path.realpath(path)
    return re.sub("^/tmp/", "/tmp/.outside/", real)


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
    try:
        done = subprocess.run([*BWRAP, "true"], capture_output=True, text=True, check=False)
        refused, why = done.returncode, done.stderr.strip()
    except FileNotFoundError:
        refused, why = 1, "bubblewrap is not installed"
    if refused:
        print(f"g12: without namespaces ({why}): one LinuxCNC at a time", file=sys.stderr)
    return not refused


def started(job: Mapping[str, object], log: IO, inherited: tuple[int, ...]) -> subprocess.Popen:
    """Start the supervisor with its job; it ends when its standard input is closed."""
    streams: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": log, "stderr": log}
    command = [PYTHON, str(SUPERVISOR)]
    process = subprocess.Popen(command, **streams, pass_fds=inherited, start_new_session=True)
    process.stdin.write(json.dumps(job).encode() + b"\n")
    process.stdin.flush()
    return process
