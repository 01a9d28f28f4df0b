# SPDX-License-Identifier: GPL-2.0-or-later
"""The phases in which a block is translated, in their order.

A phase takes the block's `Draft` as the one before it has left it: words, modes, and the codes
whose meaning a later phase deals with (``draft.meanings``). Its rules rewrite words or lines, carry
the modes on, or refuse; a rule that deals with a code takes it out. After the last phase none
remains. The comment of a phase is what holds of a block after its rules.
"""

from collections.abc import Callable

from g12.tools.translate.blocks import positions
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.rules import (
    codes,
    decimals,
    drilling_cycles,
    milled,
    motion,
    offsets,
    polar,
    subprograms,
    tools,
)
from g12.tools.translate.turning import cycles_of_turning, drilling

Rule = Callable[[Draft], None]


def of_meaning(meaning: str, rule: Callable[[Draft, ForeignWord], None]) -> Rule:
    """Return a rule that runs where a code has a meaning; the code is then dealt with."""

    def run(draft: Draft) -> None:
        code = draft.meanings.pop(meaning, None)
        if code:
            rule(draft, code)

    return run


PHASES: dict[str, tuple[Rule, ...]] = {
    # each code is LinuxCNC's, a comment, or has its meaning in draft.meanings
    "codes": (codes.keep_as_comments, codes.map_codes, cycles_of_turning.no_pass_yet),
    # the state has the modes of the block; planes name no axes, X words are of one kind
    "modes": (
        codes.follow_modes,
        polar.plane_letters,
        of_meaning("radius or diameter", codes.radius_or_diameter),
    ),
    # a call has its arguments; numbers are in whole units, axes are those of the machine
    "values": (
        subprograms.call_macro,
        codes.axes_at_zero,
        of_meaning("dwell", decimals.dwell),
        decimals.whole_units,
    ),
    # the state has the point that the block leads to, as far as it is known
    "position": (positions.follow_positions,),
    # T, H, D, S and M3 to M5 are LinuxCNC's: tool, offset, speed limit, which spindle
    "tool and spindle": (tools.tool_and_offsets, tools.speed_limit, tools.live_tool),
    # work offsets and reference points are LinuxCNC's
    "origins": (
        of_meaning("numbered offset", offsets.numbered_offset),
        of_meaning("offset by program", offsets.offset_by_program),
        motion.reference_point,
    ),
    # what a section has is written in its axes and its feed
    "sections": (
        milled.mill_block,
        of_meaning("polar on", polar.turn_on),
        of_meaning("polar off", polar.turn_off),
        of_meaning("cylinder", polar.switch_cylinder),
        polar.inside_polar,
    ),
    # F and its mode are those that the control has for the block
    "feed": (
        motion.refuse_feed_of_c,
        polar.feed_again,
        of_meaning("exact stop", motion.exact_stop),
    ),
    # cycles and increments of a lathe are moves in X, Z and C
    "cycles of lathes": (
        drilling.drilling_of_lathe,
        cycles_of_turning.turning_cycle,
        motion.incremental_words,
    ),
    # drilling cycles are LinuxCNC's, those on a lathe calls of its holes
    "cycles of mills": (
        milled.whole_cycle,
        drilling_cycles.drilling_cycle,
        milled.hole_call,
    ),
    # motion and distance mode are written where LinuxCNC is in another; stops follow cuts
    "motion": (
        motion.machine_position,
        motion.motion_mode,
        motion.distance_mode,
        tools.stop_behind_a_cut,
    ),
    # no word or code is left that nobody has read; calls and returns are written
    "lines": (codes.refuse_leftovers, subprograms.finish_call),
}


def translate_words(draft: Draft) -> None:
    for rules in PHASES.values():
        for rule in rules:
            rule(draft)
