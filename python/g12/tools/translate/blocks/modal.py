# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state that a block is reached in: the foreign control's, and LinuxCNC's where apart.

A line can be reached by several ways (a subprogram by its calls, a loop by its end, the block
after a skipped one). Where the ways differ in a mode, that mode is UNSURE, and a rule that needs
it refuses the block.
"""

from typing import NamedTuple, Self

UNSURE = "?"  # different on different ways
UNKNOWN = ""  # no value yet
AS_PROGRAMMED = "="  # LinuxCNC is in the mode that the program is in
IN_CYCLE = "cycle"  # and in the program's drilling cycle, with all of its words

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
REFERENCES = frozenset(("G28", "G30"))
CONSUMERS = REFERENCES | frozenset(
    ("G10", "G52", "G92", "G12", "G13", "G12.2", "G13.2", "G7.1")
)  # what takes the axis words of its block for itself
GROUP_OF = {code: group for group, codes in GROUPS.items() for code in codes}


class ModalState(NamedTuple):
    """The modes by the names of their groups, each as LinuxCNC's code, and what rules remember."""

    motion: str = UNKNOWN
    distance: str = "G90"
    plane: str = UNKNOWN
    units: str = UNKNOWN
    feed_mode: str = UNKNOWN
    compensation: str = "G40"
    spindle_mode: str = UNKNOWN
    path: str = UNKNOWN
    cycle: str = UNKNOWN  # the drilling cycle in force
    cycle_words: tuple = ()  # its words, by letter
    length: str = UNKNOWN  # the H of G43, "0": none
    tool: str = UNKNOWN  # the T word of the loaded tool
    next_tool: str = UNKNOWN  # that of the next M6
    limit: str = UNKNOWN  # the spindle's speed limit
    surface: str = UNKNOWN  # the S of G96
    radius: str = UNKNOWN  # the D word
    feed: str = UNKNOWN  # the F word
    polar: str = "off"  # ``on`` in polar mode, ``cylinder`` on a cylinder
    delayed: str = UNKNOWN  # a code of compensation that is written with the section's next move
    own_motion: str = AS_PROGRAMMED  # LinuxCNC's mode where it is not the program's
    own_distance: str = AS_PROGRAMMED
    own_feed: str = AS_PROGRAMMED
    turning_cycle: str = UNKNOWN  # the turning cycle that X and Z repeat
    kept: tuple = ()  # values of the first blocks of cycles
    pass_words: tuple = ()  # the words of ``turning_cycle``
    chamfers: bool | str = True  # threads end with one
    retract: str = UNKNOWN
    x_words: str = UNKNOWN  # G7: diameters, G8: radii
    live_tool: str = UNKNOWN  # the ``$`` word of a spindle that drives the tool and turns
    spindle: str = UNKNOWN  # the M3 or M4 of the first spindle
    waiting: tuple | str = ()  # X and Y of a mill's program on a lathe at its next cut
    section: int | str = UNKNOWN  # the program in which a section on a lathe has begun
    given: frozenset[int] = frozenset()  # local variables that have a value on every way
    touched: frozenset[int] = frozenset()  # those that have one on some way
    at_x: float | str | None = None  # the program's point (`positions`)
    at_y: float | str | None = None
    at_z: float | str | None = None
    at_a: float | str | None = None
    at_b: float | str | None = None
    at_c: float | str | None = None

    def own(self, group: str) -> str:
        """Return LinuxCNC's ``motion`` or ``distance`` mode."""
        mode = getattr(self, f"own_{group}")
        return getattr(self, group) if mode == AS_PROGRAMMED else mode

    def giving(self, variables: frozenset[int]) -> Self:
        """Return the state in which local variables have a value."""
        return self._replace(given=self.given | variables, touched=self.touched | variables)


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
    return state._replace(
        kept=tuple(sorted(same.items())),
        given=one.given & other.given,
        touched=one.touched | other.touched,
    )
