# SPDX-License-Identifier: GPL-2.0-or-later
"""The call frame of a remap handler that reads the following lines of the program itself.

To the interpreter such a handler is a sub: the caller's local parameters and loop labels are
hidden from the lines it reads, the line number starts at 0, and both are lost when it returns.
This module passes them in and back out, and lets the handler wait for the machine.
"""

from __future__ import annotations

from collections.abc import Iterator

from interpreter import INTERP_EXECUTE_FINISH

from g12.host.interp import Interp
from g12.section.block_rules import NO_CODE, GGroup

NO_O_WORD = 0  # o_type
_NAMES: dict[str, str] = {}  # never freed
NOT_CALLED, CALLED_AS_REMAP = 0, 4  # call_type


def interned(text: str) -> str:
    """Return a text that is never freed: the interpreter makes no copies of names."""
    return _NAMES.setdefault(text, text)


def locals_at(interp: Interp, level: int) -> dict[str, float]:
    """Return the local parameters of a call level; level 0 has the global ones too."""
    present, interp.call_level = interp.call_level, level
    params = interp.params
    values = {name: params[name] for name in params.locals() if name[0] != "_"}
    interp.call_level = present
    return values


def set_locals_at(interp: Interp, level: int, values: dict[str, float]) -> None:
    present, interp.call_level = interp.call_level, level
    params = interp.params
    for name, value in values.items():
        params[name] = value
    interp.call_level = present


class CallFrame:
    """The frame of the running handler, and of its caller, which is in the file ``home``."""

    def __init__(self, interp: Interp, home: str) -> None:
        self.interp, self.home = interp, home
        self.level, self.remap_level = interp.call_level, interp.remap_level
        block = interp.blocks[self.remap_level]
        self._remap, self._phase = block.executing_remap, block.phase
        self._interrupted = False  # by a wait: a sub that MDI called
        caller = interp.sub_context[self.level - 1]
        self.caller = interned(caller.subname or "")
        caller.filename = interned(home)  # it may still be that of an earlier call

    @property
    def is_current(self) -> bool:
        """Return whether the last line belongs to the handler's own call level, not to a sub."""
        return self.interp.call_level == self.level

    def enter(self) -> None:
        """Copy the caller's local parameters and labels to the handler's call level."""
        self.interp.sub_context[self.level].subname = self.caller
        self._entered_with = locals_at(self.interp, self.level - 1)
        set_locals_at(self.interp, self.level, self._entered_with)

    def leave(self, line: int) -> None:
        """Copy changed local parameters and the number of the last line back to the caller."""
        changed = locals_at(self.interp, self.level).items() - self._entered_with.items()
        set_locals_at(self.interp, self.level - 1, dict(changed))
        self._renumber(line)
        self.interp.sub_context[self.level - 1].sequence_number = line
        self.interp.sequence_number = line
        self.interp.mdi_interrupt = self._interrupted

    def unwind(self, line: int, *, called: bool, continue_at: int | None) -> None:
        """Set the line that LinuxCNC reports, and the byte at which the program continues.

        `Interp::unwind_call` (rs274ngc_pre.cc) takes both from the frames. The line is that of the
        main program: for a file that the section calls (``called``), or a section in another file,
        it is the calling line.
        """
        interp, frames = self.interp, self.interp.sub_context
        position = frames[self.level].position if continue_at is None else continue_at
        frames[self.level - 1].position = position
        if called:
            line = frames[self.level].sequence_number
        if frames[0].filename != self.home:
            line = frames[0].sequence_number
        for level in range(self.level):
            frames[level].sequence_number = line
        interp.sequence_number = line
        interp.blocks[self.remap_level].executing_remap = None
        interp.call_level = self.level  # a failed read has already unwound to the caller

    def execute_and_wait(self, text: str) -> Iterator[int]:
        """Execute a block, and yield until the machine has done what it waits for.

        The block may be in a sub of the section. No line may be read between it and the yield:
        the interpreter would take the input at once (`read_inputs`).

        LinuxCNC continues after the wait with block 0. Only if that is the call of a remap, at the
        level where the handler was called, `Interp::_read` (rs274ngc_pre.cc) reads no new line and
        `Interp::execute_call` (interp_o_word.cc) resumes the handler. Else milltask crashes. After
        the wait the block's mark has to be removed, or the next line would not be read either.
        (Without it: `test_waiting_for_an_input` in tests/sim/test_polar.py.)

        In a sub that MDI has called, `Interp::_execute` marks the wait with ``mdi_interrupt``, to
        read on in the sub after it. It would do so after each block executed here, so the mark is
        saved until the handler waits again or ends. (Without it: `test_in_mdi` in
        tests/sim/test_shapes.py, with kinematics.)
        """
        self._mark()
        if self.interp.execute(text):
            yield from self._wait()
        self._unmark()

    def let_linuxcnc_in(self) -> Iterator[int]:
        """Yield until all that is queued is done: only then does LinuxCNC obey an abort."""
        self._mark()
        yield from self._wait()
        self._unmark()

    def _mark(self) -> None:
        self.interp.read(f"O <{self._remap.remap_py}> call")
        self.interp.blocks[0].call_type = CALLED_AS_REMAP

    def _wait(self) -> Iterator[int]:
        interp = self.interp
        level, remap_level = interp.call_level, interp.remap_level
        interp.call_level, interp.remap_level = self.level, self.remap_level
        interp.mdi_interrupt = self._interrupted
        yield INTERP_EXECUTE_FINISH
        self._interrupted, interp.mdi_interrupt = interp.mdi_interrupt, False
        interp.call_level, interp.remap_level = level, remap_level

    def _unmark(self) -> None:
        self.interp.blocks[0].o_type, self.interp.blocks[0].call_type = NO_O_WORD, NOT_CALLED

    def _renumber(self, line: int) -> None:
        """Make the remapped block end on ``line``.

        A remapped block remembers the line where it was found (``saved_line_number``), and
        `Interp::leave_remap` (rs274ngc_pre.cc) goes back to it. Only `Interp::enter_remap` writes
        it, and for Python only execute with a line number calls that (`wrap_interp_execute_2` in
        interpmodule.cc), here from one level lower and with nothing to execute. It makes the
        remapped block of block 0, so the code is read again before. Then the block gets its line
        back, and its motion code is marked as done, or `Interp::remap_finished` would begin it.
        (Without it `test_line_numbers_inside_and_behind` fails; without the last two lines
        any section.)
        """
        interp, level = self.interp, self.remap_level
        interp.read(self._remap.name)
        interp.remap_level = level - 1
        interp.sequence_number = line
        interp.execute("", line)
        interp.remap_level = level
        block = interp.blocks[level]
        block.executing_remap, block.phase = self._remap, self._phase
        block.motion_to_be = block.g_modes[GGroup.MOTION] = NO_CODE


def run_code(interp: Interp, block: str) -> None:
    """Execute a block whose code may be remapped to a sub, with the sub's lines.

    `Interp::_execute` (rs274ngc_pre.cc) does so itself for a block typed in MDI, but then goes on
    until all calls have returned, the handler's own too.
    """
    level = interp.call_level
    interp.read(block)
    interp.execute(None)
    while interp.call_level > level:
        interp.read(None)
        interp.execute(None)
