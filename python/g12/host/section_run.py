# SPDX-License-Identifier: GPL-2.0-or-later
"""A section of interpolation: read to its end, planned as a whole, then executed.

The handler of G12.1 or G7.1 reads the following lines itself (`ProgramLines`). The interpreter
parses every line and executes O-words at once; the other blocks are collected (`SectionReader`).
After the code that switches off, the contour is planned (`SectionKind.plan`) and executed
(`SectionOutput`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterator
from enum import Enum

from g12.compensation.contour import Contour, PlaneMove
from g12.errors import Refusal
from g12.host import borrowed, kinematics_switch, messages
from g12.host.call_frame import CallFrame
from g12.host.program_lines import JUMPING
from g12.host.section_output import SectionOutput
from g12.host.section_reader import SectionReader, block_of
from g12.moves.setup import SectionKind
from g12.moves.steps import SectionPlan
from g12.section import block_rules
from g12.section.block_rules import SectionBlock
from g12.section.effects import SectionCodes
from g12.section.line import TextLine, split_line

MOST_SECTION_LINES = 1_000_000
LONGEST_READING = 0.5  # s in which LinuxCNC obeys no abort, nor anything else
LINES_BETWEEN_LOOKS = 256  # at the clock


class Phase(Enum):
    """The phase of a section.

    While it skips, after a false if or before a called sub, only O-words count. While it moves, the
    interpreter's position is the machine's, in the modes commanded so far.
    """

    READING = "reading"
    SKIPPING = "skipping"
    MOVING = "moving"
    DONE = "done"


class Section:
    """One section, from the block that switches on to the one that switches off."""

    def __init__(
        self,
        kind: SectionKind,
        codes: SectionCodes,
        frame: CallFrame,
        reader: SectionReader,
        output: SectionOutput,
        *,
        first: str = "",
        report: Callable[[Contour], None] = lambda _: None,
    ) -> None:
        """``first`` is a block that acts as if it were the section's first line.

        ``report`` takes each contour before it is cut.
        """
        self.kind, self.codes = kind, codes
        self.frame, self.program = frame, reader.program
        self.reader, self.output = reader, output
        self._first, self._report = first, report
        self._phase = Phase.READING
        self._unended: Refusal | None = None  # of the O-word that skips lines, if they never end

    def run(self) -> Iterator[int]:
        """Read, plan and move the section; yield where LinuxCNC has to wait for the machine."""
        self.frame.enter()
        try:
            self._check_file()
            yield from self._read()
        except SystemError:  # how LinuxCNC hands a failed read or execute to Python
            refusal = self.reader.refuse_failed()
            self._undo()
            raise refusal from None
        except Exception:
            self._undo()
            raise

    def _check_file(self) -> None:
        """Refuse a file that has been changed since the interpreter opened it."""
        self.program.parse()
        if not self.codes.begins(block_of(self.reader.parsed)):
            raise self._refuse("the file has been changed while the program runs")

    def _undo(self) -> None:
        """Undo the changes of reading ahead, and all that is borrowed; executed motion stays."""
        interp = self.reader.interp
        try:
            if self._phase is not Phase.MOVING:
                self.reader.restore()
            borrowed.give_back(interp)
        finally:
            if self.output.on_face:
                kinematics_switch.leave(interp)

    def _read(self) -> Iterator[int]:
        program, plain_line = self.program, self.reader.plain_line
        known = self.kind.words
        is_plain = known.plain
        if self._first:
            self.program.parse_rewritten(self._first)
            first = split_line(self._first, known)
            yield from self._process(first, block_of(self.reader.parsed))
        due = time.monotonic() + LONGEST_READING
        for count in range(MOST_SECTION_LINES):
            if not count % LINES_BETWEEN_LOOKS and self._is_late(due):
                yield from self._pause()
                due = time.monotonic() + LONGEST_READING
            raw = program.take()
            if raw is None:
                self._end_of_file()
            elif not is_plain(raw):
                yield from self._line(split_line(raw, known))
                if self._phase is Phase.DONE:
                    return
            elif self._phase is Phase.READING:
                plain_line(raw)
        read = f"{MOST_SECTION_LINES} lines were read and {self.codes.off_code} did not come"
        raise self._refuse(f"{read}: an endless loop?")

    def _is_late(self, due: float) -> bool:
        """Tell whether LinuxCNC has to be let in, which is not possible while lines are skipped."""
        reading = self._phase is Phase.READING and self.reader.interp.task
        return bool(reading) and time.monotonic() > due

    def _pause(self) -> Iterator[int]:
        """Let LinuxCNC obey an abort; it sets position and modes to the machine's meanwhile."""
        yield from self.frame.let_linuxcnc_in()
        self.reader.set_modes(self.reader.modes)
        self.reader.show_plane()

    def _refuse(self, reason: str) -> Refusal:
        return self.reader.location.refuse(reason)

    def _line(self, line: TextLine) -> Iterator[int]:
        if self.reader.deletes(line):
            return
        if line.control:
            self._control(line)
        elif self._phase is Phase.READING:
            self.reader.comment(line)
            if not line.empty:
                yield from self._words(line)

    def _words(self, line: TextLine) -> Iterator[int]:
        if line.text == "%":
            self._end_of_file()
        location, known = self.reader.location, self.kind.words
        off = [code for letter, code in line.codes if letter == "G" and code in self.codes.off]
        if off and len(line.codes) > 1:
            raise self._refuse(f"G{off[0] / 10:g} must be alone in its block")
        block_rules.check_codes(line.codes, known, self._rapid_allowed, location)
        block_rules.check_letters(line, known, location)
        if "#" in line.text:
            self.reader.show_plane()
        if line.rewritten:
            self.program.parse_rewritten(line.text)
        else:
            self.program.parse()
        block = block_of(self.reader.parsed)
        if self.codes.ends(block):
            self.reader.set_parameters(line)
            yield from self._finish(line, block)
        else:
            self._check(block)
            yield from self._process(line, block)

    def _process(self, line: TextLine, block: SectionBlock) -> Iterator[int]:
        """Process a block in the order in which the interpreter executes one."""
        reader = self.reader
        line = reader.with_spindle(line)
        reader.set_parameters(line)
        reader.set_state(line, block)
        if block.m[block_rules.MGroup.INPUT_OUTPUT] == block_rules.WAIT_FOR_INPUT:
            yield from self._wait_for_input(reader.action_text(line, block))
        elif any(self.codes.remapped.get(code) for code in block.m):
            self._call_remapped(line)
        else:
            reader.action(line, block)
        reader.move(line, block)

    def _check(self, block: SectionBlock) -> None:
        codes, location = self.codes, self.reader.location
        if codes.begins(block):
            raise location.refuse(f"the section is already on: {codes.off_code} ends it")
        stop = block.m[block_rules.MGroup.STOP]
        if stop in (block_rules.M2, block_rules.M30):
            raise self._missing_off(f"M{stop} comes before it")
        block_rules.check_block(block, self.kind.words, self._rapid_allowed, location)
        for code in block.m:
            if code in codes.remapped and not block_rules.m_code_alone(block, code):
                raise location.refuse(
                    f"M{code} is remapped: inside a section it needs a block of its own"
                )

    @property
    def _rapid_allowed(self) -> bool:
        return self.kind.rules.rapid_feed is not None

    # O-words.

    def _control(self, line: TextLine) -> None:
        """Let the interpreter execute an O-word, which may jump."""
        if self._phase is Phase.SKIPPING and line.control in JUMPING:
            return
        if self._phase is Phase.READING and self.frame.is_current:
            self._check_level(line)
        block_rules.check_call(line.text, self.codes.off_code, self.reader.location)
        self.reader.show_plane()
        self._check_done(self.program.control(line.control))
        self.reader.returned()
        self._update_phase(line)

    def _call_remapped(self, line: TextLine) -> None:
        """Let the interpreter call a sub for an M code: its lines are lines of the section."""
        self.reader.show_plane()
        self._check_done(self.program.call(line.text))
        self._update_phase(line)

    def _check_level(self, line: TextLine) -> None:
        if line.control in ("endsub", "return"):
            name = line.control if "o" in line.text else "M99"
            raise self._missing_off(f"{name} comes before it")
        if line.control == "sub":
            raise self._refuse("a sub cannot be defined inside the section")

    def _check_done(self, status: int) -> None:
        if status or self.reader.has_moved():
            raise self._refuse("what is called here moves or waits by itself")

    def _update_phase(self, line: TextLine) -> None:
        """Note whether the following lines are skipped, and the O-word that skips them."""
        if not self.program.skipping():
            self._phase, self._unended = Phase.READING, None
        elif not self._unended:
            self._phase, self._unended = Phase.SKIPPING, self._refuse(block_rules.never_ended(line))

    def _end_of_file(self) -> None:
        raise self._unended or self._missing_off("the program ends before it")

    def _missing_off(self, what: str) -> Refusal:
        return self._refuse(f"{self.codes.off_code} is missing: {what}")

    # Motion.

    def _wait_for_input(self, text: str) -> Iterator[int]:
        """Execute M66: everything before it has to be done before the lines after it are read."""
        self.reader.contour.wait(at=self.program.shown_line)
        planned = yield from self._emit()
        yield from self.frame.execute_and_wait(text)
        self.reader.remember_machine()
        self.reader.contour = self.reader.contour.continued(planned.end)

    def _finish(self, line: TextLine, block: SectionBlock) -> Iterator[int]:
        """End the section at the block that switches off."""
        if line.relative or not block_rules.alone(block, self.codes.word):
            raise self._refuse(f"{self.codes.off_code} must be alone in its block")
        if not self.frame.is_current:
            raise self._missing_off("the sub called here has one, but not the code that it ends")
        self.reader.contour.close(at=self.program.line)
        yield from self._emit()
        self.program.catch_up()
        messages.end_cut(self.reader.interp)
        self.frame.leave(self.program.line)
        borrowed.forget(self.reader.interp)
        self._phase = Phase.DONE

    def _emit(self) -> Generator[int, None, SectionPlan]:
        reader = self.reader
        plan = self.kind.plan(reader.contour)
        self._check_travel(plan)
        for note in plan.notes:
            messages.message(note)
        reader.show_machine()
        self._phase = Phase.MOVING
        self._report(reader.contour)
        for waiting in self.output.run(plan.steps, reader.modes, reader.exact_lines):
            yield from self.frame.execute_and_wait(waiting)
        self._phase = Phase.READING
        reader.remember_machine()
        return plan

    def _check_travel(self, plan: SectionPlan) -> None:
        leaving = self.kind.beyond_travel(plan.steps)
        if leaving:
            line, beyond = leaving
            by_c = beyond.axis == "X" and self.kind.words.turn_is_length and self._is_by_c(line)
            raise self.reader.location._replace(line=line).refuse(
                f"{beyond.rule}{': C and H are lengths here, not degrees' * by_c}"
            )

    def _is_by_c(self, line: int) -> bool:
        """Return whether a move of a line ends farther along C than along X."""
        moves = (each for each in self.reader.contour.elements if isinstance(each, PlaneMove))
        return any(abs(move.end.imag) > abs(move.end.real) for move in moves if move.line == line)
