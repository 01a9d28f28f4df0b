# SPDX-License-Identifier: GPL-2.0-or-later
"""The position of the program's point, in its units (X of a lathe a diameter), if it is known.

A position is a number, None if unknown, UNSURE where the ways to a block differ. It is known
from absolute numbers on; an expression, a reference point, a tool or another offset end that.
"""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, PARTNERS, Draft
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import MOTIONS, ModalState

FIELDS = {axis: f"at_{axis.lower()}" for axis in AXIS_NUMBERS}
LOST: dict[str, None] = dict.fromkeys(FIELDS.values())
FOLLOWED_CODES = frozenset(  # a block of these codes alone ends at its words
    f"G{n}" for n in (*range(5), 7, 8, *range(17, 22), 33, 40, 41, 42, 61, 64, 80, 90, 91)
) | frozenset(f"G{n}" for n in range(93, 100))
IN_POLAR = {"Y": "C", "V": "H"}
LENGTH_CODES = frozenset(("G43", "G49"))  # of the tool: a mill's is along Z
ORIGINS = frozenset(f"G{n}" for n in range(54, 60))
SHIFTING = LENGTH_CODES | ORIGINS
STAYING = frozenset(  # codes that move nothing and leave the origin, or set it to their words
    (
        "speed limit or origin",
        "exact stop",
        "cancel cycle",
        "thread chamfer",
        "no thread chamfer",
    )
)


def known_position(state: ModalState, axis: str) -> float | None:
    at = getattr(state, FIELDS[axis])
    return at if isinstance(at, float) else None


def is_unmoved(draft: Draft, axis: str) -> bool:
    """Whether a block ends where it began, as far as that is known."""
    start = known_position(draft.start, axis)
    return start is not None and start == known_position(draft.state, axis)


def value_text(value: float) -> str:
    """Return a number of the program's as LinuxCNC reads it, with eight decimals."""
    text = f"{value:.8f}".rstrip("0")
    return "0." if text == "-0." else text


def axis_of(letter: str) -> str:
    return PARTNERS.get(letter, letter)


def end_of_word(state: ModalState, word: ForeignWord) -> float | None:
    """Return where a word's axis goes, None if that is not known."""
    if word.kind != "number":
        return None
    if word.letter in AXIS_NUMBERS and state.distance == "G90":
        return word.number
    start = known_position(state, axis_of(word.letter))
    return None if start is None or state.distance not in ("G90", "G91") else start + word.number


def _is_drilling(draft: Draft) -> bool:
    """Whether a mill's drilling cycle is active in a block; a motion code ends it."""
    begins = "drilling cycle" in draft.meanings
    goes_on = bool(draft.state.cycle) and MOTIONS.isdisjoint(draft.codes())
    return (begins or goes_on) and not draft.control.is_lathe


def _follow_drilling(draft: Draft) -> None:
    again = draft.letters() & set(draft.control.value("subprograms", "cycle_repeat", "L"))
    words = [w for w in draft.axis_words() if w.letter in "XY"]
    moved = {FIELDS[w.letter]: end_of_word(draft.state, w) for w in words}
    lost = draft.state.distance == "G91" and again
    draft.change(at_z=None, **(dict.fromkeys(moved) if lost else moved))


def follow_positions(draft: Draft) -> None:
    codes, is_lathe = set(draft.codes()), draft.control.is_lathe
    drills = _is_drilling(draft)
    if drills and not codes - FOLLOWED_CODES:
        _follow_drilling(draft)
        return
    shifted = codes & (SHIFTING if is_lathe else ORIGINS) or draft.start.units != draft.state.units
    changes = "M6" in draft.m_codes() or (is_lathe and "T" in draft.letters())
    other = codes - FOLLOWED_CODES - SHIFTING or set(draft.meanings) - STAYING or drills
    if other or changes or shifted:
        draft.change(**LOST)
    elif codes & LENGTH_CODES:
        draft.change(at_z=None)
    if other:
        return
    words = [*draft.axis_words(), *(draft.increments() if is_lathe else ())]
    if draft.state.polar == "on":  # Y is C there
        words = [w._replace(letter=IN_POLAR.get(w.letter, w.letter)) for w in words]
    if words:
        draft.change(**{FIELDS[axis_of(w.letter)]: end_of_word(draft.state, w) for w in words})
