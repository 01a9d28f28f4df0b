# SPDX-License-Identifier: GPL-2.0-or-later
"""Prologs and epilog of the cycles: a block is checked, and its motion handed to the NGC sub."""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Callable
from math import inf
from typing import NamedTuple

from interpreter import INTERP_OK

from g12.cycles import circle_mill, mitsubishi, yasnac
from g12.cycles.bore import plan_bore
from g12.cycles.frame import plan_frame
from g12.cycles.haas import plan_pocket
from g12.cycles.plan import CyclePlan, EventPlanes, PocketEntry
from g12.cycles.thread import plan_thread
from g12.host import borrowed, messages
from g12.host.call_frame import set_locals_at
from g12.host.interp import (
    PER_REVOLUTION,
    Interp,
    ParsedBlock,
    kept,
    millimetres_per_unit,
    words_in,
)
from g12.host.machine import MACHINE
from g12.host.messages import code_of_block, in_mdi, main_program
from g12.host.state import read_state, tool_of_entry
from g12.lengths import ROUNDING_MM
from g12.request import CLOCKWISE, COUNTERCLOCKWISE, CycleExtent, Words, check_travel
from g12.section.block_rules import NO_CODE, GGroup
from g12.state import State, Tool

PERIMETER, POCKET = False, True


def check_at_start() -> None:
    MACHINE.read("settings", "travel")


def hand_over(interp: Interp, words: Words, plan: CyclePlan, **more: float) -> int:
    """Set the locals of a plan that stays in the travel; show the operator its messages.

    That of another cutter is shown once for each program and tool. A form has the block refused
    where a program would be told.
    """
    if is_strict(interp) and plan.message:
        raise words.refuse(plan.message.removeprefix(f"{words.code}: "))
    stay_within_limits(interp, words, plan.extent)
    set_locals_at(interp, interp.call_level, {**plan.locals, **more})
    borrowed.begin(interp)
    tool = words.context.spindle_tool
    if plan.other_cutter and tool:
        messages.message_once(interp, tool.number, plan.other_cutter)
    if plan.commanded_cutter:
        remember_cutter(interp, plan.commanded_cutter)
    if plan.kept_cutter:
        messages.message_once(interp, plan.kept_cutter, plan.kept_cutter)
    if plan.commanded_planes:
        remember_planes(interp, plan.commanded_planes)
    if plan.message:
        messages.message(plan.message)
    messages.begin_cut(interp, words, plan.cut)
    return INTERP_OK


def entry_of_machine() -> PocketEntry:
    settings = MACHINE.settings
    return PocketEntry(settings.entry == "helix", settings.entry_angle, settings.plunge_feed)


def prepare_haas(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    plan = plan_pocket(words, MACHINE.settings.clearing, entry_of_machine())
    hand = 1 if arc == COUNTERCLOCKWISE else -1
    return hand_over(interp, words, plan, arc=arc, hand=hand)


def prepare_yasnac(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(
        interp,
        words,
        yasnac.plan_circle(words),
        arc=arc,
        traverse=MACHINE.settings.yasnac_traverse * words.context.machine_unit,
        feed=interp.feed_rate,
        per_revolution=interp.feed_mode == PER_REVOLUTION,
    )


def prepare_mitsubishi(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(interp, words, mitsubishi.plan_circle(words), arc=arc)


def prepare_circle_mill(interp: Interp, pocket: bool) -> int:
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


def prepare_bore(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(interp, words, plan_bore(words, arc, MACHINE.settings.entry_angle))


def prepare_thread(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(interp, words, plan_thread(words, arc))


def prepare_frame(interp: Interp, arc: int) -> int:
    words = words_of_block(interp)
    return hand_over(interp, words, plan_frame(words, arc, entry_of_machine()))


def prolog(prepare: Callable[..., int], which: int) -> Callable[..., int]:
    """Return the prolog of a code: it prepares the arc or the event that the code stands for."""

    @messages.handler
    def prolog_of_code(self, **words):
        messages.settle(self)
        return prepare(self, which)

    return prolog_of_code


g12_haas = prolog(prepare_haas, CLOCKWISE)
g13_haas = prolog(prepare_haas, COUNTERCLOCKWISE)
g12_yasnac = prolog(prepare_yasnac, CLOCKWISE)
g13_yasnac = prolog(prepare_yasnac, COUNTERCLOCKWISE)
g12_mitsubishi = prolog(prepare_mitsubishi, CLOCKWISE)
g13_mitsubishi = prolog(prepare_mitsubishi, COUNTERCLOCKWISE)
g12_bore = prolog(prepare_bore, CLOCKWISE)
g13_bore = prolog(prepare_bore, COUNTERCLOCKWISE)
g12_thread = prolog(prepare_thread, CLOCKWISE)
g13_thread = prolog(prepare_thread, COUNTERCLOCKWISE)
g12_frame = prolog(prepare_frame, CLOCKWISE)
g13_frame = prolog(prepare_frame, COUNTERCLOCKWISE)
circle_mill_perimeter = prolog(prepare_circle_mill, PERIMETER)  # G12.2, o<circle_mill> call
circle_mill_pocket = prolog(prepare_circle_mill, POCKET)  # G13.2


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
CYCLE_WORDS = "ABCDEHIJKLPQRUVWXYZ"


def words_of_block(interp: Interp) -> Words:
    """Return the words of the block being remapped, and the state before it.

    Refuses a second code that reads them.
    """
    block = interp.blocks[interp.remap_level]
    values = words_in(block, CYCLE_WORDS)
    if block.radius_flag:
        values["@"] = block.radius
    if block.theta_flag:
        values["^"] = block.theta
    words = Words(code_of_block(interp), values, snapshot(interp))
    other = code_reading_words(block, words)
    if other:
        raise words.refuse(f"{other} cannot be in the same block")
    return words


def code_reading_words(block: ParsedBlock, words: Words) -> str | None:
    """Return a code of the block that would read a word of the cycle too, or change its tool.

    (The interpreter knows the tool of M6 only after the block.)
    """
    g_modes = block.g_modes
    if g_modes[GGroup.NON_MODAL] != NO_CODE:
        return f"G{g_modes[GGroup.NON_MODAL] / 10:g}"
    for group, code, letters in READING_WORDS:
        if g_modes[group] == code and any(letter in words for letter in letters):
            return f"G{code / 10:g}"
    if block.m_count:
        for code in block.m_modes:
            if code not in HARMLESS_M:
                return f"M{code}"
    return None


def entries_of_sub(interp: Interp, sub: str, count: int) -> list[float] | None:
    """Return the entries of ``o<sub> call`` if the code is that sub's only block, else None.

    The frame of the remap is on top of the sub's; #1 to #30 are still the sub's in a prolog.
    """
    if interp.sub_context[interp.call_level - 1].subname != sub:
        return None
    return [interp.params[index] for index in range(1, count + 1)]


def tool_in_table(interp: Interp, tool_number: int) -> Tool | None:
    """Return the tool of that number from the tool table, None if it is not there.

    The table is in the order of the tool file; `find_tool_pocket` would return the pocket, which is
    another number. Entry 0 is the spindle, with a random tool changer the tool's only entry.
    """
    table = interp.tool_table
    for index in itertools.chain(range(1, len(table)), (0,)):
        entry = table[index]
        if entry.toolno == tool_number:
            return tool_of_entry(interp, entry)
    return None


def last_cutter(interp: Interp) -> Tool | None:
    """Return the cutter of the last D commanded, by a cycle or by G41/G42: tool 0.

    The interpreter's compensation radius remains after G40 and is converted by G20/G21. The cycles
    store their D there too: one register, as on the control.
    """
    commanded, unit = commanded_of(interp), millimetres_per_unit(interp)
    cutter, radius = commanded.cutter, interp.cutter_comp_radius * unit
    if cutter is None and radius <= 0.0:
        return None
    if cutter is None or abs(cutter.radius - radius) > ROUNDING_MM:
        cutter = commanded.cutter = Tool(0, radius)
    return Tool(cutter.number, interp.cutter_comp_radius)


def remember_cutter(interp: Interp, cutter: Tool) -> None:
    interp.cutter_comp_radius = cutter.radius
    in_mm = cutter._replace(radius=cutter.radius * millimetres_per_unit(interp))
    commanded_of(interp).remember_cutter(in_mm, place_of_block(interp))


def d_is_earlier(interp: Interp) -> bool:
    """Return whether the D last commanded, if any, is not this run's."""
    place = place_of_block(interp)
    return not commanded_of(interp).gives_d(place) and not compensates_above(place)


def event_planes(interp: Interp) -> EventPlanes:
    """Return the circle mill's reference planes as last commanded by this program.

    A plane of another program, or of the text before an edit, would send the tool to a height that
    this program does not contain.
    """
    planes = commanded_of(interp).planes_at(place_of_block(interp))
    return planes.scaled(1 / millimetres_per_unit(interp))


def remember_planes(interp: Interp, planes: EventPlanes) -> None:
    in_mm = planes.scaled(millimetres_per_unit(interp))
    commanded_of(interp).remember_planes(in_mm, place_of_block(interp))


def snapshot(interp: Interp) -> State:
    return read_state(interp)._replace(
        last_cutter=last_cutter(interp),
        d_is_earlier=functools.partial(d_is_earlier, interp),
        tool_in_table=functools.partial(tool_in_table, interp),
    )


def is_strict(interp: Interp) -> bool:
    """Return whether a form makes the block: its messages would be read too late."""
    frames = (interp.sub_context[level] for level in range(interp.call_level + 1))
    return any((frame.subname or "").startswith(FORM) for frame in frames)


def stay_within_limits(interp: Interp, words: Words, extent: CycleExtent) -> None:
    """Refuse a cycle that leaves the machine's travel.

    Not in a preview, which also shows programs before the work offset is set.
    """
    if interp.task:
        check_travel(words, extent, MACHINE.travel)


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

    @property
    def is_typed(self) -> bool:
        return not self.offsets

    def reaches(self, later: Place) -> bool:
        """Return whether a value commanded here is still in force there.

        In MDI that of the loaded program is, in a program none that was typed.
        """
        in_order = later.is_typed or () < self.offsets <= later.offsets
        return self.program == later.program and in_order


def place_of_block(interp: Interp) -> Place:
    """Return the place of the block being remapped."""
    if in_mdi(interp):
        return Place(main_program(interp), ())
    levels = range(interp.call_level - 1)  # the last frame is that of the remap
    calls = (interp.sub_context[level].position - 1 for level in levels)
    return Place(main_program(interp), (*calls, interp.blocks[interp.remap_level].offset))


class CommandedValues:
    """The commanded values of one interpreter, in mm.

    ``planes`` are the circle mill's reference planes, ``cutter`` is that of the last D, tool 0
    where G41 or G42 commanded it.
    """

    def __init__(self) -> None:
        self.planes = EventPlanes()
        self.cutter: Tool | None = None
        self._first: dict[tuple[str, bool], Place] = {}  # by value and whether it was typed

    def remember_planes(self, given: EventPlanes, place: Place) -> None:
        """Note the planes that a block gives."""
        for name, plane in given._asdict().items():
            if plane is not None:
                self.planes = self.planes._replace(**{name: plane})
                self._note(name, place)

    def planes_at(self, place: Place) -> EventPlanes:
        """Return those planes that a block above a place gives."""
        planes = self.planes._asdict().items()
        return EventPlanes(**{name: at for name, at in planes if self._stands_above(name, place)})

    def remember_cutter(self, cutter: Tool, place: Place) -> None:
        self.cutter = cutter
        self._note("D", place)

    def gives_d(self, place: Place) -> bool:
        """Return whether a cycle with D stands above a place."""
        return self._stands_above("D", place)

    def _note(self, name: str, place: Place) -> None:
        first = self._first.get((name, place.is_typed))
        if not first or not first.reaches(place):
            self._first[name, place.is_typed] = place

    def _stands_above(self, name: str, place: Place) -> bool:
        """Return whether the first block that commands a value stands above a place."""
        firsts = (self._first.get((name, typed)) for typed in (False, True))
        return any(first.reaches(place) for first in firsts if first)


def commanded_of(interp: Interp) -> CommandedValues:
    return kept(interp, CommandedValues)


def compensates_above(place: Place) -> bool:
    """Return whether the program switches G41 or G42 on above a place; subs are not searched."""
    if place.is_typed or not place.program:
        return False
    return first_compensation(*place.program) < place.offsets[0]


@functools.lru_cache(maxsize=8)
def first_compensation(filename: str, changed: int) -> float:
    """Return the byte in a file at which G41 or G42 first stands; inf if it has none."""
    with open(filename, "rb") as file:
        found = COMPENSATION.search(file.read())
    return found.end() if found else inf
