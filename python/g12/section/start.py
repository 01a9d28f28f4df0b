# SPDX-License-Identifier: GPL-2.0-or-later
"""The state at the start of a section, and the reading of the words after it. Plain data."""

from typing import NamedTuple

from g12.section.line import BlockLocation
from g12.section.modes import SectionModes
from g12.section.words import SectionWords


class SectionStart(NamedTuple):
    """The interpreter's state at the start of a section, read once.

    Lengths are in program units. ``location`` is that of the block that switches on, ``words`` are
    the section's words in it, ``alone``: it holds nothing else, ``level`` is its call level. X is a
    radius value; C, the axis's position, is in degrees. ``machine_unit`` is the length of a machine
    unit, ``millimetre`` that of 1 mm; ``offsets`` convert from program to machine coordinates (X,
    Z, and C in degrees), ``x_shift`` is what G52 or G92 adds to X, a radius value. ``speeds`` are
    the commanded ones of all spindles in rpm, ``spindle`` is the number of the one that feeds per
    revolution refer to. ``tool_radius`` is None if no tool is loaded.
    """

    location: BlockLocation
    words: dict[str, float]
    alone: bool
    level: int
    x: float
    c: float
    z: float
    machine_unit: float
    millimetre: float
    offsets: dict[str, float]
    x_shift: float
    modes: SectionModes
    spindle: int
    speeds: tuple[float, ...]
    tool_radius: float | None
    diameter: bool  # G7
    yz_plane: bool  # G19
    compensated: bool
    offset_pending: bool  # after G40 the tool is still offset from the programmed point
    inverse_time: bool  # G93
    surface_speed: bool  # G96
    rotated: bool  # the work offset, by G10 L2 R
    missing_code: str = ""  # the code that makes the spindle C, where it is not


class WordRules(NamedTuple):
    """Rules for reading the words of a section; lengths and feeds in program units.

    ``diameter``: X words are diameters. ``x_scale`` converts a parsed X word into a radius value,
    ``c_scale`` a C word into a length. ``third_with_others``: the axis at right angles to the plane
    may move together with those in it. ``rapid_feed`` is None where G0 is refused,
    ``radius_tolerance`` is how far an arc's radii at start and end may differ, ``beside`` the
    tool's distance from the X line towards C+.
    """

    words: SectionWords
    diameter: bool
    x_scale: float
    c_scale: float
    third_with_others: bool
    rapid_feed: float | None
    radius_tolerance: float
    beside: float = 0.0
