# SPDX-License-Identifier: GPL-2.0-or-later
"""A section of polar coordinate interpolation: read to its end, planned as a whole, then moved.

The handler of G12.1 goes on reading the program itself (`program`). The interpreter parses every line and
obeys O-words and assignments at once; contour motion is collected, and what is no motion is kept for its
place between the moves. Behind G13.1 the contour is planned (`polar`) and handed over (`emission`).

While it reads, the interpreter is shown the programmed position in the plane, so that a program reads it
from #5420 or #<_x>; before anything moves it gets the machine's position back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import attrgetter
from typing import NamedTuple

import emccanon
from interpreter import MODE_ABSOLUTE, MODE_INCREMENTAL

from . import polar
from .emission import Action, Emission
from .errors import Refusal, number
from .frame import Frame
from .polar.block import (
    COMPENSATION,
    FORGET,
    G0,
    G1,
    G3,
    M2,
    M30,
    M_STATE,
    M_STOP,
    MOTION,
    NO_CODE,
    REASON_OF_G,
    RESTORE,
    SAVE,
    SAVE_FOR_SUB,
    STATE_CODES,
    Block,
    Line,
    Modes,
    Place,
    action_text,
    alone,
    check_block,
    check_letters,
    comment_text,
    is_plain,
    modes_after,
    split_line,
    stop_text,
)
from .polar.contour import Contour
from .program import MOVING, Program
from .travel import Travel

PER_MINUTE, PER_REVOLUTION = 0, 2  # feed_mode
WAITING_GROUP, WAIT_FOR_INPUT = 5, 66

WORDS = [
    (letter, f"{letter.lower()}_flag", f"{letter.lower()}_number") for letter in "XCZIJRFSPQLE"
]
plain_words = attrgetter(
    "f_flag", "f_number", "motion_to_be", *(name for word in WORDS[:6] for name in word[1:])
)


class Setup(NamedTuple):
    """What a section takes from the machine, its settings and the block that switched it on.

    Lengths and feeds are in program units. ``on`` and ``off`` are the codes as the parser numbers them,
    ``code`` and ``off_code`` as they are written. ``x_scale`` turns an X word into a radius value, and
    ``x_factor`` a radius value into the X word of a move. ``rapid_feed`` is None where G0 is refused.
    ``remapped`` tells of an M code whether it is remapped to a sub (True) or to Python (False).
    """

    code: str
    off_code: str
    on: int
    off: int
    diameter: bool
    x_scale: float
    x_factor: float
    z_with_x: bool
    rapid_feed: float | None
    closing: float
    blending: float
    plan: polar.Settings
    travel: Travel
    remapped: dict[int, bool]
    tool_radius: Callable[[], float | None]


class Section:
    """One section, from the block that switches on to the one that switches off."""

    def __init__(self, interp: object, setup: Setup, frame: Frame, program: Program) -> None:
        self.interp, self.setup, self.frame, self.program = interp, setup, frame, program
        self.block = interp.blocks[0]
        self.c = interp.CC_current
        self._remember_machine()
        self.modes = self._modes_found = Modes(
            incremental=interp.distance_mode == MODE_INCREMENTAL,
            per_revolution=interp.feed_mode == PER_REVOLUTION,
            feed=interp.feed_rate,
            speed=interp.speed[0],
            motion=interp.motion_mode,
        )
        self.contour = Contour(
            interp.current_x, interp.current_z, code=setup.code, diameter=setup.diameter,
            closing=setup.closing,
        )  # fmt: skip
        self.emission = Emission(
            interp,
            setup.code,
            x_factor=setup.x_factor,
            blending=setup.blending,
            absolute=MODE_ABSOLUTE,
        )
        self.saved: dict[int, Modes] = {}  # by M70 and M73, at each call level
        self.restored_on_return: set[int] = set()
        self.skipping = self.finished = False
        self.skipped_for = ""

    def run(self) -> Iterator[int]:
        """Read, plan and move the section; yield where the interpreter has to wait for the machine."""
        try:
            yield from self._read()
        except Refusal:
            self._show_machine()
            self._set_modes(self._modes_found)
            raise

    def _read(self) -> Iterator[int]:
        self.frame.enter()
        try:
            while not self.finished:
                yield from self._next_line()
        except SystemError:  # how LinuxCNC hands a failed read or execute to Python
            raise self.place.refuse(self.interp.get_errormsg()) from None

    @property
    def place(self) -> Place:
        """The line taken last."""
        return Place(self.setup.code, self.program.place)

    # Reading.

    def _next_line(self) -> Iterator[int]:
        raw = self.program.take()
        if raw is None:
            self._end_of_file()
        elif not is_plain(raw):
            yield from self._line(split_line(raw))
        elif not self.skipping:
            self._plain_line()

    def _plain_line(self) -> None:
        """A line of nothing but numbers behind G1 to G3, F and the words of a move."""
        self.program.parse()
        has_f, f, motion, has_x, x, has_c, c, has_z, z, has_i, i, has_j, j, has_r, r = plain_words(
            self.block
        )
        if has_f or motion not in (NO_CODE, self.modes.motion):
            modes = self.modes
            self._set_modes(
                modes._replace(
                    feed=f if has_f else modes.feed,
                    motion=modes.motion if motion == NO_CODE else motion,
                )
            )
        if has_x or has_c or has_z or has_i or has_j or has_r:
            self._move(
                motion, x if has_x else None, c if has_c else None, z if has_z else None,
                i if has_i else None, j if has_j else None, r if has_r else None,
            )  # fmt: skip

    def _line(self, line: Line) -> Iterator[int]:
        if line.deletable and emccanon.GET_BLOCK_DELETE():
            return
        if line.control:
            self._control(line)
        elif not self.skipping:
            self._comment(line)
            if not line.empty:
                yield from self._words(line)

    def _words(self, line: Line) -> Iterator[int]:
        if line.text == "%":
            self._end_of_file()
        check_letters(line, self.place)
        if "#" in line.text:
            self._show_plane()
        self.program.parse(line.text if line.rewritten else None)
        block = block_of(self.block)
        if block.g[MOTION] == self.setup.off:
            self._finish(block)
        else:
            self._check(block)
            yield from self._obey(line, block)

    def _control(self, line: Line) -> None:
        """Let the interpreter obey an O-word; it may go on elsewhere."""
        kind, level = line.control, self.interp.call_level
        if self.skipping and kind in MOVING:
            return
        if not self.skipping and level == self.frame.level:
            self._check_level(line)
        self._show_plane()
        self._check_done(self.program.control(kind))
        for left in sorted(self.restored_on_return, reverse=True):
            if left > self.interp.call_level:
                self._restore(left)
                self.restored_on_return.discard(left)
        self._see_skipping(line)

    def _see_skipping(self, line: Line) -> None:
        """Note whether the lines that follow are skipped, and what that began with."""
        skipping = self.program.skipping()
        if skipping and not self.skipping:
            self.skipped_for = line.text
        self.skipping = skipping

    def _check_level(self, line: Line) -> None:
        if line.control in ("endsub", "return"):
            self._missing_off(f"{line.control if 'o' in line.text else 'M99'} comes before it")
        if line.control == "sub":
            raise self.place.refuse("a sub cannot be defined inside the section")

    def _check_done(self, status: int) -> None:
        if status or (self.interp.current_x, self.interp.CC_current) != (
            self.contour.x,
            self.contour.c,
        ):
            raise self.place.refuse(
                "what is called here moves or waits by itself, outside the section"
            )

    def _end_of_file(self) -> None:
        if self.skipping:
            raise self.place.refuse(f"the program ends before what belongs to {self.skipped_for}")
        self._missing_off("the program ends before it")

    def _missing_off(self, what: str) -> None:
        raise self.place.refuse(f"{self.setup.off_code} is missing: {what}")

    # One block.

    def _check(self, block: Block) -> None:
        setup, place = self.setup, self.place
        if block.g[MOTION] == setup.on:
            raise place.refuse(f"{setup.code} is already on")
        if block.m[M_STOP] in (M2, M30):
            self._missing_off(f"M{block.m[M_STOP]} comes before it")
        check_block(block, setup.rapid_feed is not None, place)
        for code in block.m:
            if code in setup.remapped and not alone(block, code):
                raise place.refuse(
                    f"M{code} is remapped: inside a section it needs a block of its own"
                )

    def _obey(self, line: Line, block: Block) -> Iterator[int]:
        """A block, in the order in which the interpreter executes one."""
        if line.assignments:
            self.interp.read(line.assignments)
            self.interp.execute(None)
        state_code = block.m[M_STATE]
        if state_code in STATE_CODES:
            self._state_code(state_code)
        self._set_modes(modes_after(self.modes, block))
        yield from self._action(line, block)
        if line.exact_stop:
            self.emission.exact_lines.add(self.program.line)
        self._contour(line, block)
        self._mark(stop_text(block))

    def _action(self, line: Line, block: Block) -> Iterator[int]:
        text = action_text(block, line)
        if block.m[WAITING_GROUP] == WAIT_FOR_INPUT:
            yield from self._wait_for_input(text)
        elif any(self.setup.remapped.get(code) for code in block.m):
            self._call_remapped(line)
        else:
            self._mark(text)

    def _contour(self, line: Line, block: Block) -> None:
        side = block.g[COMPENSATION]
        if side != NO_CODE:
            self._compensate(side // 10)
        if block.moves:
            self._move(
                block.motion, *[block.words.get(letter) for letter in "XCZIJR"], line.relative
            )

    def _compensate(self, side: int) -> None:
        radius = self.setup.tool_radius()
        if radius is None:
            raise self.place.refuse(
                f"G{side} needs a tool in the spindle: its radius is compensated"
            )
        self.contour.compensation(side, radius, line=self.program.place)

    def _move(self, motion, x, c, z, i=None, j=None, r=None, relative="") -> None:
        """Add a move to the contour; the words are the program's, None where there is none."""
        contour, modes, line = self.contour, self.modes, self.program.place
        if x is not None:
            x *= self.setup.x_scale
            if modes.incremental or "X" in relative:
                x += contour.x
        if c is not None and (modes.incremental or "C" in relative):
            c += contour.c
        if z is not None:
            self._check_z(x, c, i, j)
            if modes.incremental:
                z += contour.z
        if G1 < motion <= G3:
            turn = 1 if motion == G3 else -1
            contour.arc(turn, x, c, z, i=i, j=j, radius=r, line=line, feed=self._feed())
        else:
            contour.line(x, c, z, line=line, feed=self._feed() if motion else self._rapid_feed())

    def _check_z(self, *others: float | None) -> None:
        if not self.setup.z_with_x and any(other is not None for other in others):
            raise self.place.refuse("Z needs a block of its own, or [G12] POLAR_Z = allow")

    def _feed(self) -> float:
        """The feed along the part in program units per minute."""
        modes = self.modes
        if not modes.per_revolution:
            return modes.feed
        if not modes.speed:
            raise self.place.refuse("feed per revolution (G95, G99) needs the spindle speed S")
        return modes.feed * modes.speed

    def _rapid_feed(self) -> float:
        feed = self.setup.rapid_feed
        if feed is None:
            raise self.place.refuse(f"G0 is refused: {REASON_OF_G[G0]}")
        return feed

    # What is no motion.

    def _mark(self, text: str) -> None:
        """Keep a block for its place between the moves."""
        if text:
            line = self.program.place
            self.contour.mark(Action(line, text, self.modes), line=line)

    def _comment(self, line: Line) -> None:
        """Keep a comment, message or report, with its parameters as they are now."""
        for comment in line.comments[-1:]:  # the interpreter knows only the last one of a line
            if "#" in comment:
                self._show_plane()
                self.interp.read("")  # which renews #5420
            text = comment_text(comment, self._parameter)
            self.contour.mark(Action(self.program.place, text, None), line=self.program.place)

    def _parameter(self, name: str) -> float | None:
        params = self.interp.params
        if name.isdigit():
            return params[int(name)] if int(name) < len(params) else None
        try:
            return params[name]
        except RuntimeError:
            return None

    def _state_code(self, code: int) -> None:
        """M70 to M73: the modes are restored here, what the machine does when the tool gets there."""
        level = self.interp.call_level
        if code == RESTORE:
            self._restore(level)
            return
        if code == FORGET:
            self.saved.pop(level, None)
            self.restored_on_return.discard(level)
        else:
            self.saved[level] = self.modes
        if code == SAVE_FOR_SUB and level > self.frame.level:
            self.restored_on_return.add(level)
        text = f"M{FORGET if code == FORGET else SAVE}"
        self.contour.mark(
            Action(self.program.place, text, self.modes, level), line=self.program.place
        )

    def _restore(self, level: int) -> None:
        if level not in self.saved:
            raise self.place.refuse("M72: no modes were saved in this section")
        action = Action(self.program.place, f"M{RESTORE}", self.modes, level)
        self.contour.mark(action, line=self.program.place)
        self._set_modes(self.saved[level])

    def _call_remapped(self, line: Line) -> None:
        """Let the interpreter call a sub for an M code: its lines are lines of the section."""
        self._show_plane()
        self._check_done(self.program.call(line.text))
        self._see_skipping(line)

    # Motion.

    def _wait_for_input(self, text: str) -> Iterator[int]:
        """M66: everything before it has to happen before the lines behind it can be read."""
        planned = self._emit()
        yield from self.frame.execute_and_wait(text)
        self._remember_machine()
        self.contour = polar.resume(self.contour, planned)

    def _finish(self, block: Block) -> None:
        """End the section at the block that switches off."""
        off = self.setup.off_code
        if not alone(block):
            raise self.place.refuse(f"{off} stands alone in its block")
        if self.interp.call_level != self.frame.level:
            self._missing_off("the sub called here has one, but not the code that it ends")
        self.contour.close(line=self.program.line)
        self._emit()
        self.program.catch_up()
        self.frame.leave(self.program.line)
        self.finished = True

    def _emit(self) -> polar.Plan:
        """Plan what was read, and hand it over; return the plan."""
        plan = polar.plan(self.contour, self.setup.plan, c=self.c)
        self._check_travel(plan)
        self._show_machine()
        self.emission.run(plan.steps, self.modes)
        self._remember_machine()
        self._modes_found = self.modes
        return plan

    def _check_travel(self, plan: polar.Plan) -> None:
        beyond = self.setup.travel.beyond(
            step for step in plan.steps if isinstance(step, polar.Run)
        )
        if beyond:
            hint = ": C and H are lengths here, not degrees" if beyond.axis == "X" else ""
            raise Refusal(
                f"{self.setup.code} line {beyond.line}: the {beyond.axis} axis would go to "
                f"{number(beyond.position)}, beyond its limit {number(beyond.limit)}{hint}"
            )

    def _set_modes(self, modes: Modes) -> None:
        """Let modes act on the lines that follow, and be what the program reads of them."""
        interp, self.modes = self.interp, modes
        interp.distance_mode = MODE_INCREMENTAL if modes.incremental else MODE_ABSOLUTE
        interp.feed_mode = PER_REVOLUTION if modes.per_revolution else PER_MINUTE
        interp.feed_rate = modes.feed
        interp.motion_mode = modes.motion

    def _show_plane(self) -> None:
        interp, contour = self.interp, self.contour
        interp.current_x, interp.current_z, interp.CC_current = contour.x, contour.z, contour.c

    def _show_machine(self) -> None:
        interp = self.interp
        interp.current_x, interp.current_z, interp.CC_current = self._machine

    def _remember_machine(self) -> None:
        interp = self.interp
        self._machine = interp.current_x, interp.current_z, interp.CC_current


def block_of(parsed: object) -> Block:
    """Return the interpreter's parsed block as plain data."""
    words = {
        letter: getattr(parsed, value) for letter, flag, value in WORDS if getattr(parsed, flag)
    }
    return Block(tuple(parsed.g_modes), tuple(parsed.m_modes), parsed.motion_to_be, words)
