# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture shows: a program, the machine, the moves, and perhaps the real motion."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path

from g12.tools.headless.machine import Run
from g12.tools.machine.ini import Ini
from g12.tools.path.follow import Followed, follow
from g12.tools.path.part import part_of_program, tool_diameters
from g12.tools.path.track import Track, limits_of, track
from g12.tools.preview.executed_blocks import COMMENT
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import Tools
from g12.tools.units import Unit, plain, unit_of
from g12.tools.verify.proof import Proof
from g12.tools.verify.rapids import Collision

HEAD_COMMENT = re.compile(r"\s*(?:[Oo]\d+\s*)?(?:\(([^()]*)\)|;\s*([^;]+))[\s;]*")
MOTION = re.compile(r"[xyzabcuvw]", re.IGNORECASE)
MOST_LINES = 20
LONGEST_HEADING = 72


@dataclass(frozen=True)
class Scene:
    """A traced program on its machine; ``diameters`` of the tools in mm, ``unit`` is shown.

    ``override`` is the feed override of the run in per cent. ``collisions`` are the rapids that
    go through material, ``contour`` the largest deviation (mm) from the programmed contours of
    polar sections, where that was measured.
    """

    program: Path
    ini: Ini
    trace: Trace
    diameters: dict[int, float]
    unit: Unit
    path: Track
    feed_colours: bool = False
    real: Followed | None = None
    override: float = 100.0
    collisions: tuple[Collision, ...] = ()
    contour: float | None = None

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
        """Return the comment that heads the program, the machine and the time."""
        cutting = (i for i, move in enumerate(self.moves) if move.kind != "rapid")
        length = sum(self.path.part_length(index) for index in cutting)
        facts = [
            heading(self.program),
            self.ini.path.name,
            f"cutting path {plain(length / self.unit.mm, 1)} {self.unit.name}",
            f"{clock(self.path.time[-1])} at the programmed feeds",
        ]
        if self.real is not None and self.override != 100:
            facts.append(f"run at {self.override:g} %")
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
    path = track(part_of_program(ini, trace.moves), trace.moves, limits_of(ini), trace.modes.speed)
    unit = unit_of(trace.modes.gcodes, units)
    return Scene(program, ini, trace, tool_diameters(ini, tools), unit, path, feed_colours)


def scene_of_proof(proof: Proof, tools: Tools = None, override: float = 100.0) -> Scene:
    """Return what to show of a program that was measured, its real motion included."""
    subject = proof.subject
    unit = unit_of(subject.trace.modes.gcodes)
    diameters = tool_diameters(subject.ini, tools)
    about = (subject.program, subject.ini, subject.trace, diameters, unit, subject.path)
    contour = max((facts.deviation for facts in proof.sections), default=None)
    hits = tuple(proof.collisions)
    return Scene(*about, real=subject.real, override=override, collisions=hits, contour=contour)


def with_run(scene: Scene, run: Run, override: float = 100.0) -> Scene:
    """Return the same scene with the real motion of a run at a feed override in per cent."""
    real = follow(scene.path, scene.moves, run.samples, scene.ini.mm)
    return replace(scene, real=real, override=override)


def heading(program: Path) -> str:
    """Return the first comment that has a line to itself before anything moves, no licence."""
    lines = program.read_text(encoding="utf-8", errors="replace").splitlines()[:MOST_LINES]
    still = takewhile(lambda line: not MOTION.search(COMMENT.sub("", line)), lines)
    found = (match[1] or match[2] for line in still if (match := HEAD_COMMENT.fullmatch(line)))
    text = next((text.strip() for text in found if "SPDX" not in text), "")
    return textwrap.shorten(text, LONGEST_HEADING, placeholder=" …")


def clock(seconds: float) -> str:
    """Return a time in words."""
    minutes, rest = divmod(seconds, 60)
    return f"{int(minutes)} min {rest:.0f} s" if minutes else f"{rest:.1f} s"
