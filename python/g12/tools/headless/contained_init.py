# SPDX-License-Identifier: GPL-2.0-or-later
"""Start a command on a system without namespaces; run by ``namespaces`` as a program.

The container that forbids them is the isolation. One LinuxCNC runs at a time: others of the same
user wait for their turn, and a foreign LinuxCNC is an error, not disturbed. A private directory
is a copy in a tree of links that mirrors the real one. The job is that of ``namespaces_init``, and
``turn``, the open folder whose lock marks the turn. Of the files in ``covers`` only programs are
supported.
"""

import contextlib
import glob
import json
import os
import re
import select
import shutil
import signal
import socket
import sys
import tempfile
import time

from namespaces_init import (
    PRIVATE_IN_TMP,
    REFUSED,
    IsolationError,
    copy_file,
    libc,
    raise_if_failed,
    realtime_environment,
    write_text,
)

PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 36, 38
IPC_RMID = 0
LINUXCNC_LOCK = "/tmp/linuxcnc.lock"
LINUXCNC_PORT = 5005  # of its server: whoever reaches it commands the machine
LINUXCNC = re.compile(r"milltask|linuxcncsvr|rtapi")  # names of LinuxCNC's processes
SEGMENT = re.compile(rb"(\d+) +/SYSV([0-9a-f]{8}) \(deleted\)$", re.MULTILINE)  # number, key
CLEAN_UP = 15.0  # s that LinuxCNC may take for it


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
            copy_file(entry.path, target)
        elif entry.name not in files:
            os.symlink(entry.path, target)
    for name, text in files.items():
        write_text(os.path.join(copy, name), text)
    return copy


def link_entries(real: str, copy: str, besides: str) -> None:
    """Fill a directory of the tree with links to the entries of the real one."""
    os.makedirs(copy, exist_ok=True)
    for name in set(os.listdir(real)) - set(os.listdir(copy)) - {besides}:
        os.symlink(os.path.join(real, name), os.path.join(copy, name))


def moved(command: list[str], job: dict) -> list[str]:
    """Return the command with paths in the copied directories moved to the tree."""
    tree = os.path.join(job["scratch"], "tree")
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


def exit_code_of(child: int, descriptor: int) -> int:
    """Let the command end, as it does when its screen ends, or end it; return its exit code."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        if not select.select([descriptor], [], [], CLEAN_UP)[0]:
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
    with contextlib.suppress(OSError):  # none, or an old one of another user
        os.unlink(LINUXCNC_LOCK)


def free(memory: dict[int, str]) -> None:
    """Free shared memory, and the semaphores of the same keys, which LinuxCNC leaves."""
    for number in memory:
        libc.shmctl(number, IPC_RMID, None)
    for number, key in system_v("sem").items():
        if key in memory.values():
            libc.semctl(number, 0, IPC_RMID)


def run(command: list[str], environment: dict[str, str]) -> int:
    """Run the command until it ends or standard input closes; return its exit code."""
    before = system_v("shm")
    child = os.posix_spawnp(command[0], command, environment)
    descriptor = os.pidfd_open(child)
    select.select([descriptor, sys.stdin], [], [])
    memory = own_shared_memory()
    try:
        return exit_code_of(child, descriptor)
    finally:
        memory |= own_shared_memory()
        end_all()
        free({number: key for number, key in memory.items() if number not in before})


def main() -> int:
    job = json.loads(sys.stdin.readline())
    os.set_inheritable(job["turn"], False)  # the lock is held until this process ends
    refuse_beside_another()
    raise_if_failed(libc.prctl(PR_SET_CHILD_SUBREAPER, 1), "taking in orphans")
    if os.geteuid():  # a setuid rtapi_app would lack root's right to the user's shared memory
        raise_if_failed(libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "staying an ordinary user")
    temporary = {"prefix": PRIVATE_IN_TMP, "dir": "/tmp", "ignore_cleanup_errors": True}
    with tempfile.TemporaryDirectory(**temporary) as folder, socket.socket() as port:
        with contextlib.suppress(OSError):  # taken already
            port.bind(("", LINUXCNC_PORT))  # LinuxCNC goes on without it
        environment = job["environment"] | realtime_environment(folder)
        code = run(moved(job["command"], job), environment)
    if select.select([sys.stdin], [], [], 0)[0]:  # closed: the starting process has ended
        shutil.rmtree(job["scratch"], ignore_errors=True)
    return code & 0xFF


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as problem:
        print(problem, file=sys.stderr)
        sys.exit(REFUSED)
