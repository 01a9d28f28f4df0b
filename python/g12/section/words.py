# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of one kind of section: which letters move which axis, and which are refused."""

from collections.abc import Callable
from typing import NamedTuple


class SectionWords(NamedTuple):
    """The words of a kind of section.

    ``plane`` are the axes of its contour: first, second and, at right angles to the plane, the
    third. ``c_is_length``: C is a length in a plane through the axis, at the present angle of C;
    else it is the axis's angle in degrees. ``letters`` are groups that move one axis; a block has
    one of each. ``foreign`` maps letters that the parser does not know to those it is given
    instead; ``relative`` are the letters for increments of an axis. ``plain`` matches a line that
    has nothing but numbers after a move's letters.

    ``planes`` are the G codes of planes that a section accepts. ``plane_name`` and ``centre_name``
    are for messages; ``refused`` are reasons by letter, ``own_block`` is that of a third axis which
    may not move together with the others, ``origin`` that of another work offset.
    """

    plane: str
    c_is_length: bool
    letters: tuple[tuple[str, str], ...]
    foreign: dict[str, str]
    relative: dict[str, str]
    plain: Callable[[str], object]
    planes: frozenset[int]
    plane_name: str
    centre_name: str
    refused: dict[str, str]
    own_block: str
    origin: str
