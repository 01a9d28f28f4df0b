# SPDX-License-Identifier: GPL-2.0-or-later
"""The demo's report of a program: its times, its picture, and what ``verify`` says of its run."""

from pathlib import Path

from g12.tools.demo.samples import Sample
from g12.tools.headless.machine import Run
from g12.tools.machine.ini import read_ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import scene_of_judgement
from g12.tools.units import clock
from g12.tools.verify.judge import judge
from g12.tools.verify.model.deviation import allowed_off
from g12.tools.verify.report import as_text


def show(sample: Sample, run: Run, output: Path) -> tuple[str, bool]:
    """Draw a sample; return its report and whether its circles and contours are correct.

    Some of the manuals' programs leave material, or have rapids through it: that is only reported.
    """
    judgement = judge(sample.path, read_ini(sample.ini), tools=sample.tools, samples=run.samples)
    program, scene = judgement.program, scene_of_judgement(judgement, sample.override)
    picture = output / f"{sample.path.parent.name}_{sample.path.stem}.png"
    style.save(picture_of(scene), picture)
    slow = clock(scene.path.time[-1])
    faster = f" at {sample.override:g} % feed ({slow} at 100 %)" if sample.override != 100 else ""
    title = f"{scene.title}: {clock(run.seconds)} on {sample.machine}{faster}, {picture}"
    said = (f"LinuxCNC said: {message.text}" for message in run.messages)
    text = "\n".join([title, *said, as_text(judgement, scene.unit)])
    cuts = zip(program.cuts, judgement.deviations)
    return text, all(off.size <= allowed_off(cut, program, None) for cut, off in cuts)
