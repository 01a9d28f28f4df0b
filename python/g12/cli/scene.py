# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture shows: a program, the machine, the moves, and perhaps the real motion."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from g12.cli.headless import Run
from g12.cli.ini import Ini
from g12.cli.motion import Followed, Track, follow, limits_of, track
from g12.cli.part import part_of, tool_diameters
from g12.cli.trace import Move, Tools, Trace, mm_per_unit
from g12.cli.units import Unit, plain, unit_of

HEAD_COMMENT = re.compile(r"\(([^()]*)\)|;\s*(.+)")
LONGEST_HEADING = 70


@dataclass(frozen=True)
class Scene:
    """A traced program on its machine; ``diameters`` of the tools in mm, ``unit`` is shown."""

    program: Path
    ini: Ini
    trace: Trace
    diameters: dict[int, float]
    unit: Unit
    path: Track
    feed_colours: bool = False
    real: Followed | None = None

    @property
    def moves(self) -> Sequence[Move]:
        """Return the program's moves."""
        return self.trace.moves

    @property
    def title(self) -> str:
        """Return the picture's heading."""
        return self.program.stem

    @property
    def subtitle(self) -> str:
        """Return the program's own first comment, the machine and the time."""
        cutting = (i for i, move in enumerate(self.moves) if move.kind != "rapid")
        length = sum(self.path.part_length(index) for index in cutting)
        facts = [
            heading(self.program),
            self.ini.path.name,
            f"cutting path {plain(length / self.unit.mm, 1)} {self.unit.name}",
            f"{clock(self.path.time[-1])} at the programmed feeds",
        ]
        return " · ".join(filter(None, facts))


def scene_of(
    program: Path,
    ini: Ini,
    trace: Trace,
    *,
    tools: Tools = None,
    units: str | None = None,
    feed_colours: bool = False,
) -> Scene:
    """Return what to show of a traced program; without ``units`` lengths as the program's."""
    path = track(part_of(ini), trace.moves, limits_of(ini), trace.modes.speed)
    unit = unit_of(trace.modes, units)
    return Scene(program, ini, trace, tool_diameters(ini, tools), unit, path, feed_colours)


def with_run(scene: Scene, run: Run) -> Scene:
    """Return the same scene with the real motion of a run."""
    real = follow(scene.path, scene.moves, run.samples, mm_per_unit(scene.ini))
    return replace(scene, real=real)


def heading(program: Path) -> str:
    """Return the first comment at the top of a program, licence lines aside."""
    lines = program.read_text(encoding="utf-8", errors="replace").splitlines()[:5]
    found = (match[1] or match[2] for line in lines if (match := HEAD_COMMENT.search(line)))
    return next((text.strip() for text in found if "SPDX" not in text), "")[:LONGEST_HEADING]


def clock(seconds: float) -> str:
    """Return a time in words."""
    minutes, rest = divmod(seconds, 60)
    return f"{int(minutes)} min {rest:.0f} s" if minutes else f"{rest:.1f} s"
