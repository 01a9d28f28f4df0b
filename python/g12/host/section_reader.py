# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks of a section: motion is collected as a contour, modes act, actions are queued.

A block without motion is queued in order between the moves; assignments act at once. While a
section is read, the interpreter's position and modes are set to the programmed ones, so that a
program reads them from #5420, #<_x> or #<_feed>.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from math import radians
from operator import attrgetter

import emccanon
from interpreter import MODE_ABSOLUTE, MODE_INCREMENTAL

from g12.compensation.contour import Contour, Start
from g12.errors import number
from g12.host import messages
from g12.host.interp import (
    PER_MINUTE,
    PER_REVOLUTION,
    WORD_FIELDS,
    Interp,
    ParsedBlock,
    position_of,
    set_position,
    words_in,
)
from g12.host.program_lines import ProgramLines, error_text
from g12.moves.setup import SectionKind
from g12.section import block_rules, effects
from g12.section.block_rules import NO_CODE, GGroup, SectionBlock
from g12.section.effects import Action, BlockEnd, SectionModes
from g12.section.line import BlockLocation, TextLine
from g12.settings import MOST_FEED

ALL_SPINDLES, MAIN_SPINDLE = -1, 0  # $
SECTION_MOTIONS = (block_rules.G0, block_rules.G1, block_rules.G2, block_rules.G3)
WITHOUT_COMPENSATION = 40

SECTION_WORDS, PLAIN_LETTERS = "XYZABCIJRKFSPQLE", "XYZABCIJR"
PLAIN_FIELDS = chain.from_iterable(WORD_FIELDS[letter] for letter in PLAIN_LETTERS)
plain_words = attrgetter(*WORD_FIELDS["F"], "motion_to_be", *PLAIN_FIELDS)


def block_of(parsed: ParsedBlock) -> SectionBlock:
    modes = tuple(parsed.g_modes), tuple(parsed.m_modes)
    return SectionBlock(*modes, parsed.motion_to_be, words_in(parsed, SECTION_WORDS))


class SectionReader:
    """Collects the blocks of one section, as the interpreter parsed them, in ``contour``."""

    def __init__(self, interp: Interp, kind: SectionKind, program: ProgramLines) -> None:
        self.interp, self.program = interp, program
        self.known, self.rules, self.start = kind.words, kind.rules, kind.start
        self.parsed = interp.blocks[0]
        state = kind.state
        self.modes = SectionModes(
            state.incremental, state.per_revolution, state.feed, state.speed, state.motion
        )
        self._spindle, self._speeds = state.spindle, list(state.speeds)
        known, rules = self.known, self.rules
        there = {axis: state.position(axis) for axis in known.axes}
        slide, turn, height = known.axes
        if known.turn_is_length:  # at the present angle, which is 0 in the plane
            there[turn] = 0.0
        scales = {"X": rules.x_scale, turn: rules.turn_scale}
        self._scales = [(letter, scales.get(letter, 1.0)) for letter in known.plane]
        self._position_scales = [(a, rules.turn_scale if a == turn else 1.0) for a in known.plane]
        first, second, level = (there[letter] * scale for letter, scale in self._position_scales)
        self.contour = Contour(
            first,
            second,
            level,
            code=kind.start.location.code,
            plane=known.plane,
            centre=known.centre_name,
            radius_tolerance=rules.radius_tolerance,
            start=Start(there[slide], radians(there[turn]), there[height]),
            beside=rules.beside,
        )
        self.exact_lines: set[int] = set()  # of G9
        self._moved = 0  # the line of the last move
        self._saved: dict[int, SectionModes] = {}  # by M70 and M73, at each call level
        self._restored_on_return: set[int] = set()
        self.remember_machine()

    @property
    def programmed(self) -> list[float]:
        """The programmed position in words of the plane's axes, X as a radius."""
        contour = self.contour
        there = contour.first, contour.second, contour.height
        return [value / scale for value, (_, scale) in zip(there, self._position_scales)]

    @property
    def location(self) -> BlockLocation:
        return BlockLocation(self.start.location.code, self.program.shown_line)

    def refuse_failed(self) -> Exception:
        """Return the refusal of a line that the interpreter could not read or execute."""
        return self.location.refuse(error_text(self.interp))

    def remember_machine(self) -> None:
        self._machine = position_of(self.interp, self.known.plane)
        self._modes_of_machine = self.modes

    def show_machine(self) -> None:
        set_position(self.interp, self._machine, self._machine.values())

    def restore(self) -> None:
        """Restore the interpreter's state as of the machine's last motion."""
        self.show_machine()
        self.set_modes(self._modes_of_machine)

    def deletes(self, line: TextLine) -> bool:
        return line.deletable and emccanon.GET_BLOCK_DELETE()

    def set_modes(self, modes: SectionModes) -> None:
        """Set the modes for the following blocks, also as the program reads them."""
        interp, self.modes = self.interp, modes
        interp.distance_mode = MODE_INCREMENTAL if modes.incremental else MODE_ABSOLUTE
        interp.feed_mode = PER_REVOLUTION if modes.per_revolution else PER_MINUTE
        interp.feed_rate = modes.feed
        interp.motion_mode = modes.motion

    def show_plane(self) -> None:
        """Set the interpreter's position to the programmed one."""
        set_position(self.interp, self.known.plane, self.programmed)

    def has_moved(self) -> bool:
        """Return whether the interpreter's position has changed since it was set."""
        return [*position_of(self.interp, self.known.plane).values()] != self.programmed

    def plain_line(self, raw: str) -> None:
        """Take a line of nothing but numbers after G1 to G3, F and the words of a move."""
        self.program.parse(raw)
        has_f, f, motion, *rest = plain_words(self.parsed)
        modes = self.modes
        if has_f or (motion != modes.motion and motion != NO_CODE):
            motion = modes.motion if motion == NO_CODE else motion
            self.set_modes(modes._replace(feed=f if has_f else modes.feed, motion=motion))
        flagged = zip(PLAIN_LETTERS, rest[::2], rest[1::2])
        words = {letter: value for letter, has, value in flagged if has}
        if words:
            self._separate()
            self._move(motion, words)

    def with_spindle(self, line: TextLine) -> TextLine:
        """Return a line with its $ word as a number: a parsed block does not show it."""
        if not line.spindle:
            return line
        self.interp.read(f"C{line.spindle[1:]}")
        return line._replace(spindle=f"${round(self.parsed.c_number)}")

    def set_parameters(self, line: TextLine) -> None:
        """Execute the assignments of a line; all values are computed before the first of them."""
        if line.assignments:
            self.interp.read(line.assignments)
            self.interp.execute(None)

    def set_state(self, line: TextLine, block: SectionBlock) -> None:
        """Set the modes of a block, and save or restore those it names."""
        code = block.m[block_rules.MGroup.MODAL_STATE]
        if code in block_rules.STATE_CODES:
            self._state_code(code)
        self.set_modes(effects.modes_after(self.modes, block, self._speed(line, block)))

    def _speed(self, line: TextLine, block: SectionBlock) -> float:
        """Return the commanded speed of the spindle that feeds per revolution refer to."""
        named, count = int(line.spindle[1:] or MAIN_SPINDLE), len(self._speeds)
        if not ALL_SPINDLES <= named < count:
            raise self.location.refuse(
                f"${named}: this machine has {count} spindle{'s' * (count > 1)}"
            )
        if "S" in block.words:
            for spindle in range(count) if named == ALL_SPINDLES else (named,):
                self._speeds[spindle] = block.words["S"]
        if block.g[GGroup.FEED] != NO_CODE:
            self._spindle = max(named, MAIN_SPINDLE)
        return self._speeds[self._spindle]

    def action(self, line: TextLine, block: SectionBlock) -> None:
        """Queue the block's actions besides motion."""
        self._mark(self.action_text(line, block))

    def action_text(self, line: TextLine, block: SectionBlock) -> str:
        """Return the block without its motion, after a trial parse by the interpreter.

        Between the moves a refusal would come too late.
        """
        text = effects.action_text(block, line)
        if text:
            self.interp.read(text)
        return text

    def move(self, line: TextLine, block: SectionBlock) -> None:
        """Add the block's motion and compensation, and queue the stop after it."""
        if line.exact_stop:
            self.exact_lines.add(self.program.shown_line)
        if block.moves:
            self._separate()
        if block.g[GGroup.COMPENSATION] != NO_CODE:
            self._compensate(block.g[GGroup.COMPENSATION] // 10)
        if block.moves:
            self._move(block.motion, block.words, line.relative)
        self._mark(effects.stop_text(block))

    def comment(self, line: TextLine) -> None:
        """Queue a comment, message or report, with the present values of its parameters."""
        self._mark(line.python)
        # the interpreter's parsed block has only the last comment of a line
        for comment in line.comments[-1:]:
            if "#" in comment:
                self.show_plane()
                self.interp.read("")  # updates #5420
            text = effects.comment_text(comment, self._parameter)
            modes = self.modes if effects.may_fail(comment) else None
            self.contour.mark(Action(self.program.shown_line, text, modes))

    def returned(self) -> None:
        """Restore the modes that an M73 saved in subs that have ended."""
        for level in sorted(self._restored_on_return, reverse=True):
            if level > self.interp.call_level:
                self._restore(level)
                self._restored_on_return.discard(level)

    def _mark(self, text: str, level: int | None = None) -> None:
        if text:
            self.contour.mark(Action(self.program.shown_line, text, self.modes, level))

    def _parameter(self, name: str) -> float | None:
        """Return a parameter by number or name, None if there is none."""
        params = self.interp.params
        if name.isdigit():
            return params[int(name)] if int(name) < len(params) else None
        try:
            return params[name]
        except RuntimeError:
            return None

    def _move(self, motion: int, words: Mapping[str, float], relative: str = "") -> None:
        """Add a line or an arc to the contour, with its words converted to the plane.

        ``relative`` are the axes whose value is an increment in any mode: of U, W, H.
        """
        known, incremental = self.known, self.known.plane if self.modes.incremental else relative
        if motion not in SECTION_MOTIONS:
            code = f"G{motion / 10:g}"
            raise self.location.refuse(f"{code} is active: the block needs G1, G2 or G3 of its own")
        contour, line = self.contour, self.program.shown_line
        here = contour.first, contour.second, contour.height
        first, second, height = (
            None
            if letter not in words
            else words[letter] * scale + at
            if letter in incremental
            else words[letter] * scale
            for (letter, scale), at in zip(self._scales, here)
        )
        i, j = (
            next((words[letter] for letter in letters if letter in words), None)
            for letters in known.centre
        )
        in_plane = any(word is not None for word in (first, second, i, j))
        if height is not None and in_plane and not self.rules.height_with_others:
            raise self.location.refuse(known.own_block)
        if block_rules.G1 < motion <= block_rules.G3:
            turn, r = 1 if motion == block_rules.G3 else -1, words.get("R")
            contour.arc(turn, first, second, height, i=i, j=j, radius=r, at=line, feed=self._feed())
        else:
            feed = self._feed() if motion else self._rapid_feed()
            contour.straight(first, second, height, at=line, feed=feed)

    def _separate(self) -> None:
        """Mark the end of a block before another on the same line, as in a loop."""
        line = self.program.shown_line
        if line == self._moved:
            self.contour.mark(BlockEnd(line))
        self._moved = line

    def _feed(self) -> float:
        """Return the feed along the path in program units per minute."""
        modes = self.modes
        if modes.feed > MOST_FEED:
            raise self.location.refuse(
                f"F{number(modes.feed)} is no feed: at most {number(MOST_FEED)}"
            )
        if not modes.per_revolution:
            return modes.feed
        if not modes.speed:
            raise self.location.refuse("feed per revolution (G95, G99) needs the spindle speed S")
        return modes.feed * modes.speed

    def _rapid_feed(self) -> float:
        feed = self.rules.rapid_feed
        if feed is None:
            raise self.location.refuse(f"G0 is refused (it is still active): {block_rules.RAPID}")
        return feed

    def _compensate(self, side: int) -> None:
        radius = 0.0 if side == WITHOUT_COMPENSATION else self._tool_radius(side)
        self.contour.compensate(side, radius, at=self.program.shown_line)

    def _tool_radius(self, side: int) -> float:
        """Return the loaded tool's radius; below 0 it is a correction to the other side."""
        tool = self.start.state.spindle_tool
        if tool is None:
            raise self.location.refuse(
                f"G{side} needs a tool in the spindle: its radius is compensated"
            )
        if tool.radius < 0.0:
            self._report_other_side(tool.radius)
        return tool.radius

    def _report_other_side(self, radius: float) -> None:
        """Show the operator, once a program, that a size correction is beyond the contour."""
        text = (
            f"{self.start.location.code}: the loaded tool has the negative diameter "
            f"{number(2 * radius)} in the tool table: G41 offsets the path by {number(-radius)} "
            "to the right, G42 to the left"
        )
        messages.message_once(self.interp, text, text)

    def _state_code(self, code: int) -> None:
        """Execute M70 to M73: here for the section's modes, between the moves for the machine's."""
        level = self.interp.call_level
        if code == block_rules.M_RESTORE:
            self._restore(level)
        elif code == block_rules.M_INVALIDATE:
            self._saved.pop(level, None)
            self._restored_on_return.discard(level)
            self._mark(f"M{block_rules.M_INVALIDATE}", level)
        else:
            self._saved[level] = self.modes
            if code == block_rules.M_AUTORESTORE and level > self.start.level:
                self._restored_on_return.add(level)
            self._mark(f"M{block_rules.M_SAVE}", level)

    def _restore(self, level: int) -> None:
        if level not in self._saved:
            raise self.location.refuse("M72: no modes were saved in this section")
        self._mark(f"M{block_rules.M_RESTORE}", level)
        self.set_modes(self._saved[level])
