# SPDX-License-Identifier: GPL-2.0-or-later
"""Prologs and epilog of the cycles: a block is checked, and its motion handed to the NGC sub."""

from __future__ import annotations

from collections.abc import Callable

from interpreter import INTERP_OK

from g12.cycles import circle_mill, mitsubishi, yasnac
from g12.cycles.bore import plan_bore
from g12.cycles.frame import plan_frame
from g12.cycles.haas import plan_pocket
from g12.cycles.plan import CyclePlan, PocketEntry
from g12.cycles.thread import plan_thread
from g12.host import borrowed, messages, reported
from g12.host.call_frame import set_locals_at
from g12.host.handlers import cycle_state
from g12.host.interp import PER_REVOLUTION, Interp
from g12.host.machine import MACHINE
from g12.request.common import CLOCKWISE, COUNTERCLOCKWISE
from g12.request.words import Words

PERIMETER, POCKET = False, True


def check_at_start() -> None:
    MACHINE.read("settings", "travel")


def hand_over(interp: Interp, words: Words, plan: CyclePlan, **more: float) -> int:
    """Set the locals of a plan that stays in the travel; show the operator its messages.

    That of another cutter is shown once for each program and tool. A form has the block refused
    where a program would be told.
    """
    if cycle_state.is_strict(interp) and plan.message:
        raise words.refuse(plan.message.removeprefix(f"{words.code}: "))
    cycle_state.stay_within_limits(interp, words, plan.extent)
    set_locals_at(interp, interp.call_level, {**plan.locals, **more})
    borrowed.begin(interp)
    tool = words.context.spindle_tool
    if plan.other_cutter and tool:
        messages.message_once(interp, tool.number, plan.other_cutter)
    if plan.commanded_cutter:
        cycle_state.remember_cutter(interp, plan.commanded_cutter)
    if plan.kept_cutter:
        messages.message_once(interp, plan.kept_cutter, plan.kept_cutter)
    if plan.commanded_planes:
        cycle_state.remember_planes(interp, plan.commanded_planes)
    if plan.message:
        messages.message(plan.message)
    reported.begin_cut(interp, words, plan.cut)
    return INTERP_OK


def entry_of_machine() -> PocketEntry:
    settings = MACHINE.settings
    return PocketEntry(settings.entry == "helix", settings.entry_angle, settings.plunge_feed)


def prepare_haas(interp: Interp, arc: int) -> int:
    words = cycle_state.words_of_block(interp)
    plan = plan_pocket(words, MACHINE.settings.clearing, entry_of_machine())
    hand = 1 if arc == COUNTERCLOCKWISE else -1
    return hand_over(interp, words, plan, arc=arc, hand=hand)


def prepare_yasnac(interp: Interp, arc: int) -> int:
    words = cycle_state.words_of_block(interp)
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
    words = cycle_state.words_of_block(interp)
    return hand_over(interp, words, mitsubishi.plan_circle(words), arc=arc)


def prepare_circle_mill(interp: Interp, pocket: bool) -> int:
    """Check the event of a code block, or of the call if the code is in o<circle_mill>."""
    words, planes = cycle_state.words_of_block(interp), cycle_state.event_planes(interp)
    entries = cycle_state.entries_of_sub(interp, "circle_mill", len(circle_mill.EVENT_ENTRIES))
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
    words = cycle_state.words_of_block(interp)
    return hand_over(interp, words, plan_bore(words, arc, MACHINE.settings.entry_angle))


def prepare_thread(interp: Interp, arc: int) -> int:
    words = cycle_state.words_of_block(interp)
    return hand_over(interp, words, plan_thread(words, arc))


def prepare_frame(interp: Interp, arc: int) -> int:
    words = cycle_state.words_of_block(interp)
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
    reported.end_cut(self)
    return INTERP_OK
