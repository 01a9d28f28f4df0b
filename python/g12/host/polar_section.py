# SPDX-License-Identifier: GPL-2.0-or-later
"""A section of polar coordinate interpolation: read to its end, planned as a whole, then moved.

The handler of G12.1 goes on reading the program itself (`program`). The interpreter parses every
line and obeys O-words at once; what the other blocks do is collected (`collector`). Behind G13.1
the contour is planned (`polar`) and handed over (`emission`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import emccanon

from g12.errors import Refusal, number
from g12.host.call_frame import Frame
from g12.host.program_lines import MOVING, Program
from g12.host.section_output import Emission
from g12.host.section_reader import Collector, Rules, block_of
from g12.polar import plan as polar
from g12.polar.soft_limits import Travel
from g12.section.block_rules import (
    M2,
    M30,
    M_STOP,
    MOTION,
    WAIT_FOR_INPUT,
    Block,
    alone,
    check_block,
    check_letters,
)
from g12.section.line import Line, Place, is_plain, split_line
from g12.section.modes import action_text

WAITING_GROUP = 5
MOST_LINES = 1_000_000  # LinuxCNC is deaf to an abort while a section is read


class Setup(NamedTuple):
    """What a section takes from the machine, its settings and the block that switches it on.

    ``on`` and ``off`` are the codes as the parser numbers them, ``off_code`` is as written.
    ``c`` is where the C axis stands. ``remapped`` tells of an M code whether it is remapped to a
    sub (True) or to Python (False).
    """

    rules: Rules
    off_code: str
    on: int
    off: int
    c: float
    plan: polar.Settings
    travel: Travel
    remapped: dict[int, bool]


class Section:
    """One section, from the block that switches on to the one that switches off."""

    def __init__(
        self, interp: object, setup: Setup, frame: Frame, program: Program, emission: Emission
    ) -> None:
        self.interp, self.setup, self.frame = interp, setup, frame
        self.program, self.emission = program, emission
        self.blocks = Collector(interp, setup.rules, program)
        self._modes_found = self.blocks.modes
        self._remember_machine()
        self._skipping = self._finished = self._handing_over = False
        self._skipped_for = ""  # the O-word whose lines are skipped

    def run(self) -> Iterator[int]:
        """Read, plan and move the section; yield where LinuxCNC has to wait for the machine."""
        self.frame.enter()
        try:
            yield from self._read()
        except SystemError:  # how LinuxCNC hands a failed read or execute to Python
            self._put_back()
            raise self._place().refuse(self.interp.get_errormsg()) from None
        except Exception:
            self._put_back()
            raise

    def _read(self) -> Iterator[int]:
        program, plain_line = self.program, self.blocks.plain_line
        for _ in range(MOST_LINES):
            if self._finished:
                return
            raw = program.take()
            if raw is None:
                self._end_of_file()
            elif not is_plain(raw):
                yield from self._line(split_line(raw))
            elif not self._skipping:
                plain_line(raw)
        raise self._place().refuse(
            f"{MOST_LINES} lines were read and {self.setup.off_code} did not come: an endless loop?"
        )

    def _place(self) -> Place:
        return Place(self.setup.rules.code, self.program.place)

    def _line(self, line: Line) -> Iterator[int]:
        if line.deletable and emccanon.GET_BLOCK_DELETE():
            return
        if line.control:
            self._control(line)
        elif not self._skipping:
            self.blocks.comment(line)
            if not line.empty:
                yield from self._words(line)

    def _words(self, line: Line) -> Iterator[int]:
        if line.text == "%":
            self._end_of_file()
        check_letters(line, self._place())
        if "#" in line.text:
            self.blocks.show_plane()
        if line.rewritten:
            self.program.parse_rewritten(line.text)
        else:
            self.program.parse()
        block = block_of(self.blocks.parsed)
        if block.g[MOTION] == self.setup.off:
            self.blocks.set_parameters(line)
            self._finish(block)
        else:
            self._check(block)
            yield from self._obey(line, block)

    def _obey(self, line: Line, block: Block) -> Iterator[int]:
        """Let a block act, in the order in which the interpreter executes one."""
        blocks = self.blocks
        line = blocks.with_spindle(line)
        blocks.set_parameters(line)
        blocks.set_state(line, block)
        if block.m[WAITING_GROUP] == WAIT_FOR_INPUT:
            yield from self._wait_for_input(action_text(block, line))
        elif any(self.setup.remapped.get(code) for code in block.m):
            self._call_remapped(line)
        else:
            blocks.action(line, block)
        blocks.move(line, block)

    def _check(self, block: Block) -> None:
        setup, place = self.setup, self._place()
        if block.g[MOTION] == setup.on:
            raise place.refuse(f"{setup.rules.code} is already on")
        if block.m[M_STOP] in (M2, M30):
            raise self._missing_off(f"M{block.m[M_STOP]} comes before it")
        check_block(block, setup.rules.rapid_feed is not None, place)
        for code in block.m:
            if code in setup.remapped and not alone(block, code):
                raise place.refuse(
                    f"M{code} is remapped: inside a section it needs a block of its own"
                )

    # O-words.

    def _control(self, line: Line) -> None:
        """Let the interpreter obey an O-word; it may go on elsewhere."""
        if self._skipping and line.control in MOVING:
            return
        if not self._skipping and self.interp.call_level == self.frame.level:
            self._check_level(line)
        self.blocks.show_plane()
        self._check_done(self.program.control(line.control))
        self.blocks.returned()
        self._see_skipping(line)

    def _call_remapped(self, line: Line) -> None:
        """Let the interpreter call a sub for an M code: its lines are lines of the section."""
        self.blocks.show_plane()
        self._check_done(self.program.call(line.text))
        self._see_skipping(line)

    def _check_level(self, line: Line) -> None:
        if line.control in ("endsub", "return"):
            name = line.control if "o" in line.text else "M99"
            raise self._missing_off(f"{name} comes before it")
        if line.control == "sub":
            raise self._place().refuse("a sub cannot be defined inside the section")

    def _check_done(self, status: int) -> None:
        interp, contour = self.interp, self.blocks.contour
        stands = interp.current_x, interp.CC_current, interp.current_z
        if status or stands != (contour.x, contour.c, contour.z):
            raise self._place().refuse("what is called here moves or waits by itself")

    def _see_skipping(self, line: Line) -> None:
        """Note whether the lines that follow are skipped, and what that began with."""
        skipping = self.program.skipping()
        if skipping and not self._skipping:
            self._skipped_for = line.text
        self._skipping = skipping

    def _end_of_file(self) -> None:
        if self._skipping:
            reason = f"the program ends before what belongs to {self._skipped_for}"
            raise self._place().refuse(reason)
        raise self._missing_off("the program ends before it")

    def _missing_off(self, what: str) -> Refusal:
        return self._place().refuse(f"{self.setup.off_code} is missing: {what}")

    # Motion.

    def _wait_for_input(self, text: str) -> Iterator[int]:
        """Obey M66: all before it has to happen before the lines behind it can be read."""
        self.blocks.contour.wait(line=self.program.place)
        planned = self._emit()
        yield from self.frame.execute_and_wait(text)
        self._remember_machine()
        self.blocks.contour = polar.resume(self.blocks.contour, planned)

    def _finish(self, block: Block) -> None:
        """End the section at the block that switches off."""
        off = self.setup.off_code
        if not alone(block):
            raise self._place().refuse(f"{off} stands alone in its block")
        if self.interp.call_level != self.frame.level:
            raise self._missing_off("the sub called here has one, but not the code that it ends")
        self.blocks.contour.close(line=self.program.line)
        self._emit()
        self.program.catch_up()
        self.frame.leave(self.program.line)
        self._finished = True

    def _emit(self) -> polar.Plan:
        """Plan what was read, and hand it over; return the plan."""
        blocks = self.blocks
        plan = polar.plan(blocks.contour, self.setup.plan, c=self.setup.c)
        self._check_travel(plan)
        self._show_machine()
        self._handing_over = True
        self.emission.run(plan.steps, blocks.modes, blocks.exact_lines)
        self._handing_over = False
        self._remember_machine()
        self._modes_found = blocks.modes
        return plan

    def _check_travel(self, plan: polar.Plan) -> None:
        rules, beyond = self.setup.rules, self.setup.travel.beyond(plan.steps)
        if beyond:
            by_c = beyond.axis == "X" and self.program.has_letter(beyond.line, "CHY")
            raise Place(rules.code, beyond.line).refuse(
                f"the {beyond.axis} axis would go to {number(beyond.position)}"
                f"{' (radius)' * (beyond.axis == 'X' and rules.diameter)}, "
                f"beyond its limit {number(beyond.limit)}"
                f"{': C and H are lengths here, not degrees' * by_c}"
            )

    # The interpreter's own view of the machine.

    def _put_back(self) -> None:
        """Leave the interpreter as it was when the machine moved last.

        A block that fails between the moves finds, and leaves, what the program commanded so far.
        """
        if self._handing_over:
            return
        self._show_machine()
        self.blocks.set_modes(self._modes_found)

    def _show_machine(self) -> None:
        interp = self.interp
        interp.current_x, interp.current_z, interp.CC_current = self._machine

    def _remember_machine(self) -> None:
        interp = self.interp
        self._machine = interp.current_x, interp.current_z, interp.CC_current
