# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state that a block is reached in: the foreign control's, and LinuxCNC's where apart.

A line can be reached by several ways (a subprogram by its calls, a loop by its end, the block
behind a skipped one). Where the ways differ in a mode, that mode is UNSURE, and a rule that needs
it refuses the block.
"""

from typing import NamedTuple

UNSURE = "?"  # different on different ways
UNKNOWN = ""  # never said
AS_PROGRAMMED = "="  # LinuxCNC is in the mode that the program is in

GROUPS = {
    "motion": ("G0", "G1", "G2", "G3"),
    "distance": ("G90", "G91"),
    "plane": ("G17", "G18", "G19"),
    "units": ("G20", "G21"),
    "feed_mode": ("G93", "G94", "G95"),
    "compensation": ("G40", "G41", "G42"),
    "spindle_mode": ("G96", "G97"),
    "path": ("G61", "G64"),
    "retract": ("G98", "G99"),
    "x_words": ("G7", "G8"),
}
MOVES = frozenset(GROUPS["motion"])
MOTIONS = MOVES | {"G33"}
CONSUMERS = frozenset(
    ("G10", "G28", "G30", "G52", "G92", "G12", "G13", "G12.2", "G13.2", "G7.1")
)  # what takes the axis words of its block for itself
GROUP_OF = {code: group for group, codes in GROUPS.items() for code in codes}


class ModalState(NamedTuple):
    """The modes by the names of their groups, each as LinuxCNC's code.

    ``cycle`` is the drilling cycle in force and ``cycle_words`` what it was given, ``length`` the H
    of G43 (``0``: none), ``tool`` the T word of what is loaded, ``next_tool`` that of the next M6,
    ``offset`` the work offset, ``limit`` the spindle's speed limit, ``surface`` the S of G96,
    ``radius`` the D word, ``feed`` the F word.
    ``own_motion``, ``own_distance`` and ``own_feed`` tell where LinuxCNC is in another mode than
    the program.
    ``polar`` is ``on`` between polar on and off, ``cylinder`` on a cylinder; ``mapped`` is the
    radius of one whose angles are written as lengths, ``delayed`` a code of compensation that is
    written with the section's next move.
    ``at_x`` to ``at_c`` are the program's point, as far as it is known (`places`); ``held`` are
    slides that LinuxCNC has not moved yet, each with where it stands. ``known_offsets`` are the
    numbered work offsets that are known to be set, or asked about. ``turn`` is the turning cycle
    that X and Z repeat, ``pass_words`` what it was given, ``kept`` what first blocks of cycles say;
    ``chamfers`` tells whether threads end with one. ``local`` are X and Y of G52, as far as they
    are known, ``turned`` is the work offset that G68 has turned, ``rigid`` the speed of a rigid tap
    and ``tap_top`` the height that it goes back to, ``waiting`` is where a mill's program goes on a
    lathe before its next cut, ``section`` the program in which that began. ``sizes`` are the
    diameters that G10 L12 has set, by tool.
    ``corner`` tells that the program's point is a corner which LinuxCNC has cut: increments would
    start elsewhere. ``x_words`` tells whether X words are diameters, ``live`` is the ``$`` word of
    a spindle that drives the tool and turns; ``spindle`` is the M3 or M4 that turns the first one.
    """

    motion: str = UNKNOWN
    distance: str = "G90"
    plane: str = UNKNOWN
    units: str = UNKNOWN
    feed_mode: str = UNKNOWN
    compensation: str = "G40"
    spindle_mode: str = UNKNOWN
    path: str = UNKNOWN
    cycle: str = UNKNOWN
    cycle_words: tuple = ()
    length: str = UNKNOWN
    tool: str = UNKNOWN
    next_tool: str = UNKNOWN
    offset: str = UNKNOWN
    limit: str = UNKNOWN
    surface: str = UNKNOWN
    radius: str = UNKNOWN
    feed: str = UNKNOWN
    polar: str = "off"
    mapped: str = UNKNOWN
    delayed: str = UNKNOWN
    own_motion: str = AS_PROGRAMMED
    own_distance: str = AS_PROGRAMMED
    own_feed: str = AS_PROGRAMMED
    held: tuple = ()
    known_offsets: tuple = ()
    turn: str = UNKNOWN
    kept: tuple = ()
    pass_words: tuple = ()
    chamfers: bool | str = True
    local: tuple | str = ()
    turned: str = UNKNOWN
    retract: str = UNKNOWN
    x_words: str = UNKNOWN
    live: str = UNKNOWN
    spindle: str = UNKNOWN
    waiting: tuple | str = ()
    section: int | str = UNKNOWN
    rigid: str = UNKNOWN
    tap_top: float | str = UNKNOWN
    sizes: tuple = ()
    corner: bool | str = False
    at_x: float | str = UNKNOWN
    at_y: float | str = UNKNOWN
    at_z: float | str = UNKNOWN
    at_a: float | str = UNKNOWN
    at_b: float | str = UNKNOWN
    at_c: float | str = UNKNOWN


def merged(one: ModalState, other: ModalState) -> ModalState:
    """Return what is sure when a line is reached in either of two states."""
    if one == other:
        return one
    state = ModalState._make(a if a == b else UNSURE for a, b in zip(one, other))
    kept, others = dict(one.kept), dict(other.kept)
    same = {
        key: kept.get(key) if kept.get(key) == others.get(key) else UNSURE
        for key in kept.keys() | others.keys()
    }
    return state._replace(kept=tuple(sorted(same.items())))
