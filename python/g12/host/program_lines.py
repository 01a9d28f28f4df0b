# SPDX-License-Identifier: GPL-2.0-or-later
"""The program after the remapped block: its lines, read here and parsed by the interpreter.

Lines are passed to the interpreter's parser as strings, since it cannot read some of them as they
are. O-words are passed with their offset in the file, so that loops return to it. After a jump the
interpreter continues in its file. It is moved past the lines read here before it has to read its
file itself: after a return from a sub, or after the section.
"""

from __future__ import annotations

import functools
import os
from bisect import bisect_right
from itertools import accumulate
from typing import NamedTuple

from g12.host.interp import Interp
from g12.section.block_rules import NO_CODE

INTERP_OK = 0  # the module interpreter has it, which unit tests have not
NO_REPEATS = 0  # L of an M98
# O-words that always change the interpreter's position in its file
JUMPING = ("call", "endsub", "return")
SHORT_LINE = 200  # characters: every LinuxCNC reads longer lines than that
SKIPPED_OVER = "g12_skipped_over"  # ngc/g12_skipped_over.ngc


class ProgramFile(NamedTuple):
    """A program file: its lines, and the byte at which each begins."""

    filename: str
    lines: list[str]
    starts: list[int]


def read_source(filename: str) -> ProgramFile:
    """Return the lines of a program file."""
    status = os.stat(filename)
    return _read(filename, status.st_mtime_ns, status.st_size)


@functools.lru_cache(maxsize=2)  # the file of the last section, and one that it calls
def _read(filename: str, changed: int, size: int) -> ProgramFile:
    with open(filename, "rb") as file:
        source = file.read().removesuffix(b"\n")
    starts = list(accumulate((len(line) + 1 for line in source.split(b"\n")), initial=0))
    text = source.decode("utf-8", "replace").replace("\ufffd", "?")  # of the same length
    return ProgramFile(filename, text.split("\n"), starts)


class LineOfFile(int):
    """The number of a line in another file than the section's: ``3 of flat.ngc``.

    It is equal to no line of another file.
    """

    file: str

    def __new__(cls, line: int, file: str) -> LineOfFile:
        number = super().__new__(cls, line)
        number.file = file
        return number

    def __eq__(self, other: object) -> bool:
        return isinstance(other, LineOfFile) and (int(self), self.file) == (int(other), other.file)

    def __ne__(self, other: object) -> bool:  # that of int would compare the numbers alone
        return not self == other

    def __hash__(self) -> int:
        return hash((int(self), self.file))

    def __format__(self, spec: str) -> str:
        """Return the number and the file's name, shortened to leave room for the rule."""
        return f"{int(self)} of {self.file:.80}"


def line_at(filename: str, offset: int, *, own: bool) -> int | None:
    """Return the line at a byte of a file; it names the file if that is not the program's own."""
    try:
        with open(filename, "rb") as file:
            line = file.read(max(0, offset)).count(b"\n") + 1
    except OSError:  # an initial block of the INI is in no file
        return None
    return line if own else LineOfFile(line, os.path.basename(filename))


def running_file(interp: Interp) -> str:
    """Return the name of the file of the program that runs, in its subs too."""
    return interp.filename if interp.call_level < 2 else interp.sub_context[0].filename


def error_text(interp: Interp) -> str:
    """Return the interpreter's text of its last error; not all of them are UTF-8."""
    try:
        return interp.get_errormsg()
    except UnicodeDecodeError as error:
        return error.object.decode("utf-8", "replace")


class ProgramLines:
    """The lines that follow the block being remapped.

    ``line`` is the number of the line taken last, counted from 1 as an editor does; ``shown_line``
    is the same number for messages; it names the file if that is not the program's own.
    """

    def __init__(self, interp: Interp) -> None:
        self.interp = interp
        self.home = self.source = read_source(interp.filename)
        offset = interp.blocks[interp.remap_level].offset
        self.line = bisect_right(self.source.starts, offset, hi=len(self.source.lines))
        self._in_file = self.line  # the last line that the interpreter itself has read
        interp.sequence_number = self.line

    @property
    def shown_line(self) -> int:
        """The number of the line taken last, for the operator."""
        if self.source is self.home:
            return self.line
        return LineOfFile(self.line, os.path.basename(self.source.filename))

    @property
    def next_at_home(self) -> int | None:
        """The byte at which the next line begins; None in another file than the section's."""
        return self.home.starts[self.line] if self.source is self.home else None

    def take(self) -> str | None:
        """Return the next line and count it as read; None at the end of the file."""
        line, lines = self.line, self.source.lines
        if line == len(lines):
            return None
        self.line = line + 1
        return lines[line]

    def parse(self, text: str | None = None) -> None:
        """Let the interpreter parse the line taken, or ``text`` instead."""
        self.interp.sequence_number = self.line
        self.interp.read(self.source.lines[self.line - 1] if text is None else text)

    def parse_rewritten(self, text: str) -> None:
        """Let the interpreter parse the line taken, rewritten; refuse it if it is too long."""
        length = len(self.source.lines[self.line - 1])
        if length > SHORT_LINE:
            self.parse(" " * length)
        self.parse(text)

    def control(self, kind: str) -> int:
        """Let the interpreter execute the line taken, an O-word, and follow its jump.

        ``kind`` is the O-word's keyword. Returns the interpreter's status.
        """
        if kind == "call":
            self.catch_up()
        interp, line = self.interp, self.line
        self.parse()
        if kind == "call" and interp.blocks[0].l_number == NO_REPEATS:
            return INTERP_OK  # LinuxCNC 2.9 would count a level that nothing ends
        interp.blocks[0].offset = self.source.starts[line - 1]
        status = interp.execute(None)
        if kind in JUMPING or interp.sequence_number != line:
            self._locate()
        return status

    def call(self, text: str) -> int:
        """Let the interpreter execute a block that is remapped to a sub; return its status."""
        self.catch_up()
        self.interp.read(text)
        self.interp.blocks[0].offset = self.source.starts[self.line - 1]
        status = self.interp.execute(None)
        self._locate()
        return status

    def catch_up(self) -> None:
        """Move the interpreter to the line after the one taken.

        Only the return from a sub changes its position in a file: call an empty sub, and change its
        return position. `Interp::execute_call` (interp_o_word.cc) notes the position in the
        caller's frame, `Interp::execute_return` seeks it. A called sub is skipped to until its
        ``sub`` line is read (`Interp::control_back_to`), which here comes from a string. (Without
        it: `test_line_numbers_inside_and_behind`; `test_subs_of_the_same_file` does not end.) The
        return from it would set #<_value>, that of the program's last sub, to 0.
        """
        interp, line = self.interp, self.line
        if self._in_file != line:
            returned = interp.return_value, interp.value_returned
            interp.read(f"o<{SKIPPED_OVER}> call")
            interp.execute(None)
            interp.sub_context[interp.call_level - 1].position = self.source.starts[line]
            for keyword in ("sub", "endsub"):
                interp.read(f"o<{SKIPPED_OVER}> {keyword}")
                interp.execute(None)
            interp.return_value, interp.value_returned = returned
        self._in_file = interp.sequence_number = line

    def skipping(self) -> bool:
        """Return whether the interpreter skips lines, after a false if or before a called sub."""
        self.interp.read("G1")
        return self.interp.blocks[0].motion_to_be == NO_CODE

    def _locate(self) -> None:
        """Continue at the interpreter's position in its file."""
        interp = self.interp
        if interp.filename != self.source.filename:
            at_home = interp.filename == self.home.filename
            self.source = self.home if at_home else read_source(interp.filename)
        interp.read("")
        self.line = bisect_right(self.source.starts, interp.blocks[0].offset - 1)
        self._in_file = interp.sequence_number = self.line
