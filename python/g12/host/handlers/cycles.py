# SPDX-License-Identifier: GPL-2.0-or-later
"""Prologs and epilog of the cycles: a block is checked, and its motion handed to the NGC sub."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Container
from types import ModuleType
from typing import NamedTuple

from interpreter import INTERP_OK

from g12.cycles import bore, circle_mill, frame, haas, mitsubishi, thread, yasnac
from g12.cycles.plan import CyclePlan, EventPlanes
from g12.errors import Refusal
from g12.host import borrowed, messages
from g12.host.call_frame import set_locals_at
from g12.host.interp import Interp, ParsedBlock, kept, millimetres_per_unit, words_in
from g12.host.interp_state import read_state, tool_of_entry
from g12.host.machine import MACHINE
from g12.lengths import ROUNDING_MM
from g12.request import CLOCKWISE, COUNTERCLOCKWISE, WHOLE, Words
from g12.section.block_rules import NO_CODE, GGroup
from g12.state import Tool

PERIMETER, POCKET = False, True


def check_at_start() -> None:
    MACHINE.read("settings", "travel")


def hand_over(interp: Interp, words: Words, plan: CyclePlan) -> int:
    """Set the locals of a plan, take the modes to restore, and show the operator its messages.

    A form has the block refused where a program would be told.
    """
    if plan.message and is_strict(interp):
        raise Refusal(plan.message.removeprefix(f"{words.code}: "), words.code)
    set_locals_at(interp, interp.call_level, plan.locals)
    borrowed.begin(interp)
    remember(interp, plan, kept(interp, CommandedValues))
    if plan.message:
        messages.message(plan.message)
    messages.begin_cut(interp, words.code, words.given, plan.cut)
    return INTERP_OK


def prolog(run: Callable[..., int], *which: object) -> Callable[..., int]:
    """Return the prolog of a code; ``which`` are the cycle and the arc, or the event, it means."""

    @messages.handler
    def prolog_of_code(self, **words):
        messages.settle(self)
        return run(self, *which)

    return prolog_of_code


def run_cycle(interp: Interp, cycle: ModuleType, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(interp, words, cycle.plan(words, arc, MACHINE.settings))


def run_event(interp: Interp, pocket: bool) -> int:
    """Check the event of a code block, or of the call if the code is in o<circle_mill>."""
    words, planes = words_of_block(interp), event_planes(interp)
    entries = entries_of_sub(interp, "circle_mill", len(circle_mill.EVENT_ENTRIES))
    if entries is None:
        plan = circle_mill.plan_code(words, planes, pocket)
    else:
        words.check_known("no words inside o<circle_mill>")
        words = Words("circle_mill", circle_mill.entries_by_letter(entries), words.context)
        plan = circle_mill.plan_call(words, planes)
    status = hand_over(interp, words, plan)
    borrowed.renew(interp, borrowed.saved_modes(interp)._replace(feed=plan.locals["feed"]))
    return status


g12_haas = prolog(run_cycle, haas, CLOCKWISE)
g13_haas = prolog(run_cycle, haas, COUNTERCLOCKWISE)
g12_yasnac = prolog(run_cycle, yasnac, CLOCKWISE)
g13_yasnac = prolog(run_cycle, yasnac, COUNTERCLOCKWISE)
g12_mitsubishi = prolog(run_cycle, mitsubishi, CLOCKWISE)
g13_mitsubishi = prolog(run_cycle, mitsubishi, COUNTERCLOCKWISE)
g12_bore = prolog(run_cycle, bore, CLOCKWISE)
g13_bore = prolog(run_cycle, bore, COUNTERCLOCKWISE)
g12_thread = prolog(run_cycle, thread, CLOCKWISE)
g13_thread = prolog(run_cycle, thread, COUNTERCLOCKWISE)
g12_frame = prolog(run_cycle, frame, CLOCKWISE)
g13_frame = prolog(run_cycle, frame, COUNTERCLOCKWISE)
circle_mill_perimeter = prolog(run_event, PERIMETER)  # G12.2, o<circle_mill> call
circle_mill_pocket = prolog(run_event, POCKET)  # G13.2


@messages.handler
def cycle_done(self, **words):
    borrowed.give_back(self)
    messages.end_cut(self)
    return INTERP_OK


READING_WORDS = (  # codes that read words of a cycle's block
    (GGroup.TOOL_LENGTH, 430, "H"),
    (GGroup.TOOL_LENGTH, 431, "XYZABCUVW"),
    (GGroup.TOOL_LENGTH, 432, "HXYZABCUVW"),
    (GGroup.PATH_CONTROL, 640, "PQ"),
    (GGroup.SPINDLE, 960, "D"),
)
# M codes that neither read words of the block nor change the tool
HARMLESS_M = (NO_CODE, 0, 1, 2, 3, 4, 5, 7, 8, 9, 30, 48, 49, 60)

FORM = "form_"  # begins the name of a form's sub
# every word that a block can have but F, S, T, N, M and O, which the interpreter processes itself
CYCLE_WORDS = "ABCDEHIJKLPQRUVWXYZ@^"


def words_of_block(interp: Interp) -> Words:
    """Return the words of the block being remapped, and the state before it.

    Refuses a second code that reads them. In a preview the axes have no limits: it also shows
    programs before the work offset is set.
    """
    commanded, block = kept(interp, CommandedValues), interp.blocks[interp.remap_level]
    values, state = words_in(block, CYCLE_WORDS), read_state(interp)
    last = last_cutter(interp, commanded)
    usual = last or state.spindle_tool
    state = state._replace(
        last_cutter=last,
        d_is_earlier=functools.partial(d_is_earlier, interp, commanded),
        tools=tools_in_table(interp, values.get("D", usual.number if usual else 0)),
        travel=MACHINE.travel if interp.task else None,
    )
    other = code_reading_words(block, values)
    words = Words(messages.code_of_block(interp), values, state)
    if other:
        raise words.refuse(f"{other} cannot be in the same block")
    return words


def code_reading_words(block: ParsedBlock, words: Container[str]) -> str | None:
    """Return a code of the block that would read a word of the cycle too, or change its tool.

    (The interpreter knows the tool of M6 only after the block.)
    """
    g_modes = block.g_modes
    if g_modes[GGroup.NON_MODAL] != NO_CODE:
        return f"G{g_modes[GGroup.NON_MODAL] / 10:g}"
    for group, code, letters in READING_WORDS:
        if g_modes[group] == code and any(letter in words for letter in letters):
            return f"G{code / 10:g}"
    m_codes = block.m_modes if block.m_count else ()
    return next((f"M{code}" for code in m_codes if code not in HARMLESS_M), None)


def entries_of_sub(interp: Interp, sub: str, count: int) -> list[float] | None:
    """Return the entries of ``o<sub> call`` if the code is that sub's only block, else None.

    The frame of the remap is on top of the sub's; #1 to #30 are still the sub's in a prolog.
    """
    if interp.sub_context[interp.call_level - 1].subname != sub:
        return None
    return [interp.params[index] for index in range(1, count + 1)]


def is_strict(interp: Interp) -> bool:
    """Return whether a form makes the block: its messages would be read too late."""
    frames = (interp.sub_context[level] for level in range(interp.call_level + 1))
    return any((frame.subname or "").startswith(FORM) for frame in frames)


def tools_in_table(interp: Interp, number: float) -> dict[int, Tool]:
    """Return the tool of that number, if the tool table has it and it is not 0.

    The table is in the order of the tool file; `find_tool_pocket` would return the pocket, which is
    another number. Entry 0 is the spindle, with a random tool changer the tool's only entry.
    """
    table = interp.tool_table
    entries = (table[index] for index in (*range(1, len(table)), 0) if number)
    entry = next((entry for entry in entries if abs(entry.toolno - number) < WHOLE), None)
    return {entry.toolno: tool_of_entry(interp, entry)} if entry else {}


def last_cutter(interp: Interp, commanded: CommandedValues) -> Tool | None:
    """Return the cutter of the last D commanded, by a cycle or by G41/G42: tool 0.

    The interpreter's compensation radius remains after G40 and is converted by G20/G21. The cycles
    store their D there too: one register, as on the control.
    """
    radius = interp.cutter_comp_radius
    in_mm = radius * millimetres_per_unit(interp)
    if abs(commanded.radius - in_mm) > ROUNDING_MM:
        commanded.radius, commanded.tool_number = in_mm, 0
    return Tool(commanded.tool_number, radius) if commanded.gives_d or in_mm > 0.0 else None


def d_is_earlier(interp: Interp, commanded: CommandedValues) -> bool:
    """Return whether the D last commanded, if any, is not this run's."""
    place = place_of_block(interp)
    return not commanded.stands_above("D", place) and not compensates_above(place)


# What a cycle commands for later blocks of the program, and where it did so. LinuxCNC tells no
# handler that a program begins. The place in the text tells it: a value that was commanded further
# down is an earlier run's, or that of a loop's last turn.

COMPENSATION = re.compile(rb"^(?:[^(;\n]|\([^)\n]*\))*?[gG][ \t]*4[12](?!\d)", re.MULTILINE)


class Place(NamedTuple):
    """A block's place: the program's file with its time of change, and the bytes above the block.

    ``offsets`` are those of the blocks that call, from the program down, and of the block itself;
    none of a block typed in MDI, which belongs to the loaded program.
    """

    program: tuple[str, int] | None
    offsets: tuple[int, ...]

    def reaches(self, later: Place) -> bool:
        """Return whether a value commanded here is still in force there.

        In MDI that of the loaded program is, in a program none that was typed.
        """
        in_order = not later.offsets or () < self.offsets <= later.offsets
        return self.program == later.program and in_order


def place_of_block(interp: Interp) -> Place:
    """Return the place of the block being remapped."""
    program = messages.main_program(interp)
    if messages.in_mdi(interp):
        return Place(program, ())
    levels = range(interp.call_level - 1)  # the last frame is that of the remap
    calls = (interp.sub_context[level].position - 1 for level in levels)
    return Place(program, (*calls, interp.blocks[interp.remap_level].offset))


class CommandedValues:
    """What the blocks of one interpreter have commanded for later ones, in mm.

    ``planes`` are the circle mill's reference planes by name. ``radius`` and ``tool_number`` are
    those of the last D, the number 0 where G41 or G42 commanded it.
    """

    def __init__(self) -> None:
        self.planes: dict[str, float] = {}
        self.radius, self.tool_number = 0.0, 0
        self._first: dict[tuple[str, bool], Place] = {}  # by value and whether it was typed

    def note(self, name: str, place: Place) -> None:
        """Note where a value has been commanded: the first such block of a run counts."""
        first = self._first.get((name, not place.offsets))
        if not first or not first.reaches(place):
            self._first[name, not place.offsets] = place

    def stands_above(self, name: str, place: Place) -> bool:
        """Return whether the first block that commands a value stands above a place."""
        firsts = (self._first.get((name, typed)) for typed in (False, True))
        return any(first.reaches(place) for first in firsts if first)

    @property
    def gives_d(self) -> bool:
        """Whether a cycle has commanded a D, which may be D0."""
        return any(name == "D" for name, _ in self._first)


def remember(interp: Interp, plan: CyclePlan, commanded: CommandedValues) -> None:
    """Note what a plan commands for later blocks; show, once a program, how its D differs."""
    place, unit, cutter = place_of_block(interp), millimetres_per_unit(interp), plan.cutter
    for name, plane in plan.planes._asdict().items():
        if plane is not None:
            commanded.planes[name] = plane * unit
            commanded.note(name, place)
    if not cutter:
        return
    if cutter.is_modal:
        interp.cutter_comp_radius = cutter.radius
        commanded.radius, commanded.tool_number = cutter.radius * unit, cutter.used.number
        commanded.note("D", place)
    for key, text in ((interp.tool_table[0].toolno, cutter.other), (cutter.kept, cutter.kept)):
        if text:
            messages.message_once(interp, key, text)


def event_planes(interp: Interp) -> EventPlanes:
    """Return the circle mill's reference planes as last commanded by this program.

    A plane of another program, or of the text before an edit, would send the tool to a height that
    this program does not contain.
    """
    commanded, place = kept(interp, CommandedValues), place_of_block(interp)
    unit = millimetres_per_unit(interp)
    planes = commanded.planes.items()
    return EventPlanes(
        **{name: at / unit for name, at in planes if commanded.stands_above(name, place)}
    )


def compensates_above(place: Place) -> bool:
    """Return whether the program switches G41 or G42 on above a place; subs are not searched."""
    if not place.offsets or not place.program:
        return False
    return first_compensation(*place.program) < place.offsets[0]


@functools.lru_cache(maxsize=8)
def first_compensation(filename: str, changed: int) -> float:
    """Return the byte in a file at which G41 or G42 first stands; inf if it has none."""
    with open(filename, "rb") as file:
        found = COMPENSATION.search(file.read())
    return found.end() if found else math.inf
