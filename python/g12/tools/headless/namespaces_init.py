# SPDX-License-Identifier: GPL-2.0-or-later
"""Start a command in namespaces of its own; run by ``headless`` as a program.

The command sees its own processes, shared memory, network and /tmp, so it and a LinuxCNC outside
cannot affect each other.  Files outside keep their names; directories named in the job are replaced
by copies, which get all writes.  Everything ends with this process, and this process ends when its
standard input is closed.

The job is a line of JSON on standard input: ``command``, ``environment``, ``copies``, a map of
directory to the files that replace real ones in it, ``covers``, a map of file to the file that
replaces it, and ``scratch``, a directory to be removed if the other end of standard input goes
away.
"""

import ctypes
import json
import os
import select
import shutil
import signal
import stat
import sys

CLONE_NEWNS, CLONE_NEWIPC = 0x00020000, 0x08000000
CLONE_NEWUSER, CLONE_NEWPID, CLONE_NEWNET = 0x10000000, 0x20000000, 0x40000000
MS_BIND, MS_REC, MS_PRIVATE = 4096, 16384, 1 << 18
PR_SET_PDEATHSIG = 1
LARGEST_COPY = 1 << 20  # bytes; larger files are shared with the real directory
REFUSED = 125  # exit code: the kernel refuses a namespace or a mount
PRIVATE_IN_TMP = "linuxcnc."  # LinuxCNC's lock and log files, and the folder of its realtime part
REALTIME_FOLDER = f"/tmp/{PRIVATE_IN_TMP}realtime"
TRANSIENT_USERS = range(61184, 65520)  # of no user and of no service for good, says systemd

libc = ctypes.CDLL(None, use_errno=True)


class IsolationError(OSError):
    """The kernel refuses a namespace or a mount."""


def raise_if_failed(result: int, action: str) -> None:
    if result:
        raise IsolationError(f"{action}: {os.strerror(ctypes.get_errno())}")


def unshare() -> None:
    """Enter new namespaces; an ordinary user gets a user namespace with the same user."""
    uid, gid = os.geteuid(), os.getegid()
    flags = CLONE_NEWIPC | CLONE_NEWPID | CLONE_NEWNET
    if uid == 0:
        raise_if_failed(libc.unshare(flags), "new namespaces")
        return
    raise_if_failed(libc.unshare(flags | CLONE_NEWUSER), "new namespaces as an ordinary user")
    write_text("/proc/self/setgroups", "deny")
    write_text("/proc/self/uid_map", f"{uid} {uid} 1")
    write_text("/proc/self/gid_map", f"{gid} {gid} 1")


def write_text(path: str, text: str) -> None:
    with open(path, "w", encoding="utf-8", errors="surrogateescape") as file:
        file.write(text)


def mount(source: str, target: str, kind: str | None, flags: int, options: str = "") -> None:
    """Mount ``source`` on ``target``, with the arguments of the system call."""
    arguments = [os.fsencode(text) if text is not None else None for text in (source, target, kind)]
    raise_if_failed(libc.mount(*arguments, flags, options.encode()), f"mounting {target}")


def bind(source: str, target: str) -> None:
    mount(source, target, None, MS_BIND | MS_REC)


def mirror(directory: str, files: dict[str, str], copy: bool) -> None:
    """Replace a directory by a private one with the same entries.

    ``files`` are texts that replace entries.  With ``copy`` ordinary files are copies, else the
    files themselves; subdirectories are always the real ones.
    """
    real = os.open(directory, os.O_PATH)
    mode = stat.S_IMODE(os.fstat(real).st_mode)
    mount("private", directory, "tmpfs", 0, f"mode={mode:o}")
    for entry in os.scandir(f"/proc/self/fd/{real}"):
        target = os.path.join(directory, entry.name)
        if entry.name in files or entry.name.startswith(PRIVATE_IN_TMP):
            continue
        try:
            mirror_entry(entry, target, copy)
        except OSError:  # other processes may remove theirs from /tmp at any time
            if os.path.lexists(entry.path):
                raise
    for name, text in files.items():
        write_text(os.path.join(directory, name), text)


def mirror_entry(entry: os.DirEntry, target: str, copy: bool) -> None:
    """Make an entry of the real directory appear in the private one, unless it cannot be read."""
    if entry.is_symlink():
        os.symlink(os.readlink(entry.path), target)
    elif entry.is_dir():
        os.mkdir(target)
        bind(entry.path, target)
    elif copy and entry.is_file() and entry.stat().st_size <= LARGEST_COPY:
        copy_file(entry.path, target)
    else:
        write_text(target, "")
        bind(entry.path, target)


def copy_file(source: str, target: str) -> None:
    """Copy contents and permissions; a file that cannot be read is left out."""
    if os.access(source, os.R_OK):
        shutil.copy(source, target)


def prepare(job: dict) -> None:
    """Set up the mounts that the command sees; the supervising process keeps the real ones."""
    raise_if_failed(libc.unshare(CLONE_NEWNS), "new mount namespace")
    mount("none", "/", None, MS_REC | MS_PRIVATE)
    mount("proc", "/proc", "proc", 0)
    mirror("/tmp", {}, copy=False)
    for directory, files in job["copies"].items():
        mirror(directory, files, copy=True)
    for covered, file in job["covers"].items():
        bind(file, covered)
    os.mkdir(REALTIME_FOLDER, 0o700)
    job["environment"] |= realtime_environment(REALTIME_FOLDER)


def realtime_environment(folder: str) -> dict[str, str]:
    """Return what LinuxCNC's realtime part needs, and give it a folder.

    It refuses to be plain root: root's becomes a user of its own. So no other user can enter the
    folder, connect to a socket there or use its shared memory.
    """
    environment = {"RTAPI_FIFO_PATH": os.path.join(folder, "rtapi")}
    if os.geteuid() == 0:
        user = TRANSIENT_USERS[int.from_bytes(os.urandom(4), "big") % len(TRANSIENT_USERS)]
        os.chown(folder, user, -1)
        environment["RTAPI_UID"] = str(user)
    return environment


def first_process(job: dict) -> int:
    """Run the command as process 1 of its namespace, whose end ends all others."""
    libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    prepare(job)
    child = os.posix_spawnp(job["command"][0], job["command"], job["environment"])
    while True:
        pid, status = os.wait()
        if pid == child:
            return os.waitstatus_to_exitcode(status)


def supervise(child: int, scratch: str) -> int:
    """Wait for process 1, and end it when standard input is closed."""
    descriptor = os.pidfd_open(child)
    ready, _, _ = select.select([descriptor, sys.stdin], [], [])
    if descriptor not in ready:
        os.kill(child, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if descriptor not in ready:
        shutil.rmtree(scratch, ignore_errors=True)
    return code


def main() -> int:
    """Run the job and return its exit code; only the supervising process returns."""
    job = json.loads(sys.stdin.readline())
    try:
        unshare()
        child = os.fork()
        if child:
            return supervise(child, job["scratch"])
        code = first_process(job)
    except OSError as error:
        print(error, file=sys.stderr)
        code = REFUSED
    sys.stderr.flush()
    os._exit(code & 0xFF)


if __name__ == "__main__":
    sys.exit(main())
