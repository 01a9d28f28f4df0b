# SPDX-License-Identifier: GPL-2.0-or-later
"""Start a command, and end it with all its processes; run by ``namespaces`` as a program.

All ends when standard input is closed, also by the end of the process that opened it. The job is a
line of JSON on standard input: ``command``, ``environment``, and ``remove``, directories to be
removed in that case.

On a system without namespaces the container that forbids them is the isolation. One LinuxCNC runs
at a time: others of the same user wait for their turn, and a foreign LinuxCNC is an error, not
disturbed. The job has ``turn``, the open folder whose lock marks the turn, ``copies``, a map of
directory to the texts that replace files in it, and ``covers``, a map of program to the one that
replaces it. A private directory is a copy in a tree of links that mirrors the real one.
"""

import contextlib
import ctypes
import glob
import json
import os
import re
import select
import shutil
import signal
import socket
import sys
import time

PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 36, 38
IPC_RMID = 0
LINUXCNC_LOCK = "/tmp/linuxcnc.lock"
LINUXCNC_PORT = 5005  # of its server: whoever reaches it commands the machine
LINUXCNC = re.compile(r"milltask|linuxcncsvr|rtapi")  # names of LinuxCNC's processes
SEGMENT = re.compile(rb"(\d+) +/SYSV([0-9a-f]{8}) \(deleted\)$", re.MULTILINE)  # number, key
CLEAN_UP = 15.0  # s that LinuxCNC may take for it
REFUSED = 125  # exit code: this LinuxCNC cannot be started here

libc = ctypes.CDLL(None, use_errno=True)


class IsolationError(OSError):
    """The command cannot be kept apart from others."""


def raise_if_failed(result: int, action: str) -> None:
    if result:
        raise IsolationError(f"{action}: {os.strerror(ctypes.get_errno())}")


def running() -> list[str]:
    found = []
    for entry in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):  # it has ended
            with open(f"/proc/{entry}/comm", encoding="utf-8") as file:
                name = file.read().strip()
            found += [f"{name} ({entry})"] if LINUXCNC.match(name) else []
    return found


def refuse_beside_another() -> None:
    found = running()
    if found:
        raise IsolationError(
            f"a LinuxCNC runs here already, {found[0]}, and this system allows no namespaces to "
            "keep another one apart from it"
        )


def mirrored(directory: str, files: dict[str, str], tree: str) -> str:
    """Return a private copy of a directory inside ``tree``, whose other entries are links.

    Its files are copies, some replaced by the texts in ``files``.
    """
    real, copy = "/", tree
    for part in os.path.realpath(directory).strip("/").split("/"):
        link_entries(real, copy, besides=part)
        real, copy = os.path.join(real, part), os.path.join(copy, part)
    os.makedirs(copy, exist_ok=True)
    for entry in os.scandir(real):
        target = os.path.join(copy, entry.name)
        if entry.is_file() and entry.name not in files:
            if os.access(entry.path, os.R_OK):
                shutil.copy(entry.path, target)
        elif entry.name not in files:
            os.symlink(entry.path, target)
    for name, text in files.items():
        with open(os.path.join(copy, name), "w", errors="surrogateescape") as file:
            file.write(text)
    return copy


def link_entries(real: str, copy: str, besides: str) -> None:
    """Fill a directory of the tree with links to the entries of the real one."""
    os.makedirs(copy, exist_ok=True)
    for name in set(os.listdir(real)) - set(os.listdir(copy)) - {besides}:
        os.symlink(os.path.join(real, name), os.path.join(copy, name))


def moved(command: list[str], job: dict) -> list[str]:
    """Return the command with paths in the copied directories moved to the tree."""
    tree = os.path.join(job["remove"][0], "tree")
    for directory, files in job["copies"].items():
        copy = mirrored(directory, files, tree)
        put_in_front(job["covers"], os.path.join(copy, "bin"))
        command = [
            copy + word[len(directory) :] if word.startswith(f"{directory}/") else word
            for word in command
        ]
    return command


def put_in_front(covers: dict[str, str], folder: str) -> None:
    """Put programs into a config's ``bin``, where LinuxCNC searches first."""
    own = os.path.realpath(folder)
    if os.path.islink(folder):
        os.unlink(folder)
    os.makedirs(folder, exist_ok=True)
    for covered, file in covers.items():
        os.symlink(file, os.path.join(folder, os.path.basename(covered)))
    if os.path.isdir(own):
        link_entries(own, folder, besides="")


def system_v(kind: str) -> dict[int, str]:
    """Return number and key of all shared memory (``shm``) or semaphores (``sem``)."""
    with open(f"/proc/sysvipc/{kind}", encoding="ascii") as file:
        rows = [line.split() for line in file.readlines()[1:]]
    return {int(number): f"{int(key) & 0xFFFFFFFF:08x}" for key, number, *_ in rows}


def own_shared_memory() -> dict[int, str]:
    """Return number and key of the shared memory that the processes below this one use."""
    found: dict[int, str] = {}
    for process in descendants(os.getpid()):
        with contextlib.suppress(OSError), open(f"/proc/{process}/maps", "rb") as file:
            found |= {int(number): key.decode() for number, key in SEGMENT.findall(file.read())}
    return found


def descendants(process: int) -> list[int]:
    below = children(process)
    return below + [each for child in below for each in descendants(child)]


def children(process: int) -> list[int]:
    """Return the processes whose parent it is; this one's are orphans of its children too."""
    found = []
    for name in glob.glob(f"/proc/{process}/task/*/children"):
        with contextlib.suppress(OSError), open(name, encoding="ascii") as file:
            found += [int(number) for number in file.read().split()]
    return found


def exit_code_of(child: int, descriptor: int, patience: float) -> int:
    """Let the command end, as it does when its screen ends, or end it; return its exit code."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        if not select.select([descriptor], [], [], patience)[0]:
            os.kill(child, number)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def end_all() -> None:
    """End every remaining process."""
    end = time.monotonic() + CLEAN_UP
    while (remaining := children(os.getpid())) and time.monotonic() < end:
        for number in remaining:
            try:
                os.kill(number, signal.SIGKILL)
                os.waitpid(number, 0)
            except OSError:
                time.sleep(0.1)  # LinuxCNC's realtime part may be root's: it ends by itself


def free(memory: dict[int, str]) -> None:
    """Free shared memory, and the semaphores of the same keys, which LinuxCNC leaves."""
    for number in memory:
        libc.shmctl(number, IPC_RMID, None)
    for number, key in system_v("sem").items():
        if key in memory.values():
            libc.semctl(number, 0, IPC_RMID)


def run(job: dict, patience: float = 0.0) -> tuple[int, dict[int, str]]:
    """Run the command until it ends or standard input closes, and end what it has started.

    Return its exit code and the shared memory in use at its end. ``patience`` in seconds is for an
    end by itself.
    """
    child = os.posix_spawnp(job["command"][0], job["command"], job["environment"])
    descriptor = os.pidfd_open(child)
    select.select([descriptor, sys.stdin], [], [])
    memory = own_shared_memory()
    code = exit_code_of(child, descriptor, patience)
    memory |= own_shared_memory()
    end_all()
    return code, memory


def run_contained(job: dict) -> int:
    """Run LinuxCNC without namespaces, and remove what it leaves in the system."""
    os.set_inheritable(job["turn"], False)  # the lock is held until this process ends
    refuse_beside_another()
    if os.geteuid():  # a setuid rtapi_app would lack root's right to the user's shared memory
        raise_if_failed(libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "staying an ordinary user")
    before = system_v("shm")
    with socket.socket() as port:
        with contextlib.suppress(OSError):  # taken already
            port.bind(("", LINUXCNC_PORT))  # LinuxCNC goes on without it
        code, memory = run({**job, "command": moved(job["command"], job)}, CLEAN_UP)
    with contextlib.suppress(OSError):  # none, or an old one of another user
        os.unlink(LINUXCNC_LOCK)
    free({number: key for number, key in memory.items() if number not in before})
    return code


def main() -> int:
    job = json.loads(sys.stdin.readline())
    raise_if_failed(libc.prctl(PR_SET_CHILD_SUBREAPER, 1), "taking in orphans")
    code = run_contained(job) if "turn" in job else run(job)[0]
    if select.select([sys.stdin], [], [], 0)[0]:  # closed: the starting process has ended
        for folder in job["remove"]:
            shutil.rmtree(folder, ignore_errors=True)
    return code & 0xFF


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as problem:
        print(problem, file=sys.stderr)
        sys.exit(REFUSED)
