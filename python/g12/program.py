# SPDX-License-Identifier: GPL-2.0-or-later
"""The program behind a block being remapped: its lines seen before the interpreter parses them.

The interpreter parses the next line of its file with ``read(None)``. A line that its parser would choke
on must not get there: it is parsed as a string instead, and the file is moved past it when the
interpreter has to read from the file again (O-words move its place themselves).
"""

from __future__ import annotations

import os
from bisect import bisect_right
from itertools import accumulate
from typing import NamedTuple

NO_MOTION = -1
SKIPPED_OVER = "g12_skipped_over"  # the name of a sub that never exists in a file


class Source(NamedTuple):
    """A program file: its lines, and the byte at which each begins."""

    version: tuple
    lines: list[str]
    starts: list[int]


def read_source(filename: str, known: Source | None = None) -> Source:
    """Return the lines of a program file; ``known`` again if the file has not changed since."""
    status = os.stat(filename)
    version = (filename, status.st_mtime_ns, status.st_size)
    if known and known.version == version:
        return known
    with open(filename, "rb") as file:
        lines = file.read().split(b"\n")
    if not lines[-1]:
        lines.pop()
    starts = list(accumulate((len(line) + 1 for line in lines), initial=0))
    return Source(version, [line.decode("utf-8", "replace") for line in lines], starts)


class Program:
    """The lines that follow the block being remapped.

    ``line`` is the number of the line taken last, counted from 1 as an editor does.
    """

    def __init__(self, interp: object, known: Source | None = None) -> None:
        self.interp = interp
        self.home = interp.filename
        self.source = read_source(self.home, known)
        self.line = bisect_right(self.source.starts, interp.blocks[interp.remap_level].offset)
        self._in_file = self.line  # how far the interpreter has read its file
        interp.sequence_number = self.line

    @property
    def place(self) -> str:
        """The line taken last, for an operator."""
        filename = self.source.version[0]
        return str(self.line) + (
            "" if filename == self.home else f" of {os.path.basename(filename)}"
        )

    def take(self) -> str | None:
        """Return the next line and count it as read; None at the end of the file."""
        if self.line == len(self.source.lines):
            return None
        self.line += 1
        return self.source.lines[self.line - 1]

    def parse(self, text: str | None = None) -> None:
        """Let the interpreter parse the line taken, or ``text`` in its place."""
        interp = self.interp
        if text is None and self._in_file == self.line - 1:
            interp.read(None)
            self._in_file = self.line
        else:
            interp.sequence_number = self.line
            interp.read(self.source.lines[self.line - 1] if text is None else text)

    def pass_by(self, *, harmless: bool = True) -> None:
        """Leave out the line taken; ``harmless`` tells that the parser could read it."""
        if harmless and self._in_file == self.line - 1:
            self.parse()

    def control(self) -> int:
        """Let the interpreter read and obey the line taken, an O-word; return its status.

        It may go on elsewhere, even in another file.
        """
        self.catch_up(self.line - 1)
        self.parse()
        return self.follow()

    def follow(self) -> int:
        """Execute the block parsed last and go on wherever that leads; return its status."""
        interp = self.interp
        status = interp.execute(None)
        if interp.filename != self.source.version[0]:
            self.source = read_source(interp.filename)
        interp.read("")
        self.line = bisect_right(self.source.starts, interp.blocks[0].offset - 1)
        self._in_file = interp.sequence_number = self.line
        return status

    def catch_up(self, line: int | None = None) -> None:
        """Make the interpreter read on behind ``line`` (default: the line taken) of its file.

        Nothing but the return from a sub moves its place: so call an empty one, whose lines need not
        be in any file, and change where it returns to.
        """
        interp, line = self.interp, self.line if line is None else line
        if self._in_file != line:
            interp.read(f"o<{SKIPPED_OVER}> call")
            interp.execute(None)
            frame = interp.sub_context[interp.call_level - 1]
            frame.position = self.source.starts[line]
            frame.sequence_number = line
            for keyword in ("sub", "endsub"):
                interp.read(f"o<{SKIPPED_OVER}> {keyword}")
                interp.execute(None)
        self._in_file = interp.sequence_number = line

    def skipping(self) -> bool:
        """Tell whether the interpreter skips lines: a false if, or on the way to a sub."""
        self.interp.read("G1")
        return self.interp.blocks[0].motion_to_be == NO_MOTION
