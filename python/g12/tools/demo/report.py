# SPDX-License-Identifier: GPL-2.0-or-later
"""The demo's report of a program: the verdict, its picture and its table."""

from collections.abc import Sequence
from pathlib import Path

from g12.tools.demo.samples import Sample
from g12.tools.headless.machine import Run
from g12.tools.machine.ini import read_ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import Scene, scene_of_proof
from g12.tools.units import Unit, clock, plain
from g12.tools.verify.proof import Proof, prove
from g12.tools.verify.report import in_columns
from g12.tools.verify.result.cut import MeasuredCut

POCKET_HEADS = ("line", "code", "centre", "radius", "tool-centre rings", "Z", "off circles", "time")
SECTION_HEADS = ("lines", "segments", "off contour", "allowed", "lowest feed", "C at most", "time")


def show(sample: Sample, run: Run, output: Path) -> tuple[str, bool]:
    """Draw a sample; return its table and whether its circles and contours are correct.

    Some of the manuals' programs leave material, or have rapids through it: that is only reported.
    """
    ini = read_ini(sample.ini)
    proof = prove(sample.path, ini, tools=sample.tools, samples=run.samples)
    scene = scene_of_proof(proof, sample.override)
    picture = output / f"{sample.path.parent.name}_{sample.path.stem}.png"
    style.save(picture_of(scene), picture)
    sound = all(cut.sound for cut in (*proof.pockets, *proof.sections))
    return describe(sample, run, proof, scene, picture), sound


def describe(sample: Sample, run: Run, proof: Proof, scene: Scene, picture: Path) -> str:
    slow = clock(scene.path.time[-1])
    faster = f" at {sample.override:g} % feed ({slow} at 100 %)" if sample.override != 100 else ""
    title = f"{scene.title}: {clock(run.seconds)} on {sample.machine}{faster}, {picture}"
    unit = scene.unit
    lines = [title, *(f"  LinuxCNC said: {message.text}" for message in run.messages)]
    if proof.pockets:
        lines += table(POCKET_HEADS, *(pocket_row(cut, unit) for cut in proof.pockets))
    if proof.sections:
        lines += table(SECTION_HEADS, *(section_row(cut, unit) for cut in proof.sections))
    found = (each for each in proof.judged if each.is_finding)
    lines += [f"  line {each.line}: {proof.text(each, unit)}" for each in found]
    return "\n".join(lines)


def pocket_row(cut: MeasuredCut, unit: Unit) -> tuple[str, ...]:
    """Return a pocket's row of the table; its time is that at the programmed feed."""
    values = cut.values
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


def section_row(cut: MeasuredCut, unit: Unit) -> tuple[str, ...]:
    values = cut.values
    return (
        f"{cut.line}-{cut.last}",
        str(values["segments"]),
        f"{unit.fine(cut.deviation)} {unit.name}",
        f"{unit.fine(values['allowed'])} {unit.name}",
        f"{plain(values['lowest_feed'] / unit.mm, 1)} {unit.name}/min",
        f"{plain(values['c_speed'], 1)} of {plain(values['c_limit'], 1)} °/s",
        f"{plain(values['seconds_programmed'], 1)} s",
    )


def table(*rows: Sequence[str]) -> list[str]:
    return [f"  {line}" for line in in_columns(rows)]
