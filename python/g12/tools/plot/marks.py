# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture marks of the judgement of ``verify``: findings, and the stock.

Lengths are millimetres in the coordinates of the picture's part.
"""

import math
from typing import NamedTuple

from shapely.geometry.base import BaseGeometry

from g12.tools.material.stock import Stock
from g12.tools.verify.judge import Judgement
from g12.tools.verify.model.finding import FINDING, Finding
from g12.tools.verify.model.solid import FACE


class DrawnStock(NamedTuple):
    """A given stock: its area as seen along Z, its top, its bottom if that is known."""

    stock: Stock
    shape: BaseGeometry
    top: float
    bottom: float | None


class Marks(NamedTuple):
    """The findings that the picture marks, each with a place, and the stock if one is given.

    ``surface`` is the radius of the cylinder that the picture unrolls, 0 without one. ``z0`` is
    the machine Z of the program's Z0 where it first cuts, as far as that is known.
    """

    findings: tuple[Finding, ...] = ()
    stock: DrawnStock | None = None
    surface: float = 0.0
    z0: float = 0.0

    @property
    def rapids(self) -> list[Finding]:
        """The rapids through material: ``path`` is where."""
        return [each for each in self.findings if "path" in each.values]

    @property
    def uncut(self) -> list[Finding]:
        """The uncut material in pockets: its ``shape`` along Z, and the ``floor`` below it."""
        return [each for each in self.findings if "floor" in each.values]

    @property
    def signs(self) -> list[Finding]:
        """The findings that are not drawn as a path or an area."""
        return [each for each in self.findings if not {"path", "floor"} & each.values.keys()]


def marks_of(judgement: Judgement) -> Marks:
    """Return what the picture of a judged program marks.

    It is that of a cylinder's surface where all sections and holes are on one.
    """
    program, solids = judgement.program, judgement.solids
    radii = [cut.surface for cut in program.cuts if program.turning or program.is_round]
    surface = radii[0] if radii and all(radii) else 0.0
    placed = (each for each in judgement.of(FINDING) if each.place is not None)
    marked = (each for each in placed if bool(_surface_of(each, judgement)) == bool(surface))
    bottom = solids.bottom if math.isfinite(solids.bottom) else None
    stock = solids.stock and DrawnStock(
        solids.stock, solids.of(FACE).shape, solids.top(FACE), bottom
    )
    return Marks(tuple(marked), stock, surface, program.z0)


def _surface_of(found: Finding, judgement: Judgement) -> float:
    """Return the radius of the cylinder on which the place of a finding is, 0 on the face."""
    own = (cut for cut in judgement.program.cuts if cut.file == found.file)
    cut = next((each for each in own if each.line <= found.line <= each.last_line), None)
    return float(found.values.get("surface", cut.surface if cut else FACE))
