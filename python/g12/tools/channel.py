# SPDX-License-Identifier: GPL-2.0-or-later
"""The connection to a process inside LinuxCNC: lines of JSON over a socket.

The socket is one of a pair that the process inherits. It has no name, so nobody else can connect to
it or replace it.
"""

import json
import select
import socket
from typing import Any


class Channel:
    """One end of the connection."""

    def __init__(self, end: socket.socket) -> None:
        self._socket = end
        self._lines = end.makefile("rb")

    def send(self, value: object) -> None:
        self._socket.sendall(json.dumps(value).encode() + b"\n")

    def is_ready(self, seconds: float) -> bool:
        """Wait up to ``seconds``; return whether a value is there or the other end is closed."""
        return bool(select.select([self._socket], [], [], seconds)[0])

    def receive(self) -> Any:
        """Return the next value; raise EOFError if the other end is closed."""
        line = self._lines.readline()
        if not line.endswith(b"\n"):
            raise EOFError
        return json.loads(line)

    def close(self) -> None:
        self._lines.close()
        self._socket.close()
