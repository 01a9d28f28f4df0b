# SPDX-License-Identifier: GPL-2.0-or-later
"""Units of length for output; everything else is in millimetres."""

import math
from collections.abc import Container
from typing import NamedTuple

from g12.lengths import MM_PER_INCH, is_inch


class Unit(NamedTuple):
    """The unit of length shown: its name, its size in mm and the decimals worth showing."""

    name: str
    mm: float
    decimals: int

    def text(self, length: float) -> str:
        """Return a length in mm as text in this unit, without trailing zeros."""
        return plain(length / self.mm, self.decimals)

    def fine(self, length: float) -> str:
        """Return a small length in mm as text in this unit, with two significant digits, or ∞."""
        value = length / self.mm
        if not math.isfinite(value):
            return "∞"
        first = math.floor(math.log10(abs(value))) if value else 0
        return plain(value, max(self.decimals, 1 - first) if abs(value) > 1e-7 else 1)

    def area(self, square_mm: float) -> str:
        return f"{plain(square_mm / self.mm**2, self.decimals)} {self.name}²"


MM = Unit("mm", 1.0, 3)
UNITS = {"mm": MM, "inch": Unit("in", MM_PER_INCH, 4)}


def unit_of(gcodes: Container[str], name: str | None = None) -> Unit:
    """Return the unit of a name, by default that of a program's active G codes."""
    return UNITS[name or ("inch" if "G20" in gcodes else "mm")]


def name_of_unit(mm: float) -> str:
    """Return the name in UNITS for a machine whose unit is ``mm`` long."""
    return "inch" if is_inch(mm) else "mm"


def counted_as(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def plain(value: float, decimals: int) -> str:
    """Return a number without trailing zeros, with a real minus sign."""
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text.replace("-", "−")


def clock(seconds: float) -> str:
    if round(seconds, 1) < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s"
