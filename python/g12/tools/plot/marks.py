# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture marks of the judgement of ``verify``: findings, and the stock.

Lengths are millimetres in the coordinates of the picture's part.
"""

from typing import NamedTuple

from g12.tools.path.part import Z
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.workpiece import Workpiece


class Marks(NamedTuple):
    """The findings that the picture marks, each with a place, and the stock if one is given.

    ``surface`` is the radius of the cylinder that the picture unrolls, 0 without one. ``z0`` is
    the machine Z of the program's Z0 where it first cuts, as far as that is known.
    """

    findings: tuple[Finding, ...] = ()
    stock: Workpiece | None = None
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


def marks_of_proof(proof: Proof) -> Marks:
    """Return what the picture of a verified program marks.

    It is that of a cylinder's surface where all sections and holes are on one. Of sections the
    place is in the coordinates of the face or the surface, of holes always in those of the face.
    """
    sections, holes = proof.sections, proof.cuts.holes
    radii = [cut.surface for cut in (*sections, *holes)]
    surface = radii[0] if radii and all(radii) else 0.0
    others = holes if surface else [cut for cut in sections if cut.surface]
    elsewhere = {id(each) for cut in others for each in cut.judged}
    placed = (each for each in proof.judged if each.is_finding and each.place is not None)
    marked = (
        each
        for each in placed
        if id(each) not in elsewhere and bool(each.values.get("surface", surface)) == bool(surface)
    )
    return Marks(tuple(marked), proof.given, surface, float(proof.subject.zero[Z]))
