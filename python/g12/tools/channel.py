# SPDX-License-Identifier: GPL-2.0-or-later
"""The connection to a process inside LinuxCNC: lines of JSON over a socket.

The socket is one of a pair that the process inherits. It has no name, so nobody else can connect to
it or replace it.
"""

import json
import select
import socket
from typing import Any

PIECE = 1 << 16  # bytes


class Channel:
    """One end of the connection."""

    def __init__(self, end: socket.socket) -> None:
        self._socket = end
        self._received = bytearray()

    def send(self, value: object) -> None:
        self._socket.sendall(json.dumps(value).encode() + b"\n")

    def is_ready(self, seconds: float) -> bool:
        """Wait up to ``seconds``; return whether a value has begun or the other end is closed."""
        return bool(self._received or select.select([self._socket], [], [], seconds)[0])

    def receive(self) -> Any:
        """Return the next value; raise EOFError if the other end is closed."""
        while (end := self._received.find(b"\n")) < 0:
            received = self._socket.recv(PIECE)
            if not received:
                raise EOFError
            self._received += received
        line = self._received[:end]
        del self._received[: end + 1]
        return json.loads(line)

    def close(self) -> None:
        self._socket.close()
