# SPDX-License-Identifier: GPL-2.0-or-later
"""Words of a mill's program that no lathe's section has, and the position of its tool.

The mill's X and Y lie on the bar's face, its Z is along the spindle (``onto`` face), or X along
the bar, Y round it and Z out of it (``onto`` round). Points are in the mill's own axes here.
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import MOVES, UNKNOWN, ModalState
from g12.tools.translate.blocks.positions import known_position, value_text

SAFE = {"G20": ("safe_inch", 0.1), "G21": ("safe_mm", 2.0)}
OTHER_PLANES = frozenset(("G18", "G19"))
NEEDLESS = frozenset(("G17", "G98", "G99"))  # in a section G98 and G99 are feed modes
OTHER_FEEDS = {"G93": "inverse time", "G95": "a feed per revolution"}


def is_on_lathe(draft: Draft) -> bool:
    return bool(draft.control.onto)


def refuse_foreign(draft: Draft) -> None:
    """Refuse what a program of X, Y and Z in G17 does not have."""
    codes = set(draft.codes())
    for word in draft.words:
        if word.letter in "ABC" and not draft.call:
            raise NotTranslated(f"{word.text}: a program for {draft.control.name} has X, Y and Z")
    if codes & OTHER_PLANES:
        code = min(codes & OTHER_PLANES)
        raise NotTranslated(f"{code}: arcs lie in X and Y here (G17): no vertical leads in CAM")
    for code in codes & OTHER_FEEDS.keys():
        raise NotTranslated(f"{code}, {OTHER_FEEDS[code]}: write G94 and F per minute")
    draft.comments += draft.take_codes(NEEDLESS)


def safe_height(draft: Draft) -> float:
    """Return the Z from which on a rapid is clear of the part, in the program's units."""
    safe = draft.control.value("mill", "safe", None)
    if safe is not None:
        return safe
    units = draft.sure("units", "how high a rapid must be depends on the units")
    if units not in SAFE:
        raise NotTranslated(
            "how high a rapid must be depends on the units: say G20 or G21 (--units)"
        )
    return draft.control.value("mill", *SAFE[units])


def waiting_point(draft: Draft) -> dict[str, str]:
    """Return the values of X and Y to which rapids lead that are not written yet."""
    return dict(draft.sure("waiting", "where X and Y go depends on the way to this block"))


def point_value(draft: Draft, axis: str, state: ModalState, why: str) -> str:
    waiting = waiting_point(draft).get(axis)
    position = known_position(state, axis)
    if waiting is None and position is None:
        raise NotTranslated(why)
    return waiting or value_text(position)


def start_height(draft: Draft) -> float | None:
    return known_position(draft.start, "Z")


def _end_height(draft: Draft) -> float | None:
    if draft.word("Z"):
        return known_position(draft.state, "Z")
    return start_height(draft)


def moves_by_rapid(draft: Draft) -> bool:
    codes = MOVES.intersection(draft.codes())
    motion = min(codes) if codes else draft.sure("motion", "X, Y or Z without G0 or G1")
    if motion == UNKNOWN:
        raise NotTranslated("X, Y or Z without G0 or G1, and none before them")
    return motion == "G0"


def check_rapid(draft: Draft, across: bool) -> None:
    """Refuse a rapid below the safe height; ``across``: it moves in X or Y. Up is allowed."""
    safe, start, end = safe_height(draft), start_height(draft), _end_height(draft)
    if end is None or (across and start is None):
        raise NotTranslated(
            "G0, and the position of Z is not known here: write Z as a number first"
        )
    lowest = end if start is None or not across else min(start, end)
    if lowest < safe and (across or start is None or end < start):
        raise NotTranslated(
            f"G0 at Z{lowest:g}, below {safe:g} where rapids are clear of the part: write G1 "
            "and F, or say --safe"
        )
