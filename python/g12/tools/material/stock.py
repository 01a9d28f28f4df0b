# SPDX-License-Identifier: GPL-2.0-or-later
"""The stock, a bar or a block, from the user's text, and its position.

A bar turns about the spindle's centre, its face is the program's Z0. A block's top is the
program's Z0, and the program's X0 Y0 is its middle, unless the text has its corner: its least X and
Y, or X, Y and Z. Its sides are along the program's X and Y. A bore is in the middle of every
pocket. Lengths are millimetres in machine coordinates, except in texts.
"""

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from shapely.affinity import rotate
from shapely.geometry import Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.errors import UsageError
from g12.tools.path.part import disc
from g12.tools.units import UNITS, Unit

NUMBER, SIGNED, UNIT_NAME = r"(\d+\.?\d*|\.\d+)", r"([-+]?(?:\d+\.?\d*|\.\d+))", r"\s*(mm|in)?"
BAR = re.compile(rf"(?:bar\s*)?{NUMBER}{UNIT_NAME}")
SIZES = rf"(?:block\s*)?{NUMBER}x{NUMBER}x{NUMBER}(?:@{SIGNED},{SIGNED}(?:,{SIGNED})?)?"
BLOCK = re.compile(rf"(?:{SIZES})?\s*(?:bore\s*{NUMBER})?{UNIT_NAME}")
BAR_FORMS = "a bar's diameter: 40, 40mm, 1.5in"
BLOCK_FORMS = (
    "100x80x20 (X, Y, Z), 100x80x20@-10,-10 or @-10,-10,0 (its least X, Y, Z), bore 30, or both"
)
Circle = tuple[Sequence[float], float]  # its centre, its radius
UNITS_MM = {unit.name: unit.mm for unit in UNITS.values()}


class Stock(NamedTuple):
    """A bar by its ``diameter``, or a block by its ``size`` in X, Y and Z; 0 and None if it is not.

    ``corner`` is the block's least X and Y from the program's zero, None for a block in the middle;
    ``top`` its top from there, ``bore`` the diameter of the holes in it.
    """

    text: str
    diameter: float = 0.0
    size: tuple[float, ...] | None = None
    corner: tuple[float, ...] | None = None
    bore: float = 0.0
    top: float = 0.0

    @property
    def is_whole(self) -> bool:
        """Whether it is a bar or a block: of a bore alone only the pockets are known."""
        return bool(self.diameter or self.size)

    def shape(self, zero: np.ndarray, rotation: float, pockets: Sequence[Circle]) -> BaseGeometry:
        """Return its area as seen along Z; ``zero`` and ``rotation`` (degrees) are the program's.

        Without a block, only the material around the pockets is known.
        """
        if self.diameter:
            return disc((0.0, 0.0), self.diameter / 2)
        if self.size:
            low = zero[:2] + np.array(self.corner or np.array(self.size[:2]) / -2)
            along = box(*low, *(low + np.array(self.size[:2])))
            whole = rotate(along, rotation, origin=tuple(zero[:2]))
        else:
            whole = unary_union([Polygon(), *(disc(*pocket) for pocket in pockets)])
        bores = [disc(centre, self.bore / 2) for centre, _ in pockets] if self.bore else []
        return whole.difference(unary_union([Polygon(), *bores]))


class StockText(NamedTuple):
    """A stock from the user's text, and the unit name of its numbers; None: the program's."""

    text: str
    units: str | None = None


def read_stock(text: str, turning: bool, unit: Unit) -> Stock:
    """Return the stock of a text, for a mill or a machine that turns its part.

    A number without a unit is in ``unit``. Raises UsageError with the valid forms.
    """
    words = " ".join(text.lower().replace("×", "x").split())
    match = (BAR if turning else BLOCK).fullmatch(words)
    *numbers, name = match.groups() if match else (None,)
    mm = UNITS_MM.get(name, unit.mm)
    sizes = [float(number or 0) * mm for number in numbers]
    least = [size for size, number in zip(sizes[:3], numbers) if number]
    if not any(sizes) or not all(least):
        forms = BAR_FORMS if turning else BLOCK_FORMS
        raise UsageError(f"--stock {text!r} is not {forms}")
    if turning:
        return Stock(words, diameter=sizes[0])
    size = tuple(sizes[:3]) if sizes[0] else None
    corner = tuple(sizes[3:5]) if numbers[3] else None
    top = sizes[5] + sizes[2] if numbers[5] else 0.0
    return Stock(words, size=size, corner=corner, bore=sizes[6], top=top)
