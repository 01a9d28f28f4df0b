# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a section begins and ends in a mill's program, so that every cut lies in one.

1. Rapids in X and Y outside a section wait: the lathe goes there when something is cut.
2. The first block at a feed begins the section: the slide and C go to its start at the safe
   height, then the section's code.
3. A call and a loop begin one before them, or what they cut would lie in one only sometimes.
4. A tool, an offset, G28, a drilling cycle, the end, a return: the section ends before it.
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import MOVES, REFERENCES, UNKNOWN, UNSURE
from g12.tools.translate.blocks.positions import SHIFTING, known_position
from g12.tools.translate.on_lathe.mill_words import (
    check_rapid,
    is_on_lathe,
    moves_by_rapid,
    point_value,
    refuse_foreign,
    safe_height,
    start_height,
    waiting_point,
)
from g12.tools.translate.on_lathe.surfaces import FACE, ROUND, MilledSurface
from g12.tools.translate.rules.modes import MACHINES_OWN
from g12.tools.translate.rules.polar import feed_of_rapids

SURFACES = {"face": FACE, "round": ROUND}
ENDING = MACHINES_OWN | SHIFTING
ARC = frozenset("IJR")


def mill_block(draft: Draft) -> None:
    if not is_on_lathe(draft):
        return
    draft.sure("polar", "a section has begun on one way to this block, and not on another")
    refuse_foreign(draft)
    if "cancel cycle" in draft.meanings:
        draft.comments.append(draft.meanings.pop("cancel cycle").code)
        draft.change(cycle=UNKNOWN, cycle_words=())
    if draft.state.polar != "off" and _ends_here(draft):
        _end_section(draft)
    _go_home(draft)
    if drills(draft):
        return
    has_words = bool(draft.letters() & {"X", "Y", "Z", *ARC})
    if has_words and not draft.call and REFERENCES.isdisjoint(draft.codes()):
        _write_move(draft)
    elif draft.call and draft.state.polar == "off" and draft.state.waiting:
        _begin_section(draft)
    if draft.state.polar != "off":
        milled_surface(draft).inside(draft)
    elif draft.state.compensation in ("G41", "G42"):
        code = draft.state.compensation
        raise NotTranslated(f"{code} before the first cut: write it with the contour's first G1")


def milled_surface(draft: Draft) -> MilledSurface:
    return SURFACES[draft.control.onto]


def before_loop(draft: Draft) -> None:
    """Begin a section before a loop, so that each round of it lies in one."""
    if is_on_lathe(draft) and draft.state.polar == "off" and draft.state.waiting:
        _begin_section(draft)


def drills(draft: Draft) -> bool:
    if "drilling cycle" in draft.meanings:
        return True
    moves = not (MOVES | REFERENCES).isdisjoint(draft.codes())
    return bool(draft.state.cycle) and not moves and bool(draft.letters() & set("XYZR"))


def _ends_here(draft: Draft) -> bool:
    returns = draft.returns and draft.state.section == _program_begun_in(draft)
    changes = (
        "T" in draft.letters()
        or "M6" in draft.m_codes()
        or not ENDING.isdisjoint(draft.codes())
        or draft.start.units != draft.state.units
    )
    return changes or draft.ends or returns or drills(draft)


def _program_begun_in(draft: Draft) -> int:
    return draft.program[0][0]


def _write_move(draft: Draft) -> None:
    across = bool(draft.letters() & {"X", "Y"})
    if not moves_by_rapid(draft):
        if draft.state.polar == "off":
            _begin_section(draft)
    elif draft.state.polar != "off":
        check_rapid(draft, across)
    else:
        _rapid_outside(draft, across)


def _rapid_outside(draft: Draft, across: bool) -> None:
    """Store X and Y of a rapid for the next cut, write Z."""
    if draft.word("Z") or start_height(draft) is not None:
        check_rapid(draft, across and start_height(draft) is not None)
    if across and draft.state.distance != "G90":
        raise NotTranslated("a rapid in X or Y under G91 before the first cut: write it under G90")
    waiting = waiting_point(draft) | {w.letter: w.value for w in draft.words if w.letter in "XY"}
    for letter in "XY":
        draft.comment_out(letter, " with the next cut")
    draft.change(waiting=tuple(sorted(waiting.items())))
    milled_surface(draft).outside(draft)


def _begin_section(draft: Draft) -> None:
    if _ends_here(draft):
        raise NotTranslated(
            "a cut begins here beside a tool, an offset or units: write them in a block before it"
        )
    height, safe = start_height(draft), safe_height(draft)
    if height is None or height < safe:
        where = "not known" if height is None else f"{height:g}"
        raise NotTranslated(
            f"a cut begins here with the tool at Z {where}: G0 Z at or above {safe:g} before it, "
            "with X and Y"
        )
    feed = feed_of_rapids(draft)
    why = "a cut begins here, and the position of {} is not known: G0 X Y before it"
    x, y = (point_value(draft, axis, draft.start, why.format(axis)) for axis in "XY")
    lines = milled_surface(draft).begin(draft, (x, y), feed)
    absolute = draft.start.distance == "G90"
    draft.before += lines if absolute else [f"G90 {lines[0]}", *lines[1:], "G91"]
    draft.change(
        polar=milled_surface(draft).section,
        section=_program_begun_in(draft),
        waiting=(),
        own_motion="G1",
        own_feed="other",
        at_c=known_position(draft.state, "Y"),
    )


def _end_section(draft: Draft) -> None:
    if draft.start.compensation != "G40" or draft.state.delayed:
        raise NotTranslated("G41 or G42 is on where the section ends: G40 with a move before it")
    draft.before += milled_surface(draft).end(draft)
    own = drills(draft) and "Y" in draft.letters()  # of the hole, which no section is for
    y = known_position(draft.state, "Y" if own else milled_surface(draft).y_in)
    draft.change(polar="off", section=UNKNOWN, own_motion=UNSURE, at_y=y, at_c=None)


def _go_home(draft: Draft) -> None:
    """Write G28, G30 and G53 in the lathe's axes: the mill's machine zero has no meaning there."""
    codes = MACHINES_OWN.intersection(draft.codes())
    if not codes:
        return
    if codes == {"G53"}:
        _machine_zero(draft)
    else:
        milled_surface(draft).outside(draft)
        if not draft.axis_words():
            draft.comments += draft.take_codes(codes)  # without an axis G28 moves each of them
    draft.change(waiting=())


def _machine_zero(draft: Draft) -> None:
    """Write G53 as G28 away from the part if it has Z, as a comment if not."""
    motions = draft.take_codes({"G0", "G1"})
    goes_home = "Z" in draft.letters()
    draft.comments += draft.take_codes({"G53"})
    for word in [word for word in draft.words if word.letter in "XYZ"]:
        draft.comment_out(word.letter)
    if goes_home:
        absolute = [] if draft.state.distance == "G91" else ["G90"]
        draft.after += [f"G91 G28 {milled_surface(draft).home}0", *absolute]
    if motions:
        draft.change(motion=motions[0], own_motion=UNSURE)
