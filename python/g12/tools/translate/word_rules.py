# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules in the order in which a block goes through them.

A rule takes a `Draft`, rewrites its words or lines, carries its state on, or refuses. A rule of one
meaning runs where a code of the block has that meaning, and takes the code, too.
"""

from collections.abc import Callable

from g12.tools.translate.blocks import positions
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.milling import drilling_cycles, rigid_tapping, rotation
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
from g12.tools.translate.turning import corners, cycles_of_turning, drilling, feed_of_c


def of_meaning(meaning: str, rule: Callable[[Draft, ForeignWord], None]) -> Callable[[Draft], None]:
    """Return a rule that runs where a code has a meaning; the code is then dealt with."""

    def run(draft: Draft) -> None:
        code = draft.meanings.pop(meaning, None)
        if code:
            rule(draft, code)

    return run


WORD_RULES = (
    codes.keep_as_comments,
    codes.map_codes,
    cycles_of_turning.no_pass_yet,
    of_meaning("orientation", spindle.orientation),
    modes.follow_modes,
    polar.plane_letters,
    of_meaning("radius or diameter", modes.radius_or_diameter),
    subprograms.call_macro,
    modes.axes_at_zero,
    of_meaning("dwell", decimals.dwell),
    decimals.whole_units,
    positions.follow_positions,
    tools.tool_and_offsets,
    spindle.speed_limit,
    spindle.live_tool,
    rotation.follow_rotation,
    of_meaning("turned back", rotation.end_of_rotation),
    of_meaning("turned", rotation.rotation),
    offsets.numbered_offset,
    of_meaning("offset by program", offsets.offset_by_program),
    reference.reference_point,
    sections.mill_block,
    of_meaning("polar on", polar.turn_on),
    of_meaning("polar off", polar.turn_off),
    of_meaning("cylinder", cylinder.switch_cylinder),
    cylinder.on_the_surface,
    polar.inside_polar,
    feed_of_c.feed_of_c,
    polar.feed_again,
    of_meaning("exact stop", motion.exact_stop),
    drilling.drilling_of_lathe,
    cycles_of_turning.turning_cycle,
    corners.direct_drawing,
    reference.incremental_words,
    drilling_cycles.hole_pattern,
    rigid_tapping.rigid_tap,
    holes.whole_cycle,
    drilling_cycles.drilling_cycle,
    holes.hole_call,
    reference.machine_position,
    motion.motion_mode,
    motion.distance_mode,
    spindle.stop_behind_a_cut,
    modes.refuse_leftovers,
    subprograms.finish_call,
)
