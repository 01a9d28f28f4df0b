# SPDX-License-Identifier: GPL-2.0-or-later
"""Drilling cycles of a mill's program as calls of the lathe's holes, each a hole.

The tool goes back to where it stood before each hole, as after G98: G99 costs a little time.
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import UNSURE
from g12.tools.translate.on_lathe.mill_words import (
    is_on_lathe,
    point_value,
    safe_height,
    start_height,
)
from g12.tools.translate.on_lathe.sections import milled_surface
from g12.tools.translate.on_lathe.surfaces import DrilledHole, is_plain_number, times

DRILLED = frozenset(("G73", "G81", "G82", "G83"))
HOLE_LETTERS = "XYZRQPF"


def whole_cycle(draft: Draft) -> None:
    """Have the cycle written with all of its words in each block."""
    if is_on_lathe(draft) and ("drilling cycle" in draft.meanings or draft.state.cycle):
        if draft.state.distance != "G90":
            raise NotTranslated("a drilling cycle under G91: write its holes under G90")
        draft.change(own_motion=UNSURE)


def hole_call(draft: Draft) -> None:
    cycle = draft.state.cycle
    if not is_on_lathe(draft) or cycle not in draft.codes():
        return
    if cycle not in DRILLED:
        raise NotTranslated(f"{cycle}: on a lathe G73 and G81 to G83 are translated")
    words = {letter: draft.take(letter) for letter in HOLE_LETTERS}
    given = {letter: word.value for letter, word in words.items() if word}
    if "L" in draft.letters():
        raise NotTranslated(f"{cycle} with L: write each hole with its X and Y")
    draft.take_codes({cycle, "G90", "G94"})
    after, draft.after = draft.after, []
    draft.write([milled_surface(draft).call(draft, _hole_from_cycle(draft, cycle, given)), *after])
    draft.change(waiting=(), own_motion=UNSURE, own_feed="other", at_z=start_height(draft))


def _hole_from_cycle(draft: Draft, cycle: str, given: dict[str, str]) -> DrilledHole:
    feed = draft.sure("feed", f"{cycle} needs F")
    retract, depth = given["R"], given["Z"]
    if not feed:
        raise NotTranslated(f"{cycle} needs F")
    if is_plain_number(depth) and float(depth) >= 0:
        raise NotTranslated(f"{cycle} Z{depth}: the hole must end below Z0, the part's surface")
    if is_plain_number(retract) and float(retract) <= 0:
        retract = f"{safe_height(draft):g}"
    peck = {"G83": given.get("Q", "0"), "G73": times(given.get("Q", "0"), -1)}.get(cycle, "0")
    dwell = given.get("P", "0") if cycle == "G82" else "0"
    why = "where the hole is along {} is not known: write X and Y"
    x, y = (
        given.get(axis) or point_value(draft, axis, draft.state, why.format(axis)) for axis in "XY"
    )
    return DrilledHole(x, y, times(depth, -1), retract, feed, peck, dwell)
