# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter: names for its types and values, which its modules lack; the package's state."""

from __future__ import annotations

from typing import Any, TypeAlias

from g12.request.context import XY, XZ, YZ

Interp: TypeAlias = Any  # interpreter.Interp, with the package's state on it
ParsedBlock: TypeAlias = Any  # interpreter.block, as it was parsed
CanonModule: TypeAlias = Any  # the module emccanon, or a test's substitute
ToolTableEntry: TypeAlias = Any  # of the tool table

PER_MINUTE, INVERSE_TIME, PER_REVOLUTION = 0, 1, 2  # feed_mode
PLANE_CODES = {1: XY, 2: YZ, 3: XZ}  # plane
MOVE_WORDS = "ABCDHIJKRUVWXYZ"
WORD_FIELDS = {  # of a block: flag and value
    letter: (f"{letter.lower()}_flag", f"{letter.lower()}_number")
    for letter in "ABCDEFHIJKLPQRSTUVWXYZ"
} | {"D": ("d_flag", "d_number_float")}


def words_in(block: ParsedBlock, letters: str) -> dict[str, float]:
    """Return those of the words that a block has."""
    fields = ((letter, *WORD_FIELDS[letter]) for letter in letters)
    return {letter: getattr(block, value) for letter, flag, value in fields if getattr(block, flag)}


class PackageState:
    """The package's state of one interpreter, stored on the interpreter object.

    ``modes`` are those that a cycle has to restore, ``feed`` the F before a shape, ``path`` the
    path control and ``spindle`` the number of the spindle in use before holes. ``shown`` are the
    messages that are shown once for each program. ``source`` is the file of the last section.
    ``modes_before_face`` is the block that restores them, ``by_hand`` the G12.1 in MDI,
    ``accelerations`` those of X and Y in the INI.
    """

    def __init__(self) -> None:
        self.modes: tuple[int, int, int, bool] = (0, 0, 0, False)
        self.feed, self.path, self.spindle = 0.0, "", 0
        self.shown: set[object] = set()
        self.texts: dict[str, str] = {}
        self.source: Any = None
        self.modes_before_face = ""
        self.by_hand: Any = None
        self.accelerations: list[float] = []


def state_of(interp: Interp) -> PackageState:
    state = getattr(interp, "g12_state", None)
    if state is None:
        state = interp.g12_state = PackageState()
    return state
