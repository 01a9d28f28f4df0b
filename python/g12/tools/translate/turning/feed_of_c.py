# SPDX-License-Identifier: GPL-2.0-or-later
"""A slide and C in one feed block outside a section, which takes another time on LinuxCNC.

On a Fanuc F is along the path of millimetres (X as a radius) and degrees together, on others C's
alone; LinuxCNC takes it along X, Y and Z and would turn C too fast. Where the control does so too,
its file says ``feed_of_c = "mm"``.
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import CONSUMERS, UNKNOWN
from g12.tools.translate.blocks.positions import axis_of, is_unmoved

SLIDES = "XYZ"


def refuse_feed_of_c(draft: Draft) -> None:
    axes = {axis_of(word.letter) for word in (*draft.axis_words(), *draft.increments())}
    moved = {axis for axis in axes if not is_unmoved(draft, axis)}
    as_here = draft.control.feed_of_c == "mm" or draft.state.feed_mode == "G93"
    if "C" in moved and moved.intersection(SLIDES) and _is_feed(draft) and not as_here:
        raise NotTranslated(
            "C beside a slide at a feed: F is along another path here: write G93 and F, 1 / minutes, "
            'or say feed_of_c = "mm" in a control of your own, where F is X\'s and Z\'s alone'
        )


def _is_feed(draft: Draft) -> bool:
    other = draft.state.polar != "off" or draft.meanings or draft.state.cycle
    codes = {*CONSUMERS, "G53", "G33"}.intersection(draft.codes())
    return draft.motion() not in ("G0", UNKNOWN) and not other and not codes
