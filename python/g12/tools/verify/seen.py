# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture of a program warns of, beside what it cuts: the same that ``verify`` finds.

Lengths are millimetres in machine coordinates.
"""

from typing import NamedTuple

from g12.tools.path.part import Z
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.workpiece import Workpiece


class Seen(NamedTuple):
    """The findings, the stock if one is given, and the notes, which no picture shows.

    ``surface`` is the radius of the cylinder that the program cuts on, 0 without one. ``z0`` is
    how high the program's Z0 is where it first cuts, as far as that is known.
    """

    findings: tuple[Finding, ...] = ()
    stock: Workpiece | None = None
    notes: tuple[Finding, ...] = ()
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
        """The findings with a place that are not drawn as a path or an area."""
        drawn = [*map(id, self.rapids), *map(id, self.uncut)]
        return [each for each in self.findings if each.place is not None and id(each) not in drawn]


def seen_of_proof(proof: Proof) -> Seen:
    """Return what a picture of a program that was measured shows beside the cuts.

    It is that of a cylinder's surface where all sections are cut on one.
    """
    radii = [cut.commanded.surface for cut in proof.sections]
    return Seen(
        tuple(each for each in proof.judged if each.is_finding),
        proof.given,
        tuple(each for each in proof.judged if each.is_note),
        radii[0] if radii and all(radii) else 0.0,
        float(proof.subject.zero[Z]),
    )
