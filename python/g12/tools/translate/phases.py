# SPDX-License-Identifier: GPL-2.0-or-later
"""The phases in which a block is translated, in their order.

A phase takes the block's `Draft` as the one before it has left it: words, modes, and the codes
whose meaning a later phase deals with (``draft.meanings``). Its rules rewrite words or lines, carry
the modes on, or refuse; a rule that deals with a code takes it out. After the last phase none
remains.
"""

from collections.abc import Callable
from typing import NamedTuple

from g12.tools.translate.blocks import positions
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.milling import drilling_cycles
from g12.tools.translate.on_lathe import holes, sections
from g12.tools.translate.rules import (
    codes,
    cylinder,
    decimals,
    modes,
    motion,
    offsets,
    polar,
    reference,
    spindle,
    subprograms,
    tools,
)
from g12.tools.translate.turning import cycles_of_turning, drilling, feed_of_c

Rule = Callable[[Draft], None]


def of_meaning(meaning: str, rule: Callable[[Draft, ForeignWord], None]) -> Rule:
    """Return a rule that runs where a code has a meaning; the code is then dealt with."""

    def run(draft: Draft) -> None:
        code = draft.meanings.pop(meaning, None)
        if code:
            rule(draft, code)

    return run


class Phase(NamedTuple):
    """A step of the translation; ``leaves`` is what holds of a block after its rules."""

    name: str
    leaves: str
    rules: tuple[Rule, ...]


PHASES = (
    Phase(
        "codes",
        "each code is LinuxCNC's, a comment, or has its meaning in draft.meanings",
        (codes.keep_as_comments, codes.map_codes, cycles_of_turning.no_pass_yet),
    ),
    Phase(
        "modes",
        "the state has the modes of the block; planes name no axes, X words are of one kind",
        (
            of_meaning("orientation", spindle.orientation),
            modes.follow_modes,
            polar.plane_letters,
            of_meaning("radius or diameter", modes.radius_or_diameter),
        ),
    ),
    Phase(
        "values",
        "a call has its arguments; numbers are in whole units, axes are those of the machine",
        (
            subprograms.call_macro,
            modes.axes_at_zero,
            of_meaning("dwell", decimals.dwell),
            decimals.whole_units,
        ),
    ),
    Phase(
        "position",
        "the state has the point that the block leads to, as far as it is known",
        (positions.follow_positions,),
    ),
    Phase(
        "tool and spindle",
        "T, H, D, S and M3 to M5 are LinuxCNC's: tool, offset, speed limit, which spindle",
        (tools.tool_and_offsets, spindle.speed_limit, spindle.live_tool),
    ),
    Phase(
        "origins",
        "work offsets and reference points are LinuxCNC's",
        (
            offsets.numbered_offset,
            of_meaning("offset by program", offsets.offset_by_program),
            reference.reference_point,
        ),
    ),
    Phase(
        "sections",
        "what a section on the face or round the part has is written in its axes and its feed",
        (
            sections.mill_block,  # a mill's program on a lathe: on the face, round the part
            of_meaning("polar on", polar.turn_on),
            of_meaning("polar off", polar.turn_off),
            of_meaning("cylinder", cylinder.switch_cylinder),
            cylinder.on_the_surface,
            polar.inside_polar,
        ),
    ),
    Phase(
        "feed",
        "F and its mode are those that the control has for the block",
        (feed_of_c.refuse_feed_of_c, polar.feed_again, of_meaning("exact stop", motion.exact_stop)),
    ),
    Phase(
        "cycles of lathes",
        "cycles and increments of a lathe are moves in X, Z and C",
        (
            drilling.drilling_of_lathe,
            cycles_of_turning.turning_cycle,
            reference.incremental_words,
        ),
    ),
    Phase(
        "cycles of mills",
        "drilling cycles are LinuxCNC's, those on a lathe calls of its holes",
        (
            drilling_cycles.hole_pattern,
            holes.whole_cycle,
            drilling_cycles.drilling_cycle,
            holes.hole_call,
        ),
    ),
    Phase(
        "motion",
        "motion and distance mode are written where LinuxCNC is in another; stops follow cuts",
        (
            reference.machine_position,
            motion.motion_mode,
            motion.distance_mode,
            spindle.stop_behind_a_cut,
        ),
    ),
    Phase(
        "lines",
        "no word or code is left that nobody has read; calls and returns are written",
        (modes.refuse_leftovers, subprograms.finish_call),
    ),
)


def translate_words(draft: Draft) -> None:
    for phase in PHASES:
        for rule in phase.rules:
            rule(draft)
