# SPDX-License-Identifier: GPL-2.0-or-later
"""A program on a machine, as it was traced and perhaps as it ran, and as its parts see it."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Self

from g12.tools.machine.ini import Ini
from g12.tools.path.follow import Followed, follow
from g12.tools.path.part import Part, part_of_program
from g12.tools.path.samples import Samples
from g12.tools.path.section_axes import SectionAxes
from g12.tools.path.surface import Surface
from g12.tools.path.track import Track, limits_of, track
from g12.tools.preview.moves import Trace
from g12.tools.verify.compare.plane import x0_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.sections.view import SectionView, view_of

SAME_X0 = 1e-6  # mm


@dataclass(frozen=True)
class Subject:
    """A program on a machine, as traced, and as a part sees it; ``samples`` are those of a run.

    It is of its ``own`` moves alone, if those are given and nothing ran; ``drawn`` are their path
    and the motion of the run on it, if these are known.
    """

    program: Path
    ini: Ini
    trace: Trace
    part: Part
    samples: Samples | None = None
    own: range | None = None
    drawn: tuple[Track, Followed | None] | None = None
    _surfaces: dict[float, Self] = field(default_factory=dict)  # of a run: all of it is looked at

    @cached_property
    def path(self) -> Track:
        """The moves as one polyline in time."""
        if self.drawn:
            return self.drawn[0]
        limits, speed = limits_of(self.ini), self.trace.modes.speed
        return track(self.part, self.trace.moves, limits, speed, own=self.own)

    @cached_property
    def real(self) -> Followed | None:
        """The motion of the run, laid on the path."""
        if self.drawn or not self.samples:
            return self.drawn[1] if self.drawn else None
        return follow(self.path, self.trace.moves, self.samples, self.ini.mm)

    def about(self, centre: float, own: range | None = None) -> Self:
        """Return the same with the spindle's axis at another machine X; of its ``own`` moves."""
        same = abs(self.part.centre - centre) < SAME_X0
        return self if same else self._on(replace(self.part, centre=centre), own)

    def on_surface(self, radius: float, own: range | None = None) -> Self:
        """Return the same on a cylinder's unrolled surface."""
        there = self._on(Surface(turning=True, radius=radius), own)
        return self._surfaces.setdefault(radius, there) if self.samples else there

    def view(self, section: SectionContour, axes: SectionAxes, tolerance: float) -> SectionView:
        """Return a section that moves as its part sees it."""
        own, radius = range(section.at, section.end), section.surface
        x0 = x0_of(section, self.trace.moves[section.at])
        there = self.on_surface(radius, own) if radius else self.about(x0, own)
        return view_of(section, self.trace, there.path, there.real, axes, tolerance)

    def _on(self, part: Part, own: range | None) -> Self:
        return replace(self, part=part, own=None if self.samples else own)


def subject_of(program: Path, ini: Ini, trace: Trace, samples: Samples | None = None) -> Subject:
    """Return a traced program as its part sees it, and a run of it."""
    return Subject(program, ini, trace, part_of_program(ini, trace), samples)
