# SPDX-License-Identifier: GPL-2.0-or-later
"""The demo's report of a program: the verdict, its picture and its table."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from g12.tools.demo.samples import Sample
from g12.tools.headless.machine import Run
from g12.tools.machine.ini import read_ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import Scene, scene_of_judgement
from g12.tools.units import Unit, clock, plain
from g12.tools.verify.judge import Judgement, judge
from g12.tools.verify.measures import kind_of, measures
from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.finding import FINDING
from g12.tools.verify.report import in_columns, sentence_in, where_text

POCKET_HEADS = ("line", "code", "centre", "radius", "tool-centre rings", "Z", "off circles", "time")
SECTION_HEADS = ("lines", "segments", "off contour", "allowed", "lowest feed", "C at most", "time")


def show(sample: Sample, run: Run, output: Path) -> tuple[str, bool]:
    """Draw a sample; return its table and whether its circles and contours are correct.

    Some of the manuals' programs leave material, or have rapids through it: that is only reported.
    """
    ini = read_ini(sample.ini)
    judgement = judge(sample.path, ini, tools=sample.tools, samples=run.samples)
    scene = scene_of_judgement(judgement, sample.override)
    picture = output / f"{sample.path.parent.name}_{sample.path.stem}.png"
    style.save(picture_of(scene), picture)
    cuts = [(cut, measures(cut, judgement)) for cut in judgement.program.cuts]
    sound = all(values["deviation"] <= values["allowed"] for _, values in cuts)
    return describe(sample, run, judgement, cuts, scene, picture), sound


def describe(
    sample: Sample,
    run: Run,
    judgement: Judgement,
    cuts: Sequence[tuple[Cut, dict[str, Any]]],
    scene: Scene,
    picture: Path,
) -> str:
    slow = clock(scene.path.time[-1])
    faster = f" at {sample.override:g} % feed ({slow} at 100 %)" if sample.override != 100 else ""
    title = f"{scene.title}: {clock(run.seconds)} on {sample.machine}{faster}, {picture}"
    unit = scene.unit
    lines = [title, *(f"  LinuxCNC said: {message.text}" for message in run.messages)]
    for kind, heads, row in (
        ("pockets", POCKET_HEADS, pocket_row),
        ("sections", SECTION_HEADS, section_row),
    ):
        rows = [row(cut, values, unit) for cut, values in cuts if kind_of(cut) == kind]
        lines += table(heads, *rows) if rows else []
    for each in judgement.of(FINDING):
        lines.append(f"  {where_text(each, judgement)}: {sentence_in(each, judgement, unit)}")
    return "\n".join(lines)


def pocket_row(cut: Cut, values: dict[str, Any], unit: Unit) -> tuple[str, ...]:
    """Return a pocket's row of the table; its time is that at the programmed feed."""
    x, y = values["centre"]
    return (
        str(cut.line),
        cut.code,
        f"X{unit.text(x)} Y{unit.text(y)}",
        unit.text(values["radius"]),
        " ".join(unit.text(ring) for ring in values["rings"]),
        unit.text(values["lowest"]),
        f"{unit.fine(values['off_circles'])} {unit.name}",
        f"{plain(values['seconds_programmed'], 1)} s",
    )


def section_row(cut: Cut, values: dict[str, Any], unit: Unit) -> tuple[str, ...]:
    return (
        f"{cut.line}-{cut.last_line}",
        str(values["segments"]),
        f"{unit.fine(values['deviation'])} {unit.name}",
        f"{unit.fine(values['allowed'])} {unit.name}",
        f"{plain(values['lowest_feed'] / unit.mm, 1)} {unit.name}/min",
        f"{plain(values['c_speed'], 1)} of {plain(values['c_limit'], 1)} °/s",
        f"{plain(values['seconds_programmed'], 1)} s",
    )


def table(*rows: Sequence[str]) -> list[str]:
    return [f"  {line}" for line in in_columns(rows)]
