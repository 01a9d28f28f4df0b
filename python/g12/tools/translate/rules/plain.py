# SPDX-License-Identifier: GPL-2.0-or-later
"""Most blocks of a long program: lines and arcs that are the same on LinuxCNC, told at a glance."""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, MOVES, UNKNOWN
from g12.tools.translate.blocks.places import FIELDS, end_of_word

LETTERS = frozenset("NXYZABCIJKRF")
SETTLED = (UNKNOWN, "off", AS_PROGRAMMED, AS_PROGRAMMED, AS_PROGRAMMED)
TURNING = frozenset("ABC")  # beside a slide they can need another feed


def is_plain(draft: Draft) -> bool:
    """Tell whether no rule has anything to do; the block's motion, feed and place are then noted.

    So it is for one motion code or none, numbers with points, and no mode that LinuxCNC lacks.
    """
    state, control = draft.state, draft.control
    if state.turn or control.onto:
        return False
    at = (state.cycle, state.polar, state.own_motion, state.own_distance, state.own_feed)
    if at != SETTLED:
        return False
    modes: dict[str, float | str] = {}
    seen = set()
    for letter, value, kind, _ in draft.words:
        if kind != "number" or letter in seen:
            return False
        seen.add(letter)
        if letter == "G":
            modes["motion"] = f"G{value.lstrip('0') or '0'}"
        elif (
            letter not in LETTERS
            or (letter in AXIS_NUMBERS and letter not in control.axes)
            or (letter != "N" and "." not in value and value != "0")
        ):
            return False
        elif letter == "F":
            modes["feed"] = value
    motion = modes.get("motion", state.motion)
    arc = motion in ("G2", "G3") or seen.isdisjoint("IKR" if control.is_lathe else "R")
    if not arc or motion not in MOVES or control.meanings.get(motion) != "same":
        return False
    if motion != "G0" and not TURNING.isdisjoint(seen):
        return False
    modes.update(
        (FIELDS[w.letter], end_of_word(state, w)) for w in draft.words if w.letter in FIELDS
    )
    if any(getattr(state, mode) != value for mode, value in modes.items()):
        draft.change(**modes)
    return True
