# SPDX-License-Identifier: GPL-2.0-or-later
"""Prologs and epilog of the cycles: a block is checked, and its motion handed to the NGC sub."""

from __future__ import annotations

from collections.abc import Callable

from interpreter import INTERP_OK

from g12.cycles import circle_mill, mitsubishi, yasnac
from g12.cycles.haas import plan_pocket
from g12.host import messages
from g12.host.handlers import cycle_state
from g12.host.interp import Interp
from g12.host.machine import MACHINE
from g12.request.common import CLOCKWISE, COUNTERCLOCKWISE, other_cutter
from g12.request.words import Words

ARCS = CLOCKWISE, COUNTERCLOCKWISE  # of G12 and G13


def check_at_start() -> None:
    MACHINE.read("settings", "travel")


def prepare_haas(interp: Interp, arc: int) -> int:
    words, context = cycle_state.words_of_block(interp), cycle_state.snapshot(interp)
    other = other_cutter(words.code, words.value("D"), context, context.last_radius)
    clearing, entry = MACHINE.settings.clearing, cycle_state.pocket_entry()
    pocket = plan_pocket(words, context, clearing, entry)
    cycle_state.stay_within_limits(interp, words, pocket.extent())
    hand = 1 if arc == COUNTERCLOCKWISE else -1
    cycle_state.hand_over(interp, **pocket.locals(), arc=arc, hand=hand)
    cycle_state.report_other_cutter(interp, context, other)
    if pocket.commanded_radius is not None:
        cycle_state.remember_radius(interp, pocket.commanded_radius)
    if pocket.message:
        messages.message(pocket.message)
    return INTERP_OK


def prepare_yasnac(interp: Interp, arc: int) -> int:
    words, context = cycle_state.words_of_block(interp), cycle_state.snapshot(interp)
    other = other_cutter(words.code, words.value("D"), context)
    circle = yasnac.plan_circle(words, context)
    cycle_state.stay_within_limits(interp, words, circle.extent(context.z))
    cycle_state.report_other_cutter(interp, context, other)
    cycle_state.hand_over(
        interp,
        **circle._asdict(),
        arc=arc,
        traverse=cycle_state.traverse_feed(interp),
        feed=interp.feed_rate,
        per_revolution=cycle_state.per_revolution(interp),
    )
    return INTERP_OK


def prepare_mitsubishi(interp: Interp, arc: int) -> int:
    words, context = cycle_state.words_of_block(interp), cycle_state.snapshot(interp)
    other = other_cutter(words.code, words.value("D"), context)
    circle = mitsubishi.plan_circle(words, context)
    cycle_state.stay_within_limits(interp, words, circle.extent(context))
    cycle_state.report_other_cutter(interp, context, other)
    cycle_state.hand_over(interp, **circle._asdict(), arc=arc)
    return INTERP_OK


def planned_event(interp: Interp, pocket: bool) -> circle_mill.MillEvent:
    """Return the event of a code block, or of the call if the code is in o<circle_mill>."""
    words, context = cycle_state.words_of_block(interp), cycle_state.snapshot(interp)
    plane = cycle_state.first_plane(interp)
    entries = cycle_state.entries_of_sub(interp, "circle_mill", len(circle_mill.EVENT_ENTRIES))
    if entries is None:
        event = circle_mill.plan_code(words, context, plane, pocket)
    else:
        words.check_known("no words inside o<circle_mill>")
        words = Words("circle_mill", circle_mill.entries_by_letter(entries))
        event = circle_mill.plan_call(words, context, plane)
    cycle_state.stay_within_limits(interp, words, event.extent())
    return event


def prepare_circle_mill(interp: Interp, pocket: bool) -> int:
    event = planned_event(interp, pocket)
    cycle_state.hand_over(interp, **event.locals())
    cycle_state.remember_first_plane(interp, event.position.first_plane)
    if event.message:
        messages.message(event.message)
    return INTERP_OK


def prolog(prepare: Callable[..., int], argument: int) -> Callable[..., int]:
    """Return the prolog of a code: ``prepare`` for its arc code, or its kind of event."""

    @messages.handler
    def prolog_of_code(self, **words):
        return prepare(self, argument)

    return prolog_of_code


g12_haas, g13_haas = (prolog(prepare_haas, arc) for arc in ARCS)
g12_yasnac, g13_yasnac = (prolog(prepare_yasnac, arc) for arc in ARCS)
g12_mitsubishi, g13_mitsubishi = (prolog(prepare_mitsubishi, arc) for arc in ARCS)
circle_mill_perimeter, circle_mill_pocket = (  # G12.2 and o<circle_mill> call, G13.2
    prolog(prepare_circle_mill, pocket) for pocket in (False, True)
)


@messages.handler
def cycle_done(self, **words):
    cycle_state.restore_modes(self)
    return INTERP_OK
