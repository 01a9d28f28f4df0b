# SPDX-License-Identifier: GPL-2.0-or-later
"""The words that one kind of section has: which letters move what, and which mean nothing there."""

from collections.abc import Callable
from typing import NamedTuple


class SectionWords(NamedTuple):
    """The words of a kind of section.

    ``plane`` are the axes of its contour: first, second and, at right angles to the plane, the
    third. ``c_is_length``: C is a length in a plane that is laid through the axis where it stands;
    else it is the axis's angle in degrees. ``letters`` are those that move one axis, of which a
    block has one.

    ``foreign`` are letters that the parser is not given as they are, and what it is given instead;
    ``relative`` those that are increments of an axis. ``plain`` tells a line that has nothing but
    numbers after a move's letters.

    ``planes`` are the G codes of planes that may stand inside. ``plane_name`` and ``centre_name``
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
